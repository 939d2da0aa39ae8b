# SPDX-License-Identifier: GPL-3.0-or-later
"""`make bench` writes what it promises: every figure, with what is asked, or the sentence why there is none."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "pipelines"))
from bench_scaling import AGREEMENTS, BANDWIDTH, LATENCY, scaling  # noqa: E402

BIN = Path(os.environ.get("MELTPROOF_BIN", ROOT / "build/release/bin"))
# A pool of a few particles, a second of work: for plumbing only.
TINY = ["solver/cases/track_0wt.toml", "--set", "powder.surface=bare", "--set", "spacing=14 um",
        "--set", "laser.exposure=100 us", "--set", "domain.depth=98 um", "--set", "domain.width=196 um",
        "--set", "domain.before=80 um", "--set", "domain.behind=80 um"]
MEASURED = ["pair_loop_Mupd_per_core_f64", "pair_loop_simd_over_scalar", "whole_step_Mupd_per_core",
            "active_set_speedup", "camera_real_time_factor", "bytes_per_particle"]


def call(*command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, cwd=ROOT)


def bench(*arguments):
    return call(BIN / "meltproof-bench", *arguments)


def join(*arguments):
    return call(sys.executable, ROOT / "pipelines/bench.py", ROOT / "pipelines/bench.toml", *arguments)


def benchmark(name, rates, **counters):
    return [{"name": name, "run_type": "iteration", "repetition_index": k, "items_per_second": rate,
             "real_time": 1.0, "cpu_time": 1.0, "time_unit": "ms", **counters} for k, rate in enumerate(rates)]


class Bench(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        cls.step = cls.root / "step.json"
        done = bench(*TINY, "--until", "80 us", "--window", "1 us", "--repeats", "2", "--output", cls.step)
        assert done.returncode == 0, done.stderr
        cls.pairs = cls.root / "pairs.json"
        # Repeats lie in the file in the order in which they were drawn.
        cls.pairs.write_text(json.dumps({"benchmarks": [
            *reversed(benchmark("pair_loop/lanes", [2e6, 4e6, 3e6])),
            *benchmark("pair_loop/scalar", [1e6, 1e6, 0.5e6]),
            *benchmark("extraction/memory/real_time", [19525.0, 97625.0], frame_rate=9762.5)]}))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_whole_steps_are_written_with_their_spread(self):
        result = json.loads(self.step.read_text())
        for key in ("whole_step_Mupd_per_core", "active_set_speedup", "flow_Mupd_per_core"):
            made = result["figures"][key]
            self.assertEqual(len(made["repeats"]), 2)
            self.assertGreater(made["min"], 0)
            self.assertLessEqual(made["min"], made["median"])
            self.assertLessEqual(made["median"], made["max"])
            self.assertTrue(made["unit"] and made["how"])
        step = result["details"]["step"]
        self.assertGreater(step["liquid_particles"], 0)
        for engine in ("as_tracks_run", "nothing_skipped", "everything_computed"):
            self.assertAlmostEqual(sum(step[engine]["share_of_time"].values()), 1, 9)
        self.assertEqual(result["provenance"]["program"], "meltproof-bench")

    def test_a_model_of_more_ranks_is_fitted_to_what_few_of_them_sent(self):
        # Made up: four messages of a step, bytes that fall with the square root of the ranks, 10 % uneven a doubling.
        runs = {f"ranks_{n}": {"ranks": n, "particles": 1000, "messages_per_rank_and_acoustic_step": 4.0, "most_copies_on_a_rank": 50,
                               "bytes_per_rank_and_acoustic_step": 1e6 * n ** -0.5, "acoustic_steps": 100,
                               "largest_over_mean_work": 1 + 0.1 * (n.bit_length() - 1), "seconds_on_one": [4.0, 6.0],
                               "parts_on_one_s": {"flow": 6.0, "heat": 2.5, "state": 1.5}}
                for n in (2, 4, 8)}
        found = scaling(runs)
        self.assertAlmostEqual(found["model"]["bytes_exponent"], -0.5)
        self.assertAlmostEqual(found["model"]["uneven_per_doubling"], 0.1)
        self.assertAlmostEqual(found["seconds_per_acoustic_step_on_one_rank"], 0.1)
        of_64 = next(row for row in found["says"] if row["ranks"] == 64)
        expected = 0.1 / (0.1 / 64 * 1.6 + 0.15 * 50 * 0.1 / 1000 + 4 * LATENCY + 1e6 / 8 / BANDWIDTH + 6 * AGREEMENTS * LATENCY)
        self.assertAlmostEqual(of_64["strong_speedup"], expected)
        self.assertLess(of_64["strong_efficiency"], 1)
        # Half of the particles on each: copies and bytes as on two ranks, unevenness as on 64.
        expected = 0.05 / (0.05 * 1.6 + 0.15 * 50 * 0.1 / 1000 + 4 * LATENCY + 1e6 * 2 ** -0.5 / BANDWIDTH + 6 * AGREEMENTS * LATENCY)
        self.assertAlmostEqual(of_64["weak_efficiency"], expected)
        self.assertIsNone(scaling({"step": {}}))

    def test_parts_are_joined_and_what_does_not_exist_is_said_to_be_pending(self):
        output = self.root / "bench.json"
        done = join(self.step, self.pairs, "--output", output)
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(output.read_text())
        figures = result["figures"]
        for key in MEASURED:
            self.assertEqual(figures[key]["value"], figures[key]["median"])
            self.assertIsInstance(figures[key]["met"], bool)
            self.assertTrue(figures[key]["unit"] and figures[key]["how"], key)
        self.assertIsNone(figures["ranks_2_over_1"]["value"])
        self.assertIn("nothing was run on two ranks", figures["ranks_2_over_1"]["pending"])
        self.assertEqual(figures["pair_loop_Mupd_per_core_f64"]["repeats"], [2, 4, 3])
        self.assertEqual(figures["pair_loop_simd_over_scalar"]["repeats"], [2, 4, 6])
        self.assertEqual(figures["camera_real_time_factor"]["max"], 10)
        self.assertIn("pending: nothing was run on two ranks", done.stdout)
        self.assertTrue(result["revision"] and result["machine"]["processor"] and result["machine"]["lanes_f64"])
        self.assertFalse(list(self.root.glob("*.tmp*")))

    def test_mistakes_are_sentences_and_nothing_is_written(self):
        output = self.root / "none.json"
        for arguments, sentence in (
                (["nowhere.toml", "--output", output], "nowhere.toml cannot be opened"),
                ([*TINY, "--output", output, "--stage", "flight"], "--stage flight: there is no such stage"),
                ([*TINY, "--output", output, "--until", "3 mm"], "mm"),
                ([*TINY, "--output", output, "--until", "99 us"], "are more than the beam's 100 us"),
                ([*TINY, "--output", output, "--until", "0 us"], "expected a time above zero"),
                ([*TINY, "--output", output, "--repeats", "0"], "--repeats"),
                ([*TINY], "--output is missing")):
            done = bench(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(sentence, done.stdout + done.stderr)
        for arguments, sentence in (
                ([self.root / "gone.json", "--output", output], "cannot be read"),
                (["README.md", "--output", output], "is no JSON")):
            done = join(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(sentence, done.stderr)
        self.assertFalse(output.exists())

    def test_help_teaches(self):
        said = bench("--help").stdout
        for word in ("Example:", "Stages:", "--until", "Exit status"):
            self.assertIn(word, said)


if __name__ == "__main__":
    unittest.main()
