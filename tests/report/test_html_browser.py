"""Pages in a browser: silent, without requests, laid out whole; motions run and follow what drags them."""

from __future__ import annotations

import base64
import io
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.ttLib import TTFont

import centrode as ct
from centrode.locale import speaking
from centrode.model.examples.catalogue import load_cam
from centrode.render.document import blocks
from centrode.render.document.cam_player import moving_wheel
from centrode.render.document.chapters import document_chapter
from centrode.render.document.linkage_player import moving_of
from centrode.render.document.numbers import Numbers
from centrode.report.html.fonts import FONT
from centrode.report.html.page import html_page
from centrode.views.equations import sheet

from .browser import Seen, frames, opened, until
from .made import HOSTILE, moving, report

PLANE, SPHERE, WHEEL = "slider-between-cranks", "spherical-crank-rocker", "walking-wheel-four-legs"
WIDTHS = (1280, 820, 400)
EMBEDDED = re.compile(r'data:font/woff;base64,([^"]+)"')
MARKUP = "<img src=x onerror=alert(1)>"
A4 = 643  # width of the text on A4 in a browser's pixels, 96 to an inch


@pytest.fixture(scope="module")
def hostile(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("pages") / "hostile.html"
    made, still = report(), moving()
    named = replace(
        still,
        places={"O": still.places["O"], MARKUP: still.places["A"]},
        bodies={MARKUP: ("O", MARKUP)},
        tracks=(MARKUP,),
        drive_texts=(MARKUP,) * len(still.drive),
    )
    chapter = blocks.ChapterBlocks("names", MARKUP, (blocks.SectionBlocks(MARKUP, (named,)),))
    file.write_bytes(html_page(replace(made, chapters=(*made.chapters, chapter))))
    return file


@pytest.fixture(scope="module")
def motions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Motions in the plane, on the sphere, of a wheel."""
    cam = load_cam(WHEEL)
    moved = [moving_of(ct.example(name), ct.motion(ct.example(name))) for name in (PLANE, SPHERE)]
    moved.append(moving_wheel(ct.walking_wheel(cam), cam.title))
    chapters = [
        blocks.ChapterBlocks(f"{k}", f"{k}", (blocks.SectionBlocks("", (one,)),))
        for k, one in enumerate(moved)
    ]
    file = tmp_path_factory.mktemp("pages") / "motions.html"
    file.write_bytes(html_page(blocks.Report("Motions", "", "en", tuple(chapters))))
    return file


@pytest.fixture(scope="module")
def formulas(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All equations of two mechanisms, in Ukrainian."""
    with speaking("uk"):
        chapters = []
        for name in ("six-bar-press", "third-class-triad"):
            equations = ct.equations(ct.example(name), ())
            numbers = Numbers(equations.mechanism.display)
            for key in ("equations", "derivation"):
                chapters.append(document_chapter(key, sheet(equations), numbers))
        file = tmp_path_factory.mktemp("pages") / "formulas.html"
        file.write_bytes(html_page(blocks.Report("Formulas", "", "uk", tuple(chapters))))
    return file


def silent(seen: Seen, file: Path) -> None:
    assert seen.messages == []
    assert [one for one in seen.requests if not one.startswith("data:")] == [file.as_uri()]


def test_pages_are_silent(running: Any, hostile: Path, motions: Path, formulas: Path) -> None:
    for file in (hostile, motions, formulas):
        with opened(running, file) as seen:
            silent(seen, file)


def test_what_users_wrote_is_read(running: Any, hostile: Path) -> None:
    with opened(running, hostile) as seen:
        assert seen.page.title() == " ".join(HOSTILE.split())
        assert seen.page.text_content("h1") == HOSTILE
        assert HOSTILE in seen.page.text_content("main p:not(.subtitle)")
        assert seen.page.query_selector_all(".moving .names")[-1].text_content() == f"O{MARKUP}"
        assert seen.page.query_selector_all("output")[-1].text_content() == MARKUP


@pytest.mark.parametrize("wide", WIDTHS)
def test_nothing_is_wider_than_the_page(
    running: Any, hostile: Path, motions: Path, formulas: Path, wide: int
) -> None:
    for file in (hostile, motions, formulas):
        with opened(running, file, wide) as seen:
            assert seen.page.evaluate("document.documentElement.scrollWidth") <= wide


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A table that a phone has no room for, with long heads and long texts, and one that it has room for."""
    heads = ("reaction", "greatest transmission angle, °", *(f"$x_{k}$, m" for k in range(8)), "remark")
    row = ("5 slider", "128.25", *("−123.456",) * 8, "directions of two velocities that are known")
    numbers = (False, *(True,) * 9, False)
    wide = blocks.TableBlock(heads, (row,) * 4, "Wide", numbers)
    small = blocks.TableBlock(("point", "$x$, m"), (("A", "1.5"),) * 3, "Small", (False, True))
    section = blocks.SectionBlocks("", (wide, small))
    file = tmp_path_factory.mktemp("pages") / "tables.html"
    file.write_bytes(
        html_page(blocks.Report("Tables", "", "en", (blocks.ChapterBlocks("t", "T", (section,)),)))
    )
    return file


@pytest.mark.parametrize("wide", [390, 1280])
def test_tables_can_be_read_at_every_width(running: Any, tables: Path, wide: int) -> None:
    """No text is broken at every blank, letters are no small print, and what a row is about stays in view."""
    with opened(running, tables, wide) as seen:
        until(seen.page, lambda: bool(seen.page.evaluate("document.querySelector('table').style.cssText")))
        assert seen.page.evaluate("document.documentElement.scrollWidth") <= wide
        found = seen.page.evaluate(
            """[...document.querySelectorAll('.table')].map((holder) => {
              holder.scrollLeft = 10000;
              const first = holder.querySelector('tbody td'), box = first.getBoundingClientRect();
              const shown = document.elementFromPoint(box.left + 2, box.top + box.height / 2) === first;
              const worded = [...holder.querySelectorAll('th, td')].filter((cell) => !cell.querySelector('math'));
              const lines = new Map(worded.map((cell) => {
                const range = document.createRange();
                range.selectNodeContents(cell);
                return [cell, new Set([...range.getClientRects()].map((one) => Math.round(one.top))).size];
              }));
              return { size: parseFloat(getComputedStyle(first).fontSize), scrolled: holder.scrollLeft > 0,
                stays: Math.abs(box.left - holder.getBoundingClientRect().left) < 1 && shown,
                most: Math.max(...lines.values()),
                first: lines.get(first) };
            })"""
        )
        assert [one["scrolled"] for one in found] == [wide == 390, False]
        for one in found:
            assert one["size"] >= 12
            assert one["stays"] and one["first"] == 1
            assert one["most"] <= 4


@pytest.mark.parametrize("wide", [*WIDTHS, A4])
def test_formulas_are_whole(running: Any, formulas: Path, wide: int) -> None:
    """Each has a size and ends inside of its column; on the narrowest screen a system may be scrolled."""
    with opened(running, formulas, wide) as seen:
        if wide == A4:
            seen.page.emulate_media(media="print")
        sizes = np.array(
            seen.page.evaluate(
                "[...document.querySelectorAll('main .formulas > div:not(.one) math')].map((one) => {"
                " const own = one.getBoundingClientRect(), room = one.closest('.formulas').getBoundingClientRect();"
                " return [own.width, own.height, room.right - own.right, own.left - room.left]; })"
            )
        )
        assert len(sizes) > 100
        assert sizes[:, :2].min() > 3
        assert sizes[:, 2:].min() >= -0.5  # browsers round to parts of a pixel
        over = seen.page.evaluate(
            "[...document.querySelectorAll('main .formulas')].map((one) => one.scrollWidth - one.clientWidth)"
        )
        assert max(over) <= (0 if wide != min(WIDTHS) else 200)
        smallest = seen.page.evaluate(
            "Math.min(...[...document.querySelectorAll('.formulas > div')].map((one) =>"
            " parseFloat(getComputedStyle(one).fontSize) / parseFloat(getComputedStyle(one.parentElement).fontSize)))"
        )
        assert smallest >= (0.5 if wide == min(WIDTHS) else 0.7)


def test_letters_are_those_of_the_font_inside(running: Any, formulas: Path) -> None:
    """Widths on the page are the advances of the font's own letters: no font of the machine stands in."""
    font = TTFont(FONT)
    inside = TTFont(io.BytesIO(base64.b64decode(EMBEDDED.findall(formulas.read_text(encoding="utf-8"))[0])))
    letters = "".join(one for one in "𝜑𝑙Δ𝜔∫√" if ord(one) in inside.getBestCmap())
    assert len(letters) > 3
    cmap, advances = font.getBestCmap(), font["hmtx"]
    with opened(running, formulas) as seen:
        widths = seen.page.evaluate(
            "(letters) => [...letters].map((one) => { const made = document.createElement('span');"
            " made.style.font = '1000px \"centrode math\"'; made.textContent = one; document.body.append(made);"
            " const wide = made.getBoundingClientRect().width; made.remove(); return wide; })",
            letters,
        )
        assert seen.page.evaluate("getComputedStyle(document.querySelector('math')).fontFamily").startswith(
            '"centrode math"'
        )
    units = font["head"].unitsPerEm
    wanted = [1000 * advances[cmap[ord(one)]][0] / units for one in letters]
    np.testing.assert_allclose(widths, wanted, atol=1.0)  # a thousandth of a letter's size


class Stage:
    """A motion on a page, read as a user sees it."""

    def __init__(self, page: Any, number: int) -> None:
        self.page = page
        self.holder = page.query_selector_all(".moving")[number]
        self.holder.scroll_into_view_if_needed()

    @property
    def place(self) -> float:
        return float(self.holder.get_attribute("data-place"))

    def point(self, name: str) -> np.ndarray:
        """The middle of a point's sign on the screen."""
        box = self.holder.query_selector(f'[data-point="{name}"] :is(.hinge, .dot)').bounding_box()
        return np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])

    def drag(self, start: np.ndarray, *ways: np.ndarray) -> None:
        mouse = self.page.mouse
        mouse.move(*start)
        mouse.down()
        for to in ways:
            mouse.move(*to, steps=12)
        mouse.up()

    def press(self, name: str) -> None:
        self.holder.query_selector(f'[data-do="{name}"]').click()

    def key(self, key: str) -> None:
        self.holder.query_selector(".paper").focus()
        self.page.keyboard.press(key)


