# SPDX-License-Identifier: GPL-3.0-or-later
"""Plane sections through a run, each particle drawn as the square that it stands for."""

import artifact
import numpy as np
import style
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.tri import Triangulation

MICRON = 1e-6
AXES = {"x": 0, "y": 1, "z": 2}


def last_hot(run):
    """The last snapshot with more than half the largest amount of liquid: the pool before the beam goes off."""
    names = artifact.snapshots(run)
    liquid = [float(artifact.data(run, f"{name}/liquid_fraction").sum()) for name in names]
    if max(liquid) == 0:
        raise artifact.MissingArtifact(f"{run.filename} holds no snapshot with liquid metal.")
    lit = [index for index, amount in enumerate(liquid) if amount > 0.5 * max(liquid)]
    return names[lit[-1]]


def slice_of(run, snapshot, normal, at=0.0):
    """Indices of the particles of the layer nearest to the plane, and the two axes in the plane."""
    position = artifact.data(run, f"{snapshot}/position")
    half = 0.5 * artifact.scalar(run, "spacing")
    across = position[:, AXES[normal]]
    nearest = across[np.argmin(np.abs(across - at))]
    chosen = np.flatnonzero(np.abs(across - nearest) <= half)
    first, second = (axis for axis in "xyz" if axis != normal)
    return chosen, position[chosen, AXES[first]] / MICRON, position[chosen, AXES[second]] / MICRON, first, second


def squares(horizontal, vertical, side):
    corners = 0.5 * side * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    return np.column_stack([horizontal, vertical])[:, None, :] + corners[None, :, :]


def frame(axes, horizontal, vertical, side, first, second):
    label = {"x": "scan direction x [um]", "y": "y [um]", "z": "height z [um]"}
    axes.set(xlim=(horizontal.min() - side / 2, horizontal.max() + side / 2),
             ylim=(vertical.min() - side / 2, vertical.max() + side / 2), aspect="equal",
             xlabel=label[first], ylabel=label[second])
    axes.grid(False)


def plot_origin(axes, run, snapshot, normal, looks):
    """Where each particle comes from; `looks` are (name, colour) of plate, base powder, additive powder."""
    chosen, horizontal, vertical, first, second = slice_of(run, snapshot, normal)
    side = artifact.scalar(run, "spacing") / MICRON
    origin = artifact.data(run, f"{snapshot}/origin")[chosen]
    for number, (name, colour) in enumerate(looks):
        picked = origin == number
        axes.add_collection(PolyCollection(squares(horizontal[picked], vertical[picked], side), facecolor=colour,
                                           edgecolor="white", linewidth=0.15, label=name))
    frame(axes, horizontal, vertical, side, first, second)


def plot_field(axes, bar_axes, run, snapshot, field, normal, label, contour=None, scale=1.0, at=0.0):
    """One field in a section, its colours explained in `bar_axes`, with the contour line of one value; returns
    the largest value shown."""
    chosen, horizontal, vertical, first, second = slice_of(run, snapshot, normal, at)
    side = artifact.scalar(run, "spacing") / MICRON
    values = scale * artifact.data(run, f"{snapshot}/{field}")[chosen]
    colours = PolyCollection(squares(horizontal, vertical, side), array=values, cmap=style.FIELD_COLOURS,
                             norm=Normalize(values.min(), max(values.max(), values.min() + 1e-9)),
                             edgecolor="face", linewidth=0.2)
    axes.add_collection(colours)
    frame(axes, horizontal, vertical, side, first, second)
    if contour is not None and values.min() < contour < values.max():
        grid = Triangulation(horizontal, vertical)
        corners = np.stack([horizontal[grid.triangles], vertical[grid.triangles]], axis=2)
        longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        grid.set_mask(longest > 2.0 * side)  # no line across gaps between grains
        axes.tricontour(grid, values, levels=[contour], colors="white", linewidths=1.4)
        axes.tricontour(grid, values, levels=[contour], colors="black", linewidths=0.5, linestyles="--")
    axes.figure.colorbar(colours, cax=bar_axes, label=label)
    return float(values.max())
