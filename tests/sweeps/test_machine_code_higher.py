"""Groups of higher class by machine code: statuses of the arrays, numbers as far as positions are determined."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from centrode.kinematics.machine_code import batch
from centrode.kinematics.machine_code.newton import CHANGE, CONDITION
from centrode.kinematics.preparation import ready
from centrode.numerics import machine_code
from centrode.sweeps import designs
from centrode.sweeps.arrays import ArraysExecutor
from growing_higher import HIGHER, grown_higher
from mechanisms import EPS, parts_of
from redriven import answer
from samples import few

pytest.importorskip("llvmlite", reason="machine code needs the extra fast")

Array = npt.NDArray[np.float64]
MACHINE, ARRAYS = "machine code", "arrays"
EXAMPLES = {
    "third-class-triad": "links.AB.length",
    "fourth-class-group": "links.BD.length",
    "stephenson-driven-at-rocker": "links.PR.length",
    "watt-driven-second-loop": "links.PR.length",
}
ORDERS = (
    ("position", "angle"), ("velocity", "angular_velocity"), ("acceleration", "angular_acceleration"),
)  # fmt: skip
OUTPUTS = [name for names in ORDERS for name in names] + ["residual"]
ROUNDINGS = 64
"""Of the equations of a group and of what they are made from."""


class Counter:
    """Counts the mechanisms that are left to the arrays."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.left: list[Array] = []
        run = ArraysExecutor.run

        def counted(executor: ArraysExecutor, task: Any, numbers: Any, values: Any, results: Any) -> None:
            self.left.append(np.array(next(iter(values.values()))))
            run(executor, task, numbers, values, results)

        monkeypatch.setattr(ArraysExecutor, "run", counted)

    def taken(self) -> Array:
        """The first values of those left so far, which are then forgotten."""
        found = np.concatenate([*self.left, np.zeros(0)])
        self.left.clear()
        return found


def both(mechanism: ct.Mechanism, vary: Any, outputs: Any, samples: int, **more: Any) -> list[xr.Dataset]:
    """The sweep by machine code, and by arrays."""
    return [ct.sweep(mechanism, vary, outputs, samples, executor=name, **more) for name in (MACHINE, ARRAYS)]


def greatest(numbers: xr.DataArray) -> float:
    """The greatest size; 0 if there is none."""
    sizes = np.abs(numbers.to_numpy())
    return float(np.max(sizes, initial=0.0, where=np.isfinite(sizes)))


def same_statuses(found: xr.Dataset, expected: xr.Dataset) -> None:
    """Statuses, absences, residuals of rounding alone."""
    for name in ("status", "samples_ok"):
        np.testing.assert_array_equal(found[name], expected[name])
    for name in OUTPUTS:
        np.testing.assert_array_equal(np.isnan(found[name]), np.isnan(expected[name]))
    assert greatest(found["residual"]) <= max(greatest(expected["residual"]), ROUNDINGS * EPS)


def off(found: xr.Dataset, expected: xr.Dataset, order: int) -> float:
    """Greatest difference, in the size of what there is."""
    return max(
        greatest(found[name] - expected[name]) / max(1.0, greatest(expected[name])) for name in ORDERS[order]
    )


