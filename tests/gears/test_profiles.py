"""True teeth against the envelope of the rack with fifty digits, and against what is measured on them."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.optimize import brentq, minimize_scalar

from centrode.gears.involutes import involute_curve
from centrode.gears.measurements import measurements
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.profiles import (
    half_base_angle,
    tooth_profile,
    true_contact_ratio,
    turned_pieces,
    wheel_outline,
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
    profile = tooth_profile(pair, 0)
    pieces = {piece.kind: piece for piece in profile.pieces}
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
    profile = tooth_profile(_pair(teeth, shift), 0)
    for before, after in zip(profile.pieces, profile.pieces[1:], strict=False):
        assert np.hypot(*(before.places[-1] - after.places[0])) < 1e-12
    whole = turned_pieces(profile, 0.3, (1.0, 2.0))
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


@pytest.mark.parametrize(
    ("kind", "teeth", "shifts", "number"),
    [
        ("external", (12, 24), (0.6, 0.36), 0),
        ("external", (12, 24), (0.6, 0.36), 1),
        ("external", (25, 40), (-0.1, 0.2), 0),
        ("internal", (20, 62), (0.3, 0.3), 1),
        ("internal", (20, 63), (0.1, -0.2), 1),
    ],
)
def test_measurements_are_those_of_true_teeth(kind, teeth, shifts, number) -> None:
    """Span between parallel tangents and dimension over pins, found on the involutes themselves."""
    pair = PairGeometry(kind, 3.0, teeth, shifts)
    wheel, found = pair.wheels[number], measurements(pair, number)
    base, half, z = wheel.base / 2, half_base_angle(pair, number), wheel.teeth
    sense = -1 if wheel.internal else 1

    def place(roll: float, turned: float, side: int) -> tuple[np.ndarray, np.ndarray]:
        places, slopes = involute_curve(base, np.array([roll]), half, sense)
        mirrored = np.array([side, 1.0])
        cosine, sine = math.cos(turned), math.sin(turned)
        turning = np.array([[cosine, -sine], [sine, cosine]])
        return turning @ (places[0] * mirrored), turning @ (slopes[0] * mirrored)

    # Pins lie in a gap: between this tooth and the next, about the gap's middle.
    def gap_to_pin(radius: float) -> float:
        centre = radius * np.array([math.sin(math.pi / z), math.cos(math.pi / z)])
        near = minimize_scalar(
            lambda roll: float(np.hypot(*(place(roll, 0.0, 1)[0] - centre))), bounds=(1e-6, 1.2), method="bounded",
            options={"xatol": 1e-12},
        )  # fmt: skip
        return float(near.fun) - found.pin / 2

    middle = wheel.pitch / 2 + shifts[number] * 3.0
    radius = brentq(
        gap_to_pin, middle - (0.6 if sense > 0 else 2.4), middle + (2.4 if sense > 0 else 0.6), xtol=1e-11
    )
    between = 2 * radius * (1 if z % 2 == 0 else math.cos(math.pi / (2 * z)))
    assert found.over_pins == pytest.approx(between + sense * found.pin, abs=1e-7)

    # A span: the farther flanks of k teeth, symmetric about the middle between them; the tangent there is upright.
    turned = (found.span_teeth - 1) * math.pi / z if sense > 0 else -(found.span_teeth - 1) * math.pi / z

    def lean(roll: float) -> float:
        # The right flank of the rightmost tooth (of an internal wheel the left flank of it, across gaps).
        return float(place(roll, -abs(turned), 1 if sense > 0 else -1)[1][0])

    roll = brentq(lean, 1e-4, 1.2, xtol=1e-13)
    across = 2 * abs(float(place(roll, -abs(turned), 1 if sense > 0 else -1)[0][0]))
    if sense > 0:
        assert found.span == pytest.approx(across, abs=1e-9)
    assert not math.isnan(found.span)


def test_undercut_is_where_the_rack_cuts_into_the_involute() -> None:
    """By brute force: whether a place of the rack's rounded edge enters the tooth beyond the base circle."""
    generator = np.random.default_rng(7)
    seen = {True: 0, False: 0}
    for _case in range(400):
        teeth, shift = int(generator.integers(6, 40)), float(generator.uniform(-0.6, 0.8))
        pair = PairGeometry("external", 1.0, (teeth, 60), (shift, 0.0))
        if abs(shift - pair.wheels[0].least_shift) < 0.02:
            continue
        base, half = teeth / 2 * math.cos(math.pi / 9), half_base_angle(pair, 0)
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
    profile, base = tooth_profile(pair, 0), pair.wheels[0].base / 2
    corner = next(piece for piece in profile.pieces if piece.kind == "fillet").places[-1]
    assert math.hypot(*corner) > base
    _begin, end = pair.action_ends
    left = (end - math.sqrt(math.hypot(*corner) ** 2 - base**2)) / pair.base_pitch
    assert true_contact_ratio(pair) == pytest.approx(left, rel=1e-9)
    assert true_contact_ratio(pair) < pair.contact_ratio
    whole = PairGeometry("external", 2.0, (20, 40), (0.0, 0.0))
    assert true_contact_ratio(whole) == pytest.approx(whole.contact_ratio, rel=1e-14)
