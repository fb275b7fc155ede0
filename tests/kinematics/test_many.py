"""Motions of many mechanisms as machine code: the bits of the arrays, events and statuses included."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.kinematics.machine_code import batch
from centrode.kinematics.preparation import ready
from centrode.numerics import machine_code
from centrode.structure.groups import Newton
from samples import few

pytestmark = pytest.mark.skipif(not machine_code.PRESENT, reason="machine code needs the extra fast")


def both(mechanism: ct.Mechanism, path: str, share: float, samples: int) -> tuple[xr.Dataset, xr.Dataset]:
    """The motions with machine code, and by arrays alone."""
    vary = {path: ct.value_at(mechanism, path) * np.linspace(1.0 - share, 1.0 + share, 23)}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(batch, "WORTH_COMPILING", 1)
        found = ct.motion(mechanism, samples, vary=vary)
        patch.setattr(machine_code, "PRESENT", False)
        return found, ct.motion(mechanism, samples, vary=vary)


TO_THE_BIT = [
    name
    for name in ct.example_names()
    if not any(isinstance(x, Newton) for x in ready(ct.example(name)).structure.groups)
]
"""Those with groups of higher class stand in `test_machine_code_higher`."""


SHARES = (0.002, 0.3)
"""Of a length: with the first hardly a mechanism meets limits, with the second many do."""


@pytest.mark.parametrize(
    ("name", "share"),
    few(
        [(name, SHARES[k % 2]) for k, name in enumerate(TO_THE_BIT[1::2])],
        [(n, x) for n in TO_THE_BIT for x in SHARES],
    ),
)
def test_the_bits_of_the_arrays(name: str, share: float) -> None:
    mechanism = ct.example(name)
    lengths = [link for link in mechanism.links if mechanism.links[link].length is not None]
    if not lengths:
        pytest.skip("no length to vary")
    found, expected = both(mechanism, f"links.{lengths[-1]}.length", share, 25)
    if mechanism.space == "sphere" and mechanism.gears:
        # residuals of bevel gears are differences of arc tangents, which kernels round their own way: 2 ULP of a turn
        left, known = found.residual.to_numpy(), expected.residual.to_numpy()
        assert np.array_equal(np.isnan(left), np.isnan(known))
        assert np.nanmax(abs(left - known)) <= 2 * 2 * np.spacing(2.0 * np.pi)
        found, expected = found.drop_vars("residual"), expected.drop_vars("residual")
        for worst in ("worst_residual", "worst_residual_constraint"):
            del found.attrs[worst], expected.attrs[worst]
    xr.testing.assert_identical(found, expected)


def test_machine_code_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    lanes: list[int] = []
    solve = batch.solve
    monkeypatch.setattr(batch, "solve", lambda *args, **more: lanes.append(args[3]) or solve(*args, **more))
    both(ct.example("six-bar-press"), "links.OA.length", 0.01, 37)
    # a few for the name of the worst constraint, then all by arrays
    assert lanes[-1] == 23
    assert sum(lanes[:-1]) < 23


def test_progress_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batch, "WORTH_COMPILING", 1)
    monkeypatch.setattr(batch, "AT_ONCE", 2)
    calls: list[tuple[int, int]] = []
    vary = {"links.AB.length": np.linspace(3.4, 3.6, 7)}
    ct.motion(ct.example("crank-rocker"), 7, vary=vary, progress=lambda done, of: calls.append((done, of)))
    assert calls == [(2, 7), (4, 7), (6, 7), (7, 7)]
