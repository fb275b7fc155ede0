"""Failures that carry their data and say the repair, and the statuses of samples."""

from __future__ import annotations

from enum import IntEnum
from typing import Self


class CentrodeError(Exception):
    """A failure told to the user in a sentence: where, what, and the repair.

    Attributes
    ----------
    where : str
        File, table or key the message is about; empty where there is none.
    what, repair : str
        What is wrong, and what to do about it, already in the user's language.
    exit_code : int
        What the command line returns: 2 for wrong input, 3 for a mechanism that cannot do what was asked.

    Examples
    --------
    >>> import centrode as ct
    >>> try:
    ...     ct.motion(ct.example("crank-rocker"), 0)
    ... except ct.CentrodeError as failure:
    ...     failure.exit_code
    2
    """

    exit_code = 2

    def __init__(self, where: str, what: str, repair: str = "") -> None:
        self.where = where
        self.what = what
        self.repair = repair
        super().__init__(str(self))

    def __reduce__(self) -> tuple[type[Self], tuple[str, str, str]]:
        """The failure as another process gets it: Exception itself would hand over the sentence alone."""
        return type(self), (self.where, self.what, self.repair)

    def __str__(self) -> str:
        sentence = f"{self.where}: {self.what}" if self.where else self.what
        return f"{sentence}; {self.repair}" if self.repair else sentence


class InputError(CentrodeError):
    """The input is wrong: nothing was computed and nothing was written.

    Examples
    --------
    >>> import centrode as ct
    >>> try:
    ...     ct.example("crank")
    ... except ct.InputError as failure:
    ...     failure.repair
    'list them with: centrode examples'
    """


class NotComputedYet(InputError):
    """The input is right, but names something this version does not compute.

    Examples
    --------
    >>> import centrode as ct
    >>> try:
    ...     ct.curvature(ct.example("spherical-four-bar"), "BC", [0.1])
    ... except ct.NotComputedYet as failure:
    ...     failure.what
    'curvature is not computed on the sphere'
    """


class MotionError(CentrodeError):
    """The mechanism cannot do what was asked: what could be computed stands beside the message.

    Examples
    --------
    >>> import centrode as ct
    >>> try:
    ...     ct.graphic_analysis(ct.example("slider-between-cranks-locked"), instants=[3.0])
    ... except ct.MotionError as failure:
    ...     failure.what
    'at 3 the mechanism is open: nothing can be constructed'
    """

    exit_code = 3


class DamageWarning(RuntimeWarning):
    """Results kept by an earlier run are damaged; what was lost is made again."""


class ClusterWarning(RuntimeWarning):
    """Nothing is wrong with the work, but the cluster does not do it now."""


class Status(IntEnum):
    """What a sample of a motion is worth; every motion carries one per sample.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.Status(0).name, ct.Status.OPEN.word
    ('OK', 'open')
    """

    OK = 0
    OPEN = 1
    CUT_OFF = 2
    SINGULAR = 3
    UNCONVERGED = 4
    SELF_LOCKING = 5

    @property
    def word(self) -> str:
        """The word that tables and messages use, in English; catalogues translate it for display."""
        return self.name.lower().replace("_", "-" if self is Status.SELF_LOCKING else " ")


STATUSES_OF_MOTION = tuple(status for status in Status if status is not Status.SELF_LOCKING)
"""Those that a motion itself can have; friction adds one to reactions."""
STATUSES_NOT_REACHED = (Status.OPEN, Status.CUT_OFF, Status.UNCONVERGED)
"""Those of samples that a mechanism does not reach from its initial position."""
