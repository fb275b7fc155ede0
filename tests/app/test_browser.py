"""The workbench in a browser: drawing, dragging, undoing and sharing, and the numbers that follow from a drawing."""

from __future__ import annotations

import base64
import math
import tomllib
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from centrode.model.examples import example_text
from report.browser import browser, frames

from .bench import Bench, bench, opened
from .served import Served, served

SIX_DIGITS = 1e-4
"""Curves say five digits of their greatest value."""
GREY = "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAAAAABX3VL4AAAADklEQVR4nGNoaGBoaAAABgYCASzBUNcAAAAASUVORK5CYII="
"""A picture of four points."""


@pytest.fixture(scope="module")
def running() -> Iterator[Any]:
    with browser() as one:
        yield one


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    pytest.importorskip("starlette", reason="no starlette: pip install centrode[app]")
    pytest.importorskip("uvicorn", reason="no uvicorn: pip install centrode[app]")
    with served(tmp_path_factory.mktemp("bench")) as one:
        yield one


def places_of(one: Bench) -> dict[str, np.ndarray]:
    """Places of the points as the text has them [m]."""
    tables = one.tables
    given = {**tables.get("points", {}), **tables["frame"]["points"]}
    return {name: np.array(place, float) for name, place in given.items()}


def quarter_turn(vector: np.ndarray) -> np.ndarray:
    return np.array([-vector[1], vector[0]])


def four_bar(one: Bench) -> None:
    """Five gestures: three links, the crank drives, the last joint stands still."""
    one.draw((0.25, 0.7), (0.33, 0.55))
    one.draw("B", (0.65, 0.35))
    one.draw("C", (0.7, 0.7))
    one.click("AB")
    one.switch("drive")
    one.click("D")
    one.switch("ground")
    one.motion()


def test_a_four_bar_from_an_empty_canvas(running: Any, server: Served) -> None:
    """The velocity of the coupler's end is that of the loop's linear equations, from the places in the text."""
    with bench(running, server.address) as one:
        four_bar(one)
        at = places_of(one)
        speed = one.tables["drives"][0]["speed"]
        speed = float(str(speed).split()[0])
        one.choose_curve(0, "point C velocity")
        a, b, c, d = (at[name] for name in "ABCD")
        of_b = speed * quarter_turn(b - a)
        rates = np.linalg.solve(np.column_stack([quarter_turn(c - b), -quarter_turn(c - d)]), -of_b)
        velocity = rates[1] * quarter_turn(c - d)
        shown = one.values()
        scale = max(abs(velocity))
        assert abs(shown["vx(C)"] - velocity[0]) < 2 * SIX_DIGITS * max(scale, 1)
        assert abs(shown["vy(C)"] - velocity[1]) < 2 * SIX_DIGITS * max(scale, 1)
        assert one.messages == []


def test_a_slider_crank(running: Any, server: Served) -> None:
    """The slider moves along its guide as l1 and l2 say: x' from the derivative of the closed form."""
    with bench(running, server.address) as one:
        one.draw((0.25, 0.6), (0.33, 0.45))
        one.draw("B", (0.65, 0.6))
        one.mode("guide")
        one.draw("C", (0.85, 0.6))
        one.click("AB")
        one.switch("drive")
        one.motion()
        at = places_of(one)
        a, b, c = (at[name] for name in "ABC")
        assert c[1] == a[1]
        angle, crank, rod = math.atan2(*(b - a)[::-1]), math.dist(a, b), math.dist(b, c)
        rate = -crank * math.sin(angle) - crank**2 * math.sin(angle) * math.cos(angle) / math.sqrt(
            rod**2 - (crank * math.sin(angle)) ** 2
        )
        rate *= float(str(one.tables["drives"][0]["speed"]).split()[0])
        one.choose_curve(0, "point C velocity")
        shown = one.values()
        assert abs(shown["vx(C)"] - rate) < 2 * SIX_DIGITS * max(abs(rate), 1)
        assert abs(shown["vy(C)"]) < 2 * SIX_DIGITS
        assert one.messages == []


def test_a_six_bar_keeps_its_lengths(running: Any, server: Served) -> None:
    """A second loop on the rocker's joint; over the whole motion its links keep the lengths of the text."""
    with bench(running, server.address) as one:
        four_bar(one)
        one.draw("C", (0.85, 0.55))
        one.draw("E", (0.92, 0.85))
        one.click("F")
        one.switch("ground")
        one.motion()
        assert len(one.names("link")) == 5
        at = places_of(one)
        for place in (72, 198, 288):
            one.page.locator('[data-do="seek"]').fill(str(place))
            seen = {name: np.array(one.spot(name)) for name in one.names("point")}
            scale = math.dist(seen["A"], seen["D"]) / math.dist(at["A"], at["D"])
            for link in one.names("link"):
                first, second = link[0], link[1]
                assert (
                    abs(math.dist(seen[first], seen[second]) / scale - math.dist(at[first], at[second]))
                    < 2 / scale
                )
        assert one.messages == []


