"""What a straight impact must give: a damped Hertz impact integrated here, and the detachment functions in closed form.

Independent of the package and of the extension: nothing is imported from either.
"""

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

CARRIER_RADIUS = 0.75e-3
CARRIER_MASS = 7700 * 4 / 3 * math.pi * CARRIER_RADIUS**3
MODULUS = 210e9 / (2 * (1 - 0.3**2))
GRAIN_RADIUS = 10e-6
GRAIN_MASS = 2700 * 4 / 3 * math.pi * GRAIN_RADIUS**3
SURFACE_ENERGY = 14.633e-20 / (18 * math.pi * 0.4e-9**2)
PULL_OFF = 3 * math.pi * SURFACE_ENERGY * CARRIER_RADIUS * GRAIN_RADIUS / (CARRIER_RADIUS + GRAIN_RADIUS)
FRICTION = 0.3


@dataclass(frozen=True)
class Collision:
    """Duration (s), largest acceleration (m/s2) and restitution of an impact."""

    time: float
    peak: float
    restitution: float


def collide(speed: float, alpha: float) -> Collision:
    """A sphere hits a flat wall: Hertz with F_d = -alpha sqrt(m F_el/delta) v, until the force would pull."""
    stiffness = 4 / 3 * MODULUS * math.sqrt(CARRIER_RADIUS)
    # lengths and times of the undamped impact, so that the integrator sees numbers near 1
    length = (CARRIER_MASS * speed**2 / stiffness) ** 0.4
    duration = length / speed

    def acceleration(delta: float, velocity: float) -> float:
        return delta**1.5 + alpha * delta**0.25 * velocity if delta > 0 else 0.0

    def slope(_: float, state):
        return [state[1], -acceleration(*state)]

    def released(time: float, state) -> float:
        # the force over delta^(1/4), which has a simple root at the end of the contact
        return state[0] ** 1.25 + alpha * state[1] if time > 1e-3 and state[0] > 0 else (1.0 if time <= 1e-3 else 0.0)

    end: Any = released
    end.terminal, end.direction = True, -1
    run = solve_ivp(slope, (0, 50), [0.0, 1.0], events=end, rtol=1e-9, atol=1e-12, max_step=0.005)
    peak = max(acceleration(*state) for state in run.y.T)
    return Collision(run.t[-1] * duration, peak * length / duration**2, -run.y[1, -1])


@cache
def damping(restitution: float) -> float:
    """The alpha that realises a coefficient of restitution."""
    return brentq(lambda alpha: collide(1.0, alpha).restitution - restitution, 1e-6, 15.0, xtol=1e-6)


def hemispheres(speed: float, restitution: float, bare: float) -> tuple[float, float]:
    """Shares of the grains that detach on the south and on the north in a straight impact (Eqs. 2-6)."""
    collision = collide(speed, damping(restitution))
    covered = 1 - (1 - math.cos(bare)) / 2
    normal = (1 - PULL_OFF / (GRAIN_MASS * collision.peak)) / 2 - (1 - math.cos(bare)) / 2

    change = (1 + collision.restitution) * speed
    critical = PULL_OFF * (CARRIER_RADIUS + GRAIN_RADIUS) / GRAIN_MASS

    def excess(polar: float) -> float:
        start = change * math.sin(polar)
        force = FRICTION / 2 * (2 * PULL_OFF + GRAIN_MASS * collision.peak * math.cos(polar))
        return start**2 - 2 * force * start * collision.time / 2 / GRAIN_MASS - critical

    equator = math.pi / 2
    ring = math.cos(brentq(excess, 1e-9, equator)) / 2 if excess(equator) > 0 else 0.0
    return max(normal, 0.0) / covered, ring / covered
