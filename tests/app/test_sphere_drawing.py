"""Drawing on the sphere: points with longitudes and latitudes, from which arcs and angles follow."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.app.documents import read_document
from centrode.app.frames import read_frame
from centrode.app.operations import apply_operation
from centrode.app.patches import Patch
from centrode.app.sketch import SketchParts
from centrode.errors import InputError
from centrode.kinematics.motion import initial_place
from centrode.model.examples import example_text

HERE = Path()
EMPTY = 'space = "sphere"\ndisplay = { angle = "deg" }\n'
FOUR_BAR = """\
space = "sphere"
display = { angle = "deg" }

[points]
A = ["0 deg", "0 deg"]
B = ["0 deg", "30 deg"]
C = ["60 deg", "45 deg"]
D = ["90 deg", "0 deg"]

[frame]
points = ["A", "D"]

[links.AB]

[links.BC]

[links.CD]

[[drives]]
link = "AB"
speed = 1
"""


def at(longitude, latitude):
    """A place as a message holds it."""
    x, y = math.radians(longitude), math.radians(latitude)
    return [math.cos(y) * math.cos(x), math.cos(y) * math.sin(x), math.sin(y)]


def arc(one, other):
    return math.acos(max(-1.0, min(1.0, float(np.dot(one, other)))))


def patch_of(text, *operations):
    patch = Patch(text, HERE)
    for operation in operations:
        apply_operation(patch, operation)
    return patch


def places_in_motion(text):
    """Where the package itself puts the points of a text."""
    mechanism = ct.parse_mechanism(text)
    start = ct.motion(mechanism, at=[initial_place(mechanism)]).position.isel(sample=0)
    return {str(name): start.sel(point=name).values for name in start.point.values}


def test_a_four_bar_takes_five_gestures():
    patch = patch_of(
        EMPTY,
        {"do": "add_link", "at": at(0, 0), "to": at(0, 30)},
        {"do": "add_link", "at": at(0, 30), "to": at(60, 45), "from_point": "B"},
        {"do": "add_link", "at": at(60, 45), "to": at(90, 0), "from_point": "C"},
        {"do": "set_row", "object": "AB", "row": "drive", "on": True},
        {"do": "set_row", "object": "D", "row": "ground", "on": True},
    )
    assert patch.text == FOUR_BAR
    places = places_in_motion(patch.text)
    for name, place in {"A": at(0, 0), "B": at(0, 30), "C": at(60, 45), "D": at(90, 0)}.items():
        assert places[name] == pytest.approx(place, abs=1e-12)


def test_a_dragged_joint_stands_there_and_a_locked_arc_holds():
    moved = patch_of(FOUR_BAR, {"do": "move_point", "point": "C", "to": at(50, 40)})
    assert places_in_motion(moved.text)["C"] == pytest.approx(at(50, 40), abs=1e-6)
    locked = patch_of(
        FOUR_BAR,
        {"do": "lock", "path": "links.CD.length", "on": True},
        {"do": "move_point", "point": "C", "to": at(50, 30)},
    )
    places = places_in_motion(locked.text)
    assert arc(places["C"], places["D"]) == pytest.approx(arc(at(60, 45), at(90, 0)), abs=4e-6)
    # the nearest place: on the great circle from D through the wish
    normal = np.cross(places["D"], at(50, 30))
    assert abs(normal @ places["C"]) < 1e-5


def test_a_guide_is_a_great_circle_that_holds_its_point():
    text = patch_of(
        EMPTY,
        {"do": "add_link", "at": at(0, 0), "to": at(0, 20)},
        {"do": "add_link", "at": at(0, 20), "to": at(80, 10), "from_point": "B"},
        {"do": "add_guide", "at": at(80, 10), "to": at(85, 40), "point": "C"},
        {"do": "set_row", "object": "AB", "row": "drive", "on": True},
    ).text
    pole = np.cross(at(80, 10), at(85, 40))
    pole /= np.linalg.norm(pole)
    assert abs(places_in_motion(text)["C"] @ pole) < 1e-5
    # the angle of the drive needs an arc of the frame: a pole was added to it
    assert len(tomllib.loads(text)["frame"]["points"]) == 2
    dragged = patch_of(text, {"do": "move_point", "point": "C", "to": at(90, 30)})
    after = places_in_motion(dragged.text)["C"]
    assert abs(after @ pole) < 1e-5
    assert arc(after, at(90, 30)) == pytest.approx(abs(math.asin(np.dot(pole, at(90, 30)))), abs=1e-5)


def test_numbers_are_arcs_longitudes_and_latitudes():
    longer = patch_of(FOUR_BAR, {"do": "set", "path": "links.BC.length", "value": "50"})
    places = places_in_motion(longer.text)
    assert math.degrees(arc(places["B"], places["C"])) == pytest.approx(50.0, abs=1e-3)
    assert arc(places["C"], places["D"]) == pytest.approx(arc(at(60, 45), at(90, 0)), abs=1e-5)
    assert places["B"] == pytest.approx(at(0, 30), abs=1e-6)
    east = patch_of(FOUR_BAR, {"do": "set", "path": "points.D.longitude", "value": "92"})
    assert places_in_motion(east.text)["D"] == pytest.approx(at(92, 0), abs=1e-12)
    rows = SketchParts(read_document(FOUR_BAR, HERE))
    assert rows.length("AB") == pytest.approx(math.pi / 6, abs=1e-12)


def test_plates_masses_and_loads():
    text = patch_of(
        FOUR_BAR,
        {"do": "add_point", "link": "BC", "at": at(30, 60)},
        {"do": "set_row", "object": "CD", "row": "mass", "on": True},
        {"do": "set_row", "object": "E", "row": "load", "on": True},
        {"do": "set_row", "object": "E", "row": "trace", "on": True},
    ).text
    tables = tomllib.loads(text)
    assert tables["links"]["BC"]["points"] == ["B", "C", "E"] and tables["links"]["CD"]["shape"] == "arc"
    assert tables["loads"] == [{"kind": "force", "point": "E", "vector": [0, 0, -100]}]
    assert places_in_motion(text)["E"] == pytest.approx(at(30, 60), abs=1e-6)
    ct.reduce(ct.parse_mechanism(text))


def test_an_unfinished_drawing_stands_where_it_was_drawn(ask):
    text = patch_of(EMPTY, {"do": "add_link", "at": at(10, 20), "to": at(40, 20)}).text
    scene = ask("read", text=text)["scene"]
    assert scene["kind"] == "sphere" and scene["draws"] is True
    assert [one["at"] for one in scene["points"]] == [pytest.approx(at(10, 20)), pytest.approx(at(40, 20))]
    assert not ask("read", text=example_text("spherical-four-bar"))["scene"]["draws"]


def distances(places, names):
    """Arcs between all pairs of points."""
    return [arc(places[a], places[b]) for k, a in enumerate(names) for b in names[:k]]


def test_a_copy_stands_beside_and_is_as_great():
    patch = patch_of(FOUR_BAR, {"do": "duplicate", "objects": ["BC", "CD"], "about": [0, 0, 1], "angle": 0.2})
    copies = patch.named[:3]
    assert copies == ["E", "F", "G"]
    places = {**places_in_motion(FOUR_BAR)}
    text = tomllib.loads(patch.text)
    assert text["frame"]["points"] == ["A", "D", "G"]  # D is at rest, its copy too
    sketch = SketchParts(read_document(patch.text, HERE))
    assert distances(sketch.places, copies) == pytest.approx(distances(places, ["B", "C", "D"]), abs=4e-6)
    turn = np.array([[math.cos(0.2), -math.sin(0.2), 0], [math.sin(0.2), math.cos(0.2), 0], [0, 0, 1]])
    for copy, name in zip(copies, "BCD", strict=True):
        assert sketch.places[copy] == pytest.approx(turn @ np.array(places[name]), abs=2e-6)
    beside = patch_of(FOUR_BAR, {"do": "duplicate", "objects": ["C"]})
    place = SketchParts(read_document(beside.text, HERE)).places[beside.named[0]]
    assert arc(place, at(60, 45)) == pytest.approx(math.pi / 12, abs=4e-6)


@pytest.mark.parametrize(
    ("axis", "pole"), [([at(0, 0), at(90, 0)], [0, 0, 1]), ([at(0, 0), at(0, 90)], [0, 1, 0])]
)
def test_a_mirror_image_in_a_great_circle(axis, pole):
    """Of the equator latitudes change their sign, of the meridian through x longitudes."""
    patch = patch_of(FOUR_BAR, {"do": "mirror", "objects": ["AB", "BC", "CD"], "axis": axis})
    before, after = places_in_motion(FOUR_BAR), places_in_motion(patch.text)
    for name, place in before.items():
        image = np.array(place) - 2 * np.dot(place, pole) * np.array(pole)
        assert after[name] == pytest.approx(image, abs=2e-6)
    upright = patch_of(FOUR_BAR, {"do": "mirror", "objects": ["B", "C"], "axis": "y"})
    swapped = places_in_motion(upright.text)
    assert arc(swapped["B"], swapped["C"]) == pytest.approx(arc(at(0, 30), at(60, 45)), abs=4e-6)


def test_two_joints_become_one():
    """The rod that was drawn apart ends at the joint it is dropped on."""
    rod = {"do": "add_link", "at": at(60, 45), "to": at(70, 60), "from_point": "C"}
    joined = patch_of(FOUR_BAR, rod, {"do": "join", "points": ["E", "B"]})
    tables = tomllib.loads(joined.text)
    assert "E" not in tables["points"] and tables["links"]["CE"]["points"] == ["C", "B"]
    assert places_in_motion(joined.text)["B"] == pytest.approx(at(0, 30), abs=1e-6)


SPHERICAL = ["spherical-four-bar", "spherical-crank-rocker-rigid", "spherical-crank-rocker-touching"]


@pytest.mark.parametrize("name", SPHERICAL)
def test_arcs_and_angles_follow_a_dragged_joint(name, ask):
    """Every joint stands where it is put and the others where they stood, in the motion of the file that is written."""
    text = example_text(name)
    before = places_in_motion(text)
    random = np.random.default_rng(28)
    for point in before:
        goal = before[point] + 0.1 * random.standard_normal(3)
        goal /= np.linalg.norm(goal)
        patch = patch_of(text, {"do": "move_point", "point": point, "to": list(goal)})
        after = places_in_motion(patch.text)
        for other, place in before.items():
            expected = goal if other == point else place
            assert after[other] == pytest.approx(expected, abs=4e-6), (point, other)
    frame = ask("drag", text=text, mode="edit", point="B", to=list(at(3, 16)))
    header, _arrays = read_frame(frame)
    assert header["values"]["links.AB.length"] == pytest.approx(arc(at(3, 16), before["A"]), abs=1e-6)
    scene = ask("read", text=text)["scene"]
    assert all(point["handles"]["edit"] for point in scene["points"])


def test_a_locked_arc_holds_its_joint():
    text = patch_of(
        example_text("spherical-four-bar"), {"do": "lock", "path": "links.BC.length", "on": True}
    ).text
    after = places_in_motion(patch_of(text, {"do": "move_point", "point": "C", "to": at(10, 50)}).text)
    assert arc(after["B"], after["C"]) == pytest.approx(math.pi / 4, abs=4e-6)


REFUSALS = [
    (FOUR_BAR, {"do": "add_link", "at": [0, 1], "to": at(1, 1)}, "three numbers"),
    (FOUR_BAR, {"do": "add_link", "at": [0, 0, 0], "to": at(1, 1)}, "centre"),
    (FOUR_BAR, {"do": "add_guide", "at": at(60, 45), "to": at(60, 45), "point": "C"}, "too short"),
    (FOUR_BAR, {"do": "move_point", "point": "C", "to": at(0, 30)}, "coincide"),
    (FOUR_BAR, {"do": "duplicate", "objects": ["AB"], "about": [0, 1]}, "three numbers"),
    (FOUR_BAR, {"do": "duplicate", "objects": ["AB"], "angle": "x"}, "number"),
    (FOUR_BAR, {"do": "mirror", "objects": ["C"], "axis": [at(0, 10), at(0, 10)]}, "axis"),
    (FOUR_BAR, {"do": "join", "points": ["A", "B"]}, "both belong"),
    (example_text("spherical-four-bar"), {"do": "duplicate", "objects": ["AB"]}, "arcs and angles"),
    (
        example_text("spherical-four-bar"),
        {"do": "add_link", "at": at(0, 0), "to": at(1, 1)},
        "arcs and angles",
    ),
    (example_text("spherical-four-bar"), {"do": "move_point", "point": "B", "to": [1, 0, 0]}, "coincide"),
]


@pytest.mark.parametrize(("text", "operation", "said"), REFUSALS)
def test_what_cannot_be_is_refused_and_nothing_changes(text, operation, said):
    patch = Patch(text, HERE)
    with pytest.raises(InputError, match=said):
        apply_operation(patch, operation)
    assert patch.text == text


def test_pitch_circles_and_great_circles_are_in_the_scene(ask):
    """Bevel wheels touch along z2 A + z1 B; wheels in the plane at the place that divides the distance by the teeth."""
    bevel = ask("read", text=example_text("bevel-pair"))["scene"]
    contact = 40 * np.array([1.0, 0, 0]) + 20 * np.array([0, 1.0, 0])
    contact /= np.linalg.norm(contact)
    radii = {wheel["link"]: wheel["radius"] for wheel in bevel["wheels"]}
    assert radii == pytest.approx({"AE": arc(contact, [1, 0, 0]), "BF": arc(contact, [0, 1, 0])}, abs=1e-12)
    train = ask("read", text=example_text("planetary-gear-train"))["scene"]["wheels"]
    assert [wheel["link"] for wheel in train] == ["sun", "planet", "planet", "frame"]
    sun, planet, again, ring = (wheel["radius"] for wheel in train)
    assert sun / planet == pytest.approx(24 / 18) and planet == pytest.approx(again)
    assert ring == pytest.approx(sun + 2 * planet)  # the ring is around both
    plate = ask("read", text=example_text("wobble-plate"))["scene"]["guides"][0]["circle"]
    assert plate == {"pole": pytest.approx([0, 1, 0]), "radius": pytest.approx(math.pi / 2)}
