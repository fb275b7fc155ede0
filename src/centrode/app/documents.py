"""The text of a description as the workbench has it: what it describes, and what is wrong with it at which line."""

from __future__ import annotations

import hashlib
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeAlias

from pydantic import ValidationError

from centrode.app.panel_titles import with_panel_titles
from centrode.app.text_places import line_and_column, text_places
from centrode.errors import CentrodeError, InputError
from centrode.kinematics.preparation import Ready, ready
from centrode.locale import _, chosen_language
from centrode.model.cam_files import AnyCam, kind_of_cam
from centrode.model.mechanism import Mechanism
from centrode.model.reading import PROBLEMS_SOUGHT, Place, error_at_place, problems_within
from centrode.model.toml import (
    bare_angles_of,
    description_kind,
    refuse_other_kind,
    toml_tables,
    validated_tables,
)

Tables: TypeAlias = Mapping[str, Any]

TEXT_SIZE = 300_000
"""Characters of a description in the workbench; a description of 200 links has some 20 000."""
KEPT = 32
"""Descriptions that are kept read."""
MENDED_LINES = 5
"""Lines that are left out in turn, where the text is no TOML, to draw what the others describe."""

_LINE = re.compile(r"line (\d+), column (\d+)")
_ENTRY = re.compile(r"\[\[([\w.]+)\]\](?: (\d+))?,? ?([\w.]*)")
_TABLE = re.compile(r"\[([^\[\]]+)\] ?([\w.]*)")


@dataclass(frozen=True)
class TextProblem:
    """Something wrong with a text, at a line and a column, both from 1."""

    message: str
    repair: str
    line: int
    column: int
    path: str

    def as_dict(self) -> dict[str, Any]:
        """As a message holds it."""
        return {
            "message": with_panel_titles(self.message),
            "repair": with_panel_titles(self.repair),
            "line": self.line,
            "column": self.column,
            "path": self.path,
        }


@dataclass(frozen=True)
class Document:
    """A text and what it describes.

    Attributes
    ----------
    tables : as complete as the text allows; empty where nothing can be read
    mechanism, cam : what it describes; None where something is wrong with it
    prepared : the mechanism with its plan and initial position; None where it does not assemble
    free : where a drive has no law, so that only a simulation moves the mechanism: its initial position all the same
    problems : in the order of the text
    """

    text: str
    tables: Tables
    mechanism: Mechanism | None
    cam: AnyCam | None
    prepared: Ready | None
    problems: tuple[TextProblem, ...]
    free: Ready | None = None

    @property
    def position(self) -> Ready | None:
        """The mechanism in its initial position, whether its drives have laws or not."""
        return self.prepared or self.free

    @property
    def digest(self) -> str:
        """By which a message names the text."""
        return digest_of(self.text)

    @property
    def is_cam(self) -> bool:
        """Whether the text says that it describes a cam."""
        return description_kind(self.tables) == "cam"

    def require_mechanism(self) -> Mechanism:
        """The mechanism; InputError with its first problem where the text describes none."""
        if self.mechanism is None:
            raise self._refusal()
        return self.mechanism

    def require_prepared(self) -> Ready:
        """The mechanism in its initial position; InputError with the first problem where it does not assemble."""
        if self.prepared is None:
            raise self._refusal()
        return self.prepared

    def _refusal(self) -> InputError:
        if not self.problems:
            return InputError("", _("this describes a cam, not a linkage"))
        first = self.problems[0]
        place = _("line {line}").format(line=first.line)
        return InputError(place, first.message, first.repair)


