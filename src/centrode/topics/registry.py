"""Every topic, in the order of the commands and the chapters."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import (
    ChapterOfTopic,
    Choice,
    Flag,
    InstantsOption,
    Lazily,
    MotionRange,
    Topic,
    Written,
)

FLYWHEEL = Topic(
    name="flywheel",
    help=mark("Find the flywheel of a machine, and its real motion."),
    compute=Lazily("centrode.dynamics.steady_motion.machine", "machine_results"),
    result=Lazily("centrode.dynamics.steady_motion.machine", "MachineResults"),
    view=Lazily("centrode.views.flywheel", "sheet"),
    concerns=Lazily("centrode.dynamics.steady_motion.machine", "is_machine"),
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

REDUCTION = Topic(
    name="reduce",
    help=mark("Reduce masses and loads to the drive, part by part."),
    compute=Lazily("centrode.dynamics.reduction_results", "reduction_results"),
    result=Lazily("centrode.dynamics.reduction_results", "ReductionResults"),
    view=Lazily("centrode.views.reduction", "sheet"),
    concerns=Lazily("centrode.dynamics.masses", "has_masses_or_loads"),
    options=(MotionRange(),),
    chapters=(ChapterOfTopic("reduction", mark("Reduction to the drive"), after="masses-and-loads"),),
    ending=Lazily("centrode.study.limiting", "check_reached"),
    after="rotatability",
)

SIMULATION = Topic(
    name="simulate",
    help=mark("Let a machine run: loads, friction and a motor move it."),
    compute=Lazily("centrode.dynamics.simulation.results", "simulation_results"),
    result=Lazily("centrode.dynamics.simulation.results", "SimulationResults"),
    view=Lazily("centrode.views.simulation", "sheet"),
    concerns=Lazily("centrode.dynamics.simulation.results", "has_simulation"),
    options=(
        Written("duration", mark("T"), mark('How long it runs: "20 s".')),
        Written("turns", mark("N"), mark("End after so many turns of the drive."), float),
        Written("driving", mark("FORMULA"), mark('Moment of the drive in t, q and v: "20 - 2*v".')),
        Written("speed", mark("V"), mark('Speed of the drive at the start: "65 rpm".')),
        Choice(
            "scheme",
            ("adaptive", "stiff", "runge-kutta-4"),
            mark("How to integrate: adaptive (the rule), for stiff laws, or fixed steps."),
            has_rule=False,
        ),
        Written("steps", mark("N"), mark("Number of fixed steps."), int),
        Flag("motion", mark("Write the motion of all points and links too.")),
    ),
    chapters=(ChapterOfTopic("simulation", mark("Motion under loads")),),
    extent=Lazily("centrode.dynamics.simulation.results", "simulation_extent"),
    progress=mark("integrating, %"),
    ending=Lazily("centrode.dynamics.simulation.results", "check_ended"),
    has_instants=False,
)

REACTIONS = Topic(
    name="reactions",
    help=mark("Find the forces in every joint and what the drives must give."),
    compute=Lazily("centrode.dynamics.bearings.results", "reaction_results"),
    result=Lazily("centrode.dynamics.bearings.results", "ReactionResults"),
    view=Lazily("centrode.views.reactions", "sheet"),
    concerns=Lazily("centrode.dynamics.masses", "has_masses_or_loads"),
    options=(
        InstantsOption(
            mark('Only at this value of the drive ("120 deg"), or time ("1 s"); as often as needed.')
        ),
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

BALANCE = Topic(
    name="balance",
    help=mark("Find counterweights that balance a mechanism."),
    compute=Lazily("centrode.dynamics.balancing.balance", "balance"),
    result=Lazily("centrode.dynamics.balancing.balance", "Balance"),
    view=Lazily("centrode.views.balance", "sheet"),
    concerns=Lazily("centrode.dynamics.balancing.results", "may_shake"),
    options=(
        Written(
            "on",
            mark("LINK"),
            mark('Link for a counterweight, or "LINK@POINT" with the point its radius is measured from.'),
            several=True,
        ),
        Flag("full", mark("Make the shaking force zero (the rule).")),
        Flag("least_maximum", mark("Make the greatest effects as small as they can be.")),
        Written(
            "fraction",
            mark("F"),
            mark('Slider-crank: balance what turns, and this much of what moves to and fro ("1/2").'),
        ),
        Flag("moment", mark("With --full: balance the shaking moment too, by discs.")),
        Written(
            "weights",
            mark("F,M,T"),
            mark("With --least-maximum: weights of force, moment and drive (1,0,0 if left out)."),
        ),
        Written(
            "radius",
            mark("[LINK=]LENGTH"),
            mark('Distance of the counterweight from its point ("50 mm").'),
            several=True,
        ),
        Written(
            "most",
            mark("[LINK=]MASS"),
            mark('Greatest mass of a counterweight ("3 kg").'),
            several=True,
        ),
        Written("thickness", mark("LENGTH"), mark("Counterweights are discs of this thickness.")),
        Written("density", mark("DENSITY"), mark("Density of discs (steel if left out).")),
        Written(
            "about",
            mark("PLACE"),
            mark('What moments are taken about: a point of the frame, or "0.2,0.1" in metres.'),
        ),
        Flag("steady", mark("At the real speed of the machine, not at its mean speed.")),
    ),
    arguments=Lazily("centrode.cli.balance_options", "balance_arguments"),
    dark=True,
    after="simulate",
)
SHAKING = Topic(
    name="shaking",
    help="",
    compute=Lazily("centrode.dynamics.balancing.results", "shaking_results"),
    result=Lazily("centrode.dynamics.balancing.results", "ShakingResults"),
    view=Lazily("centrode.views.balance", "shaking_sheet"),
    concerns=Lazily("centrode.dynamics.balancing.results", "may_shake"),
    chapters=(ChapterOfTopic("balance", mark("Shaking forces and balance"), after="force-polygons"),),
    has_command=False,
    has_instants=False,
)

TOPICS: tuple[Topic, ...] = (REDUCTION, FLYWHEEL, SIMULATION, REACTIONS, BALANCE, SHAKING)
"""Every topic."""
