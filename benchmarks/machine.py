"""What the benchmarks ran on."""

import os
import platform
import re
import subprocess
from pathlib import Path


def processor() -> str:
    """Name of the processor."""
    cpu = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    return cpu[1] if cpu else platform.processor()


def description(lmp: Path) -> dict[str, str]:
    """Machine, version of a LAMMPS program and how it was compiled."""
    version = (
        subprocess.run([lmp, "-h"], capture_output=True, text=True, check=True).stdout.splitlines()[1].split(" - ")[1]
    )
    return {
        "machine": f"{processor()}, {os.cpu_count()} cores",
        "lammps": version,
        "compiler": "Release, as ./bootstrap build",
    }


def instructions(command: list[str], folder: Path, *functions: str) -> list[int]:
    """Instructions of a command, by valgrind, within functions and what they call.

    Args:
        command: the program and its words.
        folder: where it runs.
        functions: regular expressions, the first line of each counts.
    """
    out = folder / "callgrind.out"
    subprocess.run(
        ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", *command],
        capture_output=True,
        check=True,
        cwd=folder,
    )
    table = subprocess.run(
        ["callgrind_annotate", "--inclusive=yes", "--threshold=100", str(out)],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    lines = [re.search(rf"^ *([\d,]+) .*{function}", table, re.MULTILINE) for function in functions]
    return [int(line[1].replace(",", "")) for line in lines]
