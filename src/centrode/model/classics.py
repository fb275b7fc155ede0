"""Classic mechanisms of the plane by their lengths: the fixed pivot O in the origin, the crank OA driven at 1 rad/s.

Lengths are numbers [m] or texts with a unit. Angles are counter-clockwise from the x axis, on which the
second fixed pivot D lies; `start` [rad] is the crank's angle at t = 0, chosen so that the mechanism
assembles where it is left out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.units import to_si

Length = float | str


def four_bar(
    crank: Length,
    coupler: Length,
    rocker: Length,
    ground: Length,
    *,
    start: float | str | None = None,
    side: str = "left",
    speed: float | str = 1.0,
) -> Mechanism:
    """Four-bar linkage O-A-B-D: crank OA, coupler AB, rocker DB, D on the x axis.

    `side` is that of B from the line A -> D. With phi and psi the angles of OA and DB it obeys
    K1 cos psi - K2 cos phi + K3 = cos(phi - psi), where K1 = ground/crank, K2 = ground/rocker and
    K3 = (crank^2 - coupler^2 + rocker^2 + ground^2) / (2 crank rocker) (F. Freudenstein, Trans. ASME 76,
    1954, 483-492; angles from O towards D). Raises InputError for lengths that close at no angle.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.check(ct.four_bar(1, 3.5, 3, 4)).formula
    'I(crank) -> II(coupler, rocker)'
    """
    a, b, c, d = _lengths(crank=crank, coupler=coupler, rocker=rocker, ground=ground)
    return _driven(
        "Four-bar linkage",
        _four_bar_start(a, b, c, d) if start is None else start,
        speed,
        frame={"points": {"O": [0, 0], "D": [d, 0]}},
        links={"crank": _link("OA", a), "coupler": _link("AB", b), "rocker": _link("DB", c)},
        assembly={"sides": {"B": side}},
    )


def parallelogram(
    crank: Length, ground: Length, *, start: float | str = 1.0, speed: float | str = 1.0
) -> Mechanism:
    """Parallelogram O-A-B-D: the coupler AB stays parallel to OD, the rocker DB to the crank OA."""
    a, d = _lengths(crank=crank, ground=ground)
    angle = to_si(start, "angle")
    return _driven(
        "Parallelogram",
        angle,
        speed,
        frame={"points": {"O": [0, 0], "D": [d, 0]}},
        links={
            "crank": _link("OA", a, angle),
            "coupler": _link("AB", d, 0.0),
            "rocker": _link("DB", a, angle),
        },
    )


def slider_crank(
    crank: Length,
    coupler: Length,
    offset: Length = 0.0,
    *,
    start: float | str | None = None,
    side: str = "ahead",
    speed: float | str = 1.0,
) -> Mechanism:
    """Slider-crank: crank OA, coupler AB, B slides along y = offset.

    x_B = crank cos phi +- sqrt(coupler^2 - (offset - crank sin phi)^2), plus where B is "ahead" of A along
    the x axis (J. J. Uicker, G. R. Pennock, J. E. Shigley, Theory of Machines and Mechanisms, offset
    slider-crank). Raises InputError for lengths that close at no angle.

    Examples
    --------
    >>> import centrode as ct
    >>> float(ct.motion(ct.slider_crank(1, 3), at=[0.0]).position.sel(point="B", axis="x")[0])
    4.0
    """
    a, b = _lengths(crank=crank, coupler=coupler)
    e = to_si(offset, "length")
    if abs(e) >= a + b:
        raise InputError(
            "slider_crank", _("crank and coupler do not reach a guide with this offset"), _("shorten it")
        )
    lifted = math.asin(max(-1.0, min(1.0, e / a))) if abs(e) >= b else 0.0
    return _driven(
        "Slider-crank",
        lifted if start is None else start,
        speed,
        frame={"points": {"O": [0, 0]}},
        links={"crank": _link("OA", a), "coupler": _link("AB", b)},
        guides=[{"point": "B", "on": "frame", "through": [0, e], "direction": [1, 0]}],
        assembly={"sides": {"B": side}},
    )


def inverted_slider_crank(
    crank: Length,
    ground: Length,
    offset: Length = 0.0,
    *,
    start: float | str | None = None,
    side: str = "ahead",
    speed: float | str = 1.0,
) -> Mechanism:
    """Inverted slider-crank: crank OA, A slides along a line of the rocker, which turns about D.

    In the rocker's axes the line is y = offset; with s the displacement along it
    A - D = R(psi) (s, offset), s = +-sqrt(|A - D|^2 - offset^2), plus where A is "ahead" of D.
    With the crank longer than the ground the rocker turns fully (Whitworth). Raises InputError where A
    never comes as far from D as the offset.
    """
    a, d = _lengths(crank=crank, ground=ground)
    e = to_si(offset, "length")
    if abs(e) >= a + d:
        raise InputError(
            "inverted_slider_crank", _("the crank does not reach the slot with this offset"), _("shorten it")
        )
    return _driven(
        "Inverted slider-crank",
        (math.pi / 2 if math.hypot(a, d) > abs(e) else math.pi) if start is None else start,
        speed,
        frame={"points": {"O": [0, 0], "D": [d, 0]}},
        links={"crank": _link("OA", a), "rocker": {"points": {"D": [0, 0]}}},
        guides=[{"point": "A", "on": "rocker", "through": [0, e], "direction": [1, 0]}],
        assembly={"sides": {"A": side}},
    )


def scotch_yoke(crank: Length, *, start: float | str = 0.0, speed: float | str = 1.0) -> Mechanism:
    """Scotch yoke: the crank's pin A slides in an upright slot of the yoke; x_H = crank cos phi."""
    (a,) = _lengths(crank=crank)
    return _driven(
        "Scotch yoke",
        start,
        speed,
        frame={"points": {"O": [0, 0]}},
        links={"crank": _link("OA", a), "yoke": {"points": {"H": [0, 0]}}},
        guides=[
            {"point": "H", "on": "frame", "through": [0, 0], "direction": [1, 0], "link": "yoke"},
            {"point": "A", "on": "yoke", "through": "H", "direction": [0, 1]},
        ],
    )


def _driven(title: str, start: float | str, speed: float | str, **parts: Any) -> Mechanism:
    drive = {"link": "crank", "start": start, "speed": speed}
    return Mechanism(title=title, drives=[drive], **parts)


def _link(points: str, length: float, angle: float | None = None) -> Mapping[str, Any]:
    given = {"points": list(points), "length": length}
    return given if angle is None else {**given, "angle": angle}


def _lengths(**given: Length) -> tuple[float, ...]:
    """Lengths in metres; the names of the arguments stand in the messages."""
    lengths = []
    for name, value in given.items():
        try:
            length = to_si(value, "length")
        except InputError as error:
            raise InputError(name, error.what, error.repair) from None
        if length <= 0:
            raise InputError("", _("{key} must be positive, got {value}").format(key=name, value=value))
        lengths.append(length)
    return tuple(lengths)


def _four_bar_start(a: float, b: float, c: float, d: float) -> float:
    """A crank angle at which coupler and rocker meet at an angle: 0, else the middle of the reach of A from D."""
    least, most = max(abs(d - a), abs(b - c)), min(a + d, b + c)
    if least >= most:
        repair = _("no length may exceed the sum of the others")
        raise InputError("four_bar", _("the lengths close at no angle of the crank"), repair)
    if abs(b - c) < abs(d - a) * (1 - 1e-9) and abs(d - a) < (b + c) * (1 - 1e-9):
        return 0.0
    middle = (least**2 + most**2) / 2
    return math.acos((a * a + d * d - middle) / (2 * a * d))
