# SPDX-License-Identifier: GPL-3.0-or-later
"""What the files of one simulated track say: means over the window in which its pool is measured."""

import math
import tomllib
from pathlib import Path

import artifact
import numpy as np

UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "m": 1.0, "um": 1e-6, "W": 1.0, "K": 1.0, "1": 1.0, "m s-1": 1.0, "m/s": 1.0}


def resolved_input(folder):
    """input.toml of a run: the case with all defaults."""
    path = artifact.existing(Path(folder) / "input.toml")
    with path.open("rb") as file:
        return tomllib.load(file)


def quantity(text, path="input.toml"):
    """A number with its unit, as a resolved input writes it, in SI."""
    if not isinstance(text, str):
        return float(text)
    number, _, unit = text.partition(" ")
    if unit not in UNITS:
        raise artifact.MissingArtifact(f"{path} holds the unit `{unit}`, which is not known here.")
    return float(number) * UNITS[unit]


def window_of(given):
    """Beginning and end of the averaging window in us, from a resolved input."""
    exposure = 1e6 * quantity(given["laser"]["exposure"])
    return max(0.0, exposure - 1e6 * quantity(given["output"]["averaging_window"])), exposure


def window_mean(table, name, window, path="history.csv"):
    """Mean and sample standard deviation of a column of history.csv over the window; None if it is not there."""
    if not any(header.split(" [")[0] == name for header in table):
        return None, None
    time = artifact.column(table, "time", path)
    inside = (time >= window[0] - 1e-6) & (time <= window[1] + 1e-6)
    values = artifact.column(table, name, path)[inside]
    if values.size == 0:
        return None, None
    return float(values.mean()), float(values.std(ddof=1)) if values.size > 1 else 0.0


def flow_numbers(folder, result):
    """Speeds, peak temperature and evaporated share of a track, from its history; missing ones are None."""
    folder = Path(folder)
    path = folder / "history.csv"
    table = artifact.read_table(path)
    window = window_of(resolved_input(folder)) if (folder / "input.toml").is_file() else (0.0, math.inf)
    speed, _ = window_mean(table, "mean_speed", window, path)
    fastest, _ = window_mean(table, "largest_speed", window, path)
    peak, peak_sd = window_mean(table, "peak_temperature", window, path)
    absorbed = result.get("energy_absorbed_J")
    evaporated = result.get("energy_evaporated_J")
    return {"mean_speed_m_s": speed, "largest_speed_m_s": fastest, "peak_temperature_K": peak,
            "peak_temperature_sd_K": peak_sd,
            "evaporated_share": evaporated / absorbed if absorbed and evaporated is not None else None}


def still_growing(state):
    """`steady`, or the limit that the length tends to with its uncertainty, or why neither is known: a text."""
    if not state:
        return None
    if state.get("steady"):
        return "steady"
    if "limit_um" in state:
        return f"{state['verdict']}; tends to {state['limit_um']:.0f} ± {state['u_limit_um']:.0f} um"
    return state["verdict"]


def finite(number):
    return number is not None and np.isfinite(number)
