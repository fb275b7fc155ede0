"""Masses and loads reduced to the drives: what the terminal, the files, the figures and the document show."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.dynamics.masses import massless_links
from centrode.errors import Status
from centrode.quantities import QUANTITIES, STATUS_WORDS
from centrode.sheets.plots import AxisLabel, Curve, CurvePanel, CurveRole, Plot
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Fact,
    FactTable,
    Formula,
    Paragraph,
    Reference,
    Section,
    Sheet,
    Table,
    illustrations,
)
from centrode.sheets.texts import (
    NOTHING,
    Expression,
    Factor,
    Joined,
    Leaf,
    Name,
    Number,
    Part,
    Sentence,
    Symbol,
    Text,
    Title,
    Unit,
)
from centrode.views.abscissa import motion_abscissa
from centrode.views.columns import force_columns, rows_reached, status_column
from centrode.views.formulas import index_symbol, join_expressions, sum_of
from centrode.views.instants import instant_title
from centrode.views.limits import unreached_failure
from centrode.views.load_names import load_text
from centrode.views.load_plots import load_captions, load_pictures, loads_table

if TYPE_CHECKING:
    import xarray as xr

    from centrode.dynamics.link_motions import LinkMotion
    from centrode.dynamics.reduction_results import PartExtremes, ReductionResults
    from centrode.model.mechanism import Mechanism

Array: TypeAlias = NDArray[np.float64]
Lines: TypeAlias = tuple[tuple[Leaf, ...], ...]

VARIABLES = (
    "drive_rate",
    "reduced_inertia",
    "reduced_inertia_part",
    "reduced_inertia_slope",
    "reduced_inertia_slope_part",
    "reduced_moment",
    "reduced_moment_part",
    "inertia_matrix",
    "inertia_matrix_part",
    "christoffel",
    "generalised_force",
    "generalised_force_part",
)
IN_TABLE = (("reduced_inertia", "J"), ("reduced_inertia_slope", "J'"), ("reduced_moment", "M"))
LETTERS = {"angle": "phi", "displacement": "s", "distance": "l"}
"""What a chosen coordinate is called in formulas, by what is driven."""
WHOLES = {"reduced_inertia": Sentence("reduced inertia"), "reduced_moment": Sentence("reduced moment")}
JUMPS_SHOWN = 12
MOST = 11
"""Curves in one panel, besides the sum; of more, the greatest are drawn."""
HIDDEN = 0.05
"""Parts below this share of the greatest get a panel of their own."""
ROUNDING = 1e-13
"""Coefficients of motion below this are zero."""
ROUNDINGS = 64.0
"""Roundings in a share m v^2 + J phi^2 by either route, each of the size of its terms."""


def sheet(results: ReductionResults) -> Sheet:
    """Everything there is to say about the reduction of masses and loads to the drives."""
    return Sheet(
        facts=tuple(_facts(results)),
        tables={
            "reduction": reduction_table(results.reduction),
            **({"loads": loads_table(results)} if results.courses else {}),
        },
        datasets={"reduction": results.reduction},
        pictures={**dict(_pictures(results)), **dict(load_pictures(results))},
        chapters={"reduction": _chapter(results)},
        printed=(_extremes(results),),
        failure=unreached_failure(results.mechanism, results.reduction["status"], results.limits),
    )


# Tables


def reduction_table(dataset: xr.Dataset) -> Table:
    """One row a sample, each quantity with its parts; inertias and moments in SI."""
    columns = (Column(name, values.values, unit) for name, unit, values in force_columns(dataset, VARIABLES))
    return Table((*columns, status_column(dataset["status"])))


def _extremes(results: ReductionResults) -> Table:
    """Least, greatest and mean value of each quantity and of its parts."""
    rows = results.extremes
    numbers = (
        Column(name, tuple(_number(getattr(one, name), one.unit) for one in rows), head=head)
        for name, head in (
            ("least", Sentence("least")),
            ("greatest", Sentence("greatest")),
            ("mean", Sentence("mean")),
        )
    )
    return Table(
        (
            Column("", tuple(_label(results.mechanism, one) for one in rows)),
            Column("unit", tuple(Unit(one.unit) for one in rows), head=Sentence("unit")),
            *numbers,
        )
    )


def _number(value: float, unit: str) -> Text:
    """A number whose unit stands beside it; nothing where there is none."""
    return Number(value, unit, unit_fixed=True, unit_hidden=True) if np.isfinite(value) else NOTHING


def _label(mechanism: Mechanism, one: PartExtremes) -> Text:
    drives = Joined(tuple(map(Name, one.drives)))
    if one.variable == "inertia_matrix":
        return Sentence("inertia coefficient {drives}", drives=drives)
    if one.variable == "generalised_force":
        return Sentence("force by {drives}", drives=drives)
    if not one.label:
        return WHOLES[one.variable]
    return Part(load_text(mechanism, one.label) if one.variable == "reduced_moment" else Name(one.label))


# Facts


def _facts(results: ReductionResults) -> Iterator[Fact]:
    """Masses, loads, speed of the drive, jumps and statuses."""
    mechanism, reduction = results.mechanism, results.reduction
    loads = tuple(load_text(mechanism, str(label)) for label in reduction["load"].values)
    yield Fact(Sentence("drives"), names_text(reduction["drive"].values))
    yield Fact(Sentence("links with mass"), names_text(reduction["link"].values))
    yield Fact(Sentence("massless links"), names_text(massless_links(mechanism)))
    yield Fact(Sentence("loads"), Joined(loads) if loads else Sentence("none"))
    if "drive_rate" in reduction:
        yield Fact(Sentence("speed of the drive"), _speed(results))
        yield Fact(Sentence("jumps and kinks of the loads at"), _jumps(results))
    status = reduction["status"].values
    counts = tuple(
        Joined((Sentence(STATUS_WORDS[Status(code)]), Number(int(np.sum(status == code)), digits="d")), " ")
        for code in np.unique(status)
    )
    yield Fact(Sentence("samples"), Joined((Number(len(status), digits="d"), Joined(counts)), ": "))


def names_text(names: Sequence[str] | NDArray[np.str_]) -> Text:
    """Names in a row, or that there are none."""
    return Joined(tuple(Name(str(name)) for name in names)) if len(names) else Sentence("none")


def _speed(results: ReductionResults) -> Text:
    reduction, unit = results.reduction, results.mechanism.motion_parameter.drives[0].speed_unit
    rates = reduction["drive_rate"].values
    low, high = (Number(float(rate), unit, unit_fixed=True) for rate in (np.min(rates), np.max(rates)))
    # a rate that is computed at each sample may differ in its last digits only
    constant = format(low.value, low.digits) == format(high.value, high.digits)
    speed: Text = low if constant else Sentence("{first} to {last}", first=low, last=high)
    if reduction.attrs["rate_from"] == "machine":
        return Sentence("{speed}, the mean speed of the machine", speed=speed)
    return speed


def _jumps(results: ReductionResults) -> Text:
    jumps, unit = results.reduction["jumps"].values, results.mechanism.motion_parameter.drives[0].unit
    texts: list[Text] = [Number(float(at), unit, ".9g", degrees_too=True) for at in jumps[:JUMPS_SHOWN]]
    if len(jumps) > JUMPS_SHOWN:
        texts.append(Sentence("and {n} more", n=Number(len(jumps) - JUMPS_SHOWN, digits="d")))
    return Joined(texts, "; ") if texts else Sentence("none")


# Figures


def _pictures(results: ReductionResults) -> Iterator[tuple[str, Plot]]:
    """Figures by name; what has no masses or no loads is left out."""
    mechanism, dataset = results.mechanism, results.reduction
    is_single = "reduced_inertia" in dataset
    plots = _of_one_drive(mechanism, dataset) if is_single else _of_several(mechanism, dataset)
    abscissa = motion_abscissa(mechanism, dataset)
    for name, (title, panels) in plots.items():
        if any(panel.curves for panel in panels):
            yield name, Plot(title, Title(mechanism.title), abscissa, tuple((panel,) for panel in panels))


def _of_one_drive(mechanism: Mechanism, dataset: xr.Dataset) -> dict[str, tuple[Sentence, list[CurvePanel]]]:
    moment = _parts(mechanism, dataset, "reduced_moment", "load")
    inertia = [
        _parts(mechanism, dataset, name, "link") for name in ("reduced_inertia", "reduced_inertia_slope")
    ]
    return {
        "reduced-inertia": (Sentence("Reduced moment of inertia and its derivative"), inertia),
        "reduced-moment": (Sentence("Reduced moment of the loads"), [moment, *_small(moment)]),
    }


def _parts(mechanism: Mechanism, dataset: xr.Dataset, name: str, dimension: str) -> CurvePanel:
    """The parts of a quantity along links or loads, and their sum."""
    parts = dataset[f"{name}_part"]
    curves = {str(label): parts.sel({dimension: label}).values for label in parts[dimension].values}
    texts: dict[str, Text] = {
        label: load_text(mechanism, label) if dimension == "load" else Name(label) for label in curves
    }
    axis = AxisLabel(symbol=Symbol(QUANTITIES[name].symbol), unit=str(parts.attrs["units"]), unit_fixed=True)
    return _panel(axis, curves, texts, dataset[name].values)


def _of_several(mechanism: Mechanism, dataset: xr.Dataset) -> dict[str, tuple[Sentence, list[CurvePanel]]]:
    drives = [str(name) for name in dataset["drive"].values]
    forces, matrix = dataset["generalised_force_part"], dataset["inertia_matrix"]
    units = str(forces.attrs["units"]).split(", ")
    labels = [str(label) for label in forces["load"].values]
    texts = {label: load_text(mechanism, label) for label in labels}
    panels = []
    for number, drive in enumerate(drives):
        chosen = forces.isel(drive=number)
        curves = {label: chosen.sel(load=label).values for label in labels}
        # a drive may have any name, so it stands beside the letter and not below it
        text = Joined((Symbol(QUANTITIES["generalised_force"].symbol), Name(drive)), " ")
        axis = AxisLabel(text, unit=units[number % len(units)], unit_fixed=True)
        panels.append(_panel(axis, curves, texts, dataset["generalised_force"].isel(drive=number).values))
    pairs = [(i, j) for i in range(len(drives)) for j in range(i, len(drives))]
    elements = tuple(
        Curve(Joined((Name(drives[i]), Name(drives[j]))), matrix.isel(drive=i, drive_2=j).values, place)
        for place, (i, j) in enumerate(pairs)
    )
    unit = str(matrix.attrs["units"])
    axis = AxisLabel(
        symbol=Symbol(QUANTITIES["inertia_matrix"].symbol), unit="1" if "," in unit else unit, unit_fixed=True
    )
    has_masses = dataset.sizes["link"] > 0
    return {
        "inertia-matrix": (
            Sentence("Elements of the inertia matrix"),
            [CurvePanel(axis, elements if has_masses else ())],
        ),
        "generalised-forces": (Sentence("Generalised forces of the loads"), panels),
    }


def _panel(
    axis: AxisLabel, curves: Mapping[str, Array], texts: Mapping[str, Text], total: Array
) -> CurvePanel:
    """Curves of the parts that reach farthest, under a black one of their sum; a single part is its own sum."""
    farthest = sorted(curves, key=lambda label: _reach(curves[label]), reverse=True)[:MOST]
    kept = tuple(
        Curve(texts[label], curves[label], place, role=CurveRole.PART)
        for place, label in enumerate(label for label in curves if label in farthest)
    )
    if len(curves) < 2:
        return CurvePanel(axis, kept)
    return CurvePanel(axis, (*kept, Curve(Sentence("sum"), total, len(kept), role=CurveRole.SUM)))


def _small(panel: CurvePanel) -> list[CurvePanel]:
    """A panel of the parts that the scale of the greatest hides; none where there are none."""
    reach = {curve.place: _reach(curve.values) for curve in panel.curves if curve.role is CurveRole.PART}
    most = max(reach.values(), default=0.0)
    small = tuple(curve for curve in panel.curves if 0 < reach.get(curve.place, 0.0) < HIDDEN * most)
    return [CurvePanel(panel.label, small)] if small else []


def _reach(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.max(np.abs(known), initial=0.0))


# Chapter


DETAILS = ("moment-sum",)
"""Figures that only the full form of a document shows: the chapter of the flywheel has the sum of moments as well."""


def _chapter(results: ReductionResults) -> Chapter:
    """Reduced inertia, its derivative and the reduced moment: formulas, numbers at instants, course, figures."""
    captions: dict[str, Text] = {
        "reduced-inertia": Sentence("Reduced inertia with the parts of the links, and its derivative"),
        "reduced-moment": Sentence("Reduced moment with the parts of the loads"),
        "inertia-matrix": Sentence("Elements of the inertia matrix"),
        "generalised-forces": Sentence("Generalised forces of the drives"),
        **load_captions(results),
    }
    sections = [Section(NOTHING, (*_meaning(results), FactTable(tuple(_facts(results)))))]
    if "reduced_inertia" in results.reduction:
        formulas = Reference(
            Sentence("Reduced inertia, its derivative and the reduced moment follow from {reduction}.")
        )
        sections += [*_sums(results), Section(Sentence("Over the motion"), (formulas, _course(results)))]
    sections.append(Section(Sentence("Extremes and means"), (_extremes(results),), detail=True))
    return Chapter(
        Sentence("Reduction to the drive"), (*sections, illustrations(captions, captions, DETAILS))
    )


def _meaning(results: ReductionResults) -> tuple[Block, ...]:
    if "reduced_inertia" not in results.reduction:
        text = Sentence(
            "With several drives the masses give an inertia matrix and the loads a generalised force of each "
            "drive: kinetic energy and power remain those of the mechanism."
        )
        lines: Lines = (("T", "1/2 sum_(i, k) M_(i k) dot(q)_i dot(q)_k"), ("P", "sum_i Q_i dot(q)_i"))
        return Paragraph(text), Formula(lines)
    coordinate = results.mechanism.motion_parameter.drives[0]
    letter = LETTERS[coordinate.driven] if coordinate.is_chosen else "q"
    text = (
        Sentence(
            "The mechanism is replaced by its drive alone, with an inertia $J$ of the same kinetic energy and a moment "
            "$M$ of the same power. Primes denote derivatives with respect to the generalised coordinate {symbol}.",
            symbol=Expression(letter),
        )
        if coordinate.is_chosen
        else Sentence(
            "The mechanism is replaced by its drive alone, with an inertia $J(q)$ of the same kinetic energy and a "
            "moment $M(q)$ of the same power. Primes denote derivatives with respect to the value $q$ of the drive."
        )
    )
    kinetic = f"1/2 J dot({letter})^2"
    if results.mechanism.space == "sphere":
        meaning = Sentence(
            "$omega_k$ is the angular velocity of link $k$, $upright(bold(I))_k$ its tensor of inertia about the"
            " centre of the sphere."
        )
        inertia = "sum_k arrow(omega)'_k dot.op upright(bold(I))_k arrow(omega)'_k"
        lines = (("T", kinetic), ("J", inertia), ("M", "sum_j arrow(M)_j dot.op arrow(omega)'_j"))
        return Paragraph(text), Paragraph(meaning), Formula(lines, "reduction")
    meaning = Sentence(
        "$v_k$ is the velocity of the centre of mass of link $k$, $phi_k$ the angle of the link."
    )
    lines = (
        ("T", kinetic),
        ("J", "sum_k (m_k v'_k^2 + J_k phi'_k^2)"),
        ("J'", "2 sum_k (m_k arrow(v)'_k dot.op arrow(v)''_k + J_k phi'_k phi''_k)"),
        ("M", "sum_j arrow(F)_j dot.op arrow(r)'_j + sum_j M_j phi'_j"),
    )
    return Paragraph(text), Paragraph(meaning), Formula(lines, "reduction")


def _course(results: ReductionResults) -> Table:
    """A few even samples."""
    parameter, data = results.mechanism.motion_parameter, results.reduction
    head = Name(parameter.drives[0].label) if parameter.is_uniform else Expression(parameter.instant.symbol)
    quantities = (
        Column(name, data[name].values, str(data[name].attrs["units"]), Expression(letter))
        for name, letter in IN_TABLE
    )
    return Table(
        (
            Column("instant", np.asarray(parameter.instants(data)), parameter.instant.unit, head),
            *quantities,
        ),
        Sentence("Reduced inertia, its derivative and the reduced moment at equal steps"),
        rows_reached(data["status"]),
    )


def _sums(results: ReductionResults) -> Iterator[Section]:
    """The sums with their numbers at each instant, beside the reduction itself."""
    data = results.instants
    for k in range(0 if data is None else data.sizes["sample"]):
        assert data is not None
        links = results.links[k] if results.links else ()
        title = instant_title(results.mechanism, data, k)
        yield Section(title, tuple(_sums_at(results.mechanism, data.isel(sample=k), links)))


def _sums_at(mechanism: Mechanism, here: xr.Dataset, links: Sequence[LinkMotion]) -> Iterator[Block]:
    if not np.isfinite(float(here["reduced_inertia"])):
        yield Paragraph(Sentence("The mechanism does not reach this position: there are no values."))
        return
    if links:
        yield _table_of_links(mechanism, links)
    yield Formula((*_shares(links), *_totals(here)))
    if here.sizes["load"]:
        yield _table_of_loads(mechanism, here)
    if links:
        yield from _checks(here, links)


def _table_of_links(mechanism: Mechanism, links: Sequence[LinkMotion]) -> Table:
    """What the sums are made of: masses and coefficients, in SI, as they go together."""
    by_angle = mechanism.motion_parameter.drives[0].unit == "rad"
    columns = (
        ("m", "kg", [one.mass for one in links]),
        ("J", "kg m^2", [one.inertia for one in links]),
        ("v'", "m/rad" if by_angle else "1", [abs(one.velocity) for one in links]),
        ("phi'", "1" if by_angle else "rad/m", [one.turning for one in links]),
    )
    return Table(
        (
            Column("link", tuple(Name(one.link) for one in links), head=Sentence("link")),
            *(
                Column(
                    letter,
                    np.where(np.abs(values) < ROUNDING, 0.0, values),
                    unit,
                    Expression(letter),
                    unit_fixed=True,
                )
                for letter, unit, values in columns
            ),
        ),
        Sentence("Masses, and speeds of the links per unit of the drive's speed"),
    )


def _shares(links: Sequence[LinkMotion]) -> Iterator[tuple[Leaf, ...]]:
    """Inertia of each link, with its numbers."""
    for one in links:
        letters, terms = [], []
        for letter, speed, factor, coefficient in (
            ("m", "v", one.mass, abs(one.velocity)),
            ("J", "phi", one.inertia, one.turning),
        ):
            # what translates has no term of its turning; a mass has its term even where its centre rests
            if factor and (coefficient or letter == "m"):
                square = Expression(f"{speed}'_({{name}})^2", name=Name(one.link))
                letters.append(join_expressions((index_symbol(letter, one.link), square), " "))
                terms.append(
                    Expression(
                        "{factor} dot.op {coefficient}^(2)",
                        factor=Factor(Number(factor)),
                        coefficient=Factor(Number(coefficient)),
                    )
                )
        if letters:
            left = index_symbol("J", one.link, "^*")
            yield (
                left,
                join_expressions(letters, " + "),
                join_expressions(terms, " + "),
                Number(one.reduced_share),
            )


def _totals(here: xr.Dataset) -> Iterator[tuple[Leaf, ...]]:
    for name, symbol in IN_TABLE:
        shares, unit = here[f"{name}_part"].values.tolist(), str(here[name].attrs["units"])
        total = Number(float(here[name]), unit, unit_fixed=True)
        if len(shares) > 1:
            yield symbol, sum_of(shares), total
        elif shares:
            yield symbol, total


def _table_of_loads(mechanism: Mechanism, here: xr.Dataset) -> Table:
    names = tuple(load_text(mechanism, str(name)) for name in here["load"].values)
    unit = str(here["reduced_moment"].attrs["units"])
    shares = Column("share", here["reduced_moment_part"].values, unit, Expression("M"))
    return Table((Column("load", names, head=Sentence("load")), shares), Sentence("Share of each load"))


def _checks(here: xr.Dataset, links: Sequence[LinkMotion]) -> tuple[Check, Check]:
    """The sums over the links' own motions beside the reduction."""
    allowed = ROUNDINGS * float(np.finfo(float).eps)
    inertia, slope = sum(one.reduced_share for one in links), sum(one.slope for one in links)
    return (
        Check(
            Sentence("The reduced moment of inertia agrees with the sum over the links within {share}."),
            abs(inertia - float(here["reduced_inertia"])),
            inertia,
            allowed,
        ),
        Check(
            Sentence(
                "Its derivative agrees with the sum over the links within {share} of its greatest terms."
            ),
            abs(slope - float(here["reduced_inertia_slope"])),
            sum(one.slope_terms for one in links),
            allowed,
        ),
    )
