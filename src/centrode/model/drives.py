"""Drives: an angle, a displacement or a distance that is given as a law of time, or left free."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import PlainValidator, ValidationInfo, field_validator, model_validator

from centrode.errors import InputError
from centrode.laws import Law, ShaftLaw, TableLaw, TextLaw, Uniform
from centrode.locale import _
from centrode.model.cam_of_drive import read_plate_cam
from centrode.model.follower_cam import PlateCam
from centrode.model.motion_parameter import (
    SPEED_KINDS,
    MotionParameter,
    drive_coordinate,
    kind_of_value,
)
from centrode.model.reading import FRAME, DescriptionPart, Problem, at_most_one_of, bounded_list, one_of
from centrode.model.segments import Segment, law_of_segments, read_segments
from centrode.model.values import (
    READING,
    Angle,
    Flag,
    Name,
    TableColumns,
    angular_speed,
    positive,
    read_rows,
    read_text,
    si,
)

if TYPE_CHECKING:
    from centrode.model.settings import ChosenCoordinate

_LAWS = ("speed", "law", "table", "segments", "cam")
_OF_CAM = ("cam_speed", "cam_angle", "cam_point", "lowers")


def _read_law(value: object) -> str:
    text = read_text(value)
    try:
        TextLaw(text)
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    return text


class Drive(DescriptionPart):
    """A given motion of one degree of freedom: value(t) = start + law(t).

    A drive without a law is a free coordinate: it names an angle, a displacement or a distance in the results of a
    simulation, and holds nothing.

    Attributes
    ----------
    link, guide, distance : str, str, two points
        One of them: the link's angle, the displacement along the guide, the distance of the points.
    relative_to : str
        The link an angle is measured from.
    start : float [rad or m]
        Value at t = 0, without the law's own value there; from the initial position by default.
    speed, law, table, segments, cam : float [rad/s or m/s], formula in t, rows of (time, value), Segments, PlateCam
        At most one of them. In a file, `table` may be the path of a CSV file beside it, `cam` that of a cam's
        description or the name of a built-in one.
    repeat : bool
        Whether the segments follow each other again and again.
    cam_speed : float [rad/s]
        Of the cam; its description's own by default.
    cam_angle : float [rad]
        Of the cam at t = 0.
    cam_point : str
        The driven link's point that touches the cam, or the roller's centre; the link's own axis is the arm if left
        out.
    lowers : bool
        Whether the cam's lift lowers the value instead of raising it.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.Drive(link="OA", speed="60 rpm").speed
    6.283185307179586
    """

    link: Name | None = None
    guide: Name | None = None
    distance: Annotated[tuple[Name, ...], bounded_list(2)] | None = None
    relative_to: Name = FRAME
    start: float | None = None
    speed: float | None = None
    law: Annotated[str, PlainValidator(_read_law)] | None = None
    table: tuple[tuple[float, float], ...] | None = None
    segments: tuple[Segment, ...] | None = None
    repeat: Flag = False
    cam: Annotated[PlateCam, PlainValidator(read_plate_cam)] | None = None
    cam_speed: Annotated[float, PlainValidator(partial(angular_speed, read=positive))] | None = None
    cam_angle: Angle = 0.0
    cam_point: Name | None = None
    lowers: Flag = False

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        wrong = one_of(given, ("link", "guide", "distance")) + at_most_one_of(given, _LAWS)
        if given.get("link") is None and given.get("relative_to", FRAME) != FRAME:
            repair = _("remove it; a guide's displacement is along the link it is on")
            wrong.append(Problem(_("relative_to is used with the drive of a link's angle only"), repair))
        if given.get("repeat") and given.get("segments") is None:
            wrong.append(Problem(_("repeat is used with segments only"), _("remove it, or give segments")))
        if given.get("cam") is None:
            foreign = [key for key in _OF_CAM if given.get(key)]
            told = _("{key} is used with a cam only")
            wrong += [Problem(told.format(key=key), _("remove it, or give a cam")) for key in foreign]
        return super().key_problems(given) + wrong

    @field_validator("start", "speed", mode="plain")
    @classmethod
    def _number(cls, value: object, info: ValidationInfo) -> float | None:
        if value is None:
            return None
        kind = _kind(info, rate=info.field_name == "speed")
        return angular_speed(value) if kind == "angular speed" else si(value, kind)

    @field_validator("table", mode="plain")
    @classmethod
    def _rows(cls, value: object, info: ValidationInfo) -> tuple[tuple[float, float], ...] | None:
        if value is None:
            return None
        columns = TableColumns(("time", _kind(info)), "[time, value]", 2)
        rows = read_rows(value, columns, READING.get().folder)
        try:
            TableLaw(*zip(*rows, strict=True))
        except InputError as error:
            raise Problem(error.what, error.repair) from None
        return tuple((time, number) for time, number in rows)

    @field_validator("segments", mode="plain")
    @classmethod
    def _segments(cls, value: object, info: ValidationInfo) -> tuple[Segment, ...] | None:
        return None if value is None else read_segments(value, _kind(info))

    @model_validator(mode="after")
    def _cam_fits(self) -> Self:
        if self.cam is not None:
            _check_cam(self, self.cam)
        return self

    @property
    def kind(self) -> str:
        """What is driven: "angle", "displacement" or "distance"."""
        return "angle" if self.link else "displacement" if self.guide else "distance"

    @property
    def id(self) -> str:
        """The link's name, the guide's id, or the two points as "A-B"."""
        return self.link or self.guide or "-".join(self.distance or ())

    @property
    def turning(self) -> float | None:
        """Speed [rad/s] of the cam that drives; None without one."""
        if self.cam is None:
            return None
        return self.cam.body.speed if self.cam_speed is None else self.cam_speed

    @property
    def has_law(self) -> bool:
        """Whether a law of time gives its motion; without one it is a free coordinate."""
        return any(getattr(self, key) is not None for key in _LAWS)

    def check_law(self) -> None:
        """Raise InputError for a drive without a law, which nothing but a simulation moves."""
        if not self.has_law:
            raise InputError(
                f"[[drives]] {self.id}",
                _("it has no law of motion: it is a free coordinate, which only a simulation moves"),
                _("give speed, law, table, segments or cam, or use centrode simulate"),
            )

    @property
    def motion_law(self) -> Law:
        """s(t) [rad or m]; the drive's value is start + s(t). Raises InputError for a drive without a law."""
        self.check_law()
        if self.speed is not None:
            return Uniform(self.speed)
        if self.law is not None:
            return TextLaw(self.law)
        if self.segments is not None:
            return law_of_segments(self.segments, self.repeat)
        if self.cam is not None:
            return ShaftLaw(self.cam.lift_law, self.turning or 1.0, self.cam_angle, self.lowers)
        times, values = zip(*self.table or (), strict=True)
        return TableLaw(times, values)


