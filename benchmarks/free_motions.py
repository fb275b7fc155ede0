"""Forward dynamics beside MuJoCo: integration alone, whole motions, many mechanisms, forty loops."""

from __future__ import annotations

import functools
import math
import os
import subprocess
import sys
import time
from collections.abc import Iterator

import mujoco
import numpy as np
from tools.campaigns.free_motions.references import (
    LIBRARY,
    chain_of_squares,
    position_of_squares,
    squeezer,
)

import centrode as ct
from benchmarks.table import Promise, Row
from benchmarks.timing import best_clock_times
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion, free_motion_of
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.numerics.machine_code import cache

CRANK, COUPLER, ROCKER, BASE = 0.3, 0.8, 0.6, 0.9
START, SPEED, MOMENT, DURATION = math.pi / 3, 10.0, 0.1, 10.0
LANES, LOOPS = 10_000, 40
SQUEEZED, TURNED = 0.05, 33.81534072136017377697757
"""Duration of A03 [s], and the angle of its crank then [rad] by quadrature of the energy to 25 digits."""
STEP, SOLREF = 2.5e-5, 2e-4
"""MuJoCo's step [s] and time constant of a closure [s], with which its energy errs by some 3e-7 J."""


def _rod(length: float) -> dict[str, object]:
    return {"length": length, "mass": length, "shape": "rod"}


def four_bar() -> FreeMotion:
    """A four-bar linkage of rods, 1 kg/m, with 0.1 N m on its crank."""
    mechanism = ct.Mechanism(
        gravity=[0.0, -9.81],
        frame={"points": {"A": [0.0, 0.0], "D": [BASE, 0.0]}},
        links={"AB": _rod(CRANK), "BC": _rod(COUPLER), "DC": _rod(ROCKER)},
        drives=[{"link": "AB", "start": START, "speed": 1.0}],
        assembly={"sides": {"C": "left"}},
        loads=[{"kind": "torque", "link": "AB", "value": MOMENT}],
    )
    return free_motion_of(mechanism)


FRESH = """
import sys, time
begun = time.perf_counter()
import xarray
import centrode as ct
mechanism = ct.example("double-pendulum")
loaded = time.perf_counter()
if sys.argv[1:]:
    sys.modules["dask"] = None
ct.simulate(mechanism)
simulated = time.perf_counter()
ct.simulate(mechanism)
print(loaded - begun, simulated - loaded, time.perf_counter() - simulated)
"""


def _fresh_process(*words: str) -> tuple[float, float, float]:
    """Times [s] of a new process for xarray and a description, for its first simulation, and for the next."""
    told = [
        subprocess.run(
            [sys.executable, "-c", FRESH, *words], capture_output=True, encoding="utf-8", check=True
        )
        for _round in range(3)
    ]
    loaded, first, again = zip(*(map(float, one.stdout.split()) for one in told), strict=True)
    return min(loaded), min(first), min(again)


