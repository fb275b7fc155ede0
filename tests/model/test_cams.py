"""The description of a cam: read, written, refused; and the doors that tell cams from linkages."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path

import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.model.cam import vary_cam
from centrode.model.cam_files import cam_text, parse_cam, read_cam
from centrode.model.examples import example_text
from centrode.model.examples.catalogue import load, load_cam
from centrode.model.schema import CAM_PROPERTIES, cam_schema

from .test_schema import fits

FULL = """\
kind = "cam"
title = "Walking wheel"
display = { length = "mm", angle = "deg" }

[curvature]
law = "exponential"
k0 = "0.01 1/mm"
k1 = "0.75 1/rad"
symmetric = true

[start]
radius = "5 cm"

[range]
to = "60 deg"

[roller]
radius = "8 mm"

[return]
kind = "designed"
least_radius = "20 mm"
greatest_radius = "80 mm"
least_curvature_radius = "5 mm"
pressure_angle = "40 deg"
convex = true

[mover]
legs = 4
post = "12 mm"
working_arc = ["-45 deg", "45 deg"]

[contact]
force = "2 kN"
width = "20 mm"
cam = { elasticity = "210 GPa" }
roller = { elasticity = "2e5 N/mm^2", poisson = 0.28 }
admissible = "600 MPa"

[choose]
parameters = { "curvature.k0" = ["0.008 1/mm", 15], "curvature.k1" = [0, "0.02 1/deg"] }
minimise = "stress"
pressure_angle = "30 deg"
size = "140 mm"

