"""Folds of traced formulas, and their derivatives by the values that vary: states that a scan over samples carries.

What is reduced over samples becomes a state of a scan, and then a number of the mechanism. A fold of what another fold
gave (`max(abs(x - mean(x)))`) needs that one first: samples are passed once for each depth of folds.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

from centrode.kinematics.machine_code.trace import ImpliedPlaces, Traced, Untraceable
from centrode.kinematics.machine_code.variables import Varied
from centrode.locale import mark
from centrode.numerics.expressions import EXPRESSIONS, Expressions, Node, Operand, as_node, variable
from centrode.numerics.graphs import Graph, gradient, rebuilt, split_graph
from centrode.numerics.linear_forms import ONE, StandingFactors
from centrode.numerics.operations import CONSTANT, VARIABLE
from centrode.numerics.scans import Reduction
from centrode.structure.gearing import Straight


@dataclass(frozen=True)
class Fold:
    """A fold: the name of its result, what is folded, and how often samples have been passed before."""

    name: str
    kind: str
    value: Node
    depth: int

    @property
    def state(self) -> Reduction:
        """The fold as a state that a scan over samples carries on; NaN at a sample makes the result NaN."""
        m, so_far = EXPRESSIONS, variable(self.name)
        if self.kind == "sum":
            return Reduction({self.name: as_node(so_far + self.value)}, {self.name: 0.0})
        # `min` and `max` of nodes let NaN win, as folds over arrays do
        extreme, start = (m.min, math.inf) if self.kind == "min" else (m.max, -math.inf)
        return Reduction({self.name: as_node(extreme(self.value, so_far))}, {self.name: start})


NEUTRAL = {"sum": 0.0, "min": math.inf, "max": -math.inf}
"""What changes nothing in a fold."""


@dataclass(frozen=True)
class Known:
    """The samples at which the tables of a formula have numbers: a variable that is 1 there, and how many they are."""

    name: str
    count: int

    def only(self, value: Operand, otherwise: float) -> Operand:
        """A value there, elsewhere another one."""
        return EXPRESSIONS.where(EXPRESSIONS.equal(variable(self.name), 1.0), value, otherwise)


@dataclass
class Folds(Expressions):
    """Namespace that traces formulas of so many samples; the folds they ask for are listed in `found`."""

    samples: int
    found: dict[tuple[str, bytes], Fold] = field(default_factory=dict)

    def fold(self, name: str, value: Operand, known: Known | None = None) -> Operand:
        # range and mean are made of simpler folds, which other formulas may share
        """The number that a fold of FOLDS gives; of some samples alone where `known` says which."""
        if name == "range":
            return self.fold("max", value, known) - self.fold("min", value, known)
        if name == "mean":
            count = self.samples if known is None else known.count
            return self.fold("sum", value, known) / float(count)
        node = as_node(value if known is None else known.only(value, NEUTRAL[name]))
        key = name, node.key
        if key not in self.found:
            self.found[key] = Fold(f"fold {len(self.found)}", name, node, self._depth(node))
        return variable(self.found[key].name)

    def within(self, known: Known | None) -> Expressions:
        """The namespace whose folds take the known samples alone."""
        return self if known is None else FoldsWithin(self, known)

    def at_depth(self, depth: int) -> Sequence[Fold]:
        """The folds that need so many passes before their own."""
        return [fold for fold in self.found.values() if fold.depth == depth]

    @property
    def passes(self) -> int:
        """Number of passes over the samples, at least one."""
        return 1 + max((fold.depth for fold in self.found.values()), default=0)

    def _depth(self, node: Node) -> int:
        used = set(Graph({"": node}).variables)
        # a fold inside a fold has to be finished first: so many passes lie before this one
        return 1 + max((fold.depth for fold in self.found.values() if fold.name in used), default=-1)


@dataclass
class FoldsWithin(Expressions):
    """Namespace whose folds take some samples alone; what they find is listed with all others."""

    folds: Folds
    known: Known

    def fold(self, name: str, value: Operand) -> Operand:
        """The number that a fold of FOLDS gives."""
        return self.folds.fold(name, value, self.known)


# Derivatives of what is requested by the values that vary, as expressions: reverse mode through samples and
# folds.

Through: TypeAlias = Sequence[tuple[Node, Operand]]
"""The variables that a value moves, each with its derivative by that value."""

m = EXPRESSIONS


NUMBER_OF_SAMPLE = "number of sample"
"""An input of a pass: 0 at the first sample, 1 at the next one."""


@dataclass(frozen=True)
class States:
    """Derivatives of a fold.

    Attributes
    ----------
    parts : state -> what is folded into it: a derivative of the formula at a sample, or which sample it is
    at_end : path -> derivative by the value there, from the states when all samples are passed
    sample : of an extreme, the state that says at which sample it is, and
    there : the inputs of that sample by names of their own: name -> input
    """

    parts: Mapping[str, Node]
    at_end: Mapping[str, Node]
    sample: str = ""
    there: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Slopes:
    """Derivatives by values at paths.

    Attributes
    ----------
    through : path -> the variables of the plan that it moves
    standing : name -> whole turns in angles, which jump and have no derivative; what is found by iteration
    folds : whose results have derivatives of their own
    moving : variables that differ from sample to sample
    inputs : those of them that are the same for all mechanisms; with these the derivatives of an extreme are computed
        once a mechanism, at its sample, if nothing else moves
    implied : places of the plan as implicit functions, which are differentiated in place of the closed forms
    known : fold -> its states, once they have been requested
    """

    through: Mapping[str, Through]
    standing: Mapping[str, Node]
    folds: Folds
    moving: frozenset[str]
    inputs: frozenset[str] = frozenset()
    implied: ImpliedPlaces | None = None
    known: dict[str, States] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        paths: Sequence[str],
        varied: Varied,
        traced: Traced,
        folds: Folds,
        moving: frozenset[str],
        inputs: frozenset[str] = frozenset(),
    ) -> Slopes:
        """Derivatives by all paths that vary. Raises Untraceable for one that moves more than is known here."""
        return cls(through_of(paths, varied), traced.standing, folds, moving, inputs, traced.implied)

    def of_node(self, node: Node) -> dict[str, Node]:
        # what jumps, or was found by iteration, is put aside as a variable: it has no derivative
        """Path -> derivative of an expression, that of the folds it uses included."""
        still = self._without_standing(node)
        used = frozenset(Graph({"": still}).variables)
        names = [fold.name for fold in self.folds.found.values() if fold.name in used]
        moved = list(dict.fromkeys(x for path in self.through.values() for x, _factor in path))
        parts = gradient(still, [*moved, *map(variable, names)])
        partial = dict(zip(moved, parts, strict=False))
        of_folds = dict(zip(names, parts[len(moved) :], strict=True))
        slopes: dict[str, Operand] = {}
        for path, through in self.through.items():
            total: Operand = 0.0
            for x, factor in through:
                total = total + partial[x] * factor
            for name, part in of_folds.items():
                # the chain through a fold's result: its own derivatives are summed up while the samples are
                # passed
                total = total + part * self.states_of(name).at_end[path]
            slopes[path] = total
        return dict(self._with_closed_forms(Graph.of(slopes)).outputs)

    def of_fold(self, fold: Fold) -> Reduction:
        """The states of a fold's derivatives; at an extreme they are those of the first sample that has it."""
        so_far = variable(fold.name)
        # strictly better, so that of equal values the first sample's derivatives stay
        better = m.less(fold.value, so_far) if fold.kind == "min" else m.less(so_far, fold.value)
        state = {}
        for label, part in self.states_of(fold.name).parts.items():
            more = variable(label) + part if fold.kind == "sum" else m.where(better, part, variable(label))
            state[label] = as_node(more)
        return Reduction(state, dict.fromkeys(state, 0.0))

    def states_of(self, name: str) -> States:
        """States by which a scan carries the derivatives of a fold of this name: those with less work at a sample."""
        if name not in self.known:
            fold = next(fold for fold in self.folds.found.values() if fold.name == name)
            if fold.kind == "sum":
                self.known.update(self._of_sums(fold.depth))
            else:
                by_paths = self._by_paths(fold)
                self.known[name] = self._at_sample(fold, by_paths) or by_paths
        return self.known[name]

    def _of_sums(self, depth: int) -> dict[str, States]:
        """States of all sums of one pass: what they have in common is computed once."""
        sums = [fold for fold in self.folds.at_depth(depth) if fold.kind == "sum"]
        ways = [{fold.name: min(self._by_paths(fold), self._by_parts(fold), key=self._work) for fold in sums}]
        if not depth:
            ways.append(self._by_forms(sums))
        return min(ways, key=lambda states: self._work(*states.values()))

    def _by_forms(self, sums: Sequence[Fold]) -> dict[str, States]:
        """A state for what moves in the derivatives in the direction of each path; several may have it in common."""
        still = [self._without_standing(fold.value) for fold in sums]
        directions = [{as_node(x): factor for x, factor in through} for through in self.through.values()]
        factors = StandingFactors(self.moving)
        forms = factors.derivatives(still, directions, self._with_closed_forms)
        found: dict[str, States] = {}
        for k, fold in enumerate(sums):
            parts: dict[str, Node] = {}
            ends: dict[str, Operand] = {}
            for path, of_path in zip(self.through, forms, strict=True):
                ends[path] = 0.0
                for what, factor in factors.with_common_factors(of_path[k]).items():
                    if what is ONE:
                        ends[path] = ends[path] + factor * float(self.folds.samples)
                        continue
                    label = f"sum {what.key.hex()}"
                    parts[label] = what
                    ends[path] = ends[path] + variable(label) * factor
            found[fold.name] = States(parts, {path: as_node(end) for path, end in ends.items()})
        return found

    def _split(self, still: Graph) -> tuple[Graph, Graph, dict[str, Node]]:
        """Parts that stand while samples are passed, the rest with these as variables, and all that stands in it."""
        # what differs from sample to sample, and what jumps, cannot stand still
        jumping = self.moving | self.given_numbers.keys()
        variables = [x for x in still.variables if x not in jumping]
        parts, rest = split_graph(still, variables, f"{next(iter(still.outputs))} part")
        return parts, rest, {**parts.outputs, **{x: variable(x) for x in rest.variables if x in variables}}

    def _at_sample(self, fold: Fold, by_paths: States) -> States | None:
        """One state for all paths: at which sample the extreme is. None where more moves than inputs."""
        slopes = Graph(dict(zip(by_paths.at_end, by_paths.parts.values(), strict=True)))
        moving = [name for name in slopes.variables if name in self.moving]
        if not self.inputs or not self.inputs.issuperset(moving):
            return None
        sample = f"{fold.name} at"
        there = {f"{sample} {name}": name for name in moving}
        ends = slopes.substitute({name: variable(own) for own, name in there.items()})
        return States({sample: variable(NUMBER_OF_SAMPLE)}, ends.outputs, sample, there)

    def _by_paths(self, fold: Fold) -> States:
        """A state for each path."""
        slopes = self.of_node(fold.value)
        labels = {path: derivative_name(fold.name, path) for path in slopes}
        parts = {labels[path]: slope for path, slope in slopes.items()}
        return States(parts, {path: variable(label) for path, label in labels.items()})

    def _by_parts(self, fold: Fold) -> States:
        """A state for each part of the formula that stands while the samples are passed.

        To fold is linear in derivatives. So the chain from these parts down to the values at paths is gone through
        once a mechanism, at the end.
        """
        parts, rest, standing = self._split(Graph({fold.name: self._without_standing(fold.value)}))
        factors = {x: self.of_node(node) for x, node in standing.items()}
        # parts that no value moves need no state
        moved = [x for x, factor in factors.items() if any(map(_is_something, factor.values()))]
        slopes = gradient(rest.outputs[fold.name], [variable(x) for x in moved])
        labels = {x: f"{fold.name} through {x}" for x in moved}
        graph = Graph.of(dict(zip(labels.values(), slopes, strict=True)))
        ends: dict[str, Operand] = dict.fromkeys(self.through, 0.0)
        for x in moved:
            for path, factor in factors[x].items():
                ends[path] = (
                    ends[path] + variable(labels[x]) * factor if _is_something(factor) else ends[path]
                )
        # the parts are put back as expressions: states are folded from variables of the plan alone
        outputs = self._with_closed_forms(graph.substitute(parts.outputs)).outputs
        return States(outputs, {path: as_node(end) for path, end in ends.items()})

    @cached_property
    def given_numbers(self) -> dict[str, Node]:
        """Name -> what derivatives by dimensions take as given: what stands, and what implicit functions hold."""
        return {**self.standing, **(self.implied.held if self.implied else {})}

    @cached_property
    def _replacements(self) -> dict[Node, Node]:
        """What stands as variables, and places in closed form as implicit functions of their loci."""
        replacements = {x: variable(name) for name, x in self.standing.items()}
        for place, implied in self.implied.places.items() if self.implied else ():
            # loci may hang on places that were found before
            replacements[place] = self._replace(implied, replacements)
        return replacements

    @cached_property
    def _closed_forms(self) -> dict[Node, Node]:
        """The other way round: values are those of closed forms."""
        return {x: place for place, x in self._replacements.items()}

    def _with_closed_forms(self, slopes: Graph) -> Graph:
        """Derivatives with the numbers that they take as given."""

        def replacement(node: Node, _arguments: tuple[Node, ...]) -> Node | None:
            closed = self._closed_forms.get(node)
            return (
                self.given_numbers.get(str(node.detail)) if closed is None and not node.arguments else closed
            )

        return Graph(rebuilt(slopes.outputs, replacement))

    def _without_standing(self, node: Node) -> Node:
        return self._replace(node, self._replacements)

    def _replace(self, node: Node, replacements: Mapping[Node, Node]) -> Node:
        return rebuilt({"": node}, lambda x, _arguments: replacements.get(x))[""]

    def _work(self, *ways: States) -> int:
        """Operations that are carried out at every sample."""
        parts = {name: part for states in ways for name, part in states.parts.items()}
        moving = set()
        for node in Graph(parts).order:
            own = node.operation == VARIABLE and node.detail in self.moving
            if own or any(x in moving for x in node.arguments):
                moving.add(node)
        return len(moving) + len(parts)


