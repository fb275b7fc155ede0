"""`ct.motion(out=...)`: the result's arrays are views of the caller's memory, with the numbers of fresh memory."""

import re

import numpy as np
import pytest

import centrode as ct
from centrode.numerics import machine_code, rooms

MANY = 700  # enough to be worth compiling, see `batch.WORTH_COMPILING`
CASES = {
    "crank-rocker": ("links.AB.length", MANY),
    "six-bar-press": ("links.OA.length", MANY),
    "scissor-lift": (None, 1),
    "spherical-four-bar": ("links.BC.length", 5),
    "third-class-triad": ("links.AB.length", 3),
}
"""Mechanism -> the length that varies and how many there are."""
IN_ROOM = (
    "position", "velocity", "acceleration", "velocity_coefficient", "acceleration_coefficient",
    "angular_velocity", "angular_acceleration", "joint_angle", "slide_velocity",
)  # fmt: skip


def vary_of(name: str, width: float) -> dict[str, np.ndarray] | None:
    path, count = CASES[name]
    if path is None:
        return None
    given = ct.value_at(ct.example(name), path)
    return {path: given * np.random.default_rng(0).uniform(1.0 - width, 1.0 + width, count)}


def room_for(name: str, samples: int, vary: dict[str, np.ndarray] | None) -> np.ndarray:
    """Room of the size that the refusal names."""
    with pytest.raises(ct.InputError) as refused:
        ct.motion(ct.example(name), samples, vary=vary, out=np.empty(3))
    found = re.search(r"3 numbers; needed: (\d+); make it by numpy.empty\(\1\)", str(refused.value))
    assert found is not None, refused.value
    return np.full(int(found[1]), np.pi)


@pytest.mark.parametrize("width", [0.01, 0.6])
@pytest.mark.parametrize("name", CASES)
def test_same_motion_in_given_room(name: str, width: float) -> None:
    """Clear mechanisms and such as lock, by machine code and by arrays; twice, as the room is used again."""
    vary = vary_of(name, width)
    expected = ct.motion(ct.example(name), 361, vary=vary)
    room = room_for(name, 361, vary)
    for _turn in range(2):
        found = ct.motion(ct.example(name), 361, vary=vary, out=room)
        assert found.identical(expected)
        for kind in IN_ROOM:
            if kind in found and found[kind].size:
                assert np.shares_memory(found[kind].values, room), kind


@pytest.mark.skipif(not machine_code.PRESENT, reason="llvmlite is absent")
@pytest.mark.parametrize("width", [0.01, 0.6])
def test_numbers_of_fixed_points_in_blank_memory(width: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where zeros take no pages they are not written: fixed points are where they were, and absent where they were."""
    vary = vary_of("crank-rocker", width)
    expected = ct.motion(ct.example("crank-rocker"), 361, vary=vary)
    monkeypatch.setattr(rooms, "BLANK", 0)
    found = ct.motion(ct.example("crank-rocker"), 361, vary=vary)
    assert found.identical(expected)
    assert bool((found.status == ct.Status.OPEN).any()) == (width > 0.1)


@pytest.mark.parametrize(
    "out",
    [
        [0.0] * 100_000,
        np.empty(100_000, np.float32),
        np.empty(200_000)[::2],
        np.broadcast_to(np.zeros(1), (100_000,)),
    ],
    ids=["list", "float32", "every second", "read-only"],
)
def test_what_is_no_room(out: object) -> None:
    with pytest.raises(ct.InputError, match=r"out: an array of float64 .*numpy.empty\(\d+\)"):
        ct.motion(ct.example("crank-rocker"), 37, out=out)  # type: ignore[arg-type]


def test_room_of_any_shape_and_more() -> None:
    room = np.empty((100, 100))
    found = ct.motion(ct.example("crank-rocker"), 37, out=room)
    assert np.shares_memory(found.position.values, room)
