"""Records survive the trip through JSON and CSV."""

from dataclasses import replace

import pytest

from dustdetach import InvalidInput, Result, read_csv, run
from dustdetach.impact import Impact
from dustdetach.result import write_csv


def test_there_and_back(tmp_path, resolved_result):
    result = run(Impact(speed=3.0))
    resolved = resolved_result
    for record in (result, resolved):
        assert Result.from_json(record.to_json()) == record
    write_csv(tmp_path / "results.csv", [result, resolved])
    assert read_csv(tmp_path / "results.csv") == [result, resolved]
    assert [path.name for path in tmp_path.iterdir()] == ["results.csv"]


def test_records_older_than_a_parameter_have_its_default(tmp_path, resolved_result):
    path = tmp_path / "results.csv"
    write_csv(path, [replace(resolved_result, spread=2.5), resolved_result])
    header, wide, row = path.read_text().splitlines()
    column = header.split(",").index("spread")
    assert wide.split(",")[column] == "2.5"
    assert read_csv(path)[0].spread == 2.5
    lines = [line.split(",") for line in (header, row)]
    path.write_text("".join(",".join(line[:column] + line[column + 1 :]) + "\n" for line in lines))
    assert read_csv(path) == [resolved_result]
    old = resolved_result.to_json().replace('"spread": 1.0, ', "")
    assert '"spread"' not in old
    assert Result.from_json(old) == resolved_result


@pytest.fixture
def table(tmp_path, resolved_result):
    """A table of two rows, and its file."""
    path = tmp_path / "results.csv"
    write_csv(path, [resolved_result, replace(resolved_result, seed=2)])
    return path, path.read_text()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (",0.7,", ",\xff,", "not a text in UTF-8"),
        (",0.7,", ",nan,", "line 2: restitution: 'nan' is not a finite number"),
        (",0.7,", ",1e400,", "line 2: restitution: '1e400' is not a finite number"),
        pytest.param(",0.7,", "," + "1" * 5000 + ",", "line 2: restitution: '11111", id="5000 digits"),
        pytest.param(",0.7,", "," + "1" * 200_000 + ",", "line 2: field larger than field limit", id="200000 digits"),
        pytest.param(",45,", "," + "1" * 5000 + ",", "line 2: grains: '11111", id="5000 digits of a whole number"),
        (",45,", ",45.5,", "line 2: grains: '45.5' is not a whole number"),
        (",True,", ",yes,", "line 2: rotation: 'yes' is not True or False"),
        (",True,", ",True,True,", "line 2: more fields than columns"),
        (",True,", ",True\n", "line 2: grains: the line is cut"),
        (",True,", ',"True', "line 3: rotation: 'True45"),
        (",True,", ",Tr\0ue,", "line 2: rotation: 'Tr\\x00ue' is not True or False"),
    ],
)
def test_broken_tables_are_named_with_their_line(table, old, new, words):
    path, text = table
    assert old in text
    path.write_bytes(text.replace(old, new, 1).encode("latin-1"))
    with pytest.raises(InvalidInput) as refusal:
        read_csv(path)
    message = str(refusal.value)
    assert message.startswith(f"{path}: ")
    assert words in message
    assert len(message) < 400


@pytest.mark.parametrize("name", ["folder", "loop", "nowhere"])
def test_tables_that_are_none(tmp_path, name):
    (tmp_path / "folder").mkdir()
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(InvalidInput) as refusal:
        read_csv(str(tmp_path / name))
    assert str(refusal.value).startswith(f"{tmp_path / name}: ")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("{", "", "cut, or no JSON"),
        pytest.param("{", "[" * 5000, "cut, or no JSON", id="nested 5000 deep"),
        pytest.param('"speed": ', '"speed": ' + "1" * 5000 + ', "slow": ', "cut, or no JSON", id="5000 digits"),
        pytest.param('"speed": ', '"speed": ' + "1" * 400 + ', "slow": ', "speed: 11111", id="400 digits"),
        ('"speed": ', '"speed": NaN, "slow": ', "speed: nan is not of the type float"),
        ('"speed": ', '"sped": ', "no key speed"),
        ('"rotation": true', '"rotation": 1', "rotation: 1 is not of the type bool"),
        ('"grains": 45', '"grains": true', "grains: True is not of the type int"),
        ('"grains": 45', '"grains": 45.0', "grains: 45.0 is not of the type int"),
        ('"method": "resolved"', '"method": null', "method: None is not of the type str"),
        ('"north": ', '"north": null, "n": ', "north: None is not of the type float"),
    ],
)
def test_broken_records_are_named(resolved_result, old, new, words):
    text = resolved_result.to_json()
    assert old in text
    assert Result.from_json(text) == resolved_result
    with pytest.raises(InvalidInput) as refusal:
        Result.from_json(text.replace(old, new, 1))
    assert str(refusal.value).startswith("not a result: ")
    assert words in str(refusal.value)
    for length in (0, 1, len(text) // 2, len(text) - 1):
        with pytest.raises(InvalidInput, match="cut, or no JSON"):
            Result.from_json(text[:length])


def test_what_a_resolved_run_does_not_know_is_empty(tmp_path, resolved_result):
    write_csv(tmp_path / "results.csv", [resolved_result])
    names, values = (line.split(",") for line in (tmp_path / "results.csv").read_text().splitlines())
    row = dict(zip(names, values, strict=True))
    assert [name for name, value in row.items() if value == ""] == ["normal", "tangential_mode", "knocked"]


def test_an_empty_field_is_wrong_elsewhere(tmp_path, resolved_result):
    write_csv(tmp_path / "results.csv", [replace(resolved_result, north=None)])
    with pytest.raises(InvalidInput, match="line 2"):
        read_csv(tmp_path / "results.csv")
