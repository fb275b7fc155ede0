"""Accuracy of a mechanism: worst cases, statistics, play and assembly within the limits of its dimensions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import grid_of, solve
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.tolerances import Limits, ToleranceOutput
from centrode.printed_results import PrintsSummary
from centrode.sweeps.designs import unit_of
from centrode.sweeps.outputs import identifier
from centrode.tolerances.assembly_in_limits import AssemblyInLimits, first_stop
from centrode.tolerances.clearances import ClearanceExtent, clearance_extents
from centrode.tolerances.deviated_mechanisms import DeviatedMechanisms, Evaluated
from centrode.tolerances.dimension_limits import DimensionLimits, limits_of
from centrode.tolerances.joint_play import play_of
from centrode.tolerances.sensitivity import Outputs, named_outputs
from centrode.tolerances.statistical import (
    DrawnOutput,
    Propagated,
    draw_deviations,
    drawn_outputs,
    propagated_output,
)
from centrode.tolerances.worst_case import (
    ALL_CORNERS,
    Extent,
    TrueExtent,
    corners_of,
    linear_extent,
    true_extents,
)

Array: TypeAlias = npt.NDArray[np.float64]
Bounds: TypeAlias = Mapping[str, Limits | float]

DRAWS = 10_000
"""Mechanisms that are drawn where nothing else is said."""
MOST_DRAWS = 10_000_000
AT_ONCE = 2_000_000
"""Mechanisms that are drawn and computed together, so that memory is bounded."""


@dataclass(frozen=True)
class OutputAccuracy:
    """How far one output deviates.

    Attributes
    ----------
    name, text : of the output, and what it is
    unit : SI unit; "1" where a formula has none
    of_samples : whether it has a number of every sample
    nominal : of the description [SI]: one number, or (samples,)
    gradient : (..., paths) derivatives by the numbers
    linear, true : worst cases
    statistics : to first order
    drawn : of drawn mechanisms; None where none moves
    within : least and greatest value that it may have [SI], numbers or (samples,); None without bounds
    clearance : by the play in joints; None where there is none
    """

    name: str
    text: str
    unit: str
    of_samples: bool
    nominal: Array
    gradient: Array
    linear: Extent
    true: TrueExtent
    statistics: Propagated
    drawn: DrawnOutput | None
    within: tuple[Array, Array] | None
    clearance: ClearanceExtent | None

    @cached_property
    def worst(self) -> int:
        """The sample with the greatest linear deviation; 0 of an output that is one number."""
        if not self.of_samples:
            return 0
        size = np.maximum(np.abs(self.linear.lower), np.abs(self.linear.upper))
        return int(np.nanargmax(size)) if np.isfinite(size).any() else 0

    def at_worst(self, values: Array) -> float:
        """The number at the worst sample of (samples,), or the one number that there is."""
        return float(values[self.worst] if self.of_samples else values)

    @property
    def is_kept(self) -> bool | None:
        """Whether the true worst case keeps the bounds; None without bounds."""
        if self.within is None:
            return None
        low, high = self.nominal + self.true.lower, self.nominal + self.true.upper
        return not bool(np.any(low < self.within[0]) or np.any(high > self.within[1]))


@dataclass(frozen=True, repr=False)
class ToleranceResults(PrintsSummary):
    """Accuracy of a mechanism within the limits of its dimensions.

    Attributes
    ----------
    mechanism : Mechanism
    limits : of its dimensions
    outputs : in their order
    motion : of the mechanism of the description, at the samples
    assembly : whether all mechanisms assemble and move
    draws, seed : mechanisms drawn
    """

    mechanism: Mechanism
    limits: DimensionLimits
    outputs: tuple[OutputAccuracy, ...]
    motion: xr.Dataset
    assembly: AssemblyInLimits
    draws: int
    seed: int

    @cached_property
    def units(self) -> tuple[str, ...]:
        """SI unit of each number that deviates."""
        return tuple(unit_of(self.mechanism, path) for path in self.limits.paths)

    def __getitem__(self, name: str) -> OutputAccuracy:
        for output in self.outputs:
            if output.name == name:
                return output
        names = [output.name for output in self.outputs]
        raise InputError(
            "outputs", _("there is no output {name}").format(name=value_text(name)), nearest(name, names)
        )


def tolerances(
    mechanism: MechanismSource,
    outputs: Outputs | None = None,
    limits: Mapping[str, Limits | str] | None = None,
    samples: int | None = None,
    draws: int = DRAWS,
    seed: int = 0,
    bounds: Bounds | None = None,
) -> ToleranceResults:
    """How far what a mechanism gives deviates if its dimensions lie within their limits and its joints have play.

    Parameters
    ----------
    outputs : names or formulas
        Each one number of a mechanism ("range(slide_H)") or of each sample ("position.B.x"); those of the description
        if there are none, or else the strokes of its sliders.
    limits : path -> (lower, upper) [SI], or a class such as "IT7"
        In place of those of the description; normal, as far as the description says nothing else.
    samples : of the motion
    draws : mechanisms that are drawn
    seed : of the drawn ones: the same seed draws the same
    bounds : output -> (least, greatest) [SI], or a deviation to each side; in place of those of the description

    Returns
    -------
    ToleranceResults
        Each output with its linear and true worst case, three standard deviations with the contribution of each number,
        drawn mechanisms with the share that satisfies the bounds, and deviations by play; whether all mechanisms move.

    Raises
    ------
    InputError
        No tolerance, an unknown path or output, a size beyond the standard grades, and as `motion` does.

    Notes
    -----
    First-order numbers are exact derivatives times limits. The true worst case is that of corners of the limits, all of
    them up to 12 numbers, improved by the derivatives there. Play is that of joints at rest: it says between which
    positions an output may lie, and is no contact dynamics.

    Examples
    --------
    >>> import centrode as ct
    >>> found = ct.tolerances("crank-rocker", "range(angle_DB)", {"links.DB.length": (-1e-3, 1e-3)}, draws=100)
    >>> found["range(angle_DB)"].linear.upper.shape
    ()
    """
    mechanism = mechanism_of(mechanism)
    texts, given = _requested_outputs(mechanism, outputs, bounds)
    draws, seed = _checked_count(draws, "draws", 1, MOST_DRAWS), _checked_count(seed, "seed", 0, 2**63)
    deviating = limits_of(mechanism, limits)
    prepared = ready(mechanism)
    mechanisms = DeviatedMechanisms(prepared, deviating, texts, samples)
    within = {name: _bounds_about(mechanisms.nominal[name], given[name]) for name in texts}
    corners = corners_of(mechanisms, seed)
    computed = mechanisms.outputs_of_many(corners)
    true = true_extents(mechanisms, corners, computed)
    drawn, moving, count = _drawn(mechanisms, draws, seed, within)
    stopped = corners[~computed.moves]
    assembly = AssemblyInLimits(
        len(corners),
        len(stopped),
        len(deviating.paths) <= ALL_CORNERS,
        count,
        count - moving,
        first_stop(mechanisms, stopped),
    )
    settings = mechanism.tolerances
    described_units = {} if settings is None else {name: one.unit for name, one in settings.outputs.items()}
    play = play_of(mechanism)
    clearances = clearance_extents(prepared, texts, play, samples) if play else {}
    found = tuple(
        OutputAccuracy(
            name,
            text,
            described_units.get(name) or mechanisms.units[name],
            mechanisms.of_samples[name],
            mechanisms.nominal[name],
            mechanisms.gradients[name],
            linear_extent(mechanisms.gradients[name], deviating.lower, deviating.upper),
            true[name],
            propagated_output(mechanisms.gradients[name], deviating),
            drawn.get(name),
            within.get(name),
            clearances.get(name),
        )
        for name, text in texts.items()
    )
    return ToleranceResults(
        mechanism,
        deviating,
        found,
        dataset_of(solve(prepared, grid_of(prepared, samples, None, None, None))),
        assembly,
        count,
        seed,
    )


def _drawn(
    mechanisms: DeviatedMechanisms, draws: int, seed: int, within: Mapping[str, tuple[Array, Array] | None]
) -> tuple[dict[str, DrawnOutput], int, int]:
    """Statistics of drawn mechanisms, how many of them move, and how many were drawn."""
    # outputs of samples would fill the memory: fewer mechanisms tell as much of a band
    draws = min(draws, mechanisms.most_at_once)
    deviations = draw_deviations(mechanisms.limits, draws, seed)
    parts = [
        mechanisms.outputs_of_many(deviations[first : first + AT_ONCE]) for first in range(0, draws, AT_ONCE)
    ]
    whole = (
        parts[0]
        if len(parts) == 1
        else Evaluated(
            {name: np.concatenate([part.outputs[name] for part in parts]) for name in mechanisms.texts},
            np.concatenate([part.moves for part in parts]),
        )
    )
    return drawn_outputs(mechanisms, whole, within), int(np.count_nonzero(whole.moves)), draws


def _requested_outputs(
    mechanism: Mechanism, outputs: Outputs | None, bounds: Bounds | None
) -> tuple[dict[str, str], dict[str, Limits | float | None]]:
    """Name -> text of each output, and its bounds."""
    own: Mapping[str, ToleranceOutput] = {} if mechanism.tolerances is None else mechanism.tolerances.outputs
    if outputs is None:
        texts = {name: output.formula for name, output in own.items()} or default_outputs(mechanism)
    else:
        # the name of an output of the description stands for it
        texts = {
            name: own[text].formula if text in own else text for name, text in named_outputs(outputs).items()
        }
    within: dict[str, Limits | float | None] = {}
    for name in texts:
        described = own.get(name)
        within[name] = None if described is None else described.within or described.deviation
    for name, one in (bounds or {}).items():
        if name not in texts:
            what = _("there is no output {name}").format(name=value_text(name))
            raise InputError("bounds", what, nearest(name, texts))
        if isinstance(one, int | float):
            if not one > 0.0:
                raise InputError(
                    "bounds", _("{key} must be positive, got {value}").format(key=name, value=one)
                )
        elif not one[0] < one[1]:
            what = _("the bounds {least} and {greatest} leave nothing between them")
            raise InputError("bounds", what.format(least=one[0], greatest=one[1]))
        within[name] = one
    return texts, within


def _bounds_about(nominal: Array, given: Limits | float | None) -> tuple[Array, Array] | None:
    """Least and greatest value from bounds, or from the deviation to each side."""
    if given is None:
        return None
    if isinstance(given, int | float):
        return nominal - given, nominal + given
    return np.asarray(float(given[0])), np.asarray(float(given[1]))


def default_outputs(mechanism: Mechanism) -> dict[str, str]:
    """Outputs where nothing is said: strokes of sliders on the frame, or else the way of a link that is not driven."""
    guides = [guide.id for guide in mechanism.guides if guide.on == FRAME]
    if guides:
        return {f"stroke of {name}": f"range({identifier('slide', name)})" for name in guides}
    driven = {drive.link for drive in mechanism.drives}
    links = [name for name in mechanism.links if name not in driven]
    last = links[-1] if links else next(iter(mechanism.links))
    quantity = "joint_angle" if mechanism.space == "sphere" else "angle"
    return {f"swing of {last}": f"range({identifier(quantity, last)})"}


def need_tolerances(mechanism: Mechanism, **_arguments: Any) -> None:
    """Raise InputError where the description says of no number how far it deviates."""
    limits_of(mechanism)


def _checked_count(given: Any, where: str, least: int, most: int) -> int:
    if isinstance(given, bool) or not isinstance(given, int | np.integer) or not least <= given <= most:
        what = _("{value} is not a whole number from {least} to {most}")
        raise InputError(where, what.format(value=value_text(given), least=least, most=most))
    return int(given)


def tolerance_results(
    mechanism: Mechanism,
    samples: int | None = None,
    outputs: Sequence[str] = (),
    draws: int | None = None,
    seed: int | None = None,
    instants: Sequence[float] = (),
) -> ToleranceResults:
    """What `tolerances` gives, as a command calls it."""
    return tolerances(
        mechanism, list(outputs) or None, None, samples, DRAWS if draws is None else draws, seed or 0
    )
