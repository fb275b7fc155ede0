"""Operations of a graph as operations of LLVM's language."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from centrode.numerics.expressions import Node
from centrode.numerics.machine_code.language import FUNCTIONS, Code, Value, by_library, by_library_where
from centrode.numerics.machine_code.polynomials import (
    ARCTANGENT,
    COSINE,
    QUARTER_TURN,
    QUARTER_TURN_SHORT,
    SINE,
    SLOPE,
)
from centrode.numerics.operations import CONSTANT

# Sine, cosine and the angle of a vector on vectors of doubles: the greatest errors stand in docs/engine.md.
#
# The argument is brought to |r| <= pi/4 by Cody and Waite's reduction: r = x - k pi/2 with pi/2 in several
# parts, kept as r + low. Beyond `REDUCED` the C library is called, lane by lane.

REDUCED = 1e5
"""Greatest magnitude that is reduced here: k stays below 2^17, so that its products with parts are exact."""
ROUNDER = 1.5 * 2.0**52
"""Adding it rounds to a whole number, which then stands in the lowest bits."""
SIGN_OF_DOUBLE = 63
SMALLEST = 5e-324


def sine_and_cosine(code: Code, x: Value) -> tuple[Value, Value]:
    """Sine and cosine of x; below 1 ULP from the true value for |x| <= 1e5, the C library's beyond."""
    # beside 2^52 the last place is worth 1: the sum is rounded to a whole number of quarter turns, ties to
    # even, and the same number stands in its lowest bits
    turns = code.add(code.multiply(x, code.constant(2.0 / math.pi)), code.constant(ROUNDER))
    k = code.subtract(turns, code.constant(ROUNDER))
    r, low = _reduced_by_fma(code, x, k) if code.has_fma else _reduce_by_short_parts(code, x, k)
    sine, cosine = _sine(code, r, low), _cosine(code, r, low)
    quarter = code.bits_of(turns)
    odd = _is_odd(code, quarter)
    near = (
        _flip_sign(code, code.select(odd, cosine, sine), quarter),
        # cos x = sin(x + quarter turn): one quarter further
        _flip_sign(code, code.select(odd, sine, cosine), code.whole("add", quarter, 1)),
    )
    # r of -0 comes out of the sums as +0 a zero keeps its sign
    at_zero = code.compare("oeq", x, code.constant(0.0))
    near = code.select(at_zero, x, near[0]), near[1]
    # k would need more bits than a product with the first part has left
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


def _reduce_by_short_parts(code: Code, x: Value, k: Value) -> tuple[Value, Value]:
    """The rest x - k pi/2 as a sum of two, without FMA: parts of pi/2 so short that products with k are exact."""
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


def _flip_sign(code: Code, value: Value, quarter: Value) -> Value:
    """The value, with the other sign in the third and the fourth quarter."""
    sign = code.whole("shl", code.whole("and", quarter, 2), SIGN_OF_DOUBLE - 1)
    return code.from_bits(code.block.put(f"xor {code.vector.whole} {code.bits_of(value)}, {sign}"))


def angle(code: Code, y: Value, x: Value) -> Value:
    """The angle of (x, y) in [-pi, pi]; below 2 ULP from the true value, zeros and infinities by C's rules.

    The sum of x and y must not be beyond all numbers: up to 8e307 they may be anything.
    """
    ax, ay = code.intrinsic("fabs", x), code.intrinsic("fabs", y)
    steep = code.compare("ogt", ay, ax)
    # of the two the lesser over the greater: the quotient is at most 1 and nothing overflows
    least, most = code.select(steep, ax, ay), code.select(steep, ay, ax)
    # a steeper vector is turned back by pi/4, and one that is infinite both ways
    # least > most SLOPE, written with the difference: of two infinite ones that is NaN, and with `ugt` they
    # are turned
    bound = code.multiply(code.subtract(most, least), code.constant(SLOPE / (1.0 - SLOPE)))
    turned = code.compare("ugt", least, bound)
    t = _arctangent(code, _slope(code, least, most, turned))
    left = _is_negative(code, x)
    # in the upper half plane the angle is +-t from a multiple of pi/4 multiples of a quarter of pi from which
    # t counts: 4 or 0 on the axis of x, 2 on that of y, 3 and 1 between
    of_axis = code.select(steep, code.constant(2.0), _either(code, left, 4.0, 0.0))
    eighths = code.select(turned, _either(code, left, 3.0, 1.0), of_axis)
    backwards = code.logical("xor", steep, left)
    towards = code.select(backwards, code.negate(t), t)
    # what pi/4 lacks is at most a third of the last place
    whole = code.multiply_add(eighths, code.constant(math.pi / 4.0), towards)
    # with the sign of y, that of a zero too: C's rule for the lower half plane
    return code.intrinsic("copysign", whole, y)


def _slope(code: Code, least: Value, most: Value, turned: Value) -> Value:
    """The slope of the vector, turned back by pi/4 or not, at most 4/7 either way; 0 of two zeros; NaN stays."""
    zero, tiny = code.constant(0.0), code.constant(SMALLEST)
    back = code.subtract(least, most)
    # the difference of infinite ones counts as zero
    back = code.select(code.compare("olt", back, zero), back, zero)
    # across / along is tan(t - pi/4) = (least - most) / (most + least) where the vector is turned back
    across = code.select(turned, back, least)
    along = code.select(turned, code.add(most, least), most)
    # 0 / 0 would be NaN: of two zeros the slope is 0. The least number changes no other quotient, and NaN
    # stays, being no less than it
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


