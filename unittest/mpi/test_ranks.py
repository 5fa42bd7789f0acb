"""The same grains leave on 1, 2 and 4 ranks, with newton on and off, and after a restart on another number of ranks."""

import re
from pathlib import Path

import pytest
from ranks import run_ranks


def mpirun(folder: Path, deck: str, ranks: int, **variables: str) -> str:
    """What lmp-dust prints of a deck beside this file, on so many ranks."""
    done = run_ranks(folder, Path(__file__).with_name(deck), ranks, **variables)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


def thermo(said: str) -> str:
    """The table of a deck's run."""
    table = re.search(r"^ *Step .*?(?=^Loop time)", said, re.M | re.S)
    assert table, said
    return table[0]


def run(folder: Path, ranks: int, **variables: str) -> tuple[str, str, list[str]]:
    """Final state of the carriers, thermo output and events (sorted) of the deck on so many ranks."""
    said = mpirun(folder, "in.ranks", ranks, **variables)
    events = (folder / "ranks.txt.events").read_text().splitlines()
    rows = sorted(line for line in events if re.match(r"\d+ \d+ \d+ \d", line))
    return (folder / "ranks.txt").read_text(), thermo(said), rows


@pytest.fixture(scope="module")
def one_rank(tmp_path_factory):
    return run(tmp_path_factory.mktemp("one"), 1)


def test_carriers_change_ranks_in_contact(one_rank):
    """What makes the other tests worth something: carriers cross x = 0.01 while they touch the wall."""
    state, _, events = one_rank
    rows = [line.split() for line in state.splitlines()[9:]]
    assert len(rows) == 8
    assert all(float(row[3]) * float(row[9]) > 25e-6 for row in rows)  # farther along the wall than to the border
    assert len(events) > 10000


@pytest.mark.parametrize("ranks", [2, 4])
@pytest.mark.parametrize("newton", ["off", "on"])
def test_same_on_any_number_of_ranks(one_rank, tmp_path, ranks, newton):
    state, thermo, events = run(tmp_path, ranks, newton=newton)
    assert state == one_rank[0]
    assert thermo == one_rank[1]
    assert events == one_rank[2]


@pytest.fixture(scope="module")
def one_rank_restarted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("restarted")
    run(folder, 1, steps="1500", save="yes")
    return run(folder, 1, start="restart")


def test_restart_in_contact_ends_as_the_whole_run(one_rank, one_rank_restarted):
    """The same grains; the trajectory changes by 1e-10, as LAMMPS recomputes damping forces with other velocities."""
    assert one_rank_restarted[1].splitlines()[-1] == one_rank[1].splitlines()[-1]


@pytest.mark.parametrize("before, after", [(1, 4), (4, 1), (2, 4)])
def test_restart_in_contact_on_other_ranks(one_rank_restarted, tmp_path, before, after):
    run(tmp_path, before, steps="1500", save="yes")
    state, thermo, _ = run(tmp_path, after, start="restart")
    assert state == one_rank_restarted[0]
    assert thermo == one_rank_restarted[1]


def test_motion_of_grains_on_any_number_of_ranks(one_rank, tmp_path):
    """What `tangential integrate` records of a collision goes with the carrier, to another rank and into a restart."""
    whole = run(tmp_path, 1, tangential="integrate")
    assert whole[2] != one_rank[2]
    assert run(tmp_path, 4, tangential="integrate") == whole
    run(tmp_path, 2, steps="1500", save="yes", tangential="integrate")
    assert run(tmp_path, 4, start="restart", tangential="integrate")[1].splitlines()[-1] == whole[1].splitlines()[-1]


@pytest.mark.parametrize("newton", ["off", "on"])
def test_real_grains_stay_tied_on_any_number_of_ranks(tmp_path, newton):
    """Chains of necks cross ranks; the sums of forces on the carrier run in another order, which is round-off."""
    tied = []
    for ranks in (1, 2, 4):
        mpirun(tmp_path, "in.dust", ranks, newton=newton)
        tied.append((tmp_path / "dust.txt").read_text())
    assert 0 < sum(line.endswith(" 1 ") or line.endswith(" 1") for line in tied[0].splitlines()[9:]) < 450
    assert tied[1] == tied[0]
    assert tied[2] == tied[0]


def swap(folder: Path, ranks: int = 1, **variables: str) -> list[list[float]]:
    """Rows of id x y z vx vy vz omega after in.swap."""
    mpirun(folder, "in.swap", ranks, **variables)
    return [[float(word) for word in line.split()] for line in (folder / "swap.txt").read_text().splitlines()[9:]]


def assert_same_motion(rows: list[list[float]], expected: list[list[float]]):
    """To the round-off of positions, 1e-10 of an overlap; the history moves this by a percent in this time."""
    assert len(rows) == len(expected) == 8
    for row, other in zip(rows, expected, strict=True):
        assert row[4:7] == pytest.approx(other[4:7], abs=1e-6)
        assert row[7:] == pytest.approx(other[7:], abs=1e-2)


# of grains: undamped, and near the critical damping, whose rate of the overlap is history too
ETAS = ["0", "3e14"]


@pytest.mark.parametrize("eta", ETAS)
@pytest.mark.parametrize("models", ["plain", "gaps", "large"])
def test_contacts_survive_a_swap_of_their_atoms(tmp_path, models, eta):
    """Necks, rates and displacements beside models with other histories, when atoms are sorted or change ranks."""
    expected = swap(tmp_path, models=models, eta=eta)
    order = [line for line in (tmp_path / "swap.txt.order").read_text().splitlines() if line.isdigit()]
    assert_same_motion(swap(tmp_path, models=models, eta=eta, sort="200"), expected)
    swapped = [line for line in (tmp_path / "swap.txt.order").read_text().splitlines() if line.isdigit()]
    assert swapped != order
    for ranks, newton in (2, "on"), (4, "off"):
        assert_same_motion(swap(tmp_path, ranks, models=models, eta=eta, newton=newton), expected)


@pytest.mark.parametrize("eta", ETAS)
@pytest.mark.parametrize("ranks", [1, 2])
def test_restart_keeps_necks_rates_and_displacements(tmp_path, ranks, eta):
    expected = swap(tmp_path, eta=eta)
    swap(tmp_path, eta=eta, steps="300", save="yes")
    assert_same_motion(swap(tmp_path, ranks, eta=eta, start="restart"), expected)


def test_a_long_collision_crosses_two_borders_at_once(tmp_path):
    """From the first rank to the last of 2 x 2 in one exchange: the rank between must have room to hand it on."""
    found = []
    for px, py in (1, 1), (2, 2):
        found.append(thermo(mpirun(tmp_path, "in.corner", px * py, px=str(px), py=str(py))))
    assert found[1] == found[0]
    assert float(found[0].split()[-6]) > 0.5  # dispersion ratio


@pytest.mark.parametrize("ranks", [1, 2, 4])
def test_notices_are_said_once(tmp_path, ranks):
    """Carriers of several ranks have too few steps in contacts that pull: two lines from the first rank."""
    said = mpirun(tmp_path, "in.notices", ranks)
    warnings = [line for line in said.splitlines() if "WARNING: Fix dust/detach" in line]
    assert len(warnings) == 2, said
    assert sum("pulls" in line for line in warnings) == 1
    assert sum("too few" in line for line in warnings) == 1
