"""The files of the page: what the package serves is what its sources give, checked types included."""

from __future__ import annotations

import gzip
import json
import re
import shutil
import subprocess
from pathlib import Path

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
