"""SVG files as sketches: lines, paths of straight pieces, circles, words; transforms and units."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import TypeAlias

from centrode.errors import InputError
from centrode.locale import _
from centrode.sketches.sketch import Label, Place, Polyline, Sketch, SketchCircle, role_of
from centrode.sketches.xml_trees import Element, xml_tree

Matrix: TypeAlias = tuple[float, float, float, float, float, float]

UNITS = {
    "mm": 1e-3,
    "cm": 1e-2,
    "m": 1.0,
    "in": 0.0254,
    "pt": 0.0254 / 72,
    "pc": 0.0254 / 6,
    "px": 0.0254 / 96,
    "": 0.0254 / 96,
}
"""Metres in a unit; a user unit without another is a pixel of CSS."""
SIMILAR = 1e-6
"""So far a transform may be from one that keeps circles."""
UPRIGHT: Matrix = (1.0, 0.0, 0.0, -1.0, 0.0, 0.0)

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-z%]*)\s*", re.IGNORECASE)
_STEP = re.compile(
    r"([MmLlHhVvZzCcSsQqTtAa])|([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|[\s,]+|(.)", re.DOTALL
)
_TRANSFORM = re.compile(r"(matrix|translate|scale|rotate|skewX|skewY)\s*\(([^()]*)\)")
PASSED_OVER = {
    "defs",
    "title",
    "desc",
    "metadata",
    "style",
    "namedview",
    "script",
    "symbol",
    "clipPath",
    "mask",
    "marker",
    "pattern",
}
"""Elements that draw nothing by themselves."""
GROUPS = {"svg", "g", "a", "switch"}


def svg_sketch(content: bytes, where: str) -> Sketch:
    """The drawing of an SVG file, y upwards. Raises InputError where it cannot be read."""
    root = xml_tree(content, where)
    if root.name != "svg":
        raise InputError(where, _("this is no SVG file: its root is {name}").format(name=root.name[:40]))
    sketch = Sketch()
    matrix = _view(root, sketch, where)
    for child in root.children:
        _read_element(child, matrix, "", sketch, where)
    return sketch


def _view(root: Element, sketch: Sketch, where: str) -> Matrix:
    """From the root's coordinates to the drawing, y upwards; the unit of it."""
    box = [float(x) for x in _NUMBER.findall(root.get("viewBox"))]
    width, height = _length(root.get("width")), _length(root.get("height"))
    if len(box) == 4 and min(box[2:]) > 0.0 and width and width[1] in UNITS:
        scales = [width[0] / box[2] * UNITS[width[1]]]
        if height and height[1] in UNITS:
            scales.append(height[0] / box[3] * UNITS[height[1]])
        # with one scale for both axes the drawing is as it is shown, and the smaller side decides
        unit = min(scales)
    else:
        unit = UNITS["px"]
    physical = width is not None and width[1] not in ("", "px", "%")
    if not physical:
        sketch.notes.append(_("the file names no unit of length: 96 units are an inch"))
    if not (0.0 < unit < 1e6):
        raise InputError(
            where, _("the size of the drawing is no length"), _("give width, height and viewBox")
        )
    sketch.unit = unit
    return UPRIGHT


def _length(text: str) -> tuple[float, str] | None:
    fitting = _LENGTH.fullmatch(text)
    return (float(fitting[1]), fitting[2].lower()) if fitting else None


