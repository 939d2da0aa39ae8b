# SPDX-License-Identifier: GPL-3.0-or-later
"""A folder of recordings: which they are, what is known of each, every one measured, all joined.

A folder is a campaign where it holds campaign.toml or campaign.csv, where it holds folders, or where one of its
files holds more than one frame (by its first bytes). Otherwise its files are the frames of one recording.
`--decide` only says which: "campaign" or "recording".
"""

import argparse
import concurrent.futures
import csv
import json
import math
import os
import subprocess
import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE))

KEYS = {"file": str, "additive_wt_percent": (int, float), "power_W": (int, float), "speed_m_s": (int, float),
        "calibration": str}
# First bytes of formats that hold many frames: HDF5 and MATLAB 7.3, MATLAB 5, PTW, IRB.
MANY = (b"\x89HDF\r\n\x1a\n", b"MATLAB", b"CED\0", b"\xffIRB")
ASIDE = {"campaign.toml", "campaign.csv"}
NOT_A_RECORDING = {".inc", ".json", ".txt", ".md", ".toml"}


class Refused(Exception):
    """What the user gave cannot be used."""


def holds_many_frames(path):
    """Whether the file's content is that of a recording of several frames."""
    with path.open("rb") as file:
        start = file.read(4096)
        if start.startswith(MANY) or b"xPixls" in start:
            return True
        if start.startswith(b"FFF\0"):  # a sequence is one such block after the other
            return (start + file.read(1 << 24)).count(b"FFF\0") > 1
    if start[:4] in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"):
        from PIL import Image

        try:
            with Image.open(path) as picture:
                return getattr(picture, "n_frames", 1) > 1
        except OSError:
            return False  # what the reader of recordings says of it is clearer
    return False


def inside(folder):
    """Files and folders of a folder that may be recordings, by name."""
    return sorted(p for p in folder.iterdir() if not p.name.startswith(".") and p.name not in ASIDE
                  and (p.is_dir() or p.suffix.lower() not in NOT_A_RECORDING))


def is_campaign(folder):
    if any((folder / name).is_file() for name in ASIDE):
        return True
    return any(p.is_dir() or holds_many_frames(p) for p in inside(folder))


def checked(row, where):
    for key, content in row.items():
        if key not in KEYS:
            raise Refused(f"{where}: there is no key `{key}`; a track has {', '.join(KEYS)}.")
        if not isinstance(content, KEYS[key]) or isinstance(content, bool):
            raise Refused(f"{where}: {key} is {content!r}; expected {'a text' if KEYS[key] is str else 'a number'}.")
        if KEYS[key] is not str and not (math.isfinite(content) and content >= 0):
            raise Refused(f"{where}: {key} is {content}; expected a number that is not negative.")
    if "file" not in row:
        raise Refused(f"{where}: the key `file` is missing; it names a recording of the folder.")
    return row


def read_toml(path):
    try:
        record = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as problem:
        raise Refused(f"{path} is no TOML file ({problem}).") from None
    unknown = set(record) - {"track"}
    if unknown or not isinstance(record.get("track"), list):
        raise Refused(f"{path}: expected tables [[track]]" +
                      (f", found the key `{sorted(unknown)[0]}`." if unknown else ", found none."))
    return [checked(row, f"{path}, track {i + 1}") for i, row in enumerate(record["track"])]


def read_csv(path):
    rows = []
    with path.open(encoding="utf-8-sig", newline="") as file:
        for line, cells in enumerate(csv.DictReader(file), start=2):
            row = {}
            for key, cell in cells.items():
                if key is None or cell is None:
                    raise Refused(f"{path}, line {line}: it has not as many cells as the header.")
                if not cell.strip():
                    continue
                if KEYS.get(key) in (None, str):
                    row[key] = cell.strip()
                    continue
                try:
                    row[key] = float(cell)
                except ValueError:
                    raise Refused(f"{path}, line {line}: {key} is \"{cell}\"; expected a number with a decimal "
                                  "point.") from None
            rows.append(checked(row, f"{path}, line {line}"))
    return rows


def tracks_of(folder):
    """A dictionary a track: its file and what campaign.toml or campaign.csv says of it."""
    both = [folder / name for name in sorted(ASIDE) if (folder / name).is_file()]
    if len(both) > 1:
        raise Refused(f"{folder} holds campaign.toml and campaign.csv; keep one of them.")
    if both:
        rows = (read_toml if both[0].suffix == ".toml" else read_csv)(both[0])
        names = [row["file"] for row in rows]
        for row in rows:
            if not (folder / row["file"]).exists():
                raise Refused(f"{both[0]}: the recording '{row['file']}' is not in {folder}.")
            if "calibration" in row and not (folder / row["calibration"]).is_file():
                raise Refused(f"{both[0]}: the calibration '{row['calibration']}' is not in {folder}.")
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise Refused(f"{both[0]}: the recording '{twice[0]}' stands in it twice.")
        if not rows:
            raise Refused(f"{both[0]} names no recording.")
        return rows
    found = [{"file": p.name} for p in inside(folder)]
    if not found:
        raise Refused(f"{folder} holds no recording.")
    return found


