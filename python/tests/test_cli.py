"""The command: what it prints, and that bad input is one line, exit status 2 and nothing written."""

import functools
import json
import os
import resource
from pathlib import Path

import pytest

from dustdetach import Impact
from dustdetach.cli import main
from dustdetach.result import KEYS

INTERFACE_KEYS = [
    "method",
    "speed",
    "angle",
    "restitution",
    "coverage",
    "bare",
    "grain_diameter",
    "carrier_diameter",
    "hamaker",
    "z0",
    "spread",
    "friction",
    "wall_friction",
    "grain_damping",
    "seed",
    "tangential",
    "rotation",
    "grains",
    "dispersion_ratio",
    "north",
    "south",
    "normal",
    "tangential_mode",
    "contact_time",
    "peak_acceleration",
    "restitution_realised",
    "timestep",
    "steps",
    "end",
    "loop_seconds",
    "wall_seconds",
    "lammps_version",
]

IMPACT = ("impact", "--speed", "4", "--angle", "90", "--restitution", "0.7")


def assert_one_line(process, words, status=2):
    assert process.returncode == status, process.stderr
    assert process.stdout == ""
    assert process.stderr.count("\n") == 1, process.stderr
    assert words in process.stderr
    assert process.stderr.startswith("dustdetach")


def test_json_has_the_keys_of_the_interface_in_order(command, tmp_path):
    process = command(*IMPACT, "--method", "functions", "--tangential", "estimate", "--no-rotation", "--json")
    assert process.returncode == 0, process.stderr
    printed = list(json.loads(process.stdout))
    assert printed == list(KEYS)
    # further parameters follow
    assert printed[: len(INTERFACE_KEYS)] == INTERFACE_KEYS
    assert process.stderr == ""
    assert list(tmp_path.iterdir()) == []


def test_the_spin_is_followed_unless_told_otherwise(command):
    # friction spins an oblique carrier up
    oblique = ("impact", "--speed", "8", "--angle", "60", "--wall-friction", "0.3", "--json")
    default, followed, ignored = (
        json.loads(command(*oblique, *option).stdout) for option in ((), ("--rotation",), ("--no-rotation",))
    )
    assert (default["rotation"], followed["rotation"], ignored["rotation"]) == (True, True, False)
    assert default["dispersion_ratio"] == followed["dispersion_ratio"] != ignored["dispersion_ratio"]


def test_grain_damping_of_an_impact_by_functions(command):
    fast = ("impact", "--speed", "12", "--tangential", "integrate", "--json")
    dead, ringing = (json.loads(command(*fast, *option).stdout) for option in ((), ("--grain-damping", "0.06")))
    assert (dead["grain_damping"], ringing["grain_damping"]) == (1.0, 0.06)
    assert ringing["dispersion_ratio"] > dead["dispersion_ratio"]


def test_without_json_a_summary(command, tmp_path):
    process = command(*IMPACT)
    assert process.returncode == 0
    assert "dispersion ratio" in process.stdout
    assert "south" in process.stdout
    assert list(tmp_path.iterdir()) == []


def test_grains_that_meet(command):
    words = (*IMPACT, "--grain-diameter", "40e-6")
    alone, together = (
        json.loads(command(*words, *option, "--json").stdout)
        for option in (("--no-meet", "--tangential", "integrate"), ("--meet",))
    )
    assert (alone["meet"], alone["knocked"], alone["end"]) == (False, 0.0, "rebound")
    assert (together["meet"], together["tangential"], together["end"]) == (True, "integrate", "settled")
    assert "knocked off" in command(*words, "--meet").stdout


