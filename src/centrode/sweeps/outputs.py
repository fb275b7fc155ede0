"""What is kept of every motion of a sweep: quantities, of everything that has them or of one point, link or guide."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.reduction import REDUCED, Values, reduced_number
from centrode.errors import InputError
from centrode.kinematics.motion import by_time, kinds_of
from centrode.kinematics.solve import Solved
from centrode.locale import _
from centrode.model.reading import nearest, value_text
from centrode.numerics.arrays import ARRAYS, Arrays
from centrode.numerics.operations import CONSTANTS, FUNCTIONS
from centrode.numerics.text_formula import TEXT_LENGTH, TextFormula, compile_formula
from centrode.quantities import QUANTITIES
from centrode.sweeps import designs
from centrode.sweeps.designs import MECHANISM, Design, Rows

Array: TypeAlias = npt.NDArray[np.float64]

COEFFICIENTS = ("velocity_coefficient", "acceleration_coefficient")
DERIVED = ("hinge_angle", "hinge_velocity", "hinge_acceleration", "polar_angle", "azimuth")
"""Quantities that a motion derives from its places and spins: sweeps have those instead."""
RESIDUAL, CONTACT = "residual", "contact"
_LENGTH = 200


@dataclass(frozen=True)
class Output:
    """Quantity of a motion, of all or of one point, link or guide.

    Attributes
    ----------
    name : str
        As it is requested: "velocity", "position.C", "position.C.x".
    quantity : str
        Its name in the vocabulary.
    where : for each dimension behind the sample an index, or all of it
    dimensions, shape : what is left of those dimensions
    attributes : units, symbol, long name
    """

    name: str
    quantity: str
    where: tuple[int | slice, ...]
    dimensions: tuple[str, ...]
    shape: tuple[int, ...]
    attributes: Mapping[str, Any]

    def of(self, solved: Solved, values: Values) -> Array:
        """Values of the output (lanes, samples, ...), bit by bit those of the motion's dataset.

        `values` are those that vary, by their paths.
        """
        if self.quantity == RESIDUAL:
            return solved.residual
        if self.quantity in REDUCED:
            return reduced_number(self.quantity, solved, values)
        if self.quantity == CONTACT:
            return solved.contacts[:, :, *self.where]
        for kind in kinds_of(solved):
            orders = [None if x is None else x[:, :, *self.where] for x in kind.orders]
            # only the part that is wanted is turned into rates by time: of a view nothing is copied
            _values, first, second = orders
            assert first is not None
            assert second is not None
            if self.quantity in kind.names:
                differentiated = by_time(
                    (_values, first, second), kind.names.index(self.quantity), solved.span
                )
                if differentiated is not None:
                    return differentiated
            by_drive = [kind.prefix + word for word in COEFFICIENTS]
            if self.quantity in by_drive:
                return (first, second)[by_drive.index(self.quantity)]
        raise InputError("outputs", _("there is no {name} here").format(name=self.name))


def outputs_of(motion: xr.Dataset, asked: Sequence[str] | str) -> tuple[Output, ...]:
    """The outputs of these names, in their order; `motion` is a motion of the mechanism.

    Raises InputError: none, twice the same, an unknown quantity, point, link, guide or axis.
    """
    names = [asked] if isinstance(asked, str) else list(asked)
    if not names:
        raise InputError("outputs", _("no output is given"), _('name one, such as "position.C" or "angle"'))
    if len(names) > designs.OUTPUTS:
        what = _("{count} outputs are given").format(count=len(names))
        raise InputError("outputs", what, _("give at most {most}").format(most=designs.OUTPUTS))
    outputs: dict[str, Output] = {}
    for name in names:
        if name in outputs:
            raise InputError("outputs", _("{name} is given twice").format(name=value_text(name)))
        outputs[name] = _output(motion, name)
    return tuple(outputs.values())


def quantities_of(motion: xr.Dataset) -> list[str]:
    """Names of the quantities that a motion has at every sample, in reading order."""
    # statuses have a column of their own
    told = [name for name in QUANTITIES if name in motion.data_vars and "sample" in motion[name].dims]
    return [name for name in told if name != "status" and name not in DERIVED]


def every_number(motion: xr.Dataset) -> Iterator[tuple[str, ...]]:
    """(quantity, label, axis) of each single number that a motion has at every sample."""
    for name in quantities_of(motion):
        rooms = [motion[dimension].values.tolist() for dimension in motion[name].dims[1:]]
        yield from ((name, *labels) for labels in _combinations(rooms))


def _combinations(rooms: list[list[str]]) -> Iterator[tuple[str, ...]]:
    if not rooms:
        yield ()
        return
    for label in rooms[0]:
        yield from ((label, *rest) for rest in _combinations(rooms[1:]))


def _output(motion: xr.Dataset, name: object) -> Output:
    if not isinstance(name, str) or len(name) > _LENGTH:
        raise InputError("outputs", _("an output is a text such as {example}").format(example='"position.C"'))
    quantity, _dot, rest = name.partition(".")
    known = quantities_of(motion)
    if quantity not in known:
        what = _("there is no quantity {name}").format(name=value_text(quantity))
        raise InputError("outputs", what, nearest(quantity, known))
    return output_of_quantity(motion, name, quantity, rest)


def output_of_quantity(motion: xr.Dataset, name: str, quantity: str, rest: str) -> Output:
    """The output of a quantity, and of the labels in `rest`: "C", "C.x", or nothing for all."""
    variable = motion[quantity]
    where: list[int | slice] = []
    left: list[str] = []
    for dimension in map(str, variable.dims[1:]):
        labels = [str(label) for label in motion[dimension].values]
        if not rest:
            where.append(slice(None))
            left.append(dimension)
            continue
        label, rest = _label(name, rest, labels)
        where.append(labels.index(label))
    if rest:
        what = _("{name} has no entry {rest}").format(name=value_text(name), rest=value_text(rest))
        raise InputError("outputs", what, _("omit it"))
    shape = tuple(motion.sizes[dimension] for dimension in left)
    return Output(name, quantity, tuple(where), tuple(left), shape, dict(variable.attrs))


def _label(name: str, rest: str, labels: list[str]) -> tuple[str, str]:
    """The longest label that `rest` begins with (labels may hold dots), and what stands behind it."""
    # the longest first: a label may begin another one
    for label in sorted(labels, key=len, reverse=True):
        if rest == label or rest.startswith(label + "."):
            return label, rest[len(label) + 1 :]
    word = rest.partition(".")[0]
    what = _("there is no {word} in {name}").format(word=value_text(word), name=value_text(name))
    raise InputError("outputs", what, nearest(word, labels))


# Many samples made one number: least, greatest, their difference, mean; samples that are not ok are left out.

Mask: TypeAlias = npt.NDArray[np.bool_]

REDUCTIONS = ("min", "max", "range", "mean")
FOLDS = frozenset((*REDUCTIONS, "sum"))
"""What formulas may do over samples; those of REDUCTIONS also stand alone."""


def fold_samples(name: str, values: Array, ok: Mask) -> Array:
    """One number of the samples (axis 1) that are ok; NaN where none is.

    Parameters
    ----------
    name : one of FOLDS
    values : (lanes, n, ...)
    ok : (lanes, n)

    Notes
    -----
    Rounding of a mean stays below n eps times the mean of the absolute values. A NaN at an ok sample makes the
    whole NaN.
    """
    # the mask against all further axes
    counted = ok.reshape(*ok.shape, *[1] * (values.ndim - 2))
    counts = counted.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        folded = np.asarray(_fold(name, values, counted, counts))
    return np.where(counts > 0, folded, np.nan)


def _fold(name: str, values: Array, counted: Mask, counts: Any) -> Any:
    if name in ("mean", "sum"):
        total = values.sum(axis=1, where=counted)
        return total / counts if name == "mean" else total
    # of `max` only the greatest is wanted; from zero it is what is taken off
    least = values.min(axis=1, where=counted, initial=np.inf) if name != "max" else 0.0
    if name == "min":
        return least
    return values.max(axis=1, where=counted, initial=-np.inf) - least


class Folding(Arrays):
    """Namespace of a formula of the motion: functions on arrays (lanes, n), and folds that give (lanes, 1)."""

    def __init__(self, ok: Mask) -> None:
        self.ok = ok

    def fold(self, name: str, values: Any) -> Array:
        """One number a mechanism of what may vary from sample to sample."""
        return fold_samples(
            name, np.broadcast_to(np.asarray(values, dtype=np.float64), self.ok.shape), self.ok
        )[:, None]


# Formulas of the motion: one number a mechanism, of anything the motion has at its samples.

VALUE = "value"
"""Name of the result of a formula that has none of its own."""
RESERVED = frozenset({"samples_ok", "worst_residual", "status", "progress", "sample", "path", MECHANISM})

# no word inside a number (1e5) or behind a dot
_WORD = re.compile(r"(?<![\w.])[^\W\d]\w*")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,39}")


@dataclass(frozen=True)
class Variable:
    """What a name in a formula stands for: a number of the motion, the time, a drive's value, a varied value."""

    kind: Literal["output", "time", "drive", "varied"]
    source: str
    output: Output | None = None

    def of(self, solved: Solved, values: Rows) -> Array:
        """Values of the variable, (lanes, n) or what broadcasts to it."""
        if self.output is not None:
            return self.output.of(solved, values)
        if self.kind == "varied":
            return np.asarray(values[self.source])[:, None]
        if self.kind == "time":
            return solved.span.time[None, :]
        path = solved.ready.kinematics.path
        drives = path.coordinates(ARRAYS, solved.span.parameter)
        return np.broadcast_to(drives[self.source], (1, len(solved.span.time)))


