"""Sobol indices: those of an input that is all there is, of one that does nothing, and what is refused."""

import json

import pytest

from dustdetach import InvalidInput
from dustdetach.sensitivity import sensitivity

FILE = """speed = 8
coverage = 0.05
samples = 32
z0 = { uniform = [0.3e-9, 0.5e-9] }
wall_friction = { uniform = [0.05, 0.06] }
"""


def test_what_matters_and_what_does_not(command, tmp_path):
    (tmp_path / "uncertain.toml").write_text(FILE)
    process = command("sensitivity", "uncertain.toml", "--json")
    assert process.returncode == 0, process.stderr
    found = json.loads(process.stdout)
    assert found["impacts"] == 32 * 4
    assert found["total"]["z0"] > 0.9 > 0.1 > found["total"]["wall_friction"]
    assert found["first"]["z0"] == pytest.approx(1, abs=0.15)
    assert 0.5 < found["mean"] < 0.85 and 0.02 < found["deviation"] < 0.2
    assert "impacts, 0 s left" in process.stderr
    lines = command("sensitivity", "uncertain.toml").stdout.splitlines()
    assert lines[1].startswith("z0") and "total" in lines[1]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("speed = 8", "no uncertain input; allowed: keys such as z0"),
        ("speed = [4, 8]\nz0 = { uniform = [3e-10, 5e-10] }", "speed: several values; allowed: one, or a distribution"),
        ("speed = 8\nspede = 3", "spede: unknown key"),
        ("speed = 8\nz0 = { uniform = [0.3, 0.5] }", "--z0: 0."),
        ("speed = 8\nz0 = { uniform = [5e-10, 3e-10] }", "z0: uniform"),
        ("speed = 0.1\nsamples = 8\nz0 = { uniform = [3e-10, 5e-10] }", "does not vary over these inputs"),
    ],
)
def test_what_has_no_indices(tmp_path, text, said):
    path = tmp_path / "uncertain.toml"
    path.write_text(text)
    with pytest.raises(InvalidInput) as refusal:
        sensitivity(path)
    assert str(refusal.value).startswith(f"{path}: ")
    assert said in str(refusal.value)


def test_no_file(command):
    process = command("sensitivity", "nowhere.toml")
    assert (process.returncode, process.stderr.count("\n")) == (2, 1)
    assert "nowhere.toml: no such file" in process.stderr
