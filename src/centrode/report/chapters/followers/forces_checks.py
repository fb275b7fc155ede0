"""Second routes to the forces of a follower: virtual work with its friction, springs put in, loads of strips."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.forces import least_push, meeting_of
from centrode.locale import _
from centrode.report.chapters.followers.parts import ROUNDED
from centrode.report.chapters.followers.profile_checks import angles
from centrode.report.telling import measured

if TYPE_CHECKING:
    from centrode.cams.followers.forces import Burden, FollowerForces
    from centrode.render.document.blocks import Check

NODES = 16
"""Of the rule of Gauss and Chebyshev, which integrates an ellipse exactly."""
FLAT_TOP = 1e-9
"""What the place of an extreme, known to some 1e-8 of its stretch, leaves of a value that vanishes."""


def by_virtual_work(forces: FollowerForces) -> Check:
    """The torque against what push and friction do on the follower's way and where surfaces slide."""
    phi = angles()
    rows, found = forces.body.motion.lift(phi, 2), forces.at(phi)
    met = meeting_of(forces.body, rows)
    carried = met.sense * np.stack([-met.place[:, 1], met.place[:, 0]], axis=1)
    slid = np.sum(met.slip * (carried - met.lever * rows[1][:, None]), axis=1)
    lost = forces.friction * found.normal * slid
    apart = np.abs(found.torque - (found.push * rows[1] + lost))
    known = np.isfinite(apart)
    size = float(np.max(np.abs(found.normal[known]), initial=0.0)) * float(np.abs(met.place).max())
    text = _(
        "At 720 angles the moment of the contact force about the cam's axis is what virtual work asks for, to {share}"
        " of force times radius."
    )
    if forces.friction:
        text = _(
            "At 720 angles the moment of the contact force about the cam's axis does what the push and the friction do"
            " on their ways, to {share} of force times radius."
        )
    return measured(text, float(np.max(apart[known], initial=0.0)), size, ROUNDED)


def at_speed_of_jumping(forces: FollowerForces, speed: float) -> Check:
    """The least push at the speed of jumping, which is zero."""
    return _vanishes(
        forces,
        forces.burden,
        speed,
        _("At this speed the least push over the turn is {share} of the greatest."),
    )


def with_spring(forces: FollowerForces, preload: float) -> Check:
    """The least push with the preload that is needed, which is zero."""
    text = _("With this preload the least push over the turn is {share} of the greatest.")
    return _vanishes(forces, replace(forces.burden, preload=preload), forces.speed, text)


def _vanishes(forces: FollowerForces, burden: Burden, speed: float, text: str) -> Check:
    motion = forces.body.motion
    least = least_push(motion, burden, speed).value
    rows = motion.lift(angles(), 2)
    size = float(np.abs(burden.needed(rows, speed)).max())
    return measured(text, abs(least), size, FLAT_TOP)


def strip_loads(forces: FollowerForces) -> Check:
    """Pressures of the strip added up over its width against the load that it carries."""
    found = forces.at(angles())
    strip, width = found.strip, forces.width
    assert strip is not None and width is not None
    load = np.abs(found.normal) / width
    # the pressures of a strip lie on an ellipse
    across = math.pi * np.arange(1, NODES + 1) / (NODES + 1)
    ellipse = math.pi / (NODES + 1) * float(np.sum(np.sin(across) ** 2))
    apart = np.abs(ellipse * strip.half_width * strip.pressure - load)
    known = np.isfinite(apart)
    text = _("The elliptic pressures, added up across the strip, carry the load to {share} of it.")
    share = (
        float(np.max(apart[known] / load[known], initial=0.0, where=load[known] > 0.0))
        if known.any()
        else math.nan
    )
    return measured(text, share, 1.0, ROUNDED)