def _read_element(element: Element, matrix: Matrix, layer: str, sketch: Sketch, where: str) -> None:
    name = element.name
    if name in PASSED_OVER:
        return
    if "none" in (element.get("display"), _style(element, "display")) or "hidden" in (
        element.get("visibility"),
        _style(element, "visibility"),
    ):
        sketch.leave_out(_("hidden elements"))
        return
    matrix = _product(matrix, _transform(element.get("transform"), where))
    layer = _layer(element, layer)
    if name in GROUPS:
        if name == "svg":
            sketch.leave_out(_("drawings inside the drawing"))
            return
        for child in element.children:
            _read_element(child, matrix, layer, sketch, where)
        return
    number = _SvgNumbers(element, where)
    if name == "line":
        ends = [(number("x1"), number("y1")), (number("x2"), number("y2"))]
        _add(sketch, element, [_move(matrix, end) for end in ends], layer, closed=False)
    elif name in ("polyline", "polygon"):
        numbers = [float(x) for x in _NUMBER.findall(element.get("points"))]
        places = [_move(matrix, place) for place in zip(numbers[::2], numbers[1::2], strict=False)]
        _add(sketch, element, places, layer, closed=name == "polygon")
    elif name == "rect":
        x, y, w, h = number("x"), number("y"), number("width"), number("height")
        corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
        _add(sketch, element, [_move(matrix, corner) for corner in corners], layer, closed=True)
    elif name in ("circle", "ellipse"):
        radii = (number("r"), number("r")) if name == "circle" else (number("rx"), number("ry"))
        _add_circle(sketch, matrix, (number("cx"), number("cy")), radii, layer)
    elif name == "path":
        pieces = _path_pieces(element.get("d"))
        if pieces is None:
            sketch.leave_out(_("curved paths"))
            return
        for places, closed in pieces:
            _add(sketch, element, [_move(matrix, place) for place in places], layer, closed=closed)
    elif name == "text":
        words = " ".join("".join(_words(element)).split())
        place = _move(matrix, (number("x"), number("y")))
        if words:
            sketch.labels.append(Label(words[:100], place, layer))
    else:
        sketch.leave_out(_("elements {name}").format(name=name[:40]))


class _SvgNumbers:
    """Numbers of an element's attributes; absent ones are zero."""

    def __init__(self, element: Element, where: str) -> None:
        self.element, self.where = element, where

    def __call__(self, name: str) -> float:
        text = self.element.get(name)
        if not text:
            # words may stand in a part of their own
            inner = next((one.get(name) for one in self.element.children if one.get(name)), "")
            text = inner.split()[0] if inner.split() else "0"
        read = _length(text.split()[0] if text.split() else "0")
        if read is None or read[1] not in ("", "px"):
            what = _("the attribute {name} is not a number of the drawing's own units").format(name=name)
            raise InputError(self.where, what, _("save it as plain SVG"))
        return read[0]


def _words(element: Element) -> Iterator[str]:
    yield element.text
    for child in element.children:
        yield from _words(child)


def _style(element: Element, name: str) -> str:
    """A property of the attribute `style`."""
    for rule in element.get("style").split(";"):
        key, _colon, value = rule.partition(":")
        if key.strip() == name:
            return value.strip()
    return ""


def _layer(element: Element, outer: str) -> str:
    """The layer of an element: its own label, class or id where that says what it is for, else that around it."""
    names = [element.get("label"), element.get("class"), element.get("id")]
    own = next((name for name in names if role_of(name)), "")
    return own or outer


def _add(sketch: Sketch, element: Element, places: Sequence[Place], layer: str, *, closed: bool) -> None:
    fill = element.get("fill") or _style(element, "fill")
    if fill.startswith("url(") and len(places) > 2:
        sketch.hatches.append(Polyline(tuple(places), True, layer))
        return
    if len(places) < 2:
        sketch.leave_out(_("lines without length"))
        return
    sketch.add_stroke(places, layer, closed=closed)


def _add_circle(
    sketch: Sketch, matrix: Matrix, centre: Place, radii: tuple[float, float], layer: str
) -> None:
    a, b, c, d, _e, _f = matrix
    scale = math.hypot(a, b)
    even = abs(radii[0] - radii[1]) <= SIMILAR * max(map(abs, radii))
    keeps = abs(math.hypot(c, d) - scale) + abs(a * c + b * d) / (scale or 1.0) <= SIMILAR * scale
    if not (even and keeps):
        sketch.leave_out(_("ellipses"))
        return
    sketch.rings.append(SketchCircle(_move(matrix, centre), abs(radii[0]) * scale, layer))


