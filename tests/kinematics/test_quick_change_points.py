"""Change points at which a group turns fast, the crank nearly as long as the frame: closed forms of 50 digits."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

import centrode as ct
from mechanisms import EPS, events, point, statuses
from samples import few, spread

DIGITS = 50
ROUNDING = 2.0**-53
WIDE = (1e-12, 1e-10, 1e-8)
"""Errors of position, velocity and acceleration in units of the size, where |1 - ratio| is at least 0.01."""
TIMES = 100.0
"""Errors nearer to ratio 1, in units of what rounding of the dimensions and of the drive's value makes there."""
RATIOS = [0.05, 0.3, 0.9, 0.95, 0.99, 0.999, 0.9999, 1 - 1e-6, 1 + 1e-6, 1.0001, 1.01, 1.05, 2.0, 20.0]
KINDS = {"antiparallelogram": "right", "kite": "left"}
"""The side on which B lies where the crank stands at 1 rad."""


def linkage(kind: str, ratio: float, **more: Any) -> ct.Mechanism:
    """OA = ratio, OD = 1; crossed with the opposite links alike, or a kite with AB = OA and DB = OD."""
    coupler, rocker = (1.0, ratio) if kind == "antiparallelogram" else (ratio, 1.0)
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [1.0, 0.0]}},
        links={"OA": {"length": ratio}, "AB": {"length": coupler}, "DB": {"length": rocker}},
        drives=[{"link": "OA", "start": 1.0, "speed": 1.0}],
        assembly={"sides": {"B": KINDS[kind]}, **more},
    )


def exact(kind: str, q: Any, a: Any, d: Any) -> list[Any]:
    """B with three derivatives by q: a quotient of n and m, each of them p + r e^(iq) or p + r e^(-iq).

    The antiparallelogram swaps O and B, A and D: B = (d^2 - a^2)/conj(d - a e^iq). In the kite B is the mirror image
    of O in the line AD: B = d - d (a e^iq - d)/(a e^-iq - d).
    """
    e, i = mpmath.expj(q), mpmath.mpc(0, 1)
    if kind == "antiparallelogram":
        n = [d * d - a * a, 0, 0, 0]
        m = [d - a / e, i * a / e, a / e, -i * a / e]
        offset = mpmath.mpf(0)
    else:
        n = [-d * (a * e - d), -d * i * a * e, d * a * e, d * i * a * e]
        m = [a / e - d, -i * a / e, -a / e, i * a / e]
        offset = d
    b = n[0] / m[0]
    first = (n[1] - b * m[1]) / m[0]
    second = (n[2] - 2 * first * m[1] - b * m[2]) / m[0]
    third = (n[3] - 3 * second * m[1] - 3 * first * m[2] - b * m[3]) / m[0]
    return [offset + b, first, second, third]


def rounding(kind: str, q: Any, a: Any, d: Any) -> list[float]:
    """What one rounding of both dimensions, alike links staying alike, and of the drive's value makes of B."""
    by = mpmath.mpf(2) ** -80
    here, longer, wider = (
        exact(kind, q, a, d),
        exact(kind, q, a * (1 + by), d),
        exact(kind, q, a, d * (1 + by)),
    )
    # a value next to zero is the difference of angles of the order of 1 rad, that of the frame's line among them
    turn = max(mpmath.mpf(1), abs(q))
    return [
        float(
            ROUNDING * (abs(here[k + 1] * turn) + (abs(longer[k] - here[k]) + abs(wider[k] - here[k])) / by)
        )
        for k in range(3)
    ]


def values_about_change_points(ratio: float) -> np.ndarray[Any, np.dtype[np.float64]]:
    """A turn of the drive, closely about its change points at 0 and pi; the bend at 0 is |1 - ratio| wide."""
    bend = abs(1.0 - ratio) / np.sqrt(ratio)
    near = np.concatenate(
        [bend * np.array([0.0, 0.1, 0.3, 0.5, 0.7, 1.0, 1.5, 3.0]), [1e-9, 1e-5, 0.0399, 0.0401]]
    )
    near = near[near < 1.0]
    return np.unique(np.concatenate([np.linspace(0.0, 6.25, 26), near, -near, np.pi + near, np.pi - near]))


@pytest.mark.parametrize("ratio", spread(RATIOS, 7))
@pytest.mark.parametrize("kind", KINDS)
def test_positions_and_derivatives(kind: str, ratio: float) -> None:
    q = values_about_change_points(ratio)
    data = ct.motion(linkage(kind, ratio), at=q)
    assert set(statuses(data)) == {"ok"}
    found = [point(data, "B", variable) for variable in ("position", "velocity", "acceleration")]
    size = max(ratio, 1.0)
    with mpmath.workdps(DIGITS):
        for k, at in enumerate(q):
            numbers = mpmath.mpf(float(at)), mpmath.mpf(ratio), mpmath.mpf(1)
            truth, least = exact(kind, *numbers), rounding(kind, *numbers)
            for order, wide in enumerate(WIDE):
                error = float(abs(mpmath.mpc(complex(found[order][k])) - truth[order]))
                allowed = size * wide
                if abs(1.0 - ratio) < 0.0099:
                    allowed = max(allowed, TIMES * least[order])
                assert error <= allowed, (order, at, error, allowed)


