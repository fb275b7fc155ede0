"""Operations of the workbench write what a person would write; a drawing moves as it is drawn."""

from __future__ import annotations

import difflib
import math
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.app.documents import read_document
from centrode.app.operations import apply_operation
from centrode.app.patches import Patch
from centrode.app.sketch import SketchParts
from centrode.errors import InputError
from centrode.model.examples import example_names, example_text

HERE = Path()

FOUR_BAR = """\
[points]
A = [0, 0]
B = [1, 0.5]
C = [4, 2]
D = [4, 0]

[frame]
points = ["A", "D"]

[links.AB]

[links.BC]

[links.CD]

[[drives]]
link = "AB"
speed = 1
"""


def patch_of(text, *operations):
    patch = Patch(text, HERE)
    for operation in operations:
        apply_operation(patch, operation)
    return patch


def test_a_four_bar_from_an_empty_canvas_takes_five_gestures():
    patch = patch_of(
        "",
        {"do": "add_link", "at": [0, 0], "to": [1, 0.5]},
        {"do": "add_link", "at": [1, 0.5], "to": [4, 2], "from_point": "B"},
        {"do": "add_link", "at": [4, 2], "to": [4, 0], "from_point": "C"},
        {"do": "set_row", "object": "AB", "row": "drive", "on": True},
        {"do": "set_row", "object": "D", "row": "ground", "on": True},
    )
    assert patch.text == FOUR_BAR
    mechanism = ct.parse_mechanism(patch.text)
    # the places that were drawn are those of the first sample; the crank turns about A at 1 rad/s
    start = ct.motion(mechanism, 5).isel(sample=0)
    assert start.position.sel(point="C").values == pytest.approx([4, 2], abs=1e-12)
    assert start.velocity.sel(point="B").values == pytest.approx([-0.5, 1.0], abs=1e-12)


def test_a_slider_crank_is_drawn():
    patch = patch_of(
        "",
        {"do": "add_link", "at": [0, 0], "to": [0.3, 0.4]},
        {"do": "add_link", "at": [0.3, 0.4], "to": [1.5, 0], "from_point": "B"},
        {"do": "add_guide", "at": [1.5, 0], "direction": 0.0, "point": "C"},
        {"do": "set_row", "object": "AB", "row": "drive", "on": True, "value": "60 rpm"},
    )
    motion = ct.motion(ct.parse_mechanism(patch.text), 721)
    stroke = float(motion.slide.max() - motion.slide.min())
    assert stroke == pytest.approx(1.0, abs=1e-4)  # twice the crank of 0.5, in line
    assert 'speed = "60 rpm"' in patch.text


def test_dropping_on_a_joint_makes_a_hinge_and_joining_too():
    apart = patch_of(FOUR_BAR, {"do": "add_link", "at": [1, 0.5], "to": [2, 3]})
    assert SketchParts(apart.document).owners("E") == ["EF"]
    apply_operation(apart, {"do": "join", "points": ["E", "B"]})
    assert sorted(SketchParts(apart.document).owners("B")) == ["AB", "BC", "EF"]
    hinged = patch_of(FOUR_BAR, {"do": "add_link", "at": [1, 0.5], "to": [2, 3], "from_point": "B"})
    assert sorted(SketchParts(hinged.document).owners("B")) == ["AB", "BC", "BE"]


def test_a_joint_is_hinged_to_a_link_where_it_stands():
    """The middle of a scissor: both links have it, and a lock of a length that is none any more is taken away."""
    patch = patch_of(
        "",
        {"do": "add_link", "at": [0, 0], "to": [2, 1]},
        {"do": "add_link", "at": [2, 0], "to": [0, 1]},
        {"do": "add_point", "link": "AB", "at": [1, 0.5]},
        {"do": "lock", "path": "links.CD.length", "on": True},
        {"do": "add_point", "link": "CD", "point": "E"},
    )
    sketch = SketchParts(patch.document)
    assert sketch.owners("E") == ["AB", "CD"] and sketch.places["E"] == (1.0, 0.5)
    assert not sketch.marks["locked"]


