"""Numbers with units: hand values, pint as the judge of the common ones, refusals."""

import math
import os
import subprocess
import sys
from functools import cache
from pathlib import Path

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode.errors import InputError
from centrode.model.units import COMMON, KINDS, to_si, unit_factor


@pytest.mark.parametrize(
    ("value", "kind", "expected"),
    [
        (3, "length", 3.0),
        ("0.5 mm", "length", 0.0005),
        ("850mm", "length", 0.85),
        ("1445 mm", "length", 1.445),
        ("0.5", "length", 0.5),
        ("-1e-3 m", "length", -0.001),
        ("2 inch", "length", 0.0508),
        ("1/2 m", "length", 0.5),
        ("pi/2 rad", "angle", math.pi / 2),
        ("28.6 deg", "angle", math.radians(28.6)),
        ("99.1 deg", "angle", math.radians(99.1)),
        ("90°", "angle", math.pi / 2),
        ("pi", "angle", math.pi),
        ("2 * pi rad", "angle", 2 * math.pi),
        ("30 arcmin", "angle", math.pi / 360),
        ("65 rpm", "angular speed", 65 * math.pi / 30),
        ("2 turn/s", "angular speed", 4 * math.pi),
        ("3 mm/min", "speed", 5e-5),
        ("450 kg*mm^2", "inertia", 4.5e-4),
        ("450 kg mm^2", "inertia", 4.5e-4),
        ("9.81 m/s^2", "acceleration", 9.81),
        ("9.81 m/s**2", "acceleration", 9.81),
        ("2 N/mm", "stiffness", 2000.0),
        ("2 N·m/deg", "angular stiffness", 360 / math.pi),
        ("3 N*m*s", "angular damping", 3.0),
        ("-40/20", "ratio", -2.0),
        ("20 ms", "time", 0.02),
    ],
)
def test_hand_values(value: object, kind: str, expected: float) -> None:
    assert to_si(value, kind) == pytest.approx(expected, rel=4e-16)


@cache
def registry() -> pint.UnitRegistry:
    """Units as pint defines them: read once, nothing is added to them."""
    return pint.UnitRegistry()


@pytest.mark.parametrize(("si", "unit"), [(si, unit) for si, units in COMMON.items() for unit in units])
def test_common_units_are_those_of_pint(si: str, unit: str) -> None:
    factor = registry().Quantity(1.0, unit).to(si).magnitude
    assert COMMON[si][unit] == pytest.approx(factor, rel=4e-16)


@given(st.integers(-(10**9), 10**9))
def test_millimetres_are_exact(count: int) -> None:
    assert to_si(f"{count} mm", "length") == count / 1000


@given(st.floats(-1e12, 1e12))
def test_numbers_in_si_keep_every_bit(number: float) -> None:
    assert to_si(f"{number!r} m", "length") == to_si(number, "length") == number


