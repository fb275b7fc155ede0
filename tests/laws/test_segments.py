"""Laws of segments: joints, ends, turns, and what they promise where segments meet."""

import math
import pickle
import sys

import numpy as np
import pytest

from centrode.errors import InputError
from centrode.laws import CURVES, Law, LawSegment, SegmentedLaw
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.rounding_bounds import ROUNDED, SAFETY, Rounded

EPS = sys.float_info.epsilon
JETS = JetFunctions(ARRAYS)
PRESS = (
    LawSegment(2.0, 0.12, "cycloidal"),
    LawSegment(0.5, None, "dwell"),
    LawSegment(1.0, 0.05, "3-4-5"),
    LawSegment(0.5, 0.0, "polynomial", (0.0, 0.0), (0.02,), ((0.125, 0.04),)),
)


def derivatives(law: Law, t: float, order: int = 3) -> list[float]:
    jet = law.jet(JETS, Jet.variable(np.float64(t), order))
    return [float(jet.derivative(k)) for k in range(order + 1)]


@pytest.mark.parametrize("name", CURVES)
def test_a_segment_is_the_curve_in_its_own_time_and_size(name: str) -> None:
    law = SegmentedLaw((LawSegment(0.5, 1.0, "uniform"), LawSegment(4.0, -2.0, name)))
    for u in (0.0, 0.1, 0.3, 0.5, 0.7, 0.9):
        jet = CURVES[name].jet(JETS, Jet.variable(np.float64(u), 3))
        found = derivatives(law, 0.5 + 4 * u)
        # Rounding of the time is carried by the next derivative; no curve's is above 70 up to the fourth but those
        # of the sines, 2 pi and 4 pi to that power.
        margin = 16 * EPS * 3 * (4 * math.pi) ** 4
        for order in range(4):
            expected = -3 * float(jet.derivative(order)) / 4**order + (1.0 if order == 0 else 0.0)
            assert found[order] == pytest.approx(expected, rel=0, abs=margin / 4**order)


def test_joints_have_the_values_that_were_asked_for() -> None:
    law = SegmentedLaw(PRESS)
    assert law.span == (0.0, 4.0)
    assert [law.jet(math, t) for t in (0.0, 2.0, 2.25, 2.5, 3.5, 4.0)] == [0.0, 0.12, 0.12, 0.12, 0.05, 0.0]
    assert law.jet(math, 3.625) == 0.04


@pytest.mark.parametrize("count", [1, 2, 3])
def test_speed_and_acceleration_run_through_joints(count: int) -> None:
    """Of these curves both vanish at the joints, on both sides, exactly."""
    joint = sum(segment.time for segment in PRESS[:count])
    left = derivatives(SegmentedLaw(PRESS[:count]), joint)
    right = derivatives(SegmentedLaw(PRESS), joint)
    assert left[:3] == right[:3]
    assert left[1:3] == [0.0, 0.0]


def test_derivatives_at_joints_are_those_of_what_begins_there() -> None:
    law = SegmentedLaw((LawSegment(1.0, 2.0, "uniform"), LawSegment(1.0, -1.0, "uniform")))
    assert [derivatives(law, t, 1) for t in (0.0, 1.0, 2.0)] == [[0.0, 2.0], [2.0, -3.0], [-1.0, -3.0]]
    jet = law.jet(JETS, Jet.variable(np.array([0.0, 1.0, 2.0]), 1))
    assert jet.derivative(1).tolist() == [2.0, -3.0, -3.0]


def test_before_and_after_it_stays() -> None:
    law = SegmentedLaw((LawSegment(1.0, 2.0, "uniform"),))
    assert derivatives(law, -0.1) == [0.0, 0.0, 0.0, 0.0]
    assert derivatives(law, 1.1) == [2.0, 0.0, 0.0, 0.0]
    np.testing.assert_array_equal(law.jet(ARRAYS, np.array([-9.0, 0.5, 9.0])), [0.0, 1.0, 2.0])
    assert math.isnan(law.jet(math, math.nan))


def test_segments_repeat_and_the_value_runs_on() -> None:
    segments = (
        LawSegment(1.0, 2.0, "cycloidal"),
        LawSegment(0.5, None, "dwell"),
        LawSegment(0.5, 1.5, "uniform"),
    )
    once, law = SegmentedLaw(segments), SegmentedLaw(segments, repeat=True)
    assert law.span is None
    t = np.linspace(0, 2, 33)[:-1]  # whole multiples of 1/16: turns are exact
    for turn in (-3, -1, 0, 1, 40):
        np.testing.assert_array_equal(law.jet(ARRAYS, t + 2 * turn), once.jet(ARRAYS, t) + 1.5 * turn)
    assert derivatives(law, 4.0, 1) == [3.0, 0.0]  # the turn that begins there, not the one that ends
    assert derivatives(law, 2.0 - 2**-40, 1)[1] == -1.0


def test_turns_of_a_period_that_is_no_binary_number() -> None:
    """Where the turn is mistaken by rounding, the formulas at its ends go on: no gap and no stop."""
    law = SegmentedLaw((LawSegment(0.1, 1.0, "uniform"),), repeat=True)
    t = np.arange(-200, 200) * 0.1
    jet = law.jet(JETS, Jet.variable(t, 1))
    np.testing.assert_allclose(jet.value, 10 * t, rtol=0, atol=4 * EPS * 10 * np.abs(t).max())
    np.testing.assert_allclose(jet.derivative(1) * np.ones(400), 10.0, rtol=4 * EPS)


def test_arrays_scalars_and_bounds_agree() -> None:
    t = np.linspace(-1, 5, 61).reshape(1, 61)
    for repeat in (False, True):
        law = SegmentedLaw(PRESS, repeat)
        many = law.jet(ARRAYS, t)
        assert many.shape == (1, 61)
        bounded = law.jet(ROUNDED, Rounded.of(t))
        one = np.array([law.jet(math, number) for number in t.ravel().tolist()])
        assert (np.abs(many.ravel() - one) <= SAFETY * bounded.bound.ravel()).all()
        # The time is known to half a unit of its last place, and the speed stays below 0.3.
        assert (bounded.bound <= 64 * EPS * 0.3 * 5).all()


def test_laws_can_be_sent_and_compared() -> None:
    law = SegmentedLaw(PRESS, True)
    assert pickle.loads(pickle.dumps(law)) == law != SegmentedLaw(PRESS)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"time": 0.0}, "time of a segment must be positive"),
        ({"time": -1.0}, "time of a segment must be positive"),
        ({"time": math.inf}, "finite"),
        ({"to": math.nan}, "finite"),
        ({"curve": "cycloid"}, "known curve"),
        ({"curve": "dwell"}, "unless it dwells"),
        ({"to": None}, "unless it dwells"),
        ({"curve": "polynomial", "through": ((1.0, 0.5),)}, "times of `through`"),
        ({"curve": "polynomial", "through": ((0.5, 0.5), (0.5, 0.6))}, "times of `through`"),
        ({"curve": "polynomial", "at_end": (math.nan,)}, "finite"),
    ],
)
def test_bad_segments_are_refused(wrong: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        LawSegment(**{"time": 1.0, "to": 1.0, "curve": "3-4-5", **wrong})  # type: ignore[arg-type]


def test_bad_laws_are_refused() -> None:
    with pytest.raises(InputError, match="at least one"):
        SegmentedLaw(())
    with pytest.raises(InputError, match="segment 2 is too short"):
        SegmentedLaw((LawSegment(1e20, 1.0, "uniform"), LawSegment(1.0, 2.0, "uniform")))
