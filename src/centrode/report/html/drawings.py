"""Figures inside of a page: safe whatever their texts, no two with the same name inside, letters and pens once."""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass, field
from itertools import groupby
from xml.etree import ElementTree as Xml

from centrode.errors import InputError
from centrode.locale import _
from centrode.render.drawing.looks import INK, LIGHT_PAPER, ColourLooks, set_looks

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
LETTER_DECIMALS = 1
"""Of places of letters in a text, in hundredths of its size."""
DECIMALS = 2
"""Of coordinates in a figure, in 1/72 inch."""


KEPT_LETTERS = 1024
"""Outlines of letters that are kept: most figures of a page have the same ones."""
LETTER_STEP = re.compile(r"\s*([A-Za-z])\s*")
LEAST_CLIPPED = 2
"""Elements for which a group is shorter than what they say themselves."""
PLACE = re.compile(r"translate\(([-\d.]+) ([-\d.]+)\)")
TRANSLATION = re.compile(r"translate\([^)]*\)")
PEN = re.compile(r"[\w\s:;#%.,()-]+")
"""Declarations that cannot end the rule that they stand in."""
STEP = re.compile(r"[A-Za-z]|-?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?")
PAIRS = {"M": 1, "L": 1, "Q": 2, "C": 3}
"""Points that each step of a path takes."""


@dataclass
class Drawings:
    """The figures of a page.

    Attributes
    ----------
    letters : outlines that they share -> the name of each
    texts : letters of texts that they share -> the name of each
    pens : strokes and fills that they share -> the class of each
    looks : their colours -> the variable of each
    count : of figures
    """

    letters: dict[str, str] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)
    pens: dict[str, str] = field(default_factory=dict)
    looks: dict[ColourLooks, str] = field(default_factory=dict)
    count: int = 0

    def embedded_figure(self, svg: bytes, label: str) -> str:
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
            whole.extend(_kept(child, names))
        _join_edges(whole)
        _join_strokes(whole)
        _group_by_clip(whole)
        set_looks(whole, self._spell_colour)
        self._share_pens(whole)
        self._share_texts(whole)
        return _written(whole)

    def shared_outlines(self) -> str:
        """The outlines that figures share; it stands before them."""
        if not self.letters:
            return ""
        outlines = "".join(
            drawn.replace("<path", f'<path id="{name}"', 1) for drawn, name in self.letters.items()
        )
        texts = "".join(f'<g id="{name}">{letters}</g>' for letters, name in self.texts.items())
        return f'<svg class="letters" width="0" height="0" aria-hidden="true"><defs>{outlines}{texts}</defs></svg>'

    def style(self) -> str:
        """The rules of the pens that figures share, and their colours in both looks of a screen and on paper."""
        light, dark, printed = (
            "".join(f" --{name}: {getattr(look, which)};" for look, name in self.looks.items())
            for which in ("light", "dark", "printed")
        )
        colours = (
            f":root {{{light} }}\n@media (prefers-color-scheme: dark) {{ :root {{{dark} }} }}\n"
            f"@media print {{ :root {{{printed} }} }}\n"
        )
        pens = "".join(f"svg .{name} {{ {pen} }}\n" for pen, name in self.pens.items())
        return (colours if self.looks else "") + pens

    def _spell_colour(self, look: ColourLooks) -> str:
        """A colour of a figure: the paper or the ink of the page, or a variable."""
        if look.printed == LIGHT_PAPER:
            return "var(--paper)"
        if look == INK:
            return "currentColor"
        return f"var(--{self.looks.setdefault(look, f'c{len(self.looks)}')})"

    def _share_pens(self, whole: Xml.Element) -> None:
        """A class in place of each style."""
        for element in whole.iter():
            pen = element.get("style", "")
            if PEN.fullmatch(pen):
                del element.attrib["style"]
                element.set("class", self.pens.setdefault(pen, f"p{len(self.pens)}"))

    def _share_texts(self, whole: Xml.Element) -> None:
        """A reference in place of each text, and of the letter of a text of one."""
        names = set(self.letters.values())
        for group in list(whole.iter("g")):
            letters = list(group)
            if not letters or not all(_is_letter(one, names) for one in letters):
                continue
            for one in letters:
                _place_letter(one)
            if len(letters) == 1 and set(letters[0].attrib) == {"href"}:
                name = letters[0].get("href", "").removeprefix("#")
            else:
                name = self.texts.setdefault("".join(map(_written, letters)), f"t{len(self.texts)}")
            for one in letters:
                group.remove(one)
            group.tag = "use"
            group.set("href", f"#{name}")

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
        drawn = _drawn_letter(path.get("d", ""), path.get("transform", ""))
        return self.letters.setdefault(drawn, f"g{len(self.letters)}")


