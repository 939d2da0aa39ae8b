# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 4 of the paper: the powder bed, the melt pool in two sections, and the AlSi10Mg concentration."""

import argparse

import artifact
import matplotlib.pyplot as plt
import numpy as np
import sections
import style

MICRON = 1e-6
MATERIALS = [("316L", "#bdbdbd", ""), ("AlSi10Mg", style.ORANGE, "////")]


def plot_powder(axes, path):
    """Every sphere from above, the higher over the lower; returns the facts for the caption."""
    with artifact.open_artifact(path, "meltproof powder bed") as bed:
        centre = artifact.data(bed, "spheres/centre") / MICRON
        radius = artifact.data(bed, "spheres/radius") / MICRON
        material = artifact.data(bed, "spheres/material")
        lower, upper = artifact.data(bed, "box/lower") / MICRON, artifact.data(bed, "box/upper") / MICRON
        facts = {name: artifact.scalar(bed, name) for name in
                 ("packing_density", "mean_coordination", "additive_mass_fraction", "d50")}
    for index in np.argsort(centre[:, 2], kind="stable"):
        _, colour, hatch = MATERIALS[int(material[index])]
        axes.add_patch(plt.Circle(centre[index, :2], radius[index], facecolor=colour, hatch=hatch,
                                  edgecolor="black", linewidth=0.3))
    for name, colour, hatch in MATERIALS:
        axes.add_patch(plt.Circle((0, 0), 0, facecolor=colour, hatch=hatch, edgecolor="black", linewidth=0.3,
                                  label=name))
    axes.set(xlim=(lower[0], upper[0]), ylim=(lower[1], upper[1]), aspect="equal", xlabel="scan direction x [um]",
             ylabel="y [um]")
    axes.grid(False)
    axes.legend(loc="upper right", frameon=True, framealpha=0.9, handlelength=1.2)
    facts["spheres"] = len(radius)
    return facts


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("powder", help="powder.h5")
    arguments.add_argument("run", help="run.h5")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    figure, panels = plt.subplots(4, 1, figsize=(style.PAGE_WIDTH, 7.6), height_ratios=[1.15, 1, 1, 1])
    bed = plot_powder(panels[0], given.powder)
    panels[0].set_title("a  Powder bed from above, before the beam")

    with artifact.open_artifact(given.run, "meltproof run") as run:
        liquidus = artifact.scalar(run, "reference_temperature")
        spacing = artifact.scalar(run, "spacing") / MICRON
        before, hot = artifact.snapshots(run)[0], sections.last_with_beam(run)
        time = artifact.scalar(run, f"{hot}/time")
        panels[1].set_title("b  Powder and plate as SPH particles in the section y = 0, at the start")
        sections.plot_origin(panels[1], run, before, "y", MATERIALS)
        panels[2].set_title(f"c  Temperature in the section y = 0 at {1e6 * time:.0f} us; white line: liquidus of 316L")
        sections.plot_field(figure, panels[2], run, hot, "temperature", "y", "temperature [K]", contour=liquidus)
        last = artifact.snapshots(run)[-1]
        cooled = artifact.scalar(run, f"{last}/time")
        panels[3].set_title(f"d  AlSi10Mg concentration in the section y = 0 at {1e6 * cooled:.0f} us, after solidification")
        top = sections.plot_field(figure, panels[3], run, last, "concentration", "y", "AlSi10Mg [wt%]", scale=100.0)

    style.save(figure, given.output, "Powder bed and melt pool (the paper's Fig. 4)",
               f"Simulated, {100 * bed['additive_mass_fraction']:.3g} wt% AlSi10Mg, particle spacing {spacing:g} um. "
               f"The bed holds {bed['spheres']} spheres (median diameter {bed['d50'] / MICRON:.3g} um, packing "
               f"density {bed['packing_density']:.3f}, mean coordination {bed['mean_coordination']:.2f}). The "
               f"highest concentration in section d is {top:.3g} wt%. Particles do not move in this version: "
               "the molten grains keep their places.")


style.run(main)
