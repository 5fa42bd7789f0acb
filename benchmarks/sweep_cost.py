"""What sweeps cost, against another checkout: a thousand impacts, a thousand seeds, two processes, kills.

    git worktree add /tmp/before COMMIT; (cd /tmp/before; ./bootstrap build)
    . build/environment; build/venv/bin/python benchmarks/sweep_cost.py --before /tmp/before [--repeat N] [--out FILE]

Each command runs as a user starts it, and its processor time (user + system, with all processes it has started) is
taken from start to table; those of both checkouts are run in turn, and of each the median is given.

* impacts: 20 speeds, 10 angles, 5 restitutions, one texture; `same step` gives both the time step of 1 ns.
* seeds: 1,000 of one impact.
* jobs: 20,000 impacts by one process and by two (or ranks). Where there is a processor for each, the sweep takes what
  the first process takes and half of what the others do: that is the gain by processor time. The wall time and the
  machine's load are given, too; ranks that wait for each other take the processor meanwhile.
* kills: a sweep is killed (kill -9) ten times at random, and its table compared with that of one that was not.
"""

import argparse
import csv
import json
import os
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from machine import description

ROOT = Path(__file__).resolve().parent.parent
SECONDS = ("loop_seconds", "wall_seconds")


def grid(speeds: int, angles: int, restitutions: int) -> dict[str, list[float]]:
    """Speeds, angles and restitutions, evenly from 1 to 20 m/s, 15 to 90 degrees and 0.5 to 0.9."""

    def even(low: float, high: float, number: int) -> list[float]:
        return [round(low + (high - low) * k / (number - 1), 6) for k in range(number)]

    return {
        "speed": even(1, 20, speeds),
        "angle": even(15, 90, angles),
        "restitution": even(0.5, 0.9, restitutions),
    }


IMPACTS = grid(20, 10, 5)
SWEEPS: dict[str, dict] = {
    "1000 impacts": IMPACTS,
    "1000 impacts, same step": {**IMPACTS, "timestep": 1e-9},
    "1000 seeds": {"speed": 8.0, "seed": list(range(1, 1001))},
}
MANY = grid(50, 40, 10)


class Checkout:
    """A checkout that has been built, and its command."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.commit = subprocess.run(
            ["git", "-C", root, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=True
        ).stdout.strip()

    def command(self, cases: Path, out: Path, *more: str) -> list[str]:
        """The words that run a sweep."""
        return [str(self.root / "build/bin/dustdetach"), "sweep", str(cases), "--out", str(out), *more]


def write_cases(path: Path, cases: dict) -> Path:
    path.write_text("".join(f"{name} = {value}\n" for name, value in cases.items()))
    return path


def run(words: list[str]) -> tuple[float, float]:
    """Processor and wall time of a command with all it has started, s; what it writes is dropped."""
    # an environment of its own: this one's may name the plugin of one of the checkouts
    names = ("DUSTDETACH_PLUGIN", "DUSTDETACH_INPUTS", "PYTHONPATH", "DUST_BUILD_DIR")
    environment = {name: value for name, value in os.environ.items() if name not in names}
    started = time.monotonic()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.monotonic() - started
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(words)}: exit status {process.returncode}")
    return usage.ru_utime + usage.ru_stime, wall


#: runs the command and tells the processor time of its first process, s, and of those it has started
TELL = """
import json, resource, sys
from dustdetach.cli import main
if main(sys.argv[1:]) == 0:
    usages = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    print(json.dumps([usage.ru_utime + usage.ru_stime for usage in usages]))
"""


def run_and_tell(checkout: Checkout, words: list[str]) -> tuple[float, float]:
    """Processor time of a sweep's first process and of those it has started, s."""
    environment = checkout.root / "build/environment"
    python = checkout.root / "build/venv/bin/python"
    line = f". '{environment}'; exec '{python}' -c \"$0\" \"$@\""
    done = subprocess.run(["bash", "-c", line, TELL, *words[1:]], capture_output=True, text=True, check=True)
    first, others = json.loads(done.stdout.splitlines()[-1])
    return first, others


def rows(out: Path) -> list[dict[str, str]]:
    """The table of a sweep without the columns that differ from run to run."""
    with open(out / "results.csv", newline="") as stream:
        return [{key: value for key, value in row.items() if key not in SECONDS} for row in csv.DictReader(stream)]


