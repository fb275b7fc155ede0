"""Animations of results that are there already: a motion, centrodes, a walking wheel, a cam with roller or follower.

What `frames`, `dark` and `said` are is told by `animate_motion` for all of them; what is shown of cams has the units of
`display`, metres and radians if it is left out.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from centrode.errors import InputError
from centrode.locale import _
from centrode.present.animations import timing
from centrode.present.animations.animate import stage_of
from centrode.present.animations.cams import roller_stage, walking_stage
from centrode.present.animations.centrodes import CentrodesLayer
from centrode.present.animations.encoding import Said, no_progress
from centrode.present.animations.followers import follower_stage
from centrode.present.animations.motions import scene_of_film
from centrode.present.animations.paces import write_stage
from centrode.present.animations.shown import Shown
from centrode.present.animations.timing import SIZE, Timing
from centrode.study.moving.courses import course_from
from centrode.study.moving.films import film_from

if TYPE_CHECKING:
    import xarray

    from centrode.analysis.instant_centres.results import CentrodeResults
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.cams.profiles import ProfileBody
    from centrode.cams.walking_wheel import WheelMover
    from centrode.model.mechanism import Mechanism
    from centrode.model.settings import Display

FRAMES = 48
FRAMES_OF_A_STEP = 36
PER_SECOND = 100.0 / 7.0
FRAMES_OF_A_TURN, PER_SECOND_OF_A_TURN = timing.FRAMES, timing.PER_SECOND


def animate_motion(
    mechanism: Mechanism,
    dataset: xarray.Dataset,
    path: Path,
    *,
    frames: int | None = None,
    dark: bool = False,
    said: Said = no_progress,
) -> None:
    """Write an animation (GIF or MP4) of a motion; where the motion does not close, it runs there and back.

    Parameters
    ----------
    mechanism : Mechanism
    dataset : Dataset
        Its motion, of `motion` or of `simulate` with the motion: the frames are some of its samples. `animate` computes
        its own, evenly spaced.
    path : Path
        The file, GIF or MP4 by the ending of its name.
    frames : int
        Of the motion one way; 48 if left out, 36 of a step of a walking wheel, 60 of a turn of a cam.
    dark : bool
        Light lines on a dark ground.
    said : callable
        Told after each frame how many are done, and of how many.

    Raises
    ------
    InputError
        No sample has every point in place.
    """
    film = film_from(course_from(mechanism, dataset), frames or FRAMES)
    stage, _notes = stage_of(film, Shown(), SIZE, dark=dark)
    write_stage(stage, Path(path), Timing(stage.frames, PER_SECOND), said)


def animate_centrodes(
    mechanism: Mechanism,
    motion: xarray.Dataset,
    centrodes: xarray.Dataset,
    path: Path,
    dark: bool = False,
    *,
    said: Said = no_progress,
) -> None:
    """Write an animation (GIF or MP4) of one centrode rolling on the other; raises InputError where nothing rolls."""
    if int((centrodes["centrode_piece"].to_numpy() >= 0).sum()) < 2:
        raise InputError(
            "link", _("there is no centrode in this range"), _("ask for another link or another range")
        )
    film = film_from(course_from(mechanism, motion), FRAMES)
    scene = scene_of_film(film)
    rolling = CentrodesLayer(
        film, scene, str(centrodes.attrs["link"]), str(centrodes.attrs["against"]), centrodes
    )
    stage, _notes = stage_of(film, Shown(()), SIZE, dark=dark, more=[rolling])
    write_stage(stage, Path(path), Timing(stage.frames, PER_SECOND), said)


def animate_rolling(results: CentrodeResults, path: Path, dark: bool = False) -> None:
    """Write an animation (GIF or MP4) of the centrodes of a result; raises InputError where nothing rolls."""
    animate_centrodes(results.mechanism, results.motion, results.centrodes, path, dark)


def animate_walking(
    wheel: WheelMover,
    path: Path,
    title: str = "",
    display: Display | None = None,
    *,
    frames: int | None = None,
    dark: bool = False,
    said: Said = no_progress,
) -> None:
    """Write an animation (GIF or MP4) of one step of a walking wheel, that of `walking_wheel`, seen from its hub."""
    stage = walking_stage(wheel, frames or FRAMES_OF_A_STEP, SIZE, title, display, dark=dark)
    write_stage(stage, Path(path), Timing(stage.frames, PER_SECOND), said)


def animate_cam_body(
    body: ProfileBody,
    path: Path,
    title: str = "",
    display: Display | None = None,
    *,
    frames: int | None = None,
    dark: bool = False,
    said: Said = no_progress,
) -> None:
    """Write an animation (GIF or MP4) of a turn of a cam, that of `cam_body`, below its roller, or there and back."""
    stage = roller_stage(body, frames or FRAMES_OF_A_TURN, SIZE, title, display, dark=dark)
    write_stage(stage, Path(path), Timing(stage.frames, PER_SECOND_OF_A_TURN), said)


def animate_follower(
    body: FollowerCam,
    path: Path,
    title: str = "",
    display: Display | None = None,
    *,
    frames: int | None = None,
    dark: bool = False,
    said: Said = no_progress,
) -> None:
    """Write an animation (GIF or MP4) of one turn of a cam, that of `follower_cam`, below its follower."""
    stage = follower_stage(body, frames or FRAMES_OF_A_TURN, SIZE, title, display, dark=dark)
    write_stage(stage, Path(path), Timing(stage.frames, PER_SECOND_OF_A_TURN), said)
