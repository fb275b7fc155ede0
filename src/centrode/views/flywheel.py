"""The flywheel of a machine and its real motion: what the terminal, the files, the figures and the document show."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from centrode.dynamics.steady_motion.flywheel import SOURCE_DISC, SOURCE_RIM, Wheel
from centrode.sheets.plots import (
    AxisLabel,
    Curve,
    CurveDiagram,
    CurvePanel,
    CurveRole,
    Plot,
    Trace,
    TraceKind,
)
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Paragraph,
    Reference,
    Scalar,
    Section,
    Sheet,
    Table,
    illustrations,
)
from centrode.sheets.texts import (
    NOTHING,
    Counted,
    Expression,
    Factor,
    Joined,
    Leaf,
    Name,
    Number,
    Sentence,
    Symbol,
    Text,
    Title,
)
from centrode.views.columns import motion_table, rows_shown
from centrode.views.drive_balance import SENSE, driving_lines, links_line, moment_of_links
from centrode.views.instants import instant_title
from centrode.views.motion_plots import (
    PlottedMotion,
    over_samples,
    panels_of_links,
    panels_of_points,
    quantities_panel,
    quantity_label,
)

if TYPE_CHECKING:
    import xarray as xr

    from centrode.dynamics.steady_motion.flywheel import Flywheel
    from centrode.dynamics.steady_motion.machine import MachineResults
    from centrode.sheets.pictures import Picture

UNITS = {
    "mean_speed": "rad/s",
    "fluctuation": "1",
    "turns": "1",
    "work_of_loads": "J",
    "driving_moment": "N m",
    "error": "J",
    "energy_greatest": "J",
    "greatest_at": "rad",
    "energy_least": "J",
    "least_at": "rad",
    "present": "kg m^2",
    "least_speed": "rad/s",
    "greatest_speed": "rad/s",
    "time_of_cycle": "s",
    "obtained": "1",
    "inertia_first_order": "kg m^2",
    "inertia_by_tangents": "kg m^2",
    "inertia": "kg m^2",
    "inertia_in_time": "kg m^2",
    "added": "kg m^2",
    "added_first_order": "kg m^2",
}
WHEEL_UNITS = {
    "outer": "m",
    "inner": "m",
    "width": "m",
    "mass": "kg",
    "inertia": "kg m^2",
    "rim_speed": "m/s",
}
WHEELS = ("rim", "disc", "source_rim", "source_disc")
MEANS = {"middle": Sentence("mean of the greatest and the least"), "time": Sentence("average over time")}

ENERGIES_IN_TABLE = (
    ("turned", "phi"),
    ("moment_of_loads", "M_upright(c)"),
    ("work_of_loads", "A_upright(c)"),
    ("work_of_drive", "A_upright(d)"),
    ("inertia_of_links", 'J_upright("II")'),
    ("energy_of_links", 'T_upright("II")'),
    ("energy_change", "Delta T_upright(I)"),
)
SPEEDS_IN_TABLE = (
    ("turned", "phi"),
    ("drive_speed", "omega"),
    ("drive_acceleration", "epsilon"),
    ("drive_speed_first_order", "omega_1"),
    ("drive_acceleration_first_order", "epsilon_1"),
)


def sheet(results: MachineResults) -> Sheet:
    """Everything there is to say about the energies, the flywheel and the real motion of a machine."""
    mechanism, flywheel = results.mechanism, results.flywheel
    points = mechanism.moving_points
    facts = (*_energies(flywheel), *_inertias(flywheel), _speed(flywheel), *_sizes(flywheel))
    tables = {"machine": motion_table(results.steady, points)}
    if results.instants is not None:
        tables["machine-instants"] = motion_table(results.instants, points)
    return Sheet(
        facts=facts,
        scalars=dict(scalars(flywheel)),
        tables=tables,
        datasets={"machine": results.steady},
        pictures=dict(_pictures(results)),
        chapters={
            "flywheel": _flywheel_chapter(results, facts),
            "real-motion": _real_motion_chapter(results),
        },
    )


def scalars(flywheel: Flywheel) -> Iterator[tuple[str, Scalar]]:
    """Numbers by name, in SI, without what does not exist; those of a wheel have its name in front."""
    for field in fields(flywheel):
        value = getattr(flywheel, field.name)
        if field.name in UNITS and value is not None:
            yield f"machine_{field.name}", Scalar(value, UNITS[field.name])
        if field.name in WHEELS and value is not None:
            for name, unit in WHEEL_UNITS.items():
                yield f"flywheel_{field.name}_{name}", Scalar(getattr(value, name), unit)


# Facts


def _works(flywheel: Flywheel) -> tuple[float, float]:
    """Work of the loads [J] and mean driving moment [N m]: weights take as much as they give, the rest is rounding."""
    idle = abs(flywheel.work_of_loads) <= flywheel.error
    return (0.0, 0.0) if idle else (flywheel.work_of_loads, flywheel.driving_moment)


def _energies(flywheel: Flywheel) -> list[Fact]:
    work, moment = _works(flywheel)
    turns = Counted("{n} turn of the drive", "{n} turns of the drive", flywheel.turns)
    mean_speed = Number(flywheel.mean_speed, "rad/s", unit_fixed=True)
    change = Sentence(
        "{greatest} at {greatest_at}, {least} at {least_at}, range {range}",
        greatest=Number(flywheel.energy_greatest, "J"),
        greatest_at=Number(degrees(flywheel.greatest_at), "deg", ".5g"),
        least=Number(flywheel.energy_least, "J"),
        least_at=Number(degrees(flywheel.least_at), "deg", ".5g"),
        range=Number(flywheel.energy_greatest - flywheel.energy_least, "J"),
    )
    return [
        Fact(Sentence("cycle"), Joined((turns, Number(flywheel.time_of_cycle, "s")))),
        Fact(
            Sentence("mean speed"),
            Sentence("{value} ({remark})", value=mean_speed, remark=MEANS[flywheel.mean]),
        ),
        Fact(
            Sentence("work of the loads"),
            Sentence(
                "{work} per cycle, within {error}",
                work=Number(work, "J"),
                error=Number(flywheel.error, "J", ".1e"),
            ),
        ),
        Fact(Sentence("mean driving moment"), Number(moment, "N m")),
        Fact(Sentence("change of energy"), change),
    ]


def _inertias(flywheel: Flywheel) -> list[Fact]:
    """Inertia needed by each route, inertia present, and what the flywheel adds."""
    present = Fact(Sentence("inertia present"), Number(flywheel.present, "kg m^2"))
    first_order, needed, in_time, by_tangents = (
        flywheel.inertia_first_order,
        flywheel.inertia,
        flywheel.inertia_in_time,
        flywheel.inertia_by_tangents,
    )
    if needed is None or first_order is None or in_time is None or by_tangents is None:
        return [present]
    exactly = Sentence(
        "{middle} exactly ({time} where the mean speed is the average over time)",
        middle=Number(needed, "kg m^2"),
        time=Number(in_time, "kg m^2", unit_hidden=True),
    )
    if flywheel.mean == "time":
        exactly = Sentence("{inertia} exactly", inertia=Number(in_time, "kg m^2"))
    approximately = Sentence(
        "{inertia} by the first-order formula ({difference})",
        inertia=Number(first_order, "kg m^2"),
        difference=Number((first_order - needed) / abs(needed) if needed else 0.0, digits="+.2%"),
    )
    tangents = Sentence("{inertia} by Wittenbauer's diagram", inertia=Number(by_tangents, "kg m^2"))
    added = Number(flywheel.added, "kg m^2") if flywheel.added else Sentence("none is needed")
    return [
        Fact(Sentence("inertia needed"), exactly),
        Fact(NOTHING, tangents),
        Fact(NOTHING, approximately),
        present,
        Fact(Sentence("flywheel"), added),
    ]


def _speed(flywheel: Flywheel) -> Fact:
    speeds = Sentence(
        "{least} to {greatest}, fluctuation {obtained}",
        least=Number(flywheel.least_speed, "rad/s", unit_fixed=True, unit_hidden=True),
        greatest=Number(flywheel.greatest_speed, "rad/s", unit_fixed=True),
        obtained=Number(flywheel.obtained),
    )
    return Fact(Sentence("speed of the drive"), speeds)


def _sizes(flywheel: Flywheel) -> Iterator[Fact]:
    """Sizes of a rim and of a disc: exactly, and by the coefficients of the coursework where they apply."""
    shapes = (
        (Sentence("rim"), flywheel.rim, flywheel.source_rim, SOURCE_RIM),
        (Sentence("disc"), flywheel.disc, flywheel.source_disc, SOURCE_DISC),
    )
    for label, exact, source, coefficient in shapes:
        if exact is not None:
            yield Fact(label, _size(exact))
        if source is not None and flywheel.added_first_order:
            yield Fact(
                NOTHING,
                Sentence(
                    "by the coefficient {coefficient}: {outer}, {mass}, actual {inertia} ({error})",
                    coefficient=Number(coefficient),
                    outer=Number(source.outer, "m", ".4g"),
                    mass=Number(source.mass, "kg", ".5g"),
                    inertia=Number(source.inertia, "kg m^2"),
                    error=Number(source.inertia / flywheel.added_first_order - 1, digits="+.1%"),
                ),
            )


def _size(wheel: Wheel) -> Text:
    hole = Sentence(", {inner} inside", inner=Number(wheel.inner, "m", ".4g")) if wheel.inner else NOTHING
    size = Sentence(
        "{outer} across{hole}, {width} wide, {mass}",
        outer=Number(wheel.outer, "m", ".4g"),
        hole=hole,
        width=Number(wheel.width, "m", ".4g"),
        mass=Number(wheel.mass, "kg", ".5g"),
    )
    edge: Text = Sentence("{speed} at its edge", speed=Number(wheel.rim_speed, "m/s", ".4g", unit_fixed=True))
    if wheel.bounded:
        edge = Joined((edge, Sentence("(admissible: the width follows)")), " ")
    return Joined((size, edge))


# Figures


def _moments(steady: xr.Dataset) -> CurvePanel:
    """Moments of the loads and of the drive, and their sum."""
    parts = ("moment_of_loads", "driving_moment")
    panel = quantities_panel(steady, parts, Symbol("M"))
    values = np.sum([steady[name].values for name in parts], axis=0)
    return replace(
        panel, curves=(*panel.curves, Curve(Sentence("sum"), values, len(parts), role=CurveRole.SUM))
    )


def _pictures(results: MachineResults) -> Iterator[tuple[str, Picture]]:
    """Figures by name; those without a curve are left out."""
    mechanism, steady = results.mechanism, results.steady
    motion, turned = PlottedMotion(mechanism, steady), steady["turned"].values
    abscissa, title = over_samples(quantity_label("turned"), turned), Title(mechanism.title)
    plots = {
        "moments": (
            Sentence("Moments on the drive and inertia of the links"),
            (
                (_moments(steady),),
                (quantities_panel(steady, ("inertia_of_links",), Symbol("J", "II")),),
                (quantities_panel(steady, ("inertia_slope_of_links",), Symbol("J′", "II")),),
            ),
        ),
        "works": (
            Sentence("Works over the cycle"),
            ((quantities_panel(steady, ("work_of_drive", "work_of_loads", "work"), Symbol("A")),),),
        ),
        "energies": (
            Sentence("Energies over the cycle"),
            ((quantities_panel(steady, ("work", "energy_of_links", "energy_change"), Symbol("T")),),),
        ),
        "drive-speed": (
            Sentence("Speed and acceleration of the drive"),
            tuple(
                (
                    quantities_panel(
                        steady, (exact, f"{exact}_first_order"), symbol, (f"{exact}_first_order",)
                    ),
                )
                for exact, symbol in (("drive_speed", Symbol("ω")), ("drive_acceleration", Symbol("ε")))
            ),
        ),
        "real-angular-velocities": (
            Sentence("Real angular velocities of the links"),
            panels_of_links(motion, "angular_velocity"),
        ),
        "real-angular-accelerations": (
            Sentence("Real angular accelerations of the links"),
            panels_of_links(motion, "angular_acceleration"),
        ),
        "real-velocities": (
            Sentence("Real velocities of the points"),
            panels_of_points(motion, "velocity"),
        ),
        "real-accelerations": (
            Sentence("Real accelerations of the points"),
            panels_of_points(motion, "acceleration"),
        ),
    }
    for name, (what, rows) in plots.items():
        if any(panel.curves for row in rows for panel in row):
            yield name, Plot(what, title, abscissa, rows)
    if "tangent_slopes" in steady.attrs:
        yield "wittenbauer", _wittenbauer(steady, title)


def _wittenbauer(steady: xr.Dataset, mechanism: Title) -> CurveDiagram:
    """Work over the inertia of the links, with the tangents of the least and the greatest speed."""
    inertia = steady["inertia_of_links"].values
    work = (steady["energy_change"] + steady["energy_of_links"]).values
    reach = np.array([0.0, 1.08 * float(inertia.max())])
    slopes, starts = steady.attrs["tangent_slopes"], steady.attrs["tangent_intercepts"]
    names = (Sentence("tangent of the least speed"), Sentence("tangent of the greatest speed"))
    tangents = [
        Trace(
            Sentence(
                "{name}, slope {slope}", name=name, slope=Number(slope, "rad^2/s^2", ".5g", unit_fixed=True)
            ),
            reach,
            start + slope * reach,
            TraceKind.LINE,
            _touching(steady, at, slope, start),
        )
        for name, slope, start, at in zip(
            names, slopes, starts, steady.attrs["tangents_touch_at"], strict=True
        )
    ]
    # the tangents cut a segment off the axis of works: over the difference of slopes it is the inertia needed
    length, turn = starts[1] - starts[0], slopes[1] - slopes[0]
    segment = Sentence(
        "{length} between them; over {slopes}\nit is {symbol} = {inertia}",
        length=Number(length, "J", ".5g"),
        slopes=Number(turn, "rad^2/s^2", ".5g", unit_fixed=True),
        symbol=Symbol("J"),
        inertia=Number(length / turn, "kg m^2"),
    )
    return CurveDiagram(
        Sentence("Wittenbauer's diagram: work over the inertia of the links"),
        mechanism,
        AxisLabel(symbol=Symbol("J", "II"), unit="kg m^2"),
        AxisLabel(symbol=Symbol("A"), unit="J"),
        (
            Trace(Sentence("work of drive and loads"), inertia, work),
            *tangents,
            Trace(segment, np.zeros(2), np.array(starts), TraceKind.SEGMENT),
        ),
        (float(reach[0]), float(reach[1])),
    )


def _touching(steady: xr.Dataset, at: float, slope: float, start: float) -> np.ndarray:
    """Where a tangent touches the diagram: its place at the nearest sample, on the line."""
    inertia = float(np.interp(at, steady["turned"].values, steady["inertia_of_links"].values))
    return np.array([[inertia, start + slope * inertia]])


# Chapters


def _flywheel_chapter(results: MachineResults, facts: tuple[Fact, ...]) -> Chapter:
    """Energies of the machine over a cycle, and the flywheel that keeps its speed even enough."""
    flywheel = results.flywheel
    pictures = ("works", "energies", "wittenbauer")
    captions = {
        "wittenbauer": Sentence(
            "Wittenbauer's diagram: work over the inertia of the links, with both tangents"
        )
    }
    course = _over_cycle(
        results.steady, ENERGIES_IN_TABLE, Sentence("Moments, works and energies over the cycle")
    )
    formulas = (
        Reference(Sentence("The inertia of the links follows from {reduction}.")),
        Reference(Sentence("Works and energies follow from {works}.")),
    )
    figures = illustrations(pictures, captions, details=("works",))
    sections = (
        Section(NOTHING, (*_groups(flywheel), Formula(tuple(_work_relations(results)), "works"))),
        Section(Sentence("Over the cycle"), (*formulas, course)),
        Section(Sentence("Inertia and flywheel"), tuple(_needed_inertia(results))),
        Section(Sentence("Summary"), (FactTable(facts),)),
        Section(NOTHING, (_moments_alone(results), *figures.blocks)),
    )
    return Chapter(Sentence("Flywheel"), sections)


def _moments_alone(results: MachineResults) -> Illustration:
    """The moments on the drive and their sum; the chapter of the reduction has the inertia of the links."""
    turned = results.steady["turned"].values
    abscissa, caption = (
        over_samples(quantity_label("turned"), turned),
        Sentence("Moments on the drive and their sum"),
    )
    rows = ((_moments(results.steady),),)
    return Illustration(Plot(caption, Title(results.mechanism.title), abscissa, rows), caption)


def _groups(flywheel: Flywheel) -> tuple[Block, ...]:
    """What counts as what; the cycle."""
    cycle = Counted(
        "A cycle has {n} turn of the drive; angles turned $phi$ count in the sense in which the drive turns, moments, "
        "speeds and accelerations along its coordinate.",
        "A cycle has {n} turns of the drive; angles turned $phi$ count in the sense in which the drive turns, moments, "
        "speeds and accelerations along its coordinate.",
        flywheel.turns,
    )
    groups = Sentence(
        "Group I consists of the masses that turn with the drive at a constant ratio, shafts and flywheel; group "
        'II of the links, whose inertia $J_upright("II")$ changes with the position.'
    )
    return Paragraph(cycle), Paragraph(groups)


def _work_relations(results: MachineResults) -> Iterator[tuple[Leaf, ...]]:
    """Work of the loads, the mean moment that makes up for it, energies, their extremes."""
    flywheel, machine = results.flywheel, results.mechanism.machine
    work, moment = _works(flywheel)
    turn = "2 pi" if flywheel.turns == 1 else f"2 pi dot.op {flywheel.turns}"
    # moments count along the coordinate: where it falls, the work is not theirs over the angle turned
    falls, coordinate = (
        float(results.steady["drive_speed"][0]) < 0.0,
        results.mechanism.motion_parameter.drives[0],
    )
    minus, letter, first = "-", "phi", "0"
    if falls:
        letter = "phi" if coordinate.is_chosen else "q"
        minus, first = "", f"({letter}_0)"
    mean = "overline(M)_upright(d)" if machine is not None and machine.driving else "M_upright(d)"
    yield (
        "A_upright(c)",
        f"integral.cont M_upright(c) thin d {letter}",
        Number(work, "J"),
    )
    yield (
        Expression(mean),
        f"{minus}frac(A_upright(c), {turn})",
        Expression(f"{minus}frac({{work}}, {turn})", work=Number(work, "J", unit_hidden=True)),
        Number(moment, "N m"),
    )
    yield 'T_upright("II")', '1/2 J_upright("II") omega_upright(m)^2'
    yield (
        "Delta T_upright(I)",
        f'integral_{first}^{letter} (M_upright(d) + M_upright(c)) thin d {letter} - T_upright("II")',
    )
    for name, value, at in (
        ("max", flywheel.energy_greatest, flywheel.greatest_at),
        ("min", flywheel.energy_least, flywheel.least_at),
    ):
        right = Expression("{energy} quad (phi = {at})", energy=Number(value, "J"), at=Number(at, "rad"))
        yield f"Delta T_(upright(I), {name})", right


def _over_cycle(steady: xr.Dataset, columns: tuple[tuple[str, str], ...], caption: Sentence) -> Table:
    """Variables at even steps of the cycle, under their letters."""
    return Table(
        tuple(
            Column(name, steady[name].values, str(steady[name].attrs["units"]), Expression(letter))
            for name, letter in columns
        ),
        caption,
        rows_shown(steady.sizes["sample"]),
    )


def _needed_inertia(results: MachineResults) -> Iterator[Block]:
    """From the range of energies to the wheel; without a fluctuation only what the shafts give."""
    flywheel = results.flywheel
    needed, first_order, fluctuation = flywheel.inertia, flywheel.inertia_first_order, flywheel.fluctuation
    if fluctuation is None or needed is None or first_order is None:
        yield Paragraph(
            Sentence("No coefficient of fluctuation is given: the speed is the one with the shafts alone.")
        )
        yield _energy_check(results)
        return
    with_numbers = Expression(
        "frac({range}, {speed}^(2) dot.op {fluctuation})",
        range=Number(flywheel.energy_greatest - flywheel.energy_least, "J", unit_hidden=True),
        speed=Factor(Number(flywheel.mean_speed, "rad/s", unit_fixed=True)),
        fluctuation=Factor(Number(fluctuation)),
    )
    in_letters = Expression(
        "frac(Delta T_(upright(I), max) - Delta T_(upright(I), min), omega_upright(m)^2 delta)"
    )
    inertia = "J_upright(I)"
    yield Formula(((inertia, in_letters, with_numbers, Number(first_order, "kg m^2")),))
    yield Paragraph(
        Sentence(
            "This uses the energy of the links at the mean speed. The energy equation itself gives, without that "
            "approximation:"
        )
    )
    yield Formula(((inertia, Number(needed, "kg m^2")),))
    yield from _wheels(results)
    yield _energy_check(results)
    if flywheel.added:
        # an error of the works moves speeds by its share of the energy, extremes of the mesh by the root of rounding
        share = 2.0 * flywheel.error / (needed * flywheel.mean_speed**2)
        yield Check(
            Sentence(
                "The coefficient of fluctuation obtained with this moment of inertia equals the required one "
                "within {share}."
            ),
            abs(flywheel.obtained - fluctuation),
            fluctuation,
            share / fluctuation + float(np.sqrt(np.finfo(float).eps)),
        )


def _wheels(results: MachineResults) -> Iterator[Block]:
    """The flywheel's own inertia, and the sizes of a rim and a disc."""
    flywheel, machine = results.flywheel, results.mechanism.machine
    if not flywheel.added or flywheel.inertia is None or machine is None:
        yield Paragraph(Sentence("The shafts have enough inertia: no flywheel is needed."))
        return
    ratio = machine.flywheel.ratio
    letters, above = "J_upright(I) - J_upright(s)", "{needed} - {present}"
    if ratio != 1.0:
        letters, above = f"frac({letters}, i^2)", f"frac({above}, {{ratio}}^(2))"
    with_numbers = Expression(
        above,
        needed=Number(flywheel.inertia, "kg m^2", unit_hidden=True),
        present=Number(flywheel.present, "kg m^2", unit_hidden=True),
        ratio=Factor(Number(ratio)),
    )
    yield Paragraph(
        Sentence("$J_upright(s)$ is the inertia of the existing shafts, $J_upright(f)$ that of the flywheel.")
    )
    added = Number(flywheel.added, "kg m^2")
    yield Formula((("J_upright(f)", Expression(letters), with_numbers, added),))
    for title, wheel in ((Sentence("A rim:"), flywheel.rim), (Sentence("A disc:"), flywheel.disc)):
        if wheel is not None:
            yield Paragraph(title)
            yield Formula(tuple(_size_relations(wheel, machine.flywheel.density)))


