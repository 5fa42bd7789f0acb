"""Files that appear complete or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import InvalidInput


@contextmanager
def replace_file(path: Path) -> Iterator[Path]:
    """A temporary name beside ``path`` to write to; renamed to ``path`` if the block succeeds, removed if not."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part{path.suffix}")
    try:
        yield part
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def writable_file(path: Path, option: str) -> Path:
    """``path`` if a file can be written there.

    Raises:
        InvalidInput: it is a folder, or its folder does not exist or cannot be written to.
    """
    if path.is_dir():
        raise InvalidInput(f"{option}: {path} is a folder; allowed: the name of a file")
    if not path.parent.is_dir():
        raise InvalidInput(f"{option}: there is no folder {path.parent}")
    if not os.access(path.parent, os.W_OK):
        raise InvalidInput(f"{option}: cannot write into {path.parent}")
    return path
