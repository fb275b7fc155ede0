"""Reactions of a random mechanism, and what is missing of the equilibrium of its bodies."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

import centrode as ct
from centrode.errors import CentrodeError
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.columns import EPS
from tools.campaigns.grown.higher import HIGHER, grown_higher
from tools.campaigns.grown.plane import KINDS
from tools.campaigns.reactions.burden import burdened
from tools.campaigns.reactions.newton_euler import FRAME, Balance, vector

Array = npt.NDArray[np.float64]
WIDTH = 0.3
"""Of the range about the initial position, on either side [rad]."""
SAMPLES = 7
OPERATIONS = 256
"""Roundings in one sum of forces, with those of the sines of turned directions and of accelerations."""
TOLD = ("the mobility", "flat in the initial position", "no initial", "cannot")
"""Parts of refusals that drawn mechanisms may meet: two points of a group in one place and the like."""


def drawn(seed: int, number: int) -> tuple[dict[str, Any], list[str]]:
    """The description of a case, and the kinds of its groups."""
    random = random_of(seed, number)
    some = HIGHER if random.random() < 0.25 else ()
    kinds = [str(random.choice(KINDS)) for _ in range(int(random.integers(1, 5)))]
    if some:
        kinds[-1] = str(random.choice(some))
    grown = int(random.integers(2**32))
    parts = burdened(grown_higher(kinds, grown), int(random.integers(2**32)))
    parts["drives"][0]["speed"] = float(random.choice([-1.0, 1.0]) * random.uniform(0.3, 5.0))
    return parts, kinds


def run(seed: int, number: int) -> Outcome:
    """Reactions about the initial position of one mechanism, and the sums of forces and moments of every body."""
    parts, kinds = drawn(seed, number)
    mechanism = ct.Mechanism(**parts)
    outcome = Outcome(f"# {', '.join(kinds)}\n{ct.mechanism_text(mechanism)}")
    begun = parts["drives"][0]["start"]
    ends: Any = {"samples": SAMPLES, "start": begun - WIDTH, "stop": begun + WIDTH}
    try:
        motion, found = ct.motion(mechanism, **ends), ct.reactions(mechanism, **ends)
    except CentrodeError as refusal:
        outcome.count("refused")
        if not any(words in str(refusal) for words in TOLD):
            outcome.fault(f"refused: {refusal}")
        return outcome
    good = found.reaction_status.to_numpy() == 0
    outcome.count("samples", SAMPLES)
    outcome.count("samples with reactions", int(good.sum()))
    if found.attrs["undetermined"]:
        outcome.count("undetermined by statics")
        return outcome
    if not good.any():
        return outcome
    if not np.isfinite(found.joint_force.to_numpy()[good]).all():
        outcome.fault("reactions that statics determines are not numbers")
        return outcome
    with np.errstate(all="ignore"):
        balance, outer = Balance.of(mechanism, motion, found), Balance.of_outer(mechanism, motion, found)
    row = "with a group of higher class" if set(kinds) & set(HIGHER) else "groups of class II"
    compare(outcome, row, balance, outer, good, unknowns(mechanism))
    return outcome


def unknowns(mechanism: ct.Mechanism) -> int:
    """Equations of all bodies: three of a link, two of a pin."""
    points = {name for link in mechanism.links.values() for name in link.coordinates}
    return 3 * len(mechanism.links) + 2 * len(points)


def compare(outcome: Outcome, row: str, balance: Balance, outer: Balance, good: Array, size: int) -> None:
    """What is missing of equilibrium, in units of the greatest force or moment that acts."""
    unit = balance.greatest()
    bound = OPERATIONS * size * EPS
    for body in balance.acting:
        if body == FRAME:
            continue
        force, moment = balance.missing(body)
        outcome.hold(row, "force", worst(abs(force) / unit, good), bound)
        if not body.startswith("pin"):
            outcome.hold(row, "moment", worst(abs(moment) / unit, good), bound)
    sums = [outer.missing(body) for body in outer.acting]
    missing = abs(vector(balance.found.frame_force) - sum(force for force, _moment in sums))
    outcome.hold(row, "frame", worst(missing / unit, good), bound)
    missing = abs(balance.found.frame_moment.to_numpy() - sum(moment for _force, moment in sums))
    outcome.hold(row, "frame", worst(missing / unit, good), bound)


def worst(values: Any, good: Array) -> float:
    """The greatest value among good samples."""
    return float(np.max(np.asarray(values)[good]))


CAMPAIGN = Campaign(
    name="reactions",
    title="Reactions",
    about="""Random planar mechanisms of one to four groups, a quarter of them with a group of higher class, with gears,
rolling wheels and guides; a mass on most links and a load of every kind. Reactions about the initial position are put
into the equations of Newton and Euler of every link and every pin, written down anew from the motion's accelerations;
so are the force and the moment on the frame, which have to be all loads less the rates of momentum. Where statics
determines the reactions, these equations have no other solution.""",
    columns={
        "force": (
            "greatest sum of forces on a link or pin, which should be zero, in the greatest force or moment that acts; "
            "bound 256 roundings for each equation"
        ),
        "moment": "the same of moments on a link",
        "frame": "the frame's force and moment beside the sums of loads and inertia",
    },
    run=run,
    cases=5000,
)
