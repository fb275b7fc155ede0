"""Parameter studies: how extremes of a machine's motion, its flywheel or its reactions depend on what varies.

Of each mechanism the whole analysis is computed, as the functions of that name do it, and its single numbers are kept:
extremes, where they lie, means, the coefficient of fluctuation.
"""

from __future__ import annotations

import functools
import importlib
import json
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import nan, prod
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import CentrodeError, InputError
from centrode.locale import _, speaking
from centrode.model.files import kind_at, mechanism_text, parse_mechanism, with_values
from centrode.model.mechanism import Mechanism
from centrode.model.placement import replace_placed
from centrode.model.reading import nearest, value_text
from centrode.model.units import KINDS
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.text_formula import TextFormula, compile_formula
from centrode.sweeps.clusters import ClusterSource, open_cluster, wanted_libraries
from centrode.sweeps.designs import Design, Grid, Sample, design_of
from centrode.sweeps.outputs import identifier
from centrode.version import __version__

Numbers: TypeAlias = Mapping[str, tuple[float, str]]
"""Name of a number -> its value and its SI unit."""
Progress: TypeAlias = Callable[[int, int], None]

MOST_MECHANISMS = 10_000
"""Mechanisms of one study: each takes some tenths of a second."""
PLACE = "_at"
"""What ends the name of the place of an extreme: `least_speed_at` belongs to `least_speed`."""
STATUS, REFUSAL = "computed", "refusal"

# each analysis loads what it needs, integrators among it, when it is computed
_regimes = functools.partial(importlib.import_module, "centrode.dynamics.simulation.steady_state")
_routes = functools.partial(importlib.import_module, "centrode.dynamics.simulation.routes")
_motions = functools.partial(importlib.import_module, "centrode.dynamics.simulation.simulate")
_numbers = functools.partial(importlib.import_module, "centrode.dynamics.simulation.motion_numbers")
_simulations = functools.partial(importlib.import_module, "centrode.dynamics.simulation.results")
_speeds = functools.partial(importlib.import_module, "centrode.dynamics.steady_motion.steady")
_machines = functools.partial(importlib.import_module, "centrode.dynamics.steady_motion.machine")
_flywheels = functools.partial(importlib.import_module, "centrode.dynamics.steady_motion.flywheel")
_bearings = functools.partial(importlib.import_module, "centrode.dynamics.bearings.results")


# The numbers of one mechanism.


def _extremes_of_simulation(mechanism: Mechanism, samples: int | None) -> Numbers:
    """Of the steady regime that a simulation runs up to; by the equations of all links, of the motion itself."""
    settings = mechanism.simulation
    if settings is not None and _routes().equations_for(mechanism, settings) == _routes().MULTIBODY:
        if samples is not None:
            settings = settings.model_copy(update={"samples": samples, "at": ()})
        found: Numbers = _numbers().motion_numbers(_motions().simulate(mechanism, settings))
        return found
    regime = _regimes().steady_regime(mechanism)
    return {
        "least_speed": (regime.least_speed, "rad/s"),
        "least_speed_at": (regime.least_at, "rad"),
        "greatest_speed": (regime.greatest_speed, "rad/s"),
        "greatest_speed_at": (regime.greatest_at, "rad"),
        "mean_speed": (regime.mean_speed, "rad/s"),
        "fluctuation": (regime.fluctuation, "1"),
        "driving_moment": (regime.driving_moment, "N m"),
        "period": (regime.time, "s"),
        "multiplier": (regime.multiplier, "1"),
    }


def _steady(mechanism: Mechanism, _samples: int | None) -> Numbers:
    """Of the steady motion at a given mean speed; places are angles turned from the initial position."""
    solution = _speeds().solution_of(mechanism)
    speed = solution.speed.extremes()
    return {
        "least_speed": (speed.least, "rad/s"),
        "least_speed_at": (speed.at_least, "rad"),
        "greatest_speed": (speed.greatest, "rad/s"),
        "greatest_speed_at": (speed.at_greatest, "rad"),
        "mean_speed": (solution.speed.mean("time"), "rad/s"),
        "fluctuation": (2.0 * (speed.greatest - speed.least) / (speed.greatest + speed.least), "1"),
        "inertia": (solution.speed.inertia, "kg m^2"),
    }


