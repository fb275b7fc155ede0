"""The slider of a motion in a report: events marked and gone to, by hand and by keyboard, what holds shaded."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import centrode as ct
from centrode.report.html.page import html_page
from centrode.views.motion_events import KINDS, held_parts, marked_events

from .browser import frames, opened

NAME = "catapult"


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("report") / "catapult.html"
    path.write_bytes(html_page(ct.report(ct.example(NAME), name=NAME)))
    return path


def test_events_of_a_report_are_gone_to(running: Any, file: Path) -> None:
    run = ct.simulate(ct.example(NAME))
    events, held = marked_events(run, KINDS), held_parts(run)
    with opened(running, file) as seen:
        player = seen.page.locator(".moving", has=seen.page.locator(".ticks"))
        assert player.count() == 1
        # impacts that die away within a pixel share a mark; each kind of event has one of its own
        signs = {one.sign for one in events}
        assert all(player.locator(f".tick.{sign}").count() for sign in signs)
        assert player.locator(".tick").count() < len(events)
        assert player.locator(".ticks .held").count() == len(held)
        box = player.locator(".ticks").bounding_box()
        times = run["time"].values
        first = next(one.time for one in events if one.sign == "impact")
        player.locator(".ticks").click(position={"x": box["width"] * first / times[-1] + 2, "y": 5})
        frames(seen.page)
        place = float(player.get_attribute("data-place")) / (len(times) - 1)
        assert abs(place - first / times[-1]) < 2e-3
        said = player.locator("output")
        assert "stop arm: impact" in said.inner_text()
        # from the slider itself: the event before is the release, the one behind it a rebound
        player.locator('[data-do="seek"]').focus()
        seen.page.keyboard.press("PageDown")
        frames(seen.page)
        assert "rim: lets go" in said.inner_text() and "release: condition met" in said.inner_text()
        for _event in range(30):
            seen.page.keyboard.press("PageUp")
        frames(seen.page)
        assert "lands: condition met" in said.inner_text()
        assert seen.messages == []
