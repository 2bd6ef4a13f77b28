#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What docs/cones.md says from "Measured" on, and docs/cones.svg:   ./build.sh docs cones

Random cones are embedded once and kept in build/cones, so that a run that was stopped goes on where it was; from nothing
it takes half an hour of two cores. Meshes of ../shared/meshes that are not there are left out."""

import json
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
MESHES = ROOT.parent / "shared" / "meshes"
KEPT = ROOT / "build" / "cones"
sys.path.insert(0, str(ROOT / "addon"))

import core  # noqa: E402

SEED, TRIPLES, SMALL = 2026, 200, 12000  # up to SMALL vertices each triple is embedded for all three signatures
SPHERES = {
    **{"spot.obj": None, "fandisk.off": None, "bunny.obj": 0.96, "david.obj": 0.66, "head_max.off": None},
    **{"head_julius.off": None, "armadillo.obj": 2.38, "nefertiti.obj": 1.09},
}  # and the spread of BFF's eight automatic cones
DISKS = ["lion.off", "camelhead.off", "hemisphere.obj"]
SIGNATURES = ("442", "432", "237")
COLOURS = {"442": "#1f77b4", "432": "#2ca02c", "237": "#d62728"}


# ------------------------------------------------------------------------------------------------- measuring


def measured(mesh, signature, cones):
    """(spread of log area, mean quasi-conformal error), or None with the reason."""
    try:
        distortion = core.embed(*mesh, signature, cones, weights="conformal").report["distortion"]
    except core.OrbifoldError as error:
        return None, str(error)
    return distortion["log_area_std"], distortion["quasi_conformal_mean"]


def random_rows(name, mesh):
    """[[signature, cones, spread or None]] of 200 random triples: all three signatures, on a large mesh in turn; on a
    disk between mirrors, so that the corners are on the boundary."""
    file = KEPT / f"random.{name}.json"
    if not file.is_file():
        loops = core.topology_of(mesh[1]).loops
        places, star = (np.asarray(loops[0]), "*") if loops else (np.unique(mesh[1]), "")
        random, wanted = np.random.default_rng(SEED), []
        for k in range(TRIPLES):
            cones = [int(v) for v in random.choice(places, 3, replace=False)]
            for signature in SIGNATURES if len(mesh[0]) < SMALL else (SIGNATURES[k % 3],):
                wanted.append((star + signature, _in_turn(cones, loops[0]) if star else cones))
        with ThreadPoolExecutor(2) as pool:
            spreads = list(pool.map(lambda row: measured(mesh, *row)[0], wanted))
        KEPT.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps([[*row, spread] for row, spread in zip(wanted, spreads)]))
    return [row[:3] for row in json.loads(file.read_text()) if row[2] is not None]


def _in_turn(cones, loop):
    """As they follow along the boundary."""
    return sorted(cones, key=list(map(int, loop)).index)


def predicted_rows(name, mesh, rows):
    """What is predicted of each row; kept too, beside the library's version."""
    file = KEPT / f"predicted.{name}.json"
    if not file.is_file():
        with ThreadPoolExecutor(2) as pool:
            spreads = list(pool.map(lambda row: core.predict(*mesh, row[0], row[1]).spread, rows))
        file.write_text(json.dumps(spreads))
    return json.loads(file.read_text())


def study(name):
    """All numbers of one mesh."""
    mesh = core.read_mesh(MESHES / name)
    begun = time.process_time()
    usual = core.suggest_cones(*mesh)
    seconds = time.process_time() - begun
    flat = core.suggest_cones(*mesh, flat=True)[0]
    rows = random_rows(name, mesh)
    found = {"name": name, "vertices": len(mesh[0]), "seconds": seconds, "random": rows}
    found["predicted"] = predicted_rows(name, mesh, rows)
    for which, made in (("flat", flat), ("best", usual[0])):
        spread, angles = measured(mesh, made.signature, made.cones)
        found[which] = (made, spread, angles)
        print(f"{name}: {made.signature} {made.cones} predicted {made.predicted:.3f} measured {spread:.3f}", flush=True)
    return found


# ------------------------------------------------------------------------------------------------- writing

MEASURED = """## Measured

By `./build.sh docs cones`. The one-click suggestion is the best of the plane's signatures; where another one is better, it
follows. *Predicted* and *measured* are spreads of log area, measured ones from the embedding with conformal weights; *qc* is
its mean quasi-conformal error (1 is perfect; where a signature has a star, its tile is not conformal, and the prediction
counts angles too). *Random*: the best and the median of 200 random triples, really embedded (`442`, `432` and `237`, on a large
mesh in turn; on disks `*442`, `*432` and `*237` with corners on the border). *BFF*: the spread that the eight automatic cones of
boundary-first flattening leave, whose angles are arbitrary, so that nothing tiles. Seconds are the processor's, for all
usual suggestions together. Not listed: surfaces whose usual signature has no cones (kitten `o`, spread 1.66; three_holes `ooo`, 0.90).

| mesh | vertices | suggestion | cones | predicted | measured | qc | random: best | median | BFF | seconds |
|---|---|---|---|---|---|---|---|---|---|---|
{suggestions}

## Prediction against measurement

Over those random triples: the correlation of predicted and measured spread, and the slope through the origin.

{agreement}

![Predicted against measured spread, 442 blue, 432 green, 237 red](cones.svg)

What the prediction is: [mathematics.md](mathematics.md), section 8; what was tried: [decisions.md](decisions.md).
"""


