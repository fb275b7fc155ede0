"""Links, joints and loops counted, and Chebyshev's formula beside the rank."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass

from centrode.locale import _
from centrode.model.mechanism import Guide, Mechanism
from centrode.structure.constraints import Constraint
from centrode.structure.wheels import Contact


@dataclass(frozen=True)
class Count:
    """Chebyshev's count of a planar mechanism (also Gruebler's): 3 n - 2 p5 - p4.

    A point on a guide without a link of its own counts as a slider: one more link, hinged to the point and
    sliding on the guide; a cylinder as barrel and rod, hinged to its points and sliding on each other. A hinge
    of k links counts k - 1 times. Meshing wheels are a higher pair; so is a rolling wheel whose distance from its
    track an arm or a guide keeps. Another rolling wheel leaves one freedom, as a lower pair does, and counts as one.
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


def count(mechanism: Mechanism, redundant: Collection[Constraint] = ()) -> Count:
    """Count links and pairs of a mechanism; `redundant` are the constraints that repeat others."""
    members: Counter[str] = Counter(list(mechanism.frame.points))
    for link in mechanism.links.values():
        members.update(list(link.coordinates))
    blocks = [guide for guide in mechanism.guides if is_bare(guide)]
    members.update(guide.point for guide in blocks)
    cylinders = [drive.distance for drive in mechanism.drives if drive.distance]
    for ends in cylinders:
        members.update(ends)
    hinges = sum(number - 1 for number in members.values())
    kept_at_track = {c.rolling for c in redundant if isinstance(c, Contact)}
    rolling = sum(wheel.id not in kept_at_track for wheel in mechanism.rolling)
    links = len(mechanism.links) + len(blocks) + 2 * len(cylinders)
    lower = hinges + len(mechanism.guides) + len(cylinders) + rolling
    return Count(links, lower, len(mechanism.gears) + len(mechanism.rolling) - rolling)


def is_bare(guide: Guide) -> bool:
    """Whether a guide has no link of its own, so that a slider is understood."""
    return guide.link is None


def slider_of(guide: Guide) -> str:
    """The link that slides on a guide: its own, or the slider understood at its point."""
    return guide.link if guide.link is not None else _("slider {point}").format(point=guide.id)
