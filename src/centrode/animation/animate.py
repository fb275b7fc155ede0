"""Animations of mechanisms and cams: what is asked for, from the motion to the file."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.animation.centrodes import CentresLayer, CentrodesLayer
from centrode.animation.frames import (
    Course,
    Film,
    course_from,
    course_of,
    course_of_simulation,
    film_from,
    film_of,
    film_of_simulation,
)
from centrode.animation.layers import Layer, instant_captions, scene_of_film, statuses_of
from centrode.animation.linkages import LinksLayer, PathsLayer
from centrode.animation.stage import Stage
from centrode.animation.vectors import joint_layer, load_layer, point_vectors, share_scale
from centrode.animation.video_files import (
    SIZE,
    Animation,
    Pace,
    Said,
    Timing,
    check_timing,
    kind_of,
    need_video,
    no_progress,
    size_of,
    write_stage,
)
from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model.cam import Cam
from centrode.model.examples.catalogue import DescriptionSource, description_of
from centrode.model.follower_cam import PlateCam
from centrode.model.labels import place_words
from centrode.model.mechanism import FRAME
from centrode.model.reading import nearest
from centrode.scenes.places import LinkageScene
from centrode.scenes.sphere import Globe

if TYPE_CHECKING:
    import xarray

    from centrode.analysis.instant_centres.results import CentrodeResults
    from centrode.dynamics.equilibria.modes import ModesResults
    from centrode.dynamics.motion_results import MotionResults
    from centrode.model.mechanism import Mechanism

# What an animation of a mechanism shows beside its links: names that are asked for, and the layers they stand
# for.


@dataclass(frozen=True)
class Shown:
    """What is shown of a mechanism's motion.

    Attributes
    ----------
    what : sequence of str
        Any of "paths", "velocities", "accelerations", "centres", "centrodes", "forces" and "loads".
    points : sequence of str, optional
        Points whose paths, velocities and accelerations are shown; all that move if left out.
    growing : bool
        Paths grow behind their points.
    pairs : sequence of (body, body), optional
        Whose instant centres are shown; all of up to four bodies, of more those against the frame, if left out.
    link, against : str
        Whose centrodes roll; the first link without a fixed point, on the frame, if left out.
    """

    what: Sequence[str] = ("paths",)
    points: Sequence[str] | None = None
    growing: bool = False
    pairs: Sequence[tuple[str, str]] | None = None
    link: str | None = None
    against: str = FRAME


Maker: TypeAlias = Callable[["Film", LinkageScene | Globe, Shown], Layer]

MAKERS: Mapping[str, Maker] = {
    "paths": lambda film, scene, shown: PathsLayer(
        film, scene, points_of(film.mechanism, shown), shown.growing
    ),
    "centrodes": lambda film, scene, shown: CentrodesLayer(
        film, scene, shown.link or coupler(film.mechanism, shown.against), shown.against
    ),
    "velocities": lambda film, scene, shown: point_vectors(
        film, scene, "velocity", points_of(film.mechanism, shown)
    ),
    "accelerations": lambda film, scene, shown: point_vectors(
        film, scene, "acceleration", points_of(film.mechanism, shown)
    ),
    "forces": lambda film, scene, _shown: joint_layer(film, scene),
    "loads": lambda film, scene, _shown: load_layer(film, scene),
    "centres": lambda film, scene, shown: CentresLayer(film, scene, shown.pairs),
}  # fmt: skip
"""Layers by the names that they are asked for by, from below upwards."""


def check_shown(mechanism: Mechanism, shown: Shown) -> None:
    """Raise InputError for a name that means nothing, before anything is computed."""
    for name in shown.what:
        if name not in MAKERS:
            what = _("{name} cannot be shown").format(name=f'"{name}"')
            raise InputError("show", what, _("show any of {known}").format(known=", ".join(sorted(MAKERS))))
    for name in shown.points or ():
        if name not in mechanism.moving_points:
            what = _("there is no moving point {name}").format(name=f'"{name}"')
            raise InputError("points", what, nearest(name, mechanism.moving_points))
    needs = {
        "points": (shown.points is not None, ("paths", "velocities", "accelerations")),
        "growing": (shown.growing, ("paths",)),
        "pairs": (shown.pairs is not None, ("centres",)),
        "link": (shown.link is not None, ("centrodes",)),
        "against": (shown.against != FRAME, ("centrodes",)),
    }
    for name, (given, kinds) in needs.items():
        if given and not set(kinds) & set(shown.what):
            what = _("it controls how {kinds} are shown, which are not shown").format(kinds=", ".join(kinds))
            raise InputError(name, what, _("show them, or remove it"))


def layers_of(film: Film, scene: LinkageScene | Globe, shown: Shown) -> list[Layer]:
    """The links, and what is shown beside them."""
    check_shown(film.mechanism, shown)
    made = [make(film, scene, shown) for name, make in MAKERS.items() if name in shown.what]
    share_scale(made)
    return [LinksLayer(film, scene), *made]


def points_of(mechanism: Mechanism, shown: Shown) -> list[str]:
    """The points that are shown, in the description's order."""
    return [name for name in mechanism.moving_points if shown.points is None or name in shown.points]


