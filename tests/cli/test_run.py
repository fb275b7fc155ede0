"""`centrode run` on good input: what it writes, what it prints, and that the two agree."""

from __future__ import annotations

import csv
import json
import math
import os
import re
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import centrode as ct
from centrode.model.examples import example_text
from centrode.quantities import display_unit
from samples import examples_at_hand

Centrode = Callable[..., Any]
FIGURES = (
    "accelerations",
    "angles",
    "angular-accelerations",
    "angular-velocities",
    "kinematic-coefficients",
    "mechanism",
    "paths",
    "slides",
    "velocities",
)
PICTURES = [f"{name}.{kind}" for name in FIGURES for kind in ("png", "svg")]
TABLES = ["motion.csv", "motion.nc", "summary.json"]


def rows_of(folder: Path, table: str = "motion.csv") -> list[dict[str, str]]:
    with (folder / table).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def summary_of(folder: Path) -> dict[str, float]:
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert all(set(scalar) == {"value", "unit"} for scalar in summary.values())
    return {name: scalar["value"] for name, scalar in summary.items()}


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def numbers(text: str) -> list[float]:
    """Numbers of a printed row, values in degrees after radians left out."""
    return [float(n) for n in re.findall(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?", re.sub(r"\([^()]*deg\)", "", text))]


@pytest.mark.drawn
def test_everything_is_written_and_said(centrode: Centrode, folder: Path) -> None:
    done = centrode("run", "slider-between-cranks", "--out", "result", "--samples", "5")
    assert done.code == 0
    assert done.err == ""
    out = folder / "result"
    assert names(out) == sorted([*TABLES, "instants.csv", *PICTURES])
    assert all((out / f"{name}.png").read_bytes().startswith(b"\x89PNG") for name in FIGURES)
    assert all("<svg" in (out / f"{name}.svg").read_text(encoding="utf-8") for name in FIGURES)
    assert "22 files in result:" in done.out
    assert all(name in done.out for name in names(out))
    assert done.out.startswith("Slider between two cranks\n\nmobility  ")
    assert all(len(line) <= 110 for line in done.out.splitlines())
    assert names(folder) == ["result"]


def test_headers_and_values_of_the_table(centrode: Centrode, folder: Path) -> None:
    centrode("run", "slider-between-cranks", "--out", "result", "--samples", "5", "--no-figures")
    assert names(folder / "result") == ["instants.csv", *TABLES]
    rows = rows_of(folder / "result")
    header = list(rows[0])
    assert header[:4] == ["time [s]", "drive_OA [rad]", "angle_OA [rad]", "angle_AC [rad]"]
    assert {
        "angular_velocity_AC [rad/s]", "position_C_x [m]", "velocity_C_x [m/s]", "acceleration_B_y [m/s^2]",
        "slide_C [m]", "velocity_coefficient_B_x [m/rad]", "status", "residual",
    } <= set(header)  # fmt: skip
    assert not any(name.startswith("position_O") for name in header), "points of the frame do not move"
    motion = ct.motion(ct.example("slider-between-cranks"), 5)
    assert [float(row["velocity_C_x [m/s]"]) for row in rows] == pytest.approx(
        motion.velocity.sel(point="C", axis="x").to_numpy(), rel=1e-15
    )
    assert {row["status"] for row in rows} == {"ok"}


@pytest.mark.parametrize("name", ["kite", "slider-between-cranks-locked", "scissor-lift", "six-bar-press"])
def test_the_summary_holds_what_is_printed(centrode: Centrode, folder: Path, name: str) -> None:
    done = centrode("run", name, "--out", "result", "--no-figures")
    told, saved = done.rows, summary_of(folder / "result")
    display = ct.example(name).display
    unit = "rad" if "rad" in units(folder, "first_value") else "m"
    factor = display_unit(unit, display.length, display.angle)[0]

    def shown(*values: float) -> list[float]:
        return [pytest.approx(value * factor, rel=1e-8) for value in values]

    n, p5, p4 = (saved[key] for key in ("moving_links", "lower_pairs", "higher_pairs"))
    assert numbers(told["mobility"]) == [
        saved["mobility"], 3, n, 2, p5, p4, saved["mobility_by_chebyshev"],
    ]  # fmt: skip
    assert told["independent loops"] == str(saved["loops"])
    assert (told["redundant constraints"] == "none") == (saved["redundant_constraints"] == 0)
    # without a residual it closes exactly, and no number is told
    assert (numbers(told["initial position"]) or [0.0]) == [
        pytest.approx(saved["initial_residual"], rel=0.05)
    ]
    assert numbers(told["worst residual"])[0] == pytest.approx(saved["worst_residual"], rel=0.05)
    assert numbers(told["range"]) == [
        *shown(saved["first_value"], saved["last_value"]), pytest.approx(saved["duration"], rel=1e-5),
    ]  # fmt: skip
    for row, key in (("limits", "limit"), ("change points", "change_point")):
        assert numbers(told[row]) == shown(*(v for k, v in saved.items() if k.startswith(f"{key}_")))
    counts = {k.removeprefix("samples_").replace("_", " "): v for k, v in saved.items() if "samples_" in k}
    said = dict(part.rsplit(" ", 1) for part in told["samples"].partition(": ")[2].split(", "))
    assert {k: int(v) for k, v in said.items()} == {k: v for k, v in counts.items() if v}
    assert sum(counts.values()) == saved["samples"] == len(rows_of(folder / "result"))


def units(folder: Path, name: str) -> str:
    return str(json.loads((folder / "result" / "summary.json").read_text())[name]["unit"])


def test_what_the_message_offers_is_reached(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "run", "slider-between-cranks-locked", "--range", "reachable", "--no-figures", "--out", "r"
    )
    assert done.code == 0, done.err
    assert done.rows["samples"] == "101: ok 101"
    text = example_text("slider-between-cranks-locked")
    assert "\n[study]\n" in text
    (folder / "m.toml").write_text(
        text.replace("[study]\n", '[study]\nrange = "reachable"\n'), encoding="utf-8"
    )
    from_file = centrode("run", "m.toml", "--no-figures", "--out", "f")
    assert from_file.code == 0, from_file.err
    assert from_file.rows["range"] == done.rows["range"]


def test_a_mechanism_that_locks_ends_with_3_and_everything_written(centrode: Centrode, folder: Path) -> None:
    done = centrode("run", "slider-between-cranks-locked", "--out", "result")
    assert done.code == 3
    assert done.err == (
        "Error: slider-between-cranks-locked: the mechanism locks: 72 of 101 samples are not reached"
        " (limit at 1.79991242 rad (103.127 deg), group CB-BD (point B) in a dead position);"
        ' choose the range between the limits (range = "reachable" under [study], or the option --range reachable),'
        " or change a dimension as centrode rotatability proposes\n"
    )
    assert names(folder / "result") == sorted([*TABLES, "instants.csv", *PICTURES])
    assert "ok 29, open 59, cut off 13" in done.rows["samples"]
    end = "1.79991242 rad (103.127 deg) (dead position of group CB-BD (point B))"
    assert done.rows["reached part"] == f"0 rad (0 deg) to {end}"
    assert summary_of(folder / "result")["limit_1"] == pytest.approx(1.79991241652444, abs=1e-12)
    statuses = [row["status"] for row in rows_of(folder / "result")]
    assert statuses == ["ok"] * 29 + ["open"] * 59 + ["cut off"] * 13
    gap = rows_of(folder / "result")[50]
    assert float(gap["drive_OA [rad]"]) == pytest.approx(math.pi, abs=1e-15)
    assert gap["position_B_x [m]"] == "", "absence is empty"
    done = centrode(
        "run", "slider-between-cranks-locked", "--out", "inside", "--no-figures", "--to", "103 deg"
    )
    assert done.code == 0


def test_a_range_with_units(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "run", "kite", "--out", "r", "--no-figures", "--samples", "4", "--from", "0 deg", "--to", "90 deg"
    )
    assert done.code == 0
    assert done.rows["range"] == "0 rad (0 deg) to 1.57079633 rad (90 deg) in 1.5708 s"
    drive = [float(row["drive_OA [rad]"]) for row in rows_of(folder / "r")]
    assert drive == pytest.approx([0, math.pi / 6, math.pi / 3, math.pi / 2], abs=1e-15)


def test_a_range_runs_backwards_and_below_zero(centrode: Centrode, folder: Path) -> None:
    done = centrode("run", "kite", "--no-figures", "--samples", "2", "--from", "10 deg", "--to", "-10 deg")
    assert done.code == 0
    drive = [float(row["drive_OA [rad]"]) for row in rows_of(folder / "kite-result")]
    assert drive == pytest.approx([math.pi / 18, -math.pi / 18], abs=1e-15)


def test_one_sample(centrode: Centrode, folder: Path) -> None:
    assert centrode("run", "kite", "--out", "r", "--samples", "1").code == 0
    assert len(rows_of(folder / "r")) == 1


def test_a_law_is_asked_for_by_times(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "run", "wiper", "--out", "r", "--no-figures", "--samples", "5", "--from", "0 s", "--to", "2 s"
    )
    assert done.code == 0
    # between pi/2 + 0.8 sin 0 and the greatest of the samples, at 1.5 s
    least, greatest = math.pi / 2, math.pi / 2 + 0.8 * math.sin(1.5)
    assert done.rows["range"] == (
        f"0 s to 2 s, OA between {least:.9g} rad (90 deg) and {greatest:.9g} rad (135.722 deg)"
    )
    saved = summary_of(folder / "r")
    assert (saved["first_time"], saved["last_time"], saved["duration"]) == (0.0, 2.0, 2.0)
    assert (saved["least_OA"], saved["greatest_OA"]) == pytest.approx((least, greatest), abs=1e-15)
    assert [float(row["time [s]"]) for row in rows_of(folder / "r")] == [0.0, 0.5, 1.0, 1.5, 2.0]


def test_several_drives_are_asked_for_by_times(centrode: Centrode) -> None:
    done = centrode("run", "two-link-arm", "--out", "r", "--no-figures", "--to", "1 s")
    assert done.code == 0
    assert done.rows["range"] == (
        "0 s to 1 s, OA between 0 rad (0 deg) and 1 rad (57.2958 deg),"
        " AB between -2 rad (-114.592 deg) and 0 rad (0 deg)"
    )


def test_a_file_with_a_law_says_its_times(centrode: Centrode, folder: Path, four_bar: str) -> None:
    law = four_bar.replace("speed = 1\n", 'law = "0.3*sin(2*t)"\n[study]\nfrom = "500 ms"\nto = "2 s"\n')
    (folder / "press.toml").write_text(law)
    done = centrode("run", "press.toml", "--no-figures")
    assert done.code == 0
    assert done.rows["range"].startswith("0.5 s to 2 s, OA between ")
    assert names(folder / "press-result") == TABLES


def test_a_table_beside_the_file(centrode: Centrode, folder: Path, four_bar: str) -> None:
    (folder / "sub").mkdir()
    (folder / "sub" / "press.toml").write_text(four_bar.replace("speed = 1", 'table = "crank.csv"'))
    (folder / "sub" / "crank.csv").write_text("time [s],angle [deg]\n0,0\n1,10\n2,40\n3,90\n")
    done = centrode("run", "sub/press.toml", "--no-figures", "--samples", "4")
    assert done.code == 0
    assert done.rows["range"].startswith("0 s to 3 s, OA between 1 rad ")
    assert names(folder) == ["press-result", "sub"], "the default folder stands in the current one"


def test_the_file_says_what_it_shows(centrode: Centrode, folder: Path, four_bar: str) -> None:
    text = 'display = { length = "mm", angle = "deg" }\n' + four_bar.replace("start = 1", 'start = "1 rad"')
    text += "[study]\nsamples = 3\n"
    (folder / "press.toml").write_text(text)
    done = centrode("run", "press.toml", "--out", "r", "--no-figures")
    assert done.rows["range"] == "57.2957795 deg to 417.29578 deg in 6.28319 s"
    row = rows_of(folder / "r")[0]
    assert float(row["position_A_x [mm]"]) == pytest.approx(1000 * math.cos(1))
    assert float(row["angle_OA [deg]"]) == pytest.approx(math.degrees(1))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_ends_of_lines_and_marks_of_editors_do_not_matter(
    centrode: Centrode, folder: Path, four_bar: str, encoding: str, end: str
) -> None:
    text = four_bar.replace("Press", "Пресс «А'»").replace("\n", end)
    (folder / "press.toml").write_bytes(text.encode(encoding))
    done = centrode("run", "press.toml", "--no-figures", "--samples", "3")
    assert done.code == 0
    assert done.out.startswith("Пресс «А'»\n")


def test_an_existing_folder_keeps_its_other_files(centrode: Centrode, folder: Path) -> None:
    out = folder / "deep" / "result"
    out.mkdir(parents=True)
    (out / "notes.txt").write_text("mine")
    (out / "motion.csv").write_text("of yesterday")
    done = centrode("run", "kite", "--out", "deep/result", "--no-figures", "--samples", "2")
    assert done.code == 0
    assert f"3 files in {Path('deep/result')}: motion.csv, motion.nc, summary.json" in done.out
    assert (out / "notes.txt").read_text() == "mine"
    assert len(rows_of(out)) == 2
    if os.name == "posix":
        mode = {stat.S_IMODE((out / name).stat().st_mode) for name in ("notes.txt", "motion.csv")}
        assert len(mode) == 1, "results may be read by whom other files may"


def test_the_same_command_writes_the_same_table_twice(centrode: Centrode, folder: Path) -> None:
    for out in ("one", "two"):
        centrode("run", "jansen-leg", "--out", out, "--samples", "20", "--no-figures")
    for name in ("motion.csv", "summary.json"):
        assert (folder / "one" / name).read_bytes() == (folder / "two" / name).read_bytes()


def test_a_file_goes_before_an_example_of_its_name(centrode: Centrode, folder: Path, four_bar: str) -> None:
    (folder / "kite").write_text(four_bar)
    assert centrode("check", "kite").out.startswith("Press\n")


@pytest.mark.parametrize("name", examples_at_hand(ct.example_names()))
def test_every_example_runs(centrode: Centrode, name: str) -> None:
    done = centrode("run", name, "--out", "r", "--no-figures", "--samples", "12")
    assert done.code == (3 if name.endswith("-locked") else 0), done.err


def test_in_a_process_of_its_own(folder: Path) -> None:
    run = [sys.executable, "-m", "centrode", "run", "kite", "--out", "r", "--samples", "3", "--no-figures"]
    done = subprocess.run(run, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0
    assert done.stderr == ""
    assert done.stdout.startswith("Kite linkage\n")
    assert names(folder / "r") == TABLES


def test_instants_are_computed_exactly(centrode: Centrode, folder: Path, four_bar: str) -> None:
    (folder / "press.toml").write_text(four_bar + '[study]\ninstants = ["99.1 deg", 0.3]\n')
    assert centrode("run", "press.toml", "--out", "r", "--no-figures", "--samples", "3").code == 0
    rows = rows_of(folder / "r", "instants.csv")
    assert [float(row["drive_OA [rad]"]) for row in rows] == [math.radians(99.1), 0.3]
    assert [float(row["position_A_x [m]"]) for row in rows] == pytest.approx(
        [math.cos(math.radians(99.1)), math.cos(0.3)], abs=1e-15
    )


@pytest.mark.parametrize("name", ["crank-rocker", "spherical-four-bar"])
def test_an_animation_of_the_motion(centrode: Centrode, folder: Path, name: str) -> None:
    done = centrode("run", name, "--animate", "--no-figures", "--samples", "9", "--out", "moved")
    assert done.code == 0
    assert "motion.gif" in done.out
    with Image.open(folder / "moved" / "motion.gif") as moved:
        # the last of nine samples of a whole turn is the first picture again
        assert getattr(moved, "n_frames", 1) == 8
