"""What the laws of tangential lift-off cost: in.impacts and in.drum by impulse and by estimate.

    . build/environment; build/venv/bin/python benchmarks/law_cost.py [--repeat N] [--out FILE]

The decks run with each law in turn, so that whatever else the machine does hits both; of each the run that took the
processor least is kept. Instructions of the fix's post_force in in.impacts are counted besides (valgrind), which do not
depend on the machine's load. The drum is a small and fast one, in which 87,000 collisions end and 16,000 grains leave.
"""

import argparse
import json
import resource
import subprocess
import tempfile
from pathlib import Path

from deck import read
from fix_cost import LMP, command, fix_instructions
from machine import description

LAWS = ("impulse", "estimate")
DRUM = {"carriers": "1000", "drum": "0.04", "lifter": "2e-3", "rate": "180", "turns": "0.3", "settle": "0.02"}
DRUM |= {"timestep": "3e-6"}
ROUGH = {"angle": "60", "wall_friction": "0.3"}
CASES = {
    "in.impacts": ("in.impacts", {}),
    "in.impacts, 60 degrees, wall friction 0.3": ("in.impacts", ROUGH),
    "in.drum, 1000 carriers": ("in.drum", DRUM),
}


def processor_seconds(deck: Path, variables: dict[str, str]) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(command(deck, variables), capture_output=True, check=True, cwd=deck.parent)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    result: dict = {**description(LMP), "repeats": args.repeat}
    with tempfile.TemporaryDirectory() as folder:
        for case, (name, variables) in CASES.items():
            path = Path(folder) / name  # what LAMMPS writes goes beside it
            path.write_text(read(name))
            cases = {law: variables | {"tangential": law} for law in LAWS}
            times: dict[str, list[float]] = {law: [] for law in LAWS}
            for _ in range(args.repeat):
                for law, words in cases.items():
                    times[law].append(processor_seconds(path, words))
            row: dict = {"processor_seconds": {law: min(times[law]) for law in LAWS}}
            if name == "in.impacts":
                row["instructions_fix"] = {law: fix_instructions(path, words)[0] for law, words in cases.items()}
            result[case] = row
            shares = {what: values["impulse"] / values["estimate"] for what, values in row.items()}
            print(f"{case}: impulse/estimate", *(f"{what} {share:.3f}" for what, share in shares.items()), flush=True)
    if args.out:
        args.out.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
