# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the validation report from artifacts: one self-contained HTML page and the same as PDF.

Every number comes from an artifact or is computed from one here; equal artifacts give equal bytes.
"""

import argparse
import base64
import json
import os
import re
import sys
import tomllib
from pathlib import Path

import jinja2
from markupsafe import Markup

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "figures"))
from artifact import MissingArtifact, existing, open_artifact, read_json, scalar, text, value  # noqa: E402
from errata_numbers import numbers  # noqa: E402
from findings import findings  # noqa: E402
from fonts import rules  # noqa: E402
from numbering import number  # noqa: E402
from study_table import code_differs, read_studies  # noqa: E402
from track_table import describe, read_tracks  # noqa: E402


def fixed(number, digits):
    return "–" if number is None else f"{number:.{digits}f}"


def scientific(number):
    return "–" if number is None else f"{number:.1e}"


def short(number):
    return "–" if number is None else f"{number:.3g}"


def percent_number(share):
    return "–" if share is None else f"{100 * share:.2g}"


def signed_percent(share):
    return "–" if share is None else f"{100 * share:+.1f} %"


def of_spacing(micrometres):
    """A spacing in um, or in m where a case is stated in metres."""
    return f"{micrometres:g} um" if micrometres < 1000 else f"{1e-6 * micrometres:.3g} m"


def extra_text(name, number):
    """A further result of a case in words: `parasitic_capillary_number` 0.0123."""
    if isinstance(number, bool) or not isinstance(number, (int, float)):
        return f"{name.replace('_', ' ')}: {number}"
    return f"{name.replace('_', ' ')} {number:.3g}"


def readable_rule(rule):
    """A rule of the comparison table as it is set in print."""
    return rule.replace("<=", "≤").replace(">=", "≥")


def thousands(number):
    return f"{number:,}".replace(",", " ")


def duration(seconds):
    if seconds < 120:
        return f"{seconds:.1f} s" if seconds < 10 else f"{seconds:.0f} s"
    return f"{seconds / 60:.1f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


def read_figures(folder):
    """Every figure of the folder with its words, in the order of their names."""
    figures = []
    for path in sorted(Path(folder).glob("*.svg")):
        words = read_json(path.with_suffix(".json"))
        figures.append({"name": path.stem, "path": path, "title": words["title"], "caption": words["caption"]})
    if not figures:
        raise MissingArtifact(f"{folder} holds no figure; `make figures` makes them.")
    return figures


def inline_svg(figure):
    """The graphic as an element of the page. Names inside it get the figure's own prefix, because several
    graphics of one page must not share them."""
    svg = figure["path"].read_text(encoding="utf-8")
    svg = svg[svg.index("<svg"):]
    prefix = figure["name"].split("_")[0] + "-"
    svg = re.sub(r'\bid="', f'id="{prefix}', svg)
    svg = re.sub(r'href="#', f'href="#{prefix}', svg)
    svg = svg.replace("url(#", f"url(#{prefix}")
    label = Markup.escape(figure["title"])
    return Markup(svg.replace("<svg", f'<svg role="img" aria-label="{label}"', 1))


def embedded_svg(figure):
    """The graphic as an image inside the page: WeasyPrint draws glyphs only of graphics in files."""
    data = base64.b64encode(figure["path"].read_bytes()).decode()
    return Markup(f'<img alt="{Markup.escape(figure["title"])}" src="data:image/svg+xml;base64,{data}">')


def provenance_of_hdf5(path):
    """The provenance of an HDF5 artifact in the form of that of a JSON result."""
    with open_artifact(path, "") as file:
        group = value(file, "provenance", path)
        return {"program": text(group.attrs["program"]), "revision": text(group.attrs["revision"]),
                "inputs": json.loads(text(group.attrs["inputs"])),
                "libraries": json.loads(text(group.attrs["libraries"])),
                "threads": int(scalar(file, "provenance/threads")),
                "wall_time_s": scalar(file, "provenance/wall_time")}


def collect_provenance(work, verification, studies, comparison):
    """One line per artifact, every input file with its checksum, and the libraries."""
    files = [Path(verification), *sorted(Path(work).glob("powder_*/powder.h5")),
             *sorted(Path(work).glob("track_*/result.json")),
             *sorted(Path(work).glob("track_*/thermography/summary.json")),
             *sorted(Path(work).glob("track_*/linescan_*.json")), Path(studies), Path(comparison)]
    artifacts, inputs, libraries = [], {}, {}
    for path in files:
        record = read_json(path) if path.suffix == ".json" else {"provenance": provenance_of_hdf5(path)}
        if "provenance" not in record:
            continue  # a line scan without a grain is a sentence, no result
        made = record["provenance"]
        artifacts.append({"path": path.as_posix(), "program": value(made, "program", path),
                          "revision": value(made, "revision", path), "particles": count(record.get("particles")),
                          "steps": count(record.get("steps")), "threads": made["threads"],
                          "wall_time": duration(record.get("wall_time_s", made["wall_time_s"]))})
        libraries.update(made["libraries"])
        inputs.update({entry["path"]: entry["sha256"] for entry in made["inputs"]})
    return artifacts, [{"path": path, "sha256": sum_} for path, sum_ in sorted(inputs.items())], libraries


def count(number):
    """A number of particles or steps; a list of them as its largest."""
    if isinstance(number, list):
        number = max(number)
    return "" if number is None else thousands(number)


def is_old_track(made, last_commit, root):
    """Whether an artifact is a track that other code than that of the sources made. Tables are made anew whenever Make
    finds them old; of a program built from uncommitted sources it cannot be told."""
    return (made["program"] == "meltproof-solve" and "dirty" not in made["revision"]
            and code_differs(made["revision"], last_commit, root))


def read_estimate(path):
    """What a run at the paper's resolution would cost; None if nobody has estimated it."""
    if not Path(path).is_file():
        return None
    estimate = read_json(path)
    for key in ("hours_two_cores", "hours_64_ranks", "particles", "spacing_um", "revision", "how"):
        value(estimate, key, path)
    return estimate


