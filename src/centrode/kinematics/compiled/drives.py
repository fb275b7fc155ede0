"""Several drives in a traced plan: their values and rates are variables of a place on the path.

A law is not traced: what it gives at the places is computed by the arrays, once for all mechanisms. Derivatives that
are the same everywhere stay numbers, so that plans skip their zeros as the arrays do.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expressions import Operand, variable
from centrode.algebra.jets import Jet
from centrode.kinematics.compiled.variables import PARAMETER, boxed, times_of
from centrode.kinematics.paths import JETS, Path
from centrode.kinematics.sampling import ORDERS
from centrode.kinematics.spans import Span

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class TracedPath(Path):
    """A path of several drives, the value of each with its derivatives as variables."""

    known: Mapping[str, Number] = field(default_factory=dict)

    def drive_values(self, m: Namespace, parameter: Number) -> dict[str, Number]:
        """Jets where the parameter is one, else values."""
        if isinstance(parameter, Jet):
            return dict(self.known)
        values = {drive: x.value if isinstance(x, Jet) else x for drive, x in self.known.items()}
        if isinstance(parameter, np.ndarray):
            return {drive: boxed([x]) for drive, x in values.items()}
        return values


def traced_path(path: Path, parameter: Array, order: int) -> Path:
    """The path as a plan is traced with; `parameter` are some of its places."""
    if not path.by_time:
        return path
    known: dict[str, Number] = {}
    for drive, value in _jets(path, parameter, order).items():
        known[drive] = value
        if isinstance(value, Jet):
            known[drive] = Jet([_operand(drive, k, x) for k, x in enumerate(value.coefficients)])
    whole = {each.name: getattr(path, each.name) for each in fields(Path)}
    return TracedPath(**whole, known=known)


def places_of(path: Path, parameter: Array, order: int) -> dict[str, Array]:
    """What the variables of places on the path stand for at parameters: name -> (n,)."""
    found = {PARAMETER: parameter}
    if not path.by_time:
        return found
    for drive, value in _jets(path, parameter, order).items():
        if isinstance(value, Jet):
            rows = (np.broadcast_to(x, parameter.shape) for x in value.coefficients)
            found |= {_name(drive, k): row for k, row in enumerate(rows)}
    return found


def inputs_of(path: Path, span: Span) -> dict[str, Array]:
    """What the variables of a place stand for at the samples of a span: name -> (samples,)."""
    return {**places_of(path, span.parameter, ORDERS - 1), **times_of(span)}


def winders_of(path: Path) -> dict[str, Operand]:
    """What links may turn with: the drive's value, or those of several drives."""
    if not path.by_time:
        return {path.driven[0].drive.id: variable(PARAMETER)}
    values = path.drive_values(None, variable(PARAMETER))
    return {one.drive.id: values[one.drive.id] for one in path.driven if one.drive.kind == "angle"}


def _jets(path: Path, parameter: Array, order: int) -> dict[str, Number]:
    with np.errstate(all="ignore"):
        return Path.drive_values(path, JETS, Jet.variable(parameter, order))


def _operand(drive: str, k: int, coefficient: Number) -> Operand:
    return variable(_name(drive, k)) if np.ndim(coefficient) else float(coefficient)


def _name(drive: str, k: int) -> str:
    return f"drive {drive}, {k}"
