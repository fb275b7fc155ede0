"""The motion of a mechanism with any number of degrees of freedom: terminal, files, figures and document."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.quantities import QUANTITIES
from centrode.sheets.linkages import PathsPicture
from centrode.sheets.players import MotionPlayer
from centrode.sheets.plots import Abscissa, AxisLabel, Curve, CurvePanel, Plot
from centrode.sheets.sheet import (
    Chapter,
    Check,
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
from centrode.sheets.texts import (
    NOTHING,
    Counted,
    Expression,
    Joined,
    Name,
    Number,
    Sentence,
    Symbol,
    Text,
    Title,
)
from centrode.views.columns import VARIABLES, drive_units, rows_shown, status_column, without_rounding
from centrode.views.energy_balance import (
    ADAPTIVE,
    ENERGIES_CAPTION,
    ENERGIES_TITLE,
    RESIDUAL,
    SHOWN,
    STIFF,
    WORKS,
    energies_at_end,
    facts_left_out,
    occasion_facts,
    works_at_end,
)
from centrode.views.motion_events import (
    KINDS,
    event_facts,
    event_marks,
    event_table,
    event_text,
    held_parts,
    held_stretches,
    marked_events,
)
from centrode.views.motion_plots import (
    deal_to_panels,
    great_value,
    over_samples,
    quantities_panel,
    quantity_label,
)

if TYPE_CHECKING:
    import xarray as xr

    from centrode.dynamics.simulation.results import SimulationResults
    from centrode.sheets.pictures import Picture

Array: TypeAlias = NDArray[np.float64]

FINER = 8
"""Points of a phase portrait in place of one sample, where the curve bends between samples."""
SEEN = 1e-3
"""Share of a picture's side that a chord may be beside its curve."""
PORTRAIT, PORTRAITS = "simulation-phase-", 6
"""Names of phase portraits begin so; and how many there are at most."""
MARGIN = 0.04
"""Share of a phase portrait's width that is left free on either side."""
SAFETY = 100.0
"""Errors of steps add up, and energies turn over more than once."""

SCHEMES = {"adaptive": ADAPTIVE, "stiff": STIFF}
IN_CSV = (
    "generalised_coordinate",
    "generalised_velocity",
    "generalised_acceleration",
    *VARIABLES,
    "work_part",
    "keeping_moment",
    "velocity_residual",
    "joint_force",
    "guide_force",
    "guide_moment",
    "restraint_force",
    "contact_mode",
)
COORDINATES = {
    "drives": ("drive_value", "drive_speed", "drive_acceleration"),
    "coordinates": ("generalised_coordinate", "generalised_velocity", "generalised_acceleration"),
}
TITLES = {
    "simulation-coordinates": Sentence("Coordinates, velocities and accelerations"),
    "simulation-energies": ENERGIES_TITLE,
    "simulation-works": Sentence("Works of loads and drives"),
}
CAPTIONS: dict[str, Sentence] = {
    "simulation-coordinates": Sentence("Coordinates, velocities and accelerations over time"),
    "simulation-energies": ENERGIES_CAPTION,
    "simulation-works": Sentence("Works of the single loads and drives over time"),
    "simulation-paths": Sentence("Paths of the points"),
}


def multibody_sheet(results: SimulationResults) -> Sheet:
    """Everything there is to say about a motion by the equations of all links."""
    run = results.simulation
    return Sheet(
        facts=tuple(_facts(results)),
        tables={"simulation": _table(run), **_events(run)},
        datasets={"simulation": run},
        pictures=Deferred(dict(_pictures(results))),
        chapters={"simulation": _chapter(results)},
        printed=_players(results),
    )


def _players(results: SimulationResults) -> tuple[MotionPlayer, ...]:
    """The motion itself, which a page plays, with its events marked."""
    run = results.simulation
    if run.sizes["sample"] < 2:
        return ()
    marks, held = marked_events(run, KINDS), held_parts(run)
    return (MotionPlayer(results.mechanism, run, by_time=True, marks=marks, held=held),)


