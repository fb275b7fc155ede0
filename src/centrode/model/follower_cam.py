"""The description of a plate cam with a follower whose lift is given over a turn."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import (
    Field,
    ModelWrapValidatorHandler,
    PlainValidator,
    ValidationInfo,
    field_validator,
    model_validator,
)

from centrode import laws
from centrode.errors import InputError
from centrode.laws import SegmentedLaw
from centrode.laws.rises import TextPiece, plain
from centrode.laws.segments import segment_formula
from centrode.locale import _
from centrode.model import reading
from centrode.model.cam import Material, Size, Steepness, Stress
from centrode.model.cam_cycle import with_angles_of_segments
from centrode.model.reading import (
    KEY,
    DescriptionPart,
    Problem,
    Problems,
    bounded_list,
    choice,
    entries,
    missing_key,
    value_text,
)
from centrode.model.segments import (
    DRIVEN,
    UNITS,
    foreign_keys,
    plain_rate,
    problems_of_end,
    read_degree,
    read_through,
)
from centrode.model.settings import CamReportWishes, Display, read_samples
from centrode.model.values import Angle, Flag, Text, not_negative, positive, quantity, si
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.operations import SCALARS
from centrode.quantities import terminal_unit

# Parts of a cam with a follower: cam, follower, spring, bounds, tool, study.

KINDS = ("translating", "oscillating")
CONTACTS = ("knife", "roller", "flat")
TURNS = ("counter-clockwise", "clockwise")


class CamBody(DescriptionPart):
    """The cam: table [cam].

    Attributes
    ----------
    base_radius : float [m] or None
        Least distance of the follower's contact place (of a roller: of the cam's profile) from the centre, at lift 0.
    turn : "counter-clockwise" or "clockwise"
    speed : float [rad/s] or None
        Of the camshaft, positive.
    thickness : float [m] or None
        Width of the cam across its plane.
    material : Material or None
    """

    base_radius: Size | None = None
    turn: Annotated[Literal["counter-clockwise", "clockwise"], choice(*TURNS)] = "counter-clockwise"
    speed: Annotated[float, quantity("angular speed", positive)] | None = None
    thickness: Size | None = None
    material: Material | None = None


class Spring(DescriptionPart):
    """A spring that presses the follower on the cam.

    Attributes
    ----------
    stiffness : float [N/m], of an oscillating follower [N*m/rad]
    preload : float [N], of an oscillating follower [N*m]
        At lift 0.
    """

    stiffness: float
    preload: float = 0.0

    @field_validator("stiffness", mode="plain")
    @classmethod
    def _stiffness(cls, value: object) -> float:
        return not_negative(value, "angular stiffness" if DRIVEN.get() == "angle" else "stiffness")

    @field_validator("preload", mode="plain")
    @classmethod
    def _preload(cls, value: object) -> float:
        return not_negative(value, "torque" if DRIVEN.get() == "angle" else "force")


class Follower(DescriptionPart):
    """What the cam moves.

    Attributes
    ----------
    kind : "translating" or "oscillating"
    contact : "knife", "roller" or "flat"
    roller_radius : float [m]
        Of a roller.
    offset : float [m]
        Of a translating follower: of its line from the cam's centre.
    arm, pivot_distance : float [m]
        Of an oscillating follower: its length to the roller's centre or the edge; of its pivot from the cam's centre.
    face_offset : float [m]
        Of an oscillating flat face: by how much its line passes the pivot, on the cam's side.
    mass : float [kg], inertia : float [kg*m^2]
        Of a translating, of an oscillating follower, with all that moves with it.
    spring : Spring or None
    load : float [N or N*m]
        A constant force, or moment, that presses the follower on the cam.
    friction : float
        Coefficient between cam and follower.
    material : Material or None
    """

    kind: Annotated[Literal["translating", "oscillating"], choice(*KINDS)] = "translating"
    contact: Annotated[Literal["knife", "roller", "flat"], choice(*CONTACTS)] = "roller"
    roller_radius: Size | None = None
    offset: Annotated[float, quantity("length")] = 0.0
    arm: Size | None = None
    pivot_distance: Size | None = None
    face_offset: Annotated[float, quantity("length")] = 0.0
    mass: Annotated[float, quantity("mass", not_negative)] | None = None
    inertia: Annotated[float, quantity("inertia", not_negative)] | None = None
    spring: Spring | None = None
    load: float = 0.0
    friction: Annotated[float, quantity("ratio", not_negative)] = 0.0
    material: Material | None = None

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        problems = super().key_problems(given)
        kind, contact = given.get("kind", "translating"), given.get("contact", "roller")
        if contact in CONTACTS:
            problems += _belongs(given, "roller_radius", contact == "roller", _("a roller"), needed=True)
        if kind not in KINDS:
            return problems
        swings = kind == "oscillating"
        straight, turning = _("a translating follower"), _("an oscillating follower")
        for key in ("offset", "mass"):
            problems += _belongs(given, key, not swings, straight)
        problems += _belongs(given, "inertia", swings, turning)
        problems += _belongs(given, "pivot_distance", swings, turning, needed=True)
        # A flat face is long enough wherever the cam touches it: it has no arm.
        flat, arm = swings and contact == "flat", _("an oscillating follower with a roller or a knife edge")
        problems += _belongs(given, "arm", swings and not flat, arm, needed=True)
        return problems + _belongs(given, "face_offset", flat, _("an oscillating flat face"))

    @field_validator("load", mode="plain")
    @classmethod
    def _load(cls, value: object) -> float:
        return si(value, "torque" if DRIVEN.get() == "angle" else "force")


def _belongs(
    given: Mapping[str, Any], key: str, right: bool, whose: str, *, needed: bool = False
) -> list[Problem]:
    """The problem of a key that is given for another follower, or missing for this one."""
    has = given.get(key) is not None
    if right:
        return [missing_key(key)] if needed and not has else []
    if not has or given[key] == 0:
        return []
    return [
        Problem(_("{key} is used with {whose} only").format(key=value_text(key), whose=whose), _("remove it"))
    ]


def read_ratio(value: object, kind: str) -> float:
    """A part of a whole: positive, at most 1."""
    ratio = positive(value, kind)
    if ratio > 1:
        raise Problem(_("{key} must be at most 1, got {value}").format(key=KEY, value=value_text(value)))
    return ratio


Ratio = Annotated[float, quantity("ratio", read_ratio)]


class FollowerBounds(DescriptionPart):
    """What is admissible: table [bounds].

    Attributes
    ----------
    pressure_angle : float [rad]
        Greatest one.
    return_pressure_angle : float [rad]
        Greatest one where the follower falls; that of the rise if left out.
    curvature_radius : float [m]
        Least radius of curvature of the profile where it is convex.
    roller_to_curvature, roller_to_radius : float, at most 1
        Greatest ratios of a roller's radius to the least radius of curvature of the path of its centre, and to the
        least distance of this path from the cam's centre.
    stress : float [Pa]
        Greatest contact stress.
    """

    pressure_angle: Steepness | None = None
    return_pressure_angle: Steepness | None = None
    curvature_radius: Size | None = None
    roller_to_curvature: Ratio | None = None
    roller_to_radius: Ratio | None = None
    stress: Stress | None = None


class Tool(DescriptionPart):
    """The milling cutter or grinding wheel that the cam is made with: `radius` [m]."""

    radius: Size


class FollowerStudy(DescriptionPart):
    """What is to be computed.

    Attributes
    ----------
    samples : int
        Over a turn, both ends included.
    instants : tuple of float [rad]
        Angles that are shown.
    chord_tolerance : float [m]
        By how much the chords between points for a machine may depart from the profile.
    show_undercut : bool
        Whether a profile that the follower cuts away is shown, instead of being refused.
    """

    samples: Annotated[int, PlainValidator(read_samples)] | None = None
    instants: Annotated[tuple[Angle, ...], bounded_list(reading.INSTANTS)] = ()
    chord_tolerance: Size = 1e-6
    show_undercut: Flag = False


# Segments of a follower's lift over a turn of its cam, as a file gives them.

MOST = 200
"""Segments of a turn."""
MOST_RATES = 8
"""Derivatives that may be given at an end."""

LEAST_ANGLE = 1e-6
"""Of a segment [rad]: a fifth of a second of arc."""
MOST_LIFT = 1e4
"""What a lift may reach [m or rad], between its points too."""

CLOSED = 1e-9
"""Segments whose angles miss a turn by no more [rad] are taken to fill it: so far angles are written out."""


def read_rates(value: object) -> tuple[float, ...]:
    """Derivatives of the lift by the cam's angle, of first and higher order, in SI."""
    return tuple(
        _rate(entry, DRIVEN.get(), order) for order, entry in enumerate(entries(value, MOST_RATES), 1)
    )


