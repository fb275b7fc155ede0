"""Random sets of five poses: are all real dyads found, and no others?"""

from __future__ import annotations

import numpy as np

from centrode.synthesis.burmester import Poses, closures, five_pose_dyads
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.synthesis.burmester_elimination import real_dyads


def run(seed: int, number: int) -> Outcome:
    """Dyads of five random poses against an elimination in 50 digits."""
    random = random_of(seed, number)
    places, angles = random.normal(size=(5, 2)), random.uniform(-3, 3, 5)
    poses = Poses(places[:, 0] + 1j * places[:, 1], angles)
    outcome = Outcome(f"{places.tolist()} {angles.tolist()}")
    found = five_pose_dyads(poses)
    own = real_dyads(places.tolist(), angles.tolist())
    row = f"{len(own)} dyads"
    outcome.count(row)
    if len(found.moving) != len(own):
        outcome.fault(f"{len(found.moving)} dyads are found, there are {len(own)}")
        return outcome
    outcome.measure(row, "distance", 0.0)
    for moving, fixed in own:
        size = 1 + abs(moving) + abs(fixed)
        distance = float((np.abs(found.moving - moving) + np.abs(found.fixed - fixed)).min()) / size
        outcome.hold(row, "distance", distance, 1e-7)
    if len(own):
        scale = (1 + np.abs(found.moving) + np.abs(found.fixed)) ** 2
        missed = float((np.abs(closures(poses, found.moving, found.fixed)).max(axis=1) / scale).max())
        outcome.hold(row, "closure", missed, 1e-12)
    return outcome


CAMPAIGN = Campaign(
    name="five-poses",
    title="Dyads of five random poses",
    about="""Five poses with normally distributed places and evenly distributed angles. All real dyads of the program
are compared with those of an elimination in 50 digits that shares nothing with it: determinants of three rows each,
their resultant as a polynomial, and its zeros. Their number has to agree, and each has to lie where the elimination has
it.""",
    columns={
        "distance": "of a dyad from that of the elimination, over the size of both points; at most 1e-7",
        "closure": "change of the square of a dyad's length between poses, over that size; at most 1e-12",
    },
    run=run,
    cases=1000,
    block=20,
)  # fmt: skip
