"""What can be said of a mechanism before it moves: structure, mobility, plan, initial position."""

from __future__ import annotations

from dataclasses import dataclass, field

from centrode.chains.identification import ChainOfMechanism, chain_of
from centrode.kinematics.preparation import Ready, ready
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.printed_results import PrintsSummary
from centrode.structure.assur import AssurGroup, assur_groups, structural_formula
from centrode.structure.rank import Count, count


@dataclass(frozen=True, repr=False)
class MechanismCheck(PrintsSummary):
    """Structure of a mechanism that assembles and can be driven.

    Attributes
    ----------
    mechanism : Mechanism
    mobility : by the rank of the Jacobian at real positions; `count` gives Chebyshev's formula beside it
    redundant : names of the constraints that repeat others
    groups : inputs and Assur groups in the order in which they are solved
    formula : the groups as a structural formula
    plan : the steps of the solution in words
    initial_residual : how well the initial position closes, in units of the greatest length
    chain : the kinematic chain, and which of its inversions the mechanism is
    """

    mechanism: Mechanism = field(repr=False)
    mobility: int
    drives: tuple[str, ...]
    count: Count
    redundant: tuple[str, ...]
    groups: tuple[AssurGroup, ...]
    formula: str
    plan: tuple[str, ...]
    initial_residual: float
    chain: ChainOfMechanism


def check(mechanism: MechanismSource) -> MechanismCheck:
    """Structure, mobility and plan of a mechanism; raises as `motion` does before it computes.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.check(ct.example("crank-rocker")).mobility
    1
    """
    mechanism = mechanism_of(mechanism)
    return check_of(ready(mechanism))


def check_of(prepared: Ready) -> MechanismCheck:
    """Structure, mobility and plan of a mechanism that is prepared already."""
    structure = prepared.structure
    mechanism = prepared.mechanism
    return MechanismCheck(
        mechanism,
        prepared.mobility,
        tuple(drive.id for drive in mechanism.drives),
        count(mechanism, structure.redundant),
        tuple(constraint.label for constraint in structure.redundant),
        assur_groups(structure),
        structural_formula(structure),
        tuple(group.sentence for group in structure.groups),
        prepared.assembled.residual,
        chain_of(mechanism),
    )
