# SPDX-License-Identifier: GPL-3.0-or-later
"""`make process` on synthetic recordings of meltproof-camera: the report says what was measured, of what kind the
recording is and where every parameter comes from; a folder is one recording or a campaign by its content."""

import concurrent.futures
import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BIN = Path(os.environ.get("MELTPROOF_BIN", ROOT / "build/release/bin"))
sys.path.insert(0, str(HERE))
import campaign  # noqa: E402
from material_test import material  # noqa: E402

SCALE = "data/scales/synthetic_across_x.h5"


def film(*films):
    """Films analytic pools at the same time: a path and an absorbed power each."""
    cameras = [begin_film(path, power) for path, power in films]
    for camera in cameras:
        said = camera.communicate()[1]
        assert camera.returncode == 0, said


def begin_film(path, power):
    settings = path.with_suffix(".settings.toml")
    settings.write_text(f'[view]\nsurface_row = 19.6\n[rosenthal]\nview = "top"\nframes = 52\n'
                        f'absorbed_power = "{power} W"\n')
    return subprocess.Popen([str(BIN / "meltproof-camera"), "--rosenthal", "--settings", str(settings), "--seed", "3",
                             "--output", str(path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            cwd=ROOT)


def process(**variables):
    environment = {key: text for key, text in os.environ.items() if not key.startswith(("MAKE", "MFLAGS"))}
    environment.update({"MELTPROOF_BIN": str(BIN), "SOURCE_DATE_EPOCH": "0", **variables})
    return subprocess.run(["bash", "pipelines/process_recording.sh"], capture_output=True, text=True, cwd=ROOT,
                          env=environment, check=False)


class Runs:
    """What takes long, begun together before the first test: the recordings filmed, then a pool, a recording without
    one and a campaign each processed."""

    def __init__(self, folder):
        self.pool, self.tracks = folder / "a pool.h5", folder / "tracks"
        self.tracks.mkdir()
        film((self.pool, 62), *((self.tracks / f"{name}.h5", power)
                                for name, power in (("a", 58), ("b", 60), ("c", 66))))
        (self.tracks / "campaign.csv").write_text(
            "file,additive_wt_percent,speed_m_s\na.h5,0,0.375\nb.h5,0,0.375\nc.h5,5,0.375\n")
        self.output, self.bare, self.joined = folder / "out", folder / "bare", folder / "joined"
        with concurrent.futures.ThreadPoolExecutor() as together:
            one, without, campaign_run = (together.submit(process, **variables) for variables in (
                {"RECORDING": str(self.pool), "OUTPUT": str(self.output), "CALIBRATION": SCALE, "GRADUATION": "100 um",
                 "GRADUATION_IS": "period", "MATERIAL": "316L"},
                {"RECORDING": SCALE, "OUTPUT": str(self.bare)},
                {"RECORDING": str(self.tracks), "OUTPUT": str(self.joined)}))
        self.one, self.without, self.campaign = one.result(), without.result(), campaign_run.result()


def setUpModule():
    global KEPT, RUNS
    KEPT = tempfile.TemporaryDirectory()
    RUNS = Runs(Path(KEPT.name))


def tearDownModule():
    KEPT.cleanup()


class OneRecording(unittest.TestCase):
    def setUp(self):
        self.done, self.output = RUNS.one, RUNS.output
        self.assertEqual(self.done.returncode, 0, self.done.stdout + self.done.stderr)
        self.page = (self.output / "report.html").read_text()
        self.summary = json.loads((self.output / "summary.json").read_text())

    def test_length_and_depth_with_their_intervals_are_in_the_first_lines(self):
        answer = self.page[self.page.index('class="answer"'):]
        answer = answer[:answer.index("</p>")]
        for name in ("length", "depth"):
            budget = self.summary["budget"][f"{name}_um"]
            low, high = budget["interval_95"]
            self.assertIn(f"{budget['value']:.4g} µm</strong>, 95 % interval {low:.4g} to {high:.4g} µm", answer)

    def test_it_is_called_synthetic_on_top_and_at_every_picture(self):
        self.assertLess(self.page.index("Synthetic recording, no measurement"), self.page.index('class="answer"'))
        captions = self.page.split("<figcaption>")[1:]
        self.assertGreaterEqual(sum("synthetic" in c.split("</figcaption>")[0].lower() for c in captions), 5)
        self.assertIn("The picture of the scale is synthetic", self.page)

    def test_every_parameter_says_where_it_comes_from(self):
        rows = {row["name"]: row for row in self.summary["parameters"]}
        self.assertEqual((rows["reference temperature"]["value"], rows["reference temperature"]["source"]),
                         (1683, "given"))
        self.assertEqual((rows["freezing heat"]["value"], rows["freezing heat"]["source"]), (0.209, "given"))
        self.assertEqual(rows["transmission of the windows"]["source"], "file")
        self.assertEqual(rows["pixel size along x"]["source"], "calibration")
        self.assertEqual(rows["scan speed"]["source"], "unknown")
        self.assertEqual(rows["point spread, sigma"]["source"], "calibration")
        self.assertAlmostEqual(rows["point spread, sigma"]["value"], 0.8, delta=0.02)
        self.assertLess(rows["point spread, sigma"]["u"], 0.06)  # by the scatter of single rows at SNR 20
        for words in ("given by you", "your calibration", "the recording&#39;s file", "nobody says it",
                      "liquidus of 316L", "Its freezing heat is 0.209: 274.7 kJ/kg between solidus (1633 K)"):
            self.assertIn(words, self.page)

    def test_the_tail_is_drawn_with_the_reference_signal(self):
        self.assertTrue(self.summary["reference_signal"]["used"])
        with (self.output / "tail.csv").open() as file:
            rows = [[float(cell) for cell in row] for row in list(csv.reader(file))[1:]]
        near = min(rows, key=lambda row: abs(row[0]))
        self.assertLess(abs(near[0]), 3)  # the front lies within the profile
        misfit = sum(((row[1] - row[3]) / row[2]) ** 2 for row in rows) / len(rows)
        self.assertLess(misfit, 4)  # the exported model is the one that was fitted
        self.assertIn("S* is the signal of liquid metal", self.page)

    def test_a_length_that_rests_on_an_emissivity_says_what_would_narrow_it(self):
        with tempfile.TemporaryDirectory() as folder:
            settings, output = Path(folder) / "settings.toml", Path(folder) / "out"
            settings.write_text('reference_signal = "off"\nemissivity_liquid = 0.3\n')
            done = process(RECORDING=str(RUNS.pool), OUTPUT=str(output), SETTINGS=str(settings))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            page = (output / "report.html").read_text()
            for said in ("They are not independent of the emissivity", "Most of the interval is what is not known of "
                         "the emissivity. It would be narrower", "MATERIAL", "35 % (assumed"):
                self.assertIn(said, page)
            self.assertIn("It would be narrower", done.stdout)
        self.assertNotIn("It would be narrower", self.page)

    def test_a_front_that_is_placed_vaguely_is_used_with_a_caution(self):
        with tempfile.TemporaryDirectory() as folder:
            settings, output = Path(folder) / "settings.toml", Path(folder) / "out"
            settings.write_text("[reference]\nuncertainty = 0.001\n")
            done = process(RECORDING=str(RUNS.pool), OUTPUT=str(output), SETTINGS=str(settings))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            page = (output / "report.html").read_text()
        self.assertIn("<strong>Caution:</strong> the recording shows a front, but places it only so", page)
        self.assertIn("Caution: the recording shows a front", done.stdout)
        self.assertNotIn("Caution", self.page)

    def test_the_page_moves_and_the_pdf_is_one(self):
        self.assertIn("The frames in turn", self.page)
        self.assertEqual((self.output / "report.pdf").read_bytes()[:5], b"%PDF-")
        from PIL import Image

        with Image.open(self.output / "animation.png") as moving:
            self.assertEqual(moving.n_frames, len(self.summary["film_frames"]))

    def test_the_same_inputs_give_the_same_bytes(self):
        before = {name: (self.output / name).read_bytes() for name in ("report.html", "report.pdf", "animation.png")}
        again = subprocess.run(["pipelines/python.sh", "pipelines/recording_report/recording_report.py",
                                str(self.output), "--calibration", str(self.output / "calibration.json"), "--material",
                                material("316L")[2]], cwd=ROOT, env={**os.environ, "SOURCE_DATE_EPOCH": "0"},
                               check=False)
        self.assertEqual(again.returncode, 0)
        for name, content in before.items():
            self.assertEqual((self.output / name).read_bytes(), content, name)


class WithoutAPool(unittest.TestCase):
    def test_the_report_says_why(self):
        self.assertEqual(RUNS.without.returncode, 3, RUNS.without.stdout + RUNS.without.stderr)
        page = (RUNS.bare / "report.html").read_text()
        self.assertIn("<strong>No melt pool.</strong>", page)
        self.assertNotIn("<h2>Uncertainty</h2>", page)

    def test_an_unknown_material_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            done = process(RECORDING=SCALE, OUTPUT=str(Path(folder) / "out"), MATERIAL="unobtainium")
            self.assertEqual(done.returncode, 2)
            self.assertIn("neither a file nor a material", done.stderr)
            self.assertFalse((Path(folder) / "out").exists())


class WhatCannotBeUsed(unittest.TestCase):
    def test_it_is_said_with_its_name_and_nothing_is_left_behind(self):
        with tempfile.TemporaryDirectory() as kept:
            folder = Path(kept)
            (folder / "notes.ptw").write_text("Monday: cleaned the lens.\n")
            (folder / "empty.seq").write_bytes(b"")
            (folder / "other.json").write_text('{"x": 1}')
            (folder / "pool.h5").symlink_to(RUNS.pool)
            scale = {"GRADUATION": "100 um", "GRADUATION_IS": "period"}
            for variables, said in (
                    ({"RECORDING": "notes.ptw"}, "its content is text"),
                    ({"RECORDING": "empty.seq"}, "the file is empty"),
                    ({"RECORDING": "gone.ptw"}, "does not exist"),
                    ({"RECORDING": "pool.h5", "CALIBRATION": "other.json"}, "pixel_size_x_um is missing"),
                    ({"RECORDING": "pool.h5", "CALIBRATION": "pool.h5"}, "say also its graduation"),
                    ({"RECORDING": "pool.h5", "CALIBRATION": "notes.ptw", **scale}, "notes.ptw' gives no pixel size"),
                    # A pool is no scale: no result of the calibration, and for the whole a wrong input.
                    ({"RECORDING": "pool.h5", "CALIBRATION": "pool.h5", **scale}, "pool.h5' gives no pixel size")):
                given = {key: str(folder / text) if key in ("RECORDING", "CALIBRATION") else text
                         for key, text in variables.items()}
                done = process(OUTPUT=str(folder / "out"), **given)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertIn(said, done.stderr)
                self.assertFalse((folder / "out").exists(), said)


class Folders(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.folder = Path(self.kept.name)

    def tearDown(self):
        self.kept.cleanup()

    def test_pictures_of_one_frame_are_one_recording(self):
        from PIL import Image

        frames = [Image.new("I;16", (8, 8), i) for i in range(3)]
        for i, frame in enumerate(frames):
            frame.save(self.folder / f"{i}.tiff")
        self.assertFalse(campaign.is_campaign(self.folder))
        frames[0].save(self.folder / "3.tiff", save_all=True, append_images=frames[1:])
        self.assertTrue(campaign.is_campaign(self.folder))

    def test_folders_and_a_table_are_a_campaign(self):
        (self.folder / "track").mkdir()
        self.assertTrue(campaign.is_campaign(self.folder))
        (self.folder / "track").rmdir()
        self.assertFalse(campaign.is_campaign(self.folder))
        (self.folder / "campaign.csv").write_text("file\n")
        self.assertTrue(campaign.is_campaign(self.folder))

    def test_a_wrong_table_is_refused_in_a_sentence(self):
        (self.folder / "a.ptw").write_bytes(b"")
        for text, said in (('[[track]]\nfile = "a.ptw"\npower = 175\n', "no key `power`"),
                           ('[[track]]\nfile = "b.ptw"\n', "is not in"),
                           ('[[track]]\nfile = "a.ptw"\nspeed_m_s = "fast"\n', "expected a number"),
                           ('[[track]]\nfile = "a.ptw"\n[[track]]\nfile = "a.ptw"\n', "twice"),
                           ('title = "x"\n', "expected tables [[track]]")):
            (self.folder / "campaign.toml").write_text(text)
            with self.assertRaisesRegex(campaign.Refused, said.replace("[", r"\[").replace("]", r"\]")):
                campaign.tracks_of(self.folder)
        (self.folder / "campaign.toml").unlink()
        (self.folder / "campaign.csv").write_text("file,additive_wt_percent\na.ptw,5,1\n")
        with self.assertRaisesRegex(campaign.Refused, "not as many cells"):
            campaign.tracks_of(self.folder)
        (self.folder / "campaign.csv").write_text('file,additive_wt_percent\na.ptw,"0,5"\n')
        with self.assertRaisesRegex(campaign.Refused, "decimal point"):
            campaign.tracks_of(self.folder)

    def test_a_campaign_draws_length_against_content(self):
        done, output = RUNS.campaign, RUNS.joined
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("== track 3 of 3: c.h5", done.stdout)
        with (output / "campaign.csv").open() as file:
            rows = list(csv.DictReader(file))
        lengths = [float(row["length [um]"]) for row in rows]
        for row, length in zip(rows, lengths):
            track = json.loads((output / row["file"] / "summary.json").read_text())
            self.assertAlmostEqual(track["budget"]["length_um"]["value"], length, delta=1e-3)
            self.assertLess(abs(track["speed_relative_error"]), 0.01)
        page = (output / "campaign.html").read_text()
        self.assertIn(f"0 wt%: length <strong>{(lengths[0] + lengths[1]) / 2:.4g} µm", page)
        self.assertIn(f"5 wt%: length <strong>{lengths[2]:.4g} µm", page)
        self.assertGreater(lengths[2], lengths[1])
        self.assertIn("all of the 3 recordings were computed by the virtual camera", page)
        self.assertIn("Length against additive content", page)
        self.assertTrue((output / "campaign.pdf").is_file())


if __name__ == "__main__":
    unittest.main()
