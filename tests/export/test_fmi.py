"""FMUs: valid for FMPy, and in it they move as simulations and motions of the program."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from tools.source_programs import COMPILER

import centrode as ct
from centrode.errors import InputError, NotComputedYet
from centrode.export.fmi import FmuProgram, fmu_program
from centrode.export.fmi_archive import Fmu
from centrode.model.examples import example_text
from samples import ALL

fmpy = pytest.importorskip("fmpy", reason="FMUs are run by FMPy")
from fmpy.validation import validate_fmu  # noqa: E402

from explicit_importer import exchanged_outputs  # noqa: E402

needs_compiler = pytest.mark.skipif(COMPILER is None, reason="gcc is not installed")

SOME = ("crank-rocker", "inverted-slider-crank", "parallelogram", "slider-crank-offset")
TWENTY = (
    *SOME, "antiparallelogram", "drag-link", "four-bar-and-slider", "four-bar-excerpt", "galloway", "geared-five-bar",
    "kite", "oscillating-cylinder", "peaucellier", "planetary-gear-train", "rack-and-pinion",
    "slider-between-cranks-vertical", "scotch-yoke", "shaper", "slider-between-cranks", "whitworth-quick-return",
)  # fmt: skip
CASES = TWENTY if ALL else SOME
TOLERANCE = 1e-8
MOMENT = 2.0


def compiled(fmu: Fmu, folder: Path) -> str:
    """The FMU with a binary for this machine."""
    assert COMPILER is not None
    source, library = folder / f"{fmu.name}.c", folder / f"{fmu.name}.so"
    source.write_text(fmu.source, encoding="utf-8")
    flags = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    subprocess.run(
        [COMPILER, *flags, "-o", str(library), str(source), "-lm"], check=True, capture_output=True
    )
    file = folder / f"{fmu.name}.fmu"
    file.write_bytes(fmu.archive({f"binaries/{fmpy.platform_tuple}/{fmu.name}.so": library.read_bytes()}))
    return str(file)


def weighty(name: str) -> ct.Mechanism:
    """An example with masses, driven by a constant moment for a second and a half."""
    text = re.sub(r"^(\[links\.[^\].]+\])$", r"\1\nmass = 1.5\ninertia = 2.5", example_text(name), flags=re.M)
    text = re.sub(r"^\[simulation\](?s:.*)", "", text, flags=re.M)
    told = f'speed = 2.0\nduration = 1.5\nsamples = 16\ntolerance = {TOLERANCE / 10}\ndriving = "{MOMENT}"'
    text = text.replace("\ntitle", "\ngravity = [0.0, -9.81]\ntitle", 1) if "gravity" not in text else text
    return ct.parse_mechanism(f"{text}\n[simulation]\n{told}\n")


@needs_compiler
@pytest.mark.parametrize("name", CASES)
def test_free_motions_are_those_of_a_simulation(name: str, tmp_path: Path) -> None:
    mechanism = weighty(name)
    course = ct.simulate(mechanism)
    point = next(point for point in reversed(ct.motion(mechanism).point.values))
    fmu = fmu_program(mechanism, [], [f"position {point} {axis}" for axis in "xy"], name=name)
    assert isinstance(fmu, FmuProgram)
    file = compiled(fmu, tmp_path)
    assert validate_fmu(file) == []
    times, drive = course.time.values, course.drive_value.values[:, 0]
    sense = float(np.sign(course.drive_speed.values[0])) * (1.0 if drive[1] > drive[0] else -1.0)
    places = ct.motion(mechanism, at=drive).position.sel(point=point).values
    size = max(1.0, float(np.abs(places).max()))
    # the importer integrates a model of exchange: CVODE gathers some thirty times its tolerance on the way
    for kind, tolerance in (("CoSimulation", TOLERANCE), ("ModelExchange", TOLERANCE / 100)):
        found = fmpy.simulate_fmu(
            file, fmi_type=kind, stop_time=float(times[-1]), output_interval=float(times[1]),
            relative_tolerance=tolerance, start_values={fmu_input(fmu): sense * MOMENT},
            output=["drive", "drive speed", *(fmu.program.results[k].name for k in fmu.outputs)],
        )  # fmt: skip
        assert np.abs(found["time"] - times).max() < 1e-12
        assert np.abs(found["drive"] - drive).max() <= 10 * TOLERANCE * max(1.0, np.abs(drive).max()), kind
        for k, axis in enumerate("xy"):
            assert np.abs(found[f"position {point} {axis}"] - places[:, k]).max() <= 100 * TOLERANCE * size, (
                kind
            )
    # an importer with an explicit method needs no finer tolerance than co-simulation
    moved = exchanged_outputs(file, times, ["drive"], {fmu_input(fmu): sense * MOMENT}, TOLERANCE)[:, 0]
    assert np.abs(moved - drive).max() <= 10 * TOLERANCE * max(1.0, np.abs(drive).max())
    assert np.ptp(drive) > 0.3


def fmu_input(fmu: FmuProgram) -> str:
    return "drive moment" if fmu.program.drive_unit == "rad" else "drive force"


@needs_compiler
def test_whole_turns_go_on_beyond_the_printed_range(tmp_path: Path) -> None:
    fmu = fmu_program("crank-rocker", [], ["angle OA", "angle DB", "velocity B x"], driven=True)
    file = compiled(fmu, tmp_path)
    assert validate_fmu(file) == []
    times = np.linspace(0.0, 1.0, 41)
    signals = np.array(
        [(t, 20.0 * t - 5.0, 20.0, 0.0) for t in times],
        dtype=[(word, np.float64) for word in ("time", "drive", "drive speed", "drive acceleration")],
    )
    found = fmpy.simulate_fmu(
        file, fmi_type="CoSimulation", stop_time=1.0, output_interval=0.025, input=signals
    )
    drive = 20.0 * found["time"] - 5.0
    # inputs hold during a step: outputs are those of its beginning
    drive[1:] -= 20.0 * 0.025
    motion = ct.motion("crank-rocker", at=drive)
    assert np.abs(found["angle OA"] - motion.angle.sel(link="OA").values).max() < 1e-9
    assert np.abs(found["angle DB"] - motion.angle.sel(link="DB").values).max() < 1e-9
    rates = motion.velocity_coefficient.sel(point="B", axis="x").values * 20.0
    assert np.abs(found["velocity B x"] - rates).max() < 1e-9 * 20.0


@needs_compiler
def test_a_driven_model_of_exchange_follows_its_inputs(tmp_path: Path) -> None:
    outputs = ["angle DB", "position B x", "velocity B x", "acceleration B x"]
    file = compiled(fmu_program("crank-rocker", [], outputs, driven=True), tmp_path)
    times = np.linspace(0.0, 1.0, 41)
    drive, speed, acceleration = 0.3 + 2.0 * times + 4.0 * times**2, 2.0 + 8.0 * times, np.full(41, 8.0)
    words = ("time", "drive", "drive speed", "drive acceleration")
    rows = list(zip(times, drive, speed, acceleration, strict=True))
    signals = np.array(rows, dtype=[(word, np.float64) for word in words])
    found = fmpy.simulate_fmu(
        file, fmi_type="ModelExchange", stop_time=1.0, output_interval=0.025, input=signals, output=outputs
    )
    assert np.abs(found["time"] - times).max() < 1e-12
    motion = ct.motion("crank-rocker", at=drive)
    at = motion.sel(point="B", axis="x")
    wanted = {
        "angle DB": motion.angle.sel(link="DB").values,
        "position B x": at.position.values,
        "velocity B x": at.velocity_coefficient.values * speed,
        "acceleration B x": at.acceleration_coefficient.values * speed**2
        + at.velocity_coefficient.values * acceleration,
    }
    for name, values in wanted.items():
        assert np.abs(found[name] - values).max() < 1e-9 * max(1.0, np.abs(values).max()), name


@needs_compiler
def test_dimensions_are_parameters(tmp_path: Path) -> None:
    fmu = fmu_program("crank-rocker", ["links.AB.length"], ["position B x", "position B y"], driven=True)
    file = compiled(fmu, tmp_path)
    found = fmpy.simulate_fmu(
        file, stop_time=0.1, output_interval=0.1, start_values={"links.AB.length": 3.6, "drive": 1.0}
    )
    wanted = ct.motion(
        ct.with_value(ct.example("crank-rocker"), "links.AB.length", 3.6), at=[1.0]
    ).position.sel(point="B")
    assert [found["position B x"][0], found["position B y"][0]] == pytest.approx(wanted.values[0], abs=1e-12)


def test_the_same_mechanism_gives_the_same_bytes() -> None:
    one, other = (fmu_program("crank-rocker", [], ["angle DB"], driven=True) for _k in range(2))
    assert one.archive() == other.archive()
    assert one.token != fmu_program("crank-rocker", [], ["angle AB"], driven=True).token


@pytest.mark.parametrize(
    ("name", "outputs", "error", "told"),
    [
        ("five-bar-two-drives", None, NotComputedYet, "one drive"),
        ("crank-rocker", None, NotComputedYet, "masses"),
        ("third-class-triad", None, NotComputedYet, "platform"),
        ("single-cylinder-engine", ["angle XY"], InputError, "angle XY"),
    ],
)
def test_what_is_no_fmu_is_refused_by_name(
    name: str, outputs: list[str] | None, error: type[Exception], told: str
) -> None:
    with pytest.raises(error, match=told):
        fmu_program(name, None, outputs)


# The equations of all links.

FREE = ("double-pendulum", "five-bar-pendulum", "andrews-mechanism")


def free_mechanism(name: str) -> ct.Mechanism:
    """An example by the equations of all links, its first drive driven by a constant moment."""
    text = re.sub(r"^\[simulation\](?s:[^\[]*)", "", example_text(name), flags=re.M)
    if name == "andrews-mechanism":
        # as it is known: its moment is a load, and its crank turns more than five times
        told = f"duration = 0.05\nsamples = 51\ntolerance = {TOLERANCE / 10}"
    else:
        told = f'duration = 1.5\nsamples = 16\ntolerance = {TOLERANCE / 10}\ndriving = "0.2"'
    return ct.parse_mechanism(f'{text}\n[simulation]\nequations = "multibody"\n{told}\n')


@needs_compiler
@pytest.mark.parametrize("name", FREE)
def test_motions_of_all_links_are_those_of_a_simulation(name: str, tmp_path: Path) -> None:
    mechanism = free_mechanism(name)
    course = ct.simulate(mechanism)
    drives = [f"drive {drive.id}" for drive in mechanism.drives]
    points = list(mechanism.moving_points)
    outputs = [*drives, *(f"position {point} {axis}" for point in points for axis in "xy")]
    wanted = np.stack(
        [*course.drive_value.values.T, *(course.position.sel(point=x, axis=y) for x in points for y in "xy")],
        axis=1,
    )
    fmu = fmu_program(mechanism, None, [*outputs, "kinetic energy"], name=name)
    file = compiled(fmu, tmp_path)
    assert validate_fmu(file) == []
    # the moment of `driving` is positive in the sense in which the drive's law sets out
    sense = {"double-pendulum": 1.0, "five-bar-pendulum": -1.0}.get(name, 0.0)
    given = {f"drive moment {mechanism.drives[0].id}": sense * 0.2}
    times = course.time.values
    # CVODE with BDF, which is what FMPy has, gathers some thousand times its tolerance
    for kind, tolerance in (("CoSimulation", TOLERANCE), ("ModelExchange", TOLERANCE / 1000)):
        found = fmpy.simulate_fmu(
            file, fmi_type=kind, stop_time=float(times[-1]), output_interval=float(times[1]),
            relative_tolerance=tolerance, start_values=given, output=["status", *outputs],
        )  # fmt: skip
        assert np.abs(found["time"] - times).max() < 1e-12
        assert set(found["status"]) == {0}
        moved = np.stack([found[x] for x in outputs], axis=1)
        assert np.abs(moved - wanted).max() <= 10 * TOLERANCE, kind
    moved = exchanged_outputs(file, times, outputs, given, TOLERANCE)
    assert (
        np.abs(moved - wanted).max(axis=0) <= 10 * TOLERANCE * np.maximum(1.0, np.abs(wanted).max(axis=0))
    ).all()
    assert np.ptp(wanted[:, 0]) > 0.3
    if sense:
        still = ct.simulate(mechanism, mechanism.simulation.model_copy(update={"driving": None}))  # type: ignore[union-attr]
        assert np.abs(course.drive_value.values - still.drive_value.values).max() > 0.01


@needs_compiler
def test_a_start_that_does_not_close_is_closed(tmp_path: Path) -> None:
    outputs = [f"position {point} {axis}" for point in "CD" for axis in "xy"]
    fmu = fmu_program("five-bar-pendulum", None, outputs)
    file = compiled(fmu, tmp_path)
    start = {
        one.name: float(one.attributes["start"]) for one in fmu.variables if one.name.startswith("coordinate")
    }
    name, value = next(iter(start.items()))
    found = fmpy.simulate_fmu(
        file, fmi_type="CoSimulation", stop_time=0.01, output_interval=0.01, start_values={name: value + 0.05},
        output=[*outputs, *start],
    )  # fmt: skip
    assert abs(found[name][0] - value) > 0.01
    for row in found:
        apart = [row[f"position C {axis}"] - row[f"position D {axis}"] for axis in "xy"]
        assert np.hypot(*apart) == pytest.approx(0.45, abs=1e-9)


TWO_BARS = """
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.OA]
length = 1
mass = 1
shape = "rod"
[links.AB]
length = 1
mass = 1
shape = "rod"
[[drives]]
link = "OA"
start = 0.0
[[drives]]
link = "AB"
start = 0.0
speed = 1.0
"""


@pytest.mark.parametrize(
    ("more", "options", "told"),
    [
        ('[[stops]]\nlink = "OA"\nmost = 1.0\n', {}, "stops"),
        ('[[loads]]\nkind = "friction"\npoint = "A"\nlink = "AB"\nvalue = 0.1\n', {}, "friction"),
        ('[simulation]\nduration = 1\nkeeps = ["AB"]\n', {}, "keep"),
        ("", {"vary": ["links.AB.length"]}, "--vary"),
        ("", {"start": 0.0}, "--from"),
        ("", {"outputs": ["angle XY"]}, "angle XY"),
    ],
)  # fmt: skip
def test_what_free_motion_is_no_fmu_is_refused_by_name(
    more: str, options: dict[str, object], told: str
) -> None:
    with pytest.raises((NotComputedYet, InputError), match=told):
        fmu_program(ct.parse_mechanism(TWO_BARS + more), **options)  # type: ignore[arg-type]
