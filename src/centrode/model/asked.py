"""What a description asks for besides the mechanism: display, assembly, study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, PlainValidator

from centrode.locale import _
from centrode.model import limits
from centrode.model.entries import choice, listed, table
from centrode.model.frozen import FrozenMap
from centrode.model.names import read_name
from centrode.model.part import Part
from centrode.model.problems import KEY, Problem, shown
from centrode.model.values import EndOfMotion, PlaceOfMotion
from centrode.quantities import ANGLES, LENGTHS

REACHABLE = "reachable"
"""The range that a drive reaches from its initial position."""

Side = Literal["left", "right", "ahead", "behind"]


def read_samples(value: object) -> int:
    """A number of samples."""
    if isinstance(value, bool) or not isinstance(value, int):
        raise Problem(_("{key} must be a whole number, got {value}").format(key=KEY, value=shown(value)))
    if not 1 <= value <= limits.SAMPLES:
        what = _("{key} must lie between 1 and {most}, got {value}")
        repair = _("ask for fewer samples") if value > 0 else _("ask for more samples")
        raise Problem(what.format(key=KEY, most=limits.SAMPLES, value=shown(value)), repair)
    return value


class Display(Part):
    """Units in which tables and figures show lengths and angles."""

    length: Annotated[str, choice(*LENGTHS)] = "m"
    angle: Annotated[str, choice(*ANGLES)] = "rad"


class Assembly(Part):
    """Which way groups are assembled, and what happens at change points.

    Attributes
    ----------
    sides : mapping of a group's point, link or guide to "left", "right", "ahead" or "behind"
        Left or right of the line between the group's two known points, in description order; ahead or
        behind along a guide. Needed where the initial position does not tell.
    continuation : "smooth" or "keep"
        Run through change points smoothly, or keep the sign of the assembly.
    """

    sides: Annotated[
        Mapping[str, Annotated[Side, choice("left", "right", "ahead", "behind")]],
        table(read_name, limits.POINTS),
        AfterValidator(FrozenMap[str, Side]),
    ] = FrozenMap({})
    continuation: Annotated[Literal["smooth", "keep"], choice("smooth", "keep")] = "smooth"


class Study(Part):
    """What is to be computed.

    Attributes
    ----------
    samples : int
        Number of samples.
    instants : tuple of float [rad or m; s if there are several drives]
        Values of the drive at which positions are shown.
    start, stop : float [rad or m; s if the drive is a law of time or there are several]
        Range of the drive's value; "from" and "to" in a file.
    range : "reachable"
        In place of these: between the limits about the initial position, without limits one turn.
    """

    samples: Annotated[int, PlainValidator(read_samples)] | None = None
    instants: Annotated[tuple[PlaceOfMotion, ...], listed(limits.INSTANTS)] = ()
    start: Annotated[EndOfMotion | None, Field(alias="from")] = None
    stop: Annotated[EndOfMotion | None, Field(alias="to")] = None
    range: Annotated[Literal["reachable"], choice(REACHABLE)] | None = None

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        ends = [key for key in ("from", "start", "to", "stop") if given.get(key) is not None]
        wrong = super().key_problems(given)
        if given.get("range") is not None and ends:
            names = ", ".join(("range", *ends))
            wrong.append(Problem(_("{names} are given together").format(names=names), _("keep one of them")))
        return wrong
