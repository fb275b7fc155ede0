"""Panels: what a topic of the registry has to say about a description, as blocks for the page."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeAlias

from centrode import render
from centrode.app.documents import Document
from centrode.app.motion_frames import MOST_FRAMES, player_frames
from centrode.app.panel_titles import failure_texts, shown_topics, with_panel_titles
from centrode.errors import CentrodeError, InputError
from centrode.kinematics.motion import default_instants
from centrode.locale import _, mark
from centrode.model.cam_files import AnyCam
from centrode.model.mechanism import Mechanism
from centrode.sheets.sheet import Formula
from centrode.topics.arguments import option_arguments
from centrode.topics.sheets import sheet_with_parts
from centrode.topics.topic import (
    ChoiceOption,
    Command,
    FlagOption,
    InstantsOption,
    Lazily,
    Option,
    Topic,
    ValueOption,
)

Described: TypeAlias = Mechanism | AnyCam

SAMPLES = 721
"""Samples of a panel at most."""
INSTANTS = 5
"""Instants of a panel at most."""
MOST_ROOM = 10_000
"""Points of a picture's width: a page that claims more has none."""
POINTS = 72.0
"""Points of an inch."""
TEXT = 200
"""Characters of an option."""
CONCERNS_NOTHING = mark("this description has nothing that this topic is about")
FORMULAS = Lazily("centrode.report.html.mathematics", "formulas_of")
SPELLING = Lazily("centrode.render.document.spelling", "DocumentSpelling")
NUMBERS = Lazily("centrode.render.document.numbers", "Numbers")


def topic_list() -> list[dict[str, Any]]:
    """Name, title, formats and options of each topic, in the chosen language."""
    return [
        {
            "name": topic.name,
            "title": _(topic.title),
            "for": topic.subject,
            "formats": ["csv", "xlsx"],
            "options": list(_options(topic)),
        }
        for topic in shown_topics()
    ]


def _options(topic: Topic) -> Iterator[dict[str, Any]]:
    for option in () if topic.command is None else topic.command.options:
        match option:
            case ChoiceOption(name, words, help_text, has_default):
                choices = [{"value": word, "label": word} for word in words]
                value = words[0] if has_default else None
                yield {
                    "name": name,
                    "label": _label(help_text),
                    "kind": "choice",
                    "choices": choices,
                    "value": value,
                }
            case FlagOption(name, help_text):
                yield {
                    "name": name,
                    "label": _label(help_text),
                    "kind": "flag",
                    "value": False,
                }
            case ValueOption():
                kind = "text" if option.kind is str else "number"
                yield {
                    "name": option.name,
                    "label": _label(option.help),
                    "kind": kind,
                    "value": None,
                    "required": option.required,
                    "of": "link" if option.metavar == "LINK" else None,
                }
            case InstantsOption(help_text):
                yield {
                    "name": "at",
                    "label": _label(help_text),
                    "kind": "text",
                    "value": None,
                }


def _label(sentence: str) -> str:
    """What a field of the panel means, in the reader's language."""
    return with_panel_titles(_(sentence)).rstrip(".")


def topics_of(document: Document) -> dict[str, bool | str]:
    """Name of each topic -> whether this description has it, or why it has not."""
    found: dict[str, bool | str] = {}
    description: Described | None = document.cam or document.mechanism
    for topic in shown_topics():
        if (topic.subject == "cam") != document.is_cam:
            continue
        takes_free = topic.panel is not None and topic.panel.free and document.free is not None
        if description is None or not (document.is_cam or document.prepared or takes_free):
            found[topic.name] = _("the mechanism cannot move yet")
        else:
            found[topic.name] = _concern(topic, description)
    return found


def _concern(topic: Topic, description: Described) -> bool | str:
    """Whether a topic concerns a description that is right, or why it does not."""
    try:
        if topic.concerns is None or topic.concerns(description):
            return True
    except CentrodeError as failure:
        return with_panel_titles(failure.what)
    needs = topic.panel.needs if topic.panel is not None else ""
    return _(needs) if needs else _(CONCERNS_NOTHING)


def topic_named(name: object) -> Topic:
    """A topic that the workbench shows; InputError for anything else."""
    for topic in shown_topics():
        if topic.name == name:
            return topic
    raise InputError("", _("the server does not know this topic"))


