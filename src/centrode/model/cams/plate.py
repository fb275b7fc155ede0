"""The description of a plate cam with a follower whose lift is given over a turn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, ModelWrapValidatorHandler, model_validator

from centrode.laws import SegmentedLaw
from centrode.model.asked import Display
from centrode.model.cams.followers import Bounds, CamBody, Follower, FollowerStudy, Tool
from centrode.model.cams.lifting import MOST, LiftSegment, lift_law, segment_problems
from centrode.model.entries import choice, listed
from centrode.model.part import Part
from centrode.model.problems import Problems
from centrode.model.reports import CamReportWishes
from centrode.model.segments import DRIVEN
from centrode.model.values import Text


class PlateCam(Part):
    """A turning plate cam and its follower, by the follower's lift.

    The arguments are those of a file (docs: cam followers), as parts or as plain dicts, texts with units included.
    All numbers it holds are SI.

    Attributes
    ----------
    title : str
    kind : "cam"
    display : Display
    body : CamBody
        "cam" in a file.
    follower : Follower
    segments : tuple of LiftSegment
        They fill a turn and bring the lift back to 0.
    bounds : Bounds
    tool : Tool or None
    study : FollowerStudy
    report : CamReportWishes

    Raises
    ------
    InputError
        Anything that is not a description, with its place and the repair.
    """

    title: Text = ""
    kind: Annotated[Literal["cam"], choice("cam")]
    display: Display = Display()
    body: Annotated[CamBody, Field(alias="cam")] = CamBody()
    follower: Follower
    segments: Annotated[tuple[LiftSegment, ...], listed(MOST)]
    bounds: Bounds = Bounds()
    tool: Tool | None = None
    study: FollowerStudy = FollowerStudy()
    report: CamReportWishes = CamReportWishes()

    if TYPE_CHECKING:

        def __init__(self, **parts: Any) -> None: ...

    @model_validator(mode="wrap")
    @classmethod
    def _of_its_follower(cls, data: Any, handler: ModelWrapValidatorHandler[PlateCam]) -> PlateCam:
        token = DRIVEN.set("angle" if _swings(data) else "length")
        try:
            return handler(data)
        finally:
            DRIVEN.reset(token)

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        problems = segment_problems(self.segments)
        if problems:
            raise Problems(problems)
        return self

    @property
    def swings(self) -> bool:
        """Whether the follower is an oscillating one: its lift is an angle."""
        return self.follower.kind == "oscillating"

    @property
    def lift_law(self) -> SegmentedLaw:
        """Lift [m or rad] over the angle of the cam [rad], turn after turn."""
        return lift_law(self.segments)


def _swings(data: Any) -> bool:
    """Whether what is read says that its follower oscillates."""
    follower = data.get("follower") if isinstance(data, Mapping) else getattr(data, "follower", None)
    kind = follower.get("kind") if isinstance(follower, Mapping) else getattr(follower, "kind", None)
    return bool(kind == "oscillating")
