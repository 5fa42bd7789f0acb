"""The decks of carriers that are held: what a centrifuge and a shaker take off is what closed forms say.

Runs the programs of one build: DUST_BUILD_DIR (set by ./bootstrap test), or build/ of this checkout.
"""

import math
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
GAMMA = 14.633e-20 / (18 * math.pi * 0.4e-9**2)
RADIUS, GRAIN = 0.75e-3, 10e-6
PULL_OFF = 3 * math.pi * GAMMA * RADIUS * GRAIN / (RADIUS + GRAIN)
HOLD = PULL_OFF / (4 / 3 * math.pi * GRAIN**3 * 2700)  # m/s2


def rows(deck: str, folder: Path, **variables: str) -> list[list[float]]:
    command = [BUILD / "bin/lmp", "-in", ROOT / "lammps-inputs" / deck, "-log", "none", "-var", "out", "table"]
    command += ["-var", "plugin", BUILD / "plugin/dustplugin.so"]
    for name, value in variables.items():
        command += ["-var", name, value]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout[-2000:]
    assert "WARNING: Fix dust/detach" not in done.stdout
    lines = (folder / "table").read_text().splitlines()
    return [[float(word) for word in line.split()] for line in lines if not line.startswith("#")]


def share(acceleration: float, spread: float) -> float:
    """Of the grains on the side that is pulled off: the mean over their directions."""
    total, steps = 0.0, 2000
    for k in range(steps):
        load = acceleration * (k + 0.5) / steps / HOLD
        if spread > 1:
            total += 0.5 * math.erfc(-math.log(load) / math.log(spread) / math.sqrt(2))
        else:
            total += load > 1
    return total / steps


@pytest.mark.parametrize("spread", [1, 2, 4])
def test_a_centrifuge_takes_the_outer_half(tmp_path, spread):
    table = rows("in.centrifuge", tmp_path, spread=str(spread))
    assert len(table) == 40
    for spin, acceleration, off in table:
        assert acceleration == pytest.approx(0.05 * (2 * math.pi * spin / 60) ** 2, rel=1e-4)
        # farther out than its carrier's centre a grain is pulled a little more
        assert 0.5 * share(acceleration, spread) - 0.006 < off < 0.5 * share(1.016 * acceleration, spread) + 0.006
    assert table[-1][2] > 0.4


@pytest.mark.parametrize("spread", [1, 2, 4])
def test_a_shaker_takes_both_sides(tmp_path, spread):
    table = rows("in.shaker", tmp_path, spread=str(spread))
    assert len(table) == 30
    for amplitude, acceleration, off in table:
        assert acceleration == pytest.approx(amplitude * (2 * math.pi * 20e3) ** 2, rel=1e-4)
        assert off == pytest.approx(share(acceleration, spread), abs=0.006)
    assert table[-1][2] > 0.8
