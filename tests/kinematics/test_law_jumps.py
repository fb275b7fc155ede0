"""Laws that jump are refused, wherever the samples stand; laws that bend have at the bend what holds from there on."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

import centrode as ct
from drives import five_bar
from mechanisms import EPS, link


def turned_by(law: str, stop: float = 1.0) -> ct.Mechanism:
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0]}},
        links={"OA": {"length": 0.5}},
        drives=[{"link": "OA", "law": law}],
        study={"stop": stop},
    )


@pytest.mark.parametrize("samples", [2, 11, 360])
@pytest.mark.parametrize(
    ("law", "told"),
    [
        ("t + 0.1*sign(t-0.5)", "its law jumps at t = 0.5 s, from 0.4 to 0.6"),
        ("t + 1e-8*sign(t-0.7)", "its law jumps at t = 0.7 s, from 0.69999999 to 0.70000001"),
        ("sign(t)", "its law jumps at t = 0 s, from 0 to 1"),
        ("sign((t-0.3)^2-1e-12)", "its law jumps at t = 0.299999 s, from 1 to -1"),
        ("sign(max(t-0.1,0))", "its law jumps at t = 0.1 s, from 0 to 1"),
        ("atan2(sin(4*t),cos(4*t))", "its law jumps at t = 0.785398163 s, from 3.14159265 to -3.14159265"),
        ("atan(1/(t-0.4))", "its law jumps at t = 0.4 s, from -1.57079633 to 1.57079633"),
        ("0.1/(t-1/3)", "its law has no finite value at t = 0.333333333 s"),
        ("(t-1/3)^-2", "its law has no finite value at t = 0.333333333 s"),
        ("tan(2*t)", "its law has no finite value at t = 0.785398163 s"),
        ("log(abs(t-0.3))", "its law has no finite value at t = 0.3 s"),
    ],
)
def test_a_law_that_jumps_is_refused_with_the_place(law: str, told: str, samples: int) -> None:
    with pytest.raises(ct.InputError) as refused:
        ct.motion(turned_by(law), samples=samples)
    assert str(refused.value).startswith(f"[[drives]] OA: {told}")
    assert refused.value.repair


def test_a_jump_behind_the_range_is_left_alone_and_one_before_it_is_not() -> None:
    mechanism = turned_by("t + 0.1*sign(t-0.5)")
    assert (ct.motion(mechanism, samples=5, stop=0.4).status == 0).all()
    assert (ct.motion(mechanism, at=[0.1, 0.3]).status == 0).all()
    for asked in ({"start": 0.6, "stop": 1.0}, {"at": [0.9]}):
        with pytest.raises(ct.InputError, match=r"jumps at t = 0\.5 s"):
            ct.motion(mechanism, **asked)


@pytest.mark.parametrize(
    "law",
    [
        "(t-0.5)*sign(t-0.5)",
        "sin(1000*t)*sign(sin(1000*t))",
        "sqrt(abs(t-0.3))*sign(t-0.3)",
        "atan2(sin(t),cos(t))",
        "t/(t+1)",
        "atan2(t-0.5,1e-9)",
    ],
)
def test_a_law_that_goes_on_is_accepted_though_its_parts_jump(law: str) -> None:
    assert (ct.motion(turned_by(law), samples=7).status == 0).all()


@pytest.mark.parametrize(
    ("law", "speeds", "accelerations"),
    [
        ("abs(t-0.5)", [-1, -1, 1, 1, 1], [0] * 5),
        ("(t-0.5)*sign(t-0.5)", [-1, -1, 1, 1, 1], [0] * 5),
        ("min(t,0.5)", [1, 1, 0, 0, 0], [0] * 5),
        ("max(t,0.5)", [0, 0, 1, 1, 1], [0] * 5),
        ("max(t-0.5,0)^2", [0, 0, 0, 0.5, 1], [0, 0, 2, 2, 2]),
    ],
)
def test_at_a_kink_stands_what_holds_from_there_on(
    law: str, speeds: list[float], accelerations: list[float]
) -> None:
    data = ct.motion(turned_by(law), samples=5)
    assert (data.status == 0).all()
    assert link(data, "OA", "angular_velocity") == pytest.approx(np.array(speeds), abs=8 * EPS)
    assert link(data, "OA", "angular_acceleration") == pytest.approx(np.array(accelerations), abs=8 * EPS)


def test_the_second_of_two_drives_jumps() -> None:
    drives = [
        {"link": "OA", "start": 1.0, "law": "0.1*t"},
        {"link": "EC", "start": 1.8, "law": "0.1*sign(t-2)"},
    ]
    with pytest.raises(ct.InputError, match=r"EC: its law jumps at t = 2 s, from -0\.1 to 0\.1"):
        ct.motion(five_bar(drives=drives), samples=3, stop=3.0)


@pytest.mark.parametrize(
    ("law", "exact"),
    [
        ("0.1*exp(-t^2)", lambda t: 0.1 * math.exp(-(t**2))),
        ("0.1*abs(t-0.5)", lambda t: 0.1 * abs(t - 0.5)),
        ("0.1*log(1+t)", lambda t: 0.1 * math.log(1 + t)),
        ("min(0.1*t,0.05)", lambda t: min(0.1 * t, 0.05)),
        ("max(0.1*t,0.05)", lambda t: max(0.1 * t, 0.05)),
    ],
)
def test_laws_of_several_drives_may_have_any_function(law: str, exact: Callable[[float], float]) -> None:
    drives = [{"link": "OA", "start": 1.0, "law": law}, {"link": "EC", "start": 1.8, "law": "0.1*t"}]
    data = ct.motion(five_bar(drives=drives), samples=5, stop=2.0)
    values = [1.0 + exact(t) for t in data.time.values]
    assert link(data, "OA") == pytest.approx(np.array(values), abs=8 * EPS)
