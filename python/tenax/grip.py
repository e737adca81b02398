"""Gymnasium environments in which a hand holds what slips: `import gymnasium, tenax.grip; gymnasium.make("tenax/Grip-v0")`.

`python -m tenax.grip --help` prints the baselines' scores.
"""

from __future__ import annotations

import argparse
import sys
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, SupportsFloat, Tuple

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from . import _native
from .fingertip import FAMILIES

__all__ = ["BASELINES", "ConstantGrip", "DrawnGrip", "Grip", "MarginPid", "Policy", "do_nothing", "play"]

Observation = NDArray[np.float32]
Action = NDArray[np.float32]
Policy = Callable[[Observation], Action]

# Steps a second.
STEP_HZ = 80
_PLACES = {name: place for place, (name, _, _) in enumerate(_native.OBSERVED)}


class Grip(gymnasium.Env[Observation, Action]):
    """A scene of `cargo tenax run --list`, whose motor is yours. The wearer of a hand grasps and lifts by their muscles, and comes first.

    Action: motor duty for a step of 12.5 ms, -1 (opens) to 1 (closes), shape (1,). It is ignored while a muscle is active or the wearer
    drives. With `reflex=True` the firmware's reflex acts too, and the duty is added to its drive: 0 is the reflex alone. The motor's limits
    and the force ceiling are not applied to the action, and the detectors are not told of it.

    Observation, "conditioned": what the firmware makes of its sensors, shape (24,), named by `Grip.NAMES`: forces in N, 0 while not known.
    "raw": volts at the pins, shape (330,): twelve films in each of 25 frames, then tenax.CHANNELS[12:].

    Reward: minus newton-seconds of grip beyond what holds the object (times `force_weight`), minus millimetres slid (times `slid_weight`),
    minus `lost_weight` when it is dropped, left behind or broken, which ends the episode unless `ends_when_lost=False`: only then are the scores
    of a lost object those of `tenax run`, which goes on.

    info: time_s, grip_n and needed_n (N), beyond_need_ns and slid_mm in this step, kept; at the end `scores`, as a report of `tenax run`.

    reset(seed=N): the noise of `cargo tenax run --seed N`. `frame_skip`: steps of 12.5 ms for each action.
    """

    metadata: Dict[str, Any] = {"render_modes": []}
    NAMES: Tuple[str, ...] = tuple(_PLACES)

    def __init__(
        self, scene: str = "glass", *, reflex: bool = False, observation: str = "conditioned", frame_skip: int = 1,
        force_weight: float = 0.1, slid_weight: float = 1.0, lost_weight: float = 100.0, ends_when_lost: bool = True,
        settings: Optional[Mapping[str, int]] = None,
    ) -> None:
        if observation not in ("conditioned", "raw"):
            raise ValueError(f"observation is `conditioned` or `raw`, not {observation!r}")
        self.scene, self.reflex, self.frame_skip = scene, reflex, frame_skip
        self.weights, self.ends_when_lost = (force_weight, slid_weight, lost_weight), ends_when_lost
        self.settings = list((settings or {}).items())
        self.is_raw = observation == "raw"
        self.action_space = spaces.Box(-1.0, 1.0, (1,), np.float32)
        bounds = np.array([row[1:] for row in _native.OBSERVED], dtype=np.float32)
        low, high = (np.zeros(330, np.float32), np.full(330, 3.3, np.float32)) if self.is_raw else (bounds[:, 0], bounds[:, 1])
        self.observation_space = spaces.Box(low, high, dtype=np.float32)
        self.world: Optional[_native.World] = None
        self._before = (0.0, 0.0, True)

    def _made(self, seed: Optional[int], options: Mapping[str, Any]) -> _native.World:
        noise = int(self.np_random.integers(1, 2**31)) if seed is None else seed
        return _native.World(options.get("scene", self.scene), noise, self.reflex, self.settings)

    def reset(self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None) -> Tuple[Observation, Dict[str, Any]]:
        super().reset(seed=seed)
        self.world = self._made(seed, options or {})
        self._before = (0.0, 0.0, True)
        return self._observation(self.world), {"world": self.world.name, "duration_s": self.world.duration_s}

    def step(self, action: Action) -> Tuple[Observation, SupportsFloat, bool, bool, Dict[str, Any]]:
        if self.world is None:
            raise gymnasium.error.ResetNeeded("call reset first")
        goes_on = self.world.step(float(np.asarray(action).reshape(-1)[0]), self.frame_skip)
        time_s, beyond_ns, slid_mm, grip_n, needed_n, kept = self.world.truth()
        step_ns, step_mm = beyond_ns - self._before[0], slid_mm - self._before[1]
        force, slid, lost = self.weights
        reward = -force * step_ns - slid * step_mm - (lost if self._before[2] and not kept else 0.0)
        self._before = (beyond_ns, slid_mm, kept)
        terminated = not kept and self.ends_when_lost
        info: Dict[str, Any] = {
            "time_s": time_s, "grip_n": grip_n, "needed_n": needed_n, "beyond_need_ns": step_ns, "slid_mm": step_mm, "kept": kept,
        }
        if terminated or not goes_on:
            info["scores"] = self.world.scores()
        return self._observation(self.world), reward, terminated, not goes_on, info

    def _observation(self, world: _native.World) -> Observation:
        box = self.observation_space
        assert isinstance(box, spaces.Box)
        return np.clip(world.raw() if self.is_raw else world.observation(), box.low, box.high)


