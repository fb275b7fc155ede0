"""Absence is a status and NaN: ok, open, cut off, singular, and the limits between them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import centrode as ct
from centrode.errors import Status
from mechanisms import EPS, events, four_bar, moved, parts_of, point, statuses

VALUES = ("position", "velocity", "acceleration", "angle", "angular_velocity", "angular_acceleration")
DERIVATIVES = ("velocity", "acceleration", "angular_velocity", "angular_acceleration")
TRIPLE_ROCKER = float(np.arccos((4 + 16 - 5.5**2) / 16))
"""Lengths 2, 2.5, 3, 4: AD = 2.5 + 3 by the law of cosines; the four-bar locks there and at the opposite angle."""


def locked() -> ct.Mechanism:
    return ct.example("slider-between-cranks-locked")


def test_statuses_of_a_mechanism_that_locks() -> None:
    data = ct.motion(locked(), 101)
    q = data["drive_value"].to_numpy()[:, 0]
    upper, lower = 1.79991241652444028, 5.47487058607948
    expected = np.select([q < upper, q > lower], ["ok", "cut off"], "open").tolist()
    assert statuses(data) == expected
    assert {"ok", "open", "cut off"} == set(expected)


def test_open_samples_hold_nothing_and_cut_off_ones_everything() -> None:
    data = ct.motion(locked(), 101)
    status = data["status"].to_numpy()
    moving = [name for name in data.point.to_numpy() if name not in ("O", "D")]
    for name in VALUES:
        variable = data[name].sel(point=moving) if "point" in data[name].dims else data[name]
        values = variable.to_numpy()
        assert np.isnan(values[status == Status.OPEN]).all()
        assert np.isfinite(values[status != Status.OPEN]).all()
    for name in ("slide", "slide_velocity", "slide_acceleration", "residual"):
        values = data[name].to_numpy()
        assert np.isnan(values[status == Status.OPEN]).all()
        assert np.isfinite(values[status != Status.OPEN]).all()
    # nothing stands at the frame's points either, where there is no motion
    assert np.isnan(data["position"].sel(point="O").to_numpy()[status == Status.OPEN]).all()


def test_cut_off_samples_close_the_loop() -> None:
    data = ct.motion(locked(), 101)
    status = data["status"].to_numpy()
    b, c = (point(data, name)[status == Status.CUT_OFF] for name in "BC")
    d = ct.example("slider-between-cranks-locked").frame.coordinates["D"]
    assert np.abs(b - c) == pytest.approx(1.2 * np.ones(len(b)), abs=8 * EPS * 2)
    assert np.abs(b - complex(*d)) == pytest.approx(0.8 * np.ones(len(b)), abs=8 * EPS * 2)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_limits_of_a_four_bar_without_a_crank(sense: float) -> None:
    data = ct.motion(four_bar(2.0, 2.5, 3.0, 4.0), 9, start=-sense * 3.0, stop=sense * 3.0)
    # the radicand is known to some eps of itself and has a slope of its own order there
    assert events(data, "limit") == pytest.approx([-TRIPLE_ROCKER, TRIPLE_ROCKER], abs=4 * np.spacing(3.0))
    assert statuses(data) == ["open"] * 1 + ["ok"] * 7 + ["open"] * 1


@pytest.mark.parametrize("turn", [0.0, 0.7, -2.3])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_limits_in_any_frame_and_size(turn: float, scale: float) -> None:
    parts = moved(parts_of(four_bar(2.0, 2.5, 3.0, 4.0)), turn, scale=scale)
    data = ct.motion(ct.Mechanism(**parts), 9, start=turn - 3.0, stop=turn + 3.0)
    expected = [turn - TRIPLE_ROCKER, turn + TRIPLE_ROCKER]
    # turned, the frame's points are rounded: the angle of OD by some eps
    assert events(data, "limit") == pytest.approx(expected, abs=8 * np.spacing(4.0))


def test_a_sample_on_a_limit_is_singular() -> None:
    mechanism = four_bar(2.0, 2.5, 3.0, 4.0)
    found = events(ct.motion(mechanism, 2, start=-3.0, stop=3.0), "limit")
    data = ct.motion(mechanism, 2, start=found[0], stop=found[1])
    assert statuses(data) == ["singular", "singular"]
    for name in DERIVATIVES:
        assert np.isnan(data[name].sel({"link": "DB"} if "link" in data[name].dims else {"point": "B"})).all()
    # B on the line AD, 2.5 from A; at the limit a place is the root of a radicand known to eps
    a, b = point(data, "A"), point(data, "B")
    straight = a + 2.5 / 5.5 * (4 - a)
    assert np.abs(b - straight) == pytest.approx(np.zeros(2), abs=np.sqrt(EPS) * 4)
    assert np.isfinite(data["residual"].to_numpy()).all()


def test_slider_crank_with_a_short_rod_locks() -> None:
    """Rod shorter than the crank: sin q = +-l/r are the limits."""
    mechanism = ct.slider_crank(2.0, 1.0, start=0.0)
    data = ct.motion(mechanism, 361, start=-np.pi, stop=np.pi)
    nearest = [q for q in events(data, "limit") if abs(q) < 1.0]
    assert nearest == pytest.approx([-np.arcsin(0.5), np.arcsin(0.5)], abs=4 * EPS)
    words = set(statuses(data))
    assert {"ok", "open", "cut off"} <= words <= {"ok", "open", "cut off", "singular"}


def test_tangent_mechanism_goes_to_infinity() -> None:
    """Two parallel lines do not meet: a limit of a group without a radicand."""
    data = ct.motion(ct.example("tangent-mechanism"), 5, start=-2.0, stop=2.0)
    assert events(data, "limit") == pytest.approx([-np.pi / 2, np.pi / 2], abs=4 * EPS)
    assert statuses(data) == ["cut off", "ok", "ok", "ok", "cut off"]


def test_displacement_drives_stop_at_their_limits() -> None:
    data = ct.motion(ct.example("elliptic-trammel"), 5, start=-1.5, stop=1.5)
    assert events(data, "limit") == pytest.approx([-1.0, 1.0], abs=4 * EPS)
    assert statuses(data) == ["open", "ok", "ok", "ok", "open"]


def test_default_range_of_a_displacement_drive_is_inside_its_limits() -> None:
    parts = parts_of(ct.example("elliptic-trammel"))
    parts.pop("study")
    data = ct.motion(ct.Mechanism(**parts), 11)
    x = data["drive_value"].to_numpy()[:, 0]
    assert set(statuses(data)) == {"ok"}
    # the limits at +-1, half a hundredth of the range left out at both ends
    assert [x[0], x[-1]] == pytest.approx([-0.99, 0.99], abs=16 * EPS)


def test_two_groups_lock_at_their_own_places() -> None:
    """Watt's chain with a short upper rod: the nearer limit is the upper dyad's, found against its own equation."""
    parts = parts_of(ct.example("watt-six-bar"))
    parts["links"]["QR"]["length"] = 0.45
    for name in ("PR", "QR"):
        parts["links"][name].pop("angle")
    parts["assembly"] = {"sides": {"R": "right"}}
    data = ct.motion(ct.Mechanism(**parts), 721)
    limits = [q for q in events(data, "limit") if q > 0]
    crank_rocker = ct.Mechanism(**{**parts, "links": {k: v for k, v in parts["links"].items() if k[-1] != "R"},
                                   "assembly": {}})  # fmt: skip

    def gap(q: float) -> float:
        at = ct.motion(crank_rocker, 1, start=q, stop=q)
        return float(abs(point(at, "P") - point(at, "Q"))[0]) - 1.65

    assert limits
    for q in limits:
        # brentq stops within 4 eps of its argument
        assert brentq(gap, q - 0.01, q + 0.01, xtol=4 * EPS) == pytest.approx(q, abs=64 * EPS)


@pytest.mark.parametrize(
    ("law", "stop", "message"),
    [
        ("log(t)", 1.0, "no finite value at t = 0"),
        ("log(1 - t)", 2.0, "no finite value with two derivatives"),
        ("1000000 * t", 1.0, "it is too long: 1.59e[+]05 turns; give at most 500"),
    ],
)
def test_laws_that_cannot_be_followed(law: str, stop: float, message: str) -> None:
    mechanism = four_bar(1.0, 3.5, 3.0, 4.0, drives=[{"link": "OA", "law": law}])
    with pytest.raises(ct.InputError, match=message):
        ct.motion(mechanism, 5, stop=stop)


@pytest.mark.parametrize(("start", "stop"), [(-1e7, 1.0), (1.0, 1e7)])
def test_ranges_too_far_away(start: float, stop: float) -> None:
    with pytest.raises(ct.InputError, match="it is too long"):
        ct.motion(four_bar(1.0, 3.5, 3.0, 4.0), 5, start=start, stop=stop)


@pytest.mark.parametrize("samples", [0, -1, 10**9, True, 2.5, "many"])
def test_impossible_numbers_of_samples(samples: Any) -> None:
    with pytest.raises(ct.InputError, match=r"samples? (is|are) given; give 1 to 1000000"):
        ct.motion(four_bar(1.0, 3.5, 3.0, 4.0), samples)


def test_an_empty_range_is_refused() -> None:
    """Many samples of one position are a slip; one sample of it is what somebody may want."""
    turning = four_bar(1.0, 3.5, 3.0, 4.0)
    by_law = four_bar(1.0, 3.5, 3.0, 4.0, drives=[{"link": "OA", "law": "t"}])
    for mechanism, unit in ((turning, "rad"), (by_law, "s")):
        with pytest.raises(ct.InputError, match=f"the range is empty: it begins and ends at 1 {unit}; give"):
            ct.motion(mechanism, 5, start=1.0, stop=1.0)
        assert ct.motion(mechanism, 1, start=1.0, stop=1.0).sizes["sample"] == 1
