"""The parameters of an impact, each described once: see `about` for what follows from a description."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields

from .about import FOLLOWS, About, DerivedWord, about, described
from .materials import PROPERTIES

METHODS = ("functions", "resolved")
#: laws of tangential lift-off that know how a grain's contact rings
RINGING = ("impulse", "integrate")
TANGENTIAL = ("impulse", "estimate", "integrate", "frictionless", "off")

#: sizes of grains: all of one, lognormal or Rosin-Rammler by volume
DISTRIBUTIONS = ("none", "lognormal", "rrsb")

#: m/s
FASTEST = 100.0

LARGEST_SEED = 900_000_000

#: s
LONGEST_TIMESTEP = 1e-7

#: what the reference case is made of
CARRIER, WALL, GRAIN = (DerivedWord(name) for name in ("stainless steel", "stainless steel", "limestone"))

#: in place of a material's name where its numbers alone are given
OWN = DerivedWord("own numbers")

#: versions of records: with a spread of adhesion, with materials, with grains that meet
SPREAD, MATERIALS, MEETING = 1, 2, 3

_FUNCTIONS, _RESOLVED = ("functions",), ("resolved",)


def _material(part: str, key: str, symbol: str, figure_unit: str = "", factor: float = 1.0) -> dict[str, About]:
    """Metadata of a number of a material."""
    known = PROPERTIES[key]
    return about(
        f"{known.help} of the {part}",
        unit=known.unit,
        above=known.above,
        least=known.least,
        most=known.most,
        follows=f"that of the material --{part}",
        symbol=symbol,
        figure_unit=figure_unit,
        factor=factor,
        since=MATERIALS,
    )


def _name(part: str) -> dict[str, About]:
    return about(f"material of the {part}; dustdetach materials shows all", symbol=part, deck=False, since=MATERIALS)


def _hamaker(pair: str, follows: str, variable: str, used: str = "") -> dict[str, About]:
    """Metadata of a Hamaker constant that resolved runs use, and what else does."""
    return about(
        f"Hamaker constant of {pair}, in a resolved run{used}",
        unit="J",
        least=1e-22,
        most=1e-17,
        follows=follows,
        methods=_RESOLVED,
        variables={"resolved": variable},
        symbol=f"$A$ of {pair}",
        figure_unit="10$^{-20}$ J",
        factor=1e20,
        since=MATERIALS,
    )


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """The parameters of an impact. SI units, angles as stated; `Impact` checks them and says what they mean together.

    The defaults are the reference case of the paper: a steel carrier of 1.5 mm with calcium carbonate grains of
    20 um at a coverage of 0.2.
    """

    method: str = field(
        default="functions",
        metadata=about(
            "functions (the detachment functions on a carrier without grains as atoms) or resolved (every grain an "
            "atom with adhesive contacts)",
            choices=METHODS,
            deck=False,
        ),
    )
    speed: float = field(metadata=about("impact speed", unit="m/s", above=0.0, most=FASTEST, symbol="$v_p$"))
    angle: float = field(
        default=90.0,
        metadata=about(
            "angle between velocity and wall; 90 is straight",
            unit="degrees",
            above=0.0,
            most=90.0,
            title="angle to the wall",
            symbol=r"$\alpha$",
            figure_unit="°",
        ),
    )
    restitution: float = field(
        default=0.7,
        metadata=about("coefficient of restitution of carrier and wall", least=0.01, most=1.0, symbol="$e_{pw}$"),
    )
    spin: float = field(
        default=0.0,
        metadata=about(
            "carrier's spin before the impact, about the axis across its path; above 0 as when it rolls on",
            unit="rad/s",
            title="spin before the impact",
            symbol=r"$\omega$",
            since=MATERIALS,
        ),
    )
    coverage: float = field(
        default=0.2,
        metadata=about(
            "coverage X0, grain cross-sections over the carrier's surface",
            above=0.0,
            limit="and at most 0.5 or so, where random placement jams",
            title="coverage",
            symbol="$X_0$",
        ),
    )
    bare: float = field(
        default=FOLLOWS,
        metadata=about(
            "half-angle of the bare cap where the carrier meets the wall",
            unit="rad",
            least=0.0,
            below=math.pi,
            follows="so wide that no grain reaches the wall, 0.33 in the reference case",
            title="half-angle of the bare cap",
            symbol=r"$\theta_{bare}$",
        ),
    )
    grain_diameter: float = field(
        default=20e-6,
        metadata=about(
            "diameter of the grains; with a distribution their median by volume",
            unit="m",
            above=0.0,
            title="diameter of the grains",
            symbol="$d_d$",
            figure_unit="µm",
            factor=1e6,
        ),
    )
    distribution: str = field(
        default="none",
        metadata=about(
            "sizes of the grains by volume: none (all alike), lognormal or rrsb (Rosin-Rammler), cut at the volume "
            "fractions 0.01 and 0.99",
            choices=DISTRIBUTIONS,
            deck=False,
            symbol="sizes",
            since=MATERIALS,
        ),
    )
    distribution_spread: float = field(
        default=1.0,
        metadata=about(
            "geometric standard deviation of a lognormal distribution, or exponent of an rrsb one",
            deck=False,
            above=0.0,
            most=100.0,
            title="spread of sizes",
            symbol=r"$\sigma_g$",
            since=MATERIALS,
        ),
    )
    carrier_diameter: float = field(
        default=1.5e-3,
        metadata=about(
            "diameter of the carrier", unit="m", above=0.0, most=1.0, symbol="$d_p$", figure_unit="mm", factor=1e3
        ),
    )
    carrier: str = field(default=CARRIER, metadata=_name("carrier"))
    wall: str = field(default=WALL, metadata=_name("wall"))
    grain: str = field(default=GRAIN, metadata=_name("grain"))
    carrier_density: float = field(default=FOLLOWS, metadata=_material("carrier", "density", r"$\rho_p$"))
    carrier_modulus: float = field(default=FOLLOWS, metadata=_material("carrier", "modulus", "$E_p$", "GPa", 1e-9))
    carrier_poisson: float = field(default=FOLLOWS, metadata=_material("carrier", "poisson", r"$\nu_p$"))
    wall_modulus: float = field(default=FOLLOWS, metadata=_material("wall", "modulus", "$E_w$", "GPa", 1e-9))
    wall_poisson: float = field(default=FOLLOWS, metadata=_material("wall", "poisson", r"$\nu_w$"))
    grain_density: float = field(default=FOLLOWS, metadata=_material("grain", "density", r"$\rho_d$"))
    grain_modulus: float = field(default=FOLLOWS, metadata=_material("grain", "modulus", "$E_d$", "GPa", 1e-9))
    grain_poisson: float = field(default=FOLLOWS, metadata=_material("grain", "poisson", r"$\nu_d$"))
    hamaker: float = field(
        default=FOLLOWS,
        metadata=about(
            "Hamaker constant A_12 of grain and carrier",
            unit="J",
            least=1e-22,
            most=1e-17,
            follows="the root of those of the two materials, to five digits",
            symbol="$A_{12}$",
            figure_unit="10$^{-20}$ J",
            factor=1e20,
        ),
    )
    wall_hamaker: float = field(
        default=FOLLOWS,
        metadata=_hamaker(
            "grain and wall", "that of the two materials; --hamaker, if the wall is as the carrier", "hamaker_wall"
        ),
    )
    grain_hamaker: float = field(
        default=FOLLOWS,
        metadata=_hamaker("two grains", "that of the material --grain", "hamaker_grains", " and with --meet"),
    )
    z0: float = field(
        default=0.4e-9,
        metadata=about(
            "separation at which van der Waals force and pull-off force are equal",
            unit="m",
            least=1e-11,
            most=1e-7,
            title="separation of equal forces",
            symbol="$z_0$",
            figure_unit="nm",
            factor=1e9,
        ),
    )
    surface_energy: float = field(
        default=FOLLOWS,
        metadata=about(
            "surface energy of grain and carrier, in place of a Hamaker constant; the pull-off force is 3 pi gamma R",
            unit="J/m2",
            above=0.0,
            most=10.0,
            follows="A_12/(18 pi z0^2)",
            deck=False,
            title="surface energy of grain and carrier",
            symbol=r"$\gamma$",
            figure_unit="mJ/m²",
            factor=1e3,
            since=MATERIALS,
        ),
    )
    spread: float = field(
        default=1.0,
        metadata=about(
            "geometric standard deviation of the grains' pull-off forces; 1: all alike",
            least=1.0,
            most=100.0,
            title="spread of pull-off forces",
            symbol=r"$\sigma_a$",
            since=SPREAD,
        ),
    )
    friction: float = field(
        default=0.3, metadata=about("friction mu_f of grain and carrier", least=0.0, most=10.0, symbol=r"$\mu_f$")
    )
    wall_friction: float = field(
        default=0.05, metadata=about("friction mu of carrier and wall", least=0.0, most=10.0, symbol=r"$\mu_w$")
    )
    grain_damping: float = field(
        default=1.0,
        metadata=about(
            "damping ratio of a grain's contact; resolved runs and --tangential " + " or ".join(RINGING) + " use it",
            least=0.0,
            most=100.0,
            title="damping ratio of a grain's contact",
            symbol=r"$\zeta$",
        ),
    )
    seed: int = field(
        default=1, metadata=about("seed of the random texture", least=1, most=LARGEST_SEED, symbol="seed")
    )
    tangential: str = field(
        default=DerivedWord("impulse"),
        metadata=about(
            "law of tangential lift-off: " + ", ".join(TANGENTIAL),
            choices=TANGENTIAL,
            methods=_FUNCTIONS,
            symbol="law",
        ),
    )
    meet: bool = field(
        default=False,
        metadata=about(
            "whether moving grains knock others off, which takes seconds, by --tangential integrate; in resolved runs "
            "they always do",
            deck=False,
            methods=_FUNCTIONS,
            symbol="grains meet",
            since=MEETING,
        ),
    )
    rotation: bool = field(
        default=True,
        metadata=about(
            "whether the functions follow the carrier's spin; resolved runs always do",
            deck=False,
            methods=_FUNCTIONS,
            symbol="rotation",
        ),
    )
    timestep: float = field(
        default=FOLLOWS,
        metadata=about(
            "time step",
            unit="s",
            above=0.0,
            most=LONGEST_TIMESTEP,
            follows="a share of the contact time, 1/300 in general; 1e-9 in a resolved run",
            symbol=r"$\Delta t$",
            figure_unit="ns",
            factor=1e9,
        ),
    )

    def values(self) -> dict[str, str | bool | int | float]:
        """Every parameter by name, in order, whether given or not."""
        return {name: getattr(self, name) for name in ABOUT}


#: what is known of each parameter, in order
ABOUT = described(Parameters)

PARAMETERS = tuple(ABOUT)

#: under `from __future__ import annotations` a field's type is its spelling
PARAMETER_TYPES = {of.name: str(of.type) for of in fields(Parameters)}

Parameters.__doc__ = f"{Parameters.__doc__}\n    Attributes:\n" + "".join(
    f"        {name}: {known.help}{f', {known.unit}' if known.unit else ''}; {known.allowed}.\n"
    for name, known in ABOUT.items()
)
