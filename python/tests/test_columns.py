"""The columns of the fix's output, in Python and in the header that the fix itself uses."""

import re
from pathlib import Path

import pytest

from dustdetach import Impact, run
from dustdetach.columns import DetachAtom, DetachRow, DetachVector, Mode

SOURCES = Path(__file__).parents[2] / "src"


def enums_of(header):
    """Names in each enum of a header, the last one apart, which counts them, by the name of the namespace around it."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", header.read_text(), flags=re.DOTALL)
    enums = re.findall(r"namespace (\w+)\s*{\s*enum\s*{([^}]*)}", text)
    return {name: [word.strip() for word in words.split(",") if word.strip()][:-1] for name, words in enums}


@pytest.mark.parametrize("enum", [DetachVector, DetachAtom, DetachRow])
def test_python_and_the_fix_name_the_same_columns(enum):
    assert [column.name for column in enum] == enums_of(SOURCES / "detach_columns.h")[enum.__name__]
    assert list(enum) == list(range(len(enum)))


def test_modes_are_those_of_the_core():
    names = re.search(r"enum Mode {([^}]*)}", (SOURCES / "core/criteria.h").read_text())[1].split(",")
    # counted from 1 in a row, so that 0 can be a grain that stays
    assert [mode.name for mode in Mode][1:] == [name.strip() for name in names][:-1]


def test_a_row_holds_what_its_columns_say(tmp_path):
    result = run(Impact(speed=8.0, angle=60.0), events=tmp_path / "events")
    rows = [
        [float(word) for word in line.split()]
        for line in (tmp_path / "events").read_text().splitlines()
        if len(line.split()) == len(DetachRow)
    ]
    assert len(rows) == round(result.dispersion_ratio * 4500)
    assert {row[DetachRow.CARRIER] for row in rows} == {1}
    assert {row[DetachRow.DIAMETER] for row in rows} == {20e-6}
    assert max(row[DetachRow.STEP] for row in rows) <= result.steps
    assert len({row[DetachRow.GRAIN] for row in rows}) == len(rows)
    by_mode = [sum(row[DetachRow.MODE] == mode for row in rows) / 4500 for mode in (Mode.NORMAL, Mode.TANGENTIAL)]
    assert by_mode == pytest.approx([result.normal, result.tangential_mode])
    # on the carrier, which has come a little way along x
    for row in rows:
        assert row[DetachRow.X] ** 2 + row[DetachRow.Y] ** 2 < (0.8e-3) ** 2
        assert 0 < row[DetachRow.Z] < 1.6e-3
