"""Sweeps over ranges, replicas and distributions."""

import numpy as np
import pytest

from dustdetach import InvalidInput, read_cases
from dustdetach.cases import json_schema


def cases(tmp_path, text):
    path = tmp_path / "sweep.toml"
    path.write_text(text)
    return read_cases(path)


def test_ranges_replicas_and_grids(tmp_path):
    made = cases(tmp_path, "speed = { from = 2, to = 8, steps = 4 }\nseed = { replicas = 3 }\nangle = [60, 90]\n")
    assert len(made) == 24
    assert sorted({case.speed for case in made}) == [2, 4, 6, 8]
    assert {case.seed for case in made} == {1, 2, 3}
    by = cases(tmp_path, "speed = { from = 0.1, to = 0.5, by = 0.1 }\nseed = { replicas = 2, first = 11 }\n")
    assert sorted({case.speed for case in by}) == [0.1, 0.2, 0.3, 0.4, 0.5]
    assert {case.seed for case in by} == {11, 12}
    log = cases(tmp_path, 'speed = { from = 1, to = 100, steps = 3, scale = "log" }\n')
    assert [case.speed for case in log] == [1, 10, 100]
    assert [case.speed for case in cases(tmp_path, "speed = { from = 3, to = 9, steps = 1 }\n")] == [3]


@pytest.mark.parametrize("sampling", ["latin hypercube", "sobol"])
def test_uncertain_inputs_fill_their_ranges_evenly(tmp_path, sampling):
    text = (
        f'speed = [6, 8]\nsamples = 32\nsampling = "{sampling}"\n'
        "z0 = { uniform = [0.3e-9, 0.5e-9] }\nfriction = { normal = [0.3, 0.03] }\nspread = 1.2\n"
        "surface_energy = { lognormal = [0.02, 1.3] }\n"
    )
    made = cases(tmp_path, text)
    assert len(made) == 64
    z0 = np.sort([case.z0 for case in made if case.speed == 6])
    # each of 32 equal parts has one
    assert np.array_equal(np.floor((z0 - 0.3e-9) / 0.2e-9 * 32), np.arange(32))
    assert np.mean([case.friction for case in made]) == pytest.approx(0.3, abs=0.003)
    assert np.median([case.surface_energy for case in made]) == pytest.approx(0.02, rel=0.03)
    # the same samples at each speed, and from the same seed again
    assert list(z0) == sorted(case.z0 for case in made if case.speed == 8)
    assert cases(tmp_path, text) == made
    assert cases(tmp_path, text + "sampling_seed = 2\n") != made


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("speed = { from = 2, steps = 3 }", "speed: to: missing in a range"),
        ("speed = { from = 2, to = 8 }", "speed: a range has steps (how many values) or by"),
        ("speed = { from = 2, to = 8, steps = 3, by = 1 }", "speed: a range has steps"),
        ("speed = { from = 2, to = 8, by = -1 }", "speed: by: -1 does not lead from 2 to 8"),
        ("speed = { from = 2, to = 8, by = 0 }", "speed: by: 0 does not lead"),
        ("speed = { from = 2, to = 8, by = 1e-9 }", "speed: by: 1e-09 does not lead"),
        ("speed = { from = 2, to = 8, steps = 0 }", "speed: steps: 0 is out of range"),
        ("speed = { from = 2, to = 8, steps = 2.5 }", "speed: steps: 2.5 is out of range"),
        ("speed = { from = 0, to = 8, steps = 3, scale = 'log' }", "speed: scale: 'log'; allowed: linear, or log"),
        ("speed = { from = 'a', to = 8, steps = 3 }", "speed: from: 'a' is not a number"),
        ("speed = { from = 2, to = 8, step = 3 }", "speed: 'step': unknown key; allowed: from, to, steps, by, scale"),
        ("speed = { steps = 3 }", "speed: {'steps': 3}; allowed: a value, a list, {from, to, steps}"),
        ("speed = { replicas = 3 }", "speed: replicas are over seeds"),
        ("speed = 4\nseed = { replicas = 0 }", "seed: replicas: 0 is out of range"),
        ("speed = 4\nseed = { replicas = 2, first = 1.5 }", "seed: first: 1.5 is not a whole number"),
        ("speed = 4\nz0 = { uniform = [5, 3] }", "z0: uniform: [5, 3]; allowed: [low, high]"),
        ("speed = 4\nz0 = { normal = [5, 0] }", "z0: normal: [5, 0]; allowed: [mean, deviation above 0]"),
        ("speed = 4\nz0 = { lognormal = [5, 1] }", "z0: lognormal: [5, 1]; allowed: [median above 0"),
        ("speed = 4\nz0 = { uniform = 3 }", "z0: uniform: 3 is not two numbers"),
        ("speed = 4\nz0 = { uniform = [0.3, 0.5] }", "--z0: 0."),
        ("speed = 4\nsamples = 0", "samples: number: 0 is out of range"),
        ("speed = 4\nsampling = 'dice'", "sampling: unknown choice 'dice'; allowed: latin hypercube, sobol"),
        ("speed = { from = 1, to = 9, steps = 3000 }\nseed = { replicas = 3000 }", "9000000 cases; allowed: at most"),
    ],
)
def test_wrong_ranges_are_named(tmp_path, text, said):
    with pytest.raises(InvalidInput) as refusal:
        cases(tmp_path, text)
    assert said in str(refusal.value)


def test_the_schema_knows_ranges():
    forms = json_schema()["properties"]["speed"]["anyOf"]
    assert {tuple(form.get("properties", {})) for form in forms} >= {
        ("replicas", "first"),
        ("uniform",),
        ("lognormal",),
    }
    assert json_schema()["properties"]["sampling"]["enum"] == ["latin hypercube", "sobol"]
    assert len(json_schema()["properties"]["carrier"]["anyOf"]) == 2
