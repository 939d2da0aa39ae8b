# SPDX-License-Identifier: GPL-3.0-or-later
"""Recomputes each number with which reports/template/errata.toml shows that the paper contradicts itself.

The constants are those that the paper prints (doi 10.3390/met11111842: equations, Tables 1, 3, A1, A2).
"""

import csv
from math import erf, erfc, exp, log, pi, sqrt
from pathlib import Path


GAS_CONSTANT = 8.314462618  # J/(mol K)


def quintic_slope(q):
    """dW/dq of the quintic spline in three dimensions, for h = 1 (norm 1/(120 pi))."""
    total = 0.0
    for knot, weight in ((3, 1), (2, -6), (1, 15)):
        if q < knot:
            total += -5 * weight * (knot - q) ** 4
    return total / (120 * pi)


def laplacian_of_x_squared(pair_factor):
    """sum_j V pair_factor F_ij (x_i^2 - x_j^2) on a cubic lattice with h = spacing = 1; exact is 2."""
    total = 0.0
    for x in range(-3, 4):
        for y in range(-3, 4):
            for z in range(-3, 4):
                square = x * x + y * y + z * z
                if 0 < square < 9:
                    r = sqrt(square)
                    total += pair_factor * r * quintic_slope(r) / (square + 0.01) * (0 - x * x)
    return total


def line(constant, slope, temperature):
    return constant + slope * temperature


def kanaya_okayama(atomic_weight, atomic_number, density, kilovolt):
    """Range of the electrons in um; density in g/cm3."""
    return 0.0276 * atomic_weight * kilovolt**1.67 / (atomic_number**0.89 * density)


def largest_measured_absorptivity(root):
    """Of the bare 316L tracks near the paper's setting; kept in data/experiments/tracks316l."""
    largest = 0.0
    for path in sorted((Path(root) / "data/experiments/tracks316l").glob("*.csv")):
        rows = csv.DictReader(line for line in path.read_text(encoding="utf-8").splitlines() if line[:1] != "#")
        for row in rows:
            cell = next((v for k, v in row.items() if k.startswith("absorptivity")), "")
            largest = max(largest, float(cell or 0))
    return largest


def numbers(root):
    """Every placeholder of errata.toml with its value."""
    z1, z2 = 44.0, 55.0
    middle, wide = 0.5 * (z1 + z2), 20.0
    solidus, liquidus = 1633.0, 1683.0
    aluminium, silicon, magnesium = 26.982, 28.086, 24.305
    shares = {aluminium: 0.8965, silicon: 0.10, magnesium: 0.0035}
    return {
        "laplacian_printed": laplacian_of_x_squared(4.0),
        "laplacian_consistent": laplacian_of_x_squared(2.0),
        "printed_spread_mm": 1e3 * sqrt(4 * 1e-4 * 1.0),
        "half_space_at_middle": 0.5 * erfc((z1 - middle) / wide),
        "stripe_at_middle": 0.5 * (erf((middle - z1) / wide) - erf((middle - z2) / wide)),
        "activation_kJ_mol": 26200 * GAS_CONSTANT / 1e3,
        "diffusivity_at_liquidus": 8.34e-5 * exp(-26200 / liquidus),
        "conductivity_jump_solidus": line(355.93, -196.90e-3, solidus) - line(9.59, 141e-4, solidus),
        "conductivity_jump_liquidus": line(6.60, 121.40e-4, liquidus) - line(355.93, -196.90e-3, liquidus),
        "enthalpy_jump_1132_kJ": (line(-374150, 714.29, 1132) - line(-138595, 458.93, 1132)) / 1e3,
        "enthalpy_crossing_K": (374150 - 138595) / (714.29 - 458.93),
        "enthalpy_jump_liquidus_kJ": (line(-336177.97, 847.46, liquidus) - line(-8181263, 5494.51, liquidus)) / 1e3,
        "al_enthalpy_jump_kJ": (line(140209.01, 909.09, 853) - line(-8243682.40, 10729.61, 853)) / 1e3,
        "al_enthalpy_zero_K": 230136.36 / 909.09,
        "steel_enthalpy_zero_K": 138595 / 458.93,
        "viscosity_zero_K": 1.95 / log(180.76 / 180.68),
        "molar_mass_as_sum": aluminium + 10 * silicon + magnesium,
        "molar_mass_average": 1 / sum(share / mass for mass, share in shares.items()),
        "track_um": 0.375 * 10.4e-4 * 1e6,
        "domain_mm3": 1.3e6 * (2e-3) ** 3,
        "range_iron_um": kanaya_okayama(55.845, 26, 7.874, 30),
        "range_aluminium_um": kanaya_okayama(aluminium, 13, 2.70, 30),
        "largest_absorptivity": largest_measured_absorptivity(root),
    }