def test_drawing_by_keyboard(running: Any, server: Served) -> None:
    """The cross draws the links, Tab and Enter hinge the next one on, Space selects, rows are buttons."""
    with bench(running, server.address) as one:
        press = one.page.keyboard.press
        one.page.focus(".stage-holder .drawing")

        def cross(right: int, up: int) -> None:
            for _ in range(abs(right)):
                press("ArrowRight" if right > 0 else "ArrowLeft")
            for _ in range(abs(up)):
                press("ArrowUp" if up > 0 else "ArrowDown")

        press("ArrowRight")  # the cross appears
        cross(-8, -4)
        press("Enter")
        cross(2, 4)
        one.gesture(lambda: press("Enter"))
        for right, up in ((9, 4), (3, -9)):
            press("Enter")
            cross(right, up)
            one.gesture(lambda: press("Enter"))
        assert one.names("point") == ["A", "B", "C", "D"]
        one.page.focus('[data-kind="link"][data-name="AB"]')
        press(" ")
        one.page.focus('[data-row="drive"]')
        one.gesture(lambda: press("Enter"))
        one.page.focus('[data-kind="point"][data-name="D"]')
        press(" ")
        one.page.focus('[data-row="ground"]')
        one.gesture(lambda: press("Enter"))
        one.motion()
        at = places_of(one)
        press("e")
        one.page.focus('[data-kind="point"][data-name="C"]')
        one.gesture(lambda: press("ArrowUp"))
        after = places_of(one)
        assert after["C"][1] > at["C"][1] and after["C"][0] == pytest.approx(at["C"][0], abs=1e-6)
        assert one.messages == []


def test_undo_brings_the_same_bytes_back(running: Any, server: Served) -> None:
    """A hundred changes, undone and done again, letter for letter."""
    with bench(running, server.address) as one:
        one.template("crank-rocker")
        one.motion()
        first = one.text
        one.click((0.02, 0.02))
        one.page.focus('[data-kind="link"][data-name="AB"]')
        one.page.keyboard.press(" ")
        field = one.page.locator('[data-path="links.AB.length"]')
        texts = [first]
        for step in range(100):
            field.fill(f"{3.5 + 0.001 * (step + 1):.3f}")
            one.gesture(lambda: field.press("Enter"), settle=False)
            texts.append(one.text)
        assert len(set(texts)) == 101
        one.page.focus(".stage-holder .drawing")
        for expected in reversed(texts[:-1]):
            one.page.keyboard.press("Control+z")
            assert one.text == expected
        for expected in texts[1:]:
            one.page.keyboard.press("Control+y")
            assert one.text == expected
        assert one.messages == []


def test_a_link_holds_the_description(running: Any, server: Served) -> None:
    """Another window has the same text and the same statuses; a crank-rocker takes some 224 letters."""
    clipboard = ["clipboard-read", "clipboard-write"]
    with (
        bench(running, server.address, permissions=clipboard) as one,
        bench(running, server.address) as other,
    ):
        one.template("double-rocker")
        one.motion()
        one.page.click('[data-do="link"]')
        one.wait("document.querySelector('#said').innerText !== ''")
        address = one.page.evaluate("navigator.clipboard.readText()")
        assert server.token not in address
        other.page.click('[data-do="open"]')
        other.page.fill(LINK_FIELD, address)
        other.gesture(lambda: other.page.press(LINK_FIELD, "Enter"))
        other.page.reload()
        other.page.wait_for_selector(".bench")
        other.motion()
        assert other.text == one.text
        states = [[shown_state(page, place) for place in range(0, 361, 40)] for page in (one, other)]
        assert states[0] == states[1]
        assert len(set(states[0])) > 1
        plain = "\n".join(
            line for line in example_text("crank-rocker").splitlines() if not line.startswith("#")
        )
        letters = one.page.evaluate(PACKED, plain)
        assert len(letters) < 260
        other.page.evaluate("location.hash = '#m=abc'")
        other.wait("document.querySelector('#said').classList.contains('bad')")
        assert other.text == one.text


LINK_FIELD = "#pmks"
PACKED = """async (text) => {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}"""


