"""Motions through change points against exact ones, on and off the event, in any frame and at any size."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import factorial
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from mechanisms import EPS, Parts, events, moved, parts_of, point, statuses
from samples import few

M = JetFunctions(ARRAYS)
Form = Callable[[Any], Any]


def cis(q: Any) -> Any:
    return M.cos(q) + M.sin(q) * 1j


def mirrored_origin(q: Any) -> Any:
    """Mirror image of O in the line from A = e^iq to D = 2."""
    return 2.0 - (cis(q) - 2.0) / (cis(-q) - 2.0) * 2.0


def antiparallelogram(q: Any) -> Any:
    """B = D + e^(i psi), tan(psi/2) = -3 tan(q/2)."""
    half = M.cos(q * 0.5) - M.sin(q * 0.5) * 3j
    return half / (M.cos(q * 0.5) + M.sin(q * 0.5) * 3j) + 2.0


def galloway(q: Any) -> Any:
    return (M.cos(q * 0.5) + M.sqrt(4.0 - M.sin(q * 0.5) ** 2)) * cis(q * 0.5)


EXACT: dict[str, tuple[str, Form]] = {
    "parallelogram": ("B", lambda q: cis(q) + 2.0),
    "antiparallelogram": ("B", antiparallelogram),
    "kite": ("B", mirrored_origin),
    "galloway": ("B", galloway),
    "scott-russell": ("C", lambda q: M.sin(q) * 2j),
    "three-crank-parallelogram": ("E", lambda q: cis(q) + 0.8),
}
EVENTS = {"scott-russell": [-1.5, -0.5, 0.5, 1.5], "galloway": [-2, 0, 2]}
"""Change points in units of pi within two turns about 0; the others have every multiple of pi."""

MENDED = tuple(16 * factorial(order) * EPS / 0.04 ** (1 + order) for order in range(3))
"""Errors about a change point, in units of the size; an eighth of them was measured (1.1e-14, 2.5e-13, 1.2e-11).

At the end of the stretch on which a power series gives the motion, 0.04 rad away, the root of the closed form has an
error of some EPS/0.04, and its derivatives have those of higher powers. On the circle of the series, 0.08 rad away,
there is less, and the series does not multiply it.
"""


@cache
def parts(name: str) -> Parts:
    return parts_of(ct.example(name))


def worst_errors(
    name: str, turn: float, scale: float, start: float, stop: float, samples: int
) -> list[float]:
    """Greatest errors of value, first and second derivative, in units of the mechanism's size."""
    mechanism = ct.Mechanism(**moved(parts(name), turn, scale=scale))
    data = ct.motion(mechanism, samples, start=start + turn, stop=stop + turn)
    assert set(statuses(data)) == {"ok"}
    q = np.linspace(start, stop, samples)
    label, form = EXACT[name]
    exact = form(Jet.variable(q, 2))
    frame = scale * np.exp(1j * turn)
    return [
        float(np.max(np.abs(point(data, label, variable) / frame - exact.derivative(order))))
        for order, variable in enumerate(("position", "velocity", "acceleration"))
    ]


@pytest.mark.parametrize("samples", [36, 360, 3600])
@pytest.mark.parametrize("name", EXACT)
def test_through_change_points_on_and_off_the_event(name: str, samples: int) -> None:
    for start in (0.0, 0.0123, 0.5):
        errors = worst_errors(name, 0.0, 1.0, start, start + 4 * np.pi, samples + 1)
        for error, allowed in zip(errors, MENDED, strict=True):
            assert error <= allowed


TURNS, SCALES = (0.3, 2.0, -1.234), (1e-6, 1.0, 1e6)


@pytest.mark.parametrize(
    ("turn", "scale"),
    few([*zip(TURNS, SCALES, strict=True)], [(turn, scale) for turn in TURNS for scale in SCALES]),
)
@pytest.mark.parametrize("name", EXACT)
def test_any_frame_and_any_size(name: str, turn: float, scale: float) -> None:
    errors = worst_errors(name, turn, scale, -2 * np.pi, 2 * np.pi, 361)
    for error, allowed in zip(errors, MENDED, strict=True):
        assert error <= allowed


@pytest.mark.parametrize("turn", [0.0, 0.7])
@pytest.mark.parametrize("name", EXACT)
def test_places_of_the_events(name: str, turn: float) -> None:
    mechanism = ct.Mechanism(**moved(parts(name), turn))
    data = ct.motion(mechanism, 3, start=turn - 2 * np.pi, stop=turn + 2 * np.pi)
    found = np.array(events(data, "change point"))
    found = found[np.append(True, np.diff(found) > 1e-6)]
    expected = np.pi * np.array(EVENTS.get(name, [-2, -1, 0, 1, 2])) + turn
    # the place is the root of the radicand's derivative, whose rounding is some eps over a second derivative of order 1
    assert found == pytest.approx(expected, abs=64 * EPS * 2 * np.pi)
    assert events(data, "limit") == []


