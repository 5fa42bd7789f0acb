"""One impact of a dust-laden carrier on a wall: its parameters, their units and their allowed ranges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from .errors import InvalidInput, shown

METHODS = ("functions", "resolved")
#: laws of tangential lift-off that know how a grain's contact rings
RINGING = ("impulse", "integrate")
TANGENTIAL = ("impulse", "estimate", "integrate", "frictionless", "off")

#: share of a surface that random sequential placement of discs covers before it jams
JAMMING = 0.547

#: the most grains a texture may have; beyond it a case would not fit in memory
MOST_GRAINS = 10_000_000

#: m/s
FASTEST = 100.0

LARGEST_SEED = 900_000_000

#: below it products of parameters are too small for floating-point numbers
SMALLEST = 1e-60


def option(field: str) -> str:
    """The command-line option of a parameter: ``grain_diameter`` -> ``--grain-diameter``."""
    return "--" + field.replace("_", "-")


#: the deck's carrier and wall of steel: kg/m3, and E* = E/(2 (1 - nu^2)) in Pa
CARRIER_DENSITY = 7700.0
CONTACT_MODULUS = 210e9 / (2 * (1 - 0.3**2))

#: the deck's grains of calcium carbonate: kg/m3, and E* of grain and steel in Pa
GRAIN_DENSITY = 2700.0
GRAIN_MODULUS = 1 / ((1 - 0.3**2) / 75e9 + (1 - 0.3**2) / 210e9)

#: the pull-off force per mass must be that of gravity at least, m/s2, and the surface energy at most this, J/m2
GRAVITY, LARGEST_SURFACE_ENERGY = 9.81, 10.0

#: a carrier of steel on steel has at this speed, m/s, the largest overlap that the default of the bare cap allows for
BARE_SPEED = 20.0

#: in place of a bare cap that is not given: as wide as the diameters need it. No value that a user gives is this object
BARE_FROM_GEOMETRY = float("nan")


class Chosen(float):
    """A value that nobody has asked for, and which is chosen anew when ``replace`` changes what it depends on."""


#: in place of a time step that is not given: by the contact time, see `default_timestep`
TIMESTEP_FROM_CONTACT = Chosen("nan")

#: steps in a contact of Hertz: in general, at a restitution below `MUCH_DAMPED`, when damping is strongest at first
#: touch, and where grains ring, or wall friction above `MUCH_FRICTION` shakes them, whatever the restitution
CONTACT_STEPS, DAMPED_STEPS, RINGING_STEPS = 300, 1000, 3000
MUCH_DAMPED, MUCH_FRICTION = 0.5, 0.1

#: s, and what a resolved run takes where none is given
LONGEST_TIMESTEP, RESOLVED_TIMESTEP = 1e-7, 1e-9

#: time steps that resolve an oscillation of a grain on its carrier
LEAST_GRAIN_STEPS = 30

#: 2 zeta omega dt, the share of its speed that a grain loses to damping in a step: an explicit damper needs it small
MOST_DAMPING_A_STEP = 0.25

#: the most grains of a resolved run, about 4 GB
MOST_RESOLVED_GRAINS = 100_000

#: a resolved run ends 50 us after its start: the longest contact that leaves time for grains to come off, s
LONGEST_RESOLVED_CONTACT = 30e-6

#: a contact of fewer steps is not resolved, one of more does not end within the deck's step limit
LEAST_STEPS, MOST_STEPS = 50, 100_000


@dataclass(frozen=True, kw_only=True)
class Impact:
    """A carrier with a monolayer of dust hits a rigid wall. SI units, angles as stated.

    The defaults are the reference case of the paper: a steel carrier of 1.5 mm with calcium carbonate grains of
    20 um at a coverage of 0.2.

    Attributes:
        method: ``functions``, the detachment functions on a carrier without grains as atoms, or ``resolved``, every
            grain an atom with adhesive contacts.
        speed: impact speed, m/s, above 0 and at most 100.
        angle: between velocity and wall plane, degrees, above 0 and at most 90 (straight).
        restitution: coefficient of restitution e_pw of carrier and wall, above 0 and at most 1.
        coverage: X0, summed cross-section of the grains over the carrier's surface, above 0; random
            placement jams near 0.5, see `largest_coverage`.
        bare: half-angle of the bare cap where the carrier meets the wall, rad, from 0 to below pi; by default so wide
            that no grain reaches the wall before the carrier's largest overlap, see `bare_half_angle`.
        grain_diameter: d_d, m, below the carrier's radius; adhesion must hold a grain that is lifted by gravity.
        carrier_diameter: d_p, m, above 0 and at most 1.
        hamaker: A_12 of grain and carrier, J, 1e-22 to 1e-17.
        z0: separation at which the van der Waals force equals the pull-off force, m, 1e-11 to 1e-7.
        spread: geometric standard deviation of the grains' pull-off forces, from 1 (all alike) to 100; hamaker and z0
            give their median.
        friction: mu_f between grain and carrier, from 0 to 10.
        wall_friction: mu between carrier and wall, from 0 to 10.
        grain_damping: damping ratio of a grain's contact at equilibrium overlap, from 0: below 1 grains ring, and more
            of them leave; resolved runs and `RINGING` laws use it.
        seed: of the random texture, 1 to 900000000.
        tangential: lift-off on the far side: ``impulse`` (friction as a momentum, rolling as its limit), ``estimate``
            (Eqs. 4-6), ``integrate`` (each grain's own sliding and rolling), ``frictionless`` (Eq. 4) or ``off``;
            resolved runs do not use it.
        rotation: whether the functions follow the carrier's spin; ``False`` is as in the paper. Resolved runs always
            follow it.
        timestep: s, above 0 and at most 1e-7; by default as `default_timestep` has it. A resolved run also needs
            `LEAST_GRAIN_STEPS` in a grain's oscillation.

    Raises:
        InvalidInput: a value outside its range; the message names the option.
    """

    method: str = "functions"
    speed: float
    angle: float = 90.0
    restitution: float = 0.7
    coverage: float = 0.2
    bare: float = BARE_FROM_GEOMETRY
    grain_diameter: float = 20e-6
    carrier_diameter: float = 1.5e-3
    hamaker: float = 14.633e-20
    z0: float = 0.4e-9
    spread: float = 1.0
    friction: float = 0.3
    wall_friction: float = 0.05
    grain_damping: float = 1.0
    seed: int = 1
    tangential: str = "impulse"
    rotation: bool = True
    timestep: float = TIMESTEP_FROM_CONTACT

    def __post_init__(self) -> None:
        for field in fields(self):
            # under `from __future__ import annotations` a field's type is its spelling
            value = getattr(self, field.name)
            if value is not BARE_FROM_GEOMETRY and not isinstance(value, Chosen):
                value = _convert(field.name, str(field.type), value)
            object.__setattr__(self, field.name, value)

        _one_of("method", self.method, METHODS)
        _one_of("tangential", self.tangential, TANGENTIAL)

        _above("speed", self.speed, 0.0, FASTEST, "m/s")
        _above("angle", self.angle, 0.0, 90.0, "degrees")
        _from("restitution", self.restitution, 0.01, 1.0)
        _above("carrier_diameter", self.carrier_diameter, 0.0, 1.0, "m")
        radius = self.carrier_diameter / 2
        _above("grain_diameter", self.grain_diameter, 0.0, radius, "m, the carrier's radius", included=False)
        if self.bare is BARE_FROM_GEOMETRY:
            object.__setattr__(self, "bare", bare_half_angle(self.carrier_diameter, self.grain_diameter))
        _from("bare", self.bare, 0.0, math.pi, "rad", included=False)
        _above("coverage", self.coverage, 0.0, self.largest_coverage, "(random placement jams there)")
        _from("hamaker", self.hamaker, 1e-22, 1e-17, "J")
        _from("z0", self.z0, 1e-11, 1e-7, "m")
        _from("spread", self.spread, 1.0, 100.0)
        _from("friction", self.friction, 0.0, 10.0)
        _from("wall_friction", self.wall_friction, 0.0, 10.0)
        _from("grain_damping", self.grain_damping, 0.0, 100.0)
        if self.method == "functions" and self.tangential not in RINGING and self.grain_damping != Impact.grain_damping:
            raise InvalidInput(
                f"--grain-damping: {self.grain_damping:g} does nothing with --tangential {self.tangential}, which does "
                f"not know how a grain's contact rings; allowed: {Impact.grain_damping:g}, or --tangential "
                + " or ".join(RINGING)
            )
        _from("seed", self.seed, 1, LARGEST_SEED)
        if isinstance(self.timestep, Chosen):
            object.__setattr__(self, "timestep", Chosen(default_timestep(self)))
        _above("timestep", self.timestep, 0.0, LONGEST_TIMESTEP, "s")

        if self.grains > MOST_GRAINS:
            smallest = self.carrier_diameter * math.sqrt(4 * self.coverage / MOST_GRAINS)
            raise InvalidInput(
                f"--grain-diameter: {self.grain_diameter:g} makes {self.grains:.3g} grains; allowed: "
                f"{smallest:.3g} to {self.carrier_diameter:g} m at this coverage"
            )
        if self.grains < 1:
            raise InvalidInput(
                f"--coverage: {self.coverage:g} leaves no grain on the carrier; allowed: above "
                f"{(self.grain_diameter / self.carrier_diameter) ** 2 / 8:.3g} for these diameters"
            )

        self._check_adhesion()
        steps = self.hertz_contact_time / self.timestep
        if not LEAST_STEPS <= steps <= MOST_STEPS:
            raise InvalidInput(
                f"--timestep: {self.timestep:g} s makes {steps:.3g} steps of a contact of "
                f"{self.hertz_contact_time:.3g} s; allowed: {self.hertz_contact_time / MOST_STEPS:.3g} to "
                f"{self.hertz_contact_time / LEAST_STEPS:.3g} s for this speed, angle and carrier diameter"
            )

        if self.method == "resolved":
            self._check_resolved()

    def _check_adhesion(self) -> None:
        """What makes no sense as adhesion shows that something was given in other units; the fix asks for the same."""
        surface_energy = self.hamaker / (18 * math.pi * self.z0**2)
        if surface_energy > LARGEST_SURFACE_ENERGY:
            least = math.sqrt(self.hamaker / (18 * math.pi * LARGEST_SURFACE_ENERGY))
            raise InvalidInput(
                f"--z0: {self.z0:g} m makes a surface energy of {surface_energy:.3g} J/m2; allowed: {least:.3g} to "
                "1e-07 m for this Hamaker constant"
            )
        effective = 1 / (2 / self.grain_diameter + 2 / self.carrier_diameter)
        mass = math.pi / 6 * self.grain_diameter**3 * GRAIN_DENSITY
        held = 3 * math.pi * surface_energy * effective / mass
        if held < GRAVITY:
            raise InvalidInput(
                f"--grain-diameter: {self.grain_diameter:g} m makes grains that are held up to an acceleration of "
                f"{held:.3g} m/s2; allowed: so small that this is at least {GRAVITY:g}"
            )

    def _check_resolved(self) -> None:
        """What a resolved run needs beyond the ranges of all impacts."""
        if not self.rotation:
            raise InvalidInput(
                "--rotation: false is for the functions, a resolved run always follows the spin; allowed: true"
            )
        if self.grains > MOST_RESOLVED_GRAINS:
            smallest = self.carrier_diameter * math.sqrt(4 * self.coverage / MOST_RESOLVED_GRAINS)
            raise InvalidInput(
                f"--grain-diameter: {self.grain_diameter:g} makes {self.grains} grains, in a resolved run at most "
                f"{MOST_RESOLVED_GRAINS}; allowed: {smallest:.3g} to {self.carrier_diameter:g} m at this coverage"
            )
        longest = self.grain_period / LEAST_GRAIN_STEPS
        if self.grain_damping > 0:
            longest = min(longest, MOST_DAMPING_A_STEP * self.grain_period / (4 * math.pi * self.grain_damping))
        if self.timestep > longest:
            raise InvalidInput(
                f"--timestep: {self.timestep:g} s does not resolve the contact of a grain, which oscillates in "
                f"{self.grain_period:.3g} s with the damping ratio {self.grain_damping:g}; allowed: above 0 and at "
                f"most {longest:.3g} s"
            )
        if self.hertz_contact_time > LONGEST_RESOLVED_CONTACT:
            # at a given speed the contact time is proportional to the diameter
            largest = self.carrier_diameter * LONGEST_RESOLVED_CONTACT / self.hertz_contact_time
            raise InvalidInput(
                f"--carrier-diameter: {self.carrier_diameter:g} makes a contact of {self.hertz_contact_time:.3g} s, in "
                f"a resolved run at most {LONGEST_RESOLVED_CONTACT:g} s; allowed: above 0 and at most {largest:.3g} m "
                "for this speed and angle"
            )

    @property
    def grain_period(self) -> float:
        """Period of a grain that oscillates about its equilibrium overlap on the carrier, 2 pi sqrt(m_d/k_0), s.

        k_0 = 6/5 E* a_0 with a_0 = (A R_12^2/(2 z0^2 E*))^(1/3); with a spread that of the grains that hold hardest, at
        three standard deviations, as the deck of resolved runs has them.
        """
        hardest = self.hamaker * self.spread**3
        effective = 1 / (2 / self.grain_diameter + 2 / self.carrier_diameter)
        contact_radius = (hardest * effective**2 / (2 * self.z0**2 * GRAIN_MODULUS)) ** (1 / 3)
        mass = math.pi / 6 * self.grain_diameter**3 * GRAIN_DENSITY
        return 2 * math.pi * math.sqrt(mass / (1.2 * GRAIN_MODULUS * contact_radius))

    @property
    def hertz_contact_time(self) -> float:
        """Contact time of the undamped impact (Hertz), s; see `hertz_contact_time`."""
        return hertz_contact_time(self)

    @property
    def grains(self) -> int:
        """Number of grains of the monolayer, N = 4 X0 (R_p/R_d)^2."""
        return round(4 * self.coverage * (self.carrier_diameter / self.grain_diameter) ** 2)

    @property
    def largest_coverage(self) -> float:
        """Coverage at which random sequential placement jams, 0.547 ((R_p+R_d)/R_p)^2 (1 - (1 - cos bare)/2)."""
        shell = (1 + self.grain_diameter / self.carrier_diameter) ** 2
        return float(round(JAMMING * shell * (1 + math.cos(self.bare)) / 2, 4))

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> Impact:
        """An impact from names and values.

        Raises:
            InvalidInput: an unknown name, a missing speed, or a value out of its range.
        """
        if not isinstance(values, Mapping):
            raise InvalidInput(f"{shown(values)} is not a mapping of names and values")
        known = [field.name for field in fields(cls)]
        for name in values:
            if name not in known:
                raise InvalidInput(f"{name}: unknown parameter; allowed: {', '.join(known)}")
        if "speed" not in values:
            raise InvalidInput("speed: missing; allowed: above 0 and at most 100 m/s")
        return cls(**values)


def hertz_contact_time(impact: Any) -> float:
    """Contact time of an undamped impact (Hertz), s.

    2.9432 overlap/speed with overlap = (15 m v^2/(16 E* sqrt(R)))^0.4 and the speed normal to the wall.

    Args:
        impact: an `Impact`, or a result, which has the same parameters.
    """
    radius = impact.carrier_diameter / 2
    speed = impact.speed * math.sin(math.radians(impact.angle))
    mass = 4 / 3 * math.pi * radius**3 * CARRIER_DENSITY
    overlap = (15 * mass * speed**2 / (16 * CONTACT_MODULUS * math.sqrt(radius))) ** 0.4
    return float(2.9432 * overlap / speed)


def default_timestep(impact: Any) -> float:
    """The time step of an impact that is given none, s: a share of `hertz_contact_time`, to two digits.

    1/300 of it; 1/1000 at a restitution below 0.5; 1/3000 at a wall friction above 0.1, and where a law in `RINGING` is
    given a damping ratio below 1. At most 1e-7 s. In a resolved run 1e-9 s.

    Args:
        impact: an `Impact`, or a result, which has the same parameters.
    """
    if impact.method == "resolved":
        return RESOLVED_TIMESTEP
    rings = impact.tangential in RINGING and impact.grain_damping < 1
    if rings or impact.wall_friction > MUCH_FRICTION:
        steps = RINGING_STEPS
    else:
        steps = CONTACT_STEPS if impact.restitution >= MUCH_DAMPED else DAMPED_STEPS
    return min(LONGEST_TIMESTEP, float(f"{hertz_contact_time(impact) / steps:.2g}"))


def bare_half_angle(carrier_diameter: float, grain_diameter: float) -> float:
    """Half-angle of a bare cap that keeps grains off the wall until the carrier's largest overlap, rad.

    cos theta = (R_p - R_d - delta)/(R_p + R_d), rounded up to hundredths, with Hertz' delta of steel on steel at
    `BARE_SPEED`, the same share of R_p for all sizes. 0.33 for 20 um on 1.5 mm; the fix and create_dust do the same.

    Args:
        carrier_diameter: d_p, m.
        grain_diameter: d_d, m.
    """
    mass_per_cube = 4 / 3 * math.pi * CARRIER_DENSITY
    overlap = (15 * mass_per_cube * BARE_SPEED**2 / (16 * CONTACT_MODULUS)) ** 0.4
    level = ((1 - overlap) * carrier_diameter - grain_diameter) / (carrier_diameter + grain_diameter)
    return math.ceil(100 * math.acos(level)) / 100


def as_impact(value: object, name: str) -> Impact:
    """An impact that a caller has passed.

    Args:
        value: what was passed.
        name: what the message calls it.

    Raises:
        InvalidInput: it is another thing.
    """
    if not isinstance(value, Impact):
        raise InvalidInput(f"{name}: {shown(value)} is not an Impact")
    return value


PARAMETERS = tuple(field.name for field in fields(Impact))
PARAMETER_TYPES = {field.name: str(field.type) for field in fields(Impact)}


def _convert(name: str, kind: str, value: Any) -> str | bool | int | float:
    """The value as its field's type; numbers may come as any kind of number, numpy's included."""
    if kind == "str":
        if not isinstance(value, str):
            raise InvalidInput(f"{option(name)}: {shown(value)} is not a word")
        return str(value)
    if kind == "bool":
        if not isinstance(value, bool) and not _is_numpys_bool(value):
            raise InvalidInput(f"{option(name)}: {shown(value)} is not true or false")
        return bool(value)
    number = finite_number(name, value)
    if kind == "int":
        if int(value) != number:
            raise InvalidInput(f"{option(name)}: {number:g} is not a whole number")
        return int(value)
    return number


def _is_numpys_bool(value: Any) -> bool:
    """Told without numpy, which takes longer to import than all the rest."""
    return getattr(getattr(value, "dtype", None), "kind", "") == "b"


def finite_number(name: str, value: Any) -> float:
    """A number of any kind as a plain one.

    Raises:
        InvalidInput: it is none, or not finite.
    """
    listed = getattr(value, "ndim", 0) > 0
    if listed or isinstance(value, (str, bytes, bytearray, bool)) or _is_numpys_bool(value):
        raise InvalidInput(f"{option(name)}: {shown(value)} is not a number")
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InvalidInput(f"{option(name)}: {shown(value)} is not a finite number") from None
    if not math.isfinite(number):
        raise InvalidInput(f"{option(name)}: {number} is not a finite number")
    return number


def _one_of(name: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise InvalidInput(f"{option(name)}: unknown choice {shown(value)}; allowed: {', '.join(allowed)}")


def _above(name: str, value: float, low: float, high: float, unit: str = "", *, included: bool = True) -> None:
    if not (low < value <= high if included else low < value < high):
        allowed = f"above {low:g} and {'at most' if included else 'below'} {high:g} {unit}".rstrip()
        raise InvalidInput(f"{option(name)}: {value:g} is out of range; allowed: {allowed}")
    if low == 0 and value < SMALLEST:
        raise InvalidInput(f"{option(name)}: {value:g} is too small to compute with; allowed: at least {SMALLEST:g}")


def _from(name: str, value: float, low: float, high: float, unit: str = "", *, included: bool = True) -> None:
    if not (low <= value <= high if included else low <= value < high):
        end = "to" if included else "to below"
        allowed = f"{low:g} {end} {high:.9g} {unit}".rstrip()
        raise InvalidInput(f"{option(name)}: {value:.10g} is out of range; allowed: {allowed}")
