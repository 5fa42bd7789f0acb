"""Random sequences of runs and of what a script may do between them, and the books of mass, momentum and grains.

    python drills.py FIRST LAST    plays these seeds and says what does not close

A drill is a play in acts. An act is one LAMMPS process on 1, 2 or 4 ranks; the next one goes on from a restart file, of
the end of the act or of the middle of its last run. After each command all atoms are written out, and what the command
should have done is computed from what was written before.
"""

from __future__ import annotations

import math
import random
import re
import shutil
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ranks import run_ranks

LARGEST = 1.5e-3  # diameter of a carrier
BARE = math.pi / 6.0 * LARGEST**3 * 7700.0
GRAIN = math.pi / 6.0 * 100e-6**3 * 2700.0
SOFT = "hertz/material 210e6 0.7 0.3 tangential mindlin NULL 0 0.05 damping coeff_restitution/limited"
COLUMNS = "id type mass x y z vx vy vz f_dust[1] f_dust[2] diameter"
ROWS = " ".join(f"f_dust[{n}]" for n in (1, 2, 3, 5, 9, 10, 11))
MASS, MOMENTUM = 1e-12, 1e-11  # relative: sums of some thousand terms

Vector = tuple[float, ...]
# by step, carrier and grain: step in which it was written, which is the next one where a run starts, mass and velocity
Rows = dict[tuple[float, float, float], tuple[int, float, Vector]]


class Open(AssertionError):
    """A book that does not close."""


def close(found: float, expected: float, tolerance: float, what: str) -> None:
    if not abs(found - expected) <= tolerance:
        raise Open(f"{what}: {found!r}, not {expected!r} within {tolerance:.2g}")


@dataclass(frozen=True, order=True)
class Atom:
    kind: int
    mass: float
    v: Vector
    attached: float
    lost: float
    diameter: float
    id: int = field(compare=False)
    x: Vector = field(compare=False)

    @property
    def bare(self) -> float:
        """Mass of a carrier without grains."""
        return math.pi / 6.0 * self.diameter**3 * 7700.0

    @property
    def grains_at_first(self) -> int:
        """With a coverage of 0.15."""
        return round(0.6 * (self.diameter / 100e-6) ** 2)


@dataclass
class State:
    """All atoms between two commands, and the fix's vector."""

    step: int
    totals: list[float]
    atoms: list[Atom]

    @property
    def mass(self) -> float:
        return math.fsum(a.mass for a in self.atoms)

    @property
    def momentum(self) -> Vector:
        return tuple(math.fsum(a.mass * a.v[d] for a in self.atoms) for d in range(3))

    @property
    def scale(self) -> float:
        return math.fsum(a.mass * (abs(a.v[0]) + abs(a.v[1]) + abs(a.v[2])) for a in self.atoms) + BARE * 0.01

    @property
    def new(self) -> list[Atom]:
        """Carriers without the mass of their grains: it comes when the first run starts."""
        return [a for a in self.atoms if a.kind == 1 and a.lost == 0.0 and abs(a.mass - a.bare) < 1e-9 * BARE]

    @property
    def unknown(self) -> list[Atom]:
        """Carriers that have no grains yet."""
        return [a for a in self.new if a.attached == 0.0]

    @property
    def grains(self) -> int:
        return sum(a.kind == 2 for a in self.atoms)

    @property
    def detached(self) -> float:
        return self.totals[2] + self.totals[3] + self.totals[11] + self.totals[12]

    @property
    def no_room(self) -> float:
        return self.totals[13]


def read_state(dump: Path, words: list[str]) -> State:
    atoms = []
    for line in dump.read_text().split("ITEM: ATOMS")[1].splitlines()[1:]:
        w = line.split()
        x, v = tuple(float(t) for t in w[3:6]), tuple(float(t) for t in w[6:9])
        atoms.append(Atom(int(w[1]), float(w[2]), v, float(w[9]), float(w[10]), float(w[11]), int(w[0]), x))
    if len({a.id for a in atoms}) != len(atoms):
        raise Open("IDs exist twice")
    return State(int(words[0]), [float(w) for w in words[1:]], atoms)


def read_rows(dump: Path) -> Rows:
    rows: Rows = {}
    for frame in dump.read_text().split("ITEM: TIMESTEP\n")[1:] if dump.exists() else ():
        for line in frame.split("ITEM: ENTRIES")[1].splitlines()[1:]:
            n = [float(w) for w in line.split()]
            rows[n[0], n[1], n[2]] = (int(frame.split()[0]), math.pi / 6.0 * n[3] ** 3 * 2700.0, tuple(n[4:7]))
    return rows


@dataclass
class Command:
    """Lines of a script, and how they change the state before."""

    kind: str
    lines: list[str]
    goes: Callable[[Atom], bool] | None = None  # which atoms are deleted
    shift: Vector = ()
    velocity: tuple[float | None, ...] = ()


