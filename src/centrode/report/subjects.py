"""What there are reports on: descriptions of every kind, and requests of a synthesis."""

from __future__ import annotations

from pathlib import Path
from typing import TypeAlias

from centrode.errors import InputError
from centrode.model.examples.catalogue import Described, DescribedSource, reported_description
from centrode.model.reading import read_file
from centrode.model.toml import SYNTHESIS, description_kind, toml_tables
from centrode.synthesis.requests import SYNTHESES, SynthesisTask

Reported: TypeAlias = Described | SynthesisTask
ReportedSource: TypeAlias = DescribedSource | SynthesisTask


def reported_subject(source: ReportedSource) -> Reported:
    """A description or a request itself, or what its file or a built-in name holds; InputError for anything else."""
    if isinstance(source, SynthesisTask):
        return source
    if isinstance(source, str | Path) and _is_request(Path(source)):
        return SYNTHESES.read(source)
    return reported_description(source)


def _is_request(path: Path) -> bool:
    """Whether a file has a table [synthesis]; what is wrong with it is said where it is read in full."""
    if not path.is_file():
        return False
    try:
        return description_kind(toml_tables(read_file(path), path.name)) == SYNTHESIS
    except InputError:
        return False
