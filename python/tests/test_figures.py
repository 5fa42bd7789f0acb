"""Figures of sweeps: which are drawn, what is in them, and what cannot be drawn."""

from dataclasses import replace

import pytest
from matplotlib import pyplot as plt

from dustdetach import InvalidInput, MachineFault, read_csv
from dustdetach.figures import COLOURS, _curves, draw, plot
from dustdetach.result import write_csv


def table(folder):
    """The rows with the default law of tangential lift-off."""
    return [row for row in read_csv(folder / "results.csv") if row.tangential == "impulse"]


def test_both_figures_from_one_folder(figures_folder):
    names = [path.name for path in plot(figures_folder)]
    assert names == ["figure4.png", "figure4.svg", "figure5.png", "figure5.svg"]
    for name in names:
        assert (figures_folder / name).stat().st_size > 10_000
    assert plt.imread(figures_folder / "figure4.png").shape[:2] == (780, 1420)


def test_a_sweep_of_angles_alone_makes_one_figure(figures_folder, tmp_path):
    write_csv(tmp_path / "results.csv", [row for row in table(figures_folder) if row.restitution == 0.7])
    assert [path.name for path in plot(tmp_path)] == ["figure5.png", "figure5.svg"]


def test_the_picture_says_what_it_shows(figures_folder, tmp_path):
    rows = [row for row in table(figures_folder) if row.angle == 90]
    with plt.rc_context({"svg.fonttype": "none"}):
        draw([*rows, *map(resolved, rows[:5])], tmp_path / "both")
    text = (tmp_path / "both.svg").read_text()
    for words in ("Impact speed", "(m/s)", "Dispersion ratio", "North", "South", "dust-resolved", "0.5"):
        assert words in text


def resolved(row, **changes):
    return replace(row, method="resolved", normal=None, tangential_mode=None, knocked=None, timestep=1e-9, **changes)


@pytest.mark.filterwarnings("error")
def test_resolved_rows_of_other_parameters_are_a_curve_of_their_own(figures_folder, tmp_path):
    rows = [row for row in table(figures_folder) if row.angle == 90]
    others = [resolved(row, grain_damping=0.2) for row in rows if row.restitution == 0.7 and row.speed in (4, 8)]
    # a layout that does not fit is a warning, and so an error here
    with plt.rc_context({"svg.fonttype": "none"}):
        draw([*rows, *others], tmp_path / "damping")
    text = (tmp_path / "damping.svg").read_text()
    assert text.count("ζ") == 4
    assert text.count("0.2<") >= 1


@pytest.mark.filterwarnings("error")
def test_resolved_rows_alone_are_open_markers_one_a_seed(figures_folder, tmp_path):
    rows = [row for row in table(figures_folder) if (row.angle, row.restitution) == (90, 0.7)]
    seeds = [resolved(row, seed=seed) for row in rows if row.speed in (4, 8) for seed in (1, 2, 3)]
    with plt.rc_context({"svg.fonttype": "none"}):
        draw(seeds, tmp_path / "seeds")
    text = (tmp_path / "seeds.svg").read_text()
    assert ">dust-resolved<" in text
    assert ">functions<" not in text
    # three panels with six points and the legend's
    assert text.count(f"fill: #ffffff; stroke: {COLOURS[0].lower()}") == 3 * 6 + 1


@pytest.mark.filterwarnings("error")
def test_laws_of_a_curve_share_its_colour(figures_folder, tmp_path):
    rows = [row for row in table(figures_folder) if row.angle == 90]
    rows = [replace(row, tangential=law) for row in rows for law in ("impulse", "estimate")]
    points = [resolved(row) for row in rows if row.tangential == "impulse" and row.speed == 8]
    with plt.rc_context({"svg.fonttype": "none"}):
        draw([*rows, *points], tmp_path / "laws")
    text = (tmp_path / "laws.svg").read_text()
    for words in (">impulse<", ">estimate<", ">dust-resolved<"):
        assert text.count(words) == 1
    assert ">functions<" not in text
    # a dashed line in each panel and colour, and the legend's
    assert text.count("stroke-dasharray") >= 3 * 3 + 1
    assert COLOURS[3].lower() not in text


