"""Motions that a page plays, and of which paper shows how they begin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.sheets.texts import NOTHING, Text

if TYPE_CHECKING:
    import xarray

    from centrode.cams.followers.geometry import FollowerCam
    from centrode.cams.walking_wheel import WheelMover
    from centrode.model.mechanism import Mechanism
    from centrode.sheets.texts import Text, Title


@dataclass(frozen=True)
class MotionPlayer:
    """A motion that a page plays, and of which paper shows the initial position.

    Attributes
    ----------
    mechanism, motion : whose motion
    by_time : a slider goes through time, whatever the motion is a function of
    title : what moves so; nothing where the place says it
    marks : names and instants [s] that the slider through time marks
    """

    mechanism: Mechanism
    motion: xarray.Dataset
    by_time: bool = False
    title: Text = NOTHING
    marks: tuple[tuple[Text, float], ...] = ()


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
