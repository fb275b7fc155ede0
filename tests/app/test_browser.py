"""The workbench in a browser: drawing, dragging, undoing and sharing, and the numbers that follow from a drawing."""

from __future__ import annotations

import base64
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from centrode.app.documents import read_document
from centrode.app.sketch import SketchParts
from centrode.model.examples import example_text
from report.browser import frames

from .bench import Bench, bench, opened
from .served import Served, served

SIX_DIGITS = 1e-4
"""Curves say five digits of their greatest value."""
GREY = "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAAAAABX3VL4AAAADklEQVR4nGNoaGBoaAAABgYCASzBUNcAAAAASUVORK5CYII="
"""A picture of four points."""


def places_of(one: Bench) -> dict[str, np.ndarray]:
    """Places of the points as the text has them [m]."""
    tables = one.tables
    fixed = tables["frame"]["points"]
    given = {**tables.get("points", {}), **(fixed if isinstance(fixed, dict) else {})}
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


def unit_of(degrees: list[str]) -> np.ndarray:
    """Unit vector of a longitude and a latitude as a file has them."""
    longitude, latitude = (math.radians(float(one.split()[0])) for one in degrees)
    across = math.cos(latitude)
    return np.array([across * math.cos(longitude), across * math.sin(longitude), math.sin(latitude)])


def begin_on_sphere(one: Bench) -> None:
    one.gesture(lambda: one.page.click('[data-do="sphere"]'))


def test_a_spherical_four_bar_from_an_empty_canvas(running: Any, server: Served) -> None:
    """Five gestures, and a joint dragged; the speed of C by the loop's equations with the axes through the centre."""
    with bench(running, server.address) as one:
        begin_on_sphere(one)
        one.draw((0.42, 0.62), (0.45, 0.5))
        one.draw("B", (0.58, 0.3))
        one.draw("C", (0.64, 0.6))
        one.click("AB")
        one.switch("drive")
        one.click("D")
        one.switch("ground")
        one.motion()
        one.mode("edit")
        before = one.tables["points"]["C"]
        one.gesture(lambda: one.drag("C", (0.6, 0.34)))
        one.motion()
        points = one.tables["points"]
        assert points["C"] != before
        a, b, c, d = (unit_of(points[name]) for name in "ABCD")
        of_b = np.cross(a, b)
        tangent, towards = np.cross(d, c), np.cross(b, c)
        # C turns about D, and along the arc BC both ends have one speed
        along = (c - (b @ c) * b) / np.linalg.norm(towards)
        at_c = np.cross(towards, c) / np.linalg.norm(towards)
        rate = (of_b @ along) / (tangent @ at_c) * float(one.tables["drives"][0]["speed"])
        one.choose_curve(0, "point C velocity")
        shown = one.values()
        for axis, value in zip("xyz", rate * tangent, strict=True):
            assert abs(shown[f"v{axis}(C)"] - value) < 3 * SIX_DIGITS * max(1.0, abs(rate))
        assert one.messages == []


def test_a_great_circle_guides_a_point_of_the_sphere(running: Any, server: Served) -> None:
    """Drawn by keyboard: a crank, a rod, and a circle for its end; all lie where the text says."""
    with bench(running, server.address) as one:
        begin_on_sphere(one)
        press = one.page.keyboard.press
        one.page.focus(".stage-holder .drawing")
        press("ArrowRight")
        press("Enter")
        for _ in range(4):
            press("ArrowUp")
        one.gesture(lambda: press("Enter"))
        press("Enter")
        for _ in range(9):
            press("ArrowRight")
        one.gesture(lambda: press("Enter"))
        press("g")
        one.page.focus(".stage-holder .drawing")
        press("Enter")
        for _ in range(4):
            press("ArrowUp")
        one.gesture(lambda: press("Enter"))
        one.page.focus('[data-kind="link"][data-name="AB"]')
        press(" ")
        one.page.focus('[data-row="drive"]')
        one.gesture(lambda: press("Enter"))
        one.motion()
        guide, points = one.tables["guides"][0], one.tables["points"]
        assert guide["point"] == "C"
        assert abs(unit_of(guide["pole"]) @ unit_of(points["C"])) < 1e-5
        assert one.page.get_attribute('[data-kind="guide"]', "d")
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


