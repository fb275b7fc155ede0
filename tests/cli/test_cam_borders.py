"""`centrode cam` where something ends: stalls, undercut under a standing leg, rollers that touch, units."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cam_shapes import WHEEL

Centrode = Callable[..., Any]
CONTACT = '[contact]\nforce = "3 kN"\nwidth = "30 mm"\ncam = { elasticity = "206 GPa" }\n'
ALONE = WHEEL.partition("[mover]")[0]


def written(folder: Path, text: str) -> None:
    (folder / "cam.toml").write_text(text, encoding="utf-8")


@pytest.mark.parametrize(
    "more",
    [
        "",
        '[return]\nkind = "designed"\n',
        '[return]\nkind = "mirrored"\n',
        pytest.param(CONTACT, marks=pytest.mark.drawn),
    ],
)
@pytest.mark.parametrize("symmetric", ["symmetric = true\n", ""])
def test_no_profile_leads_to_a_stall(centrode: Centrode, folder: Path, symmetric: str, more: str) -> None:
    written(folder, ALONE.replace("symmetric = true\n", symmetric).replace('"90 deg"', '"170 deg"') + more)
    done = centrode("cam", "cam.toml", "--samples", "31", "--out", "out")
    assert done.code == 3
    assert "no profile can guide a roller to 126.016 deg, where the follower stalls" in done.err
    assert "nan" not in done.out and "Warning" not in done.err
    assert {"cam-path.csv", "cam-path.png", "summary.json"} <= {
        one.name for one in (folder / "out").iterdir()
    }
    assert not (folder / "out" / "cam-profile.csv").exists()
    if more == CONTACT:
        assert done.rows["greatest contact stress"].startswith("unbounded towards 126.016 deg")
        assert "greatest_contact_stress" not in json.loads((folder / "out" / "summary.json").read_text())


def test_both_stalls_are_told(centrode: Centrode, folder: Path) -> None:
    """A circle of radius R about a centre c away from the origin: its tangents from there are sin(phi) = R/c away."""
    written(
        folder,
        'kind = "cam"\ncurvature = { law = "constant", k0 = 50 }\nstart = { radius = "100 mm" }\n'
        'range = { from = "-1 rad", to = "1 rad" }\ndisplay = { angle = "deg" }\n',
    )
    done = centrode("cam", "cam.toml", "--samples", "2", "--out", "out")
    at = math.degrees(math.asin(0.02 / 0.08))
    assert done.code == 3
    assert f"the follower stalls at -{at:.9g} deg and {at:.9g} deg" in done.err
    # neither of the two samples lies on the path: there is nothing to compare or to draw, and no failure
    assert "truncated after a_20: no sample to compare it at" in done.out
    assert "nan" not in done.out and "Warning" not in done.err


def test_where_the_cut_series_gives_no_path_is_told(centrode: Centrode, folder: Path) -> None:
    written(folder, ALONE.partition("[roller]")[0].replace('"90 deg"', '"120 deg"'))
    done = centrode("cam", "cam.toml", "--samples", "25", "--terms", "60")
    assert done.code == 0
    assert "it gives no path at " in done.out and " of 25 samples: the sine η is beyond 1 there" in done.out


def test_a_hub_is_not_level_over_an_undercut(centrode: Centrode, folder: Path) -> None:
    written(folder, WHEEL + '[return]\nkind = "mirrored"\n')
    done = centrode("cam", "cam.toml")
    assert "but not from -45 deg to -40.4569 deg, 40.4569 deg to 45 deg: the profile is undercut" in done.out
    written(folder, WHEEL)
    assert "but not from" not in centrode("cam", "cam.toml").out


def test_rollers_of_neighbouring_legs_do_not_overlap(centrode: Centrode, folder: Path) -> None:
    """At 24 legs the rollers of both legs beside phi = 0 are 2 rho sin(7.5 deg) apart, theirs the least radius."""
    text = WHEEL.replace("legs = 4", "legs = 24").replace('to = "90 deg"', 'to = "7.5 deg"')
    written(folder, text)
    done = centrode("cam", "cam.toml", "--out", "out", "--no-figures")
    assert done.code == 3
    assert "the rollers of neighbouring legs overlap by " in done.err
    room = json.loads((folder / "out" / "summary.json").read_text())["walking_roller_room"]["value"]
    least = 2 * 0.05 * math.sin(math.radians(7.5)) - 0.03  # the path is nowhere nearer than 50 mm
    assert least <= room < least + 1e-3
    written(folder, text.replace('"15 mm"', '"5 mm"'))
    done = centrode("cam", "cam.toml")
    assert done.code == 0
    assert done.rows["neighbouring rollers"] == f"clearance {1e3 * (room + 0.02):.6g} mm"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (WHEEL + CONTACT.replace("206 GPa", "206"), "mm wide, wider than the roller; check the units"),
        (
            WHEEL.replace("legs = 4", 'legs = 4\nworking_arc = ["50 deg", "-50 deg"]'),
            "[mover] working_arc: a wor",
        ),
        (WHEEL.replace('"90 deg"', '"40 deg"'), "[range]: the working arc covers -45 to 45 deg"),
        (
            WHEEL.replace(
                'law = "exponential"\nk0 = "0.01 1/mm"\nk1 = 0.75',
                'law = "spline"\npoints = [["0 deg", 10], ["90 deg", 20], ["45 deg", 15]]',
            ),
            "[curvature] points: the angles of a spline must increase; they do not at point 3: 90, then 45",
        ),
    ],
)
def test_the_message_names_the_place(centrode: Centrode, folder: Path, text: str, said: str) -> None:
    written(folder, text)
    done = centrode("cam", "cam.toml")
    assert done.code == 2 and said in done.err


def test_rubber_has_a_poisson_ratio_of_a_half(centrode: Centrode, folder: Path) -> None:
    written(folder, WHEEL + CONTACT.replace('"206 GPa"', '"206 GPa", poisson = 0.5'))
    assert centrode("cam", "cam.toml").code == 0
