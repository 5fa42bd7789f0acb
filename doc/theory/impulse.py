#!/usr/bin/env python3
"""Draws doc/images/impulse.png, the picture of doc/theory.rst, from the formulas alone: no code of the package.

. build/environment && build/venv/bin/python doc/theory/impulse.py
"""

import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import numpy as np
from matplotlib import pyplot as plt
from numpy.typing import NDArray

HERE = Path(__file__).resolve().parent
Array = NDArray[np.float64]

# reference case, SI units: carrier and grain of steel and calcium carbonate, 20 um on 1.5 mm
R_P, R_D, RHO_P, E_STAR = 0.75e-3, 10e-6, 7700.0, 210e9 / (2 * (1 - 0.3**2))
SHELL, R_12 = R_P + R_D, R_P * R_D / (R_P + R_D)
HOLD = 1.5042e-6 / 1.1310e-11  # F_c/m_d
MU, THETA_CRIT = 0.3, 0.15
V_CRIT = math.sqrt(HOLD * SHELL)
# damping of the Hertzian contact with the wall that realises e = 0.7
ALPHA = 0.2733
UNIT = math.sqrt(0.2267e-9 / HOLD)  # sqrt(delta_c/c), s


def pulse(speed: float, dt: float = 1e-9) -> Array:
    """Acceleration of the carrier in each step of a straight impact; the contact never pulls."""
    mass, stiffness = 4 / 3 * math.pi * R_P**3 * RHO_P, 4 / 3 * E_STAR * math.sqrt(R_P)
    overlap, v, found = 0.0, speed, []
    while True:
        overlap += v * dt
        elastic = stiffness * overlap**1.5
        force = elastic + ALPHA * math.sqrt(mass * elastic / overlap) * v
        if force <= 0:
            return np.array(found)
        found.append(force / mass)
        v -= force / mass * dt


def follow(a: Array, polar: Array, dt: float = 1e-9) -> tuple[Array, Array]:
    """Slide and roll of grains at polar angles through the collision: F_n/F_c of each step, velocity at the end."""
    t, w, rolling = polar.copy(), np.zeros_like(polar), np.zeros_like(polar)
    loads = []
    for step in a:
        gn = w * w / SHELL - step * np.cos(t)
        push = step * np.sin(t) * dt
        pivot = 2 * HOLD * THETA_CRIT * R_12 / R_D * (1 + np.sqrt(np.maximum(0, 1 - gn / HOLD))) * dt
        pivot = np.where(rolling > 0, pivot, 0.0)
        to_roll = 2 / 7 * (w + push - rolling) + 5 / 7 * pivot
        taken = np.clip(to_roll, 0, MU * np.abs(2 * HOLD - gn) * dt)
        w = w + push - taken
        rolling = np.maximum(0, rolling + 2.5 * (taken - pivot))
        t = t + w * dt / SHELL
        loads.append(gn / HOLD)
    return np.array(loads), w


def draw_velocities(axes: plt.Axes, speed: float) -> None:
    a, dt = pulse(speed), 1e-9
    dv, time = a.sum() * dt, len(a) * dt
    t = np.radians(np.linspace(0, 90, 181))
    slip = dv * np.sin(t)
    sliding = MU * (2 * HOLD * time + dv * np.cos(t))
    held = HOLD * time
    pivots = 2 * R_12 / R_D * THETA_CRIT * (held + np.sqrt(held * (held + dv * np.cos(t))))
    taken = np.minimum(sliding, 2 / 7 * slip + 5 / 7 * np.minimum(pivots, slip))
    largest = 2 * HOLD + a.max() * np.cos(t)
    estimate = np.sqrt(np.maximum(0, slip**2 - 0.5 * MU * largest * slip * time))
    degrees = np.degrees(t)
    axes.plot(degrees, slip, color="0.6", linewidth=0.9, label="frictionless")
    axes.plot(degrees, 5 / 7 * slip, color="0.6", linestyle=":", label="rolls, 5/7")
    axes.plot(degrees, estimate, color="#D55E00", linestyle="--", label="estimate")
    axes.plot(degrees, slip - taken, color="#0072B2", linewidth=2, label="impulse")
    some = np.radians(np.arange(5, 90, 5.0))
    followed = follow(a, some)[1]
    axes.plot(np.degrees(some), followed, "o", color="k", markerfacecolor="white", markersize=4, label="followed")
    axes.axhline(V_CRIT, color="0.3", linewidth=0.8)
    axes.text(2, V_CRIT + 0.25, "leaves above", fontsize=8)
    axes.set(
        xlabel="polar angle from the north pole (°)", ylabel="$v_t$ at the end (m/s)", xlim=(0, 90), ylim=(0, None)
    )
    axes.set_title(f"straight, {speed:g} m/s, e 0.7")
    axes.legend(frameon=False, loc="lower right", fontsize=8)