@dataclass(frozen=True)
class OutputFormula:
    """A formula with what its names stand for."""

    name: str
    text: TextFormula
    variables: Mapping[str, Variable]

    def of(self, solved: Solved, values: Rows, ok: Mask) -> Array:
        """Value of the formula for each mechanism (lanes,); NaN where no sample is ok."""
        given = {name: variable.of(solved, values) for name, variable in self.variables.items()}
        with np.errstate(all="ignore"):
            value = np.asarray(self.text(Folding(ok), **given), dtype=np.float64)
        # one number a mechanism stands in a column of one
        flat = np.broadcast_to(value, (len(ok), 1))[:, 0]
        return np.where(ok.any(axis=1), flat, np.nan)

    @property
    def varies(self) -> bool:
        """Whether the formula has a value at every sample, not one a mechanism."""
        # of two samples: what still has two values varies from sample to sample
        two = {
            name: np.ones((1, 1 if variable.kind == "varied" else 2))
            for name, variable in self.variables.items()
        }
        with np.errstate(all="ignore"):
            value = self.text(Folding(np.ones((1, 2), dtype=bool)), **two)
        return np.shape(value)[-1:] == (2,)

    def at_samples(self, solved: Solved, values: Rows, ok: Mask) -> Array:
        """Values of a formula of samples (lanes, n)."""
        given = {name: variable.of(solved, values) for name, variable in self.variables.items()}
        with np.errstate(all="ignore"):
            value = np.asarray(self.text(Folding(ok), **given), dtype=np.float64)
        return np.where(ok, np.broadcast_to(value, ok.shape), np.nan)

    def trace(self, m: Any, solved: Solved, values: Mapping[str, Any]) -> Any:
        """Value of the formula as an expression: `solved` is of one sample, `m` folds over samples."""
        given = {name: variable.of(solved, values).item() for name, variable in self.variables.items()}
        return self.text(m, **given)


