"""The description of a pair of gear wheels, in files and as tables."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeAlias

from pydantic import PlainValidator, model_validator

from centrode.geometry.involute import involute, pressure_angle_of
from centrode.locale import _
from centrode.model.cam import whole
from centrode.model.description_files import DescriptionFiles
from centrode.model.reading import (
    KEY,
    DescriptionPart,
    Problem,
    choice,
    likely,
    nearest,
    value_text,
)
from centrode.model.settings import Display, GearReportWishes
from centrode.model.values import (
    Flag,
    Text,
    angular_speed,
    not_negative,
    numbers,
    positive,
    quantity,
    si,
)

KIND = "gear pair"
RACK = "rack"
PURPOSES = ("no undercut", "equal sliding", "least sliding", "strength", "standard")
"""What shifts may be chosen for."""
STANDARD = "standard"
APPLICATIONS = ("power", "kinematic")
"""What pairs are for, as GOST 16532 tells them apart."""
FEWEST_TEETH, MOST_TEETH = 4, 1000
MOST_SHIFT = 5.0

Teeth: TypeAlias = tuple[int, int | Literal["rack"]]
Purpose: TypeAlias = Literal["no undercut", "equal sliding", "least sliding", "strength", "standard"]
Application: TypeAlias = Literal["power", "kinematic"]


def read_teeth(value: object) -> Teeth:
    """Numbers of teeth, of which the second may be "rack"."""
    form = _('[pinion, wheel] or [pinion, "rack"]')
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise Problem(_("expected {form}, got {value}").format(form=form, value=value_text(value)))
    first, second = value
    if second == RACK:
        return _tooth_number(first), "rack"
    return _tooth_number(first), _tooth_number(second)


def _tooth_number(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not FEWEST_TEETH <= value <= MOST_TEETH:
        what = _("a number of teeth is a whole number from {least} to {most}, got {value}")
        raise Problem(
            what.format(least=FEWEST_TEETH, most=MOST_TEETH, value=value_text(value)),
            likely(value, [RACK]) if isinstance(value, str) else "",
        )
    return value


def read_shifts(value: object) -> tuple[float, float] | Purpose:
    """Two shift coefficients, or what they are to be chosen for."""
    if isinstance(value, str):
        if value not in PURPOSES:
            what = _("{value} is no purpose of shifts").format(value=value_text(value))
            raise Problem(what, nearest(value, list(PURPOSES)))
        return value  # type: ignore[return-value]
    first, second = numbers(value, ("ratio", "ratio"), _("[x1, x2] or a purpose"))
    for number in (first, second):
        if not abs(number) <= MOST_SHIFT:
            what = _("a shift coefficient lies between -{most:g} and {most:g}, got {value:g}")
            raise Problem(what.format(most=MOST_SHIFT, value=number), _("it is in modules"))
    return first, second


def _read_rack_angle(value: object, kind: str) -> float:
    number = si(value, kind)
    if not math.radians(10) <= number <= math.radians(35):
        what = _("{key} must lie between 10 and 35 deg, got {value}").format(key=KEY, value=value_text(value))
        raise Problem(what, _("it is 20 deg in GOST 13755 and ISO 53"))
    return number


def _read_helix(value: object, kind: str) -> float:
    number = si(value, kind)
    if not 0 <= number <= math.radians(60):
        what = _("{key} must lie between 0 and 60 deg, got {value}").format(key=KEY, value=value_text(value))
        raise Problem(what, _("write 0 for spur teeth"))
    return number


def _coefficient(least: float, most: float) -> PlainValidator:
    def read(value: object) -> float:
        number = si(value, "ratio")
        if not least <= number <= most:
            what = _("{key} must lie between {least:g} and {most:g}, got {value}")
            raise Problem(
                what.format(key=KEY, least=least, most=most, value=value_text(value)), _("it is in modules")
            )
        return number

    return PlainValidator(read)


class Rack(DescriptionPart):
    """The reference rack in the normal section, by default that of GOST 13755 and ISO 53.

    Attributes
    ----------
    pressure_angle : alpha [rad]
    addendum : h_a*, in modules
    clearance : c*, in modules
    fillet : rho_f*, radius of the rounded edge of the generating rack, in modules; at most what the clearance holds
    """

    pressure_angle: Annotated[float, quantity("angle", _read_rack_angle)] = math.radians(20)
    addendum: Annotated[float, _coefficient(0.3, 2.0)] = 1.0
    clearance: Annotated[float, _coefficient(0.0, 1.0)] = 0.25
    fillet: Annotated[float, _coefficient(0.0, 1.5)] | None = None

    @property
    def fillet_radius(self) -> float:
        """rho_f*: 0.38 as standards have it, or what the clearance holds where that is less."""
        most = self.clearance / (1 - math.sin(self.pressure_angle))
        return min(0.38, most) if self.fillet is None else self.fillet

    @property
    def is_standard(self) -> bool:
        """Whether it is the rack of GOST 13755: 20 deg, h_a* 1, c* 0.25, rho_f* 0.38."""
        own = (self.pressure_angle, self.addendum, self.clearance)
        # The standard rounds its fillet: 0.37994 is what the clearance holds.
        same_fillet = math.isclose(self.fillet_radius, 0.38, abs_tol=1e-3)
        return same_fillet and all(map(math.isclose, own, (math.radians(20), 1.0, 0.25)))

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        most = self.clearance / (1 - math.sin(self.pressure_angle))
        if self.fillet is not None and self.fillet > most + 1e-3:
            what = _("a fillet of {fillet:g} modules does not fit into a clearance of {clearance:g} modules")
            repair = _("at most {most:.4g} does").format(most=most)
            raise Problem(what.format(fillet=self.fillet, clearance=self.clearance), repair, ("fillet",))
        # The tip of the generating rack ends where both flanks meet.
        reach = math.pi / 4 / math.tan(self.pressure_angle)
        if self.addendum + self.clearance >= reach:
            what = _("the teeth of the rack are pointed: addendum and clearance together exceed {most:.4g}")
            raise Problem(what.format(most=reach), _("reduce one of them"), ("addendum",))
        return self


class GearPair(DescriptionPart):
    """A pair of involute gear wheels, external, internal, or a wheel with a rack.

    The arguments are those of a file (docs: gears), texts with units included. All numbers it holds are SI.

    Attributes
    ----------
    title : str
    kind : "gear pair"
    display : Display
    module : m of the normal section [m]
    teeth : of pinion and wheel; the second may be "rack"
    internal : whether the second wheel has its teeth inside
    shifts : x_1 and x_2, or what they are chosen for ("no undercut", "equal sliding", "least sliding", "strength",
        "standard": as GOST 16532-70 recommends; its bounds of the numbers of teeth are those of textbooks and were not
        compared with the printed standard)
    application : "power" or "kinematic", with shifts = "standard" alone; "power" where it is not given
    centre_distance : [m]; the sum of the shifts follows from it
    helix_angle : beta [rad]
    rack : Rack
    width : of the rims [m]
    pin : diameter for the dimension over pins [m]; 1.7 modules by default
    speed : of the pinion [rad/s]
    moment : on the pinion [N m]
    samples : places along the line of action
    report : GearReportWishes

    Raises
    ------
    InputError
        Anything that is not a description, with its place and the repair.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.GearPair(kind="gear pair", module="3 mm", teeth=[12, 24], shifts=[0.6, 0.36]).teeth
    (12, 24)
    """

    title: Text = ""
    kind: Annotated[Literal["gear pair"], choice(KIND)]
    display: Display = Display()
    module: Annotated[float, quantity("length", positive)]
    teeth: Annotated[Teeth, PlainValidator(read_teeth)]
    internal: Flag = False
    shifts: Annotated[tuple[float, float] | Purpose, PlainValidator(read_shifts)] | None = None
    application: Annotated[Application, choice(*APPLICATIONS)] | None = None
    centre_distance: Annotated[float, quantity("length", positive)] | None = None
    helix_angle: Annotated[float, quantity("angle", _read_helix)] = 0.0
    rack: Rack = Rack()
    width: Annotated[float, quantity("length", positive)] | None = None
    pin: Annotated[float, quantity("length", positive)] | None = None
    speed: Annotated[float, PlainValidator(angular_speed)] | None = None
    moment: Annotated[float, quantity("torque", not_negative)] | None = None
    samples: Annotated[int, whole(2, 10_000)] = 101
    report: GearReportWishes = GearReportWishes()

    if TYPE_CHECKING:

        def __init__(self, **parts: Any) -> None: ...

    @property
    def turns(self) -> int:
        """1 where both wheels turn in opposite senses, -1 where the second has its teeth inside."""
        return -1 if self.internal else 1

    @property
    def mesh_ratio(self) -> float:
        """Turn of the wheel over that of the pinion, negative where they turn in opposite senses."""
        first, second = self.teeth
        assert isinstance(second, int)
        return -self.turns * first / second

    def working_mesh(self) -> tuple[float, float]:
        """Working pressure angle [rad] of the transverse section, and centre distance [m], of a pair that is no rack.

        Raises Problem where the numbers are missing: shifts that are chosen for a purpose without a centre distance.
        """
        first, second = self.teeth
        assert isinstance(second, int)
        teeth, slope = second + self.turns * first, math.tan(self.rack.pressure_angle)
        angle = math.atan(slope / math.cos(self.helix_angle))
        plain = self.module / math.cos(self.helix_angle) * teeth / 2
        if self.centre_distance is not None:
            cosine = plain * math.cos(angle) / self.centre_distance
            if cosine > 1:
                what = _("at its centre distance the flanks do not touch")
                raise Problem(what, _("enlarge it"), ("centre_distance",))
            return math.acos(cosine), self.centre_distance
        if not isinstance(self.shifts, tuple):
            what = _("the shifts of the pair are chosen for a purpose")
            raise Problem(
                what, _("give the numbers that centrode gears prints, or centre_distance"), ("shifts",)
            )
        total = self.shifts[1] + self.turns * self.shifts[0]
        working = pressure_angle_of(involute(angle) + 2 * total * slope / teeth)
        if math.isnan(working):
            raise Problem(_("the wheels cannot mesh"), _("enlarge the sum of the shifts"), ("shifts",))
        return working, plain * math.cos(angle) / math.cos(working)

    @property
    def purpose(self) -> Purpose | None:
        """What the shifts are chosen for; None where numbers are given."""
        if isinstance(self.shifts, str):
            return self.shifts
        return "no undercut" if self.shifts is None else None

    @property
    def intended_application(self) -> Application:
        """What the pair is for: power, where it does not say so."""
        return self.application or "power"

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        first, second = self.teeth
        if second == RACK:
            if self.internal:
                raise Problem(_("a rack has no teeth inside"), _("remove internal"), ("internal",))
            if self.centre_distance is not None:
                raise Problem(_("a rack has no centre"), _("give shifts"), ("centre_distance",))
        elif self.internal and isinstance(second, int) and second - first < 2:
            what = _("the internal wheel has to have at least two teeth more than the pinion")
            raise Problem(what, _("enlarge the second number"), ("teeth",))
        if self.centre_distance is not None and isinstance(self.shifts, tuple):
            what = _("shifts and centre distance are both given: one follows from the other")
            raise Problem(
                what, _("remove one of them, or give a purpose of the shifts"), ("centre_distance",)
            )
        if self.application is not None and self.shifts != STANDARD:
            what = _("the application matters to recommended shifts alone")
            raise Problem(what, _('remove it, or give shifts = "standard"'), ("application",))
        if self.shifts == STANDARD:
            self._check_recommendation()
        return self

    def _check_recommendation(self) -> None:
        """Refuse pairs for which GOST 16532-70 recommends no shifts, whatever their numbers of teeth."""
        what = _("GOST 16532 recommends shifts of spur external pairs alone")
        repair = _("give [x1, x2], or another purpose")
        first, second = self.teeth
        if second == RACK or self.internal or self.helix_angle:
            raise Problem(what, repair, ("shifts",))
        if not self.rack.is_standard:
            what = _("GOST 16532 recommends shifts for the reference rack of GOST 13755 alone")
            raise Problem(what, _("remove rack, or give [x1, x2]"), ("shifts",))
        if isinstance(second, int) and first > second:
            what = _("GOST 16532 recommends shifts of a pinion that is no greater than the wheel")
            raise Problem(what, _("write the smaller number of teeth first"), ("teeth",))


GEAR_PAIRS = DescriptionFiles(KIND, lambda _tables, _where: GearPair)
"""Pairs of gears in files."""
