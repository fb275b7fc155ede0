"""Random mechanisms for tests with groups of higher class."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st
from tools.campaigns.grown.higher import HIGHER, GrowingHigher, grown_higher
from tools.campaigns.grown.plane import KINDS

__all__ = ["HIGHER", "GrowingHigher", "grown_higher", "higher_descriptions"]


def higher_descriptions() -> st.SearchStrategy[dict[str, Any]]:
    """Descriptions of a crank with a random group of higher class, and up to two groups of any kind around it."""
    some = st.lists(st.sampled_from(KINDS + HIGHER), max_size=1)
    kinds = st.builds(lambda a, b, c: [*a, b, *c], some, st.sampled_from(HIGHER), some)
    return st.builds(grown_higher, kinds, st.integers(0, 2**32 - 1))