def draw_course(axes: plt.Axes, speed: float) -> None:
    a, dt = pulse(speed), 1e-9
    time, dv = len(a) * dt, a.sum() * dt
    times = np.arange(len(a)) * dt * 1e6
    tau = np.linspace(0, math.pi, 200)
    for degrees, colour in ((86, "#009E73"), (90, "#D55E00"), (91, "#0072B2")):
        t = np.radians(np.array([float(degrees)]))
        loads, end = follow(a, t)
        axes.plot(times, loads[:, 0], color=colour, label=f"{degrees:g}°")
        # half a sine, with the velocity of the law at the end
        outward = -math.cos(t[0]) + dv * time / (2 * math.pi * dv) * (tau - np.sin(tau)) * end[0] / SHELL * math.sin(
            t[0]
        )
        load = math.pi * dv / (2 * time) * np.sin(tau) * outward + (end[0] * (1 - np.cos(tau)) / 2) ** 2 / SHELL
        axes.plot(tau / math.pi * time * 1e6, load / HOLD, color=colour, linestyle="--", linewidth=0.9)
    axes.axhline(1, color="0.3", linewidth=0.8)
    axes.text(0.05, 1.06, "leaves above", fontsize=8)
    axes.set(xlabel="time (µs)", ylabel="$F_n/F_c$", xlim=(0, None), ylim=(-3, 1.6))
    axes.set_title(f"grains by the equator, {speed:g} m/s")
    axes.legend(frameon=False, loc="lower left", fontsize=8, title="polar angle", title_fontsize=8)


def overlap(y: float) -> float:
    return 6 ** (1 / 3) * (2 * y**4 - 4 / 3 * y)


def ring(zeta: float, load: float, slope: float) -> tuple[Array, Array, Array]:
    """Overlap of a contact whose load grows to its last value and stays there; units of F_c, delta_c and UNIT."""
    drag, dt, t = zeta * math.sqrt(1.8 / 6 ** (1 / 3)), 0.01, -30.0
    y = (0.5 * (1 + math.sqrt(1 - (load + slope * t)))) ** (1 / 3)
    d, u = overlap(y), -slope / (4 * (6 * y**5 - 3 * y**2)) * 6 ** (1 / 3) * (8 * y**3 - 4 / 3)
    found = []
    while t < 25 and d > -1:
        g = load + slope * min(t, 0)
        u -= dt * (g + 4 * (y**6 - y**3) + 2 * drag * y * y * u)
        d += dt * u
        for _ in range(4):
            y = max(y - (overlap(y) - d) / (6 ** (1 / 3) * (8 * y**3 - 4 / 3)), 6 ** (-1 / 3) * 1.0001)
        t += dt
        found.append((t, g, d))
    times, loads, overlaps = np.array(found).T
    return times, loads, overlaps


def draw_ringing(axes: plt.Axes) -> None:
    load, slope = 0.6, 1.4
    for zeta, colour in ((1.0, "#0072B2"), (0.2, "#D55E00"), (0.06, "#009E73")):
        times, loads, overlaps = ring(zeta, load, slope)
        if zeta == 1:
            axes.plot(times * UNIT * 1e6, loads, color="0.5", linestyle="--", label="load $F_n/F_c$")
        axes.plot(times * UNIT * 1e6, overlaps, color=colour, label=f"overlap/$\\delta_c$, $\\zeta$ = {zeta:g}")
    axes.axhline(-1, color="0.3", linewidth=0.8)
    axes.text(0.97, -0.93, "breaks below", fontsize=8, ha="right")
    axes.set(xlabel="time after the contact with the wall (µs)", xlim=(-0.25, 1), ylim=(-1.15, 4))
    axes.set_title("a contact that is let go")
    axes.legend(frameon=False, loc="upper right", fontsize=8)


def main() -> None:
    plt.rcParams |= {"font.size": 9, "axes.titlesize": 9, "axes.spines.top": False, "axes.spines.right": False}
    figure, (velocities, course, ringing) = plt.subplots(1, 3, figsize=(10.5, 3.3), layout="constrained")
    draw_velocities(velocities, 10.0)
    draw_course(course, 5.5)
    draw_ringing(ringing)
    figure.savefig(HERE.parent / "images/impulse.png", dpi=150)


if __name__ == "__main__":
    main()
