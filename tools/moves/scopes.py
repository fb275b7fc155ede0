"""Names of a Python source: where each is bound and which binding each occurrence means."""

from __future__ import annotations

import ast
import builtins
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

BUILTINS = frozenset(dir(builtins))
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


@dataclass(eq=False)
class Scope:
    """A module, class, function or comprehension with the names that it binds."""

    kind: str
    name: str
    parent: Scope | None = None
    bound: set[str] = field(default_factory=set)
    parameters: set[str] = field(default_factory=set)
    outer: dict[str, bool] = field(default_factory=dict)
    """Names of `global` (True) and `nonlocal` (False) statements."""

    @property
    def path(self) -> str:
        """Qualified name, like "Class.method", without the module."""
        return f"{self.parent.path}.{self.name}".lstrip(".") if self.parent else ""

    def resolve(self, name: str) -> Scope | None:
        """The scope whose binding a name means here; None for a builtin or an unknown name."""
        scope: Scope | None = self
        while scope is not None:
            if scope.outer.get(name):
                return scope.module
            visible = scope.kind != "class" or scope is self
            if visible and name in scope.bound and name not in scope.outer:
                return scope
            scope = scope.parent
        return None

    @property
    def module(self) -> Scope:
        """The outermost scope."""
        return self.parent.module if self.parent else self


@dataclass(frozen=True)
class Occurrence:
    """A name in the text, from one offset to another."""

    name: str
    scope: Scope
    start: int
    end: int
    inside: tuple[int, int] | None = None
    """The formatted string around it, whose inner positions Python 3.11 does not know."""


@dataclass(frozen=True)
class Member:
    """An attribute of a plain name, `name.attribute`, or its name as a string beside it."""

    owner: Occurrence
    attribute: str
    start: int
    end: int
    quoted: bool = False


@dataclass(frozen=True)
class Imported:
    """One name that an import statement binds."""

    statement: ast.Import | ast.ImportFrom
    alias: ast.alias
    scope: Scope
    typing_only: bool

    @property
    def local(self) -> str:
        """The name that is bound."""
        return self.alias.asname or self.alias.name.split(".")[0]


