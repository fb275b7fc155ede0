"""Runs of campaigns: resumed without loss, refused where they do not fit, with pages that say what was found."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from tools.campaigns import __main__ as command
from tools.campaigns import runner
from tools.campaigns.campaign import Campaign, Outcome, Tally
from tools.campaigns.page import page
from tools.campaigns.registry import CAMPAIGNS
from tools.campaigns.runner import run_campaign

from centrode.errors import InputError

PAGES = Path(__file__).parents[2] / "docs" / "validation"


def squares(seed: int, number: int) -> Outcome:
    """A case with a figure; every seventh fails, every eleventh raises."""
    outcome = Outcome(subject=f"{seed} and {number}")
    outcome.measure("all", "square", number**2 % 97)
    outcome.count("drawn", seed)
    if number % 7 == 3:
        outcome.fault(f"seven {number}")
    if number % 11 == 5:
        raise ValueError(f"eleven {number}")
    return outcome


CAMPAIGN = Campaign(
    "squares", "Squares", "Squares of numbers.", {"square": "what it is"}, squares, 40, block=7
)


def test_a_run_in_pieces_is_the_run_at_once(tmp_path: Path) -> None:
    whole = run_campaign(CAMPAIGN, 2, 40, 60.0, tmp_path / "whole")
    for cases in (5, 7, 23, 40):
        pieces = run_campaign(CAMPAIGN, 2, cases, 60.0, tmp_path / "pieces")
        assert pieces.cases == cases
    assert pieces == whole
    assert whole == Tally.of(CAMPAIGN, 2, range(40))
    assert page(CAMPAIGN, 2, pieces) == page(CAMPAIGN, 2, whole)


def test_a_block_that_was_cut_short_is_computed_again(tmp_path: Path) -> None:
    whole = run_campaign(CAMPAIGN, 1, 40, 60.0, tmp_path)
    file = tmp_path / "squares-1.jsonl"
    content = file.read_bytes()
    for length in (len(content) - 1, len(content) - 40, content.index(b"\n") + 20, content.index(b"\n") + 1):
        file.write_bytes(content[:length])
        assert run_campaign(CAMPAIGN, 1, 40, 60.0, tmp_path) == whole
        assert file.read_bytes() == content


def test_what_was_done_before_an_interruption_stays(tmp_path: Path) -> None:
    def interrupted(seed: int, number: int) -> Outcome:
        if number == 20:
            raise KeyboardInterrupt
        return squares(seed, number)

    with pytest.raises(KeyboardInterrupt):
        run_campaign(replace(CAMPAIGN, run=interrupted), 1, 40, 60.0, tmp_path)
    lines = (tmp_path / "squares-1.jsonl").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + 2  # two whole blocks of seven
    assert run_campaign(CAMPAIGN, 1, 40, 60.0, tmp_path) == Tally.of(CAMPAIGN, 1, range(40))


def test_figures_of_two_states_of_the_program_are_not_added_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run_campaign(CAMPAIGN, 1, 10, 60.0, tmp_path)
    monkeypatch.setattr(runner, "state_of_the_program", lambda: "another")
    with pytest.raises(InputError, match=r"another state of the program.*--anew"):
        run_campaign(CAMPAIGN, 1, 20, 60.0, tmp_path)
    assert run_campaign(CAMPAIGN, 1, 20, 60.0, tmp_path, anew=True).cases == 20


def test_the_page_names_figures_with_their_cases_and_faults() -> None:
    text = page(CAMPAIGN, 3, Tally.of(CAMPAIGN, 3, range(12)))
    greatest = max((number**2 % 97, -number) for number in range(12) if number % 11 != 5)
    assert f"| all | 11 | {greatest[0]} [{-greatest[1]}] |" in text
    assert "3 of 12 cases have faults" in text
    assert "case 3: `seven 3`" in text
    assert "case 5: `ValueError: eleven 5 (test_runs.py:" in text


def test_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(command, "CAMPAIGNS", {"squares": CAMPAIGN})
    places = ["--folder", str(tmp_path / "records"), "--pages", str(tmp_path / "pages")]
    assert command.main(["squares", "--cases", "3", *places]) == 0
    assert command.main(["squares", "--cases", "9", *places]) == 1
    assert "9 cases, 2 with faults" in capsys.readouterr().out
    assert (tmp_path / "pages" / "squares.md").read_text(encoding="utf-8").startswith("# Squares\n")
    assert command.main(["--case", "3", "--seed", "4"]) == 1
    assert "4 and 3" in capsys.readouterr().out
    assert command.main(["circles"]) == 2
    assert "campaigns are squares" in capsys.readouterr().err


def test_every_campaign_has_its_page() -> None:
    assert sorted(file.stem for file in PAGES.glob("*.md")) == sorted(CAMPAIGNS)
