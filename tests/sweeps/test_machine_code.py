"""Machine code computes the sweeps of the arrays: the same numbers, statuses and absences, whatever is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from centrode.kinematics.hinge_angles import HINGE_ANGLES
from centrode.kinematics.machine_code.event_free_mechanisms import EventScreening
from centrode.kinematics.preparation import ready
from centrode.numerics import machine_code, rooms
from centrode.quantities import QUANTITIES
from centrode.structure.groups import Newton
from centrode.sweeps import designs
from centrode.sweeps.arrays import ArraysExecutor
from centrode.sweeps.outputs import DERIVED
from growing import mechanism_of
from growing_sphere import grown
from mechanisms import EPS, four_bar, parts_of
from samples import few

pytest.importorskip("llvmlite", reason="machine code needs the extra fast")

MACHINE, ARRAYS = "machine code", "arrays"
REFUSED = {
    "gears or wheels whose turns are counted": ("planetary-hypocycloid", "rack-and-pinion"),
    "guides that close": ("spherical-crank-guide", "wobble-plate"),
}  # fmt: skip
REASONS = {name: reason for reason, names in REFUSED.items() for name in names}
TO_THE_BIT = [
    name
    for name in ct.example_names()
    if name not in REASONS
    and not any(isinstance(x, Newton) for x in ready(ct.example(name)).structure.groups)
]
"""Those with groups of higher class stand in `test_machine_code_higher`."""
ANGLES = ("angle", "joint_angle")


def path_of(mechanism: ct.Mechanism) -> str:
    """A dimension that may vary: the first length, or the first coordinate that is not zero."""
    for name, link in mechanism.links.items():
        if link.length is not None:
            return f"links.{name}.length"
    places = [
        f"links.{name}.points.{p}.x" for name, link in mechanism.links.items() for p in link.coordinates
    ]
    places += [f"frame.points.{name}.x" for name in mechanism.frame.points]
    return next(path for path in places if ct.value_at(mechanism, path) != 0.0)


def around(mechanism: ct.Mechanism, share: float, count: int) -> dict[str, Any]:
    """A dimension that varies by some share to both sides."""
    path = path_of(mechanism)
    return {path: ct.value_at(mechanism, path) * np.linspace(1.0 - share, 1.0 + share, count)}


def everything(mechanism: ct.Mechanism) -> list[str]:
    """All quantities that a motion has at each sample."""
    motion = ct.motion(mechanism, 2)
    named = [name for name in QUANTITIES if name in motion.data_vars and "sample" in motion[name].dims]
    return [
        name
        for name in named
        if name != "status" and name not in (*DERIVED, *HINGE_ANGLES) and motion[name].size
    ]


def same(found: xr.Dataset, expected: xr.Dataset, outputs: list[str], gears: float = 0.0) -> None:
    """Bits of everything but angles; these within the 2 ULP of atan2 and the rounding of their turns.

    `gears` [rad] is what residuals of gears on the sphere, which are angles by atan2, may differ by.
    """
    for name in ("status", "samples_ok"):
        np.testing.assert_array_equal(found[name], expected[name], err_msg=name)
    for name in ("worst_residual", *(name for name in outputs if name == "residual")):
        np.testing.assert_allclose(found[name], expected[name], rtol=0, atol=gears, err_msg=name)
    for name in (name for name in outputs if name != "residual"):
        a, b = found[name].to_numpy(), expected[name].to_numpy()
        if name.partition(".")[0] in ANGLES:
            np.testing.assert_array_equal(np.isnan(a), np.isnan(b))
            off = np.abs(a - b) - 2.0 * np.spacing(np.pi) - np.spacing(np.abs(b))
            assert np.nanmax(off, initial=-1.0) <= 0.0, name
        else:
            np.testing.assert_array_equal(a, b, err_msg=name)


def same_residuals(found: xr.Dataset, mechanism: ct.Mechanism, vary: Any, samples: int) -> int:
    """Bits of the worst residual of all samples, or where closed forms say that all close, of three of them.

    Returns how many can only be of three.
    """
    residual = ct.sweep(mechanism, vary, "residual", samples, executor=ARRAYS)["residual"].to_numpy()
    whole = np.isfinite(residual).all(axis=1)
    worst = np.fmax.reduce(residual, axis=1)
    some = residual[:, samples * np.arange(3) // 3].max(axis=1)
    own = found["worst_residual"].to_numpy()
    assert ((own == worst) | (np.isnan(own) & np.isnan(worst)) | (whole & (own == some))).all()
    return int(np.count_nonzero(whole & (own == some) & (own != worst)))


def both(
    mechanism: ct.Mechanism, vary: Any, outputs: list[str], samples: int, **more: Any
) -> tuple[xr.Dataset, xr.Dataset]:
    """The sweep by machine code, and by arrays."""
    found, expected = (
        ct.sweep(mechanism, vary, outputs or None, samples, executor=name, **more)
        for name in (MACHINE, ARRAYS)
    )
    assert (found.attrs["executor"], expected.attrs["executor"]) == (MACHINE, ARRAYS)
    return found, expected


FORMULAS_WITH_EVENTS = {"swing": "range(angle_AB)", "wander": "max(abs(position_B_y - mean(position_B_y)))"}


class Counter:
    """Counts the mechanisms that are left to the arrays."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.left = 0
        run = ArraysExecutor.run

        def counted(executor: ArraysExecutor, task: Any, numbers: Any, values: Any, results: Any) -> None:
            self.left += len(next(iter(values.values())))
            run(executor, task, numbers, values, results)

        monkeypatch.setattr(ArraysExecutor, "run", counted)


