"""Expression nodes: formulas run over them leave behind what they compute.

A node is an operation with its arguments. Equal expressions are one node (hash-consing), so what a formula
computes twice is computed once. Rules that rewrite an expression keep every bit of its IEEE value, signed
zeros, infinities and NaN included, because statuses hang on the sign of radicands: nothing is reassociated,
x*0 and x-x stay (x may be infinite), x+0 stays (x may be -0), and of constants only operations that are
rounded correctly are carried out beforehand.
"""

from __future__ import annotations

import hashlib
import math
import operator
import struct
import threading
import weakref
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from centrode.numerics.operations import CONSTANT, DERIVED, OPERATIONS, VARIABLE

# Operations on constants as the machine does them: quotients by zero and roots below zero are no errors.

NAN = math.nan


def ieee_quotient(a: float, b: float) -> float:
    """Quotient by IEEE 754: infinite by zero, NaN for 0/0."""
    if b != 0.0:
        return a / b
    # only NaN differs from itself; of zero by zero and of NaN by zero there is no value
    if a == 0.0 or a != a or b != b:
        return NAN
    # copysign sees the sign of a zero, which a comparison does not: 1 / -0 is -infinity
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def square_root(x: float) -> float:
    """Square root, rounded correctly; NaN below zero."""
    return math.sqrt(x) if x >= 0.0 or x != x else NAN


def minimum(a: float, b: float) -> float:
    """The lesser of two numbers; NaN if one of them is."""
    # comparisons with NaN are false: a NaN in b comes out by itself, one in a has to be looked for
    return a if a < b or a != a else b


def maximum(a: float, b: float) -> float:
    """The greater of two numbers; NaN if one of them is."""
    return a if a > b or a != a else b


def least(a: float, b: float) -> float:
    """The lesser of two numbers; the other one if one is NaN."""
    # as in `minimum`, but here a NaN in b has to be looked for, and a NaN in a loses by itself
    return a if a < b or b != b else b


def greatest(a: float, b: float) -> float:
    """The greater of two numbers; the other one if one is NaN."""
    return a if a > b or b != b else b


FOLDED: Mapping[str, Callable[..., float]] = {
    "add": operator.add,
    "subtract": operator.sub,
    "multiply": operator.mul,
    "divide": ieee_quotient,
    "negate": operator.neg,
    "abs": abs,
    "sqrt": square_root,
    "minimum": minimum,
    "maximum": maximum,
    "least": least,
    "greatest": greatest,
}
"""Operations that are rounded correctly everywhere: their value does not depend on who computes it, or when."""


def exact_reciprocal(x: float) -> float | None:
    """1/x if x is a power of two, so that multiplying by it is the same as dividing by x."""
    mantissa, exponent = math.frexp(x)
    # the reciprocals of the outermost powers are subnormal or infinite
    return 1.0 / x if abs(mantissa) == 0.5 and -1020 < exponent < 1020 else None


