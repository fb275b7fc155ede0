"""Sentences on what a mechanism is made of: links, hinges, guides, wheels, cylinders."""

from __future__ import annotations

import math
from collections.abc import Iterator

from centrode.locale import _, mark, ngettext
from centrode.model.mechanism import FRAME, Gear, Guide, Mechanism, Rolling
from centrode.structure.rank import is_bare, slider_of
from centrode.study.words.lists import called, links_listed, listed

LEVEL = 1e-9
"""Directions of guides nearer than this to an axis are called horizontal and vertical [rad]."""

# Translators: {links} are names of links such as "AC and CB", {point} the name of a point; names do not change.
SLIDERS = {
    "horizontal": mark("A slider, hinged to {links} in {point}, moves along a fixed horizontal guide."),
    "vertical": mark("A slider, hinged to {links} in {point}, moves along a fixed vertical guide."),
    "inclined": mark(
        "A slider, hinged to {links} in {point}, moves along a fixed guide at {angle} to the horizontal."
    ),
    "circle": mark("A slider, hinged to {links} in {point}, moves along a fixed circle."),
}
LONE_SLIDERS = {
    "horizontal": mark("A slider in {point} moves along a fixed horizontal guide."),
    "vertical": mark("A slider in {point} moves along a fixed vertical guide."),
    "inclined": mark("A slider in {point} moves along a fixed guide at {angle} to the horizontal."),
    "circle": mark("A slider in {point} moves along a fixed circle."),
}
SLIDING_LINKS = {
    "horizontal": mark("Link {link} moves along a fixed horizontal guide without turning."),
    "vertical": mark("Link {link} moves along a fixed vertical guide without turning."),
    "inclined": mark("Link {link} moves along a fixed guide at {angle} to the horizontal without turning."),
    "circle": mark("Link {link} moves along a fixed circle without turning against it."),
}
ROLLING = {
    ("line", True): mark("Wheel {wheel} rolls without slip on a fixed straight track."),
    ("line", False): mark("Wheel {wheel} rolls without slip on a straight track of link {on}."),
    ("outside", True): mark("Wheel {wheel} rolls without slip on the outside of a fixed circle."),
    ("outside", False): mark("Wheel {wheel} rolls without slip on the outside of a circle of link {on}."),
    ("inside", True): mark("Wheel {wheel} rolls without slip inside a fixed circle."),
    ("inside", False): mark("Wheel {wheel} rolls without slip inside a circle of link {on}."),
}


def moving_parts(mechanism: Mechanism) -> list[str]:
    """Names of the moving links, sliders and cylinders included, as they are counted."""
    found = [
        *map(called, mechanism.link_names),
        *(slider_of(guide) for guide in mechanism.guides if is_bare(guide)),
    ]
    for drive in mechanism.drives:
        if drive.kind == "distance":
            found.append(_("barrel of cylinder {name}").format(name=drive.id))
            found.append(_("rod of cylinder {name}").format(name=drive.id))
    return found


def sentences_on_joints(mechanism: Mechanism) -> Iterator[str]:
    """What the mechanism is made of, and how that is joined."""
    parts = moving_parts(mechanism)
    # Translators: {parts} is a list of names such as "OA, AC, slider C"
    yield ngettext(
        "Besides the frame the mechanism has {n} moving link: {parts}.",
        "Besides the frame the mechanism has {n} moving links: {parts}.",
        len(parts),
    ).format(n=len(parts), parts=", ".join(parts))
    yield from _on_hinges(mechanism)
    yield from _on_plates(mechanism)
    for guide in mechanism.guides:
        yield _on_guide(mechanism, guide)
    for gear in mechanism.gears:
        yield _on_gear(gear)
    for wheel in mechanism.rolling:
        yield _on_rolling(wheel)
    for drive in mechanism.drives:
        if drive.distance is not None:
            first, second = drive.distance
            yield _("A cylinder reaches from {first} to {second}.").format(first=first, second=second)


def links_at(mechanism: Mechanism, point: str) -> list[str]:
    """Links that have a point."""
    return [name for name, link in mechanism.links.items() if point in link.coordinates]


