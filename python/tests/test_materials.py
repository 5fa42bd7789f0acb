"""Materials: names and numbers, what an impact makes of them, an impact of unlike ones by a deck written by hand."""

import json
from dataclasses import replace

import pytest

from dustdetach import Impact, InvalidInput, run
from dustdetach.impact import combined_modulus
from dustdetach.materials import PROPERTIES, _own, find_material, materials, use_materials
from dustdetach.session import lammps_session

GLASS_ON_STEEL = (
    *("--carrier", "glass", "--carrier-diameter", "2e-3", "--grain", "limestone", "--grain-diameter", "10e-6"),
    *("--coverage", "0.15", "--wall", "steel", "--speed", "5", "--angle", "45"),
)

# written by hand for 2 mm glass beads with 10 um limestone at 15 % coverage, 5 m/s at 45 degrees on steel; the wall's
# one material has the E* and G* of glass and steel
DECK = """
units si
atom_style sphere
boundary m f f
newton off
comm_modify vel yes
region box block -0.004 0.008 -0.002 0.002 -0.001 0.006
create_box 1 box
variable vz equal -5.0*sin(45*PI/180)
variable start equal 0.5*2e-3-5*v_vz*1e-9
create_atoms 1 single 0.0 0.0 ${{start}}
set group all diameter 2e-3 density 2500
velocity all set $(5.0*cos(45*PI/180)) 0.0 ${{vz}}
timestep 1e-9
neighbor 2e-4 bin
pair_style granular
pair_coeff * * hertz/material 70e9 0.7 0.2 tangential mindlin NULL 0.0 0.05 damping coeff_restitution/limited
fix move all nve/sphere
fix wall all wall/gran granular hertz/material {modulus:.17g} 0.7 {poisson:.17g} tangential mindlin NULL 0.0 0.05 &
  damping coeff_restitution/limited zplane 0.0 NULL
fix dust all dust/detach texture monolayer 10e-6 coverage 0.15 seed 1 density 2700 hamaker 8.1025e-20 0.4e-9 &
  elastic 75e9 0.3 70e9 0.2 friction 0.3 every 100 damping 1.0
variable finished equal f_dust[9]
fix stop all halt 100 v_finished > 0 error continue message no
thermo_modify norm no
run 20000
"""


@pytest.fixture(autouse=True)
def _library_alone():
    """What a test adds to the materials is gone after it."""
    yield
    _own.clear()


def one_material_for(modulus, poisson, other_modulus, other_poisson):
    """Modulus and Poisson's ratio of a body whose contact with its like has the E* and G* of two materials, by hand."""
    normal = 1 / ((1 - poisson**2) / modulus + (1 - other_poisson**2) / other_modulus)
    shear = 1 / (
        2 * (2 - poisson) * (1 + poisson) / modulus + 2 * (2 - other_poisson) * (1 + other_poisson) / other_modulus
    )
    ratio = 2 * shear / normal
    nu = (1 - 2 * ratio) / (1 - ratio)
    one = 2 * (1 - nu**2) * normal
    # back: G* = E/(4 (2 - nu)(1 + nu))
    assert one / (4 * (2 - nu) * (1 + nu)) == pytest.approx(shear, rel=1e-12)
    return one, nu


def test_glass_beads_on_steel_are_the_deck_written_by_hand(command):
    printed = json.loads(command("impact", *GLASS_ON_STEEL, "--timestep", "1e-9", "--json").stdout)
    modulus, poisson = one_material_for(70e9, 0.2, 210e9, 0.3)
    with lammps_session() as lmp:
        lmp.commands_string(DECK.format(modulus=modulus, poisson=poisson))
        ratio = lmp.extract_fix("dust", 0, 0)
        time, peak = lmp.numpy.extract_fix("dust", 1, 2)[0, 3:5]
        rebound = lmp.numpy.extract_atom("v")[0, 2]
    assert printed["grains"] == 24000
    assert printed["dispersion_ratio"] == ratio == pytest.approx(0.42, abs=0.01)
    assert printed["contact_time"] == time
    # the modulus is worked out in another order: its last digit
    assert printed["peak_acceleration"] == pytest.approx(peak, rel=1e-13)
    assert printed["restitution_realised"] == pytest.approx(-rebound / (-5 * 0.5**0.5), rel=1e-12)


