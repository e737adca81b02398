"""Five classifiers on ten taxels, and a network trained for the firmware: python -m tenax.train on recordings of scenes, with a picture.

    python classifiers.py --dataset array_dataset.csv     # what `cargo tenax dataset` writes; without: a small one from scenes
"""

from __future__ import annotations

import argparse
import csv
import itertools
import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tenax
from tenax import train

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--dataset", type=Path)
parser.add_argument("--out", type=Path, default=Path("."))
asked = parser.parse_args()
TAXELS = [name for name in tenax.CHANNELS if name.startswith("array_")]
SCENES = ("array-pour", "array-pick", "array-disturb", "array-rotation")


def from_scenes(path: Path) -> Path:
    """A row a slow frame, in the columns of `cargo tenax dataset`. The scenes are the same with other noise: a real data set has other contacts."""
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["split", "session", "material", "recording", "task", "t_s", "label", *(f"a{n}" for n in range(1, 11))])
        for scene, seed in itertools.product(SCENES, (1, 2)):
            samples, slips = tenax.recording(scene, seed)
            times, volts = samples["t_s"][24::25], np.stack([samples[name][24::25] for name in TAXELS], axis=1)
            codes = np.clip(np.round(1000 * volts / tenax.MV), 0, 16_380).astype(int)
            for t_s, row in zip(times, codes):
                slides = any(slip.macro_onset_s < t_s <= slip.end_s for slip in slips)
                about = ["train" if seed == 1 else "validation", f"{scene}-{seed}", "box", f"{scene}-{seed}", "pour" if scene == "array-pour" else "pick"]
                rows.writerow([*about, f"{t_s:.4f}", int(slides), *row])
    return path


dataset = asked.dataset or from_scenes(asked.out / "array_dataset_of_scenes.csv")
folder = asked.out / "classifiers"
train.main([str(dataset), "--out", str(folder), "--rows", "5000"])
scores = json.loads((folder / "report.json").read_text())["scores"]

figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
for place, key in ((0.2, "auc"), (-0.2, "balanced")):
    axes.barh([n + place for n in range(len(scores))], [score[key] for score in scores.values()], height=0.4, label=key)
axes.set(yticks=range(len(scores)), yticklabels=list(scores), xlim=(0.4, 1.0), xlabel="in recordings that it has not seen: area under the ROC curve, and balanced accuracy")
axes.axvline(0.5, color="grey", linestyle="--")
figure.legend(loc="outside upper center", ncols=2)
figure.savefig(asked.out / "classifiers.png")
