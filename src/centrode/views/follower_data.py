"""What the description of a cam with a follower gives, as tables of documents."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from centrode.sheets.sheet import Block, Chapter, Column, Fact, FactTable, Section, Table
from centrode.sheets.texts import NOTHING, Expression, Name, Number, Sentence, Text, Title
from centrode.views.followers import CONTACTS, KINDS, MEGA, curve_name, letter_of

if TYPE_CHECKING:
    from centrode.model.cam import Material
    from centrode.model.drives import Drive
    from centrode.model.follower_cam import LiftSegment, PlateCam

GIGA = 1e-9
TURNS = {"counter-clockwise": Sentence("counter-clockwise"), "clockwise": Sentence("clockwise")}


def data_chapter(cam: PlateCam) -> Chapter:
    """Everything the description gives."""
    blocks: list[Block] = [FactTable(tuple(_given(cam, cam.body.speed)), Sentence("Cam and follower"))]
    bounds = tuple(_bounds(cam))
    if bounds:
        blocks.append(FactTable(bounds, Sentence("Admissible values")))
    return Chapter(Sentence("Data"), (Section(NOTHING, (*blocks, *_segments(cam))),))


def driving_cam(drive: Drive, cam: PlateCam) -> tuple[Block, ...]:
    """A cam that drives a linkage, with its follower's motion."""
    facts = [*_given(cam, None), Fact(Sentence("speed of the cam"), _turning(drive.turning or 0.0))]
    facts.append(Fact(Sentence("angle of the cam at $t = 0$"), _number(drive.cam_angle, "rad")))
    if drive.cam_point is not None:
        facts.append(Fact(Sentence("point of the link that the cam moves"), Name(drive.cam_point)))
    raises = Sentence("raises the value of the drive")
    facts.append(
        Fact(Sentence("lift"), Sentence("lowers the value of the drive") if drive.lowers else raises)
    )
    caption = Sentence("Cam that moves drive {drive}", drive=Name(drive.id))
    if cam.title:
        caption = Sentence(
            "Cam {title}, which moves drive {drive}", title=Title(cam.title), drive=Name(drive.id)
        )
    return (FactTable(tuple(facts), caption), *_segments(cam))


def _number(value: float, unit: str = "1") -> Number:
    return Number(value, unit, digits="")


def _given(cam: PlateCam, speed: float | None) -> Iterator[Fact]:
    """Cam and follower without the motion."""
    body, follower = cam.body, cam.follower
    if body.base_radius is not None:
        yield Fact(Sentence("base radius"), _number(body.base_radius, "m"))
    yield Fact(Sentence("the cam turns"), TURNS[body.turn])
    if speed is not None:
        yield Fact(Sentence("speed of the cam"), _turning(speed))
    if body.thickness is not None:
        yield Fact(Sentence("thickness of the cam"), _number(body.thickness, "m"))
    if body.material is not None:
        yield Fact(Sentence("material of the cam"), _material(body.material))
    kind = Sentence("{kind}, with {contact}", kind=KINDS[follower.kind], contact=CONTACTS[follower.contact])
    yield Fact(Sentence("follower"), kind)
    yield from _sizes(
        (Sentence("radius of the roller"), follower.roller_radius, "m"),
        (Sentence("offset of the follower's axis"), follower.offset or None, "m"),
        (Sentence("length of the arm"), follower.arm, "m"),
        (Sentence("pivot from the cam's centre"), follower.pivot_distance, "m"),
        (Sentence("offset of the face from the pivot"), follower.face_offset or None, "m"),
    )
    yield from _burden(cam)
    if cam.tool is not None:
        yield Fact(Sentence("radius of the cutter"), _number(cam.tool.radius, "m"))


def _turning(speed: float) -> Text:
    """The speed of a cam [rad/s] in turns a minute and in radians."""
    rate = Number(speed, "rad/s", digits="", unit_fixed=True)
    return Sentence("{turns} turns per minute, {rate}", turns=_number(speed * 30.0 / np.pi), rate=rate)


def _burden(cam: PlateCam) -> Iterator[Fact]:
    """Masses, spring, load, friction of the follower."""
    follower, spring = cam.follower, cam.follower.spring
    push, stiffness = ("N m", "N m/rad") if cam.swings else ("N", "N/m")
    yield from _sizes(
        (Sentence("mass of the follower"), follower.mass, "kg"),
        (Sentence("moment of inertia of the follower"), follower.inertia, "kg m^2"),
        (Sentence("stiffness of the spring"), None if spring is None else spring.stiffness, stiffness),
        (Sentence("preload of the spring"), None if spring is None else spring.preload, push),
        (Sentence("load"), follower.load or None, push),
        (Sentence("friction between cam and follower"), follower.friction or None, "1"),
    )
    if follower.material is not None:
        yield Fact(Sentence("material of the follower"), _material(follower.material))


