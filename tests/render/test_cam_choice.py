"""Figures of contact and choice: they show what was found, in the units of the display."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import centrode as ct
from centrode.cams.parameter_choice.search import CamChoice
from centrode.cams.results import cam_contact_results
from centrode.sheets.texts import Symbol
from centrode.views.cam_choice import parameter_symbol, parameter_unit
from drawn_curves import at_samples


@pytest.fixture(scope="module")
def cam() -> ct.Cam:
    return ct.example("walking-wheel-four-legs")


@pytest.fixture(scope="module")
def found(cam: ct.Cam) -> CamChoice:
    return ct.choose_cam(cam, points=4)


def test_the_front_and_its_parameters(found: CamChoice) -> None:
    figure = ct.figures(found)["cam-choice"]
    assert found.front is not None
    upper, *lower = figure.axes
    line = next(one for one in upper.get_lines() if one.get_label() == "best designs")
    np.testing.assert_allclose(line.get_xdata(), 1e-6 * found.front.values("stress"), rtol=1e-15)
    np.testing.assert_allclose(line.get_ydata(), 1e3 * found.front.values("size"), rtol=1e-15)
    assert " ".join(upper.get_ylabel().split()) == "greatest radius of the roller's path, mm"
    assert lower[-1].get_xlabel() == "greatest contact stress, MPa"
    assert len(lower) == len(found.choice.chosen.parameters)
    first = lower[0].get_lines()[0].get_ydata()
    expected = [1e-3 * one.parameters["curvature.k0"] for one in found.front.designs]
    np.testing.assert_allclose(first, expected, rtol=1e-15)
    texts = [text.get_text() for text in upper.get_legend().get_texts()]
    assert texts == ["best designs", "bound", "start, violates a bound", "chosen"]


def test_without_a_front_there_is_no_figure(found: CamChoice) -> None:
    assert ct.figures(dataclasses.replace(found, front=None)) == {}


def test_the_chosen_design_lies_on_the_front(found: CamChoice) -> None:
    """Between its neighbours, below their chord: the front is convex here."""
    assert found.front is not None
    stress, size = found.front.values("stress"), found.front.values("size")
    chosen = found.choice.chosen.measures
    assert size[-1] < chosen["size"].value <= np.interp(chosen["stress"].value, stress, size)


def test_contact(cam: ct.Cam) -> None:
    data = ct.cam_contact(cam, 9)
    figure = ct.figures(cam_contact_results(cam, 9))["cam-contact"]
    upper, lower = figure.axes
    shown = [at_samples(axes.get_lines()[0].get_ydata(), 9) for axes in (upper, lower)]
    np.testing.assert_allclose(shown[0], 1e-6 * data["contact_stress"], rtol=1e-15)
    np.testing.assert_allclose(shown[1], 1e3 * data["contact_half_width"], rtol=1e-15)
    assert lower.get_xlim() == pytest.approx((-45, 45))
    texts = [text.get_text() for text in upper.get_legend().get_texts()]
    stress, at = 1e-6 * data.attrs["greatest_stress"], math.degrees(data.attrs["greatest_stress_at"])
    assert f"{stress:.5g} MPa at {at:.5g}°" in texts
    assert "admissible stress" in texts


def test_symbols_of_parameters(cam: ct.Cam) -> None:
    assert parameter_symbol("curvature.points.3") == Symbol("K", "3", slanted=True)
    assert parameter_unit(cam, "curvature.points.3") == "1/m"
    assert parameter_symbol("curvature.constants.a") == Symbol("a")
    assert parameter_unit(cam, "curvature.constants.a") == "1"
    assert parameter_unit(cam, "curvature.k1") == "1/rad"
    linear = ct.Cam(
        kind="cam", curvature={"law": "linear", "k0": 20, "k1": 1}, start={"radius": 0.05}, range={"to": 1}
    )
    assert parameter_unit(linear, "curvature.k1") == "1/m/rad"
