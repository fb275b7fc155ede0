"""A plan as expressions: what a motion without events computes at one place of the path, for any mechanism of a batch.

The plan runs over expression nodes as it runs over arrays. What differs from mechanism to mechanism are variables;
so are the parameter of the path, the time, and the rates of the parameter. Signs are those of the initial position,
which holds for mechanisms without change points alone (`judging` tells which these are), or flip at change points whose
places are variables too.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.errors import Status
from centrode.kinematics.branches import branches_at_start
from centrode.kinematics.compiled.drives import traced_path, winders_of
from centrode.kinematics.compiled.signs import signs_of
from centrode.kinematics.compiled.variables import PARAMETER, Varied, boxed, span_of_variables
from centrode.kinematics.evaluate import Hooks, Kinematics
from centrode.kinematics.layout import Layout, layout_of, positions_from
from centrode.kinematics.phases import with_phases
from centrode.kinematics.ready import Ready
from centrode.kinematics.residuals import UnitLength, each_residual
from centrode.kinematics.sampling import ORDERS
from centrode.kinematics.solve import Solved
from centrode.kinematics.spans import Span
from centrode.kinematics.spins import spins_of
from centrode.locale import mark
from centrode.structure.groups import Newton
from centrode.structure.positions import Positions
from centrode.structure.wheels import Contact, contact_point

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]
Number: TypeAlias = Any

NODE_JETS = JetFunctions(EXPRESSIONS)
TURN = 2.0 * np.pi
WHOLE = 1.5 * 2.0**52
"""Added and taken away again it leaves the nearest whole number: the bits behind the point do not fit."""


class Untraceable(Exception):
    """The plan does something that expressions cannot say; `reason` is told to the user."""

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(reason)


@dataclass(frozen=True)
class Traced:
    """A motion at one place of the path.

    Attributes
    ----------
    solved : arrays of nodes and floats, of one lane and one sample
    radicands, divisors : group -> jet of first order, or what does not move with the drive: events are their zeros
    turning : link -> cosine and sine of its angle where its turns have to be found
    winders : drive -> its value, with which links may turn
    turns : link -> the turns that stand in its angle: a whole number
    """

    solved: Solved
    radicands: Mapping[int, Number]
    divisors: Mapping[int, Number]
    turning: Mapping[str, tuple[Operand, Operand]]
    winders: Mapping[str, Operand]

    @property
    def turns(self) -> dict[str, Node]:
        return {link: as_node(turns_of(link, *rotor, self.winders)) for link, rotor in self.turning.items()}


class _Signs(Hooks):
    """Signs as they are given; radicands and divisors are kept.

    At samples a root that does not move has derivatives that are zero, on the mesh none, as with arrays: quotients by
    what depends on it are rounded otherwise.
    """

    def __init__(self, signs: Mapping[int, Operand], on_mesh: bool) -> None:
        self.signs = signs
        self.on_mesh = on_mesh
        self.radicands: dict[int, Number] = {}
        self.divisors: dict[int, Number] = {}

    def root(self, group: int, radicand: Number) -> Number:
        self.radicands[group] = radicand
        if not isinstance(radicand, Jet) and not self.on_mesh:
            radicand = Jet((radicand, *[0.0] * (ORDERS - 1)))
        return NODE_JETS.sqrt(radicand) * self.signs[group]

    def divisor(self, group: int, divisor: Number) -> Number:
        self.divisors[group] = divisor
        return divisor

    def continued(self, group: int, key: str, angle: Number) -> Number:
        raise Untraceable(mark("gears or wheels whose turns are counted"))

    def higher(self, group: int, m: Any, at: Positions) -> None:
        raise Untraceable(mark("groups of higher class"))


def refuse_untraceable(ready: Ready, span: Span) -> None:
    """Raise Untraceable for what is known before the plan is run."""
    kinematics = ready.kinematics
    if any(isinstance(group, Newton) for group in ready.structure.groups):
        raise Untraceable(mark("groups of higher class"))
    if np.any(kinematics.path.impossible(span.parameter)):
        raise Untraceable(mark("a cylinder shorter than zero"))
    curves = [kinematics.numbers.curve(guide.id) for guide in ready.mechanism.guides]
    if any(kinematics.numbers.space.period(np, curve) is not None for curve in curves):
        raise Untraceable(mark("guides that close"))


def traced(
    ready: Ready,
    span: Span,
    varied: Varied,
    crossings: Mapping[int, int] | None = None,
    on_mesh: bool = False,
) -> Traced:
    """The motion of a mechanism of a batch at one place of the path, a sample or a node of the mesh.

    `crossings` says of how many change points of a group the sign is to know (see `signs`). Raises Untraceable.
    """
    refuse_untraceable(ready, span)
    known = ready.kinematics
    path = traced_path(known.path, span.parameter, ORDERS - 1)
    kinematics = with_phases(replace(known, numbers=varied.numbers, path=path), known.numbers.gearing.phase)
    hooks = _Signs(signs_of(ready, crossings or {}), on_mesh)
    at = kinematics.positions(NODE_JETS, Jet.variable(variable(PARAMETER), ORDERS - 1), hooks)
    layout = layout_of(kinematics)
    columns = _columns(layout.numbers(NODE_JETS, kinematics.numbers, at))
    winders = winders_of(path)
    angles, turning = _angles(kinematics, layout, at, columns, ready.assembled.angles, winders)
    solved = _solved(_Parts(ready, kinematics, layout, columns, angles), span, varied)
    return Traced(solved, hooks.radicands, hooks.divisors, turning, winders)


@dataclass(frozen=True)
class _Parts:
    ready: Ready
    kinematics: Kinematics
    layout: Layout
    columns: Nodes
    angles: Nodes


def _columns(numbers: Sequence[Number]) -> Nodes:
    """Value, first and second derivative of numbers: (3, numbers)."""
    return np.stack([boxed([_derivative(x, order) for x in numbers]) for order in range(ORDERS)])


def _derivative(x: Number, order: int) -> Operand:
    found: Operand = x.derivative(order) if isinstance(x, Jet) else x if order == 0 else 0.0
    return found


def _angles(
    kinematics: Kinematics,
    layout: Layout,
    at: Positions,
    columns: Nodes,
    start: Mapping[str, float],
    winders: Mapping[str, Operand],
) -> tuple[Nodes, dict[str, tuple[Operand, Operand]]]:
    """Angles with their derivatives as `turning.fill_angles` has them: (3, angles); rotors of those that may turn."""
    found = np.empty((ORDERS, len(layout.angles)), dtype=object)
    turning: dict[str, tuple[Operand, Operand]] = {}
    for k, link in enumerate(layout.angles):
        if layout.runs_on and link in at.angles:
            found[:, k] = [_derivative(at.angles[link], order) for order in range(ORDERS)]
            continue
        cosine, sine = columns[:, layout.rotor(link)].T
        if isinstance(cosine[0], float) and isinstance(sine[0], float):
            found[:, k] = 0.0
            found[0, k] = _standing(cosine[0], sine[0], start[link])
            continue
        turning[link] = cosine[0], sine[0]
        found[0, k] = EXPRESSIONS.atan2(sine[0], cosine[0]) + TURN * turns_of(
            link, cosine[0], sine[0], winders
        )
        for order in (1, 2):
            found[order, k] = cosine[0] * sine[order] - sine[0] * cosine[order]
    return found, turning


def _standing(cosine: float, sine: float, start: float) -> float:
    """The angle of a link that never turns, on the turn of the initial position."""
    angle = float(np.arctan2(sine, cosine))
    return angle + TURN * round((start - angle) / TURN)


def turns_of(link: str, cosine: Operand, sine: Operand, winders: Mapping[str, Operand]) -> Operand:
    """The turns that bring an angle within half a turn of a centre that runs on with a drive."""
    centre: Operand = variable(centre_of(link))
    for drive, value in winders.items():
        centre = centre + variable(winding_of(link, drive)) * value
    return ((centre - EXPRESSIONS.atan2(sine, cosine)) * (1.0 / TURN) + WHOLE) - WHOLE


def centre_of(link: str) -> str:
    """Name of the middle of a link's angles, those of the drive (times its winding) taken off."""
    return f"centre {link}"


