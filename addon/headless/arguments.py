# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of `./build.sh run`, read into a dataclass."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NoReturn, Optional, Sequence

from .errors import RunError

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

Several meshes, a folder (all mesh files in it) and a list of jobs are done one after the other; a mesh that fails does
not stop the others. A table sums up, and the exit status is 0 only if all went well. A list of jobs is a .csv file, its
first line naming the columns, or a .json file with a list of objects: mesh, and any of orbifold, cones, orders,
weights, holes, output, object, files, export. What a job does not say is as on the command line; paths in the list are
relative to its folder."""


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

    def with_values(self, values: dict[str, str]) -> "Arguments":
        """These, but for what the options (by their names without dashes) say; `mesh` and `output` as they stand."""
        words = [word for name, text in values.items() if name != "mesh" for word in _words(name, text)]
        told = read_request(words).arguments
        fields = {OPTIONS[name]: getattr(told, OPTIONS[name]) for name in values if name != "mesh"}
        return replace(self, **fields, **({"mesh": Path(values["mesh"])} if "mesh" in values else {}))


@dataclass(frozen=True)
class Request:
    """What the command line asks for."""

    arguments: Arguments  # of the one mesh, or what holds for all of them
    meshes: tuple[Path, ...]  # files and folders
    jobs: Optional[Path]  # a list of jobs

    @property
    def is_batch(self) -> bool:
        return self.jobs is not None or len(self.meshes) > 1 or any(mesh.is_dir() for mesh in self.meshes)


# columns of a list of jobs, each an option -> field of Arguments
OPTIONS = {
    "orbifold": "signature", "cones": "cones", "orders": "orders", "weights": "weights", "holes": "holes",
    "output": "output", "object": "object_name", "files": "files", "export": "export",
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
    arguments = Arguments(
        mesh=read.mesh[0] if len(read.mesh) == 1 else None,
        signature=read.orbifold,
        cones=None if read.cones == "auto" else _whole_numbers("--cones", read.cones, "4,70,900 or auto"),
        orders=None if read.orders is None else _whole_numbers("--orders", read.orders, "4,4,2"),
        weights=read.weights,
        holes=read.holes,
        output=read.output,
        object_name=read.object,
        files=_endings(read.files),
        export=read.export,
    )
    return Request(arguments, tuple(read.mesh), read.jobs)


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
        "                       [--files blend,json,npz,png] [--export] [--blender PATH]",
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
    add("--cones", metavar="i,j,k", default="auto", help="vertices, or auto (default)")
    add("--orders", metavar="n,n,n", help="the order of each cone, where not in the signature's sequence")
    add("--weights", metavar="KIND", choices=WEIGHTS, default="conformal",
        help=f"{', '.join(WEIGHTS[:-1])} (plane only) or {WEIGHTS[-1]} (default %(default)s)")
    add("--holes", choices=HOLES, default="refuse",
        help="boundary loops beyond the signature's mirrors: refuse, fill or mirror (default %(default)s)")
    add("--output", metavar="DIR", type=Path, default=Path("out"), help="folder for the results (default out)")
    add("--object", metavar="NAME", help="which object, where the file holds several meshes")
    add("--files", metavar="ENDINGS", default=",".join(FILES), help="which files to write (default %(default)s)")
    add("--export", action="store_true", help="also write the object, with its texture coordinates, as it came")
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
