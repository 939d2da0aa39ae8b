# SPDX-License-Identifier: GPL-3.0-or-later
"""Joins what the programs of `make bench` measured into one file and prints it as a table.

Each part is the result of meltproof-bench, or what Google Benchmark writes with --benchmark_out. The table of
figures (pipelines/bench.toml) says what is asked of each and where it comes from. A figure that no part holds has
the value null and says why. Speed is reported, never judged: the status is 0 whether or not targets are met.

Example: bench.py pipelines/bench.toml step.json pairs.json imaging.json --output reports/bench.json
"""

import argparse
import json
import os
import platform
import sys
import tomllib
from datetime import datetime, timezone
from pathlib import Path
from statistics import median
from textwrap import wrap

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bench_scaling import scaling, scaling_lines  # noqa: E402

KEYS = {"key", "unit", "how", "at_least", "at_most", "rate", "scale", "per_counter", "over", "counter", "pending"}


class BadInput(Exception):
    """What the user gave cannot be used; the message is a sentence."""


def read_json(path):
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as problem:
        raise BadInput(f"{path} cannot be read: {problem.strerror}") from problem
    except ValueError as problem:
        raise BadInput(f"{path} is no JSON ({problem}); measure it again") from problem


def read_table(path):
    try:
        table = tomllib.loads(Path(path).read_text(encoding="utf-8")).get("figure", [])
    except OSError as problem:
        raise BadInput(f"{path} cannot be read: {problem.strerror}") from problem
    except tomllib.TOMLDecodeError as problem:
        raise BadInput(f"{path}: {problem}") from problem
    for row in table:
        if "key" not in row or "unit" not in row:
            raise BadInput(f"{path}: a figure needs key and unit, found {row}")
        if unknown := set(row) - KEYS:
            raise BadInput(f"{path}: {row['key']} has the unknown key {sorted(unknown)[0]}; "
                           f"known are {', '.join(sorted(KEYS))}")
    return table


class Parts:
    """Everything that was measured: figures by key, and repeats of benchmarks by name in their order."""

    def __init__(self, paths):
        self.figures, self.benchmarks, self.details = {}, {}, {}
        self.lanes = self.provenance = None
        for path in paths:
            part = read_json(path)
            if "figures" in part:
                self.figures |= part["figures"]
                self.details |= part.get("details", {})
                self.lanes, self.provenance = part.get("lanes"), part.get("provenance")
            elif "benchmarks" in part:
                for run in part["benchmarks"]:
                    if run.get("error_occurred"):
                        raise BadInput(f"{path}: {run['name']}: {run['error_message']}")
                    if run["run_type"] == "iteration":
                        name = run["name"].removesuffix("/real_time")
                        self.benchmarks.setdefault(name, []).append(run)
            else:
                raise BadInput(f"{path} holds neither figures of meltproof-bench nor benchmarks")
        for runs in self.benchmarks.values():
            runs.sort(key=lambda run: run["repetition_index"])

    def repeats(self, row):
        """The repeats of a figure, or nothing. Those of a ratio are of neighbouring measurements."""
        if "rate" not in row:
            return self.figures.get(row["key"], {}).get("repeats")
        runs = self.benchmarks.get(row["rate"])
        other = self.benchmarks.get(row["over"]) if "over" in row else None
        if not runs or ("over" in row and not other):
            return None
        if "counter" in row:
            return [run[row["counter"]] for run in runs]
        values = [run["items_per_second"] * row.get("scale", 1) for run in runs]
        if "per_counter" in row:
            values = [value / run[row["per_counter"]] for value, run in zip(values, runs)]
        if other:
            values = [value / run["items_per_second"] for value, run in zip(values, other)]
        return values


