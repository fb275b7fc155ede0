"""Text of a file that somebody else wrote: bounded, a regular file, in UTF-8."""

from __future__ import annotations

import difflib
import re
import stat
import unicodedata
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from types import UnionType
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError, WrapSerializer, model_validator

from centrode.errors import InputError
from centrode.files.inputs import note
from centrode.locale import _, mark, ngettext
from centrode.model.look_alikes import in_latin, letters_note, likeness_note, look_alike, look_alike_pairs

# What a file may ask for at most: a text that asks for more is refused before anything is built from it.

FILE_SIZE = 1_000_000
"""Bytes of a description or of a drive's table."""

LINKS = 200
"""Structure and systems of equations grow with their square and more: a check takes seconds here, a run a minute."""
POINTS = 2000
GUIDES = 500
DRIVES = 100
LOADS = 500
SAMPLES = 1_000_000
INSTANTS = 1000
TABLE_ROWS = 10_000

GREATEST = 1e50
"""Greatest number; fourth powers of it can still be computed with."""

GREATEST_ANGLE = 1e6
"""Greatest angle [rad]: of a greater one the place within a turn is lost in rounding."""

LEAST = 1e-50
"""Least length and other number that has to be positive."""

NAME_LENGTH = 40
TEXT_LENGTH = 1000
"""Characters of a title or a formula."""

QUANTITY_LENGTH = 100
"""Characters of a number with its unit."""

UNIT_LENGTH = 40
NESTING = 12
"""Tables and lists inside each other; the grammar needs five."""

PROBLEMS_SOUGHT = 20
"""Problems of one table after which no more are looked for."""

PROBLEMS_SHOWN = 5
"""Problems of one file that are told together."""


# Problems of a description while it is read, and the sentences they become.

Place = tuple[str | int, ...]
"""Keys and indices from the top of the description to the value a problem is about."""

TABLES = (
    *("display", "frame", "assembly", "machine", "study", "report", "tolerances"),
    *("curvature", "start", "range", "roller", "return", "mover", "contact", "choose"),
    *("cam", "follower", "bounds", "tool"),
)

KEY = "{key}"
"""Stands in a problem's sentence for the key it is about, which only the reader of the whole knows."""


class Problem(ValueError):
    """One thing wrong with a description; pydantic gathers these and adds the place above `at`."""

    def __init__(self, what: str, repair: str = "", at: Place = ()) -> None:
        super().__init__(what)
        self.what = what
        self.repair = repair
        self.at = at


class Problems(ValueError):
    """Several problems found by one check."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        super().__init__("; ".join(problem.what for problem in problems))
        self.problems = tuple(problems)


def value_text(value: object) -> str:
    """A value as a sentence shows it: texts in quotes, numbers as written, anything else by its kind."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        text = value if len(value) <= 60 else value[:57] + "..."
        return '"' + "".join(c if c.isprintable() else repr(c)[1:-1] for c in text) + '"'
    if isinstance(value, float):
        return repr(value).removesuffix(".0")
    if isinstance(value, int):
        return str(value) if abs(value) < 10**30 else _("a number of that size")
    if isinstance(value, dict):
        return _("a table")
    if isinstance(value, list | tuple):
        count = len(value)
        return ngettext("a list of {count} value", "a list of {count} values", count).format(count=count)
    return _("a value of another kind")


def likely(name: str, known: Iterable[str]) -> str:
    """Repair of a misspelt name: the nearest known one, if one is near."""
    names = list(known)
    alike = look_alike(name, names)
    if alike is not None:
        if len(names) == 1:  # either may be mistyped
            return likeness_note(name, alike)
        odd, common = next(pair for pair in look_alike_pairs([name, *names]) if name in pair)
        return letters_note(odd, [(odd, common)])
    folded = [other for other in names if other.casefold() == name.casefold()]
    cutoff = 0.5 if len(name) <= 3 else 0.6  # AO is near OA; "angle" is not near "machine"
    looks = {in_latin(other): other for other in reversed(names)}
    near = difflib.get_close_matches(in_latin(name[:NAME_LENGTH]), [*looks], n=1, cutoff=cutoff)
    close = folded or [looks[other] for other in near]
    return _("did you mean {name}?").format(name=value_text(close[0])) if close else ""


