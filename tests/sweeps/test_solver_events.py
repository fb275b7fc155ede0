"""Derivatives of a solver where there are limits and change points, against differences; and links that wind anew."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct

OUTPUTS = [
    "position.B", "velocity.B", "angle", "max(position_B_x)", "mean(position_B_y)", "range(angle_DB)",
    "sum(sin(angle_DB))", "max(abs(position_B_x - mean(position_B_x)))",
]  # fmt: skip
LIMITED = [2.2, 1.5]
"""Crank and coupler that make the four-bar a double rocker: samples that are open, and cut off."""


def test_derivatives_between_limits_are_differences() -> None:
    solver = ct.solver("crank-rocker", ["links.OA.length", "links.AB.length"], 73, outputs=OUTPUTS)
    frame, slopes, values = solver.move(LIMITED), solver.gradient(LIMITED), np.array(LIMITED)
    assert not frame.is_clear
    assert set(frame.status.tolist()) == {ct.Status.OK, ct.Status.OPEN, ct.Status.CUT_OFF}
    # wherever there is a number there is a derivative, on the other side of a limit as well
    np.testing.assert_array_equal(np.isfinite(slopes).all(axis=1), np.isfinite(solver.outputs(LIMITED)))
    step = 1e-6
    for k in range(2):
        off = step * np.eye(2)[k]
        difference = (solver.outputs(values + off) - solver.outputs(values - off)) / (2.0 * step)
        good = np.isfinite(slopes[:, k])
        # rounding over the step; next to a limit the third derivatives are great
        np.testing.assert_allclose(slopes[good, k], difference[good], rtol=1e-6, atol=1e-6)


def test_there_is_no_derivative_at_a_limit() -> None:
    # the crank of a double rocker at its limit, to the last bit or so
    solver = ct.solver("crank-rocker", ["links.AB.length"], at=[0.0, 1.0], outputs="position.B.x")
    mechanism = ct.with_value(ct.example("crank-rocker"), "links.OA.length", 2.2)
    limit = ct.motion(ct.with_value(mechanism, "links.AB.length", 1.5), 73).event_value.values[0]
    solver = ct.solver(mechanism, ["links.AB.length"], at=[0.5 * limit, limit], outputs="position.B.x")
    slopes = solver.gradient([1.5])
    np.testing.assert_array_equal(np.isfinite(slopes[:, 0]), [True, False])


def test_behind_a_change_point_there_is_no_derivative_by_what_it_hangs_on() -> None:
    solver = ct.solver("kite", ["links.AB.length"], 73, outputs="position.B")
    frame, slopes = solver.move(solver.own), solver.gradient(solver.own).reshape(73, 2)
    assert (frame.status == ct.Status.OK).all()
    assert frame.events[0].kind == "change point"
    # other lengths have no change point: the motion between this one's two is another one there
    first, second = (event.at for event in frame.events)
    between = (solver.parameter > first) & (solver.parameter < second)
    assert 30 < between.sum() < 40
    np.testing.assert_array_equal(np.isnan(slopes).all(axis=1), between)
    assert np.isfinite(slopes[~between]).all()
    step = 1e-7
    one, other = (solver.outputs([solver.own[0] + x]).reshape(73, 2) for x in (step, -step))
    difference = (one - other) / (2.0 * step)
    near = np.minimum(np.abs(solver.parameter - first), np.abs(solver.parameter - second))
    far = ~between & (near > 0.3)
    np.testing.assert_allclose(slopes[far], difference[far], rtol=1e-5, atol=1e-5)


def test_groups_of_higher_class_with_events_have_no_derivatives() -> None:
    solver = ct.solver("third-class-triad", ["links.OA.length"], 37, outputs="position.C")
    for factor in (1.0, 3.0, 6.0):
        values = [factor * solver.own[0]]
        assert solver.move(values).is_clear == bool(np.isfinite(solver.gradient(values)).all())


@pytest.mark.parametrize("samples", [3, 7, 73])
def test_links_wind_as_often_as_they_do(samples: int) -> None:
    """From crank-rocker to drag link and back: rocker and coupler turn with the crank, then they do not."""
    free = ["links.OA.length", "links.AB.length", "links.DB.length", "frame.points.D.x"]
    # where the link DB stands at about the same angle in both
    mechanism = ct.with_value(ct.example("crank-rocker"), "drives.OA.start", "90 deg")
    solver = ct.solver(mechanism, free, samples)
    crank, drag = [1.0, 3.5, 3.0, 4.0], [3.0, 3.2, 3.5, 1.0]
    for values in (crank, drag, drag, crank, drag):
        frame = solver.move(values)
        vary = {path: [value] for path, value in zip(free, values, strict=True)}
        motion = ct.motion(mechanism, samples, vary=vary).isel(mechanism=0)
        assert frame.is_clear
        np.testing.assert_array_equal(frame.angle, motion.angle)
        np.testing.assert_array_equal(frame.status, motion.status)
    assert abs(frame.angle[-1, -1] - frame.angle[0, -1]) > 6.0


def test_outputs_and_moves_share_how_links_wind() -> None:
    """A gradient of a drag link between moves of a crank-rocker: the next move counts turns anew."""
    free = ["links.OA.length", "links.AB.length", "links.DB.length", "frame.points.D.x"]
    mechanism = ct.with_value(ct.example("crank-rocker"), "drives.OA.start", "90 deg")
    solver = ct.solver(mechanism, free, 73, outputs=["angle.DB", "max(angle_DB)"])
    crank, drag = [1.0, 3.5, 3.0, 4.0], [3.0, 3.2, 3.5, 1.0]
    for values in (crank, drag, crank, drag):
        own = solver.gradient(values)
        frame = solver.move(values)
        vary = {path: [value] for path, value in zip(free, values, strict=True)}
        motion = ct.motion(mechanism, 73, vary=vary).isel(mechanism=0)
        np.testing.assert_array_equal(frame.angle, motion.angle)
        np.testing.assert_allclose(frame.outputs["angle.DB"], motion.angle.sel(link="DB"), rtol=1e-15)
        assert np.isfinite(own).all()
