"""Topics of equations."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.option_values import READ_INSTANT, WRITTEN_PAGE
from centrode.topics.topic import ChapterOfTopic, Command, InDocuments, Lazily, Panel, Topic, ValueOption

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
