"""Segments of a cam's turn in the editor: as rows, added, deleted, with another curve."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from centrode.app.documents import Document, Tables
from centrode.app.patches import Operation, Patch
from centrode.app.quantity_texts import written_quantity
from centrode.app.sketch import list_of_tables, number
from centrode.app.text_changes import TextChanges, spelled_value
from centrode.errors import InputError
from centrode.laws import DWELL, FORMULA
from centrode.locale import _
from centrode.model.cam_cycle import LENGTHS, with_angles_of_segments
from centrode.model.reading import Problems
from centrode.model.settings import Display
from centrode.model.units import number_and_unit
from centrode.render import plain_text
from centrode.views.followers import curve_name

CURVES = (
    "dwell", "uniform", "parabolic", "harmonic", "cycloidal", "3-4-5", "4-5-6-7", "trapezoid", "modified sine",
    "modified trapezoid",
)  # fmt: skip
"""Curves of a segment that need nothing but its ends."""
SHAPES = ("lift", "at_start", "at_end", "through", "degree")
"""Keys of a segment that belong to one kind of curve."""
RISES = {"length": "10 mm", "angle": "20 deg"}
"""Lift at the end of the first segment that rises, where no other one says how far."""
ROOM = "segments"


def lift_kind(tables: Tables) -> str:
    """Kind of quantity of the lift: an oscillating follower swings."""
    follower = tables.get("follower")
    swings = isinstance(follower, Mapping) and follower.get("kind") == "oscillating"
    return "angle" if swings else "length"


def segment_rows(document: Document) -> Iterator[dict[str, Any]]:
    """Segments in the order of the text, right or not: where they begin and end [rad], lifts there [m or rad]."""
    try:
        tables = with_angles_of_segments(document.tables)
    except Problems:
        tables = document.tables
    kind, start, level = lift_kind(tables), 0.0, 0.0
    curves = {curve: plain_text(curve_name(curve), Display()) for curve in CURVES}
    for k, segment in enumerate(list_of_tables(tables, ROOM)):
        stop = start + (number(segment.get("angle"), "angle") or 0.0)
        end = number(segment.get("to"), kind)
        end = level if end is None else end
        curve = str(segment.get("curve", FORMULA))
        yield {
            "path": f"{ROOM}.{k}",
            "from": start,
            "to": stop,
            "kind": DWELL if end == level else "rise" if end > level else "fall",
            "law": curve,
            "start": level,
            "lift": end,
            "laws": list(CURVES),
            "names": {**curves, curve: plain_text(curve_name(curve), Display())},
        }
        start, level = stop, end


def add_segment(patch: Patch, operation: Operation) -> None:
    """Divide a segment: behind it the follower waits for the half of its time. So the turn stays full."""
    number_before, segment = _segment_of(patch, operation, "after")
    key = _length_key(segment)
    half = _scaled_length(patch, segment[key], 0.5, key)
    changes = TextChanges(patch.text)
    changes.set((ROOM, number_before, key), half)
    changes.insert_entry(ROOM, number_before + 1, {key: half, "curve": DWELL})
    patch.text = changes.text
    patch.changed.append(f"{ROOM}.{number_before + 1}")


def delete_segment(patch: Patch, operation: Operation) -> None:
    """Take out a segment; the one before it, or behind the first, takes its part of the turn."""
    k, segment = _segment_of(patch, operation, "segment")
    segments = list_of_tables(patch.document.tables, ROOM)
    if len(segments) < 2:
        raise InputError("", _("a turn has at least one segment"))
    beside = k - 1 if k else 1
    key, rows = _length_key(segments[beside]), list(segment_rows(patch.document))
    own, gone = (rows[one]["to"] - rows[one]["from"] for one in (beside, k))
    changes = TextChanges(patch.text)
    if own > 0.0:
        longer = _sum_of(segments[beside], segment, key)
        if longer is None:
            longer = _scaled_length(patch, segments[beside][key], (own + gone) / own, key)
        changes.set((ROOM, beside, key), longer)
    if not k and "from" in segments[1]:
        changes.remove((ROOM, 1, "from"))
    changes.remove((ROOM, k))
    patch.text = changes.text
    patch.changed.append(f"{ROOM}.{k}")


def set_curve(patch: Patch, operation: Operation) -> None:
    """Give a segment another curve, with the lift that it needs then, and without what only the old one has."""
    k, segment = _segment_of(patch, operation, "segment")
    curve = operation.get("curve")
    if curve not in CURVES:
        raise InputError("", _("expected one of {words}").format(words=", ".join(CURVES)))
    changes = TextChanges(patch.text)
    for key in (*SHAPES, *(("to",) if curve == DWELL else ())):
        if key in segment:
            changes.remove((ROOM, k, key))
    if curve != DWELL and segment.get("to") is None:
        changes.set((ROOM, k, "to"), _lift_beside(patch.document, k))
    changes.set((ROOM, k, "curve"), curve)
    patch.text = changes.text
    patch.changed.append(f"{ROOM}.{k}.curve")


def _segment_of(patch: Patch, operation: Operation, key: str) -> tuple[int, Mapping[str, Any]]:
    """Number and table of the segment that an operation names."""
    segments, k = list_of_tables(patch.document.tables, ROOM), operation.get(key)
    if isinstance(k, bool) or not isinstance(k, int) or not 0 <= k < len(segments):
        raise InputError("", _("there is no such segment"))
    return k, segments[k]


def _length_key(segment: Mapping[str, Any]) -> str:
    """Key that says how long a segment lasts."""
    for key in LENGTHS:
        if segment.get(key) is not None:
            return key
    raise InputError("", _("this part of the text is written in a way that cannot be changed here"))


def _scaled_length(patch: Patch, old: Any, factor: float, key: str) -> Any:
    """How long a segment lasts, times a factor, spelled as it was."""
    if isinstance(old, int | float):
        return factor * old
    known = number_and_unit(str(old))
    if known is not None:
        return f"{spelled_value(factor * float(known[0]))} {known[1]}".strip()
    kind = {"angle": "angle", "share": "ratio", "time": "time"}[key]
    value = number(old, kind)
    if value is None:
        raise InputError("", _("this part of the text is written in a way that cannot be changed here"))
    return written_quantity(patch.sketch, old, factor * value, kind, exactly=True)


def _sum_of(one: Mapping[str, Any], other: Mapping[str, Any], key: str) -> Any:
    """How long two segments last together, digit by digit; None where they are spelled in different ways."""
    known = [number_and_unit(str(segment.get(key))) for segment in (one, other)]
    first, second = known
    if first is None or second is None or first[1] != second[1]:
        return None
    total = math.fsum(float(number_text) for number_text, _unit in (first, second))
    return f"{spelled_value(total)} {first[1]}" if first[1] else total


def _lift_beside(document: Document, k: int) -> Any:
    """Lift at the end of a segment that begins to move: 0 where it stands higher, else as far as others rise."""
    rows = list(segment_rows(document))
    if rows[k]["start"] > 0.0:
        return 0
    kind = lift_kind(document.tables)
    ends = [segment.get("to") for segment in list_of_tables(document.tables, ROOM)]
    lifts = [end for end in ends if (number(end, kind) or 0.0) > 0.0]
    return max(lifts, key=lambda end: number(end, kind) or 0.0, default=RISES[kind])
