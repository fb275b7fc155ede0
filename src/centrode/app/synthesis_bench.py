"""What the page of syntheses asks: the search for what was drawn, how far it is, its end before the time, its answers.

The search runs in the process of what takes longer. Beside it the other process reads how far it is, and tells it to
stop, by files in a folder that only this user may open.
"""

from __future__ import annotations

import math
import re
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from centrode import render
from centrode.app.documents import TEXT_SIZE
from centrode.app.open_mechanism import (
    mechanism_offer,
    places_of,
    request_of_mechanism,
    text_with_answer,
)
from centrode.errors import InputError
from centrode.locale import _, mark
from centrode.model.files import mechanism_text
from centrode.sheets.texts import Number, Text
from centrode.synthesis.answers import Answer, SynthesisResults
from centrode.synthesis.requests import SYNTHESES
from centrode.synthesis.synthesise import synthesise
from centrode.views.synthesis import error_shown

WORDS: Mapping[str, str] = {
    "title": mark("Synthesis"),
    "lead": mark(
        "Draw or write what a point, a link or an output has to do: mechanisms that do it are sought."
    ),
    "wanted": mark("Wanted"),
    "path": mark("a path of a point"),
    "motion": mark("poses of a link"),
    "function": mark("a function of the crank"),
    "strokes": mark("strokes"),
    "hint_path": mark(
        "Drag a line, or press where the point has to pass. With the keyboard: arrow keys move the cross, Enter sets "
        "a point, Backspace removes the last one."
    ),
    "hint_motion": mark(
        "Press where the link has to be and drag in its direction. With the keyboard: arrow keys move the cross, the "
        "comma and the full stop turn it, Enter sets a pose, Backspace removes the last one."
    ),
    "hint_function": mark(
        "Give y(x) with its range and the angles by which the crank and the rocker turn over it, or write angles of "
        "both as rows."
    ),
    "hint_strokes": mark(
        "Give the stroke, or the swing of a rocker, and the ratio of the slow to the fast stroke."
    ),
    "drawing": mark("Drawing"),
    "formula": mark("formula of x"),
    "x_from": mark("x from"),
    "x_to": mark("x to"),
    "swing_crank": mark("the crank turns by, degrees"),
    "swing_rocker": mark("the rocker turns by, degrees"),
    "targets_function": mark("or angles of crank and rocker, degrees"),
    "topology": mark("mechanism"),
    "of_mechanism": mark("Mechanism"),
    "new_mechanism": mark("a new one"),
    "open_mechanism": mark("the open one: {title}"),
    "untitled": mark("Untitled mechanism"),
    "point": mark("point"),
    "link": mark("link"),
    "output": mark("output quantity"),
    "bounds": mark("Dimensions that may change, mm"),
    "least": mark("{name}, at least"),
    "greatest_bound": mark("{name}, at most"),
    "hint_function_own": mark(
        "Write rows: a value of the drive, and what the output is there, counted from any zero."
    ),
    "hint_strokes_own": mark(
        "Give what the output moves by, and the ratio of the slow to the fast stroke if it matters."
    ),
    "targets_own": mark("values of the drive and of the output, degrees or mm"),
    "replaced": mark(
        "This answer replaces the whole text, because its numbers cannot be put into it one by one."
    ),
    "slider-crank-offset": mark("offset slider-crank linkage"),
    "crank-rocker": mark("crank-rocker linkage"),
    "shaper": mark("shaper with a slotted lever"),
    "whitworth-quick-return": mark("Whitworth quick-return mechanism"),
    "six-bar-press": mark("six-bar press"),
    "wanted_stroke": mark("stroke, mm"),
    "wanted_swing": mark("swing of the rocker, degrees"),
    "wanted_time_ratio": mark("time ratio"),
    "trade_off": mark("trade-off of the error"),
    "trade_off_none": mark("none"),
    "trade_off_size": mark("against the size"),
    "trade_off_transmission": mark("against the transmission angle"),
    "turn_error": mark("greatest error of the turn"),
    "time_ratio": mark("time ratio"),
    "stroke": mark("stroke"),
    "swing": mark("swing"),
    "limit_angle": mark("angle of the crank between the limit positions"),
    "targets": mark("Targets, mm"),
    "targets_motion": mark("Targets, mm and degrees"),
    "clear": mark("Remove all"),
    "closed": mark("closed path"),
    "crank": mark("the crank turns fully"),
    "order": mark("targets are passed in their order"),
    "transmission": mark("least transmission angle, degrees"),
    "length_ratio": mark("longest to shortest link at most"),
    "most_size": mark("width and height at most, mm"),
    "search": mark("Search"),
    "stop": mark("Stop"),
    "searching": mark("searching"),
    "answers": mark("Answers"),
    "answer": mark("answer {number}"),
    "stopped": mark("The search was stopped: these are the answers until then."),
    "error": mark("r.m.s. error"),
    "greatest": mark("greatest error"),
    "least_transmission": mark("least transmission angle"),
    "size": mark("size"),
    "insert": mark("Insert into the workbench"),
    "workbench": mark("Workbench"),
    "lost": mark("the connection to centrode is lost"),
}
"""Labels of the page by their names in it."""
TICKET = re.compile(r"[0-9a-f]{32}")
"""What a page names its search by, so that no other one stops it."""
LEAST_LONG = 0.9995
"""Metres from which three digits of millimetres would be written as a power of ten."""
DIGITS = 6
"""Significant digits of places in a picture."""
EVERY = 2
"""Of so many places of a traced curve the page shows one."""


