"""What a part of a cam's results consists of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from typing import Any, TypeAlias

import xarray as xr

from centrode.model.cam_files import AnyCam
from centrode.quantities import display_unit
from centrode.sheets.sheet import Scalar

Rows: TypeAlias = list[tuple[str, str]]


@dataclass(frozen=True)
class Asked:
    """What is asked for besides the description.

    Numbers of samples and of terms of the series, a groove, a front.
    """

    samples: int | None = None
    terms: int | None = None
    groove: bool = False
    front: bool = False


@dataclass(frozen=True)
class CamTable:
    """A table below the rows of a part: heading, names of columns, lines, and whether these begin with a name."""

    heading: str
    header: tuple[str, ...]
    lines: list[tuple[str, ...]]
    named: bool = False


@dataclass(frozen=True)
class CamPart:
    """A part of a cam's results.

    Attributes
    ----------
    heading : str
        In the language of the reader.
    rows : list of (label, text)
    scalars : mapping of name to Scalar, in SI
        What `summary.json` holds.
    datasets : mapping of name to Dataset
        What is written as tables and drawn; the names are those of the files.
    tables : tuple of CamTable
    failures : tuple of str
        What the cam cannot do, in sentences: the command ends with 3.
    objects : mapping of name to anything
        What drawings need besides.
    """

    heading: str
    rows: Rows
    scalars: Mapping[str, Scalar]
    datasets: Mapping[str, xr.Dataset] = field(default_factory=dict)
    tables: tuple[CamTable, ...] = ()
    failures: tuple[str, ...] = ()
    objects: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Units:
    """Numbers with their units as a cam's description shows them."""

    cam: AnyCam

    def text(self, value: float, unit: str = "m", digits: int = 6) -> str:
        """A number in SI as it is shown, with its unit; a plain number has none."""
        factor, shown = self.shown(unit)
        return f"{value * factor:.{digits}g}" + ("" if shown == "1" else f" {shown}")

    def angle(self, value: float, digits: int = 6) -> str:
        """An angle in degrees, the cam's other unit before it where it has another."""
        degrees = f"{value * 180 / pi:.{digits}g} deg"
        factor, shown = self.shown("rad")
        return degrees if shown == "deg" else f"{value * factor:.{digits}g} {shown} ({degrees})"

    def shown(self, unit: str) -> tuple[float, str]:
        """Factor and unit; what is by radian stays by radian."""
        angle = "rad" if "/rad" in unit else str(self.cam.display.angle)
        return display_unit(unit, str(self.cam.display.length), angle)
