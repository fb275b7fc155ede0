"""Allocation: closed forms of one bound, conditions of optimality of several, grades, and what tolerances say back."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls

import centrode as ct

PATHS = [
    "links.OA.length", "links.AB.points.B.x", "links.CD.points.B.x",
    "frame.points.C.x", "links.CD.points.D.x", "links.DH.points.H.x",
]  # fmt: skip
STROKE = "range(position_H_x)"
COSTS = dict(zip(PATHS, (1.0, 2.0, 0.5, 4.0, 1.0, 3.0), strict=True))


def gradient(name: str = STROKE) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.asarray(ct.sensitivity("six-bar-press", [name], by=PATHS)[f"gradient.{name}"])


def test_worst_case_closed_form() -> None:
    found = ct.allocate_tolerances("six-bar-press", {STROKE: 5e-3}, by=PATHS, costs=COSTS)
    slopes, costs = np.abs(gradient()), np.array(list(COSTS.values()))
    shape = np.sqrt(costs / slopes)
    assert found.halves == pytest.approx(5e-3 * shape / (slopes * shape).sum(), rel=1e-12)
    assert found.use[STROKE] == pytest.approx(1.0, rel=1e-12)


def test_statistical_closed_form() -> None:
    found = ct.allocate_tolerances(
        "six-bar-press", {STROKE: 5e-3}, by=PATHS, costs=COSTS, method="statistical"
    )
    slopes, costs = np.abs(gradient()), np.array(list(COSTS.values()))
    shape = (costs / slopes**2) ** (1 / 3)
    assert found.halves == pytest.approx(5e-3 * shape / np.sqrt(((slopes * shape) ** 2).sum()), rel=1e-12)


def test_equal_tolerances() -> None:
    found = ct.allocate_tolerances("six-bar-press", {STROKE: 5e-3}, by=PATHS, kind="equal")
    assert found.halves == pytest.approx(5e-3 / np.abs(gradient()).sum(), rel=1e-12)


@pytest.mark.parametrize("method", ["worst case", "statistical"])
def test_several_bounds_obey_the_conditions_of_optimality(method: str) -> None:
    """Of a convex programme: costs' slopes are a sum of those of the bounds that hold, with positive multipliers."""
    bounds = {STROKE: 4e-3, "position.H.x": 4e-3, "max(angle_CD)": 3e-3}
    found = ct.allocate_tolerances("six-bar-press", bounds, by=PATHS, costs=COSTS, method=method, samples=91)
    power = 1 if method == "worst case" else 2
    rows = []
    for name, most in bounds.items():
        slopes = np.asarray(ct.sensitivity("six-bar-press", [name], by=PATHS, samples=91)[f"gradient.{name}"])
        rows.append(np.abs(slopes.reshape(-1, len(PATHS))) / most)
    weights = np.concatenate(rows) ** power
    used = (weights * found.halves**power).sum(axis=1)
    assert used.max() == pytest.approx(1.0, rel=1e-9)
    active = used > 1 - 1e-6
    slopes = np.array(list(COSTS.values())) / found.halves
    # of neighbouring samples one alone holds exactly: the least multipliers that explain the slopes
    multipliers, left = nnls((weights[active] * power * found.halves**power).T, slopes)
    assert left < 1e-4 * np.linalg.norm(slopes)
    assert (multipliers > 0).sum() >= 2


def test_no_other_tolerances_are_cheaper() -> None:
    bounds = {STROKE: 5e-3, "max(angle_CD)": 3e-3}
    found = ct.allocate_tolerances("six-bar-press", bounds, by=PATHS, costs=COSTS)
    weights = np.array([np.abs(gradient(name)) / most for name, most in bounds.items()])
    costs = np.array(list(COSTS.values()))
    random = np.random.default_rng(1)
    others = found.halves * np.exp(0.3 * random.normal(size=(20_000, len(PATHS))))
    others /= (others @ weights.T).max(axis=1)[:, None]
    assert (costs / others).sum(axis=1).min() >= found.cost * (1 - 1e-9)


def test_grades() -> None:
    mechanism = ct.four_bar("100 mm", "350 mm", "300 mm", "400 mm")
    paths = ["links.crank.length", "links.coupler.length", "links.rocker.length"]
    found = ct.allocate_tolerances(mechanism, {"range(angle_rocker)": 1e-3}, by=paths, kind="grade")
    assert len(set(found.grades)) == 1
    assert found.use["range(angle_rocker)"] <= 1.0
    # the next grade is some 60 % wider
    assert found.use["range(angle_rocker)"] > 1 / 1.7
    cheap = ct.allocate_tolerances(mechanism, {"range(angle_rocker)": 1e-3}, by=paths)
    assert all(grade > 0 for grade in cheap.grades)
    assert (cheap.rounded <= cheap.halves * (1 + 1e-12)).all()
    assert cheap.rounded_use["range(angle_rocker)"] <= 1.0


def test_a_length_without_influence_is_not_bounded() -> None:
    found = ct.allocate_tolerances(
        "crank-rocker", {"max(position_A_x)": 1e-3}, by=["links.OA.length", "links.AB.length"]
    )
    assert np.isinf(found.halves[1])
    assert np.isfinite(found.cost)


def test_the_true_worst_case_of_what_was_allocated() -> None:
    found = ct.allocate_tolerances("six-bar-press", {STROKE: 1e-4}, by=PATHS)
    limits = {path: (-half, half) for path, half in zip(PATHS, found.halves, strict=True)}
    output = ct.tolerances("six-bar-press", STROKE, limits, draws=10)[STROKE]
    assert float(output.linear.upper) == pytest.approx(1e-4, rel=1e-12)
    assert float(output.true.upper) == pytest.approx(1e-4, rel=1e-3)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, "no output has bounds"),
        ({"bounds": {STROKE: (2.0, 3.0)}}, "outside its bounds"),
        ({"bounds": {STROKE: 1e-3}, "method": "worst"}, "worst case"),
        ({"bounds": {STROKE: 1e-3}, "kind": "cheap"}, "no"),
        ({"bounds": {STROKE: 1e-3}, "by": ["links.OA.mass"]}, "not a number|depend on none"),
        ({"bounds": {STROKE: 1e-3}, "by": ["frame.points.C.x"], "kind": "grade"}, "no grade"),
        (
            {"bounds": {STROKE: 1e-3}, "by": ["links.OA.length", "guides.H.direction"], "kind": "equal"},
            "equal",
        ),
        (
            {"bounds": {STROKE: 1e-3}, "costs": {"links.OA.length": 0.0}, "by": ["links.OA.length"]},
            "positive",
        ),
        ({"bounds": {"position.Q.x": 1e-3}}, '"Q"'),
    ],
)
def test_refusals(arguments: dict[str, object], words: str) -> None:
    with pytest.raises(ct.InputError, match=words):
        ct.allocate_tolerances("six-bar-press", **arguments)  # type: ignore[arg-type]
