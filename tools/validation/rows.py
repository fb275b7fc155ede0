"""What is compared: printed numbers, one by one or in columns of a table."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

REFERENCE = Path(__file__).parents[2] / "tests" / "reference"
ROUNDED = 1 + 1e-9
"""A printed decimal fraction is itself rounded when it is read."""


@dataclass(frozen=True)
class Row:
    """One printed number; `half_unit` is half a unit of its last printed digit."""

    quantity: str
    symbol: str
    unit: str
    printed: float
    half_unit: float
    found: float

    @property
    def agrees(self) -> bool:
        """Whether the computed number rounds to the printed one."""
        return abs(self.found - self.printed) <= self.half_unit * ROUNDED


@dataclass(frozen=True)
class Column:
    """A column of a printed table."""

    quantity: str
    printed: Array
    half_unit: float
    found: Array

    @property
    def worst(self) -> float:
        """The greatest distance, in half units of the last printed digit."""
        return float(np.max(np.abs(self.found - self.printed)) / self.half_unit)

    @property
    def agreeing(self) -> int:
        """How many of the numbers round to the printed ones."""
        return int(np.sum(np.abs(self.found - self.printed) <= self.half_unit * ROUNDED))


@dataclass(frozen=True)
class Source:
    """A document and what it prints."""

    title: str
    about: str
    rows: tuple[Row, ...] = ()
    columns: tuple[Column, ...] = ()


def printed(name: str) -> list[dict[str, str]]:
    """Rows of a file with printed numbers."""
    with (REFERENCE / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def column(rows: Sequence[dict[str, str]], name: str) -> Array:
    """A column of such rows as numbers."""
    return np.array([float(row[name]) for row in rows])
