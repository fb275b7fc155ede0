"""Bearings: loads in the axes of their links, and where journal and bush wear."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.bearings.wear import bearings
from mechanisms import parts_of

EPSILON = 2.0**-52
FORCE = 5 * 0.5 * 9.0


def turning() -> ct.Mechanism:
    link = {"points": {"O": [0, 0], "A": [2, 0]}, "mass": 5, "centre": [0.5, 0], "inertia": 0.25}
    return ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": link},
        drives=[{"link": "OA", "start": 0, "speed": 3.0}],
    )


def test_a_turning_mass() -> None:
    """Its shaft is loaded, and wears, always at the same place; the bush evenly all around."""
    crank = turning()
    reactions = ct.reactions(crank, 361)
    data = bearings(crank, reactions)
    assert data.bearing.to_numpy().tolist() == ["O: OA, frame"]
    bound = 1e3 * EPSILON * FORCE
    assert abs(data.load_on_journal[:, 0] - [-FORCE, 0]).max() <= bound
    assert np.array_equal(data.load_on_bush[:, 0], data.bearing_load[:, 0])
    assert abs(float(data.load_path[0]) - FORCE * math.tau) <= 361 * EPSILON * FORCE * math.tau
    # of the arc of 120 degrees each sector of 10 degrees is a twelfth, about the outer side of the shaft
    share = np.zeros(36)
    share[[*range(6), *range(30, 36)]] = 1 / 12
    # an end of the arc lies on an end of a sector
    assert np.abs(data.wear[0, 0] - share).max() <= 1e-12
    # a step is spread from both its ends, which are whole degrees
    assert np.abs(data.wear[0, 1] - 1 / 36).max() <= 1e-12


@pytest.mark.parametrize(("sectors", "arc"), [(1, 1.0), (7, 0.01), (36, math.tau), (360, 2.0)])
def test_shares_add_up(sectors: int, arc: float) -> None:
    press = ct.example("six-bar-press")
    data = bearings(press, ct.reactions(press, 73), sectors=sectors, arc=arc)
    assert data.wear.shape == (6, 2, sectors)
    assert np.abs(data.wear.sum("sector") - 1).max() <= 100 * sectors * EPSILON
    assert (data.wear >= 0).all()
    if arc == math.tau:
        assert np.abs(data.wear - 1 / sectors).max() <= 100 * EPSILON


def test_axes_of_the_links() -> None:
    """The two loads are action and reaction, seen by each link."""
    press = ct.example("six-bar-press")
    reactions, motion = ct.reactions(press, 37), ct.motion(press, 37)
    data = bearings(press, reactions, motion)
    assert data.bearing_journal.to_numpy().tolist() == ["OA", "OA", "AB", "CD", "CD", "DH"]
    assert data.bearing_bush.to_numpy().tolist() == ["frame", "AB", "CD", "frame", "DH", "slider"]
    for k, bush in enumerate(data.bearing_bush.to_numpy()):
        load = data.bearing_load[:, k].to_numpy() @ [1, 1j]
        own = reactions.joint_force.sel(side=f"{data.bearing_point.to_numpy()[k]}/{bush}").to_numpy() @ [
            1,
            1j,
        ]
        assert np.array_equal(load, own)
        journal = motion.angle.sel(link=data.bearing_journal.to_numpy()[k]).to_numpy()
        angle = 0.0 if bush == "frame" else motion.angle.sel(link=bush).to_numpy()
        bound = 10 * EPSILON * np.abs(load).max()
        assert (
            np.abs(data.load_on_journal[:, k].to_numpy() @ [1, 1j] * np.exp(1j * journal) + load).max()
            <= bound
        )
        assert np.abs(data.load_on_bush[:, k].to_numpy() @ [1, 1j] * np.exp(1j * angle) - load).max() <= bound
        assert np.array_equal(data.relative_turning[:, k], journal - angle)


def test_wear_follows_finer_samples() -> None:
    """The path of a smooth load: the trapezoid rule is off by the step's square; a jump by the step."""
    engine = ct.example("single-cylinder-engine")
    coarse, middle, fine = (
        bearings(engine, ct.reactions(engine, 360 * k + 1)).load_path.to_numpy() for k in (1, 2, 4)
    )
    assert np.all(np.abs(fine - middle) <= 0.6 * np.abs(middle - coarse) + 1e-9 * fine)


def test_a_hinge_of_three_links_has_two_bearings() -> None:
    """The link that is described first has the pin."""
    jansen = ct.example("jansen-leg")
    load = {"kind": "force", "point": "G", "vector": [0.0, 10.0]}
    loaded = ct.Mechanism(**{**parts_of(jansen), "loads": [load]})
    data = bearings(loaded, ct.reactions(loaded, 13))
    points = data.bearing_point.to_numpy().tolist()
    for point in set(points):
        here = [k for k, name in enumerate(points) if name == point]
        assert len({data.bearing_journal.to_numpy()[k] for k in here}) == 1
    assert max(points.count(point) for point in points) >= 2


def test_what_is_not_determined_wears_nobody_knows_how() -> None:
    load = {"kind": "torque", "link": "wheel", "value": 3.0}
    loaded = ct.Mechanism(**{**parts_of(ct.example("rolling-wheel-rod")), "loads": [load]})
    reactions = ct.reactions(loaded, 9)
    data = bearings(loaded, reactions)
    lost = np.isnan(data.bearing_load.to_numpy()).all(axis=(0, 2))
    assert np.array_equal(np.isnan(data.wear.to_numpy()).all(axis=(1, 2)) >= lost, np.ones(len(lost), bool))


@pytest.mark.parametrize(
    ("options", "where"),
    [
        ({"sectors": 0}, "sectors"),
        ({"sectors": 4000}, "sectors"),
        ({"arc": 0.0}, "arc"),
        ({"arc": 7.0}, "arc"),
    ],
)
def test_refused(options: dict[str, float], where: str) -> None:
    crank = turning()
    with pytest.raises(ct.InputError) as refused:
        bearings(crank, ct.reactions(crank, 5), **options)
    assert refused.value.where == where


def test_a_motion_of_other_samples_is_refused() -> None:
    crank = turning()
    with pytest.raises(ct.InputError, match="other samples"):
        bearings(crank, ct.reactions(crank, 5), ct.motion(crank, 6))
