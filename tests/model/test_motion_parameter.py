"""What a motion is a function of: kind, unit and symbol by hand for each drive, in the plane and on the sphere."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.errors import InputError
from centrode.model.drives import motion_parameter_of
from centrode.model.motion_parameter import TIME

LINK, GUIDE = ct.Drive(link="OA", speed=2.0), ct.Drive(guide="C", speed=-0.5)
CYLINDER = ct.Drive(distance=("A", "B"), speed=0.0)
BY_LAW = ct.Drive(link="OA", law="sin(t)")
MOTION = xr.Dataset(
    {"time": ("sample", [0.0, 1.0]), "drive_value": (("sample", "drive"), [[3.0, 5.0], [4.0, 6.0]])}
)


@pytest.mark.parametrize(
    ("drives", "space", "parameter", "instant", "speed"),
    [
        ([LINK], "plane", ("angle", "rad", "φ"), ("angle", "rad", "φ"), 2.0),
        ([LINK], "sphere", ("angle", "rad", "φ"), ("angle", "rad", "φ"), 2.0),
        ([GUIDE], "plane", ("length", "m", "s"), ("length", "m", "s"), -0.5),
        ([GUIDE], "sphere", ("angle", "rad", "s"), ("angle", "rad", "s"), -0.5),
        ([CYLINDER], "plane", ("length", "m", "l"), ("length", "m", "l"), 0.0),
        ([BY_LAW], "plane", ("angle", "rad", "φ"), ("time", "s", "t"), None),
        ([LINK, GUIDE], "plane", ("time", "s", "t"), ("time", "s", "t"), None),
        ([], "plane", ("time", "s", "t"), ("time", "s", "t"), None),
    ],
)
def test_kinds_units_and_symbols(
    drives: list[ct.Drive],
    space: str,
    parameter: tuple[str, str, str],
    instant: tuple[str, str, str],
    speed: float | None,
) -> None:
    found = motion_parameter_of(drives, space)
    assert (found.variable.kind, found.variable.unit, found.variable.symbol) == parameter
    assert (found.instant.kind, found.instant.unit, found.instant.symbol) == instant
    assert found.constant_speed == speed
    assert found.is_uniform is (speed is not None)


def test_units_of_speeds_and_forces() -> None:
    found = motion_parameter_of([LINK, GUIDE], "plane")
    assert [one.speed_unit for one in found.drives] == ["rad/s", "m/s"]
    assert [one.force_unit for one in found.drives] == ["N m", "N"]
    arc = motion_parameter_of([GUIDE], "sphere").drives[0]
    assert (arc.speed_unit, arc.force_unit) == ("rad/s", "N m")


def test_only_the_angle_of_a_link_comes_round() -> None:
    assert motion_parameter_of([LINK], "plane").turns
    assert not motion_parameter_of([GUIDE], "sphere").turns
    assert not motion_parameter_of([LINK, GUIDE], "plane").turns


def test_the_value_of_a_law_states_no_instant() -> None:
    assert not motion_parameter_of([BY_LAW], "plane").states_instants
    assert motion_parameter_of([LINK], "plane").states_instants
    assert motion_parameter_of([LINK, BY_LAW], "plane").states_instants


@pytest.mark.parametrize(
    ("drives", "values", "instants"),
    [
        ([LINK], [3.0, 4.0], [3.0, 4.0]),
        ([BY_LAW], [3.0, 4.0], [0.0, 1.0]),
        ([LINK, GUIDE], [0.0, 1.0], [0.0, 1.0]),
    ],
)
def test_values_and_instants_of_a_motion(
    drives: list[ct.Drive], values: list[float], instants: list[float]
) -> None:
    found = motion_parameter_of(drives, "plane")
    assert found.values(MOTION).tolist() == values
    assert found.instants(MOTION).tolist() == instants


def test_values_and_times_at_constant_speed() -> None:
    found = motion_parameter_of([LINK], "plane")
    # a drive at 2 rad/s from 1 rad is at 4 rad after 1.5 s; at 6 rad/s in place of it after 0.5 s
    assert found.times(np.array([4.0]), 1.0).tolist() == [1.5]
    assert found.times(4.0, 1.0, 6.0) == 0.5
    assert found.value_at(1.5, 1.0) == 4.0


def test_one_drive_of_several() -> None:
    several = motion_parameter_of([LINK, GUIDE], "plane")
    assert several.along("C") == motion_parameter_of([GUIDE], "plane")
    assert several.along("C").in_time().variable is TIME
    with pytest.raises(InputError, match="there is no drive"):
        several.drive("X")


@pytest.mark.parametrize(
    ("drives", "space", "text", "value"),
    [
        ([LINK], "plane", "180 deg", math.pi),
        ([GUIDE], "plane", "5 mm", 0.005),
        ([GUIDE], "sphere", "180 deg", math.pi),
        ([BY_LAW], "plane", "20 ms", 0.02),
        ([LINK, GUIDE], "plane", 3, 3.0),
    ],
)
def test_instants_are_read(drives: list[ct.Drive], space: str, text: Any, value: float) -> None:
    assert motion_parameter_of(drives, space).instant.read(text, "--at") == value


@pytest.mark.parametrize(
    ("drives", "space", "text"),
    [
        ([LINK], "plane", "5 mm"),
        ([GUIDE], "sphere", "5 mm"),
        ([GUIDE], "plane", "1 rad"),
        ([BY_LAW], "plane", "1 rad"),
    ],
)
def test_instants_of_another_kind_are_refused(drives: list[ct.Drive], space: str, text: str) -> None:
    with pytest.raises(InputError, match="--at"):
        motion_parameter_of(drives, space).instant.read(text, "--at")
