"""Operations of a geometry that structure and motion need, so that neither knows in which space it works.

Places, poses and loci are whatever the space makes of them; coordinates in a link's own axes are pairs of
numbers in both: (x, y) [m] in the plane, (longitude, latitude) [rad] on the sphere. The curve of a guide is
given by two groups of numbers: a point and a unit vector of a line, or the pole and the arc of a circle.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeAlias

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Coordinates: TypeAlias = tuple[Number, Number]
Curve: TypeAlias = tuple[tuple[Number, ...], tuple[Number, ...]]
Place: TypeAlias = Any
Pose: TypeAlias = Any
Locus: TypeAlias = Any
Rotor: TypeAlias = tuple[Number, Number]
Row: TypeAlias = tuple[Number, ...]
Rows: TypeAlias = tuple[Row, Row]
"""Derivatives of one equation by the coordinates of the two bodies it ties: 2 of a point, 3 of a link."""
Reference: TypeAlias = tuple[Coordinates, ...] | None
"""Of an angle: two points in the axes of the link, two in those of the body it is measured against."""
Root: TypeAlias = Callable[[Number], Number]


class Space(Protocol):
    """The formulas of a geometry, over any algebra `m`.

    Coordinates of a point by which rows are derivatives: its shift in two unit directions that depend on its
    place alone. Of a link: in the plane the shift of its origin and its turn, on the sphere its rotation
    vector. `moved_point` and `moved_pose` move by the same coordinates.
    """

    @property
    def name(self) -> str:
        """Name of the space in a description."""

    @property
    def coordinates(self) -> tuple[str, str]:
        """Names of the coordinates in a link's own axes."""

    @property
    def axes(self) -> tuple[str, ...]:
        """Names of the components of a place."""

    @property
    def unit(self) -> str:
        """SI unit of lengths: m, or rad where they are arcs."""

    @property
    def crosses_once(self) -> bool:
        """Whether the curves of two guides meet in one place, not in two."""

    @property
    def lacks(self) -> frozenset[str]:
        """What a description may name and the space has no formulas for: gears, rolling, distance, guided links."""

    @property
    def at_rest(self) -> Pose:
        """Pose of the frame."""

    def place(self, m: Namespace, pose: Pose, local: Coordinates) -> Place:
        """Place of a link's point."""

    def attitude(self, pose: Pose) -> tuple[Number, ...]:
        """The numbers of a pose that tell how the link is turned."""

    def pose_of(self, m: Namespace, attitude: Sequence[Number], local: Coordinates, at: Place) -> Pose:
        """Pose from these numbers and the place of one point."""

    def stretch(self, attitude: Sequence[Number]) -> list[Number]:
        """Residuals that are zero as long as a link keeps its own distances."""

    def rotor(
        self, m: Namespace, pose: Pose, points: Sequence[Coordinates], towards: Sequence[Place]
    ) -> Rotor:
        """Cosine and sine of a link's angle, from the places it is measured towards.

        On the sphere: of the arc between its first two points, about the first, from the arc towards a place.
        In the plane it is the angle of the link's own axes.
        """

    # closed forms

    def pose_by_two_points(
        self, m: Namespace, first: Coordinates, second: Coordinates, at_first: Place, at_second: Place
    ) -> Pose:
        """Pose of a link from the places of two of its points."""

    def pose_at_angle(
        self,
        m: Namespace,
        angle: Number,
        points: Sequence[Coordinates],
        at: Sequence[Place | None],
        towards: Sequence[Place],
    ) -> Pose | None:
        """Pose of a link of a known angle from the places of its points that are known; None if it takes others.

        `towards` are the places that the angle is measured towards.
        """

    def turned_pose(
        self, m: Namespace, base: Pose, rotor: Rotor, pivot: Coordinates, at: Place, reference: Reference
    ) -> Pose:
        """Pose of a link with its pivot at a place, turned by a rotor against a base."""

    def aim(
        self, m: Namespace, pivot: Coordinates, at: Place, curve: Curve, target: Place, root: Root
    ) -> Pose:
        """Pose of a link with its pivot at a place, a curve of which passes through a target."""

    def circle(self, m: Namespace, centre: Place, first: Coordinates, second: Coordinates) -> Locus:
        """Where a link's point can be whose other point is at a centre."""

    def rail(self, m: Namespace, pose: Pose, curve: Curve) -> Locus:
        """Where a point on a guide can be."""

    def stop(self, m: Namespace, pose: Pose, curve: Curve, displacement: Number) -> Locus:
        """Where a point can be that has a displacement along a guide."""

    def place_at_slide(self, m: Namespace, pose: Pose, curve: Curve, displacement: Number) -> Place:
        """Place of a point that has a displacement along a guide."""

    def meet(self, one: Locus, other: Locus, root: Root, divisor: Root) -> Place:
        """Where two loci meet; circles of links stand first."""

    def directions_at(self, m: Namespace, locus: Locus, place: Place) -> tuple[Place, ...]:
        """Orthonormal directions at a place of a locus, the one square to the locus first; of plain numbers."""

    def implied_place(
        self, one: Locus, other: Locus, place: Place, root: Number, hold: Callable[[Number], Number]
    ) -> Place | None:
        """A number for each axis that has the derivatives of the place where two loci meet, as an implicit function.

        They are those of `meet` in fewer operations; the values of the numbers say nothing. `hold` gives a number as
        one without derivatives, `root` is the signed root that `meet` was given. None where no root decides.
        """

    def lack(self, m: Namespace, one: Locus, other: Locus) -> tuple[float, float, float, float]:
        """By how much two loci fail to meet, positive for the reason.

        Both together too short; the first too long for the second, and the other way round; both together too
        long, as only circles on the sphere can be.
        """

    # measures

    def distance(self, m: Namespace, a: Place, b: Place) -> Number:
        """Distance of two places."""

    def leverage(self, m: Namespace, first: Coordinates, second: Coordinates) -> Number:
        """How well two points of a link determine its attitude: their distance, on the sphere the sine of their arc."""

    def reach(self, m: Namespace, curve: Curve, at: Place) -> Number:
        """Distance of a guide's curve from a place in the axes of the body that carries it."""

    def period(self, m: Namespace, curve: Curve) -> Number | None:
        """Length of a guide's curve if it closes."""

    def slide(self, m: Namespace, point: Place, pose: Pose, curve: Curve) -> Number:
        """Displacement of a point along a guide.

        In the plane from the point the line goes through. On the sphere from the meridian of the pole to its
        north, counter-clockwise seen from outside the pole, in (-period/2, period/2].
        """

    # constraints

    def in_link(self, m: Namespace, point: Place, pose: Pose, local: Coordinates) -> list[Number]:
        """Two numbers that are zero where a link's point is at a place."""

    def in_link_rows(self, m: Namespace, point: Place, pose: Pose, local: Coordinates) -> list[Rows]:
        """Derivatives of `in_link` by the coordinates of point and link."""

    def apart(self, m: Namespace, point: Place, pose: Pose, local: Coordinates) -> list[Number]:
        """Components of a place less that of a link's point: for looking at, where `in_link` is for Newton's method."""

    def on_guide(self, m: Namespace, point: Place, pose: Pose, curve: Curve) -> Number:
        """Distance of a point from the curve of a guide, signed."""

    def on_guide_row(self, m: Namespace, point: Place, pose: Pose, curve: Curve) -> Rows:
        """Derivatives of `on_guide` by the coordinates of point and link."""

    def turn(self, m: Namespace, pose: Pose, base: Pose, rotor: Rotor, reference: Reference) -> Number:
        """Angle by which a link is turned from where a rotor against a base has it, in (-pi, pi]."""

    def turn_row(self, m: Namespace, pose: Pose, base: Pose, reference: Reference) -> Rows:
        """Derivatives of `turn` by the coordinates of link and base."""

    def slid(self, m: Namespace, point: Place, pose: Pose, curve: Curve, displacement: Number) -> Number:
        """Displacement of a point along a guide, less a given displacement."""

    def slid_row(self, m: Namespace, point: Place, pose: Pose, curve: Curve) -> Rows:
        """Derivatives of `slid` by the coordinates of point and link."""

    # small motions

    def moved_point(self, m: Namespace, point: Place, by: Sequence[Number]) -> Place:
        """A point moved by its two coordinates."""

    def moved_pose(self, m: Namespace, pose: Pose, by: Sequence[Number]) -> Pose:
        """A link moved by its three coordinates."""

    def shifts(self, m: Namespace, at: Place, scale: Number) -> Sequence[Row]:
        """Coordinates of three small motions of a link one of whose points is at a place.

        Shifts by `scale` in two directions, and a turn of 1 rad: about the point, in the plane about the origin.
        """

    def spin(self, pose: Pose, at: Place) -> Row:
        """Coordinates of a link's turn by 1 rad about a place."""

    def normalise(self, m: Namespace, pose: Pose) -> Pose:
        """A pose that keeps the link's own distances, from one that nearly does."""
