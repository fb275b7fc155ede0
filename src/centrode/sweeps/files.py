"""Sweeps in files: which mechanism, what varies, what is asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.examples.loading import load
from centrode.model.mechanism import Mechanism
from centrode.model.problems import nearest, shown
from centrode.model.reading import read_file
from centrode.model.toml_text import toml_tables
from centrode.sweeps import limits
from centrode.sweeps.asked import Reduce
from centrode.sweeps.designs import Grid, grid
from centrode.sweeps.drawing import METHODS, Sample, sample

WAYS = ("vary", "grid", "sample")
KEYS = ("mechanism", *WAYS, "outputs", "samples", "from", "to", "reduce", "gradient", "executor")
RANGE = ("from", "to", "count")
SAMPLE = ("count", "method", "seed", "ranges")


@dataclass(frozen=True)
class SweepStudy:
    """A sweep as a file describes it; its parts are arguments of `sweep`.

    Attributes
    ----------
    name : of the mechanism, as the file says it
    start, stop : ends of the range as written (numbers in SI or texts with a unit); None for the motion's own
    """

    name: str
    mechanism: Mechanism
    vary: Mapping[str, Any] | Grid | Sample
    outputs: tuple[str, ...]
    samples: int | None
    start: float | str | None
    stop: float | str | None
    reduce: Reduce
    gradient: bool
    executor: str


def read_sweep(path: str | Path) -> SweepStudy:
    """The sweep described in a TOML file; raises InputError that says where it is wrong.

    The mechanism is a file (looked for in the study's own folder) or a built-in one.
    """
    path = Path(path)
    tables = toml_tables(read_file(path), path.name)
    try:
        return _study(tables, path.parent)
    except InputError as error:
        raise InputError(
            ", ".join(filter(None, (path.name, error.where))), error.what, error.repair
        ) from error


def _study(tables: Mapping[str, Any], folder: Path) -> SweepStudy:
    _refuse_unknown("", tables, KEYS)
    name = tables.get("mechanism")
    if not isinstance(name, str) or not name:
        example = _('write mechanism = "press.toml", or the name of a built-in one')
        raise InputError("mechanism", _("it is missing"), example)
    near = folder / name
    samples = tables.get("samples")
    if samples is not None and (isinstance(samples, bool) or not isinstance(samples, int)):
        raise InputError("samples", _("expected a whole number, got {value}").format(value=shown(samples)))
    return SweepStudy(
        name,
        load(near if near.is_file() else name),
        _vary(tables),
        _outputs(tables.get("outputs", [])),
        samples,
        _end("from", tables.get("from")),
        _end("to", tables.get("to")),
        _reduce(tables.get("reduce")),
        _switch("gradient", tables.get("gradient", False)),
        _text("executor", tables.get("executor", "auto")),
    )


def _switch(key: str, value: Any) -> bool:
    if not isinstance(value, bool):
        raise InputError(key, _("expected true or false, got {value}").format(value=shown(value)))
    return value


def _refuse_unknown(where: str, table: Mapping[str, Any], known: tuple[str, ...]) -> None:
    for key in table:
        if key not in known:
            raise InputError(where, _("unknown key {key}").format(key=shown(key)), nearest(key, known))


def _vary(tables: Mapping[str, Any]) -> Mapping[str, Any] | Grid | Sample:
    given = [way for way in WAYS if way in tables]
    if len(given) != 1:
        what = _("exactly one of {ways} says what varies").format(ways=", ".join(f"[{way}]" for way in WAYS))
        raise InputError(", ".join(f"[{way}]" for way in given), what, _("give one of them"))
    way = given[0]
    table = tables[way]
    if not isinstance(table, dict):
        raise InputError(way, _("expected a table, got {value}").format(value=shown(table)))
    if way == "vary":
        return dict(_paths(table, ()))
    if way == "grid":
        return grid({path: _range(path, value) for path, value in _paths(table, RANGE)})
    return _sample(table)


def _paths(table: Mapping[str, Any], leaf: tuple[str, ...], above: str = "") -> Iterator[tuple[str, Any]]:
    """(path, value) of a table whose keys are paths, in quotes or as TOML's dotted keys.

    A table inside is a value if it has one of the keys in `leaf`, and no table under it.
    """
    for key, value in table.items():
        path = f"{above}.{key}" if above else key
        if not isinstance(value, dict) or any(
            word in value and not isinstance(value[word], dict) for word in leaf
        ):
            yield path, value
        else:
            yield from _paths(value, leaf, path)


def _range(path: str, value: object) -> Any:
    """A range of a grid: a table with from, to and count; values as they are."""
    if not isinstance(value, dict):
        return value
    _refuse_unknown(path, value, RANGE)
    for key in RANGE:
        if key not in value:
            example = '{ from = "0.9 m", to = "1.1 m", count = 21 }'
            raise InputError(
                path, _("{key} is missing").format(key=key), _("write {example}").format(example=example)
            )
    return (value["from"], value["to"], value["count"])


def _sample(table: Mapping[str, Any]) -> Sample:
    _refuse_unknown("[sample]", table, SAMPLE)
    ranges = table.get("ranges")
    if not isinstance(ranges, dict) or "count" not in table:
        raise InputError(
            "[sample]", _("it needs count and ranges"), _("write count = 1000 and [sample.ranges]")
        )
    found = {path: _range_of_sample(path, value) for path, value in _paths(ranges, RANGE[:2])}
    return sample(found, table["count"], table.get("method", METHODS[0]), table.get("seed", 0))


def _range_of_sample(path: str, value: object) -> Any:
    if not isinstance(value, dict):
        return value
    _refuse_unknown(path, value, RANGE[:2])
    return tuple(value.get(key) for key in RANGE[:2])


def _outputs(given: object) -> tuple[str, ...]:
    if isinstance(given, str):
        return (given,)
    if (
        not isinstance(given, list)
        or len(given) > limits.OUTPUTS
        or not all(isinstance(x, str) for x in given)
    ):
        raise InputError(
            "outputs", _("expected a list of texts, such as {example}").format(example='["position.C"]')
        )
    return tuple(given)


def _end(key: str, given: object) -> float | str | None:
    if given is None or isinstance(given, str):
        return given
    if isinstance(given, bool) or not isinstance(given, int | float):
        raise InputError(
            key, _("expected a number or a text with a unit, got {value}").format(value=shown(given))
        )
    return float(given)


def _reduce(given: object) -> Reduce:
    if given is None or isinstance(given, str):
        return given
    if not isinstance(given, dict) or not all(isinstance(text, str) for text in given.values()):
        raise InputError("reduce", _("expected a text, or a table of formulas"))
    return given


def _text(key: str, given: object) -> str:
    if not isinstance(given, str):
        raise InputError(key, _("expected a text, got {value}").format(value=shown(given)))
    return given
