"""Pairs of gears against printed tables, and against velocities and contacts that are computed from true teeth."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import root

from centrode.gears.involutes import involute_curve
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.shift_choice import shift_sum_at
from centrode.geometry.involute import involute, pressure_angle_of

DEGREE = math.pi / 180
RANDOM = np.random.default_rng(33)


def test_involute_function_and_its_inverse() -> None:
    for angle in (1e-8, 1e-4, 0.03, 0.049, 0.051, 0.3, 1.2, 1.5):
        assert pressure_angle_of(involute(angle)) == pytest.approx(angle, rel=4e-15 / min(1, angle**0.1))
    # Printed in tables of the involute function (20 degrees: 0.0149044).
    assert involute(20 * DEGREE) == pytest.approx(0.0149044, abs=5e-8)
    assert math.isnan(pressure_angle_of(-1e-9))
    assert involute(1e-3) == pytest.approx(1e-9 / 3 * (1 + 2 / 5 * 1e-6), rel=1e-12)


def test_printed_spur_pair() -> None:
    """A maker's table: m 3, 12 and 24 teeth, shifts 0.6 and 0.36; four decimals of a millimetre."""
    pair = PairGeometry("external", 3.0, (12, 24), (0.6, 0.36))
    assert math.degrees(pair.working_angle) == pytest.approx(26.0886, abs=5e-5)
    assert pair.centre_distance == pytest.approx(56.4999, abs=5e-5)
    assert pair.contact_ratio == pytest.approx(1.2021, abs=5e-5)
    printed = (
        ("working_pitch", 37.6666, 75.3332), ("tip", 44.8397, 79.3997), ("root", 32.100, 66.660),
        ("base", 33.8289, 67.6579), ("addendum", 4.420, 3.700), ("dedendum", 1.950, 2.670),
    )  # fmt: skip
    for name, *values in printed:
        for wheel, value in zip(pair.wheels, values, strict=True):
            assert getattr(wheel, name) == pytest.approx(value, abs=2e-4), name


def test_printed_helical_pair() -> None:
    """Bolsover's table of a profile shifted helical pair: m 3, beta 30 deg, 12 and 60 teeth, x 0.09809 and 0."""
    pair = PairGeometry("external", 3.0, (12, 60), (0.09809, 0.0), 30 * DEGREE, width=20.0)
    assert math.degrees(pair.transverse.pressure_angle) == pytest.approx(22.79588, abs=5e-6)
    assert math.degrees(pair.working_angle) == pytest.approx(23.1126, abs=5e-5)
    assert pair.distance_coefficient == pytest.approx(0.09744, abs=1e-5)
    assert pair.centre_distance == pytest.approx(125.0, abs=5e-4)
    assert pair.contact_ratio == pytest.approx(1.294, abs=5e-4)
    assert pair.overlap_ratio == pytest.approx(1.061, abs=5e-4)
    printed = (
        ("pitch", 41.569, 207.846), ("base", 38.322, 191.611), ("working_pitch", 41.667, 208.333),
        ("addendum", 3.292, 2.998), ("dedendum", 3.456, 3.750), ("tip", 48.154, 213.842), ("root", 34.658, 200.346),
    )  # fmt: skip
    for name, *values in printed:
        for wheel, value in zip(pair.wheels, values, strict=True):
            assert getattr(wheel, name) == pytest.approx(value, abs=6e-4), name


@pytest.mark.parametrize(
    ("kind", "teeth", "module", "shifts", "angle", "distance"),
    [
        # A sheet of centre distances of profile shifted gears.
        ("internal", (17, 96), 14.0, (0.2, 0.5), 21.1251, 557.0887),
        ("external", (30, 78), 16.0, (0.0, 0.05), 20.1446, 864.7972),
    ],
)
def test_printed_centre_distances(kind, teeth, module, shifts, angle, distance) -> None:
    pair = PairGeometry(kind, module, teeth, shifts)
    assert math.degrees(pair.working_angle) == pytest.approx(angle, abs=5e-5)
    assert pair.centre_distance == pytest.approx(distance, abs=5e-5)


def test_printed_chordal_thickness() -> None:
    """SDP/SI, Elements of metric gear technology, table 10-1: m 10, 12 teeth, x 0.3, addendum 13."""
    wheel = PairGeometry("rack", 10.0, (12, math.inf), (0.3, 0.0)).wheels[0]
    assert wheel.addendum == pytest.approx(13.0, abs=5e-5)
    assert wheel.pitch_thickness == pytest.approx(17.8918, abs=5e-5)
    assert math.degrees(wheel.pitch_thickness / wheel.pitch) == pytest.approx(8.54270, abs=6e-6)
    chord, height = wheel.chordal_thickness(wheel.pitch)
    assert chord == pytest.approx(17.8256, abs=5e-5)
    assert height == pytest.approx(13.6657, abs=5e-5)


