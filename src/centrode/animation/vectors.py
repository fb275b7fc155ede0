"""Layers of vectors at points: velocities, accelerations, forces; one scale over the whole animation, told below it."""

from __future__ import annotations

import functools
import importlib
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from centrode.animation.layers import NOTHING, Array, Layer, MotionLayer, ScaleArrow
from centrode.animation.stage import ARROW_HEAD, arrow_outlines
from centrode.locale import _, decimal_mark, ngettext
from centrode.model.settings import shown_as
from centrode.quantities import spelled_unit
from centrode.render.drawing.style import INK, pens
from centrode.scenes.places import LinkageScene
from centrode.scenes.sphere import Globe

if TYPE_CHECKING:
    from centrode.animation.frames import Film

# what computes forces is not loaded where none are shown
_forces = functools.partial(importlib.import_module, "centrode.animation.forces")

LONGEST = 0.22
"""Length of the longest vector, as a part of the mechanism's extent."""
WILD = 6.0
"""Vectors that run to infinity are drawn up to this many times the upper decile."""
KEY = 0.8
"""The arrow of the scale is at most this part of the longest vector."""


@dataclass(frozen=True)
class Vectors:
    """Vectors at the samples of a film's frames.

    Attributes
    ----------
    title, unit : str
        What is shown, and the unit of the values.
    places : (sample, vector, axis)
        Where they begin, as the scene has it.
    values : (sample, vector, axis)
        In `unit`; NaN where there is none.
    colours : sequence
        One for each vector.
    colour : Any
        Of the arrow of the scale.
    """

    title: str
    unit: str
    places: Array
    values: Array
    colours: Sequence[Any]
    colour: Any


class VectorLayer(MotionLayer):
    """Vectors whose lengths are everywhere the same number of drawing units to a unit of their values."""

    def __init__(self, film: Film, scene: LinkageScene | Globe, vectors: Vectors, level: float = 7.0) -> None:
        super().__init__(film, scene)
        self.vectors = vectors
        self.level = level
        sizes = np.linalg.norm(vectors.values, axis=2)
        self.greatest = _greatest(sizes[np.isfinite(sizes)])
        with np.errstate(invalid="ignore"):
            self.shown = np.isfinite(sizes) & (sizes <= self.greatest * (1.0 + 1e-12)) & (sizes > 0.0)
            self.left_out = int((sizes > self.greatest * (1.0 + 1e-12)).any(axis=1).sum())
        extent = float(np.max(np.ptp(self.box, axis=0)))
        self.scale = LONGEST * extent / self.greatest if self.greatest > 0.0 else 0.0

    def arrows(self, sample: int) -> tuple[Array, Array]:
        """Starts (n, 2) and components (n, 2) on paper of the vectors drawn at a sample, in drawing units."""
        shown = self.shown[sample]
        starts = self.on_paper(self.vectors.places[sample][shown])
        return starts, self.scale * self.on_paper(self.vectors.values[sample][shown])

    def reach(self) -> Array:
        """All tips."""
        found = [start + along for start, along in map(self.arrows, range(self.count))]
        return np.concatenate([NOTHING, *found])

    def draw(self, axes: Axes, frame: int) -> None:
        """All vectors of a frame at once."""
        sample = self.sample(frame)
        starts, along = self.arrows(sample)
        if not len(starts):
            return
        colours = [self.vectors.colours[k] for k in np.flatnonzero(self.shown[sample]).tolist()]
        head = ARROW_HEAD * self.scene.extent / self.scene.inches
        outlines = list(arrow_outlines(starts, along, head))
        axes.add_collection(
            PolyCollection(
                outlines, facecolors=colours, edgecolors="white", linewidths=0.5, zorder=self.level
            ),
            autolim=False,
        )

    def scales(self) -> Sequence[ScaleArrow]:
        """A round value not longer than the longest vector."""
        if not self.greatest > 0.0:
            return ()
        value = round_down(KEY * self.greatest)
        number = f"{value:g}".replace(".", decimal_mark())
        text = f"{self.vectors.title}: {number} {self.vectors.unit}"
        return [ScaleArrow(self.scale * value, text, self.vectors.colour)]

    def notes(self) -> Sequence[str]:
        """What is not there, and what is too long to be drawn."""
        found = []
        if not self.greatest > 0.0:
            found.append(_("{what}: none").format(what=self.vectors.title))
        if self.left_out:
            text = ngettext(
                "{what}: too long to draw in {n} position", "{what}: too long to draw in {n} positions",
                self.left_out,
            )  # fmt: skip
            found.append(text.format(what=self.vectors.title, n=self.left_out))
        return found


