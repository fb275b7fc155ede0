"""Every topic."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import (
    ChapterOfTopic,
    ChoiceOption,
    Command,
    FlagOption,
    InDocuments,
    InstantsOption,
    Lazily,
    NumbersOption,
    Panel,
    RangeOptions,
    Topic,
    ValueOption,
)

READ_SCALES = Lazily("centrode.cli.option_values", "read_scales")
READ_SPEEDS = Lazily("centrode.cli.option_values", "read_speeds")
READ_PAIRS = Lazily("centrode.cli.option_values", "read_pairs")
READ_PAIRS_OF_BODIES = Lazily("centrode.cli.option_values", "read_pairs_of_bodies")
READ_RANGES = Lazily("centrode.cli.option_values", "read_ranges")
READ_BOUNDS = Lazily("centrode.cli.option_values", "read_bounds")
READ_VARIED = Lazily("centrode.cli.option_values", "read_varied")
READ_INSTANTS = Lazily("centrode.cli.option_values", "read_instants")
READ_INSTANT = Lazily("centrode.cli.option_values", "read_instant")
HAS_CURVATURE_LAW = Lazily("centrode.model.cam_files", "has_curvature_law")
NEEDS_FOLLOWER = Lazily("centrode.model.cam_files", "with_follower")
NEEDS_CURVATURE_LAW = Lazily("centrode.model.cam_files", "require_curvature_cam")

MOTION = ChoiceOption(
    "motion",
    ("mean", "real"),
    mark("Forces at the mean speed (default), or at the real speed and acceleration of a machine."),
)
WRITTEN_PAGE = mark("Write FILE.txt, FILE.tex (LaTeX) or FILE.md (Markdown) instead of printing.")

INTEGRATE = Topic(
    name="integrate",
    compute=Lazily("centrode.equations.integration", "integration_results"),
    result=Lazily("centrode.equations.integration", "IntegrationResults"),
    restore=Lazily("centrode.equations.integration", "results_of_integration"),
    view=Lazily("centrode.views.integrations", "sheet"),
    concerns=Lazily("centrode.equations.integration", "is_integrated"),
    command=Command(
        help=mark("Integrate the differential equations of a mechanism."),
        options=(
            ValueOption(
                "method",
                "rk4|adaptive",
                mark(
                    "Fixed steps of the fourth-order Runge-Kutta method, or adaptive steps of eighth order."
                ),
            ),
            ValueOption("steps", mark("N"), mark("Number of steps; the result has one row more."), int),
            ValueOption("tolerance", mark("X"), mark("Tolerance of each adaptive step."), float),
            ValueOption(
                "to",
                mark("B"),
                mark("Last value of the drive, or last time."),
                parameter="stop",
                read=READ_INSTANT,
            ),
        ),
        folder="integration",
        samples=False,
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "integration",
                mark("Integration of the equations"),
                code='ct.integrate(mechanism, method="adaptive")',
            ),
        ),
        arguments={"method": "adaptive"},
        instants=False,
        options=("rk4_steps",),
    ),
    panel=Panel(needs=mark("these equations are integrated in the plane only")),
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

REDUCTION = Topic(
    name="reduce",
    compute=Lazily("centrode.dynamics.reduction_results", "reduction_results"),
    result=Lazily("centrode.dynamics.reduction_results", "ReductionResults"),
    restore=Lazily("centrode.dynamics.reduction_results", "results_of_reduction"),
    view=Lazily("centrode.views.reduction", "sheet"),
    concerns=Lazily("centrode.dynamics.masses", "has_masses_or_loads"),
    command=Command(
        help=mark("Reduce masses and loads to the drive, with the share of each."),
        options=(RangeOptions(),),
    ),
    document=InDocuments(
        chapters=(ChapterOfTopic("reduction", mark("Reduction to the drive"), code="ct.reduce(mechanism)"),)
    ),
    panel=Panel(needs=mark("no link has a mass, and there is no load: switch Mass or Load on")),
)

FLYWHEEL = Topic(
    name="flywheel",
    compute=Lazily("centrode.dynamics.steady_motion.machine", "machine_results"),
    result=Lazily("centrode.dynamics.steady_motion.machine", "MachineResults"),
    restore=Lazily("centrode.dynamics.steady_motion.machine", "results_of_steady_motion"),
    value=Lazily("centrode.dynamics.steady_motion.flywheel", "Flywheel"),
    complete=Lazily("centrode.dynamics.steady_motion.machine", "results_of_flywheel"),
    view=Lazily("centrode.views.flywheel", "sheet"),
    concerns=Lazily("centrode.dynamics.steady_motion.machine", "is_machine"),
    command=Command(
        help=mark("Find the flywheel of a machine, and its real motion."),
        needs=Lazily("centrode.dynamics.steady_motion.flywheel", "need_fluctuation"),
        options=(
            ChoiceOption(
                "mean",
                ("middle", "time"),
                mark("Mean speed: mean of the greatest and the least (default), or average over time."),
            ),
            ChoiceOption(
                "method",
                ("exact", "first-order"),
                mark("Real velocities by the energy equation (default), or by the first-order formula."),
            ),
        ),
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("flywheel", mark("Flywheel"), code="print(ct.summary(ct.flywheel(mechanism)))"),
            ChapterOfTopic("real-motion", mark("Real motion"), code="ct.steady_motion(mechanism)"),
        ),
        may_be_left_out=True,
    ),
    panel=Panel(needs=mark("the description has no [machine] with a mean speed")),
)

SIMULATION = Topic(
    name="simulate",
    compute=Lazily("centrode.dynamics.simulation.results", "simulation_results"),
    result=Lazily("centrode.dynamics.simulation.results", "SimulationResults"),
    restore=Lazily("centrode.dynamics.simulation.results", "results_of_simulation"),
    view=Lazily("centrode.views.simulation", "sheet"),
    concerns=Lazily("centrode.dynamics.simulation.results", "has_simulation"),
    command=Command(
        help=mark("Simulate a machine under loads, friction and a motor."),
        options=(
            ValueOption("duration", mark("T"), mark('Duration of the motion: "20 s".')),
            ValueOption("turns", mark("N"), mark("Stop after this many turns of the drive."), float),
            ValueOption("driving", mark("FORMULA"), mark('Moment of the drive in t, q and v: "20 - 2*v".')),
            ValueOption("speed", mark("V"), mark('Initial speed of the drive: "65 rpm".')),
            ValueOption(
                "speed_of",
                mark("PATH=V"),
                mark('Initial speed of a part: "links.OA=10 rad/s", "points.P=1,0"; may be repeated.'),
                several=True,
                parameter="speeds",
                read=READ_SPEEDS,
            ),
            ValueOption(
                "keep",
                mark("DRIVE"),
                mark("Drive that keeps its law while the others are free; may be repeated."),
                several=True,
                parameter="keeps",
            ),
            ChoiceOption(
                "equations",
                ("reduced", "multibody"),
                mark("Reduced equation of the drive, or equations of all links, which pass dead positions."),
                has_default=False,
            ),
            ChoiceOption(
                "scheme",
                ("adaptive", "stiff", "runge-kutta-4"),
                mark("Integration scheme: adaptive (default), for stiff laws, or fixed steps."),
                has_default=False,
            ),
            ValueOption("steps", mark("N"), mark("Number of fixed steps."), int),
            ValueOption("tolerance", mark("X"), mark("Relative tolerance of the adaptive schemes."), float),
            ValueOption(
                "at",
                mark("T"),
                mark('Only at this time ("1 s"); may be repeated.'),
                several=True,
            ),
            FlagOption("motion", mark("Write the motion of all points and links too.")),
            FlagOption(
                "reactions", mark("Find the reactions in all joints too, by the equations of all links.")
            ),
        ),
        extent=Lazily("centrode.dynamics.simulation.results", "simulation_extent"),
        progress=mark("integrating, %"),
        ending=Lazily("centrode.dynamics.simulation.results", "check_ended"),
    ),
    document=InDocuments(
        chapters=(ChapterOfTopic("simulation", mark("Motion under loads"), code="ct.simulate(mechanism)"),),
        instants=False,
    ),
    panel=Panel(
        needs=mark("the description has no [simulation] with a motor or a driving moment"), free=True
    ),
)

REACTIONS = Topic(
    name="reactions",
    compute=Lazily("centrode.dynamics.bearings.results", "reaction_results"),
    result=Lazily("centrode.dynamics.bearings.results", "ReactionResults"),
    restore=Lazily("centrode.dynamics.bearings.results", "results_of_reactions"),
    view=Lazily("centrode.views.reactions", "sheet"),
    concerns=Lazily("centrode.dynamics.masses", "has_masses_or_loads"),
    command=Command(
        help=mark("Find reactions in joints and balancing moments of drives."),
        options=(
            InstantsOption(
                mark('Only at this value of the drive ("120 deg"), or time ("1 s"); may be repeated.')
            ),
            MOTION,
            ValueOption(
                "speed",
                mark("V"),
                mark('With --at: speed of the drive in its own sense ("65 rpm"); 0 at rest.'),
            ),
            ValueOption(
                "acceleration",
                mark("A"),
                mark('With --speed: acceleration of the drive in its own sense ("-2.77 rad/s^2").'),
            ),
            FlagOption("frictionless", mark("Omit Coulomb friction.")),
            RangeOptions(),
        ),
        summary=False,
        complete="complete",
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("reactions", mark("Reactions in the joints"), code="ct.reactions(mechanism)"),
        ),
        add_instants=Lazily("centrode.dynamics.bearings.results", "with_instants"),
        motion=True,
        may_be_left_out=True,
        may_be_incomplete=True,
    ),
    panel=Panel(needs=mark("no link has a mass, and there is no load: switch Mass or Load on")),
)

BALANCE = Topic(
    name="balance",
    compute=Lazily("centrode.dynamics.balancing.balance", "balance"),
    result=Lazily("centrode.dynamics.balancing.balance", "Balance"),
    view=Lazily("centrode.views.balance", "sheet"),
    concerns=Lazily("centrode.dynamics.balancing.results", "may_shake"),
    command=Command(
        help=mark("Find counterweights that balance a mechanism."),
        options=(
            ValueOption(
                "on",
                mark("LINK"),
                mark('Link for a counterweight, or "LINK@POINT" with the point its radius is measured from.'),
                several=True,
            ),
            FlagOption("full", mark("Make the shaking force zero (default).")),
            FlagOption("least_maximum", mark("Minimise the greatest forces and moments.")),
            ValueOption(
                "fraction",
                mark("F"),
                mark(
                    'Slider-crank: balance the rotating masses and this fraction of the reciprocating ones ("1/2").'
                ),
            ),
            FlagOption("moment", mark("With --full: balance the shaking moment too, by discs.")),
            ValueOption(
                "weights",
                mark("F,M,T"),
                mark("With --least-maximum: weights of force, moment and drive (1,0,0 by default)."),
            ),
            ValueOption(
                "radius",
                mark("[LINK=]LENGTH"),
                mark('Distance of the counterweight from its point ("50 mm").'),
                several=True,
            ),
            ValueOption(
                "most",
                mark("[LINK=]MASS"),
                mark('Greatest mass of a counterweight ("3 kg").'),
                several=True,
            ),
            ValueOption("thickness", mark("LENGTH"), mark("Counterweights are discs of this thickness.")),
            ValueOption("density", mark("DENSITY"), mark("Density of discs (steel by default).")),
            ValueOption(
                "about",
                mark("PLACE"),
                mark('Reference point of moments: a point of the frame, or "0.2,0.1" in metres.'),
            ),
            FlagOption("steady", mark("At the real speed of the machine, not at its mean speed.")),
        ),
        arguments=Lazily("centrode.cli.option_values", "balance_arguments"),
        dark=True,
    ),
    panel=Panel(mark("Balancing"), mark("no link has a mass: switch Mass on")),
)

SHAKING = Topic(
    name="shaking",
    compute=Lazily("centrode.dynamics.balancing.results", "shaking_results"),
    result=Lazily("centrode.dynamics.balancing.results", "ShakingResults"),
    restore=Lazily("centrode.dynamics.balancing.results", "results_of_shaking"),
    view=Lazily("centrode.views.balance", "shaking_sheet"),
    concerns=Lazily("centrode.dynamics.balancing.results", "may_shake"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("balance", mark("Shaking forces and balance"), code="ct.shaking(mechanism)"),
        ),
        instants=False,
    ),
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

FOLLOWER_MOTION = Topic(
    name="follower-motion",
    compute=Lazily("centrode.cams.followers.motion_results", "follower_motion_results"),
    result=Lazily("centrode.cams.followers.motion_results", "FollowerMotionResults"),
    restore=Lazily("centrode.cams.followers.motion_results", "results_of_follower_motion"),
    view=Lazily("centrode.views.follower_motion", "sheet"),
    concerns=Lazily("centrode.model.cam_files", "has_follower"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("data", mark("Data"), code="cam"),
            ChapterOfTopic("lift", mark("Motion of the follower"), code="ct.cam(cam)"),
        )
    ),
    subject="cam",
    panel=Panel(mark("Motion of the follower"), mark("a curvature law gives this cam: it has no lift")),
)

MOTION_LAWS = Topic(
    name="motion-laws",
    compute=Lazily("centrode.cams.followers.motion_results", "motion_law_results"),
    result=Lazily("centrode.cams.followers.motion_results", "MotionLawResults"),
    restore=Lazily("centrode.cams.followers.motion_results", "MotionLawResults"),
    view=Lazily("centrode.views.motion_laws", "sheet"),
    concerns=Lazily("centrode.cams.followers.motion_results", "has_rise"),
    document=InDocuments(chapters=(ChapterOfTopic("laws", mark("Laws of motion for one rise")),)),
    subject="cam",
    command=Command(
        help="",
        options=(FlagOption("laws", mark("Also other laws of motion for the first rise of the follower.")),),
        needs=NEEDS_FOLLOWER,
    ),
    flag="laws",
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

FORCE_POLYGONS = Topic(
    name="polygons",
    compute=Lazily("centrode.dynamics.force_polygons.results", "force_polygon_results"),
    result=Lazily("centrode.dynamics.force_polygons.results", "ForcePolygonResults"),
    value=Lazily("centrode.dynamics.force_polygons.polygons", "ForcePolygons"),
    complete=Lazily("centrode.dynamics.force_polygons.results", "results_of_force_polygons"),
    view=Lazily("centrode.views.force_polygons", "sheet"),
    concerns=Lazily("centrode.dynamics.force_polygons.results", "has_force_polygons"),
    command=Command(
        help=mark("Find reactions and the balancing moment by force polygons."),
        options=(
            InstantsOption(
                mark(
                    'Value of the drive ("pi/2 rad"), or time; by default the instants of the study, or else the start.'
                )
            ),
            ValueOption(
                "paper", mark("SIZE"), mark("Sheet for which scales are chosen: A5, A4 (default) or A3.")
            ),
            MOTION,
        ),
        samples=False,
        default_instants=True,
        folder="polygons",
        dark=True,
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "force-polygons",
                mark("Force polygons"),
                code=(
                    "for at in instants:\n"
                    "    for figure in ct.figures(ct.force_polygons(mechanism, at=at)).values():\n"
                    "        display(figure)"
                ),
            ),
        ),
        # drawings on a sheet of this size fit between the margins of a page
        arguments={"paper": "A5", "complete": False},
        motion=True,
    ),
    panel=Panel(needs=mark("no link has a mass, and there is no load: switch Mass or Load on")),
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

CHECK = Topic(
    name="check",
    compute=Lazily("centrode.kinematics.check", "check"),
    result=Lazily("centrode.kinematics.check", "MechanismCheck"),
    view=Lazily("centrode.views.structure", "sheet"),
    command=Command(
        help=mark("Check a mechanism: mobility, loops, groups, order of solution."),
        samples=False,
        prints_only=True,
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("data", mark("Data"), code="mechanism"),
            ChapterOfTopic("structure", mark("Structure"), code="ct.check(mechanism)"),
        ),
        instants=False,
    ),
    panel=Panel(mark("Structure")),
)

CHAIN = Topic(
    name="kinematic-chain",
    compute=Lazily("centrode.chains.identification", "chain_of"),
    result=Lazily("centrode.chains.identification", "ChainOfMechanism"),
    view=Lazily("centrode.views.chains", "sheet"),
)

SWEEP = Topic(
    name="sweep",
    compute=Lazily("centrode.sweeps.sweep", "sweep_results"),
    result=Lazily("centrode.sweeps.sweep", "SweepResults"),
    view=Lazily("centrode.views.sweeps", "sheet"),
    subject="mechanisms",
    restore=Lazily("centrode.sweeps.sweep", "SweepResults"),
)

PARAMETER_STUDY = Topic(
    name="parameter-study",
    compute=Lazily("centrode.sweeps.parameter_studies", "parameter_study"),
    result=Lazily("centrode.sweeps.parameter_studies", "ParameterStudy"),
    view=Lazily("centrode.views.parameter_studies", "sheet"),
    subject="mechanisms",
    restore=Lazily("centrode.sweeps.parameter_studies", "ParameterStudy"),
)

VARIANTS = Topic(
    name="variants",
    compute=Lazily("centrode.assignments.results", "variants"),
    result=Lazily("centrode.assignments.results", "Variants"),
    view=Lazily("centrode.views.variants", "sheet"),
    subject="mechanisms",
)

EQUATIONS = Topic(
    name="equations",
    compute=Lazily("centrode.equations.instants", "equation_results"),
    result=Lazily("centrode.equations.derivation", "Equations"),
    view=Lazily("centrode.views.equations", "sheet"),
    command=Command(
        help=mark("Write the constraint equations in symbols and solve them."),
        options=(
            ValueOption(
                "point",
                mark("NAME"),
                mark(
                    "A point whose velocity is given; may be repeated; points on guides of the frame by default."
                ),
                several=True,
                parameter="points",
            ),
        ),
        pages=("txt", "tex", "md"),
        file_help=WRITTEN_PAGE,
        samples=False,
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "equations",
                mark("Constraint equations"),
                code="equations = ct.equations(mechanism)\nequations",
            ),
            ChapterOfTopic(
                "derivation",
                mark("Velocities and accelerations"),
                code=(
                    "at_instants = ct.motion(mechanism, at=instants)\n"
                    'at_instants[["angle", "angular_velocity", "angular_acceleration"]].to_dataframe()'
                ),
            ),
        ),
        points=True,
        may_be_left_out=True,
        may_be_incomplete=True,
    ),
)

DESCRIBE = Topic(
    name="describe",
    compute=Lazily("centrode.analysis.operation", "principle_of_operation"),
    result=Lazily("centrode.analysis.operation", "PrincipleOfOperation"),
    view=Lazily("centrode.views.words", "sheet"),
    command=Command(
        help=mark("Describe in words how a mechanism works."),
        pages=("txt", "tex", "md"),
        file_help=WRITTEN_PAGE,
        samples=False,
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("words", mark("How it works"), code="ct.principle_of_operation(mechanism)"),
        ),
        instants=False,
    ),
)

GIVEN_MASSES = Topic(
    name="masses",
    compute=Lazily("centrode.dynamics.masses", "link_masses"),
    result=Lazily("centrode.dynamics.masses", "LinkMasses"),
    view=Lazily("centrode.views.masses_and_loads", "sheet"),
    concerns=Lazily("centrode.dynamics.masses", "has_masses_or_loads"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "masses-and-loads",
                mark("Masses and loads"),
                code="{name: link.mass for name, link in mechanism.links.items()}",
            ),
        ),
        instants=False,
    ),
)

BASE_RADIUS = Topic(
    name="base-radius",
    compute=Lazily("centrode.cams.followers.base_radius_results", "choose_base_radius"),
    result=Lazily("centrode.cams.followers.base_radius_results", "BaseRadiusResults"),
    view=Lazily("centrode.views.base_radius", "sheet"),
    concerns=Lazily("centrode.cams.followers.base_circle", "has_size"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "base-radius", mark("Choice of the base radius"), code="ct.choose_base_radius(cam)"
            ),
        )
    ),
    subject="cam",
    panel=Panel(mark("Choice of the base radius"), mark("the cam has no size to choose")),
)

FOLLOWER_PROFILE = Topic(
    name="follower-profile",
    compute=Lazily("centrode.cams.followers.profile_results", "follower_profile_results"),
    result=Lazily("centrode.cams.followers.profile_results", "FollowerProfileResults"),
    restore=Lazily("centrode.cams.followers.profile_results", "results_of_follower_profile"),
    value=Lazily("centrode.cams.followers.geometry", "FollowerCam"),
    complete=Lazily("centrode.cams.followers.profile_results", "results_of_follower_cam"),
    view=Lazily("centrode.views.follower_profile", "sheet"),
    concerns=Lazily("centrode.cams.followers.base_circle", "has_profile"),
    command=Command(
        help="",
        needs=NEEDS_FOLLOWER,
        animation=Lazily("centrode.animation.cams", "animate_body_of"),
        animation_file="cam.gif",
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("motion", mark("Motion")),
            ChapterOfTopic("profile", mark("Profile of the cam"), code="ct.cam_profile(cam)"),
        )
    ),
    subject="cam",
    panel=Panel(mark("Profile of the cam"), mark("the cam has no size yet: its base radius is missing")),
)

ROLLER_PATH = Topic(
    name="roller-path",
    compute=Lazily("centrode.cams.cam", "roller_path_results"),
    result=Lazily("centrode.cams.cam", "RollerPathResults"),
    restore=Lazily("centrode.cams.cam", "results_of_roller_path"),
    view=Lazily("centrode.views.roller_path", "sheet"),
    concerns=HAS_CURVATURE_LAW,
    document=InDocuments(
        chapters=(
            ChapterOfTopic("data", mark("Data"), code="cam"),
            ChapterOfTopic("path", mark("Path of the roller's centre"), code="ct.cam(cam)"),
        ),
        instants=False,
    ),
    subject="cam",
    panel=Panel(
        mark("Path of the roller's centre"), mark("a follower gives this cam: it has no curvature law")
    ),
)

PATH_ROUTES = Topic(
    name="path-routes",
    compute=Lazily("centrode.cams.cam", "path_routes_results"),
    result=Lazily("centrode.cams.cam", "PathRoutesResults"),
    restore=Lazily("centrode.cams.cam", "results_of_path_routes"),
    view=Lazily("centrode.views.path_routes", "sheet"),
    concerns=HAS_CURVATURE_LAW,
    command=Command(
        help="",
        options=(
            ValueOption(
                "terms",
                mark("N"),
                mark(
                    "Truncate the power series after a_N; by default the number of the description, or else 20."
                ),
                int,
            ),
        ),
        needs=NEEDS_CURVATURE_LAW,
    ),
    document=InDocuments(chapters=(ChapterOfTopic("routes", mark("Three routes to the path")),)),
    subject="cam",
    panel=Panel(needs=mark("a follower gives this cam: it has no curvature law")),
)

CAM_SERIES = Topic(
    name="cam-series",
    compute=Lazily("centrode.cams.series", "cam_series_results"),
    result=Lazily("centrode.cams.series", "CamSeriesResults"),
    restore=Lazily("centrode.cams.series", "CamSeriesResults"),
    view=Lazily("centrode.views.cam_series", "sheet"),
    concerns=HAS_CURVATURE_LAW,
    command=Command(
        help="",
        options=(FlagOption("series", mark("Also the coefficients of the power series of the path.")),),
        needs=NEEDS_CURVATURE_LAW,
    ),
    flag="series",
    document=InDocuments(
        chapters=(ChapterOfTopic("series", mark("Power series of the path"), code="ct.cam_series(cam)"),),
        instants=False,
    ),
    subject="cam",
)

FOLLOWER_FORCES = Topic(
    name="follower-forces",
    compute=Lazily("centrode.cams.followers.force_results", "follower_force_results"),
    result=Lazily("centrode.cams.followers.force_results", "FollowerForceResults"),
    restore=Lazily("centrode.cams.followers.force_results", "results_of_cam_forces"),
    view=Lazily("centrode.views.follower_forces", "sheet"),
    concerns=Lazily("centrode.cams.followers.force_results", "has_forces"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "cam-forces", mark("Forces on the cam and the follower"), code="ct.cam_forces(cam)"
            ),
        )
    ),
    subject="cam",
    panel=Panel(mark("Forces on the cam and the follower"), mark("the follower has no mass, spring or load")),
)

CAM_PROFILE = Topic(
    name="cam-profile",
    compute=Lazily("centrode.cams.results", "cam_profile_results"),
    result=Lazily("centrode.cams.results", "CamProfileResults"),
    restore=Lazily("centrode.cams.results", "results_of_cam_profile"),
    view=Lazily("centrode.views.cam_profile", "sheet"),
    concerns=Lazily("centrode.cams.results", "has_roller"),
    command=Command(
        help="",
        options=(FlagOption("groove", mark("Also the outer wall of a groove that the roller runs in.")),),
        needs=NEEDS_CURVATURE_LAW,
        animation=Lazily("centrode.animation.cams", "animate_body_of"),
        animation_file="cam.gif",
    ),
    document=InDocuments(
        chapters=(ChapterOfTopic("profile", mark("Profile of the cam"), code="ct.cam_profile(cam)"),),
        instants=False,
    ),
    subject="cam",
    panel=Panel(needs=mark("a follower gives this cam: it has no curvature law")),
)

WALKING_WHEEL = Topic(
    name="walking-wheel",
    compute=Lazily("centrode.cams.results", "walking_wheel_results"),
    result=Lazily("centrode.cams.results", "WalkingWheelResults"),
    restore=Lazily("centrode.cams.results", "results_of_walking_wheel"),
    value=Lazily("centrode.cams.walking_wheel", "WheelMover"),
    complete=Lazily("centrode.cams.results", "results_of_wheel"),
    view=Lazily("centrode.views.walking_wheel", "sheet"),
    concerns=Lazily("centrode.cams.results", "has_mover"),
    command=Command(
        help="",
        needs=NEEDS_CURVATURE_LAW,
        animation=Lazily("centrode.animation.cams", "animate_body_of"),
        animation_file="walking-wheel.gif",
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("motion", mark("Motion")),
            ChapterOfTopic("walking", mark("Walking wheel"), code="print(ct.summary(ct.walking_wheel(cam)))"),
        )
    ),
    subject="cam",
    panel=Panel(mark("Walking wheel"), mark("the cam has no mover")),
)

CAM_CONTACT = Topic(
    name="cam-contact",
    compute=Lazily("centrode.cams.results", "cam_contact_results"),
    result=Lazily("centrode.cams.results", "CamContactResults"),
    restore=Lazily("centrode.cams.results", "CamContactResults"),
    view=Lazily("centrode.views.cam_contact", "sheet"),
    concerns=Lazily("centrode.cams.results", "has_contact"),
    document=InDocuments(
        chapters=(ChapterOfTopic("contact", mark("Contact of roller and cam"), code="ct.cam_contact(cam)"),),
        instants=False,
    ),
    subject="cam",
    panel=Panel(mark("Contact of roller and cam"), mark("the cam has no materials in contact")),
)

CAM_CHOICE = Topic(
    name="cam-choice",
    compute=Lazily("centrode.cams.parameter_choice.search", "choose_cam"),
    result=Lazily("centrode.cams.parameter_choice.search", "CamChoice"),
    view=Lazily("centrode.views.cam_choice", "sheet"),
    concerns=Lazily("centrode.cams.parameter_choice.search", "has_choice"),
    # the front of best designs takes longer than all the rest
    command=Command(help="", samples=False, complete="front"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("choice", mark("Chosen parameters"), code="ct.choose_cam(cam, front=False)"),
        ),
        arguments={"front": False},
        chosen_arguments={"front": True},
        instants=False,
    ),
    subject="cam",
    panel=Panel(needs=mark("the cam has nothing to choose"), arguments={"front": False}),
)

GEAR_PAIR = Topic(
    name="gear-pair",
    compute=Lazily("centrode.gears.results", "gear_pair"),
    result=Lazily("centrode.gears.results", "GearPairResults"),
    view=Lazily("centrode.views.gear_pair", "sheet"),
    subject="gear pair",
)

TOLERANCES = Topic(
    name="tolerances",
    compute=Lazily("centrode.tolerances.results", "tolerance_results"),
    result=Lazily("centrode.tolerances.results", "ToleranceResults"),
    view=Lazily("centrode.views.tolerances", "sheet"),
    concerns=Lazily("centrode.tolerances.results", "has_tolerances"),
    command=Command(
        help=mark("Find how far outputs deviate by tolerances and play."),
        needs=Lazily("centrode.tolerances.results", "need_tolerances"),
        options=(
            ValueOption(
                "output",
                mark("OUTPUT"),
                mark('What deviates: "position.B.x", "range(slide_B)"; may be repeated.'),
                several=True,
                parameter="outputs",
            ),
            ValueOption("draws", mark("N"), mark("Mechanisms that are drawn (10000 by default)."), int),
            ValueOption("seed", mark("N"), mark("The same seed draws the same mechanisms."), int),
        ),
        dark=True,
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "accuracy",
                mark("Accuracy of the mechanism"),
                code="print(ct.summary(ct.tolerances(mechanism)))",
            ),
        ),
        instants=False,
        may_be_left_out=True,
    ),
    panel=Panel(needs=mark("the description has no [tolerances] with limits")),
)

SENSITIVITY = Topic(
    name="sensitivity",
    compute=Lazily("centrode.tolerances.sensitivity", "sensitivity_results"),
    result=Lazily("centrode.tolerances.sensitivity", "SensitivityResults"),
    restore=Lazily("centrode.tolerances.sensitivity", "SensitivityResults"),
    view=Lazily("centrode.views.sensitivity", "sheet"),
    subject="mechanisms",
)

CAM_SENSITIVITY = Topic(
    name="cam-sensitivity",
    compute=Lazily("centrode.tolerances.sensitivity", "cam_sensitivity_results"),
    result=Lazily("centrode.tolerances.sensitivity", "CamSensitivityResults"),
    restore=Lazily("centrode.tolerances.sensitivity", "CamSensitivityResults"),
    view=Lazily("centrode.views.sensitivity", "cam_sheet"),
    concerns=Lazily("centrode.cams.followers.base_circle", "has_profile"),
    subject="cam",
)

ALLOCATION = Topic(
    name="allocation",
    compute=Lazily("centrode.tolerances.allocation", "allocate_tolerances"),
    result=Lazily("centrode.tolerances.allocation", "Allocation"),
    view=Lazily("centrode.views.allocation", "sheet"),
    subject="mechanisms",
)

SYNTHESIS = Topic(
    name="synthesis",
    compute=Lazily("centrode.synthesis.synthesise", "synthesise"),
    result=Lazily("centrode.synthesis.answers", "SynthesisResults"),
    view=Lazily("centrode.views.synthesis", "sheet"),
    subject="synthesis",
)

IMPROVEMENT = Topic(
    name="improve",
    compute=Lazily("centrode.synthesis.improvement", "improve"),
    result=Lazily("centrode.synthesis.improvement", "Improvement"),
    view=Lazily("centrode.views.improvement", "sheet"),
    command=Command(
        help=mark("Change dimensions until a number of the motion is least."),
        options=(
            ValueOption(
                "objective",
                mark("MEASURE"),
                mark("What is reduced, as stroke(slide_H), reaction(B/AB) or a formula of the motion."),
                required=True,
            ),
            ValueOption(
                "free",
                mark("PATH=FIRST:LAST"),
                mark('Dimension with its range, as "links.AB.length=3.4 m:3.6 m"; repeatable.'),
                several=True,
                required=True,
                read=READ_RANGES,
            ),
            ValueOption(
                "keep",
                mark("MEASURE=FIRST:LAST"),
                mark('Number kept within bounds, as "stroke(slide_H)=1.5 m:"; repeatable.'),
                several=True,
                parameter="constraints",
                read=READ_BOUNDS,
            ),
            ChoiceOption(
                "aim", ("least", "greatest"), mark("Whether the objective becomes least or greatest.")
            ),
        ),
        progress=mark("searching"),
        pictures=False,
    ),
)

GEAR_TRAIN = Topic(
    name="gear-train",
    compute=Lazily("centrode.gears.train_results", "gear_train"),
    result=Lazily("centrode.gears.train_results", "GearTrainResults"),
    view=Lazily("centrode.views.gear_train", "sheet"),
    subject="gear train",
)

TOPICS: tuple[Topic, ...] = (
    INTEGRATE,
    LIMITS,
    REGION,
    ANGLES,
    CENTRES,
    CENTRODES,
    REDUCTION,
    FLYWHEEL,
    SIMULATION,
    REACTIONS,
    BALANCE,
    SHAKING,
    FOLLOWER_MOTION,
    MOTION_LAWS,
    GEAR_PAIR,
    SYNTHESIS,
    IMPROVEMENT,
    GEAR_TRAIN,
    ROTATABILITY,
    REPAIR,
    FORCE_POLYGONS,
    PLAN,
    DIAGRAMS,
    RUN,
    CHECK,
    CHAIN,
    SWEEP,
    PARAMETER_STUDY,
    VARIANTS,
    GIVEN_MASSES,
    DESCRIBE,
    BASE_RADIUS,
    FOLLOWER_PROFILE,
    ROLLER_PATH,
    PATH_ROUTES,
    CAM_SERIES,
    CAM_PROFILE,
    WALKING_WHEEL,
    CAM_CONTACT,
    CAM_CHOICE,
    FOLLOWER_FORCES,
    TOLERANCES,
    SENSITIVITY,
    CAM_SENSITIVITY,
    ALLOCATION,
    EQUATIONS,
)
"""Every topic."""
