"""Friction by coefficients against closed forms: journals, wedges, drawers that tilt, friction circles."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from mechanisms import EPS, link, point
from newton_euler import vector

Array = npt.NDArray[np.float64]
ROUNDINGS = 512
"""Roundings on the way from a description to one force, in units of the greatest force."""


def close(found: Any, wanted: Any, size: float, loss: Any = 1.0) -> None:
    assert np.max(abs(np.asarray(found) - np.asarray(wanted))) <= ROUNDINGS * EPS * size * np.max(loss)


def statuses(found: xr.Dataset) -> list[int]:
    return [int(status) for status in found.reaction_status.to_numpy()]


@pytest.mark.parametrize(
    ("fit", "factor"), [("clearance", 1.0), ("new", math.pi / 2), ("worn-in", 4 / math.pi)]
)
@pytest.mark.parametrize("speed", [3.0, -3.0])
def test_a_journal_under_a_weight(fit: str, factor: float, speed: float) -> None:
    """The pin bears the weight whatever the angle, and the moment is mu r W against the turning."""
    weight, arm, radius, mu = 50.0, 0.4, 0.03, 0.2
    crank = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": arm}},
        drives=[{"link": "OA", "speed": speed}],
        loads=[
            {"kind": "force", "point": "A", "vector": [0, -weight]},
            {"kind": "friction", "point": "O", "coefficient": mu, "radius": radius, "fit": fit},
        ],
    )
    found = ct.reactions(crank, 13)
    angle = found.drive_value.to_numpy()[:, 0]
    resisting = factor * mu * radius * weight
    close(found.friction_moment.sel(bearing="O/OA"), -resisting * np.sign(speed), weight)
    close(found.balancing[:, 0], weight * arm * np.cos(angle) + resisting * np.sign(speed), weight)
    close(found.friction_power[:, 0], resisting * abs(speed), weight)
    close(found.friction_work, resisting * 2 * math.pi, weight)
    # over a turn the weight takes nothing: all that the drive gives is lost
    close(found.attrs["efficiency"], 0.0, weight / resisting)


def wedge(angle: float, mus: tuple[float, float, float], speed: float = 1.0) -> ct.Mechanism:
    """A block of 100 N between vertical guides, on the slope of a wedge that a drive pushes along the ground."""
    slope, side, ground = mus
    return ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"wedge": {"points": {"W": [0, 0]}}, "block": {"points": {"P": [0, 0]}}},
        guides=[
            {"point": "W", "on": "frame", "through": "O", "direction": [-1, 0], "link": "wedge", "angle": 0},
            {"point": "P", "on": "wedge", "through": [0, 0], "name": "slope",
             "direction": [math.cos(angle), math.sin(angle)]},
            {"point": "P", "on": "frame", "through": [-1, 0], "name": "side", "direction": [0, 1],
             "link": "block", "angle": 0},
        ],
        drives=[{"guide": "W", "speed": speed}],
        loads=[
            {"kind": "force", "point": "P", "vector": [0, -100]},
            {"kind": "friction", "guide": "slope", "coefficient": slope},
            {"kind": "friction", "guide": "side", "coefficient": side},
            {"kind": "friction", "guide": "W", "coefficient": ground},
        ],
    )  # fmt: skip


@pytest.mark.parametrize("mus", [(0.1, 0.0, 0.0), (0.1, 0.2, 0.15), (0.0, 0.3, 0.0)])
@pytest.mark.parametrize("angle", [0.3, 0.8, 1.2])
def test_a_wedge_lifts(angle: float, mus: tuple[float, float, float]) -> None:
    slope, side, ground = mus
    found = ct.reactions(wedge(angle, mus), 3, 1.2, 1.4)
    sine, cosine = math.sin(angle), math.cos(angle)
    push = sine + slope * cosine  # horizontal part of the force between wedge and block, over its normal part
    up = cosine - slope * sine
    normal = 100.0 / (up - side * push)
    wanted = normal * push + ground * normal * up
    close(abs(found.guide_normal.sel(guide="slope")), normal, 100.0, normal)
    close(found.balancing[:, 0], wanted, 100.0, normal)
    ideal = 100.0 * math.tan(angle)
    close(found.efficiency, ideal / wanted, 1.0, normal)
    if not (side or ground):
        close(found.balancing[:, 0], 100 * math.tan(angle + math.atan(slope)), 100.0, normal)
    assert not found.self_locking.any()


def test_a_wedge_that_jams() -> None:
    """No force lifts the block once the slope exceeds 90 degrees less the angles of friction."""
    mu = 0.2
    rho = math.atan(mu)
    for angle, jams in ((math.pi / 2 - rho - 1e-3, False), (math.pi / 2 - rho + 1e-3, True)):
        found = ct.reactions(wedge(angle, (mu, 0.0, 0.0)), 3, 1.2, 1.4)
        status = ct.Status.SELF_LOCKING if jams else ct.Status.OK
        assert statuses(found) == [status] * 3
        assert found.self_locking.to_numpy().tolist() == [2 if jams else 0] * 3
        assert bool(np.isnan(found.balancing).all()) is jams
        assert bool(np.isnan(found.joint_force).all()) is jams or not found.sizes["side"]
    # friction at the side guide jams it at less: 90 degrees less both angles
    for angle, jams in ((math.pi / 2 - 2 * rho - 1e-3, False), (math.pi / 2 - 2 * rho + 1e-3, True)):
        found = ct.reactions(wedge(angle, (mu, mu, 0.0)), 3, 1.2, 1.4)
        assert statuses(found) == [ct.Status.SELF_LOCKING if jams else ct.Status.OK] * 3


def test_a_wedge_that_the_weight_drives_back() -> None:
    """With slopes above the angle of friction the weight pushes the wedge out; below, the drive has to pull."""
    mu = 0.2
    rho = math.atan(mu)
    for angle in (rho + 0.1, rho - 0.1):
        found = ct.reactions(wedge(angle, (mu, 0.0, 0.0), -1.0), 3, 1.2, 1.4)
        close(found.balancing[:, 0], 100 * math.tan(angle - rho), 100.0)
        held = angle < rho
        assert found.self_locking.to_numpy().tolist() == [int(held)] * 3
        assert statuses(found) == [ct.Status.OK] * 3
        close(found.efficiency, 0.0 if held else math.tan(angle - rho) / math.tan(angle), 1.0)


def drawer(length: float | None, eccentric: float, mu: float, height: float | None = None) -> ct.Mechanism:
    """A drawer pulled against 10 N by a pin that moves in its cross slot, `eccentric` beside its guide."""
    friction: dict[str, Any] = {"kind": "friction", "guide": "S", "coefficient": mu}
    friction |= {key: v for key, v in (("length", length), ("height", height)) if v is not None}
    return ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"puller": {"points": {"D": [0, 0]}}, "drawer": {"points": {"S": [0, 0]}}},
        guides=[
            {"point": "D", "on": "frame", "through": [0, eccentric], "direction": [1, 0], "link": "puller"},
            {"point": "S", "on": "frame", "through": "O", "direction": [1, 0], "link": "drawer"},
            {"point": "D", "on": "drawer", "name": "slot", "through": [0, 0], "direction": [0, 1]},
        ],
        drives=[{"guide": "D", "speed": 0.5}],
        loads=[{"kind": "force", "guide": "S", "value": -10}, friction],
    )


@pytest.mark.parametrize("eccentric", [0.3, -0.3])
def test_a_drawer_that_tilts(eccentric: float) -> None:
    """Two contacts bear N = F e / l each: F = Q / (1 - 2 mu e / l), and jams from l = 2 mu e down."""
    mu = 0.25
    for length in (1.0, 0.4, 2 * mu * 0.3 + 1e-3):
        share = 1 - 2 * mu * abs(eccentric) / length
        found = ct.reactions(drawer(length, eccentric, mu), 3, 0.1, 0.2)
        close(found.balancing[:, 0], 10 / share, 10 / share, 1 / share)
        close(found.friction_force.sel(guide="S"), 10 - 10 / share, 10 / share, 1 / share)
        close(found.efficiency, share, 1.0, 1 / share)
    jammed = ct.reactions(drawer(2 * mu * 0.3 - 1e-3, eccentric, mu), 3, 0.1, 0.2)
    assert statuses(jammed) == [ct.Status.SELF_LOCKING] * 3
    assert math.isnan(jammed.attrs["efficiency"])
    # without a length only the normal force counts, and there is none
    close(ct.reactions(drawer(None, eccentric, mu), 3, 0.1, 0.2).balancing, 10.0, 10.0)


def test_the_arm_of_friction_in_a_high_slider() -> None:
    """A slider of 40 N on its lower face, pulled along the line: friction below it tilts it forwards."""
    mu, height, length = 0.3, 0.2, 0.5
    parts: dict[str, Any] = {
        "links": {"sled": {"points": {"S": [0, 0]}}},
        "frame": {"points": {"O": [0, 0]}},
        "guides": [{"point": "S", "on": "frame", "through": "O", "direction": [1, 0], "link": "sled"}],
    }
    friction = {"kind": "friction", "guide": "S", "coefficient": mu, "length": length, "height": height}
    loads = [{"kind": "force", "point": "S", "vector": [0, -40]}, friction]
    for speed in (1.0, -1.0):
        sled = ct.Mechanism(**parts, drives=[{"guide": "S", "speed": speed}], loads=loads)
        found = ct.reactions(sled, 3, 0.0, 1.0)
        # what both ends press with balances the moment mu N h / 2; both still bear on the lower face
        close(found.balancing[:, 0], mu * 40 * speed, 40.0)
        close(found.guide_normal, 40.0, 40.0)
        close(found.guide_moment, 0.0, 40.0)  # all that the guide does, friction in it
        close(found.guide_force[:, 0, 0], -mu * 40 * speed, 40.0)


@pytest.mark.parametrize("eccentric", [1.2, -1.2, 0.05])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_high_drawer_by_its_two_contacts(eccentric: float, sense: float) -> None:
    """Forces of both ends on lower or upper face, put on the drawer one by one, with 40 N on it."""
    mu, length, height, pull, weight = 0.2, 0.8, 0.5, 10.0, 40.0
    one = drawer(length, eccentric, mu, height)
    loads = [
        {"kind": "force", "guide": "S", "value": -pull * sense},
        {"kind": "force", "point": "S", "vector": [0, -weight]},
        {"kind": "friction", "guide": "S", "coefficient": mu, "length": length, "height": height},
    ]
    parts = {name: getattr(one, name) for name in ("frame", "links", "guides", "assembly")}
    machine = ct.Mechanism(**parts, drives=[{"guide": "D", "speed": 0.5 * sense}], loads=loads)
    found = ct.reactions(machine, 3, 0.1, 0.2)
    force = sense * pull
    for _round in range(200):  # each round leaves less than two thirds of the error

        def moment(first: float, second: float, force: float = force) -> float:
            """About S: the pin's force, then both contacts at x = -l/2 and l/2 with friction on their faces."""
            total = -eccentric * force
            for place, normal in ((-length / 2, first), (length / 2, second)):
                face = -math.copysign(height / 2, normal)
                total += place * normal - face * (-sense * mu * abs(normal))
            return total

        # straight in N_2 - N_1 at N_1 + N_2 = W, whatever the faces
        zero, unit = moment(weight / 2, weight / 2), moment(weight / 2 - 1, weight / 2 + 1)
        apart = -zero / (unit - zero)
        first, second = weight / 2 - apart, weight / 2 + apart
        assert abs(moment(first, second)) < 1e-12 * weight
        force = sense * (pull + mu * (abs(first) + abs(second)))
    assert (first * second < 0) is (abs(eccentric) > 1.0)
    close(found.balancing[:, 0], force, 64 * abs(force))
    close(found.guide_normal.sel(guide="S"), weight, 64 * abs(force))


