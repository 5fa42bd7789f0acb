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


def test_what_a_resolved_run_does_not_know_is_empty(tmp_path, resolved_result):
    write_csv(tmp_path / "results.csv", [resolved_result])
    names, values = (line.split(",") for line in (tmp_path / "results.csv").read_text().splitlines())
    row = dict(zip(names, values, strict=True))
    assert [name for name, value in row.items() if value == ""] == ["normal", "tangential_mode"]


def test_an_empty_field_is_wrong_elsewhere(tmp_path, resolved_result):
    write_csv(tmp_path / "results.csv", [replace(resolved_result, north=None)])
    with pytest.raises(InvalidInput, match="line 2"):
        read_csv(tmp_path / "results.csv")
