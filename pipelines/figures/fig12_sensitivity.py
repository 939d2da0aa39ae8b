# SPDX-License-Identifier: GPL-3.0-or-later
"""What one changed number does to length, width and depth of the pool, run by run."""

import argparse

import artifact
import matplotlib.pyplot as plt
import style

EXTENTS = ("length", "width", "depth")
CLUMPED = 0.01  # share above which a run does not count


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("studies", help="studies.json of meltproof-studies")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    summary = artifact.read_json(given.studies)
    runs = {run["name"]: run for run in artifact.value(summary, "runs", given.studies)}
    rows = []
    for entry in artifact.value(summary, "series", given.studies):
        if entry["kind"] in ("numerical", "physics") and entry["base"] in runs:
            rows += [(entry["kind"], runs[name], runs[entry["base"]]) for name in entry["runs"]
                     if name in runs and name != entry["base"]]
    figure, axes = plt.subplots(figsize=(style.PAGE_WIDTH, 1.2 + 0.2 * max(3, len(rows))))
    for offset, (extent, look) in enumerate(zip(EXTENTS, style.SERIES)):
        for place, (_, run, base) in enumerate(rows):
            change = 100 * (run[f"{extent}_um"] / base[f"{extent}_um"] - 1)
            counted = run["clumped_fraction"] < CLUMPED
            axes.plot([change], [place + 0.2 * (offset - 1)], color=look["color"], marker=look["marker"],
                      linestyle="none", fillstyle="full" if counted else "none", label=extent if place == 0 else None)
    axes.axvline(0, color="black", linewidth=0.8)
    axes.margins(x=0.1)
    if rows:
        axes.set_yticks(range(len(rows)), [f"{run['title']} ({kind})" for kind, run, _ in rows], fontsize=6.5)
        axes.set_ylim(len(rows) - 0.5, -0.5)
        axes.legend(loc="best", ncols=3)
    else:
        axes.set_yticks([])
        axes.text(0.5, 0.5, "not run yet: make studies", transform=axes.transAxes, ha="center", va="center", fontsize=7,
                  style="italic", bbox=style.PENDING_BOX)
    axes.set_xlabel("change against the base [%]")
    hollow = any(run["clumped_fraction"] >= CLUMPED for _, run, _ in rows)
    style.save(figure, given.output, "What one changed number does to the pool",
               "Simulated: the paper's track, on a bare plate or with powder where a content is named, one number changed at a "
               "time, against its base. Numerical choices "
               "should change nothing: their spread is part of the numerical uncertainty. Physics may."
               + (" Hollow marks: runs whose melt clumps, which do not count." if hollow else ""))


style.run(main)
