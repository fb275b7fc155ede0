"""Answers of a synthesis: mechanisms with what they miss, how they transmit, and their defects."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NoReturn

import numpy as np

from centrode.errors import CentrodeError, MotionError, Status
from centrode.kinematics.motion import motion
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism
from centrode.synthesis.cognates import cognates
from centrode.synthesis.four_bars import (
    COUPLER,
    CRANK,
    DX,
    DY,
    OX,
    OY,
    PX,
    PY,
    ROCKER,
    Array,
    Complex,
    cosines_of_transmission,
    crank_margins,
    least_transmission,
)
from centrode.synthesis.requests import SynthesisTask

CHECKED_PLACES = 361
"""Samples of the motion by which an answer is proved."""


@dataclass(frozen=True)
class Defects:
    """What a motion from target to target meets.

    Attributes
    ----------
    order : targets are not passed in their order
    branch : the linkage stops at a limit between two targets, or leaves its branch
    crank : the crank does not turn fully, where that was required
    """

    order: bool
    branch: bool
    crank: bool

    @property
    def none(self) -> bool:
        """Whether there is no defect."""
        return not (self.order or self.branch or self.crank)


@dataclass(frozen=True, eq=False)
class Answer:
    """One mechanism that does what was wanted, more or less.

    Attributes
    ----------
    mechanism : Mechanism
    error : what the answers are ranked by: root mean square distance [m] or angle [rad]; of functions the greatest
    greatest : greatest error, in the same unit
    sum_of_squares : of the errors
    transmission : least transmission angle over the motion [rad]; NaN where there is none
    size : width and height [m] of the box around all positions
    defects : Defects
    curve : (n) complex, the traced curve; empty where nothing is traced
    met : (targets) complex, where the point is at the targets
    drive : (targets) angles of the crank there [rad]
    cognates : mechanisms that draw the same curve
    deviations : (targets) errors of a function [rad] with their sign; None of other kinds
    numbers : further named numbers with their SI unit
    links : lines of links where the first target is met; empty of four-bar linkages, which their dimensions draw
    """

    mechanism: Mechanism
    error: float
    greatest: float
    sum_of_squares: float
    transmission: float
    size: tuple[float, float]
    defects: Defects
    curve: Complex = field(default_factory=lambda: np.empty(0, dtype=np.complex128))
    met: Complex = field(default_factory=lambda: np.empty(0, dtype=np.complex128))
    drive: Array = field(default_factory=lambda: np.empty(0))
    cognates: tuple[Mechanism, ...] = ()
    deviations: Array | None = None
    numbers: Mapping[str, tuple[float, str]] = field(default_factory=dict)
    links: tuple[Complex, ...] = ()


@dataclass(frozen=True, eq=False)
class Construction:
    """Both limit positions of a mechanism from a stroke, and where they leave the hinge of its crank.

    Attributes
    ----------
    ends : (2) complex, the end of the stroke that the crank moves directly [m]
    links : lines of the links in both limit positions
    pin : (n) complex, the circle of the crank's pin
    sight : (n) complex, the circle from which both ends are seen at the same angle; empty of slotted levers
    fixed : (m) complex, fixed hinges
    """

    ends: Complex
    links: tuple[Complex, ...]
    pin: Complex
    sight: Complex
    fixed: Complex


@dataclass(frozen=True, eq=False)
class SynthesisResults:
    """The answers to a request, the best first.

    Attributes
    ----------
    task : SynthesisTask
    answers : at most as many as were wanted
    targets : (n) complex, points to pass or poses' places; empty of strokes
    closed : whether the targets lie along a closed path
    examined : linkages that the search began with
    complete : False where it was stopped before its end
    curves : of poses: name -> complex points of the centre and circle point curves
    values : (n, 2) crank and rocker angles [rad] that a function should have
    construction : of strokes, that of the best answer; None elsewhere
    """

    task: SynthesisTask
    answers: tuple[Answer, ...]
    targets: Complex = field(default_factory=lambda: np.empty(0, dtype=np.complex128))
    closed: bool = False
    examined: int = 0
    complete: bool = True
    curves: Mapping[str, Complex] = field(default_factory=dict)
    values: Array | None = None
    construction: Construction | None = None

    @property
    def mechanism(self) -> Mechanism:
        """The best answer."""
        return self.answers[0].mechanism


def four_bar_description(
    linkage: Array,
    side: float,
    start: float,
    sense: float,
    title: str,
    display: Mapping[str, object],
    point: str = "P",
    further: Mapping[str, list[float]] | None = None,
) -> Mechanism:
    """The description of a four-bar linkage O-A-B-D with its coupler point.

    Parameters
    ----------
    linkage : (9,) in the order of `DIMENSIONS` [m]
    start : of the crank [rad]
    sense : +1 or -1, of the crank
    further : more points of the coupler, in its axes [m]
    """
    row = [float(value) for value in linkage]
    points = {"A": [0.0, 0.0], "B": [row[COUPLER], 0.0]}
    if point:
        points[point] = [row[PX], row[PY]]
    return Mechanism(
        title=title,
        display=display,
        frame={"points": {"O": row[OX : OY + 1], "D": row[DX : DY + 1]}},
        links={
            "OA": {"length": row[CRANK]},
            "AB": {"points": {**points, **(further or {})}},
            "DB": {"length": row[ROCKER]},
        },
        drives=[{"link": "OA", "start": float(start), "speed": float(sense)}],
        assembly={"sides": {"B": "left" if side > 0 else "right"}},
    )


def four_bar_answer(
    task: SynthesisTask,
    linkage: Array,
    side: float,
    crank: Array,
    sense: float,
    errors: Array,
    closed: bool,
    numbers: Mapping[str, tuple[float, str]] | None = None,
    further: Mapping[str, list[float]] | None = None,
) -> Answer:
    """An answer with everything about it that the engine computes from its description.

    Parameters
    ----------
    crank : (targets) angles of the crank [rad], in the order of the targets
    errors : (targets) distances [m] from them, or angles [rad]
    """
    wanted = task.synthesis
    title = task.title or "Four-bar linkage"
    point = wanted.point if wanted.kind in ("path", "motion") else ""
    display = task.display.model_dump(exclude_unset=True)
    mechanism = four_bar_description(linkage, side, crank[0], sense, title, display, point, further)
    turns = bool((crank_margins(linkage[None]) > 0).all())
    defects = proved_defects(mechanism, crank, sense, turns, wanted.constraints.crank is not None)
    curve, met, size = trace_point(mechanism, point, crank, sense, turns)
    others = []
    if wanted.kind == "path":
        for other, its_side, start in cognates(linkage, side, float(crank[0])):
            if (crank_margins(other[None]) > 0).all():
                others.append(four_bar_description(other, its_side, start, sense, title, display, point))
    return Answer(
        mechanism,
        float(np.sqrt(np.mean(errors**2))),
        float(np.max(np.abs(errors))),
        float((errors**2).sum()),
        transmission_of(linkage, crank, turns),
        size,
        defects,
        curve,
        met,
        crank,
        tuple(others),
        errors if wanted.kind == "function" else None,
        numbers or {},
    )


def transmission_of(linkage: Array, crank: Array, turns: bool) -> float:
    """Least transmission angle [rad]: over a full turn, else over the way from the first target to the last."""
    if turns:
        return float(least_transmission(linkage[None])[0])
    frame = math.atan2(linkage[DY] - linkage[OY], linkage[DX] - linkage[OX])
    from_frame = crank - frame
    cosines = cosines_of_transmission(
        linkage[None], from_frame.min(keepdims=True), from_frame.max(keepdims=True)
    )
    return math.acos(min(float(np.abs(cosines).max()), 1.0))


def proved_defects(
    mechanism: Mechanism, crank: Array, sense: float, turns: bool, needs_crank: bool
) -> Defects:
    """Defects by the engine's motion: over a full turn, or from the first target to the last.

    One branch and one circuit are kept where no sample of the motion is open and no limit lies on the way, because the
    side of a dyad changes nowhere else.
    """
    order = bool((np.diff(crank) * sense <= 0).any() or abs(crank[-1] - crank[0]) >= 2 * np.pi)
    start = float(crank[0])
    stop = start + sense * 2 * np.pi if turns else float(crank[-1])
    if stop == start:
        return Defects(order, False, needs_crank and not turns)
    try:
        data = motion(mechanism, CHECKED_PLACES, start=start, stop=stop)
        branch = bool((data.status.to_numpy() != int(Status.OK)).any())
    except CentrodeError:
        branch = True
    return Defects(order, branch, needs_crank and (not turns or branch))


def box_around(mechanism: Mechanism, places: Array) -> tuple[float, float]:
    """Width and height [m] of the box around the frame and the places of all moving points, (samples, points, 2)."""
    fixed = np.array(list(mechanism.frame.points.values()), dtype=np.float64)
    low = np.minimum(np.nanmin(places, axis=(0, 1)), fixed.min(axis=0))
    high = np.maximum(np.nanmax(places, axis=(0, 1)), fixed.max(axis=0))
    return float(high[0] - low[0]), float(high[1] - low[1])


def trace_point(
    mechanism: Mechanism, point: str, crank: Array, sense: float, turns: bool
) -> tuple[Complex, Complex, tuple[float, float]]:
    """Curve of the point, its places at crank angles, and the box around all moving points, by the engine."""
    start = float(crank[0])
    stop = start + sense * 2 * np.pi if turns else float(crank[-1])
    none = np.empty(0, dtype=np.complex128)
    if stop == start:
        return none, none, (math.nan, math.nan)
    try:
        data = motion(mechanism, CHECKED_PLACES, start=start, stop=stop)
        exact = motion(mechanism, at=list(crank)) if point else None
    except CentrodeError:
        return none, none, (math.nan, math.nan)
    places = data.position.to_numpy()
    box = box_around(mechanism, places)
    if exact is None:
        return none, none, box
    curve = data.position.sel(point=point).to_numpy()
    met = exact.position.sel(point=point).to_numpy()
    return curve[:, 0] + 1j * curve[:, 1], met[:, 0] + 1j * met[:, 1], box


def refuse_poses(linkages: int) -> NoReturn:
    """Refuse poses through which so many linkages lead, none of which keeps what is required."""
    what = ngettext(
        "{n} linkage leads through the poses, but does not keep everything that is required",
        "{n} linkages lead through the poses, but none keeps everything that is required",
        linkages,
    )
    repair = _("loosen a constraint, or change a pose")
    raise MotionError("[synthesis]", what.format(n=linkages), repair)
