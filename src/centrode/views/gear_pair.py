"""A pair of gear wheels: what the terminal, the files and the figures show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, assert_never

import numpy as np

from centrode.gears.blocking_contour import LEAST_CONTACT_RATIO, LEAST_TIP_THICKNESS
from centrode.gears.profiles import rack_over_pinion, whole_tooth
from centrode.gears.racks import rack_positions, rack_tooth
from centrode.gears.shift_fields import shift_fields
from centrode.numerics.outline_pieces import OutlinePiece
from centrode.sheets.outlines import DrawnLines, LineUse, OutlineDrawing, OutlineSet
from centrode.sheets.plots import (
    Abscissa,
    Area,
    AreaDiagram,
    AreaKind,
    AreaPath,
    AxisLabel,
    Curve,
    CurveDiagram,
    CurvePanel,
    Plot,
    Trace,
)
from centrode.sheets.sheet import (
    Column,
    Deferred,
    Fact,
    Failure,
    Scalar,
    Sheet,
    Table,
)
from centrode.sheets.texts import (
    NOTHING,
    Joined,
    Name,
    Number,
    Sentence,
    Symbol,
    Text,
    Title,
    Unit,
)
from centrode.views.gear_pair_chapters import (
    PAIR_KINDS,
    contact_chapter,
    contour_chapter,
    data_chapter,
    geometry_chapter,
    recommendation_text,
    teeth_chapter,
)

if TYPE_CHECKING:
    from centrode.gears.pair_faults import PairFault
    from centrode.gears.pair_geometry import GearWheel, PairGeometry
    from centrode.gears.profiles import ToothProfile
    from centrode.gears.results import GearPairResults

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]

PINION, WHEEL, RACK = Sentence("pinion"), Sentence("wheel"), Sentence("rack")
PURPOSES = {
    "no undercut": Sentence("chosen so that the rack does not undercut"),
    "equal sliding": Sentence("chosen for equal specific sliding"),
    "least sliding": Sentence("chosen for the least specific sliding"),
    "strength": Sentence("chosen for the flattest flanks at the pitch point"),
    "standard": Sentence("recommended by GOST 16532"),
}
CURVES = {
    "mesh": Sentence("no mesh without play"),
    "undercut_1": Sentence("undercut of the pinion"),
    "undercut_2": Sentence("undercut of the wheel"),
    "interference_1": Sentence("interference at the pinion's fillet"),
    "interference_2": Sentence("interference at the wheel's fillet"),
    "pointed_1": Sentence("pointed teeth of the pinion"),
    "pointed_2": Sentence("pointed teeth of the wheel"),
    "tips": Sentence("tips run into each other"),
    "contact_ratio_1": Sentence("contact ratio of one"),
    "contact_ratio_1.2": Sentence("contact ratio {ratio}", ratio=Number(LEAST_CONTACT_RATIO)),
    "tip_0.25_1": Sentence("tips of the pinion: {share} modules", share=Number(LEAST_TIP_THICKNESS)),
    "tip_0.25_2": Sentence("tips of the wheel: {share} modules", share=Number(LEAST_TIP_THICKNESS)),
    "tip_0.4_1": Sentence("tips of the pinion: {share} modules", share=Number(0.4)),
    "tip_0.4_2": Sentence("tips of the wheel: {share} modules", share=Number(0.4)),
    "equal_sliding": Sentence("equal specific sliding"),
}
TEETH_SHOWN = 3
"""Teeth on each side of the mesh in a drawing of it."""
RACK_TEETH = 4
"""The same of a rack, whose gap lies in the middle."""
MOST_SLIDING = 12.0
"""Specific sliding beyond which a curve leaves its figure: at a base circle it is infinite."""
MOST_PRESSURE = 6.0
"""Pressure coefficient beyond which a curve leaves its figure, for the same reason."""


def sheet(results: GearPairResults) -> Sheet:
    """Everything there is to say about a pair of wheels."""
    contour = results.geometry.kind != "rack"
    return Sheet(
        facts=tuple(_facts(results)),
        scalars=_scalars(results),
        tables=Deferred(
            {
                "wheels": lambda: _wheels_file(results),
                "line-of-action": lambda: _action_table(results),
                **({"blocking-contour": lambda: _contour_table(results)} if contour else {}),
            }
        ),
        pictures=Deferred(
            {
                "mesh": lambda: _mesh(results),
                "sliding": lambda: _sliding(results),
                "generation": lambda: _generation(results),
                **(
                    {
                        "contact-ratio": lambda: _contact_ratios(results),
                        "blocking-contour": lambda: _contour(results),
                    }
                    if contour
                    else {}
                ),
            }
        ),
        chapters=Deferred(
            {
                "data": lambda: data_chapter(results, PURPOSES.get(results.gear_pair.purpose or "")),
                "gear-geometry": lambda: geometry_chapter(results, wheels_table(results)),
                "gear-contact": lambda: contact_chapter(results),
                **({"blocking-contour": lambda: contour_chapter(results)} if contour else {}),
                "gear-teeth": lambda: teeth_chapter(results),
            }
        ),
        printed=(wheels_table(results),),
        outlines=Deferred(
            {
                name: lambda profile=profile: _outline(results, profile)  # type: ignore[misc]
                for name, profile in zip(("pinion", "wheel"), results.profiles, strict=False)
            }
        ),
        failure=_failure(results),
        notes=tuple(_notes(results)),
    )


def _second(pair: PairGeometry) -> Sentence:
    return RACK if pair.kind == "rack" else WHEEL


def _facts(results: GearPairResults) -> Iterator[Fact]:
    yield from _facts_of_shifts(results)
    yield from _facts_of_mesh(results)
    yield from _facts_of_loading(results)


def _facts_of_shifts(results: GearPairResults) -> Iterator[Fact]:
    pair, described = results.geometry, results.gear_pair
    teeth = Sentence("helical teeth") if pair.helix_angle else Sentence("spur teeth")
    yield Fact(Sentence("pair"), Joined((PAIR_KINDS[pair.kind], teeth)))
    yield Fact(Sentence("module"), Number(pair.module, "m"))
    if pair.helix_angle:
        yield Fact(Sentence("helix angle"), Number(pair.helix_angle, "rad"))
    if pair.kind != "rack":
        yield Fact(Sentence("ratio"), Number(pair.ratio))
    first, second = pair.shifts
    shifts: Text = Joined((Number(first), Number(second)), "; ")
    if described.purpose is not None:
        shifts = Sentence("{shifts}, {purpose}", shifts=shifts, purpose=PURPOSES[described.purpose])
    yield Fact(Sentence("shift coefficients"), shifts)
    if results.recommendation is not None:
        yield Fact(Sentence("recommendation for"), recommendation_text(results.recommendation, described))


def _facts_of_mesh(results: GearPairResults) -> Iterator[Fact]:
    pair = results.geometry
    yield Fact(Sentence("working pressure angle"), Number(pair.working_angle, "rad"))
    if pair.kind != "rack":
        distance = Sentence(
            "{working}, without shifts {plain}",
            working=Number(pair.centre_distance, "m"),
            plain=Number(pair.pitch_distance, "m"),
        )
        yield Fact(Sentence("centre distance"), distance)
    yield Fact(Sentence("contact ratio"), Number(pair.contact_ratio))
    if results.true_contact_ratio < pair.contact_ratio * (1 - 1e-9):
        yield Fact(
            NOTHING,
            Sentence("{ratio} of the flanks that undercut leaves", ratio=Number(results.true_contact_ratio)),
        )
    if pair.overlap_ratio:
        total = Sentence(
            "{overlap}, total {total}",
            overlap=Number(pair.overlap_ratio),
            total=Number(pair.overlap_ratio + pair.contact_ratio),
        )
        yield Fact(Sentence("overlap ratio"), total)
    clearances = Joined(tuple(Number(one.radial_clearance, "m") for one in pair.wheels), "; ")
    yield Fact(Sentence("radial clearance at the tips"), clearances)
    pinion, wheel = (
        Sentence("unbounded") if one.sliding_is_unbounded else Number(one.sliding, digits=".4g")
        for one in pair.wheels
    )
    sliding = Sentence("pinion {pinion}, {second} {wheel}", pinion=pinion, wheel=wheel, second=_second(pair))
    yield Fact(Sentence("greatest specific sliding"), sliding)


def _facts_of_loading(results: GearPairResults) -> Iterator[Fact]:
    """The speed of the second wheel and the forces between the teeth, where the description gives speed and moment."""
    pair = results.geometry
    if results.output_speed is not None:
        unit = "m/s" if pair.kind == "rack" else "rad/s"
        yield Fact(
            Sentence("speed of the rack") if pair.kind == "rack" else Sentence("speed of the wheel"),
            Number(results.output_speed, unit, unit_fixed=unit == "rad/s"),
        )
    if results.forces is not None:
        forces = results.forces
        parts = [
            Sentence("tangential {force}", force=Number(forces.tangential, "N")),
            Sentence("radial {force}", force=Number(forces.radial, "N")),
        ]
        if forces.axial:
            parts.append(Sentence("axial {force}", force=Number(forces.axial, "N")))
        yield Fact(Sentence("forces between the teeth"), Joined(tuple(parts)))


def _scalars(results: GearPairResults) -> dict[str, Scalar]:
    pair = results.geometry
    found = {
        "module": Scalar(pair.module, "m"),
        "shift_1": Scalar(pair.shifts[0], "1"),
        "shift_2": Scalar(pair.shifts[1], "1"),
        "working_pressure_angle": Scalar(pair.working_angle, "rad"),
        "centre_distance": Scalar(pair.centre_distance, "m"),
        "contact_ratio": Scalar(pair.contact_ratio, "1"),
        "overlap_ratio": Scalar(pair.overlap_ratio, "1"),
        "greatest_sliding_1": Scalar(pair.wheels[0].sliding, "1"),
        "greatest_sliding_2": Scalar(pair.wheels[1].sliding, "1"),
    }
    if results.forces is not None:
        found["tangential_force"] = Scalar(results.forces.tangential, "N")
        found["radial_force"] = Scalar(results.forces.radial, "N")
        found["axial_force"] = Scalar(results.forces.axial, "N")
    return {name: scalar for name, scalar in found.items() if math.isfinite(scalar.value)}


Row = tuple[Text, str, list[float]]


def _rows(results: GearPairResults) -> list[Row]:
    """Dimensions of both wheels: what it is, its SI unit, the values; those that neither has are left out."""
    pair = results.geometry
    rows: list[Row] = []

    def row(head: Text, unit: str, values: list[float]) -> None:
        if not all(math.isnan(value) for value in values):
            rows.append((head, unit, values))

    def of_wheels(head: Text, unit: str, attribute: str) -> None:
        row(head, unit, [float(getattr(wheel, attribute)) for wheel in pair.wheels])

    def of_measurements(head: Text, unit: str, attribute: str) -> None:
        values = [float(getattr(one, attribute)) for one in results.measurements]
        row(head, unit, values + [math.nan] * (2 - len(values)))

    teeth = [pair.teeth[0], math.nan if math.isinf(pair.teeth[1]) else pair.teeth[1]]
    row(Sentence("number of teeth"), "1", teeth)
    of_wheels(Sentence("shift coefficient"), "1", "shift")
    of_wheels(Sentence("least shift without undercut"), "1", "least_shift")
    of_wheels(Sentence("pitch diameter"), "m", "pitch")
    of_wheels(Sentence("base diameter"), "m", "base")
    of_wheels(Sentence("working pitch diameter"), "m", "working_pitch")
    of_wheels(Sentence("tip diameter"), "m", "tip")
    of_wheels(Sentence("root diameter"), "m", "root")
    of_wheels(Sentence("addendum"), "m", "addendum")
    of_wheels(Sentence("dedendum"), "m", "dedendum")
    of_wheels(Sentence("tooth thickness on the pitch circle"), "m", "pitch_thickness")
    of_wheels(Sentence("tooth thickness at the tip"), "m", "tip_thickness")
    of_measurements(Sentence("constant chord"), "m", "constant_chord")
    of_measurements(Sentence("height to the constant chord"), "m", "constant_chord_height")
    of_measurements(Sentence("teeth of the span"), "1", "span_teeth")
    of_measurements(Sentence("span over these teeth"), "m", "span")
    of_measurements(Sentence("pin diameter"), "m", "pin")
    of_measurements(Sentence("dimension over pins"), "m", "over_pins")
    return rows


def wheels_table(results: GearPairResults) -> Table:
    """Dimensions of both wheels, in the units of the display."""
    heads, units, numbers = zip(*_rows(results), strict=True)
    spelled = tuple(NOTHING if unit == "1" else Unit(unit, shown=True) for unit in units)
    # numbers of teeth and lengths stand in one column: each is spelled by itself
    pinion, wheel = (
        tuple(Number(row[place], unit, unit_hidden=True) for unit, row in zip(units, numbers, strict=True))
        for place in (0, 1)
    )
    return Table(
        (
            Column("quantity", heads, head=Sentence("dimension")),
            Column("unit", spelled, head=Sentence("unit")),
            Column("pinion", pinion, head=PINION),
            Column("wheel", wheel, head=_second(results.geometry)),
        ),
        Sentence("Dimensions of the wheels"),
    )


def _wheels_file(results: GearPairResults) -> Table:
    """The same in SI and in full."""
    heads, units, numbers = zip(*_rows(results), strict=True)
    values = np.array(numbers)
    return Table(
        (
            Column("quantity", heads),
            Column("unit", tuple(Name("" if unit == "1" else unit) for unit in units)),
            Column("pinion", values[:, 0]),
            Column("wheel", values[:, 1]),
        )
    )


def _action_table(results: GearPairResults) -> Table:
    action = results.line_of_action
    columns = [
        Column("place", action.places, "m", head=Sentence("from the pitch point")),
        Column("radius_1", action.radii[:, 0], "m", head=Sentence("radius of curvature of the pinion")),
        Column("radius_2", action.radii[:, 1], "m", head=Sentence("radius of curvature of the other flank")),
        Column("sliding_1", action.sliding[:, 0], head=Sentence("specific sliding of the pinion")),
        Column("sliding_2", action.sliding[:, 1], head=Sentence("specific sliding of the other flank")),
        Column("pressure", action.pressure, head=Sentence("pressure coefficient")),
    ]
    if action.speeds is not None:
        columns.append(Column("sliding_speed", action.speeds, "m/s", head=Sentence("sliding speed")))
    return Table(tuple(columns), Sentence("Along the line of action"))


def _contour_table(results: GearPairResults) -> Table:
    contour = results.contour
    assert contour is not None
    kept = {name: places[~np.isnan(places).any(axis=1)] for name, places in contour.curves.items()}
    names = tuple(CURVES[name] for name, places in kept.items() for _place in places)
    places = np.concatenate([*kept.values(), np.empty((0, 2))])
    return Table(
        (
            Column("curve", names, head=Sentence("curve")),
            Column("shift_1", places[:, 0], head=Sentence("shift of the pinion")),
            Column("shift_2", places[:, 1], head=Sentence("shift of the wheel")),
        ),
        Sentence("Curves of the blocking contour"),
    )


# What is wrong


_ADVICE = Sentence("choose other shifts: those of least sliding satisfy all bounds where that is possible")


def _failure(results: GearPairResults) -> Failure | None:
    """Why the pair cannot work, its first fault, and what helps."""
    fault = next(iter(results.faults), None)
    return None if fault is None else Failure(*_words_of_fault(results, fault))


def _words_of_fault(results: GearPairResults, fault: PairFault) -> tuple[Sentence, Sentence]:
    """What is wrong, and the repair."""
    pair = results.geometry
    wheel = (PINION, _second(pair))[fault.wheel or 0]
    match fault.kind:
        case "tip inside base":
            wrong = Sentence(
                "{wheel}: its tips lie inside the base circle, where there is no involute", wheel=wheel
            )
            return wrong, Sentence("raise its shift or its number of teeth")
        case "no clearance":
            return Sentence("{wheel}: its tips reach the root of the other one", wheel=wheel), _ADVICE
        case "contact ratio":
            ratio = Number(pair.contact_ratio, digits=".4g")
            wrong = Sentence("the contact ratio {ratio} is below one", ratio=ratio)
            return wrong, Sentence("reduce the sum of the shifts, or raise the numbers of teeth")
        case "pointed":
            wrong = Sentence("{wheel}: the teeth are pointed below their tip", wheel=wheel)
            return wrong, Sentence("reduce its shift")
        case "fillet":
            return Sentence("{wheel}: the tips of the other one run into its fillets", wheel=wheel), _ADVICE
        case "tips":
            wrong = Sentence("the tips of both wheels run into each other as they leave mesh")
            return wrong, Sentence("enlarge the difference of the numbers of teeth, or the shifts")
        case "contact after undercut":
            left = Number(results.true_contact_ratio, digits=".4g")
            wrong = Sentence("undercut leaves a contact ratio of {left}, which is below one", left=left)
            return wrong, Sentence("raise the shift of the undercut wheel")
    assert_never(fault.kind)


def _notes(results: GearPairResults) -> Iterator[Text]:
    """What a designer should know besides."""
    pair = results.geometry
    for wheel, name in zip(pair.wheels, (PINION, _second(pair)), strict=True):
        if wheel.undercut:
            yield Sentence(
                "{wheel}: undercut; without it the shift is at least {least}, or the number of teeth {teeth}",
                wheel=name,
                least=Number(wheel.least_shift, digits=".5g"),
                teeth=Number(math.ceil(wheel.least_teeth)),
            )
        if wheel.sliding_is_unbounded:
            yield Sentence(
                "{wheel}: contact reaches its base circle, where sliding grows without bound", wheel=name
            )
        if 0 < wheel.tip_thickness < LEAST_TIP_THICKNESS * pair.module:
            yield Sentence(
                "{wheel}: the tips are {share} modules thick; at least {least} is usual",
                wheel=name,
                share=Number(wheel.tip_thickness / pair.module, digits=".3g"),
                least=Number(LEAST_TIP_THICKNESS),
            )
    if 1 <= results.true_contact_ratio < LEAST_CONTACT_RATIO:
        yield Sentence("the contact ratio is below the usual {least}", least=Number(LEAST_CONTACT_RATIO))


# Pictures


def _outline(results: GearPairResults, profile: ToothProfile) -> OutlineSet:
    """All teeth of a wheel about its axis."""
    pieces = [
        piece.on_layer("profile").moved_by(2 * math.pi * tooth / profile.teeth)
        for tooth in range(profile.teeth)
        for piece in whole_tooth(profile)
    ]
    return OutlineSet(Title(results.gear_pair.title), tuple(pieces))


@dataclass(frozen=True)
class _TeethInMesh:
    """Teeth of a wheel about the pitch point.

    Attributes
    ----------
    wheel, profile : whose they are
    angles : of the teeth shown, from that on the y axis of the profile [rad]
    centre : of the wheel from that of the pinion [m]
    up : 1 where the pitch point lies above the centre, -1 below
    """

    wheel: GearWheel
    profile: ToothProfile
    angles: Array
    centre: tuple[float, float]
    up: int

    def arc(self, diameter: float) -> Array:
        """An arc of a circle of the wheel over the teeth shown."""
        half = math.pi / self.profile.teeth * len(self.angles)
        return _arc(self.centre, diameter / 2, self.up, half)

    def on_all(self, piece: OutlinePiece) -> list[OutlinePiece]:
        """A piece of the tooth on the y axis on each of the teeth."""
        return [piece.moved_by(angle, self.centre) for angle in self.angles.tolist()]

    @property
    def working_flanks(self) -> list[Array]:
        """The flanks that touch the other wheel where the pinion drives, from where contact begins to the tips."""
        wheel = self.wheel
        ends = sorted((wheel.base / 2 / math.cos(wheel.active_pressure), wheel.tip / 2))
        # The pinion drives with the left flanks; the right flanks of a wheel above it are left ones of its own tooth.
        side = 1 if wheel.internal else -1
        flanks = []
        for piece in whole_tooth(self.profile):
            radii = np.hypot(*piece.places.T)
            kept = (radii > ends[0] * (1 - 1e-9)) & (radii < ends[1] * (1 + 1e-9))
            if np.ptp(radii) > 1e-9 * ends[1] and (side * piece.places[:, 0] > 0).all() and kept.sum() > 1:
                flanks += [moved.places[kept] for moved in self.on_all(piece)]
        return flanks


def teeth_in_mesh(results: GearPairResults) -> list[_TeethInMesh]:
    """The teeth of each wheel that are shown; of a rack there are none."""
    pair = results.geometry
    found = []
    for number, profile in enumerate(results.profiles):
        step = 2 * math.pi / profile.teeth
        centre, turn, up = (0.0, 0.0), 0.0, 1
        if number:
            # A gap of the wheel takes the pinion's tooth: below its centre where it is external, above where internal.
            centre = (0.0, pair.sign * pair.centre_distance)
            turn, up = step / 2 + (math.pi if pair.sign > 0 else 0.0), -pair.sign
        shown = min(TEETH_SHOWN, (profile.teeth - 1) // 2)
        # The gap of the wheel lies in the middle: as many teeth on either side.
        angles: Array = turn + step * np.arange(-shown, shown + 1 - number, dtype=float)
        found.append(_TeethInMesh(pair.wheels[number], profile, angles, centre, up))
    return found


def mesh_parts(results: GearPairResults) -> tuple[list[OutlinePiece], list[Array], Array]:
    """Teeth about the pitch point, arcs of the working pitch circles, and both ends of the active line of action."""
    pair = results.geometry
    teeth = teeth_in_mesh(results)
    pieces = [
        moved.on_layer(("profile", "shoe")[one.wheel.number])
        for one in teeth
        for piece in whole_tooth(one.profile)
        for moved in one.on_all(piece)
    ]
    circles = [one.arc(one.wheel.working_pitch) for one in teeth]
    begin, end = pair.action_ends
    middle, angle = pair.pitch_curvature_radius, pair.working_angle
    # The contact moves with the driven flank: along the inner tangent of both base circles through the pitch point.
    direction = np.array([-math.cos(angle), math.sin(angle)])
    pitch = np.array([[0.0, pair.wheels[0].working_pitch / 2]])
    return pieces, circles, pitch + np.outer(np.array([max(begin, 0.0), end]) - middle, direction)


def _mesh(results: GearPairResults) -> OutlineDrawing:
    """The teeth about the pitch point, with their working flanks, the circles and the line of action."""
    pair = results.geometry
    teeth = teeth_in_mesh(results)
    pieces, circles, action = mesh_parts(results)
    shapes = []
    if pair.kind == "rack":
        shapes.append(DrawnLines(LineUse.FOLLOWER, Sentence("teeth of the rack"), (rack_line(pair),)))
    flanks = tuple(flank for one in teeth for flank in one.working_flanks)
    shapes += [
        DrawnLines(LineUse.WORKING, Sentence("working flanks"), flanks),
        DrawnLines(LineUse.AXIS, Sentence("working pitch circles"), tuple(circles)),
        DrawnLines(LineUse.CIRCLE, Sentence("base circles"), tuple(one.arc(one.wheel.base) for one in teeth)),
        DrawnLines(LineUse.NORMAL, Sentence("active line of action"), (action,)),
    ]
    return OutlineDrawing(
        Sentence("Teeth in mesh"),
        Title(results.gear_pair.title),
        tuple(pieces),
        {"profile": PINION, "shoe": WHEEL} if pair.kind != "rack" else {"profile": PINION},
        tuple(shapes),
        Sentence("axis of the pinion"),
    )


ROLLED = 0.75
"""Positions of the rack reach this share of a turn of two teeth to either side."""
POSITIONS = 17


def generation_parts(results: GearPairResults) -> tuple[list[OutlinePiece], tuple[Array, ...]]:
    """Teeth of the pinion beside a gap on the y axis, and the positions of the rack's tooth that cuts the gap."""
    pair, profile = results.geometry, results.profiles[0]
    wheel, step = pair.wheels[0], 2 * math.pi / profile.teeth
    teeth = [
        piece.on_layer("profile").moved_by(side * step / 2)
        for side in (-1, 1)
        for piece in whole_tooth(profile)
    ]
    # The rack meets the tips where it has rolled by about the angle of a tooth and a half.
    rolled = np.linspace(-1.0, 1.0, POSITIONS) * ROLLED * 2 * step
    outline = rack_tooth(pair.transverse, wheel.shift * pair.module)
    return teeth, tuple(rack_positions(outline, wheel.pitch / 2, rolled))


