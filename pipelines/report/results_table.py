# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the table of results on the terminal; status 1 if something is not as the suite declares it."""

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from artifact import MissingArtifact, read_json, value  # noqa: E402


def columns(rows):
    """Rows of cells as lines with aligned columns; the last column is as long as it likes."""
    widths = [max(len(row[index]) for row in rows) for index in range(len(rows[0]) - 1)]
    return ["  " + "  ".join([cell.ljust(width) for cell, width in zip(row, widths)] + [row[-1]]).rstrip()
            for row in rows]


def print_verification(path):
    """The cases with exact solutions; returns the names of those that miss what is asked."""
    cases = value(read_json(path), "cases", path)
    rows = [("verification", "error", "asked", "order", "")]
    for case in cases:
        order = f"{case['order']:.2f}" if case.get("order") is not None else "-"
        rows.append((case["name"], f"{100 * case['error']:.2g} %", f"{100 * case['asked']:.2g} %", order,
                     "met" if case["pass"] else "MISSED"))
    print("\n".join(columns(rows)))
    return [f"{case['name']} misses the error asked of it" for case in cases if not case["pass"]]


def print_comparisons(path):
    """The comparisons with measurements, and of what is asked of every run the rows that fail; returns the
    failures of the table."""
    comparison = read_json(path)
    rows = [("comparison", "verdict", "finding")]
    waiting = held = 0
    for row in value(comparison, "rows", path):
        if row["verdict"] == "pending" and row.get("waits_for") == "simulation" and row.get("S") is None:
            waiting += 1
        elif row["kind"] == "verification":
            of_a_track = "file" in row.get("simulated", {})
            held += of_a_track and row["verdict"] == "agrees"
            if of_a_track and row["verdict"] != "agrees":
                rows.append((row["name"], row["verdict"], row["finding"]))
        else:
            rows.append((row["name"], row["verdict"], row["finding"]))
    print()
    print("\n".join(columns(rows)))
    print(f"  and {held} balances and acceptance tests of the tracks are held.")
    if waiting:
        print(f"  {waiting} comparisons wait for simulations.")
    return comparison.get("failures", [])


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--verification", required=True)
    arguments.add_argument("--comparison")
    arguments.add_argument("--report", help="the report whose place is printed at the end")
    given = arguments.parse_args()

    failures = print_verification(given.verification)
    if given.comparison:
        # Every case is a row of the comparisons too, where what is known of it is declared.
        failures = print_comparisons(given.comparison)
    if given.report:
        print(f"\nThe report is {given.report}, and {Path(given.report).with_suffix('.html')} for a browser.")
    for failure in failures:
        print(f"not as declared: {failure}", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except MissingArtifact as problem:
        print(f"results_table.py: error: {problem}", file=sys.stderr)
        sys.exit(2)