def _size_relations(wheel: Wheel, density: float) -> Iterator[tuple[Leaf, ...]]:
    """Outer diameter, bore, width and mass, and the inertia that they have; in SI, as they go together."""
    sizes = {
        "rho": Number(density, "kg/m^3", unit_fixed=True),
        "D": Number(wheel.outer, "m", unit_fixed=True),
    }
    if wheel.inner:
        sizes["d"] = Number(wheel.inner, "m", unit_fixed=True)
    sizes["b"] = Number(wheel.width, "m", unit_fixed=True)
    first, *others = sizes
    line = ", quad ".join([f"{{{first}}}", *(f"{letter} = {{{letter}}}" for letter in others)])
    yield first, Expression(line, **sizes)
    four, two = (f"(D^{power} - d^{power})" if wheel.inner else f"D^{power}" for power in (4, 2))
    yield "m", f"frac(pi, 4) rho b {two}", Number(wheel.mass, "kg")
    inertia = Number(wheel.inertia, "kg m^2", unit_fixed=True)
    yield "J_upright(f)", f"frac(pi, 32) rho b {four}", inertia


def _energy_check(results: MachineResults) -> Check:
    """Kinetic energy at the real speed less the works has to stay what it is over the cycle."""
    steady = results.steady
    kinetic = 0.5 * (steady.attrs["inertia"] + steady["inertia_of_links"]) * steady["drive_speed"] ** 2
    energy, size = (kinetic - steady["work"]).values, float(kinetic.max())
    return Check(
        Sentence(
            "Kinetic energy at the real speed minus the work of all forces is constant over the cycle within {share}."
        ),
        float(np.ptp(energy)),
        size,
        2.0 * results.flywheel.error / size + 64.0 * float(np.finfo(float).eps),
    )


