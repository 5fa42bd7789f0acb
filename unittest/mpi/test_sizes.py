"""Carriers of many sizes: the same grains on 1, 2 and 4 ranks and after a restart, textures and totals of all sizes."""

import math
from pathlib import Path

import pytest
from test_ranks import mpirun, thermo


def run(folder: Path, ranks: int, **variables: str) -> tuple[str, str, list[str]]:
    """Final state of the carriers, thermo output of the last run and events (sorted) of the deck on so many ranks."""
    said = mpirun(folder, "in.sizes", ranks, **variables)
    rows = [line for line in (folder / "sizes.txt.events").read_text().splitlines() if len(line.split()) == 5]
    return (folder / "sizes.txt").read_text(), thermo(said[said.rindex("Step ") - 9 :]), sorted(rows)


@pytest.fixture(scope="module")
def one_rank(tmp_path_factory):
    return run(tmp_path_factory.mktemp("one"), 1, save="yes")


def test_what_makes_the_other_tests_worth_something(one_rank):
    """Many classes; carriers come when others have lost grains; some leave before the end."""
    state, table, events = one_rank
    textures = {float(line.split()[4]) for line in events}
    assert len(textures) > 12
    # classes a factor 1.05 apart
    largest = max(textures)
    assert all(abs(math.log(largest / d) / math.log(1.05) % 1 - 0.5) > 0.49 for d in textures)
    assert len(events) > 50_000
    first, last = ([float(word) for word in table.splitlines()[row].split()] for row in (1, -1))
    assert first[1] > last[1]
    assert first[2] < last[2] - 0.1
    # each carrier had 4 X0 (R/R_d)^2 grains of its class, so by its radius within 5 %
    carriers = [[float(word) for word in line.split()] for line in state.splitlines()[9:]]
    for _, radius, attached, mass, _ in carriers:
        initial = attached + mass / (4 / 3 * math.pi * 10e-6**3 * 2700)
        assert initial == pytest.approx(0.4 * (radius / 10e-6) ** 2, rel=0.051)
    # the books: what came is there, has left, or went with its carrier
    assert last[3] == first[3]


@pytest.mark.parametrize("ranks", [2, 4])
@pytest.mark.parametrize("sizes", ["0.05", "0"])
def test_same_on_any_number_of_ranks(one_rank, tmp_path, ranks, sizes):
    expected = one_rank if sizes == "0.05" else run(tmp_path, 1, sizes=sizes)
    assert run(tmp_path, ranks, sizes=sizes) == expected


@pytest.mark.parametrize("sizes", ["0.05", "0"])
def test_restart_on_other_ranks(tmp_path, sizes):
    whole = run(tmp_path, 1, save="yes", sizes=sizes)
    restarted = run(tmp_path, 1, start="restart", sizes=sizes)
    assert restarted[1].splitlines()[-1] == whole[1].splitlines()[-1]
    run(tmp_path, 4, save="yes", sizes=sizes)
    again = run(tmp_path, 2, start="restart", sizes=sizes)
    assert again[0] == restarted[0]
    assert again[1] == restarted[1]
