"""Records survive the trip through JSON and CSV."""

from dataclasses import replace

from dustdetach import Result, read_csv, run
from dustdetach.impact import Impact
from dustdetach.result import write_csv


def test_there_and_back(tmp_path):
    result = run(Impact(speed=3.0))
    resolved = replace(result, method="resolved", normal=None, tangential_mode=None)
    assert Result.from_json(result.to_json()) == result
    write_csv(tmp_path / "results.csv", [result, resolved])
    assert read_csv(tmp_path / "results.csv") == [result, resolved]
    assert [path.name for path in tmp_path.iterdir()] == ["results.csv"]
