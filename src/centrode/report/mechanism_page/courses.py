"""The curves that a page can draw: for each what it is called, its unit, and where the program of the page has it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism
from centrode.quantities import QUANTITIES
from centrode.render.document.numbers import Numbers

OF_POINTS = ("position", "velocity", "acceleration", "velocity_coefficient", "acceleration_coefficient")
LETTERS: Mapping[str, str] = {"position": ""}
"""Letter before the name of an axis; that of the quantity where it is another."""


def courses_of(mechanism: Mechanism, data: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Every quantity of the program by the point, or of all links together, as plain data of the page."""
    numbers = Numbers(mechanism.display)
    quantities = {one["name"]: one for one in data["quantities"]}
    found: list[dict[str, Any]] = []
    for point in data["points"][data["fixed"] :]:
        for name in OF_POINTS:
            if name in quantities:
                found.append(_of_point(quantities[name], point, data, numbers))
    for quantity in quantities.values():
        if quantity["name"] not in OF_POINTS:
            found += _of_parts(quantity, data, numbers)
    return found


def chosen_courses(
    mechanism: Mechanism, courses: Sequence[Mapping[str, Any]], data: Mapping[str, Any]
) -> list[str]:
    """The curves that a page opens with: what the last point does, and how fast the links turn."""
    keys = [str(one["key"]) for one in courses]
    moving = data["points"][data["fixed"] :]
    guided = [guide.point for guide in mechanism.guides if guide.on == FRAME and guide.point in moving]
    last = (guided or moving)[-1:]
    wished = [f"{name}.{point}" for point in last for name in ("position", "velocity", "acceleration")]
    wished.append("angular_velocity" if "angular_velocity" in keys else "joint_velocity")
    wished.append("reduced_moment")
    return [key for key in wished if key in keys]


def _unit(quantity: Mapping[str, Any], numbers: Numbers) -> dict[str, Any]:
    factor, label = numbers.shown(quantity["unit"])
    return {"unit": label, "factor": factor}


def _title(quantity: Mapping[str, Any]) -> str:
    return QUANTITIES[quantity["name"]].title


def _of_point(
    quantity: Mapping[str, Any], point: str, data: Mapping[str, Any], numbers: Numbers
) -> dict[str, Any]:
    """A vector of a point: its components and its size."""
    name, place = quantity["name"], data["points"].index(point)
    symbol = quantity["symbol"]

    def component(axis: str) -> str:
        return f"{axis}({point})" if name == "position" else f"{symbol}_{axis}({point})"

    return {
        "key": f"{name}.{point}",
        "group": _("point {name}").format(name=point),
        "label": f"{point}: {_title(quantity)}",
        "size": "" if name == "position" else f"|{symbol}|({point})",
        "parts": [
            {"quantity": name, "index": [place, k], "label": component(axis)}
            for k, axis in enumerate(data["axes"])
        ],
        **_unit(quantity, numbers),
    }


def _of_parts(
    quantity: Mapping[str, Any], data: Mapping[str, Any], numbers: Numbers
) -> Iterator[dict[str, Any]]:
    """A quantity of all links, guides or joints together; of vectors one course for each link."""
    kind, *axes = quantity["dimensions"] or ["whole"]
    if kind == "whole":
        own = {"group": _("mechanism"), "size": "", **_unit(quantity, numbers)}
        part = {"quantity": quantity["name"], "index": [], "label": quantity["symbol"]}
        yield {**own, "key": quantity["name"], "label": _title(quantity), "parts": [part]}
        return
    names = {
        "link": data["links"],
        "guide": data["guides"],
        "joint": data["joints"],
        "rolling": data["rolling"],
        "hinge": data["hinges"],
    }.get(kind)
    if not names:
        return
    links, wheels = _("links"), _("wheels")
    groups = {"link": links, "hinge": links, "joint": links, "guide": _("guides"), "rolling": wheels}
    own = {"group": groups[kind], "size": "", **_unit(quantity, numbers)}
    name, symbol = quantity["name"], quantity["symbol"]
    if not axes:
        parts = [{"quantity": name, "index": [k], "label": f"{symbol}({one})"} for k, one in enumerate(names)]
        yield {**own, "key": name, "label": _title(quantity), "parts": parts}
    elif axes == ["axis"]:
        for k, one in enumerate(names):
            parts = [
                {"quantity": name, "index": [k, j], "label": f"{symbol}_{axis}({one})"}
                for j, axis in enumerate(data["axes"])
            ]
            size = f"|{symbol}|({one})"
            yield {
                **own,
                "size": size,
                "key": f"{name}.{one}",
                "label": f"{one}: {_title(quantity)}",
                "parts": parts,
            }
