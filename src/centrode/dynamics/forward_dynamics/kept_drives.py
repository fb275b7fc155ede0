"""Drives that keep their laws in a free motion."""

from __future__ import annotations

from collections.abc import Sequence

from centrode.dynamics.forward_dynamics.equations_of_motion import KeptDrive
from centrode.errors import NotComputedYet
from centrode.kinematics.path import DrivenBy, path_of
from centrode.laws import Law
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.numerics.expressions import EXPRESSIONS, variable
from centrode.numerics.initial_value_problems import TIME
from centrode.numerics.jets import Jet, JetFunctions
from centrode.structure.constraints import AngleDrive, DisplacementDrive, DistanceDrive, constraints_of


def kept_drives_of(mechanism: Mechanism, scale: float, keeps: Sequence[str]) -> tuple[KeptDrive, ...]:
    """Drives that keep their laws, in the order of the constraints.

    Parameters
    ----------
    scale : greatest length of the mechanism [m]
    keeps : ids of drives

    Raises
    ------
    NotComputedYet
        The law of one has text formulas in its segments.
    """
    if not keeps:
        return ()
    driven: dict[str, DrivenBy] = {one.drive.id: one for one in path_of(mechanism, scale).driven}
    found = []
    for constraint in constraints_of(mechanism):
        if (
            isinstance(constraint, AngleDrive | DisplacementDrive | DistanceDrive)
            and constraint.drive in keeps
        ):
            law = driven[constraint.drive].law
            if not _is_traceable(law):
                what = _("a drive that keeps a law with text formulas in its segments is not computed here")
                repair = _("give a speed, a table, one formula, or segments with other curves")
                raise NotComputedYet(f"[[drives]] {constraint.drive}", what, repair)
            found.append(KeptDrive(constraint, driven[constraint.drive]))
    return tuple(found)


def _is_traceable(law: Law) -> bool:
    """Whether a law can be traced: text formulas of segments are chosen by the value of the time."""
    try:
        law.jet(JetFunctions(EXPRESSIONS), Jet((variable(TIME), 1.0, 0.0)))
    except TypeError:
        return False
    return True
