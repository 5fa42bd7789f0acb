"""Frames of a resolved impact: what they hold, and files that are not what they should be."""

import numpy as np
import pytest

from dustdetach import InvalidInput
from dustdetach.frames import frame_sizes, read_frames


def test_the_frames_hold_what_the_result_says(resolved_impact, resolved_frames, resolved_result):
    sizes = frame_sizes(resolved_frames)
    steps = list(sizes)
    assert steps == list(range(0, resolved_result.steps + 1, 500))
    last, first = read_frames(resolved_frames, [steps[-1], 0])
    assert (first.step, last.step) == (0, steps[-1])
    # necks are not known yet in the first frame
    assert first.tied.all()
    assert sizes[0] - 1 == len(first.tied) == resolved_result.grains
    tied = np.count_nonzero(last.tied)
    assert tied == round(resolved_result.grains * (1 - resolved_result.dispersion_ratio))
    for frame in (first, last):
        assert frame.carrier_radius == pytest.approx(resolved_impact.carrier_diameter / 2)
        assert frame.radii == pytest.approx(resolved_impact.grain_diameter / 2)
        distances = np.linalg.norm(frame.centres - frame.carrier, axis=1)
        touching = frame.carrier_radius + resolved_impact.grain_diameter / 2
        # six digits of a millimetre in the file
        assert distances[frame.tied] == pytest.approx(touching, abs=5e-9)
    # the carrier has gone up and on
    assert (last.carrier - first.carrier)[[0, 2]].min() > 1e-4


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("radius c_tied", "radius", "frame of step 0: no column c_tied"),
        ("TIMESTEP\n0\n", "TIMESTEP\n7\n", "no frame of step 0"),
        (" 1 0 0 ", " 2 0 0 ", "0 carriers where one is expected"),
        (" 1 0 0 ", " 1 here 0 ", "frame of step 0: "),
        ("2 2 0 0 1 0.1 1\n", "", "frame of step 0: the file is cut"),
    ],
)
def test_broken_frames_are_named(tmp_path, old, new, words):
    text = (
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n-2 2\n-2 2\n-2 2\n"
        "ITEM: ATOMS id type x y z radius c_tied\n1 1 0 0 0 1 0\n2 2 0 0 1 0.1 1\n"
    )
    path = tmp_path / "frames"
    path.write_text(text)
    assert len(read_frames(path, [0])) == 1
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(InvalidInput) as refusal:
        read_frames(path, [0])
    assert words in str(refusal.value)
    assert str(path) in str(refusal.value)


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"ITEM: TIMESTEP\n0\nITEM", b"ITEM: TIMESTEP\nzero\n"])
def test_files_without_frames_are_named(tmp_path, content):
    path = tmp_path / "frames"
    path.write_bytes(content)
    for read in (frame_sizes, lambda path: read_frames(path, [0])):
        with pytest.raises(InvalidInput) as refusal:
            read(path)
        assert str(refusal.value).startswith(f"{path}: ")


def test_a_folder_holds_no_frames(tmp_path):
    with pytest.raises(InvalidInput, match="Is a directory"):
        frame_sizes(str(tmp_path))
