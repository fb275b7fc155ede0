"""Random spherical mechanisms for tests, grown group by group."""

from __future__ import annotations

from hypothesis import strategies as st
from tools.campaigns.grown.sphere import KINDS, Growing, Vector, angle_at, arc, coordinates, grown, unit

__all__ = ["KINDS", "Growing", "Vector", "angle_at", "arc", "coordinates", "grown", "mechanisms", "unit"]


def mechanisms(kinds: tuple[str, ...] = KINDS) -> st.SearchStrategy[Growing]:
    """A crank with one to four random groups."""
    lists = st.lists(st.sampled_from(kinds), min_size=1, max_size=4)
    return st.builds(grown, lists, st.integers(0, 2**32 - 1))