class Node:
    """An expression: variable, constant, or an operation on other nodes.

    Attributes
    ----------
    operation : name in `OPERATIONS`, "variable" or "constant"
    arguments : the nodes it acts on
    detail : name of a variable, value of a constant
    key : digest of the whole expression, the same in every process; arguments that commute count in any order
    """

    __slots__ = ("__weakref__", "arguments", "detail", "key", "operation")
    __array_ufunc__ = None  # NumPy's scalars leave operators to the node

    operation: str
    arguments: tuple[Node, ...]
    detail: str | float
    key: bytes

    def __repr__(self) -> str:
        inside = self.detail if not self.arguments else f"{len(self.arguments)} arguments"
        return f"<{self.operation}: {inside}>"

    def __bool__(self) -> bool:
        raise TypeError("a traced formula cannot branch on a value: select with where")

    @property
    def is_condition(self) -> bool:
        """Whether the node stands for a truth value."""
        return self.operation in OPERATIONS and OPERATIONS[self.operation].condition

    def __add__(self, other: Any) -> Node:
        return _build_operation("add", self, other)

    def __radd__(self, other: Any) -> Node:
        return _build_operation("add", other, self)

    def __sub__(self, other: Any) -> Node:
        return _build_operation("subtract", self, other)

    def __rsub__(self, other: Any) -> Node:
        return _build_operation("subtract", other, self)

    def __mul__(self, other: Any) -> Node:
        return _build_operation("multiply", self, other)

    def __rmul__(self, other: Any) -> Node:
        return _build_operation("multiply", other, self)

    def __truediv__(self, other: Any) -> Node:
        return _build_operation("divide", self, other)

    def __rtruediv__(self, other: Any) -> Node:
        return _build_operation("divide", other, self)

    def __pow__(self, other: Any) -> Node:
        return _build_operation("power", self, other)

    def __lt__(self, other: Any) -> Node:
        return _build_operation("less", self, other)

    def __le__(self, other: Any) -> Node:
        return _build_operation("less_equal", self, other)

    def __gt__(self, other: Any) -> Node:
        return _build_operation("less", other, self)

    def __ge__(self, other: Any) -> Node:
        return _build_operation("less_equal", other, self)

    def __neg__(self) -> Node:
        return apply_operation("negate", self)

    def __pos__(self) -> Node:
        return self

    def __abs__(self) -> Node:
        return apply_operation("abs", self)

    def __array_namespace__(self) -> Expressions:
        """The functions of nodes, for formulas that ask numbers whose they are (`operations.PLAIN`)."""
        return EXPRESSIONS


Operand: TypeAlias = Node | float

# weak: an expression is forgotten with the last formula that holds it. Locked: nodes are compared by
# identity, so two threads that build the same expression have to get the same node
_known: weakref.WeakValueDictionary[bytes, Node] = weakref.WeakValueDictionary()
_one_at_a_time = threading.Lock()


def variable(name: str) -> Node:
    """The variable of a name; the same name is the same node."""
    return _node(VARIABLE, (), name)


def constant(value: float) -> Node:
    """A number as a node."""
    return _node(CONSTANT, (), float(value))


def as_node(x: Operand) -> Node:
    """A node, or a plain number as a constant."""
    return x if isinstance(x, Node) else constant(x)


def apply_operation(operation: str, *arguments: Operand) -> Node:
    """The node of an operation on arguments, rewritten where a simpler expression has the same bits."""
    nodes = tuple(as_node(x) for x in arguments)
    _check_kinds(operation, nodes)
    simpler = _rewritten(operation, nodes)
    return _node(operation, nodes, "") if simpler is None else simpler


def _build_operation(operation: str, a: Any, b: Any) -> Node:
    # what is neither node nor number (a jet, say) has operators of its own
    if isinstance(a, (Node, float, int)) and isinstance(b, (Node, float, int)):
        return apply_operation(operation, a, b)
    return NotImplemented  # type: ignore[no-any-return]


def _node(operation: str, arguments: tuple[Node, ...], detail: str | float) -> Node:
    """The one node of an expression."""
    key = _key(operation, arguments, detail)
    with _one_at_a_time:
        node = _known.get(key)
        if node is None:
            node = Node()
            node.operation, node.arguments, node.detail, node.key = operation, arguments, detail, key
            _known[key] = node
    return node


def _key(operation: str, arguments: tuple[Node, ...], detail: str | float) -> bytes:
    keys = [x.key for x in arguments]
    # a + b and b + a have the same bits, so they may be one node; products too
    if operation in OPERATIONS and OPERATIONS[operation].commutes:
        keys.sort()
    # bits of a fixed byte order, not the value: 0 and -0 are two constants, and other machines get the same
    # key
    own = detail.encode() if isinstance(detail, str) else struct.pack("<d", detail)
    return hashlib.blake2b(b"\0".join([operation.encode(), own]) + b"".join(keys), digest_size=16).digest()


