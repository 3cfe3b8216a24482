"""`cogmap` with a cheap experiment of its own, which leaves a line in a diary whenever it is begun."""

import os
import time
from pathlib import Path

import numpy as np

from arena import Brownian, Camera
from cogmap.cli import main
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import experiment
from cogmap.experiments.result import Result

DIARY, SECONDS = Path(os.environ["DIARY"]), float(os.environ.get("SECONDS", "0.1"))


@experiment(room="furnished", views=200, takes=("nose", "map"))
def cheap(conditions: Conditions) -> Result:
    """Take a small walk and sleep a little."""
    with DIARY.open("a", encoding="utf-8") as diary:
        diary.write(f"{conditions.nose.noise} {conditions.map['charts']} {conditions.seed}\n")
    walk = conditions.explore(Brownian(), Camera.panoramic(16, 4), views=300)
    time.sleep(SECONDS)
    if conditions.map["charts"] == 13:
        raise RuntimeError("bad luck")
    smell = float(np.log(walk.odours).std())
    seen = int(np.asarray(walk.views).sum())
    return Result({"smell": smell * conditions.map["charts"], "seen": seen, "trusted": conditions.seed < 2})


if __name__ == "__main__":
    main()
