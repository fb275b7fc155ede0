"""A walking wheel: step, evenness of its travel, shoe, and the proof that it rolls level without slip."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.cams.profiles import shoe_outlines
from centrode.sheets.outlines import OutlineSet, WheelPositions
from centrode.sheets.players import WheelPlayer
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Deferred,
    Fact,
    FactTable,
    Failure,
    Formula,
    Paragraph,
    Scalar,
    Section,
    Sheet,
    illustrations,
)
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Text, Title
from centrode.views.curvature_cams import ROUNDED, angle, carrier_table, course, on_both_sides, shortfall

if TYPE_CHECKING:
    from centrode.cams.results import WalkingWheelResults
    from centrode.cams.walking_wheel import WheelMover, WheelRolling

DUG = 1e-9
"""Share of the hub's height by which a shoe may seem to dig in by rounding."""
SAMPLES = 180
"""Spaces between the points of a shoe's outline."""


def sheet(results: WalkingWheelResults) -> Sheet:
    """Everything there is to say about a walking wheel; nothing where the cam has no profile."""
    heading = Sentence("Walking wheel")
    chapters = {"walking": lambda: _chapter(results)}
    wheel, proof, dataset = results.wheel, results.proof, results.dataset
    if wheel is None or proof is None or dataset is None:
        if results.refusal is None:
            return Sheet()
        return Sheet(
            heading=heading, facts=_facts(results), chapters=Deferred(chapters), failure=_failure(results)
        )
    variables = [str(name) for name in dataset.data_vars if name != "carrier_angle"]
    title = Title(results.cam.title)
    motion = Section(NOTHING, (WheelPlayer(title, wheel),))
    positions = Sentence("The walking wheel; above each position stands the angle of its carrier")
    return Sheet(
        heading=heading,
        facts=_facts(results),
        scalars=_scalars(wheel, proof),
        tables=Deferred({"shoe-profile": lambda: carrier_table(dataset, variables)}),
        datasets={"shoe-profile": dataset},
        pictures={"walking-wheel": WheelPositions(positions, title, wheel, results.instants)},
        chapters=Deferred({"motion": lambda: Chapter(Sentence("Motion"), (motion,)), **chapters}),
        failure=_failure(results),
        outlines=Deferred(
            {"shoe-profile": lambda: OutlineSet(title, tuple(shoe_outlines(wheel.shoe, SAMPLES)))}
        ),
    )


# Facts and numbers


def _facts(results: WalkingWheelResults) -> tuple[Fact, ...]:
    if results.wheel is None or results.proof is None:
        return (Fact(Sentence("shoe"), Sentence("none")),)
    return (
        *_travel(results, results.wheel),
        *_shoe(results, results.wheel),
        *_rolling(results, results.wheel, results.proof),
    )


def _travel(results: WalkingWheelResults, wheel: WheelMover) -> Iterator[Fact]:
    rates = wheel.rates
    legs = Sentence("{count}, each in contact over ±{half}", count=Number(wheel.legs), half=angle(wheel.half))
    yield Fact(Sentence("legs"), legs)
    yield Fact(Sentence("height of the hub"), Number(wheel.height, "m"))
    turn = Number(wheel.step * wheel.legs, "m")
    yield Fact(
        Sentence("step"), Sentence("{step}; a turn travels {turn}", step=Number(wheel.step, "m"), turn=turn)
    )
    uneven = Sentence(
        "dX/dφ {least} at {least_at} to {greatest} at {greatest_at}, ratio {ratio}",
        least=Number(rates.least, "m/rad"),
        least_at=on_both_sides(results.cam, rates.at_least),
        greatest=Number(rates.greatest, "m/rad"),
        greatest_at=on_both_sides(results.cam, rates.at_greatest),
        ratio=Number(wheel.unevenness),
    )
    yield Fact(Sentence("unevenness of the travel"), uneven)


def _shoe(results: WalkingWheelResults, wheel: WheelMover) -> Iterator[Fact]:
    gap = Number(abs(wheel.print_gap), "m")
    apart = Sentence("and {gap} between them", gap=gap)
    if wheel.print_gap < 0:
        apart = Sentence("overlapping by {gap}", gap=gap)
    prints = Sentence("{length} long", length=Number(wheel.print_length, "m"))
    yield Fact(Sentence("footprints"), Joined((prints, apart)))
    bend, at = wheel.shoe.least_bend
    text = Sentence(
        "radius of curvature from {bend} at {at}", bend=Number(bend, "m"), at=on_both_sides(results.cam, at)
    )
    yield Fact(Sentence("shoe"), text)


def _rolling(results: WalkingWheelResults, wheel: WheelMover, proof: WheelRolling) -> Iterator[Fact]:
    """The proof: level, without slip; what else keeps the wheel going."""
    level = Number(proof.level, "m", ".2g")
    yield Fact(
        Sentence("level"),
        Sentence("with the shoe on the ground the height of the hub is constant within {error}", error=level),
    )
    if results.uneven:
        where = Joined(
            [Sentence("{first} to {last}", first=angle(one), last=angle(two)) for one, two in results.uneven]
        )
        lost = Sentence(
            "but not from {where}: the profile is undercut there and the roller leaves its path", where=where
        )
        yield Fact(NOTHING, lost)
    slip = Sentence(
        "the shoe's point at the contact moves at {slip} of the hub's speed",
        slip=Number(proof.slip, digits=".1g"),
    )
    yield Fact(Sentence("no slip"), slip)
    lengths = Sentence(
        "arc of the shoe {arc}, ground travelled {ground}, difference {apart}",
        arc=Number(proof.shoe_arc, "m", ".10g"),
        ground=Number(proof.ground, "m", ".10g"),
        apart=Number(abs(proof.shoe_arc - proof.ground), "m", ".2g"),
    )
    yield Fact(NOTHING, lengths)
    if abs(proof.joint) > DUG * wheel.height:
        jump = Number(proof.joint, "m/rad")
        taken = Sentence("the hub's dX/dφ jumps by {jump} where the next leg takes over", jump=jump)
        yield Fact(Sentence("change of legs"), taken)
    if not _digs(wheel, proof):
        yield Fact(Sentence("returning legs"), Sentence("clear of the ground"))
    if not _overlap(wheel, proof):
        apart = Sentence("clearance {room}", room=Number(proof.room, "m"))
        yield Fact(Sentence("neighbouring rollers"), apart)


