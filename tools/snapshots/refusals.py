"""What the program refuses: wrong descriptions, and wrong options of right ones."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path

DESCRIPTIONS = Path(__file__).with_name("descriptions")
PRESS = (DESCRIPTIONS / "press.toml").read_text(encoding="utf-8")
CHANGES = tomllib.loads((DESCRIPTIONS / "changes.toml").read_text(encoding="utf-8"))

OPTIONS = (
    'run press.toml --samples 1000000000', 'run press.toml --samples 0', 'run press.toml --samples many',
    'run press.toml --from|1 kg', 'run press.toml --to|2 s', 'run press.toml --to inf', 'run press.toml --to|',
    'run press.toml --to|1e9 deg', 'run press.toml --range nothing', 'run press.toml --unknown', 'run press.toml --out press.toml',
    'run nowhere.toml', 'run kyte', 'run Kite', 'run .', 'run valve-cam', 'cam kite', 'unknown', 'examples kyte', 'examples --out',
    'check press.toml --lang de', 'equations press.toml --point Q', 'integrate press.toml --steps 0', 'integrate press.toml --method euler',
    'integrate press.toml --tolerance 2', 'rotatability press.toml --vary links.XY.length', 'rotatability press.toml --repair --vary links.AB.length=3:1',
    'limits five-bar-two-drives', 'limits five-bar-two-drives --drive XY', 'limits five-bar-two-drives --drive OA --hold|EC=1 kg',
    'region press.toml', 'region five-bar-two-drives --samples 1', 'polygons six-bar-press', 'polygons six-bar-press --at|1 m',
    'polygons crank-rocker --at|1 rad', 'diagrams slider-between-cranks-locked --at|2.5 rad', 'diagrams spherical-four-bar --at|1 rad',
    'diagrams crank-rocker --at|1 rad --scale speed=1', 'diagrams crank-rocker --at|1 rad --angle-step 1m', 'centres crank-rocker --pair OA',
    'centres crank-rocker --pair OA,XY', 'centrodes crank-rocker --link XY', 'centrodes crank-rocker --link OA --against OA',
    'plan crank-rocker --positions 1', 'plan crank-rocker --link XY', 'angles crank-rocker --samples 0', 'draw crank-rocker --out x.png',
    'draw crank-rocker --out x.svg --path XY', 'export crank-rocker', 'export spherical-four-bar --mjcf', 'report crank-rocker --format odt',
    'report crank-rocker --chapters nothing', 'report crank-rocker --digits 0', 'report crank-rocker --points XY', 'report crank-rocker --at|1 kg',
    'report crank-rocker --chapters flywheel', 'animate crank-rocker --out x.avi', 'animate crank-rocker --show nothing', 'animate crank-rocker --frames 0',
    'animate crank-rocker --size 5', 'animate crank-rocker --size 1x1', 'animate crank-rocker --points XY', 'balance single-cylinder-engine --on XY',
    'balance single-cylinder-engine --fraction 3', 'balance single-cylinder-engine --weights 1,2', 'balance six-bar-press --radius|OA=1 kg',
    'balance single-cylinder-engine --full --least-maximum', 'flywheel crank-rocker', 'flywheel six-bar-press --mean other',
    'simulate crank-rocker', 'simulate six-bar-press --duration|1 m', 'simulate six-bar-press --driving|20 - * v --duration|1 s',
    'simulate six-bar-press-run-up --turns -1', 'simulate six-bar-press-run-up --scheme euler', 'sweep press.toml', 'sweep nowhere.toml',
    'variants press.toml', 'variants press.toml --topology kite', 'variants nowhere.csv --topology kite', 'cam valve-cam --terms 0',
    'cam valve-cam --samples 0', 'cam indexing-cam --groove', 'cam cam-from-curvature --laws', 'schema --cam --other', 'reduce crank-rocker',
    'reactions spherical-crank-rocker', 'reactions crank-rocker', 'animate slider-between-cranks-locked --from|0 deg --to|172 deg --frames 2 --size 160x120',
)  # fmt: skip
"""Words apart by blanks; behind a `|` a word that may hold some."""


def _words(line: str) -> list[str]:
    found: list[str] = []
    for part in line.split(" --"):
        head, bar, tail = part.partition("|")
        words = (head if not found else f"--{head}").split()
        found += [*words, tail] if bar else words
    return found


REFUSALS: Mapping[str, tuple[Sequence[str], Mapping[str, str]]] = {
    **{line: (_words(line), {"press.toml": PRESS}) for line in OPTIONS},
    **{
        name: (["run", "press.toml", "--no-figures", "--out", "out"], {"press.toml": PRESS.replace(one["replace"], one["by"], 1)})
        for name, one in CHANGES.items()
    },
}
"""Name -> arguments and files."""