L, R = 0.35, 0.1
CRANK = {
    "frame": {"points": {"O": [0, 0]}},
    "links": {"OA": {"length": R}, "AB": {"length": L}, "piston": {"points": {"B": [0, 0]}}},
    "guides": [{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "piston"}],
    "assembly": {"sides": {"B": "ahead"}},
}
CIRCLES = {"O": 0.006, "A": 0.005, "B": 0.004}
"""Radii of friction circles [m]: coefficient times radius of the pin."""
MU = 0.12


def rubbing(scale: float = 1.0) -> list[dict[str, Any]]:
    hinges = [
        {"kind": "friction", "point": point, "coefficient": scale * 0.2, "radius": circle / 0.2}
        for point, circle in CIRCLES.items()
    ]
    return [*hinges, {"kind": "friction", "guide": "B", "coefficient": scale * MU}]


def line_of_rod(motion: xr.Dataset, pushes: Any) -> tuple[Any, Any, Any, Any, Any]:
    """Unit force of the rod on the crank, tangent to both friction circles; moments there over that force; v of B.

    `pushes` is 1 where the rod is pressed, -1 where it is pulled.
    """
    a, b = point(motion, "A"), point(motion, "B")
    rod, crank = (link(motion, name, "angular_velocity") for name in ("AB", "OA"))
    at_a, at_b = np.sign(rod - crank) * CIRCLES["A"], np.sign(rod) * CIRCLES["B"]
    # moments of friction on the rod, -at_a - at_b, and l x force balance: the force leans from the rod by their arm
    lean = np.arcsin((at_a + at_b) / L)
    unit = (a - b) / L
    force = pushes * unit * np.exp(-1j * np.where(pushes > 0, 1.0, -1.0) * lean)
    return force, a, at_a, -np.sign(crank) * CIRCLES["O"], point(motion, "B", "velocity").real


