"""Fits: the smooth response against the fix, intervals that hold, what is refused, and what is said of bad data."""

import json
import math

import numpy as np
import pytest
from scipy.stats import norm

from dustdetach import Impact, run
from dustdetach.fitting import Data, Model, fit, read_data
from dustdetach.response import Curves, Polygon, directions

SPEEDS = (2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 12.0)

#: a curve that rises evenly, as no single pull-off force makes one
EVEN = "speed,dispersion_ratio\n2,0.20\n4,0.42\n6,0.47\n8,0.55\n10,0.70\n"


def smooth(impact):
    return float(Model([impact], ()).predict(np.empty(0))[0])


@pytest.mark.parametrize(
    "changes",
    [
        {"speed": 2.0},
        {"speed": 8.0},
        {"speed": 12.0, "angle": 60.0},
        {"speed": 8.0, "spread": 1.5},
        {"speed": 10.0, "spread": 2.0, "angle": 60.0},
        {"speed": 8.0, "spin": 2000.0, "wall_friction": 0.3},
        {"speed": 9.0, "angle": 60.0, "spin": -4000.0, "wall_friction": 0.3, "spread": 1.3},
        {"speed": 8.0, "friction": 0.1},
        {"speed": 12.0, "friction": 0.8, "restitution": 0.5},
        {"speed": 8.0, "rotation": False, "angle": 60.0, "wall_friction": 0.3},
        {"speed": 8.0, "distribution": "lognormal", "distribution_spread": 1.5, "grain_diameter": 15e-6, "bare": 0.4},
    ],
)
def test_the_smooth_response_is_the_mean_over_seeds_of_the_fix(changes):
    runs = [run(Impact(**changes, seed=seed, coverage=0.35)).dispersion_ratio for seed in range(1, 6)]
    # with unequal grains each run has drawn them by chance, of 40,000 a standard deviation of 0.0023
    chance = "spread" in changes or "distribution" in changes
    assert smooth(Impact(**changes)) == pytest.approx(np.mean(runs), abs=0.006 if chance else 0.0025)


def test_the_mean_over_the_spread_is_that_of_the_polygon():
    polygon = Polygon.of(np.exp(np.random.default_rng(1).uniform(2, 5, 4000)))
    for middle, spread in ((3.0, 1.5), (4.5, 1.05), (1.0, 4.0)):
        width = math.log(spread)
        x = np.linspace(middle - 9 * width, middle + 9 * width, 200_001)
        expected = np.trapezoid(np.interp(x, polygon.x, polygon.above) * norm.pdf(x, middle, width), x)
        found = Curves([polygon]).shares_below(np.array([math.exp(middle)]), spread)[0]
        assert found == pytest.approx(expected, abs=1e-5)
    # no spread is the limit of a small one
    some = [Curves([polygon]).shares_below(np.array([math.exp(3.5)]), spread)[0] for spread in (1.0, 1.0001)]
    assert some[0] == pytest.approx(some[1], abs=1e-3)


def test_directions_are_even_outside_the_cap():
    n = directions(0.5)
    assert np.allclose(np.sum(n**2, axis=1), 1)
    assert n[:, 2].min() >= -math.cos(0.5)
    assert np.mean(n, axis=0) == pytest.approx([0, 0, (1 - math.cos(0.5)) / 2], abs=2e-3)


def test_a_response_without_steps():
    model = Model([Impact(speed=6.0), Impact(speed=8.0, angle=60.0)], ("z0", "spread"))
    places = np.linspace(-0.2, 0.2, 41)
    ratios = np.array([model.predict(np.array([place, math.log(1.5)])) for place in places])
    steps = np.diff(ratios, axis=0)
    assert np.all(steps < 0)
    # of a ratio with the steps of single grains the second differences would be as large as the first
    assert np.abs(np.diff(steps, axis=0)).max() < 0.1 * np.abs(steps).max()


@pytest.fixture(scope="module")
def truth():
    return np.array([run(Impact(speed=speed, z0=0.35e-9, spread=1.5)).dispersion_ratio for speed in SPEEDS])


