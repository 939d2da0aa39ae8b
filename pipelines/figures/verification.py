# SPDX-License-Identifier: GPL-3.0-or-later
"""The two panels in which a verification case is shown: its profile, and its error against the spacing."""

from pathlib import Path

import numpy as np
import style
from artifact import MissingArtifact, column, read_json, read_table, value


def load_cases(path, wanted):
    """The cases of verification.json whose name holds one of the words in `wanted`."""
    cases = [case for case in value(read_json(path), "cases", path)
             if any(word in value(case, "name", path) for word in wanted)]
    if not cases:
        raise MissingArtifact(f"{path} holds no case named like {' or '.join(wanted)}; run `make verify`.")
    return cases


def profile_path(case, verification):
    """`profile_csv` of a case, as named from the project's root or from beside verification.json."""
    named = Path(case["profile_csv"])
    beside = Path(verification).parent / named
    return named if named.is_file() or not beside.is_file() else beside


def plot_profile(axes, case, verification):
    """Exact solution as a line, each spacing as markers."""
    path = profile_path(case, verification)
    table = read_table(path)
    headers = list(table)
    position = column(table, "position", path)
    exact_header = next((h for h in headers if h.split(" [")[0] == "exact"), None)
    if exact_header is None:
        raise MissingArtifact(f"{path} has no column `exact`.")
    exact = table[exact_header]
    known = np.isfinite(position) & np.isfinite(exact)
    order = np.argsort(position[known], kind="stable")
    axes.plot(position[known][order], exact[known][order], color="black", linewidth=1.0, label="exact", zorder=3)
    for index, header in enumerate(h for h in headers[1:] if h != exact_header):
        look = style.SERIES[index % len(style.SERIES)]
        present = np.isfinite(position) & np.isfinite(table[header])
        every = max(1, int(present.sum()) // 40)
        axes.plot(position[present][::every], table[header][present][::every], linestyle="none",
                  marker=look["marker"], color=look["color"], fillstyle="none", markersize=3.5,
                  markeredgewidth=0.8, label=f"SPH, {header.rsplit(' [', 1)[0]}", zorder=4)
    unit = exact_header.split("[", 1)[1].rstrip("]") if "[" in exact_header else "1"
    quantity = value(case, "quantity", verification)
    axes.set_xlabel(next(h for h in headers if h.split(" [")[0] == "position"))
    axes.set_ylabel(f"{axis_quantity(quantity)} [{unit}]")
    axes.set_title(case["title"], fontsize=7)
    axes.legend(loc="best")


def axis_quantity(quantity):
    """`L2 error of the concentration` is measured on the concentration: that is what the axis shows."""
    words = quantity.split(" of the ")
    return words[-1] if len(words) > 1 else quantity


def plot_convergence(axes, cases):
    """Error against spacing, log-log, with the asked error of each case as a short dashed line."""
    for index, case in enumerate(cases):
        look = style.SERIES[index % len(style.SERIES)]
        spacings, errors = np.asarray(case["spacings_um"], float), np.asarray(case["errors"], float)
        order = case.get("order")
        label = case["name"].replace("_", " ") + (f": order {order:.2f}" if order is not None else "")
        axes.loglog(spacings, 100 * errors, label=label, fillstyle="none", **look)
        axes.plot([spacings.min() * 0.87, spacings.min() * 1.15], [100 * case["asked"]] * 2,
                  color=look["color"], linewidth=2.2)
    ticks = sorted({spacing for case in cases for spacing in case["spacings_um"]})
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_xlabel("particle spacing [um]")
    axes.set_ylabel("relative error [%]")
    axes.set_title("Error against spacing", fontsize=7)
    axes.legend(loc="best", fontsize=6)


def caption_sentences(cases):
    """One sentence per case with the numbers of verification.json."""
    sentences = []
    for case in cases:
        order = f", observed order {case['order']:.2f}" if case.get("order") is not None else ""
        finest = min(case["spacings_um"])
        verdict = "met" if case["pass"] else "NOT met"
        sentences.append(f"{case['title']}: error {100 * case['error']:.2g} % at {finest:g} um spacing "
                         f"(asked {100 * case['asked']:.2g} %, {verdict}){order}.")
    return " ".join(sentences)
