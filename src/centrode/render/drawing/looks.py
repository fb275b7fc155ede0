"""Colours of figures on a screen, in its light and in its dark look; on paper they stay as they are drawn.

Lines and marks have a contrast of 3 to 1 to the ground in both looks, letters of 4.5 to 1 (WCAG 2, 1.4.3 and 1.4.11).
Greys that are fainter than that on white paper are meant to be: grids, and what stands behind.
"""

from __future__ import annotations

import colorsys
import functools
import re
from collections.abc import Callable
from typing import NamedTuple
from xml.etree import ElementTree as Xml

LIGHT_PAPER, DARK_PAPER = "#ffffff", "#17181a"
"""Grounds of pages."""
LIGHT_INK, DARK_INK = "#1c1c1c", "#e4e4e4"
"""What is black on paper."""
DARK_STAGE = "#1b1d1f"
"""Ground of moving drawings; contrasts in the dark are to it, the lightest of grounds that figures stand on."""
LINES, LETTERS = 3.0, 4.5
"""Least contrasts to the ground."""
DARK_GROUND = 0.09
"""Lightness in the dark of what was white."""
LEAST = 0.58
"""Lightness that a coloured line gets at least in the dark."""
TINT = 0.8
"""Lightness of areas that are tints of the ground, at least."""
GREY = 0.05
"""Saturation below which a colour is a grey."""
STEP = 0.01
"""Of lightness, where a contrast is sought."""
SCREEN_PALETTE = {
    "#0072b2": ("#0072b2", "#56b4e9"),
    "#d55e00": ("#d55e00", "#f0894a"),
    "#009e73": ("#00845f", "#3fd0a2"),
    "#cc79a7": ("#b04f8f", "#e39ac7"),
    "#e69f00": ("#8f6a00", "#e6b84a"),
    "#56b4e9": ("#2a8fc7", "#9fd0f2"),
    "#000000": (LIGHT_INK, DARK_INK),
}
"""The palette on light and on dark ground; `motion.css` and the workbench have the same hues."""
LETTERED = {"g", "text", "tspan"}
"""Elements that colour letters; whatever else is drawn has a style of its own."""
_DECLARATION = re.compile(r"(?P<key>fill|stroke|stop-color)(?P<colon>:\s*)(?P<colour>#[0-9a-fA-F]{6})\b")
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")
_SVG = "{http://www.w3.org/2000/svg}"

RGB = tuple[float, float, float]


class ColourLooks(NamedTuple):
    """A colour as it is drawn, "#rrggbb", and on a light and on a dark screen."""

    printed: str
    light: str
    dark: str


# The dark look of any colour, by which whole figures are turned round too.


def dark_line(colour: RGB) -> RGB:
    """A colour as it is seen best on the dark ground: greys turned round, colours made light enough."""
    if (own := SCREEN_PALETTE.get(_hex(colour))) is not None:
        return _rgb(own[1])
    hue, lightness, saturation = colorsys.rgb_to_hls(*colour)
    if saturation < GREY:
        lightness = DARK_GROUND + (1.0 - DARK_GROUND - 0.04) * (1.0 - lightness)
    else:
        lightness = max(lightness, LEAST)
    return colorsys.hls_to_rgb(hue, lightness, saturation)


def dark_area(colour: RGB) -> RGB:
    """The colour of an area: a tint of the white ground becomes one of the dark ground."""
    if not _is_tint(colour):
        return dark_line(colour)
    hue, lightness, saturation = colorsys.rgb_to_hls(*colour)
    return colorsys.hls_to_rgb(hue, DARK_GROUND + 1.2 * (1.0 - lightness), saturation)


# Looks of what figures consist of.


@functools.cache
def line_look(colour: str) -> ColourLooks:
    """How a line or a mark looks."""
    rgb = _rgb(colour)
    light = SCREEN_PALETTE.get(colour, (colour,))[0]
    dark = _hex(dark_line(rgb))
    if _is_faint(rgb):
        return ColourLooks(colour, colour, dark)
    return ColourLooks(colour, _dark_enough(light, LINES), _light_enough(dark, LINES))


@functools.cache
def area_look(colour: str) -> ColourLooks:
    """How an area looks: the ground, a tint of it, or as a line does."""
    if colour == LIGHT_PAPER:
        return ColourLooks(colour, LIGHT_PAPER, DARK_PAPER)
    rgb = _rgb(colour)
    return ColourLooks(colour, colour, _hex(dark_area(rgb))) if _is_tint(rgb) else line_look(colour)


