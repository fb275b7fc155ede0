"""Worst cases, statistics and assembly: the press's figures, closed forms, distributions and drawn mechanisms."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

import centrode as ct
from centrode.model.tolerances import Tolerances
from centrode.tolerances.dimension_limits import DimensionLimits
from centrode.tolerances.statistical import draw_deviations, propagated_output, yield_of
from centrode.tolerances.worst_case import linear_extent

GRADIENT = {
    "links.OA.length": 4.817,
    "links.CD.points.B.x": -2.393,
    "frame.points.C.x": -2.059,
    "links.AB.points.B.x": 2.032,
    "links.CD.points.D.x": 0.888,
    "links.DH.points.H.x": 0.0165,
}
STROKE = {"stroke": "range(position_H_x)"}
MILLIMETRE = dict.fromkeys(GRADIENT, (-1e-3, 1e-3))


@pytest.fixture(scope="module")
def press() -> ct.tolerances:  # type: ignore[valid-type]
    return ct.tolerances("six-bar-press", STROKE, MILLIMETRE, samples=361, bounds={"stroke": (1.575, 1.585)})


def test_stroke_of_the_press(press: object) -> None:
    """Figures of the first study of this mechanism, to their last digit."""
    output = press["stroke"]  # type: ignore[index]
    for path, slope in zip(press.limits.paths, output.gradient, strict=True):  # type: ignore[attr-defined]
        assert round(float(slope), 3 if abs(slope) > 0.1 else 4) == GRADIENT[path]
    assert round(1e3 * float(output.linear.upper), 3) == 12.205
    assert round(1e3 * float(output.linear.lower), 3) == -12.205
    assert round(1e3 * float(output.true.lower), 3) == -12.168
    assert round(1e3 * float(output.true.upper), 3) == 12.241
    assert round(1e3 * float(output.statistics.half), 3) == 6.171
    assert output.statistics.contributions.sum() == pytest.approx(1.0, rel=1e-14)
    assert output.is_kept is False


def test_true_extremes_are_those_of_all_corners(press: object) -> None:
    own = np.array([ct.value_at(ct.example("six-bar-press"), path) for path in GRADIENT])
    corners = np.array(list(itertools.product((-1e-3, 1e-3), repeat=6)))
    found = ct.sweep(
        "six-bar-press", dict(zip(GRADIENT, (own + corners).T, strict=True)), samples=361, reduce=STROKE
    )
    output = press["stroke"]  # type: ignore[index]
    assert output.nominal + output.true.upper == pytest.approx(float(found["stroke"].max()), rel=1e-14)
    assert output.nominal + output.true.lower == pytest.approx(float(found["stroke"].min()), rel=1e-14)


def test_root_sum_of_squares_against_a_million_presses() -> None:
    """For +-0.1 % of each length the standard deviation is that of drawn mechanisms within 0.5 %."""
    mechanism = ct.example("six-bar-press")
    limits = {
        path: (-1e-3 * ct.value_at(mechanism, path), 1e-3 * ct.value_at(mechanism, path)) for path in GRADIENT
    }
    output = ct.tolerances(mechanism, STROKE, limits, samples=91, draws=1_000_000, seed=32)["stroke"]
    drawn = output.drawn
    assert drawn is not None
    assert drawn.count == 1_000_000
    # the share of sampling is 1/sqrt(2 n), 0.07 %
    assert float(drawn.deviation) == pytest.approx(float(output.statistics.deviation), rel=5e-3)
    assert float(drawn.mean) == pytest.approx(float(output.nominal), abs=5e-3 * float(drawn.deviation))


def test_a_corner_is_improved_where_the_output_is_not_monotone() -> None:
    """(x - x0)^2 of one number is least inside its limits: no corner knows."""
    own = ct.value_at(ct.example("crank-rocker"), "links.OA.length")
    formula = f"(links_OA_length - {own + 2e-4})^2 + 0*max(position_B_x)"
    output = ct.tolerances(
        "crank-rocker", {"x": formula}, {"links.OA.length": (-1e-3, 1e-3)}, samples=13, draws=10
    )["x"]
    assert float(output.true.least.value) == pytest.approx(0.0, abs=1e-14)
    assert output.true.least.deviations[0] == pytest.approx(2e-4, abs=1e-7)
    assert float(output.true.greatest.value) == pytest.approx(1.2e-3**2, rel=1e-9)


def test_bands_of_a_slider_crank() -> None:
    """x = r cos(phi) + sqrt(l^2 - r^2 sin(phi)^2): corners by hand."""
    r, l = 0.3, 1.1
    limits = {"links.crank.length": (-1e-3, 2e-3), "links.coupler.length": (-3e-3, 1e-3)}
    found = ct.tolerances(ct.slider_crank(r, l), {"x": "position.B.x"}, limits, samples=37, draws=50)
    output, phi = found["x"], found.motion["drive_value"].to_numpy()[:, 0]

    def place(dr: float, dl: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
        return np.asarray((r + dr) * np.cos(phi) + np.sqrt((l + dl) ** 2 - ((r + dr) * np.sin(phi)) ** 2))

    corners = np.array([place(dr, dl) for dr in (-1e-3, 2e-3) for dl in (-3e-3, 1e-3)]) - place(0, 0)
    assert np.abs(output.true.upper - corners.max(axis=0)).max() < 1e-15
    assert np.abs(output.true.lower - corners.min(axis=0)).max() < 1e-15
    assert output.unit == "m"
    size = np.maximum(-output.linear.lower, output.linear.upper)
    assert output.worst == int(np.argmax(size))


def test_linear_extent_and_propagation_by_hand() -> None:
    limits = DimensionLimits(("a", "b"), np.zeros(2), np.array([-1.0, 0.0]), np.array([2.0, 4.0]), "uniform")
    extent = linear_extent(np.array([3.0, -1.0]), limits.lower, limits.upper)
    assert (float(extent.lower), float(extent.upper)) == (-7.0, 6.0)
    found = propagated_output(np.array([3.0, -1.0]), limits)
    assert float(found.shift) == 3 * 0.5 - 2.0
    assert float(found.deviation) == pytest.approx(math.sqrt(9 * 1.5**2 / 3 + 4 / 3), rel=1e-15)
    assert found.contributions == pytest.approx([0.8350515463917526, 0.16494845360824742], rel=1e-14)


def limits_with(distribution: str, coefficient: float | None = None) -> DimensionLimits:
    tolerances = Tolerances(
        dimensions={"links.a.length": [-1.0, 1.0], "links.b.length": [-2.0, 4.0]},
        distribution=distribution,
        correlations=[]
        if coefficient is None
        else [{"paths": ["links.a.length", "links.b.length"], "value": coefficient}],
    )
    lower, upper = np.array([-1.0, -2.0]), np.array([1.0, 4.0])
    paths = ("links.a.length", "links.b.length")
    return DimensionLimits(paths, np.zeros(2), lower, upper, tolerances.distribution, tolerances.correlations)


@pytest.mark.parametrize("distribution", ["normal", "uniform", "triangular"])
@pytest.mark.parametrize("coefficient", [None, 0.7, -0.4])
def test_drawn_numbers_have_their_moments(distribution: str, coefficient: float | None) -> None:
    limits = limits_with(distribution, coefficient)
    drawn = draw_deviations(limits, 200_000, 7)
    # five standard errors
    error = 5 / math.sqrt(200_000)
    assert drawn.mean(axis=0) == pytest.approx([0.0, 1.0], abs=error * 1.8)
    shares = {"normal": 1 / 3, "uniform": 1 / math.sqrt(3), "triangular": 1 / math.sqrt(6)}
    assert drawn.std(axis=0) == pytest.approx(np.array([1.0, 3.0]) * shares[distribution], rel=error)
    assert np.corrcoef(drawn.T)[0, 1] == pytest.approx(coefficient or 0.0, abs=error)
    if distribution != "normal":
        assert (np.abs(drawn - [0.0, 1.0]) <= [1.0, 3.0]).all()
    assert (drawn == draw_deviations(limits, 200_000, 7)).all()
    assert (drawn != draw_deviations(limits, 200_000, 8)).any()


def test_correlated_numbers_add_up() -> None:
    """Two lengths that deviate alike act as one: their derivatives are added before they are squared."""
    text = (
        ct.mechanism_text(ct.example("six-bar-press"))
        + """
