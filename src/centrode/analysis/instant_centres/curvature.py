"""Curvature of point paths at given places: inflection circle, Euler and Savary, stationary curvature, Ball's point."""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Real
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.instant_centres.bodies import (
    ROUNDED,
    Array,
    Seen,
    mechanism_of_motion,
    refuse_batch,
    vectors,
)
from centrode.errors import InputError, NotComputedYet, Status
from centrode.geometry.plane import PlanePose, Vector, reversed_rotor, rotate_vector, subtract
from centrode.kinematics.events import EventScan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.motion import (
    attributes_of,
    coordinates_along,
    judgements_of,
    labels_of,
    vocabulary_variable,
)
from centrode.kinematics.path import JETS, SampleGrid
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.sample_index import selectable
from centrode.kinematics.samples import start_of
from centrode.kinematics.solve import fit_for, grid_of, solve
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.labels import sliders_of
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.units import read_quantity
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Positions

Local: TypeAlias = Mapping[str, tuple[float, float]]
ORDER = 3


def curvature(
    source: MechanismSource | xr.Dataset,
    link: str,
    at: npt.ArrayLike | None = None,
    against: str = "frame",
    points: Mapping[str, tuple[float | str, float | str]] | None = None,
) -> xr.Dataset:
    """Curvature of the paths of a link's points, at given places of a motion.

    Parameters
    ----------
    source : Mechanism or Dataset
        A planar mechanism, its file or the name of a built-in one, or its motion (of a batch, one mechanism).
    link, against : str
        Bodies: links, "frame", sliders ("slider C"); the paths are those that `against` sees.
    at : (n,) values of the drive [rad or m], times [s] where it is a law or there are several, or texts with a unit
        Of a motion its samples by default.
    points : name -> (x, y) [m], or texts with a unit, optional
        Further points of the link, in its own axes.

    Returns
    -------
    Dataset
        In the frame's axes: `pole` and `inflection_pole` (sample, axis) [m], ends of a diameter of the
        inflection circle; `inflection_diameter` (sample) [m]; `pole_tangent` (sample) [rad], the x axis of
        the pole's own axes, whose y axis points to the inflection pole; `stationary_cubic` (sample,
        coefficient) [1/m], a and b of (x^2 + y^2)(a x + b y) = x y in these axes; `ball_point` (sample, axis)
        [m]. Of each point: `path_curvature` (sample, point) [1/m], positive to the left as the drive's value
        (or time) grows; `path_curvature_slope` [1/m^2] by the arc; `curvature_centre` (sample, point, axis).

    Raises
    ------
    InputError
        Unknown bodies, no places.
    NotComputedYet
        The mechanism moves on the sphere.

    Notes
    -----
    Exact: from jets of the third order. Absent (NaN) in a translation is what belongs to the pole, at the
    pole the curvature, on the inflection circle the centre of curvature; Ball's point where every point of
    the inflection circle is one.

    Examples
    --------
    >>> import centrode as ct
    >>> bends = ct.curvature(ct.example("elliptic-trammel"), "AB", [0.6])
    >>> round(float(bends.inflection_diameter[0]), 6)
    1.0
    """
    mechanism, places = _source_mechanism(source, at)
    if mechanism.space == "sphere":
        raise NotComputedYet(
            "space", _("curvature is not computed on the sphere"), _("choose a planar mechanism")
        )
    for name in (link, against):
        _check_body(mechanism, name)
    if link == against:
        what = _("{name} does not move relative to itself")
        if link == FRAME:
            what = _("the frame does not move relative to itself")
        raise InputError("link", what.format(name=link))
    prepared = ready(mechanism)
    if places is None:
        # the motion starts anew from its description: a dataset has two derivatives, and the third is needed
        assert isinstance(source, xr.Dataset)
        places = prepared.parameter.instants(source)
    span = grid_of(prepared, None, None, None, places)
    solved = solve(prepared, span)
    positions = jet_positions(prepared, span)
    # behind a limit the motion does not get there, but the mechanism has its position
    present = np.isin(solved.status[0], (Status.OK, Status.CUT_OFF))
    seen = _pose_derivatives(mechanism, positions, link, against, present)
    own = _local_points(mechanism, link) | {name: _place(name, at) for name, at in (points or {}).items()}
    scale = float(prepared.kinematics.numbers.scale)
    with np.errstate(all="ignore"):
        variables = _of_pole(seen, scale) | _of_points(seen, own, scale)
    kept = {**coordinates_along(solved), "axis": labels_of(solved.layout.space.axes)}
    variables["status"] = judgements_of(solved, ())["status"]
    coordinate = {"point": labels_of(tuple(own)), "coefficient": labels_of(("a", "b"))}
    facts = attributes_of(solved, "centrodes") | {"link": link, "against": against}
    return selectable(xr.Dataset(variables, coords=kept | coordinate, attrs=facts))


