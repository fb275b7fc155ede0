"""Candidates of a repair: many mechanisms of one structure at once, and one of them as a description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.analysis.repairing.varying import Varying, places_anew
from centrode.geometry.plane import Vector, add, reversed_rotor, rotor_of, subtract, turned
from centrode.kinematics.assembly_mode import side_names, side_words, stated_side
from centrode.kinematics.dyads import solve_group
from centrode.kinematics.plan_evaluation import FixedSigns, Kinematics, SideChoices
from centrode.kinematics.prepared import Ready
from centrode.model.frozen import FrozenMap
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.paths import with_value
from centrode.model.placing import replace_placed
from centrode.model.values import Placed
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions, dimensions_of
from centrode.structure.groups import Group, links_of

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


@dataclass(frozen=True)
class Batch:
    """Mechanisms of one structure: the plan with their numbers as columns, and the signs of their initial positions."""

    kinematics: Kinematics
    signs: Mapping[int, Array]
    size: int


@dataclass(frozen=True)
class Candidates:
    """A mechanism and what may change in it."""

    prepared: Ready
    varying: tuple[Varying, ...]

    def values(self, changes: Array) -> Array:
        """Values (n, p) in SI at scaled changes (n, p)."""
        before = np.array([one.before for one in self.varying])
        return np.asarray(before + changes * np.array([one.scale for one in self.varying]))

    def box(self) -> tuple[Array, Array]:
        """Least and greatest scaled change of each number."""
        low = np.array([(one.low - one.before) / one.scale for one in self.varying])
        high = np.array([(one.high - one.before) / one.scale for one in self.varying])
        return low, high

    def batch(self, changes: Array) -> Batch:
        """The mechanisms at scaled changes (n, p); what the initial angles place is placed anew."""
        mechanism = self.prepared.mechanism
        columns = dict(zip((one.path for one in self.varying), self.values(changes).T, strict=True))
        angles = {p.split(".")[1]: x for p, x in columns.items() if self._turns(p)}
        varied = {path: x for path, x in columns.items() if not self._turns(path)}
        numbers = dimensions_of(mechanism, varied, ARRAYS)
        if places_anew(mechanism):
            size = len(changes)
            placed = placed_numbers(mechanism, numbers, angles)
            whole = {path: np.broadcast_to(x, size).astype(np.float64) for path, x in placed.items()}
            numbers = dimensions_of(mechanism, {**varied, **whole}, ARRAYS)
        upright = numbers.mapped(lambda x: x if isinstance(x, float) else np.asarray(x)[:, None])
        kinematics = replace(self.prepared.kinematics, numbers=upright)
        signs = signs_at_start(self.prepared, kinematics, angles, len(changes))
        return Batch(kinematics, signs, len(changes))

    def _turns(self, path: str) -> bool:
        return any(one.path == path and one.is_initial_angle for one in self.varying)

    def mechanism(self, change: Array) -> Mechanism:
        """The description of one candidate at scaled changes (p,)."""
        found = self.prepared.mechanism
        for one, value in zip(self.varying, self.values(change[None, :])[0], strict=True):
            found = with_value(found, one.path, float(value))
        if places_anew(found):
            return replace_placed(found)
        return _assembled_as(self.prepared, found, self.batch(change[None, :]))


def placed_numbers(
    mechanism: Mechanism, numbers: Dimensions, angles: Mapping[str, Number]
) -> dict[str, Number]:
    """Coordinates by path of all that is placed, as the chain of initial angles puts it, over arrays."""
    fixed = {n: at for n, at in mechanism.frame.points.items() if not isinstance(at, Placed)}
    points: dict[str, Vector] = {name: numbers.frame[name] for name in fixed}
    poses: dict[str, tuple[Vector, Vector]] = {FRAME: ((0.0, 0.0), (1.0, 0.0))}
    waiting = list(mechanism.links)
    while waiting:
        posed = [name for name in waiting if _pose(mechanism, numbers, angles, name, points, poses)]
        if not posed:
            break
        waiting = [name for name in waiting if name not in posed]
    found: dict[str, Number] = {}
    for name, at in mechanism.frame.points.items():
        if isinstance(at, Placed):
            found |= {f"frame.points.{name}.{axis}": x for axis, x in zip("xy", points[name], strict=True)}
    for guide in mechanism.guides:
        if isinstance(guide.through, Placed):
            origin, rotor = poses[guide.on]
            inside = turned(subtract(points[guide.point], origin), reversed_rotor(rotor))
            found |= {f"guides.{guide.id}.through.{axis}": x for axis, x in zip("xy", inside, strict=True)}
    return found


def _pose(
    mechanism: Mechanism,
    numbers: Dimensions,
    angles: Mapping[str, Number],
    name: str,
    points: dict[str, Vector],
    poses: dict[str, tuple[Vector, Vector]],
) -> bool:
    """Pose a link that has an initial angle and a known point, and with it all its points."""
    local = numbers.local[name]
    angle = angles[name] if name in angles else mechanism.initial_angle(name)
    known = next((point for point in local if point in points), None)
    if angle is None or known is None:
        return False
    rotor = rotor_of(ARRAYS, angle)
    origin = subtract(points[known], turned(local[known], rotor))
    poses[name] = origin, rotor
    for point, coordinates in local.items():
        points.setdefault(point, add(origin, turned(coordinates, rotor)))
    return True


def signs_at_start(
    prepared: Ready, kinematics: Kinematics, angles: Mapping[str, Number], size: int
) -> dict[int, Array]:
    """Signs (size, 1) of all groups in the initial positions: stated, by initial angles, or those of the original."""
    mechanism = prepared.mechanism
    placed = places_anew(mechanism)
    signs: dict[int, Array] = {}
    at = kinematics.frame(ARRAYS, np.full((1, 1), kinematics.path.initial))
    with np.errstate(all="ignore"):
        for index, group in enumerate(kinematics.structure.groups):
            if group.signed:
                own = np.full((size, 1), prepared.assembled.signs[index])
                decided = not placed or stated_side(kinematics, group) is not None
                hints = {} if decided else _hints(mechanism, group, angles)
                signs[index] = _nearer(kinematics, group, index, at, hints) if hints else own
            choices = SideChoices(FixedSigns(ARRAYS, signs), index)
            solve_group(group, ARRAYS, kinematics.numbers, at, choices)
    return {index: np.broadcast_to(sign, (size, 1)) for index, sign in signs.items()}


def _hints(mechanism: Mechanism, group: Group, angles: Mapping[str, Number]) -> dict[str, Number]:
    found: dict[str, Number] = {}
    for link in links_of(group):
        angle = mechanism.links[link].angle
        if link in angles:
            found[link] = np.asarray(angles[link])[:, None]
        elif angle is not None:
            found[link] = angle
    return found


def _nearer(
    kinematics: Kinematics, group: Group, index: int, at: Positions, hints: Mapping[str, Number]
) -> Array:
    """The sign whose angles are nearer to the hints."""
    off = []
    for sign in (1.0, -1.0):
        trial = at.copied()
        solve_group(
            group, ARRAYS, kinematics.numbers, trial, SideChoices(_Clamped(ARRAYS, {index: sign}), index)
        )
        total: Number = 0.0
        for link, hint in hints.items():
            cosine, sine = trial.poses[link].rotor
            total = total - (cosine * np.cos(hint) + sine * np.sin(hint))
        off.append(total)
    return np.asarray(np.where(off[0] <= off[1], 1.0, -1.0))


class _Clamped(FixedSigns):
    """A group that falls short of closing by rounding closes flat."""

    def root(self, group: int, radicand: Number) -> Number:
        return super().root(group, np.maximum(radicand, 0.0))


def _assembled_as(prepared: Ready, mechanism: Mechanism, batch: Batch) -> Mechanism:
    """The description with its assembly said by sides, and initial angles as they are with the new dimensions."""
    groups = [group for group in prepared.structure.groups if group.signed]
    space = batch.kinematics.numbers.space
    sides: dict[str, Any] = dict(mechanism.assembly.sides)
    for index, group in enumerate(prepared.structure.groups):
        if group.signed and not any(name in sides for name in side_names(group)):
            sides[side_names(group)[0]] = side_words(space, group)[
                0 if prepared.assembled.signs[index] > 0 else 1
            ]
    assembly = mechanism.assembly.model_copy(update={"sides": FrozenMap(sides)})
    found = mechanism.model_copy(update={"assembly": assembly})
    at = _positions(batch)
    guided = {guide.link for guide in mechanism.guides} | {guide.on for guide in mechanism.guides}
    driven = {drive.link for drive in mechanism.drives}
    for link in _links_with_angles(mechanism, groups):
        if link not in guided and link not in driven and mechanism.space == "plane":
            cosine, sine = (float(np.reshape(x, -1)[0]) for x in at.poses[link].rotor)
            found = with_value(found, f"links.{link}.angle", float(np.arctan2(sine, cosine)))
    return found


def _positions(batch: Batch) -> Positions:
    kinematics = batch.kinematics
    with np.errstate(all="ignore"):
        return kinematics.positions(
            ARRAYS, np.full((1, 1), kinematics.path.initial), FixedSigns(ARRAYS, batch.signs)
        )


def _links_with_angles(mechanism: Mechanism, groups: Sequence[Group]) -> list[str]:
    names = dict.fromkeys(link for group in groups for link in links_of(group))
    return [name for name in names if mechanism.links[name].angle is not None]
