"""Topics of gears: pairs and trains."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import ChapterOfTopic, InDocuments, Lazily, Topic

GEAR_PAIR = Topic(
    name="gear-pair",
    compute=Lazily("centrode.gears.results", "gear_pair"),
    result=Lazily("centrode.gears.results", "GearPairResults"),
    view=Lazily("centrode.views.gear_pair", "sheet"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("data", mark("Data"), code="pair"),
            ChapterOfTopic(
                "gear-geometry", mark("Geometry of the pair"), code="print(ct.summary(ct.gear_pair(pair)))"
            ),
            ChapterOfTopic("gear-contact", mark("Contact and sliding")),
            ChapterOfTopic("blocking-contour", mark("Blocking contour")),
            ChapterOfTopic("gear-teeth", mark("Teeth in mesh and their generation")),
        ),
        instants=False,
    ),
    subject="gear pair",
)

GEAR_TRAIN = Topic(
    name="gear-train",
    compute=Lazily("centrode.gears.train_results", "gear_train"),
    result=Lazily("centrode.gears.train_results", "GearTrainResults"),
    view=Lazily("centrode.views.gear_train", "sheet"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("data", mark("Data"), code="train"),
            ChapterOfTopic(
                "train-choice",
                mark("Choice of the numbers of teeth"),
                code="print(ct.summary(ct.gear_train(train)))",
            ),
            ChapterOfTopic("train-conditions", mark("Ratio, conditions and efficiency")),
            ChapterOfTopic("train-motion", mark("Velocities of the train")),
        ),
        instants=False,
    ),
    subject="gear train",
)
