"""Sweeps: the table, picking up after a kill, failures, several processes and ranks."""

import csv
import errno
import os
import shutil
import signal
import subprocess
import sys
import time

import pytest

from dustdetach import CasesFailed, Impact, InvalidInput, MachineFault, figure4, figure5, sweep
from dustdetach.places import find_deck
from dustdetach.result import KEYS
from dustdetach.sweeping import Build, _attempt, _Table

CASES = [Impact(speed=float(speed), angle=angle) for speed in range(2, 8) for angle in (60.0, 90.0)]


def completed(folder):
    return {path: path.stat().st_mtime_ns for path in folder.glob("*/result.json")}


def rows(folder):
    with open(folder / "results.csv", newline="") as stream:
        return list(csv.DictReader(stream))


def test_results_come_in_the_order_of_the_cases_and_fill_the_table(tmp_path):
    results = sweep([*CASES, CASES[0]], tmp_path / "out")
    assert [(result.speed, result.angle) for result in results] == [(case.speed, case.angle) for case in CASES]
    table = rows(tmp_path / "out")
    assert len(table) == len(CASES)
    assert tuple(table[0]) == KEYS
    assert {float(row["dispersion_ratio"]) for row in table} == {result.dispersion_ratio for result in results}


def test_only_what_is_missing_is_run_again(tmp_path):
    sweep(CASES, tmp_path)
    before = completed(tmp_path)
    removed = sorted(before)[:3]
    for path in removed:
        path.unlink()
    told = []
    sweep(CASES, tmp_path, progress=lambda done, total, left: told.append((done, total)))
    after = completed(tmp_path)
    assert [path for path in before if after[path] != before[path]] == sorted(removed, key=list(before).index)
    assert told == [(done, len(CASES)) for done in range(len(CASES) - 3, len(CASES) + 1)]
    assert len(rows(tmp_path)) == len(CASES)


def test_a_killed_sweep_picks_up_where_it_stopped(tmp_path, command):
    speeds = [1 + 0.05 * i for i in range(300)]
    (tmp_path / "sweep.toml").write_text(f"speed = {speeds}\n")
    folder = tmp_path / "out"
    words = [sys.executable, "-m", "dustdetach", "sweep", "sweep.toml", "--out", "out"]
    process = subprocess.Popen(words, cwd=tmp_path, stderr=subprocess.DEVNULL, start_new_session=True)
    while len(completed(folder)) < 5:
        assert process.poll() is None
        time.sleep(0.002)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = completed(folder)
    assert 5 <= len(before) < len(speeds)

    again = command("sweep", "sweep.toml", "--out", "out")
    assert again.returncode == 0, again.stderr
    assert again.stderr.startswith(f"{len(before)}/{len(speeds)} cases")
    after = completed(folder)
    assert {path: after[path] for path in before} == before
    assert len(after) == len(rows(folder)) == len(speeds)


def test_both_methods_in_a_folder_after_a_kill(tmp_path, command):
    (tmp_path / "sweep.toml").write_text("speed = [4, 8]\ncoverage = 0.0004\n")
    folder = tmp_path / "out"
    words = ["sweep", "sweep.toml", "--method", "both", "--out", "out"]
    process = subprocess.Popen(
        [sys.executable, "-m", "dustdetach", *words], cwd=tmp_path, stderr=subprocess.DEVNULL, start_new_session=True
    )
    # functions first; killed in the second of the resolved impacts
    while not list(folder.glob("resolved-*/result.json")):
        assert process.poll() is None
        time.sleep(0.002)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = completed(folder)
    assert len(before) == 3

    again = command(*words)
    assert again.returncode == 0, again.stderr
    assert again.stderr.startswith("3/4 cases")
    after = completed(folder)
    assert {path: after[path] for path in before} == before
    table = rows(folder)
    assert sorted((row["method"], float(row["speed"])) for row in table) == [
        ("functions", 4),
        ("functions", 8),
        ("resolved", 4),
        ("resolved", 8),
    ]
    for row in table:
        assert (row["normal"] == "") == (row["tangential_mode"] == "") == (row["method"] == "resolved")
    # a sweep by one method keeps the rows of the other
    assert command("sweep", "sweep.toml", "--out", "out").returncode == 0
    assert completed(folder) == after
    assert rows(folder) == table


