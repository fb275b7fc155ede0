"""Every kind of description refuses those of the others in their own words, with the command that takes them."""

from __future__ import annotations

import itertools

import pytest

import centrode as ct
from centrode.model.cam_files import CAMS
from centrode.model.examples import FOLDERS, example_names, example_text
from centrode.model.files import MECHANISMS
from centrode.model.gear_pairs import GEAR_PAIRS
from centrode.model.gear_trains import GEAR_TRAINS
from centrode.model.toml import KINDS
from centrode.synthesis.requests import SYNTHESES

FILES = {files.kind: files for files in (MECHANISMS, CAMS, GEAR_PAIRS, GEAR_TRAINS, SYNTHESES)}
TEXTS = {kind: example_text(example_names(kind)[0]) for kind in FOLDERS} | {
    "synthesis": '[synthesis]\nkind = "strokes"\ntopology = "shaper"\nstroke = "0.4 m"\n'
}
COMMANDS = {
    "linkage": "centrode run",
    "cam": "centrode cam",
    "gear pair": "centrode gears",
    "gear train": "centrode trains",
    "synthesis": "centrode synthesise",
}


def test_every_kind_has_its_files() -> None:
    assert set(FILES) == set(KINDS) == set(TEXTS)


@pytest.mark.parametrize(("given", "wanted"), list(itertools.permutations(COMMANDS, 2)))
def test_another_kind_is_refused_with_the_command_that_takes_it(given: str, wanted: str) -> None:
    with pytest.raises(ct.InputError) as caught:
        FILES[wanted].parse(TEXTS[given], "sent.toml")
    assert caught.value.where == "sent.toml"
    if (given, wanted) == ("linkage", "synthesis"):  # one table more makes a request of it
        assert "[synthesis]" in caught.value.what
    else:
        assert caught.value.what == f"{KINDS[given].described}, {KINDS[wanted].wanted}"
        assert COMMANDS[given] in caught.value.repair


@pytest.mark.parametrize("kind", FILES)
def test_a_file_is_read_as_its_text(kind: str, tmp_path) -> None:
    file = tmp_path / "described.toml"
    file.write_text(TEXTS[kind], encoding="utf-8")
    read = FILES[kind].read(file)
    assert read == FILES[kind].parse(TEXTS[kind])
    if kind != "synthesis":
        assert FILES[kind].parse(FILES[kind].text(read)) == read


def test_a_request_of_synthesis_beside_links_is_none_of_a_linkage() -> None:
    text = TEXTS["linkage"] + "\n" + TEXTS["synthesis"].replace('topology = "shaper"\n', "")
    with pytest.raises(ct.InputError, match="centrode synthesise"):
        ct.parse_mechanism(text)
