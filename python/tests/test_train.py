"""The network's trainer: its tables are the firmware's, and what can be learned is learned."""

import ast
import contextlib
import hashlib
import io
import json
import os
import re
import tempfile
import unittest
from pathlib import Path

import numpy as np

import tenax

try:
    from tenax import train
except ImportError as missing:
    raise unittest.SkipTest(f"the trainer is not tested: {missing}") from None

CHECKOUT = Path(os.environ.get("TENAX_CHECKOUT", ".."))
SHIPPED = CHECKOUT / "logic/src/array/network.in"
# The recordings are not part of the project.
REAL = CHECKOUT.parent / "shared" / "data"
CALIBRATION, THRESHOLD, NOISE = (0.7935670976526779, 0.20573033944853786), 0.04699179530143738, [3.2844309272143106, 14.32529063634988]
NETWORK_IN = "fbd3d22fa84f0b6ff12259bf190653e076b3f450e9e9bfe429b3c8ebf09ac18a"
NETWORK_JSON = "4334ba1fb76bf82f569af6db73c2a2e7f584c3bdbcc853feaaef397fa30e9f26"
RECIPE = """
title = "t"
description = "d"
[array]
columns = ["a0", "a1", "a2", "a3", "a4", "a5", "a6", "a7", "a8", "a9"]
rate_hz = 80
[recordings]
name = "recording"
session = "object"
[labels]
column = "label"
slip = ["1"]
no_slip = ["0"]
"""


def trembling(path: Path, sessions: int = 4, slips: bool = True) -> None:
    """Objects that tremble more while they slip, each with noise of its own."""
    random, rows = np.random.default_rng(1), ["recording,object,label," + ",".join(f"a{n}" for n in range(10))]
    for n in range(12):
        slip = np.arange(160) % 80 >= 40
        levels = 4000 + np.cumsum(np.where(slip, 60, 8)[:, None] * random.uniform(-0.5, 0.5, (160, 10)), axis=0)
        rows += [f"{n},{n % sessions},{int(is_slip and slips)}," + ",".join(str(int(own)) for own in row) for is_slip, row in zip(slip, levels)]
    path.write_text("\n".join(rows) + "\n")
    path.with_suffix(".toml").write_text(RECIPE)


class Exported(unittest.TestCase):
    def test_bit_for_bit_as_the_rust_exporter_wrote(self) -> None:
        # The last network that the trainer in Rust made (seed 1, `tenax dataset` of the same commit), before rounding, and the two rows whose
        # activations are the largest of the data's. The hashes are of the files that it wrote.
        own = np.load(Path(__file__).with_name("exported.npz"))
        network = train.Network((own["first"], own["second"], own["last"]), (own["first_bias"], own["second_bias"], own["last_bias"]))
        sha256 = "cbe83658844a717f7e313abaeba66381eacaade6a1ed0140d0b0ef0bef2e88e8"
        saved = {
            "sha256": sha256, "lag": 1, "window": 10, "covariance_knee": 128, "spectrum_knee": 2048, "structure_knee": 128,
            **train.quantise(network, own["rows"], CALIBRATION, THRESHOLD), "noise_samples": NOISE,
        }
        saved.update(on_permille=725, off_permille=325)
        text = train.rust(saved, f"Learned from `array_dataset.csv` (SHA-256 {sha256}), seed 1; docs/array.md says how it is judged.")
        text = text.replace("python -m tenax.train", "tenax train", 1)
        told = [hashlib.sha256(each.encode()).hexdigest() for each in (text, json.dumps(saved, separators=(",", ":")))]
        self.assertEqual(told, [NETWORK_IN, NETWORK_JSON])

    def shipped(self) -> "tuple[str, dict[str, object]]":
        text = SHIPPED.read_text()
        layers = re.findall(r"layer::<\d+, \d+>\((.*?)\n        \),", text, re.S)
        first, second, last = (ast.literal_eval(f"[{own}]") for own in layers)
        numbers = {name: int(value) for name, value in re.findall(r"(\w+): (\d+),", text)}
        return text, {**numbers, "first": first, "second": second, "last": [last[0][0], last[1][0]]}

    def test_the_shipped_tables_are_written_byte_for_byte(self) -> None:
        text, saved = self.shipped()
        self.assertEqual(train.rust(saved, text.splitlines()[1][3:]), text)

    def test_integers_are_judged_as_by_the_firmware(self) -> None:
        samples, _ = tenax.recording("array-pour", seed=1)
        volts = np.stack([samples[name][24::25] for name in tenax.CHANNELS if name.startswith("array_")], axis=1)
        rows, said = tenax.detect.features(volts, 80), tenax.detect.mlp(volts, 80)
        known = rows.any(axis=1)
        odds = train.judge(self.shipped()[1], rows[known])
        np.testing.assert_allclose(1 / (1 + np.exp(-odds)), said.value[known], atol=0.004)

    def test_covariances_of_the_firmwares_window_are_the_firmwares(self) -> None:
        samples = (4000 + np.cumsum(np.random.default_rng(1).integers(-30, 31, (200, 10)), axis=0)).astype(np.uint16)
        for recipe in (train.Recipe(), train.Recipe(lag=5, covariance_knee=6400)):
            rows, known = train.features(samples, recipe)
            np.testing.assert_array_equal(train.covariances(samples, recipe)[known], rows[known, :55])


