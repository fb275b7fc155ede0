"""A dataset knows its topic and its description: it is shown as its result, also after it was a file."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode import notebook
from centrode.cams.cam import cam_routes
from centrode.cams.followers.geometry import FollowerCam
from centrode.cams.followers.motion_results import follower_motion_results, motion_law_results
from centrode.cams.results import shoe_profile
from centrode.dynamics.bearings.results import reaction_results
from centrode.dynamics.motion_results import study
from centrode.dynamics.reduction_results import reduction_results
from centrode.dynamics.simulation.results import simulation_results
from centrode.render.netcdf import WITHOUT_ENTRIES, read_dataset, write_dataset
from centrode.sheets.sheet import Column
from centrode.topics.presentation import RESTORED, VALUES, is_result, restored_result
from centrode.topics.registry import TOPICS

PRESS = ct.example("six-bar-press")
CRANK_ROCKER = ct.example("crank-rocker")
VALVE_CAM = ct.example("valve-cam")
WALKING_WHEEL = ct.example("walking-wheel-four-legs")

DATASETS: dict[str, Callable[[], xr.Dataset]] = {
    "run": lambda: ct.motion(PRESS, 37),
    "integrate": lambda: ct.integrate(CRANK_ROCKER, steps=20),
    "region": lambda: ct.reachable_region(ct.example("five-bar-two-drives"), samples=9),
    "angles": lambda: ct.transmission_angles(PRESS, 37),
    "reduce": lambda: ct.reduce(PRESS, 37),
    "flywheel": lambda: ct.steady_motion(PRESS, 37),
    "simulate": lambda: simulation_results(ct.example("six-bar-press-run-up"), 9, duration="1 s").simulation,
    "equilibrium": lambda: ct.equilibrium(ct.example("double-pendulum")),
    "modes": lambda: ct.modes(ct.example("double-pendulum")),
    "reactions": lambda: ct.reactions(PRESS, 37),
    "shaking": lambda: ct.shaking(PRESS, 37),
    "centres": lambda: ct.instant_centres(ct.motion(PRESS, at=[2.0, 3.0])),
    "centrodes": lambda: ct.centrodes(ct.motion(PRESS, 37), "AB"),
    "follower-motion": lambda: follower_motion_results(ct.example("valve-cam"), 37).dataset,
    "parameter-study": lambda: ct.sweep(
        "six-bar-press", {"links.OA.length": [0.34, 0.347]}, compute="flywheel"
    ),
    "sweep": lambda: ct.sweep(
        CRANK_ROCKER, {"links.AB.length": [3.4, 3.5]}, ["position.B", "angle.DB"], 9, reduce="max"
    ),
    "motion-laws": lambda: motion_law_results(ct.example("valve-cam")).dataset,
    "roller-path": lambda: ct.cam(ct.example("cam-from-curvature"), 37),
    "cam-series": lambda: ct.cam_series(ct.example("cam-from-curvature"), 9),
    "path-routes": lambda: cam_routes(ct.example("cam-from-curvature"), 9),
    "cam-profile": lambda: ct.cam_profile(WALKING_WHEEL, 37),
    "walking-wheel": lambda: shoe_profile(WALKING_WHEEL, 37),
    "cam-contact": lambda: ct.cam_contact(WALKING_WHEEL, 37),
    "follower-profile": lambda: ct.cam_profile(VALVE_CAM, 37),
    "follower-forces": lambda: ct.cam_forces(VALVE_CAM, 37),
    "sensitivity": lambda: ct.sensitivity(
        PRESS, ["range(position_H_x)", "position.H", "joint_force.B/AB.x"], samples=37
    ),
    "cam-sensitivity": lambda: ct.sensitivity(VALVE_CAM, ["lift"], samples=37),
}
VALUES_OF_FUNCTIONS: dict[str, Callable[[], object]] = {
    "flywheel": lambda: ct.flywheel(PRESS),
    "polygons": lambda: ct.force_polygons(PRESS, 2.0),
    "walking-wheel": lambda: ct.walking_wheel(WALKING_WHEEL),
    "follower-profile": lambda: ct.follower_cam(VALVE_CAM),
}


def same_column(first: Column, second: Column) -> bool:
    """Whether two columns agree to the last bit, absent numbers included."""
    if isinstance(first.values, np.ndarray) and isinstance(second.values, np.ndarray):
        numbers = first.values.dtype.kind == "f"
        return first.name == second.name and np.array_equal(first.values, second.values, equal_nan=numbers)
    return first == second


def test_every_topic_with_a_dataset_is_looked_at() -> None:
    assert set(DATASETS) == set(RESTORED)


@pytest.mark.parametrize("topic", DATASETS)
def test_a_dataset_is_its_result_and_stays_so_in_a_file(topic: str, tmp_path: Path) -> None:
    dataset = DATASETS[topic]()
    assert dataset.attrs["topic"] == topic
    write_dataset(dataset, tmp_path / "result.nc")
    again = ct.open(tmp_path / "result.nc")
    assert set(again.variables) == set(dataset.variables)
    assert WITHOUT_ENTRIES not in again.attrs
    assert ct.summary(again) == ct.summary(dataset) == str(ct.Result(again))
    told, read = ct.tables(dataset), ct.tables(again)
    assert list(told) == list(read)
    for name, table in told.items():
        columns = zip(table.columns, read[name].columns, strict=True)
        assert all(same_column(*pair) for pair in columns), name
    assert type(restored_result(again)).__name__ == RESTORED[topic].result.name
    assert ct.Result(again).dataset is again


@pytest.mark.parametrize("topic", VALUES_OF_FUNCTIONS)
def test_a_value_that_knows_its_description_is_shown_as_its_result(topic: str) -> None:
    known = {one.name: one for one in TOPICS}[topic]
    assert known in VALUES.values()
    value = VALUES_OF_FUNCTIONS[topic]()
    result = known.compute(PRESS, at=[2.0]) if topic == "polygons" else None
    if result is None:
        result = known.compute(value.mechanism if hasattr(value, "mechanism") else value.cam)
    assert type(restored_result(value)) is type(result)
    assert ct.summary(value) == ct.summary(result)
    assert list(ct.tables(value)) == list(ct.tables(result))


def test_every_topic_with_a_value_is_looked_at() -> None:
    assert set(VALUES_OF_FUNCTIONS) == {topic.name for topic in VALUES.values()}


def test_a_value_without_description_is_refused() -> None:
    body = ct.follower_cam(VALVE_CAM)
    plain = FollowerCam(body.motion, body.guide, body.touch, body.base_radius, body.sense)
    with pytest.raises(ct.InputError, match="knows no description"):
        ct.summary(plain)


@pytest.mark.parametrize(
    "name", ["six-bar-press", "wiper", "five-bar-two-drives", "slider-between-cranks-locked"]
)
def test_a_motion_says_what_the_study_of_its_mechanism_says(name: str) -> None:
    mechanism = ct.example(name)
    assert ct.summary(ct.motion(mechanism, 37)) == ct.summary(study(mechanism, 37))


def test_single_places_of_a_motion_have_reactions_without_bearing_loads() -> None:
    single = restored_result(ct.motion(PRESS, at=[2.0]))
    assert single.reactions.at == (2.0,) and single.reactions.loads is None
    assert "samples                1: ok 1" in ct.summary(ct.motion(PRESS, at=[2.0]))


def test_coefficients_and_curvature_are_parts_of_results() -> None:
    two = ct.example("five-bar-two-drives")
    coefficients = ct.kinematic_coefficients(two, 9)
    assert ct.summary(coefficients) == ct.summary(ct.motion(two, 9))
    assert "coefficients" in ct.tables(coefficients)
    bends = ct.curvature(PRESS, "AB", [2.0])
    assert restored_result(bends).curvature is bends


def test_the_whole_result_and_its_dataset_say_the_same() -> None:
    results = reaction_results(PRESS, 37)
    assert ct.summary(results) == ct.summary(results.reactions)
    reduced = reduction_results(PRESS, 37)
    assert ct.summary(reduced) == ct.summary(reduced.reduction)


def test_reactions_at_single_places_have_no_bearing_loads() -> None:
    single = ct.reactions(PRESS, at=[2.0])
    assert ct.summary(single) == ct.summary(reaction_results(PRESS, at=[2.0]))


def test_a_simulation_says_by_which_settings_it_ran() -> None:
    run = DATASETS["simulate"]()
    assert restored_result(run).settings.duration == 1.0


def test_what_is_no_result_is_refused() -> None:
    motion = ct.motion(PRESS, 5)
    for strange in (
        xr.Dataset(),
        motion.assign_attrs(topic="nothing"),
        ct.transmission_angles(PRESS, 5).assign_attrs(mechanism=3),
    ):
        assert not is_result(strange)
        with pytest.raises(ct.InputError, match="names no topic"):
            ct.summary(strange)
    with pytest.raises(ct.InputError, match=r"lacks a part.*least_transmission_angle"):
        ct.summary(ct.transmission_angles(PRESS, 5).drop_vars("least_transmission_angle"))
    for part in (
        motion[["position", "status"]],
        motion.isel(point=[1]),
        motion.transpose(),
        motion.isel(sample=3),
    ):
        with pytest.raises(ct.InputError, match="lacks a part"):
            ct.summary(part)
    with pytest.raises(ct.InputError, match="can be shown"):
        ct.summary(3)


def test_batches_have_no_sheet() -> None:
    several = ct.motion(CRANK_ROCKER, 5, vary={"links.AB.length": [3.4, 3.5]})
    assert not is_result(several)
    assert not is_result(ct.instant_centres(several))


def test_a_notebook_shows_results_our_way_and_other_datasets_their_own() -> None:
    angles = ct.transmission_angles(PRESS, 37)
    shown = notebook.result_html(angles)
    assert "<svg" in shown and "least transmission angle" in shown and "xr-wrap" in shown
    other = xr.Dataset({"a": ("x", [1.0])})
    assert "<svg xmlns:xlink" not in notebook.result_html(other) and "xr-wrap" in notebook.result_html(other)
    assert "<svg" in notebook.result_html(ct.Result(angles))


@pytest.mark.parametrize(
    "bytes_of", [b"", b"CDF\x01", b"CDF\x01" + b"\xff" * 64, b"\x89HDF\r\n\x1a\n" + bytes(64)]
)
def test_damaged_files_are_refused_in_words(bytes_of: bytes, tmp_path: Path) -> None:
    file = tmp_path / "result.nc"
    file.write_bytes(bytes_of)
    with pytest.raises(ct.InputError):
        ct.open(file)
    with pytest.raises(ct.InputError, match="no such file"):
        ct.open(tmp_path / "absent.nc")


def test_a_file_of_something_else_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "other.nc"
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(file, engine="scipy")
    with pytest.raises(ct.InputError, match="names no topic"):
        ct.open(file)


@pytest.mark.parametrize(
    "text", ["no JSON", json.dumps({"a": [["x"], [1 << 70], "<f8", {}]}), "[]", '{"a": 1}']
)
def test_forged_absences_are_refused(text: str, tmp_path: Path) -> None:
    file = tmp_path / "forged.nc"
    xr.Dataset({"b": ("y", [1.0])}, attrs={WITHOUT_ENTRIES: text}).to_netcdf(file, engine="scipy")
    with pytest.raises(ct.InputError):
        read_dataset(file)
