"""Pages on which a reader changes a mechanism: what they hold and refuse, and that hands and keys get the motion."""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import json
import re
import shlex
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.cli.main import main
from centrode.locale import choose_language, speaking
from centrode.model.examples import example_text
from centrode.model.files import parse_mechanism, value_at, with_values
from centrode.report.mechanism_page.driving_cams import cams_of
from centrode.report.mechanism_page.handles import handles_of
from centrode.report.mechanism_page.numbers_that_vary import joints_of, ranges_of
from centrode.report.mechanism_page.page_file import mechanism_page

from .browser import Seen, frames, opened, until
from .made import HOSTILE

PLANE, SPHERE, LOCKED, BRANCHED = (
    "crank-rocker",
    "spherical-four-bar",
    "slider-between-cranks-locked",
    "antiparallelogram",
)
REDUNDANT = "three-crank-parallelogram"
LIMITS = (1.79991241652444, 5.47487058607948)
"""Of the locked one [rad]: where its coupler and rocker come into line; its file says where they are from."""
LARGE = ("excavator-arm", "jansen-leg", "five-bar-two-drives", "andrews-squeezer")
BYTES = 250_000
AXE = Path(__file__).with_name("axe") / "axe.min.js"
AXE_SUM = "880970c081707360e64f34cea25ff91892f5bc95675b0776925b9709dd8a68bb"
CLIPBOARD = ["clipboard-read", "clipboard-write"]
DATA = re.compile(r'<script type="application/json" id="page-data">(.*?)</script>', re.DOTALL)


@pytest.fixture(autouse=True)
def english_again() -> Iterator[None]:
    yield
    choose_language("en")


# What the reader changes, and what follows a hand.


@pytest.mark.parametrize("name", ["six-bar-press", "whitworth-quick-return", SPHERE, "excavator-arm"])
def test_every_number_has_a_range_around_it(name: str) -> None:
    mechanism = ct.example(name)
    for path, (least, most) in ranges_of(mechanism).items():
        assert least < value_at(mechanism, path) < most


def test_joints_on_the_axis_of_a_link_stay_on_it() -> None:
    """The press: lengths of links given by coordinates, the frame, the line of the slider; centres of mass stay."""
    assert list(ranges_of(ct.example("six-bar-press"))) == [
        "links.OA.length",
        "links.AB.points.B.x",
        "links.CD.points.B.x",
        "links.CD.points.D.x",
        "links.DH.points.H.x",
        *(f"frame.points.{point}.{axis}" for point in "OC" for axis in "xy"),
        "guides.H.through.y",
    ]
    assert joints_of(ct.example("six-bar-press")) == set("OABCDH")
    assert not any("Z" in path for path in ranges_of(ct.example(SPHERE)))  # it only tells where angles begin


def ways(name: str, paths: list[str] | None = None) -> dict[str, list[dict[str, Any]]]:
    """Name of a joint -> what follows its handle."""
    mechanism = ct.example(name)
    points, links = list(mechanism.points), list(mechanism.links)
    chosen = list(ranges_of(mechanism)) if paths is None else paths
    return {points[one["point"]]: one["ways"] for one in handles_of(mechanism, points, links, chosen)}


def test_a_handle_moves_the_lengths_of_its_links() -> None:
    found = ways("six-bar-press")
    assert {way["path"] for way in found["B"]} == {"links.AB.points.B.x", "links.CD.points.B.x"}
    assert [way["kind"] for way in found["O"]] == ["frame"]
    assert {way["kind"] for way in found["H"]} == {"guide", "length"}
    assert found["A"][0] == {
        "kind": "length",
        "path": "links.OA.length",
        "other": 0,
        "sign": 1,
        "driven": True,
    }


def test_what_does_not_vary_has_no_handle() -> None:
    assert list(ways(PLANE, ["links.AB.length"])) == ["A", "B"]
    assert ways(PLANE, []) == {}


# The file and the command.


@pytest.mark.parametrize("name", LARGE)
def test_a_page_is_small_and_the_same_each_time(name: str) -> None:
    page = mechanism_page(name, language="uk")  # two bytes a letter
    assert len(page.encode()) <= BYTES
    assert mechanism_page(name, language="uk") == page


def test_a_page_loads_nothing_and_runs_its_own_scripts() -> None:
    page = mechanism_page(PLANE)
    assert "default-src 'none'" in page
    assert not re.search(r'(?:src|href)="', page)
    assert "eval(" not in page and "new Function" not in page


