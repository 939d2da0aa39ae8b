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
    return np.array([math.nan if share is None else 100 * share for share in shares])


def draw_simulated(axes, simulated):
    """The line itself, the band of scatter within the strip, and what the beam sees."""
    position = np.array(simulated["position_um"])
    sharp = percent(simulated["concentration"])
    if "concentration_strip" in simulated:
        strip, scatter = percent(simulated["concentration_strip"]), percent(simulated["concentration_strip_sd"])
        axes.fill_between(position, strip - scatter, strip + scatter, facecolor="#e4e4e4", edgecolor="#aaaaaa",
                          linewidth=0.4, hatch="////", label="scatter in the strip (1 s)")
    axes.plot(position, sharp, color=style.BLACK, linestyle=":", linewidth=1.0, label="simulated")
    axes.plot(position, percent(simulated["concentration_seen"]), color=style.BLUE, linestyle="-",
              label="simulated, as EDS would see it")
    return np.nanmax(sharp)


def draw_measured(axes, scan):
    """The points at their places on the simulated line, so that the registration is seen; returns their bounds."""
    measured, compared = scan["measured"], scan["compared"]
    place = np.array(compared.get("place_on_simulated_line_um", compared["position_um"]))
    at = {round(x, 9): k for k, x in enumerate(measured["position_um"])}
    index = [at[round(x, 9)] for x in compared["position_um"]]
    values = percent(measured["concentration"])
    u = np.nan_to_num(percent(measured["concentration_u"]))
    axes.errorbar(place, values[index], yerr=u[index], fmt="s", color=style.RED, fillstyle="none", capsize=2,
                  label="measured")
    flagged = measured["flagged_points"]
    if flagged and not scan["registration"]["reversed"]:
        axes.plot(np.array(measured["position_um"])[flagged] + scan["registration"]["shift_um"], values[flagged],
                  linestyle="none", marker="x", color=style.BLACK, label="total off, not compared")
    return np.nanmin(values), np.nanmax(values)


def draw_residuals(axes, scan, limits):
    """Simulated minus measured, with the uncertainty of the difference."""
    axes.set(xlabel="position along the line [um]", ylabel="S - D [wt%]", xlim=limits)
    if not scan.get("compared"):
        axes.set_visible(False)
        return
    compared = scan["compared"]
    place = compared.get("place_on_simulated_line_um", compared["position_um"])
    difference = percent(compared["simulated"]) - percent(compared["measured"])
    u = np.nan_to_num(percent(compared.get("u", [0] * len(difference))))
    axes.axhline(0, color=style.BLACK, linewidth=0.6)
    axes.errorbar(place, difference, yerr=u, fmt="o", color=style.BLACK, fillstyle="none", markersize=3, capsize=2)


def sentence(scan, direction):
    interaction, grain = scan["interaction"], scan.get("grain")
    where = (f"through a grain {grain['edge_distance_um']:.3g} um from the pool's edge "
             f"({grain['particles']} particles)" if grain else "along a given line")
    name = {"depth": "Depth", "lateral": "Lateral"}.get(direction, "Given line")
    words = f"{name}: {where}, beam {interaction['voltage_kV']:g} kV"
    if "sigma_most_um" in interaction:
        words += (f", X-rays from {2.355 * interaction['sigma_least_um']:.3g} to "
                  f"{2.355 * interaction['sigma_most_um']:.3g} um (full width, by the matrix)")
    else:
        words += f", interaction volume {interaction['range_um']:.3g} um"
    strip = scan["line"].get("strip")
    if strip:
        words += f", strip {strip['width_um']:g} um wide and up to {strip['most_depth_um']:.3g} um deep"
    if scan.get("metrics"):
        chi = scan["metrics"].get("reduced_chi_square")
        words += (f"; RMSE {100 * scan['metrics']['RMSE']:.2g} wt% over {scan['metrics']['points']} points, "
                  + (f"reduced chi-square {chi:.2g}" if chi is not None else "no reduced chi-square")
                  + f", shift {scan['registration']['shift_um']:.2g} um")
    return words + "."


def plot(axes, below, path, letter):
    """One line scan; returns its sentence for the caption."""
    scan = artifact.read_json(path)
    if artifact.value(scan, "status", path) == "no result":
        axes.set(xlabel="position along the line [um]", ylabel="AlSi10Mg [wt%]", xlim=(0, 20), ylim=(0, 100))
        axes.text(0.5, 0.5, textwrap.fill("no result: " + scan["reason"], 42), transform=axes.transAxes, ha="center",
                  va="center", fontsize=7, style="italic", bbox=style.PENDING_BOX)
        if below:
            below.set_visible(False)
        return f"{letter}: no result, {scan['reason'].rstrip('.')}."
    direction = artifact.value(artifact.value(scan, "line", path), "direction", path)
    axes.set(ylabel="AlSi10Mg [wt%]")
    axes.set_title(f"{letter}  " + {"depth": "In depth", "lateral": "Lateral"}.get(direction, "Along a given line"))
    least, most = 0, draw_simulated(axes, artifact.value(scan, "simulated", path))
    if scan.get("measured"):
        lowest, highest = draw_measured(axes, scan)
        least, most = min(0, 1.3 * lowest), max(most, highest)
    else:
        axes.text(0.98, 0.68, "measurement pending:\nFig. 7 is not public\nas numbers", transform=axes.transAxes,
                  ha="right", va="top", fontsize=7, style="italic", bbox=style.PENDING_BOX)
    axes.set_ylim(least, max(1.0, 1.25 * most))  # what noise carries below nothing stays visible
    axes.legend(loc="upper right", fontsize=6.5)
    if below:
        draw_residuals(below, scan, axes.get_xlim())
    if not below or not below.get_visible():
        axes.set_xlabel("position along the line [um]")
    return sentence(scan, direction)


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("linescans", nargs=2, help="linescan_depth.json and linescan_lateral.json")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    measured = [bool(artifact.read_json(path).get("measured")) for path in given.linescans]
    if any(measured):
        figure, rows = plt.subplots(2, 2, figsize=(style.PAGE_WIDTH, 3.4), height_ratios=[3, 1])
        panels = list(zip(rows[0], rows[1]))
    else:
        figure, row = plt.subplots(1, 2, figsize=(style.PAGE_WIDTH, 2.5))
        panels = [(axes, None) for axes in row]
    sentences = [plot(axes, below, path, letter)
                 for (axes, below), path, letter in zip(panels, given.linescans, "ab")]
    end = ("Below: simulated minus measured, with the uncertainty of the difference." if all(measured) else
           "The measured profiles are pending: the paper shows them in a figure only.")
    style.save(figure, given.output, "Concentration through a molten grain (the paper's Fig. 7)",
               "Simulated, after solidification: AlSi10Mg along a line, as it is, its scatter within the strip that "
               "the scan measures, and the strip's mean convolved with the interaction volume of the electron beam. "
               + " ".join(sentences) + " " + end)


style.run(main)
