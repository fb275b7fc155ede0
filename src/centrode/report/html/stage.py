"""A motion as data of a page: in the units of its picture, ready to be drawn and dragged."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from centrode.locale import _
from centrode.render.document.blocks import Moving, Outline, RingBlock
from centrode.render.drawing.colours import CARRIER, GROUND, INK, MARKERS, MUTED, PALETTE
from centrode.report.html.parts import page_data

Array = NDArray[np.float64]
WIDE, TALLEST = 6400, 5200
"""Greatest size of a picture, in tenths of a pixel."""
ROOM = 0.11
"""Room around what is seen, as a part of its extent."""
UNIT = 100_000
"""Of unit vectors."""
SIGN = 55.0
"""Radius of a hinge in the picture; hatching and supports are measured by it."""
SAME = 1e-6
"""A motion is closed where its last picture is the first, within this part of its extent."""


class PictureMap:
    """From places of a motion to places of a picture, whose y points down."""

    def __init__(self, moving: Moving) -> None:
        low, high = _box(moving)
        if moving.view is not None and np.max(high - low) > 1.9:
            low, high = -np.ones(2), np.ones(2)
        extent = float(np.max(high - low)) or 1.0
        low, high = low - ROOM * extent, high + ROOM * extent
        self.scale = float(min(WIDE / (high - low)[0], TALLEST / (high - low)[1]))
        self.low, self.high = low, high
        self.size = [round(self.scale * side) for side in (high - low)]

    def place(self, places: Array) -> Array:
        """Places (..., 2)."""
        return np.stack(
            [
                self.scale * (places[..., 0] - self.low[0]),
                self.scale * (self.high[1] - places[..., 1]),
            ],
            axis=-1,
        )

    def path(self, corners: Array, closed: bool) -> str:
        """Corners (n, 2) of an outline in axes of its own as a path."""
        drawn, pen = "", False
        for x, y in self.scale * corners * np.array([1.0, -1.0]):
            if np.isfinite(x):
                drawn += f"{'L' if pen else 'M'}{x:.0f} {y:.0f}"
            pen = bool(np.isfinite(x))
        return drawn + ("Z" if closed else "")

    def poses(self, poses: Array) -> list[float | None]:
        """Poses (n, 3) as x, y and degrees clockwise, one behind the other."""
        turned = -np.degrees(np.unwrap(np.nan_to_num(poses[:, 2])))
        places = self.place(poses[:, :2])
        rows = np.column_stack([np.round(places), np.round(turned, 2)])
        rows[~np.isfinite(poses).all(axis=1)] = np.nan
        return _numbers(rows)


def stage_of(moving: Moving, still: str) -> str:
    """The element of a motion: its first picture, its controls, and its data, which the page's script reads."""
    data = page_data(_data(moving))
    label = html.escape(_("Mechanism in motion; drag a point, or use the arrow keys"))
    first = moving.drive_texts[moving.start] if moving.drive_texts else ""
    return (
        f'<div class="moving" role="group" aria-label="{label}">'
        f'<div class="paper" tabindex="0" aria-label="{label}">{still}</div>'
        f'{controls_of(first, ticks=_ticks(moving))}<script type="application/json">{data}</script></div>'
    )


PLAY_ICON = (
    '<svg viewBox="0 0 16 16" width="14" height="14" aria-hidden="true">'
    '<path fill="currentColor" d="M3 1l11 7-11 7z"/></svg>'
)
"""Drawn, since fonts lack the signs of players; `animation.js` has the one for a pause."""
_MARKERS = {
    "": "",
    "o": "M-45 0a45 45 0 1 0 90 0a45 45 0 1 0 -90 0Z",
    "s": "M-42 -42H42V42H-42Z",
    "^": "M0 -55L50 38H-50Z",
    "D": "M0 -58L58 0L0 58L-58 0Z",
    "v": "M0 55L50 -38H-50Z",
}
"""Outlines of the markers of links that share a colour, in thousandths of an inch as the picture is."""

SCREEN_COLOURS = {
    **{colour: f"var(--hue-{place})" for place, colour in enumerate(PALETTE)},
    GROUND: "var(--earth)",
    INK: "var(--sign)",
    MUTED: "var(--trace)",
    CARRIER: "var(--carrier)",
}
"""Colours of moving drawings as variables of `motion.css`, which has them for light and dark screens and for paper."""


