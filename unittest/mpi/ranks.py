"""Starts lmp-dust on several ranks."""

import os
import subprocess
from pathlib import Path

BUILD = Path(os.environ.get("DUST_BUILD_DIR", Path(__file__).parents[2] / "build"))
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def run_ranks(folder: Path, deck: str | Path, ranks: int, **variables: str) -> "subprocess.CompletedProcess[str]":
    """Runs a deck in a folder, whatever comes of it."""
    # ranks that wait let others work: a machine may have fewer cores, or much to do
    command = ["mpirun", "--oversubscribe", "--mca", "mpi_yield_when_idle", "1", "-np", str(ranks)]
    command += [str(BUILD / "bin/lmp-dust"), "-log", "none", "-in", str(deck)]
    for name, value in variables.items():
        command += ["-var", name, value]
    # the environment as Python knows it: where LAMMPS has run in this process, MPI has added words of its own, with
    # which mpirun would take itself for one of the ranks and end without a word
    environment = os.environ | AS_ROOT
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=600)
