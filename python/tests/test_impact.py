"""Ranges of an impact's parameters and what follows from them."""

import math
import pickle
import random
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from dustdetach import Impact, InvalidInput
from dustdetach.parameters import METHODS, PARAMETER_TYPES


def test_the_reference_case_has_4500_grains():
    assert Impact(speed=4).grains == 4500


def test_numbers_of_any_kind_become_plain_ones():
    impact = Impact(
        speed=np.float32(4),
        seed=np.int64(3),
        angle=60,
        rotation=np.False_,
        method=np.str_("functions"),
        z0=np.array(4e-10),
    )
    assert [type(value) for value in (impact.speed, impact.seed, impact.angle)] == [float, int, float]
    assert [type(value) for value in (impact.rotation, impact.method, impact.z0)] == [bool, str, float]
    assert Impact(speed=Decimal("4.5"), seed=Fraction(3)) == Impact(speed=4.5, seed=3)


def test_extreme_numbers_are_refused_or_taken_but_no_puzzle():
    chance = random.Random(1)
    numbers = (5e-324, 1e-300, 1e-61, 1e-60, 1e-30, 1e-10, 1e-3, 0.5, 1, math.pi, 90, 100, 1e15, 1e300, -1, 0, -0.0)
    names = [name for name, kind in PARAMETER_TYPES.items() if kind == "float"]
    for _ in range(5000):
        values = {name: chance.choice(numbers) for name in names if chance.random() < 0.3}
        try:
            Impact(**{"speed": 4.0, "method": chance.choice(METHODS), **values})
        except InvalidInput as refusal:
            assert str(refusal).startswith("--")


@pytest.mark.parametrize("values", [None, "speed", ["speed"], {3: 4}, {"speed\n": 4}])
def test_mappings_that_are_none(values):
    with pytest.raises(InvalidInput):
        Impact.from_mapping(values)


@pytest.mark.parametrize(
    ("name", "value", "allowed"),
    [
        ("speed", 0, "above 0 and at most 100 m/s"),
        ("speed", -1, "above 0"),
        ("speed", math.inf, "not a finite number"),
        ("angle", 0, "above 0 and at most 90 degrees"),
        ("angle", 91, "at most 90 degrees"),
        ("restitution", 0, "0.01 to 1"),
        ("restitution", 1.1, "0.01 to 1"),
        ("restitution", math.nan, "not a finite number"),
        ("coverage", 0, "above 0"),
        ("coverage", -1, "above 0"),
        ("coverage", 0.7, "at most 0.54"),
        ("bare", -0.1, "0 to below 3.14159265 rad"),
        ("bare", 3.2, "0 to below 3.14159265 rad"),
        ("grain_diameter", 0.75e-3, "above 0 and below 0.00075 m, the carrier's radius"),
        ("grain_diameter", 1e-9, "grains; allowed: "),
        ("carrier_diameter", 0, "above 0 and at most 1 m"),
        ("hamaker", 0, "1e-22 to 1e-17 J"),
        ("hamaker", 1.0001e-17, "1e-22 to 1e-17 J"),
        ("z0", 0, "1e-11 to 1e-07 m"),
        ("z0", 1e-6, "1e-11 to 1e-07 m"),
        # 14.633e-20/(18 pi 10) = 1.609e-11 squared
        ("z0", 1.5e-11, "1.61e-11 to 1e-07 m for this Hamaker constant"),
        ("spread", 0.9, "1 to 100"),
        ("friction", -0.1, "0 to 10"),
        ("wall_friction", -0.1, "0 to 10"),
        ("grain_damping", -1, "0 to 100"),
        ("seed", 0, "1 to 900000000"),
        ("seed", -5, "1 to 900000000"),
        ("seed", 1.5, "whole number"),
        ("tangential", "guess", "impulse, estimate, integrate, frictionless, off"),
        ("method", "both", "functions, resolved"),
        ("rotation", 1, "not true or false"),
        ("timestep", 0, "above 0 and at most 1e-07 s"),
        ("speed", "4", "not a number"),
        ("speed", True, "not a number"),
        ("speed", np.True_, "not a number"),
        ("speed", b"4", "not a number"),
        ("speed", np.array([4.0]), "not a number"),
        ("speed", [4.0, [2.0]], "not a finite number"),
        ("speed", 4j, "not a finite number"),
        ("speed", None, "not a finite number"),
        pytest.param("speed", 10**5000, "not a finite number", id="5000 digits"),
        ("speed", 1e-300, "at least 1e-60"),
        ("carrier_diameter", 1e-300, "at least 1e-60"),
        pytest.param("seed", 10**400, "not a finite number", id="400 digits"),
        ("method", 3, "not a word"),
        pytest.param("method", "a\nb" * 1000, "functions, resolved", id="a long word"),
    ],
)
def test_out_of_range(name, value, allowed):
    with pytest.raises(InvalidInput) as refusal:
        Impact(**{"speed": 4.0, name: value})
    message = str(refusal.value)
    assert message.startswith("--" + name.replace("_", "-"))
    assert allowed in message
    assert "\n" not in message


