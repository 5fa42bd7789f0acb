"""What a resolved impact costs: a contact against LAMMPS' own jkr and sds, an impact against one by the functions.

    . build/environment; build/venv/bin/python benchmarks/resolved_cost.py [--repeat N] [--parts contact,impact,skin]
        [--out FILE]

All runs use the plugin in one stock LAMMPS and lammps-inputs/in.impact.resolved, cut short or with other lines where
said. Variants run in turn, so that whatever else the machine does hits all; the fastest run of each is compared. Times
are the CPU's: LAMMPS' wall times times the CPU use it prints below them.
contact: Pair time by steps and grains, in free flight at rest, where each grain has one contact, and through the
reference case's collision. The other contact is jkr + mindlin + sds + viscoelastic with the same E, eta, nu and
friction; jkr's cohesion is gamma = A/(18 pi z0^2), as LAMMPS' pull-off force is 3 pi gamma R_eff, and sds has our
stiffness and limit at the equilibrium overlap. In the collision the two lose different grains, so there the contacts
are counted, in another run.
impact: the whole deck, two cases, against the same impacts in in.impacts, a hundred at once, and in in.impact, again
and again in one process.
skin: the first 9 us, through the collision, by neighbor skin in grain diameters; no skin changes what detaches.
Instructions are counted besides if valgrind is there: they do not depend on the machine's load.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from deck import BUILD, INPUTS, PLUGIN, changed
from machine import description, instructions

LMP = BUILD / "bin/lmp"
CASES = {"8 m/s": {}, "12 m/s, 60 degrees": {"speed": "12", "angle": "60"}}
SKINS = (0.25, 0.5, 0.75, 1.0, 1.5)
AT_ONCE = 100  # carriers in in.impacts
FLIGHT = 2500  # steps
COUNTED = 200  # steps under valgrind
SKIN_TIME = "9e-6"


def uncounted(text: str) -> str:
    """Without the state of the grains, which LAMMPS' own contact does not have."""
    text = changed(text, r"^(compute +tied|variable +held|compute +held|variable +ratio) .*\n", times=4)
    return changed(text, r"^thermo_style .*c_tied.*", "thermo_style custom step cpu")


def stock(text: str) -> str:
    """The same grains with LAMMPS' own contact."""
    gamma = "$(v_{}/(18*PI*v_z0^2))"
    ours = {
        "${hamaker_wall} ${z0} ${slide}": gamma.format("hamaker_wall"),
        "$(v_hamaker1) ${z0} ${slide}": gamma.format("hamaker1"),
        "${hamaker_grains} ${z0} ${slide}": gamma.format("hamaker_grains"),
    }
    for words, cohesion in ours.items():
        stiffness = cohesion.replace("$(", "$(12*PI*")
        text = changed(
            text,
            re.escape(words),
            f"{cohesion} tangential mindlin NULL 0.0 ${{friction}} damping viscoelastic "
            f"rolling sds {stiffness} 0.0 $(2*v_theta_crit)",
            times=None,
        )
    return changed(text, r"\bjkr/vdw\b", "jkr", times=4)


def at_rest(text: str) -> str:
    text = changed(text, r"^fix +begin .*\n")
    setup = text.split('print           "Approach"')[0]
    return setup + "velocity all set 0.0 0.0 0.0\nrun ${rest}\n"


def collision(text: str) -> str:
    return text.split("# north:")[0]


def count_contacts(text: str) -> str:
    """Pairs that overlap, every fiftieth step; to be timed it is too slow."""
    counting = (
        "compute touching all contact/atom\ncompute touches all reduce sum c_touching\nthermo 50\n"
        "thermo_style custom step c_touches\nthermo_modify lost ignore norm no\n"
    )
    return text.replace('print           "Collision"', counting + 'print           "Collision"')


def first_microseconds(text: str, skin: float) -> str:
    text = changed(text, r"^variable +more .*", f"variable more equal round({SKIN_TIME}/v_timestep)")
    return changed(text, r"^neighbor +\$\{grain_diameter\}", f"neighbor $({skin}*v_grain_diameter)")


