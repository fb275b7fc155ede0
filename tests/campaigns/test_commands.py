"""A fixed sample of the campaign of commands, within this process; every command has its turn."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from tools.campaigns.commands import lines
from tools.campaigns.commands.cases import run

from centrode.locale import choose_language_of_process

CASES = tuple(number for number in range(60) if number != 19)
"""The one that is left out makes a whole report: ten seconds."""


@pytest.fixture(autouse=True)
def english() -> Iterator[None]:
    """Commands of the sample choose languages; other tests of the process speak English."""
    yield
    choose_language_of_process("en")


@pytest.mark.parametrize("number", CASES)
def test_a_fixed_sample(number: int) -> None:
    outcome = run(1, number, here=True)
    assert outcome.faults == [], outcome.subject


def test_every_command_is_drawn_from() -> None:
    named = [" ".join(path) for path, _command in lines.commands()]
    assert len(named) == len(set(named))
    assert {"run", "report", "examples"} <= set(named)