@pytest.mark.parametrize(
    ("value", "kind", "message"),
    [
        (
            "0.5 kg",
            "length",
            'expected a length (m), got "0.5 kg"; write a number in m, or a text with a unit',
        ),
        ("0.5 rad", "length", "expected a length (m)"),
        ("5 slug", "length", "expected a length (m)"),
        ("5 m", "angle", "expected an angle (rad)"),
        ("20 Hz", "angular speed", "Hz does not distinguish turns from radians: write rpm or rad/s"),
        ("2 kHz", "angular speed", "write rpm or rad/s"),
        ("2 deg", "angular speed", "expected an angular speed"),
        ("20 degC", "length", "expected a length"),
        ("5 wibble", "length", "is not a known unit"),
        ("730 об/хв", "angular speed", 'units have their international names: write "730 rpm"'),
        ("730 об/мин", "angular speed", 'units have their international names: write "730 rpm"'),
        ("pi/2 рад", "angle", 'units have their international names: write "pi/2 rad"'),
        ("60 град", "angle", 'units have their international names: write "60 deg"'),
        ("450 кг·мм^2", "inertia", 'units have their international names: write "450 kg*mm^2"'),
        ("9.81 м/с^2", "acceleration", 'units have their international names: write "9.81 m/s^2"'),
        ("9 кН", "force", 'units have their international names: write "9 kN"'),
        ("3,5 мм", "length", 'decimals have a point, not a comma: write "3.5 mm"'),
        ("5 мм", "angle", '"мм" is not a known unit, write a number in rad'),
        ("5 m^9999999", "length", "expected a length"),
        ("5 m**9**9**9", "length", "expected a length"),
        ("five m", "length", "expected a length"),
        ("１２ mm", "length", "expected a length"),
        ("٣ mm", "length", "expected a length"),
        ("12 ｍｍ", "length", "expected a length"),
        ("ｐｉ/2 rad", "angle", "expected an angle"),
        ("5 m; import os", "length", "expected a length"),
        ("", "length", "expected a length"),
        ("m", "length", "expected a length"),
        ("1/0 m", "length", "expected a length"),
        (
            "x" * 101,
            "mass",
            "a text of 101 characters is too long for a number with its unit, at most 100 are allowed; shorten it",
        ),
        ("5 " + "m" * 60, "length", "expected a length"),
        (math.nan, "length", "expected a finite number, got nan"),
        (math.inf, "length", "finite"),
        ("1e999 m", "length", "finite"),
        ("nan", "length", "expected a length"),
        ("inf m", "length", "expected a length"),
        (10**400, "length", "expected a length"),
        (True, "length", "got true"),
        (None, "length", "expected a length"),
        ([1], "length", "a list of 1 value"),
        ({}, "length", "got a table"),
        ("2 m", "ratio", "expected a number"),
        ("2 rad", "ratio", "expected a number"),
    ],
)
def test_refusals(value: object, kind: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        to_si(value, kind)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("text", "kind", "named"),
    [
        ("140 мм", "length", "140 mm"),
        ("75 об/мин", "angular speed", "75 rpm"),
        ("72 град", "angle", "72 deg"),
        ("2.2 кН", "force", "2.2 kN"),
        ("1.4 кг·м²", "inertia", "1.4 kg*m^2"),
        ("9,81 м/с²", "acceleration", "9.81 m/s^2"),
    ],
)
def test_units_in_cyrillic_are_repaired(text: str, kind: str, named: str) -> None:
    with pytest.raises(InputError) as caught:
        to_si(text, kind)
    assert caught.value.repair.endswith(f'write "{named}"')
    to_si(named, kind)  # the repair can be read


@pytest.mark.parametrize("text", ["5 мм", "5 коп", "5 °/с"])
def test_cyrillic_units_of_other_kinds_have_no_such_repair(text: str) -> None:
    with pytest.raises(InputError) as caught:
        to_si(text, "mass")
    assert "international" not in caught.value.repair


@pytest.mark.parametrize("unit", ["", "m m m", "1/s", "m;", "kg", "m" * 41])
def test_units_of_display_are_lengths(unit: str) -> None:
    with pytest.raises(InputError):
        unit_factor(unit, "length")


@given(st.text(alphabet="0123456789 .eE+-*/^()[]{}mradegpiskNHz°·µ%\n'\"_,;λ", max_size=40))
def test_any_text_is_a_quantity_or_an_input_error(text: str) -> None:
    for kind in KINDS:
        try:
            assert math.isfinite(to_si(text, kind))
        except InputError as error:
            assert "\n" not in str(error)


PROBE = "import sys; from centrode.model.units import to_si; print({call}, 'pint' in sys.modules)"


def probe(call: str, **environment: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", PROBE.format(call=call)],
        env={**os.environ, **environment},
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    assert done.stderr == ""
    return done.stdout.strip()


def test_common_units_need_no_pint() -> None:
    assert probe("to_si('65 rpm', 'angular speed')").endswith("False")


def test_home_that_cannot_be_written_does_not_hurt(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    home = str(blocked / "home")
    result = probe("to_si('2 inch', 'length')", HOME=home, XDG_CACHE_HOME=home, LOCALAPPDATA=home)
    assert result == "0.0508 True"
