"""What an animation of a mechanism shows beside its links: names that are asked for, and the layers they stand for."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import FRAME
from centrode.model.reading import nearest
from centrode.present.animations.centres import CentresLayer
from centrode.present.animations.centrodes import CentrodesLayer
from centrode.present.animations.forces import joint_layer, load_layer
from centrode.present.animations.kinematic import point_vectors
from centrode.present.animations.layers import Layer
from centrode.present.animations.links import LinksLayer
from centrode.present.animations.paths import PathsLayer
from centrode.present.animations.vectors import share_scale
from centrode.present.scene import Scene
from centrode.present.sphere.globe import Globe

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism
    from centrode.study.moving.films import Film


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


Maker: TypeAlias = Callable[["Film", Scene | Globe, Shown], Layer]

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
            what = _("it says how to show {kinds}, which are not shown").format(kinds=", ".join(kinds))
            raise InputError(name, what, _("show them, or take it out"))


def layers_of(film: Film, scene: Scene | Globe, shown: Shown) -> list[Layer]:
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
        raise InputError("link", _("there is no link that could roll"), _("take centrodes out"))
    return (free or others)[0]
