"""Texts of TOML: their tables, bounded, and the part that they describe."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from centrode.errors import InputError
from centrode.locale import _, mark
from centrode.model import reading
from centrode.model.look_alikes import in_latin
from centrode.model.reading import DescriptionPart, input_error, value_text
from centrode.model.units import international
from centrode.model.values import RAD, READING, BareAngles, Radians, Reading

# What the parser of TOML complains about, in sentences of ours: its own are for programmers, and English
# only.

_TWICE = mark("a key is given twice")
_OPEN_TEXT = mark("a text is not closed: its quote is missing")
_NO_CHARACTER = mark("the code of a character in a text is wrong")
_CLOSED = mark("this table is complete already, nothing can be added to it")

_SENTENCES = {
    r"Invalid statement": mark("this is neither a [heading] nor key = value"),
    r"Expected newline or end of document .*": mark("there is more on the line than one value"),
    r"Cannot declare .* twice": mark("this table is already in the file"),
    r"Cannot overwrite a value": _TWICE,
    r"Duplicate inline table key .*": _TWICE,
    r"Cannot (mutate|redefine) .*": _CLOSED,
    r"Expected '\]+' at the end of .*": mark("a heading is not closed: its bracket is missing"),
    r"Expected '=' after a key .*": mark("= is missing after a key"),
    r"Invalid initial character for a key part": mark("a key is missing, or begins with a wrong character"),
    r"Unclosed array": mark("a list is not closed: its bracket is missing"),
    r"Unclosed inline table": mark("a table is not closed: its brace is missing"),
    r"Unterminated string": _OPEN_TEXT,
    r"(Illegal|Found invalid) character '\\n'|Expected ['\"]{3,}": _OPEN_TEXT,
    r"Illegal character .*|Found invalid character .*": mark("this character is not allowed here"),
    r"Unescaped '\\' in a string": mark("a backslash in a text: double it, or use single quotes"),
    r"Invalid hex value|Escaped character .*": _NO_CHARACTER,
    r"Invalid date or datetime": mark("this date does not exist"),
    r"Invalid value": mark("a value is missing, or a text without quotes"),
}


def toml_reason(message: str) -> str:
    """The sentence for what `tomllib` says; its own words where a later version of it says something new."""
    for pattern, sentence in _SENTENCES.items():
        if re.fullmatch(pattern, message, re.DOTALL):
            return _(sentence)
    return message


Described = TypeVar("Described", bound=DescriptionPart)

_KEY = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
# Dotted keys nest without a bracket, and cost the parser the square of their number.
_DOTTED = re.compile(rf"(?<![\w-]){_KEY}(?:[ \t]*+\.[ \t]*+{_KEY}){{{reading.NESTING * 2},}}")
# Two mistakes of people who are used to other decimals and to units behind numbers: 3,5 and 3.5 mm.
_COMMA = re.compile(r"=[ \t]*+([+-]?\d++),(\d++)([ \t]*+)")
_NUMBER = re.compile(r"(?:[=\[,]|^)[ \t]*+([+-]?\d[\d_.]*+(?:[eE][+-]?\d++)?+)[ \t]*+$")
_UNIT = re.compile(r"([^\W\d_]|[°%])[^\s,\]}#=\"']*+(?![ \t]*+=)")
_WORD = re.compile(r"[\w-]+")
_BARE = re.compile(r"([^\W\d][\w-]*+)[ \t\r]*+(?:#.*)?")
TYPOGRAPHIC, DASHES = tuple("“”„‟«»‘’‚"), tuple("−–—‐‑")
INVISIBLE = tuple("\u200b\u200c\u200d\u2060\ufeff\u00ad\u200e\u200f")
BARE_VALUES = ("true", "false", "inf", "nan")
"""Words that are values of TOML in small letters."""
_PLACE = re.compile(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", re.DOTALL)


def parse_tables(
    kind: type[Described],
    mapping: Mapping[str, Any],
    where: str,
    folder: Path | None,
    bare_angles: BareAngles = "radians",
) -> Described:
    """What plain dicts and lists describe, files beside it in `folder`; raises InputError that starts with `where`."""
    try:
        return validated_tables(kind, mapping, folder, bare_angles)
    except ValidationError as error:
        raise input_error(error, where) from None


def validated_tables(
    kind: type[Described], mapping: Mapping[str, Any], folder: Path | None, bare_angles: BareAngles
) -> Described:
    """What plain dicts and lists describe; raises pydantic's ValidationError, in which each problem has its place."""
    token = READING.set(Reading(folder=folder or Path(), bare_angles=bare_angles))
    try:
        return kind.model_validate(dict(mapping))
    finally:
        READING.reset(token)


