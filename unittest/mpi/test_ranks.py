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


def grains_at(folder: Path, ranks: int, step: str) -> list[str]:
    """Rows of compute dust/grain at a step, sorted."""
    run(folder, ranks, steps="3000")
    _, _, frame = (folder / "ranks.txt.grains").read_text().partition(f"ITEM: TIMESTEP\n{step}\n")
    return sorted(line for line in frame.split("ITEM: TIMESTEP")[0].splitlines() if re.match(r"\d+ \d+ \d", line))


def test_every_attached_grain_is_where_it_is_on_any_number_of_ranks(tmp_path):
    """While carriers slide over borders between ranks, and grains have left some."""
    for ranks in (1, 2, 4):
        (tmp_path / str(ranks)).mkdir()
    rows = grains_at(tmp_path / "1", 1, "3000")
    assert 10000 < len(rows) < 8 * 4500
    assert rows == grains_at(tmp_path / "2", 2, "3000")
    assert rows == grains_at(tmp_path / "4", 4, "3000")


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


def test_inertia_from_motion_on_other_ranks_and_after_a_restart(one_rank, tmp_path):
    folders = [tmp_path / name for name in ("one", "four", "again")]
    for folder in folders:
        folder.mkdir()
    one = run(folders[0], 1, inertia="motion")
    assert run(folders[1], 4, inertia="motion") == one
    assert one[2] != []
    run(folders[2], 4, inertia="motion", steps="1500", save="yes")
    _, restarted, _ = run(folders[2], 1, inertia="motion", start="restart")
    assert restarted.splitlines()[-1] == one[1].splitlines()[-1]
    # and as by contact forces: these carriers are free
    assert one[1].splitlines()[-1].split()[:6] == one_rank[1].splitlines()[-1].split()[:6]


# a dense layer of many sizes whose grains knock others off, while carriers cross borders and after they have left
MEETING = {
    "tangential": "integrate",
    "dust": "texture monolayer 30e-6 coverage 0.2 seed 1 bare 0.6 distribution lognormal 30e-6 1.5",
    "more": "meet yes",
    "steps": "20000",
}


@pytest.fixture(scope="module")
def meeting(tmp_path_factory):
    return run(tmp_path_factory.mktemp("meeting"), 1, **MEETING)


def numbers(thermo: str) -> list[list[float]]:
    return [[float(word) for word in line.split()] for line in thermo.splitlines()[1:]]


def assert_same_totals(found: str, expected: str):
    """Counts are the same; masses of grains of many sizes are summed in another order on other ranks."""
    assert numbers(found)[-1] == pytest.approx(numbers(expected)[-1], rel=1e-13, abs=0)


@pytest.mark.parametrize("ranks, newton", [(2, "off"), (4, "on")])
def test_grains_that_meet_on_any_number_of_ranks(meeting, tmp_path, ranks, newton):
    *_, knocked, followed = numbers(meeting[1])[-1]
    assert knocked > 20
    assert followed == 8  # all carriers' grains still are
    state, thermo, events = run(tmp_path, ranks, newton=newton, **MEETING)
    assert state == meeting[0]
    assert events == meeting[2]
    assert_same_totals(thermo, meeting[1])


@pytest.mark.parametrize("before, after", [(1, 1), (2, 4)])
def test_restart_while_grains_are_followed(meeting, tmp_path, before, after):
    """As the run that was not interrupted: nothing touches the carriers any more."""
    run(tmp_path, before, **{**MEETING, "steps": "9000"}, save="yes")
    state, thermo, _ = run(tmp_path, after, start="restart", **MEETING)
    assert state == meeting[0]
    assert_same_totals(thermo, meeting[1])
