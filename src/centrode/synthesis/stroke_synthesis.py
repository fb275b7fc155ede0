"""Synthesis from strokes: from a request to answers, by the closed forms of `strokes`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from centrode.errors import InputError, MotionError, Status
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.synthesis.answers import (
    CHECKED_PLACES,
    Answer,
    Construction,
    Defects,
    SynthesisResults,
    box_around,
)
from centrode.synthesis.four_bars import Complex
from centrode.synthesis.requests import Synthesis, SynthesisTask
from centrode.synthesis.strokes import (
    EQUAL,
    CrankRocker,
    SlottedLever,
    crank_rockers,
    evenly,
    limit_angle,
    shaper,
    slider_crank,
    whitworth,
)

OFF_ROUND = 0.0123
PARTS, ROUNDS = 60, 7
"""Limit positions are enclosed in a part of so many of their cell, so many times."""
FAIR = 0.6
"""Of the best transmission angle, which answers have at least where nobody gives one."""
SWING = math.radians(60)
"""Of the rocker of a press, where nobody gives one."""


def stroke_answers(task: SynthesisTask) -> SynthesisResults:
    """Mechanisms of a stroke or a swing, a time ratio and a transmission angle.

    Raises
    ------
    InputError
        A time ratio that the topology cannot have.
    MotionError
        No mechanism transmits so well; the greatest possible angle is named.
    """
    wanted = task.synthesis
    ratio = wanted.time_ratio or 1.0
    if ratio - 1 < EQUAL and wanted.topology in ("shaper", "whitworth-quick-return"):
        what = _("a quick return has a time ratio above 1")
        raise InputError("[synthesis] time_ratio", what, _("give one, such as 1.5"))
    match wanted.topology:
        case "slider-crank-offset":
            mechanisms = [_slider_crank(task, ratio)]
        case "shaper" | "whitworth-quick-return":
            mechanisms = [_slotted_lever(task, ratio)]
        case "crank-rocker":
            mechanisms = _crank_rockers(task, ratio)
        case _:
            mechanisms = _presses(task, ratio)
    return SynthesisResults(
        task,
        tuple(_answer(mechanism, transmission, wanted) for mechanism, transmission in mechanisms),
        construction=_construct(mechanisms[0][0], wanted),
    )


def _answer(mechanism: Mechanism, transmission: float, wanted: Synthesis) -> Answer:
    """An answer with the stroke and the time ratio that the engine finds in its motion."""
    data = motion(mechanism, CHECKED_PLACES)
    branch = bool((data.status.to_numpy() != int(Status.OK)).any())
    box = box_around(mechanism, data.position.to_numpy())
    numbers = _measure_stroke(mechanism, wanted)
    zero = 0.0
    return Answer(
        mechanism, zero, zero, zero, transmission, box,
        Defects(False, branch, branch), numbers=numbers,
    )  # fmt: skip


def start_of(mechanism: Mechanism) -> float:
    """Angle [rad] at which the crank starts."""
    return float(mechanism.drives[0].start or 0.0)


def output_of(mechanism: Mechanism, wanted: Synthesis) -> tuple[str, str]:
    """What moves to and fro: ("slide", guide) or ("angle", link)."""
    if wanted.topology == "crank-rocker":
        return "angle", "DB"
    guide = wanted.guide or {"slider-crank-offset": "B", "six-bar-press": "H"}.get(str(wanted.topology), "E")
    return "slide", guide


def _measure_stroke(mechanism: Mechanism, wanted: Synthesis) -> Mapping[str, tuple[float, str]]:
    """Stroke and time ratio of the output, refined between samples by the slopes of the engine's motion."""
    ends = _limit_places(mechanism, wanted)
    if len(ends) != 2:
        return {}
    first, second = (float(_output_at(mechanism, wanted, [end])[0][0]) for end in ends)
    between = ends[1] - ends[0]
    slow = max(between, 2 * math.pi - between)
    unit, key = ("rad", "swing") if output_of(mechanism, wanted)[0] == "angle" else ("m", "stroke")
    return {
        key: (abs(second - first), unit),
        "time_ratio": (slow / (2 * math.pi - slow), "1"),
        "limit_angle": (limit_angle(slow / (2 * math.pi - slow)), "rad"),
    }


def _output_at(
    mechanism: Mechanism, wanted: Synthesis, places: list[float]
) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """The output and its velocity at values of the drive."""
    kind, name = output_of(mechanism, wanted)
    data = motion(mechanism, at=places)
    if kind == "angle":
        angle = np.unwrap(data.angle.sel(link=name).to_numpy())
        return angle, data.angular_velocity.sel(link=name).to_numpy()
    column = data.guide.to_numpy().tolist().index(name)
    return data.slide.to_numpy()[:, column], data.slide_velocity.to_numpy()[:, column]


