"""Files that appear complete or not at all, on the disk before they have their name."""

import errno
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from dustdetach import DustError, InvalidInput, read_cases, read_csv
from dustdetach.errors import MachineFault
from dustdetach.files import as_path, check_room, make_folder, read_text, replace_file, scratch_folder, writable_file
from dustdetach.frames import frame_sizes
from dustdetach.texture import read_texture


def test_a_file_is_on_the_disk_before_it_has_its_name(tmp_path, monkeypatch):
    done = []
    fsync, rename = os.fsync, os.replace

    def note_fsync(file):
        done.append(("to disk", Path(os.readlink(f"/proc/self/fd/{file}"))))
        fsync(file)

    def note_rename(part, path):
        done.append(("rename", Path(path)))
        rename(part, path)

    monkeypatch.setattr(os, "fsync", note_fsync)
    monkeypatch.setattr(os, "replace", note_rename)
    path = tmp_path / "file"
    with replace_file(path) as part:
        part.write_text("all of it")
    assert done == [("to disk", part), ("rename", path), ("to disk", tmp_path)]
    assert path.read_text() == "all of it"


def test_a_folder_is_on_the_disk_as_well(tmp_path, monkeypatch):
    done = []
    monkeypatch.setattr(os, "fsync", lambda file: done.append(Path(os.readlink(f"/proc/self/fd/{file}"))))
    make_folder(tmp_path / "a" / "b")
    assert sorted(done) == [tmp_path, tmp_path / "a"]
    make_folder(tmp_path / "a" / "b")
    assert len(done) == 2


def test_a_full_disk_leaves_what_was_there(tmp_path, largest_file):
    path = tmp_path / "file"
    path.write_text("old")
    with largest_file(100), pytest.raises(MachineFault) as fault, replace_file(path) as part:
        part.write_text("x" * 1000)
    assert str(fault.value) == f"{path}: File too large"
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_disk_that_fails_when_the_file_should_be_on_it(tmp_path, monkeypatch):
    def fail(_):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(MachineFault, match="Input/output error"), replace_file(tmp_path / "file") as part:
        part.write_text("all of it")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["folder", "no/such/file", "loop/file", "file/file", "x" * 300])
def test_what_cannot_be_replaced_is_named(tmp_path, name):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("mine")
    (tmp_path / "loop").symlink_to("loop")
    before = sorted(tmp_path.iterdir())
    with pytest.raises(InvalidInput) as refusal, replace_file(tmp_path / name) as part:
        part.write_text("all of it")
    assert str(refusal.value).startswith(f"{tmp_path / name}: ")
    assert sorted(tmp_path.iterdir()) == before


def test_what_a_killed_process_has_left_is_removed_by_the_next(tmp_path):
    leave = (
        "import os, signal, sys; from pathlib import Path; from dustdetach.files import replace_file\n"
        "with replace_file(Path(sys.argv[1])) as part:\n"
        "    part.write_text('half'); os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    path = tmp_path / "file"
    killed = subprocess.run([sys.executable, "-c", leave, path])
    assert killed.returncode == -signal.SIGKILL
    assert len(list(tmp_path.iterdir())) == 1
    others = [tmp_path / name for name in (".dust.elsewhere.999999.0.part", ".dust.", ".dust.notes")]
    with replace_file(tmp_path / "at work") as mine:
        mine.write_text("not yet")
        for other in others:
            other.write_text("not ours to remove")
        with replace_file(path) as part:
            part.write_text("all of it")
        assert sorted(tmp_path.iterdir()) == sorted([path, mine, *others])


def test_two_threads_may_write_one_file(tmp_path):
    path = tmp_path / "file"
    both = threading.Barrier(2)

    def write(text):
        with replace_file(path) as part:
            part.write_text(text)
            both.wait(10)

    threads = [threading.Thread(target=write, args=(letter * 1000,)) for letter in "ab"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert path.read_text() in ("a" * 1000, "b" * 1000)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("content", "words"), [(b"ab\xff", "not a text in UTF-8 (byte 3)"), ("a".encode("utf-16"), "(byte 1)")]
)
def test_what_is_no_text_is_named(tmp_path, content, words):
    (tmp_path / "file").write_bytes(content)
    with pytest.raises(InvalidInput) as refusal:
        read_text(tmp_path / "file")
    assert str(refusal.value).startswith(f"{tmp_path / 'file'}: ")
    assert words in str(refusal.value)


@pytest.mark.parametrize(
    "read", [read_text, read_texture, frame_sizes, read_csv, read_cases, lambda path: writable_file(path, "--out")]
)
@pytest.mark.parametrize("device", ["/dev/zero", "/dev/null", "/dev/full"])
def test_a_device_may_have_no_end(read, device):
    with pytest.raises(InvalidInput, match=f"{device}: is a device"):
        read(Path(device))


def test_a_byte_order_mark_is_no_part_of_a_text(tmp_path):
    (tmp_path / "file").write_bytes(b"\xef\xbb\xbfspeed = 2")
    assert read_text(tmp_path / "file") == "speed = 2"


@pytest.mark.parametrize("value", [None, 3, b"bytes", "a\0b", ["x"]])
def test_what_is_no_name(value):
    with pytest.raises(InvalidInput, match=r"out: .* is not the name of a file or folder"):
        as_path(value, "out")


def test_room_is_asked_for_before_it_runs_out(tmp_path, largest_file):
    check_room(tmp_path, 1000)
    with largest_file(100), pytest.raises(MachineFault) as fault:
        check_room(tmp_path, 2_000_000)
    assert str(fault.value).startswith(f"{tmp_path}: File too large: 2 MB of temporary files are needed")
    with largest_file(100), pytest.raises(MachineFault), scratch_folder(1000):
        pass
    assert list(tmp_path.iterdir()) == []


def test_no_place_for_temporary_files(monkeypatch):
    def fail(**_):
        raise FileNotFoundError(errno.ENOENT, "No usable temporary directory found")

    monkeypatch.setattr("tempfile.TemporaryDirectory", fail)
    with pytest.raises(DustError, match=r"no temporary folder: .*; TMPDIR may name another place"), scratch_folder(1):
        pass
