"""Drawings of the sphere: arcs on it, dashed behind it, names and signs at the points; tables of vectors."""

from __future__ import annotations

import numpy as np
import pytest
import xarray
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from centrode.errors import Status
from centrode.model.files import parse_mechanism
from centrode.quantities import QUANTITIES
from centrode.render.drawing.globe import HIDDEN, draw_globe
from centrode.scenes.sphere import WHOLE, globe_of, great_arc
from drawn_curves import heights_at
from shown_motion import columns_of, motion_figures

TEXT = """
title = "Crank on the sphere"
space = "sphere"
display = { angle = "deg" }
[frame.points]
A = [0, 0]
D = [SIZE, 0]
[links.crank]
points = { A = [0, 0], B = [SIZE, 0], E = [0, SIZE] }
reference = ["A", "D"]
[[guides]]
name = "way"
point = "B"
pole = "A"
radius = SIZE
[[drives]]
link = "crank"
start = 0
speed = 1
"""


def made(size: float = 0.8, samples: int = 73, gap: bool = False):
    """A crank whose points run round circles about the x axis, as a result of motion."""
    mechanism = parse_mechanism(TEXT.replace("SIZE", f'"{size!r} rad"'), "crank.toml")
    q = np.linspace(0.0, 2 * np.pi, samples)

    def ring(shift: float):
        turn = q + shift
        return np.stack(
            [np.full(samples, np.cos(size)), np.sin(size) * np.cos(turn), np.sin(size) * np.sin(turn)], axis=1
        )

    a, d = np.tile([1.0, 0, 0], (samples, 1)), np.tile([np.cos(size), np.sin(size), 0], (samples, 1))
    position = np.stack([a, d, ring(0.0), ring(np.pi / 2)], axis=1)
    omega = np.tile([1.0, 0, 0], (samples, 1, 1))
    velocity = np.cross(omega, position)
    acceleration = np.cross(omega, velocity)
    one, zero = np.ones((samples, 1)), np.zeros((samples, 1))
    arc = np.sin(size)
    values = {
        "position": position, "velocity": velocity, "acceleration": acceleration,
        "velocity_coefficient": velocity, "acceleration_coefficient": acceleration,
        "angular_velocity": omega, "angular_acceleration": 0 * omega,
        "angular_velocity_coefficient": omega, "angular_acceleration_coefficient": 0 * omega,
        "joint_angle": q[:, None], "joint_velocity": one, "joint_acceleration": zero,
        "joint_velocity_coefficient": one, "joint_acceleration_coefficient": zero,
        "slide": arc * q[:, None], "slide_velocity": arc * one, "slide_acceleration": zero,
        "slide_velocity_coefficient": arc * one, "slide_acceleration_coefficient": zero,
    }  # fmt: skip
    dims = {"joint": ("joint",), "slide": ("guide",), "angular": ("link", "axis")}
    variables = {}
    for name, array in values.items():
        array = array.copy()
        if gap:
            array[samples // 3 : samples // 2] = np.nan
        own = dims.get(name.split("_")[0], ("point", "axis"))
        quantity = QUANTITIES[name].on_sphere()
        variables[name] = (("sample", *own), array, {"units": quantity.unit, "symbol": quantity.symbol})
    status = np.zeros(samples, dtype=np.int8)
    if gap:
        status[samples // 3 : samples // 2] = Status.OPEN
    variables["status"] = ("sample", status)
    variables["residual"] = ("sample", np.zeros(samples), {"units": "1"})
    coords = {
        "time": ("sample", q, {"units": "s"}), "drive_value": (("sample", "drive"), q[:, None], {"units": "rad"}),
        "point": ["A", "D", "B", "E"], "link": ["crank"], "joint": ["crank"], "guide": ["way"],
        "drive": ["crank"], "axis": ["x", "y", "z"],
    }  # fmt: skip
    return mechanism, xarray.Dataset(variables, coords)


def drawn(size: float = 0.8, sample: int = 0):
    globe = globe_of(*made(size))
    axes = Figure().subplots()
    draw_globe(axes, globe, sample, faded=[10, 20])
    return globe, axes


def centres(axes, radius: float):
    return {
        tuple(np.round(patch.center, 9)) for patch in axes.patches
        if isinstance(patch, Circle) and np.isclose(patch.radius, radius)
    }  # fmt: skip


def test_great_arcs_stay_on_the_sphere_and_are_evenly_divided():
    start, end = np.array([1.0, 0, 0]), np.array([0.0, 0.6, 0.8])
    arc = great_arc(start, end)
    np.testing.assert_allclose(np.linalg.norm(arc, axis=1), 1.0, rtol=0, atol=1e-15)
    steps = np.linalg.norm(np.diff(arc, axis=0), axis=1)
    np.testing.assert_allclose(steps, steps[0], rtol=1e-12)
    assert (arc[0] == start).all() and np.allclose(arc[-1], end, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(great_arc(start, start), np.tile(start, (len(arc), 1)))


def test_the_view_is_square_and_over_what_moves():
    globe = globe_of(*made())
    np.testing.assert_allclose(globe.view @ globe.view.T, np.eye(3), rtol=0, atol=1e-15)
    assert np.linalg.det(globe.view) == pytest.approx(1.0)
    assert globe.in_front(np.array([1.0, 0, 0]))
    assert globe.view[1, 2] > 0  # the north pole is up


def test_signs_and_names_stand_at_the_points():
    globe, axes = drawn()
    at = {name: tuple(np.round(globe.flat(place), 9)) for name, place in globe.at(0).items()}
    assert centres(axes, globe.sign) == {at["A"], at["B"]}
    assert centres(axes, 0.5 * globe.sign) == {at["A"], at["D"], at["E"]}
    assert {text.get_text() for text in axes.texts} == set(at)
    assert centres(axes, 1.0) == {(0.0, 0.0)}  # the outline of the sphere
    assert axes.get_aspect() == 1.0


def test_what_lies_behind_is_dashed():
    globe, axes = drawn(1.4, 25)
    hidden = [line for line in axes.get_lines() if line.get_linestyle() == "--"]
    assert hidden and HIDDEN[1]
    circle = globe.circle(globe.mechanism.guides[0], 0)
    front = globe.in_front(circle)
    assert front.any() and not front.all()
    np.testing.assert_allclose(circle @ [1.0, 0, 0], np.cos(1.4), rtol=0, atol=1e-14)
    whole = globe.flat(circle)
    dashed = next(line for line in hidden if len(line.get_xdata()) == len(whole))
    shown = np.isfinite(dashed.get_xdata())
    # behind, and one step beyond on each side
    assert (shown | front).all() and (shown & front).sum() <= 4


def test_a_small_linkage_fills_the_drawing():
    globe = globe_of(*made(0.01))
    assert globe.extent < 0.03
    assert globe_of(*made(0.8)).extent == 2.0 > WHOLE


def test_figures_of_a_spherical_motion():
    mechanism, dataset = made(gap=True)
    figures = motion_figures(mechanism, dataset, [0.0, 1.0])
    assert list(figures) == [
        "mechanism", "paths", "joint-angles", "joint-velocities", "joint-accelerations", "angular-velocities",
        "angular-accelerations", "velocities", "accelerations", "slides", "kinematic-coefficients",
    ]  # fmt: skip
    (line,) = [x for x in figures["joint-angles"].axes[0].get_lines() if x.get_label() == "crank"]
    expected = np.degrees(dataset["joint_angle"].to_numpy()[:, 0])
    np.testing.assert_array_equal(
        heights_at(line, np.degrees(dataset["drive_value"].to_numpy()[:, 0])), expected
    )
    (size,) = [x for x in figures["angular-velocities"].axes[0].get_lines() if x.get_label() == "crank"]
    known = np.isfinite(size.get_ydata())
    np.testing.assert_allclose(size.get_ydata()[known], np.degrees(1.0))
    assert len(figures["velocities"].axes) == 4  # x, y, z and the magnitude


def test_tables_have_a_column_for_each_axis():
    mechanism, dataset = made(samples=5)
    headers, _columns = columns_of(dataset, mechanism.display, mechanism.moving_points)
    assert headers[:5] == [
        "time [s]", "drive_crank [deg]", "angular_velocity_crank_x [deg/s]", "angular_velocity_crank_y [deg/s]",
        "angular_velocity_crank_z [deg/s]",
    ]  # fmt: skip
    assert "joint_angle_crank [deg]" in headers and "slide_way [deg]" in headers
    assert "position_B_z" in headers and "velocity_B_z [1/s]" in headers