def _generation(results: GearPairResults) -> OutlineDrawing:
    """How the rack generates a gap of the pinion: its positions as it rolls. Undercut is where they cross a flank."""
    teeth, positions = generation_parts(results)
    pitch = results.geometry.wheels[0].pitch / 2
    circle = _arc((0.0, 0.0), pitch, 1, 2 * math.pi / results.profiles[0].teeth)
    return OutlineDrawing(
        Sentence("Generation by the rack"),
        Title(results.gear_pair.title),
        tuple(teeth),
        {"profile": PINION},
        (
            DrawnLines(LineUse.NORMAL, Sentence("positions of the rack"), positions),
            DrawnLines(LineUse.AXIS, Sentence("pitch circle"), (circle,)),
        ),
        NOTHING,
    )


def _arc(centre: tuple[float, float], radius: float, up: int, half: float) -> Array:
    """An arc over or below a centre [m], by so much [rad] to either side."""
    angles = np.linspace(-half, half, 121)
    return np.stack([centre[0] + radius * np.sin(angles), centre[1] + up * radius * np.cos(angles)], axis=-1)


def rack_line(pair: PairGeometry) -> Array:
    """Teeth of the rack whose gap takes the pinion's tooth."""
    return rack_over_pinion(pair, RACK_TEETH)


