"""What the pair force costs: a settled bed and a resolved impact, against LAMMPS' own loop and styles and LIGGGHTS.

    . build/environment; build/venv/bin/python benchmarks/pair_cost.py [--repeat N] [--parts bed,resolved]
        [--before FOLDER] [--bed FILE] [--out FILE]

CPU time (user and system) of whole processes; variants run in turn, so that whatever else the machine does hits all,
and medians over the repeats are given, of times and of ratios within a repeat. `--before` names the folder of a plugin
that was built earlier: the same models by the code of then.

bed: 20,000 carriers that lie still on a floor, periodic to the sides, for 1000 steps. They settle once, by our plugin,
in two minutes; `--bed FILE` keeps where they lie, or reads it if it is there. LAMMPS' granular has its own
coeff_restitution with limit_damping; gran/hertz/history and LIGGGHTS' hertz with tangential history have the same
stiffness and friction. Their damping is another, which in a bed at rest costs the same.
resolved: in.impact.resolved, in free flight at rest, where each grain has one contact, and whole. At rest the loop
alone: what 2500 steps take more than 500, by steps and grains, so that start-up cancels, and in it LAMMPS' Pair time.
The stock contact is that of resolved_cost.py, those of LIGGGHTS and YADE are told in other_programs.py. A program that
is not installed (Debian: liggghts, yade) is left out.
"""

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import other_programs
from deck import INPUTS, PLUGIN
from machine import description
from resolved_cost import LMP, at_rest, stock, uncounted

CARRIERS = 20_000
STEPS = 1000  # of the bed
FLIGHT, FEW = 2500, 500  # of the impact at rest
GRAINS = 4500
KN, KT = 1.5384615384615e8, 1.9004524886878e8  # of hertz/material 2.1e8 with nu 0.3: 4/3 E*, 8 G*
OURS = "hertz/material 2.1e8 {e} 0.3 tangential mindlin NULL 0.0 0.3 damping coeff_restitution/limited"
OWN = "hertz/material 2.1e8 0.5 0.3 tangential mindlin NULL 0.0 0.3 damping coeff_restitution limit_damping"

BOX = """
units si
atom_style sphere
boundary p p f
newton off
comm_modify vel yes
timestep 3e-6
"""
MOTION = """
fix move all nve/sphere
fix down all gravity 9.81 vector 0 0 -1
thermo {every}
thermo_style custom step ke
run {steps}
"""
SETTLE = f"""{BOX}
region box block 0 0.034 0 0.034 0 0.085
create_box 1 box
lattice sc 1.7e-3 origin 0.5 0.5 0.5
create_atoms 1 box
displace_atoms all random 5e-5 5e-5 5e-5 4711
set group all diameter 1.5e-3 density 7700
neighbor 3.75e-4 bin
pair_style granular
pair_coeff * * {OURS.format(e=0.2)}
fix floor all wall/gran granular {OURS.format(e=0.2)} zplane 0.0 NULL
{MOTION.format(every=5000, steps=60000)}
write_data bed.data nocoeff
"""
LIGGGHTS = f"""
units si
atom_style granular
atom_modify map array
boundary p p f
newton off
communicate single vel yes
read_data bed.liggghts
neighbor 3.75e-4 bin
fix young all property/global youngsModulus peratomtype 2.1e8
fix poisson all property/global poissonsRatio peratomtype 0.3
fix restitution all property/global coefficientRestitution peratomtypepair 1 0.5
fix friction all property/global coefficientFriction peratomtypepair 1 0.3
pair_style gran model hertz tangential history
pair_coeff * *
timestep 3e-6
fix floor all wall/gran model hertz tangential history primitive type 1 zplane 0.0
{MOTION.format(every=STEPS, steps=STEPS)}
"""


def bed_deck(pair: str, wall: str) -> str:
    return (
        f"{BOX}\nread_data bed.data\nneighbor 3.75e-4 bin\n{pair}\n"
        f"fix floor all wall/gran {wall} zplane 0.0 NULL\n{MOTION.format(every=STEPS, steps=STEPS)}"
    )


