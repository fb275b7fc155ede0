"""The thirty variants: limits against the inequalities of the triangle, folders, resuming, failing rows."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import centrode as ct
from blank_canvas import blank_pictures
from centrode.assignments import results as variant_results
from centrode.assignments.results import VariantRow, compute_variant, spoken_variants
from centrode.assignments.tables import read_variants
from centrode.errors import InputError
from centrode.files.drafts import remove_file
from centrode.files.locks import hold_lock
from centrode.locale import speaking
from centrode.report.variants import folders
from computed_once import computed_once

WORKED = ct.example("slider-between-cranks")
TABLE = Path(__file__).parents[1] / "reference" / "planar-variants.csv"
L1 = 0.5


@pytest.fixture(autouse=True)
def shared() -> Iterator[None]:
    """The same few variants stand in most tables: each is computed once."""
    with computed_once():
        yield


def margin(row: dict[str, float], t: Any) -> Any:
    """What is left of the two triangles of the worked topology at a crank angle: negative where one does not close."""
    l2, l3, l4 = (row[f"l{k}_m"] for k in (2, 3, 4))
    two, three, four = (row[f"phi{k}_0_rad"] for k in (2, 3, 4))
    height = l2 * np.sin(two) - L1 * np.sin(t)
    slider = l2**2 - height**2
    side = np.sign(np.cos(two))
    c = L1 * np.cos(t) + side * np.sqrt(np.maximum(slider, 0)) + 1j * l2 * np.sin(two)
    d = L1 + l2 * np.exp(1j * two) + l3 * np.exp(1j * three) + l4 * np.exp(1j * four)
    apart = np.abs(c - d)
    return np.minimum.reduce([slider, l3 + l4 - apart, apart - abs(l3 - l4)])


def first_limit(row: dict[str, float]) -> float | None:
    """The first crank angle at which a triangle is flat, by halving what a fine scan brackets."""
    t = np.linspace(0.0, 2 * np.pi, 20_001)
    negative = np.flatnonzero(margin(row, t) < 0)
    if not negative.size:
        return None
    low, high = t[negative[0] - 1], t[negative[0]]
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if margin(row, middle) >= 0 else (low, middle)
    return float(low)


def test_all_thirty_on_the_worked_topology(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows tell what structure and motion say; the integrated motion beside them is left out."""

    def refuse(*_anything: object, **_options: object) -> None:
        raise InputError("", "left out")

    monkeypatch.setattr(variant_results, "integrate_both", refuse)
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    expected = [first_limit(row) for row in rows]
    assert sum(limit is None for limit in expected) == 7
    for row, limit, variant in zip(rows, expected, read_variants(WORKED, TABLE), strict=True):
        found = compute_variant(WORKED, variant).row
        assert found.turns_fully == (limit is None), row
        if limit is None:
            assert (found.limit, found.status) == (None, "ok")
            continue
        # where a triangle is flat its height is of the order of the root of a rounding
        assert found.limit == pytest.approx(limit, abs=1e-7)
        assert found.unit == "rad"
        assert found.status == "locks"
        assert found.group in ("group AC (point C)", "group CB-BD (point B)")


def test_results_of_a_variant() -> None:
    results = ct.variants(WORKED, [{"variant": "seven", "l3": 1.2}]).results
    assert len(results) == 1
    assert results[0].row == VariantRow("seven", True, None, "", "", "", "ok")
    assert results[0].mechanism == WORKED
    assert results[0].integration is not None and results[0].integration.attrs["steps"] == 100
    assert results[0].study is not None and results[0].study.unreached_samples == 0


def test_one_wrong_variant_does_not_stop_the_others() -> None:
    table = [{"variant": "a", "l2": 1.0}, {"variant": "b", "l2": -1.0}, {"variant": "c", "l2": 1.1}]
    seen: list[tuple[int, int]] = []
    found = ct.variants(WORKED, table, progress=lambda done, of: seen.append((done, of))).results
    assert [results.row.status for results in found] == ["ok", "refused", "ok"]
    assert "length must be positive" in found[1].row.cause
    assert found[1].study is None
    assert seen == [(1, 3), (2, 3), (3, 3)]


