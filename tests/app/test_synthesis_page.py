"""The page of syntheses in a browser: a path drawn, answers found, one put into the workbench."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.model.files import mechanism_from
from report.test_mechanism_page import AXE

from .bench import STORE
from .served import Served
from .test_accessible_bench import AUDIT, WIDE, WIDTHS
from .test_shared_links import packed

TICKET = "0123456789abcdef" * 2
POSES = [["0 mm", "0 mm", "0 deg"], ["30 mm", "10 mm", "20 deg"], ["50 mm", "40 mm", "50 deg"]]
LOOP = [(60 * math.cos(turn), 25 * math.sin(turn)) for turn in np.linspace(0, 2 * np.pi, 41)]
"""What the hand draws [mm]."""


@pytest.fixture
def page(running: Any, server: Served) -> Iterator[Any]:
    one = running.new_page(viewport={"width": 1400, "height": 900})
    one.set_default_timeout(170_000)
    one.goto(f"http://127.0.0.1:{server.port}/synthesis?token={server.token}&language=en")
    one.wait_for_selector("#search")
    yield one
    one.close()


def place_on(page: Any, place: tuple[float, float]) -> tuple[float, float]:
    """Where a place [mm] of the sheet is in the window."""
    found = page.evaluate(
        "([x, y]) => { const at = new DOMPoint(x, -y).matrixTransform(document.querySelector('#canvas')"
        ".getScreenCTM()); return [at.x, at.y]; }",
        list(place),
    )
    return float(found[0]), float(found[1])


def parsed_mechanism(text: str) -> Any:
    """What a text describes."""
    return mechanism_from(tomllib.loads(text))


def rows_of(page: Any) -> list[list[float]]:
    """The targets as the page lists them."""
    return [[float(part) for part in row.split()] for row in page.input_value("#targets").splitlines()]


def test_a_drawn_path_becomes_a_mechanism_of_the_workbench(page: Any, server: Served) -> None:
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.mouse.move(*place_on(page, LOOP[0]))
    page.mouse.down()
    for place in LOOP[1:]:
        page.mouse.move(*place_on(page, place))
    page.mouse.up()
    drawn = np.array(rows_of(page)) @ [1, 1j]
    # A closed line at equal steps: all on the ellipse, as exactly as a pixel and 41 chords have it.
    assert len(drawn) == 20
    assert page.is_checked("#closed")
    assert np.abs(np.hypot(drawn.real / 60, drawn.imag / 25) - 1).max() < 0.05
    page.click("#search")
    page.wait_for_selector("#answers .card[aria-pressed='true']")
    said = page.inner_text("#answers li:first-child .card")
    assert "r.m.s. error" in said and "least transmission angle" in said and "size" in said
    assert page.get_attribute("#canvas .traced", "d").count("L") > 90
    # Another answer is looked at, and the best one goes into the workbench.
    page.click("#answers li:nth-child(2) .card")
    page.click("#answers li:first-child .card")
    page.click("#insert")
    page.wait_for_selector(".stage-holder .drawing [data-kind='link']")
    kept = page.evaluate(f"dispatchEvent(new Event('pagehide')), sessionStorage.getItem('{STORE}')")
    mechanism = parsed_mechanism(json.loads(kept)["text"])
    assert mechanism.drives[0].link == "OA"
    path = ct.motion(mechanism, 1441).position.sel(point="P").to_numpy() @ [1, 1j] * 1e3
    missed = np.abs(path[:, None] - drawn[None]).min(axis=0)
    stated = float(said.split("r.m.s. error: ")[1].split("\u00a0")[0].split()[0])
    # As near as the card says; samples of the path lie some tenths of a millimetre apart.
    assert math.sqrt((missed**2).mean()) < max(1.02 * stated, 0.2) < 3
    # What was there before comes back.
    page.click('[data-do="undo"]')
    page.wait_for_function("() => !document.querySelector(\".stage-holder .drawing [data-kind='link']\")")
    assert errors == []


def test_poses_by_the_keyboard_alone(page: Any) -> None:
    page.select_option("#kind", "motion")
    page.focus("#canvas")
    for keys in (
        "Enter",
        "ArrowRight ArrowRight Shift+ArrowRight ArrowUp , Enter",
        "ArrowUp ArrowUp , , Enter",
        "Enter",
        "Backspace",
    ):
        for key in keys.split():
            page.keyboard.press(key)
    assert rows_of(page) == [[0, 0, 0], [30, 5, 15], [30, 15, 45]]
    page.focus("#search")
    page.keyboard.press("Enter")
    page.wait_for_selector("#answers .card")
    assert page.locator("#canvas .pose").count() == 3
    # Other targets: the answers were for those before.
    page.focus("#canvas")
    page.keyboard.press("Backspace")
    assert page.locator("#answers .card").count() == 0
    assert page.is_disabled("#insert")


def test_a_function_and_strokes(page: Any) -> None:
    page.select_option("#kind", "function")
    assert not page.is_visible("#closed") and page.is_visible("#formula")
    assert page.input_value("#transmission") == "30" and page.input_value("#length_ratio") == "6"
    page.click("#search")
    page.wait_for_selector("#answers .card")
    said = page.inner_text("#answers li:first-child .card")
    assert float(said.split("least transmission angle: ")[1].split("\u00a0")[0].split()[0].rstrip("°")) >= 30
    page.fill("#transmission", "")
    page.fill("#length_ratio", "")
    page.click("#search")
    page.wait_for_selector("#answers .card")
    said = page.inner_text("#answers li:first-child .card")
    # log10 x over 60 and 90 deg: 0.00697 deg is the least greatest error that is known
    greatest = float(said.split("greatest error: ")[1].split("\u00a0")[0].split()[0].rstrip("°"))
    assert 0.0065 < greatest < 0.0071
    page.fill("#targets", "0 0\n14 20\n33 42\n47 55\n60 63")
    page.click("#search")
    page.wait_for_selector("#answers .card")
    page.select_option("#kind", "strokes")
    assert page.is_visible("#swing") and not page.is_visible("#stroke") and not page.is_visible("#targets")
    page.fill("#transmission", "35")
    page.click("#search")
    page.wait_for_selector("#answers .card")
    said = page.inner_text("#answers li:first-child .card")
    assert "time ratio: 1.25" in said and "swing: 40" in said
    page.select_option("#topology", "whitworth-quick-return")
    assert page.is_visible("#stroke") and page.locator("#answers .card").count() == 0
    page.fill("#transmission", "")
    page.click("#search")
    page.wait_for_selector("#answers .card")
    assert "stroke: 100" in page.inner_text("#answers li:first-child .card")
    assert page.locator("#canvas .links").count() == 1


def test_a_trade_off(page: Any) -> None:
    """None of the answers is worse than another in both its error and its transmission angle."""
    page.fill("#targets", "\n".join(f"{x:.3f} {y + 0.004 * x * x:.3f}" for x, y in LOOP[:-1:4]))
    page.fill("#size", "")
    page.select_option("#trade_off", "transmission")
    page.click("#search")
    page.wait_for_selector("#answers .card")
    cards = [card.inner_text() for card in page.locator("#answers .card").all()]

    def numbers(name: str) -> list[float]:
        return [float(card.split(name)[1].split("\u00a0")[0].split()[0].rstrip("°")) for card in cards]

    errors, angles = numbers("r.m.s. error: "), numbers("least transmission angle: ")
    assert len(cards) > 1
    assert errors == sorted(errors) and angles == sorted(angles)


def test_the_workbench_leads_here(running: Any, server: Served) -> None:
    page = running.new_page()
    page.set_default_timeout(170_000)
    page.goto(f"http://127.0.0.1:{server.port}/?token={server.token}&language=en")
    page.click('[data-do="open"]')
    page.click('[data-do="synthesis"]')
    page.wait_for_selector("#search")
    assert "/synthesis" in page.url
    page.close()


def test_what_is_wrong_is_said_and_a_search_is_stopped(page: Any) -> None:
    page.fill("#targets", "1 2")
    page.click("#search")
    page.wait_for_selector("#said:has-text('targets')")
    page.fill("#targets", "\n".join(f"{x:.3f} {y + 9 * math.sin(3 * x):.3f}" for x, y in LOOP[:-1]))
    page.click("#search")
    page.click("#stop")
    page.wait_for_selector("#search:not([disabled])")
    assert page.inner_text("#said") != ""


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_everybody_can_use_it(running: Any, server: Served, language: str) -> None:
    """Audited by day and at night at every width in English; other words change neither colours nor parts."""
    page = running.new_page()
    page.set_default_timeout(170_000)
    page.goto(f"http://127.0.0.1:{server.port}/synthesis?token={server.token}&language={language}")
    page.wait_for_selector("#search")
    page.evaluate(AXE.read_text("utf-8"))
    page.select_option("#kind", "motion")
    page.fill("#targets", "0 0 0\n30 10 20\n50 40 50")
    page.click("#search")
    page.wait_for_selector("#answers .card")
    for kind in ("motion", "path", "function", "strokes"):
        if kind != "motion":
            page.select_option("#kind", kind)
        for scheme in ("light", "dark") if language == "en" else ("light",):
            page.emulate_media(color_scheme=scheme)
            for wide in WIDTHS:
                page.set_viewport_size({"width": wide, "height": 900})
                assert page.evaluate(WIDE) == 0
                if language == "en" or wide == WIDTHS[0]:
                    assert page.evaluate(AUDIT, ["html", []]) == []
    page.close()


def test_answers(ask: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    words = ask("synthesis", want="words", language="uk")["words"]
    assert set(words) >= {"title", "search", "insert"}
    wanted = {"kind": "motion", "targets": POSES, "answers": 2}
    found = ask("synthesise", ticket=TICKET, wanted=wanted)
    assert found["complete"] and len(found["answers"]) == 2
    for answer in found["answers"]:
        mechanism = parsed_mechanism(answer["text"])
        assert {"O", "A", "B", "D"} <= set(answer["points"])
        crank = complex(*answer["points"]["A"]) - complex(*answer["points"]["O"])
        start = mechanism.drives[0].start
        assert abs(np.angle(crank / np.exp(1j * start))) < 1e-4
    # Files by which it was followed are gone; a search that is not there has no share.
    assert list(tmp_path.iterdir()) == []
    assert ask("synthesis", want="progress", ticket=TICKET)["share"] == 0
    folder = tmp_path / f"centrode-synthesis-{TICKET}"
    folder.mkdir()
    (folder / "share").write_text("0.25")
    assert ask("synthesis", want="stop", ticket=TICKET)["share"] == 0.25
    assert (folder / "stop").exists()
    for name, wrong in (
        ("synthesis", {"want": "other"}),
        ("synthesis", {"want": "stop", "ticket": "../../etc"}),
        ("synthesise", {"ticket": TICKET}),
        ("synthesise", {"ticket": "x", "wanted": wanted}),
        ("synthesise", {"ticket": "f" * 32, "wanted": {"kind": "strokes", "stroke": 1}}),
        ("synthesise", {"ticket": "f" * 32, "wanted": {"kind": "path", "targets": [[0, 0]]}}),
    ):
        assert "error" in ask(name, **wrong)


OPEN = """# the mechanism of the window
title = "Lever"
display = { length = "mm", angle = "deg" }

