"""Radial forces of pairs of gears in reactions, against the equilibrium of each wheel and against refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.errors import InputError

SHAFTS = """
[frame.points]
O = [0, 0]
C = [{distance}, 0]
[links.OA]
points = {{ O = [0, 0], A = ["18 mm", 0] }}
[links.CB]
points = {{ C = [0, 0], B = ["37 mm", 0] }}
angle = 0.0
[[gears]]
links = ["OA", "CB"]
{gear}
[[loads]]
kind = "torque"
link = "CB"
value = {moment}
[[drives]]
link = "OA"
start = 0
speed = "60 rpm"
"""
EXTERNAL = 'pair = "shifted-gear-pair"'
DISTANCE = 0.0564998697


def _shafts(gear: str = EXTERNAL, distance: float = DISTANCE, moment: float = 20.0) -> ct.Mechanism:
    return ct.parse_mechanism(SHAFTS.format(gear=gear, distance=distance, moment=moment))


@pytest.mark.parametrize("moment", [20.0, -20.0])
def test_an_external_pair_presses_its_axes_apart(moment: float) -> None:
    """F_t = M/r_w and F_r = F_t tan(alpha_w), the same whichever way the load turns; hinges bear both."""
    found = ct.reactions(_shafts(moment=moment), samples=3)
    pair = ct.gear_pair("shifted-gear-pair").geometry
    tangential = abs(moment) / (pair.wheels[1].working_pitch / 2)
    radial = tangential * math.tan(pair.working_angle)
    on_wheel = found.tooth_radial_force.sel(gear="OA-CB").to_numpy()
    assert np.allclose(on_wheel, [radial, 0.0], rtol=1e-6)
    for side, sign in (("C/CB", -1), ("O/OA", 1)):
        pin = found.joint_force.sel(side=side).to_numpy()
        assert np.allclose(pin[:, 0], sign * radial, rtol=1e-6)
        assert np.allclose(np.abs(pin[:, 1]), tangential, rtol=1e-6)
    frame = found.joint_force.sel(side="C/frame").to_numpy()
    assert np.allclose(frame[:, 0], radial, rtol=1e-6)


@pytest.mark.parametrize("moment", [20.0, -20.0])
def test_friction_in_a_hinge_feels_the_radial_force(moment: float) -> None:
    """The pin bears both parts of the tooth force: F_t / cos(alpha_w), by which the bearing rubs."""
    rough = """
