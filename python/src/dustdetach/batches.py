"""Results of a sweep on the disk, in batches: a file of many results is there complete or not at all.

The first line of a batch says what computed it (version of this package, contents of LAMMPS' library, the plugin and
the deck) and how many results follow, one a line. A digest of that is part of its name: results of another build are
never taken for one's own.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Sequence
from operator import attrgetter
from pathlib import Path

from .errors import InvalidInput, LammpsMissing
from .files import file_error, make_folder, read_text, replace_file
from .impact import Impact
from .parameters import PARAMETERS
from .places import find_deck, lammps_library, plugin_if_any
from .result import Result
from .runner import DECKS
from .version import __version__

SUFFIX = ".jsonl"

_Parameters = tuple[str | bool | int | float, ...]

_parameters_of = attrgetter(*PARAMETERS)


def parameters_of(case: Impact | Result) -> _Parameters:
    """The values of all parameters: what a case and its result have in common."""
    values: _Parameters = _parameters_of(case)
    return values


class Build:
    """What computes the results, and so belongs to the name of a batch."""

    def __init__(self) -> None:
        common = {"dustdetach": __version__, "lammps": _digest(lammps_library()), "plugin": _plugin_digest()}
        self.identity = {method: {**common, "deck": _digest(find_deck(deck))} for method, deck in DECKS.items()}
        self._ends = {
            method: f"-{_text_digest(json.dumps(identity, sort_keys=True))[:8]}{SUFFIX}"
            for method, identity in self.identity.items()
        }

    def name(self, results: Sequence[Result]) -> str:
        """Name of a batch: method, a digest of the parameters, one of the build."""
        method = results[0].method
        digest = _text_digest(json.dumps([parameters_of(result) for result in results]))[:12]
        return f"{method}-{digest}{self._ends[method]}"

    def is_own(self, name: str) -> bool:
        """Whether a file of this name is a batch of this build."""
        return any(name.startswith(f"{method}-") and name.endswith(end) for method, end in self._ends.items())


def write_batch(folder: Path, build: Build, results: Sequence[Result]) -> str:
    """Keep results of one method, at least one; the folder is made if it is not there.

    Returns:
        The name of the file.

    Raises:
        InvalidInput: the file cannot be there.
        MachineFault: the disk is full, or fails.
    """
    make_folder(folder)
    name = build.name(results)
    head = {"build": build.identity[results[0].method], "results": len(results)}
    lines = [json.dumps(head), *(result.to_json() for result in results)]
    with replace_file(folder / name) as part:
        part.write_text("\n".join(lines) + "\n")
    return name


def read_batch(path: Path) -> list[Result]:
    """The results of a batch.

    Raises:
        InvalidInput: it is cut, or is another file; the message names it.
    """
    try:
        head, *lines = read_text(path).splitlines() or [""]
        try:
            number = json.loads(head)["results"]
        except (ValueError, RecursionError, TypeError, KeyError):
            raise InvalidInput("not a batch of results: cut, or another file") from None
        if number != len(lines):
            raise InvalidInput(f"not a batch of results: {len(lines)} in place of {number!r}")
        return [Result.from_json(line) for line in lines]
    except InvalidInput as error:
        where = "" if str(error).startswith(f"{path}: ") else f"{path}: "
        raise InvalidInput(f"{where}{error}; remove it, and its cases are run again") from None


def builds_in(folder: Path) -> list[dict[str, str]]:
    """What has computed the batches of a folder, each build once."""
    found = []
    for path in sorted(folder.glob(f"*{SUFFIX}")):
        with open(path, encoding="utf-8", errors="replace") as stream:
            try:
                build = json.loads(stream.readline())["build"]
            except (ValueError, RecursionError, TypeError, KeyError):
                continue
        if isinstance(build, dict) and build not in found:
            found.append(build)
    return found


class Batches:
    """The batches of a build in a folder, each taken in once, whoever has written it."""

    def __init__(self, folder: Path, build: Build) -> None:
        self._folder, self._build = folder, build
        self._known: set[str] = set()

    def know(self, name: str) -> None:
        """Do not read this one: its results are at hand."""
        self._known.add(name)

    def new(self) -> Iterator[Result]:
        """The results of the batches that are not known yet.

        Raises:
            InvalidInput: one is cut, or is another file; or the folder holds results of a version without batches.
        """
        for name in self._names():
            if self._build.is_own(name) and name not in self._known:
                yield from read_batch(self._folder / name)
                self.know(name)
            elif name.startswith(_METHODS) and os.path.lexists(self._folder / name / "result.json"):
                raise InvalidInput(
                    f"--out: {self._folder / name}: a folder for a case, from a version of dustdetach that is another "
                    "build and whose results are not taken; allowed: a folder without, or remove all of them"
                )

    def _names(self) -> list[str]:
        try:
            return sorted(os.listdir(self._folder))
        except FileNotFoundError:
            return []
        except OSError as error:
            raise file_error(self._folder, error) from None


_METHODS = tuple(f"{method}-" for method in DECKS)


def _plugin_digest() -> str:
    """Of every library of the plugin: the one LAMMPS loads may be a door to another beside it."""
    plugin = plugin_if_any()
    return _digest(*sorted(plugin.parent.glob("dust*.so"))) if plugin else "compiled into LAMMPS"


def _digest(*paths: Path) -> str:
    try:
        return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()[:16]
    except OSError as error:
        raise LammpsMissing(f"{error.filename}: {error.strerror}") from None


def _text_digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def in_batches(cases: Iterable[Impact], most: int) -> Iterator[list[Impact]]:
    """Cases in runs of one method, of at most so many; a resolved impact, which takes a minute, stands alone.

    Those with the same grains on the same carrier follow each other: a texture takes longer than an impact.
    """
    batch: list[Impact] = []
    for case in sorted(cases, key=_slow_first):
        if batch and (case.method != batch[0].method or len(batch) == most or case.method == "resolved"):
            yield batch
            batch = []
        batch.append(case)
    if batch:
        yield batch


#: what varies within a texture at no cost
_QUICK = (
    *("wall", "wall_modulus", "wall_poisson", "wall_hamaker", "wall_friction", "restitution", "rotation", "spin"),
    *("timestep", "angle", "speed"),
)

_slow_first = attrgetter("method", *(name for name in PARAMETERS if name not in ("method", *_QUICK)), *_QUICK)
