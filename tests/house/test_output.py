"""What commands write appears whole or not at all."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from centrode.cli.output import output_folder, write_file
from centrode.errors import InputError
from centrode.render.plain_table import aligned_text


def test_table_aligns_columns() -> None:
    text = aligned_text([["OA", "0.5"], ["шатун", "12.25"]], header=["link", "length, m"], right=[1])
    assert text == "link   length, m\nOA           0.5\nшатун      12.25"


def test_table_without_rows() -> None:
    assert aligned_text([]) == ""
    assert aligned_text([], header=["a", "b"]) == "a  b"


def test_a_table_is_no_wider_than_the_terminal() -> None:
    """Cells and heads take several lines; a number keeps its unit, an equation its sides."""
    rows = [["P10", "OA relative to the frame", "at OA = 0.5 rad"], ["P20", "none", "-"]]
    assert aligned_text(rows, header=["centre", "pair of bodies", "place"], width=36).splitlines() == [
        "        pair of",
        "centre  bodies         place",
        "P10     OA relative    at",
        "        to the frame   OA = 0.5 rad",
        "P20     none           -",
    ]
    assert aligned_text(rows, width=100) == aligned_text(rows)
    assert aligned_text(rows, width=1).count("OA = 0.5 rad") == 1  # what cannot be narrower stays


def test_folder_gets_its_files_at_the_end(tmp_path: Path) -> None:
    out = tmp_path / "new" / "result"
    with output_folder(out) as draft:
        (draft / "motion.csv").write_text("1\n")
        (draft / "figures").mkdir()
        (draft / "figures" / "paths.svg").write_text("<svg/>")
        assert not out.exists()
    assert (out / "motion.csv").read_text() == "1\n"
    assert (out / "figures" / "paths.svg").read_text() == "<svg/>"
    assert [path.name for path in tmp_path.iterdir()] == ["new"]
    assert stat.S_IMODE(out.stat().st_mode) == stat.S_IMODE((tmp_path / "new").stat().st_mode)


def test_folder_replaces_files_of_the_same_name_only(tmp_path: Path) -> None:
    (tmp_path / "motion.csv").write_text("old")
    (tmp_path / "notes.txt").write_text("mine")
    with output_folder(tmp_path) as draft:
        (draft / "motion.csv").write_text("new")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {
        "motion.csv": "new",
        "notes.txt": "mine",
    }


@pytest.mark.parametrize("failure", [ValueError, KeyboardInterrupt])
def test_nothing_is_half_written(tmp_path: Path, failure: type[BaseException]) -> None:
    (tmp_path / "motion.csv").write_text("old")
    for out in (tmp_path, tmp_path / "result" / "deep"):
        with pytest.raises(failure), output_folder(out) as draft:
            (draft / "motion.csv").write_text("new")
            raise failure
    assert [path.name for path in tmp_path.iterdir()] == ["motion.csv"]
    assert (tmp_path / "motion.csv").read_text() == "old"


def refused(out: Path) -> str:
    with pytest.raises(InputError) as told, output_folder(out):
        pytest.fail("the block must not be entered")
    assert told.value.exit_code == 2
    return str(told.value)


def test_a_file_in_the_way_is_refused_at_once(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    assert f"{tmp_path / 'taken'} is not a folder" in refused(tmp_path / "taken")
    assert f"{tmp_path / 'taken'} is not a folder" in refused(tmp_path / "taken" / "below" / "it")


def test_a_broken_link_and_a_long_name_are_refused(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "nowhere")
    assert "is not a folder" in refused(tmp_path / "link")
    assert "cannot be written" in refused(tmp_path / ("x" * 300))


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a file system that nobody can write")
def test_an_unwritable_place_is_refused() -> None:
    assert "cannot be written" in refused(Path("/proc/centrode"))


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    try:
        assert "cannot be written" in refused(tmp_path / "result")
    finally:
        tmp_path.chmod(0o700)


def test_a_folder_where_a_file_has_to_go_leaves_everything_alone(tmp_path: Path) -> None:
    (tmp_path / "summary.json").mkdir()
    with (
        pytest.raises(InputError, match="is a folder, but a file is to be written there"),
        output_folder(tmp_path) as draft,
    ):
        (draft / "motion.csv").write_text("new")
        (draft / "summary.json").write_text("{}")
    assert [path.name for path in tmp_path.iterdir()] == ["summary.json"]


def test_file_is_written_whole_and_with_the_usual_permissions(tmp_path: Path) -> None:
    path, usual = tmp_path / "new" / "mine.toml", tmp_path / "usual"
    write_file(path, 'title = "Кривошип"\n')
    usual.write_text("")
    assert path.read_bytes() == 'title = "Кривошип"\n'.encode()
    assert path.stat().st_mode == usual.stat().st_mode
    assert len(list(tmp_path.iterdir())) == 2


def test_file_is_not_replaced_unless_forced(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("mine")
    with pytest.raises(InputError, match="exists already; add --force to replace it"):
        write_file(path, "new")
    assert path.read_text() == "mine"
    write_file(path, "new", force=True)
    assert path.read_text() == "new"


def test_file_refusals(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(InputError, match="is a folder; name a file"):
        write_file(tmp_path, "", force=True)
    with pytest.raises(InputError, match="is not a folder"):
        write_file(tmp_path / "taken" / "x.toml", "")
    with pytest.raises(InputError, match="cannot be written"):
        write_file(tmp_path / ("x" * 300), "")
