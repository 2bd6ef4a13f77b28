# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of `./build.sh run`, read into a dataclass."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NoReturn, Optional, Sequence

from .errors import RunError

SAMPLE = "creature"
DEFAULT_SIGNATURE = "442"
WEIGHTS = ("conformal", "cotan", "delaunay", "mean-value", "mean-value-exact", "uniform")
HOLES = ("refuse", "fill", "mirror")
FILES = ("blend", "json", "npz", "png")

EPILOG = """\
Cones are vertices of the mesh, counted from 0 in the sequence of the file, one for each number of the signature
and in its sequence ("632": the first gets order 6); those after a * are mirror corners and lie on the mesh's
boundary. `--cones auto`, which is also what happens without --cones, places them where areas are stretched least;
without --orbifold too, the signature is the best of those that are usual for the mesh. Where such cones cannot be
embedded the next best are tried. The same mesh always gets the same cones.

A mesh with more boundary loops than the signature has mirrors (*) is refused; with --holes fill the others, the
shortest ones, are closed for the computation, and with --holes mirror each adds a * to the signature.

Four files are written, NAME being the mesh file's name without its ending: NAME.blend, NAME.json (the report),
NAME.npz (the layout in double precision) and NAME.png (a picture). The exit status is 0 only if the result was
certified to be a bijection; otherwise it is 1, stderr has one line that says why, and nothing is written.
--files writes some of them only; --export also writes the object in the format that it came in, with its texture
coordinates (.obj .ply .glb .gltf .fbx; NAME.blend is there anyway).

With --map-to a map takes what MESH has to another mesh: --cones are its landmarks, --map-cones the corresponding ones
of the other in the same sequence; without them they are the cones that a .blend keeps. --orbifold is by their number
where it is not said. --transfer names what comes over: groups,colours,attributes,uv_maps if nothing is said, and
cut_seams,texture,form,form_back,shape_keys,heat,heat_area. NAME is then that of the other mesh: NAME.blend has both
meshes, NAME.json the report, NAME.npz the map in both directions, and NAME.png shows one pattern on both. Several
--map-to, or a folder, are several jobs, each with its --map-cones if one has them.

Several meshes, a folder (all mesh files in it) and a list of jobs are done one after the other; a mesh that fails does
not stop the others. A table sums up, and the exit status is 0 only if all went well. A list of jobs is a .csv file, its
first line naming the columns, or a .json file with a list of objects: mesh, and any of orbifold, cones, orders,
weights, holes, output, object, files, export, map-to, map-cones, map-object, transfer. What a job does not say is as
on the command line; paths in the list are relative to its folder."""


@dataclass(frozen=True)
class Arguments:
    mesh: Optional[Path]  # None: the sample creature
    signature: Optional[str]  # None: not said
    cones: Optional[tuple[int, ...]]  # None: suggested
    orders: Optional[tuple[int, ...]]  # None: as the signature says
    weights: str
    holes: str
    output: Path
    object_name: Optional[str]
    files: tuple[str, ...] = FILES  # endings of what is written
    export: bool = False  # also in the mesh's own format
    map_to: Optional[Path] = None  # the mesh that gets what `mesh` has; None: `mesh` is unwrapped
    map_cones: Optional[tuple[int, ...]] = None  # its landmarks; None: the cones that its file keeps
    map_object: Optional[str] = None
    transfer: Optional[tuple[str, ...]] = None  # names of what comes over; None: what is usual

    @property
    def name(self) -> str:
        """Of the files that are written."""
        named = self.map_to or self.mesh
        return named.stem if named is not None else SAMPLE

    @property
    def title(self) -> str:
        mesh = self.mesh.name if self.mesh is not None else SAMPLE
        return mesh if self.map_to is None else f"{mesh} to {self.map_to.name}"

    def with_values(self, values: dict[str, str]) -> "Arguments":
        """These, but for what the options (by their names without dashes) say; `mesh` and `output` as they stand."""
        words = [word for name, text in values.items() if name != "mesh" for word in _words(name, text)]
        if "map-to" not in values and self.map_to is not None:
            words.append(f"--map-to={self.map_to}")
        told = read_request(words).arguments
        fields = {OPTIONS[name]: getattr(told, OPTIONS[name]) for name in values if name != "mesh"}
        return replace(self, **fields, **({"mesh": Path(values["mesh"])} if "mesh" in values else {}))


