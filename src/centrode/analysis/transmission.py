"""Transmission and pressure angles of dyads over a motion.

The transmission angle of a group is the angle at which the two lines meet that its velocity diagram is drawn with:
for two links the angle between them at their common hinge (0 to 180 deg), otherwise the acute one. The pressure
angle, between the force on what is driven and its velocity, is what is left to a right angle: at a guide between
the link and the guide (RRP), at a rocking guide between the guide and the arm to its pivot (RPR), at two guides
between the normal of one and the other (PRP, RPP). Friction is left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.transmission_extremes import extreme_transmission_angles
from centrode.analysis.transmission_on_sphere import ArcAngles
from centrode.errors import InputError
from centrode.kinematics.dataset import dataset_of, named
from centrode.kinematics.ready import ready
from centrode.kinematics.solve import asked_span, solve
from centrode.kinematics.spans import span_at
from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Aim, Group, Meet, Rail, Rod, Slot, Stop, Stroke, links_of, points_of

Lines: TypeAlias = npt.NDArray[np.complex128]
Array: TypeAlias = npt.NDArray[np.float64]


def transmission_angles(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    at: npt.ArrayLike | None = None,
) -> xr.Dataset:
    """Transmission and pressure angles of every dyad over the motion.

    The arguments are those of `motion`. The result has the dimensions sample and group: `transmission_angle` and
    `pressure_angle` [rad] by the links of the groups, with time, status, events and values of the drives as in the
    motion. Accurate as the positions are; at a limit the transmission angle is 0 or 180 deg. Groups of higher class and
    gears have none. `least_transmission_angle` and `greatest_transmission_angle` [rad] (group) are the exact extremes
    of the acute angle over all that the mechanism reaches between the first and the last sample.

    On the sphere they are angles between arcs: of links, and from a point to the pole of its guide.

    Raises InputError where no group has such an angle; else as `motion` does.
    """
    prepared = ready(mechanism)
    span = (
        asked_span(prepared, samples, start, stop)
        if at is None
        else span_at(prepared.kinematics.path, np.asarray(at, dtype=np.float64))
    )
    data = dataset_of(solve(prepared, span))
    structure = prepared.structure
    found, numbered = {}, []
    arcs = ArcAngles(data) if mechanism.space == "sphere" else None
    for number, group in enumerate(structure.groups):
        angle = _angle(data, structure.dimensions, group) if arcs is None else arcs.of(group)
        if angle is not None:
            found["-".join(links_of(group) or points_of(group))] = angle
            numbered.append(number)
    if not found:
        raise InputError(
            "[links]",
            _("no group of the mechanism has a transmission angle"),
            _("ask for it where a dyad of two links, or of a link and a guide, is driven"),
        )
    angles = np.stack(list(found.values()), axis=1)
    extremes = extreme_transmission_angles(prepared, span)
    least, greatest = np.array([extremes[number] for number in numbered]).T
    variables = {
        "transmission_angle": named("transmission_angle", ("sample", "group"), angles),
        "pressure_angle": named("pressure_angle", ("sample", "group"), np.abs(np.pi / 2 - angles)),
        "least_transmission_angle": named("least_transmission_angle", ("group",), least),
        "greatest_transmission_angle": named("greatest_transmission_angle", ("group",), greatest),
        **{name: data[name] for name in ("status", "event_value", "event_kind")},
    }
    coords = {"group": list(found), **{name: data[name] for name in ("time", "drive_value")}}
    return xr.Dataset(variables, coords, attrs={"title": mechanism.title})


@dataclass(frozen=True)
class TransmissionResults:
    """Transmission and pressure angles of a mechanism.

    Attributes
    ----------
    mechanism : Mechanism
    angles : the dataset of `transmission_angles`
    """

    mechanism: Mechanism
    angles: xr.Dataset


def transmission_results(mechanism: Mechanism, samples: int | None = None) -> TransmissionResults:
    """Transmission and pressure angles over the motion, with the mechanism; raises as `transmission_angles` does."""
    return TransmissionResults(mechanism, transmission_angles(mechanism, samples))


def _angle(data: xr.Dataset, numbers: Dimensions, group: Group) -> Array | None:
    """Transmission angle of a group at every sample; None where it has none."""
    if isinstance(group, Aim) and group.contact is None:
        arm = place(data, group.target) - place(data, group.pivot)
        return _acute(1j * arm, _heading(data, numbers, group.link, group.guide))
    if not isinstance(group, Meet) or any(isinstance(locus, Stop) for locus in group.loci):
        return None
    directions = list(_directions(data, numbers, group))
    if len(directions) != 2:
        return None
    if group.circles == 2:
        return np.abs(np.angle(directions[1] * directions[0].conj()))
    return _acute(*directions)


def _directions(data: xr.Dataset, numbers: Dimensions, group: Meet) -> Iterator[Lines]:
    """Directions in which the loci let the group's vector move; of circles the arms towards their centres."""
    circles = group.circles == 2
    for locus in group.loci:
        if isinstance(locus, (Rod, Stroke)):
            arm = place(data, locus.centre) - place(data, locus.point)
            yield arm if circles else 1j * arm
        elif isinstance(locus, Rail):
            yield _heading(data, numbers, locus.on, locus.guide)
        elif isinstance(locus, Slot) and group.carriage is not None:
            yield _heading(data, numbers, group.carriage, locus.guide)


def place(data: xr.Dataset, point: str) -> Lines:
    """Places of a point as complex numbers."""
    xy = data["position"].sel(point=point).to_numpy()
    return np.asarray(xy[:, 0] + 1j * xy[:, 1])


def _heading(data: xr.Dataset, numbers: Dimensions, link: str, guide: str) -> Lines:
    """Directions of a guide at every sample."""
    turn = np.zeros(data.sizes["sample"]) if link == FRAME else data["angle"].sel(link=link).to_numpy()
    return np.asarray(complex(*numbers.direction[guide]) * np.exp(1j * turn))


def _acute(first: Lines, second: Lines) -> Array:
    """The acute angle between two directions, in [0, pi/2]."""
    turned = second * first.conj()
    return np.asarray(np.arctan2(np.abs(turned.imag), np.abs(turned.real)))
