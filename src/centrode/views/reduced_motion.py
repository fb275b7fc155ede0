"""The motion of a machine with one drive that is left to itself: terminal, files, figures and document."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import pi, tau
from typing import TYPE_CHECKING

import numpy as np

from centrode.kinematics.hinge_angles import moving_hinges
from centrode.quantities import QUANTITIES
from centrode.sheets.players import MotionPlayer
from centrode.sheets.plots import Abscissa, AxisLabel, Curve, CurvePanel, Plot
from centrode.sheets.sheet import (
    Chapter,
    Check,
    Column,
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
    Unit,
)
from centrode.views.columns import motion_table, rows_shown, without_rounding
from centrode.views.energy_balance import (
    ADAPTIVE,
    ENERGIES_CAPTION,
    ENERGIES_TITLE,
    RESIDUAL,
    STIFF,
    WORKS,
    energies_at_end,
    occasion_facts,
    works_at_end,
)
from centrode.views.motion_events import marked_events
from centrode.views.motion_plots import over_samples, quantities_panel, quantity_label

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from centrode.dynamics.simulation.results import SimulationResults
    from centrode.dynamics.simulation.steady_state import Regime

NO_DEVIATION = 1e-6
"""A multiplier below this is rounding of the map's differences."""
EVALUATIONS = 12
"""Accelerations that a step of the adaptive scheme computes at least."""

SCHEMES = {
    "adaptive": Sentence("adaptive ({solver})", solver=ADAPTIVE),
    "stiff": Sentence("for stiff laws ({solver})", solver=STIFF),
    "adaptive, then stiff": Sentence(
        "adaptive ({first}), then for stiff laws ({second})", first=ADAPTIVE, second=STIFF
    ),
    "runge-kutta-4": Sentence("Runge-Kutta of fourth order, fixed steps"),
}
OCCASIONS = {
    "turns_back": Sentence("reversal"),
    "sticks": Sentence("stopped by friction"),
    "breaks_loose": Sentence("breakaway"),
    "limit": Sentence("limit"),
    "change_point": Sentence("change point"),
    "standstill": Sentence("final stop"),
}
IN_TABLE = (
    ("time", "t"),
    ("turned", "phi"),
    ("drive_speed", "dot(q)"),
    ("drive_acceleration", "dot.double(q)"),
    ("driving_moment", "M_upright(d)"),
    ("kinetic_energy", "T"),
)
PANELS = {
    "simulation-speed": (("drive_speed",), ("drive_acceleration",), ("driving_moment", "moment_of_loads")),
    "simulation-phase": (("drive_speed",),),
    "simulation-energies": (
        ("kinetic_energy", "potential_energy"),
        WORKS,
        ("energy_residual",),
    ),
}
TITLES = {
    "simulation-speed": Sentence("Speed of the drive and the moments on it"),
    "simulation-phase": Sentence("Speed over the generalised coordinate"),
    "simulation-energies": ENERGIES_TITLE,
    "simulation-angles": Sentence("Speed of the drive and angles over its value"),
}
CAPTIONS: dict[str, Text] = {
    "simulation-speed": Sentence("Speed and acceleration of the drive, and the moments on it, over time"),
    "simulation-phase": Sentence("Speed over the generalised coordinate"),
    "simulation-energies": ENERGIES_CAPTION,
    "simulation-angles": Sentence(
        "Speed of the drive, angle $gamma$ of the coupler to the path of its hinge and angle $psi$ of the driven link "
        "over the generalised coordinate"
    ),
}


def reduced_sheet(results: SimulationResults) -> Sheet:
    """Everything there is to say about a motion by the reduced equation."""
    run = results.simulation
    points = results.mechanism.moving_points if "position" in run else None
    return Sheet(
        facts=(*_facts(results), *_regime_facts(results)),
        tables={"simulation": motion_table(run, points)},
        datasets={"simulation": run},
        pictures=dict(_pictures(results)),
        chapters={"simulation": _chapter(results)},
        printed=_players(results),
    )


