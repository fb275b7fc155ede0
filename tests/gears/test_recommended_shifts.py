"""Recommended shifts: every row and bound, what is refused, conditions over the whole of each row."""

from __future__ import annotations

import itertools
import math

import mpmath
import numpy as np
import pytest

import centrode as ct
from centrode.assignments.gear_variants import gear_variants
from centrode.errors import InputError
from centrode.gears.pair_faults import pair_faults
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.recommended_shifts import ROWS, RecommendedRow, distance_use
from centrode.model.gear_pairs import GEAR_PAIRS, GearPair

ANGLE = math.radians(20)


def described(
    teeth: tuple[int, int], application: str | None = None, distance: float | None = None, **keys: object
) -> GearPair:
    """A pair of module 2 mm with recommended shifts; its centre distance in metres."""
    given: dict[str, object] = {"kind": "gear pair", "module": "2 mm", "teeth": list(teeth), **keys}
    if application is not None:
        given["application"] = application
    if distance is not None:
        given["centre_distance"] = distance
    return GEAR_PAIRS.from_tables({"shifts": "standard", **given})


def distance_of(teeth: tuple[int, int], total: float) -> float:
    """The centre distance [m] of wheels of 2 mm whose shifts have this sum, to thirty digits before it is rounded."""
    with mpmath.workdps(30):
        angle = mpmath.radians(20)
        own = mpmath.tan(angle) - angle + 2 * mpmath.mpf(total) * mpmath.tan(angle) / sum(teeth)
        working = mpmath.findroot(lambda a: mpmath.tan(a) - a - own, angle + mpmath.mpf("0.05"))
        return float(mpmath.mpf("0.001") * sum(teeth) * mpmath.cos(angle) / mpmath.cos(working))


@pytest.mark.parametrize(
    ("application", "teeth", "shifts"),
    [
        (None, (10, 10), (0.5, 0.5)),
        ("power", (10, 40), (0.5, 0.5)),
        ("power", (30, 30), (0.5, 0.5)),
        ("power", (31, 31), (0.0, 0.0)),
        ("power", (90, 400), (0.0, 0.0)),
        ("kinematic", (12, 22), (0.3, -0.3)),
        ("kinematic", (16, 22), (0.3, -0.3)),
        ("kinematic", (16, 300), (0.3, -0.3)),
        ("kinematic", (17, 17), (0.0, 0.0)),
        ("kinematic", (40, 60), (0.0, 0.0)),
    ],
)
def test_rows_without_a_centre_distance(
    application: str | None, teeth: tuple[int, int], shifts: tuple[float, float]
) -> None:
    assert ct.gear_pair(described(teeth, application)).geometry.shifts == shifts


@pytest.mark.parametrize(
    ("application", "teeth", "shifts"),
    [
        ("power", (14, 49), (0.3, -0.3)),
        ("power", (20, 70), (0.3, -0.3)),
        ("power", (21, 21), (0.0, 0.0)),
        (None, (21, 80), (0.0, 0.0)),
        ("kinematic", (12, 22), (0.3, -0.3)),
        ("kinematic", (16, 22), (0.3, -0.3)),
        ("kinematic", (17, 17), (0.0, 0.0)),
        ("kinematic", (17, 60), (0.0, 0.0)),
    ],
)
def test_rows_at_the_centre_distance_without_shifts(
    application: str | None, teeth: tuple[int, int], shifts: tuple[float, float]
) -> None:
    """Also where the distance is written with its digits, in another unit."""
    assert ct.gear_pair(described(teeth, application, 1e-3 * sum(teeth))).geometry.shifts == shifts
    inches = f"{sum(teeth) / 25.4:.15g} in"
    assert ct.gear_pair(described(teeth, application, inches)).geometry.shifts == shifts  # type: ignore[arg-type]


