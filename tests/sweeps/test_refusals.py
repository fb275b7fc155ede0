"""What cannot be swept is told in a sentence, before anything is computed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.sweeps import designs

AB = "links.AB.length"
WRONG: list[tuple[dict[str, Any], str]] = [
    ({"vary": {}}, "nothing varies"),
    ({"vary": None}, "nothing varies"),
    ({"vary": {"links.AX.length": [1.0]}}, "there is no"),
    ({"vary": {"links.AB.lenght": [1.0]}}, 'did you mean "length"'),
    ({"vary": {"drives.OA.speed": [1.0]}}, "names no dimension"),
    ({"vary": {AB: []}}, "one or more values"),
    ({"vary": {AB: [[3.5]]}}, "one-dimensional"),
    ({"vary": {AB: [3.5, np.nan]}}, "finite"),
    ({"vary": {AB: [3.5, -1.0]}}, "positive"),
    ({"vary": {AB: ["3.5 kg"]}}, "expected a length"),
    ({"vary": {AB: [3.5, {}]}}, "not numbers"),
    ({"vary": {AB: "3.5 m"}}, "not numbers"),
    ({"vary": {AB: [3.4, 3.5], "links.OA.length": [1.0]}}, "links.AB.length 2, links.OA.length 1"),
    ({"vary": {AB: ("3.4 m", "3.6 m", 21)}}, "ct.grid"),
    ({"vary": ct.grid({})}, "nothing varies"),
    ({"vary": ct.grid({AB: ("3.6 m", "3.4 m", 21)})}, "does not increase"),
    ({"vary": ct.grid({AB: (3.5, 3.5, 2)})}, "does not increase"),
    ({"vary": ct.grid({AB: (3.4, 3.6)})}, "first, last, count"),
    ({"vary": ct.grid({AB: (3.4, 3.6, 0)})}, "whole number"),
    ({"vary": ct.grid({AB: (3.4, 3.6, 2.5)})}, "whole number"),
    ({"vary": ct.grid({AB: (3.4, 3.6, 1)})}, "two values or more"),
    ({"vary": ct.grid({AB: (3.4, np.inf, 3)})}, "finite"),
    ({"vary": ct.grid({AB: (-1.0, 3.6, 3)})}, "positive"),
    ({"vary": ct.grid({AB: (3, 4, 10**7), "frame.points.D.x": (3, 4, 10**7)})}, "100000000000000 mechanisms"),
    ({"vary": ct.grid({AB: (3, 4, 10**5), "frame.points.D.x": (3, 4, 10**5)})}, "would take .* GB"),
    ({"vary": ct.sample({}, 3)}, "nothing varies"),
    ({"vary": ct.sample({AB: (3.6, 3.4)}, 3)}, "does not increase"),
    ({"vary": ct.sample({AB: [3.4]}, 3)}, "first, last"),
    ({"vary": ct.sample({AB: (3.4, 3.6)}, 0)}, "whole number"),
    ({"vary": ct.sample({AB: (3.4, 3.6)}, 10**13)}, "whole number"),
    ({"vary": ct.sample({AB: (3.4, 3.6)}, 3, "sobel")}, 'did you mean "sobol"'),
    ({"vary": ct.sample({AB: (3.4, 3.6)}, 3, seed=-1)}, "seed"),
    ({"outputs": []}, "no output"),
    ({"outputs": None}, "no output"),
    ({"outputs": ["positon.B"]}, 'did you mean "position"'),
    ({"outputs": ["position.Q"]}, "there is no"),
    ({"outputs": ["position.B.z"]}, "known are: x, y"),
    ({"outputs": ["position.B.x.y"]}, "has no entry"),
    ({"outputs": ["status"]}, "there is no quantity"),
    ({"outputs": ["angle", "angle"]}, "twice"),
    ({"outputs": [3]}, "an output is a text"),
    ({"outputs": ["angle"] * 201}, "at most 200"),
    ({"samples": 0}, "give 1 to"),
    ({"samples": 10**9}, "give"),
    ({"stop": np.nan}, "range must be finite"),
    ({"reduce": "men"}, 'did you mean "mean"'),
    ({"reduce": 3}, "one of min, max, range, mean"),
    ({"reduce": "max(angle_DB) + 1"}, "omit outputs"),
    ({"outputs": None, "reduce": "max(angle_DC)"}, 'did you mean "angle_D'),
    ({"outputs": None, "reduce": "2*angle_DB"}, "value at every sample"),
    ({"outputs": None, "reduce": "max(angle_DB"}, "not a formula"),
    ({"outputs": None, "reduce": "__import__(1)"}, "unknown name"),
    ({"outputs": None, "reduce": "range(angle_DB, 1)"}, "wrong number of arguments"),
    ({"outputs": None, "reduce": ""}, "empty"),
    ({"outputs": None, "reduce": {}}, "1 to 200 formulas"),
    ({"outputs": None, "reduce": {"samples_ok": "1"}}, "cannot be the name"),
    ({"outputs": None, "reduce": {"a b": "1"}}, "cannot be the name"),
    ({"outputs": None, "reduce": {"a": 1}}, "a formula is a text"),
    ({"outputs": None, "reduce": {"a": "1" * 2000}}, "at most 1000 characters"),
]


@pytest.mark.parametrize(("change", "message"), WRONG, ids=[f"{k} {m}" for k, (_c, m) in enumerate(WRONG)])
def test_what_is_refused(change: dict[str, Any], message: str) -> None:
    asked: dict[str, Any] = {"vary": {AB: [3.4, 3.5]}, "outputs": ["angle.DB"], "samples": 5}
    with pytest.raises(ct.InputError, match=message):
        ct.sweep(ct.example("crank-rocker"), **{**asked, **change})


def test_a_great_result_may_go_to_a_store(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(designs, "IN_MEMORY", 1000)
    with pytest.raises(ct.InputError, match="give a store"):
        ct.sweep(ct.example("crank-rocker"), {AB: np.linspace(3.4, 3.6, 100)}, "angle", 5)


def test_mechanisms_that_do_not_assemble_are_refused_as_by_motion() -> None:
    mechanism = ct.with_value(ct.example("crank-rocker"), AB, 20.0)
    with pytest.raises(ct.InputError) as swept:
        ct.sweep(mechanism, {AB: [3.5]}, "angle", 5)
    with pytest.raises(ct.InputError) as moved:
        ct.motion(mechanism, 5)
    assert str(swept.value) == str(moved.value)
