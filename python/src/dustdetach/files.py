"""Files that appear complete or not at all, and what is wrong with those that cannot be read or written."""

from __future__ import annotations

import errno
import itertools
import os
import platform
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import DustError, InvalidInput, MachineFault, shown

#: errors of the system that another name would not help against
MACHINE_FAULTS = frozenset(
    (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.ENOMEM, errno.EMFILE, errno.ENFILE)
)

_numbers = itertools.count()

#: begins the name of a file that is being written: ours, this machine's, and then the process's
_PART = f".dust.{platform.node().replace('/', '-')[:64]}."


def as_path(value: object, name: str) -> Path:
    """A file name as a path.

    Args:
        value: a string or a path.
        name: what the message calls it.

    Raises:
        InvalidInput: it is none, or holds a zero byte.
    """
    if not isinstance(value, (str, os.PathLike)):
        raise InvalidInput(f"{name}: {shown(value)} is not the name of a file or folder")
    path = os.fspath(value)
    if not isinstance(path, str) or "\0" in path:
        raise InvalidInput(f"{name}: {shown(path)} is not the name of a file or folder")
    return Path(path)


def file_error(path: Path, error: OSError) -> DustError:
    """What the system says about a file, as an error of ours that names it."""
    kind = MachineFault if error.errno in MACHINE_FAULTS else InvalidInput
    return kind(f"{path}: {error.strerror or error}")


def read_text(path: Path) -> str:
    """The text of a file in UTF-8.

    Raises:
        InvalidInput: it cannot be read, or is no such text.
        MachineFault: the disk fails.
    """
    check_file(path)
    try:
        return path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise file_error(path, error) from None
    except UnicodeDecodeError as error:
        raise InvalidInput(f"{path}: not a text in UTF-8 (byte {error.start + 1})") from None


def check_file(path: Path) -> None:
    """Refuse a device, which may have no end.

    Raises:
        InvalidInput: it is one.
    """
    with suppress(OSError):
        mode = path.stat().st_mode
        if stat.S_ISCHR(mode) or stat.S_ISBLK(mode):
            raise InvalidInput(f"{path}: is a device; allowed: the name of a file")


@contextmanager
def replace_file(path: Path) -> Iterator[Path]:
    """A temporary name beside ``path`` to write to; renamed to ``path`` if the block succeeds, removed if not.

    The content is on the disk before the file gets its name, so that not even a crash of the machine leaves half of it.

    Raises:
        InvalidInput: the file cannot be there.
        MachineFault: the disk is full, or fails.
    """
    part = path.with_name(f"{_PART}{os.getpid()}.{next(_numbers)}.part{path.suffix[:8]}")
    try:
        try:
            yield part
            _to_disk(part)
            os.replace(part, path)
            _to_disk(path.parent)
            _clean_up(path.parent)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise file_error(path, error) from None


def _clean_up(folder: Path) -> None:
    """Remove what processes of this machine that were killed have left of their files."""
    with suppress(OSError):
        for name in os.listdir(folder):
            process = name.removeprefix(_PART).split(".")[0] if name.startswith(_PART) else ""
            if process.isdecimal() and not _runs(int(process)):
                (folder / name).unlink(missing_ok=True)


def _runs(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        pass
    return True


@contextmanager
def scratch_folder(room: int) -> Iterator[Path]:
    """A temporary folder with room for so many bytes, removed with all that is in it.

    Raises:
        MachineFault: there is no place for one.
    """
    try:
        folder = tempfile.TemporaryDirectory(prefix="dustdetach-", ignore_cleanup_errors=True)
    except OSError as error:
        raise MachineFault(f"no temporary folder: {error.strerror or error}; TMPDIR may name another place") from None
    with folder as name:
        check_room(Path(name), room)
        yield Path(name)


def check_room(folder: Path, room: int) -> None:
    """Whether so many bytes of temporary files fit into a folder, asked before LAMMPS or MPI find out on their own.

    Raises:
        MachineFault: they do not.
    """
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            os.posix_fallocate(file.fileno(), 0, room)
    except OSError as error:
        if error.errno in MACHINE_FAULTS:
            raise MachineFault(
                f"{folder}: {error.strerror}: {room / 1e6:.3g} MB of temporary files are needed there; TMPDIR may name "
                "another folder"
            ) from None


def make_folder(path: Path) -> None:
    """Make a folder, and those above it, if it is not there.

    Raises:
        InvalidInput: it cannot be made, for instance because it is a file.
        MachineFault: the disk is full, or fails.
    """
    try:
        missing = [folder for folder in (path, *path.parents) if not folder.exists()]
        path.mkdir(parents=True, exist_ok=True)
        for folder in missing:
            _to_disk(folder.parent)
    except OSError as error:
        raise file_error(path, error) from None


def writable_file(path: Path, option: str) -> Path:
    """``path`` if a file can be written there.

    Raises:
        InvalidInput: it is a folder or a device, or its folder does not exist or cannot be written to.
    """
    check_file(path)
    if os.path.isdir(path):
        raise InvalidInput(f"{option}: {path} is a folder; allowed: the name of a file")
    if not os.path.isdir(path.parent):
        raise InvalidInput(f"{option}: there is no folder {path.parent}")
    if not os.access(path.parent, os.W_OK):
        raise InvalidInput(f"{option}: cannot write into {path.parent}")
    return path


def _to_disk(path: Path) -> None:
    """Wait until the content of a file, or the names in a folder, are on the disk."""
    try:
        file = os.open(path, os.O_RDONLY)
        try:
            os.fsync(file)
        finally:
            os.close(file)
    except OSError as error:
        # some file systems cannot do this for folders, and one may be writable but not readable
        if error.errno in MACHINE_FAULTS or not path.is_dir():
            raise
