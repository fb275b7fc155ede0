"""A train of gears as a mechanism that moves: axes, wheels with a mark, carriers; alone, or before a machine."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from centrode.errors import InputError
from centrode.gears.closed_trains import ClosedTrain, set_of
from centrode.gears.planetary_trains import CarrierSeries, OrdinaryTrain, PlanetaryTrain
from centrode.gears.train_results import GearTrainResults
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import document, mechanism_from
from centrode.model.mechanism import Mechanism

USUAL_SPEED = math.tau
"""Of what drives where none is given [rad/s]: a turn in a second."""
MOST_TURNS = 200
"""Of what drives, over which a train alone is shown."""
DRIVE = "drive"
"""What a table of a load may be over, and one of a moment is where it says nothing."""
MOST_TURNS_OF_CYCLE = 60
"""Turns of the drive that steady motion looks for a cycle in."""
AXIS, CRANK_AXIS, CRANK = "M", "N", "crank"


class _Parts:
    """Points, links and gears of a mechanism while it is put together.

    The main axis is the point M; wheel n has the mark Wn, carrier n ends in An, planet n has the mark Pn.
    """

    def __init__(self, module: float, axis: tuple[float, float] = (0.0, 0.0)) -> None:
        self.radius = module / 2
        self.axis = axis
        self.points: dict[str, Any] = {AXIS: list(axis)}
        self.links: dict[str, Any] = {}
        self.gears: list[dict[str, Any]] = []

    def wheel(self, name: str, centre: str, mark: str, teeth: int) -> None:
        """A wheel about a point, with a mark on its pitch circle."""
        points = {centre: [0.0, 0.0], mark: [teeth * self.radius, 0.0]}
        self.links[name] = {"points": points, "angle": 0.0}

    def gear(self, first: str, second: str, ratio: float, carrier: str = "frame") -> None:
        """A gear between two links."""
        self.gears.append({"links": [first, second], "ratio": ratio, "carrier": carrier})

    def planetary_stage(self, train: PlanetaryTrain, sun: str, number: int) -> str:
        """A planetary stage of which one planet stands for all; returns its carrier."""
        scheme = train.scheme
        own, planet, other, fixed = train.teeth
        carrier, rolling, end = f"carrier-{number}", f"planet-{number}", f"A{number}"
        if sun not in self.links:
            self.wheel(sun, AXIS, f"W{number}", own)
        arm = {AXIS: [0.0, 0.0], end: [train.arms[0] * self.radius, 0.0]}
        self.links[carrier] = {"points": arm, "angle": 0.0}
        self.wheel(rolling, end, f"P{number}", max(planet, other))
        self.gear(sun, rolling, scheme.sun * own / planet, carrier)
        self.gear(rolling, "frame", scheme.fixed * other / fixed, carrier)
        return carrier

    def closed_train(self, train: ClosedTrain) -> tuple[str, str]:
        """Both sets of a closed train, with one planet each; returns what drives and what is driven.

        A shaft is called by its first member; what is at rest is the frame.
        """
        shafts = train.shafts
        links = {member: shaft[0].replace(" ", "-") for shaft in shafts.shafts for member in shaft}
        links |= dict.fromkeys(shafts.shaft(shafts.fixed), "frame")
        for shaft in shafts.shafts:
            points = {AXIS: [0.0, 0.0]} | dict(self._mark(train, member) for member in shaft)
            if links[shaft[0]] == "frame":
                self.points |= {
                    name: [self.axis[0] + place[0], self.axis[1]]
                    for name, place in points.items()
                    if name.startswith("A")
                }
            else:
                self.links[links[shaft[0]]] = {"points": points, "angle": 0.0}
        for number, stage in enumerate(train.stages, 1):
            own, planet, _other, ring = stage.teeth
            sun, outer, carrier = (links[f"{part} {number}"] for part in ("sun", "ring", "carrier"))
            rolling = f"planet-{number}"
            self.wheel(rolling, f"A{number}", f"P{number}", planet)
            self.gear(sun, rolling, -own / planet, carrier)
            self.gear(rolling, outer, planet / ring, carrier)
        return links[shafts.input], links[shafts.output]

    def _mark(self, train: ClosedTrain, member: str) -> tuple[str, list[float]]:
        """A point of a member that shows how it turns: on a pitch circle, or the planet's axis of a carrier."""
        stage, number = train.stages[set_of(member)], set_of(member) + 1
        letter, radius = {
            "sun": ("W", stage.teeth[0]),
            "ring": ("R", stage.teeth[3]),
            "carrier": ("A", stage.arms[0]),
        }[member.split()[0]]
        return f"{letter}{number}", [radius * self.radius, 0.0]

    def shaft(self, driving: str, number: int, teeth: tuple[int, int], along: float) -> float:
        """A shaft that an external wheel drives, on an axis to the right; returns how far that lies from the first."""
        there = along + sum(teeth) * self.radius
        centre, name = f"{AXIS}{number}", f"shaft-{number}"
        self.points[centre] = [self.axis[0] + there, self.axis[1]]
        self.wheel(name, centre, f"W{number}", teeth[1])
        self.gear(driving, name, -teeth[0] / teeth[1])
        return there

    def train(self, results: GearTrainResults) -> tuple[str, str, float]:
        """All of the chosen train: what drives, what is driven, and how far that lies from the main axis."""
        train = results.chosen
        if isinstance(train, OrdinaryTrain):
            self.wheel("shaft-1", AXIS, "W1", train.pairs[0][0])
            along = 0.0
            for number, teeth in enumerate(train.pairs, 2):
                along = self.shaft(f"shaft-{number - 1}", number, teeth, along)
            return "shaft-1", f"shaft-{len(train.pairs) + 1}", along
        if isinstance(train, ClosedTrain):
            return *self.closed_train(train), 0.0
        stages = train.stages if isinstance(train, CarrierSeries) else (train,)
        last = "wheel-1"
        for number, stage in enumerate(stages, 1):
            last = self.planetary_stage(stage, last, number)
        if stages[0].driver == "carrier":
            return last, "wheel-1", 0.0
        return "wheel-1", last, 0.0


