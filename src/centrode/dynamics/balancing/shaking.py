"""Shaking force and shaking moment of a mechanism as a labelled result, with their harmonics."""

from __future__ import annotations

from math import tau
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.balancing.harmonics import Harmonics, harmonics_of
from centrode.dynamics.balancing.inertial import Array, Effects, Pace, effects_of, tracks_of
from centrode.dynamics.balancing.instants import Speed, check_speed, on_sphere
from centrode.dynamics.balancing.turning import Turning, heavy, top
from centrode.dynamics.states import Moving, State
from centrode.dynamics.steady_motion.solution import solution_of
from centrode.dynamics.steady_motion.steady import turned_at
from centrode.errors import InputError, MotionError
from centrode.kinematics.dataset import (
    Variable,
    attributes_of,
    coordinates_of,
    judgements_of,
    named,
)
from centrode.kinematics.ready import Ready, ready
from centrode.kinematics.solve import Solved, asked_span, solve
from centrode.kinematics.spans import Span, span_at
from centrode.locale import _, speaking
from centrode.model.mechanism import Mechanism
from centrode.model.problems import nearest, shown

About = str | tuple[float, float]
ORDERS, MOST_ORDERS = 8, 60


def shaking(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    at: npt.ArrayLike | None = None,
    *,
    about: About = (0.0, 0.0),
    speed: Speed = "mean",
    orders: int = ORDERS,
) -> xr.Dataset:
    """Force and moment that the inertia of a mechanism puts on its frame, at the samples of a motion.

    Parameters
    ----------
    samples, start, stop, at
        As for `motion`; in steady motion as for `steady_motion`, over its cycle.
    about : name of a point of the frame, or (x, y) [m]
        What moments are taken about; the frame's origin if left out.
    speed : "mean" or "steady"
        The machine's mean speed, or the drive's own where there is none; or the real one of `steady_motion`.
    orders : int
        Harmonics up to this multiple of the drive's turns.

    Returns
    -------
    Dataset
        `shaking_force` (sample, axis), its size, `shaking_moment`, `inertia_on_drive` (sample); where the drive
        turns all the way round at a constant speed or in steady motion, harmonics by `order` (docs: balancing).

    Raises
    ------
    InputError
        As `motion` does; no link with a mass; a place that is not the frame's.
    NotComputedYet
        The sphere.
    """
    if mechanism.space == "sphere":
        raise on_sphere()
    check_speed(speed)
    if isinstance(orders, bool) or not 1 <= orders <= MOST_ORDERS:
        what = _("{orders} harmonics were asked for").format(orders=orders)
        raise InputError("orders", what, _("ask for 1 to {most}").format(most=MOST_ORDERS))
    centre, masses = place_of(mechanism, about), heavy(mechanism)
    prepared, span = _asked(mechanism, samples, start, stop, at, speed)
    solved = solve(prepared, span)
    state = State.of(solved, Moving(span.time, span.parameter, span.rate))
    effects = effects_of(
        tracks_of(state, masses), masses, Pace(span.rate, span.second_rate), complex(*centre)
    )
    variables = _curves(effects, solved.ready.parameter.units[0], several=prepared.kinematics.path.by_time)
    variables["drive_rate"] = named(
        "drive_rate", ("sample",), span.rate.copy(), solved.ready.parameter.units[0]
    )
    variables["status"] = judgements_of(solved, ())["status"]
    found, facts = _harmonics(mechanism, complex(*centre), speed, orders)
    if prepared.kinematics.path.by_time:
        del variables["drive_rate"]
    attributes = attributes_of(solved) | {"about": list(centre), "speed": speed} | facts
    coordinates = _coordinates(solved, found)
    return xr.Dataset(variables | found, coords=coordinates, attrs=attributes)


def place_of(mechanism: Mechanism, about: About) -> tuple[float, float]:
    """Coordinates of a place of the frame, given by name or by themselves; InputError for any other."""
    if isinstance(about, str):
        if about not in mechanism.frame.points:
            what = _("{name} is no point of the frame").format(name=shown(about))
            raise InputError("about", what, nearest(about, list(mechanism.frame.points)))
        x, y = mechanism.frame.coordinates[about]
        return x, y
    try:
        x, y = (float(number) for number in about)
    except (TypeError, ValueError):
        x = y = np.nan
    if not np.isfinite([x, y]).all():
        raise InputError("about", _("expected a point of the frame, or two finite coordinates in metres"))
    return x, y


