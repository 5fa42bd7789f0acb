"""Every example of the documentation that is a command, a file or a script of this package runs as it stands there."""

import re
import shlex
from pathlib import Path

import pytest

from dustdetach import Impact, read_cases, sweep
from dustdetach.cli import _parser
from dustdetach.materials import _own, use_materials

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "doc").glob("*.rst")), ROOT / "lammps-inputs/README.md"]

#: hours: their words are read, and not run
LONG = ("sweep figure4 --method both",)


def blocks(page, language):
    """The code blocks of a page in a language, with the indentation taken off."""
    text = page.read_text()
    found = re.findall(rf"^\.\. code-block:: {language}\n\n((?:   .*\n|\n)+)", text, re.M)
    return [re.sub(r"^   ", "", block, flags=re.M) for block in found]


def commands():
    for page in PAGES:
        for block in (*blocks(page, "sh"), page.read_text() if page.suffix == ".md" else ""):
            for line in block.replace("\\\n", " ").splitlines():
                if match := re.match(r" *(?:build/bin/)?dustdetach (.*)", line):
                    yield pytest.param(shlex.split(match[1], comments=True), id=f"{page.stem}: {match[1][:60].strip()}")


EXAMPLES = list(commands())


def test_there_are_examples():
    assert len(EXAMPLES) > 15


@pytest.fixture
def place(tmp_path):
    """What the examples' names stand for."""
    (tmp_path / "FILE.toml").write_text("speed = [4, 8]\ncoverage = 0.002\n")
    (tmp_path / "DATA.csv").write_text(
        "speed,dispersion_ratio\n3,.44\n4,.46\n5,.47\n6,.52\n7,.63\n8,.72\n9,.76\n10,.8\n12,.85\n"
    )
    return tmp_path


@pytest.mark.parametrize("words", EXAMPLES)
def test_commands(command, place, words):
    line = " ".join(words)
    if line.startswith(LONG):
        assert _parser().parse_args(words).run
        return
    if words[0] in ("plot", "report"):
        folder = words[1]
        names = [name for name in ("speed", "angle", "restitution", "carrier") if name in line] or ["speed"]
        values = {
            "speed": (4.0, 6.0, 8.0),
            "angle": (60.0, 90.0),
            "restitution": (0.5, 0.7),
            "carrier": ("glass", "steel"),
        }
        cases = [{}]
        for name in names:
            cases = [{**case, name: value} for case in cases for value in values[name]]
        sweep([Impact(**{"speed": 4.0, "coverage": 0.01, **case}) for case in cases], place / folder)
    if words[:2] in (["texture", "check"], ["texture", "draw"]):
        assert command("texture", "make", "--out", words[2]).returncode == 0
    # a minute each with all their grains
    few = ("--coverage", "0.002") if "resolved" in words and words[0] == "impact" else ()
    process = command(*words, *few)
    assert process.returncode == 0, process.stderr


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_files(page, tmp_path):
    for number, block in enumerate(blocks(page, "toml")):
        path = tmp_path / f"{number}.toml"
        path.write_text(block)
        if "density =" in block:
            assert use_materials(path)
            _own.clear()
        else:
            assert read_cases(path)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_scripts(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks(page, "python"):
        if "dustdetach" in block:
            exec(compile(block, page.name, "exec"), names)


def test_every_option_is_tested():
    tests = "\n".join(path.read_text() for path in Path(__file__).parent.glob("test_*.py"))
    missing = []

    def look(parser):
        for action in parser._actions:
            if isinstance(action.choices, dict):
                for sub in action.choices.values():
                    look(sub)
            missing.extend(
                option for option in action.option_strings if option.startswith("--") and option not in tests
            )

    look(_parser())
    # those of parameters are made from one description: test_about looks at all of them
    from dustdetach.about import option
    from dustdetach.parameters import PARAMETERS

    assert set(missing) - set(map(option, PARAMETERS)) <= {"--help"}
