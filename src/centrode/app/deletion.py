"""What is deleted, and what goes with it: everything that names it, and points that nothing has any more."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from centrode.app.edit_drags import value_at_place
from centrode.app.patches import Operation, Patch
from centrode.app.references import key_places, references
from centrode.app.sketch import SketchParts, guide_name, list_of_tables, load_name, marked_names
from centrode.app.state_rows import remove_guides
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import Place, value_text


def delete_objects(patch: Patch, operation: Operation) -> None:
    """Take out points, links, guides and loads with all that names them."""
    for name in patch.objects_of(operation):
        sketch = patch.sketch
        guides = {guide_name(sketch, k): k for k in range(len(sketch.guides))}
        loads = {load_name(k): k for k in range(len(list_of_tables(sketch.tables, "loads")))}
        if name in sketch.links:
            _delete_link(patch, name)
        elif name in sketch.points:
            _delete_point(patch, name)
        elif name in guides:
            remove_guides(patch, [guides[name]])
        elif name in loads:
            patch.remove(("loads", loads[name]))
        else:
            continue  # it went with another one


def _delete_link(patch: Patch, link: str) -> None:
    sketch = patch.sketch
    points = sketch.links[link]
    patch.remove(("links", link), *_references_to(patch, sketch, link, "link"))
    patch.text = marked_names(patch.text, {f"links.{link}.length": None})
    _drop_unused(patch, points)


def _references_to(patch: Patch, sketch: SketchParts, name: str, kind: str) -> list[Place]:
    """What goes with an object: entries that name it, and the key of its side."""
    places: list[Place] = []
    for place in references(sketch.tables, name, kind):
        room = place[0]
        if room in ("guides", "drives", "loads", "gears", "rolling"):
            places.append(place[:2])
        elif room == "links":
            if str(place[1]) == name and kind == "link":
                continue
            what = _("{place} names {name}").format(place=".".join(map(str, place)), name=value_text(name))
            raise InputError(name, what, _("change it in the text first"))
        elif room == "report":
            places.append(place)
    places += [place for place in key_places(sketch.tables, name, kind) if place[0] == "assembly"]
    return list(dict.fromkeys(places))


def _drop_unused(patch: Patch, points: Sequence[str]) -> None:
    """Points that nothing has any more."""
    for point in points:
        sketch = patch.sketch
        if point in sketch.points and not sketch.owners(point) and not sketch.guides_of(point):
            _delete_point(patch, point)
        elif point not in sketch.points:
            _forget(patch, point)


def _forget(patch: Patch, point: str) -> None:
    """What still names a point that is gone."""
    patch.remove(*_references_to(patch, patch.sketch, point, "point"))
    patch.text = marked_names(patch.text, {point: None})


def _delete_point(patch: Patch, point: str) -> None:
    sketch = patch.sketch
    for link in sketch.owners(point):
        rest = [one for one in sketch.links[link] if one != point]
        if len(rest) < 2 or not sketch.tables["links"][link].get("points"):
            _delete_link(patch, link)
            continue
        place: Place = ("links", link, "points")
        if isinstance(value_at_place(sketch.tables, place), Mapping):
            patch.remove((*place, point))
        else:
            patch.write((place, rest))
    sketch = patch.sketch
    if point not in sketch.points:
        return
    frame = sketch.tables.get("frame", {}).get("points")
    gone: list[Place] = _references_to(patch, sketch, point, "point")
    gone += [place for place in key_places(sketch.tables, point, "point") if place[0] in ("points", "frame")]
    if isinstance(frame, list) and point in frame:
        patch.write((("frame", "points"), [one for one in frame if one != point]))
    guides = sketch.guides_of(point)
    gone += [
        ("drives", k) for g in guides for k in sketch.drives_of(str(sketch.guides[g].get("name", point)))
    ]
    patch.remove(*dict.fromkeys(gone))
    patch.text = marked_names(patch.text, {point: None})