def _check_kinds(operation: str, nodes: tuple[Node, ...]) -> None:
    expected = OPERATIONS[operation]
    if len(nodes) != expected.arguments:
        raise TypeError(f"{operation} takes {expected.arguments} arguments, got {len(nodes)}")
    for i, node in enumerate(nodes):
        condition = expected.of_conditions or (operation == "where" and i == 0)
        if node.is_condition is not condition:
            raise TypeError(
                f"{operation} takes a {'condition' if condition else 'number'} as argument {i + 1}"
            )


def _rewritten(operation: str, nodes: tuple[Node, ...]) -> Node | None:
    """A simpler node of the same value to the last bit, if a rule gives one."""
    # only what IEEE 754 rounds correctly: sin(2) stays an operation, or its bits would be those of the
    # library at hand
    if operation in FOLDED and all(x.operation == CONSTANT for x in nodes):
        return constant(FOLDED[operation](*(x.detail for x in nodes)))
    rule = _RULES.get(operation)
    simpler: Node | None = rule(*nodes) if rule else None
    return simpler


def _opposite_of(x: Node) -> Node | None:
    """The expression that x is the opposite of."""
    return x.arguments[0] if x.operation == "negate" else None


def _is(x: Node, value: float) -> bool:
    # bits again: rules for 0 do not hold for -0
    return x.operation == CONSTANT and struct.pack("<d", x.detail) == struct.pack("<d", value)


def _add(a: Node, b: Node) -> Node | None:
    # -0 + x is x whatever x is; 0 + x is not, as 0 + (-0) is 0
    if _is(a, -0.0) or _is(b, -0.0):
        return b if _is(a, -0.0) else a
    # IEEE 754 defines a - b as a + (-b), so these keep every bit
    if (y := _opposite_of(b)) is not None:
        return apply_operation("subtract", a, y)
    if (x := _opposite_of(a)) is not None:
        return apply_operation("subtract", b, x)
    return None


def _subtract(a: Node, b: Node) -> Node | None:
    # x - 0 is x also for x = -0; x - (-0) is not, and stays
    if _is(b, 0.0):
        return a
    # -0 - b is -b for both zeros; 0 - b is not, as 0 - 0 is 0
    if _is(a, -0.0):
        return apply_operation("negate", b)
    # doubling is exact, so this rounds once, as -b - b does
    if _opposite_of(a) is b:
        return apply_operation("multiply", -2.0, b)
    y = _opposite_of(b)
    return None if y is None else apply_operation("add", a, y)


def _multiply(a: Node, b: Node) -> Node | None:
    for factor, other in ((a, b), (b, a)):
        if _is(factor, 1.0):
            return other
        if _is(factor, -1.0):
            return apply_operation("negate", other)
        # signs go outside, so that products which differ by a sign alone share the node of the product
        if (x := _opposite_of(factor)) is not None:
            return apply_operation("negate", apply_operation("multiply", x, other))
    return None


def _divide(a: Node, b: Node) -> Node | None:
    if (x := _opposite_of(a)) is not None:
        return apply_operation("negate", apply_operation("divide", x, b))
    if (y := _opposite_of(b)) is not None:
        return apply_operation("negate", apply_operation("divide", a, y))
    # both are rounded once from the same exact value if the reciprocal is exact
    if b.operation == CONSTANT:
        reciprocal = exact_reciprocal(float(b.detail))
        return None if reciprocal is None else apply_operation("multiply", a, reciprocal)
    return None


def _abs(x: Node) -> Node | None:
    if x.operation == "abs":
        return x
    y = _opposite_of(x)
    return None if y is None else apply_operation("abs", y)


def _sin(x: Node) -> Node | None:
    y = _opposite_of(x)
    return None if y is None else apply_operation("negate", apply_operation("sin", y))


def _cos(x: Node) -> Node | None:
    y = _opposite_of(x)
    return None if y is None else apply_operation("cos", y)


def _extreme(a: Node, b: Node) -> Node | None:
    return a if a is b else None


def _opposite(x: Node) -> Node | None:
    return x.arguments[0] if x.operation == "opposite" else None


def _where(condition: Node, a: Node, b: Node) -> Node | None:
    if a is b:
        return a
    if condition.operation == "opposite":
        return apply_operation("where", condition.arguments[0], b, a)
    return None


