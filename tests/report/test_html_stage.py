"""Motions as data of a page: to scale, upright, and nothing in it that a page could take for its own."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
import pytest

import centrode as ct
from centrode.render.document.linkage_player import moving_of
from centrode.report.html.stage import UNIT, stage_of

from .made import HOSTILE, moving

DATA = re.compile(r'<script type="application/json">(.*?)</script>', re.DOTALL)


def data_of(element: str) -> dict:
    (text,) = DATA.findall(element)
    return json.loads(text)


def rows(numbers: list, columns: int) -> np.ndarray:
    return np.array([np.nan if one is None else one for one in numbers], dtype=float).reshape(-1, columns)


def test_places_are_to_scale_and_upright() -> None:
    """Whole numbers of the picture: each differs from its place by half a unit at most."""
    mechanism = ct.example("six-bar-press")
    motion = ct.motion(mechanism, samples=37)
    data = data_of(stage_of(moving_of(mechanism, motion), ""))
    found = {point["name"]: rows(point["at"], 2) for point in data["points"]}
    places = {name: motion.position.sel(point=name).values for name in found}
    hinges = ("O", "C")
    scale = np.diff([found[name][0, 0] for name in hinges])[0] / (places["C"] - places["O"])[0, 0]
    error = 1.0 + 1.0 / abs(found["C"][0, 0] - found["O"][0, 0]) * max(data["size"])
    for name, place in places.items():
        drawn = np.broadcast_to(found[name], place.shape) - found["O"][0]
        wanted = scale * (place - places["O"]) * [1.0, -1.0]
        assert np.abs(drawn - wanted).max() <= error, name
        assert (found[name] > 0).all()
        assert (found[name] < data["size"]).all()


def test_a_motion_knows_whether_it_closes() -> None:
    whole = moving_of(ct.example("crank-rocker"), ct.motion(ct.example("crank-rocker")))
    part = ct.motion(ct.example("crank-rocker"), start=0.0, stop=1.0, samples=9)
    assert data_of(stage_of(whole, ""))["loop"] is True
    assert data_of(stage_of(moving_of(ct.example("crank-rocker"), part), ""))["loop"] is False


def test_the_sphere_has_unit_vectors() -> None:
    mechanism = ct.example("spherical-crank-rocker")
    data = data_of(stage_of(moving_of(mechanism, ct.motion(mechanism, samples=13)), ""))
    for point in data["points"]:
        length = np.linalg.norm(rows(point["at"], 3), axis=1) / UNIT
        assert np.abs(length - 1).max() <= np.sqrt(3) / 2 / UNIT * (1 + 1e-9)
    assert data["size"][0] >= 2 * data["radius"]


def test_absent_places_are_none() -> None:
    whole = moving()
    places = {name: place.copy() for name, place in whole.places.items()}
    places["A"][3] = np.nan
    data = data_of(stage_of(replace(whole, places=places), ""))
    at = {point["name"]: point["at"] for point in data["points"]}["A"]
    assert [index for index, one in enumerate(at) if one is None] == [6, 7]


@pytest.mark.parametrize("text", [HOSTILE, "</script><script>alert(1)</script>", "\u2028<!--<script>"])
def test_hostile_names_stay_data(text: str) -> None:
    whole = moving()
    named = replace(
        whole,
        places={"O": whole.places["O"], text: whole.places["A"]},
        bodies={text: ("O", text)},
        tracks=(text,),
        drive_texts=(text,) * len(whole.drive),
        caption=text,
    )
    element = stage_of(named, "")
    assert element.count("<script") == element.count("</script") == 1
    data = data_of(element)
    assert [point["name"] for point in data["points"]] == ["O", text]
    assert data["bodies"][0]["name"] == data["texts"][0] == data["label"] == text
