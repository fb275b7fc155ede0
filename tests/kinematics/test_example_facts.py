"""Every built-in example runs and ends as its header claims; strokes, ratios, limits and paths of the headers."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.dynamics.motion_results import MotionResults, study
from centrode.kinematics.preparation import ready
from mechanisms import EPS, events, link, point, slide, statuses

CHANGE_POINTS = {
    # within the range of the example; next to them samples are interpolated
    "antiparallelogram": 2,
    "galloway": 2,
    "kite": 2,
    "parallelogram": 2,
    "scott-russell": 2,
    "three-crank-parallelogram": 2,
}
INTERPOLATED = 1e-11
"""Residual next to a change point: six nodes on each side, an error of the twelfth derivative times 0.06^12."""


@cache
def studied(name: str) -> MotionResults:
    return study(ct.example(name))


def run(name: str) -> xr.Dataset:
    """The motion of an example, as its study has it; not to be changed."""
    return studied(name).motion


@pytest.mark.parametrize("name", ct.example_names())
def test_every_example_runs(name: str) -> None:
    data = run(name)
    mechanism = ct.example(name)
    expected = {"ok", "open", "cut off"} if name.endswith("-locked") else {"ok"}
    assert set(statuses(data)) == expected
    assert len(events(data, "change point")) == CHANGE_POINTS.get(name, 0)
    # a residual is a difference of coordinates: a few roundings of each of the places on the way there
    rounding = 4 * EPS * len(mechanism.links)
    # angles of gears and rolling wheels are rounded to their own size
    if mechanism.gears or mechanism.rolling:
        angles = data["angle" if mechanism.space == "plane" else "joint_angle"]
        rounding += 4 * EPS * float(np.abs(angles).max())
    assert data.attrs["worst_residual"] <= (INTERPOLATED if name in CHANGE_POINTS else rounding)
    assert ready(mechanism).assembled.residual <= rounding


@pytest.mark.parametrize("name", ct.example_names())
def test_studies_tell_success_and_failure(name: str) -> None:
    assert (studied(name).unreached_samples > 0) == name.endswith("-locked")


def fine(name: str, start: float, stop: float, samples: int = 3601) -> xr.Dataset:
    return ct.motion(ct.example(name), samples, start=start, stop=stop)


def test_straight_lines() -> None:
    """Chebyshev and Hoeken: stroke 4, y between 4 and sqrt(16.078125)."""
    for name in ("chebyshev-straight-line", "hoeken"):
        p = point(fine(name, np.pi / 2, 3 * np.pi / 2), "P")
        assert abs(p[0].real - 4) <= 64 * EPS
        assert abs(p[-1].real) <= 64 * EPS
        assert p.imag.min() >= 4 - 64 * EPS
        top = np.sqrt(16.078125)
        # the crest is met at a sample to within half a step: y'' / 2 (step / 2)^2 with y'' below 1
        assert top - (np.pi / 3600) ** 2 <= p.imag.max() <= top + 64 * EPS


def test_peaucellier_draws_a_line() -> None:
    data = run("peaucellier")
    p, c = point(data, "P"), point(data, "C")
    # P hangs on three dyads; near the limits digits are lost with 1/sine of the angle between BP and EP (0.06)
    assert np.max(np.abs(p.real - 16 / 3)) <= 64 * EPS * 16 / 3 / 0.06
    assert np.max(np.abs(np.abs(p) * np.abs(c) - 16)) <= 64 * EPS * 16 / 0.06
    wide = ct.motion(ct.example("peaucellier"), 5, start=-1.7, stop=1.7)
    limit = 2 * np.arccos(2 / 3)
    assert events(wide, "limit") == pytest.approx([-limit, limit], abs=8 * EPS)
    assert limit == pytest.approx(1.682137341, abs=5e-10)
    # at the limit itself B lies on E and P is undetermined; just inside P is where the line says, slope (8/3)/cos^2 = 6
    near = ct.motion(ct.example("peaucellier"), 1, start=limit - 1e-8, stop=limit - 1e-8)
    assert point(near, "P")[0].imag == pytest.approx(5.962848, abs=5e-7 + 6e-8)
    at = ct.motion(ct.example("peaucellier"), 1, start=limit, stop=limit)
    assert statuses(at) == ["singular"]
    assert np.isnan(point(at, "P")[0])
    assert point(at, "B")[0] == pytest.approx(point(at, "E")[0], abs=64 * EPS * 5)


def test_double_and_triple_rockers_lock_by_the_cosine_law() -> None:
    wide = ct.motion(ct.example("double-rocker"), 9, start=0.3, stop=1.4)
    assert events(wide, "limit") == pytest.approx([np.arccos(7 / 8), np.arccos(3 / 8)], abs=4 * EPS)
    assert events(wide, "limit") == pytest.approx([0.505360510, 1.186399552], abs=5e-10)
    wide = ct.motion(ct.example("triple-rocker"), 9, start=-2.4, stop=2.4)
    assert events(wide, "limit") == pytest.approx([-np.arccos(-41 / 64), np.arccos(-41 / 64)], abs=4 * EPS)
    at_zero = ct.motion(ct.example("triple-rocker"), 1, start=0.0, stop=0.0)
    assert np.cos(np.pi - link(at_zero, "DB")[0]) == pytest.approx(9 / 16, abs=16 * EPS)


def test_the_excerpt_head_to_tail_closes_and_locks() -> None:
    """OD by the sum of its links; the crank stops where the coupler and the rocker are in line: AD = 0.6."""
    chain = ct.motion(ct.example("four-bar-excerpt-head-to-tail"), at=[0.0])
    assert np.allclose(chain.position.sel(point="D")[0], [0.1, 0.3 * np.sqrt(3)], rtol=0, atol=4 * EPS)
    # equations (6) of the source: 2 (0.1/0.3) over sin(-pi/3), times sin(2 pi/3) and sin(-pi/3)
    assert chain.angular_velocity[0, 1:].to_numpy() == pytest.approx([-2 / 3, 2 / 3], rel=16 * EPS)
    wide = ct.motion(ct.example("four-bar-excerpt-head-to-tail"), 9, start=-1.2, stop=4.0)
    opening = np.arccos((0.29 - 0.36) / (0.2 * np.sqrt(0.28)))
    line = np.arctan2(0.3 * np.sqrt(3), 0.1)
    assert events(wide, "limit") == pytest.approx([line - opening, line + opening], abs=16 * EPS)


def test_worked_mechanism_locks_where_fifty_digits_say() -> None:
    limits = events(run("slider-between-cranks-locked"), "limit")
    assert limits[0] == pytest.approx(1.79991241652444028, abs=4 * np.spacing(1.8))
    assert limits[1] == pytest.approx(5.47487058607948, abs=5e-15)


def test_rockers_turn_back() -> None:
    """Crank-rockers: extremes of the rocker's angle at D to the line DO, where crank and coupler are in line."""
    for name, rocker, cosines in (
        ("crank-rocker", "DB", (4.75 / 24, 18.75 / 24)),
        ("watt-six-bar", "rocker", (0.3125, 0.9125)),
        ("stephenson-six-bar", "DB", (0.3125, 0.9125)),
        ("four-bar-excerpt", "DB", (0.375, 0.875)),
    ):
        data = fine(name, 0.0, 2 * np.pi)
        angle = np.pi - link(data, rocker)
        reached = sorted((np.max(np.abs(angle)), np.min(np.abs(angle))), reverse=True)
        # an extreme is met within half a step: psi'' / 2 (step / 2)^2, psi'' below 4 here
        assert reached == pytest.approx(np.arccos(cosines).tolist(), abs=2 * (np.pi / 3600) ** 2)


