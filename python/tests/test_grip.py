"""The environments: checked by gymnasium's own checker, the same scores as `tenax run`, and the same again for the same seed."""

import contextlib
import io
import tempfile
import time
import unittest
import warnings
from pathlib import Path

import numpy as np

import tenax

try:
    import gymnasium
    from gymnasium.utils.env_checker import check_env

    from tenax import grip
except ImportError as missing:
    raise unittest.SkipTest(f"the environments are not tested: {missing}") from None


class Environments(unittest.TestCase):
    def test_gymnasiums_checker_has_nothing_to_say(self) -> None:
        for name in ("tenax/Grip-v0", "tenax/DrawnGrip-v0"):
            for options in ({}, {"observation": "raw"}, {"reflex": True, "frame_skip": 4}):
                with warnings.catch_warnings():
                    warnings.simplefilter("error")
                    check_env(gymnasium.make(name, **options).unwrapped)

    def test_two_of_one_seed_agree(self) -> None:
        one, other = grip.DrawnGrip(), grip.DrawnGrip()
        random = np.random.default_rng(5)
        for env in (one, other):
            env.reset(seed=9)
        # One and the same after the first, too.
        for env in (one, other):
            env.reset()
        for _ in range(150):
            action = random.uniform(-0.2, 1.0, 1).astype(np.float32)
            told, again = one.step(action), other.step(action)
            np.testing.assert_array_equal(told[0], again[0])
            self.assertEqual(told[1:], again[1:])

    def test_a_vector_of_them(self) -> None:
        envs = gymnasium.make_vec("tenax/DrawnGrip-v0", num_envs=3, vectorization_mode="sync")
        seen, _ = envs.reset(seed=4)
        self.assertEqual(seen.shape, (3, len(grip.Grip.NAMES)))
        for _ in range(30):
            seen, rewards, *_ = envs.step(np.zeros((3, 1), np.float32))
        self.assertEqual((seen.shape, rewards.shape), ((3, len(grip.Grip.NAMES)), (3,)))


class Scores(unittest.TestCase):
    def reported(self, scene: str, seed: int, told: "dict[str, object]") -> None:
        report = tenax.run(scene, seed, bound=False)
        self.assertEqual(told["kept"], report["object"]["kept"], (scene, seed))
        self.assertEqual(told["slid_mm"], report["slip"]["distance_mm"], (scene, seed))
        self.assertEqual(told["peak_n"], report["grip"]["peak_force_n"], (scene, seed))
        self.assertEqual(told["needed_n"], report["grip"]["needed_force_n"], (scene, seed))

    def test_the_reflex_is_that_of_run(self) -> None:
        scenes = ("glass", (1, 2)), ("can", (1, 3)), ("arm-swing", (2,)), ("gripper", (1,)), ("gripper-control", (1,)), ("pick-up-trial", (1, 2))
        for scene, seeds in scenes:
            env = grip.Grip(scene, reflex=True, ends_when_lost=False)
            for seed in seeds:
                self.reported(scene, seed, grip.play(env, grip.do_nothing, seed))

    def test_the_reflex_in_drawn_worlds_is_that_of_run(self) -> None:
        env = grip.DrawnGrip(worlds=2, reflex=True, ends_when_lost=False)
        with tempfile.TemporaryDirectory() as folder:
            for n in range(len(tenax.FAMILIES)):
                text, noise = tenax.drawn(2, n)
                path = Path(folder) / f"{n}.toml"
                path.write_text(text)
                self.reported(str(path), noise, grip.play(env, grip.do_nothing, n))

    def test_doing_nothing_loses_what_the_reflex_keeps_and_costs_more(self) -> None:
        rows = {row["policy"]: row for row in grip.table(lambda reflex: grip.Grip(reflex=reflex), [1])}
        reflex, nothing = rows["reflex"], rows["do nothing"]
        self.assertEqual((reflex["kept"], nothing["kept"]), (True, False))
        self.assertGreater(reflex["reward"], nothing["reward"])

    def test_a_loss_costs_once(self) -> None:
        short, whole = grip.Grip(slid_weight=0.0, force_weight=0.0), grip.Grip(slid_weight=0.0, force_weight=0.0, ends_when_lost=False)
        self.assertEqual([grip.play(env, grip.do_nothing, 1)["reward"] for env in (short, whole)], [-100.0, -100.0])

    def test_the_wearer_comes_first(self) -> None:
        env = grip.Grip("glass")
        env.reset(seed=1)
        drives = []
        for _ in range(80 * 3):
            seen, *_ = env.step(np.array([-1.0], np.float32))
            drives.append((bool(seen[env.NAMES.index("wearer_active")]), float(seen[env.NAMES.index("drive")])))
        # Their closing goes on, whatever is asked for; without them it opens.
        active = [drive for is_active, drive in drives if is_active]
        self.assertTrue(active and max(active) > 0 and min(active) >= 0, active)
        self.assertEqual(min(drive for is_active, drive in drives if not is_active), -1.0)

    def test_the_table_has_a_row_for_every_baseline(self) -> None:
        with contextlib.redirect_stdout(io.StringIO()) as told:
            self.assertEqual(grip.main(["--drawn", "2", "--seeds", "0..1", "--each"]), 0)
        self.assertEqual(len(told.getvalue().splitlines()), 1 + 3 * len(grip.BASELINES), told.getvalue())

    def test_fifty_times_as_fast_as_it_lasts(self) -> None:
        env = grip.Grip("glass", reflex=True)
        begun = time.process_time()
        grip.play(env, grip.do_nothing, 1)
        assert env.world is not None
        self.assertLess(time.process_time() - begun, env.world.duration_s / 50)


if __name__ == "__main__":
    unittest.main()
