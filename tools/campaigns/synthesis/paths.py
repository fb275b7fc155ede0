"""Closed paths of random crank-rockers: is a linkage found that draws them to rounding, and has no answer a defect?"""

from __future__ import annotations

import numpy as np

from centrode.synthesis.four_bars import coupler_motion
from centrode.synthesis.synthesise import synthesise
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.synthesis.coupler_continuation import walk

RECOVERED = 1e-9
"""Root mean square distance over the size of the path."""
POINTS = 40


def run(seed: int, number: int) -> Outcome:
    """Synthesise the path of a random crank-rocker, and follow every answer through the targets."""
    random = random_of(seed, number)
    excess = random.uniform(0.15, 1.5, 3)
    ground, coupler, rocker = 1 + excess.sum() - excess
    row = np.array([0, 0, ground, 0, 1, coupler, rocker, *random.uniform(-2.5, 2.5, 2)])
    crank = np.linspace(0, 2 * np.pi, POINTS, endpoint=False)
    path = coupler_motion(row[None], crank, np.ones(1)).point[0]
    path = path * np.exp(1j * random.uniform(0, 6)) * random.uniform(0.2, 5)
    path = path + complex(*random.uniform(-9, 9, 2))
    outcome = Outcome(f"{row.tolist()}")
    table = [[float(z.real), float(z.imag)] for z in path]
    wanted = {"topology": "crank-rocker", "kind": "path", "targets": table, "constraints": {"crank": "OA"}}
    answers = synthesise({"synthesis": {**wanted, "answers": 3}}).answers
    size = float(np.abs(path - path.mean()).max())
    error = answers[0].error / size
    outcome.count("recovered" if error < RECOVERED else "not recovered")
    if error >= RECOVERED:
        outcome.measure("not recovered", "error", error)
    for answer in answers:
        walked = walk(answer.mechanism, answer.drive)
        if not (walked.ordered and walked.one_branch and walked.closes):
            outcome.fault("an answer that is said to have no defect has one")
        missed = np.abs(np.array(walked.places["P"]) - path)
        difference = abs(float(np.sqrt(np.mean(missed**2))) - answer.error) / size
        outcome.hold("all answers", "difference", difference, 1e-9)
    return outcome


CAMPAIGN = Campaign(
    name="synthesised-paths",
    title="Paths of random crank-rockers",
    about="""Random crank-rockers with a random coupler point draw closed paths, which are turned, scaled and moved; 40
points of each are the targets of a synthesis without crank angles, with a crank that turns fully and the order kept.
Recovered is what a linkage is found for whose root mean square error is smaller than 1e-9 of the path's size. Every
answer, also those that are not best, is followed through all targets by a continuation of its own in steps of 0.2 deg:
it has to close, to stay on its branch, and to pass the targets in their order.""",
    columns={
        "error": "root mean square error over the size of the path, where it was not recovered",
        "difference": "of the error that is stated and that of the continuation, over the size; at most 1e-9",
    },
    run=run,
    cases=200,
    block=2,
)  # fmt: skip
