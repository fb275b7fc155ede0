"""The mechanism: one frozen description that everything else is derived from."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import lru_cache, wraps
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, Self, TypeVar

from pydantic import model_validator

from centrode.model.checks import problems_of_parts
from centrode.model.contact_checks import contact_problems
from centrode.model.description import Description
from centrode.model.drives import Drive
from centrode.model.gears import Gear
from centrode.model.links import Frame, Guide, Link, Rolling, Track
from centrode.model.loads import AnyLoad
from centrode.model.motor_checks import motor_problems
from centrode.model.placement import resolve_placement
from centrode.model.reading import FRAME, Problems
from centrode.model.settings import Assembly, Display, Machine, ReportWishes, Study
from centrode.model.simulation import Simulation
from centrode.model.tolerance_checks import tolerance_problems
from centrode.model.tolerances import Tolerances
from centrode.model.values import Placed, Vector

__all__ = [
    "FRAME",
    "Assembly",
    "Display",
    "Drive",
    "Frame",
    "Gear",
    "Guide",
    "Link",
    "AnyLoad",
    "Machine",
    "Mechanism",
    "Placed",
    "ReportWishes",
    "Rolling",
    "Simulation",
    "Study",
    "Tolerances",
    "Track",
    "Vector",
]


class Mechanism(Description):
    """A mechanism: points, links, guides, gears, drives, loads and assembly; it holds no motion.

    The arguments are those of a file (docs: the description), as parts or as plain dicts, texts with
    units included: `Mechanism(frame={"points": {"O": [0, 0]}}, links={"OA": {"length": "0.5 m"}})`.
    All numbers it holds are SI. "placed" points and guides are put where the chain of the links'
    initial angles puts them.

    Attributes
    ----------
    title : str
    space : "plane" or "sphere"
    gravity : (x, y) [m/s^2], on the sphere (x, y, z), or None
    radius : float [m] or None
        Of the sphere, for masses and forces.
    display : Display
    frame : Frame
    links : mapping of name to Link, in description order
    guides, gears, rolling, drives, loads : tuples
    assembly : Assembly
    stops, clamps, events : tuples
        What bounds, holds and watches coordinates of a simulation.
    motors, controllers : tuples
        What drives a simulation besides its settings.
    machine : Machine or None
    simulation : Simulation or None
    study : Study
    report : ReportWishes
    tolerances : Tolerances or None

    Raises
    ------
    InputError
        Anything that is not a description, with its place and the repair.

    Examples
    --------
    >>> import centrode as ct
    >>> bar = ct.Mechanism(
    ...     frame={"points": {"O": [0, 0]}}, links={"OA": {"length": "0.2 m"}}, drives=[{"link": "OA", "speed": 1}]
    ... )
    >>> bar.links["OA"].length
    0.2
    """

    if TYPE_CHECKING:

        def __init__(self, **parts: Any) -> None: ...

    @model_validator(mode="after")
    def _checked_and_placed(self) -> Self:
        problems = problems_of_parts(self) or [*contact_problems(self), *motor_problems(self)]
        if problems:
            raise Problems(problems)
        frame, guides = resolve_placement(self)
        # The only writes to a frozen description, before anybody has seen it.
        object.__setattr__(self, "frame", frame)
        object.__setattr__(self, "guides", guides)
        # paths of coordinates lead to numbers only once everything is placed
        wrong = list(tolerance_problems(self))
        if wrong:
            raise Problems(wrong)
        return self


Arguments = ParamSpec("Arguments")
Value = TypeVar("Value")


def kept_by_mechanism(
    most: int,
) -> Callable[
    [Callable[Concatenate[Mechanism, Arguments], Value]], Callable[Concatenate[Mechanism, Arguments], Value]
]:
    """A function of a mechanism keeps its `most` last values, for mechanisms that are equal down to the order of names.

    Of a mechanism that cannot be hashed nothing is kept.
    """

    def decorate(
        function: Callable[Concatenate[Mechanism, Arguments], Value],
    ) -> Callable[Concatenate[Mechanism, Arguments], Value]:
        @lru_cache(maxsize=most)
        def keep(
            mechanism: Mechanism, _order: Hashable, rest: tuple[Any, ...], named: tuple[Any, ...]
        ) -> Value:
            return function(mechanism, *rest, **dict(named))

        @wraps(function)
        def look(mechanism: Mechanism, /, *rest: Arguments.args, **named: Arguments.kwargs) -> Value:
            order = order_of_names(mechanism)
            if order is None:
                return function(mechanism, *rest, **named)
            return keep(mechanism, order, rest, tuple(named.items()))

        return look

    return decorate


def order_of_names(mechanism: Mechanism) -> tuple[object, ...] | None:
    """The order in which points and links are described, which equal mechanisms leave open.

    None for a copy whose parts cannot be hashed: nothing is kept of it.
    """
    try:
        hash(mechanism)
    except TypeError:
        return None
    links = tuple((name, tuple(link.coordinates)) for name, link in mechanism.links.items())
    return tuple(mechanism.frame.points), links


def has_tolerances(mechanism: Mechanism) -> bool:
    """Whether the description says which numbers deviate."""
    settings = mechanism.tolerances
    return settings is not None and (settings.default is not None or bool(settings.dimensions))
