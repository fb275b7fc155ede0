"""One number of a whole motion with its derivatives by free dimensions: what an improvement reduces or keeps.

A measure is a formula of the solver's outputs, or one of a few words for what no formula says: the time ratio of an
output, how much it moves while the crank passes a range, the unevenness of a machine. Their derivatives follow from
those of the outputs, which the kernels give exactly.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.steady_motion.steady import solution_of
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.reading import value_text
from centrode.model.units import read_quantity

Array: TypeAlias = npt.NDArray[np.float64]
Numbers: TypeAlias = Mapping[str, Array]
Compute: TypeAlias = Callable[[Array, Array, Numbers, Numbers], tuple[float, Array]]
"""(values of the drive, times, outputs, their derivatives) -> the number and its derivatives (free,)."""

_CALL = re.compile(r"\s*(\w+)\s*\((.*)\)\s*")
RATES = {"angle": "angular", "slide": "slide", "position": ""}


@dataclass(frozen=True)
class Measure:
    """One number of a motion.

    Attributes
    ----------
    text : as it was written
    outputs : name -> formula that the solver computes for it
    compute : from these outputs
    unit : SI unit, empty where a formula leaves it open
    """

    text: str
    outputs: Mapping[str, str]
    compute: Compute
    unit: str = ""


def measure_of(mechanism: Mechanism, text: object, where: str, number: int) -> Measure:
    """The measure that a text names; `number` keeps its outputs apart from those of others.

    Raises InputError: not a text, a word with the wrong arguments. Formulas are read by the solver.
    """
    if not isinstance(text, str) or not text.strip():
        what = _("expected a formula such as {example}, got {value}")
        raise InputError(where, what.format(example='"range(angle_DB)"', value=value_text(text)))
    plain = text.strip()
    call = _CALL.fullmatch(plain)
    word = call[1] if call else plain
    arguments = [part.strip() for part in call[2].split(",")] if call else []
    if word == "stroke" and len(arguments) == 1:
        return replace(_formula(text, f"range({arguments[0]})", number), unit=_unit_of(arguments[0]))
    if word == "reaction" and len(arguments) == 1:
        side = re.sub(r"\W", "_", arguments[0])
        size = f"max(sqrt(joint_force_{side}_x^2 + joint_force_{side}_y^2))"
        return replace(_formula(text, size, number), unit="N")
    if plain == "shaking_force":
        return replace(_formula(text, "max(sqrt(shaking_force_x^2 + shaking_force_y^2))", number), unit="N")
    if word == "time_ratio" and len(arguments) == 1:
        return _time_ratio(text, arguments[0], where, number)
    if word == "dwell" and len(arguments) == 3:
        return _dwell(text, arguments, where, number)
    if plain == "unevenness":
        return _unevenness(mechanism, text, where, number)
    if word in ("stroke", "reaction", "time_ratio", "dwell") and call:
        examples = "stroke(slide_H), reaction(B/AB), time_ratio(slide_H), dwell(slide_H, 90 deg, 150 deg)"
        what = _("{name} is not written so").format(name=word)
        raise InputError(where, what, _("as in {example}").format(example=examples))
    return _formula(text, plain, number)


def _formula(text: str, formula: str, number: int) -> Measure:
    name = f"measure_{number}"

    def compute(places: Array, times: Array, values: Numbers, slopes: Numbers) -> tuple[float, Array]:
        return float(values[name]), np.ravel(slopes[name])

    return Measure(text, {name: formula}, compute)


def _unit_of(output: str) -> str:
    return "rad" if output.startswith(("angle", "joint_angle")) else "m"


def _rates_of(output: str, where: str) -> tuple[str, str]:
    """Formulas of the velocity and the acceleration of an output of a motion."""
    kind, _between, rest = output.partition("_")
    if kind not in RATES or not rest:
        what = _("{name} is no angle, slide or position").format(name=value_text(output))
        raise InputError(where, what, _("as in {example}").format(example="time_ratio(slide_H)"))
    prefix = f"{RATES[kind]}_" if RATES[kind] else ""
    return f"{prefix}velocity_{rest}", f"{prefix}acceleration_{rest}"


def _time_ratio(text: str, output: str, where: str, number: int) -> Measure:
    """Slow to fast stroke by the places at which the velocity vanishes.

    Between samples the velocity is the cubic of its values and slopes there. Where it vanishes at phi, phi moves by
    -(dv/dp)/(dv/dphi) with a dimension p.
    """
    first, second = f"measure_{number}_v", f"measure_{number}_a"
    velocity, acceleration = _rates_of(output, where)

    def compute(places: Array, times: Array, values: Numbers, slopes: Numbers) -> tuple[float, Array]:
        speed, rate, by, rate_by = values[first], values[second], slopes[first], slopes[second]
        none = np.full(by.shape[-1], np.nan)
        cells = np.flatnonzero(speed[:-1] * speed[1:] < 0)
        if len(cells) != 2:
            return math.nan, none
        # derivatives by the place, of a drive that turns evenly
        step = places[1] - places[0]
        pace = (times[1] - times[0]) / step
        zeros, moves = [], []
        for k in cells.tolist():
            ends = np.array([speed[k], step * pace * rate[k], speed[k + 1], step * pace * rate[k + 1]])
            part = _vanishing_part(ends)
            weights, weight_slopes = hermite(part)
            its = np.stack([by[k], step * pace * rate_by[k], by[k + 1], step * pace * rate_by[k + 1]])
            zeros.append(places[k] + step * part)
            moves.append(-step * (weights @ its) / float(weight_slopes @ ends))
        turn = places[-1] - places[0]
        way, move = abs(zeros[1] - zeros[0]), (moves[1] - moves[0]) * np.sign(zeros[1] - zeros[0])
        whole = abs(turn)
        ratio = way / (whole - way)
        slope = move * whole / (whole - way) ** 2
        return (float(ratio), slope) if ratio >= 1 else (float(1 / ratio), -slope / ratio**2)

    return Measure(text, {first: velocity, second: acceleration}, compute, "1")


def hermite(part: float | Array) -> tuple[Array, Array]:
    """Weights of value, slope, value, slope at the ends of a cell, and their derivatives by the part."""
    t = part
    weights = np.array([1 - 3 * t**2 + 2 * t**3, t - 2 * t**2 + t**3, 3 * t**2 - 2 * t**3, t**3 - t**2])
    slopes = np.array([6 * t**2 - 6 * t, 1 - 4 * t + 3 * t**2, 6 * t - 6 * t**2, 3 * t**2 - 2 * t])
    return weights, slopes


def _vanishing_part(ends: Array) -> float:
    """Where the cubic of a cell vanishes; its ends have different signs."""
    low, high = 0.0, 1.0
    for _halving in range(60):
        middle = (low + high) / 2
        if float(hermite(middle)[0] @ ends) * ends[0] > 0:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def _dwell(text: str, arguments: list[str], where: str, number: int) -> Measure:
    """How far an output moves while the crank goes from one angle to the other."""
    name = f"measure_{number}"
    low, high = (read_quantity(angle, "angle", where) for angle in arguments[1:])
    if not 0 < high - low < 2 * math.pi:
        raise InputError(where, _("a dwell lies between two angles less than a turn apart"))

    def compute(places: Array, times: Array, values: Numbers, slopes: Numbers) -> tuple[float, Array]:
        within = np.flatnonzero(np.mod(places[:-1] - low, 2 * math.pi) <= high - low)
        numbers = [values[name][within]]
        by = [slopes[name][within]]
        for end in (low, high):
            # the ends lie between samples of a motion that repeats itself
            cell = np.mod((end - places[0]) * np.sign(places[1] - places[0]), 2 * math.pi)
            cell /= abs(places[1] - places[0])
            k = min(int(cell), len(places) - 2)
            part = cell - k
            numbers.append((1 - part) * values[name][k : k + 1] + part * values[name][k + 1 : k + 2])
            by.append((1 - part) * slopes[name][k : k + 1] + part * slopes[name][k + 1 : k + 2])
        number, slope = np.concatenate(numbers), np.concatenate(by)
        most, least = int(np.argmax(number)), int(np.argmin(number))
        return float(np.ptp(number)), slope[most] - slope[least]

    return Measure(text, {name: arguments[0]}, compute, _unit_of(arguments[0]))


def _unevenness(mechanism: Mechanism, text: str, where: str, number: int) -> Measure:
    """Greatest less least speed to the mean speed, by the energy of a turn with a constant driving moment.

    The energy at a sample is E + W, W the work of the loads and the mean moment since the start. With J the reduced
    inertia the speed is sqrt(2 (E + W)/J); E follows from half of greatest plus least, which is the mean speed.
    """
    machine = mechanism.machine
    if machine is None:
        what = _("unevenness is that of a machine")
        raise InputError(where, what, _("add [machine] with a mean_speed"))
    # with the flywheel that the machine has or needs: it stays while dimensions change
    shafts = float(solution_of(mechanism, "middle").speed.inertia)
    mean = float(machine.mean_speed)
    moment, inertia = f"measure_{number}_m", f"measure_{number}_j"

    def compute(places: Array, times: Array, values: Numbers, slopes: Numbers) -> tuple[float, Array]:
        torque, mass = values[moment], values[inertia] + shafts
        work, work_by = (_work_of_moment(places, x) for x in (torque, slopes[moment]))
        energy = 0.5 * mean * mean * float(mass.mean())
        for _iteration in range(50):
            square = 2 * (energy + work) / mass
            if not (square > 0).all():
                return math.nan, np.full(work_by.shape[-1], np.nan)
            speed = np.sqrt(square)
            most, least = int(np.argmax(speed)), int(np.argmin(speed))
            miss = (speed[most] + speed[least]) / 2 - mean
            gain = (1 / (mass[most] * speed[most]) + 1 / (mass[least] * speed[least])) / 2
            energy -= miss / gain
            if abs(miss) < 1e-13 * mean:
                break
        # of the speed without the change of E, which is what keeps the mean speed
        by = (work_by - 0.5 * (speed**2)[:, None] * slopes[inertia]) / (mass * speed)[:, None]
        per_energy = 1 / (mass * speed)
        energy_by = -(by[most] + by[least]) / (per_energy[most] + per_energy[least])
        ends = [by[k] + per_energy[k] * energy_by for k in (most, least)]
        return float(speed[most] - speed[least]) / mean, (ends[0] - ends[1]) / mean

    return Measure(text, {moment: "reduced_moment", inertia: "reduced_inertia"}, compute, "1")


def _work_of_moment(places: Array, torque: Array) -> Array:
    """Work of a moment less its mean over a turn, by the trapezoidal rule: of a period it converges like a series."""
    step = places[1] - places[0]
    first = np.zeros((1, *torque.shape[1:]))
    mean = torque[:-1].mean(axis=0)
    parts = 0.5 * step * (torque[:-1] + torque[1:] - 2 * mean)
    return np.concatenate([first, np.cumsum(parts, axis=0)])
