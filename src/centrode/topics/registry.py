"""Every topic, in the order of the commands and the chapters."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import ChapterOfTopic, Choice, Given, Lazily, OutFolder, Topic

INSTANT = Lazily("centrode.model.motion_parameter", "read_instant")
"""Reads a value of the drive, or a time where that states an instant."""

READ_PAIR = Lazily("centrode.analysis.instant_centres.results", "read_pair")
"""Reads the names of two bodies."""

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
        ChapterOfTopic("real-motion", mark("Real motion"), after="flywheel"),
    ),
    after="region",
)

CENTRES = Topic(
    name="centres",
    help=mark("Find the instant centres of velocity of every pair of links."),
    compute=Lazily("centrode.analysis.instant_centres.results", "centre_results"),
    result=Lazily("centrode.analysis.instant_centres.results", "CentreResults"),
    view=Lazily("centrode.views.centres", "sheet"),
    needs=Lazily("centrode.analysis.instant_centres.results", "need_pairs"),
    options=(
        Given(
            "at",
            "instants",
            mark("VALUE"),
            mark(
                'Value of the drive ("pi/2 rad"), or time; the instants of the study if left out, else the start.'
            ),
            read=INSTANT,
            several=True,
        ),
        Given(
            "pair",
            "pairs",
            mark("LINK,LINK"),
            mark('Two links ("AC,frame"); all pairs if left out. As often as needed.'),
            read=READ_PAIR,
            several=True,
        ),
    ),
    chapters=(
        ChapterOfTopic(
            "centres",
            mark("Instant centres of velocity"),
            after="graphic",
            concerns=Lazily("centrode.analysis.instant_centres.results", "is_planar"),
        ),
        ChapterOfTopic(
            "axes",
            mark("Instantaneous axes"),
            after="rotatability",
            concerns=Lazily("centrode.analysis.instant_centres.results", "is_on_sphere"),
        ),
    ),
    samples=False,
    shortfall=Lazily("centrode.analysis.instant_centres.results", "centre_shortfall"),
    dark=True,
    out=OutFolder.ON_REQUEST,
    after="cam",
)

CENTRODES = Topic(
    name="centrodes",
    help=mark("Compute the centrodes of a link and draw them."),
    compute=Lazily("centrode.analysis.instant_centres.results", "centrode_results"),
    result=Lazily("centrode.analysis.instant_centres.results", "CentrodeResults"),
    view=Lazily("centrode.views.centrodes", "sheet"),
    options=(
        Given(
            "link", "link", mark("LINK"), mark("The link that carries the moving centrode."), required=True
        ),
        Given("against", "against", mark("LINK"), mark("The link that it rolls on; the frame if left out.")),
        Given(
            "at",
            "instants",
            mark("VALUE"),
            mark("Also the curvature of the paths of the link's points there; as often as needed."),
            read=INSTANT,
            several=True,
        ),
    ),
    ranged=True,
    shortfall=Lazily("centrode.analysis.instant_centres.results", "centrode_shortfall"),
    animation=Lazily("centrode.present.animations.given", "animate_rolling"),
    animation_help=mark("Also write an animation: one centrode rolls on the other."),
    dark=True,
    out=OutFolder.ALWAYS,
    after="centres",
)

TOPICS: tuple[Topic, ...] = (FLYWHEEL, CENTRES, CENTRODES)
"""Every topic."""
