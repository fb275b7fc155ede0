"""The letters that move, read off one sample of a motion: angles, bearings, lengths of cylinders, displacements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from centrode.equations.board import Board
from centrode.equations.letters import Letter
from centrode.equations.lines import Line, Rod, lines_of, rods_of
from centrode.model.mechanism import FRAME

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Standing:
    """What moves, as it stands at a sample of a motion."""

    board: Board
    motion: xr.Dataset
    sample: int

    def values(self) -> dict[Letter, float]:
        """Number of every letter that moves [rad, m]."""
        lines = {line.name: line for line in lines_of(self.board.ready)}
        rods = {rod.name: rod for rod in rods_of(self.board.ready)}
        found = {}
        for letter in self.board.alphabet.rates:
            meaning = self.board.alphabet.meanings[letter]
            if meaning.kind == "link angle":
                found[letter] = self._angle(meaning.names[0])
            elif meaning.kind == "relative angle":
                found[letter] = self._angle(meaning.names[0]) - self._angle(meaning.names[1])
            elif meaning.kind in ("bearing", "cylinder"):
                found[letter] = float(np.angle(self._way(rods[meaning.names[0]])))
            elif meaning.kind == "stroke":
                found[letter] = abs(self._way(rods[meaning.names[0]]))
            else:
                found[letter] = self._slide(lines[meaning.names[0]])
        return found

    def _angle(self, link: str) -> float:
        return 0.0 if link == FRAME else float(self.motion["angle"].sel(link=link)[self.sample])

    def _at(self, point: str) -> complex:
        return complex(*self.motion["position"].sel(point=point).to_numpy()[self.sample])

    def _world(self, body: str, local: tuple[float, float]) -> complex:
        if body == FRAME:
            return complex(*local)
        name, own = next(iter(self.board.local(body).items()))
        arm = complex(*local) - complex(*own)
        return self._at(name) + arm * complex(np.exp(1j * self._angle(body)))

    def _way(self, rod: Rod) -> complex:
        first = self._at(rod.first) if isinstance(rod.first, str) else self._world(*rod.first)
        return self._at(rod.second) - first

    def _slide(self, line: Line) -> float:
        away = self._at(line.point) - self._world(line.on, line.through)
        heading = complex(*line.direction) * complex(np.exp(1j * self._angle(line.on)))
        return (away * heading.conjugate()).real
