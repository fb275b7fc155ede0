"""Which samples a motion is asked at: values of the drive, or times where the drive is a law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.errors import InputError
from centrode.kinematics.law_jumps import Jump, first_jump
from centrode.kinematics.paths import JETS, DrivenBy, Path, unit_of
from centrode.laws import ShaftLaw
from centrode.locale import _
from centrode.model import limits

Array: TypeAlias = npt.NDArray[np.float64]

MAX_TURNS = 500.0
INSIDE = 0.005
"""Share of the reachable range left out at both ends if none is asked for: there speeds are infinite."""

LEAST_JUMP = 1e-9
"""Jumps of a law are told down to this share of 1 rad, or of the greatest length."""


@dataclass(frozen=True)
class Span:
    """Samples of a path: times, the path's parameter there, and its first two derivatives by time."""

    time: Array
    parameter: Array
    rate: Array
    second_rate: Array

    @property
    def accelerates(self) -> bool:
        """Whether the parameter has a second derivative by time anywhere."""
        return bool(self.second_rate.any())


def span_of(
    path: Path,
    samples: int,
    start: float | None,
    stop: float | None,
    reach: tuple[float, float],
    reachable: bool = False,
) -> Span:
    """Evenly spaced samples from start to stop: values of the drive [rad or m], or times [s] where the drive is a law.

    `reach` are the nearest limits: the range of a displacement drive where none is asked for, and that of any drive
    where the `reachable` range is.
    """
    if isinstance(samples, bool) or not 1 <= samples <= limits.SAMPLES:
        raise InputError(
            _("samples"),
            _("{samples} samples were asked for").format(samples=samples),
            _("ask for 1 to {most}").format(most=limits.SAMPLES),
        )
    for name, value in (("from", start), ("to", stop)):
        if value is not None and not np.isfinite(value):
            raise InputError(name, _("the range must be finite"))
    if path.parameter.is_uniform:
        span = _at_values(path, np.linspace(*_range(path, start, stop, reach, reachable), samples))
    elif reachable and None in (start, stop):
        raise InputError(
            "[study] range",
            _("the reachable range is that of one drive at constant speed; here the range is one of time"),
            _("give from and to, or --from and --to"),
        )
    else:
        span = _even_times(path, samples, start, stop)
    _check_extent(path, span)
    return span


def span_at(path: Path, places: Array) -> Span:
    """Samples at given places: values of the drive [rad or m], or times [s] where the drive is a law."""
    if places.ndim != 1 or not 1 <= len(places) <= limits.SAMPLES or not np.isfinite(places).all():
        raise InputError("at", _("it needs finite values of the drive, one or more, in one dimension"))
    span = _at_values(path, places) if path.parameter.is_uniform else _at_times(path, places)
    _check_extent(path, span)
    return span


def _check_extent(path: Path, span: Span) -> None:
    """Refuse a law that jumps or has no value, and what a mesh of nodes cannot cover: ends too far from the start."""
    for one in path.driven:
        jump = _jump(path, one, span.time)
        if jump is not None and np.isfinite(jump.after):
            what = _("its law jumps at t = {time:.9g} s, from {before:.9g} to {after:.9g}")
            raise InputError(
                f"[[drives]] {one.drive.id}",
                what.format(time=jump.time, before=jump.before, after=jump.after),
                _("no drive can jump: join the parts by a ramp or by segments, or ask for another range"),
            )
        if not all(np.isfinite(part).all() for part in _derivatives(one, span.time)):
            raise InputError(
                f"[[drives]] {one.drive.id}",
                _("its law has no finite value with two derivatives everywhere in the range"),
                _("correct the law, or ask for another range"),
            )
        if jump is not None:
            raise InputError(
                f"[[drives]] {one.drive.id}",
                _("its law has no finite value at t = {time:.9g} s").format(time=jump.time),
                _("correct the law, or ask for another range"),
            )
    if path.pace is not None:
        ends = min(path.initial, float(np.min(span.time))), max(path.initial, float(np.max(span.time)))
        turns = path.pace.turns(*ends)
    else:
        turns = float(np.max(np.abs(span.parameter - path.initial))) / (2.0 * np.pi * path.unit)
    if turns > MAX_TURNS:
        raise InputError(
            _("range"),
            _("it reaches too far: {turns:.3g} turns").format(turns=turns),
            _("ask for at most {most:g}").format(most=MAX_TURNS),
        )


