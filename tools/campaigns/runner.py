"""Runs of a campaign: block by block into its record, as far as asked, and its page at the end."""

from __future__ import annotations

import hashlib
import time
from pathlib import Path
from typing import Any

import centrode
from centrode.cli.progress import Progress
from centrode.files.locks import hold_lock
from tools.campaigns.campaign import Campaign, Tally
from tools.campaigns.page import page
from tools.campaigns.record import Record

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "docs" / "validation"
FOLDER = ROOT / "campaigns-output"


def state_of_the_program() -> str:
    """A fingerprint of the program's source and of the campaigns': figures of two states are not added up."""
    found = hashlib.sha256()
    for folder in (Path(centrode.__file__).parent, Path(__file__).parent):
        for file in sorted(folder.rglob("*.py")):
            found.update(file.relative_to(folder).as_posix().encode() + b"\0" + file.read_bytes())
    return found.hexdigest()


def run_campaign(
    campaign: Campaign, seed: int, cases: int, seconds: float, folder: Path, anew: bool = False
) -> Tally:
    """Go on with a campaign until it has so many cases or the time is up; returns all that its record has."""
    file = folder / f"{campaign.name}-{seed}.jsonl"
    heading: dict[str, Any] = {"campaign": campaign.name, "seed": seed, "program": state_of_the_program()}
    folder.mkdir(parents=True, exist_ok=True)
    with hold_lock(folder / f"{campaign.name}-{seed}.lock", str(file)), Progress() as progress:
        if anew:
            file.unlink(missing_ok=True)
        record = Record.opened(file, heading)
        began = time.monotonic()
        while record.tally.cases < cases and time.monotonic() - began < seconds:
            first = record.tally.cases
            block = Tally()
            for number in range(first, min(first + campaign.block, cases)):
                progress.say(campaign.title, number, cases)
                block.add(number, campaign.outcome(seed, number))
            record.take(block)
    return record.tally


def write_page(campaign: Campaign, seed: int, tally: Tally, folder: Path = PAGES) -> Path:
    """Write the page of a campaign; returns its file."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{campaign.name}.md"
    file.write_text(page(campaign, seed, tally), encoding="utf-8")
    return file