def _rate(value: object, kind: str, order: int) -> float:
    """One of them: a number, or a text such as "5 mm/rad^2"."""
    if not isinstance(value, str):
        return si(value, "ratio")
    try:
        # A second derivative times the square of an angle is a lift: units of every order are read by that.
        return si(value.strip() + order * "*rad", kind)
    except Problem:
        return plain_rate(value, f"{UNITS[kind]}/rad" + (f"^{order}" if order > 1 else ""))


def _read_angle(value: object) -> float:
    angle = positive(value, "angle")
    if angle < LEAST_ANGLE:
        what = _("{value} is outside the range that can be computed").format(value=value_text(value))
        raise Problem(what, _("stay above {least:g}").format(least=LEAST_ANGLE))
    return angle


def read_lift(value: object) -> str:
    """The formula of a lift, as text; empty where a curve gives it."""
    if value == "":
        return ""
    if not isinstance(value, str):
        raise Problem(
            _("{key} must be a formula in quotes, got {value}").format(key=KEY, value=value_text(value))
        )
    try:
        segment_formula(value)
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    return value


class LiftSegment(DescriptionPart):
    """A stretch of a turn, over which the follower rises, falls or dwells.

    Attributes
    ----------
    angle : float [rad], positive
        How far the cam turns meanwhile.
    share, time : float [1], [s]
        In place of the angle: its share of a turn, or how long the segment lasts.
    start : float [rad] or None
        "from" in a file: the angle at which it begins, where the one before has to end.
    to : float [m or rad]
        Lift at its end; a dwell has none.
    curve : str
        A curve by its name, "dwell", "polynomial" or "b-spline"; "formula" where there is a `lift`.
    lift : str
        The lift [m or rad] as a formula of `phi`, the angle [rad] from the segment's start; `beta` is the segment's
        angle, `s0` the lift at its start, `s1` = `to` that at its end, `h` = s1 - s0.
    at_start, at_end : tuple of float [m/rad or rad/rad, then by rad^2, ...]
        Of a polynomial or a B-spline: first, second, ... derivative of the lift there, as far as they are given.
    through : tuple of (angle [rad], lift [m or rad])
        Of these: lifts on the way, at angles from the segment's start.
    degree : int
        Of a B-spline.
    """

    angle: Annotated[float, PlainValidator(_read_angle)]
    # turned into the angle before a segment is read: no segment holds them
    share: Annotated[float, quantity("ratio", positive)] | None = None
    time: Annotated[float, quantity("time", positive)] | None = None
    start: Annotated[float | None, Field(alias="from")] = None
    to: float | None = None
    curve: Annotated[str, choice(*laws.LIFT_CURVES, other_names=laws.CURVE_SYNONYMS)] = laws.FORMULA
    lift: Annotated[str, PlainValidator(read_lift)] = ""
    at_start: Annotated[tuple[float, ...], PlainValidator(read_rates)] = ()
    at_end: Annotated[tuple[float, ...], PlainValidator(read_rates)] = ()
    through: tuple[tuple[float, float], ...] = ()
    degree: Annotated[int, PlainValidator(read_degree)] | None = None

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        wrong = super().key_problems(given) + problems_of_end(given)
        curve = given.get("curve")
        if curve is None and not given.get("lift"):
            wrong.append(missing_key("curve"))
        if curve == laws.FORMULA and not given.get("lift"):
            wrong.append(missing_key("lift"))
        if curve not in (None, laws.FORMULA) and given.get("lift"):
            what, repair = _("the lift is given by a curve and by a formula"), _("leave one of them out")
            wrong.append(Problem(what, repair))
        return wrong + foreign_keys(given, ("at_start", "at_end", "through"))

    @field_validator("start", mode="plain")
    @classmethod
    def _angle(cls, value: object) -> float | None:
        return None if value is None else si(value, "angle")

    @field_validator("to", mode="plain")
    @classmethod
    def _lift(cls, value: object) -> float | None:
        return None if value is None else _lift_of(value)

    @field_validator("through", mode="plain")
    @classmethod
    def _through(cls, value: object, info: ValidationInfo) -> tuple[tuple[float, float], ...]:
        return read_through(value, info, "angle", "[angle, lift]")

    @property
    def law(self) -> laws.LawSegment:
        """The segment of the law, over angles instead of times; raises InputError where it makes none."""
        degree = laws.DEGREE if self.degree is None else self.degree
        return laws.LawSegment(
            self.angle, self.to, self.curve, self.at_start, self.at_end, self.through, degree, self.lift
        )


