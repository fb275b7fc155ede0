"""Hooke's joint and the wobble plate against their closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from mechanisms import EPS

X = np.linspace(0.0, 2.0 * np.pi, 49)


@pytest.mark.parametrize("bend", [0.1, np.pi / 6, 1.2])
def test_hookes_joint(bend: float) -> None:
    """tan(driven) = tan(driving)/cos b; speeds and accelerations are its derivatives."""
    motion = ct.motion(ct.example("hookes-joint"), at=X, vary={"frame.points.D.longitude": [bend]}).isel(
        mechanism=0
    )
    driven = motion.joint_angle.sel(joint="DC").to_numpy() + np.pi / 2
    truth = np.unwrap(np.arctan2(np.sin(X), np.cos(bend) * np.cos(X)))
    steep = 1.0 / np.cos(bend)
    assert np.abs(driven - truth).max() <= 64 * EPS * 2 * np.pi * steep
    uneven = 1.0 - (np.sin(bend) * np.cos(X)) ** 2
    speed = np.cos(bend) / uneven
    growth = -np.cos(bend) * np.sin(bend) ** 2 * np.sin(2.0 * X) / uneven**2
    assert np.abs(motion.joint_velocity.sel(joint="DC") - speed).max() <= 64 * EPS * steep**3
    assert np.abs(motion.joint_acceleration.sel(joint="DC") - growth).max() <= 256 * EPS * steep**5


def test_wobble_plate() -> None:
    """The rim's pin swings along the shaft with tan psi = -tan 20 deg sin x."""
    motion = ct.motion(ct.example("wobble-plate"), at=X)
    x, _y, z = motion.position.sel(point="C").to_numpy().T
    tilt = np.radians(20.0)
    truth = np.arctan(-np.tan(tilt) * np.sin(X))
    assert np.abs(np.arctan2(x, z) - truth).max() <= 64 * EPS
    # counted about Y from the north, which is Z, towards A
    assert np.abs(motion.slide.to_numpy()[:, 0] - truth).max() <= 64 * EPS


def test_transmission_angles_are_angles_of_spherical_triangles() -> None:
    """Hooke's joint: the cosine theorem in B C D of three right arcs; a guide is a rocker of 90 deg."""
    found = ct.transmission_angles(ct.example("hookes-joint"), samples=25)
    x = found.drive_value.to_numpy()[:, 0]
    # arcs BC and DC are right, so the angle in C is the arc from B to D
    truth = np.arccos(np.sin(np.pi / 6) * np.cos(x))
    assert np.abs(found.transmission_angle.to_numpy()[:, 0] - truth).max() <= 64 * EPS
    rocker = ct.transmission_angles(ct.example("spherical-four-bar"), samples=25)
    guide = ct.transmission_angles(ct.example("spherical-crank-guide"), samples=25)
    acute = np.minimum(rocker.transmission_angle, np.pi - rocker.transmission_angle).to_numpy()
    assert np.abs(acute - guide.transmission_angle.to_numpy()).max() <= 64 * EPS
    summed = ct.rotatability(ct.example("spherical-four-bar")).drives[0].transmissions[0].least
    assert abs(acute.min() - summed) <= 1.0 / 24**2  # one of 25 samples lies within half a step of the least