def _is_something(factor: Node) -> bool:
    return factor.operation != CONSTANT or factor.detail != 0.0


def derivative_name(name: str, path: str) -> str:
    """Name of the derivative of a fold by the value at a path."""
    return f"{name} by {path}"


def _of_a_mass(path: str) -> bool:
    """Whether a path is that of a mass, which no dimension of the plan is."""
    room, *_name, last = path.split(".")
    return room == "links" and (last in ("mass", "inertia", "radius", "centre_radius") or ".centre." in path)


def through_of(paths: Sequence[str], varied: Varied) -> Mapping[str, Through]:
    """Path -> the variables of a plan that its value moves, each with a factor.

    Raises Untraceable for one that moves more than is known here.
    """
    return {path: _through(path, varied) for path in paths}


def _through(path: str, varied: Varied) -> Through:
    """The variables that the value at a path moves: itself, or cosine and sine of a direction."""
    if path in varied.names or _of_a_mass(path):
        return [(variable(path), 1.0)]
    directions = {f"guides.{guide}.direction": x for guide, x in varied.numbers.direction.items()}
    for wheel, track in varied.numbers.gearing.track.items():
        if isinstance(track, Straight):
            directions[f"rolling.{wheel}.along.direction"] = track.direction
    if path not in directions or not all(isinstance(x, Node) for x in directions[path]):
        raise Untraceable(mark("derivatives by numbers that move nothing"))
    cosine, sine = directions[path]
    # d cos = -sin and d sin = cos by the angle
    return [(cosine, -sine), (sine, cosine)]
