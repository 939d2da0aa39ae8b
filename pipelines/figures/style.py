# SPDX-License-Identifier: GPL-3.0-or-later
"""How every figure of the report looks, and how it is saved so that equal data give equal bytes."""

import json
import os
import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

from artifact import MissingArtifact

# Okabe and Ito's palette: told apart with any colour vision. Line style and marker differ as well, so a
# black and white print still tells the series apart.
BLACK, ORANGE, SKY, GREEN, BLUE, RED = "#000000", "#E69F00", "#56B4E9", "#009E73", "#0072B2", "#D55E00"
SERIES = [
    {"color": BLUE, "linestyle": "-", "marker": "o"},
    {"color": RED, "linestyle": "--", "marker": "s"},
    {"color": GREEN, "linestyle": "-.", "marker": "^"},
    {"color": ORANGE, "linestyle": ":", "marker": "D"},
    {"color": SKY, "linestyle": (0, (5, 1, 1, 1, 1, 1)), "marker": "v"},
    {"color": BLACK, "linestyle": (0, (1, 1)), "marker": "x"},
]
FIELD_COLOURS = "cividis"  # grows steadily in brightness, in colour and in grey
PAGE_WIDTH = 6.9  # inches between the margins of an A4 page

matplotlib.rcParams.update({
    "svg.hashsalt": "meltproof",
    "svg.fonttype": "path",
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 8,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.3,
    "lines.markersize": 4,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "figure.constrained_layout.use": True,
})


# The frame of a note that says, inside a figure, that a measurement is not there.
PENDING_BOX = {"boxstyle": "round,pad=0.4", "facecolor": "#f4f4f4", "edgecolor": "#999999", "linestyle": "--",
               "linewidth": 0.6}


def save(figure, output, title, caption):
    """Writes the vector graphic and, beside it, its title and caption (`.json`) for the report. An output that
    ends in .png becomes a picture of pixels without words beside it, for a page such as README.md."""
    output = Path(output)
    output.parent.mkdir(parents=True, exist_ok=True)
    partial = output.with_name(output.name + ".tmp")
    if output.suffix == ".png":
        figure.savefig(partial, format="png", dpi=130, metadata={"Software": None, "Title": title})
    else:
        figure.savefig(partial, format="svg", metadata={"Date": None, "Creator": "Meltproof", "Title": title})
        text = json.dumps({"title": title, "caption": caption}, indent=1, ensure_ascii=False) + "\n"
        words = output.with_suffix(".json.tmp")
        words.write_text(text, encoding="utf-8")
        os.replace(words, output.with_suffix(".json"))
    plt.close(figure)
    os.replace(partial, output)


def run(main):
    """Runs a figure's main(); what is missing or refused becomes one sentence and status 2."""
    try:
        main()
    except MissingArtifact as problem:
        print(f"{Path(sys.argv[0]).name}: error: {problem}", file=sys.stderr)
        sys.exit(2)
