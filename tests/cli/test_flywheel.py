"""`centrode flywheel`, and what `run` adds for a machine, as a user meets them; machines that cannot be computed."""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.dynamics.steady_motion.machine import machine_results
from centrode.model.examples import example_text
from centrode.topics.presentation import sheet_of
from machines import ENGINE

Centrode = Callable[..., Any]
FIGURES = [
    "drive-speed", "energies", "moments", "real-accelerations", "real-angular-accelerations",
    "real-angular-velocities", "real-velocities", "wittenbauer", "works",
]  # fmt: skip
PICTURES = sorted(f"{name}.{kind}" for name in FIGURES for kind in ("png", "svg"))
GIVEN = ENGINE.format(machine="fluctuation = 0.05", more="", speed=1)


@pytest.fixture
def compressor(folder: Path) -> Path:
    (folder / "compressor.toml").write_text(GIVEN)
    return folder


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_a_flywheel_is_printed(centrode: Centrode, compressor: Path) -> None:
    done = centrode("flywheel", "compressor.toml")
    assert (done.code, done.err) == (0, "")
    assert done.out.startswith("Compressor\n\n")
    found = ct.flywheel(ct.read_mechanism("compressor.toml"))
    said = done.rows
    assert said["cycle"] == f"1 turn of the drive, {found.time_of_cycle:.6g} s"
    assert said["mean speed"] == "20 rad/s (mean of the greatest and the least)"
    assert said["work of the loads"].startswith("-800 J per cycle, within ")
    assert said["mean driving moment"] == f"{400 / math.pi:.6g} N·m"
    assert said["inertia needed"].startswith(
        f"{found.inertia:.6g} kg·m² exactly ({found.inertia_in_time:.6g}"
    )
    assert f"{found.inertia_first_order:.6g} kg·m² by the first-order formula (+" in done.out
    assert said["speed of the drive"] == "19.5 to 20.5 rad/s, fluctuation 0.05"
    assert "actual" in done.out
    assert [path.name for path in compressor.iterdir()] == ["compressor.toml"]


def test_files_of_others_in_the_folder_are_not_counted(centrode: Centrode, compressor: Path) -> None:
    (compressor / "made").mkdir()
    (compressor / "made" / "notes.txt").write_text("mine")
    done = centrode("flywheel", "compressor.toml", "--out", "made", "--no-figures", "--samples", "5")
    assert done.out.endswith("3 files in made: machine.csv, machine.nc, summary.json\n")
    assert (compressor / "made" / "notes.txt").read_text() == "mine"


def test_a_spherical_machine(centrode: Centrode, folder: Path) -> None:
    machine = "\n[machine]\nmean_speed = 2.94\nfluctuation = 0.05\n"
    (folder / "s.toml").write_text(example_text("spherical-crank-rocker-rigid") + machine)
    said = centrode("flywheel", "s.toml").rows
    assert said["work of the loads"].startswith("-11.7352 J per cycle")
    done = centrode("flywheel", "spherical-four-bar")
    assert (done.code, done.out) == (2, "")
    assert "[machine]: it is missing" in done.err


def test_the_mean_in_time(centrode: Centrode, compressor: Path) -> None:
    said = centrode("flywheel", "compressor.toml", "--mean", "time").rows
    found = ct.flywheel(ct.read_mechanism("compressor.toml"), "time")
    assert said["mean speed"] == "20 rad/s (average over time)"
    assert said["cycle"] == f"1 turn of the drive, {math.tau / 20:.6g} s"
    assert said["inertia needed"] == f"{found.inertia:.6g} kg·m² exactly"


