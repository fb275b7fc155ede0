"""What is kept of every motion of a sweep: quantities, of everything that has them or of one point, link or guide."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.kinetostatics.reaction_expressions import REACTIONS, reaction_number
from centrode.dynamics.reduction import REDUCED, Values, reduced_number
from centrode.errors import InputError
from centrode.kinematics.hinge_angles import HINGE_ANGLES
from centrode.kinematics.motion import by_time, hinge_orders, kinds_of
from centrode.kinematics.solve import Solved
from centrode.locale import _
from centrode.model.reading import nearest, value_text
from centrode.numerics.arrays import ARRAYS, Arrays
from centrode.numerics.operations import CONSTANTS, FUNCTIONS
from centrode.numerics.text_formula import TEXT_LENGTH, TextFormula, compile_formula
from centrode.quantities import QUANTITIES
from centrode.sweeps import designs
from centrode.sweeps.designs import MECHANISM, Design, Rows
from centrode.sweeps.sample_tables import NAME, SampleTable, common_known, tables_of

Array: TypeAlias = npt.NDArray[np.float64]

COEFFICIENTS = ("velocity_coefficient", "acceleration_coefficient")
DERIVED = ("polar_angle", "azimuth")
"""Quantities that a motion derives from its places: sweeps have those instead."""
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
        if self.quantity in REACTIONS:
            return reaction_number(self.quantity, solved, values)[:, :, *self.where]
        if self.quantity == CONTACT:
            return solved.contacts[:, :, *self.where]
        if self.quantity in HINGE_ANGLES:
            return self._at_hinges(solved)
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

    def _at_hinges(self, solved: Solved) -> Array:
        orders = hinge_orders(solved)
        assert orders is not None, "expressions know no turns: such outputs are left to the arrays"
        value, first, second = orders
        assert value is not None
        value, first, second = (x[:, :, *self.where] for x in (value, first, second))
        found = by_time((value, first, second), HINGE_ANGLES.index(self.quantity), solved.span)
        assert found is not None
        return found


def outputs_of(motion: xr.Dataset, asked: Sequence[str] | str) -> tuple[Output, ...]:
    """The outputs of these names, in their order; `motion` is a motion of the mechanism.

    Raises InputError: none, twice the same, an unknown quantity, point, link, guide or axis.
    """
    given: object = asked
    if not isinstance(given, Iterable):
        what = _("an output is a text such as {example}").format(example='"position.C"')
        raise InputError("outputs", what)
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


TABLE = "table"
"""Before the name of a table: the variable of its numbers. No path of a number has a space."""


@dataclass(frozen=True)
class Variable:
    """What a name in a formula stands for.

    A number of the motion, the time, a drive's value, a varied value, a table, a formula before this one.
    """

    kind: Literal["output", "time", "drive", "varied", "table", "formula"]
    source: str
    output: Output | None = None

    def of(self, solved: Solved, values: Rows, tables: Mapping[str, SampleTable]) -> Array:
        """Values of the variable, (lanes, n) or what broadcasts to it."""
        if self.output is not None:
            return self.output.of(solved, values)
        if self.kind == "varied":
            return np.asarray(values[self.source])[:, None]
        if self.kind == TABLE:
            # of a traced motion the table is a variable as well
            own = table_variable(self.source)
            return np.asarray(values[own])[:, None] if own in values else tables[self.source].values[None, :]
        if self.kind == "time":
            return solved.span.time[None, :]
        path = solved.ready.kinematics.path
        drives = path.coordinates(ARRAYS, solved.span.parameter)
        return np.broadcast_to(drives[self.source], (1, len(solved.span.time)))


def table_variable(name: str) -> str:
    """Name of the variable of a table's numbers."""
    return f"{TABLE} {name}"