def train_mechanism(results: GearTrainResults, machine: MechanismSource | None = None) -> Mechanism:
    """The chosen train as a mechanism whose driven link turns once; or a machine that it drives.

    What drives is the link "wheel-1", "carrier-1" or "shaft-1", of a closed train that of its first member, such as
    "sun-1"; one planet stands for all of a stage; behind a pair the driven link is "crank".

    Parameters
    ----------
    results : GearTrainResults
    machine : Mechanism, or the name of its file or of a built-in one
        In the plane, with one drive, which turns a link about a point of the frame at a constant speed. The pair behind
        the train turns that link. The motor's angle is the new drive, zero where the crank's is that of its start; the
        crank keeps its sense. Range, instants, loads by the angle of the crank and `[machine]` are converted to the
        motor: its mean speed and the ratios of its shafts. `[machine]` is omitted where the crank returns only after
        more than 60 turns of the motor: a cycle has whole turns of the drive.

    Raises
    ------
    InputError
        Of a machine: a train without a pair behind it; another kind of machine; names that both have.

    Examples
    --------
    >>> import centrode as ct
    >>> list(ct.train_mechanism(ct.gear_train("single-planet-train")).links)
    ['wheel-1', 'carrier-1', 'planet-1', 'crank']
    """
    if machine is not None:
        return _machine_with_train(results, mechanism_of(machine))
    described = results.gear_train
    parts = _Parts(described.module)
    driver, last, along = parts.train(results)
    if described.pair_behind is not None:
        driving, driven = described.pair_behind
        parts.points[CRANK_AXIS] = [along + (driving + driven) * parts.radius, 0.0]
        parts.wheel(CRANK, CRANK_AXIS, "C1", driven)
        parts.gear(last, CRANK, -driving / driven)
    turns = min(abs(results.whole_ratio(results.chosen)), MOST_TURNS)
    has_speed = described.input_speed is not None or described.output_speed is not None
    tables: Mapping[str, Any] = {
        "title": described.title,
        "display": {"length": "mm", "angle": "deg"},
        "frame": {"points": parts.points},
        "links": parts.links,
        "gears": parts.gears,
        "drives": [
            {"link": driver, "start": 0.0, "speed": results.input_speed if has_speed else USUAL_SPEED}
        ],
        "study": {"from": 0.0, "to": turns * math.tau},
    }
    return mechanism_from(tables)


