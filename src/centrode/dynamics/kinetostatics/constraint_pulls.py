"""What each constraint does to points and links: its row of the Jacobian as forces and moments of one unit."""

from __future__ import annotations

from centrode.dynamics.kinetostatics.equilibrium import Equilibrium
from centrode.dynamics.kinetostatics.teeth import Teeth
from centrode.dynamics.pulls import Pull
from centrode.model.mechanism import Mechanism
from centrode.structure.constraints import (
    Constraint,
    Contact,
    DisplacementDrive,
    GearRatio,
    NoSlip,
    PointOnGuide,
    Positions,
)
from centrode.structure.dimensions import Dimensions


def pulls_of(
    constraint: Constraint,
    mechanism: Mechanism,
    numbers: Dimensions,
    at: Positions,
    teeth: Teeth,
    space: Equilibrium,
) -> list[tuple[Pull, ...]]:
    """Forces and moments of each row of a constraint, at a multiplier of one.

    Rows act on points; where a guide has a slider of its own, and under a rolling wheel, the force is put on the
    slider or the wheel itself: the pin's share of it would be a mere name.
    """
    if isinstance(constraint, GearRatio) and constraint.gear in teeth.axes:
        return [teeth.pulls(constraint, at, numbers)]
    link = _bearer(constraint, mechanism)
    return [space.of_row(constraint, row, at, link) for row in constraint.rows(numbers, at)]


def _bearer(constraint: Constraint, mechanism: Mechanism) -> str | None:
    """The link that takes what a constraint's row gives to a point; None where it is the pin itself."""
    if isinstance(constraint, (PointOnGuide, DisplacementDrive)):
        return mechanism.guide(constraint.guide).link
    return constraint.link if isinstance(constraint, (Contact, NoSlip)) else None