def test_a_resolved_impact(command, tmp_path):
    words = (*IMPACT, "--method", "resolved", "--coverage", "0.0004")
    printed = json.loads(command(*words, "--json").stdout)
    assert list(printed) == list(KEYS)
    assert (printed["method"], printed["normal"], printed["tangential_mode"]) == ("resolved", None, None)

    process = command(*words)
    assert process.returncode == 0, process.stderr
    assert process.stderr == ""
    assert "south" in process.stdout
    assert f"dispersion ratio   {printed['dispersion_ratio']:.4f}" in process.stdout
    # which lift-off took a grain is what only the functions know
    assert "by lift-off" not in process.stdout
    assert f"ended by {printed['end']}" in process.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--speed", "0"), "--speed: 0 is out of range; allowed: above 0 and at most 100 m/s"),
        (("--speed", "nan"), "--speed: nan is not a finite number"),
        (("--speed", "fast"), "--speed: invalid float value: 'fast'"),
        (("--angle", "91"), "--angle: 91 is out of range; allowed: above 0 and at most 90 degrees"),
        (("--angle", "0"), "--angle: 0 is out of range"),
        (("--restitution", "0"), "--restitution: 0 is out of range; allowed: 0.01 to 1"),
        (("--timestep", "1e-7"), "--timestep: 1e-07 s makes"),
        (("--speed", "1e-12", "--timestep", "1e-9"), "--timestep: 1e-09 s makes"),
        (("--restitution", "1.2"), "--restitution: 1.2 is out of range"),
        (("--coverage", "0"), "--coverage: 0 is out of range; allowed: above 0 and at most 0.5"),
        (("--coverage", "-1"), "--coverage: -1 is out of range"),
        (("--coverage", "0.7"), "--coverage: 0.7 is out of range"),
        (("--bare", "4"), "--bare: 4 is out of range"),
        (
            ("--grain-diameter", "0.002"),
            "--grain-diameter: 0.002 is out of range; allowed: above 0 and below 0.00075 m",
        ),
        (("--carrier-diameter", "-1"), "--carrier-diameter: -1 is out of range"),
        (("--hamaker", "0"), "--hamaker: 0 is out of range"),
        (("--z0", "0"), "--z0: 0 is out of range"),
        (("--friction", "-1"), "--friction: -1 is out of range"),
        (("--wall-friction", "-1"), "--wall-friction: -1 is out of range"),
        (("--grain-damping", "-1"), "--grain-damping: -1 is out of range"),
        (("--seed", "0"), "--seed: 0 is out of range; allowed: 1 to 900000000"),
        (("--seed", "1.5"), "--seed: invalid int value: '1.5'"),
        (
            ("--tangential", "guess"),
            "--tangential: unknown choice 'guess'; allowed: impulse, estimate, integrate, frictionless, off",
        ),
        (("--timestep", "1"), "--timestep: 1 is out of range"),
        (("--method", "magic"), "--method: unknown choice 'magic'; allowed: functions, resolved"),
        (("--method", "both"), "--method: unknown choice 'both'; allowed: functions, resolved"),
        (("--method", "resolved", "--timestep", "1e-8"), "--timestep: 1e-08 s does not resolve the contact of a grain"),
        (("--method", "resolved", "--grain-diameter", "2e-6"), "in a resolved run at most 100000"),
        (("--method", "resolved", "--no-rotation"), "--rotation: false is for the functions"),
        (("--picture", "carrier.txt"), "--picture: carrier.txt; allowed: a file name that ends in .png"),
        (("--picture", "no/such/carrier.png"), "--picture: there is no folder no/such"),
        (("--colour", "red"), "unrecognized arguments: --colour red"),
        (("--spe", "4"), "unrecognized arguments: --spe 4"),
    ],
)
def test_bad_options_of_impact(command, tmp_path, options, words):
    assert_one_line(command(*IMPACT, *options), words)
    assert list(tmp_path.iterdir()) == []


def test_what_lammps_refuses(command, tmp_path):
    # so near to where placement jams that only the placement can tell
    process = command(*IMPACT, "--coverage", Impact(speed=4).largest_coverage)
    assert_one_line(process, "coverage")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("sweep", "figure6", "--out", "out"), "figure6: no such file; allowed: figure4, figure5"),
        (("sweep", "figure4"), "--out"),
        (("sweep", "figure4", "--out", "out", "--jobs", "0"), "--jobs: 0 is out of range; allowed: 1 or more"),
        (("sweep", "figure4", "--out", "out", "--executor", "cloud"), "--executor: unknown choice 'cloud'"),
        (
            ("sweep", "figure4", "--out", "out", "--method", "magic"),
            "--method: unknown choice 'magic'; allowed: functions, resolved, both",
        ),
        (("plot", "nowhere"), "nowhere/results.csv: no such file"),
        (("report", "nowhere"), "nowhere/results.csv: no such file"),
        (("texture", "make", "--coverage", "0.7", "--out", "t"), "--coverage: 0.7 is out of range"),
        (("texture", "make", "--out", "no/such/t"), "--out: there is no folder no/such"),
        (("texture", "make", "--out", "."), "--out: . is a folder"),
        (("texture", "check", "nowhere"), "nowhere: it cannot be read: No such file"),
        (("texture", "draw", "nowhere", "--out", "t.png"), "nowhere: it cannot be read: No such file"),
        (("conjure",), "invalid choice: 'conjure'"),
        ((), "required: COMMAND"),
    ],
)
def test_bad_arguments_of_the_other_commands(command, tmp_path, arguments, words):
    assert_one_line(command(*arguments), words)
    assert list(tmp_path.iterdir()) == []


def test_out_that_is_a_file(command, tmp_path):
    (tmp_path / "out").write_text("mine")
    assert_one_line(command("sweep", "figure4", "--out", "out"), "--out: out is a file; allowed: the name of a folder")
    assert (tmp_path / "out").read_text() == "mine"


def test_unknown_key_of_a_sweep(command, tmp_path):
    (tmp_path / "sweep.toml").write_text("speed = [2, 4]\nspede = 3\n")
    assert_one_line(command("sweep", "sweep.toml", "--out", "out"), "sweep.toml: spede: unknown key")
    assert not (tmp_path / "out").exists()


