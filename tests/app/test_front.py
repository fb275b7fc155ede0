"""The files of the page: what the package serves is what its sources give, checked types included."""

from __future__ import annotations

import gzip
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from centrode.app.words import WORDS

APP = Path(__file__).parents[2] / "src" / "centrode" / "app"
FRONT, STATIC = APP / "front", APP / "static"
NAMES = (
    "index.html",
    "app.js",
    "app.css",
    "editor.js",
    "licences.txt",
    "gears.html",
    "gears.js",
    "gears.css",
)
MOST = {"app.js": 120_000, "editor.js": 150_000}
"""Bytes that a browser loads, compressed."""
SAID = re.compile(r'\bsay\(\s*"([a-z_]+)"|\bsay\([^()]*? \? "([a-z_]+)" : "([a-z_]+)"\)|"(keys_[a-z]+)"')


def test_the_page_is_small() -> None:
    for name, most in MOST.items():
        assert len(gzip.compress((STATIC / name).read_bytes(), 9)) < most


def test_the_page_is_what_its_sources_give(tmp_path: Path) -> None:
    npm = shutil.which("npm")
    if npm is None or shutil.which("node") is None:
        pytest.skip("no npm: the page cannot be built here")
    if not (FRONT / "node_modules").is_dir():
        pytest.skip("no packages of npm: npm ci in src/centrode/app/front")
    types = subprocess.run(
        [npm, "run", "types", "--silent"], cwd=FRONT, capture_output=True, text=True, check=False
    )
    assert types.returncode == 0, types.stdout
    subprocess.run(["node", "build.mjs", "--out", str(tmp_path)], cwd=FRONT, check=True)
    for name in NAMES:
        assert (tmp_path / name).read_bytes() == (STATIC / name).read_bytes(), f"npm run build: {name}"


def test_packages_are_pinned() -> None:
    given = json.loads((FRONT / "package.json").read_text("utf-8"))
    lock = json.loads((FRONT / "package-lock.json").read_text("utf-8"))["packages"]
    for name, version in given["devDependencies"].items():
        assert lock[f"node_modules/{name}"]["version"] == version
    assert all("integrity" in one for name, one in lock.items() if name)
    assert "node_modules/codemirror" not in lock  # which is not CodeMirror 6 in its last version


def test_every_sentence_of_the_page_is_one_of_the_server() -> None:
    said: set[str] = set()
    for file in [*FRONT.glob("*.ts"), *FRONT.glob("*.tsx")]:
        said |= {key for found in SAID.findall(file.read_text("utf-8")) for key in found if key}
    assert len(said) > 80
    assert said <= set(WORDS)


def called(module: str, function: str, argument: object) -> Any:
    """What a function of a module of the page returns, from Node."""
    if shutil.which("node") is None or not (FRONT / "node_modules").is_dir():
        pytest.skip("no node or no packages of npm: npm ci in src/centrode/app/front")
    program = (
        'import { build } from "esbuild";'
        f'const made = await build({{ entryPoints: ["{module}.ts"], bundle: true, format: "esm", write: false }});'
        'const room = await import("data:text/javascript;base64," + Buffer.from(made.outputFiles[0].contents)'
        '.toString("base64"));'
        f"console.log(JSON.stringify(room.{function}({json.dumps(argument)})));"
    )
    done = subprocess.run(
        ["node", "--input-type=module", "--eval", program],
        cwd=FRONT,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


@pytest.mark.parametrize(
    ("paths", "told"),
    [
        (["points.B.0", "points.B.1", "points.C.0"], "points.B, points.C"),
        (["frame.points.A.1", "frame.points.D.0"], "frame.points.A, frame.points.D"),
        (["links.AB.length", "links.AB.length"], "links.AB.length"),
        (
            ["links.AB.points.C.0", "links.AB.points.C.1", "links.BC.angle"],
            "links.AB.points.C, links.BC.angle",
        ),
        (["links.AB.length", "links.AB.angle", "links.BC"], "links.AB, links.BC"),
        (["drives.0.start", "drives.1"], "drives.0.start, drives.1"),
        (["drives.0", "drives.0.speed"], "drives.0"),
        ([f"points.{name}.0" for name in "ABCDEF"], "points.A, points.B, points.C, points.D, …"),
    ],
)
def test_elements_that_an_edit_changed_are_told_once(paths: list[str], told: str) -> None:
    assert called("changes", "changedText", paths) == told


@pytest.mark.parametrize(
    ("plain", "typeset"),
    [
        ("within 1.2e-03 m/s² of", "within 1.2·10⁻³\u00a0m/s² of"),
        ("3.6e-14 1/s in", "3.6·10⁻¹⁴\u00a01/s in"),
        ("2e+05 1/(m·rad)", "2·10⁵\u00a01/(m·rad)"),
        ("-1.5 Н·м/рад", "−1.5\u00a0Н·м/\u2060рад"),
        ("12 °/s", "12\u00a0°/s"),
        ("12 samples", "12 samples"),
        ("0e+00 m", "0\u00a0m"),
    ],
)
def test_a_number_keeps_its_power_and_its_unit(plain: str, typeset: str) -> None:
    assert called("typeset", "typeset", plain) == typeset
