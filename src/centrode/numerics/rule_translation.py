"""Plain functions of Python in other languages, statement by statement.

What is translated are functions of a module of this package: their first parameter is a record `m` with numbers
and arrays of numbers, the others are numbers, annotated `int` or `float`. They consist of assignments to
annotated names and to the record, of `if`, `while`, `for ... in range`, `return`, `continue`, and of calls. A
function of the module is called as a statement, or as the whole right side of an assignment. Names in capitals
are constants of the module.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from types import ModuleType

from centrode.numerics.graphs import ALONE, Text
from centrode.numerics.source_languages import REAL, WHOLE, Language

SIGNS: Mapping[type[ast.AST], str] = {
    ast.Add: "add", ast.Sub: "subtract", ast.Mult: "multiply", ast.Div: "divide",
    ast.USub: "negate", ast.Not: "opposite",
    ast.And: "both", ast.Or: "either", ast.Lt: "less", ast.LtE: "less_equal", ast.Eq: "equal", ast.NotEq: "not_equal",
}  # fmt: skip
TURNED: Mapping[type[ast.AST], str] = {ast.Gt: "less", ast.GtE: "less_equal"}
"""Comparisons that are written with their sides exchanged."""
FUNCTIONS = {
    "abs": "abs",
    "sqrt": "sqrt",
    "sin": "sin",
    "cos": "cos",
    "atan2": "atan2",
    "min": "minimum",
    "max": "maximum",
}
NUMBERS = ("pi", "nan")
KINDS = {"int": WHOLE, "float": REAL}


def translate_rules(module: ModuleType, language: Language, numbers: Mapping[str, int | float]) -> list[str]:
    """The functions of a module in a language, in the order in which they are called.

    Parameters
    ----------
    module : whose functions are translated
    language : which they are written in
    numbers : numbers of the record that are the same for all records, written as they are

    Raises SyntaxError for a statement or an expression that is none of the few above.
    """
    functions = [
        node for node in ast.parse(inspect.getsource(module)).body if isinstance(node, ast.FunctionDef)
    ]
    gives = {each.name: _kind(each.returns) for each in functions}
    lines: list[str] = []
    for each in functions:
        lines += _Translation(module, language, numbers, gives).function(each)
    return lines


def called_first(module: ModuleType) -> list[str]:
    """Heads of the functions of a module as C declares them before they are defined."""
    functions = [
        node for node in ast.parse(inspect.getsource(module)).body if isinstance(node, ast.FunctionDef)
    ]
    return [
        f"static {_kind(each.returns) or 'void'} {each.name}("
        + ", ".join(["record *m", *(f"{_kind(x.annotation)} {x.arg}" for x in each.args.args[1:])])
        + ");"
        for each in functions
    ]


def _kind(annotation: ast.expr | None) -> str:
    return KINDS.get(annotation.id, "") if isinstance(annotation, ast.Name) else ""


@dataclass
class _Translation:
    """One function on its way into a language; `names` are those that have been given a value."""

    module: ModuleType
    language: Language
    numbers: Mapping[str, int | float]
    gives: Mapping[str, str]
    names: dict[str, str] = field(default_factory=dict)

    def function(self, node: ast.FunctionDef) -> list[str]:
        parameters = [(x.arg, _kind(x.annotation)) for x in node.args.args[1:]]
        body = self._block(node.body)
        if self.language.declares:
            body = [f"{kind} {name};" for name, kind in self.names.items()] + body
        elif self.language.blocks["end"] and not self.language.gives_record_back and self.names:
            body = [f"let {', '.join(self.names)};", *body]
        documented = ast.get_docstring(node)
        head = [f"{self.language.comment} {documented}"] if documented else []
        return [*head, *self.language.function(node.name, parameters, self.gives[node.name], body)]

    def _block(self, statements: Sequence[ast.stmt]) -> list[str]:
        return [line for statement in statements for line in self._statement(statement)]

    def _statement(self, node: ast.stmt) -> list[str]:
        language = self.language
        match node:
            case ast.Expr(ast.Constant()) | ast.Pass():
                return []
            case ast.Expr(ast.Call() as call):
                return [self._call(call, "")]
            case ast.AnnAssign(ast.Name(name), annotation, ast.expr() as value):
                self.names.setdefault(name, _kind(annotation))
                return [self._assignment(name, value)]
            case ast.Assign([target], value):
                return [self._assignment(self._text(target), value)]
            case ast.Return(value):
                return language.return_lines("" if value is None else self._text(value))
            case ast.If():
                return self._choice(node, "if")
            case ast.While(test, body):
                return [
                    language.block("while", self._text(test)),
                    *language.indented_lines(self._block(body)),
                    *self._end,
                ]
            case ast.For(ast.Name(name), ast.Call(ast.Name("range"), ends), body):
                return self._loop(name.lstrip("_"), ends, body)
        raise SyntaxError(ast.unparse(node))

    def _choice(self, node: ast.If, word: str) -> list[str]:
        language = self.language
        lines = [
            language.block(word, self._text(node.test)),
            *language.indented_lines(self._block(node.body)),
        ]
        match node.orelse:
            case []:
                return lines + self._end
            case [ast.If() as other]:
                return lines + self._choice(other, "elif")
            case others:
                return [
                    *lines,
                    language.block("else"),
                    *language.indented_lines(self._block(others)),
                    *self._end,
                ]

    def _loop(self, name: str, ends: Sequence[ast.expr], body: Sequence[ast.stmt]) -> list[str]:
        if self.names.get(name, WHOLE) != WHOLE:
            raise SyntaxError(f"{name} is the number of a loop and of something else")
        if self.language.declares:
            self.names.setdefault(name, WHOLE)
        first, last = ("0", self._text(ends[0])) if len(ends) == 1 else (self._text(x) for x in ends)
        return [
            self.language.block("for", name, first, last),
            *self.language.indented_lines(self._block(body)),
            *self._end,
        ]

    @property
    def _end(self) -> list[str]:
        return [self.language.blocks["end"]] if self.language.blocks["end"] else []

    def _assignment(self, target: str, value: ast.expr) -> str:
        if isinstance(value, ast.Call) and self._call_of_function(value) in self.gives:
            return self._call(value, target)
        return f"{target} = {self._text(value)}{self.language.line_end}"

    def _call_of_function(self, call: ast.Call) -> str:
        return call.func.id if isinstance(call.func, ast.Name) else ""

    def _call(self, call: ast.Call, target: str) -> str:
        if isinstance(call.func, ast.Attribute):
            # a formula of the record
            return self.language.call_lines(
                call.func.attr, [self._text(x) for x in call.args], "", gives=False
            )
        name, arguments = self._call_of_function(call), [self._text(x) for x in call.args[1:]]
        return self.language.call_lines(name, arguments, target, gives=bool(self.gives[name]))

    # Expressions.

    def _text(self, node: ast.expr) -> str:
        return self._expression(node)[0]

    def _expression(self, node: ast.expr) -> Text:
        language, notation = self.language, self.language.notation
        match node:
            case ast.Constant(value):
                return (str(value), ALONE) if isinstance(value, int) else notation.number(float(str(value)))
            case ast.Name(name):
                if name in NUMBERS or name.isupper():
                    return self._constant(getattr(self.module, name))
                return name, ALONE
            case ast.Attribute(ast.Name("m"), name):
                if name in self.numbers:
                    return self._constant(self.numbers[name])
                return language.scalar_text(name), ALONE
            case ast.Subscript(ast.Attribute(ast.Name("m"), name), index):
                return language.element_text(name, self._text(index)), ALONE
            case ast.BinOp(left, operator, right):
                sides = [self._expression(left), self._expression(right)]
                return notation.operation_text(SIGNS[type(operator)], sides)
            case ast.UnaryOp(operator, operand):
                return notation.operation_text(SIGNS[type(operator)], [self._expression(operand)])
            case ast.Compare(left, [operator], [right]):
                sides = [self._expression(left), self._expression(right)]
                if type(operator) in TURNED:
                    return notation.operation_text(TURNED[type(operator)], sides[::-1])
                return notation.operation_text(SIGNS[type(operator)], sides)
            case ast.BoolOp(operator, values):
                # compilers warn where the sign of one stands bare beside that of the other
                texts = [self._alone(x) if isinstance(x, ast.BoolOp) else self._expression(x) for x in values]
                return reduce(lambda a, b: notation.operation_text(SIGNS[type(operator)], [a, b]), texts)
            case ast.Call(ast.Name(name), arguments):
                return self._function(name, [self._expression(x) for x in arguments])
        raise SyntaxError(ast.unparse(node))

    def _alone(self, node: ast.expr) -> Text:
        return f"({self._text(node)})", ALONE

    def _function(self, name: str, arguments: Sequence[Text]) -> Text:
        if name in self.language.plain:
            return self.language.plain[name].format(arguments[0][0]), ALONE
        if name not in FUNCTIONS:
            raise SyntaxError(f"{name} is called within an expression")
        return self.language.notation.operation_text(FUNCTIONS[name], arguments)

    def _constant(self, value: float) -> Text:
        if isinstance(value, int):
            return str(value), ALONE
        return self.language.notation.number(value)
