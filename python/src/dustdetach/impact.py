"""One impact of a dust-laden carrier on a wall: what its parameters must be, and what follows from them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from .about import Derived, DerivedWord, converted, given, option
from .errors import InvalidInput, shown
from .materials import Material, find_material
from .parameters import ABOUT, DISTRIBUTIONS, LONGEST_TIMESTEP, OWN, PARAMETER_TYPES, RINGING, Parameters

#: share of a surface that random sequential placement of discs covers before it jams
JAMMING = 0.547

#: the most grains a texture may have; beyond it a case would not fit in memory
MOST_GRAINS = 10_000_000

#: the pull-off force per mass must be that of gravity at least, m/s2, and the surface energy at most this, J/m2
GRAVITY, LARGEST_SURFACE_ENERGY = 9.81, 10.0

#: largest overlap over the carrier's radius of steel on steel at 20 m/s, which the default of the bare cap allows for
BARE_OVERLAP = 0.025597

#: steps in a contact of Hertz: in general, at a restitution below `MUCH_DAMPED`, when damping is strongest at first
#: touch, and where grains ring, or wall friction above `MUCH_FRICTION` shakes them, whatever the restitution
CONTACT_STEPS, DAMPED_STEPS, RINGING_STEPS = 300, 1000, 3000
MUCH_DAMPED, MUCH_FRICTION = 0.5, 0.1

#: s, what a resolved run takes where none is given
RESOLVED_TIMESTEP = 1e-9

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

#: volume fraction at which distributions are cut below and above, and the standard deviations it is from the median
CUT, CUT_DEVIATIONS = 0.01, 2.3263478740408408

#: the parts of an impact that have a material, and which of its numbers they need; a rigid wall needs no density
PARTS = {
    "carrier": ("density", "modulus", "poisson"),
    "wall": ("modulus", "poisson"),
    "grain": ("density", "modulus", "poisson"),
}


@dataclass(frozen=True, kw_only=True)
class Impact(Parameters):
    """A carrier with a monolayer of dust hits a rigid wall: `Parameters` that have been checked.

    A parameter that is not given and follows from others (``bare``, the numbers of the materials, the Hamaker
    constants, the surface energy and the time step) is filled in, and follows again in `dataclasses.replace`.

    Raises:
        InvalidInput: a value outside its range; the message names the option.
    """

    def __post_init__(self) -> None:
        for name, about in ABOUT.items():
            value = getattr(self, name)
            if isinstance(value, Derived):
                continue
            value = converted(name, PARAMETER_TYPES[name], value)
            about.check(name, value)
            object.__setattr__(self, name, value)
        if self.meet and not given(self.tangential):
            object.__setattr__(self, "tangential", DerivedWord("integrate"))
        self._fill_materials()
        self._check_sizes()
        self._fill_adhesion()
        self._check_adhesion()
        if self.method == "functions" and self.tangential not in RINGING and self.grain_damping != Impact.grain_damping:
            raise InvalidInput(
                f"--grain-damping: {self.grain_damping:g} does nothing with --tangential {self.tangential}, which does "
                f"not know how a grain's contact rings; allowed: {Impact.grain_damping:g}, or --tangential "
                + " or ".join(RINGING)
            )
        self._check_meeting()
        self._check_spin()
        self._fill("timestep", default_timestep(self))
        steps = self.hertz_contact_time / self.timestep
        if not LEAST_STEPS <= steps <= MOST_STEPS:
            raise InvalidInput(
                f"--timestep: {self.timestep:g} s makes {steps:.3g} steps of a contact of "
                f"{self.hertz_contact_time:.3g} s; allowed: {self.hertz_contact_time / MOST_STEPS:.3g} to "
                f"{self.hertz_contact_time / LEAST_STEPS:.3g} s for this speed, angle and carrier"
            )
        if self.method == "resolved":
            self._check_resolved()

    def _fill(self, name: str, value: float) -> None:
        """Set a number that nobody has given, if so."""
        if isinstance(getattr(self, name), Derived):
            object.__setattr__(self, name, Derived(value))

    def _fill_materials(self) -> None:
        for part, keys in PARTS.items():
            numbers = [f"{part}_{key}" for key in keys]
            name = getattr(self, part)
            named = given(name)
            material = find_material(name if named else getattr(Parameters, part), part)
            own = not named and any(given(getattr(self, number)) for number in numbers)
            object.__setattr__(self, part, material.name if named else OWN if own else getattr(Parameters, part))
            for number, key in zip(numbers, keys, strict=True):
                self._fill(number, getattr(material, key))

    def material(self, part: str) -> Material:
        """The material that a part is named after; its numbers may have been replaced.

        Args:
            part: ``carrier``, ``wall`` or ``grain``.
        """
        name = getattr(self, part)
        return find_material(getattr(Parameters, part) if isinstance(name, DerivedWord) else name, part)

    def _check_sizes(self) -> None:
        """Distribution, diameters, bare cap and coverage, which limit each other."""
        spread = self.distribution != "none"
        if not spread and self.distribution_spread != Impact.distribution_spread:
            raise InvalidInput(
                f"--distribution-spread: {self.distribution_spread:g} does nothing without a distribution; allowed: "
                f"with --distribution {' or '.join(DISTRIBUTIONS[1:])}"
            )
        if self.distribution == "lognormal" and self.distribution_spread <= 1:
            raise InvalidInput(
                f"--distribution: spread {self.distribution_spread:g} is out of range; allowed: above 1 for lognormal"
            )
        radius = self.carrier_diameter / 2
        if not self.grain_diameter < radius or not self.coarsest < radius:
            raise InvalidInput(
                f"--grain-diameter: {self.grain_diameter:g} is out of range; allowed: above 0 and below "
                f"{radius * self.grain_diameter / self.coarsest:g} m"
                + (", where the coarsest grains have the carrier's radius" if spread else ", the carrier's radius")
            )
        self._fill("bare", bare_half_angle(self.carrier_diameter, self.coarsest))
        if self.coverage > self.largest_coverage:
            raise InvalidInput(
                f"--coverage: {self.coverage:g} is out of range; allowed: above 0 and at most "
                f"{self.largest_coverage:g} (random placement jams there)"
            )
        if self.grains > MOST_GRAINS:
            smallest = self.grain_diameter * math.sqrt(self.grains / MOST_GRAINS)
            raise InvalidInput(
                f"--grain-diameter: {self.grain_diameter:g} makes {self.grains:.3g} grains; allowed: "
                f"{smallest:.3g} to {self.carrier_diameter:g} m at this coverage"
            )
        if self.grains < 1:
            raise InvalidInput(
                f"--coverage: {self.coverage:g} leaves no grain on the carrier; allowed: above "
                f"{(self.grain_diameter / self.carrier_diameter) ** 2 / 8:.3g} for these diameters"
            )

    def _fill_adhesion(self) -> None:
        """Hamaker constants from materials or the surface energy, and the surface energy from them."""
        if given(self.surface_energy):
            made = 18 * math.pi * self.z0**2 * self.surface_energy
            if given(self.hamaker):
                raise InvalidInput(
                    "--surface-energy: the adhesion is given twice; allowed: either --surface-energy, or --hamaker "
                    "with --z0"
                )
            self._fill("hamaker", made)
            if self.method == "resolved":
                ABOUT["hamaker"].check("hamaker", self.hamaker)
        else:
            if not given(self.hamaker):
                self._fill("hamaker", self._pair_hamaker("carrier"))
            self._fill("surface_energy", self.hamaker / (18 * math.pi * self.z0**2))
        self._fill("wall_hamaker", self._wall_hamaker())
        own = self.material("grain").hamaker
        if own is None and (self.method == "resolved" or self.meet) and not given(self.grain_hamaker):
            raise InvalidInput(
                f"--grain-hamaker: the material {self.grain} has no Hamaker constant; allowed: "
                f"{ABOUT['grain_hamaker'].allowed}"
            )
        self._fill("grain_hamaker", own or 0.0)

    def _wall_hamaker(self) -> float:
        """Of grain and wall: as on the carrier if both are of one material, or if a surface energy is given."""
        alike = self.material("wall").name == self.material("carrier").name or given(self.surface_energy)
        lacking = self.material("wall").hamaker is None or self.material("grain").hamaker is None
        if alike or (lacking and self.method == "functions"):
            return self.hamaker
        return float(self.wall_hamaker) if given(self.wall_hamaker) else self._pair_hamaker("wall")

    def _pair_hamaker(self, part: str) -> float:
        """A_12 = sqrt(A_11 A_22) of grain and carrier or wall, to five digits as the paper's, J."""
        product = 1.0
        for each in ("grain", part):
            material = self.material(each)
            if material.hamaker is None:
                name = "hamaker" if part == "carrier" else "wall_hamaker"
                raise InvalidInput(
                    f"{option(name)}: the material {material.name} has no Hamaker constant; allowed: "
                    f"{ABOUT[name].allowed}" + (", or --surface-energy" if part == "carrier" else "")
                )
            product *= material.hamaker
        return float(f"{math.sqrt(product):.4e}")

    def _check_adhesion(self) -> None:
        """What makes no sense as adhesion shows that something was given in other units; the fix asks for the same."""
        if self.surface_energy > LARGEST_SURFACE_ENERGY:
            least = math.sqrt(self.hamaker / (18 * math.pi * LARGEST_SURFACE_ENERGY))
            raise InvalidInput(
                f"--z0: {self.z0:g} m makes a surface energy of {self.surface_energy:.3g} J/m2; allowed: {least:.3g} "
                "to 1e-07 m for this Hamaker constant"
            )
        held = self.hold(self.coarsest)
        if held < GRAVITY:
            raise InvalidInput(
                f"--grain-diameter: {self.coarsest:g} m makes grains that are held up to an acceleration of "
                f"{held:.3g} m/s2; allowed: so small that this is at least {GRAVITY:g}"
            )

    def _pull_off_force(self, diameter: float) -> float:
        """F_c = 3 pi gamma R_12 of a grain, the median of its spread, N."""
        return 3 * math.pi * self.surface_energy / (2 / diameter + 2 / self.carrier_diameter)

    def hold(self, diameter: float) -> float:
        """F_c/m_d of a grain: the acceleration up to which it is held, the median of its spread, m/s2."""
        return self._pull_off_force(diameter) / self._mass(diameter)

    def _mass(self, diameter: float) -> float:
        return math.pi / 6 * diameter**3 * self.grain_density

    def _check_meeting(self) -> None:
        """Grains that meet are followed, by one law."""
        if not self.meet:
            return
        if self.method == "resolved":
            raise InvalidInput(
                "--meet: true is for the functions, in a resolved run grains always meet; allowed: false"
            )
        if self.tangential != "integrate":
            raise InvalidInput(
                f"--meet: true does nothing with --tangential {self.tangential}, which follows no grain; allowed: "
                "--tangential integrate"
            )

    def _check_spin(self) -> None:
        """A spin that throws grains off before the impact is not this impact's."""
        if self.spin == 0:
            return
        if self.method == "functions" and not self.rotation:
            raise InvalidInput(
                f"--spin: {self.spin:g} rad/s does nothing where the spin is not followed; allowed: 0, or --rotation"
            )
        reach = (self.carrier_diameter + self.coarsest) / 2
        fastest = math.sqrt(self.hold(self.coarsest) / reach)
        if abs(self.spin) >= fastest:
            raise InvalidInput(
                f"--spin: {self.spin:g} rad/s throws grains off before the impact; allowed: above -{fastest:.4g} and "
                f"below {fastest:.4g} rad/s for these grains"
            )

    def _check_resolved(self) -> None:
        """What a resolved run needs beyond the ranges of all impacts."""
        if not self.rotation:
            raise InvalidInput(
                "--rotation: false is for the functions, a resolved run always follows the spin; allowed: true"
            )
        if self.distribution == "rrsb":
            raise InvalidInput("--distribution: rrsb is for the functions; allowed in a resolved run: none, lognormal")
        if self.distribution != "none" and self.spread > 1:
            raise InvalidInput(
                f"--spread: {self.spread:g} is not there in a resolved run with a distribution of sizes; allowed: 1"
            )
        if self.grains > MOST_RESOLVED_GRAINS:
            smallest = self.grain_diameter * math.sqrt(self.grains / MOST_RESOLVED_GRAINS)
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
    def contact_modulus(self) -> float:
        """E* of carrier and wall, Pa."""
        return contact_modulus(self)

    @property
    def adhesion_modulus(self) -> float:
        """E* of grain and carrier, Pa."""
        return combined_modulus(self.grain_modulus, self.grain_poisson, self.carrier_modulus, self.carrier_poisson)

    @property
    def finest(self) -> float:
        """Diameter of the finest grains that there can be, m."""
        return self.quantile(CUT)

    @property
    def coarsest(self) -> float:
        """Diameter of the coarsest grains that there can be, m."""
        return self.quantile(1 - CUT)

    def quantile(self, fraction: float) -> float:
        """Diameter below which there is this fraction of the volume, before the cuts at 0.01 and 0.99, m."""
        if self.distribution == "none":
            return self.grain_diameter
        if self.distribution == "rrsb":
            return float(self.grain_diameter * (-math.log1p(-fraction) / math.log(2)) ** (1 / self.distribution_spread))
        deviations = math.copysign(CUT_DEVIATIONS, fraction - 0.5)
        if fraction not in (CUT, 1 - CUT):
            deviations = _normal_quantile(fraction)
        return self.grain_diameter * math.exp(deviations * math.log(self.distribution_spread))

    @property
    def grain_period(self) -> float:
        """Period of a grain that oscillates about its equilibrium overlap on the carrier, 2 pi sqrt(m_d/k_0), s.

        k_0 = 6/5 E* a_0 with a_0 = (A R_12^2/(2 z0^2 E*))^(1/3); with a spread that of the grains that hold hardest, at
        three standard deviations, with a distribution that of the finest, as the deck of resolved runs has them.
        """
        hardest = self.hamaker * self.spread**3
        effective = 1 / (2 / self.finest + 2 / self.carrier_diameter)
        modulus = self.adhesion_modulus
        contact_radius = (hardest * effective**2 / (2 * self.z0**2 * modulus)) ** (1 / 3)
        return 2 * math.pi * math.sqrt(self._mass(self.finest) / (1.2 * modulus * contact_radius))

    @property
    def hertz_contact_time(self) -> float:
        """Contact time of the undamped impact (Hertz), s; see `hertz_contact_time`."""
        return hertz_contact_time(self)

    @property
    def grains(self) -> int:
        """Number of grains of the monolayer, N = 4 X0 (R_p/R_d)^2; with a distribution about so many."""
        equal = 4 * self.coverage * (self.carrier_diameter / self.grain_diameter) ** 2
        if self.distribution != "none":
            equal *= _grains_for_one(self.distribution, self.distribution_spread)
        return round(equal)

    @property
    def largest_coverage(self) -> float:
        """Coverage at which random sequential placement jams, 0.547 ((R_p+R_d)/R_p)^2 (1 - (1 - cos bare)/2)."""
        shell = (1 + self.grain_diameter / self.carrier_diameter) ** 2
        return float(round(JAMMING * shell * (1 + math.cos(self.bare)) / 2, 4))

    def deck_variables(self) -> dict[str, str | int | float]:
        """The variables of the deck of the impact's method (``-var NAME VALUE``)."""
        variables: dict[str, Any] = {
            about.variables.get(self.method, name): getattr(self, name)
            for name, about in ABOUT.items()
            if about.deck and self.method in about.methods
        }
        if given(self.surface_energy):
            del variables["hamaker"]
            variables["surface_energy"] = self.surface_energy
        if self.method == "resolved":
            if self.distribution == "lognormal":
                variables["sigma_g"] = self.distribution_spread
            return variables
        variables["rotation"] = "yes" if self.rotation else "no"
        if self.meet:
            variables["cohesion"] = self.grain_hamaker / self.hamaker
        if self.tangential not in RINGING:
            del variables["grain_damping"]
        if self.distribution != "none":
            variables["distribution"] = self.distribution
            variables["distribution_spread"] = self.distribution_spread
        return variables

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> Impact:
        """An impact from names and values.

        Raises:
            InvalidInput: an unknown name, a missing speed, or a value out of its range.
        """
        if not isinstance(values, Mapping):
            raise InvalidInput(f"{shown(values)} is not a mapping of names and values")
        for name in values:
            if name not in ABOUT:
                raise InvalidInput(f"{name}: unknown parameter; allowed: {', '.join(ABOUT)}")
        if "speed" not in values:
            raise InvalidInput(f"speed: missing; allowed: {ABOUT['speed'].allowed}")
        return cls(**values)


