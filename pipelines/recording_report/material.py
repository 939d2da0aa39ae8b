# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints what a material's file tells a measurement, three lines: the reference temperature, which is its liquidus; its
freezing heat, or nothing where the file lacks what that takes; and a sentence on whose values these are.

Freezing heat: the heat that the alloy gives off from liquidus to solidus, over specific heat times liquidus. The
enthalpy's slope between the two holds the latent heat and what cools the metal through that range, and both belong to
it. The specific heat is the mean of those on either side: the field that the tail is fitted by runs through both.
"""

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
KELVIN, HEAT = {"K"}, {"J kg-1 K-1", "J/(kg K)"}


class Missing(Exception):
    """What the freezing heat lacks, a clause."""


def refuse(sentence):
    print(f"make process: {sentence}", file=sys.stderr)
    sys.exit(2)


def number(entry, units, name):
    """The number in a text such as "1683 K"."""
    if not isinstance(entry, str):
        raise Missing(f"it has no {name}")
    content, _, unit = entry.strip().partition(" ")
    try:
        value = float(content)
    except ValueError:
        value = 0
    if not 0 < value < float("inf") or unit.strip() not in units:
        raise Missing(f"its {name} is \"{entry}\", where a positive number in {min(units)} is expected")
    return value


def table(record, name):
    return record[name] if isinstance(record.get(name), dict) else {}


def freezing_heat(record):
    """The freezing heat and what it was computed from. @raises Missing"""
    liquidus = number(table(record, "liquidus").get("value"), KELVIN, "liquidus")
    solidus = number(table(record, "solidus").get("value"), KELVIN, "solidus")
    if not solidus < liquidus:
        raise Missing("its solidus is not below its liquidus")
    pieces = table(record, "enthalpy").get("piece")
    if not isinstance(pieces, list) or not all(isinstance(p, dict) for p in pieces):
        raise Missing("it has no enthalpy by pieces")
    slopes = [(number(p.get("from"), KELVIN, "enthalpy.piece.from"), number(p.get("to"), KELVIN, "enthalpy.piece.to"),
               number(p.get("slope"), HEAT, "enthalpy.piece.slope")) for p in pieces]
    solid = [c for low, high, c in slopes if low < solidus <= high]
    liquid = [c for low, high, c in slopes if low <= liquidus < high]
    if not solid or not liquid:
        raise Missing("its enthalpy does not reach beyond solidus and liquidus")
    inside = [(min(high, liquidus) - max(low, solidus), c) for low, high, c in slopes if low < liquidus and high > solidus]
    if abs(sum(width for width, _ in inside) - (liquidus - solidus)) > 1e-6 * liquidus:
        raise Missing("its enthalpy has a gap between solidus and liquidus")
    heat = sum(width * c for width, c in inside)
    specific = 0.5 * (solid[0] + liquid[0])
    return heat / (specific * liquidus), (
        f"{heat / 1e3:.4g} kJ/kg between solidus ({solidus:g} K) and liquidus, over {specific:.4g} J/(kg K), the mean "
        f"specific heat of the solid ({solid[0]:.4g}) and the liquid ({liquid[0]:.4g}) beside that range, times the "
        "liquidus")


def main():
    named = sys.argv[1]
    shipped = ROOT / "data/materials"
    path = next((p for p in (Path(named), shipped / named, shipped / f"{named}.toml") if p.is_file()), None)
    if path is None:
        known = ", ".join(sorted(p.stem for p in shipped.glob("*.toml") if "[liquidus]" in p.read_text(encoding="utf-8")))
        refuse(f"MATERIAL '{named}' is neither a file nor a material of data/materials (there are {known}).")
    try:
        record = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as problem:
        refuse(f"MATERIAL '{named}': {path} is no TOML file ({problem}).")
    liquidus = table(record, "liquidus")
    value = liquidus.get("value")
    if not isinstance(value, str):
        refuse(f"MATERIAL '{named}': {path} has no liquidus with a value such as \"1683 K\".")
    words = (f"The reference temperature is the liquidus of {record.get('name', path.stem)}, {value} "
             f"({path.name}; source: {liquidus.get('source', 'not said')}).")
    try:
        heat, how = freezing_heat(record)
    except Missing as lack:
        print(f"{value}\n\n{words} Its freezing heat, which would narrow the reference signal S*, was not handed on, "
              f"since {path.name} says too little: {lack}.")
        return
    print(f"{value}\n{heat:.4g}\n{words} Its freezing heat is {heat:.3g}: {how} (enthalpy of {path.name}).")


main()
