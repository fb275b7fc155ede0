from __future__ import annotations

import math
import re
from fractions import Fraction

import pytest

from centrode import locale, quantities
from centrode.errors import InputError, Status
from centrode.model.units import KINDS, read_quantity
from centrode.quantities import (
    ANGLES,
    LENGTHS,
    QUANTITIES,
    UNIT_SYMBOLS,
    display_unit,
    typeset_unit,
    with_unit,
)


def test_every_variable_of_a_motion_is_named() -> None:
    bases = (
        "angle",
        "angular_velocity",
        "angular_acceleration",
        "joint_angle",
        "joint_velocity",
        "joint_acceleration",
        "hinge_angle",
        "hinge_velocity",
        "hinge_acceleration",
        "polar_angle",
        "azimuth",
        "slide",
        "slide_velocity",
        "slide_acceleration",
    )
    coefficients = [
        f"{prefix}{order}_coefficient"
        for prefix in ("", "angular_", "joint_", "slide_")
        for order in ("velocity", "acceleration")
    ]
    others = ("time", "drive_value", "position", "velocity", "acceleration", "contact", "status", "residual")
    events = ("event_value", "event_kind", "event_group")
    reduced = [f"reduced_{name}" for name in ("inertia", "inertia_slope", "moment")]
    reduced += ["inertia_matrix", "generalised_force"]
    reduced = [*reduced, *(f"{name}_part" for name in reduced), "christoffel", "jumps", "drive_rate"]
    steady = ["turned", "moment_of_loads", "driving_moment", "work_of_loads", "work_of_drive", "work"]
    steady += ["inertia_of_links", "inertia_slope_of_links", "energy_of_links", "energy_change"]
    steady += [f"drive_{name}{order}" for name in ("speed", "acceleration") for order in ("", "_first_order")]
    reactions = ["joint_force", "guide_force", "guide_normal", "guide_moment", "gear_moment", "tooth_force"]
    reactions += [f"rolling_{name}" for name in ("force", "normal", "tangential")]
    reactions += [f"{of}_{name}" for of in ("inertia", "frame", "shaking") for name in ("force", "moment")]
    reactions += ["joint_moment", "centre_force", "tooth_radial_force"]
    reactions += [f"friction_{name}" for name in ("moment", "force", "power", "work", "turns")]
    reactions += ["efficiency", "self_locking", "balancing", "determined", "reaction_status", "reaction_loss"]
    centres = (
        "centre",
        "centre_direction",
        "centre_case",
        "relative_speed",
        "fixed_centrode",
        "moving_centrode",
        "fixed_arc",
        "moving_arc",
        "centrode_piece",
        "pole",
        "inflection_pole",
        "inflection_diameter",
        "pole_tangent",
        "ball_point",
        "stationary_cubic",
        "path_curvature",
        "path_curvature_slope",
        "curvature_centre",
    )
    transmission = ("transmission_angle", "pressure_angle")
    transmission += ("least_transmission_angle", "greatest_transmission_angle")
    integrated = ("drift", "angle_difference", "position_difference")
    cams = {
        "carrier_angle",
        "cam_pressure_angle",
        "roller_centre",
        "drawn_curvature",
        "radius_by_slope",
        "parting",
    }
    cams |= {f"{name}_error" for name in ("foretold", "series")} | {"routes_difference", "pressure_cosine"}
    for name in ("path_radius", "pressure_sine", "law_curvature"):
        cams |= {name, f"{name}_slope"}
    cams |= {"path_radius_second", "pressure_sine_second"}
    known = {*bases, *coefficients, *others, *events, *centres, *transmission, *integrated}
    simulated = ["inertia", "moment_of_friction", "power_of_drive", "power_of_loads", "work_of_friction"]
    simulated += ["work_of_other_loads", "kinetic_energy", "potential_energy", "energy_residual"]
    simulated += [f"occasion_{name}" for name in ("time", "value", "kind", "part", "impulse", "loss")]
    simulated += ["restraint_force", "contact_mode", "controller_output"]
    known |= set(reduced) | set(steady) | set(simulated) | set(reactions)
    known |= {"shaking_force", "shaking_force_size", "shaking_moment", "inertia_on_drive", "order"}
    known |= {
        f"{what}_harmonic_{part}"
        for what in ("force", "moment")
        for part in ("cosine", "sine", "amplitude", "phase")
    }
    known.add("force_harmonic_greatest")
    cams |= {"path_curvature", "profile", "profile_radius", "profile_angle", "profile_bend", "groove"}
    cams |= {f"shoe_{name}" for name in ("profile", "radius", "angle", "bend", "along", "upright")}
    cams |= {"hub_travel", "hub_rate"}
    cams |= {f"contact_{name}" for name in ("stress", "stress_by_source", "shear", "depth", "half_width")}
    cams |= {"cam_curvature_radius"}
    cams |= {"profile_normal", "face_place", "cutter_centre", "curve_point", "curve_normal"}
    cams |= {"cam_angle", "joint_angle", "joint_before", "joint_after", "lift", "swing"}
    cams |= {"drawn_angle", "drawn_motion"}
    cams |= {"sine_coefficient", "cosine_coefficient"}
    cams |= {"follower_push", "follower_moment", "contact_force", "cam_torque"}
    ends = ("slope", "second", "third", "fourth", "velocity", "acceleration", "jerk")
    cams |= {f"{front}_{end}" for front in ("lift", "swing") for end in ends}
    cams |= {
        "drawn_share",
        "drawn_rise",
        "share",
        "rise_share",
        "peak_coefficient",
        "torque_coefficient",
        "first_jump",
    }
    known |= cams
    known |= {"moment_of_links", "inertia_moment_of_group"}
    known |= {f"generalised_{order}" for order in ("coordinate", "velocity", "acceleration")}
    known |= {"work_part", "keeping_moment", "velocity_residual"}
    known |= {
        "bearing_load",
        "load_on_journal",
        "load_on_bush",
        "relative_turning",
        "load_path",
        "sector",
        "wear",
    }
    known |= {"stability", "growth_rate", "holding_moment", "friction_reach", "friction_holds_everywhere"}
    known |= {"friction_share", "friction_feeds_itself"}
    known |= {f"{kind}_frequency" for kind in ("damped", "natural", "undamped", "critical")}
    known |= {"damping_ratio", "mode_amplitude", "mode_phase", "friction_band", "branch"}
    known |= {f"branch_{name}" for name in ("value", "coordinate", "stability")}
    known |= {f"critical_{name}" for name in ("value", "kind", "coordinate")}
    known |= {f"{name}_gradient" for name in ("coordinate", "speed", "position", "point_speed")}
    known |= {f"occasion_{name}" for name in ("position", "point_speed")}
    known |= {f"occasion_{name}_gradient" for name in ("time", "position", "point_speed")}
    assert set(QUANTITIES) == known
    assert all(name.isascii() and name == quantity.name for name, quantity in QUANTITIES.items())


