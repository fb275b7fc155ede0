"""Limits of the dimensions of a mechanism: those of its description, and the distribution between them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.files import value_at
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.reading import value_text
from centrode.model.tolerance_checks import bodies_at_pin, limits_of_number, refuse_counted
from centrode.model.tolerances import Correlation, Distribution, Limits, is_size
from centrode.model.values import Vector

Array = npt.NDArray[np.float64]

SIGMAS = {"normal": 3.0, "uniform": math.sqrt(3.0), "triangular": math.sqrt(6.0)}
"""Half of the width between the limits, in standard deviations."""
FLAT = 1e-12
"""A coordinate below this part of the greatest one is zero: the point lies on an axis of its link."""


@dataclass(frozen=True)
class DimensionLimits:
    """Numbers that deviate from those of the description.

    Attributes
    ----------
    paths : in the order of the description
    values : of the description [SI]
    lower, upper : deviations [SI]
    distribution : between the limits
    correlations : of numbers that deviate together
    """

    paths: tuple[str, ...]
    values: Array
    lower: Array
    upper: Array
    distribution: Distribution = "normal"
    correlations: tuple[Correlation, ...] = ()

    @property
    def middles(self) -> Array:
        """Mean deviations [SI]."""
        return np.asarray(0.5 * (self.lower + self.upper))

    @property
    def halves(self) -> Array:
        """Half of the width between the limits [SI]."""
        return np.asarray(0.5 * (self.upper - self.lower))

    @property
    def deviations(self) -> Array:
        """Standard deviations [SI]."""
        return np.asarray(self.halves / SIGMAS[self.distribution])

    @cached_property
    def correlation(self) -> Array:
        """Matrix of coefficients of correlation.

        Raises InputError where no numbers can have them.
        """
        matrix = np.eye(len(self.paths))
        for one in self.correlations:
            numbers = [self.paths.index(path) for path in one.paths]
            for number in numbers:
                for other in numbers:
                    if number != other:
                        matrix[number, other] = one.value
        least = float(np.linalg.eigvalsh(matrix)[0]) if len(matrix) else 1.0
        # rounding of the eigenvalues grows with the size of the matrix
        if least < -len(matrix) * 1e-14:
            raise InputError(
                "[tolerances] correlations",
                _("no numbers can deviate together in this way: the matrix has a negative eigenvalue"),
                _("bring the coefficients nearer to zero"),
            )
        return matrix

    @property
    def covariance(self) -> Array:
        """Covariance matrix of the deviations [SI^2]."""
        deviations = self.deviations
        return np.asarray(self.correlation * deviations[:, None] * deviations[None, :])

    def with_paths(self, paths: Sequence[str]) -> DimensionLimits:
        """The limits of some of the numbers."""
        rows = [self.paths.index(path) for path in paths]
        kept = tuple(one for one in self.correlations if set(one.paths) <= set(paths))
        return DimensionLimits(
            tuple(paths), self.values[rows], self.lower[rows], self.upper[rows], self.distribution, kept
        )


def limits_of(mechanism: Mechanism, given: Mapping[str, Limits | str] | None = None) -> DimensionLimits:
    """Limits of the dimensions: those given by path, or those of the description with its default.

    Numbers without width are left out, as they are exact. Raises InputError: no tolerance at all, a size beyond the
    standard grades.
    """
    settings = mechanism.tolerances
    found: dict[str, Limits] = {}
    if given is None and settings is not None:
        given = {**_defaults(mechanism, settings.default), **settings.dimensions}
    for path, tolerance in (given or {}).items():
        try:
            refuse_counted(mechanism, path)
            found[path] = limits_of_number(tolerance, value_at(mechanism, path))
        except InputError as error:
            raise InputError(f"[tolerances] {path}", error.what, error.repair) from None
    found = {path: limits for path, limits in found.items() if limits[0] != limits[1]}
    if not found:
        raise InputError(
            "[tolerances]",
            _("no dimension has a tolerance"),
            _('write default = "±0.1 mm", or a path: "links.OA.length" = "±0.1 mm"'),
        )
    paths = tuple(found)
    lower, upper = np.array(list(found.values())).T
    values = np.array([value_at(mechanism, path) for path in paths])
    return DimensionLimits(
        paths,
        values,
        lower,
        upper,
        "normal" if settings is None else settings.distribution,
        ()
        if settings is None
        else tuple(one for one in settings.correlations if set(one.paths) <= set(paths)),
    )


def check_paths(mechanism: Mechanism, paths: Sequence[str], where: str) -> None:
    """Raise InputError at the first path that leads to no number."""
    for path in paths:
        try:
            value_at(mechanism, path)
        except InputError as error:
            raise InputError(where, error.what, error.repair) from None
    for path in paths:
        if list(paths).count(path) > 1:
            raise InputError(where, _("{name} is given twice").format(name=value_text(path)))


def _defaults(mechanism: Mechanism, default: Limits | str | None) -> dict[str, Limits | str]:
    if default is None:
        return {}
    paths = length_paths(mechanism)
    if isinstance(default, str):
        paths = [path for path in paths if is_size(path, mechanism.space)]
    return dict.fromkeys(paths, default)


def length_paths(mechanism: Mechanism) -> list[str]:
    """Paths of the lengths that a drawing of the mechanism dimensions; on the sphere those of arcs.

    Of a link with coordinates the first joint is the origin of its dimensions and the second one lies on their axis, if
    they do so in the description; of the frame a joint at its origin is the origin.
    """
    return list(dict.fromkeys(_lengths(mechanism)))


def _lengths(mechanism: Mechanism) -> Iterator[str]:
    plane = mechanism.space == "plane"
    for name, link in mechanism.links.items():
        if link.length is not None:
            yield f"links.{name}.length"
        elif plane:
            yield from _of_points(mechanism, name, link.coordinates)
    if plane:
        joints = {p: at for p, at in mechanism.frame.coordinates.items() if _is_joint(mechanism, p, FRAME)}
        scale = max((abs(x) for at in joints.values() for x in at), default=1.0)
        for point, (x, y) in joints.items():
            if max(abs(x), abs(y)) > FLAT * scale:
                yield from (f"frame.points.{point}.{axis}" for axis in "xy")
        for guide in mechanism.guides:
            if guide.on == FRAME and isinstance(guide.through, tuple):
                along = guide.unit
                yield f"guides.{guide.id}.through.{'y' if abs(along[0]) >= abs(along[1]) else 'x'}"
    for wheel in mechanism.rolling:
        yield f"rolling.{wheel.id}.radius"
    if not plane:
        yield from (f"guides.{guide.id}.radius" for guide in mechanism.guides if guide.radius is not None)


def _of_points(mechanism: Mechanism, name: str, points: Mapping[str, Vector]) -> Iterator[str]:
    joints = [(point, place) for point, place in points.items() if _is_joint(mechanism, point, name)]
    scale = max((abs(x) for _point, place in joints for x in place), default=1.0)
    for number, (point, (x, y)) in enumerate(joints):
        if number == 0 and max(abs(x), abs(y)) <= FLAT * scale:
            continue
        for axis, value in (("x", x), ("y", y)):
            if number > 1 or abs(value) > FLAT * scale:
                yield f"links.{name}.points.{point}.{axis}"


def _is_joint(mechanism: Mechanism, point: str, body: str) -> bool:
    """Whether another body is hinged there, or a guide leads the point or passes through it."""
    if len(bodies_at_pin(mechanism, point)) > 1:
        return True
    ends = {end for drive in mechanism.drives for end in drive.distance or ()}
    return point in ends or any(
        point == guide.point or (guide.through == point and guide.on == body) for guide in mechanism.guides
    )
