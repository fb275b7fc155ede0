"""Centrodes against closed forms; they roll on each other without slip; curvature of paths against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from mechanisms import EPS, four_bar, point
from samples import few


def curve(data: Any, name: str) -> Any:
    """A curve as complex numbers."""
    xy = data[name].to_numpy()
    return xy[..., 0] + 1j * xy[..., 1]


def test_cardan_circles_of_the_trammel() -> None:
    """The rod of length 1 rolls a circle of radius 1/2 in one of radius 1; the centre is (x_A, y_B)."""
    motion = ct.motion(ct.example("elliptic-trammel"), samples=61)
    found = ct.centrodes(motion, "AB")
    fixed, moving = curve(found, "fixed_centrode"), curve(found, "moving_centrode")
    a, b = point(motion, "A"), point(motion, "B")
    steep = 1.0 / np.abs(b)  # digits lost towards the limits
    assert (np.abs(fixed - (a.real + 1j * b.imag)) <= 64 * EPS * steep**2).all()
    assert (np.abs(np.abs(fixed) - 1.0) <= 64 * EPS * steep**2).all()
    assert (np.abs(np.abs(moving - 0.5) - 0.5) <= 64 * EPS * steep**2).all()
    assert (found["centrode_piece"] == 0).all()


def antiparallelogram() -> Any:
    return ct.motion(ct.example("antiparallelogram"), samples=91, start=0.4, stop=2.8)


def test_hyperbolas_of_the_antiparallelogram() -> None:
    """The coupler relative to the frame: foci O and D, and A and B, vertices a crank's length apart."""
    motion = antiparallelogram()
    found = ct.centrodes(motion, "AB")
    fixed, moving = curve(found, "fixed_centrode"), curve(found, "moving_centrode")
    far = np.maximum(np.abs(fixed), 2.0)
    for place, (first, second) in ((fixed, (0.0, 2.0)), (moving, (0.0, 2.0))):
        difference = np.abs(np.abs(place - first) - np.abs(place - second))
        assert (np.abs(difference - 1.0) <= 256 * EPS * far**2).all()


def test_ellipses_of_the_antiparallelogram() -> None:
    """One crank against the other: foci are the ends of each, the sum of the distances is a long link."""
    found = ct.centrodes(antiparallelogram(), "DB", "OA")
    for name in ("fixed_centrode", "moving_centrode"):
        place = curve(found, name)
        total = np.abs(place) + np.abs(place - 1.0)
        assert np.abs(total - 2.0).max() <= 256 * EPS * 4


def test_a_wheel_is_its_own_centrode() -> None:
    motion = ct.motion(ct.example("rolling-wheel-rod"), samples=31)
    found = ct.centrodes(motion, "wheel")
    fixed, moving = curve(found, "fixed_centrode"), curve(found, "moving_centrode")
    assert np.abs(fixed - point(motion, "C").real).max() <= 64 * EPS * 2
    assert np.abs(np.abs(moving) - 0.3).max() <= 64 * EPS
    rolled = 0.6 * np.pi  # once round
    assert float(found["fixed_arc"][-1]) == pytest.approx(rolled, rel=1e-14)
    assert float(found["moving_arc"][-1]) == pytest.approx(rolled, rel=(2 * np.pi / 30) ** 4)


@pytest.mark.parametrize(
    ("name", "link", "against", "span"),
    [
        ("crank-rocker", "AB", "frame", (0.5, 1.5)),
        ("antiparallelogram", "DB", "OA", (0.5, 2.5)),
        ("slider-crank-offset", "AB", "frame", (0.3, 1.2)),
        ("slider-between-cranks", "CB", "OA", (0.3, 1.2)),
        ("inverted-slider-crank", "lever", "OA", (0.3, 1.2)),
        ("planetary-hypocycloid", "planet", "frame", (0.0, 2.0)),
    ],
)
def test_they_roll_without_slip(name: str, link: str, against: str, span: tuple[float, float]) -> None:
    """Chords between samples differ by the third power of their length, arcs by the fourth power in all."""
    worst = []
    for samples in (41, 81, 161):
        motion = ct.motion(ct.example(name), samples=samples, start=span[0], stop=span[1])
        found = ct.centrodes(motion, link, against)
        assert (found["centrode_piece"] == 0).all()
        worst.append(float(np.abs(found["fixed_arc"] - found["moving_arc"]).max()))
        total = float(found["fixed_arc"][-1])
    noise = 2.0**10 * EPS * total
    assert worst[2] <= worst[1] / 12 + noise  # 16 in the limit
    assert worst[1] <= worst[0] / 12 + noise
    assert worst[2] <= 1e-6 * total


