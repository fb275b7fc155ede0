"""How the documentation is built: `make docs`, with warnings as errors."""

from __future__ import annotations

import centrode

project = "centrode"
author = "centrode contributors"
copyright = "centrode contributors"
version = release = centrode.__version__

extensions = ["myst_parser", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4  # links to headings work as on code hosts
exclude_patterns = ["_build"]

# TOML comments before the first table, console transcripts with `...`: shown, not parsed to the last sign
suppress_warnings = ["misc.highlighting_failure"]

html_theme = "furo"
html_title = f"centrode {version}"
html_static_path: list[str] = []
html_copy_source = html_show_sourcelink = False
