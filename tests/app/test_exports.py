"""Files for other programs: those that the functions of the package write, under names that the programs take."""

from __future__ import annotations

import io
import json
import zipfile

import pytest

import centrode as ct
from centrode.app.frames import read_frame
from centrode.export.fmi import fmu_program
from centrode.export.freecad import freecad_macro
from centrode.export.mjcf import mjcf_text
from centrode.export.motion_code import motion_code
from centrode.export.robot_models import sdf_model, urdf_model
from centrode.kinematics.motion import initial_place
from centrode.model.examples import example_text

NAME = "crank-rocker"
STEM, PLAIN = "Crank-rocker-four-bar-linkage", "Crank_rocker_four_bar_linkage"


def exported(ask, topic, kind, text):
    """Name and content of a file."""
    answer = ask("export", text=text, topic=topic, format=kind)
    assert isinstance(answer, bytes), answer
    header, _arrays = read_frame(answer[: 4 + int.from_bytes(answer[:4], "little")])
    return header["name"], answer[4 + int.from_bytes(answer[:4], "little") :]


def mujoco(mechanism):
    return mjcf_text(mechanism, ct.motion(mechanism, at=[initial_place(mechanism)]))


TEXTS = [
    ("model", "xml", f"{STEM}.xml", mujoco),
    ("freecad", "FCMacro", f"{STEM}.FCMacro", freecad_macro),
    ("code", "c", f"{PLAIN}.c", lambda one: motion_code(one, "c", name=PLAIN)),
    ("code", "python", f"{PLAIN}.py", lambda one: motion_code(one, "python", name=PLAIN)),
    ("code", "matlab", f"{PLAIN}.m", lambda one: motion_code(one, "matlab", name=PLAIN)),
    ("code", "javascript", f"{PLAIN}.js", lambda one: motion_code(one, "javascript", name=PLAIN)),
]


@pytest.mark.parametrize(("topic", "kind", "name", "write"), TEXTS, ids=[kind for _, kind, *_ in TEXTS])
def test_a_text_is_that_of_the_package(ask, topic, kind, name, write):
    found, content = exported(ask, topic, kind, example_text(NAME))
    assert found == name
    assert content.decode() == write(ct.parse_mechanism(example_text(NAME)))


@pytest.mark.parametrize(("kind", "model"), [("urdf", urdf_model), ("sdf", sdf_model)])
def test_a_model_of_a_robot_comes_with_its_loops(ask, kind, model):
    name, content = exported(ask, "robot", kind, example_text(NAME))
    expected = model(ct.parse_mechanism(example_text(NAME)))
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        files = {one: archive.read(one).decode() for one in archive.namelist()}
    assert name == f"{STEM}-{kind}.zip"
    assert files == {f"{STEM}.{kind}": expected.text, f"{STEM}.loops.json": expected.loops}
    assert json.loads(expected.loops)


@pytest.mark.parametrize(("example", "driven"), [(NAME, True), ("single-cylinder-engine", False)])
def test_an_fmu_is_driven_where_nothing_else_could_move_it(ask, example, driven):
    name, content = exported(ask, "fmu", "fmu", example_text(example))
    mechanism = ct.parse_mechanism(example_text(example))
    stem = name.removesuffix(".fmu")
    assert content == fmu_program(mechanism, name=stem, driven=driven).archive({})


def test_all_of_them_are_offered(ask):
    offered = {one["name"]: one for one in ask("hello", language="uk")["exports"]}
    assert {"report", "drawing", "page", "model", "robot", "fmu", "freecad", "code"} == set(offered)
    assert offered["code"]["formats"] == ["c", "python", "matlab", "javascript"]
    assert [name for name, one in offered.items() if one["for"] is None] == ["report"]


def test_what_a_program_does_not_take_is_said(ask):
    answer = ask("export", text=example_text("spherical-four-bar"), topic="robot", format="urdf")
    assert answer["error"]["message"]
    assert ask("export", text=example_text(NAME), topic="code", format="exe")["error"]["repair"]