def test_a_resolved_run_follows_the_spin():
    assert Impact(speed=8.0, method="resolved").rotation
    with pytest.raises(InvalidInput, match=r"--rotation: false .* allowed: true"):
        Impact(speed=8.0, method="resolved", rotation=False)


def test_a_grain_oscillates_in_a_quarter_of_a_microsecond():
    # 2 pi sqrt(m_d/k_0) with m_d 1.1310e-11 kg, E* 6.073e10 Pa and a_0 90.18 nm
    expected = 2 * math.pi * math.sqrt(1.1310e-11 / (1.2 * 6.073e10 * 90.18e-9))
    assert Impact(speed=4).grain_period == pytest.approx(expected, rel=1e-3)


def test_grains_that_gravity_would_lift_off():
    # 3 pi gamma R_12/m_d with gamma 0.016173 J/m2, 2700 kg/m3
    def held(grain, carrier):
        return 3 * math.pi * 0.016173 / (2 / grain + 2 / carrier) / (math.pi / 6 * grain**3 * 2700)

    assert held(2e-3, 0.02) > 9.81 > held(2.4e-3, 0.02)
    parameters = {"speed": 8.0, "carrier_diameter": 0.02, "timestep": 1e-8}
    Impact(grain_diameter=2e-3, **parameters)
    with pytest.raises(InvalidInput, match=r"--grain-diameter: 0\.0024 m .* at least 9\.81"):
        Impact(grain_diameter=2.4e-3, **parameters)


def test_damping_and_time_step_are_bound_together():
    # the explicit damper diverges where a step takes more than a part of a grain's speed: seen at 20 and 1 ns
    Impact(speed=8.0, method="resolved", grain_damping=5.0)
    with pytest.raises(InvalidInput, match=r"--timestep: .* damping ratio 20"):
        Impact(speed=8.0, method="resolved", grain_damping=20.0)
    Impact(speed=8.0, method="resolved", grain_damping=20.0, timestep=0.25e-9)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("grain_diameter", 2e-6, "--grain-diameter: 2e-06 makes 450000 grains, in a resolved run at most 100000"),
        ("timestep", 1e-8, "--timestep: 1e-08 s does not resolve the contact of a grain"),
        ("carrier_diameter", 0.03, "--carrier-diameter: 0.03 makes a contact of "),
    ],
)
def test_a_resolved_run_allows_less(name, value, words):
    others = {"coverage": 0.2, "grain_diameter": 4e-4 if name == "carrier_diameter" else 20e-6}
    parameters = {"speed": 8.0, **others, name: value}
    assert Impact(**parameters).method == "functions"
    with pytest.raises(InvalidInput) as refusal:
        Impact(method="resolved", **parameters)
    message = str(refusal.value)
    assert message.startswith(words)
    assert "\n" not in message
    # the end of the range that the message names is allowed
    range_named = message.split("allowed: ")[1]
    if name == "grain_diameter":
        nearly = 1.01 * float(range_named.split()[0])
        parameters["timestep"] = 0.5e-9  # what so small grains need
    else:
        nearly = 0.99 * float(range_named.split("at most ")[1].split()[0])
    assert Impact(method="resolved", **{**parameters, name: nearly}).method == "resolved"


def test_bare_cap_from_the_geometry():
    assert Impact(speed=8.0).bare == 0.33
    assert Impact(speed=8.0, grain_diameter=40e-6).bare == 0.40
    assert Impact(speed=8.0, grain_diameter=40e-6, bare=0.33).bare == 0.33
    assert Impact(speed=8.0, carrier_diameter=0.1e-3, grain_diameter=5e-6).bare == 0.50
    with pytest.raises(InvalidInput, match="--bare: nan is not a finite number"):
        Impact(speed=8.0, bare=math.nan)


def test_the_time_step_follows_what_is_replaced_unless_it_was_asked_for():
    impact = Impact(speed=8.0)
    assert replace(impact, speed=1.0) == Impact(speed=1.0)
    assert replace(impact, speed=1.0).timestep > impact.timestep
    assert replace(impact, method="resolved").timestep == 1e-9
    assert replace(replace(impact, timestep=2e-9), speed=1.0).timestep == 2e-9
    assert pickle.loads(pickle.dumps(impact)) == impact
    assert replace(pickle.loads(pickle.dumps(impact)), speed=1.0) == Impact(speed=1.0)


def test_the_longest_time_step_is_kept():
    assert Impact(speed=1e-9).timestep == 1e-7
