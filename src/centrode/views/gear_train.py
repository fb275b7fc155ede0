"""A train of gears by its ratio: what the terminal, the files and the figures show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.gears.closed_trains import ClosedTrain
from centrode.gears.planetary_trains import CarrierSeries, OrdinaryTrain, PlanetaryTrain
from centrode.numerics.outline_pieces import OutlinePiece
from centrode.sheets.outlines import DrawnLines, LineUse, OutlineDrawing
from centrode.sheets.plots import AxisLabel, CurveDiagram, Trace
from centrode.sheets.sheet import Column, Deferred, Fact, Scalar, Sheet, Table
from centrode.sheets.texts import NOTHING, Joined, Number, Sentence, Symbol, Text, Title
from centrode.views.closed_train_chapters import member_text, power_flow, shaft_text
from centrode.views.gear_train_chapters import (
    choice_chapter,
    conditions_chapter,
    data_chapter,
    motion_chapter,
)

if TYPE_CHECKING:
    from centrode.gears.train_results import GearTrainResults
    from centrode.gears.train_search import AnyTrain

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]

SCHEMES = {
    "single planets": Sentence("planetary, planets with one rim between sun and ring"),
    "stepped planets": Sentence("planetary, planets with two rims between sun and ring"),
    "external meshes": Sentence("planetary, planets with two rims, two external meshes"),
    "internal meshes": Sentence("planetary, planets with two rims in two rings"),
    "two carriers": Sentence("two planetary trains in series"),
    "closed": Sentence("closed, two planetary sets with two joined shafts"),
    "one pair": Sentence("ordinary, one external pair"),
    "two pairs": Sentence("ordinary, two external pairs"),
}
LISTED = 10
"""Trains that the terminal shows."""
CIRCLE = 73
"""Places of a circle."""


def sheet(results: GearTrainResults) -> Sheet:
    """Everything there is to say about trains of a ratio, and about the chosen one."""
    closed = results.chosen if isinstance(results.chosen, ClosedTrain) else None
    powers = () if closed is None else (powers_table(closed, results),)
    return Sheet(
        facts=tuple(_facts(results)),
        scalars=_scalars(results),
        tables=Deferred(
            {
                "trains": lambda: trains_table(results, None),
                "members": lambda: members_table(results),
                **({"powers": lambda: powers_table(closed, results)} if closed is not None else {}),
            }
        ),
        pictures=Deferred(
            {
                "wheels": lambda: wheels_drawing(results),
                "velocities": lambda: _velocities(results),
                "angular-velocities": lambda: _angular_velocities(results),
            }
        ),
        chapters=Deferred(
            {
                "data": lambda: data_chapter(results, SCHEMES[results.gear_train.scheme]),
                "train-choice": lambda: choice_chapter(
                    results, tuple(_facts(results)), trains_table(results, LISTED)
                ),
                "train-conditions": lambda: conditions_chapter(results, powers),
                "train-motion": lambda: motion_chapter(members_table(results)),
            }
        ),
        printed=(trains_table(results, LISTED), members_table(results), *powers),
        notes=tuple(_notes(results)),
    )


def teeth_text(train: AnyTrain) -> Text:
    """Numbers of teeth: of a planet with one rim once, stages of two carriers apart."""
    if isinstance(train, CarrierSeries | ClosedTrain):
        return Joined(tuple(teeth_text(stage) for stage in train.stages), "; ")
    if isinstance(train, OrdinaryTrain):
        return Joined(tuple(_numbers(pair) for pair in train.pairs), "; ")
    sun, planet, _other, fixed = train.teeth
    return _numbers(train.teeth if train.scheme.stepped else (sun, planet, fixed))


def _numbers(teeth: tuple[int, ...]) -> Text:
    return Joined(tuple(Number(float(one)) for one in teeth), ", ")


def _facts(results: GearTrainResults) -> Iterator[Fact]:
    described, train = results.gear_train, results.chosen
    yield Fact(Sentence("scheme of the train"), SCHEMES[described.scheme])
    yield Fact(Sentence("ratio that is sought"), Number(described.whole_ratio))
    if described.pair_behind is not None:
        yield Fact(Sentence("of it the train has"), Number(described.train_ratio))
    count = Number(float(len(results.found.trains)))
    yield Fact(
        Sentence("trains with this ratio"),
        Sentence("more than {count}", count=count) if results.found.more else count,
    )
    yield Fact(Sentence("numbers of teeth"), teeth_text(train))
    ratio = Sentence(
        "{ratio}, deviation {share} %",
        ratio=Number(results.whole_ratio(train)),
        share=Number(100 * results.deviation(train), digits=".3g"),
    )
    yield Fact(Sentence("ratio"), ratio)
    if not isinstance(train, OrdinaryTrain):
        stages = (train,) if isinstance(train, PlanetaryTrain) else train.stages
        most = min(stage.most_planets for stage in stages)
        planets = Sentence(
            "{count}, at most {most} fit beside each other",
            count=Number(float(stages[0].planets)),
            most=Number(float(most)),
        )
        yield Fact(Sentence("planets"), planets)
        yield Fact(Sentence("greatest diameter"), Number(train.diameter * described.module, "m"))
    else:
        yield Fact(Sentence("length along the axes"), Number(train.diameter * described.module, "m"))
    efficiency = results.efficiency(train)
    locked: Text = Sentence("none: the train locks itself")
    yield Fact(Sentence("efficiency"), locked if efficiency <= 0 else Number(efficiency, digits=".4g"))
    if isinstance(train, ClosedTrain):
        yield Fact(Sentence("flow of power"), power_flow(train))
    if described.input_speed is not None or described.output_speed is not None:
        yield Fact(Sentence("speed of the motor"), Number(results.input_speed, "rad/s", unit_fixed=True))
        yield Fact(
            Sentence("speed of the driven shaft"), Number(results.output_speed, "rad/s", unit_fixed=True)
        )


def _scalars(results: GearTrainResults) -> dict[str, Scalar]:
    train = results.chosen
    closed = {}
    if isinstance(train, ClosedTrain):
        closed = {"circulating_power": Scalar(train.circulating_power, "1")}
    return closed | {
        "trains": Scalar(float(len(results.found.trains)), "1"),
        "ratio": Scalar(results.whole_ratio(train), "1"),
        "deviation": Scalar(results.deviation(train), "1"),
        "efficiency": Scalar(results.efficiency(train), "1"),
        "diameter": Scalar(train.diameter * results.gear_train.module, "m"),
    }


def _notes(results: GearTrainResults) -> Iterator[Text]:
    train = results.chosen
    if isinstance(train, PlanetaryTrain) and train.driver == "carrier" and results.efficiency(train) > 0:
        reverse = PlanetaryTrain(train.scheme, train.teeth, train.planets, "sun")
        if reverse.efficiency(results.efficiencies) <= 0:
            yield Sentence("driven from the sun the train locks itself")


def _columns(trains: tuple[AnyTrain, ...], *, spelled: bool) -> Iterator[Column]:
    first = trains[0]
    letters: list[Text]
    if isinstance(first, PlanetaryTrain):
        letters = [Symbol("z", "1"), Symbol("z", "2"), Symbol("z'", "2"), Symbol("z", "3")]
        shown = [0, 1, 2, 3] if first.scheme.stepped else [0, 1, 3]
    else:
        two_sets = isinstance(first, CarrierSeries | ClosedTrain)
        shown = [0, 1, 3, 4, 5, 7] if two_sets else list(range(len(first.teeth)))
        letters = [
            Symbol("z", str(shown.index(place) + 1)) if place in shown else NOTHING for place in range(8)
        ]
    for place in shown:
        teeth = np.array([train.teeth[place] for train in trains], dtype=np.float64)
        name = f"teeth_{shown.index(place) + 1}"
        yield _whole_column(name, teeth, letters[place], spelled=spelled)


def _whole_column(name: str, values: Array, head: Text, *, spelled: bool) -> Column:
    """Whole numbers: each spelled by itself where people read them, as numbers in files."""
    if spelled:
        return Column(name, tuple(Number(value) for value in values.tolist()), head=head)
    return Column(name, values, head=head, whole=True)


def trains_table(results: GearTrainResults, most: int | None) -> Table:
    """The trains that have the ratio, the smallest first."""
    trains = results.found.trains[:most]
    module = results.gear_train.module
    length = Sentence("length") if isinstance(trains[0], OrdinaryTrain) else Sentence("diameter")
    return Table(
        (
            _whole_column(
                "number", np.arange(1.0, len(trains) + 1), Sentence("number"), spelled=most is not None
            ),
            *_columns(trains, spelled=most is not None),
            Column(
                "ratio", np.array([results.whole_ratio(train) for train in trains]), head=Sentence("ratio")
            ),
            Column(
                "deviation",
                np.array([100 * results.deviation(train) for train in trains]),
                head=Sentence("deviation, %"),
            ),
            Column("diameter", np.array([train.diameter * module for train in trains]), "m", head=length),
            Column(
                "efficiency",
                np.array([results.efficiency(train) for train in trains]),
                head=Sentence("efficiency"),
            ),
            *_circulating(trains),
        ),
        Sentence("Trains of this ratio, the smallest first"),
    )


def _circulating(trains: tuple[AnyTrain, ...]) -> Iterator[Column]:
    """The power that goes round in closed trains."""
    shares = [train.circulating_power for train in trains if isinstance(train, ClosedTrain)]
    if shares:
        yield Column("circulating_power", np.array(shares), head=Sentence("circulating power"))


def members_table(results: GearTrainResults) -> Table:
    """How fast each wheel and carrier of the chosen train turns."""
    motions = results.motions
    driver = results.input_speed
    return Table(
        (
            Column("member", tuple(shaft_text(one.members) for one in motions), head=Sentence("member")),
            Column(
                "speed",
                np.array([one.speed for one in motions]),
                "rad/s",
                head=Sentence("angular velocity"),
                unit_fixed=True,
            ),
            Column(
                "share",
                np.array([one.speed / driver for one in motions]),
                head=Sentence("over that of the driving shaft"),
            ),
        ),
        Sentence("Angular velocities"),
    )


def powers_table(train: ClosedTrain, results: GearTrainResults) -> Table:
    """What the members of a closed train carry: without losses, and power with those of the meshes."""
    ideal, lossy = train.powers(), train.powers(results.efficiencies)
    return Table(
        (
            Column("member", tuple(member_text(one.member) for one in ideal), head=Sentence("member")),
            Column("speed", np.array([one.speed for one in ideal]), head=Sentence("speed")),
            Column("moment", np.array([one.moment for one in ideal]), head=Sentence("moment")),
            Column("power", np.array([one.power for one in ideal]), head=Sentence("power into the set")),
            Column(
                "power_with_losses",
                np.array([one.power for one in lossy]),
                head=Sentence("the same with losses"),
            ),
        ),
        Sentence("Flow of power, over the driving shaft"),
    )


# Pictures


def _velocities(results: GearTrainResults) -> CurveDiagram:
    """Smirnov's triangles: velocities across the line of centres over the places on it, a line for each member."""
    traces = [
        Trace(
            shaft_text(one.members),
            one.velocities[np.argsort(one.places)],
            np.sort(one.places),
            marks=np.stack([one.velocities, one.places], axis=-1),
        )
        for one in results.motions
    ]
    reach = max(float(np.abs(one.velocities).max()) for one in results.motions)
    least = min(float(one.velocities.min()) for one in results.motions)
    return CurveDiagram(
        Sentence("Plan of linear velocities"),
        Title(results.gear_train.title),
        AxisLabel(Sentence("velocity across the line of centres"), unit="m/s"),
        AxisLabel(Sentence("along the line of centres"), unit="m"),
        tuple(traces),
        (1.08 * min(least, 0.0) - 0.02 * reach, 1.08 * reach),
    )


