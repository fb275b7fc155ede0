"""Pages follow the look of the screen, figures and moving drawings too; on paper they stay as they are drawn."""

from __future__ import annotations

import colorsys
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import centrode as ct
from centrode import notebook
from centrode.render.document.blocks import Moving, Picture, Report
from centrode.render.drawing.colours import PALETTE
from centrode.render.drawing.looks import SCREEN_PALETTE, area_look, letter_look, line_look
from centrode.report.html.page import html_page
from centrode.report.texts import blocks_of

from .browser import opened

NAMES = ("six-bar-press", "spherical-four-bar", "cam-from-curvature", "helical-gear-pair")
LIGHT, DARK = "#ffffff", "#17181a"
RULE = re.compile(r"svg \.(p\d+) \{ ([^}]*) \}")
VARIABLE = re.compile(r"--(c\d+): (#[0-9a-f]{6});")
DRAWN = re.compile(r"(?:fill|stroke): (#[0-9a-fA-F]{6})")
FOLLOWS = re.compile(r"none|currentColor|var\(--paper\)|var\(--(c\d+)\)|url\(#[\w-]+\)")


def luminance(colour: str) -> float:
    """Relative luminance of sRGB (WCAG 2.2)."""
    shares = [int(pair, 16) / 255 for pair in re.findall("..", colour[1:])]
    red, green, blue = (s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4 for s in shares)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    bright, dim = sorted((luminance(one), luminance(other)), reverse=True)
    return (bright + 0.05) / (dim + 0.05)


def is_meant_faint(colour: str) -> bool:
    """Greys of grids and of what stands behind, tints of areas: no more than paper with a shade."""
    _hue, lightness, saturation = colorsys.rgb_to_hls(
        *(int(pair, 16) / 255 for pair in re.findall("..", colour[1:]))
    )
    return lightness > 0.65 if saturation < 0.05 else lightness >= 0.8


@pytest.fixture(scope="module")
def reports() -> dict[str, Report]:
    return {}


def report(kept: dict[str, Report], name: str) -> Report:
    if name not in kept:
        kept[name] = ct.report(ct.example(name), name=name)
    return kept[name]


def looks(page: str) -> dict[str, tuple[str, str, str]]:
    """The colours of a page: light, dark, on paper."""
    begin = page.index(":root { --c0")
    light, dark, printed = (dict(VARIABLE.findall(line)) for line in page[begin:].splitlines()[:3])
    assert light.keys() == dark.keys() == printed.keys()
    return {name: (light[name], dark[name], printed[name]) for name in light}


def pictures(made: Report) -> Iterator[Picture]:
    for block in blocks_of(made):
        if isinstance(block, Moving):
            yield block.still
        elif isinstance(block, Picture):
            yield block


@pytest.mark.drawn
@pytest.mark.parametrize("name", NAMES)
def test_every_colour_follows_the_screen_and_is_seen_on_it(reports: dict[str, Report], name: str) -> None:
    made = report(reports, name)
    page = html_page(made).decode()
    found = looks(page)
    body = page[page.index("<body>") :]
    pens = {pen: re.findall(r"(?:fill|stroke): ([^;]+)", rules) for pen, rules in RULE.findall(page)}
    drawn = {colour.lower() for one in pictures(made) for colour in DRAWN.findall(one.svg.decode())}
    assert len(drawn) > 5
    assert {printed for _light, _dark, printed in found.values()} == drawn - {"#ffffff", "#000000"}

    assert all(FOLLOWS.fullmatch(colour) for colours in pens.values() for colour in colours)
    assert not re.search(r'(?:fill|stroke)="#', body)
    assert "fill: #" not in body
    lettered = set(re.findall(r'<g (?:[^>]*? )?class="(p\d+)"', body)) | set(
        re.findall(r'<use (?:[^>]*? )?href="#[gt]\d+"[^>]* class="(p\d+)"', body)
    )
    assert lettered or name not in ("six-bar-press", "spherical-four-bar")  # elsewhere all letters are ink
    for pen, colours in pens.items():
        least = 4.5 if pen in lettered else 3.0
        for variable in filter(None, (FOLLOWS.fullmatch(colour)[1] for colour in colours)):  # type: ignore[index]
            light, dark, printed = found[variable]
            if least == 3.0 and is_meant_faint(printed):
                assert luminance(light) > 0.4  # faint on white, and as faint on black
                assert luminance(dark) < 0.2
                continue
            assert contrast(light, LIGHT) >= least, (pen, printed, light)
            assert contrast(dark, DARK) >= least, (pen, printed, dark)


@pytest.mark.parametrize(
    "colour", [*(one.lower() for one in PALETTE), "#a00000", "#332288", "#8a8a8a", "#b4b4b4"]
)
def test_any_colour_is_seen_in_both_looks(colour: str) -> None:
    letters, line = letter_look(colour), line_look(colour)
    assert contrast(letters.light, LIGHT) >= 4.5
    assert contrast(letters.dark, DARK) >= 4.5
    if not is_meant_faint(colour):
        assert contrast(line.light, LIGHT) >= 3.0
        assert contrast(line.dark, DARK) >= 3.0
    assert {letters.printed, line.printed, area_look(colour).printed} == {colour}