def test_what_else_a_hand_does_is_done_by_keyboard(running: Any, server: Served) -> None:
    """A point on a link, a guide at it, several at once, the view, the drive's place, a photo's scale, the windows."""
    with bench(running, server.address) as one:
        press = one.page.keyboard.press
        one.template("crank-rocker")
        one.motion()
        one.page.focus('[data-kind="link"][data-name="AB"]')
        one.gesture(lambda: press("Enter"))
        assert one.names("point") == ["O", "D", "A", "B", "C"]
        one.page.focus('[data-kind="link"][data-name="OA"]')
        press(" ")
        one.page.focus('[data-kind="link"][data-name="DB"]')
        press("Shift+ ")
        assert one.page.inner_text(".selection h2").startswith("2 ")
        one.gesture(lambda: press("Control+d"))
        assert len(one.names("link")) == 5
        one.gesture(lambda: press("Control+z"))
        one.motion()
        press("m")
        one.page.focus('[data-kind="point"][data-name="A"]')
        before = one.page.input_value('[data-do="seek"]')
        press("ArrowUp")
        one.until(lambda: one.page.input_value('[data-do="seek"]') != before)
        one.settle()
        x, y = one.spot("O")
        one.page.focus(".stage-holder .drawing")
        press("Control+ArrowRight")
        frames(one.page)
        assert one.spot("O") == pytest.approx((x - 60, y), abs=0.2)
        one.page.click('[data-do="photo"]')
        one.page.locator("dialog input[type=file]").set_input_files(
            {"name": "grey.png", "mimeType": "image/png", "buffer": base64.b64decode(GREY)}
        )
        one.wait("document.querySelector('.photo').getAttribute('display') === 'inline'")
        wide = float(one.page.get_attribute(".photo", "width"))
        one.page.locator("dialog .buttons button", has_text="scale").focus()
        press("Enter")
        one.page.focus(".stage-holder .drawing")
        for key in ("ArrowRight", "Enter", "ArrowRight", "ArrowRight", "Enter"):
            press(key)
        one.page.wait_for_selector("#photo-length")
        drawn = float(one.page.input_value("#photo-length"))
        one.page.fill("#photo-length", str(3 * drawn))
        one.page.press("#photo-length", "Enter")
        one.until(lambda: float(one.page.get_attribute(".photo", "width")) > 2 * wide)
        one.page.focus('[role="tab"][aria-selected="true"]')
        press("ArrowRight")
        assert one.page.get_attribute("#tab-motion", "aria-selected") == "false"
        one.page.focus(".stage-holder .drawing")
        press("?")
        one.page.wait_for_selector("dialog.keys")
        press("Escape")
        one.wait("document.querySelector('dialog') === null")
        assert one.messages == []


