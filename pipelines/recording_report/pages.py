# SPDX-License-Identifier: GPL-3.0-or-later
"""From facts and pictures to one self-contained HTML page and the same page as PDF, by one template."""

import base64
import io
import os
import re
import sys
from pathlib import Path

import jinja2
from markupsafe import Markup

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "figures"))
import style  # noqa: E402  (sets matplotlib up for equal bytes)


def svg_of(figure):
    """A matplotlib figure as the text of an SVG graphic without date."""
    file = io.StringIO()
    figure.savefig(file, format="svg", metadata={"Date": None, "Creator": "Meltproof"})
    style.plt.close(figure)
    return definitions_first(file.getvalue())


def definitions_first(svg):
    """The same graphic with all its <defs> in front. WeasyPrint looks for every glyph and marker from the beginning on,
    and with matplotlib's order it walks through the whole drawing each time."""
    definitions = re.findall(r"<defs>.*?</defs>", svg, flags=re.DOTALL)
    bare = re.sub(r"\s*<defs>.*?</defs>", "", svg, flags=re.DOTALL)
    begin = bare.index(">", bare.index("<svg")) + 1
    return bare[:begin] + "\n" + "\n".join(definitions) + bare[begin:]


def data_uri(content, kind):
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def picture(source, words):
    """An <img> with the picture inside the page; `words` are its alternative text."""
    return Markup(f'<img alt="{Markup.escape(words)}" src="{source}">')


def drawing(svg, words):
    return picture(data_uri(svg.encode(), "image/svg+xml"), words)


def number(value, digits=4):
    """Four significant digits, without an exponent where a reader would write none."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    text = f"{value:.{digits}g}"
    if "e" in text and 1e-3 <= abs(value) < 1e7:
        text = f"{value:.0f}"
    return text


def uncertain(value, u):
    """A value and its standard uncertainty, both to the uncertainty's second digit: 269.4 ± 1.5."""
    if not u or u != u:
        return number(value)
    import math

    places = max(0, 1 - math.floor(math.log10(abs(u))))
    return f"{value:.{min(places, 6)}f} ± {u:.{min(places, 6)}f}"


def render(template, facts):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE / "template"), autoescape=True,
                                     trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters.update(number=number)
    environment.globals.update(uncertain=uncertain)
    page_style = Markup((HERE / "template" / "page.css").read_text(encoding="utf-8"))
    return environment.get_template(template).render(**facts, style=page_style)


def write(path, content):
    """Under another name first: a file is there whole, or not at all."""
    partial = path.with_name(path.name + ".tmp")
    partial.write_bytes(content)
    os.replace(partial, path)


def write_pages(template, facts, output):
    """output.html, where pictures may move, and output.pdf, where they may not (`printed`)."""
    page = render(template, {**facts, "printed": False})
    printed = render(template, {**facts, "printed": True})

    import weasyprint  # slow to load: only once the page stands

    pdf = weasyprint.HTML(string=printed).write_pdf()
    write(output.with_suffix(".html"), page.encode())
    write(output.with_suffix(".pdf"), pdf)


def plain(text):
    """A file name of letters, digits, dots, dashes and underscores."""
    return re.sub(r"[^\w.-]+", "_", text)