@pytest.mark.parametrize(
    ("name", "displacement"),
    [
        ("drive_value", "m"),
        ("event_value", "m"),
        ("velocity_coefficient", "1"),
        ("acceleration_coefficient", "1/m"),
        ("angular_velocity_coefficient", "rad/m"),
        ("angular_acceleration_coefficient", "rad/m^2"),
        ("slide_velocity_coefficient", "1"),
        ("slide_acceleration_coefficient", "1/m"),
        ("angular_velocity", "rad/s"),
        ("reduced_inertia", "kg"),
        ("reduced_inertia_slope", "kg/m"),
        ("reduced_moment", "N"),
        ("drive_rate", "m/s"),
    ],
)
def test_units_follow_the_kind_of_drive(name: str, displacement: str) -> None:
    quantity = QUANTITIES[name]
    assert quantity.for_drive("rad") == quantity
    assert quantity.for_drive("m").unit == displacement
    assert quantity.for_drive("m").name == name


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("position", "1"),
        ("acceleration", "1/s^2"),
        ("velocity_coefficient", "1/rad"),
        ("slide", "rad"),
        ("slide_velocity", "rad/s"),
        ("slide_velocity_coefficient", "1"),
        ("slide_acceleration_coefficient", "1/rad"),
        ("angular_velocity", "rad/s"),
    ],
)
def test_units_on_the_sphere(name: str, unit: str) -> None:
    """Its radius is 1: places are plain numbers, displacements along circles are arcs."""
    assert QUANTITIES[name].on_sphere().unit == unit


DEGREE = 180 / math.pi


@pytest.mark.parametrize(
    ("unit", "length", "angle", "factor", "label"),
    [
        ("m", "mm", "deg", 1000.0, "mm"),
        ("m/s^2", "mm", "rad", 1000.0, "mm/s^2"),
        ("rad/s", "m", "deg", DEGREE, "deg/s"),
        ("rad/s^2", "m", "turn", 1 / (2 * math.pi), "turn/s^2"),
        ("m/rad", "mm", "deg", 1000 / DEGREE, "mm/deg"),
        ("m/rad^2", "cm", "deg", 100 / DEGREE**2, "cm/deg^2"),
        ("1/rad", "mm", "deg", 1 / DEGREE, "1/deg"),
        ("rad/m^2", "mm", "deg", DEGREE / 1e6, "deg/mm^2"),
        ("1", "mm", "deg", 1.0, "1"),
        ("s", "mm", "deg", 1.0, "s"),
        ("m", "in", "rad", float(Fraction(10000, 254)), "in"),
        ("kg m^2", "mm", "deg", 1.0, "kg m^2"),
    ],
)
def test_display_units(unit: str, length: str, angle: str, factor: float, label: str) -> None:
    got, said = display_unit(unit, length, angle)
    assert said == label
    assert abs(got - factor) <= 4 * 2.0**-52 * factor