[[loads]]
kind = "friction"
point = "C"
coefficient = 0.1
radius = "5 mm"
"""
    text = SHAFTS.format(gear=EXTERNAL, distance=DISTANCE, moment=moment) + rough
    found = ct.reactions(ct.parse_mechanism(text), samples=3)
    pair = ct.gear_pair("shifted-gear-pair").geometry
    radius, angle = pair.wheels[1].working_pitch / 2, pair.working_angle
    # The wheel turns with -30 rpm and friction acts against that: it adds to a positive load.
    arm = 0.1 * 0.005 / math.cos(angle)
    tangential = abs(moment) / (radius - math.copysign(arm, moment))
    pin = found.joint_force.sel(side="C/CB").to_numpy()
    assert np.allclose(np.hypot(*pin.T), tangential / math.cos(angle), rtol=1e-6)


ROUGH = """
[[loads]]
kind = "friction"
point = "{point}"
coefficient = {coefficient}
radius = "5 mm"
"""
ORBIT = """
[frame.points]
O = [0, 0]
[links.arm]
points = {{ O = [0, 0], A = [{distance}, 0] }}
[links.planet]
points = {{ A = [0, 0], B = ["37 mm", 0] }}
angle = 0.0
[[gears]]
links = ["frame", "planet"]
carrier = "arm"
pair = "shifted-gear-pair"
[[loads]]
kind = "torque"
link = "planet"
value = {moment}
[[drives]]
link = "arm"
start = 0
speed = "{speed} rpm"
"""


@pytest.mark.parametrize("speed", [60, -60])
@pytest.mark.parametrize("moment", [20.0, -20.0])
def test_friction_takes_power_in_both_senses_of_rotation_and_of_power(speed: int, moment: float) -> None:
    """What drives and the load give what both hinges rub away: mu r F |omega| by their whole forces."""
    text = SHAFTS.replace('speed = "60 rpm"', f'speed = "{speed} rpm"')
    text = text.format(gear=EXTERNAL, distance=DISTANCE, moment=moment)
    text += ROUGH.format(point="O", coefficient=0.1) + ROUGH.format(point="C", coefficient=0.2)
    found = ct.reactions(ct.parse_mechanism(text), samples=3)
    first = speed * math.tau / 60
    second = -first / 2
    forces = {side: np.hypot(*found.joint_force.sel(side=side).to_numpy().T) for side in ("O/OA", "C/CB")}
    rubbed = 0.005 * (0.1 * forces["O/OA"] * abs(first) + 0.2 * forces["C/CB"] * abs(second))
    assert (rubbed > 0.5).all()
    assert np.allclose(found.balancing[:, 0] * first + moment * second, rubbed, rtol=1e-9)
    # The teeth press the axes apart by the tangential force that is left with friction.
    pair = ct.gear_pair("shifted-gear-pair").geometry
    wheel, angle = pair.wheels[1].working_pitch / 2, pair.working_angle
    helps = math.copysign(1.0, moment * second)
    tangential = abs(moment) / (wheel + helps * 0.2 * 0.005 / math.cos(angle))
    assert np.allclose(np.abs(found.tooth_force[:, 0, 1]), tangential, rtol=1e-6)
    assert np.allclose(found.tooth_radial_force[:, 0, 0], tangential * math.tan(angle), rtol=1e-6)


@pytest.mark.parametrize("speed", [60, -60])
@pytest.mark.parametrize("moment", [20.0, -20.0])
def test_friction_takes_power_on_a_carrier_that_moves(speed: int, moment: float) -> None:
    """A planet on a fixed sun: its pin rubs with the speed against the arm, that of the arm with the arm's own."""
    text = ORBIT.format(distance=DISTANCE, moment=moment, speed=speed)
    text += ROUGH.format(point="O", coefficient=0.15) + ROUGH.format(point="A", coefficient=0.15)
    found = ct.reactions(ct.parse_mechanism(text), samples=5)
    arm = speed * math.tau / 60
    planet = arm * (1 + 12 / 24)  # Willis: the sun is wheel 1, of 12 teeth
    pins = {
        side: np.hypot(*found.joint_force.sel(side=side).to_numpy().T)
        for side in map(str, found.side.to_numpy())
    }
    on_planet, on_arm = pins["A/planet"], pins["O/frame"]
    rubbed = 0.15 * 0.005 * (on_planet * abs(planet - arm) + on_arm * abs(arm))
    assert (rubbed > 0.1).all()
    assert np.allclose(found.balancing[:, 0] * arm + moment * planet, rubbed, rtol=1e-8)


@pytest.mark.parametrize("moment", [20.0, -20.0])
def test_polygons_have_the_whole_force_between_teeth(moment: float) -> None:
    """The graphic way gives the pins of both wheels as the equations do, the radial part included."""
    mechanism = _shafts(moment=moment)
    found, exact = ct.force_polygons(mechanism, 0.3), ct.reactions(mechanism, at=[0.3])
    forces = {name: np.array([force.real, force.imag]) for name, force in found.reactions.items()}
    sizes = sorted(float(np.hypot(*force)) for force in forces.values())
    expected = {float(np.hypot(*exact.joint_force.sel(side=side).to_numpy()[0])) for side in ("O/OA", "C/CB")}
    for size in expected:
        assert min(abs(size - one) for one in sizes) < 1e-9 * size
    assert not any("radial component" in repr(step) for step in found.steps)


