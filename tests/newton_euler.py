"""Equilibrium of every pin and link, as the campaign of reactions has it."""

from __future__ import annotations

from tools.campaigns.reactions.newton_euler import FRAME, Balance, dot, vector

__all__ = ["FRAME", "Balance", "dot", "vector"]