def _place(name: str, at: Any) -> tuple[float, float]:
    """Coordinates [m] of a point in the axes of its link, of numbers or of texts with a unit."""
    where = f"points, {name}"
    if isinstance(at, str) or len(at) != 2:
        raise InputError(where, _("expected two coordinates, got {value}").format(value=value_text(at)))
    x, y = (one if isinstance(one, Real) else read_quantity(one, "length", where) for one in at)
    return float(x), float(y)


def _source_mechanism(
    source: MechanismSource | xr.Dataset, at: npt.ArrayLike | None
) -> tuple[Mechanism, npt.ArrayLike | None]:
    if isinstance(source, xr.Dataset):
        refuse_batch(source)
        return mechanism_of_motion(source), at
    if at is None:
        raise InputError("at", _("it needs values of the drive"), _("give one or more"))
    return mechanism_of(source), at


def _check_body(mechanism: Mechanism, name: str) -> None:
    names = (FRAME, *mechanism.link_names, *sliders_of(mechanism))
    if name not in names:
        what = _("there is no link {name}").format(name=value_text(name))
        raise InputError("link", what, nearest(name, names))


def jet_positions(prepared: Ready, span: SampleGrid) -> Positions:
    """Positions with three derivatives by the path's parameter, (1, samples) each, on the branch of the motion."""
    fitted = fit_for(prepared, span)
    continuation = start_of(fitted, fitted.kinematics)
    EventScan(continuation, mesh_of(fitted.kinematics.path, span.parameter)).run()
    along = span.parameter[None, :]
    with np.errstate(all="ignore"):
        return continuation.kinematics.positions(
            JETS, Jet.variable(along, ORDER), continuation.hooks(JETS, along, None)
        )


def _pose_derivatives(
    mechanism: Mechanism, at: Positions, link: str, against: str, present: npt.NDArray[np.bool_]
) -> Seen:
    """Three derivatives of the pose of a link in the axes of another."""
    pose, base = _pose(mechanism, at, link), _pose(mechanism, at, against)
    back = reversed_rotor(base.rotor)
    origin, rotor = rotate_vector(subtract(pose.origin, base.origin), back), rotate_vector(pose.rotor, back)
    x, y, cosine, sine = (_jet(number) for number in (*origin, *rotor))
    # the rotor is a unit vector: its spin c s' - s c' is the relative angular velocity, whatever the angle is
    spin = cosine.lower_order() * sine.slope() - sine.lower_order() * cosine.slope()

    # numbers that do not depend on the parameter are plain and have to be spread over the samples
    def along(number: object) -> Array:
        values = np.broadcast_to(np.asarray(number, dtype=np.float64), (1, len(present)))[0]
        return np.where(present, values, np.nan)

    return Seen(
        tuple(along(x.derivative(k)) + 1j * along(y.derivative(k)) for k in range(ORDER + 1)),
        tuple(along(spin.derivative(k)) for k in range(ORDER)),
        along(cosine.value) + 1j * along(sine.value),
        *(along(_jet(v[0]).value) + 1j * along(_jet(v[1]).value) for v in (base.origin, base.rotor)),
    )


def _pose(mechanism: Mechanism, at: Positions, name: str) -> PlanePose:
    guide = sliders_of(mechanism).get(name)
    if guide is None:
        return PlanePose(*at.poses[name])
    x, y = at.points[guide.point]
    # a slider is hinged in its point and turns with the guide it slides on
    return PlanePose((x, y), PlanePose(*at.poses[guide.on]).rotor)


def _jet(number: object) -> Jet:
    return number if isinstance(number, Jet) else Jet((number, *[0.0] * ORDER))


