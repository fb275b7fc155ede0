"""Formulas of the motion: one number a mechanism, of anything the motion has at its samples."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.text import TEXT_LENGTH, TextFormula, compile_formula
from centrode.algebra.vocabulary import CONSTANTS, FUNCTIONS
from centrode.errors import InputError
from centrode.kinematics.solve import Solved
from centrode.locale import _
from centrode.model.problems import nearest, shown
from centrode.sweeps import limits
from centrode.sweeps.designs import MECHANISM, Design, Rows
from centrode.sweeps.outputs import Output, every_number, numbered
from centrode.sweeps.reductions import FOLDS, REDUCTIONS, Folding

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]

VALUE = "value"
"""Name of the result of a formula that has none of its own."""
RESERVED = frozenset({"samples_ok", "worst_residual", "status", "progress", "sample", "path", MECHANISM})

_WORD = re.compile(r"(?<![\w.])[^\W\d]\w*")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,39}")


@dataclass(frozen=True)
class Variable:
    """What a name in a formula stands for: a number of the motion, the time, a drive's value, a varied value."""

    kind: Literal["output", "time", "drive", "varied"]
    source: str
    output: Output | None = None

    def of(self, solved: Solved, values: Rows) -> Array:
        """Its values, (lanes, n) or what broadcasts to it."""
        if self.output is not None:
            return self.output.of(solved, values)
        if self.kind == "varied":
            return np.asarray(values[self.source])[:, None]
        if self.kind == "time":
            return solved.span.time[None, :]
        path = solved.ready.kinematics.path
        drives = path.drive_values(ARRAYS, solved.span.parameter)
        return np.broadcast_to(drives[self.source], (1, len(solved.span.time)))


@dataclass(frozen=True)
class Formula:
    """A formula with what its names stand for."""

    name: str
    text: TextFormula
    variables: Mapping[str, Variable]

    def of(self, solved: Solved, values: Rows, ok: Mask) -> Array:
        """Its value for each mechanism (lanes,); NaN where no sample is ok."""
        given = {name: variable.of(solved, values) for name, variable in self.variables.items()}
        with np.errstate(all="ignore"):
            found = np.asarray(self.text(Folding(ok), **given), dtype=np.float64)
        flat = np.broadcast_to(found, (len(ok), 1))[:, 0]
        return np.where(ok.any(axis=1), flat, np.nan)

    def traced(self, m: Any, solved: Solved, values: Mapping[str, Any]) -> Any:
        """Its value where numbers are expressions: `solved` is of one sample, `m` folds."""
        given = {name: variable.of(solved, values).item() for name, variable in self.variables.items()}
        return self.text(m, **given)


def formulas_of(motion: xr.Dataset, design: Design, asked: Mapping[str, str] | str) -> tuple[Formula, ...]:
    """The formulas of these texts; `motion` is a motion of the mechanism.

    Raises InputError: a name that is none, an unknown variable, not a formula, a value that still varies from
    sample to sample.
    """
    texts = {VALUE: asked} if isinstance(asked, str) else dict(asked)
    if not 1 <= len(texts) <= limits.OUTPUTS:
        raise InputError("reduce", _("give 1 to {most} formulas").format(most=limits.OUTPUTS))
    known = dict(_variables(motion, design))
    return tuple(_formula(motion, name, text, known) for name, text in texts.items())


def identifier(*words: str) -> str:
    """The name that a formula may use: words joined by _, which also stands for signs a name cannot have."""
    return "_".join(re.sub(r"\W", "_", word) for word in words)


def _variables(motion: xr.Dataset, design: Design) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Name -> what it stands for, as words."""
    yield "time", ("time",)
    for drive in motion["drive"].values.tolist():
        yield identifier("drive", drive), ("drive", drive)
    for path in design.coordinates:
        yield identifier(path), ("varied", path)
    for words in every_number(motion):
        yield identifier(*words), words


def _formula(motion: xr.Dataset, name: object, text: object, known: Mapping[str, tuple[str, ...]]) -> Formula:
    taken = isinstance(name, str) and (name in RESERVED or name in motion.dims)
    if not isinstance(name, str) or not _NAME.fullmatch(name) or taken:
        what = _("{name} cannot be the name of a result").format(name=shown(name))
        raise InputError("reduce", what, _("use letters, digits and underscores"))
    where = "reduce" if name == VALUE else f"reduce {name}"
    if not isinstance(text, str):
        raise InputError(where, _("a formula is a text"), _('such as "range(position_C_x)"'))
    words = dict.fromkeys(_WORD.findall(text[:TEXT_LENGTH]))
    used = tuple(word for word in words if word in known)
    _refuse_unknown(where, words, known)
    formula = compile_formula(text, used, where, FOLDS)
    variables = {word: _variable(motion, known[word]) for word in used if word in formula.used}
    _refuse_varying(where, formula, variables)
    return Formula(name, formula, variables)


def _refuse_unknown(where: str, words: Iterable[str], known: Mapping[str, tuple[str, ...]]) -> None:
    """A misspelt name is told with the nearest one: there may be hundreds."""
    for word in words:
        if word not in known and word not in CONSTANTS and word not in FUNCTIONS | FOLDS:
            what = _("unknown name {name}").format(name=shown(word))
            raise InputError(where, what, nearest(word, [*REDUCTIONS, *known]))


def _variable(motion: xr.Dataset, words: tuple[str, ...]) -> Variable:
    if words[0] == "time":
        return Variable("time", "time")
    if words[0] == "drive":
        return Variable("drive", words[1])
    if words[0] == "varied":
        return Variable("varied", words[1])
    rest = ".".join(words[1:])
    return Variable("output", ".".join(words), numbered(motion, ".".join(words), words[0], rest))


def _refuse_varying(where: str, formula: TextFormula, variables: Mapping[str, Variable]) -> None:
    """The value must be one number a mechanism: two samples tell."""
    two = {name: np.ones((1, 1 if variable.kind == "varied" else 2)) for name, variable in variables.items()}
    with np.errstate(all="ignore"):
        found = formula(Folding(np.ones((1, 2), dtype=bool)), **two)
    if np.shape(found)[-1:] == (2,):
        what = _("the formula has a value at every sample, not one a mechanism")
        raise InputError(
            where, what, _("say of which sample: min(...), max(...), range(...), mean(...), sum(...)")
        )
