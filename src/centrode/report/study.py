"""What the chapters of a report are made from: results that are computed when first asked for, and once."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias, TypeVar, cast

import numpy as np
import xarray as xr

from centrode.analysis.redesign.candidates import check_greatest_change, read_least_angle
from centrode.dynamics.kinetostatics.applied_forces import MotionOfDrive, check_motion
from centrode.dynamics.kinetostatics.reactions import motion_of_forces
from centrode.dynamics.motion_results import MotionResults, instants_of, study
from centrode.dynamics.simulation.routes import moves_freely
from centrode.equations.derivation import Equations, equations
from centrode.errors import CentrodeError, InputError, Status
from centrode.kinematics.check import MechanismCheck, check
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.cam import Cam
from centrode.model.cam_files import AnyCam
from centrode.model.follower_cam import PlateCam
from centrode.model.gear_pairs import GearPair
from centrode.model.gear_trains import GearTrain
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.page_standards import STANDARDS, Standard
from centrode.model.reading import nearest, value_text
from centrode.model.settings import (
    DIGITS,
    LEAST_DIGITS,
    LEAST_ROWS,
    MOST_DIGITS,
    MOST_POSITIONS,
    MOST_RK4_STEPS,
    MOST_ROWS,
    ReportWishes,
)
from centrode.model.units import read_quantity
from centrode.quantities import status_word
from centrode.render.document.numbers import Numbers

# What a report is to hold: the wishes of the description's [report], and those of the caller, which go before
# them.

Wished = TypeVar("Wished")
Reported: TypeAlias = Mechanism | AnyCam | GearPair | GearTrain
"""What there are reports on."""
Subject: TypeAlias = Literal["mechanism", "cam", "gear pair", "gear train"]


@dataclass(frozen=True)
class ReportOptions:
    """What a report is to hold; what is None is left to the description, and else to the report.

    Attributes
    ----------
    chapters : names of chapters, in any order; all that apply if nobody chooses
    instants : values of the drive at which tables, diagrams and forces are shown [rad or m; s with a law or several],
        or texts with a unit ("120 deg")
    points : names of points whose velocities and paths are given
    digits : significant digits of numbers
    full : everything there is to show; otherwise the compact form, with the checks in one table at the end.
        Chapters that somebody has chosen are full unless this or the description says otherwise
    motion : of the forces: "real" at the real speed and acceleration of a machine in steady motion, "mean" at its mean
        speed; by default the real one where it can be computed
    standard : page style and captions, "plain", "gost" or "dstu"
    rows : of a table over the motion, at most
    positions : in the plan of positions
    rk4_steps : fixed Runge-Kutta steps, whose rows and errors the chapter on integration has as well
    angle_step : to which directions of drawings are read [rad], or a text with a unit
    least_transmission_angle : what every dyad of a repaired mechanism keeps [rad], or a text with a unit
    greatest_change : of a repair: of a length over itself, of a coordinate over the greatest length, below 1

    Examples
    --------
    >>> import centrode as ct
    >>> ct.ReportOptions(chapters=("structure", "reactions"), digits=4).digits
    4
    """

    chapters: tuple[str, ...] | None = None
    instants: Sequence[float | str] | float | str | None = None
    points: tuple[str, ...] | None = None
    digits: int | None = None
    full: bool | None = None
    motion: MotionOfDrive | None = None
    standard: Standard | None = None
    rows: int | None = None
    positions: int | None = None
    rk4_steps: int | None = None
    angle_step: float | str | None = None
    least_transmission_angle: float | str | None = None
    greatest_change: float | None = None


@dataclass(frozen=True)
class Wishes:
    """The same, settled; chapters and points are None where nobody chose, instants empty.

    `options` are name -> value of what is wished of the computation of single topics.
    """

    chapters: tuple[str, ...] | None
    instants: tuple[float, ...]
    points: tuple[str, ...] | None
    digits: int
    full: bool
    motion: MotionOfDrive | None = None
    standard: Standard | None = None
    rows: int | None = None
    options: Mapping[str, Any] = field(default_factory=dict)


def settle_options(description: Reported, options: ReportOptions, known: Iterable[str]) -> Wishes:
    """The wishes of a caller, where there are none those of the description.

    Raises InputError for a chapter that is not in `known`, for a point that the mechanism has not, for digits out of
    bounds.
    """
    asked = description.report
    points = asked.points or None if isinstance(asked, ReportWishes) else None
    chapters = _first(options.chapters, asked.chapters or None)
    full = _first(options.full, asked.full)
    found = Wishes(
        chapters,
        _instants_of(description, options.instants),
        _first(options.points, points),
        options.digits if options.digits is not None else asked.digits or DIGITS,
        chapters is not None if full is None else full,
        _first(options.motion, asked.motion if isinstance(asked, ReportWishes) else None),
        _first(options.standard, asked.standard),
        *_rows_and_options(description, options),
    )
    if found.motion is not None:
        check_motion(found.motion)
    if found.standard not in (None, *STANDARDS):
        what = _("there is no standard {name}").format(name=value_text(found.standard))
        raise InputError("standard", what, nearest(str(found.standard), list(STANDARDS)))
    where = "chapters" if options.chapters is not None else "[report] chapters"
    if found.chapters is not None and not found.chapters:
        raise InputError(where, _("no chapter is named"), nearest("", list(known)))
    _check(found.chapters, known, where, _("there is no chapter {name}"))
    _check(asked.text, known, "[report.text]", _("there is no chapter {name}"))
    names = description.points if isinstance(description, Mechanism) else ()
    _check(found.points, names, "points", _("unknown point {name}"))
    moving = description.moving_points if isinstance(description, Mechanism) else ()
    _check(found.points, moving, "points", _("point {name} does not move"))
    if not LEAST_DIGITS <= found.digits <= MOST_DIGITS:
        what = _("the number of significant digits is {least} to {most}, {digits} is given")
        said = what.format(least=LEAST_DIGITS, most=MOST_DIGITS, digits=found.digits)
        raise InputError("digits", said)
    return found


def _rows_and_options(description: Reported, options: ReportOptions) -> tuple[int | None, dict[str, Any]]:
    """Rows of tables over the motion, and what is wished of the computation of single topics."""
    asked = description.report
    if not isinstance(asked, ReportWishes):
        given = (options.rows, options.positions, options.rk4_steps, options.angle_step)
        if any(one is not None for one in given):
            raise InputError("report", _("rows, positions and steps are those of linkages"))
        if options.least_transmission_angle is not None or options.greatest_change is not None:
            raise InputError("report", _("bounds of a repair are those of linkages"))
        return None, {}
    for name, value, least, most in (
        ("rows", options.rows, LEAST_ROWS, MOST_ROWS),
        ("positions", options.positions, 2, MOST_POSITIONS),
        ("rk4_steps", options.rk4_steps, 1, MOST_RK4_STEPS),
    ):
        if value is not None and not least <= value <= most:
            what = _("{value} is not a whole number between {least} and {most}")
            raise InputError(name, what.format(value=value_text(value), least=least, most=most))
    step = options.angle_step
    if step is not None:
        refuses = description.display.refuses_bare_angles
        step = read_quantity(step, "angle", "angle_step", refuses_bare=refuses)
    check_greatest_change(options.greatest_change)
    least_angle = read_least_angle(options.least_transmission_angle, description.display)
    wished = {
        "positions": _first(options.positions, asked.positions),
        "rk4_steps": _first(options.rk4_steps, asked.rk4_steps),
        "angle_step": _first(step, asked.angle_step),
        "least_transmission_angle": _first(least_angle, asked.least_transmission_angle),
        "greatest_change": _first(options.greatest_change, asked.greatest_change),
    }
    chosen = {name: value for name, value in wished.items() if value is not None}
    return _first(options.rows, asked.rows), chosen


def instant(description: Reported, text: float | str, where: str) -> float:
    """Value of the drive, a time with a law or several drives, an angle of a cam [rad, m or s], of a number or a text.

    Raises InputError, which names `where`, for a unit of another kind.
    """
    if isinstance(description, Mechanism):
        return description.motion_parameter.instant.read(text, where)
    return read_quantity(text, "angle", where, refuses_bare=description.display.refuses_bare_angles)


def _instants(
    description: Mechanism | AnyCam, given: Sequence[float | str] | float | str | None
) -> tuple[float, ...] | None:
    """Instants in SI, of several or one alone."""
    if given is None:
        return None
    listed: Sequence[Any] = [given] if isinstance(given, str | int | float) else given
    # a number of an array is one, as no text is
    numbers = (one if isinstance(one, str) else float(one) for one in listed)
    return tuple(instant(description, one, "at") for one in numbers)


def _instants_of(
    description: Reported, given: Sequence[float | str] | float | str | None
) -> tuple[float, ...]:
    """Instants in SI, those of the description where a caller gives none; gears have none."""
    if isinstance(description, GearPair | GearTrain):
        if given is not None:
            raise InputError("at", _("instants are those of mechanisms and cams"), _("omit them"))
        return ()
    own = description.report.instants or description.study.instants
    return _first(_instants(description, given), own) or ()


def _first(wish: Wished | None, other: Wished | None) -> Wished | None:
    return other if wish is None else wish


def _check(names: Iterable[str] | None, known: Iterable[str], where: str, what: str) -> None:
    candidates = list(known)
    for name in names or ():
        if name not in candidates:
            raise InputError(where, what.format(name=value_text(name)), nearest(name, candidates))


Made = TypeVar("Made")


class ReportStudy:
    """A description with its wishes and its results.

    Attributes
    ----------
    description : Mechanism, Cam, PlateCam, GearPair or GearTrain
    wishes : what the report is to hold
    numbers : how it spells its numbers
    """

    def __init__(self, description: Reported, wishes: Wishes) -> None:
        self.description = description
        self.wishes = wishes
        self.numbers = Numbers(description.display, wishes.digits)
        self._made: dict[Hashable, Any] = {}

    def once(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """What `make` gives, made at the first call with this key; a failure is raised again, not repeated."""
        if key not in self._made:
            try:
                self._made[key] = make()
            except Exception as failure:
                self._made[key] = _Failed(failure)
        made = self._made[key]
        if isinstance(made, _Failed):
            raise made.failure
        return cast(Made, made)

    def keep(self, key: Hashable, made: Any) -> None:
        """Keep what is known already: `once` gives it at the first call with this key."""
        self._made[key] = made

    def wants(self, chapter: str) -> bool:
        """Whether a chapter is asked for: by its name, or because nobody chose."""
        return self.wishes.chapters is None or chapter in self.wishes.chapters

    def assemble(self) -> None:
        """Raise as `check` does for a linkage that does not assemble: there is nothing to report on it.

        One that only a simulation moves has a report on that.
        """
        if self.subject == "mechanism" and not self.moves_freely:
            _structure = self.check

    @property
    def moves_freely(self) -> bool:
        """Whether only a simulation moves it: it has fewer drives with a law than degrees of freedom."""
        return isinstance(self.description, Mechanism) and moves_freely(self.description)

    @property
    def subject(self) -> Subject:
        """What is reported on, as topics call it."""
        if isinstance(self.description, GearPair | GearTrain):
            return self.description.kind
        return "cam" if self.is_cam else "mechanism"

    @property
    def is_cam(self) -> bool:
        """Whether a cam is reported on, of either kind."""
        return isinstance(self.description, Cam | PlateCam)

    @property
    def is_planar(self) -> bool:
        """Whether a planar linkage is reported on."""
        return isinstance(self.description, Mechanism) and self.description.space == "plane"

    @property
    def mechanism(self) -> Mechanism:
        """The linkage; chapters of cams do not ask."""
        assert isinstance(self.description, Mechanism)
        return self.description

    @property
    def check(self) -> MechanismCheck:
        """Structure, mobility, plan, initial position."""
        return self.once("check", lambda: check(self.mechanism))

    @property
    def study(self) -> MotionResults:
        """Everything that `run` computes."""
        return self.once(
            "study", lambda: study(self.mechanism, motion=self.motion_of_forces, incomplete=True)
        )

    @property
    def motion_of_forces(self) -> MotionOfDrive:
        """The motion at which forces are computed: as wished, else the real one of a machine that has one."""
        wished = self.wishes.motion
        if wished is not None:
            return wished
        return self.once("motion of forces", lambda: motion_of_forces(self.mechanism))

    @property
    def results(self) -> Mapping[str, Any]:
        """Results of topics by their names: that of a run, and its parts."""
        return {"run": self.study, **self.study.parts}

    @property
    def motion(self) -> xr.Dataset:
        """The labelled motion."""
        return self.study.motion

    @property
    def equations(self) -> Equations:
        """The equations in symbols."""
        return self.once("equations", lambda: equations(self.mechanism))

    @property
    def points(self) -> tuple[str, ...]:
        """Points whose velocities and paths are told: those asked for, else those on guides of the frame."""
        if self.wishes.points is not None:
            return self.wishes.points
        try:
            return self.equations.points
        except CentrodeError:  # there are none in symbols
            guides = self.mechanism.guides
            return tuple(dict.fromkeys(guide.point for guide in guides if guide.on == FRAME))


class _Failed:
    """A failure that is kept in place of a result."""

    def __init__(self, failure: Exception) -> None:
        self.failure = failure


# The instants of a report: places on the motion that tables, formulas with numbers and diagrams are made for.


@dataclass(frozen=True)
class Moment:
    """One instant.

    Attributes
    ----------
    data, sample : the motion that has it, and where
    at : what `motion` is asked for it: a value of the drive, with a law or several drives a time
    title : "OA = 90°"
    status : of the sample
    """

    data: xr.Dataset
    sample: int
    at: float
    title: str

    @property
    def status(self) -> Status:
        """What the sample is worth."""
        return Status(int(self.data["status"][self.sample]))

    @property
    def is_reached(self) -> bool:
        """Whether everything is known there."""
        return self.status == Status.OK

    @property
    def missing(self) -> str:
        """Why there is nothing to tell of it."""
        sentence = _("At {place} the sample is {status}: the velocities are not defined.")
        return sentence.format(place=self.title, status=status_word(self.status))


def moments_of(study: ReportStudy) -> tuple[Moment, ...]:
    """The instants asked for; else the initial position, or the first sample that is reached."""
    return study.once("moments", lambda: tuple(_moments(study)))


def _moments(study: ReportStudy) -> list[Moment]:
    mechanism = study.mechanism
    places = instants_of(mechanism, study.wishes.instants)
    data = motion(mechanism, at=places)
    return [Moment(data, k, at, _title(study, data, k)) for k, at in enumerate(places)]


def _title(study: ReportStudy, data: xr.Dataset, sample: int) -> str:
    numbers = study.numbers
    values = data["drive_value"].values[sample]
    told = [
        f"{drive.label} = {drive_value_text(float(value), drive.unit, numbers)}"
        for drive, value in zip(study.mechanism.motion_parameter.drives, values, strict=True)
    ]
    if not study.mechanism.motion_parameter.is_uniform:
        told.insert(0, f"t = {numbers.with_unit(float(data['time'][sample]), 's')}")
    return ", ".join(told)


def drive_value_text(value: float, unit: str, numbers: Numbers) -> str:
    """A value of a drive with its unit; radians also in degrees, as a person thinks of them."""
    text = numbers.with_unit(value, unit)
    if unit == "rad" and str(numbers.display.angle) == "rad" and value:
        return f"{text} ({numbers.plain(float(np.degrees(value)))}°)"
    return text
