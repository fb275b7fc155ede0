"""Motions that topics have found, as the page gets them: frames with their events, exact where something happens."""

from __future__ import annotations

import csv
import io
import math
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from centrode.app.documents import read_document
from centrode.app.frames import read_frame
from centrode.app.motion_frames import MOST_FRAMES, MOST_NUMBERS, chosen_samples, motion_answer
from centrode.app.sketch import SketchParts
from centrode.model.examples import example_text

SINGLE = 2.0**-22
"""Places come in single precision, and are rounded once more on their way."""

INERTIA, DAMPING, STIFFNESS, FRICTION, RESTITUTION = 25 * 0.9**2 / 3, 12.0, 8.0, 1.5, 0.3
START, SLACK = math.radians(80), -math.pi / 3
"""The door of the example door-closer: a rod about its end, its spring slack at -60 degrees."""


def played(ask: Callable[..., Any], text: str, topic: str, **options: Any) -> tuple[dict[str, Any], Any]:
    """Header and arrays of a panel that plays something."""
    answer = ask("panel", text=text, topic=topic, options=options)
    assert isinstance(answer, bytes), answer
    return read_frame(answer)


def motion_blocks(header: dict[str, Any]) -> list[dict[str, Any]]:
    return [block for block in header["blocks"] if block["kind"] == "motion"]


def door_first_impact() -> tuple[float, float]:
    """When the door meets its frame first and how fast, by the closed form of a damped oscillator."""
    rest = SLACK + FRICTION / STIFFNESS  # friction acts against the closing
    decay = DAMPING / (2 * INERTIA)
    turn = math.sqrt(STIFFNESS / INERTIA - decay**2)
    away = START - rest

    def angle(t: float) -> float:
        return rest + away * math.exp(-decay * t) * (math.cos(turn * t) + decay / turn * math.sin(turn * t))

    low, high = 1.0, 2.0
    for _halving in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if angle(middle) > 0 else (low, middle)
    speed = away * STIFFNESS / INERTIA / turn * math.exp(-decay * low) * math.sin(turn * low)
    return low, speed


def number(cell: str) -> float:
    return float(cell.split("\u00a0")[0].split(" ")[0].replace("−", "-"))


def test_events_of_a_door_are_those_of_its_closed_form(ask: Callable[..., Any]) -> None:
    header, _arrays = played(ask, example_text("door-closer"), "simulate")
    (block,) = motion_blocks(header)
    time, speed = door_first_impact()
    first = block["marks"][0]
    assert first["sign"] == "impact" and abs(first["at"] - time) < 1e-8
    row = block["events"]["rows"][0]
    # cells have six and four digits
    assert abs(number(row[0]) - time) < 1e-5
    assert number(row[3]) == pytest.approx((1 + RESTITUTION) * INERTIA * speed, rel=5e-4)
    assert number(row[4]) == pytest.approx(INERTIA * speed**2 / 2 * (1 - RESTITUTION**2), rel=5e-4)
    assert "N·m·s" in row[3]
    signs = [mark["sign"] for mark in block["marks"]]
    assert signs.count("close") == 1 and signs.count("stick") == 1 and block["events"]["count"] == len(signs)
    assert {one["label"] for one in block["held"]} == {"frame", "friction door"}
    assert all(one["to"] == 4.0 for one in block["held"])
    # of small rebounds: out against spring and friction, back by the spring against friction, then the impact
    impulses = [number(one[3]) for one in block["events"]["rows"] if one[1] == "impact"]
    spring = STIFFNESS * -SLACK
    back = math.sqrt((spring - FRICTION) / (spring + FRICTION))
    assert impulses[-1] / impulses[-2] == pytest.approx(RESTITUTION * back, rel=2e-3)


