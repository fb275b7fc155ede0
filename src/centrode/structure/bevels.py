"""Bevel gears: what the angles of wheels on the sphere are measured on, and what of the carrier's angle they hold.

A wheel's turn against the carrier is its own angle where that is measured from an arc of the carrier. Where it is
measured from an arc of the frame, about the point about which the carrier turns too, the carrier's angle is taken off.
"""

from __future__ import annotations

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import FRAME, Gear, Mechanism


def shares_of(mechanism: Mechanism, gear: str) -> tuple[float, float]:
    """How many times the carrier's angle is taken off those of the first and the second wheel of a gear."""
    if mechanism.space != "sphere":
        return 1.0, 1.0
    found = next(other for other in mechanism.gears if other.id == gear)
    first, second = (_share(mechanism, found, wheel) for wheel in found.links)
    return first, second


def measured_on(mechanism: Mechanism) -> dict[str, str]:
    """Link -> the body that its reference arc lies on, of the links of gears on the sphere."""
    if mechanism.space != "sphere":
        return {}
    found: dict[str, str] = {}
    for gear in mechanism.gears:
        for link in (*gear.links, gear.carrier):
            if link != FRAME and link not in found:
                found[link] = _base(mechanism, gear, link)
    return found


def _share(mechanism: Mechanism, gear: Gear, wheel: str) -> float:
    carrier = gear.carrier
    if carrier == FRAME or (wheel != FRAME and _base(mechanism, gear, wheel) == carrier):
        return 0.0
    if _base(mechanism, gear, carrier) == FRAME and wheel in (FRAME, *_about(mechanism, carrier)):
        return 1.0
    raise InputError(
        f"[[gears]] {gear.id}",
        _("the angle of {link} is measured on the frame, and not where {carrier} turns").format(
            link=wheel, carrier=carrier
        ),
        _("measure it from two points of {carrier}: reference = [...]").format(carrier=carrier),
    )


def _about(mechanism: Mechanism, carrier: str) -> list[str]:
    """Links whose angle is measured in the same point as the carrier's."""
    pivots = {name: next(iter(link.coordinates), None) for name, link in mechanism.links.items()}
    return [name for name, pivot in pivots.items() if pivot == pivots[carrier]]


def _base(mechanism: Mechanism, gear: Gear, link: str) -> str:
    """The body that the angle of a gear's link is measured on: what it is driven against, the carrier, the frame."""
    where = f"[[gears]] {gear.id}"
    reference = mechanism.links[link].reference
    if reference is None:
        pivot = next(iter(mechanism.links[link].coordinates), "")
        raise InputError(
            where,
            _("on the sphere {link} needs an arc that its angle is measured from").format(link=link),
            _('add to it: reference = ["{pivot}", ...], two points of {carrier}').format(
                pivot=pivot, carrier=gear.carrier
            ),
        )
    driven = {drive.link: drive.relative_to for drive in mechanism.drives if drive.link}
    bodies = [driven[link]] if link in driven else [gear.carrier, FRAME]
    for body in bodies:
        if (
            body in (gear.carrier, FRAME)
            and body != link
            and set(reference) <= set(mechanism.points_of(body))
        ):
            return body
    raise InputError(
        where,
        _("the angle of {link} is measured neither on {carrier} nor on the frame").format(
            link=link, carrier=gear.carrier
        ),
        _("name two points of one of them: reference = [...]"),
    )
