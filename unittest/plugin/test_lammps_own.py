"""The tests that LAMMPS has of its granular models (unittest/granular in its source), run with the plugin.

Each of them is a system in a YAML file, with positions, velocities, torques and spins that LAMMPS recorded. Here they
are run by a stock LAMMPS and by one with the plugin, which must give its bits, and so pass all that the former passes.

Runs the programs of one build: DUST_BUILD_DIR (set by ./bootstrap test), or build/ of this checkout.
"""

import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
LMP = BUILD / "bin" / "lmp"
PLUGIN = BUILD / "plugin" / "dustplugin.so"
SOURCE = Path(re.findall(r"^LAMMPS_SOURCE_DIR:PATH=(.*)", (BUILD / "CMakeCache.txt").read_text(), re.M)[0])
TESTS = SOURCE / "unittest" / "granular" / "tests"
CASES = sorted(TESTS.glob("dem*.yaml"))
LONGEST = 10000  # steps of a segment: the angle of repose takes 85000, in which the heap is there long before
RECORDED = {"run_pos": "x y z", "run_vel": "vx vy vz", "run_torque": "tqx tqy tqz", "run_omega": "omegax omegay omegaz"}

pytestmark = pytest.mark.skipif(not CASES, reason=f"this LAMMPS has no tests of granular models: no {TESTS}")


def blocks(case: Path) -> dict[str, list[str]]:
    """The lines under each key of such a file, which has no more of YAML than that."""
    found: dict[str, list[str]] = {}
    key = ""
    for line in case.read_text().splitlines():
        if begins := re.match(r"(\w+):(.*)", line):
            key, rest = begins[1], begins[2].strip()
            found[key] = [] if rest.startswith("!") or not rest else [rest]
        elif line.startswith(" "):
            found[key].append(line.strip())
    return found


def run(case: dict[str, list[str]], folder: Path, newton: str, first: str = "") -> list[str] | None:
    """All that moves atoms, at the end of each segment; nothing where LAMMPS lacks a package or a style."""
    columns = " ".join(RECORDED.values())
    deck = [first, f"newton {newton}", f"variable input_dir index {TESTS}"]
    deck += [f"variable {name} index {value}" for name, value in (line.split(maxsplit=1) for line in case["variables"])]
    deck += case["pre_commands"] + [f"pair_style {case['pair_style'][0]}"]
    deck += [f"pair_coeff {line}" for line in case["pair_coeff"]] + case["post_commands"] + ["run 0 post no"]
    segments = [min(int(word), LONGEST) for word in " ".join(case["run_segments"]).split()]
    for n, steps in enumerate(segments):
        deck += [f"run {steps} post no", f"write_dump all custom {n} id {columns} fx fy fz modify format float %.17g"]
    (folder / "in.case").write_text("\n".join(deck) + "\n")
    environment = {name: value for name, value in os.environ.items() if name != "LAMMPS_PLUGIN_PATH"}
    command = [LMP, "-in", "in.case", "-log", "none", "-nocite"]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
    if re.search(r"Unrecognized \w+ style", done.stdout):
        return None
    assert done.returncode == 0, done.stdout[-2000:]
    return [(folder / str(n)).read_text() for n in range(len(segments))]


def atoms(state: str) -> dict[int, list[float]]:
    rows = [line.split() for line in state.splitlines()[9:]]
    return {int(row[0]): [float(word) for word in row[1:]] for row in rows}


@pytest.mark.parametrize("newton", ["on", "off"])
@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_passes_with_the_plugin(tmp_path: Path, path: Path, newton: str) -> None:
    case = blocks(path)
    (tmp_path / "stock").mkdir()
    stock = run(case, tmp_path / "stock", newton)
    if stock is None:
        pytest.skip("needs " + ", ".join(case["prerequisites"]) + ": not in this LAMMPS")
    ours = run(case, tmp_path, newton, f"plugin load {PLUGIN}")
    assert ours == stock  # to the last bit: 17 digits are enough to tell two numbers apart
    states = [atoms(state) for state in ours]
    assert all(states)

    tolerance = float(case["epsilon"][0])
    for n, (key, _) in enumerate(RECORDED.items()):
        for row in case.get(key, []):
            segment, atom, *recorded = row.split()
            reached = states[int(segment)][int(atom)][3 * n : 3 * n + 3]
            assert reached == pytest.approx([float(word) for word in recorded], rel=tolerance, abs=tolerance), key


def test_the_bits_are_those_of_these_models() -> None:
    """What makes the other test worth something: the files have pairs and walls of pair style granular."""
    commands = [line for path in CASES for key in ("pair_coeff", "post_commands") for line in blocks(path)[key]]
    for word in ("hooke", "hertz/material", "jkr", "dmt", "linear_history", "mindlin", "mindlin_rescale", "sds"):
        assert any(f" {word} " in command for command in commands), word
    assert sum("wall/gran granular" in command for command in commands) > 10
