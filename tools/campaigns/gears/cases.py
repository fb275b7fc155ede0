"""Random pairs, external and internal: do true teeth that turn enter each other where the program says nothing."""

from __future__ import annotations

import math

import numpy as np

from centrode.gears.pair_faults import pair_faults
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.profiles import true_action_ends
from centrode.gears.racks import ReferenceRack
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.gears.turned_teeth import external_tooth, greatest_depth, internal_tooth

SEEN = 2e-4
"""Depth in modules from which teeth enter each other: what sampling and interpolation leave lies below."""


def drawn_pair(random: np.random.Generator) -> PairGeometry:
    """A pair of module one whose flanks can touch."""
    while True:
        internal = bool(random.random() < 0.45)
        first = int(random.integers(6, 45))
        second = first + int(random.integers(4, 50)) if internal else int(random.integers(6, 90))
        shifts = float(random.uniform(-0.8, 1.1)), float(random.uniform(-0.8, 1.1))
        addendum = float(random.choice([1.0, 1.0, 0.8]))
        alpha = math.radians(float(random.choice([20.0, 20.0, 25.0])))
        edge = float(random.choice([1.0, 1.0, 0.7, 0.3])) * 0.25 / (1 - math.sin(alpha))
        rack = ReferenceRack(alpha, addendum, 0.25, edge)
        pair = PairGeometry("internal" if internal else "external", 1.0, (first, second), shifts, 0.0, rack)
        if math.isfinite(pair.working_angle):
            return pair


def run(seed: int, number: int) -> Outcome:
    """What the program reports of a pair, beside the depth to which its teeth enter each other."""
    pair = drawn_pair(random_of(seed, number))
    outcome = Outcome(f"{pair.kind} {pair.teeth} {pair.shifts} {pair.rack}")
    kinds = [fault.kind for fault in pair_faults(pair)]
    if {"pointed", "tip inside base"} & set(kinds):
        outcome.count("without whole teeth")
        return outcome
    alpha, height, edge = pair.rack.pressure_angle, pair.rack.addendum, pair.rack.fillet
    wheels = [
        internal_tooth(int(wheel.teeth), wheel.shift, wheel.tip / 2, wheel.root / 2, alpha)
        if wheel.internal
        else external_tooth(int(wheel.teeth), wheel.shift, wheel.tip / 2, alpha, height, edge)
        for wheel in pair.wheels
    ]
    depth = greatest_depth(wheels[0], wheels[1], pair.centre_distance)
    enters = {"fillet", "tips", "no clearance"} & set(kinds)
    if enters:
        outcome.count(
            "reported, and they enter" if depth > SEEN else "reported, but they enter less than is seen"
        )
    elif depth > SEEN:
        outcome.fault(
            f"teeth enter each other by {depth:.4f} modules, and the program reports {kinds or 'nothing'}"
        )
    else:
        outcome.count("clear")
        outcome.hold(pair.kind, "depth", depth, SEEN)
    begin, end = true_action_ends(pair)
    if end < begin and not {"contact ratio", "contact after undercut"} & set(kinds):
        outcome.fault("no contact, and the program says nothing")
    return outcome


CAMPAIGN = Campaign(
    name="gears",
    title="Teeth that enter each other",
    about="""Random pairs of involute wheels, external and internal, of few and many teeth, with shifts far beyond what
is usual. Each wheel is cut anew: fillets as equidistants of the path of the rack's edge, flanks as involutes, undercut
where both cross. Both wheels turn against each other without play, and every place of each tooth is looked for in the
other wheel. What enters by more than the sampling leaves has to be among the program's reports: tips in fillets, tips
that meet tips, tips at the root.""",
    columns={"depth": f"depth in modules of one tooth in another where nothing is reported; at most {SEEN:g}"},
    run=run,
    cases=10_000,
    block=100,
)  # fmt: skip
