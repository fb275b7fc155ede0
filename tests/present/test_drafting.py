"""Drawings at full size: dimensions in the file, what covers what, layers, a clean audit, the same bytes."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import ezdxf
import numpy as np
import pytest
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

import centrode as ct
from centrode.present.drafting.board import BoardWords, Cover, Drawing, Ring, Stroke, visible
from centrode.present.drafting.dxf import write_drawing_dxf
from centrode.present.drafting.sheet import mechanism_drawing
from centrode.present.drafting.svg import MARGIN, drawing_svg, write_drawing_svg
from centrode.present.drawing import NAME_POINTS
from centrode.present.linkage_scene import scene_of

SVG = "{http://www.w3.org/2000/svg}"
RINGS = 1e-9
"""Places are in millimetres; a micrometre's millionth is rounding of the largest drawings."""


def drawing_of(name: str, **how: object) -> tuple[ct.Mechanism, object, Drawing]:
    mechanism = ct.example(name)
    motion = ct.motion(mechanism)
    return mechanism, motion, mechanism_drawing(mechanism, motion, 0, **how)


EVERY_SIGN = (
    "cardan-gear", "excavator-arm", "hookes-joint", "inverted-slider-crank", "planetary-gear-train",
    "planetary-hypocycloid", "rack-and-pinion", "rolling-wheel-rod", "scissor-lift-cylinder", "scotch-yoke",
    "six-bar-press", "slider-between-cranks-locked", "three-crank-parallelogram",
)  # fmt: skip


@pytest.mark.parametrize("name", EVERY_SIGN)
def test_every_planar_mechanism_is_drawn_clean(name: str, tmp_path: Path) -> None:
    mechanism = ct.example(name)
    if mechanism.space == "sphere":
        with pytest.raises(ct.NotComputedYet):
            mechanism_drawing(mechanism, ct.motion(mechanism, 3))
        return
    motion = ct.motion(mechanism, 13)
    drawing = mechanism_drawing(mechanism, motion, 0, mechanism.moving_points)
    file = tmp_path / "a.dxf"
    write_drawing_dxf(drawing, file)
    document = ezdxf.readfile(file)
    audit = document.audit()
    assert not audit.errors
    assert not audit.fixes
    assert document.units == 4
    layers = {entity.dxf.layer for entity in document.modelspace()}
    assert {"frame", "links", "title"} <= layers
    ET.fromstring(drawing_svg(drawing))


@pytest.mark.parametrize("name", ["six-bar-press", "andrews-squeezer", "jansen-leg"])
def test_hinges_are_as_far_apart_as_the_links_are_long(name: str, tmp_path: Path) -> None:
    mechanism, _motion, drawing = drawing_of(name)
    write_drawing_dxf(drawing, tmp_path / "a.dxf")
    circles = [
        np.array([*one.dxf.center][:2])
        for one in ezdxf.readfile(tmp_path / "a.dxf").modelspace().query("CIRCLE")
    ]
    assert circles
    for link in mechanism.links.values():
        if link.length is not None:
            apart = [math.dist(a, b) for a in circles for b in circles]
            assert min(abs(one - 1e3 * link.length) for one in apart) <= RINGS * 1e3 * link.length


def test_lines_end_at_the_circles_of_hinges() -> None:
    _mechanism, _motion, drawing = drawing_of("crank-rocker")
    strokes, rings = visible(drawing)
    hinges = [ring for ring in rings if ring.layer == "hinges"]
    assert len(hinges) == 4
    inradius = math.cos(math.pi / 48)  # of the polygon that stands for a circle
    for stroke in strokes:
        if stroke.layer == "links":
            for ring in hinges:
                away = np.hypot(*(stroke.places - ring.centre).T)
                assert away.min() >= ring.radius * inradius * (1 - 1e-9)


