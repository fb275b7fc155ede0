"""Descriptions to start from: an inversion of a chain as a mechanism whose points stand as in its sketch.

Joints of a sketch that lie symmetrically may make a dead position, so they are moved a little, each by itself. Drives
turn links against the frame where that suffices, and other links against each other otherwise.
"""

from __future__ import annotations

import string
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import tomli_w

from centrode.chains.kinematic_chains import Joint, KinematicChain
from centrode.chains.planar_drawings import ChainSketch, chain_sketch
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.files import parse_mechanism
from centrode.model.mechanism import Mechanism
from centrode.model.toml import in_short_lines

Array: TypeAlias = npt.NDArray[np.float64]

SIDE = 100.0
"""Length of a side [mm]."""
GOLDEN, ASIDE = 2.399963229728653, 6.0
"""Angle between the directions in which one joint after the other is moved, and how far [mm]."""
WELL = 3e-3
"""Least singular value of the velocity equations, over the greatest, at which no other joints are looked at."""


def start_description(
    chain: KinematicChain, inversion: int = 1, sketch: ChainSketch | None = None
) -> Mechanism:
    """An inversion of a chain as a mechanism with turning joints, ready to be changed.

    Parameters
    ----------
    chain : KinematicChain
    inversion : number of the inversion, from 1 in the order of `chain.inversions`
    sketch : where its joints stand; by default that of `chain_sketch`

    Returns
    -------
    Mechanism
        Sides of links are some 100 mm long; as many links are driven as the chain has mobility.

    Raises
    ------
    InputError
        There is no inversion of this number; a truss cannot be driven.

    Examples
    --------
    >>> import centrode as ct
    >>> watt, stephenson = ct.chains(6)
    >>> ct.check(start_description(stephenson, 3)).mobility
    1
    """
    return parse_mechanism(start_text(chain, inversion, sketch))


def start_text(chain: KinematicChain, inversion: int = 1, sketch: ChainSketch | None = None) -> str:
    """The same as the text of a file, with the coordinates of the points; raises as `start_description` does."""
    if not 1 <= inversion <= len(chain.inversions):
        what = _("there is no inversion {number}").format(number=inversion)
        raise InputError("inversion", what, _("this chain has {count}").format(count=len(chain.inversions)))
    if chain.mobility < 1:
        raise InputError("chain", _("a truss has no freedom, so nothing of it can be driven"))
    sketch = chain_sketch(chain) if sketch is None else sketch
    frame = chain.inversions[inversion - 1].frame
    letters = _letters(len(chain.joints))
    names = ["".join(sorted(letters[k] for k in ring)) for ring in sketch.outlines]
    places = _generic(sketch.places)
    driven = _driven(chain, places, frame)
    moving = [link for link in range(chain.links) if link != frame]
    tables = {
        "title": _title(chain, inversion),
        "display": {"length": "mm", "angle": "deg"},
        "points": {
            letter: [f"{x:.1f} mm" for x in place] for letter, place in zip(letters, places, strict=True)
        },
        "frame": {"points": [letters[k] for k in sorted(sketch.outlines[frame])]},
        "links": {
            names[link]: {"points": [letters[k] for k in sorted(sketch.outlines[link])]} for link in moving
        },
        "drives": [_drive(names, frame, chain.joints[joint]) for joint in driven],
    }
    return in_short_lines(tomli_w.dumps(tables))


def start_texts(chain: KinematicChain) -> Iterator[str]:
    """The texts of all inversions of a chain, in their order."""
    sketch = chain_sketch(chain)
    for number in range(1, 1 + len(chain.inversions)):
        yield start_text(chain, number, sketch)


def _letters(count: int) -> str:
    """Names of points; I and O look like figures."""
    return "".join(letter for letter in string.ascii_uppercase if letter not in "IO")[:count]


def _title(chain: KinematicChain, inversion: int) -> str:
    return _("Chain of {links} links, inversion {number} of {count}").format(
        links=chain.links, number=inversion, count=len(chain.inversions)
    )


def _generic(places: Array) -> Array:
    """Coordinates [mm], to the digits that a file shows, off every symmetry."""
    turn = GOLDEN * np.arange(len(places))
    moved = SIDE * places + ASIDE * np.column_stack([np.cos(turn), np.sin(turn)])
    return np.asarray(np.round(moved - moved.min(axis=0), 1))


def _drivable(joints: Sequence[Joint], frame: int, count: int) -> Iterator[tuple[int, ...]]:
    """So many joints whose angles may be given, those of the frame first."""
    at_frame = [k for k, joint in enumerate(joints) if frame in joint]
    elsewhere = [k for k in range(len(joints)) if k not in at_frame]
    return combinations(at_frame + elsewhere, count)


def _driven(chain: KinematicChain, places: Array, frame: int) -> tuple[int, ...]:
    """The first joints that move all links well, or those that move them best."""
    best: tuple[int, ...] = ()
    share = -1.0
    for joints in _drivable(chain.joints, frame, chain.mobility):
        found = _conditioning(chain, places, frame, joints)
        if found > share:
            best, share = joints, found
        if found > WELL:
            break
    return best


def _conditioning(chain: KinematicChain, places: Array, frame: int, driven: Sequence[int]) -> float:
    """How surely velocities of all links follow from those of driven joints: least over greatest singular value."""
    rows = np.zeros((2 * len(chain.joints) + len(driven), chain.links, 3))
    for k, (joint, place) in enumerate(zip(chain.joints, places / SIDE, strict=True)):
        for link, sign in zip(joint, (1.0, -1.0), strict=True):
            # velocity of the place on the link, from that of the origin and the angular velocity
            rows[2 * k, link] = sign * np.array([1.0, 0.0, -place[1]])
            rows[2 * k + 1, link] = sign * np.array([0.0, 1.0, place[0]])
    for k, number in enumerate(driven):
        one, other = chain.joints[number]
        rows[2 * len(chain.joints) + k, [one, other], 2] = 1.0, -1.0
    free = [link for link in range(chain.links) if link != frame]
    values = np.linalg.svd(rows[:, free].reshape(len(rows), -1), compute_uv=False)
    return float(values[-1] / values[0])


def _drive(names: Sequence[str], frame: int, joint: Joint) -> dict[str, Any]:
    one, other = joint if joint[1] == frame else joint[::-1]
    drive = {"link": names[one], "speed": "1 rad/s"}
    return drive if other == frame else {**drive, "relative_to": names[other]}
