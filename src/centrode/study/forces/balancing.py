"""What is said of counterweights: what was asked, what they are, what they do, and the masses at the joints."""

from __future__ import annotations

from math import degrees, dist
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.dynamics.balancing.balance import Balance
from centrode.dynamics.balancing.counterweights import Counterweight
from centrode.dynamics.balancing.methods import Loop, Share
from centrode.dynamics.masses import massless_links
from centrode.locale import _
from centrode.model.mechanism import Display, Mechanism
from centrode.quantities import display_unit

if TYPE_CHECKING:
    import xarray

Rows: TypeAlias = list[tuple[str, str]]
ORDERS_SHOWN = (1.0, 2.0)
NOTHING = 1e-9
"""An effect below this share of what it was without counterweights is shown as zero: it is rounding."""


def balance_rows(found: Balance) -> Rows:
    """What was asked and the counterweights, in the language and the units of the reader."""
    mechanism = found.mechanism
    massless = ", ".join(massless_links(mechanism))
    rows = [
        (_("balance"), kind_text(found)),
        (_("speed of the drive"), _speed_text(found.before)),
        (_("massless links"), massless or _("none")),
    ]
    for one in found.counterweights:
        rows.append((_("counterweight {link}").format(link=one.link), _one_text(one, mechanism.display)))
    for disc in found.discs:
        text = _("{inertia:.6g} kg m², fixed to it")
        if disc.base is not None:
            text = _("{inertia:.6g} kg m², geared 1 : 1 to turn against it about {base}")
        label = _("disc for {link}").format(link=disc.link)
        rows.append((label, text.format(inertia=disc.inertia, base=disc.base)))
    return [*rows, *_proof_rows(found)]


def kind_text(found: Balance) -> str:
    """How a mechanism was balanced."""
    if found.to == "full":
        both = _("shaking force and shaking moment zero")
        return both if found.discs else _("shaking force zero")
    if found.weights is not None:
        return _weights_text(found.weights)
    said = _("what turns with the crank's pin, and {share:.4g} % of what moves to and fro")
    return said.format(share=100.0 * (found.fraction or 0.0))


def _weights_text(weights: tuple[float, ...]) -> str:
    names = (_("shaking force"), _("shaking moment"), _("moment of the drive"))
    parts = [(name, weight) for name, weight in zip(names, weights, strict=True) if weight]
    if len(parts) == 1:
        return _("the least greatest value: {what}").format(what=parts[0][0])
    total = " + ".join(f"{weight:g} x {name}" for name, weight in parts)
    return _("the least sum of greatest values, each over that without counterweights: {sum}").format(
        sum=total
    )


def _speed_text(data: xarray.Dataset) -> str:
    rates = data["drive_rate"].to_numpy()
    unit = str(data["drive_rate"].attrs["units"])
    low, high = (f"{rate:.6g} {unit}" for rate in (float(np.min(rates)), float(np.max(rates))))
    if data.attrs["speed"] == "steady":
        return _("{first} to {last}, of steady motion").format(first=low, last=high)
    return low


def _one_text(one: Counterweight, display: Display) -> str:
    factor, unit = display_unit("m", display.length)
    if not one.mass:
        return _("none is needed")
    text = _("{mass:.6g} kg, {radius:.6g} {unit} from {base} at {angle:.5g} deg to the link's x axis").format(
        mass=one.mass, radius=one.radius * factor, unit=unit, base=one.base, angle=degrees(one.angle)
    )
    if one.disc is not None:
        disc = _(", a disc of {disc:.6g} {unit} radius").format(disc=one.disc * factor, unit=unit)
        text += disc
    return text + f" ({one.product:.6g} kg m)"


def _proof_rows(found: Balance) -> Rows:
    rows = []
    if found.bound is not None and found.bound > NOTHING * found.before.attrs["greatest_shaking_force"]:
        text = _("no counterweights on these links bring the greatest force below {force:.6g} N")
        rows.append((_("proved"), text.format(force=found.bound)))
    elif found.proved:
        rows.append((_("proved"), _("no counterweights on these links, with these radii, do better")))
    if not found.unique:
        text = _("other counterweights on these links do the same; these have the least products")
        rows.append((_("choice"), text))
    before, after = (data.attrs["greatest_shaking_moment"] for data in (found.before, found.after))
    if after > before * (1.0 + NOTHING):
        text = _("it grows: counterweights that balance the force have inertia of their own")
        rows.append((_("shaking moment"), text))
    return rows


