"""Published and independent motions of mechanisms left to themselves, each by two ways."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.integrate
import scipy.special
import xarray as xr

import centrode as ct
from centrode.dynamics.forward_dynamics.free_motion import free_motion_of
from centrode.model.files import with_values
from tools.campaigns.campaign import Campaign, Outcome
from tools.campaigns.free_motions.dense_equations import DenseMechanism
from tools.campaigns.free_motions.examples import parts_of
from tools.validation.rows import REFERENCE

Array = npt.NDArray[np.float64]
Bound = Callable[[float, float], float]
"""(time [s], value) -> the advised tolerance there."""

FOLDER = REFERENCE / "dynamics"
TIGHT = 1e-12
GRAVITY = 9.81
PRINTED = 1e-12
"""Half a unit of the last digit of the tables."""


@dataclass(frozen=True)
class Values:
    """What is known of one thing: values (instants) at times [s], within what is advised."""

    times: Array
    known: Array
    bound: Array


def table(name: str) -> dict[str, Array]:
    """Columns of a table by their heads."""
    with (FOLDER / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {head: np.array([float(row[head]) for row in rows]) for head in rows[0]}


def described(name: str) -> ct.Mechanism:
    """The mechanism of a description in the folder."""
    return ct.parse_mechanism((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))


def angles_of_table(name: str, links: tuple[str, ...], advised: Bound) -> dict[str, Values]:
    """Angles of links that a table has; the bound is no tighter than what the two codes behind it differ by."""
    columns = table(name)
    return {
        link: Values(
            columns["t"],
            columns[link],
            np.array(
                [
                    max(advised(t, value), 3.0 * differ) + PRINTED
                    for t, value, differ in zip(columns["t"], columns[link], columns["differ"], strict=True)
                ]
            ),
        )
        for link in links
    }


def simulated(mechanism: ct.Mechanism, times: Array, equations: str, **changes: Any) -> xr.Dataset:
    """The motion at instants by a route of the program."""
    settings = mechanism.simulation or ct.Simulation(duration=float(times[-1]))
    update = {"tolerance": TIGHT, "equations": equations, "duration": float(times[-1]), **changes}
    return ct.simulate(mechanism, settings.model_copy(update=update), at=times, motion=equations == "reduced")


def dense_angles(mechanism: ct.Mechanism, times: Array, springs: tuple[Any, ...] = ()) -> dict[str, Array]:
    """Angles of links by dense equations in absolute coordinates, from rest."""
    free = free_motion_of(mechanism.with_drives_held())
    start = free.integrate(free.initial(), 1.0, 1e-6, at=[0.0])
    dense = DenseMechanism(
        parts_of(as_masses(mechanism)),
        dict(zip(free.points, start.places[0], strict=True)),
        dict(zip(free.links, start.angles[0], strict=True)),
    )
    dense.add_springs(springs)
    q, v, time = dense.start, np.zeros_like(dense.start), 0.0
    found: dict[str, list[float]] = {link: [] for link in dense.bodies}
    for instant in times:
        q, v = dense.equations.state_at(q, v, float(instant) - time, TIGHT)
        time = float(instant)
        for k, link in enumerate(dense.bodies):
            found[link].append(float(q[3 * k + 2]))
    return {link: np.array(values) for link, values in found.items()}


def as_masses(mechanism: ct.Mechanism) -> ct.Mechanism:
    """Rods of a description with their centre of mass and their inertia as numbers."""
    links = {}
    for name, link in mechanism.links.items():
        assert link.shape == "rod" and link.mass is not None
        ends = np.array(list(link.coordinates.values()))
        length = math.dist(*ends)
        rod = {"centre": tuple(ends.mean(axis=0)), "inertia": link.mass * length**2 / 12.0, "shape": None}
        links[name] = link.model_copy(update=rod)
    return mechanism.model_copy(update={"links": links})


def hold(
    outcome: Outcome, row: str, column: str, found: Mapping[str, Array], known: Mapping[str, Values]
) -> None:
    """Keep the greatest error, and its share of what is advised; `found` may end early, and says so."""
    for name, values in known.items():
        count = len(found[name])
        apart = np.abs(found[name] - values.known[:count])
        if name in links_modulo_a_turn(row):
            apart = np.abs(np.mod(apart + math.pi, math.tau) - math.pi)
        outcome.measure(row, column, float(np.max(apart)))
        outcome.hold(row, f"{column}, share", float(np.max(apart / values.bound[:count])), 1.0)
        if count < len(values.times):
            outcome.fault(f"{row}: {column} ends at {values.times[count - 1]} s")


def links_modulo_a_turn(row: str) -> tuple[str, ...]:
    """Links whose angles a table has modulo a turn."""
    return ("BC", "DC") if row.startswith("change points") else ()


def angles(run: xr.Dataset) -> dict[str, Array]:
    """Angles of the links of a dataset."""
    return {str(link): run["angle"].sel(link=link).values for link in run["link"].values}


ALL, OTHER = "all links", "second way"


def double_pendulum(outcome: Outcome) -> None:
    """Two degrees of freedom, no closure."""
    row, mechanism = "double pendulum; dense equations", described("double-pendulum")
    known = angles_of_table("double-pendulum", ("OA", "AB"), lambda _t, _value: 1e-9)
    times = known["OA"].times
    hold(outcome, row, ALL, angles(simulated(mechanism, times, "multibody")), known)
    hold(outcome, row, OTHER, dense_angles(mechanism, times), known)


def five_bar(outcome: Outcome) -> None:
    """Two degrees of freedom, a loop, a spring."""
    row, mechanism = "five-bar with spring; dense equations", described("five-bar")
    known = angles_of_table("five-bar", ("AB", "BC", "DC", "ED"), lambda _t, _value: 1e-9)
    times = known["AB"].times
    hold(outcome, row, ALL, angles(simulated(mechanism, times, "multibody")), known)
    hold(outcome, row, OTHER, dense_angles(mechanism, times, tuple(mechanism.loads)), known)


def four_bar(outcome: Outcome) -> None:
    """31 turns of a crank with a moment."""
    row, mechanism = "four-bar, 31 turns; reduced equation", described("four-bar-reactions")
    known = angles_of_table("four-bar-reactions", ("AB", "BC", "DC"), lambda _t, _value: 1e-8)
    times = known["AB"].times
    hold(outcome, row, ALL, angles(simulated(mechanism, times, "multibody")), known)
    law = mechanism.model_copy(update={"drives": (mechanism.drives[0].model_copy(update={"speed": 1.0}),)})
    hold(outcome, row, OTHER, angles(simulated(law, times, "reduced")), known)


def through_limits(outcome: Outcome) -> None:
    """A double rocker whose drive turns back."""
    row, mechanism = "through limits; dense equations", described("through-limits")
    known = angles_of_table(
        "through-limits", ("AB", "BC", "DC"), lambda t, _value: 1e-9 if t <= 1.0 else 1e-8
    )
    times = known["AB"].times
    hold(outcome, row, ALL, angles(simulated(mechanism, times, "multibody")), known)
    hold(outcome, row, OTHER, dense_angles(mechanism, times), known)


def change_points(outcome: Outcome) -> None:
    """All links in line, four times."""
    row, mechanism = "change points; reduced equation", described("change-points")
    known = angles_of_table("change-points", ("AB", "BC", "DC"), lambda _t, _value: 1e-8)
    times = known["AB"].times
    for column, equations in ((ALL, "multibody"), (OTHER, "reduced")):
        hold(outcome, row, column, angles(simulated(mechanism, times, equations)), known)


def on_the_sphere(outcome: Outcome) -> None:
    """A spherical four-bar."""
    row, mechanism = "spherical four-bar; reduced equation", described("spherical-four-bar-free")
    columns = table("spherical-four-bar-free")
    bound = np.maximum(1e-9, 3.0 * columns["differ"]) + PRINTED
    known = {name: Values(columns["t"], columns[name], bound) for name in ("AB", "C_x", "C_y", "C_z")}
    law = mechanism.model_copy(update={"drives": (mechanism.drives[0].model_copy(update={"speed": 1.0}),)})
    for column, equations, one in ((ALL, "multibody", mechanism), (OTHER, "reduced", law)):
        run = simulated(one, columns["t"], equations)
        found = {"AB": np.ravel(run["drive_value"].values)}
        place = run["position"].sel(point="C").values
        found |= {f"C_{axis}": place[:, k] for k, axis in enumerate("xyz")}
        hold(outcome, row, column, found, known)


def andrews(outcome: Outcome, start: float) -> None:
    """Andrews' mechanism (A03): a table, and the quadrature of its energy from another start."""
    mechanism = squeezer(start)
    if start == HANDBOOK:
        row = "Andrews' mechanism, table; reduced equation"
        known = angles_of_table(
            "andrews",
            ("OF", "EF", "BE", "GE", "AG", "HE", "AH"),
            lambda t, value: 1e-9 * max(1.0, abs(value)) if t <= 0.03 else 1e-8,
        )
    else:
        row = "A03 of IFToMM; reduced equation"
        crank = np.array(
            [2.153381340199014167181026, 8.178115005483415436431968, 15.80017467066272021171045,
             24.36806492575054854642924, 33.81534072136017377697757]
        )  # fmt: skip
        # a thousand-millionth of a metre at F, 7 mm from the axis
        times = np.array([0.01, 0.02, 0.03, 0.04, 0.05])
        known = {"OF": Values(times, crank, np.full(5, 1e-9 / 0.007))}
    times = known["OF"].times
    hold(outcome, row, ALL, angles(simulated(mechanism, times, "multibody")), known)
    law = mechanism.model_copy(update={"drives": (mechanism.drives[0].model_copy(update={"speed": 1.0}),)})
    hold(outcome, row, OTHER, angles(simulated(law, times, "reduced", speed=0.0)), known)


