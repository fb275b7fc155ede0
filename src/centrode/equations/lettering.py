"""What the boards of both spaces share: letters, what moves, what the drives give."""

from __future__ import annotations

from collections.abc import Mapping

from centrode.equations.alphabet import Alphabet
from centrode.equations.draft import Draft, Unknown
from centrode.equations.letters import Letter
from centrode.equations.sums import Sum
from centrode.kinematics.prepared import Ready


class Lettering:
    """Letters of a mechanism, with the numbers of its initial position behind them."""

    def __init__(self, ready: Ready) -> None:
        self.ready = ready
        self.numbers = ready.kinematics.numbers
        self.mechanism = ready.mechanism
        self.alphabet = Alphabet()
        self.order = {name: i + 1 for i, name in enumerate(self.mechanism.links)}
        self.driven: dict[Letter, str] = {}
        """Letters that a drive gives."""
        self.moving: list[str] = []
        """Moving points in the order in which they were placed."""

    @property
    def moves(self) -> Mapping[Letter, Sum]:
        """Rate of every letter that moves."""
        return {letter: Sum.letter(rate) for letter, rate in self.alphabet.rates.items()}

    @property
    def moves_twice(self) -> Mapping[Letter, Sum]:
        """Rates of letters and of their rates."""
        seconds = {rate: Sum.letter(second) for rate, second in self.alphabet.seconds.items()}
        return {**self.moves, **seconds}

    @property
    def axes_through(self) -> tuple[str, str] | None:
        """Points of the frame that give the axes of places, where these are not the description's own."""
        return None

    def drive_value(self, drive: str) -> float:
        """Value of a drive in the initial position."""
        return float(self.ready.assembled.positions.drives[drive])

    def sort_in(self, letter: Letter, name: str, draft: Draft, drive: str | None) -> None:
        """Note what gives a letter that moves: a drive, or the constraints of a group."""
        if drive is not None:
            self.driven[letter] = drive
            return
        rate = self.alphabet.rates[letter]
        draft.unknowns.append(Unknown(name, letter, rate, self.alphabet.seconds[rate]))