@pytest.mark.parametrize("teeth", [(12, 24), (18, 90), (25, 26), (40, 160)])
@pytest.mark.parametrize(
    ("application", "total", "first", "second"),
    [
        ("power", 1e-3, 1e-3, 0.0),
        ("power", 0.3, 0.3, 0.0),
        ("power", 0.5, 0.5, 0.0),
        ("power", 0.51, 0.5, 0.01),
        ("power", 0.8, 0.5, 0.3),
        ("power", 1.0, 0.5, 0.5),
        ("kinematic", 1e-3, 1e-3, 0.0),
        ("kinematic", 0.51, 0.51, 0.0),
        ("kinematic", 1.0, 1.0, 0.0),
    ],
)
def test_rows_of_an_enlarged_centre_distance(
    teeth: tuple[int, int], application: str, total: float, first: float, second: float
) -> None:
    """The distance of a sum by the involute equation; the sum comes back to half the teeth times rounding."""
    distance = distance_of(teeth, total)
    geometry = ct.gear_pair(described(teeth, application, distance)).geometry
    assert geometry.shifts == pytest.approx((first, second), abs=1e-11)
    assert geometry.centre_distance == pytest.approx(distance, rel=1e-13)


@pytest.mark.parametrize(
    ("application", "teeth", "total", "said"),
    [
        ("power", (9, 40), None, "power transmission with 9 and 40 teeth"),
        ("kinematic", (11, 40), None, "kinematic transmission with 11 and 40 teeth"),
        ("kinematic", (12, 21), None, "kinematic transmission with 12 and 21 teeth"),
        ("kinematic", (16, 21), None, "kinematic transmission with 16 and 21 teeth"),
        (
            "power",
            (13, 60),
            0.0,
            "power transmission with 13 and 60 teeth at the centre distance without shifts",
        ),
        (
            "power",
            (14, 48),
            0.0,
            "power transmission with 14 and 48 teeth at the centre distance without shifts",
        ),
        (
            "power",
            (20, 69),
            0.0,
            "power transmission with 20 and 69 teeth at the centre distance without shifts",
        ),
        ("kinematic", (11, 40), 0.0, "kinematic transmission with 11 and 40 teeth at the centre distance"),
        ("kinematic", (16, 21), 0.0, "kinematic transmission with 16 and 21 teeth at the centre distance"),
        ("power", (20, 40), 1.001, "it is 1.001"),
        ("kinematic", (20, 40), 1.001, "it is 1.001"),
        ("power", (20, 40), -0.001, "it is -0.001"),
        ("kinematic", (20, 40), -0.2, "it is -0.2"),
    ],
)
def test_what_the_recommendation_leaves_out_is_refused(
    application: str, teeth: tuple[int, int], total: float | None, said: str
) -> None:
    distance = None if total is None else distance_of(teeth, total)
    with pytest.raises(InputError, match="GOST 16532 recommends") as refusal:
        ct.gear_pair(described(teeth, application, distance))
    assert said in str(refusal.value)
    assert "blocking contour" in str(refusal.value)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"helix_angle": "10 deg"}, "spur external pairs alone"),
        ({"internal": True, "teeth": [20, 60]}, "spur external pairs alone"),
        ({"teeth": [20, "rack"]}, "spur external pairs alone"),
        ({"rack": {"addendum": 0.8}}, "reference rack of GOST 13755"),
        ({"rack": {"pressure_angle": "25 deg"}}, "reference rack of GOST 13755"),
        ({"rack": {"clearance": 0.3}}, "reference rack of GOST 13755"),
        ({"rack": {"fillet": 0.2}}, "reference rack of GOST 13755"),
        ({"teeth": [40, 20]}, "smaller number of teeth first"),
        ({"application": "kinematik"}, 'did you mean "kinematic"'),
        ({"application": "power", "shifts": [0.1, 0]}, 'shifts = "standard"'),
        ({"application": "power", "shifts": "strength"}, 'shifts = "standard"'),
        ({"application": "power", "shifts": None}, 'shifts = "standard"'),
    ],
)
def test_descriptions_without_a_recommendation_are_refused(keys: dict[str, object], said: str) -> None:
    given = {"kind": "gear pair", "module": "2 mm", "teeth": [20, 40], "shifts": "standard"} | keys
    with pytest.raises(InputError) as refusal:
        GEAR_PAIRS.from_tables({key: value for key, value in given.items() if value is not None})
    assert said in str(refusal.value)


