"""The groups a plan is made of: what is known before each, what it gives.

Assur groups of class II (dyads) are named by their joints, R a hinge and P a guide, in the order outer,
inner, outer: RRR, RRP, RPR, PRP, RPP (Artobolevsky, Theory of Mechanisms and Machines, kinds 1 to 5). Rigid
points, links by two points, cranks and parallel links are solved on the way.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from centrode.structure.constraints import Constraint, Contact, GearRatio, NoSlip

# What gears and rolling wheels add to the groups of a plan: angles that follow, loci, trains.


@dataclass(frozen=True)
class Meshed:
    """How the angle of a link follows from those of the other two links of a gear."""

    gear: GearRatio


@dataclass(frozen=True)
class Rolled:
    """How the angle of a wheel follows from where its centre is on its track."""

    rolling: NoSlip


Following: TypeAlias = Meshed | Rolled


@dataclass(frozen=True)
class Touch:
    """Locus: where a wheel's centre is at its track; `carried` if the unknown carries the track past a known wheel."""

    point: str
    contact: Contact
    carried: bool
    letter: str


@dataclass(frozen=True)
class Rolloff:
    """Locus: the line square to a track where the wheel's own turn puts its centre; `carried` as in `Touch`."""

    point: str
    rolling: NoSlip
    carried: bool
    letter = "P"


@dataclass(frozen=True)
class Arm:
    """A link that holds a wheel's centre and turns about the centre of its track, a point of the link by name."""

    rolling: NoSlip
    link: str
    pivot: str


@dataclass(frozen=True)
class AngleGiven:
    """A drive or a guide gives the angle between two links."""

    link: str
    relative_to: str
    drive: str | None = None
    guide: str | None = None


AngleEquation: TypeAlias = GearRatio | NoSlip | Arm | AngleGiven
"""A linear equation between the angles of links."""


@dataclass(frozen=True)
class Train:
    """Links whose angles follow together from linear equations, and then their places, one after the other.

    `places` has each link with its known point, in the order of placing; `brought` each point with the link
    that brings it; `pivots` the order of elimination as (equation, link).
    """

    equations: tuple[AngleEquation, ...]
    pivots: tuple[tuple[int, str], ...]
    places: tuple[tuple[str, str], ...]
    brought: tuple[tuple[str, str], ...]
    kind = "gear train"
    signed = False

    @property
    def links(self) -> tuple[str, ...]:
        """Links in the order of placing."""
        return tuple(link for link, _point in self.places)


def angles_in(equation: AngleEquation) -> tuple[str, ...]:
    """Links whose angles an equation ties together."""
    if isinstance(equation, GearRatio):
        return equation.links
    if isinstance(equation, NoSlip):
        return equation.link, equation.on
    if isinstance(equation, Arm):
        return equation.rolling.link, equation.rolling.on, equation.link
    return equation.link, equation.relative_to


@dataclass(frozen=True)
class RigidPoint:
    """A point of a link whose pose is known."""

    point: str
    link: str
    kind = "rigid point"
    signed = False


@dataclass(frozen=True)
class TwoPointLink:
    """A link two of whose points are known."""

    link: str
    first: str
    second: str
    kind = "link by two points"
    signed = False


@dataclass(frozen=True)
class Turning:
    """How the angle of a link follows: from a drive or from a guide against which it does not turn.

    `link` and `relative_to` are as the constraint names them; either may be the unknown one.
    """

    link: str
    relative_to: str
    drive: str | None = None
    guide: str | None = None


@dataclass(frozen=True)
class TurnedLink:
    """A link of known angle with a known point: a crank, a parallel link, or a wheel that meshes or rolls."""

    link: str
    pivot: str
    turning: Turning | Following
    signed = False

    @property
    def kind(self) -> str:
        if isinstance(self.turning, Turning):
            return "crank" if self.turning.drive is not None else "parallel link"
        return "rolling wheel" if isinstance(self.turning, Rolled) else "gear"