def measure(folder, track, output):
    """One track through pipelines/process_recording.sh. @return what it said, with its exit status."""
    environment = {**os.environ, "RECORDING": str(folder / track["file"]), "OUTPUT": str(output)}
    if "calibration" in track:
        environment["CALIBRATION"] = str(folder / track["calibration"])
    if "speed_m_s" in track:
        environment["SCAN_SPEED"] = f"{track['speed_m_s']} m/s"
    return subprocess.run([str(ROOT / "pipelines/process_recording.sh")], env=environment, check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def measure_all(folder, tracks, places):
    """Every track's outcome in order, as soon as it is there; as many at once as there are processors. Nobody is waited
    for that was not begun when the caller stops."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        running = [pool.submit(measure, folder, track, place) for track, place in zip(tracks, places)]
        try:
            for task in running:
                yield task.result()
        finally:
            for task in running:
                task.cancel()


def join(program, summaries, output):
    done = subprocess.run([program, *map(str, summaries), "--output", str(output), "--quiet"], check=False)
    if done.returncode:
        raise Refused(f"the {len(summaries)} tracks could not be joined; the reason stands above.")
    return json.loads(output.read_text(encoding="utf-8"))


def grouped(tracks, program, output):
    """Tracks of one additive content joined, by content."""
    groups = []
    for content in sorted({track["content"] for track in tracks if track["content"] is not None}):
        members = [track for track in tracks if track["content"] == content]
        name = f"campaign_{content:g}wt.json"
        joined = join(program, [track["summary"] for track in members], output / name)["length_um"]
        groups.append({"content": content, "n": len(members), "mean": joined["mean"],
                       "between_frames": joined["sigma_between_frames"],
                       "between_tracks": joined["sigma_between_tracks"], "u_mean": joined["u_mean"]})
    return groups


def process(folder, output):
    tracks, skipped, measured = tracks_of(folder), [], []
    program = Path(os.environ.get("MELTPROOF_BIN", ROOT / "build/release/bin")) / "meltproof-campaign"
    import pages

    names = [pages.plain(track["file"]) for track in tracks]
    places = [output / (name if names.count(name) == 1 else f"{i + 1}_{name}") for i, name in enumerate(names)]
    for i, (track, place, done) in enumerate(zip(tracks, places, measure_all(folder, tracks, places))):
        print(f"== track {i + 1} of {len(tracks)}: {track['file']}\n{done.stdout}", end="", flush=True)
        if done.returncode not in (0, 3, 4):
            raise Refused(f"the recording '{track['file']}' could not be processed (status {done.returncode}); the "
                          "reason stands above. Mend it or leave it out in campaign.toml.")
        summary = json.loads((place / "summary.json").read_text(encoding="utf-8"))
        if not summary["melt_pool_found"]:
            skipped.append({"file": track["file"], "reason": summary["reason"]})
            continue
        if "length_um" not in summary:
            raise Refused(f"lengths of '{track['file']}' are in pixels and cannot be joined; give CALIBRATION, or a "
                          "calibration for every track in campaign.toml.")
        value = summary.get("budget", {}).get("length_um", {"value": summary["length_um"]["mean"], "interval_95": None})
        measured.append({**track, "content": track.get("additive_wt_percent"), "summary": place / "summary.json",
                         "report": f"{place.name}/report.html", "synthetic": summary["synthetic"],
                         "length_um": value["value"], "interval": value["interval_95"],
                         "sd_um": summary["length_um"]["sd"], "n": summary["length_um"]["n"]})
    if not measured:
        print(f"In none of the {len(tracks)} recordings of '{folder}' was a melt pool found; each is described in "
              f"{output}/.")
        return 3
    joined = join(program, [track["summary"] for track in measured], output / "campaign.json")
    groups = grouped(measured, program, output)
    from campaign_report import write_report

    write_report(folder.resolve().name, measured, skipped, joined, groups, output)
    print(f"The campaign's report is {output}/campaign.pdf, and campaign.html for a browser.")
    return 0


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("folder")
    arguments.add_argument("--decide", action="store_true")
    arguments.add_argument("--output")
    given = arguments.parse_args()
    folder = Path(given.folder)
    try:
        if given.decide:
            print("campaign" if is_campaign(folder) else "recording")
            return 0
        return process(folder, Path(given.output))
    except Refused as problem:
        print(f"make process: {problem}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