@dataclass(frozen=True)
class Request:
    """What the command line asks for."""

    arguments: Arguments  # of the one mesh, or what holds for all of them
    meshes: tuple[Path, ...]  # files and folders
    jobs: Optional[Path]  # a list of jobs
    targets: tuple[tuple[Path, Optional[tuple[int, ...]]], ...]  # files and folders, each with its landmarks

    @property
    def is_batch(self) -> bool:
        paths = [*self.meshes, *(target for target, _ in self.targets)]
        several = len(self.meshes) > 1 or len(self.targets) > 1
        return self.jobs is not None or several or any(path.is_dir() for path in paths)


# columns of a list of jobs, each an option -> field of Arguments
OPTIONS = {
    "orbifold": "signature", "cones": "cones", "orders": "orders", "weights": "weights", "holes": "holes",
    "output": "output", "object": "object_name", "files": "files", "export": "export", "map-to": "map_to",
    "map-cones": "map_cones", "map-object": "map_object", "transfer": "transfer",
}
YES, NO = ("yes", "true", "1"), ("no", "false", "0")


class HelpWanted(Exception):
    """`--help` was among the arguments; str() is the text to print."""


class _Parser(argparse.ArgumentParser):
    """Errors are raised, not printed with the usage and exit status 2; so is the help."""

    def print_help(self, file: object = None) -> NoReturn:
        raise HelpWanted(self.format_help())

    def error(self, message: str) -> NoReturn:
        raise RunError(f"{message}; see ./build.sh run --help")


def read_request(words: Sequence[str]) -> Request:
    """Raises RunError for anything that is not understood, HelpWanted for `--help`."""
    read = _parser().parse_intermixed_args(list(words))
    targets = _targets(read)
    arguments = Arguments(
        mesh=read.mesh[0] if len(read.mesh) == 1 else None,
        signature=read.orbifold,
        cones=None if read.cones in (None, "auto") else _whole_numbers("--cones", read.cones, "4,70,900 or auto"),
        orders=None if read.orders is None else _whole_numbers("--orders", read.orders, "4,4,2"),
        weights=read.weights,
        holes=read.holes,
        output=read.output,
        object_name=read.object,
        files=_endings(read.files),
        export=read.export,
        map_object=read.map_object,
        transfer=None if read.transfer is None else tuple(word.strip() for word in read.transfer.split(",")),
        **(dict(zip(("map_to", "map_cones"), targets[0])) if len(targets) == 1 else {}),
    )
    return Request(arguments, tuple(read.mesh), read.jobs, targets)


def _targets(read: argparse.Namespace) -> tuple[tuple[Path, Optional[tuple[int, ...]]], ...]:
    """What --map-to and --map-cones say, and that nothing contradicts them."""
    lists = [_whole_numbers("--map-cones", text, "4,70,900") for text in read.map_cones]
    if not read.map_to:
        for option in ("map_cones", "map_object", "transfer"):
            if getattr(read, option):
                raise RunError(f"--{option.replace('_', '-')} goes with --map-to MESH")
        return ()
    if read.cones == "auto":
        raise RunError("--cones auto: landmarks of a map have to be picked, in pairs that correspond")
    if read.orders is not None:
        raise RunError("--orders: landmarks of a map have the orders of the signature; leave it out")
    if lists and len(lists) != len(read.map_to):
        raise RunError(f"there are {len(lists)} --map-cones for {len(read.map_to)} --map-to: one for each, or none")
    return tuple(zip(read.map_to, lists or [None] * len(read.map_to)))


