"""Values that plain functions return print as their summary."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import centrode as ct
from centrode.printed_results import PrintsSummary


@pytest.mark.parametrize(
    ("compute", "part"),
    [
        (lambda: ct.check("crank-rocker"), "mobility               1 by rank"),
        (lambda: ct.rotatability("crank-rocker"), "turns fully          yes, it returns after 1 turn"),
        (lambda: ct.principle_of_operation("crank-rocker"), "Coupler AB passes the motion on to\nrocker DB"),
        (lambda: ct.follower_cam("valve-cam"), "base radius                         24 mm"),
        (lambda: ct.walking_wheel("walking-wheel-three-legs"), "height of the hub         147.7 mm"),
    ],
)
def test_a_value_prints_its_summary(compute: Callable[[], Any], part: str) -> None:
    value = compute()
    assert isinstance(value, PrintsSummary)
    assert repr(value) == str(value) == ct.summary(value)
    assert part in str(value)


class PartOfResult(PrintsSummary):
    """What no topic computes."""


def test_what_no_topic_computes_prints_as_an_object() -> None:
    assert "PartOfResult object" in repr(PartOfResult())
