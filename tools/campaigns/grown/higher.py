"""Random mechanisms with groups of higher class: triads and contours of four sides among dyads of all kinds."""

from __future__ import annotations

from typing import Any

import numpy as np

from tools.campaigns.grown.plane import Growing, grown

HIGHER = ("triad", "triad on guides", "slotted triad", "guided triad", "four sides")


class GrowingHigher(Growing):
    """A mechanism so far, to which groups of higher class can be added too."""

    def _triad(self) -> None:
        """A plate on three rods."""
        self._plate("rrr")

    def _triad_on_guides(self) -> None:
        """A plate on two rods, with a third point on a guide."""
        self._plate("rrg")

    def _slotted_triad(self) -> None:
        """A plate on two rods, with a slot that passes a known point."""
        self._plate("rrs")

    def _guided_triad(self) -> None:
        """A plate on one rod, one point on a guide, and a slider that carries one of its points beside its guide."""
        self._plate("rgc")

    def _plate(self, supports: str) -> None:
        known = [self.known_point() for _support in supports]
        bodies = [self.body() for _support in supports]
        corners = {self.new() + mark: self.place() for mark in "abc"}
        plate = self.link(dict(corners))
        for k, (support, (corner, at)) in enumerate(zip(supports, corners.items(), strict=True)):
            if support == "r":
                self.link({known[k]: self.places[known[k]], corner: at})
            elif support == "g":
                self.guide(corner, at, bodies[k], self.angle())
            elif support == "s":
                self.guide(known[k], self.places[known[k]], plate, self.angle())
            else:
                runner = corner + "'"
                slider = self.link({corner: at, runner: at + self.place() / 4})
                self.guide(runner, self.places[runner], bodies[k], self.angle(), slider)

    def _four_sides(self) -> None:
        """Two plates on known points, joined by two rods."""
        plates = []
        for known in self.known_points():
            plates.append((known, {self.new() + mark + known: self.place() for mark in "ab"}))
        for known, corners in plates:
            self.link({known: self.places[known], **corners})
        for one, other in zip(*(corners for _known, corners in plates), strict=True):
            self.link({one: self.places[one], other: self.places[other]})


def grown_higher(kinds: list[str], seed: int) -> dict[str, Any]:
    """The description of a crank with groups of these kinds on it."""
    return grown(kinds, seed, GrowingHigher(np.random.default_rng(seed)))
