"""Other names, and two points that become one: everything that named the old one names the new one."""

from __future__ import annotations

import math

from centrode.app.number_fields import drop_point
from centrode.app.patches import Operation, Patch
from centrode.app.references import key_places, references
from centrode.app.sketch import list_of_tables, marked_names
from centrode.app.state_rows import remove_guides
from centrode.app.text_changes import TextChanges
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import read_link_name, read_name, two_points, value_text


def rename(patch: Patch, operation: Operation) -> None:
    """Give a point or a link another name."""
    sketch = patch.sketch
    old, given = operation.get("object"), operation.get("name")
    try:
        name = read_link_name(given) if old in sketch.links else read_name(given)
    except ValueError as error:
        raise InputError("", getattr(error, "what", str(error)), getattr(error, "repair", "")) from None
    if name == old:
        return
    if name in sketch.links or name in sketch.points:
        raise InputError(
            "", _("{name} is taken already").format(name=value_text(name)), _("choose another name")
        )
    if old in sketch.points and old not in sketch.links:
        _rename_point(patch, str(old), name)
    elif old in sketch.links:
        _rename_link(patch, str(old), name)
    else:
        raise InputError("", _("the server does not know this object"))
    patch.changed.append(name)


def _rename_link(patch: Patch, old: str, name: str) -> None:
    sketch = patch.sketch
    changes = TextChanges(patch.text)
    table, points = sketch.tables["links"][old], sketch.links[old]
    if not table.get("points") and two_points(name) != points:
        changes.set(("links", old, "points"), list(points))
    for place in references(changes.tables, old, "link"):
        changes.set(place, name)
    for place in [*key_places(changes.tables, old, "link")]:
        changes.rename_key(place, name)
    patch.text = marked_names(changes.text, {f"links.{old}.length": f"links.{name}.length"})


def _rename_point(patch: Patch, old: str, name: str) -> None:
    sketch = patch.sketch
    for link, points in sketch.links.items():
        if old in points and not sketch.tables["links"][link].get("points"):
            first, second = (name if one == old else one for one in points)
            taken = {*sketch.links, *sketch.points}
            if two_points(first + second) == (first, second) and first + second not in taken:
                # the name of the link is its points: it goes with them
                changes = TextChanges(patch.text)
                for place in references(changes.tables, link, "link"):
                    changes.set(place, first + second)
                for place in [*key_places(changes.tables, link, "link")]:
                    changes.rename_key(place, first + second)
                path = f"links.{link}.length"
                patch.text = marked_names(changes.text, {path: f"links.{first + second}.length"})
            else:
                patch.write((("links", link, "points"), list(points)))
    _replace_point(patch, old, name)
    changes = TextChanges(patch.text)
    for place in [*key_places(changes.tables, old, "point")]:
        changes.rename_key(place, name)
    patch.text = marked_names(changes.text, {old: name})


def _replace_point(patch: Patch, old: str, name: str) -> None:
    """Name another point wherever a text names this one; a guide without a name is called as its point."""
    changes = TextChanges(patch.text)
    kinds = ["point"]
    if any(
        one.get("point") == old and not one.get("name") for one in list_of_tables(changes.tables, "guides")
    ):
        kinds.append("guide")
    for kind in kinds:
        for place in references(changes.tables, old, kind):
            changes.set(place, name)
    patch.text = changes.text


def join_points(patch: Patch, operation: Operation) -> None:
    """Make one point of two."""
    sketch = patch.sketch
    points = operation.get("points") or [operation.get("point"), operation.get("to")]
    if not isinstance(points, list) or len(points) != 2 or points[0] == points[1]:
        raise InputError("", _('two different points are needed: ["A", "B"]'))
    old, kept = (patch.point_of({"point": one}) for one in points)
    both = [link for link, of_link in sketch.links.items() if old in of_link and kept in of_link]
    if both:
        what = _("points {first} and {second} both belong to {link}")
        raise InputError("", what.format(first=old, second=kept, link=both[0]))
    if old in sketch.frame_points or kept not in sketch.places:
        old, kept = kept, old
    if old in sketch.frame_points:
        raise InputError("", _("both points belong to the frame"), _("switch Ground off at one of them"))
    if (
        kept in sketch.places
        and old in sketch.places
        and math.dist(sketch.places[kept], sketch.places[old]) > 1e-9 * sketch.size
        and not sketch.is_short_form
    ):
        drop_point(patch, old, sketch.places[kept])
        sketch = patch.sketch
    for link, of_link in sketch.links.items():
        if old in of_link and not sketch.tables["links"][link].get("points"):
            patch.write((("links", link, "points"), list(of_link)))
    guides = [k for k in sketch.guides_of(old) if sketch.guides_of(kept)]
    if guides:
        remove_guides(patch, guides)
    _replace_point(patch, old, kept)
    changes = TextChanges(patch.text)
    for place in [*key_places(changes.tables, old, "point")]:
        if place[0] == "links":
            changes.rename_key(place, kept)
        else:
            changes.remove(place)
    patch.text = marked_names(changes.text, {old: None})
    patch.changed.append(kept)
