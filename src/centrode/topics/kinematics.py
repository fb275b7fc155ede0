"""Topics of the motion: positions, velocities, centres, limits."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.option_values import (
    MOTION,
    READ_INSTANTS,
    READ_PAIRS,
    READ_PAIRS_OF_BODIES,
    READ_RANGES,
    READ_SCALES,
    READ_VARIED,
)
from centrode.topics.topic import (
    ChapterOfTopic,
    Command,
    FlagOption,
    InDocuments,
    Lazily,
    NumbersOption,
    Panel,
    RangeOptions,
    Topic,
    ValueOption,
)

RUN = Topic(
    name="run",
    compute=Lazily("centrode.dynamics.motion_results", "study"),
    result=Lazily("centrode.dynamics.motion_results", "MotionResults"),
    restore=Lazily("centrode.dynamics.motion_results", "results_of_motion"),
    view=Lazily("centrode.views.motion", "sheet"),
    command=Command(
        help=mark("Compute the motion of a mechanism: tables and pictures."),
        options=(RangeOptions(echoed=False), NumbersOption(), MOTION),
        folder="result",
        animation=Lazily("centrode.animation.animate", "animate_results"),
        animation_help=mark("Also write an animation of the motion."),
        animation_file="motion.gif",
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("motion", mark("Motion"), code="motion = ct.motion(mechanism)\nmotion"),
            ChapterOfTopic(
                "tables",
                mark("Tables of the motion"),
                code=(
                    "motion = ct.motion(mechanism)\n"
                    'display(motion["position"].to_series().unstack(["point", "axis"]))\n'
                    'motion["velocity"].to_series().unstack(["point", "axis"])'
                ),
            ),
            ChapterOfTopic(
                "plots",
                mark("Plots of the motion"),
                code="for figure in ct.figures(ct.motion(mechanism)).values():\n    display(figure)",
            ),
            ChapterOfTopic("conclusions", mark("Conclusions")),
        ),
        add_instants=Lazily("centrode.dynamics.motion_results", "with_instants"),
        wished=True,
        points=True,
    ),
    panel=Panel(pictures=False),
)

DIAGRAMS = Topic(
    name="diagrams",
    compute=Lazily("centrode.analysis.graphic.results", "graphic_analysis"),
    result=Lazily("centrode.analysis.graphic.results", "GraphicResults"),
    view=Lazily("centrode.views.graphic", "sheet"),
    concerns=Lazily("centrode.analysis.instant_centres.results", "is_planar"),
    command=Command(
        help=mark("Check velocities and accelerations by drawing them."),
        needs=Lazily("centrode.analysis.graphic.results", "need_few_instants"),
        options=(
            ValueOption(
                "at",
                mark("VALUE"),
                mark(
                    'Value of the drive ("pi/2 rad"), or time; by default the instants of the study, or else the start.'
                ),
                several=True,
                parameter="instants",
                read=READ_INSTANTS,
            ),
            ValueOption(
                "angle_step",
                mark("ANGLE"),
                mark('Reading step of directions ("1 deg"); exact by default.'),
            ),
            ValueOption(
                "length_step",
                mark("LENGTH"),
                mark('Reading step of lengths on paper ("0.5 mm"); exact by default.'),
            ),
            ValueOption(
                "scale",
                mark("NAME=VALUE"),
                mark('Scale in SI per millimetre: length, velocity or acceleration ("length=0.02").'),
                several=True,
                parameter="scales",
                read=READ_SCALES,
            ),
        ),
        folder="diagrams",
        samples=False,
        default_instants=True,
        dark=True,
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "graphic",
                mark("Graph-analytic check"),
                code="ct.graphic_analysis(mechanism, instants=instants, incomplete=True)",
            ),
        ),
        arguments={"incomplete": True},
        options=("angle_step",),
    ),
    panel=Panel(needs=mark("this is drawn in the plane only")),
)

PLAN = Topic(
    name="plan",
    compute=Lazily("centrode.analysis.position_plan", "plan_of_positions"),
    result=Lazily("centrode.analysis.position_plan", "PositionPlan"),
    view=Lazily("centrode.views.position_plan", "sheet"),
    concerns=Lazily("centrode.analysis.instant_centres.results", "is_planar"),
    command=Command(
        help=mark("Draw the mechanism in numbered positions of its cycle."),
        options=(
            ValueOption("positions", mark("N"), mark("Number of positions; 12 by default."), int),
            ValueOption(
                "link",
                mark("NAME"),
                mark("Link or guide whose velocity vanishes in position 0; a slider or rocker by default."),
            ),
        ),
        folder="plan",
        samples=False,
        dark=True,
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("positions", mark("Plan of positions"), code="ct.plan_of_positions(mechanism)"),
        ),
        instants=False,
        options=("positions",),
        points=True,
    ),
    panel=Panel(needs=mark("this is drawn in the plane only")),
)

CENTRES = Topic(
    name="centres",
    compute=Lazily("centrode.analysis.instant_centres.results", "centre_results"),
    result=Lazily("centrode.analysis.instant_centres.results", "CentreResults"),
    restore=Lazily("centrode.analysis.instant_centres.results", "results_of_centres"),
    view=Lazily("centrode.views.centres", "sheet"),
    command=Command(
        help=mark("Find the instant centres of velocity of every pair of links."),
        needs=Lazily("centrode.analysis.instant_centres.results", "need_pairs"),
        options=(
            ValueOption(
                "at",
                mark("VALUE"),
                mark(
                    'Value of the drive ("pi/2 rad"), or time; by default the instants of the study, or else the start.'
                ),
                several=True,
                parameter="instants",
                read=READ_INSTANTS,
            ),
            ValueOption(
                "pair",
                mark("LINK,LINK"),
                mark('Two links ("AC,frame"); all pairs by default. May be repeated.'),
                several=True,
                parameter="pairs",
                read=READ_PAIRS_OF_BODIES,
            ),
        ),
        samples=False,
        default_instants=True,
        ending=Lazily("centrode.analysis.instant_centres.results", "centre_shortfall"),
        dark=True,
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "centres",
                mark("Instant centres of velocity"),
                concerns=Lazily("centrode.analysis.instant_centres.results", "is_planar"),
                code="ct.instant_centres(ct.motion(mechanism, at=instants))",
            ),
            ChapterOfTopic(
                "axes",
                mark("Instantaneous axes"),
                concerns=Lazily("centrode.analysis.instant_centres.results", "is_on_sphere"),
                code="ct.instant_centres(ct.motion(mechanism, at=instants))",
            ),
        ),
        may_be_left_out=True,
    ),
)

CENTRODES = Topic(
    name="centrodes",
    compute=Lazily("centrode.analysis.instant_centres.results", "centrode_results"),
    result=Lazily("centrode.analysis.instant_centres.results", "CentrodeResults"),
    restore=Lazily("centrode.analysis.instant_centres.results", "results_of_centrodes"),
    view=Lazily("centrode.views.centrodes", "sheet"),
    command=Command(
        help=mark("Compute the centrodes of a link and draw them."),
        options=(
            ValueOption(
                "link", mark("LINK"), mark("The link that carries the moving centrode."), required=True
            ),
            ValueOption("against", mark("LINK"), mark("The link that it rolls on; the frame by default.")),
            ValueOption(
                "at",
                mark("VALUE"),
                mark("Also the curvature of the paths of the link's points there; may be repeated."),
                several=True,
                parameter="instants",
                read=READ_INSTANTS,
            ),
            RangeOptions(),
        ),
        ending=Lazily("centrode.analysis.instant_centres.results", "centrode_shortfall"),
        folder="centrodes",
        dark=True,
        animation=Lazily("centrode.animation.animate", "animate_rolling"),
        animation_help=mark("Also write an animation: one centrode rolls on the other."),
    ),
    panel=Panel(mark("Centrodes")),
)

ANGLES = Topic(
    name="angles",
    compute=Lazily("centrode.analysis.transmission", "transmission_results"),
    result=Lazily("centrode.analysis.transmission", "TransmissionResults"),
    restore=Lazily("centrode.analysis.transmission", "TransmissionResults"),
    view=Lazily("centrode.views.transmission", "sheet"),
    command=Command(
        help=mark("Compute transmission and pressure angles over the motion."), folder="angles", dark=True
    ),
    panel=Panel(mark("Transmission angles")),
)

ROTATABILITY = Topic(
    name="rotatability",
    compute=Lazily("centrode.analysis.redesign.results", "rotatability_results"),
    result=Lazily("centrode.analysis.rotatability.rotatability", "Rotatability"),
    view=Lazily("centrode.views.rotatability", "sheet"),
    command=Command(
        help=mark("Check whether a mechanism turns fully, and repair it."),
        needs=Lazily("centrode.analysis.redesign.results", "need_repair"),
        options=(
            FlagOption("repair", mark("Seek the smallest change after which it turns fully.")),
            ValueOption(
                "vary",
                mark("PATH[=LOW:HIGH]"),
                mark('A number that may change ("links.CB.angle=200 deg:300 deg"); may be repeated.'),
                several=True,
                read=READ_VARIED,
            ),
            ValueOption(
                "least_transmission_angle",
                mark("ANGLE"),
                mark(
                    "Least transmission angle of every dyad; by default 20 deg, or less where that is out of reach."
                ),
            ),
            ValueOption(
                "greatest_change",
                mark("SHARE"),
                mark(
                    "Greatest change of a length over itself, or of a coordinate over the greatest length (0.3)."
                ),
            ),
        ),
        progress=mark("seeking a repair, %"),
        kinds=("json", "toml"),
        file_help=mark("Also write FILE.json with the result, or FILE.toml with the repaired mechanism."),
        samples=False,
    ),
    document=InDocuments(
        chapters=(ChapterOfTopic("rotatability", mark("Rotatability"), code="ct.rotatability(mechanism)"),),
        arguments={"complete": True},
        instants=False,
        options=("least_transmission_angle", "greatest_change"),
    ),
)

REPAIR = Topic(
    name="repair",
    compute=Lazily("centrode.analysis.redesign.results", "repair_results"),
    result=Lazily("centrode.analysis.redesign.repair", "Repair"),
    view=Lazily("centrode.views.rotatability", "repair_sheet"),
    concerns=Lazily("centrode.analysis.redesign.repair", "needs_repair"),
    flag="repair",
)

LIMITS = Topic(
    name="limits",
    compute=Lazily("centrode.kinematics.several_inputs.limits", "limits"),
    result=Lazily("centrode.kinematics.several_inputs.limits", "Limits"),
    view=Lazily("centrode.views.limits", "sheet"),
    concerns=Lazily("centrode.kinematics.several_inputs.limits", "has_one_drive"),
    command=Command(
        help=mark("Find the limits of one drive with the others fixed."),
        options=(
            ValueOption("drive", mark("NAME"), mark("The drive that moves; required if there are several.")),
            ValueOption(
                "hold",
                mark("NAME=VALUE"),
                mark('Value of another drive ("EC=30 deg"); its initial value by default.'),
                several=True,
                parameter="held",
                read=READ_PAIRS,
            ),
            ValueOption(
                "about", mark("VALUE"), mark("Value from which it moves; its initial value by default.")
            ),
        ),
        kinds=("json", "csv"),
        samples=False,
    ),
    panel=Panel(mark("Limits of a drive"), mark("this takes one drive by a link, a guide or a distance")),
)

REGION = Topic(
    name="region",
    compute=Lazily("centrode.kinematics.several_inputs.region", "region_results"),
    result=Lazily("centrode.kinematics.several_inputs.region", "RegionResults"),
    restore=Lazily("centrode.kinematics.several_inputs.region", "results_of_region"),
    view=Lazily("centrode.views.regions", "sheet"),
    concerns=Lazily("centrode.kinematics.several_inputs.region", "has_two_drives"),
    command=Command(
        help=mark("Compute the reachable region of two drives and draw it."),
        options=(
            ValueOption(
                "drive",
                mark("NAME"),
                mark("One of the two drives; give the option twice if there are more than two."),
                several=True,
                parameter="drives",
            ),
            ValueOption(
                "range",
                mark("NAME=FIRST:LAST"),
                mark(
                    'Range of a drive ("EC=0 deg:90 deg"); by default one turn, or the range between its limits.'
                ),
                several=True,
                parameter="ranges",
                read=READ_RANGES,
            ),
            ValueOption(
                "hold",
                mark("NAME=VALUE"),
                mark("Value of a further drive; its initial value by default."),
                several=True,
                parameter="held",
                read=READ_PAIRS,
            ),
            ValueOption("samples", mark("N"), mark("Grid lines of each drive."), int),
        ),
        folder="region",
        samples=False,
    ),
    panel=Panel(mark("Reachable region of two drives"), mark("this takes two drives")),
)
