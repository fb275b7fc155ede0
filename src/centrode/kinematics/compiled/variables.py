"""What is a variable in a traced plan: the numbers of a batch, and the place on the path."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Operand, variable
from centrode.algebra.jet_functions import JetFunctions
from centrode.kinematics.spans import Span
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]
Number: TypeAlias = Any

NODE_JETS = JetFunctions(EXPRESSIONS)
PARAMETER, TIME, RATE, SECOND_RATE, SCALE = "parameter", "time", "rate", "second rate", "scale"
STEP, SHARE, FIRST, SAMPLE = "step", "share", "first", "sample"
"""Of a walk along the path: how far the place before is, how often that goes into the longest step, whether there is
none, whether the place is a sample."""
ALONG = (PARAMETER, TIME, RATE, SECOND_RATE, STEP, SHARE, FIRST, SAMPLE)


def boxed(values: Sequence[Any]) -> Nodes:
    """An array of nodes and floats."""
    found = np.empty(len(values), dtype=object)
    for k, value in enumerate(values):
        found[k] = value
    return found


@dataclass(frozen=True)
class Varied:
    """The numbers of a batch as variables.

    Attributes
    ----------
    numbers : every array of the batch a variable, floats as they are
    names : a variable for each array that `arrays_of` finds, in its order
    scale : the greatest length, a variable where it varies
    """

    numbers: Dimensions
    names: tuple[str, ...]
    scale: Operand

    def values(self, numbers: Dimensions) -> dict[str, Array]:
        """What the variables stand for in a batch of the same kind: name -> (lanes,)."""
        found = dict(zip(self.names, arrays_of(numbers), strict=True))
        if not isinstance(self.scale, float):
            found[SCALE] = np.asarray(numbers.scale, dtype=np.float64)
        return found


def varied_of(numbers: Dimensions, values: Mapping[str, Array]) -> Varied:
    """The numbers of a batch as variables; those that are a varied value itself are called by its path."""
    known = {id(value): path for path, value in values.items()}
    names: list[str] = []

    def lifted(x: Number) -> Number:
        if isinstance(x, float):
            return x
        # one array in several places is one variable
        names.append(known.setdefault(id(x), f"number {len(names)}"))
        return variable(names[-1])

    nodes = numbers.mapped(lifted)
    scale = numbers.scale
    return Varied(nodes, tuple(names), scale if isinstance(scale, float) else variable(SCALE))


def taken(numbers: Dimensions, lanes: npt.NDArray[np.intp]) -> Dimensions:
    """The numbers of some mechanisms of a batch."""
    return numbers.mapped(lambda x: x if isinstance(x, float) else x[lanes])


def arrays_of(numbers: Dimensions) -> list[Array]:
    """The arrays of a batch's numbers, in the order in which `mapped` meets them."""
    found: list[Array] = []

    def seen(x: Number) -> Number:
        if not isinstance(x, float):
            found.append(x)
        return x

    numbers.mapped(seen)
    return found


@dataclass(frozen=True)
class TracedSpan(Span):
    """One place of the path, whose numbers may be variables."""

    accelerated: bool = False

    @property
    def accelerates(self) -> bool:
        return self.accelerated


def span_of_variables(span: Span) -> TracedSpan:
    """The place as variables; rates that are the same everywhere as numbers."""
    accelerates = span.accelerates

    def row(name: str, values: Array) -> Any:
        return values[:1] if (values == values[0]).all() else boxed([variable(name)])

    second = row(SECOND_RATE, span.second_rate) if accelerates else np.zeros(1)
    place = boxed([variable(PARAMETER)])
    return TracedSpan(boxed([variable(TIME)]), place, row(RATE, span.rate), second, accelerates)


def times_of(span: Span) -> dict[str, Array]:
    """What the variables of a place that tell of time stand for at the samples of a span: name -> (samples,)."""
    return {
        TIME: span.time,
        RATE: span.rate,
        SECOND_RATE: span.second_rate,
    }
