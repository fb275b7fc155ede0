"""Operations of a graph as operations of LLVM's language."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from centrode.algebra.expressions import Node
from centrode.algebra.machine_code.language import Code, Value
from centrode.algebra.machine_code.library import FUNCTIONS, by_library
from centrode.algebra.machine_code.trigonometry import angle, sine_and_cosine
from centrode.algebra.operations import CONSTANT

ARITHMETIC = {"add": "fadd", "subtract": "fsub", "multiply": "fmul", "divide": "fdiv"}
COMPARISONS = {"less": "olt", "less_equal": "ole", "equal": "oeq", "not_equal": "une"}
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
            self.values[node] = self._computed(node, [self.value(x) for x in node.arguments])

    def _computed(self, node: Node, arguments: list[Value]) -> Value:
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
            x = self._widened(self.value(node))
            sine, cosine = sine_and_cosine(self.code.of_doubles(), x)
            self._turned[node] = self._narrowed(sine), self._narrowed(cosine)
        return self._turned[node]

    def _in_doubles(self, operation: str, arguments: list[Value]) -> Value:
        code, wide = self.code.of_doubles(), [self._widened(x) for x in arguments]
        if operation == "atan2":
            return self._narrowed(angle(code, *wide))
        return self._narrowed(by_library(code, FUNCTIONS[operation], *wide))

    def _widened(self, x: Value) -> Value:
        """Functions are computed in doubles, whatever the kernel's numbers are."""
        code = self.code
        if code.vector.number == "double":
            return x
        return code.block.put(f"fpext {code.vector.name} {x} to {code.of_doubles().vector.name}")

    def _narrowed(self, x: Value) -> Value:
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
