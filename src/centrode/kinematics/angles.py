"""Angles of links that run on over turns, from their rotors.

An angle belongs to the value of the drive, not to the samples asked for: it is counted along the mesh of
the path, outwards from the initial position, and a sample takes its turn from the nearest node.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]
TURN = 2.0 * np.pi


def node_angles(
    positions: Positions, links: tuple[str, ...], initial: Array, start: int, shape: tuple[int, int]
) -> Array:
    """Continuous angles (links, lanes, nodes) on the mesh; `initial` (links,) are those at the node `start`."""
    angles = np.empty((len(links), *shape))
    for k, link in enumerate(links):
        cosine, sine = (np.broadcast_to(_plain(x), shape) for x in positions.poses[link].rotor)
        angles[k] = np.unwrap(_bridged(np.arctan2(sine, cosine)), axis=-1)
    turns = np.round((initial[:, None] - angles[:, :, start]) / TURN)
    return np.asarray(angles + TURN * turns[:, :, None])


def _plain(x: object) -> Array:
    return np.asarray(x.value if isinstance(x, Jet) else x, dtype=np.float64)


def _bridged(angle: Array) -> Array:
    """The same angles with gaps filled by the last known value before them (the first one after, at the beginning)."""
    known = np.isfinite(angle)
    if known.all():
        return angle
    nodes = np.arange(angle.shape[1])
    last = np.maximum.accumulate(np.where(known, nodes, -1), axis=1)
    first = np.argmax(known, axis=1)
    filled = np.take_along_axis(angle, np.where(last < 0, first[:, None], last), axis=1)
    return np.where(np.isfinite(filled), filled, 0.0)


def angles_and_rates(
    rotors: Array, nodes: Array, nearest: npt.NDArray[np.intp]
) -> tuple[Array, Array, Array]:
    """Angle and its first two derivatives from rotors (3, links, 2, lanes, n): each (links, lanes, n)."""
    cosine, sine = rotors[0, :, 0], rotors[0, :, 1]
    near = nodes[:, :, nearest]
    angle = near + (np.arctan2(sine, cosine) - near + np.pi) % TURN - np.pi
    rate = cosine * rotors[1, :, 1] - sine * rotors[1, :, 0]
    second = cosine * rotors[2, :, 1] - sine * rotors[2, :, 0]
    return angle, rate, second
