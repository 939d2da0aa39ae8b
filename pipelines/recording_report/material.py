# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the reference temperature that a material's file means, its liquidus, and whose value that is."""

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def refuse(sentence):
    print(f"make process: {sentence}", file=sys.stderr)
    sys.exit(2)


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
    liquidus = record.get("liquidus", {})
    value = liquidus.get("value") if isinstance(liquidus, dict) else None
    if not isinstance(value, str):
        refuse(f"MATERIAL '{named}': {path} has no liquidus with a value such as \"1683 K\".")
    print(value)
    print(f"The reference temperature is the liquidus of {record.get('name', path.stem)}, {value} "
          f"({path.name}; source: {liquidus.get('source', 'not said')}).")


main()
