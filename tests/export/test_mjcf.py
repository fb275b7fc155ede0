"""Models for MuJoCo: loaded there, they move as ours do, up to what MuJoCo itself leaves of its constraints."""

from __future__ import annotations

import math
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import centrode as ct
from centrode.export.mjcf import mjcf_text, omitted_loads
from centrode.kinematics.motion import initial_place
from centrode.model.examples import example_text
from samples import examples_at_hand

mujoco = pytest.importorskip("mujoco", reason="models are tried in MuJoCo")

FULL_TURN = (
    "andrews-squeezer", "crank-rocker", "drag-link", "four-bar-and-slider", "fourth-class-group", "geared-five-bar",
    "inverted-slider-crank", "jansen-leg", "klann-leg", "oscillating-cylinder", "planetary-gear-train", "scotch-yoke",
    "shaper", "six-bar-press", "slider-between-cranks", "stephenson-six-bar", "third-class-triad", "rack-and-pinion",
    "planetary-hypocycloid", "cardan-gear",
)  # fmt: skip
ELSEWHERE = (
    "excavator-arm",
    "five-bar-two-drives",
    "scissor-lift-cylinder",
    "two-link-arm",
    "wiper",
    "elliptic-trammel",
    "rolling-wheel-rod",
)
MOMENTS = 12
AMPLIFIED = 8
"""A point may be off by the constraints' violation over the sine of the least transmission angle, here above 7 deg."""


def model_of(name: str) -> tuple[ct.Mechanism, str]:
    mechanism = ct.example(name)
    return mechanism, mjcf_text(mechanism, ct.motion(mechanism, at=[initial_place(mechanism)]))


@pytest.mark.parametrize("name", FULL_TURN)
def test_the_driven_motion_is_ours(name: str) -> None:
    mechanism, text = model_of(name)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    speed, start = mechanism.drives[0].speed, initial_place(mechanism)
    assert speed is not None
    steps = int(2 * math.pi / abs(speed) / model.opt.timestep / MOMENTS)
    values, places, left = [], [], 0.0
    for _moment in range(MOMENTS):
        mujoco.mj_step(model, data, steps)
        mujoco.mj_forward(model, data)
        values.append(start + float(data.actuator_length[0]))
        places.append(data.site_xpos[:, :2].copy())
        left = max(left, float(np.abs(data.efc_pos).max(initial=0.0)))
    assert abs(abs(values[-1] - start) / (2 * math.pi) - 1) < 0.01  # the drive has turned once
    motion = ct.motion(mechanism, at=values)
    points = [model.site(k).name.partition(".")[2] for k in range(model.nsite)]
    ours = motion.position.sel(point=points).to_numpy()
    size = float(np.ptp(ours, axis=(0, 1)).max())
    assert left <= 1e-4 * size
    assert np.abs(np.array(places) - ours).max() <= AMPLIFIED * left + 1e-12 * size


@pytest.mark.parametrize("name", examples_at_hand((*FULL_TURN, *ELSEWHERE)))
def test_loops_close_at_the_assembled_pose(name: str) -> None:
    mechanism, text = model_of(name)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    size = float(np.ptp(data.site_xpos[:, :2], axis=0).max())
    assert float(np.abs(data.efc_pos).max(initial=0.0)) <= 1e-12 * size
    if not mechanism.gears and not mechanism.rolling:
        # each loop is one pin too many for a tree
        assert model.neq == ct.check(mechanism).count.loops


def test_masses_and_gravity_are_those_of_the_description() -> None:
    mechanism, text = model_of("six-bar-press")
    root = ET.fromstring(text)
    masses = {body.attrib["name"]: float(body.find("inertial").attrib["mass"]) for body in root.iter("body")}  # type: ignore[union-attr]
    assert {name: masses[name] for name in ("AB", "CD", "DH", "slider")} == {
        "AB": 9,
        "CD": 16,
        "DH": 22,
        "slider": 3.5,
    }
    assert root.find("option").attrib["gravity"] == "0.0 -10.0 0.0"  # type: ignore[union-attr]
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    motion = ct.motion(mechanism, at=[initial_place(mechanism)])
    middle = data.body("DH").xipos[:2]
    assert np.allclose(middle, motion.position.sel(point="S4")[0], rtol=0, atol=1e-12)
    assert float(model.body("CD").inertia.max()) == pytest.approx(0.55, rel=1e-12)


