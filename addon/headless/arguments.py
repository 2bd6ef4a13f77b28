# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of `./build.sh run`, read into a dataclass."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn, Optional, Sequence

from .errors import RunError

DEFAULT_SIGNATURE = "442"
WEIGHTS = ("conformal", "cotan", "delaunay", "mean-value", "mean-value-exact", "uniform")
HOLES = ("refuse", "fill", "mirror")

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
certified to be a bijection; otherwise it is 1, stderr has one line that says why, and nothing is written."""


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


class HelpWanted(Exception):
    """`--help` was among the arguments; str() is the text to print."""


class _Parser(argparse.ArgumentParser):
    """Errors are raised, not printed with the usage and exit status 2; so is the help."""

    def print_help(self, file: object = None) -> NoReturn:
        raise HelpWanted(self.format_help())

    def error(self, message: str) -> NoReturn:
        raise RunError(f"{message}; see ./build.sh run --help")


def read_arguments(words: Sequence[str]) -> Arguments:
    """Raises RunError for anything that is not understood, HelpWanted for `--help`."""
    read = _parser().parse_args(list(words))
    return Arguments(
        mesh=read.mesh,
        signature=read.orbifold,
        cones=None if read.cones == "auto" else _whole_numbers("--cones", read.cones, "4,70,900 or auto"),
        orders=None if read.orders is None else _whole_numbers("--orders", read.orders, "4,4,2"),
        weights=read.weights,
        holes=read.holes,
        output=read.output,
        object_name=read.object,
    )


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="./build.sh run",
        usage="./build.sh run [MESH] [--orbifold SIGNATURE] [--cones i,j,k | --cones auto] [--orders n,n,n]\n"
        "                       [--weights conformal|cotan|delaunay|mean-value|mean-value-exact|uniform]\n"
        "                       [--holes refuse|fill|mirror] [--output DIR] [--object NAME] [--blender PATH]",
        description="Map a mesh onto an orbifold: seamless texture coordinates, certified to be a bijection.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("mesh", metavar="MESH", nargs="?", type=Path,
        help=".obj .ply .stl .glb .gltf .fbx .blend .off; without it a sample creature is grown")
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
    add("--blender", metavar="PATH", help="the Blender to run in")  # read by build.sh; accepted here
    return parser


def _whole_numbers(option: str, text: str, example: str) -> tuple[int, ...]:
    try:
        numbers = tuple(int(word) for word in text.split(","))
    except ValueError:
        raise RunError(f"{option} {text}: expected whole numbers with commas between them, such as {example}") from None
    return numbers
