"""Shaking force and moment against Newton's law from the motion, differences of the momentum, and closed series."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from burdened import burdened, velocity_of_centre
from centrode.kinematics.preparation import ready
from centrode.model.examples import example_text
from growing import DYADS, grown
from mechanisms import EPS, OPERATIONS, link, point, rounding, solve_evenly
from samples import few

Array = npt.NDArray[np.float64]
RATE = 2 * math.pi * 50
R, L, PISTON = 0.05, 0.18, 0.8


def engine(piston: float = PISTON, crank: float = 0.0, **more: Any) -> ct.Mechanism:
    """A slider-crank whose masses stand in the crank's pin and the piston."""
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0, 0]}},
        "links": {
            "OA": {"length": R, "mass": crank, "centre": "A", "inertia": 0},
            "AB": {"length": L},
            "piston": {"points": ["B"], "mass": piston},
        },
        "guides": [{"point": "B", "on": "frame", "through": [0, 0], "direction": [1, 0], "link": "piston"}],
        "drives": [{"link": "OA", "start": 0.3, "speed": RATE}],
        "assembly": {"sides": {"B": "ahead"}},
    }
    return ct.Mechanism(**{**parts, **more})


def by_newton(mechanism: ct.Mechanism, data: xr.Dataset, about: complex) -> tuple[Any, Array, float, float]:
    """Force and moment of all inertia forces, from accelerations of points and links; and the sizes of their parts."""
    force, moment, great, far = 0j, np.zeros(data.sizes["sample"]), 0.0, 0.0
    for name, body in mechanism.links.items():
        if not body.mass:
            continue
        (first, local), *_more = body.coordinates.items()
        assert isinstance(body.centre, tuple)
        reach = complex(body.centre[0] - local[0], body.centre[1] - local[1])
        arm = reach * np.exp(1j * link(data, name))
        omega, epsilon = link(data, name, "angular_velocity"), link(data, name, "angular_acceleration")
        a = point(data, first, "acceleration") + (1j * epsilon - omega**2) * arm
        place = point(data, first) + arm - about
        force = force - body.mass * a
        moment = moment - body.mass * (np.conj(place) * a).imag - (body.inertia or 0.0) * epsilon
        great += body.mass * float(np.nanmax(abs(a)))
        far += body.mass * float(np.nanmax(abs(place) * abs(a)))
        far += (body.inertia or 0.0) * float(np.nanmax(abs(epsilon)))
    return force, moment, great, far


@settings(max_examples=few(5, 25))
@given(st.lists(st.sampled_from(DYADS), min_size=1, max_size=3), st.integers(0, 2**32 - 1))
def test_newtons_law_holds_at_every_sample(kinds: list[str], seed: int) -> None:
    parts = burdened(grown(kinds, seed), seed)
    parts.pop("loads")
    mechanism = ct.Mechanism(**parts)
    start = parts["drives"][0]["start"]
    about = (0.3, -1.1)
    asked: dict[str, Any] = {"samples": 7, "start": start, "stop": start + 0.2}
    data = ct.motion(mechanism, **asked)
    found = ct.shaking(mechanism, **asked, about=about)
    if not any(body.mass for body in mechanism.links.values()):
        return
    force, moment, great, far = by_newton(mechanism, data, complex(*about))
    known = data.status.to_numpy() == 0
    shaken = found.shaking_force.to_numpy() @ [1, 1j]
    # the same accelerations, multiplied and added up in another order: a rounding for each factor and summand
    many = OPERATIONS * EPS * (4 + len(mechanism.links))
    assert np.all(abs(shaken - force)[known] <= many * great)
    assert np.all(abs(found.shaking_moment.to_numpy() - moment)[known] <= many * far)


