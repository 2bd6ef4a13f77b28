# SPDX-License-Identifier: GPL-3.0-or-later
"""Every kind of bad input has its status and names the elements."""

import numpy as np
import pytest
from meshes import cube, icosphere, octahedron, torus

import core

VERTICES, TRIANGLES = icosphere(1)
CONES = [0, 1, 2]


def failure(vertices=VERTICES, triangles=TRIANGLES, signature="442", cones=CONES, **options):
    """The error that embedding raises, with a message of one line."""
    with pytest.raises(core.OrbifoldError) as caught:
        core.embed(vertices, triangles, signature, cones, **options)
    error = caught.value
    message = str(error)
    assert len(message) > 10 and "\n" not in message
    assert len(error.elements) <= 16 and error.found >= len(error.elements)
    if error.element == "edge":
        assert all(len(edge) == 2 for edge in error.elements)
    return error


def edges_of(error):
    assert error.element == "edge"
    return {tuple(sorted(edge)) for edge in error.elements}


def test_boundary():
    error = failure(triangles=TRIANGLES[1:])
    a, b, c = sorted(TRIANGLES[0])
    assert error.status == "ORB_BOUNDARY" and edges_of(error) == {(a, b), (a, c), (b, c)} and error.found == 3


def test_non_manifold_edge():
    a, b, _ = TRIANGLES[0]
    error = failure(np.vstack([VERTICES, [[3, 0, 0]]]), np.vstack([TRIANGLES, [[a, b, len(VERTICES)]]]))
    assert error.status == "ORB_NON_MANIFOLD_EDGE" and edges_of(error) == {tuple(sorted((a, b)))} and error.found == 1


def test_non_manifold_vertex():
    n = len(VERTICES)
    other = TRIANGLES + n  # a second sphere that shares vertex 5
    other[other == n + 5] = 5
    error = failure(np.vstack([VERTICES, VERTICES + 3]), np.vstack([TRIANGLES, other]))
    assert (error.status, error.element, error.elements, error.found) == ("ORB_NON_MANIFOLD_VERTEX", "vertex", [5], 1)


def test_inconsistent_orientation():
    turned = TRIANGLES.copy()
    turned[7] = turned[7][::-1]
    a, b, c = sorted(turned[7])
    error = failure(triangles=turned)
    assert error.status == "ORB_INCONSISTENT_ORIENTATION" and edges_of(error) == {(a, b), (a, c), (b, c)}


def test_several_components():
    n = len(VERTICES)
    error = failure(np.vstack([VERTICES, VERTICES + 3]), np.vstack([TRIANGLES, TRIANGLES + n]))
    assert error.status == "ORB_SEVERAL_COMPONENTS" and error.element == "vertex"
    assert len(error.elements) == 2 and error.elements[0] < n <= error.elements[1]


def test_wrong_genus():
    vertices, triangles = torus()
    error = failure(vertices, triangles, cones=[0, 5, 20])
    assert error.status == "ORB_WRONG_GENUS"


def test_isolated_vertices_are_tolerated_but_are_no_cones():
    vertices = np.vstack([VERTICES, [[9, 9, 9]]])
    result = core.embed(vertices, TRIANGLES, "442", CONES)
    assert result.report["certificate"]["flipped"] == 0
    error = failure(vertices, cones=[0, 1, len(VERTICES)])
    assert (error.status, error.element, error.elements) == ("ORB_BAD_CONE", "vertex", [len(VERTICES)])


@pytest.mark.parametrize("index", [-1, len(VERTICES), 2**31 - 1, 2**31, 2**40, -(2**33)])
def test_index_out_of_range(index):
    broken = TRIANGLES.astype(np.int64)
    broken[3, 1] = index
    error = failure(triangles=broken)
    assert (error.status, error.element, error.elements) == ("ORB_INDEX_OUT_OF_RANGE", "triangle", [3])


def test_degenerate_triangle():
    broken = TRIANGLES.copy()
    broken[4, 1] = broken[4, 0]
    error = failure(triangles=broken)
    assert (error.status, error.element, error.elements) == ("ORB_DEGENERATE_TRIANGLE", "triangle", [4])


def test_repeated_triangle():
    error = failure(triangles=np.vstack([TRIANGLES, TRIANGLES[6:7]]))
    assert error.status == "ORB_REPEATED_TRIANGLE" and error.element == "triangle"
    assert set(error.elements) <= {6, len(TRIANGLES)} and error.elements


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_non_finite(value):
    broken = VERTICES.copy()
    broken[11, 2] = value
    error = failure(broken)
    assert (error.status, error.element, error.elements) == ("ORB_NON_FINITE", "vertex", [11])


@pytest.mark.parametrize(
    "cones, named",
    [([0, 1, 0], [0]), ([0, 1, 1000], [1000]), ([0, -3, 1], [-3]), ([0, 1, 2**40], [2**40])],
)
def test_bad_cone(cones, named):
    error = failure(cones=cones)
    assert (error.status, error.element, error.elements) == ("ORB_BAD_CONE", "vertex", named)


@pytest.mark.parametrize("cones", [[], [0], [0, 1], [0, 1, 2, 3]])
def test_cone_count(cones):
    assert failure(cones=cones).status == "ORB_CONE_COUNT"


