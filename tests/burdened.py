"""Random masses and loads of mechanisms, as the campaign of reactions has them."""

from __future__ import annotations

from tools.campaigns.reactions.burden import burdened, kinetic_energy, powers, velocity_of_centre

__all__ = ["burdened", "kinetic_energy", "powers", "velocity_of_centre"]
