"""From a motion to the scene that drawings read."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from centrode.model.settings import shown_as
from centrode.present.cams.driving_cam import driving_cams
from centrode.present.scene import LinkageScene, box, span
from centrode.present.wheels import pitch_circles, reaches

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism


def scene_of(mechanism: Mechanism, dataset: xarray.Dataset) -> LinkageScene:
    """Read a motion for drawing.

    Parameters
    ----------
    mechanism : Mechanism
        The description, with every "placed" resolved.
    dataset : Dataset
        Its motion, without batch dimensions.
    """
    factor = shown_as("m", mechanism.display)[0]
    samples = dataset.sizes["sample"]
    tracks = {
        name: np.tile(factor * np.asarray(place, dtype=float), (samples, 1))
        for name, place in mechanism.frame.coordinates.items()
    }
    for name in dataset["point"].to_numpy().tolist():
        if name not in tracks:
            tracks[name] = factor * dataset["position"].sel(point=name).to_numpy()
    turns = {name: dataset["angle"].sel(link=name).to_numpy() for name in dataset["link"].to_numpy().tolist()}
    travels = {
        guide.id: factor * span(dataset["slide"].sel(guide=guide.id).to_numpy()) for guide in mechanism.guides
    }
    low, high = box(list(tracks.values()))
    scene = LinkageScene(
        mechanism=mechanism,
        tracks=tracks,
        turns=turns,
        travels=travels,
        low=low,
        high=high,
        factor=factor,
        cams=driving_cams(mechanism, dataset, factor),
    )
    lines = [scene.guide_line(guide, slice(None)) for guide in mechanism.guides if guide.on != "frame"]
    ends = [end for line in lines if line is not None for end in line]
    rims = [disc.outline for sample in range(samples) for _link, disc in pitch_circles(scene, sample)]
    cams = [cam.reach() for cam in scene.cams]
    low, high = box([*tracks.values(), *ends, *reaches(scene), *rims, *cams])
    return replace(scene, low=low, high=high)