class Commands:
    """Draws them."""

    def __init__(self, draw: random.Random, sizes: bool) -> None:
        self.draw = draw
        self.sizes = sizes

    def any(self) -> Command:
        kinds = [self.run] * 5 + [self.delete, self.create, self.displace, self.velocity, self.spin, self.other]
        return self.draw.choice(kinds)()

    def run(self) -> Command:
        steps, piece = self.draw.randint(1, 900), self.draw.randint(1, 300)
        pieces = (
            [f"run {steps} post no"],
            [f'run {steps} post no every {piece} "print piece"'],
            [f"run {steps} post no", f"run {piece} pre no post no"],
        )
        return Command("run", self.draw.choice(pieces))

    def delete(self) -> Command:
        part, kind = self.draw.randint(3, 5), self.draw.choice((1, 1, 2))
        rest = self.draw.randrange(part)
        lines = [
            f'variable pick atom "(type=={kind}) && (id%{part}=={rest})"',
            "group gone variable pick",
            f"delete_atoms group gone compress {self.draw.choice(('yes', 'no'))}",
            "group gone delete",
        ]
        return Command("delete", lines, goes=lambda a: a.kind == kind and a.id % part == rest)

    def create(self) -> Command:
        return Command("create", self.atoms(self.draw.choice((1, 1, 2)), self.draw.randint(1, 3)))

    def atoms(self, kind: int, number: int) -> list[str]:
        """Lines that make atoms in the middle of the box, which fly to its centre, so that they meet."""
        seed, rate = self.draw.randint(1, 10**6), self.draw.uniform(800.0, 2500.0)
        size, density = (str(LARGEST), "7700") if kind == 1 else ("100e-6", "2700")
        if kind == 1 and self.sizes:
            size = "v_size"
        return [
            "region middle block -3e-3 3e-3 -3e-3 3e-3 -3e-3 3e-3",
            "group before union all",
            f"create_atoms {kind} random {number} {seed} middle overlap 1.7e-3 maxtry 500",
            "group new subtract all before",
            "group before delete",
            "region middle delete",
            f"variable size atom {LARGEST}-2e-4*(id%3)",
            f"set group new diameter {size}",
            f"set group new density {density}",
            *(f"variable v{c} atom -{rate}*{c}+{self.draw.uniform(0.0, 1.0)}" for c in "xyz"),
            "velocity new set v_vx v_vy v_vz",
            "group carriers type 1",
            "group new delete",
        ]

    def displace(self) -> Command:
        shift = tuple(self.draw.uniform(-1e-3, 1e-3) for _ in range(3))
        return Command("displace", ["displace_atoms all move {!r} {!r} {!r} units box".format(*shift)], shift=shift)

    def velocity(self) -> Command:
        v = tuple(self.draw.choice((None, self.draw.uniform(-3.0, 3.0))) for _ in range(3))
        words = " ".join("NULL" if c is None else repr(c) for c in v)
        return Command("velocity", [f"velocity all set {words}"], velocity=v)

    def spin(self) -> Command:
        spin = (self.draw.uniform(-2500.0, 2500.0) for _ in range(3))
        return Command("spin", ["set group carriers omega {} {} {}".format(*spin)])

    def other(self) -> Command:
        lines = (
            "reset_atoms id",
            f"balance 1.0 shift {self.draw.choice(('x', 'y', 'xyz'))} 5 1.01",
            f"timestep {self.draw.choice((5e-8, 8e-8, 1e-7, 1.4e-7))}",
        )
        return Command("other", [self.draw.choice(lines)])


