"""Runs decks for the benchmarks, and writes their tables."""

import os
import subprocess
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
INPUTS = ROOT / "lammps-inputs"
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
PLUGIN = BUILD / "plugin/dustplugin.so"


def run(deck: str, folder: Path | None = None, *, log: str = "none", **variables: object) -> str:
    """What a deck of ``lammps-inputs`` prints, on the stock LAMMPS with the plugin.

    Args:
        deck: its name.
        folder: where it runs and writes its files; one that is gone afterwards if ``None``.
        log: name of LAMMPS' log file.
        variables: of the deck (``-var``).
    """
    command = [str(BUILD / "bin/lmp"), "-in", str(INPUTS / deck), "-log", log]
    for name, value in {"plugin": PLUGIN, **variables}.items():
        command += ["-var", name, str(value)]
    with tempfile.TemporaryDirectory() as scratch:
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder or scratch, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)} failed:\n{done.stdout[-2000:]}")
    return done.stdout


def table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> Iterator[str]:
    """The lines of a table in Markdown, numbers that are not whole with four places."""
    names = [str(name) for name in head]
    yield "| " + " | ".join(names) + " |"
    yield "|" + "---|" * len(names)
    for row in rows:
        yield "| " + " | ".join(f"{cell:.4f}" if isinstance(cell, float) else str(cell) for cell in row) + " |"
    yield ""
