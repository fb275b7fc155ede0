"""Languages in which straight-line formulas and plain functions are printed: C, Python, MATLAB and JavaScript.

All write operations by the one table of operations. A language says what it writes otherwise, how a statement
looks, and how numbers of a record are reached; records are handed over as `m`. MATLAB hands over values, so a
function there gives its record back.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from centrode.numerics.expressions import Node
from centrode.numerics.graphs import ALONE, Notation, Text, is_worth_a_line, topological_order
from centrode.numerics.javascript import HELPERS, JAVASCRIPT
from centrode.numerics.operations import CONSTANT, OPERATIONS, VARIABLE

REAL, WHOLE = "double", "int"
"""Kinds of numbers of plain functions, as C calls them."""


@dataclass(frozen=True)
class Language:
    """How a language writes programs of numbers.

    Attributes
    ----------
    name : as users call it
    suffix : of its files
    notation : how it writes operations
    plain : floor, int and what else plain functions call beside the operations -> pattern with the argument
    element : pattern of a number of the record's array: array, index
    first : index of the first number of an array
    scalar : pattern of a number of the record
    constant : pattern of a line that names a value: name, value
    line_end : of a statement
    comment : what a comment begins with
    blocks : patterns of what opens `if`, `elif`, `else`, `while` and `for`, and of what closes all of them
    helpers : what printed formulas call, in the language itself
    """

    name: str
    suffix: str
    notation: Notation
    plain: Mapping[str, str]
    element: str
    first: int
    scalar: str
    constant: str
    line_end: str
    comment: str
    blocks: Mapping[str, str]
    helpers: str
    declares: bool = False
    gives_record_back: bool = field(default=False)

    def element_text(self, array: str, index: str) -> str:
        """A number of an array of the record; `index` counts from 0."""
        if self.first:
            index = str(int(index) + 1) if index.isdigit() else f"{index} + 1"
        return self.element.format(array, index)

    def scalar_text(self, name: str) -> str:
        """A number of the record."""
        return self.scalar.format(name)

    def block(self, word: str, *parts: str) -> str:
        """What opens a block."""
        return self.blocks[word].format(*parts)

    def indented_lines(self, lines: Sequence[str], depth: int = 1) -> list[str]:
        """Lines of a block."""
        return ["    " * depth + line if line else line for line in lines]

    def function(
        self, name: str, parameters: Sequence[tuple[str, str]], gives: str, body: Sequence[str]
    ) -> list[str]:
        """A function of the record and of numbers (name, kind); `gives` is the kind of what it returns, or empty."""
        names = [parameter for parameter, _kind in parameters]
        if self.gives_record_back:
            back = "[m, value]" if gives else "m"
            return [
                f"function {back} = {name}({', '.join(['m', *names])})",
                *self.indented_lines(body),
                "end",
                "",
            ]
        if self.declares:
            kinds = [f"{kind} {parameter}" for parameter, kind in parameters]
            words = frozenset(re.findall(r"\w+", " ".join(body)))
            body = [f"(void){each};" for each in ("m", *names) if each not in words] + list(body)
            head = f"static {gives or 'void'} {name}({', '.join(['record *m', *kinds])}) {{"
            return [head, *self.indented_lines(body), "}", ""]
        if self.blocks["end"]:
            return [f"function {name}({', '.join(['m', *names])}) {{", *self.indented_lines(body), "}", ""]
        return [f"def {name}({', '.join(['m', *names])}):", *self.indented_lines(body or ["pass"]), "", ""]

    def return_lines(self, value: str) -> list[str]:
        """Lines that end a function with a value, or with none."""
        if self.gives_record_back:
            return [f"value = {value};", "return"] if value else ["return"]
        return [f"return {value}{self.line_end}"] if value else [f"return{self.line_end}"]

    def call_lines(self, function: str, arguments: Sequence[str], target: str, gives: bool) -> str:
        """A statement that calls a function with the record; what it gives goes to `target`, or nowhere."""
        call = f"{function}({', '.join(['m', *arguments])})"
        if self.gives_record_back:
            back = f"[m, {target or '~'}]" if gives else "m"
            return f"{back} = {call};"
        return f"{target} = {call}{self.line_end}" if target else f"{call}{self.line_end}"


def _number_text(x: float, infinite: str, none: str) -> Text:
    if math.isfinite(x):
        # whole numbers too have a point: a quotient of two is none of whole numbers
        text = repr(float(x))
        return text, ALONE if text[0].isdigit() else OPERATIONS["negate"].strength
    if math.isnan(x):
        return none, ALONE
    return (infinite, ALONE) if x > 0.0 else (f"-{infinite}", OPERATIONS["negate"].strength)


SAME = {name: name for name in ("sin", "cos", "atan2", "exp")}
ORDER = {name: name for name in ("minimum", "maximum", "least", "greatest")}
"""Functions that every language has under these names, and those that are helpers of it."""
BRACES = {
    "if": "if ({}) {{", "elif": "}} else if ({}) {{", "else": "}} else {{", "while": "while ({}) {{",
    "for": "for ({0} = {1}; {0} < {2}; {0}++) {{", "end": "}",
}  # fmt: skip

C = Notation(
    {**SAME, **ORDER, "sqrt": "sqrt", "abs": "fabs", "log": "log", "power": "pow", "opposite": "!"},
    lambda x: _number_text(x, "INFINITY", "NAN"),
    {"both": "&&", "either": "||"},
    "({} ? {} : {})",
)
C_HELPERS = """/* Of two numbers one of which is none the first two give none, the others the other one. */
static inline double minimum(double a, double b) { return a < b || a != a ? a : b; }
static inline double maximum(double a, double b) { return a > b || a != a ? a : b; }
static inline double least(double a, double b) { return a < b || b != b ? a : b; }
static inline double greatest(double a, double b) { return a > b || b != b ? a : b; }
"""

PYTHON = Notation(
    {**{name: name for name in ("sin", "cos", "exp", "log")}, **ORDER, "atan2": "math.atan2", "sqrt": "sqrt",
     "abs": "abs", "power": "power", "divide": "quotient"},
    lambda x: _number_text(x, "math.inf", "math.nan"),
    {},
    "({1} if {0} else {2})",
)  # fmt: skip
PYTHON_HELPERS = '''def quotient(a, b):
    """a / b as processors divide: no error where b is zero."""
    if b:
        return a / b
    return math.nan if not a else math.copysign(math.inf, a) * math.copysign(1.0, b)


def guarded(function):
    """A function that gives no number where it would raise an error."""

    def call(*arguments):
        try:
            return function(*arguments)
        except (ArithmeticError, ValueError):
            return math.nan

    return call


sin, cos, exp, log, power = map(guarded, (math.sin, math.cos, math.exp, math.log, math.pow))


def sqrt(x):
    return math.sqrt(x) if x >= 0.0 else math.nan


def floor(x):
    return math.floor(x) if math.isfinite(x) else x


# Of two numbers one of which is none the first two give none, the others the other one.


def minimum(a, b):
    return a if a < b or a != a else b


def maximum(a, b):
    return a if a > b or a != a else b


def least(a, b):
    return a if a < b or b != b else b


def greatest(a, b):
    return a if a > b or b != b else b
'''

MATLAB = Notation(
    {**SAME, **ORDER, "sqrt": "root", "abs": "abs", "log": "logarithm", "power": "real_power", "opposite": "not",
     "where": "choose"},
    lambda x: _number_text(x, "Inf", "NaN"),
    {"not_equal": "~=", "both": "&&", "either": "||"},
)  # fmt: skip
MATLAB_HELPERS = """function y = choose(condition, a, b)
    if condition
        y = a;
    else
        y = b;
    end
