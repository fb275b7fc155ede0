"""Play in joints: reactions to a unit load by kinetostatics, closed forms, true positions by brute force."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from centrode.kinematics.preparation import ready
from centrode.tolerances.clearances import clearance_extents, with_free_joints
from centrode.tolerances.joint_play import play_of

PINS = 'O = "0.1 mm"\nA = "0.1 mm"\nB = "0.1 mm"\n'


def with_play(source: ct.Mechanism | str, play: str) -> ct.Mechanism:
    mechanism = ct.example(source) if isinstance(source, str) else source
    return ct.parse_mechanism(f"{ct.mechanism_text(mechanism)}\n[tolerances.clearances]\n{play}")


def test_slider_crank_by_hand() -> None:
    """A unit force on the slider goes along the rod as 1/cos(beta): so much of their play pins and rod add."""
    r, l, c = 0.3, 1.1, 1e-4
    mechanism = with_play(ct.slider_crank(r, l), PINS)
    joints = play_of(mechanism)
    found = clearance_extents(ready(mechanism), {"x": "position.B.x"}, joints, 37)["x"]
    phi = np.array(ct.motion(mechanism, 37)["drive_value"])[:, 0]
    sine = r * np.sin(phi) / l
    cosine = np.sqrt(1 - sine**2)
    by_name = {joint.name: found.shares[:, k] for k, joint in enumerate(joints)}
    assert np.abs(by_name["A/coupler"] - c / cosine).max() < 1e-17
    assert np.abs(by_name["O/crank"] - c / cosine).max() < 1e-17
    # the guide pushes by tan(beta)
    assert np.abs(by_name["B"] - c * np.abs(sine) / cosine).max() < 1e-17


@pytest.mark.parametrize("sample", [3, 17, 30])
def test_virtual_work_against_kinetostatics(sample: int) -> None:
    """The reaction of each joint to a unit load at the output is that of `reactions` with no other load."""
    plain = ct.example("six-bar-press")
    joints_with_play = "".join(f'{pin} = "1 mm"\n' for pin in "OABCDH")
    mechanism = with_play(plain, joints_with_play)
    joints = play_of(mechanism)
    found = clearance_extents(ready(mechanism), {"x": "position.H.x"}, joints, 37)["x"]
    unit = plain.model_copy(update={"loads": (), "gravity": None, "machine": None, "study": ct.Study()})
    weightless = {
        name: link.model_copy(update={"mass": None, "centre": None, "inertia": None, "shape": None})
        for name, link in plain.links.items()
    }
    text = ct.mechanism_text(unit.model_copy(update={"links": weightless}))
    loaded = ct.parse_mechanism(text + '\n[[loads]]\nkind = "force"\npoint = "H"\nvector = [1, 0]\n')
    forces = ct.reactions(loaded, 37)
    for number, joint in enumerate(joints):
        if joint.point:
            side = forces["joint_force"].sel(side=joint.name)[sample].to_numpy()
            exact = float(np.hypot(*side))
        else:
            exact = abs(float(forces["guide_normal"].sel(guide=joint.name)[sample]))
        assert found.shares[sample, number] == pytest.approx(1e-3 * exact, rel=1e-11), joint.name


def test_true_extremes_by_brute_force() -> None:
    """Pins anywhere in their holes: none of many lies beyond the polished extremes, and the best come close to them."""
    mechanism = with_play("crank-rocker", 'O = "20 mm"\nA = "20 mm"\nB = "20 mm"\nD = "20 mm"\n')
    joints = play_of(mechanism)
    found = clearance_extents(ready(mechanism), {"y": "angle.DB"}, joints, 25)["y"]
    worst = int(np.argmax(found.first_order))
    least, greatest = brute_force(mechanism, worst, 4000)
    assert found.lower <= least
    assert greatest <= found.upper
    assert greatest > 0.93 * found.upper
    assert least < 0.93 * found.lower
    # the play is great, so that first order and truth differ
    assert found.upper != pytest.approx(float(found.first_order[worst]), rel=1e-4)
    assert found.upper == pytest.approx(float(found.first_order[worst]), rel=0.1)


def brute_force(mechanism: ct.Mechanism, sample: int, count: int) -> tuple[float, float]:
    """Extremes of the rocker's angle over pins at random on the rims of their holes."""
    joints = play_of(mechanism)
    free = with_free_joints(mechanism, joints)
    paths = [f"links.{joint.body}.points.{joint.point}.{axis}" for joint in joints for axis in "xy"]
    moving = ct.solver(free, paths, 25, outputs="angle.DB")
    own = np.array(moving.own)
    nominal = moving.outputs(list(own))[sample]
    angles = np.random.default_rng(5).uniform(0, 2 * np.pi, (count, len(joints)))
    plays = np.array([joint.play for joint in joints])
    offsets = np.stack([plays * np.cos(angles), plays * np.sin(angles)], axis=-1).reshape(count, -1)
    deviations = [moving.outputs(list(own + offset))[sample] - nominal for offset in offsets]
    return min(deviations), max(deviations)