def test_frames_have_the_instants_of_events_themselves(ask: Callable[..., Any]) -> None:
    """The door lies at its frame in the frame of each impact: not a sample before it."""
    header, arrays = played(ask, example_text("door-closer"), "simulate")
    (block,), (motion,) = motion_blocks(header), header["motions"]
    times, door = arrays["0 drive"], arrays["0 angles"][:, motion["links"].index("door")]
    for mark in block["marks"]:
        sample = int(np.searchsorted(times, np.float32(mark["at"])))
        assert times[sample] == np.float32(mark["at"])
        assert abs(door[sample]) < SINGLE
    assert np.all(door > -SINGLE)
    plots = [one for one in header["blocks"] if one["kind"] == "plot" and one["cursor"]]
    assert plots and all(len(one["x"]["values"]) == len(times) for one in plots)
    over_time = next(one for one in plots if one["marks"])
    ((begin, end),) = over_time["shaded"]
    assert end == 4.0 and begin == pytest.approx(block["held"][0]["from"], rel=1e-6)


def test_a_stone_flies_a_parabola_between_its_events(ask: Callable[..., Any]) -> None:
    header, arrays = played(ask, example_text("catapult"), "simulate")
    (block,), (motion,) = motion_blocks(header), header["motions"]
    at = {mark["label"]: mark["at"] for mark in block["marks"]}
    times, stone = arrays["0 drive"].astype(float), arrays["0 points"][:, motion["points"].index("S")]
    flight = times >= at["release: condition met"]
    since = times[flight] - times[flight][0]
    begin, speed = stone[flight][0], arrays["0 velocities"][:, motion["points"].index("S")][flight][0]
    fallen = np.array([0.0, -9.81]) * since[:, None] ** 2 / 2
    assert np.abs(stone[flight] - begin - speed * since[:, None] - fallen).max() < 4e-6
    assert times[-1] == pytest.approx(at["lands: condition met"]) and abs(stone[-1, 1]) < 4e-6


def test_a_simulation_by_the_reduced_equation_is_played_too(ask: Callable[..., Any]) -> None:
    text = example_text("six-bar-press-run-up")
    header, arrays = played(ask, text, "simulate", duration="1 s")
    motion = header["motions"][0]
    places = dict(zip(motion["points"], np.moveaxis(arrays["0 points"], 1, 0), strict=True))
    first = ask("read", text=text)["scene"]
    for link in first["links"]:
        pairs = list(zip(link["points"], link["points"][1:], strict=False))
        for one, other in pairs:
            lengths = np.linalg.norm(places[one] - places[other], axis=1)
            assert np.ptp(lengths) < 8 * SINGLE, link["name"]


LONG = """
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.rod]
points = ["O", "A"]
length = 1
mass = 1
shape = "rod"
[[drives]]
link = "rod"
start = 0
[simulation]
equations = "multibody"
duration = 2
samples = {samples}
{at}
"""


def test_a_long_simulation_is_played_in_fewer_frames(ask: Callable[..., Any]) -> None:
    """More samples than a page plays are not even computed; given instants are, and then thinned."""
    header, arrays = played(ask, LONG.format(samples=400_000, at=""), "simulate")
    assert header["motions"][0]["samples"] == len(arrays["0 drive"]) == MOST_FRAMES
    assert arrays["0 drive"][0] == 0.0 and arrays["0 drive"][-1] == 2.0
    # pendulum from the horizontal: its greatest speed is that of the energy
    speed = np.abs(arrays["0 angular_velocities"]).max()
    assert speed == pytest.approx(math.sqrt(3 * 9.81), rel=1e-4)
    many = ", ".join(f"{k / 6000:.6f}" for k in range(12_001))
    header, arrays = played(ask, LONG.format(samples=2, at=f"at = [{many}]"), "simulate")
    assert len(arrays["0 drive"]) == MOST_FRAMES and arrays["0 drive"][-1] == 2.0


def test_frames_of_a_large_mechanism_stay_within_their_bound() -> None:
    xr = pytest.importorskip("xarray")
    data = xr.Dataset({"position": (("sample", "point", "axis"), np.zeros((20_001, 500, 2)))})
    chosen = chosen_samples(data)
    assert len(chosen) * 1000 <= MOST_NUMBERS < (len(chosen) + 1) * 1000
    assert chosen[0] == 0 and chosen[-1] == 20_000


