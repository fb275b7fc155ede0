"""The track of a group of higher class: its curve over the path in pieces, and where Newton's method starts.

Pieces belong to the mechanism and its path, not to the samples: a place starts from the piece on which it lies.
So what is found does not depend on what else is asked for. A curve that closes after whole turns is followed once:
behind that every place starts from the one as many turns before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
End: TypeAlias = Literal["on", "limit", "lost"]

HALVINGS, CLOSE = 60, 1e-13


@dataclass(frozen=True)
class Piece:
    """A stretch of the curve by its share u, 0 to 1: coefficients (6, width + 1), that of u^0 first.

    The last column is the path's parameter beyond `origin`. `first` and `last` are the parameters at the ends,
    `sense` is the sign of the group's determinant.
    """

    coefficients: Array
    origin: float
    first: float
    last: float
    sense: float


@dataclass(frozen=True)
class Period:
    """After so much of the path a closed curve repeats itself; the numbers of the state have grown by (width,)."""

    length: float
    grown: Array


@dataclass
class Trail:
    """The pieces in one sense of the path, outward from the initial position, and how they end.

    A place closer than `margin` to a limit is the limit itself.
    """

    pieces: list[Piece] = field(default_factory=list)
    end: End = "on"
    limit: float = np.nan
    margin: float = -1.0
    state: Array | None = None
    """There, if the limit is the group's own."""
    period: Period | None = None
    """Of a closed curve."""


@dataclass(frozen=True)
class Foretold:
    """Where Newton's method starts at every place, and what is known of the place beforehand."""

    state: Array
    sense: Array
    beyond: Mask
    limit: Mask


