"""What the doctor finds, and what it says is wrong."""

from pathlib import Path

import pytest


def test_a_sound_build(command, tmp_path):
    process = command("doctor")
    assert process.returncode == 0, process.stdout
    for words in (
        "LAMMPS version: 20",
        "MPI: Open MPI",
        "FFT: FFTW3",
        "dustplugin.so, loads",
        "libdustcore.so, loads",
        "decks: ",
    ):
        assert words in process.stdout
    assert "WRONG" not in process.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("DUSTDETACH_PLUGIN", "plugin: no plugin dustplugin.so"),
        ("DUSTDETACH_PLUGIN", "texture files: no library libdustcore.so"),
        ("DUSTDETACH_INPUTS", "decks: no deck in.impact"),
        ("PYTHONPATH", "LAMMPS: no Python module lammps"),
    ],
)
def test_what_is_missing(command, monkeypatch, name, words):
    # what PYTHONPATH does without is LAMMPS' module, not this package
    monkeypatch.setenv(name, str(Path(__file__).parents[1] / "src") if name == "PYTHONPATH" else "/nowhere")
    process = command("doctor")
    assert process.returncode == 1
    assert f"WRONG  {words}" in process.stdout


def test_a_plugin_that_is_none(command, tmp_path, monkeypatch):
    (tmp_path / "dustplugin.so").write_text("not a library")
    monkeypatch.setenv("DUSTDETACH_PLUGIN", str(tmp_path / "dustplugin.so"))
    process = command("doctor")
    assert process.returncode == 1
    assert "WRONG  plugin: the plugin " in process.stdout
    assert "does not load into LAMMPS" in process.stdout