def test_names_of_users_end_no_script() -> None:
    hostile = ct.example(PLANE).model_copy(update={"title": f"</script>{HOSTILE}"})
    page = mechanism_page(hostile)
    assert page.count("</script>") == 3  # the data and two scripts
    data = json.loads(DATA.findall(page)[0])
    assert data["program"]["title"] == f"</script>{HOSTILE}"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["third-class-triad"], "third-class-triad"),
        ([PLANE, "--vary", "links.AB.length"], 'write "links.AB.length=3 m:4 m"'),
        ([PLANE, "--vary", "links.AB.length=4 m:3 m"], "give the lesser end first"),
        ([PLANE, "--vary", "links.AC.length=1 m:3 m"], "AC"),
        ([PLANE, "--out", "page.pdf"], ".html"),
        (["walking-wheel-four-legs"], "centrode cam"),
    ],
)
def test_what_cannot_be_a_page_is_refused(
    arguments: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["--lang", "en", "page", *arguments]) == 2
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_a_page_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    command = ["--lang", "en", "page", PLANE, "--language", "uk", "--vary", "links.AB.length=3 m:4 m"]
    assert main(command) == 0
    page = Path(f"{PLANE}.html").read_text(encoding="utf-8")
    assert '<html lang="uk">' in page
    assert [one["path"] for one in json.loads(DATA.findall(page)[0])["program"]["parameters"]] == [
        "links.AB.length"
    ]
    assert main(command) == 2
    assert "--force" in capsys.readouterr().err


# In a browser.


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """File of a mechanism's page in a language."""
    folder = tmp_path_factory.mktemp("pages")

    def page(name: str, language: str = "en") -> Path:
        file = folder / f"{name}-{language}.html"
        if not file.exists():
            file.write_text(mechanism_page(name, language=language), encoding="utf-8")
        return file

    return page


class Hand:
    """What a reader does on a page."""

    def __init__(self, seen: Seen) -> None:
        self.page = seen.page
        self.page.context.grant_permissions(CLIPBOARD)

    def joint(self, name: str) -> np.ndarray:
        """Where a joint's handle is on the screen."""
        box = self.page.query_selector(f'[data-handle="{name}"] .collar').bounding_box()
        return np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])

    def drag(self, name: str, way: tuple[float, float]) -> None:
        start = self.joint(name)
        self.page.mouse.move(*start)
        self.page.mouse.down()
        self.page.mouse.move(*(start + way), steps=4)
        frames(self.page)
        self.end = self.joint(name)
        self.page.mouse.up()
        frames(self.page)

    def copied(self, what: str) -> str:
        """The text that a button copies."""
        self.page.evaluate("navigator.clipboard.writeText('')")
        self.page.click(f'[data-do="{what}"]')
        until(self.page, lambda: bool(self.page.evaluate("navigator.clipboard.readText()")))
        return str(self.page.evaluate("navigator.clipboard.readText()"))

    def values(self) -> dict[str, float]:
        """Path -> value [SI] of every dimension, as the link keeps them."""
        link = self.copied("copy-link").partition("#s=")[2].split(".")[1]
        told = self.page.evaluate("(told) => atob(told.replaceAll('-', '+').replaceAll('_', '/'))", link)
        return dict(json.loads(told)["v"])

    def table(self, separator: str = ",") -> list[list[str]]:
        return list(csv.reader(io.StringIO(self.copied("csv")), delimiter=separator))

    @property
    def statuses(self) -> str:
        return str(self.page.inner_text(".statuses"))

    @property
    def said(self) -> str:
        return str(self.page.inner_text("#said"))


def test_hands_and_keys_change_the_motion(running: Any, pages: Callable[..., Path]) -> None:
    """A joint goes where the hand takes it, and the motion is that of the mechanism with these lengths."""
    mechanism = ct.example(PLANE)
    file = pages(PLANE)
    with opened(running, file) as seen:
        hand = Hand(seen)
        start = hand.joint("B")
        hand.drag("B", (40.0, -25.0))
        np.testing.assert_allclose(
            hand.end, start + np.array([40.0, -25.0]), atol=0.2
        )  # of a tenth of a pixel
        hand.drag("D", (-30.0, 20.0))
        seen.page.focus('[data-handle="A"]')
        seen.page.keyboard.press("Shift+ArrowRight")
        assert re.match(r"OA = 1\.\d+ m; AB = \d\.\d+ m", hand.said)
        seen.page.focus(".rows input[type=range]")
        seen.page.keyboard.press("ArrowRight")
        seen.page.fill(".rows input[type=text] >> nth=2", "3,1")
        seen.page.keyboard.press("Tab")
        frames(seen.page)
        values = hand.values()
        assert values["links.DB.length"] == 3.1
        assert {"links.OA.length", "links.AB.length", "frame.points.D.x", "frame.points.D.y"} <= set(values)
        head, *rows = hand.table()
        motion = ct.motion(with_values(mechanism, values))
        for name, column in (("position", "{axis}(B) [m]"), ("acceleration", "a_{axis}(B) [m/s²]")):
            for axis in "xy":
                place = head.index(column.format(axis=axis))
                found = [float(row[place]) for row in rows]
                wanted = motion[name].sel(point="B", axis=axis).values
                # printed with 15 digits; accelerations within 1e-13 times the square of the condition, here some 20
                np.testing.assert_allclose(
                    found, wanted, rtol=0, atol=5e-11 if name == "acceleration" else 1e-13 * 4
                )
        for _ in range(5):
            seen.page.keyboard.press("Escape")
            seen.page.click('[data-do="undo"]')
            frames(seen.page)
        assert seen.page.is_disabled('[data-do="reset"]')
        assert seen.messages == []
        assert [one for one in seen.requests if not one.startswith("data:")] == [file.as_uri()]