def test_a_motion_runs_and_stops(running: Any, motions: Path) -> None:
    with opened(running, motions) as seen:
        for number in range(3):
            stage = Stage(seen.page, number)
            names = [
                one.get_attribute("data-point")
                for one in stage.holder.query_selector_all("[data-point].grip")
            ]
            before, begun = stage.place, [stage.point(name) for name in names]

            def far(
                stage: Stage = stage, names: Any = names, begun: Any = begun, before: float = before
            ) -> bool:
                moved = [stage.point(name) for name in names]
                ways = [np.hypot(*(one - other)) for one, other in zip(begun, moved, strict=True)]
                return stage.place > before and max(ways) > 5

            stage.press("play")
            until(seen.page, far)
            stage.press("play")
            frames(seen.page)
            still = stage.place
            frames(seen.page)
            assert stage.place == still
        silent(seen, motions)


def test_the_crank_follows_the_pointer(running: Any, motions: Path) -> None:
    """Dragged to an angle, the crank stands there, and every point where the mechanism has it."""
    mechanism = ct.example(PLANE)
    motion = ct.motion(mechanism)
    with opened(running, motions) as seen:
        stage = Stage(seen.page, 0)
        pivot, pin = stage.point("O"), stage.point("A")
        crank = np.hypot(*(pin - pivot))
        scale = crank / float(np.hypot(*motion.position.sel(point="A")[0].values))
        for turn in (0.6, 1.7, 2.9, 4.2, 6.0):
            to = pivot + 1.4 * crank * np.array([np.cos(turn), -np.sin(turn)])
            stage.drag(stage.point("A"), to)
            way = stage.point("A") - pivot
            assert abs(np.hypot(*way) - crank) <= 1.0
            off = np.angle(np.exp(1j * (np.arctan2(-way[1], way[0]) - turn)))
            assert abs(off) <= 2.0 / crank  # two pixels: of the sign that is measured, and of the pointer
            value = float(
                np.interp(stage.place, np.arange(motion.sizes["sample"]), motion.drive_value.values[:, 0])
            )
            there = ct.motion(mechanism, at=[value])
            origin = there.position.sel(point="O").values[0]
            for name in there.point.values:
                wanted = pivot + scale * (there.position.sel(point=name).values[0] - origin) * [1, -1]
                assert np.abs(stage.point(str(name)) - wanted).max() <= 1.5, (turn, name)


