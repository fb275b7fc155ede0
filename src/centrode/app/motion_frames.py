"""Motions as frames for the player of the page: by the drives' laws, and those that topics have found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import CentrodeError, Status
from centrode.kinematics.motion import motion
from centrode.kinematics.preparation import Ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.settings import shown_as
from centrode.scenes.driving_cams import driving_cams

if TYPE_CHECKING:
    from centrode.sheets.players import MotionPlayer

MOST_SAMPLES = 1441
"""Samples of one motion by the drives' laws: a quarter of a degree of a turn."""
MOST_FRAMES = 10_001
"""Samples of a motion that a topic has found."""
MOST_NUMBERS = 4_000_000
"""Numbers of such a motion, of four bytes each."""

STATUS_WORDS = tuple(Status)[:5]
ARRAYS_OF_MOTION = {
    "points": "position",
    "velocities": "velocity",
    "accelerations": "acceleration",
    "angles": "angle",
    "angular_velocities": "angular_velocity",
    "angular_accelerations": "angular_acceleration",
}
"""Array of a frame -> variable of a motion."""


def motion_answer(prepared: Ready, samples: int | None) -> tuple[dict[str, Any], dict[str, Any]]:
    """Header and arrays of the motion of a mechanism over its range."""
    mechanism = prepared.mechanism
    count = min(max(samples or mechanism.study.samples or 361, 2), MOST_SAMPLES)
    data = motion(mechanism, count)
    parameter = mechanism.motion_parameter
    variable = parameter.variable
    factor, unit = shown_as(variable.unit, mechanism.display)
    kinds = {"rad": "angle", "m": "length", "s": "time"}
    header = {
        **_names_and_statuses(data),
        "samples": count,
        "kind": kinds.get(variable.unit, "time"),
        "unit": unit,
        "factor": factor,
        "events": [
            {
                "drive": float(at),
                "kind": ("limit", "change point")[int(kind)],
                "text": _(("limit", "change point")[int(kind)]),
                "group": str(group),
            }
            for at, kind, group in zip(
                data["event_value"].to_numpy(),
                data["event_kind"].to_numpy(),
                data["event_group"].to_numpy(),
                strict=True,
            )
        ],
    }
    arrays = {"drive": np.asarray(parameter.instants(data), dtype=float), **_arrays(data)}
    header["cams"] = _add_cams(mechanism, data, arrays)
    header["start"] = _initial_sample(prepared, arrays["drive"])
    return header, arrays


def _initial_sample(prepared: Ready, instants: npt.NDArray[Any]) -> float | None:
    """Where the initial position is among the samples, between two of them as a fraction; None where the range leaves
    it out.
    """
    begins = 0.0
    if prepared.mechanism.motion_parameter.is_uniform:
        (begins,) = map(float, prepared.assembled.positions.drives.values())
    if not min(instants) <= begins <= max(instants):
        return None
    forward = 1.0 if instants[-1] >= instants[0] else -1.0
    return float(np.interp(forward * begins, forward * instants, np.arange(len(instants))))


def _names_and_statuses(data: xr.Dataset) -> dict[str, Any]:
    return {
        "points": data["point"].to_numpy().tolist(),
        # modes on the sphere have no angles of links
        "links": data["link"].to_numpy().tolist() if "link" in data.coords else [],
        "status_words": {str(int(status)): _(status.word) for status in STATUS_WORDS},
        "reached": {str(int(status)): status in (Status.OK, Status.SINGULAR) for status in STATUS_WORDS},
    }


def _arrays(data: xr.Dataset) -> dict[str, Any]:
    found = {name: data[key].to_numpy() for name, key in ARRAYS_OF_MOTION.items() if key in data}
    return {"time": data["time"].to_numpy(), **found, "status": data["status"].to_numpy()}


def _add_cams(mechanism: Mechanism, data: xr.Dataset, arrays: dict[str, Any]) -> list[dict[str, Any]]:
    """Cams that drive, as they stand at the first sample, and what follows each of them at every sample."""
    try:
        cams = driving_cams(mechanism, data, 1.0)
    except CentrodeError:
        return []
    found = []
    for k, cam in enumerate(cams):
        samples = range(len(cam.angles))
        rollers = [cam.roller(sample) for sample in samples]
        lines = [np.array(cam.lines(sample)).reshape(-1) for sample in samples]
        turned = cam.angles - cam.angles[0]
        arrays[f"cam_turns_{k}"] = turned if cam.forward else -turned
        arrays[f"cam_lines_{k}"] = np.array(lines)
        if rollers[0] is not None:
            arrays[f"cam_rollers_{k}"] = np.array([roller[0] for roller in rollers if roller is not None])
        found.append(
            {
                "centre": cam.hub.tolist(),
                "outline": cam.outline(0).tolist(),
                "mark": cam.mark(0).tolist(),
                "roller": None if rollers[0] is None else rollers[0][1],
            }
        )
    return found


# Motions of topics.


def player_frames(players: Sequence[MotionPlayer]) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Headers of the motions of a topic, and their arrays, whose names begin with the number of the motion.

    Samples are those of the topic; where they are too many, evenly chosen ones.
    """
    headers: list[dict[str, Any]] = []
    arrays: dict[str, Any] = {}
    for number, player in enumerate(players):
        data = player.motion
        chosen = chosen_samples(data)
        if len(chosen) < data.sizes["sample"]:
            data = data.isel(sample=chosen)
        own = _arrays(data)
        own["drive"] = own.pop("time")
        factor, unit = shown_as("s", player.mechanism.display)
        headers.append(
            {
                **_names_and_statuses(data),
                "samples": data.sizes["sample"],
                "kind": "time",
                "unit": unit,
                "factor": factor,
                "events": [],
                "cams": [],
            }
        )
        arrays |= {f"{number} {name}": values for name, values in own.items()}
    return headers, arrays


def chosen_samples(data: xr.Dataset) -> npt.NDArray[np.intp]:
    """Samples of a motion that fit into a frame, the first and the last among them."""
    count = data.sizes["sample"]
    return np.unique(np.linspace(0, count - 1, min(count, frames_that_fit(data))).round().astype(np.intp))


def frames_that_fit(data: xr.Dataset) -> int:
    """How many samples of a motion go into a frame."""
    numbers = sum(
        int(np.prod([size for name, size in data[key].sizes.items() if name != "sample"]))
        for key in ARRAYS_OF_MOTION.values()
        if key in data
    )
    return max(2, min(MOST_FRAMES, MOST_NUMBERS // max(numbers, 1)))
