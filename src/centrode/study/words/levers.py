"""Sentences on links that a slider or a wheel turns about their pivots."""

from __future__ import annotations

from centrode.locale import _, mark
from centrode.structure.groups import (
    Aim,
)
from centrode.study.words.lists import called
from centrode.study.words.roles import Roles

# Translators: {link}, {block}, {wheel} are names of links, {pivot} and {point} of points; names do not change.
LEVERS = {
    "turns": mark("The slider in {point} moves along link {link} and turns it fully about {pivot}."),
    "swings": mark(
        "The slider in {point} moves along link {link} and swings it about {pivot} through {angle}."
    ),
    "moves": mark("The slider in {point} moves along link {link} and turns it about {pivot}."),
    "still": mark("The slider in {point} moves along link {link}, which does not turn."),
}
BLOCKS = {
    "turns": mark("Link {block} slides along link {link} and turns it fully about {pivot}."),
    "swings": mark("Link {block} slides along link {link} and swings it about {pivot} through {angle}."),
    "moves": mark("Link {block} slides along link {link} and turns it about {pivot}."),
    "still": mark("Link {block} slides along link {link}, which does not turn."),
}
RESTING = {
    "turns": mark("Link {link} rests on wheel {wheel} and is turned fully about {pivot}."),
    "swings": mark("Link {link} rests on wheel {wheel} and swings about {pivot} through {angle}."),
    "moves": mark("Link {link} rests on wheel {wheel} and turns about {pivot}."),
    "still": mark("Link {link} rests on wheel {wheel} and does not turn."),
}

STILL = 1e-9
"""A link that turns less than this does not turn [rad]."""


def extent(roles: Roles, link: str) -> tuple[str, str]:
    """How a link on a pivot moves, as a key of sentences, and its angle."""
    if link not in roles.swings:
        return "moves", ""
    if roles.swings[link] < STILL:
        return "still", ""
    if roles.turns_fully(link):
        return "turns", ""
    return "swings", roles.angle_text(roles.swings[link])


def on_lever(roles: Roles, group: Aim) -> str:
    """The sentence on a link that turns to a point, a slider or a wheel."""
    key, angle = extent(roles, group.link)
    place = {"link": called(group.link), "pivot": group.pivot, "angle": angle}
    if group.contact is not None:
        return _(RESTING[key]).format(wheel=called(group.contact.link), **place)
    block = group.block or roles.mechanism.guide(group.guide).link
    if block is not None:
        return _(BLOCKS[key]).format(block=called(block), **place)
    return _(LEVERS[key]).format(point=group.target, **place)