def test_a_joint_that_does_not_come_where_it_was_put_says_why():
    locked = patch_of(FOUR_BAR, {"do": "lock", "path": "links.BC.length", "on": True})
    apply_operation(locked, {"do": "move_point", "point": "C", "to": [5, 4]})
    assert locked.held == "the locked length holds"
    assert patch_of(FOUR_BAR, {"do": "move_point", "point": "C", "to": [4.1, 2]}).held == ""


def test_a_point_on_a_link_makes_a_plate():
    text = patch_of(FOUR_BAR, {"do": "add_point", "link": "BC", "at": [2, 3]}).text
    mechanism = ct.parse_mechanism(text)
    assert list(mechanism.links["BC"].coordinates) == ["B", "C", "E"]
    explicit = patch_of(example_text("crank-rocker"), {"do": "add_point", "link": "AB", "at": [1.0, 1.0]})
    mechanism = ct.parse_mechanism(explicit.text)
    start = ct.motion(mechanism, 2).position.isel(sample=0)
    assert start.sel(point="C").values == pytest.approx([1.0, 1.0], abs=1e-5)


def test_a_link_from_another_link_is_one_step():
    """Both ends on links: each becomes a point of that link, and what is refused leaves no point behind."""
    before = patch_of(FOUR_BAR, {"do": "add_link", "at": [0, 3], "to": [4, 4]})
    line = {"do": "add_link", "at": [2.5, 1.25], "to": [2, 3.5], "from_link": "BC", "to_link": "EF"}
    patch = patch_of(before.text, line)
    sketch = SketchParts(patch.document)
    assert sketch.links["BC"] == ("B", "C", "G") and sketch.links["EF"] == ("E", "F", "H")
    assert sketch.links["GH"] == ("G", "H")
    assert [sketch.places[name] for name in "GH"] == [(2.5, 1.25), (2.0, 3.5)]
    with pytest.raises(InputError, match="both belong to BC"):
        apply_operation(before, {**line, "to_link": "BC"})
    assert before.text == patch_of(FOUR_BAR, {"do": "add_link", "at": [0, 3], "to": [4, 4]}).text


def test_a_joint_slides_along_a_link():
    """The lever of a shaper: it turns as the formula of its triangle says, by atan2 of the pin from its pivot."""
    patch = patch_of(
        "",
        {"do": "add_link", "at": [0, 0], "to": [0.3, 0]},
        {"do": "add_link", "at": [0, -0.5], "to": [0.6, 0.5]},
        {"do": "add_guide", "at": [0.3, 0], "point": "B", "on": "CD", "direction": [-0.6, -1.0]},
        {"do": "set_row", "object": "AB", "row": "drive", "on": True},
        {"do": "set_row", "object": "C", "row": "ground", "on": True},
    )
    assert patch.document.tables["guides"] == [{"point": "B", "on": "CD", "direction": [1, 0]}]
    turns = ct.motion(ct.parse_mechanism(patch.text), 25)
    pin, tip = (turns.position.sel(point=name).values for name in "BD")
    expected = [math.atan2(y + 0.5, x) for x, y in pin]
    assert [math.atan2(y + 0.5, x) for x, y in tip] == pytest.approx(expected, abs=1e-9)
    # in a file with lengths the line is written in the axes of the link
    text = patch_of(example_text("crank-rocker"), {"do": "add_link", "at": [1, -3], "to": [2, 3]}).text
    patch = patch_of(text, {"do": "add_guide", "at": [1, 0], "direction": [1, 6], "point": "A", "on": "CE"})
    (guide,) = patch.document.tables["guides"]
    along, across = 1 / math.sqrt(37), 6 / math.sqrt(37)
    assert guide["through"] == pytest.approx([3 * across, 3 * along], abs=1e-4)


