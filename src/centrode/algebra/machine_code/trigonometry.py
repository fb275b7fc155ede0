"""Sine, cosine and the angle of a vector on vectors of doubles: the greatest errors stand in docs/engine.md.

The argument is brought to |r| <= pi/4 by Cody and Waite's reduction: r = x - k pi/2 with pi/2 in several
parts, kept as r + low. Beyond `REDUCED` the C library is asked, lane by lane.
"""

from __future__ import annotations

import math

from centrode.algebra.machine_code.language import Code, Value
from centrode.algebra.machine_code.library import by_library_where
from centrode.algebra.machine_code.polynomials import (
    ARCTANGENT,
    COSINE,
    QUARTER_TURN,
    QUARTER_TURN_SHORT,
    SINE,
    SLOPE,
)

REDUCED = 1e5
"""Greatest magnitude that is reduced here: k stays below 2^17, so that its products with parts are exact."""
ROUNDER = 1.5 * 2.0**52
"""Adding it rounds to a whole number, which then stands in the lowest bits."""
SIGN_OF_DOUBLE = 63
SMALLEST = 5e-324


def sine_and_cosine(code: Code, x: Value) -> tuple[Value, Value]:
    """Sine and cosine of x; below 1 ULP from the true value for |x| <= 1e5, the C library's beyond."""
    turns = code.add(code.multiply(x, code.constant(2.0 / math.pi)), code.constant(ROUNDER))
    k = code.subtract(turns, code.constant(ROUNDER))
    r, low = _reduced_by_fma(code, x, k) if code.has_fma else _reduced(code, x, k)
    sine, cosine = _sine(code, r, low), _cosine(code, r, low)
    quarter = code.bits_of(turns)
    odd = _is_odd(code, quarter)
    near = (
        _flipped(code, code.select(odd, cosine, sine), quarter),
        _flipped(code, code.select(odd, sine, cosine), code.whole("add", quarter, 1)),
    )
    # a zero keeps its sign
    at_zero = code.compare("oeq", x, code.constant(0.0))
    near = code.select(at_zero, x, near[0]), near[1]
    beyond = code.compare("ogt", code.intrinsic("fabs", x), code.constant(REDUCED))
    far = by_library_where(code, beyond, ("sin", "cos"), (x,), near)
    return far[0], far[1]


def _reduced_by_fma(code: Code, x: Value, k: Value) -> tuple[Value, Value]:
    """The rest x - k pi/2 as a sum of two; the first product and difference are exact together."""
    first, second, third = (code.constant(part) for part in QUARTER_TURN)
    back = code.negate(k)
    near = code.fma(back, first, x)
    product = code.multiply(k, second)
    # what rounding took from the product
    lost = code.fma(back, second, product)
    r, low = _difference(code, near, product)
    return _sum_of_two(code, r, code.fma(back, third, code.add(low, lost)))


def _reduced(code: Code, x: Value, k: Value) -> tuple[Value, Value]:
    """The same where the machine rounds products: parts so short that products with k are exact."""
    r, low = x, code.constant(0.0)
    for part in QUARTER_TURN_SHORT:
        r, lost = _difference(code, r, code.multiply(k, code.constant(part)))
        low = code.add(low, lost)
    return _sum_of_two(code, r, low)


def _difference(code: Code, a: Value, b: Value) -> tuple[Value, Value]:
    """The difference of any two numbers, and what rounding took from it (Knuth)."""
    rest = code.subtract(a, b)
    taken = code.subtract(a, rest)
    return rest, code.subtract(code.subtract(a, code.add(rest, taken)), code.subtract(b, taken))


def _sum_of_two(code: Code, a: Value, b: Value) -> tuple[Value, Value]:
    """The sum of a and a smaller b, and what rounding took from it."""
    total = code.add(a, b)
    return total, code.subtract(b, code.subtract(total, a))


