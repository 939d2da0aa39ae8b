# SPDX-License-Identifier: GPL-3.0-or-later
"""Any number of ranks and threads, and a restart on another number of ranks, end in the same bytes."""

import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "output"))
from same_bytes import BIN, assert_same, command, environment, fields, launcher, run_case  # noqa: E402


class AnyNumberOfRanks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.root = Path(cls.place.name)
        cls.whole = cls.root / "whole"
        done = run_case(cls.whole, "--threads", 1)
        assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def run_and_compare(self, ranks, threads):
        folder = self.root / f"{ranks}x{threads}"
        done = run_case(folder, "--threads", threads, ranks=ranks)
        self.assertEqual(done.returncode, 0, done.stderr)
        assert_same(self, self.whole, folder)

    def test_one_rank_and_two_threads(self):
        self.run_and_compare(1, 2)

    def test_two_ranks(self):
        self.run_and_compare(2, 1)

    def test_two_ranks_of_two_threads(self):
        self.run_and_compare(2, 2)

    def test_four_ranks(self):
        self.run_and_compare(4, 1)

    def test_reflected_light_is_followed_across_ranks(self):
        """Of a beam that boils a deep hole, so that rays go from rank to rank."""
        options = ("--threads", 1, "--set", "laser.absorption=ray_traced", "--set", "laser.power=250 W")
        whole = self.root / "rays_whole"
        self.assertEqual(run_case(whole, *options).returncode, 0)
        self.assertNotEqual((whole / "history.csv").read_bytes(), (self.whole / "history.csv").read_bytes())
        for ranks in (2, 4):
            with self.subTest(ranks):
                folder = self.root / f"rays_{ranks}"
                done = run_case(folder, *options, ranks=ranks)
                self.assertEqual(done.returncode, 0, done.stderr)
                assert_same(self, whole, folder)

    def test_grains_that_conduct_best_exchange_in_substeps_across_ranks(self):
        """Grains of the additive in a powder bed, at a spacing where they would hold the step back."""
        bed = self.root / "bed.h5"
        subprocess.run([BIN / "meltproof-powder", "solver/cases/powder_1wt.toml", "--output", bed, "-q"], check=True)
        options = ("--threads", 1, "--powder", bed, "--set", "powder.surface=powder", "--set", "spacing=5 um",
                   "--set", "laser.exposure=30 us", "--set", "output.averaging_window=15 us",
                   "--set", "output.cooling_limit=10 us", "--set", "domain.depth=84 um")
        whole = self.root / "grains_whole"
        done = run_case(whole, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        steps = [float(line.split(",")[1]) for line in (whole / "history.csv").read_text().splitlines()[1:]]
        # us: 0.125 h^2 over the diffusivity of solid AlSi10Mg, which would be the longest step.
        self.assertGreater(max(steps), 0.125 * 5**2 / (155 / (7763 * 909.09) * 1e6) + 0.01)
        for ranks in (2, 4):
            with self.subTest(ranks):
                folder = self.root / f"grains_{ranks}"
                done = run_case(folder, *options, ranks=ranks)
                self.assertEqual(done.returncode, 0, done.stderr)
                assert_same(self, whole, folder)
        self.stop(self.root / "grains_stopped", 2, *options[2:], steps=25)
        done = run_case(self.root / "grains_stopped", "--restart", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("goes on from", done.stderr)
        assert_same(self, whole, self.root / "grains_stopped")

    def two_ranks_stop_and_one_goes_on(self, name, *options, steps):
        """Of a case that runs for seconds: mpirun takes its time to pass a signal on."""
        whole, folder = self.root / f"{name}_whole", self.root / name
        done = run_case(whole, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.stop(folder, 2, *options, steps=steps)
        done = run_case(folder, "--restart", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("goes on from", done.stderr)
        assert_same(self, whole, folder)

    def test_stopped_on_two_ranks_it_goes_on_on_one(self):
        self.two_ranks_stop_and_one_goes_on("flow", "--set", "spacing=10 um", steps=25)

    def test_without_flow_too(self):
        self.two_ranks_stop_and_one_goes_on("still", "--set", "flow.enabled=false", "--set", "spacing=6 um", steps=2)

    def stop(self, folder, ranks, *options, steps=25, at_once=False):
        """Sends SIGTERM, as a batch queue does, once there are checkpoints; at once to the ranks themselves, where
        mpirun, which takes its time to pass it on, could be too late for a case that runs for less than a second."""
        run = subprocess.Popen(launcher(ranks) + command(folder, "--checkpoint-steps", steps, "--threads", 1, *options),
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment(ranks))
        while len(list((folder / "checkpoints").glob("checkpoint_*.h5"))) < 2 and run.poll() is None:
            time.sleep(0.002)
        children = Path(f"/proc/{run.pid}/task/{run.pid}/children")
        for process in children.read_text().split() if at_once else [run.pid]:
            os.kill(int(process), signal.SIGTERM)
        _, said = run.communicate(timeout=120)
        self.assertNotEqual(run.returncode, 0, said)
        self.assertIn("--restart", said)
        self.assertFalse((folder / "run.h5").exists())

    def test_stopped_on_one_rank_it_goes_on_on_three(self):
        folder = self.root / "one_to_three"
        self.stop(folder, 0)
        done = run_case(folder, "--threads", 1, "--restart", ranks=3)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("goes on from", done.stderr)
        assert_same(self, self.whole, folder)

    def test_a_full_disk_stops_all_ranks_with_one_sentence_and_keeps_the_checkpoint_before(self):
        folder = self.root / "full"
        run = subprocess.Popen(launcher(3) + command(folder, "--checkpoint-steps", 20, "--threads", 1),
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment(3))
        while not (before := sorted((folder / "checkpoints").glob("checkpoint_*.h5"))) and run.poll() is None:
            time.sleep(0.002)
        # No file may grow to what a checkpoint needs any more: its room is refused as on a full disk.
        limit = before[-1].stat().st_size - 4096
        for rank in Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split():
            resource.prlimit(int(rank), resource.RLIMIT_FSIZE, (limit, limit))
        _, said = run.communicate(timeout=100)
        self.assertEqual(run.returncode, 1, said)
        self.assertEqual(said.count("cannot be written (is the disk full?)"), 1, said)
        kept = sorted((folder / "checkpoints").glob("*checkpoint_*.h5"))
        self.assertIn(f"the last good checkpoint is {kept[-1]}", said)
        self.assertTrue(kept[-1].name.startswith("checkpoint_"), kept)
        done = run_case(folder, "--restart", "--threads", 1, ranks=2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("goes on from", done.stderr)
        assert_same(self, self.whole, folder)

    def test_a_checkpoint_damaged_in_the_part_of_one_rank_is_passed_over_by_all(self):
        folder = self.root / "damaged"
        self.stop(folder, 2, steps=5, at_once=True)
        found = sorted((folder / "checkpoints").glob("checkpoint_*.h5"))
        with h5py.File(found[-1], "r+") as file:
            file["flow/pressure"][-1] += 1  # of the last rank: identities are rows
        done = run_case(folder, "--restart", "--threads", 1, ranks=3, timeout=100)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("flow/pressure does not have the checksum", done.stderr)
        self.assertIn("goes on from " + str(found[0]), done.stderr)
        assert_same(self, self.whole, folder)

    def test_the_number_of_ranks_does_not_show_in_a_checkpoint(self):
        """But for its provenance and the clocks among its numbers: fields and their checksums."""
        contents = []
        for ranks in (0, 2, 4):
            folder, kept = self.root / f"written_by_{ranks}", self.root / f"{ranks}.h5"
            place = folder / "checkpoints" / "checkpoint_000000000040.h5"
            run = subprocess.Popen(launcher(ranks) + command(folder, "--checkpoint-steps", 40, "--threads", 1),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment(ranks))
            while not place.exists() and run.poll() is None:
                time.sleep(0.002)
            os.link(place, kept)  # the run keeps the last two and removes all in the end
            self.assertEqual(run.wait(timeout=120), 0)
            contents.append(fields(kept))
        for one in contents[1:]:
            self.assertEqual(one.keys(), contents[0].keys())
            for name in set(one) - {"numbers"}:
                self.assertEqual(one[name], contents[0][name], name)

    def test_no_program_loads_two_hdf5_libraries(self):
        for program in sorted(BIN.iterdir()):
            libraries = subprocess.run(["ldd", program], capture_output=True, text=True).stdout
            kinds = {name for name in ("libhdf5_serial.so", "libhdf5_openmpi.so") if name in libraries}
            self.assertLess(len(kinds), 2, program)
            if program.name in ("meltproof-solve", "meltproof-powder", "meltproof-export", "meltproof-verify"):
                self.assertEqual(kinds, {"libhdf5_openmpi.so"}, program)

    def test_what_cannot_be_shared_is_refused_in_a_sentence(self):
        for setting, said in (("flow.surroundings=gas", 'flow.surroundings = "gas"'),
                              ("physics.surface_conduction=true", "physics.surface_conduction = true")):
            with self.subTest(setting):
                done = run_case(self.root / "refused", "--set", setting, ranks=2)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(done.stderr.count(f"{said} cannot be divided among several ranks"), 1, done.stderr)
                self.assertFalse((self.root / "refused" / "run.h5").exists())

    def test_processes_that_do_not_know_of_each_other_are_stopped(self):
        # As srun starts them without a PMIx that both sides speak: four runs into the same folder.
        done = subprocess.run(command(self.root / "alone"), capture_output=True, text=True,
                              env={**environment(0), "SLURM_STEP_NUM_TASKS": "4"})
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("4 processes that do not know of each other", done.stderr)
        self.assertFalse((self.root / "alone" / "run.h5").exists())

    def test_a_bad_input_is_said_once(self):
        done = run_case(self.root / "bad", "--set", "laser.power=-1 W", ranks=3)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("laser.power"), 1, done.stderr)


if __name__ == "__main__":
    unittest.main()
