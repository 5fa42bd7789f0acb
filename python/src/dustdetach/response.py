"""The dispersion ratio as a smooth function of adhesion and friction: the functions on all places of a carrier at once.

A texture has a few thousand grains, each of which leaves or stays, so that the ratio of a run goes up and down in steps
of one grain and differs from seed to seed. Here the same two criteria (lift-off normal and the impulse law, see
``doc/theory.rst``) give, for every direction n from the carrier's centre, the hold c* below which a grain there leaves;
c = F_c/m_d. The ratio is the share of the directions and grains with c < c*, an integral over the sphere outside the
bare cap and over the log-normal spread of c that is done in closed form.

The carrier's motion is LAMMPS': one run of the deck for each motion, whatever holds the grains.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from .files import read_text, scratch_folder
from .impact import Impact
from .result import Result
from .runner import run

Array: TypeAlias = NDArray[np.float64]

#: directions over the sphere, and at most so many moments of a collision
DIRECTIONS, MOMENTS = 3000, 240

#: phases of the half sine at which the impulse law looks, as the fix does
PHASES = np.pi * np.arange(3, 13) / 12

#: rolling limit of a grain, rad: the fix' default
THETA_CRIT = 0.15

#: of the slip of a solid sphere, what makes it roll
TO_ROLL = 2 / 7


@dataclass(frozen=True)
class Motion:
    """How a carrier moves in a collision.

    Attributes:
        change: v_contact - v_rebound (3,), m/s.
        duration: of the contact, s.
        peak: largest acceleration, m/s2.
        spin_before, spin_after: (3,), rad/s.
        accelerations: (M, 3), m/s2.
        spins: at the same moments (M, 3), rad/s.
    """

    change: Array
    duration: float
    peak: float
    spin_before: Array
    spin_after: Array
    accelerations: Array
    spins: Array


#: grains of the texture in the run that gives a motion: what is on it does not move a carrier
FEW_GRAINS = 20

#: parameters that a carrier's motion depends on
_MOVES = (
    *("speed", "angle", "restitution", "spin", "carrier_diameter", "carrier_density", "carrier_modulus"),
    *("carrier_poisson", "wall_modulus", "wall_poisson", "wall_friction", "timestep"),
)
_motions: dict[tuple[float, ...], Motion] = {}


def motion_of(impact: Impact) -> Motion:
    """The motion of an impact's carrier, from one run of the deck; kept for impacts that move alike."""
    key = tuple(getattr(impact, name) for name in _MOVES)
    if key not in _motions:
        coverage = FEW_GRAINS / 4 * (impact.grain_diameter / impact.carrier_diameter) ** 2
        few = replace(
            impact,
            method="functions",
            coverage=min(coverage, impact.coverage),
            distribution="none",
            distribution_spread=1.0,
            tangential="off",
            grain_damping=1.0,
            rotation=True,
        )
        with scratch_folder(1 << 22) as folder:
            result = run(few, motion=folder / "motion")
            rows = _read_motion(folder / "motion")
        _motions[key] = _motion(impact, result, rows)
    return _motions[key]


def _read_motion(path: Path) -> Array:
    """The numbers of a dump with one atom: velocity, spin, force and torque, a row a step (M, 12)."""
    lines = read_text(path).splitlines()
    starts = [index + 1 for index, line in enumerate(lines) if line.startswith("ITEM: ATOMS")]
    return np.array([lines[index].split() for index in starts if index < len(lines)], dtype=float)


def _motion(impact: Impact, result: Result, rows: Array) -> Motion:
    mass = math.pi / 6 * impact.carrier_diameter**3 * impact.carrier_density
    touching = np.flatnonzero(np.any(rows[:, 6:9] != 0, axis=1))
    # all that differ from their neighbours count, but a few hundred of a smooth pulse have its largest to a millionth
    chosen = touching[np.unique(np.linspace(0, len(touching) - 1, MOMENTS).round().astype(int))]
    return Motion(
        change=rows[0, :3] - rows[-1, :3],
        duration=result.contact_time,
        peak=result.peak_acceleration,
        spin_before=rows[0, 3:6],
        spin_after=rows[-1, 3:6],
        accelerations=rows[chosen, 6:9] / mass,
        spins=rows[chosen, 3:6],
    )


