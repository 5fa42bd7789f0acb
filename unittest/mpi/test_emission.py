"""Grains that become atoms: the same ones on any number of ranks, wherever borders lie, and after a restart."""

import re
from pathlib import Path

import pytest
from test_ranks import mpirun, thermo


def emit(folder: Path, ranks: int, **variables: str) -> tuple[str, list[str]]:
    """Final state of carriers and grains, and what the deck says at the end of the run."""
    last = re.findall(r"^ +9000 .*|^mass .*", mpirun(folder, "in.emit", ranks, **variables), re.M)
    return (folder / "emit.txt").read_text(), last


@pytest.fixture(scope="module")
def emitted(tmp_path_factory):
    return emit(tmp_path_factory.mktemp("emitted"), 1)


@pytest.mark.parametrize(("ranks", "newton"), [(2, "off"), (4, "off"), (4, "on")])
def test_emitted_grains_on_any_number_of_ranks(emitted, tmp_path, ranks, newton):
    """Random orientations, turning carriers, their masses, of which ghosts hear, and the IDs of the new atoms."""
    assert len(emitted[0].splitlines()) > 500
    assert emit(tmp_path, ranks, newton=newton) == emitted


def test_restart_while_grains_wait(tmp_path):
    """In the middle of the collision; the trajectory changes by 1e-10, as LAMMPS recomputes damping forces."""
    state, last = emit(tmp_path, 1, save="yes")
    assert (tmp_path / "emit.450.restart").exists()
    again, last_again = emit(tmp_path, 4, start="restart", save="yes")
    assert last_again == last
    assert [line.split()[:2] for line in again.splitlines()] == [line.split()[:2] for line in state.splitlines()]


def waiting(folder: Path, ranks: int, **variables: str) -> tuple[str, str]:
    table = thermo(mpirun(folder, "in.waiting", ranks, **variables))
    return (folder / "waiting.txt").read_text(), table


@pytest.fixture(scope="module")
def waited(tmp_path_factory):
    return waiting(tmp_path_factory.mktemp("waited"), 1)


@pytest.mark.parametrize(("ranks", "newton"), [(2, "off"), (4, "on")])
def test_waiting_grains_change_ranks_with_their_carriers(waited, tmp_path, ranks, newton):
    assert len(waited[0].splitlines()) > 300
    assert waiting(tmp_path, ranks, newton=newton) == waited


def room(folder: Path, ranks: int, **variables: str) -> str:
    """What is left at the end, once mass and momentum have been looked at."""
    said = mpirun(folder, "in.room", ranks, **variables)
    before, after = (float(word) for word in re.findall(r"^(?:before|after): mass (\S+)", said, re.M))
    assert after == pytest.approx(before, rel=1e-12)
    assert abs(float(re.findall(r"^momentum (\S+)", said, re.M)[0])) < 1e-12 * 4.0 * after
    return re.findall(r"^atoms .*", said, re.M)[0]


@pytest.mark.parametrize(
    ("ranks", "variables"),
    [
        (1, {"fixes": "two", "shift": "2.9e-3"}),
        (2, {"pz": "2"}),
        (2, {"pz": "2", "fixes": "two", "shift": "2.9e-3"}),
        (4, {"shift": "3.01e-3"}),
    ],
)
def test_room_does_not_depend_on_ranks_borders_or_fixes(tmp_path, ranks, variables):
    assert room(tmp_path, ranks, **variables) == "atoms 2565 without room 84 overlaps 0"
