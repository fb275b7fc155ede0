"""`centrode integrate`, `centrode variants` and `centrode describe` as a user meets them."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct

Centrode = Callable[..., Any]

FIGURES = ("integrated-angles", "integrated-angular-velocities", "integrated-slides", "integrated-velocities",
           "integration-errors")  # fmt: skip


@pytest.mark.drawn
def test_integrate(centrode: Centrode, folder: Path) -> None:
    done = centrode("integrate", "slider-between-cranks", "--out", "r")
    assert (done.code, done.err) == (0, "")
    assert done.out.startswith("Slider between two cranks\n\n")
    assert done.rows["method"] == "Runge-Kutta of fourth order, 100 steps of 0.0628319 s"
    assert done.rows["range"] == "0 s to 6.28318531 s"
    assert done.rows["rows"] == "101: ok 101"
    assert done.rows["stops"] == "nowhere"
    assert done.rows["closed-form solution"] == "no obstacle"
    assert done.rows["greatest drift"].endswith(" of the greatest length (y_D)")
    assert done.rows["last row"].startswith("repeats the first within ")
    assert {file.name for file in (folder / "r").iterdir()} == {
        "integration.csv", "integration.nc", *(f"{name}.{kind}" for name in FIGURES for kind in ("png", "svg")),
    }  # fmt: skip
    with (folder / "r" / "integration.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 101
    expected = ct.integrate(ct.example("slider-between-cranks"))
    for header, values in {
        "time [s]": expected["time"],
        "angle_CB [rad]": expected["angle"].sel(link="CB"),
        "angular_velocity_BD [rad/s]": expected["angular_velocity"].sel(link="BD"),
        "velocity_C_x [m/s]": expected["velocity"].sel(point="C", axis="x"),
        "slide_velocity_C [m/s]": expected["slide_velocity"].sel(guide="C"),
        "drift_y_D": expected["drift"].sel(constraint="y_D"),
        "angle_difference_BD [rad]": expected["angle_difference"].sel(link="BD"),
        "position_difference_B [m]": expected["position_difference"].sel(point="B"),
    }.items():
        assert np.array_equal([float(row[header]) for row in rows], values.to_numpy()), header
    assert {row["status"] for row in rows} == {"ok"}
    with xr.open_dataset("r/integration.nc", engine="scipy") as data:
        assert np.array_equal(data["angle"], expected["angle"])


def test_integrate_with_everything_said(centrode: Centrode, folder: Path) -> None:
    done = centrode("integrate", "crank-rocker", "--method", "adaptive", "--steps", "7", "--tolerance", "1e-8", "--to",
                    "180 deg", "--no-figures")  # fmt: skip
    assert (done.code, done.err) == (0, "")
    assert done.rows["method"].startswith("Dormand-Prince of eighth order, ")
    assert done.rows["method"].endswith(" steps, tolerance 1.0e-08")
    assert done.rows["rows"] == "8: ok 8"
    assert done.rows["last row"].startswith("does not repeat the first: ")
    assert {file.name for file in (folder / "crank-rocker-integration").iterdir()} == {
        "integration.csv", "integration.nc",
    }  # fmt: skip


def test_integrate_stops_at_a_limit_with_exit_3(centrode: Centrode, folder: Path) -> None:
    done = centrode("integrate", "slider-between-cranks-locked", "--out", "r", "--no-figures")
    assert done.code == 3
    assert done.rows["rows"] == "101: ok 29, open 72"
    assert "1.79991242 s (OA at 1.79991242 rad (103.127 deg)) the determinant" in done.rows["stops"]
    assert done.rows["closed-form solution"].startswith("limit at 1.79991242 rad (103.127 deg); ")
    assert done.rows["last row"] == "not reached"
    assert "choose a range that ends before it" in done.err
    with (folder / "r" / "integration.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["status"] for row in rows] == ["ok"] * 29 + ["open"] * 72
    assert all(row["angle_CB [rad]"] == "" for row in rows[29:])


def test_integrate_with_too_few_steps_says_so(centrode: Centrode, folder: Path) -> None:
    done = centrode("integrate", "slider-between-cranks", "--steps", "5", "--out", "r")
    assert done.code == 3
    assert "fixed steps drift off the mechanism at " in done.err
    assert done.err.rstrip().endswith("increase the number of steps")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("nothing",), "no such file"),
        (("crank-rocker", "--method", "rk5"), 'there is no method "rk5"; did you mean "rk4"?'),
        (("crank-rocker", "--steps", "0"), "0 steps are given"),
        (("crank-rocker", "--steps", "many"), "many"),
        (("crank-rocker", "--method", "adaptive", "--tolerance", "1"), "1 is not a valid tolerance"),
        (
            ("crank-rocker", "--tolerance", "1e-8"),
            "--tolerance: fixed steps have no tolerance; add --method adaptive",
        ),
        (("crank-rocker", "--method", "adaptive", "--tolerance", "nan"), "is not a valid tolerance"),
        (("crank-rocker", "--to", "3 kg"), "--to: expected an angle"),
        (("crank-rocker", "--to", "1000000 deg"), "it is too long"),
        (("spherical-four-bar",), "not on the sphere"),
    ],
)
def test_integrate_refuses(
    centrode: Centrode, folder: Path, arguments: tuple[str, ...], message: str
) -> None:
    done = centrode("integrate", *arguments, "--out", "r")
    assert (done.code, done.out) == (2, "")
    assert message in done.err
    assert "Traceback" not in done.err
    assert list(folder.iterdir()) == []


# variants

TABLE = "variant;l3_m;phi3_0_rad;phi4_0_rad\n1;1,2;1,9;3,5\n2;1,2;4,7;5,7\n3;1,25;1,9;3,5\n"


@pytest.fixture
def table(folder: Path) -> Path:
    (folder / "t.csv").write_text(TABLE, encoding="utf-8")
    return folder / "t.csv"


def test_variants(centrode: Centrode, folder: Path, table: Path) -> None:
    done = centrode("variants", "t.csv", "--topology", "slider-between-cranks")
    assert (done.code, done.err) == (0, "")
    lines = done.out.splitlines()
    assert lines[0].split() == ["variant", "turns", "fully", "limit", "group", "status"]
    assert lines[1].split() == ["1", "yes", "ok"]
    assert lines[2].split() == ["2", "no", "1.79991242", "rad", "group", "CB-BD", "(point", "B)", "locks"]
    assert lines[-2:] == ["3 variants: ok 2, locks 1", "wrote t-variants/summary.csv".replace("/", os.sep)]
    names = {path.name for path in (folder / "t-variants").iterdir()}
    assert names == {"summary.csv", "variant-1", "variant-2", "variant-3"}


def test_variants_with_workbooks_and_commas(centrode: Centrode, folder: Path, table: Path) -> None:
    words = ("variants", "t.csv", "--topology", "slider-between-cranks", "--out", "r")
    assert centrode(*words).code == 0
    plain = {path: path.read_text(encoding="utf-8") for path in Path("r").rglob("*.csv")}
    for _again in range(2):  # what is finished is not spelled again
        assert centrode(*words, "--xlsx", "--decimal-comma").code == 0
        for path, text in plain.items():
            assert path.with_suffix(".xlsx").read_bytes()[:2] == b"PK"
            found = list(csv.reader(path.read_text(encoding="utf-8-sig").splitlines(), delimiter=";"))
            expected = list(csv.reader(text.splitlines()))
            assert [[field.replace(",", ".") for field in row] for row in found] == [
                [field.replace(",", ".") for field in row] for row in expected
            ]
            assert not any("." in field for field in found[-1] if field and field[0] in "0123456789-")
    assert centrode(*words).code == 0
    assert {path: path.read_text(encoding="utf-8") for path in Path("r").rglob("*.csv")} == plain
    assert not list(Path("r").rglob("*.xlsx"))


def test_variants_with_a_row_that_is_refused(centrode: Centrode, folder: Path, table: Path) -> None:
    table.write_text(TABLE + "4;-1;1,9;3,5\n5;9;1,9;3,5\n", encoding="utf-8")
    done = centrode("variants", "t.csv", "--topology", "slider-between-cranks", "--out", "r")
    assert done.code == 3
    assert "3 variants" not in done.err
    assert done.err.startswith("Error: t.csv: 1 variant was not computed\n4: ")
    assert "length must be positive" in done.err
    assert "5 variants: " in done.out
    assert (folder / "r" / "variant-3" / "motion.csv").exists()


def test_causes_are_told_in_the_language_asked_for(centrode: Centrode, folder: Path, table: Path) -> None:
    table.write_text(TABLE + "4;-1;1,9;3,5\n5;9;1,9;3,5\n", encoding="utf-8")
    done = centrode("variants", "t.csv", "--topology", "slider-between-cranks", "--out", "r", "--lang", "ru")
    assert done.code == 3
    assert "Traceback" not in done.err and "length must be positive" not in done.err
    assert done.err.splitlines()[1].startswith("4: [links.CB]: length: ")
    assert "group" not in done.out and "variant " not in done.out
    summary = (folder / "r" / "summary.csv").read_text(encoding="utf-8")
    assert "length must be positive" in summary and summary.isascii()


def test_variants_are_gone_on_with(
    centrode: Centrode, folder: Path, table: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(self: object, what: str, done: int = 0, of: int = 0) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with monkeypatch.context() as interrupted:
        interrupted.setattr("centrode.cli.variants.Progress.say", stop)
        done = centrode("variants", "t.csv", "--topology", "slider-between-cranks", "--out", "r")
    assert (done.code, done.out) == (130, "")
    assert done.err == "finished results stay in r; the same command resumes from there\ninterrupted\n"
    marker = folder / "r" / "variant-1" / "variant.json"
    before = marker.stat().st_mtime_ns
    assert centrode("variants", "t.csv", "--topology", "slider-between-cranks", "--out", "r").code == 0
    assert marker.stat().st_mtime_ns == before


@pytest.mark.parametrize(
    ("content", "arguments", "message"),
    [
        (TABLE, (), "--topology"),
        (TABLE, ("--topology", "nothing"), "no such file"),
        (TABLE, ("--topology", "crank-rocker"), 'column "phi4_0_rad": there is no link 4'),
        (TABLE, ("--topology", "slider-between-cranks", "--jobs", "0"), "0 processes are given"),
        ("", ("--topology", "slider-between-cranks"), "t.csv: the file is empty"),
        (
            "variant,l2\n1,x\n",
            ("--topology", "slider-between-cranks"),
            't.csv, row 2, column "l2": expected a length',
        ),
    ],
)
def test_variants_refuses(
    centrode: Centrode, folder: Path, table: Path, content: str, arguments: tuple[str, ...], message: str
) -> None:
    table.write_text(content, encoding="utf-8")
    done = centrode("variants", "t.csv", "--out", "r", *arguments)
    assert (done.code, done.out) == (2, "")
    assert message in done.err
    assert "Traceback" not in done.err
    assert [path.name for path in folder.iterdir()] == ["t.csv"]


@pytest.fixture
def short(folder: Path) -> Path:
    """A topology that wishes for a short report."""
    text = ct.mechanism_text(ct.example("slider-between-cranks")) + '\n[report]\nchapters = ["structure"]\n'
    (folder / "short.toml").write_text(text, encoding="utf-8")
    return folder / "short.toml"


def test_variants_with_reports(centrode: Centrode, folder: Path, table: Path, short: Path) -> None:
    arguments = (
        "variants",
        "t.csv",
        "--topology",
        "short.toml",
        "--out",
        "r",
        "--report",
        "--format",
        "html,pdf",
    )
    done = centrode(*arguments)
    assert (done.code, done.err) == (0, "")
    ends = [f"wrote r{os.sep}{name}" for name in ("summary.csv", "answers.html", "answers.pdf")]
    assert done.out.splitlines()[-3:] == ends
    files = {path.name for path in (folder / "r" / "variant-2").iterdir()}
    assert {"report.html", "report.pdf", "answers.json", "motion.csv"} <= files
    before = [(folder / "r" / name).read_bytes() for name in ("answers.html", "answers.pdf")]
    marker = (folder / "r" / "variant-1" / "variant.json").stat().st_mtime_ns
    assert centrode(*arguments).code == 0  # the same bytes, and nothing is made again
    assert [(folder / "r" / name).read_bytes() for name in ("answers.html", "answers.pdf")] == before
    assert (folder / "r" / "variant-1" / "variant.json").stat().st_mtime_ns == marker


def test_variants_with_reports_and_an_analysis(centrode: Centrode, folder: Path) -> None:
    """A press has its flywheel, a linkage without a machine has none: both have a report, and the answers say so."""
    chapter = '[report]\nchapters = ["structure"]\n'
    for name in ("six-bar-press", "crank-rocker"):
        text = ct.mechanism_text(ct.example(name))
        assert "[report]" not in text
        (folder / f"{name}.toml").write_text(f"{text}\n{chapter}", encoding="utf-8")
    (folder / "t.csv").write_text("variant,topology\na,\nb,crank-rocker.toml\n", encoding="utf-8")
    done = centrode(
        *("variants", "t.csv", "--topology", "six-bar-press.toml", "--out", "r"),
        *("--compute", "flywheel", "--report", "--format", "html"),
    )
    assert (done.code, done.err) == (0, "")
    refusal = "b: [machine]: it is missing"
    assert "1 variant has no numbers:" in done.out and refusal in done.out and "2 variants: ok 2" in done.out
    assert {"report.html", "answers.json", "machine.csv"} <= {
        path.name for path in (folder / "r" / "variant-a").iterdir()
    }
    assert not (folder / "r" / "variant-b" / "machine.csv").exists()
    with (folder / "r" / "summary.csv").open(encoding="utf-8", newline="") as file:
        first, second = csv.DictReader(file)
    assert first["inertia [kg m^2]"] and (first["cause"], first["status"]) == ("", "ok")
    assert second["cause"].startswith("flywheel: [machine]: it is missing") and second["status"] == "ok"
    answers = (folder / "r" / "answers.html").read_text(encoding="utf-8")
    assert "Analysis: flywheel" in answers and refusal in answers
    spoken = centrode(
        "variants",
        "t.csv",
        "--topology",
        "six-bar-press.toml",
        "--out",
        "r2",
        "--compute",
        "flywheel",
        "--lang",
        "ru",
    )
    assert "b: [machine]: " in spoken.out and "it is missing" not in spoken.out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--format", "pdf"), "--format: this option is used with --report only"),
        (("--report", "--format", "odt"), "odt"),
        (("--report", "--format", ","), "no format is named"),
    ],
)
def test_variants_refuse_wrong_formats(
    centrode: Centrode, folder: Path, table: Path, short: Path, arguments: tuple[str, ...], message: str
) -> None:
    done = centrode("variants", "t.csv", "--topology", "short.toml", "--out", "r", *arguments)
    assert (done.code, done.out) == (2, "")
    assert message in done.err and "Traceback" not in done.err
    assert not (folder / "r").exists()


def test_variants_in_processes_of_the_real_command(centrode: Centrode, folder: Path, table: Path) -> None:
    """Several processes say and write the same as one, byte by byte, of variants that are refused too."""
    table.write_text("".join(TABLE.splitlines(keepends=True)[:3]) + "4;-1;1,9;3,5\n", encoding="utf-8")
    words = ["variants", "t.csv", "--topology", "slider-between-cranks"]
    done = subprocess.run(
        [sys.executable, "-m", "centrode", *words, "--jobs", "2", "--out", "r"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    one = centrode(*words, "--out", "one")
    assert done.returncode == one.code == 3
    assert done.stderr == one.err
    assert "3 variants: ok 1, locks 1, refused 1" in done.stdout
    assert done.stdout.replace(f"r{os.sep}summary", f"one{os.sep}summary") == one.out
    written = [
        {file.relative_to(out): file.read_bytes() for file in Path(out).rglob("*") if file.is_file()}
        for out in ("r", "one")
    ]
    assert written[0] == written[1]


# words


def test_describe(centrode: Centrode) -> None:
    done = centrode("describe", "slider-between-cranks")
    assert (done.code, done.err) == (0, "")
    assert done.out.startswith(
        "Slider between two cranks\n\nThe mechanism has 6 links: the frame and 5 moving links "
    )
    assert max(map(len, done.out.splitlines())) <= 100
    whole = " ".join(done.out.split())
    assert whole.endswith(
        " ".join(ct.summary(ct.principle_of_operation(ct.example("slider-between-cranks"))).split())
    )


@pytest.mark.parametrize(
    ("name", "begins"),
    [("words.txt", "Slider between"), ("words.tex", "\\documentclass"), ("words.md", "# Slider between")],
)
def test_a_description_is_written_as_a_page(centrode: Centrode, folder: Path, name: str, begins: str) -> None:
    done = centrode("describe", "slider-between-cranks", "--out", name)
    assert (done.code, done.out) == (0, f"wrote {name}\n")
    text = (folder / name).read_text(encoding="utf-8")
    assert text.startswith(begins)
    assert "its stroke is 1.279 m." in " ".join(text.split())
    done = centrode("describe", "slider-between-cranks", "--out", "words.pdf")
    assert done.code == 2 and "use one of .txt, .tex, .md" in done.err


@pytest.mark.parametrize("arguments", [("nothing",), ("press.toml",)])
def test_describe_refuses(
    centrode: Centrode, folder: Path, four_bar: str, arguments: tuple[str, ...]
) -> None:
    (folder / "press.toml").write_text(four_bar.replace("length = 3.5", "length = 35"), encoding="utf-8")
    done = centrode("describe", *arguments)
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith(f"Error: {arguments[0]}")
    assert "Traceback" not in done.err
