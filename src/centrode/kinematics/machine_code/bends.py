"""Radicands and divisors of a traced plan with bounds of their second derivatives over the cells of the mesh."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.assembly import with_phases
from centrode.kinematics.events import bent_drives, half_widths
from centrode.kinematics.machine_code.variables import PARAMETER, Varied, traced_path
from centrode.kinematics.path import Path, SampleGrid
from centrode.kinematics.plan_evaluation import EvaluationPolicy, ReachedRadicand, is_long_row
from centrode.kinematics.preparation import Ready
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.bends import BendFunctions, Bent, Cells
from centrode.numerics.expressions import EXPRESSIONS, Operand, variable
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

NODE_BENDS = BendFunctions(EXPRESSIONS)
HALF = "half a cell"
RADICAND, DIVISOR = "radicand", "divisor"


@dataclass
class _Bounding(EvaluationPolicy):
    """Signs as they are given; keeps radicands and divisors up to the first group of higher class."""

    signs: Mapping[int, Operand]
    found: dict[tuple[str, int], Bent]
    cells: Cells

    def root(self, group: int, radicand: Number) -> Number:
        self.found[RADICAND, group] = self._bend_of(radicand)
        return NODE_BENDS.sqrt(radicand) * self.signs[group]

    def divisor(self, group: int, divisor: Number) -> Number:
        self.found[DIVISOR, group] = self._bend_of(divisor)
        return divisor

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        raise ReachedRadicand(None)  # only walks along the path count turns

    def higher(self, group: int, m: Any, at: Positions) -> None:
        raise ReachedRadicand(None)

    def _bend_of(self, number: Number) -> Bent:
        return number if isinstance(number, Bent) else Bent(number, 0.0, 0.0, self.cells)


@dataclass(frozen=True)
class BentPlan:
    """What a plan is run over again for bounds of second derivatives, see `bent_guards`."""

    ready: Ready
    span: SampleGrid
    varied: Varied
    signs: Mapping[int, Operand] | None

    def guards(self, half: float | None = None) -> dict[tuple[str, int], Bent]:
        """Radicands and divisors on cells of the mesh, or with one drive of another half width."""
        return bent_guards(self.ready, self.span, self.varied, self.signs, half)


def bent_guards(
    ready: Ready,
    span: SampleGrid,
    varied: Varied,
    signs: Mapping[int, Operand] | None = None,
    width: float | None = None,
) -> dict[tuple[str, int], Bent]:
    """(radicand or divisor, group) -> the number on a cell, as far as its second derivative is bounded.

    With one drive `width` is half the width of cells, that of the mesh if it is left out.
    """
    known = ready.kinematics
    path = traced_path(known.path, span.parameter, 2)
    kinematics = with_phases(replace(known, numbers=varied.numbers, path=path), known.numbers.gearing.phase)
    # with one drive all cells of the mesh are equally wide, and the width is a constant of the kernel
    half: Operand = variable(HALF) if path.by_time else width or 0.5 * path.step
    cells = Cells(half, EXPRESSIONS, holds=is_long_row(known.structure))
    place = NODE_BENDS.variable(variable(PARAMETER), cells)
    drives = {drive: _driven(drive, x, cells) for drive, x in path.drive_values(NODE_BENDS, place).items()}
    hooks = _Bounding(ready.assembled.signs if signs is None else signs, {}, cells)
    at = Positions.of_frame(kinematics.numbers, drives, NODE_BENDS)
    # behind a group of higher class nothing bounds second derivatives; what was kept so far is used
    with suppress(ReachedRadicand):
        kinematics.advance(at, range(len(kinematics.structure.groups)), NODE_BENDS, hooks)
    return hooks.found


def _driven(drive: str, value: Number, cells: Cells) -> Number:
    """A drive's value with the bend of its law, a variable where that is not plainly zero."""
    if isinstance(value, Bent) or not isinstance(value, Jet):
        return value
    # a drive at constant speed has no bend, and its literal zero saves the operations behind it
    still = all(type(x) is float and x == 0.0 for x in value.coefficients[2:])
    first, slope = value.coefficients[:2]
    return Bent(first, slope, 0.0 if still else variable(_name(drive)), cells)


def bends_of(path: Path, mesh: Array) -> dict[str, Array]:
    """Values of the variables of cells at the nodes of a mesh: name -> (nodes,)."""
    if not path.by_time:
        return {}
    half = half_widths(mesh)
    bends = {HALF: np.broadcast_to(half, mesh.shape)}
    with np.errstate(all="ignore"):
        for drive, value in bent_drives(path, mesh, Cells(half, ARRAYS)).items():
            if isinstance(value, Bent):
                bends[_name(drive)] = np.broadcast_to(value.bend, mesh.shape)
    return bends


def _name(drive: str) -> str:
    return f"bend of drive {drive}"
