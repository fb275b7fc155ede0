"""Many mechanisms by `ct.simulate`: as each for itself, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from free_motions import CHANGE_POINTS, DOUBLE_PENDULUM, FOUR_BAR

TIGHT = {"equations": "multibody", "tolerance": 1e-11, "duration": 1.0}


def settings(mechanism: ct.Mechanism, **changes: object) -> ct.Simulation:
    assert mechanism.simulation is not None
    return mechanism.simulation.model_copy(update={**TIGHT, **changes})


def test_states_are_those_of_each_for_itself() -> None:
    mechanism = ct.parse_mechanism(FOUR_BAR)
    lengths, masses = [0.29, 0.3, 0.31], [0.8, 0.9, 0.7]
    vary = {"links.AB.length": lengths, "links.BC.mass": masses}
    many = ct.simulate(mechanism, settings(mechanism), at=[0.5, 1.0], vary=vary, threads=2)
    assert many.generalised_coordinate.shape == (3, 2, 3)
    assert set(many["ended"].values) == {0}
    for k, (length, mass) in enumerate(zip(lengths, masses, strict=True)):
        text = FOUR_BAR.replace("length = 0.3\nmass = 0.3", f"length = {length}\nmass = 0.3").replace(
            "mass = 0.8", f"mass = {mass}"
        )
        own = ct.parse_mechanism(text)
        one = ct.simulate(own, settings(own), at=[0.5, 1.0])
        assert (
            np.max(np.abs(one.generalised_coordinate.values - many.generalised_coordinate.values[k])) <= 1e-9
        )
    assert many.attrs["worst_energy_residual"] <= 1e-8
    assert many["links.AB.length"].attrs["units"] == "m"


def test_a_chain_without_drives() -> None:
    mechanism = ct.parse_mechanism(DOUBLE_PENDULUM)
    many = ct.simulate(mechanism, settings(mechanism), vary={"links.AB.mass": [1.0, "1500 g"]})
    text = DOUBLE_PENDULUM.replace("[links.AB]\nlength = 1\nmass = 1", "[links.AB]\nlength = 1\nmass = 1.5")
    own = ct.parse_mechanism(text)
    one = ct.simulate(own, settings(own), at=[1.0])
    assert (
        np.max(np.abs(one.generalised_coordinate.values[0] - many.generalised_coordinate.values[1, 0]))
        <= 1e-9
    )


def test_change_points_are_passed_one_by_one() -> None:
    mechanism = ct.parse_mechanism(CHANGE_POINTS)
    many = ct.simulate(
        mechanism, settings(mechanism, duration=3.0), at=[1.5, 3.0], vary={"links.BC.mass": [0.8, 0.9]}
    )
    one = ct.simulate(mechanism, settings(mechanism, duration=3.0), at=[1.5, 3.0])
    assert set(many["ended"].values) == {0}
    assert np.max(np.abs(one.generalised_coordinate.values - many.generalised_coordinate.values[0])) <= 1e-8


def test_what_does_not_assemble_says_so() -> None:
    mechanism = ct.parse_mechanism(FOUR_BAR)
    many = ct.simulate(mechanism, settings(mechanism), vary={"links.AB.length": [0.3, 5.0]})
    words = many["ended"].attrs["flag_meanings"].split()
    assert [words[k] for k in many["ended"].values] == ["duration", "not_assembled"]
    assert np.isnan(many.generalised_coordinate.values[1]).all()
    assert many.attrs["mechanisms_whole"] == 1


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ({}, "nothing varies"),
        ({"links.AB.length": [0.3, 0.31], "links.BC.length": [0.8]}, "same number of values"),
        ({"links.XX.length": [1.0]}, "XX"),
        ({"links.AB.length": [-1.0]}, "positive"),
        ({"links.AB.length": ["1 kg"]}, "length"),
        ({"links.AB.length": 2.0}, "list of values"),
        ({"links.AB.length": [float("nan")]}, "finite"),
    ],
)
def test_what_is_refused(vary: dict[str, object], words: str) -> None:
    mechanism = ct.parse_mechanism(FOUR_BAR)
    with pytest.raises(ct.InputError, match=words):
        ct.simulate(mechanism, settings(mechanism), vary=vary)


def test_threads_are_a_small_number() -> None:
    mechanism = ct.parse_mechanism(FOUR_BAR)
    with pytest.raises(ct.InputError, match="threads"):
        ct.simulate(mechanism, settings(mechanism), vary={"links.AB.length": [0.3]}, threads=0)


def test_the_start_alone_may_be_requested() -> None:
    mechanism = ct.parse_mechanism(DOUBLE_PENDULUM)
    many = ct.simulate(mechanism, settings(mechanism), at=[0.0], vary={"links.OA.mass": [1.0, 2.0]})
    assert np.all(many.generalised_coordinate.values == 0.0) and many.attrs["mechanisms_whole"] == 2