def combined_modulus(modulus: float, poisson: float, other_modulus: float, other_poisson: float) -> float:
    """E* of two materials, 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2, Pa."""
    return 1 / ((1 - poisson**2) / modulus + (1 - other_poisson**2) / other_modulus)


def contact_modulus(case: Parameters) -> float:
    """E* of carrier and wall, Pa.

    Args:
        case: an impact or its result.
    """
    return combined_modulus(case.carrier_modulus, case.carrier_poisson, case.wall_modulus, case.wall_poisson)


def hertz_contact_time(case: Parameters) -> float:
    """Contact time of an undamped impact (Hertz), s.

    2.9432 overlap/speed with overlap = (15 m v^2/(16 E* sqrt(R)))^0.4, E* of carrier and wall, and the speed normal to
    the wall.

    Args:
        case: an impact or its result.
    """
    radius = case.carrier_diameter / 2
    speed = case.speed * math.sin(math.radians(case.angle))
    mass = 4 / 3 * math.pi * radius**3 * case.carrier_density
    overlap = (15 * mass * speed**2 / (16 * contact_modulus(case) * math.sqrt(radius))) ** 0.4
    return float(2.9432 * overlap / speed)


def default_timestep(case: Parameters) -> float:
    """The time step of an impact that is given none, s: a share of `hertz_contact_time`, to two digits.

    1/300 of it; 1/1000 at a restitution below 0.5; 1/3000 at a wall friction above 0.1, and where a law in `RINGING` is
    given a damping ratio below 1. At most 1e-7 s. In a resolved run 1e-9 s.

    Args:
        case: an impact or its result.
    """
    if case.method == "resolved":
        return RESOLVED_TIMESTEP
    rings = case.tangential in RINGING and case.grain_damping < 1
    if rings or case.wall_friction > MUCH_FRICTION:
        steps = RINGING_STEPS
    else:
        steps = CONTACT_STEPS if case.restitution >= MUCH_DAMPED else DAMPED_STEPS
    return min(LONGEST_TIMESTEP, float(f"{hertz_contact_time(case) / steps:.2g}"))


