"""Topics of gears: pairs and trains."""

from __future__ import annotations

from centrode.topics.topic import Lazily, Topic

GEAR_PAIR = Topic(
    name="gear-pair",
    compute=Lazily("centrode.gears.results", "gear_pair"),
    result=Lazily("centrode.gears.results", "GearPairResults"),
    view=Lazily("centrode.views.gear_pair", "sheet"),
    subject="gear pair",
)

GEAR_TRAIN = Topic(
    name="gear-train",
    compute=Lazily("centrode.gears.train_results", "gear_train"),
    result=Lazily("centrode.gears.train_results", "GearTrainResults"),
    view=Lazily("centrode.views.gear_train", "sheet"),
    subject="gear train",
)