@pytest.mark.parametrize("name", few([*EXAMPLES][1::2], [*EXAMPLES]))
def test_numbers_of_the_arrays(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Within some roundings times what positions and derivatives answer to the dimensions; no arrays needed."""
    mechanism, path = ct.example(name), EXAMPLES[name]
    vary = {path: ct.value_at(mechanism, path) * np.linspace(0.998, 1.002, 5)}
    counter = Counter(monkeypatch)
    found, expected = both(mechanism, vary, OUTPUTS, 9)
    assert len(counter.taken()) == 5, "those of the comparison alone"
    same_statuses(found, expected)
    assert (found["status"] == ct.Status.OK).all()
    motion = ct.motion(mechanism, 9)
    told = answer(mechanism, motion["drive_value"].to_numpy().ravel()).max(axis=1)
    for order in range(3):
        # a five hundredth more or less of a length changes what is answered by less than twice
        assert off(found, expected, order) <= 2 * ROUNDINGS * EPS * told[order], order


def bound(order: int) -> float:
    """What certainty leaves of the condition, and how much faster derivatives may change: radians of the drive."""
    condition, faster = CHANGE / CONDITION, CHANGE / np.radians(1.0)
    return float(2 * ROUNDINGS * EPS * condition * faster**order)


def drawn(kinds: list[str], seed: int) -> ct.Mechanism:
    """The first random mechanism from a seed on that one drive moves."""
    while True:
        try:
            mechanism = ct.Mechanism(**grown_higher(kinds, seed))
            ready(mechanism)
            return mechanism
        except ct.InputError:
            seed += 1


AROUND = {
    "alone": ([], []),
    "dyad and wheel": (["RRR"], ["wheel on a circle"]),
    "wheel and dyad": (["wheel on a line"], ["RPR block"]),
    "two": ([], ["four sides"]),
}


PAIRS = [(kind, [*AROUND][(k + j) % 4]) for k, kind in enumerate(HIGHER) for j in few((k % 2 * 2,), (0, 2))]
"""Every kind, and every way to stand among others."""


@pytest.mark.parametrize(("kind", "around"), PAIRS)
def test_random_mechanisms(kind: str, around: str) -> None:
    """Groups of every kind, alone and among others, from nearly alike to far apart."""
    before, behind = AROUND[around]
    draw = np.random.default_rng([HIGHER.index(kind), [*AROUND].index(around)])
    mechanism = drawn([*before, kind, *behind], int(draw.integers(1000)))
    paths = [
        f"links.{n}.points.{p}.{a}" for n, x in mechanism.links.items() for p in x.coordinates for a in "xy"
    ]
    chosen = draw.choice([p for p in paths if ct.value_at(mechanism, p) != 0.0], 2, replace=False)
    share = 10.0 ** draw.uniform(-3.0, -1.0)
    vary = {str(p): ct.value_at(mechanism, str(p)) * (1.0 + share * draw.uniform(-1, 1, 12)) for p in chosen}
    found, expected = both(mechanism, vary, OUTPUTS, 5, start=-0.2, stop=float(draw.choice([0.3, 1.5])))
    same_statuses(found, expected)
    for order in range(3):
        assert off(found, expected, order) <= bound(order)


NEAR = {
    "inside the range": ("third-class-triad", "links.AB.length", 5.10130816180524, 0.05),
    "at its end": ("stephenson-driven-at-rocker", "links.PR.length", 1.92519812025464, 0.05),
    "at its end, five bodies": ("watt-driven-second-loop", "links.PR.length", 1.24021735922587, 0.03),
}
"""Dimensions with which a mechanism just locks: between two that the arrays tell apart, halved again and again.
The last number says how far to go from there."""


@pytest.mark.parametrize("where", few([*NEAR][::2], [*NEAR]))
def test_near_a_limit(where: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """On both sides of it, down to rounding: what is certain keeps away from it."""
    name, path, middle, reach = NEAR[where]
    mechanism = ct.example(name)
    aside = middle * np.geomspace(1e-12, reach, few(4, 14))
    values = np.concatenate([middle - aside, middle + aside])
    counter = Counter(monkeypatch)
    found = ct.sweep(mechanism, {path: values}, OUTPUTS, 9, executor=MACHINE)
    left = counter.taken()
    expected = ct.sweep(mechanism, {path: values}, OUTPUTS, 9, executor=ARRAYS)
    same_statuses(found, expected)
    whole = (expected["samples_ok"] == 9).to_numpy()
    assert whole.any()
    assert not whole.all()
    certain = ~np.isin(values, left)
    assert certain.any()
    assert whole[certain].all()
    # positions there part as the root of the distance does: a degree of the drive is more than a ten thousandth
    assert np.abs(values[certain] - middle).min() > 1e-4 * middle
    for order in range(3):
        assert off(found, expected, order) <= bound(order)


def triads(count: int) -> tuple[ct.Mechanism, dict[str, Array]]:
    """Triads of which some meet limits."""
    draw = np.random.default_rng(5)
    paths = ("links.AB.length", "links.DC.length", "frame.points.E.x")
    mechanism = ct.example("third-class-triad")
    return mechanism, {p: ct.value_at(mechanism, p) * draw.uniform(0.96, 1.04, count) for p in paths}


FORMULAS = {
    "swing": "range(angle_platform) / links_AB_length",
    "wander": "max(abs(position_C_y - mean(position_C_y)))",
    "pull": "mean(acceleration_F_x^2)",
    "turned": "max(angle_EF) + max(time) + max(drive_OA)",
    "worst": "max(residual)",
}


@pytest.mark.parametrize("more", few([{"start": -2.0, "stop": 3.0}], [{}, {"start": -2.0, "stop": 3.0}]))
def test_reduced_on_the_way(more: dict[str, float]) -> None:
    """Folds inside folds pass the samples again, from the initial position in their midst too."""
    mechanism, vary = triads(20)
    found, expected = both(mechanism, vary, None, 31, reduce=FORMULAS, **more)
    np.testing.assert_array_equal(found["samples_ok"], expected["samples_ok"])
    for name in FORMULAS:
        size = np.nanmax(np.abs(expected[name]), initial=1.0)
        np.testing.assert_allclose(found[name], expected[name], rtol=0.0, atol=bound(2) * float(size))
        assert not np.array_equal(found[name], np.zeros(20))
    ranges = [x["angle.EF"] for x in both(mechanism, vary, "angle.EF", 31, reduce="range")]
    np.testing.assert_allclose(ranges[0], ranges[1], rtol=0.0, atol=bound(0) * 2.0 * np.pi)


@pytest.mark.parametrize("reduce", few(["mean"], [None, "mean"]))
def test_bits_do_not_hang_on_chunks_threads_or_the_cache(
    reduce: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    mechanism, vary = triads(40)

    def computed(**more: Any) -> xr.Dataset:
        outputs = ["position.C", "angle", "velocity"]
        return ct.sweep(mechanism, vary, outputs, 19, reduce=reduce, executor=MACHINE, **more)

    whole = computed()
    xr.testing.assert_identical(whole, computed(threads=2))
    monkeypatch.setenv("CENTRODE_CACHE", "")
    pytest.importorskip("centrode.numerics.machine_code.kernels").forget()
    for name, value in (("KERNEL_LANES", 11), ("KERNEL_BUFFER", 20_000), ("BLOCK_POSITIONS", 200)):
        monkeypatch.setattr(designs, name, value)
    xr.testing.assert_identical(whole, computed())


def test_it_does_not_matter_which_samples_are_asked_for() -> None:
    mechanism, vary = triads(8)
    few = ct.sweep(mechanism, vary, OUTPUTS, 5, start=0.0, stop=2.0, executor=MACHINE)
    more = ct.sweep(mechanism, vary, OUTPUTS, 201, start=0.0, stop=2.0, executor=MACHINE)
    np.testing.assert_array_equal(few["status"], more["status"][:, ::50])
    for order in range(3):
        assert off(few, more.isel(sample=slice(None, None, 50)), order) <= bound(order)


@pytest.mark.parametrize(
    ("start", "stop", "samples"),
    few([(-9.0, 2.0, 9), (0.3, -0.1, 5)], [(-9.0, 2.0, 9), (0.3, -0.1, 5), (0.2, 20.0, 25)]),
)
def test_turns_of_angles(start: float, stop: float, samples: int) -> None:
    """Of a dyad's link behind the group, which turns round with the crank, and of the group's own."""
    mechanism = ct.Mechanism(**grown_higher(["four sides", "RRR"], 2))
    vary = {path: ct.value_at(mechanism, path) * np.linspace(0.999, 1.001, 3) for path in behind(mechanism)}
    found, expected = both(mechanism, vary, OUTPUTS, samples, start=start, stop=stop)
    same_statuses(found, expected)
    assert off(found, expected, 0) <= bound(0)


def test_laws_go_back_and_forth() -> None:
    """Samples in no order along the path, with rates of their own; and one sample alone."""
    parts = parts_of(ct.example("third-class-triad"))
    parts["drives"] = [{"link": "OA", "law": "0.6 * sin(2 * t) + 0.3 * t", "start": 0.0}]
    mechanism, vary = ct.Mechanism(**parts), {"links.AB.length": np.linspace(4.99, 5.01, 9)}
    for samples, stop in ((30, 5.0), (1, 1.0)):
        found, expected = both(mechanism, vary, OUTPUTS, samples, start=0.0, stop=stop)
        same_statuses(found, expected)
        for order in range(3):
            assert off(found, expected, order) <= bound(order)


def behind(mechanism: ct.Mechanism) -> list[str]:
    """One dimension of the last link."""
    name, link = list(mechanism.links.items())[-1]
    return [f"links.{name}.points.{list(link.coordinates)[-1]}.x"]


def test_derivatives_by_dimensions() -> None:
    """Against differences: they err by the third derivative, which is of the size of the numbers themselves."""
    mechanism, step = ct.example("third-class-triad"), 2e-5
    paths = ["links.AB.length", "frame.points.E.x", "links.platform.points.B.y"]
    middle = {path: ct.value_at(mechanism, path) for path in paths}
    ends = {path: np.full(6, value) for path, value in middle.items()}
    for k, path in enumerate(paths):
        ends[path][2 * k : 2 * k + 2] += [-step, step]
    formulas = {name: FORMULAS[name] for name in ("swing", "pull", "turned")} | {"speed": "max(velocity_C_y)"}
    one = {path: [value] for path, value in middle.items()}
    exact = ct.sweep(mechanism, one, None, 25, reduce=formulas, gradient=True, executor=MACHINE)
    by_arrays = ct.sweep(mechanism, ends, None, 25, reduce=formulas, executor=ARRAYS)
    for name in formulas:
        values = by_arrays[name].to_numpy().reshape(3, 2)
        slopes = (values[:, 1] - values[:, 0]) / (2.0 * step)
        rounding = bound(0) * max(1.0, float(np.abs(values).max())) / step
        np.testing.assert_allclose(
            exact[f"gradient.{name}"][0], slopes, rtol=0.0, atol=1e3 * step**2 + rounding, err_msg=name
        )


def test_several_drives_are_left_to_the_arrays(monkeypatch: pytest.MonkeyPatch) -> None:
    """The platform's rod DC stands on a second crank."""
    parts = parts_of(ct.example("third-class-triad"))
    parts["frame"]["points"]["Q"] = [-0.5, 0.0]
    del parts["frame"]["points"]["D"]
    parts["links"]["QD"] = {"length": 0.5}
    parts["drives"].append({"link": "QD", "start": 0.0, "speed": 0.1})
    mechanism, vary = ct.Mechanism(**parts), {"links.AB.length": [4.99, 5.01]}
    with pytest.raises(ct.InputError, match="groups of higher class with several drives; use executor"):
        ct.sweep(mechanism, vary, "position", 3, executor=MACHINE)
    monkeypatch.setattr(designs, "WORTH_COMPILING", 1)
    monkeypatch.setattr(batch, "WORTH_COMPILING", 1)
    assert ct.sweep(mechanism, vary, "position", 3).attrs["executor"].startswith(f"{ARRAYS} (")
    assert (ct.motion(mechanism, 3, start=0.0, stop=0.1, vary=vary)["status"] == ct.Status.OK).all()


def test_many_motions(monkeypatch: pytest.MonkeyPatch) -> None:
    mechanism, vary = triads(20)
    monkeypatch.setattr(batch, "WORTH_COMPILING", 1)
    solve, lanes = batch.solve, []
    monkeypatch.setattr(batch, "solve", lambda *args, **more: lanes.append(args[3]) or solve(*args, **more))
    found = ct.motion(mechanism, 25, vary=vary)
    assert sum(lanes) < 20, "some meet limits, and one tells the worst constraint"
    monkeypatch.setattr(machine_code, "PRESENT", False)
    expected = ct.motion(mechanism, 25, vary=vary)
    np.testing.assert_array_equal(found["status"], expected["status"])
    for order in range(3):
        assert off(found, expected, order) <= bound(order)
    assert list(found.variables) == list(expected.variables)