def test_a_ring_presses_its_pinion_towards_its_centre() -> None:
    pair = ct.gear_pair("internal-gear-pair").geometry
    distance = (
        -pair.centre_distance
    )  # the ring's centre lies to the left: the teeth mesh to the right of the pinion
    found = ct.reactions(_shafts('pair = "internal-gear-pair"', distance), samples=3)
    radial = 20.0 / (pair.wheels[1].working_pitch / 2) * math.tan(pair.working_angle)
    assert np.allclose(found.tooth_radial_force.isel(gear=0), [radial, 0.0], rtol=1e-9)
    assert np.allclose(found.joint_force.sel(side="O/OA", axis="x"), radial, rtol=1e-9)
    assert found.gear.to_numpy().tolist() == ["OA-CB"]


def test_what_is_without_a_pair_has_no_radial_force() -> None:
    bare, paired = (ct.reactions(_shafts(gear), samples=3) for gear in ("ratio = -0.5", EXTERNAL))
    assert "tooth_radial_force" not in bare
    assert np.allclose(bare.tooth_force, paired.tooth_force, rtol=1e-12)
    assert np.allclose(bare.balancing, paired.balancing, rtol=1e-12)
    assert np.allclose(bare.frame_force, paired.frame_force, rtol=1e-12, atol=1e-9)


def test_a_pair_is_read_back_with_its_ratio() -> None:
    mechanism = _shafts()
    assert mechanism.gears[0].ratio == -0.5
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
    helical = ct.gear_pair("helical-gear-pair").geometry.centre_distance
    degrees = 'display = { angle = "deg" }\n' + SHAFTS.format(
        gear='pair = "helical-gear-pair"', distance=helical, moment=1
    )
    mechanism = ct.parse_mechanism(degrees)
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism


@pytest.mark.parametrize(
    "name", [name for name in ct.example_names("gear pair") if name not in ("rack-gear-pair",)]
)
def test_the_working_mesh_is_that_of_the_geometry(name: str) -> None:
    described = ct.example(name)
    if described.purpose is not None and described.centre_distance is None:
        pytest.skip("its shifts are chosen for a purpose")
    angle, distance = described.working_mesh()
    geometry = ct.gear_pair(name).geometry
    assert angle == pytest.approx(geometry.working_angle, rel=1e-12)
    assert distance == pytest.approx(geometry.centre_distance, rel=1e-12)


@pytest.mark.parametrize(
    ("gear", "distance", "said"),
    [
        (EXTERNAL, 0.057, "the centres are 0.057 m apart, and the pair meshes at 0.0564998697 m"),
        (EXTERNAL + "\nratio = -0.4", DISTANCE, "not that of the pair, -0.5"),
        ('pair = "rack-gear-pair"', DISTANCE, "keeps no ratio of angles"),
        ('pair = "crank-rocker"', DISTANCE, "no built-in pair of gears"),
        ('pair = "nothing.toml"', DISTANCE, "nothing.toml"),
        ('pair = "../pair.toml"', DISTANCE, "not in the folder"),
        ("pair = 3", DISTANCE, "expected the name"),
        ('pair = { kind = "cam" }', DISTANCE, "not a pair of gears"),
        (
            'pair = { kind = "gear pair", module = "3 mm", teeth = [12, 24], shifts = "strength" }',
            DISTANCE,
            "chosen for a purpose",
        ),
        ('pair = { kind = "gear pair", module = "3 mm", teeth = [3, 24] }', DISTANCE, "whole number"),
    ],
)
def test_refusals(gear: str, distance: float, said: str) -> None:
    with pytest.raises(InputError) as refusal:
        _shafts(gear, distance)
    assert said in str(refusal.value)
    assert "[[gears]] 1" in str(refusal.value)


def test_there_is_no_pair_on_the_sphere() -> None:
    text = ct.mechanism_text(ct.example("bevel-pair"))
    line = next(line for line in text.splitlines() if line.startswith("ratio ="))
    with pytest.raises(InputError, match="none on the sphere"):
        ct.parse_mechanism(text.replace(line, 'pair = "shifted-gear-pair"'))