def _lift_of(value: object) -> float:
    lift = si(value, DRIVEN.get())
    if lift < 0:
        what = _("the lift is measured from its lowest position and must not be negative, got {value}")
        raise Problem(
            what.format(value=value_text(value)), _("let the base circle be that of the lowest position")
        )
    if 0 < lift < reading.LEAST:
        what = _("{value} is outside the range that can be computed").format(value=value_text(value))
        raise Problem(what, _("stay above {least:g}").format(least=reading.LEAST))
    return lift


def lift_law(segments: Sequence[LiftSegment]) -> laws.SegmentedLaw:
    """The lift over the angle of the cam [rad], turn after turn; raises InputError where segments make no law."""
    parts = [segment.law for segment in segments]
    rest = math.tau - math.fsum(part.time for part in parts[:-1])
    if abs(rest - parts[-1].time) <= CLOSED:
        parts[-1] = replace(parts[-1], time=rest)
    return laws.SegmentedLaw(tuple(parts), repeat=True)


def segment_problems(segments: Sequence[LiftSegment]) -> list[Problem]:
    """What is wrong with segments as the lift of a turn: gaps, overlaps, a lift that does not return."""
    if not segments:
        return [Problem(_("no segments are given"), _("write [[segments]] that fill a turn"), ("segments",))]
    found = _start_problems(segments)
    end = math.fsum(segment.angle for segment in segments)
    if not found and end > math.tau + CLOSED:
        what = _("the segments overlap: together they take {angle:.9g} deg, a turn has 360 deg")
        repair = _("shorten one by {excess:.6g} deg").format(excess=math.degrees(end - math.tau))
        found.append(Problem(what.format(angle=math.degrees(end)), repair, ("segments",)))
    if not found and end < math.tau - CLOSED:
        what = _("the segments leave a gap: together they take {angle:.9g} deg, a turn has 360 deg")
        repair = _("add a dwell of {missing:.6g} deg").format(missing=math.degrees(math.tau - end))
        found.append(Problem(what.format(angle=math.degrees(end)), repair, ("segments",)))
    lifts = [segment.to for segment in segments if segment.to is not None]
    if lifts and lifts[-1] != 0:
        what = _("the lift does not return: a turn begins at 0 and ends at {lift:.9g} {unit}")
        told = what.format(lift=lifts[-1], unit=terminal_unit(UNITS[DRIVEN.get()]))
        found.append(Problem(told, _("let the last segment that moves go to 0"), ("segments",)))
    if not any(lifts) and not any(_swells(segment) for segment in segments):
        found.append(Problem(_("nothing moves: no segment lifts the follower"), at=("segments",)))
    return found or _lawless(segments)


