"""A mechanism as one file that computes its own motion: no network, no Python, no other files."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from centrode.errors import STATUSES_NOT_REACHED, STATUSES_OF_MOTION
from centrode.kinematics.motion import motion
from centrode.locale import _, chosen_language, decimal_mark, speaking
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.model.motion_parameter import MotionVariable
from centrode.page.program import PageProgram, page_program
from centrode.render.document.numbers import Numbers
from centrode.report.html.parts import page_data, page_part, page_policy, page_script
from centrode.report.html.stage import controls_of
from centrode.report.mechanism_page.courses import chosen_courses, courses_of
from centrode.report.mechanism_page.drawing import drawing_of
from centrode.report.mechanism_page.handles import handles_of
from centrode.report.mechanism_page.numbers_that_vary import name_of, ranges_of
from centrode.report.mechanism_page.words import words_of_page
from centrode.version import __version__

HERE = Path(__file__).parent
SHARED_SCRIPTS = ("space.js", "picture.js", "animation.js")
SCRIPTS = (
    "model.js",
    "outlines.js",
    "handles.js",
    "mechanism_stage.js",
    "curves.js",
    "panel.js",
    "state_link.js",
    "opening.js",
)
SHARED_STYLES = ("base.css", "document.css", "motion.css")
STYLES = ("mechanism_page.css",)
LAST_STYLES = ("print.css",)
FILE = "mechanism.toml"
"""What commands name where a mechanism has no file."""
Vary = Mapping[str, Sequence[float | str]]


def mechanism_page(
    described: MechanismSource,
    vary: Vary | None = None,
    *,
    language: str | None = None,
    samples: int | None = None,
    source: str = "",
) -> str:
    """A mechanism as a page (HTML) on which a reader changes its dimensions and sees its motion.

    Parameters
    ----------
    described : Mechanism, file or name of an example
    vary : path -> (from, to), numbers [SI] or texts with a unit
        The numbers that have a slider and follow the handles of joints; without it the lengths of all links, the places
        of joints in links and in the frame, and the lines of the frame's guides.
    language : "en", "ru" or "uk"; the chosen one if None
    samples : of the motion; the description's own if None
    source : file or example that commands on the page name; as `described` names it if empty

    Returns
    -------
    str
        The same mechanism gives the same page.

    Raises
    ------
    NotComputedYet
        A group without a closed form, or a number that the page cannot vary, by its name.
    InputError
        A path or a range that is none, a description that defines no motion.

    Examples
    --------
    >>> page = mechanism_page("crank-rocker", {"links.AB.length": ("3 m", "4 m")})
    >>> page.startswith("<!DOCTYPE html>"), len(page) < 250_000
    (True, True)
    """
    mechanism = mechanism_of(described)
    source = source or (FILE if isinstance(described, Mechanism) else Path(described).name)
    ranges = ranges_of(mechanism) if vary is None else vary
    program = page_program(mechanism, ranges, samples)  # what is refused is said in the language of messages
    with speaking(language or chosen_language()):
        if program.data["reduction_missing"] or program.data["reactions_missing"]:
            program = page_program(mechanism, ranges, samples)
        return _page(mechanism, program, _data(mechanism, program, source))


def _data(mechanism: Mechanism, program: PageProgram, source: str) -> dict[str, Any]:
    """What the scripts read."""
    data = dict(program.data)
    points, links = list(data["points"]), list(data["links"])
    paths = [one.path for one in program.parameters]
    numbers = Numbers(mechanism.display)
    courses = courses_of(mechanism, data)
    drawing = drawing_of(mechanism, motion(mechanism), points, links)
    units = dict.fromkeys([*(one.unit for one in program.parameters), *(["m"] if drawing["cams"] else [])])
    return {
        "program": data,
        "drawing": drawing,
        "handles": handles_of(mechanism, points, links, paths),
        "names": {path: name_of(mechanism, path) for path in paths},
        "units": {unit: _unit(unit, numbers) for unit in units},
        "parameter": _variable(mechanism.motion_parameter.instant, numbers),
        "drive": _variable(mechanism.motion_parameter.variable, numbers),
        "courses": courses,
        "chosen": chosen_courses(mechanism, courses, data),
        "reached": [status not in STATUSES_NOT_REACHED for status in STATUSES_OF_MOTION],
        "words": words_of_page(),
        "decimal": decimal_mark(),
        "source": source,
    }


def _unit(unit: str, numbers: Numbers) -> dict[str, Any]:
    factor, label = numbers.shown(unit)
    return {"factor": factor, "label": label}


def _variable(variable: MotionVariable, numbers: Numbers) -> dict[str, Any]:
    """What the motion is a function of, or what states a position: where a law may pass a value twice, the time."""
    return {"symbol": variable.symbol, "byTime": variable.unit == "s", **_unit(variable.unit, numbers)}


def _page(mechanism: Mechanism, program: PageProgram, data: Mapping[str, Any]) -> str:
    title = html.escape(_(mechanism.title) or _("Mechanism"))
    own = page_script([*map(page_part, SHARED_SCRIPTS), *map(_part, SCRIPTS)])
    scripts = [program.javascript, own]
    style = "".join([*map(page_part, SHARED_STYLES), *map(_part, STYLES), *map(page_part, LAST_STYLES)])
    return (
        f'<!DOCTYPE html>\n<html lang="{chosen_language()}">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{page_policy(scripts)}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>{style}</style>\n</head>\n<body>\n"
        f"{_body(title, program)}"
        f'<script type="application/json" id="page-data">{page_data(data)}</script>\n'
        f"{''.join(f'<script>{script}</script>' for script in scripts)}\n</body>\n</html>\n"
    )


def _body(title: str, program: PageProgram) -> str:
    """The elements of the page; scripts fill what is empty."""
    dimensions = _dimensions() if program.parameters else ""
    curves = _curves(_reasons_for_omission(program))
    return (
        f'<div class="live"><header><h1>{title}</h1><p class="subtitle">{_subtitle()}</p></header>\n<main>\n'
        f"{_player(_controls(program))}\n{dimensions}\n{curves}\n{_exports()}\n</main>\n</div>\n{_by_hand()}\n"
    )


def _subtitle() -> str:
    return _escape(_("This page computes the motion itself; made by centrode {version}"), version=__version__)


def _player(controls: str) -> str:
    """The mechanism, what is said of its motion, and on paper the table of its dimensions."""
    name = _escape(_("Player"))
    label = _escape(_("Mechanism in motion; drag a link, or use the arrow keys"))
    without = _escape(
        _("This page computes the motion by its own script; the browser does not run scripts here.")
    )
    hint = _escape(
        _(
            "Drag a ring to change the dimensions, a link to move the mechanism. By keyboard: Tab reaches every ring, "
            "arrow keys move it, with Shift ten times as far; Space plays."
        )
    )
    table = _escape(_("Dimensions"))
    return (
        f'<section class="stage" aria-label="{name}"><div class="moving" role="group" aria-label="{label}">'
        f'<div class="paper" tabindex="0" role="group" aria-label="{label}"><noscript>{without}</noscript></div>'
        f'{controls_of("", controls)}</div><div class="statuses" role="status"></div><p class="hint">{hint}</p>'
        f'<div class="printed" aria-hidden="true"><p class="caption"><b>{table}.</b> <span class="place"></span></p>'
        "<table><tbody></tbody></table></div></section>"
    )


def _dimensions() -> str:
    """The sliders and what takes changes back."""
    name, reset, undo = _("Dimensions"), _button("reset", _("Reset")), _button("undo", _("Undo"))
    return (
        f'<section class="dimensions" aria-labelledby="h-dimensions">{_heading("dimensions", name)}'
        '<div class="rows"></div><p class="note bad" role="alert"></p>'
        f'<p class="buttons">{reset}{undo}</p></section>'
    )


def _reasons_for_omission(program: PageProgram) -> list[str]:
    """Why reduced masses and loads, or reactions, are not among the curves."""
    sentences = {
        "reduction_missing": _("Curves of reduced masses and loads are omitted: {reason}."),
        "reactions_missing": _("Curves of reactions are omitted: {reason}."),
    }
    reasons = {name: str(program.data[name]) for name in sentences}
    return [sentences[name].format(reason=reason) for name, reason in reasons.items() if reason]


def _curves(missing: Sequence[str]) -> str:
    """The curves; `missing` says why masses and loads are not among them."""
    note = "".join(f'<p class="hint">{_escape(why)}</p>' for why in missing)
    name, add = _("Curves"), _button("add-curve", _("Add a curve"))
    return (
        f'<section class="curves" aria-labelledby="h-curves">{_heading("curves", name)}'
        f'<div class="charts"></div><p class="buttons">{add}</p>{note}</section>'
    )


def _exports() -> str:
    """What a reader takes along: the link, the table, the numbers."""
    name, numbers = _("Numbers and link"), _escape(_("Numbers at the cursor"))
    link, table = _button("copy-link", _("Copy the link")), _button("csv", _("Copy as CSV"))
    return (
        f'<section class="away" aria-labelledby="h-away">{_heading("away", name)}'
        f'<p class="buttons">{link}{table}</p>'
        '<p id="said" role="status"></p>'
        f'<details class="table-of-numbers"><summary>{numbers}</summary><div class="numbers"></div></details></section>'
    )


def _by_hand() -> str:
    """What shows a text to copy where the browser does not let the page do it."""
    name, why, close = (
        _("Copy by hand"),
        _("The browser does not let the page copy; copy it here:"),
        _("Close"),
    )
    return (
        f'<dialog id="by-hand" aria-label="{_escape(name)}"><form method="dialog"><label>{_escape(why)}'
        f'<textarea rows="6" readonly></textarea></label><button>{_escape(close)}</button></form></dialog>'
    )


def _button(name: str, text: str) -> str:
    return f'<button type="button" data-do="{name}">{_escape(text)}</button>'


def _heading(name: str, text: str) -> str:
    return f'<h2 id="h-{name}">{_escape(text)}</h2>'


def _controls(program: PageProgram) -> str:
    """What the player of a page has beside that of reports."""

    def box(name: str, text: str, on: bool = False) -> str:
        checked = " checked" if on else ""
        return f'<label><input type="checkbox" data-show="{name}"{checked}> {_escape(text)}</label>'

    of_link = _escape(_("of link"))
    links = "".join(_option(name, name == _floating_link(program)) for name in program.data["links"])
    body = f'<label class="of"> {of_link} <select data-do="body">{links}</select></label>'
    centrodes = box("rolling-centrodes", _("both centrodes"))
    reactions = box("reactions", _("reactions")) if program.data["sides"] else ""
    return (
        '<div class="strip"></div>'
        + box("loop", _("loop"), on=True)
        + (box("handles", _("handles"), on=True) if program.parameters else "")
        + box("velocities", _("velocities"))
        + box("accelerations", _("accelerations"))
        + box("instant-centres", _("instant centres"))
        + f'<span class="pair">{centrodes}{reactions}{body}</span>'
        + box("ghosts", _("ghost positions"))
        + _button("fit", _("Fit"))
        + (_turn_buttons() if program.mechanism.space == "sphere" else "")
    )


def _option(name: str, chosen: bool) -> str:
    return f"<option{' selected' if chosen else ''}>{html.escape(name)}</option>"


def _floating_link(program: PageProgram) -> str:
    """The first link that is not hinged to the frame: its centrodes are curves."""
    links, fixed = program.mechanism.links, set(program.mechanism.frame.points)
    free = [
        name
        for name, link in links.items()
        if len(link.coordinates) > 1 and not fixed & set(link.coordinates)
    ]
    return next(iter(free), "")


def _turn_buttons() -> str:
    """Buttons that turn the sphere, as dragging it does."""
    names = {
        "left": ("\u2190", _("Turn the sphere to the left")),
        "right": ("\u2192", _("Turn the sphere to the right")),
        "up": ("\u2191", _("Turn the sphere up")),
        "down": ("\u2193", _("Turn the sphere down")),
    }
    made = (
        f'<button type="button" data-turn="{way}" aria-label="{name}" title="{name}">{sign}</button>'
        for way, (sign, name) in ((way, (sign, _escape(name))) for way, (sign, name) in names.items())
    )
    return f'<span class="turns">{"".join(made)}</span>'


def _escape(sentence: str, **holes: str) -> str:
    return html.escape(sentence.format(**holes) if holes else sentence)


@cache
def _part(name: str) -> str:
    """A script or a style without its indents and the lines that explain it: a page is sent by mail."""
    lines = (line.strip() for line in (HERE / name).read_text(encoding="utf-8").splitlines())
    return "".join(f"{line}\n" for line in lines if line and not line.startswith("// "))
