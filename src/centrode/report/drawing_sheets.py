"""The sheets of drawings of a mechanism: what can be drawn of it, computed and put on sheets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from centrode.analysis.graphic.results import graphic_analysis
from centrode.analysis.position_plan import USUAL, plan_of_positions
from centrode.dynamics.force_polygons.results import force_polygon_results, has_force_polygons
from centrode.dynamics.kinetostatics.reactions import motion_of_forces
from centrode.dynamics.steady_motion.machine import is_machine, machine_results
from centrode.errors import CentrodeError, NotComputedYet
from centrode.locale import _
from centrode.model.examples.catalogue import mechanism_of
from centrode.model.explanatory_note import TitlePage
from centrode.sheets.drawing_sheets import DrawingSet, TitleBlock
from centrode.views.drawing_sheets import energy_sheet, force_sheets, motion_sheets

if TYPE_CHECKING:
    from centrode.model.examples.catalogue import MechanismSource
    from centrode.model.mechanism import Mechanism
    from centrode.sheets.drawing_sheets import DrawingSheet

SHORT = 60
"""Most letters of a mechanism's own title in a title block."""


def drawing_sheets(
    mechanism: MechanismSource,
    *,
    instants: Sequence[float | str] | float | str = (),
    positions: int = USUAL,
    link: str | None = None,
) -> DrawingSet:
    """Sheets A1 of a planar mechanism: its motion; where they are described, its machine and its forces.

    Parameters
    ----------
    instants : values of the drive [rad or m], times [s], or texts with a unit, at which plans of vectors and forces
        are drawn; those of the study by default, else the initial position
    positions, link : as of `plan_of_positions`

    Raises
    ------
    NotComputedYet
        Spherical linkages.
    InputError, MotionError
        As `plan_of_positions`.

    Examples
    --------
    >>> import centrode as ct
    >>> from centrode.report.drawing_sheets import drawing_sheets
    >>> made = drawing_sheets(ct.example("crank-rocker"))
    >>> [type(sheet).__name__ for sheet in made.sheets]
    ['MotionSheet']
    """
    mechanism = mechanism_of(mechanism)
    if mechanism.space == "sphere":
        what = _("sheets of drawings are made of planar mechanisms")
        raise NotComputedYet("space", what, _("use the pictures of centrode run"))
    missing: list[str] = []
    sheets = tuple(_sheets(mechanism, instants, positions, link, missing))
    return DrawingSet(title_block(mechanism), sheets, tuple(missing))


def title_block(mechanism: Mechanism) -> TitleBlock:
    """What the description says of its work: its title page, and the mechanism's title where the work has none."""
    page = mechanism.report.title_page or TitlePage()
    organisation = (
        page.institution,
        page.department,
        ", ".join(filter(None, (page.group, str(page.year or "")))),
    )
    return TitleBlock(
        page.designation or page.variant,
        page.title or _(mechanism.title),
        page.author,
        page.teacher,
        tuple(filter(None, organisation)),
    )


def _sheets(
    mechanism: Mechanism,
    instants: Sequence[float | str] | float | str,
    positions: int,
    link: str | None,
    missing: list[str],
) -> Iterator[DrawingSheet]:
    """The sheets; a reason joins `missing` for each that cannot be made."""
    plan = plan_of_positions(mechanism, positions, link)
    drawn = graphic_analysis(mechanism, instants=instants, incomplete=True)
    missing += [str(check) for check in drawn.checks if isinstance(check, CentrodeError)]
    yield from motion_sheets(plan, drawn)
    if is_machine(mechanism):
        try:
            yield energy_sheet(machine_results(mechanism), plan)
        except CentrodeError as failure:
            missing.append(str(failure))
    if has_force_polygons(mechanism):
        places = mechanism.motion_parameter.instant.read_all(instants, "instants")
        try:
            forces = force_polygon_results(
                mechanism, motion=motion_of_forces(mechanism), instants=tuple(places) or None, complete=False
            )
        except CentrodeError as failure:
            missing.append(str(failure))
        else:
            yield from force_sheets(forces)