def _kind(info: ValidationInfo, rate: bool = False) -> str:
    driven = "angle" if info.data.get("link") is not None else "displacement"
    kind = kind_of_value(driven, READING.get().space)
    return SPEED_KINDS[kind] if rate else kind


def _check_cam(drive: Drive, cam: PlateCam) -> None:
    """Raise Problem where a cam cannot drive what it is to drive."""
    if READING.get().space == "sphere":
        raise Problem(_("disc cams are planar"), _("give another law"), ("cam",))
    if drive.turning is None:
        what = _("the speed of the cam is not given")
        raise Problem(what, _("give cam_speed, or speed in the cam's table [cam]"), ("cam",))
    if drive.distance is not None:
        what = _("a cam drives the angle of a link, or a displacement along a guide")
        raise Problem(what, _("name a link or a guide"), ("cam",))
    if drive.cam_point is not None and not cam.swings:
        what = _("cam_point is used with an oscillating follower only; a guide has its own point")
        raise Problem(what, _("remove it"), ("cam_point",))
    if cam.swings and drive.link is None:
        what = _("the cam's follower oscillates, but a displacement is driven")
        raise Problem(what, _("drive a link's angle, or choose a translating follower"), ("cam",))
    if not cam.swings and drive.guide is None:
        what = _("the cam's follower translates, but an angle is driven")
        raise Problem(
            what, _("drive a displacement along a guide, or choose an oscillating follower"), ("cam",)
        )


def motion_parameter_of(
    drives: Sequence[Drive],
    space: str,
    chosen: ChosenCoordinate | None = None,
    *,
    refuses_bare: bool = False,
) -> MotionParameter:
    """What a motion of a mechanism with these drives, in the plane or on the sphere, is a function of.

    The value of one drive alone may be a coordinate that is chosen.
    """
    coordinates = tuple(drive_coordinate(one.id, one.kind, space, one.speed, refuses_bare) for one in drives)
    if chosen is not None and len(coordinates) == 1:
        coordinates = (coordinates[0].measured_from(chosen.zero, chosen.way),)
    return MotionParameter(coordinates, by_time=len(drives) > 1)