def test_each_method_has_its_own_deck_in_the_name(monkeypatch, tmp_path):
    build = Build()
    assert build.identity["functions"] != build.identity["resolved"]
    functions, resolved = (build.name(Impact(speed=4.0, method=method)) for method in ("functions", "resolved"))
    for name in ("in.impact", "in.impact.resolved"):
        shutil.copy(find_deck(name), tmp_path)
    with open(tmp_path / "in.impact.resolved", "a") as stream:
        stream.write("# changed\n")
    monkeypatch.setattr("dustdetach.sweeping.find_deck", lambda name: tmp_path / name)
    # results of the other method stay good
    assert Build().name(Impact(speed=4.0)) == functions
    assert Build().name(Impact(speed=4.0, method="resolved")) != resolved


def test_sweeps_of_the_same_folder_share_cases_and_the_table(figures_folder, impulse_table):
    assert len(rows(figures_folder)) == 2 * len(impulse_table) == len(completed(figures_folder))


def test_results_of_another_build_are_not_taken(tmp_path, monkeypatch):
    sweep(CASES[:2], tmp_path)
    monkeypatch.setattr("dustdetach.sweeping.__version__", "another")
    sweep(CASES[:2], tmp_path)
    assert len(completed(tmp_path)) == 4
    assert len(rows(tmp_path)) == 2


def test_a_case_that_fails_is_reported_and_the_others_go_on(tmp_path, command):
    hopeless = Impact(speed=1.0).largest_coverage
    (tmp_path / "sweep.toml").write_text(f"speed = [2, 4]\ncoverage = [0.2, {hopeless}]\n")
    process = command("sweep", "sweep.toml", "--out", "out")
    assert process.returncode == 1
    assert process.stderr.count("case failed") == 2
    assert len(rows(tmp_path / "out")) == 2
    with pytest.raises(CasesFailed) as failure:
        sweep([Impact(speed=2.0, coverage=hopeless)], tmp_path / "out")
    assert len(failure.value.failures) == 1


