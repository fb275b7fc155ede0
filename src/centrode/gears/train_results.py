"""Everything that is computed of a train of gears that is sought by its ratio."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from centrode.errors import InputError, MotionError
from centrode.gears.closed_trains import ClosedTrain, set_of
from centrode.gears.involutes import Array
from centrode.gears.planetary_trains import (
    CarrierSeries,
    MeshEfficiency,
    OrdinaryTrain,
    PlanetaryTrain,
)
from centrode.gears.train_search import AnyTrain, FoundTrains, TrainBounds, find_trains
from centrode.locale import _, ngettext
from centrode.model.examples.catalogue import GearTrainSource, gear_train_of
from centrode.model.gear_trains import ORDINARY, GearTrain

ROUNDING = 1e-12
"""Deviations of a ratio below this are those of its decimal numbers."""


@dataclass(frozen=True, eq=False)
class MemberMotion:
    """How a wheel or a carrier turns, and where it has which velocity.

    Attributes
    ----------
    members : ("wheel 1",), ("planet 1",), ...; two of a joined shaft of a closed train; ("crank",) behind a pair
    speed : angular velocity [rad/s]
    places : (n) on the line of centres from the first axis [m]: its own axis, its contacts
    velocities : (n) across that line [m/s]
    """

    members: tuple[str, ...]
    speed: float
    places: Array
    velocities: Array


@dataclass(frozen=True)
class GearTrainResults:
    """A described train with everything that is computed of it.

    Attributes
    ----------
    gear_train : GearTrain
        The description.
    found : FoundTrains
        All trains that have the ratio, the smallest first.
    """

    gear_train: GearTrain
    found: FoundTrains

    @property
    def chosen(self) -> AnyTrain:
        """The train that is shown in full."""
        return self.found.trains[self.gear_train.chosen - 1]

    @property
    def efficiencies(self) -> MeshEfficiency:
        """Of the meshes, as described."""
        losses = self.gear_train.mesh_efficiency
        return MeshEfficiency(losses.external, losses.internal)

    @property
    def ratio_behind(self) -> float:
        """That of the pair behind the train, with its sign; 1 without one."""
        pair = self.gear_train.pair_behind
        return 1.0 if pair is None else -pair[1] / pair[0]

    def whole_ratio(self, train: AnyTrain) -> float:
        """From the motor to the crank, with its sign."""
        return float(train.ratio) * self.ratio_behind

    def deviation(self, train: AnyTrain) -> float:
        """By how much its ratio exceeds that which is sought, relative."""
        share = abs(self.whole_ratio(train) / self.gear_train.whole_ratio) - 1
        return share if abs(share) > ROUNDING else 0.0

    def efficiency(self, train: AnyTrain) -> float:
        """From the motor to the crank."""
        behind = 1.0 if self.gear_train.pair_behind is None else self.efficiencies.external
        return train.efficiency(self.efficiencies) * behind

    @property
    def input_speed(self) -> float:
        """Of what drives [rad/s]; by the speed of the crank where that alone is given, 1 where none is."""
        described = self.gear_train
        if described.input_speed is not None:
            return described.input_speed
        if described.output_speed is not None:
            return described.output_speed * abs(self.whole_ratio(self.chosen))
        return 1.0

    @property
    def output_speed(self) -> float:
        """Of what is driven [rad/s], negative against what drives."""
        return self.input_speed / self.whole_ratio(self.chosen)

    @cached_property
    def motions(self) -> tuple[MemberMotion, ...]:
        """How every wheel and carrier of the chosen train turns."""
        radius, train = self.gear_train.module / 2, self.chosen
        if isinstance(train, OrdinaryTrain):
            moves = _ordinary_motions(train, radius, self.input_speed)
        elif isinstance(train, CarrierSeries):
            first, second = train.stages
            middle = self.input_speed / float(first.ratio)
            moves = [
                *_planetary_motions(first, radius, self.input_speed, 1),
                *_planetary_motions(second, radius, middle, 2),
            ]
        elif isinstance(train, ClosedTrain):
            moves = _closed_motions(train, radius, self.input_speed)
        else:
            moves = _planetary_motions(train, radius, self.input_speed, 1)
        pair = self.gear_train.pair_behind
        if pair is not None:
            axis = 0.0 if not isinstance(train, OrdinaryTrain) else moves[-1].places[0]
            speed = self.input_speed / float(train.ratio)
            # The driving wheel of the pair sits on the last shaft, which is there already.
            moves.append(_pair_motions(pair, radius, speed, axis, "", "crank")[1])
        return tuple(moves)


def _line(member: str, speed: float, axis: float, places: list[float]) -> MemberMotion:
    """A body that turns about an axis of the frame."""
    at = np.array([axis, *places])
    return MemberMotion((member,), speed, at, speed * (at - axis))


def _planetary_motions(
    train: PlanetaryTrain, radius: float, input_speed: float, stage: int
) -> list[MemberMotion]:
    sun, _planet, _other, fixed = train.teeth
    carrier = input_speed / float(train.sun_ratio) if train.driver == "sun" else input_speed
    arm = train.arms[0] * radius
    rolls = carrier * float(train.planet_ratio)
    # The planets touch the fixed wheel where they are at rest.
    at = np.array([arm, sun * radius, fixed * radius])
    planets = MemberMotion((f"planet {stage}",), rolls, at, carrier * arm + rolls * (at - arm))
    return [
        _line(f"wheel {stage}", carrier * float(train.sun_ratio), 0.0, [sun * radius]),
        planets,
        _line(f"carrier {stage}", carrier, 0.0, [arm]),
    ]


def _closed_motions(train: ClosedTrain, radius: float, input_speed: float) -> list[MemberMotion]:
    """The shafts that turn, then the planets of both sets."""
    speeds = {member: input_speed * float(speed) for member, speed in train.speeds.items()}
    moves = []
    for shaft in train.shafts.shafts:
        contacts = {_contact_radius(train, member) for member in shaft}
        at = np.array([0, *sorted(contacts)]) * radius
        if train.speeds[shaft[0]]:
            moves.append(MemberMotion(shaft, speeds[shaft[0]], at, speeds[shaft[0]] * at))
    for number, stage in enumerate(train.stages, 1):
        sun, planet, _other, ring = stage.teeth
        carrier = speeds[f"carrier {number}"]
        rolls = carrier + (carrier - speeds[f"sun {number}"]) * sun / planet
        at = np.array([stage.arms[0], sun, ring]) * radius
        moves.append(MemberMotion((f"planet {number}",), rolls, at, carrier * at[0] + rolls * (at - at[0])))
    return moves


def _contact_radius(train: ClosedTrain, member: str) -> int:
    """Where a member meets its planets, in half modules: at their axes where it is the carrier."""
    stage = train.stages[set_of(member)]
    return {"sun": stage.teeth[0], "ring": stage.teeth[3], "carrier": stage.arms[0]}[member.split()[0]]


def _ordinary_motions(train: OrdinaryTrain, radius: float, speed: float) -> list[MemberMotion]:
    axis, moves = 0.0, []
    for number, (driving, driven) in enumerate(train.pairs):
        names = f"wheel {2 * number + 1}", f"wheel {2 * number + 2}"
        moves += _pair_motions((driving, driven), radius, speed, axis, *names)
        axis += (driving + driven) * radius
        speed *= -driving / driven
    return moves


def _pair_motions(
    pair: tuple[int, int], radius: float, speed: float, axis: float, driving: str, driven: str
) -> list[MemberMotion]:
    contact = axis + pair[0] * radius
    other = contact + pair[1] * radius
    return [
        _line(driving, speed, axis, [contact]),
        _line(driven, -speed * pair[0] / pair[1], other, [contact]),
    ]


def gear_train(source: GearTrainSource) -> GearTrainResults:
    """Trains of gears of a ratio: all numbers of teeth within the bounds, the smallest first.

    Parameters
    ----------
    source : GearTrain, file or name of an example

    Returns
    -------
    GearTrainResults

    Raises
    ------
    InputError
        A description that is none; a number of a chosen train beyond the list.
    MotionError
        No train within the bounds has the ratio; the nearest one is given.

    Examples
    --------
    >>> import centrode as ct
    >>> train = ct.gear_train("single-planet-train").chosen
    >>> train.teeth, float(train.ratio)
    ((17, 28, 28, 73), 5.294117647058823)
    """
    described = gear_train_of(source)
    least, most = described.teeth
    planets = 1 if described.scheme in ORDINARY else described.planets
    bounds = TrainBounds(described.train_ratio, described.tolerance, least, most, planets)
    found = find_trains(described.scheme, bounds, described.driver, described.shafts)
    results = GearTrainResults(described, found)
    if not found.trains:
        raise MotionError("ratio", *_nothing_found(results))
    if described.chosen > len(found.trains):
        what = ngettext("there is {count} train", "there are {count} trains", len(found.trains))
        raise InputError("chosen", what.format(count=len(found.trains)), _("choose one of them"))
    return results


def _nothing_found(results: GearTrainResults) -> tuple[str, str]:
    """What is not there, and the nearest train."""
    described, nearest = results.gear_train, results.found.nearest
    what = _(
        "no train of this scheme with {least} to {most} teeth has the ratio {ratio:.6g} within {share:.3g} %"
    )
    least, most = described.teeth
    said = what.format(least=least, most=most, ratio=described.whole_ratio, share=100 * described.tolerance)
    if nearest is None:
        return said, _("allow other numbers of teeth or planets, or take another scheme")
    repair = _(
        "the nearest is {ratio:.6g} with {teeth} teeth; allow other numbers of teeth, or take another scheme"
    )
    teeth = ", ".join(str(number) for number in nearest.teeth)
    return said, repair.format(ratio=results.whole_ratio(nearest), teeth=teeth)
