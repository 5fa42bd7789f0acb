"""What fix dust/detach costs in lammps-inputs/in.impacts: share of the loop time in free flight and in contact.

    . build/environment; build/venv/bin/python benchmarks/fix_cost.py [--repeat N] [--out FILE]

The deck runs with and without the fix in turn, so that whatever else the machine does hits both; the fastest run of
each, the least disturbed one, is compared. Contact: the deck as it is, 0.2 to 20 m/s, for the 2300 steps in which all
hundred carriers touch the wall: they lose up to 93 % of their grains meanwhile. Then the same at 60 degrees, also
with a wall friction that makes the acceleration turn. Free flight: no carrier touches the wall in 200,000 steps.
Instructions are counted besides if valgrind is there: they do not depend on the machine's load.
"""

import argparse
import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from deck import BUILD, changed, read
from machine import description, instructions

LMP = BUILD / "bin/lmp-dust"
CASES = {
    "free flight": {"flight": "400000", "limit": "200000"},
    "contact": {"limit": "2300"},
    "contact, 60 degrees": {"limit": "2300", "angle": "60"},
    "contact, 60 degrees, wall friction 0.3": {"limit": "2300", "angle": "60", "wall_friction": "0.3"},
}


def decks(folder: Path) -> dict[str, Path]:
    """in.impacts without its stop and its results, as it is and without the fix."""
    text = changed(read("in.impacts"), r"^(plugin load|fix +stop|variable +finished).*\n", times=3)
    text = changed(text, r"^write_dump (.*&\n)*.*\n")
    without = changed(text, r"^fix +dust (.*&\n)*.*\n")
    without = changed(without, r" f_dust\S*", times=None)
    paths = {"with": folder / "in.with", "without": folder / "in.without"}
    paths["with"].write_text(text)
    paths["without"].write_text(without)
    return paths


def command(deck: Path, variables: dict[str, str]) -> list[str]:
    words = [str(LMP), "-in", str(deck), "-log", "none"]
    for name, value in variables.items():
        words += ["-var", name, value]
    return words


def loop_time(deck: Path, variables: dict[str, str]) -> float:
    done = subprocess.run(command(deck, variables), capture_output=True, text=True, check=True, cwd=deck.parent)
    return float(re.search(r"^Loop time of (\S+)", done.stdout, re.MULTILINE)[1])


def fix_instructions(deck: Path, variables: dict[str, str]) -> list[int]:
    """Of the fix's post_force and of the whole time loop."""
    return instructions(
        command(deck, variables), deck.parent, r"FixDustDetach::post_force\(int\)", r"Verlet::run\(int\)"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=9)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    result: dict = {**description(LMP), "repeats": args.repeat}
    with tempfile.TemporaryDirectory() as folder:
        paths = decks(Path(folder))
        for case, variables in CASES.items():
            times: dict[str, list[float]] = {"with": [], "without": []}
            for _ in range(args.repeat):
                for which, path in paths.items():
                    times[which].append(loop_time(path, variables))
            with_fix, rest = (min(times[which]) for which in ("with", "without"))
            row = {
                "loop_seconds_with": with_fix,
                "loop_seconds_without": rest,
                "fix_share_of_loop": (with_fix - rest) / with_fix,
                "fix_against_rest": (with_fix - rest) / rest,
            }
            if shutil.which("valgrind"):
                shorter = variables | {"limit": str(min(int(variables["limit"]), 3000))}
                fix, loop = fix_instructions(paths["with"], shorter)
                row |= {"instructions_fix": fix, "instructions_loop": loop, "instructions_fix_share": fix / loop}
            result[case] = row
            print(
                f"{case}: the fix takes {100 * row['fix_share_of_loop']:.1f} % of the loop time, "
                f"{row['fix_against_rest']:.2f} of the rest of the step"
                + (
                    f"; {100 * row['instructions_fix_share']:.1f} % of the instructions"
                    if "instructions_fix" in row
                    else ""
                )
            )
    if args.out:
        args.out.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
