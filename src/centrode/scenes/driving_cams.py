"""A cam under its follower in a picture: its profile however it has turned, the roller, the arm, the face."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from centrode.cams.followers.base_circle import follower_cam, has_size
from centrode.cams.followers.geometry import FollowerCam, Oscillating
from centrode.errors import CentrodeError
from centrode.model.checks import pivot_of
from centrode.numerics.arrays import ARRAYS

if TYPE_CHECKING:
    import xarray

    from centrode.model.follower_cam import PlateCam
    from centrode.model.mechanism import Drive, Mechanism

Array = NDArray[np.float64]
PLACES = 361
FACE = 0.12
"""How far a flat face goes on beyond the contacts, as a part of the base radius."""
MARK = 0.62
"""Length of the mark that shows how the cam has turned, as a part of its base radius."""


@dataclass(frozen=True)
class DrivingCam:
    """A cam in the picture of its follower, which may belong to a linkage.

    Attributes
    ----------
    body : FollowerCam
    centre : (2) [m]
        Of its axis.
    axes : (2, 2)
        Rows are the directions of the follower's own x and y in the picture; a mirror image where the lift turns the
        link counter-clockwise.
    angles : (sample) [rad]
        That the cam has turned in its sense.
    pivot : (2) [m] or None
        Of an oscillating follower.
    factor : float
        Units of the display in a metre.
    """

    body: FollowerCam
    centre: Array
    axes: Array
    angles: Array
    pivot: Array | None
    factor: float

    def drawn(self, places: Array) -> Array:
        """Places (n, 2) of the follower's axes in the picture, in units of the display."""
        return self.factor * (self.centre + places @ self.axes)

    @classmethod
    def alone(cls, body: FollowerCam, angles: Array, factor: float) -> DrivingCam:
        """The cam with its follower in the follower's own axes, without a linkage."""
        pivot = np.array([body.guide.distance, 0.0]) if isinstance(body.guide, Oscillating) else None
        return cls(body, np.zeros(2), np.eye(2), angles, pivot, factor)

    @property
    def hub(self) -> Array:
        """The axis, in units of the display."""
        return np.asarray(self.factor * self.centre)

    @property
    def forward(self) -> bool:
        """Whether the cam turns counter-clockwise in the picture."""
        return bool(self.body.sense * np.linalg.det(self.axes) > 0.0)

    def carried_places(self, places: Array, sample: int) -> Array:
        """Places (n, 2) of the cam's axes in the picture as the cam stands at a sample."""
        return self.drawn(self.body.in_frame(places, np.full(len(places), self.angles[sample])))

    def outline(self, sample: int) -> Array:
        """The profile as the cam stands at a sample (n, 2)."""
        return self.carried_places(self._profile, sample)

    def mark(self, sample: int) -> Array:
        """A line from the axis (2, 2) that shows how the cam has turned."""
        return self.carried_places(np.array([[0.0, 0.0], [0.0, MARK * self.body.base_radius]]), sample)

    @cached_property
    def _profile(self) -> Array:
        edges = np.array(self.body.edges)
        phi = np.unique(np.concatenate([np.linspace(0.0, edges[-1], PLACES), edges]))[:-1]
        return self.body.contact(phi).place

    def roller(self, sample: int) -> tuple[Array, float] | None:
        """Centre and radius of the roller; nothing of other followers."""
        radius = self.body.touch.roller
        if not 0.0 < radius < math.inf:
            return None
        return self._touching(sample), self.factor * radius

    def arm(self, sample: int) -> tuple[Array, Array] | None:
        """An oscillating follower from its pivot to the roller's centre, the edge, or the end of its face."""
        if self.pivot is None:
            return None
        if math.isinf(self.body.touch.roller):
            return self._swinging_face(sample)
        return self.factor * self.pivot, self._touching(sample)

    def face(self, sample: int) -> tuple[Array, Array] | None:
        """The ends of a translating flat face."""
        if math.isfinite(self.body.touch.roller) or isinstance(self.body.guide, Oscillating):
            return None
        height = self.body.guide.start + float(self.body.motion.lift(self.angles[[sample]])[0, 0])
        over, offset = FACE * self.body.base_radius, self.body.guide.offset
        ends = (self.body.face.least - over + offset, self.body.face.greatest + over + offset)
        first, last = self.drawn(np.array([[x, height] for x in ends]))
        return first, last

    def shank(self, sample: int) -> tuple[Array, Array] | None:
        """What joins a swinging face to the pivot that it passes at a distance."""
        guide, line = self.body.guide, self.arm(sample)
        if line is None or self.pivot is None or not isinstance(guide, Oscillating) or not guide.face_offset:
            return None
        return self.factor * self.pivot, line[0]

    def lines(self, sample: int) -> list[tuple[Array, Array]]:
        """All of the follower that is straight: arm, face, shank."""
        found = (self.arm(sample), self.face(sample), self.shank(sample))
        return [line for line in found if line is not None]

    def foot(self, sample: int) -> Array:
        """Where the stem of a translating follower ends: in the roller's centre, the edge, or on the face."""
        if isinstance(self.body.guide, Oscillating):
            return self._touching(sample)
        height = self.body.guide.start + float(self.body.motion.lift(self.angles[[sample]])[0, 0])
        return np.asarray(self.drawn(np.array([[self.body.guide.offset, height]]))[0])

    def reach(self) -> Array:
        """Corners of a box that holds the cam however it has turned, and its roller at any sample."""
        edges = np.array(self.body.edges)
        phi = np.linspace(0.0, edges[-1], PLACES)
        contact = self.body.contact(phi)
        most = float(np.linalg.norm(contact.place, axis=1).max())
        corners = [self.centre - most, self.centre + most]
        radius = self.body.touch.roller
        if 0.0 < radius < math.inf:
            turned = self.body.in_frame(contact.centre, phi) @ self.axes + self.centre
            corners += [turned.min(axis=0) - radius, turned.max(axis=0) + radius]
        if self.pivot is not None:
            corners.append(self.pivot)
        return self.factor * np.array(corners)

    def _touching(self, sample: int) -> Array:
        """The roller's centre or the edge in the picture."""
        phi = np.mod(self.angles[[sample]], math.tau)
        return np.asarray(self.drawn(self.body.in_frame(self.body.contact(phi).centre, phi))[0])

    def _swinging_face(self, sample: int) -> tuple[Array, Array]:
        guide = self.body.guide
        assert isinstance(guide, Oscillating)
        psi = guide.start + float(self.body.motion.lift(self.angles[[sample]])[0, 0])
        along, normal = np.array([-math.cos(psi), math.sin(psi)]), np.array([math.sin(psi), math.cos(psi)])
        foot = np.array([guide.distance, 0.0]) - guide.face_offset * normal
        far = self.body.face.greatest + FACE * self.body.base_radius
        first, last = self.drawn(np.array([foot, foot + far * along]))
        return first, last