def test_printed_sum_of_shifts_at_a_centre_distance() -> None:
    """A worked sheet after ISO 21771:2007: m 3.5, 31 and 30 teeth, distances 114.3447280708 and 116.5."""
    helix = math.acos(3.5 * 61 / 2 / 114.3447280708)
    pair = PairGeometry("external", 3.5, (31, 30), (0.0, 0.0), helix)
    assert math.degrees(pair.transverse.pressure_angle) == pytest.approx(21.2990642859, abs=2e-9)
    total = shift_sum_at(pair, 116.5)
    assert total == pytest.approx(0.651877131252, abs=2e-10)
    working = PairGeometry("external", 3.5, (31, 30), (0.291, total - 0.291), helix)
    assert math.degrees(working.working_angle) == pytest.approx(23.8707609654, abs=2e-9)
    assert working.centre_distance == pytest.approx(116.5, abs=1e-10)


def test_contact_ratio_without_shift_and_least_teeth() -> None:
    assert PairGeometry("external", 1.0, (17, 34), (0, 0)).contact_ratio == pytest.approx(1.5977, abs=5e-5)
    assert PairGeometry("external", 1.0, (20, 40), (0, 0)).contact_ratio == pytest.approx(1.6352, abs=5e-5)
    # 2/sin^2(20 deg) teeth are the fewest without undercut.
    assert PairGeometry("external", 1.0, (18, 40), (0, 0)).wheels[0].least_teeth == pytest.approx(
        17.0973, abs=5e-5
    )
    assert PairGeometry("external", 1.0, (12, 40), (0, 0)).wheels[0].least_shift == pytest.approx(
        0.29813, abs=5e-6
    )


def test_a_rack_is_an_endless_wheel() -> None:
    rack = PairGeometry("rack", 3.0, (20, math.inf), (0.0, 0.0))
    near = PairGeometry("external", 3.0, (20, 10_000_000), (0.0, 0.0))
    assert rack.contact_ratio == pytest.approx(near.contact_ratio, abs=1e-5)
    assert rack.wheels[0].sliding == pytest.approx(near.wheels[0].sliding, rel=1e-4)
    assert rack.wheels[1].sliding == pytest.approx(near.wheels[1].sliding, rel=1e-5)


def _pairs() -> list[PairGeometry]:
    """Random pairs that can work: external, internal, helical."""
    pairs: list[PairGeometry] = []
    while len(pairs) < 24:
        first = int(RANDOM.integers(12, 40))
        helix = float(RANDOM.choice([0.0, 0.2]))
        internal = len(pairs) % 3 == 2
        second = first + int(RANDOM.integers(12, 60)) if internal else int(RANDOM.integers(12, 90))
        shifts = float(RANDOM.uniform(0, 0.6)), float(RANDOM.uniform(0, 0.6))
        pair = PairGeometry("internal" if internal else "external", 2.0, (first, second), shifts, helix)
        if math.isfinite(pair.working_angle) and pair.contact_ratio > 1.05 and pair.action_ends[0] > 0.1:
            pairs.append(pair)
    return pairs


PAIRS = _pairs()


def _flank(pair: PairGeometry, number: int, roll: float, turned: float) -> tuple[np.ndarray, np.ndarray]:
    """Place and slope of the flanks that touch while the pinion turns clockwise, each wheel turned by an angle.

    The pinion's centre is the origin, the wheel's lies above it (below it where it is internal). At zero a tooth of the
    pinion and a gap of the wheel lie on the line of centres.
    """
    wheel = pair.wheels[number]
    half = wheel.half_base_angle
    places, slopes = involute_curve(wheel.base / 2, np.array([roll]), half, -1 if wheel.internal else 1)
    place, slope = places[0], slopes[0]
    if number == 0:
        angle, centre = turned, np.zeros(2)
    else:
        # The tooth on the right of the gap, and its flank on the left there: below its centre that is the one
        # on the right of a tooth that points up.
        if pair.sign < 0:
            place, slope = place * [-1, 1], slope * [-1, 1]
        step = math.pi / wheel.teeth
        angle = turned + (math.pi + step if pair.sign > 0 else -step)
        centre = np.array([0.0, pair.sign * pair.centre_distance])
    cosine, sine = math.cos(angle), math.sin(angle)
    turning = np.array([[cosine, -sine], [sine, cosine]])
    return turning @ place + centre, turning @ slope


