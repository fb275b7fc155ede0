"""Positions in closed form, letter by letter, against the motion, which knows nothing of auxiliary vectors."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import sympy
import xarray as xr
from hypothesis import assume, given, settings

import centrode as ct
from centrode.equations.derivation import Equations
from centrode.equations.instants import PlacedEquations, equation_results, instant_of, position_values
from centrode.equations.sphere_chains import SphereBoard
from centrode.equations.symbols import Sum
from centrode.errors import Status
from centrode.sheets.sheet import Formula
from centrode.views.equations import sheet
from growing import descriptions, mechanism_of
from growing_sphere import Growing
from growing_sphere import mechanisms as spherical_mechanisms
from mechanisms import EPS, four_bar
from samples import few, spread
from worked_out import planar_examples

WORTH = 1e6
"""Positions whose condition is worse prove nothing about formulas and are passed over."""
OPERATIONS = 64
"""Roundings in the lines of one group."""
MENDED = 1e-10
"""Error of places about change points, where motions are interpolated."""


def compared(found: Equations, motion: xr.Dataset) -> int:
    """Compare all places and angles at all samples; the number of samples that were worth it."""
    functions, scale = found.position_functions, float(found.board.numbers.scale)
    meanings = found.board.alphabet.meanings
    count = 0
    for sample in np.flatnonzero(motion.status.to_numpy() == Status.OK).tolist():
        instant = instant_of(found, motion, sample)
        condition = max((one.condition for one in instant.velocities), default=1.0)
        if not condition < WORTH:
            continue
        count += 1
        values = position_values(found, motion, sample)
        turns = max(1.0, *(abs(x) for x in instant.values.values() if np.isfinite(x)))
        allowed = OPERATIONS * EPS * condition * len(functions.groups) * max(1.0, scale) * turns
        allowed += MENDED if motion.event_kind.size else 0.0
        for point, place in functions.places.items():
            at = motion.position.sel(point=point).to_numpy()[sample]
            own = [total.value(np, values.__getitem__) for total in place]
            assert np.abs(np.array(own) - at).max() <= allowed, (point, sample, allowed)
        for letter in found.board.alphabet.rates:
            away = values[letter] - instant.values[letter]
            away -= math.tau * round(away / math.tau) if meanings[letter].unit == "rad" else 0.0
            assert abs(away) <= allowed / min(1.0, scale), (letter, sample, away)
    return count


@pytest.mark.parametrize("name", spread(planar_examples(), 16))
def test_positions_of_examples(name: str) -> None:
    mechanism = ct.example(name)
    found = ct.equations(mechanism)
    assert compared(found, ct.motion(mechanism, 7))
    # every moving point has its coordinates, and only groups of higher class have none in closed form
    assert set(found.position_functions.places) == set(found.board.moving)
    assert all(one.kind == "higher class" for one in found.position_functions.groups if one.unsolved)


@settings(max_examples=few(8, 60), deadline=None)
@given(descriptions())
def test_positions_of_random_mechanisms(parts: dict[str, Any]) -> None:
    mechanism = mechanism_of(parts)
    found = ct.equations(mechanism)
    assume(compared(found, ct.motion(mechanism, 5)))
    assert not found.position_functions.unsolved_letters


@pytest.mark.parametrize(
    "mechanism",
    [ct.example("parallelogram"), ct.example("kite"), four_bar(2.0, 3.0, 3.0, 4.0)],
    ids=["parallelogram", "kite", "in line"],
)
def test_signs_after_a_change_of_branch(mechanism: ct.Mechanism) -> None:
    """Past a change point the formulas with the other sign are those of the motion."""
    found, motion = ct.equations(mechanism), ct.motion(mechanism, 13)
    (branch,) = found.position_functions.branches
    assert compared(found, motion) >= 8
    reached = np.flatnonzero(motion.status.to_numpy() == Status.OK).tolist()
    signs = {int(position_values(found, motion, sample)[branch.letter]) for sample in reached}
    assert signs == {-1, 1}


def test_the_source_s_letters_and_numbers() -> None:
    """Six-bar of the coursework at phi = 99.1 deg: formulas as it writes them, numbers to its last printed digit."""
    mechanism = ct.example("six-bar-press")
    text = ct.summary(ct.equations(mechanism))
    for line in (
        "l_AC = √((x_A - x_C)² + y_A²) = √(l₁² + x_C² - 2 l₁ x_C cos φ₁)",
        "δ₁ = atan2(y_A, x_C - x_A)",
        "δ₂ = arccos((l_AC² + l₃² - l₂²)/(2 l_AC l₃))",
        "φ₃ = π - δ₁ - δ₂",
        "x_B = x_C + l₃ cos φ₃",
        "φ₂ = atan2(y_B - y_A, x_B - x_A)",
        "δ₃ = arcsin((y_D - C₃)/l₄)",
        "x_H = x_D + l₄ cos φ₄",
    ):
        assert f"\n  {line}\n" in text
    found = equation_results(mechanism, None, [math.radians(120.0)])
    assert isinstance(found, PlacedEquations) and found.place_values[0] is not None
    values = {letter.name: value for letter, value in found.place_values[0].items()}
    degrees = {"delta1": 11.921, "delta2": 72.32, "phi3": 95.759, "phi2": 22.167, "delta3": 27.745}
    for name, printed in degrees.items():
        assert abs(math.degrees(values[name]) - printed) <= 0.5e-3 * (10.0 if name == "delta2" else 1.0)
    lengths = {
        "l_AC": 1.455,
        "x_B": 1.165,
        "y_B": 0.846,
        "x_D": 1.079,
        "y_D": 1.691,
        "x_H": 2.584,
        "x_S2": 0.496,
    }
    for name, printed in lengths.items():
        assert abs(values[name] - printed) <= 0.5e-3


def test_expressions_for_further_work() -> None:
    """Put in one after the other, the expressions give the motion."""
    mechanism = ct.example("crank-rocker")
    found = ct.equations(mechanism)
    symbols: dict[str, Any] = {
        name: value for name, value in found.values.items() if not name.startswith("phi")
    }
    symbols["phi1"] = 1.0
    for name, one in found.positions.items():
        symbols[name] = one.subs({sympy.Symbol(x): y for x, y in symbols.items()})
    motion = ct.motion(mechanism, at=[1.0])
    for axis in "xy":
        assert (
            abs(float(symbols[f"{axis}_B"]) - float(motion.position.sel(point="B", axis=axis)[0])) <= 64 * EPS
        )
    assert str(found.positions["phi3"]) == "-delta1 - delta2 + pi"


# On the sphere.


def axes_of(board: SphereBoard) -> Any:
    first, second = (np.array(board.inside["frame"][name]) for name in board.firsts["frame"])
    upright = np.cross(first, second) / np.linalg.norm(np.cross(first, second))
    return np.stack([first, np.cross(upright, first), upright])


def compared_on_sphere(mechanism: ct.Mechanism, samples: int) -> dict[int, list[int]]:
    """Compare all places; sign of each dyad at the samples that were worth it."""
    found, motion = ct.equations(mechanism), ct.motion(mechanism, samples)
    board, functions = found.board, found.position_functions
    assert isinstance(board, SphereBoard)
    axes, signs = axes_of(board), dict[int, list[int]]()
    for sample in np.flatnonzero(motion.status.to_numpy() == Status.OK).tolist():
        values = position_values(found, motion, sample)
        # an arc cosine loses what its sine is short of one, and so does a direction of a short vector
        worst = 1.0
        for one in functions.groups:
            for letter in one.auxiliary[2:]:
                worst /= abs(math.sin(values[letter])) * min(1.0, values[one.auxiliary[0]])
        if not worst < WORTH:
            continue
        allowed = 16 * OPERATIONS * EPS * worst * len(functions.groups or (1,))
        allowed += MENDED if motion.event_kind.size else 0.0
        for point, place in functions.places.items():
            at = axes @ motion.position.sel(point=point).to_numpy()[sample]
            own = [total.value(np, values.__getitem__) for total in place]
            assert np.abs(np.array(own) - at).max() <= allowed, (point, sample, allowed)
        for number, branch in enumerate(functions.branches):
            signs.setdefault(number, []).append(int(values[branch.letter]))
    return signs


@pytest.mark.parametrize(
    "name", ["spherical-crank-rocker", "spherical-crank-guide", "hookes-joint", "wobble-plate"]
)
def test_positions_on_the_sphere(name: str) -> None:
    assert compared_on_sphere(ct.example(name), 13)


@settings(max_examples=few(6, 40), deadline=None)
@given(spherical_mechanisms(("RRR", "RRP", "rigid point", "turned link")))
def test_positions_of_random_mechanisms_on_the_sphere(growing: Growing) -> None:
    try:
        compared_on_sphere(ct.Mechanism.model_validate(growing.parts()), 3)
    except ct.InputError as refused:
        assert "too many terms" in refused.what


def test_spherical_coordinates_of_the_thesis() -> None:
    """tan theta_C explicitly, with the right sign of the root, and both angles of B, against the motion."""
    mechanism = ct.example("spherical-crank-rocker")
    found, motion = ct.equations(mechanism), ct.motion(mechanism, 25)
    b, c = found.position_functions.spherical
    assert c.tangent is not None and not c.y
    text = ct.summary(found)
    assert "tan φ_B = sin AB cos φ₁/cos AB\n" in text
    root = "√(sin² AB sin² φ₁ + cos² AB - cos² BC)"
    assert f"tan θ_C = tan φ₃ = (-cos AB sin AB sin φ₁ + cos BC {root})/(cos² AB - cos² BC)\n" in text
    for sample in range(25):
        values = position_values(found, motion, sample)
        at = {name: motion.position.sel(point=name).to_numpy()[sample] for name in "BC"}
        theta = math.atan2(math.hypot(*at["C"][:2]), at["C"][2])
        explicit = float(c.tangent[1].value(values.__getitem__))
        assert abs(math.atan(explicit) - theta) <= 64 * EPS / math.sin(
            values[found.position_functions.groups[0].auxiliary[2]]
        )
        assert abs(float(b.z.value(np, values.__getitem__)) - at["B"][2]) <= 8 * EPS
        longitude = float(b.y.value(np, values.__getitem__)) / float(b.x.value(np, values.__getitem__))
        assert abs(longitude - math.tan(math.atan2(at["B"][1], at["B"][0]))) <= 16 * EPS


@pytest.mark.parametrize(("name", "instant"), [("six-bar-press", 2.0), ("spherical-crank-rocker", 0.7)])
def test_documents_have_the_values_of_the_first_instant(name: str, instant: float) -> None:
    """Every line of the chapter ends with its number at the instant, the detail has the numbers put in."""
    found = equation_results(ct.example(name), None, [instant, instant + 1.0])
    assert isinstance(found, PlacedEquations) and found.place_values[0] is not None
    sections = sheet(found).chapters["equations"].sections
    titles = [str(section.title) for section in sections]
    (place,) = [k for k, title in enumerate(titles) if "with their values at" in title]
    shown = [
        (line[0].total, line[-1].value)  # type: ignore[union-attr]
        for block in sections[place].blocks
        if isinstance(block, Formula)
        for line in block.lines
    ]
    lines = found.position_functions.lines
    assert [total for total, _value in shown] == [Sum.letter(line.letter) for line in lines]
    for (_total, value), line in zip(shown, lines, strict=True):
        assert abs(value - found.place_values[0][line.letter]) <= 8 * EPS
    assert sections[place + 1].detail and not sections[place].detail
