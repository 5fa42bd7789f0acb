"""The decks of beds at small size, and that of an inhaler: they run through on a stock LAMMPS with the plugin, and what
they show holds.

Runs the programs of one build: DUST_BUILD_DIR (set by ./bootstrap test), or build/ of this checkout.
"""

import math
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
DECKS = ROOT / "lammps-inputs"
GRAIN_MASS = 3.141592653589793 / 6 * 20e-6**3 * 2700

DROP = {"carriers": "60", "tube": "8e-3", "settle": "0.04", "rest": "1e-3", "splash": "3e-3"}
DRUM = {"carriers": "200", "drum": "20e-3", "lifter": "1e-3", "rate": "150", "turns": "0.04", "settle": "5e-3"}
SIEVE = {"carriers": "80", "tube": "10e-3", "settle": "0.04", "splash": "3e-3"}
POUR = {"carriers": "100", "time": "0.1", "slope": "60", "speed": "3"}


def run(name: str, folder: Path, **variables: str) -> subprocess.CompletedProcess:
    command = [BUILD / "bin/lmp", "-in", DECKS / name, "-log", "none", "-var", "plugin", BUILD / "plugin/dustplugin.so"]
    for variable, value in variables.items():
        command += ["-var", variable, value]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)


def output(name: str, folder: Path, **variables: str) -> str:
    done = run(name, folder, **variables)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


def table(text: str) -> list[dict[str, float]]:
    """Rows of the last run's thermo output by column."""
    lines = text.splitlines()
    start = max(i for i, line in enumerate(lines) if line.split()[:1] == ["Step"])
    end = next(i for i, line in enumerate(lines) if i > start and line.startswith("Loop time"))
    names = lines[start].split()
    rows = [line.split() for line in lines[start + 1 : end] if not line.startswith(("WARNING", "Fix"))]
    return [dict(zip(names, map(float, row), strict=True)) for row in rows]


def number(pattern: str, text: str) -> float:
    found = re.search(pattern, text, re.MULTILINE)
    assert found, text[-2000:]
    return float(found[1])


def test_a_drum_turns_and_takes_its_carriers_along(tmp_path):
    text = output("in.drum", tmp_path, **DRUM, dump="frames")
    rows = table(text)
    assert rows[0]["f_dust"] == 0
    # the mean of x is carried to the rising side of the wall, the negative one
    places = []
    for block in (tmp_path / "frames").read_text().split("ITEM: TIMESTEP\n")[1:]:
        lines = block.splitlines()[8:]
        assert len(lines) == 200
        carriers = [[float(word) for word in line.split()] for line in lines]
        assert max((c[1] ** 2 + c[3] ** 2) ** 0.5 for c in carriers) < 10e-3 - 0.5e-3
        places.append(sum(c[1] for c in carriers) / 200)
    assert len(places) > 2
    assert places[-1] < places[0]
    assert number(r"after (\S+) turns", text) == pytest.approx(0.04, abs=1e-3)


