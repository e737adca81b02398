"""The package and the program `tenax` say the same, byte for byte. Needs what `cargo tenax test` builds."""

import contextlib
import io
import json
import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import tenax
from tenax import camera

from test_fingertip import rig

PROGRAM = Path(os.environ.get("TENAX_CHECKOUT", "..")) / "target" / "release" / "tenax-sim"


@unittest.skipUnless(PROGRAM.exists(), f"{PROGRAM} is not built")
class Program(unittest.TestCase):
    def same(self, stem: str, told: tenax.Report, *arguments: str) -> None:
        with tempfile.TemporaryDirectory() as out:
            subprocess.run([PROGRAM, "run", "--host", "--out", out, *arguments], check=True, capture_output=True)
            self.assertEqual(told.line, (Path(out) / f"{stem}.line.bin").read_bytes())
            report = json.loads((Path(out) / f"{stem}.json").read_text())
        self.assertEqual({**told, "wall_s": 0}, {**report, "wall_s": 0})

    def test_of_a_scene(self) -> None:
        self.same("glass", tenax.run("glass", 3), "--scene", "glass", "--seed", "3")

    def test_of_a_recording(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "friction_rig_drawn.csv"
            samples = rig()
            rows = [",".join(samples), *(",".join(map(repr, row)) for row in zip(*(own.tolist() for own in samples.values())))]
            path.write_text("\n".join(rows) + "\n")
            self.same("friction_rig_drawn", tenax.replay(path, seed=2), "--replay", str(path), "--seed", "2")

    def test_a_served_hand_takes_a_cameras_codes(self) -> None:
        with tempfile.TemporaryDirectory() as out:
            serving = subprocess.Popen([PROGRAM, "run", "--host", "--serve", "--scene", "glass", "--out", out], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            try:
                port = serving.stdout.readline().split()[-1]
                told = io.StringIO()
                with contextlib.redirect_stderr(told):
                    taught = camera.Taught(port)
                    time.sleep(0.1)  # It consents once it has felt that its hand is empty, 12.5 ms after power-up.
                    taught.teach((1, -1), 0.02)
                    time.sleep(0.5)
                self.assertEqual(told.getvalue(), "")
            finally:
                serving.kill()
                serving.communicate()


if __name__ == "__main__":
    unittest.main()
