"""What a sweep is asked for: outputs at every sample, outputs reduced, or formulas."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError
from centrode.kinematics.solve import Solved
from centrode.locale import _
from centrode.model.problems import nearest, shown
from centrode.sweeps.designs import Design, Rows
from centrode.sweeps.formulas import Formula, formulas_of
from centrode.sweeps.outputs import Output, outputs_of
from centrode.sweeps.reductions import REDUCTIONS, folded

AnyArray: TypeAlias = npt.NDArray[Any]
Reduce: TypeAlias = str | Mapping[str, str] | None

PATH = "path"
"""Dimension of derivatives: one for each path that varies."""


@dataclass(frozen=True)
class Column:
    """One variable of the result, the dimensions of the mechanisms left out.

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
        """What it takes for one mechanism."""
        return int(np.prod(self.shape, dtype=np.int64)) * np.dtype(self.kind).itemsize


JUDGED = (
    Column("samples_ok", (), (), np.int32, {"units": "1", "long_name": "samples that are ok"}, -1),
    Column("worst_residual", (), (), np.float64, {"units": "1", "long_name": "worst closure residual"}),
)
"""What every result says of each mechanism."""


@dataclass(frozen=True)
class Asked:
    """Outputs, reduced by one of REDUCTIONS or not at all, or formulas; `columns` are those of the result."""

    outputs: tuple[Output, ...]
    reduction: str | None
    formulas: tuple[Formula, ...]
    columns: tuple[Column, ...] = field(compare=False)

    @property
    def slopes(self) -> dict[str, str]:
        """Column -> the column of its derivatives, where these are asked for."""
        names = {column.name for column in self.columns}
        return {name: slope_of(name) for name in names if slope_of(name) in names}

    @property
    def reduced(self) -> bool:
        """Whether a mechanism has one number of its samples."""
        return bool(self.reduction or self.formulas)

    def results(self, solved: Solved, values: Rows, ok: npt.NDArray[np.bool_]) -> dict[str, AnyArray]:
        """The columns of some mechanisms (lanes, ...) from their motion, but for those of JUDGED."""
        if self.formulas:
            return {formula.name: formula.of(solved, values, ok) for formula in self.formulas}
        if self.reduction is not None:
            return {
                output.name: folded(self.reduction, output.of(solved, values), ok) for output in self.outputs
            }
        return {"status": solved.status} | {output.name: output.of(solved, values) for output in self.outputs}


def slope_of(name: str) -> str:
    """Name of the derivatives of a reduced column."""
    return f"gradient.{name}"


def with_slopes(asked: Asked, paths: int) -> Asked:
    """The same with the derivatives of every reduced column by the values that vary.

    Raises InputError where nothing is reduced.
    """
    if not asked.reduced:
        what = _("derivatives are those of reduced outputs")
        raise InputError("gradient", what, _("say how to reduce them"))
    reduced = [column for column in asked.columns if column not in JUDGED]
    words = "derivatives by the varied values [SI]; NaN for mechanisms that are not ok everywhere or meet an event"
    slopes = [
        Column(
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
) -> Asked:
    """What these arguments of `sweep` mean; `motion` is a motion of the mechanism. Raises InputError."""
    if reduce is None or (isinstance(reduce, str) and reduce in REDUCTIONS):
        found = outputs_of(motion, outputs if outputs is not None else ())
        return Asked(found, reduce, (), _columns(motion, found, reduce))
    if not isinstance(reduce, str | Mapping):
        raise InputError(
            "reduce", _("it is one of {names}, or a formula").format(names=", ".join(REDUCTIONS))
        )
    if isinstance(reduce, str) and reduce.isidentifier():
        what = _("unknown reduction {name}").format(name=shown(reduce))
        raise InputError("reduce", what, nearest(reduce, REDUCTIONS))
    if outputs:
        raise InputError(
            "outputs",
            _("formulas name what they use themselves"),
            _("leave outputs out, or reduce by one of {names}").format(names=", ".join(REDUCTIONS)),
        )
    formulas = formulas_of(motion, design, reduce)
    columns = tuple(
        Column(formula.name, (), (), np.float64, {"long_name": formula.name, "formula": formula.text.text})
        for formula in formulas
    )
    return Asked((), None, formulas, (*columns, *JUDGED))


def _columns(motion: xr.Dataset, outputs: tuple[Output, ...], reduction: str | None) -> tuple[Column, ...]:
    along: tuple[str, ...] = () if reduction else ("sample",)
    count = () if reduction else (motion.sizes["sample"],)
    more = {"reduction": reduction} if reduction else {}
    found = [
        Column(x.name, along + x.dimensions, count + x.shape, np.float64, {**x.attributes, **more})
        for x in outputs
    ]
    if reduction is None:
        attributes = {
            key: value.tolist() if isinstance(value, np.ndarray) else value
            for key, value in motion["status"].attrs.items()
        }
        found.append(Column("status", along, count, np.int8, attributes, -1))
    return (*found, *JUDGED)
