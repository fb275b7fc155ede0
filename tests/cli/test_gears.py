"""`centrode gears` as a user meets it; pairs that cannot work; other commands about pairs."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct

Centrode = Callable[..., Any]
PAIR = """kind = "gear pair"
module = "3 mm"
"""


@pytest.mark.parametrize(
    ("rest", "said"),
    [
        ("teeth = [12, 24]\nshifts = [1.1, -0.3]", "pointed"),
        ("teeth = [12, 24]\nshifts = [1.2, 1.2]", "below one"),
        ("teeth = [12, 24]\nshifts = [1.19, 0.25]", "run into its fillets"),
    ],
)
def test_a_pair_that_cannot_work_is_shown_and_ends_with_code_three(
    centrode: Centrode, folder: Path, rest: str, said: str
) -> None:
    (folder / "pair.toml").write_text(PAIR + rest, encoding="utf-8")
    done = centrode("gears", "pair.toml")
    assert done.code == 3
    assert "pinion" in done.out
    assert said in done.err
    assert done.err.startswith("Error: pair.toml: ")


def test_tables_drawings_and_outlines(centrode: Centrode, folder: Path) -> None:
    done = centrode("gears", "shifted-gear-pair", "--out", "pair")
    assert done.code == 0, done
    pictures = {
        f"{name}.{kind}"
        for name in ("mesh", "generation", "sliding", "contact-ratio", "blocking-contour")
        for kind in ("png", "svg")
    }
    outlines = {f"{name}.{kind}" for name in ("pinion", "wheel") for kind in ("svg", "dxf")}
    tables = {"wheels.csv", "line-of-action.csv", "blocking-contour.csv", "summary.json"}
    assert {path.name for path in (folder / "pair").iterdir()} == pictures | outlines | tables
    assert "contact ratio                 1.2021" in done.out
    with (folder / "pair" / "wheels.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["quantity"]: row for row in csv.DictReader(file)}
    assert float(rows["tip diameter"]["pinion"]) == pytest.approx(44.8397e-3, abs=5e-8)
    assert rows["tip diameter"]["unit"] == "m"
    summary = json.loads((folder / "pair" / "summary.json").read_text(encoding="utf-8"))
    assert summary["centre_distance"]["value"] == pytest.approx(
        ct.gear_pair("shifted-gear-pair").geometry.centre_distance
    )


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
@pytest.mark.parametrize("name", ct.example_names("gear pair"))
def test_every_pair_is_said_in_every_language(centrode: Centrode, name: str, language: str) -> None:
    done = centrode("--lang", language, "gears", name)
    assert done.code == 0, done
    assert "nan" not in done.out
    if language != "en":
        assert "pinion" not in done.out


@pytest.mark.parametrize("command", ["run", "trains", "cam", "describe"])
def test_other_commands_say_which_one_computes_a_pair(centrode: Centrode, command: str) -> None:
    done = centrode(command, "shifted-gear-pair")
    assert done.code == 2
    assert "centrode gears" in done.err


def test_a_pair_as_a_document(centrode: Centrode, folder: Path) -> None:
    done = centrode("report", "rack-gear-pair", "--out", "pair.html", "--chapters", "gear-contact")
    assert done.code == 0, done
    assert "Contact and sliding" in (folder / "pair.html").read_text(encoding="utf-8")
    assert "instants are those of mechanisms" in centrode("report", "rack-gear-pair", "--at", "1 rad").err


RECOMMENDED = """kind = "gear pair"
module = "5 mm"
teeth = [14, 50]
shifts = "standard"
"""


@pytest.mark.parametrize(
    ("rest", "shifts", "row"),
    [
        ("", "0.5; 0.5", "centre distance not given; pinion of 10 to 30 teeth"),
        (
            'centre_distance = "160 mm"',
            "0.3; -0.3",
            "centre distance without shifts; pinion of 14 to 20 teeth; ratio of 3.5 or more",
        ),
        ('centre_distance = "161 mm"', "; 0, ", "sum of the shifts above 0, at most 0.5"),
        ("teeth = [31, 50]", "0; 0", "centre distance not given; pinion of 31 teeth or more"),
    ],
)
def test_recommended_shifts_come_with_their_row(
    centrode: Centrode, folder: Path, rest: str, shifts: str, row: str
) -> None:
    kept = RECOMMENDED.replace("teeth = [14, 50]\n", "") if rest.startswith("teeth") else RECOMMENDED
    (folder / "pair.toml").write_text(kept + rest + "\n", encoding="utf-8")
    done = centrode("gears", "pair.toml")
    assert done.code == 0, done
    lines = {line[:28].strip(): line[28:].strip() for line in done.out.splitlines()}
    assert shifts in lines["shift coefficients"]
    assert "recommended by GOST 16532" in lines["shift coefficients"]
    assert row in " ".join(done.out.split())


def test_a_sum_without_recommended_shifts_is_refused(centrode: Centrode, folder: Path) -> None:
    (folder / "pair.toml").write_text(RECOMMENDED + 'centre_distance = "165 mm"\n', encoding="utf-8")
    done = centrode("gears", "pair.toml")
    assert done.code == 2
    assert "pair.toml, centre_distance: GOST 16532 recommends shifts for sums from 0 to 1" in done.err


@pytest.mark.parametrize(
    ("language", "row"),
    [
        ("en", "kinematic transmission; centre distance not given; pinion of 12 to 16 teeth; "
               "wheel of 22 teeth or more"),
        ("ru", "кинематическая передача; межосевое расстояние не задано; число зубьев шестерни от 12 до 16; "
               "число зубьев колеса не менее 22"),
        ("uk", "кінематична передача; міжосьову відстань не задано; кількість зубців шестірні від 12 до 16; "
               "кількість зубців колеса не менша за 22"),
    ],
)  # fmt: skip
def test_command_and_document_name_the_row_in_each_language(
    centrode: Centrode, folder: Path, language: str, row: str
) -> None:
    text = RECOMMENDED + 'application = "kinematic"\n'
    (folder / "pair.toml").write_text(text, encoding="utf-8")
    assert row in " ".join(centrode("--lang", language, "gears", "pair.toml").out.split())
    done = centrode("--lang", language, "report", "pair.toml", "--out", "pair.html", "--chapters", "data")
    assert done.code == 0, done
    assert row in " ".join((folder / "pair.html").read_text(encoding="utf-8").split())


def test_an_animation_needs_a_folder(centrode: Centrode) -> None:
    done = centrode("gears", "rack-gear-pair", "--animate")
    assert done.code == 2
    assert "no output folder is given" in done.err


def test_a_linkage_is_no_pair(centrode: Centrode) -> None:
    done = centrode("gears", "crank-rocker")
    assert done.code == 2
    assert "this describes a linkage, not a pair of gears" in done.err


def test_the_schema_of_pairs(centrode: Centrode) -> None:
    schema = json.loads(centrode("schema", "--gears").out)
    assert schema["properties"]["kind"]["const"] == "gear pair"
    assert centrode("schema", "--gears", "--cam").code == 2


def test_a_pair_on_its_sheet(centrode: Centrode, folder: Path) -> None:
    done = centrode("sheets", "shifted-gear-pair", "--format", "dxf", "--out", "sheet")
    assert done.code == 0, done
    assert (folder / "sheet" / "sheet-1.dxf").stat().st_size > 10_000
    assert centrode("sheets", "shifted-gear-pair", "--at", "1", "--out", "more").code == 2