def coupler(mechanism: Mechanism, against: str) -> str:
    """The first link that has no point of the frame, nor of the body it is seen against; else the first other link."""
    body = mechanism.links.get(against)
    fixed = {*mechanism.frame.points, *(body.coordinates if body is not None else ())}
    others = [name for name in mechanism.link_names if name != against]
    free = [name for name in others if not fixed & set(mechanism.links[name].coordinates)]
    if not others:
        raise InputError("link", _("there is no link that could roll"), _("remove centrodes"))
    return (free or others)[0]


# what computes cams is not loaded for a linkage
_of_cams = functools.partial(importlib.import_module, "centrode.animation.cams")


def animate(
    described: DescriptionSource,
    path: str | Path,
    shown: Shown | None = None,
    pace: Pace | None = None,
    *,
    start: float | str | None = None,
    stop: float | str | None = None,
    simulation: bool = False,
    size: Sequence[int] | str = SIZE,
    dark: bool = False,
    said: Said = no_progress,
) -> Animation:
    """Write an animation, GIF or MP4 by the ending of its name, that runs on without a jump.

    A drive that turns fully runs round; where the mechanism is limited, or a range is requested that does not close,
    the motion runs there and back. View and scales of vectors stay the same over the whole animation.

    Parameters
    ----------
    described : Mechanism, Cam or PlateCam
        Of a cam with a mover the walking wheel is shown, of another the cam that turns below its roller or follower.
    path : str or Path
        The file; it appears whole or not at all, and replaces one that is there.
    shown : Shown
        What is shown beside the links; the paths of the points by default. A cam takes none.
    pace : Pace
        Frames, frames a second, duration or speed.
    start, stop : float [rad or m, or s], or texts with a unit
        Values of the drive, as for `motion`.
    simulation : bool
        The motion of the description's simulation, from its start to its end, in place of that of the drives. It shows
        paths, velocities and accelerations; one of 1 to 20 s runs at its own pace, another takes 6 s.
    size : (width, height) or "800x600"
        In pixels; MP4 takes even ones, odd ones are made greater by one.
    dark : bool
        Light lines on a dark ground.
    said : callable
        Told after each frame how many are drawn, and of how many.

    Raises
    ------
    InputError
        Names, numbers or sizes out of bounds; nothing that moves; MP4 without imageio-ffmpeg.

    Examples
    --------
    >>> import centrode as ct
    >>> animation = ct.animate(ct.example("crank-rocker"), "motion.gif", stop=0.2, size=(160, 120))
    >>> animation.loop
    'back'
    """
    described = description_of(described)
    path, pace = Path(path), pace or Pace()
    kind = kind_of(path)
    if kind == ".mp4":
        need_video()
    if isinstance(described, Cam | PlateCam):
        if shown is not None or start is not None or stop is not None or simulation:
            raise InputError("show", _("a cam is shown as a whole"), _("remove it"))
        found: Animation = _of_cams().animate_cam(described, path, pace, size, dark, said)
        return found
    shown = shown or Shown()
    check_shown(described, shown)
    check_timing(kind, pace.frames, pace.fps, pace.duration, pace.speed)
    if simulation:
        _check_of_simulation(shown, start, stop)
        course = course_of_simulation(described)
        pace = _own_pace(pace, course.seconds)
    else:
        course = course_of(described, None, start, stop)
    timing = pace.timing(kind, course.seconds)
    pixels = size_of(size, kind, timing.frames)
    film = (film_of_simulation if simulation else film_of)(course, timing.frames)
    stage, notes = stage_of(film, shown, pixels, dark=dark)
    write_stage(stage, path, timing, said)
    notes = [*_about(course), *notes]
    return Animation(
        path, timing.frames, timing.per_second, pixels, course.loop, tuple(notes), course.left_out
    )


