"""Renderers: sheets as text of a terminal, as files, as figures, as blocks of a document; they know no mechanics."""