def test_the_same_table_makes_the_same_file(figures_folder, tmp_path):
    rows = table(figures_folder)
    draw(rows, tmp_path / "a")
    draw(rows, tmp_path / "b")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_resolved_runs_of_another_sweep_are_drawn_as_well(figures_folder, tmp_path):
    rows = table(figures_folder)
    write_csv(tmp_path / "results.csv", [row for row in rows if row.angle == 90])
    points = [resolved(row) for row in rows if row.angle == 90 and row.speed == 8]
    write_csv(tmp_path / "resolved.csv", points)
    with plt.rc_context({"svg.fonttype": "none"}):
        assert [path.name for path in plot(tmp_path)] == ["figure4.png", "figure4.svg"]
    assert (tmp_path / "figure4.svg").read_text().count(">dust-resolved<") == 1
    (tmp_path / "resolved.csv").write_text("speed\n")
    with pytest.raises(InvalidInput, match=r"resolved\.csv: "):
        plot(tmp_path)


def test_one_speed_makes_no_curve(figures_folder, tmp_path):
    write_csv(tmp_path / "results.csv", [row for row in table(figures_folder) if row.speed == 4])
    with pytest.raises(InvalidInput, match="at least two speeds are needed"):
        plot(tmp_path)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"speed": -1.0}, "speed: -1 is out of range"),
        ({"speed": 1e308}, "speed: 1e+308 is out of range; allowed: above 0 and at most 100"),
        ({"north": 1.5}, "north: 1.5 is out of range; allowed: 0 to 1"),
        ({"dispersion_ratio": -1e300}, "dispersion_ratio: -1e+300 is out of range"),
    ],
)
def test_numbers_that_no_impact_has_are_named(figures_folder, tmp_path, change, words):
    first, *others = table(figures_folder)
    write_csv(tmp_path / "results.csv", [replace(first, **change), *others])
    with pytest.raises(InvalidInput) as refusal:
        plot(str(tmp_path))
    assert str(refusal.value).startswith(f"{tmp_path / 'results.csv'}: {words}")
    assert [path.name for path in tmp_path.iterdir()] == ["results.csv"]


@pytest.mark.parametrize("folder", ["nowhere", "loop", "a\nb"])
def test_folders_without_a_table_are_named(tmp_path, folder):
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(InvalidInput, match=r"results\.csv: no such file"):
        plot(str(tmp_path / folder))


def test_a_figure_that_cannot_be_replaced_is_named(figures_folder, tmp_path):
    rows = [row for row in table(figures_folder) if row.angle == 90]
    (tmp_path / "figure4.svg").mkdir()
    with pytest.raises(InvalidInput) as refusal:
        draw(rows, tmp_path / "figure4")
    assert str(refusal.value).startswith(f"{tmp_path / 'figure4.svg'}: ")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["figure4.png", "figure4.svg"]


def test_a_full_disk_leaves_no_half_figure(figures_folder, tmp_path, largest_file):
    rows = [row for row in table(figures_folder) if row.angle == 90]
    with largest_file(1000), pytest.raises(MachineFault, match=r"figure4\.png: File too large"):
        draw(rows, tmp_path / "figure4")
    assert list(tmp_path.iterdir()) == []


def test_broken_tables_are_named(tmp_path, figures_folder):
    table = (figures_folder / "results.csv").read_text()
    (tmp_path / "results.csv").write_text(table.replace("north", "nord"))
    with pytest.raises(InvalidInput, match="no column north"):
        plot(tmp_path)
    (tmp_path / "results.csv").write_text(table.replace("rebound", "rebound", 1).replace(",4500,", ",many,", 1))
    with pytest.raises(InvalidInput, match=r"line 2: .*many"):
        plot(tmp_path)


def test_time_steps_that_nobody_asked_for_tell_no_curves_apart(figures_folder):
    rows = [
        row for row in table(figures_folder) if (row.angle, row.restitution, row.tangential) == (90, 0.7, "impulse")
    ]
    assert len({row.timestep for row in rows}) > 3
    assert len(_curves([*rows, *map(resolved, rows)])) == 1
    assert len(_curves([*rows, replace(rows[0], timestep=1e-9)])) > 1