def test_moving_drawings_have_the_hues_of_the_figures() -> None:
    folder = Path(ct.__file__).parent / "report" / "html"
    rules = re.sub(r"\s+", " ", (folder / "motion.css").read_text(encoding="utf-8"))
    dark = rules.index("@media (prefers-color-scheme: dark)")
    printed = (folder / "print.css").read_text(encoding="utf-8")
    sheets = (rules[:dark], rules[dark : rules.index(".moving")], printed)
    for place, colour in enumerate(PALETTE):
        hues = [re.findall(rf"--hue-{place}: (#\w+);", sheet) for sheet in sheets]
        assert hues == [[one] for one in (*SCREEN_PALETTE[colour.lower()], colour.lower())]
    assert not re.search(r"(?:fill|stroke): #", rules)


@pytest.mark.parametrize("name", ["six-bar-press", "spherical-four-bar", "walking-wheel-three-legs"])
def test_what_moves_has_colours_of_the_page(reports: dict[str, Report], name: str) -> None:
    page = html_page(report(reports, name)).decode()
    stages = re.findall(r'<script type="application/json">(.*?)</script>', page, re.DOTALL)
    colours = [
        one["colour"]
        for stage in map(json.loads, stages)
        for part in ("bodies", "shapes", "rings")
        for one in stage[part]
    ]
    assert colours
    assert all(re.fullmatch(r"var\(--[a-z]+(-\d)?\)", one) for one in colours)
    for one in set(colours):
        assert page.count(f"{one[4:-1]}: #") == 3  # light, dark, on paper


@pytest.mark.drawn
def test_a_browser_shows_figures_on_the_ground_of_the_page(
    running: Any, reports: dict[str, Report], tmp_path: Path
) -> None:
    path = tmp_path / "report.html"
    path.write_bytes(html_page(report(reports, "helical-gear-pair")))
    measure = """() => {
      const picture = document.querySelector("figure > .paper > svg");
      const fills = [...picture.querySelectorAll("path")].map((one) => getComputedStyle(one));
      return {ground: fills[0].fill, page: getComputedStyle(document.body).backgroundColor,
        strokes: [...new Set(fills.map((one) => one.stroke))], letters: getComputedStyle(picture).fill};
    }"""
    seen: dict[str, dict[str, Any]] = {}
    for scheme in ("light", "dark"):
        with opened(running, path, 1200, color_scheme=scheme) as view:
            seen[scheme] = view.page.evaluate(measure)
            view.page.emulate_media(media="print", color_scheme=scheme)
            seen[f"{scheme} on paper"] = view.page.evaluate(measure)
    for one in seen.values():
        assert one["ground"] == one["page"]
    assert seen["dark"]["ground"] == "rgb(23, 24, 26)"
    assert seen["light on paper"] == seen["dark on paper"]
    assert seen["light on paper"]["ground"] == "rgb(255, 255, 255)"
    assert seen["light on paper"]["letters"] == "rgb(0, 0, 0)"
    printed = {f"#{int(r):02x}{int(g):02x}{int(b):02x}" for one in seen["light on paper"]["strokes"]
               for r, g, b in re.findall(r"rgb\((\d+), (\d+), (\d+)\)", one)}  # fmt: skip
    assert (
        {"#0072b2", "#d55e00"}
        <= printed
        <= {one.lower() for one in PALETTE} | {"#dddddd", "#606060", "#8a8a8a", "#202020"}
    )


@pytest.mark.drawn
def test_letters_of_figures_are_read_on_a_phone(
    running: Any, reports: dict[str, Report], tmp_path: Path
) -> None:
    """A figure is never less than 0.8 of its size on paper: what is wider is scrolled, by keyboard too."""
    path = tmp_path / "report.html"
    path.write_bytes(html_page(report(reports, "helical-gear-pair")))
    with opened(running, path, 360) as seen:
        figures = seen.page.evaluate(
            "[...document.querySelectorAll('figure > .paper')].map((one) => ({focus: one.tabIndex,"
            " wide: one.scrollWidth, room: one.clientWidth, drawn: one.firstElementChild.getBoundingClientRect().width,"
            " paper: 96 * parseFloat(one.style.getPropertyValue('--size'))}))"
        )
        assert seen.page.evaluate("document.documentElement.scrollWidth") == 360
    assert len(figures) > 3
    for one in figures:
        assert one["drawn"] >= 0.8 * one["paper"] - 1
        assert (one["focus"] == 0) == (one["wide"] > one["room"] + 1)
    assert any(one["focus"] == 0 for one in figures)


def test_figures_of_notebooks_follow_the_notebook() -> None:
    shown = notebook.mechanism_html(ct.example("six-bar-press"))
    style = shown[shown.index("<style>") : shown.index("</style>")]
    told = dict(re.findall(r"(--centrode-[\w-]+): (#\w+)", style))
    used = dict(re.findall(r"var\((--centrode-[\w-]+), (#\w+)\)", shown))
    assert told.keys() == used.keys()
    assert not re.search(r"(?:fill|stroke): #", shown)
    assert told["--centrode-ffffff-17181a"] == DARK
    assert used["--centrode-ffffff-17181a"] == LIGHT
    assert contrast(told["--centrode-000000-e4e4e4"], DARK) > 10