def bare_angles_of(mapping: Mapping[str, Any]) -> BareAngles:
    """What an angle without a unit is in a file: refused where the file displays anything but radians."""
    display = mapping.get("display")
    angle = display.get("angle", RAD) if isinstance(display, Mapping) else RAD
    return "radians" if angle == RAD else "refused"


@dataclass(frozen=True)
class KindOfDescription:
    """What a description may be of.

    Attributes
    ----------
    described, wanted : "this describes a cam" and "not a cam", together a sentence about two kinds
    repair : what computes it
    named, unknown : of a value of another description that should name one, and of a name that no built-in one has;
        empty where no other description names this kind
    """

    described: str
    wanted: str
    repair: str
    named: str = ""
    unknown: str = ""


SYNTHESIS = "synthesis"
KINDS: Mapping[str, KindOfDescription] = {
    "linkage": KindOfDescription(
        mark("this describes a linkage"),
        mark("not a linkage"),
        mark("compute it with: centrode run; in Python read it with read_mechanism"),
    ),
    "cam": KindOfDescription(
        mark("this describes a cam"),
        mark("not a cam"),
        mark("compute it with: centrode cam; in Python read it with read_cam"),
        mark("expected the name of a cam's file or of a built-in cam, got {value}"),
        mark("there is no built-in cam {name}"),
    ),
    "gear pair": KindOfDescription(
        mark("this describes a pair of gears"),
        mark("not a pair of gears"),
        mark("compute it with: centrode gears; in Python with gear_pair"),
        mark("expected the name of a file or of a built-in pair of gears, got {value}"),
        mark("there is no built-in pair of gears {name}"),
    ),
    "gear train": KindOfDescription(
        mark("this describes a train of gears"),
        mark("not a train of gears"),
        mark("compute it with: centrode trains; in Python with gear_train"),
    ),
    SYNTHESIS: KindOfDescription(
        mark("this is a request of synthesis"),
        mark("not a request of synthesis"),
        mark("answer it with: centrode synthesise; in Python with synthesise"),
    ),
}
"""Kinds of descriptions; the file of a linkage names none, one of a synthesis has a table of that name."""


def description_kind(mapping: Mapping[str, Any]) -> str | None:
    """The kind of description, a key of `KINDS`; None where neither its kind nor its tables say it."""
    if SYNTHESIS in mapping:
        return SYNTHESIS
    kind = mapping.get("kind")
    if isinstance(kind, str) and kind in KINDS and kind not in ("linkage", SYNTHESIS):
        return kind
    return "linkage" if "links" in mapping else None


def refuse_other_kind(mapping: Mapping[str, Any], wanted: str, where: str = "") -> None:
    """Raise InputError, with what computes it, where a description is of another kind than a wanted one."""
    kind = description_kind(mapping)
    if kind is not None and kind != wanted:
        what = _("{described}, {wanted}")
        described, other = _(KINDS[kind].described), _(KINDS[wanted].wanted)
        raise InputError(where, what.format(described=described, wanted=other), _(KINDS[kind].repair))


def with_unit(value: Any) -> Any:
    """Tables and lists with angles that are `Radians` as texts with their unit; 0 needs none."""
    if isinstance(value, Radians):
        return f"{float(value)!r} {RAD}" if value else 0.0
    if isinstance(value, Mapping):
        return {key: with_unit(entry) for key, entry in value.items()}
    return [with_unit(entry) for entry in value] if isinstance(value, list) else value


_SHORT_LIST = re.compile(r"\[\n((?: +[^\[\]\n]*,\n)+) *\]")


def in_short_lines(text: str) -> str:
    """A text of TOML with short lists in one line each."""
    return _SHORT_LIST.sub(_in_one_line, text)


def _in_one_line(match: re.Match[str]) -> str:
    return "[" + ", ".join(line.strip().removesuffix(",") for line in match.group(1).splitlines()) + "]"


def toml_tables(text: str, where: str) -> dict[str, Any]:
    """Tables of a text of TOML; raises InputError where it is none, is too long, or nests too deeply."""
    if len(text) > reading.FILE_SIZE:
        what = _("the text has {size} characters, at most {most} are allowed")
        raise InputError(where, what.format(size=len(text), most=reading.FILE_SIZE))
    repair = _("tables and lists may be nested at most {most} deep").format(most=reading.NESTING)
    nested = InputError(where, _("the text nests too deeply"), repair)
    if _DOTTED.search(text):
        raise nested
    try:
        tables = tomllib.loads(text)
    except RecursionError:
        raise nested from None
    except tomllib.TOMLDecodeError as error:
        raise _not_toml(str(error), text, where) from None
    except ValueError:  # a date or a number that Python cannot hold
        reason = _("a date is impossible, or a number has too many digits")
        raise InputError(where, _("not TOML: {reason}").format(reason=reason)) from None
    if _depth(tables) > reading.NESTING:
        raise nested
    return tables


