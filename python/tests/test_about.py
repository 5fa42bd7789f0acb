"""Descriptions of parameters: what derives from them, and that nothing stands in two places."""

import json
import re
from pathlib import Path

import pytest

from dustdetach import Impact
from dustdetach.about import About, option
from dustdetach.cases import json_schema
from dustdetach.documentation import TABLES
from dustdetach.parameters import ABOUT, PARAMETER_TYPES, Parameters
from dustdetach.places import find_deck
from dustdetach.result import COLUMNS, KEYS
from dustdetach.runner import DECKS


def test_every_parameter_is_an_option_a_key_a_column_and_in_the_documentation(command):
    said = command("impact", "--help").stdout
    schema = json_schema()["properties"]
    for name, about in ABOUT.items():
        # --distribution KIND X50 SPREAD has two
        assert option(name) in said or name == "distribution_spread"
        assert schema[name]["description"].startswith(about.help)
        assert name in KEYS
        assert f"``{name}``" in TABLES["parameters"]()
        assert f"        {name}: {about.help}" in Parameters.__doc__
    for key in KEYS:
        assert f"``{key}``" in TABLES["columns"]()
        assert COLUMNS[key].help


@pytest.mark.parametrize("method", ["functions", "resolved"])
def test_the_decks_take_every_variable(method):
    deck = find_deck(DECKS[method]).read_text()
    known = set(re.findall(r"^variable +(\w+) +index", deck, re.M)) | set(
        re.findall(r"is_defined\(variable,(\w+)", deck)
    )
    known |= {"distribution_spread"}
    impact = Impact(speed=8.0, method=method, distribution="lognormal", distribution_spread=1.2, timestep=0.5e-9)
    for case in (impact, Impact(speed=8.0, method=method), Impact(speed=8.0, method=method, surface_energy=0.02)):
        assert set(case.deck_variables()) <= known


@pytest.mark.parametrize("deck", ["in.impact", "in.impact.resolved", "in.impact.distribution", "in.impact.spin"])
def test_no_number_of_a_material_stands_in_a_command(deck):
    commands = [
        line for line in find_deck(deck).read_text().splitlines() if not re.match(r"variable \S+ +index|#", line)
    ]
    for number in ("7700", "2700", "210e9", "75e9", " 0.3 ", "14.633", "10.1e"):
        assert not any(number in line.split("#")[0] for line in commands), number


def test_ranges_in_words_are_those_that_are_checked():
    about = About(help="x", unit="m", above=0.0, below=2.0)
    assert about.allowed == "above 0 and below 2 m"
    for value in (0.0, 2.0):
        with pytest.raises(ValueError, match=r"--x: .* out of range; allowed: above 0 and below 2 m"):
            about.check("x", value)
    about.check("x", 1.9999)


def test_legends_have_symbol_and_unit():
    assert ABOUT["z0"].words(0.4e-9) == "$z_0$ = 0.4 nm"
    assert ABOUT["angle"].words(60.0) == r"$\alpha$ = 60°"
    assert ABOUT["rotation"].words(False) == "rotation no"
    assert ABOUT["carrier"].words("glass") == "carrier glass"
    assert ABOUT["speed"].axis == "Impact speed $v_p$ (m/s)"


def test_the_schema_is_what_the_command_prints_and_accepts_a_sweep(command):
    printed = json.loads(command("schema").stdout)
    assert printed == json_schema()
    speed = printed["properties"]["speed"]["anyOf"]
    assert speed[0] == {"type": "number", "exclusiveMinimum": 0.0, "maximum": 100.0}
    assert printed["properties"]["case"]["items"]["properties"].keys() == PARAMETER_TYPES.keys()


def test_the_documentation_page_has_the_tables():
    page = (Path(__file__).parents[2] / "doc/python.rst").read_text()
    assert re.findall(r"dust-table:: (\w+)", page) == list(TABLES)
