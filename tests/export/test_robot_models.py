"""Models of robots: loaded by another library, their points move as ours do, and loops close."""

from __future__ import annotations

import io
import json
import math
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.errors import Status
from centrode.export.robot_models import sdf_model, urdf_model
from centrode.kinematics.motion import initial_place
from centrode.kinematics.preparation import ready
from centrode.model.files import parse_mechanism
from samples import ALL

yourdfpy = pytest.importorskip("yourdfpy", reason="models are loaded by yourdfpy")

PLANAR = tuple(name for name in ct.example_names() if ct.example(name).space == "plane")
SOME = (
    "elliptic-trammel", "excavator-arm", "geared-five-bar", "inverted-slider-crank", "jansen-leg",
    "oscillating-cylinder", "parallelogram", "planetary-gear-train", "rack-and-pinion", "scotch-yoke",
    "slider-between-cranks-locked",
    "third-class-triad", "wiper",
)  # fmt: skip
AT_HAND = PLANAR if ALL else SOME
EXACT = 1e-9
LOOKS = 7


def motion_of_model(mechanism: ct.Mechanism) -> xr.Dataset:
    """The motion at the places of a model's coordinates: the initial one first."""
    prepared = ready(mechanism)
    whole = ct.motion(mechanism)
    places = whole.drive_value.values[:, 0] if prepared.parameter.is_uniform else whole.time.values
    moving = ct.motion(mechanism, at=[initial_place(mechanism), *places.tolist()])
    return moving.isel(sample=moving.status.values == Status.OK)


def size_of(moving: xr.Dataset) -> float:
    return float(np.ptp(moving.position.values, axis=(0, 1)).max())


@pytest.mark.parametrize("name", AT_HAND)
def test_points_of_a_tree_move_as_ours(name: str) -> None:
    mechanism = ct.example(name)
    model = urdf_model(mechanism)
    robot = yourdfpy.URDF.load(io.BytesIO(model.text.encode()), build_scene_graph=True, load_meshes=False)
    loops = json.loads(model.loops)
    moving = motion_of_model(mechanism)
    size = size_of(moving)
    # every joint gets its own coordinate, those that follow others too
    free = [joint for joint in robot.robot.joints if joint.type != "fixed"]
    for joint in free:
        joint.mimic = None
    robot = yourdfpy.URDF(robot=robot.robot, build_scene_graph=True, load_meshes=False)
    assert {joint.name for joint in free} == set(loops["coordinates"])
    for k in np.linspace(0, moving.sizes["sample"] - 1, LOOKS).astype(int):
        robot.update_cfg({joint: values[k] for joint, values in loops["coordinates"].items()})
        for link, points in [
            ("frame", mechanism.frame.points),
            *((x, y.coordinates) for x, y in mechanism.links.items()),
        ]:
            for point in points:
                found = robot.get_transform(f"{link}.{point}".replace(" ", "_"))[:2, 3]
                wanted = moving.position.sel(point=point).values[k]
                assert np.abs(found - wanted).max() <= EXACT * size, (link, point)


@pytest.mark.parametrize("name", AT_HAND)
def test_joints_follow_the_drive_within_the_stated_error(name: str) -> None:
    model = urdf_model(name)
    robot = yourdfpy.URDF.load(io.BytesIO(model.text.encode()), build_scene_graph=False, load_meshes=False)
    loops = json.loads(model.loops)
    followers = {joint.name: joint.mimic for joint in robot.robot.joints if joint.mimic is not None}
    assert set(followers) == set(loops["mimics"])
    for joint, mimic in followers.items():
        master, own = (np.array(loops["coordinates"][x]) for x in (mimic.joint, joint))
        away = float(np.abs(mimic.multiplier * master + mimic.offset - own).max())
        stated = loops["mimics"][joint]
        # the statement is no larger than what it states
        assert away == pytest.approx(stated["error"], rel=1e-9, abs=1e-12)
        assert stated["exact"] == (
            away <= EXACT * (size_of(ct.motion(name)) if joint.startswith("guide") else 1.0)
        )


@pytest.mark.parametrize(
    ("name", "followers"),
    [
        ("geared-five-bar", {"frame_EC_E": -2.0}),
        ("parallelogram", {"frame_DB_D": 1.0, "OA_AB_A": -1.0}),
        ("rack-and-pinion", {"guide_H": 0.02}),
    ],
)
def test_gears_parallelograms_and_racks_follow_exactly(name: str, followers: dict[str, float]) -> None:
    mimics = json.loads(urdf_model(name).loops)["mimics"]
    exact = {joint: mimic["multiplier"] for joint, mimic in mimics.items() if mimic["exact"]}
    assert exact == pytest.approx(followers, rel=1e-12)


class SdfBodies:
    """An own reader of SDF: where links stand initially, and what joints say of pairs of them."""

    def __init__(self, text: str) -> None:
        model = ET.fromstring(text).find("model")
        assert model is not None
        self.place = {link.attrib["name"]: _numbers(link.findtext("pose"))[:2] for link in model.iter("link")}
        self.joints = [joint for joint in model.iter("joint") if joint.attrib["type"] != "fixed"]
        self.frames = {
            frame.attrib["name"]: (frame.attrib["attached_to"], _numbers(frame.findtext("pose"))[:2])
            for frame in model.iter("frame")
        }

    def anchor(self, joint: ET.Element) -> np.ndarray:
        """Where a joint stands initially."""
        return self.place[str(joint.findtext("child"))] + _numbers(joint.findtext("pose"))[:2]


