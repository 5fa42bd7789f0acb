"""Completion of the command in a shell, from its own parser."""

from __future__ import annotations

import argparse

from .materials import materials
from .parameters import ABOUT

SHELLS = ("bash", "zsh")


def completion(parser: argparse.ArgumentParser, shell: str) -> str:
    """A script that completes commands, options and the words that an option takes.

    Args:
        parser: of the command.
        shell: of `SHELLS`; zsh reads bash's by its ``bashcompinit``.
    """
    cases = []
    for words, each in _commands(parser, ()):
        options = [option for action in each._actions for option in action.option_strings if option.startswith("--")]
        names = [name for action in each._actions if isinstance(action.choices, dict) for name in action.choices]
        cases.append(f'    "{" ".join(words)}") words="{" ".join((*names, *options))}" ;;')
    head = "autoload -U +X bashcompinit && bashcompinit\n" if shell == "zsh" else ""
    lines = "\n".join(cases)
    values = "\n".join(f'    {option}) words="{" ".join(given)}" ;;' for option, given in _values().items())
    return f"""{head}_dustdetach() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" command="" words="" k
  for ((k = 1; k < COMP_CWORD; k++)); do
    case "${{COMP_WORDS[k]}}" in -*) break ;; *) command="$command ${{COMP_WORDS[k]}}" ;; esac
  done
  command="${{command# }}"
  case "$command" in
{lines}
    *) command="${{command%% *}}" ;;
  esac
  [ -n "$words" ] || case "$command" in
{lines}
  esac
  case "$before" in
{values}
  esac
  COMPREPLY=($(compgen -W "$words" -- "$word") $(compgen -f -- "$word"))
}}
complete -o filenames -F _dustdetach dustdetach
"""


def _commands(
    parser: argparse.ArgumentParser, words: tuple[str, ...]
) -> list[tuple[tuple[str, ...], argparse.ArgumentParser]]:
    """A parser and those of its commands, each with the words that lead to it."""
    found = [(words, parser)]
    for action in parser._actions:
        if isinstance(action.choices, dict):
            for name, each in action.choices.items():
                found += _commands(each, (*words, name))
    return found


def _values() -> dict[str, list[str]]:
    """The words that options take."""
    found = {f"--{name}": list(about.choices) for name, about in ABOUT.items() if about.choices}
    found |= {
        f"--{part}": [each.name.replace(" ", "\\ ") for each in materials()] for part in ("carrier", "wall", "grain")
    }
    return found