@pytest.mark.drawn
def test_files_of_a_flywheel(centrode: Centrode, compressor: Path) -> None:
    done = centrode("flywheel", "compressor.toml", "--out", "f", "--samples", "9", "--method", "first-order")
    assert (done.code, done.err) == (0, "")
    names = sorted(path.name for path in (compressor / "f").iterdir())
    assert names == sorted([*PICTURES, "machine.csv", "machine.nc", "summary.json"])
    mechanism = ct.read_mechanism("compressor.toml")
    data = ct.steady_motion(mechanism, 9, method="first-order")
    table = rows(compressor / "f" / "machine.csv")
    for k, row in enumerate(table):
        assert float(row["work_of_loads [J]"]) == float(data["work_of_loads"][k])
        assert float(row["drive_speed [rad/s]"]) == float(data["drive_speed"][k])
        assert float(row["velocity_B_x [m/s]"]) == float(data["velocity"].sel(point="B", axis="x")[k])
    with xr.open_dataset(compressor / "f" / "machine.nc", engine="scipy") as written:
        np.testing.assert_array_equal(written["drive_acceleration"], data["drive_acceleration"])
        assert written.attrs["speed_by"] == "first-order"
    summary = json.loads((compressor / "f" / "summary.json").read_text())
    found = ct.flywheel(mechanism)
    assert summary["machine_inertia"] == {"value": found.inertia, "unit": "kg m^2"}
    assert found.rim is not None
    assert summary["flywheel_rim_outer"] == {"value": found.rim.outer, "unit": "m"}
    assert {
        name: one.as_dict() for name, one in sheet_of(machine_results(mechanism)).scalars.items()
    } == summary


def files_below(folder: Path) -> dict[str, list[str]]:
    """Names of files by their folder, that of all files first."""
    found: dict[str, list[str]] = {}
    for path in sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file()):
        found.setdefault("/".join(path.parts[:-1]), []).append(path.name)
    return found


def test_a_run_computes_the_machine(centrode: Centrode, folder: Path) -> None:
    done = centrode("run", "six-bar-press", "--out", "r", "--no-figures")
    assert (done.code, done.err) == (0, "")
    assert done.rows["flywheel"] == "1456.73 kg·m²"
    assert "loads and machine" not in done.out
    assert files_below(folder / "r") == {
        "": ["instants.csv", "motion.csv", "motion.nc", "summary.json"],
        "flywheel": ["machine-instants.csv", "machine.csv", "machine.nc"],
        "reactions": ["bearing-loads.csv", "bearings.nc", "joints.csv", "reactions.csv", "reactions.nc"],
    }
    assert done.out.endswith(
        "12 files in r: instants.csv, motion.csv, motion.nc, summary.json\n"
        "flywheel/: machine-instants.csv, machine.csv, machine.nc\n"
        "reactions/: bearing-loads.csv, bearings.nc, joints.csv, reactions.csv, reactions.nc\n"
    )
    (instant,) = rows(folder / "r" / "flywheel" / "machine-instants.csv")
    assert float(instant["turned [deg]"]) == pytest.approx(99.1, abs=1e-9)
    assert float(instant["drive_acceleration_first_order [deg/s^2]"]) == pytest.approx(
        math.degrees(2.768), abs=0.03
    )
    assert len(rows(folder / "r" / "flywheel" / "machine.csv")) == 361
    summary = json.loads((folder / "r" / "summary.json").read_text())
    assert summary["machine_driving_moment"]["value"] == pytest.approx(-2263.03, abs=0.005)
    assert summary["samples_ok"]["value"] == 361


def test_a_run_without_a_fluctuation(centrode: Centrode, compressor: Path) -> None:
    """The shafts alone carry the motion: energies and the fluctuation that there is."""
    shafts = GIVEN.replace("fluctuation = 0.05", "[[machine.shafts]]\ninertia = 30\nname = 'wheel'")
    (compressor / "compressor.toml").write_text(shafts)
    done = centrode("run", "compressor.toml", "--out", "r", "--samples", "5", "--no-figures")
    assert (done.code, done.err) == (0, "")
    assert done.rows["inertia present"] == "30 kg·m²"
    assert "inertia needed" not in done.rows
    mechanism = ct.read_mechanism("compressor.toml")
    drawn = ct.figures(machine_results(mechanism, 5))
    assert sorted(drawn) == [name for name in FIGURES if name != "wittenbauer"]
    summary = json.loads((compressor / "r" / "summary.json").read_text())
    assert 0.03 < summary["machine_obtained"]["value"] < 0.04
    assert "machine_inertia" not in summary


