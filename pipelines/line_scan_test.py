# SPDX-License-Identifier: GPL-3.0-or-later
"""From an export to the figure: a synthetic track, and a synthetic measurement in each of the vendors' formats.

No number here was measured. The track is a plate whose concentration falls from one side to the other; the
measurements are what the program itself says that EDS would see, written in another format and with another origin.
"""

import csv
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
BIN = Path(os.environ.get("MELTPROOF_BIN", ROOT / "build/release/bin"))
LINE = ["--start", "20 um, -25 um, -20 um", "--end", "20 um, 25 um, -20 um"]


def scan(*arguments):
    return subprocess.run([str(BIN / "meltproof-linescan"), *map(str, arguments)], capture_output=True, text=True,
                          cwd=ROOT)


def synthetic_run(path):
    """A plate of 40 x 80 x 40 um in spacings of 2 um; AlSi10Mg at y < -4 um, steel beyond, 6 um between them."""
    half = 1e-6
    axes = [np.arange(20) * 2e-6 + half, np.arange(-20, 20) * 2e-6 + half, np.arange(-20, 0) * 2e-6 + half]
    position = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    concentration = np.array([0.5 * math.erfc((y + 4e-6) / 6e-6) for y in position[:, 1]])
    with h5py.File(path, "w") as file:
        file.attrs["kind"] = "meltproof run"
        file["spacing"] = file["smoothing_length"] = 2e-6
        for name in ("0000", "0001"):
            group = file.create_group(f"snapshots/{name}")
            group["time"] = 1e-3
            group["position"] = position
            group["concentration"] = concentration
            group["identity"] = np.arange(len(position), dtype=np.int64)
            group["origin"] = np.where(np.linalg.norm(position - [2e-5, 2e-5, -6e-6], axis=1) < 4e-6, 2, 0).astype("i4")
            group["melted"] = (np.abs(position[:, 1]) <= 3e-5).astype("u1")


