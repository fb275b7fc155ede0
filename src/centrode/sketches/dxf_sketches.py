"""DXF files as sketches: lines, polylines, circles, hatches, words, and the blocks that hold them."""

from __future__ import annotations

import functools
import io
import logging
import math
import re
from collections.abc import Iterator
from importlib.util import find_spec
from typing import Any

import lazy_loader

from centrode.errors import InputError
from centrode.locale import _
from centrode.optional_packages import how_to_install
from centrode.sketches.sketch import MOST_STROKES, Label, Place, Polyline, Sketch, SketchCircle

METRES = {
    1: 0.0254, 2: 0.3048, 3: 1609.344, 4: 1e-3, 5: 1e-2, 6: 1.0, 7: 1e3, 8: 2.54e-8, 9: 2.54e-5, 10: 0.9144, 11: 1e-10,
    12: 1e-9, 13: 1e-6, 14: 0.1, 15: 10.0, 16: 100.0,
}  # fmt: skip
"""Metres in a unit by the number of $INSUNITS."""
DEEPEST_BLOCK = 6
BINARY = b"AutoCAD Binary DXF"

_ezdxf = functools.partial(lazy_loader.load, "ezdxf")  # an extra, and slow to import
_path = functools.partial(lazy_loader.load, "ezdxf.path")


def dxf_sketch(content: bytes, where: str) -> Sketch:
    """The drawing in the model space of a DXF file. Raises InputError where it cannot be read."""
    if find_spec("ezdxf") is None:
        raise InputError(where, _("DXF needs ezdxf, which is not installed"), how_to_install("drawings"))
    if content.startswith(BINARY):
        raise InputError(where, _("a binary DXF file is not read"), _("save it as DXF of text (ASCII)"))
    logging.getLogger("ezdxf").addHandler(logging.NullHandler())  # it tells of damage that is told here
    sketch = Sketch()
    try:
        document = _ezdxf().read(io.StringIO(_text_of(content)))
        unit = document.header.get("$INSUNITS", 0)
        if unit not in METRES:
            sketch.notes.append(_("the file names no unit of length: taken as millimetres"))
        sketch.unit = METRES.get(unit, 1e-3)
        for entity in _entities(document.modelspace(), sketch, 0):
            _read_entity(entity, sketch)
            if len(sketch.strokes) + len(sketch.rings) + len(sketch.labels) > MOST_STROKES:
                break
    except Exception as error:
        # the library raises whatever comes: the file is a stranger's, and damaged
        what = _("the DXF file is damaged: {reason}").format(reason=type(error).__name__)
        raise InputError(where, what, _("save it again, as DXF of AutoCAD 2010 or R12")) from None
    return sketch


def _text_of(content: bytes) -> str:
    """The text of a file, by the code page that it names."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        named = re.search(rb"ANSI_(\d{3,5})", content[:20_000])
        page = f"cp{named[1].decode()}" if named else "latin-1"
        try:
            return content.decode(page, "replace")
        except LookupError:
            return content.decode("latin-1")


def _entities(container: Any, sketch: Sketch, depth: int) -> Iterator[Any]:
    """Entities, with those that blocks hold where they are inserted."""
    for entity in container:
        if entity.dxftype() != "INSERT":
            yield entity
        elif depth >= DEEPEST_BLOCK:
            sketch.leave_out(_("blocks nested too deeply"))
        else:
            yield from _entities(entity.virtual_entities(), sketch, depth + 1)


def _read_entity(entity: Any, sketch: Sketch) -> None:
    kind, layer = entity.dxftype(), str(entity.dxf.get("layer", "0"))
    match kind:
        case "LINE":
            sketch.add_stroke([_flat(entity.dxf.start), _flat(entity.dxf.end)], layer)
        case "LWPOLYLINE":
            sketch.add_stroke(_outline(entity), layer, closed=bool(entity.closed))
        case "POLYLINE" if entity.is_2d_polyline or entity.is_3d_polyline:
            sketch.add_stroke(_outline(entity), layer, closed=bool(entity.is_closed))
        case "CIRCLE" | "ARC":
            place = _flat(entity.ocs().to_wcs(entity.dxf.center))
            (sketch.rings if kind == "CIRCLE" else sketch.arcs).append(
                SketchCircle(place, abs(entity.dxf.radius), layer)
            )
        case "POINT":
            sketch.rings.append(SketchCircle(_flat(entity.dxf.location), 0.0, layer))
        case "TEXT":
            aligned = entity.dxf.get("align_point") if entity.dxf.get("halign", 0) else None
            place = _flat(entity.ocs().to_wcs(aligned or entity.dxf.insert))
            sketch.labels.append(Label(str(entity.dxf.text)[:100], place, layer))
        case "MTEXT":
            sketch.labels.append(Label(entity.plain_text()[:100], _flat(entity.dxf.insert), layer))
        case "SOLID" | "TRACE":
            corners = tuple(_flat(place) for place in entity.wcs_vertices())
            sketch.hatches.append(Polyline(corners, True, layer))
        case "HATCH":
            for path in entity.paths:
                corners = tuple(_flat(place) for place in _corners(path))
                if len(corners) > 2:
                    sketch.hatches.append(Polyline(corners, True, layer))
        case _:
            sketch.leave_out(_("entities {name}").format(name=kind[:40]))


def _outline(entity: Any) -> list[Place]:
    """Vertices of a polyline; arcs between them as eight lines each."""
    if not entity.has_arc:
        places = entity.vertices_in_wcs() if entity.dxftype() == "LWPOLYLINE" else entity.points_in_wcs()
        return [_flat(place) for place in places]
    outline = _path().make_path(entity)
    return [_flat(place) for place in outline.flattening(math.inf, segments=8)]


def _corners(path: Any) -> Iterator[Any]:
    """Corners of the boundary of a hatch; of curved edges their ends are enough."""
    if hasattr(path, "vertices"):
        yield from path.vertices
        return
    for edge in path.edges:
        if hasattr(edge, "start"):
            yield edge.start
        elif hasattr(edge, "center"):
            for turn in range(8):
                angle = turn * math.pi / 4
                radius = getattr(edge, "radius", 0.0)
                yield edge.center[0] + radius * math.cos(angle), edge.center[1] + radius * math.sin(angle)


def _flat(place: Any) -> Place:
    return float(place[0]), float(place[1])
