# SPDX-License-Identifier: GPL-3.0-or-later
"""Rosenthal's pool of a moving point source on a half space: what conduction alone would make of a beam.

T - T0 = a P / (2 pi k R) exp(-v (R + x) / (2 alpha)), x from the source along the scan, R the distance to it
(Rosenthal 1946). Properties are constants; here k at the solidus, and c the mean of the enthalpy from T0 to the
solidus. No latent heat, no size of the beam, no flow.
"""

import sys
import tomllib
from math import exp, pi, sqrt
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from artifact import MissingArtifact, existing  # noqa: E402
from track import quantity  # noqa: E402


def number(text):
    """The number of a quantity such as `9.59 W m-1 K-1`; a bare number is itself."""
    return float(str(text).split()[0])


def conductivity(material, temperature):
    """k of the piece of the table that ends at, or holds, the temperature."""
    for piece in material["conductivity"]["piece"]:
        if number(piece["from"]) <= temperature <= number(piece["to"]) and "constant" in piece:
            return number(piece["constant"]) + number(piece.get("linear", 0)) * temperature
    raise MissingArtifact(f"{material['name']}: no conductivity is given at {temperature} K.")


def mean_specific_heat(material, lower, upper):
    gained = 0.0
    for piece in material["enthalpy"]["piece"]:
        start, end = max(lower, number(piece["from"])), min(upper, number(piece["to"]))
        gained += max(0.0, end - start) * number(piece["slope"])
    return gained / (upper - max(lower, number(material["enthalpy"]["piece"][0]["from"])))


def largest(function, lower, upper):
    """The largest value of a function with one maximum, by golden section."""
    golden = 0.5 * (sqrt(5) - 1)
    for _ in range(100):
        left, right = upper - golden * (upper - lower), lower + golden * (upper - lower)
        if function(left) > function(right):
            upper = right
        else:
            lower = left
    return function(0.5 * (lower + upper))


def pool(power, absorptivity, speed, k, alpha, rise):
    """Length, width and depth in m of the region that is warmer by at least `rise`, K."""
    strength = absorptivity * power / (2 * pi * k * rise)  # m: the tail, where T - T0 = a P / (2 pi k R)
    behind = strength

    def rise_over_limit(x, radius):
        return strength / radius * exp(-speed * (radius + x) / (2 * alpha))

    lower, upper = 1e-9, strength
    for _ in range(200):  # ahead of the source x = R
        middle = 0.5 * (lower + upper)
        if rise_over_limit(middle, middle) > 1:
            lower = middle
        else:
            upper = middle
    ahead = 0.5 * (lower + upper)

    def half_width(x):
        low, high = abs(x), abs(x) + strength
        for _ in range(100):
            radius = 0.5 * (low + high)
            if rise_over_limit(x, radius) > 1:
                low = radius
            else:
                high = radius
        return sqrt(max(0.0, low * low - x * x))

    half = largest(half_width, -behind, ahead)
    return behind + ahead, 2 * half, half


def of_track(resolved, root):
    """Rosenthal's length, width and depth in um for a resolved case, and the constants that were used."""
    path = Path(root) / resolved["materials"]["base"]
    with existing(path).open("rb") as file:
        material = tomllib.load(file)
    start = quantity(resolved["initial_temperature"])
    solidus, liquidus = number(material["solidus"]["value"]), number(material["liquidus"]["value"])
    outlined = quantity(resolved["output"].get("pool_temperature", 0)) or liquidus
    given = resolved["laser"].get("absorptivity", -1)
    absorptivity = float(given) if float(given) >= 0 else number(material["absorptivity"]["value"])
    k = conductivity(material, solidus)
    heat = mean_specific_heat(material, start, solidus)
    alpha = k / (number(material["density"]["value"]) * heat)
    length, width, depth = pool(quantity(resolved["laser"]["power"]), absorptivity, quantity(resolved["laser"]["speed"]),
                                k, alpha, outlined - start)
    return {"length_um": 1e6 * length, "width_um": 1e6 * width, "depth_um": 1e6 * depth, "k_W_m_K": k,
            "alpha_m2_s": alpha, "absorptivity": absorptivity}
