"""Every public function of a mechanism or a cam takes also the name of its file or of a built-in one."""

from __future__ import annotations

import inspect
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.model.examples.catalogue import description_of

SOURCES = {"MechanismSource", "CamSource", "DescriptionSource", "MechanismSource | xr.Dataset"}
DESCRIPTIONS = {
    "Mechanism",
    "AnyCam",
    "Mechanism | AnyCam",
    "Mechanism | Cam | PlateCam",
    "Mechanism | xr.Dataset",
}
ITSELF = {"mechanism_text", "cam_text", "value_at"}
"""They take a description to write it, or to read a number of it."""


def first_annotations() -> dict[str, str]:
    functions = {name: getattr(ct, name) for name in dir(ct) if inspect.isfunction(getattr(ct, name))}
    signatures = {name: list(inspect.signature(each).parameters.values()) for name, each in functions.items()}
    return {name: str(parameters[0].annotation) for name, parameters in signatures.items() if parameters}


def test_only_functions_of_descriptions_themselves_take_no_name() -> None:
    annotations = first_annotations()
    assert {name for name, annotation in annotations.items() if annotation in DESCRIPTIONS} == ITSELF
    assert len([annotation for annotation in annotations.values() if annotation in SOURCES]) >= 33


def test_a_name_a_file_and_the_description_give_the_same(tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(ct.mechanism_text(ct.example("crank-rocker")))
    cam = tmp_path / "own-cam.toml"
    cam.write_text(ct.cam_text(ct.example("valve-cam")))
    wanted = ct.motion(ct.example("crank-rocker"), 5)
    for source in ("crank-rocker", str(path), path):
        np.testing.assert_array_equal(ct.motion(source, 5).position, wanted.position)
    for source in ("valve-cam", cam):
        np.testing.assert_array_equal(ct.cam(source, 5).lift, ct.cam(ct.example("valve-cam"), 5).lift)
    assert description_of("crank-rocker") == description_of(path) == ct.example("crank-rocker")
    assert description_of("valve-cam") == description_of(str(cam)) == ct.example("valve-cam")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ct.motion("crank-rokcer"), 'did you mean "crank-rocker"'),
        (lambda: ct.motion("valve-cam"), "this describes a cam, not a linkage"),
        (lambda: ct.cam("crank-rocker"), "this describes a linkage, not a cam"),
        (lambda: ct.motion(ct.example("valve-cam")), "takes a mechanism.*type PlateCam"),
        (lambda: ct.cam(ct.example("crank-rocker")), "takes a cam.*type Mechanism"),
        (lambda: ct.report(3), "takes a mechanism, a cam.*type int"),
        (lambda: ct.reactions("nowhere.toml"), "nowhere.toml"),
    ],
)
def test_anything_else_is_refused_with_what_is_taken(call: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        call()  # type: ignore[operator]
