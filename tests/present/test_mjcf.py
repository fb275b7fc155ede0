"""Models for MuJoCo: loaded there, they move as ours do, up to what MuJoCo itself leaves of its constraints."""

from __future__ import annotations

import math
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import centrode as ct

mujoco = pytest.importorskip("mujoco", reason="models are tried in MuJoCo")

FULL_TURN = (
    "andrews-squeezer", "crank-rocker", "drag-link", "four-bar-and-slider", "fourth-class-group", "geared-five-bar",
    "inverted-slider-crank", "jansen-leg", "klann-leg", "oscillating-cylinder", "planetary-gear-train", "scotch-yoke",
    "shaper", "six-bar-press", "slider-between-cranks", "stephenson-six-bar", "third-class-triad",
)  # fmt: skip
ELSEWHERE = (
    "excavator-arm",
    "five-bar-two-drives",
    "scissor-lift-cylinder",
    "two-link-arm",
    "wiper",
    "elliptic-trammel",
)
MOMENTS = 12
AMPLIFIED = 8
"""A point may be off by the constraints' violation over the sine of the least transmission angle, here above 7 deg."""


def model_of(name: str) -> tuple[ct.Mechanism, str]:
    mechanism = ct.example(name)
    return mechanism, ct.mjcf_text(mechanism, ct.motion(mechanism, at=[ct.initial_place(mechanism)]))


@pytest.mark.parametrize("name", FULL_TURN)
def test_the_driven_motion_is_ours(name: str) -> None:
    mechanism, text = model_of(name)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    speed, start = mechanism.drives[0].speed, ct.initial_place(mechanism)
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


@pytest.mark.parametrize("name", (*FULL_TURN, *ELSEWHERE))
def test_loops_close_at_the_assembled_pose(name: str) -> None:
    mechanism, text = model_of(name)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    size = float(np.ptp(data.site_xpos[:, :2], axis=0).max())
    assert float(np.abs(data.efc_pos).max(initial=0.0)) <= 1e-12 * size
    if not mechanism.gears:
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
    motion = ct.motion(mechanism, at=[ct.initial_place(mechanism)])
    middle = data.body("DH").xipos[:2]
    assert np.allclose(middle, motion.position.sel(point="S4")[0], rtol=0, atol=1e-12)
    assert float(model.body("CD").inertia.max()) == pytest.approx(0.55, rel=1e-12)


@pytest.mark.parametrize("name", ["hookes-joint", "rack-and-pinion"])
def test_what_is_not_in_the_model_is_refused(name: str) -> None:
    with pytest.raises(ct.NotComputedYet):
        model_of(name)


def test_hostile_names_are_names() -> None:
    text = ct.mechanism_text(ct.example("crank-rocker")).replace(
        'title = "', 'title = "<a href=\\"x\\">& ', 1
    )
    mechanism = ct.parse_mechanism(text)
    model = ct.mjcf_text(mechanism, ct.motion(mechanism, at=[0.0]))
    assert ET.fromstring(model).attrib["model"] == mechanism.title
    mujoco.MjModel.from_xml_string(model)
