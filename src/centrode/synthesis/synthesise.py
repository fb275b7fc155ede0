"""Synthesis: from what one wants to mechanisms that do it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

from centrode.errors import InputError, NotComputedYet
from centrode.locale import _
from centrode.synthesis.answers import SynthesisResults
from centrode.synthesis.function_synthesis import function_answers
from centrode.synthesis.mechanism_synthesis import mechanism_answers
from centrode.synthesis.path_synthesis import path_answers
from centrode.synthesis.pose_synthesis import pose_answers
from centrode.synthesis.processes import check_jobs, processes
from centrode.synthesis.requests import FOUR_BARS, MOST_POSES, SPHERICAL, SYNTHESES, SynthesisTask
from centrode.synthesis.spherical_synthesis import spherical_answers
from centrode.synthesis.stroke_synthesis import stroke_answers

SynthesisSource: TypeAlias = SynthesisTask | str | Path | Mapping[str, Any]


def task_of(source: SynthesisSource) -> SynthesisTask:
    """The request itself, of a file, or of tables as a file's; InputError for anything else."""
    given: object = source
    if isinstance(given, SynthesisTask):
        return given
    if isinstance(given, str | Path):
        return SYNTHESES.read(given)
    if isinstance(given, Mapping):
        return SYNTHESES.from_tables(given)
    what = _("this function takes a request of a synthesis, its file or its tables")
    raise InputError("", what, _("it got a value of type {kind}").format(kind=type(source).__name__))


def is_exact(task: SynthesisTask) -> bool:
    """Whether poses are few enough to be met exactly, by dimensions that are all free."""
    wanted = task.synthesis
    return (
        len(wanted.rows) <= MOST_POSES
        and wanted.timing == "free"
        and wanted.place == "free"
        and not wanted.free
    )


def synthesise(
    source: SynthesisSource,
    progress: Callable[[float], None] = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
    jobs: int = 1,
) -> SynthesisResults:
    """Mechanisms that do what is wanted, the best first.

    Parameters
    ----------
    source : path of a TOML file with a table [synthesis], its tables, or what `read_synthesis` made of them
    progress : called with the share that is done
    stop : once it is true the search ends with what there is
    jobs : processes on which paths, poses in the least squares sense and mechanisms of files are searched; the answers
        are those of one

    Returns
    -------
    SynthesisResults
        `answers` have a description each, with their error, least transmission angle, size and defects. The same
        request gives the same answers.

    Raises
    ------
    InputError
        What is wanted contradicts itself, or the file is wrong.
    MotionError
        Nothing was found.

    Examples
    --------
    >>> import centrode as ct
    >>> wanted = {"topology": "crank-rocker", "kind": "function", "formula": "log(x)/log(10)", "x": [1, 2],
    ...           "swings": ["60 deg", "90 deg"]}
    >>> found = ct.synthesise({"synthesis": wanted})
    >>> bool(found.answers[0].greatest < 1e-3)
    True
    """
    task = task_of(source)
    wanted = task.synthesis
    check_jobs(jobs)
    if task.mechanism is not None:
        with processes(jobs) as several:
            return mechanism_answers(task, progress, stop, several)
    if wanted.kind == "motion" and wanted.topology in FOUR_BARS and is_exact(task):
        return pose_answers(task, progress, stop)
    if wanted.kind in ("path", "motion") and wanted.topology in FOUR_BARS:
        with processes(jobs) as several:
            return path_answers(task, progress, stop, several)
    if wanted.topology in SPHERICAL and wanted.kind != "strokes":
        with processes(1 if wanted.kind == "function" else jobs) as several:
            return spherical_answers(task, progress, stop, several)
    if wanted.kind == "strokes":
        return stroke_answers(task)
    if wanted.kind == "function" and wanted.topology in FOUR_BARS:
        return function_answers(task, progress, stop)
    raise NotComputedYet(
        "[synthesis] topology",
        _("this kind is not synthesised for this topology"),
        _("one of {names}, or links described beside [synthesis]").format(
            names=", ".join((*FOUR_BARS, *SPHERICAL))
        ),
    )
