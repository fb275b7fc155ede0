"""Every topic, in the order of the commands and the chapters."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import ChapterOfTopic, Choice, Flag, Instants, Lazily, MotionRange, Topic

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
    may_be_left_out=True,
    after="region",
)

REACTIONS = Topic(
    name="reactions",
    help=mark("Find the forces in every joint and what the drives must give."),
    compute=Lazily("centrode.dynamics.bearings.results", "reaction_results"),
    result=Lazily("centrode.dynamics.bearings.results", "ReactionResults"),
    view=Lazily("centrode.views.reactions", "sheet"),
    concerns=Lazily("centrode.dynamics.bearings.results", "has_forces"),
    options=(
        Instants(mark('Only at this value of the drive ("120 deg"), or time ("1 s"); as often as needed.')),
        Flag("steady", mark("At the real speed of a machine in steady motion, not at its mean speed.")),
        Flag("frictionless", mark("Leave out friction that is given by coefficients.")),
        MotionRange(),
    ),
    chapters=(ChapterOfTopic("reactions", mark("Reactions in the joints"), after="simulation"),),
    ending=Lazily("centrode.study.forces.reached", "refuse_unreached"),
    may_be_left_out=True,
    after="reduce",
    summary=False,
    complete="complete",
    add_instants=Lazily("centrode.dynamics.bearings.results", "with_instants"),
    may_be_incomplete=True,
)

TOPICS: tuple[Topic, ...] = (FLYWHEEL, REACTIONS)
"""Every topic."""