def _players(results: SimulationResults) -> tuple[MotionPlayer, ...]:
    """The motion itself, which a page plays, where the places of the points are there."""
    run = results.simulation
    if "position" not in run or run.sizes["sample"] < 2:
        return ()
    return (MotionPlayer(results.mechanism, run, by_time=True, marks=marked_events(run, OCCASIONS)),)


# Facts


def _facts(results: SimulationResults) -> Iterator[Fact]:
    """What moved, how it ended, speeds, works and energies."""
    run = results.simulation
    speed, unit = run["drive_speed"].values, str(run["drive_speed"].attrs["units"])
    least, greatest, last = (
        Number(value, unit, unit_fixed=True)
        for value in without_rounding([speed.min(), speed.max(), speed[-1]]).tolist()
    )
    turns = results.mechanism.drives[0].kind == "angle"
    yield Fact(Sentence("drives"), Joined(tuple(Name(str(name)) for name in run["drive"].values)))
    yield Fact(Sentence("driven by"), _driven_by(run))
    yield Fact(Sentence("scheme"), _scheme(run))
    yield Fact(Sentence("ended"), _ending(run))
    yield Fact(Sentence("turned") if turns else Sentence("moved"), _turns(run))
    yield Fact(
        Sentence("speed of the drive"),
        Sentence(
            "{least} to {greatest}, {last} at the end",
            least=replace(least, unit_hidden=True),
            greatest=greatest,
            last=last,
        ),
    )
    yield Fact(Sentence("works"), works_at_end(run))
    yield Fact(Sentence("energies"), energies_at_end(run))
    yield from _occasions(run)


def _driven_by(run: xr.Dataset) -> Text:
    law, unit = str(run.attrs["driving"]), str(run["driving_moment"].attrs["units"])
    return Sentence("nothing") if law == "0" else Joined((Name(law), Unit(unit)), " ")


def _scheme(run: xr.Dataset) -> Text:
    scheme = SCHEMES[run.attrs["scheme"]]
    if run.attrs["executor"] == "machine code":
        scheme = Sentence("{scheme}, machine code", scheme=scheme)
    count = int(run.attrs["evaluations"])
    return Joined((scheme, Counted("{n} acceleration computed", "{n} accelerations computed", count)))


def _ending(run: xr.Dataset) -> Text:
    time = Number(float(run["time"].values[-1]), "s")
    return {
        "duration": Sentence("after {time}", time=time),
        "turns": Sentence("after the given number of turns, in {time}", time=time),
        "limit": Sentence("at a limit of the mechanism, after {time}", time=time),
        "change point": Sentence("at a change point, where its path ends, after {time}", time=time),
        "standstill": Sentence("the machine has stopped; {time} are shown", time=time),
        "interrupted": Sentence("interrupted at {time}", time=time),
    }[run.attrs["ended"]]


def _turns(run: xr.Dataset) -> Text:
    turned, unit = float(run["turned"].values[-1]), str(run["turned"].attrs["units"])
    value = _value(turned, unit)
    return (
        Sentence("{value}, {turns} turns", value=value, turns=Number(turned / tau))
        if unit == "rad"
        else value
    )


def _value(value: float, unit: str) -> Number:
    """A value of the drive."""
    return Number(value, unit, ".9g", degrees_too=True)


def _occasions(run: xr.Dataset) -> Iterator[Fact]:
    """When and where it turned back, stuck, came to a limit."""
    unit = str(run["occasion_value"].attrs["units"])
    times, values = (run[name].values.tolist() for name in ("occasion_time", "occasion_value"))
    places: list[Text] = [
        Sentence("at {time}, drive at {value}", time=Number(time, "s"), value=_value(value, unit))
        for time, value in zip(times, values, strict=True)
    ]
    return occasion_facts(run, OCCASIONS, places)


def _regime_facts(results: SimulationResults) -> tuple[Fact, ...]:
    if results.regime is not None:
        return tuple(_of_regime(results.regime))
    if not results.no_regime:
        return ()
    reason = Sentence("none found: {reason}", reason=Name(results.no_regime))
    return (Fact(Sentence("steady regime"), reason),)