class Names(ast.NodeVisitor):
    """All scopes, occurrences, members and imports of a source."""

    def __init__(self, text: str, tree: ast.Module) -> None:
        self.text = text
        self.starts = [0]
        for line in text.splitlines(keepends=True):
            self.starts.append(self.starts[-1] + len(line))
        self.lines = text.splitlines()
        self.module = Scope("module", "")
        self.scope = self.module
        self.occurrences: list[Occurrence] = []
        self.members: list[Member] = []
        self.imports: list[Imported] = []
        self._formatted: tuple[int, int] | None = None
        self._typing_only = False
        self.visit(tree)

    def offset(self, line: int, column: int) -> int:
        """Place in the text of a line and a column in bytes, as `ast` counts."""
        return self.starts[line - 1] + len(self.lines[line - 1].encode()[:column].decode())

    def span(self, node: ast.AST) -> tuple[int, int]:
        """First and last place of a node."""
        start = self.offset(node.lineno, node.col_offset)  # type: ignore[attr-defined]
        return start, self.offset(node.end_lineno, node.end_col_offset)  # type: ignore[attr-defined]

    def scopes(self) -> Iterator[Scope]:
        """Every scope with an occurrence, each once."""
        seen: set[int] = set()
        for occurrence in self.occurrences:
            scope: Scope | None = occurrence.scope
            while scope is not None and id(scope) not in seen:
                seen.add(id(scope))
                yield scope
                scope = scope.parent

    # -- occurrences

    def _occurs(self, name: str, start: int, bind: bool) -> Occurrence:
        if bind:
            self.scope.bound.add(name)
        occurrence = Occurrence(name, self.scope, start, start + len(name), self._formatted)
        self.occurrences.append(occurrence)
        return occurrence

    def visit_Name(self, node: ast.Name) -> None:
        """Use or binding of a name."""
        scope = self.scope
        bind = not isinstance(node.ctx, ast.Load)
        if self._formatted:
            self._occurs(node.id, self._formatted[0], bind)
            return
        self._occurs(node.id, self.offset(node.lineno, node.col_offset), bind)
        self.scope = scope

    def visit_NamedExpr(self, node: ast.NamedExpr) -> None:
        """A walrus binds outside comprehensions."""
        self.visit(node.value)
        inner = self.scope
        while self.scope.kind == "comprehension" and self.scope.parent:
            self.scope = self.scope.parent
        self.visit(node.target)
        self.scope = inner

    def visit_Attribute(self, node: ast.Attribute) -> None:
        """Attributes of plain names are kept beside their owner."""
        self.visit(node.value)
        if isinstance(node.value, ast.Name):
            end = 0 if self._formatted else self.offset(node.end_lineno or 0, node.end_col_offset or 0)
            self.members.append(Member(self.occurrences[-1], node.attr, end - len(node.attr), end))

    def visit_Call(self, node: ast.Call) -> None:
        """`setattr(module, "name", ...)` and its like name an attribute in a string."""
        self.visit(node.func)
        for place, argument in enumerate(node.args):
            self.visit(argument)
            if (
                place == 1
                and isinstance(argument, ast.Constant)
                and isinstance(argument.value, str)
                and isinstance(node.args[0], ast.Name)
                and argument.value.isidentifier()
            ):
                owner = next(o for o in reversed(self.occurrences) if o.name == node.args[0].id)
                start, end = self.span(argument)
                self.members.append(Member(owner, argument.value, start, end, quoted=True))
        for keyword in node.keywords:
            self.visit(keyword)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        """Occurrences in a formatted string know the string alone."""
        before, self._formatted = self._formatted, self._formatted or self.span(node)
        self.generic_visit(node)
        self._formatted = before

    # -- bindings

    def _import(self, node: ast.Import | ast.ImportFrom) -> None:
        for alias in node.names:
            imported = Imported(node, alias, self.scope, self._typing_only)
            self.scope.bound.add(imported.local)
            self.imports.append(imported)

    def visit_Import(self, node: ast.Import) -> None:
        """An import binds a name."""
        self._import(node)

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        """An import binds names."""
        self._import(node)

    def visit_If(self, node: ast.If) -> None:
        """Imports under TYPE_CHECKING are marked."""
        before = self._typing_only
        self.visit(node.test)
        self._typing_only = before or (isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING")
        for statement in node.body:
            self.visit(statement)
        self._typing_only = before
        for statement in node.orelse:
            self.visit(statement)

    def visit_Global(self, node: ast.Global) -> None:
        """Names of the module."""
        self.scope.outer.update(dict.fromkeys(node.names, True))
        begin, end = self.span(node)
        for name in node.names:
            found = re.compile(rf"\b{name}\b").search(self.text, begin, end)
            self.occurrences.append(Occurrence(name, self.scope, found.start(), found.end()))  # type: ignore[union-attr]

    def visit_Nonlocal(self, node: ast.Nonlocal) -> None:
        """Names of an outer function."""
        self.scope.outer.update(dict.fromkeys(node.names, False))

    def visit_ExceptHandler(self, node: ast.ExceptHandler) -> None:
        """`except ... as name`."""
        if node.name:
            self._written_name(node, rf"\bas\s+({node.name})\b", node.name)
        self.generic_visit(node)

    def visit_MatchAs(self, node: ast.MatchAs) -> None:
        """A capture of `match`."""
        self.generic_visit(node)
        if node.name:
            _begin, end = self.span(node)
            self._occurs(node.name, end - len(node.name), True)

    def visit_MatchStar(self, node: ast.MatchStar) -> None:
        """A starred capture of `match`."""
        if node.name:
            _begin, end = self.span(node)
            self._occurs(node.name, end - len(node.name), True)

    def _written_name(self, node: ast.AST, pattern: str, name: str) -> None:
        begin, end = self.span(node)
        found = re.compile(pattern).search(self.text, begin, end)
        self._occurs(name, found.start(1), True)  # type: ignore[union-attr]

    # -- scopes

    def _enter(self, kind: str, name: str) -> Scope:
        before, self.scope = self.scope, Scope(kind, name, self.scope)
        return before

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        """Decorators and bases stand outside."""
        for outside in [*node.decorator_list, *node.bases, *node.keywords]:
            self.visit(outside)
        self._written_name(node, rf"class\s+({node.name})\b", node.name)
        before = self._enter("class", node.name)
        for statement in node.body:
            self.visit(statement)
        self.scope = before

    def visit_FunctionDef(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        """Decorators, defaults and annotations stand outside."""
        for decorator in node.decorator_list:
            self.visit(decorator)
        self._written_name(node, rf"def\s+({node.name})\b", node.name)
        if node.returns:
            self.visit(node.returns)
        self._function(node, node.name, node.body)

    visit_AsyncFunctionDef = visit_FunctionDef  # noqa: N815 -- names that `ast` calls

    def visit_Lambda(self, node: ast.Lambda) -> None:
        """A function without a name."""
        self._function(node, "<lambda>", [node.body])

    def _function(
        self,
        node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda,
        name: str,
        body: list[ast.stmt] | list[ast.expr],
    ) -> None:
        given = node.args
        parameters = [*given.posonlyargs, *given.args, *given.kwonlyargs]
        parameters += [more for more in (given.vararg, given.kwarg) if more]
        for outside in [*given.defaults, *given.kw_defaults]:
            if outside:
                self.visit(outside)
        for parameter in parameters:
            if parameter.annotation:
                self.visit(parameter.annotation)
        before = self._enter("function", name)
        for parameter in parameters:
            start = self._formatted[0] if self._formatted else self.span(parameter)[0]
            self._occurs(parameter.arg, start, True)
            self.scope.parameters.add(parameter.arg)
        for statement in body:
            self.visit(statement)
        self.scope = before

    def _comprehension(self, node: ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp) -> None:
        self.visit(node.generators[0].iter)
        before = self._enter("comprehension", "<comprehension>")
        for place, generator in enumerate(node.generators):
            self.visit(generator.target)
            if place:
                self.visit(generator.iter)
            for condition in generator.ifs:
                self.visit(condition)
        for part in (node.key, node.value) if isinstance(node, ast.DictComp) else (node.elt,):
            self.visit(part)
        self.scope = before

    visit_ListComp = visit_SetComp = visit_DictComp = visit_GeneratorExp = _comprehension  # noqa: N815
