"""`centrode equilibrium`, `centrode modes`: what they print and write, and how results come back from files."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import centrode as ct
from centrode.dynamics.equilibria.modes import modes_results
from sprung import SPRUNG_FOUR_BAR

Centrode = Callable[..., Any]
PUSHED = """\
title = "Pushed rod"
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.OA]
length = 1
mass = 1
shape = "rod"
angle = 0
[[loads]]
name = "push"
kind = "torque"
link = "OA"
value = 1
"""


def test_equilibria_along_a_moment(centrode: Centrode, folder: Path) -> None:
    (folder / "rod.toml").write_text(PUSHED, encoding="utf-8")
    done = centrode("equilibrium", "rod.toml", "--vary", "loads.push.value=0.5 N m:6 N m", "--out", "rests")
    assert done.code == 0, done
    assert done.rows["equilibria"] == "2"
    assert "unstable" in done.rows["equilibrium 2"]
    value = done.rows["critical value"]
    assert value.startswith("4.905 N") and value.endswith("fold: an equilibrium is lost")
    names = {path.name for path in (folder / "rests").iterdir()}
    assert {
        "equilibria.csv",
        "equilibria.nc",
        "branches.csv",
        "critical-values.csv",
        "equilibrium-1.png",
    } <= names
    assert "branches-OA.png" in names
    with (folder / "rests" / "equilibria.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    found = ct.open(folder / "rests" / "equilibria.nc")
    assert [float(row["OA [rad]"]) for row in rows] == found.generalised_coordinate.values[:, 0].tolist()
    # what is read back says the same
    assert f"{done.rows['equilibrium 1']}" in ct.summary(found)


def test_modes_in_files_and_in_a_report(centrode: Centrode, folder: Path) -> None:
    # a document is of a mechanism whose drive has a law
    text = SPRUNG_FOUR_BAR.replace("start = 1.0", "start = 1.0\nspeed = 1")
    (folder / "bar.toml").write_text(text, encoding="utf-8")
    done = centrode("modes", "bar.toml", "--out", "modes", "--animate", "--no-figures", "--xlsx")
    assert done.code == 0, done
    assert done.rows["mode 1"].startswith(f"{14.0053859693733763 / math.tau:.6g} Hz, damping ratio 0.002077")
    names = {path.name for path in (folder / "modes").iterdir()}
    assert {"modes.xlsx", "modes.nc", "mode-1.gif"} <= names
    assert (folder / "modes" / "mode-1.gif").read_bytes().startswith(b"GIF89a")
    done = centrode("report", "bar.toml", "--out", "report", "--chapters", "modes", "--format", "html")
    assert done.code == 0, done
    page = next((folder / "report").glob("*.html")).read_text(encoding="utf-8")
    assert "Natural oscillations" in page and "asymptotically stable" in page


def test_a_drawn_mode_is_closed_in_every_position_and_ends_where_it_begins() -> None:

    (motion,) = modes_results(ct.parse_mechanism(SPRUNG_FOUR_BAR)).motions
    b, c = (motion["position"].sel(point=name).values for name in "BC")
    assert np.allclose(np.hypot(*(c - b).T), 0.8, atol=1e-12)
    assert np.allclose(b[0], b[-1], atol=1e-12)
    assert np.ptp(motion["angle"].sel(link="AB").values) > 0.1


def test_exit_codes_tell_what_is_wrong(centrode: Centrode, folder: Path) -> None:
    (folder / "rod.toml").write_text(PUSHED.replace("value = 1", "value = 6"), encoding="utf-8")
    done = centrode("equilibrium", "rod.toml")
    assert done.code == 3 and "no equilibrium is found" in done.err
    done = centrode("equilibrium", "rod.toml", "--vary", "loads.push.value")
    assert done.code == 2 and "no range is given" in done.err
    done = centrode("modes", "rod.toml", "--hold", "X=1")
    assert done.code == 2 and 'no drive "X"' in done.err


HELD = """\
title = "A block on a slope"
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.block]
points = { B = [0, 0] }
mass = 2
[[guides]]
point = "B"
on = "frame"
through = "O"
direction = "15 deg"
link = "block"
[[drives]]
guide = "B"
start = 0
[[loads]]
kind = "friction"
guide = "B"
coefficient = 0.3
"""
CONTROLLER = """\
[[controllers]]
name = "pull"
drive = "B"
target = 0.1
proportional = 500
derivative = 60
"""


def test_friction_alone_and_a_controller_hold_a_block(centrode: Centrode, folder: Path) -> None:
    (folder / "block.toml").write_text(HELD, encoding="utf-8")
    done = centrode("equilibrium", "block.toml", "--out", "rests")
    assert done.code == 0, done
    assert done.rows["equilibria"] == "0" and done.rows["friction holds"] == "in every position"
    # tan 15 deg over 0.3
    assert done.rows["the initial position takes"] == "89.3164 % of the friction: it stays"
    assert "in every position" in ct.summary(ct.open(folder / "rests" / "equilibria.nc"))
    assert "friction alone holds it" in centrode("modes", "block.toml").err
    (folder / "pulled.toml").write_text(HELD + CONTROLLER, encoding="utf-8")
    done = centrode("equilibrium", "pulled.toml", "--out", "pulled")
    weight = 2 * 9.81 * math.sin(math.radians(15))
    assert done.rows["pull gives"] == f"{weight:+.6g} N"
    found = ct.open(folder / "pulled" / "equilibria.nc")
    assert math.isclose(float(found.drive_value[0, 0]), 0.1 - weight / 500, rel_tol=1e-12)
    reach = 0.3 * 2 * 9.81 * math.cos(math.radians(15)) / 500
    ends = np.sort(found.friction_band.values.ravel())
    assert np.allclose(ends, [0.1 - weight / 500 - reach, 0.1 - weight / 500 + reach], rtol=1e-9)
