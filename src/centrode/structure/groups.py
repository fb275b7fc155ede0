"""The groups a plan is made of: what is known before each, what it gives.

Assur groups of class II (dyads) are named by their joints, R a hinge and P a guide, in the order outer,
inner, outer: RRR, RRP, RPR, PRP, RPP (Artobolevsky, Theory of Mechanisms and Machines, kinds 1 to 5). Rigid
points, links by two points, cranks and parallel links are solved on the way.

Kinds are words of English, marked for the catalogues: data hold them as they are, readers see them in their language
(Russian and Ukrainian books write ВВП for RRP).

Every group answers for itself: `kind` and whether its equation has two roots (`is_signed`), the `links` whose pose and
the `points` whose place it gives, whether a drive acts inside it (`is_input`), and a `sentence` that says in the
language of the reader what is found and from what. What tells groups or loci apart ends in `assert_never`, so the type
checker names every place that
a new one concerns.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias, assert_never

from centrode.locale import _, mark
from centrode.model.reading import body_word
from centrode.structure.constraints import Constraint, GearRatio, NoSlip, TrackContact

# What gears and rolling wheels add to the groups of a plan: angles that follow, loci, trains.
#
# A locus answers for itself too: `letter` says whether it is a circle (R) or a line (P) in the plane, `is_input`
# whether a drive sets it.


@dataclass(frozen=True)
class Meshed:
    """Angle of a link from those of the other two links of a gear."""

    gear: GearRatio


@dataclass(frozen=True)
class Rolled:
    """Angle of a wheel from the place of its centre on its track."""

    rolling: NoSlip


Following: TypeAlias = Meshed | Rolled


@dataclass(frozen=True)
class Touch:
    """Locus: where a wheel's centre is at its track; `carried` if the unknown carries the track past a known wheel."""

    point: str
    contact: TrackContact
    carried: bool
    letter: str
    is_input = False

    @property
    def sentence(self) -> str:
        """What it is, as a part of a sentence."""
        if self.letter == "P":
            return _("the line beside the track of wheel {wheel}").format(wheel=self.contact.rolling)
        return _("the circle about the track of wheel {wheel}").format(wheel=self.contact.rolling)


@dataclass(frozen=True)
class Rolloff:
    """Locus: the line square to a track where the wheel's own turn puts its centre; `carried` as in `Touch`."""

    point: str
    rolling: NoSlip
    carried: bool
    letter = "P"
    is_input = False

    @property
    def sentence(self) -> str:
        """What it is, as a part of a sentence."""
        return _("the position to which wheel {wheel} rolls").format(wheel=self.rolling.rolling)


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
    kind = mark("gear train")
    is_signed = False

    @property
    def links(self) -> tuple[str, ...]:
        """Links in the order of placing."""
        return tuple(link for link, _point in self.places)

    @property
    def points(self) -> tuple[str, ...]:
        """Points whose place the group gives."""
        return tuple(point for point, _link in self.brought)

    @property
    def is_input(self) -> bool:
        """Whether a drive acts inside the group."""
        return any(
            isinstance(equation, AngleGiven) and equation.drive is not None for equation in self.equations
        )

    @property
    def sentence(self) -> str:
        """What is found, and from what."""
        return _("gear train: links {links} turned together").format(links=", ".join(self.links))


def angles_in(equation: AngleEquation) -> tuple[str, ...]:
    """Links whose angles an equation ties together."""
    match equation:
        case GearRatio():
            return equation.links
        case NoSlip():
            return equation.link, equation.on
        case Arm():
            return equation.rolling.link, equation.rolling.on, equation.link
        case AngleGiven():
            return equation.link, equation.relative_to
        case _:
            assert_never(equation)


@dataclass(frozen=True)
class RigidPoint:
    """A point of a link whose pose is known."""

    point: str
    link: str
    kind = "rigid point"
    is_signed = False
    links = ()
    is_input = False

    @property
    def points(self) -> tuple[str, ...]:
        """Points whose place the group gives."""
        return (self.point,)

    @property
    def sentence(self) -> str:
        """What is found, and from what."""
        return _("point {point} of link {link}").format(point=self.point, link=self.link)


@dataclass(frozen=True)
class TwoPointLink:
    """A link two of whose points are known."""

    link: str
    first: str
    second: str
    kind = mark("link by two points")
    is_signed = False
    points = ()
    is_input = False

    @property
    def links(self) -> tuple[str, ...]:
        """Links whose pose the group gives."""
        return (self.link,)

    @property
    def sentence(self) -> str:
        """What is found, and from what."""
        return _("link {link} through {first} and {second}").format(
            link=self.link, first=self.first, second=self.second
        )