def nearest(name: str, known: Iterable[str]) -> str:
    """Repair of a misspelt name: the nearest known one, else what is known."""
    names = list(known)
    repair = likely(name, names)
    if repair or not names:
        return repair
    few = ", ".join(names[:20]) + (", ..." if len(names) > 20 else "")
    return _("known are: {names}").format(names=few)


def location(place: Place) -> tuple[str, str]:
    """Table and key of a place as the file spells them: ("[links.BC]", "length"), ("[[guides]] 2", "point")."""
    place = tuple(part if isinstance(part, int) else value_text(str(part))[1:-1] for part in place)
    if len(place) >= 2 and isinstance(place[1], int):
        return f"[[{place[0]}]] {place[1] + 1}", ".".join(str(p) for p in place[2:])
    if len(place) >= 3 and place[:2] == ("machine", "shafts") and isinstance(place[2], int):
        return f"[[machine.shafts]] {place[2] + 1}", ".".join(str(p) for p in place[3:])
    if (len(place) == 2 and place[0] == "links") or place == ("frame", "points"):
        return "[" + ".".join(str(p) for p in place) + "]", ""
    if len(place) >= 2 and isinstance(place[-1], int):
        return "[" + ".".join(str(p) for p in place[:-2]) + "]", str(place[-2])
    if len(place) >= 2:
        return "[" + ".".join(str(p) for p in place[:-1]) + "]", str(place[-1])
    if place and place[0] in TABLES:
        return f"[{place[0]}]", ""
    return "", str(place[0]) if place else ""


def error_at_place(problem: Problem, place: Place, source: str) -> InputError:
    """The sentence of a problem at a place of a source (a file's name; empty in Python)."""
    table, key = location(place + problem.at)
    what = problem.what
    if KEY in what:
        what = what.replace(KEY, key, 1)
    elif key:
        table = f"{table} {key}" if not table.startswith("[[") else f"{table}, {key}"
    where = ", ".join(part for part in (source, table.strip()) if part)
    return InputError(where, what, problem.repair)


def problems_of(error: dict[str, Any]) -> list[Problem]:
    """The problems that one of pydantic's errors carries; its own kinds are told without its words."""
    cause = error.get("ctx", {}).get("error")
    if isinstance(cause, Problems):
        return list(cause.problems)
    if isinstance(cause, Problem):
        return [cause]
    return [Problem(_("this value does not fit here: {value}").format(value=value_text(error.get("input"))))]


def problems_within(error: ValidationError) -> list[Problem]:
    """The problems that pydantic gathered, each with its place in what was read."""
    return [
        Problem(problem.what, problem.repair, place + problem.at)
        for entry in error.errors(include_url=False)
        for place in [tuple(part for part in entry["loc"] if part != "[key]")]
        for problem in problems_of(dict(entry))
    ]


def input_error(error: ValidationError, source: str) -> InputError:
    """One InputError that tells the first few problems pydantic gathered, one a line."""
    found = [error_at_place(problem, (), source) for problem in problems_within(error)]
    first, rest = found[0], found[1:PROBLEMS_SHOWN]
    lines = [str(other) for other in rest]
    left = len(found) - 1 - len(rest)
    if left > 0:
        lines.append(
            ngettext("and {count} more problem", "and {count} more problems", left).format(count=left)
        )
    tail = "".join("\n" + line for line in lines)
    if first.repair:
        return InputError(first.where, first.what, first.repair + tail)
    return InputError(first.where, first.what + tail)


CSV_SEPARATORS = ",;\t"
"""What may part the columns of a CSV file: spreadsheets write semicolons where decimals have commas."""


def csv_separator(text: str) -> str:
    """What parts the columns of a CSV file: that of CSV_SEPARATORS which its first line has most of."""
    return max(CSV_SEPARATORS, key=text.partition("\n")[0].count)


def read_file(path: Path) -> str:
    """Text of a file.

    Raises
    ------
    InputError
        Missing, not a regular file, not readable, more than `limits.FILE_SIZE` bytes (told before any is
        read), or not UTF-8.
    """
    content = read_content(path, FILE_SIZE)
    for signature, what in _SIGNATURES.items():
        if content.startswith(signature):
            raise InputError(_shown_name(path), _(what), _("give a file of plain text"))
    if _is_utf16(content):
        what = _("the file is text in UTF-16, not in UTF-8")
        repair = _(
            "save it as UTF-8 (Notepad: Save as, Encoding); in PowerShell write files by --out, not by >"
        )
        raise InputError(_shown_name(path), what, repair)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        what = _("the file is not text in UTF-8 (byte {place})").format(place=error.start)
        raise InputError(
            _shown_name(path), what, _("save it as UTF-8 (Notepad: Save as, Encoding)")
        ) from None


