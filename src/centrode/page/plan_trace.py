"""What a page computes, as expressions: the motion at one place of the path, and what tells where events are.

The plan is run over expressions as it is run over arrays. Variables are the numbers of the mechanism, and those of a
place: the parameter of the path, the rates of the parameter, the sign of each group, the angle with its turns at the
node next to it for everything that gears and wheels depend on.
"""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.masses import masses_of
from centrode.dynamics.reduction import REDUCED, balancing_number, check_reducible, reduced_number
from centrode.errors import InputError, NotComputedYet
from centrode.kinematics.assembly import with_phases
from centrode.kinematics.events import ROOM
from centrode.kinematics.hinge_angles import HINGE_ANGLES, moving_hinges, rotor_of_hinge
from centrode.kinematics.machine_code.trace import (
    MotionParts,
    Untraceable,
    angles_of,
    columns_of,
    motion_of_parts,
)
from centrode.kinematics.machine_code.variables import (
    NODE_JETS,
    PARAMETER,
    TURN,
    Varied,
    box_array,
    whole_turns,
)
from centrode.kinematics.motion import by_time, kinds_of
from centrode.kinematics.path import Path, SampleGrid
from centrode.kinematics.plan_evaluation import EvaluationPolicy, Kinematics, is_long_row, layout_of
from centrode.kinematics.preparation import Ready
from centrode.kinematics.samples import ORDERS
from centrode.kinematics.solve import Solved
from centrode.laws import SegmentedLaw, ShaftLaw
from centrode.locale import _
from centrode.numerics.bends import BendFunctions, Bent, Cells
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.jets import Jet
from centrode.numerics.rounding_bounds import Rounded, RoundedFunctions
from centrode.structure.assur import name_of
from centrode.structure.constraints import Positions
from centrode.structure.groups import Newton

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Nodes: TypeAlias = npt.NDArray[Any]
m = EXPRESSIONS

NODE_BENDS = BendFunctions(EXPRESSIONS)
NODE_BOXES = RoundedFunctions(EXPRESSIONS, gathers=False)
NODE_ROUNDED = RoundedFunctions(EXPRESSIONS)
HALF = "half"
RADICAND, DIVISOR = "radicand", "divisor"


def sign_of(group: int) -> str:
    """Name of the sign of a group at a place; zero where its radicand is zero within rounding."""
    return f"sign {group}"


def near_of(key: str) -> str:
    """Name of an angle with its turns at the node of the mesh that is nearest to a place."""
    return f"near {key}"


def turns_of(link: str) -> str:
    """Name of the whole turns of a link's angle at a place."""
    return f"turns {link}"


def higher_group(ready: Ready) -> str:
    """Name of the first group that has no closed form; empty where all have one."""
    return next((name_of(group) for group in ready.structure.groups if isinstance(group, Newton)), "")


def untraced_drive(ready: Ready) -> str:
    """Name of the first of several drives whose law is not traced; empty where all are."""
    path = ready.kinematics.path
    laws = {driven.drive.id: driven.law for driven in path.driven} if path.by_time else {}
    return next((drive for drive, law in laws.items() if isinstance(law, SegmentedLaw | ShaftLaw)), "")


def refuse_higher_class(ready: Ready) -> None:
    """Raise NotComputedYet, with the group's name, where a group has no closed form."""
    if group := higher_group(ready):
        what = _("a page computes closed forms, and the {group} has none").format(group=group)
        raise NotComputedYet("page", what, _("show it by: {command}").format(command="centrode report"))


def refuse_laws(ready: Ready) -> None:
    """Raise NotComputedYet, with the drive's name, for a law of several drives that is not traced."""
    if drive := untraced_drive(ready):
        what = _("a page with several drives knows no law of a cam, and drive {drive} has one")
        raise NotComputedYet("page", what.format(drive=drive), _("drive it by a formula or a table"))


