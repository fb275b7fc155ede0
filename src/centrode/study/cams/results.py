"""What a cam's description asks for, part by part: each part has its datasets, its rows and its numbers.

A part is computed where `wanted` says that the description asks for it; `cam_results` runs them in this order, the
command prints and writes what they give. What other rooms compute of a cam is added as further parts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from centrode.model.cam import Cam
from centrode.model.cam_files import AnyCam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.choice import choice_part
from centrode.study.cams.contact import contact_part
from centrode.study.cams.parts import Asked, CamPart
from centrode.study.cams.profiles import profile_part, walking_part


class MakesPart(Protocol):
    """Computes a part of the results; None where the description does not ask for it."""

    def __call__(self, cam: Cam, asked: Asked) -> CamPart | None: ...


PARTS: Mapping[str, MakesPart] = {
    "profile": profile_part,
    "walking": walking_part,
    "contact": contact_part,
    "choice": choice_part,
}
"""Parts by name, in the order in which they are computed and shown."""


@dataclass(frozen=True)
class CamResults:
    """Everything about a cam: its parts by name."""

    cam: AnyCam
    parts: Mapping[str, CamPart]

    @property
    def scalars(self) -> dict[str, Scalar]:
        """All numbers, in SI."""
        return {name: one for part in self.parts.values() for name, one in part.scalars.items()}

    @property
    def objects(self) -> dict[str, Any]:
        """What drawings need besides the datasets."""
        return {name: one for part in self.parts.values() for name, one in part.objects.items()}

    @property
    def failures(self) -> list[str]:
        """What the cam cannot do of what was asked."""
        return [one for part in self.parts.values() for one in part.failures]


def cam_results(
    cam: AnyCam,
    samples: int | None = None,
    terms: int | None = None,
    *,
    groove: bool = False,
    front: bool = False,
) -> CamResults:
    """Everything about the cam of a description but for what its follower gives.

    Parameters
    ----------
    cam : Cam or PlateCam
    samples : int
        Evenly spaced over the range or the turn; the description's own number, else 361.
    terms : int
        Of the power series; the description's own number, else 20.
    groove : bool
        Also the outer wall of a groove that the roller runs in.
    front : bool
        Also the front of best designs where `[choose] trade_off` names a measure; it takes some seconds.

    Raises
    ------
    InputError
        What `ct.cam` and `ct.cam_routes` refuse.
    """
    asked = Asked(samples, terms, groove, front)
    found: dict[str, CamPart | None] = {}
    if isinstance(cam, Cam):
        found = {name: make(cam, asked) for name, make in PARTS.items()}
    return CamResults(cam, {name: part for name, part in found.items() if part is not None})
