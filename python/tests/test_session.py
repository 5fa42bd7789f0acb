"""LAMMPS in this process: one at a time, and what stands in its way."""

import threading

import pytest

from dustdetach import Impact, InvalidInput, run, sweep
from dustdetach.errors import LammpsBusy, MachineFault
from dustdetach.session import _check_room, lammps_file, lammps_session


def in_thread(call):
    """What a call in another thread returns or raises."""
    answer = []

    def answering():
        try:
            answer.append(call())
        except Exception as error:
            answer.append(error)

    thread = threading.Thread(target=answering)
    thread.start()
    thread.join()
    return answer[0]


@pytest.mark.parametrize(
    "call",
    [
        lambda folder: run(Impact(speed=2.0)),
        # no case has failed, and nothing is wrong with any of them
        lambda folder: sweep([Impact(speed=2.0)], folder),
    ],
)
def test_another_thread_is_refused_on_one_line_while_lammps_runs(tmp_path, call):
    with lammps_session():
        refusal = in_thread(lambda: call(tmp_path / "out"))
    assert isinstance(refusal, LammpsBusy)
    assert "one run at a time" in str(refusal)
    assert not (tmp_path / "out").exists()
    # and then it may
    assert in_thread(lambda: run(Impact(speed=2.0))).end == "rebound"


def test_a_program_with_threads_goes_on(command, tmp_path):
    script = tmp_path / "threads.py"
    script.write_text(
        "from concurrent.futures import ThreadPoolExecutor\n"
        "from dustdetach import DustError, Impact, run\n"
        "def one(speed):\n"
        "    try:\n"
        "        return run(Impact(speed=speed)).end\n"
        "    except DustError as error:\n"
        "        return str(error)\n"
        "with ThreadPoolExecutor(4) as pool:\n"
        "    print(*pool.map(one, [2.0, 3.0, 4.0, 5.0, 6.0, 7.0]), sep='\\n')\n"
        "print('after:', one(2.0))\n"
    )
    done = command(program=[script])
    assert done.returncode == 0, done.stderr
    *answers, after = done.stdout.splitlines()
    assert len(answers) == 6
    assert all(answer == "rebound" or answer.startswith("LAMMPS runs in another thread") for answer in answers)
    assert "rebound" in answers
    assert after == "after: rebound"


def test_a_refusal_leaves_lammps_free():
    with pytest.raises(InvalidInput), lammps_session() as lmp:
        lmp.command("no such command")
    with lammps_session() as lmp:
        assert lmp.version() > 0


@pytest.mark.parametrize("name", ['quo"te', "line\nbreak"])
def test_names_that_lammps_cannot_take(tmp_path, name):
    with pytest.raises(InvalidInput, match="LAMMPS takes no such name"):
        lammps_file(tmp_path / name, "events")
    assert lammps_file(tmp_path / "two words $x #", "events") == f'"{tmp_path}/two words $x #"'


def test_what_a_full_disk_refuses_is_the_machines_fault():
    with pytest.raises(MachineFault, match="No space left on device"), lammps_session() as lmp:
        lmp.command('print "No space left on device"')
        lmp.command("No space left on device")


def test_mpi_is_not_started_without_room_for_its_files(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    _check_room()
    # a name that Open MPI makes a folder of is none of its faults
    monkeypatch.setenv("TMPDIR", str(tmp_path / "new"))
    _check_room()

    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("os.posix_fallocate", fail)
    with pytest.raises(MachineFault) as fault:
        _check_room()
    assert str(fault.value).startswith(f"{tmp_path}: No space left on device: 10.5 MB of temporary files are needed")
