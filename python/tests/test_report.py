"""Reports: what they say, that they repeat what they report, and that a browser opens, sorts and turns them."""

import html
import json
import random
import re
import shlex
import shutil
import subprocess
from dataclasses import replace

import pytest

from dustdetach import Impact, InvalidInput, read_cases, read_csv, run, sweep
from dustdetach.report import command_of, sweep_file, write_report
from dustdetach.result import KEYS, write_csv

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")

GLASS = {"carrier": "glass", "wall": "steel", "carrier_diameter": 2e-3}


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """A folder with a sweep of glass beads, and its report."""
    folder = tmp_path_factory.mktemp("report")
    sweep([Impact(speed=speed, angle=angle, **GLASS) for speed in (4.0, 8.0, 12.0) for angle in (45.0, 90.0)], folder)
    return folder, write_report(folder)


def data_of(report):
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', report.read_text())[1])


def test_the_report_says_what_it_is_about(swept):
    report = swept[1]
    text = html.unescape(report.read_text())
    assert report.name == "report.html"
    for words in (
        "Dust from glass carriers that hit steel",
        "Asked in 6 impacts: impact speed: 4, 8, 12 m/s; angle between velocity and wall: 45, 90°.",
        "carrier glass of 2 mm: 2500 kg/m3, 70 GPa, Poisson 0.2",
        "One texture (seed 1) in all impacts",
        "Digests: dustdetach",
        "dustdetach impact --speed 4.0 --angle 45.0",
    ):
        assert words in text, words
    assert text.count("<svg") >= 1
    assert data_of(report)["count"] == 6
    assert report.stat().st_size < 5e6


def test_nothing_comes_from_elsewhere(swept):
    text = swept[1].read_text()
    # of SVG, the addresses are names of formats
    for tag in ("src", "href"):
        assert all(place.startswith("#") for place in re.findall(rf'\b{tag}="([^"]*)"', text)), tag
    assert not re.search(r"url\((?!#)|@import|fetch\(|XMLHttpRequest|<link|<iframe", text)
    assert "default-src 'none'" in text


def test_the_carriers_are_those_of_the_runs(swept):
    for carrier in data_of(swept[1])["carriers"]:
        speed, angle = map(float, re.match(r"(\S+) m/s, (\S+) degrees", carrier["label"]).groups())
        result = run(Impact(speed=speed, angle=angle, **GLASS))
        assert f"ratio {result.dispersion_ratio:.3f}" in carrier["label"]


@pytest.mark.parametrize(
    "changes",
    [
        {},
        GLASS,
        {"carrier_density": 2600.0},
        {"carrier": "glass", "carrier_modulus": 65e9, "surface_energy": 0.02},
        {"hamaker": 1e-19, "bare": 0.5, "rotation": False},
        {"distribution": "lognormal", "distribution_spread": 1.5, "grain_diameter": 15e-6, "bare": 0.4},
        {"carrier": "glass", "wall": "alumina", "grain": "quartz", "method": "resolved"},
        {"spin": -1000.0, "tangential": "integrate", "grain_damping": 0.2, "seed": 7},
    ],
)
def test_commands_and_files_repeat_an_impact(command, tmp_path, changes):
    impact = Impact(speed=8.0, **changes)
    (tmp_path / "sweep.toml").write_text(sweep_file([impact, replace(impact, speed=9.0)]))
    again = read_cases(tmp_path / "sweep.toml")
    assert [case.values() for case in again] == [impact.values(), replace(impact, speed=9.0).values()]
    if impact.method == "functions":
        printed = json.loads(command(*shlex.split(command_of(impact))[1:], "--json").stdout)
        assert {name: printed[name] for name in impact.values()} == impact.values()


def test_warnings(swept, tmp_path):
    rows = read_csv(swept[0] / "results.csv")
    bad = replace(rows[0], end="step limit", restitution_realised=0.5, lammps_version=20240829, timestep=6e-8, bare=0.1)
    write_csv(tmp_path / "results.csv", [bad, *rows[1:]])
    text = html.unescape(write_report(tmp_path).read_text())
    for words in (
        "at the step limit",
        "is not that asked for",
        "several versions",
        "fewer than 100 time steps",
        "crushes",
    ):
        assert words in text, words


