"""Texture files, most of them odd: cut, with numbers that are none or out of range, with lines too many or too few.

As a program, with the environment of ``build/environment``: whether Python and the fix judge so many odd files alike.

    build/venv/bin/python python/tests/texture_files.py [NUMBER]
"""

import random
import sys
import tempfile
from pathlib import Path

from dustdetach import InvalidInput
from dustdetach.session import LammpsRefusal, lammps_session
from dustdetach.texture import read_texture

SMALL = """# dust texture 1
carrier_diameter 1.5e-3
bare 0.33 0 0 -1
# comment
grains 3
1 0 0 2e-5
0 1 0 2e-5

0 0 1 3e-5
end
"""

#: numbers and words that one line or another takes, or nearly takes, or that some readers take and others do not
TOKENS = (
    *("0", "1", "-1", "2", "3", "4", "0.33", "1e-3", "1.5e-3", "2e-5", "-2e-5", "3.15", "3.14159", "1.0005", "0.9995"),
    *("1.0011", "0.998", "1e-9", "1e-320", "1e308", "1e400", "-0", "+1", "+-1", "1.", ".5", "1e", "e1", "1e+0", "1E0"),
    *("0x1", "0x1p0", "inf", "-inf", "nan", "NaN", "infinity", "1_0", "1,0", "1d0", "1f", "0b1", "1e5", "100000001"),
    *("one", "end", "END", "grains", "bare", "#", "'1'", '"1"', "1;", "\u00e9", "\u0661", "\ufeff1", "\x00", "1\x00"),
)
SEPARATORS = (" ", "  ", "\t", "\x0b", "\x0c", "\u00a0", ",", "\r", "\n", "")
LINES = ("", " ", "# comment", " # comment", "end", "1 0 0 2e-5", "bare 0.33 0 0 -1", "grains 3", "\ufeff", "\x1a")


def odd_file(chance: random.Random) -> bytes:
    """`SMALL` with one or two changes."""
    lines = SMALL.split("\n")
    for _ in range(chance.choice((1, 1, 2))):
        place = chance.randrange(len(lines))
        words = lines[place].split(" ")
        kind = chance.randrange(8)
        if kind <= 2:
            words[chance.randrange(len(words))] = chance.choice(TOKENS)
            lines[place] = " ".join(words)
        elif kind == 3:
            lines[place] = chance.choice(SEPARATORS).join(words)
        elif kind == 4:
            lines[place] += chance.choice((" ", "\r", "\t", " 1", " #", chance.choice(SEPARATORS)))
        elif kind == 5:
            lines.insert(place, chance.choice(LINES))
        elif kind == 6:
            del lines[place]
            lines = lines or [""]
        else:
            lines[place] = direction(chance, lines[place])
    text = "\n".join(lines).encode()
    if chance.random() < 0.1:
        text = text[: chance.randrange(len(text) + 1)]
    if chance.random() < 0.05:
        place = chance.randrange(len(text) + 1)
        text = text[:place] + bytes([chance.randrange(256)]) + text[place:]
    return text


def direction(chance: random.Random, line: str) -> str:
    """A line of a grain, or the cap's, with a direction that is nearly of length 1, or a diameter near a limit."""
    length = 1 + chance.choice((0, 1e-12, 1e-10, 5e-4, -5e-4, 9.99e-4, 1.001e-3, -1.001e-3, 1, 1e-2))
    vector = [chance.gauss(0, 1) for _ in range(3)]
    scale = length / sum(part * part for part in vector) ** 0.5
    numbers = " ".join(f"{part * scale:.17g}" for part in vector)
    if line.startswith("bare"):
        return f"bare {chance.choice((0, 0.33, 3.14, 3.1416))} {numbers}"
    diameter = chance.choice((2e-5, 7.5e-4, 7.4999999e-4, 7.5000001e-4, 1.4e-3, 1e-300, 0))
    return f"{numbers} {diameter:.17g}"


def disagreements(number: int, seed: int = 1) -> tuple[int, list[bytes]]:
    """How many of so many odd files Python takes, and those that the fix does not judge like it."""
    chance = random.Random(seed)
    taken, others = 0, []
    with tempfile.TemporaryDirectory() as folder, lammps_session() as lmp:
        path = Path(folder) / "texture"
        lmp.commands_list(["units si", "atom_style sphere", "region box block 0 1 0 1 0 1", "create_box 1 box"])
        for _ in range(number):
            text = odd_file(chance)
            path.write_bytes(text)
            try:
                read_texture(path)
                python = ""
            except InvalidInput as refusal:
                python = str(refusal).removeprefix(f"{path}: ")
            try:
                lmp.command(f"fix dust all dust/detach texture file {path}")
                lmp.command("unfix dust")
                fix = ""
            except LammpsRefusal as refusal:
                fix = str(refusal)
            taken += not python
            # of an empty file the fix says no more than that it cannot read it
            if bool(python) != bool(fix) or (text and python not in fix):
                others.append(text)
    return taken, others


if __name__ == "__main__":
    asked = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
    good, differently = disagreements(asked)
    print(f"{asked} files, of which Python takes {good}; the fix judges {len(differently)} of them differently")
    for example in differently[:5]:
        print(example)
    raise SystemExit(bool(differently))
