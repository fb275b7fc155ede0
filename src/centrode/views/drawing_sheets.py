"""Drawings on sheets: which diagrams of a motion, of a machine and of its forces stand on them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.drawing_sheets import (
    DiagramSheet,
    EnergyMassDiagram,
    EnergySheet,
    ForceSheet,
    MotionSheet,
    ScaledCurve,
    ScaledDiagram,
    VectorSheet,
)
from centrode.sheets.force_pages import GroupPage, LeverPage
from centrode.sheets.pages import PositionsPage, VectorDiagramPage
from centrode.sheets.plots import AxisLabel
from centrode.sheets.texts import NOTHING, Name, Sentence, Symbol, Text
from centrode.views import force_polygons, graphic, position_plan

if TYPE_CHECKING:
    import xarray

    from centrode.analysis.graphic.results import GraphicResults
    from centrode.analysis.position_plan import PositionPlan
    from centrode.dynamics.force_polygons.results import ForcePolygonResults
    from centrode.dynamics.steady_motion.machine import MachineResults
    from centrode.model.mechanism import Mechanism

Array: TypeAlias = NDArray[np.float64]

BESIDE, MOST_PLANS = 2, 8
"""Plans of vectors that find room below the mechanism, those of one instant; and on a sheet of their own."""
MOST_GROUPS = 4
"""Groups with their polygons on one sheet."""
NONE = 1e-9
"""Rates whose product with the time is less than this part of the values are rounding."""
ON_GUIDES = ("slide", "slide_velocity", "slide_acceleration")
OF_LINKS = ("angle", "angular_velocity", "angular_acceleration")
OF_JOINTS = ("joint_angle", "joint_velocity", "joint_acceleration")


def motion_sheets(plan: PositionPlan, drawn: GraphicResults) -> Iterator[MotionSheet | VectorSheet]:
    """Positions and the motion of the output; plans of vectors beside them or, of several instants, on their own."""
    page = position_plan.sheet(plan).pictures["plan"]
    assert isinstance(page, PositionsPage)
    pictures = graphic.sheet(drawn).pictures.values()
    plans = tuple(one for one in pictures if isinstance(one, VectorDiagramPage))
    diagrams = tuple(output_diagrams(plan))
    if 0 < len(plans) <= BESIDE:
        name = Sentence("Plan of positions, kinematic diagrams, plans of velocities and accelerations")
        yield MotionSheet(name, page, diagrams, plans)
        return
    yield MotionSheet(Sentence("Plan of positions, kinematic diagrams"), page, diagrams, ())
    for start in range(0, len(plans), MOST_PLANS):
        name = Sentence("Plans of velocities and accelerations")
        yield VectorSheet(name, plans[start : start + MOST_PLANS])


def output_diagrams(plan: PositionPlan) -> Iterator[ScaledDiagram]:
    """Displacement, velocity and acceleration of the output over the drive, counted from position 0."""
    name, kind, variables, units, letters = _output(plan)
    if not name:
        return
    across, values = _over_cycle(plan, kind, name, variables)
    ticks = _ticks(plan)
    parameter = plan.mechanism.motion_parameter
    turns = parameter.instant.unit == "rad"
    letter = Symbol("φ") if turns else Symbol(parameter.instant.symbol)
    label = AxisLabel(symbol=letter, unit=parameter.instant.unit)
    titles = _titles(kind, name)
    for title, unit, symbol, curve in zip(titles, units, letters, values, strict=True):
        up = AxisLabel(symbol=Symbol(symbol), unit=unit)
        yield ScaledDiagram(title, label, up, (ScaledCurve(NOTHING, across, curve),), ticks)


def _output(plan: PositionPlan) -> tuple[str, str, tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """The link or guide whose motion is plotted: that which position 0 belongs to, else the last slider or link."""
    mechanism = plan.mechanism
    guides = [guide.id for guide in mechanism.guides if guide.on == "frame"]
    driven = {drive.guide for drive in mechanism.drives} | {drive.link for drive in mechanism.drives}
    others = [name for name in (*reversed(guides), *reversed(mechanism.link_names)) if name not in driven]
    name = plan.link or next(iter(others), "")
    if name in mechanism.link_names:
        return name, "link", OF_LINKS, ("rad", "rad/s", "rad/s^2"), ("ψ", "ω", "ε")
    return name, "guide", ON_GUIDES, ("m", "m/s", "m/s^2"), ("s", "v", "a")


def _titles(kind: str, name: str) -> tuple[Sentence, Sentence, Sentence]:
    if kind == "link":
        return (
            Sentence("Angle of {link}", link=Name(name)),
            Sentence("Angular velocity of {link}", link=Name(name)),
            Sentence("Angular acceleration of {link}", link=Name(name)),
        )
    return (
        Sentence("Displacement of slider {point}", point=Name(name)),
        Sentence("Velocity of slider {point}", point=Name(name)),
        Sentence("Acceleration of slider {point}", point=Name(name)),
    )


def diagram_sheet(mechanism: Mechanism, course: xarray.Dataset, name: str) -> DiagramSheet:
    """Angle, velocity and acceleration of a link or guide on the sphere over the drive, from the first sample on.

    `course` is the motion of a mechanism that has the joint or guide of this name.
    """
    kind, variables = ("guide", ON_GUIDES) if name in course["guide"].values else ("joint", OF_JOINTS)
    letters = ("s", "v", "a") if kind == "guide" else ("ψ", "ω", "ε")
    parameter = mechanism.motion_parameter
    along = parameter.instants(course)
    known = np.isfinite(course[variables[0]].sel({kind: name}).values)
    across = np.abs(along - along[0])[known]
    values = [course[variable].sel({kind: name}).values[known] for variable in variables]
    values[0] = np.unwrap(values[0])
    turns = parameter.instant.unit == "rad"
    label = AxisLabel(
        symbol=Symbol("φ") if turns else Symbol(parameter.instant.symbol), unit=parameter.instant.unit
    )
    titles = _titles("link" if kind == "joint" else kind, name)
    diagrams = [
        ScaledDiagram(
            title,
            label,
            AxisLabel(symbol=Symbol(letter), unit=unit),
            (ScaledCurve(NOTHING, across, curve),),
        )
        for title, letter, unit, curve in zip(
            titles, letters, ("rad", "rad/s", "rad/s^2"), values, strict=True
        )
    ]
    return DiagramSheet(Sentence("Kinematic diagrams"), tuple(diagrams))


def _drive_progress(plan: PositionPlan, values: Array) -> Array:
    """How far the drive has gone from position 0; within a turn, in the sense of the drive."""
    along = plan.mechanism.motion_parameter.instants(plan.path)
    turn = float(along[-1] - along[0])
    if not plan.closed:
        return np.abs(values - plan.zero)
    share = (values - plan.zero) / turn
    share = share - np.floor(share + 1e-9)
    return np.asarray(np.maximum(share, 0.0) * abs(turn), dtype=np.float64)


def _ticks(plan: PositionPlan) -> tuple[float, ...]:
    """Where the numbered positions are on the axis of the drive; after a turn comes one more, the first again."""
    parameter = plan.mechanism.motion_parameter
    places = _drive_progress(plan, parameter.instants(plan.positions))
    along = parameter.instants(plan.path)
    return (*places.tolist(), abs(float(along[-1] - along[0]))) if plan.closed else tuple(places.tolist())


def _over_cycle(
    plan: PositionPlan, kind: str, name: str, variables: tuple[str, ...]
) -> tuple[Array, list[Array]]:
    """Places of the samples on the axis of the drive, and the variables there; a turn ends as it begins."""
    parts = (plan.path, plan.positions)
    across = np.concatenate(
        [_drive_progress(plan, plan.mechanism.motion_parameter.instants(one)) for one in parts]
    )
    values = [
        np.concatenate([one[variable].sel({kind: name}).values for one in parts]) for variable in variables
    ]
    time = plan.path["time"].values
    values[1:] = [_without_rounding(*pair, float(time[-1] - time[0])) for pair in pairwise(values)]
    order = np.argsort(across, kind="stable")
    apart = np.diff(across[order], prepend=-np.inf) > 1e-9 * float(across.max())
    order = order[apart]
    across = across[order]
    chosen = [one[order] for one in values]
    chosen[0] = _from_zero(chosen[0], float(values[0][len(values[0]) - plan.positions.sizes["sample"]]), kind)
    if plan.closed:
        along = plan.mechanism.motion_parameter.instants(plan.path)
        across = np.append(across, abs(along[-1] - along[0]))
        ends = [
            float(chosen[0][0] if kind == "guide" else chosen[0][-1]),
            *(float(one[0]) for one in chosen[1:]),
        ]
        if kind == "link":
            turn = float(np.round((chosen[0][-1] - chosen[0][0]) / (2 * np.pi)) * 2 * np.pi)
            ends[0] = float(chosen[0][0]) + turn
        chosen = [np.append(one, end) for one, end in zip(chosen, ends, strict=True)]
    return across, chosen


def _without_rounding(values: Array, rates: Array, time: float) -> Array:
    """Rates of values over a time [s]; nothing where they are rounding of these."""
    size = float(np.nanmax(np.abs(values), initial=0.0))
    return rates if float(np.nanmax(np.abs(rates), initial=0.0)) * abs(time) > NONE * size else 0.0 * rates


def _from_zero(values: Array, start: float, kind: str) -> Array:
    """Displacements counted from position 0; angles without jumps by whole turns."""
    moved: Array = values - start
    if kind != "link":
        return moved
    known = np.isfinite(moved)
    moved[known] = np.unwrap(moved[known])
    turns = round(float(moved[0]) / (2 * np.pi))
    return np.asarray(moved - 2 * np.pi * turns)


# The machine


def energy_sheet(machine: MachineResults, plan: PositionPlan | None) -> EnergySheet:
    """Moments and works over the cycle, and the energy-mass diagram; the plan's positions are marked along the turn.

    Without a plan, as on the sphere, round numbers are.
    """
    steady, flywheel = machine.steady, machine.flywheel
    turned = steady["turned"].values
    over = AxisLabel(symbol=Symbol("φ"), unit="rad")
    ticks = () if plan is None else _places_in_cycle(machine, plan)

    def curve(name: str, label: Text = NOTHING) -> ScaledCurve:
        return ScaledCurve(label, turned, steady[name].values)

    def diagram(title: Sentence, letter: str, unit: str, *curves: ScaledCurve) -> ScaledDiagram:
        return ScaledDiagram(title, over, AxisLabel(symbol=Symbol(letter), unit=unit), curves, ticks)

    moments = diagram(
        Sentence("Moments of the loads and of the drive"), "M", "N m",
        curve("moment_of_loads", Symbol("M", "c")), curve("driving_moment", Symbol("M", "d")),
    )  # fmt: skip
    works = diagram(
        Sentence("Works of the loads and of the drive"), "A", "J",
        curve("work_of_loads", Symbol("A", "c")), curve("work_of_drive", Symbol("A", "d")),
    )  # fmt: skip
    inertia = steady["inertia_of_links"].values
    work = steady["work"].values
    masses = ScaledDiagram(
        Sentence("Energy-mass diagram"),
        AxisLabel(symbol=Symbol("J"), unit="kg m^2"),
        AxisLabel(symbol=Symbol("T"), unit="J"),
        (ScaledCurve(NOTHING, inertia, work),),
    )
    lines = flywheel.tangents
    slopes: tuple[float, ...] = ()
    intercepts: tuple[float, ...] = ()
    touching: tuple[tuple[float, float], ...] = ()
    if lines is not None:
        slopes = lines.lower_slope, lines.upper_slope
        intercepts = lines.lower_intercept, lines.upper_intercept
        at = np.interp([lines.lower_at, lines.upper_at], turned, inertia).tolist()
        touching = tuple(
            (place, start + slope * place) for place, slope, start in zip(at, slopes, intercepts, strict=True)
        )
    return EnergySheet(
        Sentence("Moments, works, reduced inertia, energy-mass diagram"),
        (moments, works),
        EnergyMassDiagram(
            diagram(Sentence("Change of energy"), "T", "J", curve("work")),
            diagram(Sentence("Reduced inertia of the links"), "J", "kg m^2", curve("inertia_of_links")),
            masses,
            slopes,
            intercepts,
            touching,
            flywheel.inertia_by_tangents,
        ),
    )


def _places_in_cycle(machine: MachineResults, plan: PositionPlan) -> tuple[float, ...]:
    """How far the drive has turned from the beginning of the cycle to each position; nothing of longer cycles."""
    turned, values = machine.steady["turned"].values, machine.steady["drive_value"].values[:, 0]
    turn = float(values[-1] - values[0])
    if not (plan.closed and abs(abs(turn) - 2 * np.pi) < 1e-9):
        return ()
    share = (plan.mechanism.motion_parameter.instants(plan.positions) - values[0]) / turn
    share = share - np.floor(share + 1e-9)
    return tuple((np.maximum(share, 0.0) * turned[-1]).tolist())


# Forces


def force_sheets(forces: ForcePolygonResults) -> Iterator[ForceSheet]:
    """Groups of every instant with their polygons, some on each sheet."""
    pictures = force_polygons.sheet(forces).pictures.values()
    groups = [
        one
        for one in pictures
        if isinstance(one, LeverPage) or (isinstance(one, GroupPage) and _has_forces(one))
    ]
    for start in range(0, len(groups), MOST_GROUPS):
        yield ForceSheet(Sentence("Force polygons"), tuple(groups[start : start + MOST_GROUPS]))


def _has_forces(page: GroupPage) -> bool:
    """Whether forces act on the group of a page."""
    return any(polygon.strokes for polygon in page.polygons)
