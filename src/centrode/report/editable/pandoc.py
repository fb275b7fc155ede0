"""Pandoc, which reads formulas and writes documents: each run is a process of its own that sees one text."""

from __future__ import annotations

import os
import subprocess
from functools import cache
from pathlib import Path

import pypandoc

EPOCH = {"SOURCE_DATE_EPOCH": "315532800"}  # 1980, the first year that files of a ZIP can have
"""The time that documents say they were written at: the same report gives the same bytes."""


def run_pandoc(content: bytes, *options: str, folder: str | Path | None = None) -> bytes:
    """What pandoc makes of a text; ValueError, which is a fault of whoever made the text, where it refuses it
    or does not understand a formula.

    Parameters
    ----------
    content : what it reads
    options : of its command line
    folder : in which the files lie that the text names; it has none if left out
    """
    command = [_program(), "--fail-if-warnings", *options, *(["--sandbox"] if folder is None else [])]
    done = subprocess.run(command, input=content, capture_output=True, cwd=folder, env=os.environ | EPOCH)
    if done.returncode:
        raise ValueError(done.stderr.decode(errors="replace").strip())
    return done.stdout


@cache
def _program() -> str:
    return str(pypandoc.get_pandoc_path())
