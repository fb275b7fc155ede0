"""Built-in mechanisms left to gravity, against dense equations in absolute coordinates (tests/multibody.py)."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from centrode.model.files import mechanism_text
from multibody import Multibody
from samples import ALL

EXAMPLES = (
    "crank-rocker",
    "double-rocker",
    "five-bar-two-drives",
    "four-bar-and-slider",
    "inverted-slider-crank",
    "jansen-leg",
    "klann-leg",
    "planetary-gear-train",
    "scissor-lift",
    "scotch-yoke",
    "shaper",
    "six-bar-press",
    "slider-crank-offset",
    "stephenson-six-bar",
    "third-class-triad",
    "triple-rocker",
    "two-link-arm",
    "watt-six-bar",
    "whitworth-quick-return",
)


def in_rods(name: str) -> ct.Mechanism:
    """An example without its loads, under gravity; its links have the mass and the inertia of rods of 1 kg/m."""
    example = ct.example(name)
    links = {}
    for link, one in example.links.items():
        ends = list(one.coordinates.values())
        length = max(max(np.hypot(a[0] - b[0], a[1] - b[1]) for a in ends for b in ends), 1e-3)
        middle = tuple(float(np.mean(axis)) for axis in zip(*ends, strict=True))
        update = {"mass": length, "centre": middle, "inertia": length**3 / 12.0, "shape": None, "masses": ()}
        links[link] = one.model_copy(update=update)
    fallen = example.model_copy(
        update={
            "links": links,
            "loads": (),
            "gravity": (0.0, -9.81),
            "machine": None,
            "simulation": ct.Simulation(duration=1, equations="multibody", tolerance=1e-12),
        }
    )
    return ct.parse_mechanism(mechanism_text(fallen))


WHOLE, BEGINNING = 1.0, 0.05
"""Shares of the swing that are compared."""


@pytest.mark.parametrize(
    ("name", "share"),
    # the suite looks at every second one for its beginning only; the campaign `free-motions` has random ones
    [(name, WHOLE if ALL or k % 2 == 0 else BEGINNING) for k, name in enumerate(EXAMPLES)],
)
def test_states_are_those_of_the_dense_equations(name: str, share: float) -> None:
    mechanism = in_rods(name)
    scale = max(
        float(np.ptp(np.array([*points.values()]), axis=0).max())
        for points in (
            {**mechanism.frame.coordinates, "": (0.0, 0.0)},
            *(link.coordinates for link in mechanism.links.values()),
        )
    )
    # as long as a pendulum of that length needs for a swing, at most a second
    last = share * min(1.0, 2.0 * np.sqrt(scale / 9.81))
    run = ct.simulate(mechanism, at=np.linspace(0.0, last, 3))
    assert run.attrs["ended"] == "duration"
    assert run.sizes["sample"] == 3
    assert run.attrs["worst_energy_residual"] <= 1e-9 * len(mechanism.links) * 9.81 * scale**2
    second = Multibody(mechanism)
    places = {point: run["position"].sel(point=point).values[0] for point in run["point"].values}
    angles = {link: float(run["angle"].sel(link=link)[0]) for link in run["link"].values}
    start = second.start(angles, places)
    found = second.run(start, np.zeros(second.size), [last / 2, last], tolerance=1e-12)
    for k, (coordinates, _velocities) in enumerate(found, start=1):
        own = np.array([float(run["angle"].sel(link=link)[k]) for link in second.bodies])
        theirs = np.array([*second.angles(coordinates).values()])
        assert np.abs(own - theirs).max() <= 1e-8
        # what moved is far more than what may differ
        assert np.abs(own - [angles[link] for link in second.bodies]).max() > 1e-5
