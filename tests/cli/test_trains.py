"""`centrode trains` as a user meets it: lists, files, a machine with its train, ratios that no train has."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct

Centrode = Callable[..., Any]


def test_tables_plans_and_the_mechanism(centrode: Centrode, folder: Path) -> None:
    done = centrode("trains", "stepped-planet-train", "--out", "train")
    assert done.code == 0, done
    pictures = {
        f"{name}.{kind}" for name in ("wheels", "velocities", "angular-velocities") for kind in ("png", "svg")
    }
    names = {path.name for path in (folder / "train").iterdir()}
    assert names == pictures | {"trains.csv", "members.csv", "summary.json", "train.toml"}
    with (folder / "train" / "trains.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(ct.gear_train("stepped-planet-train").found.trains)
    sun, planet, other, ring = (int(float(rows[0][f"teeth_{place}"])) for place in range(1, 5))
    assert float(rows[0]["ratio"]) == pytest.approx(1 + planet * ring / (sun * other))
    summary = json.loads((folder / "train" / "summary.json").read_text(encoding="utf-8"))
    assert summary["ratio"]["value"] == pytest.approx(float(rows[0]["ratio"]))
    assert centrode("check", "train/train.toml").code == 0


def test_a_machine_with_its_train(centrode: Centrode, folder: Path) -> None:
    assert centrode("trains", "single-planet-train", "--drives", "six-bar-press", "--out", "train").code == 0
    done = centrode("check", "train/train.toml")
    assert done.code == 0
    assert "carrier-1-OA" in done.out
    refused = centrode("trains", "two-ring-train", "--drives", "six-bar-press")
    assert refused.code == 2
    assert "no pair behind" in refused.err


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
@pytest.mark.parametrize("name", ct.example_names("gear train"))
def test_every_train_is_said_in_every_language(centrode: Centrode, name: str, language: str) -> None:
    done = centrode("--lang", language, "trains", name)
    assert done.code == 0, done
    assert "nan" not in done.out
    if language != "en":
        assert "carrier" not in done.out
        assert "ratio" not in done.out


def test_a_ratio_that_no_train_has_ends_with_code_three(centrode: Centrode, folder: Path) -> None:
    text = 'kind = "gear train"\nscheme = "single planets"\nratio = 40\nmodule = "2 mm"\n'
    (folder / "train.toml").write_text(text, encoding="utf-8")
    done = centrode("trains", "train.toml")
    assert done.code == 3
    assert done.err.startswith("Error: train.toml")
    assert "the nearest is" in done.err


@pytest.mark.parametrize("command", ["run", "cam", "gears", "describe"])
def test_other_commands_say_which_one_finds_trains(centrode: Centrode, command: str) -> None:
    done = centrode(command, "single-planet-train")
    assert done.code == 2
    assert "centrode trains" in done.err


def test_a_linkage_is_no_train(centrode: Centrode) -> None:
    done = centrode("trains", "crank-rocker")
    assert done.code == 2
    assert "this describes a linkage, not a train of gears" in done.err


def test_the_schema_of_trains(centrode: Centrode) -> None:
    schema = json.loads(centrode("schema", "--trains").out)
    assert schema["properties"]["kind"]["const"] == "gear train"
    assert centrode("schema", "--gears", "--trains").code == 2
