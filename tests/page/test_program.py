"""The program of a page: what it says of a mechanism, and what Node computes by it."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator

import numpy as np
import pytest
from tools.node import MISSING, NODE, Array, PageFrame, page_frames

import centrode as ct
from centrode.dynamics.kinetostatics.reaction_expressions import REACTIONS
from centrode.errors import InputError, NotComputedYet, Status
from centrode.model.examples import example_text
from centrode.model.examples.catalogue import MechanismSource
from centrode.model.files import parse_mechanism, with_values
from centrode.page.program import page_program
from centrode.report.mechanism_page.numbers_that_vary import ranges_of

needs_node = pytest.mark.skipif(NODE is None, reason=MISSING)


def test_data_are_plain_and_say_what_changes() -> None:
    program = page_program("crank-rocker")
    assert json.loads(json.dumps(program.data, allow_nan=False)) == program.data
    paths = [parameter.path for parameter in program.parameters]
    assert paths[:3] == ["links.OA.length", "links.AB.length", "links.DB.length"]
    length = program.parameters[0]
    assert (length.kind, length.unit, length.positive) == ("length", "m", True)
    assert length.least == length.value / 2 and length.most == 2 * length.value
    assert program.data["points"][: program.data["fixed"]] == list(program.mechanism.frame.points)


def test_ranges_are_read_with_their_units() -> None:
    (length,) = page_program("crank-rocker", {"links.AB.length": ("3 m", "350 cm")}).parameters
    assert (length.least, length.most) == (3.0, 3.5)


def test_a_digest_tells_structures_and_not_numbers() -> None:
    program = page_program("crank-rocker")
    changed = page_program(ct.with_value(program.mechanism, "links.AB.length", 3.2))
    other = page_program("crank-rocker", {"links.AB.length": (3, 4)})
    digests = {x.data["digest"] for x in (program, changed, other, page_program("watt-six-bar"))}
    assert program.data["digest"] == changed.data["digest"] and len(digests) == 3


@pytest.mark.parametrize(
    ("name", "vary", "error", "told"),
    [
        ("third-class-triad", None, NotComputedYet, "platform"),
        ("crank-rocker", {"links.AB.length": (3, 2)}, InputError, "links.AB.length"),
        ("crank-rocker", {"links.AB.length": (-1, 2)}, InputError, "positive"),
        ("crank-rocker", {"links.AB.length": "3"}, InputError, "two ends"),
        ("crank-rocker", {"links.XY.length": (1, 2)}, InputError, "XY"),
        ("crank-rocker", {"links.AB.length": ("3 kg", "4 kg")}, InputError, "kg"),
        ("crank-rocker", {"drives.OA.speed": (1, 2)}, InputError, "no dimension"),
    ],
)
def test_what_cannot_be_printed_is_refused_by_name(name: str, vary: object, error: type, told: str) -> None:
    with pytest.raises(error, match=told):
        page_program(name, vary)  # type: ignore[arg-type]


@needs_node
def test_limits_are_those_of_the_law_of_cosines() -> None:
    program = page_program("crank-rocker", {"links.AB.length": (1, 4)})
    (frame,) = page_frames(program, [[1.5]])
    crank, rocker = (float(ct.value_at(program.mechanism, f"links.{name}.length")) for name in ("OA", "DB"))
    one, other = program.mechanism.frame.points.values()
    base = math.dist(one, other)
    # coupler and rocker in line: the diagonal is their sum
    cosine = (crank**2 + base**2 - (1.5 + rocker) ** 2) / (2 * crank * base)
    limits = [event["drive"] for event in frame.events]
    assert {event["kind"] for event in frame.events} == {"limit"}
    assert limits and all(abs(math.cos(at) - cosine) < 1e-13 for at in limits)
    # what lies behind a limit, walked from the initial position, is cut off or open, and never ok
    drive = np.array(program.data["places"]["parameter"])
    low, high = frame.reach
    assert low in limits or high in limits
    assert (frame.status[(low < drive) & (drive < high)] == Status.OK).all()
    assert (frame.status[(drive < low) | (drive > high)] != Status.OK).all()


@needs_node
def test_limits_of_a_motion_to_and_fro_are_found() -> None:
    """The wiper swings about its initial position: its first and last samples are one place."""
    program = page_program("wiper", {"links.DB.length": (0.3, 0.9)})
    (frame,) = page_frames(program, [[0.48]])
    (limit,) = frame.events
    # blade (0.1 m) and arm in line: the way from A to D, 0.1 m beside the other arm's hinge, is their sum
    assert math.cos(limit["drive"]) == pytest.approx((0.6**2 + 0.1**2 - 0.58**2) / (2 * 0.6 * 0.1), abs=1e-13)
    drive = np.array(program.data["places"]["parameter"])
    assert ((frame.status == Status.OPEN) == (drive > limit["drive"])).all()


@needs_node
@pytest.mark.parametrize("name", ["jansen-leg", "scissor-lift", "five-bar-two-drives"])
def test_a_frame_does_not_depend_on_those_before(name: str) -> None:
    """Where events are looked for first follows from the frame before, and what is found does not."""
    program = page_program(name)
    random, own = np.random.default_rng(5), np.array([parameter.value for parameter in program.parameters])
    cases = [(own * (1.0 + 0.25 * random.uniform(-1.0, 1.0, len(own)))).tolist() for _ in range(12)]
    forwards, backwards = page_frames(program, cases), page_frames(program, cases[::-1])[::-1]
    for one, other in zip(forwards, backwards, strict=True):
        assert (one.status == other.status).all() and one.reach == other.reach
        assert [(e["kind"], e["group"]) for e in one.events] == [
            (e["kind"], e["group"]) for e in other.events
        ]
        # roots are taken to a bit of the drive
        apart = [abs(e["drive"] - f["drive"]) for e, f in zip(one.events, other.events, strict=True)]
        assert max(apart, default=0.0) <= 1e-13
        for quantity, values in one.quantities.items():
            np.testing.assert_array_equal(values, other.quantities[quantity])


@needs_node
def test_numbers_that_contradict_each_other_leave_their_residual() -> None:
    program = page_program("three-crank-parallelogram", {"links.FE.length": (0.5, 1.5)})
    fits, not_quite, slightly, off = page_frames(program, [[1.0], [1.0 + 1e-9], [1.0 + 1e-6], [1.1]])
    for frame in (fits, not_quite):
        assert (frame.status == Status.OK).all() and np.isnan(frame.misfit).all()
    for frame, length in ((slightly, 1.0 + 1e-6), (off, 1.1)):
        assert (frame.status == Status.OPEN).all() and np.isnan(frame.quantities["position"][:, -1]).all()
        # the pins of the third crank stay 1 m apart: in units of its length, squared, 1 is what is wanted
        np.testing.assert_allclose(frame.misfit, 1.0 - length**-2, rtol=1e-8)


@needs_node
def test_impossible_numbers_are_shown_and_not_broken() -> None:
    program = page_program("crank-rocker")
    own = [parameter.value for parameter in program.parameters]
    none, apart, whole = page_frames(program, [[-1.0, *own[1:]], [100.0, *own[1:]], own])
    assert not none.possible and (none.status == Status.OPEN).all()
    assert (
        apart.possible
        and (apart.status == Status.OPEN).all()
        and np.isnan(apart.quantities["position"]).all()
    )
    # frames before leave nothing behind
    assert (
        whole.possible
        and (whole.status == Status.OK).all()
        and np.isfinite(whole.quantities["position"]).all()
    )


@needs_node
def test_change_points_are_told() -> None:
    program = page_program("parallelogram")
    own = [parameter.value for parameter in program.parameters]
    changed = [1.01 * own[0], *own[1:]]
    with_points, without = page_frames(program, [own, changed])
    assert with_points.signs_change and not without.signs_change
    # both cranks of a parallelogram turn alike, through its change points too
    turning = with_points.quantities["angular_velocity"]
    names = program.data["links"]
    cranks = [
        names.index(link)
        for link in names
        if set(program.data["link_points"][link]) & set(program.data["points"][:2])
    ]
    assert np.abs(turning[:, cranks] - turning[:, cranks[:1]]).max() < 1e-12


@needs_node
def test_a_law_of_time_gives_rates_by_time() -> None:
    program = page_program("wiper")
    own = [parameter.value for parameter in program.parameters]
    (frame,) = page_frames(program, [own])
    motion = ct.motion(program.mechanism)
    assert np.abs(frame.quantities["acceleration"] - motion.acceleration.values).max() < 1e-12


@needs_node
@pytest.mark.parametrize("name", ["six-bar-press", "single-cylinder-engine", "spherical-crank-rocker"])
def test_masses_and_loads_are_reduced_as_by_arrays(name: str) -> None:
    program = page_program(name)
    (frame,) = page_frames(program, [[parameter.value for parameter in program.parameters]])
    reduced = ct.reduce(program.mechanism)
    for quantity in ("reduced_inertia", "reduced_inertia_slope", "reduced_moment"):
        expected = reduced[quantity].values
        assert np.abs(frame.quantities[quantity] - expected).max() <= 1e-14 * max(1.0, np.abs(expected).max())


@needs_node
@pytest.mark.parametrize("name", ["six-bar-press", "single-cylinder-engine", "in-line-four-bar"])
def test_the_balancing_moment_is_that_of_all_reactions(name: str) -> None:
    program = page_program(name)
    (frame,) = page_frames(program, [[parameter.value for parameter in program.parameters]])
    # reactions come from the equations of every link, the page's from those of energy
    expected = ct.reactions(program.mechanism).balancing.values[:, 0]
    assert np.abs(frame.quantities["balancing"] - expected).max() <= 1e-12 * np.abs(expected).max()


TURNED = """
[[loads]]
kind = "torque"
link = "OA"
value = "3 - 0.1 * q"
"""


def turned() -> ct.Mechanism:
    """A load that grows with the angle of the crank, beyond half a turn too."""
    return parse_mechanism(example_text("in-line-four-bar") + TURNED, "turned.toml")


def differences(
    mechanism: ct.Mechanism, frame: PageFrame, there: Array
) -> Iterator[tuple[str, float, float]]:
    """Of each reaction its name, the greatest difference, and what the arrays say of their own rounding."""
    expected = ct.reactions(mechanism)
    assert (expected.reaction_status.values[there] == Status.OK).all()
    names = [name for name in REACTIONS if name in expected and name in frame.quantities]
    greatest = max(float(np.abs(expected[name].values[there]).max()) for name in names)
    bound = float(expected.reaction_loss.values[there].max()) * greatest
    for name in names:
        wanted = expected[name].values[there].reshape(there.sum(), -1)
        found = frame.quantities[name][there].reshape(there.sum(), -1)
        yield name, float(np.abs(found - wanted).max()), bound


@needs_node
@pytest.mark.parametrize(
    "name", ["six-bar-press", "single-cylinder-engine", "in-line-four-bar", "andrews-squeezer", "turned"]
)
def test_reactions_are_those_of_the_arrays(name: str) -> None:
    mechanism = turned() if name == "turned" else ct.example(name)
    program = page_program(mechanism, ranges_of(mechanism))
    random = np.random.default_rng(27)
    own = np.array([parameter.value for parameter in program.parameters])
    span = np.array([parameter.most - parameter.least for parameter in program.parameters])
    cases = [own, *(own + 0.005 * span * random.uniform(-1.0, 1.0, (3, len(own))))]
    paths = [parameter.path for parameter in program.parameters]
    for values, frame in zip(cases, page_frames(program, [case.tolist() for case in cases]), strict=True):
        changed = with_values(mechanism, dict(zip(paths, values.tolist(), strict=True)))
        every = np.ones(len(frame.status), dtype=bool)
        found = {told: (apart, bound) for told, apart, bound in differences(changed, frame, every)}
        assert {"joint_force", "balancing", "frame_force", "frame_moment", "shaking_moment"} <= set(found)
        assert ("guide_moment" in found) == bool(mechanism.guides)
        for told, (apart, bound) in found.items():
            assert apart <= bound, told


@needs_node
def test_reactions_are_absent_beside_change_points() -> None:
    text = re.sub(
        r"^(\[links\.\w+\])$", r"\1\nmass = 1.5\ninertia = 0.3", example_text("parallelogram"), flags=re.M
    )
    mechanism = parse_mechanism(text.replace("\ntitle", "\ngravity = [0.0, -9.81]\ntitle"), "heavy.toml")
    program = page_program(mechanism)
    (frame,) = page_frames(program, [[parameter.value for parameter in program.parameters]])
    absent = np.isnan(frame.quantities["joint_force"]).any(axis=(1, 2))
    drive = np.array(program.data["places"]["parameter"])
    places = np.array([event["drive"] for event in frame.events if event["kind"] == "change point"])
    assert len(places) >= 2
    assert (absent == (np.abs(drive[:, None] - places) < 0.02).any(axis=1)).all() and absent.any()
    assert all(apart <= bound for _name, apart, bound in differences(mechanism, frame, ~absent))


FRICTION = """
[[loads]]
kind = "friction"
guide = "H"
coefficient = 0.1
"""


@pytest.mark.parametrize(
    ("mechanism", "reason"),
    [
        ("spherical-crank-rocker", "sphere"),
        (parse_mechanism(example_text("six-bar-press") + FRICTION, "rubbed.toml"), "friction"),
        ("crank-rocker", ""),
    ],
)
def test_what_reactions_cannot_be_traced_is_left_out_with_a_reason(
    mechanism: MechanismSource, reason: str
) -> None:
    program = page_program(mechanism)
    assert program.data["reactions"] == [] and "reactions: {" not in program.javascript
    assert reason in program.data["reactions_missing"] and bool(reason) == bool(
        program.data["reactions_missing"]
    )


@needs_node
def test_a_kept_assembly_passes_its_change_points() -> None:
    text = re.sub("continuation = .*", 'continuation = "keep"', example_text("parallelogram"))
    program = page_program(parse_mechanism(text, "kept.toml"))
    (frame,) = page_frames(program, [[parameter.value for parameter in program.parameters]])
    motion = ct.motion(program.mechanism)
    assert (frame.status == motion.status.values).all() and not frame.signs_change
    assert np.abs(frame.quantities["position"] - motion.position.values).max() < 1e-13


@needs_node
def test_centrodes_are_those_of_the_program() -> None:
    program = page_program("crank-rocker")
    (frame,) = page_frames(program, [[parameter.value for parameter in program.parameters]])
    curves = ct.centrodes(ct.motion(program.mechanism), "AB")
    fixed, moving = curves.fixed_centrode.values, curves.moving_centrode.values
    # towards infinity rounding grows with the square of the distance
    scale = 1.0 + (np.hypot(*fixed.T) ** 2)[:, None]
    assert np.nanmax(np.abs(frame.centres["AB"][:, :2] - fixed) / scale) < 1e-13
    assert np.nanmax(np.abs(frame.centres["AB"][:, 2:] - moving) / scale) < 1e-13


@needs_node
def test_several_drives_by_tables_have_their_laws() -> None:
    rows = "[[0.0, 0.0], [1.0, 0.9], [2.5, 2.2], [4.0, 4.5], [6.3, 6.0]]"
    text = example_text("five-bar-two-drives").replace(
        "start = 0.0\nspeed = 1.0", f"table = {rows}\nstart = 0.0"
    )
    assert rows in text
    program = page_program(parse_mechanism(text, "tabled.toml"))
    (frame,) = page_frames(program, [[parameter.value for parameter in program.parameters]])
    motion = ct.motion(program.mechanism)
    for quantity in ("position", "velocity", "acceleration"):
        expected = motion[quantity].values
        assert np.abs(frame.quantities[quantity] - expected).max() < 1e-14 * max(1.0, np.abs(expected).max())


@needs_node
def test_an_engine_holds_no_words_that_end_a_script() -> None:
    assert "</" not in page_program("crank-rocker").javascript