def is_timestep_chosen(cases: Iterable[Parameters]) -> bool:
    """Whether nobody has asked for the time steps: each is `default_timestep`, whatever else differs.

    Args:
        cases: impacts or results.
    """
    return all(case.timestep == default_timestep(case) for case in cases)


def _normal_quantile(fraction: float) -> float:
    from statistics import NormalDist

    return NormalDist().inv_cdf(fraction)


@cache
def _grains_for_one(distribution: str, spread: float) -> float:
    """Grains of a distribution that cover as much as one of its median diameter, by means over the volume."""
    number = squares = 0.0
    intervals = 400
    for k in range(intervals):
        # equal steps of the logarithm, as fine grains count most
        fraction = CUT * ((1 - CUT) / CUT) ** ((k + 0.5) / intervals)
        if distribution == "rrsb":
            size = (-math.log1p(-fraction) / math.log(2)) ** (1 / spread)
        else:
            size = spread ** _normal_quantile(fraction)
        number += fraction / size**3
        squares += fraction / size
    return number / squares


def bare_half_angle(carrier_diameter: float, grain_diameter: float) -> float:
    """Half-angle of a bare cap that keeps grains off the wall until the carrier's largest overlap, rad.

    cos theta = (R_p - R_d - delta)/(R_p + R_d), rounded up to hundredths, with Hertz' delta of steel on steel at 20
    m/s, the same share of R_p for all sizes. 0.33 for 20 um on 1.5 mm; the fix and create_dust do the same.

    Args:
        carrier_diameter: d_p, m.
        grain_diameter: d_d of the coarsest grains, m.
    """
    level = ((1 - BARE_OVERLAP) * carrier_diameter - grain_diameter) / (carrier_diameter + grain_diameter)
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
