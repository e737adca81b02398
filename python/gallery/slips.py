"""A recording in, slips marked:   python slips.py touch.csv --recipe friction_rig     (without a file: one that a scene makes)"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, List

import matplotlib.pyplot as plt
import numpy as np

import tenax

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("recording", nargs="?", help="a CSV file: t_s, and columns that are channels in volts, or that the recipe names")
parser.add_argument("--recipe", help="how its columns reach the pins: docs/recipes.md")
parser.add_argument("--out", type=Path, default=Path("."))
asked = parser.parse_args()

slips: List[tenax.Slip] = []
samples: Any
if asked.recording:
    samples = np.genfromtxt(asked.recording, delimiter=",", names=True)
else:
    samples, slips = tenax.recording("glass", seed=1)
run = tenax.Fingertip().run(samples, recipe=asked.recipe)

figure, (loads, heard) = plt.subplots(2, sharex=True, figsize=(10, 5), layout="constrained")
loads.plot(run.states["time_s"], run.states["load_n"], label="grip")
loads.plot(run.states["time_s"], run.states["ft_n"], label="shear")
loads.set_ylabel("force, N")
heard.plot(run.ticks["time_s"], run.ticks["vibration_mv"], color="grey", linewidth=0.5)
heard.set(ylabel="vibration, mV", xlabel="time, s")
for place, detector in enumerate(tenax.DETECTORS):
    stretches = run.stretches(detector, "believed")
    for begin_s, end_s in stretches:
        loads.axvspan(begin_s, end_s, color=f"C{place + 2}", alpha=0.3)
    if stretches:
        loads.plot([], [], color=f"C{place + 2}", linewidth=6, alpha=0.3, label=f"{detector} believed")
        print(f"{detector:<14} believed {len(stretches)} times, first at {stretches[0][0]:.3f} s")
for slip in slips:
    heard.axvline(slip.macro_onset_s, color="red", linestyle="--", label=f"slips {slip.slid_mm:.1f} mm")
loads.legend(loc="upper left")
if slips:
    heard.legend(loc="upper left")
figure.savefig(asked.out / "slips.png")