def test_the_rack_of_the_standard_may_be_written_out() -> None:
    rack = {"pressure_angle": "20 deg", "addendum": 1, "clearance": 0.25, "fillet": 0.38}
    pair = ct.gear_pair(described((20, 40), rack=rack))
    assert pair.geometry.shifts == (0.5, 0.5)
    assert GEAR_PAIRS.parse(GEAR_PAIRS.text(pair.gear_pair)) == pair.gear_pair
    kinematic = described((20, 40), "kinematic")
    assert GEAR_PAIRS.parse(GEAR_PAIRS.text(kinematic)) == kinematic


def test_no_two_rows_are_for_one_pair() -> None:
    """By brute force over numbers of teeth; ranges of sums meet in their ends, of which the lower is excluded."""
    for application, use in itertools.product(("power", "kinematic"), ("free", "unshifted")):
        rows = [row for row in ROWS if row.application == application and use in row.distances]
        assert len(rows) == 2
        for first, second in itertools.product(range(4, 60), range(4, 250)):
            assert sum(row.covers((first, second)) for row in rows) <= 1
    for application in ("power", "kinematic"):
        ends = [row.sums for row in ROWS if row.application == application and "shifted" in row.distances]
        assert [end for ends_of_row in ends for end in ends_of_row] in ([0.0, 1.0], [0.0, 0.5, 0.5, 1.0])
    assert [distance_use(total) for total in (None, 0.0, -1e-12, 1e-6, -1e-6)] == [
        "free", "unshifted", "unshifted", "shifted", "shifted",
    ]  # fmt: skip


# The conditions over the whole of each row, by formulas written here again.


def involute(angle: np.ndarray) -> np.ndarray:
    """The involute function."""
    return np.tan(angle) - angle


def conditions(z1: np.ndarray, z2: np.ndarray, x1: float, x2: float) -> dict[str, np.ndarray]:
    """Contact ratio, thinner tip in modules, shifts above those of undercut, of spur wheels of the standard rack."""
    own = involute(np.array(ANGLE)) + 2 * (x1 + x2) * math.tan(ANGLE) / (z1 + z2)
    working = np.full(own.shape, 0.5)
    for _ in range(60):
        working -= (involute(working) - own) / np.tan(working) ** 2
    distance = (z1 + z2) / 2 * math.cos(ANGLE) / np.cos(working)
    lowered = x1 + x2 - (distance - (z1 + z2) / 2)
    path, tips = -distance * np.sin(working), []
    for z, x in ((z1, x1), (z2, x2)):
        tip = z / 2 + 1 + x - lowered
        # cos(alpha_a) = r_b/r_a: above one a wheel of few teeth whose tips lie inside its base circle.
        angle = np.arccos(np.minimum(z / 2 * math.cos(ANGLE) / tip, 1.0))
        path = path + tip * np.sin(angle)
        half = (math.pi / 2 + 2 * x * math.tan(ANGLE)) / z + involute(np.array(ANGLE)) - involute(angle)
        tips.append(2 * tip * half)
    return {
        "contact ratio": path / (math.pi * math.cos(ANGLE)),
        "tip": np.minimum(*tips),
        "pinion": x1 - (1 - z1 * math.sin(ANGLE) ** 2 / 2),
        "wheel": x2 - (1 - z2 * math.sin(ANGLE) ** 2 / 2),
    }


def domain(row: RecommendedRow) -> tuple[np.ndarray, np.ndarray]:
    """All numbers of teeth of a row."""
    first, second = np.meshgrid(np.arange(4, 1001), np.arange(4, 1001), indexing="ij")
    least, most = row.pinion
    fits = (least <= first) & (first <= most) & (second >= np.maximum(first, row.least_wheel))
    fits &= second >= row.least_ratio * first
    return first[fits].astype(float), second[fits].astype(float)