def test_if_every_case_fails_nothing_is_written(tmp_path):
    with pytest.raises(CasesFailed):
        sweep([Impact(speed=2.0, coverage=Impact(speed=1.0).largest_coverage)], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_processes_give_what_one_gives(tmp_path, impulse_table):
    for result in sweep(CASES, tmp_path, jobs=2):
        expected = impulse_table.get((result.speed, result.angle, result.restitution))
        assert expected is not None
        assert result.dispersion_ratio == expected.dispersion_ratio
        assert result.contact_time == expected.contact_time


def test_ranks_give_what_one_gives(tmp_path, command, impulse_table):
    pytest.importorskip("mpi4py")
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        pytest.skip("no mpirun")
    (tmp_path / "sweep.toml").write_text("speed = [2, 4, 6, 8]\nangle = [60, 90]\n")
    launcher = [mpirun, "--allow-run-as-root", "--oversubscribe", "-np", "3"]
    process = command("sweep", "sweep.toml", "--out", "out", "--executor", "mpi", launcher=launcher)
    assert process.returncode == 0, process.stderr
    assert process.stdout == "out/results.csv\n"
    table = rows(tmp_path / "out")
    assert len(table) == 8
    for row in table:
        expected = impulse_table[float(row["speed"]), float(row["angle"]), 0.7]
        assert float(row["dispersion_ratio"]) == expected.dispersion_ratio


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"jobs": 0}, "--jobs: 0 is out of range"),
        ({"executor": "cloud"}, "--executor: unknown choice 'cloud'; allowed: local, mpi"),
        ({"executor": "mpi", "jobs": 2}, "--jobs: with --executor mpi"),
        ({"jobs": 1.5}, "--jobs: 1.5 is not a whole number; allowed: 1 or more"),
        ({"jobs": "2"}, "--jobs: '2' is not a whole number"),
        ({"jobs": True}, "--jobs: True is out of range"),
        ({"jobs": None}, "--jobs: None is not a whole number"),
        ({"executor": None}, "--executor: unknown choice None"),
    ],
)
def test_bad_arguments(tmp_path, options, words):
    with pytest.raises(InvalidInput, match=words):
        sweep(CASES, tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("cases", [None, "figure4", [3], Impact(speed=2), [Impact(speed=2), "x"]])
def test_what_is_no_list_of_impacts(tmp_path, cases):
    with pytest.raises(InvalidInput, match=r"sweep: .* is not (an Impact|a list of impacts)"):
        sweep(cases, tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("out", [None, 3, b"out", "a\0b"])
def test_what_is_no_name_of_a_folder(out):
    with pytest.raises(InvalidInput, match=r"--out: .* is not the name"):
        sweep(CASES, out)


def test_a_missing_plugin_stops_the_sweep(tmp_path, command, monkeypatch):
    monkeypatch.setenv("DUSTDETACH_PLUGIN", str(tmp_path / "none.so"))
    process = command("sweep", "figure4", "--out", "out")
    assert process.returncode == 1
    assert "run ./bootstrap build or set DUSTDETACH_PLUGIN" in process.stderr
    assert not (tmp_path / "out").exists()


def test_a_folder_that_takes_no_files_is_named_before_any_work():
    with pytest.raises(InvalidInput, match="--out: /proc/nowhere"):
        sweep(CASES, "/proc/nowhere")


@pytest.mark.parametrize("name", ["file", "file/out", "loop", "loop/out", "x" * 300, "broken"])
def test_what_is_no_folder_is_named_before_any_work(tmp_path, name):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "broken").symlink_to("nowhere")
    with pytest.raises(InvalidInput, match="--out: "):
        sweep(CASES, tmp_path / name)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["broken", "file", "loop"]


@pytest.mark.parametrize("how", ["empty", "cut", "folder", "another"])
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_result_that_is_none_is_named_before_any_work(tmp_path, how, jobs):
    sweep(CASES[:2], tmp_path)
    first, _ = sorted(tmp_path.glob("*/result.json"))
    text = first.read_text()
    first.unlink()
    if how == "folder":
        first.mkdir()
    else:
        first.write_text({"empty": "", "cut": text[: len(text) // 2], "another": "[1, 2]"}[how])
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}
    with pytest.raises(InvalidInput) as refusal:
        sweep(CASES, tmp_path, jobs=jobs)
    assert str(refusal.value).startswith(f"{first}: ")
    assert str(refusal.value).endswith("remove it, and its case is run again")
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")} == before
    # as it says
    shutil.rmtree(first) if how == "folder" else first.unlink()
    assert len(sweep(CASES[:2], tmp_path)) == len(rows(tmp_path)) == 2


def test_ranks_agree_on_a_result_that_is_none(tmp_path, command):
    pytest.importorskip("mpi4py")
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        pytest.skip("no mpirun")
    sweep(CASES[:2], tmp_path / "out")
    broken = next((tmp_path / "out").glob("*/result.json"))
    broken.write_text("")
    launcher = [mpirun, "--allow-run-as-root", "--oversubscribe", "-np", "3"]
    process = command("sweep", "figure4", "--out", "out", "--executor", "mpi", launcher=launcher)
    assert process.returncode == 2
    said = [line for line in process.stderr.splitlines() if "dustdetach" in line]
    reason = "not a result: cut, or no JSON; remove it, and its case is run again"
    assert said == [f"dustdetach sweep: {broken.relative_to(tmp_path)}: {reason}"]


def test_a_table_that_is_a_folder_is_named_before_any_work(tmp_path):
    (tmp_path / "results.csv").mkdir()
    with pytest.raises(InvalidInput, match=r"--out: .*/results\.csv is a folder"):
        sweep(CASES, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["results.csv"]


def test_a_table_that_cannot_be_replaced_is_named_and_the_results_stay(tmp_path, monkeypatch):
    rename = os.replace

    def refuse(part, path):
        if path.name == "results.csv":
            raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))
        rename(part, path)

    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(InvalidInput) as refusal:
        sweep(CASES[:2], tmp_path)
    assert str(refusal.value) == f"{tmp_path / 'results.csv'}: Operation not permitted"
    assert len(completed(tmp_path)) == 2
    assert not any(path.is_file() for path in tmp_path.iterdir())
    monkeypatch.undo()
    assert len(sweep(CASES[:2], tmp_path)) == 2


@pytest.mark.parametrize("name", ["", "build.json", "result.json"])
def test_a_case_that_cannot_be_kept_is_named(tmp_path, name):
    folder = Build().folder(tmp_path, CASES[0])
    if name:
        (folder / name).mkdir(parents=True)
    else:
        folder.write_text("mine")
    with pytest.raises(InvalidInput) as refusal:
        sweep(CASES[:1], tmp_path)
    assert str(refusal.value).startswith(f"{folder / name if name else folder}: ")
    assert not [path for path in tmp_path.rglob(".*")]


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_full_disk_stops_the_sweep_and_leaves_nothing_half(tmp_path, largest_file, jobs):
    sweep(CASES[:1], tmp_path)
    before = sorted(tmp_path.rglob("*"))
    with largest_file(100), pytest.raises(MachineFault) as fault:
        sweep(CASES, tmp_path, jobs=jobs)
    assert "File too large" in str(fault.value)
    if jobs == 1:
        # the first case that could not be kept, not the table after all of them
        assert str(fault.value).startswith(f"{Build().folder(tmp_path, CASES[1])}/")
    assert [path for path in sorted(tmp_path.rglob("*")) if path.is_file()] == [
        path for path in before if path.is_file()
    ]
    assert len(sweep(CASES, tmp_path)) == len(rows(tmp_path)) == len(CASES)


def test_two_sweeps_at_once_fill_one_table(tmp_path):
    build = Build()
    table = _Table(tmp_path, build)
    # what another sweep makes after this one has begun
    theirs = sweep(CASES[:2], tmp_path)
    ours = [_attempt(tmp_path, build, case).result for case in CASES[2:4]]
    for case, result in zip(CASES[2:4], ours, strict=True):
        table.add(case, result)
    table.write()
    assert sorted(float(row["dispersion_ratio"]) for row in rows(tmp_path)) == sorted(
        result.dispersion_ratio for result in (*theirs, *ours)
    )


def test_one_sweep_takes_what_another_has_made_meanwhile(tmp_path):
    (theirs,) = sweep(CASES[:1], tmp_path)
    assert _attempt(tmp_path, Build(), CASES[0]).result == theirs


def test_several_sweeps_as_processes_fill_one_table(tmp_path):
    names = [("figure4",), ("figure5",), ("figure4", "--jobs", "2")]
    commands = [[sys.executable, "-m", "dustdetach", "sweep", *name, "--out", "out"] for name in names]
    processes = [subprocess.Popen(words, cwd=tmp_path, stderr=subprocess.DEVNULL) for words in commands]
    assert [process.wait(600) for process in processes] == [0, 0, 0]
    cases = {*figure4(), *figure5()}
    assert len(rows(tmp_path / "out")) == len(completed(tmp_path / "out")) == len(cases)
    assert not list((tmp_path / "out").rglob(".*"))


SCRIPT = """
from dustdetach import Impact, sweep
{guard}
    print(len(sweep([Impact(speed=float(speed)) for speed in (2, 3, 4)], "out", jobs=2)))
"""


def test_a_script_without_a_guard_is_told_so(tmp_path, command):
    (tmp_path / "script.py").write_text(SCRIPT.format(guard="if True:"))
    process = command(program=["script.py"])
    assert process.returncode == 1
    assert process.stderr.splitlines()[-1].startswith("dustdetach.errors.InvalidInput: --jobs: ")
    assert "a call under if __name__ == '__main__':" in process.stderr
    # and nothing from the processes that came to the same call
    assert process.stderr.count("Traceback") == 1
    assert not (tmp_path / "out").exists()


def test_a_script_with_a_guard_runs(tmp_path, command):
    (tmp_path / "script.py").write_text(SCRIPT.format(guard="if __name__ == '__main__':"))
    process = command(program=["script.py"])
    assert (process.returncode, process.stdout, process.stderr) == (0, "3\n", "")
