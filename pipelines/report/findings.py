# SPDX-License-Identifier: GPL-3.0-or-later
"""The report's findings: what the paper's doubtful points do to the result, each sentence made of numbers of artifacts.

A run that is not there is named; no word here says more than the numbers that stand beside it.
"""

import csv
import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "figures")]
from artifact import data, existing, open_artifact, snapshots  # noqa: E402
from rosenthal import conductivity, number  # noqa: E402

EXTENTS = ("length", "width", "depth")
CLUMPED = 0.01  # share above which a run does not count, as in meltproof-studies
TREND_ROWS = (("fig5_trend_pool", "the connected pool above the liquidus of 316L"),
              ("fig5_trend_any_liquid", "any liquid, each point above its own liquidus"))
CONTENTS = (0, 1, 5)
TREND_WORDS = {"rises": "rises beyond k u at every step", "falls": "falls beyond k u at one step or more",
               "undecided": "neither rises beyond k u at every step nor falls beyond it at any"}


def signed(share):
    return f"{100 * share:+.1f} %"


def conduction_of_content(root, content):
    """What mixing `content` (a mass fraction) of AlSi10Mg into 316L does to the tail of Rosenthal's pool, which is
    a P / (2 pi k (T_l - T0)): the changes by liquidus, absorptivity and conductivity, and all three, as shares."""
    material = {}
    for name in ("316L", "AlSi10Mg"):
        with existing(Path(root) / f"data/materials/{name}.toml").open("rb") as file:
            material[name] = tomllib.load(file)
    steel, alloy = material["316L"], material["AlSi10Mg"]

    def mixed(one, two):
        return (1 - content) * one + content * two

    start = 293.15
    liquidus = [number(m["liquidus"]["value"]) for m in (steel, alloy)]
    by_liquidus = (liquidus[0] - start) / (mixed(*liquidus) - start)
    absorbs = [number(m["absorptivity"]["value"]) for m in (steel, alloy)]
    by_absorptivity = mixed(*absorbs) / absorbs[0]
    conducts = [conductivity(m, t) for m, t in zip((steel, alloy), (liquidus[0], 1e3))]
    by_conductivity = conducts[0] / mixed(*conducts)
    return {"liquidus": by_liquidus - 1, "absorptivity": by_absorptivity - 1, "conductivity": by_conductivity - 1,
            "all": by_liquidus * by_absorptivity * by_conductivity - 1}


def additive_left(work, track="track_5wt"):
    """Mean share of the additive in all that ever melted, at the end of a run; None without the run."""
    path = Path(work) / track / "run.h5"
    if not path.is_file():
        return None
    with open_artifact(path, "meltproof run") as file:
        last = snapshots(file)[-1]
        melted = data(file, f"{last}/melted").astype(bool)
        return float(data(file, f"{last}/concentration")[melted].mean()) if melted.any() else None


def rise_of_length(rows, work, root):
    """Erratum 18: does the length rise with the additive content, by which definition, and why."""
    by_name = {row["name"]: row for row in rows}
    sentences, missing, differences = [], [], {}
    for name, words in TREND_ROWS:
        details = (by_name.get(name) or {}).get("details") or {}
        if "values" not in details:
            missing.append(words)
            continue
        lengths = ", ".join(f"{length:.0f} ± {u:.0f} um at {content} wt%" for content, length, u in
                            zip(CONTENTS, details["values"], details["uncertainties"]))
        row = by_name[name]
        sentences.append(f"Length of {words}: {lengths}; it {TREND_WORDS[details['trend']]} "
                         f"(smallest step {row['S']:+.0f} um, u {row['u_val']:.0f} um, k = {row['coverage']:g}). Measured is a "
                         f"rise, so this {row['verdict']}.")
        differences[name] = details["values"]
    if len(differences) == 2:
        beyond = ", ".join(f"{any_liquid - pool:.0f} um at {content} wt%" for content, pool, any_liquid in
                           zip(CONTENTS, *(differences[name] for name, _ in TREND_ROWS)))
        sentences.append(f"By the second definition, in which metal rich in AlSi10Mg counts below the liquidus of 316L, it is "
                         f"longer than by the first by {beyond}.")
    by = conduction_of_content(root, 0.05)
    sentences.append(
        f"Conduction alone: 5 wt%, fully mixed by the paper's rules, change the length of Rosenthal's pool by "
        f"{signed(by['liquidus'])} through the liquidus, {signed(by['absorptivity'])} through the absorptivity and "
        f"{signed(by['conductivity'])} through the conductivity, together {signed(by['all'])}.")
    left = additive_left(work)
    if left is not None:
        sentences.append(f"Of the 5 wt% in the powder {100 * left:.2g} wt% are left on average in all that melted.")
    return {"question": "Does the length rise with the additive content?", "erratum": 18, "sentences": sentences,
            "missing": missing}


