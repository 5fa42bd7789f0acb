#!/usr/bin/env python3
"""Makes the tables of doc/validation.rst from real runs and prints them.

    . build/environment && build/venv/bin/python doc/validation/tables.py [NAME ...]

NAME is one of the functions named table_* below, without that prefix; all of them by default (about half a minute).
The reference is computed here, without any code of the package: a damped Hertz impact integrated by SciPy and the
closed form of the two detachment functions for a uniform layer and an acceleration along the wall normal.
"""

import itertools
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from dustdetach import Impact, run
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

ROOT = Path(__file__).resolve().parents[2]

# reference case, SI units
R_P, RHO_P, E_STAR = 0.75e-3, 7700.0, 210e9 / (2 * (1 - 0.3**2))
R_D, RHO_D = 10e-6, 2700.0
HAMAKER, MU_F = 14.633e-20, 0.3
M_P = 4 / 3 * math.pi * R_P**3 * RHO_P
M_D = 4 / 3 * math.pi * R_D**3 * RHO_D


# --- reference -------------------------------------------------------------------------------------------
def impact(alpha: float) -> tuple[float, float, float]:
    """Dimensionless impact y'' = -max(0, y^1.5 - alpha y^0.25 (-v)), speed 1: restitution, duration, peak.

    y is overlap over the length (m v0^2/k)^(2/5), t is time times v0 over that length, with F_el = k delta^1.5.
    """

    def force(y: float, v: float) -> float:
        y = max(y, 0.0)
        return max(0.0, y**1.5 + alpha * y**0.25 * v)  # v = dy/dt, positive into the wall

    def no_force(_t: float, s: list[float]) -> float:
        return s[0] ** 1.25 + alpha * s[1] if s[0] > 0 and s[1] < 0 else 1.0

    no_force.terminal = True
    # y ~ t at first; the damping force's root at y = 0 makes a tiny first step necessary
    out = solve_ivp(
        lambda t, s: (s[1], -force(*s)),
        (0, 30),
        (1e-12, 1.0),
        events=no_force,
        method="DOP853",
        rtol=1e-11,
        atol=1e-13,
        max_step=0.005,
    )
    peak = max(force(y, v) for y, v in zip(*out.y, strict=True))
    return -out.y[1, -1], out.t[-1], peak


@cache
def alpha(e: float) -> float:
    """Damping that realises e, by trial."""
    return brentq(lambda a: impact(a)[0] - e, 0.0, 4.0, xtol=1e-8)


@dataclass
class Reference:
    south: float
    north: float
    contact_time: float
    peak: float


def reference(speed: float, e: float, bare: float = 0.33, z0: float = 0.4e-9) -> Reference:
    """Straight impact of the reference carrier, any speed, e, bare cap and z0."""
    k = 4 / 3 * E_STAR * math.sqrt(R_P)
    length = (M_P * speed**2 / k) ** 0.4
    _, duration, peak = impact(alpha(e))
    time, a_max = duration * length / speed, peak * speed**2 / length

    gamma = HAMAKER / (18 * math.pi * z0**2)
    c = 3 * math.pi * gamma * R_P * R_D / (R_P + R_D) / M_D  # F_c/m_d
    grains = (1 + math.cos(bare)) / 2  # share of the sphere that holds grains
    south = max(0.0, (1 - c / a_max) / 2 - (1 - math.cos(bare)) / 2)

    def excess(u: float) -> float:  # of v_t^2 over v_crit^2 at cos(theta) = u
        vt0 = speed * (1 + e) * math.sqrt(1 - u * u)
        return vt0**2 - 0.5 * MU_F * vt0 * time * (2 * c + a_max * u) - c * (R_P + R_D)

    north = brentq(excess, 0.0, 1.0) / 2 if excess(0.0) > 0 else 0.0
    return Reference(south / grains, north / grains, time, a_max)


# --- tables ----------------------------------------------------------------------------------------------
def show(title: str, head: str, rows: list[list[str]]) -> None:
    """One table in reStructuredText."""
    names = head.split("|")
    widths = [max(len(x) for x in column) for column in zip(names, *rows, strict=True)]
    rule = "  ".join("=" * w for w in widths)
    print(f"{title}\n\n{rule}\n{'  '.join(n.ljust(w) for n, w in zip(names, widths, strict=True)).rstrip()}\n{rule}")
    for row in rows:
        print("  ".join(x.ljust(w) for x, w in zip(row, widths, strict=True)).rstrip())
    print(rule + "\n", flush=True)


def table_damping() -> None:
    rows = []
    for e in (0.9, 0.7, 0.5, 0.3, 0.1):
        result = run(Impact(speed=4.0, restitution=e))
        rows.append([f"{e}", f"{alpha(e):.4f}", f"{result.restitution_realised:.4f}"])
    show("Damping: alpha by trial integration; e realised at 4 m/s, 1 ns steps", "e|alpha|e realised", rows)


