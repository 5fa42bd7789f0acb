"""Results as tables of pandas and Parquet: the same numbers, with units; without those packages one line says so."""

import sys

import pytest

from dustdetach import Impact, InvalidInput, PackageMissing, run, to_dataframe, write_parquet
from dustdetach.result import KEYS


@pytest.fixture(scope="module")
def results():
    return [run(Impact(speed=speed, carrier="glass")) for speed in (4.0, 8.0)]


def test_a_dataframe_has_every_column_and_its_unit(results, resolved_result):
    pytest.importorskip("pandas")
    frame = to_dataframe([*results, resolved_result])
    assert list(frame.columns) == list(KEYS)
    assert list(frame.speed) == [4, 8, 8]
    assert list(frame.carrier) == ["glass", "glass", "stainless steel"]
    assert frame.normal.isna().tolist() == [False, False, True]
    assert frame.attrs["units"]["surface_energy"] == "J/m2"
    assert "dispersion_ratio" not in frame.attrs["units"]


def test_parquet_has_units_in_its_metadata(results, resolved_result, tmp_path):
    pytest.importorskip("pyarrow")
    from pyarrow.parquet import read_table

    table = read_table(write_parquet(tmp_path / "results.parquet", [*results, resolved_result]))
    assert table.to_pylist() == [result.columns() for result in (*results, resolved_result)]
    assert table.schema.field("contact_time").metadata[b"unit"] == b"s"
    assert b"dispersion ratio" in table.schema.field("dispersion_ratio").metadata[b"description"]


def test_a_sweep_writes_parquet_beside_csv(command, tmp_path):
    pytest.importorskip("pyarrow")
    (tmp_path / "sweep.toml").write_text("speed = [4, 8]\n")
    process = command("sweep", "sweep.toml", "--out", "out", "--parquet")
    assert process.returncode == 0, process.stderr
    assert process.stdout.split() == ["out/results.csv", "out/results.parquet"]


def test_without_the_package_one_line_says_so(results, monkeypatch, tmp_path):
    for name in ("pandas", "pyarrow"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(PackageMissing, match=r"no Python package pandas; pip install 'dustdetach\[tables\]'"):
        to_dataframe(results)
    with pytest.raises(PackageMissing, match="no Python package pyarrow"):
        write_parquet(tmp_path / "t", results)
    with pytest.raises(InvalidInput, match="'x' is not a Result"):
        to_dataframe(["x"]) if monkeypatch.undo() is None else None


def test_in_a_notebook_a_result_is_short(results):
    text = results[1]._repr_html_()
    assert text.startswith("<table><tr><th>impact</th><td>8 m/s, 90 degrees")
    assert "glass of 1.5 mm" in text
    assert len(text) < 1500
