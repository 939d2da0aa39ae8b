# SPDX-License-Identifier: GPL-3.0-or-later
"""Flows and drops against exact solutions and published tables: profiles and errors."""

import argparse

import matplotlib.pyplot as plt
import style
import verification

KINDS = ("channel", "hydrostatic", "taylor_green", "cavity", "laplace", "drop", "oscillat", "marangoni", "thermocapillary",
         "return_flow", "recoil", "migration")


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("verification", help="verification.json of meltproof-verify")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    cases = verification.load_cases(given.verification, KINDS, key="kind")
    shown = [case for case in cases if verification.has_profile(case, given.verification)]
    rows = (len(shown) + 1 + 2) // 3
    figure, panels = plt.subplots(rows, 3, figsize=(style.PAGE_WIDTH, 2.3 * rows), squeeze=False)
    panels = list(panels.flat)
    for axes, case in zip(panels, shown):
        verification.plot_profile(axes, case, given.verification)
    converging = [case for case in cases if len(case["spacings_um"]) > 1]
    verification.plot_convergence(panels[len(shown)], converging[:len(style.SERIES)])
    for unused in panels[len(shown) + 1:]:
        unused.remove()
    style.save(figure, given.output, "Flows and drops against exact solutions",
               "Exact solution or published table as a line, SPH as markers. Right below: error against spacing, of the first "
               f"{len(style.SERIES)} cases. " + verification.caption_sentences(cases))


style.run(main)
