"""Reactions of a mechanism with the motion they belong to, found once, and how many equations they solve."""

from __future__ import annotations

import xarray as xr

import centrode as ct
from centrode.dynamics.kinetostatics.applied_forces import input_motion_of
from centrode.dynamics.kinetostatics.equations import Scheme
from centrode.dynamics.kinetostatics.friction import contacts_of
from centrode.dynamics.kinetostatics.reactions import reactions_at
from centrode.dynamics.loads import MassesAndLoads
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import requested_grid, solve
from centrode.structure.plan import Structure, structure_of

_last: list[tuple[ct.Mechanism, Structure]] = []


def motion_and_reactions(
    mechanism: ct.Mechanism, samples: int, around: float | None = None
) -> tuple[xr.Dataset, xr.Dataset]:
    """What `ct.motion` and `ct.reactions` give over the study's range, or so far around the initial position."""
    prepared = ready(mechanism)
    initial = prepared.kinematics.path.initial
    ends = (None, None) if around is None else (initial - around, initial + around)
    solved = solve(prepared, requested_grid(prepared, samples, *ends))
    burden = MassesAndLoads.for_reactions(mechanism)
    found = reactions_at(solved, burden, input_motion_of(solved, burden), contacts_of(mechanism))
    return dataset_of(solved), found


def structure(mechanism: ct.Mechanism) -> Structure:
    """The structure of a mechanism; that of the last one is kept, as several statements ask for it."""
    if not _last or _last[0][0] is not mechanism:
        _last[:] = [(mechanism, structure_of(mechanism))]
    return _last[0][1]


def number_of_equations(mechanism: ct.Mechanism) -> int:
    return Scheme.of(structure(mechanism)).size