class Drill:
    """The play of a seed, in a folder of its own."""

    def __init__(self, seed: int, folder: Path) -> None:
        self.draw = random.Random(seed)
        sizes = seed % 3 == 2
        self.commands = Commands(self.draw, sizes)
        self.folder = folder
        self.emit = seed % 2 == 1
        self.boundary = ("p p p", "f f f", "s s s", "p p s")[seed // 2 % 4]
        self.half = 30e-3 if "f" in self.boundary else 4e-3
        every = self.draw.choice((1, 50, 100000)) if self.emit else 1
        self.fix = (
            "fix dust carriers dust/detach texture monolayer 100e-6 coverage 0.15 seed 3 stiffen 1000 counts yes "
            f"orientation random 5 tangential {self.draw.choice(('estimate', 'integrate'))} every {every} "
            + ("emit 2" if self.emit else "mass yes")
            + (" sizes 0" if sizes else "")
        )
        check, often = self.draw.choice(("yes", "no")), self.draw.choice((1, 7, 50))
        self.neighbour = f"neigh_modify every {often} delay 0 check {check} one 10000 page 200000"
        self.act = self.states = 0
        self.state: State | None = None  # the last one in the books
        self.taken = 0.0  # grains that were on carriers that have been deleted
        self.rows: Rows = {}  # that belong to the play; `entered` are in the books
        self.entered: set[tuple[float, float, float]] = set()

    def play(self, acts: int) -> None:
        script = self.opening()
        for self.act in range(acts):
            script, middle = self.play_act(script, self.act + 1 == acts)
            script += [*self.styles(self.act + 1), f"timestep {self.draw.choice((8e-8, 1e-7))}"]
            if middle and self.draw.random() < 0.5:  # while grains wait
                script += ["balance 1.0 shift x 5 1.01", "displace_atoms all move 3e-4 -2e-4 1e-4 units box"]

    def opening(self) -> list[str]:
        h = self.half
        return [
            "units si",
            "newton off",
            "atom_style sphere",
            "atom_modify map array",
            f"boundary {self.boundary}",
            f"region box block -{h} {h} -{h} {h} -{h} {h}",
            "create_box 2 box",
            "timestep 1e-7",
            *self.commands.atoms(1, self.draw.randint(4, 9)),
            *self.styles(0),
        ]

    def styles(self, act: int) -> list[str]:
        dump = [f"dump rows all local 1 rows.{act} {ROWS}", "dump_modify rows format float %.17g"]
        return [
            "comm_modify vel yes",
            "neighbor 3e-4 bin",
            self.neighbour,
            "pair_style granular",
            f"pair_coeff * * {SOFT}",
            "fix move all nve/sphere",
            self.fix,
            *([] if self.emit else dump),
            "thermo 100000",
        ]

    def play_act(self, script: list[str], last: bool) -> tuple[list[str], bool]:
        """Runs a script that ends before the first command of the act; returns the beginning of the next one's, and
        whether that goes on from the middle of a run."""
        commands = [Command("run", [f"run {self.draw.randint(1, 500)}"])]
        commands += [self.commands.any() for _ in range(self.draw.randint(3, 7))]
        if "middle" not in script[0]:
            commands.insert(0, Command("restart", []))
        numbers = []
        for command in commands:
            script += command.lines
            numbers.append(self.write_state(script))
        middle = not last and self.draw.random() < 0.6
        if middle:
            script += [f"restart {self.draw.randint(60, 150)} middle.{self.act}.*"]
            script += [f"run {self.draw.randint(300, 700)} post no"]
        else:
            script += [f"write_restart end.{self.act}"]
        said = self.run(script, self.draw.choice((1, 2, 4)))
        self.rows = read_rows(self.folder / f"rows.{self.act}") | self.rows
        totals = {int(w[1]): w[2:] for w in (line.split() for line in re.findall(r"^TOTALS .*", said, re.M))}
        for command, number in zip(commands, numbers, strict=True):
            state = read_state(self.folder / f"state.{number}", totals[number])
            try:
                self.enter(command, state)
            except Open as error:
                raise Open(f"in.act{self.act}, state {number}, {command.lines}: {error}") from None
        if not middle:
            return [f"read_restart end.{self.act}"], False
        files = sorted(self.folder.glob(f"middle.{self.act}.*"), key=lambda p: int(p.suffix[1:]))
        files = [p for p in files if self.state and int(p.suffix[1:]) > self.state.step]
        chosen = self.draw.choice(files)
        self.rows = {key: row for key, row in self.rows.items() if row[0] <= int(chosen.suffix[1:])}
        return [f"read_restart {chosen.name}"], True

    def write_state(self, script: list[str]) -> int:
        self.states += 1
        totals = "".join(f" $(f_dust[{n}]:%.17g)" for n in range(1, 15))
        script += [
            f'write_dump all custom state.{self.states} {COLUMNS} modify sort id format float "%.17g"',
            f'print "TOTALS {self.states} $(step){totals}"',
        ]
        return self.states

    def run(self, script: list[str], ranks: int) -> str:
        deck = self.folder / f"in.act{self.act}"
        deck.write_text("\n".join([*script[:1], f"# {ranks} ranks", *script[1:]]) + "\n")
        done = run_ranks(self.folder, deck.name, ranks)
        if done.returncode != 0:
            raise Open(f"{deck}: " + done.stdout[-1500:] + done.stderr[-500:])
        return done.stdout

    # --- books ---

    def enter(self, command: Command, after: State) -> None:
        before, self.state = self.state, after
        if before is None:
            return
        if command.kind == "run":
            self.check_run(before, after)
        elif command.kind == "create":
            known = {a.id for a in before.atoms}
            if [a for a in after.atoms if a.id in known] != before.atoms:
                raise Open("other atoms have changed")
        else:
            self.check_between(before, command, after)
        self.check_grains(after)

    def gained(self, before: State) -> tuple[float, Vector]:
        """Mass and momentum that new carriers get with their grains."""
        masses = [a.grains_at_first * GRAIN for a in before.new]
        momentum = (math.fsum(mass * a.v[d] for mass, a in zip(masses, before.new, strict=True)) for d in range(3))
        return math.fsum(masses), tuple(momentum)

    def check_run(self, before: State, after: State) -> None:
        mass, momentum = self.gained(before)
        leaves = [key for key, row in self.rows.items() if row[0] <= after.step and key not in self.entered]
        self.entered.update(leaves)
        mass += before.mass - math.fsum(self.rows[key][1] for key in leaves)
        close(after.mass, mass, MASS * before.mass, "mass")
        for d in range(3):
            lost = math.fsum(self.rows[key][1] * self.rows[key][2][d] for key in leaves)
            expected = before.momentum[d] + momentum[d] - lost
            close(after.momentum[d], expected, MOMENTUM * (before.scale + after.scale), f"momentum along {'xyz'[d]}")
        if self.emit:
            flown = (after.detached - before.detached) - (after.no_room - before.no_room)
            close(after.grains - before.grains, flown, 0.0, "grains that are atoms")

    def check_between(self, before: State, command: Command, after: State) -> None:
        """What is not meant to change has not, to the last bit."""
        if command.goes:
            gone = [a for a in before.atoms if command.goes(a)]
            self.taken += sum(a.attached for a in gone)
            if after.totals[0] - before.totals[0] == sum(a.grains_at_first for a in before.unknown):
                self.taken += sum(a.grains_at_first for a in gone if a in before.unknown)  # had got them before
            before = State(before.step, before.totals, [a for a in before.atoms if not command.goes(a)])
        if command.velocity:
            for a in after.atoms:
                if any(want is not None and v != want for v, want in zip(a.v, command.velocity, strict=True)):
                    raise Open(f"atom {a.id} has the velocity {a.v}")
        elif command.shift:
            places = {a.id: a.x for a in before.atoms}
            for a in after.atoms:
                for d, border in enumerate(self.boundary.split()):
                    way = a.x[d] - places[a.id][d] - command.shift[d]
                    way = math.remainder(way, 2.0 * self.half) if border == "p" else way
                    close(way, 0.0, 1e-12, f"way of atom {a.id}")
        if before.new and not after.new:  # LAMMPS sets up its styles for some commands as it does for a run
            close(after.mass, before.mass + self.gained(before)[0], MASS * before.mass, "mass")
            return
        what = (lambda a: (a.kind, a.mass, a.attached)) if command.velocity else (lambda a: a)
        if sorted(map(what, before.atoms)) != sorted(map(what, after.atoms)):
            raise Open("atoms have changed")
        if command.kind == "restart" and [a.id for a in before.atoms] != [a.id for a in after.atoms]:
            raise Open("IDs have changed")
        # a collision under way goes with its carrier, and with it who has left on the north, slid and rolled
        totals = [n for n in range(14) if n not in (1, 4, 5, 9, 10) or not command.goes]
        if not before.unknown and any(before.totals[n] != after.totals[n] for n in totals):
            raise Open(f"totals have changed: {after.totals}, not {before.totals}")

    def check_grains(self, state: State) -> None:
        attached = sum(a.attached for a in state.atoms)
        close(attached, state.totals[1], 0.0, "attached grains")
        close(state.totals[0] - attached - state.detached, self.taken, 0.0, "grains taken away by their carriers")
        close(state.totals[6], state.detached * GRAIN, MASS * GRAIN * (1.0 + state.detached), "detached mass")
        close(state.totals[4] + state.totals[5], state.detached, 0.0, "south and north")
        if not self.emit:
            for a in state.atoms:
                if a.kind == 1 and a not in state.new:
                    close(a.mass, a.bare + a.attached * GRAIN, 1e-11 * BARE, f"mass of carrier {a.id}")


def drill(seed: int, folder: Path, acts: int = 3) -> State:
    """Plays a seed; returns the state at its end."""
    play = Drill(seed, folder)
    play.play(acts)
    assert play.state is not None
    return play.state


def main() -> int:
    """`drills.py FIRST LAST`: these seeds; folders of those that fail stay."""
    first, last = int(sys.argv[1]), int(sys.argv[2])
    failed = []
    for seed in range(first, last + 1):
        folder = Path(tempfile.mkdtemp(prefix=f"drill{seed}."))
        try:
            end = drill(seed, folder)
            print(f"{seed}: step {end.step}, {len(end.atoms)} atoms, {end.detached:.0f} grains off", flush=True)
            shutil.rmtree(folder)
        except Open as error:
            failed.append(seed)
            print(f"{seed}: {folder}/{error}", flush=True)
    print(f"{last - first + 1} drills, {len(failed)} failed: {failed}")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
