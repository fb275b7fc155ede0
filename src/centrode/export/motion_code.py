"""The motion of one mechanism as a source file of another language, without dependencies.

The file holds the mechanism's formulas, printed from the graph that a page computes by, and the rules of
`motion_rules`, which look for limits and change points. So positions, velocities, accelerations and the status
are functions of the drive and of the dimensions that were chosen.
"""

from __future__ import annotations

from collections.abc import Sequence

from centrode.errors import InputError, NotComputedYet
from centrode.export.code_files import source_text
from centrode.export.motion_program import traced_program
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource
from centrode.numerics.graphs import Unwritten
from centrode.numerics.source_languages import LANGUAGES


def motion_code(
    mechanism: MechanismSource,
    language: str,
    vary: Sequence[str] | None = None,
    *,
    name: str | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
) -> str:
    """A source file that computes a mechanism's motion and status from the drive and from chosen dimensions.

    Parameters
    ----------
    mechanism : Mechanism, file or name of an example
    language : "c", "python", "matlab" or "javascript"
    vary : paths of the dimensions ("links.AB.length"); without it all lengths, and the coordinates of all fixed points
    name : of the program; by default that of the mechanism
    start, stop : range of the drive [rad or m], of several drives of time [s]; that of the description by default

    Returns
    -------
    str
        The text of one file without dependencies. Statuses are those of `motion`; beyond the range they are "outside".

    Raises
    ------
    NotComputedYet
        A group that has no closed form, an operation that the language has no words for, a law of several drives that
        is none of formulas: each by its name.
    InputError
        A path that names no dimension, a language that is none of the four.

    Examples
    --------
    >>> from centrode.export.motion_code import motion_code
    >>> text = motion_code("crank-rocker", "c", ["links.AB.length"])
    >>> "int crank_rocker_at(crank_rocker *m, double drive, double speed, double acceleration)" in text
    True
    """
    if language not in LANGUAGES:
        what = _("{language} is none of the languages").format(language=language)
        raise InputError("language", what, _("choose one of: {names}").format(names=", ".join(LANGUAGES)))
    program = traced_program(mechanism, vary, name=name, start=start, stop=stop, option=f"--{language}")
    try:
        return source_text(program, LANGUAGES[language])
    except Unwritten as unwritten:
        what = _("the operation {operation} has no words in {language}")
        raise NotComputedYet(
            f"--{language}", what.format(operation=unwritten.operation, language=LANGUAGES[language].name)
        ) from None