def test_names_cannot_break_the_page(swept, tmp_path):
    rows = read_csv(swept[0] / "results.csv")
    write_csv(tmp_path / "results.csv", [replace(rows[0], end="</script><b>&")])
    report = write_report(tmp_path)
    assert report.read_text().count("</script>") == 2
    assert data_of(report)["values"][KEYS.index("end")] == ["</script><b>&"]


def test_a_long_table_is_small_enough_to_mail(swept, tmp_path):
    row = read_csv(swept[0] / "results.csv")[0]
    chance = random.Random(1)
    rows = []
    for _ in range(800):
        unlike = Impact(speed=chance.uniform(2, 20), angle=chance.uniform(20, 90), z0=chance.uniform(3e-10, 5e-10))
        rows.append(replace(row, **unlike.values(), dispersion_ratio=chance.random()))
    write_csv(tmp_path / "results.csv", rows)
    assert write_report(tmp_path).stat().st_size < 2.5e6


def test_a_table_too_long_to_mail(swept, tmp_path):
    rows = read_csv(swept[0] / "results.csv")
    write_csv(tmp_path / "results.csv", rows * 501)
    with pytest.raises(InvalidInput, match="3006 results; allowed: at most 3000 in a report"):
        write_report(tmp_path)


def test_the_command(command, swept, tmp_path):
    process = command("report", swept[0], "--out", "mail.html")
    assert (process.returncode, process.stdout.strip()) == (0, "mail.html"), process.stderr
    assert (tmp_path / "mail.html").stat().st_size > 100_000
    for words, said in (
        (("report", "nowhere"), "nowhere/results.csv: no such file"),
        (("report", swept[0], "--out", "no/such/file"), "--out: there is no folder no/such"),
    ):
        process = command(*words)
        assert (process.returncode, process.stdout, process.stderr.count("\n")) == (2, "", 1)
        assert said in process.stderr


# what a reader does: sorts by a title, twice; turns the carrier; asks for when; its answers go into the document
USE = """
<script>
const said = {errors: window.faults, rows: document.querySelectorAll("#table tbody tr").length};
const column = () => [...document.querySelectorAll("#table tbody tr")].map(row => Number(row.cells[2].textContent));
const title = () => document.querySelector("#table th[data-name=dispersion_ratio]");
title().click(); said.rising = column();
title().click(); said.falling = column();
document.getElementById("all").click(); said.titles = document.querySelectorAll("#table th").length;
const box = document.getElementById("carrier"), shot = () => box.toDataURL();
const first = shot();
for (const [type, x] of [["pointerdown", 100], ["pointermove", 180], ["pointerup", 180]])
  box.dispatchEvent(new PointerEvent(type, {clientX: x, clientY: 200, pointerId: 1}));
said.turned = shot() !== first;
const second = shot();
document.querySelector("input[value=when]").click(); said.recoloured = shot() !== second;
const third = shot(), slider = document.getElementById("until");
slider.value = 30; slider.dispatchEvent(new Event("input")); said.earlier = shot() !== third;
said.csv = csvText();
said.asked = performance.getEntriesByType("resource").length;
document.body.insertAdjacentHTML("beforeend", "<pre id=said></pre>");
document.getElementById("said").textContent = JSON.stringify(said);
</script>
"""


@pytest.mark.skipif(CHROMIUM is None, reason="no chromium")
def test_a_browser_opens_sorts_and_turns_it(swept, tmp_path):
    text = swept[1].read_text()
    watch = "<script>window.faults = []; onerror = fault => { window.faults.push(String(fault)); };</script>"
    used = tmp_path / "used.html"
    used.write_text(text.replace("<head>", "<head>" + watch).replace("</body>", USE + "</body>"))
    options = ("--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}")
    done = subprocess.run(
        [CHROMIUM, *options, "--virtual-time-budget=5000", "--dump-dom", used.as_uri()],
        capture_output=True,
        text=True,
        timeout=240,
    )
    said = json.loads(html.unescape(re.search(r'<pre id="said">(.*?)</pre>', done.stdout, re.S)[1]))
    assert said["errors"] == []
    assert said["rows"] == 6
    assert said["rising"] == sorted(said["rising"]) != said["falling"]
    assert said["falling"] == sorted(said["falling"], reverse=True)
    assert said["titles"] > 40
    assert said["turned"] and said["recoloured"] and said["earlier"]
    assert said["asked"] == 0
    # what is downloaded is the table
    (tmp_path / "results.csv").write_text(said["csv"])
    assert read_csv(tmp_path / "results.csv") == read_csv(swept[0] / "results.csv")
