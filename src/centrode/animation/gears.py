"""Layers of gears: teeth in mesh with their contacts on the line of action, and the rack that generates a wheel."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from centrode.animation.frames import frame_ways
from centrode.animation.layers import Array, Layer
from centrode.animation.stage import Stage
from centrode.animation.video_files import PER_SECOND, SIZE, Said, Timing, no_progress, write_stage
from centrode.gears.profiles import rack_over_pinion, wheel_outline
from centrode.gears.racks import rack_positions, rack_tooth
from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.render.drawing.cams import CHAIN
from centrode.render.drawing.style import INK, MUTED, PALETTE

if TYPE_CHECKING:
    from centrode.gears.pair_geometry import PairGeometry
    from centrode.gears.results import GearPairResults

FRAMES_OF_A_PITCH = 40
"""Pictures of one pitch; the last leads to the first."""
PITCHES_SHOWN = 2.6
"""So many pitches to either side of the pitch point are shown."""
FRAMES_OF_GENERATION = 60
ROLLED = 1.5
"""The rack rolls by so many pitches to either side."""
SHOWN_RACK_TEETH = 6
"""Teeth of a rack that are drawn to either side of the pinion."""
RACK_TEETH = 5


class MeshLayer(Layer):
    """Both wheels, or a wheel and its rack, about the pitch point, over one pitch."""

    def __init__(self, pair: PairGeometry, outlines: Sequence[Array], frames: int, factor: float) -> None:
        self.pair = pair
        self.factor = factor
        self.turned = 2 * math.pi / pair.teeth[0] * frame_ways("round", frames)
        self.outlines = outlines
        self.pitch = pair.wheels[0].working_pitch / 2
        self.half = PITCHES_SHOWN * math.pi * pair.transverse.module

    def reach(self) -> Array:
        """A window about the pitch point."""
        middle, half = np.array([0.0, self.pitch]), self.half
        return np.asarray(self.factor * (middle + np.array([[-half, -0.6 * half], [half, 0.6 * half]])))

    def bodies(self, frame: int) -> list[Array]:
        """Outlines (n, 2) of pinion and wheel in a frame [m]; the pinion turns clockwise."""
        pair, turned = self.pair, float(self.turned[frame])
        placed = [_turn(self.outlines[0], -turned)]
        if pair.kind == "rack":
            return [*placed, rack_over_pinion(pair, SHOWN_RACK_TEETH, pair.wheels[0].pitch / 2 * turned)]
        step = 2 * math.pi / pair.teeth[1]
        # A gap of the wheel takes the pinion's tooth at the pitch point.
        begin = step / 2 + (math.pi if pair.sign > 0 else 0.0)
        wheel = _turn(self.outlines[1], begin + pair.sign * turned / pair.ratio)
        return [*placed, wheel + np.array([0.0, pair.sign * pair.centre_distance])]

    def contacts(self, frame: int) -> Array:
        """Places (k, 2) where flanks touch on the active line of action [m]."""
        pair = self.pair
        begin, end = pair.action_ends
        # The involute unwinds from the base circle: its right flank lies half a tooth ahead of the pitch point.
        rolled = math.tan(pair.working_angle) + _half_angle(pair) + float(self.turned[frame])
        places = np.arange(-4.0, 5.0) * pair.base_pitch + pair.wheels[0].base / 2 * rolled
        kept: Array = places[(places >= max(begin, 0.0)) & (places <= end)]
        return _on_line(pair, kept)

    def ground(self, axes: Axes) -> None:
        """The working pitch circles and the active line of action."""
        pair = self.pair
        angles = np.linspace(-math.pi, math.pi, 721)
        for wheel in pair.wheels:
            if wheel.is_rack:
                axes.axhline(self.factor * self.pitch, color=MUTED, linewidth=0.9, linestyle=CHAIN)
                continue
            centre = 0.0 if wheel.number == 0 else pair.sign * pair.centre_distance
            radius = wheel.working_pitch / 2
            circle = np.stack([radius * np.sin(angles), centre + radius * np.cos(angles)])
            axes.plot(*(self.factor * circle), color=MUTED, linewidth=0.9, linestyle=CHAIN, zorder=2)
        ends = _on_line(pair, np.array([max(pair.action_ends[0], 0.0), pair.action_ends[1]]))
        axes.plot(*(self.factor * ends.T), color=INK, linewidth=1.2, zorder=6)

    def draw(self, axes: Axes, frame: int) -> None:
        """The teeth, and where they touch."""
        for number, outline in enumerate(self.bodies(frame)):
            colour = PALETTE[number]
            places = self.factor * outline
            if number == 0 or self.pair.kind == "external":
                axes.add_artist(Polygon(places, facecolor=colour, edgecolor="none", alpha=0.15, zorder=3))
            closed = places if self.pair.kind == "rack" and number else np.concatenate([places, places[:1]])
            axes.plot(*closed.T, color=colour, linewidth=1.6, zorder=4)
        axes.plot(
            *(self.factor * self.contacts(frame).T),
            linestyle="none",
            marker="o",
            markersize=6,
            color=INK,
            zorder=7,
        )

    def entries(self) -> Sequence[tuple[Artist, str]]:
        """What the lines mean."""
        other = _("rack") if self.pair.kind == "rack" else _("wheel")
        return [
            (Line2D([], [], color=PALETTE[0], linewidth=1.6), _("pinion")),
            (Line2D([], [], color=PALETTE[1], linewidth=1.6), other),
            (Line2D([], [], color=INK, linewidth=1.2), _("active line of action")),
            (Line2D([], [], color=INK, marker="o", linestyle="none"), _("contact")),
        ]


class GenerationLayer(Layer):
    """The rack that rolls about a wheel at rest: its positions stay behind it and envelope the tooth gap."""

    def __init__(self, pair: PairGeometry, outline: Array, frames: int, factor: float) -> None:
        self.factor = factor
        self.outline = outline
        self.pitch = pair.wheels[0].pitch / 2
        step = 2 * math.pi / pair.teeth[0]
        rolled = np.linspace(-ROLLED * step, ROLLED * step, frames)
        tooth = rack_tooth(pair.transverse, pair.wheels[0].shift * pair.module)
        pitch = math.pi * pair.transverse.module
        middle = np.arange(RACK_TEETH) - RACK_TEETH // 2
        rack = np.concatenate([tooth + np.array([place * pitch, 0.0]) for place in middle])
        self.positions = rack_positions(rack, self.pitch, rolled)
        self.half = 1.35 * pitch
        # The gap of the wheel lies in the middle, where the rack's tooth cuts it.
        self.wheel = _turn(outline, step / 2)

    def reach(self) -> Array:
        """A window about the gap that is cut."""
        middle, half = np.array([0.0, self.pitch]), self.half
        return np.asarray(self.factor * (middle + np.array([[-half, -0.75 * half], [half, 0.75 * half]])))

    def ground(self, axes: Axes) -> None:
        """The wheel that comes out, and its pitch circle."""
        places = self.factor * self.wheel
        axes.add_artist(Polygon(places, facecolor=PALETTE[0], edgecolor="none", alpha=0.12, zorder=2))
        axes.plot(*np.concatenate([places, places[:1]]).T, color=PALETTE[0], linewidth=1.8, zorder=5)
        angles = np.linspace(-math.pi, math.pi, 721)
        circle = self.factor * self.pitch * np.stack([np.sin(angles), np.cos(angles)])
        axes.plot(*circle, color=MUTED, linewidth=0.9, linestyle=CHAIN, zorder=2)

    def draw(self, axes: Axes, frame: int) -> None:
        """The rack, and the positions it has had."""
        past = self.factor * self.positions[: frame + 1 : 3]
        axes.add_artist(LineCollection(list(past), colors=MUTED, linewidths=0.6, zorder=3))
        axes.plot(*(self.factor * self.positions[frame]).T, color=PALETTE[1], linewidth=1.8, zorder=6)

    def entries(self) -> Sequence[tuple[Artist, str]]:
        """What the lines mean."""
        return [
            (Line2D([], [], color=PALETTE[0], linewidth=1.8), _("pinion")),
            (Line2D([], [], color=PALETTE[1], linewidth=1.8), _("generating rack")),
            (Line2D([], [], color=MUTED, linewidth=0.6), _("positions of the rack")),
        ]


def _turn(places: Array, angle: float) -> Array:
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.asarray(places @ np.array([[cosine, sine], [-sine, cosine]]))


def _half_angle(pair: PairGeometry) -> float:
    """Half of the angle [rad] that a tooth of the pinion subtends at the working pitch circle."""
    wheel = pair.wheels[0]
    return float(wheel.thickness(wheel.working_pitch) / wheel.working_pitch)


def _on_line(pair: PairGeometry, radii: Array) -> Array:
    """Places (k, 2) on the line of action by the radius of curvature of the pinion's flank [m]."""
    angle, pitch = pair.working_angle, np.array([0.0, pair.wheels[0].working_pitch / 2])
    along = np.array([math.cos(angle), math.sin(angle)])
    # The pinion turns clockwise: its driving flanks touch on the right of their teeth.
    return np.asarray(pitch + np.outer(radii - pair.pitch_curvature_radius, along))


