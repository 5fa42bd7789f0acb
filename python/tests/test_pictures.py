"""Pictures of carriers, drawn by LAMMPS."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib import pyplot as plt

from dustdetach import Impact, InvalidInput, MachineFault
from dustdetach import pictures as module
from dustdetach.pictures import draw_impact, draw_moments, draw_texture
from dustdetach.shares import read_fates
from dustdetach.texture import make_texture, read_texture


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """Small pictures: the time LAMMPS takes grows with the third power of the size."""
    monkeypatch.setattr(module, "SIZE", 300)
    monkeypatch.setattr(module, "MOMENT_SIZE", 200)


def share(pixels, red, green, blue):
    """Share of the pixels whose colour is nearer to a direction in colour space than 0.97."""
    colour = np.array([red, green, blue])
    bright = pixels[pixels.max(axis=2) > 0.2]
    cosines = bright @ colour / (np.linalg.norm(bright, axis=1) * np.linalg.norm(colour))
    return np.count_nonzero(cosines > 0.985) / pixels[:, :, 0].size


def test_a_texture(tmp_path):
    make_texture(Impact(speed=1.0), tmp_path / "t.txt")
    draw_texture(read_texture(tmp_path / "t.txt"), tmp_path / "t.png")
    pixels = plt.imread(tmp_path / "t.png")[:, :, :3]
    assert min(pixels.shape[:2]) > 200
    height, width = pixels.shape[:2]
    # black, the scale bar, in the lower left corner alone
    black = (pixels < 0.1).all(axis=2)
    assert black[int(0.9 * height) :, : width // 3].any() and not black[: height // 3, : width // 4].any()
    # corners white, the bare cap below the middle the carrier's blue grey
    assert (pixels[0, 0] == 1).all()
    cap = pixels[int(0.88 * height), width // 2]
    assert cap[2] > cap[0]


def test_marks_are_a_round_length_and_the_direction_of_the_impact():
    assert [module._round_length(most) for most in (2.1e-4, 4.9e-5, 9.9e-6)] == pytest.approx([2e-4, 2e-5, 5e-6])
    # from the side, a straight impact goes down and one along the wall to the right
    assert module._projected((0, 0, -1), (90, -90)) == pytest.approx([0, 1])
    assert module._projected((1, 0, 0), (90, -90)) == pytest.approx([1, 0])


def test_an_impact_colours_what_comes_off(tmp_path):
    _, orange, blue, *_ = (kind.colour for kind in module.FATES)
    slow = draw_impact(Impact(speed=3.0), tmp_path / "slow.png")
    fast = draw_impact(Impact(speed=10.0), tmp_path / "fast.png")
    assert slow.north == 0 < fast.north
    slow_pixels, fast_pixels = (plt.imread(tmp_path / name)[:, :, :3] for name in ("slow.png", "fast.png"))
    assert share(slow_pixels, *orange) > 0.03
    assert share(fast_pixels, *blue) > share(slow_pixels, *blue) + 0.01
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fast.png", "slow.png"]


def test_every_detachment_of_an_impact_is_in_the_events(tmp_path):
    from dustdetach import run

    result = run(Impact(speed=8.0, angle=60.0), events=tmp_path / "events")
    fates = read_fates(tmp_path / "events", 4500)
    assert np.bincount(fates, minlength=3).tolist() == [
        round(4500 * (1 - result.dispersion_ratio)),
        round(4500 * result.normal),
        round(4500 * result.tangential_mode),
    ]


def test_grains_of_many_sizes_that_knock_each_other_off_are_drawn(tmp_path):
    sizes = {"distribution": "lognormal", "distribution_spread": 1.5, "bare": 0.6}
    result = draw_impact(Impact(speed=8.0, meet=True, grain_diameter=40e-6, **sizes), tmp_path / "layer.png")
    assert result.knocked > 0.02
    light_blue = (0.34, 0.71, 0.91)
    assert share(plt.imread(tmp_path / "layer.png")[:, :, :3], *light_blue) > 0.001


def test_an_event_of_a_grain_that_is_not_there(tmp_path):
    (tmp_path / "events").write_text("ITEM: ENTRIES step carrier grain mode\n5 1 7 1\n")
    with pytest.raises(InvalidInput, match="an event of grain 7"):
        read_fates(tmp_path / "events", 6)


@pytest.mark.parametrize("line", ["5 1 2", "5 1 2 9 1e-5", "5 1 2 nan", "5 1 two 1", "5 1 inf 1"])
def test_an_event_that_is_none(tmp_path, line):
    (tmp_path / "events").write_text(f"ITEM: ENTRIES step carrier grain mode\n{line}\n")
    with pytest.raises(InvalidInput, match="is no event: the file is cut, or another one"):
        read_fates(str(tmp_path / "events"), 6)


@pytest.mark.parametrize("draw", [draw_impact, draw_texture])
def test_what_cannot_be_drawn(tmp_path, draw):
    with pytest.raises(InvalidInput, match="'x' is not a"):
        draw("x", tmp_path / "x.png")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", [".", "no/such/x.png", "loop/x.png"])
def test_a_place_for_no_picture_is_named_before_any_work(tmp_path, name, monkeypatch):
    (tmp_path / "loop").symlink_to("loop")
    monkeypatch.setattr(module, "run", None)
    with pytest.raises(InvalidInput, match="picture: "):
        draw_impact(Impact(speed=8.0), tmp_path / name)


def test_a_full_disk_leaves_no_half_picture(tmp_path, largest_file, monkeypatch):
    drawn = module._compose

    def compose(*arguments):
        with largest_file(1000):
            drawn(*arguments)

    monkeypatch.setattr(module, "_compose", compose)
    with pytest.raises(MachineFault, match=r"carrier\.png: File too large"):
        draw_impact(Impact(speed=8.0), tmp_path / "carrier.png")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("lost", ["events.dump", "carrier.png"])
def test_what_lammps_could_not_write_is_the_machines_fault(tmp_path, monkeypatch, lost):
    # LAMMPS itself does not always notice
    made = {"events.dump": "make_texture", "carrier.png": "_compose"}[lost]
    go_on = getattr(module, made)

    def cut(*arguments):
        for argument in arguments:
            file = argument.with_name(lost) if isinstance(argument, Path) else None
            if file is not None and file.is_file():
                file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
        return go_on(*arguments)

    monkeypatch.setattr(module, made, cut)
    with pytest.raises(MachineFault) as fault:
        draw_impact(Impact(speed=8.0), tmp_path / "x.png")
    assert lost in str(fault.value)
    assert "the disk may be full" in str(fault.value)
    assert list(tmp_path.iterdir()) == []


def test_the_command_draws(command, tmp_path):
    assert command("texture", "make", "--coverage", "0.05", "--out", "t.txt").returncode == 0
    drawn = command("texture", "draw", "t.txt", "--out", "t.png")
    assert (drawn.returncode, drawn.stdout, drawn.stderr) == (0, "t.png\n", "")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["t.png", "t.txt"]


def test_four_moments_of_a_resolved_impact(tmp_path, resolved_frames, resolved_result):
    draw_moments(resolved_frames, resolved_result, tmp_path / "moments.png")
    pixels = plt.imread(tmp_path / "moments.png")[:, :, :3]
    height, width = (length // 2 for length in pixels.shape[:2])
    first, *_, last = (pixels[top : top + height, left : left + width] for top in (0, height) for left in (0, width))
    orange = module.STATES[1].colour
    assert share(first, *orange) == 0
    assert share(last[: int(0.8 * height)], *orange) > 0.0002
    # the wall, from the left to the right
    wall = np.abs(first - first.max(axis=2, keepdims=True)).max(axis=2) < 0.12
    assert (wall & (first.max(axis=2) < 0.95)).any(axis=0).mean() > 0.9
    assert [path.name for path in tmp_path.iterdir()] == ["moments.png"]


def test_the_picture_of_a_resolved_impact_is_that_of_its_frames(tmp_path, monkeypatch, resolved_impact):
    drawn = []
    monkeypatch.setattr(module, "_draw_frames", lambda frames, result, path: drawn.append((len(frames), result)))
    result = draw_impact(resolved_impact, tmp_path / "moments.png")
    assert drawn == [(4, result)]
    assert result.method == "resolved"


def test_the_moments_are_before_after_and_as_late_as_all_grains_are_there(resolved_result):
    result = replace(resolved_result, contact_time=3.1e-6, timestep=1e-9, grains=45)
    sizes = {step: 46 for step in range(0, 50001, 500)}
    assert module._moments(sizes, result) == [0, 3500, 13000, 50000]
    sizes.update({step: 45 for step in range(30000, 50001, 500)})
    assert module._moments(sizes, result) == [0, 3500, 10000, 29500]
