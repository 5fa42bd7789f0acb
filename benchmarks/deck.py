"""Runs decks for the benchmarks, and writes their tables."""

import os
import re
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


def read(deck: str, **variables: object) -> str:
    """The text of a deck of ``lammps-inputs``, with values of its variables in front: those win, as with ``-var``."""
    values = "".join(f"variable {name} index {value}\n" for name, value in variables.items())
    return values + (INPUTS / deck).read_text()


def changed(text: str, pattern: str, by: str = "", times: int | None = 1) -> str:
    """A deck with other lines, where no variable does.

    Args:
        text: the deck.
        pattern: a regular expression, in which ^ and $ are the ends of lines.
        by: what stands there then, as it is.
        times: how often the pattern must be found; any number above 0 if ``None``.

    Raises:
        ValueError: it is found another number of times.
    """
    result, found = re.subn(pattern, lambda _: by, text, flags=re.MULTILINE)
    if not found or (times is not None and found != times):
        raise ValueError(f"{pattern} stands {found} times in the deck")
    return result


def table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> Iterator[str]:
    """The lines of a table in Markdown, numbers that are not whole with four places."""
    names = [str(name) for name in head]
    yield "| " + " | ".join(names) + " |"
    yield "|" + "---|" * len(names)
    for row in rows:
        yield "| " + " | ".join(f"{cell:.4f}" if isinstance(cell, float) else str(cell) for cell in row) + " |"
    yield ""
