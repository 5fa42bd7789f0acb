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
        ("tangential", "integrate", "estimate, frictionless, off"),
        ("method", "resolved", "functions"),
        ("method", "both", "functions"),
        ("rotation", True, "--no-rotation"),
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
