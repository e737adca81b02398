"""S1's threshold against false alarms: slips caught and alarms an hour on scenes, each threshold with the firmware's own detector."""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tenax

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--out", type=Path, default=Path("."))
parser.add_argument("--seeds", type=int, default=1)
asked = parser.parse_args()

FILMS = tenax.CHANNELS[:12]
# The robot's pushes and what is poured are loud, and nothing slides.
SCENES = ("glass", "steel-balls", "wearer", "pour", "push-hold")
recordings = [
    tenax.recording(scene, seed) for scene, seed in itertools.product(SCENES, range(1, asked.seeds + 1))
]
hours = sum(samples["t_s"][-1] for samples, _ in recordings) / 3600
thresholds = [20, 50, 100, 150, 200, 300]
caught, alarms = [], []
for threshold in thresholds:
    slipped = found = false = 0
    for samples, slips in recordings:
        films = np.stack([samples[name] for name in FILMS], axis=1)
        onsets = tenax.detect.s1(films, 2000, s1_mv=threshold).onsets_s
        spans = [(slip.micro_onset_s, slip.end_s + 0.05) for slip in slips]
        # As the scorer's: in time is until 50 ms after all of the contact slides. What the wearer means is neither.
        for slip in slips:
            if not slip.meant:
                slipped += 1
                found += any(slip.micro_onset_s <= at_s <= slip.macro_onset_s + 0.05 for at_s in onsets)
        false += sum(not any(begin_s <= at_s <= end_s for begin_s, end_s in spans) for at_s in onsets)
    caught.append(found / slipped)
    alarms.append(false / hours)
    print(f"S1 at {threshold:>3} mV: {found} of {slipped} slips caught, {alarms[-1]:.0f} false alarms an hour, the wearer's own movements included")

figure, axes = plt.subplots(figsize=(6, 5), layout="constrained")
axes.plot(alarms, caught, "o-")
for threshold, x, y in zip(thresholds, alarms, caught):
    axes.annotate(f"{threshold} mV", (x, y), textcoords="offset points", xytext=(6, -12))
axes.set(xlabel="false alarms an hour", ylabel="slips caught", ylim=(-0.05, 1.05))
figure.savefig(asked.out / "threshold.png")
