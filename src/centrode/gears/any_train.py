"""A train of gears of whichever scheme."""

from __future__ import annotations

from typing import TypeAlias

from centrode.gears.closed_trains import ClosedTrain
from centrode.gears.planetary_trains import CarrierSeries, OrdinaryTrain, PlanetaryTrain

AnyTrain: TypeAlias = PlanetaryTrain | CarrierSeries | ClosedTrain | OrdinaryTrain
"""Every kind of train that is listed."""
