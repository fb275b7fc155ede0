"""The workbench for everybody: audited on every panel and window, at every width, in every language and at night."""

from __future__ import annotations

import hashlib
from typing import Any

import pytest

from report.browser import frames
from report.test_mechanism_page import AXE, AXE_SUM

from .bench import Bench, bench
from .served import Served

MECHANISM, CAM, SPHERE = "six-bar-press", "indexing-cam", "spherical-four-bar"
WIDTHS = (400, 1000, 1920)
OTHERS = {
    "five-bar-two-drives": ("region",),
    "five-bar-pendulum": ("simulate",),
    "door-closer": ("simulate",),
    "vibrating-screen": ("modes",),
    "spherical-crank-rocker-rigid": ("simulate", "modes"),
    "cam-from-curvature": ("roller-path", "path-routes"),
    "walking-wheel-four-legs": ("cam", "cam-profile", "walking-wheel", "cam-contact", "cam-choice"),
}
"""Descriptions with panels that the three do not have."""
AUDIT = """async ([include, rules]) => {
  const where = {include: [include], exclude: [[".paper svg > *"]]}; // pictures are one thing each
  const how = {resultTypes: ["violations"], ...(rules.length ? {runOnly: rules} : {})};
  const found = await axe.run(where, how);
  return found.violations.filter((one) => ["serious", "critical"].includes(one.impact))
    .map((one) => `${one.id}: ${one.nodes.slice(0, 3).map((node) => node.html.slice(0, 160)).join(" | ")}`);
}"""
SMALL = """() => [...document.querySelectorAll("body *")].filter((one) => {
  const own = [...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
  if (!own || !one.getClientRects().length || one.closest("math, svg, noscript")) return false;
  return parseFloat(getComputedStyle(one).fontSize) < 11;
}).map((one) => one.outerHTML.slice(0, 120))"""
WIDE = "() => document.documentElement.scrollWidth - document.documentElement.clientWidth"


def serious_findings(one: Bench, where: str = "html", *rules: str) -> list[str]:
    """What axe-core finds that is serious, of all rules or of some."""
    frames(one.page)
    return list(one.page.evaluate(AUDIT, [where, list(rules)]))


@pytest.mark.parametrize("name", [MECHANISM, CAM, SPHERE])
def test_nothing_serious_is_found_on_any_panel(running: Any, server: Served, name: str) -> None:
    """By day all rules, at night the contrast of colours."""
    axe = AXE.read_bytes()
    assert hashlib.sha256(axe).hexdigest() == AXE_SUM
    with bench(running, server.address) as one:
        one.page.evaluate(axe.decode())
        assert serious_findings(one) == []  # the empty canvas
        one.template(name)
        one.motion()
        assert serious_findings(one) == []
        tabs = one.page.locator('[role="tab"]')
        for k in range(tabs.count()):
            tabs.nth(k).click()
            one.until(lambda: one.page.get_attribute("#panel", "data-ready") == "true")
            assert serious_findings(one, "#panel") == [], tabs.nth(k).inner_text()
        one.page.emulate_media(color_scheme="dark")
        assert serious_findings(one, "html", "color-contrast") == []
        assert one.messages == []


@pytest.mark.parametrize("name", OTHERS)
def test_nothing_serious_is_found_on_panels_of_few_descriptions(
    running: Any, server: Served, name: str
) -> None:
    with bench(running, server.address) as one:
        one.page.evaluate(AXE.read_text("utf-8"))
        one.template(name)
        one.motion()
        for topic in OTHERS[name]:
            one.page.click(f"#tab-{topic}")
            one.until(lambda: one.page.get_attribute("#panel", "data-ready") == "true")
            assert one.page.locator("#panel .missing").count() == 0, topic
            assert serious_findings(one, "#panel") == [], topic
        one.page.emulate_media(color_scheme="dark")
        assert serious_findings(one, "html", "color-contrast") == []
        assert one.messages == []


def test_nothing_serious_is_found_on_the_sphere_that_is_drawn_on(running: Any, server: Served) -> None:
    with bench(running, server.address) as one:
        one.page.evaluate(AXE.read_text("utf-8"))
        one.gesture(lambda: one.page.click('[data-do="sphere"]'))
        assert serious_findings(one) == []
        one.draw((0.42, 0.62), (0.45, 0.5))
        assert serious_findings(one) == []


def test_nothing_serious_is_found_in_any_window(running: Any, server: Served) -> None:
    with bench(running, server.address) as one:
        one.page.evaluate(AXE.read_text("utf-8"))
        one.template("crank-rocker")
        one.motion()
        for name in ("open", "export", "photo", "keys"):
            one.page.click(f'[data-do="{name}"]')
            assert serious_findings(one, "dialog") == [], name
            one.page.keyboard.press("Escape")
        one.page.click('[data-do="text"]')
        one.page.wait_for_selector(".cm-content")
        one.page.focus('[data-kind="link"][data-name="AB"]')
        one.page.keyboard.press(" ")
        assert serious_findings(one) == []
        one.page.emulate_media(color_scheme="dark")
        assert serious_findings(one, "html", "color-contrast") == []
        assert one.messages == []


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_it_fits_every_window_in_letters_that_can_be_read(
    running: Any, server: Served, language: str
) -> None:
    with bench(running, server.address, language=language) as one:
        one.template(MECHANISM)
        one.motion()
        one.page.focus('[data-kind="link"][data-name="AB"]')
        one.page.keyboard.press(" ")
        assert one.page.get_attribute("html", "lang") == language
        for wide in WIDTHS:
            one.page.set_viewport_size({"width": wide, "height": 900})
            frames(one.page)
            assert one.page.evaluate(WIDE) <= 0, wide
            assert one.page.evaluate(SMALL) == [], wide
        assert one.messages == []