def test_the_other_keys_and_buttons_by_keyboard(running: Any, server: Served) -> None:
    """Modes, view, player, text, deletion, join, mirror images, names, rows, locks, files: without a pointer."""
    with bench(running, server.address) as one:
        press, focus = one.page.keyboard.press, one.page.focus
        one.page.locator('[data-do="open"]').press("Enter")
        # focus and key in one call: what draws the dialog again between them would take the focus
        one.gesture(lambda: one.page.locator('[data-template="crank-rocker"]').press("Enter"))
        one.motion()
        first = one.text
        focus(".stage-holder .drawing")
        for key, mode in zip("gemd", ("guide", "edit", "move", "draw"), strict=True):
            press(key)
            assert one.page.get_attribute(f'.modes [data-mode="{mode}"]', "aria-pressed") == "true"
        apart = math.dist(one.spot("O"), one.spot("D"))
        press("+")
        frames(one.page)
        assert math.dist(one.spot("O"), one.spot("D")) == pytest.approx(1.25 * apart, rel=1e-3)
        press("-")
        press("f")
        frames(one.page)
        assert math.dist(one.spot("O"), one.spot("D")) == pytest.approx(apart, rel=1e-3)
        press("m")
        press(".")
        press(".")
        press(",")
        assert float(one.page.input_value('[data-do="seek"]')) == 1.0
        press("p")
        one.until(lambda: float(one.page.input_value('[data-do="seek"]')) > 2.0)
        press("p")
        focus('[data-do="seek"]')
        press("Home")
        assert float(one.page.input_value('[data-do="seek"]')) == 0.0
        focus(".stage-holder .drawing")
        press("t")
        one.page.wait_for_selector(".cm-content")
        one.page.locator(".text-pane .plain").focus()
        press("Enter")
        one.until(lambda: one.page.locator(".text-pane").count() == 0)
        focus('[data-kind="link"][data-name="AB"]')
        press(" ")
        one.page.locator(".dimension button").first.focus()
        one.gesture(lambda: press("Enter"))
        assert "locked links.AB.length" in one.text
        for row in ("mass", "load"):
            name = "AB" if row == "mass" else "B"
            focus(f'[data-kind="{"link" if row == "mass" else "point"}"][data-name="{name}"]')
            press(" ")
            focus(f'[data-row="{row}"]')
            one.gesture(lambda: press("Enter"))
        assert "mass" in one.tables["links"]["AB"] and one.tables["loads"][0]["point"] == "B"
        one.page.locator(".rename input").fill("K")
        one.gesture(lambda: one.page.locator(".rename input").press("Enter"))
        assert "K" in one.names("point") and one.tables["loads"][0]["point"] == "K"
        while one.text != first:
            press("Control+z") if one.page.evaluate("document.activeElement.tagName") != "INPUT" else focus(
                ".stage-holder .drawing"
            )
        one.motion()
        for name in ("mirror-upright", "mirror-level"):
            focus('[data-kind="point"][data-name="A"]')
            press(" ")
            focus('[data-kind="point"][data-name="B"]')
            press("Shift+ ")
            focus(f'[data-do="{name}"]')
            one.gesture(lambda: press("Enter"))
            focus(".stage-holder .drawing")
            one.gesture(lambda: press("Control+z"))
        assert one.text == first
        focus('[data-kind="link"][data-name="AB"]')
        press(" ")
        one.gesture(lambda: press("Delete"))
        assert "AB" not in one.names("link")
        press("Control+o")
        one.page.wait_for_selector("dialog.open")
        press("Escape")
        one.wait("document.querySelector('dialog') === null")
        assert one.messages == []


def test_a_joint_dropped_on_another_one_is_joined(running: Any, server: Served) -> None:
    """By hand in Edit, and by the button of two that are selected; on the globe an arrow key turns it in Move."""
    with bench(running, server.address) as one:
        one.draw((0.25, 0.7), (0.33, 0.5))
        one.draw((0.55, 0.4), (0.7, 0.7))
        assert one.names("link") == ["AB", "CD"]
        apart = one.text
        one.mode("edit")
        one.gesture(lambda: one.drag("C", "B"))
        assert len(one.names("point")) == 3
        joined = one.text
        one.page.focus(".stage-holder .drawing")
        one.gesture(lambda: one.page.keyboard.press("Control+z"))
        assert one.text == apart
        for key, name in ((" ", "C"), ("Shift+ ", "B")):
            one.page.focus(f'[data-kind="point"][data-name="{name}"]')
            one.page.keyboard.press(key)
        one.page.focus('[data-do="join"]')
        one.gesture(lambda: one.page.keyboard.press("Enter"))
        assert one.text == joined
        one.template("spherical-four-bar")
        one.motion()
        one.mode("move")
        one.page.focus(".stage-holder .drawing")
        before = one.spot("B")
        one.page.keyboard.press("ArrowRight")
        frames(one.page)
        assert one.spot("B") != pytest.approx(before, abs=1.0)
        one.mode("edit")
        first = one.tables
        one.page.focus('[data-kind="point"][data-name="C"]')
        one.gesture(lambda: one.page.keyboard.press("ArrowUp"))
        assert one.tables["links"]["DC"]["length"] != first["links"]["DC"]["length"]
        assert one.tables["frame"] == first["frame"]
        assert one.messages == []


