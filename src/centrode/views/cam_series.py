"""The power series of a cam's path: what the terminal, the files and the document show, in the letters of the paper."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.sheets.sheet import (
    Block,
    Chapter,
    Column,
    Deferred,
    Fact,
    Formula,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Expression, Number, Sentence, Symbol, Text
from centrode.views.columns import rows_shown
from centrode.views.curvature_cams import carrier_table

if TYPE_CHECKING:
    from centrode.cams.series import CamSeriesResults

VARIABLES = (
    "pressure_sine",
    "pressure_sine_slope",
    "pressure_sine_second",
    "pressure_cosine",
    "law_curvature",
    "path_radius",
)
MOST_ROWS = 19


def sheet(results: CamSeriesResults) -> Sheet:
    """The coefficients, and the course of the cut series as the paper tabulates it."""
    return Sheet(
        heading=Sentence("Power series about φ = {zero}", zero=Number(0.0)),
        facts=tuple(_facts(results)),
        printed=(_coefficients(results), _course(results)),
        tables=Deferred(
            {
                "cam-series": lambda: carrier_table(results.dataset, VARIABLES),
                "cam-coefficients": lambda: _coefficients(results, shown=False),
            }
        ),
        datasets={"cam-series": results.dataset},
        chapters=Deferred({"series": lambda: _chapter(results)}),
    )


def _facts(results: CamSeriesResults) -> Iterator[Fact]:
    last = Symbol("a", str(int(results.dataset.attrs["terms"])), slanted=True)
    yield Fact(Sentence("series"), Sentence("truncated after {term}", term=last))
    recursions: Text = Sentence(
        "recursions ({first}), ({second}), ({third})", first=Number(24), second=Number(25), third=Number(34)
    )
    if results.dataset.attrs["recursion"] != "exponential":
        recursions = Sentence(
            "recursions ({first}), ({second}) and that of the equations of the path",
            first=Number(24),
            second=Number(25),
        )
    yield Fact(Sentence("coefficients by"), recursions)


def _coefficients(results: CamSeriesResults, *, shown: bool = True) -> Table:
    """a_n and b_n; as they are `shown` with digits of their own size each, else all."""
    data = results.dataset
    names = (("sine_coefficient", "a_n"), ("cosine_coefficient", "b_n"))
    terms = tuple(Number(number, digits="d") for number in data["term"].values.tolist())
    columns = [Column("n", terms, head=Expression("n"))]
    for name, letter in names:
        values = data[name].values
        if shown:
            # they fall off by powers of the radius of convergence
            cells = tuple(Number(value, digits=".5e" if value else "g") for value in values.tolist())
            columns.append(Column(name, cells, head=Expression(letter)))
        else:
            columns.append(Column(name, values, head=Expression(letter)))
    return Table(tuple(columns), Sentence("Coefficients of the series"))


def _course(results: CamSeriesResults, *, shown: bool = True) -> Table:
    """phi, eta with two derivatives, lambda, K and rho, in the columns of the paper's table; as `_coefficients`."""
    data = results.dataset
    data = data.isel(sample=list(rows_shown(data.sizes["sample"], MOST_ROWS)))
    columns = [Column("phi", data["carrier_angle"].values, "rad", Expression("phi"))]
    for name, letter, unit, digits in (
        ("pressure_sine", "eta", "1", ".6f"),
        ("pressure_sine_slope", "eta'", "1", ".6f"),
        ("pressure_sine_second", "eta''", "1", ".6f"),
        ("pressure_cosine", "lambda", "1", ".6f"),
        ("law_curvature", "K", "1/m", ".6f"),
        ("path_radius", "rho", "m", ".3f"),
    ):
        values = data[name].values
        if not shown:
            columns.append(Column(name, values, unit, Expression(letter)))
            continue
        size = 0.5e-6 if unit == "1" else 0.0
        cells = tuple(
            Number(0.0 if abs(value) < size else value, unit, digits, unit_hidden=True)
            for value in values.tolist()
        )
        columns.append(Column(name, cells, unit, Expression(letter)))
    caption = Sentence("The truncated series at equal steps of the carrier")
    return Table(tuple(columns), caption)


def _chapter(results: CamSeriesResults) -> Chapter:
    """The equation, the recursions and the series in the letters of the paper."""
    recursion = _exponential() if results.dataset.attrs["recursion"] == "exponential" else _general()
    blocks = (*_series(), *recursion, _coefficients(results), _course(results, shown=False))
    return Chapter(Sentence("Power series of the path"), (Section(NOTHING, blocks),))


def _series() -> tuple[Block, ...]:
    """The equation of the path, its solution as series, and the recursion of the cosine."""
    equation = Formula((("K eta'' - K' eta' + K eta + K' lambda", "0"), ("lambda", "sqrt(1 - eta^2)")))
    series = Formula(
        (
            ("eta", "sum_(n = 0)^infinity a_n phi^n"),
            ("lambda", "sum_(n = 0)^infinity b_n phi^n"),
            ("a_0", "sin gamma_0"),
            ("a_1", "cos gamma_0 - rho_0 K(0)"),
            ("b_0", "cos gamma_0"),
        )
    )
    cosines = Formula(
        (
            (
                "b_(m + 1)",
                "-frac(1, 2 b_0) (sum_(i = 0)^(m + 1) a_i a_(m + 1 - i) + sum_(i = 1)^m b_i b_(m + 1 - i))",
            ),
        )
    )
    return (
        Paragraph(
            Sentence(
                "With $eta = sin gamma$ and $lambda = cos gamma$ the path of the roller's centre follows from"
            )
        ),
        equation,
        Paragraph(Sentence("Both are power series about $phi = 0$:")),
        series,
        Paragraph(
            Sentence(
                "The coefficients $b_(m + 1)$ follow from $lambda^2 + eta^2 = 1$, the paper's formulas ({even}) and "
                "({odd}):",
                even=Number(24),
                odd=Number(25),
            )
        ),
        cosines,
    )


def _exponential() -> tuple[Block, ...]:
    """The recursion of the sine where the curvature is an exponential function."""
    return (
        Paragraph(
            Sentence(
                "Of the curvature $K = k_0 e^(k_1 phi)$ the equation becomes autonomous, and the paper's formula "
                "({number}) gives",
                number=Number(34),
            )
        ),
        Formula(
            (
                ("eta'' - k_1 eta' + eta + k_1 sqrt(1 - eta^2)", "0"),
                (
                    "a_(m + 2)",
                    "frac(k_1 ((m + 1) a_(m + 1) - b_m) - a_m, (m + 2)(m + 1))",
                ),
            )
        ),
    )


def _general() -> tuple[Block, ...]:
    """The recursions of sine and radius for a curvature with any power series."""
    return (
        Paragraph(
            Sentence("With $K = sum k_i phi^i$ and $rho = sum r_i phi^i$ the coefficients $a_(n + 1)$ are")
        ),
        Formula(
            (
                ("(n + 1) a_(n + 1)", "b_n - sum_(i = 0)^n r_i k_(n - i)"),
                (
                    "(n + 1) b_0 r_(n + 1)",
                    "sum_(i = 0)^n r_i a_(n - i) - sum_(i = 1)^n (n + 1 - i) b_i r_(n + 1 - i)",
                ),
            )
        ),
    )