@pytest.mark.parametrize("push", [-800.0, 800.0])
def test_a_slider_crank_by_friction_circles(push: float) -> None:
    """The crank works against a force on the piston: friction in three hinges and in the slider."""
    loads = [{"kind": "force", "guide": "B", "value": push}, *rubbing()]
    machine = ct.Mechanism(**CRANK, drives=[{"link": "OA", "speed": 7.0}], loads=loads)
    turn: dict[str, Any] = {"samples": 121, "start": 0.02, "stop": 2 * math.pi - 0.02}
    found, motion = ct.reactions(machine, **turn), ct.motion(machine, **turn)
    force, a, at_a, at_o, speed = line_of_rod(motion, -np.sign(push))
    # on the piston: push, minus what the rod gives the crank, friction against its speed
    size = push / (force.real + np.sign(speed) * MU * abs(force.imag))
    wanted = -size * ((np.conj(a) * force).imag + at_a + at_o)
    good = found.reaction_status.to_numpy() == 0
    assert good.sum() > 110
    assert (size[good] > 0).all()
    loss = 1 / np.min(abs(force.real))
    close(vector(found.joint_force.sel(side="A/OA"))[good], (size * force)[good], 800.0, loss)
    close(found.balancing[:, 0].to_numpy()[good], wanted[good], 800.0, loss)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_piston_does_not_start_the_crank_at_its_dead_point(side: str) -> None:
    """Where the line between the friction circles passes within that of the crank's pin, no force turns it."""
    angles = np.linspace(0.005, 1.5, 300)
    places = R * np.cos(angles) + np.sqrt(L**2 - (R * np.sin(angles)) ** 2)
    torque = -5.0 if side == "left" else 5.0  # against the turning of the crank
    machine = ct.Mechanism(
        **{**CRANK, "assembly": {"sides": {"A": side}}},
        drives=[{"guide": "B", "start": float(places[-1]), "speed": -0.4}],
        loads=[{"kind": "torque", "link": "OA", "value": torque}, *rubbing()],
    )
    found, motion = ct.reactions(machine, at=places), ct.motion(machine, at=places)
    sense = np.sign(link(motion, "OA", "angular_velocity"))
    assert (sense == -np.sign(torque)).all()
    force, a, at_a, at_o, _speed = line_of_rod(motion, 1.0)
    arm = sense * ((np.conj(a) * force).imag + at_a + at_o)  # of the rod's force, less the friction circles
    locked = found.reaction_status.to_numpy() == ct.Status.SELF_LOCKING
    assert 20 < locked.sum() < 100
    assert (locked == (arm <= 0)).all()
    size = 5.0 / arm[~locked]
    wanted = -size * (abs(force.real) + MU * abs(force.imag))[~locked]
    # the arm is a difference of lengths as long as the rod, and friction feeds on what it makes greater
    close(found.balancing[:, 0].to_numpy()[~locked] / wanted, 1.0, 1.0, (np.max(size) * L / 5.0) ** 2)


def test_small_friction_is_straight_in_the_coefficients() -> None:
    def given(scale: float) -> Array:
        loads = [{"kind": "force", "guide": "B", "value": -800.0}, *rubbing(scale)]
        machine = ct.Mechanism(**CRANK, drives=[{"link": "OA", "speed": 7.0}], loads=loads)
        return np.asarray(ct.reactions(machine, at=np.linspace(0.3, 6.0, 23)).balancing[:, 0])

    none, small, twice = given(0.0), given(1e-6), given(2e-6)
    first = small - none
    assert (first > 0).all()
    # the rest is of second order: the square of a share 1e-6, times the few forces it feeds on
    assert np.max(abs(twice - none - 2 * first)) <= 100 * 1e-12 * np.max(abs(none)) + 100 * EPS * 80
