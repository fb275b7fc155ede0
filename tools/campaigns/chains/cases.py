"""Motions of random chains beside the solutions of their closure equations."""

from __future__ import annotations

from typing import Any

import numpy as np

import centrode as ct
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.chains.closure import Closure
from tools.campaigns.closure.comparison import COLUMNS, compare_motion
from tools.campaigns.grown.higher import HIGHER, GrowingHigher
from tools.campaigns.grown.plane import KINDS, grown


def drawn(seed: int, number: int) -> tuple[dict[str, Any], list[str], GrowingHigher, np.random.Generator]:
    """The description of a case, the kinds of its groups, and where everything stands at the start."""
    random = random_of(seed, number)
    kinds = [str(random.choice(KINDS)) for _ in range(int(random.integers(1, 5)))]
    if random.random() < 0.3:
        kinds[int(random.integers(len(kinds)))] = str(random.choice(HIGHER))
    growing = GrowingHigher(np.random.default_rng([seed, number, 1]))
    return grown(kinds, 0, growing), kinds, growing, random


def run(seed: int, number: int) -> Outcome:
    """Statuses over two turns, limits, and positions with two derivatives."""
    parts, kinds, growing, random = drawn(seed, number)
    mechanism = ct.Mechanism(**parts)
    outcome = Outcome(f"# {', '.join(kinds)}\n{ct.mechanism_text(mechanism)}")
    row = "with a group of higher class" if set(kinds) & set(HIGHER) else "groups of class II"
    compare_motion(outcome, row, mechanism, Closure(growing), random)
    return outcome


CAMPAIGN = Campaign(
    name="chains",
    title="Random chains",
    about="""Random planar chains: a crank and one to four groups of all kinds (dyads with hinges, guides and carriages,
rigid points, gears, wheels rolling on lines and circles), three in ten with a group of higher class. Each is placed
first and measured afterwards.

The oracle writes the closure equations in origin and angle of every link, without dyads, branches or an order of
groups. It walks their curve of positions along its arc from the initial position to two turns of range; where the crank
turns back is a limit, found by bisection along the arc. Statuses of 25 samples are judged by it. Positions with two
derivatives are compared with solutions at 50 digits. Rounding is what one rounding of every term of the equations
makes, by their inverse.""",
    columns=COLUMNS,
    run=run,
    cases=5000,
)  # fmt: skip
