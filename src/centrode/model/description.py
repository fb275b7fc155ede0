"""All parts of a mechanism together, and look-ups among them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import AfterValidator, Field, ModelWrapValidatorHandler, PlainValidator, model_validator

from centrode.errors import InputError
from centrode.locale import _, mark
from centrode.model import reading
from centrode.model.contacts import MOST_CONTACTS, Clamp, EventCondition, Stop
from centrode.model.drives import Drive, motion_parameter_of
from centrode.model.gears import Gear
from centrode.model.initial_points import with_links_between_points
from centrode.model.links import Frame, Guide, Link, Rolling
from centrode.model.loads import AnyLoad, read_load
from centrode.model.motion_parameter import (
    UNDRIVEN,
    DriveCoordinate,
    MotionParameter,
    drive_coordinate,
)
from centrode.model.motors import MOST_CONTROLLERS, Controller, DriveMotor
from centrode.model.reading import (
    FRAME,
    DescriptionPart,
    FrozenMap,
    bounded_list,
    choice,
    nearest,
    two_points,
    value_text,
)
from centrode.model.settings import Assembly, Display, Machine, ReportWishes, Study
from centrode.model.simulation import Simulation
from centrode.model.tolerances import Tolerances
from centrode.model.values import (
    READING,
    Placed,
    PositiveMetres,
    Reading,
    Text,
    Vector,
    link_table,
    read_axes,
)
from centrode.numerics.operations import SCALARS


def _read_gravity(value: object) -> tuple[float, ...]:
    return read_axes(value, "acceleration")


def _fill_points(links: Mapping[str, Link]) -> Mapping[str, Link]:
    """Links with the two points that a name made of two points stands for, where a link lists none."""
    return FrozenMap({name: _with_points(name, link) for name, link in links.items()})


def _with_points(name: str, link: Link) -> Link:
    points = two_points(name)
    if link.points or link.length is None or points is None:
        return link
    return link.model_copy(update={"points": points})


class Description(DescriptionPart):
    """The parts of a mechanism, each right in itself, not yet checked against each other; see `Mechanism`."""

    repairs: ClassVar[Mapping[str, str]] = {
        "links": mark(
            "write each link below a heading, [links.AB], or begin with a built-in mechanism: "
            "centrode examples crank-rocker --out mine.toml"
        )
    }

    title: Text = ""
    space: Annotated[Literal["plane", "sphere"], choice("plane", "sphere")] = "plane"
    gravity: Annotated[tuple[float, ...], PlainValidator(_read_gravity)] | None = None
    radius: PositiveMetres | None = None
    display: Display = Display()
    # read before the links and taken apart into them: a mechanism holds none
    initial_points: Annotated[Mapping[str, Vector], Field(alias="points")] = FrozenMap({})
    frame: Frame = Frame()
    links: Annotated[Mapping[str, Link], link_table, AfterValidator(_fill_points)]
    guides: Annotated[tuple[Guide, ...], bounded_list(reading.GUIDES)] = ()
    gears: Annotated[tuple[Gear, ...], bounded_list(reading.LINKS)] = ()
    rolling: Annotated[tuple[Rolling, ...], bounded_list(reading.LINKS)] = ()
    drives: Annotated[tuple[Drive, ...], bounded_list(reading.DRIVES)] = ()
    assembly: Assembly = Assembly()
    loads: Annotated[
        tuple[Annotated[AnyLoad, PlainValidator(read_load)], ...], bounded_list(reading.LOADS)
    ] = ()
    stops: Annotated[tuple[Stop, ...], bounded_list(MOST_CONTACTS)] = ()
    clamps: Annotated[tuple[Clamp, ...], bounded_list(MOST_CONTACTS)] = ()
    events: Annotated[tuple[EventCondition, ...], bounded_list(MOST_CONTACTS)] = ()
    motors: Annotated[tuple[DriveMotor, ...], bounded_list(reading.DRIVES)] = ()
    controllers: Annotated[tuple[Controller, ...], bounded_list(MOST_CONTROLLERS)] = ()
    machine: Machine | None = None
    simulation: Simulation | None = None
    study: Study = Study()
    report: ReportWishes = ReportWishes()
    tolerances: Tolerances | None = None

    @model_validator(mode="wrap")
    @classmethod
    def _in_its_space(cls, data: Any, handler: ModelWrapValidatorHandler[Description]) -> Description:
        token = READING.set(_reading_of(data, READING.get()))
        try:
            given = isinstance(data, Mapping) and data.get("points")
            return handler(with_links_between_points(data) if given else data)
        finally:
            READING.reset(token)

    @property
    def sphere_radius(self) -> float:
        """Radius [m] of the sphere that masses and forces count on; 1 if it is not given."""
        return 1.0 if self.radius is None else self.radius

    @property
    def runs_at_mean_speed(self) -> bool:
        """Whether a machine gives its drive a mean speed."""
        return self.machine is not None and self.machine.mean_speed > 0.0

    @property
    def motion_parameter(self) -> MotionParameter:
        """What a motion is a function of: the value of the one drive, or time; its unit and how instants are stated."""
        return motion_parameter_of(
            self.drives,
            self.space,
            self.study.coordinate,
            refuses_bare=self.display.refuses_bare_angles,
        )

    def with_range(self, word: str | None) -> Self:
        """The mechanism whose study has a range by a word ("reachable") in place of its own; itself without a word.

        Raises InputError for another word.
        """
        if word is None:
            return self
        study = Study(
            samples=self.study.samples,
            instants=self.study.instants,
            range=word,
            coordinate=self.study.coordinate,
        )
        return self.model_copy(update={"study": study})

    def with_drives_held(self) -> Self:
        """The mechanism in which drives without a law hold their places, so that kinematics can place it."""
        if all(drive.has_law for drive in self.drives):
            return self
        drives = tuple(
            drive if drive.has_law else drive.model_copy(update={"speed": 0.0}) for drive in self.drives
        )
        return self.model_copy(update={"drives": drives})

    @property
    def link_names(self) -> tuple[str, ...]:
        """Names of the moving links in description order."""
        return tuple(self.links)

    @property
    def moving_points(self) -> tuple[str, ...]:
        """Points that are not the frame's, in order of first mention in the links, then in the guides."""
        named = [point for link in self.links.values() for point in link.coordinates]
        named += [guide.point for guide in self.guides]
        return tuple(dict.fromkeys(point for point in named if point not in self.frame.points))

    @property
    def points(self) -> tuple[str, ...]:
        """All points: the frame's, then the moving ones."""
        return (*self.frame.points, *self.moving_points)

    def guide(self, identity: str) -> Guide:
        """The guide of an id; raises InputError if there is none."""
        for guide in self.guides:
            if guide.id == identity:
                return guide
        what = _("there is no guide {name}").format(name=value_text(identity))
        raise InputError("", what, nearest(identity, [guide.id for guide in self.guides]))

    def drive(self, identity: str) -> Drive:
        """The drive of an id; raises InputError if there is none."""
        for drive in self.drives:
            if drive.id == identity:
                return drive
        what = _("there is no drive {name}").format(name=value_text(identity))
        raise InputError("", what, nearest(identity, [drive.id for drive in self.drives]))

    def through(self, guide: Guide) -> Vector:
        """Coordinates [m] of a point of the guide's line in the axes of `guide.on`.

        Raises InputError for a line that is not placed yet.
        """
        if isinstance(guide.through, str):
            return self.points_of(guide.on)[guide.through]
        if not isinstance(guide.through, Placed):
            return guide.through
        if guide.through.at is None:
            where = f"[[guides]] {guide.id}, through"
            raise InputError(where, _("the position of the line is not known yet"), _("give its coordinates"))
        return guide.through.at

    def points_of(self, link: str) -> Mapping[str, Vector]:
        """Local coordinates [m] of the points of a link or of the frame."""
        return self.frame.coordinates if link == FRAME else self.links[link].coordinates

    def initial_angle(self, link: str) -> float | None:
        """Absolute angle [rad] of a link in the initial position, where the description tells it.

        The link's `angle`; else the `start` of the drive of its angle, with its law at t = 0, from the
        angle of the link it is relative to.
        """
        return self._initial_angle(link, ())

    def _initial_angle(self, link: str, seen: tuple[str, ...]) -> float | None:
        if link == FRAME:
            return 0.0
        angle = self.links[link].angle
        if angle is not None or link in seen:
            return angle
        for drive in self.drives:
            if drive.link == link and drive.start is not None:
                base = self._initial_angle(drive.relative_to, (*seen, link))
                value = value_at_start(drive)
                return None if base is None or value is None else base + value
        return None

    def guide_turn(self, guide: Guide) -> float:
        """Constant angle [rad] from `guide.on` to `guide.link`: the given one, else by the initial angles, else 0."""
        if guide.angle is not None or guide.link is None:
            return guide.angle or 0.0
        turned, base = self.initial_angle(guide.link), self.initial_angle(guide.on)
        return 0.0 if turned is None or base is None else turned - base


