"""Equations on the sphere: as the source writes them, and against motion, which knows nothing of arcs and closures."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

import centrode as ct
from centrode.equations.derivation import Equations
from centrode.equations.sphere_chains import SphereBoard
from growing_sphere import Growing, Vector, angle_at, mechanisms
from mechanisms import EPS
from samples import few
from worked_out import Values, initial_values, value_of

WORTH = 1e5
"""Positions whose condition is worse prove nothing about formulas."""
OPERATIONS = 4096
"""Roundings in the places of four groups on each other, their derivatives and right sides, of errors that add up."""


def mechanism_of(growing: Growing) -> ct.Mechanism:
    return ct.Mechanism.model_validate(growing.parts())


def places(motion: Any, sample: int) -> dict[str, Vector]:
    return {str(name): motion.position.sel(point=name)[sample].to_numpy() for name in motion.point.values}


def spin(motion: Any, link: str, sample: int) -> Vector:
    if link == "frame":
        return np.zeros(3)
    return np.asarray(motion.angular_velocity.sel(link=link)[sample].to_numpy())


def board_of(found: Equations) -> SphereBoard:
    assert isinstance(found.board, SphereBoard)
    return found.board


def own_axes(found: Equations, at: dict[str, Vector]) -> Vector:
    """The axes in which the formulas are written, as rows."""
    first, second = (at[name] for name in board_of(found).firsts["frame"])
    upright = np.cross(first, second)
    upright /= np.linalg.norm(upright)
    return np.stack([first, np.cross(upright, first), upright])


def conditioned(found: Equations, values: Values) -> float:
    """What its slope, of terms of the size of one, makes of the rounding of a closure."""
    slopes = [group.velocities.system.matrix[0][0] for group in found.groups]
    sizes = [abs(float(one.value(math, values.__getitem__))) for one in slopes]
    return 1.0 / min(sizes, default=1.0) if min(sizes, default=1.0) else math.inf


def check(mechanism: ct.Mechanism, *, passed: bool = False) -> bool:
    """Places, velocities and rates of angles by the formulas in the initial position against motion."""
    found = ct.equations(mechanism)
    values = initial_values(found)
    worth = conditioned(found, values)
    if not worth < WORTH:
        return passed
    motion = ct.motion(
        mechanism, at=[0.0] if len(mechanism.drives) > 1 else [float(mechanism.drives[0].start or 0.0)]
    )
    at = places(motion, 0)
    axes = own_axes(found, at)
    speed = 1.0 + max((abs(values[one.rate]) for one in found.unknowns), default=0.0)
    allowed = OPERATIONS * EPS * worth * len(found.groups or (1,)) * speed
    for point in found.board.moving:
        velocity = found.velocity(point)
        formulas = [velocity.x, velocity.y, velocity.z]
        place = [one.value(math, values.__getitem__) for one in velocity.place]
        assert np.abs(np.array(place) - axes @ at[point]).max() <= allowed
        rates = [value_of(one, values) for one in formulas if one is not None]
        known = axes @ motion.velocity.sel(point=point)[0].to_numpy()
        assert np.abs(np.array(rates) - known).max() <= allowed
    for one in found.unknowns:
        kind, _dot, link = one.name.partition(".")
        pivot = next(x.names[1] for x in found.legend if x.symbol == one.letter.name)
        if kind == "angle":
            base = board_of(found).body_of(pivot)
            turning = float((spin(motion, link, 0) - spin(motion, base, 0)) @ at[pivot])
            assert abs(turning - values[one.rate]) <= allowed
    return True


@pytest.mark.parametrize("name", [name for name in ct.example_names() if ct.example(name).space == "sphere"])
def test_examples_agree_with_motion(name: str) -> None:
    mechanism = ct.example(name)
    try:
        assert check(mechanism)
    except ct.InputError as refused:
        assert "driven links and dyads" in refused.what


@settings(max_examples=few(6, 25), deadline=None)
@given(mechanisms(("RRR", "RRP", "rigid point", "turned link")))
def test_random_mechanisms_agree_with_motion(growing: Growing) -> None:
    mechanism = mechanism_of(growing)
    try:
        check(mechanism, passed=True)
    except ct.InputError as refused:
        assert "too many terms" in refused.what


def parts_of(crank: float, coupler: float, rocker: float, ground: float, side: str) -> dict[str, Any]:
    return {
        "space": "sphere",
        "frame": {"points": {"A": [0, 0], "D": [ground, 0]}},
        "links": {
            "AB": {"length": crank, "reference": ["A", "D"]},
            "BC": {"length": coupler},
            "DC": {"length": rocker, "reference": ["D", "A"]},
        },
        "drives": [{"link": "AB", "start": 0.3, "speed": 1.0}],
        "assembly": {"sides": {"C": side}},
    }


def four_bar(crank: float, coupler: float, rocker: float, ground: float, side: str) -> ct.Mechanism:
    return ct.Mechanism.model_validate(parts_of(crank, coupler, rocker, ground, side))


SIDES = ("left", "right")
ARCS = [(0.3, 1.1, 1.0, 1.2), (0.5, 1.4, 0.9, 1.3), (math.pi / 2, math.pi / 2, math.pi / 2, 0.5)]


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("arcs", ARCS)
def test_a_whole_turn_of_a_four_bar(arcs: tuple[float, float, float, float], side: str) -> None:
    """Angles read from places satisfy the closures, and their rates and accelerations are those of the formulas."""
    found = ct.equations(four_bar(*arcs, side))
    motion = ct.motion(four_bar(*arcs, side), samples=37)
    letters = {one.name: one for one in (*found.board.alphabet.rates, *found.board.alphabet.seconds)}
    letters |= {one.name: one for one in found.board.alphabet.seconds.values()}
    for sample in range(37):
        at = places(motion, sample)
        values: Values = dict(found.board.alphabet.values)
        for letter, name in found.given.names.items():
            values[name] = values[letter]
        beta = float(motion.drive_value[sample, 0])
        values |= {letters["phi1"]: beta, letters["omega1"]: 1.0, letters["epsilon1"]: 0.0}
        values[letters["phi3"]] = angle_at(at["D"], at["A"], at["C"])
        corner = abs(angle_at(at["C"], at["D"], at["B"]))
        values[letters["gamma2"]] = math.pi / 2 - corner
        for group in found.groups:
            for condition in group.conditions:
                assert abs(condition.residual.value(math, values.__getitem__)) <= 64 * EPS
        for number, variable in ((0, "angular_velocity"), (1, "angular_acceleration")):
            for group in found.groups:
                solution = (group.velocities, group.seconds)[number]
                matrix, right = (
                    float(one.value(math, values.__getitem__))
                    for one in (solution.system.matrix[0][0], solution.system.right[0])
                )
                letter = solution.letters[0]
                values[letter] = right / matrix
                if group.symbols == ("phi3",):
                    known = float(motion[variable].sel(link="DC")[sample].to_numpy() @ at["D"])
                    speed = 1.0 + abs(known) + abs(values[letters["omega3"]]) ** 2
                    assert abs(known - values[letter]) <= 512 * EPS * speed / matrix**2
                elif number == 0:
                    spins = spin(motion, "BC", sample) - spin(motion, "DC", sample)
                    known = abs(float(spins @ at["C"]))
                    assert abs(known - abs(values[letter])) <= 512 * EPS * (1.0 + known) / matrix**2


def test_the_source_s_equations() -> None:
    text = ct.summary(ct.equations(ct.example("spherical-crank-rocker")))
    assert "cos BC = sin AB sin φ₁ cos φ₃ + cos AB sin φ₃\n" in text
    assert "sin BC sin γ₂ = sin AB cos φ₁\n" in text
    assert "γ̇₂ = -ω₁ sin AB sin φ₁/(sin BC cos γ₂)\n" in text


@pytest.mark.parametrize(("crank", "whole", "printed"), [(12, 3, 0.3747), (24, 2, 0.1320)])
def test_gamma_at_the_start_is_the_source_s(crank: int, whole: int, printed: float) -> None:
    ab = math.pi / crank
    bc = math.pi / whole - ab
    parts = parts_of(ab, bc, math.pi / 2, math.pi / 2, "left")
    parts["drives"] = [{"link": "AB", "start": 0.0, "speed": 1.0}]
    found = ct.equations(ct.Mechanism.model_validate(parts))
    assert abs(abs(found.values["gamma2"]) - printed) <= 0.5e-4


def test_groups_that_are_not_written_are_refused() -> None:
    parts = parts_of(0.3, 1.1, 1.0, 1.2, "left")
    parts["guides"] = [
        {"name": "one", "point": "P", "on": "AB", "pole": [1.0, 0.4], "radius": 0.9},
        {"name": "other", "point": "P", "on": "frame", "pole": [0.4, 0.8], "radius": 0.9},
    ]
    parts["assembly"]["sides"]["P"] = "left"
    with pytest.raises(ct.InputError, match="driven links and dyads"):
        ct.equations(ct.Mechanism.model_validate(parts))


def test_other_axes_are_told() -> None:
    parts = parts_of(0.3, 1.1, 1.0, 1.2, "left")
    assert "Axes" not in ct.summary(ct.equations(ct.Mechanism.model_validate(parts), ["C"]))
    parts["frame"]["points"] = {"A": [0.2, 0.1], "D": [1.4, 0.1]}
    text = ct.summary(ct.equations(ct.Mechanism.model_validate(parts), ["C"]))
    assert "x passes through A, D lies in the half-plane of x and y" in text
    assert "cos BC = " in text and " cos AD" in text
