"""Cams below their followers in motion: alone, and in linkages that they drive; pitch circles that turn with them."""

from __future__ import annotations

import functools
import math
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from PIL import Image

import centrode as ct
from centrode.animation.animate import Shown
from centrode.animation.cams import FollowerLayer, follower_captions
from centrode.animation.frames import course_of, film_of
from centrode.animation.layers import Layer, instant_captions, scene_of_film
from centrode.animation.linkages import LinksLayer
from centrode.animation.video_files import Pace
from centrode.cams.followers.geometry import FollowerCam
from centrode.cams.followers.motion import follower_motion
from centrode.scenes.places import View

EPS = float(np.finfo(float).eps)
FRAMES = 5
CAM = """
kind = "cam"
title = "A cam"
display = { length = "mm", angle = "deg" }
cam = { base_radius = "40 mm", turn = "TURN" }
follower = { FOLLOWER }
segments = [
    { angle = "120 deg", to = "LIFT", curve = "3-4-5" },
    { angle = "120 deg", to = 0, curve = "cycloidal" },
    { angle = "120 deg", curve = "dwell" },
]
"""
STEM, ARM = 'kind = "translating"', 'kind = "oscillating", pivot_distance = "100 mm"'
FOLLOWERS = {
    "roller": f'{STEM}, contact = "roller", roller_radius = "8 mm", offset = "-12 mm"',
    "knife": f'{STEM}, contact = "knife", offset = "12 mm"',
    "flat": f'{STEM}, contact = "flat"',
    "arm": f'{ARM}, contact = "roller", roller_radius = "8 mm", arm = "90 mm"',
    "sharp arm": f'{ARM}, contact = "knife", arm = "90 mm"',
    "face": f'{ARM}, contact = "flat"',
    "passing face": f'{ARM}, contact = "flat", face_offset = "8 mm"',
}


def cam_of(name: str, turn: str = "counter-clockwise") -> ct.PlateCam:
    lift = "8 deg" if ARM in FOLLOWERS[name] else "14 mm"
    text = CAM.replace("FOLLOWER", FOLLOWERS[name]).replace("LIFT", lift).replace("TURN", turn)
    found = ct.parse_cam(text)
    assert isinstance(found, ct.PlateCam)
    return found


@functools.cache
def body_of(name: str, turn: str) -> FollowerCam:
    return ct.follower_cam(cam_of(name, turn))


def layer_of(name: str, turn: str = "counter-clockwise") -> FollowerLayer:
    return FollowerLayer(body_of(name, turn), math.tau * np.arange(FRAMES) / FRAMES, 1e3)


def drawn(layer: Layer, frame: int) -> Axes:
    """Axes on which a layer has drawn its ground and a frame."""
    places = layer.reach()
    axes = Figure().add_axes((0.0, 0.0, 1.0, 1.0))
    layer.stand(View(places.min(axis=0), places.max(axis=0), float(np.ptp(places, axis=0).max()) / 5.0))
    layer.ground(axes)
    layer.draw(axes, frame)
    return axes


def profile_of(axes: Axes) -> np.ndarray:
    """The greatest polygon."""
    shapes = [np.asarray(one.get_xy()) for one in axes.patches if isinstance(one, Polygon)]
    return max(shapes, key=lambda shape: float(np.ptp(shape, axis=0).max()))


@pytest.mark.parametrize("name", FOLLOWERS)
@pytest.mark.parametrize(("turn", "sense"), [("counter-clockwise", 1.0), ("clockwise", -1.0)])
def test_the_cam_turns_as_it_is_described(name: str, turn: str, sense: float) -> None:
    layer = layer_of(name, turn)
    first = profile_of(drawn(layer, 0))
    for frame in range(1, FRAMES):
        angle = sense * math.tau * frame / FRAMES
        turned = first @ np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        assert np.abs(profile_of(drawn(layer, frame)) - turned).max() <= 32 * EPS * np.abs(first).max()


