"""Dyads with long or all but long enough rods on moving points, and where the program says that they close."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

import centrode as ct
from centrode.errors import CentrodeError
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.columns import EPS
from tools.campaigns.gaps.carriers import CARRIERS, Carrier
from tools.campaigns.gaps.scan import NODES, Gap, gaps_of

Array = npt.NDArray[np.float64]
LEAST = 1e-8
"""Gaps narrower than this [rad] are counted, and no fault where they are missed."""
OPERATIONS = 1024.0


@dataclass(frozen=True)
class Chain:
    """A chain whose dyad may fail: what has to be positive for it to close, the greatest square of lengths in it."""

    kind: str
    mechanism: ct.Mechanism
    start: float
    reserve: Callable[[Array], Array]
    divisor: Callable[[Array], Array] | None
    square: float


def drawn(seed: int, number: int) -> tuple[Chain, np.random.Generator]:
    """The chain of a case."""
    random = random_of(seed, number)
    start = float(random.uniform(-np.pi, np.pi))
    carrier = CARRIERS[int(random.integers(len(CARRIERS)))](random, start)
    finish = on_a_line if random.random() < 0.35 else on_a_pivot
    return finish(random, carrier, start), random


def on_a_pivot(random: np.random.Generator, carrier: Carrier, start: float) -> Chain:
    """Rods PR and KR on a fixed pivot K."""
    pivot = complex(*random.uniform(-2.0, 2.0, 2))
    p = complex(carrier.place(np.array([start]))[0])

    def apart(q: Array) -> Array:
        return np.asarray(np.abs(carrier.place(q) - pivot))

    one, other = rods(
        random, carrier, apart(np.linspace(start - np.pi, start + np.pi, NODES)), abs(p - pivot)
    )
    reach, excess = one + other, abs(one - other)
    side = float(random.choice([-1.0, 1.0]))
    parts = carrier.parts
    parts["frame"]["points"]["K"] = [pivot.real, pivot.imag]
    parts["links"] |= {
        "PR": {"points": ["P", "R"], "length": one},
        "KR": {"points": ["K", "R"], "length": other},
    }
    parts["assembly"]["sides"]["R"] = "left" if side > 0.0 else "right"

    def reserve(q: Array) -> Array:
        length = apart(q)
        long_enough = (reach - length) * (reach + length)
        if not excess:
            return np.asarray(long_enough)
        return np.asarray(np.minimum(long_enough, (length - excess) * (length + excess)))

    kind = f"{carrier.kind}, rods on a pivot"
    return Chain(kind, ct.Mechanism(**parts), start, reserve, carrier.divisor, reach**2)


def rods(random: np.random.Generator, carrier: Carrier, distances: Array, now: float) -> tuple[float, float]:
    """Long rods for a point that runs away; else such as fail by very little at the greatest or least distance."""
    by = 10.0 ** -float(random.uniform(2.0, 13.0))
    if carrier.divisor is not None:
        one = other = 0.5 * 10.0 ** float(random.uniform(0.5, 6.0))
    elif random.random() < 0.5:
        reach = float(np.max(distances)) * (1.0 - by)
        one = reach * float(random.uniform(0.35, 0.65))
        other = reach - one
    else:
        excess = float(np.min(distances)) * (1.0 + by)
        other = float(np.max(distances))
        one = other + excess
    if abs(one - other) < now < one + other:
        return one, other
    return 0.75 * max(now, 0.1), 0.75 * max(now, 0.1)


def on_a_line(random: np.random.Generator, carrier: Carrier, start: float) -> Chain:
    """A rod PR with R on a line of the frame."""
    through = complex(*random.uniform(-2.0, 2.0, 2))
    heading = float(random.uniform(-np.pi, np.pi))
    back = np.exp(-1j * heading)

    def apart(q: Array) -> Array:
        return np.asarray(np.abs(np.imag((carrier.place(q) - through) * back)))

    now = float(apart(np.array([start]))[0])
    if carrier.divisor is not None:
        length = now + 10.0 ** float(random.uniform(0.5, 6.0))
    else:
        most = float(np.max(apart(np.linspace(start - np.pi, start + np.pi, NODES))))
        length = max(most * (1.0 - 10.0 ** -float(random.uniform(2.0, 13.0))), 1.05 * now)
    sense = float(random.choice([-1.0, 1.0]))
    parts = carrier.parts
    parts["links"]["PR"] = {"points": ["P", "R"], "length": length}
    parts["guides"].append(
        {"point": "R", "on": "frame", "through": [through.real, through.imag], "direction": heading}
    )
    parts["assembly"]["sides"]["R"] = "ahead" if sense > 0.0 else "behind"

    def reserve(q: Array) -> Array:
        return np.asarray((length - apart(q)) * (length + apart(q)))

    kind = f"{carrier.kind}, rod to a line"
    return Chain(kind, ct.Mechanism(**parts), start, reserve, carrier.divisor, length**2)


def run(seed: int, number: int) -> Outcome:
    """Statuses inside, beside and beyond the gaps of one chain, and its limits."""
    chain, random = drawn(seed, number)
    outcome = Outcome(f"# {chain.kind}\n{ct.mechanism_text(chain.mechanism)}")
    low, high = chain.start - math.pi, chain.start + math.pi
    rounding = OPERATIONS * EPS * chain.square
    gaps = gaps_of(chain.reserve, chain.divisor, low, high, rounding)
    outcome.subject += "".join(f"\n# gap {gap.low!r} .. {gap.high!r} ({gap.width:.2g} rad)" for gap in gaps)
    behind = max((gap for gap in gaps if gap.high < chain.start), key=lambda gap: gap.high, default=None)
    ahead = min((gap for gap in gaps if gap.low > chain.start), key=lambda gap: gap.low, default=None)
    values, wanted = samples_of(random, chain.start, behind, ahead, (low, high))
    try:
        data = ct.motion(chain.mechanism, at=values)
    except CentrodeError as refusal:
        outcome.count("refused")
        outcome.fault(f"{chain.kind}: refused: {refusal}")
        return outcome
    outcome.count("samples", len(values))
    good = data.status.to_numpy() == ct.Status.OK
    for gap in (behind, ahead):
        if gap is not None and not gap.doubtful:
            judge(outcome, chain, gap, data, values, good)
    inside = [k for k, there in enumerate(wanted) if there and not good[k]]
    if inside:
        word = ct.Status(int(data.status[inside[0]])).word
        outcome.fault(f"{chain.kind}: {word} at {values[inside[0]]!r}, where the chain gets")
    return outcome


def samples_of(
    random: np.random.Generator,
    start: float,
    behind: Gap | None,
    ahead: Gap | None,
    ends: tuple[float, float],
) -> tuple[Array, list[bool]]:
    """Values of the drive, and of which of them the chain gets there without doubt."""
    first = behind.high if behind is not None else ends[0]
    last = ahead.low if ahead is not None else ends[1]
    span = last - first
    values = [float(x) for x in random.uniform(first + 1e-6 * span, last - 1e-6 * span, 8)]
    wanted = [True] * len(values)
    for gap, outer in ((behind, ends[0]), (ahead, ends[1])):
        if gap is None or gap.doubtful:
            continue
        values += [
            float(x) for x in random.uniform(gap.low + 0.05 * gap.width, gap.high - 0.05 * gap.width, 3)
        ]
        beyond = (outer, gap.low) if gap.high < start else (gap.high, outer)
        values += [float(x) for x in random.uniform(*beyond, 2)]
        wanted += [False] * 5
    return np.array(values), wanted


def judge(outcome: Outcome, chain: Chain, gap: Gap, data: Any, values: Array, good: Any) -> None:
    """Nothing may be ok in the gap or beyond it; the limit stands at its near end."""
    row = f"{chain.kind}, {decade(gap.width)}"
    sense = 1.0 if gap.low > chain.start else -1.0
    near = gap.low if sense > 0.0 else gap.high
    beyond = sense * (values - near) > 0.0
    missed = bool((good & beyond).any())
    outcome.count(f"gaps, {decade(gap.width)}")
    if missed:
        outcome.count(f"missed, {decade(gap.width)}")
        if gap.width >= LEAST:
            outcome.fault(
                f"{row}: ok in or beyond the gap {gap.low!r} .. {gap.high!r} ({gap.width:.2g} rad), "
                f"started at {chain.start!r}"
            )
        return
    step = 1e-3 * max(gap.width, 1e-12)
    slope = abs(float(chain.reserve(np.array([near - sense * step]))[0])) / step
    rounding = OPERATIONS * EPS * (chain.square / max(slope, 1e-300) + 4.0)
    places = data.event_value.to_numpy()
    off = float(np.min(abs(places - near), initial=math.inf))
    outcome.measure(row, "limit", off)
    outcome.hold(row, "limit / rounding", off / rounding, 1.0)


def decade(width: float) -> str:
    """The decade of a gap's width in words."""
    power = math.floor(math.log10(width)) if width > 0.0 else -16
    return "wider than 0.01" if power >= -2 else f"width from 1e{power:03d}"


CAMPAIGN = Campaign(
    name="gaps",
    title="Gaps",
    about="""Chains that do not close over an interval of the crank's angle that may be far narrower than a cell of
the mesh (half a degree): a dyad with long rods on a point that two guides carry, which runs to infinity where these
are parallel, for a moment or at two angles close together; and dyads whose rods are by a very little too short, or
too different, on the pin of a four-bar or a slider-crank.

The oracle computes what has to be positive for the dyad to close from formulas of its own at 4001 nodes a turn, looks
for its minima by golden section and for the poles by bisection, and bisects the ends of every gap. Inside the gap
next to the start, and beyond it, no sample may be ok; on the near side all are; the limit stands at the near end.""",
    columns={
        "limit": "error of the limit at the near end of the gap [rad]",
        "limit / rounding": "the same in units of 1024 roundings of the squared lengths over the slope; bound 1",
    },
    run=run,
    cases=20000,
    block=100,
)  # fmt: skip
