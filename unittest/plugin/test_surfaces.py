"""Walls of triangles, read from STL files: fix surface/global and surface/local with the package's damping, in a stock
LAMMPS with the plugin, which has no GRANSURF of its own, and compiled in.

Runs the programs of one build: DUST_BUILD_DIR (set by ./bootstrap test), or build/ of this checkout.
"""

import math
import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
PLUGIN = BUILD / "plugin/dustplugin.so"
PROGRAMS = ["lmp", "lmp-dust"]
SOURCE = Path(re.findall(r"^LAMMPS_SOURCE_DIR:PATH=(.*)", (BUILD / "CMakeCache.txt").read_text(), re.M)[0])
OLD = not (SOURCE / "src/GRANSURF").is_dir()

Point = tuple[float, float, float]

STEEL = "hertz/material 210e9 0.7 0.3 tangential mindlin NULL 0.0 0.05 damping coeff_restitution/limited"
DUST = "fix dust carriers dust/detach texture monolayer 20e-6 coverage 0.2 seed 1"
PLACES = [(2e-3, -2e-3), (1e-3, 1e-3), (5e-3, 5e-3)]  # middle of a triangle, shared edge, free corner
IMPACTS = [(2, 90), (8, 90), (8, 60), (12, 30)]  # m/s, degrees


def write_stl(path: Path, triangles: list[tuple[Point, Point, Point]]) -> None:
    """An ASCII STL file; normals follow from the order of the corners."""
    lines = ["solid surface"]
    for corners in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {:.17g} {:.17g} {:.17g}".format(*corner) for corner in corners]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid surface"]) + "\n")


def square(size: float) -> list[tuple[Point, Point, Point]]:
    """Two triangles in the plane z = 0 that share the diagonal x = y."""
    a, b, c, d = (-size, -size, 0.0), (size, -size, 0.0), (size, size, 0.0), (-size, size, 0.0)
    return [(a, b, c), (a, c, d)]


def impact(wall: str, place: tuple[float, float], velocity: Point, drift: Point | None = None) -> str:
    """A carrier above `place` that meets a wall at z = 0: plane, global or local. With a drift, all of it moves so.

    Prints one line: RESULT, dispersion ratio, detached on the north, velocity less the drift, after 6000 steps.
    """
    d = drift or (0.0, 0.0, 0.0)
    linear = "linear {:.17g} {:.17g} {:.17g}".format(*d)
    moving = {
        "plane": "",
        "global": "fix_modify wall move 1 rotate 0 0 0 0 0 1 1",
        "local": f"fix drift surface move {linear}",
    }
    styles = {
        "plane": f"""pair_style granular
pair_coeff * * {STEEL}
fix wall all wall/gran granular {STEEL} zplane 0.0 NULL""",
        "global": f"""pair_style granular
pair_coeff * * {STEEL}
fix wall all surface/global input stl 1 1 square.stl model * * granular {STEEL}""",
        "local": f"""fix surface all surface/local input stl 2 1 square.stl
pair_style hybrid granular surf/granular
pair_coeff 1 1 granular {STEEL}
pair_coeff 1 2 surf/granular {STEEL}
pair_coeff 2 2 none
neigh_modify exclude type 2 2""",
    }
    local = wall == "local"
    return f"""
clear
plugin load {{plugin}}
units si
atom_style {"hybrid sphere tri" if local else "sphere"}
atom_modify map array
boundary p p f
newton {"on" if local else "off"}
comm_modify vel yes
region box block -0.01 0.01 -0.01 0.01 -0.004 0.01
create_box 2 box
create_atoms 1 single {place[0]:.17g} {place[1]:.17g} 0.7501e-3
set group all diameter 1.5e-3
set group all density 7700
group carriers id 1
velocity carriers set {velocity[0] + d[0]:.17g} {velocity[1] + d[1]:.17g} {velocity[2] + d[2]:.17g}
neighbor 3e-4 bin
timestep 1e-9
{styles[wall]}
fix move carriers nve/sphere
{"group surface subtract all carriers" if local else ""}
{moving[wall] if drift else ""}
{DUST}
run 6000 post no
print "RESULT $(f_dust:%.17g) $(f_dust[6]:%.17g) $(vx[1]-{d[0]}:%.17g) $(vy[1]-{d[1]}:%.17g) $(vz[1]-{d[2]}:%.17g)"
"""


def velocity(speed: float, angle: float) -> tuple[float, float, float]:
    """Towards the middle of the square, along its diagonal: the contact stays on the surface."""
    along = -speed * math.cos(math.radians(angle)) / math.sqrt(2)
    return along, along, -speed * math.sin(math.radians(angle))


def run(program: str, deck: str, folder: Path) -> str:
    write_stl(folder / "square.stl", square(5e-3))
    (folder / "in.surface").write_text(deck.replace("{plugin}", str(PLUGIN)))
    command = [BUILD / "bin" / program, "-in", "in.surface", "-log", "none"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300).stdout


def results(said: str) -> list[list[float]]:
    return [[float(word) for word in line.split()[1:]] for line in said.splitlines() if line.startswith("RESULT")]


@pytest.fixture(scope="module")
def plane(tmp_path_factory):
    """Ratio, north and velocity of each impact on a plane."""
    deck = "".join(impact("plane", (0.0, 0.0), velocity(*how)) for how in IMPACTS)
    found = results(run("lmp-dust", deck, tmp_path_factory.mktemp("plane")))
    assert len(found) == len(IMPACTS)
    assert all(0.2 < row[0] < 0.9 for row in found)
    return found


needs_surfaces = pytest.mark.skipif(OLD, reason="LAMMPS 4Feb2025 has no GRANSURF")


