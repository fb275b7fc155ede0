"""Equilibria: what the terminal, the files, the figures and the document show of them."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from functools import partial
from itertools import islice
from math import tau
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.dynamics.equilibria.critical_values import BRANCH_POINT, FOLD, HOPF, KINK
from centrode.dynamics.equilibria.critical_values import KINDS as CRITICAL_KINDS
from centrode.dynamics.equilibria.small_motions import ASYMPTOTIC, NEUTRAL, STABILITIES, STABLE, UNSTABLE
from centrode.sheets.linkages import MechanismPicture
from centrode.sheets.plots import AxisLabel, CurveDiagram, Trace
from centrode.sheets.sheet import (
    Chapter,
    Column,
    Deferred,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Symbol, Text, Title

if TYPE_CHECKING:
    import xarray as xr

    from centrode.dynamics.equilibria.equilibrium import EquilibriumResults
    from centrode.sheets.pictures import Picture

Array: TypeAlias = NDArray[np.float64]

SHOWN = 12
"""Equilibria that a terminal lists and pictures show; files have all of them."""
DRAWN = 6
STABILITY: dict[str, Sentence] = {
    ASYMPTOTIC: Sentence("asymptotically stable"),
    STABLE: Sentence("stable"),
    NEUTRAL: Sentence("neutral"),
    UNSTABLE: Sentence("unstable"),
}
CRITICAL: dict[str, Sentence] = {
    FOLD: Sentence("fold: an equilibrium is lost"),
    BRANCH_POINT: Sentence("branch point: other equilibria branch off"),
    HOPF: Sentence("Hopf point: oscillations begin to grow"),
    KINK: Sentence("kink: a stop closes or opens, or a controller reaches its bound"),
}


def sheet(results: EquilibriumResults) -> Sheet:
    """Every equilibrium with its stability, where friction holds, and what is critical along a number."""
    found = results.equilibria
    tables = {"equilibria": _table(found)}
    if "friction_band" in found and found.sizes["band"]:
        tables["friction-bands"] = _bands_table(found)
    if found.attrs["vary"]:
        tables |= {"branches": _branches_table(found), "critical-values": _critical_table(found)}
    return Sheet(
        facts=tuple(_facts(results)),
        tables=tables,
        datasets={"equilibria": found},
        pictures=Deferred(dict(_pictures(results))),
        chapters={"equilibria": _chapter(results)},
    )


def coordinate_units(found: xr.DataArray) -> list[str]:
    """SI unit of every generalised coordinate of a variable whose last dimension they are."""
    units = str(found.attrs["units"]).split(", ")
    return units * found.shape[-1] if len(units) == 1 else units


def place_text(found: xr.Dataset, number: int | None = None) -> Text:
    """Where an equilibrium is: values of the drives, without drives those of the first coordinates."""
    names, values, units = named_values(found)
    row = values if number is None else values[number]
    parts = [
        Joined((Name(name), Number(float(value), unit, degrees_too=True)), " = ")
        for name, value, unit in zip(names, row, units, strict=True)
    ]
    return Joined(parts[:4])


def named_values(found: xr.Dataset) -> tuple[list[str], Array, list[str]]:
    """Names, values, units that tell a position: of free drives if they are enough, else of generalised coordinates."""
    held = json.loads(found.attrs["hold"]) | json.loads(found.attrs.get("speed", "{}"))
    free = [k for k, name in enumerate(found["drive"].values) if name not in held]
    if len(free) < int(found.attrs["mobility"]) or not free:
        values = found["generalised_coordinate"]
        return [str(name) for name in found["coordinate"].values], values.values, coordinate_units(values)
    units = coordinate_units(found["drive_value"])
    names = [str(found["drive"].values[k]) for k in free]
    return names, found["drive_value"].values[..., free], [units[k] for k in free]


def _facts(results: EquilibriumResults) -> Iterator[Fact]:
    found = results.equilibria
    count = found.sizes["equilibrium"]
    yield Fact(Sentence("degrees of freedom"), Number(int(found.attrs["mobility"]), digits="d"))
    yield Fact(Sentence("positions looked at"), Number(int(found.attrs["starts"]), digits="d"))
    yield Fact(Sentence("equilibria"), Number(count, digits="d"))
    for k in range(min(count, SHOWN)):
        label = Sentence("equilibrium {number}", number=Number(k + 1, digits="d"))
        yield Fact(
            label, Joined((place_text(found, k), _stability_text(found, k), *_resting_texts(found, k)), "; ")
        )
    if count > SHOWN:
        more = Number(count - SHOWN, digits="d")
        yield Fact(NOTHING, Sentence("and {more} more, which the files have", more=more))
    yield from _held_facts(results)
    yield from _controller_facts(found)
    yield from _friction_facts(found)
    yield from _critical_facts(found)


def _stability_text(found: xr.Dataset, k: int) -> Text:
    text: Text = STABILITY[STABILITIES[int(found["stability"].values[k])]]
    rates, frequencies = found["growth_rate"].values[k], found["damped_frequency"].values[k]
    oscillating = frequencies[np.isfinite(frequencies) & (frequencies > 0.0)]
    if int(found["stability"].values[k]) == STABILITIES.index(UNSTABLE) and np.isfinite(rates).any():
        growth = Number(float(np.nanmax(rates)), "1/s")
        return Sentence("{stability}, a departure grows by {rate}", stability=text, rate=growth)
    if len(oscillating):
        slowest = Number(float(np.min(oscillating)) / tau, "Hz")
        return Sentence("{stability}, slowest oscillation {frequency}", stability=text, frequency=slowest)
    return text


def _resting_texts(found: xr.Dataset, k: int) -> Iterator[Text]:
    """Stops on which an equilibrium rests, with their forces."""
    if "restraint_force" not in found:
        return
    units = coordinate_units(found["restraint_force"])
    forces = found["restraint_force"].values[k]
    for name, force, unit in zip(found["contact"].values, forces, units, strict=True):
        if force:
            size = Number(abs(float(force)), unit, ".6g")
            yield Sentence("rests on {stop} with {force}", stop=Name(str(name)), force=size)


def _held_facts(results: EquilibriumResults) -> Iterator[Fact]:
    found = results.equilibria
    if "holding_moment" not in found:
        return
    units = coordinate_units(found["holding_moment"])
    for column, name in enumerate(found["drive"].values):
        values = found["holding_moment"].values[:SHOWN, column]
        if np.isfinite(values).all():
            numbers = Joined([Number(float(value), units[column], "+.6g") for value in values], "; ")
            yield Fact(Sentence("{drive} is held by", drive=Name(str(name))), numbers)


def _controller_facts(found: xr.Dataset) -> Iterator[Fact]:
    """What controllers give at each equilibrium."""
    if "controller_output" not in found:
        return
    units = coordinate_units(found["controller_output"])
    for column, name in enumerate(found["controller"].values):
        values = found["controller_output"].values[:SHOWN, column]
        if len(values):
            numbers = Joined([Number(float(value), units[column], "+.6g") for value in values], "; ")
            yield Fact(Sentence("{controller} gives", controller=Name(str(name))), numbers)


def _friction_facts(found: xr.Dataset) -> Iterator[Fact]:
    if "friction_reach" in found:
        units = coordinate_units(found["friction_reach"])
        for k, row in enumerate(found["friction_reach"].values[:SHOWN]):
            label = Sentence("friction holds about {number}", number=Number(k + 1, digits="d"))
            parts = [
                Joined((Name(str(name)), Number(float(value), unit, ".3g")), " ± ")
                for name, value, unit in zip(found["coordinate"].values, row, units, strict=True)
            ]
            yield Fact(label, Joined(parts[:4]))
    if "friction_band" not in found:
        return
    yield from _share_facts(found)
    if found["friction_holds_everywhere"].values.any():
        yield Fact(
            Sentence("friction holds"), Joined((Sentence("in every position"), *_slip_texts(found, 0)), "; ")
        )
        return
    units = coordinate_units(found["friction_band"])
    told = _told_coordinate(found)
    for k, row in enumerate(found["friction_band"].values):
        first, last = sorted(row[:, told].tolist())
        text = Sentence(
            "{name} from {first} to {last}",
            name=Name(str(found["coordinate"].values[told])),
            first=Number(first, units[told], degrees_too=True),
            last=Number(last, units[told], degrees_too=True),
        )
        yield Fact(Sentence("friction holds"), Joined((text, *_slip_texts(found, k)), "; "))


def _told_coordinate(found: xr.Dataset) -> int:
    """Number of the coordinate that tells a position: that of a drive, else the first."""
    names = [str(name) for name in found["coordinate"].values]
    return next((names.index(str(name)) for name in found["drive"].values if str(name) in names), 0)


def _share_facts(found: xr.Dataset) -> Iterator[Fact]:
    """What part of the friction the initial position takes."""
    share = float(found["friction_share"].values)
    if not np.isfinite(share):
        return
    percent = Number(100.0 * share, "%", ".6g")
    yield Fact(
        Sentence("the initial position takes"),
        Sentence("{share} of the friction: it stays", share=percent)
        if share <= 1.0
        else Sentence("{share} of the friction: it moves", share=percent),
    )


def _slip_texts(found: xr.Dataset, band: int) -> Iterator[Text]:
    if found["friction_feeds_itself"].values[band]:
        yield Sentence("friction feeds itself there, and may slip as well (Painlevé)")


def _critical_facts(found: xr.Dataset) -> Iterator[Fact]:
    if not found.attrs["vary"]:
        return
    path, unit = str(found.attrs["vary"]), str(found["branch_value"].attrs["units"])
    ends = [Number(float(found.attrs[name]), unit) for name in ("vary_low", "vary_high")]
    yield Fact(
        Sentence("number that is varied"),
        Sentence("{path} from {low} to {high}", path=Name(path), low=ends[0], high=ends[1]),
    )
    if not found.sizes["critical"]:
        yield Fact(Sentence("critical values"), Sentence("none"))
    for value, kind, frequency in zip(
        found["critical_value"].values, found["critical_kind"].values, found["critical_frequency"].values, strict=True
    ):  # fmt: skip
        words: Text = CRITICAL[CRITICAL_KINDS[int(kind)]]
        if frequency:
            words = Joined((words, Number(float(frequency) / tau, "Hz")))
        yield Fact(Sentence("critical value"), Joined((Number(float(value), unit, ".9g"), words), ": "))


# Tables


def _table(found: xr.Dataset) -> Table:
    """One row an equilibrium."""
    count = found.sizes["equilibrium"]
    columns = [
        Column("equilibrium", numbers_from_one(count), head=Sentence("equilibrium")),
        *_values_of(found, "drive_value", "drive", "drive_"),
        *_values_of(found, "generalised_coordinate", "coordinate", ""),
        Column("potential_energy", found["potential_energy"].values, "J", Symbol("V")),
        Column(
            "stability",
            tuple(STABILITY[STABILITIES[int(k)]] for k in found["stability"].values),
            head=Sentence("stability"),
        ),
        *_values_of(found, "holding_moment", "drive", "holding_"),
        *_values_of(found, "restraint_force", "contact", "force_"),
        *_values_of(found, "friction_reach", "coordinate", "friction_reach_"),
    ]
    for k in range(found.sizes["root"]):
        columns += [
            Column(f"growth_rate_{k + 1}", found["growth_rate"].values[:, k], "1/s", Symbol("σ", str(k + 1))),
            Column(
                f"damped_frequency_{k + 1}",
                found["damped_frequency"].values[:, k],
                "rad/s",
                Symbol("ω", str(k + 1)),
                unit_fixed=True,
            ),
        ]
    return Table(tuple(columns), Sentence("Equilibria"))


def numbers_from_one(count: int) -> tuple[Text, ...]:
    """1, 2, ... as numbers of things, which no document gives decimals."""
    return tuple(Number(k + 1, digits="d") for k in range(count))


def _values_of(found: xr.Dataset, variable: str, dimension: str, prefix: str) -> Iterator[Column]:
    if variable not in found:
        return
    values = found[variable]
    # drives of the same name as a coordinate say the same
    for k, (name, unit) in enumerate(zip(found[dimension].values, coordinate_units(values), strict=True)):
        yield Column(
            f"{prefix}{name}", values.values[..., k], unit, Name(f"{prefix}{name}"), detail=prefix == "drive_"
        )


def _bands_table(found: xr.Dataset) -> Table:
    units = coordinate_units(found["friction_band"])
    columns = []
    for end, word in enumerate(("from", "to")):
        for k, (name, unit) in enumerate(zip(found["coordinate"].values, units, strict=True)):
            values = found["friction_band"].values[:, end, k]
            columns.append(Column(f"{word}_{name}", values, unit, Name(f"{word} {name}")))
    return Table(tuple(columns), Sentence("Intervals in which dry friction holds"))


def _branches_table(found: xr.Dataset) -> Table:
    return Table(
        (
            Column("branch", found["branch"].values, head=Sentence("branch"), whole=True),
            Column("value", found["branch_value"].values, str(found["branch_value"].attrs["units"])),
            *_values_of(found, "branch_coordinate", "coordinate", ""),
            Column(
                "stability", tuple(STABILITY[STABILITIES[int(k)]] for k in found["branch_stability"].values)
            ),
        ),
        Sentence("Branches of equilibria"),
    )


def _critical_table(found: xr.Dataset) -> Table:
    kinds = tuple(CRITICAL[CRITICAL_KINDS[int(k)]] for k in found["critical_kind"].values)
    return Table(
        (
            Column("value", found["critical_value"].values, str(found["critical_value"].attrs["units"])),
            Column("kind", kinds, head=Sentence("kind")),
            *_values_of(found, "critical_coordinate", "coordinate", ""),
            Column("frequency", found["critical_frequency"].values, "rad/s", Symbol("ω"), unit_fixed=True),
        ),
        Sentence("Critical values"),
    )  # fmt: skip


# Figures


def _pictures(results: EquilibriumResults) -> Iterator[tuple[str, Callable[[], Picture]]]:
    found = results.equilibria
    for k in range(min(found.sizes["equilibrium"], DRAWN)):
        yield f"equilibrium-{k + 1}", partial(_pose, results, k)
    if found.attrs["vary"]:
        for k, name in enumerate(islice(found["coordinate"].values, DRAWN)):
            yield f"branches-{name}", partial(_diagram, results, k)


def _pose(results: EquilibriumResults, k: int) -> MechanismPicture:
    word = STABILITY[STABILITIES[int(results.equilibria["stability"].values[k])]]
    title = Sentence("Equilibrium {number}: {stability}", number=Number(k + 1, digits="d"), stability=word)
    return MechanismPicture(title, results.mechanism, results.poses.isel(sample=[k]), captioned=False)


def _diagram(results: EquilibriumResults, k: int) -> CurveDiagram:
    """One coordinate of the equilibria over the number that is varied."""
    found = results.equilibria
    unit = str(found["branch_value"].attrs["units"])
    x, y = found["branch_value"].values, found["branch_coordinate"].values[:, k]
    stable = found["branch_stability"].values <= STABILITIES.index(STABLE)
    breaks = np.flatnonzero(np.diff(found["branch"].values)) + 1
    traces = []
    for word, kept in ((Sentence("stable"), stable), (Sentence("unstable"), ~stable)):
        # a line ends where its neighbour is of the other kind
        traces.append(Trace(word, _with_gaps(x, kept, breaks), _with_gaps(y, kept, breaks)))
    marks = np.column_stack([found["critical_value"].values, found["critical_coordinate"].values[:, k]])
    if len(marks):
        traces.append(Trace(Sentence("critical values"), np.full(1, np.nan), np.full(1, np.nan), marks=marks))
    name = str(found["coordinate"].values[k])
    return CurveDiagram(
        Sentence("Equilibria over {path}", path=Name(str(found.attrs["vary"]))),
        Title(results.mechanism.title),
        AxisLabel(Name(str(found.attrs["vary"])), unit=unit),
        AxisLabel(Name(name), Symbol("q"), coordinate_units(found["branch_coordinate"])[k]),
        tuple(trace for trace in traces if np.isfinite(trace.x).any() or len(trace.marks)),
        (float(found.attrs["vary_low"]), float(found.attrs["vary_high"])),
    )


def _with_gaps(values: Array, kept: NDArray[np.bool_], breaks: NDArray[np.intp]) -> Array:
    return np.insert(np.where(kept, values, np.nan), breaks, np.nan)


# Chapter


def _chapter(results: EquilibriumResults) -> Chapter:
    found = results.equilibria
    text = Sentence(
        "In an equilibrium the loads do no work along any motion that the joints allow: the forces $bold(F)$ along the "
        "generalised coordinates are kept up by those of the constraints. A small departure $bold(x)$ obeys the "
        "linearised equations, whose eigenvalues tell whether it grows."
    )
    equations = Formula(
        (
            ("bold(F)(bold(q))", "bold(G)^upright(T) bold(lambda)"),
            ("bold(g)(bold(q))", "bold(0)"),
            ("bold(M) dot.double(bold(x)) + bold(C) dot(bold(x)) + bold(K) bold(x)", "bold(0)"),
        )
    )
    pictures = tuple(Illustration(name) for name, _make in _pictures(results))
    tables: list[Table] = [_table(found)] if found.sizes["equilibrium"] else []
    if found.attrs["vary"]:
        tables.append(_critical_table(found))
    more: tuple[Paragraph, ...] = ()
    if "controller_output" in found:
        words = Sentence(
            "States of controllers are further unknowns: at rest their rates vanish, and each adds an eigenvalue."
        )
        more = (Paragraph(words),)
    sections = (
        Section(NOTHING, (Paragraph(text), equations, *more, FactTable(tuple(_facts(results))))),
        Section(NOTHING, tuple(tables)),
        Section(NOTHING, pictures),
    )
    return Chapter(Sentence("Equilibria"), sections)