def free_motions() -> Iterator[Row]:
    """Times by the clock, best of several."""
    settings = ct.Simulation(
        equations="multibody", speed=SPEED, duration=DURATION, tolerance=3e-9, samples=401
    )
    # libraries are loaded, kernels are not: nothing is kept on disk here
    ct.simulate(ct.example("double-pendulum"))
    free = four_bar()
    kept = os.environ.get(cache.FOLDER)
    os.environ[cache.FOLDER] = ""
    begun = time.perf_counter()
    ct.simulate(free.mechanism, settings)
    first = time.perf_counter() - begun
    if kept is None:
        del os.environ[cache.FOLDER]
    else:
        os.environ[cache.FOLDER] = kept
    start = free.initial({"links.AB": SPEED})
    tolerance = 3e-9
    course = free.integrate(start, DURATION, tolerance)
    error = float(np.max(np.abs(course.energy_residual)))
    # the steps alone, without what is found out before and after
    rate = free.integration.rate(start)
    state = np.concatenate([[0.0, 0.01 / rate, 0.0, 0.0], free.integration.carried_values(start)])[:, None]
    rows = np.empty((4096, len(free.integration.problem.carried_names) + 1))
    kernel, numbers = free.integration.integrator(), free.integration.parameters(DURATION, tolerance, rate)
    times = best_clock_times(
        {
            "steps": functools.partial(kernel.run, numbers, state, 1_000_000, rows),
            "whole": functools.partial(ct.simulate, free.mechanism, settings),
        },
        rounds=5,
    )
    seconds, theirs = _mujoco(start.coordinates, start.speeds)
    ratio = seconds / times["steps"]
    yield Row(
        "four-bar, 10 s",
        {
            "steps [ms]": 1e3 * times["steps"],
            "whole [ms]": 1e3 * times["whole"],
            "first [ms]": 1e3 * first,
            "MuJoCo / steps": ratio,
            "energy error [J]": error,
            "MuJoCo's [J]": theirs,
        },
        promises=[
            Promise("steps of the four-bar [ms]", 1e3 * times["steps"], at_most=3.0),
            Promise("ct.simulate of the four-bar, warm [ms]", 1e3 * times["whole"], at_most=20.0),
            Promise("ct.simulate of the four-bar, first call [ms]", 1e3 * first, at_most=300.0),
            Promise("MuJoCo's time over the steps'", ratio, at_least=1500.0),
            Promise("energy error over MuJoCo's", error / theirs, at_most=1.0),
        ],
    )
    taken, apart = _andrews()
    yield Row(
        "A03, 0.05 s",
        {"steps [ms]": 1e3 * taken, "F off [m]": apart},
        promises=[
            Promise("steps of A03 [ms]", 1e3 * taken, at_most=1.0),
            Promise("position of F of A03 [m]", apart, at_most=1e-9),
        ],
    )
    # what a process loads for it: modules of the package, llvmlite, and dask, which xarray imports where it is there
    for name, words in (("without dask", ("without dask",)), ("with dask", ())):
        loaded, simulated, again = _fresh_process(*words)
        yield Row(
            f"double pendulum in a new process, {name}",
            {
                "xarray and description [ms]": 1e3 * loaded,
                "first simulation [ms]": 1e3 * simulated,
                "next [ms]": 1e3 * again,
            },
        )
    random = np.random.default_rng(1)
    lengths = {
        f"links.{link}.length": length * (1.0 + 0.01 * random.standard_normal(LANES).clip(-2.0, 2.0))
        for link, length in (("AB", CRANK), ("BC", COUPLER), ("DC", ROCKER))
    }
    settings = ct.Simulation(equations="multibody", speed=SPEED, duration=DURATION, tolerance=1e-6)
    many = functools.partial(ct.simulate, free.mechanism, settings, vary=lengths, threads=2)
    worst = float(many().attrs["worst_energy_residual"])
    taken = best_clock_times({"many": many}, rounds=7)["many"]
    yield Row(
        f"{LANES} four-bars, 10 s, two threads",
        {"[s]": taken, "energy error [J]": worst},
        promises=[
            Promise(f"{LANES} four-bars by ct.simulate, two threads [s]", taken, at_most=1.0),
            Promise("their energy error [J]", worst, at_most=1e-4),
        ],
    )
    chain = free_motion_of(chain_of_squares(LOOPS))
    upright = chain.initial({"points.B0": (1.0, 0.0)})
    begun = time.perf_counter()
    chain.integration.explicit_steps(upright, 1.0, 1e-12)
    built = time.perf_counter() - begun
    taken = best_clock_times(
        {"chain": functools.partial(chain.integration.explicit_steps, upright, 20.0, 1e-12)}, rounds=1
    )["chain"]
    apart = _distance_from_closed_form(chain, upright)
    yield Row(
        f"A02, {LOOPS} loops, 20 s, 20 change points",
        {"[s]": taken, "first [s]": built, "B0 off [m]": apart},
        promises=[
            Promise(f"A02 with {LOOPS} loops [s]", taken, at_most=2.0),
            Promise(f"position of B0 with {LOOPS} loops over 20 s [m]", apart, at_most=1e-6),
        ],
    )


