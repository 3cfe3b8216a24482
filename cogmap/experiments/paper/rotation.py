"""Rotation on the spot: the images lie on a ring, and a small network reads the heading off it."""

from __future__ import annotations

import warnings
from functools import partial

import numpy as np
import pandas as pd
from jaxtyping import Float
from sklearn.exceptions import ConvergenceWarning
from sklearn.neural_network import MLPRegressor
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler

from arena import Camera, Rotation
from arena.angles import wrap_angle
from cogmap.evaluation.quasi_metric import quasi_metric
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.paper.view_manifold import view_manifold
from cogmap.plots import plot_barcodes, plot_compass, plot_embedding, plot_quasi_metric, plot_views
from cogmap.threads import one_thread


@experiment(room="furnished", views=5_000)
def rotation(conditions: Conditions) -> Result:
    """Fig. 1 and Table 2: spin, find the ring, and predict the heading from coordinates on the manifold."""
    walk = conditions.explore(Rotation(), Camera.perspective())
    poses = walk.require("poses")
    found = view_manifold(walk.views, conditions)
    fit = predict_headings(found.embedding, poses[:, 2], conditions.seed)
    test = fit[fit["split"] == "test"]
    near = quasi_metric(found.graph, poses, conditions.seed)
    shown = np.linspace(0, len(walk) - 1, 12).astype(int)
    return Result(
        metrics={
            **{f"{split}_correlation": correlation(part) for split, part in fit.groupby("split")},
            "median_error_deg": float(np.degrees(test["error_rad"].abs().median())),
            **found.metrics(poses),
            **near.metrics,
        },
        tables={"views": found.table(poses), "predictions": fit, "distances": near.pairs},
        figures={
            "views": plot_views(np.asarray(walk[shown].views), poses[shown], 4, panoramic=False),
            "ring": plot_embedding(found.embedding, poses[:, 2], coordinates=(0, 1)),
            "prediction": plot_compass(
                (test["heading_rad"] + test["error_rad"]).to_numpy(), test["heading_rad"].to_numpy()
            ),
            "distances": plot_quasi_metric(near.pairs, near.places),
            "barcodes": plot_barcodes({"images of a spin": found.shape}),
        },
        captions={
            "ring": "The first two coordinates of the views of a spin, coloured by heading",
            "prediction": "Heading predicted by a small network against the true one",
        },
    )


def predict_headings(
    coordinates: Float[np.ndarray, "views components"],
    headings: Float[np.ndarray, "views"],
    seed: int,
    *,
    most: int = 1800,
    decays: tuple[float, ...] = (1e-6, 1e-4, 1e-2),
) -> pd.DataFrame:
    """Train a small backpropagation network from coordinates to (cos θ, sin θ) on some of the views.

    The training views set its weights, the validation views choose the weight decay, the test views judge.
    Errors are taken the short way round.

    Parameters
    ----------
    coordinates
        Of the views on their manifold.
    headings
        rad.
    seed
        Draws views, split and first weights.
    most
        Views that the network is shown, of which the paper had 1350 for training, 270 to validate, 180 to
        test; of fewer, the same shares.
    decays
        Weight decays, of which the validation views choose one.

    Returns
    -------
    pandas.DataFrame
        `view`, `split`, `heading_rad` and `error_rad` of the prediction, a row for each view it was shown.

    References
    ----------
    Rumelhart, Hinton & Williams (1986), Learning representations by back-propagating errors.
    """
    chosen = np.random.default_rng(seed).permutation(len(headings))[:most]
    shares = {"training": 0.75, "validation": 0.15, "test": 0.1}
    ends = np.rint(np.cumsum(list(shares.values())) * len(chosen)).astype(int)[:-1]
    training, validation, _ = np.split(chosen, ends)
    target = np.column_stack([np.cos(headings), np.sin(headings)])
    known = coordinates[training], target[training]

    def errors(network: Pipeline, views: np.ndarray) -> Float[np.ndarray, "_"]:
        cosine, sine = network.predict(coordinates[views]).T
        return wrap_angle(np.arctan2(sine, cosine) - headings[views])

    perceptron = partial(
        MLPRegressor,
        hidden_layer_sizes=(32,),
        activation="tanh",
        solver="lbfgs",
        max_iter=2000,
        random_state=seed,
    )
    with one_thread(), warnings.catch_warnings():
        # A number of steps is as good an end as any: the validation views judge.
        warnings.simplefilter("ignore", ConvergenceWarning)
        networks = [make_pipeline(StandardScaler(), perceptron(alpha=decay)).fit(*known) for decay in decays]
        best = min(networks, key=lambda network: float(np.square(errors(network, validation)).mean()))
        missed = errors(best, chosen)
    split = np.repeat(list(shares), np.diff([0, *ends, len(chosen)]))
    return pd.DataFrame(
        {"view": chosen, "split": split, "heading_rad": headings[chosen], "error_rad": missed}
    )


def correlation(fit: pd.DataFrame) -> float:
    """Correlate the true headings with the predicted ones, as the errors tell them: θ with θ + error."""
    return float(np.corrcoef(fit["heading_rad"], fit["heading_rad"] + fit["error_rad"])[0, 1])