@dataclass
class _TracingPolicy(EvaluationPolicy):
    """Signs as variables; keeps radicands, divisors and the angles whose turns are counted."""

    m: Namespace
    at_samples: bool = False
    radicands: dict[int, Number] = field(default_factory=dict)
    divisors: dict[int, Number] = field(default_factory=dict)
    counted: dict[str, Number] = field(default_factory=dict)

    def root(self, group: int, radicand: Number) -> Number:
        self.radicands[group] = radicand
        sign = variable(sign_of(group))
        if self.at_samples:
            # a radicand that does not move has derivatives that are zero: groups behind need jets
            if not isinstance(radicand, Jet):
                radicand = Jet((radicand, *[0.0] * (ORDERS - 1)))
            # a root of rounding would move the point: without a sign it is zero exactly
            first = m.where(m.equal(sign, 0.0), 0.0, radicand.coefficients[0])
            radicand = Jet((first, *radicand.coefficients[1:]))
        return self.m.sqrt(radicand) * sign

    def divisor(self, group: int, divisor: Number) -> Number:
        self.divisors[group] = divisor
        return divisor

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        value = angle.value if isinstance(angle, (Jet, Rounded)) else angle
        self.counted[key] = value
        return angle + TURN * whole_turns(variable(near_of(key)), value)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        raise AssertionError("groups of higher class are refused before")


@dataclass(frozen=True)
class Row:
    """Row of numbers that the motion has at every sample.

    Attributes
    ----------
    derivative : whether it is a derivative: absent in singular samples
    of_frame : whether it belongs to a point that never moves
    """

    node: Node
    derivative: bool
    of_frame: bool


@dataclass(frozen=True)
class TracedQuantity:
    """Quantity of a motion: its name and dimensions, and the place of its rows among all, in its own shape."""

    name: str
    dimensions: tuple[str, ...]
    rows: npt.NDArray[np.intp]


@dataclass(frozen=True)
class PageTrace:
    """A plan with everything that a page computes.

    Attributes
    ----------
    rows, quantities : of the motion at a sample
    angles : link, or key of a hinge -> row of its angle without turns, which are counted along the path
    residual : the greatest residual at a sample
    guards : (radicand or divisor, group), in the order of the plan
    at_samples : values of the radicands at a sample
    cells, curves, bounds : of every guard value, slope and bend over a cell; value and two derivatives; value and the
        bound of its rounding error
    rotors : link, or key of a hinge -> cosine and sine of its angle
    counted : what gears and wheels depend on -> its angle without turns
    hinges : key of a hinge -> its angle [rad] in the initial position
    laws_are_bounded : whether bends of the drives over cells are bounds: of laws of time they are looked at in three
        places of a cell
    missing : why masses and loads are not reduced; empty where they are, or where there are none
    """

    rows: tuple[Row, ...]
    quantities: tuple[TracedQuantity, ...]
    angles: Mapping[str, int]
    residual: Node
    guards: tuple[tuple[str, int], ...]
    at_samples: Mapping[int, Node]
    cells: Mapping[tuple[str, int], tuple[Node, Node, Node]]
    curves: Mapping[tuple[str, int], tuple[Node, Node, Node]]
    bounds: Mapping[tuple[str, int], tuple[Node, Node]]
    rotors: Mapping[str, tuple[Node, Node]]
    counted: Mapping[str, Node]
    hinges: Mapping[str, float]
    solved: Solved
    laws_are_bounded: bool
    missing: str