@functools.lru_cache(KEPT_LETTERS)
def _drawn_letter(outline: str, transform: str) -> str:
    """The outline of a letter as an element, without blanks that say nothing."""
    own = {"d": LETTER_STEP.sub(r"\1", " ".join(outline.split())), "transform": " ".join(transform.split())}
    return _written(Xml.Element("path", {key: value for key, value in own.items() if value}))


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


def _kept(element: Xml.Element, names: dict[str, str]) -> list[Xml.Element]:
    """An element without anything that could act or load, with new names; nothing of what is not drawn.

    Of a group that changes nothing, what is in it.
    """
    if not str(element.tag).startswith(NAMESPACE):
        return []
    tag = element.tag.removeprefix(NAMESPACE)
    if tag not in ELEMENTS:
        return []
    made = Xml.Element(tag)
    for key, value in element.attrib.items():
        _keep(made, key, value, names)
    if tag in ("text", "tspan", "title", "desc"):
        made.text = element.text
    for child in element:
        for kept in _kept(child, names):
            kept.tail = child.tail if tag in ("text", "tspan") else None
            made.append(kept)
    if tag in ("g", "defs") and not len(made):
        return []
    return list(made) if tag == "g" and not made.attrib else [made]


def _join_edges(whole: Xml.Element) -> None:
    """A name with an edge about its letters, drawn twice with the same outline, as one path: the edge below."""
    for parent in whole.iter():
        for one, other in reversed(list(zip(parent, list(parent)[1:], strict=False))):
            edge, letters = _pen(one), _pen(other)
            if one.tag == other.tag == "path" and one.get("d") == other.get("d") and "stroke" in edge:
                own = {key: value for key, value in one.attrib.items() if key not in ("d", "style")}
                same = own == {key: value for key, value in other.attrib.items() if key not in ("d", "style")}
                if same and set(letters) == {"fill"} and edge.get("fill") == letters["fill"]:
                    one.set("style", f"{one.get('style')}; paint-order: stroke")
                    parent.remove(other)


def _join_strokes(whole: Xml.Element) -> None:
    """Lines behind each other of one opaque pen as one path; what is filled or seen through would look different."""
    for parent in whole.iter():
        last: Xml.Element | None = None
        for one in list(parent):
            own = {key: value for key, value in one.attrib.items() if key != "d"}
            if one.tag != "path" or not _is_plain_stroke(one):
                last = None
            elif last is not None and own == {key: value for key, value in last.attrib.items() if key != "d"}:
                last.set("d", last.get("d", "") + one.get("d", ""))
                parent.remove(one)
            else:
                last = one


def _group_by_clip(whole: Xml.Element) -> None:
    """What stands one behind the other and is clipped alike, clipped together."""
    for parent in list(whole.iter()):
        runs = [
            (clip, list(run))
            for clip, run in groupby(
                parent, lambda one: None if one.get("transform") else one.get("clip-path")
            )
        ]
        if all(clip is None or len(run) < LEAST_CLIPPED for clip, run in runs):
            continue
        for child in list(parent):
            parent.remove(child)
        for clip, run in runs:
            if clip is None or len(run) < LEAST_CLIPPED:
                parent.extend(run)
                continue
            group = Xml.SubElement(parent, "g", {"clip-path": clip})
            for one in run:
                del one.attrib["clip-path"]
                group.append(one)


