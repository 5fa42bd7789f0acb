"""The pair force computed for many contacts at once has the bits of LAMMPS' own loop, on any number of ranks."""

from pathlib import Path

import pytest
from test_ranks import mpirun, thermo


@pytest.mark.parametrize("ranks", [1, 2, 4])
@pytest.mark.parametrize("newton", ["off", "on"])
def test_same_bits_as_lammps_own_loop(tmp_path: Path, ranks: int, newton: str) -> None:
    said = [mpirun(tmp_path, "in.fused", ranks, newton=newton)]
    ours = (tmp_path / "fused.txt").read_text()
    said.append(mpirun(tmp_path, "in.fused", ranks, newton=newton, heat="yes"))
    assert thermo(said[0]) == thermo(said[1])
    assert ours == (tmp_path / "fused.txt").read_text()
    assert ours.count("\n") == 432 + 9


def test_ghosts_that_lammps_has_not_counted(tmp_path: Path) -> None:
    states = []
    for heat in ("no", "yes"):
        mpirun(tmp_path, "in.displaced", 2, heat=heat)
        states.append((tmp_path / "displaced.txt").read_text())
    assert states[0] == states[1]
