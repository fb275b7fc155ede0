"""Angular velocities and accelerations of links in space, as vectors in the frame's axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.plan_evaluation import PlanLayout
from centrode.kinematics.stretches import TurnedStretch, with_quick_steps, with_quick_turns
from centrode.numerics.arrays import of_shape
from centrode.numerics.jets import Jet

Array: TypeAlias = npt.NDArray[np.float64]


def attitudes_of(layout: PlanLayout, columns: Array) -> Array | None:
    """Axes of the links in those of the frame and their derivatives, (3, lanes, n, links, 3, 3); none in the plane.

    The axis of a link stands before its components.
    """
    if layout.runs_on:
        return None
    taken = columns[:, layout.first_attitude : layout.first_slide]
    axes = taken.reshape(len(columns), len(layout.links), 3, 3, *columns.shape[2:])
    # samples and mechanisms to the front, as in all arrays of a result
    return np.moveaxis(axes, (4, 5), (1, 2))


def spins_of(layout: PlanLayout, columns: Array) -> Array | None:
    """Angular velocity and acceleration per unit of the parameter, (2, lanes, n, links, 3); none in the plane.

    Of a rotation with axes a_k these are half the sums of a_k x a_k' and of a_k x a_k''.
    """
    if layout.runs_on:
        return None
    lanes, samples = columns.shape[2:]
    spins = np.empty((2, lanes, samples, len(layout.links), 3), columns.dtype)
    for k in range(len(layout.links)):
        first = layout.first_attitude + 9 * k
        axes = columns[:, first : first + 9].reshape(3, 3, 3, lanes, samples)
        for order in (1, 2):
            # a_k' = w x a_k, and a_k x (w x a_k) summed over three axes is 2 w, hence the half; in second order
            # the centripetal parts w x (w x a_k) add up to nothing
            spins[order - 1, :, :, k] = 0.5 * np.cross(axes[0], axes[order], axis=1).sum(axis=0).transpose(
                1, 2, 0
            )
    return spins


# Angles of links that run on over turns, from their rotors.
#
# An angle belongs to the value of the drive, not to the samples requested: turns are counted along the mesh
# of the path, outwards from the initial position, and a sample takes its turn from the nearest node.

Side: TypeAlias = npt.NDArray[np.int8]
Turns: TypeAlias = npt.NDArray[np.int32]
Lanes: TypeAlias = npt.NDArray[np.intp]
TURN = 2.0 * np.pi


@dataclass(frozen=True)
class NodeTurns:
    """Where a link points at the nodes of the mesh, and the whole turns to add to its angle in (-pi, pi] there.

    All have shape (lanes, nodes), or (1, nodes) where the lanes agree; `below` is 1 on the right of the x axis.
    `quick` has the stretches on which half a turn may lie between two nodes.
    """

    cosine: Array
    below: Side
    turns: Turns
    quick: Sequence[TurnedStretch] = ()

    def at(self, node: Lanes, cosine: Array, sine: Array, parameter: Array) -> Turns:
        """Turns of rotors (lanes, n) at parameters (n,) that are less than half a turn away from those at the nodes."""
        # a passage of pi between the node and the sample adds or takes a turn; no arc tangent is needed to
        # see it
        passed = _turns_between(self.cosine[:, node], self.below[:, node], cosine, _below(sine))
        turns: Turns = self.turns[:, node] + passed
        if self.quick:
            turns = np.broadcast_to(turns, np.broadcast_shapes(turns.shape, cosine.shape)).copy()
            with_quick_turns(turns, np.arctan2(sine, cosine), parameter, None, self.turns, self.quick)
        return turns

    def at_single(self, lanes: Lanes, node: Lanes, cosine: Array, sine: Array, parameter: Array) -> Turns:
        """Turns of the rotors of single mechanisms, one for each parameter; all arrays are (k,)."""
        rows = lanes if len(self.cosine) > 1 else np.zeros_like(lanes)
        passed = _turns_between(self.cosine[rows, node], self.below[rows, node], cosine, _below(sine))
        turns: Turns = self.turns[rows, node] + passed
        with_quick_turns(turns, np.arctan2(sine, cosine), parameter, lanes, self.turns, self.quick)
        return turns


def node_turns(
    rotor: tuple[object, object],
    initial: float,
    start: int,
    nodes: int,
    quick: Sequence[TurnedStretch] = (),
) -> NodeTurns:
    """Turns of an angle on a mesh of so many nodes; `initial` [rad] is its value near the node `start`."""
    cosine, sine = (_on_mesh(x, nodes) for x in rotor)
    cosine, sine = _fill_gaps(cosine, sine, start)
    below = _below(sine)
    turns = np.zeros(cosine.shape, dtype=np.int32)
    # as with angles: half a turn between two nodes is decided by the rotors alone
    steps = _turns_between(cosine[:, :-1], below[:, :-1], cosine[:, 1:], below[:, 1:])
    with_quick_steps(steps, quick)
    if steps.any():
        np.cumsum(steps, axis=1, out=turns[:, 1:])
    first = np.arctan2(sine[:, start], cosine[:, start])
    # shifted as a whole, so that the node at the start has the turns of the initial angle
    turns += (np.round((initial - first) / TURN).astype(np.int32) - turns[:, start])[:, None]
    return NodeTurns(cosine, below, turns, quick)


def _below(sine: Array) -> Side:
    # the sign of a zero counts, as it does in arctan2
    return np.signbit(sine).view(np.int8)


def _turns_between(cosine: Array, below: Side, next_cosine: Array, next_below: Side) -> Side:
    """Change of the number of turns from one rotor to the next: 1 past the angle pi, -1 back.

    Two unit vectors on either side of the x axis are less than half a turn apart across its negative half
    exactly if their cosines have a negative sum.
    """
    across = (cosine + next_cosine < 0.0).view(np.int8)
    # both signs: next_below - below is +1 from above to below through pi, -1 back, 0 on one side
    return np.asarray((next_below - below) * across)


def _on_mesh(x: object, nodes: int) -> Array:
    """Values (lanes, nodes), or (1, nodes) where the lanes agree."""
    values = np.atleast_2d(np.asarray(x.value if isinstance(x, Jet) else x, dtype=np.float64))
    return of_shape(values, (values.shape[0], nodes))


def _fill_gaps(cosine: Array, sine: Array, start: int) -> tuple[Array, Array]:
    """Rotors (lanes, nodes) with gaps filled by the last known one on the way from the start, in both directions."""
    shape = np.broadcast_shapes(cosine.shape, sine.shape)
    cosine, sine = of_shape(cosine, shape), of_shape(sine, shape)
    if np.isfinite(cosine.sum() + sine.sum()):
        return cosine, sine
    known = np.isfinite(cosine + sine)
    lanes, count = known.shape
    nodes = np.arange(count, dtype=np.int32)
    # -1 and count mark that nothing is known on the way yet
    source = np.where(known, nodes, np.int32(-1))
    behind = np.where(known[:, : start + 1], nodes[: start + 1], np.int32(count))
    behind = np.minimum.accumulate(behind[:, ::-1], axis=1)[:, ::-1]
    source[:, start:] = np.maximum.accumulate(source[:, start:], axis=1)
    source[:, :start] = behind[:, :start]
    missing = (source < 0) | (source >= count)
    source = np.where(missing, np.argmax(known, axis=1).astype(np.int32)[:, None], source)
    # flat indices, so that one `take` serves cosine and sine
    flat = source + (np.arange(lanes) * count)[:, None]
    somewhere = known.any(axis=1, keepdims=True)
    cosine, sine = (np.ascontiguousarray(x).reshape(-1)[flat] for x in (cosine, sine))
    return np.where(somewhere, cosine, 1.0), np.where(somewhere, sine, 0.0)


def angle_and_rates(rotor: Array, turns: Turns, angle: Array) -> None:
    """Fill in `angle` (3, ...), angle and its first two derivatives, from a rotor (3, 2, ...) and its turns."""
    cosine, sine = rotor[0]
    angle[0] = np.arctan2(sine, cosine)
    if turns.any():
        angle[0] += TURN * turns
    for order in (1, 2):
        # with a unit rotor: c s' - s c', and c s'' - s c'', as the terms with both first derivatives cancel
        np.subtract(cosine * rotor[order, 1], sine * rotor[order, 0], out=angle[order])