@pytest.mark.parametrize("row", [row for row in ROWS if "shifted" not in row.distances])
def test_rows_of_numbers_of_teeth_work_over_their_whole_domain(row: RecommendedRow) -> None:
    """Contact, tips, and no undercut but what bounds rounded to whole teeth leave, of 0.013 modules at most."""
    z1, z2 = domain(row)
    found = conditions(z1, z2, *row.shifts(0.0))
    assert found["contact ratio"].min() > 1.04
    assert found["tip"].min() > 0.21
    assert set(z1[found["pinion"] < 0]) <= {17.0}
    assert set(z2[found["wheel"] < 0]) <= {17.0, 22.0}
    assert min(found["pinion"].min(), found["wheel"].min()) > -0.0133
    below = z1[found["contact ratio"] < 1.2]
    assert not below.size or (row.shifts(0.0) == (0.5, 0.5) and below.max() == 16)


@pytest.mark.parametrize("row", ROWS)
def test_a_pair_that_falls_short_says_so(row: RecommendedRow) -> None:
    """Faults and notes against the formulas of this file, over numbers of teeth and sums of the row."""
    z1, z2 = domain(row)
    kept = np.isin(z1, [*range(4, 24), 30, 31, 60]) & np.isin(z2, [*range(4, 28), 49, 70, 120, 1000])
    above, most = row.sums
    for total in {most, (above + most) / 2, above + (most - above) / 50}:
        shifts = row.shifts(total)
        found = conditions(z1[kept], z2[kept], *shifts)
        for place, teeth in enumerate(zip(z1[kept].tolist(), z2[kept].tolist(), strict=True)):
            pair = PairGeometry("external", 0.001, teeth, shifts)
            ratio, tip = found["contact ratio"][place], found["tip"][place]
            faults = {fault.kind for fault in pair_faults(pair)}
            assert not faults or "shifted" in row.distances
            assert (tip <= 0) == ("pointed" in faults)
            if "tip inside base" not in faults:
                assert (ratio < 1) == ("contact ratio" in faults)
            for wheel, name in zip(pair.wheels, ("pinion", "wheel"), strict=True):
                assert wheel.undercut == (found[name][place] < 0)


@pytest.mark.parametrize(
    ("teeth", "application", "note"),
    [
        ((17, 40), "kinematic", "pinion: undercut"),
        ((12, 22), "kinematic", "wheel: undercut"),
        ((12, 20), "power", "the contact ratio is below the usual 1.2"),
        ((10, 400), "power", "the tips are 0.232"),
    ],
)
def test_notes_of_recommended_pairs(teeth: tuple[int, int], application: str, note: str) -> None:
    assert note in ct.summary(ct.gear_pair(described(teeth, application)))


def test_a_row_that_fails_is_reported_as_every_pair() -> None:
    """A pinion of 6 teeth with x_1 = 0.5 has pointed teeth; the row of sums has no bound of teeth."""
    results = ct.gear_pair(described((6, 60), "power", distance_of((6, 60), 0.5)))
    assert "pointed" in {fault.kind for fault in results.faults}


def test_tables_of_variants_choose_and_leave_the_recommendation() -> None:
    rows = [
        {"variant": "1", "z1": 12, "z2": 30, "shifts": "", "x1": "", "x2": ""},
        {"variant": "2", "z1": 11, "z2": 30, "shifts": "", "x1": "", "x2": ""},
        {"variant": "3", "z1": 12, "z2": 30, "shifts": "", "x1": 0.4, "x2": 0.1},
        {"variant": "4", "z1": 12, "z2": 30, "shifts": "least sliding", "x1": "", "x2": ""},
    ]
    found = gear_variants(described((20, 40), "kinematic"), rows).results
    assert [one.status for one in found] == ["ok", "refused", "ok", "ok"]
    assert found[0].result.geometry.shifts == (0.3, -0.3)
    assert "kinematic transmission with 11 and 30 teeth" in found[1].refusal
    assert found[2].result.geometry.shifts == (0.4, 0.1)
    assert found[3].variant.described.application is None
    (chosen,) = gear_variants(
        "shifted-gear-pair", [{"variant": "a", "shifts": "standard", "application": "power"}]
    ).results
    assert chosen.result.geometry.shifts == (0.5, 0.5)
