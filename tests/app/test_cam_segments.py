"""Segments of a cam in the editor: whatever is added, deleted or given another curve, the turn stays full."""

from __future__ import annotations

import math
import random
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from centrode.app.cam_scene import cam_scene
from centrode.app.cam_segments import CURVES
from centrode.app.documents import read_document
from centrode.app.operations import apply_operation
from centrode.app.patches import Patch
from centrode.errors import InputError
from centrode.model.examples import example_text
from centrode.numerics.arrays import ARRAYS

HERE = Path()
INDEXING, VALVE = example_text("indexing-cam"), example_text("valve-cam")
SHARES = re.sub(r'angle = "(\d+) deg"', lambda found: f"share = {int(found[1]) / 360!r}", VALVE)
TIMES = re.sub(r'angle = "(\d+) deg"', lambda found: f'time = "{int(found[1]) / 9:.12g} ms"', VALVE)
"""At 1500 turns a minute a degree takes a ninth of a millisecond."""
INLINE = VALVE[: VALVE.index("[[segments]]")].replace(
    "[cam]",
    "segments = [\n"
    '  { angle = "75 deg", to = "8 mm", curve = "3-4-5" }, # opens\n'
    '  { angle = "75 deg", to = 0, curve = "3-4-5" },\n'
    '  { angle = "210 deg", curve = "dwell" },\n'
    "]\n\n[cam]",
    1,
)


def lift(text, places):
    """Lift of the follower at angles of the cam [rad], by the package."""
    cam = read_document(text, HERE).cam
    assert cam is not None, read_document(text, HERE).problems
    return np.array([float(cam.lift_law.jet(ARRAYS, np.float64(phi))) for phi in places])


def patch_of(text, *operations):
    patch = Patch(text, HERE)
    for operation in operations:
        apply_operation(patch, operation)
    return patch


@pytest.mark.parametrize("text", [INDEXING, VALVE, SHARES, TIMES, INLINE])
def test_a_segment_that_is_added_waits_and_leaves_the_others(text):
    """By the curves' own law: outside of the segment that was divided the lift is the same."""
    scene = cam_scene(read_document(text, HERE))["cam"]["segments"]
    for k, segment in enumerate(scene):
        after = patch_of(text, {"do": "add_segment", "after": k}).text
        middle = (segment["from"] + segment["to"]) / 2
        inside = np.linspace(middle, segment["to"], 7)[1:-1]
        assert lift(after, inside) == pytest.approx(np.full(5, segment["lift"]), abs=1e-12)
        outside = [phi for phi in np.linspace(0, math.tau, 73) if not segment["from"] <= phi <= segment["to"]]
        assert lift(after, outside) == pytest.approx(lift(text, outside), abs=1e-12)
        # what the author has written stands, but for the one number
        gone = [line for line in text.splitlines() if line not in after.splitlines()]
        assert len(gone) <= 1


@pytest.mark.parametrize("text", [INDEXING, VALVE, SHARES, TIMES, INLINE])
def test_a_segment_that_is_deleted_leaves_its_part_to_its_neighbour(text):
    rows = cam_scene(read_document(text, HERE))["cam"]["segments"]
    for k in range(len(rows)):
        after = patch_of(text, {"do": "delete_segment", "segment": k})
        left = cam_scene(read_document(after.text, HERE))["cam"]["segments"]
        ends = [row["to"] for j, row in enumerate(rows) if j != (k - 1 if k else 0)]
        assert [row["to"] for row in left] == pytest.approx(ends, abs=1e-12)


def test_a_hundred_changes_keep_the_turn_full():
    """The angles of the text, summed by hand, are those of a turn after every change that is not refused."""
    source, done = random.Random(28), 0
    patch = Patch(INDEXING, HERE)
    for _step in range(100):
        count = len(tomllib.loads(patch.text)["segments"])
        k = source.randrange(count)
        operation = source.choice(
            [
                {"do": "add_segment", "after": k},
                {"do": "delete_segment", "segment": k},
                {"do": "set_curve", "segment": k, "curve": source.choice(CURVES)},
            ]
        )
        try:
            apply_operation(patch, operation)
            done += 1
        except InputError as refused:
            assert "at least one segment" in refused.what
        degrees = [float(one["angle"].split()[0]) for one in tomllib.loads(patch.text)["segments"]]
        assert math.fsum(degrees) == pytest.approx(360.0, abs=1e-9)
        problems = {problem.message for problem in read_document(patch.text, HERE).problems}
        assert all("nothing moves" in one or "does not return" in one for one in problems), problems
    assert done > 80