def _of_regime(regime: Regime) -> Iterator[Fact]:
    """Period, speeds and where they lie, fluctuation, how fast deviations die away.

    Where any speed would come back, as of a conservative machine, it is a periodic motion and no steady regime.
    """
    turns = Counted("{n} turn of the drive", "{n} turns of the drive", regime.turns)
    yield Fact(
        Sentence("periodic motion") if regime.indifferent else Sentence("steady regime"),
        Joined((turns, Number(regime.time, "s"))),
    )
    yield Fact(Sentence("least speed"), _speed_at(regime.least_speed, regime.least_at))
    yield Fact(Sentence("greatest speed"), _speed_at(regime.greatest_speed, regime.greatest_at))
    mean = Number(regime.mean_speed, "rad/s", unit_fixed=True)
    yield Fact(Sentence("mean speed"), Sentence("{speed} (average over time)", speed=mean))
    yield Fact(Sentence("fluctuation"), Number(regime.fluctuation))
    yield Fact(Sentence("mean driving moment"), Number(regime.driving_moment, "N m"))
    yield Fact(Sentence("stability"), _stability(regime))


def _speed_at(speed: float, value: float) -> Text:
    return Sentence(
        "{speed} with the drive at {value}",
        speed=Number(speed, "rad/s", unit_fixed=True),
        value=_value(value, "rad"),
    )


def _stability(regime: Regime) -> Text:
    if regime.indifferent:
        return Sentence("every speed repeats after a period: there is no limit cycle")
    if regime.multiplier > 1.0:
        return Sentence("a deviation of the speed does not decay")
    if abs(regime.multiplier) < NO_DEVIATION:
        return Sentence("a deviation vanishes within one period")
    share = Number(regime.multiplier, digits=".3g")
    return Sentence("{share} of a deviation remains after one period", share=share)


# Figures


def _pictures(results: SimulationResults) -> Iterator[tuple[str, Plot]]:
    """Speed and moments over time, the speed over the value of the drive, energies and works over time."""
    run, title = results.simulation, Title(results.mechanism.title)
    time = over_samples(quantity_label("time"), run["time"].values)
    for name, panels in PANELS.items():
        rows = tuple((_panel(run, variables),) for variables in panels)
        abscissa = _phase(results) if name == "simulation-phase" else time
        yield name, Plot(TITLES[name], title, abscissa, rows)
    of_angles = _angle_panels(results)
    if of_angles:
        rows = tuple((panel,) for panel in of_angles)
        yield "simulation-angles", Plot(TITLES["simulation-angles"], title, _phase(results), rows)


def _angle_panels(results: SimulationResults) -> list[CurvePanel]:
    """On the sphere: the speed of the drive, and below it the angles of the coupler and of what is driven.

    The angle of a coupler against a link that turns about a fixed point is counted from the direction in which their
    hinge moves: there it is the pressure angle with a sign.
    """
    run, mechanism = results.simulation, results.mechanism
    if "joint_angle" not in run or not mechanism.motion_parameter.turns:
        return []
    panels = [replace(_panel(run, ("drive_speed",)), legend=False)]
    rockers = [name for name in run["joint"].values.tolist() if name not in run["drive"].values.tolist()]
    coupler = [
        Curve(
            Sentence("{link} to the path of {point}", link=Name(hinge.links[0]), point=Name(hinge.point)),
            _from_path(run["hinge_angle"].sel(hinge=hinge.label).values),
            place,
        )
        for place, hinge in enumerate(moving_hinges(mechanism))
        if hinge.links[1] in rockers
    ]
    driven = [
        Curve(Name(name), run["joint_angle"].sel(joint=name).values, k) for k, name in enumerate(rockers)
    ]
    for letter, curves in (("γ", coupler), ("ψ", driven)):
        if curves:
            scale = max(float(np.nanmax(np.abs(curve.values), initial=0.0)) for curve in curves)
            panels.append(CurvePanel(AxisLabel(symbol=Symbol(letter), unit="rad"), tuple(curves), scale))
    return panels