[study]
samples = 91
terms = 30
instants = ["0 deg", "30 deg"]
"""

LEAST = 'kind = "cam"\n[curvature]\nlaw = "constant"\nk0 = 12\n[start]\nradius = 0.05\n[range]\nto = 1\n'


def test_units_become_si() -> None:
    cam = parse_cam(FULL)
    assert (cam.curvature.k0, cam.curvature.k1, cam.curvature.symmetric) == (10.0, 0.75, True)
    assert (cam.start.radius, cam.start.pressure_angle) == (0.05, 0.0)
    assert (cam.range.start, cam.range.stop) == (0.0, pytest.approx(math.pi / 3))
    assert cam.roller is not None and cam.roller.radius == 0.008
    assert cam.return_arc is not None and cam.return_arc.greatest_radius == 0.08
    assert cam.mover is not None and cam.mover.working_arc == pytest.approx((-math.pi / 4, math.pi / 4))
    assert cam.contact is not None and cam.contact.roller is not None
    assert (cam.contact.force, cam.contact.cam.elasticity, cam.contact.admissible) == (2000.0, 210e9, 600e6)
    assert (cam.contact.cam.poisson, cam.contact.roller.elasticity) == (0.3, 200e9)
    assert cam.choose is not None
    assert cam.choose.parameters["curvature.k0"] == (8.0, 15.0)
    assert cam.choose.parameters["curvature.k1"] == (0.0, pytest.approx(0.02 * 180 / math.pi))
    assert (cam.study.samples, cam.study.terms, len(cam.study.instants)) == (91, 30, 2)


@pytest.mark.parametrize("text", [FULL, LEAST], ids=["full", "least"])
def test_written_and_read_again_it_is_the_same(text: str) -> None:
    cam = parse_cam(text)
    assert parse_cam(cam_text(cam)) == cam
    assert ct.Cam(**tomllib.loads(text)) == cam


@pytest.mark.parametrize("name", ct.example_names("cam"))
def test_examples_are_cams_and_say_where_they_are_from(name: str) -> None:
    cam = ct.example(name)
    assert isinstance(cam, ct.Cam | ct.PlateCam)
    assert load_cam(name) == cam == parse_cam(cam_text(cam))
    assert example_text(name).startswith("# ")


def test_laws_have_the_keys_they_need(tmp_path: Path) -> None:
    linear = parse_cam(LEAST.replace('"constant"', '"linear"\nk1 = "0.001 1/mm/deg"'))
    assert linear.curvature.k1 == pytest.approx(180 / math.pi)
    (tmp_path / "k.csv").write_text("phi [deg],K [1/mm]\n0,0.012\n30,0.015\n60,0.02\n")
    (tmp_path / "cam.toml").write_text(LEAST.replace('"constant"\nk0 = 12', '"spline"\npoints = "k.csv"'))
    spline = read_cam(tmp_path / "cam.toml")
    assert spline.curvature.points is not None
    assert spline.curvature.points[1] == pytest.approx((math.pi / 6, 15.0))
    formula = parse_cam(LEAST.replace('"constant"\nk0 = 12', '"formula"\nformula = "12+phi^2"'))
    assert formula.curvature.formula == "12+phi^2"


def test_numbers_are_changed_by_their_path() -> None:
    cam = parse_cam(FULL)
    other = vary_cam(cam, {"curvature.k0": 11.0, "roller.radius": 0.009})
    assert (other.curvature.k0, cam.curvature.k0) == (11.0, 10.0)
    assert other.roller is not None and other.roller.radius == 0.009
    with pytest.raises(InputError, match="the cam has no"):
        vary_cam(cam, {"curve.k0": 1.0})
    with pytest.raises(InputError, match="must be positive"):
        vary_cam(cam, {"curvature.k0": -1.0})


WRONG = [
    ("k0 = 12", "k0 = -12", "[curvature]: k0 must be positive, got -12"),
    ("k0 = 12", 'k0 = "12 mm"', "expected a curvature (1/m)"),
    ("k0 = 12", "", '[curvature]: "k0" is missing'),
    ("k0 = 12", "k0 = 12\nk1 = 1", 'a law of kind "constant" has no "k1"'),
    ("k0 = 12", "k0 = nan", "expected a finite number"),
    ('"constant"', '"parabolic"', "expected one of"),
    ('"constant"\nk0 = 12', '"formula"\nformula = "12+psi"', 'unknown name "psi"'),
    ('"constant"\nk0 = 12', '"formula"\nformula = "__import__(1)"', "unknown function"),
    ('"constant"\nk0 = 12', '"spline"\npoints = [[0, 12]]', "a spline needs at least two points"),
    ('"constant"\nk0 = 12', '"spline"\npoints = "../k.csv"', "is not in the folder of the description"),
    ("radius = 0.05", "radius = 0", "[start]: radius must be positive, got 0"),
    ("radius = 0.05", 'radius = "5 kg"', "expected a length (m)"),
    ("to = 1", "to = 0", "the range must contain phi = 0"),
    ("to = 1", "to = 1\nfrom = 0.2", "the range must contain phi = 0"),
    ("to = 1", 'to = "1 mm"', "expected an angle (rad)"),
    ("to = 1", "to = 1\nstep = 2", 'unknown key "step"'),
    ("k0 = 12", "k0 = 12\nsymmetric = 1", "expected true or false"),
    ("to = 1", "to = 1\n[roller]\nradius = 0.06", "the roller reaches the cam's centre"),
    ("to = 1", "to = 1\n[mover]\nlegs = 4", "[mover] needs a roller"),
    ("to = 1", "to = 1\n[mover]\nlegs = 1", "legs must be a whole number from 3 to 24"),
    ("to = 1", "to = 1\n[study]\nterms = 1", "terms must be a whole number from 2 to 2000"),
    ("to = 1", "to = 1\n[study]\nterms = 100000", "terms must be a whole number from 2 to 2000"),
    (
        "to = 1",
        'to = 1\n[choose]\nparameters = { "curvature.k3" = [1, 2] }',
        '"curvature.k3" cannot be chosen',
    ),
    (
        "to = 1",
        'to = 1\n[choose]\nparameters = { "curvature.k0" = [2, 1] }',
        "the least value has to be below",
    ),
    ("to = 1", "to = 1\n[choose]\nparameters = { }", "at least one parameter is to be chosen"),
    ('kind = "cam"', "", '"kind" is missing'),
]


@pytest.mark.parametrize(("old", "new", "said"), WRONG, ids=[new or old for old, new, _said in WRONG])
def test_what_is_wrong_is_told_with_its_place(old: str, new: str, said: str) -> None:
    assert LEAST.count(old) == 1
    with pytest.raises(InputError) as refused:
        parse_cam(LEAST.replace(old, new), "cam.toml")
    told = str(refused.value)
    assert told.startswith("cam.toml")
    assert said in told


def test_the_schema_knows_the_keys_of_the_parts_and_accepts_what_is_read() -> None:
    for part, properties in CAM_PROPERTIES.items():
        assert list(properties) == list(part.keys()), part
    schema = cam_schema()
    assert json.loads(json.dumps(schema)) == schema
    texts = [FULL, LEAST, *(example_text(name) for name in ct.example_names("cam"))]
    for text in texts:
        assert fits(tomllib.loads(text), schema, schema)
    for old, new in (
        ("k0 = 12", "k0 = -12"),
        ("radius = 0.05", "radius = 0"),
        ("to = 1", "to = 1\nstep = 2"),
        ("to = 1", "to = 1\n[study]\nterms = 1"),
        ('kind = "cam"', ""),
        ('kind = "cam"', 'kind = "gear"'),
    ):
        assert not fits(tomllib.loads(LEAST.replace(old, new)), schema, schema)


def test_symmetric_paths_start_level() -> None:
    for given, said in (
        ("radius = 0.05\npressure_angle = 0.1", "kink at phi = 0"),
        ("radius = 0.05\n[range]\nfrom = -1", "a symmetric law gives the path on both sides"),
    ):
        text = LEAST.replace("k0 = 12", "k0 = 12\nsymmetric = true")
        text = text.replace("radius = 0.05", given)
        text = text.replace("\n[range]\nto = 1", "\nto = 1") if "[range]" in given else text
        with pytest.raises(InputError, match=said):
            parse_cam(text)


def test_every_door_says_which_one_is_right(tmp_path: Path) -> None:
    (tmp_path / "cam.toml").write_text(LEAST)
    for reading in (lambda: load("cam-from-curvature"), lambda: ct.read_mechanism(tmp_path / "cam.toml")):
        with pytest.raises(InputError, match=r"this describes a cam, not a linkage.*centrode cam.*read_cam"):
            reading()
    for reading in (lambda: load_cam("crank-rocker"), lambda: parse_cam(example_text("crank-rocker"))):
        with pytest.raises(InputError, match="this describes a linkage, not a cam"):
            reading()
    with pytest.raises(InputError, match='did you mean "cam-from-curvature"'):
        load_cam("cam-from-curvatur")
    with pytest.raises(InputError, match="no built-in mechanisms of kind"):
        ct.example_names("gear")
