"""Every topic, in the order of the commands and the chapters."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import ChapterOfTopic, Choice, Lazily, Option, OptionKind, Topic

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
)

INTEGRATE = Topic(
    name="integrate",
    help=mark("Integrate the differential equations of a mechanism."),
    compute=Lazily("centrode.equations.integrated", "integration_results"),
    result=Lazily("centrode.equations.integrated", "IntegrationResults"),
    view=Lazily("centrode.views.integrations", "sheet"),
    concerns=Lazily("centrode.equations.integrated", "is_integrated"),
    options=(
        Option(
            "method",
            OptionKind.WORD,
            mark("Fixed steps of Runge-Kutta's method of fourth order, or adaptive ones of eighth order."),
            "rk4|adaptive",
        ),
        Option("steps", OptionKind.COUNT, mark("Number of steps, and of rows less one."), mark("N")),
        Option("tolerance", OptionKind.NUMBER, mark("Tolerance of each adaptive step."), mark("X")),
        Option("to", OptionKind.INSTANT, mark("Last value of the drive, or last time."), mark("B"), "stop"),
    ),
    chapters=(ChapterOfTopic("integration", mark("Integration of the equations"), after="centres"),),
    after="equations",
    folder="integration",
    samples=False,
    instants=False,
    in_documents={"method": "adaptive"},
    missing_says=False,
)

LIMITS = Topic(
    name="limits",
    help=mark("Find the limits of one drive while the others are held."),
    compute=Lazily("centrode.kinematics.several_drives.reach", "limits"),
    result=Lazily("centrode.kinematics.several_drives.reach", "Limits"),
    view=Lazily("centrode.views.limits", "sheet"),
    concerns=Lazily("centrode.kinematics.several_drives.reach", "has_one_drive"),
    options=(
        Option(
            "drive",
            OptionKind.WORD,
            mark("The drive that moves; needed where there are several."),
            mark("NAME"),
        ),
        Option(
            "hold",
            OptionKind.PAIRS,
            mark('Value of another drive ("EC=30 deg"); its initial one if left out.'),
            mark("NAME=VALUE"),
            "held",
        ),
        Option(
            "about",
            OptionKind.WORD,
            mark("Value from which it moves; its initial one if left out."),
            mark("VALUE"),
        ),
    ),
    after="variants",
    files=("json", "csv"),
    samples=False,
)

REGION = Topic(
    name="region",
    help=mark("Compute the reachable region of two drives and draw it."),
    compute=Lazily("centrode.kinematics.several_drives.region", "region_results"),
    result=Lazily("centrode.kinematics.several_drives.region", "RegionResults"),
    view=Lazily("centrode.views.regions", "sheet"),
    concerns=Lazily("centrode.kinematics.several_drives.region", "has_two_drives"),
    options=(
        Option(
            "drive",
            OptionKind.WORDS,
            mark("One of the two drives; say it twice where there are more than two."),
            mark("NAME"),
            "drives",
        ),
        Option(
            "range",
            OptionKind.RANGES,
            mark('Range of a drive ("EC=0 deg:90 deg"); one turn, or between its limits, if left out.'),
            mark("NAME=FIRST:LAST"),
            "ranges",
        ),
        Option(
            "hold",
            OptionKind.PAIRS,
            mark("Value of a further drive; its initial one if left out."),
            mark("NAME=VALUE"),
            "held",
        ),
        Option("samples", OptionKind.COUNT, mark("Grid lines of each drive."), mark("N")),
    ),
    folder="region",
    samples=False,
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

TOPICS: tuple[Topic, ...] = (INTEGRATE, LIMITS, REGION, FLYWHEEL, ANGLES)
"""Every topic."""