@pytest.mark.parametrize("name", FOLLOWERS)
def test_the_follower_touches_the_cam_where_its_lift_says(name: str) -> None:
    """Roller, edge and face stand at the law's lift; the profile comes up to them and not beyond."""
    layer, cam = layer_of(name), cam_of(name)
    law = follower_motion(cam)
    for frame in range(FRAMES):
        profile = profile_of(drawn(layer, frame))
        step = float(np.hypot(*np.diff(profile, axis=0).T).max())
        lift = float(law.lift(np.array([math.tau * frame / FRAMES]))[0, 0])
        if "face" in name or name == "flat":
            normal, height = np.array([0.0, 1.0]), 40.0 + 1e3 * lift
            if "face" in name:
                psi = math.asin((40.0 + (8.0 if "passing" in name else 0.0)) / 100.0) + lift
                normal = np.array([math.sin(psi), math.cos(psi)])
                height = 100.0 * math.sin(psi) - (8.0 if "passing" in name else 0.0)
            gap = height - (profile @ normal).max()
            radius = 10.0  # of curvature: the profile bends less everywhere
        else:
            radius = 8.0 if name in ("roller", "arm") else 0.0
            foot = layer.cam.foot(frame)
            if ARM in FOLLOWERS[name]:
                base = 40.0 + radius
                psi = math.acos((100.0**2 + 90.0**2 - base**2) / (2 * 100.0 * 90.0)) + lift
                place = np.array([100.0 - 90.0 * math.cos(psi), 90.0 * math.sin(psi)])
            else:
                offset = -12.0 if radius else 12.0
                place = np.array([offset, math.sqrt((40.0 + radius) ** 2 - offset**2) + 1e3 * lift])
            assert np.abs(foot - place).max() <= 64 * EPS * 200.0
            gap = float(np.hypot(*(profile - foot).T).min()) - radius
        # between places of the profile, a step apart, the nearest is missed by at most half a step of it
        room = step / 2 if radius == 0.0 else (step / 2) ** 2 / radius
        assert -64 * EPS * 200.0 <= gap <= room


@pytest.mark.parametrize("name", FOLLOWERS)
def test_the_view_holds_cam_and_follower_in_every_frame(name: str) -> None:
    layer = layer_of(name)
    low, high = layer.reach().min(axis=0), layer.reach().max(axis=0)
    # nodes of the path and of the mark lie between samples of the reach's circle
    room = 4.0 * layer.far * (1.0 - math.cos(math.pi / 360))
    for frame in range(FRAMES):
        axes = drawn(layer, frame)
        places = [line.get_xydata() for line in axes.lines] + [profile_of(axes)]
        for one in axes.patches:
            if isinstance(one, Circle) and one.radius == 8.0:
                places += [np.add(one.center, [[8.0, 8.0], [-8.0, -8.0]])]
        every = np.concatenate(places)
        assert (every >= low - room).all()
        assert (every <= high + room).all()


def test_a_passing_face_is_joined_to_its_pivot() -> None:
    layer = layer_of("passing face")
    for frame in range(FRAMES):
        pivot, foot = layer.cam.shank(frame) or (np.zeros(2), np.zeros(2))
        face = layer.cam.arm(frame)
        assert np.array_equal(pivot, [100.0, 0.0])
        assert np.hypot(*(foot - pivot)) == pytest.approx(8.0, rel=64 * EPS)
        assert abs((foot - pivot) @ (face[1] - face[0])) <= 64 * EPS * 8.0 * 200.0
    assert layer_of("face").cam.shank(0) is None


def test_its_caption_tells_angle_and_lift() -> None:
    cam = cam_of("flat")
    body = ct.follower_cam(cam)
    texts = follower_captions(body, np.radians([0.0, 60.0, 120.0]), cam.display)
    assert texts == [
        "φ = 0.0°,  s = 0.00 mm",
        "φ = 60.0°,  s = 7.00 mm",
        "φ = 120.0°,  s = 14.00 mm",
    ]
    arm = cam_of("arm")
    assert follower_captions(ct.follower_cam(arm), np.radians([120.0]), arm.display) == [
        "φ = 120.0°,  s = 8.0°"
    ]


def test_a_turn_takes_the_time_of_the_camshaft(tmp_path: Path) -> None:
    """1500 rpm, 500 times as slow: 20 s a turn."""
    made = ct.animate(
        ct.example("valve-cam"), tmp_path / "a.gif", pace=Pace(frames=4, speed=0.002), size=(160, 120)
    )
    assert made.seconds == pytest.approx(60.0 / 1500.0 / 0.002, rel=8 * EPS)
    assert (made.frames, made.loop) == (4, "round")
    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.n_frames == 4


