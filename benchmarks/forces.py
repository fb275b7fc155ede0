"""Reduction to the drive against the motion it rests on; reactions, and what peers take for the same."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from itertools import count

import numpy as np
import xarray as xr

import centrode as ct
from benchmarks import force_peers
from benchmarks.force_peers import ForcePeer
from benchmarks.table import Promise, Row
from benchmarks.timing import ROUNDS, Task, best_times, paired_times, ratio
from centrode.dynamics.kinetostatics.applied_forces import input_motion_of
from centrode.dynamics.kinetostatics.reactions import find, reactions_at
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.reduction import Reducer, reduction_of
from centrode.kinematics.preparation import ready
from centrode.kinematics.repeated_motion import WORTH_COMPILING
from centrode.kinematics.solve import requested_grid, solve
from centrode.tolerances.dimension_limits import length_paths

SAMPLES = 361
NAME = "six-bar-press"
MOST = 5.0
"""Times its kinematics that a reduction may take."""
MOST_REACTIONS = 20.0
"""Milliseconds that all reactions of the six-bar press may take, from the description to the labelled result."""
FOUR_BAR = "in-line-four-bar"
AS_FAST = 1.0
"""Times of ct.reactions that KinePy takes for the same joint forces, where a description is requested often."""


def reductions() -> Iterator[Row]:
    """The six-bar press: from the description, and where the motion is there already."""
    mechanism = ct.example(NAME)
    prepared = ready(mechanism)
    span = requested_grid(prepared, SAMPLES, None, None)
    solved = solve(prepared, span)
    reducer = Reducer.of(mechanism)
    times = paired_times(
        {
            "motion": functools.partial(ct.motion, mechanism, SAMPLES),
            "reduce": functools.partial(ct.reduce, mechanism, SAMPLES),
            "solve": functools.partial(solve, prepared, span),
            "reduction": functools.partial(reduction_of, solved),
            "at": functools.partial(reducer.at, span.parameter),
        }
    )
    whole = ratio(times, "reduce", "motion")
    yield Row(
        NAME,
        {
            "reduce / motion": whole,
            "its own part / solve": ratio(times, "reduction", "solve"),
            "any values again / solve": ratio(times, "at", "solve"),
        },
        note="its own part finds the jumps and labels the result",
        promises=[Promise(f"reduction of {SAMPLES} samples, times the motion", whole, at_most=MOST)],
    )


def reactions() -> Iterator[Row]:
    """The six-bar press and a four-bar linkage: from the description, and where the motion is there already."""
    for name in (NAME, FOUR_BAR):
        mechanism = ct.example(name)
        prepared = ready(mechanism)
        solved = solve(prepared, requested_grid(prepared, SAMPLES, None, None))
        burden = MassesAndLoads.in_plane(mechanism)
        pace = input_motion_of(solved, burden)
        whole: Task = functools.partial(ct.reactions, mechanism, SAMPLES)
        own: Task = functools.partial(find, solved, burden, pace)
        times = best_times(
            {"whole": whole, "own": own, "motion": functools.partial(ct.motion, mechanism, SAMPLES)}
        )
        milliseconds = {key: 1e3 * time for key, time in times.items()}
        promise = Promise(
            f"{name}, {SAMPLES} samples of all reactions [ms]", milliseconds["whole"], MOST_REACTIONS
        )
        yield Row(
            name,
            {
                "ct.reactions [ms]": milliseconds["whole"],
                "arrays alone [ms]": milliseconds["own"],
                "ct.motion [ms]": milliseconds["motion"],
            },
            promises=[promise],
        )


def against_peers() -> Iterator[Row]:
    """Times of peers over ours for the same joint forces, and how far apart these are."""
    press, four_bar = ct.example(NAME), ct.example(FOUR_BAR)
    if force_peers.HAS_KINEPY:
        yield _against("six-bar press, KinePy", press, force_peers.kinepy_press, SAMPLES, inner=True)
        yield _against("six-bar press, KinePy", press, force_peers.kinepy_press, 10 * SAMPLES - 9, inner=True)
    else:
        yield Row("KinePy", note="left out: it is not installed")
    if force_peers.HAS_FOURBARHINGE:
        yield _against("four-bar, fourbarhinge", four_bar, force_peers.hinge, SAMPLES)
    else:
        yield Row("fourbarhinge", note="left out: it is not installed")


def _against(
    name: str,
    mechanism: ct.Mechanism,
    build: Callable[[ct.Mechanism, xr.Dataset, float], ForcePeer],
    samples: int,
    *,
    inner: bool = False,
) -> Row:
    """One peer at so many samples; `inner`: it has no derivatives at the first and the last."""
    prepared = ready(mechanism)
    span = requested_grid(prepared, samples, None, None)
    burden = MassesAndLoads.in_plane(mechanism)
    ours = ct.reactions(mechanism, samples)
    peer = build(mechanism, ct.motion(mechanism, samples), float(ours["drive_rate"][0]))
    peer.solve()

    def arrays() -> None:
        fresh = solve(prepared, span)
        find(fresh, burden, input_motion_of(fresh, burden))

    def first_calls() -> None:
        fresh = solve(prepared, span)
        reactions_at(fresh, burden, input_motion_of(fresh, burden))

    for _call in range(WORTH_COMPILING):
        ct.reactions(mechanism, samples)
    # a peer's linkage is built beforehand: so is a solver, which takes other dimensions at every call
    lever = ct.solver(mechanism, length_paths(mechanism)[:1], samples, outputs=["joint_force", "balancing"])
    (length,), steps = lever.own, count()
    times = paired_times(
        {
            "peer": peer.solve,
            "whole": functools.partial(ct.reactions, mechanism, samples),
            "first": first_calls,
            "arrays": arrays,
            "kept": lambda: lever.outputs([length * (1.0 + 1e-7 * (next(steps) % 1000))]),
        },
        ROUNDS,
    )
    label, whole = f"{name}, {samples} samples", ratio(times, "peer", "whole")
    return Row(
        label,
        {
            "apart": _apart(peer, ours, slice(1, -1) if inner else slice(None)),
            "peer / arrays": ratio(times, "peer", "arrays"),
            "peer / first calls": ratio(times, "peer", "first"),
            "peer / ct.reactions": whole,
            "peer / ct.solver": ratio(times, "peer", "kept"),
        },
        promises=[Promise(f"{label}: its time over that of ct.reactions", whole, at_least=AS_FAST)]
        if inner
        else [],
    )


def _apart(peer: ForcePeer, ours: xr.Dataset, where: slice) -> float:
    """Greatest difference of joint forces and of what the drive gives, over the greatest of each."""
    drive = ours["balancing"].to_numpy()[where, 0]
    # samples that the peer lacks are left out
    found = [float(np.nanmax(np.abs(peer.drive()[where] - drive)) / np.max(np.abs(drive)))]
    for side, theirs in peer.forces().items():
        own = ours["joint_force"].sel(side=side).to_numpy()[where]
        found.append(float(np.nanmax(np.abs(theirs[where] - own)) / np.max(np.abs(own))))
    return max(found)