def test_what_lies_under_a_square_is_hidden() -> None:
    square = Cover(np.array([[1.0, -1.0], [3.0, -1.0], [3.0, 1.0], [1.0, 1.0]]), 2.0)
    line = np.array([[0.0, 0.0], [2.0, 0.0], [4.0, 0.0]])
    strokes = [
        Stroke("links", line, 1.0),
        Stroke("links", line + np.array([0.0, 0.5]), 3.0),
        Stroke("links", line + np.array([0.0, 2.0])),
    ]
    found, rings = visible(Drawing(strokes, [Ring("links", (2.0, 0.0), 5.0, 1.0)], [], [square]))
    assert [part.places.tolist() for part in found] == [
        [[0.0, 0.0], [1.0, 0.0]],
        [[3.0, 0.0], [4.0, 0.0]],
        (line + np.array([0.0, 0.5])).tolist(),
        (line + np.array([0.0, 2.0])).tolist(),
    ]
    assert len(rings) == 1


def test_a_circle_that_is_partly_hidden_becomes_an_arc() -> None:
    left = Cover(np.array([[-9.0, -9.0], [0.0, -9.0], [0.0, 9.0], [-9.0, 9.0]]), 2.0)
    found, rings = visible(Drawing([], [Ring("links", (0.0, 0.0), 5.0, 1.0)], [], [left]))
    assert not rings
    places = np.concatenate([part.places for part in found])
    assert places[:, 0].min() >= -1e-12
    assert np.hypot(*places.T).max() <= 5.0 * (1 + 1e-12)


def test_places_without_a_number_break_a_line() -> None:
    line = np.array([[0.0, 0.0], [1.0, 0.0], [np.nan, np.nan], [2.0, 0.0], [3.0, 0.0]])
    found, _rings = visible(Drawing([Stroke("paths", line)]))
    assert [part.places.tolist() for part in found] == [[[0.0, 0.0], [1.0, 0.0]], [[2.0, 0.0], [3.0, 0.0]]]


def test_paths_and_centrodes_are_those_of_the_motion() -> None:
    mechanism = ct.example("elliptic-trammel")
    motion = ct.motion(mechanism, 91)
    link = mechanism.link_names[0]
    pair = ct.centrodes(motion, link)
    drawing = mechanism_drawing(mechanism, motion, 10, ["P"], [pair])
    (path,) = [stroke for stroke in drawing.strokes if stroke.layer == "paths"]
    assert (
        np.abs(path.places - 1e3 * motion.position.sel(point="P")).max() <= 1e-12 * np.abs(path.places).max()
    )
    fixed, moving = (stroke.places for stroke in drawing.strokes if stroke.layer == "centrodes")
    length = 1e3 * math.dist(*list(mechanism.links[link].coordinates.values())[:2])
    # Cardan's circles: the moving one, of half the size, touches the fixed one at the instant centre
    assert np.nanmax(np.abs(np.hypot(*fixed.T) - length)) <= 1e-9 * length
    assert np.nanmin(np.hypot(*(fixed - moving[10]).T)) <= 1e-9 * length


def test_pitch_circles_touch() -> None:
    _mechanism, _motion, drawing = drawing_of("geared-five-bar")
    first, second = (ring for ring in drawing.rings if ring.layer == "pitch-circles")
    apart = math.dist(first.centre, second.centre)
    assert first.radius + second.radius == pytest.approx(apart, rel=1e-12)
    assert first.radius / second.radius == pytest.approx(2.0, rel=1e-12)  # the second turns twice as fast


def test_a_driving_cam_stands_on_its_own_layer() -> None:
    """The roller of 12 mm at the arm's end touches the profile; the axis is 110 mm from the pivot; no line twice."""
    mechanism = ct.example("cam-driven-linkage")
    motion = ct.motion(mechanism, at=[0.1])
    drawing = mechanism_drawing(mechanism, motion, 0)
    (roller,) = [ring for ring in drawing.rings if ring.layer == "cams"]
    arm = 1e3 * motion.position.sel(point="R").to_numpy()[0]
    assert roller.radius == pytest.approx(12.0, rel=1e-12)
    assert np.abs(np.array(roller.centre) - arm).max() <= RINGS
    strokes = [stroke.places for stroke in drawing.strokes if stroke.layer == "cams"]
    profile, mark = sorted(strokes, key=len, reverse=True)  # and no arm: the link has its line
    step = np.hypot(*np.diff(profile, axis=0).T).max()
    gap = np.hypot(*(profile - arm).T).min() - 12.0
    assert -RINGS <= gap <= (step / 2) ** 2 / 12.0
    hub = mark[0]
    assert np.hypot(*hub) == pytest.approx(110.0, rel=1e-12)
    assert any(np.abs(np.array(r.centre) - hub).max() <= RINGS for r in drawing.rings if r.layer == "hinges")


