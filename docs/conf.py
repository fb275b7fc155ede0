"""How the documentation is built: `make docs`, with warnings as errors."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from docutils.nodes import SkipNode
from latex2mathml.converter import convert

import centrode

project = "centrode"
author = "centrode contributors"
copyright = "centrode contributors"
version = release = centrode.__version__

sys.path.insert(0, str(Path(__file__).parent))  # the directives beside this file

extensions = ["myst_nb", "live_pages"]
nb_execution_mode = "off"  # tools/notebook.py runs it
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4  # links to headings work as on code hosts
exclude_patterns = ["_build"]

# TOML comments before the first table, console transcripts with `...`: shown, not parsed to the last sign
suppress_warnings = ["misc.highlighting_failure"]

html_theme = "furo"
html_title = f"centrode {version}"
html_static_path: list[str] = []
html_copy_source = html_show_sourcelink = False
html_math_renderer = "mathml"


def inline(writer: Any, node: Any) -> None:
    """A formula within a line, as MathML: shown by the browser itself, without a network."""
    writer.body.append(convert(node.astext()))
    raise SkipNode


def block(writer: Any, node: Any) -> None:
    """A formula on lines of its own."""
    writer.body.append(f'<div class="formula">{convert(node.astext(), display="block")}</div>')
    raise SkipNode


def setup(app: Any) -> None:
    """Tell Sphinx how formulas are shown."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
