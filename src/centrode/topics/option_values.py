"""Values and options that commands of several topics share."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import ChoiceOption, Lazily

READ_SCALES = Lazily("centrode.cli.option_values", "read_scales")
READ_SPEEDS = Lazily("centrode.cli.option_values", "read_speeds")
READ_PAIRS = Lazily("centrode.cli.option_values", "read_pairs")
READ_PAIRS_OF_BODIES = Lazily("centrode.cli.option_values", "read_pairs_of_bodies")
READ_RANGES = Lazily("centrode.cli.option_values", "read_ranges")
READ_BOUNDS = Lazily("centrode.cli.option_values", "read_bounds")
READ_VARIED = Lazily("centrode.cli.option_values", "read_varied")
READ_INSTANTS = Lazily("centrode.cli.option_values", "read_instants")
READ_INSTANT = Lazily("centrode.cli.option_values", "read_instant")

MOTION = ChoiceOption(
    "motion",
    ("mean", "real"),
    mark("Forces at the mean speed (default), or at the real speed and acceleration of a machine."),
)
WRITTEN_PAGE = mark("Write FILE.txt, FILE.tex (LaTeX) or FILE.md (Markdown) instead of printing.")
