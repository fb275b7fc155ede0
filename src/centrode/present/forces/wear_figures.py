"""How journal and bush wear around, drawn as rings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from centrode.locale import _
from centrode.present.style import INK, MUTED, PALETTE

if TYPE_CHECKING:
    import xarray


Array: TypeAlias = NDArray[np.float64]

NAME_POINTS = 7.5
JOURNAL, BUSH = PALETTE[0], PALETTE[1]
DEPTH = 0.42
"""The deepest wear, over the radius of the circle."""


def draw_wear(axes: Axes, one: xarray.Dataset) -> None:
    """A circle with the wear of the journal inside it and that of the bush outside."""
    axes.set_aspect("equal", adjustable="box")
    axes.set_axis_off()
    reach = 1.0 + DEPTH + 0.28
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    around = np.linspace(0.0, 2.0 * np.pi, 361)
    axes.plot(np.cos(around), np.sin(around), color=INK, linewidth=1.0, zorder=3)
    ways = np.radians(np.arange(0, 360, 30))[:, None]
    spokes = np.array([0.3, 1.0 + DEPTH, np.nan])
    axes.plot(
        (np.cos(ways) * spokes).ravel(), (np.sin(ways) * spokes).ravel(), color=MUTED, linewidth=0.4, zorder=1
    )
    for turn, (x, y) in {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}.items():
        far = 1.0 + DEPTH + 0.14
        axes.text(far * x, far * y, f"{turn}°", fontsize=NAME_POINTS, color=MUTED, ha="center", va="center")
    wear = one["wear"].transpose("surface", "sector").to_numpy()
    if not np.isfinite(wear).all():
        axes.text(0.0, 0.0, _("no turning\nunder load"), color=MUTED, ha="center", va="center")
        return
    middles = one["sector"].to_numpy()
    deepest = float(wear.max())
    for share, colour, sign in zip(wear, (JOURNAL, BUSH), (-1.0, 1.0), strict=True):
        radius = 1.0 + sign * DEPTH * share / deepest
        axes.fill(*_ring(middles, radius), color=colour, alpha=0.35, linewidth=0.0, zorder=2)
        outline = np.append(middles, middles[0] + 2.0 * np.pi)
        radius = np.append(radius, radius[0])
        axes.plot(radius * np.cos(outline), radius * np.sin(outline), color=colour, linewidth=1.3, zorder=4)
    axes.text(
        0.0, 0.0, _said(wear, len(middles)), fontsize=8.0, color=INK, ha="center", va="center", zorder=5
    )


def _ring(middles: Array, radius: Array) -> tuple[Array, Array]:
    """The outline of what lies between the unit circle and a curve around it."""
    turns = np.append(middles, middles[0] + 2.0 * np.pi)
    fine = np.linspace(turns[0], turns[-1], 721)
    far = np.append(radius, radius[0])
    x = np.concatenate([far * np.cos(turns), np.cos(fine[::-1])])
    y = np.concatenate([far * np.sin(turns), np.sin(fine[::-1])])
    return x, y


def _said(wear: Sequence[Array] | Array, sectors: int) -> str:
    """The greatest share of each surface in one sector."""
    journal, bush = (100.0 * float(np.max(share)) for share in wear)
    return _("greatest in {wide:.3g}°\njournal {journal:.2g} %\nbush {bush:.2g} %").format(
        wide=360.0 / sectors, journal=journal, bush=bush
    )
