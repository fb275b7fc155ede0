"""True teeth against the envelope of the rack with fifty digits, and against what is measured on them."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

from centrode.gears.measurements import base_tangent_length, span_over_teeth, wheel_measurements
from centrode.gears.pair_geometry import GearWheel, PairGeometry
from centrode.gears.profiles import (
    tooth_profile,
    true_contact_ratio,
    wheel_outline,
    whole_tooth,
)
from centrode.gears.racks import fillet_curve
from rack_envelope import fillet_place, flank_place

SHAPES = [(24, 0.36), (12, 0.6), (8, 0.0), (60, -0.4), (17, 0.0)]


def _pair(teeth: int, shift: float) -> PairGeometry:
    return PairGeometry("external", 1.0, (teeth, 40), (shift, 0.0))


@pytest.mark.parametrize(("teeth", "shift"), SHAPES)
def test_teeth_are_the_envelope_of_the_rack(teeth: int, shift: float) -> None:
    """Fillets and flanks to 1e-12 of the module."""
    pair = _pair(teeth, shift)
    profile = tooth_profile(pair.wheels[0])
    pieces = {piece.layer: piece for piece in profile.pieces}
    for normal, place in zip(pieces["fillet"].parameter, pieces["fillet"].places, strict=True):
        exact = fillet_place(float(normal), teeth, shift, pair.rack.fillet)
        assert np.hypot(float(exact[0] - mpf(place[0])), float(exact[1] - mpf(place[1]))) < 1e-12
    for place in pieces["flank"].places[:: len(pieces["flank"].places) // 5]:
        # The height on the rack's flank that makes the place is found by its radius.
        radius = math.hypot(*place)

        def gap(height, radius=radius):
            x, y = flank_place(height, teeth, shift)
            return mp.sqrt(x * x + y * y) - mpf(radius)

        alpha = mp.pi / 9
        # Radius of curvature = height along the normal: start from it.
        curvature = math.sqrt(max(radius**2 - (teeth / 2 * math.cos(math.pi / 9)) ** 2, 0.0))
        start = (mpf(curvature) - mpf(teeth) / 2 * mp.sin(alpha)) * mp.sin(alpha) - mpf(shift)
        height = mp.findroot(
            gap, (start, start + mpf("1e-6")), solver="secant", tol=mpf("1e-60"), verify=False
        )
        exact = flank_place(height, teeth, shift)
        assert np.hypot(float(exact[0] - mpf(place[0])), float(exact[1] - mpf(place[1]))) < 2e-12


@pytest.mark.parametrize(("teeth", "shift"), SHAPES)
def test_pieces_join_and_slopes_are_derivatives(teeth: int, shift: float) -> None:
    profile = tooth_profile(_pair(teeth, shift).wheels[0])
    for before, after in zip(profile.pieces, profile.pieces[1:], strict=False):
        assert np.hypot(*(before.places[-1] - after.places[0])) < 1e-12
    whole = [piece.moved_by(0.3, (1.0, 2.0)) for piece in whole_tooth(profile)]
    for before, after in itertools.pairwise(whole):
        assert np.hypot(*(before.places[-1] - after.places[0])) < 1e-12
    for piece in profile.pieces:
        # Hermite's cubic between two places hits the middle of a finer curve as its fourth derivative allows.
        step = np.diff(piece.parameter)[:, None]
        middles = (piece.places[1:] + piece.places[:-1]) / 2 + step * (
            piece.slopes[:-1] - piece.slopes[1:]
        ) / 8
        radii = np.hypot(*middles.T)
        assert (radii < np.hypot(*piece.places.T).max() + 1e-6).all()
    outline = wheel_outline(profile)
    assert np.hypot(*np.diff(outline, axis=0).T).max() < 0.4
    area = 0.5 * np.sum(outline[:-1, 0] * outline[1:, 1] - outline[1:, 0] * outline[:-1, 1])
    root, tip = profile.pieces[0].places[0], profile.pieces[-1].places[-1]
    assert math.pi * np.hypot(*root) ** 2 < area < math.pi * np.hypot(*tip) ** 2


WHEELS = [
    PairGeometry("external", 3.0, (12, 24), (0.6, 0.36)).wheels[0],
    PairGeometry("external", 3.0, (12, 24), (0.6, 0.36)).wheels[1],
    PairGeometry("external", 3.0, (25, 40), (-0.1, 0.2)).wheels[0],
    PairGeometry("internal", 3.0, (20, 62), (0.3, 0.3)).wheels[1],
    PairGeometry("internal", 3.0, (20, 63), (0.1, -0.2)).wheels[1],
    PairGeometry("internal", 3.0, (20, 81), (0.0, 0.9)).wheels[1],
]
"""Wheels of which measurements are taken from true teeth, even and odd, external and internal."""


def _right_flank(wheel: GearWheel) -> CubicHermiteSpline:
    """The right flank of the true tooth on the y axis, as a curve through its places with their slopes."""
    flank = next(piece for piece in tooth_profile(wheel).pieces if piece.layer == "flank")
    order = 1 if flank.parameter[0] < flank.parameter[-1] else -1
    return CubicHermiteSpline(flank.parameter[::order], flank.places[::order], flank.slopes[::order])


NEAR_FLANK = 2e-5
"""By so much [m] lie cubic curves through 25 places of flanks of module 3 from the involute, generously."""


@pytest.mark.parametrize("wheel", WHEELS, ids=lambda wheel: f"{wheel.internal}-{wheel.teeth}")
def test_span_is_the_distance_of_parallel_tangents_of_true_flanks(wheel: GearWheel) -> None:
    """Jaws on the true flanks about the middle of k teeth, of an internal wheel of k gaps."""
    curve, found = _right_flank(wheel), wheel_measurements(wheel)
    assert found.span_teeth >= 2
    # An external jaw lies on the right flank of the last of k teeth, an internal one on the left flank of the tooth
    # behind the last of k gaps; the tangent there is upright, the middle of all lies on the y axis.
    turned = (found.span_teeth - (1 if not wheel.internal else 0)) * math.pi / wheel.teeth
    mirror = -1 if wheel.internal else 1
    cosine, sine = math.cos(turned), math.sin(turned)

    def across(roll: float, derivative: int) -> float:
        x, y = curve(roll, derivative)
        return float(cosine * mirror * x + sine * y)

    roll = brentq(lambda value: across(value, 1), curve.x[0], curve.x[-1], xtol=1e-13)
    assert found.span == pytest.approx(2 * across(roll, 0), abs=NEAR_FLANK)


@pytest.mark.parametrize("wheel", WHEELS, ids=lambda wheel: f"{wheel.internal}-{wheel.teeth}")
def test_pins_touch_true_flanks(wheel: GearWheel) -> None:
    """A pin in the middle of a gap whose least distance from the true flank is its radius."""
    curve, found = _right_flank(wheel), wheel_measurements(wheel)
    gap = math.pi / wheel.teeth
    fine = curve(np.linspace(curve.x[0], curve.x[-1], 20_001))

    def beyond(radius: float) -> float:
        centre = radius * np.array([math.sin(gap), math.cos(gap)])
        return float(np.hypot(*(fine - centre).T).min()) - found.pin / 2

    pitch = wheel.pitch / 2 + wheel.shift * 3.0
    # On an external wheel the pin lies outside the middle of the flank, on an internal one inside.
    low, high = (pitch - 0.6, pitch + 2.6) if not wheel.internal else (pitch - 2.6, pitch + 0.6)
    radius = brentq(beyond, low, high, xtol=1e-11)
    between = 2 * radius * (1 if wheel.teeth % 2 == 0 else math.cos(gap / 2))
    assert found.over_pins == pytest.approx(between + wheel.outwards * found.pin, abs=10 * NEAR_FLANK)


@pytest.mark.parametrize("wheel", WHEELS, ids=lambda wheel: f"{wheel.internal}-{wheel.teeth}")
def test_chords_are_those_of_true_teeth(wheel: GearWheel) -> None:
    """The chord of a tooth on circles through places of the true flank."""
    flank = next(piece for piece in tooth_profile(wheel).pieces if piece.layer == "flank")
    for x, y in flank.places[1:-1]:
        chord, height = wheel.chordal_thickness(2 * math.hypot(x, y))
        assert chord == pytest.approx(2 * x, abs=1e-12 * wheel.tip)
        assert height == pytest.approx(wheel.outwards * (wheel.tip / 2 - y), abs=1e-12 * wheel.tip)
    # The constant chord is the chord where the rack's flank at its middle touches: upright to the radius of contact.
    found = wheel_measurements(wheel)
    alpha = wheel.pair.rack.pressure_angle
    x = wheel.pitch_thickness / 2 * math.cos(alpha) ** 2
    y = wheel.pitch / 2 + wheel.outwards * wheel.pitch_thickness / 2 * math.cos(alpha) * math.sin(alpha)
    assert found.constant_chord == pytest.approx(2 * x, rel=1e-12)
    assert found.constant_chord_height == pytest.approx(
        wheel.outwards * (wheel.tip / 2 - y), abs=1e-12 * wheel.tip
    )


def test_spans_exist_where_jaws_reach_the_flanks() -> None:
    """One tooth more adds the base pitch; a narrow helical wheel has no span."""
    wheel = WHEELS[1]
    teeth, span = span_over_teeth(wheel)
    assert base_tangent_length(wheel, teeth) == span
    step = base_tangent_length(wheel, teeth + 1) - span
    assert step == pytest.approx(wheel.pair.base_pitch, rel=1e-12)
    narrow = PairGeometry("external", 3.0, (40, 60), (0.0, 0.0), 0.5, width=4.0)
    assert span_over_teeth(narrow.wheels[0])[0] == 0


def test_undercut_is_where_the_rack_cuts_into_the_involute() -> None:
    """By brute force: whether a place of the rack's rounded edge enters the tooth beyond the base circle."""
    generator = np.random.default_rng(7)
    seen = {True: 0, False: 0}
    for _case in range(400):
        teeth, shift = int(generator.integers(6, 40)), float(generator.uniform(-0.6, 0.8))
        pair = PairGeometry("external", 1.0, (teeth, 60), (shift, 0.0))
        if abs(shift - pair.wheels[0].least_shift) < 0.02:
            continue
        base, half = teeth / 2 * math.cos(math.pi / 9), pair.wheels[0].half_base_angle
        # A slight undercut is a narrow range of normals next to the flank's own.
        normals = math.pi / 9 + np.geomspace(1e-10, 1.0, 20_000)
        places = fillet_curve(pair.transverse, teeth / 2, shift, normals)[0]
        places = places[np.hypot(*places.T) > base * (1 + 1e-9)]
        roll = np.sqrt((np.hypot(*places.T) / base) ** 2 - 1)
        flank = half - (roll - np.arctan(roll))
        enters = bool((np.arctan2(*places.T) < flank - 1e-13).any())
        assert pair.wheels[0].undercut == enters, (teeth, shift)
        seen[enters] += 1
    assert min(seen.values()) > 100


def test_an_undercut_wheel_loses_contact() -> None:
    """The contact ratio of true teeth, by the corner where fillet and involute cross."""
    pair = PairGeometry("external", 2.0, (9, 40), (0.0, 0.0))
    profile, base = tooth_profile(pair.wheels[0]), pair.wheels[0].base / 2
    corner = next(piece for piece in profile.pieces if piece.layer == "fillet").places[-1]
    assert math.hypot(*corner) > base
    _begin, end = pair.action_ends
    left = (end - math.sqrt(math.hypot(*corner) ** 2 - base**2)) / pair.base_pitch
    assert true_contact_ratio(pair) == pytest.approx(left, rel=1e-9)
    assert true_contact_ratio(pair) < pair.contact_ratio
    whole = PairGeometry("external", 2.0, (20, 40), (0.0, 0.0))
    assert true_contact_ratio(whole) == pytest.approx(whole.contact_ratio, rel=1e-14)
