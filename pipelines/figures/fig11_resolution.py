# SPDX-License-Identifier: GPL-3.0-or-later
"""Length, width and depth of the pool against the particle spacing, with the extrapolated value."""

import argparse

import artifact
import matplotlib.pyplot as plt
import numpy as np
import style

EXTENTS = ("length", "width", "depth")


def plot_extent(axes, entry, runs, extent, look):
    """One resolution: values with the scatter in their window, and where it converges the power law through them."""
    found = entry["quantities"][extent]
    spacing, value = np.array(found["spacings_um"]), np.array(found["values_um"])
    scatter = [runs[name][f"{extent}_sd_um"] for name in entry["runs"]][::-1]  # declared from coarse to fine
    axes.errorbar(spacing, value, yerr=scatter, fillstyle="none", capsize=3, elinewidth=0.8, label=entry["title"],
                  color=look["color"], marker=look["marker"], linestyle="none")
    base = list(spacing).index(runs[entry["base"]]["spacing_um"])
    axes.errorbar([spacing[base]], [value[base]], yerr=[2 * found["u_base_um"]], color=look["color"], elinewidth=2.4,
                  alpha=0.35, marker="none")
    if found["behaviour"] == "converges":
        limit, order = found["extrapolated_um"], found["order_used"]
        fine = np.linspace(0, spacing.max(), 60)
        slope = (value[1] - value[0]) / (spacing[1] ** order - spacing[0] ** order)
        axes.plot(fine, limit + slope * fine**order, color=look["color"], linewidth=0.8, linestyle=look["linestyle"])
        axes.plot([0], [limit], color=look["color"], marker=look["marker"], markersize=6, linestyle="none", clip_on=False)
        said = f"observed order {found['order']:.2f}, extrapolated {limit:.0f} um"
    else:
        said = found["behaviour"]
    return f"{extent}: {said}, u at {spacing[base]:g} um {found['u_base_um']:.0f} um"


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("studies", help="studies.json of meltproof-studies")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    summary = artifact.read_json(given.studies)
    runs = {run["name"]: run for run in artifact.value(summary, "runs", given.studies)}
    series = [entry for entry in artifact.value(summary, "series", given.studies)
              if entry["kind"] == "resolution" and not entry["missing"]]
    figure, panels = plt.subplots(1, 3, figsize=(style.PAGE_WIDTH, 2.6))
    sentences = []
    for entry, look in zip(series, style.SERIES):
        said = [plot_extent(axes, entry, runs, extent, look) for axes, extent in zip(panels, EXTENTS)]
        sentences.append(f"{entry['title']}: " + "; ".join(said) + ".")
    for axes, extent, letter in zip(panels, EXTENTS, "abc"):
        axes.set(xlabel="particle spacing [um]", ylabel=f"pool {extent} [um]", xlim=(0, None))
        axes.set_title(f"{letter}  {extent.capitalize()}")
        if series:
            axes.set_ylim(0, 1.15 * axes.get_ylim()[1])
        else:
            axes.text(0.5, 0.5, "not run yet:\nmake studies", transform=axes.transAxes, ha="center", va="center",
                      fontsize=7, style="italic", bbox=style.PENDING_BOX)
    if series:
        panels[0].legend(loc="lower right", fontsize=6)
    style.save(figure, given.output, "What the particle spacing changes",
               "Simulated. Thin bars: standard deviation in the averaging window; broad bar at the base: expanded numerical "
               "uncertainty (k = 2). Where a series converges, the line is f = f_0 + a h^p through its two finest values with the "
               "observed order, at most 2; the filled mark at zero is f_0. "
               + (" ".join(sentences) or "No resolution study is complete yet."))


style.run(main)