def _events(run: xr.Dataset) -> dict[str, Table]:
    """The table of events, where there are any of stops, clamps, frictions or conditions."""
    return {"simulation-events": event_table(run)} if "occasion_part" in run else {}


# What is shown of coordinates: those that drives name, else those of the equations.


class _Coordinates:
    """Names, units and courses of the coordinates that are shown."""

    def __init__(self, run: xr.Dataset) -> None:
        kind = "drives" if run.sizes["drive"] else "coordinates"
        self.dimension = "drive" if kind == "drives" else "coordinate"
        self.names = [str(name) for name in run[self.dimension].values]
        self.courses = [run[name].values for name in COORDINATES[kind]]
        units = (
            drive_units(run) if kind == "drives" else _units(run["generalised_coordinate"], len(self.names))
        )
        self.units = [unit or "1" for unit in units]

    def of_unit(self, unit: str) -> list[str]:
        """Those with values in a unit."""
        return [name for name, own in zip(self.names, self.units, strict=True) if own == unit]

    def course(self, name: str, order: int) -> Array:
        """Values, velocities or accelerations of one."""
        return np.asarray(self.courses[order][:, self.names.index(name)])


def _units(values: xr.DataArray, count: int) -> list[str]:
    units = str(values.attrs.get("units", "1")).split(", ")
    return units * count if len(units) == 1 else units


# Facts


def _facts(results: SimulationResults) -> Iterator[Fact]:
    """What moved, by which equations, how it ended, coordinates, works and energies, residuals."""
    run, settings = results.simulation, results.settings
    coordinates = _Coordinates(run)
    mobility = int(run.attrs["mobility"])
    yield Fact(Sentence("degrees of freedom"), Number(mobility, digits="d"))
    kept = Joined(tuple(map(Name, settings.keeps)))
    if settings.keeps:
        yield Fact(Sentence("drives that keep their law"), kept)
    law = str(run.attrs["driving"])
    if law != "0":
        first = Name(results.mechanism.drives[0].id)
        yield Fact(Sentence("driven by"), Sentence("{law} along {drive}", law=Name(law), drive=first))
    yield Fact(Sentence("equations"), Sentence("of all links, with the forces of the constraints"))
    redundant = int(run.attrs["redundant"])
    if redundant:
        yield Fact(Sentence("constraints that repeat others"), Number(redundant, digits="d"))
    yield Fact(Sentence("scheme"), _scheme(run))
    yield Fact(Sentence("ended"), _ending(run))
    for name in islice(coordinates.names, SHOWN):
        yield Fact(Joined((Sentence("coordinate"), Name(name)), " "), _range(coordinates, name))
    yield from facts_left_out(len(coordinates.names))
    yield Fact(Sentence("works"), works_at_end(run))
    yield Fact(Sentence("energies"), energies_at_end(run))
    yield Fact(Sentence("constraints"), _residuals(run))
    yield from _occasions(run)
    yield from _regime(results)
    yield from _rest(results)
    if "worst_imbalance" in run.attrs:
        share = Number(float(run.attrs["worst_imbalance"]), digits=".1e")
        yield Fact(
            Sentence("reactions"),
            Sentence(
                "free drives would have to give {share} of the greatest, in place of nothing", share=share
            ),
        )
    if results.second is not None:
        yield Fact(Sentence("reduced equation"), _second_route(results))


def _regime(results: SimulationResults) -> Iterator[Fact]:
    """The regime that the motion runs up to, and what is left of departures from it after a period."""
    periodic = results.periodic
    if periodic is None:
        return
    period = Number(periodic.period, "s", ".9g")
    left = Number(float(np.max(np.abs(periodic.multipliers), initial=0.0)), digits=".4g")
    if periodic.indifferent:
        text = Sentence("comes back every {period}, and so do neighbouring motions", period=period)
    elif periodic.stable:
        text = Sentence(
            "every {period}, of a departure {share} is left after each", period=period, share=left
        )
    else:
        text = Sentence(
            "every {period}, unstable: a departure becomes {share} times as great", period=period, share=left
        )
    yield Fact(Sentence("steady regime"), text)
    if periodic.turning is not None:
        yield Fact(Sentence("mean speed"), Number(periodic.mean_speed, "rad/s", unit_fixed=True))
    time = results.run_up_time
    if time is not None:
        yield Fact(
            Sentence("run-up"), Sentence("within one hundredth of it after {time}", time=Number(time, "s"))
        )