def _flywheel(mechanism: Mechanism, _samples: int | None) -> Numbers:
    """Of the flywheel; what belongs to a fluctuation that is not given is absent."""
    found = _flywheels().flywheel(mechanism)
    wheel = found.rim
    numbers = {
        "energy_least": (found.energy_least, "J"),
        "energy_least_at": (found.least_at, "rad"),
        "energy_greatest": (found.energy_greatest, "J"),
        "energy_greatest_at": (found.greatest_at, "rad"),
        "driving_moment": (found.driving_moment, "N m"),
        "least_speed": (found.least_speed, "rad/s"),
        "greatest_speed": (found.greatest_speed, "rad/s"),
        "fluctuation": (found.obtained, "1"),
        "inertia_first_order": (found.inertia_first_order, "kg m^2"),
        "inertia": (found.inertia, "kg m^2"),
        "added": (found.added, "kg m^2"),
        "rim_diameter": (None if wheel is None else wheel.outer, "m"),
        "rim_mass": (None if wheel is None else wheel.mass, "kg"),
    }
    return {name: (nan if value is None else value, unit) for name, (value, unit) in numbers.items()}


def _reactions(mechanism: Mechanism, samples: int | None) -> Numbers:
    """Greatest and least of each reaction over the motion, and where; balancing moments among them."""
    place = mechanism.motion_parameter.instant.unit
    numbers: dict[str, tuple[float, str]] = {}
    for load in _bearings().reaction_results(mechanism, samples).loads or ():
        numbers |= {
            f"greatest_{load.key}": (load.greatest, load.unit),
            f"greatest_{load.key}{PLACE}": (load.at_greatest, place),
            f"least_{load.key}": (load.least, load.unit),
            f"least_{load.key}{PLACE}": (load.at_least, place),
        }
    return numbers


ANALYSES: Mapping[str, Callable[[Mechanism, int | None], Numbers]] = {
    "simulate": _extremes_of_simulation,
    "steady_motion": _steady,
    "flywheel": _flywheel,
    "reactions": _reactions,
}
"""What is computed of each mechanism, by the name of the function that computes it."""


RESULTS: Mapping[str, Callable[[Mechanism], Any]] = {
    "simulate": lambda mechanism: _simulations().simulation_results(mechanism),
    "steady_motion": lambda mechanism: _machines().machine_results(mechanism),
    "flywheel": lambda mechanism: _machines().machine_results(mechanism),
    "reactions": lambda mechanism: _bearings().reaction_results(mechanism),
}
"""What computes all of an analysis, with what its files and figures show."""


def study_numbers(mechanism: Mechanism, compute: str, samples: int | None = None) -> Numbers:
    """The single numbers of an analysis of one mechanism: name -> value and SI unit.

    Parameters
    ----------
    compute : "simulate", "steady_motion", "flywheel" or "reactions"
    samples : of the motion; of use to reactions only

    Raises
    ------
    InputError, MotionError
        As the function of that name; another name.
    """
    return ANALYSES[check_analysis(compute)](mechanism, samples)


def analysis_results(mechanism: Mechanism, compute: str) -> Any:
    """The whole result of an analysis of one mechanism; raises as `study_numbers`."""
    return RESULTS[check_analysis(compute)](mechanism)


def check_analysis(compute: object) -> str:
    """The name of an analysis; InputError where there is none of that name."""
    if not isinstance(compute, str) or compute not in ANALYSES:
        what = _("unknown analysis {name}").format(name=value_text(compute))
        raise InputError("compute", what, nearest(str(compute), ANALYSES))
    return compute


# Numbers that follow from those that vary.


