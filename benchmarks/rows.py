"""Results as CSV files that a killed run never leaves half-written."""

import csv
from collections.abc import Iterable
from pathlib import Path


def read(path: Path) -> list[dict[str, str]]:
    """Rows of a file; none if there is no file."""
    if not path.exists():
        return []
    with path.open() as stream:
        return list(csv.DictReader(stream))


def write(path: Path, columns: Iterable[str], rows: list[dict[str, str]]) -> None:
    part = path.with_suffix(".part")
    with part.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, tuple(columns), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    part.replace(path)