[frame.points]
O = [0, 0]
D = ["92 mm", 0] # stays

[links]
OA = { length = "40 mm" }
AB = { length = "112 mm" }
DB = { length = "116 mm" }

[[drives]]
link = "OA"
start = 0
speed = 1

[assembly]
sides = { B = "left" }
"""


def test_the_open_mechanism_by_the_keyboard(running: Any, server: Served) -> None:
    """Other dimensions of what the workbench has: sought, stopped where it is wanted, and put into its text."""
    page = running.new_page(viewport={"width": 1400, "height": 900})
    page.set_default_timeout(170_000)
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    link = "#m=" + packed(OPEN.encode())
    page.goto(f"http://127.0.0.1:{server.port}/?token={server.token}&language=uk{link}")
    page.wait_for_selector(".stage-holder .drawing [data-kind='link']", state="attached")
    page.goto(f"http://127.0.0.1:{server.port}/synthesis?token={server.token}&language=uk")
    page.wait_for_selector("#search")
    page.focus("#of_mechanism")
    page.keyboard.press("ArrowDown")
    assert page.input_value("#of_mechanism") == "open" and "Lever" in page.inner_text("#of_mechanism")
    assert page.locator("#canvas .links").count() == 1
    page.focus("#kind")
    for _step in range(3):
        page.keyboard.press("ArrowDown")
    assert page.is_visible("#output") and not page.is_visible("#topology")
    page.select_option("#output", "angle.DB")
    page.fill("#swing", "60")
    # only the rocker may change: the others are released with the space bar
    for path in ("links.OA.length", "links.AB.length"):
        page.focus(f"[id='free {path}']")
        page.keyboard.press("Space")
    page.evaluate(AXE.read_text("utf-8"))
    assert page.evaluate(AUDIT, ["html", []]) == []
    page.focus("#search")
    page.keyboard.press("Enter")
    page.wait_for_selector("#answers .card[aria-pressed='true']")
    page.focus("#insert")
    page.keyboard.press("Enter")
    page.wait_for_selector(".stage-holder .drawing [data-kind='link']", state="attached")
    kept = page.evaluate(f"dispatchEvent(new Event('pagehide')), sessionStorage.getItem('{STORE}')")
    text = json.loads(kept)["text"]
    mechanism = parsed_mechanism(text)
    swing = np.ptp(ct.motion(mechanism, 721).angle.sel(link="DB").to_numpy())
    assert np.degrees(swing) == pytest.approx(60, abs=0.01)
    assert "# stays" in text and [mechanism.links[name].length for name in ("OA", "AB")] == [0.04, 0.112]
    page.click('[data-do="undo"]')
    page.wait_for_function(
        "([store, text]) => (dispatchEvent(new Event('pagehide')), JSON.parse(sessionStorage.getItem(store)).text "
        "=== text)",
        arg=[STORE, OPEN],
    )
    assert errors == []
    page.close()
