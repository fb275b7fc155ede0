"""Drags: the joint stands where it is put, what is locked holds, and a mechanism moves on its branch."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.app.documents import read_document
from centrode.app.edit_drags import edit_refusal, reshape
from centrode.app.frames import frame_bytes, read_frame
from centrode.app.move_drags import place_on_way, way_of
from centrode.app.operations import apply_operation
from centrode.app.patches import Patch
from centrode.app.sketch import SketchParts
from centrode.errors import CentrodeError, InputError
from centrode.kinematics.motion import initial_place
from centrode.model.examples import example_names, example_text

HERE = Path()
EXAMPLES = [name for name in example_names() if getattr(ct.example(name), "space", "") == "plane"]


def sketch_of(text):
    return SketchParts(read_document(text, HERE))


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_dragged_joint_stands_there_in_the_motion_of_the_edited_description(name):
    """Independent of the editor: the file that it wrote is read and moved by the package."""
    text = example_text(name)
    sketch = sketch_of(text)
    done = 0
    for point in sketch.points:
        if edit_refusal(sketch, point):
            continue
        to = (sketch.places[point][0] + 0.02 * sketch.size, sketch.places[point][1] + 0.013 * sketch.size)
        patch = Patch(text, HERE)
        try:
            reshaped = reshape(sketch, point, to, HERE)
            apply_operation(patch, {"do": "move_point", "point": point, "to": list(to)})
        except InputError:
            assert patch.text == text
            continue
        mechanism = ct.parse_mechanism(patch.text)
        motion = ct.motion(mechanism, at=[initial_place(mechanism)])
        found = motion.position.sel(point=point).values[0]
        wished = to if not reshaped.held else reshaped.places[point]
        assert found == pytest.approx(wished, abs=2e-4 * sketch.size)
        # joints of other links stand where they stood, unless a guide or a slot carries them on
        assert {*reshaped.places} >= {*sketch.places}
        done += 1
        if done == 3:
            break


def test_locked_lengths_and_held_joints_hold():
    text = example_text("crank-rocker")
    locked = Patch(text, HERE)
    apply_operation(locked, {"do": "lock", "path": "links.AB.length", "on": True})
    sketch = SketchParts(locked.document)
    for to in ([2.0, 3.5], [4.5, 1.0], [3.0, -2.0]):
        patch = Patch(locked.text, HERE)
        apply_operation(patch, {"do": "move_point", "point": "B", "to": to})
        mechanism = ct.parse_mechanism(patch.text)
        assert mechanism.links["AB"].length == ct.parse_mechanism(text).links["AB"].length
        # nearest to the wish on the circle about A
        a, b = (np.array(SketchParts(patch.document).places[one]) for one in "AB")
        assert b - a == pytest.approx(3.5 * (np.array(to) - a) / np.linalg.norm(np.array(to) - a), abs=1e-4)
    held = Patch(text, HERE)
    apply_operation(held, {"do": "set_row", "object": "B", "row": "fixed", "on": True})
    with pytest.raises(InputError, match="held"):
        apply_operation(held, {"do": "move_point", "point": "B", "to": [2, 2]})
    assert not sketch.marks["fixed"]


def test_two_locks_leave_no_freedom():
    patch = Patch(example_text("crank-rocker"), HERE)
    apply_operation(patch, {"do": "lock", "path": "links.AB.length", "on": True})
    apply_operation(patch, {"do": "lock", "path": "links.DB.length", "on": True})
    sketch = SketchParts(patch.document)
    reshaped = reshape(sketch, "B", (9.0, 9.0), HERE)
    assert reshaped.places["B"] == pytest.approx(sketch.places["B"], abs=1e-4)
    assert reshaped.held


def test_a_slider_stays_on_its_guide():
    sketch = sketch_of(example_text("six-bar-press"))
    reshaped = reshape(sketch, "H", (sketch.places["H"][0] + 0.1, 2.0), HERE)
    assert reshaped.places["H"] == pytest.approx((sketch.places["H"][0] + 0.1, 0.9), abs=1e-5)
    assert "guide" in reshaped.held


def test_the_centre_of_a_rod_stays_in_its_middle():
    text = example_text("six-bar-press")
    patch = Patch(text, HERE)
    apply_operation(patch, {"do": "move_point", "point": "D", "to": [1.0, 1.7]})
    rod = ct.parse_mechanism(patch.text).links["DH"].coordinates
    assert rod["S4"] == pytest.approx((rod["H"][0] / 2, 0.0), abs=1e-5)


@pytest.mark.parametrize(
    "name", ["crank-rocker", "six-bar-press", "double-rocker", "third-class-triad", "shaper", "scissor-lift"]
)
def test_moving_finds_the_place_that_was_wished(name):
    """A place on the point's own path is met: the point stands there, and at the drive's value of that place."""
    document = read_document(example_text(name), HERE)
    way = way_of(document)
    point = way.names[-1]
    k = way.names.index(point)
    present = float(way.ready.kinematics.path.initial)
    reached = np.flatnonzero(way.reached)
    start = int(reached[np.argmin(np.abs(way.places[reached] - present))])
    for step in range(0, 40, 4):
        node = (start + step) % (len(way.places) - 1) if way.closes else start + step
        if node >= len(way.places) or not way.reached[node]:
            break
        present = place_on_way(way, point, way.points[node, k], present)
        points, _angles, status = way.at(present)
        moving = points[len(points) - len(way.names) :]
        assert moving[k] == pytest.approx(way.points[node, k], abs=1e-6 * np.nanmax(np.abs(way.points)))
        assert status == 0


def test_a_full_turn_of_the_cursor_turns_the_crank_once():
    document = read_document(example_text("crank-rocker"), HERE)
    way = way_of(document)
    present = float(way.ready.kinematics.path.initial)
    for angle in np.linspace(present, present + 2 * math.pi, 73):
        to = 3.0 * np.array([math.cos(angle), math.sin(angle)])  # outside of the crank's circle
        present = place_on_way(way, "A", to, present)
        assert present == pytest.approx(angle, abs=1e-7)


def test_moving_stops_at_limits():
    document = read_document(example_text("double-rocker"), HERE)
    way = way_of(document)
    present = place_on_way(way, way.names[0], np.array([1e3, 1e3]), None)
    assert way.places.min() <= present <= way.places.max()
    assert np.isfinite(way.at(present)[0]).all()


def test_frames_are_four_byte_numbers_behind_a_header():
    content = frame_bytes({"id": 7, "word": "ü"}, {"a": [[1.5, math.nan]], "b": [3.0]})
    header, arrays = read_frame(content)
    assert header["word"] == "ü" and header["arrays"]["b"] == {"shape": [1], "offset": 2}
    assert arrays["a"][0, 0] == 1.5 and math.isnan(arrays["a"][0, 1]) and arrays["b"][0] == 3.0
    assert int.from_bytes(content[:4], "little") % 4 == 0


def test_drags_by_messages(ask):
    text = example_text("six-bar-press")
    digest = ask("read", text=text)["digest"]
    header, arrays = read_frame(ask("drag", digest=digest, mode="edit", point="B", to=[0.8, 0.7]))
    names = [point["name"] for point in ask("read", digest=digest)["scene"]["points"]]
    assert arrays["points"][names.index("B")] == pytest.approx([0.8, 0.7], abs=1e-5)
    dropped = ask("drag", digest=digest, mode="edit", point="B", to=[0.8, 0.7], drop=True)
    place = next(one["at"] for one in dropped["scene"]["points"] if one["name"] == "B")
    assert place == pytest.approx([0.8, 0.7], abs=1e-4)
    header, arrays = read_frame(ask("drag", digest=digest, mode="move", point="H", to=[2.5, 0.9], drive=3.8))
    motion = ct.motion(ct.example("six-bar-press"), at=[header["at"]])
    assert arrays["points"] == pytest.approx(motion.position.values[0], abs=1e-6)
    assert "error" in ask("drag", digest=digest, mode="edit", point="nothing", to=[0, 0])


def test_what_does_not_close_is_refused_in_words():
    sketch = sketch_of(example_text("three-crank-parallelogram"))
    with pytest.raises(CentrodeError):
        reshape(sketch, "F", (5.0, 5.0), HERE)
