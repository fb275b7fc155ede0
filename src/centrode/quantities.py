"""The vocabulary of results: what each variable is called, its symbol, its unit, and how units are shown.

Every table, plot and report reads it. Inside the package all numbers are SI and radians; a unit is a short
text like "m", "rad/s", "m/rad^2", and "1" where there is none. Files of data keep these texts in every
language; what people read has them from `spelled_unit`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from centrode.errors import InputError, Status
from centrode.locale import LANGUAGES, _, chosen_language, mark

# How units are shown: lengths and angles as the description asks, powers as books write them.

LENGTHS: Mapping[str, float] = {
    "m": 1.0,
    "mm": 1e3,
    "cm": 1e2,
    "dm": 1e1,
    "km": 1e-3,
    "um": 1e6,
    "in": 1 / 0.0254,
    "ft": 1 / 0.3048,
}
"""How many of each length unit make one metre."""

ANGLES: Mapping[str, float] = {"rad": 1.0, "deg": 180 / math.pi, "turn": 1 / (2 * math.pi)}
"""How many of each angle unit make one radian."""

ANGULAR_VELOCITIES: Mapping[str, float] = {f"{angle}/s": factor for angle, factor in ANGLES.items()} | {
    "rpm": 30 / math.pi
}
"""How many of each unit of angular velocity make one radian per second."""

ANGULAR_ACCELERATIONS: Mapping[str, float] = {f"{angle}/s^2": factor for angle, factor in ANGLES.items()}
"""How many of each unit of angular acceleration make one radian per second squared."""


def display_unit(unit: str, length: str = "m", angle: str = "rad") -> tuple[float, str]:
    """Factor and label that turn numbers in an SI unit into the units they are shown in.

    Parameters
    ----------
    unit : str
        SI unit made of m, rad and s; any other unit is shown as it is.
    length, angle : str
        A key of LENGTHS and a key of ANGLES; InputError for another.

    Returns
    -------
    factor : float
        Shown number = factor * SI number; relative error below 4 eps.
    label : str
        `display_unit("m/s^2", length="mm")` is `(1000.0, "mm/s^2")`.
    """
    if length not in LENGTHS:
        raise _unknown_unit("display.length", _("{unit!r} is not a unit of length"), length, LENGTHS)
    if angle not in ANGLES:
        raise _unknown_unit("display.angle", _("{unit!r} is not a unit of angle"), angle, ANGLES)
    powers = powers_of(unit)
    if not powers.keys() <= {"m", "rad", "s"}:
        return 1.0, unit
    factor = LENGTHS[length] ** powers.get("m", 0) * ANGLES[angle] ** powers.get("rad", 0)
    renamed = {"m": length, "rad": angle}
    return factor, unit_text({renamed.get(base, base): power for base, power in powers.items()})


def typeset_unit(unit: str) -> str:
    """The unit with raised powers, its names as they are typed: "kg m²" for "kg m^2"."""
    return re.sub(r"\^(\d+)", lambda found: found.group(1).translate(RAISED), unit)


def _unknown_unit(where: str, what: str, unit: str, table: Mapping[str, float]) -> InputError:
    return InputError(where, what.format(unit=unit), _("use one of {known}").format(known=", ".join(table)))


def powers_of(unit: str) -> dict[str, int]:
    """{"m": 1, "s": -2} of "m/s^2"; factors are parted by spaces, each division has one factor."""
    powers: dict[str, int] = {}
    for sign, base, power in re.findall(r"(/?)\s*([^\s/^]+)(?:\^(\d+))?", unit):
        if base != "1":
            powers[base] = powers.get(base, 0) + (-1 if sign else 1) * int(power or 1)
    return powers


def unit_text(powers: Mapping[str, int]) -> str:
    """The unit of powers: "m/s^2" of {"m": 1, "s": -2}."""

    def written(base: str, power: int) -> str:
        return base if power == 1 else f"{base}^{power}"

    above = [written(base, power) for base, power in powers.items() if power > 0]
    below = ["/" + written(base, -power) for base, power in powers.items() if power < 0]
    return (" ".join(above) or "1") + "".join(below)


# How units are spelled for readers of each language, the one place that says so.

UNIT_SYMBOLS: Mapping[str, tuple[str, str, str]] = {
    "m": ("m", "м", "м"),
    "mm": ("mm", "мм", "мм"),
    "cm": ("cm", "см", "см"),
    "dm": ("dm", "дм", "дм"),
    "km": ("km", "км", "км"),
    "um": ("µm", "мкм", "мкм"),
    "in": ("in", "дюйм", "дюйм"),
    "ft": ("ft", "фут", "фут"),
    "rad": ("rad", "рад", "рад"),
    "deg": ("°", "°", "°"),
    "turn": ("turn", "об", "об"),
    "s": ("s", "с", "с"),
    "Hz": ("Hz", "Гц", "Гц"),
    "rpm": ("rpm", "об/мин", "об/хв"),
    "kg": ("kg", "кг", "кг"),
    "N": ("N", "Н", "Н"),
    "J": ("J", "Дж", "Дж"),
    "W": ("W", "Вт", "Вт"),
    "Pa": ("Pa", "Па", "Па"),
    "MPa": ("MPa", "МПа", "МПа"),
    "GPa": ("GPa", "ГПа", "ГПа"),
    "°": ("°", "°", "°"),
    "%": ("%", "%", "%"),
}
"""A unit without powers -> its symbol in the languages, in the order of LANGUAGES."""
DEGREES = "°"
RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def spelled_unit(unit: str) -> str:
    """A unit as readers of the chosen language print it, in documents, figures, tables and sentences.

    Parameters
    ----------
    unit : str
        Made of the keys of UNIT_SYMBOLS; another symbol stays as it is.

    Returns
    -------
    str
        "N·m" for "N m", "кг·м²/рад" for "kg m^2/rad", "1/(m·rad)" for "1/m/rad", nothing for a plain number.
    """
    place = LANGUAGES.index(chosen_language())
    return _composed_unit(unit, {symbol: names[place] for symbol, names in UNIT_SYMBOLS.items()})


def terminal_unit(unit: str) -> str:
    """`spelled_unit`, but in English degrees by their typed name: what is printed as "30 deg" can be typed again."""
    if chosen_language() != "en":
        return spelled_unit(unit)
    return _composed_unit(unit, {symbol: names[0] for symbol, names in UNIT_SYMBOLS.items()} | {"deg": "deg"})


def with_unit(digits: str, label: str, gap: str = " ") -> str:
    """A number with its spelled unit behind a gap; the sign of degrees alone stands close: "5 мм", "30°", "30 °/с"."""
    return f"{digits}{'' if label == DEGREES else gap}{label}" if label else digits


def _composed_unit(unit: str, names: Mapping[str, str]) -> str:
    # descriptions type factors with a star, "N*m"
    powers = {base: power for base, power in powers_of(unit.replace("*", " ")).items() if power}

    def product(bases: Iterable[str]) -> str:
        return "·".join(
            names.get(base, base) + (str(abs(power)).translate(RAISED) if abs(power) > 1 else "")
            for base, power in ((base, powers[base]) for base in bases)
        )

    above = product(base for base, power in powers.items() if power > 0)
    below = [base for base, power in powers.items() if power < 0]
    if not below:
        return above
    return f"{above or '1'}/({product(below)})" if len(below) > 1 else f"{above or '1'}/{product(below)}"


# One variable of a result, with its symbol and unit, and the words for statuses.

STATUS_WORDS: Mapping[Status, str] = {
    Status.OK: mark("ok"),
    Status.OPEN: mark("open"),
    Status.CUT_OFF: mark("cut off"),
    Status.SINGULAR: mark("singular"),
    Status.UNCONVERGED: mark("unconverged"),
    Status.SELF_LOCKING: mark("self-locking"),
}


@dataclass(frozen=True)
class Quantity:
    """One variable of a result.

    Attributes
    ----------
    name : str
        Name of the variable, ASCII.
    symbol : str
        As formulas and plots write it.
    unit : str
        SI unit where the drive is an angle.
    long_name : str
        What it is, in English; `title` says it in the chosen language.
    by_drive : int
        How many times it is divided by the drive's unit: 1 and 2 for kinematic coefficients, -1 for the
        drive's own value, 0 for what does not depend on the kind of drive.
    """

    name: str
    symbol: str
    unit: str
    long_name: str
    by_drive: int = 0

    @property
    def title(self) -> str:
        """What it is, in the chosen language."""
        return _(self.long_name)

    def for_drive(self, drive_unit: str) -> Quantity:
        """The same quantity where the drive's value is in `drive_unit`: "rad" (an angle) or "m"."""
        powers = powers_of(self.unit)
        powers["rad"] = powers.get("rad", 0) + self.by_drive
        powers[drive_unit] = powers.get(drive_unit, 0) - self.by_drive
        if drive_unit != "rad" and powers.keys() & {"kg", "N"}:
            powers.pop("rad", None)  # moments and inertias of an angle are written without their radians
        return replace(self, unit=unit_text(powers))

    def by_drives(self, drive_units: Sequence[str]) -> Quantity:
        """The same quantity, a kinematic coefficient, by one or two drives with values in these units."""
        powers = powers_of(self.unit)
        powers["rad"] = powers.get("rad", 0) + self.by_drive
        for unit in drive_units:
            powers[unit] = powers.get(unit, 0) - 1
        return replace(self, unit=unit_text(powers))

    def on_sphere(self) -> Quantity:
        """The same quantity on the unit sphere, where displacements along guides are arcs and places plain numbers."""
        powers = powers_of(self.unit)
        length = powers.pop("m", 0)
        if self.name.startswith("slide") or self.name in ("fixed_arc", "moving_arc"):
            powers = {"rad": length + powers.pop("rad", 0), **powers}
        return replace(self, unit=unit_text({base: power for base, power in powers.items() if power}))

    def label(self, length: str = "m", angle: str = "rad") -> str:
        """Title, symbol and the unit it is shown in, for the axis of a plot: "angular velocity ω, deg/s"."""
        shown = display_unit(self.unit, length, angle)[1]
        name = f"{self.title} {self.symbol}".rstrip()
        return name if shown == "1" else f"{name}, {spelled_unit(shown)}"


