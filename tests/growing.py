"""Random mechanisms for tests, built as Assur taught: a crank, then one group after the other on what is there."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st
from tools.campaigns.grown.plane import DYADS, KINDS, WHEELS, Growing, grown

from centrode import Mechanism

__all__ = ["DYADS", "KINDS", "WHEELS", "Growing", "descriptions", "grown", "mechanism_of"]


def descriptions() -> st.SearchStrategy[dict[str, Any]]:
    """Descriptions of a crank with one to four random groups."""
    kinds = st.lists(st.sampled_from(KINDS), min_size=1, max_size=4)
    return st.builds(grown, kinds, st.integers(0, 2**32 - 1))


def mechanism_of(parts: dict[str, Any]) -> Mechanism:
    return Mechanism(**parts)
