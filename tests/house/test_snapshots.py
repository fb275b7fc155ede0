"""The record of what the program gives: a sample of it holds, and whatever changes is seen."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from tools.snapshots.__main__ import main
from tools.snapshots.artefacts import Artefact, Digest
from tools.snapshots.cases import RECORDED
from tools.snapshots.comparison import BITS, DIFFERS, NUMBERS, Verdict, compare, digests_of
from tools.snapshots.files import table_artefact, text_artefact
from tools.snapshots.record import FOLDER, read_record, write_record

from centrode.locale import choose_language_of_process

Change = Callable[[dict[str, Artefact]], None]
CURVE = np.sin(np.linspace(0.0, 6.0, 101)) * 1e3


@pytest.fixture(autouse=True)
def spoken_before(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The commands of the record speak three languages in this process: the tests after them speak English again."""
    monkeypatch.setenv("LANGUAGE", "en")
    yield
    choose_language_of_process("en")


def given() -> dict[str, Artefact]:
    """A text, a table and a figure."""
    figure = Artefact()
    figure.say("axes 1 title Angle of DB, 12.5 deg at the start")
    figure.add("y", CURVE)
    rows = "\n".join(f"{t:.17g},{y:.17g},ok" for t, y in enumerate(CURVE))
    return {
        "said": text_artefact("length 1200 mm, clearance 0.0312 mm, 2 loops"),
        "motion.csv": table_artefact(f"t [s],y [m],status\n{rows}\n"),
        "angles.png": figure,
    }


def verdicts(change: Change | None = None) -> dict[str, Verdict]:
    recorded, _labels = digests_of(given())
    after = given()
    if change is not None:
        change(after)
    return {verdict.name: verdict for verdict in compare(recorded, *digests_of(after))}


def replaced(name: str, old: str, new: str) -> Change:
    def change(artefacts: dict[str, Artefact]) -> None:
        parts = artefacts[name].parts
        assert any(isinstance(part, str) and old in part for part in parts)
        artefacts[name].parts = [part.replace(old, new) if isinstance(part, str) else part for part in parts]

    return change


def moved(name: str, amount: float) -> Change:
    """One number of a series moved by a part of the scale."""

    def change(artefacts: dict[str, Artefact]) -> None:
        values = next(
            part[1] for part in artefacts[name].parts if not isinstance(part, str) and part[0][0] == "y"
        )
        values[40] += amount * 1e3

    return change


def test_nothing_changed() -> None:
    assert {verdict.kind for verdict in verdicts().values()} == {BITS}


@pytest.mark.parametrize(
    ("change", "name", "what"),
    [
        (replaced("said", "length", "lenght"), "said", "words differ"),
        (replaced("said", "1200 mm", "1200 m"), "said", "words differ"),
        (replaced("said", "1200", "1201"), "said", "single numbers: numbers differ"),
        (replaced("said", "0.0312", "0.0313"), "said", "single numbers: numbers differ"),
        (replaced("said", "2 loops", "3 loops"), "said", "single numbers: numbers differ"),
        (replaced("motion.csv", "status", "state"), "motion.csv", "words differ"),
        (replaced("motion.csv", "| ok", "| open"), "motion.csv", "words differ"),
        (moved("motion.csv", 1e-11), "motion.csv", "y [m]: numbers differ"),
        (moved("angles.png", 1e-11), "angles.png", "y: numbers differ"),
        (moved("angles.png", np.nan), "angles.png", "y: 101 numbers (0 absent) became 101 (1 absent)"),
        (replaced("angles.png", "12.5", "12.6"), "angles.png", "single numbers: numbers differ"),
        (lambda artefacts: artefacts.pop("angles.png"), "angles.png", "it was recorded and is missing"),
        (lambda artefacts: artefacts.update(new=text_artefact("")), "new", "it is new"),
    ],
)  # fmt: skip
def test_a_change_is_seen(change: Change, name: str, what: str) -> None:
    found = verdicts(change)
    assert found[name].kind == DIFFERS
    assert any(sentence.startswith(what) for sentence in found[name].what), found[name]
    assert {verdict.kind for other, verdict in found.items() if other != name} == {BITS}


def test_rounding_errors_are_told_from_changes() -> None:
    # one last bit of numbers up to 1000: 2^-53 of the scale
    assert verdicts(moved("motion.csv", 2.0**-52))["motion.csv"].kind == NUMBERS


def test_a_record_is_read_as_it_was_written(tmp_path: Path) -> None:
    digests, _labels = digests_of({**given(), "angles.svg": given()["angles.png"]})
    write_record(tmp_path, "sample", digests)
    read = read_record(tmp_path, "sample")
    assert list(read) == list(digests)
    assert "= angles.png" in (tmp_path / "sample.txt").read_text(encoding="utf-8")
    for name, digest in read.items():
        assert (digest.bits, digest.words) == (digests[name].bits, digests[name].words)
        assert len(digest.sketches) == len(digests[name].sketches)
        for one, other in zip(digest.sketches, digests[name].sketches, strict=True):
            assert one.distance(other) < 1e-13


SAMPLE = (
    "check",
    "--only",
    "crank-rocker",
    "spherical-crank-rocker",
    "face",
    "--commands",
    "check",
    "angles",
    "dir(centrode)",
)


def test_the_record_holds_what_it_is_compared_with() -> None:
    assert sorted(file.stem for file in FOLDER.iterdir()) == sorted(RECORDED)


def test_a_sample_of_the_record_holds() -> None:
    assert main(SAMPLE) == 0


def test_a_change_of_the_record_ends_in_a_difference(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recorded = read_record(FOLDER, "crank-rocker")
    changed: dict[str, Digest] = {
        name: dataclasses.replace(digest, bits="0", words="0") if name == "check/ru/said" else digest
        for name, digest in recorded.items()
    }
    write_record(tmp_path, "crank-rocker", changed)
    words = ("check", "--only", "crank-rocker", "--commands", "check", "--record", str(tmp_path))
    assert main(words) == 1
    assert "crank-rocker/differs         check/ru/said: words differ\n" in capsys.readouterr().out