def lower_bounds(rows):
    """Which uncertainties are not fully evaluated among the rows, in words; empty if none."""
    absent = sorted({name for row in rows for name in (row.get("details") or {}).get("not_evaluated", [])
                     if row["verdict"] in ("agrees", "differs")})
    return f"{' and '.join(absent)} not fully evaluated" if absent else ""


def sort_rows(rows):
    """The comparisons with measurements by their verdict; the pending ones by what they wait for."""
    with_measurement = [row for row in rows if row["kind"] != "verification"]
    chosen = {"agrees": [], "differs": [], "uncomputed": []}
    for row in with_measurement:
        if row["verdict"] != "pending":
            chosen.get(row["verdict"], chosen["uncomputed"]).append(row)
    waiting = [row for row in with_measurement if row["verdict"] == "pending"]
    reasons = list(dict.fromkeys(row["reason"] for row in waiting))
    pending = [(reason, [row for row in waiting if row["reason"] == reason]) for reason in reasons]
    return with_measurement, chosen, pending


def fill_errata(template):
    with existing(Path(template) / "errata.toml").open("rb") as file:
        rows = tomllib.load(file)["row"]
    known = numbers(HERE.parent.parent)
    return [{**row, "finding": row["finding"].format(**known), "suite": row["suite"].format(**known)} for row in rows]


