# SPDX-License-Identifier: GPL-3.0-or-later
"""Plane sections through a run: particles as the squares that they stand for, fields as pixels."""

import artifact
import numpy as np
import style
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm, Normalize

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


def raster(run, snapshot, field, normal, at=0.0, scale=1.0):
    """A field in a plane as pixels of a quarter of the spacing: the mean of the particles within 1.5 spacings, weighted by
    (1 - (r / 1.5 spacings)^2)^2; NaN where the nearest is further than 0.87 spacings, half the diagonal of a lattice
    cell, so that a lattice is filled and a gap is not. Returns values (rows from below), the extent in um, the axes."""
    position = artifact.data(run, f"{snapshot}/position") / MICRON
    side = artifact.scalar(run, "spacing") / MICRON
    first, second = (axis for axis in "xyz" if axis != normal)
    reach, pixel = 1.5 * side, 0.25 * side
    across = position[:, AXES[normal]] - at / MICRON
    near = np.abs(across) < reach
    if not near.any():
        raise artifact.MissingArtifact(f"{run.filename} holds no particle near the plane {normal} = {at / MICRON:g} um.")
    across, u, v = across[near], position[near, AXES[first]], position[near, AXES[second]]
    value = scale * artifact.data(run, f"{snapshot}/{field}")[near].astype(float)
    left, below = u.min() - side / 2, v.min() - side / 2
    columns, rows = (int(round((top + side / 2 - start) / pixel)) for top, start in ((u.max(), left), (v.max(), below)))
    weights, sums = np.zeros(rows * columns), np.zeros(rows * columns)
    nearest = np.full(rows * columns, np.inf)
    column, row = np.floor((u - left) / pixel).astype(int), np.floor((v - below) / pixel).astype(int)
    steps = range(-int(reach / pixel) - 1, int(reach / pixel) + 2)
    for dx in steps:
        for dy in steps:
            i, j = column + dx, row + dy
            square = ((left + (i + 0.5) * pixel - u) ** 2 + (below + (j + 0.5) * pixel - v) ** 2 + across**2) / reach**2
            used = (square < 1) & (i >= 0) & (i < columns) & (j >= 0) & (j < rows)
            place = j[used] * columns + i[used]
            weight = (1 - square[used]) ** 2
            weights += np.bincount(place, weight, minlength=weights.size)
            sums += np.bincount(place, weight * value[used], minlength=sums.size)
            np.minimum.at(nearest, place, square[used])
    filled = nearest <= (0.87 * side / reach) ** 2
    values = np.where(filled, sums / np.where(filled, weights, 1), np.nan).reshape(rows, columns)
    return values, (left, left + columns * pixel, below, below + rows * pixel), first, second


def plot_field(axes, bar_axes, run, snapshot, field, normal, label, contour=None, scale=1.0, at=0.0, floor=None):
    """One field in a section, its colours explained in `bar_axes`, with the contour line of one value; returns
    the largest value shown. With a `floor` the colours are logarithmic from there on, and what is less has the
    floor's colour."""
    values, extent, first, second = raster(run, snapshot, field, normal, at, scale)
    lowest, highest = np.nanmin(values), np.nanmax(values)
    norm = Normalize(lowest, max(highest, lowest + 1e-9))
    if floor is not None:
        values = np.maximum(values, floor)  # what is no metal stays no number
        norm = LogNorm(floor, max(highest, 10 * floor))
    colours = axes.imshow(values, extent=extent, origin="lower", cmap=style.FIELD_COLOURS, interpolation="nearest",
                          norm=norm)
    names = {"x": "scan direction x [um]", "y": "y [um]", "z": "height z [um]"}
    axes.set(xlim=extent[:2], ylim=extent[2:], aspect="equal", xlabel=names[first], ylabel=names[second])
    axes.grid(False)
    if contour is not None and lowest < contour < highest:
        line = {"levels": [contour], "extent": extent, "origin": "lower"}
        axes.contour(values, colors="white", linewidths=1.4, **line)
        axes.contour(values, colors="black", linewidths=0.5, linestyles="--", **line)
    axes.figure.colorbar(colours, cax=bar_axes, label=label, extend="neither" if floor is None else "min")
    return float(highest)
