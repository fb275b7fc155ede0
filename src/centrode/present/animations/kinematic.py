"""Velocities and accelerations of points as layers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.present.animations.vectors import VectorLayer, Vectors
from centrode.present.scene import Scene
from centrode.present.shown import shown_as
from centrode.present.sphere.globe import Globe
from centrode.quantities import typeset_unit

if TYPE_CHECKING:
    from centrode.study.moving.films import Film

VELOCITY, ACCELERATION = "#00795A", "#A3287F"
COLOURS = {"velocity": VELOCITY, "acceleration": ACCELERATION}


def point_vectors(film: Film, scene: Scene | Globe, variable: str, points: Sequence[str]) -> VectorLayer:
    """The layer of a vector that the motion has for each point: "velocity" or "acceleration"."""
    found = film.motion[variable]
    factor, unit = shown_as(str(found.attrs.get("units", "")), film.mechanism.display)
    values = factor * found.sel(point=list(points)).transpose("sample", "point", "axis").to_numpy()
    places = np.stack([scene.tracks[name][: len(film.places)] for name in points], axis=1)
    title = {"velocity": _("velocity"), "acceleration": _("acceleration")}[variable]
    colour = COLOURS[variable]
    shown = Vectors(title, typeset_unit(unit), places, values, [colour] * len(points), colour)
    return VectorLayer(film, scene, shown, 7.0 if variable == "velocity" else 6.8)
