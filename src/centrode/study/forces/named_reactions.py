"""Every reaction that tables and figures show: a key, its name in the reader's language, the unit, values."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.locale import _
from centrode.model.labels import side_name
from centrode.model.mechanism import Mechanism
from centrode.model.reading import body_word

if TYPE_CHECKING:
    import xarray

Array: TypeAlias = npt.NDArray[np.float64]
Named: TypeAlias = tuple[str, str, str, Array]
"""A key that no language changes, the name, the unit, and values (samples) or (samples, 2)."""
ROUNDING = 1e-12
"""Components below this share of the greatest force or moment are shown as zero."""


def each_reaction(
    mechanism: Mechanism, found: xarray.Dataset, like: xarray.Dataset | None = None
) -> Iterator[Named]:
    """Everything that a table of reactions shows.

    With other reactions that it is to be `like`, it yields the same as for these.
    """
    like = found if like is None else like
    turning = [guide.id for guide in mechanism.guides if guide.link is not None]
    yield from _hinges(found, like)
    if "centre_force" in found:
        yield from _of(found["centre_force"], like["centre_force"], "held", _("centre on {name}"))
    for variable, dimension, text in (
        ("guide_normal", "guide", _("guide {name}, normal")),
        ("guide_moment", "guide", _("guide {name}, moment")),
        ("gear_moment", "gear", _("gear {name}, on {body}")),
        ("tooth_force", "gear", _("gear {name}, teeth")),
        ("rolling_normal", "rolling", _("wheel {name}, normal")),
        ("rolling_tangential", "rolling", _("wheel {name}, tangential")),
        ("balancing", "drive", _("drive {name} gives")),
    ):
        if variable in found:
            values, known = found[variable], like[variable]
            # a guide without a slider of its own bears no moment
            values = values.sel(guide=turning) if variable == "guide_moment" else values
            yield from _of(values, known, dimension, text)
    if "friction" in found.dims:
        yield from _friction(found)
    yield "frame_force", _("force on the frame"), "N", found["frame_force"].to_numpy()
    yield "frame_moment", _("moment on the frame"), "N m", found["frame_moment"].to_numpy()


def _friction(found: xarray.Dataset) -> Iterator[Named]:
    """Moments and forces of friction, and the efficiency."""
    for label in found["friction"].to_numpy().tolist():
        guide = label.removeprefix("guide ")
        if label == guide:
            values = found["friction_moment"].sel(bearing=label).to_numpy()
            yield (
                f"friction_moment_{label}",
                _("{side}, moment of friction").format(side=side_name(label)),
                "N m",
                values,
            )
        else:
            values = found["friction_force"].sel(guide=guide).to_numpy()
            yield f"friction_force_{guide}", _("guide {name}, friction").format(name=guide), "N", values
    yield "efficiency", _("efficiency"), "", found["efficiency"].to_numpy()


def _of(values: xarray.DataArray, like: xarray.DataArray, dimension: str, text: str) -> Iterator[Named]:
    units = str(values.attrs["units"]).split(", ")
    for number, name in enumerate(values[dimension].to_numpy().tolist()):
        one, unit = values.sel({dimension: name}), units[number % len(units)]
        key = f"{values.name}_{name}"
        if "gear_body" in values.dims:
            for body in values["gear_body"].to_numpy().tolist():
                words = {"first": _("the first"), "second": _("the second"), "carrier": _("the carrier")}
                label = text.format(name=name, body=words[body])
                yield f"{key}_{body}", label, unit, one.sel(gear_body=body).to_numpy()
        elif "axis" not in one.dims or not np.isnan(like.sel({dimension: name}).to_numpy()).all():
            yield key, text.format(name=name), unit, one.to_numpy()


def _hinges(found: xarray.Dataset, like: xarray.Dataset) -> Iterator[Named]:
    """Sides of hinges; of two that are action and reaction one, named after both bodies."""
    points, bodies = found["side_point"].to_numpy(), found["side_link"].to_numpy()
    values, known = found["joint_force"].to_numpy(), like["joint_force"].to_numpy()
    for point in dict.fromkeys(points.tolist()):
        sides = np.flatnonzero(points == point)
        names = [body_word(str(bodies[k])) for k in sides]
        keys = [f"joint_force_{point}/{bodies[k]}" for k in sides]
        if len(sides) == 2 and _opposite(known[:, sides[0]], known[:, sides[1]]):
            label = _("{point}: {other} on {body}").format(point=point, other=names[1], body=names[0])
            yield keys[0], label, "N", values[:, sides[0]]
            continue
        for k, key, name in zip(sides, keys, names, strict=True):
            yield key, _("{point}: pin on {body}").format(point=point, body=name), "N", values[:, k]


def _opposite(one: Array, other: Array) -> bool:
    size = np.nanmax(np.abs(one), initial=0.0)
    return bool(np.array_equal(np.isnan(one), np.isnan(other))) and bool(
        np.nanmax(np.abs(one + other), initial=0.0) <= ROUNDING * size
    )