def test_they_touch_in_the_centre() -> None:
    """Laid on the fixed one at a sample, the moving centrode leaves it there by a second power: a common tangent."""
    q, h = 1.0, np.array([-1e-3, 0.0, 1e-3])
    motion = ct.motion(ct.example("crank-rocker"), at=q + h)
    found = ct.centrodes(motion, "AB")
    turn = np.exp(1j * motion.angle.sel(link="AB").to_numpy()[1])
    laid = point(motion, "A")[1] + turn * curve(found, "moving_centrode")
    apart = np.abs(laid - curve(found, "fixed_centrode"))
    step = np.abs(np.diff(curve(found, "fixed_centrode"))).max()
    assert apart[1] <= 256 * EPS * 10
    assert apart[[0, 2]].max() <= step**2  # curvatures of the order of one


def test_pieces_end_where_the_centre_goes_to_infinity() -> None:
    """The coupler of a crank-rocker stops turning twice a turn: three pieces, joined at neither place."""
    motion = ct.motion(ct.example("crank-rocker"), samples=361)
    found = ct.centrodes(motion, "AB")
    pieces = found["centrode_piece"].to_numpy()
    spin = motion["angular_velocity"].sel(link="AB").to_numpy()
    assert pieces.max() == 2
    np.testing.assert_array_equal(np.diff(pieces) > 0, np.sign(spin[1:]) != np.sign(spin[:-1]))
    begins = np.flatnonzero(np.diff(pieces) > 0) + 1
    assert (found["fixed_arc"].to_numpy()[begins] == 0.0).all()


@pytest.mark.parametrize("samples", [37, 91])
def test_an_arc_that_goes_to_infinity_has_no_length_of_its_samples(samples: int) -> None:
    told = ct.summary(ct.centrodes(ct.motion(ct.example("crank-rocker"), samples), "AB"))
    arcs = [line.split()[-1] for line in told.splitlines() if line.startswith("arc of the")]
    assert arcs == ["∞", "∞"]


def test_a_translation_and_an_absence_have_no_centrode() -> None:
    found = ct.centrodes(ct.motion(ct.example("slider-between-cranks"), samples=9), "slider C")
    assert (found["centrode_piece"] == -1).all()
    assert np.isnan(found["fixed_centrode"]).all() and np.isnan(found["fixed_arc"]).all()
    locked = ct.motion(ct.example("slider-between-cranks-locked"), samples=101)
    found = ct.centrodes(locked, "CB")
    there = locked["status"].to_numpy() == ct.Status.OK
    np.testing.assert_array_equal(found["centrode_piece"].to_numpy() >= 0, there)


def test_centrodes_of_a_batch() -> None:
    bar, lengths = ct.four_bar(1, 3.5, 3, 4), [3.3, 3.6]
    many = ct.centrodes(
        ct.motion(bar, samples=31, vary={"links.coupler.length": lengths}), "coupler", "rocker"
    )
    assert many["fixed_centrode"].dims == ("mechanism", "sample", "axis")
    for lane, length in enumerate(lengths):
        alone = ct.motion(ct.with_value(bar, "links.coupler.length", length), samples=31)
        one = ct.centrodes(alone, "coupler", "rocker")
        for name in ("fixed_centrode", "moving_arc", "centrode_piece"):
            np.testing.assert_allclose(many[name][lane], one[name], rtol=1e-9, atol=1e-9)


def test_path_curvature_is_that_of_velocity_and_acceleration() -> None:
    for name, link in (("crank-rocker", "AB"), ("jansen-leg", "EG"), ("third-class-triad", "platform")):
        motion = ct.motion(ct.example(name), samples=13)
        bent = ct.curvature(motion, link)
        assert bent["status"].equals(motion["status"])
        for label in map(str, bent["point"].values):
            v, a = (point(motion, label, f"{kind}_coefficient") for kind in ("velocity", "acceleration"))
            expected = np.imag(np.conj(v) * a) / np.abs(v) ** 3
            found = bent["path_curvature"].sel(point=label).to_numpy()
            size = np.abs(a) / np.abs(v) ** 2
            assert (np.abs(found - expected) <= 2.0**14 * EPS * size).all(), (name, label)
            centre = curve(bent.sel(point=label), "curvature_centre")
            known = np.isfinite(centre)
            np.testing.assert_allclose(
                np.abs(centre - point(motion, label))[known], 1 / np.abs(found[known]), rtol=2.0**20 * EPS
            )


