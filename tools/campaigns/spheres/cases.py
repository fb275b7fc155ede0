"""Motions of random spherical chains beside the solutions of their closure equations."""

from __future__ import annotations

import numpy as np

import centrode as ct
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.closure.comparison import COLUMNS, compare_motion
from tools.campaigns.grown.sphere import Growing, grown
from tools.campaigns.spheres.closure import Closure

KINDS = ("RRR", "RRR", "RRP", "RPR", "PRP", "rigid point")
SPREADS = (0.7, 0.7, 1.5, 0.2, 0.05)
"""How far apart places lie [rad]."""


def drawn(seed: int, number: int) -> tuple[Growing, list[str], np.random.Generator]:
    """The chain of a case and the kinds of its groups; every fourth is a four-bar."""
    random = random_of(seed, number)
    count = int(random.integers(1, 5))
    kinds = ["RRR"] if random.random() < 0.25 else [str(random.choice(KINDS)) for _ in range(count)]
    if set(kinds) == {"rigid point"}:
        kinds[0] = "RRR"  # a crank alone has no unknowns
    return grown(kinds, int(random.integers(2**32)), float(random.choice(SPREADS))), kinds, random


def run(seed: int, number: int) -> Outcome:
    """Statuses over two turns, limits, and positions with two derivatives."""
    growing, kinds, random = drawn(seed, number)
    mechanism = ct.Mechanism(**growing.parts())
    outcome = Outcome(f"# {', '.join(kinds)}\n{ct.mechanism_text(mechanism)}")
    row = "four-bars" if kinds == ["RRR"] else "chains"
    compare_motion(outcome, row, mechanism, Closure(growing), random)
    return outcome


CAMPAIGN = Campaign(
    name="spheres",
    title="Spherical chains",
    about="""Random spherical chains: a crank and one to four groups (arcs, guide circles, rigid points), a quarter of
them four-bars; some of them small, down to 0.05 rad.

The oracle writes the closure in unit vectors: cosines of the arcs between points, of the radii of guide circles about
poles. It walks the curve of positions along its arc from the initial position to two turns of range; where the crank
turns back is a limit. Statuses of 25 samples are judged by it; positions with two derivatives are compared with
solutions at 50 digits. Rounding is what one rounding of every term of the equations makes, by their inverse.""",
    columns=COLUMNS,
    run=run,
    cases=5000,
)