def share_scale(layers: Iterable[Layer]) -> None:
    """Give vectors of one unit the same scale, the least of theirs: forces and loads can be compared."""
    vectors = [one for one in layers if isinstance(one, VectorLayer) and one.scale > 0.0]
    for layer in vectors:
        layer.scale = min(one.scale for one in vectors if one.vectors.unit == layer.vectors.unit)


def _greatest(sizes: Array) -> float:
    """The length that the scale is chosen for: the greatest, unless that is far from all others."""
    if not sizes.size:
        return 0.0
    usual = WILD * float(np.quantile(sizes, 0.9))
    greatest = float(sizes.max())
    return min(greatest, usual) if usual > 0.0 else greatest


def round_down(value: float) -> float:
    """The greatest of 1, 2 and 5 times powers of ten that is not above a value."""
    power = 10.0 ** math.floor(math.log10(value))
    return float(
        f"{max(step for step in (1.0, 2.0, 5.0) if step * power <= value * (1.0 + 1e-12)) * power:.3g}"
    )


# Velocities and accelerations of points as layers.

VELOCITY, ACCELERATION = "#00795A", "#A3287F"
COLOURS = {"velocity": VELOCITY, "acceleration": ACCELERATION}


def point_vectors(
    film: Film, scene: LinkageScene | Globe, variable: str, points: Sequence[str]
) -> VectorLayer:
    """The layer of a vector that the motion has for each point: "velocity" or "acceleration"."""
    found = film.motion[variable]
    factor, unit = shown_as(str(found.attrs.get("units", "")), film.mechanism.display)
    values = factor * found.sel(point=list(points)).transpose("sample", "point", "axis").values
    places = np.stack([scene.tracks[name][: len(film.places)] for name in points], axis=1)
    title = {"velocity": _("velocity"), "acceleration": _("acceleration")}[variable]
    colour = COLOURS[variable]
    shown = Vectors(title, spelled_unit(unit), places, values, [colour] * len(points), colour)
    return VectorLayer(film, scene, shown, 7.0 if variable == "velocity" else 6.8)


# Layers of forces: of the pins and guides on the links, and of the loads.

LOAD = "#7A4B00"


def joint_layer(film: Film, scene: LinkageScene | Globe) -> VectorLayer:
    """Forces of the pins on the links, each in the colour of its link, and of guides on what slides in them."""
    found = _forces().joint_forces(film.mechanism, film.places)
    colours = {name: pen.colour for name, pen in pens(film.mechanism.link_names).items()}
    values = found["joint_force"].transpose("sample", "side", "axis").values
    points = found["side_point"].values.tolist()
    drawn = [colours.get(str(name), INK) for name in found["side_link"].values]
    if "guide_force" in found:
        guides = {guide.id: guide.point for guide in film.mechanism.guides}
        names = found["guide"].values.tolist()
        values = np.concatenate(
            [values, found["guide_force"].transpose("sample", "guide", "axis").values], axis=1
        )
        points += [guides[name] for name in names]
        drawn += [INK] * len(names)
    places = np.stack([scene.tracks[name][: len(film.places)] for name in points], axis=1)
    return VectorLayer(film, scene, Vectors(_("forces on the links"), "N", places, values, drawn, INK), 7.4)


def load_layer(film: Film, scene: LinkageScene | Globe) -> VectorLayer:
    """Forces of loads and weights where they act."""
    forces = _forces().load_forces(film.mechanism, film.places)
    factor = scene.factor if isinstance(scene, LinkageScene) else 1.0
    shape = (len(film.places), 0, 3 if isinstance(scene, Globe) else 2)
    places = np.stack([factor * one.place for one in forces], axis=1) if forces else np.empty(shape)
    values = np.stack([one.force for one in forces], axis=1) if forces else np.empty(shape)
    return VectorLayer(film, scene, Vectors(_("loads"), "N", places, values, [LOAD] * len(forces), LOAD), 7.6)
