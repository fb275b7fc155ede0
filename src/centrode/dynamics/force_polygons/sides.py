"""A dyad as two bodies, each with its outer joint, and the joint between them."""

from __future__ import annotations

from dataclasses import dataclass

from centrode.dynamics.force_polygons.actions import total
from centrode.dynamics.force_polygons.joints import Joint
from centrode.dynamics.force_polygons.ledger import Ledger


@dataclass(frozen=True)
class Side:
    """A body of a dyad with its outer joint."""

    body: str
    joint: Joint

    def known(self, ledger: Ledger) -> complex:
        """Sum of the known forces on the body."""
        return total(ledger.actions[self.body])


@dataclass(frozen=True)
class Dyad:
    """Both sides and the inner joint; of RRP, RPP the side with the outer hinge stands first."""

    first: Side
    second: Side
    inner: Joint

    @property
    def kind(self) -> str:
        """Outer, inner, outer."""
        return self.first.joint.letter + self.inner.letter + self.second.joint.letter