def directions(bare: float, count: int = DIRECTIONS) -> Array:
    """Directions spread evenly over the sphere outside the bare cap around -z (N, 3), each at a height of its own."""
    index = np.arange(count) + 0.5
    z = -math.cos(bare) + (1 + math.cos(bare)) * index / count
    azimuth = math.pi * (1 + math.sqrt(5)) * index
    across = np.sqrt(np.maximum(0, 1 - z**2))
    return np.column_stack([across * np.cos(azimuth), across * np.sin(azimuth), z])


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("...d,...d->...", a, b))


class Places:
    """The criteria on all directions of a carrier that makes one collision, for grains of one size.

    Args:
        impact: the parameters; adhesion, spread, coverage and seed do not matter.
        diameter: of the grains, m.
    """

    def __init__(self, impact: Impact, diameter: float) -> None:
        self.motion = motion = motion_of(impact)
        self.spins = bool(impact.rotation)
        self.carrier_radius = impact.carrier_diameter / 2
        self.shell = (impact.carrier_diameter + diameter) / 2
        self.n = n = directions(impact.bare)
        self.tangential = impact.tangential
        self.normal = self._largest_lift()
        self.dvn = n @ motion.change
        zero = np.zeros(3)
        before, after = (motion.spin_before, motion.spin_after) if self.spins else (zero, zero)
        self.before = self.shell * np.cross(before, n)
        self.free = motion.change - self.dvn[:, None] * n + self.before
        ground = (self.shell - self.carrier_radius) * np.cross(before, n) + self.carrier_radius * np.cross(after, n)
        self.slip = self.free - ground
        self.slip_size = np.sqrt(_dot(self.slip, self.slip))
        size = math.sqrt(float(motion.change @ motion.change))
        self.amplitude = min(0.5 * math.pi / motion.duration, motion.peak / size)

    def _largest_lift(self) -> Array:
        """Largest F_n/m_d of a grain that sticks, -a.n + |r| (omega^2 - (omega.n)^2) (N,), m/s2."""
        motion = self.motion
        lift = -motion.accelerations @ self.n.T
        if self.spins and np.any(motion.spins):
            squared = _dot(motion.spins, motion.spins)[:, None]
            lift += self.shell * (squared - (motion.spins @ self.n.T) ** 2)
        return np.asarray(lift.max(axis=0))

    def holds(self, friction: float) -> Array:
        """The hold c* = F_c/m_d of each place below which a grain leaves it (N,), m/s2."""
        if self.tangential == "off":
            return self.normal
        # what the impulse law has in F_n falls with c, as friction grows with it: bisection
        low = np.zeros(len(self.n))
        high = np.full(len(self.n), 1.0)
        size = float(np.max(_dot(self.free, self.free)) + np.max(_dot(self.before, self.before)))
        high *= 4 * size / self.shell + 2 * self.motion.peak
        for _ in range(40):
            middle = 0.5 * (low + high)
            lifted = self._lifted(middle, friction)
            low, high = np.where(lifted, middle, low), np.where(lifted, high, middle)
        return np.maximum(self.normal, low)

    def _lifted(self, hold: Array, friction: float) -> NDArray[np.bool_]:
        """Whether the impulse law lifts grains off that are held by ``hold`` (N,)."""
        after = self.free - self._part_taken(hold, friction)[:, None] * self.slip
        change = after - self.before
        both = _dot(self.before, change)
        dv_before, dv_change = self.before @ self.motion.change, change @ self.motion.change
        before2, change2 = _dot(self.before, self.before), _dot(change, change)
        lifted = np.zeros(len(hold), dtype=bool)
        for tau in PHASES:
            velocity, way = 0.5 * (1 - math.cos(tau)), 0.5 * (tau - math.sin(tau)) / math.pi
            w2 = before2 + velocity * (2 * both + velocity * change2)
            moved = tau / math.pi * dv_before + way * dv_change
            dvn = self.dvn + self.motion.duration / self.shell * moved
            lifted |= self.amplitude * math.sin(tau) * dvn + w2 / self.shell > hold
        return lifted

    def _part_taken(self, hold: Array, friction: float) -> Array:
        """The part of the slip that friction takes, min(J, 2/7 |s0| + 5/7 min(K, |s0|))/|s0| (N,)."""
        held = hold * self.motion.duration
        sliding = np.maximum(0, friction * (2 * held - self.dvn))
        root = np.sqrt(held * np.maximum(0, held - self.dvn))
        pivot = 2 * THETA_CRIT * self.carrier_radius / self.shell * (held + root)
        rolling = TO_ROLL * self.slip_size + (1 - TO_ROLL) * np.minimum(self.slip_size, pivot)
        taken = np.where(sliding <= TO_ROLL * self.slip_size, sliding, np.minimum(sliding, rolling))
        return np.where(self.slip_size > 0, taken / np.maximum(self.slip_size, 1e-300), 0.0)


