"""Angles between links at moving hinges on the sphere, and spherical coordinates, by closed forms and series."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr
from numpy.polynomial import Chebyshev

import centrode as ct
from mechanisms import EPS

AB, BC = math.pi / 12, math.pi / 4


@pytest.fixture(scope="module")
def thesis() -> xr.Dataset:
    return ct.motion(ct.example("spherical-crank-rocker"), 73)


def test_the_angle_gamma_of_the_thesis(thesis: xr.Dataset) -> None:
    """Of BC to the path of C: sin gamma = sin AB cos beta / sin BC, with two derivatives by time."""
    beta, speed = thesis.drive_value.to_numpy()[:, 0], 2.94
    ratio = math.sin(AB) / math.sin(BC)
    sine = ratio * np.cos(beta)
    gamma, cosine = np.arcsin(sine), np.sqrt(1 - sine**2)
    rate = -ratio * np.sin(beta) * speed / cosine
    second = (-sine * speed**2 + sine * rate**2) / cosine
    hinge = thesis.sel(hinge="BC-DC")
    # the closest approach of the cosine to zero multiplies rounding; accelerations go by its cube
    allowed = 64 * EPS / float(cosine.min()) ** 3
    assert np.abs(np.pi / 2 - hinge.hinge_angle - gamma).max() <= allowed
    assert np.abs(-hinge.hinge_velocity - rate).max() <= allowed * speed
    assert np.abs(-hinge.hinge_acceleration - second).max() <= allowed * speed**2


def test_the_coupler_turns_as_the_thesis_says(thesis: xr.Dataset) -> None:
    """Its angular velocity is psi' about D and gamma' about C."""
    axis = thesis.position.sel(point="C").to_numpy()
    rocker = thesis.angular_velocity.sel(link="DC").to_numpy()
    rate = -thesis.hinge_velocity.sel(hinge="BC-DC").to_numpy()[:, None]
    coupler = thesis.angular_velocity.sel(link="BC").to_numpy()
    assert np.allclose(coupler, rocker + rate * axis, rtol=0, atol=64 * EPS * 2.94)


@pytest.mark.parametrize("name", ["spherical-four-bar", "hookes-joint", "spherical-crank-rocker-rigid"])
def test_rates_are_derivatives_of_the_angle(name: str) -> None:
    """A Chebyshev series through the angle, differentiated."""
    count = 120
    places = np.pi * (1 - np.cos(np.pi * (np.arange(count) + 0.5) / count))
    found = ct.motion(ct.example(name), at=places)
    assert found.sizes["hinge"]
    for hinge in found["hinge"].to_numpy():
        one = found.sel(hinge=hinge)
        series = Chebyshev.fit(found.time.to_numpy(), one.hinge_angle.to_numpy(), count - 1)
        size = float(np.abs(one.hinge_angle).max())
        for order, values in ((1, one.hinge_velocity), (2, one.hinge_acceleration)):
            # each differentiation multiplies the rounding of values by the square of the degree over the half span
            allowed = 100 * EPS * size * (count**2 / (float(np.ptp(found.time.to_numpy())) / 2)) ** order
            assert np.abs(series.deriv(order)(found.time.to_numpy()) - values).max() <= allowed


def test_turns_do_not_depend_on_samples() -> None:
    """The crank turns fully against the coupler: two samples three turns apart know as much as 1081."""
    mechanism = ct.example("spherical-crank-rocker")
    many = ct.motion(mechanism, 1081, stop=6 * np.pi).hinge_angle
    assert np.abs(np.diff(many, axis=0)).max() < 0.1
    for count in (2, 4, 7):
        few = ct.motion(mechanism, count, stop=6 * np.pi).hinge_angle
        assert np.allclose(few, many[:: 1080 // (count - 1)], rtol=0, atol=64 * EPS * 6 * np.pi)
    turning = many.sel(hinge="AB-BC").to_numpy()
    assert abs(turning[-1] - turning[0] + 6 * np.pi) <= 64 * EPS * 6 * np.pi
    # samples out of order, and one alone
    at = np.array([5 * np.pi, 0.1, -3 * np.pi, 2.5 * np.pi])
    mixed = ct.motion(mechanism, at=at).hinge_angle
    for k, value in enumerate(at):
        assert np.array_equal(ct.motion(mechanism, at=[value]).hinge_angle[0], mixed[k])


def test_angles_begin_as_the_initial_position() -> None:
    """In (-pi, pi] there, whatever range is asked for."""
    mechanism = ct.example("spherical-crank-rocker")
    first = ct.motion(mechanism, at=[0.0]).hinge_angle
    assert (np.abs(first) <= np.pi).all()
    later = ct.motion(mechanism, 3, start=4 * np.pi, stop=6 * np.pi).hinge_angle.sel(hinge="AB-BC")
    begun = float(first.sel(hinge="AB-BC")[0])
    assert np.allclose(later, begun - np.array([4, 5, 6]) * np.pi, rtol=0, atol=0.6 * np.pi)
    assert abs(float(later[0]) - begun + 4 * np.pi) <= 64 * EPS * 4 * np.pi


def test_sweeps_have_them_with_their_turns() -> None:
    """Of everything, of one hinge, reduced, and in formulas: those of the motion."""
    mechanism, lengths = ct.example("spherical-crank-rocker"), [BC, 0.9]
    motion = ct.motion(mechanism, 9, vary={"links.BC.length": lengths})
    swept = ct.sweep(
        mechanism, {"links.BC.length": lengths}, outputs=["hinge_angle", "hinge_velocity.AB-BC"], samples=9
    )
    assert np.array_equal(swept["hinge_angle"], motion.hinge_angle)
    assert np.array_equal(swept["hinge_velocity.AB-BC"], motion.hinge_velocity.sel(hinge="AB-BC"))
    folded = ct.sweep(mechanism, {"links.BC.length": lengths}, outputs="hinge_angle.BC-DC", reduce="range")
    # of the thesis: sin gamma = sin AB / sin BC on both sides
    expected = [2 * math.asin(math.sin(AB) / math.sin(length)) for length in lengths]
    assert np.allclose(folded["hinge_angle.BC-DC"], expected, rtol=0, atol=1e-3)
    with pytest.raises(ct.InputError, match="angles at hinges, whose turns are counted on the mesh"):
        ct.sweep(
            mechanism, {"links.BC.length": lengths}, outputs="hinge_angle", samples=9, executor="machine code"
        )


def test_spherical_coordinates_are_those_of_the_places(thesis: xr.Dataset) -> None:
    polar, azimuth = thesis.polar_angle, thesis.azimuth
    place = np.stack(
        [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], axis=-1
    )
    assert np.abs(place - thesis.position.to_numpy()).max() <= 8 * EPS
    # C stays on the great circle through x and z, B starts on the equator
    assert np.abs(np.sin(azimuth.sel(point="C"))).max() <= 8 * EPS
    assert abs(float(polar.sel(point="B")[0]) - np.pi / 2) <= 8 * EPS
    assert abs(float(azimuth.sel(point="B")[0]) - AB) <= 8 * EPS


def test_columns_stand_behind_those_of_before(thesis: xr.Dataset) -> None:
    names = [column.name for column in ct.tables(thesis)["motion"].columns]
    first = names.index("hinge_angle_AB-BC")
    assert "hinge_angle" not in "".join(names[:first]) and names[first - 1].startswith(
        "acceleration_coefficient"
    )
    assert [name for name in names if "azimuth" in name] == ["azimuth_B", "azimuth_C"]
    planar = ct.motion(ct.example("crank-rocker"), 5)
    assert "hinge" not in planar.dims and "polar_angle" not in planar


def test_many_mechanisms_have_them_too(thesis: xr.Dataset) -> None:
    many = ct.motion(ct.example("spherical-crank-rocker"), 73, vary={"links.BC.length": [BC, 0.9]})
    assert np.array_equal(many.hinge_angle[0], thesis.hinge_angle)


def test_a_simulation_has_the_angles_where_it_passes() -> None:
    thesis = ct.example("spherical-crank-rocker")
    times = [0.5, 1.0, 1.5]
    short, full = (ct.simulate(thesis, at=times, motion=whole) for whole in (False, True))
    for name in ("joint_angle", "hinge_angle", "hinge_velocity", "hinge_acceleration"):
        assert np.array_equal(short[name], full[name])


def test_transmission_angles_are_hinge_angles_without_sense() -> None:
    found = ct.transmission_angles(ct.example("spherical-crank-rocker"), 37)
    mu, delta = found.transmission_angle.sel(group="BC-DC"), found.hinge_angle.sel(hinge="BC-DC")
    assert np.allclose(mu, np.arccos(np.cos(delta)), rtol=0, atol=8 * EPS)
    assert "hinge_angle_BC-DC" in [column.name for column in ct.tables(found)["transmission"].columns]
