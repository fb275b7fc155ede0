"""A topic: what computes it, what there is to say about its result, its command and its chapters."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias


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


# Options of commands. One that is left out leaves the parameter to the computation.


@dataclass(frozen=True)
class ChoiceOption:
    """An option that takes one of a few words.

    Attributes
    ----------
    name : of the option and of the parameter of the computation
    words : what it may be, the default first
    help : sentence, marked for the catalogues
    has_default : without the option the first word is meant; otherwise the computation decides
    """

    name: str
    words: tuple[str, ...]
    help: str
    has_default: bool = True


@dataclass(frozen=True)
class ValueOption:
    """An option that takes a text or a number.

    Attributes
    ----------
    name : of the option
    metavar : what is written behind it, marked for the catalogues
    help : sentence, marked for the catalogues
    kind : str, int or float
    several : may be given more than once; the value is a tuple
    required : the command does not begin without it
    parameter : of the computation; the name of the option if empty
    read : (mechanism, value, "--name") -> argument of the computation, raises InputError; the value itself if None
    """

    name: str
    metavar: str | None
    help: str
    kind: type[str] | type[int] | type[float] = str
    several: bool = False
    required: bool = False
    parameter: str = ""
    read: Lazily | None = None


@dataclass(frozen=True)
class FlagOption:
    """An option that is given or not."""

    name: str
    help: str


@dataclass(frozen=True)
class RangeOptions:
    """The range of the motion: `--from`, `--to` and `--range`, as `start` and `stop` in SI of the computation.

    Attributes
    ----------
    echoed : say the ends as they were read; not where the facts of the result name the range
    """

    echoed: bool = True


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


@dataclass(frozen=True)
class NumbersOption:
    """Numbers in place of the description's own: `--set PATH=VALUE`, any number of times."""


Option: TypeAlias = ChoiceOption | ValueOption | FlagOption | RangeOptions | InstantsOption | NumbersOption


@dataclass(frozen=True)
class Command:
    """How the command of a topic takes its options, and what it writes.

    Attributes
    ----------
    help : what the command does, marked for the catalogues; of a cam's topic empty
    options : in the order of `--help`
    needs : (mechanism, **arguments) raises InputError where the command needs more, although a document does without
    arguments : options as they are written -> arguments of the computation; the same if None
    samples : whether the computation takes a number of samples
    extent : (mechanism, samples, **arguments) -> samples, and turns of the drive, that the command announces
    progress : sentence that is shown while the computation calls its `progress` with the share that is done
    complete : parameter of the computation that is False where nothing is written: then only what is printed is needed
    ending : result -> raises where it is not whole, once it has been shown
    folder : what ends the name of the folder that is always written; if empty `--out` names a folder where it is given
    kinds : of the one file that `--out` names in place of a folder ("json", "csv", or that of a further file of the
        sheet); none where it names a folder
    pages : of the one file that `--out` names, in which the page stands that is printed otherwise ("txt", "tex", "md")
    summary : whether the scalars of the sheet are written as `summary.json`
    pictures, dark : whether it draws, and on a dark ground as well
    animation : (result, file, dark) writes an animation, with `--animate`
    animation_file : its name, that of the topic as a GIF if empty
    animation_help : what the animation shows, marked for the catalogues
    file_help : what the one file holds, marked for the catalogues; JSON or CSV if empty
    prints_only : it writes no files
    default_instants : without `--at` it takes the instants of the study, else the initial position, and says so
    """

    help: str
    options: tuple[Option, ...] = ()
    needs: Lazily | None = None
    arguments: Lazily | None = None
    samples: bool = True
    extent: Lazily | None = None
    progress: str = ""
    complete: str = ""
    ending: Lazily | None = None
    folder: str = ""
    kinds: tuple[str, ...] = ()
    pages: tuple[str, ...] = ()
    summary: bool = True
    pictures: bool = True
    dark: bool = False
    animation: Lazily | None = None
    animation_file: str = ""
    animation_help: str = ""
    file_help: str = ""
    prints_only: bool = False
    default_instants: bool = False