def test_a_run_that_locks_leaves_the_machine_out(centrode: Centrode, folder: Path) -> None:
    text = GIVEN.replace("length = 0.7", "length = 0.15").replace("centre = [0.3, 0]", "centre = [0.05, 0]")
    (folder / "m.toml").write_text(text)
    done = centrode("run", "m.toml", "--out", "r", "--no-figures")
    assert done.code == 3
    assert "note: the machine is omitted: [machine]: the mechanism does not turn fully" in done.out
    assert files_below(folder / "r") == {
        "": ["motion.csv", "motion.nc", "summary.json"],
        "reactions": ["bearing-loads.csv", "bearings.nc", "joints.csv", "reactions.csv", "reactions.nc"],
    }
    done = centrode("flywheel", "m.toml", "--out", "f")
    assert (done.code, done.out) == (3, "")
    assert done.err.startswith(
        "Error: m.toml, [machine]: the mechanism does not turn fully: it has no motion at "
    )
    assert "Traceback" not in done.err
    assert not (folder / "f").exists()


def test_friction_leaves_the_machine_out(centrode: Centrode, folder: Path) -> None:
    (folder / "m.toml").write_text(GIVEN + '\n[[loads]]\nkind = "friction"\nguide = "B"\ncoefficient = 0.1\n')
    done = centrode("run", "m.toml", "--out", "r", "--no-figures")
    assert done.code == 0
    assert re.search(r"note: the machine is omitted: .*: .*friction", done.out)