class DrawnGrip(Grip):
    """As Grip, in worlds that nobody chose: ten families (tenax.FAMILIES), drawn from stated distributions. reset(seed=N): world N of
    `cargo tenax sweep --drawn --seed WORLDS`. Its rule: worlds=1 to 999 are for choosing and learning, others for scoring."""

    def __init__(self, *, worlds: int = 1, family: Optional[str] = None, **others: Any) -> None:
        super().__init__(**others)
        self.worlds, self.family = worlds, family

    def _made(self, seed: Optional[int], options: Mapping[str, Any]) -> _native.World:
        n = int(self.np_random.integers(2**31)) if seed is None else seed
        return _native.World.drawn(options.get("family", self.family), options.get("worlds", self.worlds), n, self.reflex, self.settings)


def do_nothing(_: Observation) -> Action:
    """The wearer's own grip; with the reflex, the reflex alone."""
    return np.zeros(1, np.float32)


class ConstantGrip:
    """Closes until the finger feels so many newtons, and never opens."""

    def __init__(self, newtons: float = 10.0, gain: float = 0.1) -> None:
        self.newtons, self.gain = newtons, gain

    def __call__(self, observation: Observation) -> Action:
        load_n = float(observation[_PLACES["load_n"]])
        duty = self.gain * (self.newtons - load_n) if load_n > 0.3 else 0.0
        return np.array([min(max(duty, 0.0), 1.0)], np.float32)


class MarginPid:
    """Holds the margin, the shear that the finger could still carry, at `margin_n`, by a PID; opens at a tenth of the motor's speed at most."""

    def __init__(self, margin_n: float = 0.6, kp: float = 0.25, ki: float = 0.1, kd: float = 0.01) -> None:
        self.margin_n, self.gains = margin_n, (kp, ki, kd)
        self.sum = self.before = 0.0

    def __call__(self, observation: Observation) -> Action:
        if observation[_PLACES["ratio"]] == 0.0:
            self.sum = self.before = 0.0
            return np.zeros(1, np.float32)
        error = self.margin_n - float(observation[_PLACES["margin_n"]])
        self.sum = min(max(self.sum + error / STEP_HZ, -1.0), 1.0)
        kp, ki, kd = self.gains
        duty = kp * error + ki * self.sum + kd * (error - self.before) * STEP_HZ
        self.before = error
        return np.array([min(max(duty, -0.1), 1.0)], np.float32)


# Name, whether the firmware's reflex acts, and a policy for an episode.
BASELINES: Dict[str, Tuple[bool, Callable[[], Policy]]] = {
    "reflex": (True, lambda: do_nothing),
    "constant grip": (False, ConstantGrip),
    "PID on margin": (False, MarginPid),
    "do nothing": (False, lambda: do_nothing),
}


def play(env: gymnasium.Env[Observation, Action], policy: Policy, seed: int) -> Dict[str, Any]:
    """Plays an episode; its scores, and the sum of its rewards as `reward`."""
    observation, _ = env.reset(seed=seed)
    reward = 0.0
    while True:
        observation, own, terminated, truncated, info = env.step(policy(observation))
        reward += float(own)
        if terminated or truncated:
            return {**info["scores"], "reward": reward}


gymnasium.register("tenax/Grip-v0", entry_point="tenax.grip:Grip")
gymnasium.register("tenax/DrawnGrip-v0", entry_point="tenax.grip:DrawnGrip")


def table(make: Callable[[bool], gymnasium.Env[Observation, Action]], seeds: Sequence[int]) -> List[Dict[str, Any]]:
    """Scores of every baseline by seed."""
    rows = []
    for name, (reflex, policy) in BASELINES.items():
        env = make(reflex)
        rows += [{"policy": name, "seed": seed, **play(env, policy(), seed)} for seed in seeds]
    return rows


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tenax.grip", description="Scores of the baselines: the table that a paper would print.")
    parser.add_argument("--scene", default="glass", help="a scene, or a file")
    parser.add_argument("--drawn", type=int, metavar="SEED", help="drawn worlds of this seed instead (1 to 999 are for choosing)")
    parser.add_argument("--family", choices=FAMILIES, help="of drawn worlds, one family")
    parser.add_argument("--seeds", default="1..3", help="seeds, or numbers of worlds: 7, or 1..5 [1..3]")
    parser.add_argument("--each", action="store_true", help="also a line for each seed")
    asked = parser.parse_args(arguments)
    first, _, last = asked.seeds.partition("..")
    seeds = range(int(first), int(last or first) + 1)
    if asked.drawn is None:
        rows = table(lambda reflex: Grip(asked.scene, reflex=reflex, ends_when_lost=False), seeds)
    else:
        rows = table(lambda reflex: DrawnGrip(worlds=asked.drawn, family=asked.family, reflex=reflex, ends_when_lost=False), seeds)
    columns = ("kept", "slid_mm", "peak_n", "mean_n", "beyond_need_n", "reward")
    print(f"{'policy':<16}{'seed':>8}" + "".join(f"{name:>15}" for name in columns))
    for name in BASELINES:
        own = [row for row in rows if row["policy"] == name]
        mean = {column: np.mean([float(row[column] or 0.0) for row in own]) for column in columns}
        for row in [*(own if asked.each else ()), {"policy": name, "seed": "mean", **mean}]:
            print(f"{row['policy']:<16}{row['seed']:>8}" + "".join(f"{float(row[column] or 0.0):>15.3f}" for column in columns))
    return 0


if __name__ == "__main__":
    sys.exit(main())
