"""Your own controller in the environment: here one that tightens when S2 or S1 says slip, beside the baselines."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, Callable, Dict, List, Tuple

import gymnasium
import matplotlib.pyplot as plt
import numpy as np

from tenax import grip

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--out", type=Path, default=Path("."))
parser.add_argument("--scene", default="glass")
asked = parser.parse_args()
PLACE = {name: place for place, name in enumerate(grip.Grip.NAMES)}


class Tightens:
    """Replace this one. An observation in, a duty from -1 (opens) to 1 (closes) out."""

    def __init__(self) -> None:
        self.steps_left = 0

    def __call__(self, observation: grip.Observation) -> grip.Action:
        holds = observation[PLACE["load_n"]] > 0.5
        if holds and (observation[PLACE["s1_says"]] or observation[PLACE["margin_n"]] < 0.1):
            self.steps_left = 8
        self.steps_left = max(self.steps_left - 1, 0)
        return np.array([0.3 if self.steps_left and holds else 0.0], np.float32)


figure, axes = plt.subplots(figsize=(10, 4), layout="constrained")
print(f"{'policy':<16}{'kept':>6}{'slid, mm':>10}{'peak, N':>9}{'beyond need, N':>16}{'reward':>9}")
policies: Dict[str, Tuple[bool, Callable[[], grip.Policy]]] = {"own": (False, Tightens), **grip.BASELINES}
for name, (reflex, policy) in policies.items():
    env = gymnasium.make("tenax/Grip-v0", scene=asked.scene, reflex=reflex)
    own = policy()
    observation, _ = env.reset(seed=1)
    told: List[Dict[str, Any]] = []
    reward, over = 0.0, False
    while not over:
        observation, step, terminated, truncated, info = env.step(own(observation))
        told.append(info)
        reward, over = reward + float(step), terminated or truncated
    scores = told[-1]["scores"]
    print(
        f"{name:<16}{scores['kept']!s:>6}{scores['slid_mm']:>10.1f}{scores['peak_n'] or 0:>9.1f}{scores['beyond_need_n'] or 0:>16.2f}{reward:>9.1f}"
    )
    axes.plot([row["time_s"] for row in told], [row["grip_n"] for row in told], label=name)
    if name == "reflex":
        axes.plot([row["time_s"] for row in told], [row["needed_n"] for row in told], "k--", label="needed")
axes.set(xlabel="time, s", ylabel="grip, N", title=asked.scene)
axes.legend()
figure.savefig(asked.out / "own_controller.png")