[tolerances]
links.OA.length = "±1 mm"
links.AB.points.B.x = "±1 mm"
correlations = [{ paths = ["links.OA.length", "links.AB.points.B.x"], value = 1 }]
"""
    )
    output = ct.tolerances(ct.parse_mechanism(text), STROKE, samples=91, draws=2000)["stroke"]
    assert float(output.statistics.half) == pytest.approx(1e-3 * abs(output.gradient.sum()), rel=1e-12)
    assert output.statistics.contributions.sum() == pytest.approx(1.0, rel=1e-12)


def test_yield_with_its_confidence() -> None:
    """Clopper and Pearson: of 10 of 10 the lower end is 0.025^(1/10)."""
    assert yield_of(10, 10).low == pytest.approx(0.025**0.1, rel=1e-12)
    assert yield_of(10, 10).high == 1.0
    assert yield_of(0, 10).high == pytest.approx(1 - 0.025**0.1, rel=1e-12)
    one = yield_of(95, 100)
    assert one.low < one.share == 0.95 < one.high


def test_yield_is_that_of_a_normal_output() -> None:
    """Of a nearly linear output bounds at two standard deviations hold 95.45 %."""
    output = ct.tolerances("six-bar-press", STROKE, MILLIMETRE, samples=91, draws=10)["stroke"]
    half = 2 * float(output.statistics.deviation)
    nominal = float(output.nominal)
    bounds = {"stroke": (nominal - half, nominal + half)}
    kept = ct.tolerances("six-bar-press", STROKE, MILLIMETRE, samples=91, draws=20_000, bounds=bounds)[
        "stroke"
    ].drawn.kept
    assert kept.low - 0.003 < 0.9545 < kept.high + 0.003


# Assembly.


def test_where_a_four_bar_stops_turning() -> None:
    """Lengths 1, 3, 2.1, 3.9: s + l = 4.9, p + q = 5.1; with +-0.1 each Grashof's sum is reached at half of them."""
    mechanism = ct.four_bar(1.0, 3.0, 2.1, 3.9)
    paths = ("links.crank.length", "links.coupler.length", "links.rocker.length", "frame.points.D.x")
    found = ct.tolerances(
        mechanism, "range(angle_rocker)", dict.fromkeys(paths, (-0.1, 0.1)), samples=181, draws=500
    )
    assert not found.assembly.moves
    assert found.assembly.all_corners
    first = found.assembly.first
    assert first is not None
    assert first.share == pytest.approx(0.5, abs=2e-3)
    assert first.group == "coupler-rocker"
    # crank and frame longer, coupler and rocker shorter
    assert (np.sign(first.deviations) == [1, -1, -1, 1]).all()
    near = ct.tolerances(
        mechanism, "range(angle_rocker)", dict.fromkeys(paths, (-0.04, 0.04)), samples=181, draws=500
    )
    assert near.assembly.moves
    assert near.assembly.first is None


