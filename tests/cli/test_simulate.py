"""`centrode simulate`: what it prints and writes, and how it ends."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

import centrode as ct
from simulated import CRANK_ROCKER, ROTOR

Centrode = Callable[..., Any]
DISC = ROTOR.replace("LOADS", "").replace("SENSE", "1")


def test_the_run_up(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "simulate",
        "six-bar-press-run-up",
        "--duration",
        "6 s",
        "--samples",
        31,
        "--out",
        "result",
        "--no-figures",
    )
    assert done.code == 0, done
    assert done.err == ""
    assert done.rows["driven by"] == "16200*(1 - v/7.911) N·m"
    assert done.rows["ended"] == "after 6 s"
    assert done.rows["mean driving moment"] == "-2263.03 N·m"
    assert sorted(path.name for path in (folder / "result").iterdir()) == ["simulation.csv", "simulation.nc"]
    press = ct.example("six-bar-press-run-up")
    assert press.simulation is not None
    settings = press.simulation.model_copy(update={"duration": 6.0, "samples": 31})
    expected = ct.simulate(press, settings)
    with (folder / "result" / "simulation.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["kinetic_energy [J]"]) for row in rows] == expected.kinetic_energy.values.tolist()
    with xr.open_dataset(folder / "result" / "simulation.nc", engine="scipy") as read:
        assert read.drive_speed.values.tolist() == expected.drive_speed.values.tolist()
        assert read.attrs["ended"] == "duration"


def test_everything_on_the_command_line(centrode: Centrode, folder: Path) -> None:
    (folder / "disc.toml").write_text(DISC, encoding="utf-8")
    done = centrode(
        "simulate", "disc.toml", "--driving", "3 - v", "--speed", "10 rpm", "--turns", 5, "--scheme", "stiff"
    )
    assert done.code == 0, done
    assert done.rows["ended"].startswith("after the given number of turns")
    assert done.rows["turned"].endswith("5 turns")
    assert done.rows["least speed"].startswith("3 rad/s")
    done = centrode(
        "simulate", "disc.toml", "--driving", "3", "--duration", 1, "--scheme", "runge-kutta-4", "--steps", 50,
        "--motion", "--out", "there", "--no-figures",
    )  # fmt: skip
    assert done.code == 0, done
    assert done.rows["speed of the drive"] == "0 to 6 rad/s, 6 rad/s at the end"
    header = (folder / "there" / "simulation.csv").read_text(encoding="utf-8").partition("\n")[0]
    assert "velocity_A_x [m/s]" in header


def test_it_says_where_it_stops(centrode: Centrode, folder: Path) -> None:
    text = CRANK_ROCKER.replace("CRANK", "1").replace("LOADS", "")
    (folder / "locks.toml").write_text(text, encoding="utf-8")
    done = centrode("simulate", "locks.toml", "--driving", "200", "--duration", "20 s")
    assert done.code == 3
    assert "stops at a limit after" in done.err
    assert "limit" in done.rows


def test_a_regime_that_is_not_there_is_told(centrode: Centrode, folder: Path) -> None:
    (folder / "disc.toml").write_text(DISC, encoding="utf-8")
    done = centrode("simulate", "disc.toml", "--driving", "3", "--duration", "5 s")
    assert done.code == 0, done
    assert done.rows["steady regime"].startswith("none found: the speed does not settle")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["disc.toml"], "[simulation]: it is missing"),
        (["disc.toml", "--driving", "3*w", "--duration", "1 s"], 'unknown name "w"'),
        (["disc.toml", "--driving", "3"], "the duration is not given"),
        (["disc.toml", "--driving", "3", "--duration", "1 m"], "duration"),
        (["disc.toml", "--driving", "3", "--duration", "-1 s"], "must be positive"),
        (["disc.toml", "--driving", "3", "--duration", "1", "--samples", "1"], "samples"),
        (["disc.toml", "--driving", "3", "--turns", "0"], "turns"),
        (["disc.toml", "--driving", "3", "--turns", "1", "--scheme", "runge-kutta-4"], "fixed steps"),
        (["disc.toml", "--driving", "3", "--duration", "1", "--steps", "0"], "steps"),
        (
            ["disc.toml", "--driving", "3", "--duration", "1", "--steps", "9"],
            "chooses its steps by the tolerance",
        ),
        (
            ["disc.toml", "--driving", "3", "--duration", "1", "--tolerance", "-1"],
            "must be positive, got -1\n",
        ),
        (
            ["disc.toml", "--duration", "1", "--scheme", "runge-kutta-4", "--tolerance", "1e-6"],
            "fixed steps have no tolerance",
        ),
        (["disc.toml", "--driving", "3", "--duration", "1", "--scheme", "euler"], "euler"),
        (["crank-rocker", "--driving", "3", "--duration", "1"], "neither masses nor loads"),
        (["two-link-arm", "--driving", "3", "--duration", "1"], "neither masses nor loads"),
        (["double-pendulum", "--equations", "reduced"], "one drive"),
        (["absent.toml", "--driving", "3", "--duration", "1"], "absent.toml"),
        (["disc.toml", "--driving", "3", "--duration", "1", "--out", "disc.toml"], "not a folder"),
    ],
)
def test_wrong_input(centrode: Centrode, folder: Path, arguments: list[str], said: str) -> None:
    (folder / "disc.toml").write_text(DISC, encoding="utf-8")
    done = centrode("simulate", *arguments)
    assert done.code == 2, done
    assert said in done.err
    assert "Traceback" not in done.err
    assert [path.name for path in folder.iterdir()] == ["disc.toml"]


@pytest.mark.parametrize("gravity", ["", "gravity = [0, -9.81]\n"])
@pytest.mark.parametrize("steps", [[], ["--scheme", "runge-kutta-4"]])
def test_a_conservative_machine_has_no_steady_regime(
    centrode: Centrode, folder: Path, gravity: str, steps: list[str]
) -> None:
    """Any speed comes back: 8 rad/s as well as 9 rad/s, so there is none that it runs up to."""
    text = (
        CRANK_ROCKER.replace("CRANK", "3.0").replace("LOADS", "").replace("gravity = [0, -9.81]\n", gravity)
    )
    (folder / "free.toml").write_text(text, encoding="utf-8")
    for speed in ("8", "9"):
        done = centrode("simulate", "free.toml", "--speed", speed, "--duration", "4 s", *steps)
        assert done.code == 0, done
        assert "steady regime" not in done.out
        assert done.rows["periodic motion"].startswith("1 turn of the drive, ")
        assert done.rows["stability"] == "every speed repeats after a period: there is no limit cycle"


def test_long_ones_are_announced(centrode: Centrode, folder: Path) -> None:
    (folder / "disc.toml").write_text(DISC, encoding="utf-8")
    done = centrode("simulate", "disc.toml", "--speed", "300 turn/s", "--duration", "1 s", "--driving", "0")
    assert done.code == 0, done
    assert done.err.startswith("about 300 turns of the drive at the initial speed")


def test_a_kept_assembly_ends_at_the_change_point(centrode: Centrode, folder: Path) -> None:
    text = ct.mechanism_text(ct.example("parallelogram")).replace("[links.OA]", "[links.OA]\ninertia = 1")
    start = text.index("[assembly]") if "[assembly]" in text else None
    kept = 'continuation = "keep"'
    text = (
        text + f"\n[assembly]\n{kept}\n"
        if start is None
        else text.replace("[assembly]", f"[assembly]\n{kept}")
    )
    (folder / "kept.toml").write_text(text, encoding="utf-8")
    done = centrode("simulate", "kept.toml", "--speed", "1", "--driving", "0", "--duration", "9 s")
    assert done.code == 3, done
    assert "the motion reaches the change point at 3.14159265 rad after " in done.err
    assert "change point" in done.rows


def test_many_samples_are_announced(centrode: Centrode) -> None:
    """More than fit into memory: announced, refused, and nothing computed."""
    done = centrode("angles", "six-bar-press", "--samples", 900_000)
    assert done.code == 2, done
    assert done.err.startswith("900000 samples: this may take ")
    assert "positions would take" in done.err