def _path_pieces(text: str) -> list[tuple[list[Place], bool]] | None:
    """Straight pieces of a path as places, and whether each is closed; None where it has curves or cannot be read."""
    pieces: list[tuple[list[Place], bool]] = []
    here = (0.0, 0.0)
    start = here
    places: list[Place] = []
    command = ""
    numbers: list[float] = []
    for step in _STEP.finditer(text):
        letter, number, other = step.groups()
        if other or (letter and letter not in "MmLlHhVvZz"):
            return None
        if letter:
            if numbers:
                return None
            command = letter
            if letter in "Zz":
                if places:
                    pieces.append((places, True))
                places, here = [start], start
                command = ""
            continue
        if number is None:
            continue
        if not command:
            return None
        numbers.append(float(number))
        if command in "HhVv":
            axis = "Hh".find(command) < 0
            moved = list(here)
            moved[axis] = numbers[0] + (here[axis] if command.islower() else 0.0)
            here = (moved[0], moved[1])
        elif len(numbers) == 2:
            x, y = numbers
            here = (here[0] + x, here[1] + y) if command.islower() else (x, y)
        else:
            continue
        numbers = []
        if command in "Mm":
            if len(places) > 1:
                pieces.append((places, False))
            places, start = [here], here
            command = "l" if command == "m" else "L"
        else:
            places.append(here)
    if numbers:
        return None
    if len(places) > 1:
        pieces.append((places, False))
    return pieces


def _transform(text: str, where: str) -> Matrix:
    matrix: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    if not text.strip():
        return matrix
    if _TRANSFORM.sub("", text).strip(" ,\t\r\n"):
        raise InputError(where, _("a transform of the drawing cannot be read"), _("save it as plain SVG"))
    for kind, inside in _TRANSFORM.findall(text):
        numbers = [float(x) for x in _NUMBER.findall(inside)]
        step = _step(kind, numbers) if all(map(math.isfinite, numbers)) else None
        if step is None:
            raise InputError(where, _("a transform of the drawing cannot be read"), _("save it as plain SVG"))
        matrix = _product(matrix, step)
    return matrix


def _step(kind: str, numbers: list[float]) -> Matrix | None:
    match kind, numbers:
        case "matrix", [a, b, c, d, e, f]:
            return a, b, c, d, e, f
        case "translate", [x]:
            return 1.0, 0.0, 0.0, 1.0, x, 0.0
        case "translate", [x, y]:
            return 1.0, 0.0, 0.0, 1.0, x, y
        case "scale", [x]:
            return x, 0.0, 0.0, x, 0.0, 0.0
        case "scale", [x, y]:
            return x, 0.0, 0.0, y, 0.0, 0.0
        case "rotate", [angle, *about] if len(about) in (0, 2):
            cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            x, y = about or (0.0, 0.0)
            return cosine, sine, -sine, cosine, x - cosine * x + sine * y, y - sine * x - cosine * y
        case "skewX", [angle]:
            return 1.0, 0.0, math.tan(math.radians(angle)), 1.0, 0.0, 0.0
        case "skewY", [angle]:
            return 1.0, math.tan(math.radians(angle)), 0.0, 1.0, 0.0, 0.0
    return None


def _product(outer: Matrix, inner: Matrix) -> Matrix:
    a, b, c, d, e, f = outer
    p, q, r, s, t, u = inner
    return (
        a * p + c * q, b * p + d * q, a * r + c * s, b * r + d * s, a * t + c * u + e, b * t + d * u + f,
    )  # fmt: skip


def _move(matrix: Matrix, place: Place) -> Place:
    a, b, c, d, e, f = matrix
    x, y = place
    return a * x + c * y + e, b * x + d * y + f
