"""Make the figures of the theory pages of cams and of the sphere: docs/images/theory-cams.png, theory-sphere.png.

python -m tools.theory_figures
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

import centrode as ct
from centrode.cams.cam import cam_routes
from centrode.cams.path_series import path_of
from centrode.geometry import sphere
from centrode.geometry.on_sphere import SPHERE, SphereCircle
from centrode.model.cam import vary_cam
from centrode.numerics.arrays import ARRAYS
from centrode.present.style import INK, MUTED, PALETTE, house_style

Array: TypeAlias = NDArray[np.float64]

FOLDER = Path(__file__).parents[1] / "docs" / "images"
SIZE = (8.4, 4.0)
DOTS = 110
ROLLERS = (6.0, 11.645, 24.0)
"""Radii [mm] of rollers on one path of their centre: harmless, the greatest one, too large."""
PATH_RADIUS = 36.0
LIFTING = """
[[segments]]
angle = "40 deg"
to = "25 mm"
curve = "cycloidal"
[[segments]]
angle = "60 deg"
curve = "dwell"
[[segments]]
angle = "80 deg"
to = 0
curve = "3-4-5"
[[segments]]
angle = "180 deg"
curve = "dwell"
[study]
show_undercut = true
"""
VIEW = np.array([0.75, 0.35, 0.56])
CENTRES = (np.array([1.0, -0.15, 0.1]), np.array([0.55, 0.75, 0.25]))
ARCS = (math.radians(42), math.radians(30))


def cams() -> Figure:
    """Cusps of an equidistant, and the circle in which a series converges."""
    figure = Figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2)
    _rollers(left)
    _convergence(right)
    return figure


def _rollers(axes: Axes) -> None:
    """Profiles under three rollers whose centres run on one path."""
    angles = np.radians(np.linspace(10.0, 62.0, 2001))
    for radius, colour in zip(ROLLERS, PALETTE, strict=False):
        head = f'kind = "cam"\n[cam]\nbase_radius = "{PATH_RADIUS - radius} mm"\n'
        roller = f'[follower]\nroller_radius = "{radius} mm"\n'
        body = ct.follower_cam(ct.parse_cam(head + roller + LIFTING))
        contact = body.contact(angles)
        axes.plot(*(1e3 * contact.place).T, color=colour, label=f"profile, r = {radius:g} mm")
        for loop in body.undercuts:
            cusps = 1e3 * body.contact(np.array([loop.start, loop.stop])).place
            axes.plot(*cusps.T, "o", color=colour, markersize=4)
            middle = body.contact(np.array([0.5 * (loop.start + loop.stop)]))
            _roller(axes, 1e3 * middle.centre[0], radius, colour)
    axes.plot(*(1e3 * contact.centre).T, color=INK, linewidth=1.0, label="path of the centre")
    axes.set_aspect("equal")
    axes.set_xlim(8.0, 52.0)
    axes.set_ylim(9.0, 54.0)
    axes.set_xlabel("x, mm")
    axes.set_ylabel("y, mm")
    axes.legend(loc="lower left", fontsize=7.5)


def _roller(axes: Axes, centre: Array, radius: float, colour: str) -> None:
    turn = np.linspace(0.0, math.tau, 181)
    circle = centre[:, None] + radius * np.array([np.cos(turn), np.sin(turn)])
    axes.plot(*circle, color=colour, linewidth=0.7, linestyle=":")
    axes.plot(*centre, "+", color=colour)


def _convergence(axes: Axes) -> None:
    """The plane of complex angles of the paper's cam."""
    cam = ct.example("cam-from-curvature")
    facts = cam_routes(cam, samples=2).attrs
    x, y = np.degrees(facts["singularity"])
    radius = math.degrees(facts["radius_of_convergence"])
    turn = np.linspace(0.0, math.tau, 361)
    axes.fill(radius * np.cos(turn), radius * np.sin(turn), color=PALETTE[5], alpha=0.18, linewidth=0)
    axes.plot(radius * np.cos(turn), radius * np.sin(turn), color=PALETTE[0], linewidth=1.0)
    axes.plot([0.0, 90.0], [0.0, 0.0], color=INK, linewidth=2.4, solid_capstyle="butt")
    axes.plot([x, x], [y, -y], "x", color=PALETTE[1], markersize=7, markeredgewidth=2)
    stall = math.degrees(float(path_of(vary_cam(cam, {"range.to": 2.3})).stall or math.nan))
    axes.plot([stall], [0.0], "D", color=PALETTE[1], markersize=4)
    axes.annotate("cos γ = 0", (x, y), (x + 8, y + 4), color=PALETTE[1])
    axes.annotate("stall", (stall, 0.0), (stall - 9, 7), color=PALETTE[1])
    axes.annotate("the paper's table", (2.0, -12.0), color=INK)
    axes.annotate("the series\nconverges here", (-55.0, 28.0), color=PALETTE[0])
    axes.set_aspect("equal")
    axes.set_xlim(-100.0, 145.0)
    axes.set_ylim(-112.0, 112.0)
    axes.set_xlabel("real part of φ, deg")
    axes.set_ylabel("imaginary part of φ, deg")