@dataclass(frozen=True)
class Turning:
    """Angle of a link from a drive, or from a guide against which it does not turn.

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
    points = ()
    is_signed = False

    @property
    def kind(self) -> str:
        if isinstance(self.turning, Turning):
            return "crank" if self.turning.drive is not None else mark("parallel link")
        return "rolling wheel" if isinstance(self.turning, Rolled) else "gear"

    @property
    def links(self) -> tuple[str, ...]:
        """Links whose pose the group gives."""
        return (self.link,)

    @property
    def is_input(self) -> bool:
        """Whether a drive acts inside the group."""
        return isinstance(self.turning, Turning) and self.turning.drive is not None

    @property
    def sentence(self) -> str:
        """What is found, and from what."""
        place = {"link": self.link, "point": self.pivot}
        match self.turning:
            case Meshed(gear):
                return _("link {link} about {point}, turned by gear {gear}").format(**place, gear=gear.gear)
            case Rolled(rolling):
                return _("wheel {link} about {point}, turned by rolling on {on}").format(
                    **place, on=body_word(rolling.on)
                )
            case Turning(drive=None, guide=guide):
                return _("link {link} at {point}, kept from turning by guide {guide}").format(
                    **place, guide=guide
                )
            case Turning():
                return _("link {link} about {point}, turned by its drive").format(**place)
            case _:
                assert_never(self.turning)


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
    contact: TrackContact | None = None
    kind = mark("RPR")
    is_signed = True
    is_input = False

    @property
    def links(self) -> tuple[str, ...]:
        """Links whose pose the group gives."""
        return (self.link,) if self.block is None else (self.link, self.block)

    @property
    def points(self) -> tuple[str, ...]:
        """Points whose place the group gives."""
        return () if self.sliding is None else (self.sliding,)

    @property
    def sentence(self) -> str:
        """What is found, and from what."""
        place = {"link": self.link, "point": self.pivot, "target": self.target}
        if self.contact is not None:
            return _("RPR: link {link} about {point}, resting on wheel {wheel} about {target}").format(
                **place, wheel=self.contact.rolling
            )
        return _("RPR: link {link} about {point}, its guide {guide} through {target}").format(
            **place, guide=self.guide
        )


@dataclass(frozen=True)
class Rod:
    """Locus: a circle about a known centre, drawn by a link with the end of one hinge known."""

    point: str
    centre: str
    link: str
    letter = "R"
    is_input = False

    @property
    def sentence(self) -> str:
        """What it is, as a part of a sentence."""
        return _("the circle of {link} about {point}").format(link=self.link, point=self.centre)


@dataclass(frozen=True)
class Rail:
    """Locus: a known line on which a point of the unknown moves; `on` is the body that carries it."""

    point: str
    guide: str
    on: str
    letter = "P"
    is_input = False

    @property
    def sentence(self) -> str:
        """What it is, as a part of a sentence."""
        return _("the line of guide {guide}").format(guide=self.guide)


@dataclass(frozen=True)
class Slot:
    """Locus: a line of the unknown (of known angle) through a known point."""

    point: str
    guide: str
    letter = "P"
    is_input = False

    @property
    def sentence(self) -> str:
        """What it is, as a part of a sentence."""
        return _("guide {guide} through {point}").format(guide=self.guide, point=self.point)


@dataclass(frozen=True)
class GuideStop:
    """Locus: the line square to a guide at the displacement its drive gives."""

    point: str
    guide: str
    on: str
    drive: str
    letter = "P"
    is_input = True

    @property
    def sentence(self) -> str:
        """What it is, as a part of a sentence."""
        return _("the stop set by the drive of guide {guide}").format(guide=self.guide)


@dataclass(frozen=True)
class CylinderCircle:
    """Locus: a circle about a known centre whose radius a cylinder's drive gives."""

    point: str
    centre: str
    drive: str
    letter = "R"
    is_input = True

    @property
    def sentence(self) -> str:
        """What it is, as a part of a sentence."""
        return _("the circle about {point} as large as the cylinder is long").format(point=self.centre)


Locus: TypeAlias = Rod | CylinderCircle | Rail | Slot | GuideStop | Touch | Rolloff


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
            return mark("RRR") if self.circles == 2 else mark("RRP")
        return mark("RPP") if any(isinstance(locus, Slot) for locus in self.loci) else mark("PRP")

    # in the plane a circle meets anything in two places, two lines in one; on the sphere curves of guides are
    # circles too
    @property
    def is_signed(self) -> bool:
        if self.circles or self.crosses_once:
            return bool(self.circles)
        # a stop is a single place already: nothing has to be chosen
        return not self.has_stop

    @property
    def links(self) -> tuple[str, ...]:
        """Links whose pose the group gives."""
        carriage = () if self.carriage is None else (self.carriage,)
        return carriage + tuple(rod.link for rod in self.rods)

    @property
    def is_input(self) -> bool:
        """Whether a drive acts inside the group."""
        driven = isinstance(self.turning, Turning) and self.turning.drive is not None
        return driven or any(locus.is_input for locus in self.loci)

    @property
    def has_stop(self) -> bool:
        """Whether a drive gives the place on a line, so that nothing is left to meet."""
        return any(locus.is_input and locus.letter == "P" for locus in self.loci)

    @property
    def sentence(self) -> str:
        """What is found, and from what."""
        one, other = (locus.sentence for locus in self.loci)
        if self.carriage is None:
            return _("{kind}: point {point}, where {one} meets {other}").format(
                kind=_(self.kind), point=self.points[0], one=one, other=other
            )
        return _("{kind}: link {link} of known angle, where {one} meets {other}").format(
            kind=_(self.kind), link=self.carriage, one=one, other=other
        )


@dataclass(frozen=True)
class Newton:
    """A group of higher class: points and links solved together by as many equations as they have coordinates.

    An equation is a constraint and the number of its row.
    """

    points: tuple[str, ...]
    links: tuple[str, ...]
    equations: tuple[tuple[Constraint, int], ...]
    kind = mark("higher class")
    is_signed = False
    is_input = False

    @property
    def sentence(self) -> str:
        """What is found, and from what."""
        return _("higher class: {names}").format(names=", ".join(self.points + self.links))


Group: TypeAlias = RigidPoint | TwoPointLink | TurnedLink | Train | Aim | Meet | Newton
