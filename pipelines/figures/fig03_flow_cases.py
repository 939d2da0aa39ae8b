# SPDX-License-Identifier: GPL-3.0-or-later
"""Flows that fill their space, and drops in a second fluid, against exact solutions and published tables."""

import style
import verification

style.run(lambda: verification.draw_cases(
    __doc__, ("channel", "hydrostatic", "taylor_green", "cavity", "laplace_drop", "drop_migration"),
    "Closed flows and drops against exact solutions"))
