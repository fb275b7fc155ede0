"""Pictures of forces on cams, and of cams with the linkages that they drive."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from PIL import Image

import centrode as ct
from centrode.animation.cams import animate_body
from centrode.cams.followers.force_results import follower_force_results
from centrode.model.examples.catalogue import load_cam
from centrode.render.drawing.cams import draw_cams
from centrode.render.drawing.tags import cam_lines
from centrode.scenes.linkage import scene_of
from drawn_curves import at_samples


@pytest.fixture(scope="module")
def scene():
    linkage = ct.example("cam-driven-linkage")
    return scene_of(linkage, ct.motion(linkage, 13))


def test_every_curve_of_the_forces_is_drawn():
    cam = load_cam("valve-cam")
    results = follower_force_results(cam, 73)
    found, figure = results.dataset, ct.figures(results)["cam-forces"]
    curves = [axes.lines[0].get_ydata() for axes in figure.axes]
    names = ("follower_push", "contact_force", "cam_torque", "contact_stress")
    assert len(curves) == len(names)
    for name, curve in zip(names, curves, strict=True):
        factor = 1e-6 if name == "contact_stress" else 1.0
        assert np.array_equal(at_samples(curve, 73), factor * found[name].to_numpy())
    swinging = load_cam("indexing-cam")
    figure = ct.figures(follower_force_results(swinging, 13))["cam-forces"]
    assert "Q" in figure.axes[0].get_ylabel()


def test_the_cam_is_drawn_with_its_linkage(scene):
    (cam,) = scene.cams
    axes = Figure().subplots()
    draw_cams(axes, scene, 4)
    outlines = [one.get_xy() for one in axes.patches if isinstance(one, Polygon) and len(one.get_xy()) > 300]
    assert len(outlines) == 2  # filled, and its edge
    assert np.array_equal(outlines[0][:-1], cam.outline(4))
    rollers = [one for one in axes.patches if isinstance(one, Circle) and one.radius == cam.roller(4)[1]]
    assert len(rollers) == 1 and cam.roller(4)[1] == 12.0
    assert np.abs(rollers[0].center - scene.tracks["R"][4]).max() < 1e-12


def test_the_sheet_holds_the_cam_however_it_has_turned(scene):
    for sample in range(13):
        outline = scene.cams[0].outline(sample)
        assert (outline >= scene.low).all() and (outline <= scene.high).all()
        assert len(cam_lines(scene, sample)) > 40


FOLLOWERS = {
    "flat": {"contact": "flat", "offset": "3 mm"},
    "knife": {"contact": "knife"},
    "turning": {"kind": "oscillating", "contact": "flat", "pivot_distance": "90 mm", "face_offset": "4 mm"},
}


@pytest.mark.parametrize("name", FOLLOWERS)
def test_faces_and_edges_lie_on_the_cam(name):
    swings = name == "turning"
    lift = 0.1 if swings else 0.006
    cam = {
        "kind": "cam",
        "cam": {"base_radius": "40 mm", "speed": 1.0},
        "follower": FOLLOWERS[name],
        "segments": [
            {"angle": "180 deg", "to": lift, "curve": "cycloidal"},
            {"angle": "180 deg", "to": 0, "curve": "cycloidal"},
        ],
    }
    driven = {"link": "AB"} if swings else {"guide": "A"}
    parts = {"frame": {"points": {"O": [0, 0]}}, "links": {"AB": {"length": 0.05}, "OB": {"length": 0.06}}}
    if swings:
        parts = {"frame": {"points": {"A": [0, 0]}}, "links": {"AB": {"length": 0.05}}}
    else:
        parts["guides"] = [{"point": "A", "on": "frame", "through": [0.07, 0], "direction": [0, 1]}]
        parts["assembly"] = {"sides": {"B": "left"}}
    linkage = ct.Mechanism(drives=[{**driven, "start": 0, "cam": cam}], **parts)
    scene = scene_of(linkage, ct.motion(linkage, 9))
    (drawn,) = scene.cams
    for sample in range(9):
        outline = drawn.outline(sample)
        line = drawn.arm(sample) if swings else drawn.face(sample)
        if name == "knife":
            assert line is None and drawn.roller(sample) is None
            touch = scene.tracks["A"][sample]
            apart = np.hypot(*(outline - touch).T).min()
            assert apart < np.hypot(*np.diff(outline, axis=0).T).max()
            continue
        # The cam lies on one side of the face and comes up to it: within the sagitta of a step of its outline.
        along = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
        off = (outline - line[0]) @ np.array([-along[1], along[0]])
        sagitta = np.hypot(*np.diff(outline, axis=0).T).max() ** 2 / (8 * 0.02)
        assert min(abs(off.min()), abs(off.max())) <= sagitta
        assert off.max() <= 1e-12 or off.min() >= -1e-12
        touching = outline[np.argmin(np.abs(off))]
        assert 0.0 <= (touching - line[0]) @ along <= np.hypot(*(line[1] - line[0]))


@pytest.mark.parametrize("name", ["valve-cam", "indexing-cam"])
def test_a_turn_is_written_frame_by_frame(name, tmp_path):
    told = []
    body = ct.follower_cam(load_cam(name))
    for number in range(2):
        animate_body(body, tmp_path / f"{number}.gif", name, frames=4, said=lambda *done: told.append(done))
    with Image.open(tmp_path / "0.gif") as animation:
        assert animation.n_frames == 4
    assert told[:4] == [(1, 4), (2, 4), (3, 4), (4, 4)]
    assert (tmp_path / "0.gif").read_bytes() == (tmp_path / "1.gif").read_bytes()
