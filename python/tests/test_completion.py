"""Completion of the command in bash."""

import subprocess

import pytest

from dustdetach.cli import _parser
from dustdetach.completion import completion


def completed(folder, *words):
    """What bash offers for the last word."""
    (folder / "complete.bash").write_text(completion(_parser(), "bash"))
    script = f"""source complete.bash
COMP_WORDS=({" ".join(f"'{word}'" for word in words)}) COMP_CWORD={len(words) - 1}
_dustdetach
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
    done = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    return done.stdout.split("\n")[:-1]


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (("dustdetach", "imp"), "impact"),
        (("dustdetach", "impact", "--carrier-d"), "--carrier-density"),
        (("dustdetach", "impact", "--speed", "4", "--z"), "--z0"),
        (("dustdetach", "impact", "--tangential", "imp"), "impulse"),
        (("dustdetach", "impact", "--wall", "gla"), "glass"),
        (("dustdetach", "texture", "ma"), "make"),
        (("dustdetach", "texture", "make", "--cov"), "--coverage"),
        (("dustdetach", "plot", "compl"), "complete.bash"),
        (("dustdetach", "plot", "DIR", "--ma"), "--map"),
    ],
)
def test_bash_offers(tmp_path, words, offered):
    assert offered in completed(tmp_path, *words)


def test_the_command_prints_it(command):
    for shell in ("bash", "zsh"):
        printed = command("completion", shell).stdout
        assert "complete -o filenames -F _dustdetach dustdetach" in printed
        assert ("bashcompinit" in printed) == (shell == "zsh")
    process = command("completion", "fish")
    assert (process.returncode, process.stderr.count("\n")) == (2, 1)
    assert "'fish': unknown shell; allowed: bash, zsh" in process.stderr
