"""`check`, `examples` and `schema` as a user meets them."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import pytest

import centrode as ct
from centrode.cli import output
from centrode.cli.main import COMMANDS
from centrode.model.schema import mechanism_schema
from centrode.render.plain_table import width_of

Centrode = Callable[..., Any]


def test_check_prints_structure_and_plan(centrode: Centrode, folder: Path) -> None:
    done = centrode("check", "slider-between-cranks")
    assert (done.code, done.err) == (0, "")
    rows = done.rows
    assert rows["mobility"] == "1 by rank; by Chebyshev's formula 3·5 - 2·7 - 0 = 1"
    assert rows["drives"] == "OA"
    assert rows["redundant constraints"] == "none"
    assert rows["independent loops"] == "2"
    assert rows["structural formula"] == "I(OA) -> II(AC, slider C) -> II(CB, BD)"
    assert rows["groups"] == "OA: input, class I"
    assert "AC, slider C: class II, order 2, RRP" in done.out
    assert "4. RRR: point B, where the circle of CB about C meets the circle of BD about D" in done.out
    assert list(folder.iterdir()) == [], "a check writes nothing"


def test_check_names_redundant_constraints(centrode: Centrode) -> None:
    rows = centrode("check", "three-crank-parallelogram").rows
    assert rows["mobility"] == "1 by rank; by Chebyshev's formula 3·4 - 2·6 - 0 = 0"
    assert rows["redundant constraints"] == "point E in link FE"


@pytest.mark.parametrize("name", ct.example_names())
def test_every_example_is_checked(centrode: Centrode, name: str) -> None:
    done = centrode("check", name)
    assert (done.code, done.err) == (0, "")


def test_check_refuses_as_run_does(centrode: Centrode, folder: Path, four_bar: str) -> None:
    for old, new in (("length = 1\n", "length = -1\n"), ("length = 3.5", "length = 0.5")):
        (folder / "press.toml").write_text(four_bar.replace(old, new))
        done = centrode("check", "press.toml")
        assert (done.code, done.out) == (2, "")
        assert done.err == centrode("run", "press.toml").err


def test_examples_are_listed(centrode: Centrode) -> None:
    done = centrode("examples")
    assert done.code == 0
    assert set(done.rows) >= set(ct.example_names())
    assert done.rows["kite"] == "Kite linkage"
    assert all(done.rows[name] for name in ct.example_names())


def test_an_example_is_printed_written_and_run(centrode: Centrode, folder: Path) -> None:
    printed = centrode("examples", "kite").out
    assert tomllib.loads(printed)["title"] == "Kite linkage"
    assert centrode("examples", "kite", "--out", "mine.toml").code == 0
    assert (folder / "mine.toml").read_text(encoding="utf-8") == printed
    assert centrode("run", "mine.toml", "--no-figures").code == 0
    assert (folder / "mine-result" / "summary.json").exists()


def test_an_example_does_not_replace_a_file(centrode: Centrode, folder: Path) -> None:
    (folder / "kite.toml").write_text("mine")
    done = centrode("examples", "kite", "--out", "kite.toml")
    assert done.code == 2
    assert done.err == "Error: kite.toml: exists already; add --force to replace it\n"
    assert (folder / "kite.toml").read_text() == "mine"
    assert centrode("examples", "kite", "--out", "kite.toml", "--force").code == 0


def test_an_unknown_example(centrode: Centrode) -> None:
    done = centrode("examples", "kyte")
    assert (done.code, done.out) == (2, "")
    assert done.err == 'Error: there is no built-in mechanism called "kyte"; did you mean "kite"?\n'


def test_the_schema_is_json(centrode: Centrode) -> None:
    done = centrode("schema")
    assert done.code == 0
    assert json.loads(done.out) == mechanism_schema()


@pytest.mark.parametrize(
    "arguments",
    [
        ["centres", "six-bar-press"],
        ["rotatability", "six-bar-press"],
        ["angles", "jansen-leg", "--no-figures"],
        ["check", "slider-between-cranks"],
    ],
)
def test_a_terminal_gets_lines_that_it_holds(
    centrode: Centrode, monkeypatch: pytest.MonkeyPatch, arguments: list[str]
) -> None:
    """The same words as in a file, in lines of eighty columns."""
    into_file = centrode(*arguments)
    monkeypatch.setattr(output, "terminal_width", lambda: 80)
    printed = centrode(*arguments)
    assert max(map(width_of, into_file.out.splitlines())) > 80
    assert max(map(width_of, printed.out.splitlines())) <= 80
    assert sorted(printed.out.split()) == sorted(into_file.out.split())


def test_the_help_of_every_command_explains_what_is_given(centrode: Centrode) -> None:
    """Whatever stands in capitals in a line of usage has a line of its own below it."""
    for command in COMMANDS:
        given = [one for one in command.params if isinstance(one, click.Argument)]
        assert all(getattr(one, "help", None) for one in given), command.name
        assert not given or "Positional arguments:" in centrode(str(command.name), "--help").out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run"], "Missing argument 'FILE_OR_EXAMPLE'"),
        (["check"], "Missing argument 'FILE_OR_EXAMPLE'"),
        (
            ["run", "kite", "--samples", "many"],
            "Invalid value for '--samples': 'many' is not a valid integer",
        ),
        (["run", "kite", "--sample", "3"], "No such option '--sample'"),
        (["run", "kite", "other"], "Got unexpected extra argument (other)"),
        (["runn"], "No such command 'runn'"),
    ],
)
def test_usage(centrode: Centrode, folder: Path, arguments: list[str], message: str) -> None:
    done = centrode(*arguments)
    assert (done.code, done.out) == (2, "")
    assert message in done.err
    assert list(folder.iterdir()) == []
