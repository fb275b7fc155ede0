"""Deviations by play beside those of a million pins at random in their holes."""

from __future__ import annotations

import numpy as np

import centrode as ct
from centrode.errors import CentrodeError
from centrode.kinematics.preparation import ready
from centrode.tolerances.clearances import clearance_extents
from centrode.tolerances.joint_play import play_of
from tools.campaigns.campaign import Campaign, Outcome, random_of

POSITIONS = 1_000_000
SAMPLES = 25
NEAR = 0.15
"""By how much of the deviation the best of a million pins may fall short: it has to be near in four angles at once."""


def drawn(seed: int, number: int) -> ct.Mechanism:
    """A crank-rocker with play of up to a fiftieth of the crank in each joint."""
    random = random_of(seed, number)
    while True:
        crank, coupler, rocker, ground = random.uniform((0.5, 1.5, 1.5, 1.5), (1.0, 4.0, 4.0, 4.0))
        longest = max(coupler, rocker, ground)
        if crank + longest < 0.95 * (coupler + rocker + ground - longest):
            break
    plays = random.uniform(1e-4, 0.02 * crank, 4)
    text = ct.mechanism_text(ct.four_bar(crank, coupler, rocker, ground))
    table = "".join(f"{pin} = {play!r}\n" for pin, play in zip("OABD", map(float, plays), strict=True))
    return ct.parse_mechanism(f"{text}\n[tolerances.clearances]\n{table}")


def rocker_angles(
    mechanism: ct.Mechanism, drive: float, random: np.random.Generator, count: int
) -> np.ndarray:
    """Angle [rad] of the rocker less the nominal one for pins at random, on the rims of their holes.

    By two circles: the pins of O and D belong to the frame, that of A to the crank, that of B to the coupler.
    """
    lengths = [mechanism.links[name].length or 0.0 for name in ("crank", "coupler", "rocker")]
    ground = complex(*mechanism.frame.coordinates["D"])
    plays = {joint.point: joint.play for joint in play_of(mechanism)}

    def solved(offsets: dict[str, np.ndarray]) -> np.ndarray:
        crank, coupler, rocker = lengths
        at_a = np.exp(1j * drive) * (crank - offsets["O"])
        arm, bar = rocker + offsets["B"] - offsets["D"], coupler - offsets["A"]
        line = ground - at_a
        distance = np.abs(line)
        along = (np.abs(bar) ** 2 - np.abs(arm) ** 2 + distance**2) / (2 * distance)
        across = np.sqrt(np.abs(bar) ** 2 - along**2)
        at_b = at_a + (along + 1j * across) * line / distance
        # the rocker's own axis, from the direction between the places of its pins
        return np.asarray(np.angle((at_b - ground) / arm))

    offsets = {pin: plays[pin] * np.exp(2j * np.pi * random.random(count)) for pin in "OABD"}
    nominal = solved({pin: np.zeros(1, dtype=complex) for pin in "OABD"})
    return np.asarray(np.angle(np.exp(1j * (solved(offsets) - nominal))))


def run(seed: int, number: int, count: int = POSITIONS) -> Outcome:
    """No pin lies beyond the polished extremes, and the best of them come near."""
    mechanism = drawn(seed, number)
    outcome = Outcome(ct.mechanism_text(mechanism))
    try:
        found = clearance_extents(ready(mechanism), {"psi": "angle.rocker"}, play_of(mechanism), SAMPLES)[
            "psi"
        ]
    except CentrodeError as failure:
        outcome.fault(str(failure))
        return outcome
    worst = int(np.argmax(found.first_order))
    drive = float(ct.solver(mechanism, ["links.crank.length"], SAMPLES).parameter[worst])
    angles = rocker_angles(mechanism, drive, random_of(seed, number + 10**6), count)
    size = float(found.first_order[worst])
    beyond = max(float(angles.max()) - found.upper, found.lower - float(angles.min())) / size
    short = max(1 - float(angles.max()) / found.upper, 1 - float(angles.min()) / found.lower)
    outcome.hold("crank-rockers", "beyond", max(beyond, 0.0), 1e-9)
    outcome.hold("crank-rockers", "short", short, NEAR)
    outcome.measure("crank-rockers", "first order", abs(found.upper / size - 1))
    outcome.count("pin positions", count)
    return outcome


CAMPAIGN = Campaign(
    name="clearances",
    title="Play in joints",
    about="""Random crank-rockers with play in all four joints, up to a fiftieth of the crank.

The oracle puts a million pins at random on the rims of their holes and finds the rocker by two circles, in complex
numbers. None may deviate by more than the extremes that the program finds, and the best of them have to come near.""",
    columns={
        "beyond": "by how much a pin deviates more than the extreme, as a share of it; bound 1e-9",
        "short": "by how much the best pin falls short of the extreme, as a share of it; bound 0.15",
        "first order": "by how much the extreme differs from that to first order, as a share",
    },
    run=run,
    cases=200,
)  # fmt: skip