def test_a_value_out_of_range_in_a_sweep(command, tmp_path):
    (tmp_path / "sweep.toml").write_text("speed = [2, 4]\nangle = [90, 91]\n")
    assert_one_line(command("sweep", "sweep.toml", "--out", "out"), "--angle: 91 is out of range")
    assert not (tmp_path / "out").exists()


def test_a_missing_plugin_is_said_with_what_to_do(command, tmp_path, monkeypatch):
    monkeypatch.setenv("DUSTDETACH_PLUGIN", str(tmp_path / "dustplugin.so"))
    assert_one_line(command(*IMPACT), "run ./bootstrap build or set DUSTDETACH_PLUGIN", status=1)


def test_a_missing_lammps_is_said_with_what_to_do(command, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[1] / "src"))
    assert_one_line(command(*IMPACT), "no Python module lammps", status=1)


def test_missing_decks_are_said_with_what_to_do(command, tmp_path, monkeypatch):
    monkeypatch.setenv("DUSTDETACH_INPUTS", str(tmp_path))
    assert_one_line(command(*IMPACT), "set DUSTDETACH_INPUTS", status=1)


def test_several_ranks_are_for_the_mpi_executor(command, monkeypatch):
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "2")
    monkeypatch.setenv("OMPI_COMM_WORLD_RANK", "0")
    assert_one_line(command(*IMPACT), "started on 2 MPI ranks; allowed: sweep with --executor mpi")


def test_the_mpi_executor_says_what_it_needs(command, tmp_path, monkeypatch):
    # a folder that hides an installed mpi4py
    hidden = tmp_path / "hidden"
    (hidden / "mpi4py").mkdir(parents=True)
    (hidden / "mpi4py" / "__init__.py").write_text("raise ImportError('hidden')\n")
    monkeypatch.setenv("PYTHONPATH", str(hidden), prepend=":")
    process = command("sweep", "figure4", "--out", "out", "--executor", "mpi")
    assert_one_line(process, "--executor mpi needs mpi4py", status=1)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_full_disk_behind_the_output(command, monkeypatch, unbuffered):
    monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
    with open("/dev/full", "w") as full:
        process = command(*IMPACT, "--json", stdout=full)
    assert process.returncode == 1
    assert process.stderr == "dustdetach impact: standard output: No space left on device\n"


def test_a_full_disk_behind_a_picture(command, tmp_path, monkeypatch):
    # no room for the files of MPI, which would end the process on its own
    limit = functools.partial(resource.setrlimit, resource.RLIMIT_FSIZE, (100_000, 100_000))
    process = command(*IMPACT, "--picture", "x.png", preexec_fn=limit)
    assert_one_line(process, "File too large", status=1)
    assert "TMPDIR may name another folder" in process.stderr
    assert list(tmp_path.iterdir()) == []


def test_names_of_files_need_not_be_text(command, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONIOENCODING", "utf-8:strict")
    name = os.fsdecode(b"caf\xe9")
    (tmp_path / "sweep.toml").write_text("speed = 2\n")
    process = command("sweep", "sweep.toml", "--out", name, encoding="utf-8", errors="surrogateescape")
    assert process.returncode == 0, process.stderr
    assert process.stdout == f"{name}/results.csv\n"
    assert_one_line(command("plot", name), "caf\\udce9/results.csv: no curve to draw")


def test_a_name_of_two_lines_is_said_on_one(command, tmp_path):
    process = command("sweep", "two\nlines.toml", "--out", "out")
    assert process.stderr.startswith("dustdetach sweep: two\\nlines.toml: no such file")
    assert_one_line(process, "no such file")
    assert_one_line(command(*IMPACT, "two\nlines"), "unrecognized arguments: two\\nlines")
    assert list(tmp_path.iterdir()) == []


def test_help_and_version(command):
    assert "impact" in command("--help").stdout
    assert command("--version").stdout.startswith("dustdetach ")
    for name in ("impact", "sweep", "plot", "texture", "doctor"):
        assert command(name, "--help").returncode == 0


def test_main_returns_the_status(capsys):
    assert main(["plot", "/nowhere"]) == 2
    assert "no such file" in capsys.readouterr().err


def test_a_sweep_of_functions_does_without_numpy(command, tmp_path):
    code = "import sys; from dustdetach.cli import main; main(sys.argv[1:]); print('numpy' in sys.modules)"
    (tmp_path / "one.toml").write_text("speed = 8\ncarrier = 'glass'\n")
    assert command("sweep", "one.toml", "--out", "out", program=("-c", code)).stdout.endswith("results.csv\nFalse\n")


def test_help_comes_at_once_and_what_few_need_is_not_loaded(command):
    code = "import sys, dustdetach.cli; print([name for name in sys.modules if name.split('.')[0] in sys.argv[1:]])"
    heavy = ("numpy", "scipy", "pandas", "pyarrow", "matplotlib", "PIL", "lammps")
    assert command(*heavy, program=("-c", code)).stdout == "[]\n"
    taken = []
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        assert "materials" in command("--help").stdout
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        taken.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    assert min(taken) < 0.4
