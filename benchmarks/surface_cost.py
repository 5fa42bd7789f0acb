"""What walls of triangles cost against a plane: 2000 carriers bounce on a floor of one plane, or of 2 to 10,000
triangles from an STL file, with fix dust/detach.

    . build/environment; build/venv/bin/python benchmarks/surface_cost.py [--repeat N] [--out FILE]

The cases run in turn, so that whatever else the machine does hits all; the least processor time of each, less that of
a run without steps, counts. A triangle of 10,000 is about a carrier wide.
"""

import argparse
import json
import math
import os
import re
import resource
import subprocess
import tempfile
from pathlib import Path

from machine import description

ROOT = Path(__file__).resolve().parents[1]
LMP = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build")) / "bin/lmp-dust"
SIZE = 0.1  # m
STEPS = 5000
TRIANGLES = [2, 100, 1000, 10000]
STEEL = "hertz/material 210e6 0.7 0.3 tangential mindlin NULL 0.0 0.3 damping coeff_restitution/limited"
DECK = """units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes
region box block 0 {size} 0 {size} -0.005 0.02 units box
create_box 1 box
lattice sc {spacing} origin 0.25 0.25 0.25
region low block 0.002 {inner} 0.002 {inner} 0 1e-3 units box
create_atoms 1 region low
set group all diameter 1.5e-3
set group all density 7700
displace_atoms all move 0 0 1e-3 units box
displace_atoms all random 1e-4 1e-4 1e-4 1 units box
timestep 2e-6
neighbor 4e-4 bin
pair_style granular
pair_coeff * * {steel}
fix move all nve/sphere
{wall}
fix dust all dust/detach texture monolayer 20e-6 coverage 0.2 seed 1 orientation random 1 stiffen 1000 rows no
fix fall all gravity 9.81 vector 0 0 -1
velocity all set 0.2 0.1 -0.5 units box
thermo 0
run {steps}
"""


def write_stl(path: Path, triangles: int) -> int:
    """A floor at z = 0 of about so many triangles, in rows of squares with a diagonal each; returns how many."""
    n = max(1, round(math.sqrt(triangles / 2)))
    corner = [-0.01 + (SIZE + 0.02) * k / n for k in range(n + 1)]
    facets = []
    for i in range(n):
        for j in range(n):
            a, b, c, d = ((corner[i + p], corner[j + q], 0.0) for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)))
            facets += [(a, b, c), (a, c, d)]
    with open(path, "w", encoding="ascii") as out:
        out.write("solid floor\n")
        for facet in facets:
            vertices = "".join("vertex {:.9g} {:.9g} {:.9g}\n".format(*vertex) for vertex in facet)
            out.write(f"facet normal 0 0 1\nouter loop\n{vertices}endloop\nendfacet\n")
        out.write("endsolid floor\n")
    return len(facets)


def run(wall: str, steps: int, folder: Path) -> tuple[float, str]:
    """Processor time in seconds, and what LAMMPS says."""
    deck = folder / "in.cost"
    words = {"size": SIZE, "spacing": 2.1e-3, "inner": SIZE - 0.002, "steel": STEEL, "wall": wall, "steps": steps}
    deck.write_text(DECK.format(**words) + 'print "ratio $(f_dust:%.6f)"\n')
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([LMP, "-in", deck, "-log", "none"], cwd=folder, capture_output=True, text=True, check=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, done.stdout


def cost(wall: str, folder: Path) -> dict[str, float]:
    """Seconds a step, number of carriers, dispersion ratio."""
    start, _ = run(wall, 0, folder)
    seconds, said = run(wall, STEPS, folder)
    atoms = int(re.search(r"^Loop time of .* steps with (\d+)", said, re.M)[1])
    ratio = float(re.search(r"^ratio (\S+)", said, re.M)[1])
    return {"seconds": (seconds - start) / STEPS, "atoms": atoms, "ratio": ratio}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    results = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        walls = {"plane": f"fix wall all wall/gran granular {STEEL} zplane 0.0 NULL"}
        for triangles in TRIANGLES:
            made = write_stl(folder / f"{triangles}.stl", triangles)
            walls[f"{made} triangles"] = (
                f"fix wall all surface/global input stl 1 1 {triangles}.stl model * * granular {STEEL}"
            )
        for _ in range(options.repeat):
            for what, wall in walls.items():
                case = cost(wall, folder)
                best = results.setdefault(what, case)
                best["seconds"] = min(best["seconds"], case["seconds"])
    plane = results["plane"]["seconds"]
    for what, run in results.items():
        run["of plane"] = round(run["seconds"] / plane, 3)
        print(
            f"{what:16} {1e6 * run['seconds']:8.1f} us a step, {run['of plane']:.2f} of the plane, ratio {run['ratio']}"
        )
    if options.out:
        options.out.write_text(
            json.dumps({**description(LMP), "repeats": options.repeat, "cases": results}, indent=1) + "\n"
        )


if __name__ == "__main__":
    main()
