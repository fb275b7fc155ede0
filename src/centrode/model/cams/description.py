"""The description of a cam: one frozen datum that paths, profiles, movers and stresses are derived from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeVar

from pydantic import Field, model_validator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.asked import Display
from centrode.model.cams.parts import (
    CamStudy,
    Choose,
    Contact,
    Curvature,
    Mover,
    Range,
    Return,
    Roller,
    Start,
)
from centrode.model.cams.values import CONSTANT, POINT
from centrode.model.entries import choice
from centrode.model.part import Part
from centrode.model.problems import Problem, Problems, nearest, shown
from centrode.model.reports import CamReportWishes
from centrode.model.tabled import part_tables
from centrode.model.values import Text

SomeCam = TypeVar("SomeCam", bound=Part)


class Cam(Part):
    """A fixed cam and a carrier that leads a roller about it, by the curvature of the roller's path.

    The arguments are those of a file (docs: cams), as parts or as plain dicts, texts with units included:
    `Cam(kind="cam", curvature={"law": "constant", "k0": "0.01 1/mm"}, start={"radius": "50 mm"}, range={"to": 1})`.
    All numbers it holds are SI.

    Attributes
    ----------
    title : str
    kind : "cam"
    display : Display
    curvature : Curvature
    start : Start
    range : Range
    roller : Roller or None
    return_arc : Return or None
        "return" in a file.
    mover : Mover or None
    contact : Contact or None
    choose : Choose or None
    study : CamStudy
    report : CamReportWishes

    Raises
    ------
    InputError
        Anything that is not a description, with its place and the repair.
    """

    title: Text = ""
    kind: Annotated[Literal["cam"], choice("cam")]
    display: Display = Display()
    curvature: Curvature
    start: Start
    range: Range
    roller: Roller | None = None
    return_arc: Annotated[Return | None, Field(alias="return")] = None
    mover: Mover | None = None
    contact: Contact | None = None
    choose: Choose | None = None
    study: CamStudy = CamStudy()
    report: CamReportWishes = CamReportWishes()

    if TYPE_CHECKING:

        def __init__(self, **parts: Any) -> None: ...

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        problems = [*_of_range(self), *_of_roller(self), *_of_choice(self)]
        if problems:
            raise Problems(problems)
        return self


def _of_range(cam: Cam) -> list[Problem]:
    low, high = cam.range.start, cam.range.stop
    if not low <= 0 <= high or low == high:
        what = _("the range has to hold phi = 0, where the path starts")
        return [Problem(what, _('"from" is 0 or below, "to" 0 or above'), ("range",))]
    if cam.curvature.symmetric and low:
        what = _("a symmetric law gives the path on both sides of phi = 0")
        return [Problem(what, _('leave "from" out'), ("range", "from"))]
    if cam.curvature.symmetric and cam.start.pressure_angle:
        what = _("a symmetric path has a kink at phi = 0 unless the pressure angle there is zero")
        return [Problem(what, _("set it to 0, or leave out symmetric"), ("start", "pressure_angle"))]
    return []


def _of_roller(cam: Cam) -> list[Problem]:
    needs = {"return": cam.return_arc, "mover": cam.mover, "contact": cam.contact}
    if cam.roller is None:
        return [
            Problem(_("{key} needs a roller").format(key=f"[{name}]"), _("give [roller] radius"), (name,))
            for name, part in needs.items()
            if part is not None
        ]
    if cam.roller.radius >= cam.start.radius:
        what = _("the roller reaches the cam's centre: its radius is not below that of its path")
        return [Problem(what, _("make it smaller"), ("roller", "radius"))]
    return []


def _of_choice(cam: Cam) -> list[Problem]:
    """What is chosen is a number that the description has; a stress is asked of a contact."""
    if cam.choose is None:
        return []
    problems = []
    for name in cam.choose.parameters:
        if not _has(cam, name):
            what = _("the cam has no {name}").format(name=shown(name))
            problems.append(Problem(what, _("choose what the description gives"), ("choose", "parameters")))
    stressed = cam.choose.stress is not None or "stress" in (cam.choose.minimise, cam.choose.trade_off)
    if stressed and cam.contact is None:
        what = _("the contact stress needs the force, the width and the materials")
        problems.append(Problem(what, _("write a table [contact]"), ("choose",)))
    if cam.choose.trade_off == cam.choose.minimise:
        what = _("a trade-off needs two different measures")
        problems.append(Problem(what, _("name another one"), ("choose", "trade_off")))
    return problems


def _has(cam: Cam, name: str) -> bool:
    """Whether a description gives the number of a parameter's name."""
    table, _dot, key = name.partition(".")
    if POINT.fullmatch(name):
        return int(key[7:]) <= len(cam.curvature.points or ())
    if CONSTANT.fullmatch(name):
        return key[10:] in cam.curvature.constants
    return getattr(getattr(cam, table), key, None) is not None


def varied(cam: SomeCam, values: Mapping[str, float]) -> SomeCam:
    """The cam with other numbers [SI] at paths such as "curvature.k0"; InputError for a path it does not have."""
    tables = part_tables(cam)
    for path, value in values.items():
        table, _dot, key = path.partition(".")
        if not isinstance(tables.get(table), dict) or not key:
            raise InputError("", _("the cam has no {name}").format(name=shown(path)), nearest(path, tables))
        if POINT.fullmatch(path):
            _put_point(tables[table], path, value)
        elif CONSTANT.fullmatch(path):
            tables[table].setdefault("constants", {})[path.rpartition(".")[2]] = value
        else:
            tables[table][key] = value
    return type(cam)(**tables)


def _put_point(curvature: dict[str, Any], path: str, value: float) -> None:
    points = [list(point) for point in curvature.get("points", ())]
    number = int(path.rpartition(".")[2])
    if number > len(points):
        what = _("the cam has no {name}").format(name=shown(path))
        raise InputError("", what, _("points of a spline are counted from 1"))
    points[number - 1][1] = value
    curvature["points"] = points
