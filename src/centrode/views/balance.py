"""Shaking forces, counterweights and what they do: what the terminal, the files, the figures and the document show."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, dist
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.dynamics.masses import masses_of, massless_links
from centrode.model.files import mechanism_text
from centrode.quantities import QUANTITIES
from centrode.sheets.charts import (
    BarChart,
    BarPanel,
    Bars,
    CarriedDisc,
    Hodograph,
    HodographCurve,
    LinkageWithDiscs,
)
from centrode.sheets.plots import AxisLabel, Curve, CurvePanel, Plot
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Items,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import (
    NOTHING,
    Expression,
    Joined,
    Name,
    Number,
    Place,
    Sentence,
    Symbol,
    Text,
    Title,
    Unit,
)
from centrode.views.abscissa import motion_abscissa
from centrode.views.columns import columns_of, drive_units, status_column, unit_of
from centrode.views.reduction import names_text

if TYPE_CHECKING:
    import xarray as xr

    from centrode.dynamics.balancing.balance import Balance
    from centrode.dynamics.balancing.counterweights import Counterweight
    from centrode.dynamics.balancing.methods import Loop, Share
    from centrode.dynamics.balancing.results import ShakingResults
    from centrode.sheets.pictures import Picture

Array: TypeAlias = NDArray[np.float64]
ORDERS_SHOWN = (1.0, 2.0)
ROUNDING = 1e-9
"""An effect below this share of what it was without counterweights is shown as zero: it is rounding."""
HARMONICS_ROUNDING = 1e-10
"""The same of amplitudes beside the greatest."""
DRAWN_AT = 0.12
"""Share of the motion at which the mechanism is drawn: at its beginning links often lie on one line."""
WITHOUT, WITH = Sentence("without counterweights"), Sentence("with counterweights")
CURVES = ("shaking_force", "shaking_force_size", "shaking_moment", "inertia_on_drive")
HARMONICS = (
    "force_harmonic_cosine",
    "force_harmonic_sine",
    "force_harmonic_amplitude",
    "force_harmonic_phase",
    "force_harmonic_greatest",
    "moment_harmonic_cosine",
    "moment_harmonic_sine",
    "moment_harmonic_amplitude",
    "moment_harmonic_phase",
)
GREATEST_FORCE = Sentence("greatest shaking force")
GREATEST_ON_DRIVE = Sentence("greatest moment of the drive due to inertia forces")
EFFECTS = ("shaking_force_size", "shaking_moment", "inertia_on_drive")
OVER_THE_CYCLE = Sentence(
    "Shaking force {force}, shaking moment {moment} and moment of the drive {drive} over the cycle, before and after",
    force=Symbol(QUANTITIES["shaking_force_size"].symbol),
    moment=Symbol(QUANTITIES["shaking_moment"].symbol),
    drive=Symbol(QUANTITIES["inertia_on_drive"].symbol),
)
CAPTIONS = {
    "counterweights": Sentence("The mechanism with its counterweights"),
    "shaking-hodograph": Sentence("Hodograph of the shaking force, before and after"),
    "shaking-cycle": OVER_THE_CYCLE,
    "shaking-harmonics": Sentence("Harmonics before and after"),
}
DETAILS = ("shaking-hodograph", "shaking-harmonics")
"""Figures that only the full form of a document shows."""


def sheet(balance: Balance) -> Sheet:
    """Everything there is to say about counterweights and what they do."""
    steps = tuple(_steps(balance))
    by_hand = (Paragraph(Sentence("masses replaced at the joints:")), Items(steps)) if steps else ()
    return Sheet(
        facts=tuple(_facts(balance)),
        tables={"balance": _table(balance), "harmonics": _harmonics_table(balance)},
        pictures=_pictures(balance),
        printed=(_effects(balance), *by_hand),
        files={"balanced.toml": mechanism_text(balance.balanced)},
    )


def shaking_sheet(results: ShakingResults) -> Sheet:
    """Everything there is to say about shaking forces, and about the full balance where there is one."""
    return Sheet(
        facts=tuple(_greatest(results.shaking)),
        pictures={} if results.balance is None else _pictures(results.balance),
        chapters={"balance": _chapter(results)} if results.is_shaken else {},
    )


# Facts


def _facts(balance: Balance) -> Iterator[Fact]:
    """What was wanted and the counterweights."""
    yield Fact(Sentence("balance"), _aim(balance))
    yield Fact(Sentence("speed of the drive"), _speed(balance.before))
    yield Fact(Sentence("massless links"), names_text(massless_links(balance.mechanism)))
    for one in balance.counterweights:
        yield Fact(Sentence("counterweight {link}", link=Name(one.link)), _counterweight(one))
    for disc in balance.discs:
        inertia = Number(disc.inertia, "kg m^2")
        text = Sentence("{inertia}, fixed to it", inertia=inertia)
        if disc.base is not None:
            text = Sentence(
                "{inertia}, geared {ratio} to turn against it about {base}",
                inertia=inertia,
                ratio=Joined((Number(1), Number(1)), " : "),
                base=Name(disc.base),
            )
        yield Fact(Sentence("disc for {link}", link=Name(disc.link)), text)
    yield from _proof(balance)


def _aim(balance: Balance) -> Text:
    """How a mechanism was balanced."""
    if balance.to == "full":
        both = Sentence("shaking force and shaking moment zero")
        return both if balance.discs else Sentence("shaking force zero")
    if balance.weights is not None:
        return _weights(balance.weights)
    return Sentence(
        "the masses rotating with the crank pin, and {share} of the reciprocating masses",
        share=Number(100.0 * (balance.fraction or 0.0), "%", ".4g"),
    )


def _weights(weights: tuple[float, ...]) -> Text:
    names = (Sentence("shaking force"), Sentence("shaking moment"), Sentence("moment of the drive"))
    parts = [(name, weight) for name, weight in zip(names, weights, strict=True) if weight]
    if len(parts) == 1:
        return Sentence("least maximum of {what}", what=parts[0][0])
    terms = tuple(Joined((Number(weight, digits="g"), name), " x ") for name, weight in parts)
    return Sentence(
        "the least sum of greatest values, each relative to that without counterweights: {sum}",
        sum=Joined(terms, " + "),
    )


def _speed(data: xr.Dataset) -> Text:
    rates, unit = data["drive_rate"].values, str(data["drive_rate"].attrs["units"])
    low, high = (Number(float(rate), unit, unit_fixed=True) for rate in (np.min(rates), np.max(rates)))
    if data.attrs["speed"] == "steady":
        return Sentence("{first} to {last}, of steady motion", first=low, last=high)
    return low


def _counterweight(one: Counterweight) -> Text:
    if not one.mass:
        return Sentence("none is needed")
    text: Text = Sentence(
        "{mass}, {radius} from {base} at {angle} to the link's x axis",
        mass=Number(one.mass, "kg"),
        radius=Number(one.radius, "m"),
        base=Name(one.base),
        angle=Number(degrees(one.angle), "deg", ".5g"),
    )
    if one.disc is not None:
        text = Joined((text, Sentence("a disc of {radius} radius", radius=Number(one.disc, "m"))))
    return Sentence("{value} ({remark})", value=text, remark=Number(one.product, "kg m"))


def _proof(balance: Balance) -> Iterator[Fact]:
    """What is known about better counterweights, and about the moment."""
    least = ROUNDING * balance.before.attrs["greatest_shaking_force"]
    if balance.bound is not None and balance.bound > least:
        yield Fact(
            Sentence("proved"),
            Sentence(
                "no counterweights on these links bring the greatest force below {force}",
                force=Number(balance.bound, "N"),
            ),
        )
    elif balance.proved:
        yield Fact(
            Sentence("proved"), Sentence("no better counterweights exist on these links with these radii")
        )
    if not balance.unique:
        text = Sentence(
            "other counterweights on these links give the same; these have the least mass-radius products"
        )
        yield Fact(Sentence("choice"), text)
    before, after = (data.attrs["greatest_shaking_moment"] for data in (balance.before, balance.after))
    if after > before * (1.0 + ROUNDING):
        text = Sentence(
            "it increases: counterweights that balance the force have moments of inertia of their own"
        )
        yield Fact(Sentence("shaking moment"), text)


def _greatest(data: xr.Dataset) -> Iterator[Fact]:
    """The greatest effects over the cycle, of a drive that has one."""
    for label, name, unit in (
        (GREATEST_FORCE, "greatest_shaking_force", "N"),
        (Sentence("greatest shaking moment"), "greatest_shaking_moment", "N m"),
        (GREATEST_ON_DRIVE, "greatest_inertia_on_drive", "N m"),
    ):
        if name in data.attrs:
            yield Fact(label, Number(data.attrs[name], unit))


# Effects, and the way by hand


class _Effect(NamedTuple):
    """What inertia does, before and after; `whole` is what it is small beside."""

    text: Text
    unit: str
    before: float
    after: float
    whole: float

    def shown(self, value: float) -> float:
        """A value without what rounding has left of it."""
        return 0.0 if value <= ROUNDING * self.whole else value

    @property
    def change(self) -> Text:
        """By which share it has changed; nothing of nothing."""
        before = self.shown(self.before)
        return Number(self.shown(self.after) / before - 1.0, digits="+.1%") if before else NOTHING


def _effects(balance: Balance, caption: Text = NOTHING) -> Table:
    """The greatest effects over the cycle and the first harmonics, before and after."""
    rows = tuple(_effects_of(balance))
    return Table(
        (
            Column("", tuple(row.text for row in rows)),
            Column("unit", tuple(Unit(row.unit) for row in rows), head=Sentence("unit")),
            Column("before", tuple(Number(row.shown(row.before)) for row in rows), head=Sentence("before")),
            Column("after", tuple(Number(row.shown(row.after)) for row in rows), head=Sentence("after")),
            Column("change", tuple(row.change for row in rows), head=Sentence("change")),
        ),
        caption,
    )


def _effects_of(balance: Balance) -> Iterator[_Effect]:
    both = (balance.before, balance.after)
    about = Place(tuple(balance.before.attrs["about"]), "m")
    for name, text in (
        ("shaking_force", GREATEST_FORCE),
        ("shaking_moment", Sentence("greatest shaking moment about {place}", place=about)),
        ("inertia_on_drive", GREATEST_ON_DRIVE),
    ):
        before, after = (float(data.attrs[f"greatest_{name}"]) for data in both)
        yield _Effect(text, str(balance.before[name].attrs["units"]), before, after, before)
    for name in ("force_harmonic_greatest", "moment_harmonic_amplitude"):
        whole, unit = float(balance.before[name].max()), str(balance.before[name].attrs["units"])
        for order in ORDERS_SHOWN:
            number = Number(order, digits="g")
            text = Sentence("shaking moment, order {order}", order=number)
            if name == "force_harmonic_greatest":
                text = Sentence("shaking force, order {order}", order=number)
            before, after = (float(data[name].sel(order=order)) for data in both)
            yield _Effect(text, unit, before, after, whole)
    before, after = (
        sum(float(mass.mass) for mass in masses_of(one)) for one in (balance.mechanism, balance.balanced)
    )
    yield _Effect(Sentence("mass of all links"), "kg", before, after, before)


def _steps(balance: Balance) -> Iterator[Text]:
    """The way by hand of a slider-crank or a four-bar: masses replaced at the joints; nothing for others."""
    loop = balance.loop
    if loop is None:
        return
    for share in balance.shares:
        yield _share(share)
    crank, coupler = balance.shares[:2]
    turning = crank.at_second + coupler.at_first
    yield _turns_with(turning, loop.A)
    if loop.rocker is None:
        moved = coupler.at_second + loop.slider
        yield Sentence("{mass} reciprocate with {point}", mass=Number(moved.real, "kg"), point=Name(loop.B))
    else:
        moved = balance.shares[2].at_second + coupler.at_second
        yield _turns_with(moved, loop.B)
    # masses beside the line are vectors: there is no sum of numbers
    if not any(_is_beside(share) for share in balance.shares):
        yield from _products(balance, loop, turning.real, moved.real)


def _turns_with(mass: complex, point: str) -> Text:
    return Sentence("{mass} turn with {point}", mass=Number(mass.real, "kg"), point=Name(point))


def _is_beside(share: Share) -> bool:
    """Whether the centre of a link lies beside the line of its joints."""
    return abs(share.at_second.imag) > ROUNDING * abs(share.at_first + share.at_second)


def _share(share: Share) -> Text:
    text: Text = Sentence(
        "{link}: {first_mass} at {first}, {second_mass} at {second} have its mass and centre",
        link=Name(share.link),
        first_mass=Number(share.at_first.real, "kg"),
        first=Name(share.first),
        second_mass=Number(share.at_second.real, "kg"),
        second=Name(share.second),
    )
    if not _is_beside(share):
        return text
    beside = Sentence(
        "its centre of mass is not on the line: {mass} at {second}, rotated by a right angle, are added",
        mass=Number(share.at_second.imag, "kg"),
        second=Name(share.second),
    )
    return Joined((text, beside), "; ")


def _products(balance: Balance, loop: Loop, turning: float, moved: float) -> Iterator[Text]:
    """Mass times length on each link with a counterweight, where the textbook has a sum for it."""
    by_link = {one.link: one for one in balance.counterweights}
    lengths = {share.link: Number(_length(balance, share), "m") for share in balance.shares}
    if balance.fraction is not None:
        yield Sentence(
            "({turning} + {share} · {moved}) · {length} on {link}",
            turning=Number(turning, "kg"),
            share=Number(balance.fraction, digits=".4g"),
            moved=Number(moved, "kg"),
            length=lengths[loop.crank],
            link=Name(loop.crank),
        )
        return
    other = loop.rocker or loop.coupler
    if balance.to != "full" or not balance.unique or set(by_link) != {loop.crank, other}:
        return
    at_pin = turning
    if loop.rocker is None:
        if by_link[other].base != loop.A:
            return
        at_pin = turning + moved + by_link[other].mass
    for mass, link in ((at_pin, loop.crank), (moved, other)):
        yield Sentence(
            "{mass} · {length} on {link}", mass=Number(mass, "kg"), length=lengths[link], link=Name(link)
        )


def _length(balance: Balance, share: Share) -> float:
    """Distance of the two joints of a link [m]."""
    places = balance.mechanism.links[share.link].coordinates
    return dist(places[share.first], places[share.second])


# Tables


def _table(balance: Balance) -> Table:
    """Effects of the inertia before and after, one row a sample."""
    before = balance.before
    drives = (
        Column(f"drive_{name}", before["drive_value"].isel(drive=number).values, drive_units(before)[number])
        for number, name in enumerate(before["drive"].values)
    )
    curves = (
        Column(f"{word}_{header}", values.values, unit)
        for word, data in (("before", before), ("after", balance.after))
        for variable in CURVES
        for header, unit, values in columns_of(data[variable], variable)
    )
    time = Column("time", before["time"].values, unit_of(before["time"]))
    return Table((time, *drives, *curves, status_column(before["status"])))


def _harmonics_table(balance: Balance) -> Table:
    """Harmonics before and after in SI, one row an order; counterweights can shorten the cycle, then it has fewer."""
    orders = balance.before["order"].values
    columns = []
    for word, data in (("before", balance.before), ("after", balance.after)):
        for variable in HARMONICS:
            for header, unit, values in _by_axis(data[variable], variable):
                padded = np.full(len(orders), np.nan)
                padded[: len(values)] = values.values
                columns.append(Column(f"{word}_{header}", padded, unit, unit_fixed=True))
    return Table((Column("order", orders), *columns))


def _by_axis(values: xr.DataArray, variable: str) -> Iterator[tuple[str, str, xr.DataArray]]:
    """One column, or one for each axis."""
    if "axis" not in values.dims:
        yield variable, unit_of(values), values
        return
    for axis in values["axis"].values.tolist():
        yield f"{variable}_{axis}", unit_of(values), values.sel(axis=axis)


# Figures


def _pictures(balance: Balance) -> dict[str, Picture]:
    """Hodograph of the shaking force, effects over the cycle, harmonics, the counterweights drawn."""
    return {
        "shaking-hodograph": _hodograph(balance),
        "shaking-cycle": _cycle(balance),
        "shaking-harmonics": _harmonics(balance),
        "counterweights": _drawing(balance),
    }


def _pairs(balance: Balance) -> tuple[tuple[Text, xr.Dataset, int, bool], ...]:
    """Name, dataset, place and whether it is what the other is compared with, before and after."""
    return (WITHOUT, balance.before, 1, True), (WITH, balance.after, 0, False)


def _hodograph(balance: Balance) -> Hodograph:
    symbol = QUANTITIES["shaking_force"].symbol
    x, y = (AxisLabel(symbol=Symbol(symbol, axis, slanted=True), unit="N") for axis in ("x", "y"))
    curves = tuple(
        HodographCurve(name, data["shaking_force"].values, place, compared)
        for name, data, place, compared in _pairs(balance)
    )
    title = Sentence("Shaking force on the frame; the large dot marks its start")
    return Hodograph(title, Title(balance.mechanism.title), x, y, curves)


def _cycle(balance: Balance) -> Plot:
    """Size of the force, moment, and what the drive gives, over the cycle."""
    rows = []
    for number, name in enumerate(EFFECTS):
        label = AxisLabel(  # the caption says what the letter is: words are longer than a low panel
            symbol=Symbol(QUANTITIES[name].symbol),
            unit=str(balance.before[name].attrs["units"]),
            unit_fixed=True,
        )
        curves = tuple(
            Curve(text, data[name].values, place, compared) for text, data, place, compared in _pairs(balance)
        )
        scale = max(float(np.nanmax(np.abs(curve.values))) for curve in curves)
        rows.append((CurvePanel(label, curves, scale, legend=number == 0),))
    return Plot(
        OVER_THE_CYCLE,
        Title(balance.mechanism.title),
        motion_abscissa(balance.mechanism, balance.before),
        tuple(rows),
    )


def _harmonics(balance: Balance) -> BarChart:
    """Harmonics of force and moment by order, without the mean."""
    panels, force = [], QUANTITIES["force_harmonic_greatest"]
    for name, text in (
        (force.name, Sentence(force.long_name)),
        ("moment_harmonic_amplitude", Sentence("amplitude of the moment")),
    ):
        bars = tuple(
            Bars(word, data["order"].values[1:], data[name].values[1:], place)
            for word, data, place, _compared in _pairs(balance)
        )
        label = AxisLabel(text, unit=str(balance.before[name].attrs["units"]), unit_fixed=True)
        panels.append(BarPanel(label, bars))
    return BarChart(
        Sentence("Harmonics of shaking force and moment"),
        Title(balance.mechanism.title),
        Sentence("order: periods in a turn of the drive"),
        tuple(panels),
    )


def _drawing(balance: Balance) -> LinkageWithDiscs:
    """The mechanism with its counterweights at one sample, and what they weigh."""
    discs = tuple(
        CarriedDisc(one.link, one.base, one.place, one.disc, _weighs(one))
        for one in balance.counterweights
        if one.mass > 0.0
    )
    sample = round(DRAWN_AT * balance.motion.sizes["sample"])
    mechanism = balance.mechanism
    title = Sentence("Counterweights")
    return LinkageWithDiscs(title, Title(mechanism.title), mechanism, balance.motion, sample, discs)


def _weighs(one: Counterweight) -> Text:
    return Sentence(
        "{link}: {mass}, {radius} from {base}",
        link=Name(one.link),
        mass=Number(one.mass, "kg", ".4g"),
        radius=Number(one.radius, "m", ".4g"),
        base=Name(one.base),
    )


# Chapter


def _chapter(results: ShakingResults) -> Chapter:
    """Shaking force and moment, harmonics, and the full balance; why there is none, where there is none."""
    data = results.shaking
    text = Sentence(
        "The inertia forces act on the frame as the shaking force and the shaking moment; weights and loads are "
        "not included."
    )
    formula = Formula((("arrow(F)", "-sum_k m_k arrow(a)_k"), ("M", "-frac(d K, d t)")))
    greatest = tuple(_greatest(data))
    facts = (FactTable(greatest),) if greatest else ()
    sections = [Section(NOTHING, (Paragraph(text), formula, *facts))]
    if "force_harmonic_amplitude" in data:
        sections.append(Section(Sentence("Harmonics"), (_amplitudes(data),), detail=True))
    blocks: tuple[Block, ...] = (Paragraph(Name(results.refusal)),)
    if results.balance is not None:
        blocks = tuple(_full_balance(results.balance))
    sections.append(Section(Sentence("Full balance"), blocks))
    return Chapter(Sentence("Shaking forces and balance"), tuple(sections))


def _amplitudes(data: xr.Dataset) -> Table:
    """Amplitudes by orders; what rounding has left of zero beside the greatest is zero."""
    force, moment = (data[name].values for name in ("force_harmonic_amplitude", "moment_harmonic_amplitude"))
    greatest = data["force_harmonic_greatest"].values
    orders = tuple(Number(float(order), digits="") for order in data["order"].values)
    return Table(
        (
            Column("order", orders, head=Sentence("order")),
            Column("x", _without_rounding(force[:, 0], force), "N", Expression("F_x")),
            Column("y", _without_rounding(force[:, 1], force), "N", Expression("F_y")),
            Column("greatest", _without_rounding(greatest, force), "N", Sentence("greatest")),
            Column("moment", _without_rounding(moment, moment), "N m", Expression("M")),
        ),
        Sentence("Amplitudes of the shaking force and moment by harmonics of the drive's rotation"),
    )


def _without_rounding(values: Array, beside: Array) -> Array:
    return np.where(np.abs(values) < HARMONICS_ROUNDING * float(beside.max()), 0.0, values)


def _full_balance(balance: Balance) -> Iterator[Block]:
    """Counterweights that take the shaking force away."""
    yield FactTable(tuple(_facts(balance)))
    yield Illustration("counterweights", CAPTIONS["counterweights"])
    yield _effects(balance, Sentence("Effects of the inertia forces, before and after"))
    if steps := tuple(_steps(balance)):
        yield Paragraph(Sentence("Masses replaced at the joints:"))
        yield Items(steps)
    before, after = (float(one.attrs["greatest_shaking_force"]) for one in (balance.before, balance.after))
    text = Sentence("With the counterweights {share} of the greatest shaking force remains.")
    yield Check(text, after, before, 1e4 * float(np.finfo(float).eps))
    for name, caption in CAPTIONS.items():
        if name != "counterweights":
            yield Illustration(name, caption, detail=name in DETAILS)
