"""From a motion to the block that a page plays: the part of it that the mechanism reaches, in the signs of diagrams."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.errors import InputError, Status
from centrode.locale import _
from centrode.present.drawing import MARGIN, draw_mechanism
from centrode.present.linkage_scene import scene_of
from centrode.present.pictures import complete, initial_sample
from centrode.present.scene import Scene, corners
from centrode.present.sphere.globe import Globe, draw_globe, globe_of
from centrode.present.style import house_style
from centrode.render.document.blocks import Moving, shown
from centrode.render.document.figures import picture
from centrode.render.document.numbers import NARROW, Numbers
from centrode.report.moving_shapes import rings_of, shapes_of

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
MOST = 720
"""Samples of a motion that are played; of more, evenly chosen ones."""
INCHES = 5.2
DIGITS = 4
"""Of the drive's greatest value."""


def moving_of(mechanism: Mechanism, motion: xarray.Dataset) -> Moving:
    """A motion to be played, in the plane or on the sphere.

    Parameters
    ----------
    mechanism : Mechanism
    motion : Dataset
        Of `motion`; the samples that hang together with the initial position are played.

    Raises
    ------
    InputError
        No sample has every point in place.
    """
    scene = globe_of(mechanism, motion) if mechanism.space == "sphere" else scene_of(mechanism, motion)
    chosen = played(scene, motion)
    on_sphere = isinstance(scene, Globe)
    factor = 1.0 if isinstance(scene, Globe) else scene.factor
    fixed = tuple(mechanism.frame.points)
    places = {
        name: track[chosen[:1] if name in fixed else chosen] / factor for name, track in scene.tracks.items()
    }
    frame_guides = [] if on_sphere else [guide for guide in mechanism.guides if guide.on == "frame"]
    lines = {} if isinstance(scene, Globe) else {one.id: scene.guide_line(one, 0) for one in frame_guides}
    return Moving(
        places=places,
        bodies=_bodies(mechanism),
        fixed=fixed,
        guides={name: np.array(line) / factor for name, line in lines.items() if line is not None},
        sliders={guide.point: guide.id for guide in frame_guides},
        drive=mechanism.motion_parameter.values(motion)[chosen],
        drive_texts=tuple(drive_texts(mechanism, motion, chosen)),
        tracks=tuple(name for name in mechanism.moving_points if name in places),
        still=picture(_still(scene, motion), ""),
        caption=_("Motion of {title}").format(title=shown(_(mechanism.title) or _("the mechanism"))),
        shapes=rings_of(scene, chosen) if isinstance(scene, Globe) else shapes_of(scene, chosen),
        view=scene.view if isinstance(scene, Globe) else None,
        driven=tuple(_driven(mechanism)),
        dots=tuple(_dots(mechanism)),
        start=int(np.argmin(np.abs(chosen - initial_sample(scene, motion)))),
        box=np.array([scene.low, scene.high]) / factor,
    )


def played(scene: Scene | Globe, motion: xarray.Dataset) -> NDArray[np.intp]:
    """The samples about the initial position where the mechanism is in one piece and gets to."""
    status = motion["status"].to_numpy()
    good = complete(scene) & ((status == Status.OK) | (status == Status.SINGULAR))
    if not good.any():
        raise InputError("", _("no sample has every point in place"), _("ask for another range"))
    start = initial_sample(scene, motion)
    if not good[start]:
        start = int(np.flatnonzero(good)[0])
    bad = np.flatnonzero(~good)
    low = int(bad[bad < start].max(initial=-1)) + 1
    high = int(bad[bad > start].min(initial=good.size))
    count = min(MOST + 1, high - low)
    return np.unique(np.linspace(low, high - 1, count).round().astype(np.intp))


def drive_texts(mechanism: Mechanism, motion: xarray.Dataset, samples: NDArray[np.intp]) -> list[str]:
    """The value of the only drive at each sample, else the time, with symbol and unit."""
    parameter = mechanism.motion_parameter
    values, unit, name = parameter.values(motion)[samples], parameter.variable.unit, parameter.variable.symbol
    if not parameter.by_time:
        name = f"{name} ({mechanism.drives[0].id})"
    numbers = Numbers(mechanism.display, DIGITS)
    label = numbers.shown(unit)[1]
    room = "" if label.startswith("°") else NARROW
    texts = numbers.column(values.tolist(), unit, least=1e-9 * float(np.abs(values).max()))
    return [f"{name} = {text}{room}{label}" for text in texts]


def _bodies(mechanism: Mechanism) -> dict[str, tuple[str, ...]]:
    """The points that each link is drawn through, and the rods of cylinders."""
    links = {name: tuple(corners(link)) for name, link in mechanism.links.items()}
    rods = {one.id: one.distance for one in mechanism.drives if one.distance is not None}
    return {**links, **{name: ends for name, ends in rods.items() if name not in links}}


def _driven(mechanism: Mechanism) -> list[str]:
    """Points that the drives move themselves."""
    found: list[str] = []
    for drive in mechanism.drives:
        if drive.link is not None:
            found += mechanism.links[drive.link].coordinates
        elif drive.distance is not None:
            found += drive.distance
        else:
            found += [guide.point for guide in mechanism.guides if guide.id == drive.guide]
    return [name for name in dict.fromkeys(found) if name in mechanism.moving_points]


def _dots(mechanism: Mechanism) -> list[str]:
    """Points where nothing is hinged."""
    found = []
    for name in (*mechanism.frame.points, *mechanism.moving_points):
        owners = sum(name in link.coordinates for link in mechanism.links.values())
        pins = sum(guide.point == name and guide.link is None for guide in mechanism.guides)
        ends = sum(name in (drive.distance or ()) for drive in mechanism.drives)
        if owners + pins + ends + (name in mechanism.frame.points) < 2:
            found.append(name)
    return found


def _still(scene: Scene | Globe, motion: xarray.Dataset) -> Figure:
    """The initial position over the paths of the points."""
    with house_style():
        wide, high = INCHES * ((scene.high - scene.low) / scene.extent + 2 * MARGIN)
        figure = Figure(figsize=(wide, high))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        draw = draw_globe if isinstance(scene, Globe) else draw_mechanism
        draw(axes, scene, initial_sample(scene, motion))  # type: ignore[arg-type]
        axes.set_axis_off()
    return figure