def dependent_formulas(
    mechanism: Mechanism, paths: Sequence[str], dependent: Mapping[str, str]
) -> dict[str, TextFormula]:
    """Path -> formula of the values that vary [SI], which stand in it as `links_AB_length`.

    Raises InputError: a path that is none or that varies itself, a text that is no formula of these values.
    """
    names = tuple(identifier(path) for path in paths)
    formulas = {}
    for path, text in dependent.items():
        where = f"dependent {path}"
        try:
            kind_at(mechanism, path)
        except InputError as error:
            raise InputError(where, error.what, error.repair) from None
        if path in paths:
            raise InputError(where, _("it varies itself"), _("omit it in one of the two places"))
        if not isinstance(text, str):
            raise InputError(
                where, _("a formula is a text"), _("such as {example}").format(example=f'"2*{names[0]}"')
            )
        formulas[path] = compile_formula(text, names, where)
    return formulas


def _rows(
    design: Design, formulas: Mapping[str, TextFormula]
) -> Iterator[tuple[dict[str, float], dict[str, float]]]:
    """Values that vary and values that follow, of each mechanism."""
    columns = design.rows(0, prod(design.shape))
    for k in range(prod(design.shape)):
        varied = {path: float(values[k]) for path, values in columns.items()}
        given = {identifier(path): value for path, value in varied.items()}
        with np.errstate(all="ignore"):
            yield varied, {path: float(formula(ARRAYS, **given)) for path, formula in formulas.items()}


# The study.


@dataclass(frozen=True)
class ParameterStudy:
    """A parameter study.

    Attributes
    ----------
    mechanism : the one whose numbers vary
    data : what `parameter_study` gives of it
    """

    mechanism: Mechanism
    data: xr.Dataset


def parameter_study(
    mechanism: Mechanism,
    vary: Mapping[str, Any] | Grid | Sample,
    compute: str,
    outputs: Sequence[str] | str | None = None,
    samples: int | None = None,
    dependent: Mapping[str, str] | None = None,
    progress: Progress | None = None,
    cluster: ClusterSource = None,
) -> xr.Dataset:
    """The single numbers of an analysis for many mechanisms of one structure; see `sweep` for its arguments.

    Returns
    -------
    Dataset
        Dimensions of the mechanisms. A variable for each number, with its unit; `computed` (1, or 0 of a mechanism
        whose analysis is refused: its numbers are NaN) and `refusal`, why. Values that vary are coordinates, those
        that follow from them variables, by their paths.

    Raises
    ------
    InputError
        As `sweep`; an unknown analysis or number.
    """
    check_analysis(compute)
    design = design_of(mechanism, vary, dimensions_only=False)
    count = prod(design.shape)
    if count > MOST_MECHANISMS:
        what = _("{count} mechanisms are given").format(count=count)
        raise InputError("vary", what, _("give at most {most}").format(most=MOST_MECHANISMS))
    formulas = dependent_formulas(mechanism, tuple(design.coordinates), dependent or {})
    rows = list(_rows(design, formulas))
    followed = [following for _varied, following in rows]
    given = [varied | following for varied, following in rows]
    answers = (
        (_answer(mechanism, compute, samples, row) for row in given)
        if cluster is None
        else _on_cluster(mechanism, compute, samples, given, cluster)
    )
    found: list[Numbers] = []
    refusals: list[str] = []
    # what a dataset holds in words is English
    with speaking("en"):
        for numbers, refusal in answers:
            found.append(numbers)
            refusals.append(refusal)
            if progress is not None:
                progress(len(found), count)
    variables = {
        path: _of_designs(design, [row[path] for row in followed], {"units": _unit(mechanism, path)})
        for path in formulas
    }
    variables |= _numbers_of_studies(design, found, outputs)
    variables[STATUS] = _of_designs(design, np.array([not refusal for refusal in refusals], dtype=np.int8))
    variables[REFUSAL] = _of_designs(design, np.array(refusals, dtype=str))
    coordinates = {
        path: (dimension, values, {"units": _unit(mechanism, path)})
        for path, (dimension, values) in design.coordinates.items()
    }
    attributes = {
        "topic": "parameter-study",
        "title": mechanism.title,
        "mechanism": mechanism_text(mechanism),
        "version": __version__,
        "compute": compute,
        "dependent": "; ".join(f"{path} = {text}" for path, text in (dependent or {}).items()),
    }
    return xr.Dataset(variables, coordinates, attributes)


