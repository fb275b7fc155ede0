"""The open mechanism as what a synthesis seeks: its numbers found again, and put into its text and nowhere else."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.app.open_mechanism import text_with_answer
from centrode.model.examples import example_text
from centrode.model.files import mechanism_from
from centrode.synthesis import mechanism_synthesis

TICKET = "0123456789abcdef" * 2
FOUR_BAR = """# a four-bar linkage
title = "Traced" # its point draws
display = { length = "mm", angle = "deg" }

[frame.points]
O = [0, 0]
D = ["92 mm", 0]   # the fixed hinge of the rocker

[links]
OA = { length = "40 mm" }
AB = { points = { A = [0, 0], B = ["112 mm", 0], P = ["50 mm", "30 mm"] } } # the coupler
DB = { length = "116 mm" }

[[drives]]
link = "OA"
start = 0
speed = 1

[assembly]
sides = { B = "left" }
"""
JOINTED = """# points in one position
[points]
O = [0, 0]
A = [0.4, 0]
B = [1.1, 1.0]
D = [1.2, 0] # stays

[frame]
points = ["O", "D"]

[links.OA]

[links.AB]

[links.BD]

[[drives]]
link = "OA"
speed = 1
"""
FREE = {"links.DB.length": ["90 mm", "140 mm"], "links.AB.points.P.y": ["10 mm", "50 mm"]}


@pytest.fixture(autouse=True)
def few_starts(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(mechanism_synthesis, "STARTS", 40)
    monkeypatch.setattr(mechanism_synthesis, "REFINED", 3)
    (tmp_path / "shares").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "shares"))


def described(text: str) -> Any:
    """What a text describes."""
    tables = tomllib.loads(text)
    return mechanism_from(tables)


def changed_lines(before: str, after: str) -> list[str]:
    """Lines of the second text that the first one has otherwise."""
    lines = difflib.ndiff(before.splitlines(), after.splitlines())
    return [line[2:] for line in lines if line.startswith("+ ")]


def test_it_offers_what_moves(ask: Callable[..., Any]) -> None:
    """Points that trace come first; numbers are those of joints and of such points, around what they are."""
    offer = ask("synthesis", want="mechanism", text=FOUR_BAR)
    assert offer["title"] == "Traced" and offer["crank"] == "OA" and offer["drive"] == "deg"
    assert offer["points"][0] == "P" and set(offer["points"]) == {"P", "A", "B"}
    assert offer["outputs"] == ["angle.AB", "angle.DB"]
    numbers = {one["path"]: one for one in offer["numbers"]}
    assert {"links.OA.length", "links.AB.points.P.y", "frame.points.D.x"} <= set(numbers)
    assert not any(".A." in path for path in numbers)  # the origin of its link
    crank = numbers["links.OA.length"]
    assert crank["least"] < 40 < crank["greatest"] and crank["chosen"]
    assert offer["sheet"]["points"]["D"] == [92, 0] and offer["sheet"]["fixed"] == ["O", "D"]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[frame",
        example_text("spherical-four-bar"),
        example_text("indexing-cam"),
        "[frame.points]\nO = [0, 0]\n",
    ],
)
def test_what_is_none_is_refused(ask: Callable[..., Any], text: str) -> None:
    for do, wanted in (
        ("synthesis", {"want": "mechanism"}),
        ("synthesise", {"ticket": TICKET, "wanted": {}}),
    ):
        error = ask(do, text=text, **wanted)["error"]
        assert error["message"] and "error in centrode" not in error["message"]


def test_its_path_is_found_again_and_comments_stay(ask: Callable[..., Any]) -> None:
    """Targets are places of the same linkage with other numbers: these are found, and written over the old ones."""
    there = described(FOUR_BAR.replace("116 mm", "104 mm").replace("30 mm", "22 mm"))
    places = ct.motion(there, 13).position.sel(point="P").to_numpy()[:-1]
    rows = [[f"{x!r} m", f"{y!r} m"] for x, y in places.tolist()]
    wanted = {"kind": "path", "point": "P", "targets": rows, "free": FREE, "answers": 1}
    wishes = '\n[synthesis]\nkind = "path" # of another day\n'
    found = ask("synthesise", ticket=TICKET, text=FOUR_BAR + wishes, wanted=wanted)
    (answer,) = found["answers"]
    assert answer["whole"]
    mechanism = described(answer["text"])
    assert mechanism.links["DB"].length == pytest.approx(0.104, rel=1e-5)
    assert mechanism.links["AB"].coordinates["P"][1] == pytest.approx(0.022, rel=1e-5)
    assert changed_lines(FOUR_BAR, answer["text"].rstrip("\n") + "\n") == [
        line for line in answer["text"].splitlines() if line.startswith(("AB =", "DB ="))
    ]
    assert answer["text"].count("# the coupler") == 1 and "synthesis" not in answer["text"]


def test_its_stroke_is_found(ask: Callable[..., Any]) -> None:
    """The rocker swings as far as was asked, by a motion of the text itself."""
    free = {"links.DB.length": ["90 mm", "200 mm"]}
    wanted = {"kind": "strokes", "of": "angle.DB", "swing": "60 deg", "free": free, "answers": 1}
    (answer,) = ask("synthesise", ticket=TICKET, text=FOUR_BAR, wanted=wanted)["answers"]
    angles = ct.motion(described(answer["text"]), 721).angle.sel(link="DB").to_numpy()
    assert np.degrees(np.ptp(angles)) == pytest.approx(60, abs=0.01)
    assert "# the fixed hinge of the rocker" in answer["text"]


def test_points_in_one_position_are_put_to_where_they_are(tmp_path: Path) -> None:
    """A description by coordinates has no key of a length: the joint goes to where two circles meet, it alone."""
    coupler, rocker, frame = np.hypot(0.7, 1.0), 1.2, 0.8
    along = (coupler**2 - rocker**2 + frame**2) / (2 * frame)
    joint = [float(0.4 + along), float(np.sqrt(coupler**2 - along**2))]
    answer = described(JOINTED.replace("[1.1, 1.0]", f"{joint!r}"))
    assert answer.links["BD"].length == pytest.approx(rocker)
    text, whole = text_with_answer(JOINTED, tmp_path, ("links.BD.length",), answer)
    assert whole
    (line,) = changed_lines(JOINTED, text)
    assert tomllib.loads(line)["B"] == pytest.approx(joint, abs=1e-4)


def test_where_it_cannot_be_patched_it_is_a_description_of_its_own(tmp_path: Path) -> None:
    """An answer that stands elsewhere than its numbers alone would put it."""
    other = described(FOUR_BAR.replace("[0, 0]\nD", "[0.01, 0]\nD"))
    text, whole = text_with_answer(FOUR_BAR, tmp_path, ("links.DB.length",), other)
    assert not whole
    assert described(text).frame.points["O"] == (0.01, 0)


def test_what_is_wanted_wrongly_says_where(ask: Callable[..., Any]) -> None:
    rows = [["0 mm", "0 mm"], ["10 mm", "0 mm"], ["10 mm", "5 mm"]]
    for wanted, word in (
        ({"kind": "path", "point": "P", "targets": rows}, "free"),
        ({"kind": "path", "point": "Q", "targets": rows, "free": FREE}, "Q"),
        ({"kind": "strokes", "of": "angle.XY", "swing": "1 rad", "free": FREE}, "XY"),
        ({"kind": "path", "targets": rows, "free": {"links.XY.length": ["1 mm", "2 mm"]}}, "XY"),
        ({"kind": "path", "targets": rows, "free": FREE, "trade_off": "size"}, "trade"),
    ):
        error = ask("synthesise", ticket=TICKET, text=FOUR_BAR, wanted=wanted)["error"]
        assert word in error["message"] + error["repair"]