def suggestion_rows(studies):
    for found in studies:
        spreads = np.array([row[2] for row in found["random"]])
        bff = SPHERES.get(found["name"])
        shown = ["flat"] if found["flat"][0].signature == found["best"][0].signature else ["flat", "best"]
        for which in shown:
            made, spread, angles = found[which]
            first = which == "flat"
            cells = [found["name"].split(".")[0] if first else "", found["vertices"] if first else ""]
            cells += [f"`{made.signature}`" + r" \*" * made.measured, ", ".join(map(str, made.cones))]
            cells += [f"{made.predicted:.2f}", f"{spread:.2f}", f"{angles:.2f}"]
            cells += [f"{spreads.min():.2f}", f"{np.median(spreads):.2f}"] if first else ["", ""]
            cells += ["" if bff is None or not first else f"{bff:.2f}", f"{found['seconds']:.1f}" if first else ""]
            yield f"| {' | '.join(map(str, cells))} |"


def agreement_rows(studies):
    yield f"| mesh | {' | '.join(SIGNATURES)} |"
    yield "|---" * (1 + len(SIGNATURES)) + "|"
    for found in studies:
        cells = []
        for signature in SIGNATURES:
            pairs = zip(found["predicted"], found["random"])
            both = [(said, row[2]) for said, row in pairs if row[0].lstrip("*") == signature]
            said, spread = np.array(both).T
            slope = said @ spread / (said @ said)
            cells.append(f"{_below_one(np.corrcoef(said, spread)[0, 1])}, {slope:.3f}")
        yield f"| {found['name'].split('.')[0]} | {' | '.join(cells)} |"


def _below_one(correlation):
    """0.99996 is not 1."""
    return f"{np.floor(correlation * 1e5) / 1e5:.5f}"


def picture(studies, size=480, margin=36):
    """Every random triple as a dot, as SVG: x predicted, y measured."""
    points = {signature: [] for signature in SIGNATURES}
    for found in studies:
        for said, (signature, _, spread) in zip(found["predicted"], found["random"]):
            points[signature.lstrip("*")].append((said, spread))
    most = np.ceil(max(max(p) for of in points.values() for p in of))
    scale = (size - 2 * margin) / most

    def at(x, y):
        return f"{margin + scale * x:.1f} {size - margin - scale * y:.1f}"

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size} {size}" width="{size}" height="{size}" '
        'font-family="sans-serif" font-size="11">',
        f'<rect width="{size}" height="{size}" fill="white"/>',
        f'<path d="M{at(0, 0)}L{at(most, most)}M{at(0, most)}L{at(0, 0)}L{at(most, 0)}" fill="none" stroke="#999"/>',
    ]
    for tick in range(1, int(most) + 1):
        x, y = at(tick, 0).split(), at(0, tick).split()
        lines.append(f'<text x="{x[0]}" y="{float(x[1]) + 14:.1f}" text-anchor="middle">{tick}</text>')
        lines.append(f'<text x="{float(y[0]) - 6:.1f}" y="{float(y[1]) + 4:.1f}" text-anchor="end">{tick}</text>')
    lines.append(f'<text x="{size / 2}" y="{size - 6}" text-anchor="middle">predicted spread of log area</text>')
    lines.append(f'<text x="10" y="{margin - 14}">measured</text>')
    for k, (signature, dots) in enumerate(points.items()):
        path = "".join(dict.fromkeys(f"M{at(*dot)}h0" for dot in dots))  # many are the same to a tenth of a pixel
        colour = COLOURS[signature]
        lines.append(f'<path d="{path}" stroke="{colour}" stroke-width="2" stroke-linecap="round" opacity="0.6"/>')
        lines.append(f'<text x="{margin + 12}" y="{margin + 6 + 16 * k}" fill="{colour}">{signature}</text>')
    return "\n".join([*lines, "</svg>"]) + "\n"


def main():
    there = [name for name in (*SPHERES, *DISKS) if (MESHES / name).is_file()]
    if not there:
        sys.exit("error: ../shared/meshes is not there, which this page is about")
    studies = [study(name) for name in there]
    text = MEASURED.format(
        suggestions="\n".join(suggestion_rows(studies)),
        agreement="\n".join(agreement_rows(studies)),
    )
    page = DOCS / "cones.md"
    words = page.read_text(encoding="utf-8").partition("## Measured")[0]
    page.write_text(words + text, encoding="utf-8")
    (DOCS / "cones.svg").write_text(picture(studies), encoding="utf-8")


if __name__ == "__main__":
    main()