HANDBOOK, LIBRARY = -0.0617138900142764496358948458001, -0.0620
"""Angles at which its crank begins."""


def squeezer(start: float) -> ct.Mechanism:
    """Andrews' mechanism with its spring and its moment, the crank at an angle [rad]."""
    geometry = ct.example("andrews-squeezer")
    loads = (
        '\n[[loads]]\nkind = "spring"\npoints = ["D", "C"]\nstiffness = 4530\nfree_length = 0.07785\n'
        '[[loads]]\nkind = "torque"\nlink = "OF"\nvalue = 0.033\n'
    )
    placed = ct.motion(geometry, at=[start])
    turned = {
        f"links.{name}.angle": float(placed.angle.sel(link=name)[0])
        for name in geometry.links
        if name != "OF"
    }
    whole = ct.parse_mechanism(ct.mechanism_text(geometry.model_copy(update={"simulation": None})) + loads)
    return with_values(whole, {"drives.OF.start": start, **turned})


def pendulum(outcome: Outcome) -> None:
    """A01: a mass in one point."""
    row, mechanism = "A01 of IFToMM; reduced equation", described("pendulum")
    times = np.array([0.5, 1.0, 5.0, 9.99, 10.0])
    modulus = 0.5
    quarter = scipy.special.ellipk(modulus)
    sn = scipy.special.ellipj(quarter - math.sqrt(GRAVITY) * times, modulus)[0]
    theta = -2.0 * np.arcsin(math.sqrt(modulus) * sn)
    bound = np.full(len(times), 1e-9)
    known = {"x": Values(times, np.sin(theta), bound), "y": Values(times, -np.cos(theta), bound)}
    place = simulated(mechanism, times, "multibody")["position"].sel(point="A").values
    hold(outcome, row, ALL, {"x": place[:, 0], "y": place[:, 1]}, known)
    place = simulated(driven_pendulum(), times, "reduced")["position"].sel(point="A").values
    hold(outcome, row, OTHER, {"x": place[:, 0], "y": place[:, 1]}, known)


