"""Forces of described cams: the profile's own contact, closed forms of stress, what is said and refused."""

import math

import numpy as np
import pytest

import centrode as ct
from centrode.cams.followers.force_results import follower_force_results
from centrode.cams.followers.forces import follower_forces, meeting_of
from centrode.cams.followers.motion import follower_motion
from centrode.render import plain_text
from centrode.topics.presentation import sheet_of

EPS = np.finfo(float).eps
STEEL = {"elasticity": "206 GPa", "poisson": 0.3}
SEGMENTS = (
    {"angle": "100 deg", "to": 1.0, "curve": "harmonic"},
    {"angle": "40 deg", "curve": "dwell"},
    {"angle": "90 deg", "to": 0, "curve": "3-4-5"},
    {"angle": "130 deg", "curve": "dwell"},
)
FOLLOWERS = {
    "roller": (0.018, {"contact": "roller", "roller_radius": "9 mm", "offset": "7 mm", "mass": 0.4}),
    "edge": (0.018, {"contact": "knife", "offset": "-7 mm", "mass": 0.4}),
    "face": (0.006, {"contact": "flat", "offset": "4 mm", "mass": 0.4}),
    "arm": (0.3, {"contact": "roller", "roller_radius": "9 mm", "arm": "80 mm", "pivot_distance": "95 mm"}),
    "arm-edge": (0.3, {"contact": "knife", "arm": "80 mm", "pivot_distance": "95 mm"}),
    "turning-face": (0.12, {"contact": "flat", "pivot_distance": "95 mm", "face_offset": "5 mm"}),
}


def plate(name, turn="counter-clockwise", body=(), **more):
    lift, follower = FOLLOWERS[name]
    swings = "pivot_distance" in follower
    segments = [{**one, **({"to": lift} if one.get("to") else {})} for one in SEGMENTS]
    given = {"kind": "oscillating" if swings else "translating", **follower}
    given |= {"inertia": 0.002} if swings else {}
    given["spring"] = {"stiffness": 3.0 if swings else 4e3, "preload": 2.0 if swings else 90.0}
    cam = {"base_radius": "40 mm", "turn": turn, "speed": "300 rpm", "thickness": "12 mm", "material": STEEL}
    return ct.PlateCam(kind="cam", cam=cam | dict(body), follower=given | more, segments=segments)


def failure(cam):
    """What the cam cannot do, as a command says it; an empty text where it does all."""
    failed = sheet_of(follower_force_results(cam)).failure
    return "" if failed is None else plain_text(failed.what, cam.display)


PHI = np.linspace(0.01, math.tau - 0.01, 97)


@pytest.mark.parametrize("turn", ["counter-clockwise", "clockwise"])
@pytest.mark.parametrize("name", FOLLOWERS)
def test_the_profile_touches_where_the_instant_centre_says(name, turn):
    # The envelope of the follower's places and the instant centre know nothing of each other.
    body = ct.follower_cam(plate(name, turn))
    contact = body.contact(PHI)
    met = meeting_of(body, body.motion.lift(PHI, 2))
    place, normal = body.in_frame(contact.centre, PHI), body.in_frame(contact.normal, PHI)
    # A face touches where p' says, p the distance of the face: digits lost by a small angle of it count as well.
    assert np.abs(place - met.place).max() <= 64 * EPS * np.abs(met.place).max()
    assert np.abs(normal - met.normal).max() <= 64 * EPS


@pytest.mark.parametrize("turn", ["counter-clockwise", "clockwise"])
@pytest.mark.parametrize("name", FOLLOWERS)
def test_torque_is_that_of_virtual_work_and_the_pressure_angle_says_the_force(name, turn):
    forces = follower_forces(plate(name, turn))
    found = forces.at(PHI)
    rows = forces.body.motion.lift(PHI, 2)
    size = np.abs(found.normal) * 0.1
    assert np.all(np.abs(found.torque - found.push * rows[1]) <= 64 * EPS * size)
    cosine = np.cos(forces.body.contact(PHI).pressure_angle)
    lever = 1.0
    if name in ("arm", "arm-edge"):
        lever = 0.08
    elif name == "turning-face":
        contact = forces.body.contact(PHI)
        lever = np.hypot(contact.along, 0.005)
    assert np.all(np.abs(found.normal * cosine * lever - found.push) <= 64 * EPS * np.abs(found.push))


def test_stress_by_hertz_on_the_base_circle():
    # On a dwell everything is plain: a roller of 9 mm on a cylinder of 40 mm, pressed by the spring's preload.
    forces = follower_forces(plate("roller"))
    tangent = 0.007 / math.sqrt(0.049**2 - 0.007**2)
    load = 90.0 * math.hypot(1.0, tangent) / 0.012
    modulus = 206e9 / (2 * (1 - 0.3**2))
    expected = math.sqrt(load * modulus / math.pi * (1 / 0.009 + 1 / 0.040))
    found = forces.at(np.array([math.radians(300.0)])).strip
    assert found is not None
    assert abs(found.pressure[0] - expected) <= 64 * EPS * expected
    # A flat face: the cam's curvature alone.
    face = follower_forces(plate("face")).at(np.array([math.radians(300.0)])).strip
    expected = math.sqrt(90.0 / 0.012 * modulus / math.pi / 0.040)
    assert face is not None
    assert abs(face.pressure[0] - expected) <= 64 * EPS * expected
    assert follower_forces(plate("edge")).at(PHI).strip is None


