"""Joints with play: which pins, holes and guides of a description have some, and how much."""

from __future__ import annotations

from dataclasses import dataclass

from centrode.model.mechanism import Mechanism
from centrode.model.tolerance_checks import bodies_at_pin


@dataclass(frozen=True)
class JointPlay:
    """Play of one joint.

    Attributes
    ----------
    name : "B/AB" of link AB on the pin B; of a slider that of its guide
    body : whose hole or guide it is: the link, or what carries the guide
    point : the pin; empty of a guide
    play : [m], on the sphere an arc [rad]
    length : of a slider that tilts [m], else None
    """

    name: str
    body: str
    point: str
    play: float
    length: float | None = None


def play_of(mechanism: Mechanism) -> tuple[JointPlay, ...]:
    """Joints that have play in the description."""
    settings = mechanism.tolerances
    found: dict[str, JointPlay] = {}
    guides = {guide.id: guide for guide in mechanism.guides}
    for name, clearance in (settings.clearances if settings is not None else {}).items():
        pin, _slash, link = name.partition("/")
        bodies = bodies_at_pin(mechanism, pin) if pin in mechanism.points else []
        if name in guides:
            found[name] = JointPlay(name, guides[name].on, "", clearance.play, clearance.length)
        for body in [link] if link else bodies[1:]:
            label = f"{pin}/{body}"
            # what names one link goes before what names all of them
            if label not in found or link:
                found[label] = JointPlay(label, body, pin, clearance.play)
    return tuple(found.values())
