"""What is known while groups are solved: actions on every body, reactions of the joints, names of reactions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from centrode.analysis.graphic.board import cross
from centrode.dynamics.force_polygons.actions import Action, moment_about
from centrode.dynamics.force_polygons.bodies import Bodies
from centrode.dynamics.force_polygons.joints import Joint
from centrode.errors import MotionError
from centrode.locale import _

SINGULAR = 16.0 * (2.0**-52) ** 0.5
"""Sines smaller than this are those of a dead point: there rounding of positions alone leaves the root of twice its
own share, some 2e-8."""
ROUNDED = 1e-14
"""Moments smaller than this part of the greatest force times length are rounding of none, and are not told."""


@dataclass
class Ledger:
    """Actions known so far.

    Attributes
    ----------
    actions : body -> what acts on it
    forces : joint (its number in `joints`) -> force and moment on a body of share 1
    scale : greatest length [m]
    """

    bodies: Bodies
    joints: Sequence[Joint]
    scale: float
    actions: dict[str, list[Action]]
    forces: dict[int, tuple[complex, float]] = field(default_factory=dict)

    @classmethod
    def of(cls, bodies: Bodies, joints: Sequence[Joint], outer: Iterable[Action], scale: float) -> Ledger:
        """The outer actions, before any reaction is known."""
        actions: dict[str, list[Action]] = {name: [] for name in bodies.names}
        for action in outer:
            actions[action.body].append(action)
        return cls(bodies, joints, scale, actions)

    def on(self, names: Sequence[str]) -> list[Action]:
        """What acts on some bodies, body by body."""
        return [action for name in names for action in self.actions[name]]

    def settle(self, joint: Joint, force: complex, moment: float = 0.0) -> None:
        """Enter the reaction of a joint, given on a body of share 1, with all its bodies."""
        number = next(k for k, one in enumerate(self.joints) if one is joint)
        self.forces[number] = force, moment
        for body in joint.shares:
            self.actions[body].append(self.reaction(joint, body, force, moment))

    def reaction(self, joint: Joint, body: str, force: complex, moment: float = 0.0) -> Action:
        """The action of a joint on one of its bodies."""
        share = joint.shares[body]
        return Action(
            self.symbol(joint, body),
            joint.name,
            body,
            "drive" if joint.kind == "drive" else "reaction",
            share * force,
            joint.place,
            share * moment,
        )

    def symbol(self, joint: Joint, body: str) -> str:
        """R12 of body 1 on body 2; Mb and Fb of a drive, Mz of a gear's mesh."""
        if joint.kind == "drive":
            several = len(self.bodies.mechanism.drives) > 1
            name = ("Fb" if joint.has_force else "Mb") + (f"({joint.name})" if several else "")
            return name if joint.shares[body] > 0 else f"−{name}"
        if joint.kind == "mesh" and not joint.has_force:
            several = len(self.bodies.mechanism.gears) > 1
            return f"Mz{self.bodies.number(body)}" + (f"({joint.name})" if several else "")
        name = f"R{self.bodies.pair(joint.other(body), body)}"
        return name if joint.alone else f"{name}({joint.name})"

    def moment(self, names: Sequence[str], place: complex) -> float:
        """Moment about a place of what acts on some bodies."""
        return moment_about(self.on(names), place)

    def told(self, names: Sequence[str], place: complex) -> str:
        """The same term by term: + 12.3 (G2) - 4 (MΦ2)."""
        terms = [(action.symbol, action.about(place)) for action in self.on(names)]
        none = ROUNDED * self.scale * max((abs(action.force) for action in self.on(names)), default=0.0)
        return "".join(
            f" {'-' if value < 0 else '+'} {abs(value):.5g} ({symbol})"
            for symbol, value in terms
            if abs(value) > none
        )


def across(first: complex, second: complex) -> float:
    """Sine of the angle between two unit vectors along which forces are looked for.

    Raises MotionError at a dead point, where it is not told from zero.
    """
    sine = cross(first, second)
    if abs(sine) < SINGULAR:
        dead_point()
    return sine


def dead_point() -> None:
    """Say that reactions are not determined there."""
    raise MotionError(
        "at",
        _("the mechanism is singular there (a dead point): no finite forces keep the group in equilibrium"),
        _("choose another instant"),
    )
