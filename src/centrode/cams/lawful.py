"""Whether a curvature is one of a cam over a range: known, finite and positive."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from centrode.cams.curvature_laws import CurvatureLaw, derivatives
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import bisect

Array = NDArray[np.float64]

NODES_OF_A_TURN = 2880
MOST_NODES = 100_000


def check_span(law: CurvatureLaw, start: float, stop: float) -> None:
    """Raise InputError where a law is not defined over a whole range."""
    first, last = law.span
    if first <= start and stop <= last:
        return
    what = _(
        "the curvature is known from {first:.9g} to {last:.9g} deg, the range is {start:.9g} to {stop:.9g} deg"
    )
    told = what.format(
        first=math.degrees(first), last=math.degrees(last), start=math.degrees(start), stop=math.degrees(stop)
    )
    raise InputError("[curvature]", told, _("add points, or shorten the range"))


def unlawful_place(law: CurvatureLaw, stop: float) -> float | None:
    """The first angle [rad] from 0 towards `stop` at which K is not finite and positive; None where it always is.

    Looked for on a mesh of an eighth of a degree, and at the least values between its nodes.
    """
    places = _mesh(law, stop)
    values, slopes = derivatives(law, places, 1)
    lows = _lows(law, places, slopes)
    places = np.concatenate([places, lows])
    values = np.concatenate([values, derivatives(law, lows)[0]])
    order = np.argsort(np.abs(places), kind="stable")
    places, values = places[order], values[order]
    wrong = np.flatnonzero(~_lawful(values))
    if not wrong.size:
        return None
    first = int(wrong[0])
    if not first:
        return float(places[0])
    ends = bisect(
        lambda phi: _lawful(derivatives(law, phi)[0]), places[first - 1 : first], places[first : first + 1]
    )
    return float(ends[1][0])


def lawful(law: CurvatureLaw, phi: float) -> bool:
    """Whether K is finite and positive at an angle."""
    return bool(_lawful(derivatives(law, np.array([phi]))[0])[0])


def refusal(law: CurvatureLaw, phi: float) -> InputError:
    """What is said of a curvature that is not one of a cam at an angle."""
    value = float(derivatives(law, np.array([phi]))[0, 0])
    angle = math.degrees(phi)
    if not math.isfinite(value):
        what = _("the curvature is not a finite number at {angle:.6g} deg").format(angle=angle)
    elif value <= 0 and phi == 0:
        what = _("the curvature is not positive at the start ({value:.4g} 1/m)").format(value=value)
    else:
        what = _("the curvature is not positive from {angle:.6g} deg on").format(angle=angle)
    return InputError("[curvature]", what, _("change the law, or end the range before that angle"))


def _mesh(law: CurvatureLaw, stop: float) -> Array:
    count = min(MOST_NODES, 3 + math.ceil(abs(stop) / (2 * math.pi) * NODES_OF_A_TURN))
    low, high = min(0.0, stop), max(0.0, stop)
    knots = [place for place in law.breaks if low < place < high]
    places = np.unique(np.concatenate([np.linspace(0.0, stop, count), knots]))
    return places if stop >= 0 else places[::-1]


def _lows(law: CurvatureLaw, places: Array, slopes: Array) -> Array:
    """The places of least curvature between nodes, by bisection where the slope changes its sign."""
    sense = 1.0 if places[-1] >= places[0] else -1.0
    down, up = sense * slopes[:-1] < 0, sense * slopes[1:] > 0
    low, high = places[:-1][down & up], places[1:][down & up]
    return bisect(lambda phi: sense * derivatives(law, phi, 1)[1] < 0, low, high)[1]


def _lawful(values: Array) -> NDArray[np.bool_]:
    return np.isfinite(values) & (values > 0)
