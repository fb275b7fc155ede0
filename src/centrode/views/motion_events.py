"""Events of a motion: impacts, what sticks and slips, what is closed, for terminal, tables, figures and documents."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from centrode.sheets.players import EventSign, HeldStretch, MarkedEvent
from centrode.sheets.sheet import Column, Fact, Table
from centrode.sheets.texts import NOTHING, Expression, Joined, Name, Number, Sentence, Text, Unit

if TYPE_CHECKING:
    import xarray as xr

KINDS = {
    "crossing": Sentence("change point passed"),
    "near_miss": Sentence("near miss of a change point"),
    "doubtful": Sentence("change point in doubt"),
    "impact": Sentence("impact"),
    "comes_to_rest": Sentence("comes to rest"),
    "closes": Sentence("closes"),
    "opens": Sentence("opens"),
    "touches": Sentence("touches"),
    "leaves": Sentence("leaves"),
    "lets_go": Sentence("lets go"),
    "sticks": Sentence("sticks"),
    "slips": Sentence("slips"),
    "condition": Sentence("condition met"),
}
"""What an event is called."""
SIGNS: dict[str, EventSign] = {
    "impact": "impact",
    "comes_to_rest": "close",
    "closes": "close",
    "opens": "open",
    "touches": "close",
    "leaves": "open",
    "lets_go": "open",
    "sticks": "stick",
    "slips": "slip",
    "condition": "user",
    "breaks_loose": "slip",
    "standstill": "stick",
}
"""How a slider marks an event; the others have no sign of their own."""
MARKED = 12
"""Events that figures mark one by one; more would hide what they mark."""


def kinds_of_events(run: xr.Dataset) -> list[str]:
    """The kind of every event of a motion, by its word in `KINDS`."""
    words = str(run["occasion_kind"].attrs["flag_meanings"]).split()
    return [words[kind] for kind in run["occasion_kind"].values.tolist()]


def parts_of_events(run: xr.Dataset) -> list[str]:
    """The stop, clamp, friction or user's event that every event belongs to; empty where there is none."""
    if "occasion_part" not in run:
        return [""] * run.sizes["occasion"]
    return [str(part) for part in run["occasion_part"].values]


def event_facts(run: xr.Dataset) -> Iterator[Fact]:
    """For every part how often what happened, with energies lost; user's events that did not come."""
    kinds, parts = kinds_of_events(run), parts_of_events(run)
    losses = run["occasion_loss"].values if "occasion_loss" in run else np.zeros(0)
    for part in dict.fromkeys(filter(None, parts)):
        own = [number for number, one in enumerate(parts) if one == part]
        counts: list[Text] = []
        for kind in dict.fromkeys(kinds[number] for number in own):
            count = sum(kinds[number] == kind for number in own)
            counts.append(Sentence("{kind} {n}×", kind=KINDS[kind], n=Number(count, digits="d")))
        lost = float(np.nansum(losses[own]))
        if lost > 0.0:
            counts.append(Sentence("{lost} lost", lost=Number(lost, "J")))
        yield Fact(Name(part), Joined(tuple(counts)))
    for name in str(run.attrs.get("conditions", "")).split("\n"):
        if name and name not in parts:
            yield Fact(Name(name), Sentence("its formula does not change its sign"))


def _unit_of_impulse(run: xr.Dataset, part: str) -> str:
    """Unit of the impulses of a part: that of its force times that of time."""
    names = [str(name) for name in run["contact"].values] if "contact" in run.coords else []
    units = str(run["restraint_force"].attrs["units"]).split(", ") if names else ["N"]
    unit = units[names.index(part) if part in names and len(units) > 1 else 0]
    return f"{unit} s"


def event_text(run: xr.Dataset, number: int) -> Text:
    """When an event was, where, and its impulse."""
    part = parts_of_events(run)[number]
    time = Number(float(run["occasion_time"].values[number]), "s")
    if not part:
        return Sentence("at {time}", time=time)
    impulse = float(run["occasion_impulse"].values[number])
    if np.isfinite(impulse):
        lost = Number(float(run["occasion_loss"].values[number]), "J")
        return Sentence(
            "{part} at {time}, impulse {impulse}, {lost} lost",
            part=Name(part),
            time=time,
            impulse=Number(impulse, _unit_of_impulse(run, part)),
            lost=lost,
        )
    return Sentence("{part} at {time}", part=Name(part), time=time)