def sliding_label(results: GearPairResults) -> Sentence:
    """What an axis of specific sliding is called; where it grows beyond what is shown, up to where it is."""
    if (np.abs(results.line_of_action.sliding) > MOST_SLIDING).any():
        return Sentence("specific sliding, shown up to {most} in size", most=Number(MOST_SLIDING))
    return Sentence("specific sliding")


def _sliding(results: GearPairResults) -> Plot:
    """Specific sliding and pressure along the line of action."""
    action, pair = results.line_of_action, results.geometry
    names = (PINION, _second(pair))
    sliding = np.where(np.abs(action.sliding) > MOST_SLIDING, np.nan, action.sliding)
    curves = [Curve(name, sliding[:, place], place) for place, name in enumerate(names)]
    label = AxisLabel(Sentence("along the line of action, from the pitch point"), unit="m")
    count = np.arange(len(action.places), dtype=np.intp)
    rows = [
        (CurvePanel(AxisLabel(sliding_label(results)), tuple(curves)),),
        (
            CurvePanel(
                AxisLabel(Sentence("pressure coefficient")),
                (
                    Curve(
                        Sentence("pressure coefficient"),
                        np.where(action.pressure > MOST_PRESSURE, np.nan, action.pressure),
                        2,
                    ),
                ),
                legend=False,
                from_zero=True,
            ),
        ),
    ]
    if action.speeds is not None:
        speed = Curve(Sentence("sliding speed"), action.speeds, 3)
        rows.append(
            (
                CurvePanel(
                    AxisLabel(Sentence("sliding speed"), unit="m/s"), (speed,), legend=False, from_zero=True
                ),
            )
        )
    places = []
    if action.single is not None:
        places = [
            (Sentence("one pair from here"), action.single[0]),
            (Sentence("one pair to here"), action.single[1]),
        ]
    return Plot(
        Sentence("Sliding along the line of action"),
        Title(results.gear_pair.title),
        Abscissa(label, action.places, count),
        tuple(rows),
        places=tuple(places),
    )


