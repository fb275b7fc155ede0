"""Layers of forces: of the pins and guides on the links, and of the loads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.present.animations.vectors import VectorLayer, Vectors
from centrode.present.scene import Scene
from centrode.present.sphere.globe import Globe
from centrode.present.style import INK, pens
from centrode.study.moving.forces import joint_forces, load_forces

if TYPE_CHECKING:
    from centrode.study.moving.films import Film

LOAD = "#7A4B00"


def joint_layer(film: Film, scene: Scene | Globe) -> VectorLayer:
    """Forces of the pins on the links, each in the colour of its link, and of guides on what slides in them."""
    found = joint_forces(film.mechanism, film.places)
    colours = {name: pen.colour for name, pen in pens(film.mechanism.link_names).items()}
    values = found["joint_force"].transpose("sample", "side", "axis").to_numpy()
    points = found["side_point"].to_numpy().tolist()
    drawn = [colours.get(str(name), INK) for name in found["side_link"].to_numpy()]
    if "guide_force" in found:
        guides = {guide.id: guide.point for guide in film.mechanism.guides}
        names = found["guide"].to_numpy().tolist()
        values = np.concatenate(
            [values, found["guide_force"].transpose("sample", "guide", "axis").to_numpy()], axis=1
        )
        points += [guides[name] for name in names]
        drawn += [INK] * len(names)
    places = np.stack([scene.tracks[name][: len(film.places)] for name in points], axis=1)
    return VectorLayer(film, scene, Vectors(_("forces on the links"), "N", places, values, drawn, INK), 7.4)


def load_layer(film: Film, scene: Scene | Globe) -> VectorLayer:
    """Forces of loads and weights where they act."""
    forces = load_forces(film.mechanism, film.places)
    factor = scene.factor if isinstance(scene, Scene) else 1.0
    shape = (len(film.places), 0, 3 if isinstance(scene, Globe) else 2)
    places = np.stack([factor * one.place for one in forces], axis=1) if forces else np.empty(shape)
    values = np.stack([one.force for one in forces], axis=1) if forces else np.empty(shape)
    return VectorLayer(film, scene, Vectors(_("loads"), "N", places, values, [LOAD] * len(forces), LOAD), 7.6)
