"""From the description of a cam to the designs that its parameters lead to, and back to the chosen one."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from centrode.cams.choosing.choice import Choice
from centrode.cams.choosing.problem import Family
from centrode.cams.choosing.tried import Mesh, Trial
from centrode.cams.contacts.line import Contact, Material
from centrode.cams.curvature_laws import derivatives
from centrode.cams.described import law_of
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cams.description import Cam, varied
from centrode.model.cams.values import CONSTANT, POINT
from centrode.model.frozen import FrozenMap

Array = NDArray[np.float64]

STEEPEST = math.radians(60)
"""Of a pressure angle at the start that is to be chosen."""


def contact_of(cam: Cam) -> Contact | None:
    """What presses the roller; None where the description has no contact."""
    if cam.contact is None or cam.roller is None:
        return None
    first = Material(cam.contact.cam.elasticity, cam.contact.cam.poisson)
    other = cam.contact.roller
    second = first if other is None else Material(other.elasticity, other.poisson)
    return Contact(cam.contact.force, cam.contact.width, cam.roller.radius, first, second, cam.contact.outer)


def working_arc(cam: Cam) -> tuple[float, float]:
    """Angles [rad] between which the roller is pressed: where a leg stands, else the whole range.

    A leg stands over ±pi/N, however much further `[mover] working_arc` lets the law hold.
    """
    low = -cam.range.stop if cam.curvature.symmetric else cam.range.start
    high = cam.range.stop
    if cam.mover is None:
        return low, high
    half = math.pi / cam.mover.legs
    return max(low, -half), min(high, half)


def family_of(cam: Cam) -> Family:
    """The designs of a description with `[choose]`; raises InputError where a parameter's range cannot be."""
    choose = cam.choose
    if choose is None:
        what = _("nothing is to be chosen")
        raise InputError("[choose]", what, _("write a table [choose] with parameters and bounds"))
    names = tuple(choose.parameters)
    ends = np.array([choose.parameters[name] for name in names], dtype=float)
    _check_ends(cam, dict(choose.parameters))
    low, high = working_arc(cam)
    mirrored = cam.curvature.symmetric
    mesh = Mesh((0.0 if mirrored else low, high), law_of(cam).breaks, mirrored)
    return Family(
        names, ends[:, 0], ends[:, 1], lambda values: _trial(cam, names, values), mesh, contact_of(cam)
    )


def start_of(cam: Cam, family: Family) -> Array:
    """The parameters' values in the description itself."""
    return np.array([given_value(cam, name) for name in family.names])


def bounds_of(cam: Cam) -> dict[str, float]:
    """Bounds in SI by the names of measures; the admissible stress of the contact where none is given."""
    assert cam.choose is not None
    found = {name: getattr(cam.choose, name) for name in ("stress", "pressure_angle", "size", "lift", "gap")}
    if found["stress"] is None and cam.contact is not None:
        found["stress"] = cam.contact.admissible
    return {name: bound for name, bound in found.items() if bound is not None}


def chosen_cam(cam: Cam, choice: Choice) -> Cam:
    """The description with the chosen parameters."""
    return varied(cam, choice.chosen.parameters)


def _trial(cam: Cam, names: tuple[str, ...], values: Array) -> Trial:
    given = dict(zip(names, values.tolist(), strict=True))
    law = law_of(_with_law(cam, given))
    assert cam.roller is not None or "roller.radius" not in given
    roller = 0.0 if cam.roller is None else cam.roller.radius
    return Trial(
        curvature=lambda phi: derivatives(law, phi)[0],
        radius=given.get("start.radius", cam.start.radius),
        gamma=given.get("start.pressure_angle", cam.start.pressure_angle),
        roller_radius=given.get("roller.radius", roller),
    )


def _with_law(cam: Cam, given: Mapping[str, float]) -> Cam:
    """The description with other numbers in its curvature law, not read once more: a search does it often."""
    found: dict[str, object] = {}
    points, letters = list(cam.curvature.points or ()), dict(cam.curvature.constants)
    for name, value in given.items():
        table, _dot, key = name.partition(".")
        if POINT.fullmatch(name):
            number = int(key.partition(".")[2]) - 1
            points[number] = (points[number][0], value)
            found["points"] = tuple(points)
        elif CONSTANT.fullmatch(name):
            letters[name.rpartition(".")[2]] = value
            found["constants"] = FrozenMap(letters)
        elif table == "curvature":
            found[key] = value
    return cam.model_copy(update={"curvature": cam.curvature.model_copy(update=found)})


def given_value(cam: Cam, name: str) -> float:
    """Number in SI of a description at a path such as "curvature.k0"."""
    table, _dot, key = name.partition(".")
    if POINT.fullmatch(name):
        assert cam.curvature.points is not None
        return float(cam.curvature.points[int(key.partition(".")[2]) - 1][1])
    if CONSTANT.fullmatch(name):
        return cam.curvature.constants[name.rpartition(".")[2]]
    return float(getattr(getattr(cam, table), key))


def _check_ends(cam: Cam, ranges: Mapping[str, tuple[float, float]]) -> None:
    """The ends of the box have to be designs: positive numbers, a roller smaller than its path, no stalled start."""
    lows = {name: ends[0] for name, ends in ranges.items()}
    highs = {name: ends[1] for name, ends in ranges.items()}
    roller = {name: value for name, value in highs.items() if name == "roller.radius"}
    for values in (lows, highs, {**lows, **roller}):
        try:
            end = varied(cam, values)
            law_of(end)
        except InputError as error:
            what = _("an end of a range is no design: {what}").format(what=error.what)
            raise InputError("[choose] parameters", what, error.repair) from None
        if abs(end.start.pressure_angle) > STEEPEST:
            what = _("a pressure angle at the start beyond {most:g} deg is not tried")
            raise InputError(
                "[choose] parameters", what.format(most=math.degrees(STEEPEST)), _("narrow its range")
            )
