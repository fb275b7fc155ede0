"""Mechanisms for tests, and what tests ask of motions: copies moved about, columns by name, how far digits reach."""

from __future__ import annotations

import copy
import math
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr
from tools.campaigns.columns import EPS as EPS
from tools.campaigns.columns import link as link
from tools.campaigns.columns import point as point
from tools.campaigns.columns import slide as slide

import centrode as ct
from centrode.kinematics.path import JETS
from centrode.kinematics.plan_evaluation import FixedSigns, Kinematics
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import Solved, requested_grid, solve
from centrode.numerics.jets import Jet
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Parts: TypeAlias = dict[str, Any]

WORDS_MIRRORED = {"left": "right", "right": "left", "ahead": "ahead", "behind": "behind"}


def parts_of(mechanism: ct.Mechanism) -> Parts:
    """The description as a file's tables, all numbers SI, placed points at their places."""
    parts = tomllib.loads(ct.mechanism_text(mechanism))
    points = parts.get("frame", {}).get("points", {})
    for name, at in points.items():
        points[name] = at["placed"] if isinstance(at, dict) else at
    for guide in parts.get("guides", []):
        if isinstance(guide.get("through"), dict):
            guide["through"] = guide["through"]["placed"]
    return parts


def four_bar(a: float, b: float, c: float, d: float, **more: Any) -> ct.Mechanism:
    """Four-bar linkage O-A-B-D with links OA, AB, DB, driven at OA."""
    parts: Parts = {
        "frame": {"points": {"O": [0.0, 0.0], "D": [d, 0.0]}},
        "links": {"OA": {"length": a}, "AB": {"length": b}, "DB": {"length": c}},
        "drives": [{"link": "OA", "start": 1.0, "speed": 1.0}],
        "assembly": {"sides": {"B": "left"}},
    }
    return ct.Mechanism(**{**parts, **more})


def moved(
    parts: Parts,
    turn: float = 0.0,
    shift: tuple[float, float] = (0.0, 0.0),
    scale: float = 1.0,
    mirrored: bool = False,
) -> Parts:
    """A copy of a description scaled, mirrored in the x axis, turned [rad] and shifted, in this order."""
    sense = -1.0 if mirrored else 1.0
    new = copy.deepcopy(parts)

    def local(v: list[float]) -> list[float]:
        return [scale * v[0], sense * scale * v[1]]

    def fixed(v: list[float]) -> list[float]:
        x, y = local(v)
        c, s = math.cos(turn), math.sin(turn)
        return [c * x - s * y + shift[0], s * x + c * y + shift[1]]

    frame = new.get("frame", {}).get("points", {})
    for name, at in frame.items():
        frame[name] = fixed(at)
    for body in new["links"].values():
        _move_link(body, local, sense, scale, turn)
    for guide in new.get("guides", []):
        on_frame = guide.get("on", "frame") == "frame"
        if not isinstance(guide["through"], str):
            guide["through"] = (fixed if on_frame else local)(guide["through"])
        guide["direction"] = sense * _angle(guide["direction"]) + (turn if on_frame else 0.0)
        if "angle" in guide:
            guide["angle"] = sense * guide["angle"] + (turn if on_frame else 0.0)
    for wheel in new.get("rolling", []):
        _move_wheel(wheel, fixed if wheel.get("on", "frame") == "frame" else local, scale, mirrored, turn)
    for drive in new["drives"]:
        angular = "link" in drive
        factor = sense if angular else scale
        for key in ("start", "speed"):
            if key in drive:
                drive[key] *= factor
        if angular and drive.get("relative_to", "frame") == "frame" and "start" in drive:
            drive["start"] += turn
    sides = new.get("assembly", {}).get("sides", {})
    if mirrored:
        for name, word in sides.items():
            sides[name] = WORDS_MIRRORED[word]
    new.pop("study", None)
    return new


def _move_wheel(wheel: Parts, place: Any, scale: float, mirrored: bool, turn: float) -> None:
    """What is on the left of a line is on the right of its image, so its direction is turned round."""
    track = wheel["along"]
    wheel["radius"] *= scale
    for key in ("through", "centre"):
        if isinstance(track.get(key), list):
            track[key] = place(track[key])
    if "radius" in track:
        track["radius"] *= scale
    if "direction" in track:
        angle = _angle(track["direction"])
        on_frame = wheel.get("on", "frame") == "frame"
        track["direction"] = (math.pi - angle if mirrored else angle) + (turn if on_frame else 0.0)


def _move_link(link: Parts, local: Any, sense: float, scale: float, turn: float) -> None:
    if "length" in link:
        link["length"] *= scale
    if isinstance(link.get("points"), dict):
        link["points"] = {name: local(v) for name, v in link["points"].items()}
    if "angle" in link:
        link["angle"] = sense * link["angle"] + turn
    for key in ("mass", "centre", "inertia", "shape"):
        link.pop(key, None)


def _angle(direction: float | list[float]) -> float:
    return math.atan2(direction[1], direction[0]) if isinstance(direction, list) else direction


