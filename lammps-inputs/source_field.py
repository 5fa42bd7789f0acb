"""The dust source as a CFD code reads it: from LAMMPS' memory, window by window, through the library interface.

    . build/environment; build/venv/bin/python lammps-inputs/source_field.py [--time S] [--cell M] [-var NAME VALUE]...
    mpirun -n 2 build/venv/bin/python lammps-inputs/source_field.py

The deck in.drop sets the scene, up to the moment before the heap hits the plate. From there LAMMPS advances by one
window of fix dust/detach at a time, the coupling step of a CFD code. After each, the window's local rows, one for
each grain that has come off, give the mass and the momentum that the dust phase gains in each cell of a grid that
LAMMPS knows nothing of. At the end the field's sum is compared with what the fix has counted.
"""

import argparse
import os
import sys
from pathlib import Path

import numpy as np
from lammps import LMP_SIZE_ROWS, LMP_STYLE_GLOBAL, LMP_STYLE_LOCAL, LMP_TYPE_ARRAY, LMP_TYPE_VECTOR, lammps

DECK = Path(__file__).with_name("in.drop")
DETACHED_MASS = 6  # in the fix's vector, counted from 0
DIAMETER, POSITION, VELOCITY = 4, slice(5, 8), slice(8, 11)  # columns of its local rows
DENSITY = 2700.0  # of the grains in the deck, kg/m3


class Grid:
    """Mass (kg) and momentum (kg m/s) that have come into each cell of a grid over LAMMPS' box.

    Attributes:
        mass: (nx, ny, nz).
        momentum: (nx, ny, nz, 3).
    """

    def __init__(self, lmp: lammps, cell: float) -> None:
        low, high = np.array(lmp.extract_box()[:2])
        self.low, self.cell = low, cell
        self.shape = tuple(np.ceil((high - low) / cell).astype(int))
        self.mass = np.zeros(self.shape)
        self.momentum = np.zeros((*self.shape, 3))

    def add(self, rows: np.ndarray) -> tuple[float, np.ndarray]:
        """Put the grains of rows into their cells, those outside into the nearest; returns their mass and momentum."""
        mass = np.pi / 6 * DENSITY * rows[:, DIAMETER] ** 3
        momentum = mass[:, None] * rows[:, VELOCITY]
        cells = np.floor((rows[:, POSITION] - self.low) / self.cell).astype(int)
        cells = tuple(np.clip(cells, 0, np.array(self.shape) - 1).T)
        np.add.at(self.mass, cells, mass)
        np.add.at(self.momentum, cells, momentum)
        return mass.sum(), momentum.sum(axis=0)


def window_rows(lmp: lammps) -> np.ndarray:
    """This rank's rows (N, 11) of the last complete window: a view that the next step invalidates."""
    if lmp.extract_fix("dust", LMP_STYLE_LOCAL, LMP_SIZE_ROWS) == 0:
        return np.empty((0, 11))
    return lmp.numpy.extract_fix("dust", LMP_STYLE_LOCAL, LMP_TYPE_ARRAY)


def communicator():
    """All ranks that mpirun started, or None without mpirun."""
    if "OMPI_COMM_WORLD_SIZE" not in os.environ and "PMI_SIZE" not in os.environ:
        return None
    from mpi4py import MPI

    return MPI.COMM_WORLD


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--time", type=float, default=0.01, help="after the fall, s")
    parser.add_argument("--cell", type=float, default=5e-3, help="width of a cell, m")
    parser.add_argument("-var", nargs=2, action="append", default=[], metavar=("NAME", "VALUE"), help="for the deck")
    args = parser.parse_args()

    words = ["-log", "none", "-screen", "none", "-var", "splash", "0"]
    if plugin := os.environ.get("DUSTDETACH_PLUGIN"):
        words += ["-var", "plugin", plugin]
    for name, value in args.var:
        words += ["-var", name, value]
    comm = communicator()
    first = comm is None or comm.rank == 0
    lmp = lammps(cmdargs=words, comm=comm)
    lmp.file(str(DECK))
    every = int(lmp.extract_variable("every"))
    window = every * lmp.extract_global("dt")

    grid = Grid(lmp, args.cell)
    before = lmp.extract_fix("dust", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, nrow=DETACHED_MASS)
    for _ in range(round(args.time / window)):
        lmp.command(f"run {every} pre no post no")
        source = np.hstack(grid.add(window_rows(lmp)))
        if comm is not None:
            comm.Allreduce(source.copy(), source)
        if first and source[0] > 0:
            time = lmp.extract_global("ntimestep") * lmp.extract_global("dt")
            print(f"{time:.6f} s: {source[0]:.6e} kg, momentum {source[1]:.3e} {source[2]:.3e} {source[3]:.3e} kg m/s")
    counted = lmp.extract_fix("dust", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, nrow=DETACHED_MASS) - before

    if comm is not None:
        comm.Allreduce(grid.mass.copy(), grid.mass)
    total = grid.mass.sum()
    if first:
        cells = f"{np.count_nonzero(grid.mass)} of {grid.mass.size} cells"
        print(f"{cells} got {total:.9e} kg, the fix counted {counted:.9e} kg")
    lmp.close()
    if abs(total - counted) > 1e-12 * counted:
        sys.exit("the source field does not hold what the fix has counted")


if __name__ == "__main__":
    main()