def test_strokes_and_ratios_of_times() -> None:
    step = 2 * np.pi / 3600
    for name, guide, stroke, ratio in (
        ("slider-crank-offset", "B", np.sqrt(16 - 0.09) - np.sqrt(4 - 0.09), None),
        ("shaper", "E", 3.8, 2.0),
        ("whitworth-quick-return", "E", 1.6, 2.0),
    ):
        data = fine(name, 0.0, 2 * np.pi)
        x = slide(data, guide)
        curvature = np.max(np.abs(slide(data, guide, "slide_acceleration")))
        assert np.ptp(x) == pytest.approx(stroke, abs=curvature * step**2)
        forward = np.mean(slide(data, guide, "slide_velocity")[:-1] > 0)
        shares = max(forward, 1 - forward) / min(forward, 1 - forward)
        if ratio is None:
            d = np.arcsin(0.15) - np.arcsin(0.075)
            ratio = (np.pi + d) / (np.pi - d)
        # two dead points, each found to one sample of 3600
        assert shares == pytest.approx(ratio, abs=2 * (1 + ratio) ** 2 / 3600)


def test_levers() -> None:
    data = fine("inverted-slider-crank", 0.0, 2 * np.pi)
    lever, step = link(data, "lever"), np.pi / 3600
    bend = np.max(np.abs(link(data, "lever", "angular_acceleration")))
    assert lever.min() == pytest.approx(np.pi - np.arcsin(0.4), abs=bend * step**2)
    assert lever.max() == pytest.approx(np.pi + np.arcsin(0.8 / 3), abs=bend * step**2)
    assert np.arcsin(0.4) + np.arcsin(0.8 / 3) == pytest.approx(0.681450, abs=5e-7)
    rate = link(fine("whitworth-quick-return", 0.0, 2 * np.pi, 5), "lever", "angular_velocity")
    assert rate[[1, 3]] == pytest.approx([2 / 3, 2], abs=16 * EPS)
    rate = link(fine("oscillating-cylinder", 0.0, np.pi, 2), "rod", "angular_velocity")
    assert rate == pytest.approx([-1 / 3, 1 / 5], abs=16 * EPS)


