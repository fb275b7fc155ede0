"""A drive by a law: what the study and a report call instants are values of the drive, what `--at` names is a time."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.report.study import instant

Centrode = Callable[..., Any]


def test_centres_without_places_begin_where_the_motion_does(
    centrode: Centrode, folder: Path, four_bar: str
) -> None:
    """The drive starts at 1 rad; its values state no instants, since it passes them again and again."""
    text = four_bar.replace("speed = 1", 'law = "0.5*sin(t)"') + "[study]\ninstants = [1.25]\n"
    (folder / "law.toml").write_text(text, encoding="utf-8")
    done = centrode("centres", "law.toml")
    assert (done.code, done.err) == (0, "without --at, the initial position: 0 s\n")
    assert "OA 1 rad (57.2958 deg)" in done.out


def test_instants_of_a_report_are_values_of_the_drive() -> None:
    """As its help and `[report] instants` have it, whatever the law."""
    mechanism = ct.example("wiper")
    assert instant(mechanism, "1.5 rad", "--at") == 1.5
    with pytest.raises(InputError, match="an angle"):
        instant(mechanism, "1 s", "--at")
    assert instant(ct.example("five-bar-two-drives"), "1 s", "--at") == 1.0
