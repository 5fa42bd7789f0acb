"""The pair force has the bits of LAMMPS' granular models where a product and a sum can be one instruction, too: on
aarch64, by a cross compiler and an emulator (Debian's packages g++-aarch64-linux-gnu and qemu-user).

What LAMMPS has of granular models and what the fused loops have of contacts, compiled without a LAMMPS around them.
"""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
SOURCE = Path(re.findall(r"^LAMMPS_SOURCE_DIR:PATH=(.*)", (BUILD / "CMakeCache.txt").read_text(), re.M)[0]) / "src"

COMPILER, EMULATOR = "aarch64-linux-gnu-g++", "qemu-aarch64"
GRANULAR = ["granular_model", "gran_sub_mod"]
GRANULAR += [f"gran_sub_mod_{kind}" for kind in ("normal", "damping", "tangential", "rolling", "twisting", "heat")]
STYLES = [
    "gran_sub_mod_dust_normal",
    "gran_sub_mod_dust_damping",
    "gran_sub_mod_dust_rolling",
    "contact_law",
    "contact_queue",
]
CORE = ["contact_batch", "hertz_contacts", "grain_contacts", "jkr", "damping"]
CONTRACTION = "-ffp-contract=off"  # cmake/Sources.cmake

pytestmark = [
    pytest.mark.skipif(
        not (shutil.which(COMPILER) and shutil.which(EMULATOR)),
        reason="no cross compiler and emulator: apt-get install g++-aarch64-linux-gnu qemu-user",
    ),
    pytest.mark.skipif(
        "synchronized_verlet" not in (SOURCE / "GRANULAR/granular_model.h").read_text(),
        reason="synchronized_verlet came after this LAMMPS",
    ),
]


def build(folder: Path, files: list[Path], *options: str) -> list[Path]:
    """Objects of these files."""
    headers = [f'#include "{name}.h"' for name in GRANULAR[2:] + STYLES[:3]]
    (folder / "style_gran_sub_mod.h").write_text("\n".join(headers) + "\n")
    places = [folder, ROOT / "src", ROOT / "src/core", SOURCE, SOURCE / "GRANULAR", SOURCE / "STUBS"]
    command = [
        COMPILER,
        "-std=c++17",
        "-O3",
        "-DNDEBUG",
        "-DLAMMPS_SMALLBIG",
        "-w",
        *(f"-I{place}" for place in places),
    ]
    objects = [folder / f"{file.stem}.o" for file in files]
    for file, made in zip(files, objects, strict=True):
        subprocess.run([*command, *options, "-c", file, "-o", made], check=True)
    return objects


@pytest.fixture(scope="module")
def ours(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    folder = tmp_path_factory.mktemp("ours")
    files = [ROOT / f"src/{name}.cpp" for name in STYLES] + [Path(__file__).with_name("contact_by_contact.cpp")]
    core = [ROOT / f"src/core/{name}.cpp" for name in CORE]
    return build(folder, files, CONTRACTION) + build(folder, core, CONTRACTION, "-fno-math-errno", "-fno-trapping-math")


def compare(folder: Path, objects: list[Path]) -> dict[str, tuple[int, int, float]]:
    """For carriers and for grains: steps in contact, those with other bits, the largest difference of a force."""
    # what is missing are the ways of errors and of restart files
    link = [COMPILER, "-static", "-Wl,--unresolved-symbols=ignore-all", *objects, "-o", folder / "compare"]
    subprocess.run(link, check=True, capture_output=True)
    said = subprocess.run(
        [EMULATOR, folder / "compare"], check=True, capture_output=True, text=True, timeout=300
    ).stdout
    print(said)
    rows = re.findall(r"(\w+): (\d+) steps in contact, (\d+) with other bits, a force by (\S+) of it", said)
    assert [row[0] for row in rows] == ["carriers", "grains"]
    return {what: (int(steps), int(different), float(off)) for what, steps, different, off in rows}


def test_same_bits_where_nothing_is_contracted(tmp_path: Path, ours: list[Path]) -> None:
    """As the plugin and lmp-dust are compiled."""
    lammps = build(tmp_path, [SOURCE / f"GRANULAR/{name}.cpp" for name in GRANULAR], CONTRACTION)
    for steps, different, _ in compare(tmp_path, lammps + ours).values():
        assert steps > 50000
        assert different == 0


def test_a_stock_lammps_differs_in_the_last_digits(tmp_path: Path, ours: list[Path]) -> None:
    """What doc/pair_granular.rst says of it: this compiler contracts if it is not told otherwise."""
    lammps = build(tmp_path, [SOURCE / f"GRANULAR/{name}.cpp" for name in GRANULAR])
    for steps, different, off in compare(tmp_path, lammps + ours).values():
        assert different > steps // 2
        assert off < 1e-10
