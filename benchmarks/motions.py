"""Worked mechanisms and batches of them: centrode against the compiled solver of pylinkage."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from benchmarks import peer
from benchmarks.table import Promise, Row
from benchmarks.timing import best_times
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import requested_grid, solve
from centrode.structure.dimensions import Dimensions, dimensions_of

Array = npt.NDArray[np.float64]
SAMPLES = 361
BATCH = 1000
WORKED = (
    "slider-between-cranks", "six-bar-press", "four-bar-excerpt", "crank-rocker", "slider-crank-offset", "jansen-leg",
)  # fmt: skip
BATCHES: Mapping[str, tuple[str, ...]] = {
    "crank-rocker": ("links.AB.length", "links.DB.length"),
    "six-bar-press": ("links.OA.length", "links.DH.points.H.x"),
}
"""Mechanisms of the batches, and the dimensions that vary by two per cent."""
AGREE = 1e-9
"""Greatest difference of positions that counts as the same, in units of the greatest length."""


CLEAR, THROUGH_EVENTS = 16.0, 60.0
"""Milliseconds that one motion with a group of higher class, or through change points, may take."""
SINGLE: Mapping[str, float | None] = {
    "crank-rocker": None, "slider-crank-offset": None, "six-bar-press": None, "spherical-four-bar": None,
    "third-class-triad": CLEAR, "fourth-class-group": CLEAR, "stephenson-driven-at-rocker": THROUGH_EVENTS,
    "watt-driven-second-loop": THROUGH_EVENTS, "scissor-lift": THROUGH_EVENTS,
    "scissor-lift-cylinder": THROUGH_EVENTS,
}  # fmt: skip
"""Mechanisms of which one motion is timed, and the most that it may take [ms]. The search for events looks beyond the
range that is requested: rocker drives meet their limits there."""
KEPT = 64
"""Descriptions that take turns: more than the program keeps made ready."""


def single_motions() -> Iterator[Row]:
    """One motion with labels: of a description asked for again, and of a new one whose form is known."""
    for name, most in SINGLE.items():
        mechanism = ct.example(name)
        new = itertools.cycle([mechanism.model_copy(update={"title": str(k)}) for k in range(KEPT)])
        times = best_times(
            {
                "again": functools.partial(ct.motion, mechanism, SAMPLES),
                "new": lambda new=new: ct.motion(next(new), SAMPLES),  # type: ignore[misc]
            }
        )
        again, first = 1e3 * times["again"], 1e3 * times["new"]
        promises = (
            [] if most is None else [Promise(f"{name}, one motion of {SAMPLES} samples [ms]", first, most)]
        )
        yield Row(name, {"again [ms]": again, "new [ms]": first}, promises=promises)


def worked_mechanisms() -> Iterator[Row]:
    """One mechanism at a time: what is ready to move, and all the work from its description."""
    for name in WORKED:
        mechanism = ct.example(name)
        prepared = ready(mechanism)
        motion = ct.motion(mechanism, SAMPLES)
        try:
            other = peer_of(prepared, prepared.structure.dimensions, motion)
        except peer.CannotBuild as reason:
            yield Row(name, note=f"pylinkage cannot: {reason}")
            continue
        difference = _difference(motion, other, prepared)
        if difference > AGREE:
            yield Row(name, note=f"positions differ by {difference:.1e}: not compared")
            continue
        times = best_times(
            {
                "solve": functools.partial(solve, prepared, requested_grid(prepared, SAMPLES, None, None)),
                "motion": functools.partial(ct.motion, mechanism, SAMPLES),
                "peer positions": functools.partial(other.positions, SAMPLES),
                "peer motion": functools.partial(other.motion, SAMPLES),
                "peer from nothing": functools.partial(_peer_from_nothing, prepared, motion),
            }
        )
        yield Row(
            name,
            {
                "solve / peer positions": times["solve"] / times["peer positions"],
                "solve / peer with derivatives": times["solve"] / times["peer motion"],
                "motion / peer built and run": times["motion"] / times["peer from nothing"],
            },
            note=f"positions agree to {difference:.0e}",
        )


def batches() -> Iterator[Row]:
    """A thousand mechanisms of one structure, every sample with velocities and accelerations."""
    for name, paths in BATCHES.items():
        batch = _batch(name, paths)
        motion = functools.partial(ct.motion, batch.mechanism, SAMPLES, vary=batch.vary)
        peers = [
            peer_of(batch.prepared, _lane(batch.numbers, lane), batch.motion.isel(mechanism=lane))
            for lane in range(BATCH)
        ]
        difference = max(
            _difference(batch.motion.isel(mechanism=lane), peers[lane], batch.prepared)
            for lane in range(0, BATCH, BATCH // 10)
        )
        if difference > AGREE:
            yield Row(name, note=f"positions differ by {difference:.1e}: not compared")
            continue
        times = best_times(
            {
                "motion": motion,
                "solve": functools.partial(
                    solve,
                    batch.prepared,
                    requested_grid(batch.prepared, SAMPLES, None, None),
                    numbers=batch.numbers,
                    lanes=BATCH,
                ),
                "peer": functools.partial(peer.run_batch, peers, SAMPLES),
            },
            rounds=5,
        )
        yield Row(
            f"{name} x {BATCH}",
            {
                "motion / peer": times["motion"] / times["peer"],
                "solve / peer": times["solve"] / times["peer"],
                "ns per position: motion": 1e9 * times["motion"] / (BATCH * SAMPLES),
                "solve": 1e9 * times["solve"] / (BATCH * SAMPLES),
                "peer": 1e9 * times["peer"] / (BATCH * SAMPLES),
            },
            note=f"positions agree to {difference:.0e}",
        )


@dataclass(frozen=True)
class Batch:
    """Mechanisms of one structure with the motion that says where the peer has to start."""

    mechanism: ct.Mechanism
    prepared: Ready
    vary: dict[str, Array]
    numbers: Dimensions
    motion: xr.Dataset


def _batch(name: str, paths: tuple[str, ...]) -> Batch:
    mechanism = ct.example(name)
    random = np.random.default_rng(0)
    vary = {path: float(ct.value_at(mechanism, path)) * random.uniform(0.98, 1.02, BATCH) for path in paths}
    motion = ct.motion(mechanism, SAMPLES, vary=vary)
    return Batch(mechanism, ready(mechanism), vary, dimensions_of(mechanism, vary), motion)


def _lane(numbers: Dimensions, lane: int) -> Dimensions:
    return numbers.map_numbers(lambda x: x if isinstance(x, float) else float(x[lane]))


def peer_of(prepared: Ready, numbers: Dimensions, motion: xr.Dataset) -> peer.Peer:
    """The peer of one mechanism, where its motion begins."""
    places = motion["position"].isel(sample=0)
    names = [str(point) for point in places["point"].values]
    at = {name: (float(x), float(y)) for name, (x, y) in zip(names, places.values, strict=True)}
    return peer.build(prepared, numbers, at, SAMPLES)


def _peer_from_nothing(prepared: Ready, motion: xr.Dataset) -> tuple[Array, Array, Array]:
    return peer_of(prepared, prepared.structure.dimensions, motion).motion(SAMPLES)


def _difference(motion: xr.Dataset, other: peer.Peer, prepared: Ready) -> float:
    """Greatest difference of positions, in units of the greatest length; the peer starts anew."""
    other.reset()
    theirs = other.motion(SAMPLES)[0][:, other.columns]
    ours = motion["position"].sel(point=list(other.points)).values
    return float(np.max(np.abs(ours - theirs)) / prepared.structure.dimensions.scale)
