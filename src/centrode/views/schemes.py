"""The kinematic scheme of a mechanism: in which position it is drawn, and what the picture is called."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.analysis.representative_position import representative_sample
from centrode.sheets.linkages import SchemePicture
from centrode.sheets.texts import Sentence, Unit
from centrode.views.instants import instant_title

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism


def scheme_picture(mechanism: Mechanism, motion: xarray.Dataset) -> SchemePicture:
    """The scheme at the sample of a motion that is farthest from dead and limit positions."""
    sample = representative_sample(mechanism, motion)
    place = instant_title(mechanism, motion, sample)
    if mechanism.space == "sphere":
        title = Sentence("Kinematic scheme at {place}; the dimensions of the links are arcs", place=place)
    else:
        title = Sentence(
            "Kinematic scheme at {place}; dimensions in {unit}", place=place, unit=Unit("m", shown=True)
        )
    return SchemePicture(title, mechanism, motion, sample)
