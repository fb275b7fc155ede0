"""What the drives give: their letters, and where time itself can be written for one of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from centrode.equations.lettering import Lettering
from centrode.equations.letters import Letter
from centrode.equations.sums import Sum


@dataclass(frozen=True)
class Drivenness:
    """A letter that a drive gives, with its derivatives.

    `law` is "t" where it is time itself, "uniform" at constant speed, else "law".
    """

    letter: Letter
    rate: Letter
    second: Letter
    drive: str
    law: str
    start: float
    speed: float


@dataclass(frozen=True)
class Given:
    """What the drives give.

    `names` has letters that are written otherwise (phi1 as t), `values` rates that are numbers (omega1 = 1).
    """

    drives: tuple[Drivenness, ...]
    names: Mapping[Letter, Letter]
    values: Mapping[Letter, Sum]

    def put(self, total: Sum) -> Sum:
        """A sum with what is given put in."""
        return total.replaced(self.values).renamed(self.names)


def given_of(board: Lettering) -> Given:
    """What the drives of a mechanism give; with one drive at 1 rad/s from 0 its angle is time."""
    found, names, values = [], {}, {}
    parameter = board.ready.parameter
    path = {one.drive.id: one for one in board.ready.kinematics.path.driven}
    for letter, drive in board.driven.items():
        rate = board.alphabet.rates[letter]
        second = board.alphabet.seconds[rate]
        coordinate, start = parameter.drive(drive), path[drive].start
        word, speed = "law", 0.0
        if coordinate.speed is not None:
            word, speed = "uniform", coordinate.speed
            values[second] = Sum({})
            if (start, speed, len(path)) == (0.0, 1.0, 1) and coordinate.turns:
                word = "t"
                names[letter] = Letter(letter.rank, "t")
                values[rate] = Sum.number(1)
        found.append(Drivenness(letter, rate, second, drive, word, start, speed))
    return Given(tuple(found), names, values)
