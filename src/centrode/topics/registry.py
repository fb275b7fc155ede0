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
        ChapterOfTopic("flywheel", mark("Flywheel")),
        ChapterOfTopic("real-motion", mark("Real motion")),
    ),
)

FOLLOWER_MOTION = Topic(
    name="follower-motion",
    help=mark("Find the motion of a cam's follower over a turn."),
    compute=Lazily("centrode.cams.followers.motion_results", "follower_motion_results"),
    result=Lazily("centrode.cams.followers.motion_results", "FollowerMotionResults"),
    view=Lazily("centrode.views.follower_motion", "sheet"),
    concerns=Lazily("centrode.model.cams.files", "has_follower"),
    chapters=(ChapterOfTopic("lift", mark("Motion of the follower")),),
    subject="cam",
)

MOTION_LAWS = Topic(
    name="motion-laws",
    help=mark("Compare laws of motion for the first rise of a cam's follower."),
    compute=Lazily("centrode.cams.followers.motion_results", "motion_law_results"),
    result=Lazily("centrode.cams.followers.motion_results", "MotionLawResults"),
    view=Lazily("centrode.views.motion_laws", "sheet"),
    concerns=Lazily("centrode.cams.followers.motion_results", "has_rise"),
    chapters=(ChapterOfTopic("laws", mark("Laws of motion for one rise")),),
    subject="cam",
    flag="laws",
)

TOPICS: tuple[Topic, ...] = (FLYWHEEL, FOLLOWER_MOTION, MOTION_LAWS)
"""Every topic."""
