"""Assur groups: what is left of a Baranov truss without one of its links.

A Baranov truss is a chain without freedom that has no part of this kind. To remove a link frees as many joints as it
had; joined to links whose motion is known, they leave the group no freedom, and this holds for no smaller part of it
(L. V. Assur, 1914; G. G. Baranov, Classification, formation, kinematics and kinetostatics of plane mechanisms with
pairs of the first kind, 1952). Links that symmetry exchanges give one group.
"""

from __future__ import annotations

from dataclasses import dataclass

from centrode.chains.kinematic_chains import GREATEST, Joint, KinematicChain, chains
from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.structure.assur import Contours, roman


@dataclass(frozen=True)
class AssurScheme:
    """The structural scheme of an Assur group with turning joints.

    Attributes
    ----------
    truss : the Baranov truss that it comes from
    removed : number of the link that it lacks
    """

    truss: KinematicChain
    removed: int

    @property
    def links(self) -> tuple[int, ...]:
        """Its links, by their numbers in the truss."""
        return tuple(link for link in range(self.truss.links) if link != self.removed)

    @property
    def inner_joints(self) -> tuple[Joint, ...]:
        """Joints between its own links."""
        return tuple(joint for joint in self.truss.joints if self.removed not in joint)

    @property
    def outer_links(self) -> tuple[int, ...]:
        """Its links that have a joint outside."""
        return tuple(u if v == self.removed else v for u, v in self.truss.joints if self.removed in (u, v))

    @property
    def order(self) -> int:
        """Number of its outer joints."""
        return len(self.outer_links)

    @property
    def roman(self) -> str:
        """Its class by Artobolevsky, that of its highest contour."""
        names = {joint: ("hinge", str(k)) for k, joint in enumerate(self.inner_joints)}
        joints = {names[joint]: [str(link) for link in joint] for joint in self.inner_joints}
        return roman(Contours(joints, self.order).highest)


def assur_groups(links: int) -> tuple[AssurScheme, ...]:
    """All Assur groups of so many links with turning joints, each once.

    Parameters
    ----------
    links : 2, 4, 6, 8 or 10

    Returns
    -------
    tuple of AssurScheme
        In the order of their trusses; there are 1, 2, 10 and 173 of 2, 4, 6 and 8 links.

    Raises
    ------
    InputError
        There is no group of so many links, or it is larger than those found here.

    Examples
    --------
    >>> import centrode as ct
    >>> [(group.roman, group.order) for group in ct.assur_groups(4)]
    [('IV', 2), ('III', 3)]
    """
    if links < 2 or links % 2:
        what = ngettext(
            "there is no Assur group of {n} link", "there is no Assur group of {n} links", links
        ).format(n=links)
        raise InputError("links", what, _("a group has an even number of links"))
    if links + 1 > GREATEST:
        what = _("groups of 2 to {most} links are found, {links} are wished").format(
            most=GREATEST - 2, links=links
        )
        raise InputError("links", what)
    return tuple(
        AssurScheme(truss, inversion.frame)
        for truss in chains(links + 1, 0)
        for inversion in truss.inversions
    )


@dataclass(frozen=True)
class AssurList:
    """All Assur groups of so many links."""

    links: int
    groups: tuple[AssurScheme, ...]


def assur_list(links: int) -> AssurList:
    """All Assur groups of so many links as a result; raises as `assur_groups` does."""
    return AssurList(links, assur_groups(links))
