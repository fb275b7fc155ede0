"""What all layers of a mechanism's motion know: the film, and its scene in the view of the pictures."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from centrode.present.animations.layers import Array, Layer, View
from centrode.present.reading import scene_of
from centrode.present.scene import Scene
from centrode.present.sphere.globe import Globe, globe_of
from centrode.quantities import status_word

if TYPE_CHECKING:
    from centrode.study.moving.films import Film

FAR = 0.5
"""How far out of the mechanism's box other places are shown, as a part of its extent: small links show nothing."""


class MotionLayer(Layer):
    """A layer over a film of a mechanism.

    Attributes
    ----------
    film : Film
    scene : Scene or Globe
        The frames' positions are its first samples, those of the course follow.
    count : int
        Positions of the frames.
    box : (2, 2)
        Corners of what the links need over the whole motion.
    """

    def __init__(self, film: Film, scene: Scene | Globe) -> None:
        self.film = film
        self.scene = scene
        self.count = len(film.places)
        self.box = np.array([scene.low, scene.high])

    def stand(self, view: View) -> None:
        """Signs are as large as on any drawing."""
        self.scene = replace(self.scene, low=view.low, high=view.high, inches=view.inches)

    def sample(self, frame: int) -> int:
        """The sample of a frame."""
        return int(self.film.order[frame])

    def on_paper(self, places: Array) -> Array:
        """Places in drawing units (..., 2), of those in the scene's."""
        return self.scene.flat(places) if isinstance(self.scene, Globe) else places


def scene_of_film(film: Film) -> Scene | Globe:
    """The scene that all layers of a film share."""
    if film.mechanism.space == "sphere":
        return globe_of(film.mechanism, film.together)
    return scene_of(film.mechanism, film.together)


def statuses_of(film: Film) -> dict[str, int]:
    """How many positions of the frames have which status, of those that are not in order; by its word."""
    codes, counts = np.unique(film.motion["status"].to_numpy(), return_counts=True)
    return {status_word(int(code)): int(count) for code, count in zip(codes, counts, strict=True) if code}
