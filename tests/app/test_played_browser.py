"""Simulations and modes on the canvas of the workbench: the slider, its events and their list, by hand and by keys."""

from __future__ import annotations

import math
from typing import Any

from report.browser import frames

from .bench import Bench, bench
from .served import Served

RELEASE, FIRST_IMPACT, IMPACTS = 0.351285407, 0.447518908, 9
"""Of the catapult [s], as its how-to says them; the arm's stop is at 90 degrees."""
PIXEL = 1.5


def open_panel(one: Bench, name: str, topic: str) -> None:
    """A built-in mechanism with the panel of a topic."""
    one.template(name)
    one.settle()
    show_panel(one, topic)


def show_panel(one: Bench, topic: str) -> None:
    one.page.click(f"#tab-{topic}")
    one.until(lambda: one.page.get_attribute("#panel", "data-ready") == "true")
    one.settle()
    frames(one.page)


def told(one: Bench) -> str:
    """What the player says."""
    return str(one.page.inner_text(".controls output")).replace("\u00a0", " ")


def shown_time(one: Bench) -> float:
    """The instant that the player says [s]."""
    return float(told(one).split(" = ")[1].split()[0])


def slider_share(one: Bench) -> float:
    """How far the slider has gone."""
    seek = '[data-do="seek"]'
    return float(one.page.input_value(seek)) / float(one.page.get_attribute(seek, "max"))


def test_events_of_a_simulation_are_gone_to(running: Any, server: Served) -> None:
    """By the list and by the strip under the slider: the drawing and the curves stand where the event is."""
    with bench(running, server.address, wide=1500) as one:
        open_panel(one, "catapult", "simulate")
        rows = one.page.locator(".event-list tbody tr")
        assert rows.count() == 15
        assert one.page.locator(".event-list .sign.impact").count() == IMPACTS
        assert one.page.locator(".strip .held").count() == 4
        assert shown_time(one) == 0.0
        one.page.locator(".event-list button").nth(4).click()
        frames(one.page)
        assert "stop arm: impact" in told(one)
        assert abs(shown_time(one) - FIRST_IMPACT) < 1e-3
        # the slider goes through time, whatever samples there are
        end = float(rows.last.locator("td").first.inner_text().split()[0])
        assert abs(slider_share(one) - FIRST_IMPACT / end) < 1e-5
        # the arm stands upright at its stop
        (x, y), (foot, base) = one.spot("A"), one.spot("O")
        assert abs(x - foot) < PIXEL and y < base
        assert one.page.locator("#panel .legend .entry").first.inner_text() == "arm = 1.5708\u00a0rad"
        assert rows.nth(4).get_attribute("aria-current") == "true"
        # a click on the strip goes to the nearest event
        box = one.page.locator(".strip.events").bounding_box()
        one.page.mouse.click(box["x"] + box["width"] * RELEASE / end + 3, box["y"] + box["height"] / 2)
        frames(one.page)
        assert "release: condition met" in told(one)
        assert one.messages == []


def test_events_are_gone_to_by_keyboard(running: Any, server: Served) -> None:
    with bench(running, server.address, wide=1500) as one:
        open_panel(one, "door-closer", "simulate")
        buttons = one.page.locator(".event-list button")
        assert [buttons.nth(k).get_attribute("tabindex") for k in range(3)] == ["0", "-1", "-1"]
        buttons.first.focus()
        one.page.keyboard.press("ArrowDown")
        one.page.keyboard.press("Enter")
        frames(one.page)
        assert abs(shown_time(one) - 2.037) < 1e-3 and "frame: impact" in told(one)
        one.page.keyboard.press("End")
        one.page.keyboard.press("Enter")
        frames(one.page)
        assert "friction door: sticks" in told(one)
        one.page.focus('[data-do="seek"]')
        one.page.keyboard.press("PageDown")
        frames(one.page)
        assert "frame: impact" in told(one) and shown_time(one) > 2.1
        for _event in range(20):
            one.page.keyboard.press("PageDown")
        frames(one.page)
        assert abs(shown_time(one) - 1.696) < 1e-3
        one.page.keyboard.press("PageUp")
        frames(one.page)
        assert abs(shown_time(one) - 2.037) < 1e-3
        assert "frame: impact" in str(one.page.get_attribute('[data-do="seek"]', "aria-valuetext"))
        assert one.messages == []


def test_a_simulation_plays_once_and_stops_at_its_end(running: Any, server: Served) -> None:
    with bench(running, server.address, wide=1500) as one:
        open_panel(one, "catapult", "simulate")
        speed = one.page.locator('[data-do="speed"]')
        # on its way it is looked at slowly, so that a busy machine does not miss it
        speed.fill("-3")
        one.page.locator("body").press("p")
        one.until(lambda: 0.0 < slider_share(one) < 0.95)
        speed.fill("2")
        one.until(lambda: slider_share(one) == 1.0)
        one.until(lambda: one.page.get_attribute('[data-do="play"]', "aria-label") == "Play")
        assert "lands: condition met" in told(one)
        end = one.spot("S")
        speed.fill("-3")
        one.page.click('[data-do="play"]')
        one.until(lambda: slider_share(one) < 0.9)
        one.page.click('[data-do="play"]')
        frames(one.page)
        assert one.spot("S") != end
        # with another tab the drives lead again, and the stone is back where the description has it
        show_panel(one, "motion")
        assert one.page.locator(".strip.events").count() == 0
        assert one.messages == []


