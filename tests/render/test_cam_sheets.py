"""The sheet of a cam: what is measured on its DXF, times the scales that it prints, is what formulas give."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from matplotlib.figure import Figure

import centrode as ct
from centrode.cams.followers.closed_forms import ClosedForms
from centrode.locale import speaking
from centrode.render.drafting.scales import read_scale
from centrode.render.drafting.sheets import drawing_figures, write_drawing_set
from centrode.report.drawing_sheets import drawing_sheets
from centrode.scenes.driving_cams import driving_cams
from sheet_fields import EXACT, boxes_of_texts, check_fields

Array = np.ndarray
PRINTED = re.compile(r"\\mu_\{(.+?)\}\$ = ([\d.]+)")
OFFSET, ROLLER, RISE = 8.0, 10.0, 30.0
FOLLOWERS = {
    "offset roller": 'kind = "translating"\nroller_radius = "10 mm"\noffset = "8 mm"',
    "roller, clockwise": 'kind = "translating"\nroller_radius = "10 mm"\noffset = "-8 mm"',
    "knife edge": 'kind = "translating"\ncontact = "knife"',
    "oscillating roller": 'kind = "oscillating"\nroller_radius = "8 mm"\narm = "80 mm"\npivot_distance = "95 mm"',
    "oscillating edge, clockwise": 'kind = "oscillating"\ncontact = "knife"\narm = "80 mm"\npivot_distance = "95 mm"',
    "flat": 'kind = "translating"\ncontact = "flat"\noffset = "3 mm"',
    "oscillating face": 'kind = "oscillating"\ncontact = "flat"\npivot_distance = "90 mm"\nface_offset = "5 mm"',
}


def described(name: str) -> Any:
    """A cam with a follower of a kind, its lift cycloidal."""
    follower = FOLLOWERS[name]
    lift = "12 deg" if "oscillating" in name else f"{RISE} mm"
    bounds = 'pressure_angle = "30 deg"\nreturn_pressure_angle = "45 deg"'
    if "flat" in follower:
        bounds = 'curvature_radius = "6 mm"'
    turn = "clockwise" if "clockwise" in name else "counter-clockwise"
    return ct.parse_cam(f"""