def table_closed_form() -> None:
    rows, worst = [], [0.0, 0.0, 0.0, 0.0]
    for bare in (0.05, 0.33):
        for e in (0.5, 0.7, 0.9):
            for speed in (2.0, 4.0, 6.0, 8.0, 10.0, 12.0):
                ours = run(Impact(speed=speed, restitution=e, bare=bare, tangential="estimate"))
                ref = reference(speed, e, bare)
                errors = [
                    abs(ours.south - ref.south),
                    abs(ours.north - ref.north),
                    abs(ours.contact_time / ref.contact_time - 1),
                    abs(ours.peak_acceleration / ref.peak - 1),
                ]
                worst = [max(w, x) for w, x in zip(worst, errors, strict=True)]
                if bare == 0.33 and speed in (2.0, 4.0, 8.0, 12.0):
                    rows.append(
                        [
                            f"{e}",
                            f"{speed:g}",
                            f"{ours.south:.4f}",
                            f"{ref.south:.4f}",
                            f"{ours.north:.4f}",
                            f"{ref.north:.4f}",
                            f"{ours.contact_time * 1e6:.3f}",
                            f"{ref.contact_time * 1e6:.3f}",
                            f"{ours.peak_acceleration:.4g}",
                            f"{ref.peak:.4g}",
                        ]
                    )
    show("Straight impacts, bare cap 0.33 rad", "e|v|south|ref|north|ref|t (us)|ref|a_max (m/s2)|ref", rows)
    print(
        "largest of 36 cases (also bare cap 0.05 rad, also 6 and 10 m/s): south {:.4f}, north {:.4f}, contact time "
        "{:.2%}, peak acceleration {:.2%}\n".format(*worst)
    )


def table_section5() -> None:
    rows = []

    def claim(what: str, wanted: str, got: str, ok: bool) -> None:
        rows.append([what, wanted, got, "yes" if ok else "NO"])

    def at(**keys: float):
        return run(Impact(**keys))

    x = at(speed=2.0).south
    claim("south, 2 m/s, e 0.7", ">= 0.43", f"{x:.4f}", x >= 0.43)
    x = at(speed=4.0).south
    claim("south, 4 m/s, e 0.7", ">= 0.46", f"{x:.4f}", x >= 0.46)
    souths = [at(speed=4.0, restitution=e).south for e in (0.5, 0.7, 0.9)]
    x = max(souths) - min(souths)
    claim("south, 4 m/s, spread over e 0.5 to 0.9", "<= 0.01", f"{x:.4f}", x <= 0.01)
    x = at(speed=5.0).north
    claim("north, 5 m/s, e 0.7", "0", f"{x:.4f}", x == 0.0)
    x = at(speed=8.0).north
    claim("north, 8 m/s, e 0.7", "> 0.2", f"{x:.4f}", x > 0.2)
    for speed in (8.0, 12.0, 20.0):
        north = [at(speed=speed, restitution=e).north for e in (0.5, 0.7, 0.9)]
        claim(
            f"north, {speed:g} m/s, e 0.5 / 0.7 / 0.9",
            "rising",
            " / ".join(f"{y:.4f}" for y in north),
            north == sorted(set(north)),
        )
    for speed in (4.0, 8.0, 12.0):
        ratio = [at(speed=speed, angle=a).dispersion_ratio for a in (90.0, 75.0, 60.0, 45.0, 30.0)]
        claim(
            f"ratio, {speed:g} m/s, 90 / 75 / 60 / 45 / 30 deg",
            "falling",
            " / ".join(f"{y:.3f}" for y in ratio),
            all(y < z for z, y in itertools.pairwise(ratio)),
        )
    x = at(speed=12.0, angle=60.0).north
    claim("north, 12 m/s, 60 deg", ">= 0.05", f"{x:.4f}", x >= 0.05)
    show("Numbers the paper's text gives or implies", "quantity|wanted|found|holds", rows)


def table_wall_friction() -> None:
    rows = []
    for mu in (0.0, 0.05, 0.1, 0.3):
        for speed in (2.0, 4.0, 8.0, 12.0):
            ratio = [
                run(Impact(speed=speed, angle=a, wall_friction=mu)).dispersion_ratio
                for a in (90.0, 75.0, 60.0, 45.0, 30.0, 15.0)
            ]
            rows.append([f"{mu}", f"{speed:g}", *(f"{y:.3f}" for y in ratio)])
    show("Dispersion ratio by wall friction, e 0.7", "mu|v|90|75|60|45|30|15", rows)


