"""Every topic, in the order of the commands and the chapters."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import ChapterOfTopic, Choice, Lazily, Topic

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
        ChapterOfTopic("flywheel", mark("Flywheel"), after="reduction"),
        ChapterOfTopic("real-motion", mark("Real motion")),
    ),
    after="region",
)

ANGLES = Topic(
    name="angles",
    help=mark("Compute transmission and pressure angles over the motion."),
    compute=Lazily("centrode.analysis.transmission", "transmission_results"),
    result=Lazily("centrode.analysis.transmission", "TransmissionResults"),
    view=Lazily("centrode.views.transmission", "sheet"),
    concerns=None,
    after="plan",
    folder="angles",
    dark=True,
)

TOPICS: tuple[Topic, ...] = (FLYWHEEL, ANGLES)
"""Every topic."""
