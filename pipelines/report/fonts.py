# SPDX-License-Identifier: GPL-3.0-or-later
"""The page's fonts, cut down to the characters that it uses, as rules of a style sheet: the HTML page looks the same
on a machine that has none of them. The PDF gets its fonts from WeasyPrint."""

import base64
import html
import io
import re
from pathlib import Path

from artifact import existing

FOLDER = Path("/usr/share/fonts/truetype/dejavu")  # Debian's fonts-dejavu-core
FACES = (("DejaVu Sans", "normal", "DejaVuSans.ttf"), ("DejaVu Sans", "bold", "DejaVuSans-Bold.ttf"),
         ("DejaVu Sans Mono", "normal", "DejaVuSansMono.ttf"))


def characters(page):
    """Every character that a page shows, with those that its style sheet may add."""
    text = re.sub(r"<svg.*?</svg>|<style.*?</style>|<[^>]*>", " ", page, flags=re.S)
    return "".join(sorted(set(html.unescape(text)) | set("0123456789./ ")))


def face(family, weight, file, shown):
    """One @font-face rule with the font's glyphs for `shown`."""
    from fontTools import subset, ttLib  # slow to load: only for the page itself

    font = ttLib.TTFont(existing(FOLDER / file), recalcTimestamp=False)
    options = subset.Options(recalc_timestamp=False, layout_features=["kern"], hinting=False, notdef_outline=True)
    options.drop_tables += ["FFTM"]  # the date of FontForge
    cutter = subset.Subsetter(options)
    cutter.populate(text=shown)
    cutter.subset(font)
    font.flavor = "woff"
    kept = io.BytesIO()
    font.save(kept)
    data = base64.b64encode(kept.getvalue()).decode()
    return (f'@font-face {{ font-family: "{family}"; font-weight: {weight}; '
            f'src: url(data:font/woff;base64,{data}) format("woff"); }}')


def rules(page):
    """The rules for all faces of the page."""
    shown = characters(page)
    return "\n".join(face(*known, shown) for known in FACES)