def _not_toml(message: str, text: str, where: str) -> InputError:
    match = _PLACE.fullmatch(message)
    reason, repair = toml_reason(match.group(1) if match else message), ""
    if match and match.group(2):
        line, column = int(match.group(2)), int(match.group(3))
        # Lines as the parser counts them: `splitlines` would part a text at other characters too.
        written, at = text.split("\n")[line - 1], column - 1
        reason, repair = (
            _mistyped_number(written, at)
            or _wrong_sign(written, at)
            or _unquoted_letter(written, at)
            or _unquoted_text(written, at)
            or (reason, repair)
        )
    else:
        lines = text.splitlines() or [""]
        line, column = len(lines), len(lines[-1]) + 1
    place = _("line {line}, column {column}").format(line=line, column=column)
    what = _("not TOML: {reason}").format(reason=reason)
    return InputError(f"{where}, {place}" if where else place, what, repair)


def _mistyped_number(line: str, at: int) -> tuple[str, str] | None:
    """Reason and repair where the parser stopped at a number with a decimal comma, or with a unit but no quotes."""
    for comma in _COMMA.finditer(line):
        if comma.start() < at <= comma.end():
            number = f"{comma.group(1)}.{comma.group(2)}"
            behind = _UNIT.match(line, comma.end())
            written = value_text(f"{number} {international(behind.group())}") if behind else number
            return _("decimals have a point, not a comma"), _("write {number}").format(number=written)
    number_before = _NUMBER.search(line, 0, at)
    unit = _UNIT.match(line, at)
    if number_before and unit:
        written = value_text(f"{number_before.group(1)} {international(unit.group())}")
        return _("a number with a unit is a text in quotes"), _("write {number}").format(number=written)
    return None


def _wrong_sign(line: str, at: int) -> tuple[str, str] | None:
    """Reason and repair where the parser stopped at a sign that documents have in place of one of the keyboard."""
    sign = line[at : at + 1]
    if sign in TYPOGRAPHIC:
        return _("these quotes are typographic"), _('type straight ones: "..."')
    if sign in DASHES:
        return _("this minus is typographic"), _("type the one of the keyboard: -")
    if sign and (sign in INVISIBLE or (sign.isspace() and sign not in " \t\r")):
        what = _("a space or an invisible character that TOML does not know (U+{code:04X})")
        return what.format(code=ord(sign)), _("remove it, or type an ordinary space")
    if line.startswith("```"):
        return _("``` belongs to the document, not to the example"), _("remove this line")
    return None


def _unquoted_text(line: str, at: int) -> tuple[str, str] | None:
    """Reason and repair where a value is a bare word."""
    word = _BARE.fullmatch(line[at:]) if line[:at].rstrip().endswith("=") else None
    if word is None:
        return None
    if word.group(1).casefold() in BARE_VALUES:
        what = _("TOML writes this word in small letters")
        return what, _("write {number}").format(number=word.group(1).casefold())
    return _("a text stands in quotes"), _("write {number}").format(number=value_text(word.group(1)))


def _unquoted_letter(line: str, at: int) -> tuple[str, str] | None:
    """Reason and repair where the parser stopped in a bare key at a letter beyond a to z."""
    key = next((one for one in _WORD.finditer(line) if one.start() <= at < one.end()), None)
    heading = line.lstrip().startswith("[") and "]" not in line[:at]
    is_key = key and (heading or line[key.end() :].lstrip()[:1] in ("=", "."))
    if not key or not is_key or key.group().isascii() or line[at].isascii():
        return None
    name = key.group()
    latin = in_latin(name)
    quoted = _('put the name in quotes: "{name}"').format(name=name)
    if not latin.isascii():
        return _("a name with letters other than a to z stands in quotes"), quoted
    letters = ", ".join(dict.fromkeys(letter for letter in name if letter != in_latin(letter)))
    return (
        _('{letters} in "{name}" only looks like a Latin letter').format(letters=letters, name=name),
        _("type {latin} with the Latin keyboard layout, or {quoted}").format(latin=latin, quoted=quoted),
    )


def _depth(value: object) -> int:
    """How deeply tables and lists nest, found level by level: no recursion that a file could exhaust."""
    depth, level = 0, [value]
    while level:
        inner: list[object] = []
        for entry in level:
            if isinstance(entry, dict):
                inner += entry.values()
            elif isinstance(entry, list):
                inner += entry
        depth, level = depth + 1, inner
        if depth > reading.NESTING:
            break
    return depth