def assert_as(plane: list[list[float]], found: list[list[float]], places: int) -> None:
    assert len(found) == places * len(IMPACTS)
    for row, expected in zip(found, places * plane, strict=True):
        assert row[:2] == expected[:2]  # the same grains
        assert row[2:] == pytest.approx(expected[2:], abs=1e-6)


@needs_surfaces
@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize("wall", ["global", "local"])
def test_two_triangles_are_the_plane(tmp_path, plane, program, wall):
    deck = "".join(impact(wall, place, velocity(*how)) for place in PLACES for how in IMPACTS)
    assert_as(plane, results(run(program, deck, tmp_path)), len(PLACES))


@needs_surfaces
@pytest.mark.parametrize("program", PROGRAMS)
def test_what_moves_with_its_surface_loses_the_same(tmp_path, plane, program):
    deck = "".join(impact("local", place, velocity(*how), (3.0, -2.0, 5.0)) for place in PLACES for how in IMPACTS)
    assert_as(plane, results(run(program, deck, tmp_path)), len(PLACES))


def with_wall(words: str, dust: str = DUST, more: str = "") -> str:
    """The impact on a surface/global whose model is changed, or the words of fix dust/detach, or lines before it."""
    deck = impact("global", PLACES[0], velocity(8, 90))
    return deck.replace(f"model * * granular {STEEL}", words).replace(DUST, f"{more}\n{dust}")


def warnings(said: str) -> list[str]:
    return [line for line in said.splitlines() if line.startswith("WARNING: Fix dust/detach")]


def error(said: str) -> str:
    return next((line for line in said.splitlines() if line.startswith("ERROR")), "")


@needs_surfaces
@pytest.mark.parametrize(
    "damping, modulus, words",
    [
        ("coeff_restitution/limited", "210e9", ""),
        ("coeff_restitution/limited", "210e7", "fix wall is 100 times softer.*stiffen 100"),
        ("tsuji", "210e9", "pulls carrier 1 back.*fix wall .damping tsuji"),
    ],
)
def test_the_model_of_a_surface_is_read(tmp_path, damping, modulus, words):
    model = STEEL.replace("210e9", modulus).replace("coeff_restitution/limited", damping)
    said = run("lmp-dust", with_wall(f"model * * granular {model}"), tmp_path)
    assert results(said), said[-1000:]
    found = warnings(said)
    if words:
        assert len(found) == 1
        assert re.search(words, found[0])
    else:
        assert found == []


@needs_surfaces
@pytest.mark.parametrize("pull", ["global", "local"])
def test_models_of_hybrids_are_read(tmp_path, pull):
    """The pair style of triangles, as part of a hybrid, among others that are right."""
    deck = impact("local", PLACES[0], velocity(8, 90))
    bad = STEEL.replace("coeff_restitution/limited", "tsuji")
    which = "pair_coeff 1 2 surf/granular" if pull == "local" else "pair_coeff 1 1 granular"
    said = run("lmp-dust", deck.replace(f"{which} {STEEL}", f"{which} {bad}"), tmp_path)
    found = warnings(said)
    if pull == "local":
        assert len(found) == 1
        assert "pair_coeff 1 2 (damping tsuji)" in found[0]
    else:
        assert found == []  # no carrier touches another
    assert len(results(said)) == 1


@needs_surfaces
def test_stiffen_holds_for_surfaces(tmp_path, plane):
    soft = STEEL.replace("210e9", "210e7")
    deck = with_wall(f"model * * granular {soft}", f"{DUST} stiffen 100").replace(
        f"pair_coeff * * {STEEL}", f"pair_coeff * * {soft}"
    )
    said = run("lmp-dust", deck.replace("run 6000", "run 40000"), tmp_path)
    assert warnings(said) == []
    assert results(said)[0][0] == pytest.approx(plane[1][0], abs=1e-3)


WALL = "fix wall all surface/global input stl 1 1 square.stl model * * granular " + STEEL


@needs_surfaces
@pytest.mark.parametrize(
    "deck, words",
    [
        (
            with_wall(f"model 1 * granular {STEEL} model 2 * granular {STEEL}"),
            r"Fix wall \(surface/global\) has 2 models",
        ),
        (
            impact("global", PLACES[0], velocity(8, 90)).replace(WALL, "").replace(DUST, f"{DUST}\n{WALL}"),
            r"Fix wall \(surface/global\) must stand before fix dust",
        ),
        (
            impact("local", PLACES[0], velocity(8, 90)).replace("fix dust carriers", "fix dust all"),
            "carriers must be spheres, and atom 2 is a triangle or line",
        ),
        (impact("global", PLACES[0], velocity(8, 90), (0.0, 0.0, 1.0)), "is moved by fix_modify"),
        (with_wall(f"model * * granular {STEEL}", f"{DUST} emit 2"), r"emit 2 does not know the surfaces of fix wall"),
        (
            with_wall("model * * granular jkr/vdw 1e11 1 0.3 1e-19 4e-10 tangential linear_nohistory 1 0.3"),
            "beyond contact",
        ),
    ],
    ids=["models", "order", "triangles", "moved", "emit", "adhesion"],
)
def test_what_is_refused(tmp_path, deck, words):
    said = run("lmp", deck, tmp_path)
    assert re.search(words, error(said)), said[-1500:]


@pytest.mark.skipif(not OLD, reason="this LAMMPS has GRANSURF")
@pytest.mark.parametrize("program", PROGRAMS)
def test_a_lammps_without_surfaces_says_so(tmp_path, program):
    said = run(program, impact("global", PLACES[0], velocity(8, 90)), tmp_path)
    assert "Fix surface/global needs LAMMPS 4 Jul 2026 or later with its package GRANSURF" in error(said)
