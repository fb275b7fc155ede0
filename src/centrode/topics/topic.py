"""A topic: what computes it, what there is to say about its result, and how a command takes its options."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any, TypeAlias


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
class Given:
    """An option of a computation whose value is a text of the user.

    Attributes
    ----------
    name : of the option
    parameter : of the computation; without a value the computation decides
    metavar, help : sentences, marked for the catalogues
    read : (mechanism, text, "--name") -> value; raises InputError. The text itself if None
    several : may be said as often as needed; the values come as a list
    required : the command does not begin without it
    """

    name: str
    parameter: str
    metavar: str
    help: str
    read: Lazily | None = None
    several: bool = False
    required: bool = False


Option: TypeAlias = Choice | Given


class OutFolder(Enum):
    """What a command does with its folder: asked for, with or without a summary, or always written."""

    WITH_NUMBERS = "with numbers"
    ON_REQUEST = "on request"
    ALWAYS = "always"


@dataclass(frozen=True)
class ChapterOfTopic:
    """A chapter of documents.

    Attributes
    ----------
    name : of the chapter
    title : marked for the catalogues
    after : name of the chapter that it stands behind; the end if empty
    concerns : whether a mechanism has what the chapter is about; as of the topic if None
    """

    name: str
    title: str
    after: str = ""
    concerns: Lazily | None = None


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
    concerns : whether a mechanism has what the topic is about; every one has if None
    needs : (mechanism, **options) raises InputError where the command needs more, although a document does without
    options : of the computation and the command
    chapters : of documents, in the order of the document
    samples : whether the computation takes a number of samples
    ranged : whether it takes `start` and `stop`, and the range of the description may be replaced
    shortfall : raises MotionError about what the result lacks; the rest is shown before
    animation : (result, file, dark) writes an animation
    animation_help : what the animation shows, marked for the catalogues
    dark : whether pictures can be asked for on a dark ground
    out : what is written
    after : name of the command that it is listed behind; the end of the registry's commands if empty
    """

    name: str
    help: str
    compute: Lazily
    result: Lazily
    view: Lazily
    concerns: Lazily | None = None
    needs: Lazily | None = None
    options: tuple[Option, ...] = ()
    chapters: tuple[ChapterOfTopic, ...] = ()
    samples: bool = True
    ranged: bool = False
    shortfall: Lazily | None = None
    animation: Lazily | None = None
    animation_help: str = ""
    dark: bool = False
    out: OutFolder = OutFolder.WITH_NUMBERS
    after: str = ""