def test_unlike_materials_touch_as_long_as_hertz_says():
    soft = Impact(speed=5.0, carrier="glass", wall="polyethylene", restitution=1.0, timestep=1e-9)
    assert soft.contact_modulus == pytest.approx(1 / ((1 - 0.2**2) / 70e9 + (1 - 0.42**2) / 1e9))
    assert run(soft).contact_time == pytest.approx(soft.hertz_contact_time, rel=0.002)
    assert run(replace(soft, wall="glass")).contact_time < run(soft).contact_time / 2


def test_the_result_says_what_it_was_computed_with(command):
    printed = json.loads(command("impact", *GLASS_ON_STEEL, "--json").stdout)
    assert [printed[part] for part in ("carrier", "wall", "grain")] == ["glass", "steel", "limestone"]
    assert (printed["carrier_density"], printed["carrier_modulus"], printed["carrier_poisson"]) == (2500, 70e9, 0.2)
    assert (printed["wall_modulus"], printed["grain_modulus"], printed["grain_density"]) == (210e9, 75e9, 2700)
    text = command("impact", *GLASS_ON_STEEL).stdout
    assert "glass of 2 mm: 2500 kg/m3, 70 GPa, Poisson 0.2" in text
    assert "A_12 8.1025e-20 J" in text


def test_the_reference_case_is_as_before_materials():
    impact = Impact(speed=8.0)
    assert impact.hamaker == 14.633e-20
    assert (impact.carrier_density, impact.grain_density) == (7700, 2700)
    assert impact.contact_modulus == pytest.approx(210e9 / (2 * 0.91))
    assert impact.surface_energy == pytest.approx(0.016173, rel=1e-4)
    assert impact == Impact(speed=8.0, carrier="Stainless Steel", grain="calcite", hamaker=14.633e-20)


def test_what_is_not_given_follows_again():
    glass = replace(Impact(speed=8.0), carrier="glass")
    assert (glass.carrier_density, glass.hamaker) == (2500, 8.1025e-20)
    dense = replace(glass, carrier_density=2600.0)
    assert replace(dense, carrier="alumina").carrier_density == 2600
    assert replace(Impact(speed=8.0), z0=0.2e-9).surface_energy == pytest.approx(4 * Impact(speed=8.0).surface_energy)
    assert replace(Impact(speed=8.0), grain_diameter=40e-6).bare == 0.40


def test_numbers_without_a_name_are_not_called_steel():
    own = Impact(speed=8.0, carrier_density=2500.0)
    assert (own.carrier, own.carrier_modulus) == ("own numbers", 210e9)
    assert own.wall == "stainless steel"
    assert replace(own, carrier="glass").carrier == "glass"


def test_surface_energy_in_place_of_hamaker():
    sticky = Impact(speed=8.0, surface_energy=0.016173015849053504)
    assert sticky.hamaker == pytest.approx(14.633e-20)
    assert run(sticky).dispersion_ratio == run(Impact(speed=8.0)).dispersion_ratio
    assert run(replace(sticky, surface_energy=0.05)).dispersion_ratio < 0.5
    with pytest.raises(InvalidInput, match=r"--surface-energy: the adhesion is given twice"):
        Impact(speed=8.0, surface_energy=0.01, hamaker=1e-19)


