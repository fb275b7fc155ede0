"""Formulas are cut where a reader expects it, and code is no formula."""

from __future__ import annotations

import pytest

import centrode as ct
from centrode.render.document.typst import TypstSpelling
from centrode.report.mathematics import check_formula, pieces_of
from equation_pages import Relation, entries


@pytest.mark.parametrize(
    ("formula", "depth", "pieces"),
    [
        ("a", 0, ["a"]),
        ("a + b - c", 0, ["a", "+ b", "- c"]),
        ("-a + b", 0, ["-a", "+ b"]),
        ("sin (a - b) + c", 0, ["sin (a - b)", "+ c"]),
        ("frac(a + b, c) - d", 1, ["frac(a + b, c)", "- d"]),
        ("frac(1, D) (a + b)", 0, ["frac(1, D) (a + b)"]),
        ("frac(1, D) (a + b)", 1, ["frac(1, D) \\(a", "+ b\\)"]),
        ("cos^(2) (a - b) (c + d)", 1, ["cos^(2) (a - b) \\(c", "+ d\\)"]),
        ("x_(\"a + b\") + c", 0, ["x_(\"a + b\")", "+ c"]),
        ("(a + (b + c))", 1, ["\\(a", "+ (b + c)\\)"]),
    ],
)  # fmt: skip
def test_pieces(formula: str, depth: int, pieces: list[str]) -> None:
    assert pieces_of(formula, depth) == pieces


@pytest.mark.parametrize(
    "name", ["six-bar-press", "excavator-arm", "fourth-class-group", "spherical-four-bar"]
)
def test_nothing_is_lost_between_pieces(name: str) -> None:
    equations = ct.equations(ct.example(name))
    for entry in entries(equations, TypstSpelling()):
        for part in entry.parts if isinstance(entry, Relation) else ():
            for depth in (0, 1):
                pieces = pieces_of(part, depth)
                assert " ".join(pieces).replace("\\(", "(").replace("\\)", ")") == part
                assert all(piece.count("(") == piece.count(")") for piece in pieces_of(part))


@pytest.mark.parametrize(
    "code",
    ['#read("x")', "a #b", "$", "`x`", "@x", "// x", "/* x", '"open', "a \\ b", '\\" #x "', '"a" "'],
)
def test_code_is_no_formula(code: str) -> None:
    with pytest.raises(ValueError, match="not a formula"):
        check_formula(code)


@pytest.mark.parametrize(
    "formula", ['x_("#a $b @c `d")', 'x_("a\\"b")', "a \\/ b", 'mat(delim: "|", a, b; c, d)']
)
def test_names_may_hold_anything(formula: str) -> None:
    assert check_formula(formula) == formula