class Run:
    """One LAMMPS process: what its output says, summed over its run commands, and what it took altogether."""

    def __init__(self, deck: Path, variables: dict[str, str] | None = None) -> None:
        words = [
            str(LMP),
            "-in",
            str(deck),
            "-log",
            "none",
            "-var",
            "plugin",
            str(PLUGIN),
        ]
        for name, value in (variables or {}).items():
            words += ["-var", name, value]
        with open(deck.with_name(f"{deck.name}.out"), "w+") as out:
            process = subprocess.Popen(words, stdout=out, stderr=subprocess.STDOUT, cwd=deck.parent)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            self.text = out.read()
        if process.returncode:
            raise RuntimeError(f"{' '.join(words)} failed:\n{self.text[-2000:]}")
        self.process_seconds = usage.ru_utime + usage.ru_stime
        self.megabytes = usage.ru_maxrss / 1024
        self.steps = 0
        self.wall_seconds = self.loop_seconds = self.pair_seconds = self.neigh_seconds = 0.0
        for loop in re.split(r"^Loop time of ", self.text, flags=re.MULTILINE)[1:]:
            seconds, steps = re.match(r"(\S+) on \d+ procs for (\d+) steps", loop).groups()
            use = re.search(r"^([\d.]+)% CPU use", loop, re.MULTILINE)
            pair, neigh = (re.search(rf"^{section} *\| *(\S+)", loop, re.MULTILINE) for section in ("Pair", "Neigh"))
            share = float(use[1]) / 100 if use else 1.0  # not said with post no
            self.steps += int(steps)
            self.wall_seconds += float(seconds)
            self.loop_seconds += share * float(seconds)
            self.pair_seconds += share * float(pair[1]) if pair else 0.0
            self.neigh_seconds += share * float(neigh[1]) if neigh else 0.0

    def number(self, pattern: str) -> float:
        return float(re.search(pattern, self.text)[1])


def fastest(variants: dict, repeat: int) -> dict[str, list[Run]]:
    """Runs of each variant, a deck and variables, in turn; the fastest first."""
    runs: dict[str, list[Run]] = {name: [] for name in variants}
    for _ in range(repeat):
        for name, (deck, variables) in variants.items():
            runs[name].append(Run(deck, variables))
    return {name: sorted(made, key=lambda run: run.loop_seconds) for name, made in runs.items()}


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / f"in.{name.replace(' ', '_')}"
    path.write_text(text)
    return path


def pair_instructions(deck: Path, variables: dict[str, str]) -> int:
    words = [str(LMP), "-in", str(deck), "-log", "none", "-var", "plugin", str(PLUGIN)]
    for name, value in variables.items():
        words += ["-var", name, value]
    return instructions(words, deck.parent, r"PairGranular(?:Fused)?::compute\(int")[0]


def contact(folder: Path, repeat: int) -> dict:
    text = uncounted((INPUTS / "in.impact.resolved").read_text())
    models = {"jkr/vdw, dominik/tielens": text, "jkr, sds": stock(text)}
    result: dict = {}
    for case, cut in (("free flight at rest", at_rest), ("collision", collision)):
        variables = {"rest": str(FLIGHT)}
        decks = {name: write(folder, f"{case}.{k}", cut(words)) for k, (name, words) in enumerate(models.items())}
        runs = fastest({name: (deck, variables) for name, deck in decks.items()}, repeat)
        result[case] = {}
        for name, made in runs.items():
            run = made[0]
            grains = run.number(r"(\d+) atoms in group dust")
            contacts = grains
            if cut is collision:
                counted = Run(
                    write(folder, "counted", count_contacts(cut(models[name]))),
                    variables,
                )
                table = counted.text.split("Collision")[1]
                sums = [float(row) for row in re.findall(r"^ +\d+ +(\d+) *$", table, re.MULTILINE)]
                contacts = sum(sums) / len(sums) / 2  # both atoms of a pair count it
            pair = min(other.pair_seconds for other in made)
            row = {
                "grains": int(grains),
                "contacts": round(contacts),
                "steps": run.steps,
                "pair_seconds": pair,
                "ns_per_contact_and_step": 1e9 * pair / (run.steps * contacts),
                "ns_slowest_repeat": 1e9 * max(other.pair_seconds for other in made) / (run.steps * contacts),
            }
            if shutil.which("valgrind") and cut is at_rest:
                none, some = (pair_instructions(decks[name], {"rest": str(steps)}) for steps in (0, COUNTED))
                row["instructions_per_contact_and_step"] = (some - none) / (COUNTED * contacts)
            result[case][name] = row
            print(
                f"{case}, {name}: {row['ns_per_contact_and_step']:.0f} ns per contact and step, {contacts:.0f} contacts"
                + (
                    f", {row['instructions_per_contact_and_step']:.0f} instructions"
                    if "instructions_per_contact_and_step" in row
                    else ""
                ),
                flush=True,
            )
        ours, theirs = result[case].values()
        for key in ("ns_per_contact_and_step", "instructions_per_contact_and_step"):
            if key in ours:
                result[case][f"ratio of {key.split('_')[0]}"] = ours[key] / theirs[key]
        print(
            f"{case}: " + ", ".join(f"{key} {value:.2f}" for key, value in result[case].items() if "ratio" in key),
            flush=True,
        )
    return result