def test_the_drum_drags_at_the_speed_of_its_wall(tmp_path):
    """No slip and no jump at the start: carriers at the wall come to move with it, and never faster."""
    output("in.drum", tmp_path, **DRUM | {"turns": "0.05", "friction_steel": "5", "tilt": "0"}, dump="frames")
    lines = (tmp_path / "frames").read_text().split("ITEM: TIMESTEP\n")[-1].splitlines()[8:]
    wall = 2 * 3.141592653589793 * 150 / 60 * 10e-3
    speeds = []
    for line in lines:
        _, x, _, z, radius, vx, _, vz, _ = map(float, line.split())
        distance = (x * x + z * z) ** 0.5
        if 10e-3 - distance < 1.02 * radius:
            speeds.append((z * vx - x * vz) / distance)  # along the wall, as it turns
    assert len(speeds) > 20
    assert max(speeds) < 1.5 * wall
    assert sorted(speeds)[len(speeds) // 2] == pytest.approx(wall * 9.25 / 10, rel=0.4)


def test_a_heap_at_rest_keeps_its_dust(tmp_path):
    text = output("in.drop", tmp_path, **DROP | {"settle": "0.08", "rest": "0.04", "height": "0", "splash": "0"})
    assert number(r"^at rest (\S+) kg", text) == 0


def field(folder: Path) -> dict[int, float]:
    """Sum over all cells by the step at which the window ends."""
    sums = {}
    for file in folder.glob("field.*.vtr"):
        text = file.read_text()
        cells = re.search(r"<CellData>\s*<DataArray[^>]*>(.*?)</DataArray>", text, re.DOTALL)[1].split()
        extent = [int(word) for word in re.search(r'WholeExtent="([^"]*)"', text)[1].split()]
        assert len(cells) == extent[1] * extent[3] * extent[5]
        sums[int(file.name.split(".")[1])] = sum(map(float, cells))
    return sums


@pytest.mark.parametrize("every", ["100", "7"])
def test_the_source_field_holds_what_came_off(tmp_path, every):
    text = output("in.drop", tmp_path, **DROP, every=every, field="field")
    rows = table(text)
    detached = rows[-1]["f_dust[3]"] + rows[-1]["f_dust[4]"]
    assert rows[0]["f_dust"] == 0 < detached
    # a number for each cell and window, printed to the last digit
    assert sum(field(tmp_path).values()) == pytest.approx(detached * GRAIN_MASS, rel=1e-12)


@pytest.mark.parametrize("launcher", [[], ["mpirun", "--oversubscribe", "-np", "2"]], ids=["serial", "two ranks"])
def test_a_cfd_code_reads_what_came_off(tmp_path, launcher):
    drop = DROP | {"timestep": "2e-6"}
    command = [*launcher, sys.executable, DECKS / "source_field.py", "--time", "2e-3"]
    for name, value in drop.items():
        command += ["-var", name, value]
    environment = os.environ | {"DUSTDETACH_PLUGIN": str(BUILD / "plugin/dustplugin.so")}
    environment["PYTHONPATH"] = str((BUILD / "bin/lmp").resolve().parents[1] / "python")
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    total = number(r"cells got (\S+) kg", done.stdout)
    assert total == number(r"the fix counted (\S+) kg", done.stdout) > 0
    windows = [line.split() for line in done.stdout.splitlines() if "momentum" in line]
    # window by window what LAMMPS' own grid holds; on two ranks a heap ends in other collisions
    if not launcher:
        output("in.drop", tmp_path, **drop, field="field")
        by_time = {words[0]: float(words[2]) for words in windows}
        for step, mass in field(tmp_path).items():
            if mass > 0 and f"{step * 2e-6:.6f}" in by_time:
                assert by_time.pop(f"{step * 2e-6:.6f}") == pytest.approx(mass, rel=1e-6)
        assert not by_time
    # grains leave while their carriers are braked from the speed of the fall
    assert -((2 * 9.81) ** 0.5) < float(windows[0][7]) / float(windows[0][2]) < -1


def test_poured_carriers_come_with_their_grains_and_leave_with_the_rest(tmp_path):
    text = output("in.pour", tmp_path, **POUR)
    rows = table(text)
    assert rows[0]["Atoms"] == 0 == rows[0]["f_dust"]
    last = rows[-1]
    assert last["f_pour"] == 100
    assert last["f_out"] > 10
    assert last["Atoms"] == 100 - last["f_out"]
    assert number(r"of (\d+) grains", text) == 100 * 4500
    assert last["f_dust"] * 100 * 4500 == pytest.approx(last["f_dust[3]"] + last["f_dust[4]"], rel=1e-6)
    # what is here is at most what came with those that are here
    assert 0 < last["f_dust[2]"] <= 4500 * last["Atoms"]
    for row in rows:
        if row["f_out"] == 0:
            assert row["f_dust[2]"] + row["f_dust[3]"] + row["f_dust[4]"] == 4500 * row["f_pour"]


def test_three_sieve_fractions_in_one_fix(tmp_path):
    text = output("in.sieve", tmp_path, **SIEVE)
    grains = {1.5e-3: 4500, 1.2e-3: 2880, 1.0e-3: 2000}
    placed = re.findall(r"(\d+) grains a carrier of diameter (\S+),", text)
    assert {float(diameter): int(number) for number, diameter in placed} == grains
    poured, last = table(text)[0], table(text)[-1]
    numbers = [last[f"c_number[{k}]"] for k in (1, 2, 3)]
    assert sum(numbers) == 80
    assert min(numbers) > 5
    # what the fix says of all is what the fractions lost
    off = [last[f"v_off{k}"] for k in (1, 2, 3)]
    brought = [n * number for n, number in zip(numbers, sorted(grains.values()), strict=True)]
    assert last["f_dust"] == pytest.approx(sum(map(float.__mul__, off, brought)) / sum(brought), rel=1e-6)
    assert poured["f_dust"] < 0.8 * last["f_dust"]
    assert number(r"^off in all: (\S+) of the fine", text) == pytest.approx(off[0], abs=1e-4)


def hertz_contact_time(diameter: float, stiffen: float) -> float:
    """Of two carriers that meet with 1 m/s, without losses."""
    mass, size, modulus = 7700 * math.pi / 6 * diameter**3 / 2, diameter / 4, 210e9 / stiffen / (2 * (1 - 0.3**2))
    return 2.868 * (mass**2 / (size * modulus**2)) ** 0.2


@pytest.mark.parametrize(
    ("deck", "steps", "finest", "short"),
    [
        ("in.drum", 14, "carrier_diameter", DRUM | {"settle": "1e-5", "turns": "1e-4"}),
        ("in.drop", 20, "carrier_diameter", DROP | {"settle": "1e-5", "rest": "1e-5", "splash": "1e-5"}),
        ("in.sieve", 20, "fine", SIEVE | {"settle": "1e-5", "splash": "1e-5"}),
        ("in.pour", 20, "carrier_diameter", POUR | {"time": "1e-5"}),
    ],
)
def test_the_time_step_follows_the_contact_time(tmp_path, deck, steps, finest, short):
    def timestep(**variables: str) -> float:
        return number(r"Time step +: (\S+)", output(deck, tmp_path, **short | variables))

    diameter = 1.0e-3 if finest == "fine" else 1.5e-3
    step = hertz_contact_time(diameter, 1000) / steps
    assert timestep() == pytest.approx(step, rel=0.02)  # two digits
    assert timestep(contact_steps="40") == pytest.approx(step * steps / 40, rel=0.05)
    changed = {finest: f"{1.1 * diameter}", "stiffen": "100"}
    assert timestep(**changed) == pytest.approx(hertz_contact_time(1.1 * diameter, 100) / steps, rel=0.05)
    assert timestep(timestep="1.23e-6") == 1.23e-6


@pytest.mark.parametrize(
    ("deck", "variable", "value"),
    [
        ("in.drum", "rate", "0"),
        ("in.drum", "fill", "0.7"),
        ("in.drum", "lifter", "0.03"),
        ("in.drum", "tilt", "70"),
        ("in.drum", "stiffen", "0.5"),
        ("in.drum", "carriers", "100"),
        ("in.drop", "height", "-1"),
        ("in.drop", "stiffen", "0"),
        ("in.drop", "every", "0"),
        ("in.drop", "tube", "1e-3"),
        ("in.sieve", "height", "-1"),
        ("in.sieve", "fine", "1.3e-3"),
        ("in.sieve", "tube", "1e-3"),
        ("in.sieve", "stiffen", "0.1"),
        ("in.pour", "speed", "-1"),
        ("in.pour", "slope", "70"),
        ("in.pour", "stiffen", "0"),
        *((deck, "contact_steps", "9") for deck in ("in.drum", "in.drop", "in.sieve", "in.pour", "in.chute")),
    ],
)
def test_wrong_values_are_named_in_one_line(tmp_path, deck, variable, value):
    done = run(deck, tmp_path, **{variable: value})
    assert done.returncode == 1
    said = [line for line in done.stdout.splitlines() if line.startswith(f"{variable} {value} must")]
    assert len(said) == 1, done.stdout
    assert "ERROR" not in done.stdout


def test_a_carrier_of_an_inhaler_loses_half_by_lift_off(tmp_path):
    def shares(**variables: str) -> tuple[float, float, float]:
        text = output("in.impact.inhaler", tmp_path, **variables)
        patterns = (r"^detached: lift-off (\S+),", r"^met: sliding \S+, rolling (\S+)$", r"^dispersion ratio (\S+):")
        assert re.search(r"882 grains", text), text[-2000:]
        return tuple(number(pattern, text) for pattern in patterns)

    lifted, rolling, ratio = shares(speed="9")
    assert 0.45 < lifted < 0.5 < ratio < 1.0
    assert rolling == 1.0
    assert shares(speed="9", criteria="ibrahim")[2] == 1.0
    # on a rough wall the best angle goes from 45 to 90 degrees with the speed
    rough = {"wall_friction": "0.6"}
    assert shares(speed="4", angle="45", **rough)[2] > shares(speed="4", angle="90", **rough)[2] + 0.1
    assert shares(speed="12", angle="45", **rough)[2] < shares(speed="12", angle="90", **rough)[2] - 0.05


def shares(text: str) -> list[float]:
    return [float(share) for share in re.findall(r"(0\.\d{4}) (?:came off on|on the|at the)", text)]


SOURCE = Path(re.findall(r"^LAMMPS_SOURCE_DIR:PATH=(.*)", (BUILD / "CMakeCache.txt").read_text(), re.M)[0])
needs_surfaces = pytest.mark.skipif(
    not (SOURCE / "src/GRANSURF").is_dir(), reason="surfaces of triangles are there since 4Jul2026"
)


@needs_surfaces
def test_dust_comes_off_where_the_chute_turns(tmp_path):
    """Sliding takes little; the kink and the plate take much. Together it is what the fix counts."""
    text = output("in.chute", tmp_path, carriers="60", time="0.3", dump="frames")
    upper, lower, plate = shares(text)
    assert upper < 0.05
    assert lower > 0.1
    assert plate > 0.1
    assert upper + lower + plate == pytest.approx(number(r"^dispersion ratio (\S+)", text), abs=2e-4)
    assert (tmp_path / "chute.stl").read_text().count("endfacet") == 6


@needs_surfaces
def test_a_straight_chute_takes_less(tmp_path):
    """And the carriers stay above the triangles of a file that the user gives."""
    output("in.chute", tmp_path, carriers="20", time="0.01")
    (tmp_path / "chute.stl").rename(tmp_path / "mine.stl")
    kinked = shares(output("in.chute", tmp_path, carriers="60", time="0.2", stl="mine.stl"))
    assert not (tmp_path / "chute.stl").exists()
    straight = shares(output("in.chute", tmp_path, carriers="60", time="0.2", kink="50"))
    assert straight[1] < 0.2 * kinked[1]
