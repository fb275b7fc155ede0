"""Sources of a repository: code, stubs and the code blocks of pages, with edits to their text."""

from __future__ import annotations

import ast
import io
import re
import subprocess
import tokenize
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from tools.moves.scopes import Names
from tools.moves.table import PACKAGE

SOURCE = Path("src") / PACKAGE
TEXTS = (".md", ".toml", ".cfg", ".yml", ".yaml", ".ipynb", ".txt")
BLOCK = re.compile(r"^```\s*python[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)


class Unresolved(Exception):
    """A question that the table leaves open."""


@dataclass(frozen=True, order=True)
class Edit:
    """New text for a stretch of a source."""

    start: int
    end: int
    new: str


def edited(text: str, edits: Iterable[Edit], start: int = 0, end: int | None = None) -> str:
    """A stretch of a text with those edits that lie in it."""
    stop = len(text) if end is None else end
    parts, at = [], start
    for edit in sorted(set(edits)):
        if edit.start < start or edit.end > stop:
            continue
        if edit.start < at:
            line = text[: edit.start].count("\n") + 1
            raise Unresolved(f"edits overlap at line {line}: {text[edit.start : edit.end]!r}")
        parts += [text[at : edit.start], edit.new]
        at = edit.end
    return "".join([*parts, text[at:stop]])


class Source:
    """One file; of a page, its blocks of Python are the code.

    Attributes
    ----------
    path : from the root of the repository
    module : dotted name of a module of the package, None of other files
    """

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.text = text
        self.module = None
        if path.is_relative_to(SOURCE) and path.suffix == ".py":
            parts = [PACKAGE, *path.relative_to(SOURCE).with_suffix("").parts]
            self.module = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)

    @property
    def is_python(self) -> bool:
        """Whether the file itself is code."""
        return self.path.suffix in (".py", ".pyi")

    @property
    def package(self) -> str:
        """The package that relative imports start from."""
        if not self.path.is_relative_to(SOURCE):
            return ""
        return ".".join([PACKAGE, *self.path.parent.relative_to(SOURCE).parts])

    @cached_property
    def code(self) -> str:
        """The text, of a page with blanks for all but its blocks of Python."""
        if self.is_python:
            return self.text
        blank = re.sub(r"[^\n]", " ", self.text)
        for block in BLOCK.finditer(self.text):
            start, end = block.span(1)
            try:
                ast.parse(block[1])
            except SyntaxError:
                continue
            blank = blank[:start] + block[1] + blank[end:]
        return blank

    @cached_property
    def tree(self) -> ast.Module:
        """The syntax."""
        return ast.parse(self.code)

    @cached_property
    def names(self) -> Names:
        """Scopes and occurrences."""
        return Names(self.code, self.tree)

    def line(self, offset: int) -> str:
        """Where an offset lies, as compilers say it."""
        return f"{self.path}:{self.text[:offset].count(chr(10)) + 1}"

    @cached_property
    def definitions(self) -> dict[str, list[ast.stmt]]:
        """Top statements that bind a name, but for imports."""
        found: dict[str, list[ast.stmt]] = {}
        for statement in self.tree.body:
            for name in _bound_by(statement):
                found.setdefault(name, []).append(statement)
        return found

    @cached_property
    def docstring(self) -> ast.Expr | None:
        """The statement of the module's docstring."""
        if self.tree.body and ast.get_docstring(self.tree, clean=False) is not None:
            first = self.tree.body[0]
            return first if isinstance(first, ast.Expr) else None
        return None

    def prose(self) -> Iterator[tuple[int, int, bool]]:
        """Strings and comments; the last says whether it is a comment or a docstring."""
        if not self.is_python:
            at = 0
            for block in BLOCK.finditer(self.text):
                yield at, block.start(), True
                at = block.end()
            yield at, len(self.text), True
            return
        docstrings = {
            self.names.span(node.value)[0]
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        }
        starts = self.names.starts
        for token in tokenize.generate_tokens(io.StringIO(self.text).readline):
            if token.type in (tokenize.STRING, tokenize.COMMENT):
                start = starts[token.start[0] - 1] + token.start[1]
                end = starts[token.end[0] - 1] + token.end[1]
                yield start, end, token.type == tokenize.COMMENT or start in docstrings


def _bound_by(statement: ast.stmt) -> Iterator[str]:
    if isinstance(statement, ast.Import | ast.ImportFrom):
        return
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        yield statement.name
    elif isinstance(statement, ast.If | ast.Try | ast.With | ast.For | ast.While):
        for inner in ast.iter_child_nodes(statement):
            if isinstance(inner, ast.stmt):
                yield from _bound_by(inner)
    else:
        for node in ast.walk(statement):
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
                yield node.id


def repository(root: Path) -> dict[Path, Source]:
    """The files of a repository that may name modules: what git knows, data and these tables left out."""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard"], cwd=root, capture_output=True, text=True, check=True
    )
    sources = {}
    for line in sorted(set(listed.stdout.splitlines())):
        path = Path(line)
        named = path.suffix in (".py", ".pyi", *TEXTS) or path.name == "Makefile"
        ours = path.parts[:2] == ("tools", "moves") or path.name == "test_moves.py"
        if named and not ours and (root / path).is_file():
            sources[path] = Source(path, (root / path).read_text(encoding="utf-8"))
    return sources
