"""What the chapters of a report are made from: results that are computed when first asked for, and once."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, TypeVar, cast

import xarray as xr

from centrode.equations.derivation import Equations, equations
from centrode.model.cam import Cam
from centrode.model.cam_files import AnyCam
from centrode.model.follower_cam import PlateCam
from centrode.model.mechanism import Mechanism
from centrode.render.document.numbers import Numbers
from centrode.report.options import Wishes
from centrode.study.cams.results import CamResults, cam_results
from centrode.study.check import Check, check
from centrode.study.run import StudyResults, study

Made = TypeVar("Made")


class ReportStudy:
    """A description with its wishes and its results.

    Attributes
    ----------
    description : Mechanism, Cam or PlateCam
    wishes : what the report is to hold
    numbers : how it spells its numbers
    """

    def __init__(self, description: Mechanism | AnyCam, wishes: Wishes) -> None:
        self.description = description
        self.wishes = wishes
        self.numbers = Numbers(description.display, wishes.digits)
        self._made: dict[Hashable, Any] = {}

    def once(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """What `make` gives, made at the first call with this key; a failure is raised again, not repeated."""
        if key not in self._made:
            try:
                self._made[key] = make()
            except Exception as failure:
                self._made[key] = _Failed(failure)
        made = self._made[key]
        if isinstance(made, _Failed):
            raise made.failure
        return cast(Made, made)

    def wants(self, chapter: str) -> bool:
        """Whether a chapter is asked for: by its name, or because nobody chose."""
        return self.wishes.chapters is None or chapter in self.wishes.chapters

    def assemble(self) -> None:
        """Raise as `check` does for a linkage that does not assemble: there is nothing to report on it."""
        if not self.is_cam:
            _structure = self.check

    @property
    def is_cam(self) -> bool:
        """Whether a cam is reported on, of either kind."""
        return isinstance(self.description, Cam | PlateCam)

    @property
    def is_plate_cam(self) -> bool:
        """Whether a cam is reported on that its follower's lift gives."""
        return isinstance(self.description, PlateCam)

    @property
    def is_planar(self) -> bool:
        """Whether a planar linkage is reported on."""
        return isinstance(self.description, Mechanism) and self.description.space == "plane"

    @property
    def is_spherical(self) -> bool:
        """Whether a spherical linkage is reported on."""
        return isinstance(self.description, Mechanism) and self.description.space == "sphere"

    @property
    def mechanism(self) -> Mechanism:
        """The linkage; chapters of cams do not ask."""
        assert isinstance(self.description, Mechanism)
        return self.description

    @property
    def cam(self) -> Cam:
        """The cam by a curvature law; other chapters do not ask."""
        assert isinstance(self.description, Cam)
        return self.description

    @property
    def plate(self) -> PlateCam:
        """The cam by its follower's lift; other chapters do not ask."""
        assert isinstance(self.description, PlateCam)
        return self.description

    @property
    def check(self) -> Check:
        """Structure, mobility, plan, initial position."""
        return self.once("check", lambda: check(self.mechanism))

    @property
    def study(self) -> StudyResults:
        """Everything that `run` computes."""
        return self.once("study", lambda: study(self.mechanism))

    @property
    def motion(self) -> xr.Dataset:
        """The labelled motion."""
        return self.study.motion

    @property
    def equations(self) -> Equations:
        """The equations in symbols."""
        return self.once("equations", lambda: equations(self.mechanism))

    @property
    def points(self) -> tuple[str, ...]:
        """Points whose velocities and paths are told: those asked for, else those on guides of the frame."""
        return self.equations.sliding if self.wishes.points is None else self.wishes.points

    @property
    def cam_results(self) -> CamResults:
        """Everything about a cam."""
        assert isinstance(self.description, Cam | PlateCam)
        cam = self.description
        return self.once("cam", lambda: cam_results(cam))


class _Failed:
    """A failure that is kept in place of a result."""

    def __init__(self, failure: Exception) -> None:
        self.failure = failure
