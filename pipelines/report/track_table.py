# SPDX-License-Identifier: GPL-3.0-or-later
"""The report's tables of tracks: pools beside Rosenthal and the measurements, acceptance, limiters."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "figures")]
import rosenthal  # noqa: E402
from artifact import MissingArtifact, read_json, value  # noqa: E402
from track import flow_numbers, resolved_input, still_growing  # noqa: E402

EXTENTS = ("length", "width", "depth")


def read_tracks(work):
    """result.json of every track, with the length that the thermography program saw, in the order of names."""
    tracks = []
    for path in sorted(Path(work).glob("track_*/result.json")):
        track = read_json(path)
        track["path"] = path
        film = path.parent / "thermography" / "summary.json"
        track["filmed"] = read_json(film).get("length_um") if film.is_file() else None
        for key in ("title", "window", "pool_length_um", "energy_relative_error", "species_relative_error"):
            value(track, key, path)
        tracks.append(track)
    if not tracks:
        raise MissingArtifact(f"{work} holds no track_*/result.json; `make validate` makes them.")
    return tracks


def measured(track, rows):
    """What was measured of this track: per extent (D, u_D) and the source, from the rows that compare it."""
    found, source = {}, None
    for row in rows:
        simulated = row.get("simulated") or {}
        if row.get("D") is not None and simulated.get("file") == f"{track['path'].parent.name}/result.json" \
                and row["quantity"] in EXTENTS:
            found[row["quantity"]] = (row["D"], row.get("u_D"))
            source = row.get("source")
    return {"extents": found, "source": source} if found else None


def numerical_uncertainty(track, rows):
    """u_num per extent of the rows that compare this track, in um."""
    return {row["quantity"]: row["u_num"] for row in rows
            if row.get("u_num") is not None and row["quantity"] in EXTENTS
            and (row.get("simulated") or {}).get("file") == f"{track['path'].parent.name}/result.json"}


def describe(track, rows, root):
    """One track for the template: pool, flow, steadiness, Rosenthal's pool and the measured one."""
    folder = track["path"].parent
    flow = flow_numbers(folder, track) if (folder / "history.csv").is_file() else {}
    theory = rosenthal.of_track(resolved_input(folder), root) if (folder / "input.toml").is_file() else None
    steady = track.get("steady_state", {})
    return {**track, "name": folder.name, "flow": flow, "rosenthal": theory, "measured": measured(track, rows),
            "u_num": numerical_uncertainty(track, rows), "steadiness": still_growing(steady.get("pool_length")),
            "acceptance": acceptance(track)}


def acceptance(track):
    """The acceptance of a track in the words of the table; None for a run without flow."""
    found = track.get("acceptance")
    if not found:
        return None
    ever, asked, height = found["ever_melted"], found["asked"], found.get("refilled_track") or {}
    limiters = track.get("limiters") or {}

    def share(acted, of):
        return limiters[acted] / limiters[of] if limiters.get(of) else None

    return {"pass": found["pass"], "lost": found["lost_particles"], "clumped": ever["clumped_fraction"],
            "melt_clumped": found["liquid"]["clumped_fraction_mean"], "smallest": ever["smallest_spacings"],
            "volume": ever["filled_relative_error"], "melt_volume": found["liquid"]["filled_relative_error"],
            "height_um": height.get("mean_height_um"), "deepest_um": height.get("deepest_point_um"),
            "asked_clumped": asked["clumped_fraction_below"], "asked_volume": asked["filled_relative_error_within"],
            "asked_height_um": asked["refilled_mean_height_above_um"],
            "wall_clipped": share("wall_pressure_clipped", "wall_particle_steps"),
            "curvature_held": share("curvature_held", "liquid_particle_steps")}
