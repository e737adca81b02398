"""Datasets: every sample of a recording is in them, and what the line lost is marked."""

import json
import tempfile
import unittest
from pathlib import Path

import numpy as np

import tenax

from test_fingertip import rig

try:
    import pandas  # noqa: F401
    import polars as pl

    from tenax import export
except ImportError as missing:
    raise unittest.SkipTest(f"datasets are not tested: {missing}") from None


class Dataset(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name) / "dataset"
        self.run_of = tenax.Fingertip({"stream-at-start-flag": 1}).run(rig(2.0), recipe="friction_rig")
        self.messages = tenax.decode(self.run_of.line)

    def test_every_sample_is_found_in_it(self) -> None:
        rows = export.to_lerobot([self.messages, self.messages], self.folder, task="press")
        info = json.loads((self.folder / "meta/info.json").read_text())
        self.assertEqual((info["codebase_version"], info["fps"], info["total_frames"], info["total_episodes"]), ("v3.0", 80, rows, 2))
        first, second = (pl.read_parquet(self.folder / export.DATA.format(chunk_index=0, file_index=file)) for file in (0, 1))
        self.assertEqual((first.height, second["index"][0], second["episode_index"][0]), (rows // 2, rows // 2, 1))
        # The samples themselves, as the board's converter took them.
        volts = tenax.pins(rig(2.0), recipe="friction_rig")[:, :12]
        codes = np.clip(np.floor(volts / 3.3 * 4096), 0, 4095).reshape(-1, 4, 12).sum(axis=1)
        films = np.array(first["observation.films"].to_list(), np.float32).reshape(-1, 12)
        np.testing.assert_array_equal(np.round(films / tenax.MV * 1000)[:-25], codes[: len(films) - 25])
        drive = np.array(first["action"].to_list()).reshape(-1)
        np.testing.assert_allclose(drive, self.run_of.ticks["drive"][: len(drive)], atol=1e-6)
        self.assertTrue(all(np.array(first["observation.valid"].to_list())[:-1].ravel()))

    def test_lerobots_own_loader_finds_every_sample(self) -> None:
        try:
            from lerobot.datasets.lerobot_dataset import LeRobotDataset
        except ImportError as missing:
            self.skipTest(f"LeRobot is not installed: {missing}")
        rows = export.to_lerobot([self.messages, self.messages], self.folder, task="press")
        dataset = LeRobotDataset("tenax/test", root=self.folder)
        self.assertEqual((len(dataset), dataset.num_episodes, dataset.fps), (rows, 2, 80))
        expected = [episode for _ in range(2) for episode in export.episodes(self.messages)]
        for n in range(rows):
            item, episode = dataset[n], expected[n // (rows // 2)]
            for name in export.FEATURES:
                np.testing.assert_array_equal(item[name].numpy(), episode[name][n % (rows // 2)], err_msg=f"{name} {n}")
            self.assertEqual(item["task"], "press")

    def test_what_the_line_lost_is_marked_or_ends_an_episode(self) -> None:
        lost = [message for message in self.messages if not (message.kind == "Raw" and message.first == 500)]
        [whole] = export.episodes(lost)
        at, place = divmod(500, 25)
        self.assertEqual(whole["observation.valid"][at].sum(), 20)
        self.assertEqual(whole["observation.films"][at, place:place + 5].sum(), 0)
        gap = [message for message in self.messages if not (message.kind == "Slow" and message.frame == 1024)]
        self.assertEqual([len(own["action"]) for own in export.episodes(gap)][0], 40)
        self.assertEqual(len(export.episodes([*self.messages, *self.messages])), 2)

    def test_parquet_has_the_columns(self) -> None:
        export.to_parquet(self.messages, self.folder)
        self.assertEqual(pl.read_parquet(self.folder / "ticks.parquet").height, 25 * pl.read_parquet(self.folder / "states.parquet").height)

    def test_rerun_reads_every_sample_back(self) -> None:
        try:
            from rerun.chunk import RrdReader
        except ImportError as missing:
            self.skipTest(f"Rerun is not installed: {missing}")
        file = self.folder.with_suffix(".rrd")
        picture = np.arange(48, dtype=np.uint8).reshape(6, 8)
        export.to_rerun(self.messages, file, [(0.5, picture)])
        found = {}
        for chunk in RrdReader(file).stream().to_chunks():
            columns = chunk.to_record_batch().to_pydict()
            times = columns.get("time", [])
            for name, values in columns.items():
                if name.endswith((":scalars", ":text", ":buffer")):
                    found.setdefault(chunk.entity_path, []).extend(zip(times, (value[0] for value in values)))
        run, states = self.run_of, tenax.states(self.messages)
        for place, expected in (("/senses/fn_n", states["fn_n"]), ("/ticks/drive", tenax.ticks(self.messages)["drive"])):
            told = [value for _, value in sorted(found[place])]
            np.testing.assert_array_equal(told, [value for value in expected if value is not None], err_msg=place)
        believed = [value for _, value in sorted(found["/detectors/s1/believed"])]
        np.testing.assert_array_equal(believed, run.ticks["believed"][: len(believed)] >> tenax.DETECTORS.index("s1") & 1)
        films = np.array([[value for _, value in sorted(found[f"/films/{n}"])] for n in range(1, 13)])
        frames = [frame.films for raw in self.messages if raw.kind == "Raw" for frame in raw.frames if frame.valid]
        np.testing.assert_array_equal(np.round(films.T * 1000 / tenax.MV), frames)
        self.assertEqual(bytes(found["/camera"][0][1]), picture.tobytes())
        self.assertTrue(found["/events"] and found["/mode"])

    def test_nothing_is_overwritten(self) -> None:
        self.folder.mkdir()
        (self.folder / "mine").write_text("")
        with self.assertRaises(FileExistsError):
            export.to_lerobot([self.messages], self.folder)
        with self.assertRaisesRegex(ValueError, "no slow frame"):
            export.to_lerobot([[]], self.folder / "new")


if __name__ == "__main__":
    unittest.main()
