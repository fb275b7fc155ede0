"""`centrode chains`."""

from __future__ import annotations

from pathlib import Path

import pytest

import centrode as ct
from centrode.chains import planar_drawings
from centrode.chains.kinematic_chains import chain_list
from centrode.cli.main import main
from centrode.views.chains import chains_sheet


def test_the_list_of_six_links(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chains", "6"]) == 0
    printed = capsys.readouterr().out
    assert "1. Watt chain" in printed
    assert "2. Stephenson chain" in printed
    assert printed.splitlines()[5].split() == ["inversions", "5"]


def test_what_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chains", "6", "--out", str(tmp_path / "six")]) == 0
    start = sorted(path.name for path in (tmp_path / "six" / "start").iterdir())
    assert start == [
        "chain-1-inversion-1.toml",
        "chain-1-inversion-2.toml",
        "chain-2-inversion-1.toml",
        "chain-2-inversion-2.toml",
        "chain-2-inversion-3.toml",
    ]
    assert (tmp_path / "six" / "atlas.svg").exists()
    assert (tmp_path / "six" / "chains.csv").read_text("utf-8").count("\n") == 3
    assert "start/: 5 descriptions" in capsys.readouterr().out
    (inversion,) = ct.chain_of(tmp_path / "six" / "start" / start[-1]).inversions
    assert (inversion.family, inversion.number) == ("Stephenson", 3)


def test_one_chain_alone(tmp_path: Path) -> None:
    assert main(["chains", "8", "--chain", "9", "--no-figures", "--out", str(tmp_path / "nine")]) == 0
    names = sorted(
        path.relative_to(tmp_path / "nine").as_posix() for path in (tmp_path / "nine").rglob("*.*")
    )
    assert names == ["chains.csv", "start/chain-9-inversion-1.toml", "start/chain-9-inversion-2.toml"]


def test_groups(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chains", "4", "--groups"]) == 0
    rows = [line.split()[:3] for line in capsys.readouterr().out.splitlines()[-2:]]
    assert rows == [["1", "IV", "2"], ["2", "III", "3"]]


def test_a_long_list_is_not_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chains", "10"]) == 0
    printed = capsys.readouterr().out
    assert "1834" in printed
    assert len(printed.splitlines()) < 12


def test_pages_of_an_atlas_stand_in_order() -> None:
    pictures = list(chains_sheet(chain_list(10)).pictures)
    assert len(pictures) == 12
    assert pictures == sorted(pictures)


def test_sketches_need_networkx(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(planar_drawings, "find_spec", lambda _name: None)
    assert main(["chains", "6", "--out", str(tmp_path / "six")]) == 2
    said = capsys.readouterr().err
    assert "networkx" in said
    assert "figures" in said
    assert not list(tmp_path.iterdir())
    # the list, and tables of groups, have no sketches
    assert main(["chains", "6"]) == 0
    assert main(["chains", "4", "--groups", "--no-figures", "--out", str(tmp_path / "four")]) == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["7"], "with this mobility chains have 4, 6, 8, 10, 12 links"),
        (["40"], "chains of 3 to 12 links"),
        (["six"], "six"),
        (["6", "--chain", "3"], "1 to 2"),
        (["4", "--groups", "--chain", "1"], "--chain"),
        (["5", "--groups"], "no Assur group of 5 links"),
        (["6", "--mobility", "-2"], "0"),
    ],
)
def test_what_is_refused(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chains", *arguments]) == 2
    assert said in capsys.readouterr().err
