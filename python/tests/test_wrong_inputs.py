"""Wrong inputs over all commands: one line, exit status 2 (1 if it is the machine's fault), nothing damaged."""

import hashlib
import os
import resource

import pytest

from dustdetach import Impact, run
from dustdetach.result import write_csv

DATA = "speed,dispersion_ratio\n2,0.2\n4,0.42\n6,0.47\n8,0.55\n"


@pytest.fixture(scope="module")
def rows():
    return [run(Impact(speed=speed)) for speed in (4.0, 8.0)]


@pytest.fixture
def place(tmp_path, rows):
    """A folder with a sweep's table, a sweep file, data and things that are something else."""
    (tmp_path / "done").mkdir()
    write_csv(tmp_path / "done/results.csv", rows)
    (tmp_path / "empty").mkdir()
    (tmp_path / "empty/results.csv").write_text((tmp_path / "done/results.csv").read_text().split("\n")[0] + "\n")
    (tmp_path / "cut").mkdir()
    (tmp_path / "cut/results.csv").write_text((tmp_path / "done/results.csv").read_text()[:-200])
    (tmp_path / "good.toml").write_text("speed = [2, 4]\n")
    for name, text in {
        "syntax": "speed = = 2",
        "key": "spede = 2",
        "none": "speed = []",
        "units": "speed = 4\ngrain_diameter = 20",
        "gpa": "speed = 4\ncarrier_modulus = 210",
        "gcm3": "speed = 4\ngrain_density = 2.7",
        "twice": "speed = 4\nsurface_energy = 0.01\nhamaker = 1e-19",
        "ends": "speed = { from = 2 }",
        "name": "speed = 4\nwall = 'adamant'",
    }.items():
        (tmp_path / f"{name}.toml").write_text(text)
    (tmp_path / "data.csv").write_text(DATA)
    (tmp_path / "percent.csv").write_text(DATA.replace("0.", ""))
    (tmp_path / "one.csv").write_text("speed,dispersion_ratio\n4,0.4\n4,0.42\n4,0.41\n")
    (tmp_path / "mine.toml").write_text("[granite]\ndensity = 2.65\n")
    (tmp_path / "binary").write_bytes(bytes(range(256)))
    return tmp_path


