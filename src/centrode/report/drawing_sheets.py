"""The sheets of drawings of a mechanism: what can be drawn of it, computed and put on sheets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from centrode.analysis.graphic.results import graphic_analysis
from centrode.analysis.position_plan import SAMPLES, USUAL, check_positions, plan_of_positions
from centrode.cams.followers.base_circle import follower_cam, has_size
from centrode.cams.profiles import roller_path_of
from centrode.dynamics.force_polygons.results import force_polygon_results, has_force_polygons
from centrode.dynamics.kinetostatics.reactions import motion_of_forces
from centrode.dynamics.steady_motion.machine import is_machine, machine_results
from centrode.errors import CentrodeError, InputError
from centrode.gears.results import gear_pair
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.cam_files import has_follower, require_curvature_cam, with_follower
from centrode.model.examples.catalogue import description_of
from centrode.model.explanatory_note import TitlePage
from centrode.model.gear_pairs import GearPair
from centrode.model.mechanism import Mechanism
from centrode.model.reading import FRAME
from centrode.scenes.driving_cams import driving_body
from centrode.sheets.drawing_sheets import DrawingSet, TitleBlock
from centrode.views.cam_sheets import cam_sheet, driving_cam_sheet
from centrode.views.drawing_sheets import diagram_sheet, energy_sheet, force_sheets, motion_sheets
from centrode.views.gear_sheets import gear_sheet
from centrode.views.path_sheets import path_sheet

if TYPE_CHECKING:
    from centrode.model.cam_files import AnyCam
    from centrode.model.examples.catalogue import DescriptionSource
    from centrode.sheets.drawing_sheets import DrawingSheet

SHORT = 60
"""Most letters of a mechanism's own title in a title block."""


def drawing_sheets(
    description: DescriptionSource | GearPair,
    *,
    instants: Sequence[float | str] | float | str = (),
    positions: int = USUAL,
    link: str | None = None,
) -> DrawingSet:
    """Sheets A1 of a mechanism: its motion; where they are described, its cams, machine and forces; or of a cam.

    Of a mechanism on the sphere they show the diagrams of its output and of its machine; `absent` names the drawings
    that are of the plane. Of a cam one sheet shows the synthesis, of a pair of gears teeth, generation and sliding.

    Parameters
    ----------
    description : Mechanism, PlateCam, Cam or GearPair, or the name of its file or of a built-in one
    instants : values of the drive [rad or m], times [s], or texts with a unit, at which plans of vectors and forces
        are drawn; those of the study by default, else the initial position
    positions, link : as of `plan_of_positions`; of a cam about so many positions stand on its rises and returns

    Raises
    ------
    InputError, MotionError
        As `plan_of_positions`; on the sphere, a link that does not turn about a hinge of the frame; as `follower_cam`;
        of a cam instants or a link.

    Examples
    --------
    >>> import centrode as ct
    >>> from centrode.report.drawing_sheets import drawing_sheets
    >>> made = drawing_sheets(ct.example("crank-rocker"))
    >>> [type(sheet).__name__ for sheet in made.sheets]
    ['MotionSheet']
    """
    if isinstance(description, GearPair):
        block = TitleBlock("", _(description.title), "", "", (), "")
        return DrawingSet(block, (gear_sheet(gear_pair(description)),))
    description = description_of(description)
    if not isinstance(description, Mechanism):
        return cam_sheets(description, instants=instants, positions=positions, link=link)
    mechanism = description
    missing: list[str] = []
    if mechanism.space == "sphere":
        drawn = tuple(_sheets_on_sphere(mechanism, link, missing))
        absent = _(
            "not drawn on the sphere: plan of positions, plans of velocities and accelerations, force polygons"
        )
        return DrawingSet(title_block(mechanism), drawn, tuple(missing), absent)
    sheets = tuple(_sheets(mechanism, instants, positions, link, missing))
    return DrawingSet(title_block(mechanism), sheets, tuple(missing))


def cam_sheets(
    cam: AnyCam,
    *,
    instants: Sequence[float | str] | float | str = (),
    positions: int = USUAL,
    link: str | None = None,
) -> DrawingSet:
    """The sheet A1 of a cam; arguments and errors are those of `drawing_sheets`."""
    if np.size(instants):
        raise InputError("instants", _("the sheet of a cam has no plans of vectors"), _("omit it"))
    if link is not None:
        raise InputError("link", _("the sheet of a cam shows the motion of its follower"), _("omit it"))
    check_positions(positions)
    if not has_follower(cam):
        curved = require_curvature_cam(cam)
        return DrawingSet(title_block(cam), (path_sheet(curved, roller_path_of(curved), positions),))
    plate = with_follower(cam)
    sheet = cam_sheet(plate, follower_cam(plate), positions)
    return DrawingSet(title_block(cam), (sheet,))


def title_block(mechanism: Mechanism | AnyCam) -> TitleBlock:
    """What the description says of its work: its title page, and its own title where the work has none."""
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
        page.course,
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
    yield from _sheets_of_driving_cams(mechanism, positions)
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


def _sheets_of_driving_cams(mechanism: Mechanism, positions: int) -> Iterator[DrawingSheet]:
    """The cams that drive, where their sizes are described."""
    for drive in mechanism.drives:
        cam = drive.cam
        if cam is not None and has_size(cam):
            sheet = cam_sheet(cam, driving_body(drive, cam), positions)
            yield driving_cam_sheet(drive, sheet, mechanism.display)


def _sheets_on_sphere(mechanism: Mechanism, link: str | None, missing: list[str]) -> Iterator[DrawingSheet]:
    """Diagrams of the output and of the machine; a reason joins `missing` for each sheet that cannot be made."""
    driven = {drive.link for drive in mechanism.drives} | {drive.guide for drive in mechanism.drives}
    course = motion(mechanism, SAMPLES)
    guides = [guide.id for guide in mechanism.guides if guide.on == FRAME]
    names = [*reversed(guides), *reversed(course["joint"].values.tolist())]
    known = [name for name in names if name not in driven]
    if link is not None and link not in names:
        what = _("{link} neither turns about a hinge of the frame nor is a guide of it").format(link=link)
        raise InputError("link", what, _("one of: {names}").format(names=", ".join(names)))
    if link is None and not known:
        missing.append(_("no link that is not driven turns about a hinge of the frame"))
    else:
        yield diagram_sheet(mechanism, course, link or known[0])
    if is_machine(mechanism):
        try:
            yield energy_sheet(machine_results(mechanism), None)
        except CentrodeError as failure:
            missing.append(str(failure))
