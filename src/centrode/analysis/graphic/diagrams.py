"""Velocity and acceleration diagrams of a mechanism at an instant, constructed as on a drawing board."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.graphic.construction import construct
from centrode.analysis.graphic.stage import (
    ConstructionStage,
    ConstructionStep,
    DrawingBoard,
    Edge,
    VectorDrawing,
    extent_of,
)
from centrode.errors import InputError, MotionError, Status
from centrode.geometry.plane import pose_with_point
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.path import JETS, SampleGrid, grid_at, place_of
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import requested_grid, solve
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.units import read_quantity
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.numerics.round_scales import round_scale
from centrode.quantities import status_word
from centrode.structure.constraints import FRAME, Positions
from centrode.structure.gearing import Round
from centrode.structure.plan import Structure

# Scales of drawings that a person gives instead of the round ones.

NAMES = ("length", "velocity", "acceleration")
KINDS_OF_SCALES = {"length": "length", "velocity": "speed", "acceleration": "acceleration"}
PAGE = 120.0
"""Longest side of a drawing that goes on a page A5 [mm]."""


def chosen_scale(name: str, extent: float, room: float, scales: Mapping[str, float]) -> float:
    """The scale given for a drawing of an extent [SI], or the round one that fills a room [mm].

    Raises InputError where the scale given is no positive number, or the drawing does not go on a page with it.
    """
    for other in scales:
        if other not in NAMES:
            raise InputError(
                "scales",
                _("{name} is not a scale").format(name=other),
                _("one of: {names}").format(names=", ".join(NAMES)),
            )
    given = scales.get(name)
    if given is None:
        return round_scale(extent, room)
    if not 0.0 < given < math.inf:
        raise InputError(
            f"scales, {name}", _("a scale has to be positive, got {value:g}").format(value=given)
        )
    if extent > PAGE * given:
        raise InputError(
            f"scales, {name}",
            _("the drawing would be {size:.4g} mm long").format(size=extent / given),
            _("use at least {least:g} per millimetre").format(least=round_scale(extent, PAGE)),
        )
    return given


# An instant of a motion as a drawing: positions to measure in, rates of the drives, and both constructions.

Driven: TypeAlias = tuple[dict[str, float], dict[str, float]]


def stages(
    structure: Structure, drawing: VectorDrawing, driven: Driven, grains: tuple[float, float] = (0.0, 0.0)
) -> tuple[ConstructionStage, ConstructionStage]:
    """Velocities and accelerations constructed; lengths of edges are read to the grains [m/s] and [m/s^2]."""
    # the frame's points stand still: they are all at the pole
    velocity = ConstructionStage(drawing, driven[0], grain=grains[0])
    velocity.points |= dict.fromkeys(drawing.numbers.frame, 0j)
    construct(structure, velocity)
    acceleration = ConstructionStage(drawing, driven[1], before=velocity, grain=grains[1])
    acceleration.points |= dict.fromkeys(drawing.numbers.frame, 0j)
    construct(structure, acceleration)
    return velocity, acceleration


def drawing_of(prepared: Ready, exact: xr.Dataset, board: DrawingBoard) -> VectorDrawing:
    """The mechanism as it stands at the only sample of a motion."""
    return VectorDrawing(prepared.kinematics.numbers, positions_at(prepared, exact), board)


def positions_at(prepared: Ready, exact: xr.Dataset) -> Positions:
    """The mechanism as it is drawn: places and poses at the only sample."""
    numbers = prepared.kinematics.numbers
    at = Positions.of_frame(numbers, {}, ARRAYS)
    for name in exact["point"].values.tolist():
        x, y = exact["position"].sel(point=name).values[0].tolist()
        at.points[name] = (x, y)
    for name in exact["link"].values.tolist():
        angle = float(exact["angle"].sel(link=name)[0])
        point, local = next(iter(numbers.local[name].items()))
        at.poses[name] = pose_with_point(local, at.points[point], (np.cos(angle), np.sin(angle)))
        at.angles[name] = angle
    return at


def driven_rates(prepared: Ready, span: SampleGrid) -> tuple[dict[str, float], dict[str, float]]:
    """First and second derivatives by time of what every drive gives."""
    path = prepared.kinematics.path
    # one drive at a given speed has the rates of the grid; laws are differentiated by time
    if not path.by_time:
        drive, sense = path.driven[0].drive.id, path.parameter.drives[0].sense
        return {drive: sense * float(span.rate[0])}, {drive: sense * float(span.second_rate[0])}
    first, second = {}, {}
    for driven in path.driven:
        value = driven.value(JETS, Jet.variable(span.time, 2))
        value = value if isinstance(value, Jet) else Jet((value, 0.0, 0.0))
        first[driven.drive.id], second[driven.drive.id] = (
            float(np.broadcast_to(value.derivative(k), (1,))[0]) for k in (1, 2)
        )
    return first, second


# Instant centres as they are drawn: where perpendiculars to the velocities of two points meet.

AT_REST = 1e-9
"""Links that turn slower than this part of the fastest, or move so, count as translating or at rest."""


def instant_centres(velocity: ConstructionStage) -> dict[str, complex | None]:
    """Instant centres of velocity where perpendiculars to the velocities meet; None at infinity."""
    size = max((abs(rate) for rate in velocity.points.values()), default=0.0)
    reach = extent_of([velocity.drawing.point(name) for name in velocity.points])
    centres: dict[str, complex | None] = {}
    for link, base in velocity.bases.items():
        rate, turn = velocity.rate(base), velocity.turns[link]
        # a turn counts by the speed that it gives across the drawing
        if abs(turn) * reach > AT_REST * size:
            centres[link] = velocity.drawing.point(base) + 1j * rate / turn
        # it moves but does not turn: the centre is at infinity; what does neither has none
        elif abs(rate) > AT_REST * size:
            centres[link] = None
    return centres


MECHANISM, DIAGRAM = 90.0, 105.0
"""Room of the mechanism and of a diagram on a page A5 [mm]."""
DIAGRAM_AT_REST = 1e-12
COURSE = 121
"""Samples of the motion in which slots are measured."""


@dataclass(frozen=True)
class Diagram:
    """A velocity or acceleration diagram.

    Attributes
    ----------
    order : 1 of velocities, 2 of accelerations
    images : point -> end of its vector from the pole, a complex number [m/s or m/s^2]; the frame's points at the pole
    hidden : places of links under points that slide on them (a dash behind the point's name)
    edges : relative vectors and the parts of vector equations, as they are drawn
    turns : link -> angular velocity [rad/s] or acceleration [rad/s^2]
    steps : what was done, group by group, with triangles and trials
    scale : what a millimetre stands for [m/s or m/s^2]
    """

    order: int
    images: Mapping[str, complex]
    hidden: Mapping[str, complex]
    edges: tuple[Edge, ...]
    turns: Mapping[str, float]
    steps: tuple[ConstructionStep, ...]
    scale: float

    @property
    def unit(self) -> str:
        """SI unit of its vectors."""
        return "m/s" if self.order == 1 else "m/s^2"


@dataclass(frozen=True)
class Diagrams:
    """Drawings of one instant: both diagrams, instant centres, and the mechanism.

    Attributes
    ----------
    exact, course : the motion at the instant, and all of it, for what is drawn as long as something travels
    scale : metres that a millimetre of the mechanism's drawing stands for
    centres : link -> its instant centre [m]; None at infinity; links at rest are left out
    places : point -> its place [m]
    """

    mechanism: Mechanism
    exact: xr.Dataset
    course: xr.Dataset
    board: DrawingBoard
    velocity: Diagram
    acceleration: Diagram
    centres: Mapping[str, complex | None]
    places: Mapping[str, complex]
    scale: float

    def reach(self, link: str, point: str) -> float:
        """Distance [m] of a point of a link from its instant centre, as speeds tell it."""
        return abs(self.velocity.images[point] / self.velocity.turns[link])


def velocity_diagram(mechanism: Mechanism, at: float, angle_step: float | str | None = None) -> Diagram:
    """The velocity diagram at a value of the drive [rad or m], or a time [s] where the motion is given by time.

    `angle_step` [rad] rounds the directions that are read off the drawing. Raises as `diagrams` does. Without it the
    images agree with the motion's velocities to rounding over the sine between the lines that meet.
    """
    return diagrams(mechanism, at, angle_step).velocity


def acceleration_diagram(mechanism: Mechanism, at: float, angle_step: float | str | None = None) -> Diagram:
    """Acceleration diagram with normal, tangential and Coriolis parts; arguments are those of `velocity_diagram`."""
    return diagrams(mechanism, at, angle_step).acceleration


def diagrams(
    mechanism: Mechanism,
    at: npt.ArrayLike,
    angle_step: float | str | None = None,
    length_step: float | str | None = None,
    scales: Mapping[str, float | str] | None = None,
) -> Diagrams:
    """Both diagrams of an instant, with the instant centres.

    Parameters
    ----------
    at : float [rad or m, or s], or a text with a unit
        A value of the drive, or a time, as in `motion(at=...)`.
    angle_step : float [rad] or text ("1 deg"), optional
        Directions are read to this; exactly if left out.
    length_step : float [m] or text ("0.5 mm"), optional
        Lengths on paper are read to this.
    scales : mapping, optional
        What a millimetre stands for: "length" [m], "velocity" [m/s], "acceleration" [m/s^2], or texts with a unit
        ("50 mm"); round ones that make good use of the page where left out.

    Raises
    ------
    InputError
        The sphere, where diagrams do not apply; a group that needs more than two trials; steps out of range; scales
        with which a drawing does not go on the page.
    MotionError
        The mechanism does not close there, or stands at a limit, a change point or a dead position.
    """
    if mechanism.space != "plane":
        raise InputError(
            "space",
            _("velocity and acceleration diagrams do not apply on the sphere"),
            _("use the velocities of the motion"),
        )
    refuses_bare = mechanism.display.refuses_bare_angles
    board = DrawingBoard(_step(angle_step, "angle", refuses_bare=refuses_bare), _step(length_step, "length"))
    prepared = ready(mechanism)
    at = place_of(prepared.parameter.instant, at)
    span = grid_at(prepared.kinematics.path, np.array([at], dtype=np.float64))
    exact = dataset_of(solve(prepared, span))
    _refuse_where_it_is_not(exact, at)
    numbers = {name: _scale(name, scale) for name, scale in (scales or {}).items()}
    exact_drawing = _construct_diagrams(prepared, exact, span, board, numbers)
    if board.paper_step is None:
        return exact_drawing
    # scales are chosen by the exact drawing, then lengths on paper are read
    # a step on paper [m] in millimetres, times what a millimetre stands for
    coarse = replace(board, length_step=1e3 * board.paper_step * exact_drawing.scale)
    grains = tuple(
        1e3 * board.paper_step * diagram.scale
        for diagram in (exact_drawing.velocity, exact_drawing.acceleration)
    )
    # with the reading step all is drawn again, at the scales already chosen
    again = _construct_diagrams(prepared, exact, span, coarse, {}, (grains[0], grains[1]))
    return replace(
        again,
        scale=exact_drawing.scale,
        velocity=replace(again.velocity, scale=exact_drawing.velocity.scale),
        acceleration=replace(again.acceleration, scale=exact_drawing.acceleration.scale),
    )


def _step(step: float | str | None, kind: str, *, refuses_bare: bool = False) -> float | None:
    """A reading step in SI."""
    return None if step is None else read_quantity(step, kind, f"{kind}_step", refuses_bare=refuses_bare)


def _scale(name: str, scale: Any) -> float:
    """What a millimetre stands for, in SI; the names of scales are looked at with the drawing."""
    kind = KINDS_OF_SCALES.get(name)
    if kind is None or isinstance(scale, Real):
        return cast(float, scale)
    return read_quantity(scale, kind, f"scales, {name}")


def _refuse_where_it_is_not(exact: xr.Dataset, at: float) -> None:
    status = int(exact["status"][0])
    if status not in (Status.OK, Status.CUT_OFF):
        raise MotionError(
            "at",
            _("at {at:.9g} the mechanism is {status}: nothing can be constructed").format(
                at=at, status=status_word(status)
            ),
            _("choose another instant"),
        )


def _construct_diagrams(
    prepared: Ready,
    exact: xr.Dataset,
    span: SampleGrid,
    board: DrawingBoard,
    scales: Mapping[str, float],
    grains: tuple[float, float] = (0.0, 0.0),
) -> Diagrams:
    drawing = drawing_of(prepared, exact, board)
    velocity, acceleration = stages(prepared.structure, drawing, driven_rates(prepared, span), grains)
    places = {name: complex(*at) for name, at in drawing.at.points.items()}
    # a wheel's rim may reach beyond all points
    extent = extent_of([*places.values(), *_rims(prepared.mechanism, drawing)])
    moving, speeding = _size(velocity), _size(acceleration)
    # velocities that are rounding beside what accelerations make in a moment are none
    rests = moving <= DIAGRAM_AT_REST * math.sqrt(speeding * extent)
    return Diagrams(
        prepared.mechanism,
        exact,
        _trajectory(prepared, exact),
        board,
        _diagram(velocity, chosen_scale("velocity", 0.0 if rests else moving, DIAGRAM, scales)),
        _diagram(acceleration, chosen_scale("acceleration", speeding, DIAGRAM, scales)),
        {} if rests else instant_centres(velocity),
        places,
        chosen_scale("length", extent, MECHANISM, scales),
    )


def _trajectory(prepared: Ready, exact: xr.Dataset) -> xr.Dataset:
    """The motion as far as it is requested by default; the instant alone where nothing says how far."""
    try:
        return dataset_of(solve(prepared, requested_grid(prepared, COURSE, None, None)))
    except InputError:
        return exact


def _size(stage: ConstructionStage) -> float:
    """The longer side of a diagram."""
    ends = [end for edge in stage.edges for end in (edge.start, edge.end)]
    # the pole, 0, belongs to the diagram although no edge may begin there
    return extent_of([0j, *stage.points.values(), *stage.hidden.values(), *ends])


def _diagram(stage: ConstructionStage, scale: float) -> Diagram:
    turns = {name: turn for name, turn in stage.turns.items() if name != FRAME}
    edges, steps = tuple(stage.edges), tuple(stage.steps)
    return Diagram(stage.order, stage.points, stage.hidden, edges, turns, steps, scale)


def _rims(mechanism: Mechanism, drawing: VectorDrawing) -> list[complex]:
    """Corners around wheels, and around the circles that they roll on."""
    rims = [(drawing.point(wheel.centre), wheel.radius) for wheel in mechanism.rolling]
    for wheel in mechanism.rolling:
        track = drawing.numbers.gearing.track[wheel.id]
        if isinstance(track, Round):
            rims.append((drawing.inside(wheel.on, track.centre), track.radius))
    return [centre + radius * corner for centre, radius in rims for corner in (1 + 1j, -1 - 1j)]
