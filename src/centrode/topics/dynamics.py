"""Topics of masses, forces and machines."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.option_values import MOTION, READ_PAIRS, READ_SPEEDS, READ_VARIED
from centrode.topics.topic import (
    ChapterOfTopic,
    ChoiceOption,
    Command,
    FlagOption,
    InDocuments,
    InstantsOption,
    Lazily,
    Panel,
    RangeOptions,
    Topic,
    ValueOption,
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
        needs=mark("the description has no [simulation] with a motor or a driving moment"),
        played={"motion": True, "at_events": True},
        free=True,
    ),
)

EQUILIBRIUM = Topic(
    name="equilibrium",
    compute=Lazily("centrode.dynamics.equilibria.equilibrium", "equilibrium_results"),
    result=Lazily("centrode.dynamics.equilibria.equilibrium", "EquilibriumResults"),
    restore=Lazily("centrode.dynamics.equilibria.equilibrium", "results_of_equilibrium"),
    view=Lazily("centrode.views.equilibrium", "sheet"),
    concerns=Lazily("centrode.dynamics.equilibria.equilibrium", "has_loads_to_rest"),
    command=Command(
        help=mark("Find the equilibria of a mechanism under its loads."),
        options=(
            ValueOption(
                "hold",
                mark("DRIVE=VALUE"),
                mark('Drive that is held at a value ("OA=30 deg"); may be repeated.'),
                several=True,
                read=READ_PAIRS,
            ),
            ValueOption(
                "vary",
                mark("PATH=LOW:HIGH"),
                mark("Follow the equilibria along a number and find its critical values."),
                several=True,
                read=READ_VARIED,
            ),
        ),
        samples=False,
        progress=mark("seeking equilibria, %"),
    ),
    document=InDocuments(
        chapters=(ChapterOfTopic("equilibria", mark("Equilibria"), code="ct.equilibrium(mechanism)"),),
        instants=False,
        may_be_left_out=True,
        on_request=True,
    ),
    panel=Panel(needs=mark("there is no load and no weight: switch Mass or Load on"), free=True),
)

MODES = Topic(
    name="modes",
    compute=Lazily("centrode.dynamics.equilibria.modes", "modes_results"),
    result=Lazily("centrode.dynamics.equilibria.modes", "ModesResults"),
    restore=Lazily("centrode.dynamics.equilibria.modes", "results_of_modes"),
    view=Lazily("centrode.views.modes", "sheet"),
    concerns=Lazily("centrode.dynamics.equilibria.modes", "has_masses_at_rest"),
    command=Command(
        help=mark("Find natural frequencies, damping and mode shapes."),
        options=(
            ValueOption(
                "equilibrium",
                mark("N"),
                mark("Number of the equilibrium, as centrode equilibrium counts them."),
                int,
            ),
            ValueOption(
                "hold",
                mark("DRIVE=VALUE"),
                mark('Drive that is held at a value ("OA=30 deg"); may be repeated.'),
                several=True,
                read=READ_PAIRS,
            ),
            ValueOption(
                "speed",
                mark("DRIVE=V"),
                mark('Modes about the steady rotation of a drive ("OA=65 rpm").'),
                several=True,
                read=READ_PAIRS,
            ),
        ),
        samples=False,
        animation=Lazily("centrode.animation.animate", "animate_modes"),
        animation_file="mode-1.gif",
        animation_help=mark("Also write an animation of every mode."),
    ),
    document=InDocuments(
        chapters=(ChapterOfTopic("modes", mark("Natural oscillations"), code="ct.modes(mechanism)"),),
        instants=False,
        may_be_left_out=True,
        on_request=True,
    ),
    panel=Panel(needs=mark("modes need masses and loads: switch Mass on"), free=True),
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
                mark('Speed of the drive at the given instants, in its own sense ("65 rpm"); 0 at rest.'),
            ),
            ValueOption(
                "acceleration",
                mark("A"),
                mark('Acceleration of the drive at that speed, in its own sense ("-2.77 rad/s^2").'),
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
            FlagOption(
                "moment", mark("With a shaking force of zero: balance the shaking moment too, by discs.")
            ),
            ValueOption(
                "weights",
                mark("F,M,T"),
                mark("Weights of force, moment and drive in what is minimised (1,0,0 by default)."),
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