def test_the_force_is_the_rate_of_change_of_the_momentum() -> None:
    press = ct.example("six-bar-press").model_copy(update={"machine": None})
    at, h = np.radians(np.arange(0.0, 360.0, 15.0)), 1e-3

    def momentum(values: Array) -> Any:
        data = ct.motion(press.model_copy(update={"study": ct.Study()}), at=values)
        return sum(
            (body.mass or 0.0) * velocity_of_centre(free, data, name)
            for name, body in free.links.items()
            if body.mass
        )

    free = ct.Mechanism(**{
        **{field: getattr(press, field) for field in type(press).model_fields},
        "links": {name: local_centre(body) for name, body in press.links.items()},
    })  # fmt: skip

    def slope(step: float) -> Any:
        # the drive turns at -1 rad/s: time runs against its value
        return -(momentum(at + step) - momentum(at - step)) / (2 * step)

    coarse, fine = slope(h), slope(h / 2)
    better = (4 * fine - coarse) / 3
    shaken = ct.shaking(press, at=at).shaking_force.to_numpy() @ [1, 1j]
    # the rule's error falls with the fourth power of the step, so it is well below what the last halving changed
    assert np.all(abs(shaken + better) <= abs(fine - coarse) + 1e-9 * np.max(abs(shaken)))


def local_centre(body: ct.Link) -> ct.Link:
    """The link with its centre by coordinates."""
    if not body.mass:
        return body
    name = body.centre if isinstance(body.centre, str) else next(iter(body.coordinates))
    return body.model_copy(update={"centre": body.coordinates[name]})


def series(order: int) -> float:
    """Coefficient of cos(order q) in sqrt(l^2 - r^2 sin^2 q) over l, by the binomial series."""
    ratio, total = (R / L) ** 2, 0.0
    half = 1.0
    for n in range(80):
        if n:
            half *= (0.5 - (n - 1)) / n
        k = order // 2
        if n >= k:
            wave = math.comb(2 * n, n - k) * (-1) ** k * (1.0 if k == 0 else 2.0) / 4.0**n
            total += half * (-ratio) ** n * wave
    return total


def test_harmonics_of_an_engine_are_the_textbooks() -> None:
    found = ct.shaking(engine(crank=0.5), orders=8)
    size = (PISTON * R + 0.5 * R) * RATE**2
    cosine, sine = found.force_harmonic_cosine, found.force_harmonic_sine
    first = 0.5 * R * RATE**2
    exact = {1: PISTON * R * RATE**2 + first}
    exact |= {order: PISTON * L * RATE**2 * order**2 * series(order) for order in (2, 4, 6, 8)}
    # accelerations lose by the obliquity of the rod, 1/cos^3 of it, and a few roundings each
    noise = 64 * EPS * size / (1 - (R / L) ** 2) ** 1.5
    for order in range(1, 9):
        assert abs(float(cosine.sel(order=order, axis="x")) - exact.get(order, 0.0)) <= noise
        assert abs(float(sine.sel(order=order, axis="x"))) <= noise
        across = first if order == 1 else 0.0
        assert abs(float(sine.sel(order=order, axis="y")) - across) <= noise
    assert found.attrs["harmonics_error"] <= 64 * EPS / (1 - (R / L) ** 2) ** 1.5
    # the well-known first terms: l/r + (l/r)^3/4, the next one being 15 (l/r)^5/128
    second = float(found.force_harmonic_amplitude.sel(order=2, axis="x")) / (PISTON * R * RATE**2)
    ratio = R / L
    assert 0 < second - (ratio + ratio**3 / 4) < 2 * 15 * ratio**5 / 128