def _words(option: str, text: str) -> list[str]:
    """An option as on the command line. One that takes no value is there or not."""
    if option != "export":
        return [f"--{option}={text}"]
    if text.lower() not in YES + NO:
        raise RunError(f"export {text}: say yes or no")
    return ["--export"] if text.lower() in YES else []


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="./build.sh run",
        usage="./build.sh run [MESH ...] [--jobs LIST] [--orbifold SIGNATURE] [--cones i,j,k | --cones auto]\n"
        "                       [--orders n,n,n]\n"
        "                       [--weights conformal|cotan|delaunay|mean-value|mean-value-exact|uniform]\n"
        "                       [--holes refuse|fill|mirror] [--output DIR] [--object NAME]\n"
        "                       [--files blend,json,npz,png] [--export] [--blender PATH]\n"
        "       ./build.sh run [MESH ...] [--cones i,j,k] --map-to MESH [--map-cones i,j,k] ...\n"
        "                       [--transfer WHAT,WHAT] and the options above but --orders",
        description="Map a mesh onto an orbifold: seamless texture coordinates, certified to be a bijection.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("mesh", metavar="MESH", nargs="*", type=Path,
        help=".obj .ply .stl .glb .gltf .fbx .blend .off, or a folder; without it a sample creature is grown")
    add("--jobs", metavar="LIST", type=Path, help=".csv or .json, a mesh with its options in each row")
    add("--orbifold", metavar="SIGNATURE",
        help="Conway's notation: 442, 2222, 532, 22(12), 237, *632, 4*2, 22*, **, *x, xx, 22x, o, oo, ... "
             f"(default: the best for the mesh; with --cones {DEFAULT_SIGNATURE})")
    add("--cones", metavar="i,j,k", help="vertices, or auto (default)")
    add("--orders", metavar="n,n,n", help="the order of each cone, where not in the signature's sequence")
    add("--weights", metavar="KIND", choices=WEIGHTS, default="conformal",
        help=f"{', '.join(WEIGHTS[:-1])} (plane only) or {WEIGHTS[-1]} (default %(default)s)")
    add("--holes", choices=HOLES, default="refuse",
        help="boundary loops beyond the signature's mirrors: refuse, fill or mirror (default %(default)s)")
    add("--output", metavar="DIR", type=Path, default=Path("out"), help="folder for the results (default out)")
    add("--object", metavar="NAME", help="which object, where the file holds several meshes")
    add("--files", metavar="ENDINGS", default=",".join(FILES), help="which files to write (default %(default)s)")
    add("--export", action="store_true", help="also write the object, with its texture coordinates, as it came")
    add("--map-to", metavar="MESH", type=Path, action="append", default=[],
        help="a mesh, or a folder, that gets what the first one has")
    add("--map-cones", metavar="i,j,k", action="append", default=[], help="its landmarks")
    add("--map-object", metavar="NAME", help="which object of its file")
    add("--transfer", metavar="WHAT,WHAT", help="what comes over (default groups,colours,attributes,uv_maps)")
    add("--blender", metavar="PATH", help="the Blender to run in")  # read by build.sh; accepted here
    return parser


def _endings(text: str) -> tuple[str, ...]:
    wanted = {word.strip().lstrip(".") for word in text.split(",")}
    if not wanted <= set(FILES):
        raise RunError(f"--files {text}: expected some of {','.join(FILES)}")
    return tuple(ending for ending in FILES if ending in wanted)


def _whole_numbers(option: str, text: str, example: str) -> tuple[int, ...]:
    try:
        numbers = tuple(int(word) for word in text.split(","))
    except ValueError:
        raise RunError(f"{option} {text}: expected whole numbers with commas between them, such as {example}") from None
    return numbers
