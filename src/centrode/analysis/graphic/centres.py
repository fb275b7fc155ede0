"""Instant centres as they are drawn: where perpendiculars to the velocities of two points meet."""

from __future__ import annotations

from centrode.analysis.graphic.board import extent_of
from centrode.analysis.graphic.stage import Stage

AT_REST = 1e-9
"""Links that turn slower than this part of the fastest, or move so, count as translating or at rest."""


def instant_centres(velocity: Stage) -> dict[str, complex | None]:
    """Instant centres of velocity where perpendiculars to the velocities meet; None at infinity."""
    size = max((abs(rate) for rate in velocity.points.values()), default=0.0)
    reach = extent_of([velocity.drawing.point(name) for name in velocity.points])
    found: dict[str, complex | None] = {}
    for link, base in velocity.bases.items():
        rate, turn = velocity.rate(base), velocity.turns[link]
        if abs(turn) * reach > AT_REST * size:
            found[link] = velocity.drawing.point(base) + 1j * rate / turn
        elif abs(rate) > AT_REST * size:
            found[link] = None
    return found
