"""What resolved impacts depend on besides the parameters of `dustdetach impact`: variants of in.impact.resolved.

    . build/environment; build/venv/bin/python benchmarks/influences.py [--jobs N]

Writes impacts/influences.csv; variants that are in it already are not run again. A variant is a set of the deck's
variables, or another word in the deck. Straight impacts, e 0.7, seed 1.
"""

import argparse
import re
import time
from concurrent.futures import ThreadPoolExecutor

from deck import ROOT, run
from rows import read, write

TABLE = ROOT / "benchmarks/impacts/influences.csv"
KEYS = (
    "variant",
    "speed",
    "dispersion_ratio",
    "south",
    "north",
    "end",
    "microseconds",
    "last_neck",
    "wall_seconds",
)

# name: the deck's variables, speeds
SHORT = {"limit": "20e-6"}
VARIANTS = {
    "reference": (SHORT, (8,)),
    "E of the grains / 10": ({**SHORT, "grain_modulus": "7.5e9"}, (8,)),
    "E of the grains x 2": ({**SHORT, "grain_modulus": "150e9"}, (8,)),
    "theta_crit 0.05": ({**SHORT, "theta_crit": "0.05"}, (8,)),
    "theta_crit 0.5": ({**SHORT, "theta_crit": "0.5"}, (8,)),
    "mu_f 0.1": ({**SHORT, "friction": "0.1"}, (8,)),
    "mu_f 0.6": ({**SHORT, "friction": "0.6"}, (8,)),
    "grain damping 2": ({**SHORT, "grain_damping": "2.0"}, (8,)),
    "tensile tail": ({**SHORT, "rebound": "coeff_restitution"}, (4, 5, 8)),
    "until 150 us": ({"limit": "150e-6"}, (4, 8)),
}


def row_of(variant: str, speed: int) -> dict[str, str]:
    started = time.perf_counter()
    out = run("in.impact.resolved", speed=speed, **VARIANTS[variant][0])
    end = re.search(r"^end: (\w+) after (\S+) us \(last neck (\S+),", out, re.MULTILINE)
    ratio = re.search(r"^dispersion ratio (\S+): south (\S+), north (\S+)", out, re.MULTILINE)
    seconds = f"{time.perf_counter() - started:.0f}"
    return dict(
        zip(
            KEYS,
            (variant, str(speed), *ratio.groups(), *end.groups(), seconds),
            strict=True,
        )
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    rows = read(TABLE)
    wanted = [(name, speed) for name, (_, speeds) in VARIANTS.items() for speed in speeds]
    done = {(row["variant"], int(row["speed"])) for row in rows}
    with ThreadPoolExecutor(options.jobs) as pool:
        for row in pool.map(lambda case: row_of(*case), [case for case in wanted if case not in done]):
            rows.append(row)
            print(", ".join(row.values()), flush=True)
            rows.sort(key=lambda row: wanted.index((row["variant"], int(row["speed"]))))
            write(TABLE, KEYS, rows)


if __name__ == "__main__":
    main()
