"""A bed at rest and a bed that falls, in.drop: what comes off, and what that depends on.

    . build/environment; build/venv/bin/python benchmarks/beds.py [--carriers N] [--steps N] [--out FILE]

At rest: the settled heap stays in its tube for a million steps. Fall: the heap falls from 1 m with several texture
seeds, and, with seed 1, on another number of ranks, with other output, with another skin of the neighbour lists, in
the fall alone and from the start, which makes another heap. A bed is chaotic: what changes the last digit of a force
changes what each carrier does, so that these are compared with the scatter over the seeds. The same run twice must
detach the same grains, down to the last digit of every row. Writes FILE and prints it in words.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import tempfile
from pathlib import Path

from deck import BUILD, ROOT, changed, read
from machine import description

LMP = BUILD / "bin/lmp-dust"
ROWS = " ".join(f"f_dust[{i}]" for i in range(1, 12))
TIMESTEP = "2e-6"  # s
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def run(carriers: int, ranks: int = 1, fall: str = "", **variables: str) -> dict:
    """Mass that comes off at rest (kg), the fall's dispersion ratio and its rows (sorted); ``fall``: command for it."""
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "in.drop"
        # every detachment, to the last digit
        dump = f"{fall}\ndump rows all local ${{every}} rows {ROWS}\ndump_modify rows format float %.17g\n"
        deck.write_text(changed(read("in.drop"), r"^(?=fix +field )", dump))
        command = [] if ranks == 1 else ["mpirun", "--oversubscribe", "-np", str(ranks)]
        command += [str(LMP), "-in", str(deck), "-log", "none", "-var", "carriers", str(carriers)]
        for name, value in {"timestep": TIMESTEP, **variables}.items():
            command += ["-var", name, value]
        done = subprocess.run(command, cwd=folder, env=os.environ | AS_ROOT, capture_output=True, text=True, check=True)
        masses = re.search(r"at rest (\S+) kg came off, by the fall (\S+) kg of (\S+) kg", done.stdout)
        rest, lost, total = map(float, masses.groups())
        lines = (Path(folder) / "rows").read_text().splitlines()
        rows = sorted(line for line in lines if line.count(" ") >= 10 and line[0] != "I")
    return {"rest": rest, "ratio": lost / total, "rows": rows}


OTHERS = {
    "again": {},
    "2 ranks": {"ranks": 2},
    "windows of 40 steps": {"every": "40"},
    "skin 0.4 of a diameter": {"fall": "neighbor 0.6e-3 bin"},
    "skin 0.1 of a diameter": {"fall": "neighbor 0.15e-3 bin"},
    "skin 0.4 of a diameter, also to settle": {"skin": "0.4"},
    "skin 0.1 of a diameter, also to settle": {"skin": "0.1"},
}


def falls(carriers: int, seeds: int) -> dict:
    """Dispersion ratios of the fall over the seeds, and of seed 1 with other settings."""
    runs = [run(carriers, seed=str(seed)) for seed in range(1, seeds + 1)]
    ratios = [one["ratio"] for one in runs]
    spread = {"mean": statistics.mean(ratios), "standard_deviation": statistics.stdev(ratios)}
    result = {"seeds": ratios, **spread, "seed 1": {}}
    print(
        f"{seeds} seeds: {result['mean']:.5f}, standard deviation {result['standard_deviation']:.5f}, "
        f"range {min(ratios):.5f} to {max(ratios):.5f}",
        flush=True,
    )
    for name, changes in OTHERS.items():
        other = run(carriers, **changes)
        same = other["rows"] == runs[0]["rows"]
        result["seed 1"][name] = {"ratio": other["ratio"], "difference": other["ratio"] - ratios[0], "same_rows": same}
        print(
            f"{name}: {other['ratio']:.5f}, difference {other['ratio'] - ratios[0]:+.5f}, "
            f"{'the same' if same else 'other'} {len(other['rows'])} rows",
            flush=True,
        )
    return result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--carriers", type=int, default=300)
    parser.add_argument("--steps", type=int, default=1_000_000, help="at rest")
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--out", type=Path, default=ROOT / "benchmarks/beds.json")
    args = parser.parse_args()
    result: dict = {**description(LMP), "carriers": args.carriers, "steps_at_rest": args.steps}

    still = run(args.carriers, rest=str(float(TIMESTEP) * args.steps), height="0", splash="0")
    result["mass_at_rest"] = still["rest"]
    print(f"at rest for {args.steps} steps: {still['rest']} kg", flush=True)

    result["fall"] = falls(args.carriers, args.seeds)
    args.out.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
