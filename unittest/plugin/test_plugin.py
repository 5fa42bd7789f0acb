"""The plugin in a stock LAMMPS: loaded, loaded again, refused, and equal to the package compiled in.

Runs the programs of one build: DUST_BUILD_DIR (set by ./bootstrap test), or build/ of this checkout.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
LMP = BUILD / "bin" / "lmp"
LMP_DUST = BUILD / "bin" / "lmp-dust"
PLUGIN = BUILD / "plugin" / "dustplugin.so"
PREFIX = LMP.resolve().parents[1]
SURFACES = (
    Path(re.findall(r"^LAMMPS_SOURCE_DIR:PATH=(.*)", (BUILD / "CMakeCache.txt").read_text(), re.M)[0]) / "src/GRANSURF"
).is_dir()  # of triangles: since 4Jul2026
DECKS = sorted(deck for deck in (ROOT / "lammps-inputs").glob("in.*") if SURFACES or deck.name != "in.chute")

# two spheres that touch and bounce on a wall: pair and wall contacts with the damping, oblique
DECK = """
units           si
atom_style      sphere
boundary        p p f
newton          off
comm_modify     vel yes
region          box block 0 1 0 1 0 1
create_box      1 box
create_atoms    1 single 0.5 0.5 0.20
create_atoms    1 single 0.5 0.56 0.285
set             group all diameter 0.1
set             group all density 1000
velocity        all set 0.3 0.1 -1
pair_style      granular
pair_coeff      * * hertz/material 1e7 0.7 0.3 tangential mindlin NULL 1.0 0.3 &
                damping coeff_restitution/limited
fix             move all nve/sphere
{wall}
timestep        1e-5
compute         spin all erotate/sphere
thermo_style    custom step ke c_spin press
thermo_modify   format float %.17g
thermo          1000
run             30000
print           "END"
"""
PLANE = """fix wall all wall/gran granular hertz/material 1e7 0.7 0.3 tangential mindlin NULL 1.0 0.3 &
                damping coeff_restitution/limited zplane 0 NULL"""
REGION = """region floor plane 0 0 0 0 0 1
fix wall all wall/gran/region granular hertz/material 1e7 0.7 0.3 tangential mindlin NULL 1.0 0.3 &
                damping coeff_restitution/limited region floor"""


def run(program: Path, deck: str, cwd: Path, **environment: str) -> subprocess.CompletedProcess:
    env = {name: value for name, value in os.environ.items() if name != "LAMMPS_PLUGIN_PATH"}
    deck_file = cwd / "in.test"
    deck_file.write_text(deck)
    return subprocess.run(
        [program, "-in", deck_file],
        cwd=cwd,
        env=env | environment,
        capture_output=True,
        text=True,
        timeout=120,
    )


def thermo(output: str) -> list[str]:
    """The rows of the thermo output of all runs, to the last digit."""
    rows, inside = [], False
    for line in output.splitlines():
        if line.startswith("Loop time"):
            inside = False
        if inside:
            rows.append(line)
        if line.split()[:1] == ["Step"]:
            inside = True
    return rows


def in_python(script: str, cwd: Path, **environment: str) -> subprocess.CompletedProcess:
    """Run a script against LAMMPS' Python module, in a process of its own: a crash must not end the tests."""
    env = os.environ | {"PYTHONPATH": str(PREFIX / "python")} | environment
    prelude = f"""
from lammps import lammps
PLUGIN = {str(PLUGIN)!r}
def start():
    return lammps(cmdargs=["-screen", "none", "-log", "none"])
def bounce(lmp):
    lmp.commands_string({DECK.format(wall=PLANE)!r})
    v = lmp.extract_atom("v")
    return [v[i][k] for i in range(2) for k in range(3)]
"""
    return subprocess.run(
        [sys.executable, "-c", prelude + script],
        cwd=cwd,
        env=env,
        capture_output=True,
        text=True,
        timeout=120,
    )


def test_lmp_itself_tells_open_mpi_and_fftw3():
    told = subprocess.run([LMP, "-h"], capture_output=True, text=True, check=True).stdout
    assert "MPI v" in told and "Open MPI" in told
    assert re.search(r"FFT library\s*= FFTW3", told)
    for package in ("GRANULAR", "KSPACE", "PLUGIN"):
        assert package in told


@pytest.mark.parametrize("wall", [PLANE, REGION], ids=["wall/gran", "wall/gran/region"])
def test_same_numbers_as_compiled_in(tmp_path, wall):
    deck = DECK.format(wall=wall)
    with_plugin = run(LMP, f"plugin load {PLUGIN}\n" + deck, tmp_path)
    compiled_in = run(LMP_DUST, deck, tmp_path)
    assert with_plugin.returncode == 0, with_plugin.stdout
    assert compiled_in.returncode == 0, compiled_in.stdout
    rows = thermo(with_plugin.stdout)
    assert len(rows) == 31
    assert len({row.split()[1] for row in rows}) > 3, "nothing touched"
    assert rows == thermo(compiled_in.stdout)