def test_adhesion_to_another_wall_in_a_resolved_run():
    impact = Impact(speed=8.0, method="resolved", wall="glass")
    assert (impact.hamaker, impact.wall_hamaker) == (14.633e-20, 8.1025e-20)
    assert impact.deck_variables()["hamaker_wall"] == 8.1025e-20
    assert "hamaker_wall" not in Impact(speed=8.0, wall="glass").deck_variables()
    assert Impact(speed=8.0, method="resolved", hamaker=1e-19).wall_hamaker == 1e-19


def test_unlike_materials_resolved(resolved_impact):
    quartz = replace(resolved_impact, carrier="glass", wall="alumina", grain="quartz")
    result = run(quartz)
    assert result.restitution_realised == pytest.approx(0.7, rel=0.005)
    functions = run(replace(quartz, method="functions"))
    assert result.contact_time == pytest.approx(functions.contact_time, rel=0.01)
    assert result.peak_acceleration == pytest.approx(functions.peak_acceleration, rel=0.01)
    by_energy = run(replace(resolved_impact, surface_energy=resolved_impact.surface_energy))
    # to the last digit of the Hamaker constant, which a few grains may see
    assert by_energy.contact_time == pytest.approx(run(resolved_impact).contact_time)


def test_spin_is_that_of_the_deck_with_one(command):
    spun = run(Impact(speed=8.0, spin=2000.0, wall_friction=0.3))
    assert (round(spun.dispersion_ratio, 4), round(spun.south, 4)) == (0.714, 0.4851)
    assert run(Impact(speed=8.0, wall_friction=0.3)).dispersion_ratio != spun.dispersion_ratio
    with pytest.raises(InvalidInput, match=r"--spin: 15000 rad/s throws grains off .* below 1\.323e\+04 rad/s"):
        Impact(speed=8.0, spin=15000.0)
    with pytest.raises(InvalidInput, match=r"--spin: 5 rad/s does nothing .* allowed: 0, or --rotation"):
        Impact(speed=8.0, spin=5.0, rotation=False)


def test_shares_of_a_distribution_are_by_mass(command):
    words = ("impact", "--speed", "8", "--distribution", "lognormal", "15e-6", "1.5", "--bare", "0.4")
    printed = json.loads(command(*words, "--timestep", "1e-9", "--json").stdout)
    # what in.impact.distribution prints: by mass 0.5838, by number 6322 of 13711
    assert printed["dispersion_ratio"] == pytest.approx(0.5838, abs=5e-5)
    assert printed["north"] + printed["south"] == pytest.approx(printed["dispersion_ratio"], rel=1e-9)
    assert printed["normal"] + printed["tangential_mode"] == pytest.approx(printed["dispersion_ratio"], rel=1e-9)
    assert 0.05 < printed["north"] < 0.15
    assert (printed["distribution"], printed["distribution_spread"], printed["grain_diameter"]) == (
        *("lognormal", 1.5, 15e-6),
    )


def test_a_resolved_distribution_is_lognormal():
    lognormal = {"speed": 8.0, "method": "resolved", "distribution": "lognormal", "distribution_spread": 1.2}
    assert Impact(**lognormal, timestep=0.5e-9).deck_variables()["sigma_g"] == 1.2
    with pytest.raises(InvalidInput, match="--spread: 2 is not there in a resolved run with a distribution"):
        Impact(**lognormal, spread=2.0)
    with pytest.raises(InvalidInput, match="--distribution: rrsb is for the functions"):
        Impact(**{**lognormal, "distribution": "rrsb"})


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--carrier", "glas"), "--carrier: unknown material 'glas' (did you mean glass?); allowed: stainless steel,"),
        (("--wall", "mithril"), "--wall: unknown material 'mithril'; allowed: stainless steel, steel,"),
        (("--carrier-density", "2.7"), "--carrier-density: 2.7 is out of range; allowed: 10 to 30000 kg/m3"),
        (("--grain-modulus", "75"), "--grain-modulus: 75 is out of range; allowed: 1e+06 to 1e+13 Pa"),
        (("--wall-poisson", "0.6"), "--wall-poisson: 0.6 is out of range; allowed: above -1 and at most 0.5"),
        (("--surface-energy", "16"), "--surface-energy: 16 is out of range; allowed: above 0 and at most 10 J/m2"),
        (("--carrier", "lactose"), "--hamaker: the material lactose has no Hamaker constant; allowed: 1e-22 to"),
        (("--distribution", "rrsb", "1e-5", "x"), "--distribution: 1e-5 x: not two numbers"),
        (("--distribution", "rrsb", "nan", "3"), "--distribution: median diameter nan is out of range"),
        (("--distribution", "even", "1e-5", "3"), "--distribution: unknown choice 'even'; allowed: lognormal, rrsb"),
        (
            ("--distribution", "rrsb", "1e-5", "3", "--grain-diameter", "1e-5"),
            "--grain-diameter: the median of --distribution takes its place",
        ),
        (("--materials", "nowhere"), "--materials: nowhere: no such file"),
    ],
)
def test_wrong_materials_are_one_line(command, words, said):
    process = command("impact", "--speed", "5", *words)
    assert (process.returncode, process.stdout, process.stderr.count("\n")) == (2, "", 1)
    assert process.stderr.startswith(f"dustdetach impact: {said}")


