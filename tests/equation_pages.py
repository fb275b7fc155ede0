"""The page of the equations, its formulas spelled by any table of operations."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from centrode.equations.derivation import Equations
from centrode.equations.spelling import FormulaSpelling
from centrode.render.spelling import PlainSpelling
from centrode.render.symbolic import spell_symbolic
from centrode.sheets.sheet import Formula, Section, SheetEquations, SymbolList
from centrode.sheets.symbolic import SymbolicLeaf
from centrode.sheets.texts import Leaf
from centrode.views.equations import sheet


class Relation(NamedTuple):
    """A relation a = b = ..., spelled."""

    parts: tuple[str, ...]


class System(NamedTuple):
    """A linear system, spelled."""

    matrix: tuple[tuple[str, ...], ...]
    unknowns: tuple[str, ...]
    right: tuple[str, ...]

    @property
    def formulas(self) -> list[str]:
        """Everything that stands in it."""
        return [one for row in (*self.matrix, self.unknowns, self.right) for one in row]


def sections(equations: Equations) -> Iterator[Section]:
    """The sections of the page."""
    for section in sheet(equations).printed:
        assert isinstance(section, Section)
        yield section


def entries(equations: Equations, spelling: FormulaSpelling) -> Iterator[Relation | System]:
    """Relations and systems of the page in their order."""

    def spelled(leaves: tuple[Leaf, ...]) -> tuple[str, ...]:
        assert all(isinstance(leaf, SymbolicLeaf) for leaf in leaves)
        return tuple(spell_symbolic(leaf, spelling) for leaf in leaves)  # type: ignore[arg-type]

    for section in sections(equations):
        for block in section.blocks:
            if isinstance(block, Formula):
                yield from (Relation(spelled(line)) for line in block.lines)
            elif isinstance(block, SheetEquations):
                matrix = tuple(map(spelled, block.matrix))
                yield System(matrix, spelled(block.unknowns), spelled(block.right))


def formulas(equations: Equations, spelling: FormulaSpelling) -> Iterator[str]:
    """Every formula of the page."""
    for entry in entries(equations, spelling):
        yield from entry.parts if isinstance(entry, Relation) else entry.formulas


def rows(equations: Equations) -> list[tuple[str, str, str]]:
    """Heading, left and right side of every relation and every symbol, as plain text."""
    plain = PlainSpelling(equations.mechanism.display)
    found = []
    for section in sections(equations):
        heading = plain.text(section.title)
        for block in section.blocks:
            if isinstance(block, Formula):
                for line in block.lines:
                    left, *others = map(plain.leaf, line)
                    found.append((heading, left, " = ".join(others)))
            elif isinstance(block, SymbolList):
                for one in block.symbols:
                    text = f"{plain.text(one.value)}, {plain.text(one.meaning)}"
                    found.append((heading, plain.leaf(one.symbol), text))
    return found