kind = "cam"
title = "A cam"
display = {{ length = "mm", angle = "deg" }}
[cam]
turn = "{turn}"
[follower]
{follower}
[[segments]]
angle = "120 deg"
to = "{lift}"
curve = "cycloidal"
[[segments]]
angle = "40 deg"
curve = "dwell"
[[segments]]
angle = "110 deg"
to = 0
curve = "cycloidal"
[[segments]]
angle = "90 deg"
curve = "dwell"
[bounds]
{bounds}
""")


@dataclass
class Drawn:
    """A sheet as its figure and as DXF, with the scales that are printed on it."""

    cam: Any
    figure: Figure
    document: Any

    @property
    def scales(self) -> dict[str, list[float]]:
        """What a millimetre stands for, by its index, from above and from the left."""
        found: dict[str, list[float]] = {}
        texts = [(text, box) for layer, text, box in boxes_of_texts(self.figure) if not layer]
        for text, _box in sorted(texts, key=lambda one: (one[1][0, 0] > 380.0, -one[1][0, 1])):
            for index, value in PRINTED.findall(text):
                found.setdefault(index, []).append(float(value))
        return found

    def lines(self, layer: str) -> list[Array]:
        found = self.document.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
        return [np.array([point[:2] for point in line.get_points()]) for line in found]

    def curves(self) -> list[Array]:
        """Curves over the angle of the cam, from above."""
        found = [line for line in self.lines("main") if len(line) > 300 and line[:, 0].max() < 382.0]
        return sorted(found, key=lambda line: -line[0, 1])

    def profile(self) -> Array:
        found = [line for line in self.lines("main") if len(line) > 300 and line[:, 0].min() > 382.0]
        return max(found, key=lambda line: line[:, 1].mean())

    def rings(self) -> list[tuple[Array, float]]:
        """Centres and radii of circles."""
        found = self.document.modelspace().query("CIRCLE")
        return [(np.array([*one.dxf.center][:2]), one.dxf.radius) for one in found]


def drawn(cam: Any, folder: Path) -> Drawn:
    made = drawing_sheets(cam)
    write_drawing_set(made, folder, ["dxf"])
    (figure,) = drawing_figures(made)
    document = ezdxf.readfile(folder / "sheet-1.dxf")
    assert not document.audit().errors
    return Drawn(cam, figure, document)


@pytest.fixture(scope="module")
def valve(tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    return drawn(ct.example("valve-cam"), tmp_path_factory.mktemp("valve"))


@pytest.fixture(scope="module", params=list(FOLLOWERS))
def one(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    return drawn(described(request.param), tmp_path_factory.mktemp("cam"))


def polynomial(u: Array, order: int) -> Array:
    """The 3-4-5 rise of unit height, or a derivative by its share of the angle."""
    return np.asarray(
        np.polynomial.Polynomial([0, 0, 0, 10, -15, 6]).deriv(order)(u)
        if order
        else np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])(u)
    )


def test_diagrams_are_the_lift_and_its_derivatives(valve: Drawn) -> None:
    """A 3-4-5 rise of 8 mm over 75 degrees and its mirror image, each diagram at its own printed scale."""
    beta, height = math.radians(75.0), 8e-3
    across = valve.scales["\\varphi"][0]
    assert valve.scales["\\varphi"] == [across] * 3
    origins = [curve[0, 0] for curve in valve.curves()]
    assert len(origins) == 3 and np.ptp(origins) <= EXACT  # on a common axis
    for order, (curve, letter) in enumerate(zip(valve.curves(), ("s", "s′", "s″"), strict=True)):
        per = valve.scales[letter][0]
        phi, values = ((curve - curve[0]) * [across, per]).T
        u = phi / beta
        expected = polynomial(u, order) * (u <= 1.0)
        expected += np.where((u > 1.0) & (u <= 2.0), (-1.0) ** order * polynomial(2.0 - u, order), 0.0)
        np.testing.assert_allclose(values, height / beta**order * expected, atol=1e-9 * height)
        assert phi[-1] == pytest.approx(math.tau, rel=1e-12)


def test_numbered_positions_divide_rise_and_return(valve: Drawn) -> None:
    texts = {text for layer, text, _box in boxes_of_texts(valve.figure) if not layer}
    assert {str(number) for number in range(14)} <= texts
    curve, per = valve.curves()[0], valve.scales["\\varphi"][0]
    places = (curve[:, 0] - curve[0, 0]) * per
    for number in range(13):  # six equal parts of 75 degrees, twice
        assert np.abs(places - number * math.radians(12.5)).min() <= 1e-9


def test_the_profile_has_the_support_of_a_flat_face(valve: Drawn) -> None:
    """A face at the height r0 + s touches and does not cut: the profile's extent along its normal is r0 + s."""
    per = valve.scales["l"][0]
    centre, radius = next((place, size) for place, size in valve.rings() if abs(size * per - 0.024) < 1e-12)
    assert radius * per == pytest.approx(0.024, rel=1e-12)
    places = (valve.profile() - centre) * per
    for number in range(13):
        phi = number * math.radians(12.5)
        lift = 8e-3 * float(polynomial(np.array(min(number, 12 - number) / 6.0), 0))
        normal = np.array([math.sin(phi), math.cos(phi)])
        assert float((places @ normal).max()) == pytest.approx(0.024 + lift, abs=1e-12)


def test_the_tangent_at_45_degrees_leaves_the_least_radius_of_curvature(valve: Drawn) -> None:
    """min(s + s″) is a root of a polynomial; from the cut of the tangent to the centre of the cam is rho."""
    beta, height = math.radians(75.0), 8e-3
    rise = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])
    total = height * rise + height / beta**2 * rise.deriv(2)
    turns = [
        float(np.real(root)) for root in total.deriv().roots() if abs(root.imag) < 1e-9 and 0 < root.real < 1
    ]
    least = 0.024 + min(float(total(turn)) for turn in turns)
    per = valve.scales["l"][1]
    low = [line for line in valve.lines("thin") if line[:, 0].min() > 382.0 and line[:, 1].max() < 230.0]
    upright = [
        abs(float(np.diff(line[:, 1])[0])) for line in low if len(line) == 2 and np.ptp(line[:, 0]) <= EXACT
    ]
    assert min(abs(length * per - least) for length in upright) <= 1e-12
    assert min(abs(length * per - 0.024) for length in upright) <= 1e-12
    sloping = [np.diff(line, axis=0)[0] for line in low if len(line) == 2]
    assert any(abs(step[0] + step[1]) <= EXACT < abs(step[0]) for step in sloping)
    assert f"{1e3 * least:.5g} mm" in " ".join(text for _l, text, _b in boxes_of_texts(valve.figure))