_OFFICE = mark("this is a document of an office program, or an archive, not plain text")
_PICTURE = mark("this is a picture, not plain text")
_SIGNATURES: Mapping[bytes, str] = {
    b"%PDF-": mark("this is a PDF, not plain text"),
    b"PK\x03\x04": _OFFICE,
    b"\xd0\xcf\x11\xe0": _OFFICE,
    b"{\\rtf": _OFFICE,
    b"\x89PNG": _PICTURE,
    b"\xff\xd8\xff": _PICTURE,
}
"""How files begin that somebody may take for a description."""


def _is_utf16(content: bytes) -> bool:
    """Whether bytes are a text in UTF-16: after its mark, or, as Latin letters have there, with a zero beside each."""
    if len(content) < 4 or len(content) % 2:
        return False
    zeros = [content[start:200:2].count(0) for start in (0, 1)]
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return max(zeros) > 0
    return max(zeros) > 0.8 * len(content[:200:2]) and min(zeros) == 0


def read_content(path: Path, most: int) -> bytes:
    """Bytes of a file, at most so many; raises InputError as `read_file` does."""
    where = _shown_name(path)
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise InputError(where, _("this is not a file"), _("give the path of a file"))
        if status.st_size <= most:
            with path.open("rb") as stream:
                content = stream.read(most + 1)
            note(path, status)
        if status.st_size > most or len(content) > most:
            what = _("the file has {size} bytes, at most {most} are allowed")
            raise InputError(where, what.format(size=status.st_size, most=most))
        return content
    except FileNotFoundError:
        repair = _file_meant(path) or _("check the path")
        raise InputError(where, _("there is no such file"), repair) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(where, _("the file cannot be read: {reason}").format(reason=reason)) from None


def _file_meant(path: Path) -> str:
    """Repair that names a file beside the path whose name is near; empty where there is none."""
    try:
        # a folder may hold anything: the first thousands are enough
        beside = [entry.name for entry in islice(path.parent.iterdir(), 2000) if entry.is_file()]
    except (OSError, ValueError):
        return ""
    longer = f"{path.name}.txt"  # Windows shows no endings
    same_kind = [name for name in beside if name.endswith(path.suffix)]
    return likely(path.name, [longer] if longer in beside else same_kind)


def _shown_name(path: Path) -> str:
    return value_text(path.name or str(path))[1:-1]


# What every part of a description is: frozen data that names what it does not know.

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)  # its name is private to pydantic


class _Telling(ModelMetaclass):
    """Makes a wrong value given in Python an InputError; parts inside parts are gathered by pydantic first."""

    def __call__(cls, *args: Any, **values: Any) -> Any:  # noqa: N805
        try:
            return super().__call__(*args, **values)
        except ValidationError as error:
            raise input_error(error, "") from None


