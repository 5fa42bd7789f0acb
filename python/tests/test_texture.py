"""Textures: what the extension places, and what the reader and the checks find wrong."""

import math

import numpy as np
import pytest
from texture_files import SMALL, disagreements

from dustdetach import Impact, InvalidInput
from dustdetach.texture import make_texture, read_texture


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    path = tmp_path_factory.mktemp("texture") / "reference.txt"
    make_texture(Impact(speed=1.0), path)
    return path


@pytest.mark.parametrize("changes", [{}, {"coverage": 0.5}, {"bare": 0.05, "seed": 7}, {"grain_diameter": 2e-4}])
def test_placed_textures_pass_every_check(tmp_path, changes):
    impact = Impact(speed=1.0, **changes)
    make_texture(impact, tmp_path / "t.txt")
    texture = read_texture(tmp_path / "t.txt")
    assert len(texture.diameters) == impact.grains
    grain = (impact.grain_diameter / impact.carrier_diameter) ** 2 / 4
    assert texture.coverage == pytest.approx(impact.coverage, abs=grain)
    assert texture.bare == impact.bare
    assert [path.name for path in tmp_path.iterdir()] == ["t.txt"]


def test_no_grain_overlaps_by_comparing_all_pairs(reference):
    texture = read_texture(reference)
    cosines = texture.directions @ texture.directions.T
    np.fill_diagonal(cosines, -1)
    nearest = np.sqrt(2 * (1 - cosines.max())) * (texture.carrier_diameter + 20e-6) / 2
    assert nearest >= 20e-6


def test_grains_are_spread_evenly_outside_the_cap(reference):
    heights = read_texture(reference).directions[:, 2]
    low, high = -math.cos(0.33), 1.0
    counts, _ = np.histogram(heights, bins=10, range=(low, high))
    assert counts.sum() == 4500
    assert np.abs(counts - 450).max() < 5 * math.sqrt(450)


def test_a_seed_makes_one_texture(tmp_path, reference):
    make_texture(Impact(speed=1.0), tmp_path / "same.txt")
    make_texture(Impact(speed=1.0, seed=2), tmp_path / "other.txt")
    assert (tmp_path / "same.txt").read_bytes() == reference.read_bytes()
    assert (tmp_path / "other.txt").read_bytes() != reference.read_bytes()


def test_the_documented_format(tmp_path):
    path = tmp_path / "t.txt"
    path.write_text(SMALL)
    texture = read_texture(path)
    assert texture.carrier_diameter == 1.5e-3
    assert texture.bare == 0.33
    assert texture.bare_axis.tolist() == [0, 0, -1]
    assert texture.directions.tolist() == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert texture.diameters.tolist() == [2e-5, 2e-5, 3e-5]
    assert texture.centres[2].tolist() == [0, 0, pytest.approx(0.765e-3)]


def test_a_spread_of_adhesion_is_kept(command, tmp_path):
    small = SMALL.replace("texture 1", "texture 2").replace("2e-5\n", "2e-5 0.5\n").replace("3e-5", "3e-5 4")
    (tmp_path / "t.txt").write_text(small)
    assert read_texture(tmp_path / "t.txt").adhesion.tolist() == [0.5, 0.5, 4]
    (tmp_path / "t.txt").write_text(SMALL)
    assert read_texture(tmp_path / "t.txt").adhesion.tolist() == [1, 1, 1]
    # the same grains with and without; half of them below the median, within three standard deviations
    for spread in ("1", "2"):
        assert command("texture", "make", "--spread", spread, "--out", f"{spread}.txt").returncode == 0
    alike, spread_out = (read_texture(tmp_path / f"{spread}.txt") for spread in ("1", "2"))
    assert (alike.directions == spread_out.directions).all()
    assert (alike.adhesion == 1).all()
    logs = np.log2(spread_out.adhesion)
    assert abs(logs.mean()) < 3 / math.sqrt(4500)
    assert abs(logs.std() - 1) < 3 / math.sqrt(2 * 4500)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("# dust texture 1", "# dust texture 2", "line 6: 5 numbers should be here, not 4"),
        ("# dust texture 1", "# something", "line 1: "),
        ("carrier_diameter 1.5e-3", "carrier_diameter 0", "line 2: "),
        ("carrier_diameter", "carrier", "line 2: 'carrier_diameter' should be here"),
        ("bare 0.33", "bare 4", "line 3: "),
        ("0 0 -1", "0 0 -2", "line 3: the direction has length 2"),
        ("grains 3", "grains 4", "line 10: "),
        ("grains 3", "grains 2.5", "line 5: "),
        ("end\n", "", "line 10: the file ends where 'end' should be"),
        ("0 0 1 3e-5\nend\n", "0 0", "line 9: 4 numbers should be here, not 2"),
        ("end\n", "end\n1 0 0 2e-5\n", "line 11: "),
        ("0 1 0 2e-5", "0 nan 0 2e-5", "line 7: 'nan' is not a finite number"),
        ("0 1 0 2e-5", "0 one 0 2e-5", "line 7: 'one' is not a finite number"),
        ("0 1 0 2e-5", "0 1 0 -2e-5", "line 7: grain diameter -2e-05"),
        ("0 1 0 2e-5", "0 1.01 0 2e-5", "line 7: the direction has length 1.01"),
        ("0 1 0 2e-5", "0 1 0 1.5e-3", "line 7: grain diameter 0.0015"),
        ("0 1 0 2e-5", "0 1 0 1.4e-3", "below the carrier's radius, 0.00075"),
        ("0 1 0 2e-5", "0 0.1411200080598672 -0.9899924966004454 2e-5", "line 7: "),
        ("0 1 0 2e-5", "0.9999 0.01414178206592083 0 2e-5", "overlap"),
    ],
)
def test_mistakes_are_named_with_their_line(command, tmp_path, old, new, words):
    assert old in SMALL
    (tmp_path / "t.txt").write_text(SMALL.replace(old, new))
    process = command("texture", "check", "t.txt")
    assert process.returncode == 2
    assert process.stderr.count("\n") == 1
    assert process.stderr.startswith("dustdetach texture check: t.txt: line ")
    assert words in process.stderr


