"""Names and units around friction, beside those of reactions."""

from __future__ import annotations

from typing import Any

import numpy as np

from centrode.dynamics.friction.contacts import Bearing, Contact
from centrode.dynamics.friction.following import Outcome
from centrode.dynamics.friction.losses import JAMMED, LOCKING, Powers, works_over
from centrode.dynamics.friction.reversals import reversals
from centrode.dynamics.friction.rubbing import Rubbed
from centrode.kinematics.dataset import Variable, labels_of, named
from centrode.kinematics.solve import Solved


def friction_variables(solved: Solved, rubbed: Rubbed, powers: Powers, whole: bool) -> dict[str, Variable]:
    """What is known of friction besides what stands at every sample that has reactions; works over a `whole` range."""
    parameter = solved.span.parameter
    locking = powers.locking
    locking[rubbed.solution.outcome == Outcome.LOCKED] = JAMMED
    dimensions, values, attributes = named("self_locking", ("sample",), locking)
    flags = {
        "flag_values": np.array(list(LOCKING), dtype=np.int8),
        "flag_meanings": " ".join(LOCKING.values()),
    }
    works = works_over(parameter, powers.rate, -rubbed.amounts * rubbed.slopes)
    works = np.where(whole and _found(rubbed), works, np.nan)
    found = {
        "friction_work": named("friction_work", ("friction",), works),
        "friction_turns": named("friction_turns", ("sample", "friction"), rubbed.turns.astype(np.int8)),
        "self_locking": (dimensions, values, attributes | flags),
    }
    if not solved.ready.kinematics.path.by_time:
        first, last = float(np.min(parameter)), float(np.max(parameter))
        places = reversals(solved.ready, rubbed.contacts, first, last)
        found["jumps"] = named("jumps", ("jump",), places, solved.ready.parameter.units[0])
    return found


def friction_coordinates(contacts: tuple[Contact, ...]) -> dict[str, Any]:
    """Labels of the contacts."""
    bearings = tuple(contact.label for contact in contacts if isinstance(contact, Bearing))
    found = {"friction": labels_of(tuple(contact.label for contact in contacts))}
    return found | ({"bearing": labels_of(bearings)} if bearings else {})


def friction_attributes(solved: Solved, rubbed: Rubbed, powers: Powers, whole: bool) -> dict[str, Any]:
    """How well the sizes were found, what does not rub because it does not move, and the efficiency of the whole."""
    return {
        "friction_residual": float(np.max(rubbed.solution.residual, initial=0.0)),
        "friction_iterations": rubbed.solution.tries,
        "standing": "; ".join(rubbed.standing),
        "efficiency": powers.mean_efficiency(solved.span.parameter)
        if whole and _found(rubbed)
        else float("nan"),
    }


def _found(rubbed: Rubbed) -> bool:
    return bool((rubbed.solution.outcome == Outcome.FOUND).all())