def test_sliders_tilt() -> None:
    """A bar fixed to a slider: at the distance a from it play of c over the length l moves its end by 2 a c / l."""
    text = """[frame.points]
O = [0, 0]
[links.slider]
points = { B = [0, 0], E = [0, 0.5] }
[[guides]]
point = "B"
on = "frame"
through = [0, 0]
direction = [1, 0]
link = "slider"
angle = 0
[[drives]]
guide = "B"
start = 0.2
speed = 0.1
[study]
from = "0.2 m"
to = "0.3 m"
[tolerances.clearances]
B = { play = "0.1 mm", length = "80 mm" }
"""
    mechanism = ct.parse_mechanism(text)
    joints = play_of(mechanism)
    found = clearance_extents(
        ready(mechanism), {"x": "position.E.x", "y": "position.E.y", "B": "position.B.y"}, joints, 5
    )
    assert found["x"].first_order == pytest.approx(2 * 0.5 * 1e-4 / 0.08, rel=1e-12)
    assert found["x"].upper == pytest.approx(2 * 0.5 * 1e-4 / 0.08, rel=1e-5)
    # up and down it goes by the play alone
    assert found["y"].first_order == pytest.approx(1e-4, rel=1e-9)
    assert found["B"].first_order == pytest.approx(1e-4, rel=1e-12)


def test_sides_that_forces_choose() -> None:
    """A force on the slider presses the rod: its pins lie inwards, so the slider stands nearer to the crank."""
    text = ct.mechanism_text(ct.slider_crank(0.3, 1.1, speed=1e-9))
    loaded = ct.parse_mechanism(
        text
        + '\n[[loads]]\nkind = "force"\npoint = "B"\nvector = [-500, 0]\n[tolerances.clearances]\n'
        + PINS
    )
    joints = [joint for joint in play_of(loaded) if joint.point]
    found = clearance_extents(ready(loaded), {"x": "position.B.x"}, joints, 37)["x"]
    assert found.by_force is not None
    assert found.by_force == pytest.approx(-found.first_order, rel=1e-9)
    unloaded = with_play(ct.slider_crank(0.3, 1.1), PINS)
    assert clearance_extents(ready(unloaded), {"x": "position.B.x"}, joints, 37)["x"].by_force is None


def test_outputs_that_fold() -> None:
    """At either end of a stroke the joints lie as it is worst there."""
    mechanism = with_play(ct.slider_crank(0.3, 1.1), PINS)
    texts = {
        "x": "position.B.x",
        "stroke": "range(position_B_x)",
        "top": "max(position_B_x)",
        "mean": "mean(position_B_x)",
    }
    found = clearance_extents(ready(mechanism), texts, play_of(mechanism), 37)
    place = np.array(ct.motion(mechanism, 37)["position"].sel(point="B", axis="x"))
    least, greatest = int(np.argmin(place)), int(np.argmax(place))
    whole = found["x"].first_order
    assert float(found["stroke"].first_order) == pytest.approx(whole[least] + whole[greatest], rel=1e-14)
    assert float(found["top"].first_order) == pytest.approx(whole[greatest], rel=1e-14)
    assert "mean" not in found


ON_SPHERE = "".join(f'{pin} = "0.5 deg"\n' for pin in "ABCD")


def test_virtual_work_on_the_sphere() -> None:
    """A unit moment on the rocker: what each joint bears across its pin is what its play adds."""
    mechanism = with_play("spherical-four-bar", ON_SPHERE)
    joints = play_of(mechanism)
    found = clearance_extents(ready(mechanism), {"u": "joint_angle.DC"}, joints, 37)["u"]
    load = '\n[[loads]]\nkind = "torque"\nlink = "DC"\nvalue = 1\n'
    borne = ct.reactions(ct.parse_mechanism(ct.mechanism_text(ct.example("spherical-four-bar")) + load), 37)
    motion = ct.motion(mechanism, 37)
    for number, joint in enumerate(joints):
        force = borne["joint_force"].sel(side=joint.name).to_numpy()
        pin = motion["position"].sel(point=joint.point).to_numpy()
        across = force - (force * pin).sum(axis=1)[:, None] * pin
        exact = joint.play * np.linalg.norm(across, axis=1)
        assert np.abs(found.shares[:, number] - exact).max() < 1e-14 * np.abs(exact).max(), joint.name


