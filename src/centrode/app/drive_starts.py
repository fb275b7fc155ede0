"""Starts of drives that a drag in their space leaves: what of the text begins elsewhere with them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from centrode.app.drive_space import DrivenPosition, angle_at, initial_values, position_at, starts_of
from centrode.app.edit_drags import (
    STANDS,
    Assignment,
    follows_from_points,
    near_angle,
    value_at_place,
    written_position,
)
from centrode.app.patches import Operation, Patch
from centrode.app.quantity_texts import written_quantity
from centrode.app.sketch import SketchParts, drive_name, number
from centrode.errors import InputError
from centrode.kinematics.preparation import Ready, ready
from centrode.locale import _
from centrode.model.description import coordinate_of_drive
from centrode.model.files import with_values
from centrode.model.reading import Place

UNCHANGED = 1e-9
"""Starts [rad or m] that differ by less are the same."""


def set_starts(patch: Patch, operation: Operation) -> None:
    """Let all drives start at other values [rad or m], and with them everything that the text places."""
    sketch, wished = patch.sketch, operation.get("drives")
    prepared = sketch.document.position
    values = {} if prepared is None else initial_values(prepared)
    if prepared is None or not isinstance(wished, Mapping) or set(wished) != set(values):
        raise InputError("", _("the server does not know these drives"))
    if not all(isinstance(one, int | float) and math.isfinite(one) for one in wished.values()):
        raise InputError("", _("a number is needed"))
    position = position_at(prepared, {name: float(wished[name]) for name in values})
    if not position.is_reached:
        raise InputError("", _("the mechanism cannot stand there"), _("drag it another way"))
    starts = starts_of(sketch, position)
    mechanism = prepared.mechanism
    angles = {
        f"links.{name}.angle": angle_at(prepared, position, name)
        for name, link in mechanism.links.items()
        if link.angle is not None
    }
    numbers = {f"drives.{name}.start": start for name, start in starts.items()}
    there = ready(with_values(mechanism, {**angles, **numbers}))
    _check_stands(there, position, sketch)
    own = dict(_written_starts(sketch, starts))
    if sketch.on_sphere:
        own |= dict(_written_angles(sketch, angles))
    patch.write(*own.items(), *written_position(sketch, there, own.keys()))


def _check_stands(there: Ready, position: DrivenPosition, sketch: SketchParts) -> None:
    """InputError where a description with these starts begins elsewhere: a rack stands where its line says."""
    at = there.assembled.positions.points
    if any(
        math.dist(map(float, at[name]), place) > STANDS * sketch.size
        for name, place in position.points.items()
    ):
        raise InputError(
            "", _("the description says where this begins"), _("change it in the text to begin elsewhere")
        )


def _written_angles(sketch: SketchParts, angles: Mapping[str, float]) -> Iterator[Assignment]:
    """Angles of links on the sphere, which follow from no coordinates."""
    for path, angle in angles.items():
        place: Place = ("links", path.removeprefix("links.").removesuffix(".angle"), "angle")
        old = value_at_place(sketch.tables, place)
        near = near_angle(angle, number(old, "angle"))
        if old is not None and abs(near - (number(old, "angle") or 0.0)) > UNCHANGED:
            yield place, written_quantity(sketch, old, near, "angle")


def _written_starts(sketch: SketchParts, starts: Mapping[str, float]) -> Iterator[Assignment]:
    """Starts that the text states, or that follow from nothing else in it."""
    for k, drive in enumerate(sketch.drives):
        name, link = drive_name(drive), drive.get("link")
        stated = drive.get("start") is not None
        follows = isinstance(link, str) and (
            follows_from_points(sketch, link) or sketch.tables["links"][link].get("angle") is not None
        )
        if name not in starts or (follows and not stated):
            continue
        kind = coordinate_of_drive(drive, sketch.space).kind
        old = number(drive.get("start"), kind) or 0.0
        if abs(starts[name] - old) > UNCHANGED:
            yield ("drives", k, "start"), written_quantity(sketch, drive.get("start"), starts[name], kind)
