# SPDX-License-Identifier: GPL-3.0-or-later
"""What every operator that computes an embedding does: its settings, the job, and what is written. Subclasses say what
that is."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from .. import arrangement, blender_mesh, cones, core, properties
from .jobs import JobOperator

WEIGHTS = dict(
    name="Weights",
    description="How strongly each edge of the mesh pulls",
    items=(
        ("conformal", "Conformal", "Cotangents of the target's own metric: least angle distortion"),
        ("cotan", "Cotangent", "Those of the mesh, negative ones clamped: the papers' weights, and faster"),
        ("mean-value", "Mean Value", "Positive by themselves, no clamping"),
        ("uniform", "Uniform", "All edges alike: ignores the shape of the triangles"),
        ("delaunay", "Delaunay", "Cotangents on the intrinsic Delaunay triangulation, positive by themselves"),
        ("mean-value-exact", "Mean Value, Exact", "Floater's weights as they stand, not symmetric: plane only"),
    ),
    default="conformal",
)


class EmbeddingOperator(JobOperator):
    """Mix-in. `signature` and the settings of the computation; see unwrap.py and sphere.py."""

    signature: bpy.props.StringProperty(
        name="Signature",
        description="Conway's notation, as 442, 22(12), *632 or 4*2: one order for each cone, in the sequence of the "
        "list, and for each mirror corner, along the border. Empty: that of the mesh",
        options={"SKIP_SAVE"},
    )
    weights: bpy.props.EnumProperty(**WEIGHTS)
    clamp: bpy.props.FloatProperty(
        name="Clamp",
        description="Least cotangent weight. Smaller is more conformal, but thin triangles may collapse",
        default=0.01,
        min=1e-6,
        max=1.0,
        precision=4,
    )

    holes: bpy.props.EnumProperty(
        name="Holes",
        description="What to do with borders of the mesh that the signature has no mirror for",
        items=(("mesh", "As in the Sidebar", "The choice that is kept with the mesh"), *properties.HOLES),
        default="mesh",
        options={"SKIP_SAVE"},
    )

    def draw_weights(self) -> None:
        self.layout.prop(self, "weights")
        row = self.layout.row()
        row.active = self.weights in ("conformal", "cotan", "delaunay")
        row.prop(self, "clamp")

    # ----------------------------------------------------------------------------- what subclasses provide

    def compute(self, result: core.Result) -> object:
        """What can fail or take long, before anything is written: OrbifoldError leaves the mesh as it is."""
        return None

    def write(self, context: bpy.types.Context, result: core.Result, computed: object) -> str:
        """Writes to the object (in object mode) and returns the sentence to report."""
        raise NotImplementedError

    def write_cones(self, mesh: bpy.types.Mesh, result: core.Result) -> None:
        """Where the operator's signature is not that of the mesh: give the cones its orders."""
        if self._text is None or self._text == mesh.orbifold.signature:
            return
        orders = dict(zip(result.cones.tolist(), result.orders.tolist()))
        cones.write_cones(mesh, [cones.Cone(vertex, orders[vertex]) for vertex in self._cones])
        properties.write_signature(mesh, self._text)

    # ------------------------------------------------------------------------------------------ the stages

    def start(self, context: bpy.types.Context) -> core.Job:
        """The orbifold of the mesh's cones; with its corners in turn along the border."""
        mesh = context.active_object.data
        self._cones = [cone.vertex for cone in cones.read_cones(mesh)]
        text = self.signature or properties.default_signature(mesh)
        return self.embedding(mesh, text, arrangement.in_sequence(self._cones, self._surface, text))

    def embedding(self, mesh: bpy.types.Mesh, signature: str, vertices: Sequence[int]) -> core.EmbeddingJob:
        self._text = signature
        self._extra_borders = len(self._surface.loops) - core.parse_signature(signature).n_mirrors
        return core.start_embedding(
            *(self._arrays.vertices, self._arrays.triangles, signature, vertices),
            weights=self.weights, clamp=self.clamp, holes=self.holes_of(mesh),
        )

    def holes_of(self, mesh: bpy.types.Mesh) -> str:
        return mesh.orbifold.holes if self.holes == "mesh" else self.holes

    def proceed(self, context: bpy.types.Context, job: core.Job) -> str:
        return self.finish(context, job.finish())

    def finish(self, context: bpy.types.Context, result: core.Result) -> str:
        obj = context.active_object
        computed = self.compute(result)
        with blender_mesh.object_mode(obj):
            self.write_cones(obj.data, result)
            message = self.write(context, result, computed)
        return message

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        settings = context.active_object.data.orbifold
        if not self.signature:
            self.signature = settings.signature
        if self.holes == "mesh":
            self.holes = settings.holes
        return super().invoke(context, event)