def digest_of(text: str) -> str:
    """The digest of a text, in hexadecimal digits."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def read_document(text: str, folder: Path) -> Document:
    """Read a text; nothing that it may hold raises. Files that it names lie in `folder`."""
    return _kept_document(text, folder, chosen_language())


@lru_cache(maxsize=KEPT)
def _kept_document(text: str, folder: Path, _language: str) -> Document:
    if len(text) > TEXT_SIZE:
        what = _("the text has {size} characters, at most {most} are allowed")
        problem = TextProblem(what.format(size=len(text), most=TEXT_SIZE), _("shorten it"), 1, 1, "")
        return Document(text, {}, None, None, None, (problem,))
    try:
        tables = toml_tables(text, "")
    except InputError as error:
        return Document(text, _readable_tables(text), None, None, None, (_at_line(error, text),))
    try:
        if description_kind(tables) == "cam":
            cam: AnyCam = validated_tables(kind_of_cam(tables), tables, folder, bare_angles_of(tables))
            return Document(text, tables, None, cam, None, ())
        refuse_other_kind(tables, "linkage")
        # a text that nobody has begun lacks links, not a key
        given = {"links": {}, **tables}
        mechanism = validated_tables(Mechanism, given, folder, bare_angles_of(tables))
    except ValidationError as error:
        return Document(text, tables, None, None, None, tuple(_validation_problems(error, text)))
    except CentrodeError as error:
        return Document(text, tables, None, None, None, (_at_place(error, text),))
    try:
        return Document(text, tables, mechanism, None, ready(mechanism), ())
    except CentrodeError as error:
        return Document(
            text, tables, mechanism, None, None, (_at_place(error, text),), _free_position(mechanism)
        )


def _free_position(mechanism: Mechanism) -> Ready | None:
    """The initial position of a mechanism with free coordinates: where a drive stands does not depend on its law."""
    drives = tuple(
        drive if drive.has_law else drive.model_copy(update={"speed": 1.0}) for drive in mechanism.drives
    )
    if drives == mechanism.drives:
        return None
    try:
        return ready(mechanism.model_copy(update={"drives": drives}))
    except CentrodeError:
        return None


def _validation_problems(error: ValidationError, text: str) -> Iterator[TextProblem]:
    places = text_places(text)
    for problem in problems_within(error)[:PROBLEMS_SOUGHT]:
        said = error_at_place(problem, (), "")
        line, column = places.position(problem.at)
        yield TextProblem(said.what, said.repair, line, column, path_of(problem.at))


def path_of(place: Place) -> str:
    """A place as keys with dots between them."""
    return ".".join(map(str, place))


def _at_line(error: InputError, text: str) -> TextProblem:
    """A problem of the parser of TOML, which names its line."""
    found = _LINE.search(error.where) or re.search(r"(\d+)\D+(\d+)\Z", error.where)
    line, column = (int(found.group(1)), int(found.group(2))) if found else line_and_column(text, len(text))
    return TextProblem(error.what, error.repair, line, column, "")


def _at_place(error: CentrodeError, text: str) -> TextProblem:
    """A problem of the whole, whose sentence names a heading, or nothing."""
    place = place_named(error.where)
    line, column = text_places(text).position(place) if place else (1, 1)
    named = error.where if error.where and not place else ""
    what = f"{named}: {error.what}" if named else error.what
    return TextProblem(what, error.repair, line, column, path_of(place))


def place_named(where: str) -> Place:
    """The place that a message names as "[links.BC] length" or "[[guides]] 2, point"; empty for any other words."""
    entry = _ENTRY.match(where)
    if entry:
        keys = tuple(entry.group(3).split(".")) if entry.group(3) else ()
        return (*entry.group(1).split("."), int(entry.group(2) or 1) - 1, *keys)
    table = _TABLE.match(where)
    if table:
        keys = tuple(table.group(2).split(".")) if table.group(2) else ()
        return (*table.group(1).split("."), *keys)
    return ()


def _readable_tables(text: str) -> Tables:
    """Tables of a text that is no TOML, without the lines at which the parser stops."""
    lines = text.split("\n")
    for _attempt in range(MENDED_LINES):
        try:
            return toml_tables("\n".join(lines), "")
        except InputError as error:
            found = re.search(r"(\d+)\D+(\d+)\Z", error.where)
            number = int(found.group(1)) - 1 if found else -1
            if not 0 <= number < len(lines) or not lines[number].strip():
                break
            lines[number] = ""
    return {}


def plain_tables(text: str) -> dict[str, Any]:
    """Tables of a text that is known to be TOML."""
    return tomllib.loads(text)
