"""Grains on a carrier at rest in LIGGGHTS and YADE, with their own adhesive contacts, for pair_cost.py.

The grains are those of in.impact.resolved, at the same places, of the same materials, friction and pull-off force. Each
contact is the nearest that a program has: LIGGGHTS' hertz with tangential history and cohesion sjkr, without and with
rolling friction, and YADE's Hertz-Mindlin with adhesion after DMT and a rolling moment. In neither does a grain hold on
beyond the end of its overlap, so neither has a neck. Both print how many contacts there are in the end.
"""

import math
import re
import shutil
from pathlib import Path

CARRIER = (210e9, 0.3, 7700)  # Young's modulus, Poisson's ratio, density
GRAIN = (75e9, 0.3, 2700)
FRICTION = 0.3
ENERGY = 14.633e-20 / (18 * math.pi * 0.4e-9**2)  # gamma of grain and carrier, J/m2
SKIN = 20e-6

LIGGGHTS = """
units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
hard_particles yes
read_data grains.liggghts
neighbor {skin} bin
neigh_modify one 10000 page 200000 every 10 delay 0 check yes
fix young all property/global youngsModulus peratomtype {young}
fix poisson all property/global poissonsRatio peratomtype {poisson}
fix restitution all property/global coefficientRestitution peratomtypepair 2 0.7 0.1 0.1 0.1
fix friction all property/global coefficientFriction peratomtypepair 2 {friction} {friction} {friction} {friction}
fix rolling all property/global coefficientRollingFriction peratomtypepair 2 0.01 0.01 0.01 0.01
fix cohesion all property/global cohesionEnergyDensity peratomtypepair 2 0 {cohesion} {cohesion} {cohesion}
pair_style gran model hertz tangential history cohesion sjkr{rolling}
pair_coeff * *
timestep 1e-9
fix move all nve/sphere
compute touches all contact/atom
compute touching all reduce sum c_touches
thermo_style custom step ke c_touching
thermo ${{steps}}
run ${{steps}}
variable contacts equal round(c_touching/2)
print "contacts: ${{contacts}}"
"""

YADE = """
import math, os
from yade import *

materials = [
    O.materials.append(FrictMat(young=e, poisson=nu, density=rho, frictionAngle=math.atan({friction})))
    for e, nu, rho in ({carrier}, {grain})
]
for line in open("grains").read().split("radius\\n")[1].splitlines():
    kind, *place, radius = line.split()
    O.bodies.append(utils.sphere([float(x) for x in place], float(radius), material=materials[int(kind) - 1]))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist={skin} / 2),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_MindlinPhys(gamma={gamma}, betan=0.5, betas=0.5, krot={krot}, eta={eta})],
        [Law2_ScGeom_MindlinPhys_Mindlin(includeAdhesion=True, includeMoment=True)],
    ),
    NewtonIntegrator(damping=0),
]
O.dt = 1e-9
O.run({steps}, wait=True)
print("contacts:", sum(i.isReal for i in O.interactions), flush=True)
os._exit(0)  # else it asks the desktop
"""


def reduced(radius: float, carrier: float) -> tuple[float, float]:
    """E* and R* of a grain on the carrier."""
    stiffness = 1 / sum((1 - nu**2) / e for e, nu, _ in (CARRIER, GRAIN))
    return stiffness, radius * carrier / (radius + carrier)


def liggghts(folder: Path, rolling: str = "") -> list[str]:
    """The command but for its steps (``-var steps N``); reads the dump ``grains`` in the folder."""
    head, atoms = (folder / "grains").read_text().split("ITEM: ATOMS type x y z radius\n")
    box = re.findall(r"^(\S+ \S+)$", head.split("BOX BOUNDS", 1)[1], re.MULTILINE)
    rows = [line.split() for line in atoms.splitlines()]
    lines = ["grains on a carrier", "", f"{len(rows)} atoms", "2 atom types", ""]
    lines += [f"{bounds} {axis}lo {axis}hi" for bounds, axis in zip(box, "xyz", strict=True)]
    lines += ["", "Atoms", ""]
    for i, (kind, x, y, z, radius) in enumerate(rows, 1):
        density = (CARRIER if kind == "1" else GRAIN)[2]
        lines.append(f"{i} {kind} {2 * float(radius):.17g} {density} {x} {y} {z}")
    (folder / "grains.liggghts").write_text("\n".join(lines) + "\n")

    # sjkr attracts with k 2 pi R* d against 4/3 E* sqrt(R*) d^1.5: k for which that holds at most 3 pi gamma R*
    stiffness, size = reduced(float(rows[1][4]), float(rows[0][4]))
    hertz = 4 / 3 * stiffness * math.sqrt(size)
    cohesion = (27 / 4 * hertz**2 * 3 * math.pi * ENERGY * size) ** (1 / 3) / (2 * math.pi * size)
    deck = folder / f"in.liggghts{'.rolling' if rolling else ''}"
    deck.write_text(
        LIGGGHTS.format(
            skin=SKIN,
            young=f"{CARRIER[0]} {GRAIN[0]}",
            poisson=f"{CARRIER[1]} {GRAIN[1]}",
            friction=FRICTION,
            cohesion=cohesion,
            rolling=f" rolling_friction {rolling}" if rolling else "",
        )
    )
    return ["liggghts", "-in", str(deck), "-log", "none", "-var", "steps"]


def yade(folder: Path, steps: int) -> list[str]:
    """The command; reads the dump ``grains`` in the folder."""
    size = reduced(10e-6, 750e-6)[1]
    force = 3 * math.pi * ENERGY * size
    script = folder / f"rest{steps}.py"
    script.write_text(
        YADE.format(
            carrier=CARRIER,
            grain=GRAIN,
            friction=FRICTION,
            skin=SKIN,
            gamma=force / (4 * math.pi * size),  # DMT as YADE has it holds 4 pi gamma R*
            krot=4 * force * size,
            eta=0.15,
            steps=steps,
        )
    )
    return ["yade", "-n", "-j1", "-x", str(script)]


def is_there(program: str) -> bool:
    """Whether it is installed; says so if not."""
    found = shutil.which(program) is not None
    if not found:
        print(f"{program} is not installed: left out")
    return found
