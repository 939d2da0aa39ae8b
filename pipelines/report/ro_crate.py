# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes ro-crate-metadata.json beside a report: what its files are, what made them and from what (RO-Crate 1.1).

Every artifact becomes a File with its SHA-256, every program a SoftwareApplication, and every artifact that carries a
provenance a CreateAction of that program from its inputs. The authors are the project, an organisation.
"""

import argparse
import datetime
import hashlib
import json
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "figures")]
from artifact import MissingArtifact, existing, read_json, value  # noqa: E402
from build_report import provenance_of_hdf5, write  # noqa: E402

CONTEXT = ["https://w3id.org/ro/crate/1.1/context", {"sha256": "https://schema.org/sha256"}]
SPECIFICATION = "https://w3id.org/ro/crate/1.1"
LICENCE = "https://spdx.org/licenses/GPL-3.0-or-later"
PROJECT = "#meltproof"
FORMATS = {".pdf": "application/pdf", ".html": "text/html", ".json": "application/json", ".csv": "text/csv",
           ".h5": "application/x-hdf5", ".svg": "image/svg+xml", ".toml": "application/toml"}


def crate_path(path, root):
    """The id of a file: its path from the crate's folder."""
    return Path(os.path.relpath(path, root)).as_posix()


def file_entity(path, root, name):
    path = existing(path)
    content = path.read_bytes()
    return {"@id": crate_path(path, root), "@type": "File", "name": name, "contentSize": str(len(content)),
            "sha256": hashlib.sha256(content).hexdigest(),
            "encodingFormat": FORMATS.get(path.suffix, "application/octet-stream")}


def software_entity(program, revision):
    return {"@id": f"#{program}-{revision}", "@type": "SoftwareApplication", "name": program, "version": revision,
            "softwareVersion": revision, "license": {"@id": LICENCE}, "author": {"@id": PROJECT}}


def provenance_of(path):
    """What the artifact says of its making; None if it says nothing."""
    if path.suffix == ".json":
        return read_json(path).get("provenance")
    return provenance_of_hdf5(path) if path.suffix == ".h5" else None


class Graph:
    """Entities by id, in the order in which they came; an id is described once."""

    def __init__(self, root):
        self.root, self.entities = root, {}

    def add(self, entity):
        self.entities.setdefault(entity["@id"], entity)
        return {"@id": entity["@id"]}

    def input_file(self, entry, base):
        """An input by the path that a provenance names (from the project's root): the crate's own file where it still
        has these bytes, else a work outside the crate, known by name and checksum."""
        known = self.entities.get(crate_path(Path(base) / entry["path"], self.root))
        if known and known.get("sha256") == entry["sha256"]:
            return {"@id": known["@id"]}
        return self.add({"@id": f"#input-{entry['sha256'][:16]}", "@type": "CreativeWork", "name": entry["path"],
                         "sha256": entry["sha256"],
                         "encodingFormat": FORMATS.get(Path(entry["path"]).suffix, "application/octet-stream")})

    def made(self, path, words, base):
        """A file, and the action that made it; returns the file's reference."""
        path = Path(path)
        reference = self.add(file_entity(path, self.root, words))
        found = provenance_of(path)
        if found:
            program = self.add(software_entity(found["program"], found["revision"]))
            self.add({"@id": f"#making-{reference['@id']}", "@type": "CreateAction", "name": f"making of {words}",
                      "instrument": program, "object": [self.input_file(entry, base) for entry in found["inputs"]],
                      "result": reference, "agent": {"@id": PROJECT}})
        return reference


def crate(given):
    """The whole metadata document."""
    root = Path(given.report).parent
    facts = read_json(given.circumstances)
    graph = Graph(root)
    for path in given.artifacts:  # first all files, so that an input is known as one of them
        graph.add(file_entity(path, root, f"artifact {crate_path(path, root)}"))
    artifacts = [graph.made(path, f"artifact {crate_path(path, root)}", given.base) for path in given.artifacts]
    revision = value(facts, "last_commit", given.circumstances) or "unknown"
    reporter = graph.add(software_entity("build_report.py", revision))
    outputs = []
    for suffix, words in ((".pdf", "validation report, for print"), (".html", "validation report, for a browser")):
        outputs.append(graph.add(file_entity(Path(given.report).with_suffix(suffix), root, words)))
    figures = [graph.add(file_entity(path, root, read_json(path.with_suffix(".json"))["title"]))
               for path in sorted(Path(given.figures).glob("*.svg"))]
    graph.add({"@id": "#making-report", "@type": "CreateAction", "name": "making of the validation report",
               "instrument": reporter, "object": artifacts + figures, "result": outputs, "agent": {"@id": PROJECT}})
    moment = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", "0")), datetime.timezone.utc)
    described = list(graph.entities.values())
    files = [{"@id": entity["@id"]} for entity in described if entity["@type"] == "File"]
    actions = [{"@id": entity["@id"]} for entity in described if entity["@type"] == "CreateAction"]
    head = [
        {"@id": "ro-crate-metadata.json", "@type": "CreativeWork", "about": {"@id": "./"},
         "conformsTo": {"@id": SPECIFICATION}},
        {"@id": "./", "@type": "Dataset", "name": f"Meltproof validation report, profile {facts['profile']}",
         "description": "Validation of simulated laser tracks against exact solutions and measurements: report, results, "
                        f"figures and where each number comes from. Particle spacing {facts['spacing']}, sources of "
                        f"revision {revision}.",
         "datePublished": moment.strftime("%Y-%m-%dT%H:%M:%SZ"), "license": {"@id": LICENCE},
         "author": {"@id": PROJECT}, "publisher": {"@id": PROJECT}, "hasPart": files, "mentions": actions,
         "citation": {"@id": "https://doi.org/10.3390/met11111842"}},
        {"@id": PROJECT, "@type": "Organization", "name": "The Meltproof project"},
        {"@id": LICENCE, "@type": "CreativeWork", "name": "GNU General Public License v3.0 or later",
         "description": "The licence of the software and of what it makes; measured numbers have that of their campaign, in "
                        "its dataset.toml."},
        {"@id": "https://doi.org/10.3390/met11111842", "@type": "ScholarlyArticle",
         "name": "Experimental and Numerical Investigations of In Situ Alloying during Powder Bed Fusion of Metals Using a "
                 "Laser Beam"},
    ]
    return {"@context": CONTEXT, "@graph": head + described}


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("artifacts", nargs="*", help="results behind the report: JSON and HDF5 with their provenance")
    arguments.add_argument("--report", required=True, help="the report without suffix; the crate's folder is its folder")
    arguments.add_argument("--figures", required=True, help="folder of the figures")
    arguments.add_argument("--circumstances", required=True, help="circumstances.json")
    arguments.add_argument("--base", default=".", help="folder from which provenances name their inputs")
    given = arguments.parse_args()
    document = crate(given)
    write(Path(given.report).parent / "ro-crate-metadata.json",
          (json.dumps(document, indent=1, ensure_ascii=False) + "\n").encode())


if __name__ == "__main__":
    try:
        main()
    except MissingArtifact as problem:
        print(f"ro_crate.py: error: {problem}", file=sys.stderr)
        sys.exit(2)
