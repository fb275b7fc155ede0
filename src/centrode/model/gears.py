"""Gears of a mechanism: a ratio between two links, or a pair of wheels that gives it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import PlainValidator, model_validator

from centrode.locale import _
from centrode.model.gear_pairs import GEAR_PAIRS, RACK, GearPair
from centrode.model.reading import (
    FRAME,
    KEY,
    DescriptionPart,
    Problem,
    bounded_list,
)
from centrode.model.values import Name, si

SAME_RATIO = 1e-9
"""Ratios that differ by less than this share of them are one."""


def _read_ratio(value: object) -> float:
    ratio = si(value, "ratio")
    if ratio == 0:
        raise Problem(_("{key} must not be zero").format(key=KEY))
    return ratio


def read_pair_of_gear(value: object) -> GearPair | None:
    """The pair of wheels that a value names or holds: a file beside the description, a built-in one, or tables."""
    if value is None or isinstance(value, GearPair):
        return value
    pair = GEAR_PAIRS.from_value(value)
    if pair.teeth[1] == RACK:
        what = _("a wheel with a rack keeps no ratio of angles")
        raise Problem(what, _("describe the rack with [[rolling]]"))
    pair.working_mesh()
    return pair


class Gear(DescriptionPart):
    """Two links whose angles against a carrier keep a ratio: the second's turn over the first's.

    Attributes
    ----------
    links : two names
        Of links; one of them may be "frame" (a fixed sun or ring).
    carrier : "frame" or a link
        The one that holds both axes.
    ratio : float, not zero
        Negative where they turn in opposite senses; that of the pair where one is given.
    pair : GearPair
        The wheels, the first link's the pinion: ratio, centre distance and the radial force of the teeth follow. In a
        file the name of a file beside it or of a built-in pair.
    name : str
        The gear's id where its links' names will not do.
    """

    links: Annotated[tuple[Name, ...], bounded_list(2)]
    ratio: Annotated[float, PlainValidator(_read_ratio)]
    carrier: Name = FRAME
    pair: Annotated[GearPair | None, PlainValidator(read_pair_of_gear)] = None
    name: Name | None = None

    @model_validator(mode="before")
    @classmethod
    def _ratio_of_pair(cls, given: Any) -> Any:
        """The ratio of the pair, where one is given; refused where another one is given too."""
        if not isinstance(given, Mapping) or given.get("pair") is None:
            return given
        try:
            pair = read_pair_of_gear(given["pair"])
        except Problem as problem:
            raise Problem(problem.what, problem.repair, ("pair",)) from None
        assert pair is not None
        ratio = given.get("ratio")
        if ratio is not None and abs(_read_ratio(ratio) - pair.mesh_ratio) > SAME_RATIO * abs(
            pair.mesh_ratio
        ):
            what = _("the ratio {ratio:.9g} is not that of the pair, {own:.9g}")
            said = what.format(ratio=_read_ratio(ratio), own=pair.mesh_ratio)
            raise Problem(said, _("remove it: the pair gives it"), ("ratio",))
        return {**given, "pair": pair, "ratio": pair.mesh_ratio}

    @property
    def id(self) -> str:
        """The gear's name, else its two links as "OA-wheel"."""
        return self.name or "-".join(self.links)