def _rest(results: SimulationResults) -> Iterator[Fact]:
    """When it has come to rest for good, and how far it went."""
    rest = results.rest
    if rest is None:
        return
    run = results.simulation
    names = run["coordinate"].values
    unit = _units(run["generalised_coordinate"], len(names))[rest.coordinate]
    yield Fact(
        Sentence("at rest"),
        Sentence(
            "after {time}; {coordinate} by {way} from its start",
            time=Number(rest.time, "s"),
            coordinate=Name(str(names[rest.coordinate])),
            way=Number(rest.way, unit),
        ),
    )


def _scheme(run: xr.Dataset) -> Text:
    scheme: Text = SCHEMES.get(str(run.attrs["scheme"]), Name(str(run.attrs["scheme"])))
    if run.attrs["executor"] == "machine code":
        scheme = Sentence("{scheme}, machine code", scheme=scheme)
    return Joined((scheme, Counted("{n} step", "{n} steps", int(run.attrs["steps"]))))


def _ending(run: xr.Dataset) -> Text:
    time = Number(float(run["time"].values[-1]) if run.sizes["sample"] else 0.0, "s")
    known = {
        "duration": Sentence("after {time}", time=time),
        "event": Sentence("at an event, after {time}", time=time),
        "change point": Sentence("at a change point that it does not pass, after {time}", time=time),
        "blow-up": Sentence("beyond all bounds, after {time}", time=time),
        "ambiguous friction": Sentence("where friction has no or several solutions, after {time}", time=time),
        "interrupted": Sentence("interrupted at {time}", time=time),
    }
    return known.get(str(run.attrs["ended"]), Sentence("broken off after {time}", time=time))


def _range(coordinates: _Coordinates, name: str) -> Text:
    values, unit = coordinates.course(name, 0), coordinates.units[coordinates.names.index(name)]
    if not values.size:
        return NOTHING
    ends = without_rounding([values.min(), values.max(), values[-1]]).tolist()
    least, greatest, last = (Number(value, unit) for value in ends)
    return Sentence("{least} to {greatest}, {last} at the end", least=least, greatest=greatest, last=last)


def _residuals(run: xr.Dataset) -> Text:
    place, speed = (
        float(np.max(run[name].values, initial=0.0)) for name in ("residual", "velocity_residual")
    )
    within_place, within_speed = Number(place, digits=".1e"), Number(speed, "1/s", ".1e")
    if not place and not speed:
        return Sentence("kept exactly")
    if not place:
        return Sentence(
            "kept exactly in positions and within {speed} in velocities, of the greatest length",
            speed=within_speed,
        )
    if not speed:
        return Sentence(
            "kept within {place} in positions, of the greatest length, and exactly in velocities",
            place=within_place,
        )
    return Sentence(
        "kept within {place} in positions and {speed} in velocities, of the greatest length",
        place=within_place,
        speed=within_speed,
    )


def _occasions(run: xr.Dataset) -> Iterator[Fact]:
    """What happened: change points that were passed, impacts, what stuck and slipped."""
    times = run["occasion_time"].values.tolist()
    yield from event_facts(run)
    if "friction_at_impacts" in run.attrs:
        yield Fact(
            Sentence("friction at impacts"),
            Sentence("takes no impulse: what the reactions of an impact would add is omitted"),
        )
    yield from occasion_facts(run, KINDS, [event_text(run, number) for number in range(len(times))])


