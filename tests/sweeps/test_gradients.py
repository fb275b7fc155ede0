"""Derivatives of reduced outputs: those of 50-digit differences of an independent formula, absent beside events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import centrode as ct
from centrode.model.kept_values import KeptValues
from centrode.numerics import machine_code
from centrode.sweeps import sweep_plans
from centrode.sweeps.folds import Fold, Slopes, States
from centrode.sweeps.sweep import read_sweep
from drives import five_bar
from mechanisms import EPS, four_bar

EXECUTORS = ["arrays", pytest.param("machine code", marks=pytest.mark.skipif(
    not machine_code.PRESENT, reason="machine code needs the extra fast"))]  # fmt: skip
SAMPLES = 25
LENGTHS = {"links.OA.length": 1.0, "links.AB.length": 3.5, "links.DB.length": 3.0, "frame.points.D.x": 4.0}
FORMULAS = {
    "error": "mean((position_B_x - 2)^2 + (position_B_y - mean(position_B_y))^2)",
    "swing": "range(angle_DB)",
    "turn": "mean(angle_AB) * links_AB_length",
    "far": "max(sqrt(position_B_x^2 + position_B_y^2))",
    "slope": "min(velocity_B_x)",
}


def reduced(a: Any, b: Any, c: Any, d: Any) -> dict[str, Any]:
    """The formulas for the four-bar linkage O-A-B-D, in mpmath: law of cosines, implicit derivative."""
    count = SAMPLES
    step = (mp.mpf(float(np.pi)) * 2) / (count - 1)
    xs, ys, bars, couplers, rates = [], [], [], [], []
    for k in range(count):
        crank = step * k
        x, y = a * mp.cos(crank), a * mp.sin(crank)
        apart = mp.hypot(d - x, y)
        rise = mp.acos((b**2 + apart**2 - c**2) / (2 * b * apart))
        coupler = mp.atan2(-y, d - x) + rise  # B on the left of A -> D
        bx, by = x + b * mp.cos(coupler), y + b * mp.sin(coupler)
        bar = mp.atan2(by, bx - d)
        turning = a * mp.sin(crank - bar) / (b * mp.sin(bar - coupler))
        xs.append(bx)
        ys.append(by)
        bars.append(bar)
        couplers.append(coupler)
        rates.append(-a * mp.sin(crank) - b * turning * mp.sin(coupler))
    middle = mp.fsum(ys) / count
    return {
        "error": mp.fsum((x - 2) ** 2 + (y - middle) ** 2 for x, y in zip(xs, ys, strict=True)) / count,
        "swing": max(bars) - min(bars),
        "turn": mp.fsum(couplers) / count * b,
        "far": max(mp.hypot(x, y) for x, y in zip(xs, ys, strict=True)),
        "slope": min(rates),
    }


@pytest.mark.parametrize("executor", EXECUTORS)
def test_against_differences_of_50_digits(executor: str) -> None:
    found = ct.sweep(
        four_bar(*LENGTHS.values()),
        {path: [length] for path, length in LENGTHS.items()},
        samples=SAMPLES,
        start=0.0,
        stop=2.0 * np.pi,
        reduce=FORMULAS,
        gradient=True,
        executor=executor,
    )
    assert found.attrs["executor"] == executor
    assert found["path"].values.tolist() == list(LENGTHS)
    with mp.workdps(50):
        lengths, step = [mp.mpf(length) for length in LENGTHS.values()], mp.mpf(10) ** -16
        for name, value in reduced(*lengths).items():
            assert abs(float(found[name][0]) - value) <= 10 * SAMPLES * EPS
        for k in range(len(lengths)):
            ends = [[x + sense * step * (i == k) for i, x in enumerate(lengths)] for sense in (1, -1)]
            above, below = reduced(*ends[0]), reduced(*ends[1])
            for name in FORMULAS:
                expected = (above[name] - below[name]) / (2 * step)
                # sums of some tens of numbers of size 10, divided by the sine of a transmission angle above 0.3
                assert abs(float(found[f"gradient.{name}"][0, k]) - expected) <= 100 * SAMPLES * EPS, name


@pytest.mark.parametrize("executor", EXECUTORS)
def test_of_outputs_with_axes_and_of_directions(executor: str) -> None:
    mechanism = ct.example("slider-crank-offset")
    vary: dict[str, Any] = {"links.AB.length": [2.5, 2.6], "guides.B.direction": [0.02, 0.03]}
    vary = {path: np.array(values) for path, values in vary.items()}
    vary["links.AB.length"] = ct.value_at(mechanism, "links.AB.length") * np.array([1.0, 1.05])
    outputs = ["position.B", "slide.B"]
    found = ct.sweep(mechanism, vary, outputs, 73, reduce="mean", gradient=True, executor=executor)
    assert found["gradient.position.B"].dims == ("mechanism", "axis", "path")
    assert found["gradient.slide.B"].dims == ("mechanism", "path")
    step = 1e-4
    for k, path in enumerate(vary):
        ends = [
            ct.sweep(mechanism, {**vary, path: vary[path] + sense * step}, outputs, 73, reduce="mean")
            for sense in (1.0, -1.0)
        ]
        for name in outputs:
            slope = (ends[0][name] - ends[1][name]).to_numpy() / (2 * step)
            # differences err by the third derivative, of the size of the numbers themselves
            np.testing.assert_allclose(found[f"gradient.{name}"][..., k], slope, rtol=0.0, atol=100 * step**2)


def test_absent_beside_events() -> None:
    mechanism = four_bar(1.0, 3.0, 3.0, 4.0)
    vary = {"links.AB.length": [1.5, 3.0, 20.0]}
    found = ct.sweep(mechanism, vary, "position.B", 19, reduce="max", gradient=True)
    assert np.isnan(found["gradient.position.B"]).values.all(axis=(1, 2)).tolist() == [True, False, True]
    assert np.isfinite(found["gradient.position.B"].values[1]).all()
    assert np.isfinite(found["position.B"].values[0]).all(), "the extreme of its ok samples"


@pytest.mark.parametrize("executor", EXECUTORS)
def test_with_two_drives(executor: str) -> None:
    """What moves with the drives is no part of what stands: the place where two circles meet, in 50 digits."""
    mechanism = five_bar(rods=(0.9, 0.8))
    lengths = {"links.OA.length": 0.5, "links.AB.length": 0.9, "links.CB.length": 0.8, "links.EC.length": 0.5}
    asked = {"samples": SAMPLES, "start": 0.0, "stop": 0.2}
    found = ct.sweep(
        mechanism,
        {path: [length] for path, length in lengths.items()},
        reduce={"middle": "mean(position_B_x)", "top": "max(position_B_y)"},
        gradient=True,
        executor=executor,
        **asked,  # type: ignore[arg-type]
    )
    times = np.linspace(0.0, 0.2, SAMPLES)

    def places(a: Any, b: Any, e: Any, c: Any) -> list[tuple[Any, Any]]:
        """B on the left of C -> A."""
        met = []
        for time in map(mp.mpf, times):
            x, y = a * mp.cos(1 + time), a * mp.sin(1 + time)
            u, v = 1 + c * mp.cos(mp.mpf(1.8) - 2 * time), c * mp.sin(mp.mpf(1.8) - 2 * time)
            apart = mp.hypot(u - x, v - y)
            along = (b**2 - e**2 + apart**2) / (2 * apart)
            across = mp.sqrt(b**2 - along**2)
            p, q = (u - x) / apart, (v - y) / apart
            met.append((x + along * p - across * q, y + along * q + across * p))
        return met

    def of(name: str, *given: Any) -> Any:
        met = places(*given)
        return mp.fsum(x for x, _y in met) / SAMPLES if name == "middle" else max(y for _x, y in met)

    with mp.workdps(50):
        given, step = [mp.mpf(length) for length in lengths.values()], mp.mpf(10) ** -16
        for name in ("middle", "top"):
            assert abs(float(found[name][0]) - of(name, *given)) <= 10 * SAMPLES * EPS
            for k in range(len(given)):
                ends = [[x + sense * step * (i == k) for i, x in enumerate(given)] for sense in (1, -1)]
                slope = (of(name, *ends[0]) - of(name, *ends[1])) / (2 * step)
                assert abs(float(found[f"gradient.{name}"][0, k]) - slope) <= 100 * SAMPLES * EPS


def test_what_has_no_derivatives_is_refused(tmp_path: Path) -> None:
    rack = ct.example("rack-and-pinion")
    with pytest.raises(ct.InputError, match="gears or wheels whose turns are counted"):
        ct.sweep(rack, {"links.rack.points.E.x": [0.2]}, "position", 7, reduce="max", gradient=True)
    study = tmp_path / "study.toml"
    study.write_text(
        'mechanism = "kite"\nreduce = "max"\ngradient = "yes"\n[vary]\nlinks.OA.length = [1]\n',
        encoding="utf-8",
    )
    with pytest.raises(ct.InputError, match="expected true or false"):
        read_sweep(study)


SIX = {
    "crank-rocker": (
        "links.OA.length", "links.AB.length", "links.DB.length", "frame.points.D.x", "frame.points.D.y",
        "frame.points.O.x",
    ),
    "slider-crank-offset": (
        "links.OA.length", "links.AB.length", "guides.B.through.y", "guides.B.direction", "frame.points.O.x",
        "frame.points.O.y",
    ),
    "spherical-four-bar": (
        "links.AB.length", "links.BC.length", "links.DC.length", "frame.points.D.longitude",
        "frame.points.D.latitude", "frame.points.A.longitude",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("name", "point"), [
    ("crank-rocker", "B"), ("slider-crank-offset", "B"), ("spherical-four-bar", "C"),
])  # fmt: skip
def test_ways_to_carry_a_sum_agree(name: str, point: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """By paths from closed forms; from implicit functions by paths, by standing parts and by what moves."""
    mechanism, samples, lanes = ct.example(name), 19, np.array([-0.01, 0.0, 0.01])
    vary = {path: ct.value_at(mechanism, path) + k * lanes for k, path in enumerate(SIX[name], 1)}

    def computed(way: Callable[[Slopes, list[Fold]], dict[str, States]]) -> np.ndarray:
        used = []

        def of_sums(self: Slopes, depth: int) -> dict[str, States]:
            used.append(way(self, list(self.folds.at_depth(depth))))
            return used[-1]

        monkeypatch.setattr(Slopes, "_of_sums", of_sums)
        monkeypatch.setattr(sweep_plans, "_plans", KeptValues(1))
        found = ct.sweep(
            mechanism, vary, f"position.{point}", samples, reduce="mean", gradient=True, executor="arrays"
        )
        assert used
        return found[f"gradient.position.{point}"].values

    def by_closed_forms(self: Slopes, folds: list[Fold]) -> dict[str, States]:
        assert self.implied is not None and self.implied.places
        closed = replace(self, implied=None)
        return {fold.name: closed._by_paths(fold) for fold in folds}

    expected = computed(by_closed_forms)
    assert np.abs(expected).max() > 0.1
    # sizes are of the order of 1 to 4, the least sine between arms 0.2: each of some hundred operations rounds once
    allowed = 200 * EPS * max(1.0, np.abs(expected).max()) / 0.2
    for way in (
        lambda self, folds: {fold.name: self._by_paths(fold) for fold in folds},
        lambda self, folds: {fold.name: self._by_parts(fold) for fold in folds},
        Slopes._by_forms,
    ):
        np.testing.assert_allclose(computed(way), expected, rtol=0.0, atol=allowed)


@pytest.mark.parametrize("executor", EXECUTORS)
@pytest.mark.parametrize(("name", "path", "point"), [
    ("crank-rocker", "links.AB.length", "B"), ("spherical-four-bar", "links.BC.length", "C"),
    ("third-class-triad", "links.AB.length", "C"),
])  # fmt: skip
def test_of_an_extreme_is_that_of_its_sample(name: str, path: str, point: str, executor: str) -> None:
    """An extreme has the derivatives that the first sample with its number has by itself, along a walk as well."""
    mechanism = ct.example(name)
    vary = {path: ct.value_at(mechanism, path) * np.array([1.0, 1.01, 1.02])}

    def computed(**more: Any) -> Any:
        return ct.sweep(mechanism, vary, f"position.{point}", 37, gradient=True, executor=executor, **more)

    every = computed()
    values, slopes = (every[x].to_numpy() for x in (f"position.{point}", f"gradient.position.{point}"))
    for fold, choose in (("max", np.argmax), ("min", np.argmin)):
        found = computed(reduce=fold)[f"gradient.position.{point}"].to_numpy()
        at = choose(values, axis=1)[:, None, :, None]
        expected = np.take_along_axis(slopes, at, axis=1)[:, 0]
        # with groups of higher class a walk past other places ends in other last bits
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e3 * EPS * np.abs(slopes).max())