def test_directions_come_back_as_unit_vectors(tmp_path):
    (tmp_path / "t.txt").write_text(SMALL.replace("0 1 0 2e-5", "0 1.0005 0 2e-5"))
    assert read_texture(tmp_path / "t.txt").directions[1].tolist() == [0, 1, 0]


def test_python_and_the_fix_judge_odd_files_alike():
    taken, differently = disagreements(1000)
    assert differently == []
    # neither nearly all nor nearly none, or it would show nothing
    assert 100 < taken < 700


def test_a_missing_core_is_said_with_what_to_do(command, tmp_path, monkeypatch):
    (tmp_path / "t.txt").write_text(SMALL)
    monkeypatch.setenv("DUSTDETACH_PLUGIN", str(tmp_path / "dustplugin.so"))
    process = command("texture", "check", "t.txt")
    assert process.returncode == 1
    assert process.stderr.count("\n") == 1
    assert "no library libdustcore.so" in process.stderr
    assert "run ./bootstrap build" in process.stderr
    (tmp_path / "libdustcore.so").write_text("no library")
    assert "libdustcore.so does not load" in command("texture", "check", "t.txt").stderr


@pytest.mark.parametrize("name", ["nowhere", "folder", "loop", "no text"])
def test_files_that_are_none(tmp_path, name):
    (tmp_path / "folder").mkdir()
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "no text").write_bytes(bytes(range(256)))
    with pytest.raises(InvalidInput) as refusal:
        read_texture(tmp_path / name)
    assert str(refusal.value).startswith(f"{tmp_path / name}: ")
    assert "\n" not in str(refusal.value)


def test_a_file_cut_anywhere_is_noticed(tmp_path):
    path = tmp_path / "t.txt"
    for length in range(len(SMALL) - 2):
        path.write_text(SMALL[:length])
        with pytest.raises(InvalidInput):
            read_texture(path)


def test_the_command_makes_and_checks(command, tmp_path):
    made = command("texture", "make", "--coverage", "0.1", "--out", "t.txt")
    assert (made.returncode, made.stderr) == (0, "")
    assert made.stdout == "t.txt: 2250 grains, coverage 0.100000\n"
    checked = command("texture", "check", "t.txt")
    assert checked.returncode == 0
    assert "2250 grains, coverage 0.100000, bare cap 0.33 rad" in checked.stdout


def test_distributed_sizes(tmp_path):
    path = tmp_path / "texture.txt"
    impact = Impact(speed=1.0, coverage=0.05, grain_diameter=15e-6, distribution="rrsb", distribution_spread=3.0)
    make_texture(impact, path)
    texture = read_texture(path)
    assert 0.05 <= texture.coverage < 0.0502
    volumes = np.sort(texture.diameters) ** 3
    median = np.sort(texture.diameters)[np.searchsorted(np.cumsum(volumes), volumes.sum() / 2)]
    # 3000 grains: a few per cent of scatter of a quantile
    assert median == pytest.approx(15e-6, rel=0.05)
    # the impact knows about how many there will be, and between which sizes
    assert len(texture.diameters) == pytest.approx(impact.grains, rel=0.05)
    assert impact.finest <= texture.diameters.min() * (1 + 1e-9)
    assert texture.diameters.max() <= impact.coarsest * (1 + 1e-9)


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("weibull", 15e-6, 2.0), "--distribution: unknown choice 'weibull'; allowed: none, lognormal, rrsb"),
        (("lognormal", 0.0, 2.0), "--grain-diameter: 0 is out of range"),
        (("lognormal", 1e-5, 1.0), "--distribution: spread 1 is out of range; allowed: above 1 for lognormal"),
        (("rrsb", 1e-5, 0.1), "--grain-diameter: 1e-05 is out of range; allowed: above 0 and below 4"),
        (("none", 1e-5, 2.0), "--distribution-spread: 2 does nothing without a distribution"),
    ],
)
def test_wrong_distributions_are_named(words, named):
    kind, median, spread = words
    with pytest.raises(InvalidInput) as refusal:
        Impact(speed=1.0, distribution=kind, grain_diameter=median, distribution_spread=spread)
    assert str(refusal.value).startswith(named)
