"""Groups of higher class on the sphere: a six-bar driven elsewhere, gears beside one."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from mechanisms import EPS, Parts, events, statuses

Array = npt.NDArray[np.float64]


def joint(data: xr.Dataset, name: str, variable: str = "joint_angle") -> Array:
    return np.asarray(data[variable].sel(joint=name).to_numpy())


CRANK = [{"link": "AB", "start": 1.0, "speed": 1.0}]

SIX_BAR: Parts = {
    "AB": {"length": 0.4, "reference": ["A", "D"]},
    "BCE": {"points": {"B": [0.0, 0.0], "C": [1.0, 0.0], "E": [0.5, 0.4]}, "reference": ["B", "A"]},
    "DC": {"length": 0.8, "reference": ["D", "A"]},
    "EF": {"length": 0.9, "reference": ["E", "B"]},
    "GF": {"length": 0.7, "reference": ["G", "A"]},
}
SIX_BAR_FRAME = {"points": {"A": [0.0, 0.0], "D": [1.1, 0.0], "G": [0.6, -0.5]}}


def test_a_six_bar_driven_elsewhere_is_the_same_mechanism() -> None:
    """Driven at the crank it has dyads only; driven at GF, four links have to be solved together."""
    crank = ct.Mechanism(
        space="sphere",
        frame=SIX_BAR_FRAME,
        links=SIX_BAR,
        drives=CRANK,
        assembly={"sides": {"C": "left", "F": "right"}},
    )
    exact = ct.motion(crank, at=np.linspace(0.8, 1.4, 7))
    angles = exact["joint_angle"][3]
    links = {name: {**link, "angle": float(angles.sel(joint=name))} for name, link in SIX_BAR.items()}
    start = links["GF"].pop("angle")
    rocker = ct.Mechanism(
        space="sphere",
        frame=SIX_BAR_FRAME,
        links=links,
        drives=[{"link": "GF", "start": start, "speed": 1.0}],
    )
    assert "higher class" in ct.check(rocker).plan[-1]
    found = ct.motion(rocker, at=joint(exact, "GF"))
    assert statuses(found) == statuses(exact) == ["ok"] * 7
    assert np.max(np.abs(found["position"] - exact["position"])) <= 256 * EPS
    # the chain rule: derivatives by the crank over that of GF by the crank
    rate = joint(exact, "GF", "joint_velocity_coefficient")
    bend = joint(exact, "GF", "joint_acceleration_coefficient")
    first = exact["velocity_coefficient"].to_numpy() / rate[:, None, None]
    second = (exact["acceleration_coefficient"].to_numpy() - first * bend[:, None, None]) / (rate**2)[
        :, None, None
    ]
    steep = np.max(1 / np.abs(rate))
    assert np.max(np.abs(found["velocity_coefficient"] - first)) <= 1024 * EPS * steep**2
    assert np.max(np.abs(found["acceleration_coefficient"] - second)) <= 4096 * EPS * steep**4
    # GF turns back where its angle is greatest: a limit of the mechanism that it drives
    limit = events(ct.motion(rocker, samples=91), "limit")
    assert len(limit) == 1
    at_limit = crank_at_greatest(crank)
    assert limit[0] == pytest.approx(at_limit, abs=1024 * EPS)


def crank_at_greatest(crank: ct.Mechanism) -> float:
    """Greatest angle of GF: its slope by the crank is zero, found by ever shorter pieces."""

    def slopes(q: Array) -> Array:
        return joint(ct.motion(crank, at=q), "GF", "joint_velocity_coefficient")

    coarse = ct.motion(crank, samples=361)
    q = coarse["drive_value"].to_numpy()[int(np.argmax(joint(coarse, "GF"))), 0]
    low, high = q - 0.02, q + 0.02
    for _cut in range(5):
        nodes = np.linspace(low, high, 65)
        falling = slopes(nodes) <= 0.0
        assert falling[-1] and not falling[0]
        k = int(np.argmax(falling))
        low, high = float(nodes[k - 1]), float(nodes[k])
    return float(joint(ct.motion(crank, at=[low]), "GF")[0])


def test_gears_at_a_group_of_higher_class() -> None:
    """A wheel may follow a link of such a group; a gear that holds the group together is refused."""
    exact = ct.motion(
        ct.Mechanism(
            space="sphere",
            frame=SIX_BAR_FRAME,
            links=SIX_BAR,
            drives=CRANK,
            assembly={"sides": {"C": "left", "F": "right"}},
        ),
        at=np.linspace(0.8, 1.4, 7),
    )
    links = {
        name: {**link, "angle": float(exact["joint_angle"][3].sel(joint=name))}
        for name, link in SIX_BAR.items()
    }
    start = links["GF"].pop("angle")
    frame = {"points": {**SIX_BAR_FRAME["points"], "W": [0.2, 0.7]}}
    wheel = {"WV": {"length": 0.3, "reference": ["W", "D"], "angle": 0.25}}
    geared = ct.Mechanism(
        space="sphere",
        frame=frame,
        links=links | wheel,
        gears=[{"links": ["DC", "WV"], "ratio": -3.0}],
        drives=[{"link": "GF", "start": start, "speed": 1.0}],
    )
    found = ct.motion(geared, at=joint(exact, "GF"))
    assert statuses(found) == ["ok"] * 7
    turn = joint(exact, "DC") - joint(exact, "DC")[3]
    assert np.max(np.abs(joint(found, "WV") - 0.25 + 3.0 * turn)) <= 1024 * EPS
    # without its drive, the loop is held by the gear alone
    held = ct.Mechanism(
        space="sphere",
        frame=SIX_BAR_FRAME,
        links={name: link for name, link in SIX_BAR.items() if name not in ("EF", "GF")}
        | {
            "EG": {"length": 0.6, "points": ["E", "H"]},
            "GH": {"length": 0.5, "points": ["G", "H"], "reference": ["G", "A"]},
            "GK": {"length": 0.5, "reference": ["G", "A"]},
        },
        gears=[{"links": ["DC", "GH"], "ratio": 2.0}],
        drives=[{"link": "GK", "start": 0.0, "speed": 1.0}],
    )
    with pytest.raises(ct.InputError):
        ct.motion(held, samples=3)
