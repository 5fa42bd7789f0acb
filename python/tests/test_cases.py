"""The sweeps of the paper's figures, the numbers the paper reports, methods, and sweeps from TOML files."""

from itertools import pairwise

import pytest

from dustdetach import Impact, InvalidInput, figure4, figure5, read_cases
from dustdetach.cases import with_methods

ANGLES_DOWN = (90.0, 75.0, 60.0, 45.0, 30.0)


def test_the_figures_ask_for_what_the_paper_shows():
    straight, oblique = figure4(), figure5()
    assert {case.angle for case in straight} == {90}
    assert {case.restitution for case in straight} == {0.5, 0.7, 0.9}
    assert {case.restitution for case in oblique} == {0.7}
    assert {case.tangential for case in (*straight, *oblique)} == {"impulse", "estimate"}
    assert {case.angle for case in oblique} == {15, 30, 45, 60, 75, 90}
    for cases in (straight, oblique):
        speeds = {case.speed for case in cases}
        assert len(speeds) >= 12
        assert max(speeds) == 20
        assert len([speed for speed in speeds if 1 <= speed <= 8]) >= 12


def test_south_is_almost_bare_by_2_to_4_metres_a_second(figures_table):
    assert figures_table[2, 90, 0.7].south >= 0.43
    assert figures_table[4, 90, 0.7].south >= 0.46


def test_south_hardly_depends_on_restitution(figures_table):
    south = [figures_table[4, 90, e].south for e in (0.5, 0.7, 0.9)]
    assert max(south) - min(south) <= 0.01


def test_north_begins_between_5_and_8(figures_table):
    assert figures_table[5, 90, 0.7].north == 0
    assert figures_table[8, 90, 0.7].north > 0.2


@pytest.mark.parametrize("speed", [8, 9, 10, 11, 12, 13, 14, 16, 18, 20])
def test_lower_restitution_releases_less_north(figures_table, speed):
    low, middle, high = (figures_table[speed, 90, e].north for e in (0.5, 0.7, 0.9))
    assert low < middle < high


@pytest.mark.parametrize("speed", [4, 8, 12])
def test_the_ratio_falls_with_the_angle(figures_table, speed):
    ratios = [figures_table[speed, angle, 0.7].dispersion_ratio for angle in ANGLES_DOWN]
    assert all(steeper > flatter for steeper, flatter in pairwise(ratios))


def test_both_hemispheres_release_at_12_and_60_degrees(figures_table):
    assert figures_table[12, 60, 0.7].north >= 0.05
    assert figures_table[12, 60, 0.7].south >= 0.05


def test_a_resolved_run_stands_for_all_laws():
    cases = [Impact(speed=speed, tangential=law) for speed in (4, 8) for law in ("impulse", "estimate")]
    both = with_methods(cases, "both")
    assert [case.method for case in both] == ["functions"] * 4 + ["resolved"] * 2
    assert both[:4] == cases
    assert [case.speed for case in both[4:]] == [4, 8]


def test_toml_makes_every_combination(tmp_path):
    path = tmp_path / "sweep.toml"
    path.write_text("speed = [2, 4.5]\nrestitution = [0.5, 0.7]\nseed = 3\n")
    assert read_cases(path) == [Impact(speed=v, restitution=e, seed=3) for v in (2, 4.5) for e in (0.5, 0.7)]


