"""Points and guides that stand where the chain puts them in the initial position."""

from __future__ import annotations

from typing import TypeVar

from centrode.model.bodies import Frame
from centrode.model.chain import chain_of
from centrode.model.description import Description
from centrode.model.frozen import FrozenMap
from centrode.model.names import FRAME
from centrode.model.pairs import Guide
from centrode.model.problems import Place, Problems, told
from centrode.model.values import Placed, Vector

M = TypeVar("M", bound=Description)


def place(mechanism: M) -> M:
    """The mechanism with what is still to be placed put where the chain of initial angles puts it.

    Raises
    ------
    InputError
        The chain does not reach it; the message names the link whose initial angle is missing.
    """
    try:
        frame, guides = resolved(mechanism)
    except Problems as error:
        raise told(error.problems[0], (), "") from None
    if frame == mechanism.frame and guides == mechanism.guides:
        return mechanism
    return mechanism.model_copy(update={"frame": frame, "guides": guides})


def replace_placed(mechanism: M) -> M:
    """The mechanism with everything `placed` put anew, by the links' lengths and initial angles as they are now."""
    points = {
        name: Placed() if isinstance(position, Placed) else position
        for name, position in mechanism.frame.points.items()
    }
    guides = tuple(_unresolved(guide) for guide in mechanism.guides)
    update = {"frame": Frame(points=points), "guides": guides}
    return place(mechanism.model_copy(update=update))


def _unresolved(guide: Guide) -> Guide:
    if not isinstance(guide.through, Placed):
        return guide
    return guide.model_copy(update={"through": Placed()})


def resolved(mechanism: Description) -> tuple[Frame, tuple[Guide, ...]]:
    """Frame and guides with nothing left to place; raises Problems that name the missing angles."""
    points = mechanism.frame.points
    open_points = [name for name, position in points.items() if position == Placed()]
    open_guides = [index for index, guide in enumerate(mechanism.guides) if guide.unplaced]
    if not (open_points or open_guides):
        return mechanism.frame, mechanism.guides
    chain = chain_of(mechanism)
    problems = [
        chain.problem(name, ("frame", "points", name)) for name in open_points if name not in chain.points
    ]
    lines: dict[int, Vector] = {}
    for index in open_guides:
        guide = mechanism.guides[index]
        at: Place = ("guides", index, "through")
        if guide.on != FRAME and guide.on not in chain.poses:
            problems.append(chain.problem(next(iter(mechanism.links[guide.on].coordinates)), at, guide.on))
        elif guide.point not in chain.points:
            problems.append(chain.problem(guide.point, at))
        else:
            lines[index] = chain.local(guide.on, chain.points[guide.point])
    if problems:
        raise Problems(problems)
    frame = {name: Placed(chain.points[name]) if name in open_points else points[name] for name in points}
    guides = tuple(
        guide.model_copy(update={"through": Placed(lines[index])}) if index in lines else guide
        for index, guide in enumerate(mechanism.guides)
    )
    return mechanism.frame.model_copy(update={"points": FrozenMap(frame)}), guides
