"""Colours of figures and pages that all can tell apart, and markers of what shares one."""

from __future__ import annotations

# Okabe and Ito, Color Universal Design (2008), without its yellow, which is lost on white paper.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKERS = ("", "o", "s", "^", "D", "v")
"""Markers of the things that share a colour, the first seven, the next seven and so on."""
MUTED = "#8A8A8A"
GROUND = "#404040"
INK = "#202020"
CARRIER = "#606060"
"""What carries the legs of a walking wheel."""