def test_the_dataset_says_where_the_contact_is_lost():
    cam = plate("roller", body={"speed": "1500 rpm"})
    found = ct.cam_forces(cam, 361)
    speed = found.attrs["jump_speed"]
    assert speed < cam.body.speed and found.attrs["least_push"] < 0
    lost = found["follower_push"].to_numpy() < 0
    assert lost.any()
    assert np.array_equal(np.isnan(found["contact_force"].to_numpy()), lost)
    assert np.array_equal(found["status"].to_numpy() != 0, lost)
    # Just below the speed of jumping nothing is lost.
    slower = plate("roller", body={"speed": speed * (1 - 1e-9)})
    assert not np.isnan(ct.cam_forces(slower, 361)["contact_force"].to_numpy()).any()
    assert "leaves the cam" in failure(cam)
    assert not failure(slower)


def test_a_cam_that_leads_both_ways_keeps_the_sign_of_its_force():
    cam = plate("roller", spring=None, body={"speed": "1500 rpm"})
    found = ct.cam_forces(cam, 361)
    assert found.attrs["led"] and (found["contact_force"].to_numpy() < 0).any()
    assert not np.isnan(found["contact_force"].to_numpy()).any()
    assert "needs form closure" in ct.summary(follower_force_results(cam))


def test_friction_of_an_edge_locks():
    steep = plate("edge", friction=3.0)
    found = ct.cam_forces(steep, 361)
    locked = np.isnan(found["contact_force"].to_numpy())
    assert locked.any() and not (found["follower_push"].to_numpy()[locked] < 0).any()
    assert "friction locks" in failure(steep)


def test_what_locks_between_the_samples_is_told_and_has_no_greatest_force():
    # An edge locks where tan alpha = 1/mu: with a hair more friction than the steepest place allows, nowhere else.
    body = ct.follower_cam(plate("edge"))
    steepest = body.pressure.greatest
    for share, locks in ((1 - 1e-9, False), (1 + 1e-9, True)):
        cam = plate("edge", friction=share / math.tan(steepest))
        found = ct.cam_forces(cam, 13)
        assert not np.isnan(found["contact_force"].to_numpy()).any()
        assert math.isinf(found.attrs["greatest_force"]) == locks
        assert math.isinf(found.attrs["greatest_torque"]) == locks
        assert ("friction locks" in failure(cam)) == locks
        assert ("greatest contact force       unlimited" in ct.summary(follower_force_results(cam))) == locks


def test_a_stress_that_is_not_admissible_fails():
    greatest = ct.cam_forces(plate("roller")).attrs["greatest_stress"]
    for share, fails in ((1 - 1e-9, True), (1 + 1e-9, False)):
        cam = plate("roller")
        bound = ct.PlateCam(**{**cam.model_dump(by_alias=True), "bounds": {"stress": share * greatest}})
        assert ("stress is not admissible" in failure(bound)) == fails


def test_no_greatest_stress_is_told_of_a_profile_that_is_undercut():
    # Towards a cusp the curvature grows without bound, and the stress with it.
    cam = plate("roller", roller_radius="39 mm")
    shown = ct.PlateCam(
        **{
            **cam.model_dump(by_alias=True),
            "segments": [
                {"angle": "50 deg", "to": "18 mm", "curve": "cycloidal"},
                {"angle": "50 deg", "to": 0, "curve": "cycloidal"},
                {"angle": "260 deg", "curve": "dwell"},
            ],
            "study": {"show_undercut": True},
        }
    )
    forces = follower_forces(shown)
    cusp = forces.body.undercuts[0].start
    near = forces.at(cusp - np.array([1e-3, 1e-5, 1e-7])).strip
    assert near is not None and np.all(np.diff(near.pressure) > 2 * near.pressure[:-1])
    assert math.isnan(forces.greatest_stress.value)


def test_without_speed_forces_are_those_at_rest():
    cam = plate("face", body={"speed": None})
    found = ct.cam_forces(cam, 73)
    lift = follower_motion(cam).lift(found["cam_angle"].to_numpy())[0]
    assert np.all(np.abs(found["follower_push"].to_numpy() - 90.0 - 4e3 * lift) <= 4 * EPS * 200.0)


@pytest.mark.parametrize(
    ("body", "follower", "message"),
    [
        ({"base_radius": None}, {}, "needs the cam's base radius"),
        ({}, {"offset": "60 mm"}, "misses the base circle"),
        ({"speed": "-1 rpm"}, {}, "must be positive"),
        ({"speed": "10 mm"}, {}, "expected an angular speed"),
        ({}, {"mass": "-1 kg"}, "must not be negative"),
        ({}, {"mass": "3 N"}, "expected a mass"),
        ({}, {"spring": {"stiffness": "3 N"}}, "expected a stiffness"),
        ({}, {"spring": {"preload": 3.0}}, "stiffness"),
        ({}, {"inertia": 1.0}, "is used with"),
    ],
)
def test_wrong_numbers_are_refused(body, follower, message):
    with pytest.raises(ct.InputError, match=message):
        ct.cam_forces(plate("roller", body=body, **follower))


def test_a_cam_by_its_curvature_has_no_follower():
    with pytest.raises(ct.InputError, match="no follower's lift"):
        ct.cam_forces(ct.example("cam-from-curvature"))