def _limit_places(mechanism: Mechanism, wanted: Synthesis) -> list[float]:
    """Values of the drive [rad] at which the output turns back, over one turn."""
    # off the round angles at which limit positions like to lie
    turn = np.linspace(0.0, 2 * math.pi, CHECKED_PLACES) + start_of(mechanism) + OFF_ROUND
    _values, speeds = _output_at(mechanism, wanted, turn.tolist())
    cells = np.flatnonzero(speeds[:-1] * speeds[1:] < 0)
    low, high, rises = turn[cells], turn[cells + 1], speeds[cells] > 0
    for _round in range(ROUNDS if len(cells) else 0):
        places = low + (high - low) * np.linspace(0.0, 1.0, PARTS + 1)[:, None]
        found = _output_at(mechanism, wanted, places.ravel().tolist())[1].reshape(places.shape)
        before = np.maximum((np.where(rises, found, -found) > 0).sum(axis=0), 1)
        column = np.arange(len(cells))
        low, high = places[before - 1, column], places[np.minimum(before, PARTS), column]
    return [float(end) for end in (low + high) / 2]


def _construct(mechanism: Mechanism, wanted: Synthesis) -> Construction | None:
    """Both limit positions, by the engine, and the circle through O and the ends of what the crank moves."""
    places = _limit_places(mechanism, wanted)
    if len(places) != 2:
        return None
    data = motion(mechanism, at=places)
    at = {str(name): data.position.sel(point=name).to_numpy() @ (1, 1j) for name in data.point.to_numpy()}
    slotted = wanted.topology in ("shaper", "whitworth-quick-return")
    tip = output_of(mechanism, wanted)[1] if slotted or wanted.topology == "slider-crank-offset" else "B"
    lines = [
        np.array([at[name][side] for name in link.coordinates])
        for side in (0, 1)
        for link in mechanism.links.values()
        if len(link.coordinates) > 1
    ]
    turn = np.exp(1j * np.linspace(0.0, 2 * math.pi, 181))
    frame: Complex = np.array(list(mechanism.frame.points.values()), dtype=np.float64) @ np.array([1, 1j])
    fixed = dict(zip(mechanism.frame.points, frame.tolist(), strict=True))
    home, ends = fixed["O"], at[tip]
    none = np.empty(0, dtype=np.complex128)
    return Construction(
        ends, tuple(lines), home + abs(at["A"][0] - home) * turn,
        none if slotted else _circle_through(home, complex(ends[0]), complex(ends[1]), turn),
        frame,
    )  # fmt: skip


def _circle_through(first: complex, second: complex, third: complex, turn: Complex) -> Complex:
    """The circle through three points; empty where they lie in one line, as with the time ratio one."""
    one, two = second - first, third - first
    cross = (one.conjugate() * two).imag
    if abs(cross) < 1e-9 * abs(one) * abs(two):
        return np.empty(0, dtype=np.complex128)
    centre = 1j * (one * abs(two) ** 2 - two * abs(one) ** 2) / (2 * cross)
    circle: Complex = first + centre + abs(centre) * turn
    return circle


def _describe(task: SynthesisTask, title: str, **parts: Any) -> Mechanism:
    display = task.display.model_dump(exclude_unset=True)
    return Mechanism(title=task.title or title, display=display, **parts)


def _too_poor(best: float | None) -> MotionError:
    what = _("no mechanism transmits so well at this time ratio")
    repair = _("reduce the transmission angle or the time ratio")
    if best is not None:
        repair = _("at most {angle:.4g} deg is possible; reduce the transmission angle or the time ratio")
        repair = repair.format(angle=math.degrees(best))
    return MotionError("[synthesis] transmission", what, repair)


def _slider_crank(task: SynthesisTask, ratio: float) -> tuple[Mechanism, float]:
    wanted = task.synthesis
    assert wanted.stroke is not None
    found = slider_crank(wanted.stroke, ratio, wanted.transmission)
    if found is None:
        best = slider_crank(wanted.stroke, ratio, None)
        raise _too_poor(None if best is None else best.transmission)
    name = wanted.guide or "B"
    mechanism = _describe(
        task,
        "Offset slider-crank",
        frame={"points": {"O": [0.0, 0.0]}},
        links={"OA": {"length": found.crank}, f"A{name}": {"length": found.coupler}},
        guides=[{"point": name, "on": "frame", "through": [0.0, found.offset], "direction": [1.0, 0.0]}],
        drives=[
            {"link": "OA", "start": math.asin(found.offset / (found.crank + found.coupler)), "speed": 1.0}
        ],
        assembly={"sides": {name: "ahead"}},
    )
    return mechanism, found.transmission


