# SPDX-License-Identifier: GPL-3.0-or-later
"""A run that is stopped, killed or damaged on the way ends in the same bytes as one that never was.

The full physics is on: melting, flow, surface tension, recoil, freezing. With an argument "long" the run is
killed (SIGKILL) at random moments fifty times."""

import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py
from same_bytes import assert_same, command, run_case


class Restart(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.root = Path(cls.place.name)
        cls.whole = cls.root / "whole"
        started = time.monotonic()
        done = run_case(cls.whole)
        cls.duration = time.monotonic() - started
        assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def stop_after(self, folder, seconds, how, *options):
        """Starts the run and sends it a signal; the run may end before."""
        run = subprocess.Popen(command(folder, *options), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            run.wait(timeout=seconds)
        except subprocess.TimeoutExpired:
            run.send_signal(how)
        said = run.stderr.read()
        run.stderr.close()
        return run.wait(), said

    def stop_at_a_checkpoint(self, folder, *options):
        """Stops the run by SIGTERM as soon as it has written two checkpoints."""
        run = subprocess.Popen(command(folder, "--checkpoint-steps", 25, *options), stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
        while len(self.checkpoints(folder)) < 2 and run.poll() is None:
            time.sleep(0.002)
        run.send_signal(signal.SIGTERM)
        self.printed, said = run.communicate(timeout=120)
        return run.returncode, said

    def checkpoints(self, folder):
        return sorted((folder / "checkpoints").glob("checkpoint_*.h5"))

    def assert_same(self, folder):
        assert_same(self, self.whole, folder)

    def test_a_stopped_run_goes_on_to_the_same_bytes_with_another_number_of_threads(self):
        folder = self.root / "stopped"
        status, said = self.stop_at_a_checkpoint(folder, "--threads", 1)
        self.assertEqual(status, 5, said)
        self.assertIn("--restart", said)
        self.assertRegex(self.printed, r"time: .*heat .*%.*flow .*%.*in all .* on 1 thread, \d+ steps")
        self.assertFalse((folder / "run.h5").exists())
        self.assertLessEqual(len(self.checkpoints(folder)), 2)
        done = run_case(folder, "--threads", 2, "--restart")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("goes on from", done.stderr)
        self.assert_same(folder)

    def test_a_damaged_checkpoint_is_passed_over_for_the_one_before(self):
        folder = self.root / "damaged"
        self.stop_at_a_checkpoint(folder)
        found = self.checkpoints(folder)
        self.assertEqual(len(found), 2)
        with h5py.File(found[-1], "r+") as file:
            file["enthalpy"][7] += 1e-3
        done = run_case(folder, "--restart")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("enthalpy does not have the checksum", done.stderr)
        self.assertIn("goes on from " + str(found[0]), done.stderr)
        self.assert_same(folder)

    def test_a_cut_file_is_passed_over_too(self):
        folder = self.root / "cut"
        self.stop_at_a_checkpoint(folder)
        found = self.checkpoints(folder)
        found[-1].write_bytes(found[-1].read_bytes()[:2000])
        done = run_case(folder, "--restart")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("goes on from " + str(found[0]), done.stderr)
        self.assert_same(folder)

    def test_another_input_is_refused_and_leaves_the_checkpoints_alone(self):
        folder = self.root / "other"
        self.stop_at_a_checkpoint(folder)
        before = self.checkpoints(folder)
        done = run_case(folder, "--restart", "--set", "laser.power=100 W")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("another input", done.stderr)
        self.assertEqual(self.checkpoints(folder), before)

    def test_a_checkpoint_of_another_revision_is_refused(self):
        folder = self.root / "revision"
        self.stop_at_a_checkpoint(folder)
        before = self.checkpoints(folder)
        for place in self.checkpoints(folder):
            with h5py.File(place, "r+") as file:
                file["provenance"].attrs["revision"] = "0123456789ab"
                del file["flow/recoil"]
        done = run_case(folder, "--restart")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("was made by revision 0123456789ab", done.stderr)
        self.assertIn("leave out --restart to begin anew", done.stderr)
        self.assertEqual(self.checkpoints(folder), before)

    def test_without_a_checkpoint_it_begins_and_without_restart_it_begins_anew(self):
        folder = self.root / "anew"
        done = run_case(folder, "--restart")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("from the beginning", done.stderr)
        shutil.rmtree(folder)
        self.stop_at_a_checkpoint(folder)
        done = run_case(folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("goes on", done.stderr)
        self.assert_same(folder)

    def test_a_disk_without_room_stops_the_run_with_a_sentence_and_keeps_the_checkpoint_before(self):
        folder = self.root / "full"
        self.stop_at_a_checkpoint(folder)
        before = self.checkpoints(folder)
        # No file may grow to what a checkpoint needs: writing it fails as on a full disk.
        limit = before[-1].stat().st_size - 4096

        def small_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        done = run_case(folder, "--restart", "--checkpoint-steps", 20, preexec_fn=small_files)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("cannot be written", done.stderr)
        self.assertIn("the last good checkpoint is " + str(before[-1]), done.stderr)
        self.assertEqual(self.checkpoints(folder), before)
        self.assertEqual(run_case(folder, "--restart").returncode, 0)
        self.assert_same(folder)

    @unittest.skipUnless("long" in sys.argv, "kills the run fifty times: only with the argument long")
    def test_killed_fifty_times_at_random_it_ends_in_the_same_bytes(self):
        seed = 20261123
        moments = random.Random(seed)
        folder = self.root / "killed"
        kills = 0
        while kills < 50:
            # Short enough that most runs do not end; each loses at most 10 steps.
            status, said = self.stop_after(folder, moments.uniform(0.02, 0.3) * self.duration, signal.SIGKILL,
                                           "--restart", "--checkpoint-steps", 10)
            if status == 0:
                self.assert_same(folder)
                shutil.rmtree(folder)
                continue
            self.assertEqual(status, -signal.SIGKILL, said)
            kills += 1
        done = run_case(folder, "--restart")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_same(folder)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
