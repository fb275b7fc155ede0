"""What a cam's description asks for, part by part: each part has its datasets, its rows and its numbers.

A part is computed where `wanted` says that the description asks for it; `cam_results` runs them in this order, the
command prints and writes what they give. What other rooms compute of a cam is added as further parts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from centrode.model.cam_files import AnyCam
from centrode.model.follower_cam import PlateCam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.follower_cam import plate_part
from centrode.study.cams.parts import Asked, CamPart


class MakesFollowerPart(Protocol):
    """Computes a part of the results; None where the description does not ask for it."""

    def __call__(self, cam: PlateCam, asked: Asked) -> CamPart | None: ...


FOLLOWER_PARTS: Mapping[str, MakesFollowerPart] = {
    "profile": plate_part,
}
"""Parts of a cam that is given by its follower's lift, by name."""


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


def cam_results(cam: AnyCam, samples: int | None = None) -> CamResults:
    """The profile of a cam that is given by its follower's lift; nothing of one by a curvature law.

    Parameters
    ----------
    cam : Cam or PlateCam
    samples : int
        Evenly spaced over the turn; the description's own number, else 361.

    Raises
    ------
    InputError
        What `ct.cam` refuses.
    """
    if not isinstance(cam, PlateCam):
        return CamResults(cam, {})
    found = {name: make(cam, Asked(samples)) for name, make in FOLLOWER_PARTS.items()}
    return CamResults(cam, {name: part for name, part in found.items() if part is not None})