def test_links_keep_dimensions_and_are_refused_in_words(running: Any, pages: Callable[..., Path]) -> None:
    with opened(running, pages(PLANE)) as seen:
        hand = Hand(seen)
        seen.page.fill(".rows input[type=text] >> nth=0", "1.2")
        seen.page.keyboard.press("Tab")
        seen.page.click('[data-show="velocities"]')
        seen.page.click('[data-do="on"]')
        link = hand.copied("copy-link").partition("#")[2]

        def told(fragment: str, name: str = PLANE) -> tuple[str, str]:
            seen.page.goto("about:blank")
            seen.page.goto(f"{pages(name).as_uri()}#{fragment}")
            return hand.said, seen.page.input_value(".rows input[type=text] >> nth=0")

        assert told(link) == ("The dimensions, the position and the view of the link are shown.", "1.2")
        assert seen.page.is_checked('[data-show="velocities"]')
        assert seen.page.get_attribute(".moving", "data-place") == "1.000"
        for damaged in (link[:40] + link[41:], "s=%00.%.x", "s="):
            said, value = told(damaged)
            assert said.startswith("The link is damaged") and value == "1"
        said, _value = told(link, SPHERE)
        assert said.startswith("The link belongs to another mechanism")
        assert seen.messages == []


def link_to(page: Path, state: object) -> str:
    """A link whose check sum is right, whatever it keeps: 32 bits of FNV-1a over digest and state, to the base 36."""
    digest = json.loads(DATA.findall(page.read_text(encoding="utf-8"))[0])["program"]["digest"]
    told = base64.urlsafe_b64encode(json.dumps(state).encode()).decode().rstrip("=")
    total = 0x811C9DC5
    for letter in digest + told:
        total = ((total ^ ord(letter)) * 0x01000193) & 0xFFFFFFFF
    return f"s={digest}.{told}.{np.base_repr(total, 36).lower()}"


