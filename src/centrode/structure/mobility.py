"""Links, joints and loops counted, and Chebyshev's formula beside the rank."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from centrode.locale import _
from centrode.model.mechanism import Guide, Mechanism


@dataclass(frozen=True)
class Count:
    """Chebyshev's count of a planar mechanism (also Gruebler's): 3 n - 2 p5 - p4.

    A point on a guide without a link of its own counts as a slider: one more link, hinged to the point and
    sliding on the guide. A hinge of k links counts k - 1 times.
    """

    moving_links: int
    lower_pairs: int
    higher_pairs: int

    @property
    def mobility(self) -> int:
        """Mobility by the formula; the rank decides where they differ."""
        return 3 * self.moving_links - 2 * self.lower_pairs - self.higher_pairs

    @property
    def loops(self) -> int:
        """Independent closed loops: joints less moving links (Euler)."""
        return self.lower_pairs + self.higher_pairs - self.moving_links


def count(mechanism: Mechanism) -> Count:
    """Count links and pairs of a mechanism."""
    members: Counter[str] = Counter(list(mechanism.frame.points))
    for link in mechanism.links.values():
        members.update(list(link.coordinates))
    blocks = [guide for guide in mechanism.guides if is_bare(guide)]
    members.update(guide.point for guide in blocks)
    hinges = sum(number - 1 for number in members.values())
    return Count(len(mechanism.links) + len(blocks), hinges + len(mechanism.guides), 0)


def is_bare(guide: Guide) -> bool:
    """Whether a guide has no link of its own, so that a slider is understood."""
    return guide.link is None


def slider_of(guide: Guide) -> str:
    """The link that slides on a guide: its own, or the slider understood at its point."""
    return guide.link if guide.link is not None else _("slider {point}").format(point=guide.id)