ARITHMETIC = {"add": "fadd", "subtract": "fsub", "multiply": "fmul", "divide": "fdiv"}
COMPARISONS = {"less": "olt", "less_equal": "ole", "equal": "oeq", "not_equal": "une"}
# bit 1 of k says third or fourth quarter; moved to the sign's place it flips the sign by one `xor`
LOGIC = {"both": "and", "either": "or"}
MAY_FUSE = "contract "


class Operating:
    """Computes nodes of a graph into a block; what is computed once is kept.

    Parameters
    ----------
    code : where to
    fused : nodes of which a product and the sum behind it may be rounded once
    """

    def __init__(self, code: Code, fused: frozenset[Node]) -> None:
        self.code = code
        self.fused = fused
        self.values: dict[Node, Value] = {}
        self._turned: dict[Node, tuple[Value, Value]] = {}

    def with_values(self, values: Mapping[Node, Value]) -> Operating:
        """Another that knows these values only: those of one loop are not there in the next."""
        other = Operating(self.code, self.fused)
        other.values.update(values)
        return other

    def value(self, node: Node) -> Value:
        """The value of a node that is computed, or of a constant."""
        if node.operation == CONSTANT:
            return self.code.constant(float(node.detail))
        return self.values[node]

    def compute(self, node: Node) -> None:
        """Add the value of a node whose arguments have been computed."""
        if node.arguments:
            self.values[node] = self._compute(node, [self.value(x) for x in node.arguments])

    def extreme(self, operation: str, a: Value, b: Value) -> Value:
        """The lesser ("minimum") or greater ("maximum") of two values."""
        return _OTHERS[operation](self.code, a, b)

    def _compute(self, node: Node, arguments: list[Value]) -> Value:
        operation, code = node.operation, self.code
        if operation in ARITHMETIC:
            a, b = arguments
            return code.binary(ARITHMETIC[operation], a, b, MAY_FUSE if node in self.fused else "")
        if operation in COMPARISONS:
            return code.compare(COMPARISONS[operation], *arguments)
        if operation in LOGIC:
            return code.logical(LOGIC[operation], *arguments)
        if operation in ("sin", "cos"):
            return self._of_angle(node.arguments[0])[operation == "cos"]
        if operation in FUNCTIONS or operation == "atan2":
            return self._in_doubles(operation, arguments)
        return _OTHERS[operation](code, *arguments)

    def _of_angle(self, node: Node) -> tuple[Value, Value]:
        """Sine and cosine of a node, together: most of their cost is common."""
        if node not in self._turned:
            x = self._widen(self.value(node))
            sine, cosine = sine_and_cosine(self.code.of_doubles(), x)
            # the pair is kept: a formula that takes the sine of an angle takes its cosine too
            self._turned[node] = self._narrow(sine), self._narrow(cosine)
        return self._turned[node]

    def _in_doubles(self, operation: str, arguments: list[Value]) -> Value:
        code, wide = self.code.of_doubles(), [self._widen(x) for x in arguments]
        if operation == "atan2":
            return self._narrow(angle(code, *wide))
        return self._narrow(by_library(code, FUNCTIONS[operation], *wide))

    def _widen(self, x: Value) -> Value:
        """Functions are computed in doubles, whatever the kernel's numbers are."""
        code = self.code
        if code.vector.number == "double":
            return x
        return code.block.put(f"fpext {code.vector.name} {x} to {code.of_doubles().vector.name}")

    def _narrow(self, x: Value) -> Value:
        code = self.code
        if code.vector.number == "double":
            return x
        return code.block.put(f"fptrunc {code.of_doubles().vector.name} {x} to {code.vector.name}")


def _extreme(predicate: str, nan_wins: bool) -> Callable[[Code, Value, Value], Value]:
    """The first if it is less (greater), else the second, and what becomes of NaN."""

    def extreme(code: Code, a: Value, b: Value) -> Value:
        # this selection is one instruction; it gives the second where one is NaN
        further = code.select(code.compare(predicate, a, b), a, b)
        asked = a if nan_wins else b
        return code.select(code.compare("uno", asked, asked), a, further)

    return extreme


def _opposite(code: Code, p: Value) -> Value:
    return code.logical("xor", p, "<" + ", ".join(["i1 true"] * code.vector.width) + ">")


_OTHERS: Mapping[str, Callable[..., Value]] = {
    "negate": lambda code, x: code.negate(x),
    "sqrt": lambda code, x: code.intrinsic("sqrt", x),
    "abs": lambda code, x: code.intrinsic("fabs", x),
    "minimum": _extreme("olt", nan_wins=True),
    "maximum": _extreme("ogt", nan_wins=True),
    "least": _extreme("olt", nan_wins=False),
    "greatest": _extreme("ogt", nan_wins=False),
    "opposite": _opposite,
    "where": lambda code, condition, a, b: code.select(condition, a, b),
}