def _swells(segment: LiftSegment) -> bool:
    """Whether a segment that ends where it began is asked to move on its way."""
    lifts = [lift for _angle, lift in segment.through]
    return any((*lifts, *segment.at_start, *segment.at_end, segment.lift))


def _lift_bound(pieces: Sequence[tuple[float, laws.Piece]]) -> float:
    """A bound of the lift's size: what the powers of each formula sum up to at its ends."""
    bounds, start = [], 0.0
    for end, piece in pieces:
        reach = max(abs(start - piece.origin), abs(end - piece.origin)) / piece.unit
        terms = (abs(c) * reach**k for k, c in enumerate(piece.powers, 1))
        bounds.append(abs(piece.value) + math.fsum(terms) + abs(piece.square))
        start = end
    return max(bounds)


def _start_problems(segments: Sequence[LiftSegment]) -> list[Problem]:
    """Segments that say they begin where the one before does not end."""
    found, end = [], 0.0
    for number, segment in enumerate(segments):
        if segment.start is not None and abs(segment.start - end) > CLOSED:
            what = _("it begins at {start:.9g} deg, but the one before ends at {end:.9g} deg: they overlap")
            if segment.start > end:
                what = _("it begins at {start:.9g} deg, but the one before ends at {end:.9g} deg: a gap")
            if number == 0:
                what = _("the first segment must begin at 0, not at {start:.9g} deg")
            told = what.format(start=math.degrees(segment.start), end=math.degrees(end))
            found.append(Problem(told, _("correct its angles, or add a dwell"), ("segments", number)))
        end += segment.angle
    return found


