"""Every topic, in the order of the commands and the chapters."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import ChapterOfTopic, Choice, Lazily, MotionRange, Topic

FLYWHEEL = Topic(
    name="flywheel",
    help=mark("Find the flywheel of a machine, and its real motion."),
    compute=Lazily("centrode.dynamics.steady_motion.steady", "machine_results"),
    result=Lazily("centrode.dynamics.steady_motion.steady", "MachineResults"),
    view=Lazily("centrode.views.flywheel", "sheet"),
    concerns=Lazily("centrode.dynamics.steady_motion.steady", "is_machine"),
    needs=Lazily("centrode.dynamics.steady_motion.flywheel", "need_fluctuation"),
    options=(
        Choice(
            "mean",
            ("middle", "time"),
            mark("Mean speed: half of greatest and least (the rule), or turns over time."),
        ),
        Choice(
            "method",
            ("exact", "first-order"),
            mark("Real velocities by the energy equation (the rule), or by the first-order formula."),
        ),
    ),
    chapters=(
        ChapterOfTopic("flywheel", mark("Flywheel")),
        ChapterOfTopic("real-motion", mark("Real motion")),
    ),
    may_be_left_out=True,
)

REDUCTION = Topic(
    name="reduce",
    help=mark("Reduce masses and loads to the drive, part by part."),
    compute=Lazily("centrode.dynamics.reduction_results", "reduction_results"),
    result=Lazily("centrode.dynamics.reduction_results", "ReductionResults"),
    view=Lazily("centrode.views.reduction", "sheet"),
    concerns=Lazily("centrode.dynamics.masses", "has_masses_or_loads"),
    options=(MotionRange(),),
    chapters=(ChapterOfTopic("reduction", mark("Reduction to the drive")),),
    ending=Lazily("centrode.study.limiting", "check_reached"),
)

TOPICS: tuple[Topic, ...] = (REDUCTION, FLYWHEEL)
"""Every topic."""