@pytest.mark.parametrize(("length", "angle"), [("kg", "rad"), ("m", "m"), ("", "rad"), ("M", "rad")])
def test_unknown_display_units_are_refused(length: str, angle: str) -> None:
    with pytest.raises(InputError, match=r"display\.(length|angle): .* is not a unit of .*; use one of"):
        display_unit("s", length, angle)


def test_labels_of_axes() -> None:
    assert QUANTITIES["angular_acceleration"].label(angle="deg") == "angular acceleration ε, °/s²"
    assert QUANTITIES["residual"].label() == "closure residual over the greatest length"
    assert typeset_unit("mm/deg^2") == "mm/deg²"
    locale.choose_language("ru")
    try:
        assert QUANTITIES["velocity_coefficient"].label("mm", "deg") == "аналог скорости r′, мм/°"
        assert quantities.status_word(Status.OPEN) == "не замыкается"
    finally:
        locale.choose_language("en")


def units_of_quantities() -> set[str]:
    """Symbols without powers of all units that results can have, and that descriptions can give or show."""
    every = {quantity.unit for quantity in QUANTITIES.values()}
    every |= {quantity.for_drive(drive).unit for quantity in QUANTITIES.values() for drive in ("rad", "m")}
    every |= {quantity.on_sphere().unit for quantity in QUANTITIES.values()}
    every |= {kind.unit.replace("*", " ") for kind in KINDS.values()}
    return {base for unit in every for base in quantities.powers_of(unit)} | {*LENGTHS, *ANGLES}


def test_every_unit_has_its_symbol_in_every_language() -> None:
    """Cyrillic letters in Russian and Ukrainian, none in English; signs are the same in all three."""
    assert units_of_quantities() <= UNIT_SYMBOLS.keys()
    for unit, symbols in UNIT_SYMBOLS.items():
        assert len(symbols) == len(locale.LANGUAGES), unit
        english, *others = symbols
        assert not re.search("[а-яіїєґ]", english, re.IGNORECASE), unit
        if re.search("[A-Za-z]", english):
            assert all(re.fullmatch("[А-Яа-яіїєґ/]+", one) for one in others), unit
        else:
            assert set(symbols) == {english}, unit


@pytest.mark.parametrize(
    ("unit", "english", "russian", "ukrainian"),
    [
        ("m", "m", "м", "м"),
        ("m/s^2", "m/s²", "м/с²", "м/с²"),
        ("rad/s^2", "rad/s²", "рад/с²", "рад/с²"),
        ("N m", "N·m", "Н·м", "Н·м"),
        ("kg m^2", "kg·m²", "кг·м²", "кг·м²"),
        ("kg m^2/rad", "kg·m²/rad", "кг·м²/рад", "кг·м²/рад"),
        ("N*m*s/rad", "N·m·s/rad", "Н·м·с/рад", "Н·м·с/рад"),
        ("kg/m^3", "kg/m³", "кг/м³", "кг/м³"),
        ("1/m/rad", "1/(m·rad)", "1/(м·рад)", "1/(м·рад)"),
        ("rpm", "rpm", "об/мин", "об/хв"),
        ("MPa", "MPa", "МПа", "МПа"),
        ("J", "J", "Дж", "Дж"),
        ("W", "W", "Вт", "Вт"),
        ("deg", "°", "°", "°"),
        ("deg/s", "°/s", "°/с", "°/с"),
        ("um", "µm", "мкм", "мкм"),
        ("1", "", "", ""),
        ("", "", "", ""),
        ("furlong", "furlong", "furlong", "furlong"),
    ],
)
def test_units_are_spelled_in_the_language(unit: str, english: str, russian: str, ukrainian: str) -> None:
    """The SI brochure's middle dot and raised powers, GOST 8.417 and DSTU 3651 for the Cyrillic symbols."""
    for language, spelled in zip(locale.LANGUAGES, (english, russian, ukrainian), strict=True):
        with locale.speaking(language):
            assert quantities.spelled_unit(unit) == spelled
            assert quantities.terminal_unit(unit) == (
                spelled.replace("°", "deg") if language == "en" else spelled
            )


def test_the_sign_of_degrees_stands_close() -> None:
    assert with_unit("30", "°") == "30°"
    assert with_unit("30", "°/с") == "30 °/с"
    assert with_unit("5", "mm", "\u202f") == "5\u202fmm"
    assert with_unit("5", "") == "5"


@pytest.mark.parametrize("language", locale.LANGUAGES)
def test_what_a_terminal_prints_in_english_can_be_typed_again(language: str) -> None:
    """Degrees by name in English, by the sign elsewhere: both are read."""
    with locale.speaking(language):
        for unit in ("deg", "rad"):
            text = with_unit("30", quantities.terminal_unit(unit))
            if language == "en" or unit == "deg":
                assert read_quantity(text, "angle", "--at") == read_quantity(f"30 {unit}", "angle", "--at")


def test_every_status_has_its_word() -> None:
    assert {status: quantities.status_word(status) for status in Status} == {s: s.word for s in Status}
