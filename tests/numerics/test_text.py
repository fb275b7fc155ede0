"""Formulas written as text: values against Python's own arithmetic, and refusal of all that is not arithmetic."""

import contextlib
import math
import warnings
from types import SimpleNamespace
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode.errors import InputError
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.operations import FUNCTIONS, SCALARS, TWO_ARGUMENTS
from centrode.numerics.text_formula import compile_formula

MPMATH = SimpleNamespace(
    sin=mpmath.sin, cos=mpmath.cos, sqrt=mpmath.sqrt, atan2=mpmath.atan2, exp=mpmath.exp, log=mpmath.log
)
FOUR = SimpleNamespace(sin=math.sin, cos=math.cos, sqrt=math.sqrt, atan2=math.atan2)


def value(text: str, **values: Any) -> Any:
    return compile_formula(text, tuple(values), "")(SCALARS, **values)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 + 2*3 - 4/8", 6.5),
        ("2**3**2", 512.0),
        ("-2**2", -4.0),
        ("2^-1", 0.5),
        ("9**0.5", 3.0),
        ("4**(3/2)", 8.0),
        ("4**-1.5", 0.125),
        ("7**0", 1.0),
        ("8 - 3 - 2", 3.0),
        ("16/4/2", 2.0),
        ("(1 - 3)*(2 + 1)", -6.0),
        ("pi", math.pi),
        ("2*π", 2 * math.pi),
        ("e", math.e),
        ("min(3, 1, 2) + max(1, 5)", 6.0),
        ("abs(-2)*sign(-3)", -2.0),
        ("atan2(1, -1)", math.atan2(1, -1)),
        ("1e-3 + .5 + 2.", 2.501),
        (" \t 1 +\n 2 ", 3.0),
    ],
)
def test_arithmetic(text: str, expected: float) -> None:
    assert value(text) == expected


@pytest.mark.parametrize("name", ["sin", "cos", "tan", "sqrt", "exp", "log", "asin", "acos", "atan"])
def test_functions_are_those_of_the_algebra(name: str) -> None:
    assert value(f"{name}(x)", x=0.3) == getattr(math, name)(0.3)


@pytest.mark.parametrize("name", ["tan", "asin", "acos", "atan"])
@pytest.mark.parametrize("x", [-1.0, -0.6, 0.0, 0.3, 0.999999, 1.0])
def test_functions_follow_from_four(name: str, x: float) -> None:
    derived = compile_formula(f"{name}(x)", ("x",), "")(FOUR, x=x)
    assert derived == pytest.approx(getattr(math, name)(x), rel=4e-16, abs=4e-16)


def test_works_over_arrays_and_over_fifty_digits() -> None:
    formula = compile_formula("0.3*sin(2*t) + sqrt(t)/(1 + t**2)", ("t",), "")
    t = np.linspace(0.1, 3.0, 7)
    arrays = SimpleNamespace(sin=np.sin, cos=np.cos, sqrt=np.sqrt, atan2=np.arctan2)
    with mpmath.workdps(50):
        exact = [float(formula(MPMATH, t=mpmath.mpf(float(x)))) for x in t]
    np.testing.assert_allclose(formula(arrays, t=t), exact, rtol=8e-16)
    assert formula.used == {"t"}