def formulas_of(
    motion: xr.Dataset, design: Design, asked: Mapping[str, str] | str, *, of_samples: bool = False
) -> tuple[OutputFormula, ...]:
    """The formulas of these texts, with `of_samples` also those of a sample; `motion` is a motion of the mechanism.

    Raises InputError: a name that is none, an unknown variable, not a formula, a value that still varies from
    sample to sample.
    """
    texts = {VALUE: asked} if isinstance(asked, str) else dict(asked)
    if not 1 <= len(texts) <= designs.OUTPUTS:
        raise InputError("reduce", _("give 1 to {most} formulas").format(most=designs.OUTPUTS))
    known = dict(_variables(motion, design))
    return tuple(_formula(motion, name, text, known, of_samples) for name, text in texts.items())


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


def _formula(
    motion: xr.Dataset, name: object, text: object, known: Mapping[str, tuple[str, ...]], of_samples: bool
) -> OutputFormula:
    taken = isinstance(name, str) and (name in RESERVED or name in motion.dims)
    # a name that means something else in the result would hide it
    if not isinstance(name, str) or not _NAME.fullmatch(name) or taken:
        what = _("{name} cannot be the name of a result").format(name=value_text(name))
        raise InputError("reduce", what, _("use letters, digits and underscores"))
    where = "reduce" if name == VALUE else f"reduce {name}"
    if not isinstance(text, str):
        raise InputError(where, _("a formula is a text"), _('such as "range(position_C_x)"'))
    # only words of the motion become variables: a formula may have hundreds to choose from
    words = dict.fromkeys(_WORD.findall(text[:TEXT_LENGTH]))
    used = tuple(word for word in words if word in known)
    _refuse_unknown(where, words, known)
    formula = compile_formula(text, used, where, FOLDS)
    variables = {word: _variable(motion, known[word]) for word in used if word in formula.used}
    made = OutputFormula(name, formula, variables)
    if made.varies and not of_samples:
        what = _("the formula has a value at every sample, not one per mechanism")
        raise InputError(
            where, what, _("reduce the samples: min(...), max(...), range(...), mean(...), sum(...)")
        )
    return made


