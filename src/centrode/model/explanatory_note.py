"""What a description says of its report as an explanatory note: title page, task, conclusions, sources, standard."""

from __future__ import annotations

import unicodedata
from typing import Annotated

from pydantic import PlainValidator

from centrode.locale import _
from centrode.model.page_standards import STANDARDS, Standard
from centrode.model.reading import KEY, DescriptionPart, Problem, bounded_list, choice, value_text

PROSE_LENGTH = 20_000
"""Characters of a text of several paragraphs."""
LINE_LENGTH = 300
"""Characters of a line of the title page."""
SOURCE_LENGTH = 1000
"""Characters of an entry of the list of sources."""
MOST_SOURCES = 200
FIRST_YEAR, LAST_YEAR = 1900, 2200


def read_prose(value: object) -> str:
    """A text of several lines."""
    if not isinstance(value, str):
        raise Problem(_("expected a text, got {value}").format(value=value_text(value)))
    if len(value) > PROSE_LENGTH:
        what = _("a text has at most {most} characters, got {count}")
        raise Problem(what.format(most=PROSE_LENGTH, count=len(value)), _("shorten it"))
    if any(unicodedata.category(letter) in ("Cc", "Cs") and letter not in "\n\r\t" for letter in value):
        raise Problem(_("{key} has control characters").format(key=KEY), _("remove them"))
    return value


def read_paragraphs(value: object) -> str:
    """A text of several lines that says something; an empty one is that of a key that is left out."""
    text = read_prose(value)
    if text and not text.strip():
        raise Problem(_("{key} is empty").format(key=KEY), _("write a text, or remove the key"))
    return text


def _line(value: object, most: int) -> str:
    if not isinstance(value, str):
        raise Problem(_("expected a text, got {value}").format(value=value_text(value)))
    if value and not value.strip():
        raise Problem(_("{key} is empty").format(key=KEY), _("write a text, or remove the key"))
    if len(value) > most:
        what = _("a text has at most {most} characters, got {count}")
        raise Problem(what.format(most=most, count=len(value)), _("shorten it"))
    if not all(letter.isprintable() or unicodedata.category(letter) == "Zs" for letter in value):
        what = _("{value} has control characters").format(value=value_text(value))
        raise Problem(what, _("write one line of text"))
    return " ".join(value.split())


def _read_line(value: object) -> str:
    return _line(value, LINE_LENGTH)


def _read_variant(value: object) -> str:
    """Variants have numbers, with or without letters."""
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else _read_line(value)


def _read_source(value: object) -> str:
    if value == "":
        raise Problem(_("{key} is empty").format(key=KEY), _("write a text, or remove the key"))
    return _line(value, SOURCE_LENGTH)


def _read_year(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise Problem(_("{key} must be a whole number, got {value}").format(key=KEY, value=value_text(value)))
    if not FIRST_YEAR <= value <= LAST_YEAR:
        what = _("{key} must lie between {least} and {most}, got {value}")
        raise Problem(what.format(key=KEY, least=FIRST_YEAR, most=LAST_YEAR, value=value_text(value)))
    return value


Line = Annotated[str, PlainValidator(_read_line)]
Paragraphs = Annotated[str, PlainValidator(read_paragraphs)]


class TitlePage(DescriptionPart):
    """Lines of the title page of a report; what is not given is not there.

    Attributes
    ----------
    ministry, institution, faculty, department : where the work is done
    work : its kind, such as "Explanatory note to the course project"
    course : the subject taught
    title : what the work is about; the title of the description where it is left out
    variant : number of the assignment
    author, group : who did it
    teacher : who accepts it
    city : str
    year : int
    designation : of the drawings, in their main inscriptions; the number of the sheet is appended
    """

    ministry: Line = ""
    institution: Line = ""
    faculty: Line = ""
    department: Line = ""
    work: Line = ""
    course: Line = ""
    title: Line = ""
    variant: Annotated[str, PlainValidator(_read_variant)] = ""
    author: Line = ""
    group: Line = ""
    teacher: Line = ""
    city: Line = ""
    year: Annotated[int, PlainValidator(_read_year)] | None = None
    designation: Line = ""


class ExplanatoryNote(DescriptionPart):
    """What makes a report a note that is handed in; texts are Markdown.

    Attributes
    ----------
    standard : "plain", "gost" or "dstu"
        Page style and captions; of a report that has any of the keys below, that of its language if left out.
    title_page : TitlePage
    task : what is given and what is to be done
    abstract, introduction : before and after the contents
    conclusions : the author's own, after those that follow from the results
    sources : tuple of str
        The list of sources, an entry each.
    """

    standard: Annotated[Standard, choice(*STANDARDS)] | None = None
    title_page: TitlePage | None = None
    task: Paragraphs = ""
    abstract: Paragraphs = ""
    introduction: Paragraphs = ""
    conclusions: Paragraphs = ""
    sources: Annotated[
        tuple[Annotated[str, PlainValidator(_read_source)], ...], bounded_list(MOST_SOURCES)
    ] = ()

    @property
    def is_note(self) -> bool:
        """Whether anything of a note is given."""
        given = (self.title_page, self.task, self.abstract, self.introduction, self.conclusions, self.sources)
        return any(given) or self.standard in ("gost", "dstu")
