"""Figures of sweeps: which are drawn, what is in them, and what cannot be drawn."""

from dataclasses import replace

import pytest
from matplotlib import pyplot as plt

from dustdetach import InvalidInput, read_csv
from dustdetach.figures import draw, plot
from dustdetach.result import write_csv


def test_both_figures_from_one_folder(figures_folder):
    names = [path.name for path in plot(figures_folder)]
    assert names == ["figure4.png", "figure4.svg", "figure5.png", "figure5.svg"]
    for name in names:
        assert (figures_folder / name).stat().st_size > 10_000
    assert plt.imread(figures_folder / "figure4.png").shape[:2] == (780, 1420)


def test_a_sweep_of_angles_alone_makes_one_figure(figures_folder, tmp_path):
    write_csv(
        tmp_path / "results.csv", [row for row in read_csv(figures_folder / "results.csv") if row.restitution == 0.7]
    )
    assert [path.name for path in plot(tmp_path)] == ["figure5.png", "figure5.svg"]


def test_the_picture_says_what_it_shows(figures_folder, tmp_path):
    rows = [row for row in read_csv(figures_folder / "results.csv") if row.angle == 90]
    resolved = [replace(row, method="resolved", normal=None, tangential_mode=None) for row in rows[:5]]
    with plt.rc_context({"svg.fonttype": "none"}):
        draw([*rows, *resolved], tmp_path / "both")
    text = (tmp_path / "both.svg").read_text()
    for words in ("Impact speed", "(m/s)", "Dispersion ratio", "North", "South", "dust-resolved", "0.5"):
        assert words in text


def test_the_same_table_makes_the_same_file(figures_folder, tmp_path):
    rows = read_csv(figures_folder / "results.csv")
    draw(rows, tmp_path / "a")
    draw(rows, tmp_path / "b")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_one_speed_makes_no_curve(figures_folder, tmp_path):
    write_csv(tmp_path / "results.csv", [row for row in read_csv(figures_folder / "results.csv") if row.speed == 4])
    with pytest.raises(InvalidInput, match="at least two speeds are needed"):
        plot(tmp_path)


def test_broken_tables_are_named(tmp_path, figures_folder):
    table = (figures_folder / "results.csv").read_text()
    (tmp_path / "results.csv").write_text(table.replace("north", "nord"))
    with pytest.raises(InvalidInput, match="no column north"):
        plot(tmp_path)
    (tmp_path / "results.csv").write_text(table.replace("rebound", "rebound", 1).replace(",4500,", ",many,", 1))
    with pytest.raises(InvalidInput, match=r"line 2: .*many"):
        plot(tmp_path)