def test_every_number_of_the_library_has_a_source_and_is_in_range():
    for material in materials():
        for key, about in PROPERTIES.items():
            value = getattr(material, key)
            if value is None:
                assert key == "hamaker"
                continue
            about.check(key, value)
            assert len(material.sources[key]) > 10, (material.name, key)
    assert find_material("CALCITE", "grain") is find_material("limestone", "grain")


def test_materials_are_shown_and_extended(command, tmp_path):
    (tmp_path / "mine.toml").write_text(
        "[granite]\ndensity = 2650\nmodulus = 60e9\npoisson = 0.25\nhamaker = {value = 9e-20, source = 'measured'}\n"
    )
    text = command("materials", "--materials", "mine.toml", "granite", "glass").stdout
    assert "granite" in text and "2650 kg/m3" in text and "measured" in text and "EN 572-1" in text
    assert "alumina" not in text
    listed = json.loads(command("materials", "--json").stdout)
    assert listed["glass"]["modulus"] == {"value": 70e9, "unit": "Pa", "source": "EN 572-1:2012"}
    words = ("impact", "--speed", "5", "--carrier", "granite", "--materials", "mine.toml", "--json")
    assert json.loads(command(*words).stdout)["carrier_density"] == 2650
    (tmp_path / "sweep.toml").write_text("speed = [4, 5]\ncarrier = ['granite', 'glass']\n")
    process = command("sweep", "sweep.toml", "--materials", "mine.toml", "--out", "out")
    assert process.returncode == 0, process.stderr
    assert (tmp_path / "out/results.csv").read_text().count("granite") == 2
    assert command("materials", "granit").returncode == 2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("granite = 3", "granite: 3 is not a material; allowed: a table [granite]"),
        ("[granite]\ndensity = 2.65", "granite: density: 2.65 is out of range; allowed: 10 to 30000 kg/m3"),
        ("[granite]\ndensity = 2650", "granite: modulus: missing; allowed: 1e+06 to 1e+13 Pa"),
        (
            "[granite]\ncolour = 'red'",
            "granite: colour: unknown key; allowed: density, modulus, poisson, hamaker, also",
        ),
        ("[granite]\nalso = 3", "granite: also: 3 is not a list of names"),
        ("[granite]\ndensity = {source = 'x'}", "granite: density: None is not a finite number"),
        ("[granite", "not TOML"),
    ],
)
def test_wrong_files_of_materials(tmp_path, text, said):
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(InvalidInput) as refusal:
        use_materials(path)
    assert str(refusal.value).startswith(f"{path}: {said}")


def test_combined_modulus():
    assert combined_modulus(210e9, 0.3, 210e9, 0.3) == pytest.approx(210e9 / (2 * 0.91))
