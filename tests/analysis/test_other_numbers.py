"""Other numbers in a description: the same assembly, whatever the initial angles were."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from centrode.analysis.redesign.candidates import with_numbers


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("crank-rocker", {"links.AB.length": 3.7}),
        ("antiparallelogram", {"links.OA.length": 1.5, "links.DB.length": 1.5}),
        ("six-bar-press", {"links.OA.length": 0.3, "links.CD.points.B.x": 0.9}),
        ("spherical-four-bar", {"links.AB.length": 0.3}),
    ],
)
def test_the_assembly_stays(name: str, values: dict[str, float]) -> None:
    """The motion is that of a batch, whose mechanisms keep the signs of the description."""
    alone = ct.motion(with_numbers(ct.example(name), values))
    batch = ct.motion(name, vary={path: [value] for path, value in values.items()})
    np.testing.assert_allclose(
        alone["position"].values,
        batch["position"].isel(mechanism=0).transpose("sample", "point", "axis").values,
        rtol=0,
        atol=1e-14,
    )


def test_numbers_beside_dimensions_are_taken_too() -> None:
    press = with_numbers(ct.example("six-bar-press"), {"links.AB.mass": "12 kg", "links.OA.length": "300 mm"})
    assert press.links["AB"].mass == 12.0
    assert press.links["OA"].length == 0.3


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(ct.InputError, match="XY"):
        with_numbers(ct.example("crank-rocker"), {"links.XY.length": 1.0})
    with pytest.raises(ct.InputError, match="positive"):
        with_numbers(ct.example("crank-rocker"), {"links.AB.length": -1.0})