def test_a_frame_pin_holds_the_slot_of_a_link():
    """An oscillating slide: the rod BC goes through the pin D at each angle of the crank."""
    patch = patch_of(
        "",
        {"do": "add_link", "at": [0, 0], "to": [0.3, 0]},
        {"do": "add_link", "at": [0.3, 0], "to": [2, 0], "from_point": "B"},
        {"do": "set_row", "object": "AB", "row": "drive", "on": True},
    )
    text = patch.text.replace("C = [2, 0]", "C = [2, 0]\nD = [1, 0]").replace('["A"]', '["A", "D"]')
    patch = patch_of(text, {"do": "add_guide", "at": [1, 0], "direction": [1, 0], "point": "D", "on": "BC"})
    turns = ct.motion(ct.parse_mechanism(patch.text), 25)
    b, c = (turns.position.sel(point=name).values for name in "BC")
    across = (c[:, 0] - b[:, 0]) * (0 - b[:, 1]) - (c[:, 1] - b[:, 1]) * (1 - b[:, 0])
    assert abs(across).max() < 1e-9


def test_a_point_on_a_slanted_rod_keeps_its_ratio_after_many_drags():
    """Coordinates are rounded at each of them: the middle stays within that rounding."""
    text = patch_of(FOUR_BAR, {"do": "add_point", "link": "BC", "at": [2.5, 1.25]}).text
    for k in range(8):
        to = [4 + 0.3 * math.cos(0.37 * k), 2 + 0.2 * math.sin(0.37 * k)]
        text = patch_of(text, {"do": "move_point", "point": "C", "to": to}).text
    b, c, e = (SketchParts(read_document(text, HERE)).places[name] for name in "BCE")
    assert e == pytest.approx([(x + y) / 2 for x, y in zip(b, c, strict=True)], abs=4e-5)


@pytest.mark.parametrize(
    "operation",
    [
        {"do": "set_row", "object": "B", "row": "fixed", "on": True},
        {"do": "set_row", "object": "C", "row": "trace", "on": True},
        {"do": "set_row", "object": "CD", "row": "mass", "on": True},
        {"do": "set_row", "object": "C", "row": "load", "on": True},
        {"do": "lock", "path": "links.BC.length", "on": True},
    ],
)
def test_rows_that_are_switched_off_again_leave_every_byte(operation):
    on = patch_of(FOUR_BAR, operation)
    assert on.text != FOUR_BAR
    assert patch_of(on.text, {**operation, "on": False}).text == FOUR_BAR


def test_renaming_keeps_what_the_mechanism_does():
    text = example_text("six-bar-press")
    before = ct.motion(ct.parse_mechanism(text), 13)
    patch = patch_of(
        text,
        {"do": "rename", "object": "H", "name": "ram"},
        {"do": "rename", "object": "OA", "name": "crank"},
        {"do": "rename", "object": "slider", "name": "block"},
    )
    after = ct.motion(ct.parse_mechanism(patch.text), 13)
    assert after.position.sel(point="ram").values == pytest.approx(before.position.sel(point="H").values)
    removed = [
        line for line in difflib.ndiff(text.splitlines(), patch.text.splitlines()) if line.startswith("- ")
    ]
    assert not any(line[2:].lstrip().startswith("#") for line in removed)


def test_deleting_takes_what_names_the_object():
    text = example_text("six-bar-press")
    patch = patch_of(text, {"do": "delete", "objects": ["H"]})
    tables = patch.document.tables
    assert "guides" not in tables and "loads" not in tables and "slider" not in tables["links"]
    assert text.splitlines()[:11] == patch.text.splitlines()[:11]  # the comments of its author
    four_bar = patch_of(FOUR_BAR, {"do": "delete", "objects": ["AB", "BC", "CD"]})
    assert four_bar.document.tables.get("links", {}) == {}


def test_what_loses_its_position_stays_where_it_was():
    text = example_text("crank-rocker")
    before = SketchParts(read_document(text, HERE))
    patch = patch_of(text, {"do": "delete", "objects": ["AB"]})
    after = SketchParts(patch.document)
    assert after.places["B"] == pytest.approx(before.places["B"], abs=1e-5)
    assert after.places["A"] == pytest.approx(before.places["A"], abs=1e-5)


