"""Mechanisms whose numbers lie within their limits: what many of them give, and how one goes over into another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError, Status
from centrode.kinematics.plan_evaluation import RadicandZero
from centrode.kinematics.preparation import Ready
from centrode.locale import _, ngettext
from centrode.model.reading import value_text
from centrode.sweeps.outputs import Output, identifier
from centrode.sweeps.solver import Solver
from centrode.sweeps.sweep import sweep
from centrode.tolerances.dimension_limits import DimensionLimits
from centrode.tolerances.sensitivity import differentiated_solver, is_place, unit_of_column

Array: TypeAlias = npt.NDArray[np.float64]

MOST_BY_SOLVER = 20_000
"""Mechanisms that are moved one by one where a sweep does not know an output."""
AT_ONCE = 20_000_000
"""Numbers at samples that a sweep gives at once."""


@dataclass(frozen=True)
class Evaluated:
    """Outputs of many mechanisms.

    Attributes
    ----------
    outputs : name -> (mechanisms,), or (mechanisms, samples)
    moves : (mechanisms,) whether each moves as far as that of the description
    """

    outputs: Mapping[str, Array]
    moves: npt.NDArray[np.bool_]


@dataclass(frozen=True)
class DeviatedMechanisms:
    """A mechanism with limits of its numbers, and outputs.

    Attributes
    ----------
    prepared : the mechanism of the description
    limits : of its numbers
    texts : name of an output -> what it is: one number of a mechanism, or of each sample
    samples : of the motion; None for those of the description
    """

    prepared: Ready
    limits: DimensionLimits
    texts: Mapping[str, str]
    samples: int | None = None

    def __post_init__(self) -> None:
        for name, text in self.texts.items():
            if is_place(text):
                what = _("{name} is known to sensitivity alone").format(name=value_text(text))
                raise InputError(f"outputs {name}", what, _('write a formula: "range(slide_H)"'))
        for name, column in zip(self.texts, self.solver.columns, strict=True):
            if isinstance(column.what, Output) and column.what.shape:
                size = int(np.prod(column.what.shape))
                what = ngettext("{name} has {n} number", "{name} has {n} numbers", size).format(
                    name=value_text(column.what.name), n=size
                )
                raise InputError(f"outputs {name}", what, _('name one of them, as "position.B.x"'))

    @cached_property
    def solver(self) -> Solver:
        """Moves one mechanism after the other, with gradients of the outputs."""
        return differentiated_solver(self.prepared, self.limits.paths, self.texts, samples=self.samples)

    @cached_property
    def of_samples(self) -> dict[str, bool]:
        """Whether an output has a number of every sample."""
        return {name: x.of_samples for name, x in zip(self.texts, self.solver.columns, strict=True)}

    @cached_property
    def units(self) -> dict[str, str]:
        """SI unit of each output."""
        return {name: unit_of_column(x) for name, x in zip(self.texts, self.solver.columns, strict=True)}

    @cached_property
    def nominal(self) -> dict[str, Array]:
        """The outputs of the description: (), or (samples,)."""
        return self.outputs_of(self.limits.values)

    @cached_property
    def gradients(self) -> dict[str, Array]:
        """Derivatives of the outputs at the description: (paths,), or (samples, paths)."""
        return self.gradients_of(self.limits.values)

    @cached_property
    def reached_samples(self) -> int:
        """Samples that the mechanism of the description reaches."""
        return int(np.sum(self.solver.move(list(self.limits.values)).status == Status.OK))

    def outputs_of(self, values: Array) -> dict[str, Array]:
        """The outputs of one mechanism by its numbers [SI]."""
        return self._by_name(self.solver.split(self.solver.outputs(list(values))))

    def gradients_of(self, values: Array) -> dict[str, Array]:
        """The derivatives of the outputs of one mechanism."""
        return self._by_name(self.solver.split(self.solver.gradient(list(values))))

    def _by_name(self, found: Mapping[str, Array]) -> dict[str, Array]:
        return {
            name: np.asarray(found[column.name])
            for name, column in zip(self.texts, self.solver.columns, strict=True)
        }

    def events_of(self, values: Array) -> tuple[RadicandZero, ...]:
        """Limits and change points of one mechanism."""
        return self.solver.move(list(values)).events

    # many mechanisms

    @property
    def has_reactions(self) -> bool:
        """Whether an output is a reaction, which sweeps do not know."""
        return any(column.names_reactions for column in self.solver.columns)

    @property
    def is_sampled(self) -> bool:
        """Whether any output has a number of every sample."""
        return any(self.of_samples.values())

    @property
    def most_at_once(self) -> int:
        """Mechanisms whose outputs fit into memory."""
        most = MOST_BY_SOLVER if self.has_reactions else AT_ONCE
        return max(1, most if not self.is_sampled else min(most, AT_ONCE // self.solver.samples))

    def outputs_of_many(self, deviations: Array) -> Evaluated:
        """Outputs of mechanisms by deviations (mechanisms, paths) [SI] from the description."""
        values = self.limits.values + deviations
        if self.has_reactions:
            return self._one_by_one(values)
        # the tail of a normal distribution may hold lengths that no link has
        impossible = np.asarray((values[:, self.lengths] <= 0.0).any(axis=1))
        if impossible.any():
            values = np.where(impossible[:, None], self.limits.values, values)
        found = sweep(
            self.prepared.mechanism,
            dict(zip(self.limits.paths, np.ascontiguousarray(values.T), strict=True)),
            outputs=self.formulas,
            samples=self.samples,
        )
        moves = (found["samples_ok"].to_numpy() >= self.reached_samples) & ~impossible
        outputs = {
            name: found[label].to_numpy() for name, label in zip(self.texts, self.formulas, strict=True)
        }
        return Evaluated(outputs, moves)

    @cached_property
    def lengths(self) -> list[int]:
        """Which of the numbers have to be positive."""
        return [
            number
            for number, path in enumerate(self.limits.paths)
            if path.rpartition(".")[2] in ("length", "radius", "mass")
        ]

    @cached_property
    def formulas(self) -> dict[str, str]:
        """Label -> formula of each output, as a sweep takes them."""
        labelled = {}
        for number, column in enumerate(self.solver.columns):
            what = column.what
            labelled[f"output{number}"] = (
                identifier(*self._words(what)) if isinstance(what, Output) else what.text.text
            )
        return labelled

    def _words(self, output: Output) -> list[str]:
        quantity, _dot, rest = output.name.partition(".")
        if output.dimensions or not rest:
            return [quantity]
        return [quantity, rest]

    def _one_by_one(self, values: Array) -> Evaluated:
        rows, moves = [], []
        for row in values:
            rows.append(self.outputs_of(row))
            moves.append(int(np.sum(self.solver.move(list(row)).status == Status.OK)) >= self.reached_samples)
        outputs: dict[str, Any] = {name: np.array([row[name] for row in rows]) for name in self.texts}
        return Evaluated(outputs, np.array(moves))