def test_a_hand_lets_go_and_keeps_to_links(running: Any, server: Served) -> None:
    """Escape drops nothing, no key acts under a hand; a line from a link is one step, its point the link's middle."""
    with bench(running, server.address) as one:
        four_bar(one)
        before, mouse, press = one.text, one.page.mouse, one.page.keyboard.press
        for mode in ("draw", "edit"):
            one.mode(mode)
            mouse.move(*one.spot("C"))
            mouse.down()
            mouse.move(*one.spot((0.5, 0.5)), steps=4)
            for key in ("Control+z", "Delete", "Escape"):
                press(key)
            mouse.move(*one.spot((0.45, 0.5)))
            mouse.up()
            one.settle()
            assert one.text == before and one.page.locator(".sketch > *").count() == 0
        one.mode("draw")
        one.page.locator('[data-do="seek"]').fill("100")  # the drawing goes back, the hand keeps what it took
        one.draw("BC", (0.85, 0.3))
        at = places_of(one)
        assert at["E"] == pytest.approx((at["B"] + at["C"]) / 2, abs=1e-4)
        assert one.tables["links"]["BC"]["points"] == ["B", "C", "E"] and len(one.names("link")) == 4
        one.gesture(lambda: press("Control+z"))
        assert one.text == before
        one.mode("guide")
        one.draw("C", "AB")
        assert one.tables["guides"] == [{"point": "C", "on": "AB", "direction": [1, 0]}]
        one.gesture(lambda: press("Control+z"))
        one.click("C")
        name = one.page.locator(".rename input")
        name.fill("B")
        name.press("Enter")
        one.wait("document.querySelector('.rename input').ariaInvalid === 'true'")
        name.blur()
        assert name.input_value() == "C" and one.text == before
        assert one.messages == []


DROPPED = """(text) => {
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([text], "dropped.toml"));
  return dispatchEvent(new DragEvent("drop", { dataTransfer, cancelable: true }));
}"""


def test_a_file_that_is_dropped_on_the_page_is_opened_where_it_begins(running: Any, server: Served) -> None:
    """The range of the drive begins elsewhere: in Edit the joints stand at the place of the description."""
    text = example_text("double-rocker")
    places = SketchParts(read_document(text, Path())).places
    with bench(running, server.address) as one:
        one.gesture(lambda: one.page.evaluate(DROPPED, text))
        one.motion()
        one.mode("edit")
        frames(one.page)
        seen = {name: np.array(one.spot(name)) for name in "OBD"}
        shown = math.dist(seen["B"], seen["D"]) / math.dist(seen["O"], seen["D"])
        drawn = math.dist(places["B"], places["D"]) / math.dist(places["O"], places["D"])
        across = math.dist(seen["O"], seen["B"]) / math.dist(seen["O"], seen["D"])
        assert shown == pytest.approx(drawn, rel=2e-3)
        assert across == pytest.approx(
            math.dist(places["O"], places["B"]) / math.dist(places["O"], places["D"]), rel=2e-3
        )
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


TOLERANCES = """
[tolerances]
default = "±0.1 mm"
[tolerances.clearances]
B = "0.05 mm"
[tolerances.outputs]
swing = { formula = "range(angle_DB)", deviation = "0.1 deg" }
rocker = "angle.DB"
"""


def test_tolerances_are_a_panel_with_bars_and_bands(running: Any, server: Served) -> None:
    """Limits written into the text open a panel: bars of contributions, bands over the cycle, the histogram."""
    with bench(running, server.address, wide=1600) as one:
        one.template("crank-rocker")
        one.motion()
        tab = one.page.locator('[role="tab"]', has_text="Accuracy of the mechanism")
        one.page.click('[data-do="text"]')
        one.page.wait_for_selector(".cm-content")
        one.page.click(".cm-content")
        one.page.keyboard.press("Control+End")
        one.gesture(lambda: one.page.keyboard.insert_text(TOLERANCES))
        one.motion()
        tab.click()
        one.until(lambda: one.page.locator("#panel figure svg").count() == 3)
        said = one.page.inner_text("#panel")
        assert "all move: 32 corners" in said
        assert "links.AB.length" in said
        assert "kept in the worst case" in said
        labels = one.page.locator("#panel figure figcaption").all_inner_texts()
        assert labels == ["Contributions of the numbers", "Deviations within the limits", "Drawn mechanisms"]
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


