"""Outputs of a solver: numbers at samples or reduced, and their derivatives by the free numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError, Status
from centrode.kinematics.machine_code.frame_kernels import RESIDUAL, SLACK_AT_SAMPLES, Known, closes
from centrode.kinematics.machine_code.frame_plan import FramePlan, FreeMechanism, SampleScan, screening_of
from centrode.kinematics.machine_code.trace import Traced, Untraceable
from centrode.kinematics.machine_code.variables import Varied, box_array
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import Ready
from centrode.kinematics.solve import Solved, solve
from centrode.locale import _
from centrode.model.reading import value_text
from centrode.numerics.expressions import Node, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import evaluate
from centrode.sweeps.designs import Listed
from centrode.sweeps.folds import Fold, Folds, Slopes, States
from centrode.sweeps.outputs import Output, OutputFormula, formulas_of, outputs_of, quantities_of
from centrode.sweeps.sweep import motion_with_names

Array: TypeAlias = npt.NDArray[np.float64]
Asked: TypeAlias = str | Sequence[str] | Mapping[str, str] | None
Given: TypeAlias = Sequence[float]


@dataclass(frozen=True)
class LiveColumn:
    """An output: a quantity at every sample, or a formula of samples or reduced; `shape` is that of its numbers."""

    name: str
    what: Output | OutputFormula
    of_samples: bool
    shape: tuple[int, ...]

    def of(self, solved: Solved, values: Mapping[str, Array], ok: npt.NDArray[np.bool_]) -> Any:
        """Its numbers from a motion by the arrays."""
        if isinstance(self.what, Output):
            return self.what.of(solved, values)[0]
        numbers = self.what.of(solved, values, ok, {})[0]
        return np.where(ok[0], numbers, np.nan) if self.of_samples else float(numbers)


@dataclass(frozen=True)
class SolverOutputs:
    """The outputs of a solver in their order."""

    columns: tuple[LiveColumn, ...]
    paths: tuple[str, ...]

    @property
    def numbers(self) -> int:
        """How many numbers they are."""
        return sum(math.prod(column.shape) for column in self.columns)

    def of(self, solved: Solved, given: Given) -> dict[str, Any]:
        """The outputs from a motion by the arrays."""
        values = {path: np.array([x]) for path, x in zip(self.paths, given, strict=True)}
        ok = solved.status == Status.OK
        return {column.name: column.of(solved, values, ok) for column in self.columns}

    def without_values(self) -> dict[str, Any]:
        """The outputs of a mechanism that cannot be."""
        return {
            column.name: np.full(column.shape, np.nan) if column.shape else math.nan
            for column in self.columns
        }

    def joined(self, outputs: Mapping[str, Any]) -> Any:
        """All numbers in a row; one alone as it is."""
        if self.numbers == 1:
            return float(np.ravel(outputs[self.columns[0].name])[0])
        return np.concatenate([np.ravel(outputs[column.name]) for column in self.columns])

    def blank(self, free: int) -> Array:
        """Derivatives that are not there."""
        return self.alone(np.full((self.numbers, free), np.nan))

    def alone(self, slopes: Array) -> Array:
        """Derivatives (numbers, free); of one number alone (free,)."""
        return slopes[0] if self.numbers == 1 else slopes

    def split(self, numbers: Array) -> dict[str, Array]:
        """Output -> its numbers, or their derivatives, from those of all."""
        if self.numbers == 1:
            numbers = numbers[None]
        parts, first = {}, 0
        for column in self.columns:
            count = math.prod(column.shape)
            part = numbers[first : first + count]
            parts[column.name] = part.reshape(*column.shape, *numbers.shape[1:])
            first += count
        return parts


def asked_outputs(
    ready: Ready, span: SampleGrid, paths: tuple[str, ...], asked: Asked
) -> SolverOutputs | None:
    """The outputs that are requested. Raises InputError: an unknown quantity, name or label, not a formula."""
    if asked is None:
        return None
    given: object = asked
    if not isinstance(given, Iterable):
        what = _("an output is a text such as {example}").format(example='"position.C"')
        raise InputError("outputs", what)
    named = isinstance(asked, Mapping)
    texts = dict(asked) if isinstance(asked, Mapping) else [asked] if isinstance(asked, str) else list(asked)
    motion = motion_with_names(solve(ready, span), str(texts))
    known, samples = quantities_of(motion), len(span.parameter)
    design = Listed({path: np.ones(1) for path in paths})
    columns: list[LiveColumn] = []
    for k, text in enumerate(texts):
        name, formula = (text, texts[text]) if isinstance(texts, dict) else (text, text)
        if str(formula).partition(".")[0] in known:
            (output,) = outputs_of(motion, [formula])
            columns.append(LiveColumn(str(name), output, True, (samples, *output.shape)))
            continue
        label = name if named else f"value{k}"
        (made,) = formulas_of(motion, design, {label: formula}, {}, where="outputs")
        columns.append(LiveColumn(str(name), made, made.at_samples, (samples,) if made.at_samples else ()))
    names = [column.name for column in columns]
    for name in names:
        if names.count(name) > 1:
            raise InputError("outputs", _("{name} is given twice").format(name=value_text(name)))
    if not columns:
        raise InputError("outputs", _("no output is given"), _('name one, such as "position.C" or "angle"'))
    return SolverOutputs(tuple(columns), paths)


class _SlopesByPaths(Slopes):
    """Derivatives of folds by a state for each path: of one mechanism the chain at the end is what takes time."""

    def states_of(self, name: str) -> States:
        if name not in self.known:
            fold = next(fold for fold in self.folds.found.values() if fold.name == name)
            self.known[name] = self._by_paths(fold)
        return self.known[name]


@dataclass(frozen=True)
class _Part:
    """Numbers of one pass over the samples: rows of its room."""

    scan: SampleScan
    rows: Mapping[tuple[Any, ...], int]
    folds: tuple[Fold, ...]


class LiveOutputs:
    """Outputs of a clear mechanism by kernels, with their derivatives."""

    def __init__(
        self, asked: SolverOutputs, plan: FramePlan, traced: Traced, varied: Varied, free: FreeMechanism
    ) -> None:
        self.asked, self.plan, self.traced, self.varied, self.free = asked, plan, traced, varied, free
        self.folds = Folds(len(free.span.parameter))
        given = {path: box_array([variable(path)]) for path in free.paths}
        self.nodes: dict[str, list[Node]] = {}
        for column in asked.columns:
            if isinstance(column.what, Output):
                self.nodes[column.name] = [as_node(x) for x in column.what.of(traced.solved, given).ravel()]
            else:
                self.nodes[column.name] = [as_node(column.what.trace(self.folds, traced.solved, given, {}))]

    def values(self, given: Given, memory: Any) -> dict[str, Any] | None:
        """The outputs of a mechanism; None where it is not clear."""
        found = self._run(self._parts, given, memory)
        if found is None:
            return None
        known, columns, _slopes = found
        reduced = evaluate(self._final, known)
        return {
            column.name: columns[column.name].reshape(column.shape)
            if column.of_samples
            else float(reduced[column.name])
            for column in self.asked.columns
        }

    def gradient(self, given: Given, memory: Any) -> Array:
        """Derivatives (numbers, free), of one number alone (free,); NaN where the mechanism is not clear."""
        found = self._run(self._parts_with_slopes, given, memory)
        if found is None:
            return self.asked.blank(len(self.free.paths))
        known, _columns, slopes = found
        reduced = evaluate(self._final_slopes, known)
        rows = []
        for column in self.asked.columns:
            if column.of_samples:
                rows.append(slopes[column.name].reshape(-1, len(self.free.paths)))
            else:
                rows.append(
                    np.array([[reduced[f"{column.name} by {path}"] for path in self.free.paths]], float)
                )
        return self.asked.alone(np.concatenate(rows))

    def require_slopes(self) -> None:
        """Raise InputError where the outputs cannot be differentiated."""
        try:
            _ = self._slopes
        except Untraceable as why:
            what = _("derivatives cannot be computed here: {reason}").format(reason=_(why.reason))
            raise InputError("gradient", what, _("omit gradient")) from None

    @cached_property
    def _slopes(self) -> Slopes:
        return _SlopesByPaths.of(self.free.paths, self.varied, self.traced, self.folds, frozenset())

    @cached_property
    def _final(self) -> Graph:
        return Graph({x.name: self.nodes[x.name][0] for x in self.asked.columns if not x.of_samples})

    @cached_property
    def _final_slopes(self) -> Graph:
        return Graph(
            {
                f"{name} by {path}": slope
                for name, node in self._final.outputs.items()
                for path, slope in self._slopes.of_node(node).items()
            }
        )

    @cached_property
    def _parts(self) -> list[_Part]:
        return list(self._passes(slopes=False))

    @cached_property
    def _parts_with_slopes(self) -> list[_Part]:
        return list(self._passes(slopes=True))

    def _passes(self, slopes: bool) -> Iterator[_Part]:
        """The passes over the samples: what hangs on folds of one is computed in the next."""
        screening = screening_of(self.free, self.traced, self.varied, "arrays")
        of_samples = [column for column in self.asked.columns if column.of_samples]
        last = max((self._depth(x) for column in of_samples for x in self.nodes[column.name]), default=0)
        for depth in range(max(self.folds.passes, last + 1)):
            folds = tuple(self.folds.at_depth(depth))
            nodes: dict[tuple[Any, ...], Node] = {}
            if depth == 0:
                nodes[RESIDUAL,] = as_node(self.traced.solved.residual[0, 0])
                if screening.slack_at_samples is not None:
                    nodes[SLACK_AT_SAMPLES,] = screening.slack_at_samples
            for fold in folds:
                nodes["fold", fold.name] = fold.value
                if slopes:
                    nodes |= {
                        ("part", fold.name, x): y for x, y in self._slopes.states_of(fold.name).parts.items()
                    }
            for column in of_samples:
                for k, node in enumerate(self.nodes[column.name]):
                    if self._depth(node) != depth:
                        continue
                    if not slopes:
                        nodes["column", column.name, k] = node
                        continue
                    by = self._slopes.of_node(node)
                    nodes |= {
                        ("slope", column.name, k, j): by[path] for j, path in enumerate(self.free.paths)
                    }
            scan = self.plan.samples_of({str(k): node for k, node in enumerate(nodes.values())})
            yield _Part(scan, {key: k for k, key in enumerate(nodes)}, folds)

    def _depth(self, node: Node) -> int:
        used = frozenset(Graph({"": node}).variables)
        return max((fold.depth + 1 for fold in self.folds.found.values() if fold.name in used), default=0)

    def _run(
        self, parts: Sequence[_Part], given: Given, memory: Any
    ) -> tuple[Known, dict[str, Array], dict[str, Array]] | None:
        """Variables with the results of folds, numbers at samples, their derivatives; None where it is not clear."""
        known = self.plan.judged(given, memory)
        if known is None:
            return None
        samples, free = len(self.free.span.parameter), len(self.free.paths)
        columns = {
            x.name: np.empty((samples, len(self.nodes[x.name]))) for x in self.asked.columns if x.of_samples
        }
        slopes = {name: np.empty((*array.shape, free)) for name, array in columns.items()}
        for part in parts:
            room = part.scan.room()
            if not part.scan.fill(known, room):
                return None
            rows = room[:, 0]
            if (RESIDUAL,) in part.rows:
                slack = part.rows.get((SLACK_AT_SAMPLES,))
                if not closes(rows[part.rows[RESIDUAL,]].max(), None if slack is None else rows[slack].min()):
                    return None
            for fold in part.folds:
                _fold(known, fold, rows, part.rows)
            for key, k in part.rows.items():
                if key[0] == "column":
                    columns[key[1]][:, key[2]] = rows[k]
                elif key[0] == "slope":
                    slopes[key[1]][:, key[2], key[3]] = rows[k]
        return known, columns, slopes


def _fold(known: Known, fold: Fold, rows: Array, places: Mapping[tuple[Any, ...], int]) -> None:
    """Add what is left of a fold over all samples, and of its derivatives: at an extreme those of its first sample."""
    values = rows[places["fold", fold.name]]
    at = (
        slice(None)
        if fold.kind == "sum"
        else int(np.argmin(values) if fold.kind == "min" else np.argmax(values))
    )
    known[fold.name] = float(np.sum(values[at]))
    for key, k in places.items():
        if key[:2] == ("part", fold.name):
            known[key[2]] = float(np.sum(rows[k][at]))