def _contact(pair: PairGeometry, turned: float) -> tuple[float, np.ndarray, tuple[float, float]]:
    """Turn of the wheel, place of the contact, and rolls of both involutes, where the flanks touch."""

    def gaps(unknown: np.ndarray) -> list[float]:
        other, first, second = unknown
        (a, da), (b, db) = _flank(pair, 0, first, turned), _flank(pair, 1, second, other)
        cross = da[0] * db[1] - da[1] * db[0]
        return [a[0] - b[0], a[1] - b[1], cross / np.hypot(*da) / np.hypot(*db)]

    guess = [-pair.sign * turned / pair.ratio, math.tan(pair.working_angle), math.tan(pair.working_angle)]
    found = root(gaps, guess, tol=1e-14).x
    assert max(map(abs, gaps(found))) < 1e-11
    return float(found[0]), _flank(pair, 0, found[1], turned)[0], (float(found[1]), float(found[2]))


@pytest.mark.parametrize("pair", PAIRS[:12], ids=lambda pair: f"{pair.kind}-{pair.teeth}")
def test_true_flanks_keep_the_ratio_over_the_line_of_action(pair: PairGeometry) -> None:
    """Turns of the wheel at which true flanks touch are those of the ratio; contact lasts as the formula says."""
    begin, end = pair.action_ends
    base = pair.wheels[0].base / 2
    # The pinion turns by as much as the contact moves along the line of action over the base radius.
    rolls = np.linspace(begin + 0.02, end - 0.02, 9) / base
    # The flank passes the pitch point when half of the tooth has turned past the line of centres.
    pitch_roll, half = (
        math.tan(pair.working_angle),
        pair.wheels[0].half_base_angle - involute(pair.working_angle),
    )
    start = _contact(pair, 0.0)
    for roll in rolls:
        turned = half + pitch_roll - roll
        other, place, (first, second) = _contact(pair, turned)
        assert other - start[0] == pytest.approx(-pair.sign * turned / pair.ratio, abs=1e-10)
        assert first == pytest.approx(roll, abs=1e-9)
        radius = np.hypot(*place)
        assert pair.wheels[0].base / 2 <= radius <= pair.wheels[0].tip / 2
        own = pair.wheels[1].base / 2 * math.hypot(1, second)
        inside = own <= pair.wheels[1].tip / 2 if pair.sign > 0 else own >= pair.wheels[1].tip / 2
        assert inside
    # From the tip of the wheel to that of the pinion the pinion turns by contact ratio times its pitch angle.
    first_roll = _roll_at_other_tip(pair)
    last_roll = math.sqrt((pair.wheels[0].tip / pair.wheels[0].base) ** 2 - 1)
    by_contact = (last_roll - first_roll) / (2 * math.pi / pair.teeth[0])
    assert by_contact == pytest.approx(pair.contact_ratio, abs=1e-8)


def _roll_at_other_tip(pair: PairGeometry) -> float:
    """Roll of the pinion's flank where the wheel's tip touches it, by true flanks."""
    tip = math.sqrt((pair.wheels[1].tip / pair.wheels[1].base) ** 2 - 1)

    def gap(turned: np.ndarray) -> float:
        return _contact(pair, float(turned[0]))[2][1] - tip

    begin = pair.action_ends[0] / (pair.wheels[0].base / 2)
    half = pair.wheels[0].half_base_angle - involute(pair.working_angle)
    turned = float(root(gap, [half + math.tan(pair.working_angle) - begin - 0.01], tol=1e-13).x[0])
    return _contact(pair, turned)[2][0]


@pytest.mark.parametrize("pair", PAIRS[12:], ids=lambda pair: f"{pair.kind}-{pair.teeth}")
def test_specific_sliding_is_that_of_velocities(pair: PairGeometry) -> None:
    """Sliding by the velocities of both wheels at the contact, along the common tangent."""
    begin, end = pair.action_ends
    omega = np.array([-1.0, pair.sign / pair.ratio])  # clockwise pinion
    for radius in np.linspace(begin + 0.01, end - 0.01, 5):
        angle = pair.working_angle
        pitch = np.array([0.0, pair.wheels[0].working_pitch / 2])
        # The pinion turns clockwise: the contact moves to the right and up along the line of action.
        place = pitch + (radius - pair.pitch_curvature_radius) * np.array([math.cos(angle), math.sin(angle)])
        tangent = np.array([-math.sin(angle), math.cos(angle)])
        centre = np.array([0.0, pair.sign * pair.centre_distance])
        speeds = [
            rate * float(np.dot(np.array([-arm[1], arm[0]]), tangent))
            for rate, arm in zip(omega, (place, place - centre), strict=True)
        ]
        first, second = pair.specific_sliding(radius)
        assert float(first) == pytest.approx(1 - speeds[1] / speeds[0], rel=1e-9, abs=1e-11)
        assert float(second) == pytest.approx(1 - speeds[0] / speeds[1], rel=1e-9, abs=1e-11)
