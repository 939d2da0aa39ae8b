# SPDX-License-Identifier: GPL-3.0-or-later
"""Heat conduction in slabs, melting and freezing fronts, exact and by SPH."""

import argparse

import matplotlib.pyplot as plt
import style
import verification


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("verification", help="verification.json of meltproof-verify")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    cases = verification.load_cases(given.verification, ["conduction", "stefan"])
    rows = (len(cases) + 3) // 3
    figure, panels = plt.subplots(rows, 3, figsize=(style.PAGE_WIDTH, 2.3 * rows), squeeze=False)
    panels = list(panels.flat)
    for axes, case in zip(panels, cases):
        verification.plot_profile(axes, case, given.verification)
    verification.plot_convergence(panels[len(cases)], [case for case in cases if len(case["spacings_um"]) > 1])
    for unused in panels[len(cases) + 1:]:
        unused.remove()

    style.save(figure, given.output, "Heat conduction and melting against exact solutions",
               "Temperature in slabs and around melting and freezing fronts: exact solution as a line, "
               "SPH particles as markers, and the errors against the particle spacing. "
               + verification.caption_sentences(cases))


style.run(main)
