"""What is said of reactions: what acts, how fast, what is determined, three checks, and the extremes of each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.masses import massless_links
from centrode.errors import Status
from centrode.kinematics.several_drives.holding import unit_of_value
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.names import body_word
from centrode.model.spoken import reaction_name, side_name
from centrode.quantities import status_word
from centrode.study.forces.rubbing import friction_rows
from centrode.study.wording import value_text

if TYPE_CHECKING:
    import xarray

Rows: TypeAlias = list[tuple[str, str]]
Table: TypeAlias = tuple[list[str], list[list[str]]]
Array: TypeAlias = npt.NDArray[np.float64]
Named: TypeAlias = tuple[str, str, str, Array]
"""A key that no language changes, the name, the unit, and values (samples) or (samples, 2)."""
CHECKS = ("equilibrium_residual", "frame_residual", "power_residual")
ROUNDING = 1e-12
"""Components below this share of the greatest force or moment are shown as zero."""


def reaction_rows(mechanism: Mechanism, found: xarray.Dataset) -> Rows:
    """Masses, speed, statuses, what is not determined, and the worst residuals of three checks."""
    massless = ", ".join(massless_links(mechanism))
    rows = [
        (_("drives"), ", ".join(found["drive"].to_numpy())),
        (_("links with mass"), ", ".join(found["link"].to_numpy()) or _("none")),
        (_("massless links"), massless or _("none")),
        *_speed(mechanism, found),
        (_("samples"), _counts(found["reaction_status"].to_numpy())),
    ]
    if found.attrs["undetermined"]:
        names = found.attrs["undetermined"].split("; ")
        rows.append((_("not determined"), "; ".join(map(reaction_name, names))))
    if "tooth_force" in found:
        absent = np.isnan(found["tooth_force"].sel(axis="x").to_numpy()).all(axis=0)
        gears = ", ".join(found["gear"].to_numpy()[absent])
        known = np.isfinite(found["gear_moment"].to_numpy()).any()
        if gears and known:
            rows.append((_("no tooth force"), _("{gears}: nothing tells the radii").format(gears=gears)))
    rows += friction_rows(found)
    texts = (_("equilibrium of links"), _("sum over the frame"), _("power balance"))
    words = (
        _("off by {share:.1e} of the greatest force"),
        _("off by {share:.1e} of the greatest force from the rates of momentum"),
        _("off by {share:.1e} of the greatest power from virtual work"),
    )
    for text, word, name in zip(texts, words, CHECKS, strict=True):
        rows.append((text, word.format(share=found.attrs[name])))
    return rows


def _counts(status: npt.NDArray[np.int8]) -> str:
    counts = [(Status(code), int(np.sum(status == code))) for code in np.unique(status)]
    return f"{len(status)}: " + ", ".join(f"{status_word(which)} {number}" for which, number in counts)


def _speed(mechanism: Mechanism, found: xarray.Dataset) -> Rows:
    if "drive_rate" not in found:
        return []
    unit = unit_of_value(mechanism, mechanism.drives[0])
    rates = found["drive_rate"].to_numpy()
    low, high = (f"{rate:.6g} {unit}/s" for rate in (np.min(rates), np.max(rates)))
    speed = low if low == high else _("{first} to {last}").format(first=low, last=high)
    text = {
        "machine": _("{speed}, the mean speed of the machine"),
        "steady": _("{speed}, the real speed of the machine"),
        "drive": "{speed}",
    }[found.attrs["rate_from"]]
    return [(_("speed of the drive"), text.format(speed=speed))]


def reaction_extremes(mechanism: Mechanism, found: xarray.Dataset) -> Table:
    """Header and rows: least and greatest of each reaction over the samples, and where; forces by their magnitude."""
    header = [_("reaction"), _("unit"), _("least"), _("at"), _("greatest"), _("at")]
    rows = []
    shown = list(each_reaction(mechanism, found))
    noises = _noises(shown)
    for _key, label, unit, values in shown:
        size = np.hypot.reduce(values, axis=1) if values.ndim == 2 else values
        known = np.flatnonzero(np.isfinite(size))
        if not len(known):
            rows.append([label, unit, _("not determined"), "", "", ""])
            continue
        noise = noises[unit]
        # of values that are alike but for rounding the first
        low = int(known[np.argmax(size[known] <= np.min(size[known]) + noise)])
        high = int(known[np.argmax(size[known] >= np.max(size[known]) - noise)])
        cells = []
        for k in (low, high):
            still = abs(float(size[high] - size[low])) <= noise
            cells += [_number(float(size[k]), noise), "" if still else _place(mechanism, found, k)]
        rows.append([label, unit, *cells])
    return header, rows


def greatest_reaction(mechanism: Mechanism, found: xarray.Dataset) -> Rows:
    """The joint force that is greatest over the samples, in one row; none where none is determined."""
    size = np.hypot.reduce(found["joint_force"].to_numpy(), axis=-1)
    if not np.isfinite(size).any():
        return []
    sample, side = np.unravel_index(np.nanargmax(size), size.shape)
    text = _("{side}: {force:.6g} N at {place}").format(
        side=side_name(str(found["side"].to_numpy()[side])),
        force=size[sample, side],
        place=_place(mechanism, found, int(sample)),
    )
    return [(_("greatest joint force"), text)]


def reactions_at_instant(mechanism: Mechanism, found: xarray.Dataset, sample: int = 0) -> Table:
    """Header and rows of all reactions at one sample: components and magnitude, or the one number.

    In the plane a column of directions follows.
    """
    axes = found["axis"].to_numpy().tolist()
    aside, flat = [""] * len(axes), len(axes) == 2
    header = [_("reaction"), _("unit"), *axes, _("magnitude"), *([_("direction, deg")] if flat else [])]
    rows = []
    shown = list(each_reaction(mechanism, found))
    noises = _noises(shown)
    for _key, label, unit, values in shown:
        here = values[sample]
        noise = noises[unit]
        if not np.all(np.isfinite(here)):
            row = [*aside, _missing(found, sample), ""]
        elif values.ndim == 1:
            row = [*aside, _number(float(here), noise), ""]
        else:
            size = float(np.hypot.reduce(here))
            components = [_number(float(x), ROUNDING * max(size, noise)) for x in here]
            direction = round(float(np.degrees(np.arctan2(here[1], here[0]))), 2) + 0.0
            row = [*components, _number(size, noise), "" if size <= noise else f"{direction:.2f}"]
        rows.append([label, unit, *(row if flat else row[:-1])])
    return header, rows


def _noises(shown: Iterable[tuple[str, str, str, Array]]) -> dict[str, float]:
    """Unit -> what is rounding in that unit, over all reactions that are shown."""
    found: dict[str, float] = {}
    for _key, _label, unit, values in shown:
        greatest = float(np.max(np.abs(values), where=np.isfinite(values), initial=0.0))
        found[unit] = max(found.get(unit, 0.0), ROUNDING * greatest)
    return found


def _missing(found: xarray.Dataset, sample: int) -> str:
    """Why a reaction has no number: the status, or that nothing determines it."""
    status = Status(int(found["reaction_status"].to_numpy()[sample]))
    return _("not determined") if status in (Status.OK, Status.CUT_OFF) else status_word(status)


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


def _number(value: float, noise: float) -> str:
    return f"{0.0 if abs(value) <= noise else value:.6g}"


def _place(mechanism: Mechanism, found: xarray.Dataset, sample: int) -> str:
    """The drive's value at a sample; with several drives, or one by a law, the time: what instants are asked for by."""
    if len(mechanism.drives) > 1 or mechanism.drives[0].speed is None:
        return f"{float(found['time'].to_numpy()[sample]):.6g} s"
    unit = unit_of_value(mechanism, mechanism.drives[0])
    return value_text(float(found["drive_value"].to_numpy()[sample, 0]), unit, mechanism.display)
