"""Five classifiers on the firmware's features of ten taxels, as Bamshad 2023 (figure 7) compared five; the network that ships beside them.

    python classifiers.py --dataset array_dataset.csv     # what `cargo tenax dataset` writes; without: a small one from scenes
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, List, Tuple

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import HistGradientBoostingClassifier, RandomForestClassifier
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import balanced_accuracy_score
from sklearn.neural_network import MLPClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

import tenax

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--dataset", type=Path)
parser.add_argument("--rows", type=int, default=10_000, help="rows to learn from, at most")
parser.add_argument("--out", type=Path, default=Path("."))
asked = parser.parse_args()

# Volts of ten taxels 80 times a second, slip, and whether it is to learn from.
Recording = Tuple[NDArray[np.float64], NDArray[np.bool_], bool]
TAXELS = [name for name in tenax.CHANNELS if name.startswith("array_")]


def from_scenes() -> List[Recording]:
    recordings = []
    for scene in ("array-pour", "array-pick", "array-disturb", "array-rotation"):
        for seed in (1, 2):
            samples, slips = tenax.recording(scene, seed)
            times, volts = samples["t_s"][24::25], np.stack([samples[name][24::25] for name in TAXELS], axis=1)
            slides = np.zeros(len(times), bool)
            for slip in slips:
                slides |= (slip.macro_onset_s < times) & (times <= slip.end_s)
            recordings.append((volts.astype(np.float64), slides, seed == 1))
    return recordings


def from_dataset(path: Path) -> List[Recording]:
    table: Any = np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")
    recordings = []
    for name in np.unique(table["recording"]):
        rows = table[table["recording"] == name]
        volts = np.stack([rows[f"a{n}"] for n in range(1, 11)], axis=1) * tenax.MV / 1000
        if rows["split"][0] != "test":
            recordings.append((volts, rows["label"] == 1, rows["split"][0] == "train"))
    return recordings


learn: List[Tuple[NDArray[Any], NDArray[Any]]] = []
score: List[Tuple[NDArray[Any], NDArray[Any]]] = []
shipped: List[NDArray[np.bool_]] = []
for volts, slides, learns in from_dataset(asked.dataset) if asked.dataset else from_scenes():
    features = tenax.detect.features(volts, 80)
    known = features.any(axis=1)
    (learn if learns else score).append((features[known], slides[known]))
    if not learns:
        shipped.append(tenax.detect.mlp(volts, 80).slip[known])
x, y = (np.concatenate(part) for part in zip(*learn))
unseen, truth = (np.concatenate(part) for part in zip(*score))
if len(x) > asked.rows:
    kept = np.random.default_rng(1).choice(len(x), asked.rows, replace=False)
    x, y = x[kept], y[kept]
if asked.dataset is None:
    print("The scenes are the same with other noise: --dataset has other contacts.")
# An MLP weighs no classes: rows that slip are repeated until they are half.
often = np.concatenate([np.flatnonzero(~y), np.resize(np.flatnonzero(y), np.count_nonzero(~y))])
print(f"{len(x)} rows to learn from, {y.mean():.1%} slip; {len(truth)} rows of other recordings to score on, {truth.mean():.1%} slip")

# scikit-learn has no LSTM: forest and boosting stand in the place of the paper's two.
classifiers = {
    "SVM": make_pipeline(StandardScaler(), SVC(class_weight="balanced")),
    "logistic regression": make_pipeline(StandardScaler(), LogisticRegression(class_weight="balanced", max_iter=1000)),
    "random forest": RandomForestClassifier(100, class_weight="balanced", min_samples_leaf=5, random_state=1),
    "boosting": HistGradientBoostingClassifier(class_weight="balanced", random_state=1),
    "MLP": make_pipeline(StandardScaler(), MLPClassifier((32, 16), early_stopping=True, random_state=1)),
}
scores = {}
for name, own in classifiers.items():
    rows = often if name == "MLP" else np.arange(len(x))
    scores[name] = balanced_accuracy_score(truth, own.fit(x[rows], y[rows]).predict(unseen))
# Its thresholds are chosen for few false alarms (docs/array.md).
scores["as shipped"] = balanced_accuracy_score(truth, np.concatenate(shipped))
for name, balanced in scores.items():
    print(f"{name:<22}balanced accuracy {balanced:.3f}")
if scores["logistic regression"] >= scores["MLP"] - 0.01:
    print("The linear model is as good as the network.")

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.barh(list(scores), list(scores.values()))
axes.axvline(0.5, color="grey", linestyle="--")
axes.set(xlim=(0.4, 1.0), xlabel="balanced accuracy on recordings it has not seen")
figure.savefig(asked.out / "classifiers.png")