def test_antiparallelogram_is_a_mirror_image() -> None:
    data = fine("antiparallelogram", 1.0, 3.0, 21)
    a, b = point(data, "A"), point(data, "B")
    along = 2 - a
    # OB is parallel to AD and OB * AD = 3; 1/|AD| and the dyad's sine stay above 0.15 there
    assert np.max(np.abs((b * np.conj(along)).imag)) <= 64 * EPS * 3 / 0.15
    assert np.abs(b) * np.abs(along) == pytest.approx(3 * np.ones(21), abs=64 * EPS * 3 / 0.15)
    q = data["drive_value"].to_numpy()[:, 0]
    expected = -3 / (5 - 4 * np.cos(q))
    assert link(data, "DB", "angular_velocity") == pytest.approx(expected, abs=64 * EPS * 3 / 0.15**3)


def test_drag_link_gains_a_turn() -> None:
    data = run("drag-link")
    gained = link(data, "DB")[-1] - link(data, "DB")[0]
    assert gained == pytest.approx(2 * np.pi, abs=32 * EPS * 2 * np.pi)
    a, b = point(data, "A"), point(data, "B")
    ab, oa, db = b - a, a, b - 1
    rate = (np.conj(ab) * oa).imag / (np.conj(ab) * db).imag
    assert link(data, "DB", "angular_velocity") == pytest.approx(rate, rel=64 * EPS * 2.5 * 2.2)


def test_legs() -> None:
    """Jansen: places in mm to the fourth decimal. Klann: the patent's drawing, three decimals."""
    data = fine("jansen-leg", 0.0, 2 * np.pi)
    g = point(data, "G") * 1e3
    assert abs(g[0] - (-43.1601 - 91.7569j)) <= 0.5e-4 * np.sqrt(2)
    assert abs(g[1800] - (-33.7297 - 73.5171j)) <= 0.5e-4 * np.sqrt(2)
    # extremes between samples: g'' / 2 (step / 2)^2, g'' below 100 mm
    near = 0.5e-4 + 50 * (np.pi / 3600) ** 2
    box = [g.real.min(), g.real.max(), g.imag.min(), g.imag.max()]
    assert box == pytest.approx([-71.5216, -3.6131, -91.8339, -69.3767], abs=near)
    assert np.mean(g[:-1].imag < -91.8339 + 1) == pytest.approx(0.43, abs=0.005)
    data = fine("klann-leg", 0.0, 2 * np.pi)
    foot = point(data, "P33")
    assert abs(foot[0] - 1.0001) <= 0.5e-4 * np.sqrt(2)
    assert abs(foot[1800]) <= 1e-9  # the drawing's own closure: the links' lengths come from three decimals
    assert -0.0488 <= foot[:1801].imag.min() <= -0.0487  # the header's bounds are rounded outwards
    assert 0.0063 <= foot[:1801].imag.max() <= 0.0064
    assert foot.imag.max() == pytest.approx(0.4786, abs=0.5e-4 + 1e-5)
    for name, place in (("P27", 1.277 + 0.750j), ("P35", 0.768 + 0.866j)):
        assert abs(point(data, name)[0] - place) <= 1.5e-3  # the patent's retracted position, three decimals


def test_andrews_starts_stretched() -> None:
    """OF and EF lie in one line."""
    start = ct.motion(ct.example("andrews-squeezer"), 1, start=-0.0617138900142764, stop=-0.0617138900142764)
    assert abs(point(start, "E")[0]) == pytest.approx(0.021, rel=1e-9)


def test_two_link_arm() -> None:
    data = run("two-link-arm")
    t = data.time.to_numpy()
    assert point(data, "B") == pytest.approx(np.cos(t), abs=8 * EPS)
    assert point(data, "C") == pytest.approx(0.75 * np.cos(t) + 0.25j * np.sin(t), abs=8 * EPS)
    assert link(data, "AB") == pytest.approx(-t, abs=8 * EPS * 2 * np.pi)
    assert point(data, "B", "acceleration") == pytest.approx(-np.cos(t), abs=16 * EPS)


def test_wiper_follows_its_formula() -> None:
    data = run("wiper")
    t = data.time.to_numpy()
    assert link(data, "OA") == pytest.approx(np.pi / 2 + 0.8 * np.sin(t), abs=8 * EPS)
    assert link(data, "DB", "angular_velocity") == pytest.approx(0.8 * np.cos(t), abs=256 * EPS)
    assert link(data, "DB", "angular_acceleration") == pytest.approx(-0.8 * np.sin(t), abs=4096 * EPS)
    a = np.pi / 2 + 0.8 * np.sin(t)
    assert point(data, "T") == pytest.approx(0.05 + 0.35j + 0.6 * np.exp(1j * a), abs=64 * EPS)
    assert point(data, "T") - point(data, "U") == pytest.approx(0.7j * np.ones(len(t)), abs=64 * EPS)