def _refuse_unknown(where: str, words: Iterable[str], known: Mapping[str, tuple[str, ...]]) -> None:
    """A misspelt name is reported with the nearest one: there may be hundreds."""
    for word in words:
        if word not in known and word not in CONSTANTS and word not in FUNCTIONS | FOLDS:
            what = _("unknown name {name}").format(name=value_text(word))
            raise InputError(where, what, nearest(word, [*REDUCTIONS, *known]))


def _variable(motion: xr.Dataset, words: tuple[str, ...]) -> Variable:
    if words[0] == "time":
        return Variable("time", "time")
    if words[0] == "drive":
        return Variable("drive", words[1])
    if words[0] == "varied":
        return Variable("varied", words[1])
    rest = ".".join(words[1:])
    return Variable("output", ".".join(words), output_of_quantity(motion, ".".join(words), words[0], rest))


# What a sweep computes: outputs at every sample, outputs reduced, or formulas.

AnyArray: TypeAlias = npt.NDArray[Any]
Reduce: TypeAlias = str | Mapping[str, str] | None

PATH = "path"
"""Dimension of derivatives: one for each path that varies."""


@dataclass(frozen=True)
class SweepColumn:
    """Variable of the result, the dimensions of the mechanisms left out.

    `empty` stands for mechanisms that are not computed.
    """

    name: str
    dimensions: tuple[str, ...]
    shape: tuple[int, ...]
    kind: npt.DTypeLike
    attributes: Mapping[str, Any]
    empty: float | int = np.nan

    @property
    def bytes(self) -> int:
        """Memory [bytes] of the column for one mechanism."""
        return int(np.prod(self.shape, dtype=np.int64)) * np.dtype(self.kind).itemsize


JUDGED = (
    SweepColumn("samples_ok", (), (), np.int32, {"units": "1", "long_name": "samples that are ok"}, -1),
    SweepColumn("worst_residual", (), (), np.float64, {"units": "1", "long_name": "worst closure residual"}),
)
"""What every result says of each mechanism."""