class DescriptionPart(BaseModel, metaclass=_Telling):
    """Frozen data with known keys only; a wrong value raises InputError."""

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        validate_by_name=True,
        validate_by_alias=True,
        arbitrary_types_allowed=True,
    )

    among_keys: ClassVar[str] = ""
    """Field of which a file writes the entries among the keys of the part; none if empty."""
    repairs: ClassVar[Mapping[str, str]] = {}
    """What to write where a key is missing, for keys that beginners leave out."""

    @classmethod
    def keys(cls) -> dict[str, str]:
        """Field of each key, the key as the file spells it."""
        return {field.alias or name: name for name, field in cls.model_fields.items()}

    @classmethod
    def keys_below(cls) -> dict[str, str]:
        """Path of each key of the tables below, as "constraints.size"; none of a key that several tables have."""
        paths: dict[str, list[str]] = {}
        for key, name in cls.keys().items():
            annotation = cls.model_fields[name].annotation
            # of a table, and of one that may be left out; entries of lists have names or numbers before their keys
            optional = get_args(annotation) if get_origin(annotation) in (Union, UnionType) else ()
            for part in (annotation, *optional):
                if isinstance(part, type) and issubclass(part, DescriptionPart):
                    for inner in dict(part.keys()):
                        paths.setdefault(inner, []).append(f"{key}.{inner}")
        return {key: found[0] for key, found in paths.items() if len(found) == 1}

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given; a part adds its own rules."""
        keys = cls.keys()
        unknown = unknown_keys(given, keys, cls.model_fields, cls.keys_below)
        missing = [
            missing_key(key, _(cls.repairs.get(key, "")))
            for key, name in keys.items()
            if cls.model_fields[name].is_required() and key not in given and name not in given
        ]
        return unknown + missing

    @model_validator(mode="before")
    @classmethod
    def _keys_known(cls, data: Any) -> Any:
        if isinstance(data, cls):
            return data
        if not isinstance(data, Mapping):
            raise Problem(_("expected a table, got {value}").format(value=value_text(data)))
        problems = cls.key_problems(data)
        if problems:
            raise Problems(problems)
        return dict(data)


def unknown_keys(
    given: Mapping[str, Any],
    keys: Collection[str],
    names: Collection[str] = (),
    below: Callable[[], Mapping[str, str]] = dict,
) -> list[Problem]:
    """The problems of keys that are neither in `keys`, as files spell them, nor in `names`, as Python does.

    `below` gives the paths of keys of the tables below, to which a key may belong; most descriptions need none.
    """
    unknown = [key for key in given if key not in keys and key not in names]
    paths = below() if unknown else {}
    return [
        Problem(
            _("unknown key {key}").format(key=value_text(key)),
            _("did you mean {name}?").format(name=paths[key]) if key in paths else nearest(str(key), keys),
        )
        for key in islice(unknown, PROBLEMS_SOUGHT)
    ]


def missing_key(key: str, repair: str = "") -> Problem:
    """The problem of a key that has to be given."""
    return Problem(_("{key} is missing").format(key=value_text(key)), repair)


def one_of(given: Mapping[str, Any], keys: tuple[str, ...]) -> list[Problem]:
    """The problem, if any, of not giving exactly one of `keys`."""
    names = [key for key in keys if given.get(key) is not None]
    if len(names) == 1:
        return []
    words = ", ".join(keys)
    if not names:
        return [Problem(_("one of {keys} is missing").format(keys=words))]
    return [Problem(_("{names} are given together").format(names=", ".join(names)), _("keep one of them"))]


def at_most_one_of(given: Mapping[str, Any], keys: tuple[str, ...]) -> list[Problem]:
    """The problem, if any, of giving more than one of `keys`."""
    return one_of(given, keys) if any(given.get(key) is not None for key in keys) else []


# Words, lists and tables in a description, of bounded sizes.


Word = TypeVar("Word", bound=str)


def read_choice(
    value: object, options: Sequence[Word], other_names: Mapping[str, Word] | None = None
) -> Word:
    """One of a few words; raises Problem for anything else, `other_names` are those that the error knows as well."""
    for option in options:
        if isinstance(value, str) and value == option:
            return option
    words = ", ".join(value_text(option) for option in options)
    repair = ""
    if isinstance(value, str):
        typed = value.strip().casefold()
        spoken = {_(option).casefold(): option for option in options}  # as results print them
        meant = (other_names or {}).get(typed) or spoken.get(typed)
        repair = likely(meant or value, options)
    raise Problem(
        _("expected one of {words}, got {value}").format(words=words, value=value_text(value)), repair
    )


def choice(*options: str, other_names: Mapping[str, str] | None = None) -> BeforeValidator:
    """One of a few words."""
    return BeforeValidator(lambda value: read_choice(value, options, other_names))


def entries(value: object, most: int) -> tuple[object, ...]:
    """The entries of a list, at most `most`."""
    if not isinstance(value, list | tuple):
        repair = _("write each entry below a [[...]] heading, or values in [...]")
        raise Problem(_("expected a list, got {value}").format(value=value_text(value)), repair)
    _check_count(len(value), most)
    return tuple(value)


def bounded_list(most: int) -> BeforeValidator:
    """A list of at most `most` entries, kept as a tuple."""
    return BeforeValidator(lambda value: entries(value, most))


def named_entries(value: object, read_key: Callable[[object], str], most: int) -> dict[str, Any]:
    """The entries of a table, at most `most`; the names are read first, so that no two become one."""
    if not isinstance(value, Mapping):
        raise Problem(_("expected a table, got {value}").format(value=value_text(value)))
    _check_count(len(value), most)
    named: dict[str, Any] = {}
    wrong: list[Problem] = []
    for key, entry in value.items():
        try:
            name = read_key(key)
        except Problem as problem:
            wrong.append(problem)
            continue
        if name in named:
            wrong.append(
                Problem(_("{name} is named twice").format(name=value_text(name)), _("rename one of them"))
            )
        named[name] = entry
    if wrong:
        raise Problems(wrong)
    return named


def entries_by_path(
    value: Mapping[Any, Any], above: str = "", depth: int = 1
) -> Iterator[tuple[str, object]]:
    """Entries of tables within tables by their dotted paths: TOML reads links.DB.length as three tables."""
    for key, entry in value.items():
        path = f"{above}.{key}" if above else str(key)
        if isinstance(entry, Mapping) and depth < NESTING:
            yield from entries_by_path(entry, path, depth + 1)
        else:
            yield path, entry


def _check_count(count: int, most: int) -> None:
    if count > most:
        what = _("at most {most} entries are allowed, got {count}")
        raise Problem(what.format(most=most, count=count))


def table(read_key: Callable[[object], str], most: int) -> BeforeValidator:
    """A table of at most `most` named entries."""
    return BeforeValidator(lambda value: named_entries(value, read_key, most))


# Names of points, links and guides: what one may look like, and when a link's name is made of two points.

FRAME = "frame"
"""The fixed link's name wherever a link is named."""

