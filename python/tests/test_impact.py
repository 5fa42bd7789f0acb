"""Ranges of an impact's parameters and what follows from them."""

import math

import numpy as np
import pytest

from dustdetach import Impact, InvalidInput


def test_the_reference_case_has_4500_grains():
    assert Impact(speed=4).grains == 4500


def test_numbers_of_any_kind_become_plain_ones():
    impact = Impact(speed=np.float32(4), seed=np.int64(3), angle=60)
    assert (type(impact.speed), type(impact.seed), type(impact.angle)) == (float, int, float)


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
        ("grain_diameter", 1.5e-3, "above 0 and below 0.0015 m"),
        ("grain_diameter", 1e-9, "grains; allowed: "),
        ("carrier_diameter", 0, "above 0 and at most 1 m"),
        ("hamaker", 0, "above 0"),
        ("z0", 0, "above 0"),
        ("friction", -0.1, "0 to 10"),
        ("wall_friction", -0.1, "0 to 10"),
        ("grain_damping", -1, "0 to 100"),
        ("seed", 0, "1 to 900000000"),
        ("seed", -5, "1 to 900000000"),
        ("seed", 1.5, "whole number"),
        ("tangential", "guess", "estimate, integrate, frictionless, off"),
        ("method", "both", "functions, resolved"),
        ("rotation", 1, "not true or false"),
        ("timestep", 0, "above 0 and at most 1e-07 s"),
        ("speed", "4", "not a number"),
        ("speed", True, "not a number"),
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