MASSES = ("mass", "inertia", "centre", "gravity")
WRONG = {
    "zero speed": ("mean_speed = 20", "mean_speed = 0", "[machine]: mean_speed must be positive, got 0"),
    "speed backwards": ("mean_speed = 20", 'mean_speed = "-65 rpm"', "mean_speed must be positive"),
    "wrong unit": ("mean_speed = 20", 'mean_speed = "65 m/s"', "expected an angular speed (rad/s)"),
    "no fluctuation": ("= 0.05", "= 0", "[machine]: fluctuation must be positive, got 0"),
    "lost in rounding": ("= 0.05", "= 1e-9", "1e-09 is outside the range that can be computed; stay above 1e-06"),
    "standing still": ("= 0.05", "= 2", "fluctuation must be smaller than 2, got 2"),
    "shaft without inertia": (
        "= 0.05", "= 0.05\n[[machine.shafts]]\nratio = 2", '[[machine.shafts]] 1: "inertia" is missing',
    ),
    "no ratio": (
        "= 0.05", "= 0.05\n[[machine.shafts]]\ninertia = 1\nratio = 0", "[[machine.shafts]] 1: ratio must not be zero",
    ),
    "negative inertia": (
        "= 0.05", "= 0.05\n[[machine.shafts]]\ninertia = -1", "inertia must not be negative, got -1",
    ),
    "a rim without a rim": (
        "= 0.05", "= 0.05\n[machine.flywheel]\ninner = 1", "[machine.flywheel]: inner must be smaller than 1, got 1",
    ),
    "mass for density": (
        "= 0.05", '= 0.05\n[machine.flywheel]\ndensity = "7800 kg"', "expected a density (kg/m^3), got",
    ),
    "unknown name": ("= 0.05", '= 0.05\ndriving = "1 + w"', '[machine] driving: unknown name "w"'),
    "drive without work": ("= 0.05", '= 0.05\ndriving = "sin(q)"', "the driving moment does no work over the cycle"),
    "drive without value": ("= 0.05", '= 0.05\ndriving = "1/(q-q)"', "has no finite value everywhere in the cycle"),
    "loads that drive": ("[-2000, 0]", "[2000, 0]", "the loads do work of 800 J: they drive the machine"),
    "loads of time": ("[-2000, 0]", '["-2000 - t", 0]', "the loads do not repeat with the motion"),
    "loads of turns": ("[-2000, 0]", '["-2000 - q", 0]', "the loads do not repeat with the motion"),
    "too little inertia": (
        "fluctuation = 0.05", "[[machine.shafts]]\ninertia = 0.01",
        "a moment of inertia of 0.01 kg·m² is too small: the machine would stop within the cycle",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
@pytest.mark.parametrize("command", ["flywheel", "run"])
def test_machines_that_cannot_be(centrode: Centrode, folder: Path, case: str, command: str) -> None:
    old, new, message = WRONG[case]
    assert old in GIVEN
    (folder / "m.toml").write_text(GIVEN.replace(old, new))
    if case == "too little inertia" and command == "flywheel":
        message = "[machine]: fluctuation is missing; give the one that is allowed"
    done = centrode(command, "m.toml", "--out", "result", "--no-figures")
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith("Error: m.toml")
    assert message in done.err
    assert "Traceback" not in done.err
    assert [path.name for path in folder.iterdir()] == ["m.toml"]


def without(text: str, *keys: str) -> str:
    return "\n".join(line for line in text.splitlines() if not line.startswith(keys)) + "\n"


def test_machines_of_nothing_and_of_too_much(centrode: Centrode, folder: Path) -> None:
    loads, machine = GIVEN.index("[[loads]]"), GIVEN.index("[machine]")
    cases = {
        "neither masses nor loads": without(GIVEN[:loads] + GIVEN[machine:], *MASSES),
        "[machine]: it is missing": GIVEN[:machine] + GIVEN[GIVEN.index("[assembly]") :],
        "steady motion needs one drive, the mechanism has 2": ct.mechanism_text(
            ct.example("five-bar-two-drives")
        )
        + "[machine]\nmean_speed = 1\nfluctuation = 0.1\n",
        "steady motion needs a drive that turns": ct.mechanism_text(ct.example("elliptic-trammel"))
        + "[machine]\nmean_speed = 1\nfluctuation = 0.1\n",
        "there are neither masses nor loads": ct.mechanism_text(ct.example("spherical-four-bar"))
        + "[machine]\nmean_speed = 1\nfluctuation = 0.1\n",
    }
    for message, text in cases.items():
        (folder / "m.toml").write_text(text)
        done = centrode("flywheel", "m.toml")
        assert (done.code, done.out) == (2, "")
        assert message in done.err
        assert "Traceback" not in done.err


def test_only_masses_or_only_loads(centrode: Centrode, folder: Path) -> None:
    """Masses alone swing their energy to and fro; loads alone need a flywheel as the first-order formula has it."""
    loads, machine = GIVEN.index("[[loads]]"), GIVEN.index("[machine]")
    (folder / "m.toml").write_text(GIVEN[:loads] + GIVEN[machine:])
    said = centrode("flywheel", "m.toml").rows
    assert said["work of the loads"].startswith("0 J per cycle")
    assert said["mean driving moment"] == "0 N·m"
    (folder / "m.toml").write_text(without(GIVEN, *MASSES))
    done = centrode("flywheel", "m.toml")
    assert done.code == 0
    assert (
        "by the first-order formula (+0.00%)" in done.out or "by the first-order formula (-0.00%)" in done.out
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--mean", "middling"), "Invalid value for '--mean'"),
        (("--method", "best"), "Invalid value for '--method'"),
        (
            ("--samples", "0", "--out", "f"),
            "compressor.toml, samples: 0 samples are given; give 1 to 1000000",
        ),
        (("--out", "compressor.toml"), "Error: compressor.toml is not a folder"),
    ],
)
def test_wrong_questions(
    centrode: Centrode, compressor: Path, arguments: tuple[str, ...], message: str
) -> None:
    done = centrode("flywheel", "compressor.toml", *arguments)
    assert (done.code, done.out) == (2, "")
    assert message in done.err
    assert [path.name for path in compressor.iterdir()] == ["compressor.toml"]


def test_wrong_questions_from_python() -> None:
    mechanism = ct.parse_mechanism(GIVEN)
    with pytest.raises(ct.InputError, match='mean: "best" is not a mean speed; use one of middle, time'):
        ct.flywheel(mechanism, "best")  # type: ignore[arg-type]
    with pytest.raises(
        ct.InputError, match="is not a method of computing the speed; use one of exact, first-order"
    ):
        ct.steady_motion(mechanism, 3, method="best")  # type: ignore[arg-type]
    with pytest.raises(ct.InputError, match="at: it needs finite values of the drive"):
        ct.steady_motion(mechanism, at=[math.nan])
