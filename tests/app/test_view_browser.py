"""What the page of the workbench shows and folds, in a browser: tabs, the view, what an edit changed, whole numbers."""

from __future__ import annotations

import re
from typing import Any

import pytest

from report.browser import frames

from .bench import DRAWING, Bench, bench
from .served import Served

POWERS = """() => {
  const found = {units: 0, wrapped: 0, broken: []}, panel = document.querySelector("#panel");
  const texts = [], walk = document.createTreeWalker(panel, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) texts.push(walk.currentNode);
  const lines = (node, first, last) => {
    const range = document.createRange();
    range.setStart(node, first);
    range.setEnd(node, last);
    return new Set([...range.getClientRects()].map((one) => Math.round(one.bottom / 6))).size;
  };
  for (let wide = 90; wide <= 420; wide += 3) {
    panel.style.width = `${wide}px`;
    for (const node of texts) {
      if (!node.parentElement.getClientRects().length) continue;
      for (const number of node.data.matchAll(/[\\d.]+·10[⁻⁰¹²³⁴-⁹]+(?:\\s1\\/s)?/gu)) {
        found.units += number[0].endsWith("1/s");
        found.wrapped += lines(node, 0, node.length) > 1;
        if (lines(node, number.index, number.index + number[0].length) > 1) found.broken.push(`${wide}: ${number[0]}`);
      }
    }
  }
  panel.style.width = "";
  return found;
}"""
"""Numbers with a power of ten in panels of many widths: with a unit, in texts of several lines, and broken ones."""


CORNERS = """() => {
  const paths = [...document.querySelectorAll(".drawing .track:not(.far)")].filter((one) => one.getAttribute("d"));
  const wide = (one) => one.getBBox().width;
  const path = paths.sort((one, other) => wide(other) - wide(one))[0];
  const places = path.getAttribute("d").slice(1).split(/[LM]/).map((one) => one.split(" ").map(Number));
  const ways = places.slice(1).map(([x, y], k) => [x - places[k][0], y - places[k][1]])
    .filter((one) => Math.hypot(...one) > 20);
  const corners = ways.slice(1).map(([x, y], k) => {
    const [a, b] = ways[k];
    return Math.abs(Math.atan2(a * y - b * x, a * x + b * y));
  });
  return [ways.length, Math.max(...corners) * 180 / Math.PI];
}"""
"""Pieces of the widest path of the drawing that are two pixels long and more, and its sharpest corner in degrees."""


@pytest.fixture(scope="module")
def expect() -> Any:
    return pytest.importorskip("playwright.sync_api", reason="no playwright: pip install playwright").expect


def begun(one: Bench, name: str) -> None:
    """A built-in mechanism that moves."""
    one.template(name)
    one.motion()


def test_folded_tabs_by_keyboard(running: Any, server: Served, expect: Any) -> None:
    """Topics that do not apply are behind a button; unfolded they are gone through and say why; the open one stays."""
    with bench(running, server.address, wide=1500) as one:
        begun(one, "crank-rocker")
        page = one.page
        fold, away = page.locator(".others"), page.locator('[role="tab"].away')
        expect(fold).to_have_attribute("aria-expanded", "false")
        expect(away).to_have_count(0)
        count = int(re.search(r"\d+", fold.inner_text()).group())  # type: ignore[union-attr]
        fold.focus()
        page.keyboard.press("Enter")
        expect(fold).to_have_attribute("aria-expanded", "true")
        expect(fold).to_be_focused()
        expect(away).to_have_count(count)
        page.locator('[role="tab"][aria-selected="true"]').focus()
        page.keyboard.press("End")
        expect(away.last).to_be_focused()
        expect(away.last).to_have_attribute("aria-selected", "true")
        expect(page.locator("#panel .missing")).to_have_text(re.compile(r"\w.*\.$"))
        fold.focus()
        page.keyboard.press("Space")
        expect(away).to_have_count(1)
        page.locator('[role="tab"][aria-selected="true"]').focus()
        page.keyboard.press("Home")
        expect(page.locator("#tab-motion")).to_be_focused()
        expect(away).to_have_count(0)
        assert one.messages == []


def inside(one: Bench) -> tuple[int, int, float]:
    """Points inside the drawing, points, and the greater part of a side that they reach over."""
    held, count, share = one.page.evaluate(
        """(drawing) => {
          const room = document.querySelector(drawing).getBoundingClientRect();
          const rings = [...document.querySelectorAll("[data-point] .ring")].map((one) => one.getBoundingClientRect());
          const x = rings.map((one) => one.x + one.width / 2), y = rings.map((one) => one.y + one.height / 2);
          const held = x.filter((one, k) =>
            one > room.left && one < room.right && y[k] > room.top && y[k] < room.bottom);
          const reach = (of) => Math.max(...of) - Math.min(...of);
          return [held.length, rings.length, Math.max(reach(x) / room.width, reach(y) / room.height)];
        }""",
        DRAWING,
    )
    return held, count, share


