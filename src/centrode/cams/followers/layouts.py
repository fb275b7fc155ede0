"""What a follower is and how it stands to its cam, before the size of the cam is chosen."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.contact import Face, Motion, Point, Touch
from centrode.cams.followers.guidance import (
    Guidance,
    Translating,
    oscillating,
    oscillating_face,
    translating,
)
from centrode.cams.nodes import nodes_of
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cams.plate import PlateCam

Kind: TypeAlias = Literal["translating", "oscillating"]


@dataclass(frozen=True)
class Layout:
    """A follower and the sense in which its cam turns.

    Attributes
    ----------
    kind : "translating" or "oscillating"
    touch : Point or Face
    offset : float [m]
        x of the axis of a translating follower.
    arm, distance, face_offset : float [m]
        Of an oscillating follower: of the roller's centre from the pivot; of the pivot from the cam's centre; by how
        much the line of a flat face passes the pivot on the cam's side.
    sense : +1 or -1
        Whether the cam turns counter-clockwise or clockwise.
    """

    kind: Kind
    touch: Touch
    offset: float = 0.0
    arm: float = 0.0
    distance: float = 0.0
    face_offset: float = 0.0
    sense: float = 1.0

    @property
    def flat(self) -> bool:
        return isinstance(self.touch, Face)

    def guide(self, base_radius: float) -> Guidance:
        """How the follower is led on a cam of this base radius [m]; raises InputError where it does not reach it."""
        if self.kind == "translating":
            if self.flat:
                return Translating(base_radius, self.offset)
            return translating(base_radius + self.touch.roller, self.offset)
        if self.flat:
            return oscillating_face(base_radius, self.distance, self.face_offset)
        return oscillating(base_radius + self.touch.roller, self.arm, self.distance)

    def cam(self, motion: Motion, base_radius: float) -> FollowerCam:
        """The cam of this base radius [m] for a motion.

        Raises
        ------
        InputError
            A follower that does not reach the base circle; one that the cam cannot lead all the way: it would have to
            go through the cam's centre or its pivot's line, or turn its face faster than the cam turns.
        """
        cam = FollowerCam(motion, self.guide(base_radius), self.touch, base_radius, self.sense)
        _check_led(cam)
        return cam


def _check_led(cam: FollowerCam) -> None:
    """Raise InputError at the first angle at which the follower cannot be led."""
    phi = nodes_of(cam.edges)
    found = cam.contact(phi)
    turning = found.pace
    bad = np.flatnonzero(~((np.cos(found.pressure_angle) > 0.0) & (turning > 0.0)))
    if not bad.size:
        return
    what = _("the follower cannot be led through {angle:.6g} deg: its pressure angle reaches 90 deg there")
    if not turning[bad[0]] > 0.0:
        what = _("at {angle:.6g} deg the flat face would have to turn faster than the cam")
    told = what.format(angle=math.degrees(phi[bad[0]]))
    raise InputError("[follower]", told, _("take a smaller lift, a longer segment or a greater base radius"))


def layout_of(cam: PlateCam) -> Layout:
    """The layout of a description."""
    given = cam.follower
    touch = Face() if given.contact == "flat" else Point(given.roller_radius or 0.0)
    return Layout(
        given.kind,
        touch,
        given.offset,
        given.arm or 0.0,
        given.pivot_distance or 0.0,
        given.face_offset,
        1.0 if cam.body.turn == "counter-clockwise" else -1.0,
    )