def panel_of(
    document: Document, name: object, options: object, samples: object, room: object = None
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The panel of a topic, its blocks or why there are none, and the arrays of the motions that they play.

    Parameters
    ----------
    room : how wide its pictures may be, in points of their letters; as in a document if that is no number
    """
    topic = topic_named(name)
    try:
        sheet, description = topic_sheet(document, topic, options, samples, plays=True)
        shows = topic.panel is None or topic.panel.pictures
        blocks = render.panel_blocks(
            sheet,
            description.display,
            mathematics_of(description),
            pictures=shows,
            sentences=with_panel_titles,
            width=_inches(room),
        )
        motions, arrays = player_frames(render.panel_motions(sheet))
    except CentrodeError as failure:
        what, repair = failure_texts(failure)
        return {
            "topic": topic.name,
            "title": _(topic.title),
            "missing": what,
            "repair": repair,
        }, {}
    return {"topic": topic.name, "title": _(topic.title), "blocks": blocks, "motions": motions}, arrays


def _inches(room: object) -> float | None:
    """A room in points as a width of figures."""
    if isinstance(room, bool) or not isinstance(room, int | float) or not 0.0 < room < MOST_ROOM:
        return None
    return room / POINTS


def topic_sheet(
    document: Document, topic: Topic, options: object, samples: object, *, plays: bool = False
) -> tuple[Any, Described]:
    """The sheet of a topic of a description, and this; raises CentrodeError where there is none.

    Parameters
    ----------
    plays : whether the page plays the motions that the topic finds: places of everything, no more than it can show
    """
    description: Described = document.cam if document.cam is not None else document.require_mechanism()
    if isinstance(description, Mechanism) and document.free is None:
        document.require_prepared()
    reason = topics_of(document).get(topic.name, _(CONCERNS_NOTHING))
    if reason is not True:
        raise InputError("", str(reason))
    arguments = _arguments(topic, description, options, samples)
    if plays and topic.panel is not None and topic.panel.played and isinstance(description, Mechanism):
        arguments |= {**topic.panel.played, **_bounded_samples(description)}
    command = topic.command
    if command is not None and command.needs is not None:
        # of a cam it is the description alone that may lack something
        given = (
            {} if topic.subject == "cam" else {key: arguments[key] for key in arguments if key != "samples"}
        )
        command.needs(description, **given)
    return sheet_with_parts(topic, topic.compute(description, **arguments)), description


def _arguments(topic: Topic, description: Described, options: object, samples: object) -> dict[str, Any]:
    """Arguments of the computation of a topic, from what a message holds."""
    command = topic.command
    given = dict(_given_options(command, options, description)) if command is not None else {}
    arguments = option_arguments(command, description, given) if command is not None else {}
    arguments = {**dict(topic.document.arguments), **arguments} if command is None else arguments
    if topic.panel is not None:
        arguments = {**topic.panel.arguments, **arguments}
    counts = command is not None and command.samples and command.extent is None
    if counts and isinstance(samples, int) and not isinstance(samples, bool):
        arguments["samples"] = min(max(samples, 2), SAMPLES)
    if command is not None and command.default_instants and isinstance(description, Mechanism):
        key = _instants_key(command)
        if key and not arguments.get(key):
            arguments[key] = list(default_instants(description))[:INSTANTS]
    return arguments


def _bounded_samples(mechanism: Mechanism) -> dict[str, int]:
    """Samples of a simulation where the description asks for more than a page plays."""
    own = mechanism.simulation
    return {} if own is None or own.at or own.samples <= MOST_FRAMES else {"samples": MOST_FRAMES}


def _instants_key(command: Command) -> str:
    for option in command.options:
        if isinstance(option, InstantsOption):
            return "at"
        if isinstance(option, ValueOption) and option.name == "at":
            return option.parameter
    return ""


def _given_options(command: Command, options: object, description: Described) -> Iterator[tuple[str, Any]]:
    """Options of a message that are options of the command, each of its kind."""
    table: Mapping[Any, Any] = options if isinstance(options, Mapping) else {}
    for option in command.options:
        name = "at" if isinstance(option, InstantsOption) else getattr(option, "name", "")
        value = table.get(name)
        if name and value is not None and value != "" and value != []:
            yield name, _value(option, name, value)
        elif isinstance(option, FlagOption):
            yield name, False
        elif isinstance(option, ValueOption) and option.required:
            yield name, _default(option, description)
        elif isinstance(option, ValueOption):
            yield name, () if option.several else None


def _default(option: ValueOption, description: Described) -> Any:
    """What a topic is about where nobody has chosen: of links the first that no drive turns."""
    if option.metavar != "LINK" or not isinstance(description, Mechanism):
        raise InputError(option.name, _("a text is needed"))
    driven = {drive.link for drive in description.drives}
    return next((name for name in description.links if name not in driven), next(iter(description.links)))


def _value(option: Option, name: str, value: Any) -> Any:
    if isinstance(option, FlagOption):
        return value is True
    if isinstance(option, ChoiceOption):
        if value not in option.words:
            raise InputError(name, _("expected one of {words}").format(words=", ".join(option.words)))
        return value
    several = isinstance(option, InstantsOption) or (isinstance(option, ValueOption) and option.several)
    if several and isinstance(value, str):  # of a field, in which semicolons part them
        value = [part.strip() for part in value.split(";") if part.strip()]
    values: Sequence[Any] = value if isinstance(value, list) else [value]
    if len(values) > (INSTANTS if several else 1):
        raise InputError(name, _("give at most {most}").format(most=INSTANTS if several else 1))
    kind = option.kind if isinstance(option, ValueOption) else str
    read = tuple(_read(name, kind, one) for one in values)
    return read if several else read[0]


def _read(name: str, kind: type[Any], value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise InputError(name, _("a number is needed") if kind is not str else _("a text is needed"))
    if isinstance(value, str) and len(value) > TEXT:
        raise InputError(name, _("the text is too long"))
    if kind is str:
        return value if isinstance(value, str) else repr(float(value))
    try:
        number = kind(value)
    except (ValueError, OverflowError):
        raise InputError(name, _("a number is needed")) from None
    if not math.isfinite(number):
        raise InputError(name, _("a number is needed"))
    return number


def mathematics_of(description: Described) -> Any:
    """What sets formulas as MathML; None where the libraries for documents are not installed."""
    try:
        spelling = SPELLING(NUMBERS(description.display, 5))
        FORMULAS.load()
    except (ModuleNotFoundError, CentrodeError):
        return None

    def set_formulas(formulas: Sequence[Formula]) -> list[str]:
        spelled = [
            [" = ".join(map(spelling.mathematics, parts)) for parts in formula.lines] for formula in formulas
        ]
        made = FORMULAS([line for lines in spelled for line in lines])
        return ["".join(f"<div>{made.display_formula(line)}</div>" for line in lines) for lines in spelled]

    return set_formulas
