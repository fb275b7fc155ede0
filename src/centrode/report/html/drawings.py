"""Figures inside of a page: safe whatever their texts, no two with the same name inside, letters drawn once."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from xml.etree import ElementTree as Xml

from centrode.errors import InputError
from centrode.locale import _

NAMESPACE = "{http://www.w3.org/2000/svg}"
LINK = "{http://www.w3.org/1999/xlink}href"
ELEMENTS = {
    "svg", "g", "defs", "path", "use", "clipPath", "rect", "circle", "ellipse", "line", "polyline", "polygon",
    "image", "text", "tspan", "title", "desc", "linearGradient", "radialGradient", "stop", "pattern", "mask",
}  # fmt: skip
ATTRIBUTES = {
    "d", "x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "r", "rx", "ry", "width", "height", "points", "transform",
    "viewBox", "style", "fill", "stroke", "opacity", "clip-path", "clipPathUnits", "fill-opacity", "fill-rule",
    "stroke-width", "stroke-linecap", "stroke-linejoin", "stroke-dasharray", "stroke-opacity", "stroke-miterlimit",
    "stroke-dashoffset", "preserveAspectRatio", "offset", "stop-color", "stop-opacity", "gradientUnits",
    "gradientTransform", "patternUnits", "patternTransform", "mask", "font-size", "font-family", "font-style",
    "font-weight", "text-anchor", "id",
}  # fmt: skip
REFERENCE = re.compile(r"url\(\s*['\"]?#([^)'\"]+)['\"]?\s*\)")
FOREIGN = re.compile(r"url\((?!\s*['\"]?#)|expression|@import|javascript:", re.IGNORECASE)
PICTURE = re.compile(r"data:image/(png|jpeg);base64,[A-Za-z0-9+/=\s]*")
NUMBER = re.compile(r"-?\d+\.\d{3,}(?!\d*e)")
DECIMALS = 2
"""Of coordinates in a figure, in 1/72 inch."""


@dataclass
class Drawings:
    """The figures of a page; `letters` are outlines that they share, each with its name."""

    letters: dict[str, str] = field(default_factory=dict)
    count: int = 0

    def embedded(self, svg: bytes, label: str) -> str:
        """A figure as an element of the page.

        Raises InputError for what is no SVG.
        """
        try:
            root = Xml.fromstring(svg)
        except Xml.ParseError as wrong:
            raise InputError("", _("a figure is not SVG: {why}").format(why=wrong)) from wrong
        if root.tag != f"{NAMESPACE}svg":
            raise InputError("", _("a figure is not SVG: {why}").format(why=root.tag))
        self.count += 1
        view = root.get("viewBox") or f"0 0 {_size(root.get('width'))} {_size(root.get('height'))}"
        used = _references(root)
        names = self._names(root, used)
        whole = Xml.Element("svg", {"viewBox": view, "role": "img", "aria-label": label})
        for child in root:
            kept = _kept(child, names)
            if kept is not None:
                whole.append(kept)
        return Xml.tostring(whole, encoding="unicode")

    def shared(self) -> str:
        """The outlines that figures share; it stands before them."""
        if not self.letters:
            return ""
        outlines = "".join(
            drawn.replace("<path", f'<path id="{name}"', 1) for drawn, name in self.letters.items()
        )
        return f'<svg class="letters" width="0" height="0" aria-hidden="true"><defs>{outlines}</defs></svg>'

    def _names(self, root: Xml.Element, used: set[str]) -> dict[str, str]:
        """New names of what is referred to; outlines of letters are taken out and shared."""
        names: dict[str, str] = {}
        for holder in root.iter(f"{NAMESPACE}defs"):
            for child in list(holder):
                name = child.get("id")
                if child.tag != f"{NAMESPACE}path" or name not in used or "-" not in str(name):
                    continue
                names[str(name)] = self._letter(child)
                holder.remove(child)
        for element in root.iter():
            name = element.get("id")
            if name in used and name not in names:
                names[str(name)] = f"f{self.count}-{len(names)}"
        return names

    def _letter(self, path: Xml.Element) -> str:
        """Name of a shared outline; the same letter of two figures is one."""
        own = {key: " ".join(path.get(key, "").split()) for key in ("d", "transform")}
        drawn = Xml.tostring(Xml.Element("path", {k: v for k, v in own.items() if v}), encoding="unicode")
        return self.letters.setdefault(drawn, f"g{len(self.letters)}")


def _size(text: str | None) -> str:
    found = re.match(r"[\d.]+", text or "")
    return found.group() if found else "100"


def _references(root: Xml.Element) -> set[str]:
    found: set[str] = set()
    for element in root.iter():
        for key, value in element.attrib.items():
            if key in (LINK, "href") and value.startswith("#"):
                found.add(value[1:])
            found.update(REFERENCE.findall(value))
    return found


def _kept(element: Xml.Element, names: dict[str, str]) -> Xml.Element | None:
    """An element without anything that could act or load, with new names; nothing of what is not drawn."""
    if not str(element.tag).startswith(NAMESPACE):
        return None
    tag = element.tag.removeprefix(NAMESPACE)
    if tag not in ELEMENTS:
        return None
    made = Xml.Element(tag)
    for key, value in element.attrib.items():
        _keep(made, key, value, names)
    if tag in ("text", "tspan", "title", "desc"):
        made.text = element.text
    for child in element:
        kept = _kept(child, names)
        if kept is not None:
            kept.tail = child.tail if tag in ("text", "tspan") else None
            made.append(kept)
    return None if tag in ("g", "defs") and not len(made) else made


def _keep(made: Xml.Element, key: str, value: str, names: dict[str, str]) -> None:
    if key in (LINK, "href"):
        if value.startswith("#") and value[1:] in names:
            made.set("href", f"#{names[value[1:]]}")
        elif made.tag == "image" and PICTURE.fullmatch(value):
            made.set("href", value)
    elif key == "id":
        if value in names:
            made.set("id", names[value])
    elif key in ATTRIBUTES and not FOREIGN.search(value):
        value = REFERENCE.sub(lambda found: f"url(#{names.get(found[1], '')})", value)
        made.set(key, _round(value) if key in ("d", "points", "x", "y") else value)


def _round(value: str) -> str:
    """Coordinates to hundredths of a point: less than what is seen or printed."""
    rounded = NUMBER.sub(lambda found: f"{float(found[0]):.{DECIMALS}f}".rstrip("0").rstrip("."), value)
    return " ".join(rounded.split())