def test_the_profile_is_that_of_closed_forms(one: Drawn) -> None:
    body = ct.follower_cam(one.cam)
    per = one.scales["l"][0]
    centre = min(one.rings(), key=lambda ring: abs(ring[1] * per - body.base_radius))[0]
    places = (one.profile() - centre) * per
    phi = np.radians([0, 20, 60, 100, 120, 160, 160 + 110 / 6, 215, 270])
    forms, rows = ClosedForms(body), body.motion.lift(phi, 3)
    for place in forms.place(phi, rows):
        assert np.hypot(*(places - place).T).min() <= 1e-9 * body.base_radius
    assert np.hypot(*places.T).min() == pytest.approx(body.base_radius, rel=1e-9)


def test_rollers_touch_the_profile_from_outside(one: Drawn) -> None:
    radius = one.cam.follower.roller_radius
    if radius is None:
        return
    per = one.scales["l"][0]
    rollers = [centre for centre, size in one.rings() if abs(size * per - radius) <= 1e-12]
    assert len(rollers) >= 13
    for centre in rollers:
        apart = np.hypot(*(one.profile() - centre).T).min() * per
        assert apart == pytest.approx(radius, rel=1e-9)


def test_the_diagram_of_velocities_gives_the_pressure_angle(one: Drawn) -> None:
    """From the cam's centre the end of each velocity is seen at the pressure angle that the closed form has."""
    if one.cam.follower.contact == "flat":
        return
    body, per = ct.follower_cam(one.cam), one.scales["l"][1]
    low = [ring for ring in one.rings() if ring[0][1] < 220.0 and ring[1] > 1.0]
    curve = min(
        (line for line in one.lines("main") if len(line) > 300 and line[:, 0].min() > 382.0),
        key=lambda line: line[:, 1].mean(),
    )
    swings = one.cam.follower.kind == "oscillating"
    # the curve begins at lift 0 and no velocity, where the roller's centre stands
    start = (
        np.array([body.guide.offset, body.guide.start])
        if not swings
        else np.array(
            [
                body.guide.distance - body.guide.arm * math.cos(body.guide.start),
                body.guide.arm * math.sin(body.guide.start),
            ]
        )
    )
    centre = curve[0] - start / per
    assert min(math.dist(centre, place) for place, _size in low) <= 1e-6  # a hinge stands there
    phi = np.radians([20.0, 60.0, 100.0, 160.0 + 110.0 / 6.0, 215.0])
    rows = body.motion.lift(phi, 3)
    tangents = ClosedForms(body).pressure(rows)
    seen = (curve - centre) * per
    for tangent, row in zip(tangents, rows.T, strict=True):
        up = np.array([0.0, 1.0])
        if swings:
            up = np.array([math.sin(body.guide.start + row[0]), math.cos(body.guide.start + row[0])])
        size = row[1] * (body.guide.arm if swings else 1.0)
        at = (
            start + np.array([0.0, row[0]])
            if not swings
            else np.array(
                [
                    body.guide.distance - body.guide.arm * math.cos(body.guide.start + row[0]),
                    body.guide.arm * math.sin(body.guide.start + row[0]),
                ]
            )
        )
        end = at + body.sense * size * np.array([-up[1], up[0]])
        found = seen[np.hypot(*(seen - end).T).argmin()]
        assert np.hypot(*(found - end)) <= 1e-9
        across = float(found @ np.array([up[1], -up[0]]))
        assert -body.sense * across / float(found @ up) == pytest.approx(tangent, abs=1e-7)


