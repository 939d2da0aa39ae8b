# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a campaign: every track, their statistics, and length against additive content."""

import csv
import io

import pages
from figures import against_content


def table(tracks):
    """campaign.csv: a row a track, for a spreadsheet."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["file", "additive [wt%]", "power [W]", "speed [m/s]", "length [um]", "length low [um]",
                   "length high [um]", "sd over frames [um]", "frames used [1]"])
    for track in tracks:
        low, high = track["interval"] or ("", "")
        rows.writerow([track["file"], *(track.get(key, "") for key in ("additive_wt_percent", "power_W", "speed_m_s")),
                       *(f"{x:.6g}" if x != "" else "" for x in (track["length_um"], low, high, track["sd_um"])),
                       track["n"]])
    return text.getvalue()


def write_report(name, tracks, skipped, joined, groups, output):
    with_content = [track for track in tracks if track["content"] is not None]
    figure = None
    if groups:
        figure = pages.drawing(pages.svg_of(against_content(groups, with_content)), "Length against additive content")
    shown = [{**{key: track.get(key) for key in ("file", "content", "power_W", "speed_m_s", "report", "n")},
              "length": pages.number(track["length_um"]), "sd": pages.number(track["sd_um"], 3),
              "interval": " to ".join(pages.number(x) for x in track["interval"]) if track["interval"] else "–"}
             for track in tracks]
    facts = {"name": name, "tracks": shown, "skipped": skipped, "length": joined["length_um"],
             "depth": joined["depth_um"], "groups": groups, "figure": figure,
             "synthetic": sum(bool(track["synthetic"]) for track in tracks),
             "revision": joined["provenance"].get("revision", "")}
    pages.write(output / "campaign.csv", table(tracks).encode())
    pages.write_pages("campaign.html", facts, output / "campaign")
