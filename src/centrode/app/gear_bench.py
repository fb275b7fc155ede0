"""What the page of gears shows: the blocking contour of two wheels, and the pair at the place of both sliders."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from centrode import render
from centrode.errors import InputError
from centrode.gears.blocking_contour import BLOCKING, blocking_contour
from centrode.gears.results import bare_geometry, gear_pair
from centrode.locale import _, mark
from centrode.model.gear_pairs import GEAR_PAIRS, GearPair
from centrode.views.gear_pair import CURVES, mesh_parts, sheet

WORDS: Mapping[str, str] = {
    "title": mark("Gear pair"),
    "module": mark("module, mm"),
    "pinion": mark("number of teeth of the pinion"),
    "wheel": mark("number of teeth of the wheel"),
    "internal": mark("internal gearing"),
    "first": mark("shift of the pinion"),
    "second": mark("shift of the wheel"),
    "contour": mark("Blocking contour"),
    "mesh": mark("Teeth in mesh"),
    "possible": mark("possible shifts"),
    "text": mark("Description"),
    "lost": mark("the connection to centrode is lost"),
}
"""Labels of the page by their names in it."""
DIGITS = 6
"""Significant digits of places in a picture."""


def gear_answer(message: Mapping[str, Any]) -> dict[str, Any]:
    """The answer to a message of the page: its words, the contour or the pair, as it wants.

    Raises InputError for a pair that is none, MotionError for wheels that cannot mesh.
    """
    want = message.get("want")
    if want == "words":
        return {"words": {name: _(word) for name, word in WORDS.items()}}
    if want not in ("contour", "pair"):
        raise InputError("", _("the server does not know this request"))
    described = _described_pair(message.get("pair"))
    return _contour(described) if want == "contour" else _pair(described)


def _described_pair(given: object) -> GearPair:
    if not isinstance(given, Mapping):
        raise InputError("", _("the message names no description"))
    keys = ("module", "teeth", "internal", "shifts")
    tables = {key: given[key] for key in keys if key in given}
    if isinstance(tables.get("teeth"), list) and "rack" in tables["teeth"]:
        raise InputError("teeth", _("a rack has no blocking contour"), _("give a number of teeth"))
    display = {"length": "mm", "angle": "deg"}
    return GEAR_PAIRS.from_tables({"kind": "gear pair", "display": display, **tables})


def _contour(described: GearPair) -> dict[str, Any]:
    contour = blocking_contour(bare_geometry(described))
    inside = contour.possible > 0
    return {
        "first": [float(contour.first[0]), float(contour.first[-1])],
        "second": [float(contour.second[0]), float(contour.second[-1])],
        "inside": ["".join("1" if one else "0" for one in row) for row in inside.T.tolist()],
        "curves": [
            {
                "name": name,
                "label": str(render.screen_text(CURVES[name], described.display)),
                "blocks": name in BLOCKING,
                "lines": _lines(places),
            }
            for name, places in contour.curves.items()
            if len(places)
        ],
    }


def _lines(places: np.ndarray[Any, np.dtype[np.float64]]) -> list[list[list[float]]]:
    """Parts of a curve, which rows of NaN part."""
    lines: list[list[list[float]]] = [[]]
    for x, y in places.tolist():
        if math.isnan(x):
            lines.append([])
        else:
            lines[-1].append([_short(x), _short(y)])
    return [line for line in lines if line]


def _short(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def _pair(described: GearPair) -> dict[str, Any]:
    results = gear_pair(described)
    made = sheet(results)
    display = described.display

    def words(text: Any) -> str:
        return str(render.screen_text(text, display))

    pieces, circles, action = mesh_parts(results)
    said = [words(note) for note in made.notes]
    if made.failure is not None:
        said.insert(0, f"{words(made.failure.what)}; {words(made.failure.repair)}")
    return {
        "facts": [[words(fact.label), words(fact.value)] for fact in made.facts],
        "problems": said,
        "works": made.failure is None,
        "teeth": [
            {"wheel": int(piece.layer != "profile"), "line": _places(piece.places)} for piece in pieces
        ],
        "circles": [_places(circle) for circle in circles],
        "action": _places(action),
        "pitch": results.geometry.wheels[0].working_pitch / 2 * 1e3,
        "text": GEAR_PAIRS.text(described),
    }


def _places(places: np.ndarray[Any, np.dtype[np.float64]]) -> list[list[float]]:
    """Places in millimetres."""
    return [[_short(x), _short(y)] for x, y in (places * 1e3).tolist() if math.isfinite(x + y)]
