"""Restart files of granular models, written by a stock LAMMPS and read with the plugin, and the reverse: each goes on
with the same bits, contacts of pairs, of planes and of regions included. Those of the package's own sub-models are in
unittest/styles/test_pair_granular_fused.cpp.

Runs the programs of one build: DUST_BUILD_DIR (set by ./bootstrap test), or build/ of this checkout.
"""

import itertools
import os
import subprocess
from pathlib import Path

import pytest

BUILD = Path(os.environ.get("DUST_BUILD_DIR", Path(__file__).parents[2] / "build"))
LMP = BUILD / "bin" / "lmp"
PROGRAMS = {
    "stock": (LMP, ""),
    "plugin": (LMP, f"plugin load {BUILD / 'plugin' / 'dustplugin.so'}"),
    "compiled in": (BUILD / "bin" / "lmp-dust", ""),
}

# LAMMPS' own sub-models, all that have a history among them
CONTACTS = {
    "hertz": "hertz/material 2e8 0.5 0.3 tangential mindlin_rescale NULL 0.5 0.3 damping tsuji rolling sds 1e3 0.1 0.2 "
    "twisting marshall",
    "jkr": "jkr 2e7 0.1 0.3 0.1 tangential linear_history 1e3 0.1 0.3 rolling sds 1e2 0.0 0.1 "
    "twisting sds 1e-3 1e-6 0.1",
}
BOX = """
units           si
atom_style      sphere
boundary        p p f
newton          off
region          box block 0 8.4e-3 0 8.4e-3 0 8.4e-3
create_box      2 box
lattice         sc 1.4e-3 origin 0.5 0.5 0.5
create_atoms    1 box
set             type 1 type/fraction 2 0.4 17
variable        size atom random(1.2e-3,1.5e-3,5)
set             group all diameter v_size
set             group all density 7700
velocity        all create 1e17 5 dist gaussian
"""
FORCES = """
comm_modify     vel yes
neighbor        2e-4 bin
timestep        1e-6
pair_style      granular
pair_coeff      * * {contact}
fix             move all nve/sphere
fix             floor all wall/gran granular {contact} zplane 0.0 8.4e-3
region          tube cylinder z 4.2e-3 4.2e-3 4.0e-3 INF INF units box
fix             tube all wall/gran/region granular {contact} region tube
"""
STATE = (
    "write_dump all custom state id x y z vx vy vz omegax omegay omegaz fx fy fz modify format float %.17g sort id\n"
)


def run(name: str, folder: Path, deck: str) -> None:
    program, first = PROGRAMS[name]
    environment = {word: value for word, value in os.environ.items() if word != "LAMMPS_PLUGIN_PATH"}
    (folder / "in.restart").write_text(f"{first}\n{deck}")
    command = [program, "-in", "in.restart", "-log", "none"]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout[-2000:]


@pytest.mark.parametrize("contact", CONTACTS)
def test_goes_on_with_the_same_bits(tmp_path: Path, contact: str) -> None:
    forces = FORCES.format(contact=CONTACTS[contact])
    written, ends = {}, {}
    for writer in PROGRAMS:
        (tmp_path / writer).mkdir()
        run(writer, tmp_path / writer, f"{BOX}{forces}run 200\nwrite_restart half\n")
        written[writer] = (tmp_path / writer / "half").read_bytes()
    assert written["plugin"] == written["stock"] == written["compiled in"]  # histories as well
    for writer, reader in itertools.product(PROGRAMS, PROGRAMS):
        folder = tmp_path / writer
        run(reader, folder, f"read_restart half\n{forces}run 200\n{STATE}")
        ends[writer, reader] = (folder / "state").read_text()
        assert ends[writer, reader] == ends["stock", "stock"], (writer, reader)

    # that they have a past: without it they would go on otherwise
    run("stock", tmp_path, f"{BOX}{forces}run 200\nwrite_data half nocoeff\n")
    run("stock", tmp_path, f"{BOX.split('region')[0]}read_data half\n{forces}run 200\n{STATE}")
    assert (tmp_path / "state").read_text().splitlines()[9:] != ends["stock", "stock"].splitlines()[9:]
