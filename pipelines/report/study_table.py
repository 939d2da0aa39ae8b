# SPDX-License-Identifier: GPL-3.0-or-later
"""The report's tables of studies, from studies.json of meltproof-studies and the committed results behind it."""

import functools
import hashlib
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from artifact import read_json, value  # noqa: E402

EXTENTS = ("length", "width", "depth")


# What a track run is made of: verification, tests and texts of the solver change no track.
TRACK_CODE = ("base", "solver", ":(exclude)solver/verification", ":(exclude)*_test.*", ":(exclude)*.md")


@functools.cache
def code_differs(one, other, root):
    """Whether the code that runs a track differs between two revisions; yes if that cannot be told."""
    if one == other:
        return False
    if None in (one, other) or "-dirty" in one + other:
        return True
    done = subprocess.run(["git", "diff", "--quiet", one, other, "--", *TRACK_CODE], cwd=root, capture_output=True)
    return done.returncode != 0


def is_stale(run, revision, root, witness=None):
    """Whether the code, or an input that the run read, has changed since. `witness` is that of the present program
    (pipelines/witness.py): where the run's is the same, other code has made the same numbers."""
    same_numbers = witness is not None and run.get("witness") == witness
    if not same_numbers and code_differs(run["revision"], revision, root):
        return True
    for entry in run["inputs"]:
        path = Path(root) / entry["path"]
        if path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() != entry["sha256"]:
            return True
    return False


def resolution_rows(entry):
    """One row per extent of a resolution: values from coarse to fine, behaviour, order, limit, uncertainty."""
    rows = []
    for extent in EXTENTS:
        found = entry["quantities"][extent]
        order = sorted(zip(found["spacings_um"], found["values_um"]), reverse=True)
        rows.append({"extent": extent, "values": order, "behaviour": found["behaviour"], "order": found["order"],
                     "extrapolated_um": found["extrapolated_um"], "u_base_um": found["u_base_um"],
                     "relative_u": found["relative_u"]})
    return rows


def input_rows(entry):
    """One row per extent of an input: what its runs did, the sensitivity and the share of u_input."""
    if "quantities" not in entry:
        return []
    rows = []
    for extent in EXTENTS:
        found = entry["quantities"][extent]
        rows.append({"extent": extent, "changes": found["changes"], "sensitivity": found["relative_sensitivity"],
                     "relative_u": found["relative_u"], "one_sided": found["one_sided"], "same_side": found["same_side"],
                     "left_out": found["left_out"]})
    return rows


def not_converging(resolutions):
    """The extents of the resolutions whose series has no order to extrapolate with, in words."""
    return [f"{entry['title'].lower()}: {row['extent']} {row['behaviour']}" for entry in resolutions
            for row in entry["rows"] if row["behaviour"] != "converges"]


def read_studies(path, revision, root, witness=None):
    """Resolutions, tables of sensitivity, inputs, and the shares of u_num and u_input, for the template.

    `revision` is the one that made the tracks of this report; a run of another one is marked stale, unless it has the
    same `witness`."""
    summary = read_json(path)
    by_name = {run["name"]: {**run, "stale": is_stale(run, revision, root, witness)}
               for run in value(summary, "runs", path)}
    resolutions, tables, inputs, missing = [], [], [], []
    for entry in value(summary, "series", path):
        missing += [name for name in entry["missing"] if name not in missing]
        runs = [by_name[name] for name in entry["runs"] if name in by_name]
        if entry["kind"] == "resolution":
            if not entry["missing"]:
                resolutions.append({**entry, "rows": resolution_rows(entry), "made": runs,
                                    "stale": any(run["stale"] for run in runs)})
        elif entry["kind"] == "input":
            inputs.append({**entry, "rows": input_rows(entry), "stale": any(run["stale"] for run in runs)})
        elif len(runs) > 1 and entry["base"] in by_name:
            base = by_name[entry["base"]]
            changed = [{**run, "is_base": run["name"] == entry["base"],
                        **{f"{extent}_change": run[f"{extent}_um"] / base[f"{extent}_um"] - 1 if base[f"{extent}_um"]
                           else None for extent in EXTENTS}} for run in runs]
            tables.append({**entry, "made": changed})
    return {"resolutions": resolutions, "tables": tables, "inputs": inputs, "input_sums": summary.get("inputs", {}),
            "not_converging": not_converging(resolutions), "missing": missing, "runs": list(by_name.values()),
            "quantities": value(summary, "quantities", path),
            "stale": [run["name"] for run in by_name.values() if run["stale"]]}
