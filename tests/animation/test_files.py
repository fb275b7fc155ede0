"""Animations as files: frames, loops, palettes, bytes, what Ctrl-C leaves behind."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import imageio_ffmpeg
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from PIL import Image

import centrode as ct
from centrode.animation import video_files
from centrode.animation.layers import Array, Layer
from centrode.animation.stage import COLOURS, EXACT, Palette, Stage
from centrode.animation.video_files import Timing, write_gif, write_mp4


class Dot(Layer):
    """A dot that goes round."""

    def __init__(self, frames: int) -> None:
        self.turns = 2 * np.pi * np.arange(frames) / frames

    def reach(self) -> Array:
        return np.array([[-1.5, -1.5], [1.5, 1.5]])

    def draw(self, axes: Axes, frame: int) -> None:
        turn = self.turns[frame]
        axes.plot([np.cos(turn)], [np.sin(turn)], "o", color="#D55E00", markersize=14)


class Flood(Layer):
    """A frame filled with one colour after the other."""

    def __init__(self, colours: list[str]) -> None:
        self.colours = colours

    def draw(self, axes: Axes, frame: int) -> None:
        axes.add_patch(
            Rectangle((0, 0), 1, 1, color=self.colours[frame], transform=axes.transAxes, antialiased=False)
        )


def stage(frames: int, **more: Any) -> Stage:
    return Stage([Dot(frames)], frames, (160, 120), **more)


def frames_of(path: Path) -> list[np.ndarray]:
    with Image.open(path) as picture:
        found = []
        for number in range(getattr(picture, "n_frames", 1)):
            picture.seek(number)
            found.append(np.asarray(picture.convert("RGB")).astype(int))
    return found


def decoded(path: Path, size: tuple[int, int]) -> list[np.ndarray]:
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-loglevel", "error", "-i", str(path)]
    command += ["-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    video = subprocess.run(command, capture_output=True, check=True).stdout
    return list(np.frombuffer(video, np.uint8).reshape(-1, size[1], size[0], 3).astype(int))


@pytest.mark.parametrize("dark", [False, True])
def test_a_loop_runs_on(tmp_path: Path, dark: bool) -> None:
    """The step from the last frame to the first is as large as any other."""
    said: list[tuple[int, int]] = []
    path = tmp_path / "dot.gif"
    write_gif(
        path,
        stage(12, dark=dark).pictures(),
        12,
        Timing(12, 20.0).delays,
        said=lambda done, of: said.append((done, of)),
    )
    found = frames_of(path)
    assert len(found) == 12
    assert said == [(k, 12) for k in range(1, 13)]
    changed = [int((a != b).any(axis=2).sum()) for a, b in zip(found, [*found[1:], found[0]], strict=True)]
    assert 0 < max(changed) <= 1.3 * min(changed)
    assert (found[0][2, 2].max() < 64) == dark
    with Image.open(path) as picture:
        assert picture.info["loop"] == 0
        assert picture.info["duration"] == 50
    assert [one.name for one in tmp_path.iterdir()] == ["dot.gif"]


def test_the_same_pictures_give_the_same_bytes(tmp_path: Path) -> None:
    paths = [tmp_path / name for name in ("one.gif", "two.gif")]
    for path in paths:
        write_gif(path, stage(3, title="Dot").pictures(), 3, [100, 100, 100])
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_nothing_of_a_frame_stays_in_the_next() -> None:
    """A frame on the ground that the frame before has been drawn on is the frame on a fresh one."""
    pictures = list(stage(4).pictures())
    for number in range(4):
        fresh = stage(4)
        alone = [Dot(4)]
        alone[0].turns = alone[0].turns[number:]
        first = list(Stage(alone, 1, fresh.size).pictures())[1]
        assert np.array_equal(first, pictures[number + 1])


def test_colours_that_come_late_are_kept(tmp_path: Path) -> None:
    """The palette is that of all frames, not of the first."""
    path = tmp_path / "colours.gif"
    colours = ["#FFFFFF", "#D55E00", "#0072B2", "#009E73"]
    write_gif(path, Stage([Flood(colours)], 4, (64, 64)).pictures(), 4, [100] * 4)
    for colour, frame in zip(colours, frames_of(path), strict=True):
        wanted = [int(colour[k : k + 2], 16) for k in (1, 3, 5)]
        assert frame[40, 40].tolist() == wanted


def test_a_palette_keeps_the_commonest_and_takes_the_nearest() -> None:
    random = np.random.default_rng(7)
    common = random.integers(0, 2**24, EXACT, dtype=np.uint32)
    rare = random.integers(0, 2**24, 3000, dtype=np.uint32)
    palette = Palette()
    palette.count(np.repeat(common, 50))
    palette.count(rare)
    palette.choose()
    table = np.array(palette.table).reshape(-1, 3)
    assert len(table) <= COLOURS

    def levels(packed: np.ndarray) -> np.ndarray:
        return np.stack([packed & 255, packed >> 8 & 255, packed >> 16 & 255], axis=-1).astype(int)

    assert np.array_equal(table[palette.numbers(common)], levels(common))
    apart = ((levels(rare)[:, None] - table) ** 2).sum(axis=2)
    taken = ((levels(rare) - table[palette.numbers(rare)]) ** 2).sum(axis=1)
    assert np.array_equal(taken, apart.min(axis=1))


def test_an_mp4_has_the_frames(tmp_path: Path) -> None:
    """Decoded, every frame is what was drawn, to what a video loses: its dot is where it was."""
    path = tmp_path / "dot.mp4"
    write_mp4(path, stage(12).pictures(), 12, 10.0)
    found = decoded(path, (160, 120))
    assert len(found) == 12
    for picture, video in zip(list(stage(12).pictures())[1:], found, strict=True):
        drawn = np.argwhere((picture >> 16 & 255) < 64).mean(axis=0)  # little blue: the dot
        seen = np.argwhere(video[..., 2] < 96).mean(axis=0)
        assert np.abs(drawn - seen).max() < 1.0  # a pixel: colours have half the resolution


@pytest.mark.parametrize("name", ["dot.gif", "dot.mp4"])
def test_an_interruption_leaves_nothing_and_takes_nothing_away(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(b"old")

    def said(done: int, _of: int) -> None:
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        if path.suffix == ".gif":
            write_gif(path, stage(6).pictures(), 6, [50] * 6, said)
        else:
            write_mp4(path, stage(6).pictures(), 6, 10.0, said)
    assert [one.name for one in tmp_path.iterdir()] == [name]
    assert path.read_bytes() == b"old"


def test_mp4_without_its_library_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> Any:
        raise ModuleNotFoundError(name="imageio_ffmpeg")

    monkeypatch.setattr(video_files, "_ffmpeg", missing)
    with pytest.raises(ct.InputError, match=r'pip install -e "\.\[video\]" .*, or name a \.gif'):
        ct.animate(ct.example("crank-rocker"), tmp_path / "a.mp4")
    assert list(tmp_path.iterdir()) == []