STATE = """write_dump all custom state id x y z vx vy vz omegax omegay omegaz fx fy fz &
                modify format float %.17g sort id
"""
# resolved runs of few grains, until the carriers have left what they hit; few carriers for a short time
SHORTER = {
    "in.impact.resolved": "-var coverage 0.03 -var limit 6e-6 -var dump grains",
    "in.collision.resolved": "-var coverage 0.02 -var limit 7e-6 -var dump grains",
    "in.drum": "-var carriers 200 -var drum 20e-3 -var lifter 1e-3 -var turns 0.02 -var settle 5e-3 -var dump carriers",
    "in.drop": "-var carriers 60 -var tube 8e-3 -var settle 0.02 -var rest 2e-4 -var splash 2e-3 -var field field",
    "in.chute": "-var carriers 100 -var time 0.05 -var dump carriers",
    "in.sieve": "-var carriers 60 -var tube 10e-3 -var settle 0.02 -var splash 1e-3 -var dump carriers",
    "in.pour": "-var carriers 100 -var time 0.03 -var dump carriers",
}


@pytest.mark.parametrize("deck", DECKS, ids=lambda deck: deck.name)
def test_decks_give_the_same_numbers_in_both(tmp_path, deck):
    """To the last digit: thermo output, what the deck prints at the end, the files it writes and the last state."""
    produced = []
    for program in (LMP, LMP_DUST):
        folder = tmp_path / program.name
        folder.mkdir()
        whole = tmp_path / deck.name
        whole.write_text(deck.read_text() + "\n" + STATE)
        command = [program, "-in", whole, "-log", "none", "-var", "plugin", PLUGIN, *SHORTER.get(deck.name, "").split()]
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
        assert result.returncode == 0, result.stdout
        header = next(line.split() for line in result.stdout.splitlines() if line.split()[:1] == ["Step"])
        times = [i for i, word in enumerate(header) if word in ("CPU", "S/CPU", "Elapsed")]
        rows = [[word for i, word in enumerate(row.split()) if i not in times] for row in thermo(result.stdout)]
        files = {file.name: file.read_bytes() for file in sorted(folder.iterdir())}
        lines = result.stdout.splitlines()
        last_words = [line for line in lines if re.match("dispersion ratio|carrier|grains off", line)]
        produced.append((rows, last_words, files))
    assert len(produced[0][0]) > 1
    assert "state" in produced[0][2]
    assert produced[0] == produced[1]


@pytest.mark.parametrize(
    "deck, variable, value, range",
    [
        (deck.name, *wrong)
        for deck in DECKS
        for wrong in (
            ("speed", "0", "above 0"),
            ("angle", "91", "at most 90"),
            ("kink", "71", "0 to 70"),
            ("offset", "1", "below 1"),
            ("offset", "-0.1", "at least 0"),
            ("sigma_g", "0.9", "1"),
            ("grain_contacts", "maybe", "yes or no"),
            ("timestep", "0", "above 0"),
            ("limit", "0", "above 0"),
        )
        if re.search(rf'^if "[^"]*\${{{wrong[0]}}}', deck.read_text(), re.MULTILINE)
    ],
)
def test_decks_name_a_wrong_variable(tmp_path, deck, variable, value, range):
    command = [LMP_DUST, "-in", ROOT / "lammps-inputs" / deck, "-log", "none", "-var", variable, value]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert result.returncode == 1
    assert re.search(rf"^{variable} {re.escape(value)} must be .*{range}", result.stdout, re.MULTILINE), result.stdout
    assert not list(tmp_path.iterdir())


SIZES = "-var grain_diameter 15e-6 -var sigma_g 1.5 -var bare 0.4 -var coverage 0.01 -var limit 6e-6"