def test_tangents_at_the_admissible_angle_meet_the_centre(tmp_path: Path) -> None:
    """The pressure angle decides the radius of a knife edge: one of both tangents goes through the centre."""
    sheet = drawn(described("knife edge"), tmp_path)
    per = sheet.scales["l"][1]
    body = ct.follower_cam(sheet.cam)
    thin = [line for line in sheet.lines("thin") if len(line) == 2 and line[:, 1].max() < 230.0]
    steps = [(line, np.diff(line, axis=0)[0]) for line in thin if line[:, 0].min() > 382.0]
    for angle in (30.0, 45.0):
        assert any(
            abs(abs(step[0]) - math.tan(math.radians(angle)) * abs(step[1])) <= EXACT < abs(step[0])
            for _line, step in steps
        ), angle
    low = [ring for ring in sheet.rings() if ring[0][1] < 220.0 and ring[1] > 1.0]
    away = []
    for centre, _size in low:
        for line, step in steps:
            normal = np.array([-step[1], step[0]]) / np.hypot(*step)
            if step[1] < 0.0 and abs(step[0]) > EXACT:
                away.append(abs(float((centre - line[0]) @ normal)) * per)
    assert min(away) <= 1e-9 * body.base_radius


def test_nothing_leaves_its_field_and_texts_stand_apart(one: Drawn) -> None:
    layers = ("main", "thin", "dashed", "chain", "frame", "title-block", "title-block-main")
    check_fields(one.figure, [(layer, line) for layer in layers for line in one.lines(layer)])
    for (_layer, name, first), (_other, two, second) in combinations(boxes_of_texts(one.figure), 2):
        over = np.minimum(first[1], second[1]) - np.maximum(first[0], second[0])
        assert over.min() <= 1.0, (name, two)  # boxes have room above and below small letters


def test_primes_are_letters(valve: Drawn) -> None:
    words = [one.dxf.text for one in valve.document.modelspace().query("TEXT")]
    assert {"s′", "s″"} & set(words) and not any("\\prime" in word for word in words)


def test_jumps_of_the_acceleration_are_drawn_upright(tmp_path: Path) -> None:
    """A parabolic rise of 30 mm over 120 degrees: s″ = 4 h / beta^2, then its negative."""
    text = ct.cam_text(described("offset roller")).replace("cycloidal", "parabolic", 1)
    sheet = drawn(ct.parse_cam(text), tmp_path)
    curve, per = sheet.curves()[2], sheet.scales["s″"][0]
    level = 4.0 * 0.03 / math.radians(120.0) ** 2
    values = (curve[:, 1] - curve[-1, 1]) * per
    assert values[0] == pytest.approx(level, rel=1e-9)
    upright = np.flatnonzero((np.diff(curve[:, 0]) == 0.0) & (np.abs(np.diff(values)) > 0.5 * level))
    assert [values[at] - values[at + 1] for at in upright[:1]] == [pytest.approx(2.0 * level, rel=1e-9)]


def test_sheets_of_cams_speak() -> None:
    made = drawing_sheets(ct.example("valve-cam"))
    for language, words in (("ru", "Синтез кулачкового механизма"), ("uk", "Синтез кулачкового механізму")):
        with speaking(language):
            (figure,) = drawing_figures(made)
        texts = " ".join(text for _layer, text, _box in boxes_of_texts(figure)).replace("\n", " ")
        assert words in texts
        check_fields(figure, [])


@pytest.fixture(scope="module", params=[True, False], ids=["lowers", "raises"])
def driving(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, Drawn]:
    """A linkage that a cam drives, and the sheet of its cam; the lift lowers its lever, or raises it."""
    text = ct.mechanism_text(ct.example("cam-driven-linkage"))
    assert "lowers = true" in text
    linkage = ct.parse_mechanism(text.replace("lowers = true", f"lowers = {str(request.param).lower()}"))
    made = drawing_sheets(linkage)
    assert [type(sheet).__name__ for sheet in made.sheets] == [
        "MotionSheet",
        "VectorSheet",
        "ProfileSheet",
    ] and not made.missing
    folder = tmp_path_factory.mktemp("driving")
    write_drawing_set(made, folder, ["dxf"])
    document = ezdxf.readfile(folder / "sheet-3.dxf")
    assert not document.audit().errors
    return linkage, Drawn(linkage.drives[0].cam, drawing_figures(made)[2], document)