def _material(material: Material) -> Text:
    modulus = _number(GIGA * material.elasticity, "GPa")
    return Sentence("$E$ = {modulus}, $nu$ = {ratio}", modulus=modulus, ratio=_number(material.poisson))


def _bounds(cam: PlateCam) -> Iterator[Fact]:
    bounds = cam.bounds
    yield from _sizes(
        (Sentence("greatest pressure angle"), bounds.pressure_angle, "rad"),
        (
            Sentence("greatest pressure angle where the follower falls"),
            bounds.return_pressure_angle,
            "rad",
        ),
        (Sentence("least radius of curvature of the profile"), bounds.curvature_radius, "m"),
        (
            Sentence("greatest ratio of the roller's radius to the radius of curvature of its path"),
            bounds.roller_to_curvature,
            "1",
        ),
        (
            Sentence("greatest ratio of the roller's radius to the least radius of its path"),
            bounds.roller_to_radius,
            "1",
        ),
        (Sentence("greatest contact stress"), None if bounds.stress is None else MEGA * bounds.stress, "MPa"),
    )


def _sizes(*sizes: tuple[Sentence, float | None, str]) -> Iterator[Fact]:
    """What is given of some quantities."""
    for label, value, unit in sizes:
        if value is not None:
            yield Fact(label, _number(value, unit))


def _segments(cam: PlateCam) -> Iterator[Table]:
    """The segments of a turn, and of those through points their conditions."""
    unit, letter = ("rad" if cam.swings else "m"), letter_of(cam.swings)
    angles, lifts = [0.0], [0.0]
    for segment in cam.segments:
        angles.append(angles[-1] + segment.angle)
        lifts.append(lifts[-1] if segment.to is None else segment.to)
    ends = (
        ("angle_from", angles[:-1], "rad", Sentence("$phi$ from")),
        ("angle_to", angles[1:], "rad", Sentence("$phi$ to")),
        ("lift_from", lifts[:-1], unit, Sentence("{letter} from", letter=Expression(letter))),
        ("lift_to", lifts[1:], unit, Sentence("{letter} to", letter=Expression(letter))),
    )
    numbers = tuple(Number(number) for number in range(1, len(cam.segments) + 1))
    yield Table(
        (
            Column("segment", numbers, head=Sentence("segment")),
            Column("curve", tuple(curve_name(one.curve) for one in cam.segments), head=Sentence("curve")),
            *(Column(name, _cells(values, of), of, head) for name, values, of, head in ends),
        ),
        Sentence("Segments of a turn"),
    )
    for number, segment in enumerate(cam.segments, 1):
        yield from _conditions(segment, number, unit, letter)


def _cells(values: Sequence[float], unit: str) -> tuple[Number, ...]:
    """Numbers that have digits of their own each."""
    return tuple(Number(value, unit, digits="", unit_hidden=True) for value in values)


def _conditions(segment: LiftSegment, number: int, unit: str, letter: str) -> Iterator[Table]:
    """Derivatives at the ends of a segment and points on its way."""
    ends = [
        (order, where, value)
        for where, rates in (
            (Sentence("at its start"), segment.at_start),
            (Sentence("at its end"), segment.at_end),
        )
        for order, value in enumerate(rates, 1)
    ]
    if ends:
        powers = ["" if order == 1 else f"^{order}" for order, _where, _value in ends]
        values = tuple(
            _number(value, f"{unit}/rad{power}")
            for power, (_order, _where, value) in zip(powers, ends, strict=True)
        )
        yield Table(
            (
                Column(
                    "derivative",
                    tuple(Expression(f"{letter}^(({order}))") for order, _where, _value in ends),
                    head=Sentence("derivative"),
                ),
                Column("where", tuple(where for _order, where, _value in ends), head=Sentence("where")),
                Column("value", values, head=Sentence("value")),
            ),
            Sentence("Derivatives by the angle of the cam that segment {number} has", number=Number(number)),
        )
    if segment.through:
        places, lifts = (np.array(one) for one in zip(*segment.through, strict=True))
        yield Table(
            (
                Column("angle", places, "rad", Expression("phi")),
                Column("lift", lifts, unit, Expression(letter)),
            ),
            Sentence("Points of segment {number}, angles from its start", number=Number(number)),
        )
