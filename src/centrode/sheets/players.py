"""Motions that a page plays, and of which paper shows how they begin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

from centrode.sheets.texts import NOTHING, Joined, Text

if TYPE_CHECKING:
    import xarray

    from centrode.cams.followers.geometry import FollowerCam
    from centrode.cams.walking_wheel import WheelMover
    from centrode.model.mechanism import Mechanism
    from centrode.sheets.texts import Text, Title

EventSign: TypeAlias = Literal["impact", "stick", "slip", "close", "open", "user", "other"]
"""By which a slider tells events apart."""


@dataclass(frozen=True)
class MarkedEvent:
    """An event that the slider through time marks.

    Attributes
    ----------
    kind : what happened
    time : [s]
    sign : how it is marked
    part : the stop, clamp, friction or user's event; nothing of what belongs to the whole mechanism
    impulse, loss : of an impact, with units
    """

    kind: Text
    time: float
    sign: EventSign = "other"
    part: Text = NOTHING
    impulse: Text = NOTHING
    loss: Text = NOTHING

    @property
    def name(self) -> Text:
        """What happened where."""
        return self.kind if self.part == NOTHING else Joined((self.part, self.kind), ": ")


@dataclass(frozen=True)
class HeldStretch:
    """A stretch of time in which a friction sticks, a stop is closed or a clamp holds.

    Attributes
    ----------
    name : of what holds
    begin, end : [s]
    """

    name: Text
    begin: float
    end: float


@dataclass(frozen=True)
class MotionPlayer:
    """A motion that a page plays, and of which paper shows the initial position.

    Attributes
    ----------
    mechanism, motion : whose motion
    by_time : a slider goes through time, whatever the motion is a function of
    marks : events that the slider through time marks
    held : stretches that it shades
    title : what moves so; nothing where the place says it
    loops : whether it begins again where it ends
    """

    mechanism: Mechanism
    motion: xarray.Dataset
    by_time: bool = False
    marks: tuple[MarkedEvent, ...] = ()
    held: tuple[HeldStretch, ...] = ()
    title: Text = NOTHING
    loops: bool = False


@dataclass(frozen=True)
class CamPlayer:
    """A cam that turns under its follower: a page plays it, paper shows how it begins.

    Attributes
    ----------
    title : of the cam
    body : the cam with its follower
    """

    title: Title
    body: FollowerCam


@dataclass(frozen=True)
class WheelPlayer:
    """A wheel that walks: a page plays it, paper shows how it begins.

    Attributes
    ----------
    title : of its cam
    wheel : what moves
    """

    title: Title
    wheel: WheelMover
