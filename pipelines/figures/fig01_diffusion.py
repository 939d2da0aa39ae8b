# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 1 of the paper: diffusion of a stripe of solute, exact and by SPH, with errors and orders."""

import argparse

import matplotlib.pyplot as plt
import style
import verification


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("verification", help="verification.json of meltproof-verify")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    cases = verification.load_cases(given.verification, ["species_stripe", "species_moving"])
    # Narrow to wide, against the order of the names; the others have nothing to show but their errors in the table.
    shown = [case for case in cases if case["name"].endswith("um")][::-1][:2]
    figure, panels = plt.subplots(1, len(shown) + 1, figsize=(style.PAGE_WIDTH, 2.5))
    for axes, case in zip(panels, shown):
        verification.plot_profile(axes, case, given.verification)
    verification.plot_convergence(panels[-1], shown)

    style.save(figure, given.output, "Diffusion of a stripe of solute (the paper's Fig. 1)",
               "Concentration across the stripe: the exact solution as a line, SPH particles as markers. Right: "
               "relative L2 error against the particle spacing; the thick bar is the error asked at the finest "
               "spacing. " + verification.caption_sentences(cases))


style.run(main)
