"""What gears and rolling wheels add to the groups of a plan: angles that follow, loci, trains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from centrode.structure.gear_ratios import GearRatio
from centrode.structure.wheels import Contact, NoSlip


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