end

function y = root(x)
    if x >= 0
        y = sqrt(x);
    else
        y = NaN;
    end
end

function y = logarithm(x)
    if x >= 0
        y = log(x);
    else
        y = NaN;
    end
end

function y = real_power(a, b)
    y = a ^ b;
    if ~isreal(y)
        y = NaN;
    end
end

% Of two numbers one of which is none the first two give none, the others the other one.
function y = minimum(a, b)
    y = choose(a < b || a ~= a, a, b);
end

function y = maximum(a, b)
    y = choose(a > b || a ~= a, a, b);
end

function y = least(a, b)
    y = choose(a < b || b ~= b, a, b);
end

function y = greatest(a, b)
    y = choose(a > b || b ~= b, a, b);
end
"""

LANGUAGES: Mapping[str, Language] = {
    "c": Language(
        "C", ".c", C, {"floor": "floor({})", "int": "(int)({})"}, "m->{}[{}]", 0, "m->{}", "const double {} = {};",
        ";", "//", BRACES, C_HELPERS, declares=True,
    ),
    "python": Language(
        "Python", ".py", PYTHON, {"floor": "floor({})", "int": "int({})"}, "m.{}[{}]", 0, "m.{}", "{} = {}",
        "", "#",
        {"if": "if {}:", "elif": "elif {}:", "else": "else:", "while": "while {}:", "for": "for {} in range({}, {}):",
         "end": ""},
        PYTHON_HELPERS,
    ),
    "matlab": Language(
        "MATLAB", ".m", MATLAB, {"floor": "floor({})", "int": "{}"}, "m.{}({})", 1, "m.{}", "{} = {};",
        ";", "%",
        {"if": "if {}", "elif": "elseif {}", "else": "else", "while": "while {}", "for": "for {} = ({}):({} - 1)",
         "end": "end"},
        MATLAB_HELPERS, gives_record_back=True,
    ),
    "javascript": Language(
        "JavaScript", ".js", JAVASCRIPT, {"floor": "Math.floor({})", "int": "{}"}, "m.{}[{}]", 0, "m.{}",
        "const {} = {};", ";", "//", BRACES | {"for": "for (let {0} = {1}; {0} < {2}; {0}++) {{"}, HELPERS,
    ),
}  # fmt: skip

HELPER_NAMES = frozenset(
    name for each in LANGUAGES.values() for name in re.findall(r"\b[a-z]\w+(?= ?[=(])", each.helpers)
)
"""Names of what printed formulas call."""


# Graphs as functions of a record.


@dataclass(frozen=True)
class RecordFunction:
    """A graph as a function that reads numbers of a record and writes its outputs into an array of it.

    Attributes
    ----------
    name : of the function
    array : that takes the outputs
    variables : variable -> (array, index), or (name of a number, None)
    outputs : in the order of the array
    stage : number of outputs of a stage, behind which a call may end; 0: the function has no stages
    """

    name: str
    array: str
    variables: Mapping[str, tuple[str, int | None]]
    outputs: Sequence[Node]
    stage: int = 0

    def lines(self, language: Language) -> list[str]:
        """The function in a language. Raises Unwritten for an operation that the language has no words for."""
        parameters = [("last", WHOLE)] if self.stage else []
        return language.function(self.name, parameters, "", self._body(language))

    def _body(self, language: Language) -> list[str]:
        order = topological_order(self.outputs)
        uses = Counter(x for node in order for x in node.arguments)
        ends, texts = frozenset(self.outputs), dict[Node, Text]()
        lines: list[str] = []
        step = self.stage or max(1, len(self.outputs))
        named = 0
        for first in range(0, len(self.outputs), step):
            stage = self.outputs[first : first + step]
            for node in topological_order(stage):
                if node in texts:
                    continue
                if node.operation == VARIABLE:
                    text = self._variable(language, str(node.detail))
                elif node.operation == CONSTANT:
                    text = language.notation.number(float(node.detail))
                else:
                    text = language.notation.text(node, [texts[x] for x in node.arguments])
                    if is_worth_a_line(node, text, uses[node], node in ends):
                        named += 1
                        lines.append(language.constant.format(f"t{named}", text[0]))
                        text = f"t{named}", ALONE
                texts[node] = text
            for k, node in enumerate(stage, first):
                place = language.element_text(self.array, str(k))
                lines.append(f"{place} = {texts[node][0]}{language.line_end}")
            if self.stage and first + step < len(self.outputs):
                condition = language.notation.operation_text(
                    "equal", [("last", ALONE), (str(first // step), ALONE)]
                )
                lines += [
                    language.block("if", condition[0]),
                    *language.indented_lines(language.return_lines("")),
                ]
                lines += [language.blocks["end"]] if language.blocks["end"] else []
        return lines

    def _variable(self, language: Language, name: str) -> Text:
        array, index = self.variables[name]
        if index is None:
            return language.scalar_text(array), ALONE
        return language.element_text(array, str(index)), ALONE
