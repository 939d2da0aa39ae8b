# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of one recording, from what meltproof-thermography and meltproof-calibrate have written.

Equal files give equal bytes.
"""

import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import pages  # noqa: E402
from animation import animated  # noqa: E402
from figures import histogram, per_frame, tail  # noqa: E402

from artifact import MissingArtifact, existing, read_json, read_table, value  # noqa: E402  (beside style.py)

SOURCES = {"given": "given by you", "file": "the recording's file", "default": "default",
           "calibration": "your calibration", "unknown": "nobody says it"}


def shown_unit(unit):
    return {"um": "µm", "1": "", "m": "µm"}.get(unit, unit)


def parameter(row):
    """A row of the table of parameters in a reader's units."""
    content, unit, name = row["value"], row["unit"], row["name"]
    if unit == "m" and content is not None:
        content *= 1e6
    if unit == "s" and content is not None:
        content, unit = content * 1e6, "µs"
    text = pages.uncertain(content, row["u"]) if content is not None and row.get("u") else pages.number(content, 6)
    return {"name": name, "value": text, "unit": shown_unit(unit), "source": SOURCES.get(row["source"], row["source"])}


def dimension(summary, name, unit):
    """Length or depth as the first lines say it."""
    plain = summary[f"{name}_{unit}"]
    budget = summary.get("budget", {}).get(f"{name}_{unit}")
    shown = "µm" if unit == "um" else "pixels"
    if budget:
        low, high = budget["interval_95"]
        return {"name": name, "value": pages.number(budget["value"]), "low": pages.number(low),
                "high": pages.number(high), "unit": shown, "mean": pages.number(plain["mean"]),
                "sd": pages.number(plain["sd"], 3), "n": plain["n"],
                "effective": pages.number(plain["n_effective"], 3)}
    u = plain["u_mean"]
    return {"name": name, "value": pages.number(plain["mean"]), "low": pages.number(plain["mean"] - 2 * u),
            "high": pages.number(plain["mean"] + 2 * u), "unit": shown, "mean": pages.number(plain["mean"]),
            "sd": pages.number(plain["sd"], 3), "n": plain["n"], "effective": pages.number(plain["n_effective"], 3)}


def budget_rows(summary, unit):
    rows = []
    for row in summary.get("budget", {}).get("inputs", []):
        rows.append({"input": row["input"], "type": row["type"], "how": row["how"],
                     **{key: pages.number(row[f"{key}_{unit}"], 2)
                        for key in ("u_length", "u_depth", "correction_length", "correction_depth")}})
    return rows


def calibration_facts(path):
    """What a calibration file says, and its picture where it lies beside it."""
    record = read_json(path)
    image = Path(path).with_suffix(".png")
    axes = [{"axis": axis, "size": pages.uncertain(value(record, f"pixel_size_{axis}_um", path),
                                                    record.get(f"u_pixel_size_{axis}_um"))} for axis in "xy"]
    return {"axes": axes, "synthetic": bool(record.get("synthetic")),
            "assumption": record.get("assumption") or "",
            "blurs": [pages.uncertain(i["edge_blur_px"], i.get("u_edge_blur_px"))
                      for i in record.get("images", []) if i.get("edge_blur_px")],
            "picture": pages.picture(pages.data_uri(image.read_bytes(), "image/png"), "Fit of the glass scale")
            if image.is_file() else None}


def png(path, words):
    return pages.picture(pages.data_uri(existing(path).read_bytes(), "image/png"), words)


def facts_of(folder, calibration, material):
    folder = Path(folder)
    summary = read_json(folder / "summary.json")
    name = value(summary, "recording", folder / "summary.json")
    found = value(summary, "melt_pool_found", folder / "summary.json")
    unit = "um" if "length_um" in summary else "px"
    facts = {"name": name, "summary": summary, "found": found, "unit": unit.replace("um", "µm"),
             "synthetic": summary.get("synthetic"), "material": material,
             "parameters": [parameter(row) for row in value(summary, "parameters", folder / "summary.json")],
             "contact_sheet": png(folder / "contact_sheet.png", "Frames over the whole recording"),
             "annotated": png(folder / "annotated.png", "One frame with the pool outlined"),
             "animation": None, "calibration": calibration_facts(calibration) if calibration else None,
             "notes": list(summary.get("notes", [])), "dimensions": [], "budget": [], "figures": [], "tail_reason": None,
             "budget_reason": (summary.get("budget") or {}).get("not_corrected_because"),
             "revision": summary["provenance"].get("revision", ""),
             "libraries": ", ".join(f"{k} {v}" for k, v in sorted(summary["provenance"]["libraries"].items()))}
    if summary.get("frames_lost"):
        facts["notes"].insert(0, f"The file ends early: at least {summary['frames_lost']} frames are lost; everything "
                                 f"here stands for the {summary['frames']} whole ones.")
    if summary.get("film_frames"):
        moving = animated(existing(folder / "film.png"), len(summary["film_frames"]))
        pages.write(folder / "animation.png", moving)
        facts["animation"] = pages.picture(pages.data_uri(moving, "image/png"), "The frames in turn, the pool outlined")
    if not found:
        return facts
    facts["dimensions"] = [dimension(summary, what, unit) for what in ("length", "depth")]
    facts["budget"] = budget_rows(summary, unit)
    path = folder / "frames.csv"
    table = read_table(path)
    add = facts["figures"].append
    if summary["frames"] > 1:
        add({"title": "Length and depth of every frame", "picture": pages.drawing(
            pages.svg_of(per_frame(table, path, summary, unit)), "Length and depth against time"),
            "caption": "Filled: the frames that the mean is made of. Open: the pool touches the border, is disturbed or "
                       "does not move with the beam (column status of frames.csv). Line and band: the result of the "
                       "first lines and its 95 % interval, without blur and noise."})
    if (folder / "tail.csv").is_file():
        tail_path = folder / "tail.csv"
        add({"title": "The tail and the reference signal S*", "picture": pages.drawing(
            pages.svg_of(tail(read_table(tail_path), tail_path, summary, unit)), "Signal along the tail"),
            "caption": "Signal of the mean pool along the line of pixels in which the front lies outermost, against the "
                       "fitted model. " + ("S* is the signal of liquid metal at the front, as it would be without blur."
                                           if summary["reference_signal"].get("found") else
                                           "The model's front was not accepted: " +
                                           str(summary["reference_signal"].get("reason")) + ".")})
    else:
        facts["tail_reason"] = summary["reference_signal"].get("reason")
    if summary[f"length_{unit}"]["n"] >= 5:
        add({"title": "Histogram of the lengths", "picture": pages.drawing(
            pages.svg_of(histogram(table, path, summary, unit)), "Histogram of lengths"),
            "caption": "Of the frames used."})
    return facts


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("folder", help="what meltproof-thermography wrote, with --film")
    arguments.add_argument("--calibration", help="calibration.json; its picture is looked for beside it")
    arguments.add_argument("--material", default="", help="words on where the reference temperature comes from")
    given = arguments.parse_args()
    pages.write_pages("recording.html", facts_of(given.folder, given.calibration, given.material),
                      Path(given.folder) / "report")


if __name__ == "__main__":
    try:
        main()
    except MissingArtifact as problem:
        print(f"recording_report.py: error: {problem}", file=sys.stderr)
        sys.exit(2)