def test_hostile_names_are_names() -> None:
    text = ct.mechanism_text(ct.example("crank-rocker")).replace(
        'title = "', 'title = "<a href=\\"x\\">& ', 1
    )
    mechanism = ct.parse_mechanism(text)
    model = mjcf_text(mechanism, ct.motion(mechanism, at=[0.0]))
    assert ET.fromstring(model).attrib["model"] == mechanism.title
    mujoco.MjModel.from_xml_string(model)


WEDGES = """
    title = "Wedge press"
    links.wedge = { points = { W = [0, 0], V = [1, 0.5] }, angle = 0 }
    links.ram = { points = { R = [0, 0] }, angle = 0 }
    drives = [{ guide = "W", start = 0, speed = -0.1 }]
    [[guides]]
    point = "W"
    on = "frame"
    through = [0, 0]
    direction = [1, 0]
    link = "wedge"
    [[guides]]
    point = "R"
    on = "frame"
    through = [0.6, 0]
    direction = [0, 1]
    link = "ram"
    [[guides]]
    point = "R"
    on = "wedge"
    name = "face"
    through = [0, 0]
    direction = [2, 1]
    link = "ram"
    """


def test_a_loop_of_prismatic_pairs_closes_in_a_carriage() -> None:
    mechanism = ct.parse_mechanism(WEDGES)
    text = mjcf_text(mechanism, ct.motion(mechanism, at=[0.0]))
    assert any(body.attrib["name"].startswith("carriage") for body in ET.fromstring(text).iter("body"))
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_step(model, data, round(2.0 / model.opt.timestep))
    mujoco.mj_forward(model, data)
    wedge, ram = data.site("wedge.W").xpos, data.site("ram.R").xpos
    assert wedge[0] == pytest.approx(-0.2, rel=1e-3)  # -0.1 m/s for two seconds, less the run-up
    left = float(np.abs(data.efc_pos).max(initial=0.0))
    # on the face, which rises by half of its way
    assert abs(ram[0] - 0.6) <= 2 * left + 1e-12
    assert abs(ram[1] - 0.5 * (0.6 - wedge[0])) <= 2 * left + 1e-12


@pytest.mark.parametrize("name", ["cam-driven-linkage", "wiper", "relative"])
def test_a_law_is_followed_as_told(name: str) -> None:
    """The drive lags by 2 tau: q + 2 tau q' + J q''/kp = v, J/kp <= tau^2; with v + 2 tau v' the lag is taken out."""
    if name == "relative":
        text = example_text("two-link-arm").replace("speed = -2.0", 'law = "sin(2*t)"')
        mechanism = ct.parse_mechanism(text)
    else:
        mechanism = ct.example(name)
    start = initial_place(mechanism)
    model = mujoco.MjModel.from_xml_string(mjcf_text(mechanism, ct.motion(mechanism, at=[start])))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    step = float(model.opt.timestep)
    tau = 10 * step
    times = start + step * np.arange(2000)
    motion = ct.motion(mechanism, at=times)
    ruled = [k for k, drive in enumerate(mechanism.drives) if drive.speed is None]
    values = motion["drive_value"].to_numpy()[:, ruled]
    values = values - values[0]
    rates = np.gradient(values, step, axis=0)
    bends = np.gradient(rates, step, axis=0)
    found = []
    for value, rate in zip(values, rates, strict=True):
        data.ctrl[ruled] = value + 2 * tau * rate
        mujoco.mj_forward(model, data)
        found.append(data.actuator_length[ruled].copy())
        mujoco.mj_step(model, data)
    away = np.abs(np.array(found) - values)
    assert away.max() <= tau**2 * np.abs(bends).max() + step * np.abs(rates).max()
    assert np.abs(values).max() > 100 * away.max()  # it has moved


def test_what_is_too_light_for_mujoco_is_refused() -> None:
    links = "{ OA.length = 1e-6, AB.length = 3e-6, DB.length = 3e-6 }"
    mechanism = ct.parse_mechanism(f"""
        frame.points = {{ O = [0, 0], D = [4e-6, 0] }}
        links = {links}
        drives = [{{ link = "OA", start = 0, speed = 1 }}]
        assembly.sides = {{ B = "left" }}
        """)
    with pytest.raises(ct.NotComputedYet, match="1e-15"):
        mjcf_text(mechanism, ct.motion(mechanism, at=[0.0]))