def trace_page(ready: Ready, span: SampleGrid, varied: Varied, paths: Sequence[str]) -> PageTrace:
    """The plan of a mechanism as a page computes it; numbers at the paths vary, masses among them.

    Raises NotComputedYet for what has no closed form.
    """
    refuse_higher_class(ready)
    refuse_laws(ready)
    known = ready.kinematics
    # phases of gears belong to the initial position of the description, as in batches
    kinematics = with_phases(replace(known, numbers=varied.numbers), known.numbers.gearing.phase)
    policy = _TracingPolicy(NODE_JETS, at_samples=True)
    at = kinematics.positions(NODE_JETS, Jet.variable(variable(PARAMETER), ORDERS - 1), policy)
    layout = layout_of(kinematics)
    columns = columns_of(layout.numbers(NODE_JETS, kinematics.numbers, at))
    angles, turning = angles_of(
        layout, at, columns, ready.assembled.angles, lambda link, _cosine, _sine: variable(turns_of(link))
    )
    solved = motion_of_parts(MotionParts(ready, kinematics, layout, columns, angles), span, varied)
    reduced, missing = _reductions(solved, paths)
    hinges = _hinges(solved)
    rows, quantities = _rows(solved, turning, reduced, hinges)
    rotors = turning | {hinge_key(hinge): hinge.rotor for hinge in hinges}
    guards = _guards(policy)
    return PageTrace(
        rows,
        quantities,
        _angle_rows(solved, quantities, turning, hinges),
        as_node(np.asarray(solved.residual, dtype=object).ravel()[0]),
        guards,
        {group: as_node(_value(x)) for group, x in policy.radicands.items()},
        _cells(kinematics, guards),
        _curves(kinematics, guards),
        _bounds(kinematics, guards),
        {link: (as_node(cosine), as_node(sine)) for link, (cosine, sine) in rotors.items()},
        {key: as_node(x) for key, x in policy.counted.items()},
        {hinge_key(hinge): hinge.start for hinge in hinges},
        solved,
        not kinematics.path.by_time or _laws_are_linear(kinematics.path),
        missing,
    )


# The motion at a sample, row by row.

COEFFICIENTS = ("velocity_coefficient", "acceleration_coefficient")
FRAME_OF = "point"
CONTACT = "contact"
ANGLES = ("angle", "joint_angle")
BALANCING = "balancing"


@dataclass(frozen=True)
class TracedHinge:
    """A moving hinge on the sphere: cosine and sine of its angle, and two derivatives by the path's parameter."""

    label: str
    rotor: tuple[Operand, Operand]
    rates: tuple[Operand, Operand]
    start: float


def hinge_key(hinge: TracedHinge) -> str:
    """Name under which the turns of its angle are counted: no link has a blank in front of its name."""
    return f"hinge {hinge.label}"


def _hinges(solved: Solved) -> list[TracedHinge]:
    """The moving hinges of a linkage on the sphere; none in the plane."""
    if solved.spins is None:
        return []
    ready, found = solved.ready, []
    names = (*ready.structure.dimensions.frame, *solved.layout.points)
    places = {name: solved.all_points[0, 0, 0, k] for k, name in enumerate(names)}
    at, start = Positions(places, {}, {}), ready.assembled.positions
    for hinge in moving_hinges(ready.mechanism):
        first, second = (solved.layout.links.index(link) for link in hinge.links)
        axis = places[hinge.point]
        one, two = (
            functools.reduce(operator.add, [a * (x - y) for a, x, y in zip(axis, later, former, strict=True)])
            for later, former in ((spin[0, 0, second], spin[0, 0, first]) for spin in solved.spins)
        )
        cosine, sine = rotor_of_hinge(hinge, ready.kinematics.numbers, start)
        rotor = rotor_of_hinge(hinge, ready.kinematics.numbers, at)
        found.append(TracedHinge(hinge.label, rotor, (one, two), math.atan2(float(sine), float(cosine))))
    return found


def _reductions(solved: Solved, paths: Sequence[str]) -> tuple[dict[str, Any], str]:
    """Masses and loads reduced to the drive: name -> (1, 1) nodes, or none and why."""
    mechanism = solved.ready.mechanism
    values = {path: box_array([variable(path)]) for path in paths}
    try:
        if not mechanism.loads and not masses_of(mechanism):
            return {}, ""
        if solved.ready.kinematics.path.by_time:
            why = _(
                "with several drives they are an inertia matrix and a generalised force of each drive, "
                "which centrode reduce computes"
            )
            return {}, why
        check_reducible(solved)
        found = {name: reduced_number(name, solved, values) for name in REDUCED}
        return found | {BALANCING: balancing_number(solved, values)}, ""
    except Untraceable as untraceable:
        return {}, _(untraceable.reason)
    except InputError as failure:
        return {}, str(failure)