def test_another_mechanism_is_shown_whole(running: Any, server: Served) -> None:
    """Whoever has zoomed in sees all of what opens next."""
    with bench(running, server.address, wide=1500) as one:
        begun(one, "crank-rocker")
        held, count, _share = inside(one)
        assert held == count > 3
        one.page.mouse.move(*one.spot((0.9, 0.9)))
        for _ in range(12):
            one.page.mouse.wheel(0, -240)
        one.until(lambda: inside(one)[0] < count)
        begun(one, "six-bar-press")
        frames(one.page)
        held, count, share = inside(one)
        assert held == count > 5
        assert share > 0.3
        assert one.messages == []


def changes(one: Bench) -> list[str]:
    """What the line under the drawing says was changed."""
    said = one.said()
    assert said.startswith("Changed: ")
    return said.removeprefix("Changed: ").split(", ")


def test_an_edit_names_each_element_once(running: Any, server: Served, expect: Any) -> None:
    """Both coordinates of a joint are one change, and so is one coordinate; paths are those of the text."""
    with bench(running, server.address, wide=1500) as one:
        one.draw((0.25, 0.7), (0.33, 0.55))
        one.draw("B", (0.65, 0.35))
        one.draw("C", (0.7, 0.7))
        one.mode("edit")
        x, y = one.spot("B")
        room = one.page.locator(DRAWING).bounding_box()
        share = (x - room["x"]) / room["width"], (y - room["y"]) / room["height"]
        one.gesture(lambda: one.drag("B", (share[0] + 0.05, share[1] - 0.05)))
        expect(one.page.locator("#said")).to_have_text("Changed: points.B")
        one.page.focus('[data-point="C"]')
        one.gesture(lambda: one.page.keyboard.press("ArrowRight"))
        expect(one.page.locator("#said")).to_have_text("Changed: points.C")
        one.click("AB")
        one.gesture(lambda: one.page.click('[data-row="drive"]'))
        told = changes(one)
        assert len(set(told)) == len(told)
        assert any(path.startswith("drives") for path in told)
        assert one.messages == []


def test_a_sentence_on_the_range_has_a_minus_of_print(running: Any, server: Served) -> None:
    """A drive whose limits lie on both sides of zero: the readiness tells its range as reports do."""
    with bench(running, server.address, wide=1500) as one:
        one.template("slider-between-cranks-locked")
        one.settle()
        said = one.page.inner_text(".readiness .limit")
        assert re.search(r"\d", said)
        assert not re.search(r"(?<!\w)-\d", said)
        assert "\u2212" in said


def test_a_fast_oscillation_is_drawn_round_and_its_powers_stay_whole(running: Any, server: Served) -> None:
    """A path has no corners between its samples; a power of ten keeps its unit in panels of every width."""
    with bench(running, server.address, wide=1500) as one:
        begun(one, "vibrating-screen")
        one.page.click("#tab-simulate")
        one.until(lambda: one.page.get_attribute("#panel", "data-ready") == "true")
        one.settle()
        frames(one.page)
        pieces, corner = one.page.evaluate(CORNERS)
        # the exciter's circle has a dozen samples a turn, corners of thirty degrees
        assert pieces > 3000
        assert corner < 8
        found = one.page.evaluate(POWERS)
        assert found["wrapped"] > 20
        assert found["units"] > 20
        assert found["broken"] == []


ON_PHONE = """() => {
  const pictures = [...document.querySelectorAll("#panel figure > .paper")];
  const holder = document.querySelector("#panel .table");
  const first = holder.querySelector("tbody td"), left = holder.getBoundingClientRect().left;
  holder.scrollLeft = 10000;
  return { scrolled: pictures.filter((one) => one.scrollWidth > one.clientWidth + 1).length, count: pictures.length,
    points: Math.max(...pictures.map((one) => parseFloat(one.querySelector("svg").getAttribute("width")))),
    passed: holder.scrollLeft > 0, stays: Math.abs(first.getBoundingClientRect().left - left) < 1 };
}"""


def test_pictures_are_drawn_for_the_width_of_the_panel(running: Any, server: Served) -> None:
    """On a phone nothing drawn is scrolled, and the first column of a table stays; more room has wider drawings."""
    with bench(running, server.address, wide=390) as one:
        begun(one, "six-bar-press")
        one.page.select_option(".tab-list", "polygons")
        one.wait("document.querySelector('#panel[data-topic=polygons][data-ready=true] figure')")
        phone = one.page.evaluate(ON_PHONE)
        assert phone["count"] >= 4 and phone["scrolled"] == 0
        assert phone["passed"] and phone["stays"]
        one.page.set_viewport_size({"width": 1100, "height": 900})
        one.until(lambda: one.page.evaluate(ON_PHONE)["points"] > phone["points"])
        one.settle()
        assert one.page.evaluate(ON_PHONE)["scrolled"] == 0
        assert one.messages == []
