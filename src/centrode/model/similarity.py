"""A mechanism of the plane put elsewhere: turned, shifted, and made larger or smaller as a whole.

All its motions are similar then: whatever stands in metres grows with the scale, whatever is measured from the axes of
the frame turns with it, and what lies in the axes of a link, ratios and sides of assembly stay.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.drives import Drive
from centrode.model.files import document, mechanism_from
from centrode.model.links import Frame, Guide, Link, Rolling, Track
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.reading import FrozenMap
from centrode.model.settings import ReportWishes, Study
from centrode.model.values import Placed, Vector

UNREACHED = (
    "loads", "stops", "clamps", "events", "motors", "controllers", "machine", "simulation", "tolerances"
)  # fmt: skip
"""Tables whose formulas and numbers have no similar ones in general."""


@dataclass(frozen=True)
class Similarity:
    """z -> factor z + shift of complex coordinates z = x + iy [m]; no mirror.

    Attributes
    ----------
    factor : scale times exp(i turn)
    shift : [m]
    """

    factor: complex
    shift: complex

    @property
    def scale(self) -> float:
        """By which all lengths grow."""
        return abs(self.factor)

    @property
    def turn(self) -> float:
        """By which everything turns [rad], from -pi to pi."""
        return math.atan2(self.factor.imag, self.factor.real)

    def move(self, at: Vector) -> Vector:
        """Where a point of the frame's axes [m] goes."""
        moved = self.factor * complex(*at) + self.shift
        return moved.real, moved.imag

    def move_local(self, at: Vector) -> Vector:
        """Coordinates [m] in the axes of a link."""
        return self.scale * at[0], self.scale * at[1]

    def turn_direction(self, along: Vector | float) -> Vector | float:
        """A direction in the frame's axes, as a vector or as an angle [rad]."""
        if not isinstance(along, tuple):
            return along + self.turn
        turned = self.factor / self.scale * complex(*along)
        return turned.real, turned.imag


def check_similarity(mechanism: Mechanism, where: str = "") -> None:
    """Raise InputError that names what of a mechanism has no similar one."""
    why = next(_parts_beyond_similarity(mechanism), None)
    if why is not None:
        what = _("{what} cannot be moved and scaled with the mechanism").format(what=why)
        raise InputError(where, what, _("remove it, or leave the place of the mechanism as it is given"))


def _parts_beyond_similarity(mechanism: Mechanism) -> Iterator[str]:
    if mechanism.space != "plane":
        yield 'space = "sphere"'
    for name in UNREACHED:
        if getattr(mechanism, name):
            yield name
    for gear in mechanism.gears:
        if gear.pair is not None:
            yield f"gears {gear.id}.pair"
    for drive in mechanism.drives:
        if drive.cam is not None:
            yield f"drives {drive.id}.cam"
        elif drive.segments is not None and drive.link is None:
            yield f"drives {drive.id}.segments"


def apply_similarity(mechanism: Mechanism, similarity: Similarity) -> Mechanism:
    """The mechanism that moves like this one, but for a similarity of all its positions.

    Masses, inertias and gravity stay as they are. Positions agree with the similarity of the original's to rounding.

    Raises
    ------
    InputError
        A mechanism on the sphere, loads and whatever else `UNREACHED` names, pairs of wheels, cams of drives.
    """
    check_similarity(mechanism)
    points = {
        name: Placed(None if at.at is None else similarity.move(at.at))
        if isinstance(at, Placed)
        else similarity.move(at)
        for name, at in mechanism.frame.points.items()
    }
    moved = mechanism.model_copy(
        update={
            "frame": Frame(points=FrozenMap(points)),
            "links": FrozenMap(
                {name: _move_link(link, similarity) for name, link in mechanism.links.items()}
            ),
            "guides": tuple(_move_guide(mechanism, guide, similarity) for guide in mechanism.guides),
            "rolling": tuple(_move_track(wheel, similarity) for wheel in mechanism.rolling),
            "drives": tuple(_move_drive(drive, similarity) for drive in mechanism.drives),
            "study": _move_study(mechanism, similarity),
            "report": _move_report(mechanism, similarity),
        }
    )
    # read anew, so that every rule of a description holds for it too
    return mechanism_from(document(moved))