@dataclass(frozen=True)
class OutputFormula:
    """A formula with what its names stand for.

    Attributes
    ----------
    tables : those that it names, itself or by way of other formulas
    at_samples : whether it has a value at every sample, else one of a mechanism
    reduction : one of REDUCTIONS, by which what it gives at the samples is made one number
    """

    name: str
    text: TextFormula
    variables: Mapping[str, Variable]
    tables: Mapping[str, SampleTable] = field(default_factory=dict, compare=False)
    at_samples: bool = False
    reduction: str | None = None

    @property
    def known(self) -> Mask | None:
        """The samples at which its tables have numbers, (n,); None where that is everywhere."""
        return common_known(list(self.tables.values()))

    def of(self, solved: Solved, values: Rows, ok: Mask, before: dict[str, Any]) -> Array:
        """Value of the formula for each mechanism (lanes,), NaN where no sample is ok; or at each sample (lanes, n).

        `before` are values of the formulas before this one; its own is put there too.
        """
        known = self.known
        counted = ok if known is None else ok & known
        with np.errstate(all="ignore"):
            value = np.asarray(
                self._value(Folding(counted), self._values_of_variables(solved, values, before)),
                dtype=np.float64,
            )
        before[self.name] = value
        if self.at_samples:
            everywhere = np.broadcast_to(value, ok.shape)
            return everywhere if known is None else np.where(known, everywhere, np.nan)
        # one number a mechanism stands in a column of one
        flat = np.broadcast_to(value, (len(ok), 1))[:, 0]
        return np.where(counted.any(axis=1), flat, np.nan)

    def trace(self, m: Any, solved: Solved, values: Mapping[str, Any], before: dict[str, Any]) -> Any:
        """Value of the formula as an expression: `solved` is of one sample, `m` folds over samples."""
        before[self.name] = value = self._value(
            m, self._values_of_variables(solved, values, before, of_one=True)
        )
        return value

    def _value(self, m: Any, given: Mapping[str, Any]) -> Any:
        value = self.text(m, **given)
        return value if self.reduction is None else m.fold(self.reduction, value)

    def _values_of_variables(
        self, solved: Solved, values: Mapping[str, Any], before: Mapping[str, Any], *, of_one: bool = False
    ) -> dict[str, Any]:
        given: dict[str, Any] = {}
        for name, variable in self.variables.items():
            if variable.kind == "formula":
                given[name] = before[variable.source]
            else:
                value = variable.of(solved, values, self.tables)
                given[name] = value.item() if of_one else value
        return given


def formulas_of(
    motion: xr.Dataset,
    design: Design,
    asked: Mapping[str, str] | str,
    tables: Mapping[str, SampleTable],
    where: str = "reduce",
    reduction: str | None = None,
) -> tuple[OutputFormula, ...]:
    """The formulas of these texts, with `of_samples` also those of a sample; `motion` is a motion of the mechanism.

    A formula may name those before it. What varies from sample to sample is refused under `where` = "reduce"; as
    "outputs" it has a value at every sample, or is reduced by `reduction`.

    Raises InputError: a name that is none, an unknown variable, not a formula.
    """
    texts = {VALUE: asked} if isinstance(asked, str) else dict(asked)
    if not 1 <= len(texts) <= designs.OUTPUTS:
        raise InputError(where, _("give 1 to {most} formulas").format(most=designs.OUTPUTS))
    reader = _Formulas(motion, dict(names_of_motion(motion, design)), tables, where, reduction)
    for name, text in texts.items():
        reader.read(name, text)
    return tuple(reader.found.values())


def identifier(*words: str) -> str:
    """The name that a formula may use: words joined by _, which also stands for signs a name cannot have."""
    return "_".join(re.sub(r"\W", "_", word) for word in words)


