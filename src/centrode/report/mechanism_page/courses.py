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
    for quantity in data["reactions"]:
        found += _of_reactions(quantity, data, numbers)
    return found


def chosen_courses(
    mechanism: Mechanism, courses: Sequence[Mapping[str, Any]], data: Mapping[str, Any]
) -> list[str]:
    """The curves that a page opens with: what the last point does, and how fast the links turn."""
    keys = [str(one["key"]) for one in courses]
    moving = data["points"][data["fixed"] :]
    guided = [guide.point for guide in mechanism.guides if guide.on == FRAME and guide.point in moving]
    fixed = set(data["points"][: data["fixed"]])
    # points of links that are hinged to the frame go along arcs
    on_arcs = {point for of_link in data["link_points"].values() if fixed & set(of_link) for point in of_link}
    last = (guided or [point for point in moving if point not in on_arcs] or moving)[-1:]
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


def _of_reactions(
    quantity: Mapping[str, Any], data: Mapping[str, Any], numbers: Numbers
) -> Iterator[dict[str, Any]]:
    """A reaction: of vectors one course for each side, guide, mesh or wheel, of numbers one for all of them."""
    name, symbol = quantity["name"], quantity["symbol"]
    own = {"group": _("reactions"), **_unit(quantity, numbers)}
    *kinds, last = quantity["dimensions"] or ["whole"]
    parts_of = {"axis": data["axes"], "gear_body": data["gear_bodies"]}
    owners = _owners(kinds[0] if kinds else last, data)
    if last not in parts_of:
        parts = [
            {"quantity": name, "index": index, "label": f"{symbol}({told})" if told else symbol}
            for index, told, _label in owners
        ]
        yield {**own, "key": name, "size": "", "label": _title(quantity), "parts": parts}
        return
    for index, told, label in owners:
        of = f"({told})" if told else ""
        title = label if name == "joint_force" else ": ".join(filter(None, (label, _title(quantity))))
        parts = [
            {"quantity": name, "index": [*index, k], "label": f"{symbol}_{each}{of}"}
            for k, each in enumerate(parts_of[last])
        ]
        size = f"|{symbol}|{of}" if last == "axis" else ""
        yield {
            **own,
            "key": ".".join([name, *filter(None, [told])]),
            "size": size,
            "label": title,
            "parts": parts,
        }


def _owners(kind: str, data: Mapping[str, Any]) -> list[tuple[list[int], str, str]]:
    """What a reaction belongs to: its place among others, its name in symbols, and what a reader calls it."""
    if kind == "side":
        return [
            ([k], f"{point}/{body}", _side_words(point, body))
            for k, (point, body) in enumerate(data["sides"])
        ]
    names = {
        "guide": data["guides"],
        "gear": data["gears"],
        "rolling": data["rolling"],
        "drive": [drive["id"] for drive in data["drives"]],
    }.get(kind)
    return [([], "", "")] if names is None else [([k], one, one) for k, one in enumerate(names)]


def _side_words(point: str, body: str) -> str:
    if body == FRAME:
        return _("reaction at {point} on the frame").format(point=point)
    return _("reaction at {point} on link {link}").format(point=point, link=body)