def measure_sweeps(checkouts: dict[str, Checkout], repeat: int, work: Path) -> dict:
    """Processor seconds of each sweep by each checkout."""
    result = {}
    for name, cases in SWEEPS.items():
        toml = write_cases(work / "cases.toml", cases)
        times: dict[str, list[float]] = {which: [] for which in checkouts}
        for _ in range(repeat):
            for which, checkout in checkouts.items():
                out = work / "out"
                times[which].append(run(checkout.command(toml, out))[0])
                shutil.rmtree(out)
        result[name] = {
            "processor_seconds": {which: statistics.median(values) for which, values in times.items()},
            "all": {which: [round(value, 3) for value in values] for which, values in times.items()},
        }
        medians = result[name]["processor_seconds"]
        print(name, *(f"{which} {value:.2f} s" for which, value in medians.items()), flush=True)
    return result


def measure_jobs(checkout: Checkout, repeat: int, work: Path) -> dict:
    """One process against two, and two ranks, in 20,000 impacts."""
    toml = write_cases(work / "cases.toml", MANY)
    ways = {"one": checkout.command(toml, work / "one"), "two": checkout.command(toml, work / "two", "--jobs", "2")}
    if shutil.which("mpirun"):
        mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "2"]
        ways["ranks"] = [*mpirun, *checkout.command(toml, work / "ranks", "--executor", "mpi")]
    processor: dict[str, list[float]] = {way: [] for way in ways}
    wall: dict[str, list[float]] = {way: [] for way in ways}
    shared = []
    tables = {}
    for _ in range(repeat):
        for way, words in ways.items():
            cpu, seconds = run(words)
            processor[way].append(cpu)
            wall[way].append(seconds)
            tables[way] = rows(work / way)
            shutil.rmtree(work / way)
        first, others = run_and_tell(checkout, ways["two"])
        shutil.rmtree(work / "two")
        shared.append(first + others / 2)
    cpu = {way: statistics.median(values) for way, values in processor.items()}
    result = {
        "impacts": len(tables["one"]),
        "processor_seconds": cpu,
        "with_two_processors_free": statistics.median(shared),
        "gain_processor": cpu["one"] / statistics.median(shared),
        "wall_seconds": {way: statistics.median(values) for way, values in wall.items()},
        "load": os.getloadavg()[0],
        "same_table": all(table == tables["one"] for table in tables.values()),
    }
    print("jobs", json.dumps(result), flush=True)
    return result


def measure_kills(checkout: Checkout, work: Path, kills: int = 10) -> dict:
    """A sweep killed at random, until it has been that often, and then run to its end."""
    toml = write_cases(work / "cases.toml", {**grid(20, 15, 10), "seed": [1, 2]})
    words = checkout.command(toml, work / "killed", "--jobs", "2")
    _, whole = run(checkout.command(toml, work / "whole", "--jobs", "2"))
    chance, there, deaths = random.Random(7), [], 0
    while deaths < kills:
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(chance.uniform(0.2, 0.35 * whole))
        process.kill()
        deaths += process.wait() != 0
        lines = [path.read_text().count("\n") - 1 for path in (work / "killed").glob("[!.]*.jsonl")]
        there.append(sum(lines))
    run(words)
    same = rows(work / "killed") == rows(work / "whole")
    result = {"kills": kills, "complete_after_each": there, "impacts": len(rows(work / "whole")), "same_table": same}
    print("kills", json.dumps(result), flush=True)
    return result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", type=Path, help="another checkout that has been built")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--jobs-repeat", type=int, default=3)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    checkouts = {"now": Checkout(ROOT)}
    if args.before:
        checkouts["before"] = Checkout(args.before.resolve())
    result: dict = {
        **description(ROOT / "build/bin/lmp"),
        "python": sys.version.split()[0],
        "commits": {which: checkout.commit for which, checkout in checkouts.items()},
        "repeats": args.repeat,
    }
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        result["sweeps"] = measure_sweeps(checkouts, args.repeat, work)
        result["jobs"] = measure_jobs(checkouts["now"], args.jobs_repeat, work)
        result["kills"] = measure_kills(checkouts["now"], work)
    if args.out:
        args.out.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
