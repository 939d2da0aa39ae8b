# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels in which verification cases are shown, profile and error against the spacing, and figures of them."""

import argparse
import textwrap
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import style
from artifact import MissingArtifact, column, read_json, read_table, value


def load_cases(path, wanted, key="name"):
    """The cases of verification.json whose name, or other key, holds one of the words in `wanted`."""
    cases = [case for case in value(read_json(path), "cases", path)
             if any(word in value(case, key, path) for word in wanted)]
    if not cases:
        raise MissingArtifact(f"{path} holds no case named like {' or '.join(wanted)}; run `make verify`.")
    return cases


def profile_path(case, verification):
    """`profile_csv` of a case, as named from the project's root or from beside verification.json."""
    named = Path(case["profile_csv"])
    beside = Path(verification).parent / named
    return named if named.is_file() or not beside.is_file() else beside


def has_profile(case, verification):
    """Whether a case left a profile of at least three points: some are a single number."""
    path = profile_path(case, verification)
    return path.is_file() and sum(1 for _ in path.open(encoding="utf-8")) > 3


def of_spacing(micrometres):
    """A spacing in um, or in m where a case is stated in metres."""
    return f"{micrometres:g} um" if micrometres < 1000 else f"{1e-6 * micrometres:.3g} m"


def curves(position, exact):
    """The exact curves of a profile: a table may hold several, one after another, each with its places in order."""
    cuts = np.flatnonzero(np.diff(position) < 0) + 1
    # Particles in no order step back all the time, curves one after another only where the next one begins.
    if 0 < len(cuts) < 4:
        return list(zip(np.split(position, cuts), np.split(exact, cuts)))
    order = np.argsort(position, kind="stable")
    return [(position[order], exact[order])]


def plot_profile(axes, case, verification):
    """Exact solution as a line, each spacing as markers. The table holds all spacings, one under another."""
    path = profile_path(case, verification)
    table = read_table(path)
    spacing, position = column(table, "spacing", path), column(table, "position", path)
    computed, exact = column(table, "value", path), column(table, "exact", path)
    spacings = np.unique(spacing)
    finest = spacing == spacings[0]
    for number, (place, known) in enumerate(curves(position[finest], exact[finest])):
        axes.plot(place, known, color="black", linewidth=1.0, linestyle=("-", "--", ":")[number % 3], zorder=3,
                  label="exact" if number == 0 else None)
    for look, size in zip(style.SERIES, spacings):
        chosen = spacing == size
        every = max(1, int(chosen.sum()) // 40)
        axes.plot(position[chosen][::every], computed[chosen][::every], linestyle="none", marker=look["marker"],
                  color=look["color"], fillstyle="none", markersize=3.2, markeredgewidth=0.7,
                  label=f"SPH, {of_spacing(size)}", zorder=4)
    axes.set_xlabel(textwrap.fill(case["profile"]["position"], 36), fontsize=6.5)
    axes.set_ylabel(textwrap.fill(case["profile"]["value"], 34), fontsize=6.5)
    axes.set_title(textwrap.fill(case["title"], 26), fontsize=7)
    axes.legend(loc="best", fontsize=6, frameon=True, framealpha=0.7, edgecolor="none")


def plot_convergence(axes, cases, legend=None):
    """Error against spacing, log-log, with the asked error of each case as a short thick line. `legend` says where
    the names stand, as matplotlib's legend() takes it."""
    for index, case in enumerate(cases):
        look = style.SERIES[index % len(style.SERIES)]
        spacings, errors = np.asarray(case["spacings_um"], float), np.asarray(case["errors"], float)
        order = case.get("order")
        label = case["name"].replace("_", " ") + (f": order {order:.2f}" if order is not None else "")
        axes.loglog(spacings, 100 * errors, label=label, fillstyle="none", **look)
        axes.plot([spacings.min() * 0.87, spacings.min() * 1.15], [100 * case["asked"]] * 2,
                  color=look["color"], linewidth=2.2)
    ticks = sorted({spacing for case in cases for spacing in case["spacings_um"]})
    scale, unit = (1e-6, "m") if ticks and ticks[0] >= 1000 else (1, "um")
    axes.set_xticks(ticks, [f"{scale * tick:.3g}" for tick in ticks], rotation=45 if len(ticks) > 6 else 0)
    axes.minorticks_off()
    axes.set_xlabel(f"particle spacing [{unit}]")
    axes.set_ylabel("relative error [%]")
    axes.set_title("Error against spacing", fontsize=7)
    axes.legend(**(legend or {"loc": "best"}), fontsize=6)


def caption_sentences(cases):
    """One sentence per case with the numbers of verification.json."""
    sentences = []
    for case in cases:
        order = f", observed order {case['order']:.2f}" if case.get("order") is not None else ""
        finest = min(case["spacings_um"])
        verdict = "met" if case["pass"] else "NOT met"
        sentences.append(f"{case['title']}: error {100 * case['error']:.2g} % at {of_spacing(finest)} spacing "
                         f"(asked {100 * case['asked']:.2g} %, {verdict}){order}.")
    return " ".join(sentences)


def draw_cases(about, kinds, title):
    """A figure of all cases of some kinds: a panel for each that left a profile, and their convergence."""
    arguments = argparse.ArgumentParser(description=about)
    arguments.add_argument("verification", help="verification.json of meltproof-verify")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    cases = [case for case in load_cases(given.verification, kinds, key="kind") if case["kind"] in kinds]
    shown = [case for case in cases if has_profile(case, given.verification)]
    # The convergence takes what is left of the last row, or a row of its own where that is less than two panels.
    last, column_of_last = divmod(len(shown), 3)
    if column_of_last == 2:
        last, column_of_last = last + 1, 0
    figure = plt.figure(figsize=(style.PAGE_WIDTH, 2.0 * (last + 1)))
    grid = figure.add_gridspec(last + 1, 3)
    for index, case in enumerate(shown):
        plot_profile(figure.add_subplot(grid[index // 3, index % 3]), case, given.verification)
    converging = [case for case in cases if len(case["spacings_um"]) > 1]
    plot_convergence(figure.add_subplot(grid[last, column_of_last:]), converging[:len(style.SERIES)],
                     {"loc": "upper center", "bbox_to_anchor": (0.5, -0.45), "ncols": 3})
    style.save(figure, given.output, title,
               "Exact solution or published table as a line, SPH as markers. The last panel: error against spacing, of the "
               f"first {len(style.SERIES)} cases. " + caption_sentences(cases))
