"""Stages of a graph: loops for arc tangents of their own change no bit, whatever crosses from one to the next."""

from __future__ import annotations

import numpy as np
import pytest

from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import Scan

NEEDS = "machine code needs llvmlite: pip install 'centrode[fast]'"
kernels = pytest.importorskip("centrode.numerics.machine_code.kernels", reason=NEEDS)
loops = pytest.importorskip("centrode.numerics.machine_code.loops", reason=NEEDS)

m = EXPRESSIONS
t, a = variable("t"), variable("a")


def many_angles() -> dict[str, Node]:
    """Arc tangents one behind another, with numbers of each stage taken by later ones and written."""
    s, c = m.sin(t * a), m.cos(t) + 2.0
    first = m.atan2(s, c)
    second = m.atan2(first * c, s + a)
    third = m.atan2(c, a)
    return {
        "given": as_node(a * 2.0),
        "sine": as_node(s),
        "first": as_node(first),
        "second": as_node(second + s),
        "third": as_node(third * first),
        "again": as_node(s),
    }


def selected() -> dict[str, Node]:
    """A condition that a later stage takes: there is no room for it to wait in."""
    below = m.less(m.sin(t), a)
    return {"x": as_node(m.where(below, m.atan2(t, a), t)), "y": as_node(m.where(below, t, a))}


def wide() -> dict[str, Node]:
    """More numbers that would have to wait than there is room for."""
    parts = [m.sin(t * (i + 1.0)) * a for i in range(loops.MOST_LEFT + 1)]
    return {f"angle {i}": as_node(m.atan2(part, t + 3.0)) for i, part in enumerate(parts)}


@pytest.mark.parametrize("graph, count", [(many_angles, 4), (selected, 1), (wide, 1)])
def test_number_of_stages(graph: object, count: int) -> None:
    order = Graph(graph()).order  # type: ignore[operator]
    found = loops.stages_of(order)
    assert len(found) == count
    assert sorted(map(id, (x for stage in found for x in stage.nodes))) == sorted(map(id, order))


@pytest.mark.parametrize("graph", [many_angles, selected, wide])
@pytest.mark.parametrize("lanes", [8, 63, 64, 65, 71, 200])
def test_stages_change_no_bit(graph: object, lanes: int, monkeypatch: pytest.MonkeyPatch) -> None:
    scan = Scan(("t",), ("a",), graph())  # type: ignore[operator]
    rows, steps = np.linspace(-3.0, 4.0, lanes)[None], np.array([[0.5, -1.25, 3.0]])
    staged = kernels.kernel_of(scan, lanes_inside=True).run(rows, steps).outputs
    monkeypatch.setattr(loops, "stages_of", lambda order: [loops.LoopStage(tuple(order), ())])
    kernels.forget()
    whole = kernels.kernel_of(scan, lanes_inside=True).run(rows, steps).outputs
    kernels.forget()
    assert np.array_equal(staged, whole)