def _sine(code: Code, r: Value, low: Value) -> Value:
    """Sine of r + low, |r| <= pi/4: r + (r z P(z) + low)."""
    z = code.multiply(r, r)
    return code.add(r, code.multiply_add(code.multiply(r, z), code.polynomial(SINE, z), low))


def _cosine(code: Code, r: Value, low: Value) -> Value:
    """Cosine of r + low, |r| <= pi/4: 1 - z/2 with the rounding of that difference, z^2 P(z) and r low."""
    z = code.multiply(r, r)
    half, one = code.multiply(z, code.constant(0.5)), code.constant(1.0)
    most = code.subtract(one, half)
    rest = code.subtract(code.subtract(one, most), half)
    rest = code.subtract(rest, code.multiply(r, low))
    return code.add(most, code.multiply_add(code.multiply(z, z), code.polynomial(COSINE, z), rest))


def _is_odd(code: Code, quarter: Value) -> Value:
    lowest = code.whole("and", quarter, 1)
    zero = code.vector.whole_constant(0)
    return code.block.put(f"icmp ne {code.vector.whole} {lowest}, {zero}")


def _flipped(code: Code, value: Value, quarter: Value) -> Value:
    """The value, with the other sign in the third and the fourth quarter."""
    sign = code.whole("shl", code.whole("and", quarter, 2), SIGN_OF_DOUBLE - 1)
    return code.from_bits(code.block.put(f"xor {code.vector.whole} {code.bits_of(value)}, {sign}"))


def angle(code: Code, y: Value, x: Value) -> Value:
    """The angle of (x, y) in [-pi, pi]; below 2 ULP from the true value, zeros and infinities by C's rules.

    The sum of x and y must not be beyond all numbers: up to 8e307 they may be anything.
    """
    ax, ay = code.intrinsic("fabs", x), code.intrinsic("fabs", y)
    steep = code.compare("ogt", ay, ax)
    least, most = code.select(steep, ax, ay), code.select(steep, ay, ax)
    # a steeper vector is turned back by pi/4, and one that is infinite both ways
    bound = code.multiply(code.subtract(most, least), code.constant(SLOPE / (1.0 - SLOPE)))
    turned = code.compare("ugt", least, bound)
    t = _arctangent(code, _slope(code, least, most, turned))
    left = _is_negative(code, x)
    # in the upper half plane the angle is +-t from a multiple of pi/4
    of_axis = code.select(steep, code.constant(2.0), _either(code, left, 4.0, 0.0))
    eighths = code.select(turned, _either(code, left, 3.0, 1.0), of_axis)
    backwards = code.logical("xor", steep, left)
    towards = code.select(backwards, code.negate(t), t)
    # what pi/4 lacks is at most a third of the last place
    whole = code.multiply_add(eighths, code.constant(math.pi / 4.0), towards)
    return code.intrinsic("copysign", whole, y)


def _slope(code: Code, least: Value, most: Value, turned: Value) -> Value:
    """The slope of the vector, turned back by pi/4 or not, at most 4/7 either way; 0 of two zeros; NaN stays."""
    zero, tiny = code.constant(0.0), code.constant(SMALLEST)
    back = code.subtract(least, most)
    # the difference of infinite ones counts as zero
    back = code.select(code.compare("olt", back, zero), back, zero)
    across = code.select(turned, back, least)
    along = code.select(turned, code.add(most, least), most)
    along = code.select(code.compare("ogt", tiny, along), tiny, along)
    return code.divide(across, along)


def _either(code: Code, condition: Value, a: float, b: float) -> Value:
    return code.select(condition, code.constant(a), code.constant(b))


def _is_negative(code: Code, x: Value) -> Value:
    """Whether the sign of a number is set, that of a zero included."""
    return code.block.put(f"icmp slt {code.vector.whole} {code.bits_of(x)}, {code.vector.whole_constant(0)}")


def _arctangent(code: Code, x: Value) -> Value:
    """Arctangent on [-4/7, 4/7]."""
    z = code.multiply(x, x)
    return code.multiply_add(code.multiply(x, z), code.polynomial_in_halves(ARCTANGENT, z), x)
