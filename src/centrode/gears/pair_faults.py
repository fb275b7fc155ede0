"""Why a pair of wheels cannot work: no involute at a tip, no contact, pointed teeth, interference."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.profiles import true_contact_ratio

FaultKind = Literal[
    "tip inside base", "no clearance", "contact ratio", "pointed", "fillet", "tips", "contact after undercut"
]


@dataclass(frozen=True)
class PairFault:
    """One reason why a pair cannot work.

    Attributes
    ----------
    kind : "tip inside base": the tips end inside the base circle; "no clearance": they reach the root of the other
        wheel; "contact ratio": below one; "pointed": the flanks meet below the tip; "fillet": tips of the other wheel
        run into the fillets of this one; "tips": those of an internal pair run into each other; "contact after
        undercut": what undercut leaves of the contact ratio is below one
    wheel : number of the wheel, 0 or 1; None where both are concerned
    """

    kind: FaultKind
    wheel: int | None = None


def pair_faults(pair: PairGeometry) -> Iterator[PairFault]:
    """Everything that keeps a pair with a working pressure angle from working, what others follow from first."""
    for wheel in pair.wheels:
        if wheel.tip_inside_base:
            yield PairFault("tip inside base", wheel.number)
        if not wheel.radial_clearance >= 0:
            yield PairFault("no clearance", wheel.number)
    if not pair.contact_ratio >= 1:
        yield PairFault("contact ratio")
    for wheel in pair.wheels:
        if not wheel.tip_thickness > 0:
            yield PairFault("pointed", wheel.number)
        if wheel.interferes:
            yield PairFault("fillet", wheel.number)
    if not pair.tips_clear > 0:
        yield PairFault("tips")
    if pair.contact_ratio >= 1 and not true_contact_ratio(pair) >= 1:
        yield PairFault("contact after undercut")
