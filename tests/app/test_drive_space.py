"""Several drives, and drives without a law, follow a dragged point by least squares."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.app import drive_space
from centrode.app.documents import read_document
from centrode.app.drive_space import has_free_place, initial_values, place_in_drive_space, position_at
from centrode.app.frames import read_frame
from centrode.app.operations import apply_operation
from centrode.app.patches import Patch
from centrode.app.sketch import SketchParts
from centrode.errors import InputError
from centrode.model.examples import example_text

HERE = Path()
SEVERAL = ["five-bar-two-drives", "excavator-arm", "two-link-arm", "five-bar-pendulum", "double-pendulum"]


HIGHER = ["fourth-class-group", "third-class-triad", "stephenson-driven-at-rocker", "scissor-lift-cylinder"]
"""One drive, and a group of higher class behind it."""
GEARED = ["geared-five-bar", "planetary-hypocycloid", "rolling-wheel-rod", "bevel-pair"]
"""One drive, and turns that gears or rolling wheels count."""


def without_laws(name):
    """A built-in description whose drives nothing moves; a range of the drive is none without it."""
    return re.sub(r"(?m)^(?:speed|law|from|to) = .*\n", "", example_text(name))


def positions_along(text, point, *places):
    """Positions while the cursor passes places, one after the other."""
    prepared = read_document(text, HERE).position
    values, found = initial_values(prepared), []
    for place in places:
        found.append(place_in_drive_space(prepared, point, np.array(place), values))
        values = found[-1].values
    return found


def test_the_arm_reaches_for_the_cursor_as_the_cosine_theorem_says():
    """Two links of 0.5 m: cos(elbow) = (x^2 + y^2)/0.5 - 1; on one side of the elbow all the way."""
    turns = np.linspace(0.2, 1.4, 13)
    places = [(0.8 * math.cos(turn), 0.6 * math.sin(turn)) for turn in turns]
    found = positions_along(example_text("two-link-arm"), "B", *places)
    side = np.sign(found[0].values["AB"])
    for place, position in zip(places, found, strict=True):
        elbow = side * math.acos((place[0] ** 2 + place[1] ** 2) / 0.5 - 1.0)
        first = math.atan2(place[1], place[0]) - elbow / 2
        assert position.points["B"] == pytest.approx(place, abs=1e-9)
        assert position.values == pytest.approx({"OA": first, "AB": elbow}, abs=1e-8)


def test_out_of_reach_the_arm_points_at_the_cursor():
    places = [(0.9 * math.cos(turn), 0.9 * math.sin(turn)) for turn in np.linspace(0.1, 1.0, 7)]
    last = positions_along(
        example_text("two-link-arm"), "B", *places, (3 * math.cos(1.0), 3 * math.sin(1.0))
    )[-1]
    assert last.points["B"] == pytest.approx((math.cos(1.0), math.sin(1.0)), abs=1e-6)


def test_three_drives_move_least():
    """Of all ways to bring the tip to a place near by, that of the least change of the drives, each in its own unit."""
    text = example_text("excavator-arm")
    prepared = read_document(text, HERE).position
    begin = position_at(prepared, initial_values(prepared))
    goal = begin.points["T"] + np.array([1e-4, -2e-4])
    position = place_in_drive_space(prepared, "T", goal, begin.values)
    assert position.points["T"] == pytest.approx(goal, abs=1e-12)
    change = np.array([position.values[name] - begin.values[name] for name in begin.values])
    least = np.linalg.pinv(begin.slopes["T"].T) @ (goal - begin.points["T"])
    assert change == pytest.approx(least, rel=2e-3)


@pytest.mark.parametrize("name", [*SEVERAL, *HIGHER, *GEARED])
def test_derivatives_by_the_drives_are_those_of_the_positions(name):
    """Central differences; what is dropped stands there in the motion of the file that is written."""
    text = example_text(name) if name in SEVERAL else without_laws(name)
    prepared = read_document(text, HERE).position
    begin = position_at(prepared, initial_values(prepared))
    step = 1e-5
    for k, drive in enumerate(begin.values):
        ends = [
            position_at(prepared, {**begin.values, drive: begin.values[drive] + sign * step}, begin.positions)
            for sign in (1, -1)
        ]
        for point in begin.points:
            difference = (ends[0].points[point] - ends[1].points[point]) / (2 * step)
            scale = 1.0 + np.abs(difference).max()
            assert begin.slopes[point][k] == pytest.approx(difference, abs=1e-7 * scale)
    point = prepared.mechanism.moving_points[-1]
    size = SketchParts(read_document(text, HERE)).size
    there = place_in_drive_space(prepared, point, begin.points[point] + 0.03 * size, begin.values)
    patch = Patch(text, HERE)
    apply_operation(patch, {"do": "set_starts", "drives": there.values})
    start = read_document(patch.text, HERE).position.assembled.positions.points
    for name_of_point, place in there.points.items():
        assert list(map(float, start[name_of_point])) == pytest.approx(place, abs=2e-4 * size)


@pytest.mark.parametrize("name", [*HIGHER, *GEARED])
def test_a_hand_leads_along_the_motion_of_the_drive(name):
    """A hand that goes where the crank's pin goes: the drive's value and all other points are those of the motion,
    which is followed by another route; with the last positions forgotten the way from the start gives them again."""
    text = without_laws(name)
    prepared, motion = (
        read_document(text, HERE).position,
        ct.motion(ct.parse_mechanism(example_text(name)), 73),
    )
    point, begin = prepared.mechanism.moving_points[0], initial_values(prepared)
    (drive,) = begin
    values = motion.drive_value.sel(drive=drive).values if "drive" in motion.drive_value.dims else None
    values = motion.drive_value.values if values is None else values
    first = int(np.argmin(abs(values - begin[drive])))
    size = SketchParts(read_document(text, HERE)).size
    present, seen = begin, 0
    for k in range(first + 1, min(first + 13, len(values))):
        if int(motion.status[k]) != 0:
            break
        goal = motion.position.isel(sample=k).sel(point=point).values
        found = place_in_drive_space(prepared, point, goal, present)
        if abs(found.values[drive] - values[k]) > 1e-6 * max(1.0, abs(values[k])):
            assert np.linalg.norm(found.points[point] - goal) < 1e-6 * size  # it passes there twice
            break
        for other, place in found.points.items():
            assert place == pytest.approx(
                motion.position.isel(sample=k).sel(point=other).values, abs=1e-7 * size
            )
        present, seen = found.values, seen + 1
    assert seen >= 3
    again = position_at(prepared, present)
    drive_space._KEPT.clear()
    anew = position_at(prepared, present)
    for other, place in anew.points.items():
        assert place == pytest.approx(again.points[other], abs=1e-9 * size)


def test_a_rack_that_its_line_places_is_not_dropped_elsewhere():
    text = without_laws("rack-and-pinion")
    prepared = read_document(text, HERE).position
    begin = position_at(prepared, initial_values(prepared))
    there = place_in_drive_space(prepared, "H", begin.points["H"] + np.array([0.01, 0.0]), begin.values)
    assert there.values["pinion"] == pytest.approx(0.5, abs=1e-9)  # 10 mm over a pitch radius of 20 mm
    with pytest.raises(InputError, match="where this begins"):
        apply_operation(Patch(text, HERE), {"do": "set_starts", "drives": there.values})


def test_a_drive_without_a_law_is_moved_by_hand_and_simulated(ask):
    text = without_laws("five-bar-pendulum")
    answer = ask("read", text=text)
    assert "free coordinate" in answer["problems"][0]["message"]
    scene = answer["scene"]
    assert all(point["at"] for point in scene["points"])
    assert [name for name, there in scene["topics"].items() if there is True] == [
        "simulate",
        "equilibrium",
        "modes",
    ]
    assert all(point["handles"]["move"] for point in scene["points"] if point["kind"] != "fixed")
    by_laws = ask("read", text=example_text("five-bar-pendulum"))["scene"]
    assert [one["at"] for one in scene["points"]] == [one["at"] for one in by_laws["points"]]
    moving = ask("drag", text=text, mode="move", point="C", to=[0.25, 0.55])
    header, arrays = read_frame(moving)
    names = [point["name"] for point in scene["points"]]
    assert arrays["points"][names.index("C")] == pytest.approx([0.25, 0.55], abs=1e-6)
    again = read_frame(
        ask("drag", text=text, mode="move", point="C", to=[0.25, 0.55], drives=header["drives"])
    )
    assert again[0]["drives"] == pytest.approx(header["drives"], abs=1e-9)
    dropped = ask("drag", text=text, mode="move", point="C", to=[0.25, 0.55], drop=True)
    place = next(one["at"] for one in dropped["scene"]["points"] if one["name"] == "C")
    assert place == pytest.approx([0.25, 0.55], abs=1e-4)
    assert "blocks" in ask("panel", text=text, topic="simulate", samples=9)


def test_one_crank_without_a_speed_follows_the_cursor_too():
    text = without_laws("crank-rocker")
    assert has_free_place(read_document(text, HERE))
    assert not has_free_place(read_document(example_text("crank-rocker"), HERE))
    for turn in (0.3, 1.2, 2.9):
        steps = [(2 * math.cos(a), 2 * math.sin(a)) for a in np.linspace(0.0, turn, 9)[1:]]
        position = positions_along(text, "A", *steps)[-1]
        assert position.points["A"] == pytest.approx((math.cos(turn), math.sin(turn)), abs=1e-8)


@pytest.mark.parametrize(
    "drives", [None, {}, {"OA": 0.0}, {"OA": 0.0, "EC": math.nan}, {"OA": 0.0, "EC": "x"}]
)
def test_starts_that_are_none_are_refused(drives):
    patch = Patch(example_text("five-bar-two-drives"), HERE)
    with pytest.raises(InputError):
        apply_operation(patch, {"do": "set_starts", "drives": drives})
    assert patch.text == example_text("five-bar-two-drives")
