"""A report from a description: its chapters one after the other, each standing for itself."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace
from typing import Literal, TypeAlias

import lazy_loader

from centrode.errors import CentrodeError
from centrode.locale import _, chosen_language, mark, speaking
from centrode.model.examples.catalogue import files_of
from centrode.model.mechanism import Mechanism
from centrode.model.settings import ChapterText
from centrode.render.document.blocks import ChapterBlocks, DescriptionText, Report, SectionBlocks
from centrode.render.document.captions import caption_blocks, number_blocks, refer_to_captions
from centrode.report.chapters import CHAPTERS, Kind
from centrode.report.checks import gather_checks
from centrode.report.files import lacking
from centrode.report.note import CONCLUSIONS, as_note, standard_of, with_capital_heads
from centrode.report.opening_pictures import move_players, opening_of
from centrode.report.study import ReportOptions, ReportStudy, Subject, settle_options
from centrode.report.subjects import ReportedSource, reported_subject
from centrode.synthesis.requests import SynthesisTask
from centrode.version import __version__

_prose = functools.partial(lazy_loader.load, "centrode.report.prose", suppress_warning=True)

TITLES: Mapping[Subject, str] = {
    "mechanism": mark("Mechanism"),
    "cam": mark("Mechanism"),
    "gear pair": mark("Gear pair"),
    "gear train": mark("Gear train"),
    "request": mark("Synthesis"),
}
"""Of a description without a title."""
Said: TypeAlias = Callable[[str, int, int], None]
"""Is told the title of the chapter that begins, how many are done, and how many there are."""


def report(
    description: ReportedSource,
    options: ReportOptions | None = None,
    *,
    at: Sequence[float | str] | float | str | None = None,
    language: str | None = None,
    name: str = "",
    said: Said | None = None,
) -> Report:
    """A document about a mechanism, a cam, gears or a synthesis, from its data to its forces, as chapters of blocks.

    Parameters
    ----------
    description : Mechanism, Cam, PlateCam, GearPair, GearTrain or SynthesisTask
    options : ReportOptions, optional
        Go before the wishes of the description.
    at : values of the drive [rad or m; s with several drives], angles of a cam, or texts with a unit ("120 deg")
        Instants of tables, diagrams and forces, in place of those of `options`.
    language : "en", "ru" or "uk", optional
        The language spoken at the moment by default.
    name : str
        The title where the description has none.
    said : function, optional
        Called before each chapter with its title, the number done and the number of all.

    Returns
    -------
    Report
        A chapter that cannot be made says why in its place; those with nothing to tell are omitted.

    Raises
    ------
    InputError
        The mechanism does not assemble, or the options name what is not there.

    Examples
    --------
    >>> import centrode as ct
    >>> chosen = ct.ReportOptions(chapters=("structure",))
    >>> made = ct.report(ct.example("crank-rocker"), chosen)
    >>> [chapter.name for chapter in made.chapters]
    ['structure']
    """
    description = reported_subject(description)
    options = options or ReportOptions()
    if at is not None:
        options = replace(options, instants=at)
    with nullcontext() if language is None else speaking(language):
        study = ReportStudy(description, settle_options(description, options, CHAPTERS))
        return report_of_study(study, name, said)


def report_of_study(study: ReportStudy, name: str = "", said: Said | None = None) -> Report:
    """The report of a study, in the language that is spoken; what the study has computed is not computed again."""
    study.assemble()
    note, standard = study.description.report, study.wishes.standard
    is_note = note.is_note or standard in ("gost", "dstu")
    wanted = {key: kind for key, kind in CHAPTERS.items() if _is_wanted(key, study, is_note)}
    chapters = tuple(_chapters(wanted, study, said))
    opening = opening_of(study, chapters)
    if not study.wishes.full:
        opening, chapters = move_players(opening, gather_checks(chapters))
    title = _(study.description.title) or name or _(TITLES[study.subject])
    subtitle = _("Computed by centrode {version}").format(version=__version__)
    language = chosen_language()
    made = Report(title, subtitle, language, caption_blocks(chapters), opening, _description_text(study))
    made = refer_to_captions(number_blocks(made))
    if is_note:
        made = as_note(made, note, functools.partial(_prose_sections, place="before"))
    settled = standard_of(standard, is_note, language)
    return replace(made if settled == "plain" else with_capital_heads(made), standard=settled)


def _is_wanted(key: str, study: ReportStudy, is_note: bool) -> bool:
    """Whether a chapter belongs to the report: conclusions end a note, or are named."""
    named = study.wishes.chapters is not None and key in study.wishes.chapters
    return named or is_note if key == CONCLUSIONS else study.wants(key)


def _description_text(study: ReportStudy) -> DescriptionText | None:
    """The description as a file, with the instants of the report; None of a request, whose targets lie beside it."""
    description, instants = study.description, study.wishes.instants
    if isinstance(description, SynthesisTask):
        return None
    text = files_of(description).text(description)
    if not isinstance(description, Mechanism):
        return DescriptionText(text, "cam" if study.is_cam else description.kind, instants)
    parameter = description.motion_parameter
    uniform = parameter.is_uniform and len(description.drives) == 1
    start = parameter.drives[0].value_of(description.drives[0].start or 0.0) if uniform else 0.0
    return DescriptionText(text, "mechanism", instants or (start,))


def _chapters(wanted: Mapping[str, Kind], study: ReportStudy, said: Said | None) -> Iterator[ChapterBlocks]:
    for done, (key, kind) in enumerate(wanted.items()):
        if said is not None:
            said(_(kind.title), done, len(wanted))
        chapter = _chapter(key, kind, study)
        if chapter is not None and not (
            _fails(chapter) and study.moves_freely and study.wishes.chapters is None
        ):
            yield _with_text(chapter, study.description.report.text.get(key))


def _fails(chapter: ChapterBlocks) -> bool:
    """Whether a chapter only says why it is not there, as those of kinematics do of what no drive moves."""
    return bool(chapter.missing) or not chapter.computed


def _with_text(chapter: ChapterBlocks, text: ChapterText | None) -> ChapterBlocks:
    """A chapter between what its author writes before and after it."""
    if text is None:
        return chapter
    before, after = (
        _prose_sections(text.before, "before"),
        _prose_sections(text.after, "after"),
    )
    return replace(chapter, sections=(*before, *chapter.sections, *after))


def _prose_sections(markdown: str, place: Literal["before", "after"]) -> tuple[SectionBlocks, ...]:
    """Sections of a text; InputError where the library that reads it is missing."""
    try:
        return tuple(_prose().prose_sections(markdown, place)) if markdown else ()
    except ModuleNotFoundError as missing:
        raise lacking((missing.name or "").partition(".")[0]) from missing


def _chapter(key: str, kind: Kind, study: ReportStudy) -> ChapterBlocks | None:
    """A chapter; with the reason in its place where it cannot be made, or has nothing to tell but was asked for."""
    try:
        chapter = kind.make(study)
    except CentrodeError as failure:
        return ChapterBlocks(key, _(kind.title), missing=str(failure))
    if chapter is None and key in (study.wishes.chapters or ()):
        return ChapterBlocks(key, _(kind.title), missing=_("the description has nothing for this chapter"))
    return chapter
