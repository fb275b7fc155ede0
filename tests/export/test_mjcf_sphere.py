"""Models for MuJoCo of spherical linkages: driven and free they move as ours do."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.export.mjcf import mjcf_text, omitted_loads
from centrode.kinematics.motion import initial_place

mujoco = pytest.importorskip("mujoco", reason="models are tried in MuJoCo")

DRIVEN = (
    "bevel-differential", "bevel-pair", "hookes-joint", "spherical-crank-guide", "spherical-crank-rocker-rigid",
    "spherical-crank-rocker-touching", "spherical-four-bar", "wobble-plate",
)  # fmt: skip
MOMENTS = 12
SOFT = 4e-6
"""What constraints of MuJoCo leave, in the radius of the sphere."""


def model_of(mechanism: ct.Mechanism, *, free: bool = False) -> str:
    return mjcf_text(mechanism, ct.motion(mechanism, at=[initial_place(mechanism)]), free=free)


@pytest.mark.parametrize("name", DRIVEN)
def test_the_driven_motion_is_ours(name: str) -> None:
    mechanism = ct.example(name)
    model = mujoco.MjModel.from_xml_string(model_of(mechanism))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    assert float(np.abs(data.efc_pos).max(initial=0.0)) <= 1e-15
    speeds = [drive.speed for drive in mechanism.drives]
    assert all(speeds)
    steps = int(2 * math.pi / abs(speeds[0] or 1.0) / model.opt.timestep / MOMENTS)
    turned, places, left = [], [], 0.0
    for _moment in range(MOMENTS):
        mujoco.mj_step(model, data, steps)
        mujoco.mj_forward(model, data)
        turned.append(data.actuator_length[: len(speeds)].copy())
        places.append(data.site_xpos.copy())
        left = max(left, float(np.abs(data.efc_pos).max(initial=0.0)))
    moved = np.array(turned)
    assert abs(moved[-1, 0]) == pytest.approx(2 * math.pi, rel=0.01)
    # by several drives the motion is one in time: they have run as far as they have in that of the first
    at = initial_place(mechanism) + (moved[:, 0] if len(speeds) == 1 else moved[:, 0] / (speeds[0] or 1.0))
    assert np.abs(moved / moved[:, :1] - np.array(speeds) / (speeds[0] or 1.0)).max() < 1e-3
    motion = ct.motion(mechanism, at=at)
    points = [model.site(k).name.partition(".")[2] for k in range(model.nsite)]
    ours = mechanism.sphere_radius * motion.position.sel(point=points).to_numpy()
    bound = SOFT if len(speeds) == 1 else 1e-2  # each of several drives lags by its own
    assert left <= SOFT * mechanism.sphere_radius
    assert np.abs(np.array(places) - ours).max() <= bound * mechanism.sphere_radius


FALLING = """
    title = "Spherical four-bar that falls on springs"
    space = "sphere"
    radius = 0.4
    gravity = [0, 0, -9.81]
    frame.points = { A = [1, 0, 0], D = [0, 1, 0], F = ["45 deg", "30 deg"] }
    links.AB = { length = "25 deg", reference = ["A", "D"], mass = 0.8, shape = "arc" }
    drives = [{ link = "AB", start = 0.7, speed = 1 }]
    assembly.sides = { C = "left" }
    [links.DC]
    length = "90 deg"
    reference = ["D", "A"]
    mass = 0.5
    shape = "disc"
    radius = 0.1
    centre = "D"
    centre_radius = 0.5
    [links.BC]
    length = "60 deg"
    mass = 0.9
    centre = ["25 deg", "3 deg"]
    centre_radius = 0.35
    inertia = [[0.03, 0, 0], [0, 0.06, 0.01], [0, 0.01, 0.07]]
    [[loads]]
    kind = "spring"
    points = ["B", "F"]
    stiffness = 40
    free_length = 0.2
    [[loads]]
    kind = "damper"
    points = ["C", "F"]
    damping = 0.8
    [[loads]]
    kind = "spring"
    link = "DC"
    stiffness = 2
    free_angle = "45 deg"
    [[loads]]
    kind = "friction"
    link = "AB"
    viscous = 0.05
    [[loads]]
    kind = "damper"
    link = "BC"
    relative_to = "AB"
    damping = 0.03
    [[loads]]
    kind = "torque"
    link = "DC"
    value = 0.7
    [[loads]]
    kind = "force"
    point = "C"
    vector = [0.5, 1, -1]
    """
PENDULUM = """
    title = "Spherical double pendulum"
    space = "sphere"
    radius = 0.5
    gravity = [0, 0, -9.81]
    frame.points = { A = [1, 0, 0], Z = [0, 0, 1] }
    links.AB = { length = "70 deg", reference = ["A", "Z"], mass = 1.2, shape = "arc" }
    links.BC = { length = "50 deg", reference = ["B", "A"], mass = 0.7, shape = "arc" }
    drives = [{ link = "AB", start = 1.2, speed = 1 }, { link = "BC", relative_to = "AB", start = 0.5, speed = 1 }]
    """
DIFFERENTIAL = """
    title = "Bevel differential with masses beside its shafts"
    space = "sphere"
    radius = 0.3
    gravity = [0, 0, -9.81]
    frame.points = { A = [1, 0, 0], Y = [0, 1, 0] }
    links.AP = { points = { A = [1, 0, 0], P = ["90 deg", 0] }, reference = ["A", "Y"], mass = 0.5, shape = "arc" }
    drives = [{ link = "left", start = 0, speed = 1 }, { link = "right", start = 0, speed = 1 }]
    [links.left]
    points = { A = [1, 0, 0], L = ["50 deg", 0] }
    reference = ["A", "Y"]
    mass = 1
    centre = "L"
    inertia = 0.01
    [links.right]
    points = { A = [1, 0, 0], R = ["130 deg", 0] }
    reference = ["A", "Y"]
    mass = 1
    centre = "A"
    inertia = 0.02
    [links.planet]
    points = { P = [1, 0, 0], Q = ["38 deg", 0] }
    reference = ["P", "A"]
    mass = 0.4
    centre = "Q"
    inertia = 0.004
    [[gears]]
    links = ["left", "planet"]
    ratio = -1.25
    carrier = "AP"
    [[gears]]
    links = ["right", "planet"]
    ratio = 1.25
    carrier = "AP"
    """
GUIDED = """
    title = "Crank and guide on the sphere"
    space = "sphere"
    radius = 0.4
    gravity = [1, 2, -9.81]
    frame.points = { A = [1, 0, 0], D = [0, 1, 0] }
    links.AB = { length = "25 deg", reference = ["A", "D"], mass = 0.8, shape = "arc" }
    links.BC = { length = "60 deg", mass = 0.8, shape = "arc" }
    guides = [{ point = "C", on = "frame", pole = "D", radius = "80 deg" }]
    drives = [{ link = "AB", start = 0.7, speed = 1 }]
    assembly.sides = { C = "left" }
    """
FREE = {
    "four-bar": FALLING,
    "double pendulum": PENDULUM,
    "differential": DIFFERENTIAL,
    "guide": GUIDED,
}
AT_SPEED = {"guide": 2.0}
"""Initial speeds of the drive [rad/s]; the others are at rest."""


@pytest.mark.parametrize("name", FREE)
def test_free_motions_are_those_of_a_simulation(name: str) -> None:
    told = f"duration = 1\nequations = 'multibody'\nsamples = 11\nspeed = {AT_SPEED.get(name, 0.0)}"
    mechanism = ct.parse_mechanism(f"{FREE[name]}\n[simulation]\n{told}\n")
    first = ct.motion(mechanism, at=[initial_place(mechanism)])
    assert omitted_loads(mechanism, first) == {}
    model = mujoco.MjModel.from_xml_string(mjcf_text(mechanism, first, free=True))
    model.opt.timestep = 2e-4
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_step(model, data, 5000)
    mujoco.mj_forward(model, data)
    course = ct.simulate(mechanism)
    sites = {model.site(k).name.partition(".")[2]: k for k in range(model.nsite)}
    points = [point for point in course.point.values if point in sites]
    ours = mechanism.sphere_radius * course.position.sel(point=points).values
    found = data.site_xpos[[sites[point] for point in points]]
    assert np.abs(found - ours[-1]).max() <= 1e-4 * mechanism.sphere_radius
    assert np.abs(ours[-1] - ours[0]).max() > 0.1 * mechanism.sphere_radius  # it has moved


def test_masses_are_those_of_the_description() -> None:
    mechanism = ct.parse_mechanism(FALLING)
    model = mujoco.MjModel.from_xml_string(model_of(mechanism))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert [float(model.body(name).mass[0]) for name in ("AB", "BC", "DC")] == [0.8, 0.9, 0.5]
    # a thin even arc: its centre is R sin h/h from the centre of the sphere, in the middle between its ends
    half, radius = math.radians(12.5), 0.4
    ends = (
        ct.motion(mechanism, at=[initial_place(mechanism)])
        .position.sel(point=["A", "B"])
        .values[0]
        .sum(axis=0)
    )
    middle = ends / np.linalg.norm(ends) * radius * math.sin(half) / half
    assert np.abs(data.body("AB").xipos - middle).max() <= 1e-12
    # moments of a body are those of its tensor: about its own z through the centre of mass 0.07 coupled to 0.06
    wanted = np.linalg.eigvalsh([[0.03, 0, 0], [0, 0.06, 0.01], [0, 0.01, 0.07]])
    assert np.sort(model.body("BC").inertia) == pytest.approx(wanted, rel=1e-9)


def test_a_ring_and_point_mass_that_moves_is_refused() -> None:
    with pytest.raises(ct.NotComputedYet, match="BC is a ring and a point mass"):
        model_of(ct.example("spherical-crank-rocker"))


def test_loads_that_are_not_in_the_model_are_named() -> None:
    mechanism = ct.example("spherical-crank-rocker-rigid")
    first = ct.motion(mechanism, at=[initial_place(mechanism)])
    labels = [load.label for load in mechanism.loads]
    assert omitted_loads(mechanism, first) == dict.fromkeys(labels, "dry or quadratic friction")