def _jump(path: Path, one: DrivenBy, time: Array) -> Jump | None:
    """Where a law first jumps, or has no value, between t = 0, the initial position, and any of the times."""
    least = LEAST_JUMP * unit_of(one.drive, path.scale)
    return first_jump(one.law, min(0.0, float(np.min(time))), max(0.0, float(np.max(time))), least)


def _derivatives(one: DrivenBy, time: Array) -> list[Array]:
    """A drive's value and its first two derivatives by time."""
    with np.errstate(all="ignore"):
        value = one.value(JETS, Jet.variable(time, 2))
    if not isinstance(value, Jet):
        value = Jet((value, 0.0, 0.0))
    return [np.broadcast_to(np.asarray(value.derivative(k), dtype=np.float64), time.shape) for k in range(3)]


def _at_values(path: Path, values: Array) -> Span:
    one, speed = path.driven[0], path.parameter.constant_speed
    if not speed:
        raise InputError(f"[[drives]] {one.drive.id}", _("its speed is zero"), _("give a speed, or a law"))
    ones = np.ones(len(values))
    return Span(path.parameter.times(values, one.start), values, speed * ones, 0.0 * ones)


def _range(
    path: Path, start: float | None, stop: float | None, reach: tuple[float, float], reachable: bool
) -> tuple[float, float]:
    """First and last value of the drive; what is not asked for is one turn, or the reachable range."""
    if path.turns and not reachable:
        first = path.initial if start is None else start
        return first, first + path.forward * 2.0 * np.pi if stop is None else stop
    if start is not None and stop is not None:
        return start, stop
    first, last = _reachable(path, reach)
    return first if start is None else start, last if stop is None else stop


def _reachable(path: Path, reach: tuple[float, float]) -> tuple[float, float]:
    low, high = reach
    if path.turns and np.isinf([low, high]).all():
        return path.initial, path.initial + path.forward * 2.0 * np.pi
    if path.turns:  # a limit on one side only bounds a turn
        low, high = max(low, high - 2.0 * np.pi), min(high, low + 2.0 * np.pi)
    if not np.isfinite(low) or not np.isfinite(high):
        raise InputError(
            f"[[drives]] {path.driven[0].drive.id}",
            _("its range is unlimited"),
            _("say from where to where: --from and --to, or [study] from and to"),
        )
    inside = INSIDE * (high - low)
    return (low + inside, high - inside) if path.forward > 0 else (high - inside, low + inside)


def _even_times(path: Path, samples: int, start: float | None, stop: float | None) -> Span:
    spans = [one.law.span for one in path.driven if one.law.span is not None]
    first = start if start is not None else max((span[0] for span in spans), default=0.0)
    last = stop if stop is not None else min((span[1] for span in spans), default=None)
    if last is None:
        last = _one_turn(path)
    return _at_times(path, np.linspace(first, last, samples))


def _at_times(path: Path, time: Array) -> Span:
    if path.by_time:
        return Span(time, time, np.ones(len(time)), np.zeros(len(time)))
    return Span(time, *_derivatives(path.driven[0], time))


def _one_turn(path: Path) -> float:
    periods = [one.law.period for one in path.driven if isinstance(one.law, ShaftLaw)]
    speeds = [abs(one.drive.speed) for one in path.driven if one.drive.kind == "angle" and one.drive.speed]
    if periods and not speeds:
        return max(periods)
    if not speeds:
        raise InputError(
            "[study]",
            _("the drive is a law of time, and nothing says how long it is to run"),
            _('give to = "2 s" under [study], or --to "2 s"'),
        )
    return 2.0 * np.pi / min(speeds)