def _asked(
    mechanism: Mechanism,
    samples: int | None,
    start: float | None,
    stop: float | None,
    at: npt.ArrayLike | None,
    speed: Speed,
) -> tuple[Ready, Span]:
    """The samples, passed at the speed that is asked for."""
    if speed == "steady":
        if start is not None or stop is not None:
            what = _("steady motion is shown over its cycle")
            raise InputError("speed", what, _("leave the range out, or name values by at"))
        found = solution_of(mechanism)
        turned = turned_at(found, samples, at)
        rate, second = found.speed.at(turned), found.speed.acceleration(turned)
        sense = found.cycle.sense
        return found.prepared, Span(
            found.speed.time(turned), found.cycle.value(turned), sense * rate, sense * second
        )
    prepared = ready(mechanism)
    path = prepared.kinematics.path
    if at is None:
        span = asked_span(prepared, samples, start, stop)
    else:
        span = span_at(path, np.asarray(at, dtype=np.float64))
    if mechanism.machine is not None and path.parameter.is_uniform:
        rate = np.full(len(span.parameter), np.copysign(mechanism.machine.mean_speed, path.forward))
        time = path.parameter.times(span.parameter, path.driven[0].start, rate)
        return prepared, Span(time, span.parameter, rate, 0.0 * rate)
    return prepared, span


def _curves(effects: Effects, unit: str, *, several: bool) -> dict[str, Variable]:
    """Force, its size, moment; what the drive gives, where there is one."""
    force = np.stack([effects.force.real, effects.force.imag], axis=-1)
    found = {
        "shaking_force": named("shaking_force", ("sample", "axis"), force),
        "shaking_force_size": named("shaking_force_size", ("sample",), np.abs(effects.force)),
        "shaking_moment": named("shaking_moment", ("sample",), effects.moment),
    }
    if not several:
        found["inertia_on_drive"] = named("inertia_on_drive", ("sample",), effects.driving, unit)
    return found


def _coordinates(solved: Solved, found: dict[str, Variable]) -> dict[str, Any]:
    kept = {name: value for name, value in coordinates_of(solved).items() if name in ("drive", "axis")}
    kept |= {name: coordinates_of(solved)[name] for name in ("time", "drive_value")}
    return kept | ({"order": found.pop("order")} if "order" in found else {})


def _harmonics(
    mechanism: Mechanism, about: complex, speed: Speed, orders: int
) -> tuple[dict[str, Variable], dict[str, Any]]:
    """Variables by order and facts of the whole cycle; without a cycle only the reason."""
    try:
        with speaking("en"):  # what results keep
            turning = Turning.of(mechanism, about, speed)
            harmonics = harmonics_of(turning, orders)
            greatest = greatest_of(turning)
    except (InputError, MotionError) as failure:
        return {}, {"no_harmonics": failure.what}
    facts = {
        "turns_of_cycle": turning.turns,
        "harmonics_nodes": harmonics.nodes,
        "harmonics_error": harmonics.error,
        **greatest,
    }
    return variables_of(harmonics), facts


def greatest_of(turning: Turning) -> dict[str, float]:
    """Greatest force, moment and driving moment of inertia over the cycle, between samples too, and where."""
    facts: dict[str, float] = {}
    for name, curve in (
        ("shaking_force", lambda q: np.abs(turning.effects(q).force)),
        ("shaking_moment", lambda q: np.abs(turning.effects(q).moment)),
        ("inertia_on_drive", lambda q: np.abs(turning.effects(q).driving)),
    ):
        found = top(curve, turning.nodes)
        facts |= {f"greatest_{name}": found.value, f"greatest_{name}_at": found.at % (tau * turning.turns)}
    return facts


def variables_of(harmonics: Harmonics) -> dict[str, Variable]:
    """Coefficients, amplitudes and phases by order: amplitude times cos(order q - phase)."""

    def parts(name: str, cosine: Array, sine: Array, dims: tuple[str, ...]) -> dict[str, Variable]:
        values = {
            "cosine": cosine,
            "sine": sine,
            "amplitude": np.hypot(cosine, sine),
            "phase": np.arctan2(sine, cosine),
        }
        return {f"{name}_{key}": named(f"{name}_{key}", dims, value) for key, value in values.items()}

    cosine, sine = (
        np.stack([x.real, x.imag], axis=-1) for x in (harmonics.force_cosine, harmonics.force_sine)
    )
    return {
        "order": named("order", ("order",), harmonics.orders),
        **parts("force_harmonic", cosine, sine, ("order", "axis")),
        "force_harmonic_greatest": named("force_harmonic_greatest", ("order",), harmonics.force_greatest),
        **parts("moment_harmonic", harmonics.moment_cosine, harmonics.moment_sine, ("order",)),
    }