def _real_motion_chapter(results: MachineResults) -> Chapter:
    """Real speed of the drive, and real velocities and accelerations at the instants."""
    pictures = (
        "drive-speed",
        "real-angular-velocities",
        "real-angular-accelerations",
        "real-velocities",
        "real-accelerations",
    )
    captions = {"drive-speed": Sentence("Speed and acceleration of the drive, to first order dashed")}
    at_instants = results.instants
    count = 0 if at_instants is None else at_instants.sizes["sample"]
    instants = (
        Section(
            instant_title(results.mechanism, at_instants, k), tuple(_at(results, at_instants.isel(sample=k)))
        )
        for k in range(count)
        if at_instants is not None
    )
    course = _over_cycle(
        results.steady, SPEEDS_IN_TABLE, Sentence("Speed and acceleration of the drive over the cycle")
    )
    formulas = Reference(Sentence("The first-order values follow from {speed}."))
    sections = (
        Section(NOTHING, _speed_relations()),
        *instants,
        Section(Sentence("Over the cycle"), (formulas, course)),
        illustrations(pictures, captions, details=pictures[1:]),
    )
    return Chapter(Sentence("Real motion"), sections)


def _speed_relations() -> tuple[Block, ...]:
    """The first-order formulas, and how links follow the drive."""
    meaning = Sentence(
        "With the flywheel the speed $omega$ of the drive follows from the energy equation, its acceleration "
        "$epsilon$ from the equation of motion. To first order, as in textbooks:"
    )
    speed = Expression(
        "omega_upright(m) + frac(Delta T_upright(I) - 1/2 (Delta T_(upright(I), max) + Delta T_(upright(I), min)),"
        " omega_upright(m) J_upright(I))"
    )
    acceleration = Expression(
        'frac(M_upright(c) + M_upright(d), J_upright(I) + J_upright("II"))'
        ' - frac(omega^2 J\'_upright("II"), 2 (J_upright(I) + J_upright("II")))'
    )
    beside = Sentence(
        "The numbers below are exact; first-order values ($omega_1$, $epsilon_1$) are given alongside."
    )
    links = Sentence(
        "Velocities and accelerations of the links follow with the derivatives by the angle of the drive:"
    )
    return (
        Paragraph(meaning),
        Formula((("omega", speed), ("epsilon", acceleration)), "speed"),
        Paragraph(beside),
        Paragraph(links),
        Formula(
            (("arrow(v)", "arrow(r)' omega"), ("arrow(a)", "arrow(r)'' omega^2 + arrow(r)' epsilon")),
            "transfer",
        ),
    )