def figure(row, parts):
    made = {"value": None, "unit": row["unit"]}
    made |= {name: row[name] for name in ("at_least", "at_most") if name in row}
    repeats = parts.repeats(row)
    if not repeats:
        return made | {"met": None, "pending": row.get("pending", "no part that was measured holds it")}
    value = median(repeats)
    met = None
    if "at_least" in row or "at_most" in row:
        met = row.get("at_least", value) <= value <= row.get("at_most", value)
    return made | {"value": value, "met": met, "min": min(repeats), "median": value, "max": max(repeats),
                   "repeats": repeats, "how": row.get("how") or parts.figures.get(row["key"], {}).get("how", "")}


def processor():
    information = Path("/proc/cpuinfo")
    for line in information.read_text().splitlines() if information.exists() else []:
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def joined(table, parts):
    provenance = parts.provenance or {}
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
    return {
        "date": datetime.fromtimestamp(epoch, timezone.utc).strftime("%Y-%m-%d"),
        "date_is": "of the last commit (SOURCE_DATE_EPOCH)",
        "revision": provenance.get("revision"),
        "machine": {"processor": processor(), "cores": os.cpu_count(), "lanes_f64": parts.lanes,
                    "load_average_1min": round(os.getloadavg()[0], 2),
                    "compiler": provenance.get("libraries", {}).get("compiler")},
        "figures": {row["key"]: figure(row, parts) for row in table},
        "scaling": scaling(parts.details),
        "details": parts.details,
        "benchmarks": {name: [{key: run[key] for key in ("items_per_second", "real_time", "cpu_time", "time_unit")}
                              for run in runs] for name, runs in parts.benchmarks.items()},
        "provenance": provenance,
    }


def short(value):
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def asked(made):
    if "at_least" in made:
        return f">= {short(made['at_least'])}"
    return f"<= {short(made['at_most'])}" if "at_most" in made else "-"


def words(made):
    return {True: "met", False: "not met", None: "-" if made["value"] is not None else "pending"}[made["met"]]


def table_text(result):
    rows = [("figure", "median", "min ... max", "asked", "")]
    for key, made in result["figures"].items():
        if made["value"] is None:
            rows.append((key, "-", "-", asked(made), made["pending"]))
        else:
            rows.append((key, short(made["value"]), f"{short(made['min'])} ... {short(made['max'])}", asked(made),
                         words(made)))
    widths = [max(len(row[column]) for row in rows) for column in range(4)]
    lines = ["  ".join([row[0].ljust(widths[0]), *(row[c].rjust(widths[c]) for c in (1, 2, 3)), row[4]]).rstrip()
             for row in rows]
    step = result["details"].get("step", {})
    for name, title in (("as_tracks_run", "as tracks run"), ("nothing_skipped", "nothing skipped"),
                        ("everything_computed", "everything computed")):
        if shares := step.get(name, {}).get("share_of_time"):
            lines.append(f"time of a step, {title}: " + ", ".join(
                f"{part} {100 * share:.0f} %" for part, share in sorted(shares.items(), key=lambda s: -s[1])))
    if result["scaling"]:
        lines += scaling_lines(result["scaling"])
    machine = result["machine"]
    text = (f"{machine['processor']}, {machine['cores']} cores, {machine['lanes_f64']} doubles a lane, load "
            f"{machine['load_average_1min']} as it ended. What else the machine does slows all of it down: "
            "believe ratios of one run, and the spread.")
    return "\n".join(lines + wrap(text, 110))


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("table", help="the table of figures (TOML)")
    arguments.add_argument("parts", nargs="+", help="results of the programs (JSON)")
    arguments.add_argument("--output", required=True, type=Path, help="file to write (JSON)")
    given = arguments.parse_args()
    result = joined(read_table(given.table), Parts(given.parts))
    given.output.parent.mkdir(parents=True, exist_ok=True)
    partial = given.output.with_suffix(".tmp")
    partial.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    os.replace(partial, given.output)
    print(table_text(result))


if __name__ == "__main__":
    try:
        main()
    except BadInput as problem:
        print(f"bench: error: {problem}", file=sys.stderr)
        sys.exit(2)
