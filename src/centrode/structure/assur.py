"""The plan as a structural formula: input links and Assur groups with class, order and kind.

Artobolevsky's classification: a dyad has class II and order 2; its five kinds are RRR, RRP, RPR, PRP and
RPP. A mechanism has the class of its highest group.
"""

from __future__ import annotations

from dataclasses import dataclass

from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.contours import contours_of
from centrode.structure.groups import (
    Aim,
    Group,
    Meet,
    Newton,
    Rail,
    RigidPoint,
    Slot,
    Stop,
    Stroke,
    TurnedLink,
    Turning,
    links_of,
)
from centrode.structure.mobility import is_bare, slider_of
from centrode.structure.plan import Structure
from centrode.structure.wheel_groups import AngleGiven, Meshed, Train


@dataclass(frozen=True)
class AssurGroup:
    """One term of the structural formula.

    Attributes
    ----------
    roman : "I" for an input, "II" for a dyad, "III" and on for higher groups, "0" for a link that only follows
    order : number of outer joints, 0 where that says nothing
    kind : "RRR", ..., or what else it is
    members : links, sliders that are understood included
    """

    roman: str
    order: int
    kind: str
    members: tuple[str, ...]

    @property
    def text(self) -> str:
        """The term as the formula shows it: II(2, 3)."""
        return f"{self.roman}({', '.join(self.members)})"


def assur_groups(structure: Structure) -> tuple[AssurGroup, ...]:
    """Inputs and groups in the order of the plan."""
    found: list[AssurGroup] = []
    taken: set[str] = set()
    for group in structure.groups:
        if isinstance(group, RigidPoint):
            continue
        own = _members(structure.mechanism, group)
        members = tuple(name for name in own if name not in taken)
        taken.update(members)
        if members:
            found.append(_term(structure.mechanism, group, members))
    return tuple(found)


def structural_formula(structure: Structure) -> str:
    """The order of formation: I(1) -> II(2, 3) -> II(4, 5)."""
    return " -> ".join(group.text for group in assur_groups(structure))


def _term(mechanism: Mechanism, group: Group, members: tuple[str, ...]) -> AssurGroup:
    if is_input(group):
        return AssurGroup("I", 1, group.kind, members)
    if isinstance(group, TurnedLink) and not isinstance(group.turning, Turning):
        return AssurGroup("II", 2, _("gear") if isinstance(group.turning, Meshed) else _("rolling"), members)
    if isinstance(group, Train):
        return AssurGroup("II", len(group.links), _("gear train"), members)
    if isinstance(group, (Meet, Aim)):
        return AssurGroup("II", 2, group.kind, members)
    if isinstance(group, Newton):
        contours = contours_of(mechanism, group)
        return AssurGroup(roman(contours.highest), contours.outer, _("higher class"), members)
    return AssurGroup("0", 0, group.kind, members)


def roman(number: int) -> str:
    """A small number in Roman figures."""
    figures = ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I"))
    found = ""
    for value, figure in figures:
        while number >= value:
            found += figure
            number -= value
    return found


def is_input(group: Group) -> bool:
    """Whether a drive acts inside the group."""
    if isinstance(group, TurnedLink):
        return isinstance(group.turning, Turning) and group.turning.drive is not None
    if isinstance(group, Train):
        return any(isinstance(e, AngleGiven) and e.drive is not None for e in group.equations)
    if isinstance(group, Meet):
        driven = isinstance(group.turning, Turning) and group.turning.drive is not None
        return driven or any(isinstance(locus, (Stop, Stroke)) for locus in group.loci)
    return False


def _members(mechanism: Mechanism, group: Group) -> tuple[str, ...]:
    """Links of a group, with the sliders of its guides: a slider's own link belongs to the dyad it slides in."""
    names = list(links_of(group))
    if isinstance(group, Aim) and group.contact is not None:
        names.append(group.contact.link)
    elif isinstance(group, Aim) and group.block is None:
        guide = mechanism.guide(group.guide)
        names.append(slider_of(guide))
    if isinstance(group, Meet):
        for locus in group.loci:
            if isinstance(locus, (Rail, Slot, Stop)):
                guide = mechanism.guide(locus.guide)
                if is_bare(guide) or guide.link not in names:
                    names.append(slider_of(guide))
            if isinstance(locus, Stroke):
                names.append(_("cylinder {drive}").format(drive=locus.drive))
    if isinstance(group, Newton):
        bare = [guide for guide in mechanism.guides if is_bare(guide)]
        names += [slider_of(g) for g in bare if g.point in group.points or g.on in group.links]
    return tuple(dict.fromkeys(names))
