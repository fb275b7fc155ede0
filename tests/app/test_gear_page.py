"""The page of gears in a browser: sliders for both shifts, the pair in its blocking contour."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pytest

import centrode as ct
from centrode.model.gear_pairs import GEAR_PAIRS

from .bench import bench
from .served import Served

LOOKS = """all => all.map(getComputedStyle).map(one => [one.stroke, one.strokeDasharray, one.strokeWidth])"""
"""Colour, dashes and width of curves."""
PAIR = {"module": "3 mm", "teeth": [12, 24], "shifts": [0.6, 0.36]}


def set_slider(page: Any, name: str, value: float) -> None:
    """Move a slider as a hand does: the value, and an event."""
    page.eval_on_selector(
        f"#{name}",
        "(one, value) => { one.value = value; one.dispatchEvent(new Event('input', {bubbles: true})); }",
        str(value),
    )


def test_sliders_move_the_pair_in_its_contour(running: Any, server: Served) -> None:
    page = running.new_page()
    page.set_default_timeout(120_000)
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(f"http://127.0.0.1:{server.port}/gears?token={server.token}&language=en")
    page.wait_for_selector("#facts td:has-text('56.4999 mm')")
    # The contour has its curves and what is possible inside.
    assert page.locator("#contour .curve.blocks").count() >= 4
    assert page.locator("#contour .inside").get_attribute("d").count("M") > 20
    # No two curves look alike, and the legend shows each as it is drawn.
    looks, samples = (
        page.eval_on_selector_all(where, LOOKS) for where in ("#contour .curve", "#legend .curve")
    )
    assert len(set(map(tuple, looks))) == len(looks) >= 8
    assert samples == looks
    assert {"x₁", "x₂", "0.5", "1"} <= set(page.locator("#contour text").all_text_contents())
    assert page.locator("#mesh .tooth").count() > 20
    described = GEAR_PAIRS.parse(page.locator("#text").inner_text())
    assert described.shifts == (0.6, 0.36)
    # On a phone what a slider moves follows it, and the numbers come after.
    wide = page.viewport_size
    page.set_viewport_size({"width": 390, "height": 844})
    tops = [page.locator(f"#{one}").bounding_box()["y"] for one in ("second", "contour", "mesh", "facts")]
    assert tops == sorted(tops)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    page.set_viewport_size(wide)
    # Out of the contour the page says what is wrong, as the command does.
    set_slider(page, "first", 1.5)
    page.wait_for_selector("#problems:not(.works):has-text('contact ratio')")
    assert page.locator("#place").get_attribute("cx") == "1.5"
    set_slider(page, "first", 0.5)
    page.wait_for_selector("#problems.works")
    shown = GEAR_PAIRS.parse(page.locator("#text").inner_text())
    assert shown.shifts == (0.5, 0.36)
    ratio = ct.gear_pair(shown).geometry.contact_ratio
    assert f"{ratio:.6g}" in page.locator("#facts").inner_text()
    # Other wheels have another contour.
    before = page.locator("#contour .inside").get_attribute("d")
    page.fill("#pinion", "17")
    page.dispatch_event("#pinion", "change")
    page.wait_for_function(
        "before => document.querySelector('#contour .inside').getAttribute('d') !== before", arg=before
    )
    page.fill("#pinion", "2")
    page.dispatch_event("#pinion", "change")
    page.wait_for_selector("#problems:has-text('whole number from 4 to 1000')")
    assert errors == []
    page.close()


@pytest.mark.parametrize(("language", "title"), [("en", "Gear pair"), ("uk", "Зубчаста пара")])
def test_the_workbench_leads_to_the_page(running: Any, server: Served, language: str, title: str) -> None:
    with bench(running, server.address, language=language) as one:
        one.page.click('[data-do="open"]')
        one.page.fill("dialog .filter", "crank")
        assert one.page.locator('[data-do="gears"]').count() == 0
        one.page.fill("dialog .filter", title.upper())
        assert one.page.locator("dialog .template").last.inner_text() == title
        with one.page.context.expect_page() as opened:
            one.page.click('[data-do="gears"]')
        page = opened.value
        page.set_default_timeout(120_000)
        for _ in range(2):  # loaded again it needs no token in its address
            page.wait_for_selector(f"#gears h1:has-text('{title}')")
            page.wait_for_selector("#facts td:has-text('56')")
            assert "token" not in page.url
            page.reload()
        page.close()
        assert one.messages == []


def test_the_page_is_given_with_the_token_alone(running: Any, server: Served) -> None:
    page = running.new_page()
    answer = page.goto(f"http://127.0.0.1:{server.port}/gears?token=wrong")
    assert answer.status == 403
    page.close()


def test_answers(ask: Callable[..., Any]) -> None:
    contour = ask("gears", want="contour", pair=PAIR)
    assert len(contour["inside"]) == len(contour["inside"][0]) == 61
    assert {curve["label"] for curve in contour["curves"]} >= {"undercut of the pinion", "contact ratio 1.2"}
    # The chosen place is inside: the row of x_2, the column of x_1.
    (low, high), (below, above) = contour["first"], contour["second"]
    column, row = round((0.6 - low) / (high - low) * 60), round((0.36 - below) / (above - below) * 60)
    assert contour["inside"][row][column] == "1"
    assert contour["inside"][0][0] == "0"
    pair = ask("gears", want="pair", pair=PAIR)
    assert pair["works"]
    assert ["centre distance", "56.4999 mm, without shifts 54 mm"] in pair["facts"]
    assert set(ask("gears", want="words", language="uk")["words"]) >= {"title", "contour", "first"}
    for wrong in (
        {"want": "other"},
        {"want": "pair"},
        {"want": "contour", "pair": {**PAIR, "teeth": [12, "rack"]}},
        {"want": "pair", "pair": {**PAIR, "shifts": [-2, -2]}},
        {"want": "pair", "pair": {**PAIR, "module": "much"}},
    ):
        assert "error" in ask("gears", **wrong)


def test_a_contour_is_there_before_a_hand_has_moved_on(ask: Callable[..., Any]) -> None:
    ask("gears", want="contour", pair=PAIR)
    begin = time.process_time()
    ask("gears", want="contour", pair=PAIR)
    assert time.process_time() - begin < 0.15