def test_mirroring_twice_gives_the_same_bytes():
    mirror = {"do": "mirror", "objects": ["AB", "BC", "CD"], "axis": "x"}
    once = patch_of(FOUR_BAR, mirror)
    assert SketchParts(once.document).places["B"] == pytest.approx((1.0, 1.5))
    assert ct.parse_mechanism(patch_of(once.text, mirror).text) == ct.parse_mechanism(FOUR_BAR)


def test_duplicates_stand_beside():
    patch = patch_of(FOUR_BAR, {"do": "duplicate", "objects": ["AB"], "by": [0, -2]})
    sketch = SketchParts(patch.document)
    copies = [name for name in patch.named if name in sketch.points]
    assert [sketch.places[name] for name in copies] == [(0, -2), (1, -1.5)]
    assert copies[0] in sketch.frame_points


@pytest.mark.parametrize(
    ("name", "link"), [("crank-rocker", "AB"), ("six-bar-press", "DH"), ("pantograph", None)]
)
def test_copies_of_links_with_lengths_hang_on_a_point_of_the_frame(name, link):
    """Also of links that have none: every point of the copy stands as far away as the first one."""
    text = example_text(name)
    before = SketchParts(read_document(text, HERE))
    chosen = (
        [link]
        if link
        else [one for one, points in before.links.items() if not set(points) & set(before.frame_points)]
    )
    patch = patch_of(text, {"do": "duplicate", "objects": chosen, "by": [0.3, -0.2]})
    after = SketchParts(patch.document)
    originals = list(dict.fromkeys(point for one in chosen for point in before.links[one]))
    copies = [one for one in patch.named if one in after.points]
    assert len(copies) == len(originals) and set(copies) & set(after.frame_points)
    for old, new in zip(originals, copies, strict=True):
        x, y = before.places[old]
        assert after.places[new] == pytest.approx((x + 0.3, y - 0.2), abs=2e-4 * before.size)


@pytest.mark.parametrize("name", ["crank-rocker", "six-bar-press", "slider-crank-offset", "watt-six-bar"])
def test_a_length_that_is_typed_holds_the_others(name):
    text = example_text(name)
    sketch = SketchParts(read_document(text, HERE))
    link = next(one for one in sketch.links if sketch.length(one) is not None)
    factor = {"mm": 1000.0, "cm": 100.0}.get(sketch.tables.get("display", {}).get("length"), 1.0)
    length = sketch.length(link) * 1.05
    patch = patch_of(text, {"do": "set", "path": f"links.{link}.length", "value": f"{length * factor!r}"})
    after = SketchParts(patch.document)
    assert after.length(link) == pytest.approx(length, rel=1e-12)
    for other in sketch.links:
        if other != link and sketch.length(other) is not None:
            assert after.length(other) == sketch.length(other)
    assert patch.document.prepared is not None


def test_a_length_in_points_moves_what_follows():
    patch = patch_of(FOUR_BAR, {"do": "set", "path": "links.AB.length", "value": "1.4"})
    before, after = SketchParts(read_document(FOUR_BAR, HERE)), SketchParts(patch.document)
    assert after.length("AB") == pytest.approx(1.4, abs=2e-5)
    assert after.length("BC") == pytest.approx(before.length("BC"), abs=3e-5)
    assert after.length("CD") == pytest.approx(before.length("CD"), abs=3e-5)


def test_units_are_those_of_the_author():
    text = FOUR_BAR.replace("A = [0, 0]", 'A = ["0 mm", "0 mm"]').replace(
        "B = [1, 0.5]", 'B = ["1000 mm", "50 cm"]'
    )
    patch = patch_of(text, {"do": "move_point", "point": "B", "to": [0.9, 0.61]})
    assert 'B = ["900 mm", "61 cm"]' in patch.text


SLIDER = [
    {"do": "add_link", "at": [0, 0], "to": [0.3, 0.4]},
    {"do": "add_link", "at": [0.3, 0.4], "to": [1.5, 0.5], "from_point": "B"},
    {"do": "add_guide", "at": [1.5, 0.5], "direction": [3, 1], "point": "C"},
    {"do": "set_row", "object": "AB", "row": "drive", "on": True},
]