def controls_of(first: str, more: str = "", ticks: str = "") -> str:
    """The controls of a player; `first` says where it begins, `more` are elements behind its own, `ticks` under it."""

    def word(text: str) -> str:
        return html.escape(text)

    play, back, on = word(_("Play")), word(_("One step back")), word(_("One step on"))
    position, speed, paths, names = word(_("Position")), word(_("speed")), word(_("paths")), word(_("names"))
    seek = f'<input type="range" data-do="seek" min="0" max="1" step="any" aria-label="{position}">'
    if ticks:
        seek = f'<span class="way">{seek}{ticks}</span>'
    return (
        '<div class="controls" hidden>'
        f'<button type="button" data-do="play" title="{play}" aria-label="{play}">{PLAY_ICON}</button>'
        f'<button type="button" data-do="back" title="{back}" aria-label="{back}">\u2039</button>'
        f'<button type="button" data-do="on" title="{on}" aria-label="{on}">\u203a</button>'
        f"{seek}<output>{word(first)}</output>"
        f'<label>{speed} <input type="range" data-do="speed" min="-3" max="2" step="0.5" value="0"></label>'
        f'<label><input type="checkbox" data-do="paths" checked> {paths}</label>'
        f'<label><input type="checkbox" data-do="names" checked> {names}</label>{more}</div>'
    )


def _data(moving: Moving) -> dict[str, Any]:
    """What the script draws."""
    sheet = PictureMap(moving)
    names = list(moving.places)
    samples = len(moving.drive)
    outlines = [one for one in moving.shapes if isinstance(one, Outline)]
    found: dict[str, Any] = {
        "samples": samples,
        "start": moving.start,
        "axes": 3 if moving.view is not None else 2,
        "loop": _is_closed(moving),
        "size": sheet.size,
        "label": moving.caption,
        "points": [_point(moving, sheet, name) for name in names],
        "bodies": [
            {
                "name": name,
                "points": [names.index(one) for one in points if one in moving.places],
                **look_of_link(number),
            }
            for number, (name, points) in enumerate(moving.bodies.items())
        ],
        "grounds": [_ground(sheet, line) for line in moving.guides.values()],
        "shapes": [
            {
                "d": sheet.path(one.corners, one.filled or one.white),
                "at": sheet.poses(one.poses),
                "colour": SCREEN_COLOURS[one.colour],
                "filled": one.filled,
                "white": one.white,
                "line": len(one.corners) == 2,
                "ground": one.colour == GROUND,
                "behind": one.behind,
            }
            for one in outlines
        ],
        "rings": [
            {"at": _vectors(one.poles), "arc": one.arc, "colour": SCREEN_COLOURS[one.colour]}
            for one in moving.shapes
            if isinstance(one, RingBlock)
        ],
        "tracks": [names.index(one) for one in moving.tracks],
        "texts": list(moving.drive_texts),
        "support": support_sign(),
        "words": {"play": _("Play"), "pause": _("Pause")},
        "view": None,
    }
    if moving.view is not None:
        found["view"] = np.round(moving.view, 9).tolist()
        found["centre"] = [round(value) for value in sheet.place(np.zeros(2))]
        found["radius"] = round(sheet.scale)
    return found


TICKS: Mapping[str, str] = {
    "impact": "M-3 0L3 0L0 9Z",
    "stick": "M-3 0H3V6H-3Z",
    "slip": "M-3 6L3 6L0 0Z",
    "close": "M-2.5 0H2.5V9H-2.5Z",
    "open": "M-3 0H3V6H-3ZM-1.5 1.5H1.5V4.5H-1.5Z",
    "user": "M0 0L3 4.5L0 9L-3 4.5Z",
    "other": "M-1 0H1V9H-1Z",
}
"""Outline of the mark of an event by its sign, about its place on the slider [px]."""


def _ticks(moving: Moving) -> str:
    """A strip under the slider with a mark at each event, and what is held shaded; a click goes to the mark."""
    if not (moving.marks or moving.held):
        return ""
    bands = "".join(
        f'<span class="held" style="left:{100 * begin:.2f}%;width:{max(100 * (end - begin), 0.2):.2f}%" '
        f'title="{html.escape(name)}"></span>'
        for begin, end, name in moving.held
    )
    marks = "".join(
        f'<span class="tick {sign}" style="left:{100 * share:.2f}%" data-share="{share:.6f}" '
        f'title="{html.escape(name)}"><svg viewBox="-4 0 8 9" aria-hidden="true"><path fill-rule="evenodd" '
        f'd="{TICKS[sign]}"/></svg></span>'
        for share, name, sign in moving.marks
    )
    said = html.escape(_("Events of the motion"))
    listed = html.escape("; ".join(name for _share, name, _sign in moving.marks))
    return f'<span class="ticks" role="img" aria-label="{said}: {listed}">{bands}{marks}</span>'


