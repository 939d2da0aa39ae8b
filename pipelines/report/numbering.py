# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of sections, tables and figures, the links to them, and the table of contents of the rendered page.

The template marks: `<section id="x">` with an `<h2>`, `<caption id="x">`, `<figure id="x">`, the place of the contents
`<nav id="contents"></nav>`, and links `[[x]]` to any of these.
"""

import re

from artifact import MissingArtifact


def numbered(page, pattern, opening):
    """Every element that the pattern finds (its id in group 1) with `opening(number)` after its start tag."""
    names = []

    def add(match):
        names.append(match.group(1))
        return match.group(0) + opening(len(names))

    return re.sub(pattern, add, page, flags=re.S), names


def contents(page):
    """The table of contents: one entry a section; on paper the style sheet adds dots and page."""
    found = re.findall(r'<section id="([^"]+)"[^>]*>\s*<h2>(.*?)</h2>', page, re.S)
    entries = "\n".join(f'<li><a href="#{name}">{title}</a></li>' for name, title in found)
    return f'<nav id="contents" aria-label="Contents"><h2>Contents</h2>\n<ol>\n{entries}\n</ol></nav>'


def number(page):
    """The page with numbers, links and contents. @raises MissingArtifact for a link to what the page does not have."""
    page, sections = numbered(page, r'<section id="([^"]+)"[^>]*>\s*<h2>', lambda count: f"{count}&ensp;")
    page, tables = numbered(page, r'<caption id="([^"]+)">', lambda count: f"<strong>Table {count}.</strong> ")
    page, figures = numbered(page, r'<figure id="([^"]+)"[^>]*>.*?<figcaption>', lambda count: f"<strong>Figure {count}.</strong> ")
    words = {name: f"Section {count}" for count, name in enumerate(sections, 1)}
    words.update({name: f"Table {count}" for count, name in enumerate(tables, 1)})
    words.update({name: f"Fig. {count}" for count, name in enumerate(figures, 1)})

    def link(match):
        name = match.group(1)
        if name not in words:
            raise MissingArtifact(f"the report's template links to `{name}`, which the page does not have.")
        return f'<a href="#{name}">{words[name]}</a>'

    page = re.sub(r"\[\[([\w.-]+)\]\]", link, page)
    return page.replace('<nav id="contents"></nav>', contents(page))