def _local_points(mechanism: Mechanism, name: str) -> dict[str, Vector]:
    if name in sliders_of(mechanism):
        return {sliders_of(mechanism)[name].point: (0.0, 0.0)}
    return dict(mechanism.points_of(name))


def _of_pole(seen: Seen, scale: float) -> dict[str, object]:
    """Inflection circle, cubic of stationary curvature and Ball's point."""
    first, second, third = seen.by_angle()
    turning = np.abs(seen.w[0]) * scale > ROUNDED * (np.abs(seen.w[0]) * scale + np.abs(seen.c[1]))
    pole = np.where(turning, seen.pole, np.nan)
    # with r the arm from the pole P, derivatives by the angle are Z' = i r, Z'' = A - r, Z''' = B - i r
    to_inflection = np.where(turning, second - 1j * first, np.nan)
    rest = third + first
    diameter = np.abs(to_inflection)
    # a hinge that stays has a circle without size, and no tangent
    normal = np.where(diameter > ROUNDED * scale, to_inflection / diameter, np.nan)
    ahead = rest * np.conj(-1j * normal)  # in the pole's axes: x along the tangent, y along the normal
    # Z' x Z''' |Z'|^2 = 3 (Z' x Z'') (Z' . Z''): with A = i D, B = p + i q it is (x^2 + y^2) ((p + 3 D) x + q
    # y) = 3 D^2 x y
    cubic = np.stack([ahead.real + 3.0 * diameter, ahead.imag], axis=-1) / (3.0 * diameter**2)[:, None]
    # Z' x Z''' = -Re(conj(r) B) = 0: the arm to Ball's point is square to B, and on the inflection circle an
    # arm is as long as A's part in its direction
    square = 1j * rest / np.abs(rest)
    told = (np.abs(rest) > ROUNDED * np.maximum(diameter, scale)) & np.isfinite(normal)
    ball = np.where(told, pole + square * (square * np.conj(to_inflection)).real, np.nan)
    tangent = np.angle(-1j * normal * seen.rotor)
    return {
        "pole": vocabulary_variable("pole", ("sample", "axis"), vectors(seen.outside(pole))),
        "inflection_pole": vocabulary_variable(
            "inflection_pole", ("sample", "axis"), vectors(seen.outside(pole + to_inflection))
        ),
        "inflection_diameter": vocabulary_variable("inflection_diameter", ("sample",), diameter),
        "pole_tangent": vocabulary_variable("pole_tangent", ("sample",), tangent),
        "stationary_cubic": vocabulary_variable("stationary_cubic", ("sample", "coefficient"), cubic),
        "ball_point": vocabulary_variable("ball_point", ("sample", "axis"), vectors(seen.outside(ball))),
    }


def _of_points(seen: Seen, points: Local, scale: float) -> dict[str, object]:
    """Curvature of the paths of points, its slope and its centre."""
    local = np.array([complex(*at) for at in points.values()], dtype=np.complex128)
    arm = seen.turned[:, None] * local
    w, w1, w2 = (x[:, None] for x in seen.w)
    place = seen.c[0][:, None] + arm
    first = seen.c[1][:, None] + 1j * w * arm
    second = seen.c[2][:, None] + (1j * w1 - w * w) * arm
    third = seen.c[3][:, None] + (1j * w2 - 3.0 * w * w1 - 1j * w**3) * arm
    speed = np.abs(first)
    speed[speed <= ROUNDED * (np.abs(w) * scale + np.abs(seen.c[1][:, None]))] = np.nan  # a cusp
    bend = (np.conj(first) * second).imag
    curved = bend / speed**3
    along = (np.conj(first) * second).real
    # by the arc: the derivative by the parameter over the speed
    slope = ((np.conj(first) * third).imag / speed**3 - 3.0 * bend * along / speed**5) / speed
    # next to an inflection the centre runs to infinity: it is left out where rounding would place it
    centre = place + 1j * first / speed / np.where(np.abs(curved) * scale > ROUNDED, curved, np.nan)
    outside = seen.origin[:, None] + seen.rotor[:, None] * centre
    return {
        "path_curvature": vocabulary_variable("path_curvature", ("sample", "point"), curved),
        "path_curvature_slope": vocabulary_variable("path_curvature_slope", ("sample", "point"), slope),
        "curvature_centre": vocabulary_variable(
            "curvature_centre", ("sample", "point", "axis"), vectors(outside)
        ),
    }
