"""What fix dust/detach costs in beds: share of the loop in a settled bed and in in.drum, cost per carrier from a
thousand to a million of them, memory per carrier, two ranks against one, and carriers of many sizes.

    . build/environment; build/venv/bin/python benchmarks/bed_cost.py [--parts bed,drum,sizes,ranks,scaling]
        [--bed FILE] [--out FILE]

Segments with and without the fix follow each other in one run, which does not depend on the fix; medians of each are
compared, in processor time. A segment with the fix starts when the fix has been there for 60 steps. Bed: the settled
bed of pair_cost.py (`--bed FILE` is the one there), with the fix's defaults, and with counts yes. Drum: in.drum with
5000 carriers, filled, settled and turned for a while. Sizes: in.drum with carriers of 1 to 2 mm in 15 classes, and all
of them in one. Scaling: a dense granular gas (volume fraction 0.4, 0.1 m/s a direction, no losses, contacts softened
1000 times), in which every carrier is in the same state whatever their number. Memory: by how much the largest resident
size of the process grows with the fix. Ranks: the gas. Other work on
the machine disturbs all this.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import pair_cost
from deck import BUILD, changed, read
from machine import description

LMP = BUILD / "bin/lmp-dust"
DUST = (
    "fix dust all dust/detach texture monolayer 20e-6 coverage 0.2 seed 1 orientation random 1 stiffen 1000 rows no\n"
)
GAS = """units si
atom_style sphere
boundary p p p
newton off
comm_modify vel yes
lattice sc $(1.5e-3*(PI/6/0.4)^(1/3))
region box block 0 {x} 0 {y} 0 {z}
create_box 1 box
create_atoms 1 box
set group all diameter 1.5e-3 density 7700
variable speed atom 0.1*sqrt(3)*(2*random(0,1,4711)-1)
velocity all set v_speed v_speed v_speed
timestep 3e-6
neighbor 3e-4 bin
pair_style granular
pair_coeff * * hertz/material 2.1e8 1.0 0.3 tangential mindlin NULL 0.0 0.3 damping coeff_restitution/limited
fix move all nve/sphere
thermo 1000000
run {warm}
"""
SIZES = {1_000: (10, 10, 10), 10_000: (20, 25, 20), 100_000: (50, 50, 40), 1_000_000: (100, 100, 100)}


def run(deck: str, processes: int = 1) -> tuple[list[float], list[float]]:
    """Processor seconds of loops, mean of the ranks, and the largest resident sizes by `info memory`, in bytes."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "in.deck").write_text(deck)
        command = [str(LMP), "-in", "in.deck", "-log", "none"]
        if processes > 1:
            command = ["mpirun", "--bind-to", "core", "-np", str(processes), *command]
        environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder, env=environment, check=False)
    if done.returncode:
        sys.exit(f"{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    loops = re.findall(r"^Loop time of (\S+)[^%]*?^(\S+)% CPU use", done.stdout, re.MULTILINE)
    times = [float(loop) * float(use) / 100 for loop, use in loops]
    return times, [
        2.0**20 * float(size)
        for size in re.findall(r"^Maximum resident set size: (\S+) Mbyte", done.stdout, re.MULTILINE)
    ]


def compare(deck: str, fix: str, unfix: str, pairs: int, steps: int, carriers: int) -> dict[str, float]:
    """Segments with and without the fix in turn, after `deck`."""
    with_fix, without = f"{fix}run 60\nrun {steps}\n", f"{unfix}run {steps}\n"
    segments = f"info memory\n{with_fix}info memory\n{without}{(pairs - 1) * (with_fix + without)}"
    times, (before, after) = run(deck + segments)
    times = times[-3 * pairs :]
    middle = {"with": statistics.median(times[1::3]), "without": statistics.median(times[2::3])}
    row = {f"nanoseconds_per_carrier_and_step_{which}": 1e9 * time / steps / carriers for which, time in middle.items()}
    share = [(a - b) / a for a, b in zip(times[1::3], times[2::3], strict=True) if a > 0.0]
    return row | {
        "fix_share_of_loop": 1 - middle["without"] / middle["with"],
        "median_share_of_a_pair": statistics.median(share),
        "least_and_largest_share_of_a_pair": [min(share), max(share)],
        "bytes_per_carrier_of_lammps": before / carriers,
        "bytes_per_carrier_of_the_fix": (after - before) / carriers,
        "bytes": after,
    }


def drum_costs(text: str, carriers: int, more: tuple[str, ...] = ("",), pairs: int = 7) -> list[dict[str, float]]:
    """A deck made of in.drum, for each of `more` keywords of the fix."""
    fix = re.search(r"^fix +dust (.*&\n)*.*\n", text, re.MULTILINE)[0]
    fall = re.findall(r"^fix +fall .*\n", text, re.MULTILINE)[-1]
    deck = changed(text, re.escape(fix)).split('if "$(is_defined(variable,dump))"')[0]
    deck = changed(deck, r" f_dust\S*", times=None) + "thermo 1000000\nrun 3000\n"
    return [
        # gravity stands after the fix
        compare(deck, f"unfix fall\n{fix.rstrip()} {words}\n{fall}", "unfix dust\n", pairs, 200, carriers)
        for words in more
    ]


TIMESTEP = 3e-6
COUNTS = ("counts no", "counts yes")


def drum() -> dict[str, dict[str, float]]:
    carriers = 5000
    text = read("in.drum", carriers=carriers, drum=0.06, settle=0.02, timestep=TIMESTEP)
    return dict(zip(COUNTS, drum_costs(text, carriers, COUNTS), strict=True))


def bed(file: Path | None) -> dict[str, dict[str, float]]:
    with tempfile.TemporaryDirectory() as folder:
        data = (file or Path(folder) / "bed.data").resolve()
        if not data.exists():
            run(pair_cost.SETTLE.replace("bed.data", str(data)))
        model = pair_cost.OURS.format(e=0.5)
        rest = pair_cost.MOTION.format(every=1000000, steps=60)
        deck = (
            f"{pair_cost.BOX}\nread_data {data}\nneighbor 3.75e-4 bin\npair_style granular\npair_coeff * * {model}\n"
            f"fix floor all wall/gran granular {model} zplane 0.0 NULL\n{rest}"
        )
        fix = DUST.replace(" rows no", "").rstrip()
        down = "fix down all gravity 9.81 vector 0 0 -1\n"  # stands after the fix
        return {
            words: compare(deck, f"unfix down\n{fix} {words}\n{down}", "unfix dust\n", 7, 100, pair_cost.CARRIERS)
            for words in COUNTS
        }


def sizes() -> dict[str, float | dict[str, float]]:
    carriers = 20_000
    text = read("in.drum", carriers=carriers, carrier_diameter=2e-3, drum=0.133, timestep=TIMESTEP)
    anew = "variable size atom random(1e-3,2e-3,1)\nset type 1 diameter v_size\nset type 1 density 7700\n"
    text = changed(text, r"^(?=group +carriers )", anew)
    many, one = drum_costs(text, carriers, ("sizes 0.05", "sizes 1"))
    key = "nanoseconds_per_carrier_and_step_with"
    # each against its own segments without the fix: the two follow each other
    against_none = [row[key] / row[f"{key}out"] for row in (many, one)]
    return {"classes of 5 %": many, "one class": one, "many_against_one": against_none[0] / against_none[1]}


def ranks(repeats: int = 4) -> dict[str, float]:
    """100,000 carriers of the gas with the fix on one rank and on two in turn, the fastest of each; needs two cores."""
    x, y, z = SIZES[100_000]
    deck = GAS.format(x=x, y=y, z=z, warm=60) + DUST + "run 300\n"
    times = [[run(deck, n)[0][-1] / 300 for n in (1, 2)] for _ in range(repeats)]
    one, two = map(min, zip(*times, strict=True))
    return {"seconds_per_step_on_one": one, "seconds_per_step_on_two": two, "two_against_one": one / two}


def scaling() -> dict[str, dict[str, float]]:
    result = {}
    for carriers, (x, y, z) in SIZES.items():
        steps, pairs = 30, min(100, max(3, 900_000 // carriers))  # the fix is as old in all of them
        deck = GAS.format(x=x, y=y, z=z, warm=400)  # at first nothing touches
        result[f"{carriers}"] = compare(deck, DUST, "unfix dust\n", pairs, steps, carriers)
        print(carriers, json.dumps(result[f"{carriers}"]), flush=True)
    return result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parts", default="bed,drum,sizes,ranks,scaling", help="the others keep their results in FILE")
    parser.add_argument("--bed", type=Path, help="where the carriers of the settled bed lie; written if absent")
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    result: dict = json.loads(args.out.read_text()) if args.out and args.out.exists() else {}
    for part in args.parts.split(","):
        parts = {"bed": lambda: bed(args.bed), "drum": drum, "sizes": sizes, "ranks": ranks, "scaling": scaling}
        result[part] = {**description(LMP), "load_average": os.getloadavg()[0], **parts[part]()}
        print(part, json.dumps(result[part]), flush=True)
        if args.out:
            args.out.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
