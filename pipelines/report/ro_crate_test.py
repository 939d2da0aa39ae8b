# SPDX-License-Identifier: GPL-3.0-or-later
"""The RO-Crate beside a report, against what its specification requires. Every artifact in here is synthetic."""

import hashlib
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import synthetic_artifacts  # noqa: E402


def run(*arguments):
    return subprocess.run([sys.executable, str(HERE / "ro_crate.py"), *map(str, arguments)], capture_output=True, text=True,
                          env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000"})


class Crate(unittest.TestCase):
    """What the RO-Crate 1.1 specification requires of its root, and of the entities of data and provenance."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        synthetic_artifacts.everything(cls.root)
        for suffix in (".pdf", ".html"):
            (cls.root / f"report{suffix}").write_text("synthetic")
        (cls.root / "figures").mkdir()
        (cls.root / "figures/fig.svg").write_text("<svg/>")
        (cls.root / "figures/fig.json").write_text('{"title": "synthetic figure"}')
        (cls.root / "circumstances.json").write_text('{"profile": "smoke", "spacing": "15 um", "last_commit": "abc"}')
        # One artifact that was made from another one of the crate, and from a file outside of it.
        studies = json.loads((cls.root / "studies.json").read_text())
        sum_ = hashlib.sha256((cls.root / "verification.json").read_bytes()).hexdigest()
        studies["provenance"] = {**studies["provenance"], "inputs": [
            {"path": "verification.json", "sha256": sum_}, {"path": "data/x.toml", "sha256": "f" * 64}]}
        (cls.root / "studies.json").write_text(json.dumps(studies))
        cls.first = cls.write()
        cls.graph = {entity["@id"]: entity for entity in json.loads(cls.first)["@graph"]}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def write(cls):
        done = run(cls.root / "studies.json", cls.root / "verification.json",
                   cls.root / "work/powder_5wt/powder.h5", "--report", cls.root / "report", "--figures", cls.root / "figures",
                   "--circumstances", cls.root / "circumstances.json", "--base", cls.root)
        assert done.returncode == 0, done.stderr
        return (cls.root / "ro-crate-metadata.json").read_bytes()

    def test_the_descriptor_and_the_root_are_as_the_specification_asks(self):
        document = json.loads(self.first)
        self.assertIn("https://w3id.org/ro/crate/1.1/context", document["@context"])
        self.assertEqual(len(self.graph), len(document["@graph"]), "an @id is described twice")
        descriptor = self.graph["ro-crate-metadata.json"]
        self.assertEqual(descriptor["@type"], "CreativeWork")
        self.assertEqual(descriptor["about"], {"@id": "./"})
        self.assertEqual(descriptor["conformsTo"], {"@id": "https://w3id.org/ro/crate/1.1"})
        root = self.graph["./"]
        self.assertEqual(root["@type"], "Dataset")
        self.assertRegex(root["datePublished"], r"^\d{4}-\d{2}-\d{2}T")
        for key in ("name", "description", "license", "author"):
            self.assertTrue(root[key], key)
        self.assertEqual(self.graph[root["author"]["@id"]]["@type"], "Organization")
        self.assertIn(root["license"]["@id"], self.graph)

    def test_every_file_is_a_part_of_the_root_lies_there_and_has_its_checksum(self):
        parts = {part["@id"] for part in self.graph["./"]["hasPart"]}
        files = {name: entity for name, entity in self.graph.items() if entity["@type"] == "File"}
        self.assertEqual(parts, set(files))
        self.assertIn("work/powder_5wt/powder.h5", files)
        for name, entity in files.items():
            self.assertFalse(name.startswith(("/", "..")), name)
            self.assertEqual(hashlib.sha256((self.root / name).read_bytes()).hexdigest(), entity["sha256"], name)
            self.assertTrue(entity["encodingFormat"], name)

    def test_actions_name_their_program_what_they_read_and_what_they_made(self):
        actions = [entity for entity in self.graph.values() if entity["@type"] == "CreateAction"]
        self.assertEqual(len(actions), 4)
        for action in actions:
            self.assertEqual(self.graph[action["instrument"]["@id"]]["@type"], "SoftwareApplication")
            results = action["result"] if isinstance(action["result"], list) else [action["result"]]
            for reference in [*action["object"], *results, action["agent"]]:
                self.assertIn(reference["@id"], self.graph)
        read = self.graph["#making-studies.json"]["object"]
        self.assertEqual([reference["@id"] for reference in read], ["verification.json", "#input-" + 16 * "f"])

    def test_no_person_is_named_and_equal_files_give_equal_bytes(self):
        self.assertNotIn("Person", {entity["@type"] for entity in self.graph.values()})
        self.assertEqual(self.write(), self.first)


if __name__ == "__main__":
    unittest.main()
