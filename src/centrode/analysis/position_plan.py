"""The plan of positions: a mechanism in evenly spaced, numbered positions of a cycle, counted from an extreme one."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError, MotionError, Status
from centrode.kinematics.motion import motion
from centrode.kinematics.plan_evaluation import layout_of
from centrode.kinematics.preparation import ready
from centrode.kinematics.samples import MotionOnPath
from centrode.locale import _, ngettext
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import FRAME, Mechanism
from centrode.numerics.search import interpolated_roots
from centrode.printed_results import PrintsSummary

Array: TypeAlias = npt.NDArray[np.float64]

USUAL, MOST = 12, 36
"""Positions in one plan, and the most of them: more cannot be distinguished in a drawing."""
SAMPLES = 721
SAME = 1e-9
"""Part of a turn within which its end and its beginning are one place."""


@dataclass(frozen=True, repr=False)
class PositionPlan(PrintsSummary):
    """A mechanism in numbered positions.

    Attributes
    ----------
    mechanism : the mechanism
    points : names of the points whose places a document lists
    positions : the motion at the positions, in their order; after a full turn the last is not repeated
    path : the motion in between, for the paths of the points
    zero : value of the drive at position 0 [rad or m; with a law or several drives s]
    link : whose extreme position it is (a link, or a guide of a slider); empty where the range just begins there
    closed : whether the drive makes a full turn
    extremes : values of the drive at all extreme positions of the link
    """

    mechanism: Mechanism
    points: tuple[str, ...]
    positions: xr.Dataset
    path: xr.Dataset
    zero: float
    link: str
    closed: bool
    extremes: tuple[float, ...]


def plan_of_positions(
    mechanism: MechanismSource,
    positions: int | None = None,
    link: str | None = None,
    points: Sequence[str] | None = None,
) -> PositionPlan:
    """A mechanism in numbered positions evenly spaced in the drive's value, the first an extreme one.

    Parameters
    ----------
    positions : int
        How many, 2 to 36; courseworks use 12 or 24. 12 by default.
    link : str, optional
        A link, or a guide by its id, whose velocity vanishes in position 0; the last that swings by
        default. Where the drive makes no full turn, positions run from one end of the range to the other instead.

    points : sequence of names, optional
        Points whose places a document lists; those on guides of the frame by default, without such all that move.

    Raises
    ------
    InputError
        The number of positions, a link that is not there, or does not stop; the sphere.
    MotionError
        The mechanism reaches no two samples.

    Notes
    -----
    The extreme position is a zero of the velocity coefficient, exact to rounding over the second
    coefficient.

    Examples
    --------
    >>> import centrode as ct
    >>> plan = ct.plan_of_positions(ct.example("crank-rocker"), 12)
    >>> plan.link, plan.closed
    ('DB', True)
    """
    mechanism = mechanism_of(mechanism)
    if mechanism.space != "plane":
        raise InputError("space", _("a plan of positions is drawn in the plane only"), _("draw the motion"))
    positions = USUAL if positions is None else positions
    check_positions(positions)
    path = motion(mechanism, SAMPLES)
    ok = path["status"].values == Status.OK
    by = mechanism.motion_parameter.instants(path)
    closed = bool(ok.all()) and _is_turn(mechanism, by)
    if link is not None:
        _refuse_unknown(mechanism, link)
    listed = _points_on_frame_guides(mechanism) if points is None else tuple(points)
    if not closed:
        return _open_plan(mechanism, listed, path, by, ok, positions)
    # position 0 is the first extreme in the drive's sense; where nothing swings, the beginning of the range
    name, extremes = _extremes(mechanism, path, by, link)
    zero = extremes[0] if extremes else float(by[0])
    # a full turn ends where it begins: its last position would be the first one again
    turn = by[-1] - by[0]
    values = zero + turn * np.arange(positions) / positions
    # beyond the end of the range the turn begins again, so that every value lies in the range
    values = np.where((values - by[-1]) / turn >= -SAME, values - turn, values)
    return PositionPlan(mechanism, listed, motion(mechanism, at=values), path, zero, name, closed, extremes)


def check_positions(positions: int) -> None:
    """Raise InputError for a number of positions that cannot be drawn."""
    if isinstance(positions, bool) or not 2 <= positions <= MOST:
        raise InputError(
            "positions",
            ngettext("{n} position is given", "{n} positions are given", positions).format(n=positions),
            _("give 2 to {most}").format(most=MOST),
        )


def _points_on_frame_guides(mechanism: Mechanism) -> tuple[str, ...]:
    """The points on guides of the frame; without such all points that move."""
    points = dict.fromkeys(guide.point for guide in mechanism.guides if guide.on == FRAME)
    return tuple(points) or tuple(mechanism.moving_points)


def _is_turn(mechanism: Mechanism, by: Array) -> bool:
    parameter = mechanism.motion_parameter
    turned = parameter.is_uniform and parameter.turns
    return turned and math.isclose(abs(by[-1] - by[0]), math.tau, rel_tol=1e-9)


def _open_plan(
    mechanism: Mechanism,
    points: tuple[str, ...],
    path: xr.Dataset,
    by: Array,
    ok: npt.NDArray[np.bool_],
    positions: int,
) -> PositionPlan:
    """Positions between the ends of what is reached next to the initial position."""
    reached = np.flatnonzero(ok)
    if reached.size < 2:
        raise MotionError(
            "positions", _("no position of the mechanism is reached in its range"), _("see the limits")
        )
    start = reached[np.argmin(np.abs(path["time"].values[reached]))]
    # from the initial position outwards: what is reached beyond a gap belongs to another stretch of the
    # motion
    first, last = start, start
    while first > 0 and ok[first - 1]:
        first -= 1
    while last < len(ok) - 1 and ok[last + 1]:
        last += 1
    values = np.linspace(by[first], by[last], positions)
    inside = path.isel(sample=slice(int(first), int(last) + 1))
    at = motion(mechanism, at=values)
    return PositionPlan(mechanism, points, at, inside, float(values[0]), "", False, ())


def _refuse_unknown(mechanism: Mechanism, link: str) -> None:
    known = [*mechanism.link_names, *(guide.id for guide in mechanism.guides)]
    if link not in known:
        raise InputError(
            "link",
            _("{link} is neither a link nor a guide of the mechanism").format(link=link),
            _("one of: {names}").format(names=", ".join(known)),
        )


def _extremes(
    mechanism: Mechanism, path: xr.Dataset, by: Array, link: str | None
) -> tuple[str, tuple[float, ...]]:
    """The link or guide that position 0 belongs to, and where it stands still; the last that does by default."""
    if link is None:
        fixed = [guide.id for guide in mechanism.guides if guide.on == FRAME]
        for name in [*reversed(fixed), *reversed(mechanism.link_names)]:
            stops = _stops(mechanism, path, by, name)
            if stops:
                return name, stops
        return "", ()
    stops = _stops(mechanism, path, by, link)
    if not stops:
        raise InputError(
            "link",
            _("the velocity of {link} never vanishes: it has no extreme position").format(link=link),
            _("name a rocker or a guide, or omit it"),
        )
    return link, stops


def _stops(mechanism: Mechanism, path: xr.Dataset, by: Array, name: str) -> tuple[float, ...]:
    """Where a link's angle or a guide's displacement turns back."""
    rate = _rate(mechanism, path, name)
    size = float(np.max(np.abs(rate)))
    unit = 1.0 if name in mechanism.link_names else _length(path)
    if size <= 1e-9 * unit:
        return ()  # it does not move at all
    # strictly: a rate that is zero at a sample is no root of a cell but that sample itself, taken below
    cells = np.flatnonzero(rate[:-1] * rate[1:] < 0)

    turned = interpolated_roots(_rate_on(mechanism, by, name), by[cells], by[cells + 1])
    # the last sample is left out: it is the first again
    places = [*turned.tolist(), *by[:-1][rate[:-1] == 0].tolist()]
    turn = by[-1] - by[0]
    # the end of the turn is its beginning
    places = [place - turn if abs(by[-1] - place) < SAME * abs(turn) else place for place in places]
    # in the sense of the drive, which may run backwards
    return tuple(sorted(places, key=lambda place: (place - by[0]) / turn))


def _rate_on(mechanism: Mechanism, by: Array, name: str) -> Callable[[Array], Array]:
    """Velocity coefficients at any values of the drive in a range, whose events are looked for once."""
    prepared = ready(mechanism)
    places = MotionOnPath.along(prepared, prepared.kinematics, by)
    layout = layout_of(prepared.kinematics)

    def there(values: Array) -> Array:
        samples = places.at(values)
        if name in mechanism.link_names:
            return np.asarray(samples.angles[1, layout.angles.index(name), 0])
        return np.asarray(samples.columns[1, layout.first_slide + layout.guides.index(name), 0])

    return there


def _length(path: xr.Dataset) -> float:
    """Size of a mechanism: the greatest coordinate difference of its points."""
    places = path["position"].values
    return float(np.nanmax(places) - np.nanmin(places)) or 1.0


def _rate(mechanism: Mechanism, data: xr.Dataset, name: str) -> Array:
    """Velocity coefficients of a link's angle or of a guide's displacement."""
    if name in mechanism.link_names:
        return np.asarray(data["angular_velocity_coefficient"].sel(link=name).values)
    return np.asarray(data["slide_velocity_coefficient"].sel(guide=name).values)
