"""Outlines of cams and shoes as pieces of smooth curves, with their slopes: what drawings and files are made of."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, TypeAlias

import numpy as np

from centrode.cams.closed.arcs import Arc
from centrode.cams.frames import Array, frames
from centrode.cams.profiles.bodies import CLOSED, CamBody
from centrode.cams.profiles.equidistants import Side, equidistant, signed
from centrode.cams.wheel.shoe import Shoe

Layer: TypeAlias = Literal[
    "profile-working",
    "profile-return",
    "groove-working",
    "groove-return",
    "path",
    "shoe",
    "profile",
    "cutter",
]
LEAST_PIECE = 8
"""Least number of spaces between points of a piece."""


@dataclass(frozen=True)
class Outline:
    """A smooth piece of a curve.

    Attributes
    ----------
    layer : str
        What it belongs to.
    phi : (n) [rad]
        Growing; about a corner by what the normal has turned.
    places, slopes : (n, 2) [m], [m/rad]
        Points and derivatives by phi.
    normals : (n, 2), optional
        Unit vectors out of the cam, where they are known.
    """

    layer: Layer
    phi: Array
    places: Array
    slopes: Array
    normals: Array | None = None


def cam_outlines(body: CamBody, samples: int, *, groove: bool = False) -> list[Outline]:
    """The roller's path, the profile, and the outer wall of a groove if asked, each in pieces between breaks.

    Parameters
    ----------
    samples : int
        Spaces between points over the whole turn, about.

    Raises
    ------
    InputError
        The roller is larger than a hollow of the groove.
    """
    if groove:
        body.fit_groove()
    found: list[Outline] = []
    for arc, phi in pieces(body.closed.arcs, samples):
        frame = frames(arc.curve, phi)
        found.append(Outline("path", phi, frame.place, frame.speed[:, None] * frame.tangent))
        sides: tuple[Side, ...] = ("inner", "outer") if groove else ("inner",)
        for side in sides:
            off = equidistant(frame, signed(body.roller, side))
            name: Layer
            if side == "inner":
                name = "profile-working" if arc.kind == "working" else "profile-return"
            else:
                name = "groove-working" if arc.kind == "working" else "groove-return"
            found.append(Outline(name, phi, off.place, off.speed[:, None] * frame.tangent))
        number = body.closed.arcs.index(arc)
        if phi[-1] > arc.edges[-2] and number < len(body.closed.joints):
            found += [one for side in sides for one in _corner(body, number, side, samples)]
    return found


def _corner(body: CamBody, number: int, side: Side, samples: int) -> list[Outline]:
    """The roller's own arc about a corner of the path, on the side where the walls before and behind it part."""
    joint, arc = body.closed.joints[number], body.closed.arcs[number]
    parts: Side = "outer" if joint.kink < 0.0 else "inner"
    if abs(joint.kink) <= CLOSED or side != parts:
        return []
    frame = frames(arc.curve, np.array([arc.stop]))
    count = max(2 * LEAST_PIECE, round(samples * abs(joint.kink) / math.tau))
    turned = np.linspace(0.0, abs(joint.kink), count + 1)
    sense, distance = -math.copysign(1.0, joint.kink), signed(body.roller, side)
    normal = frame.normal_angle + sense * turned
    outwards = np.stack([np.sin(normal), np.cos(normal)], axis=-1)
    along = np.stack([np.cos(normal), -np.sin(normal)], axis=-1)
    layer: Layer = "groove-return" if side == "outer" else "profile-return"
    return [Outline(layer, joint.at + turned, frame.place + distance * outwards, sense * distance * along)]


def shoe_outlines(shoe: Shoe, samples: int) -> list[Outline]:
    """The profile of a shoe in the leg's axes, in pieces between breaks."""
    found = []
    for _arc, phi in pieces([shoe.arc], samples):
        along = np.stack([np.cos(phi), -np.sin(phi)], axis=-1)
        found.append(Outline("shoe", phi, shoe.place(phi), shoe.bend(phi)[:, None] * along))
    return found


def pieces(arcs: Sequence[Arc], samples: int) -> list[tuple[Arc, Array]]:
    """Arcs between their breaks, and angles evenly spaced over each."""
    turn = sum(arc.stop - arc.start for arc in arcs)
    found = []
    for arc in arcs:
        for low, high in pairwise(arc.edges):
            count = max(LEAST_PIECE, round(samples * (high - low) / turn))
            # a break belongs to the piece behind it: the end of this one is asked for just before
            found.append((arc, np.append(np.linspace(low, high, count + 1)[:-1], np.nextafter(high, low))))
    return found
