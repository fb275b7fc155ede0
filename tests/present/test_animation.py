"""Animations: as many frames as places, one palette, a loop that ends where it begins, the same bytes twice."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import centrode as ct
from centrode.present.animation import loop_places, write_animation


def dot(place: float) -> Figure:
    """A dot on a circle: the same after a whole turn."""
    figure = Figure(figsize=(1.6, 1.6))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(-1.5, 1.5)
    axes.set_ylim(-1.5, 1.5)
    axes.plot([np.cos(place)], [np.sin(place)], "o", color="#D55E00", markersize=14)
    return figure


def frames(path: Path) -> list[np.ndarray]:
    with Image.open(path) as picture:
        found = []
        for number in range(picture.n_frames):
            picture.seek(number)
            found.append(np.asarray(picture.convert("RGB")).astype(int))
    return found


def test_places_of_a_loop() -> None:
    places = loop_places(0.5, 4.0, 8)
    assert places.tolist() == [0.5 + 0.5 * k for k in range(8)]
    assert 0.5 + 4.0 not in places


@pytest.mark.parametrize("dark", [False, True])
def test_a_loop_runs_on(tmp_path: Path, dark: bool) -> None:
    """The step from the last frame to the first is as large as any other."""
    said: list[tuple[int, int]] = []
    path = tmp_path / "dot.gif"
    write_animation(
        path, dot, loop_places(0.0, 2 * np.pi, 12), dark=dark, said=lambda done, of: said.append((done, of))
    )
    found = frames(path)
    assert len(found) == 12
    assert said == [(k, 12) for k in range(1, 13)]
    changed = [int((a != b).any(axis=2).sum()) for a, b in zip(found, [*found[1:], found[0]], strict=True)]
    assert 0 < max(changed) <= 1.3 * min(changed)
    assert (found[0][2, 2].max() < 64) == dark
    with Image.open(path) as picture:
        assert picture.info["loop"] == 0
        assert picture.info["duration"] == 70


def test_the_same_pictures_give_the_same_bytes(tmp_path: Path) -> None:
    paths = [tmp_path / name for name in ("one.gif", "two.gif")]
    for path in paths:
        write_animation(path, dot, [0.0, 1.0, 2.0], milliseconds=100)
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_colours_that_come_late_are_kept(tmp_path: Path) -> None:
    """The palette is that of all frames, not of the first."""

    def coloured(colour: str) -> Figure:
        return Figure(figsize=(0.4, 0.4), facecolor=colour)

    path = tmp_path / "colours.gif"
    colours = ["#FFFFFF", "#D55E00", "#0072B2", "#009E73"]
    write_animation(path, coloured, colours)
    for colour, frame in zip(colours, frames(path), strict=True):
        wanted = [int(colour[k : k + 2], 16) for k in (1, 3, 5)]
        assert frame[5, 5].tolist() == wanted


def test_a_motion_that_closes_runs_on_and_another_there_and_back(tmp_path: Path) -> None:
    linkage = ct.example("spherical-four-bar")
    for name, last, count in (("round", 2 * np.pi, 12), ("back", 3.0, 24)):
        motion = ct.motion(linkage, at=np.linspace(0.0, last, 49))
        ct.animate_motion(linkage, motion, tmp_path / f"{name}.gif", frames=12)
        with Image.open(tmp_path / f"{name}.gif") as picture:
            assert getattr(picture, "n_frames", 1) == count


def test_a_motion_without_a_place_is_refused(tmp_path: Path) -> None:
    linkage = ct.example("spherical-four-bar")
    motion = ct.motion(linkage, at=np.linspace(0.0, 1.0, 3))
    motion["position"][:] = np.nan
    with pytest.raises(ct.InputError, match="no sample has every point in place"):
        ct.animate_motion(linkage, motion, tmp_path / "nothing.gif")