def test_a_copy_of_a_slider_slides():
    """Chosen with its guide it is the same mechanism beside: driven alike, its points move alike."""
    chosen = {"do": "duplicate", "objects": ["AB", "BC", "guide 1"], "by": [5, 0]}
    text = patch_of("", *SLIDER, chosen, {"do": "set_row", "object": "DE", "row": "drive", "on": True}).text
    turns = ct.motion(ct.parse_mechanism(text), 13).position
    beside = turns.sel(point="F").values - turns.sel(point="C").values
    assert beside == pytest.approx(np.broadcast_to([5.0, 0.0], beside.shape), abs=1e-9)


@pytest.mark.parametrize("name", ["whitworth-quick-return", "slider-crank-offset", "six-bar-press", "shaper"])
def test_a_copy_of_a_mechanism_moves_as_the_mechanism_does(name):
    """With its slots and lines, drawn by coordinates or by lengths and angles: driven alike, its points move alike."""
    text = example_text(name)
    before = SketchParts(read_document(text, HERE))
    chosen = [*before.links, *(f"guide {k + 1}" for k in range(len(before.guides)))]
    patch = patch_of(text, {"do": "duplicate", "objects": chosen, "by": [9, 0]})
    after = SketchParts(patch.document)
    assert len(after.guides) == 2 * len(before.guides)
    originals = list(dict.fromkeys(point for one in before.links for point in before.links[one]))
    copies = dict(zip(originals, (one for one in patch.named if one in after.points), strict=True))
    crank = before.tables["drives"][0]["link"]
    turned = list(after.links)[len(before.links) + list(before.links).index(crank)]
    drive = {
        key: value
        for key, value in before.tables["drives"][0].items()
        if key not in ("link", "name", "start")
    }
    tables = {**after.tables, "drives": [before.tables["drives"][0], {"link": turned, **drive}]}
    tables = {key: value for key, value in tables.items() if key in ("frame", "links", "guides", "drives")}
    places = ct.motion(ct.Mechanism(**tables), 25).position
    for old, new in copies.items():
        beside = places.sel(point=new).values - places.sel(point=old).values
        assert beside == pytest.approx(np.broadcast_to([9.0, 0.0], beside.shape), abs=2e-4 * before.size)


@pytest.mark.parametrize("axis", ["x", "y"])
def test_a_mirror_image_slides_on_the_image_of_its_line(axis):
    """By the closed form: the slider's line has the other slope, so mirrored backward turns give mirrored places."""
    text = patch_of("", *SLIDER).text
    image = patch_of(text, {"do": "mirror", "objects": ["AB", "BC", "guide 1"], "axis": axis}).text
    along = "-18.4349 deg"
    assert read_document(image, HERE).tables["guides"][0]["direction"] == along
    first = ct.motion(ct.parse_mechanism(text), 13).position.sel(point="C").values
    second = ct.motion(ct.parse_mechanism(image), 13).position.sel(point="C").values[::-1]
    flip = 1 if axis == "x" else 0
    middle = (first[0] + second[0])[flip] / 2
    assert second[:, flip] == pytest.approx(2 * middle - first[:, flip], abs=2e-4)
    assert second[:, 1 - flip] == pytest.approx(first[:, 1 - flip], abs=2e-4)


def test_a_mirror_image_of_a_line_with_a_place_of_its_own():
    text = example_text("slider-crank-offset")
    chosen = {"do": "mirror", "objects": [*SketchParts(read_document(text, HERE)).links], "axis": "x"}
    once = patch_of(text, chosen)
    before, after = (ct.motion(ct.parse_mechanism(one), 9) for one in (text, once.text))
    assert float(after.slide.max() - after.slide.min()) == pytest.approx(
        float(before.slide.max() - before.slide.min()), rel=1e-3
    )
    assert once.document.tables["guides"] != read_document(text, HERE).tables["guides"]


