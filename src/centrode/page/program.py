"""The program of a page: a mechanism printed as JavaScript, with what has to be known of it as plain data."""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, TypeAlias

import numpy as np

from centrode.dynamics.kinetostatics.reaction_expressions import LARGEST_GAIN
from centrode.dynamics.kinetostatics.reactions import GEAR_BODIES
from centrode.errors import STATUSES_OF_MOTION, InputError, NotComputedYet
from centrode.kinematics.hinge_angles import moving_hinges
from centrode.kinematics.machine_code.frame_kernels import FreeNumbers
from centrode.kinematics.machine_code.variables import (
    PARAMETER,
    RATE,
    SCALE,
    SECOND_RATE,
    TIME,
    Varied,
    times_of,
    varied_of,
)
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import OFF_GRID, Path, SampleGrid
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.samples import CLOSED
from centrode.kinematics.solve import grid_of
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import kind_at, value_at
from centrode.model.mechanism import Mechanism
from centrode.model.units import KINDS, read_quantity
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph, Unwritten
from centrode.numerics.javascript import HELPERS, PlaceFunction, once
from centrode.page.plan_trace import HALF, PageTrace, near_of, sign_of, trace_page, turns_of
from centrode.page.reaction_trace import TracedReactions, trace_reactions
from centrode.quantities import QUANTITIES
from centrode.structure.dimensions import dimensions_of

Range: TypeAlias = Sequence[float | str]
Vary: TypeAlias = Mapping[str, Range]

WIDER = 2.0
"""Share of a length within which it may be changed where no range is given: from a half to twice."""


@dataclass(frozen=True)
class PageParameter:
    """A number that the page changes.

    Attributes
    ----------
    path : as in `vary` of a motion
    kind : of quantity: "length", "angle" ...
    unit : of value, least, most [SI]
    positive : whether no description can have it zero or less
    """

    path: str
    kind: str
    unit: str
    value: float
    least: float
    most: float
    positive: bool

    @property
    def data(self) -> dict[str, Any]:
        """The same as plain data."""
        return dict(vars(self))


@dataclass(frozen=True)
class PageProgram:
    """A mechanism as a page computes it.

    Attributes
    ----------
    mechanism : its description
    parameters : the numbers that change
    data : what `createMechanism` takes: names, numbers, places; plain, to be written as JSON
    javascript : one classic script that defines `createMechanism`
    """

    mechanism: Mechanism
    parameters: tuple[PageParameter, ...]
    data: Mapping[str, Any]
    javascript: str


