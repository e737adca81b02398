"""The logic on arrays, held against a replay of the same recording by the program's own code; and each detector alone."""

import csv
import io
import os
import tempfile
import time
import unittest
import warnings
from pathlib import Path
from typing import Any, Dict

import numpy as np

import tenax

# The recordings are not part of the project.
RIG = Path(os.environ.get("TENAX_CHECKOUT", "..")).parent / "shared" / "data" / "friction_rig_10khz.csv"
DECISIONS = ("vibration_mv", "o1", "o2", "drive", "said", "believed", "acted")


def rig(seconds: float = 4.0) -> Dict[str, "np.ndarray[Any, Any]"]:
    """A finger on a friction rig, drawn: pressed at 0.3 s, driven off at 1.5 s, loud while it slides."""
    t_s = np.arange(round(seconds * 10_000)) / 10_000
    noise = np.random.default_rng(7).normal(size=len(t_s))
    normal = 0.5 * np.clip((t_s - 0.3) / 0.2, 0.0, 1.0) * (t_s < seconds - 0.3)
    climbs = np.clip((t_s - 1.5) / 0.07, 0.0, 1.0)
    slides = t_s > 1.57
    shear = normal * np.where(slides, 0.46, 0.69 * climbs) + np.where(slides & (normal > 0), 0.02, 0.0005) * noise
    return {"t_s": t_s, "shear_n": shear, "normal_n": normal}


class Replayed(unittest.TestCase):
    """Fingertip.run decides in every tick what `run --replay` does."""

    def same(self, path: Path, samples: Any) -> None:
        run = tenax.Fingertip().run(samples, recipe="friction_rig")
        messages = tenax.decode(tenax.replay(path).line)
        ticks, states = tenax.ticks(messages), tenax.states(messages)
        told = len(ticks["drive"])
        self.assertGreater(told, 2000)
        self.assertLess(len(run.ticks["drive"]) - told, 25)
        for column in DECISIONS:
            np.testing.assert_array_equal(run.ticks[column][:told], np.array(ticks[column]), err_msg=column)
        self.assertEqual([tenax.SOURCES[own] for own in run.ticks["source"][:told]], ticks["source"])
        for column in ("fn_n", "load_n", "fx_n", "fy_n", "ft_n", "ratio", "s2", "flexor_mv"):
            np.testing.assert_array_equal(run.states[column], np.array(states[column], dtype=float), err_msg=column)
        self.assertEqual([tenax.MODES[own].split()[0] for own in run.states["mode"]], [mode.lower() for mode in states["mode"]])
        # It is a slip, or nothing is shown.
        self.assertTrue(run.stretches("s1") and run.stretches("s2"))
        self.assertTrue(any("s1 reports slip" in words for _, words in run.events), run.events)

    def test_of_a_drawn_rig(self) -> None:
        samples = rig()
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "friction_rig_drawn.csv"
            text = io.StringIO()
            rows = csv.writer(text)
            rows.writerow(samples)
            rows.writerows(zip(*(column.tolist() for column in samples.values())))
            path.write_text(text.getvalue())
            self.same(path, samples)

    def test_of_the_rigs_recording(self) -> None:
        if not RIG.exists():
            self.skipTest("recording not present")
        self.same(RIG, np.genfromtxt(RIG, delimiter=",", names=True))

    def test_forty_times_as_fast_as_it_lasts(self) -> None:
        samples = rig(60.0)
        begun = time.process_time()
        tenax.Fingertip().run(samples, recipe="friction_rig")
        self.assertLess(time.process_time() - begun, 60 / 40)

    def test_tick_by_tick(self) -> None:
        samples = rig(2.0)
        run = tenax.Fingertip().run(samples, recipe="friction_rig")
        tip = tenax.Fingertip()
        ticks = [tip.tick(frame) for frame in tenax.pins(samples, recipe="friction_rig").reshape(-1, 4, len(tenax.CHANNELS))]
        for column in ("time_s", *DECISIONS):
            expected = run.ticks[column] + (1.0 if column == "time_s" else 0.0)
            np.testing.assert_allclose([getattr(tick, column) for tick in ticks], expected, rtol=0, atol=1e-9, err_msg=column)
        self.assertEqual([tick.mode for tick in ticks], [tenax.MODES[mode] for mode in run.ticks["mode"]])


class Asked(unittest.TestCase):
    def test_settings_are_the_firmwares(self) -> None:
        self.assertIn("slip", tenax.SETTINGS["s1-mv"].meaning)
        samples = rig()
        plain = tenax.Fingertip().run(samples, recipe="friction_rig")
        deaf = tenax.Fingertip({"s1-mv": tenax.SETTINGS["s1-mv"].most, "detectors-off-mask": 8}).run(samples, recipe="friction_rig")
        self.assertTrue(plain.states["s1_slip"].any() and plain.stretches("s1", "acted"))
        self.assertLess(deaf.states["s1_slip"].sum(), plain.states["s1_slip"].sum())
        self.assertEqual(deaf.stretches("s2", "acted"), [])
        with self.assertRaisesRegex(ValueError, "no setting is called s1"):
            tenax.Fingertip({"s1": 1})
        with self.assertRaisesRegex(ValueError, "s1-mv = -1: it may be"):
            tenax.Fingertip({"s1-mv": -1})

    def test_what_no_pin_can_have_is_refused(self) -> None:
        tip = tenax.Fingertip()
        with self.assertRaisesRegex(ValueError, "likely millivolts"):
            tip.run({"t": [0.0, 0.1, 0.2], "pvdf_1": [1650.0, 1651.0, 1649.0]})
        with self.assertRaisesRegex(ValueError, "column `a` is no channel"):
            tip.run({"a": [0.0, 0.1, 0.2]}, rate_hz=100.0)
        with self.assertRaisesRegex(ValueError, "rate_hz"):
            tip.run({"pvdf_1": [1.65, 1.65]})
        with self.assertRaisesRegex(ValueError, "must not go backwards"):
            tip.run({"t": [0.0, 0.2, 0.1], "pvdf_1": [1.65, 1.66, 1.65]})
        with self.assertRaisesRegex(ValueError, "no finite numbers"):
            tip.run({"t": [0.0, 0.1], "pvdf_1": [1.65, np.nan]})
        with self.assertRaises(KeyError):
            tip.tick({"pvdf_13": 1.0})
        with self.assertRaisesRegex(ValueError, "rows of 42 volts"):
            tip.tick([1.0] * 41)


