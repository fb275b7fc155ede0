"""`centrode cam`: contact, choice and animation, from the description to the files; what is refused."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from PIL import Image

import centrode as ct

Centrode = Callable[..., Any]

GIVEN = """\
title = "Pressed roller"
kind = "cam"
display = { length = "mm", angle = "deg" }
[curvature]
law = "exponential"
k0 = "0.02 1/mm"
k1 = 0.4
[start]
radius = "50 mm"
[range]
to = "60 deg"
[roller]
radius = "10 mm"
[contact]
force = "2 kN"
width = "20 mm"
cam = { elasticity = "206 GPa" }
roller = { elasticity = "110 GPa", poisson = 0.34 }
admissible = "700 MPa"
[choose]
minimise = "stress"
size = "55 mm"
lift = "2 mm"
[choose.parameters]
"curvature.k0" = ["12 1/m", "30 1/m"]
"curvature.k1" = [-0.5, 1.5]
"""


@pytest.fixture
def pressed(folder: Path) -> Path:
    (folder / "pressed.toml").write_text(GIVEN)
    return folder


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_what_is_printed(centrode: Centrode, pressed: Path) -> None:
    done = centrode("cam", "pressed.toml")
    assert (done.code, done.err) == (0, "")
    cam = ct.read_cam("pressed.toml")
    facts = ct.cam_contact(cam).attrs
    stress, at = 1e-6 * facts["greatest_stress"], math.degrees(facts["greatest_stress_at"])
    assert done.rows["greatest contact stress"] == f"{stress:.6g} MPa at {at:.6g} deg, admissible 700 MPa"
    assert (
        f"{1e-6 * facts['greatest_stress_by_source']:.6g} MPa by the source's formula, with 0.418" in done.out
    )
    found = ct.choose_cam(cam)
    assert done.rows["minimised"] == "contact stress"
    for name, value in found.choice.chosen.parameters.items():
        assert name in done.out
        assert f"{value / 1000:.6g} 1/mm" in done.out or f"{value:.6g} 1/rad" in done.out
    assert "none is better" in done.rows["other designs"]
    assert list(pressed.iterdir()) == [pressed / "pressed.toml"]


def test_what_is_written(centrode: Centrode, pressed: Path) -> None:
    done = centrode("cam", "pressed.toml", "--out", "made", "--samples", "7", "--no-figures")
    assert (done.code, done.err) == (0, "")
    cam = ct.read_cam("pressed.toml")
    data = ct.cam_contact(cam, 7)
    table = rows(pressed / "made" / "cam-contact.csv")
    for k, row in enumerate(table):
        assert float(row["contact_stress [Pa]"]) == float(data["contact_stress"][k])
        assert float(row["cam_curvature_radius [mm]"]) == 1e3 * float(data["cam_curvature_radius"][k])
        assert row["status"] == "ok"
    with xr.open_dataset(pressed / "made" / "cam-contact.nc", engine="scipy") as written:
        np.testing.assert_array_equal(written["contact_shear"], data["contact_shear"])
    found = ct.choose_cam(cam)
    start, chosen = rows(pressed / "made" / "cam-choice.csv")
    assert (start["design"], chosen["design"], chosen["admissible"]) == ("start", "chosen", "yes")
    assert float(start["curvature.k0 [1/mm]"]) == pytest.approx(0.02, rel=1e-15)
    assert float(chosen["stress [MPa]"]) == pytest.approx(
        1e-6 * found.choice.chosen.measures["stress"].value, rel=1e-12
    )
    summary = json.loads((pressed / "made" / "summary.json").read_text())
    assert summary["chosen.curvature.k1"] == {
        "value": found.choice.chosen.parameters["curvature.k1"],
        "unit": "1/rad",
    }
    assert summary["greatest_contact_stress"] == {"value": data.attrs["greatest_stress"], "unit": "Pa"}


def test_the_chosen_description_computes(centrode: Centrode, pressed: Path) -> None:
    """What is written keeps the bounds when it is read again, and is its own choice."""
    centrode("cam", "pressed.toml", "--out", "made", "--samples", "7", "--no-figures")
    cam = ct.read_cam(pressed / "made" / "chosen.toml")
    again = ct.choose_cam(cam)
    assert not again.choice.start.misses
    now, before = (one.measures["stress"].value for one in (again.choice.chosen, again.choice.start))
    assert now == pytest.approx(before, rel=1e-8)


@pytest.mark.drawn
def test_the_figures_of_contact_and_choice(
    centrode: Centrode, pressed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ct.choose_cam, "__defaults__", (8,))  # points of the front
    text = GIVEN.replace('minimise = "stress"', 'minimise = "stress"\ntrade_off = "size"')
    (pressed / "pressed.toml").write_text(text)
    done = centrode("cam", "pressed.toml", "--out", "made", "--samples", "7", "--dark")
    assert (done.code, done.err) == (0, "")
    names = {path.name for path in (pressed / "made").iterdir()}
    assert {"cam-contact.png", "cam-contact.svg", "cam-choice.png", "cam-choice.svg"} <= names
    designs = [row["design"] for row in rows(pressed / "made" / "cam-choice.csv")]
    assert designs[:2] == ["start", "chosen"]
    assert len(designs) > 5
    with Image.open(pressed / "made" / "cam-choice.png") as picture:
        assert max(picture.convert("RGB").getpixel((2, 2))) < 64


def test_no_design_keeps_the_bounds(centrode: Centrode, pressed: Path) -> None:
    (pressed / "pressed.toml").write_text(
        GIVEN.replace('size = "55 mm"', 'size = "55 mm"\nstress = "200 MPa"')
    )
    done = centrode("cam", "pressed.toml", "--out", "made", "--samples", "5", "--no-figures")
    assert done.code == 3
    assert "no design satisfies all bounds; the closest one violates contact stress by" in done.err
    assert "move a bound, or widen the ranges of the parameters" in done.err
    assert not (pressed / "made" / "chosen.toml").exists()
    assert [row["admissible"] for row in rows(pressed / "made" / "cam-choice.csv")] == ["no", "no"]


def test_the_wheel_walks(centrode: Centrode, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("centrode.animation.cams.FRAMES_OF_A_STEP", 5)
    text = ct.cam_text(ct.example("walking-wheel-three-legs")).partition("[choose]")[0]
    (folder / "wheel.toml").write_text(text)
    done = centrode("cam", "wheel.toml", "--out", "w", "--animate", "--no-figures", "--samples", "5")
    assert (done.code, done.err) == (0, "")
    with Image.open(folder / "w" / "walking-wheel.gif") as picture:
        assert picture.n_frames == 5


ROLLED = """
kind = "cam"
curvature = { law = "exponential", k0 = "0.01 1/mm", k1 = 0.75 }
start = { radius = "50 mm", pressure_angle = 0 }
range = { to = "60 deg" }
"""


@pytest.mark.parametrize("more", ["return = {}", ""])
def test_a_cam_turns_below_its_roller(
    centrode: Centrode, folder: Path, monkeypatch: pytest.MonkeyPatch, more: str
) -> None:
    monkeypatch.setattr("centrode.animation.cams.FRAMES_OF_A_TURN", 6)
    (folder / "cam.toml").write_text(f'roller = {{ radius = "8 mm" }}\n{more}\n{ROLLED}')
    done = centrode("cam", "cam.toml", "--out", "w", "--animate", "--no-figures", "--samples", "5", "--dark")
    assert (done.code, done.err) == (0, "")
    with Image.open(folder / "w" / "cam.gif") as picture:
        assert picture.n_frames == 6


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (
            ("cam-from-curvature", "--animate", "--out", "w"),
            "--animate: a profile needs a roller; give [roller] radius",
        ),
        (("walking-wheel-four-legs", "--animate"), "no output folder is given; name one with --out"),
    ],
)
def test_no_animation(centrode: Centrode, folder: Path, words: tuple[str, ...], told: str) -> None:
    done = centrode("cam", *words)
    assert (done.code, done.out) == (2, "")
    assert told in done.err
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('force = "2 kN"', 'force = "2 kg"', "force"),
        ('width = "20 mm"', "width = 0", "width"),
        ("poisson = 0.34", "poisson = 1", "poisson"),
        ('admissible = "700 MPa"', 'admissible = "700 mm"', "admissible"),
        (
            '"curvature.k0" = ["12 1/m", "30 1/m"]',
            '"curvature.k0" = ["-12 1/m", "30 1/m"]',
            "an end of the range",
        ),
        ('"curvature.k1" = [-0.5, 1.5]', '"curvature.points.2" = [1, 2]', "the cam has no"),
        ('minimise = "stress"', 'minimise = "weight"', "expected one of"),
        ('[roller]\nradius = "10 mm"', "", "roller"),
    ],
)
def test_wrong_descriptions(centrode: Centrode, pressed: Path, old: str, new: str, told: str) -> None:
    assert old in GIVEN
    (pressed / "pressed.toml").write_text(GIVEN.replace(old, new))
    done = centrode("cam", "pressed.toml")
    assert (done.code, done.out) == (2, "")
    assert told in done.err
    assert "Traceback" not in done.err
