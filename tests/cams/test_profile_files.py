"""Profiles as files: CSV that reads back, SVG in true size, DXF that other programs read."""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import centrode as ct
from cam_shapes import exchanged
from centrode.cams.profiles import cam_body, cam_outlines, shoe_outlines
from centrode.cams.results import cam_profile_results, walking_wheel_results
from centrode.errors import InputError
from centrode.model.settings import Display
from centrode.render import dxf_files, write_table
from centrode.render.outlines import write_outlines_dxf, write_outlines_svg

ezdxf = pytest.importorskip("ezdxf")

NAME = "{http://www.w3.org/2000/svg}"
GROOVE = '[return]\ngreatest_radius = "66 mm"\n'


@pytest.fixture(scope="module")
def cam() -> ct.Cam:
    return exchanged(more=GROOVE)


def test_csv_reads_back_bit_for_bit(cam: ct.Cam, tmp_path: Path) -> None:
    data = ct.cam_profile(cam, 91, groove=True)
    write_table(
        ct.tables(cam_profile_results(cam, 91, groove=True))["cam-profile"],
        tmp_path / "cam.csv",
        Display(),
    )
    rows = list(csv.DictReader((tmp_path / "cam.csv").read_text(encoding="utf-8").splitlines()))
    assert list(rows[0])[:4] == ["carrier_angle [rad]", "part", "roller_centre_x [m]", "roller_centre_y [m]"]
    for header, values in {
        "profile_x [m]": data["profile"].sel(axis="x"),
        "groove_y [m]": data["groove"].sel(axis="y"),
        "profile_bend [m]": data["profile_bend"],
        "cam_pressure_angle [rad]": data["cam_pressure_angle"],
    }.items():
        assert [float(row[header]) for row in rows] == values.to_numpy().tolist()
    assert {row["part"] for row in rows} == {"working", "return"}
    angles = [float(row["carrier_angle [rad]"]) for row in rows]
    assert math.pi / 4 in angles  # the joint


def test_display_units_stand_in_the_header(cam: ct.Cam, tmp_path: Path) -> None:
    write_table(ct.tables(walking_wheel_results(cam, 5))["shoe-profile"], tmp_path / "shoe.csv", cam.display)
    header = (tmp_path / "shoe.csv").read_text(encoding="utf-8").splitlines()[0]
    assert header == (
        "carrier_angle [deg],shoe_radius [mm],shoe_angle [deg],shoe_bend [mm],shoe_along [mm],"
        "shoe_upright [mm],hub_travel [mm],hub_rate [mm/rad],shoe_profile_x [mm],shoe_profile_y [mm]"
    )


def test_svg_is_in_millimetres_and_its_curves_are_the_profile(cam: ct.Cam, tmp_path: Path) -> None:
    body = cam_body(cam)
    outlines = cam_outlines(body, 360, groove=True)
    write_outlines_svg(outlines, tmp_path / "cam.svg", "Cam <4> & Кулачок")
    root = ElementTree.parse(tmp_path / "cam.svg").getroot()
    assert root.find(f"{NAME}title").text == "Cam <4> & Кулачок"  # type: ignore[union-attr]
    width, view = root.get("width"), [float(one) for one in root.get("viewBox", "").split()]
    assert width == f"{view[2]:.6f}mm"
    groups = {one.get("id"): one for one in root.iter(f"{NAME}g") if one.get("id")}
    assert list(groups) == [
        "path", "profile-working", "profile-return", "groove-working", "groove-return",
    ]  # fmt: skip
    for layer, side in (("profile-return", "inner"), ("groove-return", "outer")):
        (drawn,) = groups[layer].findall(f"{NAME}path")
        numbers = np.array([float(one) for one in re.findall(r"-?\d+\.\d+", drawn.get("d", ""))]).reshape(
            -1, 2
        )
        (piece,) = [one for one in outlines if one.layer == layer]
        start, controls = numbers[0], numbers[1:].reshape(-1, 3, 2)
        ends = np.concatenate([start[None], controls[:-1, 2]])
        middles = (
            (ends + 3 * controls[:, 0] + 3 * controls[:, 1] + controls[:, 2]) / 8 * np.array([1.0, -1.0])
        )
        phi = 0.5 * (piece.parameter[1:] + piece.parameter[:-1])
        exact = 1e3 * body.profile(phi, side).place  # type: ignore[arg-type]
        step = float(np.diff(piece.parameter).max())
        # a cubic by Hermite: h^4 / 384 of the fourth derivative, some twenty sizes here; seven digits are printed
        assert np.abs(middles - exact).max() < 20 * 90 * step**4 / 384 + 1e-7