def test_a_coupler_can_be_dragged(running: Any, motions: Path) -> None:
    with opened(running, motions) as seen:
        stage = Stage(seen.page, 0)
        stage.key("Home")
        held = 0.5 * (stage.point("A") + stage.point("C"))
        before = stage.place
        stage.drag(held, held - np.array([0.0, 30.0]))
        assert stage.place != before
        assert (0.5 * (stage.point("A") + stage.point("C")))[1] < held[1] - 5


def test_keys_step_and_seek(running: Any, motions: Path) -> None:
    with opened(running, motions) as seen:
        stage = Stage(seen.page, 0)
        last = ct.motion(ct.example(PLANE)).sizes["sample"] - 1
        for key, place in (
            ("Home", 0),
            ("ArrowRight", 1),
            ("ArrowRight", 2),
            ("ArrowLeft", 1),
            ("End", last),
        ):
            stage.key(key)
            assert stage.place == place, key
        stage.key("Home")
        stage.key("ArrowLeft")
        assert stage.place == last - 1  # a closed motion goes on at its other end, which is its beginning
        stage.key("Space")
        until(seen.page, lambda: stage.place != last - 1)
        stage.key("Escape")
        stage.press("on")
        assert stage.place == round(stage.place)


def test_the_value_of_the_drive_is_told(running: Any, motions: Path) -> None:
    told = moving_of(ct.example(PLANE), ct.motion(ct.example(PLANE))).drive_texts
    with opened(running, motions) as seen:
        stage = Stage(seen.page, 0)
        stage.key("Home")
        for k in range(3):
            assert stage.holder.query_selector("output").inner_text() == told[k]
            stage.key("ArrowRight")