def test_what_is_drawn_while_a_simulation_is_open_is_the_description(running: Any, server: Served) -> None:
    """A joint is dragged where the description has it; the simulation follows from what was dropped."""
    with bench(running, server.address, wide=1500) as one:
        one.template("door-closer")
        one.motion()
        one.page.locator('[data-mode="edit"]').click()
        frames(one.page)
        show_panel(one, "simulate")
        one.page.locator(".event-list button").last.click()
        frames(one.page)
        shut = one.spot("A")
        time = one.page.locator(".event-list button").first.inner_text()
        one.page.focus('[data-kind="point"][data-name="A"]')
        one.gesture(lambda: one.page.keyboard.press("ArrowRight"))
        one.until(lambda: one.page.get_attribute("#panel", "data-ready") == "true")
        one.settle()
        frames(one.page)
        assert abs(one.spot("A")[1] - shut[1]) > 50  # the door stands open, as it begins
        assert one.page.locator(".event-list button").first.inner_text() != time
        one.page.locator(".event-list button").last.click()
        frames(one.page)
        (_x, height), (_foot, base) = one.spot("A"), one.spot("O")
        assert abs(height - base) < PIXEL  # it lies at its frame again
        assert one.messages == []


def test_a_phase_portrait_is_followed_and_goes_where_it_is_clicked(running: Any, server: Served) -> None:
    with bench(running, server.address, wide=1500) as one:
        open_panel(one, "five-bar-pendulum", "simulate")
        portrait = one.page.locator("#panel .chart", has_text="Phase portrait").first
        portrait.scroll_into_view_if_needed()
        line = portrait.locator("path.line-0")
        # the end of its first third, from the path itself
        x, y = line.evaluate(
            "one => { const at = one.getPointAtLength(one.getTotalLength() / 3)"
            ".matrixTransform(one.getScreenCTM()); return [at.x, at.y]; }"
        )
        one.page.mouse.click(x, y)
        frames(one.page)
        cursor = portrait.locator(".cursor").bounding_box()
        spot = portrait.locator(".spot").bounding_box()
        assert abs(cursor["x"] + cursor["width"] / 2 - x) < 3
        assert abs(spot["y"] + spot["height"] / 2 - y) < 3
        assert 0.0 < slider_share(one) < 1.0
        assert one.messages == []


def moves(one: Bench, point: str) -> None:
    """Wait until a point of the drawing has moved by itself."""
    before = one.spot(point)
    one.until(lambda: math.dist(one.spot(point), before) > 1.0)


def test_modes_move_on_the_canvas(running: Any, server: Served) -> None:
    """Of three modes the first moves at once; another one is chosen by keyboard, and P holds it."""
    with bench(running, server.address, wide=1500) as one:
        open_panel(one, "vibrating-screen", "modes")
        buttons = one.page.locator(".courses button")
        said = [text.replace("\u00a0", " ") for text in buttons.all_inner_texts()]
        # all masses, 126 kg, on both springs and dampers
        stiffness, damping, mass = 40_000, 600, 126
        ratio = damping / (2 * math.sqrt(stiffness * mass))
        assert len(said) == 3 and said[1].startswith("Mode 2: 2.8") and f"{ratio:.4f}" in said[1]
        assert buttons.first.get_attribute("aria-pressed") == "true"
        moves(one, "W")
        buttons.nth(1).focus()
        one.page.keyboard.press("Enter")
        frames(one.page)
        assert buttons.nth(1).get_attribute("aria-pressed") == "true"
        assert told(one) == said[1]
        moves(one, "P")
        one.page.locator("body").press("p")
        frames(one.page)
        still = one.spot("P")
        frames(one.page)
        assert one.spot("P") == still
        assert one.messages == []


def test_modes_move_on_the_sphere(running: Any, server: Served) -> None:
    with bench(running, server.address, wide=1500) as one:
        open_panel(one, "spherical-crank-rocker-rigid", "modes")
        assert one.page.locator(".courses button").count() == 2
        moves(one, "B")
        before = one.spot("A")
        moves(one, "C")
        assert one.spot("A") == before
        assert one.messages == []


def test_nothing_moves_by_itself_for_who_wants_it_calm(running: Any, server: Served) -> None:
    with bench(running, server.address, wide=1500, reduced_motion="reduce") as one:
        open_panel(one, "five-bar-pendulum", "modes")
        assert one.page.get_attribute('[data-do="play"]', "aria-label") == "Play"
        one.page.locator(".courses button").nth(1).click()
        moves(one, "C")
        assert one.messages == []
