"""What an animation is made of: layers, each of which draws one thing, and the view that all of them share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from centrode.errors import Status
from centrode.locale import decimal_mark
from centrode.model.settings import shown_as
from centrode.quantities import QUANTITIES, spelled_unit, status_word, with_unit
from centrode.scenes.linkage import scene_of
from centrode.scenes.places import LinkageScene, View
from centrode.scenes.sphere import Globe, globe_of

if TYPE_CHECKING:
    from centrode.animation.frames import Film
    from centrode.model.settings import Display

Array = NDArray[np.float64]
NOTHING: Array = np.empty((0, 2))
WHOLE: Array = np.array([[-1.0, -1.0], [1.0, 1.0]])
"""Corners of the whole sphere."""


@dataclass(frozen=True)
class ScaleArrow:
    """An arrow below the pictures that tells what the vectors of a layer are worth.

    Attributes
    ----------
    length : float
        In drawing units.
    text : str
        What is shown, and what an arrow of this length is worth.
    colour : Any
    """

    length: float
    text: str
    colour: Any


class Layer:
    """One thing that an animation shows; a layer overrides what it needs.

    The stage asks every layer for its `reach`, tells all of them the view, has their `ground` drawn once, and then
    `draw` for each frame: whatever that puts on the axes is taken away again before the next frame.
    """

    def reach(self) -> Array:
        """Places (n, 2) that the view has to hold, over all frames."""
        return NOTHING

    def stand(self, view: View) -> None:
        """Take the view that was chosen, before anything is drawn."""

    def ground(self, axes: Axes) -> None:
        """Draw what does not move, below everything that does."""

    def draw(self, axes: Axes, frame: int) -> None:
        """Draw what moves, as it is in a frame."""

    def entries(self) -> Sequence[tuple[Artist, str]]:
        """Entries of the legend."""
        return ()

    def scales(self) -> Sequence[ScaleArrow]:
        """What the lengths of its vectors are worth."""
        return ()

    def notes(self) -> Sequence[str]:
        """Sentences about what could not be shown."""
        return ()


# What all layers of a mechanism's motion know: the film, and its scene in the view of the pictures.

FAR = 0.5
"""How far out of the mechanism's box other places are shown, as a part of its extent: small links show nothing."""


class MotionLayer(Layer):
    """A layer over a film of a mechanism.

    Attributes
    ----------
    film : Film
    scene : LinkageScene or Globe
        The frames' positions are its first samples, those of the course follow.
    count : int
        Positions of the frames.
    box : (2, 2)
        Corners of what the links need over the whole motion.
    """

    def __init__(self, film: Film, scene: LinkageScene | Globe) -> None:
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


def scene_of_film(film: Film) -> LinkageScene | Globe:
    """The scene that all layers of a film share."""
    if film.mechanism.space == "sphere":
        return globe_of(film.mechanism, film.together)
    return scene_of(film.mechanism, film.together)


def statuses_of(film: Film) -> dict[str, int]:
    """How many positions of the frames have which status, of those that are not in order; by its word."""
    codes, counts = np.unique(film.motion["status"].values, return_counts=True)
    return {status_word(int(code)): int(count) for code, count in zip(codes, counts, strict=True) if code}


# What stands below the title of a frame: the values of the drives or the time, the cam's angle.

DIGITS = 4


def instant_captions(film: Film) -> list[str]:
    """The caption of each frame: the value of the only drive that moves evenly, else the time, and the status.

    The status stands there where it is not in order. All have as many decimals, so that no digit jumps.
    """
    mechanism = film.mechanism
    parameter = film.course.parameter
    factor, unit = shown_as(parameter.instant.unit, mechanism.display)
    symbol, values = parameter.instant.symbol, factor * parameter.instants(film.motion)
    decimals = decimals_for(values, unit)
    label = spelled_unit(unit)
    # plain text: mathematical text is laid out for every frame anew, at many times the cost
    texts = [f"{symbol} = {with_unit(plain_number(value, decimals), label)}" for value in values]
    for k, status in enumerate(film.motion["status"].values.tolist()):
        if status != Status.OK:
            texts[k] += f" ({status_word(status)})"
    return [texts[sample] for sample in film.order]


def turned_caption(angle: float, display: Display | None) -> str:
    """The angle that the carrier of a cam's rollers has turned by."""
    factor, unit = shown_as("rad", display)
    turned = plain_number(factor * angle, 1 if unit == "deg" else 3)
    return f"{QUANTITIES['carrier_angle'].symbol} = {with_unit(turned, spelled_unit(unit))}"


def decimals_for(values: Array, unit: str) -> int:
    """Decimals that all values are written with, so that no digit jumps."""
    greatest = float(np.nanmax(np.abs(values), initial=0.0))
    decimals = max(0, DIGITS - 1 - int(np.floor(np.log10(greatest)))) if greatest > 0.0 else 0
    return min(decimals, 1) if unit == "deg" else min(decimals, 9)


def plain_number(value: float, decimals: int) -> str:
    """A number with so many decimals, in the digits of the language; zero has no sign."""
    text = f"{value:.{decimals}f}"
    if float(text) == 0.0:
        text = text.lstrip("-")
    return text.replace("-", "−").replace(".", decimal_mark())