def test_paths_and_names_can_be_put_away(running: Any, motions: Path) -> None:
    with opened(running, motions) as seen:
        stage = Stage(seen.page, 0)
        for name in ("paths", "names"):
            group = stage.holder.query_selector(f"svg .{name}")
            assert group.bounding_box() is not None
            stage.press(name)
            assert group.bounding_box() is None
            stage.press(name)
            assert group.bounding_box() is not None


def test_the_sphere_turns_when_it_is_dragged(running: Any, motions: Path) -> None:
    """The view turns about the centre: places stay on the sphere, the drive stays where it is."""
    with opened(running, motions) as seen:
        stage = Stage(seen.page, 1)
        place, before = stage.place, stage.point("A")
        box = stage.holder.query_selector(".globe").bounding_box()
        centre = np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])
        high = box["height"]
        stage.drag(centre - [0, 0.45 * high], centre - [-60, 0.3 * high])
        assert stage.place == place
        assert np.hypot(*(stage.point("A") - before)) > 10
        for name in ("A", "B", "C", "D"):
            assert np.hypot(*(stage.point(name) - centre)) <= box["width"] / 2 + 1


def test_without_scripts_the_first_picture_is_there(running: Any, motions: Path) -> None:
    with opened(running, motions, java_script_enabled=False) as seen:
        pictures = seen.page.query_selector_all(".moving .paper > svg")
        assert len(pictures) == 3
        for one in pictures:
            box = one.bounding_box()
            assert min(box["width"], box["height"]) > 200
        assert not seen.page.query_selector(".controls").is_visible()


def test_paper_has_no_controls_and_no_contents(running: Any, motions: Path) -> None:
    with opened(running, motions) as seen:
        seen.page.emulate_media(media="print")
        for name in ("nav", ".controls"):
            assert not seen.page.query_selector(name).is_visible()
        assert seen.page.query_selector(".moving svg").is_visible()
        assert seen.page.pdf(prefer_css_page_size=True).startswith(b"%PDF")