@pytest.mark.parametrize("samples", few([36, 361], [36, 361, 721]))
@pytest.mark.parametrize("ratio", spread(RATIOS, 7))
@pytest.mark.parametrize("kind", KINDS)
def test_no_sample_is_lost(kind: str, ratio: float, samples: int) -> None:
    data = ct.motion(linkage(kind, ratio), samples)
    assert set(statuses(data)) == {"ok"}
    assert events(data, "limit") == []
    assert float(data["residual"].max()) <= 1e-13 * max(1.0, 1.0 / abs(1.0 - ratio) * 1e-3)


@pytest.mark.parametrize("samples", [37, 361])
@pytest.mark.parametrize("ratio", [0.9, 0.99, 0.9999, 1 - 1e-6, 1 + 1e-6, 1.001, 1.1])
def test_turns_of_the_rocker(ratio: float, samples: int) -> None:
    """tan(psi/2) = (r + 1)/(r - 1) tan(q/2): nearly a whole turn within |1 - r| of the change point at 0."""
    data = ct.motion(linkage("antiparallelogram", ratio), samples, start=0.3, stop=0.3 + 6 * np.pi)
    q = data["drive_value"].to_numpy()[:, 0]
    factor = (ratio + 1.0) / (ratio - 1.0)
    psi = np.sign(factor) * 2.0 * (np.arctan(abs(factor) * np.tan(q / 2)) + np.pi * np.round(q / 2 / np.pi))
    turned = data["angle"].sel(link="DB").to_numpy()
    # at the first sample the angle is in (-pi, pi]; the value of the drive is rounded to some eps of three turns
    apart = (turned - turned[0]) - (psi - psi[0])
    assert np.max(np.abs(apart)) <= 64 * EPS * max(1.0, abs(factor) / 1e3)


@pytest.mark.parametrize("executor", ["arrays", "machine code"])
def test_many_at_once_turn_as_each_by_itself(executor: str) -> None:
    """Every mechanism of a batch has stretches of its own, about change points of its own width."""
    if executor == "machine code":
        pytest.importorskip("llvmlite")
    ratios = np.array([0.5, 0.99, 0.9999, 1.0001, 1.3])
    vary = {"links.OA.length": ratios, "links.DB.length": ratios}
    many = ct.sweep(
        linkage("antiparallelogram", 0.9), vary, ["angle", "position", "acceleration"], 91, executor=executor
    )
    for k, ratio in enumerate(ratios):
        single = ct.motion(linkage("antiparallelogram", float(ratio)), 91)
        assert set(statuses(single)) == {"ok"}
        for name in ("position", "acceleration"):
            np.testing.assert_array_equal(single[name], many[name][k])
        # angles of a batch begin next to those of the description, those of one mechanism in (-pi, pi]
        turns = (single["angle"] - many["angle"][k]).to_numpy() / (2 * np.pi)
        assert np.max(np.abs(turns - np.round(turns[0]))) <= 4 * EPS


def joined_laws(sense: float) -> list[dict[str, Any]]:
    """A half turn in a second, then the other in half a second: the rate jumps at the change point itself."""
    return [
        {"to": sense * np.pi, "time": 1.0, "curve": "uniform"},
        {"to": sense * 2 * np.pi, "time": 0.5, "curve": "uniform"},
    ]


def test_a_joint_of_laws_at_the_change_point_has_no_derivatives() -> None:
    """Cranks that mirror each other pass a change point at 1 s, where both laws change over to another rate."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "E": [1.0, 0.0]}},
        links={"OA": {"length": 0.3}, "AB": {"length": 0.8}, "CB": {"length": 0.8}, "EC": {"length": 0.3}},
        drives=[
            {"link": "OA", "start": 0.0, "segments": joined_laws(1.0)},
            {"link": "EC", "start": np.pi, "segments": joined_laws(-1.0)},
        ],
        assembly={"sides": {"B": "left"}},
    )
    data = ct.motion(mechanism, at=np.array([0.9, 0.99, 1 - 1e-6, 1.0, 1 + 1e-6, 1.01, 1.1]))
    assert statuses(data) == ["ok", "ok", "singular", "singular", "singular", "ok", "ok"]
    # |AC| = 1 - 0.6 cos q: B stands sqrt(0.64 - (|AC|/2)^2) over the middle of AC
    q = np.array([0.9, 0.99, 1 - 1e-6, 1.0, 1 + 2e-6, 1.02, 1.2]) * np.pi
    height = np.cos(q / 2) * np.sqrt(0.6 * (1.3 - 0.3 * np.cos(q))) + 0.3 * np.sin(q)
    assert np.max(np.abs(point(data, "B").imag - height)) <= 1e-9
    away = [0, 1, 5, 6]
    assert np.max(np.abs(point(data, "B").imag - height)[away]) <= WIDE[0]
    assert np.isfinite(data["acceleration"].sel(point="B").to_numpy()[away]).all()
    assert np.isnan(data["velocity"].sel(point="B").to_numpy()[2:5]).all()
