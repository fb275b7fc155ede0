"""Works, energies and occasions of a simulation, whichever equations moved it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING

from centrode.sheets.sheet import Fact
from centrode.sheets.texts import NOTHING, Name, Number, Sentence, Text

if TYPE_CHECKING:
    import xarray as xr

SHOWN = 8
"""Occasions and coordinates that are shown one by one."""
ADAPTIVE, STIFF = Name("DOP853"), Name("Radau")
"""Integrators of the adaptive schemes."""
WORKS = ("work_of_drive", "work_of_friction", "work_of_other_loads")
ENERGIES_TITLE, ENERGIES_CAPTION = Sentence("Energies and works"), Sentence("Energies and works over time")
RESIDUAL = Sentence(
    "Residual of the energy balance over the whole motion: {share} of the greatest work or energy."
)


def works_at_end(run: xr.Dataset) -> Text:
    """Works of the drive, of friction and of other loads at the end."""
    drive, friction, others = (
        Number(float(run[name].values[-1]) + 0.0 if run.sizes["sample"] else 0.0, "J") for name in WORKS
    )
    return Sentence(
        "drive {drive}, friction {friction}, other loads {others}",
        drive=drive,
        friction=friction,
        others=others,
    )


def energies_at_end(run: xr.Dataset) -> Text:
    """Kinetic energy at the end, what potential energy has grown by, and what the works do not account for."""
    kinetic, potential = (run[name].values for name in ("kinetic_energy", "potential_energy"))
    gained = float(potential[-1] - potential[0]) + 0.0 if potential.size else 0.0
    return Sentence(
        "kinetic {kinetic} at the end, potential {potential}, residual {residual}",
        kinetic=Number(float(kinetic[-1]) if kinetic.size else 0.0, "J"),
        potential=Number(gained, "J", "+.6g" if gained else "g"),
        residual=Number(float(run.attrs["worst_energy_residual"]), "J", ".1e"),
    )


def occasion_facts(run: xr.Dataset, labels: Mapping[str, Sentence], places: Sequence[Text]) -> Iterator[Fact]:
    """The first occasions by their labels, each with a text of when and where, and how many more there are."""
    names = str(run["occasion_kind"].attrs["flag_meanings"]).split()
    kinds = run["occasion_kind"].values.tolist()
    for kind, place in islice(zip(kinds, places, strict=False), SHOWN):
        yield Fact(labels[names[kind]], place, is_marked=True)
    yield from (replace(fact, is_marked=True) for fact in facts_left_out(len(kinds)))


def facts_left_out(count: int) -> Iterator[Fact]:
    """How many of so many are not shown one by one."""
    if count > SHOWN:
        yield Fact(NOTHING, Sentence("and {n} more", n=Number(count - SHOWN, digits="d")))
