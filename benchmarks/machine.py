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
