"""Directives of the site: a built-in mechanism as a live page, and a gallery of all of them."""

from __future__ import annotations

import html
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective

import centrode as ct
from centrode.errors import NotComputedYet
from centrode.locale import LANGUAGES, _, speaking
from centrode.report.mechanism_page import mechanism_page

FOLDER = "pages"
"""Of the built site, where the pages of mechanisms lie."""
TALL = 1040
"""Height of a page within another one [pixels]."""


class LivePages(SphinxDirective):
    """What shows pages of mechanisms."""

    option_spec: ClassVar[dict[str, Any]] = {"language": lambda text: directives.choice(text, LANGUAGES)}

    @property
    def language(self) -> str:
        """Of the pages."""
        return str(self.options.get("language", "en"))

    def address(self, name: str) -> str:
        """Write the page of a mechanism, and return its address from the document that shows it.

        Raises NotComputedYet for a mechanism that no page computes.
        """
        folder = Path(self.env.app.outdir) / FOLDER
        folder.mkdir(parents=True, exist_ok=True)
        text = mechanism_page(name, language=self.language)
        (folder / f"{name}.{self.language}.html").write_text(text, encoding="utf-8")
        return f"{'../' * self.env.docname.count('/')}{FOLDER}/{name}.{self.language}.html"

    def title(self, name: str) -> str:
        """Of a mechanism, in the language of the page."""
        with speaking(self.language):
            return html.escape(_(ct.example(name).title))


class LivePage(LivePages):
    """A mechanism that a reader of the site can touch."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """The page within the page, and a link to it alone."""
        name = self.arguments[0]
        address, title = self.address(name), self.title(name)
        frame = (
            f'<iframe src="{address}" title="{title}" loading="lazy" '
            f'style="width: 100%; height: {TALL}px; border: 1px solid #8884; border-radius: 6px"></iframe>'
            f'<p><a href="{address}">{title}</a></p>'
        )
        return [nodes.raw("", frame, format="html")]


class PageGallery(LivePages):
    """All built-in linkages: a picture and a link to the page of each."""

    def run(self) -> list[nodes.Node]:
        """Cards, then the mechanisms that have no page."""
        cards, without = "", []
        above = "../" * self.env.docname.count("/")
        for name in ct.example_names("linkage"):
            try:
                address = self.address(name)
            except NotComputedYet:
                without.append(name)
                continue
            picture = _picture(Path(self.env.srcdir) / "images", name)
            target = Path(self.env.app.outdir) / FOLDER / picture.name
            target.write_bytes(picture.read_bytes())
            cards += (
                f'<a href="{address}" style="width: 11.5rem; text-align: center; text-decoration: none">'
                f'<img src="{above}{FOLDER}/{picture.name}" alt="" loading="lazy" '
                f'style="width: 100%; background: #fff; border-radius: 6px"><br>{self.title(name)}</a>'
            )
        grid = (
            f'<div style="display: flex; flex-wrap: wrap; gap: 1.2rem 1rem; margin: 1.5rem 0">{cards}</div>'
        )
        listed = ", ".join(f"<code>{name}</code>" for name in without)
        return [nodes.raw("", f"{grid}<p>{listed}</p>", format="html")]


def _picture(images: Path, name: str) -> Path:
    """The picture of a mechanism in the gallery: a still one, one that moves, or that of its first mode."""
    places = (f"gallery/{name}.png", f"gallery/{name}.gif", f"{name}-mode.gif")
    return next(images / place for place in places if (images / place).exists())


def setup(app: Any) -> dict[str, bool]:
    """Tell Sphinx the directives."""
    app.add_directive("mechanism-page", LivePage)
    app.add_directive("mechanism-gallery", PageGallery)
    return {"parallel_read_safe": True}