@given(st.recursive(
    st.floats(0.1, 9).map(lambda x: repr(round(x, 3))) | st.just("t"),
    lambda inner: st.tuples(inner, st.sampled_from("+-*/"), inner).map(lambda p: f"({p[0]}{p[1]}{p[2]})")
    | inner.map(lambda x: f"(-{x})") | inner.map(lambda x: f"({x})**3"),
    max_leaves=20,
))  # fmt: skip
def test_random_formulas_agree_with_python(text: str) -> None:
    if len(text) > 1000:
        return
    try:
        expected = eval(text, {"t": 0.7})
    except (ArithmeticError, TypeError):
        return
    if isinstance(expected, float) and math.isfinite(expected):
        assert value(text, t=0.7) == pytest.approx(expected, rel=1e-12, abs=1e-12 * abs(expected) + 1e-300)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the formula is empty"),
        ("   ", "the formula is empty"),
        ("2*x + y", 'unknown name "y", at character 7 of "2*x + y"; known are: x, pi, e'),
        ("x^2 + x^3*q", 'unknown name "q", at character 11'),
        ("foo(1)", 'unknown function "foo", at character 1'),
        ("2x", 'an operator is missing after a number, at character 2 of "2x"; write "2*..."'),
        ("1 +", "this is not a formula"),
        ("(1", "this is not a formula"),
        ("1)+(2", "this is not a formula"),
        ("x**x", "an exponent must be a fixed number, at character 4"),
        ("x**0.3", "an exponent must be an integer or a half"),
        ("x**101", "at most 100"),
        ("x**(1/0)", "an exponent must be a fixed number"),
        ("x + 1/(2 - 2)", "no finite value, at character 5"),
        ("sin(exp(1000)*x)", "no finite value, at character 5"),
        ("max(x, log(-1), 3)", "no finite value, at character 8"),
        ("0**-1", "no finite value, at character 1"),
        ("1e999", "too large"),
        ("9" * 400, "too large"),
        ("x.real", "only arithmetic"),
        ("x if x else 1", "only arithmetic"),
        ("not x", "only arithmetic"),
        ("1, 2", "only arithmetic"),
        ("5//2", "unknown operation"),
        ("x % 2", "this character is not allowed in a formula, at character 3"),
        ("x < 2", "this character is not allowed in a formula"),
        ("[x]", "this character is not allowed in a formula"),
        ("'x'", "this character is not allowed in a formula"),
        ("1 # 2", "this character is not allowed in a formula"),
        (
            "ｘ",
            'this character is not allowed in a formula, at character 1 of "ｘ"; write plain letters and digits',
        ),
        ("2*ｓｉｎ(x)", "this character is not allowed in a formula, at character 3"),
        ("x + １", "this character is not allowed in a formula, at character 5"),
        ("ℯ*x", "this character is not allowed in a formula, at character 1"),
        ("2*ℼ", "this character is not allowed in a formula, at character 3"),
        ("𝑥", "this character is not allowed in a formula, at character 1"),
        ("x²", "this character is not allowed in a formula, at character 2"),
        ("х", 'unknown name "х", at character 1'),  # a Cyrillic letter
        ("True", "only numbers"),
        ("sin(1, 2)", "wrong number of arguments"),
        ("atan2(1)", "wrong number of arguments"),
        ("min(1)", "wrong number of arguments"),
        ("sin(*x)", "wrong number of arguments"),
        ("sin", 'unknown name "sin"'),
        ("x()", 'unknown function "x"'),
        ("__import__(1)", "unknown function"),
        ("sin(1)(1)", "only known functions"),
        ("-" * 60 + "1", "nests deeper than 50"),
        ("sin(" * 60 + "1" + ")" * 60, "nests deeper than 50"),
        ("(" * 450 + "1" + ")" * 450, "not a formula"),
        ("x+" * 500 + "1", "at most 1000 characters"),
    ],
)
def test_refusals_say_where_and_what(text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        compile_formula(text, ("x",), "a.toml, law")
    assert message in str(caught.value)
    assert str(caught.value).startswith("a.toml, law: ")


def test_long_sums_are_not_deep() -> None:
    assert value("+".join(["1"] * 400)) == 400.0


@given(st.text(alphabet="0123456789.+-*/^(), tpisncoqre\n_%[]'\"λ٣", max_size=30))
def test_any_text_is_a_formula_or_an_input_error(text: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with contextlib.suppress(InputError):
            compile_formula(text, ("t",), "")


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_plain_numbers_and_arrays_agree(name: str) -> None:
    """Every function of one number is that of arrays, NumPy's own numbers and what has no value included."""
    values = [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, math.nan]
    pairs = [(x, y) for x in values for y in (values if name in TWO_ARGUMENTS else [0.0])]
    for x, y in pairs:
        given = (x, y) if name in TWO_ARGUMENTS else (x,)
        with np.errstate(all="ignore"):
            expected = float(getattr(ARRAYS, name)(*given))
        if not math.isfinite(expected) and not any(map(math.isnan, given)):
            continue  # plain functions raise there
        for kind in (float, np.float64):
            found = getattr(SCALARS, name)(*map(kind, given))
            assert float(found) == pytest.approx(expected, rel=2.0**-50, nan_ok=True)