def shown_state(one: Bench, place: int) -> str:
    one.page.locator('[data-do="seek"]').fill(str(place))
    return str(one.page.inner_text(".controls output"))


def test_nothing_is_lost_when_the_server_goes(running: Any, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Killed in the midst of a drag and started again, with its token or with another one at the same port."""
    with served(tmp_path_factory.mktemp("killed")) as own, bench(running, own.address) as one:
        one.template("crank-rocker")
        one.motion()
        one.mode("edit")
        x, y = one.spot("B")
        one.page.mouse.move(x, y)
        one.page.mouse.down()
        one.page.mouse.move(x + 30, y + 10, steps=4)
        before = one.text
        own.kill()
        one.page.mouse.move(x + 40, y + 20, steps=4)
        one.page.mouse.up()
        one.wait("document.querySelector('.lost') !== null")
        assert one.text == before
        own.start()
        one.wait("document.querySelector('.lost') === null")
        one.until(lambda: one.text != before)  # what was dropped meanwhile has been sent again
        one.settle()
        dropped = one.text
        own.kill()
        own.token = "another-token-of-this-server"
        own.start()
        again = opened(one.page.context, own.address)
        assert again.text == dropped
        again.page.keyboard.press("Control+z")
        assert again.text == before


def test_a_drawing_that_was_not_saved_is_one_step_below_the_file_that_opens(
    running: Any, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """A step back is the text of its own file: it is never saved over another one."""
    folder = tmp_path_factory.mktemp("files")
    for name in ("crank-rocker", "double-rocker"):
        (folder / f"{name}.toml").write_text(example_text(name), "utf-8", newline="")
    with served(folder) as own:
        own.kill()
        own.file = "crank-rocker.toml"
        own.start()
        with bench(running, own.address) as one:
            one.page.focus('[data-kind="link"][data-name="AB"]')
            one.page.keyboard.press(" ")
            field = one.page.locator('[data-path="links.AB.length"]')
            field.fill("3.75")
            one.gesture(lambda: field.press("Enter"))
            unsaved = one.text
            own.kill()
            own.file = "double-rocker.toml"
            own.start()
            again = opened(one.page.context, own.address)
            assert again.text == example_text("double-rocker")
            assert "crank-rocker.toml" in again.said()
            again.gesture(lambda: again.page.keyboard.press("Control+z"))
            assert again.text == unsaved
            assert again.page.inner_text(".subtitle").startswith("crank-rocker.toml")
            again.page.keyboard.press("Control+s")
            again.until(lambda: (folder / "crank-rocker.toml").read_text("utf-8") == unsaved)
            again.gesture(lambda: again.page.keyboard.press("Control+y"))
            assert again.page.inner_text(".subtitle") == "double-rocker.toml"
    assert (folder / "double-rocker.toml").read_text("utf-8") == example_text("double-rocker")


def test_a_text_that_is_too_great_is_refused_and_the_page_goes_on(running: Any, server: Served) -> None:
    with bench(running, server.address) as one:
        one.page.click('[data-do="open"]')
        great = {"name": "great.toml", "mimeType": "text/plain", "buffer": b"#" * 1_100_000}
        one.gesture(lambda: one.page.locator("dialog input[type=file]").set_input_files(great))
        one.wait("document.querySelector('#said').classList.contains('bad')")
        one.gesture(lambda: one.page.keyboard.press("Control+z"))
        one.template("crank-rocker")
        one.motion()
        assert one.page.locator(".lost").count() == 0


def test_letters_typed_last_are_kept(running: Any, server: Served) -> None:
    """The pane closes, and the page is left, in the moment in which letters wait to be read."""
    with bench(running, server.address, wide=1600) as one:
        one.page.click('[data-do="text"]')
        one.page.wait_for_selector(".cm-content")
        one.page.click(".cm-content")
        one.page.keyboard.press("Control+End")
        one.page.evaluate(
            """() => {
              document.execCommand("insertText", false, "# last");
              document.querySelector(".text-pane .plain").click();
            }"""
        )
        one.until(lambda: one.page.locator(".text-pane").count() == 0)
        assert one.text.endswith("# last")


def test_units_are_those_of_the_language(running: Any, server: Served) -> None:
    with bench(running, f"{server.address}&language=uk", language=None) as one:
        one.template("crank-rocker")
        one.motion()
        one.page.focus('[data-kind="link"][data-name="AB"]')
        one.page.keyboard.press(" ")
        one.page.wait_for_selector('[data-path="links.AB.length"]')
        assert one.page.locator(".side .unit").first.inner_text() == "м"


def test_the_address_of_the_window_does_not_hold_the_token(running: Any, server: Served) -> None:
    """It is loaded again all the same; a window that nobody has given the token says what to do."""
    with bench(running, server.address) as one:
        one.template("crank-rocker")
        assert server.token not in one.page.url
        before = one.text
        one.page.reload()
        one.page.wait_for_selector(".bench")
        one.settle()
        assert one.text == before and server.token not in one.page.url
        stranger = one.page.context.new_page()
        stranger.goto(f"http://127.0.0.1:{server.port}/")
        stranger.wait_for_selector(".refusal")
        assert "centrode app" in stranger.inner_text(".refusal")


def test_two_browsers_at_once(running: Any, server: Served) -> None:
    with bench(running, server.address) as one, bench(running, server.address) as other:
        one.template("slider-crank-offset")
        other.template("crank-rocker")
        one.motion()
        other.motion()
        for page in (one, other, one, other):
            x, y = page.spot("B" if page is other else "A")
            page.mode("move")
            page.page.mouse.move(x, y)
            page.page.mouse.down()
            page.page.mouse.move(x + 25, y + 25, steps=5)
            page.page.mouse.up()
            page.settle()
        assert tomllib.loads(one.text)["title"] != tomllib.loads(other.text)["title"]
        assert one.messages == other.messages == []


def test_the_text_and_the_drawing_follow_each_other(running: Any, server: Served) -> None:
    """A number typed moves the drawing; a drag changes the text; what is wrong stands at its line."""
    with bench(running, server.address, wide=1600) as one:
        one.template("crank-rocker")
        one.motion()
        one.page.click('[data-do="text"]')
        one.page.wait_for_selector(".cm-content")
        one.page.click(".cm-content")
        one.page.keyboard.press("Control+End")
        one.gesture(lambda: one.page.keyboard.type("\n[[loads]]\nkind = 5\n"))
        one.wait("document.querySelector('.problems') !== null")
        assert one.page.locator(".problems li").first.inner_text().startswith("line ")
        assert one.page.locator(".cm-lint-marker-error").count() >= 1
        one.page.focus('[data-kind="link"][data-name="AB"]')
        one.gesture(lambda: one.page.keyboard.press("Control+z"))
        assert one.text == example_text("crank-rocker")
        one.wait("document.querySelector('.problems') === null")
        one.page.keyboard.press(" ")
        field = one.page.locator('[data-path="links.AB.length"]')
        field.fill("3.75")
        one.gesture(lambda: field.press("Enter"))
        assert "3.75" in one.text
        one.wait("document.querySelector('.cm-content').innerText.includes('3.75')")
        assert one.messages == []


def test_the_profile_follows_the_segments_of_a_cam(running: Any, server: Served) -> None:
    """The greatest lift that the curve shows is the one that was written; the outline is another one."""
    with bench(running, server.address) as one:
        one.template("indexing-cam")
        one.motion()
        before = one.page.get_attribute(".cam-body", "d")
        field = one.page.locator(".segment").first.locator("input").nth(1)
        assert field.input_value() == "24"
        field.fill("30")
        one.gesture(lambda: field.press("Enter"))
        assert one.tables["segments"][0]["to"] == "30 deg"
        one.until(lambda: one.page.get_attribute(".cam-body", "d") != before)
        one.page.locator('[data-do="seek"]').fill("150")  # where the follower waits
        frames(one.page)
        assert one.page.locator(".legend .entry").first.inner_text().split(" = ")[1] == "30.000°"
        assert one.messages == []


def test_a_photo_gets_the_scale_of_a_known_length(running: Any, server: Served) -> None:
    with bench(running, server.address) as one:
        one.page.click('[data-do="photo"]')
        one.page.locator("dialog input[type=file]").set_input_files(
            {"name": "grey.png", "mimeType": "image/png", "buffer": base64.b64decode(GREY)}
        )
        one.wait("document.querySelector('.photo').getAttribute('display') === 'inline'")
        wide = float(one.page.get_attribute(".photo", "width"))
        one.page.locator("dialog .buttons button", has_text="scale").click()
        one.drag((0.4, 0.5), (0.6, 0.5))
        one.page.wait_for_selector("#photo-length")
        drawn = float(one.page.input_value("#photo-length"))
        one.page.fill("#photo-length", str(2 * drawn))
        one.page.press("#photo-length", "Enter")
        one.until(lambda: float(one.page.get_attribute(".photo", "width")) > 1.5 * wide)
        assert float(one.page.get_attribute(".photo", "width")) == pytest.approx(2 * wide, rel=1e-3)
        assert one.messages == []
