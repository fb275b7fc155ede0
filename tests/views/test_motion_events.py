"""What is shown of events: counts, stretches that are shaded, marks of the slider in a report."""

from __future__ import annotations

import re

import pytest

import centrode as ct
from centrode.report.html.page import html_page
from centrode.views.motion_events import event_marks, event_table, held_stretches

BLOCK = {
    "frame": {"points": {"O": [0, 0]}},
    "links": {"block": {"points": {"P": [0, 0]}, "mass": 2}},
    "guides": [{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
    "drives": [{"guide": "P", "start": 0}],
    "loads": [
        {"kind": "friction", "guide": "P", "value": 1, "static": 2},
        {"kind": "force", "guide": "P", "value": "t"},
    ],
    "stops": [{"guide": "P", "most": 5}],
    "simulation": {"duration": 6},
}


@pytest.fixture(scope="module")
def mechanism() -> ct.Mechanism:
    return ct.Mechanism(title="Block", **BLOCK)


@pytest.fixture(scope="module")
def run(mechanism):
    return ct.simulate(mechanism)


def test_what_sticks_and_what_is_closed_is_shaded(run):
    (first, broke), (met, last) = held_stretches(run)
    assert first == 0.0 and last == 6.0
    assert abs(broke - 2.0) < 1e-12
    # 2 x'' = t - 1 from t = 2 on: x = (s^3 / 6 + s^2 / 2) / 2 with s = t - 2
    s = met - 2.0
    assert abs((s**3 / 6 + s**2 / 2) / 2 - 5.0) < 1e-9


def test_a_motion_at_its_events_stands_where_they_happen(mechanism, run):
    """The block breaks loose at its start and touches its stop; instants asked for stay."""
    also = ct.simulate(mechanism, at=[0.0, 3.0], at_events=True)
    times = also["time"].values
    assert times.tolist() == sorted({0.0, 3.0, *run["occasion_time"].values.tolist()})
    place = also["position"].sel(point="P", axis="x").values
    assert abs(place[times == 2.0]).max() < 1e-12
    assert abs(place[-1] - 5.0) < 1e-12
    # the motion goes on behind an event: the stop holds it
    assert also["velocity"].sel(point="P", axis="x").values[-1] == 0.0


def test_the_table_and_the_marks_have_every_event(run):
    table = event_table(run)
    assert len(table.columns[0].values) == run.sizes["occasion"] == len(event_marks(run))


def test_a_report_marks_events_on_its_slider(mechanism, run):
    page = html_page(ct.report(mechanism, name="block")).decode()
    ticks = re.search(r'<span class="ticks".*?</span></span>', page, re.S)
    assert ticks is not None
    # the impact and the rest that it ends in are at one instant, but have signs of their own
    assert ticks.group().count('class="tick ') == run.sizes["occasion"]
    assert ticks.group().count('class="held"') == len(held_stretches(run))