@dataclass(frozen=True)
class Tracks:
    """The tracks of all mechanisms of a batch: one trail behind and one ahead of each initial position.

    `powers` (6, width + 1, pieces) are the coefficients of all pieces. Curves that are closed repeat themselves after a
    `period` (lanes, 2) of the path, and have `grown` (lanes, 2, width) then.
    """

    lanes: int
    initial: float
    powers: Array
    origin: Array
    sense: Array
    edges: list[Array]
    first: Lanes
    limits: Array
    margins: Array
    at_limit: Array
    followed: Array
    period: Array
    grown: Array

    @classmethod
    def of(cls, initial: float, behind: Sequence[Trail], ahead: Sequence[Trail], width: int) -> Tracks:
        """Tracks from trails; a mechanism without pieces has no track."""
        pieces: list[Piece] = []
        edges, first = [], []
        limits, margins = np.full((len(ahead), 2), np.nan), np.zeros((len(ahead), 2))
        at_limit = np.full((len(ahead), 2, width), np.nan)
        followed = np.full((len(ahead), 2), np.nan)
        period, grown = np.full((len(ahead), 2), np.inf), np.zeros((len(ahead), 2, width))
        for lane, trails in enumerate(zip(behind, ahead, strict=True)):
            own = [*reversed(trails[0].pieces), *trails[1].pieces]
            first.append(len(pieces))
            pieces += own
            edges.append(np.sort([edge for piece in own for edge in (piece.first, piece.last)])[1:-1:2])
            for side, trail in enumerate(trails):
                if trail.pieces:
                    followed[lane, side] = trail.pieces[-1].last
                if trail.end == "limit":
                    limits[lane, side], margins[lane, side] = trail.limit, trail.margin
                if trail.state is not None:
                    at_limit[lane, side] = trail.state
                if trail.period is not None:
                    period[lane, side], grown[lane, side] = trail.period.length, trail.period.grown
        coefficients = np.array([piece.coefficients for piece in pieces]).reshape(-1, 6, width + 1)
        return cls(
            len(ahead),
            initial,
            np.ascontiguousarray(np.moveaxis(coefficients, 0, 2)),
            np.array([piece.origin for piece in pieces]),
            np.array([piece.sense for piece in pieces]),
            edges,
            np.array(first, dtype=np.intp),
            limits,
            margins,
            at_limit,
            followed,
            period,
            grown,
        )

    def foretell(self, parameter: Array, lanes: Lanes) -> Foretold:
        """Starting states at parameters, one lane for each."""
        parameter, grown = self._repeated(parameter, lanes)
        which, known = self._pieces(parameter, lanes)
        state = np.full((self.at_limit.shape[2], len(parameter)), np.nan).T
        sense = np.zeros(len(parameter))
        chosen = which[known]
        if len(chosen):
            share = share_at(self.powers[:, -1], chosen, parameter[known] - self.origin[chosen])
            for column, powers in enumerate(np.moveaxis(self.powers[:, :-1], 1, 0)):
                state[known, column] = _value(powers, chosen, share)
            sense[known] = self.sense[chosen]
            state += grown
        limit = self._at_limits(parameter, lanes, state)
        past = (parameter < self.limits[lanes, 0]) | (parameter > self.limits[lanes, 1])
        return Foretold(state, sense, past & ~limit, limit)

    def _repeated(self, parameter: Array, lanes: Lanes) -> tuple[Array, Array]:
        """The places on the first round of closed curves that come before places, and how states grow between them."""
        side = (parameter > self.initial).astype(np.intp)
        period = self.period[lanes, side]
        # the end of a round belongs to it
        rounds = np.maximum(np.ceil(np.abs(parameter - self.initial) / period) - 1.0, 0.0)
        back = rounds * np.where(np.isfinite(period), period, 0.0) * (1.0 - 2.0 * side)
        return parameter + back, rounds[:, None] * self.grown[lanes, side]

    def _pieces(self, parameter: Array, lanes: Lanes) -> tuple[Lanes, Mask]:
        """The piece of each place, and whether the curve was followed as far as that."""
        which = np.zeros(len(parameter), dtype=np.intp)
        order = np.argsort(lanes, kind="stable")
        bounds = np.searchsorted(lanes[order], np.arange(self.lanes + 1))
        for lane in np.nonzero(np.diff(bounds))[0]:
            here = order[bounds[lane] : bounds[lane + 1]]
            which[here] = self.first[lane] + np.searchsorted(self.edges[lane], parameter[here])
        reach = self.followed[lanes]
        low, high = np.fmin(reach[:, 0], reach[:, 1]), np.fmax(reach[:, 0], reach[:, 1])
        return which, (parameter >= low) & (parameter <= high)

    def _at_limits(self, parameter: Array, lanes: Lanes, state: Array) -> Mask:
        """Where places are limits themselves; puts the state of the limit there."""
        limit = np.zeros(len(parameter), dtype=bool)
        for side in (0, 1):
            place = self.limits[lanes, side]
            with np.errstate(invalid="ignore"):
                here = np.abs(parameter - place) <= self.margins[lanes, side]
            state[here] = self.at_limit[lanes[here], side]
            limit |= here
        return limit


def share_at(powers: Array, which: Lanes, wanted: Array) -> Array:
    """Where polynomials (6, pieces) that run one way from 0 to 1 take values: Newton's method between bounds."""
    own = powers[:, which]
    slopes = own[1:] * np.arange(1.0, len(own))[:, None]
    low, high = np.zeros(len(wanted)), np.ones(len(wanted))
    whole = _horner(own[1:], np.ones(len(wanted)))
    with np.errstate(all="ignore"):
        share = np.clip(wanted / whole, 0.0, 1.0)
        going = np.ones(len(wanted), dtype=bool)
        for _step in range(HALVINGS):
            beyond = _horner(own, share) - wanted
            short = (beyond < 0.0) == (whole > 0.0)
            low, high = np.where(short, share, low), np.where(short, high, share)
            better = share - beyond / _horner(slopes, share)
            better = np.where((better >= low) & (better <= high), better, 0.5 * (low + high))
            change, share = np.abs(better - share), np.where(going, better, share)
            going &= change > CLOSE  # each place stops by itself
            if not going.any():
                break
    return np.asarray(share, dtype=np.float64)


def _value(powers: Array, which: Lanes, share: Array) -> Array:
    """Values of polynomials (6, pieces), a piece and a share for each place."""
    return _horner(powers[:, which], share)


def _horner(coefficients: Array, share: Array) -> Array:
    value = coefficients[-1]
    for c in coefficients[-2::-1]:
        value = value * share + c
    return np.asarray(value, dtype=np.float64)