def value_at_start(drive: Drive) -> float | None:
    """The drive's value at t = 0; None where its start is not given or its law is not defined there."""
    if drive.start is None or not drive.has_law:
        return drive.start
    try:
        value = drive.start + float(drive.motion_law.jet(SCALARS, 0.0))
    except (ArithmeticError, ValueError):
        return None
    return value if math.isfinite(value) else None


def _reading_of(data: object, outer: Reading) -> Reading:
    """Space and kind of the drives, from the raw data, for the values whose meaning they decide."""
    if not isinstance(data, Mapping):
        return outer
    space = "sphere" if data.get("space") == "sphere" else "plane"
    given = data.get("drives")
    drives = given if isinstance(given, list | tuple) else ()
    coordinates = tuple(coordinate_of_drive(drive, space) for drive in drives)
    parameter = MotionParameter(coordinates, len(drives) > 1) if drives else UNDRIVEN
    return replace(outer, space=space, parameter=parameter)


def coordinate_of_drive(drive: object, space: str) -> DriveCoordinate:
    """What is driven, and whether at a constant speed, as the raw data of a drive have it."""
    if isinstance(drive, Drive):
        return drive_coordinate(drive.id, drive.kind, space, drive.speed)
    keys = drive if isinstance(drive, Mapping) else {}
    driven = "displacement" if keys.get("guide") else "distance" if keys.get("distance") else "angle"
    ends = keys.get("distance")
    points = "-".join(map(str, ends)) if isinstance(ends, list | tuple) else ""
    name = str(keys.get("link") or keys.get("guide") or points)
    # its numbers are not read yet: any number stands for a constant speed
    return drive_coordinate(name, driven, space, None if keys.get("speed") is None else 0.0)
