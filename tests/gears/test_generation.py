"""Generation by the rack against true teeth, and the sheet of a pair."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from tools.campaigns.gears.turned_teeth import external_tooth

import centrode as ct
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.racks import rack_positions, rack_tooth
from centrode.model.gear_pairs import GEAR_PAIRS
from centrode.report.drawing_sheets import drawing_sheets
from centrode.sheets.drawing_sheets import ProfileSheet
from centrode.views.gear_pair import generation_parts
from centrode.views.gear_sheets import gear_sheet


@pytest.mark.parametrize(("teeth", "shift"), [(8, 0.0), (12, 0.6), (30, -0.3)])
def test_the_rack_touches_the_teeth_and_enters_none(teeth: int, shift: float) -> None:
    """Positions of the rack in the gap between teeth that are cut by other formulas."""
    pair = PairGeometry("external", 1.0, (teeth, 40), (shift, 0.0))
    wheel = pair.wheels[0]
    tooth = external_tooth(teeth, shift, wheel.tip / 2, pair.rack.pressure_angle, 1.0, pair.transverse.fillet)
    rolled = np.linspace(-2.0, 2.0, 801) * 2 * math.pi / teeth
    outline = rack_tooth(pair.transverse, shift)
    fine = np.concatenate(
        [np.linspace(one, two, 8, endpoint=False) for one, two in itertools.pairwise(outline)]
    )
    places = rack_positions(fine, teeth / 2, rolled)
    # The gap lies on the y axis: teeth half a pitch beside it.
    at = places[..., 1] - 1j * places[..., 0]
    depth = tooth.depth(at, np.full(at.shape, math.pi / teeth))
    # Chords of the rounded edge lie within the rack, so places touch the fillet from the gap's side.
    assert -5e-3 < depth < 5e-4


@pytest.mark.parametrize("name", ct.example_names("gear pair"))
def test_the_sheet_of_a_pair(name: str) -> None:
    results = ct.gear_pair(name)
    sheet = gear_sheet(results)
    assert [len(diagram.curves) for diagram in sheet.diagrams] == [1, 1, 1]
    assert all(np.isfinite(diagram.curves[0].up).all() for diagram in sheet.diagrams)
    made = drawing_sheets(ct.example(name))
    assert len(made.sheets) == 1
    assert isinstance(made.sheets[0], ProfileSheet)
    teeth, positions = generation_parts(results)
    assert len(positions) > 10
    assert len(teeth) == 16


def test_undercut_is_seen_in_the_generation() -> None:
    """Of an undercut wheel some positions of the rack cross the involute that would be there, of another none."""
    crossing = []
    for shift in (0.0, 0.6):
        text = f'kind = "gear pair"\nmodule = 1\nteeth = [8, 40]\nshifts = [{shift}, 0.5]\n'
        results = ct.gear_pair(GEAR_PAIRS.parse(text))
        wheel = results.geometry.wheels[0]
        outline = rack_tooth(results.geometry.transverse, shift)
        rolled = np.linspace(-1.5, 1.5, 601) * 2 * math.pi / 8
        places = np.concatenate(rack_positions(outline, wheel.pitch / 2, rolled))
        radii = np.hypot(*places.T)
        beyond = radii > wheel.base / 2 * (1 + 1e-9)
        beside = np.pi / 8 - np.abs(np.arctan2(places[beyond, 0], places[beyond, 1]))
        angles = np.arccos(wheel.base / 2 / radii[beyond])
        involute = wheel.half_base_angle - (np.tan(angles) - angles)
        crossing.append(bool(((beside < involute - 1e-4) & (radii[beyond] < wheel.pitch / 2)).any()))
    assert crossing == [True, False]