def names_of_motion(motion: xr.Dataset, design: Design) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Name -> what it stands for in a formula, as words."""
    yield "time", ("time",)
    for drive in motion["drive"].values.tolist():
        yield identifier("drive", drive), ("drive", drive)
    for path in design.paths:
        yield identifier(path), ("varied", path)
    for words in every_number(motion):
        yield identifier(*words), words


class _Formulas:
    """Reads formulas one after the other; `found` are those read so far."""

    def __init__(
        self,
        motion: xr.Dataset,
        known: Mapping[str, tuple[str, ...]],
        tables: Mapping[str, SampleTable],
        where: str,
        reduction: str | None,
    ) -> None:
        self._motion, self._tables, self._where, self._reduction = motion, tables, where, reduction
        self._known = {**known, **{name: (TABLE, name) for name in tables}}
        self.found: dict[str, OutputFormula] = {}

    def read(self, name: object, text: object) -> None:
        """Add a formula to `found`."""
        motion = self._motion
        taken = isinstance(name, str) and (
            name in RESERVED or name in motion.dims or name in motion.coords or name in self._tables
        )
        # a name that means something else in the result would hide it
        if not isinstance(name, str) or not NAME.fullmatch(name) or taken:
            what = _("{name} cannot be the name of a result").format(name=value_text(name))
            raise InputError(self._where, what, _("use letters, digits and underscores"))
        where = self._where if name == VALUE else f"{self._where} {name}"
        if not isinstance(text, str):
            raise InputError(where, _("a formula is a text"), _('such as "range(position_C_x)"'))
        # a number of the motion comes before a formula of the same name
        known = {**{other: ("formula", other) for other in self.found}, **self._known}
        # only words of the motion become variables: a formula may have hundreds to choose from
        words = dict.fromkeys(_WORD.findall(text[:TEXT_LENGTH]))
        used = tuple(word for word in words if word in known)
        _refuse_unknown(where, words, known)
        formula = compile_formula(text, used, where, FOLDS)
        variables = {word: _variable(motion, known[word]) for word in used if word in formula.used}
        varying = self._varies(formula, variables)
        if varying and self._where == "reduce":
            what = _("the formula has a value at every sample, not one per mechanism")
            raise InputError(
                where, what, _("reduce the samples: min(...), max(...), range(...), mean(...), sum(...)")
            )
        tables = self._tables_of(where, variables)
        reduction = self._reduction if varying else None
        at_samples = varying and reduction is None
        self.found[name] = OutputFormula(name, formula, variables, tables, at_samples, reduction)

    def _varies(self, formula: TextFormula, variables: Mapping[str, Variable]) -> bool:
        """Whether the value is not one number a mechanism: two samples tell."""
        # of two samples: what still has two values varies from sample to sample
        two = {name: np.ones((1, self._values_of(variable))) for name, variable in variables.items()}
        with np.errstate(all="ignore"):
            value = formula(Folding(np.ones((1, 2), dtype=bool)), **two)
        return np.shape(value)[-1:] == (2,)

    def _values_of(self, variable: Variable) -> int:
        """How many values a variable has at two samples."""
        if variable.kind == "formula":
            return 2 if self.found[variable.source].at_samples else 1
        return 1 if variable.kind == "varied" else 2

    def _tables_of(self, where: str, variables: Mapping[str, Variable]) -> dict[str, SampleTable]:
        """The tables that a formula names; those of a formula that has one number already are that one's own affair."""
        tables: dict[str, SampleTable] = {}
        for variable in variables.values():
            if variable.kind == TABLE:
                tables[variable.source] = self._tables[variable.source]
            elif variable.kind == "formula" and self.found[variable.source].at_samples:
                tables |= self.found[variable.source].tables
        known = common_known(list(tables.values()))
        if known is not None and not known.any():
            what = _("at no sample do all of its tables have a value: {names}").format(
                names=", ".join(tables)
            )
            raise InputError(where, what, _("give one value or more"))
        return tables


def _refuse_unknown(where: str, words: Iterable[str], known: Mapping[str, tuple[str, ...]]) -> None:
    """A misspelt name is reported with the nearest one: there may be hundreds."""
    for word in words:
        if word not in known and word not in CONSTANTS and word not in FUNCTIONS | FOLDS:
            what = _("unknown name {name}").format(name=value_text(word))
            raise InputError(where, what, nearest(word, [*REDUCTIONS, *known]))


def _variable(motion: xr.Dataset, words: tuple[str, ...]) -> Variable:
    kind, *rest = words
    if kind in ("time", "drive", "varied", TABLE, "formula"):
        return Variable(kind, words[-1])  # type: ignore[arg-type]
    name = ".".join(words)
    return Variable("output", name, output_of_quantity(motion, name, kind, ".".join(rest)))


# What a sweep computes: outputs at every sample, outputs reduced, or formulas.

AnyArray: TypeAlias = npt.NDArray[Any]
Reduce: TypeAlias = str | Mapping[str, str] | None

PATH, SAMPLE = "path", "sample"
"""Dimension of derivatives, one for each path that varies; and that of samples."""


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
    def at_samples(self) -> bool:
        """Whether it has a number, or more, of every sample."""
        return self.dimensions[:1] == (SAMPLE,)

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
    tables: Mapping[str, SampleTable] = field(default_factory=dict, compare=False)

    @property
    def slopes(self) -> dict[str, str]:
        """Column -> the column of its derivatives, where these are requested."""
        names = {column.name for column in self.columns}
        return {name: slope_of(name) for name in names if slope_of(name) in names}

    @property
    def is_reduced(self) -> bool:
        """Whether nothing is kept of every sample."""
        return not any(column.at_samples for column in self.columns)

    @property
    def has_hinge_angles(self) -> bool:
        """Whether an angle at a hinge is requested, whose turns are counted on the mesh of the path."""
        of_formulas = (x.output for formula in self.formulas for x in formula.variables.values())
        asked = (*self.outputs, *(output for output in of_formulas if output is not None))
        return any(output.quantity in HINGE_ANGLES for output in asked)

    def results(self, solved: Solved, values: Rows, ok: npt.NDArray[np.bool_]) -> dict[str, AnyArray]:
        """The columns of some mechanisms (lanes, ...) from their motion, but for those of JUDGED."""
        if self.formulas:
            before: dict[str, Any] = {}
            found = {formula.name: formula.of(solved, values, ok, before) for formula in self.formulas}
            return found if self.is_reduced else {"status": solved.status} | found
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
    """Sweep outputs with the derivatives of every column by the values that vary."""
    told = [column for column in asked.columns if column in JUDGED or column.name == STATUS]
    numbers = [column for column in asked.columns if column not in told]
    words = "derivatives by the varied values [SI]; NaN for mechanisms that are not ok everywhere or meet an event"
    slopes = [
        SweepColumn(
            slope_of(column.name),
            (*column.dimensions, PATH),
            (*column.shape, paths),
            np.float64,
            {"long_name": f"derivatives of {column.name}", "comment": words},
        )
        for column in numbers
    ]
    return replace(asked, columns=(*numbers, *slopes, *told))


