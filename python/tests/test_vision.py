"""The camera's tracker on drawn pictures, whose truth is known."""

import unittest

import numpy as np

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


if __name__ == "__main__":
    unittest.main()
