"""Figures of reactions: curves over the motion, hodographs and wear of bearings, forces on the mechanism to scale."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.model.reading import FRAME
from centrode.quantities import QUANTITIES, display_unit
from centrode.sheets.plots import (
    AxisLabel,
    Curve,
    CurvePanel,
    CurveRole,
    HodographPanel,
    MomentOnBody,
    PanelGrid,
    Plot,
    SectorRings,
    VectorOnBody,
    VectorPage,
)
from centrode.sheets.texts import Joined, Name, Number, Sentence, Symbol, Text, Title
from centrode.views.abscissa import motion_abscissa
from centrode.views.motion_plots import deal_to_panels
from centrode.views.reaction_names import balancing_text, body_text, contact_text, side_text

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.bearings.results import ReactionResults
    from centrode.model.mechanism import Mechanism
    from centrode.sheets.pictures import Picture

Array: TypeAlias = NDArray[np.float64]
Curves: TypeAlias = dict[str, tuple[Text, Array]]
"""Key -> name and values; what comes later under the same key takes its place."""
ALIKE = 1e-9
"""Magnitudes that differ by less than this share of the greatest are one curve."""
NAMED = 12
"""Into so many parts a turn of the drive is cut by the values that stand along a hodograph."""


def pictures(results: ReactionResults) -> Iterator[tuple[str, Picture]]:
    """Figures by name: curves of what there is and is determined; in the plane the bearings and the forces to scale."""
    mechanism, reactions = results.mechanism, results.reactions
    abscissa, title = motion_abscissa(mechanism, reactions), Title(mechanism.title)
    plots = {
        "joint-forces": (Sentence("Forces in the hinges"), _hinges(reactions)),
        "joint-components": (Sentence("Forces in the hinges by components"), _components(reactions)),
        "centre-forces": (Sentence("Forces of the centre of the sphere"), _centre(reactions)),
        "other-reactions": (Sentence("Reactions of guides, gears and wheels"), _others(reactions)),
        "balancing": (Sentence("Balancing moments and forces of the drives"), _drives(results)),
        "drive-balance": (Sentence("Balance of the moments on the drive"), _balance(reactions)),
        "friction": (Sentence("Losses to friction"), _friction(reactions)),
        "frame-force": (Sentence("Force and moment on the frame"), _frame(reactions)),
    }
    for name, (what, panels) in plots.items():
        if panels:
            yield name, Plot(what, title, abscissa, tuple((panel,) for panel in panels))
    if results.bearings is None or results.motion is None:
        return
    if results.bearings.sizes["bearing"]:
        for name, what, variable in (
            ("bearing-loads", Sentence("Loads of the bearings on the bushes"), "bearing_load"),
            (
                "journal-loads",
                Sentence("Loads on the journals, in the axes of their links"),
                "load_on_journal",
            ),
            ("bush-loads", Sentence("Loads on the bushes, in the axes of their links"), "load_on_bush"),
        ):
            yield name, PanelGrid(what, title, tuple(_hodographs(mechanism, results.bearings, variable)))
        what = Sentence("Wear of the journals (inside) and bushes (outside), each in its own axes")
        yield "bearing-wear", PanelGrid(what, title, tuple(map(_wear, _each_bearing(results.bearings))))
    page = _forces_to_scale(mechanism, reactions, results.motion)
    if page is not None:
        yield "force-vectors", page


# Curves


def _hinges(reactions: xarray.Dataset) -> list[CurvePanel]:
    """Magnitudes at the hinges: one curve of a hinge whose sides are alike, else one of each side."""
    points, labels = reactions["side_point"].values, reactions["side"].values
    sizes = _magnitude(reactions["joint_force"])
    curves: Curves = {}
    for point in dict.fromkeys(points.tolist()):
        sides = np.flatnonzero(points == point)
        first = sizes[:, sides[0]]
        apart = np.abs(sizes[:, sides] - first[:, None])
        if np.nanmax(apart, initial=0.0) <= ALIKE * np.nanmax(first, initial=0.0):
            curves[point] = (Name(point), first)
        else:
            curves |= {str(labels[k]): (side_text(str(labels[k])), sizes[:, k]) for k in sides}
    return _panels("joint_force", curves, split=True)


def _components(reactions: xarray.Dataset) -> list[CurvePanel]:
    """On the sphere: components of the force on the first link of each hinge, a panel for each axis."""
    if "centre_force" not in reactions:
        return []
    points, labels = reactions["side_point"].values.tolist(), reactions["side"].values.tolist()
    first = [labels[points.index(point)] for point in dict.fromkeys(points)]
    panels = []
    for axis in reactions["axis"].values.tolist():
        values = reactions["joint_force"].sel(axis=axis)
        curves = {side: (side_text(side), values.sel(side=side).values) for side in first}
        panels += _panels("joint_force", curves, split=True, along=axis)
    return panels


def _centre(reactions: xarray.Dataset) -> list[CurvePanel]:
    """Magnitudes of what the centre of a sphere exerts; none in the plane, or where there is nothing but rounding."""
    if "centre_force" not in reactions:
        return []
    sizes = _magnitude(reactions["centre_force"])
    least = ALIKE * np.nanmax(_magnitude(reactions["joint_force"]), initial=0.0)
    names = reactions["held"].values.tolist()
    curves = {
        name: (Name(name), sizes[:, k])
        for k, name in enumerate(names)
        if np.nanmax(sizes[:, k], initial=0.0) > least
    }
    return _panels("centre_force", curves, split=True)


def _others(reactions: xarray.Dataset) -> list[CurvePanel]:
    """Normal forces of guides, both forces of rolling wheels, moments of guides, forces of teeth."""
    forces: Curves = {}
    for variable, dimension, word in (
        ("guide_normal", "guide", None),
        ("rolling_normal", "rolling", Sentence("normal")),
        ("rolling_tangential", "rolling", Sentence("tangential")),
    ):
        if variable in reactions:
            forces |= _by_label(reactions[variable], dimension, word)
    panels = _panels("guide_normal" if "guide_normal" in reactions else "rolling_normal", forces)
    if "guide_moment" in reactions:
        moments = _by_label(reactions["guide_moment"], "guide")
        # a guide that bears no moment has no curve
        panels += _panels("guide_moment", {name: one for name, one in moments.items() if np.any(one[1])})
    if "tooth_force" in reactions:
        teeth = reactions["tooth_force"]
        names = teeth["gear"].values.tolist()
        sizes = zip(names, _magnitude(teeth).T, strict=True)
        panels += _panels("tooth_force", {name: (Name(name), size) for name, size in sizes})
    return panels


def _by_label(values: xarray.DataArray, dimension: str, word: Sentence | None = None) -> Curves:
    """Curves by their labels, with a word behind where that is needed to tell them apart."""
    return {
        f"{name} {word.message if word else ''}".rstrip(): (
            Name(name) if word is None else Joined((Name(name), word), " "),
            values.sel({dimension: name}).values,
        )
        for name in values[dimension].values.tolist()
    }


def _drives(results: ReactionResults) -> list[CurvePanel]:
    """What the drives give, a panel for each unit; beside a single curve its mean over time."""
    given, means = results.reactions["balancing"], {load.key: load.mean for load in results.loads or ()}
    units = str(given.attrs["units"]).split(", ")
    names = given["drive"].values.tolist()
    panels = []
    for unit in dict.fromkeys(units):
        of_unit = [name for k, name in enumerate(names) if units[k % len(units)] == unit]
        curves = {name: (Name(name), given.sel(drive=name).values) for name in of_unit}
        for panel in _panels("balancing", curves, unit):
            if len(panel.curves) == 1:
                (curve,), mean = panel.curves, means[f"balancing_{of_unit[0]}"]
                level = np.where(np.isfinite(curve.values), mean, np.nan)
                both = (curve, Curve(Sentence("mean"), level, 1, role=CurveRole.LEVEL))
                panel = CurvePanel(panel.label, both)
            panels.append(panel)
    return panels


def _balance(reactions: xarray.Dataset) -> list[CurvePanel]:
    """In the real motion: what the links need, what the flywheel takes, and the driving moment that both are."""
    if "driving_moment" not in reactions:
        return []
    parts = (
        (Sentence("links"), reactions["moment_of_links"].values),
        (Sentence("flywheel and shafts"), -reactions["inertia_moment_of_group"].values),
    )
    curves = [Curve(name, values, place, role=CurveRole.PART) for place, (name, values) in enumerate(parts)]
    total = Curve(
        Sentence("driving moment"), reactions["driving_moment"].values, len(parts), role=CurveRole.SUM
    )
    return [CurvePanel(AxisLabel(symbol=Symbol("M"), unit="N m"), (*curves, total))]


def _friction(reactions: xarray.Dataset) -> list[CurvePanel]:
    """Power that friction takes at each contact, and the efficiency."""
    if "friction_power" not in reactions:
        return []
    power = reactions["friction_power"]
    labels = power["friction"].values.tolist()
    powers = {label: (contact_text(label), power.sel(friction=label).values) for label in labels}
    efficiency = {"efficiency": (Sentence("efficiency"), reactions["efficiency"].values)}
    return [*_panels("friction_power", powers), *_panels("efficiency", efficiency)]


def _frame(reactions: xarray.Dataset) -> list[CurvePanel]:
    """Force and moment on the frame, and the part of inertia; moments of the plane with their sign."""
    panels = []
    for whole, inertia, size in (
        ("frame_force", "shaking_force", _magnitude),
        ("frame_moment", "shaking_moment", _size),
    ):
        curves = {
            "whole": (Sentence("total"), size(reactions[whole])),
            "inertia": (Sentence("of inertia alone"), size(reactions[inertia])),
        }
        panels += _panels(whole, curves)
    return panels


def _panels(
    variable: str,
    curves: Mapping[str, tuple[Text, Array]],
    unit: str = "",
    *,
    split: bool = False,
    along: str = "",
) -> list[CurvePanel]:
    """One panel of the curves that have numbers, or as many as keep them apart; `along` names an axis."""
    known = {key: curve for key, curve in curves.items() if np.isfinite(curve[1]).any()}
    quantity = QUANTITIES[variable]
    unit = unit or quantity.unit
    # a drive along a guide or of a cylinder gives a force
    letter = "F_b" if (variable, unit) == ("balancing", "N") else quantity.symbol
    label = AxisLabel(symbol=Symbol(letter, along, slanted=True), unit=unit)
    drawn = {key: Curve(name, values, place) for place, (key, (name, values)) in enumerate(known.items())}
    groups: Sequence[Sequence[str]] = deal_to_panels(known) if split else [list(known)]
    return [CurvePanel(label, tuple(drawn[key] for key in keys)) for keys in groups if keys]


def _size(moment: xarray.DataArray) -> Array:
    """A moment of the plane with its sign, one of the sphere by its magnitude."""
    return _magnitude(moment) if "axis" in moment.dims else moment.values


def _magnitude(values: xarray.DataArray) -> Array:
    return np.asarray(np.hypot.reduce(values.transpose(..., "axis").values, axis=-1))


# Bearings


def _each_bearing(bearings: xarray.Dataset) -> Iterator[xarray.Dataset]:
    return (bearings.isel(bearing=k) for k in range(bearings.sizes["bearing"]))


def _bearing_name(bearing: xarray.Dataset) -> Sentence:
    point, journal, bush = (str(bearing[f"bearing_{part}"].item()) for part in ("point", "journal", "bush"))
    return Sentence(
        "{point}: {journal} in {bush}", point=Name(point), journal=Name(journal), bush=body_text(bush)
    )


def _hodographs(mechanism: Mechanism, bearings: xarray.Dataset, variable: str) -> Iterator[HodographPanel]:
    """The load of each bearing, with round values of the drive, or of time, along it."""
    marks = list(_marks(mechanism, bearings))
    abscissa, symbol = motion_abscissa(mechanism, bearings), QUANTITIES[variable].symbol
    x, y = (AxisLabel(symbol=Symbol(symbol, axis, slanted=True), unit="N") for axis in ("x", "y"))
    for bearing in _each_bearing(bearings):
        force = bearing[variable].transpose("sample", "axis").values
        places = ((value, _between(force, *at)) for value, at in marks)
        known = tuple((value, (float(at[0]), float(at[1]))) for value, at in places if np.isfinite(at).all())
        yield HodographPanel(_bearing_name(bearing), x, y, force, abscissa.order, abscissa.breaks, known)


def _between(force: Array, first: int, share: float) -> Array:
    """The place at a share of the step behind a sample."""
    if share == 0.0:
        return np.asarray(force[first])
    return np.asarray((1.0 - share) * force[first] + share * force[min(first + 1, len(force) - 1)])


def _marks(mechanism: Mechanism, bearings: xarray.Dataset) -> Iterator[tuple[Number, tuple[int, float]]]:
    """Round values of the drive, else of time, with the sample before each and the share of the step behind it.

    They are round in the unit of the display.
    """
    instant, display = mechanism.motion_parameter.instant, mechanism.display
    factor, unit = display_unit(instant.unit, str(display.length), str(display.angle))
    values = factor * mechanism.motion_parameter.instants(bearings)
    if len(values) < 2 or values[0] == values[-1]:
        return
    turn = {"deg": 360.0, "rad": 2.0 * np.pi}.get(unit, 0.0)
    reach = abs(float(values[-1] - values[0]))
    step = turn / NAMED if turn and 0.4 * turn <= reach <= 1.01 * turn else _round_step(reach)
    sense = 1.0 if values[-1] > values[0] else -1.0
    low, high = sorted((float(values[0]), float(values[-1])))
    grid = step * np.round(np.arange(np.ceil(low / step - 1e-9), high / step + 1e-9))
    # the end of a whole turn is its beginning
    whole = turn > 0.0 and abs(reach - turn) < 1e-6 * turn
    for value in grid[: NAMED if whole else None].tolist():
        k = int(np.clip(np.searchsorted(sense * values, sense * value), 1, len(values) - 1))
        share = float(np.clip((value - values[k - 1]) / (values[k] - values[k - 1]), 0.0, 1.0))
        number = Number((value + 0.0) / factor, instant.unit, ".4g", unit_hidden=unit != "deg")
        yield number, ((k - 1, share) if share < 1.0 else (k, 0.0))


def _round_step(reach: float) -> float:
    """A round step that cuts a reach into some ten parts."""
    power = 10.0 ** np.floor(np.log10(reach / 10.0))
    return float(
        next(power * part for part in (1.0, 2.0, 2.5, 5.0, 10.0) if power * part >= reach / 10.0 * (1 - 1e-9))
    )


def _wear(bearing: xarray.Dataset) -> SectorRings:
    """Wear of the journal inside and of the bush outside, with the greatest share of each in one sector."""
    journal, bush = bearing["wear"].transpose("surface", "sector").values
    middles = bearing["sector"].values
    text = Sentence(
        "greatest in {wide}\njournal {journal}\nbush {bush}",
        wide=Number(360.0 / len(middles), "deg", ".3g", unit_fixed=True),
        journal=Number(100.0 * float(np.max(journal)), "%", ".2g", unit_fixed=True),
        bush=Number(100.0 * float(np.max(bush)), "%", ".2g", unit_fixed=True),
    )
    return SectorRings(_bearing_name(bearing), middles, journal, bush, text)


# Forces on the mechanism


def _forces_to_scale(
    mechanism: Mechanism, reactions: xarray.Dataset, motion: xarray.Dataset
) -> VectorPage | None:
    """The sample at which a joint force is greatest; nothing where there is none."""
    size = _magnitude(reactions["joint_force"].transpose("sample", "side", "axis"))
    if not size.size or not np.nanmax(np.nan_to_num(size)) > 0.0:
        return None
    sample = int(np.unravel_index(np.nanargmax(size), size.shape)[0])
    here = reactions.isel(sample=sample)
    vectors = (*_side_forces(here), *_guide_forces(mechanism, here))
    return VectorPage(
        Sentence("Forces of the pins on the links"),
        (mechanism, motion, sample),
        "μ_F",
        "N",
        vectors,
        tuple(_drive_moments(mechanism, here)),
        (*map(_line, vectors), *_drive_lines(here)),
    )


def _side_forces(here: xarray.Dataset) -> Iterator[VectorOnBody]:
    """The force of the pin on each body at each hinge."""
    forces = here["joint_force"].transpose("side", "axis").values.tolist()
    for label, point, body, (x, y) in zip(
        here["side"].values.tolist(),
        here["side_point"].values.tolist(),
        here["side_link"].values.tolist(),
        forces,
        strict=True,
    ):
        yield VectorOnBody(side_text(label), point, (x, y), body or FRAME)


def _guide_forces(mechanism: Mechanism, here: xarray.Dataset) -> Iterator[VectorOnBody]:
    if "guide_force" in here:
        for guide in mechanism.guides:
            x, y = here["guide_force"].sel(guide=guide.id).values.tolist()
            yield VectorOnBody(Sentence("guide {name}", name=Name(guide.id)), guide.point, (x, y))


def _drive_moments(mechanism: Mechanism, here: xarray.Dataset) -> Iterator[MomentOnBody]:
    """What a drive gives, about the first point of its link."""
    for drive in mechanism.drives:
        value = float(here["balancing"].sel(drive=drive.id))
        if drive.kind == "angle" and drive.link is not None and np.isfinite(value) and value != 0.0:
            sense = mechanism.motion_parameter.drive(drive.id).sense
            yield MomentOnBody("Mb", next(iter(mechanism.links[drive.link].coordinates)), sense * value)


def _line(vector: VectorOnBody) -> Text:
    """Magnitude and direction of a force."""
    x, y = vector.components
    if not np.isfinite(x):
        return Joined((vector.name, Sentence("not determined")), ": ")
    size = Number(float(np.hypot(x, y)), "N", ".5g")
    direction = Number(float(np.degrees(np.arctan2(y, x))), "deg", ".1f", unit_fixed=True)
    return Joined((vector.name, Joined((size, direction))), ": ")


def _drive_lines(here: xarray.Dataset) -> Iterator[Text]:
    units = str(here["balancing"].attrs["units"]).split(", ")
    for k, name in enumerate(here["drive"].values.tolist()):
        unit = units[k % len(units)]
        value = Number(float(here["balancing"].values[k]), unit, ".5g")
        yield Joined((balancing_text(Name(name), unit), value), " ")