def _angular_velocities(results: GearTrainResults) -> CurveDiagram:
    """Rays from one pole, parallel to the lines of the velocities: they cut off the angular velocities."""
    traces = [
        Trace(
            shaft_text(one.members),
            np.array([0.0, one.speed]),
            np.array([-1.0, 0.0]),
            marks=np.array([[one.speed, 0.0]]),
        )
        for one in results.motions
    ]
    speeds = [one.speed for one in results.motions] + [0.0]
    room = 0.06 * (max(speeds) - min(speeds))
    return CurveDiagram(
        Sentence("Plan of angular velocities"),
        Title(results.gear_train.title),
        AxisLabel(Sentence("angular velocity"), unit="rad/s", unit_fixed=True),
        AxisLabel(Sentence("over the pole, in distances of the pole")),
        tuple(traces),
        (min(speeds) - room, max(speeds) + room),
    )


def _circle(layer: str, centre: tuple[float, float], radius: float) -> OutlinePiece:
    angles = np.linspace(0.0, 2 * math.pi, CIRCLE)
    arms = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    across = np.stack([-np.sin(angles), np.cos(angles)], axis=-1)
    return OutlinePiece(layer, angles, radius * arms + np.array(centre), radius * across)


def wheels_drawing(results: GearTrainResults) -> OutlineDrawing:
    """Pitch circles of the chosen train seen along the axes; stages stand beside each other."""
    train, radius = results.chosen, results.gear_train.module / 2
    pieces: list[OutlinePiece] = []
    arms: list[Array] = []
    right = 0.0
    if isinstance(train, OrdinaryTrain):
        axis = 0.0
        for driving, driven in train.pairs:
            pieces.append(_circle("profile", (axis, 0.0), driving * radius))
            axis += (driving + driven) * radius
            pieces.append(_circle("shoe", (axis, 0.0), driven * radius))
        right = axis
        layers = {"profile": Sentence("driving wheels"), "shoe": Sentence("driven wheels")}
    else:
        layers = {"profile": Sentence("central wheels"), "shoe": Sentence("planets")}
        stages = (train,) if isinstance(train, PlanetaryTrain) else train.stages
        for number, stage in enumerate(stages):
            middle = number * 1.1 * train.diameter * 2 * radius
            sun, planet, other, fixed = stage.teeth
            pieces += [_circle("profile", (middle, 0.0), one * radius) for one in (sun, fixed)]
            for place in range(stage.planets):
                angle = math.pi / 2 + 2 * math.pi * place / stage.planets
                arm = stage.arms[0] * radius
                centre = (middle + arm * math.cos(angle), arm * math.sin(angle))
                pieces += [_circle("shoe", centre, one * radius) for one in sorted({planet, other})]
                arms.append(np.array([(middle, 0.0), centre]))
    pair = results.gear_train.pair_behind
    if pair is not None and isinstance(train, OrdinaryTrain):
        pieces.append(_circle("profile", (right, 0.0), pair[0] * radius))
        pieces.append(_circle("shoe", (right + sum(pair) * radius, 0.0), pair[1] * radius))
    shapes = (DrawnLines(LineUse.AXIS, Sentence("carrier"), tuple(arms)),) if arms else ()
    return OutlineDrawing(
        Sentence("Pitch circles"),
        Title(results.gear_train.title),
        tuple(pieces),
        layers,
        shapes,
        Sentence("main axis"),
    )
