# SPDX-License-Identifier: GPL-3.0-or-later
"""Every run that pipelines/studies.toml declares is one that the solver would take."""

import os
import subprocess
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BIN = Path(os.environ.get("MELTPROOF_BIN", ROOT / "build/release/bin"))


class Declared(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with (ROOT / "pipelines/studies.toml").open("rb") as file:
            cls.declared = tomllib.load(file)

    def validate(self, run):
        settings = [part for setting in run["set"] for part in ("--set", setting)]
        return subprocess.run([str(BIN / "meltproof-solve"), f"solver/cases/{run['track']}.toml", "--validate", *settings],
                              capture_output=True, text=True, cwd=ROOT)

    def test_the_solver_takes_every_run(self):
        for run in self.declared["run"]:
            with self.subTest(run=run["name"]):
                done = self.validate(run)
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_an_input_changes_nothing_but_its_key(self):
        """A sensitivity is that of one input only if its runs differ from their base in nothing else."""
        runs = {run["name"]: run for run in self.declared["run"]}
        for series in self.declared["series"]:
            if series["kind"] != "input":
                continue
            base = runs[series["base"]]
            for name in set(series["runs"]) - {series["base"]}:
                with self.subTest(series=series["name"], run=name):
                    added = set(runs[name]["set"]) ^ set(base["set"])
                    self.assertEqual({setting.split("=")[0] for setting in added}, {series["input"]})
                    self.assertEqual((runs[name]["track"], runs[name].get("powder")), (base["track"], base.get("powder")))

    def test_the_bases_value_of_an_input_is_the_one_declared(self):
        runs = {run["name"]: run for run in self.declared["run"]}
        resolved = tomllib.loads(self.validate(runs["base"]).stdout)
        number = lambda text: float(str(text).split()[0])  # noqa: E731
        self.assertEqual(number(resolved["flow"]["viscosity_factor"]), 20)
        self.assertAlmostEqual(number(resolved["laser"]["radius"]), 40e-6)
        values = {series["input"]: series.get("value") for series in self.declared["series"] if series["kind"] == "input"}
        self.assertEqual((values["flow.viscosity_factor"], values["laser.radius"]), ("20", "40 um"))
        with (ROOT / "data/materials/316L.toml").open("rb") as file:
            steel = tomllib.load(file)
        self.assertEqual(values["laser.absorptivity"], str(steel["absorptivity"]["value"]))
        self.assertEqual(values["output.pool_temperature"], steel["liquidus"]["value"])


if __name__ == "__main__":
    unittest.main()