def balance_effects(found: Balance) -> tuple[list[str], list[list[str]]]:
    """Header and rows of a table: the greatest effects over the cycle and the first harmonics, before and after."""
    header = ["", _("unit"), _("before"), _("after"), _("change")]
    x, y = found.before.attrs["about"]
    factor, unit = display_unit("m", found.mechanism.display.length)
    about = _("greatest shaking moment about ({x:.6g}, {y:.6g}) {unit}").format(
        x=x * factor, y=y * factor, unit=unit
    )
    rows = []
    for name, text in (
        ("shaking_force", _("greatest shaking force")),
        ("shaking_moment", about),
        ("inertia_on_drive", _("greatest moment of the drive for the inertia")),
    ):
        before, after = (data.attrs[f"greatest_{name}"] for data in (found.before, found.after))
        rows.append(_row(text, str(found.before[name].attrs["units"]), before, after, before))
    for name, text in (
        ("force_harmonic_greatest", _("shaking force, order {order:g}")),
        ("moment_harmonic_amplitude", _("shaking moment, order {order:g}")),
    ):
        whole = float(found.before[name].max())
        for order in ORDERS_SHOWN:
            before, after = (float(data[name].sel(order=order)) for data in (found.before, found.after))
            unit = str(found.before[name].attrs["units"])
            rows.append(_row(text.format(order=order), unit, before, after, whole))
    masses = [
        sum(link.mass or 0.0 for link in one.links.values()) for one in (found.mechanism, found.balanced)
    ]
    rows.append(_row(_("mass of all links"), "kg", masses[0], masses[1], masses[0]))
    return header, rows


def _row(text: str, unit: str, before: float, after: float, scale: float) -> list[str]:
    before, after = (0.0 if value <= NOTHING * scale else value for value in (before, after))
    change = f"{after / before - 1.0:+.1%}" if before else ""
    return [text, unit, f"{before:.6g}", f"{after:.6g}", change]


def balance_steps(found: Balance) -> list[str]:
    """The way by hand of a slider-crank or a four-bar, as sentences: masses replaced at the joints; none for others."""
    if found.loop is None:
        return []
    loop = found.loop
    return [*(_share_text(share) for share in found.shares), *_sums(found, loop)]


def _share_text(share: Share) -> str:
    text = _(
        "{link}: {first_mass:.6g} kg at {first}, {second_mass:.6g} kg at {second} have its mass and centre"
    )
    said = text.format(
        link=share.link,
        first=share.first,
        second=share.second,
        first_mass=share.at_first.real,
        second_mass=share.at_second.real,
    )
    if abs(share.at_second.imag) > NOTHING * abs(share.at_first + share.at_second):
        beside = _(
            "; its centre is beside the line, as {mass:.6g} kg at {second} turned by a right angle are"
        )
        said += beside.format(mass=share.at_second.imag, second=share.second)
    return said


def _sums(found: Balance, loop: Loop) -> list[str]:
    """Masses at the moving joints, and the products that balance them."""
    crank, coupler = found.shares[:2]
    turning = crank.at_second + coupler.at_first
    said = [_("{mass:.6g} kg turn with {point}").format(mass=turning.real, point=loop.A)]
    if loop.rocker is None:
        moved = coupler.at_second + loop.slider
        said.append(_("{mass:.6g} kg move to and fro with {point}").format(mass=moved.real, point=loop.B))
    else:
        moved = found.shares[2].at_second + coupler.at_second
        said.append(_("{mass:.6g} kg turn with {point}").format(mass=moved.real, point=loop.B))
    if any(
        abs(share.at_second.imag) > NOTHING * abs(share.at_first + share.at_second) for share in found.shares
    ):
        return said  # vectors: no sum of numbers
    return [*said, *_products(found, loop, turning.real, moved.real)]


def _products(found: Balance, loop: Loop, turning: float, moved: float) -> list[str]:
    """Mass times length on each link with a counterweight, where the textbook has a sum for it."""
    factor, unit = display_unit("m", found.mechanism.display.length)
    by_link = {one.link: one for one in found.counterweights}
    lengths = {share.link: factor * length_of(found.mechanism, share) for share in found.shares}
    if found.fraction is not None:
        text = _("({turning:.6g} kg + {share:.4g} · {moved:.6g} kg) · {length:.6g} {unit} on {link}")
        said = text.format(
            turning=turning,
            share=found.fraction,
            moved=moved,
            length=lengths[loop.crank],
            unit=unit,
            link=loop.crank,
        )
        return [said]
    if found.to != "full" or not found.unique or set(by_link) != {loop.crank, loop.rocker or loop.coupler}:
        return []
    text = _("{mass:.6g} kg · {length:.6g} {unit} on {link}")
    other, at_pin = loop.rocker, turning
    if other is None:
        other = loop.coupler
        at_pin = turning + moved + by_link[other].mass
    if other == loop.coupler and by_link[other].base != loop.A:
        return []
    sums = ((at_pin, loop.crank), (moved, other))
    return [text.format(mass=m, length=lengths[link], unit=unit, link=link) for m, link in sums]


def length_of(mechanism: Mechanism, share: Share) -> float:
    """Distance of the two joints of a link [m]."""
    places = mechanism.links[share.link].coordinates
    return dist(places[share.first], places[share.second])
