"""The counterweights that are asked for: on which links, measured from where, how made."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import dist
from typing import TypeAlias

from centrode.dynamics.balancing.counterweights import Spot
from centrode.dynamics.balancing.making import Making
from centrode.dynamics.balancing.reachable import base_of, hinged_from
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.problems import nearest, shown
from centrode.model.units import to_si

Lengths: TypeAlias = float | str | Mapping[str, float | str] | None
Masses: TypeAlias = float | str | Mapping[str, float | str] | None
MOST_COUNTERWEIGHTS = 20


def asked_spots(
    mechanism: Mechanism,
    on: Sequence[str] | None,
    to: str,
    radius: Lengths,
    most: Masses,
    thickness: float | str | None,
    density: float | str,
) -> list[Spot]:
    """Places for counterweights, in the order they were named."""
    places = _places(mechanism, on, to)
    if on is None and radius is None and thickness is None:  # one point tells no radius: sliders, wheels
        places = [(link, base) for link, base in places if len(mechanism.links[link].coordinates) > 1]
    links = [link for link, _base in places]
    radii = _by_link(radius, links, "radius", "length")
    heaviest = _by_link(most, links, "most", "mass")
    thick = None if thickness is None else positive(thickness, "thickness", "length")
    dense = positive(density, "density", "density")
    spots = []
    for link, base in places:
        out = radii.get(link)
        if out is None and thick is None:
            out = _half_way(mechanism, link, base)
        making = Making(out, thick, dense, heaviest.get(link))
        spots.append(Spot(link, base, making, base in mechanism.frame.points))
    return spots


def number(value: object, where: str, kind: str) -> float:
    """A number in SI of a number or a text with a unit; InputError about `where`."""
    try:
        return to_si(value, kind)
    except InputError as error:
        raise InputError(where, error.what, error.repair) from None


def positive(value: object, where: str, kind: str) -> float:
    """The same, greater than zero."""
    found = number(value, where, kind)
    if not found > 0.0:
        raise InputError(where, _("it must be positive, got {value}").format(value=shown(value)))
    return found


def _places(mechanism: Mechanism, on: Sequence[str] | None, to: str) -> list[tuple[str, str]]:
    """Links with the points that radii are measured from."""
    if on is None:
        hinged = hinged_from(mechanism)
        chosen = {
            name: base for name, base in hinged.items() if to == "full" or base in mechanism.frame.points
        }
        if to == "fraction":
            chosen = {name: base for name, base in chosen.items() if name == mechanism.drives[0].link}
        if not chosen:
            what = _("no link is hinged to the frame, where counterweights are put if nothing else is said")
            raise InputError("on", what, _("name links"))
        return list(chosen.items())
    names = [on] if isinstance(on, str) else list(on)
    if not names or len(names) > MOST_COUNTERWEIGHTS:
        what = _("{count} links were named").format(count=len(names))
        raise InputError("on", what, _("name 1 to {most}").format(most=MOST_COUNTERWEIGHTS))
    places = [_place(mechanism, name) for name in names]
    links = [link for link, _base in places]
    twice = next((link for link in links if links.count(link) > 1), None)
    if twice is not None:
        raise InputError("on", _("{name} is given twice").format(name=shown(twice)), _("keep one of them"))
    return places


def _place(mechanism: Mechanism, name: str) -> tuple[str, str]:
    link, sign, base = (part.strip() for part in str(name).partition("@"))
    if link not in mechanism.links:
        what = _("there is no link {name}").format(name=shown(link))
        raise InputError("on", what, nearest(link, list(mechanism.links)))
    points = list(mechanism.links[link].coordinates)
    if sign and base not in points:
        what = _("link {link} has no point {name}").format(link=shown(link), name=shown(base))
        raise InputError("on", what, nearest(base, points))
    return link, base or base_of(mechanism, link)


def _by_link(given: Lengths | Masses, links: Sequence[str], where: str, kind: str) -> dict[str, float]:
    """A number for each link that has one."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        one = positive(given, where, kind)
        return dict.fromkeys(links, one)
    for link in given:
        if link not in links:
            what = _("there is no counterweight on {name}").format(name=shown(link))
            raise InputError(where, what, nearest(str(link), list(links)))
    return {link: positive(value, f"{where} {link}", kind) for link, value in given.items()}


def _half_way(mechanism: Mechanism, link: str, base: str) -> float:
    """Half the distance to the farthest point of a link."""
    places = mechanism.links[link].coordinates
    out = 0.5 * max(dist(places[base], place) for place in places.values())
    if not out > 0.0:
        what = _("link {name} has one point, which tells no radius").format(name=shown(link))
        raise InputError("radius", what, _("give the radius of its counterweight"))
    return out
