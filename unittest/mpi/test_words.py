"""One rank makes, reads and writes textures for all: what it meets stops all of them with one line."""

from pathlib import Path

import pytest
from ranks import run_ranks

MONOLAYER = "monolayer 20e-6 coverage 0.2 seed 1"


def said(folder: Path, ranks: int, texture: str) -> tuple[int, str]:
    """Exit status and output of the deck."""
    done = run_ranks(folder, Path(__file__).with_name("in.words"), ranks, texture=texture)
    return done.returncode, done.stdout


@pytest.mark.parametrize(
    ("texture", "message"),
    [
        (f"{MONOLAYER} write /dev/full", "write /dev/full: it cannot be written: No space left on device"),
        ("monolayer 1e-6 coverage 3 seed 1", "texture: coverage 3 cannot be placed: it must be at most about 0.53"),
        ("file none.txt", "texture file none.txt: it cannot be read: No such file or directory"),
        ("file empty.txt", "texture file empty.txt: line 1: a texture file starts with '# dust texture 1'"),
    ],
)
def test_all_ranks_stop(tmp_path, texture, message):
    (tmp_path / "empty.txt").touch()
    status, output = said(tmp_path, 2, texture)
    assert status != 0
    first = next(line for line in output.splitlines() if line.startswith("ERROR"))
    assert first.startswith(f"ERROR: Fix dust/detach {message}")
    assert [path.name for path in tmp_path.iterdir()] == ["empty.txt"]


def test_all_ranks_have_the_same_texture(tmp_path):
    assert said(tmp_path, 1, f"{MONOLAYER} write one.txt")[0] == 0
    assert said(tmp_path, 2, f"{MONOLAYER} write two.txt")[0] == 0
    assert said(tmp_path, 2, "file one.txt write again.txt")[0] == 0
    one = (tmp_path / "one.txt").read_text()
    assert one.count("\n") == 4506
    assert (tmp_path / "two.txt").read_text() == (tmp_path / "again.txt").read_text() == one