# The cams that drive a linkage, in its own picture: where their axes are and how far they have turned.

APART = 1e-9
"""Of drive's values and the cam's lift, over the greatest of them: more, and the cam does not move the drive."""


def driving_cams(mechanism: Mechanism, dataset: xarray.Dataset, factor: float) -> tuple[DrivingCam, ...]:
    """The cams of a linkage's drives that can be drawn: those whose follower moves against the frame.

    Parameters
    ----------
    mechanism : Mechanism
    dataset : Dataset
        Its motion, without batch dimensions.
    factor : float
        Units of the display in a metre.

    Raises
    ------
    InputError, MotionError
        A cam that cannot lead its follower, or whose profile it undercuts.
    """
    return tuple(_cams(mechanism, dataset, factor))


def _cams(mechanism: Mechanism, dataset: xarray.Dataset, factor: float) -> Iterator[DrivingCam]:
    for drive in mechanism.drives:
        if drive.cam is None or drive.turning is None or not has_size(drive.cam):
            continue
        time = np.asarray(dataset["time"], dtype=float)
        coordinate = mechanism.motion_parameter.drive(drive.id)
        values = coordinate.measure_at(np.asarray(dataset["drive_value"].sel(drive=drive.id), dtype=float))
        apart = values - np.asarray(drive.motion_law.jet(ARRAYS, time), dtype=float)
        zero = float(np.nanmedian(apart)) if np.isfinite(apart).any() else math.nan
        # Where a simulation moves the linkage, the cam does not.
        if not np.nanmax(np.abs(apart - zero), initial=0.0) <= APART * max(
            1.0, float(np.nanmax(abs(values)))
        ):
            continue
        body = driving_body(drive, drive.cam)
        placed = (
            _translating(mechanism, drive, body, zero)
            if drive.guide
            else _turning(mechanism, drive, body, zero)
        )
        if placed is not None:
            centre, axes, pivot = placed
            angles = drive.cam_angle + drive.turning * time
            yield DrivingCam(body, centre, axes, angles, pivot, factor)


def driving_body(drive: Drive, cam: PlateCam) -> FollowerCam:
    """The cam of a drive with its follower.

    Raises
    ------
    InputError, MotionError
        As `follower_cam`, naming the drive.
    """
    try:
        return follower_cam(cam)
    except CentrodeError as error:
        where = ", ".join(part for part in (f"[[drives]] {drive.id}, cam", error.where) if part)
        raise type(error)(where, error.what, error.repair) from None


Placed = tuple[Array, Array, Array | None]


def _translating(mechanism: Mechanism, drive: Drive, body: FollowerCam, zero: float) -> Placed | None:
    """Below the guided point at lift zero, along the guide."""
    guide = mechanism.guide(drive.guide or "")
    if guide.on != "frame" or isinstance(body.guide, Oscillating):
        return None
    unit = np.asarray(guide.unit, dtype=float)
    lowest = np.asarray(mechanism.through(guide), dtype=float) + zero * unit
    up = -unit if drive.lowers else unit
    axes = np.array([[up[1], -up[0]], up])
    return lowest - np.array([body.guide.offset, body.guide.start]) @ axes, axes, None


def _turning(mechanism: Mechanism, drive: Drive, body: FollowerCam, zero: float) -> Placed | None:
    """Beside the pivot of the driven link, its arm as it stands at lift zero."""
    pivot = pivot_of(mechanism, drive.link or "")
    if pivot is None or drive.relative_to != "frame" or not isinstance(body.guide, Oscillating):
        return None
    arm = zero + _heading(mechanism, drive, pivot)
    # In the follower's own axes the arm points to pi - start and lifts clockwise.
    if drive.lowers:
        axes = _rotation(arm - (math.pi - body.guide.start))
    else:
        axes = np.diag([1.0, -1.0]) @ _rotation(arm + (math.pi - body.guide.start))
    place = np.asarray(mechanism.frame.coordinates[pivot], dtype=float)
    return place - np.array([body.guide.distance, 0.0]) @ axes, axes, place


def _heading(mechanism: Mechanism, drive: Drive, pivot: str) -> float:
    """Angle of the arm in the link's own axes."""
    if drive.cam_point is None:
        return 0.0
    points = mechanism.links[drive.link or ""].coordinates
    x, y = np.subtract(points[drive.cam_point], points[pivot])
    return math.atan2(y, x)


def _rotation(angle: float) -> Array:
    """Rows are the axes turned by an angle."""
    return np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
