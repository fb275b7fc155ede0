"""Conclusions from the results of a mechanism: what turns, extremes of the motion, flywheel, reactions, balance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite, tau
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.dynamics.bearings.reaction_series import ReactionKind
from centrode.dynamics.motion_extremes import extremes_of_motion
from centrode.dynamics.steady_motion.machine import closing_balance
from centrode.errors import CentrodeError
from centrode.model.reading import FRAME
from centrode.sheets.sheet import Block, Chapter, Check, Items, Section
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Text
from centrode.views.drive_balance import driving_terms, factor_text
from centrode.views.instants import place_number
from centrode.views.reaction_names import reaction_text

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.bearings.extremes import BearingLoad
    from centrode.dynamics.motion_results import MotionResults
    from centrode.dynamics.steady_motion.machine import MachineResults
    from centrode.numerics.search import Extremes

Found: TypeAlias = "Mapping[tuple[str, str], Extremes]"

STILL = 1e-9
"""Radians, or part of the greatest length, by which what stands still may move."""
GREATEST = 3
"""Reactions that are named."""


def conclusions_chapter(results: MotionResults) -> Chapter:
    """What follows from the results, a sentence each."""
    machine = results.machine
    data = results.motion if machine is None else machine.steady
    extremes = extremes_of_motion(results, data)
    texts = [*_turning(results), *_strokes(results, extremes), *_swings(results, extremes)]
    texts += _angles_on_sphere(results, data, extremes)
    checks: list[Block] = []
    if machine is not None:
        texts += _flywheel(machine)
    if results.reactions is not None and results.reactions.loads:
        texts += _reactions(results, results.reactions.loads)
    if machine is not None:
        try:
            balance = closing_balance(machine)
        except CentrodeError:  # the links have no reactions: their chapter says why
            pass
        else:
            texts.append(_balance(results, balance))
            checks.append(_balance_check(balance))
    return Chapter(
        Sentence("Conclusions"), (Section(NOTHING, (Items(tuple(texts), numbered=True), *checks)),)
    )


def _at(results: MotionResults, place: float) -> Number:
    return Number(place, results.mechanism.motion_parameter.instant.unit, ".4g", degrees_too=True)


# The motion


def _turning(results: MotionResults) -> Iterator[Text]:
    """Whether the drive turns fully, or what bounds it."""
    mechanism, parameter = results.mechanism, results.mechanism.motion_parameter
    names = Joined([Name(drive.name) for drive in parameter.drives])
    if results.unreached_samples and results.limits:
        places = Joined([place_number(end.value, parameter.variable.unit) for end in results.limits], "; ")
        yield Sentence("The mechanism does not turn fully: its motion is bounded at {places}.", places=places)
        return
    if results.unreached_samples:
        yield Sentence("The mechanism does not reach every position of the range that is studied.")
        return
    turns = False
    if len(mechanism.drives) == 1 and parameter.is_uniform and parameter.variable.unit == "rad":
        turns = float(np.ptp(parameter.values(results.motion))) >= tau - STILL
    if not turns:
        yield Sentence("The mechanism reaches every position of the range that is studied.")
    elif results.comes_back:
        yield Sentence(
            "The drive {drive} turns fully; after a turn the mechanism is back in its first position.",
            drive=names,
        )
    else:
        yield Sentence(
            "The drive {drive} turns fully; after a turn the mechanism is not yet back in its first position.",
            drive=names,
        )


def _rates(results: MotionResults, velocity: Extremes, acceleration: Extremes) -> dict[str, Text] | None:
    """Greatest velocity and acceleration with their places; None where one of them is nothing."""
    (speed, faster), (rise, steeper) = _in_size(velocity), _in_size(acceleration)
    if not (isfinite(speed) and isfinite(rise) and speed and rise):
        return None
    return {
        "at": _at(results, faster),
        "there": _at(results, steeper),
        "v": Number(speed, digits=".4g"),
        "a": Number(rise, digits=".4g"),
    }


def _in_size(found: Extremes) -> tuple[float, float]:
    """The value that is greatest in size, and its place."""
    if abs(found.least) > abs(found.greatest):
        return found.least, found.at_least
    return found.greatest, found.at_greatest


def _of_unit(values: dict[str, Text], **units: str) -> dict[str, Text]:
    numbers = {name: values[name] for name in units}
    return values | {
        name: Number(number.value, units[name], number.digits)
        for name, number in numbers.items()
        if isinstance(number, Number)
    }


def _strokes(results: MotionResults, extremes: Found) -> Iterator[Text]:
    """Of each slider on a guide of the frame: stroke, greatest velocity and acceleration with their places."""
    unit = "m" if results.mechanism.space == "plane" else "rad"
    for guide in results.mechanism.guides:
        if guide.on != FRAME or ("slide", guide.id) not in extremes:
            continue
        stroke = extremes["slide", guide.id].range
        rates = _rates(
            results, extremes["slide_velocity", guide.id], extremes["slide_acceleration", guide.id]
        )
        if (
            results.unreached_samples and stroke > STILL
        ):  # towards a limit velocities may grow beyond all bounds
            yield Sentence(
                "Point {name} travels {stroke} along its guide in the part of the motion that is reached.",
                name=Name(guide.point),
                stroke=Number(stroke, unit, ".4g"),
            )
        elif stroke > STILL and rates is not None:
            yield Sentence(
                "Point {name} on its guide: the stroke is {stroke}; the velocity is greatest in magnitude at {at},"
                " {v}, the acceleration at {there}, {a}.",
                name=Name(guide.point),
                stroke=Number(stroke, unit, ".4g"),
                **_of_unit(rates, v=f"{unit}/s", a=f"{unit}/s^2"),
            )


def _swings(results: MotionResults, extremes: Found) -> Iterator[Text]:
    """Of each link that swings about a point of the frame: its angle, greatest rates with their places."""
    mechanism = results.mechanism
    driven = {drive.link for drive in mechanism.drives}
    fixed = set(mechanism.frame.points)
    if mechanism.space != "plane" or results.unreached_samples:
        return
    for name, link in mechanism.links.items():
        if name in driven or not fixed & set(link.points) or ("angle", name) not in extremes:
            continue
        swing = extremes["angle", name].range
        rates = _rates(results, extremes["angular_velocity", name], extremes["angular_acceleration", name])
        if not STILL < swing < tau - STILL or rates is None:
            continue
        yield Sentence(
            "Link {name} swings through {swing}; its angular velocity is greatest in magnitude at {at}, {v}, its"
            " angular acceleration at {there}, {a}.",
            name=Name(name),
            swing=Number(swing, "rad", ".4g"),
            **_of_unit(rates, v="rad/s", a="rad/s^2"),
        )


def _angles_on_sphere(results: MotionResults, data: xarray.Dataset, extremes: Found) -> Iterator[Text]:
    """Of each link that swings about a hinge of the frame, and of each hinge of moving links: extremes of the angle."""
    if results.mechanism.space != "sphere" or results.unreached_samples:
        return
    driven = {drive.link for drive in results.mechanism.drives}
    for kind in ("joint", "hinge"):
        for name in data[kind].values.tolist() if kind in data else ():
            if kind == "joint" and name in driven:
                continue
            angle, *derivatives = (
                extremes[f"{kind}_{word}", name] for word in ("angle", "velocity", "acceleration")
            )
            rates = _rates(results, *derivatives)
            if not STILL < angle.range < tau - STILL or rates is None:
                continue
            yield _ANGLES[kind].fill(
                name=Name(name),
                swing=Number(angle.range, "rad", ".4g"),
                least=Number(angle.least, "rad", ".4g"),
                at_least=_at(results, angle.at_least),
                greatest=Number(angle.greatest, "rad", ".4g"),
                at_greatest=_at(results, angle.at_greatest),
                **_of_unit(rates, v="rad/s", a="rad/s^2"),
            )


_ANGLES: Mapping[str, Sentence] = {
    "joint": Sentence(
        "Link {name} swings through {swing}: its angle is least at {at_least}, {least}, and greatest at {at_greatest},"
        " {greatest}; its angular velocity is greatest in magnitude at {at}, {v}, its angular acceleration at {there},"
        " {a}."
    ),
    "hinge": Sentence(
        "The angle between links {name} at their hinge varies by {swing}: it is least at {at_least}, {least}, and"
        " greatest at {at_greatest}, {greatest}; its rate is greatest in magnitude at {at}, {v}, its second derivative"
        " at {there}, {a}."
    ),
}


# The machine


def _flywheel(machine: MachineResults) -> Iterator[Text]:
    """Driving moment, inertia that is needed, sizes of the flywheel."""
    wheel = machine.flywheel
    yield Sentence(
        "The loads take {work} in a cycle; the mean driving moment is {moment}.",
        work=Number(abs(wheel.work_of_loads), "J", ".5g"),
        moment=Number(wheel.driving_moment, "N m", ".5g"),
    )
    if wheel.inertia is None or wheel.fluctuation is None or wheel.added is None:
        return
    needed = {
        "speed": Number(wheel.mean_speed, "rad/s", ".4g", unit_fixed=True),
        "fluctuation": Number(wheel.fluctuation, digits=".4g"),
        "inertia": Number(wheel.inertia, "kg m^2", ".5g"),
        "present": Number(wheel.present, "kg m^2", ".5g"),
    }
    if wheel.added == 0:
        yield Sentence(
            "At the mean speed {speed} the coefficient of fluctuation {fluctuation} needs {inertia} at the drive;"
            " {present} is there, so no flywheel is needed.",
            **needed,
        )
        return
    yield Sentence(
        "At the mean speed {speed} the coefficient of fluctuation {fluctuation} needs {inertia} at the drive;"
        " {present} is there, so the flywheel has {added}.",
        **needed,
        added=Number(wheel.added, "kg m^2", ".5g"),
    )
    if wheel.rim is not None:
        yield Sentence(
            "As a rim the flywheel has the outer diameter {outer}, the width {width} and the mass {mass}.",
            outer=Number(wheel.rim.outer, "m", ".4g"),
            width=Number(wheel.rim.width, "m", ".4g"),
            mass=Number(wheel.rim.mass, "kg", ".4g"),
        )


# The forces


def _reactions(results: MotionResults, loads: tuple[BearingLoad, ...]) -> Iterator[Text]:
    """The greatest forces in joints, and what the drives must give at most, with their places."""
    forces = [
        load
        for load in loads
        if load.kind in (ReactionKind.HINGE, ReactionKind.PIN, ReactionKind.GUIDE_NORMAL)
    ]
    known = [load for load in forces if load.unit == "N" and isfinite(_size(load)[0]) and _size(load)[0] > 0]
    greatest = sorted(known, key=lambda load: -_size(load)[0])[:GREATEST]
    if greatest:
        told = [
            Sentence(
                "{force} at {place} ({reaction})",
                reaction=reaction_text(load),
                force=Number(_size(load)[0], load.unit, ".4g"),
                place=_at(results, _size(load)[1]),
            )
            for load in greatest
        ]
        yield Sentence("The greatest reactions: {reactions}.", reactions=Joined(told, "; "))
    for load in loads:
        if load.kind is ReactionKind.BALANCING and isfinite(_size(load)[0]):
            values: dict[str, Text] = {
                "drive": Name(load.names[0]),
                "greatest": Number(_size(load)[0], load.unit, ".4g"),
                "place": _at(results, _size(load)[1]),
            }
            if load.unit == "N m":
                yield Sentence(
                    "The balancing moment at the drive {drive} is greatest in magnitude at {place}, {greatest}.",
                    **values,
                )
            else:
                yield Sentence(
                    "The balancing force at the drive {drive} is greatest in magnitude at {place}, {greatest}.",
                    **values,
                )


def _size(load: BearingLoad) -> tuple[float, float]:
    """The greatest magnitude of a reaction, and where."""
    greatest, least = (abs(load.greatest), load.at_greatest), (abs(load.least), load.at_least)
    return greatest if greatest[0] >= least[0] else least


def _balance(results: MotionResults, here: xarray.Dataset) -> Text:
    """The closing balance with its numbers."""
    links, inertia, acceleration, _driving = driving_terms(here)
    numbers: dict[str, Text] = {
        "links": Number(links, "N m", ".6g", unit_hidden=True),
        "inertia": Number(inertia, "kg m^2", ".6g", unit_hidden=True),
        "acceleration": factor_text(Number(acceleration, "1", ".5g")),
        "driving": Number(links + inertia * acceleration, "N m", ".5g"),
    }
    return Sentence(
        "The machine closes at {place}: the balancing moment of the links and the inertia moment of what turns with the"
        " drive are the driving moment, {links} + {inertia} · {acceleration} = {driving}.",
        place=_at(results, float(here["drive_value"].values[0])),
        **numbers,
    )


def _balance_check(here: xarray.Dataset) -> Check:
    statement = Sentence(
        "The balancing moment of the links, by the equilibrium of each, and the inertia moment of the flywheel are the"
        " driving moment, by the work of a cycle, within {share}."
    )
    residual, error = (float(here.attrs[f"driving_{name}"]) for name in ("residual", "error"))
    return Check(statement, residual, 1.0, error + float(here["reaction_loss"]))
