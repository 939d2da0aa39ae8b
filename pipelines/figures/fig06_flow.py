# SPDX-License-Identifier: GPL-3.0-or-later
"""The melt in motion: sections along the pool with velocities, and of the track that it leaves."""

import argparse

import artifact
import matplotlib.pyplot as plt
import numpy as np
import sections
import style

MICRON = 1e-6
LIQUID = 1  # of the field `phase`
BEFORE, AHEAD, BELOW = 380.0, 80.0, 150.0  # um around the beam that the section along the pool shows


def plot_velocity(axes, run, snapshot):
    """Arrows of the melt in the section y = 0, each the mean over a cell of two spacings; returns the highest speed of
    a particle within one spacing of the section, m/s."""
    position = artifact.data(run, f"{snapshot}/position") / MICRON
    side = artifact.scalar(run, "spacing") / MICRON
    melt = (artifact.data(run, f"{snapshot}/phase") == LIQUID) & (np.abs(position[:, 1]) <= side)
    if not melt.any():
        raise artifact.MissingArtifact(f"{run.filename} holds no melt near y = 0 in {snapshot}.")
    position, velocity = position[melt], artifact.data(run, f"{snapshot}/velocity")[melt]
    cells, cell = np.unique(np.floor(position[:, [0, 2]] / (2 * side)).astype(int), axis=0, return_inverse=True)
    count = np.bincount(cell)
    mean = [np.bincount(cell, weights=quantity) / count
            for quantity in (position[:, 0], position[:, 2], velocity[:, 0], velocity[:, 2])]
    fastest = float(np.hypot(mean[2], mean[3]).max())
    # The longest arrow spans three cells, so that none hides more than its neighbour.
    reference = max(0.1, float(f"{0.5 * fastest:.1g}"))
    arrows = axes.quiver(*mean, color="white", edgecolor="black", linewidth=0.4, units="x", angles="xy", scale_units="x",
                         scale=max(fastest, 0.1) / (6 * side), width=2.2, headwidth=3.4, headlength=3.8, zorder=5)
    axes.quiverkey(arrows, 0.08, 0.12, reference, f"{reference:g} m/s", labelpos="E", coordinates="axes",
                   fontproperties={"size": 7}, labelcolor="white")
    return float(np.linalg.norm(velocity, axis=1).max())


def plate_line(axes):
    axes.axhline(0, color="black", linewidth=0.7, linestyle=":", zorder=6)


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("run", help="run.h5 of a track that flows")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    with artifact.open_artifact(given.run, "meltproof run") as run:
        title = artifact.text(run.attrs["title"]) if "title" in run.attrs else "track"
        spacing = artifact.scalar(run, "spacing") / MICRON
        liquidus = artifact.scalar(run, "reference_temperature")
        lower, upper = (artifact.data(run, f"domain/{side}") / MICRON for side in ("lower", "upper"))
        hot, last = sections.last_hot(run), artifact.snapshots(run)[-1]
        beam = float(artifact.data(run, f"{hot}/beam")[0]) / MICRON
        time, end = (1e6 * artifact.scalar(run, f"{name}/time") for name in (hot, last))
        track = 1e6 * artifact.scalar(run, "scan_speed") * artifact.scalar(run, "exposure")

        figure, panels = plt.subplots(3, 2, figsize=(style.PAGE_WIDTH, 6.4), width_ratios=[36, 1],
                                      height_ratios=[11, 8, 11])
        sections.plot_field(panels[0, 0], panels[0, 1], run, hot, "temperature", "y", "temperature [K]", liquidus)
        fastest = plot_velocity(panels[0, 0], run, hot)
        panels[0, 0].axvline(beam, color="black", linewidth=0.8, linestyle="-.", zorder=6)
        panels[0, 0].set(xlim=(max(lower[0], beam - BEFORE), min(upper[0], beam + AHEAD)), ylim=(-BELOW, None))
        panels[0, 0].set_title(f"a  Melt and its velocity at {time:.0f} us, section y = 0; dashed line: liquidus; "
                               "chain line: beam")
        sections.plot_field(panels[1, 0], panels[1, 1], run, last, "peak_temperature", "y", "highest\ntemperature [K]",
                            liquidus)
        panels[1, 0].set(ylim=(-BELOW, None))
        panels[1, 0].set_title(f"b  The solidified track at {end:.0f} us, section y = 0")
        sections.plot_field(panels[2, 0], panels[2, 1], run, last, "peak_temperature", "x", "highest\ntemperature [K]",
                            liquidus, at=0.6e-6 * track)
        panels[2, 0].set(xlim=(-BELOW, BELOW), ylim=(-BELOW, None))
        panels[2, 0].set_title(f"c  The same across the track, x = {0.6 * track:.0f} um")
    for axes in panels[:, 0]:
        plate_line(axes)

    style.save(figure, given.output, "The melt in motion, and the track that it leaves",
               f"Simulated, {title}, particle spacing {spacing:g} um. Arrows: velocity of the melt in the section, mean over cells "
               f"of two spacings; the fastest particle there moves at {fastest:.1f} m/s. Dotted line: the surface of the plate at the start. Under "
               "the beam the recoil of the vapour holds a depression open; sections b and c show how far the melt has closed it.")


style.run(main)