def _difference(results: SimulationResults) -> tuple[float, float, str, float]:
    """Greatest difference of the drive's value between both routes, what it changes by, its unit, the time compared."""
    run, second = results.simulation, results.second
    assert second is not None
    count = second.sizes["sample"]
    one, other = (data["drive_value"].values[:count, 0] for data in (run, second))
    unit = drive_units(run)[0]
    return float(np.max(np.abs(one - other))), float(np.ptp(one)), unit, float(second["time"].values[-1])


def _second_route(results: SimulationResults) -> Text:
    apart, _size, unit, time = _difference(results)
    return Sentence(
        "the value of the drive differs by at most {apart} up to {time}",
        apart=Number(apart, unit, ".1e", unit_fixed=True),
        time=Number(time, "s"),
    )


# Table


def _table(run: xr.Dataset) -> Table:
    """Every variable along the samples, one row a sample."""
    columns = [Column("time", run["time"].values, "s")]
    for number, (name, unit) in enumerate(zip(run["drive"].values, drive_units(run), strict=True)):
        columns.append(Column(f"drive_{name}", run["drive_value"].values[:, number], unit))
    for variable in IN_CSV:
        if variable in run and "sample" in run[variable].dims:
            columns += _columns(run[variable], variable)
    return Table((*columns, status_column(run["status"]), Column("residual", run["residual"].values)))


def _columns(values: xr.DataArray, variable: str) -> Iterator[Column]:
    labels = [[str(one) for one in values[name].values] for name in values.dims if name != "sample"]
    flat = values.values.reshape(len(values), -1).astype(np.float64)
    heads = [variable]
    for names in labels:
        heads = [f"{head}_{name}" for head in heads for name in names]
    units = str(values.attrs.get("units", "")).split(", ")
    for number, head in enumerate(heads):
        unit = units[number % len(units)]
        yield Column(head, flat[:, number], "" if unit == "1" else unit)


# Figures


def _pictures(results: SimulationResults) -> Iterator[tuple[str, Callable[[], Picture]]]:
    """Coordinates over time, phase portraits, energies and works, paths of the points."""
    run, title = results.simulation, Title(results.mechanism.title)
    if run.sizes["sample"] < 2:
        return
    yield "simulation-coordinates", partial(_coordinates_plot, run, title)
    coordinates = _Coordinates(run)
    for name in coordinates.names[:PORTRAITS]:
        yield f"{PORTRAIT}{name}", partial(_portrait, run, title, name)
    yield "simulation-energies", partial(_energies_plot, run, title)
    if run.sizes["source"] > 1:
        yield "simulation-works", partial(_works_plot, run, title)
    yield "simulation-paths", partial(_paths, results)


def _over_time(run: xr.Dataset) -> Abscissa:
    return over_samples(quantity_label("time"), run["time"].values)


def _coordinates_plot(run: xr.Dataset, title: Title) -> Plot:
    """Values, velocities and accelerations below each other; angles and lengths in columns of their own."""
    coordinates = _Coordinates(run)
    rows = []
    for order, name in enumerate(COORDINATES["coordinates"]):
        row = []
        for unit in dict.fromkeys(coordinates.units):
            for names in deal_to_panels(coordinates.of_unit(unit)):
                row.append(_coordinate_panel(coordinates, names, order, QUANTITIES[name].symbol, unit))
        rows.append(tuple(row))
    return _with_events(run, Plot(TITLES["simulation-coordinates"], title, _over_time(run), tuple(rows)))


def _with_events(run: xr.Dataset, plot: Plot) -> Plot:
    """A plot over time with its events marked, and what sticks or is closed shaded."""
    return replace(plot, places=event_marks(run), shaded=held_stretches(run))


def _coordinate_panel(
    coordinates: _Coordinates, names: Sequence[str], order: int, symbol: str, unit: str
) -> CurvePanel:
    behind = ("", "/s", "/s^2")[order]
    curves = tuple(
        Curve(
            Name(name),
            coordinates.course(name, order),
            coordinates.names.index(name),
            slopes=coordinates.course(name, order + 1) if order < 2 else None,
        )
        for name in names
    )
    scale = max(float(np.max(np.abs(curve.values), initial=0.0)) for curve in curves)
    return CurvePanel(
        AxisLabel(symbol=Symbol(symbol), unit=f"{unit}{behind}"), curves, scale, legend=order == 0
    )


