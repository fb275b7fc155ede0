"""Linkages that a cam drives: against the lift itself, against segments in time, and what is refused."""

import math

import numpy as np
import pytest

import centrode as ct
from centrode.cams.followers.motion import follower_motion
from centrode.model.examples import example_text
from centrode.scenes.driving_cams import driving_cams

EPS = np.finfo(float).eps

LIFT = """
kind = "cam"
[cam]
base_radius = "30 mm"
turn = "{turn}"
speed = "120 rpm"
[follower]
kind = "translating"
contact = "roller"
roller_radius = "8 mm"
offset = "5 mm"
[[segments]]
angle = "90 deg"
to = "12 mm"
curve = "cycloidal"
[[segments]]
angle = "60 deg"
curve = "dwell"
[[segments]]
angle = "120 deg"
to = 0
curve = "3-4-5"
[[segments]]
angle = "90 deg"
curve = "dwell"
"""
SWING = """
kind = "cam"
[cam]
base_radius = "30 mm"
turn = "{turn}"
speed = "120 rpm"
[follower]
kind = "oscillating"
contact = "roller"
roller_radius = "8 mm"
arm = "60 mm"
pivot_distance = "70 mm"
[[segments]]
angle = "180 deg"
to = "20 deg"
curve = "harmonic"
[[segments]]
angle = "180 deg"
to = 0
curve = "harmonic"
"""
SLIDE = """
[frame.points]
O = [0, 0]
[links]
AB = { length = "50 mm" }
OB = { length = "60 mm" }
[[guides]]
point = "A"
on = "frame"
through = ["70 mm", 0]
direction = [0, 1]
[[drives]]
guide = "A"
cam = "cam.toml"
[assembly]
sides = { B = "left" }
"""
ROCKER = """
[frame.points]
C = ["10 mm", "-5 mm"]
[links]
lever = { points = { C = [0, 0], R = [0, "60 mm"], B = ["40 mm", 0] } }
BD = { length = "80 mm" }
[[guides]]
point = "D"
on = "frame"
through = [0, "30 mm"]
direction = [1, 0]
[[drives]]
link = "lever"
start = "15 deg"
cam = "cam.toml"
cam_point = "R"
[assembly]
sides = { D = "ahead" }
"""


@pytest.fixture
def read(tmp_path):
    def reading(linkage, cam, turn="counter-clockwise"):
        (tmp_path / "cam.toml").write_text(cam.format(turn=turn))
        (tmp_path / "linkage.toml").write_text(linkage)
        return ct.read_mechanism(tmp_path / "linkage.toml")

    return reading


def test_the_drive_follows_the_lift(read):
    mechanism = read(SLIDE.replace('"cam.toml"', '"cam.toml"\nstart = "3 mm"\ncam_angle = "20 deg"'), LIFT)
    motion = ct.motion(mechanism, 145)
    time, speed = motion["time"].to_numpy(), 4 * math.pi
    # A turn of the cam is what is asked for if nothing is said.
    assert abs(time[-1] - time[0] - 0.5) <= 4 * EPS
    lift = follower_motion(mechanism.drives[0].cam).lift(math.radians(20) + speed * time, 2)
    place = motion["position"].sel(point="A", axis="y").to_numpy()
    assert np.abs(place - 0.003 - lift[0]).max() <= 16 * EPS * 0.07
    for order, name in ((1, "velocity"), (2, "acceleration")):
        got = motion[name].sel(point="A", axis="y").to_numpy()
        scale = speed**order * np.abs(lift[order]).max()
        assert np.abs(got - speed**order * lift[order]).max() <= 64 * EPS * scale


def test_a_cam_is_the_same_as_its_segments_in_time(read):
    cam = read(SLIDE, LIFT)
    segments = """[{ time = 0.125, to = "12 mm", curve = "cycloidal" },
    { time = "500/6 ms", curve = "dwell" }, { time = "500/3 ms", to = 0, curve = "3-4-5" },
    { time = 0.125, curve = "dwell" }]"""
    law = read(SLIDE.replace('cam = "cam.toml"', f"segments = {segments}"), LIFT)
    at = np.linspace(0.001, 0.49, 60)
    first, second = ct.motion(cam, at=at), ct.motion(law, at=at)
    for name in ("position", "velocity", "acceleration"):
        apart = np.abs(first[name].to_numpy() - second[name].to_numpy())
        # Joints differ by rounding of times; jerks carry that into the accelerations beside them.
        assert np.nanmax(apart) <= 1e4 * EPS * np.nanmax(np.abs(first[name].to_numpy())), name


def test_lowering_turns_the_lift_round(read):
    up, down = read(ROCKER, SWING), read(ROCKER.replace("[assembly]", "lowers = true\n[assembly]"), SWING)
    for mechanism, sign in ((up, 1.0), (down, -1.0)):
        motion = ct.motion(mechanism, 37)
        lift = follower_motion(mechanism.drives[0].cam).lift(4 * math.pi * motion["time"].to_numpy())[0]
        angle = motion["angle"].sel(link="lever").to_numpy()
        assert np.abs(angle - math.radians(15) - sign * lift).max() <= 8 * EPS