SWUNG = """
    title = "Crank on springs"
    gravity = [0, -9.81]
    frame.points = { O = [0, 0], D = [4, 0], F = [1, 3] }
    links.OA = { length = 1, mass = 2, shape = "rod" }
    links.AB = { length = 3.5, mass = 3, shape = "rod" }
    links.DB = { length = 3, mass = 3, shape = "rod" }
    drives = [{ link = "OA", start = 1, speed = 1 }]
    assembly.sides = { B = "left" }
    [[loads]]
    kind = "spring"
    points = ["A", "F"]
    stiffness = "60 N/m"
    free_length = 1.5
    [[loads]]
    kind = "damper"
    points = ["B", "F"]
    damping = "4 N s/m"
    [[loads]]
    kind = "spring"
    link = "AB"
    relative_to = "DB"
    stiffness = "12 N m/rad"
    free_angle = -2.0
    [[loads]]
    kind = "damper"
    link = "DB"
    damping = "1.5 N m s/rad"
    [[loads]]
    kind = "torque"
    link = "OA"
    relative_to = "AB"
    value = 8
    [[loads]]
    kind = "force"
    point = "B"
    vector = [5, 12]
    [simulation]
    duration = 1
    equations = "multibody"
    samples = 11
    """


BOWL = """
    title = "Disc that rolls in a bowl, on a spring"
    gravity = [0, -9.81]
    frame.points = { O = [0, 0], F = [0.3, 0.5] }
    links.OC = { length = 0.8, mass = 0.5, shape = "rod" }
    links.disc = { points = { C = [0, 0], P = [0.15, 0] }, angle = 0, mass = 2, centre = "C", inertia = 0.04 }
    rolling = [{ link = "disc", centre = "C", radius = 0.2, along = { centre = [0, 0], radius = 1, inside = true } }]
    drives = [{ link = "OC", start = -0.9, speed = 1 }]
    [[loads]]
    kind = "spring"
    points = ["P", "F"]
    stiffness = "20 N/m"
    free_length = 0.4
    [simulation]
    duration = 1
    equations = "multibody"
    samples = 11
    """
FLOOR = """
    title = "Wheel on a floor with a rod and a slider"
    gravity = [0, -9.81]
    links.wheel = { points = { C = [0, 0], P = [0.3, 0] }, angle = 0.8, mass = 3, centre = "P", inertia = 0.2 }
    links.PB = { length = 1.2, angle = -0.1, mass = 1, shape = "rod" }
    guides = [{ point = "B", on = "frame", through = [0, 0.3], direction = [1, 0] }]
    rolling = [{ link = "wheel", centre = "C", radius = 0.3, along = { through = [0, 0], direction = [1, 0] } }]
    drives = [{ link = "wheel", start = 0.8, speed = 1 }]
    assembly.sides = { B = "ahead" }
    [[loads]]
    kind = "force"
    point = "P"
    axes = "wheel"
    vector = [1, 4]
    [[loads]]
    kind = "weight"
    point = "P"
    value = 6
    [[loads]]
    kind = "weight"
    link = "PB"
    value = 25
    [simulation]
    duration = 1
    equations = "multibody"
    samples = 11
    """
RACK = """
    title = "Pinion that a rack turns"
    gravity = [0, -9.81]
    frame.points = { O = [0, 0] }
    links.pinion = { points = { O = [0, 0], M = [0.1, 0] }, mass = 2, centre = "M", inertia = 0.05 }
    links.rack = { points = { H = [0, 0], E = [0.6, 0] }, angle = 0, mass = 1, centre = "H", inertia = 0.1 }
    guides = [{ point = "H", on = "frame", through = [0, -0.1], direction = [1, 0], link = "rack" }]
    drives = [{ link = "pinion", start = 0.4, speed = 1 }]
    [[rolling]]
    link = "pinion"
    centre = "O"
    radius = 0.1
    on = "rack"
    along = { through = [0, 0], direction = [1, 0] }
    [[loads]]
    kind = "force"
    point = "E"
    vector = [4, 0]
    [simulation]
    duration = 1
    equations = "multibody"
    samples = 11
    """
WRITTEN = {"on springs": SWUNG, "in a bowl": BOWL, "on a floor": FLOOR, "on a rack": RACK}