def test_the_ellipse_of_the_trammel() -> None:
    """P = (0.75 cos t, 0.25 sin t): curvature a b / s^3 with s the rate of the arc; its slope by the arc."""
    t = np.linspace(0.4, 2.6, 12)
    bent = ct.curvature(ct.example("elliptic-trammel"), "AB", at=np.cos(t))
    a, b = 0.75, 0.25
    s = np.hypot(a * np.sin(t), b * np.cos(t))
    # the drive's value cos t grows as t falls: the path is passed clockwise
    rate = 3 * a * b * (a * a - b * b) * np.sin(t) * np.cos(t) / s**6
    condition = 2.0**10 / np.sin(t) ** 5
    found = (bent[name].sel(point="P") for name in ("path_curvature", "path_curvature_slope"))
    assert (np.abs(next(found) + a * b / s**3) <= EPS * condition / s**3).all()
    assert (np.abs(next(found) - -rate) <= EPS * condition / s**6).all()
    # Cardan circles: the inflection circle is the rolling one, the inflection pole the middle of the trammel
    assert np.abs(bent["inflection_diameter"] - 1.0).max() <= EPS * condition.max()
    assert np.abs(curve(bent, "inflection_pole")).max() <= EPS * condition.max()
    assert np.isnan(bent["ball_point"]).all()  # every point of the circle moves on a straight line


MECHANISMS = (
    ("crank-rocker", "AB", "frame"),
    ("slider-crank-offset", "AB", "frame"),
    ("drag-link", "DB", "OA"),
    ("stephenson-six-bar", "PR", "frame"),
    ("inverted-slider-crank", "lever", "OA"),
)


@settings(max_examples=few(6, 12))
@given(st.sampled_from(MECHANISMS), st.floats(0.2, 6.0), st.floats(0.3, 2.8))
def test_the_circle_the_cubic_and_the_point_do_what_they_are_for(
    which: tuple[str, str, str], q: float, turn: float
) -> None:
    """Points of the inflection circle go straight, those of the cubic keep their curvature, Ball's point does both."""
    name, link, against = which
    mechanism = ct.example(name)
    bent = ct.curvature(mechanism, link, at=[q], against=against).isel(sample=0)
    motion = ct.motion(mechanism, at=[q])
    pole, end, ball = (complex(*bent[x].to_numpy()) for x in ("pole", "inflection_pole", "ball_point"))
    tangent, (a, b) = np.exp(1j * float(bent["pole_tangent"])), bent["stationary_cubic"].to_numpy()
    way = np.exp(1j * turn)
    radius = np.sin(turn) * np.cos(turn) / (a * np.cos(turn) + b * np.sin(turn))
    diameter = float(bent["inflection_diameter"])
    chosen = {
        "circle": pole + tangent * way * diameter * np.sin(turn),
        "cubic": pole + tangent * way * radius,
        "ball": ball,
        "other": pole + tangent * way * 0.37 * diameter,
    }
    origin, angle = pose(motion, mechanism, link)
    local = {key: (at - origin) * np.exp(-1j * angle) for key, at in chosen.items()}
    points = {key: (float(at.real), float(at.imag)) for key, at in local.items()}
    again = ct.curvature(mechanism, link, at=[q], against=against, points=points).isel(sample=0)
    bends, slopes = (again[x] for x in ("path_curvature", "path_curvature_slope"))
    reach = {key: abs(at - pole) for key, at in chosen.items()}

    def allowed(key: str, power: int) -> float:
        """Places are exact to rounding over the distances that they were taken from."""
        far = 1.0 + abs(pole) + diameter + abs(chosen[key]) + 1.0 / reach[key]
        return 2.0**12 * EPS * far**4 * (1.0 + diameter / reach[key] ** 2) ** power

    for key in ("circle", "ball"):
        assert abs(float(bends.sel(point=key))) <= allowed(key, 1)
    for key in ("cubic", "ball"):
        assert abs(float(slopes.sel(point=key))) <= allowed(key, 3)
    # Euler and Savary: distances along a ray from the pole to a point, its centre and the inflection circle
    centre = complex(*again["curvature_centre"].sel(point="other").to_numpy())
    ray = chosen["other"] - pole
    on_circle = diameter * np.sin(turn)
    to_centre = float(np.real((centre - pole) / ray)) * abs(ray)
    assert abs(np.imag((centre - pole) / ray)) <= allowed("other", 2)
    assert 1 / abs(ray) - 1 / to_centre == pytest.approx(1 / on_circle, rel=allowed("other", 2))
    assert abs(end - (pole + tangent * 1j * diameter)) <= allowed("other", 1)


def pose(motion: Any, mechanism: ct.Mechanism, link: str) -> tuple[complex, float]:
    """Origin and angle of a link's axes."""
    name, own = next(iter(mechanism.links[link].coordinates.items()))
    angle = float(motion.angle.sel(link=link)[0])
    return complex(point(motion, name)[0]) - complex(*own) * np.exp(1j * angle), angle


