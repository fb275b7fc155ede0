"""An improved mechanism: what the terminal and the files show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.model.files import mechanism_text
from centrode.sheets.sheet import Column, Deferred, Fact, Scalar, Sheet, Table
from centrode.sheets.texts import NOTHING, Name, Number, Sentence, Text

if TYPE_CHECKING:
    from centrode.synthesis.improvement import Improvement

FILE = "improved.toml"


def sheet(results: Improvement) -> Sheet:
    """The objective before and after, dimensions and what was kept as tables, the improved description."""
    dimensions, kept = _dimensions(results), _kept(results)
    tables = {"dimensions": lambda: dimensions}
    if kept is not None:
        tables["kept"] = lambda: kept
    return Sheet(
        facts=tuple(_facts(results)),
        scalars={
            "before": Scalar(results.before, results.unit or "1"),
            "after": Scalar(results.after, results.unit or "1"),
        },
        tables=Deferred(tables),
        printed=(dimensions,) if kept is None else (dimensions, kept),
        files={FILE: mechanism_text(results.mechanism)},
        notes=tuple(_notes(results)),
    )


def _number(value: float, unit: str) -> Number:
    return Number(value, unit or "1", ".6g")


def _facts(results: Improvement) -> Iterator[Fact]:
    yield Fact(Sentence("objective"), Name(results.objective))
    wanted = {"least": Sentence("as small as possible"), "greatest": Sentence("as great as possible")}
    yield Fact(Sentence("wanted"), wanted[results.aim])
    yield Fact(Sentence("before"), _number(results.before, results.unit))
    yield Fact(Sentence("after"), _number(results.after, results.unit))
    if results.before:
        share = (results.after - results.before) / abs(results.before)
        yield Fact(Sentence("change"), Number(100 * share, "%", "+.2f"))
    yield Fact(Sentence("motions computed"), Number(results.evaluations, digits="d"))


def _dimensions(results: Improvement) -> Table:
    """A row for each dimension that was free, with its unit."""
    rows = results.free
    heads = {
        "before": Sentence("before"),
        "after": Sentence("after"),
        "least": Sentence("least"),
        "greatest": Sentence("greatest"),
    }
    values: dict[str, list[Text]] = {
        "before": [_number(one.before, one.unit) for one in rows],
        "after": [_number(one.after, one.unit) for one in rows],
        "least": [_number(one.low, one.unit) for one in rows],
        "greatest": [_number(one.high, one.unit) for one in rows],
    }
    columns = [Column("dimension", tuple(Name(one.path) for one in rows), head=Sentence("dimension"))]
    columns += [Column(name, tuple(values[name]), head=heads[name]) for name in heads]
    return Table(tuple(columns), Sentence("Dimensions"))


def _kept(results: Improvement) -> Table | None:
    rows = results.kept
    if not rows:
        return None

    def end(value: float, unit: str) -> Text:
        return _number(value, unit) if math.isfinite(value) else NOTHING

    return Table(
        (
            Column("kept", tuple(Name(one.text) for one in rows), head=Sentence("kept")),
            Column("before", tuple(_number(one.before, one.unit) for one in rows), head=Sentence("before")),
            Column("after", tuple(_number(one.after, one.unit) for one in rows), head=Sentence("after")),
            Column("least", tuple(end(one.low, one.unit) for one in rows), head=Sentence("least")),
            Column("greatest", tuple(end(one.high, one.unit) for one in rows), head=Sentence("greatest")),
        ),
        Sentence("What was kept"),
    )


def _notes(results: Improvement) -> Iterator[Text]:
    if not results.complete:
        yield Sentence("the search was stopped: there may be better dimensions")
    bound = [one.path for one in results.free if one.at_bound]
    if bound:
        yield Sentence("a wider range of {path} would help further", path=Name(bound[0]))