def test_rollers_of_a_driving_cam_stand_where_the_linkage_has_them(driving: tuple[Any, Drawn]) -> None:
    """The law of cosines with the lever's angle in the solved linkage, where the cam has turned so far."""
    linkage, sheet = driving
    per, axis, pivot = _axis_and_pivot(sheet)
    assert math.dist(axis, pivot) * per == pytest.approx(0.110, rel=1e-9)
    rings = [place for place, size in sheet.rings() if abs(size * per - 0.012) <= 1e-11]
    phi = np.radians([*np.arange(0, 120, 20), 120, *np.arange(180, 290, 110 / 6), 290])
    assert len(rings) == len(phi)
    speed = 150.0 * math.pi / 30.0
    lever = ct.motion(linkage, at=(phi / speed).tolist()).drive_value.values[:, 0]
    assert np.ptp(lever) == pytest.approx(math.radians(24.0), rel=1e-9)
    start = math.acos((0.090**2 + 0.110**2 - 0.052**2) / (2 * 0.090 * 0.110))
    forward = 1.0 if linkage.drives[0].lowers else -1.0
    mirror = np.array([forward, 1.0])  # an arm that lifts counter-clockwise stands on the left of its cam
    for turned, swung in zip(phi, np.abs(lever), strict=True):
        arm = math.pi - start - swung
        x, y = (np.array([0.110, 0.0]) + 0.090 * np.array([math.cos(arm), math.sin(arm)])) * mirror
        c, s = math.cos(turned), math.sin(turned) * forward
        expected = axis + np.array([c * x + s * y, c * y - s * x]) / per
        assert min(math.dist(expected, place) for place in rings) <= 1e-7


def test_the_profile_of_a_driving_cam_is_the_one_drawn_in_the_linkage(driving: tuple[Any, Drawn]) -> None:
    """The cam of `centrode draw` at the beginning, turned so that the pivot lies as on the sheet: never mirrored."""
    linkage, sheet = driving
    motion = ct.motion(linkage, at=[0.0])
    (cam,) = driving_cams(linkage, motion, 1.0)
    assert cam.pivot is not None
    per, axis, pivot = _axis_and_pivot(sheet)
    turn = complex(*(pivot - axis)) / complex(*(cam.pivot - cam.centre))
    placed = (cam.outline(0) - cam.centre) @ np.array([1.0, 1.0j]) * turn
    profile = (sheet.profile() - axis) @ np.array([1.0, 1.0j])
    apart = np.abs(placed[:, None] - profile).min(axis=1) * per
    # places of the sheet's profile are a quarter of a degree apart, at 70 mm from the axis at most
    assert apart.max() <= 0.5 * 0.070 * math.radians(0.3)
    wrong = np.abs(placed.conjugate()[:, None] - profile).min(axis=1) * per
    assert wrong.max() > 1e-3


def _axis_and_pivot(sheet: Drawn) -> tuple[float, Array, Array]:
    """The scale of the profile [m/mm], the axis of the cam and the pivot at its beginning [mm]."""
    per = sheet.scales["l"][0]
    rings = sheet.rings()
    axis = next(place for place, size in rings if abs(size * per - 0.040) <= 1e-11)
    hinges = [place for place, size in rings if abs(math.dist(place, axis) * per - 0.110) <= 1e-9]
    assert len(hinges) == 1
    return per, axis, hinges[0]


def test_a_scale_is_that_of_the_linkage(tmp_path: Path) -> None:
    made = drawing_sheets(ct.example("cam-driven-linkage"))
    for figure, scale in zip(
        drawing_figures(made, read_scale("1:2", "--scale")), ("1:2", "", "1:1"), strict=True
    ):
        shown = [text for layer, text, _box in boxes_of_texts(figure) if layer and ":" in text]
        # plans of vectors have scales of their own
        assert not scale or scale in shown
        check_fields(figure, [])


def test_a_driving_cam_that_does_not_reach_its_follower_is_named() -> None:
    linkage = ct.example("cam-driven-linkage")
    cam = linkage.drives[0].cam
    assert cam is not None
    small = cam.model_copy(update={"body": cam.body.model_copy(update={"base_radius": 0.005})})
    drive = linkage.drives[0].model_copy(update={"cam": small})
    with pytest.raises(ct.InputError, match=r"lever, cam, \[follower\] arm"):
        drawing_sheets(linkage.model_copy(update={"drives": (drive,)}))