def _portrait(run: xr.Dataset, title: Title, name: str) -> Plot:
    """The velocity of a coordinate over its value."""
    coordinates = _Coordinates(run)
    number = coordinates.names.index(name)
    unit = coordinates.units[number]
    values, speeds, samples = _between_samples(
        run["time"].values,
        [coordinates.course(name, order) for order in range(3)],
        run["occasion_time"].values,
    )
    label = AxisLabel(Name(name), Symbol("q"), unit)
    panel = CurvePanel(
        AxisLabel(symbol=Symbol("q̇"), unit=f"{unit}/s"),
        (Curve(Name(name), speeds, number),),
        float(np.max(np.abs(speeds), initial=0.0)),
        legend=False,
        dots=((Sentence("start"), float(values[0]), float(speeds[0])),),
    )
    # a curve that turns at its ends would run along the sides of the picture
    margin = MARGIN * float(np.ptp(values))
    ends = (float(np.min(values)) - margin, float(np.max(values)) + margin) if margin else None
    abscissa = replace(over_samples(label, values), ends=ends, samples=samples)
    return Plot(Sentence("Phase portrait of {name}", name=Name(name)), title, abscissa, ((panel,),))


def _between_samples(
    time: Array, course: Sequence[Array], occasions: Array
) -> tuple[Array, Array, NDArray[np.intp]]:
    """Values and speeds (n) of a coordinate at its samples, between them where a chord would be seen; samples' places.

    Samples follow the time that is simulated, and an oscillation may have only a dozen in each of its periods. Cubics
    with the slopes of both ends lead from sample to sample; not over an occasion, at which a speed or an acceleration
    jumps.
    """
    values, speeds, accelerations = course
    step = np.diff(time)
    share = np.linspace(0.0, 1.0, FINER, endpoint=False)
    weights = np.array(
        [
            (1.0 + 2.0 * share) * (1.0 - share) ** 2,
            share * (1.0 - share) ** 2,
            share**2 * (3.0 - 2.0 * share),
            share**2 * (share - 1.0),
        ]
    )
    curves, bent = [], np.zeros(len(step), dtype=bool)
    for numbers, slopes in ((values, speeds), (speeds, accelerations)):
        ends = np.array([numbers[:-1], slopes[:-1] * step, numbers[1:], slopes[1:] * step])
        curve = ends.T @ weights
        chord = ends[0][:, None] + np.outer(ends[2] - ends[0], share)
        bent |= np.max(np.abs(curve - chord), axis=1) > SEEN * np.ptp(numbers)
        curves.append(curve)
    jumps = np.searchsorted(occasions, time[:-1], "left") < np.searchsorted(occasions, time[1:], "right")
    shown = np.zeros((len(step), FINER), dtype=bool)
    shown[:, 0] = True
    shown[bent & ~jumps] = True
    places, rates = (np.append(curve[shown], end[-1]) for curve, end in zip(curves, course[:2], strict=True))
    return places, rates, np.append(np.flatnonzero(np.nonzero(shown)[1] == 0), len(places) - 1)


def _energies_plot(run: xr.Dataset, title: Title) -> Plot:
    # works that are zero all the time would hide each other
    works = [name for name in WORKS if np.any(run[name].values)]
    groups = (("kinetic_energy", "potential_energy"), works, ("energy_residual",))
    rows = tuple((_panel(run, names),) for names in groups if names)
    return _with_events(run, Plot(TITLES["simulation-energies"], title, _over_time(run), rows))


def _panel(run: xr.Dataset, variables: Sequence[str]) -> CurvePanel:
    letter = QUANTITIES[variables[0]].symbol.partition("_")[0]
    return quantities_panel(run, variables, Symbol(letter))