def test_both_lie_in_their_intervals_in_90_of_100_noises(truth):
    impacts = [Impact(speed=speed) for speed in SPEEDS]
    inside = 0
    for seed in range(100):
        noise = np.random.default_rng(seed).normal(0, 0.03, len(truth))
        found = fit(Data("noise", impacts, truth + noise, None, ("speed",)))
        if not found.untold:
            z0, spread = found.estimates["z0"], found.estimates["spread"]
            inside += z0.low <= 0.35e-9 <= z0.high and spread.low <= 1.5 <= spread.high
    assert inside >= 90


def test_friction_from_data_by_the_fix():
    cases = [(speed, angle) for speed in (4.0, 6.0, 7.0, 8.0, 9.0, 10.0, 12.0, 14.0) for angle in (90.0, 60.0)]
    impacts = [Impact(speed=speed, angle=angle) for speed, angle in cases]
    ratios = np.array([run(Impact(speed=speed, angle=angle, friction=0.15)).dispersion_ratio for speed, angle in cases])
    found = fit(Data("fix", impacts, ratios, None, ("speed", "angle")), ("z0", "friction"))
    friction = found.estimates["friction"]
    assert friction.low <= 0.15 <= friction.high
    assert friction.value == pytest.approx(0.15, abs=0.03)
    assert found.estimates["z0"].value == pytest.approx(0.4e-9, rel=0.03)


def test_surface_energy_is_the_same_force(truth, tmp_path):
    path = tmp_path / "data.csv"
    path.write_text("speed,dispersion_ratio\n" + "".join(f"{v},{r}\n" for v, r in zip(SPEEDS, truth, strict=True)))
    by_z0, by_energy = (
        fit(read_data(path, free, {}), free) for free in (("z0", "spread"), ("surface_energy", "spread"))
    )
    z0, energy = by_z0.estimates["z0"].value, by_energy.estimates["surface_energy"].value
    assert energy == pytest.approx(14.633e-20 / (18 * math.pi * z0**2), rel=0.01)
    assert z0 == pytest.approx(0.35e-9, rel=0.02)


def test_known_uncertainties_are_used(truth, tmp_path):
    path = tmp_path / "data.csv"
    noise = np.random.default_rng(4).normal(0, 0.02, len(truth))
    rows = [f"{v},{r},0.02\n" for v, r in zip(SPEEDS, truth + noise, strict=True)]
    path.write_text("speed,dispersion_ratio,uncertainty\n" + "".join(rows))
    found = fit(read_data(path, ("z0", "spread"), {}))
    assert "agrees with the data within their uncertainty" in found.words[0]
    path.write_text(path.read_text().replace(",0.02\n", ",0.004\n"))
    assert "does not agree with the data" in fit(read_data(path, ("z0", "spread"), {})).words[0]


def test_how_bad_one_force_is_and_how_far_a_spread_mends_it(command, tmp_path):
    (tmp_path / "even.csv").write_text(EVEN)
    process = command("fit", "even.csv")
    assert process.returncode == 0, process.stderr
    assert "One z0 for all grains, 0.288 nm, misses them by 0.092 (rms); a spread of" in process.stdout
    assert "The data do not tell spread" in process.stdout
    assert (tmp_path / "even.fit.png").stat().st_size > 10_000
    printed = json.loads(command("fit", "even.csv", "--free", "z0", "--json").stdout)
    assert printed["rms"] == pytest.approx(0.09, abs=0.005)
    assert printed["z0"]["low"] < printed["z0"]["value"] < printed["z0"]["high"]
    assert "mends" in printed["goodness"]


def test_a_table_of_a_sweep_is_data(tmp_path, command):
    (tmp_path / "sweep.toml").write_text(
        "speed = { from = 4, to = 12, by = 2 }\nz0 = 0.3e-9\ncarrier = 'glass'\ngrain_density = 2600\n"
    )
    assert command("sweep", "sweep.toml", "--out", "out").returncode == 0
    printed = json.loads(command("fit", "out/results.csv", "--free", "z0", "--json").stdout)
    assert printed["z0"]["value"] == pytest.approx(0.3e-9, rel=0.01)
    assert (printed["fixed"]["carrier"], printed["fixed"]["grain_density"]) == ("glass", 2600)


def test_a_sweep_by_other_laws_is_none(figures_folder, command):
    picture = figures_folder / "fit.png"
    words = ("fit", figures_folder / "results.csv", "--free", "z0", "--json", "--picture", picture)
    process = command(*words)
    assert process.returncode == 2
    assert "grain-damping" in process.stderr or "estimate" in process.stderr