@dataclass(frozen=True)
class SweepOutputs:
    """Outputs, reduced by one of REDUCTIONS or not at all, or formulas; `columns` are those of the result."""

    outputs: tuple[Output, ...]
    reduction: str | None
    formulas: tuple[OutputFormula, ...]
    columns: tuple[SweepColumn, ...] = field(compare=False)

    @property
    def slopes(self) -> dict[str, str]:
        """Column -> the column of its derivatives, where these are requested."""
        names = {column.name for column in self.columns}
        return {name: slope_of(name) for name in names if slope_of(name) in names}

    @property
    def is_reduced(self) -> bool:
        """Whether a mechanism has one number of its samples."""
        return bool(self.reduction or self.formulas)

    def results(self, solved: Solved, values: Rows, ok: npt.NDArray[np.bool_]) -> dict[str, AnyArray]:
        """The columns of some mechanisms (lanes, ...) from their motion, but for those of JUDGED."""
        if self.formulas:
            return {formula.name: formula.of(solved, values, ok) for formula in self.formulas}
        if self.reduction is not None:
            return {
                output.name: fold_samples(self.reduction, output.of(solved, values), ok)
                for output in self.outputs
            }
        return {"status": solved.status} | {output.name: output.of(solved, values) for output in self.outputs}


def slope_of(name: str) -> str:
    """Name of the derivatives of a reduced column."""
    return f"gradient.{name}"


def with_slopes(asked: SweepOutputs, paths: int) -> SweepOutputs:
    """Sweep outputs with the derivatives of every reduced column by the values that vary.

    Raises InputError where nothing is reduced.
    """
    if not asked.is_reduced:
        what = _("derivatives are those of reduced outputs")
        raise InputError("gradient", what, _("give a reduction"))
    reduced = [column for column in asked.columns if column not in JUDGED]
    words = "derivatives by the varied values [SI]; NaN for mechanisms that are not ok everywhere or meet an event"
    slopes = [
        SweepColumn(
            slope_of(column.name),
            (*column.dimensions, PATH),
            (*column.shape, paths),
            np.float64,
            {"long_name": f"derivatives of {column.name}", "comment": words},
        )
        for column in reduced
    ]
    return replace(asked, columns=(*reduced, *slopes, *JUDGED))


def asked_of(
    motion: xr.Dataset, design: Design, outputs: Sequence[str] | str | None, reduce: Reduce
) -> SweepOutputs:
    """Outputs that these arguments of `sweep` mean; `motion` is a motion of the mechanism. Raises InputError."""
    if reduce is None or (isinstance(reduce, str) and reduce in REDUCTIONS):
        listed = outputs_of(motion, outputs if outputs is not None else ())
        return SweepOutputs(listed, reduce, (), _columns(motion, listed, reduce))
    if not isinstance(reduce, str | Mapping):
        raise InputError(
            "reduce", _("it is one of {names}, or a formula").format(names=", ".join(REDUCTIONS))
        )
    if isinstance(reduce, str) and reduce.isidentifier():
        what = _("unknown reduction {name}").format(name=value_text(reduce))
        raise InputError("reduce", what, nearest(reduce, REDUCTIONS))
    if outputs:
        raise InputError(
            "outputs",
            _("formulas request the outputs they use themselves"),
            _("omit outputs, or reduce by one of {names}").format(names=", ".join(REDUCTIONS)),
        )
    formulas = formulas_of(motion, design, reduce)
    columns = tuple(
        SweepColumn(
            formula.name, (), (), np.float64, {"long_name": formula.name, "formula": formula.text.text}
        )
        for formula in formulas
    )
    return SweepOutputs((), None, formulas, (*columns, *JUDGED))


def _columns(
    motion: xr.Dataset, outputs: tuple[Output, ...], reduction: str | None
) -> tuple[SweepColumn, ...]:
    along: tuple[str, ...] = () if reduction else ("sample",)
    count = () if reduction else (motion.sizes["sample"],)
    more = {"reduction": reduction} if reduction else {}
    columns = [
        SweepColumn(x.name, along + x.dimensions, count + x.shape, np.float64, {**x.attributes, **more})
        for x in outputs
    ]
    if reduction is None:
        attributes = {
            key: value.tolist() if isinstance(value, np.ndarray) else value
            for key, value in motion["status"].attrs.items()
        }
        columns.append(SweepColumn("status", along, count, np.int8, attributes, -1))
    return (*columns, *JUDGED)
