"""What is kept of every motion of a sweep: quantities, of everything that has them or of one point, link or guide."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.reduction import REDUCED, Values, reduced_number
from centrode.errors import InputError
from centrode.kinematics.motion import by_time, kinds_of
from centrode.kinematics.solve import Solved
from centrode.locale import _
from centrode.model.problems import nearest, shown
from centrode.quantities import QUANTITIES
from centrode.sweeps import limits

Array: TypeAlias = npt.NDArray[np.float64]

COEFFICIENTS = ("velocity_coefficient", "acceleration_coefficient")
RESIDUAL, CONTACT = "residual", "contact"
_LENGTH = 200


@dataclass(frozen=True)
class Output:
    """One quantity of a motion.

    Attributes
    ----------
    name : str
        As it is asked for: "velocity", "position.C", "position.C.x".
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
        """Its values (lanes, samples, ...): the same bits as in the motion's dataset.

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
            _values, first, second = orders
            assert first is not None
            assert second is not None
            if self.quantity in kind.names:
                found = by_time((_values, first, second), kind.names.index(self.quantity), solved.span)
                if found is not None:
                    return found
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
        raise InputError(
            "outputs", _("no output is asked for"), _('name one, such as "position.C" or "angle"')
        )
    if len(names) > limits.OUTPUTS:
        what = _("{count} outputs are asked for").format(count=len(names))
        raise InputError("outputs", what, _("ask for at most {most}").format(most=limits.OUTPUTS))
    found: dict[str, Output] = {}
    for name in names:
        if name in found:
            raise InputError("outputs", _("{name} is asked for twice").format(name=shown(name)))
        found[name] = _output(motion, name)
    return tuple(found.values())


def quantities_of(motion: xr.Dataset) -> list[str]:
    """Names of the quantities that a motion has at every sample, in reading order."""
    told = [name for name in QUANTITIES if name in motion.data_vars and "sample" in motion[name].dims]
    return [name for name in told if name != "status"]


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
        what = _("there is no quantity {name}").format(name=shown(quantity))
        raise InputError("outputs", what, nearest(quantity, known))
    return numbered(motion, name, quantity, rest)


def numbered(motion: xr.Dataset, name: str, quantity: str, rest: str) -> Output:
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
        what = _("{name} has nothing called {rest}").format(name=shown(name), rest=shown(rest))
        raise InputError("outputs", what, _("leave it out"))
    shape = tuple(motion.sizes[dimension] for dimension in left)
    return Output(name, quantity, tuple(where), tuple(left), shape, dict(variable.attrs))


def _label(name: str, rest: str, labels: list[str]) -> tuple[str, str]:
    """The longest label that `rest` begins with (labels may hold dots), and what stands behind it."""
    for label in sorted(labels, key=len, reverse=True):
        if rest == label or rest.startswith(label + "."):
            return label, rest[len(label) + 1 :]
    word = rest.partition(".")[0]
    what = _("there is no {word} in {name}").format(word=shown(word), name=shown(name))
    raise InputError("outputs", what, nearest(word, labels))