def _rows(
    solved: Solved, turning: Mapping[str, Any], reduced: Mapping[str, Any], hinges: Sequence[TracedHinge]
) -> tuple[tuple[Row, ...], tuple[TracedQuantity, ...]]:
    """Rows of all quantities, equal ones once, and where each quantity finds its own."""
    places: dict[tuple[Node, bool, bool], int] = {}
    quantities: list[TracedQuantity] = []
    frame = solved.all_points.shape[3] - solved.points.shape[3]
    # angles stand without turns in their rows: less than nothing is added, so that their bits stay
    unturned = {turns_of(link): -0.0 for link in turning}

    def add(name: str, dimensions: tuple[str, ...], values: Any, derivative: bool) -> None:
        whole: Nodes = np.asarray(values, dtype=object)
        nodes = whole.reshape(whole.shape[2:])
        rows = np.empty(nodes.shape, dtype=np.intp)
        for place in np.ndindex(nodes.shape):
            operand: Any = nodes[place]
            # loads may depend on turns; the angles themselves get theirs afterwards
            node = as_node(operand)
            if name in ANGLES:
                node = Graph({"": node}).substitute(unturned).outputs[""]
            of_frame = dimensions[:1] == (FRAME_OF,) and place[0] < frame
            rows[place] = places.setdefault((node, derivative, of_frame), len(places))
        quantities.append(TracedQuantity(name, dimensions, rows))

    for kind in kinds_of(solved):
        for order, name in enumerate(kind.names):
            values = by_time(kind.orders, order, solved.span)
            if values is not None:
                add(name, kind.dimensions, values, order > 0)
        if not solved.ready.kinematics.path.by_time:
            for order, word in enumerate(COEFFICIENTS, 1):
                add(f"{kind.prefix}{word}", kind.dimensions, kind.orders[order], True)
    if solved.ready.mechanism.rolling:
        add(CONTACT, ("rolling", "axis"), solved.contacts, False)
    if hinges:
        angles = [m.atan2(sine, cosine) for cosine, sine in (hinge.rotor for hinge in hinges)]
        orders = [angles, *([hinge.rates[k] for hinge in hinges] for k in (0, 1))]
        one, two, three = (box_array(row).reshape(1, 1, -1) for row in orders)
        for order, name in enumerate(HINGE_ANGLES):
            add(name, ("hinge",), by_time((one, two, three), order, solved.span), order > 0)
    for name, values in reduced.items():
        add(name, (), values, True)
    return tuple(Row(*key) for key in places), tuple(quantities)


def _angle_rows(
    solved: Solved,
    quantities: tuple[TracedQuantity, ...],
    turning: Mapping[str, Any],
    hinges: Sequence[TracedHinge],
) -> dict[str, int]:
    """Link, or key of a hinge -> row of its angle, of those whose turns are counted along the path."""
    name = ANGLES[0 if solved.spins is None else 1]
    rows = next(quantity.rows for quantity in quantities if quantity.name == name)
    found = {link: int(rows[k]) for k, link in enumerate(solved.layout.angles) if link in turning}
    at_hinges = [quantity.rows for quantity in quantities if quantity.name == HINGE_ANGLES[0]]
    return found | {hinge_key(hinge): int(at_hinges[0][k]) for k, hinge in enumerate(hinges)}


# What tells where events are: radicands and divisors of the groups, at single places and over cells.


def _value(number: Number) -> Operand:
    operand: Operand = number.coefficients[0] if isinstance(number, Jet) else number
    return operand


def _guards(policy: _TracingPolicy) -> tuple[tuple[str, int], ...]:
    """Radicands and divisors that move, group by group."""
    found = [(RADICAND, group) for group in policy.radicands]
    found += [(DIVISOR, group) for group, x in policy.divisors.items() if isinstance(x, Jet)]
    return tuple(sorted(found, key=lambda guard: (guard[1], guard[0] == DIVISOR)))


