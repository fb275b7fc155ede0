"""`centrode cam` as a user meets it; cams that cannot be computed; other commands about cams."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

import centrode as ct
from centrode.model.examples import example_text
from centrode.model.schema import cam_schema, mechanism_schema

Centrode = Callable[..., Any]
PICTURES = sorted(
    f"{name}.{kind}" for name in ("cam-path", "cam-curves", "cam-routes") for kind in ("png", "svg")
)
TABLES = ["cam-path.csv", "cam-path.nc", "cam-routes.csv", "cam-routes.nc", "summary.json"]
CAM = """\
kind = "cam"
title = "Cam"
display = { length = "mm", angle = "deg" }
[curvature]
law = "exponential"
k0 = "0.01 1/mm"
k1 = 0.75
[start]
radius = "50 mm"
[range]
to = "90 deg"
"""


@pytest.fixture
def cam(folder: Path) -> Path:
    (folder / "cam.toml").write_text(CAM)
    return folder


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_the_example_is_printed(centrode: Centrode, folder: Path) -> None:
    done = centrode("cam", "cam-from-curvature")
    assert (done.code, done.err) == (0, "")
    assert done.out.startswith(
        "Path of a roller by an exponential curvature law\n\nPath of the roller's centre\n\n"
    )
    said = done.rows
    assert said["curvature law"] == "K = k0 exp(k1 φ), k0 = 0.01 1/mm, k1 = 0.75 1/rad"
    assert said["radius ρ"] == "50 mm at 0 deg to 61.0092 mm at 79.1402 deg"
    assert said["greatest pressure angle"] == "12.4091 deg at 43.0527 deg"
    assert said["stall"] == "none in the range; with this law the follower would stall at 126.01619 deg"
    assert said["closure"] == "mirrored at 90 deg the path has a kink of 18.373 deg"
    assert (
        said["(a) one series"]
        == "power series about φ = 0, truncated after a_20: greatest error of ρ 0.0576 mm"
    )
    assert "it converges up to 87.29346 deg" in done.out
    last = done.out.splitlines()[-1].split()
    assert last[:5] == ["90", "60.190", "60.132", "-0.159650", "-0.966032"]
    assert list(folder.iterdir()) == []


def test_terms_and_samples_are_those_asked_for(centrode: Centrode, cam: Path) -> None:
    done = centrode("cam", "cam.toml", "--terms", "40", "--samples", "7")
    assert done.code == 0
    assert "truncated after a_40" in done.out
    table = done.out.splitlines()[-7:]
    assert [line.split()[0] for line in table] == ["0", "15", "30", "45", "60", "75", "90"]


def test_everything_is_written(centrode: Centrode, cam: Path) -> None:
    done = centrode("cam", "cam.toml", "--out", "result", "--samples", "19")
    assert done.code == 0
    assert sorted(path.name for path in (cam / "result").iterdir()) == sorted(TABLES + PICTURES)
    assert "11 files in result:" in done.out
    found = rows(cam / "result" / "cam-path.csv")
    assert len(found) == 19
    assert float(found[-1]["carrier_angle [deg]"]) == 90.0
    assert abs(float(found[-1]["path_radius [mm]"]) - 60.132) <= 5e-4
    assert found[-1]["status"] == "ok"
    routes = rows(cam / "result" / "cam-routes.csv")
    assert abs(float(routes[-1]["path_radius_series [mm]"]) - 60.190) <= 5e-4
    assert routes[-1]["foretold_error [mm]"] == ""
    summary = json.loads((cam / "result" / "summary.json").read_text(encoding="utf-8"))
    assert summary["cam_stall"]["unit"] == "rad"
    assert summary["cam_greatest_radius"]["value"] == pytest.approx(0.0610092, rel=1e-5)
    assert set(summary) >= {"cam_radius_of_convergence", "cam_series_greatest_error", "cam_mirrored_kink"}
    with xr.open_dataset(cam / "result" / "cam-path.nc", engine="scipy") as data:
        assert ct.parse_cam(data.attrs["cam"]) == ct.read_cam(cam / "cam.toml")


@pytest.mark.drawn
def test_the_same_cam_gives_the_same_bytes_light_or_dark(centrode: Centrode, cam: Path) -> None:
    for name in ("one", "other"):
        assert centrode("cam", "cam.toml", "--out", name, "--samples", "19").code == 0
    for file in (cam / "one").iterdir():
        assert file.read_bytes() == (cam / "other" / file.name).read_bytes()
    assert centrode("cam", "cam.toml", "--out", "dark", "--dark", "--samples", "19").code == 0
    assert (cam / "dark" / "cam-path.png").read_bytes() != (cam / "one" / "cam-path.png").read_bytes()


def test_without_figures(centrode: Centrode, cam: Path) -> None:
    assert centrode("cam", "cam.toml", "--out", "plain", "--no-figures", "--samples", "5").code == 0
    assert sorted(path.name for path in (cam / "plain").iterdir()) == sorted(TABLES)


def test_a_follower_that_stalls_ends_with_3_and_is_written(centrode: Centrode, cam: Path) -> None:
    (cam / "cam.toml").write_text(CAM.replace("90 deg", "180 deg"))
    done = centrode("cam", "cam.toml", "--out", "result", "--samples", "37")
    assert done.code == 3
    assert done.err == (
        "Error: cam.toml: the follower stalls at 126.01619 deg, where the pressure angle is 90 deg;"
        " end the range before that angle\n"
    )
    assert done.rows["stall"] == "at 126.01619 deg, inside the range"
    found = rows(cam / "result" / "cam-path.csv")
    words = {round(float(row["carrier_angle [deg]"])): row["status"] for row in found}
    assert (words[125], words[130]) == ("ok", "open")
    assert found[-1]["path_radius [mm]"] == ""
    summary = json.loads((cam / "result" / "summary.json").read_text(encoding="utf-8"))
    assert summary["cam_stall"]["value"] == pytest.approx(math.radians(126.01619), rel=1e-8)


LAWS = {
    "constant": (
        '"constant"\nk0 = "0.012 1/mm"',
        "formula (16) does not apply where the curvature is constant",
    ),
    "round": ('"constant"\nk0 = "0.02 1/mm"', "the series terminates: its further coefficients vanish"),
    "linear": ('"linear"\nk0 = "0.012 1/mm"\nk1 = "0.004 1/mm/rad"', "K = k0 + k1 φ"),
    "spline": ('"spline"\npoints = [[0, 12], ["50 deg", 14], ["95 deg", 22]]', "the law has a break"),
    "formula": ('"formula"\nformula = "12+5*abs(phi-0.4)"', "the law has a break"),
    "symmetric": ('"exponential"\nk0 = 10\nk1 = 0.75\nsymmetric = true', "-90 deg to 90 deg"),
}


@pytest.mark.parametrize("name", LAWS)
def test_every_law_is_computed(centrode: Centrode, cam: Path, name: str) -> None:
    law, said = LAWS[name]
    (cam / "cam.toml").write_text(CAM.replace('"exponential"\nk0 = "0.01 1/mm"\nk1 = 0.75', law))
    done = centrode("cam", "cam.toml", "--out", "result", "--samples", "61", "--no-figures")
    assert (done.code, done.err) == (0, "")
    assert said in done.out
    assert len(rows(cam / "result" / "cam-path.csv")) == 61


def test_a_whole_turn_tells_how_it_closes(centrode: Centrode, cam: Path) -> None:
    text = CAM.replace('"exponential"\nk0 = "0.01 1/mm"\nk1 = 0.75', '"constant"\nk0 = "0.016 1/mm"')
    (cam / "cam.toml").write_text(text.replace("90 deg", "360 deg"))
    done = centrode("cam", "cam.toml", "--samples", "37")
    assert done.code == 0
    assert done.rows["closure"].startswith("after a turn ρ is ")


REFUSED = [
    (('"0.01 1/mm"', '"-0.01 1/mm"'), (), "k0 must be positive"),
    (('"0.01 1/mm"', '"0.01 mm"'), (), "expected a curvature (1/m)"),
    (
        ('"exponential"\nk0 = "0.01 1/mm"\nk1 = 0.75', '"linear"\nk0 = 10\nk1 = -9'),
        (),
        "not positive from 63.662 deg on",
    ),
    (('"90 deg"', '"4000 deg"'), (), "the range is longer than 10 turns"),
    (('radius = "50 mm"', 'radius = "50 mm"\npressure_angle = "90 deg"'), (), "must lie within 89 deg"),
    (("", ""), ("--terms", "1"), "1 term is given"),
    (("", ""), ("--terms", "5000"), "5000 terms are given"),
    (("", ""), ("--samples", "1"), "1 sample is given"),
    (("", ""), ("--samples", "100000000"), "100000000 samples are given"),
    (('kind = "cam"', 'kind = "gear"'), (), "expected one of"),
    (('kind = "cam"', "kind = cam"), (), "not TOML"),
]


@pytest.mark.parametrize(("change", "options", "said"), REFUSED, ids=[said for _c, _o, said in REFUSED])
def test_what_is_wrong_ends_with_2(
    centrode: Centrode, cam: Path, change: tuple[str, str], options: tuple[str, ...], said: str
) -> None:
    text = CAM.replace(*change) if change[0] else CAM
    (cam / "cam.toml").write_text(text)
    done = centrode("cam", "cam.toml", "--out", "result", *options)
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith("Error: cam.toml")
    assert said in done.err
    assert "Traceback" not in done.err
    assert not (cam / "result").exists()


@pytest.mark.parametrize("options", [("--terms", "x"), ("--terms",), ("--turns", "3"), ()])
def test_usage_errors(centrode: Centrode, folder: Path, options: tuple[str, ...]) -> None:
    done = centrode("cam", *(("cam-from-curvature", *options) if options else ()))
    assert (done.code, done.out) == (2, "")


def test_cams_and_linkages_are_not_mixed_up(centrode: Centrode, folder: Path) -> None:
    for command in ("run", "check", "flywheel", "describe", "limits"):
        done = centrode(command, "cam-from-curvature")
        assert (done.code, done.out) == (2, "")
        assert "this describes a cam, not a linkage; compute it with: centrode cam" in done.err
    done = centrode("cam", "crank-rocker")
    assert done.code == 2
    assert "this describes a linkage, not a cam; compute it with: centrode run" in done.err
    assert centrode("cam", "no-such-cam").code == 2


def test_the_schema_of_cams(centrode: Centrode, folder: Path) -> None:
    assert json.loads(centrode("schema", "--cam").out) == cam_schema()
    assert json.loads(centrode("schema").out) == mechanism_schema()


def test_cams_are_listed_and_printed(centrode: Centrode, folder: Path) -> None:
    listed = centrode("examples")
    assert "cam-from-curvature" in listed.out
    assert "centrode cam NAME" in listed.out
    assert centrode("examples", "cam-from-curvature").out == example_text("cam-from-curvature")
    assert centrode("examples", "cam-from-curvature", "--out", "mine.toml").code == 0
    assert centrode("cam", "mine.toml", "--samples", "3").code == 0
