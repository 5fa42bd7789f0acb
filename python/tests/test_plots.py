"""Plots over any parameter: what is axis, colour, panel, style and band; no row is left out without a word."""

from dataclasses import replace

import pytest
from matplotlib import pyplot as plt

from dustdetach import Impact, InvalidInput, run
from dustdetach.figures import fixed_words, plot
from dustdetach.plots import plot_by, plot_map, varied
from dustdetach.result import Result, write_csv


@pytest.fixture(scope="module")
def row():
    return run(Impact(speed=4.0))


def made(row, **changes):
    """A row of other parameters, all that follow from them too; its ratio is its place in the unit range."""
    impact = Impact.from_mapping({"speed": 4.0, **changes})
    ratio = round((impact.speed / 20 + impact.angle / 900 + impact.restitution / 10) % 1, 6)
    shares = {"dispersion_ratio": ratio, "south": ratio, "north": 0.0, "normal": ratio, "tangential_mode": 0.0}
    return Result(**{**row.columns(), **impact.values(), **shares})


def table(folder, rows):
    write_csv(folder / "results.csv", rows)
    return folder


@pytest.fixture
def drawn(monkeypatch):
    """The figures that were drawn, before they are closed."""
    figures = []
    close = plt.close
    monkeypatch.setattr(plt, "close", lambda figure: (figures.append(figure), close(figure)))
    return figures


def lines(figure):
    """Number of curves with points in all panels."""
    return sum(len(line.get_xdata()) > 0 for axes in figure.axes for line in axes.get_lines())


def words(figure):
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    texts += [axes.get_title(loc="left") for axes in figure.axes] + [axes.get_xlabel() for axes in figure.axes]
    return " | ".join([*texts, figure.get_supxlabel()])


GRID = [
    {"speed": speed, "angle": angle, "restitution": e}
    for speed in (2.0, 4.0, 8.0)
    for angle in (30.0, 60.0)
    for e in (0.5, 0.7, 0.9)
]


def test_every_row_of_a_sweep_is_in_the_figures_by_speed(row, tmp_path, drawn):
    names = [path.name for path in plot(table(tmp_path, [made(row, **case) for case in GRID]))]
    assert names == ["figure5.png", "figure5.svg"]
    # six curves in each of three panels
    assert lines(drawn[0]) == 18
    for angle in (30, 60):
        for e in (0.5, 0.7, 0.9):
            assert rf"$\alpha$ = {angle}°, $e_{{pw}}$ = {e}" in words(drawn[0])


def test_any_parameter_is_an_axis_a_colour_or_a_panel(row, tmp_path, drawn):
    folder = table(tmp_path, [made(row, **case) for case in GRID])
    names = [path.name for path in plot_by(folder, x="angle", color="restitution", panel="speed")]
    assert names == ["plot-angle-restitution-speed.png", "plot-angle-restitution-speed.svg"]
    assert lines(drawn[0]) == 9
    assert "(a) $v_p$ = 2 m/s" in words(drawn[0])
    assert "Angle to the wall" in words(drawn[0])
    # what is not asked for is found a place
    plot_by(folder, x="speed")
    assert lines(drawn[1]) == 6
    assert "(b) $\\alpha$ = 60°" in words(drawn[1])


def test_what_is_the_same_everywhere_is_said(row, tmp_path, drawn):
    rows = [made(row, **case, carrier="glass", friction=0.2) for case in GRID]
    plot_by(table(tmp_path, rows), x="speed")
    said = drawn[0].get_supxlabel()
    for part in ("carrier glass", "$d_p$ = 1.5 mm", r"$\mu_f$ = 0.2", "$X_0$ = 0.2"):
        assert part in said
    assert "$v_p$" not in said and "mu_w" not in said
    assert fixed_words(rows[:1]).count("$v_p$ = 2 m/s") == 1
    assert "Delta t" not in fixed_words(rows[:1])
    assert r"$\Delta t$ = 2 ns" in fixed_words([made(row, **case, timestep=2e-9) for case in GRID])


def test_seeds_and_uncertain_inputs_are_bands(row, tmp_path, drawn):
    rows = [
        replace(made(row, speed=speed, seed=seed, z0=z0 * 1e-10), dispersion_ratio=0.1 * seed)
        for speed in (2.0, 4.0)
        for seed in (1, 2, 3)
        for z0 in (3.0, 3.1, 3.2, 3.3, 3.4, 3.5, 3.6)
    ]
    plot_by(table(tmp_path, rows), x="speed", color="z0")
    assert "bands: 5 to 95 % of the impacts (3 of seed)" in drawn[0].get_supxlabel()
    rows = [replace(one, carrier=name) for one in rows for name in ("glass", "steel")]
    plot_by(table(tmp_path, rows), x="speed", color="carrier")
    assert "7 of $z_0$, 3 of seed" in drawn[1].get_supxlabel()
    (curve, _) = (line for line in drawn[1].axes[0].get_lines() if len(line.get_xdata()))
    assert list(curve.get_ydata()) == pytest.approx([0.2, 0.2])
    assert len(drawn[1].axes[0].collections) == 2


