# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 7 of the paper: concentration through one molten AlSi10Mg grain, in depth and across."""

import argparse
import math
import textwrap

import artifact
import matplotlib.pyplot as plt
import numpy as np
import style


def percent(shares):
    """Shares in wt%; where there is no number (no material on the line), a gap."""
    return [math.nan if share is None else 100 * share for share in shares]


def plot(axes, path, letter):
    """One line scan; returns its sentence for the caption."""
    scan = artifact.read_json(path)
    if artifact.value(scan, "status", path) == "no result":
        axes.set(xlabel="position along the line [um]", ylabel="AlSi10Mg [wt%]", xlim=(0, 20), ylim=(0, 100))
        axes.text(0.5, 0.5, textwrap.fill("no result: " + scan["reason"], 42), transform=axes.transAxes, ha="center",
                  va="center", fontsize=7, style="italic", bbox=style.PENDING_BOX)
        return f"{letter}: no result, {scan['reason'].rstrip('.')}."
    direction = artifact.value(artifact.value(scan, "line", path), "direction", path)
    axes.set(xlabel="position along the line [um]", ylabel="AlSi10Mg [wt%]")
    axes.set_title(f"{letter}  {'In depth' if direction == 'depth' else 'Lateral'}")
    simulated = artifact.value(scan, "simulated", path)
    position = simulated["position_um"]
    interaction = scan["interaction"]
    axes.plot(position, percent(simulated["concentration"]), color=style.BLACK, linestyle=":",
              linewidth=1.0, label="simulated")
    axes.plot(position, percent(simulated["concentration_seen"]), color=style.BLUE,
              linestyle="-", label="simulated, as EDS would see it")
    axes.set_ylim(0, max(1.0, 1.25 * np.nanmax(percent(simulated["concentration"]))))
    measured = scan.get("measured")
    if measured:
        axes.errorbar(measured["position_um"], percent(measured["concentration"]),
                      yerr=np.nan_to_num(percent(measured["concentration_u"])), fmt="s", color=style.RED,
                      fillstyle="none", capsize=2, label="measured")
    else:
        axes.text(0.98, 0.76, "measurement pending:\nFig. 7 is not public\nas numbers", transform=axes.transAxes,
                  ha="right", va="top", fontsize=7, style="italic", bbox=style.PENDING_BOX)
    axes.legend(loc="upper right", fontsize=6.5)
    grain = scan.get("grain")
    where = (f"through a grain {grain['edge_distance_um']:.3g} um from the pool's edge "
             f"({grain['particles']} particles)" if grain else "along a given line")
    return (f"{'Depth' if direction == 'depth' else 'Lateral'}: {where}, beam {interaction['voltage_kV']:g} kV, "
            f"interaction volume {interaction['range_um']:.3g} um.")


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("linescans", nargs=2, help="linescan_depth.json and linescan_lateral.json")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    figure, panels = plt.subplots(1, 2, figsize=(style.PAGE_WIDTH, 2.5))
    sentences = [plot(axes, path, letter) for axes, path, letter in zip(panels, given.linescans, "ab")]
    style.save(figure, given.output, "Concentration through a molten grain (the paper's Fig. 7)",
               "Simulated, after solidification: AlSi10Mg along a line, as it is and convolved with the interaction "
               "volume of the electron beam. " + " ".join(sentences) + " The measured profiles are pending: the "
               "paper shows them in a figure only.")


style.run(main)
