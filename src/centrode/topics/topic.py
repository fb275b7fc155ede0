"""A topic: what computes it, what there is to say about its result, and how a command takes its options."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal


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


@dataclass(frozen=True)
class ChapterOfTopic:
    """A chapter of documents: its name, and its title marked for the catalogues."""

    name: str
    title: str


@dataclass(frozen=True)
class Topic:
    """One analysis of a mechanism or of a cam.

    Attributes
    ----------
    name : of the command
    help : what the command does, marked for the catalogues
    compute : (mechanism or cam, samples, **options, instants=...) -> result
    result : class of what is computed
    view : result -> Sheet
    concerns : whether a mechanism has what the topic is about
    needs : raises InputError where a mechanism lacks what the command needs, although a document does without
    options : of the computation and the command
    chapters : of documents, in the order of the document
    subject : "mechanism", or "cam": those of cams have one command together
    flag : option of that command without which it leaves the topic out
    """

    name: str
    help: str
    compute: Lazily
    result: Lazily
    view: Lazily
    concerns: Lazily
    needs: Lazily | None = None
    options: tuple[Choice, ...] = ()
    chapters: tuple[ChapterOfTopic, ...] = ()
    subject: Literal["mechanism", "cam"] = "mechanism"
    flag: str = ""