def test_what_a_forged_link_keeps_is_not_trusted(running: Any, pages: Callable[..., Path]) -> None:
    """Its sum is right, its numbers are not: out of range, of another kind, no rotation, no link of the mechanism."""
    whole: dict[str, Any] = {"v": {}, "p": 3.0, "c": ["position.C"], "s": ["paths"], "r": 0.0}
    turned = {"w": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}
    wrong = [
        [], None, {}, {**whole, "v": []},
        {**whole, "v": {"links.AB.length": 1e9}}, {**whole, "v": {"links.AB.length": "1"}},
        {**whole, "v": {"links.__proto__.length": 1.0}}, {**whole, "p": None}, {**whole, "r": "fast"},
        {**whole, "w": [[0.0] * 3] * 3}, {**whole, "w": [[1e300, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]},
        {**whole, "k": "nothing"}, {**whole, "k": {}},
    ]  # fmt: skip
    harmless = [
        whole | turned,
        whole | {"p": 1e300, "r": -1e300, "c": [1, None] + ["position.B"] * 99, "s": [{}]},
    ]
    with opened(running, pages(SPHERE)) as seen:
        hand = Hand(seen)
        before = seen.page.evaluate("document.body.innerText")
        for state in [*wrong, *harmless]:
            seen.page.goto("about:blank")
            seen.page.goto(f"{pages(SPHERE).as_uri()}#{link_to(pages(SPHERE), state)}")
            frames(seen.page)
            assert hand.said.startswith("The link is damaged") == (state in wrong), state
            if state in wrong:
                assert (
                    seen.page.evaluate("document.body.innerText").replace(hand.said, "").split()
                    == before.split()
                )
        assert len(seen.page.query_selector_all(".chart")) == 12
        assert seen.messages == []


def test_a_damaged_link_changes_nothing_of_an_open_page(running: Any, pages: Callable[..., Path]) -> None:
    with opened(running, pages(PLANE)) as seen:
        hand = Hand(seen)
        seen.page.fill(".rows input[type=text] >> nth=0", "1.2")
        seen.page.keyboard.press("Tab")
        seen.page.evaluate("location.hash = 's=1.2.3'")
        until(seen.page, lambda: hand.said.startswith("The link is damaged"))
        assert hand.values() == {"links.OA.length": 1.2}


def test_every_gesture_has_its_keys(running: Any, pages: Callable[..., Path]) -> None:
    """The table of the page's document, from top to bottom, without a mouse."""
    with opened(running, pages(SPHERE)) as seen:
        hand, keyboard = Hand(seen), seen.page.keyboard

        def press(where: str, *keys: str) -> None:
            seen.page.focus(where)
            for key in keys:
                keyboard.press(key)
            frames(seen.page)

        def place() -> float:
            return float(seen.page.get_attribute(".moving", "data-place"))

        reached = set()
        for _ in range(60):
            keyboard.press("Tab")
            reached.add(
                seen.page.evaluate(
                    "document.activeElement.dataset.handle ?? document.activeElement.dataset.turn"
                )
            )
        assert {"A", "B", "C", "D", "left", "right", "up", "down"} <= reached
        press('[data-handle="D"]', "ArrowRight", "Shift+ArrowUp")
        press('[data-handle="C"]', "ArrowDown")
        press(".rows input[type=range]", "ArrowRight")
        press(".rows input[type=text] >> nth=1", "Control+a", "4", "4", "Enter")
        assert hand.values()["links.BC.length"] == pytest.approx(np.radians(44.0))
        assert len(hand.values()) >= 4
        press(".paper", "Home", "ArrowRight", "ArrowRight", "Shift+ArrowRight")
        assert place() == 12.0
        press(".paper", "End")
        assert place() == 360.0
        press(".paper", "Home", "Space")
        until(seen.page, lambda: place() > 1.0)
        press(".paper", "Space")
        eye = hand.joint("A")
        press('[data-turn="left"]', "Space")
        assert np.hypot(*(hand.joint("A") - eye)) > 5
        press('[data-do="add-curve"]', "Enter")
        assert len(seen.page.query_selector_all(".chart")) == 5
        press(".chart:last-child .remove", "Space")
        assert len(seen.page.query_selector_all(".chart")) == 4
        for _ in range(6):
            press(".paper", "Control+z")
        assert seen.page.is_disabled('[data-do="undo"]') and hand.values() == {}
        assert seen.messages == []


def test_a_finger_drags_a_joint(running: Any, pages: Callable[..., Path]) -> None:
    with opened(running, pages(PLANE), 400, has_touch=True) as seen:
        hand = Hand(seen)
        start, way = hand.joint("B"), np.array([-20.0, -15.0])
        touch = seen.page.context.new_cdp_session(seen.page)
        for kind, at in (("touchStart", start), ("touchMove", start + way / 2), ("touchMove", start + way)):
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": at[0], "y": at[1]}]})
        frames(seen.page)
        np.testing.assert_allclose(hand.joint("B"), start + way, atol=0.2)  # of a tenth of a pixel
        touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
        frames(seen.page)
        assert set(hand.values()) == {"links.AB.length", "links.DB.length"}


def test_statuses_are_said_and_change_points_give_a_command(
    running: Any, pages: Callable[..., Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with opened(running, pages(LOCKED)) as seen:
        hand = Hand(seen)
        motion = ct.motion(LOCKED)
        assert re.findall(r"From .*: ([\w ]+)\.", hand.statuses) == ["open", "cut off"]
        assert "Limits: 1.7999 rad; 5.4749 rad." in hand.statuses
        _head, *rows = hand.table()
        words = [ct.Status(one).word for one in motion["status"].values.tolist()]
        assert [row[1] for row in rows] == words
        seen.page.evaluate(
            "(place) => { const one = document.querySelector('[data-do=seek]'); one.value = place;"
            " one.dispatchEvent(new Event('input')); }",
            "60",
        )
        assert "open" in seen.page.inner_text(".controls output")
        seen.page.fill(".rows input[type=text] >> nth=0", "0,25")  # short enough to turn
        seen.page.keyboard.press("Tab")
        frames(seen.page)
        assert hand.statuses != ""
    with opened(running, pages(BRANCHED)) as seen:
        hand = Hand(seen)
        seen.page.click(".statuses button")
        command = str(seen.page.inner_text(".command code"))
        assert command == f"centrode run {BRANCHED}"
        seen.page.fill(".rows input[type=text] >> nth=0", "1.5")
        seen.page.fill(".rows input[type=text] >> nth=2", "1.5")
        seen.page.keyboard.press("Tab")
        frames(seen.page)
        command = str(seen.page.inner_text(".command code"))
        assert command.endswith('--set "links.OA.length=1.5 m" --set "links.DB.length=1.5 m"')
    assert main(["--lang", "en", *shlex.split(command)[1:], "--no-figures", "--out", "run"]) == 0


def test_a_constraint_that_does_not_fit_is_red(
    running: Any, pages: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    """The third crank repeats the constraints of the others: with one of another length nothing closes."""
    mechanism = ct.example(REDUNDANT)
    with opened(running, pages(REDUNDANT)) as seen:
        hand = Hand(seen)
        seen.page.fill(".rows input[type=text] >> nth=0", "1.05")
        seen.page.keyboard.press("Tab")
        frames(seen.page)
        motion = ct.motion(mechanism, vary={"links.OA.length": [1.05]}).isel(mechanism=0)
        _head, *rows = hand.table()
        assert [row[1] for row in rows] == [ct.Status(one).word for one in motion["status"].values.tolist()]
        # the four-bar of the first two cranks closes while the way from A to D leaves coupler (2) and rocker (1) room
        way = np.sqrt(1.05**2 + 2.0**2 - 2 * 1.05 * 2.0 * np.cos([float(row[0]) for row in rows]))
        closes = (way >= 1.0) & (way <= 3.0)
        said = [line for line in hand.statuses.splitlines() if "closure residual up to" in line]
        assert len(said) == len(
            [k for k in range(len(closes)) if closes[k] and (k == 0 or not closes[k - 1])]
        )
        assert all("above its bound of 1·10⁻⁷" in line for line in said)
        colours = (
            "(one) => [getComputedStyle(one).fill, getComputedStyle(document.querySelector('.bad')).color]"
        )
        for where in (".strip", ".chart"):
            for band in seen.page.query_selector_all(f"{where} .band.misfit"):
                fill, bad = band.evaluate(colours)
                assert fill == bad
        assert len(seen.page.query_selector_all(".strip .band.misfit")) == len(said)
        command = str(seen.page.inner_text(".command code"))
        seen.page.click('[data-do="reset"]')
        frames(seen.page)
        assert not seen.page.query_selector_all(".band.misfit") and "residual" not in hand.statuses
        assert seen.messages == []
    assert main(["--lang", "en", *shlex.split(command)[1:]]) == 2
    assert "length of link FE" in capsys.readouterr().err


def test_limits_are_marked_where_the_motion_ends(running: Any, pages: Callable[..., Path]) -> None:
    """Each in every curve and along the slider, at its place on the axis, with a sign before its sentence."""
    with opened(running, pages(LOCKED)) as seen:
        box = seen.page.evaluate(
            "(({ x, width }) => [x.baseVal.value, width.baseVal.value])(document.querySelector('.plot .box'))"
        )
        places = seen.page.evaluate(
            "[...document.querySelectorAll('.chart')].map((one) =>"
            " [...one.querySelectorAll('.mark.limit')].map((mark) => mark.x1.baseVal.value))"
        )
        expected = [box[0] + box[1] * at / (2 * np.pi) for at in LIMITS]
        np.testing.assert_allclose(places, [expected] * len(places), atol=0.01 * box[1] / 100)
        assert len(seen.page.query_selector_all(".strip .mark.limit")) == 2
        assert len(seen.page.query_selector_all(".statuses .sign .mark.limit")) == 1


@pytest.mark.parametrize(
    ("name", "wide", "scheme"), [(BRANCHED, 400, "light"), (SPHERE, 1440, "dark"), (REDUNDANT, 400, "dark")]
)
def test_pages_are_accessible(
    running: Any, pages: Callable[..., Path], name: str, wide: int, scheme: str
) -> None:
    """axe-core finds nothing, with everything shown; texts are large enough; nothing is wider than the screen."""
    with opened(running, pages(name), wide, color_scheme=scheme, bypass_csp=True) as seen:
        for box in seen.page.query_selector_all("[data-show]:not(:checked)"):
            box.click()
        if name == REDUNDANT:
            seen.page.fill(".rows input[type=text] >> nth=0", "1.05")
            seen.page.keyboard.press("Tab")
        seen.page.click("summary")
        seen.page.evaluate(AXE.read_text(encoding="utf-8"))
        found = seen.page.evaluate("axe.run()")
        assert [(one["id"], one["nodes"][0]["html"]) for one in found["violations"]] == []
        assert len(found["passes"]) > 20
        sizes = seen.page.evaluate(
            "[...document.querySelectorAll('body *')].filter((one) => [...one.childNodes].some((node) =>"
            " node.nodeType === 3 && node.textContent.trim()) && one.getClientRects().length).map((one) =>"
            " parseFloat(getComputedStyle(one).fontSize) * (one.ownerSVGElement ?"
            " one.getScreenCTM().a : 1))"
        )
        assert min(sizes) >= 11
        assert seen.page.evaluate("document.documentElement.scrollWidth") <= wide


def test_axe_is_the_file_that_is_named() -> None:
    assert hashlib.sha256(AXE.read_bytes()).hexdigest() == AXE_SUM


@pytest.mark.parametrize("wide", [640, 900, 2560])
def test_nothing_is_wider_than_the_screen(running: Any, pages: Callable[..., Path], wide: int) -> None:
    with opened(running, pages("six-bar-press", "ru"), wide) as seen:
        assert seen.page.evaluate("document.documentElement.scrollWidth") <= wide


def test_numbers_are_spelled_for_the_reader(running: Any, pages: Callable[..., Path]) -> None:
    with opened(running, pages("six-bar-press", "ru")) as seen:
        hand = Hand(seen)
        assert seen.page.input_value(".rows input[type=text] >> nth=0") == "0,347"
        assert seen.page.inner_text(".controls output") == "φ = 219,1°"
        head, first, *_rows = hand.table(";")
        assert head[0] == "φ [°]" and first[0].startswith("219,1") and "v_x(A) [м/с]" in head
        with speaking("ru"):
            assert seen.page.inner_text(".statuses") == "Механизм проходит все положения."


def test_reactions_are_curves_numbers_and_arrows(running: Any, pages: Callable[..., Path]) -> None:
    mechanism = ct.example("six-bar-press")
    with opened(running, pages("six-bar-press")) as seen:
        hand = Hand(seen)
        seen.page.click('[data-do="add-curve"]')
        seen.page.select_option(".chart:last-child select", label="reaction at B on link AB")
        seen.page.fill(".rows input[type=text] >> nth=0", "0.33")
        seen.page.keyboard.press("Tab")
        frames(seen.page)
        changed = with_values(mechanism, hand.values())
        force = ct.reactions(changed).joint_force.sel(side="B/AB").values
        size = np.hypot(*force.T)
        shown = seen.page.inner_text(".chart:last-child .legend").replace("\u2212", "-")
        told = [float(one) for one in re.findall(r"= (-?[\d.]+) N", shown)]
        # five digits of the greatest number are shown
        np.testing.assert_allclose(
            told, [*force[0], size[0]], rtol=0, atol=0.5 * 10 ** (np.ceil(np.log10(size.max())) - 5)
        )
        head, *rows = hand.table()
        for k, axis in enumerate("xy"):
            column = [float(row[head.index(f"R_{axis}(B/AB) [N]")]) for row in rows]
            # printed with 15 digits
            np.testing.assert_allclose(column, force[:, k], rtol=0, atol=1e-12 * size.max())
        whole = [float(row[head.index("|R|(B/AB) [N]")]) for row in rows]
        np.testing.assert_allclose(whole, size, rtol=0, atol=1e-12 * size.max())
        seen.page.click("summary")
        seen.page.wait_for_selector(".numbers th >> text='H: force of the guide on its point or slider'")
        arrows = ".arrow.reaction:not([display=none])"
        assert seen.page.locator(arrows).count() == 0
        seen.page.click('[data-show="reactions"]')
        frames(seen.page)
        # both pins of the coupler push it
        assert seen.page.locator(arrows).count() == 2
        assert seen.messages == []


TAPPET = """
title = "Rocker on a tappet"
[frame.points]
E = ["60 mm", "100 mm"]
[links]
PB = { length = "80 mm" }
EB = { length = "50 mm" }
[[guides]]
point = "P"
on = "frame"
through = ["10 mm", "40 mm"]
direction = [0, 1]
[[drives]]
guide = "P"
start = 0
cam = "valve-cam"
[assembly]
sides = { B = "left" }
"""
A_LITTLE = 0.1
"""Of a pixel: corners of a profile are a degree apart, and paths are written to a hundredth of a pixel."""
SHAPES = """
[...document.querySelectorAll('.shape')].map((one) => {
  const matrix = one.getCTM();
  const corners = one.getAttribute('d').match(/-?[\\d.]+/g).map(Number);
  return Array.from({ length: corners.length / 2 }, (_, k) => {
    const at = new DOMPoint(corners[2 * k], corners[2 * k + 1]).matrixTransform(matrix);
    return [at.x, at.y];
  });
})
"""
"""Corners of the shapes in the picture [pixels]: a cam's profile, its mark, its follower."""


def apart(seen: Seen, sample: int) -> float:
    """How far the follower is from the profile [pixels]: a roller's rim, or the line of a face."""
    seen.page.evaluate(
        "(place) => { const one = document.querySelector('[data-do=seek]'); one.value = place;"
        " one.dispatchEvent(new Event('input')); }",
        str(sample),
    )
    frames(seen.page)
    profile, _mark, *follower, _hub = map(np.array, seen.page.evaluate(SHAPES))
    touching = follower[-1]
    if len(touching) > 2:
        centre = touching[:-1].mean(axis=0)
        return float(np.linalg.norm(profile - centre, axis=1).min() - np.linalg.norm(touching[0] - centre))
    (x, y), along = touching[0], touching[1] - touching[0]
    off = along[0] * (profile[:, 1] - y) - along[1] * (profile[:, 0] - x)
    return float(np.abs(off).min() / np.hypot(*along))


@pytest.mark.parametrize(
    ("described", "vary", "values"),
    [
        (
            ct.example("cam-driven-linkage"),
            {"frame.points.C.x": (-0.1, 0.1), "links.lever.points.B.x": (-0.05, 0.05)}
            | {f"links.lever.points.R.{axis}": (-0.1, 0.1) for axis in "xy"},
            # the roller's arm turned in its link, its length kept: 90 mm
            ["40", "-30", "-54", "-72"],
        ),
        (
            parse_mechanism(TAPPET),
            {f"guides.P.through.{axis}": (-0.1, 0.1) for axis in "xy"} | {"links.PB.length": (0.05, 0.1)},
            ["0.015", "0.03", "0.085"],
        ),
    ],
    ids=["roller", "face"],
)
def test_a_cam_turns_under_its_follower(
    running: Any, tmp_path: Path, described: ct.Mechanism, vary: Any, values: list[str]
) -> None:
    """The follower touches the profile at every sample, also where a reader has brought it elsewhere."""
    file = tmp_path / "cam.html"
    file.write_text(mechanism_page(described, vary), encoding="utf-8")
    with opened(running, file) as seen:
        samples = range(0, 361, 40)
        assert all(abs(apart(seen, sample)) < A_LITTLE for sample in samples)
        for k, value in enumerate(values):
            seen.page.fill(f".rows input[type=text] >> nth={k}", value)
            seen.page.keyboard.press("Tab")
        frames(seen.page)
        assert all(abs(apart(seen, sample)) < A_LITTLE for sample in samples)
        assert "The cam is not drawn" not in Hand(seen).statuses
        assert seen.messages == []


def test_a_cam_that_does_not_fit_its_arm_is_not_drawn(running: Any, tmp_path: Path) -> None:
    file = tmp_path / "cam.html"
    file.write_text(
        mechanism_page("cam-driven-linkage", {"links.lever.points.R.x": (-0.1, -0.08)}), encoding="utf-8"
    )
    with opened(running, file) as seen:
        hand = Hand(seen)
        shapes = "[...document.querySelectorAll('.shape')].filter((one) => one.getAttribute('d')).length"
        drawn = seen.page.evaluate(shapes)
        assert drawn >= 4 and "cam" not in hand.statuses
        seen.page.fill(".rows input[type=text] >> nth=0", "-85")
        seen.page.keyboard.press("Tab")
        frames(seen.page)
        assert (
            "The cam is not drawn: it is made for an arm of 90 mm, and the arm is 85 mm long."
            in hand.statuses
        )
        assert seen.page.evaluate(shapes) < drawn
        seen.page.click('[data-do="reset"]')
        frames(seen.page)
        assert seen.page.evaluate(shapes) == drawn and "cam" not in hand.statuses


def test_why_a_cam_is_not_drawn_is_said() -> None:
    mechanism = parse_mechanism(TAPPET)
    points, links = list(mechanism.points), list(mechanism.links)
    cams, said = cams_of(mechanism, ct.motion(mechanism), points, links)
    assert len(cams) == 1 and said == []
    sizeless = mechanism.model_copy(
        update={
            "drives": tuple(
                drive.model_copy(
                    update={
                        "cam": drive.cam.model_copy(
                            update={"body": drive.cam.body.model_copy(update={"base_radius": None})}
                        )
                    }
                )
                for drive in mechanism.drives
            )
        }
    )
    cams, said = cams_of(sizeless, ct.motion(mechanism), points, links)
    assert cams == [] and said[0].startswith("The cam is not drawn")


def test_several_drives_say_what_reduces_them() -> None:
    text = example_text("five-bar-two-drives").replace(
        "[links.OA]\nlength = 0.1", "[links.OA]\nlength = 0.1\nmass = 1.0\ncentre = [0.05, 0]\ninertia = 1e-3"
    )
    said = (
        "Curves of reduced masses and loads are omitted: with several drives they are an inertia matrix and a "
        "generalised force of each drive, which centrode reduce computes."
    )
    assert said in mechanism_page(parse_mechanism(text))
    assert "are omitted" not in mechanism_page("five-bar-two-drives")


def test_the_curves_begin_with_a_point_that_no_crank_carries() -> None:
    chosen = json.loads(DATA.findall(mechanism_page("five-bar-two-drives"))[0])["chosen"]
    assert chosen[0] == "position.B"


def test_a_list_in_the_player_is_chosen_from_by_keys(running: Any, pages: Callable[..., Path]) -> None:
    with opened(running, pages(PLANE)) as seen:
        seen.page.click('[data-show="rolling-centrodes"]')
        seen.page.focus('[data-do="body"]')
        place = seen.page.get_attribute(".moving", "data-place")
        assert seen.page.input_value('[data-do="body"]') == "AB"
        seen.page.keyboard.press("ArrowDown")
        frames(seen.page)
        assert seen.page.input_value('[data-do="body"]') == "DB"
        assert seen.page.get_attribute(".moving", "data-place") == place


def test_curves_stand_two_beside_each_other_on_paper(running: Any, pages: Callable[..., Path]) -> None:
    with opened(running, pages("six-bar-press", "ru"), 2560) as seen:
        seen.page.set_viewport_size({"width": 680, "height": 900})
        seen.page.emulate_media(media="print")
        seen.page.evaluate("dispatchEvent(new Event('beforeprint'))")
        frames(seen.page)
        left = seen.page.evaluate(
            "[...document.querySelectorAll('.chart')].map((one) => one.getBoundingClientRect().left)"
        )
        assert left[0] == left[2] < left[1] == left[3]
        # letters of the axes are 12 units high
        assert seen.page.evaluate("document.querySelector('.plot svg').getScreenCTM().a") > 0.9
        seen.page.emulate_media(media="screen")
        seen.page.evaluate("dispatchEvent(new Event('afterprint'))")
        frames(seen.page)
        wide = seen.page.evaluate("document.querySelector('.plot svg').viewBox.baseVal.width")
        assert wide == pytest.approx(
            seen.page.evaluate("document.querySelector('.charts').clientWidth"), abs=20
        )


def test_a_page_says_why_it_has_no_reactions() -> None:
    assert "Curves of reactions are omitted: reactions on the sphere." in mechanism_page(
        "spherical-crank-rocker"
    )
    assert "are omitted" not in mechanism_page(PLANE)
    assert 'data-show="reactions"' not in mechanism_page(PLANE)


def test_a_sphere_follows_the_hand_and_paper_shows_no_controls(
    running: Any, pages: Callable[..., Path]
) -> None:
    with opened(running, pages(SPHERE)) as seen:
        hand = Hand(seen)
        start = hand.joint("C")
        hand.drag("C", (15.0, 10.0))
        np.testing.assert_allclose(hand.end, start + np.array([15.0, 10.0]), atol=0.5)
        values = hand.values()
        assert set(values) == {"links.BC.length", "links.DC.length"}
        head, *rows = hand.table()
        motion = ct.motion(with_values(ct.example(SPHERE), values))
        found = [[float(row[head.index(f"{axis}(C)")]) for axis in "xyz"] for row in rows]
        np.testing.assert_allclose(found, motion["position"].sel(point="C").values, rtol=0, atol=1e-13 * 4)
        before = hand.joint("A")
        seen.page.click('[data-turn="right"]')
        assert np.hypot(*(hand.joint("A") - before)) > 5
        seen.page.emulate_media(media="print")
        seen.page.evaluate("dispatchEvent(new Event('beforeprint'))")
        shown = {
            name: seen.page.is_visible(name) for name in (".controls", ".dimensions", ".handles", ".printed")
        }
        assert shown == {".controls": False, ".dimensions": False, ".handles": False, ".printed": True}
        assert len(seen.page.query_selector_all(".printed td.n")) == len(ranges_of(ct.example(SPHERE)))
