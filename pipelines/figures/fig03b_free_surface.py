# SPDX-License-Identifier: GPL-3.0-or-later
"""Melt with a free surface, as tracks have it, against exact solutions."""

import style
import verification

style.run(lambda: verification.draw_cases(
    __doc__, ("hydrostatic_free", "laplace_free", "oscillating_drop", "recoil_flat", "thermocapillary_layer"),
    "Melt with a free surface against exact solutions"))