@dataclass(frozen=True)
class ChapterOfTopic:
    """A chapter of documents.

    Attributes
    ----------
    name : of the chapter
    title : marked for the catalogues
    concerns : whether a mechanism has what the chapter is about; as of the topic if None
    code : what computes and shows it in a notebook, by public functions, from `mechanism` (or `cam`) at `instants`;
        if empty, the notebook shows the chapter as a page
    """

    name: str
    title: str
    concerns: Lazily | None = None
    code: str = ""


@dataclass(frozen=True)
class InDocuments:
    """How a document computes a topic.

    Attributes
    ----------
    chapters : in the order of the document
    arguments : of the computation
    chosen_arguments : further ones where somebody has chosen one of its chapters by name
    instants : whether the computation takes the instants of the document
    wished : it takes the instants that somebody wishes, none without, in place of those that a document chooses then
    motion : the computation takes the motion at which forces are computed, "mean" or "real", as the document has it
    add_instants : (result, instants=..., **arguments) -> result: a document goes on with a result that it has already
    may_be_left_out : a chapter that nobody has chosen and that cannot be computed is left out, with the reason
    may_be_incomplete : so is one whose description lacks what the computation needs
    on_request : its chapters are in a document only where somebody has chosen them by name
    points : whether the computation takes the points that the document is about
    options : parameters of the computation that somebody may wish for a document, by the names they have there
    """

    chapters: tuple[ChapterOfTopic, ...] = ()
    arguments: Mapping[str, Any] = field(default_factory=dict)
    instants: bool = True
    wished: bool = False
    motion: bool = False
    add_instants: Lazily | None = None
    may_be_left_out: bool = False
    may_be_incomplete: bool = False
    on_request: bool = False
    points: bool = False
    chosen_arguments: Mapping[str, Any] = field(default_factory=dict)
    options: tuple[str, ...] = ()


@dataclass(frozen=True)
class Panel:
    """How the workbench shows a topic.

    Attributes
    ----------
    title : marked for the catalogues; that of the first chapter if empty
    needs : what a description lacks that the topic does not concern, marked for the catalogues
    arguments : of the computation
    played : further ones with which the motion that it finds can be played
    pictures : whether its pictures are shown
    free : whether it takes descriptions with drives that have no law too
    """

    title: str = ""
    needs: str = ""
    arguments: Mapping[str, Any] = field(default_factory=dict)
    played: Mapping[str, Any] = field(default_factory=dict)
    pictures: bool = True
    free: bool = False


@dataclass(frozen=True)
class Topic:
    """One analysis of a mechanism, of a cam, or of many mechanisms of one structure.

    Attributes
    ----------
    name : of the command
    compute : (mechanism or cam, samples=..., instants=..., **arguments) -> result
    result : class of what is computed; `parts` of it, where it has some, are name -> result of another topic
    view : result -> Sheet
    concerns : whether a mechanism has what the topic is about; every one has if None
    command : None where only documents and Python have the topic
    document : its chapters
    subject : "mechanism"; "cam": those have one command together, with the options of all of them; "gear pair";
        "gear train"; "request": one of a synthesis, which mechanisms answer; "mechanisms": many of one structure, whose
        commands read a file of their own and go on with what is in a folder
    flag : option of that command without which it leaves the topic out
    restore : (mechanism or cam, dataset) -> result, of a dataset whose attribute `topic` is the name; None where the
        computation has no dataset that says everything
    value : class of what a plain function of the topic returns, which is neither a dataset nor the result; None if
        there is none. It knows its `mechanism` or its `cam`
    complete : (mechanism or cam, value) -> result
    panel : how the workbench shows it; without one it does so where the topic has a command and a chapter
    """

    name: str
    compute: Lazily
    result: Lazily
    view: Lazily
    concerns: Lazily | None = None
    command: Command | None = None
    document: InDocuments = InDocuments()
    subject: Literal["mechanism", "cam", "gear pair", "gear train", "mechanisms", "request"] = "mechanism"
    flag: str = ""
    restore: Lazily | None = None
    value: Lazily | None = None
    complete: Lazily | None = None
    panel: Panel | None = None

    @property
    def title(self) -> str:
        """What the workbench calls the topic, to be translated; empty where it does not show it."""
        if self.panel is not None and self.panel.title:
            return self.panel.title
        chapters = self.document.chapters
        shown = self.panel is not None or (self.command is not None and not self.flag)
        return chapters[0].title if chapters and shown else ""
