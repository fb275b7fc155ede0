"""A topic: what computes it, what there is to say about its result, and how a command takes its options."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, TypeVar

Entry = TypeVar("Entry")


@dataclass(frozen=True)
class Lazily:
    """A function by its module and name, loaded at the first call: a command loads its own topic alone."""

    module: str
    name: str

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        """Call the function."""
        return self.load()(*arguments, **options)

    def load(self) -> Callable[..., Any]:
        """The function itself."""
        function: Callable[..., Any] = getattr(importlib.import_module(self.module), self.name)
        return function


@dataclass(frozen=True)
class Choice:
    """An option of a computation that takes one of a few words.

    Attributes
    ----------
    name : of the option and of the parameter of the computation
    words : what it may be, the rule first
    help : sentence, marked for the catalogues
    """

    name: str
    words: tuple[str, ...]
    help: str


class OptionKind(Enum):
    """What a user writes behind an option."""

    FLAG = "nothing"
    WORD = "a text, read by the computation"
    WORDS = "texts, the option once for each"
    COUNT = "a whole number"
    NUMBER = "a number"
    PAIRS = "NAME=VALUE, the option once for each"
    RANGES = "NAME=FIRST:LAST, the option once for each"
    INSTANT = "a value of the drive, or a time"


@dataclass(frozen=True)
class Option:
    """An option of a computation; one that is left out leaves the parameter to the computation.

    Attributes
    ----------
    name : of the option
    kind : what it takes
    help : sentence, marked for the catalogues
    value : how `--help` names what it takes, marked for the catalogues
    parameter : of the computation; the name of the option if empty
    """

    name: str
    kind: OptionKind
    help: str
    value: str | None = None
    parameter: str = ""


@dataclass(frozen=True)
class ChapterOfTopic:
    """A chapter of documents.

    Attributes
    ----------
    name : of the chapter
    title : marked for the catalogues
    after : name of the chapter that it follows; that of the topics before it if empty
    """

    name: str
    title: str
    after: str = ""


@dataclass(frozen=True)
class Topic:
    """One analysis of a mechanism.

    Attributes
    ----------
    name : of the command
    help : what the command does, marked for the catalogues
    compute : (mechanism, samples, **options, instants=...) -> result
    result : class of what is computed
    view : result -> Sheet
    concerns : whether a mechanism has what the topic is about; None where every mechanism may
    needs : raises InputError where a mechanism lacks what the command needs, although a document does without
    options : of the computation and the command
    chapters : of documents, in the order of the document
    after : name of the command that its own follows in the list of commands; that of the topic before it if empty
    folder : what ends the name of the folder that the command always writes into; if empty it writes where `--out` says
    files : kinds of the one file that `--out` names ("json", "csv"); if empty it names a folder
    samples : whether the computation takes a number of samples
    pictures : whether the command draws
    dark : whether it draws on a dark ground as well
    instants : whether a document computes it at its instants
    in_documents : parameters of the computation in documents
    missing_says : whether a chapter that cannot be computed, and that nobody has chosen, is there and says why
    """

    name: str
    help: str
    compute: Lazily
    result: Lazily
    view: Lazily
    concerns: Lazily | None
    needs: Lazily | None = None
    options: tuple[Choice | Option, ...] = ()
    chapters: tuple[ChapterOfTopic, ...] = ()
    after: str = ""
    folder: str = ""
    files: tuple[str, ...] = ()
    samples: bool = True
    pictures: bool = True
    dark: bool = False
    instants: bool = True
    in_documents: Mapping[str, Any] = field(default_factory=dict)
    missing_says: bool = True


def placed(entries: Mapping[str, Entry], added: Iterable[tuple[str, str, Entry]]) -> dict[str, Entry]:
    """Entries in their order, further ones (name, name of the one before it, entry) among them.

    One that names none before it stands behind the one that was added last, the first behind all.
    """
    both, order = dict(entries), list(entries)
    last = order[-1]
    for name, after, entry in added:
        order.insert(order.index(after or last) + 1, name)
        both[name], last = entry, name
    return {name: both[name] for name in order}