class Alone(unittest.TestCase):
    def test_s1_hears_a_tone_in_its_band_at_any_rate_and_says_that_it_resampled(self) -> None:
        for rate_hz in (1000, 2000, 10_000):
            t_s = np.arange(2 * rate_hz) / rate_hz
            film = 0.4 * np.sin(2 * np.pi * 60 * t_s) * ((t_s > 0.5) & (t_s < 0.8))
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                heard = tenax.detect.s1(film, rate_hz)
            self.assertEqual((len(told) > 0, heard.resampled is not None), (rate_hz != 2000,) * 2)
            self.assertEqual(len(heard.onsets_s), 1, heard.onsets_s)
            self.assertTrue(0.5 < heard.onsets_s[0] < 0.55, heard.onsets_s)
            self.assertGreater(heard.value.max(), 200)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                self.assertFalse(tenax.detect.s1(film / 20, rate_hz).slip.any())

    def test_s2_warns_above_its_ratio(self) -> None:
        shear = np.linspace(0.0, 4.0, 800)
        warned = tenax.detect.s2(np.full(800, 10.0), shear, 80, s2=0.25)
        self.assertFalse(warned.slip.any())
        # The quadrants' Fn is no less than the load: the ratio is no more than that of the forces.
        at = warned.onsets_s[0] / 10 * 4.0 / 10.0
        self.assertTrue(0.245 <= at < 0.28, at)
        self.assertTrue(np.isnan(tenax.detect.s2(np.full(80, 0.1), shear[:80], 80).value).all())

    def test_the_network_that_ships_tells_a_sliding_contact_from_a_still_one(self) -> None:
        still = np.random.default_rng(1).normal(0.8, 0.002, (400, 10))
        slides = still + np.random.default_rng(2).normal(0.0, 0.03, (400, 10)) * (np.arange(400) > 200)[:, None]
        said = tenax.detect.mlp(slides, 80)
        self.assertFalse(said.slip[60:200].any())
        self.assertTrue(said.slip[220:].mean() > 0.5, said.slip[220:].mean())
        self.assertFalse(tenax.detect.mlp(still[:, :3], 80).slip.any())

    def test_a_head_that_flickers_slides(self) -> None:
        t_s = np.arange(4000) / 2000
        noise = np.random.default_rng(4).normal(0.0, 0.0003, len(t_s))
        light = 0.6 + noise + 0.01 * np.sin(2 * np.pi * 60 * t_s) * (t_s > 1)
        said = tenax.detect.photoelastic(light, 2000)
        self.assertFalse(said.slip[: 2000].any())
        self.assertTrue(said.slip[2200:].all())
        self.assertFalse(tenax.detect.photoelastic(light, 2000, settings={"head-slip-mv": 50}).slip.any())

    def test_features_are_those_of_the_shipped_network(self) -> None:
        rows = tenax.detect.features(np.random.default_rng(5).normal(0.8, 0.01, (160, 10)), 80)
        self.assertEqual((rows.shape, rows.dtype), ((160, 112), np.int16))
        self.assertTrue((rows[:39] == 0).all() and rows[60:].any(axis=1).all())

    def test_the_hebbian_network_knows_what_it_was_taught(self) -> None:
        random = np.random.default_rng(3)
        t_s = np.arange(40_000) / 2000
        slides = (t_s > 2) & (t_s % 2 > 1)
        films = random.normal(0.0, 0.0003, (len(t_s), 12))
        films[:, :4] += (0.05 * np.sin(2 * np.pi * 70 * t_s) * slides)[:, None]
        held = t_s > 0.5
        pictures = np.arange(2 * 30, 20 * 30) / 30
        codes = np.stack([np.where((pictures % 2) > 1, -1, 1), np.zeros(len(pictures), int)], axis=1)
        naive, _ = tenax.detect.hebbian(films, 2000, held=held)
        self.assertFalse(naive.slip.any())
        _, knows = tenax.detect.hebbian(films, 2000, held=held, taught_s=pictures, codes=codes)
        taught, _ = tenax.detect.hebbian(films, 2000, held=held, knows=knows)
        self.assertGreater(taught.slip[slides].mean(), 0.5)
        self.assertLess(taught.slip[~slides].mean(), 0.05)
        with self.assertRaisesRegex(ValueError, "no bytes of a network"):
            tenax.detect.hebbian(films, 2000, held=held, knows=b"1234")


if __name__ == "__main__":
    unittest.main()