def test_the_slope_is_that_of_the_curvature() -> None:
    """Against central differences of the curvature itself, by Richardson's rule."""
    mechanism, q = ct.example("klann-leg"), 1.3
    link = mechanism.link_names[-1]
    at = ct.curvature(mechanism, link, at=[q])
    errors = []
    for h in (2e-3, 1e-3):
        beside = ct.curvature(mechanism, link, at=[q - h, q + h])["path_curvature"].to_numpy()
        motion = ct.motion(mechanism, at=[q])
        names = [str(name) for name in at["point"].values]
        speed = np.abs([point(motion, name, "velocity_coefficient")[0] for name in names])
        errors.append(
            np.abs((beside[1] - beside[0]) / (2 * h) / speed - at["path_curvature_slope"].to_numpy()[0])
        )
    moving = speed > 0
    noise = 1e-9 * np.abs(at["path_curvature"].to_numpy()[0])[moving] / speed[moving] / 1e-3
    assert (errors[1][moving] <= errors[0][moving] / 3.5 + noise).all()  # 4 in the limit


def test_curvature_passes_a_change_point() -> None:
    """The coupler of a parallelogram translates: circles of the crank's radius, no pole, also where it is flat."""
    mechanism = ct.example("parallelogram")
    places = np.array([0.5, np.pi - 0.01, np.pi, np.pi + 0.02, 4.0])
    bent = ct.curvature(mechanism, "AB", at=places)
    crank = ct.value_at(mechanism, "links.OA.length")
    # conventions, 25: derivatives are interpolated there
    assert np.abs(np.abs(bent["path_curvature"]) * crank - 1.0).max() <= 1e-8
    assert np.abs(bent["path_curvature_slope"]).max() <= 1e-5
    assert np.isnan(bent["pole"].to_numpy()[[0, 4]]).all()


def test_curvature_where_there_is_nothing() -> None:
    locked = ct.curvature(ct.example("slider-between-cranks-locked"), "CB", at=[0.5, 2.5])
    assert locked["status"].values.tolist() == [0, 1]
    assert np.isfinite(locked["pole"][0]).all() and np.isnan(locked["pole"][1]).all()
    assert np.isnan(locked["path_curvature"][1]).all()
    still = ct.curvature(ct.example("crank-rocker"), "OA", at=[1.0])
    assert np.isnan(still["path_curvature"].sel(point="O")).all()  # it does not move
    np.testing.assert_allclose(still["pole"], 0.0, atol=4 * EPS)
    np.testing.assert_allclose(still["inflection_diameter"], 0.0, atol=16 * EPS)  # a hinge has no circle
    assert np.isnan(still["pole_tangent"]).all() and np.isnan(still["ball_point"]).all()


def test_wrong_questions_about_centrodes_and_curvature() -> None:
    mechanism = ct.example("crank-rocker")
    motion = ct.motion(mechanism, samples=3)
    with pytest.raises(ct.InputError, match='no link "AC"'):
        ct.centrodes(motion, "AC")
    with pytest.raises(ct.InputError, match="no centre relative to itself"):
        ct.centrodes(motion, "AB", "AB")
    with pytest.raises(ct.InputError, match='no link "AC"'):
        ct.curvature(motion, "AC")
    with pytest.raises(ct.InputError, match="does not move relative to itself"):
        ct.curvature(motion, "AB", against="AB")
    with pytest.raises(ct.InputError, match="needs values of the drive"):
        ct.curvature(mechanism, "AB")
    with pytest.raises(ct.InputError, match="computed for one mechanism only"):
        ct.curvature(ct.motion(mechanism, samples=3, vary={"links.AB.length": [3.5]}), "AB")
    with pytest.raises(ct.NotComputedYet, match="on the sphere"):
        ct.curvature(ct.example("spherical-four-bar"), "BC", [0])


def test_arcs_next_to_infinity_are_those_of_the_chords() -> None:
    """A centrode is nearly straight there, so that its arc is that of its chords, however long they are."""
    motion = ct.motion(four_bar(1.0, 3.5, 3.0, 4.0), samples=361)
    found = ct.centrodes(motion, "AB")
    pieces = found["centrode_piece"].to_numpy()
    for name in ("fixed", "moving"):
        places = found[f"{name}_centrode"].to_numpy() @ [1, 1j]
        for piece in range(pieces.max() + 1):
            here = np.flatnonzero(pieces == piece)
            chords = np.abs(np.diff(places[here]))
            arc = float(found[f"{name}_arc"][here[-1]])
            # an arc is longer than its chords, and by a part of them that the turning of the curve tells
            assert chords.sum() * (1 - 1e-12) <= arc <= 1.001 * chords.sum()