@dataclass(frozen=True)
class Aim:
    """RPR: a link on a known pivot whose guide passes a known target, with the guided link if there is one.

    If `block` is set, the target is a known point of that link, which does not turn against the aimed link;
    `sliding` is its point on the guide. If not, the target itself is the guide's point. With a `contact` the
    link rests on a wheel instead: a parallel of the wheel's track passes the target, the wheel's centre.
    """

    link: str
    pivot: str
    guide: str
    target: str
    block: str | None = None
    sliding: str | None = None
    contact: Contact | None = None
    kind = "RPR"
    signed = True


@dataclass(frozen=True)
class Rod:
    """Locus: a circle about a known centre, drawn by a link with the end of one hinge known."""

    point: str
    centre: str
    link: str
    letter = "R"


@dataclass(frozen=True)
class Rail:
    """Locus: a known line on which a point of the unknown moves; `on` is the body that carries it."""

    point: str
    guide: str
    on: str
    letter = "P"


@dataclass(frozen=True)
class Slot:
    """Locus: a line of the unknown (of known angle) through a known point."""

    point: str
    guide: str
    letter = "P"


@dataclass(frozen=True)
class Stop:
    """Locus: the line square to a guide at the displacement its drive gives."""

    point: str
    guide: str
    on: str
    drive: str
    letter = "P"


@dataclass(frozen=True)
class CylinderCircle:
    """Locus: a circle about a known centre whose radius a cylinder's drive gives."""

    point: str
    centre: str
    drive: str
    letter = "R"


Locus: TypeAlias = Rod | CylinderCircle | Rail | Slot | Stop | Touch | Rolloff


@dataclass(frozen=True)
class Meet:
    """RRR, RRP, PRP or RPP: one unknown vector where two loci meet.

    The vector is the place of `points[0]`, or, if there is a carriage (a link whose angle is known
    beforehand), the origin of the carriage's axes; its points then follow. `loci` stand with circles first,
    otherwise in description order, so the sign is reproducible.
    """

    points: tuple[str, ...]
    loci: tuple[Locus, Locus]
    carriage: str | None = None
    turning: Turning | Following | None = None
    crosses_once: bool = True
    """Whether the curves of two guides meet in one place."""

    @property
    def rods(self) -> tuple[Rod, ...]:
        """The loci that are links."""
        return tuple(locus for locus in self.loci if isinstance(locus, Rod))

    @property
    def circles(self) -> int:
        """Number of loci that are circles in the plane."""
        return sum(locus.letter == "R" for locus in self.loci)

    @property
    def kind(self) -> str:
        if self.circles:
            return "RRR" if self.circles == 2 else "RRP"
        return "RPP" if any(isinstance(locus, Slot) for locus in self.loci) else "PRP"

    # in the plane a circle meets anything in two places, two lines in one; on the sphere curves of guides are
    # circles too
    @property
    def signed(self) -> bool:
        if self.circles or self.crosses_once:
            return bool(self.circles)
        # a stop is a single place already: nothing has to be chosen
        return not any(isinstance(locus, Stop) for locus in self.loci)


@dataclass(frozen=True)
class Newton:
    """A group of higher class: points and links solved together by as many equations as they have coordinates.

    An equation is a constraint and the number of its row.
    """

    points: tuple[str, ...]
    links: tuple[str, ...]
    equations: tuple[tuple[Constraint, int], ...]
    kind = "higher class"
    signed = False


Group: TypeAlias = RigidPoint | TwoPointLink | TurnedLink | Train | Aim | Meet | Newton


def links_of(group: Group) -> tuple[str, ...]:
    """Links whose pose the group gives."""
    if isinstance(group, RigidPoint):
        return ()
    if isinstance(group, (Newton, Train)):
        return group.links
    if isinstance(group, Aim):
        return (group.link,) if group.block is None else (group.link, group.block)
    if isinstance(group, Meet):
        carriage = () if group.carriage is None else (group.carriage,)
        return carriage + tuple(rod.link for rod in group.rods)
    return (group.link,)


def points_of(group: Group) -> tuple[str, ...]:
    """Points whose place the group gives."""
    if isinstance(group, RigidPoint):
        return (group.point,)
    if isinstance(group, (Newton, Meet)):
        return group.points
    if isinstance(group, Train):
        return tuple(point for point, _link in group.brought)
    if isinstance(group, Aim) and group.sliding is not None:
        return (group.sliding,)
    return ()