def test_a_cam_without_a_profile_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.gif"
    text = CAM.replace("FOLLOWER", FOLLOWERS["roller"]).replace("LIFT", "14 mm").replace("TURN", "clockwise")
    open_cam = ct.parse_cam(text.replace('base_radius = "40 mm", ', ""))
    with pytest.raises(ct.InputError, match=r"\[cam\] base_radius: a profile needs the cam's base radius"):
        ct.animate(open_cam, path)
    for refused in ({"shown": Shown()}, {"start": 0.0}, {"stop": 1.0}):
        with pytest.raises(ct.InputError, match="a cam is shown as a whole"):
            ct.animate(cam_of("roller"), path, **refused)
    with pytest.raises(ct.InputError, match="a cam has no speed of its own"):
        ct.animate(cam_of("roller"), path, pace=Pace(speed=1.0))
    assert list(tmp_path.iterdir()) == []


def test_a_driving_cam_turns_with_its_linkage() -> None:
    """The roller is at the arm's end, the hub 110 mm from the pivot, the cam turned by 900 degrees a second."""
    film = film_of(course_of(ct.example("cam-driven-linkage")), FRAMES)
    scene = scene_of_film(film)
    layer = LinksLayer(film, scene)
    hub = scene.cams[0].hub
    assert np.hypot(*hub) == pytest.approx(110.0, rel=64 * EPS)
    first = profile_of(drawn(layer, 0)) - hub
    for frame, sample in enumerate(film.order.tolist()):
        axes = drawn(layer, frame)
        circles = [one for one in axes.patches if isinstance(one, Circle)]
        (roller,) = [one for one in circles if one.radius == pytest.approx(12.0, rel=8 * EPS)]
        arm = 1e3 * film.motion["position"].sel(point="R").to_numpy()[sample]
        assert np.abs(np.array(roller.center) - arm).max() <= 256 * EPS * 110.0
        angle = math.radians(900.0) * float(film.motion["time"][sample] - film.motion["time"][0])
        turned = first @ np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        assert np.abs(profile_of(axes) - hub - turned).max() <= 256 * EPS * 110.0
        assert any(np.array_equal(one.center, hub) and one.zorder == 6 for one in circles)


def test_a_law_of_time_is_told_by_the_time() -> None:
    film = film_of(course_of(ct.example("cam-driven-linkage")), 4)
    assert instant_captions(film) == ["t = 0.0000 s", "t = 0.1000 s", "t = 0.2000 s", "t = 0.3000 s"]


@pytest.mark.parametrize(("stop", "loop"), [(0.4, "round"), (0.36, "back")])
def test_a_motion_that_ends_in_a_rest_closes_only_with_its_cam(stop: float, loop: str) -> None:
    """From 290 degrees on the follower rests where it began; the cam is round again after 0.4 s."""
    course = course_of(ct.example("cam-driven-linkage"), 41, 0.0, stop)
    assert course.loop == loop
    places = course.motion["position"].transpose("sample", "point", "axis").to_numpy()
    assert np.abs(places[-1] - places[0]).max() <= 64 * EPS


def test_pitch_circles_turn_with_their_wheels() -> None:
    """Sun, planet and ring of 24, 18 and 60 mm; the planet's about the carrier's end."""
    film = film_of(course_of(ct.example("planetary-gear-train")), FRAMES)
    layer = LinksLayer(film, scene_of_film(film))
    for frame, sample in enumerate(film.order.tolist()):
        circles = [one for one in drawn(layer, frame).patches if isinstance(one, Circle)]
        end = 1e3 * film.motion["position"].sel(point="A").to_numpy()[sample]
        for radius, centre in ((24.0, np.zeros(2)), (18.0, end), (60.0, np.zeros(2))):
            found = [one for one in circles if one.radius == pytest.approx(radius, rel=64 * EPS)]
            assert found
            assert all(np.abs(np.array(one.center) - centre).max() <= 64 * EPS * 60.0 for one in found)
