# SPDX-License-Identifier: GPL-3.0-or-later
"""Small synthetic artifacts in the form of the real ones, for the tests of figures and report.

Nothing here is a simulation or a measurement, and nothing here ever reaches a report: tests write them
into a temporary folder and throw them away.
"""

import csv
import json
import math
from pathlib import Path

import h5py
import numpy as np

MICRON = 1e-6
PROVENANCE = {"program": "synthetic", "command": "synthetic", "inputs": [], "libraries": {}, "seed": 1,
              "threads": 1, "ranks": 1, "wall_time_s": 1.0, "revision": "synthetic"}


def put(file, name, values, units="1", description="synthetic, for a test"):
    data_set = file.create_dataset(name, data=values)
    data_set.attrs["units"], data_set.attrs["description"] = units, description


def powder(path, additive_mass_fraction=0.05, seed=1):
    rng = np.random.default_rng(seed)
    count = 60
    radius = rng.lognormal(math.log(7 * MICRON), 0.3, count)
    centre = np.column_stack([rng.uniform(0, 390, count), rng.uniform(-60, 60, count), np.zeros(count)]) * MICRON
    centre[:, 2] = radius
    with h5py.File(path, "w") as file:
        file.attrs["kind"] = "meltproof powder bed"
        put(file, "spheres/centre", centre, "m")
        put(file, "spheres/radius", radius, "m")
        put(file, "spheres/material", (rng.random(count) < 0.2).astype("i4"))
        put(file, "spheres/coordination", np.full(count, 3, "i4"))
        put(file, "box/lower", np.array([0, -60, 0]) * MICRON, "m")
        put(file, "box/upper", np.array([390, 60, 20]) * MICRON, "m")
        for name, number in (("packing_density", 0.5), ("mean_coordination", 3.0),
                             ("additive_mass_fraction", additive_mass_fraction)):
            put(file, name, number)
        for name, number in (("d10", 9), ("d50", 13.7), ("d90", 20)):
            put(file, name, number * MICRON, "m")
        for name in ("program", "revision", "inputs", "libraries"):
            content = PROVENANCE[name]
            file.require_group("provenance").attrs[name] = content if isinstance(content, str) else json.dumps(content)
        put(file, "provenance/threads", 1.0)
        put(file, "provenance/wall_time", 1.0, "s")


