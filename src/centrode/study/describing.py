"""How a mechanism works, in words."""

from __future__ import annotations

from centrode.model.mechanism import Mechanism


def describe(mechanism: Mechanism) -> str:
    """Sentences on links, joints, drives and what follows what, in the chosen language."""
    return mechanism.title