def page_program(
    mechanism: MechanismSource, vary: Vary | None = None, samples: int | None = None
) -> PageProgram:
    """A mechanism printed as JavaScript, with everything that a page has to know of it.

    Parameters
    ----------
    mechanism : Mechanism, file or name of an example
    vary : path -> (from, to), numbers [SI] or texts with a unit
        The numbers that the page changes; without it all lengths, and the coordinates of all fixed points.
    samples : number of samples; the description's own, else 361

    Returns
    -------
    PageProgram
        Signs of the initial position stay those of the description, as in `motion` with `vary`.

    Raises
    ------
    NotComputedYet
        A group that has no closed form, an operation that JavaScript has no words for, a path that acts on the motion
        in a way that is not known: each by its name.
    InputError
        A path that names no dimension, a range that is none, a description that defines no motion.
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    span = grid_of(prepared, samples, None, None, None)
    parameters = _parameters(mechanism, prepared, vary)
    paths = [parameter.path for parameter in parameters]
    own = {parameter.path: np.array([parameter.value]) for parameter in parameters}
    varied = varied_of(dimensions_of(mechanism, own, ARRAYS), own)
    free = FreeNumbers.of(paths, varied)
    if free is None:
        what = _("numbers that follow from {paths} cannot be printed").format(paths=", ".join(paths))
        raise NotComputedYet("page", what, _("vary other numbers"))
    traced = trace_page(prepared, span, varied, paths)
    acting = trace_reactions(traced.solved, paths, traced.quantities)
    try:
        functions = _functions(traced, acting, free, varied, len(span.parameter))
    except Unwritten as unwritten:
        what = _("the operation {operation} has no words in JavaScript").format(operation=unwritten.operation)
        raise NotComputedYet("page", what) from None
    javascript = _engine().replace(PRINTED, f"{HELPERS}const printed = {{\n{functions}\n}};")
    return PageProgram(
        mechanism,
        parameters,
        _data(mechanism, prepared, span, parameters, varied, traced, acting),
        javascript,
    )


PRINTED = '"printed";'
"""Where the functions of a mechanism stand in the engine."""


@cache
def _engine() -> str:
    """The engine without its indents and comments: a page is sent by mail."""
    script = files("centrode.page").joinpath("engine.js").read_text(encoding="utf-8")
    bare = re.sub(r"^\s*/\*.*?\*/\n", "", script, flags=re.DOTALL | re.MULTILINE)
    return "".join(f"{line.strip()}\n" for line in bare.splitlines() if line.strip())


# The numbers that a page changes.


def _parameters(mechanism: Mechanism, ready: Ready, vary: Vary | None) -> tuple[PageParameter, ...]:
    if vary is None:
        return tuple(_own_range(mechanism, ready, path) for path in lengths_and_places(mechanism))
    return tuple(_given_range(mechanism, path, ends) for path, ends in vary.items())


def lengths_and_places(mechanism: Mechanism) -> list[str]:
    """Paths of all lengths, and of the coordinates of all points that never move."""
    lengths = [f"links.{name}.length" for name, link in mechanism.links.items() if link.length is not None]
    axes = ("longitude", "latitude") if mechanism.space == "sphere" else ("x", "y")
    return lengths + [f"frame.points.{name}.{axis}" for name in mechanism.frame.points for axis in axes]


def _own_range(mechanism: Mechanism, ready: Ready, path: str) -> PageParameter:
    """A number with a range of its own: lengths to a half and to twice, places within half the greatest length."""
    plain = _parameter(mechanism, path, 0.0, 0.0)
    if plain.positive:
        least, most = plain.value / WIDER, plain.value * WIDER
    else:
        around = 0.5 * float(ready.kinematics.numbers.scale)
        least, most = plain.value - around, plain.value + around
    return _parameter(mechanism, path, least, most)


def _given_range(mechanism: Mechanism, path: str, ends: Range) -> PageParameter:
    kind = kind_at(mechanism, path)
    bare = mechanism.display.refuses_bare_angles
    if isinstance(ends, str) or len(ends) != 2:
        raise InputError(path, _("a range has two ends"), _("give it as (from, to)"))
    least, most = (
        float(read_quantity(end, kind, path, refuses_bare=bare)) if isinstance(end, str) else float(end)
        for end in ends
    )
    if not (math.isfinite(least) and math.isfinite(most) and least < most):
        raise InputError(path, _("a range ends above its beginning"), _("give the lesser end first"))
    parameter = _parameter(mechanism, path, least, most)
    if parameter.positive and not least > 0.0:
        raise InputError(path, _("length must be positive, got {value:g}").format(value=least))
    return parameter


def _parameter(mechanism: Mechanism, path: str, least: float, most: float) -> PageParameter:
    kind, own = kind_at(mechanism, path), float(value_at(mechanism, path))
    unit = KINDS[kind].unit if kind in KINDS else "1"
    # a path that is no dimension is refused as such
    dimensions_of(mechanism, {path: np.array([own])}, ARRAYS)
    return PageParameter(path, kind, unit, own, least, most, is_positive(mechanism, path))


def is_positive(mechanism: Mechanism, path: str) -> bool:
    """Whether no description can have less than zero there."""
    try:
        dimensions_of(mechanism, {path: np.array([-1.0])}, ARRAYS)
    except InputError:
        return True
    return False


# The functions of a page.

PLACE = (PARAMETER, TIME, RATE, SECOND_RATE, HALF)
"""Variables of a place that stay when numbers of the mechanism change."""


PLACES_AROUND = 20
"""Places at which the engine computes a motion beside a change point: its `AROUND`."""


def _functions(
    traced: PageTrace, acting: TracedReactions, free: FreeNumbers, varied: Varied, samples: int
) -> str:
    """All functions of a page as members of an object."""
    of_mechanism = {name: k for k, name in enumerate(mechanism_variables(varied, free.paths))}
    moving = [sign_of(group) for group in traced.at_samples]
    moving += [near_of(key) for key in traced.counted] + [turns_of(link) for link in traced.rotors]
    fixed = PLACE

    def function(
        name: str, outputs: Sequence[Node], stages: Sequence[int] = (), stride: int | None = None
    ) -> str:
        return PlaceFunction(
            name, of_mechanism, fixed, tuple(moving), tuple(outputs), tuple(stages), stride
        ).source

    def of_guards(name: str, numbers: Sequence[Sequence[Node]]) -> str:
        # what looks at one guard computes nothing of those behind it
        each = len(numbers[0]) if numbers else 0
        stages = [each * (k + 1) for k in range(len(numbers))]
        return function(name, [x for some in numbers for x in some], stages)

    stride = max(samples, PLACES_AROUND)
    motion = [row.node for row in traced.rows] + [traced.residual, *traced.at_samples.values()]
    members = [
        f"numbers: {once(mechanism_numbers(free, varied), {path: k for k, path in enumerate(free.paths)})}",
        function("motion", motion, stride=stride),
        of_guards("cells", list(traced.cells.values())),
        of_guards("curves", list(traced.curves.values())),
        of_guards("bounds", list(traced.bounds.values())),
        function("rotors", [x for two in traced.rotors.values() for x in two]),
        function("counted", list(traced.counted.values())),
    ]
    if acting.rows:
        members.append(function("reactions", acting.rows, stride=stride))
    return ",\n".join(members)


def mechanism_variables(varied: Varied, paths: Sequence[str]) -> list[str]:
    """Variables of a mechanism in the order in which a page keeps them; masses are numbers at paths alone."""
    scale = [] if isinstance(varied.scale, float) else [SCALE]
    return list(dict.fromkeys([*varied.names, *scale, *paths]))


def mechanism_numbers(free: FreeNumbers, varied: Varied) -> list[Node]:
    """The variables of a mechanism from the numbers at the paths."""
    known = {path: variable(path) for path in free.paths}
    for name, (k, word) in free.turned.items():
        known[name] = as_node(getattr(EXPRESSIONS, word)(variable(free.paths[k])))
    if free.scale is not None:
        known[SCALE] = free.scale.substitute(known).outputs[SCALE]
    return [known[name] for name in mechanism_variables(varied, free.paths)]


# What a page knows of a mechanism, as plain data.


def _data(
    mechanism: Mechanism,
    ready: Ready,
    span: SampleGrid,
    parameters: Sequence[PageParameter],
    varied: Varied,
    traced: PageTrace,
    acting: TracedReactions,
) -> dict[str, Any]:
    path, layout = ready.kinematics.path, traced.solved.layout
    frame = list(ready.structure.dimensions.frame)
    started = {name: float(angle) for name, angle in ready.assembled.angles.items()} | dict(traced.hinges)
    return {
        "digest": _digest(mechanism, parameters),
        "title": mechanism.title,
        "space": mechanism.space,
        "axes": list(layout.space.axes),
        "parameters": [parameter.data for parameter in parameters],
        "variables": len(mechanism_variables(varied, [parameter.path for parameter in parameters])),
        "points": [*frame, *layout.points],
        "fixed": len(frame),
        "links": list(layout.links),
        "joints": list(layout.angles),
        "guides": list(layout.guides),
        "rolling": [wheel.id for wheel in mechanism.rolling],
        "link_points": {name: list(link.points) for name, link in mechanism.links.items()},
        "drives": [
            {"id": drive.id, "kind": drive.kind, "unit": unit}
            for drive, unit in zip(mechanism.drives, ready.parameter.units, strict=False)
        ],
        "parameter": _parameter_data(ready),
        "samples": len(span.parameter),
        "statuses": [status.word for status in STATUSES_OF_MOTION],
        "residual_bound": CLOSED,
        "quantities": [_quantity(ready, quantity) for quantity in traced.quantities if quantity.rows.size],
        "rows": [[int(row.derivative), int(row.of_frame)] for row in traced.rows],
        "hinges": [hinge.label for hinge in moving_hinges(mechanism)] if traced.hinges else [],
        "angles": [[name, row, started[name]] for name, row in traced.angles.items()],
        "turns_matter": _turns_matter(traced),
        "reduction_missing": traced.missing,
        "reactions": [_quantity(ready, quantity) for quantity in acting.quantities],
        "reactions_missing": acting.missing,
        "largest_gain": LARGEST_GAIN,
        "sides": [[side.point, side.body] for side in acting.sides],
        "gears": [gear.id for gear in mechanism.gears],
        "gear_bodies": list(GEAR_BODIES),
        "guards": [[kind, group] for kind, group in traced.cells],
        "signs": {str(group): float(sign) for group, sign in ready.assembled.signs.items()},
        "radicands": list(traced.at_samples),
        "counted": [[key, float(ready.assembled.angles.get(key, 0.0))] for key in traced.counted],
        "smooth": mechanism.assembly.continuation == "smooth",
        "impossible": [int(k) for k in np.nonzero(path.impossible(span.parameter))[0]],
        "mesh": _mesh(path, span, traced),
        "places": _places(span),
    }


def _turns_matter(traced: PageTrace) -> bool:
    """Whether residuals or loads depend on the turns of angles, which then have to be known before."""
    outputs = {"": traced.residual, **{str(k): row.node for k, row in enumerate(traced.rows)}}
    return any(name.startswith(turns_of("")) for name in Graph(outputs).variables)


def _digest(mechanism: Mechanism, parameters: Sequence[PageParameter]) -> str:
    """What tells the structure of a mechanism, and what changes of it, from others: numbers do not count."""
    told = {
        "space": mechanism.space,
        "frame": list(mechanism.frame.points),
        "links": {name: list(link.points) for name, link in mechanism.links.items()},
        "guides": [[guide.id, guide.point, guide.on] for guide in mechanism.guides],
        "drives": [[drive.id, drive.kind] for drive in mechanism.drives],
        "gears": [gear.id for gear in mechanism.gears],
        "rolling": [wheel.id for wheel in mechanism.rolling],
        "parameters": [parameter.path for parameter in parameters],
    }
    return hashlib.blake2b(json.dumps(told).encode(), digest_size=8).hexdigest()


def _parameter_data(ready: Ready) -> dict[str, Any]:
    path = ready.kinematics.path
    return {
        "name": "time" if path.by_time else "drive",
        "unit": _parameter_unit(ready),
        "turns": path.turns,
        "initial": float(path.initial),
        "forward": float(path.forward),
        "scale": float(path.unit_at(path.initial)),
    }


def _parameter_unit(ready: Ready) -> str:
    parameter = ready.parameter.in_time() if ready.kinematics.path.by_time else ready.parameter
    return parameter.variable.unit


def _quantity(ready: Ready, quantity: Any) -> dict[str, Any]:
    known = QUANTITIES[quantity.name].for_drive(_parameter_unit(ready))
    if ready.mechanism.space == "sphere":
        known = known.on_sphere()
    return {
        "name": quantity.name,
        "dimensions": list(quantity.dimensions),
        "rows": quantity.rows.tolist(),
        "unit": known.unit,
        "symbol": known.symbol,
        "long_name": known.long_name,
    }


def _mesh(path: Path, span: SampleGrid, traced: PageTrace) -> dict[str, Any]:
    """The nodes on which events are looked for; of one drive by their first one and their distance."""
    nodes = mesh_of(path, span.parameter)
    if path.by_time:
        return {"nodes": nodes.tolist(), "bounded": traced.laws_are_bounded}
    first = round((nodes[0] - path.initial) / path.step - OFF_GRID)
    return {"first": first, "count": len(nodes), "off": OFF_GRID, "step": float(path.step)}


def _places(span: SampleGrid) -> dict[str, list[float] | float]:
    """Variables of the samples by name: one number where it is the same everywhere."""
    rows = {PARAMETER: span.parameter, **times_of(span)}
    return {
        name: float(row[0]) if (row == row[0]).all() and len(row) > 1 else [float(x) for x in row]
        for name, row in rows.items()
    }
