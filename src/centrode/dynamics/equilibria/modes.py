"""Modes of a mechanism about an equilibrium or a steady rotation, as a labelled result."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.equilibria.equilibrium import (
    Value,
    drive_coordinate,
    drive_variables,
    held_values,
    label_values,
    pose_variables,
    stable_first,
)
from centrode.dynamics.equilibria.equilibrium_search import (
    approached_positions,
    find_equilibria,
    no_equilibrium,
    settled_equilibria,
    with_states,
)
from centrode.dynamics.equilibria.friction_bands import friction_bands
from centrode.dynamics.equilibria.linear_equations import LoadedMechanism, loaded_mechanism
from centrode.dynamics.equilibria.posed_motions import mode_motion, posed_motion
from centrode.dynamics.equilibria.small_motions import SmallMotions, small_motions
from centrode.dynamics.equilibria.steady_rotation import steady_rotation
from centrode.errors import InputError, MotionError
from centrode.kinematics.motion import vocabulary_variable
from centrode.locale import _, ngettext
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import mechanism_text
from centrode.model.mechanism import Mechanism
from centrode.model.units import read_quantity
from centrode.version import __version__

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ModesResults:
    """Modes of a mechanism.

    Attributes
    ----------
    mechanism : the description
    modes : dataset of `modes`
    motions : a period of each mode, drawn larger than it is
    """

    mechanism: Mechanism
    modes: xr.Dataset
    motions: tuple[xr.Dataset, ...]


def modes(
    mechanism: MechanismSource,
    *,
    equilibrium: int | None = None,
    hold: Mapping[str, Value] | None = None,
    speed: Mapping[str, Value] | None = None,
) -> xr.Dataset:
    """Natural frequencies, damping and shapes of small motions about an equilibrium, or about a steady rotation.

    Without a choice the equilibrium is the one that the mechanism comes to from its initial position downhill.

    Parameters
    ----------
    equilibrium : number of an equilibrium of `ct.equilibrium`, counted from 1
    hold : drive -> value [rad or m, or a text with a unit] at which it is held
    speed : drive -> constant speed [rad/s or m/s, or a text with a unit], one drive
        About a motion in which all coordinates have constant speeds, in place of an equilibrium.

    Returns
    -------
    Dataset
        Of every `mode`, the slowest first: `natural_frequency` |s| and `damping_ratio` -Re s / |s| of its eigenvalue
        s = `growth_rate` + i `damped_frequency`; `mode_amplitude` and `mode_phase` of every coordinate, the greatest
        being 1 rad or 1 m; and the position itself. `undamped_frequency` is that of the masses and stiffnesses alone.

    Raises
    ------
    InputError
        A link without mass moves by itself, an equilibrium or drive is not known, nothing acts.
    MotionError
        There is no equilibrium, or no steady motion.

    Examples
    --------
    >>> import centrode as ct
    >>> pendulum = ct.Mechanism(
    ...     gravity=[0, -9.81],
    ...     frame={"points": {"O": [0, 0]}},
    ...     links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
    ... )
    >>> round(float(ct.modes(pendulum).natural_frequency[0]), 4)
    3.836
    """
    description = mechanism_of(mechanism)
    held, speeds = held_values(description, hold), _speeds(description, speed)
    if speeds and equilibrium is not None:
        what = _("an equilibrium and a speed exclude each other")
        raise InputError("equilibrium", what, _("keep one of them"))
    loaded = loaded_mechanism(description.with_drives_held(), held, speeds)
    if speeds:
        motions = steady_rotation(loaded)
    else:
        (motions,) = small_motions(loaded, _place(loaded, equilibrium)[None])
    _check_masses(loaded, motions)
    return _dataset(description, loaded, motions, held, speeds)


def _speeds(mechanism: Mechanism, speed: Mapping[str, Value] | None) -> dict[str, float]:
    """Drive -> speed of what it moves [rad/s or m/s]."""
    if speed and len(speed) > 1:
        what = _("{count} drives have a speed, and the motion of one is steady").format(count=len(speed))
        raise InputError("speed", what, _("hold the others"))
    found = {}
    for name, value in (speed or {}).items():
        coordinate = drive_coordinate(mechanism, name, "speed")
        found[name] = coordinate.sense * read_quantity(value, coordinate.speed_kind, f"speed {name}")
        if not found[name]:
            raise InputError(f"speed {name}", _("it is zero"), _("hold the drive (hold: DRIVE=VALUE)"))
    return found


def _place(loaded: LoadedMechanism, equilibrium: int | None) -> Array:
    """The equilibrium of a number, or that to which the initial position comes downhill."""
    if equilibrium is not None:
        places = stable_first(find_equilibria(loaded)).places
        if not 1 <= equilibrium <= len(places):
            what = ngettext(
                "there is {n} equilibrium, and number {number} is requested",
                "there are {n} equilibria, and number {number} is requested",
                len(places),
            )
            if loaded.mechanism.stops:
                what = ngettext(
                    "there is {n} equilibrium that rests on no stop, and number {number} is requested",
                    "there are {n} equilibria that rest on no stop, and number {number} is requested",
                    len(places),
                )
            raise InputError(
                "equilibrium",
                what.format(n=len(places), number=equilibrium),
                _("see centrode equilibrium"),
            )
        return np.asarray(places[equilibrium - 1])
    if loaded.mobility:
        begin = loaded.start[None]
        near = with_states(loaded, begin) if loaded.states else approached_positions(loaded, begin)
        found = settled_equilibria(loaded, near)
        if np.isfinite(found[0, 0]):
            return np.asarray(found[0])
    # what says why there is none
    all_found = stable_first(find_equilibria(loaded))
    if not len(all_found.places) and friction_bands(all_found):
        what = _("friction alone holds it, and what it holds has no small motions")
        raise MotionError("", what, _("omit the friction, or let springs or weights hold it"))
    if not len(all_found.places):
        raise no_equilibrium(loaded, all_found.starts)
    return np.asarray(all_found.places[0])


def _check_masses(loaded: LoadedMechanism, motions: SmallMotions) -> None:
    if motions.moves_mass:
        return
    _sizes, vectors = np.linalg.eigh(motions.mass)
    moved = np.abs(motions.free @ vectors[:, 0]) / loaded.units
    name = loaded.coordinates[int(np.argmax(moved))].name
    what = _("{name} moves by itself and has no mass: there is no frequency").format(name=name)
    raise InputError("[links]", what, _("give the links that move with it a mass"))


def _dataset(
    description: Mechanism,
    loaded: LoadedMechanism,
    motions: SmallMotions,
    held: Mapping[str, float],
    speeds: Mapping[str, float],
) -> xr.Dataset:
    values, shapes = motions.eigenvalues, motions.shapes[:, : loaded.joints]
    poses = posed_motion(loaded, np.zeros(1), motions.place[None])
    variables = {
        name: (dims[1:], one[0], attributes)
        for name, (dims, one, attributes) in (
            pose_variables(poses, "equilibrium")
            | drive_variables(description, loaded, motions.place[None], "equilibrium")
        ).items()
    }
    sizes = np.abs(values)
    with np.errstate(all="ignore"):
        damping = np.where(sizes > 0.0, -values.real / sizes, np.nan)
    amplitude = vocabulary_variable("mode_amplitude", ("mode", "coordinate"), np.abs(shapes))
    units = [one.unit for one in loaded.coordinates]
    amplitude[2]["units"] = units[0] if len(set(units)) == 1 else ", ".join(units)
    variables |= {
        "growth_rate": vocabulary_variable("growth_rate", ("mode",), values.real),
        "damped_frequency": vocabulary_variable("damped_frequency", ("mode",), values.imag),
        "natural_frequency": vocabulary_variable("natural_frequency", ("mode",), sizes),
        "damping_ratio": vocabulary_variable("damping_ratio", ("mode",), damping),
        "undamped_frequency": vocabulary_variable(
            "undamped_frequency", ("freedom",), motions.undamped_frequencies
        ),
        "mode_amplitude": amplitude,
        "mode_phase": vocabulary_variable(
            "mode_phase", ("mode", "coordinate"), np.where(np.abs(shapes) > 1e-12, np.angle(shapes), 0.0)
        ),
    }
    coordinates: dict[str, Any] = {"mode": np.arange(1, len(values) + 1)}
    return xr.Dataset(
        variables,
        coordinates | label_values(poses, description),
        {
            "topic": "modes",
            "title": description.title,
            "mechanism": mechanism_text(description),
            "version": __version__,
            "mobility": loaded.mobility,
            "stability": motions.stability,
            "hold": json.dumps(dict(held)),
            "speed": json.dumps(dict(speeds)),
        },
    )


def modes_results(
    mechanism: Mechanism,
    *,
    equilibrium: int | None = None,
    hold: Mapping[str, Value] | None = None,
    speed: Mapping[str, Value] | None = None,
) -> ModesResults:
    """Modes with the motions that are drawn; see `modes`."""
    return results_of_modes(mechanism, modes(mechanism, equilibrium=equilibrium, hold=hold, speed=speed))


def results_of_modes(mechanism: Mechanism, found: xr.Dataset) -> ModesResults:
    """A dataset of `modes` with the motions that are drawn."""
    held = {name: float(value) for name, value in json.loads(found.attrs["hold"]).items()}
    speeds = {name: float(value) for name, value in json.loads(found.attrs["speed"]).items()}
    # what controllers do is in the shapes already
    drawn = mechanism.with_drives_held().model_copy(update={"controllers": ()})
    loaded = loaded_mechanism(drawn, {**held, **_begin(drawn, speeds)})
    place = found["generalised_coordinate"].values
    shapes = found["mode_amplitude"].values * np.exp(1j * found["mode_phase"].values)
    frequencies = found["damped_frequency"].values
    return ModesResults(
        mechanism,
        found,
        tuple(
            mode_motion(loaded, place, shape, float(frequency))
            for shape, frequency in zip(shapes, frequencies, strict=True)
        ),
    )


def _begin(mechanism: Mechanism, speeds: Mapping[str, float]) -> dict[str, float]:
    """Values of the drives that turn steadily, at which their modes are drawn: those of the initial position."""
    if not speeds:
        return {}
    loaded = loaded_mechanism(mechanism)
    known = loaded.drive_values(loaded.start)
    return {name: known[name] for name in speeds}


def has_masses_at_rest(mechanism: Mechanism) -> bool:
    """Whether a mechanism has masses, and loads that may bring them back."""
    masses = any(link.mass is not None or link.inertia is not None for link in mechanism.links.values())
    return masses and bool(mechanism.loads or mechanism.gravity)
