"""Drawings of this program read back: places and lengths as they were drawn, or a refusal, never another mechanism."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.cli.main import main
from centrode.errors import CentrodeError
from centrode.kinematics.motion import initial_place
from samples import spread

READ = (
    "antiparallelogram", "cam-driven-linkage", "chebyshev-straight-line", "crank-rocker", "double-rocker",
    "drag-link", "elliptic-trammel", "five-bar-two-drives", "four-bar-and-slider", "four-bar-excerpt",
    "fourth-class-group", "galloway", "hoeken", "in-line-four-bar", "jansen-leg", "kite", "klann-leg",
    "pantograph", "parallelogram", "peaucellier", "scott-russell", "shaper", "single-cylinder-engine",
    "six-bar-press", "slider-between-cranks", "slider-crank-offset", "stephenson-driven-at-coupler",
    "stephenson-six-bar", "third-class-triad", "triple-rocker", "watt-six-bar", "whitworth-quick-return",
)  # fmt: skip
REFUSED = (
    "cardan-gear", "double-pendulum", "excavator-arm", "geared-five-bar", "inverted-slider-crank",
    "oscillating-cylinder", "planetary-gear-train", "rack-and-pinion", "rolling-wheel-rod", "scissor-lift",
    "scotch-yoke", "tangent-mechanism", "two-link-arm", "wiper",
)  # fmt: skip
"""Gears, racks, cylinders, several drives, sliders that are turned with a link, and lines that hide each other."""
DIGITS = {"svg": 1e-6, "dxf": 2e-8}
"""Of the size: the digits of SVG are a thousandth of a millimetre, those of a description nine."""

ONWARDS = 0.05
AMPLIFIED = 100
"""Errors of lengths grow by the inverse of the sine of a transmission angle; no linkage here is flatter than 1/100."""


def drawn(name: str, kind: str, folder: Path) -> Path:
    file = folder / f"{name}.{kind}"
    assert main(["draw", name, "--out", str(file)]) == 0
    return file


@pytest.mark.parametrize("name", spread(READ, 12))
@pytest.mark.parametrize("kind", ["svg", "dxf"])
def test_a_drawing_reads_back(
    name: str, kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = ct.import_sketch(drawn(name, kind, tmp_path)).mechanism
    mechanism = ct.example(name)
    ours, theirs = (places(one) for one in (mechanism, found))
    common = sorted(ours.keys() & theirs.keys())
    size = max(np.ptp(list(ours.values()), axis=0))
    for one, other in combinations(common, 2):
        apart = np.linalg.norm(ours[one] - ours[other]) - np.linalg.norm(theirs[one] - theirs[other])
        assert abs(apart) <= DIGITS[kind] * size, (one, other)
    # every link of more than a point is one, or part of what it forms with others
    links = [set(link.coordinates) for link in found.links.values()]
    for link in mechanism.links.values():
        points = set(link.coordinates)
        assert len(points) < 2 or any(points <= others for others in links), points
    assert ct.check(found).mobility == ct.check(mechanism).mobility
    drive, other = mechanism.drives[0], found.drives[0]
    if len(mechanism.drives) == 1 and drive.link == other.link and drive.relative_to == "frame":
        # where the drive is the same, all moves alike
        ours, theirs = (places(one, ONWARDS) for one in (mechanism, found))
        for one, two in combinations(common, 2):
            apart = np.linalg.norm(ours[one] - ours[two]) - np.linalg.norm(theirs[one] - theirs[two])
            assert abs(apart) <= AMPLIFIED * DIGITS[kind] * size, (one, two)


@pytest.mark.parametrize("name", spread(REFUSED, 6))
def test_what_cannot_be_told_from_lines_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(CentrodeError):
        ct.import_sketch(drawn(name, "svg", tmp_path))


def places(mechanism: ct.Mechanism, onwards: float = 0.0) -> dict[str, np.ndarray]:
    """Places of points, so far [rad] beyond the initial position."""
    first = ct.motion(mechanism, at=[initial_place(mechanism) + onwards]).isel(sample=0)
    return dict(zip(first.point.values.tolist(), first.position.values, strict=True))