def test_harmonics_add_up_to_the_curves() -> None:
    engine_with_rod = ct.example("single-cylinder-engine")
    found = ct.shaking(engine_with_rod, samples=37, orders=30)
    angle = found.drive_value.isel(drive=0)
    waves = found.order * angle
    force = (found.force_harmonic_cosine * np.cos(waves) + found.force_harmonic_sine * np.sin(waves)).sum(
        "order"
    )
    moment = (found.moment_harmonic_amplitude * np.cos(waves - found.moment_harmonic_phase)).sum("order")
    greatest, ratio = found.attrs["greatest_shaking_force"], 45 / 160
    # what lies beyond order 30 falls with (ratio/2)^order
    left = (ratio / 2) ** 30 * 900 + 1e3 * EPS
    assert np.all(abs(force - found.shaking_force) <= left * greatest)
    assert np.all(abs(moment - found.shaking_moment) <= left * greatest * 0.205)
    whole = found.force_harmonic_greatest.sel(order=2)
    assert abs(float(whole) - float(found.force_harmonic_amplitude.sel(order=2, axis="x"))) <= left * greatest


def test_greatest_values_lie_between_samples_too() -> None:
    press = ct.example("six-bar-press")
    coarse, fine = ct.shaking(press, samples=13), ct.shaking(press, samples=7201)
    greatest = coarse.attrs["greatest_shaking_force"]
    seen = float(fine.shaking_force_size.max())
    # a parabola through the top over half a step of 0.05 deg, with a curvature of some ten times the value
    assert seen <= greatest * (1 + 8 * EPS) and greatest - seen <= 10 * greatest * math.radians(0.025) ** 2
    at = ct.shaking(press, at=[coarse.attrs["greatest_shaking_force_at"]])
    assert abs(float(at.shaking_force_size[0]) - greatest) <= 1e3 * EPS * greatest


def test_moments_about_two_places_differ_by_the_force() -> None:
    linkage = ct.example("in-line-four-bar")
    origin, at_d = ct.shaking(linkage, samples=25), ct.shaking(linkage, samples=25, about="D")
    assert at_d.attrs["about"] == [0.4, 0.0]
    lever = 0.4 * origin.shaking_force.sel(axis="y")
    size = float(abs(origin.shaking_moment).max() + abs(lever).max())
    assert np.all(abs(origin.shaking_moment - at_d.shaking_moment - lever) <= 64 * EPS * size)


def test_the_drive_gives_what_the_reduced_inertia_asks() -> None:
    press = ct.example("six-bar-press")
    found, reduction = ct.shaking(press, samples=91), ct.reduce(press, samples=91)
    asked = 0.5 * reduction.reduced_inertia_slope * reduction.drive_rate**2
    size = float(reduction.reduced_inertia.max()) * float(reduction.drive_rate[0]) ** 2
    assert np.all(abs(found.inertia_on_drive - asked) <= 256 * EPS * size)
    assert np.array_equal(found.drive_rate, reduction.drive_rate)


def test_real_motion_of_a_machine() -> None:
    press = ct.example("six-bar-press")
    found, steady = ct.shaking(press, samples=37, speed="steady"), ct.steady_motion(press, samples=37)
    free = press.model_copy(update={"links": {n: local_centre(b) for n, b in press.links.items()}})
    force, moment, great, far = by_newton(free, steady, 0j)
    assert np.all(abs(found.shaking_force.to_numpy() @ [1, 1j] - force) <= 128 * EPS * great)
    assert np.all(abs(found.shaking_moment.to_numpy() - moment) <= 128 * EPS * far)
    assert np.allclose(found.drive_rate, steady.drive_speed, rtol=8 * EPS)
    assert found.attrs["harmonics_error"] <= 1e-12


def test_cycles_of_several_turns_have_fractions_of_orders() -> None:
    parts = grown(["gear"], 3)
    parts["gears"][0] |= {"ratio": 0.5, "carrier": "frame", "links": ["link0", "link1"]}
    parts["links"]["link1"] |= {"mass": 2.0, "centre": [0.3, 0.1], "inertia": 0.1}
    pivot = next(iter(parts["frame"]["points"]))
    own = parts["links"]["link1"].pop("points")
    parts["links"]["link1"]["points"] = {pivot: next(iter(own.values()))}
    parts["drives"][0]["speed"] = 3.0
    found = ct.shaking(ct.Mechanism(**parts), orders=2)
    assert found.attrs["turns_of_cycle"] == 2
    assert found.order.values.tolist() == [0, 0.5, 1, 1.5, 2]
    local = np.array([0.3, 0.1]) - next(iter(own.values()))
    exact = 2.0 * float(np.hypot(*local)) * 1.5**2
    assert abs(float(found.force_harmonic_greatest.sel(order=0.5)) - exact) <= 64 * EPS * exact
    others = found.force_harmonic_greatest.drop_sel(order=0.5)
    assert float(others.max()) <= 64 * EPS * exact