def test_a_face_that_no_link_has_is_drawn() -> None:
    text = """
    kind = "cam"
    cam = { base_radius = "30 mm", speed = "60 rpm" }
    follower = { kind = "translating", contact = "flat" }
    segments = [
        { angle = "180 deg", to = "5 mm", curve = "cycloidal" }, { angle = "180 deg", to = 0, curve = "cycloidal" }
    ]
    """
    linkage = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"AB": {"length": 0.05}, "OB": {"length": 0.06}},
        guides=[{"point": "A", "on": "frame", "through": [0.07, 0], "direction": [0, 1]}],
        drives=[{"guide": "A", "start": 0, "cam": ct.parse_cam(text)}],
        assembly={"sides": {"B": "left"}},
    )
    motion = ct.motion(linkage, at=[0.125])
    drawing = mechanism_drawing(linkage, motion, 0)
    lines = [one.places for one in drawing.strokes if one.layer == "cams" and len(one.places) == 2]
    (face,) = [line for line in lines if abs(line[0, 1] - line[1, 1]) <= RINGS]
    lift = 5.0 * (0.25 - math.sin(math.tau / 4) / math.tau)  # cycloidal, at a quarter of the rise
    assert face[0, 1] == pytest.approx(lift, abs=RINGS)


def test_the_same_drawing_gives_the_same_bytes(tmp_path: Path) -> None:
    _mechanism, _motion, drawing = drawing_of("six-bar-press")
    for name in ("a", "b"):
        write_drawing_dxf(drawing, tmp_path / f"{name}.dxf")
        write_drawing_svg(drawing, tmp_path / f"{name}.svg")
    for kind in ("dxf", "svg"):
        assert (tmp_path / f"a.{kind}").read_bytes() == (tmp_path / f"b.{kind}").read_bytes()


def test_processes_that_hash_texts_differently_write_the_same_bytes(tmp_path: Path) -> None:
    program = """
import centrode as ct
from centrode.cams.followers.manufacture import follower_outlines
from centrode.present.drafting.dxf import write_drawing_dxf
from centrode.present.drafting.sheet import mechanism_drawing
from centrode.render.outlines import write_outlines_dxf
press = ct.example("six-bar-press")
write_drawing_dxf(mechanism_drawing(press, ct.motion(press, at=[0.0])), "drawing.dxf")
cam = ct.follower_cam(ct.example("valve-cam"))
write_outlines_dxf(follower_outlines(cam), "profile.dxf")
"""
    written = []
    for seed in ("0", "4"):  # they put texts into sets in different orders
        folder = tmp_path / seed
        folder.mkdir()
        environment = os.environ | {"PYTHONHASHSEED": seed}
        subprocess.run([sys.executable, "-c", program], cwd=folder, env=environment, check=True)
        written.append([(folder / name).read_bytes() for name in ("drawing.dxf", "profile.dxf")])
    assert written[0] == written[1]


def test_hostile_text_is_text(tmp_path: Path) -> None:
    mechanism = ct.example("crank-rocker").model_copy(update={"title": "</text><script>x</script>%%c\\P{"})
    drawing = mechanism_drawing(mechanism, ct.motion(mechanism, 3))
    root = ET.fromstring(drawing_svg(drawing))
    assert not list(root.iter(f"{SVG}script"))
    assert mechanism.title in ["".join(one.itertext()) for one in root.iter(f"{SVG}text")]
    write_drawing_dxf(drawing, tmp_path / "a.dxf")
    assert not ezdxf.readfile(tmp_path / "a.dxf").audit().errors


CAPITALS = 0.729
"""Height of DejaVu's capitals, as a part of the size of its letters."""