def status_word(status: int) -> str:
    """The word for a status in the chosen language."""
    return _(STATUS_WORDS[Status(status)])


# Variables of motions: places, speeds, centres, centrodes, statuses, events.

MOTIONS = (
    Quantity("time", "t", "s", mark("time")),
    Quantity("drive_value", "q", "rad", mark("value of the drive"), by_drive=-1),
    Quantity("position", "r", "m", mark("position")),
    Quantity("velocity", "v", "m/s", mark("velocity")),
    Quantity("acceleration", "a", "m/s^2", mark("acceleration")),
    Quantity("angle", "φ", "rad", mark("angle")),
    Quantity("angular_velocity", "ω", "rad/s", mark("angular velocity")),
    Quantity("angular_acceleration", "ε", "rad/s^2", mark("angular acceleration")),
    Quantity("joint_angle", "θ", "rad", mark("angle from the reference arc")),
    Quantity("joint_velocity", "ω_θ", "rad/s", mark("angular velocity from the reference arc")),
    Quantity("joint_acceleration", "ε_θ", "rad/s^2", mark("angular acceleration from the reference arc")),
    Quantity("hinge_angle", "δ", "rad", mark("angle between the links at a hinge")),
    Quantity("hinge_velocity", "ω_δ", "rad/s", mark("relative angular velocity at a hinge")),
    Quantity("hinge_acceleration", "ε_δ", "rad/s^2", mark("relative angular acceleration at a hinge")),
    Quantity("polar_angle", "θ", "rad", mark("polar angle of the point")),
    Quantity("azimuth", "φ", "rad", mark("azimuth of the point")),
    Quantity("slide", "s", "m", mark("displacement along the guide")),
    Quantity("slide_velocity", "v_s", "m/s", mark("velocity along the guide")),
    Quantity("slide_acceleration", "a_s", "m/s^2", mark("acceleration along the guide")),
    Quantity("contact", "P", "m", mark("contact point of a rolling wheel")),
    Quantity("centre", "P", "m", mark("instant centre")),
    Quantity("centre_direction", "", "1", mark("direction of an instant centre at infinity")),
    Quantity("centre_case", "", "1", mark("how an instant centre is located")),
    Quantity("relative_speed", "ω", "rad/s", mark("relative angular velocity")),
    Quantity("fixed_centrode", "P", "m", mark("fixed centrode")),
    Quantity("moving_centrode", "p", "m", mark("moving centrode")),
    Quantity("fixed_arc", "s_P", "m", mark("arc of the fixed centrode")),
    Quantity("moving_arc", "s_p", "m", mark("arc of the moving centrode")),
    Quantity("centrode_piece", "", "1", mark("number of the piece of a centrode")),
    Quantity("pole", "P", "m", mark("pole")),
    Quantity("inflection_pole", "W", "m", mark("inflection pole")),
    Quantity("inflection_diameter", "d", "m", mark("diameter of the inflection circle")),
    Quantity("pole_tangent", "τ", "rad", mark("angle of the pole tangent")),
    Quantity("ball_point", "U", "m", mark("Ball's point")),
    Quantity("stationary_cubic", "", "1/m", mark("coefficients of the cubic of stationary curvature")),
    Quantity("path_curvature", "k", "1/m", mark("curvature of the path")),
    Quantity("path_curvature_slope", "k′", "1/m^2", mark("slope of the curvature of the path along its arc")),
    Quantity("curvature_centre", "K", "m", mark("centre of curvature of the path")),
    Quantity("velocity_coefficient", "r′", "m/rad", mark("velocity coefficient"), by_drive=1),
    Quantity("acceleration_coefficient", "r″", "m/rad^2", mark("acceleration coefficient"), by_drive=2),
    Quantity("angular_velocity_coefficient", "φ′", "1", mark("angular velocity coefficient"), by_drive=1),
    Quantity(
        "angular_acceleration_coefficient",
        "φ″",
        "1/rad",
        mark("angular acceleration coefficient"),
        by_drive=2,
    ),
    Quantity(
        "joint_velocity_coefficient", "θ′", "1", mark("velocity coefficient of the joint angle"), by_drive=1
    ),
    Quantity(
        "joint_acceleration_coefficient",
        "θ″",
        "1/rad",
        mark("acceleration coefficient of the joint angle"),
        by_drive=2,
    ),
    Quantity(
        "slide_velocity_coefficient", "s′", "m/rad", mark("velocity coefficient along the guide"), by_drive=1
    ),
    Quantity(
        "slide_acceleration_coefficient",
        "s″",
        "m/rad^2",
        mark("acceleration coefficient along the guide"),
        by_drive=2,
    ),
    Quantity(
        "drive_rate", "q̇", "rad/s", mark("speed of the drive at which loads are evaluated"), by_drive=-1
    ),
    Quantity("transmission_angle", "μ", "rad", mark("transmission angle")),
    Quantity("least_transmission_angle", "μ_min", "rad", mark("least transmission angle")),
    Quantity("greatest_transmission_angle", "μ_max", "rad", mark("greatest transmission angle")),
    Quantity("pressure_angle", "α", "rad", mark("pressure angle")),
    Quantity("status", "", "1", mark("status of the sample")),
    Quantity("residual", "", "1", mark("closure residual over the greatest length")),
    Quantity("drift", "", "1", mark("drift of the constraint over the greatest length")),
    Quantity("angle_difference", "Δφ", "rad", mark("integrated angle minus that in closed form")),
    Quantity(
        "position_difference", "Δr", "m", mark("distance of the integrated position from that in closed form")
    ),
    Quantity("event_value", "q", "rad", mark("value of the drive at the event"), by_drive=-1),
    Quantity("event_kind", "", "1", mark("kind of the event")),
    Quantity("event_group", "", "1", mark("group of the event")),
)


