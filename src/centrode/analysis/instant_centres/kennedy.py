"""Instant centres constructed at one position: joints first, then Aronhold's and Kennedy's theorem.

Of three bodies in relative motion the three instant centres lie on one line (Aronhold 1872, Kennedy 1886). A
centre is where two such lines meet. The circle diagram has the bodies on a circle and a chord for each known
centre: a chord that closes two triangles is found.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import TypeAlias

import numpy as np
import xarray as xr

from centrode.analysis.instant_centres.bodies import ROUNDED, Pair, bodies_of, is_spherical, refuse_batch
from centrode.analysis.instant_centres.centres import numbered
from centrode.analysis.instant_centres.construction import Construction, How, Step
from centrode.analysis.instant_centres.primary import Gearing, Joint, gearings_of, joints_of, ordered
from centrode.analysis.instant_centres.projective import (
    EPS,
    Spot,
    best_crossing,
    cross,
    crossing,
    differ,
    dot,
    length,
    spot,
)
from centrode.analysis.instant_centres.spots import Spots, Where, spots_of
from centrode.analysis.instant_centres.turning_bodies import turning_bodies_of
from centrode.errors import InputError
from centrode.locale import _

Derived: TypeAlias = "tuple[Pair, Spot | None, How, str, tuple[int, ...]]"

MOST_BODIES = 40
"""Bodies of one construction: its work grows as their cube."""
ROUNDINGS = 16.0 * EPS
"""Error of a place of the motion, in the size of the mechanism, besides its residual."""
UNSURE = 1e-6
"""A crossing that may be off by more is not used: its lines all but coincide in this position."""


def construct_centres(
    motion: xr.Dataset, sample: int = 0, pairs: Sequence[tuple[str, str]] | None = None
) -> Construction:
    """Construct the instant centres at one sample of a motion, as on paper.

    Joints show the primary centres; the others follow from Aronhold's and Kennedy's theorem. Places only are
    used, no velocities, so that it is independent of `instant_centres`. Where the theorem is not enough (groups
    of higher class, several drives, positions in which the lines coincide) the velocity field gives one
    centre, which the step says, and the construction goes on with it.

    Parameters
    ----------
    motion : Dataset
        As `motion` returns it; of a batch, one mechanism.
    pairs : sequence of (body, body), optional
        Only the steps that lead to these; all if left out.

    Raises
    ------
    InputError
        No position at the sample, more than 40 bodies, an unknown body.

    Notes
    -----
    On the sphere a centre is an axis through the centre of the sphere, and the three axes of three bodies lie in
    one plane: they meet the sphere on one great circle. `place` of a step is one of its two ends.
    """
    refuse_batch(motion)
    everything = turning_bodies_of(motion) if is_spherical(motion) else bodies_of(motion)
    wanted = None if pairs is None else numbered(everything, pairs)
    if len(everything.names) > MOST_BODIES:
        raise InputError(
            "pair",
            _("the construction takes up to {most} bodies, this mechanism has {count}").format(
                most=MOST_BODIES, count=len(everything.names)
            ),
            _("centres from the velocity field are given for any pairs"),
        )
    if not -len(everything.rate) <= sample < len(everything.rate):
        raise InputError("sample", _("there is no sample {sample}").format(sample=sample))
    if not np.isfinite(everything.rate[sample]):
        raise InputError(
            "at", _("the mechanism has no position with velocities there"), _("ask for another one")
        )
    residual = float(motion["residual"][sample])
    found = _Constructing(spots_of(everything.sample(sample)), residual).run()
    return found if wanted is None else found.needed(wanted)


class _Constructing:
    """Centres known so far at one position."""

    def __init__(self, spots: Spots, residual: float) -> None:
        self.spots = spots
        self.bodies = spots.bodies
        self.start = ROUNDINGS + residual
        self.gears = gearings_of(self.bodies.mechanism, self.bodies)
        self.known: dict[Pair, Spot | None] = {}  # None: at rest against each other
        self.steps: list[Step] = []

    def run(self) -> Construction:
        """Find all centres."""
        for joint in joints_of(self.bodies.mechanism, self.bodies):
            self._see(joint)
        self._lock()
        everything = [ordered(pair) for pair in combinations(range(len(self.bodies.names)), 2)]
        unknown = [pair for pair in everything if pair not in self.known]
        while unknown:
            found = [step for step in map(self._derived, unknown) if step is not None]
            for pair, where, how, name, by in found or [self._borrowed(unknown)]:
                if where is None:
                    self._rest(pair, by)
                else:
                    self._note(pair, where, how, name, by)
            unknown = [pair for pair in unknown if pair not in self.known]
        mismatch = {step.pair: self._mismatch(step.pair) for step in self.steps}
        return Construction(self.bodies.names, tuple(self.steps), mismatch)

    def _see(self, joint: Joint) -> None:
        """Take in the centre that a joint shows."""
        where, place = self.spots.shown(joint, self.start)
        before = self.known.get(joint.pair)
        if joint.pair not in self.known:
            self._note(joint.pair, where, joint.kind, joint.name, at=place)
        elif before is not None and differ(before, where):
            self._rest(joint.pair, ())  # joined twice, the bodies cannot move against each other

    def _lock(self) -> None:
        """Three bodies whose joints show centres that are not on a line cannot move against each other."""
        rigid: set[Pair] = set()
        for triple in combinations(range(len(self.bodies.names)), 3):
            pairs = [ordered(pair) for pair in combinations(triple, 2)]
            one, other, third = (self.known.get(pair) for pair in pairs)
            if one is None or other is None or third is None:
                continue
            volume = abs(dot(cross(one.vector, other.vector), third.vector))
            if volume > one.error + other.error + third.error + EPS:
                rigid.update(pairs)
        for pair in sorted(rigid):
            self._rest(pair, ())

    def _note(
        self,
        pair: Pair,
        where: Spot,
        how: How,
        name: str = "",
        by: tuple[int, ...] = (),
        at: Where | None = None,
    ) -> None:
        self.known[pair] = where
        place, direction = self.spots.read(where)
        place = place if at is None else at
        self.steps.append(Step(pair, how, name, by, place, direction, where.error))

    def _rest(self, pair: Pair, by: tuple[int, ...]) -> None:
        self.known[pair] = None
        self.steps = [step for step in self.steps if step.pair != pair]
        self.steps.append(Step(pair, "rest", "", by, None, None, self.start))

    def _derived(self, pair: Pair) -> Derived | None:
        """A centre from what is known: a gear, a body at rest against one of the two, lines that meet."""
        for gear in self.gears:
            where, third = self._by_gear(gear, pair)
            if where is not None:
                return pair, where, "gear", gear.name, (third,)
        lines: list[tuple[Spot, int]] = []
        together: list[tuple[Spot, int]] = []
        for third, one, other in self._thirds(pair):
            if one is None or other is None:
                moving = other if one is None else one
                return pair, moving, "together" if moving is not None else "rest", "", (third,)
            line = crossing(one, other)
            if line is None:
                together.append((min(one, other, key=lambda s: s.error), third))
            else:
                lines.append((line, third))
        if len(together) > 1 and differ(together[0][0], together[1][0]):
            return pair, None, "rest", "", tuple(third for _place, third in together[:2])
        if together:
            return pair, together[0][0], "together", "", (together[0][1],)
        best = best_crossing(lines, UNSURE)
        return None if best is None else (pair, best[0], "kennedy", "", best[1])

    def _thirds(self, pair: Pair) -> Iterator[tuple[int, Spot | None, Spot | None]]:
        """Bodies whose centres with both of a pair are known."""
        for third in range(len(self.bodies.names)):
            if third in pair:
                continue
            legs = [ordered((one, third)) for one in pair]
            if all(leg in self.known for leg in legs):
                yield third, self.known[legs[0]], self.known[legs[1]]

    def _by_gear(self, gear: Gearing, pair: Pair) -> tuple[Spot | None, int]:
        """The third centre of a gear, from those of the other two pairs."""
        legs = {
            "first": ordered((gear.first, gear.carrier)),
            "second": ordered((gear.second, gear.carrier)),
            "mesh": ordered((gear.first, gear.second)),
        }
        wanted = next((name for name, leg in legs.items() if leg == pair), None)
        third = next((n for n in (gear.first, gear.second, gear.carrier) if n not in pair), gear.carrier)
        others = [self.known.get(leg) for name, leg in legs.items() if name != wanted]
        known = [one for one in others if one is not None]
        if wanted is None or len(known) < 2:
            return None, third
        return self.spots.geared(gear, wanted, known), third

    def _borrowed(self, unknown: Sequence[Pair]) -> Derived:
        """A centre from the velocity field, the frame's first, where one line is known already if there is such."""
        lines = {pair: sum(1 for _third in self._thirds(pair)) for pair in unknown}
        pair = min(unknown, key=lambda pair: (pair[1] != 0, lines[pair] == 0, pair))
        pole = self.spots.pole(pair)
        if length(pole) <= ROUNDED:
            return pair, None, "rest", "", ()
        return pair, spot(complex(pole[0], pole[1]), pole[2], self.start), "field", "", ()

    def _mismatch(self, pair: Pair) -> float:
        """Relative velocity at the constructed centre, in the greatest of the motion."""
        pole, where = self.spots.pole(pair), self.known[pair]
        return length(pole if where is None else cross(pole, where.vector))