def driven_pendulum() -> ct.Mechanism:
    """The same with a drive: in absolute coordinates a mass in one point has no inertia about it."""
    return ct.Mechanism(
        gravity=[0.0, -GRAVITY],
        frame={"points": {"O": [0.0, 0.0]}},
        links={"OA": {"length": 1.0, "mass": 1.0, "centre": "A", "inertia": 0.0}},
        drives=[{"link": "OA", "start": math.pi, "speed": 1.0}],
    )


def long_pendulum(outcome: Outcome) -> None:
    """A01 over 844 swings."""
    times = np.array([2000.0])
    known = {
        "x": Values(times, np.array([0.81460306858903215212]), np.array([1e-6])),
        "y": Values(times, np.array([-0.58001882783693546159]), np.array([1e-6])),
    }
    for column, equations, mechanism in (
        (ALL, "multibody", described("pendulum")),
        (OTHER, "reduced", driven_pendulum()),
    ):
        place = simulated(mechanism, times, equations, tolerance=1e-13)["position"].sel(point="A").values
        found = {"x": place[:, 0], "y": place[:, 1]}
        hold(outcome, "A01 at 2000 s; reduced equation", column, found, known)


def chain_of_squares(loops: int) -> ct.Mechanism:
    """IFToMM's A02: bars of 1 m and 1 kg, upright and level, side by side; the first joint at 1 m/s."""
    rod = {"mass": 1.0, "shape": "rod"}
    links: dict[str, Any] = {}
    for k in range(loops + 1):
        links[f"A{k}B{k}"] = {**rod, "points": {f"A{k}": [0, 0], f"B{k}": [1, 0]}, "angle": math.pi / 2}
    for k in range(loops):
        links[f"B{k}B{k + 1}"] = {**rod, "points": {f"B{k}": [0, 0], f"B{k + 1}": [1, 0]}, "angle": 0.0}
    return ct.Mechanism(
        gravity=[0.0, -GRAVITY],
        frame={"points": {f"A{k}": [float(k), 0.0] for k in range(loops + 1)}},
        links=links,
        simulation={"duration": 20.0, "speeds": {"points": {"B0": [1.0, 0.0]}}},
    )