def _lawless(segments: Sequence[LiftSegment]) -> list[Problem]:
    """What formulas refuse: points out of order, numbers beyond reach, segments that are lost beside others."""
    found, before = [], 0.0
    for number, segment in enumerate(segments):
        try:
            _check_formulas(segment, before)
        except Problem as problem:
            found.append(Problem(problem.what, problem.repair, ("segments", number)))
        before = before if segment.to is None else segment.to
    if not found:
        try:
            lift_law(segments)
        except InputError as error:
            found.append(Problem(error.what, _("give it more of the turn"), ("segments",)))
    return found


def _check_formulas(segment: LiftSegment, before: float) -> None:
    """Raise the problem of a segment that has no formulas, or such as run away."""
    angles = (0.0, *(angle for angle, _lift in segment.through), segment.angle)
    if not all(one < other for one, other in pairwise(angles)):
        what = _("the angles of `through` must increase and lie inside the segment, counted from its start")
        raise Problem(what, _("correct them, or the segment's angle"))
    try:
        law = segment.law
        if segment.curve == laws.FORMULA:
            check_formula(law.text_piece(0.0, before))
            return
        reached = _lift_bound(law.pieces(0.0, before))
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    _check_reach(reached)


NODES = 721
"""Places at which a formula is looked at."""
SEAM = 1e-12
"""Share of the greatest lift by which a formula may miss the lift at an end: rounding."""


class _DivisorJets(JetFunctions):
    """Jets that keep the divisors of a formula, which must not pass through zero."""

    def __init__(self) -> None:
        super().__init__(SCALARS)
        self.divisors: list[float] = []

    def divisor(self, x: Any) -> Any:
        self.divisors.append(float(plain(x)))
        return x

    def tan(self, x: Any) -> Any:
        return self.sin(x) / self.divisor(self.cos(x))


def check_formula(piece: TextPiece) -> None:
    """Raise the problem of a formula without finite derivatives, beyond reach, or that misses the lift at an end."""
    lifts, before = [], list[bool]()
    for node in range(NODES):
        phi = piece.length * node / (NODES - 1)
        watching = _DivisorJets()
        try:
            found = piece.jet(watching, Jet.variable(piece.origin + phi, 2))
            numbers = [float(found.derivative(order)) for order in range(3)]
        except (ArithmeticError, ValueError):
            numbers = [math.nan]
        sides = [divisor > 0 for divisor in watching.divisors]
        passes = node > 0 and len(sides) == len(before) and sides != before
        if not all(map(math.isfinite, numbers)) or passes:
            what = _("its formula has no finite value with two derivatives at {angle:.6g} deg of the segment")
            raise Problem(
                what.format(angle=math.degrees(phi)), _("correct the formula, or the segment's angle")
            )
        before = sides
        lifts.append(numbers[0])
    _check_reach(max(map(abs, lifts)))
    scale = max(map(abs, lifts))
    unit = terminal_unit(UNITS[DRIVEN.get()])
    repair = _("correct the formula, or the lift where the segments meet")
    for what, given, found_lift in (
        (
            _("the lift jumps: its formula begins at {found:.9g} {unit}, not at {given:.9g} {unit}"),
            "s0",
            lifts[0],
        ),
        (
            _("the lift jumps: its formula ends at {found:.9g} {unit}, not at {given:.9g} {unit}"),
            "s1",
            lifts[-1],
        ),
    ):
        if abs(found_lift - piece.numbers[given]) > SEAM * scale:
            raise Problem(what.format(found=found_lift, given=piece.numbers[given], unit=unit), repair)