def test_segments_are_added_and_deleted_by_keyboard(running: Any, server: Served) -> None:
    """Angles of the text sum up to a turn, the follower waits in the new one, and undo brings the bytes back."""
    with bench(running, server.address) as one:
        one.template("indexing-cam")
        one.motion()
        first = one.text
        rows = one.page.locator(".segment")
        assert rows.count() == 4
        one.page.locator('[data-do="add-segment"]').first.focus()
        one.gesture(lambda: one.page.keyboard.press("Enter"))
        one.until(lambda: rows.count() == 5)
        angles = [float(segment["angle"].split()[0]) for segment in one.tables["segments"]]
        assert angles == [60, 60, 60, 110, 70]
        one.page.locator('[data-do="seek"]').fill("90")
        frames(one.page)
        assert one.page.locator(".legend .entry").first.inner_text().split(" = ")[1] == "24.000°"
        one.page.locator('[data-do="delete-segment"]').nth(1).focus()
        one.gesture(lambda: one.page.keyboard.press("Enter"))
        one.until(lambda: rows.count() == 4)
        assert one.text == first
        one.gesture(lambda: one.page.keyboard.press("Control+z"))
        assert len(one.tables["segments"]) == 5
        select = one.page.locator(".segment select").nth(1)
        one.gesture(lambda: select.select_option("harmonic"))
        assert one.tables["segments"][1] == {"angle": "60 deg", "curve": "harmonic", "to": 0}
        assert one.messages == []


PMKS = (
    "https://app.pmksplus.com/?0.Fe.A,0.2111.6A,A,0,0,0.0B,B,0,Fe,0.0C,C,ku,V8,0.4D,D,_W,0,0"
    "..YRAB,AB,Fe,Fe,0,0,,A,B,,.YRBC,BC,Fe,Fe,0,0,,B,C,,.YRCD,CD,Fe,Fe,0,0,,C,D,,...NH"
)


def test_a_link_of_another_program_is_opened(running: Any, server: Served) -> None:
    """The drawing of PMKS+ stands there and moves; a damaged link is refused in words and changes nothing."""
    with bench(running, server.address) as one:
        one.page.click('[data-do="open"]')
        before = one.text
        one.page.fill(LINK_FIELD, PMKS[:-40])
        one.page.press(LINK_FIELD, "Enter")
        one.page.wait_for_selector("dialog .bad")
        assert one.page.inner_text("dialog .bad") and one.text == before
        one.page.fill(LINK_FIELD, PMKS)
        one.gesture(lambda: one.page.press(LINK_FIELD, "Enter"))
        one.motion()
        assert sorted(one.names("link")) == ["AB", "BC", "CD"]
        assert one.names("point") == ["A", "D", "B", "C"] and one.page.locator("dialog").count() == 0
        a, d = (np.array(one.spot(name)) for name in "AD")
        assert a[1] == pytest.approx(d[1], abs=0.6)  # both lie on the x axis
        assert one.messages == []


BARS = b'<svg width="140mm" height="90mm" viewBox="0 -90 140 90"><path d="M0 0L30-40L120-90L140 0"/></svg>'


def test_a_drawing_from_this_computer_is_opened(running: Any, server: Served) -> None:
    """The linkage of a drawing stands there, and what was guessed is told; a damaged one is refused in words."""
    with bench(running, server.address) as one:
        before = one.text
        one.page.click('[data-do="open"]')
        field = one.page.locator('dialog input[type="file"]')
        field.set_input_files({"name": "bars.svg", "mimeType": "image/svg+xml", "buffer": BARS[:-20]})
        one.page.wait_for_selector("dialog .bad")
        assert one.page.inner_text("dialog .bad") and one.text == before
        one.gesture(
            lambda: field.set_input_files({"name": "bars.svg", "mimeType": "image/svg+xml", "buffer": BARS})
        )
        one.motion()
        assert sorted(one.names("link")) == ["AB", "BC", "CD"]
        assert "# guessed: no layer is named ground" in one.text
        assert one.messages == []


