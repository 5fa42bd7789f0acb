"""in.impact.meet: the dense layer against grain-resolved runs, over time, and how little its numbers matter.

Runs the programs of one build: DUST_BUILD_DIR (set by ./bootstrap test), or build/ of this checkout.
"""

import csv
import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
RESOLVED = ROOT / "benchmarks/meeting/resolved.csv"


def meet(folder: Path, **variables: str) -> tuple[str, dict[float, float]]:
    """What the deck prints, and the dispersion ratio by time, us."""
    command = [BUILD / "bin/lmp", "-in", ROOT / "lammps-inputs/in.impact.meet", "-log", "none"]
    for name, value in {"plugin": str(BUILD / "plugin/dustplugin.so"), "curve": "curve", **variables}.items():
        command += ["-var", name, value]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    lines = [line.split() for line in (folder / "curve").read_text().splitlines() if not line.startswith("#")]
    return done.stdout, {float(time): float(ratio) for time, ratio in lines}


def resolved(**case: str) -> dict[float, float]:
    """The same of a grain-resolved run."""
    rows = [row for row in csv.DictReader(RESOLVED.open()) if case.items() <= row.items()]
    assert rows
    return {float(row["microseconds"]): float(row["dispersion_ratio"]) for row in rows}


@pytest.mark.parametrize(("speed", "angle"), [("6", "90"), ("12", "60")])
def test_dense_layers_as_resolved_runs_at_every_microsecond(tmp_path, speed, angle):
    """Within 0.012; without meet yes the difference after 20 us is 0.20 and 0.12."""
    expected = resolved(sizes="lognormal", width="1.5", coverage="0.2", speed=speed, angle=angle)
    _, found = meet(tmp_path, speed=speed, angle=angle, limit="20e-6")
    for time in range(5, 21):
        assert found[time] == pytest.approx(expected[time], abs=0.012), time


def test_rosin_rammler_layer(tmp_path):
    expected = resolved(sizes="rrsb", width="4", coverage="0.2", speed="8", angle="90")
    _, found = meet(tmp_path, sizes="rrsb", width="4", limit="10e-6")
    assert found[9] == pytest.approx(expected[9], abs=0.012)


def test_the_deck_ends_when_no_grain_is_followed(tmp_path):
    text, curve = meet(tmp_path, coverage="0.05")
    until = float(re.search(r"followed until ([\d.]+) us", text)[1])
    assert 60 < until < 150
    counts = re.search(
        r"grains off: (\d+) of \d+: south (\d+), north (\d+); normal (\d+), tangential (\d+), knocked off (\d+)", text
    )
    off, south, north, normal, tangential, knocked = map(int, counts.groups())
    assert off == south + north == normal + tangential + knocked
    assert knocked > 100
    last = float(re.search(r"dispersion ratio ([\d.]+)", text)[1])
    assert last == pytest.approx(curve[max(curve)], abs=0.002)


@pytest.mark.parametrize("words", [{"meet": "perhaps"}, {"speed": "0"}, {"more": "meet_step 0"}])
def test_wrong_words_are_refused(tmp_path, words):
    with pytest.raises(AssertionError, match="must be"):
        meet(tmp_path, **words)


def test_turning_carriers_and_spread_are_followed(tmp_path):
    """Friction and spin: the same books."""
    text, _ = meet(tmp_path, coverage="0.05", spin="3000", wall_friction="0.3", angle="60", spread="1.5", limit="12e-6")
    counts = re.search(r"south (\d+), north (\d+); normal (\d+), tangential (\d+), knocked off (\d+)", text)
    south, north, normal, tangential, knocked = map(int, counts.groups())
    assert south + north == normal + tangential + knocked > 1000