def _of_designs(
    design: Design, values: npt.ArrayLike, attributes: Mapping[str, str] | None = None
) -> tuple[Any, ...]:
    """A variable with a value for each mechanism of a design, as xarray takes it."""
    return design.dimensions, np.reshape(values, design.shape), dict(attributes or {})


def _numbers_of_studies(
    design: Design, found: Sequence[Numbers], outputs: Sequence[str] | str | None
) -> dict[str, Any]:
    """Variables of the numbers that are wanted; NaN where a mechanism has none."""
    units = {name: unit for numbers in found for name, (_value, unit) in numbers.items()}
    return {
        name: _of_designs(
            design,
            [numbers[name][0] if name in numbers else nan for numbers in found],
            {"units": units[name]},
        )
        for name in _chosen(units, outputs)
    }


def _answer(
    mechanism: Mechanism, compute: str, samples: int | None, values: Mapping[str, float]
) -> tuple[Numbers, str]:
    """The numbers of one mechanism, or why its analysis is refused."""
    try:
        return study_numbers(with_study_values(mechanism, values), compute, samples), ""
    except CentrodeError as refused:
        return {}, str(refused)


# On a cluster: a worker is told the description, the analysis and the values as text.

_one_at_a_time = threading.Lock()
_parsed = functools.lru_cache(maxsize=4)(parse_mechanism)


def numbers_of_text(text: str) -> tuple[Numbers, str]:
    """The numbers of the mechanism that a text describes, or why its analysis is refused, in English."""
    told = json.loads(text)
    # the language is that of the process
    with _one_at_a_time, speaking("en"):
        return _answer(_parsed(told["mechanism"]), told["compute"], told["samples"], told["values"])


def _on_cluster(
    mechanism: Mechanism,
    compute: str,
    samples: int | None,
    rows: Sequence[Mapping[str, float]],
    cluster: ClusterSource,
) -> Iterator[tuple[Numbers, str]]:
    """Numbers and refusals in the order of the rows, as they are there."""
    told = {"mechanism": mechanism_text(mechanism), "compute": compute, "samples": samples}
    texts = ((k, json.dumps({**told, "values": dict(row)})) for k, row in enumerate(rows))
    early: dict[int, tuple[Numbers, str]] = {}
    following = 0
    with open_cluster(cluster) as workers:
        for k, (numbers, refusal) in workers.answers(
            numbers_of_text, texts, wanted_libraries(machine_code=True)
        ):
            early[k] = {name: (value, unit) for name, (value, unit) in numbers.items()}, refusal
            while following in early:
                yield early.pop(following)
                following += 1


def with_study_values(mechanism: Mechanism, values: Mapping[str, float]) -> Mechanism:
    """The mechanism of one row of a study; what was placed is placed anew."""
    return replace_placed(with_values(mechanism, values))


def _unit(mechanism: Mechanism, path: str) -> str:
    """SI unit of the number at a path, as results spell it."""
    kind = KINDS.get(kind_at(mechanism, path))
    return (kind.unit if kind is not None else "").replace("*", " ") or "1"


def _chosen(known: Mapping[str, str], outputs: Sequence[str] | str | None) -> Sequence[str]:
    """Names of the numbers that are kept: those of `outputs`, all if there are none."""
    names = [outputs] if isinstance(outputs, str) else list(outputs or ())
    for name in names:
        # where every analysis was refused no number is known, and the refusals say why
        if known and name not in known:
            what = _("there is no number {name}").format(name=value_text(name))
            raise InputError("outputs", what, nearest(str(name), known))
    return [name for name in names if name in known] or list(known)