def _move_link(link: Link, similarity: Similarity) -> Link:
    changed: dict[str, Any] = {}
    for key in ("length", "radius"):
        if (value := getattr(link, key)) is not None:
            changed[key] = similarity.scale * value
    if isinstance(link.points, Mapping):
        changed["points"] = FrozenMap({name: similarity.move_local(at) for name, at in link.points.items()})
    if link.angle is not None:
        changed["angle"] = link.angle + similarity.turn
    if isinstance(link.centre, tuple):
        changed["centre"] = similarity.move_local(link.centre)
    changed["masses"] = tuple(
        part.model_copy(update={"at": similarity.move_local(part.at)}) if isinstance(part.at, tuple) else part
        for part in link.masses
    )
    return link.model_copy(update=changed)


def _move_guide(mechanism: Mechanism, guide: Guide, similarity: Similarity) -> Guide:
    put = similarity.move if guide.on == FRAME else similarity.move_local
    changed: dict[str, Any] = {}
    if isinstance(guide.through, tuple):
        changed["through"] = put(guide.through)
    elif isinstance(guide.through, Placed) and guide.through.at is not None:
        changed["through"] = Placed(put(guide.through.at))
    if guide.on == FRAME:
        changed["direction"] = similarity.turn_direction(guide.direction)
        if guide.link is not None:
            # the frame's own axes stay, so the link's constant angle to them does not
            changed["angle"] = mechanism.guide_turn(guide) + similarity.turn
    return guide.model_copy(update=changed)


def _move_track(wheel: Rolling, similarity: Similarity) -> Rolling:
    track = wheel.along
    on_frame = wheel.on == FRAME
    put = similarity.move if on_frame else similarity.move_local
    changed: dict[str, Any] = {}
    for key in ("through", "centre"):
        if isinstance(at := getattr(track, key), tuple):
            changed[key] = put(at)
    if track.radius is not None:
        changed["radius"] = similarity.scale * track.radius
    if track.direction is not None and on_frame:
        changed["direction"] = similarity.turn_direction(track.direction)
    along: Track = track.model_copy(update=changed)
    return wheel.model_copy(update={"radius": similarity.scale * wheel.radius, "along": along})


def _move_drive(drive: Drive, similarity: Similarity) -> Drive:
    if drive.link is not None:
        if drive.relative_to != FRAME or drive.start is None:
            return drive
        return drive.model_copy(update={"start": drive.start + similarity.turn})
    scale = similarity.scale
    changed: dict[str, Any] = {}
    for key in ("start", "speed"):
        if (value := getattr(drive, key)) is not None:
            changed[key] = scale * value
    if drive.law is not None:
        changed["law"] = f"{scale!r} * ({drive.law})"
    if drive.table is not None:
        changed["table"] = tuple((time, scale * value) for time, value in drive.table)
    return drive.model_copy(update=changed)


def _move_value(mechanism: Mechanism, similarity: Similarity, value: float) -> float:
    """Another number of the one drive, where results are functions of it."""
    drive = mechanism.drives[0]
    if drive.link is None:
        return similarity.scale * value
    return value + similarity.turn if drive.relative_to == FRAME else value


def _move_study(mechanism: Mechanism, similarity: Similarity) -> Study:
    study = mechanism.study
    chosen = study.coordinate
    changed: dict[str, Any] = {}
    if chosen is not None:
        # instants count from its zero, which moves
        zero = _move_value(mechanism, similarity, chosen.zero)
        changed["coordinate"] = chosen.model_copy(update={"zero": zero})
    for key in ("start", "stop"):
        if (value := getattr(study, key)) is not None:
            changed[key] = _move_instant(mechanism, similarity, value)
    changed["instants"] = tuple(_move_instant(mechanism, similarity, value) for value in study.instants)
    return study.model_copy(update=changed)


def _move_report(mechanism: Mechanism, similarity: Similarity) -> ReportWishes:
    instants = tuple(_move_instant(mechanism, similarity, value) for value in mechanism.report.instants)
    return mechanism.report.model_copy(update={"instants": instants})


def _move_instant(mechanism: Mechanism, similarity: Similarity, value: float) -> float:
    """A value of the drive, or a time, at which something is shown."""
    if mechanism.motion_parameter.instant.unit == "s" or not mechanism.drives:
        return value
    if mechanism.study.coordinate is None:
        return _move_value(mechanism, similarity, value)
    return similarity.scale * value if mechanism.drives[0].link is None else value
