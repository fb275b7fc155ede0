"""What a description says of its note: read as it is written, refused with its place where it is wrong."""

from __future__ import annotations

import pytest

from centrode.errors import InputError
from centrode.model.explanatory_note import LINE_LENGTH, MOST_SOURCES, PROSE_LENGTH, SOURCE_LENGTH
from centrode.model.files import mechanism_text, parse_mechanism
from centrode.model.settings import ReportWishes

from .conftest import FOUR_BAR

NOTE = """
[report]
standard = "dstu"
task = '''
First.

Second.
'''
conclusions = "Done \U0001f600."
sources = ["One. 2020.", "Two. 2021."]
rows = 25
positions = 8
rk4_steps = 100
angle_step = "1 deg"
least_transmission_angle = "30 deg"
greatest_change = 0.4
[report.title_page]
author = "A.  B"
variant = 7
year = 2026
"""


def parsed(text: str) -> ReportWishes:
    return parse_mechanism(FOUR_BAR + text, "note.toml").report


def test_a_note_is_read_and_written_back() -> None:
    found = parsed(NOTE)
    assert found.is_note
    page = found.title_page
    assert page is not None
    assert (page.author, page.variant, page.year, page.city) == ("A. B", "7", 2026, "")
    assert found.conclusions == "Done \U0001f600."
    assert found.angle_step == pytest.approx(0.017453292519943295)
    assert found.least_transmission_angle == pytest.approx(0.5235987755982988)
    assert found.greatest_change == 0.4
    again = parse_mechanism(mechanism_text(parse_mechanism(FOUR_BAR + NOTE, "note.toml")), "again.toml")
    assert again.report == found


def test_a_report_without_the_keys_of_a_note_is_none() -> None:
    assert not parsed("").is_note
    assert not parsed('[report]\nstandard = "plain"\nrows = 5\n').is_note
    assert parsed('[report]\nstandard = "gost"\n').is_note


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            '[report]\nstandard = "gots"\n',
            '[report] standard: expected one of "plain", "gost", "dstu", got "gots"',
        ),
        ("[report]\nstandard = 2\n", '[report] standard: expected one of "plain", "gost", "dstu", got 2'),
        ('[report]\ntask = " "\n', "[report]: task is empty; write a text, or remove the key"),
        ("[report]\ntask = 5\n", "[report] task: expected a text, got 5"),
        ('[report]\ntask = ["a"]\n', "[report] task: expected a text"),
        (f'[report]\ntask = "{"a" * (PROSE_LENGTH + 1)}"\n', f"a text has at most {PROSE_LENGTH} characters"),
        ('[report]\nconclusions = "a\\u0007"\n', "[report]: conclusions has control characters"),
        ('[report]\nsources = "Book"\n', "[report] sources: expected a list"),
        ('[report]\nsources = ["Book", ""]\n', "[report]: sources is empty"),
        ('[report]\nsources = ["Book", 5]\n', "[report] sources: expected a text, got 5"),
        (
            f'[report]\nsources = ["{"a" * (SOURCE_LENGTH + 1)}"]\n',
            f"a text has at most {SOURCE_LENGTH} characters",
        ),
        (
            f"[report]\nsources = {['a'] * (MOST_SOURCES + 1)}\n",
            f"at most {MOST_SOURCES} entries are allowed",
        ),
        ('[report.title_page]\nauthor = "  "\n', "[report.title_page]: author is empty"),
        ('[report.title_page]\nauthor = "a\\nb"\n', "control characters; write one line of text"),
        ("[report.title_page]\nauthor = 5\n", "[report.title_page] author: expected a text, got 5"),
        (
            f'[report.title_page]\ntitle = "{"a" * (LINE_LENGTH + 1)}"\n',
            f"a text has at most {LINE_LENGTH} characters",
        ),
        ('[report.title_page]\nautor = "A"\n', 'unknown key "autor"; did you mean "author"?'),
        ('[report.title_page]\nyear = "2026"\n', 'year must be a whole number, got "2026"'),
        ("[report.title_page]\nyear = 26\n", "year must lie between 1900 and 2200, got 26"),
        ("[report.title_page]\nvariant = true\n", "[report.title_page] variant: expected a text, got true"),
        ("[report]\nrows = 1\n", "rows must lie between 2 and 1000, got 1"),
        ("[report]\npositions = 2.5\n", "positions must be a whole number, got 2.5"),
        ("[report]\nrk4_steps = 0\n", "rk4_steps must lie between 1 and 100000, got 0"),
        ('[report]\nangle_step = "1 mm"\n', "[report] angle_step: expected an angle"),
        ("[report]\nangle_step = 0\n", "angle_step must be positive"),
        ('[report]\nleast_transmission_angle = "1 mm"\n', "least_transmission_angle: expected an angle"),
        (
            '[report]\nleast_transmission_angle = "90 deg"\n',
            "least_transmission_angle must be smaller than 90 deg",
        ),
        ("[report]\ngreatest_change = 1.5\n", "greatest_change must be smaller than 1, got 1.5"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(text: str, message: str) -> None:
    with pytest.raises(InputError) as failure:
        parsed(text)
    told = str(failure.value)
    assert told.startswith("note.toml, ")
    assert message in told
