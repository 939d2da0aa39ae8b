# SPDX-License-Identifier: GPL-3.0-or-later
"""An animated PNG of the frames that meltproof-thermography wrote one below the other (film.png)."""

import io

from PIL import Image


def animated(film, frames):
    """The bytes of an animated PNG, an eighth of a second a frame. `frames`: how many the film holds."""
    strip = Image.open(film)
    strip = strip.convert("RGB").quantize(64, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    height = strip.height // frames
    pictures = [strip.crop((0, i * height, strip.width, (i + 1) * height)) for i in range(frames)]
    content = io.BytesIO()
    pictures[0].save(content, format="PNG", save_all=True, append_images=pictures[1:], duration=125, loop=0)
    return content.getvalue()