@pytest.mark.parametrize(
    "name",
    [
        "four-bar-and-slider",  # places that follow from initial angles
        "oscillating-cylinder",  # a slot in a link whose axes stay as they are
        "whitworth-quick-return",
        "inverted-slider-crank",  # and in one whose axes are mirrored
        "catapult",  # a slot in a link of one point
    ],
)
def test_everything_stands_at_its_mirror_image(name):
    text = ct.mechanism_text(ct.example(name))
    before = SketchParts(read_document(text, HERE))
    image = patch_of(text, {"do": "mirror", "objects": [*before.points], "axis": [[0.1, 0], [0.1, 1]]})
    stand = image.document.require_prepared().assembled.positions.points
    for point, (x, y) in before.places.items():
        assert tuple(map(float, stand[point])) == pytest.approx((0.2 - x, y), abs=3e-4 * before.size)


REFUSALS = [
    ({"do": "add_link", "at": [0, 0], "to": [0, 0]}, "the link is too short"),
    ({"do": "add_link", "at": [0, 0], "to": [1, 1], "from_point": "A", "to_point": "B"}, "both belong to AB"),
    ({"do": "set_row", "object": "A", "row": "guide", "on": True}, "does not slide"),
    ({"do": "set_row", "object": "BC", "row": "drive", "on": True}, "a driven link turns about a point"),
    ({"do": "move_point", "point": "Q", "to": [0, 0]}, 'unknown point "Q"'),
    ({"do": "move_point", "point": "B", "to": [0, float("nan")]}, "a place is two numbers"),
    ({"do": "rename", "object": "B", "name": "A"}, "is taken already"),
    ({"do": "rename", "object": "B", "name": "a/b"}, "a name"),
    ({"do": "set", "path": "links.XY.length", "value": 1}, "there is no"),
    ({"do": "set", "path": "links.AB.length", "value": "soon"}, "expected a length"),
    ({"do": "set", "path": "links.AB.length", "value": "-1"}, "AB: length must be positive"),
    ({"do": "set", "path": "links.BC.length", "value": "35 cm"}, "a group .* does not close any more"),
    ({"do": "add_guide", "at": [1, 1], "point": "B", "on": "BC"}, "belongs to BC: it does not slide"),
    ({"do": "add_guide", "at": [1, 1], "point": "B", "on": "XY"}, 'unknown link "XY"'),
    ({"do": "something"}, "does not know this operation"),
    ({}, "does not know this operation"),
]


@pytest.mark.parametrize(("operation", "said"), REFUSALS)
def test_what_cannot_be_is_refused_and_nothing_changes(operation, said):
    patch = Patch(FOUR_BAR, HERE)
    with pytest.raises(InputError, match=said.replace("(", r"\(")):
        apply_operation(patch, operation)
    assert patch.text == FOUR_BAR


@pytest.mark.parametrize("name", example_names())
def test_deleting_and_renaming_any_object_keeps_the_comments(name):
    text = example_text(name)
    sketch = SketchParts(read_document(text, HERE))
    comments = [line for line in text.splitlines() if line.lstrip().startswith("#")]
    for object_name in [*sketch.points, *sketch.links][:: max(1, len(sketch.points) // 4)]:
        for operation in (
            {"do": "rename", "object": object_name, "name": "Z9"},
            {"do": "delete", "objects": [object_name]},
        ):
            patch = Patch(text, HERE)
            try:
                apply_operation(patch, operation)
            except InputError:
                assert patch.text == text
                continue
            assert [line for line in patch.text.splitlines() if line.lstrip().startswith("#")] == comments
            if operation["do"] == "rename":
                assert patch.document.prepared is not None


def test_undo_is_the_text_before():
    texts = [FOUR_BAR]
    for k in range(100):
        angle = 0.06 * k
        operation = {"do": "move_point", "point": "C", "to": [4 + math.cos(angle), 2 + 0.5 * math.sin(angle)]}
        texts.append(patch_of(texts[-1], operation).text)
    assert len(set(texts)) > 90
    # every state is a text, and reading it does not change it
    assert all(read_document(text, HERE).text == text for text in texts)
