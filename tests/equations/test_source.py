"""The worked example of the assignment: formulas (2.5)-(2.8) and (2.10), equal and printed alike."""

from __future__ import annotations

import pytest
import sympy

import centrode as ct
from centrode.equations.derivation import Equations

t, l1, l2, l3, l4 = sympy.symbols("t l1:5")
phi1, phi2, phi3, phi4, omega1, omega2, omega3, omega4 = sympy.symbols("phi1:5 omega1:5")
sin, cos = sympy.sin, sympy.cos

PRINTED = """\
y_C = l₁ sin φ₁ + l₂ sin φ₂ = C₁
x_D = l₁ cos φ₁ + l₂ cos φ₂ + l₃ cos φ₃ + l₄ cos φ₄ = C₂
y_D = l₁ sin φ₁ + l₂ sin φ₂ + l₃ sin φ₃ + l₄ sin φ₄ = C₁ + l₃ sin φ₃ + l₄ sin φ₄ = C₃
ω₁ l₁ cos φ₁ + ω₂ l₂ cos φ₂ = 0
-ω₁ l₁ sin φ₁ - ω₂ l₂ sin φ₂ - ω₃ l₃ sin φ₃ - ω₄ l₄ sin φ₄ = 0
ω₃ l₃ cos φ₃ + ω₄ l₄ cos φ₄ = 0
| l₂ cos φ₂   0           0         |   | ω₂ |       | -l₁ cos t |
| l₂ sin φ₂   l₃ sin φ₃   l₄ sin φ₄ |   | ω₃ |   =   | -l₁ sin t |
| 0           l₃ cos φ₃   l₄ cos φ₄ |   | ω₄ |       | 0         |
Δ = l₂ l₃ l₄ sin(φ₃ - φ₄) cos φ₂
Δ₂ = -l₁ l₃ l₄ sin(φ₃ - φ₄) cos t
Δ₃ = -l₁ l₂ l₄ sin(t - φ₂) cos φ₄
Δ₄ = l₁ l₂ l₃ sin(t - φ₂) cos φ₃
dφ₂/dt = ω₂ = -(l₁/l₂) cos t/cos φ₂
dφ₃/dt = ω₃ = -(l₁/l₃) cos φ₄ sin(t - φ₂)/(cos φ₂ sin(φ₃ - φ₄))
dφ₄/dt = ω₄ = (l₁/l₄) cos φ₃ sin(t - φ₂)/(cos φ₂ sin(φ₃ - φ₄))
v_C = -l₁ sin t - ω₂ l₂ sin φ₂ = l₁ sin(φ₂ - t)/cos φ₂
"""


@pytest.fixture(scope="module")
def found() -> Equations:
    return ct.equations(ct.example("slider-between-cranks"))


def same(one: sympy.Expr, other: sympy.Expr) -> bool:
    return bool(sympy.simplify(one - other) == 0)


def test_lines_are_printed_as_in_the_source(found: Equations) -> None:
    lines = [line.strip() for line in ct.summary(found).splitlines()]
    assert [line for line in PRINTED.splitlines() if line not in lines] == []


def test_differentiated_constraints_are_2_6(found: Equations) -> None:
    printed = {
        "y_C": omega1 * l1 * cos(phi1) + omega2 * l2 * cos(phi2),
        "x_D": -omega1 * l1 * sin(phi1) - omega2 * l2 * sin(phi2) - omega3 * l3 * sin(phi3) - omega4 * l4 * sin(phi4),
        "y_D": omega3 * l3 * cos(phi3) + omega4 * l4 * cos(phi4),
    }  # fmt: skip
    pairs = ((phi1, omega1), (phi2, omega2), (phi3, omega3), (phi4, omega4))
    constraints = {name: one for group in found.groups for name, one in group.constraints.items()}
    assert constraints.keys() == printed.keys()
    for name, one in constraints.items():
        rate = sum(sympy.diff(one, phi) * omega for phi, omega in pairs)
        assert same(rate, printed[name])


