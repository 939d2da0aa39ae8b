# SPDX-License-Identifier: GPL-3.0-or-later
"""The example workflows of docs/ci.md: they are YAML, run what exists, keep what the report writes, and pin known actions."""

import re
import unittest
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "docs/examples"
KEPT = {"reports/validation.pdf", "reports/validation.html", "reports/validation.json", "reports/ro-crate-metadata.json"}
ACTIONS = {"actions/checkout@v4", "actions/upload-artifact@v4"}


def read(name):
    return yaml.safe_load((EXAMPLES / name).read_text(encoding="utf-8"))


class Workflows(unittest.TestCase):
    def check_commands(self, commands):
        """Every `make` goal and variable of the commands exists in the Makefile."""
        text = "\n".join(path.read_text(encoding="utf-8") for path in
                         [ROOT / "Makefile", *sorted((ROOT / "pipelines").glob("*.mk"))])
        calls = [line.split()[1:] for command in commands for line in command.splitlines() if line.startswith("make ")]
        self.assertTrue(calls, commands)
        for words in calls:
            for word in words:
                if "=" in word:
                    name, setting = word.split("=")
                    self.assertRegex(text, rf"(?m)^{name} \?=")
                    self.assertIn(setting, re.search(r"(?m)^PROFILES := (.*)$", text).group(1).split())
                else:
                    self.assertRegex(text, rf"(?m)^{word}:")

    def test_github(self):
        workflow = read("github-actions.yml")
        self.assertIn(True, workflow)  # YAML 1.1 reads the key `on` as a truth value
        (job,) = workflow["jobs"].values()
        self.assertEqual(job["container"], "debian:12")
        used = {step["uses"] for step in job["steps"] if "uses" in step}
        self.assertEqual(used, ACTIONS)
        self.check_commands([step["run"] for step in job["steps"] if "run" in step])
        (upload,) = [step for step in job["steps"] if step.get("uses", "").startswith("actions/upload")]
        self.assertEqual(set(upload["with"]["path"].split()), KEPT)
        self.assertEqual(upload["if"], "always()")
        checkout = next(step for step in job["steps"] if step.get("uses", "").startswith("actions/checkout"))
        self.assertEqual(checkout["with"]["fetch-depth"], 0)

    def test_gitlab(self):
        job = read("gitlab-ci.yml")["validation"]
        self.assertEqual(job["image"], "debian:12")
        self.assertEqual(set(job["artifacts"]["paths"]), KEPT)
        self.assertEqual(job["artifacts"]["when"], "always")
        self.assertEqual(job["variables"]["GIT_DEPTH"], "0")
        self.check_commands(job["script"])

    def test_the_page_and_the_projects_own_run_agree_with_them(self):
        page = (ROOT / "docs/ci.md").read_text(encoding="utf-8")
        for link in re.findall(r"\]\(([^)#]+)\)", page):
            self.assertTrue((ROOT / "docs" / link).exists(), link)
        self.assertIn("make validate PROFILE=smoke", (ROOT / ".ci/run").read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
