"""Topics of many mechanisms: sweeps, variants, tolerances, syntheses."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.option_values import READ_BOUNDS, READ_RANGES
from centrode.topics.topic import (
    ChapterOfTopic,
    ChoiceOption,
    Command,
    InDocuments,
    Lazily,
    Panel,
    Topic,
    ValueOption,
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

GEAR_VARIANTS = Topic(
    name="gear-variants",
    compute=Lazily("centrode.assignments.gear_variants", "gear_variants"),
    result=Lazily("centrode.assignments.gear_variants", "GearVariants"),
    view=Lazily("centrode.views.gear_variants", "sheet"),
    subject="mechanisms",
)

TOLERANCES = Topic(
    name="tolerances",
    compute=Lazily("centrode.tolerances.results", "tolerance_results"),
    result=Lazily("centrode.tolerances.results", "ToleranceResults"),
    view=Lazily("centrode.views.tolerances", "sheet"),
    concerns=Lazily("centrode.model.mechanism", "has_tolerances"),
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
    subject="request",
    document=InDocuments(
        chapters=(ChapterOfTopic("synthesis", mark("Synthesis of the mechanism")),), instants=False
    ),
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