@pytest.mark.parametrize(
    ("text", "options", "said"),
    [
        (
            "speed,dispersion_ratio\n8,.7\n8,.71\n8,.72\n",
            (),
            "one condition (8 m/s, 90 degrees) cannot tell z0 and spread",
        ),
        ("speed,dispersion_ratio\n4,.5\n8,.71\n", (), "2 points for 2 parameters leave nothing to judge them by"),
        ("speed,dispersion_ratio\n", (), "no points"),
        ("speed,dispersion_ratio\n2,1\n4,1\n6,1\n", ("--free", "z0"), "The data do not tell z0: any value above"),
        ("speed,dispersion_ratio\n1,0\n2,0\n3,0\n4,0\n", (), "The data do not tell z0: any value below"),
        ("speed,ratio\n2,1\n", (), "no column dispersion_ratio"),
        ("speed,colour,dispersion_ratio\n2,3,1\n", (), "'colour': unknown column"),
        ("speed,speed,dispersion_ratio\n2,3,1\n", (), "speed: two columns of this name"),
        ("speed,dispersion_ratio\n2,43\n4,50\n", (), "line 2: dispersion_ratio: '43' is out of range; allowed: 0 to 1"),
        ("speed,dispersion_ratio\n2,nan\n", (), "line 2: dispersion_ratio: 'nan' is out of range"),
        ("speed,dispersion_ratio\nfast,.4\n", (), "line 2: speed: 'fast' is not a number"),
        ("speed,dispersion_ratio\n-2,.4\n", (), "line 2: --speed: -2 is out of range"),
        ("speed,dispersion_ratio\n2\n", (), "line 2: 2 columns are named"),
        ("dispersion_ratio\n.4\n", (), "line 2: speed: missing"),
        ("speed,dispersion_ratio,uncertainty\n2,.4,0\n", (), "line 2: uncertainty: '0' is out of range"),
        (EVEN, ("--free", "z0,surface_energy"), "--free: z0 and surface_energy make one pull-off force"),
        (EVEN, ("--free", "colour"), "--free: unknown choice 'colour'; allowed: some of z0, surface_energy, hamaker"),
        (EVEN, ("--free", "z0,z0"), "--free: z0,z0; allowed"),
        (EVEN, ("--free", ""), "--free: nothing; allowed"),
        (EVEN, ("--z0", "3e-10"), "--z0: given, and --free z0 is fitted"),
        (EVEN, ("--surface-energy", "0.01"), "--surface-energy: given, and --free z0 is fitted"),
        (EVEN, ("--spread", "2"), "--spread: given, and --free spread is fitted"),
        (EVEN, ("--carrier", "glas"), "line 2: --carrier: unknown material 'glas'"),
        (EVEN, ("--grain-damping", "0.1"), "--grain-damping: 0.1 makes grains ring"),
        (EVEN, ("--picture", "fit.txt"), "--picture: fit.txt; allowed"),
    ],
)
def test_what_cannot_be_fitted_is_one_line(command, tmp_path, text, options, said):
    (tmp_path / "data.csv").write_text(text)
    process = command("fit", "data.csv", *options)
    assert (process.returncode, process.stdout) == (2, ""), process.stderr
    assert process.stderr.count("\n") == 1
    assert said in process.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["data.csv"]


def test_no_file_to_fit(command):
    assert "nowhere.csv: no such file" in command("fit", "nowhere.csv").stderr


def test_two_angles_make_two_curves(command, tmp_path):
    rows = [(4, 90, 0.47), (8, 90, 0.71), (8, 60, 0.63), (10, 60, 0.72), (6, 90, 0.52), (6, 60, 0.5), (12, 90, 0.81)]
    (tmp_path / "data.csv").write_text("speed,angle,dispersion_ratio\n" + "".join(f"{v},{a},{r}\n" for v, a, r in rows))
    process = command("fit", "data.csv", "--json", "--picture", "fit.png")
    assert process.returncode == 0, process.stderr
    printed = json.loads(process.stdout)
    assert printed["z0"]["low"] < 0.4e-9 < printed["z0"]["high"]
    assert printed["fixed"]["carrier"] == "stainless steel"
    assert (tmp_path / "fit.png").exists()
