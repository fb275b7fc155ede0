"""Motions made from closed forms with NumPy: what presentations read, without what computes it."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pytest
import xarray
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.errors import Status
from centrode.model.files import parse_mechanism
from centrode.model.mechanism import Mechanism
from centrode.quantities import QUANTITIES
from shown_motion import motion_figures

Array = NDArray[np.float64]
Made = tuple[Mechanism, xarray.Dataset]
Gallery = tuple[Mechanism, xarray.Dataset, Mapping[str, Figure]]

PRESS = """
title = "Six-bar press"
display = { length = "mm", angle = "deg" }
[frame.points]
O = [0, 0]
C = [1.25, 0]
[links.OA]
length = 0.347
[links.AB]
points = { A = [0, 0], B = [1.445, 0], S2 = [0.7225, 0] }
[links.rocker]
points = { C = [0, 0], B = [0.85, 0], D = [1.7, 0] }
[links.DH]
points = { D = [0, 0], H = [1.7, 0], S4 = [0.85, 0] }
[links.block]
points = { H = [0, 0] }
[[guides]]
point = "H"
on = "frame"
through = [0, 0.9]
direction = [1, 0]
link = "block"
[[drives]]
link = "OA"
start = "120 deg"
speed = "-1 rad/s"
[assembly]
sides = { B = "right", H = "right" }
"""

WORKED = """
title = "Crank, two couplers, slider and rocker"
[frame.points]
O = [0, 0]
D = [D_PLACE]
[links.OA]
length = 0.5
angle = 0
[links.AC]
length = 1.0
angle = 0.5
[links.CB]
length = 1.2
angle = ANGLE_3
[links.BD]
length = 0.8
angle = ANGLE_4
[[guides]]
point = "C"
on = "frame"
through = [0, 0.479425538604203]
direction = [1, 0]
[[drives]]
link = "OA"
start = 0
speed = 1
"""

SLOT = """
title = "Кулисный механизм ($A$ в пазу)"
display = { length = "mm", angle = "deg" }
[frame.points]
O = [0, 0]
C = [0, -1]
[links.OA]
length = 0.4
[links."кулиса"]
points = { C = [0, 0], "Б’" = [2, 0] }
[[guides]]
point = "A"
on = "кулиса"
through = "C"
direction = [1, 0]
[[drives]]
link = "OA"
start = 0
law = "0.5*sin(2*t)"
"""

JANSEN = """
title = "Theo Jansen's leg"
[frame.points]
O = [0, 0]
Z = [-38, -7.8]
[links]
OA = { length = 15 }
AB = { length = 50 }
ZB = { length = 41.5 }
BC = { length = 55.8 }
ZC = { length = 40.1 }
AE = { length = 61.9 }
ZE = { length = 39.3 }
CF = { length = 39.4 }
EF = { length = 36.7 }
FG = { length = 65.7 }
EG = { length = 49 }
ZG1 = { points = { Z = [0, 0], Q = [5, 0], P = [5, 8] } }
[[drives]]
link = "OA"
start = 0
speed = 1
"""

FIVE_BAR = """
title = "Five-bar with two drives"
[frame.points]
O = [0, 0]
D = [2, 0]
[links]
OA = { length = 1 }
AB = { length = 2 }
BC = { length = 2 }
DC = { length = 1 }
[[drives]]
link = "OA"
start = 2
speed = 1
[[drives]]
link = "DC"
start = 1
speed = 2
"""


def circles(first: Array, r1: float, second: Array, r2: float, side: float) -> Array:
    """Where two circles meet, to the left (+1) or the right (-1) of the line from the first centre; else NaN."""
    along = second - first
    square = np.sum(along**2, axis=-1)
    share = (r1**2 - r2**2 + square) / (2 * square)
    with np.errstate(invalid="ignore"):
        height = side * np.sqrt(r1**2 / square - share**2)
    normal = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    return first + share[..., None] * along + height[..., None] * normal


def polar(length: float, angle: Array) -> Array:
    return length * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def direction(first: Array, second: Array) -> Array:
    turn = np.arctan2(second[..., 1] - first[..., 1], second[..., 0] - first[..., 0])
    known = np.isfinite(turn)
    turn[known] = np.unwrap(turn[known])
    return turn


def slope(values: Array, over: Array) -> Array:
    if over.size < 2:
        return np.zeros_like(values)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.gradient(values, over, axis=0))


@dataclass
class Course:
    """What a closed form gives: paths of points, turns of links, slides, statuses, events."""

    time: Array
    drive: Array
    points: Mapping[str, Array]
    turns: Mapping[str, Array]
    slides: Mapping[str, Array]
    status: NDArray[np.int8] | None = None
    events: tuple[tuple[float, int], ...] = ()


def dataset_of(mechanism: Mechanism, course: Course) -> xarray.Dataset:
    """The course as a result of motion; derivatives by differences, which is enough to be drawn."""
    n, single = course.time.size, course.drive.ndim == 1
    kinds = {
        "position": (("point", "axis"), ("velocity", "acceleration"), list(course.points.values())),
        "angle": (("link",), ("angular_velocity", "angular_acceleration"), list(course.turns.values())),
        "slide": (("guide",), ("slide_velocity", "slide_acceleration"), list(course.slides.values())),
    }
    variables = {}
    for name, (dims, derived, tracks) in kinds.items():
        value = np.stack(tracks, axis=1) if tracks else np.zeros((n, 0))
        for order, own in enumerate((name, *derived)):
            if order:
                value = slope(value, course.time)
            variables[own] = (("sample", *dims), value, attributes(own))
        value = np.stack(tracks, axis=1) if tracks else np.zeros((n, 0))
        for own in derived if single else ():
            value = slope(value, course.drive)
            variables[f"{own}_coefficient"] = (("sample", *dims), value, attributes(f"{own}_coefficient"))
    status = np.zeros(n, dtype=np.int8) if course.status is None else course.status
    flags = {
        "flag_values": np.arange(5, dtype=np.int8),
        "flag_meanings": "ok open cut_off singular unconverged",
    }
    variables["status"] = ("sample", status, flags)
    variables["residual"] = ("sample", np.full(n, 1.1e-16), attributes("residual"))
    variables["event_value"] = ("event", np.array([value for value, _kind in course.events]))
    variables["event_kind"] = ("event", np.array([kind for _value, kind in course.events], dtype=np.int8))
    variables["event_group"] = ("event", np.array(["A-B-C" for _event in course.events], dtype="U5"))
    coords = {
        "time": ("sample", course.time, attributes("time")),
        "drive_value": (("sample", "drive"), course.drive.reshape(n, -1), attributes("drive_value")),
        "point": list(course.points),
        "link": list(course.turns),
        "guide": np.array(list(course.slides), dtype="U10"),
        "drive": [drive.id for drive in mechanism.drives],
        "axis": ["x", "y"],
    }
    return xarray.Dataset(variables, coords, attrs={"title": mechanism.title, "worst_residual": 1.1e-16})


def attributes(name: str) -> dict[str, str]:
    quantity = QUANTITIES[name]
    return {"units": quantity.unit, "symbol": quantity.symbol, "long_name": quantity.long_name}


def press(samples: int = 361, scale: float = 1.0, text: str = PRESS) -> Made:
    mechanism = parse_mechanism(text, "press.toml")
    time = np.linspace(0.0, 2 * np.pi, samples)
    drive = np.radians(120.0) - time
    o, c = np.zeros((samples, 2)), np.tile([1.25, 0.0], (samples, 1))
    a = polar(0.347, drive)
    b = circles(a, 1.445, c, 0.85, 1.0)
    d = c + 2 * (b - c)
    h = np.stack([d[:, 0] + np.sqrt(1.7**2 - (0.9 - d[:, 1]) ** 2), np.full(samples, 0.9)], axis=1)
    points = {"O": o, "C": c, "A": a, "B": b, "S2": (a + b) / 2, "D": d, "H": h, "S4": (d + h) / 2}
    turns = {"OA": drive, "AB": direction(a, b), "rocker": direction(c, d), "DH": direction(d, h)}
    turns["block"] = np.zeros(samples)
    course = Course(time, drive, {k: scale * v for k, v in points.items()}, turns, {"H": scale * h[:, 0]})
    return mechanism, dataset_of(mechanism, course)


def worked(samples: int = 361, locked: bool = False, stop: float = 2 * np.pi) -> Made:
    third, fourth = (4.7, 5.7) if locked else (1.9, 3.5)
    a0, c0 = np.array([0.5, 0.0]), np.array([0.5 + np.cos(0.5), np.sin(0.5)])
    b0 = c0 + polar(1.2, np.array(third))
    place = b0 + polar(0.8, np.array(fourth))
    text = WORKED.replace("D_PLACE", ", ".join(map(repr, place.tolist())))
    mechanism = parse_mechanism(text.replace("ANGLE_3", str(third)).replace("ANGLE_4", str(fourth)), "worked")
    time = np.linspace(0.0, stop, samples)
    o, d = np.zeros((samples, 2)), np.tile(place, (samples, 1))
    a = polar(0.5, time) + 0 * a0
    c = np.stack([a[:, 0] + np.sqrt(1 - (c0[1] - a[:, 1]) ** 2), np.full(samples, c0[1])], axis=1)
    cross = (place - c0)[0] * (b0 - c0)[1] - (place - c0)[1] * (b0 - c0)[0]
    b = circles(c, 1.2, d, 0.8, float(np.sign(cross)))
    turns = {"OA": time.copy(), "AC": direction(a, c), "CB": direction(c, b), "BD": direction(b, d)}
    reaches = np.isfinite(b[:, 0])
    past = np.cumsum(~reaches) > 0
    status = np.select([~reaches, past], [Status.OPEN, Status.CUT_OFF], Status.OK).astype(np.int8)
    for track in (a, c):
        track[~reaches] = np.nan
    edges = np.flatnonzero(np.diff(reaches.astype(int)))
    events = tuple((float(time[k] + time[k + 1]) / 2, 0) for k in edges)
    points = {"O": o, "D": d, "A": a, "C": c, "B": b}
    slides = {"C": c[:, 0].copy()}
    return mechanism, dataset_of(mechanism, Course(time, time, points, turns, slides, status, events))


def slotted(samples: int = 181) -> Made:
    mechanism = parse_mechanism(SLOT, "slot.toml")
    time = np.linspace(0.0, np.pi, samples)
    drive = 0.5 * np.sin(2 * time)
    o, c = np.zeros((samples, 2)), np.tile([0.0, -1.0], (samples, 1))
    a = polar(0.4, drive)
    turn = direction(c, a)
    points = {"O": o, "C": c, "A": a, "Б’": c + polar(2.0, turn)}
    slides = {"A": np.hypot(*(a - c).T)}
    course = Course(time, drive, points, {"OA": drive, "кулиса": turn}, slides, None, ((0.25, 1),))
    return mechanism, dataset_of(mechanism, course)


def jansen(samples: int = 181) -> Made:
    mechanism = parse_mechanism(JANSEN, "jansen.toml")
    time = np.linspace(0.0, 2 * np.pi, samples)
    o, z = np.zeros((samples, 2)), np.tile([-38.0, -7.8], (samples, 1))
    a = polar(15.0, time)
    b = circles(a, 50.0, z, 41.5, -1.0)
    e = circles(a, 61.9, z, 39.3, 1.0)
    c = circles(z, 40.1, b, 55.8, 1.0)
    f = circles(e, 36.7, c, 39.4, -1.0)
    g = circles(e, 49.0, f, 65.7, 1.0)
    places = {"O": o, "Z": z, "A": a, "B": b, "E": e, "C": c, "F": f, "G": g}
    still = np.zeros(samples)
    turns = {n: direction(places[n[0]], places[n[1]]) for n in mechanism.link_names if len(n) == 2}
    turns["ZG1"] = still
    places |= {"Q": z + np.array([5.0, 0.0]), "P": z + np.array([5.0, 8.0])}
    return mechanism, dataset_of(mechanism, Course(time, time, places, turns, {}))


def five_bar(samples: int = 61) -> Made:
    mechanism = parse_mechanism(FIVE_BAR, "five.toml")
    time = np.linspace(0.0, 1.0, samples)
    first, second = 2.0 + time, 1.0 + 2.0 * time
    o, d = np.zeros((samples, 2)), np.tile([2.0, 0.0], (samples, 1))
    a, c = polar(1.0, first), d + polar(1.0, second)
    b = circles(a, 2.0, c, 2.0, 1.0)
    turns = {"OA": first, "AB": direction(a, b), "BC": direction(b, c), "DC": second}
    points = {"O": o, "D": d, "A": a, "B": b, "C": c}
    drive = np.stack([first, second], axis=1)
    return mechanism, dataset_of(mechanism, Course(time, drive, points, turns, {}))


MAKERS: Mapping[str, Callable[..., Made]] = {
    "press": press,
    "worked": worked,
    "slotted": slotted,
    "jansen": jansen,
    "five_bar": five_bar,
}


@functools.cache
def gallery_of(name: str, locked: bool) -> Gallery:
    mechanism, dataset = MAKERS[name](**({"locked": True} if locked else {}))
    return mechanism, dataset, motion_figures(mechanism, dataset)


@pytest.fixture
def gallery() -> Callable[..., Gallery]:
    """gallery("press"): a mechanism, its motion and its figures, made once for all tests that only look at them."""
    return lambda name, locked=False: gallery_of(name, locked)


@pytest.fixture
def make() -> Callable[..., Made]:
    """make("press", samples=1): a mechanism and its motion."""
    return lambda name, **options: MAKERS[name](**options)
