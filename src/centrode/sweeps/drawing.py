"""Samples of ranges: latin hypercubes and Sobol sequences."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.problems import nearest, shown
from centrode.sweeps import limits
from centrode.sweeps.values import count_of, ends

Array: TypeAlias = npt.NDArray[np.float64]

METHODS = ("latin hypercube", "sobol")

# scipy costs more to import than a small sweep takes
_qmc = functools.partial(importlib.import_module, "scipy.stats.qmc")


@dataclass(frozen=True)
class Sample:
    """Mechanisms to be drawn from ranges; made by `sample`."""

    ranges: Mapping[str, Any]
    count: int
    method: str
    seed: int


def sample(ranges: Mapping[str, Any], count: int, method: str = "latin hypercube", seed: int = 0) -> Sample:
    """Mechanisms spread evenly over ranges of several dimensions, for `sweep`.

    Parameters
    ----------
    ranges : path -> (first, last)
        Numbers [SI] or texts with a unit.
    count : int
        How many mechanisms.
    method : "latin hypercube" or "sobol"
        Each of `count` slices of every range once; or the first points of a scrambled Sobol sequence (best with
        a power of two).
    seed : int
        The same seed draws the same mechanisms.
    """
    return Sample(dict(ranges), count, method, seed)


def drawn(mechanism: Mechanism, asked: Sample) -> dict[str, Array]:
    """Values [SI] of every path, one for each mechanism; InputError for a range, count, method or seed that is none."""
    count = count_of("sample", asked.count, limits.DRAWN // len(asked.ranges))
    if asked.method not in METHODS:
        what = _("unknown method {method}").format(method=shown(asked.method))
        raise InputError("sample", what, nearest(str(asked.method), METHODS))
    seed: object = asked.seed
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError("sample", _("the seed is a whole number from 0"))
    bounds = {path: _bounds(mechanism, path, given) for path, given in asked.ranges.items()}
    unit = _in_unit_cube(asked.method, len(bounds), count, np.random.default_rng(seed))
    columns = zip(bounds.items(), unit.T, strict=True)
    return {path: np.clip(low + (high - low) * column, low, high) for (path, (low, high)), column in columns}


def _bounds(mechanism: Mechanism, path: str, given: Any) -> tuple[float, float]:
    if isinstance(given, str) or not isinstance(given, tuple | list) or len(given) != 2:
        raise InputError(path, _("a range of a sample is (first, last)"))
    return ends(mechanism, path, *given)


def _in_unit_cube(method: str, paths: int, count: int, random: np.random.Generator) -> Array:
    """Points of the unit cube (count, paths)."""
    if method == "latin hypercube":
        return np.asarray(_qmc().LatinHypercube(paths, seed=random).random(count))
    # powers of two are what the sequence is balanced for; the rest is cut off
    return np.asarray(_qmc().Sobol(paths, seed=random).random_base2((count - 1).bit_length())[:count])