def _machine_with_train(results: GearTrainResults, mechanism: Mechanism) -> Mechanism:
    described = results.gear_train
    if described.pair_behind is None:
        what = _("the train has no pair behind it, which could turn the crank")
        raise InputError(
            "pair_behind", what, _("give the numbers of teeth of a pair: pair_behind = [15, 30]")
        )
    tables = document(mechanism)
    drive, crank, centre = _crank_of(mechanism, tables)
    driving, driven = described.pair_behind
    ratio = results.whole_ratio(results.chosen)
    apart = (driving + driven) * described.module / 2
    place = tables["frame"]["points"][centre]
    # The train lies to the left of the crank: first its length, then the pair.
    measure = _Parts(described.module)
    along = measure.train(results)[2]
    parts = _Parts(described.module, (place[0] - apart - along, place[1]))
    driver, last, _along = parts.train(results)
    parts.gear(last, crank, -driving / driven)
    for own, added in ((tables["frame"]["points"], parts.points), (tables["links"], parts.links)):
        both = sorted(set(own) & set(added))
        if both:
            what = _("machine and train both have {name}").format(name=both[0])
            raise InputError("machine", what, _("give it another name"))
        own.update(added)
    tables["gears"] = [*tables.get("gears", []), *parts.gears]
    start, speed = float(drive.get("start", 0.0)), float(drive["speed"])
    tables["links"][crank]["angle"] = start
    if described.input_speed is not None or described.output_speed is not None:
        speed = math.copysign(results.input_speed / abs(ratio), speed)
    tables["drives"] = [{"link": driver, "start": 0.0, "speed": speed * ratio}]
    _convert_study(tables, start, ratio)
    tables["loads"] = [_load_of_motor(load, start, ratio) for load in tables.get("loads", [])]
    if "machine" in tables:
        if _motor_turns(results) <= MOST_TURNS_OF_CYCLE:
            tables["machine"] = _machine_of_motor(tables["machine"], start, ratio)
        else:
            del tables["machine"]
    return mechanism_from(tables)


def _motor_turns(results: GearTrainResults) -> int:
    """Whole turns of the motor after which the crank is where it was."""
    driving, driven = results.gear_train.pair_behind or (1, 1)
    return abs((results.chosen.ratio * Fraction(driven, driving)).numerator)


def _formula_of_motor(formula: str, start: float, ratio: float, speed: str = "") -> str:
    """A formula of the crank's angle q, and of its speed where that has a letter, as one of the motor's."""
    formula = re.sub(r"\bq\b", f"({start!r} + q/({ratio!r}))", formula)
    return re.sub(rf"\b{speed}\b", f"({speed}/({ratio!r}))", formula) if speed else formula


def _load_of_motor(load: dict[str, Any], start: float, ratio: float) -> dict[str, Any]:
    """A load whose formulas of the crank's angle are such of the motor's."""
    if "table" in load and load.get("over", DRIVE if load.get("kind") == "torque" else "") == DRIVE:
        what = _("a load of the machine has a table over the angle of its crank")
        raise InputError("machine", what, _("give it as a formula of q, or over a displacement"))
    changed: dict[str, Any] = {}
    for key in ("vector", "value"):
        value = load.get(key)
        if isinstance(value, list):
            changed[key] = [
                _formula_of_motor(one, start, ratio) if isinstance(one, str) else one for one in value
            ]
        elif isinstance(value, str):
            changed[key] = _formula_of_motor(value, start, ratio)
    return load | changed


def _machine_of_motor(machine: dict[str, Any], start: float, ratio: float) -> dict[str, Any]:
    """[machine] with speeds and ratios over the motor in place of the crank."""
    size = abs(ratio)
    made = dict(machine)
    if "mean_speed" in made:
        made["mean_speed"] = made["mean_speed"] * size
    made["shafts"] = [
        shaft | {"ratio": shaft.get("ratio", 1.0) / size} for shaft in machine.get("shafts", [])
    ]
    wheel = machine.get("flywheel", {})
    made["flywheel"] = wheel | {"ratio": wheel.get("ratio", 1.0) / size}
    if "driving" in made:
        made["driving"] = _formula_of_motor(made["driving"], start, ratio, "v")
    return made


def _crank_of(mechanism: Mechanism, tables: dict[str, Any]) -> tuple[dict[str, Any], str, str]:
    """The drive, the link that it turns, and the point of the frame about which it does."""
    drives = tables.get("drives", [])
    link = str(drives[0].get("link")) if len(drives) == 1 else ""
    if (
        mechanism.space == "plane"
        and link in mechanism.links
        and isinstance(drives[0].get("speed"), float)
        and "relative_to" not in drives[0]
    ):
        for point in mechanism.links[link].points:
            if point in tables["frame"]["points"]:
                return drives[0], link, point
    what = _("a train drives a plane machine with one drive that turns a link about a point of the frame")
    raise InputError("machine", what, _("choose such a machine"))


def _convert_study(tables: dict[str, Any], start: float, ratio: float) -> None:
    """What was said of the crank is said of the motor."""
    study = tables.get("study", {})
    for key in ("from", "to"):
        if key in study:
            study[key] = (study[key] - start) * ratio
    if "to" not in study and "range" not in study:
        study |= {"from": 0.0, "to": math.tau * abs(ratio)}
    if study.get("from", 0.0) > study.get("to", 0.0):
        study["from"], study["to"] = study["to"], study["from"]
    if "instants" in study:
        # Those of the first turn of the crank from its start, in the sense of the motor.
        turn = math.tau * abs(ratio)
        study["instants"] = [((instant - start) * ratio) % turn for instant in study["instants"]]
    tables["study"] = study
