"""Your own detector beside those that ship: here a band's energy in numpy, scored as they are on the same recordings."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import List

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import tenax

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--out", type=Path, default=Path("."))
asked = parser.parse_args()


def own_detector(films: NDArray[np.float64]) -> NDArray[np.float64]:
    """Replace this one. Films (V), 2000 rows a second, in; when slip begins (s) out."""
    def mean(rows: int) -> NDArray[np.float64]:
        """Of the last rows."""
        sums = np.cumsum(np.vstack([np.zeros((rows, films.shape[1])), films - films[0]]), axis=0)
        average: NDArray[np.float64] = (sums[rows:] - sums[:-rows]) / rows
        return average

    # Roughly 20 to 150 Hz, in at least half of the films.
    loud = np.abs(mean(6) - mean(50)) > 0.06
    says = np.convolve(loud.sum(axis=1) >= 6, np.ones(20))[: len(films)] >= 8
    return np.flatnonzero(says & ~np.concatenate(([False], says[:-1]))) / 2000


rows: "dict[str, List[float]]" = {name: [0, 0] for name in ("own", *tenax.DETECTORS)}
slipped, hours = 0, 0.0
for scene in ("glass", "steel-balls", "knocks", "arm-swing"):
    samples, slips = tenax.recording(scene, seed=1)
    run = tenax.Fingertip().run(samples)
    onsets = {name: [begin_s for begin_s, _ in run.stretches(name)] for name in tenax.DETECTORS}
    onsets["own"] = own_detector(np.stack([samples[name] for name in tenax.CHANNELS[:12]], axis=1)).tolist()
    hours += samples["t_s"][-1] / 3600
    slipped += sum(not slip.meant for slip in slips)
    for name, own in onsets.items():
        rows[name][0] += sum(any(s.micro_onset_s <= at_s <= s.macro_onset_s + 0.05 for at_s in own) for s in slips if not s.meant)
        rows[name][1] += sum(not any(s.micro_onset_s <= at_s <= s.end_s + 0.05 for s in slips) for at_s in own)

print(f"{'detector':<14}{'caught':>8} of {slipped:<4}{'false alarms an hour':>22}")
for name, (caught, false) in rows.items():
    print(f"{name:<14}{caught:>8}{'':>8}{false / hours:>22.0f}")
figure, axes = plt.subplots(figsize=(6, 5), layout="constrained")
for name, (caught, false) in rows.items():
    axes.scatter(false / hours + 1, caught / slipped, label=name)
axes.set(xscale="log", xlabel="false alarms an hour + 1", ylabel="slips caught", ylim=(-0.05, 1.05))
axes.legend()
figure.savefig(asked.out / "own_detector.png")
