"""What may change in a repair: numbers by their paths, between bounds, and how large a change counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import TypeAlias

from centrode.errors import InputError
from centrode.kinematics.prepared import Ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.paths import value_at
from centrode.model.units import to_si
from centrode.model.values import Placed
from centrode.structure.dimensions import SPACES, dimensions_of

Value: TypeAlias = float | str
Bounds: TypeAlias = Mapping[str, tuple[Value, Value]]

MOST_PATHS = 12
SHRINK, STRETCH = 0.5, 2.0
"""How far a length changes where no bounds are given: to half and to double."""
AROUND = 0.5
"""How far a coordinate moves where no bounds are given, in the greatest length."""


@dataclass(frozen=True)
class Varying:
    """One number that may change.

    Attributes
    ----------
    unit : "rad", "m" or "1"
    scale : change that counts as 1: a radian, the length itself, for coordinates the greatest length
    """

    path: str
    before: float
    low: float
    high: float
    unit: str
    scale: float

    @property
    def is_initial_angle(self) -> bool:
        """Whether it is the initial angle of a link, which places what is `placed`."""
        return self.path.startswith("links.") and self.path.endswith(".angle")


def varyings(prepared: Ready, vary: Sequence[str] | None, bounds: Bounds | None) -> tuple[Varying, ...]:
    """The numbers that may change, with their bounds in SI.

    Without `vary`: the initial angles of links that are not driven, where these place something; otherwise the
    lengths of all links.
    """
    mechanism = prepared.mechanism
    paths = list(dict.fromkeys(vary)) if vary else [*dict.fromkeys(bounds or ())] or default_paths(mechanism)
    for path in bounds or {}:
        if path not in paths:
            raise InputError(
                "bounds", _("{path} is not among what varies").format(path=path), _("name it in vary as well")
            )
    if not 1 <= len(paths) <= MOST_PATHS:
        raise InputError(
            "vary",
            _("{n} numbers were named").format(n=len(paths)),
            _("name {least} to {most}").format(least=1, most=MOST_PATHS),
        )
    return tuple(_varying(prepared, path, (bounds or {}).get(path)) for path in paths)


def default_paths(mechanism: Mechanism) -> list[str]:
    """What varies if nothing is named."""
    driven = {drive.link for drive in mechanism.drives}
    if places_anew(mechanism):
        angled = [name for name, link in mechanism.links.items() if link.angle is not None]
        return [f"links.{name}.angle" for name in angled if name not in driven][:MOST_PATHS]
    lengths = [name for name, link in mechanism.links.items() if link.length is not None]
    return [f"links.{name}.length" for name in lengths][:MOST_PATHS]


def places_anew(mechanism: Mechanism) -> bool:
    """Whether the chain of initial angles places anything, so that changed angles are changed dimensions.

    On the sphere what is placed stays where it is.
    """
    if mechanism.space == "sphere":
        return False
    points = any(isinstance(at, Placed) for at in mechanism.frame.points.values())
    return points or any(isinstance(guide.through, Placed) for guide in mechanism.guides)


def _varying(prepared: Ready, path: str, bounds: tuple[Value, Value] | None) -> Varying:
    mechanism = prepared.mechanism
    try:
        before = value_at(mechanism, path)
    except InputError as error:
        raise InputError(path, error.what, error.repair) from None
    unit = _unit(mechanism, path)
    scale = _scale(prepared, path, before, unit)
    found = Varying(path, before, 0.0, 0.0, unit, scale)
    _check_varies(prepared, found)
    low, high = _default_bounds(found) if bounds is None else _given_bounds(found, bounds)
    return Varying(path, before, low, high, unit, scale)


def _unit(mechanism: Mechanism, path: str) -> str:
    if path.endswith((".angle", ".direction")):
        return "rad"
    return "1" if path.endswith(".ratio") else SPACES[mechanism.space].unit


def _scale(prepared: Ready, path: str, before: float, unit: str) -> float:
    if path.endswith((".length", ".ratio", ".radius")):
        return abs(before)
    return 1.0 if unit == "rad" else float(prepared.kinematics.numbers.scale)


def _default_bounds(one: Varying) -> tuple[float, float]:
    if one.path.endswith((".length", ".ratio", ".radius")):
        ends = sorted((SHRINK * one.before, STRETCH * one.before))
        return ends[0], min(ends[1], 0.999 * pi) if one.unit == "rad" else ends[1]
    reach = pi if one.unit == "rad" else AROUND * one.scale
    return one.before - reach, one.before + reach


def _given_bounds(one: Varying, bounds: tuple[Value, Value]) -> tuple[float, float]:
    kind = {"rad": "angle", "m": "length", "1": "ratio"}[one.unit]
    try:
        low, high = (to_si(value, kind) for value in bounds)
    except InputError as error:
        raise InputError(one.path, error.what, error.repair) from None
    if low > high:
        raise InputError(one.path, _("its lower bound is above its upper one"), _("exchange them"))
    if not low <= one.before <= high:
        raise InputError(
            one.path,
            _("its bounds have to hold its present value, {value:.6g} {unit}").format(
                value=one.before, unit=one.unit
            ),
            _("widen them"),
        )
    if one.path.endswith((".length", ".radius")) and low <= 0.0:
        raise InputError(one.path, _("a length stays positive"), _("raise its lower bound"))
    return low, high


def _check_varies(prepared: Ready, one: Varying) -> None:
    """Refuse what changes nothing, or is not a dimension."""
    mechanism = prepared.mechanism
    if one.is_initial_angle:
        link = one.path.removeprefix("links.").removesuffix(".angle")
        if not places_anew(mechanism):
            raise InputError(
                one.path,
                _("an initial angle changes no dimension where nothing is placed by it"),
                _("vary lengths or points, or let a point of the frame be placed"),
            )
        if any(drive.link == link for drive in mechanism.drives):
            raise InputError(one.path, _("the drive gives this angle"), _("vary that of another link"))
        return
    if _is_placed(mechanism, one.path):
        raise InputError(
            one.path,
            _("it is placed by the initial angles"),
            _("vary these, or give it coordinates"),
        )
    dimensions_of(mechanism, {one.path: one.before})


def _is_placed(mechanism: Mechanism, path: str) -> bool:
    placed = [f"frame.points.{n}." for n, at in mechanism.frame.points.items() if isinstance(at, Placed)]
    placed += [f"guides.{g.id}.through." for g in mechanism.guides if isinstance(g.through, Placed)]
    return path.startswith(tuple(placed))