@functools.cache
def letter_look(colour: str) -> ColourLooks:
    """How letters look; their edge has the colour of the ground."""
    if colour == LIGHT_PAPER:
        return area_look(colour)
    own = line_look(colour)
    return ColourLooks(colour, _dark_enough(own.light, LETTERS), _light_enough(own.dark, LETTERS))


INK = ColourLooks("#000000", LIGHT_INK, DARK_INK)
"""The look of what is black on paper, and of what has no colour of its own."""


# Figures whose colours are those of a screen.


def set_looks(drawing: Xml.Element, spell: Callable[[ColourLooks], str]) -> None:
    """Spell every colour of a drawing in SVG anew; what has no colour of its own is ink."""
    drawing.set("fill", "currentColor")
    styles: dict[tuple[str, bool], str] = {}
    for element in drawing.iter():
        letters = element.tag.removeprefix(_SVG) in LETTERED
        if style := element.get("style"):
            if (style, letters) not in styles:
                styles[style, letters] = _spelled_style(style, spell, letters)
            element.set("style", styles[style, letters])
        for key in ("fill", "stroke", "stop-color"):
            if _COLOUR.fullmatch(own := element.get(key, "")):
                element.set(key, spell(_look(key, own, letters)))


def _spelled_style(style: str, spell: Callable[[ColourLooks], str], letters: bool) -> str:
    return _DECLARATION.sub(
        lambda one: f"{one['key']}{one['colon']}{spell(_look(one['key'], one['colour'], letters))}", style
    )


def screen_figure(svg: str, spell: Callable[[ColourLooks], str]) -> str:
    """A figure in SVG whose colours are spelled anew, without a declaration before it."""
    Xml.register_namespace("", _SVG[1:-1])
    Xml.register_namespace("xlink", "http://www.w3.org/1999/xlink")
    drawing = Xml.fromstring(svg)
    set_looks(drawing, spell)
    return Xml.tostring(drawing, encoding="unicode")


def either_look(look: ColourLooks) -> str:
    """A colour in a page whose `color-scheme` is that of the screen: its paper is `--paper`."""
    if look.printed == LIGHT_PAPER:
        return "var(--paper)"
    return "currentColor" if look == INK else f"light-dark({look.light}, {look.dark})"


def contrast(one: str, other: str) -> float:
    """Contrast of two colours "#rrggbb", 1 to 21 (WCAG 2)."""
    low, high = sorted((_luminance(one), _luminance(other)))
    return (high + 0.05) / (low + 0.05)


def _look(key: str, colour: str, letters: bool) -> ColourLooks:
    colour = colour.lower()
    if letters:
        return letter_look(colour)
    return line_look(colour) if key == "stroke" and colour != LIGHT_PAPER else area_look(colour)


def _is_tint(colour: RGB) -> bool:
    _hue, lightness, saturation = colorsys.rgb_to_hls(*colour)
    return saturation >= GREY and lightness >= TINT


def _is_faint(colour: RGB) -> bool:
    saturation = colorsys.rgb_to_hls(*colour)[2]
    return saturation < GREY and contrast(_hex(colour), LIGHT_PAPER) < LINES


def _dark_enough(colour: str, least: float) -> str:
    """A colour dark enough to be seen on light paper."""
    hue, lightness, saturation = colorsys.rgb_to_hls(*_rgb(colour))
    while contrast(colour, LIGHT_PAPER) < least:
        lightness -= STEP
        colour = _hex(colorsys.hls_to_rgb(hue, max(lightness, 0.0), saturation))
    return colour


def _light_enough(colour: str, least: float) -> str:
    """A colour light enough to be seen on dark paper."""
    hue, lightness, saturation = colorsys.rgb_to_hls(*_rgb(colour))
    while contrast(colour, DARK_STAGE) < least:
        lightness += STEP
        colour = _hex(colorsys.hls_to_rgb(hue, min(lightness, 1.0), saturation))
    return colour


def _luminance(colour: str) -> float:
    linear = [one / 12.92 if one <= 0.04045 else ((one + 0.055) / 1.055) ** 2.4 for one in _rgb(colour)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def _rgb(colour: str) -> RGB:
    red, green, blue = (int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5))
    return red, green, blue


def _hex(colour: RGB) -> str:
    return "#" + "".join(f"{round(255.0 * one):02x}" for one in colour)