@pytest.mark.parametrize("turn", ["counter-clockwise", "clockwise"])
@pytest.mark.parametrize("lowers", [True, False])
@pytest.mark.parametrize(("linkage", "cam", "point"), [(SLIDE, LIFT, "A"), (ROCKER, SWING, "R")])
def test_the_cam_in_the_picture_touches_the_roller(read, linkage, cam, point, lowers, turn):
    # The roller's centre, where the linkage puts it, stays a roller's radius off the turned profile.
    text = linkage.replace("[assembly]", f"lowers = {str(lowers).lower()}\n[assembly]")
    mechanism = read(text, cam, turn)
    motion = ct.motion(mechanism, 25)
    (drawn,) = driving_cams(mechanism, motion, 1.0)
    places = motion["position"].sel(point=point).to_numpy()
    for sample in range(25):
        centre, radius = drawn.roller(sample)
        assert np.abs(centre - places[sample]).max() <= 64 * EPS * 0.1
        apart = np.hypot(*(drawn.outline(sample) - centre).T)
        # Between places of the outline, a step of s apart, the nearest is missed by s^2/8 times the curvatures.
        step = np.hypot(*np.diff(drawn.outline(sample), axis=0).T).max()
        assert -64 * EPS <= apart.min() - radius <= step**2 / 8 * (1 / radius + 1 / 0.01)
    assert drawn.forward == ((turn == "counter-clockwise") == (lowers or point == "A"))


def test_what_is_written_reads_back(read):
    for mechanism in (read(SLIDE, LIFT), read(ROCKER, SWING), ct.example("cam-driven-linkage")):
        assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism


def test_a_cam_that_is_not_that_of_the_motion_is_not_drawn(read):
    mechanism = read(SLIDE, LIFT)
    motion = ct.motion(mechanism, 25)
    moved = motion.assign(drive_value=motion["drive_value"] * 1.01)
    assert driving_cams(mechanism, moved, 1.0) == ()


@pytest.mark.parametrize(
    ("linkage", "cam", "old", "new", "message"),
    [
        (SLIDE, LIFT, '"cam.toml"', '"none.toml"', "cam: none.toml: there is no such file"),
        (SLIDE, LIFT, '"cam.toml"', '"../cam.toml"', "is not in the folder of the description"),
        (SLIDE, LIFT, '"cam.toml"', '"/etc/passwd.toml"', "is not in the folder of the description"),
        (SLIDE, LIFT, '"cam.toml"', '"valve-cm"', 'did you mean "valve-cam"?'),
        (SLIDE, LIFT, '"cam.toml"', "3", "expected the name of a cam's file"),
        (SLIDE, LIFT, '"cam.toml"', '"cam-from-curvature"', "no follower whose lift"),
        (SLIDE, LIFT, '"cam.toml"', '"linkage.toml"', "describes a linkage, not a cam"),
        (SLIDE, LIFT, '"cam.toml"', '"cam.toml"\nspeed = 1', "speed, cam are given together"),
        (SLIDE, LIFT, 'cam = "cam.toml"', "speed = 1\ncam_speed = 1", "cam_speed is used with a cam only"),
        (SLIDE, LIFT, '"cam.toml"', '"cam.toml"\ncam_speed = 0', "must be positive"),
        (SLIDE, LIFT, '"cam.toml"', '"cam.toml"\ncam_speed = "5 mm"', "expected an angular speed"),
        (
            SLIDE,
            LIFT,
            '"cam.toml"',
            '"cam.toml"\ncam_point = "A"',
            "cam_point is used with an oscillating follower only",
        ),
        (SLIDE, LIFT, '"cam.toml"', '"cam.toml"\nlowers = 1', "expected true or false"),
        (SLIDE, SWING, "", "", "the cam's follower oscillates, but a displacement is driven"),
        (ROCKER, LIFT, 'cam_point = "R"', "", "the cam's follower translates, but an angle is driven"),
        (ROCKER, SWING, 'cam_point = "R"', 'cam_point = "S"', 'has no point "S"'),
        (ROCKER, SWING, 'cam_point = "R"', 'cam_point = "C"', "is the pivot of the follower"),
        (ROCKER, SWING, 'cam_point = "R"', 'cam_point = "B"', "has an arm of 0.06 m"),
        (SLIDE, LIFT.replace('speed = "120 rpm"', ""), "", "", "the speed of the cam is not given"),
        (SLIDE, LIFT.replace("90 deg", "80 deg"), "", "", "leave a gap"),
        (
            SLIDE,
            LIFT.replace('"12 mm"', '"12 deg"'),
            "",
            "",
            "cam: cam.toml, [[segments]] 1, to: expected a length",
        ),
    ],
)
def test_wrong_drives_are_refused(read, linkage, cam, old, new, message):
    with pytest.raises(ct.InputError) as caught:
        read(linkage.replace(old, new, 1) if old else linkage, cam)
    assert message in str(caught.value)
    assert str(caught.value).startswith("linkage.toml, [[drives]] 1")


def test_no_cam_drives_on_the_sphere():
    text = example_text("spherical-four-bar")
    with pytest.raises(ct.InputError, match="disc cams are planar"):
        ct.parse_mechanism(_driven_by_cam(text))


def _driven_by_cam(text):
    lines, inside = [], False
    for line in text.splitlines():
        inside = line == "[[drives]]" or (inside and not line.startswith("["))
        if inside and line.startswith("speed"):
            line = 'cam = "indexing-cam"'
        lines.append(line)
    return "\n".join(lines)
