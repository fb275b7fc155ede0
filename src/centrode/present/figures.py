"""The figures of a motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import xarray
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.present.curves import (
    DrawnAbscissa,
    Motion,
    Rows,
    main_abscissa,
    of_coefficients,
    of_guides,
    of_joints,
    of_links,
    of_points,
    over_drive,
    sheet,
)
from centrode.present.linkage_scene import scene_of
from centrode.present.pictures import mechanism_figure, paths_figure
from centrode.present.scene import LinkageScene
from centrode.present.sphere.globe import Globe, globe_of
from centrode.present.style import house_style, pens

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism


def motion_figures(
    mechanism: Mechanism,
    dataset: xarray.Dataset,
    instants: Sequence[float] = (),
    at_instants: xarray.Dataset | None = None,
) -> dict[str, Figure]:
    """Figures of a motion, by name.

    Parameters
    ----------
    mechanism : Mechanism
        The description, with every "placed" resolved.
    dataset : Dataset
        Its motion, without batch dimensions.
    instants : sequence of float [rad or m; s with several drives]
        Values of the drive at which the mechanism is drawn, each at the nearest sample; left out, it is drawn in
        the initial position over fading pictures of others.
    at_instants : Dataset, optional
        The motion exactly there.

    Returns
    -------
    dict of name -> Figure
        "mechanism", "paths", "angles", "angular-velocities", "angular-accelerations", "velocities",
        "accelerations", "slides", "kinematic-coefficients": those that have something to show. On the sphere
        "joint-angles", "joint-velocities" and "joint-accelerations" in place of "angles".
    """
    with house_style():
        scene = read_scene(mechanism, dataset)
        kept = {
            "link": pens(mechanism.link_names),
            "joint": pens(mechanism.link_names),
            "point": pens(mechanism.moving_points),
            "guide": pens(guide.id for guide in mechanism.guides),
        }
        motion = Motion(mechanism, dataset, main_abscissa(mechanism, dataset), kept)
        figures = {
            "mechanism": mechanism_figure(*_with(mechanism, dataset, at_instants), instants),
            "paths": paths_figure(scene, dataset, motion.abscissa, kept["point"]),
        }
        for name, (title, rows, abscissa) in sheets(motion).items():
            if any(panel.curves for row in rows for panel in row):
                figures[name] = sheet(title, _(mechanism.title), rows, abscissa)
    return figures


def _with(
    mechanism: Mechanism, dataset: xarray.Dataset, more: xarray.Dataset | None
) -> tuple[LinkageScene | Globe, xarray.Dataset]:
    """Scene and samples of a motion, with samples of another behind them."""
    if more is None:
        return read_scene(mechanism, dataset), dataset
    together = [data.drop_dims("event", errors="ignore") for data in (more, dataset)]
    joined = xarray.concat(together, dim="sample", data_vars="minimal")
    return read_scene(mechanism, joined), joined


def read_scene(mechanism: Mechanism, dataset: xarray.Dataset) -> LinkageScene | Globe:
    """Where everything stands, in the plane or on the sphere."""
    on_sphere = mechanism.space == "sphere"
    return globe_of(mechanism, dataset) if on_sphere else scene_of(mechanism, dataset)


def sheets(motion: Motion) -> dict[str, tuple[str, Rows, DrawnAbscissa]]:
    """Title, panels and abscissa of every figure of curves."""
    main = motion.abscissa
    found = {
        **(joint_sheets(motion) if "joint" in motion.dataset.dims else {}),
        **(
            {"angles": (_("Angles of the links"), of_links(motion, "angle"), main)}
            if motion.axes == 2
            else {}
        ),
        "angular-velocities": (
            _("Angular velocities of the links"),
            of_links(motion, "angular_velocity"),
            main,
        ),
        "angular-accelerations": (
            _("Angular accelerations of the links"),
            of_links(motion, "angular_acceleration"),
            main,
        ),
        "velocities": (_("Velocities of the points"), of_points(motion, "velocity"), main),
        "accelerations": (_("Accelerations of the points"), of_points(motion, "acceleration"), main),
        "slides": (_("Motion along the guides"), of_guides(motion), main),
    }
    if not motion.mechanism.motion_parameter.by_time and "velocity_coefficient" in motion.dataset:
        over = over_drive(motion.mechanism, motion.dataset)
        found["kinematic-coefficients"] = (_("Kinematic coefficients"), of_coefficients(motion), over)
    return found


def joint_sheets(motion: Motion) -> dict[str, tuple[str, Rows, DrawnAbscissa]]:
    """Angles of links from their reference arcs, and the rates of these."""
    main = motion.abscissa
    return {
        "joint-angles": (_("Angles from the reference arcs"), of_joints(motion, "joint_angle"), main),
        "joint-velocities": (
            _("Angular velocities from the reference arcs"),
            of_joints(motion, "joint_velocity"),
            main,
        ),
        "joint-accelerations": (
            _("Angular accelerations from the reference arcs"),
            of_joints(motion, "joint_acceleration"),
            main,
        ),
    }