def synthesis_state(message: Mapping[str, Any], work_folder: Path) -> dict[str, Any]:
    """The words of the page, what the open mechanism offers, or how far the search is, which the page may end."""
    want = message.get("want")
    if want == "words":
        return {"words": {name: _(word) for name, word in WORDS.items()}}
    if want == "mechanism":
        return mechanism_offer(_open_text(message), work_folder)
    if want not in ("progress", "stop"):
        raise InputError("", _("the server does not know this request"))
    folder = _folder(message)
    if want == "stop" and folder.is_dir():
        (folder / "stop").touch()
    try:
        return {"share": float((folder / "share").read_text("ascii"))}
    except (OSError, ValueError):
        return {"share": 0.0}


def synthesis_answers(message: Mapping[str, Any], work_folder: Path) -> dict[str, Any]:
    """The answers to what was drawn: linkages, or the mechanism of the text of the message with other numbers.

    Raises InputError for a request that is none, MotionError where nothing was found.
    """
    wanted = message.get("wanted")
    if not isinstance(wanted, Mapping):
        raise InputError("", _("the message names no description"))
    text = _open_text(message) if "text" in message else None
    if text is not None:
        task = request_of_mechanism(text, work_folder, wanted)
    else:
        tables = {
            "display": {"length": "mm", "angle": "deg"},
            "synthesis": {"topology": "crank-rocker", **wanted},
        }
        task = SYNTHESES.from_tables(tables)
    with _files(_folder(message)) as folder:

        def say(share: float) -> None:
            # the other process reads a whole number at any time
            (folder / "new").write_text(f"{share:.4f}", "ascii")
            (folder / "new").replace(folder / "share")

        found = synthesise(task, say, (folder / "stop").exists)
    rows = [_row(found, one) for one in found.answers]
    if text is not None:
        names = tuple(task.synthesis.free)
        for row, one in zip(rows, found.answers, strict=True):
            row["text"], row["whole"] = text_with_answer(text, work_folder, names, one.mechanism)
    return {"complete": found.complete, "answers": rows}


def _open_text(message: Mapping[str, Any]) -> str:
    text = message.get("text")
    if not isinstance(text, str) or len(text) > TEXT_SIZE:
        raise InputError("", _("the message names no description"))
    return text


def _folder(message: Mapping[str, Any]) -> Path:
    ticket = message.get("ticket")
    if not isinstance(ticket, str) or not TICKET.fullmatch(ticket):
        raise InputError("", _("the server does not know this request"))
    return Path(tempfile.gettempdir()) / f"centrode-synthesis-{ticket}"


@contextmanager
def _files(folder: Path) -> Iterator[Path]:
    folder.mkdir(mode=0o700)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _row(found: SynthesisResults, answer: Answer) -> dict[str, Any]:
    """An answer as the page shows it: places in millimetres."""
    display, kind = found.task.display, found.task.synthesis.kind
    unit = "rad" if kind == "function" else "m"

    def words(text: Text) -> str:
        return render.screen_text(text, display)

    facts = []
    if kind != "strokes":
        facts += [
            ["error", words(Number(error_shown(found, answer.error), unit, digits=".3g"))],
            ["greatest", words(Number(error_shown(found, answer.greatest), unit, digits=".3g"))],
        ]
    facts += [
        [name, words(Number(value, its, digits=".4g"))] for name, (value, its) in answer.numbers.items()
    ]
    if math.isfinite(answer.transmission):
        facts.append(["least_transmission", words(Number(answer.transmission, "rad", digits=".3g"))])
    if all(map(math.isfinite, answer.size)):
        facts.append(
            [
                "size",
                " × ".join(
                    words(Number(one, "m", digits=".3g" if one < LEAST_LONG else ".5g"))
                    for one in answer.size
                ),
            ]
        )
    return {
        "facts": facts,
        "curve": [_place(one) for one in answer.curve[::EVERY]],
        "met": [_place(one) for one in answer.met],
        **places_of(answer.mechanism),
        "text": mechanism_text(answer.mechanism),
        "whole": False,
    }


def _place(place: complex) -> list[float]:
    return [float(f"{part * 1e3:.{DIGITS}g}") for part in (place.real, place.imag)]
