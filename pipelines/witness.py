#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a short track with everything switched on and keeps the SHA-256 of its history: the witness of a program.

Two programs with the same witness compute the same track to the last printed digit, so what one of them made is not
stale because the code of the other reads differently. The flow of a melt is chaotic: a change in any sum shows within
a few steps. Processors with other instruction sets may round otherwise, so witnesses of different machines say nothing.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "figures"))
from artifact import MissingArtifact  # noqa: E402

POWDER = "powder_1wt"
TRACK = ["solver/cases/track_1wt.toml", "--set", "spacing=20 um", "--set", "laser.exposure=150 us",
         "--set", "domain.depth=140 um", "--set", "domain.width=240 um", "--set", "domain.before=80 um",
         "--set", "domain.behind=80 um", "--set", "output.averaging_window=100 us"]


def run(command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    if done.returncode != 0:
        said = (done.stderr or done.stdout).strip().splitlines()
        raise MissingArtifact(f"the witness of {command[0]} ended with status {done.returncode}: "
                              f"{said[-1] if said else 'it said nothing'}")


def witness(solver, powder):
    """The SHA-256 of history.csv, as hexadecimal digits; `solver` and `powder` are the programs."""
    with tempfile.TemporaryDirectory() as folder:
        bed = Path(folder) / "powder.h5"
        run([powder, f"solver/cases/{POWDER}.toml", "--output", bed])
        run([solver, *TRACK, "--powder", bed, "--output", folder, "--threads", "1", "-q"])
        return hashlib.sha256((Path(folder) / "history.csv").read_bytes()).hexdigest()


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--solver", required=True, help="meltproof-solve")
    arguments.add_argument("--powder", required=True, help="meltproof-powder")
    arguments.add_argument("--output", required=True, help="the JSON file to write")
    given = arguments.parse_args()
    partial = Path(given.output).with_suffix(".tmp")
    partial.write_text(json.dumps({"witness": witness(given.solver, given.powder)}) + "\n", encoding="utf-8")
    os.replace(partial, given.output)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except MissingArtifact as problem:
        print(f"witness.py: error: {problem}", file=sys.stderr)
        sys.exit(2)