def cpu_seconds(command: list[str], folder: Path) -> tuple[float, str]:
    """Of a process, and what it printed."""
    with open(folder / "out", "w+") as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.STDOUT, cwd=folder)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read()
    if process.returncode:
        raise RuntimeError(f"{' '.join(command)} failed:\n{text[-2000:]}")
    return usage.ru_utime + usage.ru_stime, text


def pair_seconds(text: str) -> float:
    """CPU time of the pair styles, over all runs of a process."""
    total = 0.0
    for loop in re.split(r"^Loop time of ", text, flags=re.MULTILINE)[1:]:
        use = re.search(r"^([\d.]+)% CPU use", loop, re.MULTILINE)
        pair = re.search(r"^Pair *\| *(\S+)", loop, re.MULTILINE)
        total += (float(use[1]) / 100 if use else 1.0) * (float(pair[1]) if pair else 0.0)
    return total


def lammps(deck: Path, plugin: Path | None = None, **variables: str) -> list[str]:
    words = [str(LMP), "-in", str(deck), "-log", "none"]
    for name, value in ({"plugin": str(plugin)} if plugin else {}).items() | variables.items():
        words += ["-var", name, value]
    return words


def in_turn(variants: dict[str, list[str]], repeat: int, folder: Path) -> dict[str, dict]:
    """Medians for each variant; ratios are those of the first one to it, within a repeat."""
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in variants}
    for _ in range(repeat):
        for name, command in variants.items():
            seconds, text = cpu_seconds(command, folder)
            times[name].append((seconds, pair_seconds(text)))
            print(f"{name}: {seconds:.2f} s", flush=True)
    ours = times[next(iter(variants))]
    result = {}
    for name, made in times.items():
        result[name] = {
            "process_seconds": statistics.median(seconds for seconds, _ in made),
            "pair_seconds": statistics.median(pair for _, pair in made),
            "ours_against_it": statistics.median(a[0] / b[0] for a, b in zip(ours, made, strict=True)),
            "least_and_largest": [f(a[0] / b[0] for a, b in zip(ours, made, strict=True)) for f in (min, max)],
        }
        if all(pair for _, pair in made):
            result[name]["ours_against_it_in_pair"] = statistics.median(
                a[1] / b[1] for a, b in zip(ours, made, strict=True)
            )
    return result


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / f"in.{name}"
    path.write_text(text)
    return path


def bed(folder: Path, repeat: int, before: Path | None, kept: Path | None) -> dict:
    load = "plugin load ${plugin}\n"
    if kept and kept.exists():
        shutil.copy(kept, folder / "bed.data")
    else:
        cpu_seconds(lammps(write(folder, "settle", load + SETTLE), PLUGIN), folder)
        if kept:
            shutil.copy(folder / "bed.data", kept)
    # LIGGGHTS reads the same lines without image flags
    data = (folder / "bed.data").read_text().replace("Atoms # sphere", "Atoms")
    data = re.sub(r"^((?:\S+ ){6}\S+) -?\d+ -?\d+ -?\d+$", r"\1", data, flags=re.MULTILINE)
    (folder / "bed.liggghts").write_text(data)

    law = OURS.format(e=0.5)
    ours = write(folder, "ours", load + bed_deck(f"pair_style granular\npair_coeff * * {law}", f"granular {law}"))
    own = write(folder, "own", bed_deck(f"pair_style granular\npair_coeff * * {OWN}", f"granular {OWN}"))
    hertz = f"{KN} {KT} 1e6 0 0.3 0"
    fixed = write(
        folder, "hertz", bed_deck(f"pair_style gran/hertz/history {hertz}\npair_coeff * *", f"hertz/history {hertz}")
    )
    variants = {"ours": lammps(ours, PLUGIN)}
    if before:
        variants["before"] = lammps(ours, before)
    variants["LAMMPS granular"] = lammps(own)
    variants["LAMMPS gran/hertz/history"] = lammps(fixed)
    if other_programs.is_there("liggghts"):
        variants["LIGGGHTS"] = ["liggghts", "-in", str(write(folder, "liggghts", LIGGGHTS)), "-log", "none"]
    return {
        "carriers": CARRIERS,
        "steps": STEPS,
        "variants": in_turn(variants, repeat, folder),
    }


