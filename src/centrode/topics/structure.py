"""Topics of structure and operation, without a motion."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.option_values import WRITTEN_PAGE
from centrode.topics.topic import ChapterOfTopic, Command, InDocuments, Lazily, Panel, Topic

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
