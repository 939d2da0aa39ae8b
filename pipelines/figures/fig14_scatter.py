# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulated against measured numbers of every row, with the identity line and the model's bias and scatter."""

import argparse

import artifact
import matplotlib.pyplot as plt
import numpy as np
import style


def compared(rows):
    """Rows that have a simulated and a measured number, both positive."""
    return [row for row in rows if row["metric"] == "difference" and (row["S"] or 0) > 0 and (row["D"] or 0) > 0]


def band(axes, centre, spread, ends, **look):
    """A line S = centre * D, and two beside it at a factor of exp(+-2 spread)."""
    ends = np.array(ends)
    label = look.pop("label")
    axes.plot(ends, centre * ends, label=label, **look)
    for sign in (-1, 1):
        axes.plot(ends, centre * np.exp(sign * 2 * spread) * ends, **{**look, "linewidth": 0.6})


def scatter(axes, rows, of_all):
    """S against D of the extents, which share a unit."""
    extents = [row for row in rows if row["unit"] == "um"]
    quantities = sorted({row["quantity"] for row in extents})
    for quantity, look in zip(quantities, style.SERIES):
        mine = [row for row in extents if row["quantity"] == quantity]
        axes.errorbar([row["D"] for row in mine], [row["S"] for row in mine], xerr=[row["u_D"] or 0 for row in mine],
                      yerr=[np.hypot(row["u_num"] or 0, row["u_input"] or 0) for row in mine], elinewidth=0.6,
                      capsize=2, linestyle="none", marker=look["marker"], color=look["color"], fillstyle="none",
                      label=quantity)
    values = [row[key] for row in extents for key in ("S", "D")]
    ends = (0.7 * min(values), 1.4 * max(values))
    measured = of_all["measured_scatter"] if of_all else 0.0
    band(axes, 1.0, measured, ends, color="black", linestyle="-", linewidth=1.0, label="S = D, 2 sd of measurement")
    if of_all:
        band(axes, of_all["bias"], of_all["model_scatter"], ends, color=style.RED, linestyle="--", linewidth=1.0,
             label="model's bias, 2 sd of model")
    axes.set(xscale="log", yscale="log", xlim=ends, ylim=ends, xlabel="measured D [um]", ylabel="simulated S [um]",
               aspect="equal")
    ticks = [tick for tick in (10, 20, 50, 100, 200, 500, 1000, 2000) if ends[0] <= tick <= ends[1]]
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_locator(plt.NullLocator())
        axis.set_ticks(ticks, [str(tick) for tick in ticks])
    axes.legend(loc="upper left", fontsize=6)


def ratios(axes, rows):
    """S/D of every row, with k = 2 of the whole budget."""
    for place, row in enumerate(rows):
        u = (row["u_val"] or 0) / row["D"]
        agrees = row["verdict"] == "agrees"
        axes.errorbar([row["S"] / row["D"]], [place], xerr=[2 * u], capsize=2, elinewidth=0.8, color="black", marker="o",
                      fillstyle="full" if agrees else "none")
    axes.axvline(1, color="black", linewidth=0.8)
    axes.set_yticks(range(len(rows)), [row["name"].replace("_", " ") for row in rows], fontsize=6)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_xlabel("S / D [1]")


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("comparison", help="validation.json of meltproof-compare")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    document = artifact.read_json(given.comparison)
    rows = compared(artifact.value(document, "rows", given.comparison))
    statistics = {entry["quantity"]: entry for entry in artifact.value(document, "statistics", given.comparison)}
    figure, (left, right) = plt.subplots(1, 2, figsize=(style.PAGE_WIDTH, 3.3))
    left.set_title("a  Simulated against measured")
    right.set_title("b  Ratio, bars: 2 u_val")
    if any(row["unit"] == "um" for row in rows):
        scatter(left, rows, statistics.get("all"))
    else:
        left.set(xlabel="measured D [um]", ylabel="simulated S [um]")
    if rows:
        ratios(right, rows)
    else:
        right.set_yticks([])
        right.set_xlabel("S / D [1]")
        right.text(0.5, 0.5, "no row has both numbers", transform=right.transAxes, ha="center", va="center", fontsize=7,
                   style="italic", bbox=style.PENDING_BOX)
    sentences = [f"{'all rows' if name == 'all' else name}: {entry['points']} data, bias {entry['bias']:.2f}, model scatter "
                 f"{100 * entry['model_scatter']:.0f} %, measurement {100 * entry['measured_scatter']:.0f} %"
                 for name, entry in sorted(statistics.items())]
    style.save(figure, given.output, "Every comparison at once",
               "Simulated against measured. In a, bars are standard uncertainties; black: identity, thin lines two relative "
               "standard deviations of the measurements beside it; red dashed: the model's mean bias, thin lines two of its "
               "scatter (statistics of ln(S/D), McGrattan and Toman 2011; each datum with its own uncertainty). In b every row, "
               "filled where it agrees by its rule. "
               + ("; ".join(sentences) + "." if sentences else "Fewer than two rows can be compared, so there is no statistic."))


style.run(main)
