"""Outputs of a solver: numbers at samples or reduced, and their derivatives by the free numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.kinetostatics.applied_forces import input_motion_of
from centrode.dynamics.kinetostatics.friction import contacts_of
from centrode.dynamics.kinetostatics.reaction_expressions import LARGEST_GAIN, REACTIONS, reaction_gain
from centrode.dynamics.kinetostatics.reactions import reactions_at
from centrode.dynamics.loads import MassesAndLoads
from centrode.errors import InputError, Status
from centrode.kinematics.machine_code.event_free_mechanisms import SAFE
from centrode.kinematics.machine_code.frame_kernels import RESIDUAL, SLACK_AT_SAMPLES, Known, closes
from centrode.kinematics.machine_code.frame_plan import FramePlan, FreeMechanism, SampleScan, screening_of
from centrode.kinematics.machine_code.trace import Traced, Untraceable
from centrode.kinematics.machine_code.variables import Varied, box_array, centre_of, inputs_of, winding_of
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import Ready
from centrode.kinematics.samples import SUSPECT
from centrode.kinematics.solve import Solved, solve
from centrode.locale import _
from centrode.model.reading import value_text
from centrode.numerics.expressions import Node, as_node, variable
from centrode.numerics.graphs import Graph, directional_derivatives
from centrode.numerics.jets import Jet
from centrode.numerics.scans import evaluate
from centrode.sweeps.designs import Listed
from centrode.sweeps.folds import Fold, Folds, Slopes, States
from centrode.sweeps.outputs import Output, OutputFormula, formulas_of, outputs_of, quantities_of
from centrode.sweeps.sweep_plans import motion_with_names

Array: TypeAlias = npt.NDArray[np.float64]
Asked: TypeAlias = str | Sequence[str] | Mapping[str, str] | None
Given: TypeAlias = Sequence[float]
GAIN = "gain of reactions"
SAME = 1e-6
"""Share of the size up to which places are the same: another branch is farther off."""


@dataclass(frozen=True)
class LiveColumn:
    """An output: a quantity at every sample, or a formula of samples or reduced; `shape` is that of its numbers."""

    name: str
    what: Output | OutputFormula
    of_samples: bool
    shape: tuple[int, ...]

    @property
    def names_reactions(self) -> bool:
        """Whether it is a reaction, or a formula of some."""
        if isinstance(self.what, Output):
            return self.what.quantity in REACTIONS
        outputs = (variable.output for variable in self.what.variables.values())
        return any(output is not None and output.quantity in REACTIONS for output in outputs)

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

    def join_numbers(self, outputs: Mapping[str, Any]) -> Any:
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
            parts[column.name] = part.reshape((*column.shape, *numbers.shape[1:]))
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
    solved = solve(ready, span)
    motion = _with_reactions(motion_with_names(solved, str(texts)), solved, str(texts))
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


def _with_reactions(motion: xr.Dataset, solved: Solved, words: str) -> xr.Dataset:
    """The motion with the reactions of the description, where words name one: masses need not be complete otherwise."""
    if not any(name in words for name in REACTIONS):
        return motion
    burden = MassesAndLoads.for_reactions(solved.ready.mechanism)
    contacts = contacts_of(solved.ready.mechanism)
    found = reactions_at(solved, burden, input_motion_of(solved, burden), contacts)
    return motion.assign({name: found[name].reset_coords(drop=True) for name in REACTIONS if name in found})


class _SlopesByPaths(Slopes):
    """Derivatives of folds by a state for each path: of one mechanism the chain at the end is what takes time."""

    def of_nodes(self, nodes: Sequence[Node]) -> list[dict[str, Node]]:
        """Path -> derivative of each node; forward mode where there are more of them than paths."""
        used = frozenset(Graph({str(k): node for k, node in enumerate(nodes)}).variables)
        folds_inside = any(fold.name in used for fold in self.folds.found.values())
        if len(nodes) <= len(self.through) or folds_inside:
            return [self.of_node(node) for node in nodes]
        still = [self._without_standing(node) for node in nodes]
        found = directional_derivatives(still, [dict(through) for through in self.through.values()])
        names = {(k, j): f"{k} {j}" for k in range(len(nodes)) for j in range(len(found))}
        graph = self._with_closed_forms(Graph.of({name: found[j][k] for (k, j), name in names.items()}))
        return [
            {path: graph.outputs[names[k, j]] for j, path in enumerate(self.through)}
            for k in range(len(nodes))
        ]

    def states_of(self, name: str) -> States:
        if name not in self.known:
            fold = next(fold for fold in self.folds.found.values() if fold.name == name)
            self.known[name] = self._by_paths(fold)
        return self.known[name]


@dataclass(frozen=True)
class OutputPass:
    """What is computed at every sample in one pass: what is folded, and numbers of samples or their derivatives."""

    folds: tuple[Fold, ...]
    nodes: Mapping[tuple[Any, ...], Node]


@dataclass(frozen=True)
class TracedOutputs:
    """Outputs as expressions.

    Attributes
    ----------
    folds : over the samples that count
    nodes : output -> its numbers, of a sample or reduced
    """

    columns: tuple[LiveColumn, ...]
    traced: Traced
    varied: Varied
    paths: tuple[str, ...]
    folds: Folds
    nodes: Mapping[str, Sequence[Node]]

    @classmethod
    def of(
        cls, asked: SolverOutputs, traced: Traced, varied: Varied, paths: tuple[str, ...], samples: int
    ) -> TracedOutputs:
        """The outputs, of which so many samples count. Raises Untraceable."""
        folds, given = Folds(samples), {path: box_array([variable(path)]) for path in paths}
        nodes: dict[str, Sequence[Node]] = {}
        for column in asked.columns:
            if isinstance(column.what, Output):
                nodes[column.name] = [as_node(x) for x in column.what.of(traced.solved, given).ravel()]
            else:
                nodes[column.name] = [as_node(column.what.trace(folds, traced.solved, given, {}))]
        return cls(asked.columns, traced, varied, paths, folds, nodes)

    @cached_property
    def slopes(self) -> _SlopesByPaths:
        """Derivatives of any of them by the free numbers. Raises Untraceable."""
        made = _SlopesByPaths.of(self.paths, self.varied, self.traced, self.folds, frozenset())
        assert isinstance(made, _SlopesByPaths)
        return made

    @cached_property
    def final(self) -> Graph:
        """Numbers of the columns that are reduced, from the folds."""
        return Graph({x.name: self.nodes[x.name][0] for x in self.columns if not x.of_samples})

    @cached_property
    def final_slopes(self) -> Graph:
        """Their derivatives."""
        return Graph(
            {
                f"{name} by {path}": slope
                for name, node in self.final.outputs.items()
                for path, slope in self.slopes.of_node(node).items()
            }
        )

    @cached_property
    def values_of_passes(self) -> list[OutputPass]:
        """The passes over the samples for the numbers: what hangs on folds of one is computed in the next."""
        return [self._pass(depth, slopes=False) for depth in self._depths]

    @cached_property
    def slopes_of_passes(self) -> list[OutputPass]:
        """The passes over the samples for the derivatives."""
        return [self._pass(depth, slopes=True) for depth in self._depths]

    @property
    def _depths(self) -> range:
        nodes = (x for column in self.columns if column.of_samples for x in self.nodes[column.name])
        last = max(map(self._depth, nodes), default=0)
        return range(max(self.folds.passes, last + 1))

    def _depth(self, node: Node) -> int:
        """How often samples have to be passed before a node is known."""
        used = frozenset(Graph({"": node}).variables)
        return max((fold.depth + 1 for fold in self.folds.found.values() if fold.name in used), default=0)

    def _pass(self, depth: int, slopes: bool) -> OutputPass:
        folds = tuple(self.folds.at_depth(depth))
        nodes: dict[tuple[Any, ...], Node] = {}
        for fold in folds:
            nodes["fold", fold.name] = fold.value
            if slopes:
                nodes |= {
                    ("part", fold.name, x): y for x, y in self.slopes.states_of(fold.name).parts.items()
                }
        numbers = {
            (column.name, k): node
            for column in self.columns
            if column.of_samples
            for k, node in enumerate(self.nodes[column.name])
            if self._depth(node) == depth
        }
        if not slopes:
            nodes |= {("column", *where): node for where, node in numbers.items()}
        else:
            found = self.slopes.of_nodes(list(numbers.values()))
            nodes |= {
                ("slope", *where, j): by[path]
                for where, by in zip(numbers, found, strict=True)
                for j, path in enumerate(self.paths)
            }
        return OutputPass(folds, nodes)


@dataclass(frozen=True)
class _OutputPass:
    """Numbers of one pass over the samples: rows of its room."""

    scan: SampleScan
    rows: Mapping[tuple[Any, ...], int]
    folds: tuple[Fold, ...]

    @cached_property
    def blocks(self) -> list[tuple[str, str, list[int], slice]]:
        """Kind, column, which of its numbers, and the rows that they have one after the other."""
        found: dict[tuple[str, str], list[tuple[int, int]]] = {}
        for key, row in self.rows.items():
            if key[0] in ("column", "slope"):
                found.setdefault((key[0], key[1]), []).append((key[2], row))
        return [
            (*where, list(dict.fromkeys(k for k, _row in pairs)), slice(pairs[0][1], pairs[-1][1] + 1))
            for where, pairs in found.items()
        ]

    @cached_property
    def fold_rows(self) -> dict[tuple[Any, ...], int]:
        """Rows of what is folded."""
        return {key: row for key, row in self.rows.items() if key[0] in ("fold", "part")}


class LiveOutputs:
    """Outputs of a clear mechanism by kernels, with their derivatives."""

    def __init__(
        self, asked: SolverOutputs, plan: FramePlan, traced: Traced, varied: Varied, free: FreeMechanism
    ) -> None:
        self.asked, self.plan, self.traced, self.varied, self.free = asked, plan, traced, varied, free
        self._of_fewer: TracedOutputs | None = None
        self.expressed = TracedOutputs.of(asked, traced, varied, free.paths, len(free.span.parameter))
        given = {path: box_array([variable(path)]) for path in free.paths}
        reacting = any(column.names_reactions for column in asked.columns)
        self.gain = reaction_gain(traced.solved, given) if reacting else None

    def values(self, given: Given, memory: Any) -> dict[str, Any] | None:
        """The outputs of a mechanism; None where it is not clear."""
        found = self._run(self._parts, given, memory)
        if found is None:
            return None
        known, columns, _slopes = found
        reduced = evaluate(self.expressed.final, known)
        return {
            column.name: columns[column.name].reshape(column.shape)
            if column.of_samples
            else float(reduced[column.name])
            for column in self.asked.columns
        }

    def gradient(self, given: Given, memory: Any) -> Array | None:
        """Derivatives (numbers, free), of one number alone (free,); None where the mechanism is not clear."""
        found = self._run(self._parts_with_slopes, given, memory)
        if found is None:
            return None
        known, _columns, slopes = found
        return self._join_slopes(slopes, evaluate(self.expressed.final_slopes, known))

    def _join_slopes(self, slopes: Mapping[str, Array], reduced: Mapping[str, Any]) -> Array:
        """Derivatives of all numbers, from those at samples and the reduced ones."""
        paths, rows = self.free.paths, []
        for column in self.asked.columns:
            if column.of_samples:
                rows.append(slopes[column.name].reshape(-1, len(paths)))
            else:
                rows.append(np.array([[reduced[f"{column.name} by {path}"] for path in paths]], float))
        return self.asked.alone(np.concatenate(rows))

    # with events

    def gradient_with_events(self, given: Given, solved: Solved) -> Array:
        """Derivatives of a mechanism that is not clear, from its motion by the arrays.

        NaN at samples without a position, at limits and change points, and where a change point lies in between that
        other dimensions do not have; of a fold over samples where one that counts is among these.
        """
        if self.traced.steps:
            return self.asked.blank(len(self.free.paths))
        columns, paths = self.asked.columns, self.free.paths
        ok = solved.status[0] == Status.OK
        values = self._values_at_samples(given, solved)
        exists = self._differentiable(values, solved)
        expressed = self._of_count(int(ok.sum()))
        samples = len(ok)
        slopes = {
            x.name: np.full((samples, len(expressed.nodes[x.name]), len(paths)), np.nan)
            for x in columns
            if x.of_samples
        }
        for each in expressed.slopes_of_passes:
            names = {key: str(k) for k, key in enumerate(each.nodes)}
            found = evaluate(Graph({names[key]: node for key, node in each.nodes.items()}), values)
            rows = {key: np.broadcast_to(found[name], (samples,)) for key, name in names.items()}
            for key, row in rows.items():
                if key[0] == "slope":
                    slopes[key[1]][:, key[2], key[3]] = np.where(exists, row, np.nan)
            counted = {
                key: np.where(exists, row, np.nan)[ok] if key[0] == "part" else row[ok]
                for key, row in rows.items()
            }
            for fold in each.folds:
                _fold(values, fold, counted)
        return self._join_slopes(slopes, evaluate(expressed.final_slopes, values))

    def _of_count(self, samples: int) -> TracedOutputs:
        """The outputs where so many samples count: a mean is divided by that."""
        if samples == self.expressed.folds.samples:
            return self.expressed
        found = self._of_fewer
        if found is None or found.folds.samples != samples:
            # neighbours of a mechanism have as many as a rule
            found = TracedOutputs.of(self.asked, self.traced, self.varied, self.free.paths, samples)
            self._of_fewer = found
        return found

    def _values_at_samples(self, given: Given, solved: Solved) -> dict[str, Any]:
        """Variables of the trace at all samples: turns are those of the motion that is known."""
        values: dict[str, Any] = dict(self.varied.values(self.free.dimensions(given)))
        values |= {path: np.array([x]) for path, x in zip(self.free.paths, given, strict=True)}
        values |= inputs_of(self.free.ready.kinematics.path, self.free.span)
        for k, link in enumerate(solved.layout.angles):
            if link in self.traced.turning:
                values[centre_of(link)] = solved.angles[0, 0, :, k]
                values |= {winding_of(link, drive): 0.0 for drive in self.traced.winders}
        return values

    def _differentiable(self, values: Mapping[str, Any], solved: Solved) -> npt.NDArray[np.bool_]:
        """Samples at which the trace is the motion, away from singularities."""
        points = [as_node(x) for x in np.ravel(self.traced.solved.points[0])]
        nodes = {f"point {k}": x for k, x in enumerate(points)}
        radicands = {
            f"radicand {group}": as_node(x.value if isinstance(x, Jet) else x)
            for group, x in self.traced.radicands.items()
        }
        if self.gain is not None:
            nodes[GAIN] = self.gain
        found = evaluate(Graph(nodes | radicands), values)
        samples = len(solved.status[0])
        rows = {name: np.broadcast_to(row, (samples,)) for name, row in found.items()}
        there = solved.points[0, 0].reshape(samples, -1)
        size = np.nanmax(np.abs(there), initial=float(self.free.ready.kinematics.path.scale))
        with np.errstate(invalid="ignore"):
            # on the other side of a change point the motion is another branch
            apart = np.array([np.abs(rows[f"point {k}"] - there[:, k]) for k in range(len(points))])
            exists = apart.max(axis=0, initial=0.0) < SAME * size
            exists &= np.isin(solved.status[0], (Status.OK, Status.CUT_OFF))
            for name in radicands:
                # nearer to zero the arrays look at rounding, and derivatives have lost half of their digits
                exists &= rows[name] > SAFE * SUSPECT * np.nanmax(rows[name], initial=0.0)
            if self.gain is not None:
                exists &= rows[GAIN] < LARGEST_GAIN
        return np.asarray(exists)

    def require_slopes(self) -> None:
        """Raise InputError where the outputs cannot be differentiated."""
        try:
            _ = self.expressed.slopes
        except Untraceable as why:
            what = _("derivatives cannot be computed here: {reason}").format(reason=_(why.reason))
            raise InputError("gradient", what, _("omit gradient")) from None

    @cached_property
    def _parts(self) -> list[_OutputPass]:
        return list(self._passes(slopes=False))

    @cached_property
    def _parts_with_slopes(self) -> list[_OutputPass]:
        return list(self._passes(slopes=True))

    def _passes(self, slopes: bool) -> Iterator[_OutputPass]:
        """The passes over the samples, each with what it computes; the first also judges."""
        screening = screening_of(self.free, self.traced, self.varied, "arrays")
        expressed = self.expressed
        for depth, each in enumerate(expressed.slopes_of_passes if slopes else expressed.values_of_passes):
            nodes: dict[tuple[Any, ...], Node] = {}
            if depth == 0:
                nodes[RESIDUAL,] = as_node(self.traced.solved.residual[0, 0])
                if screening.slack_at_samples is not None:
                    nodes[SLACK_AT_SAMPLES,] = screening.slack_at_samples
                if self.gain is not None:
                    nodes[GAIN,] = self.gain
            nodes |= each.nodes
            scan = self.plan.samples_of({str(k): node for k, node in enumerate(nodes.values())})
            yield _OutputPass(scan, {key: k for k, key in enumerate(nodes)}, each.folds)

    def _run(
        self, parts: Sequence[_OutputPass], given: Given, memory: Any
    ) -> tuple[Known, dict[str, Array], dict[str, Array]] | None:
        """Variables with the results of folds, numbers at samples, their derivatives; None where it is not clear."""
        known = self.plan.judged_variables(given, memory)
        if known is None:
            return None
        samples, free = len(self.free.span.parameter), len(self.free.paths)
        columns = {
            x.name: np.empty((samples, len(self.expressed.nodes[x.name])))
            for x in self.asked.columns
            if x.of_samples
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
                # NaN fails the comparison: what is not known is not trusted
                if (GAIN,) in part.rows and not rows[part.rows[GAIN,]].max() < LARGEST_GAIN:
                    return None
            of_folds = {key: rows[k] for key, k in part.fold_rows.items()}
            for fold in part.folds:
                _fold(known, fold, of_folds)
            for kind, name, numbers, block in part.blocks:
                target = columns[name] if kind == "column" else slopes[name]
                turned = rows[block].T.reshape(samples, len(numbers), *target.shape[2:])
                # all of a column at once, as a rule
                target[:, slice(None) if len(numbers) == target.shape[1] else numbers] = turned
        return known, columns, slopes


def _fold(known: dict[str, Any], fold: Fold, rows: Mapping[tuple[Any, ...], Array]) -> None:
    """Add what is left of a fold over samples, and of its derivatives: at an extreme those of its first sample."""
    values = rows["fold", fold.name]
    if not len(values):
        # no sample counts
        known |= {key[2]: math.nan for key in rows if key[:2] == ("part", fold.name)}
        known[fold.name] = math.nan
        return
    at = (
        slice(None)
        if fold.kind == "sum"
        else int(np.argmin(values) if fold.kind == "min" else np.argmax(values))
    )
    known[fold.name] = float(np.sum(values[at]))
    for key, row in rows.items():
        if key[:2] == ("part", fold.name):
            known[key[2]] = float(np.sum(row[at]))
