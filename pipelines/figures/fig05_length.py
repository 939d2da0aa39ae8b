# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 5 of the paper: melt pool length against the additive content, measured by three definitions."""

import argparse
from pathlib import Path

import artifact
import matplotlib.pyplot as plt
import style

PENDING = "measurement pending: the values of the paper's\nFig. 5 are not public as numbers"
ROWS = {"fig5_length_0wt": 0.0, "fig5_length_1wt": 1.0, "fig5_length_5wt": 5.0}


def measured_lengths(path):
    """(content, length, standard uncertainty) of the comparison's rows whose slots are filled."""
    rows = {row["name"]: row for row in artifact.value(artifact.read_json(path), "rows", path)}
    return [(content, rows[name]["D"], rows[name]["u_D"]) for name, content in ROWS.items()
            if name in rows and rows[name]["D"] is not None]


def said_of(measured):
    """What the caption says of the measurement."""
    if not measured:
        return ("Measured lengths are pending: the paper shows them in a figure only, and no number of it is known here.")
    values = ", ".join(f"{length:.0f} um" + (f" (u {u:.0f})" if u else " (no uncertainty given)") + f" at {content:.2g} wt%"
                       for content, length, u in measured)
    missing = len(ROWS) - len(measured)
    return f"Measured, with the standard uncertainty as bar: {values}." + (f" {missing} slots are empty." if missing else "")


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("files", nargs="+", help="result.json of each track, summary.json of its recording, and "
                                                    "validation.json with what was measured")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    results, filmed, measured = {}, {}, []
    for path in given.files:
        if Path(path).name.endswith("validation.json"):
            measured = measured_lengths(path)
        elif path.endswith("result.json"):
            results[Path(path).parent] = artifact.read_json(path)
        else:
            filmed[Path(path).parent.parent] = artifact.read_json(path)
    tracks = sorted(results, key=lambda track: results[track]["additive_wt_percent"])

    figure, axes = plt.subplots(figsize=(4.6, 2.9))
    series = []
    seen = [(track, filmed[track]["length_um"]) for track in tracks
            if track in filmed and filmed[track].get("melt_pool_found") and "length_um" in filmed[track]]
    if seen:
        series.append(("as the virtual camera sees it", [results[track]["additive_wt_percent"] for track, _ in seen],
                       [length["mean"] for _, length in seen], [2 * length["u_mean"] for _, length in seen]))
    for label, key in (("connected pool, above the liquidus of 316L", "pool_length"),
                       ("any liquid, each point above its own liquidus", "any_liquid_length")):
        series.append((label, [results[track]["additive_wt_percent"] for track in tracks],
                       [artifact.value(results[track], f"{key}_um", track / "result.json") for track in tracks],
                       [artifact.value(results[track], f"{key}_sd_um", track / "result.json") for track in tracks]))
    sentences = []
    for offset, (look, (label, content, length, spread)) in enumerate(zip(style.SERIES, series)):
        shifted = [wt + 0.05 * (offset - 1) for wt in content]
        axes.errorbar(shifted, length, yerr=spread, capsize=3, elinewidth=0.8, fillstyle="none", label=label, **look)
        values = ", ".join(f"{v:.0f} um at {wt:.2g} wt%" for wt, v in zip(content, length))
        sentences.append(f"{label[0].upper()}{label[1:]}: {values}.")
    top = max(v + s for _, _, length, spread in series for v, s in zip(length, spread))
    if measured:
        top = max(top, *(length + (u or 0) for _, length, u in measured))
        axes.errorbar([content - 0.1 for content, _, _ in measured], [length for _, length, _ in measured],
                      yerr=[u or 0 for _, _, u in measured], capsize=4, color="black", marker="*", markersize=8,
                      linestyle="none", label="measured (the paper's Fig. 5)")
    axes.set(ylim=(0, 1.12 * top), xlabel="AlSi10Mg in the powder [wt%]", ylabel="melt pool length [um]")
    axes.legend(loc="lower left")
    if len(measured) < len(ROWS):
        axes.text(0.98, 0.97, PENDING, transform=axes.transAxes, ha="right", va="top", fontsize=7, style="italic",
                  bbox=style.PENDING_BOX)

    used = sorted({filmed[track].get("frames_used", "") for track, _ in seen})
    frames = f" The camera's lengths are means over frames, {'; '.join(used)}." if seen else ""
    left_out = len(tracks) - len(seen)
    note = f" In {left_out} of the filmed tracks no pool was found in the frames." if left_out else ""
    style.save(figure, given.output, "Melt pool length against the additive content (the paper's Fig. 5)",
               "Simulated. " + " ".join(sentences) + " Bars: expanded uncertainty of the mean (k = 2) for the "
               "camera, standard deviation over the averaging window for the other two. " + said_of(measured) + frames + note)


style.run(main)