def _on_hinges(mechanism: Mechanism) -> Iterator[str]:
    """Fixed and moving hinges; those of sliders are told with their guides."""
    sliders = {guide.point for guide in mechanism.guides if is_bare(guide)}
    fixed, moving = [], []
    points = dict.fromkeys([*mechanism.frame.points, *mechanism.moving_points])
    for point in points:
        links = links_at(mechanism, point)
        if point in mechanism.frame.points and links:
            # Translators: an entry of the list "Hinged to the frame: ...", such as "OA in O"
            fixed.append(_("{links} in {point}").format(links=links_listed(links), point=point))
        elif len(links) > 1 and point not in sliders:
            moving.append(_("{links} in {point}").format(links=links_listed(links), point=point))
    if fixed:
        yield _("Hinged to the frame: {hinges}.").format(hinges=", ".join(fixed))
    if moving:
        yield _("Hinged to each other: {hinges}.").format(hinges=", ".join(moving))


def _on_plates(mechanism: Mechanism) -> Iterator[str]:
    for name, link in mechanism.links.items():
        if len(link.coordinates) > 2:
            points = listed(list(link.coordinates))
            yield _("Link {link} is one rigid piece with the points {points}.").format(
                link=called(name), points=points
            )


def _on_guide(mechanism: Mechanism, guide: Guide) -> str:
    links = [name for name in links_at(mechanism, guide.point) if name != guide.on]
    own = None if guide.link is None else called(guide.link)
    place = {"links": links_listed(links), "point": guide.point, "link": own, "on": called(guide.on)}
    if guide.on == FRAME:
        way, place["angle"] = _way(mechanism, guide)
        sentences = SLIDING_LINKS if own is not None else SLIDERS if links else LONE_SLIDERS
        return _(sentences[way]).format(**place)
    if own is not None:
        return _("Link {link} slides along link {on} and does not turn against it.").format(**place)
    if links:
        return _("A slider, hinged to {links} in {point}, moves along link {on}.").format(**place)
    if guide.point in mechanism.frame.points:
        return _("A slider, hinged to the frame in {point}, moves along link {on}.").format(**place)
    return _("A slider in {point} moves along link {on}.").format(**place)


def _way(mechanism: Mechanism, guide: Guide) -> tuple[str, str]:
    """How a fixed guide lies, and its angle to the horizontal."""
    if mechanism.space == "sphere":
        return "circle", ""
    angle = math.remainder(guide.direction_angle, math.pi)
    if abs(angle) < LEVEL:
        return "horizontal", ""
    if abs(abs(angle) - math.pi / 2) < LEVEL:
        return "vertical", ""
    return "inclined", f"{math.degrees(angle):.3g}°"


def _on_gear(gear: Gear) -> str:
    one, other = gear.links
    place = {
        "one": called(one),
        "other": called(other),
        "carrier": called(gear.carrier),
        "ratio": f"{abs(gear.ratio):.4g}",
    }
    if FRAME in gear.links:
        return _("Link {link} meshes with a fixed wheel; link {carrier} carries its axis.").format(
            link=place["other" if one == FRAME else "one"], carrier=place["carrier"]
        )
    if gear.carrier == FRAME:
        text = (
            _(
                "Links {one} and {other} are geared: {other} turns in the ratio {ratio} to {one},"
                " in the opposite sense."
            )
            if gear.ratio < 0
            else _(
                "Links {one} and {other} are geared: {other} turns in the ratio {ratio} to {one},"
                " in the same sense."
            )
        )
        return text.format(**place)
    text = (
        _(
            "Links {one} and {other} are geared: seen from link {carrier}, {other} turns in the ratio {ratio} to {one},"
            " in the opposite sense."
        )
        if gear.ratio < 0
        else _(
            "Links {one} and {other} are geared: seen from link {carrier}, {other} turns in the ratio {ratio} to {one},"
            " in the same sense."
        )
    )
    return text.format(**place)


def _on_rolling(wheel: Rolling) -> str:
    track = "line" if wheel.along.direction is not None else "inside" if wheel.along.inside else "outside"
    return _(ROLLING[track, wheel.on == FRAME]).format(wheel=called(wheel.link), on=called(wheel.on))
