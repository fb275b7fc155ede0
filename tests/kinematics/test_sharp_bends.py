"""Curves of groups of higher class that bend sharply: a lever whose circular track encloses a wheel on a crank.

The centre of the track stays at the difference of the radii from the crank's pin, so the limits are those of a dyad:
the distance of pin and pivot is the lever's arm plus or minus that difference. With a long crank and little play the
curve of the lever's angle over the crank's is a narrow loop.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import pytest

import centrode as ct
from centrode.structure.plan import structure_of
from mechanisms import EPS, events, statuses
from samples import spread

START = 1.0


class Lever(NamedTuple):
    """Play between the radii, direction of the track's centre from the pin, arm of the lever, length of the crank."""

    play: float
    side: float
    arm: float
    crank: float

    @property
    def pivot(self) -> complex:
        track = cmath.rect(self.crank, START) + cmath.rect(self.play, self.side)
        return track + cmath.rect(self.arm, 2.0)

    def mechanism(self, unit: float = 1.0) -> ct.Mechanism:
        """The mechanism with every length in another unit."""
        return ct.Mechanism(
            frame={"points": {"O": [0, 0], "E": [unit * self.pivot.real, unit * self.pivot.imag]}},
            links={
                "OA": {"length": unit * self.crank},
                "wheel": {"points": {"A": [0, 0]}},
                "lever": {"points": {"E": [0, 0]}, "angle": 2.0 - math.pi},
            },
            rolling=[
                {
                    "link": "wheel",
                    "centre": "A",
                    "radius": unit * 0.5,
                    "on": "lever",
                    "along": {
                        "centre": [unit * self.arm, 0],
                        "radius": unit * (0.5 + self.play),
                        "inside": True,
                    },
                }
            ],
            drives=[{"link": "OA", "start": START, "speed": 1}],
        )

    def limits(self) -> list[tuple[float, float]]:
        """The limits on both sides of the start, each with what rounding of the lengths makes of it."""
        ground, found = abs(self.pivot), []
        for reach in (self.arm + self.play, self.arm - self.play):
            cosine = (self.crank**2 + ground**2 - reach**2) / (2.0 * self.crank * ground)
            for turn in (math.acos(cosine), -math.acos(cosine)) if abs(cosine) < 1.0 else ():
                at = START + math.remainder(cmath.phase(self.pivot) + turn - START, math.tau)
                slope = self.crank * ground * abs(math.sin(turn)) / reach
                found.append((at, 32.0 * EPS * (1.0 + (self.crank + ground) / slope)))
        return [max(x for x in found if x[0] < START), min(x for x in found if x[0] > START)]


LEVERS = [
    Lever(0.066387178, 2.316450969, 0.284678684, 2.288382606),
    Lever(0.003501626, 0.341302864, 0.434338408, 5.975783401),
    Lever(0.071360096, -1.511236709, 0.522874495, 8.133852135),
    Lever(0.070048610, 2.529250983, 0.135544860, 17.269115083),
    Lever(0.098673236, 2.220531014, 0.197475891, 20.502500490),
    Lever(0.003206561, -1.829042871, 0.278085113, 23.474921995),
]


@pytest.mark.parametrize("lever", spread(LEVERS, 3), ids=lambda x: f"{x.crank:.1f}")
def test_limits_of_a_narrow_loop(lever: Lever) -> None:
    mechanism, ends = lever.mechanism(), lever.limits()
    assert "higher class" in [group.kind for group in structure_of(mechanism).groups]
    inside = [START + (end - START) * (1.0 - 1e-4) for end, _allowed in ends]
    outside = [START + (end - START) * (1.0 + 1e-4) for end, _allowed in ends]
    motion = ct.motion(mechanism, at=[*inside, START, *outside])
    assert statuses(motion) == ["ok"] * 3 + ["open"] * 2
    found = events(motion, "limit")
    for end, allowed in ends:
        assert min(abs(x - end) for x in found) <= allowed


@pytest.mark.parametrize("lever", spread(LEVERS, 3), ids=lambda x: f"{x.crank:.1f}")
def test_the_curve_is_followed_alike_in_every_unit(lever: Lever) -> None:
    """Powers of two do not round: the same bits come out."""
    places = [START + part * (end - START) for end, _allowed in lever.limits() for part in (0.3, 0.9)]
    one, other = (ct.motion(lever.mechanism(unit), at=places) for unit in (1.0, 2.0**20))
    assert events(one, "limit") == events(other, "limit")
    assert (one.angle.values == other.angle.values).all()