SHIFT_NODES = 241
"""Places of the curves of the contact ratio."""


def _contact_ratios(results: GearPairResults) -> CurveDiagram:
    """The contact ratio over the shift of each wheel alone, and over that of the pinion at the centre distance."""
    contour, pair = results.contour, results.geometry
    assert contour is not None
    first, second = pair.shifts
    across = np.linspace(contour.first[0], contour.first[-1], SHIFT_NODES)
    up = np.linspace(contour.second[0], contour.second[-1], SHIFT_NODES)
    kept = pair.shift_sum
    courses = (
        (Sentence("over the shift of the pinion alone"), across, across, np.full(SHIFT_NODES, second)),
        (Sentence("over the shift of the wheel alone"), up, np.full(SHIFT_NODES, first), up),
        (
            Sentence("over that of the pinion, the centre distance kept"),
            across,
            across,
            kept - pair.sign * across,
        ),
    )
    traces = []
    for name, shown, own, other in courses:
        ratios = shift_fields(pair, own, other).contact_ratio
        traces.append(Trace(name, shown, np.where(ratios > 0, ratios, np.nan)))
    here = np.array([[first, pair.contact_ratio]])
    traces[0] = Trace(traces[0].name, traces[0].x, traces[0].y, marks=here)
    return CurveDiagram(
        Sentence("Contact ratio over the shifts"),
        Title(results.gear_pair.title),
        AxisLabel(Sentence("shift coefficient")),
        AxisLabel(Sentence("contact ratio")),
        tuple(traces),
        (float(min(across[0], up[0])), float(max(across[-1], up[-1]))),
    )


def _contour(results: GearPairResults) -> AreaDiagram:
    """The blocking contour with its curves, and the place of this pair."""
    contour = results.contour
    assert contour is not None
    paths = [
        AreaPath(CURVES[name], places[:, 0], places[:, 1], AreaKind.MAIN, pen)
        for pen, (name, places) in enumerate(contour.curves.items())
        if len(places) and np.isfinite(places).any()
    ]
    return AreaDiagram(
        Sentence("Blocking contour"),
        Title(results.gear_pair.title),
        AxisLabel(symbol=Symbol("x", "1")),
        AxisLabel(symbol=Symbol("x", "2")),
        contour.first,
        contour.second,
        (Area(Sentence("possible shifts"), contour.possible),),
        tuple(paths),
        ((Sentence("this pair"), *results.geometry.shifts),),
    )
