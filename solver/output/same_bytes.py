# SPDX-License-Identifier: GPL-3.0-or-later
"""A small track with the full physics on, and whether two runs of it hold the same bytes."""

import os
import subprocess
from pathlib import Path

import h5py

BIN = Path(os.environ["MELTPROOF_BIN"])
CASE = [BIN / "meltproof-solve", "solver/cases/track_1wt.toml", "--set", "powder.surface=bare", "--set", "spacing=14 um",
        "--set", "laser.exposure=100 us", "--set", "domain.width=224 um", "--set", "domain.depth=112 um",
        "--set", "domain.before=84 um", "--set", "domain.behind=84 um", "--set", "output.averaging_window=50 us",
        "--set", "output.cooling_limit=60 us", "--set", "output.frame_rate=40 kHz"]


def command(folder, *options):
    return [str(part) for part in (*CASE, "--output", folder, *options)]


def launcher(ranks):
    """mpirun, which tests must let start as root and on too few cores; nothing for 0 ranks."""
    return ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n", str(ranks)] if ranks else []


def environment(ranks):
    found = dict(os.environ)
    if ranks:
        # Ranks that wait for a core must not hold one.
        found.update(OMPI_MCA_btl_vader_single_copy_mechanism="none", OMPI_MCA_mpi_yield_when_idle="1",
                     OMP_WAIT_POLICY="passive")
    return found


def run_case(folder, *options, ranks=0, **more):
    return subprocess.run(launcher(ranks) + command(folder, *options), capture_output=True, text=True,
                          env=environment(ranks), **more)


def fields(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()].tobytes()}) if hasattr(item, "shape") else None)
    return {name: content for name, content in found.items() if not name.startswith("provenance")}


def assert_same(test, whole, folder):
    """Every field of every snapshot, the history, and that there are the same files."""
    one, other = fields(whole / "run.h5"), fields(folder / "run.h5")
    test.assertGreater(len(one), 60)
    test.assertEqual(one.keys(), other.keys())
    for name, content in one.items():
        test.assertEqual(content, other[name], name)
    test.assertEqual((whole / "history.csv").read_bytes(), (folder / "history.csv").read_bytes())
    names = {path.name for path in folder.iterdir()}
    test.assertEqual(names, {path.name for path in whole.iterdir()}, "nothing is left behind")
