# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs as one chain, and what each says to a user's mistake: one sentence, a status, nothing half-written."""

import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BIN = Path(os.environ.get("MELTPROOF_BIN", ROOT / "build/release/bin"))
sys.path.insert(0, str(ROOT / "pipelines/figures"))
import artifact  # noqa: E402

# At 14 um a pool is the coarsest one that holds together under recoil; at 20 um (three layers deep) it flies to pieces.
SPACING = 14
SMALL = ["--set", f"spacing={SPACING} um", "--set", "laser.exposure=230 us", "--set", "domain.depth=140 um",
         "--set", "domain.width=240 um", "--set", "domain.before=80 um", "--set", "domain.behind=80 um",
         "--set", "output.averaging_window=100 us"]


def run(program, *arguments, **options):
    return subprocess.run([str(BIN / f"meltproof-{program}"), *map(str, arguments)], capture_output=True, text=True,
                          cwd=ROOT, **options)


class Chain(unittest.TestCase):
    """Powder, track, camera, thermography and line scan at a spacing that is for plumbing only, not for physics."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        cls.powder = cls.root / "powder.h5"
        done = run("powder", "solver/cases/powder_5wt.toml", "--output", cls.powder)
        assert done.returncode == 0, done.stderr
        cls.tracks = {}
        for threads in (1, 2):
            cls.tracks[threads] = cls.root / f"track_{threads}"
            done = run("solve", "solver/cases/track_5wt.toml", "--powder", cls.powder, "--output", cls.tracks[threads],
                       "--threads", threads, *SMALL)
            assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_energy_and_species_close(self):
        result = json.loads((self.tracks[2] / "result.json").read_text())
        self.assertLess(result["energy_relative_error"], 1e-6)
        self.assertLess(result["species_relative_error"], 1e-10)
        self.assertGreater(result["additive_wt_percent"], 0)

    def test_one_and_two_threads_give_the_same_bytes_in_every_field(self):
        with artifact.open_artifact(self.tracks[1] / "run.h5", "meltproof run") as one, \
                artifact.open_artifact(self.tracks[2] / "run.h5", "meltproof run") as two:
            names = []
            one.visititems(lambda name, item: names.append(name) if hasattr(item, "shape") else None)
            fields = [name for name in names if not name.startswith("provenance")]
            self.assertGreater(len(fields), 20)
            for name in fields:
                self.assertEqual(one[name][()].tobytes(), two[name][()].tobytes(), name)
                self.assertTrue(artifact.text(one[name].attrs["units"]), name)
        self.assertEqual((self.tracks[1] / "history.csv").read_bytes(), (self.tracks[2] / "history.csv").read_bytes())

    def test_a_filmed_pool_is_found_and_its_recording_calls_itself_synthetic(self):
        recording, folder = self.root / "recording.h5", self.root / "thermography"
        done = run("camera", self.tracks[2] / "run.h5", "--output", recording)
        self.assertEqual(done.returncode, 0, done.stderr)
        folder.mkdir()
        done = run("thermography", recording, "--output", folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        summary = json.loads((folder / "summary.json").read_text())
        self.assertTrue(summary["melt_pool_found"])
        self.assertTrue(summary["synthetic"])
        self.assertEqual((summary["width"], summary["height"]), (96, 40))

    def test_through_ideal_optics_the_filmed_length_is_the_simulated_one_at_the_same_moment(self):
        # Small pixels, no point spread, one emissivity: what is left between the two lengths is the chain
        # itself, and the section y = 0, off which grains of the next row may stick out. The paper's optics
        # shorten a pool that is two pixels deep; that is measured in imaging/camera, not here.
        recording, folder, settings = self.root / "ideal.h5", self.root / "ideal", self.root / "ideal.toml"
        settings.write_text('[sensor]\nwidth = 384\nheight = 160\nintegration_time = "1 us"\n[optics]\n'
                            'pixel_size = "4.4 um"\npoint_spread = 0\n[surface]\nemissivity_liquid = 0.3\n'
                            '[view]\nsurface_row = 48\n')
        done = run("camera", self.tracks[2] / "run.h5", "--output", recording, "--settings", settings)
        self.assertEqual(done.returncode, 0, done.stderr)
        done = run("thermography", recording, "--output", folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        frames = artifact.read_table(folder / "frames.csv")
        history = artifact.read_table(self.tracks[2] / "history.csv")
        time = artifact.column(history, "time", "history.csv")
        simulated = artifact.column(history, "pool_length", "history.csv")
        filmed = [(1e6 * float(t), float(length)) for t, length in zip(
            artifact.column(frames, "time", "frames.csv"), artifact.column(frames, "length", "frames.csv"))]
        moment, length = filmed[-1]
        nearest = min(range(len(time)), key=lambda k: abs(time[k] - moment))
        self.assertGreater(length, 100)
        self.assertLess(abs(length - simulated[nearest]), 2 * SPACING, (moment, length, simulated[nearest]))

    def scan(self, name, start, end):
        place = self.root / name
        done = run("linescan", self.tracks[2] / "run.h5", "--start", start, "--end", end, "--output", place)
        self.assertEqual(done.returncode, 0, done.stderr)
        line = json.loads(place.read_text())
        self.assertEqual(line["status"], "pending")
        return line["simulated"]["concentration"]

    def test_a_line_below_the_plates_surface_runs_through_metal(self):
        # It may meet a pore, which has no concentration, but is metal else.
        found = self.scan("line.json", "50 um, -60 um, -10 um", "50 um, 60 um, -10 um")
        self.assertGreater(sum(value is not None for value in found), 0.75 * len(found))

    def test_a_line_through_molten_additive_shows_it(self):
        # Where the few grains of so short a track end is chance, so the line goes to where one is.
        with artifact.open_artifact(self.tracks[2] / "run.h5", "meltproof run") as run_file:
            last = run_file["snapshots"][sorted(run_file["snapshots"])[-1]]
            richest, (x, y, z) = max(
                (float(c), tuple(1e6 * at)) for c, at, melted in zip(
                    last["concentration"][()], last["position"][()], last["melted"][()]) if melted)
        self.assertGreater(richest, 0.01)
        found = [value for value in self.scan("rich.json", f"{x} um, {y - 40} um, {z} um",
                                              f"{x} um, {y + 40} um, {z} um") if value is not None]
        # The microscope averages over a particle and its neighbours.
        self.assertGreater(max(found), 0.2 * richest)
        self.assertLessEqual(max(found), 1.0001 * richest)


class Studies(unittest.TestCase):
    """One run of the studies at plumbing size; then there is nothing left to do."""

    def studies(self, root, *options):
        settings = [part for value in SMALL if value != "--set" for part in ("--set", value)]
        return subprocess.run([sys.executable, "pipelines/studies.py", "pipelines/studies.toml", "--solver",
                               BIN / "meltproof-solve", "--powder", BIN / "meltproof-powder", "--work", root / "work",
                               "--results", root / "results", *settings, *options],
                              capture_output=True, text=True, cwd=ROOT)

    def test_a_run_is_made_once_and_summarised(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            done = self.studies(root, "--only", "flow_off")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            kept = json.loads((root / "results/flow_off.json").read_text())
            for key in ("length_um", "width_sd_um", "peak_temperature_K", "evaporated_share", "revision", "inputs"):
                self.assertTrue(kept[key] or kept[key] == 0, key)
            self.assertEqual(len(kept["witness"]), 64)
            self.assertIn("nothing to do", self.studies(root, "--only", "flow_off").stdout)
            # Other code, but the same numbers: nothing to renew. Other numbers: once more.
            for changed, words in (({"revision": "0" * 12}, "nothing to do"),
                                   ({"revision": "0" * 12, "witness": "0" * 64}, "1 runs to make")):
                (root / "results/flow_off.json").write_text(json.dumps({**kept, **changed}))
                self.assertIn(words, self.studies(root, "--only", "flow_off", "--again").stdout)
            done = self.studies(root, "--only", "no_such_run")
            self.assertEqual(done.returncode, 2)
            self.assertIn("no_such_run", done.stderr)
            done = run("studies", "pipelines/studies.toml", "--results", root / "results", "--output", root / "studies.json")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(len(json.loads((root / "studies.json").read_text())["runs"]), 1)


class Mistakes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.output = self.root / "output"

    def tearDown(self):
        self.folder.cleanup()

    def refused(self, done, *words):
        """Status 2, one sentence that holds the words, nothing written."""
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        sentences = [line for line in done.stderr.strip().splitlines() if line]
        self.assertEqual(len(sentences), 1, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        written = [path for path in self.output.rglob("*") if path.is_file()] if self.output.exists() else []
        self.assertEqual(written, [])

    def case(self, old, new):
        text = (ROOT / "solver/cases/track_316L_175W_750.toml").read_text()
        self.assertIn(old, text)
        text = text.replace("../../data", str(ROOT / "data")).replace(old, new)
        path = self.root / "case.toml"
        path.write_text(text)
        return path

    def test_wrong_unit(self):
        done = run("solve", self.case('power = "175 W"', 'power = "175 kg"'), "--output", self.output)
        self.refused(done, "case.toml:14", "laser.power", "kg", "expected a quantity in W")

    def test_number_without_unit(self):
        done = run("solve", self.case('power = "175 W"', "power = 175"), "--output", self.output)
        self.refused(done, "case.toml", "power")

    def test_unknown_key(self):
        done = run("solve", self.case('power = "175 W"', 'power = "175 W"\npowre = "1 W"'), "--output", self.output)
        self.refused(done, "case.toml", "powre")

    def test_missing_files(self):
        self.refused(run("solve", self.root / "absent.toml", "--output", self.output), "absent.toml")
        self.refused(run("powder", self.root / "absent.toml", "--output", self.output / "powder.h5"), "absent.toml")
        self.refused(run("camera", self.root / "absent.h5", "--output", self.output / "recording.h5"), "absent.h5")
        self.refused(run("thermography", self.root / "absent.ptw", "--output", self.output), "absent.ptw")
        self.refused(run("linescan", self.root / "absent.h5", "--grain", "depth", "--output",
                         self.output / "line.json"), "absent.h5")
        self.refused(run("calibrate", self.root / "absent.tiff", "--graduation", "100 um", "--graduation-is", "period",
                         "--output", self.output / "scale.json"), "absent.tiff")
        self.refused(run("compare", "--table", self.root / "absent.toml", "--results", self.root, "--profile", "desk",
                         "--output", self.output / "validation.json"), "absent.toml")
        self.refused(run("verify", self.root / "absent", "--output", self.output / "verification.json"), "absent")

    def test_a_text_file_named_ptw(self):
        path = self.root / "note.ptw"
        path.write_text("this is no recording\n")
        self.refused(run("thermography", path, "--output", self.output), "note.ptw")

    def test_a_truncated_recording_keeps_its_whole_frames_and_says_so(self):
        sample = ROOT / "../shared/samples/cedip_pyradi_PyradiSampleMWIR.ptw"
        if not sample.is_file():
            self.skipTest("the vendors' sample files are not beside this checkout (../shared/samples)")
        path = self.root / "cut.ptw"
        path.write_bytes(sample.read_bytes()[:500000])
        done = run("thermography", path, "--output", self.output)
        self.assertEqual(done.returncode, 4, done.stdout + done.stderr)
        summary = json.loads((self.output / "summary.json").read_text())
        self.assertEqual(summary["frames"], (500000 - 3476) // (1016 + 69 * 64 * 2))
        self.assertIn("lost", done.stdout + done.stderr)

    def test_a_recording_without_a_pool_says_so(self):
        sample = ROOT / "../shared/samples/cedip_pyradi_PyradiSampleMWIR.ptw"
        if not sample.is_file():
            self.skipTest("the vendors' sample files are not beside this checkout (../shared/samples)")
        done = run("thermography", sample, "--output", self.output)
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("No melt pool", done.stdout)
        summary = json.loads((self.output / "summary.json").read_text())
        self.assertFalse(summary["melt_pool_found"])
        with (self.output / "frames.csv").open() as file:
            self.assertEqual(len(list(csv.reader(file))), 1 + summary["frames"])


class MakeProcess(unittest.TestCase):
    """The job of the Makefile for a recording; the build stands already when CTest runs."""

    def process(self, **variables):
        environment = {key: content for key, content in os.environ.items() if not key.startswith(("MAKE", "MFLAGS"))}
        environment.update(variables)
        return subprocess.run(["bash", "pipelines/process_recording.sh"], capture_output=True, text=True, cwd=ROOT,
                              env=environment)

    def test_without_a_recording_it_says_how_to_call_it(self):
        done = self.process(RECORDING="")
        self.assertEqual(done.returncode, 2)
        self.assertIn("make process RECORDING=", done.stderr)

    def test_a_missing_recording_and_an_unexplained_scale_are_refused(self):
        self.assertIn("does not exist", self.process(RECORDING="no such/file.ptw").stderr)
        scale = "data/scales/synthetic_across_x.h5"
        done = self.process(RECORDING=scale, CALIBRATION=scale)
        self.assertEqual(done.returncode, 2)
        self.assertIn("GRADUATION_IS", done.stderr)

    @unittest.skipUnless((BIN / "meltproof-thermography").exists() and BIN == ROOT / "build/release/bin",
                         "needs the build of the preset release")
    def test_a_path_with_spaces_is_processed(self):
        sample = ROOT / "../shared/samples/meltpool_sample_img.bmp"
        if not sample.is_file():
            self.skipTest("the vendors' sample files are not beside this checkout (../shared/samples)")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a melt pool.bmp"
            shutil.copyfile(sample, path)
            output = Path(folder) / "the results"
            done = self.process(RECORDING=str(path), OUTPUT=str(output))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            summary = json.loads((output / "summary.json").read_text())
            self.assertTrue(summary["melt_pool_found"])
            self.assertEqual((summary["frames"], summary["width"], summary["height"]), (1, 120, 128))
            self.assertTrue((output / "annotated.png").stat().st_size > 0)


if __name__ == "__main__":
    unittest.main()
