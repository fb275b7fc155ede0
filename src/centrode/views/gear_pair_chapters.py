"""Chapters of a document on a pair of gear wheels: data, geometry with its formulas, contact, contour, true teeth."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.gears.blocking_contour import LEAST_CONTACT_RATIO, LEAST_TIP_THICKNESS
from centrode.geometry.involute import involute
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Paragraph,
    Section,
    Table,
)
from centrode.sheets.texts import NOTHING, Expression, Factor, Joined, Leaf, Number, Sentence, Text

if TYPE_CHECKING:
    from centrode.gears.pair_geometry import GearWheel, PairGeometry
    from centrode.gears.recommended_shifts import RecommendedRow
    from centrode.gears.results import GearPairResults
    from centrode.model.gear_pairs import GearPair

Line = tuple[Leaf, ...]
PAIR_KINDS = {
    "external": Sentence("external"),
    "internal": Sentence("internal"),
    "rack": Sentence("wheel and rack"),
}
INV = 'op("inv")'
ROUNDING = 1e-9
"""Share by which two routes to one number may differ: roundings of differences of nearly equal numbers."""


def data_chapter(results: GearPairResults, purpose: Text | None) -> Chapter:
    """What is given of the pair."""
    pair, described = results.geometry, results.gear_pair
    facts = [Fact(Sentence("gearing"), PAIR_KINDS[pair.kind]), Fact(Sentence("module"), _size(pair.module))]
    for number, wheel in enumerate(pair.wheels):
        if not wheel.is_rack:
            label = Sentence("number of teeth of the pinion"), Sentence("number of teeth of the wheel")
            facts.append(Fact(label[number], Number(wheel.teeth)))
    facts.append(Fact(Sentence("helix angle"), _angle(pair.helix_angle)))
    facts.append(Fact(Sentence("pressure angle of the reference rack"), _angle(pair.rack.pressure_angle)))
    facts.append(Fact(Sentence("addendum coefficient"), Number(pair.rack.addendum)))
    facts.append(Fact(Sentence("clearance coefficient"), Number(pair.rack.clearance)))
    shifts: Text = Joined(tuple(Number(shift) for shift in pair.shifts), "; ")
    if purpose is not None:
        shifts = Sentence("{shifts}, {purpose}", shifts=shifts, purpose=purpose)
    facts.append(Fact(Sentence("shift coefficients"), shifts))
    if results.recommendation is not None:
        recommended = recommendation_text(results.recommendation, described)
        facts.append(Fact(Sentence("recommendation for"), recommended))
    if described.centre_distance is not None:
        facts.append(Fact(Sentence("centre distance"), _size(described.centre_distance)))
    if described.width is not None:
        facts.append(Fact(Sentence("width of the rims"), _size(described.width)))
    if described.speed is not None:
        facts.append(Fact(Sentence("speed of the pinion"), Number(described.speed, "rad/s", unit_fixed=True)))
    if described.moment is not None:
        facts.append(Fact(Sentence("moment on the pinion"), Number(described.moment, "N m")))
    return Chapter(Sentence("Data"), (Section(NOTHING, (FactTable(tuple(facts), Sentence("Gear pair")),)),))


def recommendation_text(row: RecommendedRow, described: GearPair) -> Text:
    """Which pairs the row of GOST 16532 is for that gave the shifts."""
    power = row.application == "power"
    parts: list[Text] = [Sentence("power transmission") if power else Sentence("kinematic transmission")]
    if described.centre_distance is None:
        parts.append(Sentence("centre distance not given"))
    elif "shifted" in row.distances:
        above, most = map(Number, row.sums)
        parts.append(Sentence("sum of the shifts above {above}, at most {most}", above=above, most=most))
    else:
        parts.append(Sentence("centre distance without shifts"))
    least, greatest = row.pinion
    if math.isfinite(greatest):
        ends = {"least": Number(least), "most": Number(greatest)}
        parts.append(Sentence("pinion of {least} to {most} teeth", **ends))
    elif least:
        parts.append(Sentence("pinion of {least} teeth or more", least=Number(least)))
    if row.least_wheel:
        parts.append(Sentence("wheel of {least} teeth or more", least=Number(row.least_wheel)))
    if row.least_ratio:
        parts.append(Sentence("ratio of {least} or more", least=Number(row.least_ratio)))
    return Joined(tuple(parts), "; ")


def _size(value: float, digits: str = ".7g") -> Number:
    return Number(value, "m", digits)


def _angle(value: float, digits: str = ".7g") -> Number:
    return Number(math.degrees(value), "°", digits, unit_fixed=True)


def _hidden(value: float) -> Number:
    return Number(value, "m", unit_hidden=True)


def _line(left: str, letters: str, notation: str, end: Leaf, **values: Leaf) -> Line:
    """Left side, the formula in letters, the same with numbers, and what comes out."""
    return left, Expression(letters), Expression(notation, **values), end


# Geometry


def geometry_chapter(results: GearPairResults, wheels_table: Table) -> Chapter:
    """Angles, distances and diameters, each by its formula with the numbers; all dimensions in a table."""
    pair = results.geometry
    sections = [
        Section(Sentence("Angle and centre distance"), tuple(_mesh(pair))),
        *(
            Section(title, tuple(_wheel(wheel)))
            for wheel, title in zip(
                pair.wheels,
                (Sentence("Dimensions of the pinion"), Sentence("Dimensions of the wheel")),
                strict=True,
            )
            if not wheel.is_rack
        ),
        Section(Sentence("All dimensions"), (wheels_table,)),
        Section(Sentence("Undercut and pointed teeth"), tuple(_bounds(pair))),
    ]
    return Chapter(Sentence("Geometry of the pair"), tuple(sections))


def _mesh(pair: PairGeometry) -> Iterator[Block]:
    if pair.helix_angle:
        yield from _transverse_section(pair)
    if pair.kind == "rack":
        yield Paragraph(
            Sentence(
                "With a rack the working pressure angle is that of the rack, $alpha_w = alpha_t$; shifts only move it."
            )
        )
        return
    yield Paragraph(Sentence("The working pressure angle $alpha_w$ follows from mesh without play:"))
    yield Formula(_working_angle(pair), "working-angle")
    yield Paragraph(Sentence("The pitch circles would touch at the distance $a$, the wheels mesh at $a_w$:"))
    yield Formula((*_distances(pair), *_distance_coefficients(pair)))
    apart = sum(_signed_radius(pair, wheel) for wheel in pair.wheels)
    yield Check(
        Sentence("The radii of the working pitch circles make up the centre distance within {share}."),
        abs(apart - pair.centre_distance),
        pair.centre_distance,
        ROUNDING,
    )


def _transverse_section(pair: PairGeometry) -> Iterator[Block]:
    """Module and angle of the section in which helical teeth are computed."""
    section = pair.transverse
    yield Paragraph(Sentence("Teeth are computed in the transverse section, with the module and the angle"))
    yield Formula(
        (
            _line(
                "m_t",
                "frac(m, cos beta)",
                "frac({m}, {c})",
                _size(section.module),
                m=_hidden(pair.module),
                c=Number(math.cos(pair.helix_angle)),
            ),
            ("alpha_t", Expression("arctan frac(tan alpha, cos beta)"), _angle(section.pressure_angle)),
        )
    )


def _sums(pair: PairGeometry) -> tuple[str, str]:
    """Letters of the sums of shifts and of teeth, which are differences where the wheel is internal."""
    return ("x_2 - x_1", "z_2 - z_1") if pair.kind == "internal" else ("x_1 + x_2", "z_1 + z_2")


def _working_angle(pair: PairGeometry) -> tuple[Line, ...]:
    shifts, teeth = _sums(pair)
    return (
        _line(
            'op("inv") alpha_w',
            f'op("inv") alpha_t + frac(2 ({shifts}) tan alpha, {teeth})',
            "{own} + frac(2 dot ({x}) dot {slope}, {z})",
            Number(pair.working_involute),
            own=Number(involute(pair.transverse.pressure_angle)),
            x=Number(pair.shift_sum),
            slope=Number(math.tan(pair.rack.pressure_angle)),
            z=Number(pair.teeth_sum),
        ),
        ("alpha_w", _angle(pair.working_angle)),
    )


def _distances(pair: PairGeometry) -> tuple[Line, ...]:
    """The distance of the pitch circles, and that of the centres."""
    section = pair.transverse
    return (
        _line(
            "a",
            f"frac(m_t ({_sums(pair)[1]}), 2)",
            "frac({m} dot {z}, 2)",
            _size(pair.pitch_distance),
            m=_hidden(section.module),
            z=Number(pair.teeth_sum),
        ),
        _line(
            "a_w",
            "a frac(cos alpha_t, cos alpha_w)",
            "{a} dot frac({ct}, {cw})",
            _size(pair.centre_distance),
            a=_hidden(pair.pitch_distance),
            ct=Number(math.cos(section.pressure_angle)),
            cw=Number(math.cos(pair.working_angle)),
        ),
    )


def _distance_coefficients(pair: PairGeometry) -> tuple[Line, ...]:
    """What the centres move by, and what that leaves of the shifts, in modules."""
    return (
        _line(
            "y",
            "frac(a_w - a, m)",
            "frac({aw} - {a}, {m})",
            Number(pair.distance_coefficient),
            aw=_hidden(pair.centre_distance),
            a=_hidden(pair.pitch_distance),
            m=_hidden(pair.module),
        ),
        _line(
            "Delta y",
            f"{_sums(pair)[0]} - y",
            "{x} - {y}",
            Number(pair.equalising_coefficient),
            x=Number(pair.shift_sum),
            y=Factor(Number(pair.distance_coefficient)),
        ),
    )


def _signed_radius(pair: PairGeometry, wheel: GearWheel) -> float:
    return wheel.working_pitch / 2 * (pair.sign if wheel.number == 0 else 1)


def _wheel(wheel: GearWheel) -> Iterator[Block]:
    """Diameters and thicknesses of a wheel."""
    values = _values_of(wheel)
    ends = _internal_ends if wheel.internal else _external_ends
    lines = [*_circles(wheel, values), *ends(wheel, values), _pitch_thickness(wheel, values)]
    if not wheel.tip_inside_base:
        lines += _tip_thickness(wheel, values)
    yield Formula(tuple(lines))


def _values_of(wheel: GearWheel) -> dict[str, Leaf]:
    """Numbers that the formulas of a wheel have in common."""
    pair = wheel.pair
    return {
        "m": _hidden(pair.module),
        "mt": _hidden(pair.transverse.module),
        "z": Number(wheel.teeth),
        "d": _hidden(wheel.pitch),
        "x": Factor(Number(wheel.shift)),
        "h": Number(pair.rack.addendum),
        "low": Factor(Number(pair.equalising_coefficient)),
        "c": Number(pair.rack.clearance),
        "slope": Number(math.tan(pair.rack.pressure_angle)),
    }


def _circles(wheel: GearWheel, values: dict[str, Leaf]) -> tuple[Line, ...]:
    """Pitch circle, base circle, working pitch circle."""
    pair, index = wheel.pair, wheel.number + 1
    return (
        _line(f"d_{index}", f"m_t z_{index}", "{mt} dot {z}", _size(wheel.pitch), **_of(values, "mt", "z")),
        _line(
            f"d_(b {index})",
            f"d_{index} cos alpha_t",
            "{d} dot {c}",
            _size(wheel.base),
            d=values["d"],
            c=Number(math.cos(pair.transverse.pressure_angle)),
        ),
        _line(
            f"d_(w {index})",
            f"frac(d_(b {index}), cos alpha_w)",
            "frac({b}, {c})",
            _size(wheel.working_pitch),
            b=_hidden(wheel.base),
            c=Number(math.cos(pair.working_angle)),
        ),
    )


def _internal_ends(wheel: GearWheel, values: dict[str, Leaf]) -> tuple[Line, ...]:
    """Tip and root circle of a wheel with its teeth inside."""
    pair, index = wheel.pair, wheel.number + 1
    relief = 0.25 - 0.125 * wheel.shift if wheel.shift < 2 else 0.0
    return (
        _line(
            f"d_(a {index})",
            f"d_{index} - 2 (h_a^* - x_{index} + Delta y - k_{index}) m",
            "{d} - 2 dot ({h} - {x} + {low} - {k}) dot {m}",
            _size(wheel.tip),
            k=Factor(Number(relief)),
            **_of(values, "d", "h", "x", "low", "m"),
        ),
        _line(
            f"d_(f {index})",
            "2 a_w + d_(a 1) + 2 c^* m",
            "2 dot {a} + {o} + 2 dot {c} dot {m}",
            _size(wheel.root),
            a=_hidden(pair.centre_distance),
            o=_hidden(pair.wheels[0].tip),
            **_of(values, "c", "m"),
        ),
    )


def _external_ends(wheel: GearWheel, values: dict[str, Leaf]) -> tuple[Line, ...]:
    """Tip and root circle of a wheel with its teeth outside; only beside another such wheel are its tips lowered."""
    pair, index = wheel.pair, wheel.number + 1
    lowered = pair.kind != "internal"
    letters, notation = (" - Delta y", " - {low}") if lowered else ("", "")
    return (
        _line(
            f"d_(a {index})",
            f"d_{index} + 2 (h_a^* + x_{index}{letters}) m",
            f"{{d}} + 2 dot ({{h}} + {{x}}{notation}) dot {{m}}",
            _size(wheel.tip),
            **_of(values, "d", "h", "x", "m", *(("low",) if lowered else ())),
        ),
        _line(
            f"d_(f {index})",
            f"d_{index} - 2 (h_a^* + c^* - x_{index}) m",
            "{d} - 2 dot ({t} - {x}) dot {m}",
            _size(wheel.root),
            t=Number(pair.rack.addendum + pair.rack.clearance),
            **_of(values, "d", "x", "m"),
        ),
    )


def _pitch_thickness(wheel: GearWheel, values: dict[str, Leaf]) -> Line:
    index, sign = wheel.number + 1, "+" if wheel.outwards > 0 else "-"
    return _line(
        f"s_{index}",
        f"(pi / 2 {sign} 2 x_{index} tan alpha) m_t",
        f"(pi / 2 {sign} 2 dot {{x}} dot {{slope}}) dot {{mt}}",
        _size(wheel.pitch_thickness),
        **_of(values, "x", "slope", "mt"),
    )


def _tip_thickness(wheel: GearWheel, values: dict[str, Leaf]) -> tuple[Line, ...]:
    """Pressure angle at the tips, and the thickness there."""
    index, own = wheel.number + 1, wheel.pair.transverse.pressure_angle
    sign, other = ("+", "-") if wheel.outwards > 0 else ("-", "+")
    at_tip = math.acos(wheel.base / wheel.tip)
    return (
        (f"alpha_(a {index})", Expression(f"arccos frac(d_(b {index}), d_(a {index}))"), _angle(at_tip)),
        _line(
            f"s_(a {index})",
            f"d_(a {index}) (frac(s_{index}, d_{index}) {sign} {INV} alpha_t {other} {INV} alpha_(a {index}))",
            f"{{da}} dot (frac({{s}}, {{d}}) {sign} {{it}} {other} {{ia}})",
            _size(wheel.tip_thickness),
            da=_hidden(wheel.tip),
            s=_hidden(wheel.pitch_thickness),
            d=values["d"],
            it=Number(involute(own)),
            ia=Number(involute(at_tip)),
        ),
    )


def _of(values: dict[str, Leaf], *names: str) -> dict[str, Leaf]:
    return {name: values[name] for name in names}


def _bounds(pair: PairGeometry) -> Iterator[Block]:
    """Least shifts without undercut; tips."""
    yield Paragraph(Sentence("The rack does not undercut a wheel whose shift coefficient is at least"))
    lines: list[Line] = []
    for wheel in pair.wheels:
        if wheel.is_generated:
            index = wheel.number + 1
            sine = math.sin(pair.transverse.pressure_angle)
            lines.append(
                _line(
                    f'x_({index} "min")',
                    f"h_a^* - frac(z_{index} sin^2 alpha_t, 2 cos beta)",
                    "{h} - frac({z} dot {s}, 2 dot {c})",
                    Number(wheel.least_shift),
                    h=Number(pair.rack.straight),
                    z=Number(wheel.teeth),
                    s=Number(sine * sine),
                    c=Number(math.cos(pair.helix_angle)),
                )
            )
    yield Formula(tuple(lines))
    for wheel, name in zip(pair.wheels, (Sentence("pinion"), Sentence("wheel")), strict=True):
        if wheel.is_generated:
            cut, free = (
                Sentence("{wheel}: undercut", wheel=name),
                Sentence("{wheel}: no undercut", wheel=name),
            )
            yield Paragraph(cut if wheel.undercut else free, clause=True)
        if not wheel.is_rack and math.isfinite(wheel.tip_thickness):
            text = Sentence(
                "{wheel}: the tips are {share} modules thick; at least {least} is usual",
                wheel=name,
                share=Number(wheel.tip_thickness / pair.module, digits=".3g"),
                least=Number(LEAST_TIP_THICKNESS),
            )
            yield Paragraph(text, clause=True)


# Contact


def contact_chapter(results: GearPairResults) -> Chapter:
    """Contact ratio, sliding, pressure and forces."""
    pair = results.geometry
    figures = tuple(Illustration(name) for name in _contact_pictures(pair))
    sections = [
        Section(Sentence("Contact ratio"), tuple(_contact_ratio(results))),
        Section(Sentence("Specific sliding and pressure"), (*_sliding(pair), *figures)),
    ]
    if results.forces is not None:
        sections.append(Section(Sentence("Forces between the teeth"), tuple(_forces(results))))
    return Chapter(Sentence("Contact and sliding"), tuple(sections))


def _contact_pictures(pair: PairGeometry) -> tuple[str, ...]:
    return ("sliding",) if pair.kind == "rack" else ("sliding", "contact-ratio")


def _contact_ratio(results: GearPairResults) -> Iterator[Block]:
    pair = results.geometry
    yield Paragraph(
        Sentence("The tips end the contact on the line of action. Its active length over the base pitch is")
    )
    begin, end = pair.action_ends
    lines: list[Line] = [
        _line(
            "p_b",
            "pi m_t cos alpha_t",
            "pi dot {m} dot {c}",
            _size(pair.base_pitch),
            m=_hidden(pair.transverse.module),
            c=Number(math.cos(pair.transverse.pressure_angle)),
        )
    ]
    letters = {
        "external": "sqrt(r_(a 1)^2 - r_(b 1)^2) + sqrt(r_(a 2)^2 - r_(b 2)^2) - a_w sin alpha_w",
        "internal": "sqrt(r_(a 1)^2 - r_(b 1)^2) - sqrt(r_(a 2)^2 - r_(b 2)^2) + a_w sin alpha_w",
        "rack": "sqrt(r_(a 1)^2 - r_(b 1)^2) - r_1 sin alpha_t + frac((h_a^* - x_1) m, sin alpha_t)",
    }
    lines.append(("g_alpha", Expression(letters[pair.kind]), _size(end - begin)))
    lines.append(
        _line(
            "epsilon_alpha",
            "frac(g_alpha, p_b)",
            "frac({g}, {p})",
            Number(pair.contact_ratio),
            g=_hidden(end - begin),
            p=_hidden(pair.base_pitch),
        )
    )
    if pair.overlap_ratio:
        lines.append(
            _line(
                "epsilon_beta",
                "frac(b sin beta, pi m)",
                "frac({b} dot {s}, pi dot {m})",
                Number(pair.overlap_ratio),
                b=_hidden(pair.width),
                s=Number(math.sin(pair.helix_angle)),
                m=_hidden(pair.module),
            )
        )
    yield Formula(tuple(lines), "contact-ratio")
    if pair.contact_ratio < 1:
        yield Paragraph(Sentence("It is below one: contact ends before the next teeth meet."))
    elif pair.contact_ratio < LEAST_CONTACT_RATIO:
        yield Paragraph(
            Sentence("The contact ratio is below the usual {least}.", least=Number(LEAST_CONTACT_RATIO))
        )
    if not any(wheel.undercut for wheel in pair.wheels):
        yield Check(
            Sentence("The contact of the true profiles gives the same contact ratio within {share}."),
            abs(results.true_contact_ratio - pair.contact_ratio),
            pair.contact_ratio,
            ROUNDING,
        )


def _sliding(pair: PairGeometry) -> Iterator[Block]:
    yield Paragraph(
        Sentence(
            "Specific sliding compares how fast the contact moves along both flanks; it is greatest where contact ends "
            "towards the roots. $rho$ are the radii of curvature there."
        )
    )
    lines: list[Line] = []
    for wheel in pair.wheels:
        if wheel.is_rack or wheel.sliding_is_unbounded:
            continue
        radius = wheel.active_end
        other = float(pair.other_curvature_radius(radius))
        own_index, other_index = ("1", "2") if wheel.number == 0 else ("2", "1")
        left, end = f"theta_{own_index}", Number(wheel.sliding)
        if pair.kind == "rack":
            lines.append((left, Expression("1 - frac(r_1 sin alpha_t, rho_1)"), end))
            continue
        own, over = (radius, other) if wheel.number == 0 else (other, radius)
        lines.append(
            _line(
                left,
                f"1 - frac(z_{own_index} rho_{other_index}, z_{other_index} rho_{own_index})",
                "1 - frac({z} dot {over}, {o} dot {own})",
                end,
                z=Number(wheel.teeth),
                o=Number(pair.wheels[1 - wheel.number].teeth),
                own=_hidden(own),
                over=_hidden(over),
            )
        )
    if lines:
        yield Formula(tuple(lines), "sliding")
    yield Paragraph(
        Sentence(
            "The pressure coefficient $theta_p = m / rho$ compares the module with the relative radius of curvature."
        )
    )


def _forces(results: GearPairResults) -> Iterator[Block]:
    forces, pair, moment = results.forces, results.geometry, results.gear_pair.moment
    assert forces is not None
    assert moment is not None
    lines = [
        _line(
            "F_t",
            "frac(2 T, d_(w 1))",
            "frac(2 dot {T}, {d})",
            Number(forces.tangential, "N"),
            T=Number(moment, "N m", unit_fixed=True, unit_hidden=True),
            d=Number(pair.wheels[0].working_pitch, "m", unit_fixed=True, unit_hidden=True),
        ),
        _line(
            "F_r",
            "F_t tan alpha_w",
            "{F} dot {s}",
            Number(forces.radial, "N"),
            F=Number(forces.tangential, "N", unit_hidden=True),
            s=Number(math.tan(pair.working_angle)),
        ),
    ]
    if forces.axial:
        lines.append(("F_x", Expression("F_t tan beta_w"), Number(forces.axial, "N")))
    yield Formula(tuple(lines))


def contour_chapter(results: GearPairResults) -> Chapter:
    """The blocking contour with the chosen point."""
    pair = results.geometry
    text = Paragraph(
        Sentence(
            "Every pair of shift coefficients $x_1$, $x_2$ inside the blocking contour gives a pair of these wheels "
            "that works: without undercut, pointed teeth and interference at the fillets, with a contact ratio of at "
            "least one. The pair has $x_1$ = {first} and $x_2$ = {second}.",
            first=Number(pair.shifts[0]),
            second=Number(pair.shifts[1]),
        )
    )
    return Chapter(
        Sentence("Blocking contour"), (Section(NOTHING, (text, Illustration("blocking-contour"))),)
    )


def teeth_chapter(results: GearPairResults) -> Chapter:
    """Teeth in mesh, and how the rack generates them."""
    text = Paragraph(
        Sentence(
            "The flanks are involutes; the edge of the generating rack envelopes the fillets. The contact moves along "
            "the active line of action, a common tangent of the base circles."
        )
    )
    figures = (text, Illustration("mesh"), Illustration("generation"))
    return Chapter(Sentence("Teeth in mesh and their generation"), (Section(NOTHING, figures),))
