# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the runs of pipelines/studies.toml one after another and keeps a small result of each.

A run that has its result is not made again, so the job can be stopped and started at will; --again renews
those that other code has made, unless its witness (witness.py) is the same. The results are small, are committed, and say which revision made them.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "figures"))
sys.path.insert(0, str(Path(__file__).resolve().parent))
from artifact import MissingArtifact, read_json  # noqa: E402
from track import flow_numbers  # noqa: E402
from witness import witness  # noqa: E402

EXTENTS = ("pool_length", "pool_width", "pool_depth", "any_liquid_length")


def solver_revision(solver):
    """The revision that a program says it was built from; None if it does not say."""
    said = subprocess.run([solver, "--version"], capture_output=True, text=True)
    found = re.search(r"\b([0-9a-f]{7,40}(?:-dirty)?)\b", said.stdout)
    return found.group(1) if found else None


def small_result(run, folder, seconds):
    """What is kept of a run: its pool, its acceptance, its limiters, and where it comes from."""
    result = read_json(folder / "result.json")
    kept = {"name": run["name"], "title": run["title"], "track": run["track"], "settings": run.get("set", []),
            "spacing_um": result["spacing_um"], "particles": result["particles"], "steps": result["steps"]}
    for extent in EXTENTS:
        name = extent.removeprefix("pool_")
        kept[f"{name}_um"] = result[f"{extent}_um"]
        kept[f"{name}_sd_um"] = result[f"{extent}_sd_um"]
    kept["window"] = result["window"]
    kept["steady_state"] = result.get("steady_state", {}).get("pool_length")
    kept.update(flow_numbers(folder, result))
    acceptance = result.get("acceptance", {})
    # The melt clumps; what has frozen keeps its distance, so over all that ever melted the share is diluted.
    kept["clumped_fraction"] = max(acceptance.get("liquid", {}).get("clumped_fraction_mean", 0.0),
                                   acceptance.get("ever_melted", {}).get("clumped_fraction", 0.0))
    kept["acceptance"] = acceptance
    kept["limiters"] = result.get("limiters", {})
    kept["energy_relative_error"] = result["energy_relative_error"]
    beam = [result[f"energy_{way}_J"] for way in ("absorbed", "reflected", "missed")]
    kept["absorbed_share"] = beam[0] / sum(beam)
    kept["seconds"] = seconds
    made = result["provenance"]
    kept["threads"], kept["revision"], kept["inputs"] = made["threads"], result["revision"], made["inputs"]
    return kept


def powder_bed(given, name, folder):
    """The powder bed of a case, made once."""
    place = folder / f"{name}.h5"
    if name and not place.is_file():
        subprocess.run([given.powder, f"solver/cases/{name}.toml", "--output", place], check=True, capture_output=True)
    return place


def make(given, run):
    """One run from case to small result; returns what it kept."""
    folder = Path(given.work) / run["name"]
    folder.mkdir(parents=True, exist_ok=True)
    command = [given.solver, f"solver/cases/{run['track']}.toml", "--output", str(folder), "--threads",
               str(given.threads)]
    for setting in [*run.get("set", []), *given.set]:
        command += ["--set", setting]
    if run.get("powder"):
        command += ["--powder", str(powder_bed(given, run["powder"], Path(given.work)))]
    started = time.monotonic()
    with (folder / "log.txt").open("w") as log:
        done = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT,
                              env={**os.environ, "OMP_NUM_THREADS": str(given.threads)})
    if done.returncode != 0:
        last = (folder / "log.txt").read_text(encoding="utf-8").strip().splitlines()
        raise MissingArtifact(f"the run {run['name']} ended with status {done.returncode}: "
                              f"{last[-1] if last else 'it said nothing'} (all of it in {folder / 'log.txt'})")
    kept = small_result(run, folder, time.monotonic() - started)
    kept["witness"] = given.witness
    place = Path(given.results) / f"{run['name']}.json"
    place.parent.mkdir(parents=True, exist_ok=True)
    partial = place.with_suffix(".tmp")
    partial.write_text(json.dumps(kept, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    os.replace(partial, place)
    return kept


def to_do(given, runs):
    """The runs that are wanted, in their order, and the number of those that are there already."""
    revision = solver_revision(given.solver)
    wanted, there = [], 0
    for run in runs:
        place = Path(given.results) / f"{run['name']}.json"
        kept = read_json(place) if place.is_file() else None
        finished = kept is not None and kept.get("settings") == run.get("set", []) and not (
            given.again and kept.get("revision") != revision and kept.get("witness") != given.witness)
        there += finished
        if not finished and (not given.only or run["name"] in given.only):
            wanted.append(run)
    return wanted, there


def clock(seconds):
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min"


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("declaration", help="pipelines/studies.toml")
    arguments.add_argument("--solver", required=True, help="meltproof-solve")
    arguments.add_argument("--powder", required=True, help="meltproof-powder")
    arguments.add_argument("--work", required=True, help="folder for whole runs, which are not kept")
    arguments.add_argument("--results", required=True, help="folder for the small results")
    arguments.add_argument("--jobs", type=int, default=1, help="runs at a time")
    arguments.add_argument("--threads", type=int, default=1, help="threads of each run")
    arguments.add_argument("--only", action="append", default=[], help="only this run; may be repeated")
    arguments.add_argument("--set", action="append", default=[], help="further override of every run, for trials")
    arguments.add_argument("--again", action="store_true", help="renew also what other code has made")
    given = arguments.parse_args()

    with open(given.declaration, "rb") as file:
        runs = tomllib.load(file)["run"]
    unknown = set(given.only) - {run["name"] for run in runs}
    if unknown:
        raise MissingArtifact(f"{given.declaration} declares no run {', '.join(sorted(unknown))}.")
    given.witness = witness(given.solver, given.powder)
    wanted, there = to_do(given, runs)
    if not wanted:
        print(f"nothing to do: all {there} results of the studies are in {given.results}")
        return 0
    print(f"studies: {len(wanted)} runs to make, {there} are there", flush=True)
    Path(given.work).mkdir(parents=True, exist_ok=True)
    for name in sorted({run["powder"] for run in wanted if run.get("powder")}):
        powder_bed(given, name, Path(given.work))
    failures, started = [], time.monotonic()
    with ThreadPoolExecutor(max_workers=given.jobs) as pool:
        waiting = {pool.submit(make, given, run): run for run in wanted}
        for count, ended in enumerate(as_completed(waiting), 1):
            run = waiting[ended]
            passed = time.monotonic() - started
            left = f"{count} of {len(wanted)}, about {clock(passed / count * (len(wanted) - count))} left"
            try:
                kept = ended.result()
                print(f"  {run['name']}: length {kept['length_um']:.0f}, width {kept['width_um']:.0f}, depth "
                      f"{kept['depth_um']:.0f} um, {clock(kept['seconds'])} ({left})", flush=True)
            except (MissingArtifact, OSError, KeyError, subprocess.CalledProcessError) as problem:
                failures.append(run["name"])
                print(f"studies.py: error: {problem}", file=sys.stderr, flush=True)
    if failures:
        print(f"studies.py: {len(failures)} of {len(wanted)} runs failed: {', '.join(failures)}; the others are kept. "
              "The job goes on where it stopped.", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except MissingArtifact as problem:
        print(f"studies.py: error: {problem}", file=sys.stderr)
        sys.exit(2)