PLACED = "placed"

# Primes may stand in a name (B'), other quotes would have to be escaped in files, tables and drawings.
_REFUSED = set('/\\,"`´“”„«»')
_POINT = r"[^\W\d_]\d*['’′]*"
_TWO_POINTS = re.compile(rf"({_POINT})({_POINT})")


def read_flag(value: object) -> bool:
    """True or false."""
    if not isinstance(value, bool):
        raise Problem(_("expected true or false, got {value}").format(value=value_text(value)))
    return value


def read_name(value: object) -> str:
    """A name in composed form (NFC); a Problem if it cannot stand in a file, a table and a drawing."""
    if not isinstance(value, str):
        raise Problem(_("expected a name (text), got {value}").format(value=value_text(value)))
    if len(value) > NAME_LENGTH:
        what = _("a name has at most {most} characters, got {count}")
        raise Problem(what.format(most=NAME_LENGTH, count=len(value)), _("shorten it"))
    name = unicodedata.normalize("NFC", value)
    repair = _("use letters, digits, primes, spaces, hyphens or underscores")
    if not name or name != name.strip():
        raise Problem(_("{name} is not a name").format(name=value_text(value)), repair)
    if not name.isprintable() or name.startswith(".") or _REFUSED & set(name):
        raise Problem(_("{name} has characters a name may not have").format(name=value_text(value)), repair)
    if name == PLACED:
        raise Problem(
            _('"placed" cannot be a name: it means that the point is placed along the chain'),
            _("choose another name"),
        )
    return name


def read_link_name(value: object) -> str:
    """A link's name: any name but the fixed link's."""
    name = read_name(value)
    if name == FRAME:
        repair = _("choose another name, or put its points in [frame.points]")
        raise Problem(_('"frame" is the fixed link, a moving link has another name'), repair)
    return name


def two_points(name: str) -> tuple[str, str] | None:
    """Points of a link's name that is made of two: O1A -> (O1, A), AB' -> (A, B'); None for other names."""
    match = _TWO_POINTS.fullmatch(name)
    if not match or match.group(1) == match.group(2):
        return None
    return match.group(1), match.group(2)


def body_word(name: str) -> str:
    """A link by its name, the frame by its word in the reader's language."""
    return _("frame") if name == FRAME else name


# A mapping that cannot change.

K = TypeVar("K")
V_co = TypeVar("V_co", covariant=True)


class FrozenMap(Mapping[K, V_co]):
    """A mapping that cannot change, keeps its order, equals a dict of the same items and can be hashed."""

    __slots__ = ("_items",)

    def __init__(self, items: Mapping[K, V_co]) -> None:
        self._items = dict(items)

    def __getitem__(self, key: K) -> V_co:
        return self._items[key]

    def __iter__(self) -> Iterator[K]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __hash__(self) -> int:
        return hash(frozenset(self._items.items()))

    def __repr__(self) -> str:
        return repr(self._items)


AS_DICT = WrapSerializer(lambda entries, write: write(dict(entries)))
"""Serialization of a `FrozenMap`: pydantic writes a mapping of models from a dict only."""