def contents(folder):
    """Of every file below a folder, but for what a machine says in temporary files."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def complaints(process):
    """The lines on standard error, but for how far a sweep has come."""
    return [line for line in process.stderr.splitlines() if not line.endswith(" s left")]


IMPACT = ("impact", "--speed", "4")
WRONG = [
    ((), "the following arguments are required"),
    (("impcat",), "invalid choice: 'impcat'"),
    (("impact",), "the following arguments are required: --speed"),
    (("impact", "--speed", "fast"), "argument --speed: invalid float value: 'fast'"),
    (("impact", "--speed", "0"), "--speed: 0 is out of range; allowed: above 0 and at most 100 m/s"),
    ((*IMPACT, "--angle", "1.57e3"), "--angle: 1570 is out of range"),
    ((*IMPACT, "--grain-diameter", "20"), "--grain-diameter: 20 is out of range"),
    ((*IMPACT, "--z0", "0.4"), "--z0: 0.4 is out of range; allowed: 1e-11 to 1e-07 m"),
    ((*IMPACT, "--carrier", "steal"), "did you mean steel?"),
    ((*IMPACT, "--carrier-density", "7.7"), "--carrier-density: 7.7 is out of range; allowed: 10 to 30000 kg/m3"),
    ((*IMPACT, "--grain-modulus", "75"), "--grain-modulus: 75 is out of range; allowed: 1e+06 to 1e+13 Pa"),
    ((*IMPACT, "--wall-poisson", "30"), "--wall-poisson: 30 is out of range"),
    ((*IMPACT, "--surface-energy", "16"), "--surface-energy: 16 is out of range"),
    ((*IMPACT, "--spin", "1e6"), "--spin: 1e+06 rad/s throws grains off before the impact"),
    ((*IMPACT, "--distribution", "normal", "2e-5", "1.5"), "--distribution: unknown choice 'normal'"),
    ((*IMPACT, "--materials", "mine.toml"), "mine.toml: granite: density: 2.65 is out of range"),
    ((*IMPACT, "--picture", "no/such.png"), "--picture: there is no folder no"),
    (("sweep", "figure6", "--out", "o"), "figure6: no such file; allowed: figure4, figure5"),
    (("sweep", "good.toml"), "the following arguments are required: --out"),
    (("sweep", "syntax.toml", "--out", "o"), "syntax.toml: not TOML"),
    (("sweep", "key.toml", "--out", "o"), "spede: unknown key"),
    (("sweep", "none.toml", "--out", "o"), "speed: empty list"),
    (("sweep", "units.toml", "--out", "o"), "--grain-diameter: 20 is out of range"),
    (("sweep", "gpa.toml", "--out", "o"), "--carrier-modulus: 210 is out of range"),
    (("sweep", "gcm3.toml", "--out", "o"), "--grain-density: 2.7 is out of range"),
    (("sweep", "twice.toml", "--out", "o"), "--surface-energy: the adhesion is given twice"),
    (("sweep", "ends.toml", "--out", "o"), "speed: to: missing in a range"),
    (("sweep", "name.toml", "--out", "o"), "--wall: unknown material 'adamant'"),
    (("sweep", "binary", "--out", "o"), "not a text in UTF-8"),
    (("sweep", "good.toml", "--out", "data.csv"), "--out: data.csv is a file"),
    (("sweep", "good.toml", "--out", "/proc/o"), "allowed: a folder that can be written to"),
    (("sweep", "good.toml", "--out", "o", "--jobs", "0"), "--jobs: 0 is out of range"),
    (("sweep", "good.toml", "--out", "o", "--executor", "slurm"), "--executor: unknown choice 'slurm'"),
    (("plot", "nowhere"), "nowhere/results.csv: no such file"),
    (("plot", "empty"), "empty/results.csv: no curve to draw"),
    (("plot", "cut"), "cut/results.csv: line"),
    (("plot", "done", "--x", "seed"), "--x: seed does not vary; allowed: speed"),
    (("plot", "done", "--map", "speed,angle"), "--map: angle does not vary"),
    (("report", "nowhere"), "nowhere/results.csv: no such file"),
    (("report", "empty"), "empty/results.csv: no results to report"),
    (("report", "done", "--out", "/proc/report.html"), "/proc/report.html"),
    (("fit", "nowhere.csv"), "nowhere.csv: no such file"),
    (("fit", "percent.csv"), "dispersion_ratio: '2' is out of range; allowed: 0 to 1"),
    (("fit", "one.csv"), "one condition (4 m/s, 90 degrees) cannot tell z0 and spread"),
    (("fit", "data.csv", "--free", "seed"), "--free: unknown choice 'seed'"),
    (("fit", "binary"), "not a text in UTF-8"),
    (("materials", "unobtainium"), "unknown material 'unobtainium'"),
    (("texture", "make", "--coverage", "20", "--out", "t"), "--coverage: 20 is out of range"),
    (("texture", "check", "data.csv"), "data.csv"),
    (("texture", "draw", "data.csv", "--out", "t.jpg"), "data.csv"),
]


@pytest.mark.parametrize(("words", "said"), WRONG, ids=[" ".join(words) or "nothing" for words, _ in WRONG])
def test_one_line_and_nothing_damaged(command, place, words, said):
    before = contents(place)
    process = command(*words)
    assert process.returncode == 2, (process.stdout, process.stderr)
    assert process.stdout == ""
    assert process.stderr.count("\n") == 1, process.stderr
    assert process.stderr.startswith("dustdetach")
    assert said in process.stderr
    assert contents(place) == before


@pytest.mark.parametrize("words", [IMPACT, ("sweep", "good.toml", "--out", "o"), ("doctor",)])
@pytest.mark.parametrize("plugin", ["nowhere.so", "binary"])
def test_a_plugin_that_is_none_is_the_machines_fault(command, place, monkeypatch, words, plugin):
    monkeypatch.setenv("DUSTDETACH_PLUGIN", str(place / plugin))
    monkeypatch.delenv("LAMMPS_PLUGIN_PATH", raising=False)
    before = contents(place)
    process = command(*words)
    said = process.stderr or process.stdout
    assert process.returncode == 1, said
    assert plugin in said
    assert len(complaints(process)) == (0 if words == ("doctor",) else 1)
    assert {name: digest for name, digest in contents(place).items() if name in before} == before


def test_a_full_disk_is_the_machines_fault(command, place):
    before = contents(place)

    def full():
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

    for words in (("report", "done"), ("plot", "done"), ("sweep", "good.toml", "--out", "done")):
        process = command(*words, preexec_fn=full)
        assert process.returncode == 1, (words, process.stderr)
        assert len(complaints(process)) == 1, process.stderr
        assert {name: digest for name, digest in contents(place).items() if name in before} == before
        assert not [name for name in os.listdir(place / "done") if name.endswith((".part", ".html", ".png"))]


def test_two_runs_in_one_folder(command, place):
    for _ in range(2):
        assert command("sweep", "good.toml", "--out", "o").returncode == 0
    assert len((place / "o/results.csv").read_text().splitlines()) == 3
