"""One mechanism's motion as a program: its formulas from the graph that a page computes by, its numbers, its names."""

from __future__ import annotations

import keyword
import math
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np

from centrode.dynamics.reduction import REDUCED
from centrode.errors import InputError, NotComputedYet
from centrode.export import motion_rules
from centrode.kinematics.machine_code.frame_kernels import FreeNumbers
from centrode.kinematics.machine_code.variables import (
    NODE_JETS,
    PARAMETER,
    RATE,
    SECOND_RATE,
    TIME,
    Varied,
    varied_of,
)
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import OFF_GRID, SampleGrid
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.samples import CLOSED
from centrode.kinematics.solve import grid_of
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import value_at
from centrode.model.mechanism import Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.jets import Jet
from centrode.numerics.source_languages import HELPER_NAMES, RecordFunction
from centrode.page.plan_trace import (
    HALF,
    RADICAND,
    PageTrace,
    TracedQuantity,
    higher_group,
    near_of,
    sign_of,
    trace_page,
    turns_of,
    untraced_drive,
)
from centrode.page.program import is_positive, lengths_and_places, mechanism_numbers, mechanism_variables
from centrode.quantities import QUANTITIES
from centrode.structure.dimensions import dimensions_of

Size: TypeAlias = int
WIDE = 12.0
"""Nodes of the mesh of events that one wide cell stands for."""
MOST_NODES = 20000
KINDS = (
    "position", "velocity", "acceleration", "angle", "angular_velocity", "angular_acceleration", "joint_angle",
    "joint_velocity", "joint_acceleration", "hinge_angle", "hinge_velocity", "hinge_acceleration", "slide",
    "slide_velocity", "slide_acceleration", "contact",
)  # fmt: skip
"""Quantities that are printed."""


@dataclass(frozen=True)
class CodeResult:
    """A number that the printed program gives: its quantity, what it belongs to, its unit."""

    quantity: str
    of: str
    unit: str

    @property
    def name(self) -> str:
        """As the program calls it: "position B x"."""
        return f"{self.quantity.replace('_', ' ')} {self.of}"


def traced_program(
    source: MechanismSource,
    vary: Sequence[str] | None,
    *,
    name: str | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    option: str = "language",
) -> MotionProgram:
    """The mechanism traced once for all languages. Raises as `motion_code`."""
    mechanism = mechanism_of(source)
    prepared = ready(mechanism)
    _refuse_what_is_not_traced(prepared, option)
    span = grid_of(prepared, None, start, stop, None)
    paths = lengths_and_places(mechanism) if vary is None else list(dict.fromkeys(vary))
    own = {path: np.array([float(value_at(mechanism, path))]) for path in paths}
    varied = varied_of(dimensions_of(mechanism, own, ARRAYS), own)
    free = FreeNumbers.of(paths, varied)
    if free is None:
        what = _("what follows from {paths} is not printed in source files").format(paths=", ".join(paths))
        raise NotComputedYet(option, what, _("vary other numbers"))
    traced = trace_page(prepared, _any_rates(prepared, span), varied, paths)
    given = mechanism.title or ""
    label = name or (source if isinstance(source, str) else "") or given
    return MotionProgram(mechanism, prepared, span, paths, varied, free, traced, program_name(label))


def _refuse_what_is_not_traced(prepared: Ready, option: str) -> None:
    if group := higher_group(prepared):
        what = _("source files are made of closed forms, and the {group} has none").format(group=group)
        raise NotComputedYet(option, what)
    if drive := untraced_drive(prepared):
        what = _("source files with several drives know no law of a cam, and drive {drive} has one")
        raise NotComputedYet(option, what.format(drive=drive), _("drive it by a formula or a table"))


def _any_rates(prepared: Ready, span: SampleGrid) -> SampleGrid:
    """The ends of the span; of one drive with rates that vary, as the caller of the program gives them."""
    if prepared.kinematics.path.by_time:
        return span
    ends = span.parameter[[0, -1]]
    return SampleGrid(np.array([0.0, 1.0]), ends, np.array([1.0, 2.0]), np.array([0.0, 1.0]))