@pytest.mark.parametrize("text", [
    "OA 1 rad (57.2958 deg), EC 1.14159265 rad (65.4084 deg)",
    "Кривошипно-коромысловый четырёхзвенник",
    "Механізм з двома кривошипами й повзуном",
    "WWW MMM",
])  # fmt: skip
def test_the_sheet_has_room_for_its_words(text: str) -> None:
    low, high = Drawing(words=[BoardWords("title", text, (0.0, 0.0), 1.0, left=True)]).box()
    set_width = text_to_path.get_text_width_height_descent(
        text, FontProperties(family="DejaVu Sans", size=1.0 / CAPITALS), False
    )[0]
    # the margin of the sheet takes what single wide letters need
    assert low[0] <= 0.0
    assert (1.0 + MARGIN) * high[0] >= set_width


def scaled(metres: float) -> ct.Mechanism:
    return ct.parse_mechanism(f"""
        title = "Crank-rocker"
        links = {{ OA.length = {metres}, AB.length = {3.5 * metres}, DB.length = {3 * metres} }}
        frame.points = {{ O = [0, 0], D = [{4 * metres}, 0] }}
        drives = [{{ link = "OA", start = "30 deg", speed = "60 rpm" }}]
        assembly.sides = {{ B = "left" }}
        """)


@pytest.mark.parametrize("metres", [1e-7, 1e-3, 1.0, 1e6])
def test_drawings_of_any_size_are_as_exact(metres: float) -> None:
    mechanism = scaled(metres)
    motion = ct.motion(mechanism, 13)
    root = ET.fromstring(drawing_svg(mechanism_drawing(mechanism, motion, 0)))
    sheet = max(float(part) for part in root.attrib["viewBox"].split()[2:])
    hinges = [
        np.array([float(one.attrib["cx"]), float(one.attrib["cy"])]) for one in root.iter(f"{SVG}circle")
    ]
    apart = [math.dist(a, b) for a in hinges for b in hinges]
    # coordinates have six digits of the sheet's size after the first
    for length in (1.0, 3.5, 3.0):
        assert min(abs(one - 1e3 * metres * length) for one in apart) <= 2e-6 * sheet


def test_points_of_one_link_are_dots_and_hinges_open(tmp_path: Path) -> None:
    mechanism, _motion, drawing = drawing_of("chebyshev-straight-line")
    traced = 1e3 * ct.motion(mechanism, 1)["position"].sel(point="P")[0].to_numpy()
    (dot,) = [ring for ring in drawing.rings if ring.filled]
    assert math.dist(dot.centre, traced) <= RINGS * 1e3
    root = ET.fromstring(drawing_svg(drawing))
    assert [one.get("fill") is not None for one in root.iter(f"{SVG}circle")].count(True) == 1
    write_drawing_dxf(drawing, tmp_path / "a.dxf")
    (hatch,) = ezdxf.readfile(tmp_path / "a.dxf").modelspace().query("HATCH")
    assert hatch.dxf.solid_fill == 1


def test_links_lie_on_paths_in_both_kinds_of_file(tmp_path: Path) -> None:
    mechanism = ct.example("scotch-yoke")  # H and T of one link go along the line that joins them
    drawing = mechanism_drawing(mechanism, ct.motion(mechanism, 13), 0, ["H", "T"])
    write_drawing_dxf(drawing, tmp_path / "a.dxf")
    layers = [one.dxf.layer for one in ezdxf.readfile(tmp_path / "a.dxf").modelspace().query("LWPOLYLINE")]
    assert max(k for k, layer in enumerate(layers) if layer == "paths") < layers.index("links")


def test_names_are_as_large_as_their_places_are_made_for() -> None:
    mechanism = ct.example("crank-rocker")
    motion = ct.motion(mechanism, 61)
    drawing = mechanism_drawing(mechanism, motion, 0)
    scene = scene_of(mechanism, motion)
    point = 1e3 / scene.factor * scene.extent / (72.0 * scene.inches)
    svg = ET.fromstring(drawing_svg(drawing))
    sizes = {one.attrib["font-size"] for one in svg.iter(f"{SVG}text") if one.text in ("O", "A", "B", "D")}
    # the SVG tells six digits
    assert [float(size) for size in sizes] == [pytest.approx(NAME_POINTS * point, rel=1e-5)]