# Variables of what moves machines and what they bear: inertia, loads, reactions, balance, friction, energies.

FORCES = (
    Quantity("reduced_inertia", "J", "kg m^2", mark("reduced moment of inertia"), by_drive=2),
    Quantity("reduced_inertia_part", "J", "kg m^2", mark("reduced moment of inertia of a link"), by_drive=2),
    Quantity(
        "reduced_inertia_slope",
        "J′",
        "kg m^2/rad",
        mark("derivative of the reduced moment of inertia"),
        by_drive=3,
    ),
    Quantity(
        "reduced_inertia_slope_part",
        "J′",
        "kg m^2/rad",
        mark("derivative of the reduced moment of inertia of a link"),
        by_drive=3,
    ),
    Quantity("reduced_moment", "M", "N m", mark("reduced moment"), by_drive=1),
    Quantity("reduced_moment_part", "M", "N m", mark("reduced moment of a load"), by_drive=1),
    Quantity("jumps", "q", "rad", mark("value of the drive where a load jumps"), by_drive=-1),
    Quantity("inertia_matrix", "M", "kg m^2", mark("inertia matrix"), by_drive=2),
    Quantity("inertia_matrix_part", "M", "kg m^2", mark("inertia matrix of a link"), by_drive=2),
    Quantity("christoffel", "Γ", "kg m^2", mark("Christoffel term"), by_drive=3),
    Quantity("generalised_force", "Q", "N m", mark("generalised force"), by_drive=1),
    Quantity("generalised_force_part", "Q", "N m", mark("generalised force of a load"), by_drive=1),
    Quantity("joint_force", "R", "N", mark("force of the pin on the link")),
    Quantity("joint_moment", "M_j", "N m", mark("moment of the hinge about the centre of the sphere")),
    Quantity("centre_force", "R_c", "N", mark("force of the centre of the sphere")),
    Quantity("guide_force", "R", "N", mark("force of the guide on its point or slider")),
    Quantity("guide_normal", "R_n", "N", mark("normal force of the guide")),
    Quantity("guide_moment", "M_g", "N m", mark("moment of the guide on its slider")),
    Quantity("gear_moment", "M_z", "N m", mark("moment of the mesh")),
    Quantity("tooth_force", "F_t", "N", mark("tangential force on the second wheel")),
    Quantity("tooth_radial_force", "F_r", "N", mark("radial force on the second wheel")),
    Quantity("rolling_force", "R", "N", mark("force of the track on the wheel")),
    Quantity("rolling_normal", "R_n", "N", mark("normal force of the track")),
    Quantity("rolling_tangential", "R_t", "N", mark("tangential force of the track")),
    Quantity("balancing", "M_b", "N m", mark("balancing moment or force of the drive"), by_drive=1),
    Quantity("inertia_force", "F_i", "N", mark("inertia force of a link")),
    Quantity("inertia_moment", "M_i", "N m", mark("inertia moment of a link")),
    Quantity("frame_force", "R_0", "N", mark("force on the frame")),
    Quantity("frame_moment", "M_0", "N m", mark("moment on the frame about the origin")),
    Quantity("shaking_force", "F", "N", mark("shaking force")),
    Quantity("shaking_force_size", "F", "N", mark("magnitude of the shaking force")),
    Quantity("shaking_moment", "M", "N m", mark("shaking moment")),
    Quantity(
        "inertia_on_drive", "M_i", "N m", mark("moment of the drive caused by inertia forces"), by_drive=1
    ),
    Quantity("order", "k", "1", mark("order of the harmonic")),
    Quantity("force_harmonic_cosine", "", "N", mark("cosine coefficient of the shaking force")),
    Quantity("force_harmonic_sine", "", "N", mark("sine coefficient of the shaking force")),
    Quantity("force_harmonic_amplitude", "", "N", mark("amplitude of a harmonic of the shaking force")),
    Quantity("force_harmonic_phase", "", "rad", mark("phase of a harmonic of the shaking force")),
    Quantity("force_harmonic_greatest", "F_k", "N", mark("greatest force of a harmonic")),
    Quantity("moment_harmonic_cosine", "", "N m", mark("cosine coefficient of the shaking moment")),
    Quantity("moment_harmonic_sine", "", "N m", mark("sine coefficient of the shaking moment")),
    Quantity(
        "moment_harmonic_amplitude", "M_k", "N m", mark("amplitude of a harmonic of the shaking moment")
    ),
    Quantity("moment_harmonic_phase", "", "rad", mark("phase of a harmonic of the shaking moment")),
    Quantity("friction_moment", "M_f", "N m", mark("moment of friction on the link")),
    Quantity("friction_force", "F_f", "N", mark("force of friction along the guide")),
    Quantity("friction_power", "P_f", "W", mark("power lost to friction")),
    Quantity("friction_work", "A_f", "J", mark("work lost to friction")),
    Quantity("friction_turns", "", "1", mark("whether friction changes its sense at the sample")),
    Quantity("efficiency", "η", "1", mark("efficiency")),
    Quantity("self_locking", "", "1", mark("whether friction holds the mechanism")),
    Quantity("reaction_status", "", "1", mark("status of the reactions")),
    Quantity("reaction_loss", "", "1", mark("relative error of the reactions due to rounding")),
    Quantity("bearing_load", "R", "N", mark("load of the bearing, of the journal on the bush")),
    Quantity("load_on_journal", "R", "N", mark("load on the journal in its own axes")),
    Quantity("load_on_bush", "R", "N", mark("load on the bush in its own axes")),
    Quantity("relative_turning", "φ", "rad", mark("angle of the journal in the bush")),
    Quantity("load_path", "", "N", mark("integral of the load over the relative rotation")),
    Quantity("sector", "ψ", "rad", mark("middle of a sector of the surface")),
    Quantity("wear", "w", "1", mark("share of the wear of the surface")),
    Quantity("determined", "", "1", mark("whether the constraints determine the force")),
    Quantity("turned", "φ", "rad", mark("angle turned in the cycle"), by_drive=-1),
    Quantity(
        "moment_of_loads", "M_c", "N m", mark("moment of loads and weights, reduced to the drive"), by_drive=1
    ),
    Quantity("driving_moment", "M_d", "N m", mark("driving moment"), by_drive=1),
    Quantity("moment_of_links", "M_b", "N m", mark("balancing moment of the links"), by_drive=1),
    Quantity(
        "inertia_moment_of_group",
        "M_Φ",
        "N m",
        mark("inertia moment of the masses that turn with the drive"),
        by_drive=1,
    ),
    Quantity("work_of_loads", "A_c", "J", mark("work of loads and weights")),
    Quantity("work_of_drive", "A_d", "J", mark("work of the drive")),
    Quantity("work", "A", "J", mark("work of drive and loads")),
    Quantity("inertia_of_links", "J_II", "kg m^2", mark("inertia of the links, reduced to the drive")),
    Quantity("inertia_slope_of_links", "J_II′", "kg m^2/rad", mark("derivative of the inertia of the links")),
    Quantity("energy_of_links", "T_II", "J", mark("energy of the links at the mean speed")),
    Quantity("energy_change", "ΔT_I", "J", mark("change of energy of the masses that turn with the drive")),
    Quantity("drive_speed", "ω", "rad/s", mark("speed of the drive"), by_drive=-1),
    Quantity("drive_acceleration", "ε", "rad/s^2", mark("angular acceleration of the drive"), by_drive=-1),
    Quantity("drive_speed_first_order", "ω_1", "rad/s", mark("speed of the drive to first order")),
    Quantity(
        "drive_acceleration_first_order",
        "ε_1",
        "rad/s^2",
        mark("angular acceleration of the drive to first order"),
    ),
    Quantity("inertia", "J", "kg m^2", mark("reduced moment of inertia of all moving masses"), by_drive=2),
    Quantity("moment_of_friction", "M_f", "N m", mark("moment of friction and dampers"), by_drive=1),
    Quantity("power_of_drive", "P_d", "W", mark("power of the drive")),
    Quantity("power_of_loads", "P_c", "W", mark("power of loads, weights and friction")),
    Quantity("work_of_friction", "A_f", "J", mark("work of friction and dampers")),
    Quantity("work_of_other_loads", "A_o", "J", mark("work of the other loads")),
    Quantity("kinetic_energy", "T", "J", mark("kinetic energy")),
    Quantity("potential_energy", "V", "J", mark("potential energy of weights and springs")),
    Quantity("energy_residual", "ΔE", "J", mark("residual of the energy balance")),
    Quantity("generalised_coordinate", "q", "rad", mark("generalised coordinate")),
    Quantity("generalised_velocity", "q̇", "rad/s", mark("generalised velocity")),
    Quantity("generalised_acceleration", "q̈", "rad/s^2", mark("generalised acceleration")),
    Quantity("work_part", "A", "J", mark("work of a load or of a drive")),
    Quantity(
        "keeping_moment", "M_k", "N m", mark("moment or force that keeps the law of the drive"), by_drive=1
    ),
    Quantity("velocity_residual", "", "1/s", mark("residual of the constraints in velocities")),
    Quantity("occasion_time", "t", "s", mark("time of an occasion")),
    Quantity("occasion_value", "q", "rad", mark("value of the drive at an occasion"), by_drive=-1),
    Quantity("occasion_kind", "", "1", mark("kind of an occasion")),
    Quantity("stability", "", "1", mark("stability of an equilibrium")),
    Quantity("growth_rate", "σ", "1/s", mark("real part of an eigenvalue: how fast a departure grows")),
    Quantity(
        "damped_frequency", "ω_d", "rad/s", mark("imaginary part of an eigenvalue: frequency with damping")
    ),
    Quantity("natural_frequency", "ω_0", "rad/s", mark("natural angular frequency of a mode")),
    Quantity("undamped_frequency", "ω_u", "rad/s", mark("natural angular frequency without damping")),
    Quantity("damping_ratio", "ζ", "1", mark("damping ratio of a mode")),
    Quantity("mode_amplitude", "a", "1", mark("amplitude of a coordinate in a mode")),
    Quantity("mode_phase", "ψ", "rad", mark("phase of a coordinate in a mode")),
    Quantity("holding_moment", "M_h", "N m", mark("moment or force that holds the drive"), by_drive=1),
    Quantity("friction_reach", "Δq", "rad", mark("departure up to which dry friction holds, linearised")),
    Quantity("friction_band", "q", "rad", mark("ends of the interval in which dry friction holds")),
    Quantity("friction_holds_everywhere", "", "1", mark("whether dry friction holds in every position")),
    Quantity("friction_share", "", "1", mark("share of the friction that keeps the initial position")),
    Quantity(
        "friction_feeds_itself", "", "1", mark("whether friction that feeds itself may slip there as well")
    ),
    Quantity("branch", "", "1", mark("number of a branch of equilibria")),
    Quantity("branch_value", "p", "1", mark("number that is varied along a branch of equilibria")),
    Quantity("branch_coordinate", "q", "rad", mark("generalised coordinate along a branch of equilibria")),
    Quantity("branch_stability", "", "1", mark("stability along a branch of equilibria")),
    Quantity("coordinate_gradient", "∂q/∂p", "1", mark("derivative of a coordinate by a number")),
    Quantity("speed_gradient", "∂q̇/∂p", "1", mark("derivative of the speed of a coordinate by a number")),
    Quantity("position_gradient", "∂r/∂p", "1", mark("derivative of a position by a number")),
    Quantity("point_speed_gradient", "∂v/∂p", "1", mark("derivative of the velocity of a point by a number")),
    Quantity("occasion_position", "r", "m", mark("position of a point at an event")),
    Quantity("occasion_point_speed", "v", "m/s", mark("velocity of a point at an event, before it")),
    Quantity(
        "occasion_time_gradient", "∂t/∂p", "1", mark("derivative of the instant of an event by a number")
    ),
    Quantity(
        "occasion_position_gradient", "∂r/∂p", "1", mark("derivative of a position at an event by a number")
    ),
    Quantity(
        "occasion_point_speed_gradient",
        "∂v/∂p",
        "1",
        mark("derivative of a velocity at an event, before it, by a number"),
    ),
    Quantity("critical_value", "p", "1", mark("critical value of the number that is varied")),
    Quantity("critical_kind", "", "1", mark("kind of a critical value")),
    Quantity("critical_coordinate", "q", "rad", mark("generalised coordinate at a critical value")),
    Quantity(
        "critical_frequency", "ω", "rad/s", mark("frequency of oscillations that begin at a critical value")
    ),
    Quantity("occasion_part", "", "1", mark("part that an occasion belongs to")),
    Quantity("occasion_impulse", "S", "N s", mark("impulse of an impact")),
    Quantity("occasion_loss", "ΔT", "J", mark("energy lost by an impact")),
    Quantity(
        "restraint_force", "R", "N", mark("force of a stop, a clamp or dry friction along its coordinate")
    ),
    Quantity("controller_output", "u", "N m", mark("output of a controller")),
    Quantity("contact_mode", "", "1", mark("whether a contact is closed, sticks or holds")),
)


