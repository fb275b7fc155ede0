"""Sensitivity: derivatives of what a motion gives by the dimensions of its mechanism.

Derivatives are exact: the motion is an expression of its dimensions, which is differentiated as it stands. At an end of
a stroke the place moves too, and counts for nothing, since the slide's own slope is zero there; at a limit of the drive
the radicand of the group that locks is zero, so dq = -(dr/dp) / (dr/dq) dp.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError, Status
from centrode.kinematics.machine_code.frame_plan import FreeMechanism
from centrode.kinematics.machine_code.trace import Traced, Untraceable, trace_motion
from centrode.kinematics.machine_code.variables import centre_of, inputs_of, winding_of
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.several_inputs.limits import limits
from centrode.kinematics.solve import grid_of, solve
from centrode.locale import _
from centrode.model.cam_files import AnyCam
from centrode.model.examples.catalogue import DescriptionSource, description_of
from centrode.model.files import mechanism_text, value_at
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text
from centrode.numerics.expressions import as_node
from centrode.numerics.graphs import Graph
from centrode.numerics.jets import Jet
from centrode.numerics.scans import evaluate
from centrode.numerics.search import extremes
from centrode.sweeps.designs import PATHS, unit_of
from centrode.sweeps.folds import Folds, Slopes
from centrode.sweeps.outputs import Output, OutputFormula
from centrode.sweeps.solver import Solver, solver
from centrode.sweeps.solver_outputs import LiveColumn
from centrode.tolerances.cam_sensitivity import cam_sensitivity
from centrode.tolerances.dimension_limits import check_paths, length_paths
from centrode.tolerances.limit_gradient import gradient_at_limit
from centrode.tolerances.transmission_formulas import NAME, transmission_formulas, with_transmission_angles
from centrode.version import __version__

Array: TypeAlias = npt.NDArray[np.float64]
Outputs: TypeAlias = str | Sequence[str] | Mapping[str, str]

STROKE, LIMIT = "stroke", "limit"
_WORD = re.compile(r"[^\W\d]\w*")
_ANGLE_ALONE = re.compile(r"(?:(?:min|max|range|mean)\()?\(?atan2\([^;]*\)")
ENDS = ("least", "greatest")
"""limit.least and limit.greatest: the values of the drive between which the mechanism moves."""


def named_outputs(outputs: Outputs) -> dict[str, str]:
    """Name -> what it is, as texts; raises InputError where a text is missing, or given twice."""
    given: object = outputs
    if isinstance(outputs, Mapping):
        texts = dict(outputs)
    elif isinstance(given, Iterable):
        listed = [outputs] if isinstance(outputs, str) else list(outputs)
        texts = {str(text): text for text in listed}
        if len(texts) < len(listed):
            twice = next(text for text in listed if listed.count(text) > 1)
            raise InputError("outputs", _("{name} is given twice").format(name=value_text(twice)))
    else:
        texts = {}
    if not texts or not all(isinstance(x, str) for pair in texts.items() for x in pair):
        raise InputError("outputs", _("no output is given"), _('name one, such as "position.C" or "angle"'))
    return {str(name): str(text) for name, text in texts.items()}


def sensitivity(
    mechanism: DescriptionSource,
    outputs: Outputs,
    by: Sequence[str] | None = None,
    at: npt.ArrayLike | None = None,
    samples: int | None = None,
) -> xr.Dataset:
    """Derivatives of what a motion gives by the dimensions of its mechanism, exact, at every sample and reduced.

    Parameters
    ----------
    outputs : names or formulas
        As those of `solver`: quantities of the motion ("position.B.x", "angle", "velocity.B"), reactions
        ("joint_force.B/AB"), "reduced_inertia", formulas of samples or reduced ("range(position_B_x)"); besides
        "transmission_angle.AB-DB", "stroke.GUIDE" with its true ends between samples, and "limit.least",
        "limit.greatest", the values of the drive between which the mechanism moves. A list, or name -> output. Of a cam
        with a follower "pressure_angle" and "lift", see `cam_sensitivity`.
    by : paths
        Dimensions and masses of links; without them those with a tolerance, or else all lengths.
    at, samples : as those of `motion`

    Returns
    -------
    Dataset
        Each output and `gradient.OUTPUT` with a last dimension `path`, in SI; `value` (path), the number of the
        description, and `unit` (path). `status` (sample) says where a derivative is missing: NaN at limits, at change
        points and where the mechanism is not reached.

    Raises
    ------
    InputError
        An unknown path or output, an output that has no derivative, and as `motion` does.

    Notes
    -----
    Rounding alone: derivatives differ from closed forms by some 1e-13 of their size, more near limits, where they grow
    without bound.

    Examples
    --------
    >>> import centrode as ct
    >>> found = ct.sensitivity("crank-rocker", ["range(angle_DB)"], by=["links.AB.length", "links.DB.length"])
    >>> found["gradient.range(angle_DB)"].dims
    ('path',)
    """
    source = description_of(mechanism)
    if not isinstance(source, Mechanism):
        return cam_sensitivity(source, list(named_outputs(outputs).values()), by, at, samples)
    mechanism = source
    texts = named_outputs(outputs)
    paths = paths_to_differentiate(mechanism, by)
    prepared = ready(mechanism)
    variables: dict[str, Any] = {}
    plain = {name: text for name, text in texts.items() if not is_place(text)}
    moving = differentiated_solver(prepared, paths, plain, at, samples) if plain else None
    if moving is not None:
        found = moving.split(moving.outputs(list(moving.own)))
        slopes = moving.split(moving.gradient(list(moving.own)))
        for (name, text), column in zip(plain.items(), moving.columns, strict=True):
            numbers = found[column.name], slopes[column.name]
            variables |= _variables_of(name, column, text, *numbers)
    for name, text in texts.items():
        if name not in plain:
            value, slope = gradient_at_place(prepared, paths, text, samples)
            unit = "m" if _is_of_length(prepared, text) else "rad"
            described = {"units": unit, "output": text}
            variables[name] = xr.Variable((), value, described)
            variables[f"gradient.{name}"] = xr.Variable(("path",), slope, {"units": unit, "output": text})
    units = [unit_of(mechanism, path) for path in paths]
    variables["value"] = xr.Variable(("path",), [value_at(mechanism, path) for path in paths])
    variables["unit"] = xr.Variable(("path",), units)
    coords: dict[str, Any] = {"path": list(paths)}
    span = grid_of(prepared, samples, None, None, at)
    solved = solve(prepared, span)
    labels = dataset_of(solved)
    dimensions = {str(dim) for one in variables.values() for dim in one.dims}
    coords |= {dim: labels[dim].to_numpy() for dim in sorted(dimensions & set(labels.coords))}
    variables["status"] = xr.Variable(("sample",), solved.status[0])
    coords["parameter"] = ("sample", span.parameter, {"units": prepared.parameter.variable.unit})
    attributes = {
        "topic": "sensitivity",
        "title": mechanism.title,
        "mechanism": mechanism_text(mechanism),
        "version": __version__,
        # a file keeps no order of its variables
        "outputs": "\n".join(texts),
    }
    return xr.Dataset(variables, coords, attrs=attributes)


@dataclass(frozen=True)
class SensitivityResults:
    """A mechanism with the derivatives of what it gives.

    Attributes
    ----------
    mechanism : Mechanism
    data : what `sensitivity` gives of it
    """

    mechanism: Mechanism
    data: xr.Dataset


@dataclass(frozen=True)
class CamSensitivityResults:
    """A cam with the derivatives of its pressure angle and lift; `data` is what `sensitivity` gives of it."""

    cam: AnyCam
    data: xr.Dataset


def sensitivity_results(mechanism: Mechanism, *arguments: Any, **options: Any) -> SensitivityResults:
    """What `sensitivity` gives, with the mechanism."""
    return SensitivityResults(mechanism, sensitivity(mechanism, *arguments, **options))


def cam_sensitivity_results(cam: AnyCam, *arguments: Any, **options: Any) -> CamSensitivityResults:
    """What `sensitivity` gives of a cam, with the cam."""
    return CamSensitivityResults(cam, cam_sensitivity(cam, *arguments, **options))


def paths_to_differentiate(mechanism: Mechanism, by: Sequence[str] | None) -> tuple[str, ...]:
    """The paths that are given, or those with a tolerance, or else all lengths; raises InputError."""
    if by is None:
        settings = mechanism.tolerances
        own = [] if settings is None else list(settings.dimensions)
        paths = own or length_paths(mechanism)
        if not paths:
            raise InputError("by", _("the mechanism has no length to differentiate by"), _("name paths"))
        return tuple(paths[:PATHS])
    given = [by] if isinstance(by, str) else list(by)
    if not 1 <= len(given) <= PATHS:
        raise InputError("by", _("give 1 to {most} different paths").format(most=PATHS))
    check_paths(mechanism, given, "by")
    return tuple(given)


def differentiated_solver(
    prepared: Ready,
    paths: Sequence[str],
    texts: Mapping[str, str],
    at: npt.ArrayLike | None = None,
    samples: int | None = None,
) -> Solver:
    """A solver of these outputs, transmission angles among them."""
    mechanism = prepared.mechanism
    outputs = dict(texts)
    if any(NAME in text for text in texts.values()):
        formulas = transmission_formulas(prepared, paths)
        outputs = {name: with_transmission_angles(text, formulas) for name, text in texts.items()}
        for text in texts.values():
            head, _dot, group = text.partition(".")
            if head == NAME and group not in formulas:
                what = _("group {name} has no transmission angle here").format(name=value_text(group))
                raise InputError("outputs", what, nearest(group, formulas))
    # labels of formulas are letters; what users call the outputs need not be
    labelled = {f"output{number}": text for number, text in enumerate(outputs.values())}
    moving = solver(mechanism, list(paths), samples, at=at, outputs=labelled)
    if moving.without_gradient:
        reason = _(moving.without_gradient)
        what = _("of this mechanism no derivatives by dimensions are computed: {reason}").format(
            reason=reason
        )
        raise InputError(mechanism.title, what, _("compare mechanisms of other dimensions in a sweep"))
    return moving


def _variables_of(
    name: str, column: LiveColumn, text: str, values: Any, slopes: Array
) -> dict[str, xr.Variable]:
    what = column.what
    dimensions = what.dimensions if isinstance(what, Output) else ()
    leading = ("sample", *dimensions) if column.of_samples else ()
    described = {"units": unit_of_column(column), "output": text}
    return {
        name: xr.Variable(leading, values, described),
        f"gradient.{name}": xr.Variable((*leading, "path"), slopes, described),
    }


LINEAR = frozenset({"min", "max", "range", "mean", "abs"})
"""Functions whose value has the unit of what they are of."""


def unit_of_column(column: LiveColumn) -> str:
    """SI unit of an output: that of its quantity; of a formula the common one of what it adds, else "1"."""
    what = column.what
    return str(what.attributes.get("units", "1")) if isinstance(what, Output) else unit_of_formula(what)


def unit_of_formula(formula: OutputFormula) -> str:
    """SI unit of a formula that adds and folds numbers of one unit, or is an angle; "1" of any other."""
    text = formula.text.text
    if _ANGLE_ALONE.fullmatch(text):
        return "rad"
    outputs = [variable.output for variable in formula.variables.values()]
    units = {"1" if output is None else str(output.attributes.get("units", "1")) for output in outputs}
    words = set(_WORD.findall(text)) - set(formula.variables)
    return units.pop() if len(units) == 1 and words <= LINEAR and not set(text) & set("*/^") else "1"


# Outputs that lie at places of their own: ends of strokes, limits of the drive.


def is_place(text: str) -> bool:
    """Whether an output lies at places that are found first: a stroke, or a limit."""
    return text.partition(".")[0] in (STROKE, LIMIT)


def _is_of_length(prepared: Ready, text: str) -> bool:
    if text.startswith(STROKE):
        return prepared.mechanism.space == "plane"
    return prepared.parameter.variable.unit == "m"


def gradient_at_place(
    prepared: Ready, paths: Sequence[str], text: str, samples: int | None = None
) -> tuple[float, Array]:
    """Value and derivatives of "stroke.GUIDE", "limit.least" or "limit.greatest"; raises InputError for another."""
    kind, _dot, name = text.partition(".")
    if kind == STROKE:
        guides = [guide.id for guide in prepared.mechanism.guides]
        if name not in guides:
            what = _("there is no guide {name}").format(name=value_text(name))
            raise InputError("outputs", what, nearest(name, guides))
        return stroke_gradient(prepared, paths, name, samples)
    if name not in ENDS:
        what = _("there is no {word} in {name}").format(word=value_text(name), name=value_text(text))
        raise InputError("outputs", what, nearest(name, ENDS))
    return limit_gradient(prepared, paths, name)


def stroke_gradient(
    prepared: Ready, paths: Sequence[str], guide: str, samples: int | None = None
) -> tuple[float, Array]:
    """Stroke of a slider [m, on the sphere rad] over the motion, between its true ends, and its derivatives.

    NaN where the motion is not reached everywhere.
    """
    span = grid_of(prepared, samples, None, None, None)
    solved = solve(prepared, span)
    column = solved.layout.guides.index(guide)
    blank = np.full(len(paths), np.nan)
    if np.any(solved.status != Status.OK) or prepared.kinematics.path.by_time:
        return float("nan"), blank

    def slides(places: Array, order: int) -> Array:
        return np.asarray(
            solve(prepared, grid_at(prepared.kinematics.path, places)).slides[order, 0, :, column]
        )

    nodes = np.sort(span.parameter)
    found = extremes(lambda x: slides(x, 0), lambda x: slides(x, 1), nodes)
    ends = [found.at_least, found.at_greatest]
    there = solver(prepared.mechanism, list(paths), at=ends, outputs=[f"slide.{guide}"])
    slopes = there.gradient(list(there.own))
    return float(found.range), np.asarray(slopes[1] - slopes[0])


def limit_gradient(prepared: Ready, paths: Sequence[str], end: str) -> tuple[float, Array]:
    """Value of the drive [rad or m] at one end of its way, and the derivatives of this value.

    NaN under a law, and where several groups lock at once. Raises InputError where the drive
    has no such limit, or there are several drives.
    """
    found = limits(prepared.mechanism)
    there = found.low if end == ENDS[0] else found.high
    if there is None or not math.isfinite(there.value):
        what = _("the drive has no limit {name}").format(name=value_text(end))
        raise InputError("outputs", what, _("remove the output"))
    blank = np.full(len(paths), np.nan)
    if not prepared.parameter.is_uniform:
        return there.value, blank
    try:
        slopes = _radicand_gradient(prepared, tuple(paths), there.value)
    except Untraceable:
        slopes = blank
    if np.isnan(slopes).any():
        # no radicand tells the limit of a group of higher class, the constraints do
        try:
            slopes = gradient_at_limit(prepared, paths, there.value)
        except Untraceable:
            return there.value, blank
    return there.value, slopes


def _radicand_gradient(prepared: Ready, paths: tuple[str, ...], limit: float) -> Array:
    """Derivatives of the place at which a radicand is zero; raises Untraceable."""
    span = grid_at(prepared.kinematics.path, np.array([limit]))
    free = FreeMechanism(prepared, span, paths)
    own = [value_at(prepared.mechanism, path) for path in paths]
    varied = free.varied_numbers(own)
    traced = trace_motion(prepared, span, varied, differentiable=True)
    if traced.steps:
        return np.full(len(paths), np.nan)
    values = _values_at(prepared, free, own, traced)
    radicands = {str(k): x for k, x in traced.radicands.items() if isinstance(x, Jet) and x.order}
    sizes = evaluate(Graph.of({name: x.coefficients[0] for name, x in radicands.items()}), values)
    known = {name: abs(float(np.ravel(size)[0])) for name, size in sizes.items()}
    if not known:
        return np.full(len(paths), np.nan)
    # at the limit one radicand is rounding; those of groups behind it are not known
    group = min(known, key=lambda name: math.inf if math.isnan(known[name]) else known[name])
    slopes = Slopes.of(paths, varied, traced, Folds(1), frozenset())
    by_path = slopes.of_node(as_node(radicands[group].coefficients[0]))
    nodes = {"by drive": as_node(radicands[group].coefficients[1])}
    nodes |= {f"by {path}": node for path, node in by_path.items()}
    found = evaluate(Graph(nodes), values)
    slope = float(np.ravel(found["by drive"])[0])
    return np.array([-float(np.ravel(found[f"by {path}"])[0]) / slope for path in paths])


def _values_at(prepared: Ready, free: FreeMechanism, own: Sequence[float], traced: Traced) -> dict[str, Any]:
    """Variables of a trace at the samples."""
    values: dict[str, Any] = dict(free.varied_numbers(own).values(free.dimensions(own)))
    values |= {path: np.array([x]) for path, x in zip(free.paths, own, strict=True)}
    values |= inputs_of(prepared.kinematics.path, free.span)
    solved = solve(prepared, free.span)
    for number, link in enumerate(solved.layout.angles):
        if link in traced.turning:
            # angles of what cannot close are missing at a limit: whole turns move no radicand
            values[centre_of(link)] = np.nan_to_num(solved.angles[0, 0, :, number])
            values |= {winding_of(link, drive): 0.0 for drive in traced.winders}
    return values
