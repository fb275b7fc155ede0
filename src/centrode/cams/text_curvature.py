"""A curvature by a formula written as text, parted where `abs`, `sign`, `min` or `max` bend it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.algebra.text import TextFormula, compile_formula
from centrode.cams.curvature_laws import Number, full
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import bisect

Array = NDArray[np.float64]

NODES_OF_A_TURN = 2880
MOST_KINKS = 1000


class _Watched(JetFunctions):
    """Jets that keep the values whose signs `abs`, `sign`, `min` and `max` ask for, in the order they do."""

    def __init__(self) -> None:
        super().__init__(ARRAYS)
        self.asked: list[Array] = []

    def sign(self, x: Number) -> Number:
        if isinstance(x, Jet):
            self.asked.append(np.asarray(x.value))
        return super().sign(x)

    def abs(self, x: Number) -> Number:
        return x * self.sign(x) if isinstance(x, Jet) else super().abs(x)


class _Signed(JetFunctions):
    """Jets with these signs given: the formula of one stretch, which goes on beyond its ends."""

    def __init__(self, signs: list[Array]) -> None:
        super().__init__(ARRAYS)
        self.signs = iter(signs)

    def sign(self, x: Number) -> Number:
        return next(self.signs) if isinstance(x, Jet) else super().sign(x)

    def abs(self, x: Number) -> Number:
        return x * self.sign(x) if isinstance(x, Jet) else super().abs(x)


@dataclass(frozen=True)
class TextCurvature:
    """K [1/m] by a formula of phi [rad], such as "10*exp(0.75*phi)".

    Kinks are looked for from `start` to `stop` on a mesh of an eighth of a degree and bisected to rounding; two of
    them within one cell of the mesh are missed.

    Attributes
    ----------
    constants : tuple of (name, value)
        Further letters of the formula.
    breaks : tuple of float [rad]
        Where the formula bends or jumps.
    signs : (stretches, functions)
        What `abs`, `sign`, `min` and `max` decide on each stretch between them.

    Raises
    ------
    InputError
        No formula of phi, or more kinks than `MOST_KINKS`.
    """

    text: str
    start: float
    stop: float
    constants: tuple[tuple[str, float], ...] = ()
    formula: TextFormula = field(init=False, repr=False, compare=False)
    breaks: tuple[float, ...] = field(init=False, repr=False, compare=False)
    signs: Array = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "formula", self._compiled())
        breaks = self._kinks()
        edges = np.array(
            [min(self.start, *breaks), *breaks, max(self.stop, *breaks)]
            if breaks
            else [self.start, self.stop]
        )
        object.__setattr__(self, "breaks", breaks)
        asked = self._asked(0.5 * (edges[:-1] + edges[1:]))
        object.__setattr__(self, "signs", np.sign(asked).T)

    def _compiled(self) -> TextFormula:
        names = ("phi", *(name for name, _value in self.constants))
        return compile_formula(self.text, names, "[curvature] formula")

    @property
    def span(self) -> tuple[float, float]:
        """Defined everywhere, as far as is known before it is computed."""
        return -math.inf, math.inf

    def series(self, phi: Number, order: int, side: int = 1) -> list[Number]:
        return self.along([phi, 1.0, *([0.0] * (order - 1))][: order + 1], side)

    def along(self, angles: list[Number], side: int = 1) -> list[Number]:
        stretch = np.searchsorted(self.breaks, np.real(angles[0]), side="right" if side > 0 else "left")
        functions = _Signed(list(np.moveaxis(self.signs[stretch], -1, 0)))
        with np.errstate(all="ignore"):
            return full(self._value(functions, Jet(angles)), angles[0], len(angles))

    def _value(self, functions: JetFunctions, phi: Jet) -> Any:
        try:
            return self.formula(functions, phi=phi, **dict(self.constants))
        except ZeroDivisionError:
            return math.inf

    def _asked(self, places: Array) -> Array:
        """Values (functions, n) whose signs are asked for."""
        watched = _Watched()
        with np.errstate(all="ignore"):
            self._value(watched, Jet([places]))
        return np.asarray([np.broadcast_to(one, places.shape) for one in watched.asked]).reshape(
            -1, len(places)
        )

    def _kinks(self) -> tuple[float, ...]:
        count = 3 + math.ceil((self.stop - self.start) / math.tau * NODES_OF_A_TURN)
        places = np.linspace(self.start, self.stop, count)
        above = self._asked(places) >= 0
        functions, cells = np.nonzero(above[:, :-1] != above[:, 1:])
        if len(cells) > MOST_KINKS:
            what = _("the formula bends at more than {most} places").format(most=MOST_KINKS)
            raise InputError("[curvature] formula", what, _("take out abs, sign, min and max"))
        if not len(cells):
            return ()
        first, column = above[functions, cells], np.arange(len(cells))

        def before(phi: Array) -> NDArray[np.bool_]:
            return np.asarray((self._asked(phi) >= 0)[functions, column] == first)

        _last, high = bisect(before, places[cells], places[cells + 1])
        rounding = 4 * np.finfo(np.float64).eps * (self.stop - self.start)
        high = np.where(np.abs(high) < rounding, 0.0, high)  # what is meant by abs(phi)
        return tuple(np.unique(high[(high > self.start) & (high < self.stop)]).tolist())
