# SPDX-License-Identifier: GPL-3.0-or-later
"""How the melt pool grows: length against time with what it tends to, width and depth, temperature, speed."""

import argparse
from pathlib import Path

import artifact
import matplotlib.pyplot as plt
import numpy as np
import style


def has(table, name):
    return any(header.split(" [")[0] == name for header in table)


def plot_limit(axes, time, state, look):
    """The fitted L(t) as a thin line and what it tends to with its standard uncertainty as a bar at the right."""
    limit, u, tau = state["limit_um"], state["u_limit_um"], state["time_constant_us"]
    axes.plot(time, limit * (1 - np.exp(-time / tau)), color=look["color"], linewidth=0.6)
    axes.errorbar([1.03 * time.max()], [limit], yerr=[u], color=look["color"], marker=look["marker"], fillstyle="none",
                  capsize=2, linewidth=0.8, clip_on=False)


def sentence(result):
    """What is known of the steadiness of a track's length."""
    state = result.get("steady_state", {}).get("pool_length")
    if not state:
        growth = result.get("pool_length_growth_um_per_ms")
        return f"it grows by {growth:+.0f} um/ms in the averaging window" if growth is not None else "not judged"
    if "limit_um" in state:
        return f"{state['verdict']}, tends to {state['limit_um']:.0f} ± {state['u_limit_um']:.0f} um"
    return state["verdict"]


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("results", nargs="+", help="result.json of each track; history.csv stands beside it")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    figure, panels = plt.subplots(3, 2, figsize=(style.PAGE_WIDTH, 5.2), height_ratios=[6, 6, 1])
    lengths, extents, temperatures, speeds, explained, unused = panels.flat
    unused.remove()
    explained.axis("off")
    sentences = []
    for look, path in zip(style.SERIES, given.results):
        result = artifact.read_json(path)
        table_path = Path(path).parent / "history.csv"
        table = artifact.read_table(table_path)
        time = artifact.column(table, "time", table_path)
        plain = {"markevery": max(1, len(time) // 8), "fillstyle": "none",
                 **{key: look[key] for key in ("color", "linestyle", "marker")}}
        lengths.plot(time, artifact.column(table, "pool_length", table_path), label=result["title"], **plain)
        state = result.get("steady_state", {}).get("pool_length", {})
        if "limit_um" in state:
            plot_limit(lengths, time, state, look)
        extents.plot(time, artifact.column(table, "pool_width", table_path), **plain)
        extents.plot(time, -artifact.column(table, "pool_depth", table_path), **plain)
        temperatures.plot(time, artifact.column(table, "peak_temperature", table_path), **plain)
        if has(table, "mean_speed"):
            speeds.plot(time, artifact.column(table, "mean_speed", table_path), **plain)
        sentences.append(f"{result['title']}: {sentence(result)}")
    lengths.set(xlabel="time [us]", ylabel="length [um]", ylim=(0, None))
    lengths.set_title("a  Length of the connected pool")
    extents.axhline(0, color="black", linewidth=0.6)
    extents.set(xlabel="time [us]", ylabel="width (up), depth (down) [um]")
    extents.set_title("b  Width and depth of the connected pool")
    temperatures.set(xlabel="time [us]", ylabel="peak temperature [K]", ylim=(0, None))
    temperatures.set_title("c  Highest temperature")
    speeds.set(xlabel="time [us]", ylabel="mean speed [m/s]", ylim=(0, None))
    speeds.set_title("d  Mean speed of the melt")
    key = explained.legend(*lengths.get_legend_handles_labels(), loc="center left", ncols=2, fontsize=6.5)
    key.set_in_layout(False)  # it may use the width of both columns
    style.save(figure, given.output, "The melt pool in time",
               "Simulated. Whether a pool is steady is a claim to be tested: the length of each pool, its start left out, is judged "
               "with its correlated scatter; where it still grows, the thin line is a fit of "
               "L(t) = L_inf (1 - exp(-t/tau)) and the mark at the right is L_inf with its standard uncertainty. "
               + "; ".join(sentences) + ".")


style.run(main)