#: of the places in the order of their c*, every so many is kept, and both sides of gaps wider than this in ln c*
THINNED, GAP = 15, 0.02


@dataclass(frozen=True)
class Polygon:
    """The share of places with ln c* > x, by lines between some of them.

    Attributes:
        x: ln c* (K,), rising.
        above: the share (K,), from 1 to 0.
    """

    x: Array
    above: Array

    @classmethod
    def of(cls, holds: Array) -> Polygon:
        """From c* of all places (N,), m/s2; thinned, so that its slopes are those of many places."""
        return cls.alike(holds[None])[0]

    @classmethod
    def alike(cls, holds: Array) -> list[Polygon]:
        """From c* of all places in several states (M, N), with the same shares: between two, x lies between."""
        x = np.sort(np.log(np.maximum(holds, 1e-6)), axis=1)
        count = x.shape[1]
        kept = np.zeros(count, dtype=bool)
        kept[::THINNED] = kept[-1] = True
        gaps = np.flatnonzero(np.any(np.diff(x, axis=1) > GAP, axis=0))
        kept[gaps] = kept[gaps + 1] = True
        places = np.flatnonzero(kept)
        # equal ones in a row would make a jump of a line
        rising, above = 1e-9 * np.arange(len(places)), 1 - places / (count - 1)
        return [cls(row[places] + rising, above) for row in x]


class Curves:
    """Polygons side by side, whose means over the grains' spread are worked out at once.

    Args:
        polygons: one for each impact.
    """

    def __init__(self, polygons: list[Polygon]) -> None:
        longest = max(len(polygon.x) for polygon in polygons)
        self._polygons = polygons
        self._x = np.array(
            [np.append(each.x, each.x[-1] + np.arange(1, longest - len(each.x) + 1)) for each in polygons]
        )
        above = np.array([np.append(each.above, np.zeros(longest - len(each.x))) for each in polygons])
        self._slopes = np.diff(above) / np.diff(self._x)

    def shares_below(self, holds: Array, spread: float) -> Array:
        """The share of grains with c < c*, c log-normal: the mean of each polygon over the normal distribution of ln c.

        Args:
            holds: median of the grains' c in each (n,), m/s2.
            spread: geometric standard deviation of c, from 1.
        """
        middles, width = np.log(holds), math.log(spread)
        if width < 1e-6:
            pairs = zip(middles, self._polygons, strict=True)
            return np.array([np.interp(middle, polygon.x, polygon.above) for middle, polygon in pairs])
        from scipy.special import ndtr

        u = (self._x - middles[:, None]) / width
        # from u on, the integral of 1 - Phi is phi(u) - u (1 - Phi(u))
        tail = np.exp(-0.5 * u**2) / math.sqrt(2 * math.pi) - u * ndtr(-u)
        return np.asarray(1 + width * np.sum(self._slopes * (tail[:, :-1] - tail[:, 1:]), axis=1))
