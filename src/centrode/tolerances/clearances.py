"""Play in joints: how far an output may deviate because pins are smaller than their holes.

Virtual work: if the pin of a joint moves by a vector d against its hole, an output u moves by R d, with R the joint's
reaction to a unit load along u (of the drive held, of all other joints tight). So the greatest deviation is the sum
over pins of play times |R|, and over guides play times |N|, or with a slider of the length l that tilts play times
max(|N|, 2 |M| / l). R is computed as the derivative of u by the place of the hinge on its link. True extremes follow by
turning every play to where the output is greatest. Joints are at rest: which side a pin takes is a matter of forces,
and how it gets there one of contact dynamics, which this is not.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

from centrode.dynamics.kinetostatics.reactions import reactions
from centrode.dynamics.masses import has_masses_or_loads
from centrode.errors import CentrodeError, InputError
from centrode.kinematics.motion import motion
from centrode.kinematics.preparation import Ready, ready
from centrode.locale import _
from centrode.model.files import document, mechanism_from
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.reading import value_text
from centrode.tolerances.joint_play import JointPlay
from centrode.tolerances.sensitivity import differentiated_solver
from centrode.tolerances.spherical_play import (
    displaced_place,
    hole_slopes,
    sides_in_links,
    with_free_holes,
)

Array: TypeAlias = npt.NDArray[np.float64]

POLE = 1e-6
"""Cosine of a latitude below which longitudes lose half of their digits."""
_FOLDED = re.compile(r"(range|max|min)\((\w+)\)")


@dataclass(frozen=True)
class ClearanceExtent:
    """How far an output deviates by play.

    Attributes
    ----------
    joints : in the order of the description
    shares : (joints,) or (samples, joints) what each joint adds to the greatest deviation [SI]
    first_order : greatest deviation to each side to first order [SI], one number or (samples,)
    lower, upper : true extremes at the worst sample [SI]; NaN of an output that is one number
    by_force : (samples,) deviation if every pin takes the side that its joint force presses it to [SI]; None without
        masses and loads, and of an output that is one number
    """

    joints: tuple[JointPlay, ...]
    shares: Array
    first_order: Array
    lower: float
    upper: float
    by_force: Array | None


def with_free_joints(mechanism: Mechanism, joints: Sequence[JointPlay]) -> Mechanism:
    """The same mechanism, in which the places of these hinges and lines are numbers of their own."""
    if mechanism.space == "sphere":
        return with_free_holes(mechanism, joints)
    tables = document(mechanism)
    tables.pop("tolerances", None)
    for joint in joints:
        if not joint.point:
            guide = mechanism.guide(joint.name)
            table = tables["guides"][[one.id for one in mechanism.guides].index(joint.name)]
            table["through"], table["direction"] = list(mechanism.through(guide)), list(guide.unit)
            if guide.link is not None:
                table["angle"] = mechanism.guide_turn(guide)
            if guide.link is None or joint.length is None:
                continue
        body = joint.body if joint.point else str(mechanism.guide(joint.name).link)
        link = tables["links"][body]
        if "length" in link:
            del link["length"]
        link["points"] = {name: list(place) for name, place in mechanism.links[body].coordinates.items()}
    return mechanism_from(tables)


@dataclass(frozen=True)
class _Moves:
    """How outputs move by play, in the axes of the frame; on the sphere east and north on the link.

    Attributes
    ----------
    by_place : joint -> (samples, 2) derivatives of an output by the place of the hinge, or of the line
    tilting : guide -> (samples,) derivative by the tilt of its slider [SI per rad]
    """

    by_place: Mapping[str, Array]
    tilting: Mapping[str, Array]


def clearance_extents(
    prepared: Ready, texts: Mapping[str, str], joints: Sequence[JointPlay], samples: int | None = None
) -> dict[str, ClearanceExtent]:
    """Deviations of outputs by play; outputs that fold samples otherwise than by range, max or min are left out.

    Raises InputError on the sphere for a hole at a pole of its link, and for outputs of forces and masses.
    """
    mechanism = prepared.mechanism
    if mechanism.space == "sphere":
        _check_on_sphere(mechanism, joints, texts)
    sampled: dict[str, str] = {}
    folded: dict[str, tuple[str, str]] = {}
    for name, text in texts.items():
        match = _FOLDED.fullmatch(text.replace(" ", ""))
        if match:
            folded[name] = match[1], match[2]
            sampled[f"of {name}"] = match[2]
        else:
            sampled[name] = text
    free = ready(with_free_joints(mechanism, joints))
    paths = _paths(mechanism, joints)
    moving = differentiated_solver(free, paths, sampled, samples=samples)
    slopes, values = (
        moving.split(moving.gradient(list(moving.own))),
        moving.split(moving.outputs(list(moving.own))),
    )
    frame = moving.move(list(moving.own))
    rotors = {body: np.ones(len(moving.parameter), dtype=complex) for body in (FRAME, *mechanism.links)}
    if mechanism.space == "plane":
        # on the sphere what presses a pin is said in the axes of the link, so nothing is turned
        for number, link in enumerate(mechanism.links):
            rotors[link] = np.exp(1j * np.asarray(frame["angle"][:, number]))
    sides = pressed_sides(mechanism, joints, samples)
    found: dict[str, ClearanceExtent] = {}
    bands: dict[str, tuple[Array, Array]] = {}
    for (name, text), column in zip(sampled.items(), moving.columns, strict=True):
        if not column.of_samples:
            continue
        moves = _moves(mechanism, joints, paths, slopes[column.name], rotors)
        shares = np.stack([_share(joint, moves) for joint in joints], axis=-1)
        whole = shares.sum(axis=-1)
        bands[name] = values[column.name], whole
        by_force = None if sides is None else _by_force(joints, moves, sides)
        worst = int(np.nanargmax(whole)) if np.isfinite(whole).any() else 0
        lower = upper = float("nan")
        if name in texts and np.isfinite(whole).any():
            at = float(moving.parameter[worst])
            lower, upper = true_extremes(free, paths, text, joints, moves, rotors, at, worst)
        found[name] = ClearanceExtent(tuple(joints), shares, whole, lower, upper, by_force)
    for name, (fold, _text) in folded.items():
        inner = f"of {name}"
        if inner in bands:
            found[name] = _of_fold(fold, *bands[inner], found.pop(inner))
    return {name: extent for name, extent in found.items() if name in texts}


def _of_fold(fold: str, values: Array, band: Array, extent: ClearanceExtent) -> ClearanceExtent:
    """Of the extremes of an output: at each of them the joints lie as it is worst there."""
    least, greatest = int(np.nanargmin(values)), int(np.nanargmax(values))
    rows = {"min": [least], "max": [greatest], "range": [least, greatest]}[fold]
    shares = extent.shares[rows].sum(axis=0)
    nan = float("nan")
    return ClearanceExtent(extent.joints, shares, np.asarray(shares.sum()), nan, nan, None)


FORCES = ("joint_force", "joint_moment", "guide_force", "guide_normal", "balancing", "reduced", "frame_force")


def _check_on_sphere(mechanism: Mechanism, joints: Sequence[JointPlay], texts: Mapping[str, str]) -> None:
    where = "[tolerances.clearances]"
    if mechanism.guides:
        what = _(
            "on the sphere play is computed of linkages without guides: circles that close have no derivatives"
        )
        raise InputError(where, what, _("remove it"))
    for joint in joints:
        latitude = mechanism.links[joint.body].coordinates[joint.point][1]
        if abs(math.cos(latitude)) < POLE:
            what = _("{name}: the hole lies at a pole of its link, where longitude has no direction")
            raise InputError(where, what.format(name=value_text(joint.name)), _("turn the axes of the link"))
    for text in texts.values():
        if any(word in text for word in FORCES):
            what = _("on the sphere play moves positions, and not {name}").format(name=value_text(text))
            raise InputError(where, what, _("remove it, or this output"))


def place_paths(mechanism: Mechanism, joint: JointPlay) -> tuple[str, ...]:
    """Paths of the two numbers that say where a hole or a line is."""
    place = f"links.{joint.body}.points.{joint.point}" if joint.point else f"guides.{joint.name}.through"
    first, second = ("x", "y") if mechanism.space == "plane" else ("longitude", "latitude")
    return f"{place}.{first}", f"{place}.{second}"


def _paths(mechanism: Mechanism, joints: Sequence[JointPlay]) -> list[str]:
    paths: list[str] = []
    for joint in joints:
        paths += [path for path in place_paths(mechanism, joint) if path not in paths]
        for turned in turned_places(mechanism, joint):
            paths += [path for path in (turned.x_path, turned.y_path) if path not in paths]
    return paths


@dataclass(frozen=True)
class TurnedPlace:
    """A place of a slider that turns with it about the point in its guide: paths and arm [m]."""

    x_path: str
    y_path: str
    x: float
    y: float


def turned_places(mechanism: Mechanism, joint: JointPlay) -> list[TurnedPlace]:
    """Places that move where a slider tilts: its points but that in the guide."""
    guide = mechanism.guide(joint.name) if joint.length is not None else None
    if guide is None or guide.link is None:
        return []
    points = mechanism.links[guide.link].coordinates
    x0, y0 = points[guide.point]
    found = []
    for point, (x, y) in points.items():
        if point != guide.point:
            place = f"links.{guide.link}.points.{point}"
            found.append(TurnedPlace(f"{place}.x", f"{place}.y", x - x0, y - y0))
    return found


def _moves(
    mechanism: Mechanism,
    joints: Sequence[JointPlay],
    paths: Sequence[str],
    slopes: Array,
    rotors: Mapping[str, npt.NDArray[np.complex128]],
) -> _Moves:
    by_place, tilting = {}, {}
    for joint in joints:
        first = paths.index(place_paths(mechanism, joint)[0])
        if mechanism.space == "sphere":
            place = mechanism.links[joint.body].coordinates[joint.point]
            by_place[joint.name] = hole_slopes(slopes[:, first : first + 2], place)
            continue
        # a derivative is a row: in the frame's axes it turns as the vector of its two numbers
        local = slopes[:, first] + 1j * slopes[:, first + 1]
        turned = local * rotors[joint.body]
        if not joint.point:
            normal = 1j * complex(*mechanism.guide(joint.name).unit) * rotors[joint.body]
            across = (turned * normal.conj()).real
            turned = across * normal
            if joint.length is not None:
                tilting[joint.name] = sum(
                    (
                        one.x * slopes[:, paths.index(one.y_path)]
                        - one.y * slopes[:, paths.index(one.x_path)]
                        for one in turned_places(mechanism, joint)
                    ),
                    np.zeros(len(slopes)),
                )
        by_place[joint.name] = np.stack([turned.real, turned.imag], axis=-1)
    return _Moves(by_place, tilting)


def _share(joint: JointPlay, moves: _Moves) -> Array:
    """What a joint adds at most: play times the size of its reaction to a unit load."""
    reaction = np.hypot(*moves.by_place[joint.name].T)
    if joint.length is None:
        return np.asarray(joint.play * reaction)
    return np.asarray(
        joint.play * np.maximum(reaction, 2.0 * np.abs(moves.tilting[joint.name]) / joint.length)
    )


def pressed_sides(
    mechanism: Mechanism, joints: Sequence[JointPlay], samples: int | None
) -> dict[str, Array] | None:
    """Unit vectors (samples, 2) from the middle of each joint to the side that its force presses the pin, or slider,
    to.

    On the sphere in the axes of the link. NaN where there is no force; None where no masses and loads are known, or
    reactions are not determined.
    """
    if not has_masses_or_loads(mechanism):
        return None
    try:
        found = reactions(mechanism, samples)
    except CentrodeError:
        return None
    if mechanism.space == "sphere":
        return sides_in_links(mechanism, joints, found, motion(mechanism, samples))
    sides = {}
    for joint in joints:
        if joint.point:
            # the pin pushes the link to where it lies in the hole
            force = found["joint_force"].sel(side=joint.name).to_numpy()
        else:
            force = -found["guide_force"].sel(guide=joint.name).to_numpy()
        size = np.hypot(*force.T)
        with np.errstate(invalid="ignore", divide="ignore"):
            sides[joint.name] = force / size[:, None]
    return sides


def _by_force(joints: Sequence[JointPlay], moves: _Moves, sides: Mapping[str, Array]) -> Array:
    parts = [
        joint.play * np.nansum(moves.by_place[joint.name] * sides[joint.name], axis=-1) for joint in joints
    ]
    return np.asarray(np.sum(parts, axis=0))


def true_extremes(
    free: Ready,
    paths: Sequence[str],
    text: str,
    joints: Sequence[JointPlay],
    moves: _Moves,
    rotors: Mapping[str, npt.NDArray[np.complex128]],
    at: float,
    sample: int,
) -> tuple[float, float]:
    """Least and greatest deviation of an output at one place of the drive [SI], with pins turned to the extremes."""
    there = differentiated_solver(free, paths, {"output": text}, at=[at])
    own = np.array(there.own)
    nominal = float(np.ravel(there.outputs(list(own)))[0])
    place = PinPlaces(free.mechanism, tuple(joints), tuple(paths))
    ends = []
    for sense in (-1.0, 1.0):
        start = place.start(moves, rotors, sense, sample)

        def loss(unknowns: Array, unit: float = 1.0, sense: float = sense) -> tuple[float, Array]:
            values, slopes = place.values(unknowns)
            output = float(np.ravel(there.outputs(list(own + values)))[0]) - nominal
            gradient = np.ravel(there.gradient(list(own + values))) @ slopes
            if not np.isfinite(output) or not np.isfinite(gradient).all():
                return np.inf, np.zeros_like(unknowns)
            return -sense * output / unit, -sense * gradient / unit

        unit = abs(loss(start)[0]) or 1.0
        found = minimize(
            loss, start, (unit,), jac=True, method="L-BFGS-B", bounds=place.bounds, options={"ftol": 1e-14}
        )
        ends.append(-sense * float(found.fun) * unit)
    return ends[0], ends[1]


@dataclass(frozen=True)
class PinPlaces:
    """Where pins lie in their holes: an angle each, on the rim; sliders by how far both of their ends are off."""

    mechanism: Mechanism
    joints: tuple[JointPlay, ...]
    paths: tuple[str, ...]

    @property
    def bounds(self) -> list[tuple[float | None, float | None]]:
        """Of the unknowns: angles have none, ends of sliders lie between -1 and 1 of their play."""
        found: list[tuple[float | None, float | None]] = []
        for joint in self.joints:
            found += [(None, None)] if joint.point else [(-1.0, 1.0)] * (2 if joint.length is not None else 1)
        return found

    def values(self, unknowns: Array) -> tuple[Array, Array]:
        """Deviations of the free numbers, and their derivatives by the unknowns."""
        values = np.zeros(len(self.paths))
        slopes = np.zeros((len(self.paths), len(unknowns)))
        number = 0
        for joint in self.joints:
            if joint.point:
                row = self.paths.index(place_paths(self.mechanism, joint)[0])
                angle = unknowns[number]
                if self.mechanism.space == "sphere":
                    place = self.mechanism.links[joint.body].coordinates[joint.point]
                    values[row : row + 2], slopes[row : row + 2, number] = displaced_place(
                        place, joint.play, float(angle)
                    )
                    number += 1
                    continue
                values[row : row + 2] += joint.play * np.array([np.cos(angle), np.sin(angle)])
                slopes[row : row + 2, number] += joint.play * np.array([-np.sin(angle), np.cos(angle)])
                number += 1
                continue
            row = self.paths.index(place_paths(self.mechanism, joint)[0])
            guide = self.mechanism.guide(joint.name)
            normal = np.array([-guide.unit[1], guide.unit[0]])
            count = 1 if joint.length is None else 2
            ends = unknowns[number : number + count]
            values[row : row + 2] += joint.play * ends.mean() * normal
            slopes[row : row + 2, number : number + count] += joint.play * normal[:, None] / count
            if joint.length is not None:
                by_ends = joint.play / joint.length * np.array([-1.0, 1.0])
                tilt = float(by_ends @ ends)
                cosine, sine = np.cos(tilt), np.sin(tilt)
                for one in turned_places(self.mechanism, joint):
                    x, y = self.paths.index(one.x_path), self.paths.index(one.y_path)
                    values[x] += one.x * (cosine - 1.0) - one.y * sine
                    values[y] += one.x * sine + one.y * (cosine - 1.0)
                    slopes[x, number : number + count] += (-one.x * sine - one.y * cosine) * by_ends
                    slopes[y, number : number + count] += (one.x * cosine - one.y * sine) * by_ends
            number += count
        return values, slopes

    def start(
        self,
        moves: _Moves,
        rotors: Mapping[str, npt.NDArray[np.complex128]],
        sense: float,
        sample: int,
    ) -> Array:
        """The unknowns at the first-order extreme."""
        found: list[float] = []
        for joint in self.joints:
            wanted = complex(*(sense * moves.by_place[joint.name][sample]))
            local = wanted / complex(rotors[joint.body][sample])
            if joint.point:
                found.append(float(np.angle(local)))
                continue
            normal = 1j * complex(*self.mechanism.guide(joint.name).unit)
            across = float(np.sign((local * normal.conjugate()).real)) or 1.0
            if joint.length is None:
                found.append(across)
                continue
            reaction = abs(wanted)
            tilt = sense * float(moves.tilting[joint.name][sample])
            tilts = 2.0 * abs(tilt) / joint.length > reaction
            found += [-float(np.sign(tilt)), float(np.sign(tilt))] if tilts else [across, across]
        return np.array(found)