def test_resolved_impact_with_many_sizes_and_spin(tmp_path):
    """Classes by size, each with contacts of its own; friction takes 5/(2 R) of the spin for the speed it gives."""
    command = [LMP_DUST, "-in", ROOT / "lammps-inputs/in.impact.resolved", "-log", "none", *SIZES.split()]
    command += ["-var", "spin", "4000", "-var", "wall_friction", "0.3"]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, result.stdout
    assert "WARNING" not in result.stdout
    off, grains = map(int, re.search(r"^grains off: (\d+) of (\d+)", result.stdout, re.MULTILINE).groups())
    ratio = float(re.search(r"^dispersion ratio (\S+):", result.stdout, re.MULTILINE)[1])
    assert 0 < off / grains < ratio < 1  # of the mass more, as large grains leave first
    vx, spin = map(float, re.search(r"^carrier: (\S+) .* spin (\S+) rad/s", result.stdout, re.MULTILINE).groups())
    assert 0.9 < vx < 1.1  # 2/7 of 3 m/s if it just rolled on; Mindlin's spring gives some more
    assert (4000 - spin) * 0.75e-3 * 2 / 5 == pytest.approx(vx, rel=0.005)  # the grains are 0.1 % of the mass
    classes = re.findall(r"(\d+) atoms in group class\d+", result.stdout)
    assert len(classes) == 8 and sum(map(int, classes)) == grains


def test_resolved_collision_conserves_momentum(tmp_path):
    command = [LMP_DUST, "-in", ROOT / "lammps-inputs/in.collision.resolved", "-log", "none", "-var", "offset", "0.6"]
    command += ["-var", "coverage", "0.01", "-var", "limit", "7e-6", "-var", "wall_friction", "0.3"]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, result.stdout
    sums = re.search(r"^sum of all momenta in those of a carrier: (.*)", result.stdout, re.MULTILINE)[1]
    assert all(abs(float(value)) < 1e-12 for value in sums.split())  # round-off of 3000 steps
    first, second = (
        [float(word) for word in words]
        for words in re.findall(r"^carrier \d: (\S+) \S+ (\S+) m/s, spin (\S+)", result.stdout, re.MULTILINE)
    )
    # half a turn about y brings one to the other's place
    assert first == pytest.approx([-second[0], -second[1], second[2]], abs=0.01)


def test_stock_lammps_does_not_know_the_sub_model(tmp_path):
    result = run(LMP, DECK.format(wall=PLANE), tmp_path)
    assert result.returncode != 0
    assert "coeff_restitution/limited" in result.stdout


def test_plugin_list_and_no_warnings(tmp_path):
    result = run(LMP, f"plugin load {PLUGIN}\nplugin list\n", tmp_path)
    assert result.returncode == 0, result.stdout
    listed = [line.split(":")[1].strip() for line in result.stdout.splitlines() if "style plugin" in line]
    for style in (
        "pair style plugin granular",
        "fix style plugin wall/gran",
        "fix style plugin wall/gran/region",
    ):
        assert style in listed
    assert len(listed) == len(set(listed))
    assert "WARNING" not in result.stdout


@pytest.mark.parametrize("style", ["granular", "hybrid granular"])
def test_loaded_after_the_pair_style(tmp_path, style):
    """A line when it is loaded; what it says makes the styles the plugin's."""
    sub_style = "granular " if style.startswith("hybrid") else ""
    coeff = f"pair_coeff * * {sub_style}hertz/material 1e7 0.7 0.3 tangential mindlin NULL 1.0 0.3 damping "
    deck = DECK.format(wall=PLANE).replace("pair_style      granular", f"pair_style {style}")
    deck = re.sub(r"^pair_coeff.*&\n", coeff + "&\n", deck, flags=re.MULTILINE).replace("damping &", "&")
    early, late = deck.split("timestep ")
    early = early.replace("coeff_restitution/limited", "tsuji")
    load = f"plugin load {PLUGIN}\n"
    again = f"pair_style none\npair_style {style}\n{coeff}coeff_restitution/limited\n{PLANE}\n"
    result = run(LMP, early + load + again + "timestep " + late, tmp_path)
    assert result.returncode == 0, result.stdout
    warnings = [line for line in result.stdout.splitlines() if "WARNING" in line]
    assert len(warnings) == 1
    assert "loaded after pair_style granular, fix wall (wall/gran)" in warnings[0]
    assert "pair_style none" in warnings[0]
    first = run(LMP, load + deck, tmp_path)
    assert "WARNING" not in first.stdout
    assert thermo(result.stdout) == thermo(first.stdout)


def test_lmp_dust_does_not_need_the_plugin(tmp_path):
    result = run(LMP_DUST, f"plugin load {PLUGIN}\nplugin list\n", tmp_path)
    assert result.returncode == 0, result.stdout
    assert "dustplugin.so is not needed" in result.stdout
    assert "style plugin" not in result.stdout


def test_loading_twice_changes_nothing(tmp_path):
    result = run(LMP, f"plugin load {PLUGIN}\nplugin load {PLUGIN}\n" + DECK.format(wall=PLANE), tmp_path)
    once = run(LMP, f"plugin load {PLUGIN}\n" + DECK.format(wall=PLANE), tmp_path)
    assert result.returncode == 0, result.stdout
    assert thermo(result.stdout) == thermo(once.stdout)


