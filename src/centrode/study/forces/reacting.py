"""What is said of reactions: what acts, how fast, what is determined, three checks, and the extremes of each."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.masses import massless_links
from centrode.errors import Status
from centrode.locale import _
from centrode.model.labels import reaction_name, side_name
from centrode.model.mechanism import Mechanism
from centrode.quantities import status_word
from centrode.study.forces.named_reactions import ROUNDING, Array, each_reaction
from centrode.study.forces.rubbing import friction_rows
from centrode.study.wording import value_text

if TYPE_CHECKING:
    import xarray

Rows: TypeAlias = list[tuple[str, str]]
Table: TypeAlias = tuple[list[str], list[list[str]]]
CHECKS = ("equilibrium_residual", "frame_residual", "power_residual")


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
    unit = mechanism.motion_parameter.drives[0].speed_unit
    rates = found["drive_rate"].to_numpy()
    low, high = (f"{rate:.6g} {unit}" for rate in (np.min(rates), np.max(rates)))
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


def _number(value: float, noise: float) -> str:
    return f"{0.0 if abs(value) <= noise else value:.6g}"


def _place(mechanism: Mechanism, found: xarray.Dataset, sample: int) -> str:
    """The drive's value at a sample; with several drives, or one by a law, the time: what instants are asked for by."""
    parameter = mechanism.motion_parameter
    at = float(parameter.instants(found)[sample])
    if not parameter.is_uniform:
        return f"{at:.6g} {parameter.instant.unit}"
    return value_text(at, parameter.instant.unit, mechanism.display)