def _andrews() -> tuple[float, float]:
    """Time [s] of the steps of IFToMM's A03, and how far F is from the quadrature of its energy at 0.05 s [m]."""
    free = free_motion_of(squeezer(LIBRARY).with_drives_held())
    start = free.initial()
    rate = free.integration.rate(start, SQUEEZED)
    state = np.concatenate(
        [[0.0, min(SQUEEZED, 0.01 / rate), 0.0, 0.0], free.integration.carried_values(start)]
    )[:, None]
    rows = np.empty((4096, len(free.integration.problem.carried_names) + 1))
    kernel, numbers = free.integration.integrator(), free.integration.parameters(SQUEEZED, 1e-8, rate)
    taken = best_clock_times(
        {"steps": functools.partial(kernel.run, numbers, state, 1_000_000, rows)}, rounds=20
    )["steps"]
    angle = free.integrate(start, SQUEEZED, 1e-8, at=[SQUEEZED]).angles[0, free.links.index("OF")]
    return taken, 0.007 * abs(float(angle) - TURNED)


def _distance_from_closed_form(chain: FreeMotion, upright: InitialState) -> float:
    """Greatest distance of B0 [m] over 20 s from the rotating pendulum that all uprights are."""
    instants = np.linspace(0.0, 20.0, 201)
    course = chain.integrate(upright, 20.0, 1e-12, at=instants)
    if course.ended != "duration":
        return math.inf
    places = course.places[:, chain.points.index("B0")]
    return float(np.max(np.linalg.norm(places - position_of_squares(LOOPS, instants), axis=1)))


def _mujoco(coordinates: np.ndarray, speeds: np.ndarray) -> tuple[float, float]:
    """MuJoCo's time [s] for the four-bar linkage, and how far its energy goes astray [J]."""
    model = mujoco.MjModel.from_xml_string(_model())
    data = mujoco.MjData(model)
    model.eq_data[0, :6] = [COUPLER, 0.0, 0.0, ROCKER, 0.0, 0.0]
    crank, rocker, coupler = coordinates
    data.qpos[:] = [crank, coupler - crank, rocker]
    data.qvel[:] = [speeds[0], speeds[2] - speeds[0], speeds[1]]
    data.ctrl[0] = MOMENT
    mujoco.mj_forward(model, data)
    began = _energy(data)
    worst, parts = 0.0, 20
    begun = time.perf_counter()
    for _part in range(parts):
        mujoco.mj_step(model, data, round(DURATION / STEP) // parts)
        worst = max(worst, abs(_energy(data) - began))
    return time.perf_counter() - begun, worst


def _model() -> str:
    def rod(length: float) -> str:
        moment = length**3 / 12.0
        return f'<inertial pos="{length / 2} 0 0" mass="{length}" diaginertia="1e-9 {moment} {moment}"/>'

    return f"""<mujoco><option timestep="{STEP}" integrator="RK4" gravity="0 -9.81 0" iterations="50" tolerance="1e-14"
><flag contact="disable"/></option><worldbody>
<body><joint name="crank" axis="0 0 1"/>{rod(CRANK)}
<body name="BC" pos="{CRANK} 0 0"><joint axis="0 0 1"/>{rod(COUPLER)}</body></body>
<body name="DC" pos="{BASE} 0 0"><joint axis="0 0 1"/>{rod(ROCKER)}</body></worldbody>
<actuator><motor joint="crank"/></actuator>
<equality><connect body1="BC" body2="DC" anchor="{COUPLER} 0 0" solref="{SOLREF} 1"
solimp=".9999 .9999 .001"/></equality>
</mujoco>"""


def _energy(data: mujoco.MjData) -> float:
    crank, turned, rocker = data.qpos
    angles = (crank, crank + turned, rocker)
    rates = (data.qvel[0], data.qvel[0] + data.qvel[1], data.qvel[2])
    pin = CRANK * np.array([math.cos(crank), math.sin(crank)])
    way = CRANK * rates[0] * np.array([-math.sin(crank), math.cos(crank)])
    total = -MOMENT * crank
    for length, angle, rate, at, speed in zip(
        (CRANK, COUPLER, ROCKER), angles, rates, (np.zeros(2), pin, np.array([BASE, 0.0])),
        (np.zeros(2), way, np.zeros(2)), strict=True,
    ):  # fmt: skip
        along = np.array([math.cos(angle), math.sin(angle)])
        velocity = speed + 0.5 * length * rate * np.array([-along[1], along[0]])
        total += 0.5 * length * float(velocity @ velocity) + length**3 / 24.0 * rate * rate
        total += length * 9.81 * float(at[1] + 0.5 * length * along[1])
    return float(total)
