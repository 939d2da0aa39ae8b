# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 4 of the paper: the powder bed, the melt pool in two sections, and the AlSi10Mg concentration."""

import argparse

import artifact
import matplotlib.pyplot as plt
import numpy as np
import sections
import style

MICRON = 1e-6
# Told apart by brightness as well as by colour.
MATERIALS = [("316L powder", "#d0d0d0"), ("AlSi10Mg powder", style.BLUE)]
STRIP = 90.0  # um to either side of the track that the view from above shows


def read_powder(path):
    """Spheres in um as centre, radius, material, the box as (lower, upper), and the facts for the caption."""
    with artifact.open_artifact(path, "meltproof powder bed") as bed:
        centre = artifact.data(bed, "spheres/centre") / MICRON
        radius = artifact.data(bed, "spheres/radius") / MICRON
        material = artifact.data(bed, "spheres/material")
        box = artifact.data(bed, "box/lower") / MICRON, artifact.data(bed, "box/upper") / MICRON
        facts = {name: artifact.scalar(bed, name) for name in
                 ("packing_density", "mean_coordination", "additive_mass_fraction", "d50")}
    return centre, radius, material, box, facts


def plot_powder(axes, centre, radius, material, box):
    """The spheres along the track from above, the higher over the lower."""
    shown = np.flatnonzero(np.abs(centre[:, 1]) < STRIP + radius)
    for index in shown[np.argsort(centre[shown, 2], kind="stable")]:
        axes.add_patch(plt.Circle(centre[index, :2], radius[index], facecolor=MATERIALS[int(material[index])][1],
                                  edgecolor="black", linewidth=0.25))
    axes.set(xlim=(box[0][0], box[1][0]), ylim=(max(-STRIP, box[0][1]), min(STRIP, box[1][1])), aspect="equal",
             xlabel="scan direction x [um]", ylabel="y [um]")
    axes.grid(False)


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("powder", help="powder.h5")
    arguments.add_argument("run", help="run.h5")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    centre, radius, material, box, bed = read_powder(given.powder)
    with artifact.open_artifact(given.run, "meltproof run") as run:
        # One scale for all four pictures: heights as the lengths that they show.
        height = (artifact.data(run, "domain/upper") - artifact.data(run, "domain/lower"))[2] / MICRON
        heights = [min(2 * STRIP, box[1][1] - box[0][1]), height, height, height]
        inches = 5.3 / (box[1][0] - box[0][0])
        figure, panels = plt.subplots(4, 2, figsize=(style.PAGE_WIDTH, sum(heights) * inches + 2.3),
                                      width_ratios=[34, 1], height_ratios=heights)
        liquidus = artifact.scalar(run, "reference_temperature")
        spacing = artifact.scalar(run, "spacing") / MICRON
        before, hot, last = artifact.snapshots(run)[0], sections.last_hot(run), artifact.snapshots(run)[-1]
        time, cooled = (1e6 * artifact.scalar(run, f"{name}/time") for name in (hot, last))

        plot_powder(panels[0, 0], centre, radius, material, box)
        panels[0, 0].set_title("a  Powder bed along the track, from above")
        sections.plot_origin(panels[1, 0], run, before, "y", [("plate", "#ececec"), *MATERIALS])
        panels[1, 0].set_title("b  As SPH particles at the start, section y = 0")
        sections.plot_field(panels[2, 0], panels[2, 1], run, hot, "temperature", "y", "temperature [K]", liquidus)
        panels[2, 0].set_title(f"c  Temperature at {time:.0f} us, section y = 0; line: liquidus of 316L")
        top = sections.plot_field(panels[3, 0], panels[3, 1], run, last, "concentration", "y", "AlSi10Mg [wt%]",
                                  scale=100.0, floor=0.01)
        panels[3, 0].set_title(f"d  AlSi10Mg after solidification, at {cooled:.0f} us, section y = 0")
    panels[1, 0].set(xlim=panels[2, 0].get_xlim(), ylim=panels[2, 0].get_ylim())
    for axes in panels[:2, 1]:
        axes.axis("off")  # stays, so that all four panels are equally wide
    panels[1, 0].legend(loc="lower right", ncols=3, handlelength=1.2, frameon=True, framealpha=0.9)

    style.save(figure, given.output, "Powder bed and melt pool (the paper's Fig. 4)",
               f"Simulated, {100 * bed['additive_mass_fraction']:.3g} wt% AlSi10Mg, particle spacing {spacing:g} um. "
               f"The bed holds {len(radius)} spheres (median diameter {bed['d50'] / MICRON:.3g} um, packing "
               f"density {bed['packing_density']:.3f}, mean coordination {bed['mean_coordination']:.2f}). The "
               f"highest concentration in section d is {top:.3g} wt%.")


style.run(main)