def run(folder, additive_mass_fraction=0.05, spacing_um=15.0, powder_layer=True):
    """run.h5, history.csv and result.json of a made-up moving ellipsoid."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    axes = [np.arange(0, 390, spacing_um), np.arange(-97.5, 98, spacing_um), np.arange(-112.5, 15, spacing_um)]
    x, y, z = (grid.ravel() for grid in np.meshgrid(*axes, indexing="ij"))
    position = np.column_stack([x, y, z]) * MICRON
    origin = np.where(z > 0, 1 + (np.sin(x) > 0.6), 0).astype("i4")
    with h5py.File(folder / "run.h5", "w") as file:
        file.attrs["kind"] = "meltproof run"
        for name, number, units in (("spacing", spacing_um * MICRON, "m"), ("smoothing_length", spacing_um * MICRON, "m"),
                                    ("scan_speed", 0.375, "m s-1"), ("laser_power", 175.0, "W"), ("exposure", 1.04e-3, "s"),
                                    ("beam_radius", 40 * MICRON, "m"),
                                    ("additive_mass_fraction", additive_mass_fraction, "1"),
                                    ("reference_temperature", 1683.0, "K"), ("initial_temperature", 300.0, "K")):
            put(file, name, number, units)
        put(file, "domain/lower", position.min(axis=0), "m")
        put(file, "domain/upper", position.max(axis=0), "m")
        ever = np.zeros(len(x), bool)
        for step in range(6):
            beam_x = 60 + 50 * step
            heat = 0.0 if step == 5 else 2600.0
            distance = ((x - beam_x + 60) / 130) ** 2 + (y / 65) ** 2 + (z / 60) ** 2
            temperature = 300 + heat * np.exp(-0.6 * distance)
            ever |= temperature > 1683
            group = f"snapshots/{step:04d}"
            put(file, f"{group}/time", step / 9762.5, "s")
            put(file, f"{group}/beam", np.array([beam_x, 0, 0]) * MICRON, "m")
            put(file, f"{group}/position", position, "m")
            put(file, f"{group}/temperature", temperature, "K")
            put(file, f"{group}/concentration", np.where(origin == 2, 0.8, 0.01) * (additive_mass_fraction > 0))
            put(file, f"{group}/liquid_fraction", (temperature > 1683).astype(float))
            put(file, f"{group}/phase", (temperature > 1683).astype("u1"))
            put(file, f"{group}/velocity", np.column_stack([np.cos(x / 30), 0 * y, np.sin(x / 30)])
                * (temperature > 1683)[:, None], "m s-1")
            put(file, f"{group}/identity", np.arange(len(x), dtype="i8"))
            put(file, f"{group}/origin", origin)
            put(file, f"{group}/melted", ever.astype("u1"))
            put(file, f"{group}/peak_temperature", np.where(ever, 2500.0, 900.0), "K")
    with (folder / "history.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time [us]", "dt [us]", "pool_length [um]", "pool_width [um]", "pool_depth [um]",
                         "any_liquid_length [um]", "peak_temperature [K]", "largest_speed [m/s]", "mean_speed [m/s]"])
        for time in range(0, 1000, 20):
            grown = 1 - math.exp(-time / 300)
            writer.writerow([time, 1, 250 * grown, 120 * grown, 60 * grown, 260 * grown, 2900, 2.5, 0.4])
    (folder / "input.toml").write_text(
        'initial_temperature = "293.15 K"\n[materials]\nbase = "data/materials/316L.toml"\n[laser]\npower = "175 W"\n'
        'speed = "0.375 m s-1"\nexposure = "0.00098 s"\nabsorptivity = -1\n'
        '[output]\naveraging_window = "0.0002 s"\npool_temperature = "0 K"\n')
    distances = {"clumped_fraction": 0.002, "smallest_spacings": 0.6, "filled_relative_error": -0.02}
    case = f"track_{100 * additive_mass_fraction:.0f}wt" if powder_layer else "track_316L_175W_750"
    (folder / "result.json").write_text(json.dumps({
        "case": case, "spacing_um": spacing_um, "additive_wt_percent": 100 * additive_mass_fraction,
        "pool_length_um": 250.0, "pool_width_um": 120.0, "pool_depth_um": 60.0,
        "pool_length_sd_um": 9.0, "pool_width_sd_um": 4.0, "pool_depth_sd_um": 3.0, "any_liquid_length_um": 260.0,
        "any_liquid_length_sd_um": 11.0, "pool_length_growth_um_per_ms": 20.0, "fusion_width_um": 118.0,
        "fusion_depth_um": 58.0, "title": "synthetic", "end_time_us": 1200.0, "all_solid_at_end": True,
        "energy_absorbed_J": 0.07, "energy_evaporated_J": 0.004,
        "steady_state": {"pool_length": {"verdict": "growing", "steady": False, "limit_um": 252.0, "u_limit_um": 4.0,
                                         "time_constant_us": 300.0}},
        "limiters": {"wall_pressure_clipped": 10, "wall_particle_steps": 1000, "curvature_held": 0,
                     "liquid_particle_steps": 1000},
        "acceptance": {"pass": True, "lost_particles": 0, "liquid": {**distances, "clumped_fraction_mean": 0.002}, "ever_melted": distances,
                       "asked": {"clumped_fraction_below": 0.01, "filled_relative_error_within": 0.05,
                                 "refilled_mean_height_above_um": -spacing_um},
                       "refilled_track": {"mean_height_um": -2.0, "deepest_point_um": -20.0}},
        "provenance": PROVENANCE, "energy_relative_error": 1e-12, "species_relative_error": 1e-15,
        "particles": len(x), "steps": 1000, "wall_time_s": 12.0, "revision": "synthetic", "window": "a synthetic window"}))


def recording(path, seed=2):
    rng = np.random.default_rng(seed)
    rows, columns = np.mgrid[0:40, 0:96]
    frames = [300 + 9000 * np.exp(-((columns - 20 - 4 * k) / 8) ** 2 - ((rows - 20) / 4) ** 2)
              + rng.normal(0, 20, (40, 96)) for k in range(8)]
    with h5py.File(path, "w") as file:
        file.attrs["kind"] = "meltproof recording"
        file.attrs["quantity"], file.attrs["synthetic"] = "counts", "made up for a test"
        put(file, "frames", np.clip(frames, 0, 16383).astype("u2"), "count")
        put(file, "time", np.arange(8) / 9762.5, "s")
        for name, number, units in (("integration_time", 2e-5, "s"), ("frame_rate", 9762.5, "Hz"),
                                    ("pixel_size", 17.6e-6, "m"), ("saturation_count", 16383, "count")):
            put(file, name, number, units)


def verification(path, profiles):
    profiles = Path(profiles)
    profiles.mkdir(parents=True, exist_ok=True)
    cases = []
    for name, kind in (("species_stripe_2um", "species_stripe"), ("species_stripe_20um", "species_stripe"),
                       ("species_stripe_as_printed", "species_stripe"), ("conduction_slab", "conduction_slab"),
                       ("conduction_contact", "conduction_contact"), ("stefan_0.1", "stefan"),
                       ("stefan_0.5", "stefan"), ("stefan_1", "stefan"), ("couette", "channel"),
                       ("laplace_drop_3d", "laplace_drop"), ("oscillating_drop", "oscillating_drop")):
        table = profiles / name / "profile.csv"
        table.parent.mkdir(exist_ok=True)
        with table.open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["spacing [um]", "position [um]", "value [1]", "exact [1]"])
            for spacing in (1, 2, 4):
                for position in range(0, 101, spacing):
                    exact = math.exp(-((position - 50) / 10) ** 2)
                    writer.writerow([spacing, position, exact * (1 + 0.005 * spacing ** 2), exact])
        cases.append({"name": name, "kind": kind, "title": name.replace("_", " ") + " (synthetic)",
                      "reference": "synthetic", "quantity": "synthetic", "error": 0.005, "asked": 0.01, "order": 2.0,
                      "pass": True, "extra": {"synthetic_extra": 0.25}, "broken": [], "spacings_um": [1, 2, 4], "errors": [0.005, 0.02, 0.08],
                      "profile": {"position": "position [um]", "value": "value [1]"}, "profile_csv": str(table)})
    Path(path).write_text(json.dumps({"cases": cases, "provenance": PROVENANCE}))


def thermography(folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "summary.json").write_text(json.dumps({
        "recording": "recording.h5", "frames": 8, "width": 96, "height": 40, "frame_rate": 9762.5,
        "quantity": "counts", "synthetic": "made up for a test", "melt_pool_found": True,
        "level": {"value": 4000.0, "unit": "count", "kind": "synthetic", "how": "synthetic",
                  "reference_temperature_K": 1683.0},
        "pixel_size_um": {"x": 17.6, "y": 17.6, "u_x": 0.0, "u_y": 0.0},
        "length_um": {"mean": 255.0, "sd": 8.0, "n": 6, "n_effective": 5.0, "u_mean": 4.0},
        "depth_um": {"mean": 58.0, "sd": 5.0, "n": 6, "n_effective": 5.0, "u_mean": 3.0},
        "frames_used": "synthetic", "shown_frame": 5, "provenance": PROVENANCE}))
    with (folder / "frames.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["frame [1]", "time [s]", "found [1]", "length [um]", "status [text]"])
        for k in range(8):
            writer.writerow([k, k / 9762.5, int(k > 1), 30 * k if k > 1 else "", "complete" if k > 1 else "no pool"])


def linescan(path, direction):
    position = [0.25 * k for k in range(81)]
    raw = [1.0 if abs(x - 10) < 5 else 0.0 for x in position]
    seen = [math.exp(-((x - 10) / 5) ** 2) for x in position]
    raw[-4:] = seen[-4:] = [None] * 4  # as where the line leaves the metal
    Path(path).write_text(json.dumps({
        "status": "pending", "line": {"direction": direction, "time_us": 1200.0, "spacing_um": 15.0},
        "grain": {"centre_um": [200.0, 50.0, 10.0], "edge_distance_um": 9.0, "particles": 3, "rule": "synthetic"},
        "interaction": {"voltage_kV": 30.0, "range_um": 2.45, "sigma_um": 1.04, "rule": "synthetic"},
        "simulated": {"position_um": position, "concentration": raw, "concentration_seen": seen},
        "measured": None, "metrics": None, "provenance": PROVENANCE}))


def comparison(path):
    row = {"name": "fig5_length_5wt", "title": "Synthetic row", "kind": "validation", "quantity": "length",
           "window": "synthetic", "metric": "difference", "rule": "synthetic", "rule_reason": "synthetic",
           "coverage": 2, "S": 255.0, "D": None, "E": None, "u_num": None, "u_input": None, "u_D": None,
           "u_val": None, "unit": "um", "verdict": "pending", "declared": "pending", "waits_for": "reference",
           "reason": "synthetic", "finding": "synthetic", "figure": "fig05_length", "source": None,
           "lower": None, "upper": None, "details": {}, "failure": None, "limit": None}
    row["simulated"] = {"file": "track_316L_175W_750/result.json", "value": "/x"}
    width = dict(row, name="bare_316l_width", title="Synthetic width", S=118.0, D=127.7, E=-9.7, u_val=8.4, u_D=8.4,
                 verdict="agrees", declared="agrees", waits_for=None, quantity="width")
    depth = dict(width, name="bare_316l_depth", title="Synthetic depth", S=20.0, D=58.8, E=-38.8, u_val=17.6,
                 u_D=17.6, verdict="differs", declared="differs", quantity="depth")
    # Of another file than the table of tracks shows, so that one row of a quantity stands alone there.
    second = dict(width, name="synthetic_second", title="Synthetic second", S=150.0, D=148.0, E=2.0, u_val=9.0, u_D=5.0,
                  u_num=4.0, u_input=6.0, simulated={"file": "none/result.json", "value": "/x"})
    lost = dict(row, name="lost_track_5wt", title="Synthetic loss", kind="verification", metric="number", S=0, D=None,
                verdict="agrees", declared="agrees", waits_for=None, quantity="lost particles")
    Path(path).write_text(json.dumps({
        "profile": "smoke", "rows": [row, width, depth, second, lost], "failures": [], "provenance": PROVENANCE,
        "statistics": [{"quantity": quantity, "points": points, "bias": 0.97, "model_scatter": 0.05, "measured_scatter": 0.04,
                        "scatter_is_noise": False} for quantity, points in (("all", 3), ("width", 2))],
        "summary": {"agrees": 3, "differs": 1, "pending": 1, "not computed": 0}}))


def studies(path):
    """A resolution of order 1, one numerical choice and three inputs, as meltproof-studies would summarise them."""
    def run(name, spacing, size, clumped=0.0):
        return {"name": name, "title": f"synthetic {name}", "spacing_um": spacing, "clumped_fraction": clumped,
                **{f"{extent}_{part}": number for extent, scale in (("length", 3), ("width", 1), ("depth", 1))
                   for part, number in (("um", scale * size), ("sd_um", 2.0))},
                "peak_temperature_K": 3400.0, "largest_speed_m_s": 2.0, "evaporated_share": 0.05, "seconds": 60.0,
                "revision": "synthetic", "inputs": []}

    def resolved(scale):
        return {"behaviour": "converges", "spacings_um": [7, 10, 14], "values_um": [scale * v for v in (107, 110, 114)],
                "order": 1.0, "order_used": 1.0, "extrapolated_um": 100.0 * scale, "u_um": [4.4, 6.2, 8.8],
                "u_base_um": 6.2, "relative_u": 0.057}

    def varied(name, slope, share, runs, missing=(), same_side=False, changes=(("0.36", -0.08), ("0.44", 0.08))):
        entry = {"name": name, "title": f"Synthetic {name}", "kind": "input", "runs": ["base", *runs], **common,
                 "missing": list(missing),
                 "input": {"key": f"synthetic.{name}", "value_text": "0.4" if slope else "", "u_text": "0.05" if slope else "",
                           "value": 0.4 if slope else None, "unit": "1" if slope else None, "reason": "synthetic reason",
                           "relative_uncertainty": 0.125 if slope else None, "logarithmic": False}}
        if not missing:
            effect = {"changes": [{"run": run, "setting": setting, "change": change} for run, (setting, change) in
                                  zip(runs, changes)], "relative_sensitivity": slope, "relative_u": share,
                      "one_sided": len(runs) == 1, "same_side": same_side, "left_out": []}
            entry["quantities"] = {extent: effect for extent in extents}
        return entry

    extents = {"length": 3, "width": 1, "depth": 1}
    common = {"base": "base", "about": "synthetic", "counted": True, "missing": []}
    Path(path).write_text(json.dumps({
        "profile": "desk", "runs": [run("spacing_14", 14, 114), run("base", 10, 110), run("spacing_7", 7, 107),
                                    run("none", 10, 130, 0.4), run("input_low", 10, 101), run("input_high", 10, 119),
                                    run("other_law", 10, 113)],
        "series": [
            {"name": "resolution", "title": "Synthetic resolution", "kind": "resolution",
             "runs": ["spacing_14", "base", "spacing_7"], **common,
             "quantities": {extent: resolved(scale) for extent, scale in extents.items()}},
            {"name": "cure", "title": "Synthetic choice", "kind": "numerical", "runs": ["base", "none"], **common,
             "quantities": {extent: {"u_base_um": 0.0, "relative_u": 0.0, "left_out": ["none"]} for extent in extents}},
            {"name": "later", "title": "Synthetic later", "kind": "physics", "runs": ["base", "unmade"], **common,
             "missing": ["unmade"]},
            varied("absorptivity", 0.8, 0.1, ["input_low", "input_high"]),
            varied("slope", -0.2, 0.025, ["input_low", "input_high"], same_side=True,
                   changes=(("0.8", 0.01), ("1.2", 0.02))),
            varied("law", None, 0.017, ["other_law"], changes=(("liquid", 0.03),)),
            varied("radius", 1.0, None, ["radius_low", "radius_high"], missing=["radius_low", "radius_high"])],
        "inputs": {extent: {"relative_u": 0.1045, "parts": {"absorptivity": 0.1, "slope": 0.025, "law": 0.017},
                            "sensitivities": {"absorptivity": 0.8, "slope": -0.2, "law": None}, "missing": ["radius"]}
                   for extent in extents},
        "quantities": {extent: {"relative_u": 0.057, "parts": {"resolution": 0.057, "cure": 0.0}} for extent in extents},
        "provenance": PROVENANCE}))


def everything(root):
    """A whole folder of results, as `make validate` would leave it; returns its places."""
    root = Path(root)
    work = root / "work"
    for content, share in (("0wt", 0.0), ("1wt", 0.01), ("5wt", 0.05)):
        (work / f"powder_{content}").mkdir(parents=True)
        powder(work / f"powder_{content}" / "powder.h5", share)
        run(work / f"track_{content}", share)
        recording(work / f"track_{content}" / "recording.h5")
        thermography(work / f"track_{content}" / "thermography")
    run(work / "track_316L_175W_750", 0.0, powder_layer=False)
    for direction in ("depth", "lateral"):
        linescan(work / "track_5wt" / f"linescan_{direction}.json", direction)
    verification(root / "verification.json", root / "profiles")
    comparison(root / "validation.json")
    studies(root / "studies.json")
    return work
