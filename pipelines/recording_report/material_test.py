# SPDX-License-Identifier: GPL-3.0-or-later
"""What `make process MATERIAL=` hands on of a material's file: liquidus and freezing heat."""

import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def material(named):
    """The three lines that material.py says of a material."""
    done = subprocess.run(["pipelines/python.sh", "pipelines/recording_report/material.py", str(named)], check=True,
                          capture_output=True, text=True, cwd=ROOT)
    return done.stdout.removesuffix("\n").split("\n")


class Material(unittest.TestCase):
    def test_the_freezing_heat_is_that_of_the_material_s_own_enthalpy(self):
        # Heat between solidus and liquidus in J/kg, specific heats of solid and liquid, liquidus: README of data/materials.
        for named, heat, solid, liquid, liquidus in (("316L", 274.7e3, 714.29, 847.46, 1683),
                                                     ("IN625", 58.85 * 4431.82, 681.36, 750.65, 1622),
                                                     ("IN718", 76 * 3457.34, 645.56, 720, 1609)):
            temperature, freezing, words = material(named)
            self.assertEqual(temperature, f"{liquidus} K")
            self.assertAlmostEqual(float(freezing), heat / (0.5 * (solid + liquid) * liquidus), delta=2e-4)
            self.assertIn(f"Its freezing heat is {float(freezing):.3g}: {heat / 1e3:.4g} kJ/kg", words)
            self.assertIn(f"{named}.toml", words)

    def test_the_latent_heat_may_stand_in_several_pieces(self):
        whole, parts = "5494.51 J kg-1 K-1", ("3000 J kg-1 K-1", "7989.02 J kg-1 K-1")
        text = (ROOT / "data/materials/316L.toml").read_text()
        old = f'from = "1633 K"\nto = "1683 K"\nslope = "{whole}"'
        new = (f'from = "1633 K"\nto = "1658 K"\nslope = "{parts[0]}"\n\n[[enthalpy.piece]]\n'
               f'from = "1658 K"\nto = "1683 K"\nslope = "{parts[1]}"')
        self.assertIn(old, text)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "two.toml"
            path.write_text(text.replace(old, new))
            self.assertEqual(material(path)[1], material("316L")[1])

    def test_a_file_that_says_less_gives_its_liquidus_alone_and_the_sentence_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "own.toml"
            for more, said in (("", "it has no solidus"),
                               ('[solidus]\nvalue = "1360 degC"\n', 'its solidus is "1360 degC"'),
                               ('[solidus]\nvalue = "1700 K"\n', "its solidus is not below its liquidus"),
                               ('[solidus]\nvalue = "1633 K"\n', "it has no enthalpy by pieces"),
                               ('[solidus]\nvalue = "1633 K"\n[[enthalpy.piece]]\nfrom = "298 K"\nto = "1633 K"\n'
                                'slope = "714 J kg-1 K-1"\n', "does not reach beyond solidus and liquidus")):
                path.write_text('name = "own"\n[liquidus]\nvalue = "1683 K"\nsource = "me"\n' + more)
                temperature, freezing, words = material(path)
                self.assertEqual((temperature, freezing), ("1683 K", ""))
                self.assertIn("was not handed on", words)
                self.assertIn(said, words)


if __name__ == "__main__":
    unittest.main()