# Variables of cams and walking wheels: the roller's path, profiles, contact.

CAMS = (
    Quantity("profile", "r", "m", mark("profile of the cam")),
    Quantity("profile_radius", "r", "m", mark("polar radius of the profile")),
    Quantity("profile_angle", "α", "rad", mark("polar angle of the profile")),
    Quantity("profile_bend", "R", "m", mark("radius of curvature of the profile")),
    Quantity("profile_normal", "n", "1", mark("normal of the profile")),
    Quantity("face_place", "q", "m", mark("position of the contact along the flat face")),
    Quantity("cutter_centre", "C", "m", mark("centre of the cutter")),
    Quantity("curve_point", "r", "m", mark("point of a curve")),
    Quantity("curve_normal", "n", "1", mark("normal of a curve")),
    Quantity("groove", "r", "m", mark("outer wall of the groove")),
    Quantity("shoe_profile", "r", "m", mark("profile of the shoe")),
    Quantity("shoe_radius", "r", "m", mark("polar radius of the shoe")),
    Quantity("shoe_angle", "α", "rad", mark("polar angle of the shoe")),
    Quantity("shoe_bend", "R", "m", mark("radius of curvature of the shoe")),
    Quantity("shoe_along", "Y_1", "m", mark("coordinate of the shoe along the leg")),
    Quantity("shoe_upright", "Y_2", "m", mark("coordinate of the shoe perpendicular to the leg")),
    Quantity("hub_travel", "X", "m", mark("travel of the hub")),
    Quantity("hub_rate", "X′", "m/rad", mark("travel of the hub by angle")),
    Quantity("cam_angle", "φ", "rad", mark("angle of the cam")),
    Quantity("lift", "s", "m", mark("lift of the follower")),
    Quantity("lift_slope", "s′", "m/rad", mark("slope of the lift")),
    Quantity("lift_second", "s″", "m/rad^2", mark("second derivative of the lift")),
    Quantity("lift_third", "s‴", "m/rad^3", mark("third derivative of the lift")),
    Quantity("lift_fourth", "s⁗", "m/rad^4", mark("fourth derivative of the lift")),
    Quantity("lift_velocity", "v", "m/s", mark("velocity of the follower")),
    Quantity("lift_acceleration", "a", "m/s^2", mark("acceleration of the follower")),
    Quantity("lift_jerk", "j", "m/s^3", mark("jerk of the follower")),
    Quantity("swing", "ψ", "rad", mark("angle of the follower")),
    Quantity("swing_slope", "ψ′", "1", mark("slope of the follower's angle")),
    Quantity("swing_second", "ψ″", "1/rad", mark("second derivative of the follower's angle")),
    Quantity("swing_third", "ψ‴", "1/rad^2", mark("third derivative of the follower's angle")),
    Quantity("swing_fourth", "ψ⁗", "1/rad^3", mark("fourth derivative of the follower's angle")),
    Quantity("swing_velocity", "ω", "rad/s", mark("angular velocity of the follower")),
    Quantity("swing_acceleration", "ε", "rad/s^2", mark("angular acceleration of the follower")),
    Quantity("swing_jerk", "j", "rad/s^3", mark("angular jerk of the follower")),
    Quantity("joint_angle", "φ", "rad", mark("angle of the cam where segments meet")),
    Quantity("joint_before", "", "m", mark("lift and derivatives before it")),
    Quantity("joint_after", "", "m", mark("lift and derivatives after it")),
    Quantity("drawn_angle", "φ", "rad", mark("angle of the cam at the drawn places")),
    Quantity("drawn_motion", "", "m", mark("lift and derivatives at the drawn places")),
    Quantity("share", "u", "1", mark("share of the angle")),
    Quantity("drawn_share", "φ/β", "1", mark("share of the angle at the drawn places")),
    Quantity("drawn_rise", "s/h", "1", mark("share of the rise at the drawn places")),
    Quantity("rise_share", "s/h", "1", mark("share of the rise")),
    Quantity("peak_coefficient", "C", "1", mark("peak coefficient")),
    Quantity("torque_coefficient", "C_T", "1", mark("peak coefficient of velocity times acceleration")),
    Quantity("first_jump", "", "1", mark("lowest derivative that jumps")),
    Quantity("carrier_angle", "φ", "rad", mark("angle of the carrier")),
    Quantity("path_radius", "ρ", "m", mark("radius of the roller's path")),
    Quantity("path_radius_slope", "ρ′", "m/rad", mark("slope of the radius of the roller's path")),
    Quantity(
        "path_radius_second", "ρ″", "m/rad^2", mark("second derivative of the radius of the roller's path")
    ),
    Quantity("cam_pressure_angle", "γ", "rad", mark("pressure angle of the cam")),
    Quantity("pressure_sine", "η", "1", mark("sine of the pressure angle")),
    Quantity("pressure_sine_slope", "η′", "1/rad", mark("slope of the sine of the pressure angle")),
    Quantity(
        "pressure_sine_second", "η″", "1/rad^2", mark("second derivative of the sine of the pressure angle")
    ),
    Quantity(
        "sine_coefficient", "a", "1", mark("coefficient of the series of the sine of the pressure angle")
    ),
    Quantity(
        "cosine_coefficient", "b", "1", mark("coefficient of the series of the cosine of the pressure angle")
    ),
    Quantity("pressure_cosine", "λ", "1", mark("cosine of the pressure angle")),
    Quantity("law_curvature", "K", "1/m", mark("curvature given by the law")),
    Quantity("law_curvature_slope", "K′", "1/m/rad", mark("slope of the curvature given by the law")),
    Quantity("drawn_curvature", "k", "1/m", mark("curvature of the drawn path")),
    Quantity("roller_centre", "A", "m", mark("centre of the roller")),
    Quantity("radius_by_slope", "ρ_16", "m", mark("radius by formula (16)")),
    Quantity("parting", "Δρ_16", "m", mark("radius by formula (16) minus that by (15)")),
    Quantity("foretold_error", "Δρ_N", "m", mark("error of the series estimated from its next terms")),
    Quantity("series_error", "Δρ_a", "m", mark("radius by the series minus that by steps")),
    Quantity("routes_difference", "Δρ_c", "m", mark("integrated radius minus that by steps")),
    Quantity("follower_push", "Q", "N", mark("force along the follower's motion")),
    Quantity("follower_moment", "Q", "N m", mark("moment about the follower's pivot")),
    Quantity("contact_force", "N", "N", mark("contact force")),
    Quantity("cam_torque", "M", "N m", mark("torque of the camshaft")),
    Quantity("contact_stress", "σ", "Pa", mark("contact stress")),
    Quantity("contact_stress_by_source", "σ_K", "Pa", mark("contact stress by the source's formula")),
    Quantity("contact_shear", "τ", "Pa", mark("greatest shear stress below the contact")),
    Quantity("contact_depth", "z", "m", mark("depth of the greatest shear stress")),
    Quantity("contact_half_width", "a", "m", mark("half width of the strip of contact")),
    Quantity("cam_curvature_radius", "R", "m", mark("radius of curvature of the cam at the contact")),
)


QUANTITIES: Mapping[str, Quantity] = {quantity.name: quantity for quantity in (*MOTIONS, *FORCES, *CAMS)}
"""Every variable of a motion by its name, in reading order."""