def on_sphere() -> Figure:
    """Two circles that meet, and two measures of how far places are apart."""
    figure = Figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.05))
    _circles(left)
    _measures(right)
    return figure


def _circles(axes: Axes) -> None:
    """Two circles about two centres, the places where they meet, the arcs between."""
    eye = VIEW / np.linalg.norm(VIEW)
    right = np.cross([0.0, 0.0, 1.0], eye)
    right /= np.linalg.norm(right)
    view = np.stack([right, np.cross(eye, right), eye])
    first, second = (one / np.linalg.norm(one) for one in CENTRES)
    halves = [sphere.half(ARRAYS, arc) for arc in ARCS]
    met = [
        np.array(
            SPHERE.meet(
                SphereCircle(tuple(first), halves[0]), SphereCircle(tuple(second), halves[1]), root, root
            )
        )
        for root in (np.sqrt, lambda radicand: -np.sqrt(radicand))
    ]
    turn = np.linspace(0.0, math.tau, 361)
    axes.plot(np.cos(turn), np.sin(turn), color=MUTED, linewidth=1.0)
    for centre, arc, colour in zip((first, second), ARCS, PALETTE, strict=False):
        across = np.cross(centre, [0.0, 0.0, 1.0])
        across /= np.linalg.norm(across)
        ring = np.cos(turn)[:, None] * across + np.sin(turn)[:, None] * np.cross(centre, across)
        _line(axes, view, math.cos(arc) * centre + math.sin(arc) * ring, colour, 1.5)
        for place in met:
            _line(axes, view, _arc(centre, place), colour, 0.9)
    _line(axes, view, _arc(first, second), INK, 1.5)
    names = ((first, "$p_1$", (-13, -12)), (second, "$p_2$", (5, -10)), (met[0], "$x_+$", (-7, 10)),
             (met[1], "$x_-$", (-3, -16)), (_arc(first, second)[24], "$l$", (-14, -11)),
             (_arc(first, met[0])[24], "$r_1$", (-13, 2)), (_arc(second, met[0])[24], "$r_2$", (5, 2)))  # fmt: skip
    for place, name, shift in names:
        flat = view[:2] @ place
        if name[1] in "px":
            axes.plot(*flat, "o", color=INK, markersize=4, zorder=5)
        axes.annotate(name, flat, shift, textcoords="offset points", color=INK)
    axes.set_aspect("equal")
    axes.set_axis_off()


def _arc(start: Array, end: Array) -> Array:
    angle = math.acos(float(start @ end))
    share = np.linspace(0.0, 1.0, 49)[:, None]
    return np.asarray((np.sin((1 - share) * angle) * start + np.sin(share * angle) * end) / math.sin(angle))


def _line(axes: Axes, view: Array, places: Array, colour: str, width: float) -> None:
    """A curve on the sphere, dashed where it is behind."""
    flat = places @ view.T
    front = flat[:, 2] >= 0
    for seen, dashes in ((front, "-"), (~front, (0, (2, 2)))):
        axes.plot(
            *np.where(seen[:, None], flat[:, :2], np.nan).T, color=colour, linewidth=width, linestyle=dashes
        )


def _measures(axes: Axes) -> None:
    """What vanishes where two places are the same: of the one measure the opposite place, too."""
    arcs = np.linspace(0.0, math.pi, 721)[:-1]
    axes.plot(np.degrees(arcs), np.sin(arcs), color=PALETTE[1], label="$\\sin l$")
    axes.plot(np.degrees(arcs), 2.0 * np.tan(arcs / 2.0), color=PALETTE[0], label="$2\\,\\tan(l/2)$")
    axes.plot([0.0], [0.0], "o", color=INK, clip_on=False, zorder=5)
    axes.plot([180.0], [0.0], "o", color=PALETTE[1], clip_on=False, zorder=5)
    start = 2.5
    for value, slope, colour in (
        (math.sin(start), math.cos(start), PALETTE[1]),
        (2.0 * math.tan(start / 2.0), 1.0 / math.cos(start / 2.0) ** 2, PALETTE[0]),
    ):
        end = start - value / slope
        axes.plot(np.degrees([start, end]), [value, 0.0], color=colour, linewidth=0.9, linestyle="--")
        axes.plot(math.degrees(start), value, "o", color=colour, markersize=3)
    axes.axvline(math.degrees(start), color=MUTED, linewidth=0.7, linestyle=":")
    axes.set_xlim(0.0, 200.0)
    axes.set_ylim(0.0, 7.0)
    axes.set_xticks([0, 45, 90, 135, 180])
    axes.set_xlabel("arc l, deg")
    axes.annotate("opposite place", (180.0, 0.0), (147.0, 0.8), color=PALETTE[1])
    axes.legend(loc="upper left", title="dashed: Newton's step")


def main() -> None:
    """Write the pictures."""
    with house_style():
        for name, figure in (("theory-cams", cams()), ("theory-sphere", on_sphere())):
            figure.savefig(FOLDER / f"{name}.png", dpi=DOTS, metadata={"Software": None})


if __name__ == "__main__":
    main()
