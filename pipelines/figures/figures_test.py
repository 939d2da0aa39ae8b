# SPDX-License-Identifier: GPL-3.0-or-later
"""Every figure draws the same bytes twice, and says in a sentence what it misses."""

import contextlib
import io
import json
import re
import runpy
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE)]
import synthetic_artifacts  # noqa: E402

TRACKS = ("0wt", "1wt", "5wt")
INPUTS = {
    "fig01_diffusion": ["verification.json"],
    "fig02_conduction": ["verification.json"],
    "fig03_flow_cases": ["verification.json"],
    "fig03b_free_surface": ["verification.json"],
    "fig04_powder_and_pool": ["work/powder_5wt/powder.h5", "work/track_5wt/run.h5"],
    "fig05_length": [f"work/track_{track}/result.json" for track in TRACKS]
                    + [f"work/track_{track}/thermography/summary.json" for track in TRACKS] + ["validation.json"],
    "fig06_flow": ["work/track_0wt/run.h5"],
    "fig07_profiles": ["work/track_5wt/linescan_depth.json", "work/track_5wt/linescan_lateral.json"],
    "fig08_history": [f"work/track_{track}/result.json" for track in TRACKS],
    "fig09_camera": ["work/track_5wt/recording.h5", "work/track_5wt/thermography/summary.json"],
    "fig11_resolution": ["studies.json"],
    "fig12_sensitivity": ["studies.json"],
    "fig13_tornado": ["studies.json"],
    "fig14_scatter": ["validation.json"],
    "fig10_bare_plate": ["work/track_316L_175W_750/run.h5", "work/track_316L_175W_750/result.json", "validation.json"],
}


