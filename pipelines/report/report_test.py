# SPDX-License-Identifier: GPL-3.0-or-later
"""The report: facts of its errata, equal bytes for equal artifacts, and what it says when something is wrong."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
import build_report  # noqa: E402
import errata_numbers  # noqa: E402
import rosenthal  # noqa: E402
import study_table  # noqa: E402
import synthetic_artifacts  # noqa: E402

# What an earlier, independent calculation of the same contradictions gave, and its last digit.
PUBLISHED = {
    "laplacian_printed": (3.98, 0.01), "laplacian_consistent": (1.99, 0.01), "printed_spread_mm": (20, 0.01),
    "half_space_at_middle": (0.651, 0.001), "stripe_at_middle": (0.303, 0.001), "activation_kJ_mol": (218, 1),
    "diffusivity_at_liquidus": (1.4e-11, 1e-12), "conductivity_jump_solidus": (1.8, 0.1),
    "conductivity_jump_liquidus": (2.5, 0.1), "enthalpy_jump_1132_kJ": (53.5, 0.1), "enthalpy_crossing_K": (922.4, 0.1),
    "enthalpy_jump_liquidus_kJ": (24.1, 0.1), "al_enthalpy_jump_kJ": (7.0, 0.1), "al_enthalpy_zero_K": (253, 1),
    "steel_enthalpy_zero_K": (302, 1), "viscosity_zero_K": (4405, 1), "molar_mass_as_sum": (332.14, 0.02),
    "molar_mass_average": (27.1, 0.1), "track_um": (390, 0.1), "domain_mm3": (0.0104, 1e-4),
    "range_iron_um": (3.16, 0.01), "range_aluminium_um": (8.24, 0.01), "largest_absorptivity": (0.764, 1e-6),
}


def run(script, *arguments):
    return subprocess.run([sys.executable, str(script), *map(str, arguments)], capture_output=True, text=True, cwd=ROOT,
                          env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000"})


class Errata(unittest.TestCase):
    def test_each_number_is_the_known_one(self):
        computed = errata_numbers.numbers(ROOT)
        self.assertEqual(sorted(computed), sorted(PUBLISHED))
        for name, (expected, digit) in PUBLISHED.items():
            self.assertAlmostEqual(computed[name], expected, delta=digit, msg=name)

    def test_the_text_uses_every_number_and_no_other(self):
        text = (ROOT / "reports/template/errata.toml").read_text(encoding="utf-8")
        used = set(re.findall(r"\{(\w+):", "\n".join(l for l in text.splitlines() if not l.startswith("#"))))
        self.assertEqual(used, set(PUBLISHED))


class Rosenthal(unittest.TestCase):
    def test_a_slow_source_makes_a_half_sphere(self):
        length, width, depth = rosenthal.pool(100, 0.5, 1e-9, 25, 5e-6, 1000)
        radius = 0.5 * 100 / (2 * 3.141592653589793 * 25 * 1000)
        for extent, expected in ((length, 2 * radius), (width, 2 * radius), (depth, radius)):
            self.assertAlmostEqual(extent, expected, delta=1e-3 * radius)

    def test_the_tail_does_not_depend_on_the_speed_and_a_fast_pool_is_as_deep_as_its_limit(self):
        strength = 0.4 * 175 / (2 * 3.141592653589793 * 30 * 1400)
        length, width, depth = rosenthal.pool(175, 0.4, 50.0, 30, 5e-6, 1400)
        self.assertAlmostEqual(length, strength, delta=0.01 * strength)
        # Far behind a fast source R + x = r^2 / (2 abs(x)): r^2 = (4 alpha abs(x) / v) ln(strength / abs(x)), largest at
        # abs(x) = strength / e.
        self.assertAlmostEqual(depth, (4 * 5e-6 * strength / (2.718281828 * 50.0)) ** 0.5, delta=0.03 * depth)
        self.assertAlmostEqual(width, 2 * depth)

    def test_constants_come_from_the_material(self):
        known = rosenthal.of_track({"initial_temperature": "293.15 K", "materials": {"base": "data/materials/316L.toml"},
                                    "laser": {"power": "175 W", "speed": "0.375 m s-1", "absorptivity": -1},
                                    "output": {}}, ROOT)
        self.assertAlmostEqual(known["k_W_m_K"], 9.59 + 0.0141 * 1633)
        self.assertEqual(known["absorptivity"], 0.4)


class Stale(unittest.TestCase):
    def test_a_run_is_stale_when_code_or_input_differ(self):
        run = {"revision": "synthetic", "inputs": [{"path": "Makefile", "sha256": "0" * 64}]}
        self.assertTrue(study_table.is_stale(run, "synthetic", ROOT))
        self.assertFalse(study_table.is_stale({**run, "inputs": []}, "synthetic", ROOT))
        self.assertTrue(study_table.is_stale({**run, "inputs": []}, "no-such-revision", ROOT))
        self.assertTrue(study_table.is_stale({"revision": "a-dirty", "inputs": []}, "a", ROOT))

    def test_a_track_of_other_code_is_stale_and_nothing_else(self):
        def old(program, revision):
            return build_report.is_old_track({"program": program, "revision": revision}, "synthetic", ROOT)
        self.assertTrue(old("meltproof-solve", "no-such-revision"))
        self.assertFalse(old("meltproof-solve", "synthetic"))
        self.assertFalse(old("meltproof-solve", "no-such-revision-dirty"))
        self.assertFalse(old("meltproof-compare", "no-such-revision"))

    def test_other_code_with_the_same_witness_makes_nothing_stale(self):
        run = {"revision": "synthetic", "inputs": [], "witness": "same"}
        self.assertFalse(study_table.is_stale(run, "no-such-revision", ROOT, "same"))
        self.assertTrue(study_table.is_stale(run, "no-such-revision", ROOT, "other"))
        self.assertTrue(study_table.is_stale({**run, "witness": None}, "no-such-revision", ROOT, None))
        changed = {**run, "inputs": [{"path": "Makefile", "sha256": "0" * 64}]}
        self.assertTrue(study_table.is_stale(changed, "no-such-revision", ROOT, "same"))


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        synthetic_artifacts.everything(cls.root)
        figures = HERE.parent / "figures"
        for name, inputs in (("fig01_diffusion", ["verification.json"]),
                             ("fig07_profiles", ["work/track_5wt/linescan_depth.json",
                                                 "work/track_5wt/linescan_lateral.json"])):
            run(figures / f"{name}.py", *[cls.root / path for path in inputs], "--output",
                cls.root / "figures" / f"{name}.svg").check_returncode()
        run(HERE / "circumstances.py", "--profile", "smoke", "--spacing", "15 um", "--output",
            cls.root / "circumstances.json").check_returncode()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def build(self, output, pdf=False, **changed):
        places = {"work": "work", "figures": "figures", "verification": "verification.json",
                  "comparison": "validation.json", "studies": "studies.json", "circumstances": "circumstances.json",
                  "estimate": "no_estimate.json"}
        places.update(changed)
        options = [part for name, place in places.items() for part in (f"--{name}", self.root / place)]
        return run(HERE / "build_report.py", *options, "--template", ROOT / "reports/template", "--output",
                   self.root / output, *([] if pdf else ["--no-pdf"]))

    def test_equal_artifacts_give_equal_bytes(self):
        for take in ("first", "second"):
            done = self.build(take, pdf=True)
            self.assertEqual(done.returncode, 0, done.stderr)
        for suffix in (".html", ".pdf"):
            first, second = ((self.root / take).with_suffix(suffix).read_bytes() for take in ("first", "second"))
            self.assertEqual(first, second, suffix)
        self.assertTrue((self.root / "first.pdf").read_bytes().startswith(b"%PDF-"))

    def test_the_page_says_what_agrees_differs_and_is_pending_and_loads_nothing(self):
        self.assertEqual(self.build("page").returncode, 0)
        page = (self.root / "page.html").read_text(encoding="utf-8")
        for words in ("Synthetic width", "Synthetic depth", "1 comparison: synthetic", "11 of 11 cases", "Figure 2.",
                      "growing; tends to 252", "synthetic extra 0.25", "Synthetic resolution", "not run yet:\nunmade",
                      "synthetic none", "<td>length</td><td class=\"number\">5.7</td>", "not run yet: radius_low, radius_high",
                      "both runs to one side", "not evaluated: radius", "estimate.json</code> is not there"):
            self.assertIn(words, page)
        self.assertFalse(re.findall(r'(?:src|href)="(?!#|data:)', page))
        names = re.findall(r'\bid="([^"]+)"', page)
        self.assertEqual(len({n for n in names if "figure" in n}), len([n for n in names if "figure" in n]))

    def test_the_pdf_holds_its_fonts_and_its_contents_name_the_pages(self):
        self.assertEqual(self.build("print", pdf=True).returncode, 0)
        fonts = subprocess.run(["pdffonts", self.root / "print.pdf"], capture_output=True, text=True, check=True).stdout
        rows = fonts.splitlines()[2:]
        self.assertGreaterEqual(len(rows), 3)
        for row in rows:
            self.assertEqual(row.split()[-5], "yes", row)  # emb
        text = subprocess.run(["pdftotext", "-layout", self.root / "print.pdf", "-"], capture_output=True, text=True,
                              check=True).stdout
        pages = text.split("\f")
        entries = re.findall(r"^\s*\d+\s+(.+?)\s*\.{4,}\s*(\d+)\s*$", text, re.M)
        self.assertGreaterEqual(len(entries), 10, entries)
        for title, page in entries:
            self.assertIn(title.split()[-1], pages[int(page) - 1], title)
        page = (self.root / "print.html").read_text(encoding="utf-8")
        self.assertEqual(page.count("@font-face"), 3)

    def test_every_link_leads_somewhere(self):
        self.assertEqual(self.build("links").returncode, 0)
        page = (self.root / "links.html").read_text(encoding="utf-8")
        links = set(re.findall(r'<a href="#([^"]+)"', page))
        self.assertGreater(len(links), 10)
        self.assertEqual(links - set(re.findall(r'\bid="([^"]+)"', page)), set())

    def test_a_series_that_does_not_converge_is_named(self):
        studies = json.loads((self.root / "studies.json").read_text())
        found = studies["series"][0]["quantities"]["depth"]
        found.update({"behaviour": "oscillates", "order": None, "extrapolated_um": None})
        (self.root / "oscillates.json").write_text(json.dumps(studies))
        self.assertEqual(self.build("oscillates", studies="oscillates.json").returncode, 0)
        page = (self.root / "oscillates.html").read_text(encoding="utf-8")
        self.assertIn("<strong>Does not converge:</strong> synthetic resolution: depth oscillates", page)

    def test_what_is_not_evaluated_is_named_on_the_first_page(self):
        comparison = json.loads((self.root / "validation.json").read_text())
        comparison["rows"][1]["details"] = {"u_val_is_lower_bound": True, "not_evaluated": ["u_D"]}
        (self.root / "sigma.json").write_text(json.dumps(comparison))
        self.assertEqual(self.build("sigma", comparison="sigma.json").returncode, 0)
        first = (self.root / "sigma.html").read_text(encoding="utf-8").split('id="contents"')[0]
        self.assertIn("a lower bound: u_D not fully evaluated", first)

    def test_the_papers_own_resolution_is_told_where_it_was_estimated(self):
        (self.root / "estimate.json").write_text(json.dumps(
            {"hours_two_cores": 500, "hours_64_ranks": 20, "particles": 1300000, "spacing_um": 2, "revision": "synthetic",
             "how": "made up for a test"}))
        self.assertEqual(self.build("estimated", estimate="estimate.json").returncode, 0)
        page = (self.root / "estimated.html").read_text(encoding="utf-8")
        self.assertIn("1 300 000 particles", page)
        self.assertIn("made up for a test (revision <code>synthetic</code>)", page)
        (self.root / "half.json").write_text('{"particles": 1}')
        self.assertEqual(self.build("half", estimate="half.json").returncode, 2)

    def test_a_failure_stands_at_the_top_and_fails_the_job(self):
        comparison = json.loads((self.root / "validation.json").read_text())
        comparison["failures"] = ['row "x": the table declares "agrees", but it differs']
        (self.root / "failed.json").write_text(json.dumps(comparison))
        self.assertEqual(self.build("failed", comparison="failed.json").returncode, 0)
        self.assertIn("but it differs", (self.root / "failed.html").read_text(encoding="utf-8").split("What was asked")[0])
        table = run(HERE / "results_table.py", "--verification", self.root / "verification.json", "--comparison",
                    self.root / "failed.json")
        self.assertEqual(table.returncode, 1)
        self.assertIn("but it differs", table.stderr)
        self.assertEqual(run(HERE / "results_table.py", "--verification", self.root / "verification.json",
                             "--comparison", self.root / "validation.json").returncode, 0)

    def test_a_missing_artifact_is_one_sentence_and_leaves_nothing(self):
        done = self.build("missing", comparison="absent.json")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn("absent.json does not exist", done.stderr)
        self.assertFalse(list(self.root.glob("missing*")))

    def test_circumstances_keep_their_date_when_nothing_changed(self):
        place = self.root / "circumstances.json"
        before = place.stat().st_mtime_ns
        run(HERE / "circumstances.py", "--profile", "smoke", "--spacing", "15 um", "--output", place).check_returncode()
        self.assertEqual(place.stat().st_mtime_ns, before)


if __name__ == "__main__":
    unittest.main()
