"""Picture of the decks of carriers that are held, doc/images/held.png: runs in.centrifuge and in.shaker for several
spreads of adhesion, and draws the share of dust that each acceleration takes off.

    . build/environment; build/venv/bin/python benchmarks/held_pictures.py
"""

import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
from deck import ROOT, run
from matplotlib import pyplot as plt

SPREADS = {"1": "0.2", "1.5": "#7b3294", "2": "#c2610c", "4": "#2a7f62"}
HOLD = 1.32997e5  # pull-off force by mass of the grains, m/s2


def table(deck: str, spread: str) -> np.ndarray:
    """Rows of a deck's table: spin or amplitude, acceleration, share."""
    with tempfile.TemporaryDirectory() as folder:
        run(deck, Path(folder), spread=spread, out="table")
        return np.loadtxt(Path(folder) / "table")


def main() -> None:
    figure, panels = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained", sharey=True)
    titles = {"in.centrifuge": "centrifuge: the outer half", "in.shaker": "shaker: both sides"}
    for axes, (deck, title) in zip(panels, titles.items(), strict=True):
        for spread, colour in SPREADS.items():
            _, acceleration, share = table(deck, spread).T
            axes.plot(acceleration, share, "o-", color=colour, markersize=3, linewidth=1, label=spread)
        axes.axvline(HOLD, color="0.6", linewidth=0.8, linestyle="--")
        axes.set(xscale="log", xlabel="largest acceleration of the carriers, m/s²", title=title, ylim=(0, 1))
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("share of the dust that is off")
    panels[0].legend(title="spread of the\npull-off forces", loc="upper left")
    panels[0].annotate("median $F_c/m_d$", (HOLD, 0.62), (4, 0), textcoords="offset points", color="0.4", fontsize=8)
    figure.savefig(ROOT / "doc/images/held.png", dpi=100)


if __name__ == "__main__":
    main()
