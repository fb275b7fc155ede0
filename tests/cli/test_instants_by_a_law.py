"""A drive by a law, a table or a cam: a time states an instant everywhere, as the law may pass a value again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.motion_results import study
from centrode.errors import InputError
from centrode.model.files import mechanism_text, parse_mechanism
from centrode.report.study import ReportOptions, ReportStudy, instant, moments_of, settle_options
from centrode.topics.presentation import sheet_of

Centrode = Callable[..., Any]

TWICE = ("0.2 s", "2941.592653589793 ms")
"""Times at which 0.5 sin(t) is the same: they add up to π s."""


def by_law(four_bar: str, instants: str) -> str:
    """The four-bar linkage whose crank swings."""
    return four_bar.replace("speed = 1", 'law = "0.5*sin(t)"') + f"[study]\nto = 4\ninstants = {instants}\n"


def test_commands_take_the_times_of_the_study(centrode: Centrode, folder: Path, four_bar: str) -> None:
    """The drive is at 1 rad + 0.5 sin t."""
    (folder / "law.toml").write_text(by_law(four_bar, '["500 ms", 1.25]'), encoding="utf-8")
    done = centrode("centres", "law.toml")
    assert (done.code, done.err) == (0, "without --at, the instants of [study]: 0.5 s, 1.25 s\n")
    for time in (0.5, 1.25):
        assert f"OA {1.0 + 0.5 * np.sin(time):.9g} rad" in done.out


@pytest.mark.parametrize(("table", "repair"), [("study", '"20 ms"'), ("report", '"20 ms"')])
def test_values_of_the_drive_are_refused(
    centrode: Centrode, folder: Path, four_bar: str, table: str, repair: str
) -> None:
    text = by_law(four_bar, '["1.2 rad"]').replace(
        "instants", f"[{table}]\ninstants" if table != "study" else "instants"
    )
    (folder / "law.toml").write_text(text, encoding="utf-8")
    done = centrode("describe", "law.toml")
    assert done.code == 2
    assert f"[{table}] instants" in done.err
    assert "expected a time" in done.err
    assert repair in done.err


def test_two_instants_of_one_value_are_two(four_bar: str) -> None:
    """The same angle, velocities of opposite sense; the picture shows both, each with its time."""
    mechanism = parse_mechanism(by_law(four_bar, str(list(TWICE)).replace("'", '"')))
    found = study(mechanism)
    assert found.instants is not None
    assert np.ptp(found.instants["drive_value"].values) < 1e-15
    rates = found.instants["angular_velocity"].sel(link="OA").values
    assert rates[0] == pytest.approx(0.5 * np.cos(0.2), rel=1e-14)
    assert rates[0] + rates[1] == pytest.approx(0.0, abs=1e-15)
    titles = [axes.get_title() for axes in ct.figures(found)["mechanism"].axes]
    assert [title.partition(",")[0] for title in titles] == ["$t$ = 0.2 s", "$t$ = 2.9416 s"]
    assert sheet_of(found).tables["instants"].columns[0].values.tolist() == mechanism_times(mechanism)


def mechanism_times(mechanism: ct.Mechanism) -> list[float]:
    """Instants of the study [s]."""
    return list(mechanism.study.instants)


def test_descriptions_keep_their_times(four_bar: str) -> None:
    mechanism = parse_mechanism(by_law(four_bar, '["500 ms", 1.25]'))
    assert mechanism.study.instants == (0.5, 1.25)
    assert parse_mechanism(mechanism_text(mechanism)) == mechanism


def test_instants_of_a_report_are_times() -> None:
    """Those of the description, and those of its caller."""
    mechanism = ct.example("wiper")
    assert instant(mechanism, "1500 ms", "--at") == 1.5
    with pytest.raises(InputError, match="a time"):
        instant(mechanism, "1 rad", "--at")
    assert instant(ct.example("five-bar-two-drives"), "1 s", "--at") == 1.0


def test_the_linkage_of_a_cam_is_reported_where_it_moves() -> None:
    """The cam has turned by 36 and 216 degrees, while its follower rises and falls; at rest nothing can be drawn."""
    mechanism = ct.example("cam-driven-linkage")
    assert mechanism.study.instants == (0.04, 0.24)
    settled = settle_options(mechanism, ReportOptions(), ("plots",))
    moments = moments_of(ReportStudy(mechanism, settled))
    assert [moment.at for moment in moments] == [0.04, 0.24]
    assert [moment.title.partition(",")[0] for moment in moments] == [
        "t = 0.04\u202fs",
        "t = 0.24\u202fs",
    ]
    speed = [float(moment.data["velocity"].sel(point="D").values[moment.sample, 0]) for moment in moments]
    assert speed[0] * speed[1] < 0.0
    assert min(map(abs, speed)) > 0.1
