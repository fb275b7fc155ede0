"""An angle without a unit is refused where a description displays degrees: degrees may be meant."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import centrode as ct
from centrode.model.cam_files import cam_text, parse_cam
from centrode.model.examples import example_names
from centrode.model.files import mechanism_text, parse_mechanism
from centrode.sweeps.sweep import read_sweep

FOUR_BAR = """\
{display}
[frame.points]
A = [0, 0]
D = [4, 0]
[links.AB]
length = 1
angle = {angle}
[links.BC]
length = 3.5
[links.DC]
length = 3
{rest}
[[drives]]
link = "AB"
speed = 10
[assembly.sides]
C = "left"
"""
DEGREES = 'display = { angle = "deg" }'
SPHERE = """\
space = "sphere"
display = {{ angle = "{unit}" }}
[frame.points]
A = [0, 0]
D = [{longitude}, 0]
[links.AB]
length = "20 deg"
reference = ["A", "D"]
[links.BC]
length = {length}
[links.DC]
length = "80 deg"
[[drives]]
link = "AB"
speed = 1
[assembly.sides]
C = "left"
"""
CAM = """\
kind = "cam"
display = {{ angle = "{unit}" }}
curvature = {{ law = "spline", points = "{points}" }}
start = {{ radius = "50 mm" }}
range = {{ to = {to} }}
"""


def four_bar(angle: str, display: str = DEGREES, rest: str = "") -> ct.Mechanism:
    return parse_mechanism(FOUR_BAR.format(angle=angle, display=display, rest=rest), "press.toml")


@pytest.mark.parametrize("angle", ["60", "-0.5", '"60"', '"pi/3"', '"2*pi/3"', "1e-05"])
def test_a_bare_angle_is_refused_with_its_repair(angle: str) -> None:
    with pytest.raises(ct.InputError) as refused:
        four_bar(angle)
    number = angle.strip('"')
    assert refused.value.where == "press.toml, [links.AB] angle"
    assert refused.value.what == f"{angle} is an angle without a unit, and this description displays degrees"
    assert refused.value.repair == f'write "{number} deg" or "{number} rad"'


@pytest.mark.parametrize("angle", ["0", "0.0", '"0"', '"60 deg"', '"1 rad"', '"1/6 turn"'])
def test_zero_and_angles_with_a_unit_are_accepted(angle: str) -> None:
    given = {"60 deg": math.pi / 3, "1 rad": 1.0, "1/6 turn": math.pi / 3}.get(angle.strip('"'), 0.0)
    assert four_bar(angle).links["AB"].angle == pytest.approx(given, rel=1e-15)


def test_numbers_are_si_where_radians_are_displayed() -> None:
    assert four_bar("0.5", "").links["AB"].angle == 0.5
    assert four_bar('"pi/6"', 'display = { angle = "rad" }').links["AB"].angle == math.pi / 6


def test_all_bare_angles_are_reported_at_once() -> None:
    with pytest.raises(ct.InputError) as refused:
        parse_mechanism(FOUR_BAR.format(angle=60, display=DEGREES, rest="angle = 90"), "press.toml")
    assert "[links.AB] angle: 60 is an angle" in str(refused.value)
    assert "[links.DC] angle: 90 is an angle" in str(refused.value)


def test_other_quantities_stay_si() -> None:
    assert four_bar('"60 deg"').drives[0].speed == 10.0


def test_on_the_sphere_arcs_are_angles() -> None:
    with pytest.raises(ct.InputError, match=r"\[links.BC\] length: 1.2 is an angle without a unit"):
        parse_mechanism(SPHERE.format(unit="deg", longitude='"90 deg"', length=1.2))
    with pytest.raises(ct.InputError, match="90 is an angle without a unit"):
        parse_mechanism(SPHERE.format(unit="deg", longitude=90, length='"45 deg"'))
    assert parse_mechanism(SPHERE.format(unit="rad", longitude=1.5, length=1.2)).links["BC"].length == 1.2


def test_a_cam_in_degrees_needs_units(tmp_path: Path) -> None:
    points = tmp_path / "points.csv"
    points.write_text("angle,curvature [1/m]\n0,20\n1,22\n")
    text = CAM.format(unit="deg", points="points.csv", to='"40 deg"')
    with pytest.raises(ct.InputError, match=r'row 2 of "points.csv": "1" is an angle without a unit'):
        parse_cam(text, "cam.toml", tmp_path)
    points.write_text("angle [rad],curvature [1/m]\n0,20\n1,22\n")
    parse_cam(text, "cam.toml", tmp_path)
    with pytest.raises(ct.InputError, match=r"\[range\] to: 40 is an angle without a unit"):
        parse_cam(CAM.format(unit="deg", points="points.csv", to=40), "cam.toml", tmp_path)


@pytest.mark.parametrize("name", example_names("linkage"))
def test_a_written_mechanism_reads_back(name: str) -> None:
    mechanism = ct.example(name)
    assert parse_mechanism(mechanism_text(mechanism)) == mechanism


@pytest.mark.parametrize("name", example_names("cam"))
def test_a_written_cam_reads_back(name: str) -> None:
    cam = ct.example(name)
    assert parse_cam(cam_text(cam)) == cam


def test_instants_as_texts_need_their_unit() -> None:
    mechanism = four_bar('"60 deg"')
    instant = mechanism.motion_parameter.instant
    with pytest.raises(ct.InputError) as refused:
        instant.read("60", "--at")
    assert str(refused.value).startswith('--at: "60" is an angle without a unit')
    assert instant.read("60 deg", "--at") == math.pi / 3
    assert instant.read("0", "--at") == 0.0
    assert instant.read(1.5, "at") == 1.5, "a number of Python is SI"


@pytest.mark.parametrize(
    "varied",
    [
        "from = 10\n[vary]\n'links.AB.length' = [1.0, 1.1]",
        "[vary]\n'links.DC.angle' = [70, 80]",
        "[grid]\n'links.DC.angle' = { from = 70, to = 80, count = 3 }",
        "[sample]\ncount = 3\n[sample.ranges]\n'links.DC.angle' = { from = 70, to = 80 }",
    ],
)
def test_studies_of_a_sweep_need_units(varied: str, tmp_path: Path) -> None:
    (tmp_path / "bar.toml").write_text(
        FOUR_BAR.format(angle='"60 deg"', display=DEGREES, rest='angle = "75 deg"')
    )
    study = tmp_path / "study.toml"
    study.write_text(f'mechanism = "bar.toml"\noutputs = ["position.C"]\nreduce = "max"\n{varied}\n')
    with pytest.raises(ct.InputError, match=r"(10|70) is an angle without a unit"):
        read_sweep(study)
