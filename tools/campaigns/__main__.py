"""`python -m tools.campaigns [NAME ...]` runs campaigns and writes their pages; a run that was cut short goes on.

The exit code is 1 where a case has a fault.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
import warnings
from pathlib import Path

# lazy_loader remarks that a submodule loads its package; here nothing is gained by loading only the package late
warnings.filterwarnings(
    "ignore", message="subpackages can technically be lazily loaded", category=RuntimeWarning
)

from centrode.errors import InputError  # noqa: E402
from tools.campaigns.campaign import Campaign  # noqa: E402
from tools.campaigns.registry import CAMPAIGNS  # noqa: E402
from tools.campaigns.runner import FOLDER, PAGES, run_campaign, write_page  # noqa: E402

SEED = 1
INTERRUPTED = 130


def main(words: list[str] | None = None) -> int:
    """Run what the words of the command line ask for; returns the exit code."""
    given = parsed(words)
    unknown = [name for name in given.names if name not in CAMPAIGNS]
    if unknown:
        print(f"unknown: {', '.join(unknown)}; campaigns are {', '.join(CAMPAIGNS)}", file=sys.stderr)
        return 2
    chosen = [CAMPAIGNS[name] for name in given.names or CAMPAIGNS]
    try:
        if given.case is not None:
            return max(show(campaign, given.seed, given.case) for campaign in chosen)
        return max(carry_out(campaign, given) for campaign in chosen)
    except InputError as error:
        print(f"Error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted; the same command goes on from the last block", file=sys.stderr)
        return INTERRUPTED


def parsed(words: list[str] | None) -> argparse.Namespace:
    """The options of a command line."""
    parser = argparse.ArgumentParser(prog="python -m tools.campaigns", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"all if left out: {', '.join(CAMPAIGNS)}")
    parser.add_argument("--seed", type=natural, default=SEED, help="what cases are drawn from")
    parser.add_argument(
        "--cases", type=natural, help="how many there are to be; each campaign has a number of its own"
    )
    parser.add_argument("--minutes", type=minutes, default=math.inf, help="most time for each campaign")
    parser.add_argument("--folder", type=Path, default=FOLDER, help="of the records of what has been run")
    parser.add_argument("--pages", type=Path, default=PAGES, help="where pages are written")
    parser.add_argument("--anew", action="store_true", help="begin again instead of going on")
    parser.add_argument(
        "--case", type=natural, metavar="NUMBER", help="run this case alone and show it in full"
    )
    return parser.parse_args(words)


def natural(word: str) -> int:
    """A whole number from 0."""
    number = int(word)
    if number < 0:
        raise ValueError(word)
    return number


def minutes(word: str) -> float:
    """A time above 0."""
    time = float(word)
    if not time > 0.0:
        raise ValueError(word)
    return time


def show(campaign: Campaign, seed: int, number: int) -> int:
    """Print a case with its figures and faults."""
    outcome = campaign.outcome(seed, number)
    print(f"{campaign.name}, seed {seed}, case {number}\n\n{outcome.subject}\n")
    for (row, column), value in outcome.figures.items():
        print(f"{row}: {column} {value:.3g}")
    for what, count in outcome.counts.items():
        print(f"{what}: {count}")
    for what in outcome.faults:
        print(f"fault: {what}")
    return 1 if outcome.faults else 0


def carry_out(campaign: Campaign, given: argparse.Namespace) -> int:
    """Run a campaign as far as asked and write its page."""
    cases = campaign.cases if given.cases is None else given.cases
    tally = run_campaign(campaign, given.seed, cases, 60.0 * given.minutes, given.folder, given.anew)
    file = write_page(campaign, given.seed, tally, given.pages)
    faulty = len({number for number, _what in tally.faults})
    print(f"{campaign.name}: {tally.cases} cases, {faulty} with faults; wrote {os.path.relpath(file)}")
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main())
