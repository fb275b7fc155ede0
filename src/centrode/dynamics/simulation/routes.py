"""The two routes of a simulation, and which of them a description takes: one drive, or any number of coordinates."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.contact_checks import needs_events
from centrode.structure.plan import generic_mobility

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism
    from centrode.model.simulation import Simulation

MULTIBODY, REDUCED = "multibody", "reduced"

Tell: TypeAlias = Callable[[float], None]
"""What is called with the share of a simulation that is done."""


def equations_for(mechanism: Mechanism, settings: Simulation) -> str:
    """The equations that a simulation takes: those of its settings, else the reduced one where it is enough.

    It is enough where one drive with a law has all the mobility, no drive keeps its law, the first drive's speed
    alone is given, and nothing makes events but dry friction.
    """
    if settings.equations is not None:
        return settings.equations
    if settings.keeps or settings.speeds or needs_events(mechanism):
        return MULTIBODY
    if len(mechanism.drives) != 1 or not mechanism.drives[0].has_law:
        return MULTIBODY
    return MULTIBODY if generic_mobility(mechanism) > 1 else REDUCED


def moves_freely(mechanism: Mechanism) -> bool:
    """Whether only its simulation moves a mechanism: it has fewer drives with a law than degrees of freedom."""
    if mechanism.simulation is None:
        return False
    if not mechanism.drives or not all(drive.has_law for drive in mechanism.drives):
        return True
    return len(mechanism.drives) < generic_mobility(mechanism)


def no_settings() -> InputError:
    """The refusal of a mechanism whose simulation nothing describes."""
    return InputError(
        "[simulation]",
        _("it is missing"),
        _('give driving = "20 - 2*v" and duration, or pass ct.Simulation'),
    )