def _works_plot(run: xr.Dataset, title: Title) -> Plot:
    names = [str(name) for name in run["source"].values]
    rows = []
    for group in deal_to_panels(names):
        curves = tuple(
            Curve(Name(name), run["work_part"].values[:, names.index(name)], names.index(name))
            for name in group
        )
        label = AxisLabel(symbol=Symbol("A"), unit="J")
        rows.append((CurvePanel(label, curves, great_value(run, "work_part")),))
    return Plot(TITLES["simulation-works"], title, _over_time(run), tuple(rows))


def _paths(results: SimulationResults) -> PathsPicture:
    mechanism, run = results.mechanism, results.simulation
    return PathsPicture(
        Sentence("Paths of the points"), mechanism, run, mechanism.moving_points, _over_time(run)
    )


# Chapter


def _chapter(results: SimulationResults) -> Chapter:
    """The motion in the equations of all links, what it did, and the motion itself, which a page plays."""
    run = results.simulation
    text = Sentence(
        "The motion is not prescribed: it follows from the equations of all links together with the forces of the "
        "constraints where loops close. No coordinate drives, so dead positions are positions as any others."
    )
    equations = Formula(
        (
            ("bold(M) dot.double(bold(q))", "bold(F) - bold(G)^upright(T) bold(lambda)"),
            ("bold(G) dot.double(bold(q))", "-dot(bold(G)) dot(bold(q))"),
        )
    )
    figures = tuple(
        Illustration(
            picture(),
            CAPTIONS.get(name)
            or Sentence("Phase portrait of {name}", name=Name(name.removeprefix(PORTRAIT))),
        )
        for name, picture in _pictures(results)
    )
    sections = (
        Section(NOTHING, (Paragraph(text), equations, FactTable(tuple(_facts(results))), *_checks(results))),
        Section(Sentence("Over time"), (*_players(results), _course(run), *_events_of_chapter(run))),
        Section(NOTHING, figures),
    )
    return Chapter(Sentence("Motion under loads"), sections)


def _events_of_chapter(run: xr.Dataset) -> Iterator[Table]:
    """The events, with impulses and energies."""
    if "occasion_part" in run:
        yield replace(event_table(run, caption=True), rows=rows_shown(run.sizes["occasion"]))


def _course(run: xr.Dataset) -> Table:
    """Coordinates, velocities and energies at some of the samples."""
    coordinates = _Coordinates(run)
    columns = [Column("time", run["time"].values, "s", Expression("t"))]
    for name in coordinates.names[:4]:
        unit = coordinates.units[coordinates.names.index(name)]
        columns += [
            Column(name, coordinates.course(name, 0), unit, Name(name)),
            Column(
                f"{name}_velocity",
                coordinates.course(name, 1),
                f"{unit}/s",
                Joined((Name(name), Symbol("q̇")), " "),
            ),
        ]
    for name, letter in (("kinetic_energy", "T"), ("potential_energy", "V")):
        columns.append(Column(name, run[name].values, "J", Expression(letter)))
    return Table(tuple(columns), Sentence("The motion over time"), rows_shown(run.sizes["sample"]))


def _checks(results: SimulationResults) -> Iterator[Check]:
    """What the works do not account for, and the second route."""
    run, steps = results.simulation, int(results.simulation.attrs["steps"])
    tolerance = results.settings.tolerance
    if not run.sizes["sample"]:
        return
    turned_over = [
        float(np.max(np.abs(run[name].values), initial=0.0)) for name in ("work_of_drive", "work_of_friction")
    ]
    turned_over += [
        float(np.ptp(run["potential_energy"].values)),
        float(np.max(run["kinetic_energy"].values)),
    ]
    yield Check(
        RESIDUAL,
        float(np.abs(run["energy_residual"].values).max()),
        max(turned_over),
        max(steps, 1) * SAFETY * tolerance,
    )
    if results.second is not None:
        apart, size, _unit, _time = _difference(results)
        yield Check(
            Sentence(
                "The reduced equation as a second route: the drive's value differs by {share} of its change."
            ),
            apart,
            size,
            max(steps, 1) * SAFETY * tolerance,
        )