def test_dxf_is_read_without_a_complaint_and_its_splines_are_the_profile(cam: ct.Cam, tmp_path: Path) -> None:
    body, wheel = cam_body(cam), ct.walking_wheel(cam)
    outlines = [*cam_outlines(body, 360, groove=True), *shoe_outlines(wheel.shoe, 90)]
    write_outlines_dxf(outlines, tmp_path / "cam.dxf", "Кулачок")
    document = ezdxf.readfile(tmp_path / "cam.dxf")
    audit = document.audit()
    assert not audit.has_errors and not audit.has_fixes
    assert document.units == 4 and document.header["$MEASUREMENT"] == 1
    space = document.modelspace()
    assert [one.dxf.text for one in space.query("TEXT")] == ["Кулачок"]
    for layer in ("path", "profile-working", "profile-return", "groove-working", "groove-return", "shoe"):
        pieces = [one for one in outlines if one.layer == layer]
        splines = list(space.query(f'SPLINE[layer=="{layer}"]'))
        assert len(splines) == len(pieces)
        for piece, spline in zip(pieces, splines, strict=True):
            curve = spline.construction_tool()
            phi = np.linspace(piece.parameter[0], piece.parameter[-1], 203)[1:-1]
            found = np.array([list(curve.point(one))[:2] for one in phi - piece.parameter[0]])
            exact = {
                "path": lambda at: (
                    cam_body(cam).closed.radius(at)[0][:, None] * np.stack([np.sin(at), np.cos(at)], axis=-1)
                ),
                "shoe": wheel.shoe.place,
            }.get(
                layer, lambda at, name=layer: body.profile(at, "outer" if "groove" in name else "inner").place
            )(phi)
            step = float(np.diff(piece.parameter).max())
            # a cubic spline: 5/384 h^4 of the fourth derivative, some twenty sizes here
            assert np.abs(found - 1e3 * exact).max() < 5 / 384 * step**4 * 20 * 90 + 1e-9
        lines = list(space.query(f'LWPOLYLINE[layer=="points-{layer}"]'))
        corners = np.concatenate([np.array(one.get_points("xy")) for one in lines])
        assert len(corners) >= sum(len(one.parameter) for one in pieces) - len(pieces)


def test_files_have_the_same_bytes_each_time(cam: ct.Cam, tmp_path: Path) -> None:
    before = ezdxf.options.write_fixed_meta_data_for_testing
    for name in ("one", "two"):
        outlines = cam_outlines(cam_body(cam), 90)
        write_outlines_dxf(outlines, tmp_path / f"{name}.dxf", "T")
        write_outlines_svg(outlines, tmp_path / f"{name}.svg", "T")
    for kind in ("dxf", "svg"):
        assert (tmp_path / f"one.{kind}").read_bytes() == (tmp_path / f"two.{kind}").read_bytes()
    assert ezdxf.options.write_fixed_meta_data_for_testing == before


def test_without_ezdxf_the_extra_is_named(
    cam: ct.Cam, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dxf_files, "find_spec", lambda _name: None)
    with pytest.raises(InputError, match=r'pip install -e "\.\[drawings\]"'):
        write_outlines_dxf(cam_outlines(cam_body(cam), 90), tmp_path / "cam.dxf")
    assert not list(tmp_path.iterdir())


def test_outlines_of_neighbouring_pieces_meet(cam: ct.Cam) -> None:
    outlines = [one for one in cam_outlines(cam_body(cam), 100) if one.layer.startswith("profile")]
    ends = np.array([[one.places[0], one.places[-1]] for one in outlines])
    np.testing.assert_allclose(ends[:, 1], np.roll(ends[:, 0], -1, axis=0), atol=1e-15)


@pytest.mark.parametrize("k1", [0.75, -0.1])
def test_at_corners_the_rollers_arc_joins_the_walls(k1: float) -> None:
    """Mirror images have outward corners where the path rises to its end, inward ones where it falls."""
    more = '[return]\nkind = "mirrored"\n'
    law = ('k0 = "0.01 1/mm"\nk1 = 0.75', f"k0 = 30\nk1 = {k1}" if k1 < 0 else f"k0 = 10\nk1 = {k1}")
    body = cam_body(exchanged(law, ('"15 mm"', '"5 mm"'), more=more))
    assert len(body.kinks) == 4 and (body.kinks[0].kink < 0) == (k1 > 0)
    outlines = cam_outlines(body, 180, groove=True)
    wall = "groove" if k1 > 0 else "profile"
    pieces = [one for one in outlines if one.layer.startswith(wall)]
    ends = np.array([[one.places[0], one.places[-1]] for one in pieces])
    np.testing.assert_allclose(ends[:, 1], np.roll(ends[:, 0], -1, axis=0), atol=1e-15)
    arcs = [
        one for one in pieces if np.ptp(one.parameter) == pytest.approx(abs(body.kinks[0].kink), rel=1e-9)
    ]
    assert len(arcs) == 4
    for arc, joint in zip(arcs, body.kinks, strict=True):
        corner = body.closed.radius(np.array([joint.at]))[0] * np.array(
            [math.sin(joint.at), math.cos(joint.at)]
        )
        np.testing.assert_allclose(np.hypot(*(arc.places - corner).T), 0.005, rtol=1e-12)
        tangent = arc.slopes / np.hypot(*arc.slopes.T)[:, None]
        ahead = np.gradient(arc.places, axis=0)[1:-1]
        assert np.all(np.sum(tangent[1:-1] * ahead, axis=1) > 0.99 * np.hypot(*ahead.T))


def test_a_profile_needs_a_roller() -> None:
    cam = exchanged(('[roller]\nradius = "15 mm"\n[mover]\nlegs = 4\npost = "120 mm"\n', ""))
    with pytest.raises(InputError, match=r"\[roller\]: a profile needs a roller"):
        ct.cam_profile(cam)
    with pytest.raises(InputError, match=r"\[mover\]: a walking wheel needs legs"):
        ct.walking_wheel(exchanged(('[mover]\nlegs = 4\npost = "120 mm"\n', "")))


@pytest.mark.parametrize(
    ("samples", "said"),
    [(1, "1 sample is"), (0, "0 samples are"), (-5, "-5 samples are"), (True, "True samples are")],
)
def test_a_number_of_samples_is_sensible(cam: ct.Cam, samples: int, said: str) -> None:
    with pytest.raises(InputError, match=f"{said} given"):
        ct.cam_profile(cam, samples)
