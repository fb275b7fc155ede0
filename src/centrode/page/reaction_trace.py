"""Reactions of a page's motion, as expressions: what its program computes when a reader looks at them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from centrode.dynamics.kinetostatics.joints import JointSide, sides_of
from centrode.dynamics.kinetostatics.reaction_expressions import REACTIONS, ReactionNodes, reaction_nodes
from centrode.dynamics.kinetostatics.reactions import DIMENSIONS
from centrode.dynamics.masses import masses_of
from centrode.errors import InputError
from centrode.kinematics.machine_code.trace import Untraceable
from centrode.kinematics.machine_code.variables import box_array
from centrode.kinematics.solve import Solved
from centrode.locale import _
from centrode.numerics.expressions import Node, as_node, variable
from centrode.page.plan_trace import BALANCING, TracedQuantity


@dataclass(frozen=True)
class TracedReactions:
    """Reactions at a sample of a page's motion.

    Attributes
    ----------
    rows : numbers, and as the last one the gain above which none of them is trusted; none where there are no reactions
    quantities : of the reactions, with the places of their rows
    sides : of hinges: the point, and the body on which its pin acts
    missing : why there are none; empty where they are, or where there are neither masses nor loads
    """

    rows: tuple[Node, ...] = ()
    quantities: tuple[TracedQuantity, ...] = ()
    sides: tuple[JointSide, ...] = ()
    missing: str = ""


def trace_reactions(solved: Solved, paths: Sequence[str], known: Sequence[TracedQuantity]) -> TracedReactions:
    """Reactions of a traced motion; numbers at the paths vary. What is known of the motion is not repeated."""
    mechanism = solved.ready.mechanism
    if not mechanism.loads and not masses_of(mechanism):
        return TracedReactions()
    try:
        found = reaction_nodes(solved, {path: box_array([variable(path)]) for path in paths})
    except Untraceable as why:
        return TracedReactions(missing=_(why.reason))
    except InputError as failure:
        return TracedReactions(missing=str(failure))
    # the balancing moment that follows from energy is the same number for less work
    names = [name for name in REACTIONS if name in found.parts]
    if any(quantity.name == BALANCING for quantity in known):
        names.remove(BALANCING)
    return _rows(found, names, sides_of(mechanism))


def _rows(found: ReactionNodes, names: Sequence[str], sides: tuple[JointSide, ...]) -> TracedReactions:
    """Rows of the reactions, equal ones once."""
    places: dict[Node, int] = {}
    quantities = []
    for name in names:
        nodes = found.parts[name][0]
        rows = np.empty(np.shape(nodes), dtype=np.intp)
        for place in np.ndindex(rows.shape):
            operand: Any = nodes[place] if rows.shape else nodes
            rows[place] = places.setdefault(as_node(operand), len(places))
        quantities.append(TracedQuantity(name, DIMENSIONS[name], rows))
    return TracedReactions((*places, found.gain), tuple(quantities), sides)
