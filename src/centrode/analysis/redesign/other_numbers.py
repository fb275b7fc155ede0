"""A mechanism with other numbers that is assembled as before: its groups keep the sides of the initial position."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from centrode.analysis.redesign.candidates import Candidates, Varying
from centrode.errors import InputError
from centrode.kinematics.preparation import ready
from centrode.model.files import value_at, with_values
from centrode.model.mechanism import Mechanism
from centrode.structure.dimensions import dimensions_of


def with_numbers(mechanism: Mechanism, values: Mapping[str, float | str]) -> Mechanism:
    """The mechanism with other numbers, assembled as it was.

    Parameters
    ----------
    mechanism : Mechanism
    values : path -> number [SI] or text with a unit

    Returns
    -------
    Mechanism
        Where dimensions change, its assembly names the sides, and the initial angles of its groups are those of the
        new position: angles of before would be refused, or choose another assembly.

    Raises
    ------
    InputError
        A path without a number, a value that does not fit.
    """
    changed = with_values(mechanism, values)
    numbers = {path: value_at(changed, path) for path in values}
    dimensions = [path for path in values if _is_dimension(mechanism, path)]
    if not dimensions:
        return changed
    prepared = ready(mechanism)
    varying = tuple(Varying(path, 0.0, 0.0, 0.0, "", 1.0) for path in dimensions)
    redesigned = Candidates(prepared, varying).mechanism(np.array([numbers[path] for path in dimensions]))
    rest = {path: value for path, value in values.items() if path not in dimensions}
    return with_values(redesigned, rest) if rest else redesigned


def _is_dimension(mechanism: Mechanism, path: str) -> bool:
    """Whether positions depend on a number."""
    try:
        dimensions_of(mechanism, {path: value_at(mechanism, path)})
    except InputError:
        return False
    return True