def _check_reach(reached: float) -> None:
    if not reached <= MOST_LIFT:
        what = _("the lift grows too large: with these conditions it may reach {lift:.3g} {unit}")
        repair = _("give smaller lifts and rates, or points that lie further apart")
        raise Problem(what.format(lift=reached, unit=terminal_unit(UNITS[DRIVEN.get()])), repair)


class PlateCam(DescriptionPart):
    """A turning plate cam and its follower, by the follower's lift.

    The arguments are those of a file (docs: cam followers), as parts or as plain dicts, texts with units included.
    All numbers it holds are SI.

    Attributes
    ----------
    title : str
    kind : "cam"
    display : Display
    body : CamBody
        "cam" in a file.
    follower : Follower
    segments : tuple of LiftSegment
        They fill a turn and bring the lift back to 0.
    bounds : FollowerBounds
    tool : Tool or None
    study : FollowerStudy
    report : CamReportWishes

    Raises
    ------
    InputError
        Anything that is not a description, with its place and the repair.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.example("valve-cam").follower.kind
    'translating'
    """

    title: Text = ""
    kind: Annotated[Literal["cam"], choice("cam")]
    display: Display = Display()
    body: Annotated[CamBody, Field(alias="cam")] = CamBody()
    follower: Follower
    segments: Annotated[tuple[LiftSegment, ...], bounded_list(MOST)]
    bounds: FollowerBounds = FollowerBounds()
    tool: Tool | None = None
    study: FollowerStudy = FollowerStudy()
    report: CamReportWishes = CamReportWishes()

    if TYPE_CHECKING:

        def __init__(self, **parts: Any) -> None: ...

    @model_validator(mode="wrap")
    @classmethod
    def _of_its_follower(cls, data: Any, handler: ModelWrapValidatorHandler[PlateCam]) -> PlateCam:
        token = DRIVEN.set("angle" if _is_oscillating(data) else "length")
        try:
            return handler(with_angles_of_segments(data) if isinstance(data, Mapping) else data)
        finally:
            DRIVEN.reset(token)

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        problems = [*segment_problems(self.segments), *self._ratios_without_roller()]
        if problems:
            raise Problems(problems)
        return self

    def _ratios_without_roller(self) -> list[Problem]:
        """Ratios of a roller's radius that are given for another follower."""
        if self.follower.contact == "roller":
            return []
        what, repair = _("{key} is used with {whose} only"), _("remove it")
        return [
            Problem(what.format(key=value_text(key), whose=_("a roller")), repair, ("bounds",))
            for key in ("roller_to_curvature", "roller_to_radius")
            if getattr(self.bounds, key) is not None
        ]

    @property
    def swings(self) -> bool:
        """Whether the follower is an oscillating one: its lift is an angle."""
        return self.follower.kind == "oscillating"

    @property
    def lift_law(self) -> SegmentedLaw:
        """Lift [m or rad] over the angle of the cam [rad], turn after turn."""
        return lift_law(self.segments)


def _is_oscillating(data: Any) -> bool:
    """Whether what is read says that its follower oscillates."""
    follower = data.get("follower") if isinstance(data, Mapping) else getattr(data, "follower", None)
    kind = follower.get("kind") if isinstance(follower, Mapping) else getattr(follower, "kind", None)
    return bool(kind == "oscillating")
