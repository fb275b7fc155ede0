"""Outlines under followers, and cams that a tool circle cuts from the exported points."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.cams.followers.geometry import (
    Face,
    FollowerCam,
    Oscillating,
    Point,
    Translating,
    oscillating_face,
    oscillating_follower,
    translating_follower,
)
from centrode.cams.followers.manufacture import cam_points, follower_outlines, join_outlines
from centrode.errors import InputError
from centrode.laws.segments import LawSegment, SegmentedLaw
from centrode.model.examples.catalogue import load_cam
from centrode.render.outlines import write_outlines_dxf, write_outlines_svg
from follower_motions import Array, Lift, lift_of, rise_dwell_fall_dwell

EPS = float(np.finfo(float).eps)
TURN = math.tau
MOTION, SWING = rise_dwell_fall_dwell(0.02, "3-4-5"), rise_dwell_fall_dwell(0.2)
R = 0.008


def cams() -> dict[str, FollowerCam]:
    return {
        "knife": FollowerCam(MOTION, translating_follower(0.04, 0.005), Point(0.0), 0.04),
        "roller": FollowerCam(MOTION, translating_follower(0.04 + R, -0.004), Point(R), 0.04, -1.0),
        "arm": FollowerCam(SWING, oscillating_follower(0.04 + R, 0.06, 0.07), Point(R), 0.04),
        "face": FollowerCam(MOTION, Translating(0.04), Face(), 0.04),
        "turning face": FollowerCam(
            rise_dwell_fall_dwell(0.08), oscillating_face(0.04, 0.11, 0.003), Face(), 0.04, -1.0
        ),
    }


def left_by(centres: Array, tool: float, between: int = 24) -> Array:
    """Points of the cam that a tool leaves whose centre goes straight from one of these to the next, clockwise."""
    ways = np.diff(centres, axis=0)
    lengths = np.hypot(*ways.T)
    ways, starts, lengths = (one[lengths > 1e-12] for one in (ways, centres[:-1], lengths))
    ahead = ways / lengths[:, None]
    inwards = np.stack([ahead[:, 1], -ahead[:, 0]], axis=-1)
    shares = (np.arange(between) + 0.5) / between
    left = starts[:, None] + shares[:, None] * ways[:, None] + tool * inwards[:, None]
    kept = np.ones(left.shape[:2], dtype=bool)
    for step in (-3, -2, -1, 1, 2, 3):  # what the tool takes on the neighbouring ways
        start, along, long = (np.roll(one, step, axis=0)[:, None] for one in (starts, ahead, lengths))
        foot = np.clip(np.sum((left - start) * along, axis=2), 0.0, long)
        kept &= np.hypot(*(left - start - foot[:, :, None] * along).transpose(2, 0, 1)) >= tool * (1 - 1e-12)
    return np.asarray(left[kept])


def lift_on(cam: FollowerCam, points: Array, phi: float) -> float:
    """The lift of a follower that rests on points of a cam, in the frame."""
    x, y = cam.in_frame(points, np.array(phi)).T
    guide, r = cam.guide, cam.touch.roller
    if isinstance(guide, Translating):
        if isinstance(cam.touch, Face):
            return float(y.max()) - guide.start
        near = np.abs(x - guide.offset) < r
        return float((y[near] + np.sqrt(r**2 - (x[near] - guide.offset) ** 2)).max()) - guide.start
    away, angle = np.hypot(x - guide.distance, y), np.arctan2(y, guide.distance - x)
    if isinstance(cam.touch, Face):
        far = away > guide.face_offset
        return float((angle[far] + np.arcsin(guide.face_offset / away[far])).max()) - guide.start
    near = np.abs(away - guide.arm) < r
    cosine = (guide.arm**2 + away[near] ** 2 - r**2) / (2 * guide.arm * away[near])
    return float((angle[near] + np.arccos(cosine)).max()) - guide.start


@pytest.mark.parametrize("tolerance", [1e-5, 1e-6])
@pytest.mark.parametrize("tool", [0.004, R, 0.02])
@pytest.mark.parametrize("name", ["roller", "arm", "face", "turning face"])
def test_a_cam_cut_from_the_points_by_a_tool_reproduces_the_lift(
    name: str, tool: float, tolerance: float
) -> None:
    cam = cams()[name]
    centres = join_outlines(follower_outlines(cam, tolerance, tool), "cutter")
    points = left_by(centres[:: int(cam.sense)], tool)
    phi = np.linspace(0.01, TURN - 0.01, 61)
    found, contact = np.array([lift_on(cam, points, one) for one in phi]), cam.contact(phi)
    reach = 1.0
    if isinstance(cam.guide, Oscillating):
        reach = cam.guide.arm or float(contact.along.min())
    # along the normal a chord takes away the tolerance at most; the points of a way are a twenty-fourth of it apart
    most = 1.06 * tolerance / np.cos(contact.pressure_angle).min() / reach
    missing = contact.lift - found
    assert missing.max() < most and missing.min() > -0.06 * most
    if tolerance == 1e-5 and tool == R:
        assert missing.max() > 0.05 * most  # the tolerance is used


@pytest.mark.parametrize("name", cams())
def test_chords_keep_their_tolerance(name: str) -> None:
    cam, tolerance = cams()[name], 2e-6
    for layer in ("profile", "path", "cutter"):
        worst = 0.0
        for one in follower_outlines(cam, tolerance, 0.01):
            if one.layer != layer:
                continue
            middle = np.linspace(one.parameter[:-1], one.parameter[1:], 9)[1:-1].ravel()
            contact = cam.contact(middle)
            away = {"profile": 0.0, "path": cam.touch.roller, "cutter": 0.01}[layer]
            exact = (contact.place + away * contact.normal).reshape(7, -1, 2)
            ways = np.diff(one.places, axis=0)
            long = np.hypot(*ways.T)
            there = long > 1e-12
            across = (exact - one.places[:-1])[:, there]
            off = np.abs(across[..., 0] * ways[there, 1] - across[..., 1] * ways[there, 0]) / long[there]
            worst = max(worst, float(off.max()))
        assert worst <= tolerance
        if layer == "profile":
            assert worst > 0.1 * tolerance


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("contact", ["roller", "flat", "knife"])
def test_pieces_meet_also_at_corners(contact: str, sense: float) -> None:
    """A uniform rise begins with a hollow corner (a step of a flat face) and ends with an outward one."""
    motion = lift_of(
        (90, 0.01, "uniform"), (90, 0.01, "cycloidal"), (90, 0.0, "cycloidal"), (90, None, "dwell")
    )
    motion = lift_of((90, 0.01, "uniform"), (90, 0.0, "harmonic"), (180, None, "dwell"))
    touch = {"roller": Point(0.01), "flat": Face(), "knife": Point(0.0)}[contact]
    guide = Translating(0.04) if contact == "flat" else translating_follower(0.04 + touch.roller)
    cam = FollowerCam(motion, guide, touch, 0.04, sense)
    tool = 0.006 if contact != "knife" else None
    for layer in ("profile", "cutter") if tool else ("profile",):
        pieces = [one for one in follower_outlines(cam, 1e-6, tool) if one.layer == layer]
        ends = np.array([[one.places[0], one.places[-1]] for one in pieces])
        gaps = np.hypot(*(ends[:, 0] - np.roll(ends[:, 1], 1, axis=0)).T)
        sharp = math.pi / 2  # the outward corner at 90 deg: sides of an undercut profile cross there
        for gap, one in zip(gaps, pieces, strict=True):
            crossing = contact != "knife" and abs(one.parameter[0] - sharp) < 1e-9
            assert (gap > 1e-4) if crossing and layer == "profile" else gap < 1e-12 or crossing
        for one in pieces:  # slopes are those of the points
            ahead = np.gradient(one.places, one.parameter, axis=0)[2:-2]
            room = 0.02 * np.abs(one.slopes).max()
            np.testing.assert_allclose(one.slopes[2:-2], ahead, atol=room)


def test_a_knife_edge_leaves_corners() -> None:
    """About an outward corner of the profile the cutter rolls; into a sharp inner one none comes."""
    motion = lift_of((90, 0.01, "cycloidal"), (90, 0.0, "uniform"), (180, None, "dwell"))
    cam = FollowerCam(motion, translating_follower(0.04), Point(0.0), 0.04)
    with pytest.raises(InputError, match="no cutter fits into a sharp inner corner"):
        follower_outlines(cam, 1e-6, 0.01)
    fall = SegmentedLaw(
        (
            LawSegment(math.pi / 2, 0.01, "uniform"),
            LawSegment(3 * math.pi / 2, 0.0, "polynomial", (-0.01,), (0.02 / math.pi,)),
        )
    )
    cam = FollowerCam(Lift(fall), translating_follower(0.04), Point(0.0), 0.04)
    (corner,) = cam.corners
    pieces = [one for one in follower_outlines(cam, 1e-6, 0.01) if one.layer == "cutter"]
    (arc,) = [one for one in pieces if np.ptp(one.parameter) == pytest.approx(corner.turn, rel=1e-12)]
    place = cam.contact(np.array([math.pi / 2])).place
    np.testing.assert_allclose(np.hypot(*(arc.places - place).T), 0.01, rtol=1e-12)
    ends = np.array([[one.places[0], one.places[-1]] for one in pieces])
    np.testing.assert_allclose(ends[:, 1], np.roll(ends[:, 0], -1, axis=0), atol=1e-12)


def test_a_cutter_larger_than_a_hollow_is_refused_with_the_greatest() -> None:
    cam = FollowerCam(rise_dwell_fall_dwell(0.03), translating_follower(0.02 + 0.004), Point(0.004), 0.02)
    most, _at = cam.greatest_cutter
    assert 0.004 < most < math.inf
    follower_outlines(cam, 1e-5, most * (1 - 1e-9))
    with pytest.raises(
        InputError, match=r"\[tool\] radius: a cutter of .* cuts away the hollow at .* choose one"
    ):
        follower_outlines(cam, 1e-5, most * (1 + 1e-9))
    phi = np.linspace(0, TURN, 100_001)
    found = cam.contact(phi)
    hollow = -found.bend[found.bend < 0]
    assert hollow.min() == pytest.approx(most, rel=1e-6)


def test_too_many_points_are_refused() -> None:
    with pytest.raises(InputError, match=r"chord_tolerance: .* requires \d+ points"):
        follower_outlines(cams()["roller"], 1e-15)


def test_files_of_outlines(tmp_path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    outlines = follower_outlines(cams()["arm"], 1e-6, 0.01)
    write_outlines_dxf(outlines, tmp_path / "cam.dxf", "Cam")
    write_outlines_svg(outlines, tmp_path / "cam.svg", "Cam")
    document = ezdxf.readfile(tmp_path / "cam.dxf")
    audit = document.audit()
    assert not audit.has_errors and not audit.has_fixes
    space = document.modelspace()
    for layer in ("profile", "path", "cutter"):
        (line,) = space.query(f'LWPOLYLINE[layer=="points-{layer}"]')
        np.testing.assert_allclose(
            np.array(line.get_points("xy")),
            1e3 * join_outlines(outlines, layer),
            atol=1e-9,  # type: ignore[arg-type]
        )
        assert len(space.query(f'SPLINE[layer=="{layer}"]')) == len(cams()["arm"].edges) - 1
    text = (tmp_path / "cam.svg").read_text(encoding="utf-8")
    assert 'id="cutter"' in text and 'id="profile"' in text


def test_points_of_a_description_have_normals_square_to_their_way() -> None:
    cam = load_cam("indexing-cam")
    points = cam_points(cam)
    here = points["curve"].to_numpy() == "path"
    place, normal = points["curve_point"].to_numpy()[here], points["curve_normal"].to_numpy()[here]
    np.testing.assert_allclose(np.hypot(*normal.T), 1.0, rtol=4 * EPS)
    ways = np.diff(place, axis=0)
    # a chord leaves the tangent by half of what the normal turns along it
    turned = np.hypot(*np.diff(normal, axis=0).T)
    lean = np.abs(np.sum(ways * normal[:-1], axis=1)) / np.hypot(*ways.T)
    assert np.all(lean < turned + 1e-9)
    assert np.all(np.sum(place * normal, axis=1) > 0.0)  # out of the cam
    with pytest.raises(InputError, match="a groove is made for a cam that is given by its roller's path"):
        ct.cam_profile(cam, groove=True)
