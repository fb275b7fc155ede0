"""Loads by what becomes of their work: potential energy, friction, or neither; and which follow formulas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.amounts import Constant, Diagram, StraightSpring, TorsionSpring
from centrode.dynamics.loads import Acting, Effort
from centrode.dynamics.states import State
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

STORED, FRICTION, OTHER = "stored", "friction", "other"
SORTS = (STORED, FRICTION, OTHER)
"""Weights and springs; what is described as friction or damper; all else."""


@dataclass(frozen=True)
class Sorted:
    """An effort of a load with its sort; `placed` ones depend on the place and the sense of motion alone."""

    label: str
    effort: Effort
    sort: str

    @property
    def placed(self) -> bool:
        """Whether it can be represented by the drive's value, once for each sense."""
        return isinstance(self.effort.amount, (Constant, StraightSpring, Diagram))

    @property
    def one_sided(self) -> bool:
        """Whether it may be another one for the other sense of motion."""
        effort = self.effort
        return (
            effort.gate is not None or effort.works is not None or effort.amount.jumps or effort.amount.sensed
        )

    def energy(self, state: State) -> Number:
        """Potential energy [J] that belongs to its coordinate; of stored efforts alone."""
        x, amount = self.effort.coordinate.value(state), self.effort.amount
        if isinstance(amount, TorsionSpring):
            return 0.5 * amount.stiffness * (x - amount.free) ** 2
        if isinstance(amount, StraightSpring):
            return 0.5 * amount.stiffness * (np.sqrt(2.0 * x) - amount.free) ** 2
        assert isinstance(amount, Constant)
        return -amount.value * x


def sorted_efforts(mechanism: Mechanism, loads: Sequence[Acting]) -> tuple[Sorted, ...]:
    """The efforts of a mechanism's loads, in the order of the loads."""
    kinds: list[str] = [load.kind for load in mechanism.loads]
    kinds += ["weight"] * (
        len(loads) - len(kinds)
    )  # those that gravity makes stand behind the described ones
    return tuple(
        Sorted(load.label, effort, _sort(kind, effort))
        for kind, load in zip(kinds, loads, strict=True)
        for effort in load.efforts
    )


def _sort(kind: str, effort: Effort) -> str:
    if kind in ("friction", "damper"):
        return FRICTION
    stores = kind in ("weight", "spring") and effort.gate is None
    if stores and isinstance(effort.amount, (Constant, TorsionSpring, StraightSpring)):
        return STORED
    return OTHER


def formulas_of(efforts: tuple[Sorted, ...]) -> tuple[Sorted, ...]:
    """Those whose amount is computed anew at every time."""
    return tuple(one for one in efforts if not one.placed)


def of_time(efforts: tuple[Sorted, ...]) -> bool:
    """Whether a load depends on time."""
    return any("t" in one.effort.amount.uses for one in efforts)
