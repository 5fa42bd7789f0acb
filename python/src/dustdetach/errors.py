"""The ways in which a request fails: each a `DustError`, which the command turns into one line and an exit status."""

from __future__ import annotations

#: a longer message loses its middle: a line of a broken file may have any length
LONGEST_MESSAGE = 2000


class DustError(Exception):
    """What this package raises: its message is one line.

    Attributes:
        status: exit status of the command.
    """

    status = 1

    def __init__(self, message: str) -> None:
        super().__init__(one_line(message))


class InvalidInput(DustError, ValueError):
    """An input that cannot be used: the message names it and says what is allowed (exit status 2)."""

    status = 2


class LammpsBusy(InvalidInput):
    """LAMMPS is at work in this process already: another thread waits for it (exit status 2)."""


class LammpsMissing(DustError, RuntimeError):
    """LAMMPS, the plugin or a deck cannot be found or loaded: the message says what to do (exit status 1)."""


class PackageMissing(DustError, RuntimeError):
    """A Python package that only some functions need is not installed: the message says how to get it (1)."""


class MachineFault(DustError, RuntimeError):
    """What was asked for is right, and the machine cannot do it, as on a full disk: the message names the file (1)."""


def one_line(text: str) -> str:
    r"""The text on one line that any terminal can show: control characters as Python writes them, ``\n`` for one."""
    line = "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in text)
    return shortened(line, LONGEST_MESSAGE)


def shown(value: object, most: int = 60) -> str:
    """A value of any kind as Python writes it, cut in the middle after so many characters."""
    try:
        return shortened(repr(value), most)
    except Exception:
        # a whole number of more than 4300 digits, or a class with a broken repr
        return f"a value of type {type(value).__name__} that cannot be shown"


def shortened(text: str, most: int) -> str:
    """The text, or its beginning and end if it is longer than so many characters."""
    half = (most - 3) // 2
    return text if len(text) <= most else f"{text[:half]}...{text[-half:]}"