def test_true_extremes_on_the_sphere_by_brute_force() -> None:
    """Holes turned about axes across them: none of many lies beyond the extremes, and the best come close."""
    mechanism = with_play("spherical-four-bar", ON_SPHERE)
    joints = play_of(mechanism)
    found = clearance_extents(ready(mechanism), {"u": "joint_angle.DC"}, joints, 25)["u"]
    worst = int(np.argmax(found.first_order))
    free = with_free_joints(mechanism, joints)
    paths = [
        f"links.{joint.body}.points.{joint.point}.{axis}"
        for joint in joints
        for axis in ("longitude", "latitude")
    ]
    at = [float(np.array(ct.motion(mechanism, 25)["drive_value"])[worst, 0])]
    moving = ct.solver(free, paths, at=at, outputs="joint_angle.DC")
    nominal = float(np.ravel(moving.outputs(list(moving.own)))[0])
    deviations = []
    for angles in np.random.default_rng(5).uniform(0, 2 * np.pi, (1500, len(joints))):
        values: list[float] = []
        for joint, angle in zip(joints, angles, strict=True):
            longitude, latitude = mechanism.links[joint.body].coordinates[joint.point]
            # holes of arcs lie on the equator of their link
            assert latitude == 0.0
            x = np.cos(joint.play)
            y, z = np.sin(joint.play) * np.cos(angle), np.sin(joint.play) * np.sin(angle)
            values += [longitude + float(np.arctan2(y, x)), float(np.arcsin(z))]
        deviations.append(float(np.ravel(moving.outputs(values))[0]) - nominal)
    assert found.lower <= min(deviations)
    assert max(deviations) <= found.upper
    assert max(deviations) > 0.93 * found.upper
    assert min(deviations) < 0.93 * found.lower
    assert found.upper == pytest.approx(float(found.first_order[worst]), rel=0.05)


def test_sides_that_forces_choose_on_the_sphere() -> None:
    """A moment on the rocker alone presses every pin to where the rocker gives way."""
    text = ct.mechanism_text(ct.example("spherical-four-bar")).replace("speed = 1.0", "speed = 1e-9")
    load = '\n[[loads]]\nkind = "torque"\nlink = "DC"\nvalue = -1\n[tolerances.clearances]\n'
    loaded = ct.parse_mechanism(text + load + ON_SPHERE)
    found = clearance_extents(ready(loaded), {"u": "joint_angle.DC"}, play_of(loaded), 37)["u"]
    assert found.by_force is not None
    assert found.by_force == pytest.approx(-found.first_order, rel=1e-9)


@pytest.mark.parametrize(
    ("output", "told"), [("joint_force.B/BC.x", "moves positions"), ("reduced_inertia", "moves positions")]
)
def test_forces_by_play_on_the_sphere_are_refused(output: str, told: str) -> None:
    mechanism = with_play("spherical-crank-rocker-rigid", 'B = "0.1 deg"\n')
    with pytest.raises(ct.InputError, match=told):
        clearance_extents(ready(mechanism), {"output": output}, play_of(mechanism))


def test_guides_on_the_sphere_are_refused() -> None:
    mechanism = with_play("spherical-crank-guide", 'B = "0.1 deg"\n')
    with pytest.raises(ct.InputError, match="without guides"):
        clearance_extents(ready(mechanism), {"x": "position.C.x"}, play_of(mechanism))


def test_holes_at_a_pole_of_their_link_are_refused() -> None:
    text = ct.mechanism_text(ct.example("spherical-four-bar"))
    turned = text.replace(
        '[links.BC]\nlength = "0.7853981633974483 rad"',
        '[links.BC]\npoints = { B = [0, "90 deg"], C = [0, "45 deg"] }',
    )
    mechanism = ct.parse_mechanism(turned + '\n[tolerances.clearances]\nB = "0.1 deg"\n')
    with pytest.raises(ct.InputError, match="pole of its link"):
        ct.tolerances(mechanism, "joint_angle.DC", {"links.AB.length": (-1e-4, 1e-4)}, draws=10)