def _slotted_lever(task: SynthesisTask, ratio: float) -> tuple[Mechanism, float]:
    wanted = task.synthesis
    assert wanted.stroke is not None
    turning = wanted.topology == "whitworth-quick-return"
    design: SlottedLever = (whitworth if turning else shaper)(
        wanted.stroke, ratio, wanted.length, wanted.transmission
    )
    name = wanted.guide or "E"
    crank, frame = design.crank, design.frame
    if turning:
        # the pin above O, the slider to one side
        pin = complex(0.0, crank)
        along = (pin + 1j * frame) / abs(pin + 1j * frame)
        tip, start = -design.lever * along, math.pi / 2
        local = [-design.lever, 0.0]
    else:
        pin = complex(0.0, crank)
        along = 1j
        tip, start = design.lever * along, math.pi / 2
        local = [design.lever, 0.0]
    tip = tip - 1j * frame
    drop = (design.height - frame) - tip.imag
    slant = math.asin(drop / design.link)
    mechanism = _describe(
        task,
        "Whitworth quick return" if turning else "Shaper with a slotted lever",
        frame={"points": {"O": [0.0, 0.0], "D": [0.0, -frame]}},
        links={
            "OA": {"length": crank},
            "lever": {
                "points": {"D": [0.0, 0.0], "B": local},
                "angle": f"{math.atan2(along.imag, along.real)!r} rad",
            },
            f"B{name}": {"length": design.link, "angle": f"{slant!r} rad"},
        },
        guides=[
            {"point": "A", "on": "lever", "through": "D", "direction": [1.0, 0.0]},
            {
                "point": name,
                "on": "frame",
                "through": [0.0, design.height - frame],
                "direction": [1.0, 0.0],
            },
        ],
        drives=[{"link": "OA", "start": start, "speed": 1.0}],
    )
    return mechanism, design.transmission


def _choose_rockers(wanted: Synthesis, ratio: float, swing: float, rocker: float) -> list[CrankRocker]:
    if not swing < math.pi:
        raise InputError("[synthesis] swing", _("a rocker swings by less than 180 deg"), _("reduce it"))
    found = crank_rockers(swing, ratio, rocker)
    if not found:
        what = _("no crank-rocker has this swing and this time ratio")
        raise MotionError("[synthesis]", what, _("reduce one of them"))
    least = FAIR * found[0].transmission if wanted.transmission is None else wanted.transmission
    kept = [one for one in found if one.transmission >= least - 1e-9]
    if not kept:
        raise _too_poor(found[0].transmission)
    return list(evenly(kept, wanted.answers))


def _crank_rockers(task: SynthesisTask, ratio: float) -> list[tuple[Mechanism, float]]:
    wanted = task.synthesis
    assert wanted.swing is not None
    answers = []
    for one in _choose_rockers(wanted, ratio, wanted.swing, wanted.length or 1.0):
        mechanism = _describe(
            task,
            "Crank-rocker",
            frame={"points": {"O": [one.fixed.real, one.fixed.imag], "D": [0.0, 0.0]}},
            links={
                "OA": {"length": one.crank},
                "AB": {"length": one.coupler},
                "DB": {"length": one.rocker},
            },
            drives=[{"link": "OA", "start": 0.0, "speed": 1.0}],
            assembly={"sides": {"B": "left" if one.side > 0 else "right"}},
        )
        answers.append((mechanism, one.transmission))
    return answers


def _presses(task: SynthesisTask, ratio: float) -> list[tuple[Mechanism, float]]:
    """A crank-rocker whose rocker moves a slider: the ends of its tip lie on the height of the guide alike."""
    wanted = task.synthesis
    assert wanted.stroke is not None
    swing = wanted.swing or SWING
    arm = wanted.stroke / (2 * math.sin(swing / 2))
    sagitta = arm * (1 - math.cos(swing / 2)) / 2
    angle = wanted.transmission if wanted.transmission is not None else math.radians(70)
    link = max(sagitta / math.cos(angle), 0.8 * arm)
    name = wanted.guide or "H"
    answers = []
    for one in _choose_rockers(wanted, ratio, swing, wanted.length or arm / 2):
        start, first, second = _position(one)
        tip = arm * second / abs(second)
        slant = math.asin((arm - sagitta - tip.imag) / link)
        mechanism = _describe(
            task,
            "Six-bar press",
            frame={"points": {"O": [one.fixed.real, one.fixed.imag], "C": [0.0, 0.0]}},
            links={
                "OA": {"length": one.crank},
                "AB": {"length": one.coupler, "angle": f"{_heading(second - first)!r} rad"},
                "CD": {
                    "points": {"C": [0.0, 0.0], "B": [one.rocker, 0.0], "D": [arm, 0.0]},
                    "angle": f"{_heading(second)!r} rad",
                },
                f"D{name}": {"length": link, "angle": f"{slant!r} rad"},
            },
            guides=[{"point": name, "on": "frame", "through": [0.0, arm - sagitta], "direction": [1.0, 0.0]}],
            drives=[{"link": "OA", "start": f"{start!r} rad", "speed": 1.0}],
        )
        answers.append((mechanism, min(one.transmission, math.acos(sagitta / link))))
    return answers


def _position(one: CrankRocker) -> tuple[float, complex, complex]:
    """Crank angle, A and B of a crank-rocker with D in the origin, its crank square to the frame."""
    start = _heading(-one.fixed) + math.pi / 2
    first = one.fixed + one.crank * complex(math.cos(start), math.sin(start))
    distance = abs(first)
    along = (distance**2 + one.coupler**2 - one.rocker**2) / (2 * distance)
    height = math.sqrt(max(one.coupler**2 - along**2, 0.0))
    direction = -first / distance
    return start, first, first + direction * complex(along, one.side * height)


def _heading(vector: complex) -> float:
    return math.atan2(vector.imag, vector.real)