def test_what_cannot_be_integrated_is_noted() -> None:
    sphere = ct.example("spherical-four-bar")
    found = ct.variants(sphere, [{"variant": "a", "links.BC.length": "44 deg"}]).results[0]
    assert found.row.status == "ok" and found.row.turns_fully is True
    assert found.integration is None
    assert "not on the sphere" in found.note


# folders

TWO: list[dict[str, object]] = [{"variant": "a", "l2": 1.0}, {"variant": "b", "l2": 1.05}]
FILES = ["integration.csv", "mechanism.toml", "motion.csv", "summary.json", "variant.json"]


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in sorted(folder.rglob("*"))
        if file.is_file()
    }


def stamps(folder: Path) -> dict[str, int]:
    return {str(file.relative_to(folder)): file.stat().st_mtime_ns for file in folder.rglob("variant.json")}


def test_a_folder_for_each(tmp_path: Path) -> None:
    rows = ct.write_variants(WORKED, TWO, tmp_path / "out").rows
    assert [row.variant for row in rows] == ["a", "b"]
    for name in ("variant-a", "variant-b"):
        assert sorted(file.name for file in (tmp_path / "out" / name).iterdir()) == FILES
    one = ct.read_mechanism(tmp_path / "out" / "variant-b" / "mechanism.toml")
    assert ct.value_at(one, "links.AC.length") == 1.05
    summary = json.loads((tmp_path / "out" / "variant-b" / "summary.json").read_text(encoding="utf-8"))
    assert summary["samples_ok"] == {"value": 101, "unit": "1"}
    with (tmp_path / "out" / "summary.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.reader(file))
    assert table[0] == ["variant", "turns_fully", "limit [rad]", "group", "cause", "status"]
    assert table[1:] == [["a", "yes", "", "", "", "ok"], ["b", "yes", "", "", "", "ok"]]


def test_limits_stand_in_the_summary(tmp_path: Path) -> None:
    ct.write_variants(WORKED, [{"variant": "6'", "phi3_0": 4.7, "phi4_0": 5.7}], tmp_path)
    with (tmp_path / "summary.csv").open(encoding="utf-8", newline="") as file:
        row = next(csv.DictReader(file))
    assert (row["variant"], row["turns_fully"], row["status"]) == ("6'", "no", "locks")
    assert float(row["limit [rad]"]) == pytest.approx(1.79991241652444, abs=1e-12)
    assert "CB and BD are collinear" in row["cause"] and "sin(phi3 - phi4) = 0" in row["cause"]


def test_finished_variants_are_not_computed_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = ct.write_variants(WORKED, TWO, tmp_path)
    before, all_before = stamps(tmp_path), contents(tmp_path)

    def refuse(*_anything: object) -> None:
        raise AssertionError("computed again")

    monkeypatch.setattr(folders, "compute_variant", refuse)
    assert ct.write_variants(WORKED, TWO, tmp_path) == rows
    assert (stamps(tmp_path), contents(tmp_path)) == (before, all_before)


def test_changed_and_damaged_variants_are_computed_again(tmp_path: Path) -> None:
    ct.write_variants(WORKED, TWO, tmp_path)
    before = stamps(tmp_path)
    changed = [TWO[0], {"variant": "b", "l2": -1.0}]
    rows = ct.write_variants(WORKED, changed, tmp_path).rows
    assert [row.status for row in rows] == ["ok", "refused"]
    # nothing of the variant as it was is left beside the marker of what it is
    assert [file.name for file in (tmp_path / "variant-b").iterdir()] == ["variant.json"]
    assert stamps(tmp_path)["variant-a/variant.json"] == before["variant-a/variant.json"]
    (tmp_path / "variant-a" / "variant.json").write_text('{"digest": "', encoding="utf-8")
    (tmp_path / "variant-a" / "own notes.txt").write_text("kept", encoding="utf-8")
    assert ct.write_variants(WORKED, TWO, tmp_path).rows[0].status == "ok"
    assert (tmp_path / "variant-a" / "own notes.txt").read_text(encoding="utf-8") == "kept"


def test_an_interruption_loses_nothing(tmp_path: Path) -> None:
    three = [*TWO, {"variant": "c", "l2": 1.1}]

    def stop(done: int, _of: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ct.write_variants(WORKED, three, tmp_path, progress=stop)
    before = stamps(tmp_path)
    assert set(before) == {"variant-a/variant.json", "variant-b/variant.json"}
    assert not (tmp_path / "summary.csv").exists()
    seen: list[int] = []
    ct.write_variants(WORKED, three, tmp_path, progress=lambda done, _of: seen.append(done))
    assert seen == [2, 3]
    after = stamps(tmp_path)
    assert {name: after[name] for name in before} == before
    whole = tmp_path.parent / "whole"
    ct.write_variants(WORKED, three, whole)
    assert contents(tmp_path) == contents(whole)


def test_a_fault_is_told_and_tried_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as broken:

        def fail(*_anything: object) -> None:
            raise ArithmeticError("a slip of ours")

        broken.setattr(folders, "compute_variant", fail)
        rows = ct.write_variants(WORKED, TWO, tmp_path).rows
    assert [row.status for row in rows] == ["fault", "fault"]
    assert rows[0].cause == "ArithmeticError: a slip of ours"
    assert [row.status for row in ct.write_variants(WORKED, TWO, tmp_path).rows] == ["ok", "ok"]


def test_figures_of_each(tmp_path: Path) -> None:
    with blank_pictures():  # which files there are; tests/render renders them
        ct.write_variants(WORKED, TWO[:1], tmp_path, figures=True)
    names = {file.name for file in (tmp_path / "variant-a").iterdir()}
    assert {"mechanism.png", "angles.svg", "integrated-angles.png", "integration-errors.svg"} <= names


@pytest.mark.parametrize("jobs", [0, -1, 1.5, True, 10**6])
def test_jobs_that_are_refused(jobs: Any, tmp_path: Path) -> None:
    with pytest.raises(ct.InputError, match="give 1 to 256"):
        ct.write_variants(WORKED, TWO, tmp_path / "out", jobs=jobs)
    assert not (tmp_path / "out").exists()


def test_places_that_are_refused(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(ct.InputError, match="cannot be written"):
        ct.write_variants(WORKED, TWO, tmp_path / "file")
    (tmp_path / "busy").mkdir()
    with pytest.raises(ct.InputError, match="another run is writing"):
        ct.write_variants(
            WORKED, TWO, tmp_path / "busy", progress=lambda _done, _of: nested(tmp_path / "busy")
        )


def test_the_lock_is_there_while_it_is_held_and_gone_afterwards(tmp_path: Path) -> None:
    seen: list[bool] = []
    ct.write_variants(
        WORKED, TWO, tmp_path, progress=lambda _done, _of: seen.append((tmp_path / ".lock").is_file())
    )
    assert seen and all(seen)
    assert not (tmp_path / ".lock").exists()
    (tmp_path / ".lock").touch()  # of a run that was killed
    ct.write_variants(WORKED, TWO, tmp_path)
    assert not (tmp_path / ".lock").exists()
    # a refusal takes nothing from the run that holds the lock
    with hold_lock(tmp_path / ".lock", "", remove=remove_file):
        with pytest.raises(ct.InputError, match="another run is writing"):
            nested(tmp_path)
        assert (tmp_path / ".lock").is_file()
    assert not (tmp_path / ".lock").exists()


def nested(folder: Path) -> None:
    ct.write_variants(WORKED, TWO, folder)


@pytest.mark.parametrize("language", ["ru", "uk"])
def test_causes_in_the_language_of_the_reader(language: str) -> None:
    table = [{"variant": "a", "l2": 1.0}, {"variant": "b", "l2": -1.0}, {"variant": "c", "l2": "300 mm"}]
    found = ct.variants(WORKED, table)
    rows = found.rows
    assert [row.status for row in rows] == ["ok", "refused", "locks"]
    assert spoken_variants(found) == found
    with speaking(language):
        free, refused, locks = spoken_variants(found).rows
        limits = ct.rotatability(with_l2(0.3)).limits
        with pytest.raises(InputError) as refusal:
            with_l2(-1.0)
    assert free == rows[0]
    assert refused.cause.partition(": ")[2] == str(refusal.value).partition(": ")[2]
    assert not refused.cause.isascii() and rows[1].cause.isascii()
    assert locks.group in {limit.group for limit in limits} and not locks.group.isascii()
    assert not locks.cause.isascii() and (locks.limit, locks.status) == (rows[2].limit, rows[2].status)


def with_l2(length: float) -> ct.Mechanism:
    return read_variants(WORKED, [{"variant": "x", "l2": length}])[0].of(WORKED)