_RULES: dict[str, Any] = {
    "add": _add,
    "subtract": _subtract,
    "multiply": _multiply,
    "divide": _divide,
    "negate": _opposite_of,
    "abs": _abs,
    "sin": _sin,
    "cos": _cos,
    "minimum": _extreme,
    "maximum": _extreme,
    "least": _extreme,
    "greatest": _extreme,
    "both": _extreme,
    "either": _extreme,
    "opposite": _opposite,
    "where": _where,
}


# The functions formulas need, on expression nodes: the namespace that traces.

Number: TypeAlias = Any


class Expressions:
    """Namespace `m` of nodes. Plain numbers pass through to plain numbers, so jets keep their literal zeros."""

    def asarray(self, x: Operand) -> Operand:
        """A node or number as it is: what formulas call that make arrays of numbers first."""
        return x

    def sqrt(self, x: Operand) -> Operand:
        return apply_operation("sqrt", x) if isinstance(x, Node) else square_root(x)

    def sin(self, x: Operand) -> Operand:
        return apply_operation("sin", x) if isinstance(x, Node) else math.sin(x)

    def cos(self, x: Operand) -> Operand:
        return apply_operation("cos", x) if isinstance(x, Node) else math.cos(x)

    def atan2(self, y: Operand, x: Operand) -> Operand:
        return apply_operation("atan2", y, x) if _any_node(y, x) else math.atan2(_plain(y), _plain(x))

    def exp(self, x: Operand) -> Operand:
        return apply_operation("exp", x) if isinstance(x, Node) else math.exp(x)

    def log(self, x: Operand) -> Operand:
        return apply_operation("log", x) if isinstance(x, Node) else math.log(x)

    def tan(self, x: Operand) -> Number:
        return DERIVED["tan"](self, x)

    def asin(self, x: Operand) -> Number:
        return DERIVED["asin"](self, x)

    def acos(self, x: Operand) -> Number:
        return DERIVED["acos"](self, x)

    def atan(self, x: Operand) -> Number:
        return DERIVED["atan"](self, x)

    def abs(self, x: Operand) -> Operand:
        return apply_operation("abs", x) if isinstance(x, Node) else math.fabs(x)

    def sign(self, x: Operand) -> Number:
        # zeros and NaN stay what they are
        return self.where(self.less(0.0, x), 1.0, self.where(self.less(x, 0.0), -1.0, x))

    def min(self, x: Operand, y: Operand) -> Operand:
        return apply_operation("minimum", x, y)

    def max(self, x: Operand, y: Operand) -> Operand:
        return apply_operation("maximum", x, y)

    def least(self, x: Operand, y: Operand) -> Operand:
        return apply_operation("least", x, y)

    def greatest(self, x: Operand, y: Operand) -> Operand:
        return apply_operation("greatest", x, y)

    def is_number(self, x: Operand) -> Node:
        return apply_operation("equal", x, x)

    def less(self, x: Operand, y: Operand) -> Node:
        return apply_operation("less", x, y)

    def less_equal(self, x: Operand, y: Operand) -> Node:
        return apply_operation("less_equal", x, y)

    def equal(self, x: Operand, y: Operand) -> Node:
        return apply_operation("equal", x, y)

    def not_equal(self, x: Operand, y: Operand) -> Node:
        return apply_operation("not_equal", x, y)

    def both(self, p: Node, q: Node) -> Node:
        return apply_operation("both", p, q)

    def either(self, p: Node, q: Node) -> Node:
        return apply_operation("either", p, q)

    def opposite(self, p: Node) -> Node:
        return apply_operation("opposite", p)

    def where(self, condition: Node, x: Operand, y: Operand) -> Node:
        return apply_operation("where", condition, x, y)


def _any_node(*operands: Operand) -> bool:
    return any(isinstance(x, Node) for x in operands)


def _plain(x: Operand) -> float:
    assert not isinstance(x, Node)
    return x


EXPRESSIONS = Expressions()