def _is_plain_stroke(path: Xml.Element) -> bool:
    """Whether a path is a line that hides what is below it, without a name that something refers to."""
    seen_through = any("opacity" in key for key in (*path.attrib, *_pen(path)))
    begins = path.get("d", "").startswith("M")
    return begins and _pen(path).get("fill") == "none" and not seen_through and "id" not in path.attrib


def _is_letter(element: Xml.Element, names: set[str]) -> bool:
    """Whether an element is a letter of a text, wherever it stands."""
    return element.tag == "use" and element.get("href", "").removeprefix("#") in names and not len(element)


def _place_letter(letter: Xml.Element) -> None:
    """The place of a letter as coordinates, which are shorter."""
    found = PLACE.fullmatch(letter.get("transform", ""))
    if found is not None and not {"x", "y"} & set(letter.attrib):
        del letter.attrib["transform"]
        for axis, value in zip("xy", found.groups(), strict=True):
            place = f"{float(value):.{LETTER_DECIMALS}f}".rstrip("0").rstrip(".")
            if float(place):
                letter.set(axis, place)


def _written(element: Xml.Element) -> str:
    """An element without blanks before the ends of empty ones; in texts and labels such ends are escaped."""
    return Xml.tostring(element, encoding="unicode").replace(" />", "/>")


def _pen(element: Xml.Element) -> dict[str, str]:
    """The declarations of an element's style."""
    pairs = (rule.partition(":") for rule in element.get("style", "").split(";") if rule.strip())
    return {key.strip(): value.strip() for key, _colon, value in pairs}


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
        if key == "d":
            value = _short_path(value)
        elif key in ("points", "x", "y"):
            value = _round(value)
        elif key == "transform":
            value = TRANSLATION.sub(lambda found: _round(found[0]), value)
        made.set(key, value)


def _round(value: str) -> str:
    """Coordinates to hundredths of a point: less than what is seen or printed."""
    rounded = NUMBER.sub(lambda found: f"{float(found[0]):.{DECIMALS}f}".rstrip("0").rstrip("."), value)
    return " ".join(rounded.split())


def _short_path(value: str) -> str:
    """A path to hundredths of a point, from point to point, in as few letters as SVG allows.

    Steps are differences of rounded places, so that nothing adds up.
    """
    steps: list[str] = STEP.findall(value)
    written, before, letter = "", "", ""
    start = here = (0, 0)
    k = 0
    while k < len(steps):
        if steps[k].isalpha():
            letter = steps[k]
            k += 1
        if letter in "zZ":
            written, before, here = written + "z", "z", start
            continue
        count = PAIRS.get(letter, 0)
        numbers = steps[k : k + 2 * count]
        if not count or len(numbers) < 2 * count or any(one.isalpha() for one in numbers):
            return _round(value)  # a path that matplotlib does not write
        k += 2 * count
        places = [round(float(one) * 10**DECIMALS) for one in numbers]
        first = letter == "M" and not written
        told = [place - (0 if first else here[axis % 2]) for axis, place in enumerate(places)]
        sign = letter if first else letter.lower()
        here = places[-2], places[-1]
        if letter == "M":
            start, letter = here, "L"
        if sign != before:
            written += sign
            before = sign if sign not in "Mm" else ""
        for one in map(_hundredths, told):
            tight = not written[-1].isdigit() or one.startswith("-")
            written += one if tight else f" {one}"
    return written


def _hundredths(value: int) -> str:
    """A number of hundredths as a decimal, without zeros that say nothing."""
    if not value:
        return "0"
    whole, part = divmod(abs(value), 10**DECIMALS)
    text = (str(whole) if whole else "") + (f".{part:0{DECIMALS}d}".rstrip("0") if part else "")
    return f"-{text}" if value < 0 else text