@pytest.mark.parametrize("name", ["double-pendulum", "five-bar-pendulum", "andrews-mechanism", *WRITTEN])
def test_free_motions_are_those_of_a_simulation(name: str) -> None:
    mechanism = ct.parse_mechanism(WRITTEN[name]) if name in WRITTEN else ct.example(name)
    first = ct.motion(mechanism, at=[initial_place(mechanism)])
    assert omitted_loads(mechanism, first) == {}
    model = mujoco.MjModel.from_xml_string(mjcf_text(mechanism, first, free=True))
    assert mechanism.simulation is not None and mechanism.simulation.duration is not None
    span = min(1.0, mechanism.simulation.duration)
    model.opt.timestep = span / round(span / min(model.opt.timestep, 2e-4))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_step(model, data, round(span / model.opt.timestep))
    mujoco.mj_forward(model, data)
    course = ct.simulate(mechanism)
    end = int(np.argmin(np.abs(course.time.values - span)))
    assert course.time.values[end] == pytest.approx(span, abs=1e-12)
    sites = {model.site(k).name.partition(".")[2]: k for k in range(model.nsite)}
    points = [point for point in course.point.values if point in sites]
    ours = course.position.sel(point=points).values
    size = float(np.ptp(ours, axis=(0, 1)).max())
    assert np.abs(data.site_xpos[[sites[point] for point in points], :2] - ours[end]).max() <= 1e-4 * size
    # it has moved
    assert np.abs(ours[end] - ours[0]).max() > 0.05 * size


LEFT_OUT = """
    title = "Slider-crank with loads of all kinds"
    gravity = [0, -9.81]
    frame.points = { O = [0, 0], D = [4, 0] }
    links.OA = { length = 1, mass = 2, shape = "rod" }
    links.AB = { length = 3.5, mass = 3, shape = "rod" }
    links.DB = { length = 3, mass = 3, shape = "rod" }
    drives = [{ link = "OA", start = 1, speed = 1 }]
    assembly.sides = { B = "left" }
    [[loads]]
    kind = "torque"
    name = "motor"
    link = "OA"
    value = "20*sin(3*t)"
    [[loads]]
    kind = "torque"
    name = "diagram"
    link = "OA"
    over = "time"
    table = [[0, 0], [1, 5]]
    [[loads]]
    kind = "force"
    name = "gust"
    point = "B"
    vector = [0, "5*x"]
    [[loads]]
    kind = "force"
    name = "stop"
    point = "B"
    vector = [-5, 0]
    while_moving = [1, 0]
    [[loads]]
    kind = "friction"
    name = "rubbing"
    link = "DB"
    value = 0.5
    [[loads]]
    kind = "torque"
    name = "constant"
    link = "OA"
    value = 3
    """


def test_loads_that_are_not_in_the_model_are_named_with_why() -> None:
    mechanism = ct.parse_mechanism(LEFT_OUT)
    assert omitted_loads(mechanism, ct.motion(mechanism, at=[initial_place(mechanism)])) == {
        "motor": "a formula", "diagram": "a table", "gust": "a formula",
        "stop": "acts in one sense of motion alone", "rubbing": "dry or quadratic friction",
    }  # fmt: skip


def test_a_load_of_a_formula_is_given_to_its_joint_by_the_program_that_runs_the_model() -> None:
    text = LEFT_OUT[: LEFT_OUT.index("    [[loads]]", LEFT_OUT.index("motor"))]
    told = 'duration = 1\nequations = "multibody"\nsamples = 11'
    mechanism = ct.parse_mechanism(f"{text}\n[simulation]\n{told}\n")
    first = ct.motion(mechanism, at=[initial_place(mechanism)])
    model = mujoco.MjModel.from_xml_string(mjcf_text(mechanism, first, free=True))
    model.opt.timestep = 2e-4
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    freedom = model.joint("frame OA O").dofadr[0]
    for _step in range(5000):
        # a step holds what it is given: the mean of its time
        data.qfrc_applied[freedom] = 20.0 * math.sin(3.0 * (data.time + 1e-4))
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    course = ct.simulate(mechanism)
    ours = course.position.sel(point="B").values
    assert np.abs(data.site("AB.B").xpos[:2] - ours[-1]).max() <= 1e-4 * 4.0
    still = ct.simulate(mechanism.model_copy(update={"loads": ()})).position.sel(point="B").values
    assert np.abs(still[-1] - ours[-1]).max() > 0.05  # the load is felt