def effect(run, base, u):
    """One sentence on a run against its base; `u` are relative numerical uncertainties by extent, or None."""
    if run["clumped_fraction"] >= CLUMPED:
        return (f"{run['title']}: its melt clumps ({100 * run['clumped_fraction']:.2g} % of it nearer than half a spacing), "
                "so its pool does not count.")
    parts = []
    for extent in EXTENTS:
        if not base[f"{extent}_um"]:
            continue
        change = run[f"{extent}_um"] / base[f"{extent}_um"] - 1
        judged = "" if u.get(extent) is None else (" (beyond 2 u_num)" if abs(change) > 2 * u[extent] else " (within 2 u_num)")
        parts.append(f"{extent} {base[f'{extent}_um']:.0f} to {run[f'{extent}_um']:.0f} um, {signed(change)}{judged}")
    return f"{run['title']}: {'; '.join(parts)}" + ("; stale." if run.get("stale") else ".")


def of_runs(question, erratum, base, names, studies, inputs=()):
    """A finding from runs of the studies against their base, and from the sensitivities of inputs."""
    runs = {run["name"]: run for run in studies["runs"]}
    u = {extent: found["relative_u"] for extent, found in studies["quantities"].items()}
    missing = [name for name in (base, *names) if name not in runs]
    sentences = [effect(runs[name], runs[base], u) for name in names if name in runs and base in runs]
    for entry in studies["inputs"]:
        if entry["name"] in inputs and entry["rows"]:
            parts = [f"{row['extent']} {row['sensitivity']:+.2f} % for 1 %" for row in entry["rows"]
                     if row["sensitivity"] is not None]
            if parts:
                sentences.append(f"Sensitivity to {entry['title'].lower()}: {', '.join(parts)}.")
    return {"question": question, "erratum": erratum, "sentences": sentences, "missing": missing}


def absorbed_light(studies, root):
    """Erratum 19: how much of the beam the simulation takes where reflected light is followed, against a measurement."""
    runs = {run["name"]: run for run in studies["runs"]}
    sentences, missing = [], []
    if "absorbed_share" in runs.get("ray_traced", {}):
        sentences.append(f"The paper's track on a bare plate then absorbs {100 * runs['ray_traced']['absorbed_share']:.0f} % of the "
                         "beam, 40 % at each hit.")
    path = Path(root) / "data/experiments/tracks316l/trapp2017.csv"
    with existing(path).open(encoding="utf-8", newline="") as file:
        measured = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for row in measured:
        run = runs.get(f"trapp_{row['power [W]']}W")
        if run is None or "absorbed_share" not in run:
            missing.append(f"trapp_{row['power [W]']}W")
            continue
        sentences.append(f"Bare 316L, {row['power [W]']} W, {row['speed [mm/s]']} mm/s, {row['spot [um]']} um spot: absorbed "
                         f"{100 * run['absorbed_share']:.0f} % (measured {100 * float(row['absorptivity [1]']):.0f} %), width "
                         f"{run['width_um']:.0f} um ({row['width [um]']}), depth {run['depth_um']:.0f} um ({row['depth [um]']})"
                         + ("; stale." if run.get("stale") else "."))
    if sentences:
        sentences.append("The measured numbers were digitised from a figure by a third party (Trapp et al. 2017), so no "
                         "uncertainty is known and no verdict is given.")
    return {"question": "What does the metal absorb if reflected light is followed?", "erratum": 19, "sentences": sentences,
            "missing": missing}


def findings(rows, studies, work, root):
    """All findings in the order of the report; `studies` as read_studies() gives them."""
    return [
        rise_of_length(rows, work, root),
        of_runs("How far does the absorptivity change the result?", 19, "base",
                ["absorptivity_low", "absorptivity_high", "absorptivity_06", "ray_traced"], studies, ["absorptivity"]),
        absorbed_light(studies, root),
        of_runs("How far does the viscosity factor of 20?", 12, "base",
                ["viscosity_low", "viscosity_high", "viscosity_5", "viscosity_1"], studies, ["viscosity_factor"]),
        of_runs("How far does the law of diffusivity?", 7, "powder_1wt_10", ["diffusivity_liquid"], studies),
        of_runs("How far do the density of AlSi10Mg and its molar mass?", 14, "powder_1wt_10",
                ["density_own", "molar_mass_as_printed"], studies)]
