"""Animations of gears: contacts lie on the flanks of both wheels in every picture, no tooth enters another."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.path import Path as Outline

import centrode as ct
from centrode.animation.gears import FRAMES_OF_A_PITCH, GenerationLayer, MeshLayer, animate_gears, mesh_stage
from centrode.gears.profiles import wheel_outline


def distance(places: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """Of places (k, 2) from a line through points (n, 2)."""
    begin, along = outline[:-1], np.diff(outline, axis=0)
    square = np.maximum((along**2).sum(axis=1), 1e-300)
    from_begin = places[:, None, :] - begin[None]
    share = np.clip((from_begin * along).sum(axis=2) / square, 0.0, 1.0)
    return np.asarray(np.linalg.norm(from_begin - share[..., None] * along, axis=2).min(axis=1))


@pytest.mark.parametrize("name", ["shifted-gear-pair", "internal-gear-pair", "rack-gear-pair"])
def test_flanks_touch_on_the_line_of_action(name: str) -> None:
    results = ct.gear_pair(name)
    pair = results.geometry
    layer = MeshLayer(pair, [wheel_outline(profile) for profile in results.profiles], 12, 1.0)
    counts = []
    for frame in range(12):
        contacts = layer.contacts(frame)
        counts.append(len(contacts))
        for outline in layer.bodies(frame):
            # Outlines are chords between places of the flank: they depart by less than 1e-3 of the module.
            assert (distance(contacts, outline) < 1e-3 * pair.module).all(), (frame, outline[0])
    assert min(counts) >= int(pair.contact_ratio)
    assert np.mean(counts) == pytest.approx(pair.contact_ratio, abs=1 / 12 + 1e-9)


def test_no_place_of_the_rack_lies_in_the_wheel_that_it_generates() -> None:
    results = ct.gear_pair("shifted-gear-pair")
    layer = GenerationLayer(results.geometry, wheel_outline(results.profiles[0]), 20, 1.0)
    wheel = Outline(layer.wheel)
    module = results.geometry.module
    for position in layer.positions:
        inside = position[wheel.contains_points(position)]
        # Corners of chords lie inside by what the chords depart.
        assert not len(inside) or distance(inside, layer.wheel).max() < 2e-3 * module


def test_files(tmp_path: Path) -> None:
    results = ct.gear_pair("rack-gear-pair")
    assert mesh_stage(results).frames == FRAMES_OF_A_PITCH
    files = animate_gears(results, tmp_path, size=(160, 120), frames=3)
    assert [file.name for file in files] == ["mesh.gif", "generation.gif"]
    assert all(file.stat().st_size > 1000 for file in files)