def mesh_stage(
    results: GearPairResults,
    frames: int = FRAMES_OF_A_PITCH,
    size: tuple[int, int] = SIZE,
    *,
    dark: bool = False,
) -> Stage:
    """The stage of teeth in mesh over one pitch."""
    outlines = [wheel_outline(profile) for profile in results.profiles]
    factor = shown_as("m", results.gear_pair.display)[0]
    layer = MeshLayer(results.geometry, outlines, frames, factor)
    return Stage([layer], frames, size, _(results.gear_pair.title), dark=dark)


def generation_stage(
    results: GearPairResults,
    frames: int = FRAMES_OF_GENERATION,
    size: tuple[int, int] = SIZE,
    *,
    dark: bool = False,
) -> Stage:
    """The stage of the rack that generates the pinion."""
    factor = shown_as("m", results.gear_pair.display)[0]
    layer = GenerationLayer(results.geometry, wheel_outline(results.profiles[0]), frames, factor)
    return Stage([layer], frames, size, _(results.gear_pair.title), dark=dark)


STAGES: dict[str, tuple[Callable[..., Stage], int]] = {
    "mesh": (mesh_stage, FRAMES_OF_A_PITCH),
    "generation": (generation_stage, FRAMES_OF_GENERATION),
}
"""Animations of a pair by the names of their files, with their frames."""


def animate_gears(
    results: GearPairResults,
    folder: Path,
    *,
    frames: int | None = None,
    size: tuple[int, int] = SIZE,
    dark: bool = False,
    said: Said = no_progress,
) -> list[Path]:
    """Write the animations of a pair, mesh.gif and generation.gif, into a folder; returns the files."""
    files = []
    for name, (make, usual) in STAGES.items():
        files.append(folder / f"{name}.gif")
        stage = make(results, frames or usual, size, dark=dark)
        write_stage(stage, files[-1], Timing(stage.frames, PER_SECOND), said)
    return files
