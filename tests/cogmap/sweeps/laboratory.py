"""A cheap experiment, which leaves a line in a diary whenever it is begun."""

import os
import time
from pathlib import Path

import numpy as np

from arena import Brownian, Camera
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import experiment
from cogmap.experiments.result import Result

os.fsync = lambda _: None  # slow, and a kill cuts no power


@experiment(room="furnished", views=200, takes=("nose", "map"))
def cheap(conditions: Conditions) -> Result:
    """Take a small walk and sleep a little."""
    with Path(os.environ["DIARY"]).open("a", encoding="utf-8") as diary:
        diary.write(f"{conditions.nose.noise} {conditions.map['charts']} {conditions.seed}\n")
    walk = conditions.explore(Brownian(), Camera.panoramic(16, 4), views=300)
    time.sleep(float(os.environ["SECONDS"]))
    if conditions.map["charts"] == 13:
        raise RuntimeError("bad luck")
    smell = float(np.log(walk.odours).std())
    seen = int(np.asarray(walk.views).sum())
    return Result({"smell": smell * conditions.map["charts"], "seen": seen, "trusted": conditions.seed < 2})