def impact(folder: Path, repeat: int) -> dict:
    many = (INPUTS / "in.impacts").read_text()
    many = changed(many, r"^variable +speed +atom .*", "variable speed atom v_fastest")  # all with the same
    again = write(
        folder,
        "again",
        f"variable again loop {AT_ONCE}\nlabel one\nclear\ninclude {INPUTS / 'in.impact'}\nnext again\njump SELF one\n",
    )
    resolved = write(folder, "resolved", (INPUTS / "in.impact.resolved").read_text())
    result: dict = {}
    for case, variables in CASES.items():
        at_once = {
            "fastest": variables.get("speed", "8.0"),
            "angle": variables.get("angle", "90"),
        }
        runs = fastest(
            {
                "resolved": (resolved, variables),
                "at once": (write(folder, "many", many), at_once),
                "again": (again, variables),
            },
            repeat,
        )
        run = runs["resolved"][0]
        row: dict = {
            "resolved": {
                "grains": int(run.number(r"(\d+) atoms in group dust")),
                "steps": run.steps,
                "loop_seconds": run.loop_seconds,
                "loop_wall_seconds": run.wall_seconds,
                "ms_per_step": 1e3 * run.loop_seconds / run.steps,
                "process_seconds": run.process_seconds,
                "megabytes": max(other.megabytes for other in runs["resolved"]),
                "dispersion_ratio": run.number(r"dispersion ratio ([\d.]+)"),
            }
        }
        for name, label in (
            ("at once", "functions, 100 carriers in in.impacts"),
            ("again", "functions, in.impact 100 times"),
        ):
            loop = runs[name][0].loop_seconds / AT_ONCE
            process = min(other.process_seconds for other in runs[name]) / AT_ONCE
            row[label] = {
                "loop_seconds_per_impact": loop,
                "process_seconds_per_impact": process,
                "ratio of loops": row["resolved"]["loop_seconds"] / loop,
                "ratio of processes": row["resolved"]["process_seconds"] / process,
            }
            print(
                f"{case}, {label}: {1e3 * loop:.2f} ms of loop an impact, {1e3 * process:.2f} ms of the process; "
                f"resolved takes {row[label]['ratio of loops']:.0f} and {row[label]['ratio of processes']:.0f} times "
                "that",
                flush=True,
            )
        print(
            f"{case}, resolved: {run.loop_seconds:.1f} s of loop, {run.steps} steps, "
            f"{row['resolved']['ms_per_step']:.2f} ms "
            f"a step, {row['resolved']['megabytes']:.0f} MB",
            flush=True,
        )
        result[case] = row
    return result


def skin(folder: Path, repeat: int) -> dict:
    text = (INPUTS / "in.impact.resolved").read_text()
    decks = {str(wide): (write(folder, f"skin{k}", first_microseconds(text, wide)), {}) for k, wide in enumerate(SKINS)}
    result = {}
    for name, made in fastest(decks, repeat).items():
        run = made[0]
        builds = sum(int(number) for number in re.findall(r"^Neighbor list builds = (\d+)", run.text, re.MULTILINE))
        pairs = [int(number) for number in re.findall(r"^Total # of neighbors = (\d+)", run.text, re.MULTILINE)]
        result[name] = {
            "ms_per_step": 1e3 * run.loop_seconds / run.steps,
            "list_builds": builds,
            "listed_pairs": pairs[0],
            "neigh_ms_per_step": 1e3 * run.neigh_seconds / run.steps,
            "megabytes": max(other.megabytes for other in made),
            "dispersion_ratio": run.number(r"dispersion ratio ([\d.]+)"),
        }
        print(
            f"skin {name} grain diameters: {result[name]['ms_per_step']:.3f} ms a step, "
            f"{result[name]['neigh_ms_per_step']:.3f} of them "
            f"for {builds} list builds, {pairs[0]} pairs, "
            f"{result[name]['megabytes']:.0f} MB, dispersion ratio {result[name]['dispersion_ratio']:.4f}",
            flush=True,
        )
    return result


PARTS = {"contact": contact, "impact": impact, "skin": skin}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--parts", default=",".join(PARTS), help="the others keep their results in FILE")
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    result: dict = {**description(LMP), "parts": {}}
    if args.out and args.out.exists():
        result["parts"] = json.loads(args.out.read_text())["parts"]
    with tempfile.TemporaryDirectory() as folder:
        for part in args.parts.split(","):
            result["parts"][part] = {
                "repeats": args.repeat,
                "load_average": round(os.getloadavg()[0], 1),
                **PARTS[part](Path(folder), args.repeat),
            }
    if args.out:
        args.out.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
