"""Segments of a cam by shares of its cycle or by times: the angles that follow from them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from centrode.locale import _
from centrode.model.reading import Problem, Problems, value_text
from centrode.model.values import positive

Tables = Mapping[str, Any]

LENGTHS = ("angle", "share", "time")
"""What says how long a segment lasts: the angle of the cam, its share of a turn, or time."""


def with_angles_of_segments(data: Tables) -> Tables:
    """Tables of a cam in which every segment has its angle, in place of its share of the cycle or its time.

    Times need the speed of the cam; where all segments have times, the cycle lasts as long as all of them together, and
    the speed follows.

    Raises
    ------
    Problems
        A segment with two lengths, a length that is no number, or times without a speed.
    """
    segments = data.get("segments")
    if not isinstance(segments, list | tuple) or not any(map(_is_timed, segments)):
        return data
    wrong: list[Problem] = []
    shares = [_share(entry, number, wrong) for number, entry in enumerate(segments)]
    times = [_time(entry, number, wrong) for number, entry in enumerate(segments)]
    body = data.get("cam", data.get("body"))
    speed = _speed(body)
    changed = dict(data)
    if speed is None and any(time is not None for time in times):
        if any(time is None for time in times):
            what = _("a segment lasts a time, and the cam has no speed")
            wrong.append(
                Problem(what, _("give the speed of the cam, or the times of all segments"), ("segments",))
            )
        else:
            speed = math.tau / math.fsum(time for time in times if time is not None)
            key = "cam" if "cam" in data or "body" not in data else "body"
            if body is None or isinstance(body, Mapping):
                changed[key] = {**(body or {}), "speed": speed}
    if wrong:
        raise Problems(wrong)
    rows: list[Any] = []
    for entry, share, time in zip(segments, shares, times, strict=True):
        if time is not None and speed is not None:
            share = time * speed / math.tau
        rows.append(entry if share is None else _with_angle(entry, math.tau * share))
    return {**changed, "segments": rows}


def _is_timed(entry: Any) -> bool:
    return isinstance(entry, Mapping) and any(entry.get(key) is not None for key in ("share", "time"))


def _with_angle(entry: Tables, angle: float) -> Tables:
    """A segment with its angle, as a text with its unit, which reads back exactly: a file may refuse bare angles."""
    rest = {key: value for key, value in entry.items() if key not in ("share", "time")}
    return {"angle": f"{angle!r} rad", **rest}


def _share(entry: Any, number: int, wrong: list[Problem]) -> float | None:
    if not isinstance(entry, Mapping):
        return None
    given = [key for key in LENGTHS if entry.get(key) is not None]
    if len(given) > 1:
        what = _("{names} are given together").format(names=", ".join(given))
        wrong.append(Problem(what, _("keep one of them"), ("segments", number)))
    share = _number(entry, "share", "ratio", number, wrong)
    if share is not None and share > 1.0:
        what = _("a share of the cycle is at most 1, got {value}").format(value=value_text(entry["share"]))
        wrong.append(Problem(what, _("correct it"), ("segments", number, "share")))
    return share


def _time(entry: Any, number: int, wrong: list[Problem]) -> float | None:
    return _number(entry, "time", "time", number, wrong) if isinstance(entry, Mapping) else None


def _number(entry: Tables, key: str, kind: str, number: int, wrong: list[Problem]) -> float | None:
    if entry.get(key) is None:
        return None
    try:
        return positive(entry[key], kind)
    except Problem as problem:
        wrong.append(Problem(problem.what, problem.repair, ("segments", number, key)))
        return None


def _speed(body: Any) -> float | None:
    """The speed of a cam; what is wrong with it is said where it is read."""
    given = body.get("speed") if isinstance(body, Mapping) else getattr(body, "speed", None)
    if given is None:
        return None
    try:
        return positive(given, "angular speed")
    except Problem:
        return None
