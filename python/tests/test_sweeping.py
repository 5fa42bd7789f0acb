"""Sweeps: the table, picking up after a kill, failures, several processes and ranks."""

import csv
import errno
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace

import pytest

from dustdetach import CasesFailed, Impact, InvalidInput, MachineFault, figure4, figure5, sweep
from dustdetach.result import KEYS
from dustdetach.sweeping import Build, _Table, _work

CASES = [Impact(speed=float(speed), angle=angle) for speed in range(2, 8) for angle in (60.0, 90.0)]


#: columns that differ from run to run
SECONDS = {"loop_seconds", "wall_seconds"}


def batches(folder):
    return {path: path.stat().st_mtime_ns for path in folder.glob("[!.]*.jsonl")}


def cases_in(paths):
    return sum(len(path.read_text().splitlines()) - 1 for path in paths)


def without_seconds(folder):
    return [{key: value for key, value in row.items() if key not in SECONDS} for row in rows(folder)]


@pytest.fixture
def small_batches(monkeypatch):
    """Batches of two cases, as a slow machine makes them."""
    monkeypatch.setattr("dustdetach.sweeping.BATCH_CASES", 2)


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


def test_only_what_is_missing_is_run_again(tmp_path, small_batches):
    sweep(CASES, tmp_path)
    before = batches(tmp_path)
    assert cases_in(before) == len(CASES) == 2 * len(before)
    table = without_seconds(tmp_path)
    removed = sorted(before)[:2]
    for path in removed:
        path.unlink()
    told = []
    sweep(CASES, tmp_path, progress=lambda done, total, left: told.append((done, total)))
    after = batches(tmp_path)
    assert sorted(path for path in after if before.get(path) != after[path]) == removed
    assert told == [(done, len(CASES)) for done in range(len(CASES) - 4, len(CASES) + 1)]
    assert without_seconds(tmp_path) == table


def test_a_killed_sweep_picks_up_where_it_stopped(tmp_path, command):
    speeds = [1 + 0.005 * i for i in range(1500)]
    (tmp_path / "sweep.toml").write_text(f"speed = {speeds}\n")
    folder = tmp_path / "out"
    words = [sys.executable, "-m", "dustdetach", "sweep", "sweep.toml", "--out", "out"]
    process = subprocess.Popen(words, cwd=tmp_path, stderr=subprocess.DEVNULL, start_new_session=True)
    while len(batches(folder)) < 2:
        assert process.poll() is None
        time.sleep(0.002)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = batches(folder)
    assert len(before) >= 2
    there = cases_in(before)
    assert there < len(speeds)

    again = command("sweep", "sweep.toml", "--out", "out")
    assert again.returncode == 0, again.stderr
    assert again.stderr.startswith(f"{there}/{len(speeds)} cases")
    after = batches(folder)
    assert {path: after[path] for path in before} == before
    assert cases_in(after) == len(rows(folder)) == len(speeds)