def draw(name, inputs, output):
    """Runs a figure's script here, not in a process of its own: loading matplotlib takes longer than drawing."""
    said, before, status = io.StringIO(), sys.argv, 0
    sys.argv = [str(HERE / f"{name}.py"), *map(str, inputs), "--output", str(output)]
    try:
        with contextlib.redirect_stderr(said):
            runpy.run_path(sys.argv[0], run_name="__main__")
    except SystemExit as end:
        status = end.code or 0
    finally:
        sys.argv = before
    return subprocess.CompletedProcess(name, status, stderr=said.getvalue())


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        synthetic_artifacts.everything(cls.root)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_every_script_is_tested(self):
        self.assertEqual(sorted(INPUTS), sorted(path.stem for path in HERE.glob("fig[0-9]*.py")))

    def test_a_profile_of_two_lines_is_drawn_as_two(self):
        """The cavity's table holds u along one middle line, then v along the other."""
        import numpy as np
        import verification
        place = np.array([0.1, 0.5, 0.9, 0.05, 0.5, 0.95])
        drawn = verification.curves(place, np.arange(6.0))
        self.assertEqual([list(line) for line, _ in drawn], [[0.1, 0.5, 0.9], [0.05, 0.5, 0.95]])
        scattered = verification.curves(np.array([3.0, 1, 4, 1, 5, 2, 6, 0, 7, 1]), np.arange(10.0))
        self.assertEqual(len(scattered), 1)
        self.assertEqual(list(scattered[0][0]), [0, 1, 1, 1, 2, 3, 4, 5, 6, 7])

    def test_equal_artifacts_give_equal_bytes_and_units_on_every_axis(self):
        for name, inputs in INPUTS.items():
            with self.subTest(figure=name):
                bytes_of = []
                for take in ("first", "second"):
                    output = self.root / take / f"{name}.svg"
                    done = draw(name, [self.root / path for path in inputs], output)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    bytes_of.append((output.read_bytes(), output.with_suffix(".json").read_bytes()))
                self.assertEqual(bytes_of[0], bytes_of[1])
                # matplotlib keeps each text as a comment beside its glyphs
                labels = re.findall(r"<!-- (.*?) -->", bytes_of[0][0].decode())
                self.assertTrue(any(re.search(r"\[.+\]$", label) for label in labels), labels[:20])

    def test_a_missing_artifact_is_one_sentence_and_leaves_nothing(self):
        for name, inputs in INPUTS.items():
            for missing in range(len(inputs)):
                with self.subTest(figure=name, missing=inputs[missing]):
                    paths = [self.root / path for path in inputs]
                    paths[missing] = paths[missing].with_name("absent-" + paths[missing].name)
                    output = self.root / "missing" / f"{name}.svg"
                    done = draw(name, paths, output)
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
                    self.assertIn(paths[missing].name, done.stderr)
                    self.assertFalse(output.exists())

    def test_a_line_scan_without_a_result_says_so_in_the_figure(self):
        empty = self.root / "none.json"
        empty.write_text('{"status": "no result", "reason": "no grain melted.", "simulated": null}')
        output = self.root / "none.svg"
        done = draw("fig07_profiles", [empty, self.root / "work/track_5wt/linescan_lateral.json"], output)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no grain melted", output.read_text())
        self.assertIn("no grain melted", output.with_suffix(".json").read_text())

    def test_studies_that_are_not_run_yet_are_said_to_be_missing(self):
        empty = self.root / "no_studies.json"
        empty.write_text('{"runs": [], "series": [{"kind": "resolution", "missing": ["a"], "base": "a", "runs": ["a"]}]}')
        for name in ("fig11_resolution", "fig12_sensitivity", "fig13_tornado"):
            output = self.root / f"none_{name}.svg"
            done = draw(name, [empty], output)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("not run yet", output.read_text())

    def test_the_tornado_names_the_largest_input_what_is_missing_and_what_bends(self):
        output = self.root / "tornado.svg"
        self.assertEqual(draw("fig13_tornado", [self.root / "studies.json"], output).returncode, 0)
        words = json.loads(output.with_suffix(".json").read_text())["caption"]
        self.assertIn("length: synthetic absorptivity first, 10 %", words)
        self.assertIn("Without runs so far: synthetic radius.", words)
        self.assertIn("the steeper slope counts (synthetic slope)", words)
        self.assertEqual(len(re.findall(r"<!-- +\* -->", output.read_text())), 3)  # its mark, in each panel

    def test_the_papers_figure_5_completes_itself_once_its_rows_hold_numbers(self):
        """The lengths are synthetic: 200, 210 and 260 um are nobody's measurement."""
        comparison = json.loads((self.root / "validation.json").read_text())
        one = comparison["rows"][0]
        filled = [dict(one, name=f"fig5_length_{content}wt", D=length, u_D=u) for content, length, u in
                  ((0, 200.0, 7.0), (1, 210.0, None), (5, 260.0, 9.0))]
        place, output = self.root / "filled_validation.json", self.root / "filled.svg"
        for rows, words, pending in ((filled, "200 um (u 7) at 0 wt%, 210 um (no uncertainty given) at 1 wt%", False),
                                     (filled[:1], "2 slots are empty", True), ([], "Measured lengths are pending", True)):
            place.write_text(json.dumps({**comparison, "rows": rows}))
            inputs = [self.root / path for path in INPUTS["fig05_length"][:-1]]
            self.assertEqual(draw("fig05_length", [*inputs, place], output).returncode, 0)
            self.assertIn(words, json.loads(output.with_suffix(".json").read_text())["caption"])
            self.assertEqual("measurement pending" in output.read_text(), pending)

    def test_a_scatter_without_rows_says_so(self):
        place, output = self.root / "rowless_validation.json", self.root / "rowless.svg"
        place.write_text('{"rows": [], "statistics": []}')
        self.assertEqual(draw("fig14_scatter", [place], output).returncode, 0)
        self.assertIn("no row has both numbers", output.read_text())

    def test_a_section_fills_a_lattice_and_leaves_a_gap(self):
        import h5py
        import numpy as np
        import sections
        path = self.root / "gap.h5"
        with h5py.File(path, "w") as file:
            grid = np.stack(np.meshgrid(*[np.arange(8) * 1e-5] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
            hole = np.all(np.abs(grid - 3.5e-5) < 1.1e-5, axis=1)
            position = grid[~hole] - 3.5e-5
            synthetic_artifacts.put(file, "snapshots/0000/position", position, "m")
            synthetic_artifacts.put(file, "snapshots/0000/temperature", 300 + 1e6 * position[:, 0], "K")
            synthetic_artifacts.put(file, "spacing", 1e-5, "m")
            values, extent, first, second = sections.raster(file, "snapshots/0000", "temperature", "y")
        self.assertEqual((first, second, values.shape), ("x", "z", (32, 32)))
        self.assertTrue(np.isnan(values[15:17, 15:17]).all())
        self.assertFalse(np.isnan(values[:8, :]).any())
        self.assertAlmostEqual(values[4, 16] - values[4, 12], 10, delta=1)  # 4 pixels are one spacing
        self.assertAlmostEqual(extent[1] - extent[0], 80)

    def test_the_cooling_rate_is_speed_times_slope_behind_the_pool(self):
        import h5py
        import numpy as np
        path, spacing, slope, speed = self.root / "cooling.h5", 1e-5, 5e6, 0.4
        grid = np.stack(np.meshgrid(np.arange(80), np.arange(-3, 4), np.arange(-4, 0), indexing="ij"), axis=-1)
        position = spacing * grid.reshape(-1, 3)
        with h5py.File(path, "w") as file:
            file.attrs["kind"] = "meltproof run"
            for name, number, unit in (("spacing", spacing, "m"), ("scan_speed", speed, "m s-1"), ("exposure", 1e-3, "s")):
                synthetic_artifacts.put(file, name, number, unit)
            for number, time in enumerate((6e-4, 7e-4, 8e-4)):
                behind = 7e-4 - position[:, 0]
                synthetic_artifacts.put(file, f"snapshots/{number:04d}/time", time, "s")
                synthetic_artifacts.put(file, f"snapshots/{number:04d}/position", position, "m")
                synthetic_artifacts.put(file, f"snapshots/{number:04d}/temperature",
                                        np.where(behind > 0, 3000 - slope * behind, 300.0), "K")
        script = HERE.parent / "cooling_rate.py"
        for share, status in ((0.5, 0), (0.1, 2)):
            done = subprocess.run([sys.executable, str(script), str(path), "--share", str(share), "--output",
                                   str(self.root / "rate.json")], capture_output=True, text=True)
            self.assertEqual(done.returncode, status, done.stderr)
        rate = json.loads((self.root / "rate.json").read_text())
        self.assertAlmostEqual(rate["cooling_rate_K_s"] / (speed * slope), 1, delta=1e-6)
        self.assertEqual(rate["snapshots"], 3)

    def test_a_wrong_kind_of_artifact_is_refused(self):
        done = subprocess.run([sys.executable, str(HERE / "fig04_powder_and_pool.py"),
                               *[str(self.root / "work/track_5wt/run.h5")] * 2, "--output", str(self.root / "x.svg")],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("'meltproof run', where a 'meltproof powder bed' is needed", done.stderr)


if __name__ == "__main__":
    unittest.main()