def _impulses(run: xr.Dataset) -> tuple[Column, ...]:
    """Impulses in the unit of their parts: of forces in N s, of moments in N m s."""
    values, parts = run["occasion_impulse"].values, parts_of_events(run)
    units = tuple(
        _unit_of_impulse(run, part) if np.isfinite(value) else ""
        for part, value in zip(parts, values, strict=True)
    )
    known = sorted({*units} - {""})
    if len(known) < 2:
        return (Column("impulse", values, known[0] if known else "N s", Expression("S")),)
    spelled = tuple(Unit(unit) if unit else NOTHING for unit in units)
    filled = tuple(unit or known[0] for unit in units)
    return (
        Column("impulse", values, head=Expression("S"), units=filled),
        Column("impulse_unit", spelled, head=Sentence("unit")),
    )


def event_table(run: xr.Dataset, caption: bool = False) -> Table:
    """Every event with its part, impulse and lost energy."""
    kinds = tuple(KINDS[kind] for kind in kinds_of_events(run))
    parts = tuple(Name(part) for part in parts_of_events(run))
    return Table(
        (
            Column("time", run["occasion_time"].values, "s", Expression("t")),
            Column("event", kinds, head=Sentence("event")),
            Column("part", parts, head=Sentence("part of the event")),
            *_impulses(run),
            Column("loss", run["occasion_loss"].values, "J", Expression("Delta T")),
        ),
        Sentence("Events of the motion, with impulses and lost energies") if caption else Sentence("Events"),
    )


def event_marks(run: xr.Dataset) -> tuple[tuple[Text, float], ...]:
    """Names and times of the events, where they are few enough to be marked."""
    if not any(parts_of_events(run)) or run.sizes["occasion"] > MARKED:
        return ()
    return tuple((event.name, event.time) for event in marked_events(run, KINDS))


def marked_events(run: xr.Dataset, kinds: Mapping[str, Sentence]) -> tuple[MarkedEvent, ...]:
    """Every event as a slider marks it; `kinds` name them by their words in the dataset."""
    absent = np.full(run.sizes["occasion"], np.nan)
    impulses, losses = (
        run[name].values if name in run else absent for name in ("occasion_impulse", "occasion_loss")
    )
    columns = zip(
        kinds_of_events(run),
        parts_of_events(run),
        run["occasion_time"].values.tolist(),
        impulses.tolist(),
        losses.tolist(),
        strict=True,
    )
    return tuple(
        MarkedEvent(
            kinds[kind],
            time,
            SIGNS.get(kind, "other"),
            Name(part) if part else NOTHING,
            Number(impulse, _unit_of_impulse(run, part), ".4g") if np.isfinite(impulse) else NOTHING,
            Number(loss, "J", ".4g") if np.isfinite(loss) else NOTHING,
        )
        for kind, part, time, impulse, loss in columns
    )


def held_parts(run: xr.Dataset) -> tuple[HeldStretch, ...]:
    """Stretches of time in which a friction sticks, a stop is closed or a clamp holds, each by itself."""
    begun: dict[str, float] = {}
    found: list[HeldStretch] = []
    last = float(run["time"].values[-1]) if run.sizes["sample"] else 0.0
    if "contact_mode" in run and run.sizes["sample"]:
        first = run["contact_mode"].values[0]
        names = [str(name) for name in run["contact"].values]
        begun |= {name: 0.0 for name, mode in zip(names, first, strict=True) if mode}
    parts, times = parts_of_events(run), run["occasion_time"].values.tolist()
    for kind, part, time in zip(kinds_of_events(run), parts, times, strict=True):
        if kind in ("sticks", "closes", "comes_to_rest"):
            begun.setdefault(part, float(time))
        elif kind in ("slips", "opens", "lets_go") and part in begun:
            found.append(HeldStretch(Name(part), begun.pop(part), float(time)))
    found += [HeldStretch(Name(part), time, last) for part, time in begun.items()]
    return tuple(sorted(found, key=lambda one: (one.begin, one.end)))


def held_stretches(run: xr.Dataset) -> tuple[tuple[float, float], ...]:
    """Stretches of time in which some friction sticks or some stop is closed, joined where they meet."""
    joined: list[tuple[float, float]] = []
    for one in held_parts(run):
        if joined and one.begin <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(one.end, joined[-1][1]))
        else:
            joined.append((one.begin, one.end))
    return tuple(joined)
