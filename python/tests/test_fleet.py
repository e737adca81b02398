"""The store and its questions, on rows whose answers are known."""

import tempfile
import unittest
from pathlib import Path

try:
    import polars as pl

    from tenax import fleet
except ImportError as missing:
    raise unittest.SkipTest(f"the fleet's store is not tested: {missing}") from None


def minute(quiet_mv: float, pulses: int, ratio: float) -> "pl.DataFrame":
    """A minute of holding 10 N, with so many pulses, each alone."""
    rows = 80 * 60
    pulse = [n % (rows // max(pulses, 1)) == 1 and pulses > 0 for n in range(rows)]
    return pl.DataFrame({
        "time_s": [n / 80 for n in range(rows)], "mode": ["Watch"] * rows, "fn_n": [10.0] * rows, "load_n": [10.0] * rows,
        "ft_n": [10.0 * ratio] * rows, "s2": [0.3] * rows, "margin_n": [10.0 * (0.3 - ratio)] * rows, "vibration_mv": [quiet_mv] * rows,
        "pulse": pulse, "alone": pulse, "shown": [ratio] * rows,
    })


def put(store: Path, hand: str, day: str, rows: "pl.DataFrame") -> None:
    folder = store / f"hand={hand}" / f"day={day}"
    folder.mkdir(parents=True, exist_ok=True)
    rows.write_parquet(folder / "r.parquet")


class Fleet(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.store = Path(folder.name)

    def test_each_hand_and_day_is_counted_by_itself(self) -> None:
        store = self.store
        put(store, "a", "2026-01-01", minute(4.0, 2, 0.2))
        put(store, "a", "2026-01-02", minute(4.0, 0, 0.25))
        put(store, "b", "2026-01-01", minute(60.0, 6, 0.1))
        tables = fleet.query(store)
        hands = {row["hand"]: row for row in tables["by hand"].to_dicts()}
        self.assertEqual((hands["a"]["pulses"], hands["b"]["pulses"]), (2, 6))
        self.assertAlmostEqual(hands["a"]["pulses_held_h"], 60.0)
        self.assertAlmostEqual(hands["b"]["alone_held_h"], 360.0)
        self.assertAlmostEqual(hands["a"]["friction_shown"], 0.25)
        self.assertAlmostEqual(hands["b"]["margin_n_p5"], 2.0, delta=fleet.STEP_N)
        days = {str(row["day"]): row for row in tables["by day"].to_dicts()}
        self.assertEqual((days["2026-01-01"]["pulses"], days["2026-01-02"]["pulses"]), (8, 0))


    def test_noise_raises_s1_within_its_range_and_silence_lowers_nothing(self) -> None:
        store = self.store
        put(store, "a", "2026-01-01", minute(4.0, 0, 0.2))
        self.assertIn("s1-mv = 100\n", fleet.settings(store, 0.9))
        put(store, "b", "2026-01-01", minute(50.0, 0, 0.2))
        self.assertIn("s1-mv = 125\n", fleet.settings(store, 0.9))
        put(store, "c", "2026-01-01", minute(90.0, 0, 0.2))
        told = fleet.settings(store, 0.9)
        self.assertIn("s1-mv = 150\n", told)
        self.assertIn("Louder than this allows: c.", told)


    def test_an_empty_store_says_what_to_do(self) -> None:
        store = self.store
        with self.assertRaisesRegex(SystemExit, "fleet add"):
            fleet.query(store)


if __name__ == "__main__":
    unittest.main()