def test_the_system_is_2_7(found: Equations) -> None:
    assert found.together is not None
    first, second = found.groups
    assert first.matrix == sympy.Matrix([[l2 * cos(phi2)]])
    assert first.right_side == sympy.Matrix([-l1 * cos(t)])
    assert second.matrix == sympy.Matrix([[l3 * sin(phi3), l4 * sin(phi4)], [l3 * cos(phi3), l4 * cos(phi4)]])
    assert second.right_side == sympy.Matrix([-l1 * sin(t) - omega2 * l2 * sin(phi2), 0])
    assert second.links == ("CB", "BD")
    assert second.symbols == ("phi3", "phi4")
    assert str(second.determinant) == "l3*l4*sin(phi3 - phi4)"
    assert str(first.determinant) == "l2*cos(phi2)"
    numerators = second.determinants
    assert numerators is not None
    for numerator, rate in zip(
        numerators, second.velocities.expressions(second.velocities.formulas).values(), strict=True
    ):
        assert same(numerator / second.determinant, rate)


def test_the_normal_form_is_2_8(found: Equations) -> None:
    under = cos(phi2) * sin(phi3 - phi4)
    printed = {
        "omega2": -l1 / l2 * cos(t) / cos(phi2),
        "omega3": -l1 / l3 * cos(phi4) * sin(t - phi2) / under,
        "omega4": l1 / l4 * cos(phi3) * sin(t - phi2) / under,
    }
    assert found.rates.keys() == printed.keys()
    assert all(same(one, printed[name]) for name, one in found.rates.items())


def test_the_slider_moves_as_2_10_says(found: Equations) -> None:
    velocity = found.velocity("C")
    assert velocity.closed_along is not None
    assert same(velocity.closed_along.expression, l1 * sin(phi2 - t) / cos(phi2))
    assert same(velocity.expressions[0], l1 * sin(phi2 - t) / cos(phi2))
    assert velocity.expressions[1] == 0


def test_accelerations_are_derivatives_of_the_rates(found: Equations) -> None:
    """d omega/dt along the motion, by SymPy from (2.8), at numbers that are nothing special."""
    rates = {sympy.Symbol(f"phi{i}"): found.rates[f"omega{i}"] for i in (2, 3, 4)}
    numbers = {t: 0.3, phi2: 0.7, phi3: 1.9, phi4: 3.3, l1: 0.5, l2: 1.0, l3: 1.2, l4: 0.8}
    known = dict(numbers)
    for i in (2, 3, 4):
        known[sympy.Symbol(f"omega{i}")] = found.rates[f"omega{i}"].subs(numbers).evalf(30)
    for i in (2, 3, 4):
        rate = found.rates[f"omega{i}"]
        total = sympy.diff(rate, t) + sum(sympy.diff(rate, phi) * speed for phi, speed in rates.items())
        found_here = found.accelerations[f"epsilon{i}"].subs(known).evalf(30)
        known[sympy.Symbol(f"epsilon{i}")] = found_here
        # the numbers above are floats: sixteen digits of a handful of terms
        assert abs(found_here - total.subs(numbers).evalf(30)) < 1e-14 * (1 + abs(found_here)) * 16


def test_the_excerpt_has_the_printed_program() -> None:
    """phi2' = k sin(phi1 - phi3)/sin(phi2 - phi3), phi3' = -k sin(phi1 - phi2)/sin(phi2 - phi3), k = omega1 l1/l2."""
    (group,) = ct.equations(ct.example("four-bar-excerpt-printed")).groups
    ends = sin(phi2 - phi3)
    assert same(group.rates["omega2"], omega1 * l1 * sin(phi1 - phi3) / (l2 * ends))
    assert same(group.rates["omega3"], -omega1 * l1 * sin(phi1 - phi2) / (l3 * ends))
