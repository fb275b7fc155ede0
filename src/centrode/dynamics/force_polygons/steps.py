"""Steps of a solution by force polygons as data: equations of moments and of forces, and what follows from them.

Forces are named as their symbols have it (R12ᵗ, G2, MΦ2), bodies by their numbers. All numbers are in SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Literal, TypeAlias

from centrode.dynamics.force_polygons.statics import MomentTerm, StaticJoint


@dataclass(frozen=True)
class MomentUnknown:
    """An unknown of an equation of moments with its arm [m]; None where it is a moment itself."""

    symbol: str
    arm: float | None = None


@dataclass(frozen=True)
class EquationOutcome:
    """Outcome of an equation.

    Attributes
    ----------
    symbol, value, unit : of the force or moment
    magnitude : the value is the magnitude of a vector
    """

    symbol: str
    value: float
    unit: Literal["N", "N m"] = "N"
    magnitude: bool = False


@dataclass(frozen=True)
class ForceLine:
    """A force of known direction: square to a guide, or along the line through two joints."""

    symbol: str
    guide: str = ""
    through: tuple[StaticJoint, ...] = ()


@dataclass(frozen=True)
class MomentsOfLink:
    """Equilibrium of moments of one link about a joint.

    Attributes
    ----------
    unknown : None where the equation gives the moment of a guide
    beside : the force of that guide, and by how much it passes beside the guide's point [m]
    """

    link: int
    about: StaticJoint
    unknown: MomentUnknown | None
    terms: tuple[MomentTerm, ...]
    outcome: EquationOutcome
    beside: tuple[str, float] | None = None


@dataclass(frozen=True)
class MomentsOfGroup:
    """Equilibrium of moments of a whole group about an outer hinge."""

    links: tuple[int, ...]
    about: StaticJoint
    unknown: MomentUnknown
    terms: tuple[MomentTerm, ...]
    outcome: EquationOutcome


@dataclass(frozen=True)
class MomentsOfBase:
    """Equilibrium of moments of the base of a triad about its Assur point; `moment` is that of all known forces."""

    link: int
    unknown: MomentUnknown
    moment: float
    outcome: EquationOutcome


@dataclass(frozen=True)
class ClosedPolygon:
    """The forces whose polygon closes, and the lines of the unknown ones, or what the polygon gives."""

    links: tuple[int, ...]
    forces: tuple[str, ...]
    lines: tuple[ForceLine, ...] = ()
    outcome: EquationOutcome | None = None


@dataclass(frozen=True)
class ForcesAlongGuide:
    """Equilibrium of a link along a guide; without the forces only what it gives."""

    link: int
    guide: str
    forces: tuple[str, ...]
    outcome: EquationOutcome


@dataclass(frozen=True)
class AssurPoint:
    """Where the lines of two forces on the base of a triad meet, each through a hinge of the base."""

    lines: tuple[tuple[str, StaticJoint], tuple[str, StaticJoint]]


@dataclass(frozen=True)
class ClosedAlong:
    """The polygon of a triad closes along the lines of two forces."""

    forces: tuple[str, str]


@dataclass(frozen=True)
class SolvedTogether:
    """All equations of equilibrium of a group at once."""

    equations: int
    links: tuple[int, ...]


@dataclass(frozen=True)
class JointReaction:
    """What a joint of a group that was solved together transfers."""

    joint: StaticJoint
    outcomes: tuple[EquationOutcome, ...]


class Neglect(Enum):
    """What equilibrium or the description does not determine, and is left out."""

    TOOTH_PRESSURE = "the radial part of a tooth's force"
    PITCH_POINT = "the place of a tooth's force"
    NORMAL_FORCE = "the normal force of a wheel that other joints keep at its track"


@dataclass(frozen=True)
class Assumption:
    """What is left out of the reactions of a joint."""

    joint: StaticJoint
    neglected: Neglect


Step: TypeAlias = (
    MomentsOfLink
    | MomentsOfGroup
    | MomentsOfBase
    | ClosedPolygon
    | ForcesAlongGuide
    | AssurPoint
    | ClosedAlong
    | SolvedTogether
    | JointReaction
    | Assumption
)