def test_more_numbers_than_corners() -> None:
    """With more than twelve numbers the corners are those that derivatives point to: of a sum they are the worst."""
    text = ct.mechanism_text(ct.example("jansen-leg")) + '\n[tolerances]\ndefault = "±0.1 mm"\n'
    mechanism = ct.parse_mechanism(text)
    found = ct.tolerances(
        mechanism, {"x": f"max(position_{mechanism.moving_points[-1]}_x)"}, samples=91, draws=200
    )
    assert len(found.limits.paths) > 12
    assert not found.assembly.all_corners
    output = found.outputs[0]
    assert float(output.true.upper) == pytest.approx(float(output.linear.upper), rel=0.02)
    assert float(output.drawn.greatest - output.nominal) < float(output.true.upper)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, "no dimension has a tolerance"),
        ({"outputs": "position.B", "limits": {"links.AB.length": (-1, 1)}}, "2 numbers"),
        ({"outputs": "stroke.B", "limits": {"links.AB.length": (-1e-3, 1e-3)}}, "sensitivity alone"),
        ({"outputs": "position.Q.x", "limits": {"links.AB.length": (-1e-3, 1e-3)}}, '"Q"'),
        ({"limits": {"links.AB.lenght": (-1e-3, 1e-3)}}, "length"),
        ({"limits": {"links.AB.length": "IT7"}}, "3150 mm"),
        ({"limits": {"links.AB.length": (-1e-3, 1e-3)}, "draws": 0}, "draws"),
        ({"limits": {"links.AB.length": (-1e-3, 1e-3)}, "seed": 1.5}, "seed"),
        ({"limits": {"links.AB.length": (-1e-3, 1e-3)}, "bounds": {"x": 1.0}}, "no output"),
        (
            {
                "outputs": "max(angle_DB)",
                "limits": {"links.AB.length": (-1e-3, 1e-3)},
                "bounds": {"max(angle_DB)": (2, 1)},
            },
            "nothing between",
        ),
    ],
)  # fmt: skip
def test_refusals(arguments: dict[str, object], words: str) -> None:
    with pytest.raises(ct.InputError, match=words):
        ct.tolerances("crank-rocker", **arguments)  # type: ignore[arg-type]


def test_reactions_and_angles_deviate_too() -> None:
    """Sweeps know no reactions: mechanisms are moved one by one. First order and drawn ones agree for small limits."""
    outputs = {
        "R": "joint_force.A/OA.x",
        "greatest": "max(abs(joint_force_A_OA_x))",
        "inertia": "max(reduced_inertia)",
        "angle": "transmission_angle.AB-CD",
    }
    limits = {"links.OA.length": (-1e-4, 1e-4), "frame.points.C.x": (-1e-4, 1e-4)}
    found = ct.tolerances("six-bar-press", outputs, limits, samples=37, draws=200)
    assert [output.unit for output in found.outputs] == ["N", "N", "kg m^2", "rad"]
    for output in found.outputs:
        assert output.drawn is not None
        # of 200 drawn ones the deviation is known to 5 %: four of these
        drawn, first_order = (
            output.at_worst(output.drawn.deviation),
            output.at_worst(output.statistics.deviation),
        )
        assert drawn == pytest.approx(first_order, rel=0.2)
        assert output.at_worst(output.true.upper) == pytest.approx(
            output.at_worst(output.linear.upper), rel=0.05
        )
