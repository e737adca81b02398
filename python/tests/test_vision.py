"""The camera's tracker on drawn pictures, whose truth is known."""

import contextlib
import csv
import io
import json
import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

from tenax import camera as cameras
from tenax import vision


class Drawn(unittest.TestCase):
    def test_slip_is_seen_and_force_comes_with_the_grip(self) -> None:
        camera = vision.Camera()
        right, force = {True: [], False: []}, {True: [], False: []}
        for seen in vision.drawn(seed=3):
            told = camera.picture(seen.rgb, seen.taken_s, learn=not seen.gripped)
            if told.markers and told.force is not None:
                force[seen.gripped].append(told.force[2])
            if seen.gripped and told.slip_px_s is not None:
                right[seen.slides].append(told.slips)
        self.assertGreater(len(right[True]), 10)
        self.assertGreater(np.mean(right[True]), 0.6)
        self.assertLess(np.mean(right[False]), 0.2)
        self.assertGreater(np.mean(force[True]), 3 * np.mean(force[False]))
        self.assertEqual((camera.markers.shape[1], camera.object.shape), (5, (240, 320)))
        self.assertGreater(camera.markers[:, 4].mean(), 0.8)

    def test_no_picture_is_no_picture(self) -> None:
        camera = vision.Camera()
        with self.assertRaisesRegex(ValueError, "240 x 320 x 3"):
            camera.picture(np.zeros((120, 160, 3)), 0.0, learn=True)
        self.assertEqual(camera.picture(np.zeros((240, 320, 3)), 0.0, learn=True).blind, "covered")

    def test_a_video_becomes_tables_and_a_report(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            # What ffmpeg would decode.
            film, ffmpeg = Path(folder) / "skin.rgb", Path(folder) / "ffmpeg"
            film.write_bytes(b"".join(np.ascontiguousarray(seen.rgb).tobytes() for _, seen in zip(range(60), vision.drawn(seed=3))))
            ffmpeg.write_text(f"#!/bin/sh\ncat '{film}'\n")
            ffmpeg.chmod(0o755)
            told = io.StringIO()
            with mock.patch.dict(os.environ, PATH=f"{folder}:{os.environ['PATH']}"), contextlib.redirect_stdout(told):
                self.assertEqual(cameras.main([str(film), "--out", f"{folder}/seen"]), 0)
            report = json.loads(told.getvalue())
            self.assertEqual((report["frames"], report["blind"]), (60, {}))
            self.assertGreater(report["markers"], 15)
            rows = [list(csv.DictReader(Path(f"{folder}/seen/{name}.csv").read_text().splitlines())) for name in ("markers", "object")]
            self.assertEqual((len(rows[1]), rows[1][-1]["frame"]), (60, "59"))
            self.assertLess(abs(float(rows[0][-1]["dx"])), 30)
        with mock.patch.dict(os.environ, PATH=""), self.assertRaisesRegex(OSError, "not installed"):
            next(cameras.pictures("nowhere.m4v"))


if __name__ == "__main__":
    unittest.main()
