"""Fixed and moving centrode of one body against another: two curves that roll on each other without slip."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.instant_centres.bodies import ROUNDED, Array, Places, bodies_of, vectors
from centrode.analysis.instant_centres.centres import numbered
from centrode.analysis.instant_centres.relative import Seen, seen_by
from centrode.errors import Status
from centrode.kinematics.dataset import named

NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)


def centrodes(motion: xr.Dataset, link: str, against: str = "frame") -> xr.Dataset:
    """Fixed and moving centrode of a link over a motion.

    Parameters
    ----------
    motion : Dataset
        As `motion` returns it, of a planar mechanism; a batch too.
    link, against : str
        Bodies: links, "frame", sliders ("slider C").

    Returns
    -------
    Dataset
        `fixed_centrode` (sample, axis) [m] in the axes of `against`, `moving_centrode` (sample, axis) [m] in
        those of `link`; `centrode_piece` (sample), which counts the pieces between places where the centre
        goes to infinity, -1 where there is none; `fixed_arc`, `moving_arc` (sample) [m], arcs from the
        beginning of each piece. The attributes `link` and `against` name the bodies.

    Raises
    ------
    InputError
        Unknown or equal bodies.
    NotComputedYet
        The mechanism moves on the sphere.

    Notes
    -----
    Both arcs are integrated apart, each from its own places; that they agree tells that nothing slips. They
    are of the fourth order in the distance of the samples.
    """
    bodies = bodies_of(motion)
    (pair,) = numbered(bodies, [(link, against)])
    seen = seen_by(bodies, pair)
    none = ~(np.abs(seen.w[0]) * bodies.scale > ROUNDED * bodies.rate)
    with np.errstate(divide="ignore", invalid="ignore"):
        fixed, moving = np.where(none, np.nan, seen.pole), np.where(none, np.nan, seen.pole_in_body)
        pieces = _pieces(seen, none | (motion["status"].to_numpy() != Status.OK))
        rates = _rates(motion, seen)
        arcs = [_arc(curve, rate, pieces) for curve, rate in zip((fixed, moving), rates, strict=True)]
    front = tuple(map(str, motion["status"].dims))
    variables = {
        "fixed_centrode": named("fixed_centrode", (*front, "axis"), vectors(fixed)),
        "moving_centrode": named("moving_centrode", (*front, "axis"), vectors(moving)),
        "centrode_piece": named("centrode_piece", front, pieces),
        "fixed_arc": named("fixed_arc", front, arcs[0]),
        "moving_arc": named("moving_arc", front, arcs[1]),
    }
    kept = motion[["status"]].assign_coords(axis=motion["axis"], drive_value=motion["drive_value"])
    return kept.assign(variables).assign_attrs(link=link, against=against)


def _pieces(seen: Seen, absent: npt.NDArray[np.bool_]) -> npt.NDArray[np.int32]:
    """Numbers of the pieces between samples where the relative spin changes its sense or nothing is there."""
    sense = np.sign(np.where(absent, np.nan, seen.w[0]))
    begins = np.ones(sense.shape, dtype=bool)
    begins[..., 1:] = sense[..., 1:] != sense[..., :-1]  # so it is beside what is absent
    numbers = np.cumsum(begins & ~absent, axis=-1) - 1
    return np.asarray(np.where(absent, -1, numbers), dtype=np.int32)


def _rates(motion: xr.Dataset, seen: Seen) -> tuple[Places, Places]:
    """Velocities of the pole along both curves, by the number of the sample."""
    by_drive = "velocity_coefficient" in motion
    parameter = motion["drive_value"].isel(drive=0) if by_drive else motion["time"]
    step = np.gradient(parameter.to_numpy()) if motion.sizes["sample"] > 1 else np.zeros(1)
    fixed = seen.pole_velocity * step
    return fixed, np.asarray(np.conj(seen.turned) * fixed)


def _tamed(chord: Places, first: Places, last: Places) -> tuple[Places, Places]:
    """Tangents of cubics, no longer than thrice the chord where all three point the same way.

    Next to infinity the pole covers nearly all of a step at one of its ends: with such a tangent the cubic would run
    beyond the place where it ends, and back. Where the curve has a cusp the tangents point against each other.
    """
    reach = 3.0 * np.abs(chord)
    onwards = [
        np.real(np.conj(one) * other) > 0.0 for one, other in ((first, last), (first, chord), (last, chord))
    ]
    same = np.logical_and.reduce(onwards)
    tamed = [
        np.where(same & (np.abs(one) > reach), one * (reach / np.abs(one)), one) for one in (first, last)
    ]
    return tamed[0], tamed[1]


def _arc(curve: Places, rate: Places, pieces: npt.NDArray[np.int32]) -> Array:
    """Length of a curve from the beginning of each piece: that of cubics through its places with its tangents."""
    chord = curve[..., 1:] - curve[..., :-1]
    first, last = _tamed(chord, rate[..., :-1], rate[..., 1:])
    steps = np.zeros(chord.shape)
    for node, weight in zip(NODES, WEIGHTS, strict=True):
        t = 0.5 * (node + 1.0)
        slope = 6.0 * t * (1.0 - t) * chord + (1.0 - t) * (1.0 - 3.0 * t) * first + t * (3.0 * t - 2.0) * last
        steps += 0.5 * weight * np.abs(slope)
    joined = pieces[..., 1:] == pieces[..., :-1]
    total = np.zeros(curve.shape)
    for k in range(chord.shape[-1]):  # each piece begins at zero
        total[..., k + 1] = np.where(joined[..., k], total[..., k] + steps[..., k], 0.0)
    return np.asarray(np.where(pieces < 0, np.nan, total))