def _of_guards(policy: _TracingPolicy, guards: tuple[tuple[str, int], ...]) -> dict[tuple[str, int], Number]:
    known = {RADICAND: policy.radicands, DIVISOR: policy.divisors}
    return {(kind, group): known[kind][group] for kind, group in guards}


def _cells(
    kinematics: Kinematics, guards: tuple[tuple[str, int], ...]
) -> dict[tuple[str, int], tuple[Node, Node, Node]]:
    """Value and slope of each guard in the middle of a cell, and what bounds its second derivative there."""
    cells = Cells(variable(HALF), EXPRESSIONS, holds=is_long_row(kinematics.structure))
    policy = _TracingPolicy(NODE_BENDS)
    at = Positions.of_frame(kinematics.numbers, _drive_bends(kinematics.path, cells), NODE_BENDS)
    kinematics.advance(at, range(len(kinematics.structure.groups)), NODE_BENDS, policy)
    found: dict[tuple[str, int], tuple[Node, Node, Node]] = {}
    for guard, number in _of_guards(policy, guards).items():
        bent = number if isinstance(number, Bent) else Bent(_value(number), 0.0, 0.0, cells)
        found[guard] = (as_node(bent.coefficients[0]), as_node(bent.coefficients[1]), as_node(bent.bend))
    return found


def _drive_bends(path: Path, cells: Cells) -> dict[str, Number]:
    """Values of the drives over a cell, as `events.bent_drives` has them of arrays."""
    place = variable(PARAMETER)
    if not path.by_time:
        return path.drive_values(NODE_BENDS, NODE_BENDS.variable(place, cells))
    # laws are any formulas: their second derivative is looked at in the middle and at the ends of each cell
    looks = [
        path.drive_values(NODE_JETS, Jet.variable(place + shift * cells.half, 2))
        for shift in (0.0, -1.0, 1.0)
    ]
    values: dict[str, Number] = {}
    for drive, here in looks[0].items():
        if not isinstance(here, Jet):
            values[drive] = here
            continue
        sizes = [m.abs(look[drive].derivative(2)) for look in looks]
        still = all(isinstance(size, float) and size == 0.0 for size in sizes)
        bend = 0.0 if still else ROOM * m.max(m.max(sizes[0], sizes[1]), sizes[2])
        values[drive] = Bent(here.coefficients[0], here.coefficients[1], bend, cells)
    return values


def _laws_are_linear(path: Path) -> bool:
    """Whether no drive accelerates: then nothing has to be looked at in a cell, however wide it is."""
    laws = path.drive_values(NODE_JETS, Jet.variable(variable(PARAMETER), 2)).values()
    seconds = [law.derivative(2) for law in laws if isinstance(law, Jet)]
    return all(isinstance(second, float) and second == 0.0 for second in seconds)


def _curves(
    kinematics: Kinematics, guards: tuple[tuple[str, int], ...]
) -> dict[tuple[str, int], tuple[Node, Node, Node]]:
    """Value and two derivatives of each guard at a place."""
    policy = _TracingPolicy(NODE_JETS)
    kinematics.positions(NODE_JETS, Jet.variable(variable(PARAMETER), 2), policy)
    return {guard: _derivatives(number) for guard, number in _of_guards(policy, guards).items()}


def _derivatives(number: Number) -> tuple[Node, Node, Node]:
    if not isinstance(number, Jet):
        return as_node(number), as_node(0.0), as_node(0.0)
    return tuple(as_node(number.derivative(order)) for order in range(3))  # type: ignore[return-value]


def _bounds(
    kinematics: Kinematics, guards: tuple[tuple[str, int], ...]
) -> dict[tuple[str, int], tuple[Node, Node]]:
    """Value of each guard at a place with the bound of its rounding error."""
    bounded = NODE_ROUNDED if is_long_row(kinematics.structure) else NODE_BOXES
    policy = _TracingPolicy(bounded)
    kinematics.positions(bounded, Rounded.of(variable(PARAMETER)), policy)
    rounded = {guard: Rounded.of(number) for guard, number in _of_guards(policy, guards).items()}
    return {guard: (as_node(x.value), as_node(x.bound)) for guard, x in rounded.items()}