def test_killed_at_random_it_ends_with_the_same_table(tmp_path, command):
    (tmp_path / "sweep.toml").write_text(f"speed = {[1 + 0.1 * i for i in range(150)]}\nseed = [1, 2, 3]\n")
    words = ["sweep", "sweep.toml", "--jobs", "2", "--out"]
    assert command(*words, "whole").returncode == 0
    chance = random.Random(1)
    killed = 0
    for _ in range(4):
        process = subprocess.Popen(
            [sys.executable, "-m", "dustdetach", *words, "out"],
            cwd=tmp_path,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            process.wait(chance.uniform(0.2, 2.0))
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            killed += 1
    assert killed
    assert command(*words, "out").returncode == 0
    assert without_seconds(tmp_path / "out") == without_seconds(tmp_path / "whole")
    assert not list((tmp_path / "out").glob(".*"))


def test_both_methods_in_a_folder_after_a_kill(tmp_path, command):
    (tmp_path / "sweep.toml").write_text("speed = [4, 8]\ncoverage = 0.0004\n")
    folder = tmp_path / "out"
    words = ["sweep", "sweep.toml", "--method", "both", "--out", "out"]
    process = subprocess.Popen(
        [sys.executable, "-m", "dustdetach", *words], cwd=tmp_path, stderr=subprocess.DEVNULL, start_new_session=True
    )
    # functions first; killed in the second of the resolved impacts
    while not list(folder.glob("resolved-*.jsonl")):
        assert process.poll() is None
        time.sleep(0.002)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = batches(folder)
    assert cases_in(before) == 3

    again = command(*words)
    assert again.returncode == 0, again.stderr
    assert again.stderr.startswith("3/4 cases")
    after = batches(folder)
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
    assert batches(folder) == after
    assert rows(folder) == table


def test_sweeps_of_the_same_folder_share_cases_and_the_table(figures_folder, impulse_table):
    assert len(rows(figures_folder)) == 2 * len(impulse_table) == cases_in(batches(figures_folder))


def test_results_of_another_build_are_not_taken(tmp_path, monkeypatch):
    sweep(CASES[:2], tmp_path)
    monkeypatch.setattr("dustdetach.batches.__version__", "another")
    sweep(CASES[:2], tmp_path)
    assert len(batches(tmp_path)) == 2
    assert cases_in(batches(tmp_path)) == 4
    assert len(rows(tmp_path)) == 2


def test_folders_of_a_version_without_batches_are_refused(tmp_path):
    old = tmp_path / "functions-v2-a90-e0.7-0123456789ab-01234567" / "result.json"
    old.parent.mkdir()
    old.write_text("{}")
    with pytest.raises(InvalidInput) as refusal:
        sweep(CASES, tmp_path)
    assert str(refusal.value) == (
        f"--out: {old.parent}: a folder for a case, from a version of dustdetach that is another build and whose "
        "results are not taken; allowed: a folder without, or remove all of them"
    )
    assert list(tmp_path.iterdir()) == [old.parent]


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


@pytest.mark.usefixtures("small_batches")
def test_processes_give_what_one_gives(tmp_path, impulse_table):
    for result in sweep(CASES, tmp_path, jobs=2):
        expected = impulse_table.get((result.speed, result.angle, result.restitution))
        assert expected is not None
        assert replace(result, **dict.fromkeys(SECONDS, 0.0)) == replace(expected, **dict.fromkeys(SECONDS, 0.0))


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


@pytest.mark.parametrize("how", ["empty", "cut", "short", "folder", "another"])
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_batch_that_is_none_is_named_before_any_work(tmp_path, how, jobs):
    sweep(CASES[:2], tmp_path)
    (first,) = batches(tmp_path)
    text = first.read_text()
    first.unlink()
    if how == "folder":
        first.mkdir()
    else:
        short = "".join(text.splitlines(keepends=True)[:-1])
        first.write_text({"empty": "", "cut": text[: len(text) // 2], "short": short, "another": "[1, 2]"}[how])
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}
    with pytest.raises(InvalidInput) as refusal:
        sweep(CASES, tmp_path, jobs=jobs)
    assert str(refusal.value).startswith(f"{first}: ")
    assert str(refusal.value).endswith("remove it, and its cases are run again")
    assert str(refusal.value).count(str(first)) == 1
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")} == before
    # as it says
    shutil.rmtree(first) if how == "folder" else first.unlink()
    assert len(sweep(CASES[:2], tmp_path)) == len(rows(tmp_path)) == 2


def test_a_batch_says_what_made_it(tmp_path):
    sweep(CASES[:2], tmp_path)
    (path,) = batches(tmp_path)
    head = json.loads(path.read_text().splitlines()[0])
    assert head == {"build": Build().identity["functions"], "results": 2}
    assert head["build"].keys() == {"dustdetach", "lammps", "plugin", "deck"}


def test_ranks_agree_on_a_batch_that_is_none(tmp_path, command):
    pytest.importorskip("mpi4py")
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        pytest.skip("no mpirun")
    sweep(CASES[:2], tmp_path / "out")
    (broken,) = batches(tmp_path / "out")
    broken.write_text("")
    launcher = [mpirun, "--allow-run-as-root", "--oversubscribe", "-np", "3"]
    process = command("sweep", "figure4", "--out", "out", "--executor", "mpi", launcher=launcher)
    assert process.returncode == 2
    said = [line for line in process.stderr.splitlines() if "dustdetach" in line]
    reason = "not a batch of results: cut, or another file; remove it, and its cases are run again"
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
    assert list(tmp_path.iterdir()) == list(batches(tmp_path))
    assert cases_in(batches(tmp_path)) == 2
    monkeypatch.undo()
    assert len(sweep(CASES[:2], tmp_path)) == 2


def test_a_batch_that_cannot_be_kept_is_named(tmp_path, monkeypatch):
    def refuse(part, path):
        raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))

    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(InvalidInput) as refusal:
        sweep(CASES[:1], tmp_path)
    assert str(refusal.value).startswith(f"{tmp_path}/functions-")
    assert str(refusal.value).endswith(".jsonl: Operation not permitted")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_full_disk_stops_the_sweep_and_leaves_nothing_half(tmp_path, largest_file, jobs):
    sweep(CASES[:1], tmp_path)
    before = sorted(tmp_path.rglob("*"))
    with largest_file(100), pytest.raises(MachineFault) as fault:
        sweep(CASES, tmp_path, jobs=jobs)
    assert "File too large" in str(fault.value)
    if jobs == 1:
        # the first batch that could not be kept, not the table after all of them
        assert str(fault.value).startswith(f"{tmp_path}/functions-")
    assert sorted(tmp_path.rglob("*")) == before
    assert len(sweep(CASES, tmp_path)) == len(rows(tmp_path)) == len(CASES)


def test_what_is_done_before_a_fault_is_kept(tmp_path, monkeypatch):
    from dustdetach.runner import Bench

    once, done = Bench.run, []

    def fail_at_the_third(bench, case):
        if len(done) == 2:
            raise MachineFault("no memory")
        done.append(once(bench, case))
        return done[-1]

    monkeypatch.setattr(Bench, "run", fail_at_the_third)
    with pytest.raises(MachineFault, match="no memory"):
        sweep(CASES, tmp_path)
    assert cases_in(batches(tmp_path)) == 2


def test_long_cases_are_kept_before_their_batch_is_full(tmp_path, monkeypatch):
    monkeypatch.setattr("dustdetach.sweeping.BATCH_SECONDS", 1e-9)
    for jobs in (1, 2):
        out = tmp_path / str(jobs)
        assert len(sweep(CASES, out, jobs=jobs)) == len(CASES)
        if jobs == 1:
            assert len(batches(out)) == len(CASES)


def test_two_sweeps_at_once_fill_one_table(tmp_path):
    build = Build()
    table = _Table(tmp_path, build)
    # what another sweep makes after this one has begun
    theirs = sweep(CASES[:2], tmp_path)
    ours = _work(tmp_path, build, CASES[2:4])
    table.add(ours)
    table.write()
    assert sorted(float(row["dispersion_ratio"]) for row in rows(tmp_path)) == sorted(
        result.dispersion_ratio for result in (*theirs, *ours.results)
    )


def test_one_sweep_takes_what_another_has_made_meanwhile(tmp_path):
    table = _Table(tmp_path, Build())
    theirs = sweep(CASES[:2], tmp_path)
    left, work = table.split(CASES[:3])
    assert left == CASES[2:3]
    assert work.results == theirs


def test_several_sweeps_as_processes_fill_one_table(tmp_path):
    names = [("figure4",), ("figure5",), ("figure4", "--jobs", "2")]
    commands = [[sys.executable, "-m", "dustdetach", "sweep", *name, "--out", "out"] for name in names]
    processes = [subprocess.Popen(words, cwd=tmp_path, stderr=subprocess.DEVNULL) for words in commands]
    assert [process.wait(600) for process in processes] == [0, 0, 0]
    cases = {*figure4(), *figure5()}
    assert len(rows(tmp_path / "out")) == len(cases)
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