OF_SIMULATION = ("paths", "velocities", "accelerations")
OWN_PACE, STRETCHED = (1.0, 20.0), 6.0
"""Simulations that take so long [s] run at their own pace; others are stretched to so long."""


def _check_of_simulation(shown: Shown, start: object, stop: object) -> None:
    """Refuse what belongs to a motion that drives prescribe."""
    if start is not None or stop is not None:
        what = _("a simulation goes from its start to its end")
        raise InputError("from", what, _("remove it; the duration is that of [simulation]"))
    for name in shown.what:
        if name not in OF_SIMULATION:
            what = _("{name} cannot be shown of a simulation").format(name=f'"{name}"')
            raise InputError("show", what, _("show any of {known}").format(known=", ".join(OF_SIMULATION)))


def _own_pace(pace: Pace, seconds: float) -> Pace:
    """A pace, where none is given that of the motion itself."""
    if pace.duration is not None or pace.speed is not None or (pace.frames and pace.fps):
        return pace
    return replace(pace, duration=seconds if OWN_PACE[0] <= seconds <= OWN_PACE[1] else STRETCHED)


def stage_of(
    film: Film, shown: Shown, size: tuple[int, int] = SIZE, *, dark: bool = False, more: Sequence[Layer] = ()
) -> tuple[Stage, list[str]]:
    """The stage of a film, and what has to be said of it; `more` layers are drawn over the others."""
    layers = [*layers_of(film, scene_of_film(film), shown), *more]
    captions = instant_captions(film)
    stage = Stage(
        layers, len(film.order), size, _(film.mechanism.title), lambda frame: captions[frame], dark=dark
    )
    notes = [note for layer in layers for note in layer.notes()]
    for word, count in statuses_of(film).items():
        text = ngettext("{n} position is {status}", "{n} positions are {status}", count)
        notes.append(text.format(n=count, status=word))
    return stage, notes


def _about(course: Course) -> list[str]:
    """How it runs, and which samples are not shown."""
    found = []
    if course.left_out:
        first, last = (place_words(course.mechanism, course.motion, sample) for sample in (0, -1))
        text = _("it moves from {first} to {last}; {n} of {all} samples are not reached and not shown")
        found.append(text.format(first=first, last=last, n=course.left_out, all=course.asked))
    if course.turns > 1:
        found.append(
            ngettext(
                "{n} turn of the drive in a loop", "{n} turns of the drive in a loop", course.turns
            ).format(n=course.turns)
        )
    return found


# Animations of results that are there already: a motion, centrodes.

FRAMES = 48
PER_SECOND = 100.0 / 7.0


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
        Of the motion one way; 48 if left out.
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


def animate_results(results: MotionResults, path: Path, dark: bool = False) -> None:
    """Write an animation (GIF or MP4) of the motion of a result; raises InputError where nothing is in place."""
    animate_motion(results.mechanism, results.motion, path, dark=dark)


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
    if int((centrodes["centrode_piece"].values >= 0).sum()) < 2:
        raise InputError(
            "link", _("there is no centrode in this range"), _("choose another link or another range")
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


def animate_modes(results: ModesResults, path: Path, dark: bool = False) -> None:
    """Write an animation of the first mode to a file, and of each other one beside it: mode-1.gif, mode-2.gif, ..."""
    for number, motion in enumerate(results.motions):
        beside = path.with_name(path.name.replace("1", str(number + 1)))
        animate_period(results.mechanism, motion, beside if number else path, dark)


def animate_period(mechanism: Mechanism, motion: xarray.Dataset, path: Path, dark: bool = False) -> None:
    """Write an animation of a motion that ends where it begins."""
    times = motion["time"].values
    course = Course(mechanism, motion, times, "once", asked=len(times))
    # the last position is the first of the next round
    chosen = np.unique(np.linspace(0, len(times) - 1, FRAMES + 1).round().astype(int))[:-1]
    film = Film(course, motion.isel(sample=chosen), np.arange(len(chosen)), times[chosen])
    stage, _notes = stage_of(film, Shown(), SIZE, dark=dark)
    write_stage(stage, Path(path), Timing(stage.frames, PER_SECOND), no_progress)
