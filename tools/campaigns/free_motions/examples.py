"""Every planar example left to gravity by forward dynamics: its energy, its states by a second way, its way back."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

import centrode as ct
from centrode.dynamics.forward_dynamics.free_motion import free_motion_of
from centrode.model.files import mechanism_text
from tools.campaigns.campaign import Campaign, Outcome
from tools.campaigns.free_motions.cases import (
    COLUMNS,
    DRIFT,
    DURATION,
    GAP,
    GRAVITY,
    TOLERANCE,
    Parts,
    compare,
    refuse,
    weight_times_length,
)

LEAST = 0.5
"""Length of a link with one point, and of a roller, as rods [m]."""


@cache
def names() -> tuple[str, ...]:
    """The planar linkages, each a case."""
    return tuple(name for name in ct.example_names() if ct.example(name).space == "plane")


def span_of(link: Any) -> float:
    """Greatest distance of two points of a link [m]."""
    places = np.array(list(link.coordinates.values()), dtype=np.float64)
    return float(np.max(np.linalg.norm(places[:, None] - places, axis=-1))) or LEAST


def fallen(mechanism: ct.Mechanism, *, all_rods: bool) -> ct.Mechanism:
    """An example without loads, under gravity; its links are rods of 1 kg/m, all of them or those without mass."""
    links = {}
    for name, link in mechanism.links.items():
        own = link.mass or link.inertia or link.masses
        length = span_of(link)
        centre = tuple(float(x) for x in np.mean(list(link.coordinates.values()), axis=0))
        rod = {"mass": length, "centre": centre, "inertia": length**3 / 12.0, "shape": None, "masses": ()}
        links[name] = link if own and not all_rods else link.model_copy(update=rod)
    # dense equations have places of links alone, and what has no mass may run away: a loose pin gets a roller
    carried = {point for link in mechanism.links.values() for point in link.points}
    for pin in [guide.point for guide in mechanism.guides if guide.point not in carried]:
        roller = {"points": {pin: (0.0, 0.0)}, "angle": 0.0, "mass": LEAST, "inertia": LEAST**3 / 12.0}
        links[f"roller {pin}"] = ct.Link(**roller)
    update = {"links": links, "loads": (), "gravity": (0.0, -GRAVITY), "machine": None, "simulation": None}
    return ct.parse_mechanism(mechanism_text(mechanism.model_copy(update=update)))


def parts_of(mechanism: ct.Mechanism) -> Parts:
    """What dense equations ask for: places, masses and constraints as plain numbers."""
    return {
        "gravity": mechanism.gravity,
        "frame": {"points": dict(mechanism.frame.coordinates)},
        "links": {
            name: {
                "points": {point: list(at) for point, at in link.coordinates.items()},
                "mass": link.mass,
                "centre": link.centre or (0.0, 0.0),
                "inertia": link.inertia,
            }
            for name, link in mechanism.links.items()
        },
        "guides": [
            {
                "name": guide.id,
                "point": guide.point,
                "on": guide.on,
                "through": mechanism.through(guide),
                "direction": guide.direction_angle,
                "link": guide.link,
            }
            for guide in mechanism.guides
        ],
        "gears": [
            {"links": gear.links, "carrier": gear.carrier, "ratio": gear.ratio} for gear in mechanism.gears
        ],
        "rolling": list(rolling_parts(mechanism)),
    }


def rolling_parts(mechanism: ct.Mechanism) -> Iterator[Parts]:
    """Wheels with the line or the circle that they roll on."""
    for wheel in mechanism.rolling:
        along = wheel.along
        track: Parts
        if along.radius is None:
            assert along.direction is not None
            track = {
                "through": along.through,
                "direction": float(np.arctan2(along.unit[1], along.unit[0])),
            }
        else:
            track = {"centre": along.centre, "radius": along.radius, "inside": along.inside}
        yield {
            "link": wheel.link,
            "centre": wheel.centre,
            "radius": wheel.radius,
            "on": wheel.on,
            "along": track,
        }


def run(_seed: int, number: int) -> Outcome:
    """One example: ten seconds from rest with its own masses and as rods, and what random mechanisms are held to."""
    name = names()[number]
    outcome = Outcome(subject=name)
    example = ct.example(name)
    for all_rods in (False, True):
        mechanism = fallen(example, all_rods=all_rods)
        free = free_motion_of(mechanism)
        if not free.mobility:
            outcome.count("without mobility")
            return outcome
        start = free.initial()
        course = free.integrate(start, DURATION, TOLERANCE, samples=101)
        for kind in sorted({event.kind for event in course.events}):
            outcome.count(f"motions with a {kind}")
        if course.ended != "duration":
            refuse(outcome, free, course, name)
        drift = float(np.max(np.abs(course.energy_residual))) / weight_times_length(free)
        outcome.hold(name, "drift", drift, DRIFT)
        length = max(1.0, float(free.equations.numbers.scale))
        outcome.hold(name, "gap", float(np.max(course.position_residual)) / length, GAP)
    compare(outcome, name, free, start, parts_of(mechanism))
    return outcome


CAMPAIGN = Campaign(
    name="free-examples",
    title="Planar examples left to gravity",
    about=(
        "Every built-in planar linkage falls from rest for ten seconds, without its loads: first with its own masses "
        "and links without mass made rods of 1 kg/m, then as rods altogether. After a second all points of the rods "
        "are compared with those by dense equations in absolute coordinates, and from there the motion runs backwards "
        "to its start, as in the campaign of [random mechanisms](free-motions.md), with the same bounds."
    ),
    columns=COLUMNS,
    run=run,
    cases=len(names()),
)
