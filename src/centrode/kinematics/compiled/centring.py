"""Where the angles of links stand: each stays within half a turn of a centre, which may run on with a drive."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import as_node, variable
from centrode.algebra.reductions import Reduction, together
from centrode.kinematics.compiled.drives import places_of
from centrode.kinematics.compiled.passes import INFINITE, Pass, greatest, least
from centrode.kinematics.compiled.traced import Traced
from centrode.kinematics.compiled.turns import AWAY, MOST, TURN, centre_of, whole_turns, winding_of
from centrode.kinematics.compiled.variables import FIRST
from centrode.kinematics.paths import Path
from centrode.kinematics.sampling import ORDERS

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Values: TypeAlias = dict[str, Array]

m = EXPRESSIONS
SPARSE = 4
"""Angles are followed at every fourth node of the mesh: 2 degrees of an angle drive."""
START = "start"


@dataclass(frozen=True)
class Centring:
    """How centres are found for the angles of some links of a traced plan."""

    traced: Traced
    links: tuple[str, ...]
    mesh: Array
    names: tuple[str, ...]

    @property
    def path(self) -> Path:
        """The path of the drives."""
        return self.traced.solved.ready.kinematics.path

    def centres(self, values: Mapping[str, Array], kernels: str, threads: int) -> tuple[Mask, Values]:
        """The mechanisms whose links all stay near enough to their centres; these with their windings."""
        found, further = self._over_nodes.run(values, kernels, threads), Values()
        near = [self._centred(link, found, further) for link in self.links]
        return np.logical_and.reduce(near), further

    @cached_property
    def _sparse(self) -> Values:
        """Every fourth node, the one nearest to the initial position among them."""
        start = int(np.argmin(np.abs(self.mesh - self.path.initial)))
        nodes = np.arange(len(self.mesh))
        chosen = np.unique(np.concatenate([nodes[start % SPARSE :: SPARSE], nodes[[0, -1]]]))
        return {
            **places_of(self.path, self.mesh[chosen], ORDERS - 1),
            START: (chosen == start).astype(np.float64),
            FIRST: (chosen == 0).astype(np.float64),
        }

    @cached_property
    def _over_nodes(self) -> Pass:
        return Pass(self._of_angles, self.names, self._sparse)

    @cached_property
    def _of_angles(self) -> Reduction:
        """States: each angle run on from node to node, its jumps, its ends less those of some turns of the drive."""
        parts = [Reduction({}, {})]
        for link in self.links:
            cosine, sine = self.traced.turning[link]
            raw, before = m.atan2(sine, cosine), variable(f"angle {link}")
            angle = as_node(raw + TURN * whole_turns(before, raw))
            jump = m.where(m.equal(variable(FIRST), 1.0), 0.0, m.abs(angle - before))
            there = m.where(m.equal(variable(START), 1.0), angle, variable(f"at start {link}"))
            parts.append(
                Reduction(
                    {f"angle {link}": angle, f"at start {link}": as_node(there)},
                    {f"angle {link}": 0.0, f"at start {link}": 0.0},
                )
            )
            parts.append(greatest(f"jump {link}", as_node(jump)))
            for k, winding in enumerate(self._windings):
                rest = angle
                for drive, turns in winding.items():
                    rest = as_node(rest - turns * self.traced.winders[drive])
                parts += [greatest(f"high {k} {link}", rest), least(f"low {k} {link}", rest)]
        return together(*parts)

    def _centred(self, link: str, found: Values, further: Values) -> Mask:
        """Where an angle stays within half a turn of a centre; the centre and its winding are added."""
        start = self.traced.solved.ready.assembled.angles[link]
        whole = np.round((start - found[f"at start {link}"]) / TURN)
        off = np.abs(start - found[f"at start {link}"] - TURN * whole)
        kinds = range(len(self._windings))
        halves = np.stack([found[f"high {k} {link}"] - found[f"low {k} {link}"] for k in kinds]) / 2.0
        best = np.argmin(np.where(np.isnan(halves), INFINITE, halves), axis=0)
        middles = np.stack([found[f"high {k} {link}"] + found[f"low {k} {link}"] for k in kinds]) / 2.0
        lanes = np.arange(len(best))
        for drive in self.traced.winders:
            of_each = np.array([winding.get(drive, 0.0) for winding in self._windings])
            further[winding_of(link, drive)] = of_each[best]
        further[centre_of(link)] = middles[best, lanes] + TURN * whole
        jump = found[f"jump {link}"]
        fits: Mask = halves[best, lanes] + jump < np.pi - AWAY
        return fits & (jump < MOST) & (off < np.pi - AWAY)

    @cached_property
    def _windings(self) -> list[dict[str, float]]:
        """Turns that a link may make for one of a drive: none, or one to either side for one of the drives."""
        return [{}, *[{drive: sense} for drive in self.traced.winders for sense in (1.0, -1.0)]]
