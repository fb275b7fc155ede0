"""Formulas written as text, read into formulas over any algebra; nothing of the text is run as Python."""

from __future__ import annotations

import ast
import difflib
import math
import re
import unicodedata
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.operations import CONSTANTS, DERIVED, FUNCTIONS, ONE_ARGUMENT, SCALARS, Number

SYNONYMS = {"tg": "tan", "arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctg": "atan", "ln": "log"}
"""Other spellings of functions, which an error corrects."""

# The text of a formula as Python reads it, with the way back to the user's characters.

_STRANGE = re.compile(r"[^\w\s.+\-*/^(),]")
_PASTED = re.compile(r"(?<![\w.])(?:\d++\.?+\d*+|\.\d++)(?:[eE][+-]?\d++)?+(?=[^\W\d])")


class SourceText:
    """A formula's text; complaints about it name the character that the user wrote."""

    def __init__(self, text: str, where: str) -> None:
        self.text = text
        self.where = where
        # A power is commonly written ^; `columns` leads from each character that Python reads to the user's.
        self.source, self.columns = "", [0]
        for column, character in enumerate(text):
            read = " " if character.isspace() else character.replace("^", "**")
            # a space at the beginning would be an indentation to Python
            if self.source or read != " ":
                # one more than characters: an error may point behind the last one
                self.columns[-1:] = [column] * (len(read) + 1)
                self.source += read

    def tree(self) -> ast.expr:
        """The syntax tree of what the text says."""
        if not self.text.strip():
            raise InputError(self.where, _("the formula is empty"), _("write a formula or a number"))
        self._characters()
        repair = _("use + - * / ** and parentheses")
        try:
            return ast.parse(self.source, mode="eval").body
        except SyntaxError as error:
            column = self.columns[min(max((error.offset or 1) - 1, 0), len(self.columns) - 1)]
            raise self.error(column, _("this is not a formula"), repair) from None
        except (ValueError, MemoryError, RecursionError):
            raise self.error(0, _("this is not a formula"), repair) from None

    def error(self, column: int, what: str, repair: str = "") -> InputError:
        """Complaint about a character (from 0) of the user's text."""
        place = _('{what}, at character {column} of "{text}"')
        shown = "".join(c if c.isprintable() else " " for c in self.text)
        return InputError(self.where, place.format(what=what, column=column + 1, text=shown), repair)

    def at(self, node: ast.expr, what: str, repair: str = "") -> InputError:
        """Complaint about a node, at its place in the user's text."""
        # Python counts bytes of UTF-8, users count characters
        before = self.source.encode()[: node.col_offset].decode(errors="ignore")
        return self.error(self.columns[len(before)], what, repair)

    def _characters(self) -> None:
        """Refuse what Python would read otherwise than a formula: other signs, look-alikes, names pasted to numbers."""
        strange = _STRANGE.search(self.text)
        if strange:
            what = _("this character is not allowed in a formula")
            raise self.error(strange.start(), what, _("use + - * / ** and parentheses"))
        for column, character in enumerate(self.text):
            # Python reads full-width and other compatibility letters as the plain ones (NFKC)
            if not character.isspace() and unicodedata.normalize("NFKC", character) != character:
                what = _("this character is not allowed in a formula")
                raise self.error(column, what, _("write plain letters and digits"))
        # Python takes "2in x" or "1if" for words: a person forgot a sign
        pasted = _PASTED.search(self.text)
        if pasted:
            repair = _('write "{number}*..."').format(number=pasted.group())
            raise self.error(pasted.end(), _("an operator is missing after a number"), repair)


Node = Callable[[Any, Mapping[str, Number]], Number]

TEXT_LENGTH = 1000
DEPTH = 50
GREATEST_POWER = 100


@dataclass(frozen=True)
class TextFormula:
    """A formula of named variables, read from text by `compile_formula`.

    Attributes
    ----------
    text : str
        The text as given.
    variables : tuple of str
        The names it may use.
    used : frozenset of str
        The names it does use.
    """

    text: str
    variables: tuple[str, ...]
    used: frozenset[str]
    _body: Node = field(repr=False, compare=False)

    def __call__(self, m: Any, **values: Number) -> Number:
        """Value over the algebra whose functions `m` holds; `values` gives each variable."""
        return self._body(m, values)