def statuses(data: xr.Dataset) -> list[str]:
    """The statuses in words."""
    return [ct.Status(code).word for code in data["status"].to_numpy()]


def events(data: xr.Dataset, kind: str) -> list[float]:
    """Places of the events of a kind, each once."""
    code = ("limit", "change point").index(kind)
    values = data["event_value"].to_numpy()[data["event_kind"].to_numpy() == code]
    return list(dict.fromkeys(values.tolist()))


def solved_at(mechanism: ct.Mechanism, values: npt.ArrayLike) -> list[Solved]:
    """The motion at given values of the drive, one by one: a result belongs to its value alone."""
    prepared = ready(mechanism)
    return [solve_evenly(prepared, 1, float(q), float(q)) for q in np.atleast_1d(np.asarray(values))]


STEP = 2.0**-30
"""Relative change of the dimensions by which the condition of a motion is measured: its square is lost in rounding."""
OPERATIONS = 8.0
"""Rounding errors of a motion in units of those that rounded dimensions alone would make."""


def conditioning(solved: Solved, tries: int = 8) -> Array:
    """How much a motion answers to its dimensions: (3, samples), for value, first and second derivative.

    Every length is changed at random by up to `STEP` of the greatest one, directions and the drive likewise; the
    greatest answer of any place (in the greatest length) or rotor is divided by `STEP`. The branch stays that of
    the motion.
    """
    kinematics, unit = solved.ready.kinematics, solved.ready.kinematics.path.unit
    random = np.random.default_rng(7)
    parameter = solved.span.parameter
    exact = closed_forms(solved, kinematics, parameter)
    answer = np.zeros((3, len(parameter)))
    for _ in range(tries):
        changed = replace(kinematics, numbers=nudged(kinematics.numbers, random))
        step = STEP * random.choice([-1.0, 1.0]) * np.maximum(np.abs(parameter), unit)
        change = np.abs(closed_forms(solved, changed, parameter + step) - exact) / STEP
        answer = np.maximum(answer, np.max(change, axis=1))
    return np.asarray(np.maximum(answer * unit ** np.arange(3)[:, None], 1.0))


def closed_forms(solved: Solved, kinematics: Kinematics, parameter: Array) -> Array:
    """Places in the greatest length and attitudes, by the closed forms with the signs of a motion: (3, columns, n)."""

    with np.errstate(all="ignore"):
        at = kinematics.positions(JETS, Jet.variable(parameter, 2), on_branch(solved, parameter))
    scale = float(kinematics.numbers.scale)
    columns = [x / scale for name in solved.layout.points for x in at.points[name]]
    columns += [x for name in solved.layout.links for x in solved.layout.space.attitude(at.poses[name])]
    jets = [x if isinstance(x, Jet) else Jet((x, 0.0, 0.0)) for x in columns]
    shape = parameter.shape
    return np.array([[np.broadcast_to(x.derivative(k), shape) for x in jets] for k in range(3)])


def on_branch(solved: Solved, parameter: Array) -> FixedSigns:
    """Signs and turns of a motion at parameters, for its closed forms over jets."""
    signs = {group: solved.branches.sign(group, parameter[None, :])[0] for group in solved.branches.signs}
    first_lane = np.zeros(parameter.shape, dtype=np.intp)

    def continued(key: str, angle: Any) -> Any:
        return solved.branches.turns[key].continue_angle(angle, parameter, first_lane)

    return FixedSigns(JETS, signs, continued)


def nudged(numbers: Dimensions, random: np.random.Generator) -> Dimensions:
    """The same dimensions, each number changed by up to `STEP` of the greatest length; directions by that angle."""
    length = numbers.map_numbers(lambda x: x + STEP * numbers.scale * random.uniform(-1.0, 1.0))

    def turned(rotors: Mapping[str, Any]) -> dict[str, Any]:
        found = {}
        for name, (c, s) in rotors.items():
            small = STEP * random.uniform(-1.0, 1.0)
            found[name] = (c - s * small, s + c * small)
        return found

    if numbers.space.unit == "rad":
        return length  # its numbers are angles already

    def small() -> float:
        return STEP * float(random.uniform(-1.0, 1.0))

    own = numbers.gearing
    gearing = replace(
        own.scale_lengths(lambda x: x + small() * numbers.scale),
        ratio={name: x * (1.0 + small()) for name, x in own.ratio.items()},
        phase={name: x + small() for name, x in own.phase.items()},
    )
    return replace(length, direction=turned(numbers.direction), turn=turned(numbers.turn), gearing=gearing)


def rounding(solved: Solved) -> Array:
    """What rounding may do to a motion (3, samples), in the greatest length, rad and the path's unit."""
    return np.asarray(OPERATIONS * EPS * conditioning(solved))


def solve_evenly(
    prepared: Ready, samples: int, start: float | None = None, stop: float | None = None
) -> Solved:
    """Motion at evenly spaced samples, as plain arrays."""
    return solve(prepared, requested_grid(prepared, samples, start, stop))
