"""Inverse dynamics of two drives with given laws, against a table that other equations made.

tests/reference/dynamics/inverse-dynamics-five-bar.csv: moments that both drives give to the five-bar in a field of
gravity with a spring, and their power; the source advises 1e-10.
"""

from __future__ import annotations

import tomllib
from functools import cache
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from free_motions import FIVE_BAR, table

ADVISED = 1e-10
PRINTED = 5e-14
"""Half a unit of the last of 13 digits, of moments under 1 N m."""
LAWS = {"AB": (1.7, "0.3*sin(2*t)"), "ED": (1.2, "0.2*sin(3*t)")}
COLUMNS = {"AB": "moment_AB", "ED": "moment_ED"}


def driven(**simulation: Any) -> ct.Mechanism:
    """The five-bar with the laws of the table."""
    made = tomllib.loads(FIVE_BAR)
    made["drives"] = [{"link": link, "start": start, "law": law} for link, (start, law) in LAWS.items()]
    made["simulation"] = {"duration": 3.0, **simulation}
    return ct.Mechanism(**made)


def known() -> dict[str, np.ndarray]:
    """The columns of the table."""
    return table("inverse-dynamics-five-bar")


@cache
def reactions() -> xr.Dataset:
    """Reactions at the instants of the table."""
    return ct.reactions(driven(), at=known()["t"])


@pytest.mark.parametrize("link", COLUMNS)
def test_moments_of_both_drives_are_those_of_the_table(link: str) -> None:
    balancing = reactions().balancing.sel(drive=link)
    assert np.abs(balancing.values - known()[COLUMNS[link]]).max() < ADVISED + PRINTED


def test_their_power_is_that_of_the_table() -> None:
    t, balancing = known()["t"], reactions().balancing
    rates = {"AB": 0.6 * np.cos(2 * t), "ED": 0.6 * np.cos(3 * t)}
    power = np.sum([balancing.sel(drive=link).values * rate for link, rate in rates.items()], axis=0)
    assert np.abs(power - known()["power"]).max() < ADVISED + PRINTED


def test_forces_that_keep_both_laws_in_a_simulation_are_those_of_the_table() -> None:
    kept = driven(keeps=[*LAWS], equations="multibody", tolerance=1e-12)
    run = ct.simulate(kept, at=known()["t"])
    for number, column in enumerate(COLUMNS.values()):
        assert np.abs(run.keeping_moment.values[:, number] - known()[column]).max() < ADVISED + PRINTED