def test_clear_and_load_again(tmp_path):
    load_and_run = f"plugin load {PLUGIN}\n" + DECK.format(wall=PLANE)
    result = run(LMP, load_and_run + "clear\n" + load_and_run, tmp_path)
    assert result.returncode == 0, result.stdout
    assert result.stdout.count("\nEND") == 2
    half = result.stdout.index("\nEND")
    assert thermo(result.stdout[:half]) == thermo(result.stdout[half:])


def test_survives_clear_where_lammps_restores_plugins(tmp_path):
    if run(LMP, "plugin restore\n", tmp_path).returncode != 0:
        pytest.skip("plugin restore came after this LAMMPS")
    deck = DECK.format(wall=PLANE)
    result = run(LMP, f"plugin load {PLUGIN}\n" + deck + "clear\nplugin restore\n" + deck, tmp_path)
    assert result.returncode == 0, result.stdout
    assert result.stdout.count("\nEND") == 2


def test_found_through_lammps_plugin_path(tmp_path):
    result = run(LMP, DECK.format(wall=PLANE), tmp_path, LAMMPS_PLUGIN_PATH=str(PLUGIN.parent))
    assert result.returncode == 0, result.stdout
    assert "Loaded 1 plugins" in result.stdout


def test_several_instances_in_one_process(tmp_path):
    result = in_python(
        """
first, second = start(), start()
for lmp in (first, second):
    lmp.command("plugin load " + PLUGIN)
expected = bounce(first)
assert bounce(second) == expected
first.close()    # on 4Feb2025 this closes the plugin for the process
second.command("clear")
second.command("plugin load " + PLUGIN)
assert bounce(second) == expected
third = start()
third.command("plugin load " + PLUGIN)
assert bounce(third) == expected
second.close()
third.close()
print("ALL EQUAL")
""",
        tmp_path,
    )
    assert "ALL EQUAL" in result.stdout, result.stderr
    assert result.returncode == 0


def assert_refused(result: subprocess.CompletedProcess, directory: Path, *words: str) -> None:
    """One clear line on screen and in the log, status 1, and the deck does not go on."""
    assert result.returncode == 1, result.stdout + result.stderr
    for text in (result.stdout, (directory / "log.lammps").read_text()):
        lines = [line for line in text.splitlines() if line.startswith("ERROR")]
        assert len(lines) == 1, text
        for word in ("dustplugin.so is not loaded", *words):
            assert word in lines[0]
    assert "END" not in result.stdout.splitlines()


@pytest.mark.parametrize(
    "front, words",
    [
        ("other_version.so", ("compiled for LAMMPS 29 Aug 2024 and this is LAMMPS",)),
        ("other_sizes.so", ("-bit", "LAMMPS_SIZES")),
    ],
)
def test_plugin_for_another_lammps_is_refused(tmp_path, front, words):
    result = run(LMP, f"plugin load {BUILD}/unittest/{front}\n" + 'print "END"\n', tmp_path)
    assert_refused(result, tmp_path, *words)


def other_builds() -> list[Path]:
    """Plugins that ./bootstrap built for another version or other sizes than this build's, if it did."""
    builds = [ROOT / "build" / name for name in (".", "4Feb2025", "bigbig", "4Feb2025/bigbig")]
    plugins = [(build / "plugin" / PLUGIN.name).resolve() for build in builds]
    return [plugin for plugin in plugins if plugin.exists() and plugin != PLUGIN.resolve()]


@pytest.mark.parametrize("other", other_builds(), ids=lambda p: p.parents[1].name)
def test_real_plugin_of_another_build_is_refused(tmp_path, other):
    result = run(LMP, f"plugin load {other}\n" + 'print "END"\n', tmp_path)
    assert_refused(result, tmp_path, "was compiled for ")


def test_refusal_is_an_exception_in_python(tmp_path):
    result = in_python(
        f"""
lmp = start()
try:
    lmp.command("plugin load {BUILD}/unittest/other_version.so")
except Exception as error:
    assert "dustplugin.so is not loaded" in str(error), error
    print("REFUSED")
lmp.command("plugin load " + PLUGIN)    # the instance is still good
bounce(lmp)
print("STILL GOOD")
""",
        tmp_path,
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.split("\n")[:2] == ["REFUSED", "STILL GOOD"]


def test_half_an_installation_is_named(tmp_path):
    """dustplugin.so copied without the file it opens."""
    lonely = tmp_path / "alone" / PLUGIN.name
    lonely.parent.mkdir()
    lonely.write_bytes(PLUGIN.read_bytes())
    result = run(LMP, f"plugin load {lonely}\n" + 'print "END"\n', tmp_path)
    assert_refused(result, tmp_path, "dust_styles.so")