def test_thirty_curves_have_a_scale_of_colours(row, tmp_path, drawn):
    rows = [made(row, speed=2.0 + k, angle=3.0 * n) for k in range(3) for n in range(1, 31)]
    plot_by(table(tmp_path, rows), x="speed")
    assert lines(drawn[0]) == 30
    assert len({line.get_color() for line in drawn[0].axes[0].get_lines()}) == 30
    assert drawn[0].axes[-1].get_ylabel() == r"Angle to the wall $\alpha$ (°)"


def test_hundreds_of_values_are_points(row, tmp_path, drawn):
    rows = [made(row, speed=2.0 + k / 100, angle=30.0 + k / 10) for k in range(100)]
    plot_by(table(tmp_path, rows), x="speed")
    assert lines(drawn[0]) == 0
    assert len(drawn[0].axes[0].collections[0].get_offsets()) == 100
    # also where figures by speed are asked for, whose legend would have a hundred lines
    assert [path.name for path in plot(tmp_path)] == ["plot-speed-angle.png", "plot-speed-angle.svg"]


def test_maps(row, tmp_path, drawn):
    rows = [made(row, **case, seed=seed) for case in GRID for seed in (1, 2)]
    names = [path.name for path in plot_map(table(tmp_path, rows), "speed", "angle")]
    assert names == ["map-speed-angle-restitution.png", "map-speed-angle-restitution.svg"]
    assert len(drawn[0].axes) == 4
    rows = [replace(one, wall_friction=friction) for one in rows for friction in (0.05, 0.3)]
    with pytest.raises(InvalidInput, match=r"wall_friction vary, too|restitution vary, too"):
        plot_map(table(tmp_path, rows), "speed", "angle")
    with pytest.raises(InvalidInput, match="too few places for a map"):
        plot_map(
            table(tmp_path, [made(row, speed=2.0, angle=30.0), made(row, speed=3.0, angle=40.0)]), "speed", "angle"
        )


def test_what_follows_from_another_parameter_is_none_of_its_own(row):
    rows = [made(row, speed=speed, carrier=name) for speed in (2.0, 4.0) for name in ("glass", "alumina")]
    assert varied(rows) == ["speed", "carrier"]
    by_number = [made(row, speed=speed, carrier_density=rho) for speed in (2.0, 4.0) for rho in (2000.0, 3000.0)]
    assert varied(by_number) == ["speed", "carrier_density"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--x", "colour"), "--x: unknown parameter 'colour'; allowed: speed, angle, restitution"),
        (("--x", "coverage"), "--x: coverage does not vary; allowed: speed, angle, restitution"),
        (("--color", "z0"), "--color: z0 does not vary"),
        (("--panel", "x"), "--panel: unknown parameter 'x'"),
        (("--y", "steps"), "--y: unknown choice 'steps'; allowed: dispersion_ratio, north"),
        (("--map", "speed"), "--map: speed; allowed: two parameters with a comma"),
        (("--map", "speed,speed"), "--map: speed,speed; allowed: two unlike parameters"),
        (("--map", "speed,z0"), "--map: z0 does not vary"),
        (("--map", "speed,angle", "--x", "speed"), "--map: has both axes; allowed: with --panel alone"),
    ],
)
def test_what_cannot_be_drawn_is_one_line(row, tmp_path, command, options, said):
    table(tmp_path, [made(row, **case) for case in GRID])
    process = command("plot", ".", *options)
    assert (process.returncode, process.stdout, process.stderr.count("\n")) == (2, "", 1)
    assert said in process.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["results.csv"]


def test_a_word_is_no_axis(row, tmp_path):
    rows = [made(row, carrier=name) for name in ("glass", "steel")]
    with pytest.raises(InvalidInput, match="--x: --carrier is no number"):
        plot_by(table(tmp_path, rows), x="carrier")
    with pytest.raises(InvalidInput, match="no curve to draw: no number varies"):
        plot_by(table(tmp_path, rows))


def test_the_command_draws(row, tmp_path, command):
    table(tmp_path, [made(row, **case) for case in GRID])
    for options, name in (
        (("--x", "angle", "--color", "speed", "--y", "contact-time"), "plot-contact_time-angle-speed-restitution.png"),
        (("--map", "speed,angle", "--panel", "restitution"), "map-speed-angle-restitution.png"),
    ):
        process = command("plot", ".", *options)
        assert process.returncode == 0, process.stderr
        assert name in process.stdout
        assert (tmp_path / name).stat().st_size > 10_000
