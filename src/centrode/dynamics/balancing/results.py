"""Shaking forces of a mechanism over its motion, and the counterweights that would balance it fully."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.dynamics.balancing.balance import Balance, balance
from centrode.dynamics.balancing.shaking_forces import shaking
from centrode.dynamics.masses import has_masses_or_loads
from centrode.errors import CentrodeError

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class ShakingResults:
    """Shaking forces and moments on the frame of a planar mechanism.

    Attributes
    ----------
    mechanism : the mechanism
    shaking : dataset of `shaking`, over the motion
    balance : full balance of the shaking force; None where there is none, or nothing with mass moves
    refusal : why there is none, in sentences; empty otherwise
    """

    mechanism: Mechanism
    shaking: xr.Dataset
    balance: Balance | None
    refusal: str

    @property
    def is_shaken(self) -> bool:
        """Whether anything with mass moves."""
        return bool(self.shaking["shaking_force"].values.any())


def shaking_results(mechanism: Mechanism, samples: int | None = None) -> ShakingResults:
    """Shaking forces over the motion, and the full balance where there is one.

    Raises InputError, MotionError and NotComputedYet as `shaking`; where only the balance fails, the result says why.
    """
    return results_of_shaking(mechanism, shaking(mechanism, samples))


def results_of_shaking(mechanism: Mechanism, data: xr.Dataset) -> ShakingResults:
    """A dataset of `shaking` with the full balance where there is one."""
    if not data["shaking_force"].values.any():
        return ShakingResults(mechanism, data, None, "")
    try:
        return ShakingResults(mechanism, data, balance(mechanism, samples=data.sizes["sample"]), "")
    except CentrodeError as refusal:
        return ShakingResults(mechanism, data, None, str(refusal))


def may_shake(mechanism: Mechanism) -> bool:
    """Whether a mechanism is planar and has masses or loads."""
    return mechanism.space == "plane" and has_masses_or_loads(mechanism)