def test_two_turns_of_the_crank_for_one_of_the_rocker() -> None:
    """Galloway: period 4 pi; after one turn of the crank the rocker stands elsewhere."""
    data = ct.motion(ct.example("galloway"), 5, start=1.0, stop=1.0 + 8 * np.pi)
    b = point(data, "B")
    assert abs(b[2] - b[0]) <= MENDED[0] * 3
    assert abs(b[4] - b[0]) <= MENDED[0] * 3
    assert abs(b[1] - b[0]) > 1.0
    gained = data["angle"].sel(link="DB").to_numpy()
    assert gained[2] - gained[0] == pytest.approx(2 * np.pi, abs=MENDED[0])


def test_a_value_does_not_depend_on_the_samples_around_it() -> None:
    for name in EXACT:
        wide = ct.motion(ct.example(name), 9, start=-np.pi, stop=np.pi)
        for k, q in enumerate(wide["drive_value"].to_numpy()[:, 0]):
            one = ct.motion(ct.example(name), 1, start=q, stop=q)
            for variable in ("position", "velocity", "acceleration", "angle"):
                np.testing.assert_array_equal(one[variable].to_numpy()[0], wide[variable].to_numpy()[k])


def kept(name: str) -> ct.Mechanism:
    return ct.Mechanism(**{**parts(name), "assembly": {"continuation": "keep"}})


def test_keep_keeps_the_sign_and_is_singular_at_the_event() -> None:
    data = ct.motion(kept("parallelogram"), 5, start=np.pi - 1, stop=np.pi + 1)
    at = ct.motion(kept("parallelogram"), 1, start=np.pi, stop=np.pi)
    assert statuses(data)[2] == "singular" or statuses(at) == ["singular"]
    assert set(statuses(data)[:2] + statuses(data)[3:]) == {"ok"}
    assert point(at, "B")[0] == pytest.approx(1.0, abs=1e-7)  # the root of a radicand known to eps: eps^(1/2)
    assert np.isnan(at["velocity"].sel(point="B").to_numpy()).all()
    assert np.isnan(at["acceleration"].sel(point="B").to_numpy()).all()
    # before the event the parallelogram, after it the antiparallelogram, on the same side of AD
    q = data["drive_value"].to_numpy()[:, 0]
    before, after = EXACT["parallelogram"][1](q[:2]), antiparallelogram(q[3:])
    assert point(data, "B")[:2] == pytest.approx(before, abs=64 * EPS)
    assert point(data, "B")[3:] == pytest.approx(after, abs=64 * EPS)


def test_start_at_a_change_point_needs_a_side_and_goes_on() -> None:
    there = parts_of(ct.example("parallelogram"))
    there["drives"][0]["start"] = 0.0
    there["links"]["DB"].pop("angle")
    there["links"]["AB"].pop("angle")
    with pytest.raises(
        ct.InputError, match=r'degenerate in the initial position.*sides, B = "left" \| "right"'
    ):
        ct.motion(ct.Mechanism(**there))
    for side, form in (("left", EXACT["parallelogram"][1]), ("right", antiparallelogram)):
        # going up from 0, B lies left of A -> D in the parallelogram, right in the antiparallelogram
        there["assembly"] = {"sides": {"B": side}}
        data = ct.motion(ct.Mechanism(**there), 361, start=-2 * np.pi, stop=2 * np.pi)
        assert set(statuses(data)) == {"ok"}
        exact = form(Jet.variable(data["drive_value"].to_numpy()[:, 0], 2))
        assert np.max(np.abs(point(data, "B") - exact.value)) <= MENDED[0]
        assert np.max(np.abs(point(data, "B", "acceleration") - exact.derivative(2))) <= MENDED[2]


@pytest.mark.parametrize("gap", [1e-9, -1e-9])
def test_almost_a_change_point(gap: float) -> None:
    """A parallelogram's coupler longer or shorter by 1e-9: limits on both sides of the place, or a passage past it."""
    near = parts_of(ct.example("parallelogram"))
    near["links"]["AB"]["length"] *= 1 + gap
    data = ct.motion(ct.Mechanism(**near), 721, start=1.0, stop=1.0 + 2 * np.pi)
    assert events(data, "change point") == []
    # AD shorter than AB - DB, or longer than AB + DB: at q = 0 with the longer coupler, at q = pi with the shorter one
    locks = 2 * np.pi if gap > 0 else np.pi
    limits = np.array(events(data, "limit"))
    # |AD|^2 = 5 - 4 cos q reaches (2 +- gap 2 -+ 1)^2: q^2 is about 2 |gap| at 0, 6 |gap| at pi
    half = np.sqrt(2 * 1e-9) if gap > 0 else np.sqrt(6 * 1e-9)
    assert limits[(limits > 1.0) & (limits < 1.0 + 2 * np.pi)] == pytest.approx(
        [locks - half, locks + half], abs=1e-9
    )
    passes = np.pi if gap > 0 else 2 * np.pi
    assert not np.any(np.abs(limits - passes) < 0.5)