def test_a_driving_cam_without_a_size_has_no_sheet() -> None:
    text = ct.cam_text(ct.example("indexing-cam"))
    rows = [
        row for row in text.splitlines() if not row.startswith(("base_radius", "pressure_angle", "[bounds]"))
    ]
    cam = ct.parse_cam("\n".join(rows))
    linkage = ct.example("cam-driven-linkage")
    drive = linkage.drives[0].model_copy(update={"cam": cam})
    made = drawing_sheets(linkage.model_copy(update={"drives": (drive,)}))
    assert [type(sheet).__name__ for sheet in made.sheets] == ["MotionSheet", "VectorSheet"]


CIRCLE = """
kind = "cam"
display = { length = "mm", angle = "deg" }
[curvature]
law = "constant"
k0 = "0.01 1/mm"
[start]
radius = "60 mm"
[range]
to = "90 deg"
[roller]
radius = "9 mm"
"""


def test_the_path_of_a_constant_curvature_is_a_circle(tmp_path: Path) -> None:
    """Of radius 100 mm about (0, -40) mm: rho = -40 cos phi + sqrt(100^2 - 40^2 sin^2 phi), the profile 9 mm inside."""
    sheet = drawn(ct.parse_cam(CIRCLE), tmp_path)
    distance, rate, _second = sheet.curves()
    across = sheet.scales["\\varphi"][0]
    phi = (distance[:, 0] - distance[0, 0]) * across
    assert phi[-1] == pytest.approx(math.pi / 2, rel=1e-12)
    root = np.sqrt(1.0 - (0.4 * np.sin(phi)) ** 2)
    radius = 0.1 * (root - 0.4 * np.cos(phi))
    per = sheet.scales["\\rho"][0] if "\\rho" in sheet.scales else sheet.scales["ρ"][0]
    np.testing.assert_allclose(np.diff(distance[:, 1]) * per, np.diff(radius), atol=1e-12)
    slope = 0.1 * (0.4 * np.sin(phi) - 0.16 * np.sin(phi) * np.cos(phi) / root)
    np.testing.assert_allclose((rate[:, 1] - rate[0, 1]) * sheet.scales["ρ′"][0], slope, atol=1e-12)
    per = sheet.scales["l"][0]
    rollers = np.array([place for place, size in sheet.rings() if abs(size * per - 0.009) <= 1e-12])
    assert len(rollers) == 12
    profile = sheet.profile()
    # three places of the profile give its centre; all others lie on its circle, rollers on the circle about it
    first, middle, last = profile[[0, len(profile) // 2, -1]]
    rows = 2.0 * np.array([middle - first, last - first])
    centre = np.linalg.solve(rows, [middle @ middle - first @ first, last @ last - first @ first])
    np.testing.assert_allclose(np.hypot(*(profile - centre).T) * per, 0.091, rtol=1e-9)
    np.testing.assert_allclose(np.hypot(*(rollers - centre).T) * per, 0.1, rtol=1e-9)


@pytest.mark.parametrize("name", ["cam-from-curvature", "walking-wheel-four-legs"])
def test_sheets_of_curvature_laws_keep_their_fields(name: str) -> None:
    cam = ct.example(name)
    (figure,) = drawing_figures(drawing_sheets(cam))
    check_fields(figure, [])
    texts = " ".join(text for _layer, text, _box in boxes_of_texts(figure))
    steepest = ct.cam(cam, 3601)["cam_pressure_angle"]
    assert f"= {math.degrees(float(abs(steepest).max())):.4g}°" in texts


def test_what_no_sheet_shows_is_refused() -> None:
    for cam, arguments, told in (
        ("walking-wheel-three-legs", {"link": "A"}, "motion of its follower"),
        ("valve-cam", {"instants": ["30 deg"]}, "no plans of vectors"),
        ("valve-cam", {"link": "A"}, "motion of its follower"),
        ("valve-cam", {"positions": 1}, "1 position is given"),
    ):
        with pytest.raises(ct.InputError, match=told):
            drawing_sheets(ct.example(cam), **arguments)
