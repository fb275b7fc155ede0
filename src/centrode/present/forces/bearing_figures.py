"""Figures of bearings: hodographs of their loads, and how journal and bush wear around."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from centrode.locale import _
from centrode.model.reading import body_word
from centrode.present.abscissa import main_abscissa
from centrode.present.curves import say_nothing_known, write_title
from centrode.present.forces.force_picture import force_page
from centrode.present.forces.wear_figures import JOURNAL, NAME_POINTS, draw_wear
from centrode.present.labels import label_places
from centrode.present.shown import formula, labelled, plain, shown_as
from centrode.present.style import INK, Decimals, house_style
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array: TypeAlias = NDArray[np.float64]
Draw: TypeAlias = Callable[[Axes, int], None]
COLUMNS = 3
PANEL = 3.3
"""Sides of a panel [inch]."""
NAMED = 12
"""Into so many parts a turn of the drive is cut by the values that stand along a hodograph."""
ROOM = 1.36
"""A panel is so many times as wide as its hodograph: values stand outside it."""
MOST_SEGMENTS = 90
"""Of so many parts of a hodograph its texts keep clear."""


def bearing_figures(
    mechanism: Mechanism, reactions: xarray.Dataset, bearings: xarray.Dataset, motion: xarray.Dataset
) -> dict[str, Figure]:
    """Figures of the bearings of a mechanism, by name.

    Parameters
    ----------
    reactions, bearings, motion : Dataset
        Of `reactions`, `bearings` and `motion`, at the same samples.

    Returns
    -------
    dict of name -> Figure
        "bearing-loads" (hodographs in the frame's axes), "journal-loads" and "bush-loads" (in their own axes),
        "bearing-wear", and "force-vectors", the mechanism where a joint force is greatest, at true scale.
    """
    with house_style():
        found = {}
        titles = {
            "bearing-loads": ("bearing_load", _("Loads of the bearings on the bushes")),
            "journal-loads": ("load_on_journal", _("Loads on the journals, in the axes of their links")),
            "bush-loads": ("load_on_bush", _("Loads on the bushes, in the axes of their links")),
        }
        if bearings.sizes["bearing"]:
            for name, (variable, title) in titles.items():
                draw = _hodographs(mechanism, bearings, variable)
                found[name] = _grid(mechanism, bearings, title, draw)
            title = _("Wear of the journals (inside) and bushes (outside), each in its own axes")
            found["bearing-wear"] = _grid(
                mechanism, bearings, title, lambda axes, k: draw_wear(axes, bearings.isel(bearing=k))
            )
        page = force_page(mechanism, reactions, motion)
        return found if page is None else found | {"force-vectors": page}


def _grid(mechanism: Mechanism, bearings: xarray.Dataset, title: str, draw: Draw) -> Figure:
    """A panel for each bearing."""
    count = bearings.sizes["bearing"]
    columns = 2 if count == 4 else min(COLUMNS, count)
    rows = -(-count // columns)
    size = (columns * (PANEL + 0.75), rows * (PANEL + 0.8) + 0.6)
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for k, axes in enumerate(grid[:count]):
        draw(axes, k)
        axes.set_title(_name(bearings, k))
    for axes in grid[count:]:
        axes.set_axis_off()
    write_title(figure, title, _(mechanism.title))
    return figure


def _name(bearings: xarray.Dataset, k: int) -> str:
    point, journal, bush = (
        str(bearings[f"bearing_{part}"].to_numpy()[k]) for part in ("point", "journal", "bush")
    )
    told = _("{point}: {journal} in {bush}")
    return plain(told.format(point=point, journal=journal, bush=body_word(bush)))


def _hodographs(mechanism: Mechanism, bearings: xarray.Dataset, variable: str) -> Draw:
    """What draws the hodograph of a bearing; it takes the marks along it with it."""
    marks = _marks(mechanism, bearings)
    abscissa = main_abscissa(mechanism, bearings)

    def draw(axes: Axes, k: int) -> None:
        force = bearings[variable].isel(bearing=k).transpose("sample", "axis").to_numpy()
        ordered = np.insert(force[abscissa.order], abscissa.breaks, np.nan, axis=0)
        symbol = QUANTITIES[variable].symbol
        axes.set_xlabel(labelled(formula(symbol, "x"), "N"))
        axes.set_ylabel(labelled(formula(symbol, "y"), "N"))
        if not np.isfinite(force).all(axis=1).any():
            say_nothing_known(axes)
            return
        _frame_about(axes, ordered)
        axes.plot(ordered[:, 0], ordered[:, 1], color=JOURNAL, zorder=3)
        axes.plot([0.0], [0.0], "+", color=INK, markersize=9, zorder=4)
        _mark(axes, ordered, {text: place for text, at in marks if (place := _at(force, at)) is not None})

    return draw


def _at(force: Array, at: tuple[int, float]) -> Array | None:
    """A hodograph's place at a share of a step between two samples."""
    first, share = at
    second = min(first + 1, len(force) - 1)
    place = force[first] if share == 0.0 else (1.0 - share) * force[first] + share * force[second]
    return place if np.isfinite(place).all() else None


def _marks(mechanism: Mechanism, bearings: xarray.Dataset) -> list[tuple[str, tuple[int, float]]]:
    """Texts of round values of the drive, with the sample and the share of the step behind it; else of time."""
    parameter = mechanism.motion_parameter
    factor, unit = shown_as(parameter.instant.unit, mechanism.display)
    values = factor * parameter.instants(bearings)
    if len(values) < 2 or values[0] == values[-1]:
        return []
    turn = {"deg": 360.0, "rad": 2.0 * np.pi}.get(unit, 0.0)
    reach = abs(float(values[-1] - values[0]))
    step = turn / NAMED if turn and 0.4 * turn <= reach <= 1.01 * turn else _round_step(reach)
    forward = bool(values[-1] > values[0])
    low, high = sorted((float(values[0]), float(values[-1])))
    grid = step * np.round(np.arange(np.ceil(low / step - 1e-9), high / step + 1e-9))
    whole = turn > 0.0 and abs(reach - turn) < 1e-6 * turn
    found = []
    sense = 1.0 if forward else -1.0
    for value in grid[: NAMED if whole else None].tolist():
        k = int(np.clip(np.searchsorted(sense * values, sense * value), 1, len(values) - 1))
        share = float(np.clip((value - values[k - 1]) / (values[k] - values[k - 1]), 0.0, 1.0))
        text = f"{value + 0.0:.4g}{'°' if unit == 'deg' else ''}".replace("-", "−")
        found.append((text, (k - 1, share) if share < 1.0 else (k, 0.0)))
    return found


def _round_step(reach: float) -> float:
    """A round step that cuts a reach into some ten parts."""
    power = 10.0 ** np.floor(np.log10(reach / 10.0))
    return float(
        next(power * part for part in (1.0, 2.0, 2.5, 5.0, 10.0) if power * part >= reach / 10.0 * (1 - 1e-9))
    )


def _frame_about(axes: Axes, force: Array) -> None:
    """Square limits around a hodograph and its origin, with room for what stands beside it."""
    known = np.vstack([force[np.isfinite(force).all(axis=1)], np.zeros((1, 2))])
    low, high = known.min(axis=0), known.max(axis=0)
    half = 0.5 * ROOM * float(np.max(high - low)) or 1.0
    middle = (low + high) / 2
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(Decimals())
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))


def _mark(axes: Axes, force: Array, places: dict[str, Array]) -> None:
    """Dots at round values of the drive with the values beside them, where there is room."""
    low, high = axes.get_xlim()
    height = NAME_POINTS * (high - low) / (72.0 * PANEL)
    apart: dict[str, Array] = {}
    dots = np.array(list(places.values())).reshape(-1, 2)
    axes.plot(dots[:, 0], dots[:, 1], "o", color=JOURNAL, markersize=3.2, zorder=4)
    for text, place in places.items():
        if all(np.hypot(*(place - other)) > 1.6 * height for other in apart.values()):
            apart[text] = place
    coarse = force[:: max(1, len(force) // MOST_SEGMENTS)]
    segments = [(a, b) for a, b in pairwise(coarse) if np.isfinite([a, b]).all()]
    for text, centre in label_places(apart, segments, 1.1 * height, height).items():
        axes.text(
            centre[0], centre[1], text, fontsize=NAME_POINTS, color=INK, ha="center", va="center", zorder=5
        )