@pytest.mark.parametrize("name", few(TO_THE_BIT[::2], TO_THE_BIT))
def test_the_same_as_arrays(name: str) -> None:
    mechanism = ct.example(name)
    outputs = everything(mechanism)
    spherical = mechanism.gears if mechanism.space == "sphere" else ()
    turns = 2.0 * np.pi if spherical else 0.0
    gears = sum((2.0 + abs(gear.ratio)) * 3.0 * np.spacing(turns) for gear in spherical)
    same(*both(mechanism, around(mechanism, 0.1, 21), outputs, 37), outputs, gears)


@pytest.mark.parametrize("seed", range(3))
def test_arcs_that_vary_give_the_same_bits_reduced(seed: int) -> None:
    """Their sine and cosine are those of NumPy, whichever loop is inside."""
    mechanism = mechanism_of(grown(["turned link", "RRR"], seed).parts())
    path = path_of(mechanism)
    vary = {path: ct.value_at(mechanism, path) * np.linspace(0.999, 1.001, 16)}
    found, expected = (
        ct.sweep(mechanism, vary, "position", 37, reduce="range", executor=name) for name in (MACHINE, ARRAYS)
    )
    np.testing.assert_array_equal(found["position"], expected["position"])


def test_a_residual_on_the_sphere_takes_its_own_functions() -> None:
    """Reduced sweeps round sines of arcs in the worst residual otherwise: by units of the last place of an angle."""
    mechanism = ct.example("spherical-four-bar")
    vary = {path: ct.value_at(mechanism, path) * np.linspace(0.99, 1.01, 40) for path in ("links.BC.length",)}
    found = ct.sweep(mechanism, vary, "position.C", 37, reduce="range", executor=MACHINE)
    residual = ct.sweep(mechanism, vary, "residual", 37, executor=ARRAYS)["residual"].to_numpy()
    some = residual[:, 37 * np.arange(3) // 3].max(axis=1)
    assert (some > 0.0).any()
    np.testing.assert_allclose(found["worst_residual"], some, rtol=0.0, atol=4.0 * EPS)


@pytest.mark.parametrize("name", sorted(REASONS))
def test_what_is_refused_is_told(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    mechanism = ct.example(name)
    vary = around(mechanism, 0.001, 2)
    with pytest.raises(ct.InputError, match=f"{REASONS[name]}; use executor"):
        ct.sweep(mechanism, vary, "position", 3, executor=MACHINE)
    monkeypatch.setattr(designs, "WORTH_COMPILING", 1)
    found = ct.sweep(mechanism, vary, "position", 3)
    assert found.attrs["executor"] == f"{ARRAYS} ({REASONS[name]})"


def test_mechanisms_without_events_do_not_touch_the_arrays(monkeypatch: pytest.MonkeyPatch) -> None:
    counter = Counter(monkeypatch)
    mechanism = ct.example("six-bar-press")
    ct.sweep(mechanism, around(mechanism, 0.05, 50), "angle", 37, executor=MACHINE)
    assert counter.left == 0


@pytest.mark.parametrize("reduce", [None, "range"])
def test_a_fifth_of_the_samples_open(reduce: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    mechanism = ct.example("crank-rocker")
    draw = np.random.default_rng(5)
    vary = {"links.AB.length": draw.uniform(1.0, 4.0, 300), "links.DB.length": draw.uniform(1.5, 3.5, 300)}
    outputs = ["position", "velocity", "acceleration", "angle", "residual"]
    status = ct.sweep(mechanism, vary, outputs, 37, executor=ARRAYS)["status"]
    share = float((status == ct.Status.OPEN).mean())
    assert 0.15 < share < 0.35
    counter = Counter(monkeypatch)
    if reduce is None:
        same(*both(mechanism, vary, outputs, 37), outputs)
    else:
        found, expected = both(mechanism, vary, ["position", "velocity"], 37, reduce=reduce)
        xr.testing.assert_equal(found.drop_vars("worst_residual"), expected.drop_vars("worst_residual"))
    assert counter.left == 300, "those of the comparison: machine code computes what has events too"
    if reduce is not None:
        same_residuals(found, mechanism, vary, 37)


@pytest.mark.parametrize("reduce", [None, "mean", FORMULAS_WITH_EVENTS])
@pytest.mark.parametrize("name", ["crank-rocker", "antiparallelogram", "five-bar-two-drives"])
def test_columns_of_mechanisms_with_events(name: str, reduce: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Bits, angles and sums included: motions with events are those of the arrays."""
    monkeypatch.setattr(designs, "WORTH_COMPILING", 1)
    mechanism = ct.example(name)
    lengths = np.linspace(0.97, 1.03, 9) if name == "antiparallelogram" else np.linspace(0.35, 0.49, 9)
    paths = ("links.OA.length", "links.DB.length") if name == "antiparallelogram" else ("links.AB.length",)
    vary = {path: ct.value_at(mechanism, path) * lengths for path in paths}
    counter = Counter(monkeypatch)
    outputs = [] if isinstance(reduce, dict) else ["position", "acceleration", "angle"]
    found, expected = both(mechanism, vary, outputs, 73, reduce=reduce)
    for variable in expected.data_vars:
        np.testing.assert_array_equal(found[variable], expected[variable], err_msg=str(variable))
    assert counter.left == 9, "those of the comparison"


def test_few_mechanisms_with_events_are_left_to_the_arrays(monkeypatch: pytest.MonkeyPatch) -> None:
    mechanism, vary = open_and_whole()
    counter = Counter(monkeypatch)
    found = ct.sweep(mechanism, vary, "position.B", 37, executor=MACHINE)
    assert counter.left == int((found["samples_ok"] < 37).sum()) > 0


@pytest.mark.parametrize("continuation", ["smooth", "keep"])
@pytest.mark.parametrize("name", ["kite", "parallelogram", "antiparallelogram", "three-crank-parallelogram"])
def test_change_points_and_near_misses(name: str, continuation: str) -> None:
    parts = parts_of(ct.example(name))
    parts["assembly"] = {**parts.get("assembly", {}), "continuation": continuation}
    mechanism = ct.Mechanism(**parts)
    path = path_of(mechanism)
    misses = np.concatenate([[0.0], *[sign * 10.0 ** -np.arange(1.0, 17.0) for sign in (-1.0, 1.0)]])
    vary = {path: ct.value_at(mechanism, path) * (1.0 + misses)}
    outputs = ["position", "velocity", "acceleration", "angle", "angular_velocity", "residual"]
    same(*both(mechanism, vary, outputs, 73), outputs)


def test_random_four_bars() -> None:
    draw = np.random.default_rng(11)
    vary = {f"links.{link}.length": draw.uniform(0.5, 4.0, few(1000, 3000)) for link in ("OA", "AB", "DB")}
    mechanism = four_bar(1.0, 3.0, 3.0, 3.5)
    outputs = ["position.B", "acceleration.B", "angle", "angular_acceleration"]
    found, expected = both(mechanism, vary, outputs, 19)
    assert few(160, 500) < (expected["samples_ok"] == 19).sum() < few(840, 2500)
    same(found, expected, outputs)


@pytest.mark.parametrize(("start", "stop", "samples"), [(-15.0, 4.0, 7), (3.0, 2.9, 5), (0.2, 40.0, 200)])
@pytest.mark.parametrize("name", ["drag-link", "crank-rocker", "inverted-slider-crank", "spherical-four-bar"])
def test_turns_of_angles(name: str, start: float, stop: float, samples: int) -> None:
    mechanism = ct.example(name)
    outputs = [name for name in everything(mechanism) if name in ANGLES]
    same(*both(mechanism, around(mechanism, 0.05, 9), outputs, samples, start=start, stop=stop), outputs)


def test_laws_have_rates() -> None:
    parts = parts_of(ct.example("crank-rocker"))
    parts["drives"] = [{"link": "OA", "law": "0.3 * sin(2 * t) + t", "start": 0.5}]
    parts["links"]["OA"].pop("angle", None)
    mechanism = ct.Mechanism(**parts)
    outputs = ["velocity", "acceleration", "angular_acceleration", "acceleration_coefficient"]
    same(*both(mechanism, around(mechanism, 0.05, 9), outputs, 25, start=0.0, stop=3.0), outputs)


FORMULAS = {
    "swing": "range(angle_DB) / links_AB_length",
    "wander": "max(abs(position_B_y - mean(position_B_y)))",
    "spread": "sum((position_B_x - mean(position_B_x))^2 / (1 + range(position_B_y)))",
    "when": "max(time) + max(drive_OA)",
    "either": "max(min(angle_DB), min(angle_AB))",
    "still": "links_AB_length + 1",
    "worst": "max(residual)",
}


def open_and_whole() -> tuple[ct.Mechanism, dict[str, npt.NDArray[np.float64]]]:
    """A crank-rocker of which some couplers do not reach round, and some reach nowhere."""
    return ct.example("crank-rocker"), {
        "links.AB.length": np.concatenate([np.linspace(1.2, 6.8, 40), [9.0, 12.0]])
    }


@pytest.mark.parametrize("name", ["min", "max", "range", "mean"])
def test_reductions(name: str) -> None:
    mechanism, vary = open_and_whole()
    outputs = ["position", "angular_velocity", "acceleration.B.x"]
    found, expected = both(mechanism, vary, outputs, 37, reduce=name)
    np.testing.assert_array_equal(found["samples_ok"], expected["samples_ok"])
    assert same_residuals(found, mechanism, vary, 37) > 10
    sizes = ct.sweep(mechanism, vary, outputs, 37, executor=ARRAYS)
    for output in outputs:
        # sums of n terms in another order
        allowed = 2 * 37 * EPS * float(np.nanmax(np.abs(sizes[output]))) if name == "mean" else 0.0
        np.testing.assert_allclose(found[output], expected[output], rtol=0.0, atol=allowed)
        assert found[output].dims == expected[output].dims
    assert list(found.variables) == list(expected.variables)


def test_formulas() -> None:
    mechanism, vary = open_and_whole()
    found, expected = both(mechanism, vary, [], 37, reduce=FORMULAS)
    for name in FORMULAS:
        # some ten roundings of numbers below 100, and sums of 37 terms in another order
        size = 100.0 if name == "spread" else 10.0
        np.testing.assert_allclose(
            found[name], expected[name], rtol=0.0, atol=2 * 37 * EPS * size, err_msg=name
        )
        np.testing.assert_array_equal(np.isnan(found[name]), np.isnan(expected[name]))


@pytest.mark.parametrize("reduce", [None, "mean"])
def test_bits_do_not_hang_on_chunks_threads_or_the_cache(
    reduce: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    mechanism, vary = open_and_whole()
    outputs = ["position.B", "angle", "velocity"]

    def computed(**more: Any) -> xr.Dataset:
        return ct.sweep(mechanism, vary, outputs, 37, reduce=reduce, executor=MACHINE, **more)

    whole = computed()
    xr.testing.assert_identical(whole, computed(threads=2))
    monkeypatch.setenv("CENTRODE_CACHE", "")
    kernels = pytest.importorskip("centrode.numerics.machine_code.kernels")
    kernels.forget()
    xr.testing.assert_identical(whole, computed())
    for name, value in (("KERNEL_LANES", 5), ("KERNEL_BUFFER", 20_000), ("BLOCK_POSITIONS", 200)):
        monkeypatch.setattr(designs, name, value)
    calls: list[int] = []
    xr.testing.assert_identical(whole, computed(progress=lambda done, _of: calls.append(done)))
    assert len(calls) > 3, "one chunk proves nothing"


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("outputs", [["position", "angle", "velocity"], ["position.D", "velocity.O"]])
def test_numbers_of_fixed_points_are_not_written(
    outputs: list[str], threads: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They stand in blank memory, in used memory and in a result by arrays alike; with what is open they are absent."""
    mechanism, vary = open_and_whole()

    def computed(**more: Any) -> xr.Dataset:
        return ct.sweep(mechanism, vary, outputs, 37, **more)

    expected = computed(executor=ARRAYS)
    room = np.full(sum(array.size for array in expected.data_vars.values()), np.pi)
    used = computed(executor=MACHINE, out=room, threads=threads)
    monkeypatch.setattr(rooms, "BLANK", 0)
    blank = computed(executor=MACHINE, threads=threads)
    xr.testing.assert_identical(used, blank)
    assert np.isnan(blank["position" if "position" in blank else outputs[0]]).any()
    for name, array in expected.data_vars.items():
        np.testing.assert_allclose(blank[name], array, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("threads", [0, 1000, True, "two", 1.0])
def test_threads_are_counted(threads: Any) -> None:
    mechanism, vary = open_and_whole()
    with pytest.raises(ct.InputError, match="is not a valid number of threads; give a whole number"):
        ct.sweep(mechanism, vary, "angle", 3, threads=threads)


def test_machine_code_is_chosen_where_it_pays(monkeypatch: pytest.MonkeyPatch) -> None:
    mechanism, vary = open_and_whole()
    assert ct.sweep(mechanism, vary, "angle", 37).attrs["executor"] == ARRAYS
    monkeypatch.setattr(designs, "WORTH_COMPILING", 42 * 37)
    assert ct.sweep(mechanism, vary, "angle", 37).attrs["executor"] == MACHINE


def test_without_llvmlite_arrays_compute(monkeypatch: pytest.MonkeyPatch) -> None:
    mechanism, vary = open_and_whole()
    monkeypatch.setattr(machine_code, "PRESENT", False)
    monkeypatch.setattr(designs, "WORTH_COMPILING", 1)
    found = ct.sweep(mechanism, vary, "angle", 7)
    assert found.attrs["executor"] == "arrays (llvmlite is not installed)"
    with pytest.raises(ct.InputError, match="llvmlite is not installed"):
        ct.sweep(mechanism, vary, "angle", 7, executor=MACHINE)


def test_a_store_belongs_to_one_executor(tmp_path: Path) -> None:
    pytest.importorskip("zarr", reason="stores need the extra sweeps")
    mechanism, vary = open_and_whole()
    store = tmp_path / "angles.zarr"

    def computed(name: str, **more: Any) -> xr.Dataset:
        return ct.sweep(mechanism, vary, "angle", 7, executor=name, **more)

    first = computed(MACHINE, store=store)
    np.testing.assert_array_equal(first["angle"], computed(MACHINE)["angle"])
    assert computed(MACHINE, store=store).attrs["mechanisms_found"] == 42
    with pytest.raises(ct.InputError, match="what differs: executor"):
        computed(ARRAYS, store=store)


def test_what_is_clear_has_no_event_nearby(monkeypatch: pytest.MonkeyPatch) -> None:
    """Clear mechanisms keep well away from where the arrays would find an event, and most are clear."""
    kept: list[npt.NDArray[np.bool_]] = []
    judge = EventScreening.judge

    def watched(self: EventScreening, values: Any) -> Any:
        judged = judge(self, values)
        kept.append(judged.clear)
        return judged

    monkeypatch.setattr(EventScreening, "judge", watched)
    # a four-bar closes everywhere if the longest link of the triangle stays below the others: AB + 3 >= 4 + 1
    lengths = 2.0 + np.concatenate([-np.geomspace(1e-12, 0.5, 40), [0.0], np.geomspace(1e-12, 0.5, 40)])
    mechanism = four_bar(1.0, 3.0, 3.0, 4.0)
    ct.sweep(mechanism, {"links.AB.length": lengths}, "position.B", 37, executor=MACHINE)
    (clear,) = kept
    assert not clear[lengths <= 2.0].any()
    assert clear[lengths > 2.0 + 1e-6].all(), "closed forms need no more room than that"


@pytest.mark.parametrize(
    ("path", "values"),
    [
        ("links.BF.length", [1.0, 1.1, 1.2]),
        # in the second one the axes of the wheels coincide: it has no position
        ("frame.points.A.longitude", [1.0, np.pi / 2.0, 2.0]),
    ],
)
@pytest.mark.parametrize("reduce", [None, "max"])
def test_residuals_of_gears_on_the_sphere(
    path: str, values: list[float], reduce: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Residuals of bevel gears have angles with their turns: in reduced sweeps and beside events as well."""
    monkeypatch.setattr(designs, "WORTH_COMPILING", 1)
    machine, arrays = (
        ct.sweep("bevel-pair", {path: values}, ["position"], 25, reduce=reduce, executor=executor)
        for executor in (MACHINE, ARRAYS)
    )
    assert machine.samples_ok.values.tolist() == arrays.samples_ok.values.tolist()
    np.testing.assert_allclose(machine.position, arrays.position, rtol=0.0, atol=64.0 * EPS)