def report_facts(given):
    """Everything that the template names, but for the pictures."""
    cases = value(read_json(given.verification), "cases", given.verification)
    for case in cases:
        case["pairs"] = [(of_spacing(s), e) for s, e in zip(case["spacings_um"], case["errors"])]
        case["extras"] = [extra_text(name, number) for name, number in sorted((case.get("extra") or {}).items())]
    comparison = read_json(given.comparison)
    rows = value(comparison, "rows", given.comparison)
    comparisons, measured, pending = sort_rows(rows)
    root = HERE.parent.parent
    tracks = [describe(track, rows, root) for track in read_tracks(given.work)]
    made_by = sorted({track["revision"] for track in tracks})
    studies = read_studies(given.studies, made_by[-1] if len(made_by) == 1 else None, root,
                           value(read_json(given.witness), "witness", given.witness) if given.witness else None)
    artifacts, inputs, libraries = collect_provenance(given.work, given.verification, given.studies, given.comparison)
    facts = read_json(given.circumstances)
    for made in artifacts:
        made["stale"] = is_old_track(made, facts["last_commit"], root)
    revisions = sorted({made["revision"] for made in artifacts})
    names = {**libraries, **facts["python"]}
    return {
        "facts": facts, "cases": cases, "passed": [c for c in cases if c["pass"]],
        "missed": [c for c in cases if not c["pass"]], "comparisons": comparisons, "measured": measured,
        "pending": pending, "waiting": sum(len(rows) for _, rows in pending), "bounds": lower_bounds(comparisons),
        "statistics": value(comparison, "statistics", given.comparison),
        "findings": findings(rows, studies, given.work, root), "estimate": read_estimate(given.estimate), "failures": comparison.get("failures", []), "tracks": tracks,
        "studies": studies, "not_run": read_json(given.verification).get("not_run", []),
        "balances": [row for row in rows if row["kind"] == "verification" and row["verdict"] != "pending"
                     and "file" in (row.get("simulated") or {})],
        "worst_energy": max(track["energy_relative_error"] for track in tracks),
        "worst_species": max(track["species_relative_error"] for track in tracks),
        "errata": fill_errata(given.template), "artifacts": artifacts, "inputs": inputs,
        "revision": ", ".join(revisions), "stale_artifacts": [made["path"] for made in artifacts if made["stale"]],
        "libraries": ", ".join(f"{name} {version}" for name, version in sorted(names.items())) + ".",
    }


def render(template, facts, figures, picture):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(template), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters.update(fixed=fixed, scientific=scientific, short=short, percent_number=percent_number,
                               signed_percent=signed_percent, duration=duration,
                               readable_rule=readable_rule, thousands=thousands,
                               percent=lambda share: f"{percent_number(share)} %")
    shown = [{**figure, "picture": picture(figure)} for figure in figures]
    style = Markup(existing(Path(template) / "report.css").read_text(encoding="utf-8"))
    return number(environment.get_template("report.html").render(**facts, figures=shown, style=style))


def with_fonts(page):
    """The page for a browser: with the fonts of its own text."""
    return page.replace("<style>\n", f"<style>\n{rules(page)}\n", 1)


def write(path, content):
    """Under another name first: a report is there whole, or not at all."""
    partial = path.with_name(path.name + ".tmp")
    partial.write_bytes(content)
    os.replace(partial, path)


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--work", required=True, help="folder of the profile's results")
    arguments.add_argument("--figures", required=True, help="folder of the figures")
    arguments.add_argument("--verification", required=True, help="verification.json")
    arguments.add_argument("--comparison", required=True, help="validation.json")
    arguments.add_argument("--studies", required=True, help="studies.json")
    arguments.add_argument("--witness", help="witness.json of the program that made the tracks: studies of other code "
                                             "that has the same are not stale")
    arguments.add_argument("--circumstances", required=True, help="circumstances.json")
    arguments.add_argument("--estimate", default=HERE.parent.parent / "validation/results/paper/estimate.json",
                           help="what a run at the paper's resolution would cost, if anybody has estimated it")
    arguments.add_argument("--template", required=True, help="folder with report.html, report.css, errata.toml")
    arguments.add_argument("--output", required=True, help="path without suffix; .html and .pdf are written")
    arguments.add_argument("--no-pdf", action="store_true", help="write the HTML page only, in a fraction of the time")
    given = arguments.parse_args()

    facts, figures = report_facts(given), read_figures(given.figures)
    page = with_fonts(render(given.template, facts, figures, inline_svg))
    output = Path(given.output)
    output.parent.mkdir(parents=True, exist_ok=True)
    if not given.no_pdf:
        import weasyprint  # slow to load: only once the page stands

        pdf = weasyprint.HTML(string=render(given.template, facts, figures, embedded_svg)).write_pdf()
        write(output.with_suffix(".pdf"), pdf)
    write(output.with_suffix(".html"), page.encode())


if __name__ == "__main__":
    try:
        main()
    except MissingArtifact as problem:
        print(f"build_report.py: error: {problem}", file=sys.stderr)
        sys.exit(2)