class Trained(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.data = Path(folder.name) / "trembling.csv"

    def test_what_can_be_learned_is_learned_and_rounding_costs_little(self) -> None:
        trembling(self.data)
        out = self.data.parent / "out"
        tables = []
        for seed in ("3", "3", "4"):
            with contextlib.redirect_stdout(io.StringIO()):
                train.main([str(self.data), "--recipe", str(self.data.with_suffix(".toml")), "--out", str(out), "--seed", seed, "--rows", "300"])
            tables.append((out / "network.in").read_text())
        report = json.loads((out / "report.json").read_text())
        # A window of ten remembers a slip for a while.
        self.assertGreater(report["choice"]["unseen"], 0.85)
        self.assertIn("linear model", (out / "model-card.md").read_text().splitlines()[0])
        self.assertEqual(tables[0], tables[1])
        own = "linear model" if report["choice"]["name"] == "linear model" else "network"
        whole, written = (report["scores"][f"{name}, of rows that it has learned"]["balanced"] for name in (own, "as written"))
        self.assertLess(abs(written - whole), 0.01)

    def test_another_seed_gives_another_network(self) -> None:
        rows = np.random.default_rng(1).integers(0, 5000, (300, train.INPUTS)).astype(np.int16)
        networks = [list(train.learn(rows, rows[:, 0] > 2500, True, seed))[-1].weights[0] for seed in (3, 3, 4)]
        np.testing.assert_array_equal(networks[0], networks[1])
        self.assertTrue((networks[0] != networks[2]).any())

    def test_too_little_to_choose_by_is_said(self) -> None:
        for sessions, slips, said in ((1, True, "at least two are needed"), (4, False, "both kinds are needed")):
            trembling(self.data, sessions, slips)
            with self.assertRaisesRegex(ValueError, said):
                train.train(self.data, str(self.data.with_suffix(".toml")))

    def test_real_objects_that_were_never_seen(self) -> None:
        """Learned from four real objects, scored on two others: the bar of the project is 0.90 a step."""
        if not REAL.exists():
            self.skipTest("recordings not present")
        basic, solids = (train.steps_of(REAL / f"array_biotac_sp_{name}.csv", None)[0] for name in ("basic", "solids"))
        with train.threadpool_limits(1):
            choice, _ = train.choose(basic, seed=1)
        rows, slips = train.rows_of(solids)
        says = choice.network.logits(rows) > choice.threshold
        right = (np.mean(says[slips]) + np.mean(~says[~slips])) / 2
        self.assertGreaterEqual(right, 0.90)
        self.assertGreaterEqual(train.score(choice.network.logits(rows), slips, 1.0)["auc"], 0.95)


if __name__ == "__main__":
    unittest.main()