def _digs(wheel: WheelMover, proof: WheelRolling) -> bool:
    """Whether a shoe that does not stand is in the ground."""
    return proof.clearance < -DUG * wheel.height


def _overlap(wheel: WheelMover, proof: WheelRolling) -> bool:
    """Whether rollers of neighbouring legs are in each other's way."""
    return proof.room < -DUG * wheel.height


def _failure(results: WalkingWheelResults) -> Failure | None:
    """What keeps the wheel from walking."""
    if results.refusal is not None:
        return Failure(Name(results.refusal.what), Name(results.refusal.repair))
    wheel, proof = results.wheel, results.proof
    if wheel is None or proof is None:
        return None
    texts: list[Text] = []
    if _digs(wheel, proof):
        texts.append(
            Sentence(
                "a returning shoe digs {depth} into the ground where its leg is at {at}; bound greatest_radius in"
                " [return]",
                depth=Number(-proof.clearance, "m"),
                at=angle(proof.clearance_at),
            )
        )
    if _overlap(wheel, proof):
        texts.append(
            Sentence(
                "the rollers of neighbouring legs overlap by {depth} where one leg is at {at}; use smaller "
                "rollers or fewer legs",
                depth=Number(-proof.room, "m"),
                at=angle(proof.room_at),
            )
        )
    return Failure(Joined(texts, "; ")) if texts else None


def _scalars(wheel: WheelMover, proof: WheelRolling) -> dict[str, Scalar]:
    known = {
        "legs": (wheel.legs, "1"),
        "hub_height": (wheel.height, "m"),
        "step": (wheel.step, "m"),
        "turn": (wheel.step * wheel.legs, "m"),
        "least_rate": (wheel.rates.least, "m/rad"),
        "greatest_rate": (wheel.rates.greatest, "m/rad"),
        "unevenness": (wheel.unevenness, "1"),
        "footprint": (wheel.print_length, "m"),
        "footprint_gap": (wheel.print_gap, "m"),
        "level_error": (proof.level, "m"),
        "slip": (proof.slip, "1"),
        "arc_difference": (abs(proof.shoe_arc - proof.ground), "m"),
        "clearance": (proof.clearance, "m"),
        "roller_room": (proof.room, "m"),
        "half": (math.pi / wheel.legs, "rad"),
    }
    return {f"walking_{name}": Scalar(value, unit) for name, (value, unit) in known.items()}


# Chapter


def _chapter(results: WalkingWheelResults) -> Chapter:
    """The wheel that walks: the shoe, its travel, the proof that it stays level and does not slip."""
    text = Sentence(
        "The hub stays at the height $h$ while the shoe of the standing leg rolls on the ground. In the axes of the leg"
        " the ground is a line at the distance $p$ from the roller's centre; the shoe is the envelope of these lines."
    )
    equations = Formula(
        (
            ("h", "rho (0) + C"),
            ("p", "h - rho cos phi"),
            ("x_B", "p sin phi + p' cos phi"),
            ("y_B", "p cos phi - p' sin phi"),
            ("frac(d X, d phi)", "h + rho' sin phi"),
        )
    )
    blocks: tuple[Block, ...] = (
        Paragraph(text),
        equations,
        FactTable(_facts(results)),
        *shortfall(_failure(results)),
    )
    sections = [Section(NOTHING, blocks)]
    if results.wheel is not None and results.proof is not None and results.dataset is not None:
        columns = [
            ("shoe_radius", "r_B"), ("shoe_angle", "alpha"), ("shoe_bend", "R_B"),
            ("hub_travel", "X"), ("hub_rate", "X'"),
        ]  # fmt: skip
        caption = Sentence("The shoe in polar coordinates, and the travel of the hub")
        table = course(results.dataset, columns, caption)
        sections += [
            Section(Sentence("Proof"), tuple(_proof(results.wheel, results.proof))),
            Section(Sentence("The shoe"), (table,)),
            illustrations(["walking-wheel"], {"walking-wheel": Sentence("The wheel over a step")}),
        ]
    return Chapter(Sentence("Walking wheel"), tuple(sections))


def _proof(wheel: WheelMover, proof: WheelRolling) -> Iterator[Check]:
    """Level, without slip, equal arcs: by the shoe's curve alone, put on the ground."""
    level = Sentence("The shoe on the ground keeps the height of the hub constant within {share} of it.")
    yield Check(level, proof.level, wheel.height, ROUNDED)
    slip = Sentence("The shoe's point at the contact moves at {share} of the speed of the hub.")
    yield Check(slip, proof.slip, 1.0, ROUNDED)
    arcs = Sentence("The arc of the shoe equals the ground travelled, within {share} of it.")
    yield Check(arcs, abs(proof.shoe_arc - proof.ground), wheel.print_length, ROUNDED)