class LineScan(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        cls.run_file = cls.root / "run.h5"
        synthetic_run(cls.run_file)
        cls.pending = cls.compare("pending")
        position = np.array(cls.pending["simulated"]["position_um"])
        seen = np.array(cls.pending["simulated"]["concentration_seen"])
        # Every 1 um, 1.5 um further along, without the ends, so that it lies on the line for each shift.
        cls.position = np.arange(5.0, 45.0, 1.0)
        cls.concentration = np.interp(cls.position + 1.5, position, seen)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def compare(cls, name, *arguments):
        place = cls.root / f"{name}.json"
        done = scan(cls.run_file, *LINE, "--output", place, *arguments)
        assert done.returncode == 0, done.stderr
        return json.loads(place.read_text())

    def recovered(self, result, format_name):
        self.assertEqual(result["status"], "compared")
        self.assertEqual(result["measured"]["format"], format_name)
        self.assertAlmostEqual(result["registration"]["shift_um"], 1.5, delta=0.02)
        self.assertLess(result["metrics"]["RMSE"], 1e-3)
        self.assertGreater(result["metrics_before"]["RMSE"], 0.02)

    def alloy(self, symbol):
        """wt% of an element in the mixture, steel being iron alone."""
        share = {"Al": 89.65, "Si": 10.0, "Mg": 0.35}.get(symbol, 0)
        return self.concentration * share + (1 - self.concentration) * (100 if symbol == "Fe" else 0)

    def test_h5oina_line_with_spectra_that_nobody_decodes(self):
        path = self.root / "synthetic.h5oina"
        n = len(self.position)
        with h5py.File(path, "w") as file:
            file["Manufacturer"] = "synthetic, for a test"
            file["Format Version"] = "7.0"
            file["Index"] = ["1"]
            header, data = file.create_group("1/EDS/Header"), file.create_group("1/EDS/Data")
            for name, value in (("X Cells", np.int32(n)), ("Y Cells", np.int32(1)), ("X Step", np.float32(1)),
                                ("Y Step", np.float32(0)), ("Beam Voltage", np.float32(30))):
                header[name] = np.array([[value]])
            for symbol in ("Al", "Si", "Mg", "Fe"):
                data[f"Composition/{symbol}"] = self.alloy(symbol).astype("f4")[:, None]
                data[f"Composition Sigma/{symbol}"] = np.full((n, 1), 0.5, "f4")
            data.create_dataset("Spectrum", data=np.ones((n, 64), "i4"), compression="lzf")
        # The line of H5OINA begins at 0: its first point stands 6.5 um along the simulated one.
        result = self.compare("h5oina", "--measured", path, "--shift", "8 um", "--base", "Fe 100 %", "--element", "all")
        self.assertEqual(result["measured"]["format"], "H5OINA")
        self.assertAlmostEqual(result["registration"]["shift_um"], 6.5, delta=0.05)
        self.assertLess(result["metrics"]["RMSE"], 2e-3)
        self.assertLess(result["metrics"]["reduced_chi_square"], 1)
        self.assertLess(result["measured"]["agreement"]["Al_Si"]["rms_in_u"], 0.1)

    def test_csv_with_a_decimal_comma_from_the_other_end(self):
        path = self.root / "synthetic.csv"
        rows = [f"{50 - x:.3f};{al:.4f};0,5;{fe:.4f}".replace(".", ",")
                for x, al, fe in zip(self.position, self.alloy("Al"), 100 - self.alloy("Al"))]
        path.write_text("synthetic\nDistance (um);Al Wt%;Al Wt% Sigma;Fe Wt%\n" + "\n".join(rows[::-1]) + "\n")
        result = self.compare("csv", "--measured", path, "--shift", "3 um", "--reversible")
        self.assertTrue(result["registration"]["reversed"])
        self.assertAlmostEqual(abs(result["registration"]["shift_um"]), 1.5, delta=0.02)
        self.assertEqual(result["registration"]["fitted_parameters"], 2)

    def test_a_slot_that_a_user_fills_completes_the_figure(self):
        slot = self.root / "fig7_depth.csv"
        slot.write_text("# synthetic\nposition [um],concentration [%],concentration_u [%]\n")
        empty = self.compare("slot", "--measured", slot)
        self.assertEqual(empty["status"], "pending")
        self.assertIn("empty slot", empty["pending_because"])
        with slot.open("a", newline="") as file:
            csv.writer(file).writerows([x, 100 * c, 2] for x, c in zip(self.position, self.concentration))
        self.recovered(self.compare("slot", "--measured", slot, "--shift", "3 um"), "CSV export")
        for names, words in ((("pending", "pending"), "measurement pending"), (("slot", "slot"), "S - D [wt%]")):
            output = self.root / f"{names[0]}.svg"
            done = subprocess.run([sys.executable, ROOT / "pipelines/figures/fig07_profiles.py",
                                   *(self.root / f"{name}.json" for name in names), "--output", output],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(words, output.read_text())

    def test_what_is_odd_stands_in_the_result_and_on_standard_error(self):
        path = self.root / "odd.csv"
        path.write_text("Distance (um),Al Wt%,Al (ppm),Fe Wt%\n20,60,1,38\n21,50,1,49\n22,40,1,59\n")
        done = scan(self.run_file, *LINE, "--measured", path, "--output", self.root / "odd.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads((self.root / "odd.json").read_text())
        names = {warning["name"] for warning in result["warnings"]}
        self.assertLessEqual({"no_uncertainty", "export", "shorter_than_interaction_volume"}, names)
        for warning in result["warnings"]:
            self.assertIn(warning["sentence"], done.stderr)
        self.assertIsNone(result["metrics"]["reduced_chi_square"])

    def test_a_mistake_is_one_sentence_and_leaves_nothing(self):
        output = self.root / "never.json"
        for arguments, words in ((["--measured", "absent.csv"], "no such file"), (["--width", "-1 um"], "--width"),
                                 (["--beam", "y"], "--beam"), (["--voltage", "1 kV"], "1 keV make no X-rays")):
            done = scan(self.run_file, *LINE, "--output", output, *arguments)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertFalse(output.exists())
        self.assertIn("which run?", scan("--grain", "depth").stderr)

    def test_a_line_without_a_grain_or_material_becomes_no_result(self):
        output = self.root / "none.json"
        run = [str(BIN / "meltproof-linescan"), str(self.run_file), "--start", "0 um, 0 um, 500 um", "--end",
               "0 um, 9 um, 500 um", "--output", str(output)]
        done = subprocess.run([ROOT / "pipelines/line_scan.sh", output, *run], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(output.read_text())["status"], "no result")

    def test_the_same_run_gives_the_same_numbers(self):
        again = self.compare("again")
        for result in (self.pending, again):
            result.pop("provenance", None)
        self.assertEqual(self.pending, again)


if __name__ == "__main__":
    unittest.main()