def table_inputs() -> None:
    rows = []
    base = Impact(speed=4.0)
    for name, values in (
        ("bare", (0.0, 0.05, 0.2, 0.33)),
        ("z0", (0.3e-9, 0.4e-9, 0.5e-9)),
        ("friction", (0.1, 0.3, 0.6)),
        ("tangential", ("impulse", "estimate", "integrate", "frictionless", "off")),
        ("seed", (1, 2, 3)),
        ("timestep", (0.5e-9, 1e-9, 2e-9, 4e-9)),
    ):
        for value in values:
            shares = []
            for speed in (4.0, 8.0):
                r = run(replace(base, speed=speed, **{name: value}))
                shares += [f"{r.south:.4f}", f"{r.north:.4f}"]
            rows.append([name, f"{value:g}" if not isinstance(value, str) else value, *shares])
    show("Influence of single inputs, straight, e 0.7", "input|value|south 4|north 4|south 8|north 8", rows)


def table_seeds() -> None:
    rows = []
    limits = {(2.0, "south"): 0.43, (4.0, "south"): 0.46, (8.0, "north"): 0.2}  # of section5
    for speed, sides in ((2.0, ["south"]), (4.0, ["south"]), (8.0, ["south", "north"])):
        ref = reference(speed, 0.7)
        results = [run(Impact(speed=speed, seed=seed, tangential="estimate")) for seed in range(1, 101)]
        for side in sides:
            values = [getattr(r, side) for r in results]
            limit = limits.get((speed, side))
            rows.append(
                [
                    f"{speed:g}",
                    side,
                    f"{getattr(ref, side):.4f}",
                    f"{statistics.mean(values):.4f}",
                    f"{statistics.stdev(values):.4f}",
                    f"{min(values):.4f}",
                    f"{max(values):.4f}",
                    f"{sum(x < limit for x in values)} below {limit:g}" if limit else "",
                ]
            )
    show("100 textures, straight, e 0.7", "v|side|ref|mean|deviation|least|largest|limit", rows)


def table_onset() -> None:
    rows = []
    for e in (0.5, 0.7, 0.9):
        row = [f"{e}"]
        for z0 in (0.3e-9, 0.4e-9, 0.5e-9):
            speeds = [0.1 * k for k in range(20, 151)]
            low, high = 0, len(speeds) - 1  # bisect: the release on the north grows with speed
            while high - low > 1:
                k = (low + high) // 2
                impact = Impact(speed=speeds[k], restitution=e, z0=z0)
                low, high = (low, k) if run(impact).north > 0 else (k, high)
            row.append(f"{speeds[high]:.1f}")
        rows.append(row)
    show(
        "Lowest speed (m/s, steps of 0.1) with any release on the north, straight",
        "e|z0 0.3 nm|z0 0.4 nm|z0 0.5 nm",
        rows,
    )


def table_traps() -> None:
    """The deck in.impact with other damping models in place of ours."""
    deck = (ROOT / "lammps-inputs" / "in.impact").read_text()
    build = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
    kinds = {
        "coeff_restitution/limited": "",
        "coeff_restitution": "",
        "coeff_restitution + limit_damping": " limit_damping",
        "tsuji": "",
        "tsuji + limit_damping": " limit_damping",
    }
    rows = []
    for kind, limit in kinds.items():
        text = deck.replace("damping coeff_restitution/limited", f"damping {kind.split()[0]}{limit}")
        text += '\nprint "e $(-vcm(all,z)/v_vz:%.4f)"\n'
        row = [kind]
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "deck").write_text(text)
            for speed, angle in ((4, 90), (8, 60)):
                out = subprocess.run(
                    [
                        build / "bin" / "lmp-dust",
                        "-in",
                        "deck",
                        "-log",
                        "none",
                        "-var",
                        "speed",
                        str(speed),
                        "-var",
                        "angle",
                        str(angle),
                        "-var",
                        "wall_friction",
                        "0.3" if angle < 90 else "0.05",
                    ],
                    cwd=folder,
                    capture_output=True,
                    text=True,
                    check=True,
                ).stdout
                e = re.search(r"^e (\S+)", out, re.MULTILINE).group(1)
                south, north = re.search(r"south (\S+), north (\S+)", out).groups()
                row += [e, south, north] if angle == 90 else [f"{float(south) + float(north):.4f}"]
        rows.append(row)
    show("Damping models with e = 0.7", "damping|e realised|south 4 m/s|north 4 m/s|ratio 8 m/s, 60 deg, mu 0.3", rows)


if __name__ == "__main__":
    tables = {name.removeprefix("table_"): f for name, f in list(globals().items()) if name.startswith("table_")}
    for name in sys.argv[1:] or tables:
        if name not in tables:
            sys.exit(f"no table {name}: use {', '.join(tables)}")
        tables[name]()
