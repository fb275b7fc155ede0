"""A description that is requested again and again gets machine code, and its results do not tell."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.dynamics.kinetostatics import reaction_kernels
from centrode.kinematics import repeated_motion
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import requested_grid
from centrode.numerics import machine_code

pytestmark = pytest.mark.skipif(not machine_code.PRESENT, reason="llvmlite is not installed")

SAMPLES = 53
LAST_BITS = 4e-16
"""Residuals, which are rounding alone, may be rounded otherwise."""
MOVING = (
    "crank-rocker",
    "six-bar-press",
    "geared-five-bar",
    "two-link-arm",
    "shaper",
    "jansen-leg",
)
LOADED = ("six-bar-press", "six-bar-press-run-up", "in-line-four-bar", "vibrating-screen", "door-closer")


@pytest.fixture(autouse=True)
def compile_at_second_request(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(repeated_motion, "WORTH_COMPILING", 2)


def is_compiled(mechanism: ct.Mechanism) -> bool:
    prepared = ready(mechanism)
    course = repeated_motion.repeated_motion(prepared, requested_grid(prepared, SAMPLES, None, None))
    return course.is_compiled


def assert_same(found: xr.Dataset, first: xr.Dataset) -> None:
    assert list(found.variables) == list(first.variables)
    assert list(found.attrs) == list(first.attrs)
    for name in first.variables:
        if name == "residual":
            assert np.nanmax(np.abs(found[name] - first[name])) <= LAST_BITS
        else:
            xr.testing.assert_identical(found[name], first[name])
    for name, value in first.attrs.items():
        if name == "worst_residual":
            assert abs(found.attrs[name] - value) <= LAST_BITS
        else:
            assert found.attrs[name] == value or (value != value and found.attrs[name] != found.attrs[name])


@pytest.mark.parametrize("name", MOVING)
def test_a_compiled_motion_has_the_bits_of_the_first(name: str) -> None:
    mechanism = ct.example(name)
    first = ct.motion(mechanism, SAMPLES)
    for _request in range(2):
        assert_same(ct.motion(mechanism, SAMPLES), first)
    assert is_compiled(mechanism)


@pytest.mark.parametrize("name", LOADED)
def test_compiled_reactions_have_the_bits_of_the_first(name: str) -> None:
    mechanism = ct.example(name)
    first = ct.reactions(mechanism, SAMPLES)
    for _request in range(2):
        assert_same(ct.reactions(mechanism, SAMPLES), first)
    assert is_compiled(mechanism)


def test_limits_on_the_way_are_left_to_the_arrays() -> None:
    mechanism = ct.example("antiparallelogram")
    first = ct.motion(mechanism, SAMPLES)
    assert first.sizes["event"]
    for _request in range(2):
        assert_same(ct.motion(mechanism, SAMPLES), first)


def test_angles_at_hinges_and_groups_of_higher_class_are_left_to_the_arrays() -> None:
    for name in ("spherical-four-bar", "third-class-triad"):
        mechanism = ct.example(name)
        first = ct.motion(mechanism, SAMPLES)
        assert_same(ct.motion(mechanism, SAMPLES), first)
        assert not is_compiled(mechanism)


def test_what_kernels_of_reactions_do_not_know_is_left_to_the_arrays(monkeypatch: pytest.MonkeyPatch) -> None:
    """Repeating equations leave reactions undetermined; a load without an amount is refused as at first."""
    press = ct.example("six-bar-press")
    first = ct.reactions(press, SAMPLES + 1)
    monkeypatch.setattr(reaction_kernels.ReactionKernels, "of", lambda *_given: None)
    monkeypatch.setattr(reaction_kernels, "_kept", type(reaction_kernels._kept)(1))
    for _request in range(2):
        assert_same(ct.reactions(press, SAMPLES + 1), first)


def test_loads_without_an_amount_are_refused_at_every_request() -> None:
    lever = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [4, 0]}},
        links={"OA": {"length": 1}, "AB": {"length": 3.5}, "DB": {"length": 3}},
        drives=[{"link": "OA", "start": 0.5, "speed": 1.0}],
        assembly={"sides": {"B": "left"}},
        loads=[{"kind": "torque", "link": "DB", "value": "1 / (q - q)"}],
    )
    told = set()
    for _request in range(3):
        with pytest.raises(ct.InputError, match="no finite value") as refusal:
            ct.reactions(lever, SAMPLES)
        told.add(str(refusal.value))
    assert len(told) == 1


def test_speeds_that_are_given_are_those_of_the_kernels() -> None:
    """At given places with an acceleration: other kernels than at a constant speed."""
    press, places = ct.example("six-bar-press"), [3.0, 2.0, 1.0]
    first = ct.reactions(press, at=places, speed=-6.0, acceleration=2.0)
    still = ct.reactions(press, at=places, speed=-6.0)
    for _request in range(2):
        assert_same(ct.reactions(press, at=places, speed=-6.0, acceleration=2.0), first)
        assert_same(ct.reactions(press, at=places, speed=-6.0), still)
    assert not np.allclose(first.joint_force, still.joint_force)