def compile_formula(
    text: str, variables: tuple[str, ...], where: str, folds: frozenset[str] = frozenset()
) -> TextFormula:
    """Read a formula from text.

    Known are + - * /, powers (`**` or `^`) with an integer or half-integer exponent, parentheses, the
    variables, pi, e, and sin cos tan sqrt exp log abs sign min max atan2 asin acos atan. `folds` are functions
    of one argument besides: the algebra's `fold(name, value)` makes one number of many.

    Raises
    ------
    InputError
        At `where`, naming the character of the text: not a formula, a name or a function that is not
        known, numbers without a finite value, more than 1000 characters, or more than 50 operations inside each
        other.
    """
    if len(text) > TEXT_LENGTH:
        what = _("a formula has at most {most} characters, got {count}").format(
            most=TEXT_LENGTH, count=len(text)
        )
        raise InputError(where, what, _("shorten it"))
    return _FormulaReader(text, variables, where, folds).formula()


class _FormulaReader:
    """Turns Python's syntax tree of one text into closures, refusing all that is not arithmetic."""

    def __init__(self, text: str, variables: tuple[str, ...], where: str, folds: frozenset[str]) -> None:
        self.source = SourceText(text, where)
        self.at = self.source.at
        self.variables = variables
        self.folds = folds
        self.used: set[str] = set()

    def formula(self) -> TextFormula:
        tree = self.source.tree()
        body = self.node(tree, 0)
        # last: what is no formula at all has a complaint that says more
        self.refuse_numbers_without_value(tree)
        return TextFormula(self.source.text, self.variables, frozenset(self.used), body)

    def node(self, node: ast.expr, depth: int) -> Node:
        if depth > DEPTH:
            raise self.at(
                node, _("the formula nests deeper than {most}").format(most=DEPTH), _("simplify it")
            )
        match node:
            case ast.Constant():
                return _constant(self.literal(node))
            case ast.Name():
                return self.name(node)
            case ast.UnaryOp(op=ast.UAdd()):
                return self.node(node.operand, depth + 1)
            case ast.UnaryOp(op=ast.USub()):
                inner = self.node(node.operand, depth + 1)
                return lambda m, v: -inner(m, v)
            case ast.BinOp(op=ast.Pow()):
                return self.power(node, depth)
            case ast.BinOp():
                return self.chain(node, depth)
            case ast.Call():
                return self.call(node, depth)
        raise self.at(node, _("only arithmetic is allowed here"), _("use + - * / ** and the known functions"))

    def refuse_numbers_without_value(self, node: ast.expr) -> None:
        """Refuse parts of numbers alone that have no finite value, such as 1/0: they have none over any algebra."""
        for part in self.parts_of_numbers(node):
            try:
                value = float(self.node(part, 0)(SCALARS, {}))
            except (ArithmeticError, ValueError):
                value = math.nan
            if not math.isfinite(value):
                what = _("a part of the formula has no finite value")
                raise self.at(part, what, _("correct its numbers"))

    def parts_of_numbers(self, tree: ast.expr) -> Iterator[ast.expr]:
        """The largest parts without variables and functions over samples; no recursion, as sums are long."""
        varied: set[ast.AST] = set()
        # the walk goes by levels from the root, so backwards children come before their parents
        for node in reversed(list(ast.walk(tree))):
            named = isinstance(node, ast.Name) and (node.id in self.variables or node.id in self.folds)
            if named or any(child in varied for child in ast.iter_child_nodes(node)):
                varied.add(node)
        left: list[ast.expr] = [tree]
        while left:
            node = left.pop()
            if node not in varied:
                yield node
                continue
            callee = node.func if isinstance(node, ast.Call) else None
            inner = ast.iter_child_nodes(node)
            left += [part for part in inner if isinstance(part, ast.expr) and part is not callee]

    def literal(self, node: ast.Constant) -> float:
        value = node.value
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.at(node, _("only numbers are allowed here"))
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise self.at(node, _("the number is too large"))
        return number

    def name(self, node: ast.Name) -> Node:
        name = node.id
        if name in self.variables:
            self.used.add(name)
            return lambda m, v: v[name]
        if name in CONSTANTS:
            return _constant(CONSTANTS[name])
        known = ", ".join((*self.variables, "pi", "e"))
        what = _('unknown name "{name}"').format(name=name)
        raise self.at(node, what, _("known are: {names}").format(names=known))

    def chain(self, node: ast.BinOp, depth: int) -> Node:
        """A run of + - * / from left to right: long sums are no deeper than short ones."""
        steps: list[tuple[type[ast.operator], Node]] = []
        left: ast.expr = node
        while isinstance(left, ast.BinOp) and not isinstance(left.op, ast.Pow):
            if not isinstance(left.op, ast.Add | ast.Sub | ast.Mult | ast.Div):
                raise self.at(left, _("unknown operation"), _("use + - * / ** and parentheses"))
            steps.append((type(left.op), self.node(left.right, depth + 1)))
            left = left.left
        first = self.node(left, depth + 1)
        steps.reverse()

        def run(m: Any, values: Mapping[str, Number]) -> Number:
            total = first(m, values)
            for operation, right in steps:
                total = _apply(operation, m, total, right(m, values))
            return total

        return run

    def power(self, node: ast.BinOp, depth: int) -> Node:
        base = self.node(node.left, depth + 1)
        exponent = self.exponent(node.right, depth + 1)
        twice = exponent * 2
        if twice != round(twice) or abs(exponent) > GREATEST_POWER:
            what = _("an exponent must be an integer or a half, at most {most}").format(most=GREATEST_POWER)
            raise self.at(node.right, what, _("write other powers as exp(y*log(x))"))
        if exponent == round(exponent):
            return lambda m, v: _power(m, base(m, v), round(exponent))
        # the root first, so that x^1.5 has the domain of the root: a power of x could hide a negative x
        return lambda m, v: _power(m, m.sqrt(base(m, v)), round(twice))

    def exponent(self, node: ast.expr, depth: int) -> float:
        try:
            body = self.node(node, depth) if not self.names(node) else None
            value = float("nan") if body is None else float(body(SCALARS, {}))
        except (ArithmeticError, ValueError):
            value = float("nan")
        if not math.isfinite(value):
            raise self.at(
                node, _("an exponent must be a fixed number"), _("write other powers as exp(y*log(x))")
            )
        return value

    def names(self, node: ast.expr) -> bool:
        return any(isinstance(inner, ast.Name) for inner in ast.walk(node))

    def call(self, node: ast.Call, depth: int) -> Node:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        known = FUNCTIONS | self.folds
        if name not in known:
            what = (
                _('unknown function "{name}"').format(name=name)
                if name
                else _("only known functions are allowed")
            )
            repair = _("known are: {names}").format(names=" ".join(sorted(known)))
            near = SYNONYMS.get(name) or next(iter(difflib.get_close_matches(name, sorted(known), n=1)), "")
            if near:
                repair = _("did you mean {name}?").format(name=f'"{near}"') + " " + repair
            raise self.at(node, what, repair)
        count = len(node.args)
        # of one argument min and max fold samples, of several they compare numbers
        folded = name in self.folds and (count == 1 or name not in FUNCTIONS)
        fits = count == 1 if folded or name in ONE_ARGUMENT else count == 2 if name == "atan2" else count >= 2
        if not fits or node.keywords or any(isinstance(a, ast.Starred) for a in node.args):
            raise self.at(node, _("{name} got the wrong number of arguments").format(name=name))
        arguments = [self.node(argument, depth + 1) for argument in node.args]
        if folded:
            return lambda m, values: m.fold(name, arguments[0](m, values))

        def run(m: Any, values: Mapping[str, Number]) -> Number:
            first, *others = (argument(m, values) for argument in arguments)
            if not others:
                return (
                    DERIVED[name](m, first)
                    if name in DERIVED and not hasattr(m, name)
                    else getattr(m, name)(first)
                )
            for other in others:
                first = getattr(m, name)(first, other)
            return first

        return run


def _constant(value: float) -> Node:
    return lambda m, v: value


def _apply(operation: type[ast.operator], m: Any, left: Number, right: Number) -> Number:
    if operation is ast.Add:
        return left + right
    if operation is ast.Sub:
        return left - right
    return left * right if operation is ast.Mult else left / _divisor(m, right)


def _divisor(m: Any, number: Number) -> Number:
    """Divisor unchanged, shown to algebras that have a function `divisor`, which look for its zeros."""
    return m.divisor(number) if hasattr(m, "divisor") else number


def _power(m: Any, base: Number, exponent: int) -> Number:
    """Integer power by squaring: any algebra multiplies, few raise to powers."""
    if exponent < 0:
        # one division of the whole power, and one place that an algebra has to watch for zero
        return 1.0 / _divisor(m, _power(m, base, -exponent))
    result: Number = None
    while exponent:
        if exponent & 1:
            result = base if result is None else result * base
        exponent >>= 1
        if exponent:
            base = base * base
    return 1.0 if result is None else result