LONGEST_NAME = 40
TAKEN = frozenset(
    word
    for line in (
        "auto break case char class const continue def default delete double else elseif end enum export extends",
        "extern float for function global goto inline int long module new persistent register return short signed",
        "sizeof static struct switch this typedef union unsigned var void volatile while yield main record math",
    )
    for word in line.split()
)
"""Words that a file of one of the languages has a meaning for already."""


def program_name(label: str) -> str:
    """A name that all the languages take.

    >>> program_name("slider-crank.toml"), program_name("42"), program_name("int.c")
    ('slider_crank', 'mechanism', 'int_motion')
    """
    stem = re.sub(r"\.[A-Za-z]{1,6}$", "", re.split(r"[\\/]", label)[-1])
    plain = unicodedata.normalize("NFKD", stem).encode("ascii", "ignore").decode()
    words = re.sub(r"\W+", "_", plain, flags=re.ASCII).strip("_")[:LONGEST_NAME].strip("_")
    if len(words) <= 2 or words[0].isdigit():
        return "mechanism"
    rules = {name for name in vars(motion_rules) if name.islower()}
    taken = keyword.iskeyword(words) or words in TAKEN or words in rules or words in HELPER_NAMES
    return f"{words}_motion" if taken else words


@dataclass(frozen=True)
class MotionProgram:
    """A mechanism as source files compute it: its traced plan, and the numbers that the rules need."""

    mechanism: Mechanism
    ready: Ready
    span: SampleGrid
    paths: Sequence[str]
    varied: Varied
    free: FreeNumbers
    traced: PageTrace
    name: str
    is_dynamic: bool = False

    # What is computed.

    @cached_property
    def quantities(self) -> tuple[TracedQuantity, ...]:
        """Quantities in the order in which they are printed."""
        known = {quantity.name: quantity for quantity in self.traced.quantities if quantity.rows.size}
        return tuple(known[kind] for kind in KINDS if kind in known)

    @cached_property
    def results(self) -> tuple[CodeResult, ...]:
        """What the program gives, in its order."""
        return tuple(
            CodeResult(quantity.name, " ".join(of), self._unit(quantity.name))
            for quantity in self.quantities
            for of in self._labels(quantity)
        )

    @cached_property
    def _rows(self) -> tuple[int, ...]:
        """The traced row of every result."""
        return tuple(int(k) for quantity in self.quantities for k in quantity.rows.ravel())

    def _labels(self, quantity: TracedQuantity) -> Iterator[tuple[str, ...]]:
        layout = self.traced.solved.layout
        frame = list(self.ready.structure.dimensions.frame)
        known: Mapping[str, Sequence[str]] = {
            "point": [*frame, *layout.points],
            "axis": list(layout.space.axes),
            "link": list(layout.links),
            "joint": list(layout.angles),
            "guide": list(layout.guides),
            "rolling": [wheel.id for wheel in self.mechanism.rolling],
            "hinge": [key.removeprefix("hinge ") for key in self.traced.hinges],
        }
        for place in np.ndindex(quantity.rows.shape):
            yield tuple(known[kind][k] for kind, k in zip(quantity.dimensions, place, strict=True))

    def _unit(self, quantity: str) -> str:
        known = QUANTITIES[quantity].for_drive(self.drive_unit)
        return (known.on_sphere() if self.mechanism.space == "sphere" else known).unit

    @property
    def drive_unit(self) -> str:
        """SI unit of the drive, s of several drives."""
        parameter = self.ready.parameter
        return (parameter.in_time() if self.by_time else parameter).variable.unit

    @property
    def by_time(self) -> bool:
        """Whether the motion is a function of time, as several drives have laws."""
        return self.ready.kinematics.path.by_time

    # Formulas.

    @cached_property
    def variables(self) -> dict[str, tuple[str, int | None]]:
        """Every variable of the plan, where the record has it."""
        found: dict[str, tuple[str, int | None]] = {
            PARAMETER: ("place", None), HALF: ("half", None), RATE: ("rate", None), SECOND_RATE: ("second", None),
            TIME: ("time", None),
        }  # fmt: skip
        found |= {name: ("number", k) for k, name in enumerate(self._numbers)}
        for k, (kind, group) in enumerate(self.traced.guards):
            if kind == RADICAND or sign_of(group) not in found:
                found[sign_of(group)] = ("sign", k)
        found |= {near_of(key): ("near", k) for k, key in enumerate(self.traced.counted)}
        turning = {turns_of(link): ("turns", k) for k, link in enumerate(self.traced.angles)}
        return found | turning

    @cached_property
    def _numbers(self) -> list[str]:
        return mechanism_variables(self.varied, self.paths)

    @cached_property
    def _length(self) -> Node:
        """The least length of a cylinder, by which the mechanism is open where it is not positive; else 1."""
        path = self.ready.kinematics.path
        driven = [each.drive.id for each in path.driven if each.drive.kind == "distance"]
        if not driven:
            return as_node(1.0)
        values = path.drive_values(NODE_JETS, Jet.variable(variable(PARAMETER), 2))
        lengths = [
            x.coefficients[0] if isinstance(x, Jet) else x for x in (values[drive] for drive in driven)
        ]
        least = lengths[0]
        for other in lengths[1:]:
            least = EXPRESSIONS.min(least, other)
        return as_node(least)

    @cached_property
    def functions(self) -> tuple[RecordFunction, ...]:
        """The formulas of the record."""
        traced, variables = self.traced, self.variables
        given = {path: ("given", k) for k, path in enumerate(self.paths)}
        rows = [traced.rows[k].node for k in self._rows]
        motion = [*rows, traced.residual, self._length, *traced.at_samples.values()]

        def stage_function(name: str, array: str, numbers: Sequence[Sequence[Node]]) -> RecordFunction:
            each = len(numbers[0]) if numbers else 1
            return RecordFunction(name, array, variables, [x for some in numbers for x in some], each)

        return (
            RecordFunction("evaluate_numbers", "number", given, mechanism_numbers(self.free, self.varied)),
            RecordFunction("evaluate_motion", "row", variables, motion),
            stage_function("evaluate_cells", "cell", [traced.cells[guard] for guard in traced.guards]),
            stage_function("evaluate_curves", "curve", [traced.curves[guard] for guard in traced.guards]),
            stage_function("evaluate_bounds", "bound", [traced.bounds[guard] for guard in traced.guards]),
            RecordFunction(
                "evaluate_rotors",
                "rotor",
                variables,
                [x for link in traced.angles for x in traced.rotors[link]],
            ),
            RecordFunction("evaluate_counted", "angle", variables, list(traced.counted.values())),
            *(
                [RecordFunction("evaluate_reduced", "reduced", variables, self._reduced_quantities)]
                if self.is_dynamic
                else []
            ),
        )

    @property
    def _reduced_quantities(self) -> list[Node]:
        """Reduced moment of inertia, its slope, and the reduced moment of the loads."""
        known = {quantity.name: quantity for quantity in self.traced.quantities}
        return [self.traced.rows[int(known[name].rows)].node for name in REDUCED]

    # Numbers of the rules.

    @cached_property
    def numbers(self) -> dict[str, int | float]:
        """Numbers that are the same for every record, by their names in the rules."""
        path, traced = self.ready.kinematics.path, self.traced
        mesh = mesh_of(path, self.span.parameter)
        step = float(np.min(np.diff(mesh))) if path.by_time else float(path.step)
        first = float(mesh[0])
        if not path.by_time:
            first = (
                path.initial + (round((first - path.initial) / path.step - OFF_GRID) + OFF_GRID) * path.step
            )
        nodes = math.ceil((float(mesh[-1]) - first) / step) + 1
        if nodes > MOST_NODES:
            what = _("the range is more than {count} cells long").format(count=MOST_NODES)
            raise InputError("--to", what, _("print a shorter one"))
        low, high = first, first + (nodes - 1) * step
        matters, smooth = self._turns_matter, self.mechanism.assembly.continuation == "smooth"
        return {
            "guards": len(traced.guards), "counted": len(traced.counted), "angles": len(traced.angles),
            "dimensions": len(self.paths), "nodes": nodes, "rows": len(self._rows), "smooth": int(smooth),
            "turns_matter": int(matters), "start_node": min(nodes - 1, max(0, round((path.initial - first) / step))),
            "wide_cells": max(1, math.ceil((high - low) / (WIDE * step))),
            "initial": float(path.initial), "forward": float(path.forward), "unit": float(path.unit_at(path.initial)),
            "node_first": first, "node_step": step, "low": low, "high": high, "closed": CLOSED,
        }  # fmt: skip

    @property
    def _turns_matter(self) -> bool:
        names = {turns_of(link) for link in self.traced.angles}
        motion = next(each for each in self.functions if each.name == "evaluate_motion")
        return any(
            name in names for name in Graph({str(k): x for k, x in enumerate(motion.outputs)}).variables
        )

    @cached_property
    def tables(self) -> dict[str, list[float]]:
        """Arrays of the record that are the same for all."""
        traced, rows = self.traced, self._rows
        radicands = {group: len(rows) + 2 + k for k, group in enumerate(traced.at_samples)}
        starts = {name: float(angle) for name, angle in self.ready.assembled.angles.items()} | dict(
            traced.hinges
        )
        return {
            "is_length": [float(is_positive(self.mechanism, path)) for path in self.paths],
            "is_radicand": [float(kind == RADICAND) for kind, _group in traced.guards],
            "start_sign": [float(self.ready.assembled.signs.get(group, 0)) for _kind, group in traced.guards],
            "radicand_row": [float(radicands.get(group, 0)) for _kind, group in traced.guards],
            "counted_start": [float(self.ready.assembled.angles.get(key, 0.0)) for key in traced.counted],
            "angle_row": [float(rows.index(row)) for row in traced.angles.values()],
            "angle_start": [starts[key] for key in traced.angles],
            "is_derivative": [float(traced.rows[k].derivative) for k in rows],
            "of_frame": [float(traced.rows[k].of_frame) for k in rows],
        }

    @cached_property
    def sizes(self) -> dict[str, Size]:
        """Arrays of the record that are written, and how long they are."""
        n, rows = self.numbers, len(self._rows)
        guards, angles, counted, nodes = (int(n[x]) for x in ("guards", "angles", "counted", "nodes"))
        widest = max(rows + 2, angles, counted)
        kept = {name: motion_rules.EVENTS for name in ("kind", "guard", "place", "behind", "closes")}
        return {
            "given": len(self.paths), "number": len(self._numbers), "sign": guards, "near": counted, "turns": angles,
            "row": rows + 2 + len(self.traced.at_samples), "cell": 3 * guards, "curve": 3 * guards,
            "bound": 2 * guards, "rotor": 2 * angles, "angle": counted, "node_angle": angles * nodes,
            "node_near": counted * nodes, "largest": guards, "stack_at": 200, "stack_half": 200, "first": widest,
            "above": widest, "reduced": 3, **{f"event_{name}": size for name, size in kept.items()},
        }  # fmt: skip

    @property
    def values(self) -> list[float]:
        """The dimensions of the description."""
        return [float(value_at(self.mechanism, path)) for path in self.paths]

    @property
    def speed(self) -> float:
        """The drive's own speed; 1 where it has none, or time is the parameter."""
        speed = None if self.by_time else self.mechanism.drives[0].speed
        return 1.0 if speed is None else float(speed)