def position_of_squares(loops: int, times: npt.ArrayLike) -> Array:
    """Where their first joint B0 is (times, 2): all uprights turn as one pendulum, whose equation SciPy solves."""
    instants = np.atleast_1d(np.asarray(times, dtype=np.float64))
    inertia, weight = (loops + 1) / 3 + loops, ((loops + 1) / 2 + loops) * GRAVITY
    angle = scipy.integrate.solve_ivp(
        lambda _t, y: [y[1], weight / inertia * math.sin(y[0])],
        (0.0, float(instants[-1])),
        [0.0, 1.0],
        method="DOP853",
        t_eval=instants,
        rtol=3e-14,
        atol=1e-15,
    ).y[0]
    return np.column_stack([np.sin(angle), np.cos(angle)])


def squares(outcome: Outcome, loops: int) -> None:
    """A02: loops of bars side by side; all uprights turn as one pendulum."""
    times = np.linspace(0.0, 20.0, 201)
    place_of_b0 = position_of_squares(loops, times)
    bound = np.full(len(times), 1e-9 if loops <= 2 else 1e-6)
    known = {axis: Values(times, place_of_b0[:, k], bound) for k, axis in enumerate("xy")}
    tolerance = 1e-13 if loops <= 2 else TIGHT
    place = (
        simulated(chain_of_squares(loops), times, "multibody", tolerance=tolerance)["position"]
        .sel(point="B0")
        .values
    )
    row = f"A02 of IFToMM, {loops} loop{'s' if loops > 1 else ''}; closed form"
    hold(outcome, row, ALL, {"x": place[:, 0], "y": place[:, 1]}, known)
    # elliptic functions of 25 digits beside the pendulum's equation by SciPy
    exact = {
        1: (10.0, 0.4783850577609705590053952, 0.8781501787912093011639041),
        2: (10.0, 0.3284581115408153786521642, 0.9445185381786009621612854),
        40: (20.0, 0.4109011537629452221452456, 0.9116799009719806516314131),
    }
    time, x, y = exact[loops]
    at = int(np.argmin(np.abs(times - time)))
    apart = math.dist(place_of_b0[at], (x, y))
    outcome.measure(row, OTHER, apart)
    outcome.hold(row, f"{OTHER}, share", apart / bound[at], 1.0)


CASES: tuple[Callable[[Outcome], None], ...] = (
    double_pendulum,
    five_bar,
    four_bar,
    through_limits,
    change_points,
    on_the_sphere,
    lambda outcome: andrews(outcome, HANDBOOK),
    lambda outcome: andrews(outcome, LIBRARY),
    pendulum,
    long_pendulum,
    lambda outcome: squares(outcome, 1),
    lambda outcome: squares(outcome, 2),
    lambda outcome: squares(outcome, 40),
)


def run(_seed: int, number: int) -> Outcome:
    """One reference."""
    outcome = Outcome(subject=str(number))
    CASES[number](outcome)
    return outcome


CAMPAIGN = Campaign(
    name="free-references",
    title="References of free motions",
    about=(
        "Motions that others have published, or that two codes without a formula in common have computed "
        "(`tests/reference/dynamics`), each by the equations of all links at a tolerance of 1e-12 (A01 at 2000 s and "
        "A02 with one and two loops: 1e-13) and by a second way, which the row names: the reduced equation of the "
        "drive, dense equations in absolute coordinates, or a closed form. A01 to A03 are problems of IFToMM's library "
        "of benchmarks; the tests are those of `tests/dynamics/test_free_motions.py`."
    ),
    columns={
        ALL: "greatest error at the instants of the reference [rad; of A01, A02 and places on the sphere m]",
        f"{ALL}, share": "the same over what is advised at that instant; at most 1",
        OTHER: "greatest error of the second way",
        f"{OTHER}, share": "the same over what is advised; at most 1",
    },
    run=run,
    cases=len(CASES),
)
