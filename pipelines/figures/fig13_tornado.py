# SPDX-License-Identifier: GPL-3.0-or-later
"""Which uncertain input matters most: relative uncertainty of length, width and depth, in both directions."""

import argparse
import textwrap

import artifact
import matplotlib.pyplot as plt
import style

EXTENTS = ("length", "width", "depth")


def swing(effect):
    """What one standard uncertainty more and less of the input does, in %; of a choice what the other law does, and
    the same distance to the other side."""
    share = 100 * (effect["relative_u"] or 0.0)
    slope = effect["relative_sensitivity"]
    if slope is None:
        change = max((entry["change"] for entry in effect["changes"]), key=abs)
        return share if change > 0 else -share, None
    return share if slope > 0 else -share, -share if slope > 0 else share


def label(entry):
    known, title = entry["input"], textwrap.fill(entry["title"], 20)
    return f"{title}\n(another law)" if not known["value_text"] else f"{title}\n({known['value_text']}, u {known['u_text']})"


def plot(axes, inputs, extent):
    """One panel: the inputs from the one that matters most; returns the sentence about it."""
    order = sorted(inputs, key=lambda entry: entry["quantities"][extent]["relative_u"])
    for place, entry in enumerate(order):
        effect = entry["quantities"][extent]
        more, less = swing(effect)
        common = {"height": 0.62, "edgecolor": "black", "linewidth": 0.6}
        axes.barh(place, more, facecolor=style.BLUE, **common)
        if less is not None:
            axes.barh(place, less, facecolor="white", hatch="/////", **common)
        if effect["same_side"]:
            axes.text(abs(more), place, " *", va="center", ha="left", fontsize=10, fontweight="bold")
    axes.axvline(0, color="black", linewidth=0.8)
    axes.set_yticks(range(len(order)), [label(entry) for entry in order], fontsize=6)
    axes.grid(axis="y", visible=False)
    first = order[-1]
    return f"{extent}: {first['title'].lower()} first, {100 * first['quantities'][extent]['relative_u']:.2g} %"


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("studies", help="studies.json of meltproof-studies")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    summary = artifact.read_json(given.studies)
    declared = [entry for entry in artifact.value(summary, "series", given.studies)
                if entry["kind"] == "input" and entry["counted"]]
    there = {extent: [entry for entry in declared if not entry["missing"]
                      and entry["quantities"][extent]["relative_u"] is not None] for extent in EXTENTS}
    missing = [entry["title"].lower() for entry in declared if entry not in there["length"]]
    largest = max((100 * entry["quantities"][extent]["relative_u"] for extent in EXTENTS for entry in there[extent]),
                  default=1.0)
    rows = max(len(found) for found in there.values())
    figure, panels = plt.subplots(1, 3, figsize=(style.PAGE_WIDTH, 1.1 + 0.4 * max(3, rows)))
    sentences = []
    for axes, extent, letter in zip(panels, EXTENTS, "abc"):
        axes.set_title(f"{letter}  {extent.capitalize()}")
        axes.set_xlabel("change [%]")
        if there[extent]:
            sentences.append(plot(axes, there[extent], extent))
            axes.set_xlim(-1.25 * largest, 1.25 * largest)  # one scale for all three
        else:
            axes.set_yticks([])
            axes.text(0.5, 0.5, "not run yet:\nmake studies", transform=axes.transAxes, ha="center", va="center",
                      fontsize=7, style="italic", bbox=style.PENDING_BOX)
    if rows:
        handles = [plt.Rectangle((0, 0), 1, 1, facecolor=style.BLUE, edgecolor="black"),
                   plt.Rectangle((0, 0), 1, 1, facecolor="white", hatch="/////", edgecolor="black")]
        figure.legend(handles, ["input one standard uncertainty higher, or the other law", "one lower"],
                      loc="lower center", ncols=2)
        legend = 0.22 / figure.get_figheight()  # inches, below the panels
        figure.get_layout_engine().set(rect=(0, legend, 1, 1 - legend))
    bent = sorted({entry["title"].lower() for extent in EXTENTS for entry in there[extent]
                   if entry["quantities"][extent]["same_side"]})
    style.save(figure, given.output, "Which uncertain input matters most",
               "Simulated: what one standard uncertainty of each input does to the pool, from runs with the input lower and "
               "higher; the inputs from the one that matters least to the one that matters most. "
               + ("Largest: " + "; ".join(sentences) + ". " if sentences else "")
               + (f"* lower and higher move it to the same side: the steeper slope counts ({', '.join(bent)}). " if bent else "")
               + (f"Without runs so far: {', '.join(missing)}." if missing else "Every declared input has its runs."))


style.run(main)