Outputs: TypeAlias = Sequence[str] | str | Mapping[str, str] | None
"""Names of outputs, or name -> formula."""


def asked_of(
    motion: xr.Dataset, design: Design, outputs: Outputs, reduce: Reduce, tables: object = None
) -> SweepOutputs:
    """Outputs that these arguments of `sweep` mean; `motion` is a motion of the mechanism. Raises InputError."""
    names = dict(names_of_motion(motion, design)) if tables is not None else {}
    taken = {*names, *map(str, motion.dims), *map(str, motion.coords), *RESERVED}
    found = tables_of(tables, motion.sizes[SAMPLE], taken, FOLDS)
    if not isinstance(reduce, str | Mapping | None):
        raise InputError(
            "reduce", _("it is one of {names}, or a formula").format(names=", ".join(REDUCTIONS))
        )
    if isinstance(outputs, Mapping):
        if reduce is not None and reduce not in REDUCTIONS:
            what = _("outputs are formulas already")
            raise InputError(
                "reduce", what, _("omit it, or reduce by one of {names}").format(names=", ".join(REDUCTIONS))
            )
        assert reduce is None or isinstance(reduce, str)
        return _asked_formulas(formulas_of(motion, design, outputs, found, "outputs", reduce), motion, found)
    if reduce is None or (isinstance(reduce, str) and reduce in REDUCTIONS):
        if found:
            what = _("no formula is given that could name them")
            raise InputError("tables", what, _("omit them, or give formulas as outputs"))
        listed = outputs_of(motion, outputs if outputs is not None else ())
        return SweepOutputs(listed, reduce, (), _columns(motion, listed, reduce))
    if isinstance(reduce, str) and reduce.isidentifier():
        what = _("unknown reduction {name}").format(name=value_text(reduce))
        raise InputError("reduce", what, nearest(reduce, REDUCTIONS))
    if outputs:
        raise InputError(
            "outputs",
            _("formulas request the outputs they use themselves"),
            _("omit outputs, or reduce by one of {names}").format(names=", ".join(REDUCTIONS)),
        )
    return _asked_formulas(formulas_of(motion, design, reduce, found), motion, found)


def _asked_formulas(
    formulas: tuple[OutputFormula, ...], motion: xr.Dataset, tables: Mapping[str, SampleTable]
) -> SweepOutputs:
    """What formulas ask for; of the tables those that are named."""
    columns = []
    for formula in formulas:
        attributes = {"long_name": formula.name, "formula": formula.text.text}
        if formula.reduction is not None:
            attributes["reduction"] = formula.reduction
        along, count = ((SAMPLE,), (motion.sizes[SAMPLE],)) if formula.at_samples else ((), ())
        columns.append(SweepColumn(formula.name, along, count, np.float64, attributes))
    if any(column.at_samples for column in columns):
        columns.append(_status_column(motion))
    used = {name for formula in formulas for name in formula.tables}
    named = {name: table for name, table in tables.items() if name in used}
    return SweepOutputs((), None, formulas, (*columns, *JUDGED), named)


def _columns(
    motion: xr.Dataset, outputs: tuple[Output, ...], reduction: str | None
) -> tuple[SweepColumn, ...]:
    along: tuple[str, ...] = () if reduction else (SAMPLE,)
    count = () if reduction else (motion.sizes[SAMPLE],)
    more = {"reduction": reduction} if reduction else {}
    columns = [
        SweepColumn(x.name, along + x.dimensions, count + x.shape, np.float64, {**x.attributes, **more})
        for x in outputs
    ]
    if reduction is None:
        columns.append(_status_column(motion))
    return (*columns, *JUDGED)


STATUS = "status"


def _status_column(motion: xr.Dataset) -> SweepColumn:
    """The status of every sample."""
    attributes = {
        key: value.tolist() if isinstance(value, np.ndarray) else value
        for key, value in motion[STATUS].attrs.items()
    }
    return SweepColumn(STATUS, (SAMPLE,), (motion.sizes[SAMPLE],), np.int8, attributes, -1)