def test_toml_tables_replace_the_keys_above_and_join(tmp_path):
    path = tmp_path / "sweep.toml"
    path.write_text("speed = [2, 4]\n[[case]]\nangle = 90\n[[case]]\nangle = [60, 90]\nspeed = 4\n")
    assert read_cases(path) == [
        Impact(speed=2),
        Impact(speed=4),
        Impact(speed=4, angle=60),
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("speed = [2]\nspede = 3\n", "spede: unknown key"),
        ("angle = 90\n", "speed: missing"),
        ("speed = [2, 0]\n", "--speed: 0 is out of range; allowed: above 0"),
        ("speed = 2\nrestitution = nan\n", "--restitution: nan is not a finite number"),
        ("speed = []\n", "speed: empty list"),
        ("speed = 'fast'\n", "--speed: 'fast' is not a number"),
        ("speed = 2\nseed = 1.5\n", "--seed: 1.5 is not a whole number"),
        ("speed = = 2\n", "not TOML"),
        ("speed = 2\ncase = 3\n", "case: allowed: tables [[case]]"),
    ],
)
def test_toml_mistakes_are_named(tmp_path, text, words):
    path = tmp_path / "sweep.toml"
    path.write_text(text)
    with pytest.raises(InvalidInput) as refusal:
        read_cases(path)
    assert words in str(refusal.value)
    assert str(path) in str(refusal.value)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "speed: missing"),
        (b"speed = 2 # \xe9", "not a text in UTF-8 (byte 13)"),
        ("speed = 2".encode("utf-16"), "not a text in UTF-8"),
        pytest.param(b"speed = " + b"[" * 3000 + b"]" * 3000, "nested too deeply", id="lists nested 3000 deep"),
        pytest.param(
            b"speed = " + b"{a=" * 3000 + b"1" + b"}" * 3000, "nested too deeply", id="tables nested 3000 deep"
        ),
        pytest.param(b"speed = " + b"1" * 5000, "a number of too many digits", id="5000 digits"),
        pytest.param(b"speed = " + b"1" * 4000, "--speed: 11111", id="4000 digits"),
        (b"speed = 1e400", "--speed: inf is not a finite number"),
        (b"speed = 1979-05-27", "--speed: datetime.date(1979, 5, 27) is not a finite number"),
        (b"speed = true", "--speed: True is not a number"),
        (b"speed = [[2, 3]]", "--speed: [2, 3] is not a finite number"),
        (b"speed = {of = 2}", "--speed: {'of': 2} is not a finite number"),
        pytest.param(b"a" * 100_000 + b" = 2", "aaa: unknown key", id="a long key"),
        (b'"a\\nb" = 2', "a\\nb: unknown key"),
        (
            b"speed = 2\nseed = [" + b"1," * 2000 + b"]\nfriction = [" + b"1," * 1000 + b"]",
            "2000000 cases; allowed: at",
        ),
        (b"speed = 2\nrotation = [true, false]\nmethod = 'resolved'", "--rotation: false"),
    ],
)
def test_files_that_are_no_sweep_are_named(tmp_path, content, words):
    path = tmp_path / "sweep.toml"
    path.write_bytes(content)
    with pytest.raises(InvalidInput) as refusal:
        read_cases(str(path))
    message = str(refusal.value)
    assert message.startswith(f"{path}: ")
    assert words in message
    assert "\n" not in message
    assert len(message) < 800


@pytest.mark.parametrize(
    ("name", "words"),
    [("folder", "Is a directory"), ("loop", "Too many levels of symbolic links"), ("line\nbreak", "no such file")],
)
def test_what_is_no_file_is_named(tmp_path, name, words):
    (tmp_path / "folder").mkdir()
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(InvalidInput) as refusal:
        read_cases(tmp_path / name)
    assert words in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_methods_of_a_sweep():
    slow, fast = Impact(speed=2), Impact(speed=4)
    resolved = [Impact(speed=v, method="resolved") for v in (2, 4)]
    mixed = [slow, resolved[1]]
    assert with_methods(mixed, None) == mixed
    assert with_methods(mixed, "functions") == [slow, fast]
    assert with_methods(mixed, "resolved") == resolved
    assert with_methods(mixed, "both") == [slow, fast, *resolved]
    # what becomes the same case is run once
    assert with_methods([slow, resolved[0]], "both") == [slow, resolved[0]]


def test_an_unknown_method_of_a_sweep():
    with pytest.raises(InvalidInput) as refusal:
        with_methods([Impact(speed=2)], "magic")
    assert str(refusal.value) == "--method: unknown choice 'magic'; allowed: functions, resolved, both"


def test_a_sweep_that_cannot_be_resolved():
    with pytest.raises(InvalidInput, match="--timestep"):
        with_methods([Impact(speed=2), Impact(speed=2, timestep=1e-8)], "both")


def test_toml_names_methods(tmp_path):
    path = tmp_path / "sweep.toml"
    path.write_text("speed = 4\nmethod = ['functions', 'resolved']\n")
    assert read_cases(path) == [Impact(speed=4), Impact(speed=4, method="resolved")]