def _from_path(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """What an angle between links leaves to a right angle: positive where it is acute."""
    known = angle[np.isfinite(angle)]
    sense = -1.0 if known.size and known[0] < 0.0 else 1.0
    return np.asarray(0.5 * pi - sense * angle)


def _phase(results: SimulationResults) -> Abscissa:
    """The drive's value; of one that turns on and on within one turn, with gaps where a new one begins."""
    parameter, values = results.mechanism.motion_parameter, results.simulation["drive_value"].values[:, 0]
    abscissa = over_samples(replace(quantity_label("drive_value"), unit=parameter.drives[0].unit), values)
    if not parameter.turns or np.ptp(values) <= tau:
        return abscissa
    turn = np.floor(values / tau)
    return replace(abscissa, values=values - tau * turn, breaks=np.flatnonzero(np.diff(turn)) + 1)


def _panel(run: xr.Dataset, variables: Sequence[str]) -> CurvePanel:
    """Curves of several variables of one unit, which depends on what the drive moves."""
    letter = QUANTITIES[variables[0]].symbol.partition("_")[0]
    label = AxisLabel(symbol=Symbol(letter), unit=str(run[variables[0]].attrs["units"]))
    return replace(quantities_panel(run, variables, Symbol(letter)), label=label)


# Chapter


def _chapter(results: SimulationResults) -> Chapter:
    """The motion under loads and a drive, and the steady regime."""
    text = Sentence(
        "The motion of the drive is not prescribed: it follows from the reduced moment of inertia and the "
        "reduced moments of drive and loads."
    )
    equation = Formula((("J dot.double(q) + 1/2 J' dot(q)^2", "M_upright(d) + M"),))
    sections = (
        Section(
            NOTHING, (Paragraph(text), equation, FactTable(tuple(_facts(results))), *_energy_check(results))
        ),
        Section(Sentence("Over time"), (_course(results.simulation),)),
        *_regime_section(results),
        Section(NOTHING, tuple(_figures(results))),
    )
    return Chapter(Sentence("Motion under loads"), sections)


def _figures(results: SimulationResults) -> Iterator[Illustration]:
    """The figures; the residual of the energies is among the checks."""
    for name, plot in _pictures(results):
        rows = plot.rows[:-1] if name == "simulation-energies" else plot.rows
        yield Illustration(replace(plot, rows=rows), CAPTIONS[name])


def _course(run: xr.Dataset) -> Table:
    columns = tuple(
        Column(
            name,
            run[name].values,
            "s" if name == "time" else str(run[name].attrs["units"]),
            Expression(letter),
        )
        for name, letter in IN_TABLE
        if name in run.variables
    )
    return Table(columns, Sentence("The motion at equal steps of time"), rows_shown(run.sizes["sample"]))


def _energy_check(results: SimulationResults) -> Iterator[Check]:
    """What the works do not account for; the adaptive schemes promise their tolerance at every step."""
    run = results.simulation
    if run.attrs["scheme"] == "runge-kutta-4":
        return
    works = [
        np.abs(run[name].values).max() for name in ("work_of_drive", "work_of_friction", "kinetic_energy")
    ]
    steps = int(run.attrs["evaluations"]) / EVALUATIONS
    yield Check(
        RESIDUAL,
        float(np.abs(run["energy_residual"].values).max()),
        float(max(works)),
        steps * results.settings.tolerance,
    )


def _regime_section(results: SimulationResults) -> Iterator[Section]:
    """The steady regime, or the periodic motion, of a drive that has turned all the way round."""
    regime = results.regime
    if regime is not None:
        title = Sentence("Periodic motion") if regime.indifferent else Sentence("Steady regime")
        yield Section(title, (FactTable(tuple(_of_regime(regime))),))
    elif results.no_regime:
        reason = Sentence("None is found: {reason}.", reason=Name(results.no_regime))
        yield Section(Sentence("Steady regime"), (Paragraph(reason),))