def test_a_curve_gets_the_lift_that_it_needs():
    rising = patch_of(INDEXING, {"do": "set_curve", "segment": 3, "curve": "harmonic"}).text
    assert tomllib.loads(rising)["segments"][3] == {"angle": "70 deg", "curve": "harmonic", "to": "24 deg"}
    falling = patch_of(INDEXING, {"do": "set_curve", "segment": 1, "curve": "harmonic"}).text
    assert tomllib.loads(falling)["segments"][1]["to"] == 0
    waiting = patch_of(INDEXING, {"do": "set_curve", "segment": 0, "curve": "dwell"}).text
    assert tomllib.loads(waiting)["segments"][0] == {"angle": "120 deg", "curve": "dwell"}


def test_segments_that_leave_a_gap_are_shown_to_be_corrected():
    text = INDEXING.replace('angle = "120 deg"', 'angle = "100 deg"')
    document = read_document(text, HERE)
    assert document.cam is None and "gap" in document.problems[0].message
    scene = cam_scene(document)
    assert [math.degrees(one["to"]) for one in scene["cam"]["segments"]] == pytest.approx(
        [100, 160, 270, 340]
    )
    assert {one["path"] for one in scene["dimensions"]} >= {"segments.0.angle", "segments.0.to"}


def test_curves_are_named_in_the_language(ask):
    answer = ask("read", text=INDEXING, language="uk")
    names = answer["scene"]["cam"]["segments"][0]["names"]
    assert set(names) == set(CURVES) and names["harmonic"] != "harmonic"


@pytest.mark.parametrize(
    "operation",
    [
        {"do": "add_segment", "after": 4},
        {"do": "add_segment", "after": -1},
        {"do": "delete_segment", "segment": True},
        {"do": "delete_segment"},
        {"do": "set_curve", "segment": 0, "curve": "soon"},
    ],
)
def test_what_is_no_segment_is_refused(operation):
    patch = Patch(INDEXING, HERE)
    with pytest.raises(InputError):
        apply_operation(patch, operation)
    assert patch.text == INDEXING


FOLLOWERS = {
    "flat": VALVE,
    "swinging": INDEXING,
    "clockwise": INDEXING.replace('turn = "counter-clockwise"', 'turn = "clockwise"'),
    "knife": VALVE.replace('contact = "flat"', 'contact = "knife"\noffset = "4 mm"'),
    "roller": VALVE.replace(
        'contact = "flat"', 'contact = "roller"\nroller_radius = "8 mm"\noffset = "4 mm"'
    ),
}


@pytest.mark.parametrize("text", FOLLOWERS.values(), ids=FOLLOWERS)
def test_the_follower_rests_on_the_cam_of_the_picture(text):
    """Turned by the angle of its sample, the profile touches roller, edge or face, and crosses none of them."""
    document = read_document(text, HERE)
    scene = cam_scene(document)["cam"]
    follower, profile = scene["follower"], np.array(scene["profile"])
    size = np.abs(profile).max()
    for sample in range(0, 361, 24):
        turn = follower["sense"] * math.radians(sample)
        cosine, sine = math.cos(turn), math.sin(turn)
        turned = profile @ np.array([[cosine, sine], [-sine, cosine]])
        if follower["faces"] is not None:
            (x, y), (u, v) = np.array(follower["faces"][sample]).reshape(-1, 2)[:2]
            assert y == v  # the face of a stem lies level, and the cam is below it
            inside = turned[(turned[:, 0] > x) & (turned[:, 0] < u)]
            assert inside[:, 1].max() == pytest.approx(y, abs=3e-4 * size)
            assert turned[:, 1].max() < y + 1e-5 * size
        else:
            place = np.array(follower["places"][sample])
            apart = np.linalg.norm(turned - place, axis=1).min()
            assert apart == pytest.approx(scene["roller"] or 0.0, abs=8e-3 * size)
        if follower["pivot"] is not None:
            arm = math.dist(follower["places"][sample], follower["pivot"])
            assert arm == pytest.approx(0.09, abs=1e-6)


def test_a_roller_is_led_around_a_cam_that_stands(ask):
    scene = ask("read", text=example_text("walking-wheel-four-legs"))["scene"]
    cam = scene["cam"]
    assert cam["follower"] is None and len(cam["carrier"]) == len(cam["pitch"])
    angles = np.unwrap(np.arctan2(*np.array(cam["pitch"]).T))
    assert np.abs(angles - angles[0]) == pytest.approx(
        np.abs(np.array(cam["carrier"]) - cam["carrier"][0]), abs=1e-4
    )
    profile = np.array(cam["profile"])
    for place in np.array(cam["pitch"])[::40]:
        assert np.linalg.norm(profile - place, axis=1).min() == pytest.approx(cam["roller"], abs=2e-4)
    names = [one["name"] for one in scene["dimensions"]]
    assert len(names) == len(set(names))
