"""What is asked of instant centres: steps to one, batches, big mechanisms, wrong questions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.analysis.instant_centres.centres import Case
from centrode.analysis.instant_centres.kennedy import construct_centres


def test_steps_lead_to_what_is_asked() -> None:
    motion = ct.motion(ct.example("jansen-leg"), at=[1.0])
    whole, one = construct_centres(motion), construct_centres(motion, pairs=[("frame", "AB")])
    assert [step.how for step in one.steps] == ["hinge"] * 4 + ["kennedy"]
    assert len(whole.steps) == 66
    known: set[tuple[int, int]] = set()
    for step in whole.steps:
        for by in step.by:
            legs = [(max(body, by), min(body, by)) for body in step.pair]
            assert set(legs) <= known
        known.add(step.pair)


def test_a_batch_is_its_mechanisms() -> None:
    lengths = [3.2, 3.5, 3.8]
    bar = ct.four_bar(1, 3.5, 3, 4)
    batch = ct.motion(bar, samples=5, vary={"links.coupler.length": lengths})
    many = ct.instant_centres(batch)
    assert many["centre"].dims == ("mechanism", "sample", "pair", "axis")
    for lane, length in enumerate(lengths):
        alone = ct.motion(ct.with_value(bar, "links.coupler.length", length), samples=5)
        one = ct.instant_centres(alone)
        np.testing.assert_allclose(many["centre"][lane], one["centre"], rtol=1e-10, atol=1e-12)
        made = construct_centres(batch.isel(mechanism=lane), 2)
        assert max(made.mismatch.values()) <= 1e-13


def test_what_is_not_there_has_no_centre() -> None:
    motion = ct.motion(ct.example("slider-between-cranks-locked"), samples=7)
    centres = ct.instant_centres(motion)
    absent = motion["status"].to_numpy() == ct.Status.OPEN
    assert absent.any() and not absent.all()
    assert (centres["centre_case"].to_numpy()[absent] == Case.ABSENT).all()
    assert np.isnan(centres["centre"].to_numpy()[absent]).all()
    assert not (centres["centre_case"].to_numpy()[~absent] == Case.ABSENT).any()
    with pytest.raises(ct.InputError, match="no position with velocities there"):
        construct_centres(motion, int(np.flatnonzero(absent)[0]))


def chain(dyads: int) -> ct.Mechanism:
    """A crank that moves many rockers, two links for each."""
    points = {"O": [0, 0]} | {f"D{k}": [4.0 + 0.05 * k, 0.02 * k] for k in range(dyads)}
    links: dict[str, Any] = {"crank": {"points": ["O", "A"], "length": 1.0}}
    for k in range(dyads):
        links[f"rod{k}"] = {"points": ["A", f"B{k}"], "length": 3.5}
        links[f"arm{k}"] = {"points": [f"D{k}", f"B{k}"], "length": 3.0}
    sides = {f"B{k}": "left" for k in range(dyads)}
    drives = [{"link": "crank", "start": 1.2, "speed": 1.0}]
    return ct.Mechanism(frame={"points": points}, links=links, drives=drives, assembly={"sides": sides})


def test_big_mechanisms_are_bounded() -> None:
    motion = ct.motion(chain(40), at=[1.2])
    assert ct.instant_centres(motion, [("rod3", "frame")]).sizes["pair"] == 1
    assert ct.instant_centres(motion).sizes["pair"] == 82 * 81 // 2
    with pytest.raises(ct.InputError, match="at most 40 bodies, this mechanism has 82"):
        construct_centres(motion)
    longer = ct.motion(chain(40), samples=2000, start=1.19, stop=1.21)
    with pytest.raises(ct.InputError, match="name the pairs that matter"):
        ct.instant_centres(longer)


def test_forty_bodies_are_constructed() -> None:
    made = construct_centres(ct.motion(chain(19), at=[1.2]))
    assert len(made.bodies) == 40
    assert {step.how for step in made.steps} == {"hinge", "kennedy"}
    assert all(made.mismatch[step.pair] <= 64 * step.error for step in made.steps)


def test_wrong_questions() -> None:
    motion = ct.motion(ct.example("crank-rocker"), samples=3)
    refusals = {
        'there is no link "AC"; did you mean': [("AC", "frame")],
        "AB has no centre relative to itself": [("AB", "AB")],
    }
    for message, pairs in refusals.items():
        with pytest.raises(ct.InputError, match=message):
            ct.instant_centres(motion, pairs)
    with pytest.raises(ct.InputError, match="there is no sample 3"):
        construct_centres(motion, 3)
    with pytest.raises(ct.InputError, match="there is no constructed centre of OA and OA"):
        construct_centres(motion).step("OA", "OA")
    batch = ct.motion(ct.example("crank-rocker"), samples=3, vary={"links.AB.length": [3.5, 3.6]})
    with pytest.raises(ct.InputError, match="computed for one mechanism only; select one"):
        construct_centres(batch)
