"""Fixed and moving centrode of one body against another: two curves that roll on each other without slip.

Those of the sphere are called polodes; they are the curves of `polodes`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.instant_centres.bodies import (
    ROUNDED,
    Array,
    Pair,
    TurningBodies,
    bodies_of,
    is_spherical,
    seen_by,
    turning_bodies_of,
    vectors,
)
from centrode.analysis.instant_centres.centres import axis_of, number_pairs
from centrode.errors import Status
from centrode.kinematics.motion import vocabulary_variable
from centrode.model.motion_parameter import parameter_values

# Polodes on the sphere: what the end of the instantaneous axis describes in the axes of either body.
#
# Both bodies see the axis move alike: with W the relative angular velocity, its derivatives in the axes of
# the one and of the other differ by (w1 - w2) x W = 0. So the cones that the polodes belong to roll on each
# other without slip.


@dataclass(frozen=True)
class Polodes:
    """Two curves that roll on each other, in the plane or on the sphere.

    Attributes
    ----------
    fixed, moving : (..., samples, axis) places in the axes of the one and of the other body; NaN where none is
    rates : their derivatives by the drive's value (with several drives by time)
    sense : (..., samples, k) vectors, or signs, that point against each other where the relative rotation turns back
    """

    fixed: Array
    moving: Array
    rates: tuple[Array, Array]
    sense: Array


def polodes_of(bodies: TurningBodies, pair: Pair) -> Polodes:
    """Polodes of the first body of a pair against the second, over a motion."""
    first, second = pair
    axis, spin = axis_of(bodies, pair), bodies.relative(pair)
    growing = bodies.spin_rate[..., first, :] - bodies.spin_rate[..., second, :]
    growing = growing - np.cross(bodies.spin[..., second, :], spin)  # as both bodies see it
    # where the bodies are at rest there is no axis and no rate of it: the size is NaN with the axis
    size = np.where(np.isfinite(axis[..., :1]), np.linalg.norm(spin, axis=-1, keepdims=True), np.nan)
    # a unit vector turns by the part of the derivative that is square to it
    rate = (growing - axis * np.sum(axis * growing, axis=-1, keepdims=True)) / size
    fixed, moving = (_inside(bodies.axes[..., body, :, :], axis) for body in (second, first))
    rates = _inside(bodies.axes[..., second, :, :], rate), _inside(bodies.axes[..., first, :, :], rate)
    # the axis jumps to its other end where the rotation turns back, so the place itself tells the sense
    return Polodes(fixed, moving, rates, fixed)


def _inside(axes: Array, vector: Array) -> Array:
    """Vectors of the frame in the axes of a body."""
    return np.asarray(np.einsum("...ij,...i->...j", axes, vector))


NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)


def centrodes(motion: xr.Dataset, link: str, against: str = "frame") -> xr.Dataset:
    """Fixed and moving centrode of a link over a motion.

    Parameters
    ----------
    motion : Dataset
        As `motion` returns it; a batch too.
    link, against : str
        Bodies: links, "frame", sliders ("slider C").

    Returns
    -------
    Dataset
        `fixed_centrode` (sample, axis) [m] in the axes of `against`, `moving_centrode` (sample, axis) [m] in
        those of `link`; `centrode_piece` (sample), which counts the pieces between places where the centre
        goes to infinity, -1 where there is none; `fixed_arc`, `moving_arc` (sample) [m], arcs from the
        beginning of each piece. The attributes `link` and `against` name the bodies. On the sphere both are
        polodes: unit vectors (x, y, z) of the end of the instantaneous axis that `instant_centres` gives, and
        arcs [rad]; a piece ends where the relative rotation stops and turns back.

    Raises
    ------
    InputError
        Unknown or equal bodies.

    Notes
    -----
    Both arcs are integrated apart, each from its own places; that they agree tells that nothing slips. They
    are of the fourth order in the distance of the samples.

    Examples
    --------
    >>> import centrode as ct
    >>> curves = ct.centrodes(ct.motion(ct.example("elliptic-trammel"), 37), "AB")
    >>> print(ct.summary(curves).splitlines()[3])
    arc of the fixed centrode   2.50648968 m
    """
    spherical = is_spherical(motion)
    polodes = _on_sphere(motion, link, against) if spherical else _in_plane(motion, link, against)
    pieces = _pieces(polodes, motion["status"].values == Status.OK)
    step = _steps(motion)
    arcs = [
        _arc(curve, rate * step[:, None], pieces)
        for curve, rate in zip((polodes.fixed, polodes.moving), polodes.rates, strict=True)
    ]
    front, unit = tuple(map(str, motion["status"].dims)), "rad" if spherical else "m"
    along = (*front, "axis")
    variables = {
        "fixed_centrode": vocabulary_variable("fixed_centrode", along, polodes.fixed, length_unit=unit),
        "moving_centrode": vocabulary_variable("moving_centrode", along, polodes.moving, length_unit=unit),
        "centrode_piece": vocabulary_variable("centrode_piece", front, pieces),
        "fixed_arc": vocabulary_variable("fixed_arc", front, arcs[0], length_unit=unit),
        "moving_arc": vocabulary_variable("moving_arc", front, arcs[1], length_unit=unit),
    }
    kept = motion[["status"]].assign_coords(axis=motion["axis"], drive_value=motion["drive_value"])
    curves = kept.assign(variables).assign_attrs(link=link, against=against)
    # the centrodes of several mechanisms have no sheet
    return curves.assign_attrs(topic="centrodes") if front == ("sample",) else curves


def _in_plane(motion: xr.Dataset, link: str, against: str) -> Polodes:
    """Both centrodes of a planar motion."""
    bodies = bodies_of(motion)
    (pair,) = number_pairs(bodies, [(link, against)])
    seen = seen_by(bodies, pair)
    none = ~(np.abs(seen.w[0]) * bodies.scale > ROUNDED * bodies.rate)
    with np.errstate(divide="ignore", invalid="ignore"):
        curves = [vectors(np.where(none, np.nan, curve)) for curve in (seen.pole, seen.pole_in_body)]
        rate = seen.pole_velocity
        rates = vectors(rate), vectors(np.asarray(np.conj(seen.turned) * rate))
    # in the plane the centre has no sense: the sign of the relative turn stands for it
    return Polodes(curves[0], curves[1], rates, np.sign(np.where(none, np.nan, seen.w[0]))[..., None])


def _on_sphere(motion: xr.Dataset, link: str, against: str) -> Polodes:
    bodies = turning_bodies_of(motion)
    (pair,) = number_pairs(bodies, [(link, against)])
    return polodes_of(bodies, pair)


def _pieces(found: Polodes, present: npt.NDArray[np.bool_]) -> npt.NDArray[np.int32]:
    """Numbers of the pieces between samples where the relative rotation turns back or nothing is there."""
    absent = ~(present & np.isfinite(found.fixed).all(axis=-1) & np.isfinite(found.moving).all(axis=-1))
    begins = np.ones(absent.shape, dtype=bool)
    with np.errstate(invalid="ignore"):
        # nothing is joined through NaN: the comparison is false there
        onwards = np.sum(found.sense[..., 1:, :] * found.sense[..., :-1, :], axis=-1) > 0.0
    begins[..., 1:] = ~onwards | absent[..., 1:] | absent[..., :-1]
    numbers = np.cumsum(begins & ~absent, axis=-1) - 1
    return np.asarray(np.where(absent, -1, numbers), dtype=np.int32)


def _steps(motion: xr.Dataset) -> Array:
    """By how much the parameter of the rates grows from sample to sample."""
    return np.asarray(np.gradient(parameter_values(motion)) if motion.sizes["sample"] > 1 else np.zeros(1))


def _limit_tangents(chord: Array, first: Array, last: Array) -> tuple[Array, Array]:
    """Tangents of cubics, no longer than thrice the chord where all three point the same way.

    Next to infinity the pole covers nearly all of a step at one of its ends: with such a tangent the cubic would run
    beyond the place where it ends, and back. Where the curve has a cusp the tangents point against each other.
    """
    reach = 3.0 * np.linalg.norm(chord, axis=-1)
    onwards = [
        np.sum(one * other, axis=-1) > 0.0 for one, other in ((first, last), (first, chord), (last, chord))
    ]
    same = np.logical_and.reduce(onwards)
    tamed = []
    for one in (first, last):
        size = np.linalg.norm(one, axis=-1)
        factor = np.where(same & (size > reach), reach / size, 1.0)
        tamed.append(one * factor[..., None])
    return tamed[0], tamed[1]


def _arc(curve: Array, rate: Array, pieces: npt.NDArray[np.int32]) -> Array:
    """Length of a curve from the beginning of each piece: that of cubics through its places with its tangents."""
    with np.errstate(divide="ignore", invalid="ignore"):
        chord = curve[..., 1:, :] - curve[..., :-1, :]
        first, last = _limit_tangents(chord, rate[..., :-1, :], rate[..., 1:, :])
        steps = np.zeros_like(chord[..., 0])
        # four Gauss nodes: the speed of a cubic is a root, so no rule is exact, but this one is of the eighth
        # order
        for node, weight in zip(NODES, WEIGHTS, strict=True):
            t = 0.5 * (node + 1.0)
            # derivative of the Hermite cubic through both ends
            slope = 6.0 * t * (1.0 - t) * chord + (1.0 - t) * (1.0 - 3.0 * t) * first
            slope = slope + t * (3.0 * t - 2.0) * last
            steps += 0.5 * weight * np.linalg.norm(slope, axis=-1)
    joined = pieces[..., 1:] == pieces[..., :-1]
    total = np.zeros(pieces.shape)
    for k in range(steps.shape[-1]):  # each piece begins at zero
        total[..., k + 1] = np.where(joined[..., k], total[..., k] + steps[..., k], 0.0)
    return np.asarray(np.where(pieces < 0, np.nan, total))