def _numbers(text: str | None) -> np.ndarray:
    return np.array([float(word) for word in str(text).split()])


def turned(vector: np.ndarray, angle: np.ndarray) -> np.ndarray:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.stack([cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]], axis=-1)


@pytest.mark.parametrize("name", AT_HAND)
def test_every_joint_of_a_model_of_loops_holds_along_the_motion(name: str) -> None:
    mechanism = ct.example(name)
    model = sdf_model(mechanism)
    bodies, loops = SdfBodies(model.text), json.loads(model.loops)
    moving = motion_of_model(mechanism)
    size = size_of(moving)
    # links of the description move as the motion says: by an angle and the place of a point
    moves: dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]] = {
        "frame": (np.zeros(2), np.zeros((moving.sizes["sample"], 2)), np.zeros(moving.sizes["sample"]))
    }
    for link, described in mechanism.links.items():
        point = next(iter(described.coordinates))
        places, angle = moving.position.sel(point=point).values, moving.angle.sel(link=link).values
        moves[link.replace(" ", "_")] = places[0], places, angle - angle[0]

    for guide in mechanism.guides:
        if guide.link is None:
            places = moving.position.sel(point=guide.point).values
            moves[f"slider_{guide.id}".replace(" ", "_")] = (
                places[0],
                places,
                moves[guide.on.replace(" ", "_")][2],
            )

    def place(body: str, initial: np.ndarray) -> np.ndarray:
        base, places, angle = moves[body]
        return np.asarray(places + turned(initial - base, angle))

    pins = 0
    for joint in bodies.joints:
        first, second = str(joint.findtext("parent")), str(joint.findtext("child"))
        if first not in moves or second not in moves:
            continue
        at = bodies.anchor(joint)
        apart = place(first, at) - place(second, at)
        if joint.attrib["type"] == "prismatic":
            axis = _numbers(joint.findtext("axis/xyz"))[:2]
            normal = turned(np.array([-axis[1], axis[0]]), moves[first][2])
            apart = np.sum(apart * normal, axis=1)
            assert np.abs(moves[first][2] - moves[second][2]).max() <= EXACT
        assert np.abs(apart).max() <= EXACT * size, joint.attrib["name"]
        pins += 1
    assert pins > 0
    for frame, (body, own) in bodies.frames.items():
        if body in moves:
            point = next(p for p in moving.point.values if frame == f"{body}.{p}".replace(" ", "_"))
            found = place(body, bodies.place[body] + own)
            assert np.abs(found - moving.position.sel(point=point).values).max() <= EXACT * size
    assert len(bodies.joints) == len(loops["coordinates"]) + len(loops["closures"])


def test_masses_are_those_of_the_description() -> None:
    robot = yourdfpy.URDF.load(
        io.BytesIO(urdf_model("six-bar-press").text.encode()), build_scene_graph=False, load_meshes=False
    ).robot
    inertial = {link.name: link.inertial for link in robot.links if link.inertial is not None}
    assert {name: inertial[name].mass for name in ("AB", "CD", "DH", "slider")} == {
        "AB": 9, "CD": 16, "DH": 22, "slider": 3.5,
    }  # fmt: skip
    assert inertial["CD"].inertia[2, 2] == pytest.approx(0.55, rel=1e-12)
    # a flat body: moments along the plane add up to that across
    assert all(x.inertia[0, 0] + x.inertia[1, 1] == x.inertia[2, 2] for x in inertial.values())


def test_hostile_titles_and_odd_names_are_names() -> None:
    mechanism = parse_mechanism("""
        title = '<a href="x">& press'
        frame.points = { O = [0, 0], D = [4, 0] }
        links."crank 1'" = { points = { O = [0, 0], "A 1" = [1, 0] } }
        links.AB = { points = { "A 1" = [0, 0], B = [3.5, 0] } }
        links.DB.length = 3
        drives = [{ link = "crank 1'", start = 0, speed = 1 }]
        assembly.sides = { B = "left" }
        """)
    for model in (urdf_model(mechanism), sdf_model(mechanism)):
        root = ET.fromstring(model.text)
        names: list[Any] = [each.attrib["name"] for each in root.iter() if "name" in each.attrib]
        assert all(" " not in name for name in names) and any("crank_1'" in name for name in names)


@pytest.mark.parametrize("model", [urdf_model, sdf_model])
def test_the_sphere_is_refused(model: Any) -> None:
    with pytest.raises(ct.NotComputedYet, match="planar linkages"):
        model("hookes-joint")


def test_limits_of_slides_hold_the_motion() -> None:
    text = urdf_model("slider-crank-offset").text
    loops = json.loads(urdf_model("slider-crank-offset").loops)
    (slide,) = [joint for joint in ET.fromstring(text).iter("joint") if joint.attrib["type"] == "prismatic"]
    limit = slide.find("limit")
    assert limit is not None
    values = loops["coordinates"][slide.attrib["name"]]
    low, high = float(limit.attrib["lower"]), float(limit.attrib["upper"])
    assert low < min(values) and max(values) < high and high - low < 1.2 * (max(values) - min(values))
    assert math.isfinite(float(limit.attrib["velocity"])) and float(limit.attrib["velocity"]) > 0.0