def test_several_drives_follow_the_hand(running: Any, server: Served) -> None:
    """The tip of the arm goes where it is put, the drop writes both starts, and undo takes them back."""
    with bench(running, server.address) as one:
        one.template("two-link-arm")
        one.motion()
        first = one.text
        one.mode("move")
        begin = np.array(one.spot("B"))
        goal = begin + np.array([-60, -70])
        one.gesture(lambda: one.drag("B", tuple(parts_of(one, goal))))
        one.motion()
        assert one.spot("B") == pytest.approx(tuple(goal), abs=1.5)
        assert [drive["start"] for drive in one.tables["drives"]] != [0.0, 0.0]
        one.gesture(lambda: one.page.keyboard.press("Control+z"))
        assert one.text == first
        assert one.messages == []


def parts_of(one: Bench, spot: np.ndarray) -> tuple[float, float]:
    """A place on the screen as parts of the sides of the drawing."""
    box = one.page.locator(".stage-holder .drawing").bounding_box()
    return (spot[0] - box["x"]) / box["width"], (spot[1] - box["y"]) / box["height"]


def test_fingers_draw_drag_turn_and_pinch(running: Any, server: Served) -> None:
    """Touches as the browser itself makes them: one finger draws and drags, two move and scale the paper."""
    with bench(running, server.address, has_touch=True) as one:
        touch = one.page.context.new_cdp_session(one.page)

        def fingers(kind: str, *places: tuple[float, float]) -> None:
            points = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(places)]
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        def swipe(start: Any, end: Any) -> None:
            (x, y), (u, v) = one.spot(start), one.spot(end)
            fingers("touchStart", (x, y))
            for k in range(1, 7):
                fingers("touchMove", (x + (u - x) * k / 6, y + (v - y) * k / 6))
            fingers("touchEnd")

        one.gesture(lambda: swipe((0.25, 0.7), (0.33, 0.55)))
        one.gesture(lambda: swipe("B", (0.65, 0.35)))
        assert one.names("link") == ["AB", "BC"]
        x, y = one.spot("AB")
        one.page.touchscreen.tap(x, y)
        one.page.wait_for_selector('[data-row="drive"]')
        one.mode("edit")
        before = one.tables["points"]["C"]
        one.gesture(lambda: swipe("C", (0.7, 0.45)))
        assert one.tables["points"]["C"] != before
        text, apart = one.text, math.dist(one.spot("A"), one.spot("C"))
        left, right = one.spot((0.4, 0.5)), one.spot((0.6, 0.5))
        fingers("touchStart", left, right)
        for k in range(1, 7):
            fingers("touchMove", (left[0] - 10 * k, left[1]), (right[0] + 10 * k, right[1]))
        fingers("touchEnd")
        frames(one.page)
        scale = (right[0] - left[0] + 120) / (right[0] - left[0])
        assert math.dist(one.spot("A"), one.spot("C")) == pytest.approx(scale * apart, rel=0.02)
        assert one.text == text
        assert one.messages == []


def test_a_photo_gets_the_scale_of_a_known_length(running: Any, server: Served) -> None:
    with bench(running, server.address) as one:
        one.page.click('[data-do="photo"]')
        one.page.locator("dialog input[type=file]").set_input_files(
            {"name": "grey.png", "mimeType": "image/png", "buffer": base64.b64decode(GREY)}
        )
        one.wait("document.querySelector('.photo').getAttribute('display') === 'inline'")

        def wide() -> float:
            """Metres that the photo is wide."""
            return float(one.page.evaluate("JSON.parse(localStorage.getItem('centrode.photo')).wide"))

        before = wide()
        one.page.locator("dialog .buttons button", has_text="scale").click()
        one.drag((0.4, 0.5), (0.6, 0.5))
        one.page.wait_for_selector("#photo-length")
        drawn = float(one.page.input_value("#photo-length"))
        one.page.fill("#photo-length", str(2 * drawn))
        one.page.press("#photo-length", "Enter")
        one.until(lambda: wide() > 1.5 * before)
        assert wide() == pytest.approx(2 * before, rel=1e-3)
        assert one.messages == []