def winding_of(link: str, drive: str) -> str:
    """Name of the turns that a link makes for one of a drive: -1, 0 or 1."""
    return f"winding {link} with {drive}"


def _solved(parts: _Parts, span: Span, varied: Varied) -> Solved:
    layout, kinematics = parts.layout, parts.kinematics
    fixed = Positions.of_frame(kinematics.numbers, {}, EXPRESSIONS).points
    frame = np.full((ORDERS, layout.axes * len(fixed)), 0.0, dtype=object)
    frame[0] = boxed([x for place in fixed.values() for x in place])
    parameter = variable(PARAMETER)
    at = positions_from(
        kinematics, layout, parts.columns[0], parts.angles[0], boxed([parameter])[0], EXPRESSIONS
    )
    points = parts.columns[:, : layout.first_attitude]
    worst = _worst(kinematics, at, varied.scale)
    wheels = [c for c in kinematics.structure.constraints if isinstance(c, Contact)]
    contacts = [x for c in wheels for x in contact_point(c, EXPRESSIONS, kinematics.numbers, at)]
    start = parts.ready.assembled
    path = kinematics.path
    return Solved(
        replace(parts.ready, kinematics=kinematics),
        span_of_variables(span),
        layout,
        branches_at_start(path, start.signs, start.angles, smooth=True),
        np.concatenate([frame, points], axis=1).reshape(ORDERS, 1, 1, -1, layout.axes),
        points.reshape(ORDERS, 1, 1, -1, layout.axes),
        parts.angles.reshape(ORDERS, 1, 1, -1),
        parts.columns[:, layout.first_slide : layout.first_rotor].reshape(ORDERS, 1, 1, -1),
        spins_of(layout, parts.columns.reshape(ORDERS, layout.width, 1, 1)),
        np.full((1, 1), Status.OK, dtype=np.int8),
        boxed([worst]).reshape(1, 1),
        UnitLength(""),
        boxed(contacts).reshape(1, 1, -1, 2),
    )


def _worst(kinematics: Kinematics, at: Positions, scale: Operand) -> Operand:
    """The greatest residual. Lengths are divided together: a greater number has no lesser quotient, to the last bit."""
    found: dict[bool, Operand] = {}
    for _kept, size, angular in each_residual(kinematics, EXPRESSIONS, at):
        found[angular] = EXPRESSIONS.max(found[angular], size) if angular in found else size
    if False in found:
        found[False] = found[False] / scale
    least: Operand = 0.0
    return functools.reduce(EXPRESSIONS.max, found.values(), least)
