# SPDX-License-Identifier: GPL-3.0-or-later
"""The graphics of a recording's and of a campaign's report. Series differ in marker and line as well as in
colour, so they are told apart in black and white and with any colour vision."""

import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from artifact import column  # noqa: E402
from style import BLACK, BLUE, GREEN, ORANGE, PAGE_WIDTH, RED, plt  # noqa: E402


def per_frame(table, path, summary, unit):
    """Length and depth against time (or frame), those that the mean is made of filled."""
    length, depth = column(table, "length", path), column(table, "depth", path)
    status = np.array([str(word) for word in column(table, "status", path)])
    time = column(table, "time", path)
    timed = np.isfinite(time).all() and len(time) > 1
    x = time * 1e3 if timed else column(table, "frame", path)
    found = np.isfinite(length)
    used = status == "complete"
    if not used.any():
        used = found  # lower bounds, as the summary says
    figure, axes = plt.subplots(2, 1, figsize=(PAGE_WIDTH, 3.9), sharex=True)
    for axis, values, name, colour, marker in ((axes[0], length, "length", BLUE, "o"),
                                               (axes[1], depth, "depth", RED, "s")):
        axis.plot(x[found & ~used], values[found & ~used], marker, mfc="white", mec=colour, ls="none",
                  label="not used")
        axis.plot(x[used], values[used], marker, color=colour, ls="none", label="used for the mean")
        budget = summary.get("budget", {}).get(f"{name}_{unit}")
        if budget:
            axis.axhline(budget["value"], color=BLACK, linewidth=0.9, label="result without blur and noise, 95 %")
            axis.axhspan(*budget["interval_95"], color="#bbbbbb", alpha=0.45, linewidth=0)
        axis.set_ylabel(f"{name}, {unit.replace('um', 'µm')}")
    axes[0].legend(loc="best")
    axes[1].set_xlabel("time, ms" if timed else "frame")
    return figure


def tail(table, path, summary, unit):
    """ln S along the line of the front: what is seen, the model with and without blur, and S*."""
    position = column(table, "distance from the front", path)
    seen, u = column(table, "ln S seen", path), column(table, "u", path)
    figure, axis = plt.subplots(figsize=(PAGE_WIDTH, 2.7))
    axis.errorbar(position, seen, yerr=2 * u, fmt="o", color=BLACK, markersize=2.5, elinewidth=0.6,
                  label="mean pool (two standard uncertainties)")
    axis.plot(position, column(table, "ln S model with blur", path), "-", color=BLUE, label="model as the camera blurs it")
    axis.plot(position, column(table, "ln S model", path), "--", color=RED, label="model without blur")
    reference = summary["reference_signal"]
    axis.axvline(0, color=GREEN, linestyle="-.", linewidth=1)
    if reference.get("found"):
        dark = next((row["value"] for row in summary["parameters"] if row["name"] == "signal without light"), 0) or 0
        level = math.log(max(reference["signal"] - dark, 1e-12))
        axis.axhline(level, color=GREEN, linestyle=":", linewidth=1)
        axis.plot([0], [level], "D", color=ORANGE, mec=BLACK, markersize=6, label="S* at the front")
    axis.set_xlabel(f"distance from the front, {unit.replace('um', 'µm')} (the beam is to the right)")
    axis.set_ylabel("ln of signal above dark")
    axis.legend(loc="best")
    return figure


def histogram(table, path, summary, unit):
    """How often which length was seen, in the frames used."""
    length = column(table, "length", path)
    status = np.array([str(word) for word in column(table, "status", path)])
    used = status == "complete"
    values = length[used if used.any() else np.isfinite(length)]
    figure, axis = plt.subplots(figsize=(PAGE_WIDTH, 2.1))
    bins = int(np.clip(math.ceil(math.sqrt(len(values))), 5, 40))
    axis.hist(values, bins=bins, color="#9ecae1", edgecolor=BLACK, linewidth=0.6)
    axis.axvline(summary[f"length_{unit}"]["mean"], color=BLUE, label="mean of the frames")
    if "budget" in summary:
        axis.axvline(summary["budget"][f"length_{unit}"]["value"], color=RED, linestyle="--",
                     label="without blur and noise")
    axis.set_xlabel(f"length in a frame, {unit.replace('um', 'µm')}")
    axis.set_ylabel("frames")
    axis.legend(loc="best")
    return figure


def against_content(groups, tracks):
    """Length against additive content: every track with its own spread over frames, and the mean of each
    content with the standard deviation between its tracks."""
    figure, axis = plt.subplots(figsize=(PAGE_WIDTH, 3.2))
    span = max(track["content"] for track in tracks) - min(track["content"] for track in tracks)
    shift = 0.012 * (span or 1)
    for group in groups:
        members = [track for track in tracks if track["content"] == group["content"]]
        for index, track in enumerate(members):
            axis.errorbar(track["content"] + shift * (1 + index), track["length_um"], yerr=track["sd_um"], fmt="o",
                          mfc="white", color=BLUE, markersize=3.5, elinewidth=0.8, capsize=2,
                          label="a track, standard deviation over frames" if group is groups[0] and not index else None)
    axis.errorbar([group["content"] for group in groups], [group["mean"] for group in groups],
                  yerr=[group["between_tracks"] or 0 for group in groups], fmt="s--", color=RED, elinewidth=1.4,
                  capsize=4, label="mean of the tracks, standard deviation between them")
    axis.set_xlabel("additive content, wt%")
    axis.set_ylabel("melt pool length, µm")
    axis.legend(loc="best")
    return figure
