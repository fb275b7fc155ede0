"""Instant centres from the relative velocity field, for every pair of bodies and every sample of a motion."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
import xarray as xr

from centrode.analysis.instant_centres.axes import axis_cases, axis_of, axis_speed
from centrode.analysis.instant_centres.bodies import (
    Array,
    Bodies,
    Named,
    Pair,
    Places,
    bodies_of,
    is_spherical,
    vectors,
)
from centrode.analysis.instant_centres.cases import Case, Recogniser
from centrode.analysis.instant_centres.turning_bodies import TurningBodies, turning_bodies_of
from centrode.errors import InputError
from centrode.kinematics.motion import labels_of, named
from centrode.kinematics.solve import GREATEST_RESULT
from centrode.locale import _

NUMBERS = 5
"""Numbers of a result for each pair and sample."""


def instant_centres(motion: xr.Dataset, pairs: Sequence[tuple[str, str]] | None = None) -> xr.Dataset:
    """Instant centres of velocity of pairs of bodies at the samples of a motion.

    Parameters
    ----------
    motion : Dataset
        As `motion` returns it; a batch too.
    pairs : sequence of (body, body), optional
        Names of links, "frame", or sliders ("slider C": a point on a guide without a link of its own). All
        pairs if left out, each the later body against the earlier one.

    Returns
    -------
    Dataset
        `centre` (sample, pair, axis) [m], NaN where it lies at infinity; `centre_direction` (sample, pair,
        axis), there the unit vector towards it; `centre_case` (sample, pair), the number of a `Case`. A pair
        is named "AC,frame". On the sphere `centre` is the end of the instantaneous axis (a unit vector) about
        which the first body turns counter-clockwise, seen from outside, as the drive's value (or time) grows;
        `relative_speed` (sample, pair) [rad/s] is how fast it does.

    Raises
    ------
    InputError
        Unknown or equal bodies, more than fits into memory.

    Notes
    -----
    A relative spin below eps^(2/3) of the motion's greatest velocity over its greatest length is none: the
    centre is then at infinity. A centre is as exact as the velocities over the relative spin.
    """
    bodies = turning_bodies_of(motion) if is_spherical(motion) else bodies_of(motion)
    numbers = numbered(bodies, pairs)
    _check_size(bodies, len(numbers))
    spherical = isinstance(bodies, TurningBodies)
    found = _axes(bodies, numbers) if isinstance(bodies, TurningBodies) else _centres(bodies, numbers)
    front = tuple(map(str, motion["status"].dims))
    labels = [f"{bodies.names[first]},{bodies.names[second]}" for first, second in numbers]
    variables = {
        name: named(
            name, (*front, "pair", "axis")[: values.ndim], values, length_unit="rad" if spherical else "m"
        )
        for name, values in found.items()
    }
    variables["centre_case"][2]["flag_values"] = np.array([case.value for case in Case], dtype=np.int8)
    variables["centre_case"][2]["flag_meanings"] = " ".join(case.name.lower() for case in Case)
    kept = motion[["status"]].assign_coords(drive_value=motion["drive_value"], axis=motion["axis"])
    return kept.assign_coords(pair=labels_of(tuple(labels))).assign(variables)


def _centres(bodies: Bodies, numbers: Sequence[Pair]) -> dict[str, Array]:
    """Centres of a planar motion: places, directions of those at infinity, cases."""
    recogniser = Recogniser(bodies)
    shape = (*bodies.rate.shape, len(numbers))
    centre, direction = np.full((*shape, 2), np.nan), np.full((*shape, 2), np.nan)
    cases = np.zeros(shape, dtype=np.int8)
    for column, pair in enumerate(numbers):
        cases[..., column] = recogniser.cases(pair)
        centre[..., column, :], direction[..., column, :] = _located(bodies, pair, cases[..., column])
    return {"centre": centre, "centre_direction": direction, "centre_case": cases}


def _axes(bodies: TurningBodies, numbers: Sequence[Pair]) -> dict[str, Array]:
    """Axes of a motion on the sphere: their ends, cases, relative speeds."""
    axes = [axis_of(bodies, pair) for pair in numbers]
    return {
        "centre": np.stack(axes, axis=-2),
        "centre_case": np.stack([axis_cases(bodies, pair) for pair in numbers], axis=-1),
        "relative_speed": np.stack(
            [axis_speed(bodies, pair, axis) for pair, axis in zip(numbers, axes, strict=True)], axis=-1
        ),
    }


def _located(bodies: Bodies, pair: Pair, cases: Array) -> tuple[Array, Array]:
    """Places of centres, and directions of those at infinity."""
    moving, spin = bodies.relative(pair)
    finite = (cases != Case.ABSENT) & (cases != Case.REST) & (cases != Case.TRANSLATION)
    with np.errstate(divide="ignore", invalid="ignore"):
        place = bodies.place[..., pair[0]] + 1j * moving / spin
        towards = upward(1j * moving / np.abs(moving))
    return (
        vectors(np.where(finite, place, np.nan)),
        vectors(np.where(cases == Case.TRANSLATION, towards, np.nan)),
    )


def upward(direction: Places) -> Places:
    """Of the two senses of a direction the one that points up, or to the right."""
    down = (direction.imag < 0.0) | ((direction.imag == 0.0) & (direction.real < 0.0))
    return np.asarray(np.where(down, -direction, direction))


def bearing(direction: Sequence[float]) -> float:
    """Angle [deg] of the line in a direction, at least 0 and less than 180; rounding is taken off."""
    angle = float(np.degrees(np.arctan2(direction[1], direction[0]))) % 180.0
    return 0.0 if min(angle, 180.0 - angle) < 1e-9 else angle


def numbered(bodies: Named, pairs: Sequence[tuple[str, str]] | None) -> list[Pair]:
    """Pairs by the numbers of their bodies; all of them, the later body against the earlier one, if left out."""
    if pairs is None:
        return [(second, first) for first, second in combinations(range(len(bodies.names)), 2)]
    found = []
    for first, second in pairs:
        pair = bodies.number(first), bodies.number(second)
        if pair[0] == pair[1]:
            raise InputError(
                "pair", _("{name} has no centre against itself").format(name=first), _("name two bodies")
            )
        found.append(pair)
    return found


def _check_size(bodies: Named, pairs: int) -> None:
    samples = int(bodies.rate.size)
    if NUMBERS * pairs * samples > GREATEST_RESULT:
        raise InputError(
            "pairs",
            _("{pairs} pairs at {samples} samples are more than fits into memory").format(
                pairs=pairs, samples=samples
            ),
            _('name the pairs that matter, as in pairs=[("AC", "frame")], or ask for fewer samples'),
        )