def test_no_whole_turn_no_harmonics() -> None:
    text = example_text("double-rocker").replace("length", 'mass = 1\nshape = "rod"\nlength')
    heavy = ct.parse_mechanism(text)
    found = ct.shaking(heavy, samples=5)
    assert "does not turn fully" in found.attrs["no_harmonics"]
    assert "order" not in found and np.isfinite(found.shaking_force).all()


def test_several_drives_are_shaken_too() -> None:
    arm = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"points": {"O": [0, 0], "A": [0.5, 0]}, "mass": 3, "centre": [0.2, 0.1], "inertia": 0.1},
            "AB": {"points": {"A": [0, 0], "B": [0.8, 0]}, "mass": 2, "centre": [0.4, 0], "inertia": 0.2},
        },
        drives=[{"link": "OA", "law": "sin(t)"}, {"link": "AB", "relative_to": "OA", "law": "t^2"}],
        study={"to": "2 s"},
    )
    found, data = ct.shaking(arm, samples=21), ct.motion(arm, samples=21)
    force, moment, great, far = by_newton(arm, data, 0j)
    assert np.all(abs(found.shaking_force.to_numpy() @ [1, 1j] - force) <= 64 * EPS * great)
    assert np.all(abs(found.shaking_moment.to_numpy() - moment) <= 64 * EPS * far)
    assert "one drive" in found.attrs["no_harmonics"]
    assert "inertia_on_drive" not in found


def test_absence_stays_absence() -> None:
    text = example_text("slider-between-cranks-locked")
    locked = ct.parse_mechanism(text.replace("[links.AC]", "[links.AC]\nmass = 1\nshape = 'rod'"))
    found = ct.shaking(locked)
    assert np.array_equal(np.isnan(found.shaking_force_size), found.status.to_numpy() == ct.Status.OPEN)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"about": "Q"}, "is not a point of the frame"),
        ({"about": (1.0, math.nan)}, "two finite coordinates"),
        ({"about": (1.0,)}, "two finite coordinates"),
        ({"speed": "fast"}, "not a speed of the drive"),
        ({"speed": "steady"}, r"\[machine\]"),
        ({"orders": 0}, "harmonics are given"),
        ({"orders": 1000}, "harmonics are given"),
        ({"samples": 0}, "samples"),
    ],
)
def test_wrong_arguments_are_refused(change: dict[str, Any], reason: str) -> None:
    with pytest.raises(ct.InputError, match=reason):
        ct.shaking(engine(), **change)


def test_wrong_mechanisms_are_refused() -> None:
    with pytest.raises(ct.InputError, match="no link has a mass"):
        ct.shaking(ct.example("kite"))
    with pytest.raises(ct.NotComputedYet, match="sphere"):
        ct.shaking(ct.example("spherical-four-bar"))
    with pytest.raises(ct.InputError, match="over its cycle"):
        ct.shaking(ct.example("six-bar-press"), start=0.0, speed="steady")


def test_rounding_of_a_rest_is_small() -> None:
    """What rounds where nothing moves: a crank with its centre in the pivot."""
    still = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 5, "centre": "O", "inertia": 2}},
        drives=[{"link": "OA", "speed": 7}],
    )
    found = ct.shaking(still, samples=9)
    assert float(abs(found.shaking_force).max()) == 0.0
    solved = solve_evenly(ready(still), 9)
    assert float(abs(found.shaking_moment).max()) <= float(np.max(rounding(solved))) * 2 * 49
