"""Where a source can be given a fault, and the faulty source."""

from __future__ import annotations

import ast
import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

ROOMS = (
    "numerics", "geometry", "laws", "model", "structure", "kinematics", "equations", "dynamics", "analysis", "cams",
    "sweeps", "scenes", "assignments", "render", "animation", "export", "report",
)  # fmt: skip
"""Folders of the package that mutants are drawn from."""
COMPARISONS: Mapping[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
SIGNS: Mapping[type[ast.operator], type[ast.operator]] = {ast.Add: ast.Sub, ast.Sub: ast.Add}
ARITHMETIC = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.FloorDiv, ast.Pow, ast.Mod, ast.MatMult)


@dataclass(frozen=True)
class Mutant:
    """A fault: bytes `begin` to `end` of a file become `after`.

    The file is relative to the package's folder; `function` is the qualified name of the innermost function around the
    fault, empty at the level of the module.
    """

    file: str
    kind: str
    function: str
    line: int
    begin: int
    end: int
    after: str

    def source(self, content: bytes) -> bytes:
        """The faulty source."""
        return content[: self.begin] + self.after.encode() + content[self.end :]

    def change(self, content: bytes) -> str:
        """The fault in words: what stood there and what stands there now."""
        return f"{content[self.begin : self.end].decode()} -> {self.after}"


@dataclass(frozen=True)
class Site:
    """A place in a source, and how to spell a fault of it."""

    kind: str
    function: str
    node: ast.expr | ast.stmt
    faulty: ast.expr | ast.stmt

    def mutant(self, file: str, content: bytes) -> Mutant:
        """The fault spelled out."""
        begins = [0]
        for line in content.splitlines(keepends=True):
            begins.append(begins[-1] + len(line))
        node = self.node
        assert node.end_lineno is not None and node.end_col_offset is not None
        begin = begins[node.lineno - 1] + node.col_offset
        end = begins[node.end_lineno - 1] + node.end_col_offset
        # parentheses around a node belong to its parent; around the fault they keep it one operand
        text = ast.unparse(self.faulty)
        after = text if isinstance(node, ast.stmt) else f"({text})"
        return Mutant(file, self.kind, self.function, node.lineno, begin, end, after)


def draw_mutants(package: Path, seed: int, count: int) -> list[Mutant]:
    """So many different mutants of a package: first a kind of fault is drawn, then a place for it."""
    kinds: dict[str, list[tuple[Path, Site]]] = {}
    for room in ROOMS:
        for file in sorted((package / room).rglob("*.py")):
            for site in sites(file.read_bytes()):
                kinds.setdefault(site.kind, []).append((file, site))
    if not kinds:
        raise FileNotFoundError(f"no rooms of the package in {package}")
    draw = random.Random(seed)
    names = sorted(kinds)
    chosen: dict[Mutant, None] = {}
    while len(chosen) < min(count, sum(map(len, kinds.values()))):
        file, site = draw.choice(kinds[draw.choice(names)])
        chosen.setdefault(site.mutant(file.relative_to(package).as_posix(), file.read_bytes()))
    return list(chosen)


def sites(content: bytes) -> list[Site]:
    """All faults that a source can be given, in reading order."""
    return [
        Site(kind, ".".join(function), node, faulty)
        for node, function in _walk(ast.parse(content), ())
        for kind, faulty in _faults(node)
    ]


def _walk(node: ast.AST, around: tuple[str, ...]) -> Iterator[tuple[ast.expr | ast.stmt, tuple[str, ...]]]:
    """Statements and expressions that are computed, each with the names around it as `__qualname__` has them.

    Left out are annotations, decorators, formatted texts (their parts have no places of their own in Python 3.11),
    and what is done only while types are checked or to tell an error.
    """
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if not isinstance(child, ast.AST) or isinstance(child, (ast.JoinedStr, ast.Raise, ast.Assert)):
                continue
            if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
                continue
            inside = around
            if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)):
                inside = (*around, child.name, "<locals>")
            elif isinstance(child, ast.ClassDef):
                inside = (*around, child.name)
            if isinstance(child, (ast.expr, ast.stmt)):
                yield child, _function(around)
            yield from _walk(child, inside)


def _function(around: tuple[str, ...]) -> tuple[str, ...]:
    """The names up to the innermost function; none where only classes are around."""
    last = max((k for k, name in enumerate(around) if name == "<locals>"), default=0)
    return around[:last]


def _faults(node: ast.expr | ast.stmt) -> Iterator[tuple[str, ast.expr | ast.stmt]]:
    """Kinds of faults of a node, with what stands there instead."""
    match node:
        case ast.Compare(left, [operator], [right]):
            yield "comparison", ast.Compare(left, [COMPARISONS[type(operator)]()], [right])
        case ast.Constant(bool() as value):
            yield "constant", ast.Constant(not value)
        case ast.Constant(int() as value):
            yield "constant", ast.Constant(value + 1)
        case ast.Constant(float() as value):
            yield "constant", ast.Constant(1.1 * value or 1.0)
        case ast.BinOp(left, operator, right) if isinstance(operator, ARITHMETIC) and not _is_text(node):
            if type(operator) in SIGNS:
                yield "sign", ast.BinOp(left, SIGNS[type(operator)](), right)
            yield "operand", left
            yield "operand", right
        case ast.BoolOp(_operator, [first, *_others]):
            yield "operand", first
        case ast.UnaryOp(ast.USub(), operand):
            yield "sign", operand
        case ast.UnaryOp(ast.Not(), operand):
            yield "comparison", operand
        case ast.AugAssign(target, operator, value) if type(operator) in SIGNS:
            yield "sign", ast.AugAssign(target, SIGNS[type(operator)](), value)
        case ast.Return(value) if value is not None and not _is_none(value):
            yield "return", ast.Return(ast.Constant(None))


def _is_text(node: ast.AST) -> bool:
    """Whether a sum puts texts together rather than computes."""
    while isinstance(node, ast.BinOp):
        if isinstance(node.right, ast.JoinedStr) or _is_string(node.right):
            return True
        node = node.left
    return isinstance(node, ast.JoinedStr) or _is_string(node)


def _is_string(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _is_none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None