def by_steps(variants: dict[str, Callable[[int], list[str]]], repeat: int, folder: Path) -> dict[str, dict]:
    """As `in_turn`, of the loop at rest alone: what FLIGHT steps take more than FEW, so that the start cancels."""
    loops: dict[str, list[float]] = {name: [] for name in variants}
    pairs: dict[str, list[float]] = {name: [] for name in variants}
    contacts: dict[str, int] = {}
    for _ in range(repeat):
        for name, command in variants.items():
            few, _ = cpu_seconds(command(FEW), folder)
            seconds, text = cpu_seconds(command(FLIGHT), folder)
            scale = 1e9 / GRAINS
            loops[name].append(scale * (seconds - few) / (FLIGHT - FEW))
            pairs[name].append(scale * pair_seconds(text) / FLIGHT)
            if told := re.search(r"^contacts: (\d+)", text, re.MULTILINE):
                contacts[name] = int(told[1])
            print(f"{name}: {loops[name][-1]:.0f} ns per contact and step", flush=True)
    ours = next(iter(variants))
    result = {}
    for name, made in loops.items():
        ratios = [a / b for a, b in zip(loops[ours], made, strict=True)]
        result[name] = {
            "ns_per_contact_and_step": statistics.median(made),
            "least_and_largest_ns": [min(made), max(made)],
            "ours_against_it": statistics.median(ratios),
            "least_and_largest": [min(ratios), max(ratios)],
        }
        if all(pairs[name]):
            result[name]["ns_in_pair"] = statistics.median(pairs[name])
            result[name]["ours_against_it_in_pair"] = statistics.median(
                a / b for a, b in zip(pairs[ours], pairs[name], strict=True)
            )
        if name in contacts:
            result[name]["contacts_in_the_end"] = contacts[name]
    return result


def resolved(folder: Path, repeat: int, before: Path | None, _: Path | None) -> dict:
    text = uncounted((INPUTS / "in.impact.resolved").read_text())
    ours, own = write(folder, "ours", at_rest(text)), write(folder, "own", at_rest(stock(text)))
    dump = "write_dump all custom grains type x y z radius modify format float %.17g\n"
    cpu_seconds(lammps(write(folder, "start", at_rest(text) + dump), PLUGIN, rest="0"), folder)
    variants = {"ours": lambda steps: lammps(ours, PLUGIN, rest=str(steps))}
    if before:
        variants["before"] = lambda steps: lammps(ours, before, rest=str(steps))
    variants["LAMMPS jkr, sds"] = lambda steps: lammps(own, PLUGIN, rest=str(steps))
    if other_programs.is_there("liggghts"):
        plain, rolling = other_programs.liggghts(folder), other_programs.liggghts(folder, "epsd2")
        variants["LIGGGHTS hertz, sjkr"] = lambda steps: [*plain, str(steps)]
        variants["LIGGGHTS hertz, sjkr, epsd2"] = lambda steps: [*rolling, str(steps)]
    if other_programs.is_there("yade"):
        variants["YADE Hertz-Mindlin, DMT"] = lambda steps: other_programs.yade(folder, steps)
    at = by_steps(variants, repeat, folder)
    whole = {"ours": lammps(INPUTS / "in.impact.resolved", PLUGIN)}
    if before:
        whole["before"] = lammps(INPUTS / "in.impact.resolved", before)
    return {"at rest": at, "whole": in_turn(whole, max(1, repeat // 2), folder)}


PARTS = {"bed": bed, "resolved": resolved}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=7)
    parser.add_argument("--parts", default=",".join(PARTS), help="the others keep their results in FILE")
    parser.add_argument("--before", type=Path, help="folder of an earlier dustplugin.so and dust_styles.so")
    parser.add_argument("--bed", type=Path, help="where the settled bed is kept")
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    before = args.before.resolve() / "dustplugin.so" if args.before else None
    result: dict = json.loads(args.out.read_text()) if args.out and args.out.exists() else {}
    for part in args.parts.split(","):
        with tempfile.TemporaryDirectory() as folder:
            result[part] = {
                **description(LMP),
                "repeats": args.repeat,
                **PARTS[part](Path(folder), args.repeat, before, args.bed),
            }
        print(part, json.dumps(result[part], indent=1), flush=True)
        if args.out:
            args.out.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