def _at(results: MachineResults, here: xr.Dataset) -> Iterator[Block]:
    """The acceleration with its numbers in SI, then links and points."""
    inertia = float(here.attrs["inertia"]) + float(here["inertia_of_links"])
    speed = float(here["drive_speed"])
    with_numbers = Expression(
        "frac({moment}, {inertia}) - frac({speed}^(2) dot.op {slope}, 2 dot.op {inertia})",
        moment=Number(float(here["moment_of_loads"] + here["driving_moment"]), "N m", unit_hidden=True),
        inertia=Number(inertia, "kg m^2", unit_hidden=True, unit_fixed=True),
        speed=Factor(Number(speed, "rad/s", unit_fixed=True)),
        slope=Factor(Number(float(here["inertia_slope_of_links"]), "kg m^2/rad", unit_fixed=True)),
    )
    acceleration = Number(float(here["drive_acceleration"]), "rad/s^2", unit_fixed=True)
    yield Formula(
        (
            ("omega", Number(speed, "rad/s", unit_fixed=True)),
            ("epsilon", with_numbers, acceleration),
        )
    )
    yield Paragraph(SENSE)
    driving = float(here["driving_moment"])
    terms = (moment_of_links(here), float(here.attrs["inertia"]), float(here["drive_acceleration"]), driving)
    yield Formula((links_line(here), *driving_lines(*terms)))
    yield Reference(Sentence("Velocities and accelerations follow from {transfer}."))
    mechanism = results.mechanism
    if mechanism.space == "plane":
        names = tuple(mechanism.links)
        turning = (
            Column(variable, here[variable].sel(link=list(names)).values, unit, Expression(letter))
            for variable, letter, unit in (
                ("angular_velocity", "omega", "rad/s"),
                ("angular_acceleration", "epsilon", "rad/s^2"),
            )
        )
        yield Table((_names("link", Sentence("link"), names), *turning), Sentence("Links"))
    points = mechanism.moving_points
    moving = (
        Column(
            f"{variable}_{axis}",
            here[variable].sel(point=list(points), axis=axis).values,
            str(here[variable].attrs["units"]),
            Expression(f"{letter}_{axis}"),
        )
        for variable, letter in (("velocity", "v"), ("acceleration", "a"))
        for axis in here["axis"].values.tolist()
    )
    yield Table((_names("point", Sentence("point"), points), *moving), Sentence("Points"))


def _names(name: str, head: Sentence, names: tuple[str, ...]) -> Column:
    return Column(name, tuple(map(Name, names)), head=head)
