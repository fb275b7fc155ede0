"""Files and folders that are not what they should be: named in the message, left as they were."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import centrode as ct
from centrode.model.examples.catalogue import load, load_either

Refused = Callable[..., str]


@pytest.mark.parametrize(
    ("mechanism", "message"),
    [
        ("nowhere.toml", "nowhere.toml: there is no such file; check the path"),
        ("no/where.toml", "where.toml: there is no such file; check the path"),
        ("nowhere", "nowhere: no such file, and no built-in mechanism of this name; give a TOML file, or a"),
        ("kyte", 'kyte: no such file, and no built-in mechanism of this name; did you mean "kite"?'),
        ("Kite", 'Kite: no such file, and no built-in mechanism of this name; did you mean "kite"?'),
        (".", "this is not a file; give the path of a file"),
        ("", "this is not a file; give the path of a file"),
        ("a\nb", "a\\nb: no such file, and no built-in mechanism of this name"),
        ("x" * 5000, "the operating system refused: "),
        ("x" * 5000 + ".toml", "the file cannot be read: "),
        ("\0.toml", "the file cannot be read: "),
    ],
)
def test_no_such_mechanism(refused: Refused, mechanism: str, message: str) -> None:
    assert message in refused(None, mechanism=mechanism)


def test_a_name_without_its_ending_and_a_file_in_place_of_a_command(
    centrode: Callable[..., Any], folder: Path, four_bar: str
) -> None:
    (folder / "press.toml").write_text(four_bar)
    without = centrode("check", "press")
    assert (without.code, without.err) == (
        2,
        'Error: press: no such file, and no built-in mechanism of this name; did you mean "press.toml"?\n',
    )
    alone = centrode("press.toml")
    assert alone.code == 2
    assert alone.err.endswith("Error: a command goes before the file: centrode check press.toml\n")
    # longer than a name of a file may be, as a text that was pasted
    pasted = centrode("press" * 1000)
    assert pasted.code == 2
    assert "No such command 'presspress" in pasted.err


def test_a_folder_instead_of_a_file(refused: Refused, folder: Path) -> None:
    (folder / "press.toml").mkdir()
    assert refused(None) == "press.toml: this is not a file; give the path of a file"


def test_a_folder_does_not_hide_the_example_of_its_name(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`centrode run kite --out kite` works a second time as well."""
    monkeypatch.chdir(folder)
    (folder / "kite").mkdir()
    assert load("kite") == load_either("kite") == ct.example("kite")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_is_not_waited_for(refused: Refused, folder: Path) -> None:
    os.mkfifo(folder / "press.toml")
    assert refused(None) == "press.toml: this is not a file; give the path of a file"


def test_a_device_is_not_read(refused: Refused) -> None:
    assert "this is not a file" in refused(None, mechanism="/dev/null")


def test_a_huge_file_is_not_read(refused: Refused, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with (folder / "press.toml").open("wb") as stream:
        stream.truncate(100 * 2**20)
    opens = Path.open

    def unread(path: Path, *how: Any) -> Any:
        assert path.name != "press.toml"
        return opens(path, *how)

    monkeypatch.setattr(Path, "open", unread)
    assert refused(None) == "press.toml: the file has 104857600 bytes, at most 1000000 are allowed"


def test_a_file_in_place_of_the_folder(refused: Refused, folder: Path) -> None:
    (folder / "taken").write_text("mine")
    for out, message in (
        ("taken", "taken is not a folder; name another folder"),
        ("taken/below", "taken/below: taken is not a folder; name another folder"),
    ):
        assert refused(None, "--out", out, mechanism="kite") == message


def test_a_folder_in_place_of_a_result(refused: Refused, folder: Path) -> None:
    (folder / "result" / "motion.nc").mkdir(parents=True)
    (folder / "result" / "motion.csv").write_text("mine")
    told = refused(None, mechanism="kite")
    assert told == "result/motion.nc: is a folder, but a file is to be written there; name another folder"


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a file system that nobody can write")
def test_a_folder_nobody_can_write(refused: Refused) -> None:
    told = refused(None, "--out", "/proc/centrode", mechanism="kite")
    assert told.startswith("/proc/centrode: cannot be written: ")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission(refused: Refused, folder: Path) -> None:
    (folder / "mine").mkdir(mode=0o500)
    assert refused(None, "--out", "mine", mechanism="kite").startswith("mine: cannot be written: ")


def test_a_name_too_long_for_a_folder(refused: Refused) -> None:
    assert "cannot be written: " in refused(None, "--out", "x" * 300, mechanism="kite")


def test_a_description_that_is_refused_leaves_results_alone(refused: Refused, folder: Path) -> None:
    (folder / "result").mkdir()
    (folder / "result" / "motion.csv").write_text("of yesterday")
    refused("[links.OA]\nlength = -1\n")
