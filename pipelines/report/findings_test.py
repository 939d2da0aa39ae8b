# SPDX-License-Identifier: GPL-3.0-or-later
"""What the report says in words, and its numbers of sections, tables and figures."""

import sys
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(HERE), str(HERE.parent / "figures")]
import findings  # noqa: E402
import numbering  # noqa: E402


class Findings(unittest.TestCase):
    """Every run in here is synthetic."""

    U = {"length": 0.02, "width": 0.03, "depth": None}

    def run_of(self, name, length, clumped=0.0):
        return {"name": name, "title": f"synthetic {name}", "length_um": length, "width_um": 100.0, "depth_um": 50.0,
                "clumped_fraction": clumped}

    def studies(self, *runs):
        return {"runs": runs, "inputs": [], "quantities": {extent: {"relative_u": u} for extent, u in self.U.items()}}

    def test_conduction_alone_is_what_an_independent_calculation_gave(self):
        by = findings.conduction_of_content(ROOT, 0.05)
        for part, percent in (("liquidus", 3), ("absorptivity", -4), ("conductivity", -15), ("all", -15)):
            self.assertAlmostEqual(100 * by[part], percent, delta=0.6, msg=part)

    def test_an_effect_is_judged_by_the_numerical_uncertainty(self):
        base = self.run_of("base", 300.0)
        said = findings.effect(self.run_of("hot", 330.0), base, self.U)
        self.assertIn("length 300 to 330 um, +10.0 % (beyond 2 u_num)", said)
        self.assertIn("width 100 to 100 um, +0.0 % (within 2 u_num)", said)
        self.assertTrue(said.endswith("depth 50 to 50 um, +0.0 %."), said)

    def test_a_run_that_clumps_does_not_count_and_one_that_is_missing_is_named(self):
        studies = self.studies(self.run_of("base", 300.0), self.run_of("torn", 900.0, 0.3))
        found = findings.of_runs("?", 1, "base", ["torn", "absent"], studies)
        self.assertIn("its melt clumps (30 %", found["sentences"][0])
        self.assertNotIn("900", found["sentences"][0])
        self.assertEqual(found["missing"], ["absent"])
        self.assertEqual(findings.of_runs("?", 1, "nobody", ["torn"], studies)["sentences"], [])

    def test_what_is_absorbed_stands_beside_what_was_measured(self):
        run = {**self.run_of("trapp_65W", 200.0), "absorbed_share": 0.41}
        found = findings.absorbed_light(self.studies(run), ROOT)
        self.assertIn("65 W, 500 mm/s, 60 um spot: absorbed 41 % (measured 31 %), width 100 um (75), depth 50 um (28).",
                      found["sentences"][0])
        self.assertEqual(found["missing"], ["trapp_99W", "trapp_134W", "trapp_178W"])
        self.assertEqual(findings.absorbed_light(self.studies(), ROOT)["sentences"], [])

    def test_the_rise_is_said_by_definition_with_its_verdict(self):
        def row(name, values, trend, verdict):
            return {"name": name, "S": values[1] - values[0], "u_val": 3.0, "coverage": 2, "verdict": verdict,
                    "details": {"values": values, "uncertainties": [2.0, 2.0, 2.0], "trend": trend}}
        rows = [row("fig5_trend_pool", [300.0, 301.0, 299.0], "undecided", "differs"),
                row("fig5_trend_any_liquid", [300.0, 320.0, 350.0], "rises", "agrees")]
        said = findings.rise_of_length(rows, "no/work", ROOT)
        self.assertIn("so this differs.", said["sentences"][0])
        self.assertIn("rises beyond k u at every step", said["sentences"][1])
        self.assertIn("so this agrees.", said["sentences"][1])
        self.assertIn("19 um at 1 wt%, 51 um at 5 wt%", said["sentences"][2])
        self.assertEqual(len(findings.rise_of_length([], "no/work", ROOT)["missing"]), 2)


class Numbering(unittest.TestCase):
    PAGE = ('<nav id="contents"></nav><section id="one"><h2>First</h2>[[t]] [[two]]</section>\n<section id="two">\n'
            '<h2>Second</h2><table><caption id="t">words</caption></table><figure id="f">x<figcaption>y</figcaption>'
            "</figure></section>")

    def test_sections_tables_and_figures_are_numbered_and_linked(self):
        page = numbering.number(self.PAGE)
        self.assertIn('<a href="#t">Table 1</a> <a href="#two">Section 2</a>', page)
        self.assertIn("<strong>Table 1.</strong> words", page)
        self.assertIn("<figcaption><strong>Figure 1.</strong> y", page)
        self.assertIn('<li><a href="#two">2&ensp;Second</a></li>', page)

    def test_a_link_to_nothing_is_refused(self):
        with self.assertRaises(numbering.MissingArtifact):
            numbering.number(self.PAGE + "[[nowhere]]")


if __name__ == "__main__":
    unittest.main()
