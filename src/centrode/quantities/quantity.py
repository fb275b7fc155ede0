"""One variable of a result, with its symbol and unit, and the words for statuses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from centrode.errors import Status
from centrode.locale import _, mark
from centrode.quantities.units import display_unit, powers_of, typeset_unit, unit_text

STATUS_WORDS: Mapping[Status, str] = {
    Status.OK: mark("ok"),
    Status.OPEN: mark("open"),
    Status.CUT_OFF: mark("cut off"),
    Status.SINGULAR: mark("singular"),
    Status.UNCONVERGED: mark("unconverged"),
    Status.SELF_LOCKING: mark("self-locking"),
}


@dataclass(frozen=True)
class Quantity:
    """One variable of a result.

    Attributes
    ----------
    name : str
        Name of the variable, ASCII.
    symbol : str
        As formulas and plots write it.
    unit : str
        SI unit where the drive is an angle.
    long_name : str
        What it is, in English; `title` says it in the chosen language.
    by_drive : int
        How many times it is divided by the drive's unit: 1 and 2 for kinematic coefficients, -1 for the
        drive's own value, 0 for what does not depend on the kind of drive.
    """

    name: str
    symbol: str
    unit: str
    long_name: str
    by_drive: int = 0

    @property
    def title(self) -> str:
        """What it is, in the chosen language."""
        return _(self.long_name)

    def for_drive(self, drive_unit: str) -> Quantity:
        """The same quantity where the drive's value is in `drive_unit`: "rad" (an angle) or "m"."""
        powers = powers_of(self.unit)
        powers["rad"] = powers.get("rad", 0) + self.by_drive
        powers[drive_unit] = powers.get(drive_unit, 0) - self.by_drive
        if drive_unit != "rad" and powers.keys() & {"kg", "N"}:
            powers.pop("rad", None)  # moments and inertias of an angle are written without their radians
        return replace(self, unit=unit_text(powers))

    def by_drives(self, drive_units: Sequence[str]) -> Quantity:
        """The same quantity, a kinematic coefficient, by one or two drives with values in these units."""
        powers = powers_of(self.unit)
        powers["rad"] = powers.get("rad", 0) + self.by_drive
        for unit in drive_units:
            powers[unit] = powers.get(unit, 0) - 1
        return replace(self, unit=unit_text(powers))

    def on_sphere(self) -> Quantity:
        """The same quantity on the unit sphere, where displacements along guides are arcs and places plain numbers."""
        powers = powers_of(self.unit)
        length = powers.pop("m", 0)
        if self.name.startswith("slide") or self.name in ("fixed_arc", "moving_arc"):
            powers = {"rad": length + powers.pop("rad", 0), **powers}
        return replace(self, unit=unit_text({base: power for base, power in powers.items() if power}))

    def label(self, length: str = "m", angle: str = "rad") -> str:
        """Title, symbol and the unit it is shown in, for the axis of a plot: "angular velocity ω, deg/s"."""
        shown = display_unit(self.unit, length, angle)[1]
        name = f"{self.title} {self.symbol}".rstrip()
        return name if shown == "1" else f"{name}, {typeset_unit(shown)}"


def status_word(status: int) -> str:
    """The word for a status in the chosen language."""
    return _(STATUS_WORDS[Status(status)])