def test_modes_are_played_in_the_plane_and_on_the_sphere(ask: Callable[..., Any]) -> None:
    """A period ends where it begins; links keep their lengths, arcs on the sphere too."""
    header, arrays = played(ask, example_text("vibrating-screen"), "modes")
    blocks = motion_blocks(header)
    assert [block["number"] for block in blocks] == [0, 1, 2] and all(block["loops"] for block in blocks)
    for k in range(3):
        places = arrays[f"{k} points"]
        assert np.abs(places[0] - places[-1]).max() < 2 * SINGLE
    # the bounce moves both ends alike, the pitch moves them against each other
    names = header["motions"][0]["points"]
    heights = [arrays[f"{k} points"][:, [names.index("P"), names.index("Q")], 1] for k in range(3)]
    swings = [one - one.mean(axis=0) for one in heights]
    together = [float(np.corrcoef(one.T)[0, 1]) for one in swings]
    assert together[1] > 0.9 and together[2] < -0.9

    header, arrays = played(ask, example_text("spherical-crank-rocker-rigid"), "modes")
    places, names = arrays["0 points"].astype(float), header["motions"][0]["points"]
    at = {name: places[:, names.index(name)] for name in names}
    assert np.abs(np.linalg.norm(places, axis=-1) - 1).max() < 4 * SINGLE
    for one, other, arc in (("A", "B", math.pi / 12), ("B", "C", math.pi / 4), ("D", "C", math.pi / 2)):
        cosines = np.sum(at[one] * at[other], axis=1)
        assert np.abs(cosines - math.cos(arc)).max() < 4 * SINGLE
    assert np.ptp(at["B"], axis=0).max() > 0.05


def test_exports_are_those_of_the_command(ask: Callable[..., Any]) -> None:
    """A table has the instants of the description, not those of events besides, and no places of points."""
    answer = ask("export", text=example_text("door-closer"), topic="simulate", format="csv", options={})
    assert isinstance(answer, bytes)
    with zipfile.ZipFile(io.BytesIO(answer[4 + int.from_bytes(answer[:4], "little") :])) as archive:
        rows = list(csv.DictReader(archive.read("simulation.csv").decode().splitlines()))
        events = list(csv.DictReader(archive.read("simulation-events.csv").decode().splitlines()))
    assert len(rows) == 1001
    assert any("impulse" in head and "N m s" in head.replace("*", " ") for head in events[0])


def test_events_are_said_once_and_portraits_go_from_left_to_right(ask: Callable[..., Any]) -> None:
    """The list under the slider has them; facts count them, and a value of rounding is zero."""
    header, _arrays = played(ask, example_text("door-closer"), "simulate")
    (motion,) = motion_blocks(header)
    assert len(motion["marks"]) == 10
    (facts,) = (block["facts"] for block in header["blocks"] if block["kind"] == "facts")
    labels = [fact["label"] for fact in facts]
    assert "impact" not in labels and labels.count("frame") == 1
    assert not any("·10⁻¹" in fact["text"] for fact in facts if fact["label"].startswith("coordinate"))
    (portrait,) = (block for block in header["blocks"] if block.get("name") == "simulation-phase-door")
    low, high = portrait["x"]["ends"]
    # the door shuts: its angle falls from 80 degrees
    assert low < 0.0 < START < high and portrait["x"]["values"][0] > portrait["x"]["values"][-1]


@pytest.mark.parametrize("name", ["crank-rocker", "double-rocker", "scissor-lift", "hoeken"])
def test_the_initial_position_is_found_among_the_samples(name: str) -> None:
    """Where the range of the drive begins elsewhere too: there the points stand as the description has them."""
    document = read_document(example_text(name), Path())
    header, arrays = motion_answer(document.require_prepared(), 361)
    sketch = SketchParts(document)
    low = math.floor(header["start"])
    share, rows = header["start"] - low, np.asarray(arrays["points"])[[low, min(low + 1, 360)]]
    seen = (1 - share) * rows[0] + share * rows[1]
    expected = [sketch.places[point] for point in header["points"]]
    # the chord between two of 361 samples
    assert np.abs(seen - expected).max() < 1e-3 * sketch.size


def test_a_range_without_the_initial_position_has_none() -> None:
    text = example_text("crank-rocker") + "\n[study]\nfrom = 1.0\nto = 2.0\n"
    header, _arrays = motion_answer(read_document(text, Path()).require_prepared(), 91)
    assert header["start"] is None
