# SPDX-License-Identifier: GPL-3.0-or-later
"""A user adds a campaign, and fills a slot of the paper's, without touching code. All numbers here are synthetic."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BIN = Path(os.environ.get("MELTPROOF_BIN", ROOT / "build/release/bin"))
sys.path[:0] = [str(ROOT / "pipelines"), str(ROOT / "pipelines/figures")]
import synthetic_artifacts  # noqa: E402


def blocks(page):
    """The fenced blocks of the walk in validation/README.md, in their order."""
    walk = page.split("## A campaign of your own, step by step")[1].split("\n## ")[0]
    return [(kind, textwrap.dedent(body)) for kind, body in re.findall(r"^ *```(\w+)\n(.*?)^ *```$", walk, re.S | re.M)]


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def compare(root, table, profile="desk", studies=None):
    """meltproof-compare on the results below `root`; returns the process and the rows by name."""
    output = root / "validation.json"
    command = [BIN / "meltproof-compare", "--table", table, "--results", root / "reports/work", "--profile", profile,
               "--experiments", root / "data/experiments", "--output", output]
    done = subprocess.run([*map(str, command), *(["--studies", str(studies)] if studies else [])], capture_output=True,
                          text=True, cwd=ROOT)
    rows = {row["name"]: row for row in json.loads(output.read_text())["rows"]} if output.is_file() else {}
    return done, rows


class Walk(unittest.TestCase):
    """The walk of validation/README.md, as it stands there."""

    def test_the_walk_leads_from_a_folder_to_a_verdict(self):
        (_, numbers), (_, dataset), (_, case), (_, command), (_, row) = blocks(
            (ROOT / "validation/README.md").read_text(encoding="utf-8"))
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            campaign = root / "data/experiments/my_tracks"
            campaign.mkdir(parents=True)
            os.symlink(ROOT / "data/materials", root / "data/materials")
            (campaign / "tracks.csv").write_text(numbers)
            self.assertIn("SYNTHETIC", numbers)
            (campaign / "dataset.toml").write_text(dataset.replace("CHECKSUM", sha256(campaign / "tracks.csv")))
            (root / "solver/cases").mkdir(parents=True)
            (root / "solver/cases/track_mine.toml").write_text(case)
            (root / "validation").mkdir()
            table = root / "validation/comparisons.toml"
            table.write_text(row)

            # Before the run the row waits, and the measured number is there already.
            done, rows = compare(root, table)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual((rows["my_width"]["verdict"], rows["my_width"]["D"], rows["my_width"]["u_D"]), ("pending", 120, 6))

            program, *arguments = command.split()
            small = ["--set", "domain.depth=140 um", "--set", "domain.width=240 um", "--set", "domain.before=80 um",
                     "--set", "domain.behind=80 um", "--set", "laser.exposure=150 us", "--quiet"]
            made = subprocess.run([str(BIN / program), *arguments, *small], capture_output=True, text=True, cwd=root)
            self.assertEqual(made.returncode, 0, made.stdout + made.stderr)

            # Once it is there, the runner asks for the verdict to be declared, and says which it is.
            done, rows = compare(root, table)
            self.assertEqual(done.returncode, 1)
            self.assertIn('the table declares "pending"', done.stderr)
            found = rows["my_width"]
            self.assertIn(found["verdict"], ("agrees", "differs"))
            self.assertAlmostEqual(found["E"], found["S"] - 120)
            self.assertEqual(found["details"]["not_evaluated"], ["u_num", "u_input"])  # no studies here

            declared = row.replace('verdict = "pending"', f'verdict = "{found["verdict"]}"').replace(
                'waits_for = "simulation"\n', "")
            table.write_text(declared)
            done, rows = compare(root, table)
            self.assertEqual(done.returncode, 0, done.stderr)

            # With the studies nothing but what is not run yet is missing.
            studies = root / "studies.json"
            studies.write_text(json.dumps(
                {"quantities": {"width": {"relative_u": 0.03}},
                 "inputs": {"width": {"relative_u": 0.1, "parts": {"absorptivity": 0.1}, "sensitivities":
                                      {"absorptivity": 0.8}, "missing": ["diffusivity_law"]}}}))
            _, rows = compare(root, table, studies=studies)
            self.assertEqual(rows["my_width"]["details"]["not_evaluated"], [])
            self.assertAlmostEqual(rows["my_width"]["u_input"], 0.1 * rows["my_width"]["S"])

            self.refusals(root, campaign, table, numbers, dataset)

    def refusals(self, root, campaign, table, numbers, dataset):
        """What the walk may get wrong is a sentence in the row, which is not computed, and the job fails."""
        for change, words in ((("width [um]", "width [mm]"), "[mm] in the header where dataset.toml declares [um]"),
                              (("a,175,750,120,6", "a,175,750,wide,6"), '"wide" in column "width" is no number'),
                              (("a,175,750,120,6", "a,175,750,120"), "found 4 cells")):
            (campaign / "tracks.csv").write_text(numbers.replace(*change))
            (campaign / "dataset.toml").write_text(dataset.replace("CHECKSUM", sha256(campaign / "tracks.csv")))
            done, rows = compare(root, table)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(rows["my_width"]["verdict"], "not computed")
            self.assertIn(words, rows["my_width"]["finding"])
        (campaign / "dataset.toml").write_text(dataset)  # the checksum of nothing
        self.assertIn("SHA-256", compare(root, table)[1]["my_width"]["finding"])
        # A missing sigma is named, and not taken for zero.
        (campaign / "tracks.csv").write_text(numbers.replace("a,175,750,120,6", "a,175,750,120,"))
        (campaign / "dataset.toml").write_text(dataset.replace("CHECKSUM", sha256(campaign / "tracks.csv")))
        _, rows = compare(root, table)
        self.assertIsNone(rows["my_width"]["u_D"])
        self.assertIn("u_D", rows["my_width"]["details"]["not_evaluated"])
        self.assertIn("lower bound", rows["my_width"]["finding"])


class PapersFigure5(unittest.TestCase):
    """Somebody fills the slot of Fig. 5. The lengths are SYNTHETIC: made up here, measured by nobody."""

    CSV = ("# SYNTHETIC, for a test: nobody measured these.\nadditive [%],length [um],length_sd [um],frames [1]\n"
           "0,250,12,9\n1,262,12,9\n5,400,12,9\n")

    def test_the_rows_are_no_longer_pending_and_the_figure_shows_the_numbers(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            synthetic_artifacts.everything(root / "made")
            (root / "reports/work").mkdir(parents=True)
            os.symlink(root / "made/work", root / "reports/work/desk")
            shutil.copytree(ROOT / "data/experiments", root / "data/experiments")
            # The rows of Fig. 5 alone, as they stand in the table.
            text = (ROOT / "validation/comparisons.toml").read_text(encoding="utf-8")
            rows = [part for part in re.split(r"^(?=\[\[row\]\])", text, flags=re.M) if 'name = "fig5_length' in part]
            self.assertEqual(len(rows), 3)
            table = root / "table.toml"
            table.write_text("".join(re.split(r"^# ---", part, flags=re.M)[0] for part in rows))
            done, found = compare(root, table)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual({row["verdict"] for row in found.values()}, {"pending"})

            slot = root / "data/experiments/wimmer2021"
            before = sha256(slot / "fig5_length.csv")
            (slot / "fig5_length.csv").write_text(self.CSV)
            declared = (slot / "dataset.toml").read_text().replace(before, sha256(slot / "fig5_length.csv"))
            declared = declared.replace('obtained = "pending"', 'obtained = "digitised"', 1)
            self.assertEqual(tomllib.loads(declared)["file"][0]["obtained"], "digitised")
            (slot / "dataset.toml").write_text(declared)
            done, found = compare(root, table)
            self.assertEqual(done.returncode, 1)  # until the verdicts are declared
            self.assertEqual([found[f"fig5_length_{content}wt"]["verdict"] for content in (0, 1, 5)],
                             ["agrees", "agrees", "differs"])
            self.assertEqual(found["fig5_length_5wt"]["D"], 400)

            results = [root / f"made/work/track_{content}wt/result.json" for content in (0, 1, 5)]
            drawn = subprocess.run([sys.executable, ROOT / "pipelines/figures/fig05_length.py", *results,
                                    root / "validation.json", "--output", root / "fig05.svg"], capture_output=True, text=True)
            self.assertEqual(drawn.returncode, 0, drawn.stderr)
            caption = json.loads((root / "fig05.json").read_text())["caption"]
            self.assertIn("250 um (u 12) at 0 wt%, 262 um (u 12) at 1 wt%, 400 um (u 12) at 5 wt%", caption)
            self.assertNotIn("pending", caption + (root / "fig05.svg").read_text())


if __name__ == "__main__":
    unittest.main()