def look_of_link(number: int) -> dict[str, str]:
    """Colour and marker of the link that is the `number`-th in the description."""
    return {
        "colour": SCREEN_COLOURS[PALETTE[number % len(PALETTE)]],
        "marker": _MARKERS[MARKERS[number // len(PALETTE) % len(MARKERS)]],
    }


def _point(moving: Moving, sheet: PictureMap, name: str) -> dict[str, Any]:
    places = moving.places[name]
    line = moving.guides.get(moving.sliders.get(name, ""))
    slope = None
    if line is not None and moving.view is None:
        x, y = line[1] - line[0]
        slope = round(-float(np.degrees(np.arctan2(y, x))), 3)
    return {
        "name": name,
        "at": _vectors(places) if moving.view is not None else _numbers(np.round(sheet.place(places))),
        "fixed": name in moving.fixed,
        "driven": name in moving.driven,
        "dot": name in moving.dots,
        "slider": slope,
    }


def _ground(sheet: PictureMap, line: Array) -> str:
    """The hatched line under a slider, on the side that points down or away from the middle."""
    start, end = sheet.place(line)
    way = end - start
    along = way / (float(np.hypot(*way)) or 1.0)
    across = np.array([-along[1], along[0]])
    outward = (start + end) / 2 - np.array(sheet.size) / 2
    aside = across[1] if abs(along[0]) > 0.2 else float(across @ outward)
    away = across if aside >= 0 else -across
    start, end = start + 95 * away - 220 * along, end + 95 * away + 220 * along
    return _hatch(start, end, away)


def support_sign() -> str:
    """The triangle of a fixed hinge on its ground."""
    left, right = np.array([-2.0, 3.2]) * SIGN, np.array([2.0, 3.2]) * SIGN
    over = np.array([0.8 * SIGN, 0.0])
    triangle = f"M0 0L{left[0]:.0f} {left[1]:.0f}L{right[0]:.0f} {right[1]:.0f}Z"
    return triangle + _hatch(left - over, right + over, np.array([0.0, 1.0]))


def _hatch(start: Array, end: Array, away: Array) -> str:
    """A line of the picture with strokes on one side of it."""
    way = end - start
    length = float(np.hypot(*way)) or 1.0
    count = max(2, round(length / (0.9 * SIGN)))
    drawn = f"M{start[0]:.0f} {start[1]:.0f}L{end[0]:.0f} {end[1]:.0f}"
    for number in range(1, count + 1):
        foot = start + number / count * way
        tip = foot + 0.9 * SIGN * (away - way / length)
        drawn += f"M{foot[0]:.0f} {foot[1]:.0f}L{tip[0]:.0f} {tip[1]:.0f}"
    return drawn


def _box(moving: Moving) -> tuple[Array, Array]:
    """Corners of what is seen."""
    if moving.box is not None:
        return moving.box[0], moving.box[1]
    places = [np.asarray(one, dtype=float) for one in moving.places.values()]
    if moving.view is not None:
        places = [one @ moving.view[:2].T for one in places]
    known = np.concatenate([*places, np.zeros((0, 2))])
    known = known[np.isfinite(known).all(axis=1)]
    if not len(known):
        return -np.ones(2), np.ones(2)
    return known.min(axis=0), known.max(axis=0)


def _is_closed(moving: Moving) -> bool:
    """Whether the last picture is the first."""
    tracks = [one for one in moving.places.values() if len(one) > 1]
    if len(moving.drive) < 3 or not tracks:
        return False
    apart = max(float(np.abs(one[-1] - one[0]).max()) for one in tracks)
    known = np.concatenate(tracks)
    return bool(apart <= SAME * max(1e-300, float(np.nanmax(known) - np.nanmin(known))))


def _vectors(places: Array) -> list[float | None]:
    return _numbers(np.round(UNIT * places))


def _numbers(rows: Array) -> list[float | None]:
    """Numbers one behind the other, whole ones without a point; None where one is absent."""
    flat: Sequence[float] = np.asarray(rows, dtype=float).reshape(-1).tolist()
    return [None if value != value else int(value) if value == int(value) else value for value in flat]
