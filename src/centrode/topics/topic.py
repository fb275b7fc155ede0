"""A topic: what computes it, what there is to say about its result, and how a command takes its options."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias, TypeVar

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
    has_rule : without the option the first word is meant; otherwise nothing, and the computation knows what to do
    """

    name: str
    words: tuple[str, ...]
    help: str
    has_rule: bool = True


@dataclass(frozen=True)
class Written:
    """An option of a computation that takes a text or a number; nothing where it is left out.

    Attributes
    ----------
    name : of the option and of the parameter of the computation
    metavar : what is written behind it, marked for the catalogues
    help : sentence, marked for the catalogues
    kind : str, int or float
    several : it may be given more than once, and is a tuple
    """

    name: str
    metavar: str
    help: str
    kind: type[str] | type[int] | type[float] = str
    several: bool = False


@dataclass(frozen=True)
class Flag:
    """An option of a computation that is given or not."""

    name: str
    help: str


@dataclass(frozen=True)
class MotionRange:
    """The range of the motion: `--from`, `--to` and `--range`, as `start` and `stop` in SI of the computation."""


@dataclass(frozen=True)
class InstantsOption:
    """Single places in place of the range: `--at`, as often as needed, as texts `at` of the computation.

    Attributes
    ----------
    help : sentence, marked for the catalogues
    most : more of them are refused
    """

    help: str
    most: int = 100


Option: TypeAlias = Choice | Written | Flag | MotionRange | InstantsOption


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
    compute : (mechanism, samples=..., **options, instants=...) -> result
    result : class of what is computed
    view : result -> Sheet
    concerns : whether a mechanism has what the topic is about
    needs : raises InputError where a mechanism lacks what the command needs, although a document does without
    options : of the computation and the command
    chapters : of documents, in the order of the document
    arguments : options as they are written -> arguments of the computation; the same if None
    extent : (mechanism, samples, **arguments) -> samples, and turns of the drive, that a command announces
    progress : sentence that a command shows while the computation calls its `progress` with the share that is done
    ending : result -> raises where it is not whole, once it has been shown
    dark : pictures may be dark
    has_command : whether it is a command; otherwise only documents and Python have it
    after : name of the command that its own follows in the list of commands; that of the topic before it if empty
    summary : whether the command writes the scalars of the sheet as `summary.json`
    complete : parameter of the computation that is False where nothing is written: then only what is printed is needed
    add_instants : (result of a run, instants) -> result: a document goes on with what a run has computed
    may_be_incomplete : it may be left out as well where the description lacks what the computation needs
    has_instants : the computation takes the instants of a document
    may_be_left_out : a chapter that nobody has chosen and that cannot be computed is left out, with the reason
    """

    name: str
    help: str
    compute: Lazily
    result: Lazily
    view: Lazily
    concerns: Lazily
    needs: Lazily | None = None
    options: tuple[Option, ...] = ()
    chapters: tuple[ChapterOfTopic, ...] = ()
    arguments: Lazily | None = None
    extent: Lazily | None = None
    progress: str = ""
    ending: Lazily | None = None
    dark: bool = False
    has_command: bool = True
    has_instants: bool = True
    may_be_left_out: bool = False
    after: str = ""
    summary: bool = True
    complete: str = ""
    add_instants: Lazily | None = None
    may_be_incomplete: bool = False


def placed(entries: Mapping[str, Entry], added: Iterable[tuple[str, str, Entry]]) -> dict[str, Entry]:
    """Entries in their order, further ones (name, name of the one before it, entry) among them.

    One that names none before it stands behind the one that was added last, the first behind all.
    """
    order, both = list(entries), dict(entries)
    last = order[-1] if order else ""
    for name, after, entry in added:
        order.insert(order.index(after or last) + 1, name)
        both[name], last = entry, name
    return {name: both[name] for name in order}