@pytest.mark.parametrize(
    "signature, cones, status, elements",
    [
        ("4?2", CONES, "ORB_BAD_SIGNATURE", [1]),
        ("", CONES, "ORB_BAD_SIGNATURE", [0]),
        ("412", CONES, "ORB_BAD_ORDER", None),
        ("23", [0, 1], "ORB_BAD_ORBIFOLD", None),
        ("7", [0], "ORB_BAD_ORBIFOLD", None),
        ("*442", CONES, "ORB_BOUNDARY", None),
        ("o", [], "ORB_WRONG_GENUS", None),
        ("4*2", [0, 1], "ORB_BOUNDARY", None),
    ],
)
def test_signature(signature, cones, status, elements):
    error = failure(signature=signature, cones=cones)
    assert error.status == status
    if elements is not None:
        assert error.elements == elements and error.element == "character"


@pytest.mark.parametrize("orders", [[4, 4, 4], [4, 2], [1, 4, 2], [4, 4, 2**35]])
def test_orders_that_are_not_the_signature_s(orders):
    assert failure(orders=orders).status == "ORB_BAD_ORDER"


def test_zero_area_triangles_are_tolerated_or_named():
    """A needle whose three corners are in line, and one edge of no length: certified, or the triangles are named."""
    vertices, triangles = icosphere(2)
    a, b, c = triangles[30]
    flat = vertices.copy()
    flat[a] = (flat[b] + flat[c]) / 2
    point = vertices.copy()
    point[a] = point[b]
    for broken, needles in ((flat, {30}), (point, set(np.flatnonzero((np.isin(triangles, [a, b])).sum(1) == 2)))):
        try:
            result = core.embed(broken, triangles, "442", [0, 1, 2])
            assert result.report["certificate"]["flipped"] == 0 and np.isfinite(result.embedding).all()
        except core.OrbifoldError as error:
            assert error.status == "ORB_ZERO_AREA_TRIANGLE" and error.element == "triangle"
            assert set(error.elements) <= {int(t) for t in needles} and error.elements


def uniform_rows():
    edges = np.unique(np.sort(np.stack([TRIANGLES, np.roll(TRIANGLES, -1, 1)], 2).reshape(-1, 2), 1), axis=0)
    return np.column_stack([edges, np.ones(len(edges))])


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_bad_weight(value):
    rows = uniform_rows()
    rows[5, 2] = value
    error = failure(weights=rows)
    assert error.status == "ORB_BAD_WEIGHT" and edges_of(error) == {tuple(rows[5, :2].astype(int))}


def test_edge_without_weight_or_weight_without_edge():
    rows = uniform_rows()
    error = failure(weights=rows[1:])
    assert error.status == "ORB_BAD_WEIGHT" and edges_of(error) == {tuple(rows[0, :2].astype(int))}
    far = int(np.setdiff1d(np.arange(len(VERTICES)), rows[(rows[:, :2] == 0).any(1), :2])[0])
    assert failure(weights=np.vstack([rows, [[0, far, 1]]])).status == "ORB_BAD_WEIGHT"
    assert failure(weights=np.vstack([rows, rows[:1]])).status == "ORB_BAD_WEIGHT"


@pytest.mark.parametrize("clamp", [0, -1, float("nan"), float("inf"), "thick", None])
def test_bad_clamp(clamp):
    assert failure(clamp=clamp).status == "ORB_BAD_ARGUMENT"


def test_unknown_weights():
    error = failure(weights="conform")
    assert error.status == "ORB_BAD_ARGUMENT"
    assert all(word in str(error) for word in ("'conform'", "'cotan'", "'mean-value'", "'uniform'", "'conformal'"))


@pytest.mark.parametrize(
    "options",
    [
        {"vertices": VERTICES[:, :2]},
        {"vertices": VERTICES.ravel()},
        {"vertices": [[0, 0, 0], [1, 0]]},
        {"vertices": [["a", "b", "c"]]},
        {"vertices": None},
        {"triangles": TRIANGLES.astype(float)},
        {"triangles": TRIANGLES.ravel()},
        {"triangles": TRIANGLES[:, :2]},
        {"triangles": [[0, 1, 2], [3, 4]]},
        {"cones": [[0, 1, 2]]},
        {"cones": [0.0, 1.0, 2.0]},
        {"cones": None},
        {"orders": [4.0, 4.0, 2.0]},
        {"signature": 442},
        {"weights": [[0, 1]]},
        {"weights": "cotangent"},
        {"weights": None},
        {"chart": "mercator"},
        {"chart": "poincare"},
    ],
    ids=lambda options: next(iter(options)),
)
def test_bad_argument(options):
    assert failure(**options).status == "ORB_BAD_ARGUMENT"


def test_empty_mesh():
    error = failure(np.zeros((0, 3)), np.zeros((0, 3), int))
    assert error.status != "ORB_OUT_OF_MEMORY" and error.status.startswith("ORB_")


@pytest.mark.parametrize("scale", [1e-300, 1e-160, 1e-38, 1e37, 1e150, 1e300])
def test_tiny_and_huge_coordinates(scale):
    """Those of 32-bit floats give what the unit sphere gives; beyond, the report is finite or there is an error."""
    plain = core.embed(VERTICES, TRIANGLES, "442", CONES).report["distortion"]
    try:
        scaled = core.embed(VERTICES * scale, TRIANGLES, "442", CONES).report["distortion"]
    except core.OrbifoldError:
        assert not 1e-38 <= scale <= 1e38
        return
    assert scaled == pytest.approx(plain, rel=1e-9)


@pytest.mark.parametrize("mesh", [cube, octahedron], ids=["cube", "octahedron"])
def test_errors_leave_the_arrays_alone(mesh):
    vertices, triangles = mesh()
    before = vertices.copy(), triangles.copy()
    failure(vertices, triangles, cones=[0, 0, 1])
    core.embed(vertices, triangles, "442", [0, 1, 3])
    assert np.array_equal(vertices, before[0]) and np.array_equal(triangles, before[1])
